//! The mip chain of one image: each level half as wide and high, rounded down, to 1 × 1.
//!
//! Williams, *Pyramidal Parametrics*, SIGGRAPH 1983. Odd sizes are filtered with the three-tap weights
//! of Guthe and Heckbert, *Non-Power-of-Two Mipmapping*, 2005, which keep the image's mean. Cost: time
//! O(texels); memory a third of the image, which itself is borrowed, not copied.

use super::color::{decode_unorm8, encode_srgb8, encode_unorm8};
use super::usage::Usage;
use crate::math::Vec4;
use crate::scene::Image;

/// One size of an image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level<'a> {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Row after row.
    pub texels: &'a [[u8; 4]],
}

/// An image in all its sizes.
#[derive(Debug)]
pub(super) struct MipChain<'a> {
    base: Level<'a>,
    /// Width, height and first texel of the levels from 1 on.
    sizes: Vec<(u32, u32, usize)>,
    texels: Vec<[u8; 4]>,
    /// Reading and weighting of texels.
    pub usage: Usage,
}

/// The single white texel that replaces an image that could not be read.
const WHITE: &[[u8; 4]] = &[[255; 4]];

impl<'a> MipChain<'a> {
    /// Filters all levels, if requested. An image without pixels, or with fewer than it claims, becomes white.
    pub fn new(image: &'a Image, usage: Usage, levels: bool) -> Self {
        let pixels = u64::from(image.width) * u64::from(image.height);
        let readable = pixels > 0 && image.data.len() as u64 >= pixels;
        let base = if readable {
            Level { width: image.width, height: image.height, texels: &image.data }
        } else {
            Level { width: 1, height: 1, texels: WHITE }
        };
        // Without a transparent texel, weighting by alpha only costs time.
        let opaque = || base.texels.iter().all(|t| t[3] == 255);
        let usage = if usage == Usage::ColorWithAlpha && opaque() { Usage::Color } else { usage };
        let mut chain = Self { base, sizes: Vec::new(), texels: Vec::new(), usage };
        if levels {
            chain.fill();
        }
        chain
    }

    fn fill(&mut self) {
        loop {
            let last = self.level(self.sizes.len());
            if last.width == 1 && last.height == 1 {
                return;
            }
            let size = ((last.width / 2).max(1), (last.height / 2).max(1));
            let smaller = halve(last, size, self.usage);
            self.sizes.push((size.0, size.1, self.texels.len()));
            self.texels.extend(smaller);
        }
    }

    /// Returns the number of the 1 × 1 level.
    #[inline(always)]
    pub fn last(&self) -> usize {
        self.sizes.len()
    }

    /// Returns a level: 0 is the image; numbers beyond the last return the image, too.
    #[inline(always)]
    pub fn level(&self, number: usize) -> Level<'_> {
        match number.checked_sub(1).and_then(|i| self.sizes.get(i)) {
            Some(&(width, height, first)) => {
                Level { width, height, texels: self.texels.get(first..).unwrap_or(WHITE) }
            }
            None => self.base,
        }
    }
}

/// Returns three source weights of destination texel `i`; the source starts at `2 i`. Their sum is
/// 1.
fn weights(source: u32, destination: u32, i: u32) -> [f32; 3] {
    let (s, d, i) = (source as f32, destination as f32, i as f32);
    if source == 1 {
        [1.0, 0.0, 0.0]
    } else if source.is_multiple_of(2) {
        [0.5, 0.5, 0.0]
    } else {
        [(d - i) / s, d / s, (i + 1.0) / s]
    }
}

/// Returns a level of `size` from the one before: box filter over each texel's own area.
fn halve(from: Level<'_>, size: (u32, u32), usage: Usage) -> Vec<[u8; 4]> {
    let mut texels = Vec::with_capacity(size.0 as usize * size.1 as usize);
    for y in 0..size.1 {
        let vertical = weights(from.height, size.1, y);
        for x in 0..size.0 {
            let horizontal = weights(from.width, size.0, x);
            texels.push(area(from, (2 * x, 2 * y), horizontal, vertical, usage));
        }
    }
    texels
}

