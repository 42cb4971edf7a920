//! glTF: the remaining model if a referenced file is missing or a part of the file is broken.

use crate::gltf::{ACCESSOR, read, triangle_bytes, uri};
use durer_formats::{Found, Model, ReadOptions, Resources, gltf};

/// Returns a mesh of primitives over two buffers: accessor 0 is in the file, accessor 1 in `far.bin`,
/// accessor 2 is an index list that leads out of any triangle.
fn two_buffers(primitives: &str, more: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "buffers": [{{"uri": "{}", "byteLength": 36}}, {{"uri": "far.bin", "byteLength": 36}},
            {{"uri": "data:,%01%02%03", "byteLength": 3}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 1, "byteLength": 36}},
            {{"buffer": 2, "byteLength": 3}}],
        "accessors": [{ACCESSOR}, {}, {{"bufferView": 2, "componentType": 5121, "count": 3, "type": "SCALAR"}}],
        "meshes": [{{"primitives": [{primitives}]}}] {more}}}"#,
        uri(&triangle_bytes()),
        ACCESSOR.replace(r#""bufferView": 0"#, r#""bufferView": 1"#)
    )
}

const NEAR: &str = r#"{"attributes": {"POSITION": 0}}"#;
const FAR: &str = r#"{"attributes": {"POSITION": 1}}"#;
const BROKEN: &str = r#"{"attributes": {"POSITION": 0}, "indices": 2}"#;

fn messages(model: &Model) -> Vec<String> {
    model.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn without_a_buffer_the_rest_is_shown() {
    let model = read(&two_buffers(&[FAR, NEAR, FAR].join(","), "")).unwrap();
    assert_eq!(model.scene.triangle_count(), 1);
    let why = "this source has no folder to look in";
    let left_out = "meshes[0].primitives[0] and 1 more primitive are left out";
    assert_eq!(
        messages(&model),
        [format!("buffers[1].uri: cannot read `far.bin`: {why}; {left_out}")]
    );
    let nothing = read(&two_buffers(FAR, "")).unwrap_err().to_string();
    assert_eq!(nothing, format!("buffers[1].uri: cannot read `far.bin`: {why}"));
    let unasked = messages(&read(&two_buffers(NEAR, "")).unwrap());
    let end = "nothing that is shown needs it";
    assert_eq!(unasked, [format!("buffers[1].uri: cannot read `far.bin`: {why}; {end}")]);
}

#[test]
fn packed_views_and_instances_of_a_missing_buffer_are_left_out() {
    let packed = two_buffers(&[FAR, NEAR].join(","), "").replace(
        r#"{"buffer": 1, "byteLength": 36}"#,
        r#"{"buffer": 1, "byteLength": 36, "extensions": {"EXT_meshopt_compression": {"buffer": 1,
            "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES"}}}"#,
    );
    let model = read(&packed).unwrap();
    assert_eq!(model.scene.triangle_count(), 1);
    assert!(messages(&model)[0].starts_with("buffers[1].uri: cannot read `far.bin`"), "{model:?}");
    let instanced = two_buffers(NEAR, "").replace(
        r#""nodes": [{"mesh": 0}]"#,
        r#""nodes": [{"mesh": 0, "children": [1]}, {"mesh": 0, "extensions":
            {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}}]"#,
    );
    let model = read(&instanced).unwrap();
    assert_eq!((model.scene.instances.len(), messages(&model).len()), (1, 1), "{model:?}");
}

#[test]
fn a_broken_primitive_leaves_the_others() {
    let model = read(&two_buffers(&[NEAR, BROKEN, BROKEN].join(","), "")).unwrap();
    assert_eq!(model.scene.triangle_count(), 1);
    let why = "meshes[0].primitives[1].indices: index 2 is vertex 3 of 3";
    let left_out = "meshes[0].primitives[1] and 1 more primitive are left out";
    assert_eq!(messages(&model)[0], format!("{why}; {left_out}"));
    let both = read(&two_buffers(&[FAR, BROKEN].join(","), "")).unwrap_err().to_string();
    assert!(both.starts_with("buffers[1].uri: "), "the first error: {both}");
}

/// Finds every file under another name.
struct Elsewhere;

impl Resources for Elsewhere {
    fn read(&self, _: &str, _: u64) -> Result<Vec<u8>, String> {
        Ok(triangle_bytes())
    }

    fn find(&self, path: &str, limit: u64) -> Result<Found, String> {
        Ok(Found { bytes: self.read(path, limit)?, note: Some(format!("`{path}` was FAR.bin")) })
    }
}

#[test]
fn files_of_another_name_are_reported() {
    let images = r#", "images": [{"uri": "a.png"}], "textures": [{"source": 0}],
        "materials": [{"emissiveTexture": {"index": 0}}]"#;
    let text = two_buffers(FAR, images);
    let model = gltf::read(text.as_bytes(), &Elsewhere, &ReadOptions::default()).unwrap();
    let messages = messages(&model);
    assert_eq!(messages[0], "buffers[1].uri: `far.bin` was FAR.bin");
    assert_eq!(messages[1], "images[0]: `a.png` was FAR.bin");
    assert_eq!(messages.len(), 3, "the picture is none: {messages:?}");
}
