//! From the visible items of a tile to colours: each triangle is lit once per pixel, the samples of
//! a pixel are averaged in linear light, blended surfaces are laid over from far to near.

use super::blended::{Blended, resolve_blended};
use super::rasterize::{FragmentTest, one_by_one};
use super::tile::{SamplePlane, TILE, TILE_PIXELS, block_of};
use crate::math::Vec4;
use crate::shade::color::{encode_opaque_x16, premultiply};
use crate::target::NO_ITEM;
use crate::visibility::surface::lit::{Batch, KnownNormals, Lit, MOST_SAMPLES, Shares};
use crate::visibility::surface::mixed::{Mixed, encode};
use crate::visibility::surface::patch::Patch;
use crate::visibility::surface::setup::ScreenTriangle;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, mask32x16, u32x8, u32x16};
use fearless_simd_macros::simd;

/// Rows of a tile, and one more: rows are taken in pairs.
const ROWS: usize = TILE as usize + 1;

/// Fewer patches that show one item are lit like others.
pub(super) const FEWEST_OF_STRIP: usize = 4;

/// What is behind each row of a tile, linear and encoded, apart: pairs of them would be copied piece by piece.
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
            encoded[row] =
                if as_above { encoded[row - 1] } else { u32::from_le_bytes(encode(linear[row])) };
        }
        Self { linear, encoded }
    }
}

/// Lets the fragments of masked surfaces pass where they are.
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

/// Where a tile lies in the picture, and what is behind everything.
pub struct Area<'b> {
    /// The upper left pixel.
    pub tile: [i32; 2],
    /// Pixels across and down.
    pub size: [i32; 2],
    /// The item that all samples show, where it is known.
    pub alone: Option<u32>,
    /// Linear with straight alpha, by row of the picture.
    pub background: &'b (dyn Fn(i32) -> Vec4 + Sync),
}

/// The pixels of a tile, row by row: of each the four bytes of its colour, the first one lowest.
///
/// They are written here and copied to the picture when all are there: rows of the picture lie far apart, and
/// going to and fro between them would make each store wait.
pub type Codes = [u32; TILE_PIXELS];

/// Lights everything that is visible in a tile.
pub fn resolve<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    blended: &Blended,
    (batch, mixed): (&mut Batch, &mut Mixed),
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    codes: &mut Codes,
) {
    resolve_opaque(simd, (planes, known), (batch, mixed), lit, area, codes);
    if blended.any() {
        resolve_blended(simd, planes, blended, lit, area, codes);
    }
}

/// All pixels of a tile without blended surfaces.
#[simd]
fn resolve_opaque<S: Simd>(
    simd: S,
    (planes, known): (&[SamplePlane], &KnownNormals),
    (batch, mixed): (&mut Batch, &mut Mixed),
    lit: &mut Lit<'_>,
    area: &Area<'_>,
    codes: &mut Codes,
) {
    let mut behind_rows = None;
    // Filled anew for each block, but not cleared.
    let mut samples = [u32x16::splat(simd, NO_ITEM); MOST_SAMPLES];
    // Two rows of eight pixels at a time, and then those below: they show mostly the same triangles.
    for x in (0..area.size[0]).step_by(8) {
        let width = 8.min(area.size[0] - x) as usize;
        let (mut y, mut strips, mut expected) = (0, true, false);
        while y < area.size[1] {
            let at = [area.tile[0] + x, area.tile[1] + y];
            if strips {
                let place = ([x, y], area.size[1], area.alone);
                match light_strip(simd, planes, place, lit, at, codes) {
                    Some(0) => {}
                    Some(count) => {
                        y += 2 * count as i32;
                        continue;
                    }
                    None => strips = false,
                }
            }
            if !expected {
                expect_column(simd, (planes, known), x, area.size[1], lit);
                expected = true;
            }
            let Behind { linear: behind, encoded } =
                behind_rows.get_or_insert_with(|| Behind::new(area));
            let patch = Patch::block(at);
            let [first, second] = [y, y + 1].map(|y| (y * TILE + x) as usize);
            let row = y as usize % TILE as usize;
            let count = samples_of_block(simd, planes, first, &mut samples);
            let both = [behind[row], behind[row + 1]];
            // Of the last row there may be none below; then what is written there is not copied.
            let places = [first, second];
            let samples = &samples[..count];
            if resolve_block(simd, samples, (batch, lit), both, patch, places, codes) {
                y += 2;
                continue;
            }
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
                    add_mixed(simd, planes, [first, second][i], differs, mixed, lit, behind, at);
                }
            }
            y += 2;
        }
    }
    Batch::flush(simd, batch, lit, codes);
    Mixed::flush(simd, mixed, lit);
    for pixel in mixed.pixels.drain(..) {
        codes[pixel as usize] = u32::from_le_bytes(encode(mixed.sums[pixel as usize]));
    }
}

