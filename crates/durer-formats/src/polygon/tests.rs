use super::*;
use durer::math::Vec3;
use durer::scene::Part;

/// Returns a mesh of one polygon, as a fan, moved into space by `place`.
fn fan(outline: &[[f64; 2]], place: impl Fn([f64; 2]) -> Vec3) -> Mesh {
    let n = outline.len() as u32;
    let indices = (2..n).flat_map(|i| [0, i - 1, i]).collect();
    let positions = outline.iter().map(|p| place(*p)).collect();
    Mesh { positions, indices: Some(indices), faces: vec![0], ..Mesh::default() }
}

fn flat([x, y]: [f64; 2]) -> Vec3 {
    Vec3::new(x as f32, y as f32, 0.0)
}

fn cut(mut mesh: Mesh) -> (Mesh, Model) {
    let mut model = Model::default();
    recut(&mut model, &mut mesh, &Limits::default()).unwrap();
    mesh.check().unwrap();
    (mesh, model)
}

fn triangle_normals(mesh: &Mesh) -> Vec<DVec3> {
    let normal = |i| {
        let [a, b, c] = mesh.triangle(i).map(|v| mesh.positions[v as usize].as_dvec3());
        (b - a).cross(c - a) / 2.0
    };
    (0..mesh.triangle_count()).map(normal).collect()
}

/// Returns the sum of the triangles' areas; all must face along `up`.
fn area(mesh: &Mesh, up: DVec3) -> f64 {
    let normals = triangle_normals(mesh);
    assert!(normals.iter().all(|n| n.dot(up) > 0.0), "{normals:?}");
    normals.iter().map(|n| n.length()).sum()
}

fn shoelace(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0
}

const DART: [[f64; 2]; 4] = [[2.0, 0.0], [0.5, 0.5], [0.0, 2.0], [0.0, 0.0]];
const U: [[f64; 2]; 8] = [
    [0.0, 0.0],
    [3.0, 0.0],
    [3.0, 3.0],
    [2.0, 3.0],
    [2.0, 1.0],
    [1.0, 1.0],
    [1.0, 3.0],
    [0.0, 3.0],
];
/// A square with a square hole; the bridge between them is walked in both directions.
const KEYHOLE: [[f64; 2]; 10] = [
    [0.0, 0.0],
    [4.0, 0.0],
    [4.0, 4.0],
    [0.0, 4.0],
    [0.0, 0.0],
    [1.0, 1.0],
    [1.0, 3.0],
    [3.0, 3.0],
    [3.0, 1.0],
    [1.0, 1.0],
];

#[test]
fn convex_polygons_stay_fans() {
    let ring: Vec<[f64; 2]> = (0..40)
        .map(|i| f64::from(i) * std::f64::consts::TAU / 40.0)
        .map(|a| [libm::cos(a), libm::sin(a)])
        .collect();
    // Corners on a straight border, a double corner, and a polygon entirely visible from its first corner.
    let straight = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 1.0]];
    let star = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [0.0, 2.0]];
    for outline in [&ring[..], &straight, &star] {
        let mesh = fan(outline, |[x, y]| Vec3::new(x as f32, y as f32, (x - 3.0 * y) as f32));
        assert_eq!(cut(mesh.clone()).0, mesh);
    }
    // A quad that is bent by less than a right angle.
    let bent = fan(&star[..], |[x, y]| Vec3::new(x as f32, y as f32, (x * y * 0.3) as f32));
    assert_eq!(cut(bent.clone()).0, bent);
}

#[test]
fn concave_outlines_are_filled_to_their_border_from_every_first_corner_and_both_sides() {
    let comb: Vec<[f64; 2]> = (0..20)
        .map(|i| [f64::from(i), if i % 2 == 0 { 4.0 } else { 1.0 }])
        .chain([[19.0, 0.0], [0.0, 0.0]])
        .rev()
        .collect();
    for outline in [&DART[..], &U, &KEYHOLE, &comb] {
        let exact = shoelace(outline);
        assert!(exact > 0.0);
        for start in 0..outline.len() {
            let mut turned = outline.to_vec();
            turned.rotate_left(start);
            let (mesh, model) = cut(fan(&turned, flat));
            assert!((area(&mesh, DVec3::Z) - exact).abs() <= 1e-12 * exact, "{turned:?}");
            assert_eq!(mesh.triangle_count(), outline.len() - 2);
            assert!(model.warnings.is_empty(), "{:?}", model.warnings);
            turned.reverse();
            let (mesh, _) = cut(fan(&turned, flat));
            assert!((area(&mesh, -DVec3::Z) - exact).abs() <= 1e-12 * exact);
        }
    }
}

