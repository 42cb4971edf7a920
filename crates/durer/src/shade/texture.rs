//! Textures: nearest, bilinear and mip-mapped sampling with wrap modes.
//!
//! Texture coordinates follow glTF: (0, 0) is the upper left corner of the image, (1, 1) the lower
//! right one, texel (i, j) has its centre at ((i + ½)/width, (j + ½)/height). Level of detail after
//! Williams 1983 and the OpenGL specification (4.6, 8.14): the longer of the two screen derivatives.

#[cfg(test)]
mod tests;

use super::mip::{Level, MipChain};
pub use super::texel::{INFO, MIP_MAP, Step, replay, weights};
use super::texel::{bilinear, mix};
pub use super::usage::Usage;
use crate::math::{Vec2, Vec4};
use crate::scene::{Image, MipFilter, Sampler, TextureFilter, Wrap};
use crate::trace::{NoTrace, Tracer};
use std::sync::Arc;

/// An image with its mip chain, ready to be sampled; cheap to clone.
///
/// Texels stay 8-bit and are decoded when they are fetched. The image is borrowed.
#[derive(Debug, Clone)]
pub struct PreparedTexture<'a> {
    pub(super) chain: Arc<MipChain<'a>>,
    pub(super) sampler: Sampler,
    pub(super) size: Vec2,
}

/// Parts of a texel's width at which bilinear weights are taken; fine enough for dark gradients in
/// linear light, coarse enough that a texel's centre is hit exactly in images up to 2048 wide.
pub(super) const SUBTEXEL_BITS: u32 = 12;
pub(super) const SUBTEXEL: f32 = (1 << SUBTEXEL_BITS) as f32;

impl<'a> PreparedTexture<'a> {
    /// Filters the image's mip chain. An image of size zero samples white.
    ///
    /// Cost: O(texels) time, a third of the image in memory.
    pub fn new(image: &'a Image, sampler: Sampler, usage: Usage) -> Self {
        let levels = sampler.mip != MipFilter::None;
        Self::from_chain(Arc::new(MipChain::new(image, usage, levels)), sampler)
    }

    pub(super) fn from_chain(chain: Arc<MipChain<'a>>, sampler: Sampler) -> Self {
        let base = chain.level(0);
        let size = Vec2::new(base.width as f32, base.height as f32);
        Self { chain, sampler, size }
    }

    /// Returns the colour or data at `uv`, where `ddx` and `ddy` are the derivatives of `uv` by the
    /// pixel's x and y. Straight alpha. Coordinates that are not finite count as 0.
    ///
    /// Cost: one fetch for nearest, four for bilinear, eight between two levels.
    #[inline]
    pub fn sample(&self, uv: Vec2, ddx: Vec2, ddy: Vec2) -> Vec4 {
        self.sample_traced(uv, ddx, ddy, &mut NoTrace)
    }

    /// Returns the same as [`Self::sample`], and reports the steps.
    ///
    /// ```
    /// use durer::math::Vec2;
    /// use durer::scene::{Image, Sampler};
    /// use durer::shade::texture::PreparedTexture;
    /// use durer::shade::texture::{Step, Usage};
    /// use durer::trace::Recorder;
    ///
    /// let data = [0, 255].map(|grey| [grey, grey, grey, 255]).to_vec();
    /// let image = Image { width: 2, height: 1, data, ..Image::default() };
    /// let texture = PreparedTexture::new(&image, Sampler::default(), Usage::Data);
    /// let mut steps = Recorder::default();
    /// let middle = texture.sample_traced(Vec2::splat(0.5), Vec2::ZERO, Vec2::ZERO, &mut steps);
    /// assert_eq!(middle.x, 0.5);
    /// assert!(matches!(steps.steps().last(), Some(Step::Bilinear { fractions: [0.5, 0.0], .. })));
    /// ```
    #[inline(always)]
    pub fn sample_traced(&self, uv: Vec2, ddx: Vec2, ddy: Vec2, t: &mut impl Tracer<Step>) -> Vec4 {
        let (x, y) = (ddx * self.size, ddy * self.size);
        let footprint2 = x.length_squared().max(y.length_squared());
        let detail = self.detail(footprint2);
        t.step(|| self.chosen([x, y], footprint2, &detail));
        let sum = match detail {
            Detail::Magnified => self.filtered(0, uv, self.sampler.mag, t),
            Detail::Level(level) => self.filtered(level, uv, self.sampler.min, t),
            Detail::Between(level, weight) => {
                let near = self.filtered(level, uv, self.sampler.min, t);
                let far = self.filtered(level + 1, uv, self.sampler.min, t);
                let value = mix(near, far, weight);
                t.step(|| Step::Between { weight, value });
                value
            }
        };
        let color = self.straight(sum);
        if self.chain.usage == Usage::ColorWithAlpha {
            t.step(|| Step::Divided(color));
        }
        color
    }

    /// Returns the step that says which levels were chosen.
    fn chosen(&self, ways: [Vec2; 2], footprint2: f32, detail: &Detail) -> Step {
        let lod = if footprint2 > 0.0 { half_log2(footprint2) } else { f32::NEG_INFINITY };
        let (level, weight) = match *detail {
            Detail::Magnified => (0, None),
            Detail::Level(level) => (level, None),
            Detail::Between(level, weight) => (level, Some(weight)),
        };
        Step::Detail { ways, lod, mip: self.sampler.mip, level, weight }
    }