/// Lights the patches from a place in a column on that show one item at all samples, if they are several and its material
/// suits that: how many they are. `None` where too many texels are between them, so that there is no use in asking again.
#[inline(always)]
fn light_strip<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    ([x, y], height, alone): ([i32; 2], i32, Option<u32>),
    lit: &mut Lit<'_>,
    at: [i32; 2],
    codes: &mut Codes,
) -> Option<usize> {
    let first = (y * TILE + x) as usize;
    let item = planes.first().map_or(NO_ITEM, |plane| plane.items(first)[0]);
    if item == NO_ITEM || !lit.suits_strips(item) {
        return Some(0);
    }
    let count = match alone {
        Some(_) => (height - y + 1) as usize / 2,
        None => patches_of_one(simd, planes, [x, y], height, item),
    };
    if count < FEWEST_OF_STRIP {
        return Some(0);
    }
    let place = (&mut codes[first..], TILE as usize);
    Lit::strip(simd, lit, item, (at, count), place).then_some(count)
}

/// How many patches from a place on one below another show an item at all samples.
#[inline(always)]
fn patches_of_one<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    [x, first]: [i32; 2],
    height: i32,
    item: u32,
) -> usize {
    let mut last = height;
    for plane in planes {
        for y in first..last {
            let mut differs = u32x8::splat(simd, 0);
            for eight in plane.items_of_eight((y * TILE + x) as usize).as_chunks::<8>().0 {
                differs |= u32x8::from_slice(simd, eight) ^ item;
            }
            if differs.simd_ne(u32x8::splat(simd, 0)).any_true() {
                last = y;
                break;
            }
        }
    }
    // Of the last patch of a picture there may be but one row.
    if last == height { (last - first + 1) as usize / 2 } else { (last - first) as usize / 2 }
}

