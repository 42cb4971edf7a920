//! The list of visible points that wait for light, and the colours of their pixels.
//!
//! Points come in blocks of pixels or one by one from anywhere. Both become groups of sixteen points of one run. Groups
//! whose normals are settled wait until there are enough of them to be lit in one loop, whose iterations are
//! independent; others are lit at once.

use super::known::Known;
use super::shares::Shares;
use super::{Lit, RunInfo, opaque};
use crate::math::Vec4;
use crate::shade::lane::Vec3Lane;
use crate::shade::{Faces, Frame, Points, shade_frame, shade_points};
use crate::target::NO_ITEM;
use crate::visibility::surface::gather::Gathered;
use crate::visibility::surface::points::normal_plane::NormalPlane;
use crate::visibility::surface::points::patch::Patch;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x16, u32x16};
use fearless_simd_macros::simd;

/// Points of a group, and pixels of a block.
const LANES: usize = 16;

/// Up to this many groups wait.
const MOST: usize = 32;

/// Linear, premultiplied red, green, blue and alpha of the pixels of a block.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub struct BlockSums(pub [[f32; LANES]; 4]);

/// A point of an item, seen at the centre of a pixel.
#[derive(Debug, Clone, Copy)]
pub struct ShadingPoint {
    /// The item.
    pub item: u32,
    /// The pixel on the screen.
    pub at: [i32; 2],
    /// The place of the pixel whose sum the colour is added to: its block times 16 and its lane.
    pub place: u32,
    /// Weight of the colour there.
    pub weight: f32,
}

/// Sixteen points of one plain run under lights from infinitely far away, whose normals are settled.
struct Group {
    /// The first item of the run.
    first_item: u32,
    /// By axis: normals of any length, then of unit length, then colours.
    vectors: [[f32; LANES]; 3],
    /// By axis: vectors to the eye, then of unit length.
    views: [[f32; LANES]; 3],
    /// Weights of the colours; 0 where there is no point.
    weights: [f32; LANES],
    to: Destination,
}

/// The pixels whose sums the colours of a group are added to.
#[derive(Clone, Copy)]
enum Destination {
    /// Those of a block.
    Block(usize),
    /// Any, by their places.
    Places([u32; LANES]),
}

/// Points of one plain run, collected until they fill a group.
#[derive(Default)]
struct Singles {
    count: usize,
    /// The first item of the run.
    first_item: u32,
    items: [u32; LANES],
    at: [[i32; 2]; LANES],
    places: [u32; LANES],
    weights: [f32; LANES],
    /// The points whose normals are in `normals`, as bits.
    known: u64,
    normals: Gathered,
}

/// The points that are to be lit, and the sums of the pixels' colours so far.
///
/// Points add red, green and blue. Alpha is set with the background, because all points are opaque.
pub struct PointQueue {
    /// By block.
    pub sums: Vec<BlockSums>,
    waiting: Vec<Group>,
    singles: Singles,
}

impl PointQueue {
    /// Makes an empty queue for pixels that are numbered from 0.
    pub fn new(pixels: usize) -> Self {
        let sums = vec![BlockSums::default(); pixels.div_ceil(LANES)];
        Self { sums, waiting: Vec::new(), singles: Singles::default() }
    }

    /// Sets the sums of all pixels.
    pub fn fill(&mut self, color: Vec4) {
        self.sums.fill(BlockSums(color.to_array().map(|channel| [channel; LANES])));
    }

    /// Sets the sum of a pixel.
    #[inline(always)]
    pub fn set(&mut self, place: usize, color: Vec4) {
        let sums = &mut self.sums[place / LANES].0;
        for (sum, value) in sums.iter_mut().zip(color.to_array()) {
            sum[place % LANES] = value;
        }
    }

    /// Adds a colour's share to the sum of a pixel.
    #[inline(always)]
    pub fn add_color(&mut self, place: usize, color: Vec4, weight: f32) {
        let sums = &mut self.sums[place / LANES].0;
        for (sum, value) in sums.iter_mut().zip((color * weight).to_array()) {
            sum[place % LANES] += value;
        }
    }

