//! Visible regions, compared with rays and areas, and with each other.

use crate::scenes::{Numbers, instance, soup};
use crate::surface_scenes::{Prepared, each, of_triangles};
use durer::clip::polygon::{
    BooleanOp, Shapes, WindingRule,
    overlay::{self, overlay},
};
use durer::math::{DMat4, DVec2, DVec3, Vec3};
use durer::scene::{Camera, Light, LightKind, Projection, Scene};
use durer::shade::PreparedLights;
use durer::target::drawing::{LineClass, Region, RegionKind};
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::region::planar_map::{Options, VisibleMap, VisibleRegion, replay, solve};
use durer::visibility::region::{self, Fill, Merge, hatch};
use durer::visibility::surface::Cull;

fn solved(scene: &Scene, view: &View) -> VisibleMap {
    solve(scene, view, &Options::default(), &mut NoTrace).expect("solved")
}

fn from_above(height: f64) -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 10.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height },
        near: 1.0,
        far: 20.0,
    }
}

/// Returns the winding number of rings around a point.
fn winding(rings: &[Vec<DVec2>], p: DVec2) -> i32 {
    let mut sum = 0;
    for ring in rings {
        for (i, &b) in ring.iter().enumerate() {
            let a = ring[(i + ring.len() - 1) % ring.len()];
            if (a.y <= p.y) != (b.y <= p.y) {
                let x = a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
                sum += if x > p.x { if b.y > a.y { 1 } else { -1 } } else { 0 };
            }
        }
    }
    sum
}

