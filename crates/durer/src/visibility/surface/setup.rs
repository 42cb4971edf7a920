//! From a scene to triangles on the screen: what every image-space algorithm starts from.
//!
//! Vertices are taken to homogeneous screen space in f64, triangles are cut at the near plane and at
//! the guard band only (the rasterizer does the rest), and snapped to the 24.8 grid. All algorithms
//! take their triangles and depths from here, so their pictures agree bit for bit.
//!
//! Source: near-plane-only clipping after Blinn & Newell, *Clipping using homogeneous coordinates*
//! (1978); the guard band as in graphics hardware. Cost: O(vertices + triangles).

use crate::clip::volume::{self, Borders, ClipVertex, clip_polygon, clip_segment};
use crate::math::{DMat4, DVec2, Vec3};
use crate::raster::fixed::{GUARD_BAND, HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS, first_center, snap};
use crate::raster::triangle::SnappedTriangle;
use crate::scene::{AlphaMode, Mesh, Scene, Topology};
use crate::simd::Level;
use crate::trace::NoTrace;
use crate::view::View;
use crate::visibility::surface::Cull;
use fearless_simd::prelude::*;
use fearless_simd::{dispatch, f64x4};
use fearless_simd_macros::simd;
use std::ops::Range;

/// A triangle on the screen: snapped vertices and the plane of its depth.
///
/// # Guarantees
/// Twice the area in grid units is above 0 in the order of the vertices (clockwise on the screen,
/// whatever way the face is turned), all numbers are finite, coordinates lie in the guard band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenTriangle {
    /// x of the vertices, 24.8 fixed point, pixels.
    pub x: [i32; 3],
    /// y of the vertices, 24.8 fixed point, pixels, downwards.
    pub y: [i32; 3],
    /// Depth at the centre of the pixel that holds vertex 0.
    pub depth: f32,
    /// Change of depth per pixel to the right.
    pub depth_dx: f32,
    /// Change of depth per pixel downwards.
    pub depth_dy: f32,
    /// Smallest depth of a vertex, at least 0.
    pub depth_min: f32,
    /// Largest depth of a vertex.
    pub depth_max: f32,
    /// Item index: the place of the triangle in the scene.
    pub item: u32,
}

impl ScreenTriangle {
    /// The pixel that holds vertex 0; depths are counted from its centre.
    #[inline]
    pub fn origin(&self) -> [i32; 2] {
        [self.x[0] >> SUBPIXEL_BITS, self.y[0] >> SUBPIXEL_BITS]
    }

    /// The corners alone, for the rasterizers of triangles.
    #[inline]
    pub fn snapped(&self) -> SnappedTriangle {
        let ([x0, x1, x2], [y0, y1, y2]) = (self.x, self.y);
        SnappedTriangle::within_guard_band([[x0, y0], [x1, y1], [x2, y2]])
    }

    /// The depth at a point of the screen, `dx, dy` pixels from the centre of [`Self::origin`].
    ///
    /// Everyone who compares depths computes them by this formula, in this order of operations.
    #[inline]
    pub fn depth_at(&self, dx: f32, dy: f32) -> f32 {
        let depth = self.depth + (self.depth_dx * dx + self.depth_dy * dy);
        depth.max(self.depth_min).min(self.depth_max)
    }

    /// First and last column and row of pixels whose centres lie in the bounding box; `None` where
    /// there are none.
    #[inline]
    pub fn pixel_bounds(&self, margin: i32) -> Option<[i32; 4]> {
        let min = |v: &[i32; 3]| first_center(v[0].min(v[1]).min(v[2]) - margin);
        let max = |v: &[i32; 3]| first_center(v[0].max(v[1]).max(v[2]) + margin + 1) - 1;
        let bounds = [min(&self.x), min(&self.y), max(&self.x), max(&self.y)];
        (bounds[0] <= bounds[2] && bounds[1] <= bounds[3]).then_some(bounds)
    }
}

