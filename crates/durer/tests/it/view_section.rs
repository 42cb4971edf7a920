//! Sections: cut bodies remain closed, and caps have the right area.

use crate::data;
use crate::line_scenes::{self, Random, soup};
use crate::scenes::{Numbers, instance};
use durer::math::{DMat4, DVec3, Plane, Vec3, Vec4};
use durer::scene::{Mesh, Scene};
use durer::view::section::{Options, Section, cut};
use durer::view::topology::mesh_topology;

fn plane(normal: [f64; 3], distance: f64) -> Plane {
    Plane { normal: DVec3::from(normal), distance }
}

fn scene(mesh: Mesh) -> Scene {
    Scene { meshes: vec![mesh], instances: vec![instance(0)], ..Scene::default() }
}

fn sectioned(mesh: Mesh, planes: &[Plane]) -> Section {
    cut(&scene(mesh), planes, &Options::default()).expect("cut")
}

/// Returns a box with corners at ± size; its faces point out or in.
fn cuboid(size: f32, inwards: bool) -> Mesh {
    let positions = (0..8).map(|i| {
        let sign = |bit: u32| if i >> bit & 1 == 1 { size } else { -size };
        Vec3::new(sign(0), sign(1), sign(2))
    });
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let fans = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let turned = fans.flat_map(|[a, b, c]| if inwards { [a, c, b] } else { [a, b, c] });
    Mesh { positions: positions.collect(), indices: Some(turned.collect()), ..Mesh::default() }
}

/// Returns two meshes as one.
fn joined(a: Mesh, b: Mesh) -> Mesh {
    let offset = a.positions.len() as u32;
    let mut mesh = Mesh { parts: Vec::new(), ..a };
    mesh.positions.extend(&b.positions);
    let more = b.indices.into_iter().flatten().map(|i| i + offset);
    mesh.indices = mesh.indices.map(|i| i.into_iter().chain(more).collect());
    mesh
}

fn torus(columns: u32, rows: u32) -> Mesh {
    let angle = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let mut mesh = Mesh { indices: Some(Vec::new()), ..Mesh::default() };
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let (u, v) = (angle(i, columns), angle(j, rows));
        let r = 2.0 + 0.5 * libm::cos(v);
        let p = DVec3::new(r * libm::cos(u), r * libm::sin(u), 0.5 * libm::sin(v));
        mesh.positions.push(p.as_vec3());
        let at = |i: u32, j: u32| i % columns * rows + j % rows;
        let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        mesh.indices.as_mut().expect("indices").extend([a, b, c, a, c, d]);
    }
    mesh
}

fn assert_closed(name: &str, section: &Section) {
    assert_eq!(section.open_cuts, 0, "{name}: open cuts");
    section.scene.check().expect("a valid scene");
    for mesh in section.scene.meshes.iter().filter(|m| m.triangle_count() > 0) {
        let found = mesh_topology(mesh);
        assert!(found.closed && found.oriented, "{name}: {found:?}");
        assert!(found.signed_volume > 0.0, "{name}: {}", found.signed_volume);
    }
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() <= 1e-6 * expected.max(1.0),
        "{what}: {found}, not {expected}"
    );
}

#[test]
fn section_of_a_box() {
    for (planes, area, volume) in [
        (vec![plane([0.0, 0.0, 1.0], -0.25)], 4.0, 3.0),
        // Through four edges, and through corners.
        (vec![plane([1.0, 1.0, 0.0], 0.0)], 32f64.sqrt(), 4.0),
        (vec![plane([-1.0, 0.0, 1.0], 0.0)], 32f64.sqrt(), 4.0),
        // A corner of three equal sides; a hexagon.
        (vec![plane([1.0, 1.0, 1.0], -2.0)], 3f64.sqrt() / 2.0, 1.0 / 6.0),
        (vec![plane([1.0, 1.0, 1.0], 0.0)], 27f64.sqrt(), 4.0),
        // In a face: the face is replaced by a cap.
        (vec![plane([0.0, 0.0, 1.0], 1.0)], 4.0, 8.0),
        // Two planes; the second cuts the cap of the first.
        (vec![plane([0.0, 0.0, 1.0], 0.0), plane([1.0, 0.0, 0.0], 0.0)], 4.0 + 2.0, 2.0),
    ] {
        let section = sectioned(cuboid(1.0, false), &planes);
        assert_closed(&format!("{planes:?}"), &section);
        assert_near(section.cap_area, area, "area");
        assert_near(mesh_topology(&section.scene.meshes[0]).signed_volume, volume, "volume");
    }
}

#[test]
fn section_beside_a_box_changes_nothing_or_takes_all() {
    let all = sectioned(cuboid(1.0, false), &[plane([0.0, 0.0, 1.0], 1.5)]);
    assert_eq!((all.scene.triangle_count(), all.cap_area, all.outline.len()), (12, 0.0, 0));
    for distance in [-1.0, -1.5] {
        let none = sectioned(cuboid(1.0, false), &[plane([0.0, 0.0, 1.0], distance)]);
        assert_eq!((none.scene.triangle_count(), none.cap_area), (0, 0.0));
    }
}

#[test]
fn section_of_nested_bodies() {
    let hollow =
        sectioned(joined(cuboid(1.0, false), cuboid(0.5, true)), &[plane([0.0, 0.0, -1.0], 0.1)]);
    assert_closed("hollow", &hollow);
    assert_near(hollow.cap_area, 4.0 - 1.0, "hollow");
    let inner = joined(joined(cuboid(1.0, false), cuboid(0.5, true)), cuboid(0.25, false));
    let section = sectioned(inner, &[plane([0.0, 0.0, -1.0], 0.1)]);
    assert_closed("nested", &section);
    assert_near(section.cap_area, 4.0 - 1.0 + 0.25, "nested");
}

