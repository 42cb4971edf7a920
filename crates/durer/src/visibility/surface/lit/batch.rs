//! Patches that are collected until there are enough of them to be lit in one loop, whose iterations are independent.

use super::shares::Shares;
use super::{KnownNormals, Lit, opaque};
use crate::shade::color::encode_opaque_x16;
use crate::shade::lane::Vec3Lane;
use crate::shade::{Faces, Frame, Points, shade_frame};
use crate::target::NO_ITEM;
use crate::visibility::surface::points::normal_plane::NormalPlane;
use crate::visibility::surface::points::patch::Patch;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, u32x8, u32x16};
use fearless_simd_macros::simd;

/// Up to this many patches are collected.
const MOST: usize = 32;

/// Patches of settled points of one plain run under lights from infinitely far away.
#[derive(Default)]
pub struct Batch {
    waiting: Vec<Waiting>,
    /// The first item of their run.
    first_item: u32,
}

/// A patch that waits.
struct Waiting {
    /// By axis: normals of any length, then of unit length, then colours.
    vectors: [[f32; 16]; 3],
    /// By axis: unit vectors to the eye, once they are known.
    views: [[f32; 16]; 3],
    patch: Patch,
    to: Destination,
}

/// Destination of colours.
enum Destination {
    /// Colours of whole pixels.
    Pixels {
        /// The items that they show; [`NO_ITEM`] where they show none.
        shown: [u32; 16],
        /// Places of the two halves.
        places: [usize; 2],
    },
    /// Parts of the colours of pixels, whose other parts are in neighbouring entries of the queue.
    Share {
        /// Weights of the colours.
        weight: [f32; 16],
        /// After the last part: where the two halves go.
        places: Option<[usize; 2]>,
    },
}