fn distance(rings: &[Vec<DVec2>], p: DVec2) -> f64 {
    let sides = rings.iter().flat_map(|r| r.iter().zip(r.iter().cycle().skip(1)).take(r.len()));
    let to = |(a, b): (&DVec2, &DVec2)| {
        let (u, v) = (*b - *a, p - *a);
        let t = (u.dot(v) / u.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (v - u * t).length()
    };
    sides.map(to).fold(f64::INFINITY, f64::min)
}

/// Returns the item of the nearest triangle on the line of sight through a point of the plane; `None` if another is
/// equally near up to rounding.
fn by_ray(scene: &Scene, camera: &Camera, p: DVec2) -> Option<Option<u32>> {
    let [right, up, back] = camera.axes();
    let at = camera.target + right * p.x + up * p.y;
    let (origin, along) = match camera.projection {
        Projection::Orthographic { .. } => (at + back * camera.eye.distance(camera.target), -back),
        Projection::Perspective { .. } => (camera.eye, at - camera.eye),
    };
    let forward = -back.dot(along);
    let mut hits: Vec<(f64, u32)> = Vec::new();
    let mut item = 0;
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        for i in 0..mesh.triangle_count() {
            let world = |v: u32| {
                instance.world_from_mesh.transform_point3(mesh.positions[v as usize].as_dvec3())
            };
            let [a, b, c] = mesh.triangle(i).map(world);
            let n = (b - a).cross(c - a);
            let t = n.dot(a - origin) / n.dot(along);
            let x = origin + along * t;
            let within = |p: DVec3, q: DVec3| (q - p).cross(x - p).dot(n) >= 0.0;
            let depth = t * forward;
            let seen = (camera.near..=camera.far).contains(&depth);
            if seen && within(a, b) && within(b, c) && within(c, a) {
                hits.push((depth, item));
            }
            item += 1;
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    match hits.as_slice() {
        [] => Some(None),
        [first, second, ..] if second.0 - first.0 <= 1e-7 * first.0 => None,
        [first, ..] => Some(Some(first.1)),
    }
}

fn assert_shows(name: &str, scene: &Scene, view: &View, regions: &[VisibleRegion], count: usize) {
    let half = match view.camera().projection {
        Projection::Orthographic { height } => height / 2.0,
        Projection::Perspective { fov_y } => {
            libm::tan(fov_y / 2.0) * view.camera().eye.distance(view.camera().target)
        }
    };
    let half = DVec2::new(half * f64::from(view.width()) / f64::from(view.height()), half);
    let mut numbers = Numbers(99);
    for _ in 0..count {
        let p = DVec2::new(f64::from(numbers.next()), f64::from(numbers.next())) * 2.0 - 1.0;
        let p = p * half;
        let Some(expected) = by_ray(scene, view.camera(), p) else { continue };
        let near = regions.iter().any(|r| distance(&r.rings, p) < 1e-6 * half.y);
        let found: Vec<(u32, i32)> = regions
            .iter()
            .map(|r| (r.item, winding(&r.rings, p)))
            .filter(|(_, w)| *w != 0)
            .collect();
        let expected: Vec<(u32, i32)> = expected.into_iter().map(|item| (item, 1)).collect();
        assert!(near || found == expected, "{name} at {p}: {found:?}, not {expected:?}");
    }
}

#[test]
fn visible_regions_are_what_rays_see() {
    each(40, |name, prepared| {
        let map = solved(prepared.scene, &prepared.view);
        let regions = map.regions(u64::from);
        assert_shows(name, prepared.scene, &prepared.view, &regions, 60);
        let [vertices, edges, faces, parts] = map.counts();
        assert_eq!(vertices + faces, edges + 1 + parts, "{name}: Euler");
    });
}

#[test]
fn visible_regions_of_many_triangles() {
    let scene = soup(1500, 3);
    let prepared = Prepared::new(&scene, 96, 96);
    let map = solved(&scene, &prepared.view);
    assert_shows("soup", &scene, &prepared.view, &map.regions(u64::from), 300);
}

#[test]
fn visible_regions_agree_with_the_z_buffer() {
    for scene in [crate::surface_scenes::three_beams(), crate::surface_scenes::crossing_quads()] {
        let prepared = Prepared::new(&scene, 120, 100);
        let picture = prepared.by_z_buffer();
        let items = picture.item.as_ref().expect("items");
        let map = solved(&scene, &prepared.view);
        let regions = map.regions(u64::from);
        let camera = prepared.view.camera();
        let height = match camera.projection {
            Projection::Orthographic { height } => height,
            Projection::Perspective { fov_y } => {
                2.0 * libm::tan(fov_y / 2.0) * camera.eye.distance(camera.target)
            }
        };
        let pixel = height / 100.0;
        let mut compared = 0;
        for (y, x) in (0..100).flat_map(|y| (0..120).map(move |x| (y, x))) {
            let p = DVec2::new(f64::from(x) - 59.5, 49.5 - f64::from(y)) * pixel;
            if regions.iter().any(|r| distance(&r.rings, p) < pixel) {
                continue;
            }
            let found = regions.iter().find(|r| winding(&r.rings, p) != 0).map(|r| r.item);
            let expected = items.get(x, y).filter(|i| *i != durer::target::NO_ITEM);
            assert_eq!(found, expected, "{x}, {y}");
            compared += usize::from(found.is_some());
        }
        assert!(compared > 100, "{compared} pixels compared");
    }
}

#[test]
fn visible_regions_fill_the_silhouette() {
    for seed in 1..6 {
        let scene = soup(200, seed);
        let scene = of_triangles(scene.meshes[0].positions[6..].as_chunks::<3>().0);
        let view = View::new(from_above(12.0), 64, 64).expect("view");
        let map = solved(&scene, &view);
        let sum: f64 = map.regions(u64::from).iter().map(VisibleRegion::area).sum();
        let whole: f64 = map.regions(|_| 0).iter().map(VisibleRegion::area).sum();
        assert!((sum - whole).abs() <= 1e-9 * whole, "{sum} {whole}");
        let shadows = scene.meshes[0].positions.as_chunks::<3>().0.iter().map(|t| {
            let [a, b, c] = t.map(|p| DVec2::new(f64::from(p.x), f64::from(p.y)));
            if (b - a).perp_dot(c - a) < 0.0 { [a, c, b] } else { [a, b, c] }
        });
        let shapes = Shapes::from_rings(shadows);
        let options = overlay::Options::with_rule(WindingRule::NonZero);
        let union = overlay(&shapes, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace)
            .expect("union");
        let expected = union.shapes.area();
        assert!((sum - expected).abs() <= 4e-9 * expected, "{sum} {expected}");
    }
}

/// Returns areas by item.
fn areas(scene: &Scene, view: &View, items: u32) -> Vec<f64> {
    let mut areas = vec![0.0; items as usize];
    for region in solved(scene, view).regions(u64::from) {
        areas[region.item as usize] += region.area();
    }
    areas
}

#[test]
fn visible_regions_do_not_depend_on_the_order_or_turn_of_faces() {
    let scene = soup(120, 8);
    let triangles = &scene.meshes[0].positions.as_chunks::<3>().0[2..];
    let count = triangles.len() as u32;
    let view = View::new(from_above(6.0), 80, 60).expect("view");
    let expected = areas(&of_triangles(triangles), &view, count);
    let mut reversed: Vec<[Vec3; 3]> = triangles.iter().map(|&[a, b, c]| [c, b, a]).collect();
    reversed.reverse();
    let mut found = areas(&of_triangles(&reversed), &view, count);
    found.reverse();
    for (a, b) in found.iter().zip(&expected) {
        assert!((a - b).abs() <= 1e-9, "{a} {b}");
    }
    assert!(expected.iter().filter(|a| **a > 0.0).count() > 20);
}

#[test]
fn visible_regions_show_the_first_of_equal_faces() {
    let face =
        |x: f32| [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 1.0, 0.0, 0.0), Vec3::new(x, 1.0, 0.0)];
    let scene = of_triangles(&[face(0.0), face(0.0), face(0.25)]);
    let found = areas(&scene, &View::new(from_above(4.0), 9, 9).expect("view"), 3);
    assert_eq!(found[1], 0.0);
    assert!((found[0] - 0.5).abs() < 1e-8);
    assert!((found[2] - (0.5 - 0.75 * 0.75 * 0.5)).abs() < 1e-8);
}

#[test]
fn visible_regions_are_rebuilt_from_steps() {
    let scene = soup(60, 5);
    let view = Prepared::new(&scene, 40, 40).view;
    let mut recorder = Recorder::default();
    let traced = solve(&scene, &view, &Options::default(), &mut recorder).expect("solved");
    let plain = solved(&scene, &view).regions(u64::from);
    assert_eq!(traced.regions(u64::from), plain);
    assert_eq!(replay(recorder.steps()), plain);
    assert!(!plain.is_empty());
}

#[test]
fn visible_regions_do_not_depend_on_threads() {
    let scene = soup(800, 21);
    let prepared = Prepared::new(&scene, 50, 50);
    let options = region::Options { shadows: true, ..Default::default() };
    let drawn = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
        pool.install(|| region::draw(&scene, &prepared.view, &prepared.lights, &options))
            .expect("drawn")
    };
    let one = drawn(1);
    assert!(!one.regions.is_empty());
    for threads in [2, 4] {
        assert!(drawn(threads) == one, "{threads} threads");
    }
}