#[test]
fn section_of_a_torus_has_two_discs_or_a_ring() {
    let (columns, rows) = (48, 24);
    let across = sectioned(torus(columns, rows), &[plane([1.0, 0.0, 0.0], 0.0)]);
    assert_closed("across", &across);
    let polygon = |n: u32, r: f64| {
        f64::from(n) / 2.0 * r * r * libm::sin(std::f64::consts::TAU / f64::from(n))
    };
    assert_near(across.cap_area, 2.0 * polygon(rows, 0.5), "two discs");
    let along = sectioned(torus(columns, rows), &[plane([0.0, 0.0, 1.0], 0.0)]);
    assert_closed("along", &along);
    assert_near(along.cap_area, polygon(columns, 2.5) - polygon(columns, 1.5), "a ring");
}

#[test]
fn section_of_bodies_by_any_plane_stays_closed() {
    let mut numbers = Numbers(17);
    for mesh in [torus(7, 5), torus(20, 9), cuboid(1.0, false)] {
        for _ in 0..25 {
            let normal = numbers.point(1.0).as_dvec3();
            let distance = f64::from(numbers.next() - 0.5);
            let planes = [Plane { normal, distance }, plane([0.3, -0.2, 1.0], 0.2)];
            let count = 1 + (numbers.next() * 2.0) as usize;
            let section = sectioned(mesh.clone(), &planes[..count]);
            assert_closed(&format!("{planes:?}"), &section);
        }
    }
}

#[test]
fn section_of_an_open_body_has_no_cap() {
    let mut mesh = cuboid(1.0, false);
    mesh.indices = mesh.indices.map(|i| i[6..].to_vec());
    let section = sectioned(mesh, &[plane([1.0, 0.0, 0.0], 0.0)]);
    assert_eq!((section.open_cuts, section.cap_area), (1, 0.0));
    let length: f64 = section.outline.iter().map(|[a, b]| a.distance(*b)).sum();
    assert_near(length, 6.0, "outline");
}

#[test]
fn section_interpolates_attributes_and_follows_instances() {
    let mut mesh = cuboid(1.0, false);
    let color = |p: &Vec3| Vec4::new(p.z * 0.5 + 0.5, 0.0, 0.0, 1.0);
    mesh.colors = mesh.positions.iter().map(color).collect();
    let mut scene = scene(mesh);
    scene.instances[0].world_from_mesh =
        DMat4::from_translation(DVec3::new(0.0, 0.0, 10.0)) * DMat4::from_scale(DVec3::splat(2.0));
    let options = Options { caps: false, ..Options::default() };
    let section = cut(&scene, &[plane([0.0, 0.0, -1.0], 11.0)], &options).expect("cut");
    let mesh = &section.scene.meshes[0];
    let new = &mesh.positions[8..];
    assert!(!new.is_empty() && new.iter().all(|p| p.z == 0.5), "{new:?}");
    assert!(mesh.colors[8..].iter().all(|c| (c.x - 0.75).abs() < 1e-6));
    assert!(section.outline.iter().flatten().all(|p| p.z == 11.0));
}

#[test]
fn section_planes_without_direction_are_refused() {
    for bad in [
        plane([0.0; 3], 1.0),
        plane([f64::NAN, 0.0, 1.0], 0.0),
        plane([0.0, 0.0, 1.0], f64::INFINITY),
    ] {
        assert!(cut(&scene(cuboid(1.0, false)), &[bad], &Options::default()).is_err());
    }
}

#[test]
fn bodies_whose_corners_rounding_has_moved_are_capped() {
    let mut random = Random(5);
    let mut number = || (random.next() - 0.5) * 2e-6;
    let mut jitter = |p: DVec3| p + DVec3::new(number(), number(), number());
    let noisy: Vec<_> =
        line_scenes::cuboid([0.0; 3], [2.0; 3]).into_iter().map(|t| t.map(&mut jitter)).collect();
    let plane = Plane { normal: DVec3::new(0.1, 0.2, 1.0), distance: -1.3 };
    let section = cut(&soup(&noisy), &[plane], &Options::default()).expect("cut");
    let exact = cut(&soup(&line_scenes::cuboid([0.0; 3], [2.0; 3])), &[plane], &Options::default())
        .expect("cut");
    assert_eq!((section.open_cuts, exact.open_cuts), (0, 0));
    assert!((section.cap_area - exact.cap_area).abs() < 1e-4, "{}", section.cap_area);
}

#[test]
fn conformance_section_of_real_models_stays_closed() {
    let Some(folder) = data::folder() else { return };
    for name in ["meshes/sphere.obj", "meshes/torus.obj", "meshes/wingnut.obj", "meshes/nut.ply"] {
        let path = folder.join(name);
        if !path.exists() {
            continue;
        }
        let scene = data::read_model(&path).scene;
        if !scene.meshes.iter().all(|m| mesh_topology(m).closed && mesh_topology(m).oriented) {
            continue;
        }
        let center = scene.bounds().expect("bounds").center();
        let planes = [Plane::through(center, DVec3::new(0.2, -1.0, 0.4))];
        let section = cut(&scene, &planes, &Options::default()).expect("cut");
        assert_eq!(section.open_cuts, 0, "{name}");
        assert!(section.cap_area > 0.0, "{name}");
        for mesh in &section.scene.meshes {
            assert!(mesh_topology(mesh).closed, "{name}");
        }
    }
}
