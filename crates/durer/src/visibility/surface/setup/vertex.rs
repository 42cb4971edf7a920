//! Vertices: to homogeneous screen space, in f64, four at a time.

use crate::clip::volume::{self, Borders, ClipVertex};
use crate::math::{DMat4, DVec2, Vec3};
use crate::raster::fixed::{GUARD_BAND, SUBPIXELS, snap};
use crate::simd::Level;
use fearless_simd::prelude::*;
use fearless_simd::{dispatch, f64x4};
use fearless_simd_macros::simd;

/// Bits of [`ScreenVertex::code`]: beyond which border of the view volume a vertex lies.
pub mod code {
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
pub struct ScreenVertex {
    pub x: i32,
    pub y: i32,
    /// What snapping took away, in grid steps: the place is (x + rest_x, y + rest_y).
    pub rest_x: f32,
    pub rest_y: f32,
    pub depth: f32,
    pub code: u32,
}

impl ScreenVertex {
    pub fn new((pixels, depth): (DVec2, f32)) -> Self {
        let (x, y) = (snap(pixels.x), snap(pixels.y));
        let rest = |p: f64, snapped: i32| (p * f64::from(SUBPIXELS) - f64::from(snapped)) as f32;
        Self { x, y, rest_x: rest(pixels.x, x), rest_y: rest(pixels.y, y), depth, code: 0 }
    }
}

/// Which sign of the area on the screen, y down, means: seen from behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hidden {
    Positive,
    Negative,
}

/// Takes mesh space to homogeneous screen space, and says what is outside.
#[derive(Debug, Clone, Copy)]
pub struct Transform {
    pub clip_from_mesh: DMat4,
    pub screen_from_mesh: DMat4,
    pub width: f64,
    pub height: f64,
    /// Whether the matrix turns fronts into backs.
    pub mirrored: bool,
    /// Whether faces seen from behind are left out.
    pub cull_back: bool,
}

impl Transform {
    pub fn clip_vertex(&self, p: Vec3) -> ClipVertex {
        ClipVertex { position: self.clip_from_mesh * p.as_dvec3().extend(1.0), attributes: () }
    }

    /// Cuts at the near plane, and at the guard band that the rasterizer's numbers have room for.
    pub fn clip_options(&self) -> volume::Options {
        let guard_band = GUARD_BAND / self.width.max(self.height);
        volume::Options { borders: Borders::NearOnly { guard_band }, ..Default::default() }
    }

    /// The sign that the area of faces seen from behind has, where those are left out.
    pub fn hidden_side(&self) -> Option<Hidden> {
        // Fronts are counter-clockwise with y up, so their area is negative with y down.
        let behind = if self.mirrored { Hidden::Negative } else { Hidden::Positive };
        self.cull_back.then_some(behind)
    }

    /// x and y in pixels and the depth of a vertex with w > 0.
    pub fn to_screen(self, v: &ClipVertex) -> (DVec2, f32) {
        let p = v.position;
        let (x, y, z) = (p.x / p.w, p.y / p.w, p.z / p.w);
        let pixels = DVec2::new((0.5 + 0.5 * x) * self.width, (0.5 - 0.5 * y) * self.height);
        (pixels, (0.5 + 0.5 * z) as f32)
    }

    /// Transforms positions in order; `vertices` is replaced.
    pub fn vertices(&self, level: Level, positions: &[Vec3], vertices: &mut Vec<ScreenVertex>) {
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
    let [first, second, third, fourth] = codes([
        (left, code::LEFT),
        (right, code::RIGHT),
        (top, code::TOP),
        (bottom, code::BOTTOM),
        (near, code::NEAR),
        (far, code::FAR),
        (outside_guard, code::GUARD),
        (non_finite, code::NON_FINITE),
    ]);
    for (i, code) in [first, second, third, fourth].into_iter().enumerate() {
        to[i] = ScreenVertex {
            x: snapped_x[i].to_bits() as i32,
            y: snapped_y[i].to_bits() as i32,
            rest_x: rest_x[i] as f32,
            rest_y: rest_y[i] as f32,
            depth: z[i] as f32,
            code,
        };
    }
}

/// From masks whose bit i is set where vertex i is beyond a border, and the border's code, to the codes of
/// the four vertices.
#[inline(always)]
fn codes(borders: [(u64, u32); 8]) -> [u32; 4] {
    // A byte per vertex: the product puts bit i of the mask at bit 8 · i.
    let mut all = 0_u32;
    for (mask, code) in borders {
        all |= ((mask as u32 & 15).wrapping_mul(0x0020_4081) & 0x0101_0101) * code;
    }
    all.to_le_bytes().map(u32::from)
}
