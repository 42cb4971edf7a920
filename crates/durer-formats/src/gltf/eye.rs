//! Cameras and lights, brought from their nodes to the world.

use super::buffer::Source;
use super::json;
use crate::{Place, Warning};
use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{Camera, Light, LightKind, NamedCamera, Projection, Scene};
use std::cell::LazyCell;
use std::f64::consts::PI;

/// Stronger lights count as this strong, so that all that is made of them stays finite.
const STRONGEST: f64 = 1e30;

/// The cameras of the scene's nodes, in drawing order, with unique names. A camera without a far
/// plane gets one behind the scene. Cameras that cannot see are left out with a warning.
pub fn cameras(
    source: &Source<'_>,
    nodes: &[usize],
    world: &[DMat4],
    scene: &mut Scene,
    warnings: &mut Vec<Warning>,
) {
    // Found where a camera asks for it: that takes all vertices.
    let sphere = LazyCell::new(|| scene.bounding_sphere());
    let mut cameras: Vec<NamedCamera> = Vec::new();
    for &n in nodes {
        let node = &source.root.nodes[n];
        let Some(camera) = node.camera.and_then(|c| source.root.cameras.get(c.index())) else {
            continue;
        };
        let behind = |eye: DVec3| sphere.map_or(0.0, |s| (s.center - eye).length() + s.radius);
        let found = place_camera(camera, world[n], behind);
        match found.and_then(|c| c.camera.check().map(|()| c).map_err(|e| e.to_string())) {
            Ok(mut found) => {
                let name = camera.name.as_ref().or(node.name.as_ref()).filter(|n| !n.is_empty());
                found.name = unique(name, &cameras);
                cameras.push(found);
            }
            Err(why) => {
                let place = Place::Path(format!("nodes[{n}].camera"));
                warnings.push(Warning { place, message: format!("{why}; the camera is left out") });
            }
        }
    }
    scene.cameras = cameras;
}

/// The name, or `camera` and a number, with a number more where it is taken.
fn unique(name: Option<&String>, taken: &[NamedCamera]) -> String {
    let base = name.cloned().unwrap_or_else(|| format!("camera{}", taken.len()));
    let free = |name: &String| taken.iter().all(|c| c.name != *name);
    let numbered = (2..).map(|i| format!("{base}.{i}"));
    std::iter::once(base.clone()).chain(numbered).find(free).unwrap_or(base)
}

/// The camera at the origin of `world`, looking along its −z; scale has no meaning for it.
fn place_camera(
    camera: &json::Camera,
    world: DMat4,
    behind: impl Fn(DVec3) -> f64,
) -> Result<NamedCamera, String> {
    let eye = world.w_axis.truncate();
    let backward = world.z_axis.truncate().try_normalize().ok_or("its node has no direction")?;
    let up = world.y_axis.truncate().try_normalize().ok_or("its node has no direction")?;
    let (projection, near, far, aspect) = match (&camera.perspective, &camera.orthographic) {
        (Some(p), _) => {
            let perspective = Projection::Perspective { fov_y: p.yfov };
            // Infinite: a little behind everything, so that nothing is cut off.
            let far = p.zfar.unwrap_or_else(|| (behind(eye) * 1.01).max(p.znear * 1000.0));
            (perspective, p.znear, far, p.aspect_ratio)
        }
        (None, Some(o)) => {
            let parallel = Projection::Orthographic { height: 2.0 * o.ymag.abs() };
            (parallel, o.znear, o.zfar, Some((o.xmag / o.ymag).abs()))
        }
        (None, None) => return Err("it has no projection".to_owned()),
    };
    let camera = Camera { eye, target: eye - backward, up, projection, near, far };
    let aspect = aspect.filter(|a| a.is_finite() && *a > 0.0);
    Ok(NamedCamera { name: String::new(), camera, aspect })
}

/// The lights of KHR_lights_punctual.
///
/// A file's intensities are lux (directional) and candela (point, spot). A white matte surface sends
/// back 1/π of what falls on it, so π lux make it white: all intensities are divided by π. Sunlight has
/// thousands of lux, in whatever units a program counted; how strong the picture shows it is a matter of
/// its exposure, not of the file.
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

/// Lights shine along −z of their node.
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
