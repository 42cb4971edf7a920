//! Cameras and lights of the common technique.
//!
//! Both look along −z of their node. Lights have no unit: at 1 one makes a white surface white, as far as it
//! reaches before it falls off.

use super::document::Document;
use super::material::is_linear;
use super::nodes::Placed;
use crate::eye::{self, Eye, Lamp, Lens};
use crate::text::Tally;
use crate::{Model, color};
use durer::math::{DMat4, Vec3};
use durer::scene::{LightKind, Projection};
use std::f64::consts::FRAC_PI_2;

/// Adds the cameras and lights of a model's nodes to it. `unit` is the length of the file's unit in metres.
pub(super) fn add(
    model: &mut Model,
    document: &Document<'_>,
    cameras: &[Placed],
    lights: &[Placed],
    unit: f64,
) {
    let name = |n: usize| document.attribute(n, "name").or(document.attribute(n, "id"));
    let eyes = cameras.iter().map(|placed| Eye {
        name: name(placed.target).or(name(placed.node)).unwrap_or_default().to_owned(),
        world: placed.world,
        lens: lens(document, placed.target, unit),
        place: document.place(placed.target),
    });
    eye::add_cameras(eyes, &mut model.scene, &mut model.warnings);
    let linear = is_linear(document);
    let (mut lamps, mut unknown) = (Vec::new(), Tally::default());
    for placed in lights {
        match lamp(document, placed.target, placed.world, linear) {
            Some(lamp) => lamps.push(lamp),
            None => unknown.add(|| document.place(placed.target)),
        }
    }
    model.warn_of(
        &unknown,
        "{light is of no known kind; it is|lights are of no known kind; they are} left out",
    );
    model.scene.lights = eye::lights(&lamps, unit, &model.scene);
}

/// Returns a number of an element's child.
fn number(document: &Document<'_>, element: usize, name: &str) -> Option<f64> {
    document.vector::<1>(document.find(element, &[name])?).map(|[v]| v)
}

/// Returns the projection of a camera; `unit` is the length of the file's unit.
pub(super) fn lens(document: &Document<'_>, camera: usize, unit: f64) -> Result<Lens, String> {
    let common = document.find(camera, &["optics", "technique_common"]);
    let kind = common.and_then(|c| {
        document.children(c).find(|&n| matches!(document.name(n), "perspective" | "orthographic"))
    });
    let kind = kind.ok_or("it has no projection")?;
    let get = |name| number(document, kind, name);
    let aspect = get("aspect_ratio").filter(|a| *a > 0.0);
    let near = get("znear").map(|v| v * unit);
    let far = get("zfar").map(|v| v * unit);
    let (projection, aspect) = if document.name(kind) == "perspective" {
        perspective(get("xfov"), get("yfov"), aspect).ok_or("it has no angle of view")?
    } else {
        parallel(get("xmag"), get("ymag"), aspect, unit).ok_or("it has no size of view")?
    };
    Ok(Lens { projection, near, far, aspect })
}

/// Returns a perspective projection and its aspect ratio, from any two of width, height (angles in degrees) and ratio;
/// one angle alone makes a square picture.
fn perspective(
    x: Option<f64>,
    y: Option<f64>,
    aspect: Option<f64>,
) -> Option<(Projection, Option<f64>)> {
    let tan = |degrees: f64| libm::tan(degrees.to_radians() / 2.0);
    let (fov_y, aspect) = match (x, y) {
        (Some(x), Some(y)) => (y.to_radians(), Some(tan(x) / tan(y))),
        (None, Some(y)) => (y.to_radians(), aspect),
        (Some(x), None) => (2.0 * libm::atan(tan(x) / aspect.unwrap_or(1.0)), aspect),
        (None, None) => return None,
    };
    Some((Projection::Perspective { fov_y }, aspect))
}

/// Returns a parallel projection and its aspect ratio, from half the width and half the height.
fn parallel(
    x: Option<f64>,
    y: Option<f64>,
    aspect: Option<f64>,
    unit: f64,
) -> Option<(Projection, Option<f64>)> {
    let half = y.or_else(|| Some(x? / aspect.unwrap_or(1.0)))?;
    let height = 2.0 * unit * half.abs();
    let ratio = x.zip(y).map(|(x, y)| (x / y).abs()).or(aspect);
    Some((Projection::Orthographic { height }, ratio))
}

/// Returns the light of a frame, which shines along −z; `None` if its kind is not known. Colours are linear or not,
/// like the materials'.
pub(super) fn lamp(
    document: &Document<'_>,
    light: usize,
    world: DMat4,
    linear: bool,
) -> Option<Lamp> {
    let common = document.find(light, &["technique_common"])?;
    let known =
        |n: &usize| matches!(document.name(*n), "ambient" | "directional" | "point" | "spot");
    let kind = document.children(common).find(known)?;
    let get = |name| number(document, kind, name).map(|v| v.max(0.0));
    let position = world.w_axis.truncate();
    let direction = (-world.z_axis.truncate()).try_normalize();
    let range = None;
    let of_kind = match document.name(kind) {
        "ambient" => LightKind::Ambient,
        "directional" => LightKind::Directional { direction: direction? },
        "point" => LightKind::Point { position, range },
        _ => {
            // The whole angle, and how steeply light falls to its border.
            let outer = (get("falloff_angle").unwrap_or(180.0).to_radians() / 2.0).min(FRAC_PI_2);
            let soft = get("falloff_exponent").unwrap_or(0.0) > 0.0;
            let inner = if soft { 0.0 } else { outer };
            LightKind::Spot { position, direction: direction?, range, inner, outer }
        }
    };
    let attenuation = |name, none| get(name).unwrap_or(none);
    let falloff = [
        attenuation("constant_attenuation", 1.0),
        attenuation("linear_attenuation", 0.0),
        attenuation("quadratic_attenuation", 0.0),
        0.0,
    ];
    let rgb = document.find(kind, &["color"]).and_then(|c| document.vector::<3>(c));
    let color = light_color(rgb.unwrap_or([1.0; 3]), linear);
    position.is_finite().then_some(Lamp { kind: of_kind, color, falloff })
}

/// Returns a colour times an intensity, which is above 1 where a component is.
fn light_color(rgb: [f64; 3], linear: bool) -> Vec3 {
    let intensity = rgb.into_iter().fold(1.0, f64::max);
    let rgb = rgb.map(|v| (v.max(0.0) / intensity) as f32);
    let color = if linear { Vec3::from(rgb) } else { color::linear3(rgb) };
    color * intensity as f32
}
