//! Blended surfaces of a tile: lit from near to far until next to nothing comes through, and laid over
//! what is opaque from far to near.
//!
//! Triangles that do not cover each other are lit as they come ([`Sheet`]); where they do, and their depths do
//! not tell them apart either, their fragments are collected and sorted pixel by pixel.

mod sheet;

use super::rasterize::{FragmentTest, one_by_one, rasterize};
use super::resolve::{Area, MOST_SAMPLES, Output};
use super::tile::{SamplePlane, TILE, TILE_PIXELS, block_of};
use crate::math::Vec4;
use crate::raster::fixed::HALF_PIXEL;
use crate::shade::color::{encode_opaque_x16, premultiply};
use crate::target::NO_ITEM;
use crate::visibility::surface::LEAST_THROUGH;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::mixed::encode;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x16};
use fearless_simd_macros::simd;
use sheet::Sheet;

/// A fragment of a blended surface.
#[derive(Debug, Clone, Copy, Default)]
struct Fragment {
    /// The place of its pixel: block by block.
    place: u32,
    item: u32,
    /// Depth at the first covered sample.
    depth: f32,
    /// Bit i: sample i is covered and not hidden.
    samples: u32,
}

/// So many fragments are collected before those that nothing can come before are lit.
const MANY: usize = if cfg!(test) { 64 } else { 4 * TILE_PIXELS };

/// After so many triangles it is asked whether anything comes through.
const AT_ONCE: usize = 8;

/// Pixels of a block: eight in a row, and the eight below them.
const LANES: usize = 16;

/// Blocks of a tile.
const BLOCKS: usize = TILE_PIXELS / LANES;

/// A sheet with more blocks is likely to be covered by the next large triangle.
const MANY_BLOCKS: usize = BLOCKS / 2;

/// No layer.
const NONE: u32 = u32::MAX;

/// The upper left pixel of a block, tile-local.
#[inline(always)]
fn block_at(block: usize) -> [i32; 2] {
    let columns = TILE as usize / 8;
    [(block % columns * 8) as i32, (block / columns * 2) as i32]
}

/// The place of a tile-local pixel: its block times 16 and its lane.
#[inline(always)]
fn place_of(x: i32, y: i32) -> usize {
    let block = y / 2 * (TILE / 8) + x / 8;
    (block * LANES as i32 + y % 2 * 8 + x % 8) as usize % TILE_PIXELS
}

/// The blended surfaces of a tile.
pub struct Blended {
    sheet: Sheet,
    fragments: Fragments,
    layers: Layers,
}

impl Blended {
    /// For pixels with these samples.
    pub fn new(offsets: &'static [[i32; 2]]) -> Self {
        Self {
            sheet: Sheet::new(offsets.len()),
            fragments: Fragments { list: Vec::new(), by_place: Vec::new(), offsets, tile: [0; 2] },
            layers: Layers::new(offsets.len()),
        }
    }

    /// Begins with another tile, of which nothing is lit.
    pub fn clear(&mut self) {
        self.layers.all.clear();
    }

    /// Whether anything is lit.
    pub fn any(&self) -> bool {
        !self.layers.all.is_empty()
    }
}

/// Lights the blended triangles of a tile, which come with the nearest first, until next to nothing comes through.
#[simd]
pub fn light_blended<S: Simd>(
    simd: S,
    blended: &mut Blended,
    mut triangles: &[&ScreenTriangle],
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) {
    let Blended { sheet, fragments, layers } = blended;
    layers.open(area);
    while !triangles.is_empty() && !layers.hide_all(area[1]) {
        let taken = light_sheet(simd, sheet, triangles, layers, planes, area, lit);
        triangles = &triangles[taken..];
        if taken == 0 {
            let taken = light_sorted(simd, fragments, triangles, layers, planes, area, lit);
            triangles = &triangles[taken..];
        }
    }
}

