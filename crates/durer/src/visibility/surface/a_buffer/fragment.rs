//! Fragments: what a triangle leaves in one pixel, in lists that share one pool.

use super::coverage::Areas;
use super::mask::{Direction, MaskTable};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS};
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};

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
    /// The last row that it touches.
    pub last_row: i32,
    edges: [Direction; 3],
    /// Change of depth over half a pixel in both directions.
    half_depth: f32,
    /// Towards the far plane, if that is near.
    far: Option<Direction>,
}

impl Face {
    pub fn new(t: &ScreenTriangle, triangle: u32, coverage: Coverage, last_row: i32) -> Self {
        let edges = [0, 1, 2].map(|i| {
            let [a, b] = edge_slope(t, i);
            Direction::new(a as f32, b as f32)
        });
        let half_depth = 0.5 * (t.depth_dx.abs() + t.depth_dy.abs());
        let far = (t.depth_max >= 1.0).then(|| Direction::new(-t.depth_dx, -t.depth_dy));
        Self { triangle, coverage, last_row, edges, half_depth, far }
    }
}

/// What edge function `i` gains per grid step to the right and downwards; positive is inside.
fn edge_slope(t: &ScreenTriangle, i: usize) -> [i64; 2] {
    let j = (i + 1) % 3;
    [i64::from(t.y[i] - t.y[j]), i64::from(t.x[j] - t.x[i])]
}

/// The fragments of a part of a row.
pub struct Pool {
    fragments: Vec<Fragment>,
    /// The latest fragment of each pixel.
    heads: Vec<u32>,
    /// Nothing beyond this depth can be seen in a pixel: something opaque covers all of it.
    hidden_from: Vec<f32>,
    max_fragments: usize,
    areas: Areas,
}

impl Pool {
    /// For rows of this width and as many fragments at a time.
    pub fn new(width: u32, max_fragments: usize) -> Self {
        Self {
            fragments: Vec::new(),
            heads: vec![END; width as usize],
            hidden_from: vec![f32::INFINITY; width as usize],
            max_fragments,
            areas: Areas::default(),
        }
    }

    /// Forgets the fragments; those of pixels x0 … x1 − 1 are looked for next.
    pub fn clear(&mut self, [x0, x1]: [i32; 2]) {
        self.fragments.clear();
        self.heads[x0 as usize..x1 as usize].fill(END);
        self.hidden_from[x0 as usize..x1 as usize].fill(f32::INFINITY);
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

    /// Adds a triangle's fragments in pixels x0 … x1 − 1 of row y; calls `added` with the column of
    /// each. Says whether there was room for all of them.
    #[expect(clippy::too_many_arguments, reason = "one call from one place, in the inner loop")]
    pub fn add(
        &mut self,
        t: &ScreenTriangle,
        face: &Face,
        table: &MaskTable,
        y: i32,
        columns: [i32; 2],
        mut passes: impl FnMut(i32) -> bool,
        mut added: impl FnMut(i32, &Fragment),
    ) -> bool {
        let (first, areas) = self.areas.of(t, y, columns);
        let (edges, steps) = edges_at(t, first, y);
        let [ox, oy] = t.origin();
        let blended = face.coverage == Coverage::Blended;
        for (i, &area) in areas.iter().enumerate() {
            let x = first + i as i32;
            let depth = plane_depth(t, (x - ox) as f32, (y - oy) as f32);
            let z_min = (depth - face.half_depth).max(t.depth_min);
            let z_max = (depth + face.half_depth).min(t.depth_max).max(z_min);
            let column = x as usize;
            if area <= 0.0 || z_min > self.hidden_from[column] || z_min >= 1.0 || !passes(x) {
                continue;
            }
            let at = [0, 1, 2].map(|k| (edges[k] + steps[k] * i as i64) as f32);
            let mut mask = mask_of(table, face, at);
            let mut area = area;
            if let Some(far) = face.far {
                let before = table.half_plane(&far, 1.0 - depth);
                area *= (mask & before).count_ones() as f32 / mask.count_ones().max(1) as f32;
                mask &= before;
            }
            let seen_by = if mask == 0 { nearest_sub_pixel(table, face, at) } else { mask };
            if mask == table.full() && !blended {
                self.hidden_from[column] = self.hidden_from[column].min(z_max);
            }
            if self.fragments.len() >= self.max_fragments && columns[1] - columns[0] > 1 {
                return false;
            }
            let next = self.heads[column];
            let (item, triangle) = (t.item, face.triangle);
            let fragment =
                Fragment { item, triangle, mask, seen_by, area, z_min, z_max, blended, next };
            self.heads[column] = self.fragments.len() as u32;
            added(x, &fragment);
            self.fragments.push(fragment);
        }
        true
    }
}

/// The depth of a triangle's plane, also outside the triangle.
pub fn plane_depth(t: &ScreenTriangle, dx: f32, dy: f32) -> f32 {
    t.depth + (t.depth_dx * dx + t.depth_dy * dy)
}

/// The edge functions at the centre of a pixel, in grid steps squared, divided by the grid steps of a
/// pixel; and what they gain from pixel to pixel.
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
#[cold]
fn nearest_sub_pixel(table: &MaskTable, face: &Face, at: [f32; 3]) -> u64 {
    let depth_at = |[u, v]: [f32; 2]| {
        let along = |i: usize| {
            let [a, b] = face.edges[i].slope;
            at[i] * PER_GRID_STEP * face.edges[i].scale + (a * u + b * v)
        };
        along(0).min(along(1)).min(along(2))
    };
    let mut best = (f32::NEG_INFINITY, 0);
    for (bit, center) in table.centers().enumerate() {
        let depth = depth_at(center);
        if depth > best.0 {
            best = (depth, 1 << bit);
        }
    }
    best.1
}
