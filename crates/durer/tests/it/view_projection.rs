//! Named views and cameras fitted to bounds.

use durer::math::{DMat4, DQuat, DVec3, Vec3};
use durer::scene::{
    Aabb, BoundingSphere, Camera, Instance, Mesh, Projection, Scene, Topology, UpAxis,
};
use durer::view::projection::*;
use proptest::prelude::*;

fn ndc(camera: &Camera, aspect: f64, p: DVec3) -> DVec3 {
    let clip = camera.clip_from_view(aspect) * camera.view_from_world() * p.extend(1.0);
    assert!(clip.w > 0.0, "{camera:?} {p}");
    clip.truncate() / clip.w
}

/// Checks that the eye is as near to the points as possible.
fn at_closest(
    camera: &Camera,
    points: impl IntoIterator<Item = DVec3> + Clone,
    d: &ViewDirection,
) -> bool {
    let radius = Aabb::around(points.clone()).map_or(0.0, |b| (b.size() * 0.5).length());
    let depths = points.into_iter().map(|p| (camera.eye - p).dot(d.to_eye()));
    depths.fold(f64::INFINITY, f64::min) <= CLOSEST * radius * (1.0 + 1e-6)
}

fn boxes() -> impl Strategy<Value = Aabb> {
    let place = prop_oneof![-5.0..5.0f64, -1e4..1e4f64];
    let size = prop_oneof![4 => 0.1..10.0f64, 1 => 10.0..1000.0f64, 1 => Just(0.0)];
    ([place.clone(), place.clone(), place], [size.clone(), size.clone(), size]).prop_map(
        |(p, s)| {
            let min = DVec3::from(p);
            Aabb { min, max: min + DVec3::from(s) }
        },
    )
}

fn options() -> impl Strategy<Value = FitOptions> {
    let lens = prop_oneof![
        (0.1..2.5f64).prop_map(|fov_y| Lens::Perspective { fov_y }),
        Just(Lens::Orthographic),
    ];
    (lens, 0.3..3.0f64, 0.0..0.3f64).prop_map(|(lens, aspect, margin)| FitOptions {
        lens,
        aspect,
        margin,
    })
}

fn directions() -> impl Strategy<Value = ViewDirection> {
    let angle = prop_oneof![-400.0..400.0f64, (-4..5i32).prop_map(|q| f64::from(q) * 90.0)];
    let axis = proptest::sample::select(UpAxis::ALL);
    (angle.clone(), angle, axis)
        .prop_map(|(a, e, axis)| ViewDirection::from_angles(a, e, axis).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn a_fitted_box_lies_in_the_frame_and_touches_it(b in boxes(), d in directions(), o in options()) {
        let camera = fit_box(Some(&b), &d, &o).unwrap();
        let frame = 1.0 - 2.0 * o.margin;
        let seen = b.corners().map(|c| ndc(&camera, o.aspect, c));
        let extreme = |k: usize, sign: f64| seen.iter().map(|p| p[k] * sign).fold(f64::MIN, f64::max);
        let sides = [[extreme(0, 1.0), extreme(0, -1.0)], [extreme(1, 1.0), extreme(1, -1.0)]];
        let slack = 1e-6;
        prop_assert!(sides.iter().flatten().all(|s| *s <= frame + slack), "{:?} {}", sides, frame);
        prop_assert!(seen.iter().all(|p| p.z.abs() < 1.0), "{:?}", seen);
        prop_assert!((camera.target - camera.eye).dot(d.to_eye()) < 0.0);
        // Two opposite sides are touched, unless the eye is as near as possible. A line may have no extent in the
        // picture.
        let line = b.size().to_array().iter().filter(|s| **s > 0.0).count() < 2;
        let touched = |s: &[f64; 2]| s.iter().all(|s| (s - frame).abs() <= slack);
        prop_assert!(
            line || at_closest(&camera, b.corners(), &d) || sides.iter().any(touched),
            "{:?} {}", sides, frame,
        );
    }

    #[test]
    fn a_fitted_sphere_lies_in_the_frame_and_touches_it(
        c in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0], radius in 0.1..20.0f64, d in directions(), o in options(),
    ) {
        let sphere = BoundingSphere { center: c.into(), radius };
        let camera = fit_sphere(Some(&sphere), &d, &o).unwrap();
        let frame = 1.0 - 2.0 * o.margin;
        // The outermost points seen from the eye: its rays touch the sphere there.
        let (mut largest, distance) = (0.0_f64, (camera.eye - sphere.center).length());
        for k in 0..720 {
            let (sin, cos) = f64::from(k).to_radians().sin_cos();
            let around = d.right() * cos + d.up() * sin;
            let lift = if o.lens == Lens::Orthographic { 0.0 } else { radius / distance };
            let p = sphere.center
                + (around * (1.0 - lift * lift).sqrt() + d.to_eye() * lift) * radius;
            let seen = ndc(&camera, o.aspect, p);
            prop_assert!(seen.abs().max_element() <= 1.0 + 1e-9);
            largest = largest.max(seen.x.abs()).max(seen.y.abs());
        }
        let free = distance > radius * (1.0 + CLOSEST) * (1.0 + 1e-9);
        prop_assert!(largest <= frame + 1e-9, "{} {}", largest, frame);
        prop_assert!(!free || largest >= frame - 1e-3, "{} {}", largest, frame);
    }
}

