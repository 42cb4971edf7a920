//! Vertices: to homogeneous screen space, in f64, eight at a time.

use crate::clip::volume::{self, Borders, ClipVertex};
use crate::math::{DMat4, DVec2, Vec3};
use crate::raster::fixed::{GUARD_BAND, SUBPIXELS, snap};
use crate::simd::{Level, dispatch};
use crate::visibility::surface::gather::{MAGIC, low_bits, narrowed, transpose, widened};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, u32x8};
use fearless_simd_macros::simd;

/// Bits of [`ScreenVertex::code`]: the borders of the view volume that a vertex is beyond.
pub mod code {
    pub const LEFT: u32 = 1;
    pub const RIGHT: u32 = 2;
    pub const TOP: u32 = 4;
    pub const BOTTOM: u32 = 8;
    pub const NEAR: u32 = 16;
    pub const FAR: u32 = 32;
    /// A primitive whose vertices are all beyond one of these is invisible.
    pub const OUTSIDE: u32 = LEFT | RIGHT | TOP | BOTTOM | NEAR | FAR;
    /// Too far off the screen for fixed point.
    pub const GUARD: u32 = 64;
    pub const NON_FINITE: u32 = 128;
}

/// Index of the code in a [`ScreenVertex`].
const CODE: usize = 2;

/// A vertex after division and snapping, as a row of numbers, so that eight of them are easily transposed: x and y on
/// the grid; the [`code`]; the depth; the remainders of x and y lost by snapping, in grid steps, so that the exact
/// place is (x + remainder, y + remainder); two zeros. x and y have no meaning where the code has NEAR or GUARD. Floats
/// are bits.
#[derive(Debug, Clone, Copy, Default)]
pub struct ScreenVertex(pub [u32; 8]);

impl ScreenVertex {
    pub fn new((pixels, depth): (DVec2, f32)) -> Self {
        let (x, y) = (snap(pixels.x), snap(pixels.y));
        let rest = |p: f64, snapped: i32| (p * f64::from(SUBPIXELS) - f64::from(snapped)) as f32;
        let [rest_x, rest_y] = [rest(pixels.x, x), rest(pixels.y, y)].map(f32::to_bits);
        Self([x.cast_unsigned(), y.cast_unsigned(), 0, depth.to_bits(), rest_x, rest_y, 0, 0])
    }
}

/// Sign of the area on the screen, y down, that means: seen from behind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Behind {
    Positive,
    Negative,
}

/// Transform from mesh space to homogeneous screen space, with outcodes.
#[derive(Debug, Clone, Copy)]
pub struct Transform {
    pub clip_from_mesh: DMat4,
    pub screen_from_mesh: DMat4,
    pub width: f64,
    pub height: f64,
    /// True if the matrix turns fronts into backs.
    pub mirrored: bool,
    /// True if faces seen from behind are left out.
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

    /// Returns the sign that the area of faces seen from behind has.
    pub fn behind(&self) -> Behind {
        // Fronts are counter-clockwise with y up, so their area is negative with y down.
        if self.mirrored { Behind::Negative } else { Behind::Positive }
    }

    /// Returns x and y in pixels and the depth of a vertex with w > 0.
    pub fn to_screen(self, v: &ClipVertex) -> (DVec2, f32) {
        let p = v.position;
        let (x, y, z) = (p.x / p.w, p.y / p.w, p.z / p.w);
        let pixels = DVec2::new((0.5 + 0.5 * x) * self.width, (0.5 - 0.5 * y) * self.height);
        (pixels, (0.5 + 0.5 * z) as f32)
    }

    /// Transforms positions in order; `vertices` is replaced.
    pub fn vertices(&self, level: Level, positions: &[Vec3], vertices: &mut Vec<ScreenVertex>) {
        vertices.resize(positions.len(), ScreenVertex::default());
        dispatch!(level, simd => transform(simd, self, positions, vertices));
    }
}

/// Transforms positions as [`Transform::vertices`] does, eight at a time.
#[simd]
fn transform<S: Simd>(simd: S, by: &Transform, from: &[Vec3], to: &mut [ScreenVertex]) {
    let (eights, rest) = from.as_chunks::<8>();
    let (to_eights, to_rest) = to.as_chunks_mut::<8>();
    for (from, to) in eights.iter().zip(to_eights) {
        transform_eight(simd, by, from, to);
    }
    if !rest.is_empty() {
        let mut from = [Vec3::ZERO; 8];
        let mut to = [ScreenVertex::default(); 8];
        from[..rest.len()].copy_from_slice(rest);
        transform_eight(simd, by, &from, &mut to);
        to_rest.copy_from_slice(&to[..rest.len()]);
    }
}

