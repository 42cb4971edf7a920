//! glTF: real models, and files that are broken on purpose.

use durer::math::DVec3;
use durer::scene::Scene;
use durer_formats::{Error, Model, Place, ReadOptions, Resources, Result, gltf};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The folder of test data; `None`, said on stderr, where there is none.
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

/// All `.gltf` and `.glb` files below a folder, sorted.
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
    found.sort();
    found
}

#[test]
fn every_model_has_the_triangles_of_the_index() {
    let Some(data) = data() else { return };
    let index = std::fs::read_to_string(data.join("INDEX.md")).unwrap();
    let mut checked = 0;
    for path in models(&data.join("gltf")) {
        let model = read(&path, &ReadOptions::default())
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        model.scene.check().unwrap();
        println!(
            "{}: {:?} {:?} {:#?}",
            path.display(),
            model.format,
            model.scene.bounds(),
            model.warnings
        );
        let row = format!("| {} |", path.strip_prefix(&data).unwrap().display());
        let Some(row) = index.lines().find(|l| l.starts_with(&row)) else { continue };
        let triangles = row.split(" v / ").nth(1).and_then(|r| r.split(" t").next()).unwrap();
        assert_eq!(model.scene.triangle_count(), triangles.parse::<u64>().unwrap(), "{row}");
        checked += 1;
    }
    assert!(checked >= 30, "{checked}");
}

#[test]
fn broken_files_are_refused_or_warned_about() {
    let Some(data) = data() else { return };
    for folder in ["gltf-validator", "assimp_gltf", "tinygltf", "synthetic"] {
        for path in models(&data.join("malformed").join(folder)) {
            let begin = Instant::now();
            let result = read(&path, &ReadOptions::default());
            let took = begin.elapsed();
            assert!(took < Duration::from_secs(2), "{}: {took:?}", path.display());
            let name = path.strip_prefix(data.join("malformed")).unwrap().display().to_string();
            match &result {
                Ok(m) => println!(
                    "OK   {name} {:?}",
                    m.warnings.iter().map(|w| w.to_string()).collect::<Vec<_>>()
                ),
                Err(e) => println!("ERR  {name} {e}"),
            }
        }
    }
}