    /// Returns the levels for the square of the longer screen derivative in texels.
    #[inline(always)]
    pub(super) fn detail(&self, footprint2: f32) -> Detail {
        // Also where a derivative is NaN: both comparisons of `max` let the other one win.
        if footprint2.is_nan() || footprint2 <= 1.0 {
            return Detail::Magnified;
        }
        let last = self.chain.last();
        match self.sampler.mip {
            MipFilter::None => Detail::Level(0),
            MipFilter::Nearest => Detail::Level(((half_log2(footprint2) + 0.5) as usize).min(last)),
            MipFilter::Linear => {
                let lod = half_log2(footprint2);
                let level = lod as usize;
                if level >= last {
                    Detail::Level(last)
                } else {
                    Detail::Between(level, lod - level as f32)
                }
            }
        }
    }

    /// Returns one level, filtered; premultiplied where alpha weights the colour.
    #[inline(always)]
    fn filtered(
        &self,
        number: usize,
        uv: Vec2,
        filter: TextureFilter,
        t: &mut impl Tracer<Step>,
    ) -> Vec4 {
        let level = self.chain.level(number);
        let (wrap_u, wrap_v) = (self.sampler.wrap_u, self.sampler.wrap_v);
        t.step(|| {
            let to = Vec2::new(wrapped(uv.x, wrap_u), wrapped(uv.y, wrap_v));
            Step::Wrapped { level: number, size: [level.width, level.height], from: uv, to }
        });
        match filter {
            TextureFilter::Nearest => {
                let x = nearest(uv.x, level.width, wrap_u);
                let y = nearest(uv.y, level.height, wrap_v);
                let value = self.fetch(level, x, y);
                t.step(|| Step::Nearest { level: number, texel: [x, y], value });
                value
            }
            TextureFilter::Linear => {
                let (x0, x1, tx) = linear(uv.x, level.width, wrap_u);
                let (y0, y1, ty) = linear(uv.y, level.height, wrap_v);
                let texels = [[x0, y0], [x1, y0], [x0, y1], [x1, y1]];
                // Each by itself: `map` of an array may be a call for each texel.
                let value = |[x, y]: [u32; 2]| self.fetch(level, x, y);
                let values =
                    [value(texels[0]), value(texels[1]), value(texels[2]), value(texels[3])];
                let fractions = [tx, ty];
                let value = bilinear(values, fractions);
                t.step(|| Step::Bilinear { level: number, texels, fractions, values, value });
                value
            }
        }
    }

    #[inline(always)]
    fn fetch(&self, level: Level<'_>, x: u32, y: u32) -> Vec4 {
        let index = y as usize * level.width as usize + x as usize;
        self.texel(level.texels, index)
    }

    #[inline(always)]
    pub(super) fn straight(&self, sum: Vec4) -> Vec4 {
        if self.chain.usage == Usage::ColorWithAlpha {
            super::color::unpremultiply(sum)
        } else {
            sum
        }
    }
}

/// The choice of levels.
pub(super) enum Detail {
    /// Texels are larger than pixels.
    Magnified,
    /// One level.
    Level(usize),
    /// This level and the next, with the weight of the next.
    Between(usize, f32),
}

/// Returns half the logarithm to base 2 of x > 1: the level for a squared footprint.
///
/// Mitchell's approximation from the float's bits (1962), corrected by a parabola: the error is at most 0.004, less
/// than a hundredth of a level, at a few cycles.
#[inline(always)]
fn half_log2(x: f32) -> f32 {
    let bits = x.to_bits();
    let exponent = (bits >> 23) as f32 - 127.0;
    let m = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000) - 1.0;
    // log2(1 + m) − m is 0 at both ends and 0.086 high between.
    0.5 * (exponent + m + 0.344 * m * (1.0 - m))
}

/// Returns the nearest whole number below or equal; in registers, where `f32::floor` may be a call.
#[inline(always)]
fn floor(x: f32) -> f32 {
    // From 2^23 on every float is whole.
    if x.abs() >= 8_388_608.0 {
        return x;
    }
    let whole = x as i32 as f32;
    if whole > x { whole - 1.0 } else { whole }
}

/// Returns a coordinate brought to 0…1 (both ends possible) by the wrap mode; not finite = 0.
#[inline(always)]
fn wrapped(u: f32, wrap: Wrap) -> f32 {
    if !u.is_finite() {
        return 0.0;
    }
    match wrap {
        Wrap::Repeat => u - floor(u),
        Wrap::MirroredRepeat => {
            let folded = u - 2.0 * floor(u * 0.5);
            if folded > 1.0 { 2.0 - folded } else { folded }
        }
        Wrap::ClampToEdge => u.clamp(0.0, 1.0),
    }
}

/// Returns the texel whose area holds the coordinate.
#[inline(always)]
fn nearest(u: f32, size: u32, wrap: Wrap) -> u32 {
    ((wrapped(u, wrap) * size as f32) as u32).min(size - 1)
}

/// Returns the two texels around the coordinate and the weight of the second.
#[inline(always)]
fn linear(u: f32, size: u32, wrap: Wrap) -> (u32, u32, f32) {
    // One texel too far, so that the number is positive and cutting off its fraction rounds down.
    let fixed = ((wrapped(u, wrap) * size as f32 + 0.5) * SUBTEXEL + 0.5) as i64;
    let first = (fixed >> SUBTEXEL_BITS) - 1;
    let weight = (fixed & ((1 << SUBTEXEL_BITS) - 1)) as f32 * (1.0 / SUBTEXEL);
    (inside(first, size, wrap), inside(first + 1, size, wrap), weight)
}

/// Returns the neighbour beyond a border: the other end where the image repeats, else the border
/// itself.
#[inline(always)]
fn inside(i: i64, size: u32, wrap: Wrap) -> u32 {
    let size = i64::from(size);
    let texel = match wrap {
        Wrap::Repeat if i < 0 => size - 1,
        Wrap::Repeat if i >= size => 0,
        _ => i.clamp(0, size - 1),
    };
    texel as u32
}
