//! Fragments: what a triangle leaves in one pixel, in lists that share one pool.

use super::coverage::{Areas, RowEdges, Slopes, slopes};
use super::faces::Active;
use super::mask::{Direction, MaskTable};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS};
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};

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
    next: u32,
}

/// A triangle with all that its fragments have in common.
#[derive(Debug, Clone, Copy)]
pub struct Face {
    pub triangle: u32,
    pub coverage: Coverage,
    edges: [Direction; 3],
    slopes: Slopes,
    /// Change of depth over half a pixel in both directions.
    half_depth: f32,
    /// Towards the far plane, if that is near.
    far: Option<Direction>,
}

impl Face {
    pub fn new(t: &ScreenTriangle, triangle: u32, coverage: Coverage) -> Self {
        let edge = |i| {
            let [a, b] = edge_slope(t, i);
            Direction::new(a as f32, b as f32)
        };
        // Not by `map`, which would be a call.
        let edges = [edge(0), edge(1), edge(2)];
        let half_depth = 0.5 * (t.depth_dx.abs() + t.depth_dy.abs());
        let far = (t.depth_max >= 1.0).then(|| Direction::new(-t.depth_dx, -t.depth_dy));
        Self { triangle, coverage, edges, slopes: slopes(t), half_depth, far }
    }
}

/// What edge function `i` gains per grid step to the right and downwards; positive is inside.
fn edge_slope(t: &ScreenTriangle, i: usize) -> [i64; 2] {
    let j = (i + 1) % 3;
    [i64::from(t.y[i] - t.y[j]), i64::from(t.x[j] - t.x[i])]
}

/// The fragments of a part of a row.
pub struct Pool<'a> {
    table: &'a MaskTable,
    fragments: Vec<Fragment>,
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
            heads: vec![END; width as usize],
            covers: vec![Cover::NONE; width as usize],
            max_fragments,
            areas: Areas::default(),
        }
    }

    /// Forgets the fragments; those of pixels x0 … x1 − 1 are looked for next.
    pub fn clear(&mut self, [x0, x1]: [i32; 2]) {
        self.fragments.clear();
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

    /// The fragments of a pixel, latest first.
    pub fn of_pixel(&self, x: i32) -> impl Iterator<Item = &Fragment> {
        let mut at = self.heads[x as usize];
        std::iter::from_fn(move || {
            let fragment = self.fragments.get(at as usize)?;
            at = fragment.next;
            Some(fragment)
        })
    }

    /// Adds a triangle's fragments in pixels x0 … x1 − 1 of row y, where `passes` says that it is
    /// there; calls `added` with the column of each. Says whether there was room for all of them.
    #[inline(always)]
    pub fn add(
        &mut self,
        t: &ScreenTriangle,
        face: &Face,
        y: i32,
        columns: [i32; 2],
        mut passes: impl FnMut(i32) -> bool,
        mut added: impl FnMut(i32, &Fragment),
    ) -> bool {
        let edges = RowEdges::new(t, &face.slopes, y);
        let part = columns[1] - columns[0];
        let columns = edges.columns(columns);
        let Some(nearest) = nearest_depth(t, face, columns, y) else { return true };
        if self.hides(columns, nearest) {
            return true;
        }
        let first = columns[0];
        let areas = self.areas.of(&edges, columns);
        let (edges, steps) = edges_at(t, first, y);
        let [ox, oy] = t.origin();
        for (i, &area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.0) {
            let x = first + i as i32;
            let column = x as usize;
            let depth = plane_depth(t, (x - ox) as f32, (y - oy) as f32);
            let z_min = (depth - face.half_depth).max(t.depth_min);
            if z_min > self.covers[column].hidden_from || z_min >= 1.0 || !passes(x) {
                continue;
            }
            if self.fragments.len() >= self.max_fragments && part > 1 {
                return false;
            }
            let at = [0, 1, 2].map(|k| (edges[k] + steps[k] * i as i64) as f32);
            let z_max = (depth + face.half_depth).min(t.depth_max).max(z_min);
            let mut fragment = Fragment {
                item: t.item,
                triangle: face.triangle,
                area,
                z_min,
                z_max,
                blended: face.coverage == Coverage::Blended,
                next: self.heads[column],
                mask: 0,
                seen_by: 0,
            };
            fragment.cover(self.table, face, at, depth);
            if !fragment.blended {
                self.covers[column].add(fragment.mask, z_max, self.table.full());
            }
            self.heads[column] = self.fragments.len() as u32;
            added(x, &fragment);
            self.fragments.push(fragment);
        }
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
    fn cover(&mut self, table: &MaskTable, face: &Face, at: [f32; 3], depth: f32) {
        self.mask = mask_of(table, face, at);
        if let Some(far) = face.far {
            let before = self.mask & table.half_plane(&far, 1.0 - depth);
            let all = self.mask.count_ones().max(1);
            self.area *= before.count_ones() as f32 / all as f32;
            self.mask = before;
        }
        self.seen_by = match self.mask {
            0 => nearest_sub_pixel(table, face, at),
            mask => mask,
        };
    }
}

/// The depth of a triangle's plane, also outside the triangle.
#[inline(always)]
pub fn plane_depth(t: &ScreenTriangle, dx: f32, dy: f32) -> f32 {
    t.depth + (t.depth_dx * dx + t.depth_dy * dy)
}

/// The edge functions at the centre of a pixel, in grid steps squared, divided by the grid steps of a
/// pixel; and what they gain from pixel to pixel.
#[inline(always)]
fn edges_at(t: &ScreenTriangle, x: i32, y: i32) -> ([i64; 3], [i64; 3]) {
    let center = |i: i32| i64::from(i) * i64::from(SUBPIXELS) + i64::from(HALF_PIXEL);
    let (mut edges, mut steps) = ([0; 3], [0; 3]);
    for i in 0..3 {
        let [a, b] = edge_slope(t, i);
        edges[i] = a * (center(x) - i64::from(t.x[i])) + b * (center(y) - i64::from(t.y[i]));
        steps[i] = a * i64::from(SUBPIXELS);
    }
    (edges, steps)
}

/// The sub-pixels inside all three edges.
#[inline(always)]
fn mask_of(table: &MaskTable, face: &Face, at: [f32; 3]) -> u64 {
    let inside = |i: usize| table.half_plane(&face.edges[i], at[i] * PER_GRID_STEP);
    inside(0) & inside(1) & inside(2)
}

/// Edge functions have slopes per grid step; masks want them per pixel.
const PER_GRID_STEP: f32 = 1.0 / SUBPIXELS as f32;

/// The sub-pixel that lies deepest within a triangle too small for its mask.
#[inline(always)]
fn nearest_sub_pixel(table: &MaskTable, face: &Face, at: [f32; 3]) -> u64 {
    let centers = table.centers();
    let edge = [0, 1, 2].map(|i| {
        let [a, b] = face.edges[i].slope;
        [at[i] * PER_GRID_STEP * face.edges[i].scale, a, b]
    });
    // All of them first: that is eight at a time.
    let mut depths = [0.0; 64];
    for (depth, &[u, v]) in depths.iter_mut().zip(centers) {
        let [d0, d1, d2] = edge.map(|[e, a, b]| e + (a * u + b * v));
        *depth = d0.min(d1).min(d2);
    }
    let mut best = (f32::NEG_INFINITY, 0);
    for (bit, &depth) in depths[..centers.len()].iter().enumerate() {
        if depth > best.0 {
            best = (depth, 1 << bit);
        }
    }
    best.1
}