#[test]
fn visible_regions_trapped_look_like_disjoint_ones() {
    let scene = soup(80, 4);
    let prepared = Prepared::new(&scene, 50, 50);
    let draw = |fill| {
        let options = region::Options { fill, merge: Merge::Face, ..Default::default() };
        region::draw(&scene, &prepared.view, &prepared.lights, &options).expect("drawn").regions
    };
    let (disjoint, trapped) = (draw(Fill::Disjoint), draw(Fill::Trapped { reach: 0.01 }));
    let area = |regions: &[Region]| regions.iter().map(Region::area).sum::<f64>();
    assert!(area(&trapped) > area(&disjoint) * 1.001, "shapes reach under others");
    let mut numbers = Numbers(3);
    let top = |regions: &[Region], p| {
        regions.iter().rev().find(|r| winding(&r.rings, p) != 0).map(|r| r.item)
    };
    let mut compared = 0;
    for _ in 0..400 {
        let p = DVec2::new(f64::from(numbers.next()), f64::from(numbers.next())) * 4.0 - 2.0;
        if disjoint.iter().any(|r| distance(&r.rings, p) < 1e-3) {
            continue;
        }
        compared += usize::from(top(&disjoint, p).is_some());
        assert_eq!(top(&trapped, p), top(&disjoint, p), "at {p}");
    }
    assert!(compared > 20, "{compared} points compared");
}

/// Checks that no coloured area is lost: an area that a shape gives up at its corners would be a hole.
#[test]
fn visible_regions_trapped_cover_what_disjoint_ones_do() {
    for seed in 0..6 {
        let scene = soup(60, seed);
        let prepared = Prepared::new(&scene, 50, 50);
        let draw = |fill| {
            let options = region::Options { fill, merge: Merge::Material, ..Default::default() };
            region::draw(&scene, &prepared.view, &prepared.lights, &options).expect("drawn").regions
        };
        let (disjoint, trapped) = (draw(Fill::Disjoint), draw(Fill::Trapped { reach: 0.02 }));
        let mut numbers = Numbers(seed + 7);
        for _ in 0..1500 {
            let p = DVec2::new(f64::from(numbers.next()), f64::from(numbers.next())) * 4.0 - 2.0;
            let covered = |regions: &[Region]| regions.iter().any(|r| winding(&r.rings, p) != 0);
            assert!(covered(&trapped) || !covered(&disjoint), "{seed}: {p}");
        }
    }
}

