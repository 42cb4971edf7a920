//! `--max-memory` and `--timeout`: a command that would exceed them ends with an error that names the purpose of the
//! memory, and leaves no file.

use crate::harness::{CUBE, Folder};
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Returns a binary STL file of triangles side by side.
fn stl(count: u32) -> Vec<u8> {
    let mut file = vec![b' '; 80];
    file.extend(count.to_le_bytes());
    for i in 0..count {
        let x = (i % 300) as f32;
        let y = (i / 300) as f32;
        file.extend([0; 12]);
        for v in [[x, y, 0.0], [x + 0.9, y, 0.0], [x, y + 0.9, 0.5]] {
            file.extend(v.iter().flat_map(|v| v.to_le_bytes()));
        }
        file.extend([0; 2]);
    }
    file
}

/// Returns an OBJ file of the given number of triangles.
fn obj(count: u32) -> String {
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    (0..count).for_each(|_| text.push_str("f 1 2 3\n"));
    text
}

/// Returns a polygon with many self-intersections.
fn ring(points: u64) -> String {
    let at = |i: u64| format!("[{},{}]", i * 7919 % 1009, i * 104_729 % 1013);
    let ring: Vec<String> = (0..points).chain([0]).map(at).collect();
    format!(r#"{{"type":"Polygon","coordinates":[[{}]]}}"#, ring.join(","))
}

/// Returns a drawing of many curves with wide strokes.
fn svg(curves: u32) -> String {
    let mut text =
        String::from(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">"#);
    text.push_str(
        r#"<path fill="none" stroke="red" stroke-width="9" stroke-linejoin="round" d="M50 50"#,
    );
    for i in 0..curves {
        let [a, b, c] = [37, 53, 71].map(|k| i * k % 100);
        let _ = write!(text, "C{a} {b} {c} {a} {b} {c}");
    }
    text.push_str(r#""/></svg>"#);
    text
}

#[test]
fn what_needs_more_is_refused_with_its_stage_and_the_option() {
    let folder = Folder::with_models();
    folder.write("many.stl", stl(60_000));
    folder.write("many.obj", obj(100_000));
    folder.write("curves.svg", svg(5000));
    folder.write("few.svg", svg(5));
    folder.must("render cube.obj -o a.png --depth d.png --size 600x600 --near 1 --far 20");
    folder.write("heights.xyz", "0 0 0\n".repeat(400_000));
    folder.write("ring.geojson", ring(400));
    let drawing = |inside: &str| {
        format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">{inside}</svg>"#)
    };
    folder.write("elements.svg", drawing(&"<g/>".repeat(20_000)));
    folder.write(
        "groups.svg",
        drawing(&format!(
            "{}<path d='M0 0H9V9'/>{}",
            "<g opacity='.9'><rect width='1' height='1'/>".repeat(200),
            "</g>".repeat(200)
        )),
    );
    let before = folder.names();
    for (command, budget, stage) in [
        ("render cube.obj -o o.png --size 2000x2000", "8M", "planes of the picture"),
        ("render cube.obj -o o.png --size 9x9 --shadows map", "8M", "shadow maps"),
        ("render many.stl -o o.png --size 64x64", "40k", "meshes of the model"),
        ("render many.stl -o o.png --size 900x900", "5M", "samples of the picture"),
        ("render many.stl -o o.png --size 64x64 --shadows map", "1M", "meshes of the model"),
        ("render many.obj -o o.png --size 64x64", "4M", "meshes of the model"),
        ("render many.obj -o o.png --size 64x64", "500k", "bytes of the file"),
        ("render many.stl -o o.png --size 64x --aa 16", "3500k", "triangles on the screen"),
        ("render many.stl -o o.png --size 64x64 --algorithm ray", "5M", "triangles on the screen"),
        ("render many.stl -o o.svg", "6M", "faces for hidden lines"),
        ("render many.stl -o o.svg --style regions", "6M", "faces of the drawing"),
        ("info many.stl", "40k", "meshes of the model"),
        ("pick many.stl --at 9,9", "1M", "meshes of the model"),
        ("draw curves.svg -o o.png --size 100x100", "1M", "outlines of what is painted"),
        ("draw few.svg -o o.png --size 3000x3000", "34M", "planes of the picture"),
        ("fill a.png -o o.png --at 0,0 --color red", "1M", "decoded pictures"),
        ("plot heights.xyz -o o.png", "1M", "bytes of the file"),
        ("render heights.xyz -o o.png --size 9x9", "6M", "meshes of the model"),
        ("fix ring.geojson -o o.geojson", "2M", "graph of the overlay"),
        ("buffer ring.geojson -o o.geojson --distance 1", "2M", "of the overlay"),
        ("clip ring.geojson -o o.geojson --window 0,0,900,900", "2M", "graph of the overlay"),
        ("draw elements.svg -o o.png", "8M", "elements of the drawing"),
        ("draw groups.svg -o o.png --size 2000x40", "24M", "layers of groups and clip paths"),
        (
            "warp a.png d.png -o o.png --eye 9,9,9 --target 0,0,0 --near 1 --far 20 --to-eye 9,9,8 \
             --size 1500x1500",
            "40M",
            "places of moved pixels",
        ),
    ] {
        let ended = folder.run(&format!("{command} --max-memory {budget}"));
        let file = command.split(' ').nth(1).unwrap();
        ended.fails(1, stage).fails(1, "--max-memory allows");
        if !command.starts_with("warp") {
            ended.fails(1, file);
        }
        assert_eq!(folder.names(), before, "{command}");
    }
}

#[test]
fn map_data_that_are_held_are_charged() {
    let folder = Folder::new();
    folder.write("many.wkt", "POINT (1 2)\n".repeat(200_000));
    let rest = "many.wkt --max-memory 1M";
    for command in ["clip --window 0,0,1,1 -o o.wkt", "check", "info", "fix -o o.wkt"] {
        let (name, options) = command.split_once(' ').unwrap_or((command, ""));
        folder.run(&format!("{name} {rest} {options}")).fails(1, "map data: ").fails(1, "many.wkt");
        assert_eq!(folder.names(), ["many.wkt"], "{command}");
    }
    let feature = r#"{"type":"Feature","properties":{"a":1},"geometry":{"type":"Point","coordinates":[1,2]}}"#;
    folder.write("many.geojsonl", format!("{feature}\n").repeat(20_000));
    let rest = "many.geojsonl --max-memory 1M";
    for command in
        ["tiles -o o.pmtiles", "simplify --tolerance 1 -o o.geojson", "dissolve -o o.geojson"]
    {
        let (name, options) = command.split_once(' ').unwrap_or((command, ""));
        folder
            .run(&format!("{name} {rest} {options}"))
            .fails(1, "features: ")
            .fails(1, "many.geojsonl");
        assert_eq!(folder.names(), ["many.geojsonl", "many.wkt"], "{command}");
    }
    // Features that are processed one by one are not kept.
    folder.must(&format!("clip {rest} --window 0,0,9,9 -o o.geojsonl"));
}

#[test]
fn copies_of_a_model_are_charged() {
    let folder = Folder::new();
    let count = 20_000;
    let corners = 3 * 100;
    let nodes: Vec<String> =
        (0..count).map(|i| format!(r#"{{"mesh":0,"translation":[{i},0,0]}}"#)).collect();
    let all: Vec<String> = (0..count).map(|i| i.to_string()).collect();
    let positions: Vec<f32> = (0..corners * 3).map(|i| (i * 7 % 11) as f32).collect();
    folder.write("a.bin", positions.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>());
    let gltf = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":{corners},"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{bytes}}}],"buffers":[{{"byteLength":{bytes},"uri":"a.bin"}}]}}"#,
        all.join(","),
        nodes.join(","),
        bytes = corners * 12,
    );
    folder.write("copies.gltf", gltf);
    let cut = "render copies.gltf -o a.png --size 16 --max-memory 60M --section 0,0,1,-3";
    folder
        .run(cut)
        .fails(1, "copies.gltf: copies of the model: ")
        .fails(1, "--max-memory allows 60 MB");
}

