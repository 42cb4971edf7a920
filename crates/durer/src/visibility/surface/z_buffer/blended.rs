//! Blended surfaces of a tile: collected while it is rasterized, laid over what is opaque from far to near.

use super::rasterize::FragmentTest;
use super::resolve::{Area, MOST_SAMPLES, Output, sample_items};
use super::tile::{SamplePlane, TILE, TILE_PIXELS};
use crate::math::Vec4;
use crate::shade::color::premultiply;
use crate::target::NO_ITEM;
use crate::visibility::surface::LEAST_THROUGH;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::mixed::encode;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::Simd;
use fearless_simd_macros::simd;

/// A fragment of a blended surface, in tile-local pixels.
#[derive(Debug, Clone, Copy, Default)]
struct Fragment {
    pixel: u32,
    item: u32,
    /// Depth at the first covered sample.
    depth: f32,
    /// Bit i: sample i is covered and not hidden.
    samples: u32,
}

/// Collects the fragments of blended surfaces that nothing opaque hides.
pub struct Fragments {
    list: Vec<Fragment>,
    /// Room for sorting.
    by_pixel: Vec<Fragment>,
    offsets: &'static [[i32; 2]],
    tile: [i32; 2],
}

impl Fragments {
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self { list: Vec::new(), by_pixel: Vec::new(), offsets, tile: [0; 2] }
    }

    /// Forgets all fragments and begins with another tile.
    pub fn clear(&mut self, tile: [i32; 2]) {
        self.list.clear();
        self.tile = tile;
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !self.list.is_empty()
    }

    /// Brings the fragments of each pixel together, far ones first; of equally far ones the higher
    /// item first, so that the lower is seen.
    fn sort(&mut self) {
        // They came triangle by triangle, so those of one item at one pixel follow each other.
        let mut next = [0; TILE_PIXELS + 1];
        for f in &self.list {
            next[f.pixel as usize + 1] += 1;
        }
        for pixel in 0..TILE_PIXELS {
            next[pixel + 1] += next[pixel];
        }
        self.by_pixel.resize(self.list.len(), Fragment::default());
        for f in &self.list {
            let slot = &mut next[f.pixel as usize];
            self.by_pixel[*slot] = *f;
            *slot += 1;
        }
        std::mem::swap(&mut self.list, &mut self.by_pixel);
        // The samples of one item at one pixel become one fragment. With one sample too there may be several
        // entries, for the rasterizer may come to a pixel of a triangle twice.
        self.list.dedup_by(|next, kept| {
            let same = (next.pixel, next.item) == (kept.pixel, kept.item);
            if same {
                kept.samples |= next.samples;
                kept.depth = kept.depth.min(next.depth);
            }
            same
        });
        for of_pixel in self.list.chunk_by_mut(|a, b| a.pixel == b.pixel) {
            of_pixel.sort_by(|a, b| b.depth.total_cmp(&a.depth).then(b.item.cmp(&a.item)));
        }
    }
}

impl FragmentTest for Fragments {
    /// Takes note of the fragment and lets nothing be written.
    fn passes(&mut self, t: &ScreenTriangle, x: i32, y: i32, sample: usize) -> bool {
        let origin = t.origin();
        let [ox, oy] = self.offsets[sample].map(|o| o as f32 / 256.0);
        let dx = (self.tile[0] + x - origin[0]) as f32 + ox;
        let dy = (self.tile[1] + y - origin[1]) as f32 + oy;
        self.list.push(Fragment {
            pixel: (y * TILE + x) as u32,
            item: t.item,
            depth: t.depth_at(dx, dy),
            samples: 1 << sample,
        });
        false
    }
}

/// Lays the fragments over what is behind them, eight pixels of a row at a time.
#[simd]
pub fn resolve_blended<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    fragments: &mut Fragments,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    output: &mut Output<'_>,
) {
    fragments.sort();
    let mut layers = Vec::new();
    for of_eight in fragments.list.chunk_by(|a, b| a.pixel / 8 == b.pixel / 8) {
        let first = of_eight[0].pixel as usize / 8 * 8;
        let (x, y) = (first as i32 % TILE, first as i32 / TILE);
        if x >= area.size[0] || y >= area.size[1] {
            continue;
        }
        let mut pixels: [&[Fragment]; 8] = [&[]; 8];
        for of_pixel in of_eight.chunk_by(|a, b| a.pixel == b.pixel) {
            let lane = of_pixel[0].pixel as usize - first;
            if x + (lane as i32) < area.size[0] {
                pixels[lane] = of_pixel;
            }
        }
        let at = [area.tile[0] + x, area.tile[1] + y];
        let (mut colors, count) = behind_eight(simd, planes, first, &pixels, lit, area, at);
        light_layers(simd, &pixels, count, lit, at, &mut layers);
        let start = y as usize * output.stride + x as usize;
        for (lane, fragments) in pixels.iter().enumerate().filter(|(_, f)| !f.is_empty()) {
            let colors = &mut colors[lane][..count];
            for (layer, fragment) in layers.iter().zip(fragments.iter().rev()).rev() {
                let over = Vec4::from_array([0, 1, 2, 3].map(|c| layer[c][lane]));
                for (i, under) in colors.iter_mut().enumerate() {
                    if fragment.samples >> i & 1 == 1 {
                        *under = over + *under * (1.0 - over.w);
                    }
                }
            }
            output.color[start + lane] = encode(average(colors));
        }
    }
}

