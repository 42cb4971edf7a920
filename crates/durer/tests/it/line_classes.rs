//! Which edges are lines where it is delicate: thin triangles, materials, faces that share a vertex.

use crate::line_scenes::{Triangle, cuboid, quad, soup, view};
use durer::math::DVec3;
use durer::scene::{Material, Part, Scene};
use durer::target::drawing::{Drawing, LineClass};
use durer::trace::NoTrace;
use durer::view::View;
use durer::visibility::line::ClassSet;
use durer::visibility::line::hidden_line::{Options, draw};

fn drawn(scene: &Scene, view: &View) -> Drawing {
    draw(scene, view, &Options::default(), &mut NoTrace).expect("drawing")
}

fn length(drawing: &Drawing, class: LineClass) -> f64 {
    drawing.length(|l| l.class == class)
}

fn above() -> View {
    view(DVec3::ZERO, DVec3::Z, 8.0, false)
}

#[test]
fn where_materials_meet_there_is_a_line() {
    let mut triangles =
        quad([[-2.0, -1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [-2.0, 1.0, 0.0]]);
    triangles.extend(quad([[0.0, -1.0, 0.0], [2.0, -1.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]]));
    let mut scene = soup(&triangles);
    let plain = drawn(&scene, &above());
    assert_eq!(length(&plain, LineClass::Material), 0.0);
    scene.materials = vec![Material::default()];
    let part = |range, material| Part { range, material, name: String::new() };
    scene.meshes[0].parts = vec![part(0..2, None), part(2..4, Some(0))];
    let found = drawn(&scene, &above());
    assert!((length(&found, LineClass::Material) - 2.0).abs() < 1e-6, "{:?}", found.lines);
    assert!((length(&found, LineClass::Border) - 12.0).abs() < 1e-5, "{:?}", found.lines);
}

#[test]
fn triangles_without_a_height_make_no_creases() {
    // A sheet whose diagonal passes through a vertex of one side only; what closes the gap is a line.
    let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]: [f64; 2]| DVec3::new(x, y, 0.0));
    let m = DVec3::ZERO;
    let sheet: Vec<Triangle> = vec![[a, b, m], [b, c, m], [a, c, d], [a, m, c]];
    let found = drawn(&soup(&sheet), &above());
    let classes: Vec<_> = found.lines.iter().map(|l| l.class).collect();
    assert_eq!(classes, [LineClass::Border]);
}

#[test]
fn faces_that_share_or_touch_with_a_vertex_meet_beyond_it_too() {
    let plane =
        [DVec3::new(-2.0, -2.0, 0.0), DVec3::new(2.0, -2.0, 0.0), DVec3::new(0.0, 2.0, 0.0)];
    // A vertex of the plane's own, and one that lies on it.
    for start in [plane[0], DVec3::new(-0.5, -1.0, 0.0)] {
        let end = DVec3::new(0.5, -0.5, 0.0);
        let through = [start, end + DVec3::Z, end - DVec3::Z];
        let options =
            Options { classes: ClassSet::of(&[LineClass::Intersection]), ..Options::default() };
        let found = draw(&soup(&[plane, through]), &above(), &options, &mut NoTrace);
        let found = length(&found.expect("drawing"), LineClass::Intersection);
        assert!((found - start.distance(end)).abs() < 1e-5, "{start}: {found}");
    }
}

#[test]
fn walls_hide_from_an_eye_inside_too() {
    // In a closed room; what is before the wall is seen, what is behind it is not.
    let v = view(DVec3::ZERO, DVec3::NEG_Y, 0.5, true);
    let visible = |y: [f64; 2]| {
        let mut triangles = cuboid([-2.0; 3], [2.0; 3]);
        triangles.extend(cuboid([-0.1, y[0], -0.1], [0.1, y[1], 0.1]));
        drawn(&soup(&triangles), &v).length(|l| l.is_visible())
    };
    assert!(visible([1.6, 1.8]) > 0.1);
    assert_eq!(visible([2.2, 2.4]), 0.0);
}
