//! glTF: real models, and deliberately broken files.

use durer::math::DVec3;
use durer::scene::Scene;
use durer_formats::{Error, Model, ReadOptions, Resources, Result, gltf};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Returns the folder of test data; `None`, with a note on stderr, if there is none.
fn data() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("DURER_DATA").map_or_else(beside, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: there is no folder {}", folder.display());
    None
}

/// Finds files in a folder.
struct Folder<'a>(&'a Path);

impl Resources for Folder<'_> {
    fn read(&self, path: &str, _limit: u64) -> std::result::Result<Vec<u8>, String> {
        assert!(!path.starts_with('/') && !path.split('/').any(|p| p == ".."), "{path}");
        std::fs::read(self.0.join(path)).map_err(|e| e.to_string())
    }
}

fn read(path: &Path, options: &ReadOptions) -> Result<Model> {
    let bytes = std::fs::read(path).unwrap();
    gltf::read(&bytes, &Folder(path.parent().unwrap()), options)
}

/// Models that need Draco.
const DRACO: [&str; 3] = ["Box_Draco.glb", "Duck_draco.glb", "chess-board.glb"];

/// Returns all `.gltf` and `.glb` files below a folder, sorted.
fn models(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
                found.push(path);
            }
        }
    }
    // Without the feature, files that need Draco are refused; `gltf.rs` tests this.
    if !cfg!(feature = "draco") {
        found.retain(|p| !DRACO.iter().any(|name| p.ends_with(name)));
    }
    found.sort();
    found
}

/// Models whose box in the index differs: the tool that made the index ignores sparse values, skins and the transform
/// that undoes quantization.
const OTHER_BOX: [&str; 3] =
    ["SimpleSparseAccessor.gltf", "simple_skin.gltf", "Duck_quantized.glb"];

#[test]
fn every_model_has_the_triangles_and_box_of_the_index() {
    let Some(data) = data() else { return };
    let index = std::fs::read_to_string(data.join("INDEX.md")).unwrap();
    let mut checked = 0;
    for path in models(&data.join("gltf")) {
        let model = read(&path, &ReadOptions::default())
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        model.scene.check().unwrap();
        // The cake's scene names a node that has a parent.
        let warned = path.ends_with("cakeBirthday.glb");
        assert_eq!(!model.warnings.is_empty(), warned, "{}: {:?}", path.display(), model.warnings);
        let row = format!("| {} |", path.strip_prefix(&data).unwrap().display());
        let Some(row) = index.lines().find(|l| l.starts_with(&row)) else { continue };
        let triangles = row.split(" v / ").nth(1).and_then(|r| r.split(" t").next()).unwrap();
        assert_eq!(model.scene.triangle_count(), triangles.parse::<u64>().unwrap(), "{row}");
        checked += 1;
        let numbers = row.split("bbox [").nth(1).and_then(|b| b.split("];").next());
        let Some(numbers) = numbers.filter(|_| OTHER_BOX.iter().all(|o| !row.contains(o))) else {
            continue;
        };
        let numbers: Vec<f64> =
            numbers.replace("] .. [", ", ").split(", ").map(|n| n.parse().unwrap()).collect();
        let bounds = model.scene.bounds().unwrap();
        let ours = [bounds.min.to_array(), bounds.max.to_array()].concat();
        for (ours, index) in ours.iter().zip(numbers) {
            assert!((ours - index).abs() <= 1e-3 * index.abs() + 1e-6, "{row}: {bounds:?}");
        }
    }
    assert!(checked >= 30, "{checked}");
}

/// Returns the quantities that do not depend on how a model is packed: the area and, weighted by area, the mean corner
/// of the triangles, their mean texture coordinates and normals.
fn invariants(scene: &Scene) -> [f64; 9] {
    let mut sums = [0.0; 9];
    for instance in &scene.instances {
        let (mesh, matrix) = (&scene.meshes[instance.mesh], instance.world_from_mesh);
        for t in 0..mesh.triangle_count() {
            let corners = mesh.triangle(t).map(|i| i as usize);
            let [a, b, c] = corners.map(|i| matrix.transform_point3(mesh.positions[i].as_dvec3()));
            let area = (b - a).cross(c - a).length() / 2.0;
            let mut add = |at: usize, v: &[f64]| {
                v.iter().enumerate().for_each(|(i, v)| sums[at + i] += v * area / 3.0);
            };
            add(0, &[3.0]);
            for i in corners {
                let normal = matrix.transform_vector3(mesh.normals[i].as_dvec3());
                add(1, &normal.normalize().to_array());
                add(4, &mesh.tex_coords[0][i].as_dvec2().to_array());
            }
            add(6, &(a + b + c).to_array());
        }
    }
    let area = sums[0];
    std::array::from_fn(|i| if i == 0 { area } else { sums[i] / area })
}