/// Premultiplied red, green, blue and alpha of a layer at eight pixels.
type Layer = [[f32; 8]; 4];

/// Lights the fragments of eight pixels, the nearest of each first: what next to nothing comes through of
/// need not be lit, and is clear.
#[inline(always)]
fn light_layers<S: Simd>(
    simd: S,
    pixels: &[&[Fragment]; 8],
    count: usize,
    lit: &mut Lit<'_>,
    [x, y]: [i32; 2],
    layers: &mut Vec<Layer>,
) {
    layers.clear();
    let mut through = [[1.0; MOST_SAMPLES]; 8];
    let mut open = [true; 8];
    for number in 0.. {
        let (mut items, mut samples) = ([NO_ITEM; 8], [0; 8]);
        for lane in 0..8 {
            let nearest = pixels[lane].len().checked_sub(number + 1);
            if let Some(fragment) = nearest.and_then(|i| pixels[lane].get(i)).filter(|_| open[lane])
            {
                (items[lane], samples[lane]) = (fragment.item, fragment.samples);
            }
        }
        if items == [NO_ITEM; 8] {
            break;
        }
        let mut layer = [[0.0; 8]; 4];
        Lit::colors_x8(simd, lit, &items, x, y, &mut layer);
        let [r, g, b, a] = &mut layer;
        for lane in 0..8 {
            // What is not there may have been shaded as well.
            a[lane] = if items[lane] == NO_ITEM { 0.0 } else { a[lane] };
            r[lane] *= a[lane];
            g[lane] *= a[lane];
            b[lane] *= a[lane];
            for (i, through) in through[lane][..count].iter_mut().enumerate() {
                if samples[lane] >> i & 1 == 1 {
                    *through *= 1.0 - a[lane];
                }
            }
            open[lane] &= through[lane][..count].iter().any(|&through| through > LEAST_THROUGH);
        }
        layers.push(layer);
    }
}

/// The colours behind the blended surfaces at each sample of eight pixels, of those that have some, and how
/// many samples there are; each item is lit once.
#[inline(always)]
fn behind_eight<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    first: usize,
    pixels: &[&[Fragment]; 8],
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    [x, y]: [i32; 2],
) -> ([[Vec4; MOST_SAMPLES]; 8], usize) {
    let behind = premultiply((area.background)(y));
    let mut colors = [[behind; MOST_SAMPLES]; 8];
    let mut shown = [[NO_ITEM; MOST_SAMPLES]; 8];
    let mut count = 0;
    for lane in (0..8).filter(|&lane| !pixels[lane].is_empty()) {
        (shown[lane], count) = sample_items(planes, first + lane);
    }
    for i in 0..count {
        let mut items = [NO_ITEM; 8];
        for lane in 0..8 {
            let (before, item) = (&shown[lane][..i], shown[lane][i]);
            match before.iter().position(|&other| other == item) {
                Some(earlier) => colors[lane][i] = colors[lane][earlier],
                None => items[lane] = item,
            }
        }
        if items != [NO_ITEM; 8] {
            let mut lit_here = [[0.0; 8]; 4];
            Lit::colors_x8(simd, lit, &items, x, y, &mut lit_here);
            let [r, g, b, _] = lit_here;
            for lane in (0..8).filter(|&lane| items[lane] != NO_ITEM) {
                colors[lane][i] = Vec4::new(r[lane], g[lane], b[lane], 1.0);
            }
        }
    }
    (colors, count)
}

fn average(colors: &[Vec4]) -> Vec4 {
    let sum = colors.iter().fold(Vec4::ZERO, |sum, &c| sum + c);
    // The number of samples is a power of two, so this is exact.
    sum * (1.0 / colors.len() as f32)
}
