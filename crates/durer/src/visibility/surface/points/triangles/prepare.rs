//! Making eight primitives of a mesh ready, side by side.

use super::read::{AtCorners, Corners, Read, Vectors, all_widened, at_corners};
use super::{RunTransform, place};
use crate::math::{DMat4, Vec3};
use crate::scene::{Mesh, Topology};
use crate::visibility::surface::gather::{MAGIC, low_bits, narrowed, transpose};
use crate::visibility::surface::points::attributes::VisibleTriangle;
use crate::visibility::surface::points::normal_plane::NormalPlane;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, f64x8, i32x8, mask32x8};
use fearless_simd_macros::simd;

/// Prepares the normals of eight primitives of a mesh; returns whether all are settled.
#[simd]
pub(super) fn prepare_normals<S: Simd>(
    simd: S,
    t: &RunTransform,
    mesh: &Mesh,
    (items, read): (&[u32; 8], &Read),
    kept: &mut [NormalPlane],
) -> bool {
    let normals = normal_planes(simd, t, mesh, read).by_primitive(simd);
    for (lane, &item) in items.iter().enumerate() {
        normals.store(simd, lane, item, &mut kept[place(item, kept)]);
    }
    normals.settled == 0xff
}

/// Returns the normals of eight primitives of a mesh.
#[inline(always)]
pub(super) fn normal_planes<S: Simd>(
    simd: S,
    t: &RunTransform,
    mesh: &Mesh,
    read: &Read,
) -> NormalPlanes<S> {
    let (at, normals) = (all_widened(simd, read), fronts(simd, t, mesh, read));
    OnScreen::new(simd, t, mesh, &at, normals.as_ref()).normal_planes(simd)
}

/// Prepares eight primitives of a mesh to be interpolated, side by side.
#[simd]
pub(super) fn prepare<S: Simd>(
    simd: S,
    t: &RunTransform,
    mesh: &Mesh,
    (items, corners, read): (&[u32; 8], &[[u32; 3]; 8], &Read),
    kept: &mut [VisibleTriangle],
) {
    let (at, normals) = (all_widened(simd, read), fronts(simd, t, mesh, read));
    let on_screen = OnScreen::new(simd, t, mesh, &at, normals.as_ref());
    let planes = on_screen.normal_planes(simd).by_primitive(simd);
    let OnScreen { edges: [constant, dx, dy], sides, .. } = on_screen;
    // Positions of the corners relative to the eye, and face normals turned to the visible side.
    let zero = simd.splat_f64x8(0.0);
    let mut eye = [[zero; 3]; 3];
    for (to, [x, y, z]) in eye.iter_mut().zip(&at) {
        let m = &t.eye_from_mesh;
        *to = [
            *x * m.x_axis.x + *y * m.y_axis.x + *z * m.z_axis.x + m.w_axis.x,
            *x * m.x_axis.y + *y * m.y_axis.y + *z * m.z_axis.y + m.w_axis.y,
            *x * m.x_axis.z + *y * m.y_axis.z + *z * m.z_axis.z + m.w_axis.z,
        ];
    }
    let face = face_normals(simd, &eye, t.handedness);
    let [nx, ny, nz] = seen(face, sides);
    // Edge functions and face normals, item by item.
    let none = simd.splat_f32x8(0.0);
    let ([a, b, c], [d, e, f]) = (constant, dx);
    let first = transpose(simd, [a, b, c, none, d, e, f, none]);
    let [a, b, c] = dy;
    let second = transpose(simd, [a, b, c, none, nx, ny, nz, sides]);
    for (lane, &item) in items.iter().enumerate() {
        let to = &mut kept[place(item, kept)];
        to.corners = corners[lane];
        planes.store(simd, lane, item, &mut to.normals);
        let [a, b, c, d, e, f, g, h]: [f32; 8] = first[lane].into();
        (to.edges[0], to.edges[1]) = ([a, b, c, d], [e, f, g, h]);
        let [a, b, c, d, nx, ny, nz, side]: [f32; 8] = second[lane].into();
        to.edges[2] = [a, b, c, d];
        to.seen_face_normal = Vec3::new(nx, ny, nz);
        to.from_behind = side < 0.0;
    }
    // Normals and positions of the corners.
    for (i, [px, py, pz]) in eye.into_iter().enumerate() {
        let [nx, ny, nz] = seen(normals.as_ref().map_or(face, |n| n[i]), sides);
        let (px, py, pz) = (narrowed(simd, px), narrowed(simd, py), narrowed(simd, pz));
        let rows = transpose(simd, [nx, ny, nz, none, px, py, pz, none]);
        for (&item, row) in items.iter().zip(rows) {
            row.store_slice(&mut kept[place(item, kept)].rows[i]);
        }
    }
}

