//! Sixteen look-ups of one texture at a time, with coordinates in lanes; nearby texels are decoded once.
//!
//! Every operation is the one of [`PreparedTexture::sample`], in the same order, so the bits are the
//! same.

#[cfg(test)]
mod tests;

use super::color::premultiply;
use super::lane::Lane;
use super::mip::Level;
use super::texture::{Detail, PreparedTexture, SUBTEXEL, SUBTEXEL_BITS, Usage};
use crate::math::{Vec2, Vec4};
use crate::scene::{MipFilter, TextureFilter, Wrap};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x16, i32x16};
use fearless_simd_macros::simd;

/// Texture coordinates and how they change over the screen, in lanes.
#[derive(Debug, Clone, Copy)]
pub struct TexCoords<L> {
    /// Coordinates, as in [`super::TexCoord::uv`].
    pub uv: [L; 2],
    /// Derivative, as in [`super::TexCoord::ddx`].
    pub ddx: [L; 2],
    /// Derivative, as in [`super::TexCoord::ddy`].
    pub ddy: [L; 2],
}

/// Largest number of texels that are decoded together for sixteen points.
const NEAR: i32 = 32;

/// Images up to as many texels wide and high have coordinates that fit 32 bits with their fractions.
const MAX_SIDE: u32 = 1 << 18;