    /// Lights the pixels of a block that show an item, at least one, now or at the latest by [`Self::flush`]. Some of
    /// their normals may be known, if these are settled and all that lighting needs.
    #[inline(always)]
    pub fn light_block<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        (shown, known): (u32x16<S>, Option<Known<S>>),
        (block, patch): (usize, Patch),
    ) {
        let items: [u32; LANES] = shown.into();
        let there = shown.simd_ne(u32x16::splat(simd, NO_ITEM));
        let weights = there.select(f32x16::splat(simd, 1.0), f32x16::splat(simd, 0.0));
        let (there, to) = (there.to_bitmask(), Destination::Block(block));
        let info = lit.run_info(items[there.trailing_zeros() as usize % LANES]);
        let mine = (shown - info.first_item).simd_lt(u32x16::splat(simd, info.count));
        if info.is_plain() && mine.to_bitmask() == there {
            let points = lit.points_known(simd, info.run, (shown, &items), there, (patch, known));
            return self.take(simd, lit, &info, &points, weights, &to);
        }
        let mut colors = [[0.0; LANES]; 4];
        Lit::colors_x16(simd, lit, shown, patch, &mut colors);
        add(simd, &mut self.sums, opaque(simd, &colors), weights, &to);
    }

    /// Lights all items of a block whose pixels have the given samples, weighted by their samples, at the latest by
    /// [`Self::flush`]. Returns `false` and takes none of them if they include background, if their materials, lights
    /// or normals need more than normals, or if they belong to several runs.
    #[inline(always)]
    pub fn light_samples<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        samples: &[u32x16<S>],
        (block, patch): (usize, Patch),
    ) -> bool {
        if self.waiting.len() >= MOST {
            Self::light(simd, self, lit);
        }
        let (first, mut run) = (self.waiting.len(), None);
        let mut shares = Shares::new(simd, samples);
        while let Some((item, weights)) = shares.next(simd) {
            let Some(plane) = plane_of(lit, item, &mut run) else {
                self.waiting.truncate(first);
                return false;
            };
            let normal = plane.of_patch(simd, patch);
            let left = self.share(simd, first, normal, weights);
            if left.simd_gt(f32x16::splat(simd, 0.0)).any_true() {
                let [x, y, z] = normal;
                // Pixels that do not show this item keep the normals of other items, with zero weight.
                self.waiting.push(Group {
                    first_item: run.unwrap_or_default(),
                    vectors: [x.into(), y.into(), z.into()],
                    views: stored(lit.sight.towards_eye_x16(simd, patch)),
                    weights: left.into(),
                    to: Destination::Block(block),
                });
            }
        }
        true
    }

    /// Adds an item of a block, with its normals and weights, to the groups from `first` on, where these have free
    /// lanes, and returns the weights of the lanes that have not found one. The items of each pixel keep their order;
    /// items of different pixels share groups.
    #[inline(always)]
    fn share<S: Simd>(
        &mut self,
        simd: S,
        first: usize,
        normal: [f32x16<S>; 3],
        weights: f32x16<S>,
    ) -> f32x16<S> {
        let zero = f32x16::splat(simd, 0.0);
        let mut left = weights.simd_gt(zero);
        for Group { vectors, weights: of_group, .. } in &mut self.waiting[first..] {
            let of_others = f32x16::from_slice(simd, of_group);
            let here = left & of_others.simd_eq(zero);
            here.select(weights, of_others).store_slice(of_group);
            for (to, from) in vectors.iter_mut().zip(normal) {
                here.select(from, f32x16::from_slice(simd, to)).store_slice(to);
            }
            left &= !here;
        }
        left.select(weights, zero)
    }

    /// Adds a point of an item, which is lit now or at the latest by [`Self::flush`]; its normal is given if it is
    /// known, settled, and all that lighting needs.
    #[inline(always)]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        point: ShadingPoint,
        normal: Option<&[f32; 4]>,
    ) {
        let info = lit.run_info(point.item);
        if !info.is_plain() {
            let color = lit.color(point.item, point.at[0], point.at[1]);
            return self.add_color(point.place as usize, color.with_w(0.0), point.weight);
        }
        if self.singles.count > 0 && self.singles.first_item != info.first_item {
            Self::group_singles(simd, self, lit);
        }
        let singles = &mut self.singles;
        let lane = singles.count % LANES;
        singles.first_item = info.first_item;
        singles.items[lane] = point.item;
        singles.at[lane] = point.at;
        singles.places[lane] = point.place;
        singles.weights[lane] = point.weight;
        if let Some(normal) = normal {
            singles.normals.set(lane, f32x4::from_slice(simd, normal));
            singles.known |= 1 << lane;
        }
        singles.count += 1;
        if singles.count == LANES {
            Self::group_singles(simd, self, lit);
        }
    }

    /// Makes a group of the single points.
    #[simd]
    fn group_singles<S: Simd>(simd: S, this: &mut Self, lit: &mut Lit<'_>) {
        let Singles { count, first_item, items, at, places, weights, known, normals } =
            &mut this.singles;
        let count = std::mem::take(count).min(LANES);
        let (there, known) = ((1 << count) - 1, std::mem::take(known));
        weights[count..].fill(0.0);
        let mut unknown = there & !known;
        while unknown != 0 {
            lit.expect(items[unknown.trailing_zeros() as usize % LANES]);
            unknown &= unknown - 1;
        }
        lit.make_ready();
        let (info, view) = (lit.run_info(*first_item), lit.sight.towards_eye_of(simd, at));
        let known = (known, *normals);
        let points = lit.points_by_pixel(simd, info.run, items, (there, known), (at, view));
        let (weights, to) = (f32x16::from_slice(simd, weights), Destination::Places(*places));
        this.take(simd, lit, &info, &points, weights, &to);
    }

    /// Takes a group of points of one run, which waits if it can, and is lit otherwise.
    #[inline(always)]
    fn take<S: Simd>(
        &mut self,
        simd: S,
        lit: &mut Lit<'_>,
        info: &RunInfo<'_>,
        points: &Points<f32x16<S>>,
        weights: f32x16<S>,
        to: &Destination,
    ) {
        if matches!(points.faces, Faces::Seen(_)) || lit.with_positions() {
            let (material, lights) = (info.material, lit.shared.lights);
            let [r, g, b] = shade_points(simd, points, material, lights, info.shading);
            let Vec3Lane { x, y, z } = loaded(simd, &[r, g, b]);
            return add(simd, &mut self.sums, [x, y, z], weights, to);
        }
        if self.waiting.len() >= MOST {
            Self::light(simd, self, lit);
        }
        self.waiting.push(Group {
            first_item: info.first_item,
            vectors: stored(points.normal),
            views: stored(points.view),
            weights: weights.into(),
            to: *to,
        });
    }

    /// Lights the groups that wait, in three loops: a processor looks ahead by less than the work of one group, but by
    /// several groups of a third of that work.
    #[simd]
    fn light<S: Simd>(simd: S, this: &mut Self, lit: &mut Lit<'_>) {
        let Self { sums, waiting, .. } = this;
        // First the frames: unit normals and directions to the eye.
        for Group { vectors, views, .. } in waiting.iter_mut() {
            let (normal, view) = (loaded(simd, vectors), loaded(simd, views));
            // Positions are not used.
            let points = Points { position: view, view, normal, faces: Faces::Settled };
            let frame = points.frame();
            (*vectors, *views) = (stored(frame.normal), stored(frame.view));
        }
        // Then the light of each frame, run by run.
        let lights = lit.shared.lights;
        for of_run in waiting.chunk_by_mut(|a, b| a.first_item == b.first_item) {
            let RunInfo { material, shading, .. } = lit.run_info(of_run[0].first_item);
            for Group { vectors, views, .. } in of_run {
                let (normal, view) = (loaded(simd, vectors), loaded(simd, views));
                let frame = Frame { view, face: normal, normal };
                *vectors = stored(shade_frame(&frame, view, material, lights, shading));
            }
        }
        // At last the sums.
        for Group { vectors, weights, to, .. } in waiting.iter() {
            let Vec3Lane { x, y, z } = loaded(simd, vectors);
            add(simd, sums, [x, y, z], f32x16::from_slice(simd, weights), to);
        }
        waiting.clear();
    }

    /// Lights all points that have not been lit yet.
    pub fn flush<S: Simd>(simd: S, this: &mut Self, lit: &mut Lit<'_>) {
        if this.singles.count > 0 {
            Self::group_singles(simd, this, lit);
        }
        Self::light(simd, this, lit);
    }
}

