//! Light on the surface that a ray hits: shadows, mirror images, refraction.
//!
//! T. Whitted, *An Improved Illumination Model for Shaded Display*, CACM 1980. Amount of reflection: C. Schlick, *An
//! Inexpensive BRDF Model for Physically-based Rendering*, Eurographics 1994.

use super::world::{Cast, Ray, WorldHit, WorldTriangles};
use super::{Options, RayKind, Tests};
use crate::math::{Vec3, Vec4};
use crate::scene::{Material, Projection, ShadingModel};
use crate::shade::color::premultiply;
use crate::shade::{PreparedLights, Shading};
use crate::trace::NoTrace;
use crate::visibility::surface::Background;
use crate::visibility::surface::layers::compose;
use crate::visibility::surface::lit::{Lighting, Lit, Seen};
use crate::visibility::surface::points::attributes::{blend, run_of};
use crate::visibility::surface::setup::Coverage;

/// Contributions below this change no 8-bit colour and are not followed.
const LEAST: f32 = 1.0 / 512.0;

/// Largest depth to which rays are followed, whatever the options say.
const DEEPEST: u32 = 32;

/// Number of blended surfaces that a ray passes through after the last bounce; further ones count as opaque.
const MOST_LAYERS: usize = 1024;

/// Distance from a ray's origin, as a factor of the largest coordinate, within which it hits nothing: more than the
/// rounding of the origin.
const CLEARANCE: f32 = 1.0 / (1 << 18) as f32;

/// Callback for each ray that is cast.
type Hear<'h> = &'h mut dyn FnMut(RayKind, u32, &Ray, Cast);

/// Lighting state of one thread.
pub struct Whitted<'a> {
    world: Option<&'a WorldTriangles>,
    shared: Lighting<'a>,
    options: &'a Options,
    lit: Lit<'a>,
    /// The lights without those that do not reach the point.
    reaching: PreparedLights,
    default_material: Material,
    /// True if tests of boxes and triangles are counted.
    counts: bool,
    stack: Vec<(u32, f32)>,
}

/// A point to be lit.
#[derive(Clone, Copy)]
struct Point {
    item: u32,
    seen: Seen,
    position: Vec3,
    /// Unit vector towards the viewpoint.
    view: Vec3,
    /// Unit normals, turned to the viewer.
    normal: Vec3,
    face_normal: Vec3,
    /// True if the front of the face is seen.
    front: bool,
}

/// Path of a ray to its point.
#[derive(Clone, Copy)]
struct Path {
    generation: u32,
    /// Share in the pixel's colour.
    weight: f32,
    /// Colour if nothing is hit; linear, premultiplied.
    behind: Vec4,
}

impl<'a> Whitted<'a> {
    pub fn new(
        world: Option<&'a WorldTriangles>,
        shared: Lighting<'a>,
        options: &'a Options,
        counts: bool,
    ) -> Self {
        Self {
            world,
            shared,
            options,
            lit: Lit::new(shared),
            reaching: shared.lights.clone(),
            default_material: Material::default(),
            counts,
            stack: Vec::new(),
        }
    }

    /// Returns the linear premultiplied colour at a pixel's centre along a ray from the eye: of an item, or
    /// [`crate::target::NO_ITEM`], and of the items that the ray passed through without secondary rays, far ones first.
    pub fn at_pixel(
        &mut self,
        stack: &[u32],
        [x, y]: [i32; 2],
        behind: Vec4,
        hear: &mut impl FnMut(RayKind, u32, &Ray, Cast),
    ) -> Vec4 {
        let Some((&item, blended)) = stack.split_first() else { return behind };
        let Some(world) = self.world.filter(|_| u64::from(item) < self.triangle_count()) else {
            return compose(&mut self.lit, item, blended.iter().copied(), behind, [x, y]);
        };
        let camera = self.shared.view.camera();
        let weights = self.lit.triangle(item).weights(x, y);
        let towards_eye = match camera.projection {
            Projection::Perspective { .. } => -blend(&self.lit.triangle(item).positions(), weights),
            Projection::Orthographic { .. } => camera.axes()[2].as_vec3(),
        };
        let point = self.point(item, Seen::Pixel(x, y), weights, towards_eye);
        let path = Path { generation: 0, weight: 1.0, behind };
        self.light(world, &point, path, hear)
    }

    fn triangle_count(&self) -> u64 {
        self.shared.scene.triangle_count()
    }

    fn point(&mut self, item: u32, seen: Seen, weights: [f32; 3], view: Vec3) -> Point {
        let t = self.lit.triangle(item);
        let view = view.normalize_or_zero();
        let face_normal = t.face_normal();
        let front = face_normal.dot(view) >= 0.0;
        let face_normal = if front { face_normal } else { -face_normal };
        let normal = blend(&t.corner_normals(), weights).normalize_or(face_normal);
        let normal = if normal.dot(view) < 0.0 { -normal } else { normal };
        let position = blend(&t.positions(), weights);
        Point { item, seen, position, view, normal, face_normal, front }
    }

