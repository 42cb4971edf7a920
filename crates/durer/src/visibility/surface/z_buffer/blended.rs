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

/// So many fragments are collected before those that nothing can come before are lit.
const MANY: usize = if cfg!(test) { 64 } else { 4 * TILE_PIXELS };

/// Eight pixels of a row.
const GROUPS: usize = TILE_PIXELS / 8;

/// No layer.
const NONE: u32 = u32::MAX;

/// Collects the fragments of blended surfaces that nothing opaque hides, and lights them from near to
/// far until nothing comes through.
///
/// Triangles come with the nearest first, so what is nearer than all of the next one can be lit; so there are
/// few fragments at a time, and what is behind many layers is never looked at.
pub struct Fragments {
    list: Vec<Fragment>,
    /// Room for sorting.
    by_pixel: Vec<Fragment>,
    offsets: &'static [[i32; 2]],
    tile: [i32; 2],
    /// How much comes through what is lit, of each sample of each pixel.
    through: Vec<f32>,
    /// Pixels that next to nothing comes through of, and how many they are.
    closed: Vec<bool>,
    closed_count: usize,
    layers: Vec<Layer>,
    /// Of each eight pixels the farthest layer that is lit, and the pixels that have some, as bits.
    farthest: Vec<(u32, u8)>,
    /// When to light again.
    limit: usize,
}

/// Premultiplied red, green, blue and alpha of eight pixels.
type Colors = [[f32; 8]; 4];

/// What is lit of eight pixels.
struct Layer {
    colors: Colors,
    /// The samples that each covers.
    samples: [u32; 8],
    /// The next nearer layer.
    nearer: u32,
}

impl Fragments {
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self {
            list: Vec::new(),
            by_pixel: Vec::new(),
            offsets,
            tile: [0; 2],
            through: Vec::new(),
            closed: Vec::new(),
            closed_count: 0,
            layers: Vec::new(),
            farthest: Vec::new(),
            limit: MANY,
        }
    }

    /// Forgets all fragments and begins with another tile.
    pub fn clear(&mut self, tile: [i32; 2]) {
        self.list.clear();
        self.layers.clear();
        self.limit = MANY;
        self.tile = tile;
    }

    /// Begins to collect.
    pub fn open(&mut self) {
        let samples = TILE_PIXELS * self.offsets.len();
        self.through.clear();
        self.through.resize(samples, 1.0);
        self.closed.clear();
        self.closed.resize(TILE_PIXELS, false);
        self.closed_count = 0;
        self.farthest.clear();
        self.farthest.resize(GROUPS, (NONE, 0));
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !(self.list.is_empty() && self.layers.is_empty())
    }

    /// Whether there are so many that those in front should be lit.
    pub fn are_many(&self) -> bool {
        self.list.len() >= self.limit
    }

    /// Whether nothing comes through at any pixel of a tile of this size.
    pub fn hide_all(&self, size: [i32; 2]) -> bool {
        self.closed_count >= (size[0] * size[1]) as usize
    }

    /// Brings the fragments of each pixel together, near ones first; of equally near ones the lower
    /// item first, which is seen. Mostly they came in that order.
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
            of_pixel.sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.item.cmp(&b.item)));
        }
    }
}