#[test]
fn every_direction_and_bent_polygons_are_seen_along_newells_normal() {
    let tilted = |[x, y]: [f64; 2]| Vec3::new((x - y) as f32, (x + y) as f32, (2.0 * x + y) as f32);
    let up = tilted([1.0, 0.0]).as_dvec3().cross(tilted([0.0, 1.0]).as_dvec3());
    for (place, up) in [
        (
            &(|[x, y]: [f64; 2]| Vec3::new(0.0, x as f32, y as f32)) as &dyn Fn([f64; 2]) -> Vec3,
            DVec3::X,
        ),
        (&|[x, y]| Vec3::new(y as f32, 7.0, x as f32), DVec3::Y),
        (&|[x, y]| Vec3::new(x as f32, 7.0, y as f32), -DVec3::Y),
        (&tilted, up),
    ] {
        for outline in [&DART[..], &U, &KEYHOLE] {
            let exact = shoelace(outline) * up.length();
            let (mesh, _) = cut(fan(outline, place));
            assert!((area(&mesh, up) - exact).abs() <= 1e-12 * exact, "{outline:?} {up}");
        }
    }
    let bent = fan(&U, |[x, y]| Vec3::new(x as f32, y as f32, (0.1 * x * x) as f32));
    let (mesh, _) = cut(bent);
    let seen: f64 = triangle_normals(&mesh).iter().map(|n| n.z).sum();
    assert!(triangle_normals(&mesh).iter().all(|n| n.z > 0.0) && (seen - 7.0).abs() < 1e-6);
}

#[test]
fn corners_on_straight_borders_stay_corners() {
    let mut outline = Vec::new();
    for (i, p) in U.iter().enumerate() {
        let q = U[(i + 1) % U.len()];
        outline.extend([*p, [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0], *p, *p].iter().take(2));
        outline.push(q);
    }
    let (mesh, _) = cut(fan(&outline, flat));
    assert!((area(&mesh, DVec3::Z) - 7.0).abs() < 1e-12);
    let border = |a: [f64; 2], b: [f64; 2]| {
        let ends = [flat(a), flat(b)];
        let has = |i: usize| {
            let p = mesh.triangle(i).map(|v| mesh.positions[v as usize]);
            (0..3).any(|k| [p[k], p[(k + 1) % 3]] == ends)
        };
        (0..mesh.triangle_count()).filter(|i| has(*i)).count()
    };
    for w in outline.windows(2).filter(|w| w[0] != w[1]) {
        assert_eq!(border(w[0], w[1]), 1, "{w:?}");
    }
}

