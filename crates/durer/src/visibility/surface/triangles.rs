//! Visible triangles by item: made ready to be interpolated eight at a time, the latest ones kept, for
//! neighbours share them.

use crate::math::{DMat3, DMat4, Mat3, Vec3};
use crate::scene::{Mesh, Projection, Scene, Topology};
use crate::simd::Level;
use crate::view::View;
use crate::visibility::surface::attributes::VisibleTriangle;
use crate::visibility::surface::gather::{narrowed, transpose, widened};
use crate::visibility::surface::setup::Run;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, dispatch, f32x8, f64x8, mask32x8};
use fearless_simd_macros::simd;

/// What all triangles of a run share.
#[derive(Debug, Clone, Copy)]
struct RunTransform {
    run: usize,
    screen_from_mesh: DMat4,
    eye_from_mesh: DMat4,
    normal_from_mesh: Mat3,
    /// −1 where the instance mirrors, so that fronts stay fronts.
    handedness: f64,
    /// Towards the eye where projection lines are parallel, world axes.
    parallel_view: Option<Vec3>,
}

/// Finds visible triangles by item; keeps the latest ones.
pub struct Triangles<'a> {
    scene: &'a Scene,
    view: &'a View,
    runs: &'a [Run],
    level: Level,
    transform: Option<RunTransform>,
    /// A power of two.
    kept: Box<[VisibleTriangle]>,
    wanted: Wanted,
}

/// How many triangles are kept for pictures made tile by tile: about 200 kB, as many as a tile of a fine mesh
/// shows.
pub const OF_TILES: usize = 1 << 10;

/// How many are kept for pictures made row by row, about 800 kB: a row shows more than a tile, and most of them
/// again in the next.
pub const OF_ROWS: usize = 1 << 12;

/// Items of one run that are to be made ready; their places are already theirs.
#[derive(Debug, Clone, Copy, Default)]
struct Wanted {
    items: [u32; 8],
    /// Their vertices in the mesh: read when they are wanted, for where they lie is asked for soon after, and
    /// neither is in the cache.
    corners: [[u32; 3]; 8],
    count: usize,
    run: usize,
}

impl<'a> Triangles<'a> {
    /// Keeps as many as `kept`, a power of two.
    pub fn new(
        scene: &'a Scene,
        view: &'a View,
        runs: &'a [Run],
        level: Level,
        kept: usize,
    ) -> Self {
        let kept = vec![VisibleTriangle::default(); kept].into_boxed_slice();
        Self { scene, view, runs, level, transform: None, kept, wanted: Wanted::default() }
    }

    /// The triangle of an item that the rasterizer has drawn.
    #[inline(always)]
    pub fn get(&mut self, item: u32, run: usize) -> &VisibleTriangle {
        if !self.has(item) {
            self.want(item, run);
            self.make_ready();
        }
        &self.kept[place(item, &self.kept)]
    }

    /// Whether an item is kept or wanted.
    #[inline(always)]
    pub fn has(&self, item: u32) -> bool {
        self.kept[place(item, &self.kept)].item == item
    }

    /// Has an item made ready, at the latest by [`Self::make_ready`], which comes before [`Self::get`].
    #[inline(never)]
    pub fn want(&mut self, item: u32, run: usize) {
        if self.wanted.count == self.wanted.items.len() || self.wanted.run != run {
            self.make_ready();
        }
        self.wanted.run = run;
        self.wanted.items[self.wanted.count] = item;
        self.wanted.corners[self.wanted.count] = self.corners(item, run);
        self.wanted.count += 1;
        let place = place(item, &self.kept);
        self.kept[place].item = item;
    }

    /// The vertices of an item in its mesh; of a line its ends and the first again.
    fn corners(&self, item: u32, run: usize) -> [u32; 3] {
        let run = &self.runs[run];
        let mesh = &self.scene.meshes[run.mesh];
        let primitive = (run.range.start + (item - run.first_item)) as usize;
        if mesh.topology == Topology::Triangles {
            return mesh.triangle(primitive);
        }
        let [a, b] = mesh.line_or_point(primitive);
        [a, b, a]
    }

    /// Makes all items ready that are wanted.
    pub fn make_ready(&mut self) {
        let Wanted { mut items, mut corners, count, run: index } = self.wanted;
        if count == 0 {
            return;
        }
        self.wanted.count = 0;
        for i in count..8 {
            (items[i], corners[i]) = (items[0], corners[0]);
        }
        let mesh = &self.scene.meshes[self.runs[index].mesh];
        if self.transform.as_ref().is_none_or(|t| t.run != index) {
            self.transform =
                Some(RunTransform::new(index, &self.runs[index], self.scene, self.view));
        }
        let Some(t) = &self.transform else { return };
        let kept = &mut *self.kept;
        dispatch!(self.level, simd => prepare(simd, t, mesh, (&items, &corners), kept));
    }
}