impl PreparedTexture<'_> {
    /// Returns whether [`Self::sample_x16`] may be used: bilinear at all sizes, and not too large.
    pub(super) fn suits_lanes(&self) -> bool {
        let base = self.chain.level(0);
        let linear =
            self.sampler.mag == TextureFilter::Linear && self.sampler.min == TextureFilter::Linear;
        let texels = u64::from(base.width) * u64::from(base.height);
        linear && base.width.max(base.height) <= MAX_SIDE && texels <= i32::MAX as u64
    }

    /// Returns whether [`Self::sample_x16`] asks how the coordinates change over the screen.
    pub(super) fn has_levels(&self) -> bool {
        self.sampler.mip != MipFilter::None
    }

    /// Returns red, green, blue and alpha of sixteen points, with the same bits as [`Self::sample`].
    #[simd]
    pub(super) fn sample_x16<S: Simd>(
        simd: S,
        this: &Self,
        at: &TexCoords<f32x16<S>>,
    ) -> [f32x16<S>; 4] {
        let colors = if this.has_levels() {
            this.between_levels(simd, at)
        } else {
            Self::filtered_x16(simd, this, &at.uv, this.chain.level(0))
        };
        straight_x16(simd, columns(simd, colors), this.chain.usage)
    }

    /// Returns the colours from the levels that suit each point.
    #[inline(always)]
    fn between_levels<S: Simd>(&self, simd: S, at: &TexCoords<f32x16<S>>) -> Rows<S> {
        let across = squared_length(at.ddx, self.size);
        let down = squared_length(at.ddy, self.size);
        let mut levels = [0; 16];
        let mut weights = [0.0; 16];
        // The finer level of any point that is between two.
        let mut mixed = None;
        for i in 0..16 {
            match self.detail(across[i].max(down[i])) {
                Detail::Magnified => {}
                Detail::Level(level) => levels[i] = level,
                Detail::Between(level, weight) => {
                    (levels[i], weights[i]) = (level, weight);
                    mixed = mixed.or(Some(level));
                }
            }
        }
        let near = self.in_levels(simd, &at.uv, &levels);
        let Some(mixed) = mixed else { return near };
        for i in 0..16 {
            // The results of points not between two levels are ignored.
            levels[i] = if weights[i] > 0.0 { levels[i] } else { mixed } + 1;
        }
        let far = self.in_levels(simd, &at.uv, &levels);
        let weights = spread(simd, f32x16::from_slice(simd, &weights));
        let mut sums = near;
        for i in 0..4 {
            let between = weights[i].simd_gt(simd.splat_f32x16(0.0));
            let sum = near[i] * (1.0 - weights[i]) + far[i] * weights[i];
            sums[i] = between.select(sum, near[i]);
        }
        sums
    }

    /// Returns each point in its level.
    #[inline(always)]
    fn in_levels<S: Simd>(&self, simd: S, uv: &[f32x16<S>; 2], levels: &[usize; 16]) -> Rows<S> {
        let mut rows = Self::filtered_x16(simd, self, uv, self.chain.level(levels[0]));
        let mut done = levels.map(|level| level == levels[0]);
        while let Some(next) = done.iter().position(|done| !done) {
            let of_level = Self::filtered_x16(simd, self, uv, self.chain.level(levels[next]));
            let mut is_here = [0.0; 16];
            for i in 0..16 {
                if levels[i] == levels[next] {
                    (is_here[i], done[i]) = (1.0, true);
                }
            }
            let is_here = spread(simd, f32x16::from_slice(simd, &is_here));
            for i in 0..4 {
                let is_here = is_here[i].simd_gt(simd.splat_f32x16(0.0));
                rows[i] = is_here.select(of_level[i], rows[i]);
            }
        }
        rows
    }

    /// Returns all points in one level; premultiplied where alpha weights the colour.
    #[simd]
    fn filtered_x16<S: Simd>(
        simd: S,
        this: &Self,
        [u, v]: &[f32x16<S>; 2],
        level: Level<'_>,
    ) -> Rows<S> {
        // The four texels around each point, with their weights.
        let (width, height) = (level.width as i32, level.height as i32);
        let (x0, x1, tx) = linear_x16(simd, *u, width, this.sampler.wrap_u);
        let (y0, y1, ty) = linear_x16(simd, *v, height, this.sampler.wrap_v);
        let weights = [spread(simd, tx), spread(simd, ty)];
        // The bounding rectangle of all texels needed.
        let ([left, right], [top, low]) = (ends(simd, x0), ends(simd, y0));
        let (columns, rows) = (right - left + 2, low - top + 2);
        let beside = (x1 - x0).simd_eq(1) & (y1 - y0).simd_eq(1);
        let mut means = [simd.splat_f32x16(0.0); 4];
        if beside.all_true() && columns.max(rows) <= NEAR && columns * rows <= NEAR {
            // The points are so close that they share most of their texels.
            let mut near = [[0.0; 4]; NEAR as usize];
            let (size, first) = ([columns as usize, rows as usize], top as usize * width as usize);
            this.decode_area(level, first + left as usize, size, &mut near);
            let index: [i32; 16] = ((y0 - top) * columns + (x0 - left)).into();
            for (i, to) in means.iter_mut().enumerate() {
                let [a, b] =
                    [four_near(simd, &near, &index, i, 0), four_near(simd, &near, &index, i, 1)];
                let c = four_near(simd, &near, &index, i, columns);
                let d = four_near(simd, &near, &index, i, columns + 1);
                *to = mean([a, b, c, d], [weights[0][i], weights[1][i]]);
            }
            return means;
        }
        // Otherwise each point decodes its own four texels.
        let (top, low) = (y0 * width, y1 * width);
        let indices: [[i32; 16]; 4] =
            [(top + x0).into(), (top + x1).into(), (low + x0).into(), (low + x1).into()];
        for (i, to) in means.iter_mut().enumerate() {
            let mut texels = [*to; 4];
            for (texels, indices) in texels.iter_mut().zip(&indices) {
                let texel = |k: usize| this.texel(level.texels, indices[4 * i + k] as usize);
                *texels = four(simd, [texel(0), texel(1), texel(2), texel(3)]);
            }
            *to = mean(texels, [weights[0][i], weights[1][i]]);
        }
        means
    }

    /// Decodes the texels of this many columns and rows from the texel `first` on, row by row.
    #[inline(always)]
    fn decode_area(
        &self,
        level: Level<'_>,
        first: usize,
        [columns, rows]: [usize; 2],
        out: &mut [[f32; 4]; NEAR as usize],
    ) {
        for (row, out) in out.chunks_exact_mut(columns).take(rows).enumerate() {
            let start = first + row * level.width as usize;
            let codes = level.texels.get(start..start + columns).unwrap_or(&[]);
            // A loop for each use, which is requested once.
            match self.chain.usage {
                Usage::Color => decode_all(codes, out, |code| Usage::Color.decode(code)),
                Usage::Data => decode_all(codes, out, |code| Usage::Data.decode(code)),
                Usage::ColorWithAlpha => decode_all(codes, out, |code| self.decode(code)),
            }
        }
    }

    #[inline(always)]
    pub(super) fn texel(&self, texels: &[[u8; 4]], index: usize) -> Vec4 {
        self.decode(texels.get(index).copied().unwrap_or([255; 4]))
    }

    #[inline(always)]
    pub(super) fn decode(&self, code: [u8; 4]) -> Vec4 {
        let texel = self.chain.usage.decode(code);
        if self.chain.usage == Usage::ColorWithAlpha { premultiply(texel) } else { texel }
    }
}

