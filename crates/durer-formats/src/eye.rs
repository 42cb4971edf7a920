//! Cameras and lights of files, brought from their nodes to the world.

use crate::{Model, Place, Warning};
use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::{BoundingSphere, Camera, Light, LightKind, NamedCamera, Projection, Scene};
use std::cell::LazyCell;
use std::collections::{HashMap, HashSet};

/// A near plane that a file leaves out is at this share of the distance to the scene.
const NEAR: f64 = 1e-4;

/// Projection of a camera, in the world's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lens {
    pub projection: Projection,
    /// `None` = close to the eye.
    pub near: Option<f64>,
    /// `None` = behind all there is.
    pub far: Option<f64>,
    /// Width by height of its picture.
    pub aspect: Option<f64>,
}

/// A camera as in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Eye {
    /// Empty if it has none.
    pub name: String,
    /// Its frame: it is at the origin and looks along −z, y is up. Scale has no meaning for it.
    pub world: DMat4,
    /// Its projection, or the reason why there is none.
    pub lens: Result<Lens, String>,
    /// Its position in the file, for a warning.
    pub place: Place,
}

/// Adds cameras to a scene, in their order, with unique names. Those that cannot see are left out with a warning.
pub(crate) fn add_cameras(
    eyes: impl IntoIterator<Item = Eye>,
    scene: &mut Scene,
    warnings: &mut Vec<Warning>,
) {
    // Computed only if a camera needs it, because it takes all vertices.
    let sphere = LazyCell::new(|| scene.bounding_sphere());
    let (mut cameras, mut names) = (Vec::new(), Names::default());
    for eye in eyes {
        let behind = |at: DVec3| sphere.map_or(0.0, |s| (s.center - at).length() + s.radius);
        let found = eye.lens.and_then(|lens| camera(&lens, eye.world, behind));
        match found.and_then(|c| c.camera.check().map(|()| c).map_err(|e| e.to_string())) {
            Ok(found) => cameras.push(NamedCamera { name: names.unique(&eye.name), ..found }),
            Err(why) => {
                let message = format!("{why}; the camera is left out");
                warnings.push(Warning { place: eye.place, message });
            }
        }
    }
    scene.cameras = cameras;
}

/// Names so far, for making further ones unique.
#[derive(Debug, Default)]
struct Names {
    taken: HashSet<String>,
    /// The last number appended to each name.
    last: HashMap<String, usize>,
}

impl Names {
    /// Returns the name, or `camera` and a number, with another number appended if it is in use.
    fn unique(&mut self, name: &str) -> String {
        let nameless = || format!("camera{}", self.taken.len());
        let base = Some(name).filter(|n| !n.is_empty()).map_or_else(nameless, str::to_owned);
        let mut unique = base.clone();
        while !self.taken.insert(unique.clone()) {
            let last = self.last.entry(base.clone()).or_insert(1);
            *last += 1;
            unique = format!("{base}.{last}");
        }
        unique
    }
}

/// Returns the camera of a frame, as yet without a name.
fn camera(lens: &Lens, world: DMat4, behind: impl Fn(DVec3) -> f64) -> Result<NamedCamera, String> {
    let direction = |v: DVec3| v.try_normalize().ok_or("its node has no direction");
    let eye = world.w_axis.truncate();
    let backward = direction(world.z_axis.truncate())?;
    let up = direction(world.y_axis.truncate())?;
    let near = lens.near.unwrap_or_else(|| NEAR * behind(eye));
    // If infinite, a little behind everything, so that nothing is cut off.
    let far = lens.far.unwrap_or_else(|| (behind(eye) * 1.01).max(near * 1000.0));
    let projection = lens.projection;
    let camera = Camera { eye, target: eye - backward, up, projection, near, far };
    let aspect = lens.aspect.filter(|a| a.is_finite() && *a > 0.0);
    Ok(NamedCamera { name: String::new(), camera, aspect })
}

