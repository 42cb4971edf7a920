//! From the fragments of a pixel to the share that each has in its colour.

use super::fragment::{Fragment, plane_depth};
use super::mask::{Direction, MaskTable};
use crate::visibility::surface::setup::ScreenTriangle;

/// What the fragments of one pixel share in its colour.
#[derive(Debug, Default)]
pub struct Pixel {
    /// Front to back by the nearest depth; one per item.
    pub fragments: Vec<Fragment>,
    /// The share of each, 0 … 1.
    pub shares: Vec<f32>,
    /// The sub-pixels at which each is seen.
    visible: Vec<u64>,
    /// What the background shares.
    pub background: f32,
}

/// Where the pixel is, and what its fragments come from.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    pub triangles: &'a [ScreenTriangle],
    pub table: &'a MaskTable,
    pub x: i32,
    pub y: i32,
}

impl Pixel {
    /// Takes the fragments of a pixel: pieces of one face become one fragment, the rest is sorted
    /// front to back, and what lies wholly behind opaque fragments that cover all is dropped.
    pub fn begin<'f>(&mut self, fragments: impl Iterator<Item = &'f Fragment>, full: u64) {
        self.fragments.clear();
        self.fragments.extend(fragments);
        if self.fragments.len() > 1 {
            self.fragments.sort_unstable_by_key(|f| (f.item, f.triangle));
            self.fragments.dedup_by(|next, kept| next.item == kept.item && merge(kept, next));
            self.fragments.sort_unstable_by(|a, b| {
                let depths = a.z_min.total_cmp(&b.z_min).then(a.z_max.total_cmp(&b.z_max));
                // Of equally far ones the order must not come from the order of the input.
                depths
                    .then(a.area.total_cmp(&b.area))
                    .then(a.mask.cmp(&b.mask))
                    .then(a.item.cmp(&b.item))
            });
            self.drop_hidden(full);
        }
        self.shares.clear();
        self.visible.clear();
    }

    fn drop_hidden(&mut self, full: u64) {
        let (mut covered, mut farthest) = (0, f32::NEG_INFINITY);
        let mut end = self.fragments.len();
        for (i, f) in self.fragments.iter().enumerate() {
            if covered == full && f.z_min > farthest {
                end = i;
                break;
            }
            // Fragments without a sub-pixel hide nothing.
            if !f.blended && covered != full && f.mask != 0 {
                covered |= f.mask;
                farthest = farthest.max(f.z_max);
            }
        }
        self.fragments.truncate(end);
    }

    /// Whether something can be seen through.
    pub fn is_blended(&self) -> bool {
        self.fragments.iter().any(|f| f.blended)
    }

    /// Opaque fragments: by their exact areas, as far as their sub-pixels are seen.
    pub fn resolve_opaque(&mut self, place: &Place<'_>) {
        let mut left = 1.0f32;
        let mut covered = 0;
        for i in 0..self.fragments.len() {
            let f = &self.fragments[i];
            let mut visible = f.seen_by;
            for (j, other) in self.fragments.iter().enumerate() {
                let common = visible & other.mask;
                if j != i && common != 0 {
                    visible &= !(common & in_front(other, f, place));
                }
            }
            let part = visible.count_ones() as f32 / f.seen_by.count_ones().max(1) as f32;
            let share = (f.area * part).min(left);
            left -= share;
            covered |= f.mask;
            self.shares.push(share);
            self.visible.push(visible);
        }
        if covered == place.table.full() {
            left = self.give_to_half_hidden(left);
        }
        self.background = left;
    }

    /// Where the masks leave no background, what the areas leave belongs to fragments that go on
    /// behind others.
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

    /// Fragments of which some are blended, by sub-pixel: each is weakened by all in front of it.
    ///
    /// `alphas` are those of the fragments, in their order; shares are of colour times alpha.
    pub fn resolve_blended(&mut self, alphas: &[f32], place: &Place<'_>) {
        let full = place.table.full();
        let share_of_bit = 1.0 / full.count_ones() as f32;
        for (i, f) in self.fragments.iter().enumerate() {
            let mut through = [1.0f32; 64];
            for (j, other) in self.fragments.iter().enumerate() {
                let common = f.mask & other.mask;
                if j != i && common != 0 {
                    weaken(&mut through, common & in_front(other, f, place), alphas[j]);
                }
            }
            self.shares.push(sum_of(&through, f.mask) * share_of_bit * alphas[i]);
        }
        let mut through = [1.0f32; 64];
        for (f, &alpha) in self.fragments.iter().zip(alphas) {
            weaken(&mut through, f.mask, alpha);
        }
        self.background = sum_of(&through, full) * share_of_bit;
    }
}

/// Puts a piece of the same face to another; says whether it did, which is always.
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

/// Multiplies what goes through some sub-pixels by 1 − alpha.
fn weaken(through: &mut [f32; 64], mask: u64, alpha: f32) {
    let mut bits = mask;
    while bits != 0 {
        through[bits.trailing_zeros() as usize] *= 1.0 - alpha;
        bits &= bits - 1;
    }
}

fn sum_of(through: &[f32; 64], mask: u64) -> f32 {
    through.iter().enumerate().filter(|(bit, _)| mask >> bit & 1 == 1).map(|(_, t)| t).sum()
}

/// The priority mask of two fragments: the sub-pixels at which `a` lies in front of `b`.
///
/// Where their depths overlap, the difference of the planes is itself a linear function on the pixel,
/// and its mask is looked up like an edge's.
fn in_front(a: &Fragment, b: &Fragment, place: &Place<'_>) -> u64 {
    let full = place.table.full();
    if a.z_max < b.z_min {
        return full;
    }
    if b.z_max < a.z_min {
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
    if direction.scale > 0.0 && (bx - ax).abs() + (by - ay).abs() > f32::EPSILON * ahead.abs() {
        return place.table.half_plane(&direction, ahead);
    }
    let first = ahead > 0.0 || (ahead == 0.0 && a.item < b.item);
    if first { full } else { 0 }
}