#[inline(always)]
fn decode_all(codes: &[[u8; 4]], out: &mut [[f32; 4]], decode: impl Fn([u8; 4]) -> Vec4) {
    for (to, &code) in out.iter_mut().zip(codes) {
        *to = decode(code).to_array();
    }
}

/// Sixteen colours, four side by side.
type Rows<S> = [f32x16<S>; 4];

/// Returns the colours, side by side, of the four points from `4 i` on, `after` texels behind the first texel of each.
#[inline(always)]
fn four_near<S: Simd>(
    simd: S,
    near: &[[f32; 4]; NEAR as usize],
    first: &[i32; 16],
    i: usize,
    after: i32,
) -> f32x16<S> {
    let texel = |k: usize| near[(first[4 * i + k] + after) as usize % NEAR as usize];
    four(simd, [texel(0), texel(1), texel(2), texel(3)].map(Vec4::from_array))
}

/// Returns four colours side by side.
#[inline(always)]
fn four<S: Simd>(simd: S, [a, b, c, d]: [Vec4; 4]) -> f32x16<S> {
    let (a, b) = (f32x4::simd_from(simd, a.to_array()), f32x4::simd_from(simd, b.to_array()));
    let (c, d) = (f32x4::simd_from(simd, c.to_array()), f32x4::simd_from(simd, d.to_array()));
    simd.combine_f32x8(simd.combine_f32x4(a, b), simd.combine_f32x4(c, d))
}

/// Returns each of sixteen numbers four times, for the channels of the colours in [`Rows`].
#[inline(always)]
fn spread<S: Simd>(simd: S, v: f32x16<S>) -> Rows<S> {
    let (low, high) = (simd.zip_low_f32x16(v, v), simd.zip_high_f32x16(v, v));
    let (first, second) = (simd.zip_low_f32x16(low, low), simd.zip_high_f32x16(low, low));
    [first, second, simd.zip_low_f32x16(high, high), simd.zip_high_f32x16(high, high)]
}

/// Returns the bilinear mean of four texels, the upper two first.
#[inline(always)]
fn mean<S: Simd>([a, b, c, d]: Rows<S>, [tx, ty]: [f32x16<S>; 2]) -> f32x16<S> {
    let (left, upper) = (1.0 - tx, 1.0 - ty);
    let top = a * left + b * tx;
    let low = c * left + d * tx;
    top * upper + low * ty
}

/// Returns the least and the largest of sixteen numbers.
#[inline(always)]
fn ends<S: Simd>(simd: S, v: i32x16<S>) -> [i32; 2] {
    let (a, b) = simd.split_i32x16(v);
    let (least, most) = (simd.min_i32x8(a, b), simd.max_i32x8(a, b));
    let ((a, b), (c, d)) = (simd.split_i32x8(least), simd.split_i32x8(most));
    let (least, most) = (simd.min_i32x4(a, b), simd.max_i32x4(c, d));
    [simd.reduce_min_i32x4(least), simd.reduce_max_i32x4(most)]
}