/// Returns the normals of an item, if it is of the plain run that begins with `first_item`, or of any where that is not
/// known yet, and if normals are all that its light needs.
#[inline(always)]
fn plane_of<'l>(
    lit: &'l mut Lit<'_>,
    item: u32,
    first_item: &mut Option<u32>,
) -> Option<&'l NormalPlane> {
    if item == NO_ITEM {
        return None;
    }
    let info = lit.run_info(item);
    if !info.is_plain() || *first_item.get_or_insert(info.first_item) != info.first_item {
        return None;
    }
    lit.settled_plane(item, info.run)
}

/// Adds weighted colours to the sums of pixels.
#[inline(always)]
fn add<S: Simd>(
    simd: S,
    sums: &mut [BlockSums],
    colors: [f32x16<S>; 3],
    weights: f32x16<S>,
    to: &Destination,
) {
    match to {
        Destination::Block(block) => {
            for (sum, color) in sums[*block].0.iter_mut().zip(colors) {
                (f32x16::from_slice(simd, sum) + color * weights).store_slice(sum);
            }
        }
        Destination::Places(places) => {
            let [r, g, b] = colors;
            let (r, g, b) = (r * weights, g * weights, b * weights);
            let colors: [[f32; LANES]; 3] = [r.into(), g.into(), b.into()];
            for (lane, &place) in places.iter().enumerate() {
                let sums = &mut sums[place as usize / LANES].0;
                for (sum, color) in sums.iter_mut().zip(&colors) {
                    sum[place as usize % LANES] += color[lane];
                }
            }
        }
    }
}

#[inline(always)]
fn stored<S: Simd>(v: Vec3Lane<f32x16<S>>) -> [[f32; LANES]; 3] {
    [v.x.into(), v.y.into(), v.z.into()]
}

#[inline(always)]
fn loaded<S: Simd>(simd: S, [x, y, z]: &[[f32; LANES]; 3]) -> Vec3Lane<f32x16<S>> {
    let (x, y) = (f32x16::from_slice(simd, x), f32x16::from_slice(simd, y));
    Vec3Lane::new(x, y, f32x16::from_slice(simd, z))
}
