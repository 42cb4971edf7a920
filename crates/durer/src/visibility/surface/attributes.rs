//! From a visible item back to its triangle, and from a pixel to a point on it.
//!
//! Perspective-correct coordinates come from the edge functions in homogeneous screen space
//! (M. Olano, T. Greer, *Triangle scan conversion using 2D homogeneous coordinates*, 1997), so
//! triangles that were cut at the near plane need no special care.

use crate::math::{DMat4, DVec3, Mat3, Vec3, Vec4};
use crate::scene::{Mesh, Scene, Topology};
use crate::target::NO_ITEM;
use crate::view::View;
use crate::visibility::surface::setup::Run;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// What all triangles of a run share.
#[derive(Debug, Clone, Copy)]
struct RunTransform {
    run: usize,
    screen_from_mesh: DMat4,
    eye_from_mesh: DMat4,
    normal_from_mesh: Mat3,
    world_from_mesh: Mat3,
    /// −1 where the instance mirrors, so that fronts stay fronts.
    handedness: f32,
}

/// A visible triangle, ready to be interpolated.
#[derive(Debug, Clone, Copy)]
pub struct VisibleTriangle {
    /// Its item.
    pub item: u32,
    /// Its vertices in the mesh.
    pub corners: [u32; 3],
    /// World axes, relative to the eye.
    pub positions: [Vec3; 3],
    /// World axes, not of unit length; all three the face normal where the mesh has none.
    pub normals: [Vec3; 3],
    /// Unit normal of the face's front, world axes.
    pub face_normal: Vec3,
    /// Directions from mesh to world, for tangents.
    world_from_mesh: Mat3,
    /// The pixel from whose centre x and y are counted.
    origin: [i32; 2],
    /// Edge function i at (x, y) is `edges[i][0] + edges[i][1]·x + edges[i][2]·y`.
    edges: [[f32; 3]; 3],
}

impl Default for VisibleTriangle {
    /// No triangle.
    fn default() -> Self {
        Self {
            item: NO_ITEM,
            corners: [0; 3],
            positions: [Vec3::ZERO; 3],
            normals: [Vec3::ZERO; 3],
            face_normal: Vec3::ZERO,
            world_from_mesh: Mat3::IDENTITY,
            origin: [0; 2],
            edges: [[0.0; 3]; 3],
        }
    }
}

/// The run that holds an item that was drawn.
pub fn run_of(runs: &[Run], item: u32) -> usize {
    runs.partition_point(|run| run.first_item <= item).saturating_sub(1)
}

/// Barycentric coordinates of one pixel.
pub type Weights = [f32; 3];

impl VisibleTriangle {
    /// Perspective-correct barycentric coordinates at a pixel's centre moved by `shift` pixels; kept
    /// within the triangle where the point lies outside, as it may at edges.
    #[inline(always)]
    pub fn weights(&self, x: i32, y: i32, shift: [f32; 2]) -> Weights {
        let fx = (x - self.origin[0]) as f32 + shift[0];
        let fy = (y - self.origin[1]) as f32 + shift[1];
        let edge = |e: &[f32; 3]| (e[0] + (e[1] * fx + e[2] * fy)).max(0.0);
        let (a, b, c) = (edge(&self.edges[0]), edge(&self.edges[1]), edge(&self.edges[2]));
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        [a * inverse, b * inverse, c * inverse]
    }

    /// Coordinates at the centres of the pixels to the right and below, also outside the triangle.
    pub fn weights_beside(&self, x: i32, y: i32) -> (Weights, Weights) {
        let at = |x: i32, y: i32| {
            let (fx, fy) = ((x - self.origin[0]) as f32, (y - self.origin[1]) as f32);
            let [a, b, c] = [0, 1, 2].map(|i| {
                let e = &self.edges[i];
                e[0] + (e[1] * fx + e[2] * fy)
            });
            let sum = a + b + c;
            // Beyond the horizon there is no such point: the derivative is that of the border.
            if sum > 0.0 { Some([a / sum, b / sum, c / sum]) } else { None }
        };
        let here = || self.weights(x, y, [0.0; 2]);
        (at(x + 1, y).unwrap_or_else(here), at(x, y + 1).unwrap_or_else(here))
    }