/// How the fragments of a surface come to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Coverage {
    /// Every fragment hides what is behind it.
    Opaque,
    /// A fragment is there or not, by its alpha.
    Masked,
    /// Fragments are blended in the order of their depths.
    Blended,
}

/// A run of primitives of one instance that share a material; in scene order.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Primitives of the mesh.
    pub range: Range<u32>,
    /// Index into [`Scene::materials`].
    pub material: Option<usize>,
    /// Item index of the first primitive.
    pub first_item: u32,
    /// What the material's alpha means.
    pub coverage: Coverage,
    /// Whether the material is meant to be seen from its front only.
    pub single_sided: bool,
}

/// The runs of a scene in item order: triangles first, in scene order, then lines and points, so
/// that the item of a triangle does not depend on them.
///
/// # Errors
/// [`crate::Error::Limit`] where there are more than 2³² − 2 primitives.
pub fn runs(scene: &Scene) -> crate::Result<Vec<Run>> {
    let mut runs = Vec::new();
    let mut next_item: u64 = 0;
    for pass in [true, false] {
        for (index, instance) in scene.instances.iter().enumerate() {
            let mesh = &scene.meshes[instance.mesh];
            if (mesh.topology == Topology::Triangles) != pass {
                continue;
            }
            for (range, material) in mesh.material_runs() {
                if range.is_empty() {
                    continue;
                }
                let first = next_item;
                next_item += range.len() as u64;
                if next_item >= u64::from(u32::MAX) {
                    let (value, limit) = (next_item, u64::from(u32::MAX) - 1);
                    return Err(crate::Error::Limit { what: "items", value, limit });
                }
                runs.push(Run {
                    instance: index,
                    mesh: instance.mesh,
                    range,
                    material,
                    first_item: first as u32,
                    coverage: coverage(scene, material),
                    single_sided: material.is_some_and(|m| !scene.materials[m].double_sided),
                });
            }
        }
    }
    Ok(runs)
}

fn coverage(scene: &Scene, material: Option<usize>) -> Coverage {
    match material.map(|m| scene.materials[m].alpha_mode) {
        None | Some(AlphaMode::Opaque) => Coverage::Opaque,
        Some(AlphaMode::Mask { .. }) => Coverage::Masked,
        Some(AlphaMode::Blend) => Coverage::Blended,
    }
}

/// Bits of [`ScreenVertex::code`]: beyond which border of the view volume a vertex lies.
mod code {
    pub const LEFT: u32 = 1;
    pub const RIGHT: u32 = 2;
    pub const TOP: u32 = 4;
    pub const BOTTOM: u32 = 8;
    pub const NEAR: u32 = 16;
    pub const FAR: u32 = 32;
    /// Beyond one of these with all vertices: nothing can be seen.
    pub const OUTSIDE: u32 = LEFT | RIGHT | TOP | BOTTOM | NEAR | FAR;
    /// Too far off the screen for fixed point.
    pub const GUARD: u32 = 64;
    pub const NON_FINITE: u32 = 128;
}

/// A vertex after division and snapping; x and y have no meaning where `code` has NEAR or GUARD.
#[derive(Debug, Clone, Copy, Default)]
struct ScreenVertex {
    x: i32,
    y: i32,
    /// What snapping took away, in grid steps: the place is (x + rest_x, y + rest_y).
    rest_x: f32,
    rest_y: f32,
    depth: f32,
    code: u32,
}

impl ScreenVertex {
    fn new((pixels, depth): (DVec2, f32)) -> Self {
        let (x, y) = (snap(pixels.x), snap(pixels.y));
        let rest = |p: f64, snapped: i32| (p * f64::from(SUBPIXELS) - f64::from(snapped)) as f32;
        Self { x, y, rest_x: rest(pixels.x, x), rest_y: rest(pixels.y, y), depth, code: 0 }
    }
}

