//! Exposure: how bright the light of a picture is shown.

use super::light::{Around, PreparedLights, ambient};
use crate::math::{DVec3, Vec3};
use crate::scene::{Camera, Instance, Light, Mesh, Scene};

/// Exposure: how bright the light of a picture is shown.
///
/// Files give light in units of their own: lux and candela, or an artist's program's conversion of watts.
/// [`Self::Auto`] works like a photographer's light meter (incident light, ISO 2720:1974): it measures the light at
/// points spread evenly over all surfaces and ignores the few brightest of the lit points, which almost touch a lamp.
/// All lights are then scaled by one factor, so that scenes that differ only in the strength of all their lamps look
/// alike. Emissive and unlit surfaces are given as parts of white already and do not change. The eye's position and
/// shadows have no influence, so all pictures of a scene are exposed alike.
///
/// Cost: O(triangles / stride) for the areas of at most 2¹⁶ triangles, and 2¹² points × lights.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Exposure {
    /// Automatic: a white matte surface where much light falls is nearly white. Light that comes with the camera is made so and stays.
    #[default]
    Auto,
    /// Factor of two to this power, −64 … 64, for all light including emission; 0 shows lights in their own unit
    /// ([`crate::scene::Light::color`]).
    Ev(f32),
}

/// Light of a white matte surface in the bright places of a scene, as part of white. The rest is room for ambient light
/// and brighter places.
const LEVEL: f64 = 0.8;
/// The part of all lit points that are at most as bright as [`LEVEL`].
const PART: f64 = 0.97;
/// Limit on the triangles of a scene that are examined.
const TRIANGLES: u64 = 1 << 16;
/// Number of their points that are measured.
const POINTS: usize = 1 << 12;
/// The brightness of a point light in mirrors, as a part of its light on the average lit surface: as for a directional
/// light, a quarter of the light at perpendicular incidence, which is twice the average.
const IN_MIRRORS: f32 = 0.5;

/// Measured light.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Metered {
    /// Factor by which all lights are made stronger; 1 where no light falls on anything.
    factor: f32,
    /// Reflections of point lights in mirrors, before that.
    from_points: Vec3,
}

impl Metered {
    /// Measures lights, with `ambient` light besides, at the surfaces of a scene.
    fn new(scene: &Scene, lights: &PreparedLights, ambient: Vec3) -> Self {
        let (mut levels, mut from_points) = (Vec::new(), Vec3::ZERO);
        for point in points(scene, lights.origin) {
            let (far, near) = irradiance(lights, &point);
            let level = f64::from((far + near + ambient).max_element());
            if level > 0.0 && level.is_finite() && near.is_finite() {
                levels.push(level);
                from_points += near;
            }
        }
        levels.sort_unstable_by(f64::total_cmp);
        let last = levels.len().saturating_sub(1) as f64;
        let level = levels.get((last * PART) as usize).map_or(LEVEL, |level| *level);
        // Held so that products with colours stay finite.
        let factor = (LEVEL / level).clamp(1e-30, 1e30) as f32;
        Self { factor, from_points: from_points * (IN_MIRRORS / levels.len().max(1) as f32) }
    }
}

impl PreparedLights {
    /// Builds it like [`Self::within`], but makes all light stronger or weaker by one factor, so that a white matte
    /// surface where much of it falls on the scene is nearly white: see [the module](self). If there is no ambient
    /// light, [`DEFAULT_AMBIENT`](super::light::DEFAULT_AMBIENT) is added as it is. The scene must pass
    /// [`Scene::check`].
    pub(crate) fn exposed(
        around: Around<'_>,
        lights: &[Light],
        scene: &Scene,
        camera: &Camera,
    ) -> Self {
        let mut prepared = Self::without_ambient(around, lights, camera);
        let ambient = ambient(lights);
        let Metered { factor, from_points } =
            Metered::new(scene, &prepared, ambient.unwrap_or_default());
        let directional = prepared.directional.iter_mut().map(|l| &mut l.color);
        for color in directional.chain(prepared.points.iter_mut().map(|l| &mut l.color)) {
            *color *= factor;
        }
        prepared.surround(ambient.map(|ambient| ambient * factor), factor, from_points * factor);
        prepared
    }

