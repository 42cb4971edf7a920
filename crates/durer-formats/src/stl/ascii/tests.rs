use super::*;
use crate::{NoResources, ReadOptions, stl};
use durer::math::Vec3;
use durer::scene::UpAxis;

fn read_ok(text: &str) -> Model {
    stl::read(text.as_bytes(), &NoResources, &ReadOptions::default()).expect("readable")
}

fn message(text: &str) -> String {
    let e = stl::read(text.as_bytes(), &NoResources, &ReadOptions::default());
    e.expect_err("broken").to_string()
}

fn warnings(model: &Model) -> Vec<String> {
    model.warnings.iter().map(|w| w.to_string()).collect()
}

#[test]
fn solids_and_odd_layout() {
    let text = "\u{feff}  SOLID a b\r\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 \
                vertex 0 1 0 endloop endfacet\nendsolid\nsolid c\n facet\nouter loop\nvertex 0 0 5e-1\n\
                vertex 1 0 .5\nvertex 0 1 +.5\nendloop\nendfacet\nendsolid c\n";
    let model = read_ok(text);
    let mesh = &model.scene.meshes[0];
    assert_eq!(mesh.positions[3], Vec3::new(0.0, 0.0, 0.5));
    let parts: Vec<_> = mesh.parts.iter().map(|p| (p.range.clone(), p.name.as_str())).collect();
    assert_eq!(parts, [(0..1, "a b"), (1..2, "c")]);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    assert_eq!(model.scene.up_axis, UpAxis::Z);
}

#[test]
fn broken_text_says_where() {
    let start = "solid\nfacet normal 0 0 1\nouter loop\n";
    for (text, expected) in [
        ("vertex 1 2", "line 4: `vertex` has 2"),
        ("vertex 1 b 2", "line 4, column 10: `b`"),
        ("vertex 1 2x 2", "line 4: `2x` is not a number"),
        ("vertex 1 2 3", "first facet"),
        ("endloop endfacet", "no facet has three vertices"),
    ] {
        let found = message(&format!("{start}{text}"));
        assert!(found.contains(expected), "{found}");
    }
    assert!(message("solid nonsense\nall along\n").contains("not STL"));
    let cut = format!("{start}vertex 1 2 3\nvertex 2 3 4\nvertex 1 5 6\nendloop\nendfacet\nfacet");
    let model = read_ok(&cut);
    assert_eq!((model.scene.triangle_count(), model.warnings.len()), (1, 1));
}

const CORNERS: &str = "vertex 0 0 0 vertex 1 0 0 vertex 0 1 0";

#[test]
fn ends_in_two_words_or_missing() {
    let facet = format!("facet normal 0 0 1\nouter loop\n{CORNERS}\nend loop\nEnd Facet\n");
    let model = read_ok(&format!("solid a\n{facet}{facet}end solid a\n"));
    assert_eq!((model.scene.triangle_count(), model.warnings.len()), (2, 0));
    let open = format!("facet normal 0 0 1\nouter loop\n{CORNERS}\n");
    let model = read_ok(&format!("solid\n{open}{open}{open}endsolid"));
    assert_eq!(model.scene.triangle_count(), 3);
    let model = read_ok(&format!("solid\n{open}endloop\nendfacet\n"));
    assert!(warnings(&model)[0].contains("without `endsolid`"));
}

#[test]
fn a_file_in_one_line() {
    let facet = format!("facet normal 0 0 1 outer loop {CORNERS} endloop endfacet");
    let text = format!(
        "solid my facet {facet} {facet} endsolid my facet solid b c FACET NORMAL 0 0 1 {CORNERS} endfacet endsolid b c"
    );
    let model = read_ok(&text);
    let mesh = &model.scene.meshes[0];
    let parts: Vec<_> = mesh.parts.iter().map(|p| (p.range.clone(), p.name.as_str())).collect();
    assert_eq!(parts, [(0..2, "my facet"), (2..3, "b c")]);
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
}

#[test]
fn facets_of_more_corners_are_polygons() {
    let text = format!(
        "solid\nfacet normal 0 0 1\n{CORNERS}\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n\
         vertex 2 0 0\nvertex 2 2 0\nvertex 1.5 0.5 0\nendloop\nendfacet\n\
         facet normal 0 0 1\n{CORNERS}\nendfacet\nfacet normal 0 0 1\nvertex 1 1 1\nendfacet\nendsolid\n"
    );
    let model = read_ok(&text);
    let mesh = &model.scene.meshes[0];
    assert_eq!((mesh.triangle_count(), &mesh.faces[..]), (4, &[0, 1, 3][..]));
    assert_eq!(
        warnings(&model),
        ["line 18, column 1: 1 facet has fewer than three vertices and was left out"]
    );
    let area: f32 = (1..3)
        .map(|t| mesh.triangle(t).map(|v| mesh.positions[v as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0)
        .sum();
    assert_eq!(area, 1.0);
}

#[test]
fn commas_between_numbers_and_in_them() {
    let file = |corners: &str| {
        read_ok(&format!("solid\nfacet normal 0 0 1\n{corners} vertex 0 1 0\nendfacet\nendsolid"))
    };
    let between = file("vertex 1, 2, 3 vertex 2 0 0");
    assert_eq!(between.scene.meshes[0].positions[0], Vec3::new(1.0, 2.0, 3.0));
    assert!(between.warnings.is_empty());
    let decimal = file("vertex 1,5 2,25 -3,0e1 vertex 2 0 0");
    assert_eq!(decimal.scene.meshes[0].positions[0], Vec3::new(1.5, 2.25, -30.0));
    assert!(warnings(&decimal)[0].contains("3 numbers have decimal commas"));
}

#[test]
fn long_lines_cost_no_more_than_their_length() {
    let text = format!("solid {}", "solid facet normal endsolid ".repeat(40_000));
    let _ = stl::read(text.as_bytes(), &NoResources, &ReadOptions::default());
    let names = format!("solid {CORNERS} endfacet {}", "endsolid x ".repeat(40_000));
    let _ = stl::read(names.as_bytes(), &NoResources, &ReadOptions::default());
}

#[test]
fn a_vertex_that_is_none_costs_its_facet() {
    let facet = format!("facet normal 0 0 1\nouter loop\n{CORNERS}\nendloop\nendfacet\n");
    let bad = facet.replace("vertex 1 0 0", "vertex 1 0");
    let worse = facet.replace("vertex 1 0 0", "vertex x vertex 0 0 0 vertex 0 0 0");
    let model = read_ok(&format!("solid\n{facet}{bad}{worse}{facet}endsolid\n"));
    assert_eq!(model.scene.triangle_count(), 2);
    let text = warnings(&model).join("\n");
    assert!(text.contains("line 9, column 14: 2 vertices are not three numbers"), "{text}");
    let model =
        read_ok(&format!("solid\n{facet}facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0"));
    assert_eq!(model.scene.triangle_count(), 1);
    assert!(warnings(&model).join("\n").contains("without `endsolid`"));
}