impl FragmentTest for Fragments {
    /// Takes note of the fragment and lets nothing be written.
    fn passes(&mut self, t: &ScreenTriangle, x: i32, y: i32, sample: usize) -> bool {
        if self.closed[(y * TILE + x) as usize] {
            return false;
        }
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

/// Lights the fragments that are nearer than `bound`, which is no farther than any that is to come.
#[simd]
pub fn light_nearer<S: Simd>(
    simd: S,
    fragments: &mut Fragments,
    bound: f32,
    lit: &mut Lit<'_>,
    size: [i32; 2],
) {
    fragments.sort();
    let list = std::mem::take(&mut fragments.list);
    for of_eight in list.chunk_by(|a, b| a.pixel / 8 == b.pixel / 8) {
        let first = of_eight[0].pixel as usize / 8 * 8;
        let (x, y) = (first as i32 % TILE, first as i32 / TILE);
        if x >= size[0] || y >= size[1] {
            continue;
        }
        let mut pixels: [&[Fragment]; 8] = [&[]; 8];
        for of_pixel in of_eight.chunk_by(|a, b| a.pixel == b.pixel) {
            let lane = of_pixel[0].pixel as usize - first;
            if x + (lane as i32) < size[0] {
                let nearer = of_pixel.iter().take_while(|f| f.depth < bound).count();
                pixels[lane] = &of_pixel[..nearer];
            }
        }
        light_eight(simd, fragments, &pixels, first, lit);
    }
    fragments.list = list;
    let Fragments { list, closed, .. } = fragments;
    list.retain(|f| f.depth >= bound && !closed[f.pixel as usize]);
    fragments.limit = list.len() * 2 + MANY;
}

/// Lays what is lit over what is behind it, eight pixels of a row at a time.
#[simd]
pub fn resolve_blended<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    fragments: &mut Fragments,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    output: &mut Output<'_>,
) {
    light_nearer(simd, fragments, f32::INFINITY, lit, area.size);
    for (group, &(farthest, touched)) in fragments.farthest.iter().enumerate() {
        if touched == 0 {
            continue;
        }
        let first = group * 8;
        let (x, y) = (first as i32 % TILE, first as i32 / TILE);
        let at = [area.tile[0] + x, area.tile[1] + y];
        let (mut under, count) = behind_eight(simd, planes, first, touched, lit, area, at);
        let mut next = farthest;
        while let Some(layer) = fragments.layers.get(next as usize) {
            for (i, under) in under[..count].iter_mut().enumerate() {
                lay_over(layer, i, under);
            }
            next = layer.nearer;
        }
        let start = y as usize * output.stride + x as usize;
        for lane in (0..8).filter(|lane| touched >> lane & 1 == 1) {
            output.color[start + lane] = encode(average(&under[..count], lane));
        }
    }
}

/// Lays a layer over what shows at sample `i` of eight pixels.
#[inline(always)]
fn lay_over(layer: &Layer, i: usize, under: &mut Colors) {
    let [r, g, b, a] = &layer.colors;
    for (over, under) in [r, g, b, a].into_iter().zip(under) {
        for lane in 0..8 {
            let sum = over[lane] + under[lane] * (1.0 - a[lane]);
            let covered = layer.samples[lane] >> i & 1 == 1;
            under[lane] = if covered { sum } else { under[lane] };
        }
    }
}

/// Lights the fragments of eight pixels, the nearest of each first, until next to nothing comes through.
#[inline(always)]
fn light_eight<S: Simd>(
    simd: S,
    fragments: &mut Fragments,
    pixels: &[&[Fragment]; 8],
    first: usize,
    lit: &mut Lit<'_>,
) {
    let count = fragments.offsets.len();
    let at = [first as i32 % TILE, first as i32 / TILE];
    let [x, y] = [0, 1].map(|k| fragments.tile[k] + at[k]);
    for number in 0.. {
        let (mut items, mut samples) = ([NO_ITEM; 8], [0; 8]);
        let mut touched = 0;
        for lane in 0..8 {
            let open = !fragments.closed[first + lane];
            if let Some(fragment) = pixels[lane].get(number).filter(|_| open) {
                (items[lane], samples[lane]) = (fragment.item, fragment.samples);
                touched |= 1 << lane;
            }
        }
        if touched == 0 {
            break;
        }
        let mut colors = [[0.0; 8]; 4];
        Lit::colors_x8(simd, lit, &items, x, y, &mut colors);
        let [r, g, b, a] = &mut colors;
        for lane in 0..8 {
            // What is not there may have been shaded as well.
            a[lane] = if items[lane] == NO_ITEM { 0.0 } else { a[lane] };
            r[lane] *= a[lane];
            g[lane] *= a[lane];
            b[lane] *= a[lane];
            if items[lane] == NO_ITEM {
                continue;
            }
            let start = (first + lane) * count;
            let through = &mut fragments.through[start..start + count];
            for (i, through) in through.iter_mut().enumerate() {
                if samples[lane] >> i & 1 == 1 {
                    *through *= 1.0 - a[lane];
                }
            }
            if through.iter().all(|&through| through <= LEAST_THROUGH) {
                fragments.closed[first + lane] = true;
                fragments.closed_count += 1;
            }
        }
        let (farthest, all_touched) = &mut fragments.farthest[first / 8];
        let nearer = std::mem::replace(farthest, fragments.layers.len() as u32);
        *all_touched |= touched;
        fragments.layers.push(Layer { colors, samples, nearer });
    }
}

/// The colours behind the blended surfaces at each sample of eight pixels, of those that have some, and how
/// many samples there are; each item is lit once.
#[inline(always)]
fn behind_eight<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    first: usize,
    touched: u8,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    [x, y]: [i32; 2],
) -> ([Colors; MOST_SAMPLES], usize) {
    let behind = premultiply((area.background)(y));
    let mut colors = [behind.to_array().map(|v| [v; 8]); MOST_SAMPLES];
    let mut shown = [[NO_ITEM; MOST_SAMPLES]; 8];
    let mut count = 0;
    for lane in (0..8).filter(|&lane| touched >> lane & 1 == 1) {
        (shown[lane], count) = sample_items(planes, first + lane);
    }
    for i in 0..count {
        let mut items = [NO_ITEM; 8];
        for lane in 0..8 {
            let (before, item) = (&shown[lane][..i], shown[lane][i]);
            match before.iter().position(|&other| other == item) {
                Some(earlier) => {
                    let from = colors[earlier].map(|channel| channel[lane]);
                    colors[i].iter_mut().zip(from).for_each(|(to, from)| to[lane] = from);
                }
                None => items[lane] = item,
            }
        }
        if items != [NO_ITEM; 8] {
            let mut lit_here = [[0.0; 8]; 4];
            Lit::colors_x8(simd, lit, &items, x, y, &mut lit_here);
            lit_here[3] = [1.0; 8];
            for lane in (0..8).filter(|&lane| items[lane] != NO_ITEM) {
                for (to, from) in colors[i].iter_mut().zip(&lit_here) {
                    to[lane] = from[lane];
                }
            }
        }
    }
    (colors, count)
}

/// The mean of a pixel's samples.
fn average(colors: &[Colors], lane: usize) -> Vec4 {
    let at = |colors: &Colors| Vec4::from_array([0, 1, 2, 3].map(|c| colors[c][lane]));
    let sum = colors.iter().fold(Vec4::ZERO, |sum, colors| sum + at(colors));
    // The number of samples is a power of two, so this is exact.
    sum * (1.0 / colors.len() as f32)
}