    /// Returns the scene's own lights, exposed, or, if it has none,
    /// [`PreparedLights::auto`].
    pub fn of(scene: &Scene, camera: &Camera) -> Self {
        match &scene.lights[..] {
            [] => Self::auto(camera),
            lights => Self::exposed(None, lights, scene, camera),
        }
    }
}

/// A point of a surface.
struct Point {
    /// Relative to the lights' origin.
    position: Vec3,
    /// Normal of unit length, on either side: both are lit.
    normal: Vec3,
}

/// Returns the light on a point from infinitely distant sources, including a panorama, and from point and spot lights.
fn irradiance(lights: &PreparedLights, point: &Point) -> (Vec3, Vec3) {
    let side = |normal: Vec3| Vec3::from(lights.environment.diffuse(normal.into()));
    let around = side(point.normal).max(side(-point.normal));
    let far = lights.directional.iter().map(|l| l.color * l.to_light.dot(point.normal).abs());
    let near = lights.points.iter().map(|l| {
        let (to_light, strength) = l.seen_from(point.position.into());
        l.color * (Vec3::from(to_light).dot(point.normal).abs() * strength)
    });
    (around + far.sum::<Vec3>(), near.sum())
}

/// A triangle and the sum of the areas up to it.
struct Summed {
    corners: [DVec3; 3],
    area: f64,
}

/// Returns points spread evenly over the triangles of a scene.
fn points(scene: &Scene, origin: DVec3) -> Vec<Point> {
    let triangles = summed(scene);
    let whole = triangles.last().map_or(0.0, |t| t.area);
    let mut rest = triangles.iter();
    let mut current = rest.next();
    let mut points = Vec::with_capacity(POINTS);
    for i in 0..POINTS {
        let area = whole * ((i as f64 + 0.5) / POINTS as f64);
        while current.is_some_and(|t| t.area < area) {
            current = rest.next();
        }
        points.extend(current.map(|t| point(t, i as f64, origin)));
    }
    points
}

/// Returns the `i`th of points that are spread over a triangle, by M. Roberts, *The Unreasonable
/// Effectiveness of Quasirandom Sequences*, 2018.
fn point(triangle: &Summed, i: f64, origin: DVec3) -> Point {
    let [a, b, c] = triangle.corners;
    let (u, v) = ((i * 0.754_877_666_246_692_8).fract(), (i * 0.569_840_290_998_053_3).fract());
    let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
    let position = a - origin + (b - a) * u + (c - a) * v;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    Point { position: position.as_vec3(), normal: normal.as_vec3() }
}

/// Returns triangles at even distances in the order of the scene, without those of zero area.
fn summed(scene: &Scene) -> Vec<Summed> {
    let stride = scene.triangle_count().div_ceil(TRIANGLES).max(1);
    let (mut skipped, mut area) = (0, 0.0);
    let mut triangles = Vec::new();
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh];
        let count = mesh.triangle_count() as u64;
        for i in (skipped..count).step_by(stride as usize) {
            let corners = corners(instance, mesh, i as usize);
            let [a, b, c] = corners;
            let own = (b - a).cross(c - a).length() * 0.5;
            if own > 0.0 && (area + own).is_finite() {
                area += own;
                triangles.push(Summed { corners, area });
            }
        }
        // Number of triangles of the next instance before the next one to take.
        skipped = (stride - (count + stride - skipped) % stride) % stride;
    }
    triangles
}

