//! glTF: small files written by the tests, each for one thing.

use durer::math::{DVec2, DVec3, Vec2, Vec3, Vec4};
use durer::scene::{
    AlphaMode, LightKind, MipFilter, Projection, ShadingModel, TextureFilter, Topology, Wrap,
};
use durer_formats::{
    Error, Limits, Model, NoResources, Place, Pose, ReadOptions, Resources, Result, gltf,
};
use std::cell::RefCell;

/// Bytes of numbers, little endian.
macro_rules! bytes {
    ($($type:ty: [$($value:expr),* $(,)?]),* $(,)?) => {{
        let mut bytes: Vec<u8> = Vec::new();
        $($(bytes.extend(<$type>::to_le_bytes($value));)*)*
        bytes
    }};
}

/// Returns a data URI in percent notation.
pub fn uri(bytes: &[u8]) -> String {
    let digits: String = bytes.iter().map(|b| format!("%{b:02x}")).collect();
    format!("data:,{digits}")
}

/// Returns a file of one buffer, with a view over all of it, and the members given.
pub fn file(buffer: &[u8], members: &str) -> String {
    let (uri, length) = (uri(buffer), buffer.len());
    format!(
        r#"{{"asset": {{"version": "2.0"}},
        "buffers": [{{"uri": "{uri}", "byteLength": {length}}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {length}}}],
        {members}}}"#
    )
}

/// The positions of a triangle, its accessor, and a mesh of it.
pub const TRIANGLE: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
pub const ACCESSOR: &str =
    r#"{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}"#;

pub fn triangle_bytes() -> Vec<u8> {
    TRIANGLE.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Returns a file of one triangle as mesh 0, with the members given.
pub fn triangle(members: &str) -> String {
    let mesh = r#"{"name": "t", "primitives": [{"attributes": {"POSITION": 0}}]}"#;
    let members = format!(r#""accessors": [{ACCESSOR}], "meshes": [{mesh}], {members}"#);
    file(&triangle_bytes(), &members)
}

pub fn read(text: &str) -> Result<Model> {
    gltf::read(text.as_bytes(), &NoResources, &ReadOptions::default())
}

pub fn scene(text: &str) -> durer::scene::Scene {
    read(text).unwrap().scene
}

pub fn error(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

/// Returns a binary file of a JSON text and a binary chunk.
pub fn binary(json: &str, bin: &[u8]) -> Vec<u8> {
    let json = format!("{json}{}", " ".repeat(json.len().wrapping_neg() % 4));
    let length = (12 + 8 + json.len() + 8 + bin.len()) as u32;
    let mut file = bytes![u32: [0x4654_6c67, 2, length, json.len() as u32, 0x4e4f_534a]];
    file.extend(json.as_bytes());
    file.extend(bytes![u32: [bin.len() as u32, 0x004e_4942]]);
    file.extend(bin);
    file
}

#[test]
fn text_and_binary_are_reported_apart() {
    assert!(gltf::sniff(br#" {"asset": {}}"#) && gltf::sniff(b"glTF\x02\0\0\0"));
    assert!(!gltf::sniff(b"{\"type\": \"FeatureCollection\"}") && !gltf::sniff(b"solid asset"));
    let json = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 36}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "accessors": [{ACCESSOR}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}], "nodes": [{{"mesh": 0}}]}}"#
    );
    let model =
        gltf::read(&binary(&json, &triangle_bytes()), &NoResources, &ReadOptions::default())
            .unwrap();
    assert_eq!((model.format.as_str(), model.scene.triangle_count()), ("glTF 2.0 binary", 1));
    assert_eq!(model.scene.meshes[0].positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn nodes_are_drawn_depth_first_and_share_meshes() {
    let scene = scene(&triangle(
        r#""scene": 1, "scenes": [{"nodes": [4]}, {"nodes": [3, 0]}], "nodes": [
        {"name": "a", "mesh": 0, "translation": [1, 2, 3], "scale": [2, 2, 2], "children": [2, 1]},
        {"name": "b", "mesh": 0, "rotation": [0, 0, 1, 0]},
        {"name": "c", "mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,0,0,1]},
        {"name": "d", "mesh": 0}, {"name": "other", "mesh": 0}]"#,
    ));
    let names: Vec<&str> = scene.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["d", "a", "c", "b"]);
    assert_eq!(scene.meshes.len(), 1);
    let at = |i: usize| scene.instances[i].world_from_mesh.transform_point3(DVec3::X);
    assert_eq!(
        [at(0), at(1), at(2)],
        [DVec3::X, DVec3::new(3.0, 2.0, 3.0), DVec3::new(13.0, 2.0, 3.0)]
    );
    assert!((at(3) - DVec3::new(-1.0, 2.0, 3.0)).length() < 1e-12);
}

#[test]
fn a_file_without_scenes_draws_its_roots() {
    let model = read(&triangle(
        r#""nodes": [{"name": "child", "mesh": 0}, {"name": "root", "mesh": 0, "children": [0]}]"#,
    ))
    .unwrap();
    let names: Vec<&str> = model.scene.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["root", "child"]);
    let messages: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(messages, ["scenes: there is none; all root nodes are shown"]);
}