#[test]
fn crossing_outlines_are_filled_by_the_non_zero_rule_with_interpolated_attributes() {
    let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    let mut mesh = fan(&bow, flat);
    mesh.tex_coords = vec![bow.iter().map(|p| durer::math::Vec2::new(p[0] as f32, 1.0)).collect()];
    mesh.normals = vec![Vec3::X, Vec3::Y, Vec3::X, Vec3::Y];
    let (mesh, model) = cut(mesh);
    assert_eq!(mesh.positions[4], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(mesh.tex_coords[0][4], durer::math::Vec2::ONE);
    assert!((mesh.normals[4] - Vec3::new(0.5, 0.5, 0.0).normalize()).length() < 1e-6);
    let normals = triangle_normals(&mesh);
    assert!(normals.iter().all(|n| n.z.signum() == normals[0].z.signum()), "one front");
    assert_eq!(normals.iter().map(|n| n.length()).sum::<f64>(), 2.0);
    assert_eq!(
        model.warnings[0].to_string(),
        "face 1: 1 polygon crosses itself; filled by the non-zero rule"
    );
    // A star of five corners: parts wound around twice are inside too.
    let star: Vec<[f64; 2]> = (0..5)
        .map(|i| f64::from(2 * i) * std::f64::consts::TAU / 5.0)
        .map(|a| [libm::cos(a), libm::sin(a)])
        .collect();
    let (mesh, model) = cut(fan(&star, flat));
    // Crossings are rounded to single precision, which may reverse slivers.
    let heights = triangle_normals(&mesh).into_iter().map(|n| n.z);
    assert!(heights.clone().all(|z| z > -1e-7));
    assert!((heights.sum::<f64>() - 1.122_569_941_4).abs() < 1e-6);
    assert_eq!(model.warnings.len(), 1);
}

#[test]
fn twisted_faces_whose_edges_pass_each_other_stay_fans() {
    let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.1]];
    let mesh = fan(&bow, |[x, y]| Vec3::new(x as f32, y as f32, (0.1 * x * y) as f32));
    let (same, model) = cut(mesh.clone());
    assert!(same == mesh && model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn parts_and_faces_move_along_where_faces_change_their_number_of_triangles() {
    let mut mesh = fan(&KEYHOLE, flat);
    // A triangle, the keyhole with a spike, a bow tie, a triangle.
    let spiked: Vec<u32> = vec![0, 1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
    let fan_of = |c: &[u32]| (2..c.len()).flat_map(|i| [c[0], c[i - 1], c[i]]).collect::<Vec<_>>();
    let pieces = [vec![0, 1, 2], fan_of(&spiked), fan_of(&[0, 2, 1, 3]), vec![5, 6, 7]];
    mesh.indices = Some(pieces.concat());
    mesh.faces = vec![0, 1, 11, 13];
    let part = |range| Part { range, material: None, name: String::new() };
    mesh.parts = vec![part(0..0), part(0..11), part(11..13), part(13..13), part(13..14)];
    let (mesh, _) = cut(mesh);
    assert_eq!(mesh.faces, [0, 1, 9, 11]);
    let ranges: Vec<_> = mesh.parts.iter().map(|p| p.range.clone()).collect();
    assert_eq!(ranges, [0..0, 0..9, 9..11, 11..11, 11..12]);
    assert_eq!(mesh.triangle(11), [5, 6, 7]);
    let all: f64 = triangle_normals(&mesh).iter().map(|n| n.length()).sum();
    assert!((all - (8.0 + 12.0 + 8.0 + 2.0)).abs() < 1e-12, "{all}");
}

#[test]
fn what_has_no_area_or_no_place_is_left_alone() {
    let line = fan(&[[0.0, 0.0], [3.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.5, 0.0]], flat);
    assert_eq!(cut(line.clone()).0, line);
    let mut lost = fan(&U, flat);
    lost.positions[3].x = f32::NAN;
    let (mesh, _) = cut(lost.clone());
    assert_eq!(mesh.indices, lost.indices);
}

/// Checks a spiral corridor of ten thousand corners, and a random outline with crossings everywhere.
#[test]
fn large_outlines_take_no_time() {
    let turn = |i: u32, width: f64| {
        let a = f64::from(i) * 0.02;
        [(a + width) * libm::cos(a), (a + width) * libm::sin(a)]
    };
    let spiral: Vec<_> =
        (0..5000).map(|i| turn(i, 3.0)).chain((0..5000).rev().map(|i| turn(i, 0.0))).collect();
    let rounded: Vec<_> = spiral.iter().map(|p| p.map(|v| f64::from(v as f32))).collect();
    let exact = shoelace(&rounded).abs();
    let (mesh, model) = cut(fan(&rounded, flat));
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    let up = DVec3::Z * shoelace(&rounded).signum();
    assert!((area(&mesh, up) - exact).abs() <= 1e-12 * exact);
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 40) as f64
    };
    let noise: Vec<[f64; 2]> = (0..10_000).map(|_| [random(), random()]).collect();
    let (_, model) = cut(fan(&noise, flat));
    assert!(model.warnings[0].message.contains("too intricate"), "{:?}", model.warnings);
}