/// Towards the eye where projection lines are parallel, world axes.
pub fn parallel_view(view: &View) -> Option<Vec3> {
    let camera = view.camera();
    match camera.projection {
        Projection::Perspective { .. } => None,
        Projection::Orthographic { .. } => Some(camera.axes()[2].as_vec3()),
    }
}

#[inline(always)]
fn place(item: u32, kept: &[VisibleTriangle]) -> usize {
    item as usize & (kept.len() - 1)
}

/// Numbers of three corners of eight triangles, by corner.
type Corners<S> = [f64x8<S>; 3];

/// Makes eight primitives of a mesh ready to be interpolated, side by side.
#[simd]
fn prepare<S: Simd>(
    simd: S,
    t: &RunTransform,
    mesh: &Mesh,
    (items, corners): (&[u32; 8], &[[u32; 3]; 8]),
    kept: &mut [VisibleTriangle],
) {
    let is_triangle = mesh.topology == Topology::Triangles;
    // By corner and axis; all that is read first, for it has to be waited for.
    let (mut at, mut vertex_normals) = ([[[0.0; 8]; 3]; 3], [[[0.0; 8]; 3]; 3]);
    for (lane, corners) in corners.iter().enumerate() {
        for (i, &corner) in corners.iter().enumerate() {
            let p = mesh.positions[corner as usize];
            (at[i][0][lane], at[i][1][lane], at[i][2][lane]) = (p.x, p.y, p.z);
        }
        if !mesh.normals.is_empty() {
            for (to, &corner) in vertex_normals.iter_mut().zip(corners) {
                let n = mesh.normals[corner as usize];
                (to[0][lane], to[1][lane], to[2][lane]) = (n.x, n.y, n.z);
            }
        }
    }
    let zero = simd.splat_f64x8(0.0);
    let mut eye = [[zero; 3]; 3];
    let (mut x, mut y, mut w) = ([zero; 3], [zero; 3], [zero; 3]);
    for (i, [px, py, pz]) in at.iter().enumerate() {
        let (px, py) = (f32x8::from_slice(simd, px), f32x8::from_slice(simd, py));
        let (px, py) = (widened(simd, px), widened(simd, py));
        let pz = widened(simd, f32x8::from_slice(simd, pz));
        let m = &t.eye_from_mesh;
        eye[i] = [
            px * m.x_axis.x + py * m.y_axis.x + pz * m.z_axis.x + m.w_axis.x,
            px * m.x_axis.y + py * m.y_axis.y + pz * m.z_axis.y + m.w_axis.y,
            px * m.x_axis.z + py * m.y_axis.z + pz * m.z_axis.z + m.w_axis.z,
        ];
        let m = &t.screen_from_mesh;
        x[i] = px * m.x_axis.x + py * m.y_axis.x + pz * m.z_axis.x + m.w_axis.x;
        y[i] = px * m.x_axis.y + py * m.y_axis.y + pz * m.z_axis.y + m.w_axis.y;
        w[i] = px * m.x_axis.w + py * m.y_axis.w + pz * m.z_axis.w + m.w_axis.w;
    }
    let (face, sides) = face_normals(simd, &eye, t);
    if !is_triangle {
        (x[2], y[2]) = beside_the_line(simd, &x, &y, &w);
    }
    let (origins, edges) = edges(simd, &x, &y, &w);
    store(simd, items, corners, &origins, &edges, (&face, sides), kept);

    let m = &t.normal_from_mesh;
    let (none, one) = (simd.splat_f32x8(0.0), simd.splat_f32x8(1.0));
    let mut normals = [face; 3];
    for (i, [px, py, pz]) in eye.into_iter().enumerate() {
        if !mesh.normals.is_empty() {
            let [nx, ny, nz] = &vertex_normals[i];
            let (nx, ny) = (f32x8::from_slice(simd, nx), f32x8::from_slice(simd, ny));
            let nz = f32x8::from_slice(simd, nz);
            normals[i] = [
                nx * m.x_axis.x + ny * m.y_axis.x + nz * m.z_axis.x,
                nx * m.x_axis.y + ny * m.y_axis.y + nz * m.z_axis.y,
                nx * m.x_axis.z + ny * m.y_axis.z + nz * m.z_axis.z,
            ];
        }
        let [nx, ny, nz] = normals[i];
        let (nx, ny, nz) = (nx * sides, ny * sides, nz * sides);
        let (px, py, pz) = (narrowed(simd, px), narrowed(simd, py), narrowed(simd, pz));
        let rows = transpose(simd, [nx, ny, nz, one, px, py, pz, none]);
        for (&item, row) in items.iter().zip(rows) {
            row.store_slice(&mut kept[place(item, kept)].rows[i]);
        }
    }
    let settled = settled(simd, face, &normals);
    for (lane, &item) in items.iter().enumerate() {
        kept[place(item, kept)].settled = settled >> lane & 1 == 1;
    }
}