proptest! {
    #[test]
    fn fitted_points_lie_in_the_frame_and_touch_it(
        points in prop::collection::vec([-5.0..5.0f64, -5.0..5.0, -5.0..5.0], 3..40),
        d in directions(), o in options(),
    ) {
        let mut points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        let camera = fit_points(points.iter().copied().chain([DVec3::NAN]), &d, &o).unwrap();
        let box_camera = fit_box(Aabb::around(points.iter().copied()).as_ref(), &d, &o).unwrap();
        let frame = 1.0 - 2.0 * o.margin;
        let outermost = |camera: &Camera| {
            let seen = points.iter().map(|p| ndc(camera, o.aspect, *p));
            seen.fold(0.0_f64, |m, p| m.max(p.x.abs()).max(p.y.abs()))
        };
        prop_assert!(outermost(&camera) <= frame + 1e-9);
        let closest = at_closest(&camera, points.iter().copied(), &d);
        prop_assert!(closest || outermost(&camera) >= frame - 1e-9);
        prop_assert!(outermost(&box_camera) <= frame + 1e-9);
        // The order of the points does not matter.
        points.reverse();
        prop_assert_eq!(fit_points(points, &d, &o).unwrap(), camera);
    }
}

proptest! {
    #[test]
    fn a_scene_is_fitted_as_its_points_are(
        points in prop::collection::vec([-5.0..5.0f32, -5.0..5.0, -5.0..5.0], 3..400),
        unused in 0..3usize, far in prop_oneof![Just(0.0), Just(1e4)],
        d in directions(), o in options(),
    ) {
        let mut positions: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
        positions[1].y = f32::NAN;
        let indices = (unused == 0).then(|| (0..positions.len() as u32 - 1).collect::<Vec<_>>());
        let drawn = indices.as_ref().map_or(positions.len(), Vec::len);
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0);
        let place = DMat4::from_scale_rotation_translation(
            DVec3::new(1.0, -2.0, 0.5), turn, DVec3::new(far, 1.0, 3.0),
        );
        let world: Vec<DVec3> =
            positions[..drawn].iter().map(|p| place.transform_point3(p.as_dvec3())).collect();
        let mesh = Mesh { positions, indices, topology: Topology::Points, ..Mesh::default() };
        let instance = Instance { mesh: 0, world_from_mesh: place, name: String::new() };
        let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
        let finite = || world.iter().copied().filter(|p| p.is_finite());
        let bounds = Aabb::around(finite());
        prop_assert_eq!(drawn_bounds(&scene), bounds);
        let [nearest, farthest] = drawn_ends(&scene, d.to_eye()).unwrap().map(|p| p.dot(d.to_eye()));
        prop_assert!(finite().all(|p| (farthest..=nearest).contains(&p.dot(d.to_eye()))));
        prop_assert_eq!(fit_scene(&scene, &d, &o).unwrap(), fit_points(world, &d, &o).unwrap());
    }
}

