//! Lines and points of models: visible in pictures and drawings, hidden behind surfaces, picked.

use crate::scenes::instance;
use durer::math::{DVec2, DVec3, Rect, Vec3, Vec4};
use durer::pipeline::{
    Background, DrawOptions, DrawStyle, Marks, RenderOptions, Samples, SurfaceMethod, draw, render,
};
use durer::scene::{Camera, Mesh, Projection, Scene, Topology};
use durer::target::drawing::LineClass;
use durer::view::View;
use durer::view::pick::{Hit, PickArea, pick};

fn camera() -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 4.0 },
        near: 1.0,
        far: 9.0,
    }
}

fn marks(topology: Topology, positions: &[[f32; 3]]) -> Mesh {
    let positions = positions.iter().map(|p| Vec3::from(*p)).collect();
    Mesh { topology, positions, ..Mesh::default() }
}

fn scene(meshes: Vec<Mesh>) -> Scene {
    let instances = (0..meshes.len()).map(instance).collect();
    Scene { meshes, instances, ..Scene::default() }
}

/// Returns a square from −0.5 to 0.5 in front of a line from −1 to 1 and of two points, one of them beside it.
fn hidden_in_part() -> Scene {
    let square = [[-0.5, -0.5, 1.0], [0.5, -0.5, 1.0], [0.5, 0.5, 1.0], [-0.5, 0.5, 1.0]];
    let [a, b, c, d] = square;
    scene(vec![
        marks(Topology::Points, &[[0.25, 0.25, 0.0], [-1.5, 1.0, 0.0]]),
        marks(Topology::Lines, &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        Mesh { faces: vec![0], ..marks(Topology::Triangles, &[a, b, c, a, c, d]) },
    ])
}

fn options(side: u32) -> RenderOptions {
    RenderOptions {
        width: side,
        height: side,
        samples: Samples::One,
        ..RenderOptions::new(camera())
    }
}

#[test]
fn marks_are_dark_on_light_and_light_on_dark() {
    let scene = scene(vec![marks(Topology::Lines, &[[-1.0, 0.01, 0.0], [1.0, 0.01, 0.0]])]);
    for &algorithm in SurfaceMethod::ALL {
        for (background, dark) in [(Vec4::ONE, true), (Vec4::new(0.0, 0.0, 0.05, 1.0), false)] {
            let background = Background::Color(background);
            let options = RenderOptions { algorithm, background, ..options(100) };
            let (picture, _) = render(&scene, &options).expect("picture");
            let [r, g, b, _] = picture.color.get(50, 49).expect("pixel");
            let seen = if dark { r.max(g).max(b) < 60 } else { r.min(g).min(b) > 200 };
            assert!(seen, "{algorithm}: {r} {g} {b}");
        }
    }
}

#[test]
fn marks_are_as_large_as_requested() {
    let lines = scene(vec![marks(Topology::Lines, &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])]);
    let points = scene(vec![marks(Topology::Points, &[[0.0, 0.0, 0.0]])]);
    let inked = |scene: &Scene, size: f64| {
        let marks = Marks { line_width: size, point_size: size };
        let options = RenderOptions { marks, ..options(100) };
        let (picture, _) = render(scene, &options).expect("picture");
        picture.color.data().iter().filter(|c| c[0] < 60).count()
    };
    for size in [2, 4, 10] {
        assert_eq!(inked(&lines, f64::from(size)), 50 * size as usize);
        assert_eq!(inked(&points, f64::from(size)), (size * size) as usize);
    }
}

#[test]
fn drawings_have_the_lines_and_points_of_a_model() {
    let drawing = draw(&hidden_in_part(), &DrawOptions::new(camera())).expect("drawing");
    let length =
        |visible: bool| drawing.length(|l| l.class == LineClass::Mark && l.is_visible() == visible);
    // The arms of a cross are 0.0025 of 4 units long on each side; the hidden point has a cross too.
    let cross = 4.0 * 0.0025 * 4.0;
    assert!((length(true) - (1.0 + cross)).abs() < 1e-5, "{}", length(true));
    assert!((length(false) - (1.0 + cross)).abs() < 1e-5, "{}", length(false));
    let wires = DrawOptions { style: DrawStyle::Wireframe, ..DrawOptions::new(camera()) };
    let wires = draw(&hidden_in_part(), &wires).expect("drawing").length(|_| true);
    assert!((wires - (4.0 + 2.0 + 2.0 * cross)).abs() < 1e-5, "{wires}");
}

#[test]
fn drawings_of_marks_alone_are_cut_at_the_window() {
    let lines =
        marks(Topology::Lines, &[[-9.0, 0.5, 0.0], [9.0, 0.5, 0.0], [7., 7., 0.], [8., 7., 0.]]);
    let strange = marks(Topology::Points, &[[f32::NAN, 0.0, 0.0], [0.5, 0.2, 0.0]]);
    let drawing = draw(&scene(vec![lines, strange]), &DrawOptions::new(camera())).expect("drawing");
    let cross = 4.0 * 0.0025 * 4.0;
    let length = drawing.length(|l| l.is_visible());
    assert!((length - (4.0 + cross)).abs() < 1e-5, "{length}");
}

#[test]
fn marks_are_picked_near_a_point_and_within_a_rectangle() {
    let scene = hidden_in_part();
    let view = View::new(camera(), 400, 400).expect("view");
    let at = |x: f64, y: f64| pick(&scene, &view, PickArea::Point(DVec2::new(x, y)));
    let kinds = |hits: &[Hit]| -> Vec<_> { hits.iter().map(|h| (h.topology, h.item)).collect() };
    // Items count triangles first, then the rest in scene order.
    assert_eq!(kinds(&at(120.0, 202.5)), [(Topology::Lines, 4)]);
    assert_eq!(kinds(&at(50.5, 99.0)), [(Topology::Points, 3)]);
    assert_eq!(at(120.0, 204.0), []);
    let both = at(201.0, 201.0);
    assert_eq!(both.iter().map(|h| h.topology).collect::<Vec<_>>()[..1], [Topology::Triangles]);
    assert!((both[both.len() - 1].position - DVec3::new(0.01, 0.0, 0.0)).length() < 1e-9);
    let rect = Rect::new(DVec2::new(0.0, 0.0), DVec2::new(110.0, 210.0)).expect("rectangle");
    let in_rect = pick(&scene, &view, PickArea::Rect(rect));
    assert_eq!(kinds(&in_rect), [(Topology::Points, 3), (Topology::Lines, 4)]);
}

#[test]
fn a_slanted_line_is_picked_where_it_is_in_the_world() {
    let line = marks(Topology::Lines, &[[-1.0, 0.0, 0.0], [1.0, 0.0, -8.0]]);
    let projection = Projection::Perspective { fov_y: 0.8 };
    let camera = Camera { projection, far: 90.0, ..camera() };
    let view = View::new(camera, 300, 300).expect("view");
    for t in [0.1, 0.5, 0.9] {
        let p = DVec3::new(-1.0 + 2.0 * t, 0.0, -8.0 * t);
        let s = view.screen_from_world() * p.extend(1.0);
        let on_line = PickArea::Point(DVec2::new(s.x, s.y) / s.w);
        let hits = pick(&scene(vec![line.clone()]), &view, on_line);
        assert_eq!(hits.len(), 1, "{t}");
        assert!((hits[0].position - p).length() < 1e-9, "{t}: {}", hits[0].position);
        assert!((hits[0].depth - s.z / s.w).abs() < 1e-12);
    }
}