/// Lights the first triangles, as many as do not cover each other, if all others are behind them: how many they
/// are.
#[inline(always)]
fn light_sheet<S: Simd>(
    simd: S,
    sheet: &mut Sheet,
    triangles: &[&ScreenTriangle],
    layers: &mut Layers,
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) -> usize {
    sheet.clear();
    let (mut taken, mut farthest) = (0, f32::NEG_INFINITY);
    // The item that covers others, of which the rest is in the sheet.
    let mut over = NO_ITEM;
    for t in triangles {
        // What is behind all of the sheet can as well begin another: it does where it is likely to cover much of it.
        if t.depth_min > farthest && sheet.begun().len() > MANY_BLOCKS && is_large(t, area) {
            break;
        }
        rasterize(simd, planes, area, std::iter::once(*t), Some(&mut *sheet));
        if sheet.covers_another {
            // Of an item that was cut, a part may be among the others.
            let in_parts = || triangles[..taken].iter().any(|other| other.item == t.item);
            if t.depth_min <= farthest || in_parts() {
                return 0;
            }
            over = t.item;
            break;
        }
        farthest = farthest.max(t.depth_max);
        taken += 1;
    }
    let over = u32x16::splat(simd, over);
    let none = u32x16::splat(simd, NO_ITEM);
    let mut samples = [none; MOST_SAMPLES];
    let samples = &mut samples[..layers.count];
    for &block in sheet.begun() {
        let block = block as usize;
        sheet.block(simd, block, samples);
        for items in samples.iter_mut() {
            *items = items.simd_eq(over).select(none, *items);
        }
        // Each item at a time of those that the samples of a pixel show, which are no more than samples.
        for _ in 0..layers.count {
            let mut items = none;
            for of_sample in samples.iter() {
                items = items.simd_eq(none).select(*of_sample, items);
            }
            if items.simd_eq(none).all_true() {
                break;
            }
            let mut covered = u32x16::splat(simd, 0);
            for (i, of_sample) in samples.iter_mut().enumerate() {
                let same = of_sample.simd_eq(items);
                covered |= same.select(u32x16::splat(simd, 1 << i), u32x16::splat(simd, 0));
                *of_sample = same.select(none, *of_sample);
            }
            layers.light(simd, block, items, covered, lit);
        }
    }
    taken
}

/// Whether the box of a triangle takes more than a quarter of a tile.
fn is_large(t: &ScreenTriangle, [tile, size]: [[i32; 2]; 2]) -> bool {
    let reach = HALF_PIXEL;
    t.pixel_bounds(reach).is_some_and(|[x0, y0, x1, y1]| {
        let across = (x1 - tile[0]).min(size[0] - 1) - (x0 - tile[0]).max(0);
        let down = (y1 - tile[1]).min(size[1] - 1) - (y0 - tile[1]).max(0);
        across.max(0) * down.max(0) > TILE_PIXELS as i32 / 4
    })
}

/// Lights the first triangles, as many as their depths do not tell from the others, sorted pixel by pixel: how many
/// they are.
#[inline(always)]
fn light_sorted<S: Simd>(
    simd: S,
    fragments: &mut Fragments,
    triangles: &[&ScreenTriangle],
    layers: &mut Layers,
    planes: &mut [SamplePlane],
    area: [[i32; 2]; 2],
    lit: &mut Lit<'_>,
) -> usize {
    fragments.list.clear();
    fragments.tile = area[0];
    let (mut taken, mut farthest) = (0, f32::NEG_INFINITY);
    let mut limit = MANY;
    while taken < triangles.len() && !layers.hide_all(area[1]) {
        let mut part = 0;
        for t in triangles[taken..].iter().take(AT_ONCE) {
            if t.depth_min > farthest && taken + part > 0 {
                break;
            }
            farthest = farthest.max(t.depth_max);
            part += 1;
        }
        if part == 0 {
            break;
        }
        let these = triangles[taken..taken + part].iter().copied();
        let mut open = Open { fragments, closed: &layers.closed };
        rasterize(simd, planes, area, these, Some(&mut open));
        taken += part;
        if let Some(next) = triangles.get(taken)
            && fragments.list.len() >= limit
        {
            light_nearer(simd, fragments, next.depth_min, layers, lit);
            limit = fragments.list.len() * 2 + MANY;
        }
    }
    light_nearer(simd, fragments, f32::INFINITY, layers, lit);
    taken
}

