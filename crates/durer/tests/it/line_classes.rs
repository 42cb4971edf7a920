//! The classes of edges in delicate cases: thin triangles, materials, faces that share a vertex.

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

/// Returns a roof along x whose ridge turns by these angles, in degrees, in order.
fn ridge(angles: &[f64]) -> Vec<Triangle> {
    let eaves = |i: usize, y: f64| {
        let slope = (angles[i.min(angles.len() - 1)] / 2.0).to_radians().tan();
        DVec3::new(i as f64, y, -slope)
    };
    let mut triangles = Vec::new();
    for i in 0..angles.len() {
        let [a, b] = [i, i + 1].map(|i| DVec3::new(i as f64, 0.0, 0.0));
        let [l, r] = [1.0, -1.0].map(|y| eaves(i, y));
        let [next_l, next_r] = [1.0, -1.0].map(|y| eaves(i + 1, y));
        triangles.extend([[a, b, l], [b, next_l, l], [b, a, r], [b, r, next_r]]);
    }
    triangles
}

#[test]
fn creases_that_get_blunter_go_on_where_that_is_requested() {
    let mut roof = ridge(&[60.0, 50.0, 35.0, 30.0, 20.0]);
    let view = view(DVec3::new(2.5, 0.0, 0.0), DVec3::Z, 8.0, false);
    let crease_length = |roof: &[Triangle], end: f64| {
        let options = Options { crease_end: end.to_radians(), ..Options::default() };
        length(
            &draw(&soup(roof), &view, &options, &mut NoTrace).expect("drawing"),
            LineClass::Crease,
        )
    };
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-3, "{found} instead of {expected}");
    };
    for _ in 0..2 {
        near(crease_length(&roof, 180.0), 2.0);
        near(crease_length(&roof, 40.0), 2.0);
        near(crease_length(&roof, 32.0), 3.0);
        near(crease_length(&roof, 25.0), 4.0);
        near(crease_length(&roof, 10.0), 5.0);
        roof.reverse();
    }
    // No crease begins, so none continues.
    near(crease_length(&ridge(&[35.0, 30.0, 35.0]), 25.0), 0.0);
}

#[test]
fn triangles_without_a_height_make_no_creases() {
    // A sheet whose diagonal passes through a vertex of one side only; the edges that close the gap are lines.
    let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]: [f64; 2]| DVec3::new(x, y, 0.0));
    // On it, or as far from it as 24-bit numbers may put it: upright, and turned over.
    for m in [DVec3::ZERO, DVec3::new(0.0, 0.0, 4e-7), DVec3::new(-2e-7, 2e-7, -4e-7)] {
        let sheet: Vec<Triangle> = vec![[a, b, m], [b, c, m], [a, c, d], [a, m, c]];
        let found = drawn(&soup(&sheet), &above());
        let classes: Vec<_> = found.lines.iter().map(|l| l.class).collect();
        assert_eq!(classes, [LineClass::Border], "{m}");
    }
}

#[test]
fn slivers_that_rounding_turns_out_of_a_surface_make_no_lines() {
    // The same, with coordinates of five digits: upright, turned over, leaning.
    let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]: [f64; 2]| DVec3::new(x, y, 0.0));
    let shown = |triangles: &[Triangle], tolerance: f64| {
        let options = Options { tolerance, ..Options::default() };
        let found = draw(&soup(triangles), &above(), &options, &mut NoTrace).expect("drawing");
        [LineClass::Silhouette, LineClass::Crease].map(|c| length(&found, c)).iter().sum::<f64>()
    };
    let down = DVec3::new(-3e-5, 3e-5, -4e-5);
    for m in [DVec3::new(0.0, 0.0, 5e-5), down, DVec3::new(3e-5, -3e-5, 5e-5)] {
        let sheet: Vec<Triangle> = vec![[a, b, m], [b, c, m], [a, c, d], [a, m, c]];
        assert_eq!(shown(&sheet, 5e-5), 0.0, "{m}");
        // Below that tolerance they are classified as higher ones are.
        assert!(shown(&sheet, 1e-6) > 2.7, "{m}");
    }
    // A step of that height has a riser of two triangles; the faces of a ridge have no continuation.
    let [near, far] = [-1.0, 1.0].map(|y| {
        [[-1.0, 0.0], [0.0, 0.0], [0.0, 5e-5], [1.0, 5e-5]]
            .map(|[x, z]: [f64; 2]| DVec3::new(x, y, z))
    });
    let strip = |i: usize| [[near[i], near[i + 1], far[i + 1]], [near[i], far[i + 1], far[i]]];
    let step: Vec<Triangle> = (0..3).flat_map(strip).collect();
    assert!((shown(&step, 5e-5) - 2.0).abs() < 1e-4);
    let [low, high] = [-1e-5, 1e-5].map(|x| DVec3::new(x, 1.0, 0.0));
    let eaves = [DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, -1.0)];
    let roof =
        [[DVec3::NEG_Y, high, low], [DVec3::NEG_Y, low, eaves[0]], [high, DVec3::NEG_Y, eaves[1]]];
    assert!(shown(&roof, 5e-5) > 1.9);
}

