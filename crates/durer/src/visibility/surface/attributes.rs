//! From a visible item back to its triangle, and from a pixel to a point on it.
//!
//! Perspective-correct coordinates come from the edge functions in homogeneous screen space
//! (M. Olano, T. Greer, *Triangle scan conversion using 2D homogeneous coordinates*, 1997), so
//! triangles that were cut at the near plane need no special care.

use crate::math::{DMat4, DVec2, DVec3, Mat3, Vec3, Vec4};
use crate::scene::{Mesh, Scene, Topology};
use crate::simd::Level;
use crate::target::NO_ITEM;
use crate::view::View;
use crate::visibility::surface::setup::Run;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, dispatch, f32x4, f32x8, f64x4};
use fearless_simd_macros::simd;

/// What all triangles of a run share.
#[derive(Debug, Clone, Copy)]
struct RunTransform {
    run: usize,
    screen_from_mesh: DMat4,
    eye_from_mesh: DMat4,
    normal_from_mesh: Mat3,
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
    /// Of each vertex its position, x to z, and its normal, in one row to be blended in one go.
    rows: [Row; 3],
    /// Unit normal of the face's front, world axes.
    pub face_normal: Vec3,
    /// The pixel from whose centre x and y are counted.
    origin: [i32; 2],
    /// Edge function i at (x, y) is `edges[0][i] + (edges[1][i]·x + edges[2][i]·y)`; the fourth is not used.
    edges: [[f32; 4]; 3],
}

/// A point of a triangle: position relative to the eye and normal, world axes, and two zeros.
pub type Row = [f32; 8];