#[test]
fn packed_ducks_are_the_duck() {
    let Some(data) = data() else { return };
    let duck = |name: &str| {
        let model = read(&data.join("gltf").join(name), &ReadOptions::default()).unwrap();
        assert_eq!(model.scene.triangle_count(), 4212, "{name}");
        model.scene
    };
    let plain = duck("Duck.glb");
    let names = ["Duck_draco.glb", "Duck_meshopt.glb", "Duck_quantized.glb", "Duck/Duck.gltf"];
    for name in names.into_iter().filter(|n| cfg!(feature = "draco") || !DRACO.contains(n)) {
        let packed = duck(name);
        // The coarsest of the three has 14 bits for the position and 8 for the normal.
        let all = invariants(&plain).into_iter().zip(invariants(&packed));
        for (i, (a, b)) in all.enumerate() {
            assert!((a - b).abs() < 1e-3, "{name}, value {i}: {a} {b}");
        }
        let (a, b) = (plain.bounds().unwrap(), packed.bounds().unwrap());
        let step = a.size().max_element() / f64::from(1 << 14);
        assert!((a.min - b.min).abs().max_element() <= 2.0 * step, "{name}: {a:?} {b:?}");
        assert!((a.max - b.max).abs().max_element() <= 2.0 * step, "{name}: {a:?} {b:?}");
    }
    // Both were quantized alike, so meshopt must restore the same numbers in another order.
    let positions = |name: &str| {
        let mut all = duck(name).meshes[0].positions.clone();
        all.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap());
        all
    };
    assert_eq!(positions("Duck_meshopt.glb"), positions("Duck_quantized.glb"));
}

#[cfg(feature = "draco")]
#[test]
fn draco_normals_stand_on_their_triangles() {
    let Some(data) = data() else { return };
    for name in DRACO {
        let scene = read(&data.join("gltf").join(name), &ReadOptions::default()).unwrap().scene;
        let (mut right, mut all) = (0, 0);
        for mesh in &scene.meshes {
            for t in 0..mesh.triangle_count() {
                let corners = mesh.triangle(t).map(|i| i as usize);
                let [a, b, c] = corners.map(|i| mesh.positions[i]);
                let face = (b - a).cross(c - a);
                let mean: durer::math::Vec3 = corners.map(|i| mesh.normals[i]).into_iter().sum();
                all += usize::from(face.length() > 0.0);
                right += usize::from(face.dot(mean) > 0.5 * face.length());
            }
        }
        assert!(right * 1000 >= all * 995, "{name}: {right} of {all}");
    }
}