/// Returns the mesh's normals at the corners, world axes, on the side of the front.
#[inline(always)]
fn fronts<S: Simd>(simd: S, t: &RunTransform, mesh: &Mesh, read: &Read) -> Option<AtCorners<S>> {
    if mesh.normals.is_empty() {
        return None;
    }
    let mut fronts = at_corners(simd, &read.normals);
    for normal in &mut fronts {
        *normal = along_world_axes(t, *normal);
    }
    Some(fronts)
}

/// Returns the normals of a mesh along world axes.
#[inline(always)]
fn along_world_axes<S: Simd>(t: &RunTransform, [x, y, z]: Vectors<S>) -> Vectors<S> {
    let m = &t.normal_from_mesh;
    [
        x * m.x_axis.x + y * m.y_axis.x + z * m.z_axis.x,
        x * m.x_axis.y + y * m.y_axis.y + z * m.z_axis.y,
        x * m.x_axis.z + y * m.y_axis.z + z * m.z_axis.z,
    ]
}

/// Turns normals of fronts to the side that is seen.
#[inline(always)]
fn seen<S: Simd>([x, y, z]: Vectors<S>, sides: f32x8<S>) -> Vectors<S> {
    [x * sides, y * sides, z * sides]
}

/// Eight primitives on the screen.
struct OnScreen<'n, S: Simd> {
    /// The pixels from whose centres edge functions are counted.
    origins: [i32x8<S>; 2],
    /// Edge functions, positive inside, that sum up to the w of the farthest vertex over w: constants and changes
    /// along x and y, by edge.
    edges: [Vectors<S>; 3],
    /// 1 where the front is seen, −1 where the back is.
    sides: f32x8<S>,
    /// Unit normals of the fronts, to single precision, world axes.
    front: Vectors<S>,
    /// Normals of the corners, where the mesh has any.
    normals: Option<&'n [Vectors<S>; 3]>,
    settled: mask32x8<S>,
}

/// The normals of eight primitives as linear functions of the place on the screen, as of [`NormalPlane`].
pub struct NormalPlanes<S: Simd> {
    /// The pixels from whose centres the place is counted.
    pub origins: [i32x8<S>; 2],
    /// Constants and changes along x and y.
    pub planes: [[f32x8<S>; 3]; 3],
    /// Lanes that are [settled](NormalPlane::settled).
    pub settled: mask32x8<S>,
}

/// The same, primitive by primitive.
struct Normals<S: Simd> {
    origins: [[i32; 8]; 2],
    /// Constants and changes along x, by primitive; changes along y.
    rows: [[f32x8<S>; 8]; 2],
    /// Triangles that are [settled](NormalPlane::settled), as bits.
    settled: u64,
}