/// Returns the mean of up to 3 × 3 texels from `at` on.
fn area(
    from: Level<'_>,
    at: (u32, u32),
    horizontal: [f32; 3],
    vertical: [f32; 3],
    usage: Usage,
) -> [u8; 4] {
    let (mut plain, mut weighted) = (Vec4::ZERO, Vec4::ZERO);
    for (j, wy) in (0..).zip(vertical).filter(|(_, w)| *w > 0.0) {
        for (i, wx) in (0..).zip(horizontal).filter(|(_, w)| *w > 0.0) {
            let index = (at.1 + j) as usize * from.width as usize + (at.0 + i) as usize;
            let code = from.texels.get(index).copied().unwrap_or([255; 4]);
            let texel = usage.decode(code);
            let weight = wx * wy;
            plain += texel * weight;
            weighted += texel * (weight * decode_unorm8(code[3]));
        }
    }
    // If all texels are transparent, their colours still count, for the next level's border.
    if usage == Usage::ColorWithAlpha && plain.w > 0.0 {
        let color = weighted / plain.w;
        plain = Vec4::new(color.x, color.y, color.z, plain.w);
    }
    encode(plain, usage)
}

fn encode(color: Vec4, usage: Usage) -> [u8; 4] {
    let code: fn(f32) -> u8 = if usage == Usage::Data { encode_unorm8 } else { encode_srgb8 };
    [code(color.x), code(color.y), code(color.z), encode_unorm8(color.w)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, f: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let data = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let data = data.map(|(x, y)| f(x, y)).collect();
        Image { name: String::new(), width, height, data }
    }

    #[test]
    fn a_checker_board_becomes_grey_of_half_its_light() {
        let checker =
            image(64, 64, |x, y| if (x + y) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        let color = MipChain::new(&checker, Usage::Color, true);
        assert_eq!(color.last(), 6);
        assert_eq!(color.level(6).texels, [[188, 188, 188, 255]]);
        let data = MipChain::new(&checker, Usage::Data, true);
        assert_eq!(data.level(6).texels, [[128, 128, 128, 255]]);
    }

    #[test]
    fn odd_sizes_keep_the_mean() {
        for (width, height) in [(5, 3), (7, 1), (1, 9), (13, 6), (33, 31)] {
            let noise = image(width, height, |x, y| {
                let v = (x * 7919 + y * 104_729 + x * y * 31) % 251;
                [v as u8, 255 - v as u8, (v / 2) as u8, 255]
            });
            let chain = MipChain::new(&noise, Usage::Data, true);
            let mean = |c: usize| {
                let sum: u32 = noise.data.iter().map(|t| u32::from(t[c])).sum();
                sum as f32 / noise.data.len() as f32
            };
            let last = chain.level(chain.last()).texels[0];
            for (c, &code) in last.iter().enumerate().take(3) {
                // Each level rounds once, by half a code at most.
                let bound = 0.5 * chain.last() as f32 + 0.01;
                assert!((f32::from(code) - mean(c)).abs() <= bound, "{width}x{height}");
            }
        }
    }

    #[test]
    fn transparent_texels_do_not_bleed() {
        let leaf = image(8, 8, |x, _| if x % 2 == 0 { [0, 200, 0, 255] } else { [255, 0, 255, 0] });
        let chain = MipChain::new(&leaf, Usage::ColorWithAlpha, true);
        for number in 1..=chain.last() {
            for texel in &chain.level(number).texels[..1] {
                assert_eq!(*texel, [0, 200, 0, 128]);
            }
        }
        let ignored = MipChain::new(&leaf, Usage::Color, true);
        assert_eq!(ignored.level(3).texels[0], [188, 146, 188, 128]);
    }

    #[test]
    fn images_that_could_not_be_read_are_white() {
        let short = Image { width: 100, height: 100, data: vec![[0; 4]; 5], ..Image::default() };
        for broken in [&Image::default(), &short] {
            let chain = MipChain::new(broken, Usage::Data, true);
            assert_eq!(chain.level(0).texels, [[255; 4]]);
            assert_eq!(chain.last(), 0);
        }
    }
}
