//! Cameras, and the lights of KHR_lights_punctual.

use super::buffer::Source;
use super::json;
use crate::eye::{self, Eye, Lens};
use crate::{Place, Warning};
use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Light, LightKind, Projection, Scene};
use std::f64::consts::PI;

/// Largest strength of a light, so that all values computed from it stay finite.
const STRONGEST: f64 = 1e30;

/// Adds the cameras of the scene's nodes, in drawing order, with unique names. A camera without a far plane gets one
/// behind the scene. Invalid cameras are left out with a warning.
pub fn cameras(
    source: &Source<'_>,
    nodes: &[usize],
    world: &[DMat4],
    scene: &mut Scene,
    warnings: &mut Vec<Warning>,
) {
    let eyes = nodes.iter().filter_map(|&n| {
        let node = &source.root.nodes[n];
        let camera = node.camera.and_then(|c| source.root.cameras.get(c.index()))?;
        let name = camera.name.as_ref().or(node.name.as_ref()).cloned().unwrap_or_default();
        let place = Place::Path(format!("nodes[{n}].camera"));
        Some(Eye { name, world: world[n], lens: lens(camera), place })
    });
    eye::add_cameras(eyes, scene, warnings);
}

fn lens(camera: &json::Camera) -> Result<Lens, String> {
    let (projection, near, far, aspect) = match (&camera.perspective, &camera.orthographic) {
        (Some(p), _) => {
            (Projection::Perspective { fov_y: p.yfov }, p.znear, p.zfar, p.aspect_ratio)
        }
        (None, Some(o)) => {
            let parallel = Projection::Orthographic { height: 2.0 * o.ymag.abs() };
            (parallel, o.znear, Some(o.zfar), Some((o.xmag / o.ymag).abs()))
        }
        (None, None) => return Err("it has no projection".to_owned()),
    };
    Ok(Lens { projection, near: Some(near), far, aspect })
}

/// Returns the lights of KHR_lights_punctual.
///
/// A file's intensities are lux (directional) and candela (point, spot). A white matte surface reflects 1/π of the
/// incident light, so π lux make it white: all intensities are divided by π. Sunlight has thousands of lux; its
/// brightness in the picture is determined by the exposure.
pub fn lights(
    source: &Source<'_>,
    nodes: &[usize],
    world: &[DMat4],
    warnings: &mut Vec<Warning>,
) -> Vec<Light> {
    let all = source.root.extensions.lights.as_ref().map_or([].as_slice(), |l| &l.lights);
    let mut lights = Vec::new();
    for &n in nodes {
        let node = &source.root.nodes[n];
        let index = node.extensions.light.as_ref().and_then(|l| l.light);
        let Some(light) = index.and_then(|i| all.get(i.index())) else { continue };
        match light_kind(light, world[n]) {
            Some(kind) => {
                let intensity = light.intensity.unwrap_or(1.0).clamp(0.0, STRONGEST) / PI;
                let color = DVec3::from(light.color.unwrap_or([1.0; 3])) * intensity;
                lights.push(Light { kind, color: Vec3::max(color.as_vec3(), Vec3::ZERO) });
            }
            None => {
                let name = light.name.as_deref().unwrap_or_default();
                let message = format!("the light `{name}` of type `{}` is left out", light.kind);
                warnings.push(Warning { place: Place::Path(format!("nodes[{n}]")), message });
            }
        }
    }
    lights
}

/// Returns the kind of a light, which shines along −z of its node.
fn light_kind(light: &json::Light, world: DMat4) -> Option<LightKind> {
    let position = world.w_axis.truncate();
    let direction = (-world.z_axis.truncate()).try_normalize();
    let range = light.range.filter(|r| *r > 0.0);
    if !position.is_finite() {
        return None;
    }
    Some(match light.kind.as_str() {
        "directional" => LightKind::Directional { direction: direction? },
        "point" => LightKind::Point { position, range },
        "spot" => {
            let spot = light.spot.as_ref();
            let outer =
                spot.and_then(|s| s.outer_cone_angle).unwrap_or(PI / 4.0).clamp(0.0, PI / 2.0);
            let inner = spot.and_then(|s| s.inner_cone_angle).unwrap_or(0.0).clamp(0.0, outer);
            LightKind::Spot { position, direction: direction?, range, inner, outer }
        }
        _ => return None,
    })
}
