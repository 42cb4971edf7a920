//! Hidden lines of the reference parts agree with Open CASCADE's.

use crate::data;
use durer::math::DVec3;
use durer::scene::{Camera, Projection};
use durer::trace::NoTrace;
use durer::view::View;
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
                Options { tolerance: 0.0, crease: 20.0_f64.to_radians(), ..Options::default() };
            let found = draw(&scene, &view(v), &options, &mut NoTrace).expect("drawing");
            let length = |key: &str| v[key].as_f64().unwrap_or(0.0);
            let visible = length("visible_sharp_length") + length("visible_outline_length");
            let hidden = length("hidden_sharp_length") + length("hidden_outline_length");
            let ours = [true, false].map(|seen| found.length(|l| l.is_visible() == seen));
            println!(
                "{name} {i}: visible {} of {visible}, hidden {} of {hidden}",
                ours[0], ours[1]
            );
            if polyhedron {
                assert!((ours[0] - visible).abs() <= 1e-3 * visible, "{name} {i}");
                assert!((ours[1] - hidden).abs() <= 1e-3 * hidden, "{name} {i}");
            }
        }
    }
}