impl<'n, S: Simd> OnScreen<'n, S> {
    /// Creates primitives from the positions of their corners in the mesh, and the normals there.
    #[inline(always)]
    fn new(
        simd: S,
        t: &RunTransform,
        mesh: &Mesh,
        at: &[Corners<S>; 3],
        normals: Option<&'n [Vectors<S>; 3]>,
    ) -> Self {
        let (zero, one) = (simd.splat_f64x8(0.0), simd.splat_f64x8(1.0));
        let (mut x, mut y, mut w) = ([zero; 3], [zero; 3], [zero; 3]);
        for (i, [px, py, pz]) in at.iter().enumerate() {
            let m: &DMat4 = &t.screen_from_mesh;
            x[i] = *px * m.x_axis.x + *py * m.y_axis.x + *pz * m.z_axis.x + m.w_axis.x;
            y[i] = *px * m.x_axis.y + *py * m.y_axis.y + *pz * m.z_axis.y + m.w_axis.y;
            w[i] = *px * m.x_axis.w + *py * m.y_axis.w + *pz * m.z_axis.w + m.w_axis.w;
        }
        let is_triangle = mesh.topology == Topology::Triangles;
        if !is_triangle {
            (x[2], y[2]) = beside_the_line(simd, &x, &y, &w);
        }
        // Coordinates relative to the farthest vertex, which is on the screen if any vertex is.
        let (mut ax, mut ay, mut aw, mut least_w) = (x[0], y[0], w[0], w[0]);
        for i in 1..3 {
            let farther = simd.simd_gt_f64x8(w[i], zero) & simd.simd_gt_f64x8(w[i], aw);
            ax = simd.select_f64x8(farther, x[i], ax);
            ay = simd.select_f64x8(farther, y[i], ay);
            aw = simd.select_f64x8(farther, w[i], aw);
            least_w = simd.min_f64x8(least_w, w[i]);
        }
        let (ox, oy) = (pixel(simd, ax / aw), pixel(simd, ay / aw));
        let (center_x, center_y) = (ox + 0.5, oy + 0.5);
        let (mut lx, mut ly) = ([zero; 3], [zero; 3]);
        for i in 0..3 {
            lx[i] = x[i] - center_x * w[i];
            ly[i] = y[i] - center_y * w[i];
        }
        // Cross products of the vertex after each with the one before it.
        let (mut cross_x, mut cross_y, mut cross_w) = ([zero; 3], [zero; 3], [zero; 3]);
        for i in 0..3 {
            let (u, v) = ((i + 1) % 3, (i + 2) % 3);
            cross_x[i] = ly[u] * w[v] - ly[v] * w[u];
            cross_y[i] = w[u] * lx[v] - w[v] * lx[u];
            cross_w[i] = lx[u] * ly[v] - lx[v] * ly[u];
        }
        // Edge functions: the inverse of the corners' matrix, scaled by the w of the farthest vertex.
        let determinant = lx[0] * cross_x[0] + ly[0] * cross_y[0] + w[0] * cross_w[0];
        let flat = simd.simd_eq_f64x8(determinant, zero);
        let inverse = aw / determinant;
        let none = simd.splat_f32x8(0.0);
        let mut edges = [[none; 3]; 3];
        for (to, (from, without)) in
            edges.iter_mut().zip([(cross_w, one), (cross_x, zero), (cross_y, zero)])
        {
            for (to, from) in to.iter_mut().zip(from) {
                *to = narrowed(simd, simd.select_f64x8(flat, without, from * inverse));
            }
        }
        // The determinant of triangles seen from the front is negative, because y goes downwards.
        let behind = simd.simd_gt_f64x8(determinant * t.handedness, zero);
        let behind = narrowed(simd, simd.select_f64x8(behind, one, zero));
        let behind = simd.simd_gt_f32x8(behind, none);
        let sides = simd.splat_f32x8(1.0);
        let sides = if is_triangle { simd.select_f32x8(behind, -sides, sides) } else { sides };
        // Settled triangles have gentle edge functions, w in a small range, and normals that agree with the front.
        let (front, settled) = if is_triangle {
            let front = front(simd, t, at);
            let range = narrowed(simd, aw / least_w.max(simd.splat_f64x8(t.least_w)));
            let places =
                gentle(simd, t, &edges) & simd.simd_lt_f32x8(range, simd.splat_f32x8(MOST_RANGE));
            let settled = match normals {
                Some(normals) => places & agreeing(simd, front, normals),
                None => simd.simd_gt_f32x8(dot(front, front), none),
            };
            (front, settled)
        } else {
            ([none; 3], simd.simd_gt_f32x8(none, none))
        };
        let origins = [low_bits(simd, ox + MAGIC), low_bits(simd, oy + MAGIC)];
        Self { origins, edges, sides, front, normals, settled }
    }