/// Which sign of the area on the screen, y down, means: seen from behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hidden {
    Positive,
    Negative,
}

/// Takes mesh space to homogeneous screen space, and says what is outside.
#[derive(Debug, Clone, Copy)]
struct Transform {
    clip_from_mesh: DMat4,
    screen_from_mesh: DMat4,
    width: f64,
    height: f64,
    /// Whether the matrix turns fronts into backs.
    mirrored: bool,
    /// Whether faces seen from behind are left out.
    cull_back: bool,
}

impl Transform {
    fn clip_vertex(&self, p: Vec3) -> ClipVertex {
        ClipVertex { position: self.clip_from_mesh * p.as_dvec3().extend(1.0), attributes: () }
    }

    /// Cuts at the near plane, and at the guard band that the rasterizer's numbers have room for.
    fn clip_options(&self) -> volume::Options {
        let guard_band = GUARD_BAND / self.width.max(self.height);
        volume::Options { borders: Borders::NearOnly { guard_band }, ..Default::default() }
    }

    /// The sign that the area of faces seen from behind has, where those are left out.
    fn hidden_side(&self) -> Option<Hidden> {
        // Fronts are counter-clockwise with y up, so their area is negative with y down.
        let behind = if self.mirrored { Hidden::Negative } else { Hidden::Positive };
        self.cull_back.then_some(behind)
    }

    /// x and y in pixels and the depth of a vertex with w > 0.
    fn to_screen(self, v: &ClipVertex) -> (DVec2, f32) {
        let p = v.position;
        let (x, y, z) = (p.x / p.w, p.y / p.w, p.z / p.w);
        let pixels = DVec2::new((0.5 + 0.5 * x) * self.width, (0.5 - 0.5 * y) * self.height);
        (pixels, (0.5 + 0.5 * z) as f32)
    }

    /// Transforms positions in order; `vertices` is replaced.
    fn vertices(&self, level: Level, positions: &[Vec3], vertices: &mut Vec<ScreenVertex>) {
        vertices.clear();
        vertices.resize(positions.len(), ScreenVertex::default());
        dispatch!(level, simd => transform(simd, self, positions, vertices));
    }
}

/// [`Transform::vertices`], four at a time.
#[simd]
fn transform<S: Simd>(simd: S, by: &Transform, from: &[Vec3], to: &mut [ScreenVertex]) {
    let (fours, rest) = from.as_chunks::<4>();
    let (to_fours, to_rest) = to.as_chunks_mut::<4>();
    for (from, to) in fours.iter().zip(to_fours) {
        transform_four(simd, by, from, to);
    }
    if !rest.is_empty() {
        let mut from = [Vec3::ZERO; 4];
        let mut to = [ScreenVertex::default(); 4];
        from[..rest.len()].copy_from_slice(rest);
        transform_four(simd, by, &from, &mut to);
        to_rest.copy_from_slice(&to[..rest.len()]);
    }
}