/// Checks that the background does not show between narrow strips: some shape extends beneath them all.
#[test]
fn visible_regions_trapped_back_narrow_strips() {
    let strip = |from: f32, to: f32, tilt: f32| {
        let p = |x: f32, y: f32| Vec3::new(x, y, (x - from) * tilt);
        [[p(from, -1.0), p(to, -1.0), p(to, 1.0)], [p(from, -1.0), p(to, 1.0), p(from, 1.0)]]
    };
    let mut triangles = Vec::from(strip(-0.5, 0.0, 0.0));
    let x = |i: u8| 0.005 * f32::from(i);
    (0..8).for_each(|i| triangles.extend(strip(x(i), x(i + 1), 0.3 * f32::from(i + 1))));
    triangles.extend(strip(x(8), 0.5, 3.0));
    let scene = of_triangles(&triangles);
    let view = View::new(from_above(2.4), 100, 100).expect("view");
    let lights = PreparedLights::of(&scene, view.camera());
    let reach = 0.02;
    let fill = Fill::Trapped { reach };
    let options = region::Options { fill, merge: Merge::Shade, ..Default::default() };
    let regions = region::draw(&scene, &view, &lights, &options).expect("drawing").regions;
    for k in -10..=50 {
        let p = DVec2::new(0.001 * f64::from(k), 0.123);
        // A dot as wide as `reach`.
        let dot = [-0.5, -0.25, 0.0, 0.25, 0.5].map(|d| p + DVec2::X * (d * reach));
        let backed = regions.iter().any(|r| dot.iter().all(|&q| winding(&r.rings, q) != 0));
        assert!(backed, "{p}");
    }
}

fn square(x: f32, y: f32, z: f32, size: f32) -> [[Vec3; 3]; 2] {
    let p = |u: f32, v: f32| Vec3::new(x + u * size, y + v * size, z);
    [[p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)], [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)]]
}

fn in_light(kind: LightKind) -> durer::target::drawing::Drawing {
    let scene =
        of_triangles([square(-4.0, -4.0, 0.0, 8.0), square(-2.5, 0.0, 1.0, 1.0)].as_flattened());
    let camera = from_above(10.0);
    let view = View::new(camera, 64, 64).expect("view");
    let lights = PreparedLights::new(&[Light { kind, color: Vec3::ONE }], &camera);
    let options = region::Options { shadows: true, ..Default::default() };
    region::draw(&scene, &view, &lights, &options).expect("drawn")
}

#[test]
fn visible_regions_in_the_shadow_of_a_plate() {
    let direction = DVec3::new(2.0, 0.0, -1.0).normalize();
    // A light at height 3 makes the plate's shadow 3/2 of its size.
    let position = DVec3::new(-3.0, 0.5, 3.0);
    for (kind, area, x) in [
        (LightKind::Directional { direction }, 1.0, [-0.5, 0.5]),
        (LightKind::Point { position, range: None }, 2.25, [-2.25, -0.75]),
    ] {
        let drawing = in_light(kind);
        let shadows = || drawing.regions.iter().filter(|r| r.kind == RegionKind::Shadow);
        let hidden = if area > 2.0 { 1.0 * 1.0 - 0.25 } else { 0.0 };
        let found: f64 = shadows().map(Region::area).sum();
        assert!((found - (area - hidden)).abs() < 1e-6, "{found}");
        let points = || shadows().flat_map(|r| r.rings.iter().flatten());
        let right = points().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
        assert!((right - x[1]).abs() < 1e-6, "{right} {x:?}");
        let lines = drawing.length(|l| l.class == LineClass::Shadow);
        assert!(lines > 3.0 && lines < 6.1, "{lines}");
    }
}

#[test]
fn visible_regions_hatched_by_tone() {
    let region = |kind, grey: u8| Region {
        kind,
        rings: vec![[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from).to_vec()],
        color: [grey, grey, grey, 255],
        item: None,
        part: None,
    };
    let length = |kind, grey| {
        let options = hatch::Options { spacing: 0.1, cross: false, ..Default::default() };
        let lines = hatch::hatch(&[region(kind, grey)], &options);
        assert!(lines.iter().all(|l| l.class == LineClass::Hatch && l.points.len() == 2));
        lines.iter().map(|l| l.length()).sum::<f64>()
    };
    // The area divided by the spacing of the lines.
    assert!((length(RegionKind::Surface, 0) - 1000.0).abs() < 5.0);
    assert!((length(RegionKind::Cap, 255) - 250.0).abs() < 5.0);
    assert_eq!(length(RegionKind::Surface, 255), 0.0);
    assert!(length(RegionKind::Surface, 100) < length(RegionKind::Surface, 30));
}

