//! Lighting patches one below another that show one item, where nothing but its texture is asked for: what is the same
//! for all of them is found once.

use super::Lit;
use crate::shade::color::Encoding;
use crate::shade::{MOST_PATCHES, PreparedMaterial, Strip};
use crate::visibility::surface::patch::Patch;
use crate::visibility::surface::textured::CoordsOfOne;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16};
use fearless_simd_macros::simd;

/// Patches whose colours become codes at a time.
const AT_ONCE: usize = 8;

/// What strips are lit in, one after the other.
pub struct Room {
    strip: Strip,
    /// Colours on their way to codes.
    waiting: [Encoding; AT_ONCE],
}

impl Default for Room {
    fn default() -> Self {
        Self { strip: Strip::default(), waiting: [Encoding::NONE; AT_ONCE] }
    }
}

impl Lit<'_> {
    /// Whether the material of an item suits [`Self::strip`].
    #[inline(always)]
    pub fn suits_strips(&mut self, item: u32) -> bool {
        self.run_info(item).looked_up.is_some_and(|looked_up| looked_up.in_strips)
    }

    /// Makes an item ready to be lit at blocks of pixels, the first of which is given, and so many below it. Not true where
    /// its material or its texels do not suit that.
    #[inline(always)]
    fn lay_strip<S: Simd>(
        &mut self,
        simd: S,
        item: u32,
        (at, count): ([i32; 2], usize),
    ) -> Option<(&mut Room, &PreparedMaterial<'_>)> {
        let info = self.run_info(item);
        let looked_up = info.looked_up.filter(|l| l.in_strips && count <= MOST_PATCHES)?;
        let material = info.material;
        let t = self.triangles.get(item, info.run);
        let corners = t.corners.map(|c| looked_up.coords[c as usize]);
        let of_item = CoordsOfOne::new(simd, t, corners);
        let room = &mut **self.strip.get_or_insert_default();
        let strip = &mut room.strip;
        strip.clear();
        for i in 0..count as i32 {
            let patch = Patch::block([at[0], at[1] + 2 * i]);
            let coords = of_item.at(simd, patch, false);
            strip.add(simd, material, coords.uv);
        }
        Strip::decode(simd, strip, material).then_some((room, material))
    }

    /// Lights an item at blocks of pixels, the first of which is given, and so many below it; the codes of rows of eight
    /// pixels go to each `stride`-th place of `codes`. Not true, and nothing is done, where its material or its texels do
    /// not suit that.
    #[simd]
    pub fn strip<S: Simd>(
        simd: S,
        this: &mut Lit<'_>,
        item: u32,
        blocks: ([i32; 2], usize),
        (codes, stride): (&mut [u32], usize),
    ) -> bool {
        let Some((Room { strip, waiting }, material)) = this.lay_strip(simd, item, blocks) else {
            return false;
        };
        let count = blocks.1;
        for first in (0..count).step_by(AT_ONCE) {
            let these = first..count.min(first + AT_ONCE);
            let waiting = &mut waiting[..these.len()];
            for (i, to) in these.clone().zip(&mut *waiting) {
                let (color, _) = strip.color(simd, material, i);
                *to = Encoding::new(simd, [color.x, color.y, color.z]);
            }
            look_up(waiting);
            for (i, from) in these.zip(&*waiting) {
                let (above, below) = simd.split_u32x16(from.codes(simd));
                let (first, second) = (2 * i * stride, (2 * i + 1) * stride);
                above.store_slice(&mut codes[first..first + 8]);
                below.store_slice(&mut codes[second..second + 8]);
            }
        }
        true
    }

    /// Lights an item as [`Self::strip`], and gives linear red, green, blue and straight alpha of each block.
    #[simd]
    pub fn blended_strip<S: Simd>(
        simd: S,
        this: &mut Lit<'_>,
        item: u32,
        blocks: ([i32; 2], usize),
        mut with: impl FnMut(usize, [f32x16<S>; 4]),
    ) -> bool {
        let Some((Room { strip, .. }, material)) = this.lay_strip(simd, item, blocks) else {
            return false;
        };
        for i in 0..blocks.1 {
            let (color, alpha) = strip.color(simd, material, i);
            with(i, [color.x, color.y, color.z, alpha]);
        }
        true
    }
}

/// Not a part of its caller, in which numbers would be taken from registers one by one.
#[inline(never)]
fn look_up(waiting: &mut [Encoding]) {
    for encoding in waiting {
        encoding.look_up();
    }
}
