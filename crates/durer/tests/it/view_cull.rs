//! Culling by bounding volumes, normals, facing, topology of meshes.

use durer::clip::outcode::ClipDepths;
use durer::math::{DMat4, DVec2, DVec3, Plane, Rect, Vec3};
use durer::scene::{Aabb, BoundingSphere, Camera, Mesh, Projection, Topology};
use durer::view::cull::*;
use durer::view::topology::{MeshTopology, mesh_topology, written_topology};
use proptest::prelude::*;

fn point(range: f64) -> impl Strategy<Value = DVec3> {
    let c = prop_oneof![3 => -range..range, 1 => (-4..5i32).prop_map(f64::from)];
    [c.clone(), c.clone(), c].prop_map(DVec3::from)
}

fn frustum(eye: DVec3, target: DVec3) -> Option<DMat4> {
    let projection = Projection::Perspective { fov_y: 1.0 };
    let camera = Camera { eye, target, up: DVec3::Y, projection, near: 0.5, far: 9.0 };
    camera.check().ok().map(|()| camera.clip_from_view(1.3) * camera.view_from_world())
}

/// Samples of a box: corners, middles, and a grid between them.
fn samples(b: &Aabb) -> impl Iterator<Item = DVec3> + '_ {
    (0..125).map(|i| {
        let t = DVec3::new((i % 5).into(), (i / 5 % 5).into(), (i / 25).into()) / 4.0;
        b.min * (DVec3::ONE - t) + b.max * t
    })
}

fn inside(planes: &[Plane], p: DVec3) -> bool {
    planes.iter().all(|plane| plane.evaluate(p) >= 0.0)
}

