//! From the visible items of a tile to colours: each triangle is lit once per pixel, the samples of
//! a pixel are averaged in linear light, blended surfaces are laid over from far to near.

use super::area::{Area, Codes};
use super::blended::{Blended, resolve_blended};
use super::rasterize::{FragmentTest, one_by_one};
use super::tile::{SamplePlane, TILE, block_of};
use crate::math::Vec4;
use crate::shade::color::{encode_premultiplied, premultiply};
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::{
    Batch, KnownNormals, Lit, MOST_SAMPLES, PointQueue, ShadingPoint,
};
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, mask32x16, u32x8, u32x16};
use fearless_simd_macros::simd;

/// Rows of a tile, and one more: rows are taken in pairs.
const ROWS: usize = TILE as usize + 1;

/// Background of each row of a tile, linear and encoded, apart: pairs of them would be copied piece by piece.
struct Behind {
    linear: [Vec4; ROWS],
    encoded: [u32; ROWS],
}

impl Behind {
    fn new(area: &Area<'_>) -> Self {
        let (mut linear, mut encoded) = ([Vec4::ZERO; ROWS], [0; ROWS]);
        for (y, row) in (0..area.size[1]).zip(0..ROWS) {
            linear[row] = premultiply((area.background)(area.tile[1] + y));
            let as_above = row > 0 && linear[row] == linear[row - 1];
            encoded[row] = if as_above {
                encoded[row - 1]
            } else {
                u32::from_le_bytes(encode_premultiplied(linear[row]))
            };
        }
        Self { linear, encoded }
    }
}

/// Test that the fragments of masked surfaces pass outside of holes.
pub struct MaskTest<'t, 'a> {
    pub lit: &'t mut Lit<'a>,
    pub tile: [i32; 2],
}

impl FragmentTest for MaskTest<'_, '_> {
    fn pass<S: Simd>(
        &mut self,
        simd: S,
        write: S::i32s,
        t: &ScreenTriangle,
        at: [i32; 2],
        (_, shift): (usize, u32),
    ) -> S::i32s {
        let Self { lit, tile } = self;
        one_by_one(simd, write, at, shift, |x, y, _| {
            lit.passes_mask(t.item, tile[0] + x, tile[1] + y)
        })
    }
}

/// Lights everything that is visible in a tile.
pub fn resolve<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    blended: &Blended,
    (batch, queue): (&mut Batch, &mut PointQueue),
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    codes: &mut Codes,
) {
    resolve_opaque(simd, (planes, known), (batch, queue), lit, area, codes);
    if blended.any() {
        resolve_blended(simd, planes, blended, lit, area, codes);
    }
}

/// Resolves all pixels of a tile without blended surfaces.
#[simd]
fn resolve_opaque<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    (batch, queue): (&mut Batch, &mut PointQueue),
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    codes: &mut Codes,
) {
    let Behind { linear: behind, encoded } = Behind::new(area);
    // Filled again for each block, but not cleared.
    let mut samples = [u32x16::splat(simd, NO_ITEM); MOST_SAMPLES];
    // Two rows of eight pixels at a time, and then those below: they show mostly the same triangles.
    for x in (0..area.size[0]).step_by(8) {
        let width = 8.min(area.size[0] - x) as usize;
        expect_column(simd, (planes, known), x, area.size[1], lit);
        for y in (0..area.size[1]).step_by(2) {
            let at = [area.tile[0] + x, area.tile[1] + y];
            let patch = Patch::block(at);
            let [first, second] = [y, y + 1].map(|y| (y * TILE + x) as usize);
            let row = y as usize % TILE as usize;
            let count = samples_of_block(simd, planes, first, &mut samples);
            // The last row may have no row below; then the pixels written there are not copied.
            let places = [first, second];
            let samples = &samples[..count];
            // If the samples show few items of one plain run, these are lit together, weighted by their samples.
            let few = samples.first().is_some_and(|first| patch.shows_few(simd, *first));
            if few
                && !knows_any(simd, planes, known, places)
                && batch.light_samples(simd, lit, samples, patch, places, codes)
            {
                continue;
            }
            // Otherwise pixels whose samples all show one item are lit once; the others go to the queue.
            let (above, above_differs) = whole_pixels(simd, planes, first);
            let (below, below_differs) = whole_pixels(simd, planes, second);
            let differs = [above_differs, below_differs];
            codes[first..first + 8].fill(encoded[row]);
            codes[second..second + 8].fill(encoded[row + 1]);
            let whole = simd.combine_u32x8(above, below);
            if whole.simd_ne(u32x16::splat(simd, NO_ITEM)).any_true() {
                batch.light(simd, lit, (whole, known), patch, [first, second], codes);
            }
            for i in 0..2.min(area.size[1] - y) as usize {
                if differs[i] != [0; 8] {
                    let behind = behind[row + i];
                    let (differs, at) = (&differs[i][..width], [at[0], at[1] + i as i32]);
                    let row = Row { planes, known, index: places[i], differs, behind, at };
                    add_mixed(simd, &row, queue, lit);
                }
            }
        }
    }
    Batch::flush(simd, batch, lit, codes);
    PointQueue::flush(simd, queue, lit);
    // Sums of the queue are encoded after all of them were lit.
    for pixel in queue.pixels.drain(..) {
        codes[pixel as usize] =
            u32::from_le_bytes(encode_premultiplied(queue.sums[pixel as usize]));
    }
}

