//! Pixels that show several items: each is lit once and weighted by its share of the pixel.

use crate::math::Vec4;
use crate::shade::color::{encode_rgba8, unpremultiply};
use crate::visibility::surface::lit::{Lit, QUEUE, Queue, Queued};
use fearless_simd::Simd;
use fearless_simd_macros::simd;

/// The sums of colours of pixels so far, and what still waits to be lit.
pub struct Mixed {
    /// The pixels begun, for who needs to find them again.
    pub pixels: Vec<u32>,
    /// Linear, premultiplied; by pixel.
    pub sums: Vec<Vec4>,
    /// Pixel and weight of each entry of the queue.
    waiting: [(u32, f32); QUEUE],
    queue: Queue,
}

impl Mixed {
    /// For so many pixels, which are counted from 0.
    pub fn new(pixels: usize) -> Self {
        Self {
            pixels: Vec::new(),
            sums: vec![Vec4::ZERO; pixels],
            waiting: [(0, 0.0); QUEUE],
            queue: Queue::default(),
        }
    }

    /// Begins a pixel, of which there is nothing yet.
    #[inline(always)]
    pub fn begin(&mut self, pixel: u32) {
        self.pixels.push(pixel);
        self.sums[pixel as usize] = Vec4::ZERO;
    }

    /// Adds a colour's share of a pixel.
    #[inline(always)]
    pub fn add_color(&mut self, pixel: u32, color: Vec4, weight: f32) {
        self.sums[pixel as usize] += color * weight;
    }

    /// Adds an item's share of a pixel.
    #[inline(always)]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        item: u32,
        index: u32,
        weight: f32,
        at: [i32; 2],
    ) {
        match lit.queue(item, at, &mut self.queue) {
            Queued::Done => {}
            Queued::OtherRun => {
                Self::flush(simd, self, lit);
                lit.queue(item, at, &mut self.queue);
            }
            Queued::Never => {
                let color = lit.color(item, at[0], at[1]).truncate().extend(1.0);
                return self.add_color(index, color, weight);
            }
        }
        self.waiting[(self.queue.count - 1) % QUEUE] = (index, weight);
        if self.queue.count == QUEUE {
            Self::flush(simd, self, lit);
        }
    }

    /// Lights what waits.
    #[simd]
    pub fn flush<S: Simd>(simd: S, this: &mut Self, lit: &mut Lit<'_>) {
        if this.queue.count == 0 {
            return;
        }
        let [r, g, b] = lit.shade_queue(simd, &this.queue);
        for (i, (pixel, weight)) in this.waiting.into_iter().take(this.queue.count).enumerate() {
            this.add_color(pixel, Vec4::new(r[i], g[i], b[i], 1.0), weight);
        }
        this.queue.count = 0;
    }
}

/// 8-bit sRGB, straight alpha.
pub fn encode(premultiplied: Vec4) -> [u8; 4] {
    let opaque = premultiplied.w >= 1.0;
    encode_rgba8(if opaque { premultiplied } else { unpremultiply(premultiplied) })
}