    /// Returns the linear premultiplied colour of a point, including its reflection and the surfaces visible through
    /// it.
    fn light(&mut self, world: &WorldTriangles, p: &Point, path: Path, hear: Hear<'_>) -> Vec4 {
        if self.options.shadows {
            self.find_reaching(world, p, path.generation, hear);
        }
        let local = self.lit.color_under(p.item, p.seen, &self.reaching);
        let mut color = premultiply(local);
        if local.w < 1.0 {
            let weight = path.weight * (1.0 - local.w);
            let through = Path { generation: path.generation + 1, weight, ..path };
            let direction = self.refracted(p);
            let seen = self.follow(world, p, direction, RayKind::Refraction, through, hear);
            color += seen * (1.0 - local.w);
        }
        if self.options.reflections {
            let share = self.mirrored_share(p);
            let weight = path.weight * share.max_element();
            let direction = reflected(p.view, p.normal);
            let behind = self.surroundings(direction);
            let mirrored = Path { generation: path.generation + 1, weight, behind };
            if weight >= LEAST && direction.dot(p.face_normal) > 0.0 {
                let seen = self.follow(world, p, direction, RayKind::Mirror, mirrored, hear);
                let mixed = color.truncate() * (Vec3::ONE - share) + seen.truncate() * share;
                let alpha = color.w + (seen.w - color.w).max(0.0) * share.max_element();
                color = mixed.extend(alpha);
            }
        }
        color
    }

    /// Returns the colour along a secondary ray.
    fn follow(
        &mut self,
        world: &WorldTriangles,
        from: &Point,
        direction: Vec3,
        kind: RayKind,
        path: Path,
        hear: Hear<'_>,
    ) -> Vec4 {
        if path.weight < LEAST {
            return path.behind;
        }
        if path.generation > self.options.depth.min(DEEPEST) {
            return match kind {
                RayKind::Refraction => self.straight_on(world, *from, direction, path, hear),
                _ => path.behind,
            };
        }
        let ray = leaving(from, direction, f32::MAX);
        let cast = self.cast(world, &ray, false);
        hear(kind, path.generation, &ray, cast);
        let Some(WorldHit { item, weights, .. }) = cast.hit else { return path.behind };
        let seen = Seen::Point { weights, view: -direction };
        let point = self.point(item, seen, weights, -direction);
        self.light(world, &point, path, hear)
    }

    /// Returns the colour of a ray after the last bounce: everything that it passes through, straight ahead, up to the
    /// first opaque surface.
    fn straight_on(
        &mut self,
        world: &WorldTriangles,
        mut from: Point,
        direction: Vec3,
        path: Path,
        hear: Hear<'_>,
    ) -> Vec4 {
        let (mut color, mut left) = (Vec4::ZERO, 1.0);
        for _ in 0..MOST_LAYERS {
            let ray = leaving(&from, direction, f32::MAX);
            let cast = self.cast(world, &ray, false);
            hear(RayKind::Refraction, path.generation, &ray, cast);
            let Some(WorldHit { item, weights, .. }) = cast.hit else { break };
            let seen = Seen::Point { weights, view: -direction };
            from = self.point(item, seen, weights, -direction);
            if self.options.shadows {
                self.find_reaching(world, &from, path.generation, hear);
            }
            let layer = premultiply(self.lit.color_under(item, seen, &self.reaching));
            color += layer * left;
            left *= 1.0 - layer.w;
            if left * path.weight < LEAST {
                return color;
            }
        }
        color + path.behind * left
    }

    /// Returns the nearest hit of a ray; for shadows, blended surfaces are left out.
    fn cast(&mut self, world: &WorldTriangles, ray: &Ray, shadow: bool) -> Cast {
        let Self { lit, stack, shared, counts, .. } = self;
        let accept = |hit: &WorldHit| {
            let coverage = shared.runs[run_of(shared.runs, hit.item)].coverage;
            match coverage {
                Coverage::Opaque => true,
                Coverage::Blended => !shadow,
                Coverage::Masked => {
                    let seen = Seen::Point { weights: hit.weights, view: -ray.direction };
                    lit.alpha(hit.item, seen) > 0.0
                }
            }
        };
        let mut tests = Tests::default();
        let hit = match *counts {
            false => world.nearest(ray, stack, accept, &mut NoTrace),
            true => world.nearest(ray, stack, accept, &mut tests),
        };
        Cast { hit, tests }
    }