#[inline(always)]
fn transform_eight<S: Simd>(simd: S, by: &Transform, p: &[Vec3; 8], to: &mut [ScreenVertex; 8]) {
    let m = &by.screen_from_mesh;
    // Homogeneous screen coordinates, in double precision.
    let [a, b, c, d, e, f, g, h] = p;
    let px: f32x8<S> = [a.x, b.x, c.x, d.x, e.x, f.x, g.x, h.x].simd_into(simd);
    let py: f32x8<S> = [a.y, b.y, c.y, d.y, e.y, f.y, g.y, h.y].simd_into(simd);
    let pz: f32x8<S> = [a.z, b.z, c.z, d.z, e.z, f.z, g.z, h.z].simd_into(simd);
    let (px, py, pz) = (widened(simd, px), widened(simd, py), widened(simd, pz));
    let hx = (px * m.x_axis.x + py * m.y_axis.x) + (pz * m.z_axis.x + m.w_axis.x);
    let hy = (px * m.x_axis.y + py * m.y_axis.y) + (pz * m.z_axis.y + m.w_axis.y);
    let hz = (px * m.x_axis.z + py * m.y_axis.z) + (pz * m.z_axis.z + m.w_axis.z);
    let hw = (px * m.x_axis.w + py * m.y_axis.w) + (pz * m.z_axis.w + m.w_axis.w);
    let zero = simd.splat_f64x8(0.0);
    let inv_w = simd.splat_f64x8(1.0) / hw;
    let (x, y, z) = (hx * inv_w, hy * inv_w, hz * inv_w);
    // A bit is also set if its comparison fails, so NaN is beyond all borders.
    let left = !hx.simd_ge(zero).to_bitmask();
    let right = !hx.simd_le(hw * by.width).to_bitmask();
    let top = !hy.simd_ge(zero).to_bitmask();
    let bottom = !hy.simd_le(hw * by.height).to_bitmask();
    let near = !(hz.simd_ge(zero) & hw.simd_gt(zero)).to_bitmask();
    let far = !hz.simd_le(hw).to_bitmask();
    let guard = simd.splat_f64x8(GUARD_BAND);
    let outside_guard = !(x.abs().simd_lt(guard) & y.abs().simd_lt(guard)).to_bitmask();
    // Zero times an infinity is NaN.
    let sum = (hx + hy + hz + hw) * 0.0;
    let non_finite = !sum.simd_eq(zero).to_bitmask();
    // Adding MAGIC rounds to the grid, with the coordinates in the low bits; the rests are the differences.
    let snap_scale = f64::from(SUBPIXELS);
    let (grid_x, grid_y) = (x * snap_scale, y * snap_scale);
    let (snapped_x, snapped_y) = (grid_x + MAGIC, grid_y + MAGIC);
    let (rest_x, rest_y) = (grid_x - (snapped_x - MAGIC), grid_y - (snapped_y - MAGIC));
    let none = simd.splat_f32x8(0.0);
    let (rest_x, rest_y) = (narrowed(simd, rest_x), narrowed(simd, rest_y));
    let (x, y) = (low_bits(simd, snapped_x).bitcast(), low_bits(simd, snapped_y).bitcast());
    let depth = narrowed(simd, z);
    // Written vertex by vertex; the codes only if any is set.
    let rows = transpose(simd, [x, y, none, depth, rest_x, rest_y, none, none]);
    for (to, row) in to.iter_mut().zip(&rows) {
        row.bitcast::<u32x8<S>>().store_slice(&mut to.0);
    }
    let beyond = [left, right, top, bottom, near, far, outside_guard, non_finite];
    let mut any = 0;
    for border in beyond {
        any |= border & 0xff;
    }
    if any != 0 {
        for (to, code) in to.iter_mut().zip(codes(beyond)) {
            to.0[CODE] = code;
        }
    }
}

/// Converts masks whose bit i is set where vertex i is beyond a border, in the order of the bits of [`code`], to the
/// codes of the eight vertices.
#[inline(always)]
fn codes(beyond: [u64; 8]) -> [u32; 8] {
    // Rows of bits to columns: exchange single bits, then blocks of two by two, then of four by four.
    let mut bits = u64::from_le_bytes(beyond.map(|mask| mask as u8));
    for (apart, mask) in
        [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)]
    {
        let differing = (bits ^ (bits >> apart)) & mask;
        bits ^= differing ^ (differing << apart);
    }
    bits.to_le_bytes().map(u32::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_by_border_become_codes_by_vertex() {
        let beyond = [0x01, 0x82, 0x00, 0xff, 0x10, 0x08, 0x55, 0x80];
        let expected = |vertex: usize| {
            (0..8).fold(0, |code, border| code | ((beyond[border] >> vertex) as u32 & 1) << border)
        };
        assert_eq!(codes(beyond), std::array::from_fn(expected));
    }
}
