//! The share of each fragment in the colour of its pixel.

use super::fragment::{Fragment, Pool, plane_depth};
use super::mask::{Direction, MaskTable};
use crate::visibility::surface::LEAST_THROUGH;
use crate::visibility::surface::setup::ScreenTriangle;
use std::cmp::Ordering;

/// Shares of one pixel's fragments in its colour.
#[derive(Debug, Default)]
pub struct Pixel {
    /// Front to back by the nearest depth; one per item.
    pub fragments: Vec<Fragment>,
    /// The share of each, 0 … 1.
    pub shares: Vec<f32>,
    /// The smallest depth and the number in the pool of each.
    order: Vec<u64>,
    /// The sub-pixels at which each is seen.
    visible: Vec<u64>,
    /// Share of the background.
    pub background: f32,
}

/// Position of the pixel, and the faces of its fragments.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    pub triangles: &'a [ScreenTriangle],
    pub table: &'a MaskTable,
    pub x: i32,
    pub y: i32,
}

impl Pixel {
    /// Collects the fragments of a pixel: fragments wholly behind opaque ones that cover the pixel are dropped, pieces
    /// of one face become one fragment, the rest is sorted front to back. `in_pieces` is true if there are such pieces
    /// at all.
    #[inline(always)]
    pub fn begin(&mut self, pool: &Pool<'_>, x: i32, full: u64, in_pieces: bool) {
        let hidden_from = pool.hidden_from(x);
        self.shares.clear();
        self.visible.clear();
        self.fragments.clear();
        self.order.clear();
        for number in pool.latest_first(x) {
            // Depths are at least 0, so that their bits grow with them.
            let z_min = pool.fragment(number).z_min + 0.0;
            if z_min <= hidden_from {
                // The latest are mostly the farthest.
                self.order.push(!(u64::from(z_min.to_bits()) << 32 | u64::from(number)));
                sink(&mut self.order);
            }
        }
        if self.order.len() > FEW {
            self.order.sort_unstable();
        }
        self.fragments.extend(self.order.iter().rev().map(|&key| *pool.fragment(!key as u32)));
        if hidden_from.is_finite() {
            self.drop_hidden(full);
        }
        if in_pieces {
            self.fragments.sort_unstable_by_key(|f| (f.item, f.triangle));
            self.fragments.dedup_by(|next, kept| next.item == kept.item && merge(kept, next));
        }
        sort(&mut self.fragments);
    }

    /// Removes fragments that are completely behind opaque ones that cover the whole pixel. Unlike the depth at which
    /// the pool rejects fragments, the result does not depend on the order in which they were added.
    #[inline(always)]
    fn drop_hidden(&mut self, full: u64) {
        // A fragment that hides the farthest may hide the one before it.
        while let Some(last) = self.fragments.last() {
            let (mut covered, farthest) = (0, last.z_min);
            for f in &self.fragments {
                covered |= if f.z_max < farthest && !f.blended { f.mask } else { 0 };
            }
            if covered != full {
                return;
            }
            self.fragments.pop();
        }
    }

    /// Returns whether surfaces behind it show through.
    #[inline(always)]
    pub fn is_blended(&self) -> bool {
        self.fragments.iter().any(|f| f.blended)
    }

    /// Resolves opaque fragments: by their exact areas, as far as their sub-pixels are seen.
    #[inline(always)]
    pub fn resolve_opaque(&mut self, place: &Place<'_>) {
        if let [only] = self.fragments[..] {
            self.shares.push(only.area);
            self.background = 1.0 - only.area;
            return;
        }
        let (mut left, mut covered, mut twice) = (1.0f32, 0, 0);
        for f in &self.fragments {
            twice |= covered & f.mask;
            covered |= f.mask;
        }
        for i in 0..self.fragments.len() {
            let f = &self.fragments[i];
            let (mut visible, mut area) = (f.seen_by, f.area);
            // Nothing can hide sub-pixels that only this fragment covers.
            if f.mask == 0 || f.mask & twice != 0 {
                visible = self.seen_of(i, twice, place);
                area *= visible.count_ones() as f32 / f.seen_by.count_ones().max(1) as f32;
            }
            let share = area.min(left);
            left -= share;
            self.shares.push(share);
            self.visible.push(visible);
        }
        if covered == place.table.full() && left > 0.0 {
            left = self.give_to_half_hidden(left);
            left = self.give_to_all(left);
        }
        self.background = left;
    }

