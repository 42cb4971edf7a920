//! Every visible-surface method on every model of the shared data, and at every size.

use crate::data;
use crate::surface_scenes::{Prepared, assert_same_planes, crossing_quads, duplicates};
use durer::math::DVec3;
use durer::pipeline::{RenderOptions, Samples, SurfaceMethod, render};
use durer::scene::{Camera, Projection, Scene};
use durer::target::Framebuffer;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The Benchy, whose 225,706 triangles take each method a quarter of a second at the development
/// profile's level; `conformance_visible_surface` has views of it.
const LARGEST_FILE: u64 = 4 << 20;

fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).expect("folder");
    let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("entry").path()).collect();
    paths.sort();
    for path in paths {
        let suffix = path.extension().and_then(|s| s.to_str()).unwrap_or_default();
        if path.is_dir() {
            models(&path, found);
        } else if ["glb", "gltf", "obj", "stl", "ply"].contains(&suffix.to_lowercase().as_str()) {
            found.push(path);
        }
    }
}

fn camera(scene: &Scene, number: usize) -> Option<Camera> {
    let bounds = scene.bounds()?;
    let (center, extent) = ((bounds.min + bounds.max) * 0.5, (bounds.max - bounds.min).length());
    let extent = if extent > 0.0 { extent } else { 1.0 };
    let projection = match number % 2 {
        0 => Projection::Perspective { fov_y: 0.6 },
        _ => Projection::Orthographic { height: extent },
    };
    // From all sides, occasionally from inside.
    let (turn, away) = (number as f64 * 2.4, [1.8, 1.7, 0.3][number % 3]);
    let direction = DVec3::new(libm::sin(turn), 0.4, libm::cos(turn));
    Some(Camera {
        eye: center + direction * (extent * away),
        target: center,
        up: DVec3::Y,
        projection,
        near: extent * 0.05,
        far: extent * 4.0,
    })
}

fn planes(scene: &Scene, camera: Camera, size: [u32; 2], algorithm: SurfaceMethod) -> Framebuffer {
    let mut options = RenderOptions { algorithm, ..RenderOptions::new(camera) };
    ([options.width, options.height], options.samples) = (size, Samples::One);
    (options.item, options.depth, options.normal) = (true, true, true);
    render(scene, &options).expect("picture").0
}

/// Returns the number of covered pixels; `None` if the file cannot be read or shows nothing.
fn check(path: &Path, number: usize) -> Option<usize> {
    let model = data::try_read_model(path)?;
    let camera = camera(&model.scene, number)?;
    let mut covered = 0;
    for size in [[61, 47], [1, 1]] {
        let expected = planes(&model.scene, camera, size, SurfaceMethod::ZBuffer);
        let depths = expected.depth.iter().flat_map(|d| d.data());
        covered += depths.filter(|d| **d < 1.0).count();
        for &method in SurfaceMethod::ALL {
            let found = planes(&model.scene, camera, size, method);
            assert_same_planes(&format!("{} by {method}", path.display()), &found, &expected);
        }
    }
    Some(covered)
}

#[test]
fn all_methods_agree_on_all_models() {
    let Some(folder) = data::folder() else { return };
    let mut paths = Vec::new();
    for part in ["meshes", "gltf"] {
        models(&folder.join(part), &mut paths);
    }
    paths.retain(|p| std::fs::metadata(p).is_ok_and(|m| m.len() <= LARGEST_FILE));
    assert!(paths.len() > 90, "{}", paths.len());
    let (next, read, covered) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for _ in 0..3 {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(path) = paths.get(number) else { break };
                    match check(path, number) {
                        Some(pixels) => {
                            read.fetch_add(1, Ordering::Relaxed);
                            covered.fetch_add(pixels, Ordering::Relaxed);
                        }
                        None => println!("nothing to see: {}", path.display()),
                    }
                }
            });
        }
    });
    let (read, covered) = (read.into_inner(), covered.into_inner());
    println!("{read} of {} models, {covered} covered pixels", paths.len());
    assert!(read * 20 >= paths.len() * 19 && covered > 30_000, "{read}, {covered}");
}

#[test]
fn all_methods_agree_at_all_sizes() {
    for (scene, sides) in [
        (duplicates(), &[[1, 1], [2, 1], [3, 5], [63, 64], [65, 129], [255, 257], [512, 511]][..]),
        (crossing_quads(), &[[1024, 768], [1, 2048], [2048, 9]]),
    ] {
        for &[width, height] in sides {
            let p = Prepared::new(&scene, width, height);
            compare(&p, |_| true);
        }
    }
    // Subdivision and rays take seconds for four million pixels at the development profile's optimization level.
    let fast = |m| !matches!(m, SurfaceMethod::Warnock | SurfaceMethod::Ray);
    compare(&Prepared::new(&crossing_quads(), 2048, 2048), fast);
}

fn compare(p: &Prepared<'_>, takes_part: impl Fn(SurfaceMethod) -> bool) {
    let expected = p.by_z_buffer();
    for &algorithm in SurfaceMethod::ALL.iter().filter(|m| takes_part(**m)) {
        let options = RenderOptions { algorithm, ..p.options.clone() };
        let found = render(p.scene, &options).expect("picture").0;
        assert_same_planes(algorithm.name(), &found, &expected);
    }
}
