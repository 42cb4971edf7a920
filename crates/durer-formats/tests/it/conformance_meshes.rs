//! Real mesh files with known counts, and broken ones, from the shared data.

use crate::shared::{Folder, data, files};
use durer_formats::{Model, ReadOptions, read_model};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

fn read(path: &Path) -> durer_formats::Result<Model> {
    let bytes = std::fs::read(path).expect("file");
    let folder = Folder(path.parent().expect("folder").to_owned());
    read_model(&bytes, &path.to_string_lossy(), &folder, &ReadOptions::default())
}

/// Returns the triangles per file as the index states them, or the points of files without triangles.
fn expected(data: &Path) -> BTreeMap<String, (u64, bool)> {
    let index = std::fs::read_to_string(data.join("INDEX.md")).expect("index");
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let (name, counts) = (cells.get(1)?, cells.get(4)?);
        let number = |text: &str| text.split_whitespace().last()?.parse().ok();
        let triangles = counts.split_once(" t;").and_then(|(before, _)| number(before));
        let points = counts.split_once(" points;").and_then(|(before, _)| number(before));
        if !name.starts_with("meshes/") {
            return None;
        }
        Some(((*name).to_owned(), (triangles.or(points)?, triangles.is_some())))
    };
    index.lines().filter_map(row).collect()
}

#[test]
fn every_mesh_has_the_triangles_that_the_index_states() {
    let Some(data) = data() else { return };
    let expected = expected(&data);
    let mut seen = 0;
    for path in files(&data.join("meshes"), &["obj", "stl", "ply"]) {
        let name = path.strip_prefix(&data).expect("inside").to_string_lossy().into_owned();
        let model = read(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        let Some(&(count, triangles)) = expected.get(&name) else { continue };
        let scene = &model.scene;
        if triangles {
            assert_eq!(scene.triangle_count(), count, "{name}");
        } else {
            let vertices: usize = scene.meshes.iter().map(|m| m.positions.len()).sum();
            assert_eq!((scene.triangle_count(), vertices as u64), (0, count), "{name}");
        }
        seen += 1;
    }
    assert!(seen >= 50, "only {seen} files were compared");
}

#[test]
fn broken_files_give_an_error_or_a_warning() {
    let Some(data) = data() else { return };
    let suffixes = ["obj", "mtl", "stl", "ply", "off", "txt"];
    let broken = files(&data.join("malformed"), &suffixes);
    assert!(broken.len() >= 40, "{}", broken.len());
    // These are unusual but valid: a non-planar face, a triangle without area, an empty object name, no newline after
    // the last face.
    let sound = [
        "obj_longline_1MB.obj",
        "obj_nonplanar_ngon.obj",
        "stl_degenerate.stl",
        "stl_binary_header_solid.stl",
        "stl_nan_normal.stl",
        "degenerate_mesh.obj",
        "empty_name.obj",
        "eof_test.obj",
    ];
    for path in broken {
        let start = Instant::now();
        let result = read(&path);
        assert!(start.elapsed() < Duration::from_secs(2), "{}", path.display());
        let name = path.file_name().expect("name").to_string_lossy().into_owned();
        match result {
            Ok(model) => {
                for w in &model.warnings {
                    println!("{name}: warning: {w}");
                }
                let quiet = model.warnings.is_empty();
                assert_eq!(quiet, sound.contains(&name.as_str()), "{name}: {:?}", model.warnings);
            }
            Err(e) => println!("{name}: {e}"),
        }
    }
}

#[test]
fn materials_and_textures_of_the_spider() {
    let Some(data) = data() else { return };
    let model = read(&data.join("meshes/assimp/spider/spider.obj")).expect("spider");
    let scene = &model.scene;
    assert_eq!(scene.images.len(), 4, "{:?}", model.warnings);
    assert!(scene.materials.iter().any(|m| m.base_color_texture.is_some()));
    assert!(scene.meshes[0].parts.len() > 5 && scene.meshes[0].parts[0].material.is_some());
}