impl Batch {
    /// Lights the pixels of a patch that show an item, at least one, now or at the latest by [`Self::flush`]; its
    /// halves of eight pixels go to the given places of `codes`.
    #[inline(always)]
    pub fn light<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        (shown, known): (u32x16<S>, &KnownNormals),
        patch: Patch,
        places: [usize; 2],
        codes: &mut [u32],
    ) {
        let items: [u32; 16] = shown.into();
        let there = shown.simd_ne(u32x16::splat(simd, NO_ITEM)).to_bitmask();
        let info = lit.run_info(items[there.trailing_zeros() as usize % 16]);
        let mine = (shown - info.first_item).simd_lt(u32x16::splat(simd, info.count));
        if !info.is_plain() || lit.with_positions() || mine.to_bitmask() != there {
            let mut colors = [[0.0; 16]; 4];
            Lit::colors_x16(simd, lit, shown, patch, &mut colors);
            return put(simd, opaque(simd, &colors), shown, places, codes);
        }
        let known = known.of_patch(simd, places, shown);
        let points = lit.points_known(simd, info.run, (shown, &items), there, (patch, known));
        if let Faces::Seen(_) = points.faces {
            let Points { position, .. } = points;
            let (material, lights) = (info.material, lit.shared.lights);
            let color = shade_frame(&points.frame(), position, material, lights, info.shading);
            return put(simd, [color.x, color.y, color.z], shown, places, codes);
        }
        let normal = points.normal;
        if self.waiting.len() == MOST || self.first_item != info.first_item {
            Self::flush(simd, self, lit, codes);
        }
        self.first_item = info.first_item;
        let (vectors, views) = (stored(normal), [[0.0; 16]; 3]);
        let to = Destination::Pixels { shown: items, places };
        self.waiting.push(Waiting { vectors, views, patch, to });
    }

    /// Lights all items of a patch whose pixels have the given samples, weighted by their samples; like
    /// [`Self::light`], now or later. Returns `false` and takes none of them if they include background, if their
    /// materials, lights or normals need more than normals, or if they belong to several runs.
    #[inline(always)]
    pub fn light_samples<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        samples: &[u32x16<S>],
        patch: Patch,
        places: [usize; 2],
        codes: &mut [u32],
    ) -> bool {
        if self.waiting.len() >= MOST {
            Self::flush(simd, self, lit, codes);
        }
        let first = self.waiting.len();
        let mut shares = Shares::new(simd, samples);
        while let Some((item, weight)) = shares.next(simd) {
            let Some(plane) = self.plane_of(lit, item) else {
                self.waiting.truncate(first);
                if item != NO_ITEM {
                    // The waiting pixels may belong to a run that is no longer requested.
                    Self::flush(simd, self, lit, codes);
                }
                return false;
            };
            self.share(simd, first, (plane.of_patch(simd, patch), weight), patch);
        }
        if let Some(Waiting { to: Destination::Share { places: of_last, .. }, .. }) =
            self.waiting.last_mut()
        {
            *of_last = Some(places);
        }
        true
    }

    /// Returns the normals of an item, if it may wait with the others.
    #[inline(always)]
    fn plane_of<'l>(&mut self, lit: &'l mut Lit<'_>, item: u32) -> Option<&'l NormalPlane> {
        if item == NO_ITEM {
            return None;
        }
        let info = lit.run_info(item);
        if !info.is_plain() || !self.waiting.is_empty() && self.first_item != info.first_item {
            return None;
        }
        self.first_item = info.first_item;
        lit.settled_plane(item, info.run)
    }

    /// Adds an item of a patch, with its normals and weights, to the queue from the entry `first` on. The items of each
    /// pixel keep their order; items of different pixels share entries.
    #[inline(always)]
    fn share<S: Simd>(
        &mut self,
        simd: S,
        first: usize,
        (normal, weight): ([f32x16<S>; 3], f32x16<S>),
        patch: Patch,
    ) {
        let zero = f32x16::splat(simd, 0.0);
        let mut left = weight.simd_gt(zero);
        for Waiting { vectors, to, .. } in &mut self.waiting[first..] {
            let Destination::Share { weight: weights, .. } = to else { continue };
            let of_others = f32x16::from_slice(simd, weights);
            let here = left & of_others.simd_eq(zero);
            here.select(weight, of_others).store_slice(weights);
            for (to, from) in vectors.iter_mut().zip(normal) {
                here.select(from, f32x16::from_slice(simd, to)).store_slice(to);
            }
            left &= !here;
        }
        if left.any_true() {
            let [x, y, z] = normal;
            let (vectors, views) = ([x.into(), y.into(), z.into()], [[0.0; 16]; 3]);
            // Pixels that do not show this item keep the normals of other items, with zero weight.
            let weight = left.select(weight, zero).into();
            let to = Destination::Share { weight, places: None };
            self.waiting.push(Waiting { vectors, views, patch, to });
        }
    }

    /// Lights the waiting pixels, in three loops: a processor looks ahead by less than the work of one patch, but by
    /// several patches of a third of that work.
    #[simd]
    pub fn flush<S: Simd>(simd: S, this: &mut Self, lit: &mut Lit<'_>, codes: &mut [u32]) {
        if this.waiting.is_empty() {
            return;
        }
        let info = lit.run_info(this.first_item);
        let (sight, lights) = (lit.sight, lit.shared.lights);
        // First the frames: unit normals and directions to the eye.
        for Waiting { vectors, views, patch, .. } in &mut this.waiting {
            let (view, normal) = (sight.towards_eye_x16(simd, *patch), loaded(simd, vectors));
            // Positions are not used.
            let points = Points { position: view, view, normal, faces: Faces::Settled };
            let frame = points.frame();
            (*vectors, *views) = (stored(frame.normal), stored(frame.view));
        }
        // Then the light of each frame.
        for Waiting { vectors, views, .. } in &mut this.waiting {
            let (normal, view) = (loaded(simd, vectors), loaded(simd, views));
            let frame = Frame { view, face: normal, normal };
            *vectors = stored(shade_frame(&frame, view, info.material, lights, info.shading));
        }
        // At last the codes: of whole pixels at once, of shared pixels once the sums of a patch are complete.
        let mut sums = [f32x16::splat(simd, 0.0); 3];
        for Waiting { vectors, to, .. } in &this.waiting {
            let Vec3Lane { x, y, z } = loaded(simd, vectors);
            match to {
                Destination::Pixels { shown, places } => {
                    put(simd, [x, y, z], u32x16::from_slice(simd, shown), *places, codes);
                }
                Destination::Share { weight, places } => {
                    let weight = f32x16::from_slice(simd, weight);
                    sums = [sums[0] + x * weight, sums[1] + y * weight, sums[2] + z * weight];
                    if let Some([first, second]) = *places {
                        let (above, below) = simd.split_u32x16(encode_opaque_x16(simd, sums));
                        above.store_slice(&mut codes[first..first + 8]);
                        below.store_slice(&mut codes[second..second + 8]);
                        sums = [f32x16::splat(simd, 0.0); 3];
                    }
                }
            }
        }
        this.waiting.clear();
    }
}

#[inline(always)]
fn stored<S: Simd>(v: Vec3Lane<f32x16<S>>) -> [[f32; 16]; 3] {
    [v.x.into(), v.y.into(), v.z.into()]
}

#[inline(always)]
fn loaded<S: Simd>(simd: S, [x, y, z]: &[[f32; 16]; 3]) -> Vec3Lane<f32x16<S>> {
    let (x, y) = (f32x16::from_slice(simd, x), f32x16::from_slice(simd, y));
    Vec3Lane::new(x, y, f32x16::from_slice(simd, z))
}

/// Writes the codes of colours where an item is shown.
#[inline(always)]
fn put<S: Simd>(
    simd: S,
    colors: [f32x16<S>; 3],
    shown: u32x16<S>,
    [first, second]: [usize; 2],
    codes: &mut [u32],
) {
    let (above, below) = simd.split_u32x16(encode_opaque_x16(simd, colors));
    let (above_shown, below_shown) = simd.split_u32x16(shown);
    let none = simd.splat_u32x8(NO_ITEM);
    for (new, shown, place) in [(above, above_shown, first), (below, below_shown, second)] {
        let codes = &mut codes[place..place + 8];
        let old = u32x8::from_slice(simd, codes);
        let there = simd.simd_ne_u32x8(shown, none);
        simd.select_u32x8(there, new, old).store_slice(codes);
    }
}
