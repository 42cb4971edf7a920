//! Fragments: what a triangle leaves in one pixel, in lists that share one pool.

use super::coverage::Areas;
use super::edges::{Edges, Functions, Slopes};
use super::faces::Active;
use super::mask::{Direction, MaskTable};
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use fearless_simd::Simd;

/// Faces with at most as many columns are looked for in the pixels before their edges are computed.
const NARROW: i32 = 8;

/// No further fragment.
const END: u32 = u32::MAX;

/// What a triangle leaves in one pixel.
#[derive(Debug, Clone, Copy)]
pub struct Fragment {
    /// Its item.
    pub item: u32,
    /// Index of its triangle.
    pub triangle: u32,
    /// The sub-pixels it covers; it hides what is behind these.
    pub mask: u64,
    /// The sub-pixels that decide whether it is seen: the mask, or the nearest one where that is
    /// empty.
    pub seen_by: u64,
    /// The exact area it covers, 0 … 1.
    pub area: f32,
    /// Depths within the pixel.
    pub z_min: f32,
    pub z_max: f32,
    /// Whether it lets something behind it be seen.
    pub blended: bool,
}

/// A triangle with all that its fragments have in common.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    pub triangle: u32,
    pub coverage: Coverage,
    slopes: Slopes,
    /// Change of depth over half a pixel in both directions.
    half_depth: f32,
    /// Towards the far plane, if that is near.
    far: Option<Direction>,
}

impl Face {
    #[inline(always)]
    pub fn new<S: Simd>(simd: S, t: &ScreenTriangle, triangle: u32, coverage: Coverage) -> Self {
        let half_depth = 0.5 * (t.depth_dx.abs() + t.depth_dy.abs());
        let far = (t.depth_max >= 1.0).then(|| Direction::new(-t.depth_dx, -t.depth_dy));
        Self { triangle, coverage, slopes: Slopes::new(simd, t), half_depth, far }
    }
}

/// The fragments of a part of a row.
pub struct Pool<'a> {
    table: &'a MaskTable,
    fragments: Vec<Fragment>,
    /// The fragment of the same pixel that came before each.
    nexts: Vec<u32>,
    /// The latest fragment of each pixel.
    heads: Vec<u32>,
    covers: Vec<Cover>,
    max_fragments: usize,
    areas: Areas,
}

impl<'a> Pool<'a> {
    /// For rows of this width and as many fragments at a time.
    pub fn new(table: &'a MaskTable, width: u32, max_fragments: usize) -> Self {
        Self {
            table,
            fragments: Vec::new(),
            nexts: Vec::new(),
            heads: vec![END; width as usize],
            covers: vec![Cover::NONE; width as usize],
            max_fragments,
            areas: Areas::new(width),
        }
    }

    /// Forgets the fragments; those of pixels x0 … x1 − 1 are looked for next.
    pub fn clear(&mut self, [x0, x1]: [i32; 2]) {
        self.fragments.clear();
        self.nexts.clear();
        self.heads[x0 as usize..x1 as usize].fill(END);
        self.covers[x0 as usize..x1 as usize].fill(Cover::NONE);
    }

    /// A depth behind which nothing of a pixel can be seen: opaque fragments before it cover all of
    /// the pixel. It depends on the order in which fragments came; infinite where there is none.
    #[inline(always)]
    pub fn hidden_from(&self, x: i32) -> f32 {
        self.covers[x as usize].hidden_from
    }

    /// Whether what is not nearer than `depth` is hidden in all of pixels x0 … x1 − 1.
    #[inline(always)]
    fn hides(&self, [x0, x1]: [i32; 2], depth: f32) -> bool {
        self.covers[x0 as usize..x1 as usize].iter().all(|cover| depth > cover.hidden_from)
    }

    /// Whether a triangle leaves nothing in a part of the row, as far as that can be said without
    /// looking at its edges.
    #[inline(always)]
    pub fn rejects(&self, active: &Active, part: [i32; 2]) -> bool {
        let columns = [active.columns[0].max(part[0]), active.columns[1].min(part[1])];
        let width = columns[1] - columns[0];
        width <= 0 || (width <= NARROW && self.hides(columns, active.depth))
    }

    /// Whether a pixel has no fragments.
    #[inline(always)]
    pub fn is_empty(&self, x: i32) -> bool {
        self.heads[x as usize] == END
    }

    /// The numbers of a pixel's fragments, latest first.
    #[inline(always)]
    pub fn latest_first(&self, x: i32) -> impl Iterator<Item = u32> {
        let mut at = self.heads[x as usize];
        std::iter::from_fn(move || {
            let &next = self.nexts.get(at as usize)?;
            Some(std::mem::replace(&mut at, next))
        })
    }

