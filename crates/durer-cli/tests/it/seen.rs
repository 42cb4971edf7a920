//! The contents of a picture in relation to its model: status and warnings, lines and points, culled faces.

use crate::harness::Folder;

/// Returns a glTF triangle whose front is visible along −z.
fn triangle(material: &str, mode: u32) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"materials":[{material}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0,"mode":{mode}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}]}}"#
    )
}

/// Returns the status of the picture, and the messages.
fn status(folder: &Folder, arguments: &str) -> (String, String) {
    let run = folder.must(&format!("render {arguments} --json"));
    let report = run.json();
    let status = report["models"][0]["pictures"][0]["status"].as_str().expect("status").to_owned();
    (status, run.err.clone())
}

#[test]
fn what_is_not_seen_is_reported_with_its_reason() {
    let folder = Folder::with_models();
    folder.write("front.gltf", triangle("{}", 4));
    folder.write("clear.mtl", "newmtl a\nKd 1 0 0\nd 0\n");
    folder.write("clear.obj", "mtllib clear.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    folder.write("empty.gltf", r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{}]}"#);
    for (arguments, expected, reason) in [
        ("cube.obj -o a.png --size 40", "ok", ""),
        ("empty.gltf -o a.png --size 40", "empty", "nothing to draw"),
        ("empty.gltf -o a.svg", "empty", "nothing to draw"),
        ("front.gltf -o a.png --size 40 --view front", "ok", ""),
        ("front.gltf -o a.png --size 40 --view back", "invisible", "--cull none shows"),
        ("front.gltf -o a.png --size 40 --view back --cull none", "ok", ""),
        ("clear.obj -o a.png --size 40", "invisible", "transparent"),
        ("clear.obj -o a.png --size 40 --ground --grid --axes", "invisible", "transparent"),
        ("cube.obj -o a.png --size 40 --look studio --grid", "ok", ""),
        ("cube.obj -o a.png --size 40 --eye 9,0,0 --target 10,0,0", "invisible", "behind the eye"),
        ("cube.obj -o a.svg --eye 9,0,0 --target 10,0,0", "invisible", "behind the eye"),
        ("cube.obj -o a.png --size 40 --near 1000 --far 2000", "invisible", "near plane"),
        ("cube.obj -o a.png --size 40 --shading unlit --color white", "invisible", "background"),
        ("cube.obj -o a.png --size 40 --algorithm all", "ok", ""),
        ("cube.obj -o a.png --size 90x30 --viewports front,back", "ok", ""),
        ("cube.obj -o a.png --size 40 --style hidden-line", "ok", ""),
    ] {
        let (found, printed) = status(&folder, arguments);
        assert_eq!(found, expected, "{arguments}: {printed}");
        assert!(printed.contains(reason), "{arguments}: {printed}");
        assert_eq!(
            printed.is_empty(),
            reason.is_empty() && !arguments.contains("clear"),
            "{arguments}: {printed}"
        );
    }
}

#[test]
fn lines_and_points_are_seen_drawn_and_picked() {
    let folder = Folder::new();
    folder.write("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n");
    folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\np 1 2 3\n");
    folder.write("points.gltf", triangle("{}", 0));
    for (model, kind, count) in
        [("lines.obj", "lines", 2), ("points.obj", "points", 3), ("points.gltf", "points", 3)]
    {
        for output in ["a.png --size 60", "a.svg", "a.dxf", "a.pdf", "a.geojson"] {
            let run = folder.must(&format!("render {model} --view front -o {output} --json"));
            let picture = &run.json()["models"][0]["pictures"][0];
            let white = model == "points.gltf" && output.ends_with("60");
            let expected = if white { "invisible" } else { "ok" };
            assert_eq!(picture["status"], expected, "{model} {output}: {}", run.err);
        }
        let picked = folder.must(&format!("pick {model} --view front --rect 0,0,1024,1024 --json"));
        assert_eq!(picked.json()[kind].as_array().map(Vec::len), Some(count), "{model}");
    }
    for wrong in ["--line-width 0", "--point-size -1", "--line-width 1e9", "--point-size x"] {
        assert_eq!(folder.run(&format!("render lines.obj -o a.png {wrong}")).code, 2, "{wrong}");
    }
}

#[test]
fn looks_change_pictures_and_are_refused_for_drawings() {
    let folder = Folder::with_models();
    folder.must("render cube.obj -o plain.png --size 60");
    let plain = folder.read("plain.png");
    for look in [
        "--look studio",
        "--look clay",
        "--look technical",
        "--ambient-occlusion=1 --view top --elevation 5",
        "--ground",
        "--edges",
        "--edges=3",
        "--grid",
        "--axes",
        "--color red",
    ] {
        let look = look.replace("--view top ", "");
        folder.must(&format!("render cube.obj -o a.png --size 60 {look}"));
        assert_ne!(folder.read("a.png"), plain, "{look}");
        assert_eq!(folder.run(&format!("render cube.obj -o a.svg {look}")).code, 2, "{look}");
    }
    folder.must("render cube.obj -o a.png --size 60 --look clay");
    let clay = folder.read("a.png");
    folder.must("render cube.obj -o a.png --size 60 --look clay --color red");
    assert_ne!(folder.read("a.png"), clay);
    folder.must("render cube.obj -o a.png --size 60 --look plain");
    assert_eq!(folder.read("a.png"), plain);
    for wrong in [
        "--ambient-occlusion=2",
        "--edges=0",
        "--look fancy",
        "--algorithm all --edges",
        "--algorithm all --look technical",
        "--algorithm wireframe --ambient-occlusion",
    ] {
        assert_eq!(folder.run(&format!("render cube.obj -o a.png {wrong}")).code, 2, "{wrong}");
    }
}