/// Prepares the items that a column of eight pixels shows for lighting.
#[inline(always)]
fn expect_column<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    x: i32,
    height: i32,
    lit: &mut Lit<'_>,
) {
    let none = u32x16::splat(simd, NO_ITEM);
    let any_known = known.any();
    for plane in planes {
        // Rows with 64 items in all: one bit for each item marks it as requested.
        let (rows, across) = if plane.shift > 0 { (2, 32) } else { (8, 8) };
        let (mut before, mut before_that) = (none, none);
        for y in (0..height as usize).step_by(rows) {
            let first = y * TILE as usize + x as usize;
            let mut left = 0;
            for quarter in 0..4 {
                let mut new;
                if plane.shift > 0 {
                    // Four pixels, alternately the left and the right half of eight, of four samples each.
                    let items = plane.items_of_eight(first + quarter / 2 * TILE as usize);
                    let half = quarter % 2 * 16;
                    let shown = u32x16::from_slice(simd, &items[half..half + 16]);
                    new = first_shown(simd, shown, before_that).to_bitmask();
                    (before_that, before) = (before, shown);
                    if any_known {
                        let sample = 4 * (first + quarter / 2 * TILE as usize) + half;
                        new &= !known.of_sixteen(simd, sample, shown).to_bitmask();
                    }
                } else {
                    // Eight pixels, and those below them.
                    let upper = first + 2 * quarter * TILE as usize;
                    let lower = upper + TILE as usize;
                    let above = u32x8::from_slice(simd, plane.items_of_eight(upper));
                    let below = u32x8::from_slice(simd, plane.items_of_eight(lower));
                    let shown = simd.combine_u32x8(above, below);
                    new = first_shown(simd, shown, simd.slide_u32x16::<8>(before, shown))
                        .to_bitmask();
                    before = shown;
                    if any_known {
                        let above = known.of_eight(simd, upper, above).to_bitmask();
                        let below = known.of_eight(simd, lower, below).to_bitmask();
                        new &= !(above | below << 8);
                    }
                }
                left |= new << (16 * quarter);
            }
            // Each marked item is requested; all are prepared together at the end.
            while left != 0 {
                let bit = left.trailing_zeros() as usize;
                left &= left - 1;
                let items = plane.items_of_eight(first + bit / across * TILE as usize);
                lit.expect(items[bit % across]);
            }
        }
    }
    lit.make_ready();
}

/// Returns which of sixteen consecutive items differ from the item before, the one above, and the one beside that: most
/// items that those pixels show have been requested.
#[inline(always)]
fn first_shown<S: Simd>(simd: S, shown: u32x16<S>, above: u32x16<S>) -> mask32x16<S> {
    let none = u32x16::splat(simd, NO_ITEM);
    let beside = simd.slide_u32x16::<15>(none, shown);
    let above_left = simd.slide_u32x16::<15>(none, above);
    let above_right = simd.slide_u32x16::<1>(above, none);
    let new = shown.simd_ne(none) & shown.simd_ne(beside) & shown.simd_ne(above);
    new & shown.simd_ne(above_left) & shown.simd_ne(above_right)
}