/// Checks the laws of any verdict on a body with these points.
fn check(verdict: Containment, mut points: impl Iterator<Item = bool>) -> bool {
    match verdict {
        Containment::Outside => !points.any(|p| p),
        Containment::Inside => points.all(|p| p),
        Containment::Crossing => true,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn boxes_and_spheres_are_judged_conservatively(
        eye in point(4.0), target in point(4.0), a in point(8.0), b in point(8.0), scale in 0.01..1.0f64,
        extra in prop::collection::vec((point(3.0), point(2.0)), 0..3),
    ) {
        let Some(matrix) = frustum(eye, target) else { return Ok(()) };
        let mut planes = ConvexVolume::frustum(&matrix, ClipDepths::NegativeOneToOne).planes().to_vec();
        planes.extend(extra.iter().map(|&(p, n)| Plane::through(p, n)));
        let volume = ConvexVolume::new(planes.clone());
        let b = a + (b - a) * scale;
        let aabb = Aabb { min: a.min(b), max: a.max(b) };
        let verdict = volume.contains_box(&aabb);
        prop_assert!(check(verdict, samples(&aabb).map(|p| inside(&planes, p))), "{:?}", verdict);

        let sphere = BoundingSphere { center: a, radius: scale * 3.0 };
        let verdict = volume.contains_sphere(&sphere);
        let ball = Aabb { min: DVec3::splat(-1.0), max: DVec3::ONE };
        let on = samples(&ball).filter(|d| *d != DVec3::ZERO).flat_map(|d| {
            [0.0, 0.5, 0.999_999].map(|r| a + d.normalize() * sphere.radius * r)
        });
        prop_assert!(check(verdict, on.map(|p| inside(&planes, p))), "{:?}", verdict);
    }

    #[test]
    fn rectangles_and_disks_are_judged_conservatively(a in point(4.0), b in point(4.0), radius in 0.0..4.0f64) {
        let window = Rect::new(DVec2::new(-2.0, -1.0), DVec2::new(3.0, 2.0)).unwrap();
        let thing = Rect::around([a.truncate(), b.truncate()]).unwrap();
        let grid = |i: i32| DVec2::new(f64::from(i % 9), f64::from(i / 9)) / 8.0;
        let points = (0..81).map(|i| {
            let p = thing.min() + thing.size() * grid(i);
            window.contains(p.min(thing.max())) // rounding may put the last sample beyond
        });
        prop_assert!(check(rect_in_window(&window, &thing), points));
        let center = a.truncate();
        let points = (0..81).filter_map(|i| {
            let d = grid(i) * 2.0 - DVec2::ONE;
            (d.length() < 0.999_999).then(|| window.contains(center + d * radius))
        });
        prop_assert!(check(disk_in_window(&window, center, radius), points));
    }

    #[test]
    fn newell_is_the_cross_product_and_needs_no_convexity(
        t in [point(5.0), point(5.0), point(5.0)], far in point(1e6), cut in 0.05..0.95f64, dent in 0.1..0.9f64,
    ) {
        let expected = triangle_area(t);
        prop_assert!((newell_area(&t) - expected).length() < 1e-12);
        // A dent in the first side reduces the area, wherever the polygon is.
        let middle = t[0].lerp(t[1], cut);
        let ring = [t[0], middle.lerp(t[2], dent), t[1], t[2]].map(|p| p + far);
        prop_assert!((newell_area(&ring) - expected * (1.0 - dent)).length() < 1e-7);
        let reversed = [ring[3], ring[2], ring[1], ring[0]];
        prop_assert!((newell_area(&reversed) + newell_area(&ring)).length() < 1e-7);
    }
}

#[test]
fn verdicts_are_not_always_crossing() {
    let volume = ConvexVolume::frustum(&DMat4::IDENTITY, ClipDepths::NegativeOneToOne);
    let cube = |center: f64, half: f64| Aabb {
        min: DVec3::splat(center - half),
        max: DVec3::splat(center + half),
    };
    assert_eq!(volume.contains_box(&cube(0.0, 0.9)), Containment::Inside);
    assert_eq!(volume.contains_box(&cube(0.0, 1.1)), Containment::Crossing);
    assert_eq!(volume.contains_box(&cube(3.0, 1.9)), Containment::Outside);
    assert_eq!(volume.contains_box(&cube(2.0, 1.0)), Containment::Crossing); // touches
    let ball = |x: f64, radius| BoundingSphere { center: DVec3::X * x, radius };
    assert_eq!(volume.contains_sphere(&ball(0.0, 0.99)), Containment::Inside);
    assert_eq!(volume.contains_sphere(&ball(3.0, 1.99)), Containment::Outside);
    assert_eq!(volume.contains_sphere(&ball(3.0, 2.01)), Containment::Crossing);
    assert_eq!(volume.contains_sphere(&ball(f64::NAN, 1.0)), Containment::Crossing);
    let window = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
    let disk = |x: f64, r| disk_in_window(&window, DVec2::new(x, 0.5), r);
    assert_eq!(
        [disk(0.5, 0.4), disk(1.5, 0.4), disk(1.5, 0.6), disk(1.5, 0.5)],
        [Containment::Inside, Containment::Outside, Containment::Crossing, Containment::Crossing],
    );
    // Outside only at the corner: its bounding box would overlap.
    assert_eq!(disk_in_window(&window, DVec2::splat(2.0), 1.4), Containment::Outside);
}

#[test]
fn faces_are_seen_from_their_side() {
    let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let normal = triangle_area(t);
    let seen = |z: f64| face_from_point(normal, t[0], DVec3::new(5.0, -3.0, z));
    assert_eq!(
        [seen(1.0), seen(-1.0), seen(0.0)],
        [FaceSide::Front, FaceSide::Back, FaceSide::Edge]
    );
    assert_eq!(face_along(normal, DVec3::NEG_Z), FaceSide::Front);
    assert_eq!(face_along(normal, DVec3::Z), FaceSide::Back);
    assert_eq!(face_along(DVec3::ZERO, DVec3::Z), FaceSide::Edge);
}

/// Returns a cube of side 2 around `center`, its vertices not shared, as in STL.
fn cube(center: Vec3) -> Mesh {
    let mut positions = Vec::new();
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let corner = |u: f32, v: f32| {
                let mut p = [0.0; 3];
                p[axis] = side;
                p[(axis + 1) % 3] = u;
                p[(axis + 2) % 3] = v * side;
                center + Vec3::from(p)
            };
            let [a, b, c, d] = [corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)];
            positions.extend([a, b, c, a, c, d]);
        }
    }
    Mesh { positions, ..Mesh::default() }
}

#[test]
fn a_cube_is_closed_and_turned_outward() {
    for center in [Vec3::ZERO, Vec3::splat(1e4)] {
        let found = mesh_topology(&cube(center));
        let expected = MeshTopology {
            closed: true,
            oriented: true,
            signed_volume: 8.0,
            area: 24.0,
            ..MeshTopology::default()
        };
        assert_eq!(found, expected);
        assert!(!found.inside_out());
    }
    let mut mirrored = cube(Vec3::ZERO);
    for triangle in mirrored.positions.chunks_exact_mut(3) {
        triangle.swap(1, 2);
    }
    let found = mesh_topology(&mirrored);
    assert!(found.inside_out() && found.signed_volume == -8.0);
}

