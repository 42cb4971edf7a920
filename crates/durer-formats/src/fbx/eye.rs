//! Cameras and lights.

use super::frame::Frames;
use crate::eye::{self, Eye, Lamp, Lens};
use crate::text::Tally;
use crate::{Model, Place, color};
use durer::math::{DMat4, DVec3, DVec4, Vec3};
use durer::scene::{LightKind, Projection};
use std::f64::consts::FRAC_PI_2;
use ufbx::{ApertureMode, Camera, Light, LightDecay, LightType, Node, ProjectionMode, Scene};

/// Millimetres per inch, the unit of the size of film.
const INCH: f64 = 25.4;

/// Adds the cameras and lights of a model's nodes to it. `unit` is the length of the file's unit in metres.
pub(super) fn add(model: &mut Model, scene: &Scene, frames: &Frames, unit: f64, own_lights: bool) {
    let here = |node: &Node| Place::Path(node.element.name.to_string());
    let eyes = scene.nodes.into_iter().filter_map(|node| {
        let camera = node.camera.as_deref()?;
        // Cameras look along x, and y is up.
        let turn = DMat4::from_cols(DVec4::Z, DVec4::Y, DVec4::NEG_X, DVec4::W);
        let world = frames.world(node) * turn;
        let name = node.element.name.to_string();
        Some(Eye { name, world, lens: lens(camera, unit), place: here(node) })
    });
    eye::add_cameras(eyes, &mut model.scene, &mut model.warnings);
    let (mut lamps, mut broken, mut areas) = (Vec::new(), Tally::default(), Tally::default());
    if !own_lights {
        let shining = |node: &&Node| node.light.as_deref().is_some_and(|l| l.cast_light);
        eye::warn_of_dark(scene.nodes.iter().map(|n| &**n).filter(shining).count(), model);
    }
    for node in scene.nodes.into_iter().filter(|_| own_lights) {
        let Some(light) = node.light.as_deref().filter(|l| l.cast_light) else { continue };
        match lamp(light, frames.world(node)) {
            Some(lamp) => lamps.push(lamp),
            None => broken.add(|| here(node)),
        }
        if matches!(light.type_, LightType::Area | LightType::Volume) {
            areas.add(|| here(node));
        }
    }
    for (tally, what) in [
        (
            broken,
            "{light has no direction or no place; it is|lights have no direction or no place; they are} left out",
        ),
        (
            areas,
            "{light is an area or a volume; it shines as a point|lights are areas or volumes; they shine as points}",
        ),
    ] {
        model.warn_of(&tally, what);
    }
    model.scene.lights = eye::lights(&lamps, unit, &model.scene);
}

fn positive(value: f64) -> Option<f64> {
    Some(value).filter(|v| v.is_finite() && *v > 0.0)
}

/// Returns the projection of a camera. The library's own angles are not used, because it computes them with the
/// platform's arc functions.
fn lens(camera: &Camera, unit: f64) -> Result<Lens, String> {
    let aspect = positive(camera.aspect_ratio);
    let near = positive(camera.near_plane).map(|v| v * unit);
    let far = positive(camera.far_plane).map(|v| v * unit);
    let far = far.filter(|f| near.is_none_or(|n| *f > n));
    let projection = if camera.projection_mode == ProjectionMode::Orthographic {
        Projection::Orthographic { height: camera.orthographic_size.y * unit }
    } else {
        Projection::Perspective { fov_y: angle(camera).ok_or("it has no angle of view")? }
    };
    Ok(Lens { projection, near, far, aspect })
}

/// Returns the angle of view from top to bottom, in radians.
fn angle(camera: &Camera) -> Option<f64> {
    let field = camera.field_of_view_deg;
    let half = |degrees: f64| degrees.to_radians() / 2.0;
    match camera.aperture_mode {
        ApertureMode::HorizontalAndVertical | ApertureMode::Vertical => {
            positive(field.y).map(f64::to_radians)
        }
        ApertureMode::Horizontal => {
            let aspect = positive(camera.aspect_ratio).unwrap_or(1.0);
            positive(field.x).map(|x| 2.0 * libm::atan(libm::tan(half(x)) / aspect))
        }
        ApertureMode::FocalLength => {
            let height = positive(camera.aperture_size_inch.y)? * INCH;
            Some(2.0 * libm::atan(height / (2.0 * positive(camera.focal_length_mm)?)))
        }
    }
}

/// Returns the light of a frame; they shine along −y.
fn lamp(light: &Light, world: DMat4) -> Option<Lamp> {
    let position = Some(world.w_axis.truncate()).filter(|p| p.is_finite())?;
    let direction = (-world.y_axis.truncate()).try_normalize();
    let range = None;
    let half = |degrees: f64| (degrees.to_radians() / 2.0).clamp(0.0, FRAC_PI_2);
    let kind = match light.type_ {
        LightType::Directional => LightKind::Directional { direction: direction? },
        LightType::Spot => {
            let outer = positive(light.outer_angle).map_or(FRAC_PI_2, half);
            let inner = positive(light.inner_angle).map_or(0.0, half).min(outer);
            LightKind::Spot { position, direction: direction?, range, inner, outer }
        }
        LightType::Point | LightType::Area | LightType::Volume => {
            LightKind::Point { position, range }
        }
    };
    let falloff = match light.decay {
        LightDecay::None => [1.0, 0.0, 0.0, 0.0],
        LightDecay::Linear => [0.0, 1.0, 0.0, 0.0],
        LightDecay::Quadratic => [0.0, 0.0, 1.0, 0.0],
        LightDecay::Cubic => [0.0, 0.0, 0.0, 1.0],
    };
    let c = light.color;
    let rgb = color::linear3([c.x, c.y, c.z].map(|v| v.clamp(0.0, 1.0) as f32));
    let intensity = positive(light.intensity).unwrap_or(0.0).min(1e30);
    let color: Vec3 = (rgb.as_dvec3() * DVec3::splat(intensity)).as_vec3();
    Some(Lamp { kind, color, falloff })
}
