//! Sources of light, ready for shading.
//!
//! Point and spot lights fall off as in glTF's KHR_lights_punctual (2018): with the square of the
//! distance, to nothing at the range, and smoothly between the cone's inner and outer angle.

use super::axes::world_axes;
use super::environment::{Environment, Mirrored};
use super::lane::{Lane, Vec3Lane};
use super::panorama::Panorama;
use super::shadow::ShadowMaps;
use super::tone::{self, Tone};
use crate::math::{DVec3, Vec3};
use crate::scene::{Camera, Light, LightKind, UpAxis};
use std::sync::Arc;

/// Ambient light, as a part of white, that is added if the lights include none; without it, surfaces that no light
/// reaches would be black. Give [`LightKind::Ambient`] with colour zero to prevent it.
pub(crate) const DEFAULT_AMBIENT: f32 = 0.1;

/// A light from infinitely far away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DirectionalLight {
    /// Unit vector towards the light.
    pub to_light: Vec3,
    /// Linear colour times intensity.
    pub color: Vec3,
}

/// A point light or, with a cone, a spot light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointLight {
    /// Relative to [`PreparedLights::origin`].
    pub position: Vec3,
    /// Linear colour times intensity at a distance of one.
    pub color: Vec3,
    /// Range to the power −4; 0 = endless.
    inverse_range4: f32,
    /// Unit vector along the cone; zero for a point light.
    axis: Vec3,
    /// Strength in the cone is (cos angle · scale + offset)², held to 0…1.
    scale: f32,
    offset: f32,
}

/// The lights of one picture.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedLights {
    /// World space; positions handed to shading are relative to it. It is the eye.
    pub origin: DVec3,
    /// Ambient light and the surroundings that mirrors show.
    pub(crate) environment: Environment,
    /// Lights from infinitely far away.
    pub(crate) directional: Vec<DirectionalLight>,
    /// Point and spot lights.
    pub(crate) points: Vec<PointLight>,
    /// Shadow maps of the lights; empty if none throws shadows.
    pub(crate) shadows: ShadowMaps,
    /// Changes to light before it is shown.
    pub(crate) tone: Tone,
}

/// A panorama around a scene, and the scene's axis that points up in it.
pub(crate) type Around<'a> = Option<(&'a Arc<Panorama>, UpAxis)>;

/// Squared distance below which a point light does not get brighter, which keeps its strength finite.
const NEAREST2: f32 = 1e-8;

impl PreparedLights {
    /// Creates surroundings and lights from far away, seen from the origin, for tests.
    #[cfg(test)]
    pub(crate) fn far(environment: Environment, directional: Vec<DirectionalLight>) -> Self {
        let (shadows, tone) = (ShadowMaps::default(), Tone::default());
        Self { origin: DVec3::ZERO, environment, directional, points: Vec::new(), shadows, tone }
    }

    /// Prepares lights for pictures from this camera's eye.
    ///
    /// Directions that are not finite or zero are left out, and so are positions that are not finite. If there is no
    /// ambient light, 0.1 is added. Mirrors show the ambient light and a quarter of the directional
    /// light, as if that were spread over the whole sphere.
    pub fn new(lights: &[Light], camera: &Camera) -> Self {
        Self::within(None, lights, camera)
    }

    /// Builds it like [`Self::new`], with a panorama, if there is one, in place of ambient light that is
    /// not among the lights, and of the reflection in mirrors.
    pub(crate) fn within(around: Around<'_>, lights: &[Light], camera: &Camera) -> Self {
        let mut prepared = Self::without_ambient(around, lights, camera);
        prepared.surround(ambient(lights), 1.0, Vec3::ZERO);
        prepared
    }

    /// Builds it without ambient light and without the reflections of other lights.
    pub(super) fn without_ambient(around: Around<'_>, lights: &[Light], camera: &Camera) -> Self {
        let up = camera.up.normalize_or(DVec3::Y).as_vec3();
        let mut environment = Environment { up, ..Environment::uniform(Vec3::ZERO) };
        if let Some((panorama, up)) = around {
            let (panorama, axes) = (Arc::clone(panorama), world_axes(up));
            environment.mirrored = Mirrored::Panorama { panorama, axes };
            environment.radiance = Vec3::ONE;
        }
        let mut prepared = Self {
            origin: camera.eye,
            environment,
            directional: Vec::new(),
            points: Vec::new(),
            shadows: ShadowMaps::default(),
            tone: Tone::default(),
        };
        lights.iter().for_each(|light| prepared.add(light));
        prepared
    }