/// Fragments that nothing opaque hides, to be sorted.
struct Fragments {
    list: Vec<Fragment>,
    /// Room for sorting.
    by_place: Vec<Fragment>,
    offsets: &'static [[i32; 2]],
    tile: [i32; 2],
}

impl Fragments {
    /// Brings the fragments of each pixel together, near ones first; of equally near ones the lower
    /// item first, which is seen. Mostly they came in that order.
    fn sort(&mut self) {
        // They came triangle by triangle, so those of one item at one pixel follow each other.
        let mut next = [0; TILE_PIXELS + 1];
        for f in &self.list {
            next[f.place as usize + 1] += 1;
        }
        for place in 0..TILE_PIXELS {
            next[place + 1] += next[place];
        }
        self.by_place.resize(self.list.len(), Fragment::default());
        for f in &self.list {
            let slot = &mut next[f.place as usize];
            self.by_place[*slot] = *f;
            *slot += 1;
        }
        std::mem::swap(&mut self.list, &mut self.by_place);
        // The samples of one item at one pixel become one fragment. With one sample too there may be several
        // entries, for the rasterizer may come to a pixel of a triangle twice.
        self.list.dedup_by(|next, kept| {
            let same = (next.place, next.item) == (kept.place, kept.item);
            if same {
                kept.samples |= next.samples;
                kept.depth = kept.depth.min(next.depth);
            }
            same
        });
        for of_pixel in self.list.chunk_by_mut(|a, b| a.place == b.place) {
            of_pixel.sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.item.cmp(&b.item)));
        }
    }
}

/// Fragments are collected where something comes through.
struct Open<'a> {
    fragments: &'a mut Fragments,
    /// As [`Layers::closed`].
    closed: &'a [u32],
}

impl FragmentTest for Open<'_> {
    /// Takes note of the fragments and lets nothing be written.
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        at: [i32; 2],
        (first, shift): (usize, u32),
    ) -> S::i32s {
        one_by_one(simd, write, at, shift, |x, y, sample| {
            let place = place_of(x, y);
            if self.closed[place] != 0 {
                return false;
            }
            let (origin, tile) = (t.origin(), self.fragments.tile);
            let sample = first + sample;
            let [ox, oy] = self.fragments.offsets[sample].map(|o| o as f32 / 256.0);
            let dx = (tile[0] + x - origin[0]) as f32 + ox;
            let dy = (tile[1] + y - origin[1]) as f32 + oy;
            self.fragments.list.push(Fragment {
                place: place as u32,
                item: t.item,
                depth: t.depth_at(dx, dy),
                samples: 1 << sample,
            });
            false
        })
    }
}

/// Lights the fragments that are nearer than `bound`, which is no farther than any that is to come.
#[simd]
fn light_nearer<S: Simd>(
    simd: S,
    fragments: &mut Fragments,
    bound: f32,
    layers: &mut Layers,
    lit: &mut Lit<'_>,
) {
    fragments.sort();
    let list = &mut fragments.list;
    for of_block in list.chunk_by(|a, b| a.place as usize / LANES == b.place as usize / LANES) {
        let block = of_block[0].place as usize / LANES;
        let mut pixels: [&[Fragment]; LANES] = [&[]; LANES];
        for of_pixel in of_block.chunk_by(|a, b| a.place == b.place) {
            let nearer = of_pixel.iter().take_while(|f| f.depth < bound).count();
            pixels[of_pixel[0].place as usize % LANES] = &of_pixel[..nearer];
        }
        for number in 0.. {
            let (mut items, mut samples) = ([NO_ITEM; LANES], [0; LANES]);
            let mut touched = false;
            for (lane, pixel) in pixels.iter().enumerate() {
                let open = layers.closed[block * LANES + lane] == 0;
                if let Some(fragment) = pixel.get(number).filter(|_| open) {
                    (items[lane], samples[lane]) = (fragment.item, fragment.samples);
                    touched = true;
                }
            }
            if !touched {
                break;
            }
            let samples = u32x16::from_slice(simd, &samples);
            layers.light(simd, block, u32x16::from_slice(simd, &items), samples, lit);
        }
    }
    list.retain(|f| f.depth >= bound && layers.closed[f.place as usize] == 0);
}