    /// Returns the normals as planes.
    #[inline(always)]
    fn normal_planes(&self, simd: S) -> NormalPlanes<S> {
        let none = simd.splat_f32x8(0.0);
        // Without normals at the corners, the normal is the same everywhere.
        let mut planes = [seen(self.front, self.sides), [none; 3], [none; 3]];
        if let Some(normals) = self.normals {
            for (to, edges) in planes.iter_mut().zip(&self.edges) {
                for (axis, to) in to.iter_mut().enumerate() {
                    let [a, b, c] = edges;
                    let [na, nb, nc] = normals;
                    let sum = *a * na[axis] + *b * nb[axis] + *c * nc[axis];
                    *to = sum * self.sides;
                }
            }
        }
        NormalPlanes { origins: self.origins, planes, settled: self.settled }
    }
}

impl<S: Simd> NormalPlanes<S> {
    #[inline(always)]
    fn by_primitive(&self, simd: S) -> Normals<S> {
        let none = simd.splat_f32x8(0.0);
        let [[a, b, c], [d, e, f], [g, h, i]] = self.planes;
        let rows = [
            transpose(simd, [a, b, c, none, d, e, f, none]),
            transpose(simd, [g, h, i, none, none, none, none, none]),
        ];
        let [x, y] = self.origins;
        Normals { origins: [x.into(), y.into()], rows, settled: self.settled.to_bitmask() }
    }
}

impl<S: Simd> Normals<S> {
    /// Stores the values of one primitive at its place.
    #[inline(always)]
    fn store(&self, simd: S, lane: usize, item: u32, to: &mut NormalPlane) {
        let [first, second] = &self.rows;
        let planes = to.planes.as_flattened_mut();
        first[lane].store_slice(&mut planes[..8]);
        simd.split_f32x8(second[lane]).0.store_slice(&mut planes[8..]);
        let [x, y] = &self.origins;
        to.origin = [x[lane], y[lane]];
        (to.item, to.settled) = (item, self.settled >> lane & 1 == 1);
    }
}

/// The w of the farthest vertex of a settled triangle over that of its nearest visible point is less than this.
const MOST_RANGE: f32 = 1e5;

/// Bounds of the squared lengths of a settled triangle's normals.
const LENGTHS2: [f32; 2] = [1e-20, 1e20];

/// Returns the triangles for which the points outside them where samples of their pixels may be have weights of at
/// least −[`LEAST_WEIGHT`](super::LEAST_WEIGHT), with a sum of at least nine tenths.
#[inline(always)]
fn gentle<S: Simd>(simd: S, t: &RunTransform, [_, dx, dy]: &[Vectors<S>; 3]) -> mask32x8<S> {
    let most = simd.splat_f32x8(t.most_change);
    let mut gentle = simd.simd_eq_f32x8(most, most);
    for i in 0..3 {
        let change = simd.abs_f32x8(dx[i]) + simd.abs_f32x8(dy[i]);
        gentle &= simd.simd_le_f32x8(change, most);
    }
    let sum_change = simd.abs_f32x8(dx[0] + dx[1] + dx[2]) + simd.abs_f32x8(dy[0] + dy[1] + dy[2]);
    gentle & simd.simd_le_f32x8(sum_change, most * 0.2)
}

/// Returns the triangles whose normals at the corners have lengths, and are all on the side of a unit normal, by more
/// than seven tenths of the longest: then sums with weights of [`gentle`] triangles are on its side too, by three
/// tenths.
#[inline(always)]
fn agreeing<S: Simd>(simd: S, front: Vectors<S>, &[a, b, c]: &[Vectors<S>; 3]) -> mask32x8<S> {
    let longest = dot(a, a).max(dot(b, b)).max(dot(c, c));
    let [shortest, most] = LENGTHS2;
    let mut agreeing = simd.simd_lt_f32x8(longest, simd.splat_f32x8(most));
    // Tested one by one, because the maximum with a NaN is not specified.
    for normal in [a, b, c] {
        let product = dot(front, normal);
        agreeing &= simd.simd_gt_f32x8(product, simd.splat_f32x8(0.0));
        agreeing &= simd.simd_gt_f32x8(product * product, longest * 0.49);
        agreeing &= simd.simd_gt_f32x8(product * product, simd.splat_f32x8(shortest));
        agreeing &= simd.simd_lt_f32x8(dot(normal, normal), simd.splat_f32x8(most));
    }
    agreeing
}

