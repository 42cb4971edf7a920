//! All models of the shared test data, rendered by the command.

use crate::harness::{Ended, Folder, Picture};
use durer::scene::{Mesh, Topology};
use durer::view::topology::mesh_topology;
use durer_formats::{NoResources, ReadOptions};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Longest time of a run; a longer one counts as hanging.
const PATIENCE: Duration = Duration::from_secs(20);

/// Number of simultaneous runs; each uses one thread.
const WORKERS: usize = 2;

/// Returns the folder of the test data, if it is there.
pub fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("DURER_DATA").map_or(beside, PathBuf::from);
    let found = folder.is_dir();
    if !found {
        eprintln!("skipped: no test data in {}", folder.display());
    }
    found.then_some(folder)
}

/// Returns all files with these suffixes below a folder, in order.
fn files(folder: &Path, suffixes: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let suffix = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
            if path.is_dir() {
                folders.push(path);
            } else if suffix.is_some_and(|s| suffixes.contains(&s.as_str())) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// Renders a model at 64 × 64; `None` if it takes too long.
fn render(folder: &Folder, model: &Path, out: &str) -> Option<Ended> {
    let start = Instant::now();
    let mut command = folder.command("render --size 64x64 --threads 1 --background transparent -o");
    command.arg(out).arg(model);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Messages are few and short, so that the pipe holds them until the end.
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            return None;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Some(Ended::of(child.wait_with_output().unwrap()))
}

/// Runs a check on each model, several at a time; returns all complaints.
fn for_all(
    models: &[PathBuf],
    check: impl Fn(&Path, Option<Ended>, &Folder, &str) -> Result<(), String> + Sync,
) {
    let folder = Folder::new();
    let next = AtomicUsize::new(0);
    let complaints = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..WORKERS {
            scope.spawn(|| {
                while let Some(model) = models.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let name = models.iter().position(|m| m == model).unwrap();
                    let out = format!("{name}.png");
                    let ended = render(&folder, model, &out);
                    if let Err(complaint) = check(model, ended, &folder, &out) {
                        complaints
                            .lock()
                            .unwrap()
                            .push(format!("{}: {complaint}", model.display()));
                    }
                }
            });
        }
    });
    let mut complaints = complaints.into_inner().unwrap();
    complaints.sort();
    assert!(
        complaints.is_empty(),
        "{} of {}:\n{}",
        complaints.len(),
        models.len(),
        complaints.join("\n")
    );
}

/// Returns whether a model has triangles, none of which covers anything because their corners are collinear.
fn has_no_area(model: &Path) -> bool {
    let bytes = std::fs::read(model).unwrap();
    let name = model.to_string_lossy();
    let read = durer_formats::read_model(&bytes, &name, &NoResources, &ReadOptions::default());
    let scene = read.unwrap().scene;
    let solid = |mesh: &Mesh| mesh.topology == Topology::Triangles;
    scene.meshes.iter().all(|mesh| solid(mesh) && mesh_topology(mesh).area == 0.0)
}

const SUFFIXES: [&str; 6] = ["gltf", "glb", "obj", "stl", "ply", "3mf"];

#[test]
fn every_good_model_gives_a_picture() {
    let Some(data) = data() else { return };
    let mut models = files(&data.join("meshes"), &SUFFIXES);
    models.extend(files(&data.join("gltf"), &SUFFIXES));
    assert!(models.len() > 100, "{} models", models.len());
    for_all(&models, |model, ended, folder, out| {
        let ended = ended.ok_or("it hangs")?;
        if ended.code != 0 {
            return Err(format!("exit code {}: {}", ended.code, ended.err));
        }
        let picture = Picture::decode(&folder.read(out));
        if picture.shows_something() || has_no_area(model) {
            Ok(())
        } else {
            Err(format!("nothing to see; {}", ended.err))
        }
    });
}

#[test]
fn every_bad_model_gives_a_picture_or_a_message() {
    let Some(data) = data() else { return };
    let models = files(&data.join("malformed"), &SUFFIXES);
    assert!(models.len() > 100, "{} models", models.len());
    for_all(&models, |model, ended, folder, out| {
        let ended = ended.ok_or("it hangs")?;
        let name = model.file_name().unwrap().to_string_lossy();
        match ended.code {
            0 if folder.path(out).is_file() => Ok(()),
            1 if ended.err.starts_with("durer: ") && ended.err.contains(&*name) => Ok(()),
            code => Err(format!("exit code {code}: {}", ended.err)),
        }
    });
}
