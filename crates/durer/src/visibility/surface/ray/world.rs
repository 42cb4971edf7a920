//! Rays from anywhere, against all triangles of the scene.
//!
//! S. Woop, C. Benthin, I. Wald, *Watertight Ray/Triangle Intersection*, JCGT 2013.

use super::bvh::{Box3, Bvh, Test, Tests, surface};
use crate::math::Vec3;
use crate::scene::Topology;
use crate::trace::Tracer;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::points::attributes::Weights;

/// A ray; world axes, the origin relative to the eye.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// Smallest distance of a hit; nearer ones are left out.
    pub from: f32,
    /// Largest distance of a hit; farther ones are left out.
    pub to: f32,
    /// The item from which it starts, which it cannot hit.
    pub leaves: u32,
}

/// A hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WorldHit {
    pub distance: f32,
    pub item: u32,
    pub weights: Weights,
}

/// Result of casting a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cast {
    pub hit: Option<WorldHit>,
    /// All 0 unless steps are recorded.
    pub tests: Tests,
}

pub struct WorldTriangles {
    corners: Vec<[Vec3; 3]>,
    items: Vec<u32>,
    bvh: Bvh,
}

impl WorldTriangles {
    /// Bytes for each triangle of the scene.
    pub const PER_TRIANGLE: u64 = size_of::<([Vec3; 3], u32)>() as u64 + Bvh::PER_BOX;

    /// Creates all triangles of the input's scene; lines and points have no place in the world.
    pub fn new(input: &SurfaceInput<'_>) -> Self {
        let (mut corners, mut items) = (Vec::new(), Vec::new());
        for run in &input.runs {
            let mesh = &input.scene.meshes[run.mesh];
            if mesh.topology != Topology::Triangles {
                continue;
            }
            let matrix = input.scene.instances[run.instance].world_from_mesh;
            let eye = input.view.camera().eye;
            for (item, i) in (run.first_item..).zip(run.range.clone()) {
                let triangle = mesh.triangle(i as usize).map(|v| {
                    let p = mesh.positions[v as usize].as_dvec3();
                    (matrix.transform_point3(p) - eye).as_vec3()
                });
                if triangle.iter().all(|p| p.is_finite()) {
                    corners.push(triangle);
                    items.push(item);
                }
            }
        }
        let bounds =
            |t: &[Vec3; 3]| Box3 { min: t[0].min(t[1]).min(t[2]), max: t[0].max(t[1]).max(t[2]) };
        let boxes: Vec<Box3> = corners.iter().map(bounds).collect();
        Self { corners, items, bvh: Bvh::new(&boxes, surface) }
    }

    /// Returns the nearest hit that `accept` accepts; among equally near ones the lower item.
    pub fn nearest(
        &self,
        ray: &Ray,
        stack: &mut Vec<(u32, f32)>,
        mut accept: impl FnMut(&WorldHit) -> bool,
        tests: &mut impl Tracer<Test>,
    ) -> Option<WorldHit> {
        let (sheared, inverse) = (Sheared::new(ray), ray.direction.recip());
        let mut best: Option<WorldHit> = None;
        let enter = |b: &Box3| enter(b, ray, inverse);
        let visit = |i: u32, limit: &mut f32| {
            let item = self.items[i as usize];
            if item == ray.leaves {
                return;
            }
            let Some((distance, weights)) = sheared.hit(&self.corners[i as usize]) else { return };
            let hit = WorldHit { distance, item, weights };
            let in_reach = distance >= ray.from && distance <= ray.to;
            let wins = best.is_none_or(|b| (distance, item) < (b.distance, b.item));
            if in_reach && wins && accept(&hit) {
                *limit = distance;
                best = Some(hit);
            }
        };
        self.bvh.visit(ray.to, stack, enter, visit, tests);
        best
    }
}

/// Returns the parameter at which a ray enters a box, if it does. The far end is moved out by more
/// than rounding can move it in (T. Ize, *Robust BVH Ray Traversal*, JCGT 2013).
#[inline]
fn enter(b: &Box3, ray: &Ray, inverse: Vec3) -> Option<f32> {
    let (mut near, mut far) = (0.0f32, ray.to);
    for k in 0..3 {
        let a = (b.min[k] - ray.origin[k]) * inverse[k];
        let c = (b.max[k] - ray.origin[k]) * inverse[k];
        // NaN, from a ray within a face's plane, is dropped by min and max.
        near = near.max(a.min(c));
        far = far.min(a.max(c) * (1.0 + 4.0 * f32::EPSILON));
    }
    (near <= far).then_some(near)
}

/// A ray as a shear that takes it to the z axis.
struct Sheared {
    origin: Vec3,
    axes: [usize; 3],
    shear: Vec3,
}

impl Sheared {
    fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let a = d.abs();
        let z = if a.x >= a.y && a.x >= a.z { 0 } else { 1 + usize::from(a.z > a.y) };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if d[z] < 0.0 {
            (x, y) = (y, x);
        }
        let shear = Vec3::new(d[x] / d[z], d[y] / d[z], 1.0 / d[z]);
        Self { origin: ray.origin, axes: [x, y, z], shear }
    }

    /// Returns the distance and barycentric coordinates of the hit of a triangle, from either side.
    #[inline(always)]
    fn hit(&self, corners: &[Vec3; 3]) -> Option<(f32, Weights)> {
        let [kx, ky, kz] = self.axes;
        let local = |p: Vec3| {
            let p = p - self.origin;
            (p[kx] - self.shear.x * p[kz], p[ky] - self.shear.y * p[kz], self.shear.z * p[kz])
        };
        // Each by itself: `map` of an array may be a call for each corner.
        let (a, b, c) = (local(corners[0]), local(corners[1]), local(corners[2]));
        let edges = [cross(b, c), cross(c, a), cross(a, b)];
        let (negative, positive) = (edges.iter().any(|&e| e < 0.0), edges.iter().any(|&e| e > 0.0));
        if negative == positive {
            return None;
        }
        let sum = edges[0] + edges[1] + edges[2];
        let weight = |e: f64| (e / sum) as f32;
        let weights = [weight(edges[0]), weight(edges[1]), weight(edges[2])];
        Some((weights[0] * a.2 + weights[1] * b.2 + weights[2] * c.2, weights))
    }
}

/// Returns the edge function of two sheared points; in f64 the products are exact, so its sign is.
#[inline]
fn cross(a: (f32, f32, f32), b: (f32, f32, f32)) -> f64 {
    f64::from(b.0) * f64::from(a.1) - f64::from(b.1) * f64::from(a.0)
}