/// Returns unit normals of the faces' fronts in single precision, world axes; zero if there is
/// none.
#[inline(always)]
fn front<S: Simd>(simd: S, t: &RunTransform, at: &[Corners<S>; 3]) -> Vectors<S> {
    let [x, y, z] = across(at);
    let front = [narrowed(simd, x), narrowed(simd, y), narrowed(simd, z)];
    let [x, y, z] = along_world_axes(t, front);
    let (zero, one) = (simd.splat_f32x8(0.0), simd.splat_f32x8(1.0));
    let inverse = one / simd.sqrt_f32x8(dot([x, y, z], [x, y, z]));
    let finite = simd.simd_le_f32x8(inverse, simd.splat_f32x8(f32::MAX));
    let positive = simd.simd_gt_f32x8(inverse, zero);
    let inverse = simd.select_f32x8(finite & positive, inverse, zero);
    [x * inverse, y * inverse, z * inverse]
}

/// Returns the vector product of two sides.
#[inline(always)]
fn across<S: Simd>([[ax, ay, az], [bx, by, bz], [cx, cy, cz]]: &[Corners<S>; 3]) -> Corners<S> {
    let (ux, uy, uz) = (*bx - *ax, *by - *ay, *bz - *az);
    let (vx, vy, vz) = (*cx - *ax, *cy - *ay, *cz - *az);
    [uy * vz - vy * uz, uz * vx - vz * ux, ux * vy - vx * uy]
}

/// Returns unit normals of the faces' fronts, world axes; zero if there is none.
#[inline(always)]
fn face_normals<S: Simd>(simd: S, eye: &[Corners<S>; 3], handedness: f64) -> Vectors<S> {
    let [x, y, z] = across(eye);
    let inverse = inverse_length(simd, x * x + y * y + z * z) * handedness;
    [narrowed(simd, x * inverse), narrowed(simd, y * inverse), narrowed(simd, z * inverse)]
}

#[inline(always)]
fn dot<S: Simd>([ax, ay, az]: [f32x8<S>; 3], [bx, by, bz]: [f32x8<S>; 3]) -> f32x8<S> {
    ax * bx + ay * by + az * bz
}

/// Returns one over the length, given its square; 0 if there is no direction.
#[inline(always)]
fn inverse_length<S: Simd>(simd: S, length2: f64x8<S>) -> f64x8<S> {
    let zero = simd.splat_f64x8(0.0);
    let inverse = simd.splat_f64x8(1.0) / simd.sqrt_f64x8(length2);
    let finite = simd.simd_le_f64x8(inverse, simd.splat_f64x8(f64::MAX));
    let positive = simd.simd_gt_f64x8(inverse, zero);
    simd.select_f64x8(finite & positive, inverse, zero)
}

/// Returns a third corner beside each line, so that coordinates along it can be found.
#[inline(always)]
fn beside_the_line<S: Simd>(
    simd: S,
    x: &Corners<S>,
    y: &Corners<S>,
    w: &Corners<S>,
) -> (f64x8<S>, f64x8<S>) {
    let (along_x, along_y) = (x[1] * w[0] - x[0] * w[1], y[1] * w[0] - y[0] * w[1]);
    let inverse = inverse_length(simd, along_y * along_y + along_x * along_x);
    (x[0] - along_y * inverse * w[0], y[0] + along_x * inverse * w[0])
}

/// Returns the pixel that holds a coordinate.
#[inline(always)]
fn pixel<S: Simd>(simd: S, v: f64x8<S>) -> f64x8<S> {
    let (zero, most) = (simd.splat_f64x8(0.0), simd.splat_f64x8(1e6));
    let finite = simd.simd_le_f64x8(simd.abs_f64x8(v), simd.splat_f64x8(f64::MAX));
    let v = simd.floor_f64x8(simd.select_f64x8(finite, v, zero));
    simd.min_f64x8(simd.max_f64x8(v, zero - most), most)
}