/// Makes what a column of eight pixels shows ready to be lit.
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
        // Rows with 64 items in all: a bit of each says whether it is asked for.
        let (rows, across) = if plane.shift > 0 { (2, 32) } else { (8, 8) };
        let (mut before, mut before_that) = (none, none);
        for y in (0..height as usize).step_by(rows) {
            let first = y * TILE as usize + x as usize;
            let mut left = 0;
            for quarter in 0..4 {
                let mut new;
                if plane.shift > 0 {
                    // Four pixels, in turn to the left and to the right, of four samples each.
                    let items = plane.items_of_eight(first + quarter / 2 * TILE as usize);
                    let half = quarter % 2 * 16;
                    let shown = u32x16::from_slice(simd, &items[half..half + 16]);
                    new = first_shown(simd, shown, before_that).to_bitmask();
                    (before_that, before) = (before, shown);
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

/// Which of sixteen items beside each other are shown neither by the one before nor above nor beside that: most that are
/// shown there have been asked for.
#[inline(always)]
fn first_shown<S: Simd>(simd: S, shown: u32x16<S>, above: u32x16<S>) -> mask32x16<S> {
    let none = u32x16::splat(simd, NO_ITEM);
    let beside = simd.slide_u32x16::<15>(none, shown);
    let above_left = simd.slide_u32x16::<15>(none, above);
    let above_right = simd.slide_u32x16::<1>(above, none);
    let new = shown.simd_ne(none) & shown.simd_ne(beside) & shown.simd_ne(above);
    new & shown.simd_ne(above_left) & shown.simd_ne(above_right)
}

/// Of eight pixels in a row the item that they show at all samples, [`NO_ITEM`] where there is none;
/// and a number that is 0 only where all samples show the same.
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

/// Of sixteen pixels, eight in each of two rows, the item at each sample; how many samples there are, none
/// where pixels have but one.
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

/// Sixteen pixels with the given samples each, where they show few items of plain materials on something
/// opaque: each item is lit at all of them, now or with others, and weighted by its samples. Not true where it is not so.
#[inline(always)]
fn resolve_block<S: Simd>(
    simd: S,
    samples: &[u32x16<S>],
    (batch, lit): (&mut Batch, &mut Lit<'_>),
    [above, below]: [Vec4; 2],
    patch: Patch,
    places: [usize; 2],
    codes: &mut Codes,
) -> bool {
    let Some(first) = samples.first() else { return false };
    if above.w < 1.0 || below.w < 1.0 || !patch.shows_few(simd, *first) {
        return false;
    }
    // All bits of NO_ITEM are set.
    let mut all = *first;
    for items in samples {
        all &= *items;
    }
    if all.simd_eq(u32x16::splat(simd, NO_ITEM)).all_true() {
        return false;
    }
    if batch.light_samples(simd, lit, samples, patch, places, codes) {
        return true;
    }
    let (above, below) = (above.to_array(), below.to_array());
    let mut behind = [f32x16::splat(simd, 0.0); 3];
    for (i, to) in behind.iter_mut().enumerate() {
        *to = simd.combine_f32x8(simd.splat_f32x8(above[i]), simd.splat_f32x8(below[i]));
    }
    let mut sums = [f32x16::splat(simd, 0.0); 3];
    let mut shares = Shares::new(simd, samples);
    while let Some((item, weight)) = shares.next(simd) {
        let mut colors = behind;
        if item != NO_ITEM {
            let Some(shaded) = lit.colors_of_one_x16(simd, item, patch) else { return false };
            for (to, from) in colors.iter_mut().zip(&shaded) {
                *to = f32x16::from_slice(simd, from);
            }
        }
        for (sum, color) in sums.iter_mut().zip(colors) {
            *sum += color * weight;
        }
    }
    let (above, below) = simd.split_u32x16(encode_opaque_x16(simd, sums));
    above.store_slice(&mut codes[places[0]..places[0] + 8]);
    below.store_slice(&mut codes[places[1]..places[1] + 8]);
    true
}

/// Of eight pixels in a row, those that show several items, or one and the background: each item is
/// lit once and weighted by its samples.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "one call, all of it a tile's state")]
fn add_mixed<S: Simd>(
    simd: S,
    planes: &[SamplePlane],
    index: usize,
    differs: &[u32],
    mixed: &mut Mixed,
    lit: &mut Lit<'_>,
    behind: Vec4,
    [x, y]: [i32; 2],
) {
    for i in (0..differs.len()).filter(|&i| differs[i] != 0) {
        let (pixel, at) = ((index + i) as u32, [x + i as i32, y]);
        mixed.begin(pixel);
        if let [plane] = planes
            && let Ok(items) = <&[u32; 4]>::try_from(plane.items(index + i))
        {
            add_shares(simd, items, mixed, lit, behind, pixel, at);
        } else {
            let (items, _) = sample_items(planes, index + i);
            add_shares(simd, &items, mixed, lit, behind, pixel, at);
        }
    }
}

/// Adds what each item, and the background, has of the samples of a pixel.
#[inline(always)]
fn add_shares<S: Simd, const N: usize>(
    simd: S,
    items: &[u32; N],
    mixed: &mut Mixed,
    lit: &mut Lit<'_>,
    behind: Vec4,
    pixel: u32,
    at: [i32; 2],
) {
    let mut left = (1u32 << N) - 1;
    while left != 0 {
        let item = items[left.trailing_zeros() as usize % N];
        let mut same = 0u32;
        for (i, other) in items.iter().enumerate() {
            same |= u32::from(*other == item) << i;
        }
        left &= !same;
        let weight = same.count_ones() as f32 * (1.0 / N as f32);
        if item == NO_ITEM {
            mixed.add_color(pixel, behind, weight);
        } else {
            mixed.add(simd, lit, item, pixel, weight, at);
        }
    }
}

/// The items at all samples of a pixel, and how many samples there are.
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