#[inline(always)]
fn transform_four<S: Simd>(simd: S, by: &Transform, p: &[Vec3; 4], to: &mut [ScreenVertex; 4]) {
    let m = &by.screen_from_mesh;
    let px: f64x4<S> = [p[0].x, p[1].x, p[2].x, p[3].x].map(f64::from).simd_into(simd);
    let py: f64x4<S> = [p[0].y, p[1].y, p[2].y, p[3].y].map(f64::from).simd_into(simd);
    let pz: f64x4<S> = [p[0].z, p[1].z, p[2].z, p[3].z].map(f64::from).simd_into(simd);
    let hx = (px * m.x_axis.x + py * m.y_axis.x) + (pz * m.z_axis.x + m.w_axis.x);
    let hy = (px * m.x_axis.y + py * m.y_axis.y) + (pz * m.z_axis.y + m.w_axis.y);
    let hz = (px * m.x_axis.z + py * m.y_axis.z) + (pz * m.z_axis.z + m.w_axis.z);
    let hw = (px * m.x_axis.w + py * m.y_axis.w) + (pz * m.z_axis.w + m.w_axis.w);
    let zero = f64x4::splat(simd, 0.0);
    let inv_w = f64x4::splat(simd, 1.0) / hw;
    let (x, y, z) = (hx * inv_w, hy * inv_w, hz * inv_w);
    // Every bit is set where a comparison fails too, so NaN is beyond everything.
    let left = !hx.simd_ge(zero).to_bitmask();
    let right = !hx.simd_le(hw * by.width).to_bitmask();
    let top = !hy.simd_ge(zero).to_bitmask();
    let bottom = !hy.simd_le(hw * by.height).to_bitmask();
    let near = !(hz.simd_ge(zero) & hw.simd_gt(zero)).to_bitmask();
    let far = !hz.simd_le(hw).to_bitmask();
    let guard = f64x4::splat(simd, GUARD_BAND);
    let outside_guard = !(x.abs().simd_lt(guard) & y.abs().simd_lt(guard)).to_bitmask();
    // Zero times what is not finite is NaN.
    let sum = (hx + hy + hz + hw) * 0.0;
    let non_finite = !sum.simd_eq(zero).to_bitmask();
    // Adding 1.5 · 2⁵² leaves the integer, rounded to nearest and ties to even, in the low bits.
    let magic = 6_755_399_441_055_744.0;
    let snap_scale = f64::from(SUBPIXELS);
    let (grid_x, grid_y) = (x * snap_scale, y * snap_scale);
    let (snapped_x, snapped_y) = (grid_x + magic, grid_y + magic);
    let (rest_x, rest_y) = (grid_x - (snapped_x - magic), grid_y - (snapped_y - magic));
    for i in 0..4 {
        let bit = |mask: u64, code: u32| ((mask >> i) as u32 & 1) * code;
        to[i] = ScreenVertex {
            x: snapped_x[i].to_bits() as i32,
            y: snapped_y[i].to_bits() as i32,
            rest_x: rest_x[i] as f32,
            rest_y: rest_y[i] as f32,
            depth: z[i] as f32,
            code: bit(left, code::LEFT)
                | bit(right, code::RIGHT)
                | bit(top, code::TOP)
                | bit(bottom, code::BOTTOM)
                | bit(near, code::NEAR)
                | bit(far, code::FAR)
                | bit(outside_guard, code::GUARD)
                | bit(non_finite, code::NON_FINITE),
        };
    }
}

/// Counts of what happened to triangles.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// With a vertex that is not finite.
    pub non_finite: u64,
    /// Cut by the near plane or the guard band.
    pub clipped: u64,
    /// Outside, turned away, without area or without a sample.
    pub culled: u64,
    /// Handed on.
    pub drawn: u64,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.non_finite += other.non_finite;
        self.clipped += other.clipped;
        self.culled += other.culled;
        self.drawn += other.drawn;
    }
}

/// Which triangles [`Assembler`] lets through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Filter {
    /// Which faces seen from behind are left out.
    pub cull: Cull,
    /// How far samples lie from the pixel's centre, in 1/256 pixel: triangles that cannot reach a
    /// sample are left out.
    pub sample_reach: i32,
}

/// Triangles without indices whose vertices are transformed at a time.
const UNINDEXED: u32 = 512;

/// Width in pixels at which lines of a model are drawn.
pub const LINE_WIDTH: f64 = 1.5;

/// Side in pixels of the square that a point of a model is drawn as.
pub const POINT_SIZE: f64 = 3.0;

/// Transforms, clips and sets up the triangles of runs.
pub struct Assembler<'a> {
    scene: &'a Scene,
    view: &'a View,
    filter: Filter,
    level: Level,
    vertices: Vec<ScreenVertex>,
    /// What happened so far.
    pub counts: Counts,
}

