//! Polygons and polylines against a rectangle: ours against Clipper2's RectClip64 and
//! RectClipLines64, called through its C interface.

use crate::{Random, medians};
use clipper2c_sys::{
    ClipperPath64, ClipperPaths64, ClipperPoint64, clipper_allocate, clipper_delete_paths64,
    clipper_path64_of_points, clipper_path64_size, clipper_paths64, clipper_paths64_add_path,
    clipper_paths64_length, clipper_paths64_size,
};
use durer::clip::polygon::{Shapes, rectangle};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;
use std::ffi::c_void;
use std::path::Path;

#[repr(C)]
struct Rect64 {
    left: i64,
    top: i64,
    right: i64,
    bottom: i64,
}

unsafe extern "C" {
    fn clipper_paths64_rect_clip(
        mem: *mut c_void,
        rect: *mut Rect64,
        paths: *mut ClipperPaths64,
    ) -> *mut ClipperPaths64;
    fn clipper_paths64_rect_clip_lines(
        mem: *mut c_void,
        rect: *mut Rect64,
        paths: *mut ClipperPaths64,
    ) -> *mut ClipperPaths64;
}

const WORLD: f64 = 1_000_000.0;

/// Returns closed or open curves of n points that wind around a centre.
fn blobs(count: usize, n: usize, radius: f64, random: &mut Random) -> Vec<Vec<DVec2>> {
    let blob = |random: &mut Random| {
        let center = DVec2::new(random.next(), random.next()) * WORLD;
        let point = |i: usize, random: &mut Random| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            let r = radius * (0.7 + 0.3 * random.next());
            (center + DVec2::new(angle.cos(), angle.sin()) * r).round()
        };
        (0..n).map(|i| point(i, random)).collect()
    };
    (0..count).map(|_| blob(random)).collect()
}

unsafe fn to_clipper(curves: &[Vec<DVec2>]) -> *mut ClipperPaths64 {
    unsafe {
        let paths = clipper_paths64(clipper_allocate(clipper_paths64_size()));
        for curve in curves {
            let mut points: Vec<_> =
                curve.iter().map(|p| ClipperPoint64 { x: p.x as i64, y: p.y as i64 }).collect();
            let path: *mut ClipperPath64 = clipper_path64_of_points(
                clipper_allocate(clipper_path64_size()),
                points.as_mut_ptr(),
                points.len(),
            );
            clipper_paths64_add_path(paths, path);
        }
        paths
    }
}

type RectClip =
    unsafe extern "C" fn(*mut c_void, *mut Rect64, *mut ClipperPaths64) -> *mut ClipperPaths64;

fn clipper(f: RectClip, paths: *mut ClipperPaths64) -> f64 {
    let (lo, hi) = ((WORLD * 0.25) as i64, (WORLD * 0.75) as i64);
    let mut rect = Rect64 { left: lo, top: lo, right: hi, bottom: hi };
    // SAFETY: `paths` was made by `to_clipper`; the result is deleted before it is lost.
    unsafe {
        let result = f(clipper_allocate(clipper_paths64_size()), &mut rect, paths);
        let count = clipper_paths64_length(result) as f64;
        clipper_delete_paths64(result);
        count
    }
}

/// Writes the curves for `geos.py`: their number, the points of each, and all coordinates, little endian.
fn write(path: &Path, curves: &[Vec<DVec2>]) -> std::io::Result<()> {
    let mut bytes = Vec::new();
    for number in [curves.len(), curves.first().map_or(0, Vec::len)] {
        bytes.extend((number as u64).to_le_bytes());
    }
    for point in curves.iter().flatten() {
        bytes.extend(point.x.to_le_bytes());
        bytes.extend(point.y.to_le_bytes());
    }
    std::fs::write(path, bytes)
}

/// Measures; where a folder is named, the polygons are left there.
pub fn run(folder: Option<&Path>) {
    let window = Rect::new(DVec2::splat(WORLD * 0.25), DVec2::splat(WORLD * 0.75)).unwrap();
    let cases = [("10^5 × 16", 100_000, 16, WORLD * 0.002), ("4 × 100k", 4, 100_000, WORLD * 0.4)];
    for (name, count, n, radius) in cases {
        let curves = blobs(count, n, radius, &mut Random(3));
        if let Some(folder) = folder {
            write(&folder.join(format!("{count}x{n}.f64")), &curves).unwrap();
        }
        // SAFETY: lives until the end of the program.
        let paths = unsafe { to_clipper(&curves) };
        let shapes = Shapes::from_rings(&curves);
        println!("polygons {name}, window a quarter of the world, per call:");
        medians(
            &mut [
                ("Clipper2 RectClip64", &mut || clipper(clipper_paths64_rect_clip, paths)),
                ("durer rectangle::clip", &mut || {
                    rectangle::clip(&window, &shapes, &rectangle::Options, &mut NoTrace)
                        .unwrap()
                        .ring_count() as f64
                }),
            ],
            1,
        );
        let points: Vec<DVec2> = curves.iter().flatten().copied().collect();
        let ends: Vec<usize> = (1..=count).map(|i| i * n).collect();
        println!("polylines {name}, per call:");
        medians(
            &mut [
                ("Clipper2 RectClipLines64", &mut || {
                    clipper(clipper_paths64_rect_clip_lines, paths)
                }),
                ("durer rectangle::clip_lines", &mut || {
                    rectangle::clip_lines(&window, &points, &ends, false).unwrap().ends.len() as f64
                }),
            ],
            1,
        );
    }
}
