//! Wireframes: each edge once, in the picture only, whatever is behind the eye.

use crate::scenes;
use crate::surface_scenes::{Prepared, of_triangles};
use durer::math::{IVec2, Vec3};
use durer::raster::line::{self, bresenham};
use durer::scene::{Camera, Projection, Scene};
use durer::target::Pixels;
use durer::trace::{NoTrace, Recorder};
use durer::view::View;
use durer::visibility::wireframe::{Options, Step, render};

fn draw(scene: &Scene, view: &View) -> (Pixels<[u8; 4]>, Vec<Step>) {
    let mut steps = Recorder::default();
    let mut target = Pixels::new(view.width(), view.height(), [255; 4]);
    render(scene, view, &Options::default(), &mut target, &mut steps);
    let mut quiet = Pixels::new(view.width(), view.height(), [255; 4]);
    render(scene, view, &Options::default(), &mut quiet, &mut NoTrace);
    assert!(quiet == target, "listening changes the picture");
    (target, steps.into_steps())
}

#[test]
fn a_shared_edge_is_drawn_once() {
    let p = [
        Vec3::new(-1., -1., 0.),
        Vec3::new(1., -1., 0.),
        Vec3::new(1., 1., 0.),
        Vec3::new(-1., 1., 0.),
    ];
    let mut scene = of_triangles(&[[p[0], p[1], p[2]]]);
    scene.meshes[0].positions = p.to_vec();
    scene.meshes[0].indices = Some(vec![0, 1, 2, 0, 2, 3]);
    let prepared = Prepared::new(&scene, 64, 64);
    assert_eq!(draw(&scene, &prepared.view).1.len(), 5);
}

#[test]
fn sides_inside_faces_are_no_edges() {
    // A quad, and a triangle on one of its sides.
    let corners = [(-1., -1.), (1., -1.), (1., 1.), (-1., 1.), (0., 2.)];
    let mut scene = of_triangles(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    let mesh = &mut scene.meshes[0];
    mesh.positions = corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    mesh.indices = Some(vec![0, 1, 2, 0, 2, 3, 3, 2, 4]);
    mesh.faces = vec![0, 2];
    let edges = |scene: &Scene| {
        let prepared = Prepared::new(scene, 64, 64);
        let steps = draw(scene, &prepared.view).1;
        steps.iter().map(|Step::Edge { vertices, .. }| *vertices).collect::<Vec<_>>()
    };
    assert_eq!(edges(&scene), [[0, 1], [0, 3], [1, 2], [2, 3], [2, 4], [3, 4]]);
    // The diagonal is an edge where another face has it, too.
    let mesh = &mut scene.meshes[0];
    mesh.indices.as_mut().unwrap().extend([2, 0, 4]);
    mesh.faces.push(3);
    assert!(edges(&scene).contains(&[0, 2]));
    scene.meshes[0].faces.clear();
    assert_eq!(edges(&scene).len(), 8);
}

#[test]
fn the_picture_is_rebuilt_from_its_steps() {
    let scene = scenes::materials();
    let prepared = Prepared::new(&scene, 90, 70);
    let (found, steps) = draw(&scene, &prepared.view);
    let mut rebuilt = Pixels::new(90, 70, [255; 4]);
    for Step::Edge { from, to, .. } in steps {
        let plot = |p: IVec2| rebuilt.set(p.x as u32, p.y as u32, [0, 0, 0, 255]);
        let window = line::Options { window: Some((IVec2::ZERO, IVec2::new(89, 69))) };
        bresenham::draw(from, to, &window, plot, &mut NoTrace);
    }
    assert!(rebuilt == found);
    assert!(found.data().iter().filter(|c| c[0] == 0).count() > 800);
}

/// Checks that hidden edges are drawn too, which makes a wireframe ambiguous.
#[test]
fn what_is_hidden_is_drawn() {
    let near = [Vec3::new(-2., -2., 0.5), Vec3::new(2., -2., 0.5), Vec3::new(0., 2.5, 0.5)];
    let far = [Vec3::new(-0.3, -0.3, -1.0), Vec3::new(0.3, -0.3, -1.0), Vec3::new(0., 0.3, -1.0)];
    let both = of_triangles(&[near, far]);
    let one = of_triangles(&[near]);
    let prepared = Prepared::new(&both, 80, 80);
    let dark = |scene| draw(scene, &prepared.view).0.data().iter().filter(|c| c[0] == 0).count();
    assert!(dark(&both) > dark(&one) + 15);
}

#[test]
fn soups_around_the_eye_do_no_harm() {
    for seed in 0..20 {
        let scene = scenes::soup(60, seed);
        for (width, height) in [(1, 1), (50, 40)] {
            let prepared = Prepared::new(&scene, width, height);
            draw(&scene, &prepared.view);
        }
    }
}

/// Checks that an edge that leaves the picture lights exactly those pixels of the whole edge that are in it.
#[test]
fn edges_across_the_border_keep_their_pixels() {
    let mut seen = 0;
    for seed in 0..30 {
        let scene = scenes::soup(12, seed);
        let camera = Camera {
            projection: Projection::Orthographic { height: 1.0 },
            ..Camera::look_at([0.0, 0.0, 20.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        };
        let view = View::new(camera, 40, 30).expect("view");
        let mut steps = Recorder::default();
        let mut target = Pixels::new(40, 30, [255; 4]);
        render(&scene, &view, &Options::default(), &mut target, &mut steps);
        let mut whole = Pixels::new(40, 30, [255; 4]);
        for Step::Edge { from, to, .. } in steps.steps() {
            // Without a window, except lines that would take too long.
            if (*to - *from).abs().max_element() > 1 << 20 {
                continue;
            }
            let outside = |p: &IVec2| p.cmplt(IVec2::ZERO).any() || p.x >= 40 || p.y >= 30;
            seen += usize::from(outside(from) || outside(to));
            let plot = |p: IVec2| {
                if !outside(&p) {
                    whole.set(p.x as u32, p.y as u32, [0, 0, 0, 255]);
                }
            };
            bresenham::draw(*from, *to, &line::Options::default(), plot, &mut NoTrace);
        }
        let lost = whole.data().iter().zip(target.data()).filter(|(a, b)| a[0] < b[0]).count();
        assert_eq!(lost, 0, "{seed}");
    }
    assert!(seen > 50, "{seen}");
}
