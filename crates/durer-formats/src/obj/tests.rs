//! Small files, each of a common kind.

use crate::{Model, NoResources, ReadOptions, Result};
use durer::math::{DVec3, Vec3};
use durer::scene::Mesh;

fn read(text: impl AsRef<[u8]>) -> Result<Model> {
    super::read(text.as_ref(), &NoResources, &ReadOptions::default())
}

fn mesh(model: &Model) -> &Mesh {
    &model.scene.meshes[0]
}

fn words(model: &Model) -> Vec<String> {
    model.warnings.iter().map(ToString::to_string).collect()
}

/// Returns the sum of the triangles' areas.
fn area(mesh: &Mesh) -> f64 {
    let twice = |i| {
        let [a, b, c] = mesh.triangle(i).map(|v| mesh.positions[v as usize].as_dvec3());
        (b - a).cross(c - a).length()
    };
    (0..mesh.triangle_count()).map(twice).sum::<f64>() / 2.0
}

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
const CUBE_FACES: &str = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

#[test]
fn polygons_are_filled_to_their_outline() {
    let dart = "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 2 3 4 1";
    let u =
        "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 8";
    let keyhole = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\n\
                   v 3 1 0\nv 1 1 0\nf 1 2 3 4 5 6 7 8 9 10";
    // Both ends of the bridge are often one vertex.
    let shared = keyhole.replace("f 1 2 3 4 5 6 7 8 9 10", "f 1 2 3 4 1 6 7 8 9 6");
    for (text, expected) in [(dart, 1.0), (u, 7.0), (keyhole, 12.0), (&shared, 12.0)] {
        let model = read(text).unwrap();
        assert!((area(mesh(&model)) - expected).abs() < 1e-12, "{text}");
        assert_eq!((words(&model), mesh(&model).faces.as_slice()), (vec![], &[0][..]));
    }
    let bow = read("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nvt 0 0\nf 1/1 2/1 3/1 4/1").unwrap();
    assert_eq!((area(mesh(&bow)), mesh(&bow).positions.len()), (2.0, 5));
    assert_eq!(words(&bow), ["face 1: 1 polygon crosses itself; filled by the non-zero rule"]);
}

#[test]
fn one_smoothing_group_rounds_a_cube_off() {
    let model = read(format!("{CUBE}s 1\n{CUBE_FACES}")).unwrap();
    let mesh = mesh(&model);
    assert_eq!((mesh.positions.len(), mesh.normals.len()), (8, 8));
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        let out = (*p - Vec3::splat(0.5)).normalize();
        assert!((*n - out).length() < 1e-6, "{p} {n}");
    }
    assert_eq!(words(&model), Vec::<String>::new());
}

#[test]
fn normals_are_averaged_within_their_group_only_and_over_seams_of_textures() {
    // Two squares at a right angle along x = 1, then one that continues flat.
    let squares = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nvt 0 0\nvt 1 1\n";
    let normals = |faces: &str| mesh(&read(format!("{squares}{faces}")).unwrap()).clone();
    let at = |mesh: &Mesh, p: Vec3| {
        let all = mesh.positions.iter().zip(&mesh.normals);
        all.filter(|(q, _)| **q == p).map(|(_, n)| *n).collect::<Vec<_>>()
    };
    let both = (Vec3::Z - Vec3::X).normalize();
    // The second square faces -x; corners at x = 1 have one normal, in one group.
    let one = normals("s 3\nf 1/1 2/1 3/1 4/1\nf 2/2 5/2 6/2 3/2\n");
    for n in at(&one, Vec3::X) {
        assert!((n - both).length() < 1e-6, "{n}");
    }
    assert_eq!(at(&one, Vec3::X).len(), 2, "a seam of the texture");
    let two = normals("s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n");
    assert_eq!(at(&two, Vec3::X), [Vec3::Z, Vec3::NEG_X]);
    // Off: no normal, so the face's own is used; before any statement it is off.
    let flat = normals("f 1 2 3 4\ns 7\nf 2 5 6 3\ns off\nf 1 2 3\n");
    assert_eq!(at(&flat, Vec3::X), [Vec3::ZERO, Vec3::NEG_X]);
    let own = normals("vn 1 0 0\ns 7\nf 1//1 2//1 3//1\nf 2 5 6 3\n");
    assert_eq!(at(&own, Vec3::X), [Vec3::X, Vec3::NEG_X]);
}