/// What is lit of the blended surfaces of a tile.
struct Layers {
    /// Each is that of a block; 0 at pixels where nothing is.
    all: Vec<Colors>,
    /// Of each layer the next nearer one of its block: apart, so that what lies far apart need not be waited for
    /// one after the other.
    nearer: Vec<u32>,
    /// The samples that each layer covers of each pixel, as bits; not kept where pixels have but one.
    covered: Vec<[u32; LANES]>,
    /// Of each block the farthest layer that is lit, and the pixels that have some, as bits.
    farthest: Vec<(u32, u16)>,
    /// How much comes through what is lit: sample after sample the pixels, by place.
    through: Vec<f32>,
    /// All bits are set where next to nothing comes through, and beyond the picture; by place.
    closed: Vec<u32>,
    /// How many of those are in the picture.
    closed_count: usize,
    /// Samples of a pixel.
    count: usize,
    tile: [i32; 2],
}

/// Premultiplied red, green, blue and alpha of the pixels of a block.
type Colors = [[f32; LANES]; 4];

impl Layers {
    fn new(count: usize) -> Self {
        Self {
            all: Vec::new(),
            nearer: Vec::new(),
            covered: Vec::new(),
            farthest: Vec::new(),
            through: Vec::new(),
            closed: Vec::new(),
            closed_count: 0,
            count,
            tile: [0; 2],
        }
    }

    /// Begins with a tile of this place and size.
    fn open(&mut self, [tile, size]: [[i32; 2]; 2]) {
        self.all.clear();
        self.nearer.clear();
        self.covered.clear();
        self.farthest.clear();
        self.farthest.resize(BLOCKS, (NONE, 0));
        self.through.clear();
        self.through.resize(TILE_PIXELS * self.count, 1.0);
        self.closed.clear();
        self.closed.resize(TILE_PIXELS, 0);
        if size != [TILE; 2] {
            // The rasterizer goes beyond the picture's border.
            for (x, y) in (0..TILE).flat_map(|y| (0..TILE).map(move |x| (x, y))) {
                if x >= size[0] || y >= size[1] {
                    self.closed[place_of(x, y)] = u32::MAX;
                }
            }
        }
        self.closed_count = 0;
        self.tile = tile;
    }

    /// Whether nothing comes through at any pixel of a tile of this size.
    fn hide_all(&self, size: [i32; 2]) -> bool {
        self.closed_count >= (size[0] * size[1]) as usize
    }

    /// Lights an item at each pixel of a block where there is one and something comes through; `covered` are its
    /// samples as bits.
    #[inline(always)]
    fn light<S: Simd>(
        &mut self,
        simd: S,
        block: usize,
        items: u32x16<S>,
        covered: u32x16<S>,
        lit: &mut Lit<'_>,
    ) {
        let first = block * LANES;
        let closed = &mut self.closed[first..first + LANES];
        // All bits of NO_ITEM are set.
        let items = items | u32x16::from_slice(simd, closed);
        let there = items.simd_ne(u32x16::splat(simd, NO_ITEM));
        let touched = there.to_bitmask();
        if touched == 0 {
            return;
        }
        let [x, y] = block_at(block);
        let mut colors = [[0.0; LANES]; 4];
        let at = [self.tile[0] + x, self.tile[1] + y];
        Lit::colors_x16(simd, lit, items, at, &mut colors);
        // What is not there may have been shaded as well.
        let zero = f32x16::splat(simd, 0.0);
        let alpha = there.select(f32x16::from_slice(simd, &colors[3]), zero);
        for channel in &mut colors[..3] {
            let straight = there.select(f32x16::from_slice(simd, channel), zero);
            (straight * alpha).store_slice(channel);
        }
        alpha.store_slice(&mut colors[3]);
        let rest = 1.0 - alpha;
        let mut most = zero;
        for i in 0..self.count {
            let start = i * TILE_PIXELS + first;
            let through = &mut self.through[start..start + LANES];
            let before = f32x16::from_slice(simd, through);
            let bit = covered & (1 << i);
            let is_covered = there & bit.simd_ne(u32x16::splat(simd, 0));
            let after = is_covered.select(before * rest, before);
            after.store_slice(through);
            most = most.max(after);
        }
        let closes = there & most.simd_le(f32x16::splat(simd, LEAST_THROUGH));
        self.closed_count += closes.to_bitmask().count_ones() as usize;
        let all = u32x16::splat(simd, u32::MAX);
        closes.select(all, u32x16::from_slice(simd, closed)).store_slice(closed);
        let (farthest, all_touched) = &mut self.farthest[block];
        let nearer = std::mem::replace(farthest, self.all.len() as u32);
        *all_touched |= touched as u16;
        self.nearer.push(nearer);
        self.all.push(colors);
        if self.count > 1 {
            self.covered.push(covered.into());
        }
    }