    /// The interpolated tangent, world axes, where the mesh has tangents.
    pub fn tangent(&self, mesh: &Mesh, w: Weights) -> Option<Vec4> {
        let [a, b, c] = match mesh.tangents.as_slice() {
            [] => return None,
            tangents => self.corners.map(|c| tangents[c as usize]),
        };
        let tangent = a * w[0] + b * w[1] + c * w[2];
        Some((self.world_from_mesh * tangent.truncate()).normalize_or_zero().extend(a.w))
    }

    /// [`Self::weights`] of eight pixels in a row, without shift.
    #[inline(always)]
    pub fn weights_x8<S: Simd>(&self, simd: S, x: i32, y: i32) -> [f32x8<S>; 3] {
        let lanes = f32x8::from_slice(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let zero = f32x8::splat(simd, 0.0);
        let fx = lanes + (x - self.origin[0]) as f32;
        let fy = (y - self.origin[1]) as f32;
        let [e0, e1, e2] = &self.edges;
        let a = (fx * e0[1] + e0[2] * fy + e0[0]).max(zero);
        let b = (fx * e1[1] + e1[2] * fy + e1[0]).max(zero);
        let c = (fx * e2[1] + e2[2] * fy + e2[0]).max(zero);
        let sum = (a + b + c).max(f32x8::splat(simd, f32::MIN_POSITIVE));
        let inverse = f32x8::splat(simd, 1.0) / sum;
        [a * inverse, b * inverse, c * inverse]
    }
}

/// A weighted sum of three vectors, in this order of operations.
#[inline(always)]
pub fn blend(values: &[Vec3; 3], w: Weights) -> Vec3 {
    let [a, b, c] = values;
    Vec3::new(
        a.x * w[0] + b.x * w[1] + c.x * w[2],
        a.y * w[0] + b.y * w[1] + c.y * w[2],
        a.z * w[0] + b.z * w[1] + c.z * w[2],
    )
}

/// [`blend`] of eight pixels: x, y and z apart.
#[inline(always)]
pub fn blend_x8<S: Simd>(values: &[Vec3; 3], w: &[f32x8<S>; 3]) -> [f32x8<S>; 3] {
    let [a, b, c] = values;
    [
        w[0] * a.x + w[1] * b.x + w[2] * c.x,
        w[0] * a.y + w[1] * b.y + w[2] * c.y,
        w[0] * a.z + w[1] * b.z + w[2] * c.z,
    ]
}

/// Finds visible triangles by item; keeps the latest ones, for neighbours share them.
pub struct Triangles<'a> {
    scene: &'a Scene,
    view: &'a View,
    runs: &'a [Run],
    transform: Option<RunTransform>,
    cache: Vec<VisibleTriangle>,
}

/// Triangles kept: a power of two; about 64 kB.
const CACHE: usize = 256;

impl<'a> Triangles<'a> {
    pub fn new(scene: &'a Scene, view: &'a View, runs: &'a [Run]) -> Self {
        Self { scene, view, runs, transform: None, cache: vec![VisibleTriangle::default(); CACHE] }
    }

    /// The triangle of an item that the rasterizer has drawn.
    #[inline(always)]
    pub fn get(&mut self, item: u32, run: usize) -> &VisibleTriangle {
        let slot = item as usize % CACHE;
        if self.cache[slot].item != item {
            self.prepare(item, run, slot);
        }
        &self.cache[slot]
    }

    fn transform_of(&mut self, run: usize) -> RunTransform {
        match self.transform {
            Some(t) if t.run == run => t,
            _ => {
                let t = RunTransform::new(run, &self.runs[run], self.scene, self.view);
                self.transform = Some(t);
                t
            }
        }
    }

