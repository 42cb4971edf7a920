//! Eight look-ups of one texture at a time: coordinates side by side, texels one by one.
//!
//! Every operation is the one of [`PreparedTexture::sample`], in the same order, so the bits are the
//! same.

use super::color::premultiply;
use super::lane::Lane;
use super::mip::Level;
use super::texture::{Detail, PreparedTexture, SUBTEXEL, SUBTEXEL_BITS, Usage};
use crate::math::{Vec2, Vec4};
use crate::scene::{Filter, MipFilter, Wrap};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8, i32x8};
use fearless_simd_macros::simd;

/// Texture coordinates and how they change over the screen, in lanes.
#[derive(Debug, Clone, Copy)]
pub struct TexCoords<L> {
    /// As [`super::TexCoord::uv`].
    pub uv: [L; 2],
    /// As [`super::TexCoord::ddx`].
    pub ddx: [L; 2],
    /// As [`super::TexCoord::ddy`].
    pub ddy: [L; 2],
}

/// Images up to as many texels wide and high have coordinates that fit 32 bits with their fractions.
const MAX_SIDE: u32 = 1 << 18;

impl PreparedTexture<'_> {
    /// Whether [`Self::sample_x8`] may be used: bilinear at all sizes, and not too large.
    pub(super) fn suits_lanes(&self) -> bool {
        let base = self.chain.level(0);
        let linear = self.sampler.mag == Filter::Linear && self.sampler.min == Filter::Linear;
        let texels = u64::from(base.width) * u64::from(base.height);
        linear && base.width.max(base.height) <= MAX_SIDE && texels <= i32::MAX as u64
    }

    /// Red, green, blue and alpha of eight points, bit for bit what [`Self::sample`] gives.
    #[simd]
    pub(super) fn sample_x8<S: Simd>(
        simd: S,
        this: &Self,
        at: &TexCoords<f32x8<S>>,
    ) -> [f32x8<S>; 4] {
        let mut colors = [Vec4::ZERO; 8];
        if this.sampler.mip == MipFilter::None {
            Self::filtered_x8(simd, this, &at.uv, &[this.chain.level(0); 8], &mut colors);
        } else {
            this.between_levels(simd, at, &mut colors);
        }
        let mut channels = [[0.0; 8]; 4];
        for (i, color) in colors.iter().enumerate() {
            let color = this.straight(*color).to_array();
            for (channel, value) in channels.iter_mut().zip(color) {
                channel[i] = value;
            }
        }
        let [r, g, b, a] = &channels;
        let (r, g) = (f32x8::from_slice(simd, r), f32x8::from_slice(simd, g));
        [r, g, f32x8::from_slice(simd, b), f32x8::from_slice(simd, a)]
    }

    /// From the levels that suit each point.
    #[inline(always)]
    fn between_levels<S: Simd>(&self, simd: S, at: &TexCoords<f32x8<S>>, colors: &mut [Vec4; 8]) {
        let across = squared_length(at.ddx, self.size);
        let down = squared_length(at.ddy, self.size);
        let mut levels = [self.chain.level(0); 8];
        let mut next = levels;
        let mut weights = [0.0; 8];
        let mut mixed = false;
        for i in 0..8 {
            match self.detail(across[i].max(down[i])) {
                Detail::Magnified => {}
                Detail::Level(level) => levels[i] = self.chain.level(level),
                Detail::Between(level, weight) => {
                    levels[i] = self.chain.level(level);
                    next[i] = self.chain.level(level + 1);
                    weights[i] = weight;
                    mixed = true;
                }
            }
        }
        Self::filtered_x8(simd, self, &at.uv, &levels, colors);
        if mixed {
            let mut far = [Vec4::ZERO; 8];
            Self::filtered_x8(simd, self, &at.uv, &next, &mut far);
            for i in 0..8 {
                if weights[i] > 0.0 {
                    colors[i] = colors[i] * (1.0 - weights[i]) + far[i] * weights[i];
                }
            }
        }
    }

    /// Each point in its level; premultiplied where alpha weights the colour.
    #[simd]
    fn filtered_x8<S: Simd>(
        simd: S,
        this: &Self,
        [u, v]: &[f32x8<S>; 2],
        levels: &[Level<'_>; 8],
        colors: &mut [Vec4; 8],
    ) {
        let (mut widths, mut heights) = ([0; 8], [0; 8]);
        for i in 0..8 {
            (widths[i], heights[i]) = (levels[i].width as i32, levels[i].height as i32);
        }
        let width = i32x8::from_slice(simd, &widths);
        let (x0, x1, tx) = linear_x8(simd, *u, width, this.sampler.wrap_u);
        let height = i32x8::from_slice(simd, &heights);
        let (y0, y1, ty) = linear_x8(simd, *v, height, this.sampler.wrap_v);
        let (top, low) = (y0 * width, y1 * width);
        let index = |i: i32x8<S>| <[i32; 8]>::from(i);
        let (a, b, c, d) = (index(top + x0), index(top + x1), index(low + x0), index(low + x1));
        let (tx, ty): ([f32; 8], [f32; 8]) = (tx.into(), ty.into());
        for i in 0..8 {
            let texel = |index: i32| this.texel(levels[i].texels, index as usize);
            let top = texel(a[i]) * (1.0 - tx[i]) + texel(b[i]) * tx[i];
            let low = texel(c[i]) * (1.0 - tx[i]) + texel(d[i]) * tx[i];
            colors[i] = top * (1.0 - ty[i]) + low * ty[i];
        }
    }

    #[inline(always)]
    pub(super) fn texel(&self, texels: &[[u8; 4]], index: usize) -> Vec4 {
        let texel = self.chain.usage.decode(texels.get(index).copied().unwrap_or([255; 4]));
        if self.chain.usage == Usage::ColorWithAlpha { premultiply(texel) } else { texel }
    }
}