impl Default for VisibleTriangle {
    /// No triangle.
    fn default() -> Self {
        Self {
            item: NO_ITEM,
            corners: [0; 3],
            rows: [[0.0; 8]; 3],
            face_normal: Vec3::ZERO,
            origin: [0; 2],
            edges: [[0.0; 4]; 3],
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
    /// Of the vertices; world axes, relative to the eye.
    #[inline(always)]
    pub fn positions(&self) -> [Vec3; 3] {
        self.rows.map(|[x, y, z, ..]| Vec3::new(x, y, z))
    }

    /// Of the vertices; world axes, not of unit length; all three the face normal where the mesh has
    /// none.
    #[inline(always)]
    pub fn normals(&self) -> [Vec3; 3] {
        self.rows.map(|[_, _, _, x, y, z, ..]| Vec3::new(x, y, z))
    }

    /// Edge functions at a point counted from the origin, in this order of operations.
    #[inline(always)]
    fn edges_at(&self, x: f32, y: f32) -> Weights {
        let [constant, dx, dy] = &self.edges;
        [0, 1, 2].map(|i| constant[i] + (dx[i] * x + dy[i] * y))
    }

    /// The edge functions, by constant and changes along x and y, and where a pixel's centre lies for
    /// them: what [`Self::weights`] and [`Self::weights_beside`] start from.
    #[inline(always)]
    pub fn edge_functions(&self, x: i32, y: i32) -> (&[[f32; 4]; 3], [f32; 2]) {
        (&self.edges, [(x - self.origin[0]) as f32, (y - self.origin[1]) as f32])
    }

    /// Perspective-correct barycentric coordinates at a pixel's centre moved by `shift` pixels; kept
    /// within the triangle where the point lies outside, as it may at edges.
    #[inline(always)]
    pub fn weights(&self, x: i32, y: i32, shift: [f32; 2]) -> Weights {
        let fx = (x - self.origin[0]) as f32 + shift[0];
        let fy = (y - self.origin[1]) as f32 + shift[1];
        let [a, b, c] = self.edges_at(fx, fy).map(|e| e.max(0.0));
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        [a * inverse, b * inverse, c * inverse]
    }

    /// Coordinates at the centres of the pixels to the right and below, also outside the triangle.
    pub fn weights_beside(&self, x: i32, y: i32) -> (Weights, Weights) {
        let at = |x: i32, y: i32| {
            let (fx, fy) = ((x - self.origin[0]) as f32, (y - self.origin[1]) as f32);
            let [a, b, c] = self.edges_at(fx, fy);
            let sum = a + b + c;
            // Beyond the horizon there is no such point: the derivative is that of the border.
            if sum > 0.0 { Some([a / sum, b / sum, c / sum]) } else { None }
        };
        let here = || self.weights(x, y, [0.0; 2]);
        (at(x + 1, y).unwrap_or_else(here), at(x, y + 1).unwrap_or_else(here))
    }

    /// The interpolated tangent, mesh axes, where the mesh has tangents.
    pub fn tangent(&self, mesh: &Mesh, w: Weights) -> Option<Vec4> {
        let [a, b, c] = match mesh.tangents.as_slice() {
            [] => return None,
            tangents => self.corners.map(|c| tangents[c as usize]),
        };
        let tangent = a * w[0] + b * w[1] + c * w[2];
        Some(tangent.truncate().extend(a.w))
    }

    /// [`Self::weights`] of eight pixels in a row, without shift.
    #[inline(always)]
    pub fn weights_x8<S: Simd>(&self, simd: S, x: i32, y: i32) -> [f32x8<S>; 3] {
        let lanes = f32x8::from_slice(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let zero = f32x8::splat(simd, 0.0);
        let fx = lanes + (x - self.origin[0]) as f32;
        let fy = (y - self.origin[1]) as f32;
        let [constant, dx, dy] = &self.edges;
        let a = (fx * dx[0] + dy[0] * fy + constant[0]).max(zero);
        let b = (fx * dx[1] + dy[1] * fy + constant[1]).max(zero);
        let c = (fx * dx[2] + dy[2] * fy + constant[2]).max(zero);
        let sum = (a + b + c).max(f32x8::splat(simd, f32::MIN_POSITIVE));
        let inverse = f32x8::splat(simd, 1.0) / sum;
        [a * inverse, b * inverse, c * inverse]
    }

    /// Position and normal at eight pixels in a row, component by component.
    #[inline(always)]
    pub fn points_x8<S: Simd>(&self, simd: S, x: i32, y: i32) -> [f32x8<S>; 6] {
        let w = self.weights_x8(simd, x, y);
        let [a, b, c] = &self.rows;
        let mut points = [w[0]; 6];
        for (i, to) in points.iter_mut().enumerate() {
            *to = w[0] * a[i] + w[1] * b[i] + w[2] * c[i];
        }
        points
    }

    /// Position and normal at one pixel, bit for bit what [`Self::points_x8`] gives.
    #[inline(always)]
    pub fn point<S: Simd>(&self, simd: S, x: i32, y: i32) -> f32x8<S> {
        let (fx, fy) = ((x - self.origin[0]) as f32, (y - self.origin[1]) as f32);
        let [constant, dx, dy] = &self.edges;
        let (dx, dy) = (f32x4::from_slice(simd, dx), f32x4::from_slice(simd, dy));
        let edges = dx * fx + dy * fy + f32x4::from_slice(simd, constant);
        let edges = edges.max(f32x4::splat(simd, 0.0));
        let [a, b, c, _]: [f32; 4] = edges.into();
        let inverse = 1.0 / (a + b + c).max(f32::MIN_POSITIVE);
        let [row_a, row_b, row_c] = &self.rows;
        let row_a = f32x8::from_slice(simd, row_a) * (a * inverse);
        let row_b = f32x8::from_slice(simd, row_b) * (b * inverse);
        let row_c = f32x8::from_slice(simd, row_c) * (c * inverse);
        row_a + row_b + row_c
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

/// Finds visible triangles by item; keeps the latest ones, for neighbours share them.
pub struct Triangles<'a> {
    scene: &'a Scene,
    view: &'a View,
    runs: &'a [Run],
    level: Level,
    transform: Option<RunTransform>,
    cache: Box<[VisibleTriangle; CACHE]>,
}

/// Triangles kept: a power of two; about 256 kB, as many as a row of a fine mesh shows.
const CACHE: usize = 1024;

impl<'a> Triangles<'a> {
    pub fn new(scene: &'a Scene, view: &'a View, runs: &'a [Run], level: Level) -> Self {
        let cache = Box::new([VisibleTriangle::default(); CACHE]);
        Self { scene, view, runs, level, transform: None, cache }
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

    #[inline(never)]
    fn prepare(&mut self, item: u32, run_index: usize, slot: usize) {
        let run = &self.runs[run_index];
        let mesh = &self.scene.meshes[run.mesh];
        if self.transform.as_ref().is_none_or(|t| t.run != run_index) {
            self.transform = Some(RunTransform::new(run_index, run, self.scene, self.view));
        }
        let Some(t) = &self.transform else { return };
        let primitive = (run.range.start + (item - run.first_item)) as usize;
        let to = &mut self.cache[slot];
        to.item = item;
        dispatch!(self.level, simd => prepare(simd, t, mesh, primitive, to));
    }
}

/// Makes a primitive of a mesh ready to be interpolated, its three vertices side by side.
#[simd]
fn prepare<S: Simd>(
    simd: S,
    t: &RunTransform,
    mesh: &Mesh,
    primitive: usize,
    to: &mut VisibleTriangle,
) {
    let is_triangle = mesh.topology == Topology::Triangles;
    let corners = if is_triangle {
        mesh.triangle(primitive)
    } else {
        let [a, b] = mesh.line_or_point(primitive);
        [a, b, a]
    };
    let [a, b, c] = corners;
    let p = [mesh.positions[a as usize], mesh.positions[b as usize], mesh.positions[c as usize]];
    let px = lanes(simd, [p[0].x.into(), p[1].x.into(), p[2].x.into()]);
    let py = lanes(simd, [p[0].y.into(), p[1].y.into(), p[2].y.into()]);
    let pz = lanes(simd, [p[0].z.into(), p[1].z.into(), p[2].z.into()]);
    let m = &t.eye_from_mesh;
    let ex: [f64; 4] = (px * m.x_axis.x + py * m.y_axis.x + pz * m.z_axis.x + m.w_axis.x).into();
    let ey: [f64; 4] = (px * m.x_axis.y + py * m.y_axis.y + pz * m.z_axis.y + m.w_axis.y).into();
    let ez: [f64; 4] = (px * m.x_axis.z + py * m.y_axis.z + pz * m.z_axis.z + m.w_axis.z).into();
    let (a, b, c) = (
        DVec3::new(ex[0], ey[0], ez[0]),
        DVec3::new(ex[1], ey[1], ez[1]),
        DVec3::new(ex[2], ey[2], ez[2]),
    );
    let face = (b - a).cross(c - a) * f64::from(t.handedness);
    to.face_normal = face.normalize_or_zero().as_vec3();
    let mut normals = [to.face_normal; 3];
    if !mesh.normals.is_empty() {
        for (normal, corner) in normals.iter_mut().zip(corners) {
            *normal = t.normal_from_mesh * mesh.normals[corner as usize];
        }
    }
    for ((row, p), n) in to.rows.iter_mut().zip([a, b, c]).zip(normals) {
        *row = [p.x as f32, p.y as f32, p.z as f32, n.x, n.y, n.z, 0.0, 0.0];
    }
    to.corners = corners;

    let m = &t.screen_from_mesh;
    let sx = px * m.x_axis.x + py * m.y_axis.x + pz * m.z_axis.x + m.w_axis.x;
    let sy = px * m.x_axis.y + py * m.y_axis.y + pz * m.z_axis.y + m.w_axis.y;
    let sw = px * m.x_axis.w + py * m.y_axis.w + pz * m.z_axis.w + m.w_axis.w;
    let (mut x, mut y, w): ([f64; 4], [f64; 4], [f64; 4]) = (sx.into(), sy.into(), sw.into());
    if !is_triangle {
        // A third corner beside the line, so that coordinates along it can be found.
        let along = DVec2::new(x[1], y[1]) * w[0] - DVec2::new(x[0], y[0]) * w[1];
        let side = along.perp().normalize_or_zero() * w[0];
        (x[2], y[2]) = (x[0] + side.x, y[0] + side.y);
    }
    edges(simd, [x[0], x[1], x[2]], [y[0], y[1], y[2]], [w[0], w[1], w[2]], to);
}

/// Three numbers, and the first again.
#[inline(always)]
fn lanes<S: Simd>(simd: S, [a, b, c]: [f64; 3]) -> f64x4<S> {
    f64x4::simd_from(simd, [a, b, c, a])
}

/// Edge functions of a triangle in homogeneous screen space, positive inside, that sum up to 1/w;
/// and the pixel from whose centre they are counted.
#[inline(always)]
fn edges<S: Simd>(simd: S, x: [f64; 3], y: [f64; 3], w: [f64; 3], to: &mut VisibleTriangle) {
    // Count from the vertex nearest to the eye's side that has a place on the screen.
    let mut anchor = 0;
    for i in 0..3 {
        if w[i] > 0.0 && w[i] > w[anchor] {
            anchor = i;
        }
    }
    let (ox, oy) = (pixel(x[anchor] / w[anchor]), pixel(y[anchor] / w[anchor]));
    to.origin = [ox as i32, oy as i32];
    let (lx, ly) = (
        [x[0] - (ox + 0.5) * w[0], x[1] - (ox + 0.5) * w[1], x[2] - (ox + 0.5) * w[2]],
        [y[0] - (oy + 0.5) * w[0], y[1] - (oy + 0.5) * w[1], y[2] - (oy + 0.5) * w[2]],
    );
    // The cross products of the vertices after each and before it.
    let (ux, vx) = (lanes(simd, [lx[1], lx[2], lx[0]]), lanes(simd, [lx[2], lx[0], lx[1]]));
    let (uy, vy) = (lanes(simd, [ly[1], ly[2], ly[0]]), lanes(simd, [ly[2], ly[0], ly[1]]));
    let (uw, vw) = (lanes(simd, [w[1], w[2], w[0]]), lanes(simd, [w[2], w[0], w[1]]));
    let cross_x = uy * vw - vy * uw;
    let cross_y = uw * vx - vw * ux;
    let cross_w = ux * vy - vx * uy;
    let (first_x, first_y, first_w): ([f64; 4], [f64; 4], [f64; 4]) =
        (cross_x.into(), cross_y.into(), cross_w.into());
    let determinant = lx[0] * first_x[0] + ly[0] * first_y[0] + w[0] * first_w[0];
    if determinant == 0.0 {
        to.edges = [[1.0; 4], [0.0; 4], [0.0; 4]];
        return;
    }
    let inverse = 1.0 / determinant;
    let functions = [cross_w * inverse, cross_x * inverse, cross_y * inverse];
    for (to, function) in to.edges.iter_mut().zip(functions) {
        let function: [f64; 4] = function.into();
        for (to, from) in to.iter_mut().zip(function) {
            *to = from as f32;
        }
    }
}

/// The pixel that holds a coordinate.
#[inline(always)]
fn pixel(v: f64) -> f64 {
    if v.is_finite() { v.floor().clamp(-1e6, 1e6) } else { 0.0 }
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
            handedness: sign as f32,
        }
    }
}