/// Returns red, green, blue and alpha, straight, of sixteen texels of this usage.
#[inline(always)]
fn straight_x16<S: Simd>(simd: S, [r, g, b, a]: [f32x16<S>; 4], usage: Usage) -> [f32x16<S>; 4] {
    if usage != Usage::ColorWithAlpha {
        return [r, g, b, a];
    }
    let zero = simd.splat_f32x16(0.0);
    let seen = a.simd_gt(zero);
    let (r, g, b) = (r / a, g / a, b / a);
    let a = seen.select(a, zero);
    [seen.select(r, zero), seen.select(g, zero), seen.select(b, zero), a]
}

/// Returns the reds, greens, blues and alphas of sixteen colours.
#[inline(always)]
fn columns<S: Simd>(simd: S, mut from: Rows<S>) -> [f32x16<S>; 4] {
    // Each shuffle rotates the six bits of a number's row and lane by one; two bring its channel to the front.
    for _ in 0..2 {
        let mut to = from;
        for i in 0..2 {
            to[i] = simd.unzip_low_f32x16(from[2 * i], from[2 * i + 1]);
            to[i + 2] = simd.unzip_high_f32x16(from[2 * i], from[2 * i + 1]);
        }
        from = to;
    }
    from
}

/// Returns the squared length of a change of coordinates, in texels.
#[inline(always)]
fn squared_length<S: Simd>(d: [f32x16<S>; 2], size: Vec2) -> [f32; 16] {
    let (x, y) = (d[0] * size.x, d[1] * size.y);
    (x * x + y * y).into()
}

/// Returns the two texels around each coordinate and the weight of the second.
#[inline(always)]
fn linear_x16<S: Simd>(
    simd: S,
    u: f32x16<S>,
    size: i32,
    wrap: Wrap,
) -> (i32x16<S>, i32x16<S>, f32x16<S>) {
    let (first, weight) = fixed_x16(simd, u, size, wrap);
    (inside_x16(simd, first, size, wrap), inside_x16(simd, first + 1, size, wrap), weight)
}

/// Returns the first texel of the two around each coordinate, −1 … size − 1, and the weight of the second,
/// which may be beyond the border too.
#[inline(always)]
fn fixed_x16<S: Simd>(simd: S, u: f32x16<S>, size: i32, wrap: Wrap) -> (i32x16<S>, f32x16<S>) {
    let fixed = (wrapped_x16(simd, u, wrap) * size as f32 + 0.5) * SUBTEXEL + 0.5;
    let fixed = simd.cvt_i32_f32x16(fixed);
    let weight = simd.cvt_f32_i32x16(fixed & ((1 << SUBTEXEL_BITS) - 1)) * (1.0 / SUBTEXEL);
    ((fixed >> SUBTEXEL_BITS) - 1, weight)
}

/// Brings coordinates to 0…1 (both ends possible) by the wrap mode; not finite = 0.
#[inline(always)]
fn wrapped_x16<S: Simd>(simd: S, u: f32x16<S>, wrap: Wrap) -> f32x16<S> {
    let zero = simd.splat_f32x16(0.0);
    let finite = simd.simd_le_f32x16(simd.abs_f32x16(u), simd.splat_f32x16(f32::MAX));
    let u = simd.select_f32x16(finite, u, zero);
    match wrap {
        Wrap::Repeat => u - Lane::floor(u),
        Wrap::MirroredRepeat => {
            let folded = u - Lane::floor(u * 0.5) * 2.0;
            folded.if_above(1.0, simd.splat_f32x16(2.0) - folded, folded)
        }
        Wrap::ClampToEdge => simd.min_f32x16(simd.max_f32x16(u, zero), simd.splat_f32x16(1.0)),
    }
}

/// Returns the neighbour beyond a border: the other end where the image repeats, else the border
/// itself.
#[inline(always)]
fn inside_x16<S: Simd>(simd: S, i: i32x16<S>, size: i32, wrap: Wrap) -> i32x16<S> {
    let (zero, last) = (i32x16::splat(simd, 0), i32x16::splat(simd, size - 1));
    if wrap == Wrap::Repeat {
        let wrapped = simd.select_i32x16(simd.simd_lt_i32x16(i, zero), last, i);
        return simd.select_i32x16(i.simd_ge(size), zero, wrapped);
    }
    simd.min_i32x16(simd.max_i32x16(i, zero), last)
}
