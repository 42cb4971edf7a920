//! Fragments, the parts of triangles in single pixels, in lists that share one pool.

use super::coverage::{Areas, COLUMNS};
use super::edges::{Edges, Functions};
use super::face::Face;
use super::faces::Active;
use super::mask::{Direction, EIGHT, MaskTable};
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// No further fragment.
const END: u32 = u32::MAX;

/// Contribution of a triangle to one pixel.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    /// Its item.
    pub item: u32,
    /// Index of its triangle.
    pub triangle: u32,
    /// Sub-pixels that it covers; it hides fragments behind these.
    pub mask: u64,
    /// The sub-pixels that decide whether it is visible: the mask, or the nearest sub-pixel if the mask is empty.
    pub seen_by: u64,
    /// The exact area it covers, 0 … 1.
    pub area: f32,
    /// Depths within the pixel.
    pub z_min: f32,
    pub z_max: f32,
    /// True if surfaces behind it show through.
    pub blended: bool,
}

/// Bytes of a fragment and of the number of the one before it.
pub const PER_FRAGMENT: usize = size_of::<Fragment>() + size_of::<u32>();

/// The fragments of a part of a row.
pub struct Pool<'a> {
    table: &'a MaskTable,
    fragments: Vec<Fragment>,
    /// The fragment of the same pixel that came before each.
    nexts: Vec<u32>,
    /// The latest fragment of each pixel.
    heads: Vec<u32>,
    /// For each pixel, the depth behind which nothing is visible; seven more entries pad the last vector.
    hidden_from: Vec<f32>,
    /// Coverage of the fragments of each pixel that has any.
    covers: Vec<Cover>,
    max_fragments: usize,
}

impl<'a> Pool<'a> {
    /// Creates a pool for rows of this width and as many fragments at a time as `max_fragments`.
    pub fn new(table: &'a MaskTable, width: u32, max_fragments: usize) -> Self {
        Self {
            table,
            fragments: Vec::new(),
            nexts: Vec::new(),
            heads: vec![END; width as usize],
            hidden_from: vec![f32::INFINITY; width as usize + EIGHT - 1],
            covers: vec![Cover::default(); width as usize],
            max_fragments,
        }
    }

    /// Returns the bytes of the fragments, and of the data kept for each column.
    pub fn bytes(&self) -> u64 {
        let columns = size_of::<u32>() + size_of::<f32>() + size_of::<Cover>();
        let fragments = self.fragments.capacity() * PER_FRAGMENT;
        (fragments + self.heads.len() * columns) as u64
    }

    /// Removes all fragments and prepares for pixels x0 … x1 − 1.
    pub fn clear(&mut self, [x0, x1]: [i32; 2]) {
        let part = x0 as usize..x1 as usize;
        self.fragments.clear();
        self.nexts.clear();
        self.heads[part.clone()].fill(END);
        self.hidden_from[part].fill(f32::INFINITY);
    }

    /// Returns a depth behind which nothing is visible in a pixel because opaque fragments in front of it cover the
    /// whole pixel. Infinite if there is no such depth. It depends on the order in which fragments were added.
    #[inline(always)]
    pub fn hidden_from(&self, x: i32) -> f32 {
        self.hidden_from[x as usize]
    }

    /// Returns, as bits, the pixels among the first `count` of eight from x on in which a fragment at these depths may
    /// be visible.
    #[inline(always)]
    fn seen<S: Simd>(&self, simd: S, x: i32, count: i32, depths: f32x8<S>) -> u64 {
        let hidden_from = &self.hidden_from[x as usize..][..EIGHT];
        let seen = depths.simd_le(f32x8::from_slice(simd, hidden_from));
        seen.to_bitmask() & ((1 << count) - 1)
    }

    /// Returns whether a triangle certainly leaves nothing in a part of the row, judged without its edges.
    #[inline(always)]
    pub fn rejects<S: Simd>(&self, simd: S, active: &Active, part: [i32; 2]) -> bool {
        let [x0, x1] = [active.columns[0].max(part[0]), active.columns[1].min(part[1])];
        if x1 - x0 > EIGHT as i32 {
            return false;
        }
        x0 >= x1 || self.seen(simd, x0, x1 - x0, f32x8::splat(simd, active.depth)) == 0
    }

    /// Returns the fragment of a pixel that has no other.
    #[inline(always)]
    pub fn only(&self, x: i32) -> Option<&Fragment> {
        let number = self.heads[x as usize];
        let &next = self.nexts.get(number as usize)?;
        (next == END).then(|| self.fragment(number))
    }