/// Of the cosine of a settled triangle's normals to its front, the least square.
const LEAST_COSINE2: f32 = 1e-6;

/// Between these are the squared lengths of a settled triangle's normals.
const LENGTHS2: [f32; 2] = [1e-20, 1e20];

/// Which of eight triangles are [settled](VisibleTriangle::settled), as bits; normals by corner.
#[inline(always)]
fn settled<S: Simd>(simd: S, face: [f32x8<S>; 3], normals: &[[f32x8<S>; 3]; 3]) -> u64 {
    // A weighted sum of vectors that make at most an angle with another one does that too.
    let mut all = simd.simd_eq_f32x8(face[0], face[0]);
    for &normal in normals {
        all &= within(simd, dot(face, normal), dot(normal, normal));
    }
    all.to_bitmask()
}

/// Whether vectors have a length, and a product with a unit vector that is well above 0.
#[inline(always)]
fn within<S: Simd>(simd: S, product: f32x8<S>, length2: f32x8<S>) -> mask32x8<S> {
    let [least, most] = LENGTHS2;
    let positive = simd.simd_gt_f32x8(product, simd.splat_f32x8(0.0));
    let wide = simd.simd_gt_f32x8(product * product, length2 * LEAST_COSINE2);
    let long = simd.simd_gt_f32x8(length2, simd.splat_f32x8(least));
    positive & wide & long & simd.simd_lt_f32x8(length2, simd.splat_f32x8(most))
}

#[inline(always)]
fn dot<S: Simd>([ax, ay, az]: [f32x8<S>; 3], [bx, by, bz]: [f32x8<S>; 3]) -> f32x8<S> {
    ax * bx + ay * by + az * bz
}

/// One over the length, of which the square is given; 0 where there is no direction.
#[inline(always)]
fn inverse_length<S: Simd>(simd: S, length2: f64x8<S>) -> f64x8<S> {
    let zero = simd.splat_f64x8(0.0);
    let inverse = simd.splat_f64x8(1.0) / simd.sqrt_f64x8(length2);
    let finite = simd.simd_le_f64x8(inverse, simd.splat_f64x8(f64::MAX));
    let positive = simd.simd_gt_f64x8(inverse, zero);
    simd.select_f64x8(finite & positive, inverse, zero)
}

/// Unit normals of the faces' fronts, world axes; and 1 where the front is seen, −1 where the back is.
#[inline(always)]
fn face_normals<S: Simd>(
    simd: S,
    [[ax, ay, az], [bx, by, bz], [cx, cy, cz]]: &[[f64x8<S>; 3]; 3],
    t: &RunTransform,
) -> ([f32x8<S>; 3], f32x8<S>) {
    let handedness = t.handedness;
    let (ux, uy, uz) = (*bx - *ax, *by - *ay, *bz - *az);
    let (vx, vy, vz) = (*cx - *ax, *cy - *ay, *cz - *az);
    let x = (uy * vz - vy * uz) * handedness;
    let y = (uz * vx - vz * ux) * handedness;
    let z = (ux * vy - vx * uy) * handedness;
    // Between the normal and the way from the eye.
    let product = match t.parallel_view.map(Vec3::as_dvec3) {
        Some(v) => -(x * v.x + y * v.y + z * v.z),
        None => x * *ax + y * *ay + z * *az,
    };
    let one = simd.splat_f64x8(1.0);
    let behind = simd.simd_gt_f64x8(product, simd.splat_f64x8(0.0));
    let sides = narrowed(simd, simd.select_f64x8(behind, -one, one));
    let inverse = inverse_length(simd, x * x + y * y + z * z);
    let normal =
        [narrowed(simd, x * inverse), narrowed(simd, y * inverse), narrowed(simd, z * inverse)];
    (normal, sides)
}

/// A third corner beside each line, so that coordinates along it can be found.
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