#[test]
fn without_groups_normals_are_left_to_the_renderer() {
    for switch in ["", "s off\n", "s 0\n"] {
        let model = read(format!("{CUBE}{switch}{CUBE_FACES}")).unwrap();
        assert!(mesh(&model).normals.is_empty() && mesh(&model).positions.len() == 8, "{switch}");
    }
}

#[test]
fn what_is_wrong_with_an_element_costs_that_element() {
    let text = format!(
        "{CUBE}{CUBE_FACES}f 1 2 99\nf 1 x 2\nf 1 2 3 -20\nf 1 2\nl 1 2 0\np 77 1\nf 1 2 3"
    );
    let model = read(&text).unwrap();
    assert_eq!((model.scene.triangle_count(), model.scene.meshes.len()), (13, 1));
    assert_eq!(mesh(&model).faces.len(), 7);
    let words = words(&model);
    assert_eq!(words.len(), 2, "{words:?}");
    assert!(
        words[0].starts_with("line 15, column 7: 5 faces, lines or points have a wrong corner")
    );
    assert!(words[0].ends_with(
        "the first: vertex 99 does not exist: there are 8, counted from 1, or back from -1"
    ));
    assert!(words[1].starts_with("line 18: 1 element has too few corners"));
    let error = read("v 0 0 0\nv 1 0 0\nf 1 2 3\nf 1 2 4").unwrap_err().to_string();
    assert!(error.starts_with("line 3, column 7: vertex 3 does not exist"), "{error}");
}

#[test]
fn a_vertex_without_numbers_keeps_its_number() {
    let model = read("v 0 0 0\nv 1 0 oops\nv 1 1 0\nv 0 1 0\nf 1 3 4\nf 1 2 3").unwrap();
    assert!(
        mesh(&model).positions[1].is_nan() && mesh(&model).positions[2] == Vec3::new(1., 1., 0.)
    );
    let words = words(&model);
    assert!(
        words[0].contains("1 vertex, texture coordinate or normal is not readable"),
        "{words:?}"
    );
    assert!(words[0].contains("line 2, column 7: ") && words[0].contains("`oops` is not a number"));
    let error = read("v 0 0 0\nv 1 0 0\nv 0 one 0\nf 1 2 3\n").unwrap_err().to_string();
    assert_eq!(error, "line 3, column 5: `one` is not a number");
    assert!(read("v a b c\nv 1\nf 1 1 1").unwrap_err().to_string().contains("`a` is not a number"));
}

#[test]
fn names_may_be_latin_1_and_hold_blanks() {
    let model =
        read(b"v 0 0 0\nv 1 0 0\nv 0 1 0\no K\xf6rper\ng \xc4 b\nusemtl Dunkles Gr\xfcn\nf 1 2 3")
            .unwrap();
    // With a single object, its groups are the parts.
    assert_eq!(mesh(&model).parts[0].name, "Ä b");
    assert_eq!(model.scene.materials[0].name, "Dunkles Grün");
}

#[test]
fn line_ends_marks_and_joined_lines_are_read_alike() {
    let plain = read(format!("{CUBE}{CUBE_FACES}")).unwrap();
    for text in [
        format!("\u{feff}{CUBE}{CUBE_FACES}"),
        format!("{CUBE}{CUBE_FACES}").replace('\n', "\r"),
        format!("{CUBE}{CUBE_FACES}").replace("f 1 3", "f 1 \\\r\n 3"),
    ] {
        assert_eq!(read(&text).unwrap(), plain, "{text:?}");
    }
}

#[test]
fn faces_wind_as_their_outline_does() {
    let clockwise = read("v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 4 3 2").unwrap();
    let mesh = mesh(&clockwise);
    for i in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.triangle(i).map(|v| mesh.positions[v as usize].as_dvec3());
        assert!((b - a).cross(c - a).dot(DVec3::Z) < 0.0);
    }
}

#[test]
fn lines_of_a_material_that_is_not_defined_have_none() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl nowhere\nl 1 2\np 3\nf 1 2 3\n";
    let model = read(text).unwrap();
    let materials: Vec<_> = model.scene.meshes.iter().map(|m| m.parts[0].material).collect();
    assert_eq!(materials, [Some(0), None, None]);
}
