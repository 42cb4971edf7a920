//! All methods through their common entry: the same items, depths and normals.

use crate::surface_scenes::{
    Prepared, assert_same_planes, crossing_quads, duplicates, needles, of_triangles, random,
    three_beams,
};
use durer::math::{DVec3, Vec3};
use durer::scene::{Camera, Projection, Scene};
use durer::target::Framebuffer;
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::surface::{Options, SurfaceMethod, render_with};

fn scenes() -> Vec<Scene> {
    let random = (400..420).map(random);
    [three_beams(), crossing_quads(), crate::scenes::materials()]
        .into_iter()
        .chain(random)
        .collect()
}

fn picture(p: &Prepared<'_>, method: SurfaceMethod, options: &Options) -> Framebuffer {
    let mut framebuffer = p.framebuffer();
    render_with(method, &p.input(), &p.lights, options, &mut framebuffer, &mut NoTrace)
        .expect("picture");
    framebuffer
}

#[test]
fn all_methods_give_the_same_planes_at_every_level_traced_or_not() {
    for scene in scenes() {
        let p = Prepared::new(&scene, 97, 83);
        let expected = p.by_z_buffer();
        for &method in SurfaceMethod::ALL {
            let found = picture(&p, method, &Options::default());
            assert_same_planes(method.name(), &found, &expected);
            for level in durer::simd::levels() {
                let options = Options { level, ..Options::default() };
                assert!(picture(&p, method, &options) == found, "{method} {level:?}");
            }
            let mut traced = p.framebuffer();
            let mut recorder = Recorder::default();
            let (input, options) = (p.input(), Options::default());
            render_with(method, &input, &p.lights, &options, &mut traced, &mut recorder)
                .expect("picture");
            assert!(traced == found, "{method} traced");
            assert!(method == SurfaceMethod::ZBuffer || !recorder.steps().is_empty(), "{method}");
        }
    }
}

fn assert_all_agree(p: &Prepared<'_>, what: &str) -> Framebuffer {
    let expected = p.by_z_buffer();
    for &method in SurfaceMethod::ALL {
        let found = picture(p, method, &Options::default());
        assert_same_planes(&format!("{what} by {method}"), &found, &expected);
    }
    expected
}

/// Returns a view of 64 columns and some rows of a scene given in pixels and depths.
fn upright(scene: &Scene, rows: std::ops::Range<u32>) -> Prepared<'_> {
    let mut p = Prepared::new(scene, 64, rows.len() as u32);
    let middle = f64::from(rows.start + rows.end) / 2.0;
    p.options.camera = Camera {
        eye: DVec3::new(32.0, -middle, 10.0),
        target: DVec3::new(32.0, -middle, 0.0),
        up: DVec3::Y,
        projection: Projection::Orthographic { height: rows.len() as f64 },
        near: 2.0,
        far: 18.0,
    };
    p.view = View::new(p.options.camera, 64, rows.len() as u32).expect("view");
    p
}

/// Returns a triangle given by pixels and depths.
fn at(corners: [(f32, f32, f32); 3]) -> [Vec3; 3] {
    corners.map(|(x, y, depth)| Vec3::new(x, -y, 8.0 - 16.0 * depth))
}

#[test]
fn planes_that_leave_the_depths_of_their_vertices_change_nothing() {
    // Less than two sub-pixels high: snapping moves its long edge to the centres of a row, where its plane is beyond
    // all of its vertices. Depths are clamped to those of the vertices and so bend along the row.
    let row = |ends: [f32; 2], apex: f32| {
        let (upper, lower) = (20.5 + 0.4 / 256.0, 20.5 + 1.8 / 256.0);
        at([(2.0, upper, ends[0]), (60.0, upper, ends[1]), (31.0, lower, apex)])
    };
    let plane = |depths: [f32; 2]| {
        let at_x = |x: f32| depths[0] + (depths[1] - depths[0]) * (x - 2.0) / 58.0;
        at([(-40.0, 0.0, at_x(-40.0)), (110.0, 0.0, at_x(110.0)), (32.0, 90.0, at_x(32.0))])
    };
    for (bent, others) in [
        (row([0.5, 0.3], 0.9), [[0.35, 0.29], [0.25, 0.25], [0.29, 0.29], [0.2, 0.2]]),
        (row([0.3, 0.5], 0.9), [[0.29, 0.35], [0.25, 0.25], [0.29, 0.29], [0.2, 0.2]]),
        (row([0.5, 0.7], 0.1), [[0.65, 0.71], [0.75, 0.75], [0.71, 0.71], [0.8, 0.8]]),
        (row([0.7, 0.5], 0.1), [[0.71, 0.65], [0.75, 0.75], [0.71, 0.71], [0.8, 0.8]]),
    ] {
        for other in others {
            let mut seen = [0; 2];
            for triangles in [[bent, plane(other)], [plane(other), bent]] {
                let scene = of_triangles(&triangles);
                // One row has windows that it fills.
                assert_all_agree(&upright(&scene, 20..21), &format!("{other:?}, one row"));
                let expected = assert_all_agree(&upright(&scene, 0..64), &format!("{other:?}"));
                let items = expected.item.iter().flat_map(|i| i.data());
                items.filter(|i| **i < 2).for_each(|i| seen[*i as usize] += 1);
            }
            assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
        }
    }
}

#[test]
fn needles_are_decided_alike() {
    for seed in 0..20 {
        let (scene, side) = (needles(seed), 40 + 7 * (seed as u32 % 16));
        assert_all_agree(&Prepared::new(&scene, side, side), &format!("needles {seed}"));
    }
}

#[test]
fn faces_in_one_plane_belong_to_the_first() {
    for side in [63, 129] {
        assert_all_agree(&Prepared::new(&duplicates(), side, side + 1), "duplicates");
    }
    // Facing the eye, where depths are equal bit for bit.
    let facing = |x: f32| at([(x - 40.0, -9.0, 0.4), (x + 40.0, -9.0, 0.4), (x, 80.0, 0.4)]);
    for xs in [[32.0, 20.0, 40.0], [40.0, 32.0, 20.0], [20.0, 40.0, 32.0]] {
        let scene = of_triangles(&xs.map(facing));
        let seen = assert_all_agree(&upright(&scene, 0..64), &format!("{xs:?}"));
        assert_eq!(seen.item.and_then(|i| i.get(32, 32)), Some(0));
    }
}

#[test]
fn what_lies_in_the_far_plane_is_not_seen() {
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let square = |z: f32, half: f32| {
        [(-1., -1.), (1., -1.), (-1., 1.)].map(|(x, y)| corner(x * half, y * half, z))
    };
    let scene = of_triangles(&[square(-8.0, 3.0), square(0.0, 0.5), square(-8.0, 2.0)]);
    let mut p = Prepared::new(&scene, 40, 30);
    p.options.camera = Camera {
        eye: DVec3::new(0.0, 0.0, 8.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 4.0 },
        near: 1.0,
        far: 16.0,
    };
    p.view = View::new(p.options.camera, 40, 30).expect("view");
    let seen = assert_all_agree(&p, "far plane");
    let depths = seen.depth.iter().flat_map(|d| d.data());
    assert_eq!(depths.filter(|d| **d < 1.0).count(), 28);
}