/// Of a change of coordinates, in texels.
#[inline(always)]
fn squared_length<S: Simd>(d: [f32x8<S>; 2], size: Vec2) -> [f32; 8] {
    let (x, y) = (d[0] * size.x, d[1] * size.y);
    (x * x + y * y).into()
}

/// The two texels around each coordinate and the weight of the second.
#[inline(always)]
fn linear_x8<S: Simd>(
    simd: S,
    u: f32x8<S>,
    size: i32x8<S>,
    wrap: Wrap,
) -> (i32x8<S>, i32x8<S>, f32x8<S>) {
    let sizes = simd.cvt_f32_i32x8(size);
    let fixed = simd.cvt_i32_f32x8((wrapped_x8(simd, u, wrap) * sizes + 0.5) * SUBTEXEL + 0.5);
    let first = (fixed >> SUBTEXEL_BITS) - 1;
    let weight = simd.cvt_f32_i32x8(fixed & ((1 << SUBTEXEL_BITS) - 1)) * (1.0 / SUBTEXEL);
    (inside_x8(simd, first, size, wrap), inside_x8(simd, first + 1, size, wrap), weight)
}

/// Coordinates brought to 0…1 (both ends possible) by the wrap mode; not finite = 0.
#[inline(always)]
fn wrapped_x8<S: Simd>(simd: S, u: f32x8<S>, wrap: Wrap) -> f32x8<S> {
    let zero = simd.splat_f32x8(0.0);
    let finite = simd.simd_le_f32x8(simd.abs_f32x8(u), simd.splat_f32x8(f32::MAX));
    let u = simd.select_f32x8(finite, u, zero);
    match wrap {
        Wrap::Repeat => u - Lane::floor(u),
        Wrap::MirroredRepeat => {
            let folded = u - Lane::floor(u * 0.5) * 2.0;
            folded.if_above(1.0, simd.splat_f32x8(2.0) - folded, folded)
        }
        Wrap::ClampToEdge => simd.min_f32x8(simd.max_f32x8(u, zero), simd.splat_f32x8(1.0)),
    }
}

/// The neighbour beyond a border: the other end where the image repeats, else the border itself.
#[inline(always)]
fn inside_x8<S: Simd>(simd: S, i: i32x8<S>, size: i32x8<S>, wrap: Wrap) -> i32x8<S> {
    let (zero, last) = (i32x8::splat(simd, 0), size - 1);
    if wrap == Wrap::Repeat {
        let wrapped = simd.select_i32x8(simd.simd_lt_i32x8(i, zero), last, i);
        return simd.select_i32x8(simd.simd_ge_i32x8(i, size), zero, wrapped);
    }
    simd.min_i32x8(simd.max_i32x8(i, zero), last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Image, Sampler};
    use crate::simd::levels;
    use fearless_simd::dispatch;

    #[simd]
    fn eight<S: Simd>(simd: S, texture: &PreparedTexture<'_>, at: &[[f32; 8]; 6]) -> [[f32; 8]; 4] {
        let lane = |i: usize| f32x8::from_slice(simd, &at[i]);
        let (uv, ddx) = ([lane(0), lane(1)], [lane(2), lane(3)]);
        let colors = PreparedTexture::sample_x8(
            simd,
            texture,
            &TexCoords { uv, ddx, ddy: [lane(4), lane(5)] },
        );
        let [r, g, b, a] = colors;
        [r.into(), g.into(), b.into(), a.into()]
    }

    #[test]
    fn eight_look_ups_are_eight_times_one() {
        let strange =
            [f32::NAN, f32::INFINITY, f32::MIN, -0.0, 1e-40, -1e-9, 1.0, 8_388_609.0, 3e9, -2.5];
        // Numbers from 0 to 1 that follow each other without order.
        let mut seed = 7_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32
        };
        for (width, height) in [(8, 4), (5, 7), (1, 3), (64, 64)] {
            let data = (0..width * height).map(|_| [0; 4].map(|_: u8| (random() * 255.0) as u8));
            let data = data.collect();
            let image = Image { name: String::new(), width, height, data };
            for wrap in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
                for mip in [MipFilter::None, MipFilter::Nearest, MipFilter::Linear] {
                    let (mag, min) = (Filter::Linear, Filter::Linear);
                    let sampler = Sampler { mag, min, mip, wrap_u: wrap, wrap_v: wrap };
                    for usage in [Usage::Color, Usage::ColorWithAlpha, Usage::Data] {
                        let texture = PreparedTexture::new(&image, sampler, usage);
                        for round in 0..40 {
                            let mut at = [[0.0; 8]; 6];
                            for (k, lanes) in at.iter_mut().enumerate() {
                                let scale = if k < 2 { 5.0 } else { 0.3 };
                                *lanes = lanes.map(|_| (random() - 0.4) * scale);
                                lanes[k] = strange[(round + k) % strange.len()];
                            }
                            agrees(&texture, &at);
                        }
                    }
                }
            }
        }
    }

    fn agrees(texture: &PreparedTexture<'_>, at: &[[f32; 8]; 6]) {
        for level in levels() {
            let colors = dispatch!(level, simd => eight(simd, texture, at));
            for i in 0..8 {
                let two = |k: usize| Vec2::new(at[k][i], at[k + 1][i]);
                let one = texture.sample(two(0), two(2), two(4)).to_array();
                let ours = [0, 1, 2, 3].map(|c| colors[c][i].to_bits());
                assert_eq!(ours, one.map(f32::to_bits), "{:?}", two(0));
            }
        }
    }
}