#[test]
fn caps_of_each_part_are_hatched_in_a_direction_of_their_own() {
    let cap = |x: f64, part| Region {
        kind: RegionKind::Cap,
        rings: vec![[(x, 0.0), (x + 9.0, 0.0), (x + 9.0, 9.0), (x, 9.0)].map(DVec2::from).to_vec()],
        color: [200, 60, 50, 255],
        item: None,
        part,
    };
    let regions = [cap(0.0, Some(3)), cap(10.0, Some(7)), cap(20.0, Some(3)), cap(30.0, None)];
    let lines = hatch::hatch(&regions, &hatch::Options { spacing: 0.2, ..Default::default() });
    let angle = |l: &durer::target::drawing::Line| {
        let way = l.points[1] - l.points[0];
        (way.y.atan2(way.x).to_degrees().round() as i64).rem_euclid(180)
    };
    for line in &lines {
        let second = line.points[0].x > 9.5 && line.points[0].x < 19.5;
        assert_eq!(angle(line), if second { 135 } else { 45 }, "{line:?}");
    }
    // 9 × 9 dots at a distance of four spacings.
    let length: f64 = lines.iter().map(|l| l.length()).sum();
    assert!((length / (4.0 * 81.0 / 0.8) - 1.0).abs() < 0.02, "{length}");
}

#[test]
fn visible_regions_hatched_alike_share_their_lines() {
    let region = |x: f64, grey: u8| Region {
        kind: RegionKind::Surface,
        rings: vec![[(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)].map(DVec2::from).to_vec()],
        color: [grey, grey, grey, 255],
        item: None,
        part: None,
    };
    let options = hatch::Options { spacing: 0.1, angle: 0.0, cross: true, ..Default::default() };
    let lines = hatch::hatch(&[region(0.05, 0), region(1.05, 0)], &options);
    let across = |l: &&durer::target::drawing::Line| (l.points[0].x - l.points[1].x).abs() < 1e-6;
    let (second, first): (Vec<_>, Vec<_>) = lines.iter().partition(across);
    // Through both; across, twenty columns.
    assert!(first.iter().all(|l| (l.length() - 2.0).abs() < 1e-9), "{first:?}");
    assert_eq!((first.len(), second.len()), (10, 20));
    // A little lighter: every second of the lines across remains.
    let lines = hatch::hatch(&[region(0.05, 41)], &options);
    assert_eq!(lines.iter().filter(across).count(), 5, "{lines:?}");
}

#[test]
fn visible_regions_are_painted_from_far_to_near() {
    // The nearer one comes first from the left, and by number.
    let near = square(-1.0, -1.0, 1.0, 1.5);
    let far = square(0.0, -0.5, 0.0, 1.0);
    let scene = of_triangles([near, far].as_flattened());
    let view = View::new(from_above(4.0), 64, 64).expect("view");
    let options = region::Options { merge: Merge::Face, ..Default::default() };
    let lights = PreparedLights::new(&[], view.camera());
    let drawing = region::draw(&scene, &view, &lights, &options).expect("drawn");
    let items: Vec<Option<u32>> = drawing.regions.iter().map(|r| r.item).collect();
    let place = |item: u32| items.iter().position(|i| *i == Some(item));
    let last_far = [2, 3].iter().filter_map(|i| place(*i)).max();
    let first_near = [0, 1].iter().filter_map(|i| place(*i)).min();
    assert!(last_far.is_some() && last_far < first_near, "{items:?}");
}

#[test]
fn visible_regions_of_mirrored_instances_keep_their_fronts() {
    let view = View::new(from_above(4.0), 64, 64).expect("view");
    for sign in [1.0, -1.0] {
        let mut scene = of_triangles(&square(-0.5, -0.5, 0.0, 1.0));
        scene.instances[0].world_from_mesh = DMat4::from_scale(DVec3::new(sign, 1.0, 1.0));
        let options = Options { cull: Cull::Back, ..Options::default() };
        let map = solve(&scene, &view, &options, &mut NoTrace).expect("solved");
        assert!(!map.regions(u64::from).is_empty(), "{sign}");
        // A half turn shows the back.
        scene.instances[0].world_from_mesh = DMat4::from_scale(DVec3::new(-sign, 1.0, -1.0));
        let map = solve(&scene, &view, &options, &mut NoTrace).expect("solved");
        assert!(map.regions(u64::from).is_empty(), "{sign}");
    }
}

#[test]
fn visible_regions_of_nothing() {
    let scene = Scene { instances: vec![], ..of_triangles(&[]) };
    let view = View::new(from_above(1.0), 3, 3).expect("view");
    let map = solved(&scene, &view);
    assert!(map.regions(u64::from).is_empty());
    let scene =
        Scene { instances: vec![instance(0)], ..of_triangles(&[[Vec3::NAN; 3], [Vec3::ONE; 3]]) };
    assert!(solved(&scene, &view).regions(u64::from).is_empty());
}
