//! The memory of whole runs as Linux reports it; other systems have no such test.

use crate::harness::Folder;
use std::fmt::Write;

/// Squares along the side of a sheet; each consists of two triangles.
const SIDE: u32 = 200;

/// Memory that the command itself needs, whatever the model.
const OWN: u64 = 16 << 20;

fn height(x: u32, y: u32) -> f32 {
    (x * 7 % 13) as f32 * 0.1 + (y * 5 % 11) as f32 * 0.1
}

/// Returns the corners of all squares' triangles.
fn triangles() -> impl Iterator<Item = [[u32; 2]; 3]> {
    (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))).flat_map(|(x, y)| {
        let [a, b, c, d] = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
        [[a, b, c], [a, c, d]]
    })
}

fn stl() -> Vec<u8> {
    let mut file = vec![b' '; 80];
    file.extend((2 * SIDE * SIDE).to_le_bytes());
    for triangle in triangles() {
        file.extend([0; 12]);
        for [x, y] in triangle {
            file.extend([x as f32, y as f32, height(x, y)].iter().flat_map(|v| v.to_le_bytes()));
        }
        file.extend([0; 2]);
    }
    file
}

fn ascii_stl() -> Vec<u8> {
    let mut text = String::from("solid sheet\n");
    for triangle in triangles() {
        text.push_str("facet normal 0 0 1\nouter loop\n");
        for [x, y] in triangle {
            let _ = writeln!(text, "vertex {x} {y} {}", height(x, y));
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid\n");
    text.into_bytes()
}

fn obj() -> Vec<u8> {
    let mut text = String::new();
    for (x, y) in (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| (x, y))) {
        let _ = writeln!(text, "v {x} {y} {}", height(x, y));
    }
    let number = |[x, y]: [u32; 2]| y * (SIDE + 1) + x + 1;
    for [a, b, c] in triangles() {
        let _ = writeln!(text, "f {} {} {}", number(a), number(b), number(c));
    }
    text.into_bytes()
}

fn ply() -> Vec<u8> {
    let (vertices, faces) = ((SIDE + 1) * (SIDE + 1), 2 * SIDE * SIDE);
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\n\
         property float y\nproperty float z\nelement face {faces}\n\
         property list uchar uint vertex_indices\nend_header\n"
    )
    .into_bytes();
    for (x, y) in (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| (x, y))) {
        file.extend([x as f32, y as f32, height(x, y)].iter().flat_map(|v| v.to_le_bytes()));
    }
    for triangle in triangles() {
        file.push(3);
        let number = |[x, y]: [u32; 2]| y * (SIDE + 1) + x;
        file.extend(triangle.iter().flat_map(|&c| number(c).to_le_bytes()));
    }
    file
}

#[test]
fn a_run_takes_less_than_eight_times_its_file() {
    let folder = Folder::new();
    for (name, file) in
        [("a.stl", stl()), ("b.stl", ascii_stl()), ("c.obj", obj()), ("d.ply", ply())]
    {
        folder.write(name, &file);
        let arguments = format!("render {name} -o {name}.png --size 64x64 --threads 1 --json");
        let report = folder.must(&arguments).json();
        let Some(peak) = report["peak_memory_bytes"].as_u64() else {
            println!("skipped: the system does not tell the peak of the memory");
            return;
        };
        let most = OWN + 8 * file.len() as u64;
        assert!(peak < most, "{name} of {} bytes: {peak}, not below {most}", file.len());
    }
}

/// Returns a binary glTF file of many vertices and one triangle.
fn glb(vertices: u32) -> Vec<u8> {
    let (points, bytes) = (12 * vertices, 12 * vertices + 12);
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"buffers":[{{"byteLength":{bytes}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"accessors":[
        {{"bufferView":0,"componentType":5126,"count":{vertices},"type":"VEC3"}},
        {{"bufferView":1,"componentType":5125,"count":3,"type":"SCALAR"}}],"bufferViews":[
        {{"buffer":0,"byteLength":{points}}},{{"buffer":0,"byteOffset":{points},"byteLength":12}}]}}"#
    );
    json += &" ".repeat(json.len().wrapping_neg() % 4);
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + json.len() as u32 + bytes).to_le_bytes());
    file.extend((json.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(json.bytes());
    file.extend(bytes.to_le_bytes());
    file.extend(b"BIN\0");
    for i in 0..vertices {
        let point = [i as f32, (i % 2) as f32, 0.0];
        file.extend(point.iter().flat_map(|v| v.to_le_bytes()));
    }
    file.extend([0, 1, 2].iter().flat_map(|index: &u32| index.to_le_bytes()));
    file
}

#[test]
fn of_a_binary_gltf_file_only_what_is_made_of_it_is_held() {
    let folder = Folder::new();
    let file = glb(3_000_000);
    folder.write("a.glb", &file);
    let report = folder.must("render a.glb -o a.png --size 64x64 --threads 1 --json").json();
    let Some(peak) = report["peak_memory_bytes"].as_u64() else {
        println!("skipped: the system does not tell the peak of the memory");
        return;
    };
    let most = OWN + 3 * file.len() as u64 / 2;
    assert!(peak < most, "{} bytes: {peak}, not below {most}", file.len());
}

/// Memory that a batch may need for each of its small pictures: its line of the report, and its data before the run.
const EACH: u64 = 16 << 10;

#[test]
fn a_batch_takes_no_more_than_its_pictures() {
    let folder = Folder::new();
    let models: Vec<String> = (0..160).map(|i| format!("m{i}.obj")).collect();
    models.iter().for_each(|name| folder.write(name, crate::harness::CUBE));
    let peak = |arguments: &str| {
        let report = folder.must(&format!("render {arguments} -o out --size 16x16 --json")).json();
        report["peak_memory_bytes"].as_u64()
    };
    for (few, many, count) in [
        (models[..40].join(" "), models.join(" "), 120),
        ("m0.obj --turntable 40".to_owned(), "m0.obj --turntable 360".to_owned(), 320),
    ] {
        let (Some(few), Some(many)) = (peak(&few), peak(&many)) else {
            println!("skipped: the system does not tell the peak of the memory");
            return;
        };
        // Memory grew by 230 kB per model and by 65 kB per frame while freed blocks could not be reused.
        assert!(many < few + count * EACH + (1 << 20), "{few} became {many}");
    }
}