    /// Lays the layers of a block over what shows at each sample, the farthest first.
    #[inline(always)]
    fn lay_over<S: Simd>(&self, simd: S, block: usize, under: &mut [[f32x16<S>; 4]]) {
        let mut next = self.farthest[block].0;
        while let Some(layer) = self.all.get(next as usize) {
            let covered = self.covered.get(next as usize);
            let alpha = f32x16::from_slice(simd, &layer[3]);
            for (i, under) in under.iter_mut().enumerate() {
                for (over, under) in layer.iter().zip(under) {
                    let sum = f32x16::from_slice(simd, over) + *under * (1.0 - alpha);
                    // Without samples it is 0 where nothing is, which changes nothing.
                    *under = match covered {
                        Some(covered) => {
                            let bit = u32x16::from_slice(simd, covered) & (1 << i);
                            bit.simd_ne(u32x16::splat(simd, 0)).select(sum, *under)
                        }
                        None => sum,
                    };
                }
            }
            next = self.nearer[next as usize];
        }
    }
}

/// Lays what is lit over what is behind it, block by block.
#[simd]
pub fn resolve_blended<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    blended: &Blended,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    output: &mut Output<'_>,
) {
    let layers = &blended.layers;
    let mut under = [[f32x16::splat(simd, 0.0); 4]; MOST_SAMPLES];
    let under = &mut under[..layers.count];
    for (block, &(_, touched)) in layers.farthest.iter().enumerate() {
        if touched == 0 {
            continue;
        }
        behind_block(simd, planes, block, lit, area, under);
        layers.lay_over(simd, block, under);
        let mut sums = [f32x16::splat(simd, 0.0); 4];
        for colors in under.iter() {
            for (sum, color) in sums.iter_mut().zip(colors) {
                *sum += *color;
            }
        }
        // The number of samples is a power of two, so this is exact.
        let mut mean = [[0.0; LANES]; 4];
        for (to, sum) in mean.iter_mut().zip(sums) {
            (sum * (1.0 / layers.count as f32)).store_slice(to);
        }
        let opaque: [u32; LANES] = encode_opaque_x16(simd, &mean).into();
        let [x, y] = block_at(block);
        for lane in (0..LANES).filter(|lane| touched >> lane & 1 == 1) {
            let [r, g, b, a] = &mean;
            let pixel = if a[lane] >= 1.0 {
                opaque[lane].to_le_bytes()
            } else {
                encode(Vec4::new(r[lane], g[lane], b[lane], a[lane]))
            };
            let (x, y) = (x as usize + lane % 8, y as usize + lane / 8);
            output.color[y * output.stride + x] = pixel;
        }
    }
}

