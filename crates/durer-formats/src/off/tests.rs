use super::*;
use crate::NoResources;
use durer::math::Vec3;

fn result(text: &str) -> Result<Model> {
    read(text.as_bytes(), &NoResources, &ReadOptions::default())
}

fn read_ok(text: &str) -> Model {
    result(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn warnings(model: &Model) -> String {
    model.warnings.iter().map(|w| format!("{w}\n")).collect()
}

const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const RED: Vec4 = Vec4::new(1.0, 0.0, 0.0, 1.0);
const BLUE: Vec4 = Vec4::new(0.0, 0.0, 1.0, 1.0);

#[test]
fn headers_of_all_sorts() {
    for head in
        ["OFF\n4 1 4", "OFF 4 1 4", "OFF4 1 4", "off\n# c\n\n4 1", "4 1 0", "# c\nOFF\n4 # d\n1"]
    {
        let model = read_ok(&format!("{head}\n{SQUARE}4 0 1 2 3\n"));
        let mesh = &model.scene.meshes[0];
        assert_eq!((mesh.triangle_count(), &mesh.faces[..]), (2, &[0][..]), "{head}");
        assert_eq!((mesh.positions[2], model.warnings.len()), (Vec3::new(1.0, 1.0, 0.0), 0));
    }
    for text in ["OFF\n1 2 3", "COFF 3 1 0", "STCN4OFF\n2\n", "OFF BINARY\n", "OFF"] {
        assert!(sniff(text.as_bytes()), "{text}");
    }
    for text in ["OFF we go", "OFFICE 1", "v 1 2 3", "", "4 1 0"] {
        assert!(!sniff(text.as_bytes()), "{text}");
    }
}

#[test]
fn colors_of_vertices_and_faces() {
    let model =
        read_ok("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 0 255 255\n0 1 0 0 255 0\n3 0 1 2\n");
    assert_eq!(model.scene.meshes[0].colors[..2], [RED, BLUE]);
    let model = read_ok("OFF\n3 1 0\n0 0 0 1.0 0 0 1\n1 0 0 0 0 1 1\n0 1 0 0 0.5 0 1\n3 0 1 2\n");
    assert_eq!(model.scene.meshes[0].colors[..2], [RED, BLUE]);
    let model = read_ok(&format!("OFF\n4 2 0\n{SQUARE}3 0 1 2 255 0 0\n3 0 2 3 0 0 1.0 0.5\n"));
    let mesh = &model.scene.meshes[0];
    let color = |t: usize| mesh.triangle(t).map(|v| mesh.colors[v as usize])[0];
    assert_eq!((color(0), mesh.positions.len()), (RED, 6));
    let model = read_ok(&format!("OFF\n4 3 0\n{SQUARE}3 0 1 2 1 0 0\n3 0 2 3 0 0 1\n3 1 2 3 7\n"));
    let mesh = &model.scene.meshes[0];
    let color = |t: usize| mesh.triangle(t).map(|v| mesh.colors[v as usize]);
    assert_eq!((color(0), color(1), color(2)), ([RED; 3], [BLUE; 3], [Vec4::ONE; 3]));
    assert!(warnings(&model).contains("1 face has a color by number"), "{}", warnings(&model));
}

#[test]
fn normals_and_texture_coordinates() {
    let model = read_ok(
        "STCNOFF\n3 1 0\n0 0 0 0 0 2 255 0 0 255 0.25 0.25\n1 0 0 0 0 1 0 0 255 255 1 0\n0 1 0 0 1 0 0 0 255 255 0 1\n3 0 1 2\n",
    );
    let mesh = &model.scene.meshes[0];
    assert_eq!((mesh.normals[0], mesh.tex_coords[0][0]), (Vec3::Z, Vec2::new(0.25, 0.75)));
    assert_eq!((mesh.colors[0], model.warnings.len()), (RED, 0));
}

#[test]
fn lines_points_and_what_is_wrong() {
    let model = read_ok(&format!("OFF\n4 5 0\n{SQUARE}2 0 1\n3 1 2 3\n1 1\n3 0 1 9\n0\n"));
    assert_eq!(model.scene.meshes[1].indices.as_deref(), Some(&[0, 1][..]));
    let text = warnings(&model);
    assert!(text.contains("1 face has a vertex") && text.contains("2 faces have fewer"), "{text}");
    let model = read_ok(&format!("OFF\n4 0 0\n{SQUARE}"));
    assert_eq!(model.scene.meshes[0].topology, Topology::Points);
    for (text, expected) in [
        ("OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "line 4, column 7: this vertex does not exist"),
        ("OFF\n1 1 0\n0 x 0\n", "line 3, column 3: `x` is not a number"),
        ("OFF\nx\n", "line 2, column 1: `x` is not a number of vertices"),
        ("OFF\n3 1 0\n", "the file ends too early"),
        ("OFF\n1 1 0\n0 0 0\n-3 1\n", "`-3` is not a number of vertices of a face"),
        ("4OFF\n1 0 0\n", "four or more dimensions is not supported"),
        ("OFF BINARY\n", "binary OFF is not supported"),
        ("GOFF", "begins with `OFF`, not with `GOFF`"),
    ] {
        let found = result(text).expect_err(text).to_string();
        assert!(found.contains(expected), "{found}");
    }
}

#[test]
fn a_file_that_ends_early_is_read_as_far_as_it_goes() {
    let model = read_ok(&format!("OFF\n4 4000000000 0\n{SQUARE}3 0 1 2\n3 0 2"));
    assert_eq!(model.scene.triangle_count(), 1);
    assert!(warnings(&model).contains("1 of 4000000000 faces"), "{}", warnings(&model));
    let model = read_ok(&format!("OFF\n4 3 0\n{SQUARE}3 0 1 2\n3 0 x 3\n3 0 1 2\n"));
    assert_eq!(model.scene.triangle_count(), 1);
    assert!(warnings(&model).contains("`x` is not a number: 4 of 4 vertices and 1 of 3 faces"));
    let model = read_ok("OFF\n4000000000 1 0\n0 0 0\n1 1");
    assert!(warnings(&model).contains("1 of 4000000000 vertices"), "{}", warnings(&model));
}

#[test]
fn a_concave_face_is_the_polygon() {
    let text = "OFF\n5 1 0\n0 0 0\n2 0 0\n2 2 0\n1 0.5 0\n0 2 0\n5 0 1 2 3 4\n";
    let model = read_ok(text);
    let mesh = &model.scene.meshes[0];
    let area: f32 = (0..mesh.triangle_count())
        .map(|t| mesh.triangle(t).map(|v| mesh.positions[v as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0)
        .sum();
    assert_eq!((area, &mesh.faces[..]), (2.5, &[0][..]));
}