    /// Returns the sub-pixels at which a fragment is visible; `twice` has the sub-pixels that several fragments cover.
    #[inline(always)]
    fn seen_of(&self, i: usize, twice: u64, place: &Place<'_>) -> u64 {
        let f = &self.fragments[i];
        // All fragments wholly in front of it precede it.
        let before = self.fragments[..i].iter();
        let hidden = before.fold(0, |masks, g| masks | if g.z_max < f.z_min { g.mask } else { 0 });
        let mut visible = f.seen_by & !hidden;
        // The rest is between fragments whose depths overlap.
        if f.mask & twice & visible != 0 {
            for (j, other) in self.fragments.iter().enumerate() {
                if other.z_min > f.z_max {
                    break;
                }
                let common = visible & other.mask;
                if j != i && common != 0 {
                    visible &= !(common & in_front(other, f, place));
                }
            }
        }
        visible
    }

    /// Limits the background's share to the one computed from areas if the masks leave no background. The share that
    /// small fragments lose to their neighbours is distributed among everything visible.
    #[inline(always)]
    fn give_to_all(&mut self, left: f32) -> f32 {
        let areas: f32 = self.fragments.iter().map(|f| f.area).sum();
        let background = (1.0 - areas).clamp(0.0, left);
        if left > background && left < 1.0 {
            let more = (1.0 - background) / (1.0 - left);
            self.shares.iter_mut().for_each(|share| *share *= more);
            return background;
        }
        left
    }

    /// Adds the rest of the areas to fragments that continue behind others, if the masks leave no background.
    #[inline(always)]
    fn give_to_half_hidden(&mut self, mut left: f32) -> f32 {
        for ((f, share), &visible) in self.fragments.iter().zip(&mut self.shares).zip(&self.visible)
        {
            if visible != 0 && visible != f.seen_by {
                let more = (f.area - *share).clamp(0.0, left);
                *share += more;
                left -= more;
            }
        }
        left
    }

    /// Returns whether the fragments come one behind the other in the same order at all sub-pixels.
    pub fn is_in_order(&self) -> bool {
        self.fragments.iter().enumerate().all(|(i, f)| {
            let near = self.fragments[i + 1..].iter().take_while(|behind| behind.z_min <= f.z_max);
            near.fold(0, |masks, behind| masks | behind.mask) & f.mask == 0
        })
    }

    /// Resolves fragments some of which are blended, [in order](Self::is_in_order): composes them front to back.
    ///
    /// `alpha` returns the alpha of a fragment, given its number; it is not called for fragments that are almost
    /// invisible.
    pub fn resolve_in_order(&mut self, full: u64, mut alpha: impl FnMut(usize, &Fragment) -> f32) {
        let share_of_bit = 1.0 / full.count_ones() as f32;
        let mut through = [share_of_bit; 64];
        let mut open = full;
        self.shares.resize(self.fragments.len(), 0.0);
        for (i, (f, share)) in self.fragments.iter().zip(&mut self.shares).enumerate() {
            let mut seen = f.mask & open;
            if seen == 0 {
                continue;
            }
            let alpha = alpha(i, f);
            while seen != 0 {
                let bit = seen.trailing_zeros() as usize % 64;
                seen &= seen - 1;
                *share += through[bit] * alpha;
                through[bit] *= 1.0 - alpha;
                if through[bit] <= share_of_bit * LEAST_THROUGH {
                    open &= !(1 << bit);
                }
            }
        }
        let all = &through[..full.count_ones() as usize];
        self.background = all.iter().fold(0.0, |sum, through| sum + through);
    }

    /// Resolves fragments some of which are blended: composes them front to back at each sub-pixel, in the order of
    /// their depths there.
    ///
    /// `alphas` are the fragments' alphas, in the same order; shares apply to colour times alpha.
    pub fn resolve_blended(&mut self, alphas: &[f32], place: &Place<'_>) {
        let share_of_bit = 1.0 / place.table.full().count_ones() as f32;
        self.shares.resize(self.fragments.len(), 0.0);
        self.background = 0.0;
        let mut order: Vec<(f32, usize)> = Vec::with_capacity(self.fragments.len());
        for (bit, &center) in place.table.centers().iter().enumerate() {
            let here = self.fragments.iter().enumerate().filter(|(_, f)| f.mask >> bit & 1 == 1);
            order.clear();
            order.extend(here.map(|(i, f)| (depth_at(f, center, place), i)));
            order.sort_by(|a, b| {
                let item = |i: usize| self.fragments[i].item;
                a.0.total_cmp(&b.0).then_with(|| item(a.1).cmp(&item(b.1)))
            });
            let mut through = share_of_bit;
            for &(_, i) in &order {
                self.shares[i] += through * alphas[i];
                through *= 1.0 - alphas[i];
            }
            self.background += through;
        }
    }
}

