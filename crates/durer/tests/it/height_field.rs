//! Height fields: the inputs that they refuse, and their mesh.

use durer::Error;
use durer::math::DVec3;
use durer::scene::HeightField;

fn field(size: [usize; 2], heights: &[f64]) -> HeightField {
    HeightField::new(size, [0.0, 1.0], [0.0, 1.0], heights.to_vec()).expect("field")
}

#[test]
fn height_fields_refuse_what_is_no_grid() {
    let new = |size, x, z, n| HeightField::new(size, x, z, vec![0.0; n]);
    let (one, nan) = ([0.0, 1.0], f64::NAN);
    assert!(new([2, 2], one, one, 4).is_ok());
    assert!(new([1, 1], [3.0, 3.0], [0.0, 0.0], 1).is_ok());
    for (size, x, z, n) in [
        ([0, 2], one, one, 0),
        ([2, 2], one, one, 3),
        ([2, 2], [1.0, 0.0], one, 4),
        ([2, 2], [1.0, 1.0], one, 4),
        ([2, 2], [nan, 1.0], one, 4),
        ([2, 2], one, [0.0, f64::INFINITY], 4),
        ([2, 2], one, [-1e300, 1e300], 4),
        ([3, 1], [1e16, 1e16 + 2.0], one, 3),
    ] {
        let error = new(size, x, z, n).expect_err("no grid");
        assert!(matches!(error, Error::Parameter { .. }), "{size:?} {x:?} {z:?}: {error}");
    }
    let huge = HeightField::from_fn([usize::MAX, 9], one, one, |_, _| 0.0);
    assert!(matches!(huge, Err(Error::Limit { .. })));
}

#[test]
fn what_is_no_number_is_missing() {
    let f = field([3, 2], &[1.0, f64::NAN, f64::INFINITY, -1e200, 2.0, -3.0]);
    let heights: Vec<_> = (0..6).map(|i| f.height(i % 3, i / 3)).collect();
    assert_eq!(heights, [Some(1.0), None, None, None, Some(2.0), Some(-3.0)]);
    assert_eq!((f.range(), f.missing()), (Some([-3.0, 2.0]), 3));
    assert_eq!((f.height(3, 0), f.height(0, 2)), (None, None));
    assert_eq!(field([1, 1], &[f64::NAN]).bounds(), None);
    assert_eq!(field([1, 1], &[f64::NAN]).to_scene().triangle_count(), 0);
}

#[test]
fn the_mesh_looks_up_and_leaves_holes_open() {
    let f = HeightField::new(
        [3, 3],
        [1e6, 1e6 + 2.0],
        [-1.0, 1.0],
        vec![0.0, 1.0, f64::NAN, 0.5, 0.0, 2.0, 1.0, 1.5, 0.0],
    )
    .expect("field");
    let scene = f.to_scene();
    scene.check().expect("scene");
    let mesh = &scene.meshes[0];
    // Three of four cells have all their corners.
    assert_eq!((mesh.triangle_count(), &mesh.faces[..]), (6, &[0, 2, 4][..]));
    assert_eq!(mesh.positions.len(), 8);
    for i in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.triangle(i).map(|v| mesh.positions[v as usize].as_dvec3());
        assert!((b - a).cross(c - a).y > 0.0, "triangle {i}");
    }
    let corner = scene.instances[0].world_from_mesh.transform_point3(mesh.positions[0].as_dvec3());
    assert_eq!(corner, DVec3::new(1e6, 0.0, -1.0));
}

#[test]
fn cells_are_cut_along_the_ridge() {
    use durer::scene::Diagonal::{Falling, Rising};
    assert_eq!(field([2, 2], &[0.0, 1.0, 1.0, 0.0]).cell(0, 0), Some(Rising));
    assert_eq!(field([2, 2], &[1.0, 0.0, 0.5, 0.0]).cell(0, 0), Some(Falling));
    assert_eq!(field([2, 2], &[1.0; 4]).cell(0, 0), Some(Rising));
    assert_eq!(field([2, 2], &[1.0; 4]).cell(1, 0), None);
}

#[test]
fn a_bilinear_surface_is_the_same_at_other_points() {
    let f = |x: f64, z: f64| 1.0 + 2.0 * x - z + 3.0 * x * z;
    let make = |size| HeightField::from_fn(size, [0.0, 2.0], [1.0, 3.0], f).expect("field");
    for size in [[2, 2], [5, 3], [17, 12]] {
        let (found, expected) = (make([9, 5]).resampled(size).expect("field"), make(size));
        for row in 0..size[1] {
            for column in 0..size[0] {
                let (a, b) = (found.height(column, row), expected.height(column, row));
                assert!(a.zip(b).is_some_and(|(a, b)| (a - b).abs() < 1e-12), "{a:?} {b:?}");
            }
        }
    }
    let mut heights = vec![1.0; 9];
    heights[8] = f64::NAN;
    let found = field([3, 3], &heights).resampled([5, 5]).expect("field");
    assert_eq!((found.missing(), found.height(2, 2), found.height(3, 3)), (4, Some(1.0), None));
}