#[test]
fn faces_that_share_or_touch_with_a_vertex_meet_beyond_it_too() {
    let plane =
        [DVec3::new(-2.0, -2.0, 0.0), DVec3::new(2.0, -2.0, 0.0), DVec3::new(0.0, 2.0, 0.0)];
    // A vertex of the plane itself, and one that lies on the plane.
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
    // In a closed room: edges in front of the wall are visible, edges behind it are not.
    let v = view(DVec3::ZERO, DVec3::NEG_Y, 0.5, true);
    let visible = |y: [f64; 2]| {
        let mut triangles = cuboid([-2.0; 3], [2.0; 3]);
        triangles.extend(cuboid([-0.1, y[0], -0.1], [0.1, y[1], 0.1]));
        drawn(&soup(&triangles), &v).length(|l| l.is_visible())
    };
    assert!(visible([1.6, 1.8]) > 0.1);
    assert_eq!(visible([2.2, 2.4]), 0.0);
}

/// Returns the lines of a drawing of these triangles in any order, with any first corner and any rotation.
fn drawn_in_any_order(triangles: &[Triangle], view: &View) -> Drawing {
    let drawing = drawn(&soup(triangles), view);
    let count = triangles.len();
    for shift in 0..6 {
        let mut other: Vec<Triangle> =
            (0..count).map(|i| triangles[(i * 5 + shift) % count]).collect();
        for (i, t) in other.iter_mut().enumerate() {
            t.rotate_left(i % 3);
            if (i + shift) % 4 < shift {
                t.swap(1, 2);
            }
        }
        assert_eq!(drawn(&soup(&other), view).lines, drawing.lines, "shift {shift}");
    }
    drawing
}

#[test]
fn a_band_with_one_side_has_no_tear() {
    let band = |i: usize, side: f64| {
        let u = i as f64 / 48.0 * std::f64::consts::TAU;
        // At the end of the rounding the two sides swap.
        let (side, u) = if i == 48 { (-side, 0.0) } else { (side, u) };
        let across = side * 0.6;
        let r = 2.0 + across * (u / 2.0).cos();
        DVec3::new(r * u.cos(), r * u.sin(), across * (u / 2.0).sin())
    };
    let quads = (0..48).flat_map(|i| {
        let [a, b, c, d] = [band(i, -1.0), band(i + 1, -1.0), band(i + 1, 1.0), band(i, 1.0)];
        [[a, b, c], [a, c, d]]
    });
    let triangles: Vec<Triangle> = quads.collect();
    let view = view(DVec3::ZERO, DVec3::new(0.3, -1.0, 0.8), 8.0, false);
    let drawing = drawn_in_any_order(&triangles, &view);
    let classes: std::collections::BTreeSet<_> = drawing.lines.iter().map(|l| l.class).collect();
    assert!(classes.iter().eq(&[LineClass::Silhouette, LineClass::Border]), "{classes:?}");
}

#[test]
fn steps_are_outlines_whichever_side_is_the_front() {
    // A step with its riser seen edge-on.
    let [near, far] = [-1.0, 1.0].map(|y| {
        [[-2.0, 0.0], [0.0, 0.0], [0.0, 1.0], [2.0, 1.0]]
            .map(|[x, z]: [f64; 2]| DVec3::new(x, y, z))
    });
    let strip = |i: usize| [[near[i], near[i + 1], far[i + 1]], [near[i], far[i + 1], far[i]]];
    let triangles: Vec<Triangle> = (0..3).flat_map(strip).collect();
    let drawing = drawn_in_any_order(&triangles, &above());
    assert!((length(&drawing, LineClass::Silhouette) - 2.0).abs() < 1e-6, "{:?}", drawing.lines);
    assert_eq!(length(&drawing, LineClass::Crease), 0.0);
}

#[test]
fn a_set_has_the_classes_that_it_was_made_of() {
    for &one in LineClass::ALL {
        let (only, without) = (ClassSet::of(&[one]), ClassSet::of(LineClass::ALL).without(one));
        for &other in LineClass::ALL {
            assert_eq!(only.contains(other), one == other, "{one:?} {other:?}");
            assert_eq!(without.contains(other), one != other, "{one:?} {other:?}");
        }
    }
}