    /// Sets the ambient light and the surroundings that mirrors show: a panorama times `factor`, or the light of all
    /// lights, where `from_points` is the part of point lights.
    pub(super) fn surround(&mut self, ambient: Option<Vec3>, factor: f32, from_points: Vec3) {
        let directional: Vec3 = self.directional.iter().map(|l| l.color).sum();
        let environment = &mut self.environment;
        if let Mirrored::Panorama { .. } = environment.mirrored {
            environment.ambient = ambient.unwrap_or_default();
            environment.radiance = Vec3::splat(factor);
            return;
        }
        let ambient = ambient.unwrap_or(Vec3::splat(DEFAULT_AMBIENT));
        environment.ambient = ambient;
        environment.radiance = ambient + directional * 0.25 + from_points;
        (environment.gradient, environment.step) = (0.4, 0.45);
    }

    /// Creates key, fill and rim lights that go with the camera, and more ambient light from above.
    pub fn auto(camera: &Camera) -> Self {
        let mut prepared = Self::new(&auto_lights(camera), camera);
        let environment = &mut prepared.environment;
        environment.up = camera.axes()[1].normalize_or(DVec3::Y).as_vec3();
        environment.slope = 0.4;
        prepared
    }

    /// Returns the surroundings that a perfect mirror reflects in a unit direction, as a display shows
    /// them; `None` if they are only sky and ground.
    pub(crate) fn mirrored(&self, direction: Vec3) -> Option<Vec3> {
        let environment = &self.environment;
        environment.is_furnished().then(|| {
            let seen = environment.reflection(direction.into(), 0.0, Some(1.0));
            tone::display(self.tone.of(seen)).into()
        })
    }

    fn add(&mut self, light: &Light) {
        match light.kind {
            LightKind::Ambient => {}
            LightKind::Directional { direction } => {
                let to_light = (-direction).normalize_or_zero().as_vec3();
                if to_light != Vec3::ZERO {
                    self.directional.push(DirectionalLight { to_light, color: light.color });
                }
            }
            LightKind::Point { position, range } => {
                self.add_point(light.color, position, range, (Vec3::ZERO, 0.0, 1.0));
            }
            LightKind::Spot { position, direction, range, inner, outer } => {
                let (inner, outer) = (libm::cos(inner), libm::cos(outer));
                let scale = 1.0 / (inner - outer).max(0.001);
                let cone = (scale as f32, (-outer * scale) as f32);
                let axis = direction.normalize_or_zero().as_vec3();
                self.add_point(light.color, position, range, (axis, cone.0, cone.1));
            }
        }
    }

    fn add_point(
        &mut self,
        color: Vec3,
        position: DVec3,
        range: Option<f64>,
        (axis, scale, offset): (Vec3, f32, f32),
    ) {
        let position = (position - self.origin).as_vec3();
        let inverse2 = range.filter(|r| *r > 0.0).map_or(0.0, |r| 1.0 / (r * r));
        let inverse_range4 = (inverse2 * inverse2) as f32;
        if position.is_finite() {
            self.points.push(PointLight { position, color, inverse_range4, axis, scale, offset });
        }
    }
}

/// Returns the sum of all ambient lights; `None` if there is none.
pub(super) fn ambient(lights: &[Light]) -> Option<Vec3> {
    let ambient = lights.iter().filter(|l| l.kind == LightKind::Ambient);
    ambient.map(|l| l.color).reduce(|a, b| a + b)
}

impl PointLight {
    /// Returns the unit vector along the axis of a spot light and the cosine of its outer angle; `None` for a light
    /// that shines everywhere.
    pub(crate) fn cone(&self) -> Option<(Vec3, f32)> {
        (self.axis != Vec3::ZERO).then(|| (self.axis, -self.offset / self.scale))
    }

    /// Returns unit vector from `position` to the light, and the light's strength there.
    #[inline(always)]
    pub(crate) fn seen_from<L: Lane>(&self, position: Vec3Lane<L>) -> (Vec3Lane<L>, L) {
        let d = Vec3Lane::splat(position.x, self.position).minus(position);
        let distance2 = d.dot(d);
        let to_light = d.unit_or(Vec3Lane::splat(distance2, Vec3::ZERO));
        // The window 1 − (d/range)⁴ ends the light at its range.
        let window = (distance2 * distance2 * self.inverse_range4).one_minus().at_least(0.0);
        let cone = to_light.dot_all(-self.axis) * self.scale + self.offset;
        let cone = cone.at_least(0.0).at_most(1.0);
        (to_light, window / distance2.at_least(NEAREST2) * (cone * cone))
    }
}