/// Warns of lights that do not shine, because [`ReadOptions::own_lights`](crate::ReadOptions) is off.
pub(crate) fn warn_of_dark(count: usize, model: &mut Model) {
    let words = "{light of the file does|lights of the file do} not shine unless its own lights are requested";
    model.warn_counted(Place::Whole, count as u64, words);
}

/// A light of a format that specifies the falloff with distance itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lamp {
    pub kind: LightKind,
    /// Linear colour times intensity: at 1 a white matte surface is white.
    pub color: Vec3,
    /// Attenuation of points and spots: at a distance of d units of the file, light is divided by the
    /// sum of these times 1, d, d² and d³.
    pub falloff: [f64; 4],
}

/// A point lamp nearer to the middle of a scene than this part of its radius is inside: it shines all
/// around, not in one direction.
const INSIDE: f64 = 0.25;

/// Returns the lights of a scene. `unit` is the length of a file's unit in the world's.
///
/// The library's lamps fall off with the square of the distance. Point lights that hardly fall off and are outside the
/// scene become directional lights: with square falloff they would overexpose nearby surfaces. Others get the strength
/// that they have in the middle of the scene, or at its radius if they are nearer than that.
///
/// Black lamps are left out; all are left out if only ambient light remains, which shows no shapes.
pub(crate) fn lights(lamps: &[Lamp], unit: f64, scene: &Scene) -> Vec<Light> {
    let sphere = LazyCell::new(|| scene.bounding_sphere());
    let light = |lamp: &Lamp| {
        let (kind, scale) = match lamp.kind {
            LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
                let none = BoundingSphere { center: position, radius: unit };
                fit(lamp, position, unit, sphere.unwrap_or(none))
            }
            kind => (kind, 1.0),
        };
        let color = (lamp.color.as_dvec3() * scale).as_vec3();
        let shines = color.is_finite() && color.max_element() > 0.0;
        shines.then(|| Light { kind, color: color.max(Vec3::ZERO) })
    };
    let lights: Vec<Light> = lamps.iter().filter_map(light).collect();
    let shows = lights.iter().any(|l| l.kind != LightKind::Ambient);
    if shows { lights } else { Vec::new() }
}