impl<'a> Assembler<'a> {
    /// An assembler for the scene, which has passed [`Scene::check`].
    pub fn new(scene: &'a Scene, view: &'a View, filter: Filter, level: Level) -> Self {
        Self { scene, view, filter, level, vertices: Vec::new(), counts: Counts::default() }
    }

    /// Hands the screen triangles of primitives `range` of a run to `emit`, in order. Lines become
    /// strips of [`LINE_WIDTH`], points squares of [`POINT_SIZE`].
    pub fn primitives(
        &mut self,
        run: &Run,
        range: Range<u32>,
        mut emit: impl FnMut(ScreenTriangle),
    ) {
        let mesh = &self.scene.meshes[run.mesh];
        let world_from_mesh = self.scene.instances[run.instance].world_from_mesh;
        let transform = Transform {
            clip_from_mesh: self.view.clip_from_world() * world_from_mesh,
            screen_from_mesh: self.view.screen_from_world() * world_from_mesh,
            width: f64::from(self.view.width()),
            height: f64::from(self.view.height()),
            mirrored: glam::DMat3::from_mat4(world_from_mesh).determinant() < 0.0,
            cull_back: match self.filter.cull {
                Cull::None => false,
                Cull::Back => true,
                Cull::Material => run.single_sided,
            },
        };
        match mesh.topology {
            Topology::Triangles => self.triangles(mesh, &transform, run, range, &mut emit),
            Topology::Lines | Topology::Points => {
                for primitive in range {
                    let item = run.first_item + (primitive - run.range.start);
                    let ends = mesh.line_or_point(primitive as usize);
                    let ends = ends.map(|c| transform.clip_vertex(mesh.positions[c as usize]));
                    self.strip(&transform, ends, item, &mut emit);
                }
            }
        }
    }

    fn triangles(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        run: &Run,
        range: Range<u32>,
        emit: &mut impl FnMut(ScreenTriangle),
    ) {
        let mut vertices = std::mem::take(&mut self.vertices);
        // Without indices no vertex serves two triangles, and a few at a time stay in the cache.
        let most = if mesh.indices.is_none() { UNINDEXED } else { u32::MAX };
        let mut start = range.start;
        while start < range.end {
            let part = start..range.end.min(start.saturating_add(most));
            start = part.end;
            let first = self.transform_vertices(mesh, transform, &part, &mut vertices);
            for triangle in part.clone() {
                let corners = mesh.triangle(triangle as usize);
                let at = match first {
                    Some(first) => {
                        let [a, b, c] = corners;
                        [a - first, b - first, c - first].map(|i| i as usize)
                    }
                    None => {
                        let i = 3 * (triangle - part.start) as usize;
                        [i, i + 1, i + 2]
                    }
                };
                let v = [&vertices[at[0]], &vertices[at[1]], &vertices[at[2]]];
                let item = run.first_item + (triangle - run.range.start);
                self.assemble(mesh, transform, corners, v, item, emit);
            }
        }
        self.vertices = vertices;
    }

    /// Transforms the vertices of a range of triangles: all between the smallest and the largest
    /// index, where that is not many more than are used, and then gives the smallest; else three
    /// for each triangle.
    fn transform_vertices(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        range: &Range<u32>,
        vertices: &mut Vec<ScreenVertex>,
    ) -> Option<u32> {
        let corners = 3 * range.start as usize..3 * range.end as usize;
        let Some(indices) = &mesh.indices else {
            transform.vertices(self.level, &mesh.positions[corners], vertices);
            return None;
        };
        let used = &indices[corners];
        let (min, max) = used.iter().fold((u32::MAX, 0), |(lo, hi), &i| (lo.min(i), hi.max(i)));
        if max >= min && ((max - min) as usize) < used.len() {
            let positions = &mesh.positions[min as usize..=max as usize];
            transform.vertices(self.level, positions, vertices);
            return Some(min);
        }
        let gathered: Vec<Vec3> = used.iter().map(|&i| mesh.positions[i as usize]).collect();
        transform.vertices(self.level, &gathered, vertices);
        None
    }