/// Returns the light that shows the form of any model: key light from the upper left, weaker fill
/// light from the right, rim light from behind, ambient light; all of them go with the camera.
///
/// White matte surfaces stay below white, and no side is black: on a matte sphere of reflectance 0.8 the 8-bit colours
/// are between 76 and 220.
pub(crate) fn auto_lights(camera: &Camera) -> Vec<Light> {
    let [right, up, back] = camera.axes();
    let from = |x: f64, y: f64, z: f64, intensity: f32| {
        let direction = -(right * x + up * y + back * z).normalize_or_zero();
        Light { kind: LightKind::Directional { direction }, color: Vec3::splat(intensity) }
    };
    vec![
        from(-0.55, 0.75, 1.0, 0.7),
        from(0.9, 0.0, 0.6, 0.15),
        from(0.5, 0.5, -1.0, 0.2),
        Light { kind: LightKind::Ambient, color: Vec3::splat(0.15) },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::camera_at;

    fn camera() -> Camera {
        Camera { target: DVec3::new(1e6, 0.0, 0.0), ..camera_at(1e6, 0.0, 10.0) }
    }

    fn strength(kind: LightKind, at: Vec3) -> f32 {
        let lights = PreparedLights::new(&[Light { kind, color: Vec3::ONE }], &camera());
        lights.points[0].seen_from(Vec3Lane::from(at)).1
    }

    #[test]
    fn point_lights_fall_off_with_the_square_and_end_at_their_range() {
        let position = camera().eye + DVec3::new(0.0, 2.0, 0.0);
        let endless = LightKind::Point { position, range: None };
        assert_eq!(strength(endless, Vec3::ZERO), 0.25);
        assert_eq!(strength(endless, Vec3::new(0.0, -2.0, 0.0)), 1.0 / 16.0);
        let short = LightKind::Point { position, range: Some(4.0) };
        assert_eq!(strength(short, Vec3::ZERO), 0.25 * (1.0 - 1.0 / 16.0));
        assert_eq!(strength(short, Vec3::new(0.0, -2.0, 0.0)), 0.0);
        assert_eq!(strength(short, Vec3::new(0.0, -9.0, 0.0)), 0.0);
        // At the light itself the strength is finite, and light has no direction.
        assert!(strength(endless, Vec3::new(0.0, 2.0, 0.0)).is_finite());
    }

    #[test]
    fn spot_lights_fade_between_their_angles() {
        let position = camera().eye + DVec3::new(0.0, 1.0, 0.0);
        let (inner, outer) = (0.3, 0.6);
        let direction = -DVec3::Y;
        let spot = LightKind::Spot { position, direction, range: None, inner, outer };
        let at_angle = |a: f64| {
            let down = DVec3::new(libm::sin(a), 1.0 - libm::cos(a), 0.0).as_vec3();
            strength(spot, down)
        };
        assert!((at_angle(0.0) - 1.0).abs() < 1e-5 && (at_angle(0.29) - 1.0).abs() < 1e-5);
        assert_eq!(at_angle(0.61), 0.0);
        let middle = libm::acos((libm::cos(inner) + libm::cos(outer)) / 2.0);
        assert!((at_angle(middle) - 0.25).abs() < 1e-4);
    }

    #[test]
    fn automatic_lights_go_with_the_camera() {
        let (a, mut b) = (camera(), camera());
        b.eye = b.target + DVec3::new(10.0, 0.0, 0.0);
        let in_view = |c: &Camera| -> Vec<DVec3> {
            let view = c.view_from_world();
            let lights = PreparedLights::auto(c).directional;
            lights.iter().map(|l| view.transform_vector3(l.to_light.as_dvec3())).collect()
        };
        for (x, y) in in_view(&a).iter().zip(in_view(&b)) {
            assert!((*x - y).length() < 1e-6);
        }
    }

    #[test]
    fn lights_without_ambient_get_a_little() {
        let key = Light { kind: LightKind::Directional { direction: -DVec3::Z }, color: Vec3::ONE };
        let none = Light { kind: LightKind::Ambient, color: Vec3::ZERO };
        let bad = Light { kind: LightKind::Directional { direction: DVec3::NAN }, ..key };
        let lights = PreparedLights::new(&[key, bad], &camera());
        assert_eq!(lights.environment.ambient, Vec3::splat(DEFAULT_AMBIENT));
        assert_eq!(lights.directional.len(), 1);
        assert_eq!(PreparedLights::new(&[key, none], &camera()).environment.ambient, Vec3::ZERO);
    }
}