/// The colours behind the blended surfaces at each sample of a block; each item is lit once.
#[inline(always)]
fn behind_block<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    block: usize,
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    colors: &mut [[f32x16<S>; 4]],
) {
    let [x, y] = block_at(block);
    let at = [area.tile[0] + x, area.tile[1] + y];
    // Of the last row there may be none below.
    let below = (y + 1).min(area.size[1] - 1) + area.tile[1];
    let above = premultiply((area.background)(at[1])).to_array();
    let below = premultiply((area.background)(below)).to_array();
    let mut behind = [f32x16::splat(simd, 0.0); 4];
    for (i, behind) in behind.iter_mut().enumerate() {
        *behind = simd.combine_f32x8(simd.splat_f32x8(above[i]), simd.splat_f32x8(below[i]));
    }
    let none = u32x16::splat(simd, NO_ITEM);
    let mut shown = [none; MOST_SAMPLES];
    for plane in planes {
        let samples = &mut shown[plane.first..plane.first + (1 << plane.shift)];
        block_of(simd, &plane.item, (y * TILE + x) as usize, samples);
    }
    for i in 0..colors.len() {
        colors[i] = behind;
        let items = shown[i];
        let mut left = items;
        for earlier in 0..i {
            let same = items.simd_eq(shown[earlier]);
            left = same.select(none, left);
            for k in 0..4 {
                colors[i][k] = same.select(colors[earlier][k], colors[i][k]);
            }
        }
        let unlit = left.simd_ne(none);
        if unlit.any_true() {
            let mut shaded = [[0.0; LANES]; 4];
            Lit::colors_x16(simd, lit, left, at, &mut shaded);
            shaded[3] = [1.0; LANES];
            for k in 0..4 {
                let shaded = f32x16::from_slice(simd, &shaded[k]);
                colors[i][k] = unlit.select(shaded, colors[i][k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::bins::{Bins, jobs};
    use super::super::front_to_back::FrontToBack;
    use super::super::rasterize::AllPass;
    use super::*;
    use crate::math::{DMat4, DVec3, Vec3};
    use crate::scene::{AlphaMode, Camera, Instance, Material, Mesh, Part, Projection, Scene};
    use crate::shade::{PreparedLights, PreparedMaterials};
    use crate::simd::levels;
    use crate::view::View;
    use crate::visibility::surface::lit::Lighting;
    use crate::visibility::surface::setup::{Coverage, Filter, runs};
    use crate::visibility::surface::{Cull, Samples};
    use fearless_simd::dispatch;

    /// Sheets one behind another, each of many triangles that share their edges; before and between them some that
    /// cross, and something opaque.
    fn scene() -> Scene {
        let mut positions = Vec::new();
        for sheet in 0..12 {
            let z = 0.8 - 0.12 * sheet as f32;
            for (x, y) in (0..3).flat_map(|y| (0..3).map(move |x| (x, y))) {
                let at = |i: i32, j: i32| {
                    // Tilted, but apart from the next, which begins farther to the left, where it is nearest.
                    let (x, y) = (i as f32 * 0.6 - 0.8, j as f32 * 0.7 - 1.1);
                    Vec3::new(x - 0.02 * sheet as f32, y, z - 0.02 * x)
                };
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                positions.extend([a, c, d, a, b, c]);
            }
        }
        for (x, z) in [(0.2, 0.3), (0.4, -0.1)] {
            let [a, b, c] = [(x, -0.8, z), (x + 0.6, 0.1, z - 0.3), (x - 0.2, 0.7, z + 0.05)];
            positions.extend([a, b, c].map(|(x, y, z)| Vec3::new(x, y, z)));
            positions.extend([b, a, c].map(|(x, y, z)| Vec3::new(x, -y, z)));
        }
        let blended = positions.len() as u32 / 3;
        positions.extend([(0.1, 0.1), (0.9, 0.3), (0.3, 0.9)].map(|(x, y)| Vec3::new(x, y, 0.02)));
        // Each sheet has its own colour, and the crossing ones have another.
        let glass = |i: usize| Material {
            base_color: Vec4::new(0.08 * i as f32, 0.5, 1.0 - 0.08 * i as f32, 0.4),
            alpha_mode: AlphaMode::Blend,
            ..Material::default()
        };
        let part = |i: usize, range| Part { range, material: Some(i), name: String::new() };
        let mut parts: Vec<Part> =
            (0..12).map(|i| part(i, 18 * i as u32..18 * (i as u32 + 1))).collect();
        parts.push(part(12, 216..blended));
        parts.push(part(13, blended..blended + 1));
        let materials = (0..13).map(glass).chain([Material::default()]).collect();
        let instance = Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: String::new() };
        Scene {
            meshes: vec![Mesh { positions, parts, ..Mesh::default() }],
            instances: vec![instance],
            materials,
            ..Scene::default()
        }
    }

    #[test]
    fn sheets_look_as_if_all_fragments_were_sorted() {
        let scene = scene();
        let projection = Projection::Orthographic { height: 2.0 };
        let (eye, target, up) = (DVec3::Z * 2.0, DVec3::ZERO, DVec3::Y);
        let camera = Camera { eye, target, up, projection, near: 1.0, far: 4.0 };
        let view = View::new(camera, 64, 64).expect("view");
        let (runs, lights) = (runs(&scene).expect("runs"), PreparedLights::auto(&camera));
        let materials = PreparedMaterials::new(&scene);
        for (samples, level) in [Samples::One, Samples::Four, Samples::Sixteen]
            .into_iter()
            .flat_map(|s| levels().into_iter().map(move |l| (s, l)))
        {
            let filter = Filter { cull: Cull::None, sample_reach: 128 };
            let jobs = jobs(&runs);
            let bins = jobs.iter().map(|job| Bins::new(job, &runs, &scene, &view, filter, level));
            let bins: Vec<Bins> = bins.collect();
            let lighting = Lighting {
                scene: &scene,
                view: &view,
                runs: &runs,
                materials: &materials,
                lights: &lights,
                shading: None,
                level,
            };
            let (mut lit, area) = (Lit::new(lighting), [[0, 0], [64, 64]]);
            let mut planes = SamplePlane::of(samples.offsets());
            for bins in bins.iter().filter(|b| b.coverage == Coverage::Opaque) {
                dispatch!(level, simd =>
                    rasterize(simd, &mut planes, area, bins.of_tile(0), None::<&mut AllPass>));
            }
            let mut order = FrontToBack::default();
            let triangles = order.nearest_first(&bins, 0);
            let planes = &mut planes;
            let (mut sheets, mut sorted) =
                (Blended::new(samples.offsets()), Blended::new(samples.offsets()));
            let taken = dispatch!(level, simd => {
                light_blended(simd, &mut sheets, triangles, planes, area, &mut lit);
                // Only sorted; and how many sheets there would be.
                let (mut rest, mut taken) = (triangles, [0; 2]);
                sorted.layers.open(area);
                while !rest.is_empty() {
                    let Blended { sheet, fragments, layers } = &mut sorted;
                    let n = light_sorted(simd, fragments, rest, layers, planes, area, &mut lit);
                    let mut other = Layers::new(layers.count);
                    other.open(area);
                    let m = light_sheet(simd, sheet, rest, &mut other, planes, area, &mut lit);
                    taken[usize::from(m > 0)] += 1;
                    rest = &rest[n..];
                }
                taken
            });
            assert!(taken[0] > 0 && taken[1] > 4, "{taken:?}");
            let background = |_: i32| Vec4::new(0.1, 0.2, 0.3, 0.5);
            let area = Area { tile: [0; 2], size: [64; 2], background: &background };
            let mut pictures = [[[0; 4]; TILE_PIXELS]; 2];
            for (blended, color) in [&sheets, &sorted].into_iter().zip(&mut pictures) {
                let mut output = Output { color, stride: 64 };
                dispatch!(level, simd =>
                    resolve_blended(simd, planes, blended, &mut lit, &area, &mut output));
            }
            let [a, b] = &pictures;
            let differing = a.iter().zip(b).filter(|(a, b)| a != b).count();
            assert_eq!(differing, 0, "{samples:?} {level:?}");
            assert!(a.iter().filter(|pixel| **pixel != [0; 4]).count() > 3000);
        }
    }
}