    #[inline(never)]
    fn prepare(&mut self, item: u32, run_index: usize, slot: usize) {
        let t = self.transform_of(run_index);
        let run = &self.runs[run_index];
        let mesh = &self.scene.meshes[run.mesh];
        let primitive = (run.range.start + (item - run.first_item)) as usize;
        let is_triangle = mesh.topology == Topology::Triangles;
        let corners = if is_triangle {
            mesh.triangle(primitive)
        } else {
            let [a, b] = mesh.line_or_point(primitive);
            [a, b, a]
        };
        let points = corners.map(|c| mesh.positions[c as usize].as_dvec3());
        let at_eye = points.map(|p| t.eye_from_mesh.transform_point3(p));
        let [a, b, c] = at_eye;
        let face = (b - a).cross(c - a) * f64::from(t.handedness);
        let face_normal = face.normalize_or_zero().as_vec3();
        let normals = if mesh.normals.is_empty() {
            [face_normal; 3]
        } else {
            corners.map(|c| t.normal_from_mesh * mesh.normals[c as usize])
        };
        let mut on_screen = points.map(|p| t.screen_from_mesh * p.extend(1.0));
        if !is_triangle {
            // A third corner beside the line, so that coordinates along it can be found.
            let [a, b, c] = &mut on_screen;
            let along = b.truncate().truncate() * a.w - a.truncate().truncate() * b.w;
            let side = along.perp().normalize_or_zero() * a.w;
            (c.x, c.y) = (a.x + side.x, a.y + side.y);
        }
        let (origin, edges) = edges(on_screen);
        self.cache[slot] = VisibleTriangle {
            item,
            corners,
            positions: at_eye.map(DVec3::as_vec3),
            normals,
            face_normal,
            world_from_mesh: t.world_from_mesh,
            origin,
            edges,
        };
    }
}

impl RunTransform {
    fn new(index: usize, run: &Run, scene: &Scene, view: &View) -> Self {
        let world_from_mesh = scene.instances[run.instance].world_from_mesh;
        let eye_from_world = DMat4::from_translation(-view.camera().eye);
        let linear = glam::DMat3::from_mat4(world_from_mesh);
        let determinant = linear.determinant();
        // The cofactor matrix takes normals along, also where the inverse does not exist.
        let cofactors = glam::DMat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        );
        let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
        let largest = cofactors.to_cols_array().into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let scale = if largest > 0.0 { sign / largest } else { 1.0 };
        Self {
            run: index,
            screen_from_mesh: view.screen_from_world() * world_from_mesh,
            eye_from_mesh: eye_from_world * world_from_mesh,
            normal_from_mesh: (cofactors * scale).as_mat3(),
            world_from_mesh: linear.as_mat3(),
            handedness: sign as f32,
        }
    }
}

/// Edge functions of a triangle in homogeneous screen space, positive inside, that sum up to 1/w;
/// and the pixel from whose centre they are counted.
fn edges(p: [glam::DVec4; 3]) -> ([i32; 2], [[f32; 3]; 3]) {
    // Count from the vertex nearest to the eye's side that has a place on the screen.
    let anchor = p.iter().filter(|p| p.w > 0.0).fold(p[0], |a, b| if b.w > a.w { *b } else { a });
    let pixel = |v: f64| if v.is_finite() { v.floor().clamp(-1e6, 1e6) } else { 0.0 };
    let (ox, oy) = (pixel(anchor.x / anchor.w), pixel(anchor.y / anchor.w));
    let local = p.map(|p| DVec3::new(p.x - (ox + 0.5) * p.w, p.y - (oy + 0.5) * p.w, p.w));
    let [a, b, c] = local;
    let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
    let determinant = a.dot(bc);
    let inverse = if determinant != 0.0 { 1.0 / determinant } else { 0.0 };
    let edge = |e: DVec3| [e.z * inverse, e.x * inverse, e.y * inverse].map(|v| v as f32);
    let edges =
        if determinant == 0.0 { [[1.0, 0.0, 0.0]; 3] } else { [edge(bc), edge(ca), edge(ab)] };
    ([ox as i32, oy as i32], edges)
}
