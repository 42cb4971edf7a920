//! Hidden lines of the reference parts agree with Open CASCADE's.

use crate::data;
use crate::line_oracle::{distance, segments};
use durer::math::{DVec2, DVec3};
use durer::scene::{Camera, Projection};
use durer::trace::NoTrace;
use durer::view::View;
use durer::view::picture_plane::PicturePlane;
use durer::visibility::line::hidden_line::{Options, draw};
use serde_json::Value;

fn vector(v: &Value) -> DVec3 {
    let at = |i: usize| v[i].as_f64().expect("number");
    DVec3::new(at(0), at(1), at(2))
}

fn view(v: &Value) -> View {
    let (target, normal) = (vector(&v["origin"]), vector(&v["view_n"]));
    let (distance, projection) = match v["focus"].as_f64() {
        // Wide enough for all parts.
        Some(focus) => (focus, Projection::Perspective { fov_y: 1.5 }),
        None => (1000.0, Projection::Orthographic { height: 1000.0 }),
    };
    let eye = target + normal * distance;
    let camera =
        Camera { eye, target, up: vector(&v["view_y"]), projection, near: 0.01, far: 3000.0 };
    View::new(camera, 1000, 1000).expect("view")
}

#[test]
fn lengths_of_visible_and_hidden_lines() {
    let Some(folder) = data::folder() else { return };
    let folder = folder.join("reference/hidden_line_occt");
    let text = std::fs::read_to_string(folder.join("hlr.json")).expect("reference");
    let reference: Value = serde_json::from_str(&text).expect("JSON");
    for (name, model) in reference["models"].as_object().expect("models") {
        let scene = data::read_model(&folder.join(model["mesh"].as_str().expect("mesh"))).scene;
        let polyhedron = model["planar_faces_only"].as_bool().expect("kind");
        for (i, v) in model["views"].as_array().expect("views").iter().enumerate() {
            let options =
                Options { tolerance: 0.0, crease: 15.0_f64.to_radians(), ..Options::default() };
            let found = draw(&scene, &view(v), &options, &mut NoTrace).expect("drawing");
            let length = |key: &str| v[key].as_f64().unwrap_or(0.0);
            let visible = length("visible_sharp_length") + length("visible_outline_length");
            let hidden = length("hidden_sharp_length") + length("hidden_outline_length");
            let ours = [true, false].map(|seen| found.length(|l| l.is_visible() == seen));
            println!(
                "{name} {i}: visible {} of {visible}, hidden {} of {hidden}",
                ours[0], ours[1]
            );
            let within = if polyhedron { 1e-3 } else { 1e-2 };
            assert!((ours[0] - visible).abs() <= within * visible, "{name} {i}");
            assert!((ours[1] - hidden).abs() <= within * hidden, "{name} {i}");
        }
    }
}

/// Returns Open CASCADE's lines of one visibility.
fn exact(view: &Value, visibility: &str) -> Vec<[DVec2; 2]> {
    let point = |p: &Value| DVec2::new(p[0].as_f64().expect("x"), p[1].as_f64().expect("y"));
    let lines = |kind: &str| view[format!("{visibility}_{kind}")].as_array();
    let all = ["sharp", "outline"].into_iter().filter_map(lines).flatten();
    all.map(|line| [point(&line[0]), point(&line[1])]).collect()
}

/// Returns the largest distance of the ends of some segments from others.
fn farthest(of: &[[DVec2; 2]], from: &[[DVec2; 2]]) -> f64 {
    let nearest = |p| from.iter().map(|s| distance(p, *s)).fold(f64::INFINITY, f64::min);
    of.iter().flatten().map(|p| nearest(*p)).fold(0.0, f64::max)
}

#[test]
fn places_of_visible_and_hidden_lines_of_polyhedra() {
    let Some(folder) = data::folder() else { return };
    let folder = folder.join("reference/hidden_line_occt");
    let text = std::fs::read_to_string(folder.join("hlr.json")).expect("reference");
    let reference: Value = serde_json::from_str(&text).expect("JSON");
    let models = reference["models"].as_object().expect("models");
    for (name, model) in models.iter().filter(|m| m.1["planar_faces_only"] == true) {
        let scene = data::read_model(&folder.join(model["mesh"].as_str().expect("mesh"))).scene;
        for (i, v) in model["views"].as_array().expect("views").iter().enumerate() {
            let options = Options { crease: 15.0_f64.to_radians(), ..Options::default() };
            let found = draw(&scene, &view(v), &options, &mut NoTrace).expect("drawing");
            for visibility in ["visible", "hidden"] {
                let seen = visibility == "visible";
                let lines = found.lines.iter().filter(|l| l.is_visible() == seen);
                let ours: Vec<[DVec2; 2]> = lines.flat_map(segments).collect();
                let exact = exact(v, visibility);
                let size = exact.iter().flatten().map(|p| p.length()).fold(0.0, f64::max);
                // Ends of theirs on ours, and ends of ours on theirs.
                let off = farthest(&exact, &ours).max(farthest(&ours, &exact));
                assert!(off <= 1e-6 * size, "{name} {i} {visibility}: {off} of {size}");
            }
        }
    }
}

#[test]
fn lines_go_through_all_corners() {
    let Some(folder) = data::folder() else { return };
    let scene = data::read_model(&folder.join("cases/drawing/pillars_dropped_vertex.obj")).scene;
    let named = [(1.0, -1.7, 0.9), (0.3, -1.0, 0.5), (2.0, 1.0, 1.5), (1.0, 0.2, -0.8)];
    // Further views along a spiral around the model, from above to below.
    let all_around = (0..120).map(|i| {
        let (s, c) = (2.4 * f64::from(i)).sin_cos();
        let z = 0.98 - 1.96 * f64::from(i) / 119.0;
        let r = (1.0 - z * z).sqrt();
        (r * c, r * s, z)
    });
    for (x, y, z) in named.into_iter().chain(all_around) {
        let to_eye = DVec3::new(x, y, z).normalize();
        let camera = Camera {
            eye: to_eye * 100.0,
            target: DVec3::ZERO,
            up: DVec3::Z,
            projection: Projection::Orthographic { height: 30.0 },
            near: 1.0,
            far: 300.0,
        };
        let view = View::new(camera, 1000, 1000).expect("view");
        let drawing = draw(&scene, &view, &Options::default(), &mut NoTrace).expect("drawing");
        let plane = PicturePlane::new(&view);
        let mesh = &scene.meshes[0];
        let sides = (0..mesh.triangle_count()).flat_map(|t| {
            let corners = mesh.triangle(t).map(|v| mesh.positions[v as usize].as_dvec3());
            let at = corners.map(|p| plane.project(p).expect("before the eye"));
            [[at[0], at[1]], [at[1], at[2]], [at[2], at[0]]]
        });
        let sides: Vec<[DVec2; 2]> = sides.collect();
        // A line that skips a corner is away from all edges of the mesh.
        let middles = |s: [DVec2; 2]| [s[0], (s[0] + s[1]) / 2.0];
        let ours: Vec<[DVec2; 2]> = drawing.lines.iter().flat_map(segments).map(middles).collect();
        let off = farthest(&ours, &sides);
        assert!(off < 1e-6, "{to_eye}: {off}");
    }
}
