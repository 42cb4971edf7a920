//! Barycentric coordinates, areas, perspective-correct interpolation.

use durer::math::{DVec2, DVec3};
use durer::raster::interpolate::*;
use proptest::prelude::*;

fn point2() -> impl Strategy<Value = DVec2> {
    [-50.0..50.0f64, -50.0..50.0].prop_map(DVec2::from)
}

fn point3() -> impl Strategy<Value = DVec3> {
    [-5.0..5.0f64, -5.0..5.0, -5.0..5.0].prop_map(DVec3::from)
}

fn weights() -> impl Strategy<Value = [f64; 3]> {
    [0.01..1.0f64, 0.01..1.0, 0.01..1.0].prop_map(|w| {
        let total: f64 = w.iter().sum();
        w.map(|x| x / total)
    })
}

proptest! {
    #[test]
    fn barycentric_coordinates_give_the_point_back(t in [point2(), point2(), point2()], p in point2()) {
        prop_assume!(doubled_area(t).abs() > 1.0);
        let w = barycentric_2d(t, p).unwrap();
        prop_assert!((w[0] + w[1] + w[2] - 1.0).abs() < 1e-9);
        prop_assert!((blend(w, t) - p).length() < 1e-8);
    }

    #[test]
    fn barycentric_coordinates_in_space_project_along_the_normal(
        t in [point3(), point3(), point3()], w in weights(), height in -2.0..2.0f64,
    ) {
        prop_assume!(area_3d(t) > 0.1);
        let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
        let found = barycentric_3d(t, blend(w, t) + normal * height).unwrap();
        for k in 0..3 {
            prop_assert!((found[k] - w[k]).abs() < 1e-9, "{:?} {:?}", found, w);
        }
    }

    /// Checks that the point seen through a pixel is the intersection of the pixel's ray with the plane of the
    /// triangle.
    #[test]
    fn perspective_correct_equals_ray_and_plane(t in [point3(), point3(), point3()], screen in weights()) {
        let t = t.map(|p| p - DVec3::Z * 6.0); // in front of an eye that looks down −z
        let points = t.map(|p| p.truncate() / -p.z);
        prop_assume!(doubled_area(points).abs() > 1e-2);
        let pixel = blend(screen, points);
        let ray = pixel.extend(-1.0);
        let normal = (t[1] - t[0]).cross(t[2] - t[0]);
        let hit = ray * (normal.dot(t[0]) / normal.dot(ray));
        prop_assume!(normal.normalize().dot(ray).abs() > 1e-2);

        let inv_w = t.map(|p| -1.0 / p.z);
        let weights = perspective_correct(screen, inv_w);
        prop_assert!((blend(weights, t) - hit).length() < 1e-8);

        // Plane equations over the screen give the same, for an attribute and for depth (linear after division).
        let x = PerspectivePlane::through(points, inv_w, t.map(|p| p.x)).unwrap();
        prop_assert!((x.at(pixel) - hit.x).abs() < 1e-7, "{} {}", x.at(pixel), hit.x);
        let depth = ScreenPlane::through(points, inv_w).unwrap();
        prop_assert!((depth.at(pixel) - -1.0 / hit.z).abs() < 1e-9);
    }

    #[test]
    fn a_plane_takes_its_values_at_the_corners(t in [point2(), point2(), point2()], f in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0]) {
        prop_assume!(doubled_area(t).abs() > 1.0);
        let plane = ScreenPlane::through(t, f).unwrap();
        prop_assert_eq!(plane.at(t[0]).to_bits(), f[0].to_bits());
        for k in 1..3 {
            prop_assert!((plane.at(t[k]) - f[k]).abs() < 1e-8);
        }
    }
}

#[test]
fn areas_by_the_short_formula() {
    let t = [DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 3.0)];
    assert_eq!(doubled_area(t), 12.0);
    assert_eq!(polygon_area(&t), 6.0);
    assert_eq!(polygon_area(&[t[2], t[1], t[0]]), -6.0);
    assert_eq!((polygon_area(&t[..2]), polygon_area(&[])), (0.0, 0.0));
    assert_eq!(area_3d([DVec3::ZERO, DVec3::Y * 3.0, DVec3::Z * 4.0]), 6.0);
}

#[test]
fn no_area_has_no_coordinates() {
    let line = [DVec2::ZERO, DVec2::ONE, DVec2::splat(2.0)];
    assert_eq!(barycentric_2d(line, DVec2::X), None);
    assert_eq!(barycentric_3d(line.map(|p| p.extend(0.0)), DVec3::X), None);
    assert_eq!(ScreenPlane::through(line, [1.0, 2.0, 3.0]), None);
}
