//! Counts of operations of the methods for visible surfaces, on scenes whose counts are found by hand.

use crate::surface_scenes::{Prepared, of_triangles, random, three_beams};
use durer::math::{DVec3, Vec3};
use durer::pipeline::{RenderOptions, SurfaceMethod, render, render_counted};
use durer::scene::{Camera, Projection, Scene};

/// Columns and rows.
const SIDE: u32 = 16;

/// Returns the options of a picture in which a unit is a pixel, seen along −z; y is up from the lower border.
fn options(scene: &Scene, algorithm: SurfaceMethod) -> RenderOptions {
    let middle = f64::from(SIDE) / 2.0;
    let camera = Camera {
        eye: DVec3::new(middle, middle, 10.0),
        target: DVec3::new(middle, middle, 0.0),
        up: DVec3::Y,
        projection: Projection::Orthographic { height: SIDE.into() },
        near: 1.0,
        far: 19.0,
    };
    RenderOptions { algorithm, camera, ..Prepared::new(scene, SIDE, SIDE).options }
}

/// Returns a right-angled triangle with two sides of nine pixels, at a height z.
///
/// It contains the centres of 8 + 7 + … + 1 = 36 pixels, in eight rows, and touches 9 + 8 + … + 1 = 45.
fn triangle(z: f32) -> [Vec3; 3] {
    [Vec3::new(0.0, 0.0, z), Vec3::new(9.0, 0.0, z), Vec3::new(0.0, 9.0, z)]
}

fn counts(triangles: &[[Vec3; 3]], method: SurfaceMethod) -> Vec<(&'static str, u64)> {
    let scene = of_triangles(triangles);
    let counted = render_counted(&scene, &options(&scene, method)).expect("picture");
    counted.2.iter().map(|of| (of.name, of.count)).collect()
}

#[test]
fn one_triangle_is_counted_by_all_methods() {
    let of = |method| counts(&[triangle(0.0)], method);
    let pixels = [("depth-comparisons", 36), ("depths-stored", 36)];
    assert_eq!(of(SurfaceMethod::ZBuffer), pixels);
    let spans = [("activations", 1), ("triangle-spans", 8)];
    assert_eq!(of(SurfaceMethod::ScanLineZ), [spans, pixels].concat());
    // The two rows of one and two pixels are too short to be worth a span.
    assert_eq!(
        of(SurfaceMethod::SpanningScanLine),
        [("edges-passed", 16), ("visible-spans", 6), ("span-splits", 0), ("pixels-written", 3)]
    );
    let fragments = [("fragments", 45), ("longest-list", 1), ("shares", 45)];
    assert_eq!(of(SurfaceMethod::ABuffer), fragments);
    assert_eq!(
        of(SurfaceMethod::DepthSort),
        [("pairs-tested", 0), ("moves", 0), ("splits", 0), ("painted", 1)]
    );
    assert_eq!(
        of(SurfaceMethod::Warnock),
        [("windows", 1), ("triangles-listed", 1), ("divisions", 0), ("samples", 0)]
    );
    // The hierarchy is one leaf, whose box contains the centres of 9 × 9 pixels.
    assert_eq!(
        of(SurfaceMethod::Ray),
        [("rays", 256), ("boxes-tested", 256), ("triangles-tested", 81), ("hits", 36)]
    );
}

#[test]
fn the_order_of_two_triangles_changes_what_is_stored() {
    let (near, far) = (triangle(2.0), triangle(-2.0));
    for (triangles, stored) in [([near, far], 36), ([far, near], 72)] {
        let of = |method| counts(&triangles, method);
        let pixels = [("depth-comparisons", 72), ("depths-stored", stored)];
        assert_eq!(of(SurfaceMethod::ZBuffer), pixels);
        // Where the near triangle covers a whole pixel, the far one, which comes later, leaves no fragment.
        assert_eq!(of(SurfaceMethod::ABuffer)[..2], [("fragments", 54), ("longest-list", 2)]);
        assert_eq!(of(SurfaceMethod::DepthSort)[3], ("painted", 2));
        assert_eq!(of(SurfaceMethod::Ray)[2..], [("triangles-tested", 162), ("hits", 36)]);
    }
}

#[test]
fn faces_that_cross_are_split() {
    // They cross along x = 6, in the middle of both.
    let face = |slope: f32| {
        let z = |x: f32| slope * (x - 6.0);
        [Vec3::new(0.0, 0.0, z(0.0)), Vec3::new(12.0, 0.0, z(12.0)), Vec3::new(6.0, 12.0, 0.0)]
    };
    let of = |method| counts(&[face(0.3), face(-0.3)], method);
    let [.., splits, painted] = of(SurfaceMethod::DepthSort)[..] else { panic!("four counts") };
    assert_eq!((splits, painted), (("splits", 1), ("painted", 3)));
    let of = of(SurfaceMethod::Warnock);
    assert!(of[2].1 > 4, "{of:?}");
    // Each division replaces a window by four.
    assert_eq!(of[0].1, 1 + 4 * of[2].1);
}

#[test]
fn counting_changes_no_picture_and_methods_compare_the_same_pixels() {
    let scenes = [three_beams(), random(401), random(407), crate::scenes::materials()];
    for (number, scene) in scenes.iter().enumerate() {
        let counted = |method| {
            let prepared = Prepared::new(scene, 61, 47);
            let options = RenderOptions { algorithm: method, ..prepared.options };
            let (picture, _, counts) = render_counted(scene, &options).expect("picture");
            assert!(picture == render(scene, &options).expect("picture").0, "{method}");
            let depths = picture.depth.expect("depths");
            let seen = depths.data().iter().filter(|&&depth| depth < 1.0).count();
            let of = move |name: &str| counts.iter().find(|of| of.name == name).expect(name).count;
            (of, seen as u64)
        };
        let all: Vec<_> = SurfaceMethod::ALL.iter().map(|&method| counted(method)).collect();
        let [(z_buffer, _), (scan_line, _), .., (rays, seen)] = &all[..] else { panic!() };
        let compared = z_buffer("depth-comparisons");
        assert_eq!(compared, scan_line("depth-comparisons"), "scene {number}");
        assert!(z_buffer("depths-stored") <= compared, "scene {number}");
        assert_eq!(rays("hits"), *seen, "scene {number}");
    }
}