#[test]
fn whether_a_large_model_is_closed_may_stay_open() {
    let folder = Folder::new();
    folder.write("many.stl", stl(60_000));
    let info = folder.must("info many.stl --max-memory 6100k");
    let text = String::from_utf8(info.out).unwrap();
    assert!(text.contains("whether it is closed is not checked: edges of the model"), "{text}");
}

#[test]
fn a_model_that_costs_too_much_is_skipped() {
    let folder = Folder::with_models();
    folder.write("many.obj", obj(100_000));
    let command =
        "render many.obj cube.obj -o out/ --size 64x64 --skip-failures --max-memory 500k --json";
    let ended = folder.run(command);
    ended.fails(3, "many.obj: bytes of the file");
    assert_eq!(ended.json()["models"].as_array().unwrap().len(), 1);
    assert!(folder.path("out/cube.png").exists() && !folder.path("out/many.png").exists());
}

/// Checks that the memory of one model is available again for the next.
#[test]
fn models_one_after_another_share_a_budget() {
    let folder = Folder::new();
    let names: Vec<String> = (0..6).map(|i| format!("{i}.stl")).collect();
    names.iter().for_each(|name| folder.write(name, stl(20_000)));
    let models = names.join(" ");
    folder.must(&format!("render {models} -o out/ --size 64x64 --max-memory 6M"));
    folder.must(&format!("info {models} --max-memory 4M"));
}

#[test]
fn time_ends_what_looks_at_it() {
    let folder = Folder::with_models();
    let printed = "cube.obj: it takes longer than the 0.05 s that --timeout allows";
    let command = "render cube.obj -o o.png --size 9000x9000 --aa 16 --timeout 0.05";
    folder.run(command).fails(1, printed);
    assert_eq!(folder.names(), ["broken.obj", "cube.obj"]);
    folder.must("render cube.obj -o o.png --size 20x20 --timeout 600");
}

/// Checks that a timeout also ends a command that waits for its input.
#[test]
fn time_ends_what_waits() {
    let folder = Folder::new();
    let start = Instant::now();
    let command = "clip - --from geojsonl --to geojsonl --window 0,0,9,9 -o o.json --timeout 0.1";
    let mut child = folder.command(command);
    let mut child = child.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"{\"type\":").unwrap();
    let output = child.wait_with_output().unwrap();
    let printed = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{printed}");
    assert!(
        printed.contains("standard input") && printed.contains("--timeout allows"),
        "{printed}"
    );
    assert!(start.elapsed() > Duration::from_secs(1) && folder.names().is_empty());
    drop(input);
}

#[test]
fn sizes_and_seconds_are_checked() {
    let folder = Folder::new();
    folder.write("a.obj", CUBE);
    folder.run("info a.obj --max-memory 0").fails(2, "--max-memory");
    folder.run("info a.obj --max-memory 3X").fails(2, "--max-memory");
    folder.run("info a.obj --timeout 0").fails(2, "--timeout");
    folder.must("info a.obj --max-memory 64M --timeout 9");
}