    #[inline(always)]
    fn assemble(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        corners: [u32; 3],
        v: [&ScreenVertex; 3],
        item: u32,
        emit: &mut impl FnMut(ScreenTriangle),
    ) {
        let (all, any) = (v[0].code & v[1].code & v[2].code, v[0].code | v[1].code | v[2].code);
        if any & code::NON_FINITE != 0 {
            self.counts.non_finite += 1;
        } else if all & code::OUTSIDE != 0 {
            self.counts.culled += 1;
        } else if any & (code::NEAR | code::GUARD) != 0 {
            self.clip(mesh, transform, corners, item, emit);
        } else {
            match self.set_up(v, item, transform.hidden_side()) {
                Some(triangle) => {
                    self.counts.drawn += 1;
                    emit(triangle);
                }
                None => self.counts.culled += 1,
            }
        }
    }

    /// Cuts a triangle at the near plane and the guard band and sets up the fan of what remains.
    #[cold]
    fn clip(
        &mut self,
        mesh: &Mesh,
        transform: &Transform,
        corners: [u32; 3],
        item: u32,
        emit: &mut impl FnMut(ScreenTriangle),
    ) {
        self.counts.clipped += 1;
        let points = corners.map(|c| transform.clip_vertex(mesh.positions[c as usize]));
        let polygon = clip_polygon(&points, &transform.clip_options(), &mut NoTrace);
        let projected: Vec<ScreenVertex> =
            polygon.iter().map(|v| ScreenVertex::new(transform.to_screen(v))).collect();
        let mut drawn = 0;
        for i in 2..projected.len() {
            let v = [&projected[0], &projected[i - 1], &projected[i]];
            if let Some(triangle) = self.set_up(v, item, transform.hidden_side()) {
                drawn = 1;
                emit(triangle);
            }
        }
        self.counts.drawn += drawn;
        self.counts.culled += 1 - drawn;
    }

    /// The strip around a line, or the square around a point (whose ends are the same).
    fn strip(
        &mut self,
        transform: &Transform,
        ends: [ClipVertex; 2],
        item: u32,
        emit: &mut impl FnMut(ScreenTriangle),
    ) {
        if !ends.iter().all(|v| v.position.is_finite()) {
            self.counts.non_finite += 1;
            return;
        }
        let Some(inside) = clip_segment(ends, &transform.clip_options(), &mut NoTrace) else {
            self.counts.culled += 1;
            return;
        };
        let [(pa, za), (pb, zb)] = inside.map(|v| transform.to_screen(&v));
        let along = (pb - pa).normalize_or_zero();
        let (back, side) = match along == DVec2::ZERO {
            true => (DVec2::X * (0.5 * POINT_SIZE), DVec2::Y * (0.5 * POINT_SIZE)),
            false => (DVec2::ZERO, along.perp() * (0.5 * LINE_WIDTH)),
        };
        let corners = [pa - back - side, pa - back + side, pb + back + side, pb + back - side];
        let z = [za, za, zb, zb];
        let v = [0, 1, 2, 3].map(|i| ScreenVertex::new((corners[i], z[i])));
        let mut drawn = 0;
        for [i, j, k] in [[0, 1, 2], [0, 2, 3]] {
            let triangle = self.set_up([&v[i], &v[j], &v[k]], item, None);
            if let Some(triangle) = triangle {
                drawn = 1;
                emit(triangle);
            }
        }
        self.counts.drawn += drawn;
        self.counts.culled += 1 - drawn;
    }