/// Edge functions of triangles in homogeneous screen space, positive inside, that sum up to the w of the farthest
/// vertex over w: constants and changes along x and y, by edge; and the pixels from whose centres they are counted.
#[inline(always)]
fn edges<S: Simd>(
    simd: S,
    x: &Corners<S>,
    y: &Corners<S>,
    w: &Corners<S>,
) -> ([[f64; 8]; 2], [[f32x8<S>; 3]; 3]) {
    let (zero, one) = (simd.splat_f64x8(0.0), simd.splat_f64x8(1.0));
    // Count from the farthest vertex, which has a place on the screen if any has.
    let (mut ax, mut ay, mut aw) = (x[0], y[0], w[0]);
    for i in 1..3 {
        let farther = simd.simd_gt_f64x8(w[i], zero) & simd.simd_gt_f64x8(w[i], aw);
        ax = simd.select_f64x8(farther, x[i], ax);
        ay = simd.select_f64x8(farther, y[i], ay);
        aw = simd.select_f64x8(farther, w[i], aw);
    }
    let (ox, oy) = (pixel(simd, ax / aw), pixel(simd, ay / aw));
    let (center_x, center_y) = (ox + 0.5, oy + 0.5);
    let (mut lx, mut ly) = ([zero; 3], [zero; 3]);
    for i in 0..3 {
        lx[i] = x[i] - center_x * w[i];
        ly[i] = y[i] - center_y * w[i];
    }
    // The cross products of the vertices after each and before it.
    let (mut cross_x, mut cross_y, mut cross_w) = ([zero; 3], [zero; 3], [zero; 3]);
    for i in 0..3 {
        let (u, v) = ((i + 1) % 3, (i + 2) % 3);
        cross_x[i] = ly[u] * w[v] - ly[v] * w[u];
        cross_y[i] = w[u] * lx[v] - w[v] * lx[u];
        cross_w[i] = lx[u] * ly[v] - lx[v] * ly[u];
    }
    let determinant = lx[0] * cross_x[0] + ly[0] * cross_y[0] + w[0] * cross_w[0];
    let flat = simd.simd_eq_f64x8(determinant, zero);
    let inverse = aw / determinant;
    let mut edges = [[simd.splat_f32x8(0.0); 3]; 3];
    for (to, (from, without)) in
        edges.iter_mut().zip([(cross_w, one), (cross_x, zero), (cross_y, zero)])
    {
        for (to, from) in to.iter_mut().zip(from) {
            *to = narrowed(simd, simd.select_f64x8(flat, without, from * inverse));
        }
    }
    ([ox.into(), oy.into()], edges)
}

/// The pixel that holds a coordinate.
#[inline(always)]
fn pixel<S: Simd>(simd: S, v: f64x8<S>) -> f64x8<S> {
    let (zero, most) = (simd.splat_f64x8(0.0), simd.splat_f64x8(1e6));
    let finite = simd.simd_le_f64x8(simd.abs_f64x8(v), simd.splat_f64x8(f64::MAX));
    let v = simd.floor_f64x8(simd.select_f64x8(finite, v, zero));
    simd.min_f64x8(simd.max_f64x8(v, zero - most), most)
}

/// Everything of the triangles but positions and normals, to their places.
#[inline(always)]
fn store<S: Simd>(
    simd: S,
    items: &[u32; 8],
    corners: &[[u32; 3]; 8],
    [x, y]: &[[f64; 8]; 2],
    [constant, dx, dy]: &[[f32x8<S>; 3]; 3],
    (&[nx, ny, nz], sides): (&[f32x8<S>; 3], f32x8<S>),
    kept: &mut [VisibleTriangle],
) {
    let none = simd.splat_f32x8(0.0);
    let ([a, b, c], [d, e, f]) = (*constant, *dx);
    let first = transpose(simd, [a, b, c, none, d, e, f, none]);
    let ([a, b, c], n) = (*dy, [nx * sides, ny * sides, nz * sides]);
    let second = transpose(simd, [a, b, c, none, n[0], n[1], n[2], sides]);
    for (lane, &item) in items.iter().enumerate() {
        let to = &mut kept[place(item, kept)];
        (to.item, to.corners) = (item, corners[lane]);
        to.origin = [x[lane] as i32, y[lane] as i32];
        let [a, b, c, d, e, f, g, h]: [f32; 8] = first[lane].into();
        (to.edges[0], to.edges[1]) = ([a, b, c, d], [e, f, g, h]);
        let [a, b, c, d, nx, ny, nz, side]: [f32; 8] = second[lane].into();
        to.edges[2] = [a, b, c, d];
        to.seen_face_normal = Vec3::new(nx, ny, nz);
        to.from_behind = side < 0.0;
    }
}

impl RunTransform {
    fn new(index: usize, run: &Run, scene: &Scene, view: &View) -> Self {
        let world_from_mesh = scene.instances[run.instance].world_from_mesh;
        let eye_from_world = DMat4::from_translation(-view.camera().eye);
        let linear = DMat3::from_mat4(world_from_mesh);
        let determinant = linear.determinant();
        // The cofactor matrix takes normals along, also where the inverse does not exist.
        let cofactors = DMat3::from_cols(
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
            handedness: sign,
            parallel_view: parallel_view(view),
        }
    }
}