    /// Removes from [`Self::reaching`] the lights that are blocked from a point. Blended surfaces cast no shadow.
    fn find_reaching(
        &mut self,
        world: &WorldTriangles,
        p: &Point,
        generation: u32,
        hear: Hear<'_>,
    ) {
        let lights = self.shared.lights;
        for (i, light) in lights.directional.iter().enumerate() {
            let dark = self.in_shadow(world, p, light.to_light, f32::MAX, generation, hear);
            self.reaching.directional[i].color = if dark { Vec3::ZERO } else { light.color };
        }
        for (i, light) in lights.points.iter().enumerate() {
            let way = light.position - p.position;
            let (distance, direction) = (way.length(), way.normalize_or_zero());
            // The ray ends before a lamp's own surface around the light.
            let reach = distance * (1.0 - 16.0 * CLEARANCE);
            let dark = self.in_shadow(world, p, direction, reach, generation, hear);
            self.reaching.points[i].color = if dark { Vec3::ZERO } else { light.color };
        }
    }

    fn in_shadow(
        &mut self,
        world: &WorldTriangles,
        p: &Point,
        direction: Vec3,
        reach: f32,
        generation: u32,
        hear: Hear<'_>,
    ) -> bool {
        // A surface that faces away from the light is dark without a ray.
        if direction.dot(p.face_normal) <= 0.0 {
            return false;
        }
        let ray = leaving(p, direction, reach);
        let cast = self.cast(world, &ray, true);
        hear(RayKind::Shadow, generation, &ray, cast);
        cast.hit.is_some()
    }

    fn material(&self, item: u32) -> &Material {
        let run = &self.shared.runs[run_of(self.shared.runs, item)];
        run.material.map_or(&self.default_material, |m| &self.shared.scene.materials[m])
    }

    /// Returns the share of the mirror image in a point's colour; textures do not change it.
    fn mirrored_share(&self, p: &Point) -> Vec3 {
        let m = self.material(p.item);
        let (straight, roughness) = match m.model {
            ShadingModel::Unlit => return Vec3::ZERO,
            _ if self.shared.shading == Some(Shading::Unlit) => return Vec3::ZERO,
            ShadingModel::MetallicRoughness => {
                let base = m.base_color.truncate();
                (Vec3::splat(0.04).lerp(base, m.metallic.clamp(0.0, 1.0)), m.roughness)
            }
            ShadingModel::Phong => (m.specular, (2.0 / (m.shininess.max(0.0) + 2.0)).sqrt().sqrt()),
        };
        let straight = straight.clamp(Vec3::ZERO, Vec3::ONE);
        let smooth = 1.0 - roughness.clamp(0.0, 1.0);
        let x = 1.0 - p.normal.dot(p.view).clamp(0.0, 1.0);
        let grazing = (x * x) * (x * x) * x;
        (straight + (Vec3::ONE - straight) * grazing) * (smooth * smooth)
    }

    /// Returns the direction of a ray behind a surface; mirrored if it cannot leave.
    fn refracted(&self, p: &Point) -> Vec3 {
        let index = self.options.refractive_index;
        let index = if index.is_finite() && index > 0.0 { index } else { 1.0 };
        let eta = if p.front { 1.0 / index } else { index };
        let cos = p.normal.dot(p.view);
        let k = 1.0 - eta * eta * (1.0 - cos * cos);
        if index == 1.0 {
            return -p.view;
        }
        if k < 0.0 {
            return reflected(p.view, p.normal);
        }
        (p.normal * (eta * cos - k.sqrt()) - p.view * eta).normalize_or(-p.view)
    }

    /// Returns the colour in mirrors that reflect nothing of the scene: its surroundings, or the
    /// background if these are only sky and ground; linear, premultiplied.
    fn surroundings(&self, direction: Vec3) -> Vec4 {
        let mirrored = self.shared.lights.mirrored(direction);
        mirrored.map_or_else(|| self.sky(direction), |color| color.extend(1.0))
    }

    /// Returns the background in a direction; linear, premultiplied.
    fn sky(&self, direction: Vec3) -> Vec4 {
        premultiply(match self.options.look.background {
            Background::Color(color) => color,
            Background::Gradient(top, bottom) => {
                let up = self.shared.view.camera().axes()[1].as_vec3();
                top.lerp(bottom, (0.5 - 0.5 * direction.dot(up)).clamp(0.0, 1.0))
            }
        })
    }
}

fn reflected(view: Vec3, normal: Vec3) -> Vec3 {
    (normal * (2.0 * normal.dot(view)) - view).normalize_or(normal)
}

/// Returns a ray that leaves a surface.
fn leaving(p: &Point, direction: Vec3, to: f32) -> Ray {
    let from = p.position.abs().max_element() * CLEARANCE;
    Ray { origin: p.position, direction, from, to, leaves: p.item }
}