#[test]
fn named_views_look_along_the_axes() {
    let check = |view: NamedView, axis, to_eye: DVec3, up: DVec3| {
        let d = view.direction(axis);
        assert_eq!((d.to_eye(), d.up()), (to_eye, up), "{view} {axis:?}");
    };
    use NamedView::*;
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    for (view, to_eye, up) in
        [(Front, z, y), (Back, -z, y), (Right, x, y), (Left, -x, y), (Top, y, -z), (Bottom, -y, z)]
    {
        check(view, UpAxis::Y, to_eye, up);
    }
    for (view, to_eye, up) in
        [(Front, -y, z), (Back, y, z), (Right, x, z), (Left, -x, z), (Top, z, y), (Bottom, -z, -y)]
    {
        check(view, UpAxis::Z, to_eye, up);
    }
    for (axis, front, right) in
        [(UpAxis::X, z, -y), (UpAxis::NegX, z, y), (UpAxis::NegY, z, -x), (UpAxis::NegZ, -y, -x)]
    {
        check(Front, axis, front, axis.up());
        check(Right, axis, right, axis.up());
        check(Back, axis, -front, axis.up());
        check(Top, axis, axis.up(), -front);
    }
    for &axis in UpAxis::ALL {
        assert_eq!(axis.up().cross(axis.front()), axis.right(), "{axis:?} is right-handed");
        let sign = if axis.name().starts_with('-') { -1.0 } else { 1.0 };
        let index = "xyz".find(&axis.name()[axis.name().len() - 1..]).unwrap();
        assert_eq!(axis.up()[index], sign, "{axis:?} is called as it points");
    }
    let third = DVec3::ONE / 3.0_f64.sqrt();
    assert!((Iso.direction(UpAxis::Y).to_eye() - third).length() < 1e-15);
    assert!(
        (Iso.direction(UpAxis::Z).to_eye() - third * DVec3::new(1.0, -1.0, 1.0)).length() < 1e-15
    );
    for &view in NamedView::ALL {
        assert_eq!(view.name().parse::<NamedView>().unwrap(), view);
        let d = view.direction(UpAxis::Z);
        assert!((d.right().cross(d.up()) - d.to_eye()).length() < 1e-15);
    }
    assert_eq!("side".parse::<NamedView>().unwrap(), Right);
    assert!("inside".parse::<NamedView>().is_err());
    assert!(ViewDirection::from_angles(f64::NAN, 0.0, UpAxis::Y).is_err());
}

#[test]
fn points_lines_and_nothing_are_seen_too() {
    let far = DVec3::new(1e12, -3e9, 7.0);
    let flat = |min: DVec3, size: DVec3| Some(Aabb { min, max: min + size });
    let cases = [
        None,
        flat(DVec3::ZERO, DVec3::ZERO),
        flat(far, DVec3::ZERO),
        flat(far, DVec3::splat(1e-3)),
        flat(DVec3::ONE, DVec3::Z * 5.0),
        flat(DVec3::ONE, DVec3::new(4.0, 3.0, 0.0)),
        flat(DVec3::splat(1e-30), DVec3::splat(1e-30)),
    ];
    for bounds in cases {
        for &view in NamedView::ALL {
            for lens in [Lens::Perspective { fov_y: 0.6 }, Lens::Orthographic] {
                let options = FitOptions { lens, ..FitOptions::default() };
                let d = view.direction(UpAxis::Y);
                let sphere = bounds.map(|b| BoundingSphere {
                    center: b.center(),
                    radius: (b.size() * 0.5).length(),
                });
                for camera in [
                    fit_box(bounds.as_ref(), &d, &options),
                    fit_sphere(sphere.as_ref(), &d, &options),
                ] {
                    let camera = camera.unwrap();
                    for c in bounds.map_or([DVec3::ZERO; 8], |b| b.corners()) {
                        assert!(
                            ndc(&camera, 1.0, c).abs().max_element() < 1.0,
                            "{bounds:?} {view}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn wrong_options_and_bounds_are_errors() {
    let d = NamedView::Iso.direction(UpAxis::Y);
    let good = FitOptions::default();
    let unit = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    for bad in [
        FitOptions { aspect: 0.0, ..good },
        FitOptions { aspect: f64::NAN, ..good },
        FitOptions { margin: 0.5, ..good },
        FitOptions { margin: f64::NAN, ..good },
        FitOptions { lens: Lens::Perspective { fov_y: 0.0 }, ..good },
        FitOptions { lens: Lens::Perspective { fov_y: 3.2 }, ..good },
    ] {
        assert!(fit_box(Some(&unit), &d, &bad).is_err(), "{bad:?}");
        assert!(fit_sphere(None, &d, &bad).is_err(), "{bad:?}");
    }
    let nan = Aabb { min: DVec3::NAN, max: DVec3::ONE };
    let huge = Aabb { min: DVec3::splat(-1e308), max: DVec3::splat(1e308) };
    assert!(fit_box(Some(&nan), &d, &good).is_err() && fit_box(Some(&huge), &d, &good).is_err());
    let ball = BoundingSphere { center: DVec3::ZERO, radius: f64::INFINITY };
    assert!(fit_sphere(Some(&ball), &d, &good).is_err());
}

#[test]
fn a_turntable_keeps_the_frame() {
    let sphere = BoundingSphere { center: DVec3::ONE, radius: 2.0 };
    let options = FitOptions { lens: Lens::Orthographic, ..FitOptions::default() };
    let heights = (0..36).map(|i| {
        let d = ViewDirection::from_angles(f64::from(i) * 10.0, 20.0, UpAxis::Z).unwrap();
        match fit_sphere(Some(&sphere), &d, &options).unwrap().projection {
            Projection::Orthographic { height } => height,
            Projection::Perspective { .. } => f64::NAN,
        }
    });
    let all: Vec<f64> = heights.collect();
    assert!(all.iter().all(|h| *h == all[0]));
}