/// Moves the last of some to its place among the others, which are in order, as long as they are few.
#[inline(always)]
fn sink(order: &mut [u64]) {
    let mut at = order.len() - 1;
    if at < FEW {
        while at > 0 && order[at] < order[at - 1] {
            order.swap(at, at - 1);
            at -= 1;
        }
    }
}

/// Sorts fragments front to back: mostly they are few and nearly so.
#[inline(always)]
fn sort(fragments: &mut [Fragment]) {
    if fragments.len() > FEW {
        fragments.sort_unstable_by(order);
        return;
    }
    for i in 1..fragments.len() {
        let mut at = i;
        while at > 0 && is_nearer(&fragments[at], &fragments[at - 1]) {
            fragments.swap(at, at - 1);
            at -= 1;
        }
    }
}

/// Largest number of fragments that are sorted by insertion.
const FEW: usize = 16;

#[inline(always)]
fn is_nearer(a: &Fragment, b: &Fragment) -> bool {
    if a.z_min == b.z_min { order(a, b).is_lt() } else { a.z_min < b.z_min }
}

fn order(a: &Fragment, b: &Fragment) -> Ordering {
    let depths = a.z_min.total_cmp(&b.z_min).then(a.z_max.total_cmp(&b.z_max));
    // The order of equally far ones must not depend on the order of the input.
    depths.then(a.area.total_cmp(&b.area)).then(a.mask.cmp(&b.mask)).then(a.item.cmp(&b.item))
}

/// Returns the depth of a fragment at a sub-pixel.
fn depth_at(f: &Fragment, [u, v]: [f32; 2], place: &Place<'_>) -> f32 {
    let t = &place.triangles[f.triangle as usize];
    let [ox, oy] = t.origin();
    let depth = plane_depth(t, (place.x - ox) as f32 + u, (place.y - oy) as f32 + v);
    depth.clamp(f.z_min, f.z_max)
}

/// Adds a piece of the same face to another; returns whether it did, which is always the case.
fn merge(kept: &mut Fragment, piece: &Fragment) -> bool {
    kept.seen_by = match (kept.mask, piece.mask) {
        (0, 0) => kept.seen_by,
        (a, b) => a | b,
    };
    kept.mask |= piece.mask;
    kept.area = (kept.area + piece.area).min(1.0);
    kept.z_min = kept.z_min.min(piece.z_min);
    kept.z_max = kept.z_max.max(piece.z_max);
    true
}

/// Returns the priority mask of two fragments: the sub-pixels at which `a` is in front of `b`.
///
/// Where their depths overlap, the difference of the planes is itself a linear function on the pixel,
/// and its mask is looked up like an edge's.
#[inline(always)]
fn in_front(a: &Fragment, b: &Fragment, place: &Place<'_>) -> u64 {
    let full = place.table.full();
    if a.z_max < b.z_min {
        return full;
    }
    // A sliver that covers no sub-pixel lies in sub-pixels of its neighbours in the same surface, so only fragments
    // clearly in front hide it.
    if b.z_max < a.z_min || b.mask == 0 {
        return 0;
    }
    let plane = |f: &Fragment| {
        let t = &place.triangles[f.triangle as usize];
        let [ox, oy] = t.origin();
        let depth = plane_depth(t, (place.x - ox) as f32, (place.y - oy) as f32);
        [depth, t.depth_dx, t.depth_dy]
    };
    let ([za, ax, ay], [zb, bx, by]) = (plane(a), plane(b));
    let (ahead, direction) = (zb - za, Direction::new(bx - ax, by - ay));
    if direction.scale != 0.0 && (bx - ax).abs() + (by - ay).abs() > f32::EPSILON * ahead.abs() {
        return place.table.half_plane(&direction, ahead);
    }
    let first = ahead > 0.0 || (ahead == 0.0 && a.item < b.item);
    if first { full } else { 0 }
}