    /// A fragment by its number.
    #[inline(always)]
    pub fn fragment(&self, number: u32) -> &Fragment {
        &self.fragments[number as usize]
    }

    /// Adds a triangle's fragments in pixels x0 … x1 − 1 of row y, where `passes` says that it is
    /// there; calls `added` with the column of each. Says whether there was room for all of them.
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
        let columns = parts.columns(columns);
        let Some(nearest) = nearest_depth(t, face, columns, y) else { return true };
        if self.hides(columns, nearest) {
            return true;
        }
        self.areas.begin(&parts, columns);
        let functions = edges.functions(simd, columns[0], y);
        let [ox, oy] = t.origin();
        for x in columns[0]..columns[1] {
            let (i, column) = ((x - columns[0]) as usize, x as usize);
            let area = self.areas.next(i);
            if area <= 0.0 {
                continue;
            }
            let depth = plane_depth(t, (x - ox) as f32, (y - oy) as f32);
            let z_min = (depth - face.half_depth).max(t.depth_min);
            if z_min > self.covers[column].hidden_from || z_min >= 1.0 || !passes(x) {
                continue;
            }
            if self.fragments.len() >= self.max_fragments && part > 1 {
                self.areas.end(i);
                return false;
            }
            let z_max = (depth + face.half_depth).min(t.depth_max).max(z_min);
            let mut fragment = Fragment {
                item: t.item,
                triangle: face.triangle,
                area,
                z_min,
                z_max,
                blended: face.coverage == Coverage::Blended,
                mask: 0,
                seen_by: 0,
            };
            fragment.cover(simd, self.table, face, &functions, i, depth);
            if !fragment.blended {
                self.covers[column].add(fragment.mask, z_max, self.table.full());
            }
            self.nexts.push(self.heads[column]);
            self.heads[column] = self.fragments.len() as u32;
            added(x, &fragment);
            self.fragments.push(fragment);
        }
        self.areas.end((columns[1] - columns[0]) as usize);
        true
    }
}

/// What opaque fragments hide of a pixel.
#[derive(Debug, Clone, Copy)]
struct Cover {
    /// Nothing beyond this depth can be seen.
    hidden_from: f32,
    /// The largest depth of the fragments in `mask`.
    farthest: f32,
    /// What has been covered since the last time that all was.
    mask: u64,
}

impl Cover {
    const NONE: Self = Self { hidden_from: f32::INFINITY, farthest: 0.0, mask: 0 };

    /// Adds an opaque fragment.
    #[inline(always)]
    fn add(&mut self, mask: u64, z_max: f32, full: u64) {
        if mask == full {
            self.hidden_from = self.hidden_from.min(z_max);
        } else if mask != 0 && z_max < self.hidden_from {
            self.mask |= mask;
            self.farthest = self.farthest.max(z_max);
            if self.mask == full {
                *self = Self { hidden_from: self.farthest, ..Self::NONE };
            }
        }
    }
}

/// The smallest depth of a face in pixels x0 … x1 − 1 of row y, as its fragments have it; `None`
/// where there are no such pixels.
#[inline(always)]
fn nearest_depth(t: &ScreenTriangle, face: &Face, [x0, x1]: [i32; 2], y: i32) -> Option<f32> {
    let [ox, oy] = t.origin();
    let at = |x: i32| plane_depth(t, (x - ox) as f32, (y - oy) as f32);
    // Rounding keeps the order of the pixels of a row.
    (x0 < x1).then(|| (at(x0).min(at(x1 - 1)) - face.half_depth).max(t.depth_min))
}

impl Fragment {
    /// Finds the mask from the edge functions and the depth at the pixel's centre; what is beyond
    /// the far plane goes.
    #[inline(always)]
    fn cover<S: Simd>(
        &mut self,
        simd: S,
        table: &MaskTable,
        face: &Face,
        functions: &Functions<S>,
        column: usize,
        depth: f32,
    ) {
        let at = functions.at(simd, column);
        self.mask = functions.mask(simd, &face.slopes, table, at);
        if let Some(far) = face.far {
            let before = self.mask & table.half_plane(&far, 1.0 - depth);
            let all = self.mask.count_ones().max(1);
            self.area *= before.count_ones() as f32 / all as f32;
            self.mask = before;
        }
        self.seen_by = match self.mask {
            0 => functions.nearest(simd, &face.slopes, table, at),
            mask => mask,
        };
    }
}

/// The depth of a triangle's plane, also outside the triangle.
#[inline(always)]
pub fn plane_depth(t: &ScreenTriangle, dx: f32, dy: f32) -> f32 {
    t.depth + (t.depth_dx * dx + t.depth_dy * dy)
}