    /// Returns the first of pixels x0 … x1 − 1 that has fragments, or x1.
    #[inline(always)]
    pub fn next_filled(&self, [x0, x1]: [i32; 2]) -> i32 {
        let part = &self.heads[x0 as usize..x1 as usize];
        if part.first().is_some_and(|head| *head != END) {
            return x0;
        }
        let eights = part.chunks_exact(EIGHT).take_while(|heads| **heads == [END; EIGHT]).count();
        let rest = part[EIGHT * eights..].iter().take_while(|head| **head == END).count();
        x0 + (EIGHT * eights + rest) as i32
    }

    /// Returns the numbers of a pixel's fragments, latest first.
    #[inline(always)]
    pub fn latest_first(&self, x: i32) -> impl Iterator<Item = u32> {
        let mut at = self.heads[x as usize];
        std::iter::from_fn(move || {
            let &next = self.nexts.get(at as usize)?;
            Some(std::mem::replace(&mut at, next))
        })
    }

    /// Returns a fragment by its number.
    #[inline(always)]
    pub fn fragment(&self, number: u32) -> &Fragment {
        &self.fragments[number as usize]
    }

    /// Adds a triangle's fragments in pixels x0 … x1 − 1 of row y, where `passes` returns true; calls `added` with the
    /// column of each. Returns whether there was room for all of them.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "one call, all of it a row's state")]
    pub fn add<S: Simd>(
        &mut self,
        simd: S,
        t: &ScreenTriangle,
        face: &Face,
        y: i32,
        columns: [i32; 2],
        mut passes: impl FnMut(i32) -> bool,
        mut added: impl FnMut(i32, &Fragment),
    ) -> bool {
        let edges = Edges::new(simd, t);
        let parts = edges.row(simd, &face.slopes, y);
        let part = columns[1] - columns[0];
        let columns = parts.columns(simd, columns);
        let width = columns[1] - columns[0];
        if width <= 0 || (width > EIGHT as i32 && self.hides(t, face, columns, y)) {
            return true;
        }
        let [ox, oy] = t.origin();
        let depths = Depths { t, half: face.half_depth, from: [ox, y - oy] };
        let areas = Areas::new(simd, &parts, columns);
        let functions = edges.functions(simd, columns[0], y);
        let row = Row { t, face, depths, areas, functions, columns };
        // Most triangles have no pixels but these.
        let mut next = (columns[0], 0.0);
        let mut room = self.add_eight(simd, &row, &mut next, part > 1, &mut passes, &mut added);
        while room && next.0 < columns[1] {
            room = self.add_eight(simd, &row, &mut next, part > 1, &mut passes, &mut added);
        }
        room
    }

    /// Adds a triangle's fragments in up to eight pixels from `next` on, a column and the area before it. Returns
    /// whether there was room, if it is `limited`.
    #[inline(always)]
    fn add_eight<S: Simd>(
        &mut self,
        simd: S,
        row: &Row<'_, S>,
        next: &mut (i32, f32),
        limited: bool,
        passes: &mut impl FnMut(i32) -> bool,
        added: &mut impl FnMut(i32, &Fragment),
    ) -> bool {
        let Row { t, face, depths, areas, functions, columns } = row;
        // Leave out pixels beyond the far plane and those hidden by opaque fragments added before.
        let (first, mut sum) = *next;
        let count = (columns[1] - first).min(EIGHT as i32);
        let [depth, z_min, z_max] = depths.of_eight(simd, first);
        let before_far = z_min.simd_lt(f32x8::splat(simd, 1.0)).to_bitmask();
        let seen = self.seen(simd, first, count, z_min) & before_far;
        *next = (first + EIGHT as i32, 0.0);
        if seen == 0 && next.0 >= columns[1] {
            return true;
        }
        // Areas and masks of all eight pixels: the running sum of the area needs the hidden ones, too.
        let [here, after] = areas.changes(simd, first, first == columns[0]);
        let at = functions.at(simd, (first - columns[0]) as usize);
        let masks = face.slopes.masks(simd, self.table, at);
        let [p, q, r]: [[f32; EIGHT]; 3] = [at[0].into(), at[1].into(), at[2].into()];
        let depth: [f32; EIGHT] = depth.into();
        let (z_min, z_max): ([f32; EIGHT], [f32; EIGHT]) = (z_min.into(), z_max.into());
        for i in 0..count as usize % (EIGHT + 1) {
            let (x, column) = (first + i as i32, first as usize + i);
            let area = sum + here[i % EIGHT];
            sum = area + after[i % EIGHT];
            // Pixels without a fragment: no area, hidden, or excluded by the test.
            if area <= 0.0 || seen >> i & 1 == 0 || !passes(x) {
                continue;
            }
            if limited && self.fragments.len() >= self.max_fragments {
                return false;
            }
            // The fragment, cut off at the far plane if it crosses it.
            let mask = masks.get(self.table, i);
            let mut fragment = Fragment {
                item: t.item,
                triangle: face.triangle,
                area: area.min(1.0),
                z_min: z_min[i % EIGHT],
                z_max: z_max[i % EIGHT],
                blended: face.coverage == Coverage::Blended,
                mask,
                seen_by: mask,
            };
            if let Some(far) = &face.far {
                fragment.cut_off(self.table, far, depth[i % EIGHT]);
            }
            // Link it before the earlier fragments of its pixel.
            let head = std::mem::replace(&mut self.heads[column], self.fragments.len() as u32);
            let cover = &mut self.covers[column];
            if head == END {
                *cover = Cover::default();
            }
            // A sliver between sub-pixels is visible where the nearest one is; opaque masks may close the pixel.
            if fragment.mask == 0 {
                let at = [p[i % EIGHT], q[i % EIGHT], r[i % EIGHT], 0.0];
                fragment.seen_by = functions.nearest(simd, &face.slopes, self.table, at);
            } else if !fragment.blended {
                let hidden_from = &mut self.hidden_from[column];
                cover.add(fragment.mask, fragment.z_max, self.table.full(), hidden_from);
            }
            self.nexts.push(head);
            added(x, &fragment);
            self.fragments.push(fragment);
        }
        next.1 = sum;
        true
    }