#[test]
fn a_default_scene_that_is_missing_gives_way_to_what_there_is() {
    let shown = |scenes: &str| {
        let members = r#""nodes": [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0}]"#;
        let model = read(&triangle(&format!("{scenes} {members}"))).unwrap();
        let names = model.scene.instances.iter().map(|i| i.name.clone()).collect::<String>();
        (names, model.warnings.iter().map(ToString::to_string).collect::<String>())
    };
    let none = "scenes: there is none; all root nodes are shown";
    assert_eq!(shown(r#""scene": 0,"#), ("ab".into(), none.into()));
    let first = "scene: there is no scene 7 among 1; the first one is shown";
    assert_eq!(shown(r#""scene": 7, "scenes": [{"nodes": [1]}],"#), ("b".into(), first.into()));
}

#[test]
fn other_scenes_are_reported() {
    let messages = |scenes: &str| {
        let members = r#""nodes": [{"mesh": 0, "children": [1]}, {"mesh": 0}, {"mesh": 0}, {"name": "camera"}]"#;
        let model = read(&triangle(&format!(r#""scenes": [{scenes}], {members}"#))).unwrap();
        model.warnings.iter().map(ToString::to_string).collect::<String>()
    };
    let one = "scenes: 1 further scene has objects that are not shown; --scene chooses it";
    assert_eq!(messages(r#"{"nodes": [0]}, {"nodes": [2]}"#), one);
    let two = "scenes: 2 further scenes have objects that are not shown; --scene chooses one";
    assert_eq!(messages(r#"{"nodes": [0]}, {"nodes": [0, 2]}, {"nodes": [2]}"#), two);
    assert_eq!(messages(r#"{"nodes": [0, 2]}, {"nodes": [2]}, {"nodes": [3]}, {}"#), "");
}

#[test]
fn scenes_are_chosen_by_name_or_number() {
    let nodes = r#""nodes": [{"name": "a", "mesh": 0}, {"name": "b", "mesh": 0}, {"name": "c", "mesh": 0}]"#;
    let scenes = r#""scenes": [{"nodes": [0]}, {"name": "0", "nodes": [1]}, {"nodes": [2]}]"#;
    let file = triangle(&format!(r#""scene": 2, {scenes}, {nodes}"#));
    let shown = |scene: Option<&str>| {
        let options = ReadOptions { scene: scene.map(str::to_owned), ..ReadOptions::default() };
        durer_formats::gltf::read(file.as_bytes(), &NoResources, &options).map(|model| {
            assert_eq!(model.scenes, ["scene0", "0", "scene2"]);
            assert_eq!(model.warnings.is_empty(), scene.is_some(), "{:?}", model.warnings);
            model.scene.instances.iter().map(|i| i.name.clone()).collect::<String>()
        })
    };
    for (scene, name) in [(None, "c"), (Some("scene0"), "a"), (Some("0"), "b"), (Some("2"), "c")] {
        assert_eq!(shown(scene).unwrap(), name, "{scene:?}");
    }
    let messages = shown(Some("3")).unwrap_err().to_string();
    assert_eq!(messages, "scenes: there is no scene `3`; there are scene0, 0, scene2");
}

#[test]
fn the_centre_of_a_model_on_the_globe_is_added() {
    let file = |extension: &str| {
        triangle(&format!(
            r#"{extension} "nodes": [{{"mesh": 0, "translation": [1, 2, 3], "children": [1]}}, {{"mesh": 0}}]"#
        ))
    };
    let places = |text: &str| {
        let model = read(text).unwrap();
        assert!(!model.warnings.iter().any(|w| w.message.contains("RTC")), "{:?}", model.warnings);
        let at = |i: &durer::scene::Instance| i.world_from_mesh.w_axis.truncate().to_array();
        model.scene.instances.iter().map(at).collect::<Vec<_>>()
    };
    let rtc = r#""extensionsUsed": ["CESIUM_RTC"], "extensions": {"CESIUM_RTC": {"center": [4e6, 5e5, 5.5e6]}},"#;
    assert_eq!(places(&file("")), [[1.0, 2.0, 3.0]; 2]);
    // Its z axis points up.
    assert_eq!(places(&file(rtc)), [[4_000_001.0, 5_500_002.0, -499_997.0]; 2]);
}

#[test]
fn trees_must_be_trees() {
    let nodes = |nodes: &str| error(&triangle(&format!(r#""nodes": [{nodes}]"#)));
    assert!(nodes(r#"{"children": [1]}, {"children": [0]}"#).starts_with("nodes[0]: "));
    assert!(nodes(r#"{"children": [0]}"#).contains("its own ancestor"));
    assert!(nodes(r#"{"children": [2]}, {"children": [2]}, {}"#).contains("two parents"));
    assert!(nodes(r#"{"children": [1, 1]}, {}"#).contains("two parents"));
    assert!(nodes(r#"{"children": [7]}"#).contains("no node 7: there is 1"));
}

#[test]
fn trees_may_be_deep() {
    // Every node moves its children by one along x and turns them by half a turn around x.
    let node = |i: usize| {
        format!(r#"{{"children": [{i}], "matrix": [1,0,0,0, 0,-1,0,0, 0,0,-1,0, 1,0,0,1]}}"#)
    };
    let chain: Vec<String> = (1..100_000).map(node).collect();
    let text = triangle(&format!(r#""nodes": [{}, {{"mesh": 0}}]"#, chain.join(",")));
    let scene = scene(&text);
    let place = scene.instances[0].world_from_mesh;
    // 99,999 half turns equal one.
    assert_eq!(place.transform_point3(DVec3::ONE), DVec3::new(100_000.0, -1.0, -1.0));
    // All nodes are in the scene, the last first: each also has its parent there.
    let all: Vec<String> = (0..100_000).rev().map(|i| i.to_string()).collect();
    let text = text.replace(
        r#""nodes": ["#,
        &format!(r#""scenes": [{{"nodes": [{}]}}], "nodes": ["#, all.join(",")),
    );
    assert_eq!(self::scene(&text).instances.len(), 1);
    let closed = text.replace(r#"{"mesh": 0}]"#, r#"{"mesh": 0, "children": [0]}]"#);
    assert!(error(&closed).contains("its own ancestor"));
}

#[test]
fn accessors_without_data_are_no_larger_than_those_with_data() {
    let of = |count: u32| {
        let accessor = ACCESSOR.replace(r#""bufferView": 0, "#, "");
        let accessor = accessor.replace(r#""count": 3"#, &format!(r#""count": {count}"#));
        let mesh = r#"{"primitives": [{"attributes": {"POSITION": 0}}]}"#;
        let members = format!(
            r#""accessors": [{accessor}], "meshes": [{mesh}], "nodes": [{{"mesh": 0}}],
            "scenes": [{{"nodes": [0]}}]"#
        );
        read(&file(&triangle_bytes(), &members))
    };
    assert_eq!(of(3).unwrap().scene.triangle_count(), 1);
    let messages = of(100_000_000).unwrap_err().to_string();
    assert!(
        messages.contains("an accessor of 100000000 elements has no `bufferView`"),
        "{messages}"
    );
}

#[test]
fn accessors_may_be_interleaved_sparse_and_normalized() {
    // Three vertices of 16 bytes: a float x, padding, RGB in bytes, padding; then the sparse data.
    let mut data = Vec::new();
    for (i, rgb) in [[255u8, 0, 0], [0, 255, 0], [51, 0, 102]].iter().enumerate() {
        data.extend(bytes![f32: [i as f32, 0.0, 0.0]]);
        data.extend(rgb);
        data.push(9);
    }
    data.extend(bytes![u16: [1, 2], f32: [7.0, 8.0, 9.0, 4.0, 5.0, 6.0]]);
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{}", "byteLength": 76}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 48, "byteStride": 16}},
            {{"buffer": 0, "byteOffset": 48, "byteLength": 4}},
            {{"buffer": 0, "byteOffset": 52, "byteLength": 24}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse":
                {{"count": 2, "indices": {{"bufferView": 1, "componentType": 5123}},
                "values": {{"bufferView": 2}}}}}},
            {{"bufferView": 0, "byteOffset": 12, "componentType": 5121, "normalized": true,
                "count": 3, "type": "VEC3"}},
            {{"componentType": 5126, "count": 3, "type": "VEC3", "sparse":
                {{"count": 1, "indices": {{"bufferView": 1, "componentType": 5123}},
                "values": {{"bufferView": 2}}}}}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "COLOR_0": 1}}}},
            {{"attributes": {{"POSITION": 2}}}}]}}], "nodes": [{{"mesh": 0}}]}}"#,
        uri(&data)
    );
    let all = scene(&text);
    let mesh = &all.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::new(7.0, 8.0, 9.0), Vec3::new(4.0, 5.0, 6.0)]);
    assert_eq!(
        mesh.colors,
        [
            Vec4::new(1.0, 0.0, 0.0, 1.0),
            Vec4::new(0.0, 1.0, 0.0, 1.0),
            Vec4::new(0.2, 0.0, 0.4, 1.0)
        ]
    );
    assert_eq!(all.meshes[1].positions[1], Vec3::new(7.0, 8.0, 9.0));
    assert_eq!(all.meshes[1].positions[2], Vec3::ZERO);
    // The sparse index 2 becomes 3, which is out of range.
    let wrong = text.replace("%01%00%02%00", "%01%00%03%00");
    let model = read(&wrong).unwrap();
    let messages = model.warnings[1].to_string();
    assert!(messages.starts_with("accessors[0].sparse.indices: "), "{messages}");
    assert!(messages.ends_with("meshes[0].primitives[0] is left out"), "{messages}");
}

#[test]
fn strips_and_fans_keep_their_winding() {
    let positions = [0.0f32, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let mut data = Vec::new();
    positions.chunks(2).for_each(|p| data.extend(bytes![f32: [p[0], p[1], 0.0]]));
    let file = |mode: u32| {
        file(
            &data,
            &format!(
                r#""accessors": [{{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}}],
                "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "mode": {mode}}}]}}],
                "nodes": [{{"mesh": 0}}]"#
            ),
        )
    };
    let strip = &scene(&file(5)).meshes[0];
    for t in 0..2 {
        let [a, b, c] = strip.triangle(t).map(|i| strip.positions[i as usize]);
        assert!((b - a).cross(c - a).z > 0.0, "{t}");
    }
    let topologies = [0, 1, 2, 3, 4, 5, 6].map(|m| {
        let mesh = &scene(&file(m)).meshes[0];
        (mesh.topology, mesh.primitive_count())
    });
    use Topology::*;
    let expected = [
        (Points, 4),
        (Lines, 2),
        (Lines, 4),
        (Lines, 3),
        (Triangles, 1),
        (Triangles, 2),
        (Triangles, 2),
    ];
    assert_eq!(topologies, expected);
    assert!(error(&file(7)).starts_with("meshes[0].primitives[0].mode: "));
}

#[test]
fn broken_primitives_tell_their_path() {
    let primitive = |accessors: &str, primitive: &str| {
        let mut data = triangle_bytes();
        data.extend(bytes![u16: [0, 1, 3]]);
        error(&file(
            &data,
            &format!(
                r#""accessors": [{ACCESSOR}, {accessors}],
                "meshes": [{{"primitives": [{primitive}]}}], "nodes": [{{"mesh": 0}}]"#
            ),
        ))
    };
    let indices = r#"{"bufferView": 0, "byteOffset": 36, "componentType": 5123, "count": 3, "type": "SCALAR"}"#;
    let message = primitive(indices, r#"{"attributes": {"POSITION": 0}, "indices": 1}"#);
    assert_eq!(message, "meshes[0].primitives[0].indices: index 2 is vertex 3 of 3");
    let message = primitive(indices, r#"{"attributes": {"POSITION": 1}}"#);
    assert!(message.starts_with("meshes[0].primitives[0].attributes.POSITION: "), "{message}");
    let two = r#"{"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3"}"#;
    let message = primitive(two, r#"{"attributes": {"POSITION": 0, "NORMAL": 1}}"#);
    assert!(message.starts_with("meshes[0].primitives[0].attributes.NORMAL: "), "{message}");
    let message = primitive(two, r#"{"attributes": {"POSITION": 0}, "indices": 1}"#);
    assert!(message.starts_with("meshes[0].primitives[0].indices: "), "{message}");
    let message = primitive(two, r#"{"attributes": {"POSITION": 0}, "material": 3}"#);
    assert_eq!(message, "meshes[0].primitives[0].material: there is no material 3, none at all");
    let huge = r#"{"bufferView": 0, "componentType": 5126, "count": 1000000000, "type": "VEC3"}"#;
    let message = primitive(huge, r#"{"attributes": {"POSITION": 1}}"#);
    assert!(message.starts_with("accessors[1]: ends at byte 12000000000"), "{message}");
    // Without a view no data limit the count, so only the limit can refuse it.
    let zeros = r#"{"componentType": 5126, "count": 1000000000, "type": "VEC3"}"#;
    let message = primitive(zeros, r#"{"attributes": {"POSITION": 1}}"#);
    assert!(message.contains("decoded size is 12000000"), "{message}");
    let early = r#"{"bufferView": 0, "byteOffset": 18446744073709551615, "componentType": 5126, "count": 3, "type": "VEC3"}"#;
    assert!(primitive(early, r#"{"attributes": {"POSITION": 0}}"#).starts_with("accessors[1]: "));
}

#[test]
fn what_has_a_corner_that_is_no_vertex_is_left_out() {
    for (mode, indices, kept, word) in [
        (4, vec![0, 1, 3, 0, 2, 1, 9, 9, 9], vec![0, 2, 1], "2 triangles"),
        (5, vec![0, 1, 2, 7], vec![0, 1, 2], "1 triangle"),
        (1, vec![8, 0, 1, 2], vec![1, 2], "1 line"),
        (0, vec![2, 65535, 0], vec![2, 0], "1 point"),
    ] {
        let mut data = triangle_bytes();
        data.extend(indices.iter().flat_map(|i: &u16| i.to_le_bytes()));
        let count = indices.len();
        let model = read(&file(
            &data,
            &format!(
                r#""accessors": [{ACCESSOR}, {{"bufferView": 0, "byteOffset": 36, "componentType": 5123,
                    "count": {count}, "type": "SCALAR"}}],
                "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1,
                    "mode": {mode}}}]}}], "nodes": [{{"mesh": 0}}]"#
            ),
        ));
        let model = model.unwrap();
        assert_eq!(model.scene.meshes[0].indices.as_ref(), Some(&kept), "mode {mode}");
        let first = indices.iter().position(|i| *i > 2).unwrap();
        let left_out =
            if word.starts_with('1') { "is left out" } else { "are left out, the first" };
        let why = format!("index {first} is vertex {} of 3", indices[first]);
        let messages = model.warnings.last().unwrap().to_string();
        let all = format!("{word} with a corner that is not a vertex {left_out}: {why}");
        assert_eq!(messages, format!("meshes[0].primitives[0]: {all}"));
    }
}

#[test]
fn extensions_are_refused_or_warned_about() {
    let nodes = r#""nodes": [{"mesh": 0}]"#;
    let required = triangle(&format!(r#"{nodes}, "extensionsRequired": ["X_shape"]"#));
    let Err(Error::Unsupported { what, .. }) = read(&required) else { panic!() };
    assert_eq!(what, "X_shape");
    let used = ["KHR_materials_iridescence", "KHR_mesh_quantization", "X_shape"];
    let model = read(&triangle(&format!(r#"{nodes}, "extensionsUsed": {used:?}"#))).unwrap();
    assert_eq!(model.extensions, used);
    let warnings: Vec<String> = model.warnings.iter().map(|w| w.message.clone()).collect();
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    assert!(warnings[0].starts_with("KHR_materials_iridescence"));
    assert!(warnings[1].starts_with("X_shape"));
    assert!(error("{}").contains("asset"));
}

#[test]
fn gltf_1_is_reported_by_name() {
    let messages =
        "asset.version: glTF 1.0 is not supported; export the model as glTF 2.0, or convert it";
    for old in [
        r#"{"asset": {"version": "1.0"}}"#,
        r#"{"asset": {"version": "1.0"}, "accessors": {}, "scenes": {}}"#,
        r#"{"accessors": {"a": {}}, "asset": {"generator": "x"}}"#,
    ] {
        assert!(error(old).starts_with(messages), "{}", error(old));
    }
    let mut file = binary("{}", b"");
    file[4] = 1;
    let error = gltf::read(&file, &NoResources, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("byte 4: glTF 1.0 (binary) is not supported"), "{error}");
}

#[test]
fn materials_are_read_whole() {
    let text = triangle(
        r#""nodes": [{"mesh": 0}], "images": [{"bufferView": 0}],
        "samplers": [{"magFilter": 9728, "minFilter": 9985, "wrapS": 33071, "wrapT": 33648}],
        "textures": [{"source": 0, "sampler": 0}, {}],
        "materials": [{"name": "m", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
            "emissiveFactor": [1, 0.5, 0], "normalTexture": {"index": 0, "scale": 2},
            "occlusionTexture": {"index": 0, "strength": 0.5},
            "pbrMetallicRoughness": {"metallicFactor": 0.25, "baseColorFactor": [1, 0, 0, 0.5],
                "baseColorTexture": {"index": 0, "texCoord": 1, "extensions": {
                    "KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 3], "texCoord": 2}}}},
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}},
            {"alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}},
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}},
            {"extensions": {"KHR_materials_pbrSpecularGlossiness":
                {"diffuseFactor": [0, 1, 0, 1], "glossinessFactor": 0.75}}}]"#,
    );
    let model = read(&text).unwrap();
    let [m, unlit, glossy] = model.scene.materials.as_slice() else { panic!() };
    assert_eq!((m.name.as_str(), m.model), ("m", ShadingModel::MetallicRoughness));
    assert_eq!(m.alpha_mode, AlphaMode::Mask { cutoff: 0.25 });
    assert!(m.double_sided && !unlit.double_sided);
    assert_eq!(m.emissive, Vec3::new(4.0, 2.0, 0.0));
    assert_eq!((m.metallic, m.roughness), (0.25, 1.0));
    assert_eq!((m.normal_scale, m.occlusion_strength), (2.0, 0.5));
    let base = m.base_color_texture.unwrap();
    assert_eq!((base.texture, base.tex_coord), (0, 2));
    assert_eq!(base.transform.transform_point2(DVec2::ONE), DVec2::new(2.5, 3.25));
    assert_eq!((unlit.model, unlit.alpha_mode), (ShadingModel::Unlit, AlphaMode::Blend));
    // Its specular factor keeps the default 1: everything is reflected, nothing scattered.
    assert!(glossy.metallic > 1.0 - 1e-6 && glossy.roughness == 0.25);
    assert!((glossy.base_color - Vec4::ONE).length() < 1e-6);
    let sampler = model.scene.textures[0].sampler;
    assert_eq!(
        (sampler.mag, sampler.min, sampler.mip),
        (TextureFilter::Nearest, TextureFilter::Linear, MipFilter::Nearest)
    );
    assert_eq!((sampler.wrap_u, sampler.wrap_v), (Wrap::ClampToEdge, Wrap::MirroredRepeat));
    // The image is invalid and texture 1 has none: both are white, each with a warning.
    assert!(model.scene.images.iter().all(|i| i.data.is_empty()));
    let places: Vec<&Place> = model.warnings.iter().map(|w| &w.place).collect();
    let expected = ["scenes", "textures[1]", "images[0]"].map(|at| Place::Path(at.into()));
    assert_eq!(places, expected.iter().collect::<Vec<_>>());
}

/// Answers every request with nothing, and records it.
#[derive(Default)]
struct Asked(RefCell<Vec<String>>);

impl Resources for Asked {
    fn read(&self, path: &str, _: u64) -> std::result::Result<Vec<u8>, String> {
        self.0.borrow_mut().push(path.to_owned());
        Err("no".to_owned())
    }
}

#[test]
fn references_stay_in_the_folder() {
    let file = |uri: &str| {
        triangle(&format!(
            r#""nodes": [{{"mesh": 0}}], "images": [{{"uri": "{uri}"}}],
            "textures": [{{"source": 0}}],
            "materials": [{{"emissiveTexture": {{"index": 0}}}}]"#
        ))
    };
    let requested = Asked::default();
    let read = |uri: &str| gltf::read(file(uri).as_bytes(), &requested, &ReadOptions::default());
    let model = read("./maps/a%20b%2epng").unwrap();
    assert_eq!(*requested.0.borrow(), ["maps/a b.png"]);
    assert!(model.warnings[1].to_string().contains("cannot read `./maps/a%20b%2epng`: no"));
    for bad in
        ["../a.png", "http://h/a.png", "/a.png", "a/%2e%2e/%2e%2e/b", "%5c%5ch%5ca", "c:\\\\a"]
    {
        let model = read(bad).unwrap();
        let messages = model.warnings[1].to_string();
        assert!(
            messages.starts_with("images[0]: cannot read") && messages.ends_with("drawn white"),
            "{messages}"
        );
        assert_eq!(model.scene.triangle_count(), 1);
    }
    assert_eq!(requested.0.borrow().len(), 1);
    for (written, path) in [("maps\\\\a.png", "maps/a.png"), ("100%.png", "100%.png")] {
        read(written).unwrap();
        assert_eq!(requested.0.borrow().last().unwrap(), path);
    }
}

#[test]
fn cameras_and_lights_stand_in_the_world() {
    let model = read(&triangle(
        r#""nodes": [{"mesh": 0}, {"name": "n", "camera": 0, "translation": [0, 0, 5]},
            {"camera": 1, "rotation": [0, 1, 0, 0]}, {"camera": 2}, {"camera": 0},
            {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}}],
        "cameras": [{"perspective": {"yfov": 0.5, "znear": 0.01, "aspectRatio": 1.5}},
            {"name": "o", "orthographic": {"xmag": 4, "ymag": 2, "znear": 0, "zfar": 10}},
            {"perspective": {"yfov": 0, "znear": 1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 6, "color": [1, 0.5, 0], "range": 9,
                "spot": {"outerConeAngle": 0.5}},
            {"type": "directional", "intensity": 100000}, {"type": "area"}]}}"#,
    ))
    .unwrap();
    let names: Vec<&str> = model.scene.cameras.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["n", "o", "camera2"]);
    let [first, second, _] = model.scene.cameras.as_slice() else { panic!() };
    assert_eq!((first.camera.eye, first.camera.target), (DVec3::Z * 5.0, DVec3::Z * 4.0));
    assert_eq!(first.camera.projection, Projection::Perspective { fov_y: 0.5 });
    assert!(first.camera.far > 6.0 && first.aspect == Some(1.5));
    assert_eq!(second.camera.projection, Projection::Orthographic { height: 4.0 });
    assert!((second.camera.target - DVec3::Z).length() < 1e-12 && second.aspect == Some(2.0));
    let [spot, sun] = model.scene.lights.as_slice() else { panic!() };
    let pi = std::f64::consts::PI;
    assert_eq!(spot.color, (DVec3::new(6.0, 3.0, 0.0) / pi).as_vec3());
    let LightKind::Spot { position, direction, range, inner, outer } = spot.kind else { panic!() };
    assert_eq!((position, direction), (DVec3::new(1.0, 2.0, 3.0), -DVec3::Z));
    assert_eq!((range, inner, outer), (Some(9.0), 0.0, 0.5));
    assert_eq!(sun.kind, LightKind::Directional { direction: -DVec3::Z });
    // All lights have the same unit, however strong the others are.
    assert_eq!(sun.color, (DVec3::ONE * 1e5 / pi).as_vec3());
    assert_eq!(model.warnings.len(), 3, "{:?}", model.warnings);
}

/// Returns a triangle with a morph target that lifts it by one, a skin of two joints, and an animation that increases
/// the weight and moves joint 1.
fn posed(pose: Option<Pose>, members: &str) -> Result<Model> {
    let data = bytes![
        f32: [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        f32: [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0],
        f32: [0.0, 2.0, 0.0, 1.0],
        f32: [0.0, 0.0, 0.0, 0.0, 4.0, 0.0],
        u8: [0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0],
        f32: [1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
    ];
    let accessor = |offset: usize, component: u32, count: usize, shape: &str| {
        format!(
            r#"{{"bufferView": 0, "byteOffset": {offset}, "componentType": {component},
            "count": {count}, "type": "{shape}"}}"#
        )
    };
    let accessors = [
        accessor(0, 5126, 3, "VEC3"),
        accessor(36, 5126, 3, "VEC3"),
        accessor(72, 5126, 2, "SCALAR"),
        accessor(80, 5126, 2, "SCALAR"),
        accessor(88, 5126, 2, "VEC3"),
        accessor(112, 5121, 3, "VEC4"),
        accessor(124, 5126, 3, "VEC4"),
    ]
    .join(",");
    let text = file(
        &data,
        &format!(
            r#""accessors": [{accessors}], "meshes": [{{"primitives": [{{"attributes":
            {{"POSITION": 0, "JOINTS_0": 5, "WEIGHTS_0": 6}}, "targets": [{{"POSITION": 1}}]}}]}}],
            "animations": [{{"name": "still", "samplers": [], "channels": []}},
            {{"name": "go", "samplers": [{{"input": 2, "output": 3}}, {{"input": 2, "output": 4,
                "interpolation": "STEP"}}],
            "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}},
                {{"sampler": 1, "target": {{"node": 2, "path": "translation"}}}}]}}], {members}"#
        ),
    );
    gltf::read(text.as_bytes(), &NoResources, &ReadOptions { pose, ..ReadOptions::default() })
}

/// Returns the posed triangle's corners in the world.
fn corners(model: &Model) -> [DVec3; 3] {
    let instance = &model.scene.instances[0];
    let positions = &model.scene.meshes[instance.mesh].positions;
    [0, 1, 2].map(|i| instance.world_from_mesh.transform_point3(positions[i].as_dvec3()))
}

fn at(animation: &str, time: f64) -> Option<Pose> {
    Some(Pose { animation: Some(animation.to_owned()), time })
}

#[test]
fn morph_targets_follow_their_weights() {
    let nodes = r#""nodes": [{"mesh": 0, "weights": [0.25]}, {}, {}]"#;
    let z = |pose| corners(&posed(pose, nodes).unwrap()).map(|p| p.z);
    assert_eq!(z(None), [0.25; 3]);
    assert_eq!(z(at("still", 1.0)), [0.25; 3]);
    assert_eq!(z(at("go", -1.0)), [0.0; 3]);
    assert_eq!(z(at("go", 1.5)), [0.75; 3]);
    assert_eq!(z(at("1", 99.0)), [1.0; 3]);
    let model = posed(None, nodes).unwrap();
    assert_eq!(model.animations, ["still", "go"]);
    let missing = posed(at("run", 0.0), nodes).unwrap_err().to_string();
    assert!(missing.contains("no animation `run`; there are still, go"), "{missing}");
    assert!(posed(at("go", f64::NAN), nodes).is_err());
}

#[test]
fn skins_ignore_their_nodes_place() {
    // Joint 0 at x + 10, joint 1 its child at y + 2 (the animation: 4 from second 2 on).
    let nodes = r#""nodes": [{"mesh": 0, "skin": 0, "translation": [99, 0, 0]},
        {"translation": [10, 0, 0], "children": [2]}, {"translation": [0, 2, 0]}],
        "skins": [{"joints": [1, 2]}]"#;
    let corners = |pose| corners(&posed(pose, nodes).unwrap());
    let expected = |y: f64, z: f64| {
        // Weights 1 | ½ ½ | 2 (of joint 1, normalized).
        [DVec3::new(10.0, 0.0, z), DVec3::new(11.0, y / 2.0, z), DVec3::new(10.0, 1.0 + y, z)]
    };
    assert_eq!(corners(None), expected(2.0, 0.0));
    assert_eq!(corners(at("go", 1.0)), expected(0.0, 0.5));
    assert_eq!(corners(at("go", 2.0)), expected(4.0, 1.0));
    let one_joint = nodes.replace("[1, 2]}]", "[1]}]");
    let message = posed(None, &one_joint).unwrap_err().to_string();
    assert!(
        message.starts_with("meshes[0].primitives[0].attributes.JOINTS_0: vertex 1"),
        "{message}"
    );
}

#[test]
fn limits_are_kept() {
    let text = triangle(r#""nodes": [{"mesh": 0}, {"mesh": 0}]"#);
    let with = |limits: Limits| {
        let options = ReadOptions { limits, ..ReadOptions::default() };
        gltf::read(text.as_bytes(), &NoResources, &options)
    };
    let limited = |limits| matches!(with(limits), Err(Error::Limit { .. }));
    assert!(with(Limits { instances: 2, primitives: 1, ..Limits::default() }).is_ok());
    assert!(limited(Limits { instances: 1, ..Limits::default() }));
    assert!(limited(Limits { primitives: 0, ..Limits::default() }));
    assert!(limited(Limits { decoded_bytes: 35, ..Limits::default() }));
}

#[test]
fn several_sets_of_texture_coordinates_are_kept() {
    let mut data = triangle_bytes();
    data.extend(bytes![u16: [0, 65535, 13107, 0, 65535, 65535, 1, 2, 3, 4, 5, 6]]);
    let set = |offset: u32, normalized: bool| {
        format!(
            r#"{{"bufferView": 0, "byteOffset": {offset}, "componentType": 5123,
            "normalized": {normalized}, "count": 3, "type": "VEC2"}}"#
        )
    };
    let scene = scene(&file(
        &data,
        &format!(
            r#""accessors": [{ACCESSOR}, {}, {}], "meshes": [{{"primitives": [{{"attributes":
            {{"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}}}}]}}], "nodes": [{{"mesh": 0}}]"#,
            set(36, true),
            set(48, false)
        ),
    ));
    let sets = &scene.meshes[0].tex_coords;
    assert_eq!(sets[0], [Vec2::new(0.0, 1.0), Vec2::new(0.2, 0.0), Vec2::ONE]);
    assert_eq!(sets[1], [Vec2::new(1.0, 2.0), Vec2::new(3.0, 4.0), Vec2::new(5.0, 6.0)]);
}

/// A triangle with RGBA colours in bytes, compressed by a Draco encoder: with edgebreaker, and sequentially.
#[cfg(feature = "draco")]
const DRACO: [&str; 2] = [
    "445241434f020201010000000301010100000107ff011101010002ff0000000000010009030000000102020401010100\
     00803f0000000000000000000000000000803f0000000000000000000000000000000001010100091b5515ad2a03f56f\
     81000100cc666801cde7321a0000000000ff000000",
    "445241434f02020100000001030100010201020009030000020204010100010000000000000000000000000000803f00\
     00000000000000000000000000803f0000000000010100091b5515ad2a03047081018039201050e66c8616d00c000000\
     00ff000000",
];

/// Returns a file whose triangle is a Draco bitstream.
#[cfg(feature = "draco")]
fn draco(bytes: &[u8], normalized: bool) -> String {
    file(
        bytes,
        &format!(
            r#""accessors": [{{"componentType": 5126, "count": 3, "type": "VEC3"}},
            {{"componentType": 5121, "normalized": {normalized}, "count": 3, "type": "VEC4"}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "COLOR_0": 1}},
            "extensions": {{"KHR_draco_mesh_compression": {{"bufferView": 0,
                "attributes": {{"POSITION": 0, "COLOR_0": 1}}}}}}}}]}}],
            "nodes": [{{"mesh": 0}}], "extensionsRequired": ["KHR_draco_mesh_compression"]"#
        ),
    )
}

#[cfg(feature = "draco")]
#[test]
fn draco_attributes_are_normalized_as_the_accessor_says() {
    for hex in DRACO {
        let digits: Vec<u8> =
            hex.bytes().map(|d| (d as char).to_digit(16).unwrap() as u8).collect();
        let bytes: Vec<u8> = digits.as_chunks::<2>().0.iter().map(|[a, b]| a << 4 | b).collect();
        let all = scene(&draco(&bytes, true));
        let mesh = &all.meshes[0];
        let corner = |p: Vec3| mesh.positions.iter().position(|q| *q == p).unwrap();
        let colors = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| mesh.colors[corner(p)]);
        let expected = [[255, 0, 51, 255], [0, 255, 0, 102], [51, 51, 255, 255]];
        assert_eq!(colors, expected.map(|c| Vec4::from(c.map(|c| c as f32 / 255.0))));
        let [a, b, c] = mesh.triangle(0).map(|i| mesh.positions[i as usize]);
        assert_eq!((b - a).cross(c - a), Vec3::Z);
        assert_eq!(
            scene(&draco(&bytes, false)).meshes[0].colors.iter().map(|c| c.x).sum::<f32>(),
            306.0
        );
        for cut in 0..bytes.len() - 8 {
            let message = error(&draco(&bytes[..cut], true));
            let begin = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: ";
            assert!(message.starts_with(begin), "{cut}: {message}");
        }
    }
}

#[cfg(not(feature = "draco"))]
#[test]
fn draco_is_refused_by_name_without_the_feature() {
    let required = r#""nodes": [], "extensionsRequired": ["KHR_draco_mesh_compression"]"#;
    assert!(error(&triangle(required)).contains("KHR_draco_mesh_compression is not supported"));
}

#[test]
fn morph_targets_have_as_many_vertices() {
    let accessors = r#"{"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3"}"#;
    let text = file(
        &triangle_bytes(),
        &format!(
            r#""accessors": [{ACCESSOR}, {accessors}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"weights": [1], "primitives": [{{"attributes": {{"POSITION": 0}},
            "targets": [{{"POSITION": 1}}]}}]}}]"#
        ),
    );
    let message = error(&text);
    assert_eq!(
        message,
        "meshes[0].primitives[0].targets[0].POSITION: has 2 elements for 3 vertices"
    );
}
