//! From the visible items of a tile to colours: each item is lit once per pixel, weighted by its samples, and added to the
//! background in linear light; blended surfaces are laid over; all pixels are encoded.

use super::area::{Area, Codes, block_at, place_of};
use super::blended::{Blended, lay_over};
use super::rasterize::{FragmentTest, one_by_one};
use super::tile::{SamplePlane, TILE, samples_of_block};
use crate::shade::color::encode_premultiplied_x16;
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::{
    BlockSums, KnownNormals, Lit, MOST_SAMPLES, PointQueue, ShadingPoint,
};
use crate::visibility::surface::points::patch::Patch;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x8, u32x16};
use fearless_simd_macros::simd;

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

/// Lights everything that is visible in a tile, and encodes the colours.
pub fn resolve<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    blended: &Blended,
    queue: &mut PointQueue,
    lit: &mut Lit<'_>,
    area: &Area,
    codes: &mut Codes,
) {
    light_opaque(simd, (planes, known), queue, lit, area);
    if blended.any() {
        lay_over(simd, planes, blended, lit, area, &mut queue.sums);
    }
    encode(simd, &queue.sums, area, codes);
}

/// Lights the opaque surfaces of a tile.
#[simd]
fn light_opaque<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    queue: &mut PointQueue,
    lit: &mut Lit<'_>,
    area: &Area,
) {
    // Filled again for each block, but not cleared.
    let mut samples = [u32x16::splat(simd, NO_ITEM); MOST_SAMPLES];
    // Two rows of eight pixels at a time, and then those below: they show mostly the same triangles.
    for x in (0..area.size[0]).step_by(8) {
        expect_column(simd, (planes, known), x, area.size[1], lit);
        for y in (0..area.size[1]).step_by(2) {
            let [first, second] = [y, y + 1].map(|y| (y * TILE + x) as usize);
            let samples = samples_of_block(simd, planes, first, &mut samples);
            resolve_block(simd, (planes, known), samples, [first, second], queue, lit, area);
        }
    }
    PointQueue::flush(simd, queue, lit);
}

/// Lights the pixels of a block, whose rows begin at these pixels of the tile and show the items of `samples`.
#[inline(always)]
fn resolve_block<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    samples: &[u32x16<S>],
    rows: [usize; 2],
    queue: &mut PointQueue,
    lit: &mut Lit<'_>,
    area: &Area,
) {
    let [x, y] = [rows[0] as i32 % TILE, rows[0] as i32 / TILE];
    let block = place_of(x, y) / 16;
    let patch = Patch::block([area.tile[0] + x, area.tile[1] + y]);
    let Shown { whole, mixed, background } = shown(simd, samples);
    begin(simd, &mut queue.sums[block], area.behind(simd, block), background);
    let several = samples.len() > 1;
    let knows = several && knows_any(simd, planes, known, rows);
    // If the samples show few items of one plain run, these are lit together, weighted by their samples.
    if several
        && !knows
        && patch.shows_few(simd, samples[0])
        && queue.light_samples(simd, lit, samples, (block, patch))
    {
        return;
    }
    // Otherwise pixels whose samples all show one item are lit once, and of the others each item is. Normals that are
    // known at samples are added one by one.
    let full = whole.simd_ne(u32x16::splat(simd, NO_ITEM)).to_bitmask();
    let mut mixed = mixed;
    if knows {
        mixed |= full;
    } else if full != 0 {
        let known = known.of_patch(simd, rows, whole);
        queue.light_block(simd, lit, (whole, known), (block, patch));
    }
    let [width, height] = [area.size[0] - x, area.size[1] - y];
    let row = (1 << width.min(8)) - 1;
    mixed &= if height > 1 { row | row << 8 } else { row };
    while mixed != 0 {
        let lane = mixed.trailing_zeros() as usize % 16;
        mixed &= mixed - 1;
        let pixel = rows[lane / 8] + lane % 8;
        let at = (patch.pixel(lane), 16 * block + lane);
        if let [plane] = planes
            && let Ok(items) = <&[u32; 4]>::try_from(plane.items(pixel))
        {
            add_mixed(simd, items, (pixel, known), at, queue, lit);
        } else {
            add_mixed(simd, &items_of(planes, pixel), (pixel, known), at, queue, lit);
        }
    }
}

/// Items and background that the pixels of a block show.
struct Shown<S: Simd> {
    /// The item that all samples of a pixel show, or [`NO_ITEM`].
    whole: u32x16<S>,
    /// Pixels whose samples show several items, or one and the background, as bits.
    mixed: u64,
    /// The share of samples that show the background.
    background: f32x16<S>,
}

/// Returns the items and the background that the pixels of a block with these samples show.
#[inline(always)]
fn shown<S: Simd>(simd: S, samples: &[u32x16<S>]) -> Shown<S> {
    let (none, same) = (u32x16::splat(simd, NO_ITEM), u32x16::splat(simd, 0));
    let (zero, share) = (f32x16::splat(simd, 0.0), f32x16::splat(simd, 1.0 / samples.len() as f32));
    let (first, mut differs, mut background) = (samples[0], same, zero);
    for items in samples {
        differs |= first ^ *items;
        background += items.simd_eq(none).select(share, zero);
    }
    let same = differs.simd_eq(same);
    Shown { whole: same.select(first, none), mixed: (!same).to_bitmask(), background }
}

/// Begins the sums of a block with the background's share. All else is opaque, so that alpha is known.
#[inline(always)]
fn begin<S: Simd>(simd: S, sums: &mut BlockSums, behind: [f32x16<S>; 4], share: f32x16<S>) {
    let zero = f32x16::splat(simd, 0.0);
    let seen = share.simd_gt(zero);
    for (i, (to, channel)) in sums.0.iter_mut().zip(behind).enumerate() {
        let of_background = seen.select(channel * share, zero);
        let of_opaque = if i == 3 { 1.0 - share } else { zero };
        (of_background + of_opaque).store_slice(to);
    }
}

/// Encodes the colours of a tile.
#[simd]
fn encode<S: Simd>(simd: S, sums: &[BlockSums], area: &Area, codes: &mut Codes) {
    for block in area.blocks() {
        let of_block = encode_premultiplied_x16(simd, &sums[block].0);
        let [x, y] = block_at(block);
        for (row, of_row) in [y, y + 1].into_iter().zip(of_block.as_chunks::<8>().0) {
            codes[(row * TILE + x) as usize..][..8].copy_from_slice(of_row);
        }
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

/// Adds the items of a pixel that shows several, or one and the background: each is lit once and weighted by its
/// samples.
#[inline(always)]
fn add_mixed<S: Simd, const N: usize>(
    simd: S,
    items: &[u32; N],
    (pixel, known): (usize, &KnownNormals),
    (at, place): ([i32; 2], usize),
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
        if item != NO_ITEM {
            let weight = same.count_ones() as f32 * (1.0 / N as f32);
            let normal = known.of_sample(N * pixel + sample, item);
            let place = place as u32;
            queue.add(simd, lit, ShadingPoint { item, at, place, weight }, normal);
        }
    }
}

/// Returns the items at sixteen samples of a pixel.
fn items_of(planes: &[SamplePlane], pixel: usize) -> [u32; MOST_SAMPLES] {
    let mut items = [NO_ITEM; MOST_SAMPLES];
    for plane in planes {
        let of_plane = plane.items(pixel);
        items[plane.first..plane.first + of_plane.len()].copy_from_slice(of_plane);
    }
    items
}