    /// Returns whether a face is completely hidden in pixels x0 … x1 − 1 of row y, at least one pixel.
    fn hides(&self, t: &ScreenTriangle, face: &Face, [x0, x1]: [i32; 2], y: i32) -> bool {
        let [ox, oy] = t.origin();
        let at = |x: i32| plane_depth(t, (x - ox) as f32, (y - oy) as f32);
        // Rounding keeps the order of the pixels of a row.
        let nearest = (at(x0).min(at(x1 - 1)) - face.half_depth).max(t.depth_min);
        self.hidden_from[x0 as usize..x1 as usize].iter().all(|&hidden_from| nearest > hidden_from)
    }
}

/// A triangle in a row of pixels.
struct Row<'a, S: Simd> {
    t: &'a ScreenTriangle,
    face: &'a Face,
    depths: Depths<'a>,
    areas: Areas,
    functions: Functions<S>,
    /// The first pixel that it may touch, and the one after the last.
    columns: [i32; 2],
}

/// The depths of a triangle in a row of pixels.
struct Depths<'a> {
    t: &'a ScreenTriangle,
    /// Change over half a pixel in both directions.
    half: f32,
    /// The column of the triangle's origin, and how many rows below it these are.
    from: [i32; 2],
}

impl Depths<'_> {
    /// Returns the depths in eight pixels from column x on: at the centre, as [`plane_depth`] has it, the smallest and
    /// the largest.
    #[inline(always)]
    fn of_eight<S: Simd>(&self, simd: S, x: i32) -> [f32x8<S>; 3] {
        let (t, [from_x, from_y]) = (self.t, self.from);
        let dx = f32x8::from_slice(simd, &COLUMNS) + (x - from_x) as f32;
        let depth = dx * t.depth_dx + t.depth_dy * from_y as f32 + t.depth;
        let z_min = (depth - self.half).max(f32x8::splat(simd, t.depth_min));
        let z_max = (depth + self.half).min(f32x8::splat(simd, t.depth_max)).max(z_min);
        [depth, z_min, z_max]
    }
}

/// Coverage of a pixel by opaque fragments that do not cover all of it.
#[derive(Debug, Clone, Copy, Default)]
struct Cover {
    /// The largest depth of the fragments in `mask`.
    farthest: f32,
    /// Covered part since the last time that all was covered.
    mask: u64,
}

impl Cover {
    /// Adds an opaque fragment; nothing beyond `hidden_from` can be seen.
    #[inline(always)]
    fn add(&mut self, mask: u64, z_max: f32, full: u64, hidden_from: &mut f32) {
        if mask == full {
            *hidden_from = hidden_from.min(z_max);
        } else if z_max < *hidden_from {
            self.mask |= mask;
            self.farthest = self.farthest.max(z_max);
            if self.mask == full {
                *hidden_from = self.farthest;
                *self = Self::default();
            }
        }
    }
}

impl Fragment {
    /// Removes the sub-pixels beyond the far plane; `depth` is the fragment's depth at the pixel's centre.
    #[cold]
    fn cut_off(&mut self, table: &MaskTable, far: &Direction, depth: f32) {
        let before = self.mask & table.half_plane(far, 1.0 - depth);
        let all = self.mask.count_ones().max(1);
        self.area *= before.count_ones() as f32 / all as f32;
        (self.mask, self.seen_by) = (before, before);
    }
}

/// Returns the depth of a triangle's plane, also outside the triangle.
#[inline(always)]
pub fn plane_depth(t: &ScreenTriangle, dx: f32, dy: f32) -> f32 {
    t.depth + (t.depth_dx * dx + t.depth_dy * dy)
}