fn corners(instance: &Instance, mesh: &Mesh, triangle: usize) -> [DVec3; 3] {
    mesh.triangle(triangle).map(|vertex| {
        instance.world_from_mesh.transform_point3(mesh.positions[vertex as usize].as_dvec3())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DMat4;
    use crate::scene::{Light, LightKind};
    use crate::testing::{camera_at, scene_of};

    /// Returns a square floor, from −half to half, in `cells` × `cells` squares.
    fn floor(half: f32, cells: u32) -> Scene {
        let at = |i: u32| (i as f32 / cells as f32 * 2.0 - 1.0) * half;
        let side = cells + 1;
        let positions =
            (0..side * side).map(|i| Vec3::new(at(i % side), 0.0, at(i / side))).collect();
        let cell = |i: u32| i / cells * side + i % cells;
        let corners = |i: u32| [0, side, 1, 1, side, side + 1].map(|d| cell(i) + d);
        let indices = Some((0..cells * cells).flat_map(corners).collect());
        scene_of(Mesh { positions, indices, ..Mesh::default() })
    }

    fn sun(direction: DVec3, strength: f32) -> Light {
        Light { kind: LightKind::Directional { direction }, color: Vec3::splat(strength) }
    }

    fn lamp(height: f64, color: Vec3) -> Light {
        Light { kind: LightKind::Point { position: DVec3::Y * height, range: None }, color }
    }

    #[test]
    fn the_sun_on_a_floor_is_brought_to_the_level() {
        for (strength, slope) in [(1.0f32, 0.0), (1e4, 0.0), (1e-6, 1.0), (3e5, 0.3)] {
            let sun = sun(DVec3::new(slope, -1.0, 0.0), strength);
            for cells in [1, 7, 300] {
                let scene = floor(2.0, cells);
                let lights =
                    PreparedLights::exposed(None, &[sun], &scene, &camera_at(3.0, 4.0, 5.0));
                let sun = &lights.directional[0];
                let light = sun.color.x * sun.to_light.y;
                assert!((light - 0.8).abs() < 1e-5, "{strength} {slope} {cells}: {light}");
                assert_eq!(lights.environment.ambient, Vec3::splat(0.1));
            }
        }
    }

    #[test]
    fn lamps_that_are_stronger_by_one_factor_make_the_same_picture() {
        let scene = floor(5.0, 10);
        let exposed = |factor: f32| {
            let lights = [
                lamp(2.0, Vec3::new(1.0, 0.5, 0.2) * factor),
                sun(DVec3::new(1.0, -2.0, 0.5), 0.3 * factor),
            ];
            PreparedLights::exposed(None, &lights, &scene, &camera_at(3.0, 4.0, 5.0))
        };
        let (one, many) = (exposed(1.0), exposed(1e4));
        let near = |a: Vec3, b: Vec3| (a - b).abs().max_element() < 1e-5 * a.max_element();
        assert!(near(one.points[0].color, many.points[0].color));
        assert!(near(one.directional[0].color, many.directional[0].color));
        assert!(near(one.environment.radiance, many.environment.radiance));
    }

    #[test]
    fn what_is_nearest_to_a_lamp_does_not_darken_all_else() {
        // 5 cm over a floor of 10 m, and 3 m under one.
        for (height, least, most) in [(0.05, 5.0, 1e5), (3.0, 0.8, 1.5)] {
            let lights = PreparedLights::exposed(
                None,
                &[lamp(height, Vec3::ONE)],
                &floor(5.0, 20),
                &camera_at(3.0, 4.0, 5.0),
            );
            let below = lights.points[0].color.x / (height * height) as f32;
            assert!(below > least && below < most, "{height}: {below}");
        }
    }

    #[test]
    fn where_nothing_is_lit_nothing_changes() {
        let black = lamp(1.0, Vec3::ZERO);
        for scene in [Scene::default(), floor(1.0, 3)] {
            let lights = PreparedLights::exposed(None, &[black], &scene, &camera_at(3.0, 4.0, 5.0));
            assert_eq!(lights, PreparedLights::new(&[black], &camera_at(3.0, 4.0, 5.0)));
        }
        let nothing = PreparedLights::exposed(
            None,
            &[lamp(1.0, Vec3::ONE)],
            &Scene::default(),
            &camera_at(3.0, 4.0, 5.0),
        );
        assert_eq!(nothing.points[0].color, Vec3::ONE);
    }

    #[test]
    fn all_instances_are_measured_however_many_triangles_there_are() {
        let mut scene = floor(1.0, 260);
        // A second floor, placed upright.
        let turned = DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2);
        scene.instances.push(Instance { world_from_mesh: turned, ..scene.instances[0].clone() });
        let count = scene.triangle_count();
        let triangles = summed(&scene);
        assert_eq!(triangles.len() as u64, count.div_ceil(count.div_ceil(TRIANGLES)));
        let upright = points(&scene, DVec3::ZERO).iter().filter(|p| p.normal.x.abs() > 0.9).count();
        assert!(upright.abs_diff(POINTS / 2) < 4, "{upright}");
    }
}