/// File, animation, seconds, and the positions of some vertices in the world.
type Pose = (&'static str, Option<&'static str>, f64, &'static [(usize, [f64; 3])]);

/// Computed from the files by an independent program with numpy: skins, morph targets, channels.
const POSES: &[Pose] = &[
    ("simple_skin.gltf", None, 0.0, &[(0, [-0.5, 0.0, 0.0]), (9, [0.5, 2.0, 0.0])]),
    (
        "simple_skin.gltf",
        Some("0"),
        1.25,
        &[(0, [-0.5, 0.0, 0.0]), (5, [0.25, 1.25, 0.0]), (9, [-1.0, 1.5, 0.0])],
    ),
    ("simple_skin.gltf", Some("0"), 99.0, &[(8, [-0.5, 2.0, 0.0]), (9, [0.5, 2.0, 0.0])]),
    (
        "AnimatedMorphCube/AnimatedMorphCube.gltf",
        None,
        0.0,
        &[(0, [1.0, -1.0, -1.0]), (5, [1.0, 1.0, 1.0])],
    ),
    (
        "AnimatedMorphCube/AnimatedMorphCube.gltf",
        Some("Square"),
        1.0,
        &[(1, [-1.0, -1.0, -1.0]), (2, [-1.0, -1.0, -0.29422]), (5, [1.0, 1.0, -0.29422])],
    ),
    (
        "AnimatedMorphCube/AnimatedMorphCube.gltf",
        Some("Square"),
        2.2,
        &[(3, [1.0, -1.0, -0.21287]), (5, [1.0, 1.0, -0.92769])],
    ),
    (
        "CesiumMan.glb",
        None,
        0.0,
        &[
            (0, [0.09343, 0.97357, -0.04871]),
            (1000, [-0.13100, 1.42330, 0.06915]),
            (3000, [0.13100, 1.42284, -0.09788]),
        ],
    ),
    (
        "CesiumMan.glb",
        Some("0"),
        0.5,
        &[
            (0, [0.10445, 0.96218, -0.01652]),
            (1000, [-0.08336, 1.42603, 0.07512]),
            (3000, [0.14602, 1.40182, -0.13366]),
        ],
    ),
    (
        "Fox/Fox.gltf",
        None,
        0.0,
        &[(0, [2.05637, 35.21442, -23.04512]), (1500, [-5.66873, 5.08781, 16.25012])],
    ),
    (
        "Fox/Fox.gltf",
        Some("Walk"),
        0.3,
        &[
            (0, [1.94988, 33.14065, -21.89386]),
            (700, [-4.50018, 42.23670, -38.81742]),
            (1500, [-5.65752, 16.14892, 45.15827]),
        ],
    ),
    (
        "Fox/Fox.gltf",
        Some("2"),
        0.9,
        &[
            (0, [3.86799, 42.17238, -26.07734]),
            (700, [-4.41290, 49.11018, -45.82759]),
            (1500, [-5.84897, 12.59881, -3.60534]),
        ],
    ),
];

#[test]
fn poses_are_those_computed_elsewhere() {
    let Some(data) = data() else { return };
    for &(name, animation, time, vertices) in POSES {
        let animation = animation.map(str::to_owned);
        let pose = animation.is_some().then_some(durer_formats::Pose { animation, time });
        let options = ReadOptions { pose, ..ReadOptions::default() };
        let scene = read(&data.join("gltf").join(name), &options).unwrap().scene;
        let instance = &scene.instances[0];
        for &(vertex, expected) in vertices {
            let local = scene.meshes[instance.mesh].positions[vertex].as_dvec3();
            let ours = instance.world_from_mesh.transform_point3(local);
            let error = (ours - DVec3::from(expected)).abs().max_element();
            assert!(error < 2e-5, "{name} at {time}: vertex {vertex} is {ours}, not {expected:?}");
        }
    }
}

/// Codes of the validator that must be errors here too, wherever they occur in a file.
const STRUCTURAL: [&str; 18] = [
    "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
    "ACCESSOR_TOO_LONG",
    "BUFFER_BYTE_LENGTH_MISMATCH",
    "GLB_CHUNK_TOO_BIG",
    "GLB_DUPLICATE_CHUNK",
    "GLB_EMPTY_CHUNK",
    "GLB_LENGTH_MISMATCH",
    "GLB_LENGTH_TOO_SMALL",
    "GLB_UNEXPECTED_END_OF_HEADER",
    "GLB_UNEXPECTED_FIRST_CHUNK",
    "IO_ERROR",
    "NODE_LOOP",
    "NODE_PARENT_OVERRIDE",
    "UNDEFINED_PROPERTY",
    "UNRESOLVED_REFERENCE",
    "UNUSED_EXTENSION_REQUIRED",
    "VALUE_NOT_IN_RANGE",
    "ACCESSOR_JOINTS_INDEX_OOB",
];

/// Codes of files that are read without a warning, and the reason why pictures do not suffer.
const HARMLESS: &[(&str, &str)] = &[
    ("ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION", "brought to unit length"),
    ("ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", "stated bounds are not used"),
    ("ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "stated bounds are not used"),
    ("ACCESSOR_INVALID_FLOAT", "not drawn; vertices that are not finite are warned about"),
    ("ACCESSOR_INVALID_IBM", "the last row of an affine matrix is not used"),
    ("ACCESSOR_INVALID_SIGN", "brought to ±1"),
    ("ACCESSOR_MAX_MISMATCH", "stated bounds are not used"),
    ("ACCESSOR_MIN_MISMATCH", "stated bounds are not used"),
    ("ACCESSOR_NON_CLAMPED", "colours above 1 are light"),
    ("ACCESSOR_NORMALIZED_INVALID", "floats are never normalized"),
    ("ACCESSOR_VECTOR3_NON_UNIT", "brought to unit length"),
    ("ANIMATION_CHANNEL_TARGET_NODE_MATRIX", "the rest pose has no animation"),
    ("ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", "stated bounds are not used"),
    ("ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT", "an error once it is posed"),
    ("BUFFER_DATA_URI_MIME_TYPE_INVALID", "buffers are bytes"),
    ("BUFFER_VIEW_INVALID_BYTE_STRIDE", "unaligned data are read all the same"),
    ("BUFFER_VIEW_TARGET_OVERRIDE", "targets are for graphics hardware"),
    ("BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", "one element needs no stride"),
    ("CAMERA_XMAG_YMAG_ZERO", "no node uses the camera"),
    ("EMPTY_ENTITY", "nothing in it is nothing to draw"),
    ("IMAGE_DATA_INVALID", "no material uses the image"),
    ("IMAGE_UNEXPECTED_EOS", "no material uses the image"),
    ("INVALID_IBM_ACCESSOR_COUNT", "no node uses the skin; an error where one does"),
    ("INVALID_URI", "no material uses the image; a buffer is an error"),
    ("MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", "missing weights are zero"),
    ("MESH_PRIMITIVE_ACCESSOR_UNALIGNED", "unaligned data are read all the same"),
    ("MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE", "without a stride it is tightly packed"),
    ("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "not drawn; an error where it is"),
    ("MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", "sets are read up to the first gap"),
    ("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "not drawn; an error where it is"),
    ("MESH_PRIMITIVE_INVALID_ATTRIBUTE", "unknown attributes are not read"),
    ("MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH", "not drawn; warned about where it is"),
    ("MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT", "not drawn; an error where it is"),
    ("MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", "a difference to nothing is not used"),
    ("MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "a set that is not there is (0, 0)"),
    ("MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "not drawn; an error where it is"),
    ("NODE_MATRIX_NON_TRS", "any affine matrix can be drawn"),
    ("NODE_MATRIX_TRS", "the matrix is taken"),
    ("NODE_SKIN_NO_SCENE", "joints need not be drawn"),
    ("ONE_OF_MISMATCH", "the first projection is taken"),
    ("SKIN_SKELETON_INVALID", "the skeleton's root is not used"),
    ("TYPE_MISMATCH", "extensions that are not read may be anything"),
    ("UNSATISFIED_DEPENDENCY", "a skin without a mesh draws nothing"),
    ("VALUE_MULTIPLE_OF", "unaligned data are read all the same"),
];

/// Returns the codes of the errors in the validator's report on a file.
fn codes(path: &Path) -> Vec<String> {
    let report = std::fs::read(format!("{}.report.json", path.display())).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    let messages = report["issues"]["messages"].as_array().cloned().unwrap_or_default();
    let errors = messages.iter().filter(|m| m["severity"] == 0);
    errors.map(|m| m["code"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn files_of_the_validator_are_refused_or_harmless() {
    let Some(data) = data() else { return };
    let mut refused = 0;
    for path in models(&data.join("malformed/gltf-validator")) {
        let codes = codes(&path);
        match read(&path, &ReadOptions::default()) {
            Err(error) => {
                refused += 1;
                assert!(!matches!(error, Error::Io(_) | Error::Library(_)), "{error}");
                assert!(!error.to_string().is_empty());
            }
            Ok(model) => {
                let structural = codes.iter().find(|c| STRUCTURAL.contains(&c.as_str()));
                assert!(structural.is_none(), "{}: {structural:?}", path.display());
                let known = |c: &String| HARMLESS.iter().any(|(h, _)| h == c);
                let unknown = codes.iter().find(|c| !known(c));
                let reported = !model.warnings.is_empty();
                assert!(reported || unknown.is_none(), "{}: {unknown:?}", path.display());
            }
        }
    }
    assert!(refused > 40, "{refused}");
}

#[test]
fn valid_files_of_the_validator_are_read() {
    let Some(data) = data() else { return };
    for path in models(&data.join("malformed/gltf-validator")) {
        // Three files that need unavailable things: a network, glTF 2.1, a missing buffer.
        let foreign = ["non_relative_uri.gltf", "min_version_valid.gltf", "named_objects.gltf"];
        if codes(&path).is_empty() && !foreign.iter().any(|f| path.ends_with(f)) {
            let result = read(&path, &ReadOptions::default());
            assert!(result.is_ok(), "{}: {}", path.display(), result.unwrap_err());
        }
    }
}

/// Broken files and the beginning of their error message; empty if they can be read.
const BROKEN: &[(&str, &str)] = &[
    ("assimp_gltf/BoxBadNormals-glTF-Binary/BoxBadNormals.glb", ""),
    ("assimp_gltf/IndexOutOfRange/AllIndicesOutOfRange.gltf", "meshes[0].primitives[0].indices: "),
    ("assimp_gltf/IndexOutOfRange/IndexOutOfRange.gltf", ""),
    ("assimp_gltf/RecursiveNodes/RecursiveNodes.gltf", "nodes[0]: "),
    ("assimp_gltf/TestNoRootNode/NoScene.gltf", ""),
    ("assimp_gltf/TestNoRootNode/SceneWithoutNodes.gltf", ""),
    ("assimp_gltf/wrongTypes/badArray.gltf", "line 44"),
    ("assimp_gltf/wrongTypes/badExtension.gltf", "line 130"),
    ("assimp_gltf/wrongTypes/badNumber.gltf", "line 132"),
    ("assimp_gltf/wrongTypes/badObject.gltf", "line 125"),
    ("assimp_gltf/wrongTypes/badUint.gltf", "line 128"),
    ("tinygltf/integer-out-of-bounds.gltf", "line 34"),
    ("tinygltf/invalid-buffer-index.gltf", "bufferViews[1]: "),
    ("tinygltf/invalid-buffer-view-index.gltf", "bufferViews[0]: "),
    ("tinygltf/invalid-primitive-indices.gltf", "bufferViews[0]: "),
    ("synthetic/glb_chunk_len_lies.glb", "byte 12: "),
    ("synthetic/glb_length_lies.glb", "byte 8: "),
    ("synthetic/glb_truncated.glb", "byte 8: "),
    ("synthetic/gltf_buffer_shorter.gltf", "buffers[0]: "),
    ("synthetic/gltf_camera_zero_fov.gltf", ""),
    ("synthetic/gltf_count_overflow.gltf", "accessors[0]: "),
    ("synthetic/gltf_node_chain_20000.gltf", ""),
    ("synthetic/gltf_node_cycle.gltf", "nodes[0]: "),
    ("synthetic/gltf_node_self_child.gltf", "nodes[0]: "),
    ("synthetic/gltf_offset_overflow.gltf", "accessors[0]: "),
    ("synthetic/gltf_scale_1e38.gltf", ""),
    ("synthetic/gltf_stride_zero_count_big.gltf", "accessors[0]: "),
    ("synthetic/gltf_uri_traversal.gltf", "buffers[0].uri: "),
    ("synthetic/gltf_valid_baseline.gltf", ""),
    ("synthetic/gltf_zero_matrix.gltf", ""),
    ("synthetic/json_nest_100k.gltf", "line 1"),
];

#[test]
fn broken_files_tell_where() {
    let Some(data) = data() else { return };
    for (name, begin) in BROKEN {
        let start = Instant::now();
        let result = read(&data.join("malformed").join(name), &ReadOptions::default());
        assert!(start.elapsed() < Duration::from_secs(2), "{name}");
        match result {
            Ok(_) => assert!(begin.is_empty(), "{name}"),
            Err(e) => {
                assert!(!begin.is_empty() && e.to_string().starts_with(begin), "{name}: {e}");
            }
        }
    }
}

#[test]
fn no_damage_of_real_files_panics() {
    let Some(data) = data() else { return };
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = |below: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % below as u64) as usize
    };
    let limits = durer_formats::Limits { decoded_bytes: 64 << 20, ..Default::default() };
    let pose = Some(durer_formats::Pose::default());
    let options = ReadOptions { limits, pose, ..ReadOptions::default() };
    let mut refused = 0;
    for name in [
        "Box_Draco.glb",
        "Duck_meshopt.glb",
        "Fox_gltfpack_cc.glb",
        "singleBlendshapeCube_sparse.glb",
    ] {
        let bytes = std::fs::read(data.join("gltf").join(name)).unwrap();
        for _ in 0..60 {
            let mut damaged = bytes.clone();
            for _ in 0..1 + next(8) {
                let at = next(damaged.len());
                damaged[at] = next(256) as u8;
            }
            refused +=
                usize::from(gltf::read(&damaged, &durer_formats::NoResources, &options).is_err());
        }
    }
    assert!(refused > 20, "{refused}");
}