#[test]
fn holes_flips_and_fins_are_counted() {
    let mut open = cube(Vec3::ZERO);
    open.positions.truncate(33);
    let found = mesh_topology(&open);
    assert_eq!((found.closed, found.oriented, found.boundary_edges), (false, true, 3));

    let mut flipped = cube(Vec3::ZERO);
    flipped.positions.swap(0, 1);
    let found = mesh_topology(&flipped);
    assert_eq!((found.closed, found.oriented, found.inside_out()), (true, false, false));

    let mut fin = cube(Vec3::ZERO);
    let (a, b) = (fin.positions[0], fin.positions[1]);
    fin.positions.extend([a, b, Vec3::splat(9.0)]);
    let found = mesh_topology(&fin);
    assert_eq!((found.closed, found.non_manifold_edges, found.boundary_edges), (false, 1, 2));
}

#[test]
fn odd_meshes_do_no_harm() {
    let mut odd = cube(Vec3::ZERO);
    odd.positions.extend([Vec3::ONE, Vec3::ONE, Vec3::X]); // collapsed
    odd.positions.extend([Vec3::NAN, Vec3::ONE, Vec3::X]);
    let found = mesh_topology(&odd);
    assert!(found.closed && found.oriented && found.collapsed == 1);
    // −0 and 0 are equal coordinates.
    let mut zeros = cube(Vec3::ONE);
    for p in zeros.positions.iter_mut().step_by(2) {
        *p = Vec3::from(p.to_array().map(|c| if c == 0.0 { -0.0 } else { c }));
    }
    assert!(mesh_topology(&zeros).closed);

    // Exporters write it for zero.
    let mut noisy = cube(Vec3::ONE);
    for p in noisy.positions.iter_mut().step_by(2) {
        *p = Vec3::from(p.to_array().map(|c| if c == 0.0 { 3e-17 } else { c }));
    }
    assert!(mesh_topology(&noisy).closed);
    // A displacement within rounding, and a gap beyond it.
    let gap = |amount: f32| {
        let mut gap = cube(Vec3::ONE);
        gap.positions[0] += amount;
        mesh_topology(&gap).closed
    };
    assert!(gap(1e-6) && !gap(1e-3));
    let mut written = cube(Vec3::ONE);
    written.positions[0] += 1e-4;
    assert!(!mesh_topology(&written).closed && written_topology(&written, 1e-4).closed);

    let dangling = Mesh { indices: Some(vec![0, 1, 99]), ..cube(Vec3::ZERO) };
    assert_eq!(mesh_topology(&dangling).area, 0.0);
    let lines = Mesh { topology: Topology::Lines, ..cube(Vec3::ZERO) };
    assert!(!mesh_topology(&lines).closed && !mesh_topology(&Mesh::default()).closed);
}

/// Checks real models, whose closedness was determined by the program that made their index.
mod conformance_topology {
    use super::*;
    use std::path::{Path, PathBuf};

    fn data() -> Option<PathBuf> {
        let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
        let folder = std::env::var_os("DURER_DATA").map_or(beside, PathBuf::from);
        let index = folder.join("INDEX.md").is_file();
        if !index {
            println!("skipped: no test data in {}", folder.display());
        }
        index.then_some(folder)
    }

    /// Returns the triangles of a binary STL file; `None` for a text one.
    fn binary_stl(bytes: &[u8]) -> Option<Mesh> {
        let count = u32::from_le_bytes(bytes.get(80..84)?.try_into().ok()?) as usize;
        let records = bytes.get(84..).filter(|r| r.len() == count * 50)?;
        let number = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        let positions = records
            .chunks_exact(50)
            .flat_map(|r| r[12..48].chunks_exact(12))
            .map(|v| Vec3::new(number(v), number(&v[4..]), number(&v[8..])))
            .collect();
        Some(Mesh { positions, ..Mesh::default() })
    }

    #[test]
    fn stl_models_are_closed_where_the_index_says_so() {
        let Some(folder) = data() else { return };
        let index = std::fs::read_to_string(folder.join("INDEX.md")).expect("index");
        let (mut closed, mut open) = (0, 0);
        for line in
            index.lines().filter(|l| l.contains("| 3D mesh STL |") && l.contains("| meshes/"))
        {
            let name = line.split('|').nth(1).expect("name").trim();
            let bytes = std::fs::read(folder.join(name)).expect("model");
            let Some(mesh) = binary_stl(&bytes) else { continue };
            let found = mesh_topology(&mesh);
            let expected = line.contains("; watertight");
            // The index counts the edges of collapsed triangles; without them Benchy is closed.
            assert_eq!(found.closed && found.collapsed == 0, expected, "{name}: {found:?}");
            if found.closed && found.oriented {
                assert!(found.signed_volume > 0.0, "{name}: {found:?}");
            }
            closed += usize::from(expected);
            open += usize::from(!expected);
        }
        assert!(closed >= 10 && open >= 3, "{closed} closed, {open} open");
    }
}
