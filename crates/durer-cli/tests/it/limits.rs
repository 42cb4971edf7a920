//! Files that demand too much are refused at once, with the file, the place and the limit, whatever their headers
//! claim.

use crate::harness::Folder;
use std::io::Write;

/// Returns a triangle as glTF, with parts of the text replaced.
fn gltf(replace: &[(&str, &str)]) -> String {
    let text = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    replace.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}

const NODES: &str = r#""nodes":[{"mesh":0}]"#;

/// Returns a node tree as deep as it has nodes.
fn chain(nodes: usize) -> String {
    let inner: String = (1..nodes).map(|i| format!("{{\"children\":[{i}]}},")).collect();
    gltf(&[(NODES, &format!(r#""nodes":[{inner}{{"mesh":0}}]"#))])
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut sum = flate2::Crc::new();
    sum.update(kind);
    sum.update(data);
    let length = (data.len() as u32).to_be_bytes();
    [&length[..], kind, data, &sum.sum().to_be_bytes()].concat()
}

/// Returns an RGB picture that claims this size and holds this number of zeros.
fn png(width: u32, height: u32, zeros: usize) -> Vec<u8> {
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(&vec![0; zeros]).expect("memory");
    let packed = packed.finish().expect("memory");
    let size = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 2, 0, 0, 0]].concat();
    let chunks = [chunk(b"IHDR", &size), chunk(b"IDAT", &packed), chunk(b"IEND", b"")];
    [&b"\x89PNG\r\n\x1a\n"[..], &chunks.concat()].concat()
}

#[test]
fn counts_of_thousands_of_millions_are_refused() {
    let folder = Folder::new();
    let count = r#""count":3"#;
    let dense = gltf(&[(count, r#""count":1000000000"#)]);
    let indices = r#""indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}"#;
    let sparse = format!(r#""sparse":{{"count":1,{indices}}},"count":900000000"#);
    let sparse = gltf(&[
        (r#""bufferView":0,"componentType":5126,"#, r#""componentType":5126,"#),
        (count, &sparse),
    ]);
    let ply = "ply\nformat ascii 1.0\nelement vertex 1000000000\nproperty float x\nproperty float y\n\
               property float z\nend_header\n0 0 0\n";
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999\n";
    for (name, content, part) in [
        ("dense.gltf", dense.as_str(), "ends at byte 12000000000 of a view of 36"),
        ("sparse.gltf", &sparse, "above the limit of 4294967296"),
        ("index.obj", obj, "line 4, column 7: vertex 999999999 does not exist"),
    ] {
        folder.write(name, content);
        folder.run(&format!("render {name} -o a.png")).fails(1, part).fails(1, name);
    }
    folder.write("count.ply", ply);
    let read = folder.must("render count.ply -o a.png");
    assert!(read.err.contains("1 of 1000000000 rows of element `vertex` is read"), "{}", read.err);
    folder.write("count.wkb", [1, 2, 0, 0, 0, 255, 255, 255, 255]);
    let clip = "clip count.wkb --window 0,0,1,1 -o a.geojson";
    folder.run(clip).fails(1, "byte 5, feature 1: a count of 4294967295");
    // The existing data are read: the count in the header of an STL file is often wrong.
    folder.write("count.stl", [&[b'x'; 80][..], &[255; 4], &[0; 50]].concat());
    assert!(folder.must("render count.stl -o a.png").err.contains("the file has room for 1"));
}

#[test]
fn trees_of_nodes_may_be_deep_but_must_be_trees() {
    let folder = Folder::new();
    folder.write("deep.gltf", chain(100_000));
    folder.must("info deep.gltf");
    let nodes = |text: &str| gltf(&[(NODES, text)]);
    let cycle = r#""nodes":[{"children":[1]},{"children":[0],"mesh":0}]"#;
    folder.write("cycle.gltf", nodes(cycle));
    folder.run("info cycle.gltf").fails(1, "is its own ancestor");
    // Without this check forty levels would be 2⁴⁰ instances.
    let doubled: String = (1..40).map(|i| format!("{{\"children\":[{i},{i}]}},")).collect();
    folder.write("doubled.gltf", nodes(&format!(r#""nodes":[{doubled}{{"mesh":0}}]"#)));
    folder.run("info doubled.gltf").fails(1, "has two parents");
}

#[test]
fn text_that_is_nested_without_end_is_refused() {
    let folder = Folder::new();
    let files = [
        ("deep.geojson", r#"{"type":"GeometryCollection","geometries":["#.repeat(5000)),
        ("deep.wkt", "GEOMETRYCOLLECTION(".repeat(20_000)),
        ("deep.svg", format!("<svg xmlns='http://www.w3.org/2000/svg'>{}", "<g>".repeat(50_000))),
    ];
    for (name, content) in files {
        folder.write(name, content);
        let clip = format!("clip {name} --window 0,0,1,1 -o a.geojson");
        folder.run(&clip).fails(1, "nested too deep").fails(1, "line 1, column");
    }
    folder.write("deep.json", "[".repeat(100_000));
    folder.run("plot deep.json -o a.svg").fails(1, "nested too deep");
    let entities: String = (b'b'..=b'j')
        .map(|c| {
            format!("<!ENTITY {} '{}'>", c as char, format!("&{};", (c - 1) as char).repeat(10))
        })
        .collect();
    let laugh = format!(
        "<!DOCTYPE svg [<!ENTITY a 'ha'>{entities}]><svg xmlns='http://www.w3.org/2000/svg'>\
         <text>&j;</text></svg>"
    );
    folder.write("laugh.svg", laugh);
    folder
        .run("draw laugh.svg -o a.png")
        .fails(1, "entities refer to each other in a circle, or too often");
}

#[test]
fn pictures_that_are_more_than_they_hold_are_refused() {
    let folder = Folder::new();
    folder.write("huge.png", png(60_000, 60_000, 1000));
    folder.run("fill huge.png --at 0,0 --color red -o a.png").fails(1, "above the limit");
    folder.run("plot huge.png -o a.svg").fails(1, "above the limit");
    let textured = gltf(&[
        (r#""attributes""#, r#""material":0,"attributes""#),
        (
            r#""scene":0"#,
            r#""scene":0,"images":[{"uri":"huge.png"}],"textures":[{"source":0}],
            "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}]"#,
        ),
    ]);
    folder.write("textured.gltf", textured);
    folder
        .run("render textured.gltf -o a.png")
        .fails(1, "the side of an image is 60000, above the limit");
    // Slightly more than a megabyte of zeros for a picture of one pixel: the excess is not read.
    folder.write("bomb.png", png(1, 1, 1 << 28));
    folder.must("fill bomb.png --at 0,0 --color red -o b.png");
    folder.write("short.png", png(9000, 9000, 1000));
    folder.run("fill short.png --at 0,0 --color red -o c.png").fails(1, "short.png");
    for name in ["a.png", "c.png"] {
        assert!(!folder.path(name).exists(), "{name}");
    }
}

#[test]
fn limits_name_the_option_that_raises_them() {
    let folder = Folder::with_models();
    folder.run("render cube.obj -o a.png --max-triangles 5").fails(
        1,
        "cube.obj: the number of triangles, lines and points is 12, above the limit of 5; --max-triangles raises it",
    );
    folder
        .run("info cube.obj --max-bytes 20")
        .fails(1, "cube.obj: it has more bytes than the limit of 20; --max-bytes raises it");
}