/// Returns the item that each of eight pixels in a row shows at all samples, or [`NO_ITEM`]; and a number that is 0
/// only where all samples show the same item.
#[inline(always)]
fn whole_pixels<S: Simd>(simd: S, planes: &[SamplePlane], index: usize) -> (u32x8<S>, [u32; 8]) {
    let [first, mut differs] = planes[0].eight(simd, index);
    for plane in &planes[1..] {
        let [other, differs_there] = plane.eight(simd, index);
        differs |= differs_there | (first ^ other);
    }
    // All bits of NO_ITEM are set.
    let same = differs.simd_eq(u32x8::splat(simd, 0));
    (same.select(first, u32x8::splat(simd, NO_ITEM)), differs.into())
}

/// Returns the items at the samples of sixteen pixels, eight in each of two rows; and the number of
/// samples, none if pixels have only one.
#[inline(always)]
fn samples_of_block<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    index: usize,
    samples: &mut [u32x16<S>; MOST_SAMPLES],
) -> usize {
    let fours = planes.iter().filter(|plane| plane.shift > 0);
    let mut count = 0;
    for plane in fours {
        block_of(simd, &plane.item, index, &mut samples[count..count + 4]);
        count += 4;
    }
    count
}

/// Returns whether the normal of anything that a block shows is known, in rows of pixels that begin at these places.
#[inline(always)]
fn knows_any<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    known: &KnownNormals,
    places: [usize; 2],
) -> bool {
    let [plane] = planes else { return false };
    known.any()
        && places.into_iter().any(|pixel| {
            let (sixteens, _) = plane.items_of_eight(pixel).as_chunks::<16>();
            sixteens.iter().enumerate().any(|(i, items)| {
                let shown = u32x16::from_slice(simd, items);
                let sample = (pixel << plane.shift) + 16 * i;
                let known = known.of_sixteen(simd, sample, shown);
                (known & shown.simd_ne(u32x16::splat(simd, NO_ITEM))).any_true()
            })
        })
}

/// Pixels side by side.
struct Row<'r> {
    planes: &'r [SamplePlane],
    known: &'r KnownNormals,
    /// The place of the first in the tile, and on the screen.
    index: usize,
    at: [i32; 2],
    /// For each a number that is 0 only where all its samples show the same.
    differs: &'r [u32],
    /// Colour behind them, linear and premultiplied.
    behind: Vec4,
}

/// Adds the pixels of a row that show several items, or one and the background: each item is lit once and weighted by
/// its samples.
#[inline(always)]
fn add_mixed<S: Simd>(simd: S, row: &Row<'_>, queue: &mut PointQueue, lit: &mut Lit<'_>) {
    let Row { planes, index, at: [x, y], differs, .. } = *row;
    for i in (0..differs.len()).filter(|&i| differs[i] != 0) {
        let (pixel, at) = (index + i, [x + i as i32, y]);
        queue.begin(pixel as u32);
        if let [plane] = planes
            && let Ok(items) = <&[u32; 4]>::try_from(plane.items(pixel))
        {
            add_shares(simd, items, (pixel, at), row, queue, lit);
        } else {
            let (items, _) = sample_items(planes, pixel);
            add_shares(simd, &items, (pixel, at), row, queue, lit);
        }
    }
}

/// Adds the share of each item, and of the background, in the samples of a pixel.
#[inline(always)]
fn add_shares<S: Simd, const N: usize>(
    simd: S,
    items: &[u32; N],
    (pixel, at): (usize, [i32; 2]),
    row: &Row<'_>,
    queue: &mut PointQueue,
    lit: &mut Lit<'_>,
) {
    let mut left = (1u32 << N) - 1;
    while left != 0 {
        let sample = left.trailing_zeros() as usize % N;
        let item = items[sample];
        let mut same = 0u32;
        for (i, other) in items.iter().enumerate() {
            same |= u32::from(*other == item) << i;
        }
        left &= !same;
        let weight = same.count_ones() as f32 * (1.0 / N as f32);
        if item == NO_ITEM {
            queue.add_color(pixel as u32, row.behind, weight);
        } else {
            let normal = row.known.of_sample(N * pixel + sample, item);
            queue.add(simd, lit, ShadingPoint { item, at, pixel: pixel as u32, weight }, normal);
        }
    }
}

/// Returns the items at all samples of a pixel, and how many samples there are.
#[inline(always)]
fn sample_items(planes: &[SamplePlane], pixel: usize) -> ([u32; MOST_SAMPLES], usize) {
    let (mut items, mut count) = ([NO_ITEM; MOST_SAMPLES], 0);
    for plane in planes {
        for &item in plane.items(pixel) {
            items[count] = item;
            count += 1;
        }
    }
    (items, count)
}