    /// Back-face and area test, bounding box test, depth plane.
    #[inline(always)]
    fn set_up(
        &self,
        v: [&ScreenVertex; 3],
        item: u32,
        hidden: Option<Hidden>,
    ) -> Option<ScreenTriangle> {
        let area = i64::from(v[1].x - v[0].x) * i64::from(v[2].y - v[0].y)
            - i64::from(v[2].x - v[0].x) * i64::from(v[1].y - v[0].y);
        let culled = match hidden {
            None => area == 0,
            Some(Hidden::Positive) => area >= 0,
            Some(Hidden::Negative) => area <= 0,
        };
        if culled {
            return None;
        }
        let [a, b, c] = if area < 0 { [v[0], v[2], v[1]] } else { v };
        let (x, y) = ([a.x, b.x, c.x], [a.y, b.y, c.y]);
        if self.misses_all_samples(&x, self.view.width())
            || self.misses_all_samples(&y, self.view.height())
        {
            return None;
        }
        let [depth, depth_dx, depth_dy] = depth_plane(a, b, c, area.abs() as f64);
        Some(ScreenTriangle {
            x,
            y,
            depth,
            depth_dx,
            depth_dy,
            depth_min: a.depth.min(b.depth).min(c.depth).max(0.0),
            depth_max: a.depth.max(b.depth).max(c.depth).max(0.0),
            item,
        })
    }

    /// Whether no sample of a pixel on the screen lies between three coordinates.
    #[inline(always)]
    fn misses_all_samples(&self, v: &[i32; 3], pixels: u32) -> bool {
        let reach = self.filter.sample_reach;
        let (lo, hi) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let (first, end) = (first_center(lo - reach), first_center(hi + reach + 1));
        first >= end || end <= 0 || i64::from(first) >= i64::from(pixels)
    }
}

/// The plane of depth through three vertices: its value at the centre of the pixel that holds the
/// first, and its change per pixel.
#[inline(always)]
fn depth_plane(
    a: &ScreenVertex,
    b: &ScreenVertex,
    c: &ScreenVertex,
    snapped_area: f64,
) -> [f32; 3] {
    // Through the places before snapping, which are exact.
    let away = |to: i32, from: i32, rest: f32, rest_from: f32| {
        f64::from(to - from) + (f64::from(rest) - f64::from(rest_from))
    };
    let (mut dx1, mut dy1) =
        (away(b.x, a.x, b.rest_x, a.rest_x), away(b.y, a.y, b.rest_y, a.rest_y));
    let (mut dx2, mut dy2) =
        (away(c.x, a.x, c.rest_x, a.rest_x), away(c.y, a.y, c.rest_y, a.rest_y));
    let mut area = dx1 * dy2 - dx2 * dy1;
    let (mut rest_x, mut rest_y) = (f64::from(a.rest_x), f64::from(a.rest_y));
    if area < 0.25 * snapped_area {
        // A sliver that only snapping gives its area: its plane is that of the snapped triangle.
        (dx1, dy1) = (f64::from(b.x - a.x), f64::from(b.y - a.y));
        (dx2, dy2) = (f64::from(c.x - a.x), f64::from(c.y - a.y));
        (area, rest_x, rest_y) = (snapped_area, 0.0, 0.0);
    }
    let scale = f64::from(SUBPIXELS) / area;
    let z = f64::from(a.depth);
    let (dz1, dz2) = (f64::from(b.depth) - z, f64::from(c.depth) - z);
    let depth_dx = (dz1 * dy2 - dz2 * dy1) * scale;
    let depth_dy = (dz2 * dx1 - dz1 * dx2) * scale;
    let depth = z + depth_dx * to_center(a.x, rest_x) + depth_dy * to_center(a.y, rest_y);
    [depth as f32, depth_dx as f32, depth_dy as f32]
}

/// From a coordinate to the centre of the pixel that holds its snapped place, in pixels.
#[inline(always)]
fn to_center(v: i32, rest: f64) -> f64 {
    (f64::from(HALF_PIXEL - (v & (SUBPIXELS - 1))) - rest) / f64::from(SUBPIXELS)
}