/// Returns the kind of a lamp at a place, and the factor of its colour that gives the right strength at the scene.
fn fit(lamp: &Lamp, position: DVec3, unit: f64, scene: BoundingSphere) -> (LightKind, f64) {
    let way = scene.center - position;
    let distance = way.length().max(scene.radius);
    let d = distance / unit;
    let divisor = lamp.falloff.iter().rev().fold(0.0, |sum, c| sum * d + c);
    let or_one = |scale: f64| if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
    let is_point = matches!(lamp.kind, LightKind::Point { .. });
    let is_even = 2.0 * lamp.falloff[0] >= divisor && way.length() > INSIDE * scene.radius;
    match way.try_normalize().filter(|_| is_point && is_even) {
        Some(direction) => (LightKind::Directional { direction }, or_one(1.0 / divisor)),
        None => (lamp.kind, or_one(distance * distance / divisor)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::scene::{Instance, Mesh};

    /// Returns a scene of two points, with the radius 1 around the origin.
    fn scene() -> Scene {
        let positions = vec![Vec3::X, Vec3::NEG_X];
        let mesh = Mesh { positions, ..Mesh::default() };
        let world_from_mesh = DMat4::IDENTITY;
        let instance = Instance { mesh: 0, world_from_mesh, name: String::new() };
        Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() }
    }

    #[test]
    fn lamps_are_as_strong_as_they_are_at_the_scene() {
        let lamp = |x: f64, falloff| Lamp {
            kind: LightKind::Point { position: DVec3::new(x, 0.0, 0.0), range: None },
            color: Vec3::splat(2.0),
            falloff,
        };
        for (x, falloff, unit, expected) in [
            // Equally strong everywhere.
            (10.0, [1.0, 0.0, 0.0, 0.0], 0.01, 2.0),
            (10.0, [1.0, 0.0, 1e-9, 0.0], 0.01, 2.0 / 1.001),
            // Inside the scene: 2 at its radius.
            (0.0, [1.0, 0.0, 0.0, 0.0], 0.01, 2.0),
            (10.0, [0.0, 1.0, 0.0, 0.0], 0.01, 0.2),
            // Whatever the distance, the falloff is the library's own.
            (10.0, [0.0, 0.0, 0.5, 0.0], 1.0, 4.0),
            (70.0, [0.0, 0.0, 0.5, 0.0], 1.0, 4.0),
            (70.0, [0.0, 0.0, 1.0, 0.0], 0.01, 2e-4),
            (10.0, [0.0, 0.0, 0.0, 1.0], 1.0, 0.2),
            (10.0, [0.0; 4], 1.0, 2.0),
        ] {
            let [light] = lights(&[lamp(x, falloff)], unit, &scene())[..] else { panic!("one") };
            assert!((light.color.x / expected - 1.0).abs() < 1e-6, "{falloff:?}: {}", light.color);
        }
    }

    #[test]
    fn lamps_that_do_not_fall_off_shine_one_way() {
        let (position, range) = (DVec3::new(0.0, 3.0, 0.0), None);
        let (point, direction) = (LightKind::Point { position, range }, DVec3::NEG_Y);
        let spot = LightKind::Spot { position, direction, range, inner: 0.1, outer: 0.2 };
        let kind = |kind, falloff| {
            let lamp = Lamp { kind, color: Vec3::ONE, falloff };
            let light = lights(&[lamp], 1.0, &scene())[0];
            (light.kind, f64::from(light.color.x))
        };
        let sun = LightKind::Directional { direction };
        assert_eq!(kind(point, [1.0, 0.0, 0.0, 0.0]), (sun, 1.0));
        assert_eq!(kind(point, [0.0, 0.0, 1.0, 0.0]), (point, 1.0));
        assert_eq!(kind(spot, [1.0, 0.0, 0.0, 0.0]), (spot, 9.0));
    }

    #[test]
    fn what_shows_no_shapes_does_not_count() {
        let lamp = |kind, color| Lamp { kind, color, falloff: [1.0, 0.0, 0.0, 0.0] };
        let sun = LightKind::Directional { direction: DVec3::NEG_Y };
        let all = |lamps: &[Lamp]| lights(lamps, 1.0, &scene()).len();
        assert_eq!(all(&[lamp(LightKind::Ambient, Vec3::ONE)]), 0);
        assert_eq!(all(&[lamp(LightKind::Ambient, Vec3::ONE), lamp(sun, Vec3::ZERO)]), 0);
        assert_eq!(all(&[lamp(LightKind::Ambient, Vec3::ONE), lamp(sun, Vec3::ONE)]), 2);
    }

    #[test]
    fn cameras_have_names_and_see() {
        let perspective = Projection::Perspective { fov_y: 1.0 };
        let lens = Lens { projection: perspective, near: None, far: None, aspect: Some(0.0) };
        let eye = |name: &str, lens, world| {
            let place = Place::Path("here".to_owned());
            Eye { name: name.to_owned(), world, lens, place }
        };
        let world = DMat4::from_translation(DVec3::new(0.0, 0.0, 9.0));
        let (mut scene, mut warnings) = (scene(), Vec::new());
        let eyes = [
            eye("a", Ok(lens), world),
            eye("a", Ok(lens), world),
            eye("", Ok(lens), world),
            eye("b", Ok(lens), DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0))),
            eye("c", Err("it is blind".to_owned()), world),
        ];
        add_cameras(eyes, &mut scene, &mut warnings);
        let names: Vec<&str> = scene.cameras.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["a", "a.2", "camera2"]);
        let seen = &scene.cameras[0];
        assert_eq!((seen.aspect, seen.camera.target), (None, DVec3::new(0.0, 0.0, 8.0)));
        assert!((seen.camera.far - 10.1).abs() < 1e-9 && (seen.camera.near - 1e-3).abs() < 1e-9);
        let messages: Vec<String> = warnings.iter().map(ToString::to_string).collect();
        assert_eq!(messages[0], "here: its node has no direction; the camera is left out");
        assert_eq!(messages[1], "here: it is blind; the camera is left out");
    }
}
