//! Triangles by edge functions over tiles of 8 × 8 pixels.
//!
//! Joel McCormack and Robert McNamara, *Tiled Polygon Traversal Using Half-Plane Edge Functions*,
//! Graphics Hardware 2000, with the trivial accept and reject of a tile by its corners (Fuchs et al.,
//! *Pixel-Planes 5*, 1989; Greene 1996). Image space. A tile is left out where one function is
//! negative at its most favourable corner, and lit as a whole where all are positive at the least
//! favourable; only tiles on the outline test single pixels.

pub use super::Options;
use super::{Edge, SnappedTriangle, Span};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::trace::{PseudocodeLine, Tracer};
use crate::view::window::PixelRect;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "tiles",
    title: "Tiles with half-plane edge functions",
    authors: "Joel McCormack, Robert McNamara",
    year: 2000,
    source: "Tiled Polygon Traversal Using Half-Plane Edge Functions, Graphics Hardware",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::Area],
    cost: "O(tiles of the bounding box + pixels of the tiles on the outline) time, O(1) memory",
    limits: "coordinates within the guard band",
    pseudocode: &[
        "E_i(x, y) ← edge function of each edge, ≥ 0 inside",
        "for each tile of 8 × 8 pixels of the bounding box:",
        "    if some E_i is negative at the corner where it is largest:",
        "        reject the tile",
        "    else if each E_i is ≥ 0 at the corner where it is smallest:",
        "        accept the tile: set all of its pixels",
        "    else:",
        "        for each pixel of the tile:",
        "            set it if all E_i are ≥ 0 there",
    ],
};

/// Width and height of a tile in pixels: a row's mask fits a byte.
pub(crate) const TILE: i32 = 8;

/// Result of testing a tile's corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// All of it is outside one edge.
    Rejected,
    /// All of it is inside all edges.
    Accepted,
    /// Its pixels were tested.
    Examined,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A tile was decided.
    Tile {
        /// Its left column, a multiple of 8.
        x: i32,
        /// Its top row, a multiple of 8.
        y: i32,
        /// Result of the test.
        verdict: Verdict,
        /// Covered pixels, row by row; bit k is column x + k. Not clipped.
        rows: [u8; TILE as usize],
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        let Self::Tile { verdict, .. } = self;
        match verdict {
            Verdict::Rejected => 4,
            Verdict::Accepted => 6,
            Verdict::Examined => 9,
        }
    }
}

/// Emits the covered pixels, row by row from the top, one span a row.
pub fn rasterize(
    triangle: &SnappedTriangle,
    options: &Options,
    mut emit: impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    let Some(edges) = triangle.edges() else { return };
    let pixels = triangle.pixels(&options.clip);
    if pixels.is_empty() {
        return;
    }
    let mut tile_y = pixels.y0() & -TILE;
    while tile_y < pixels.y1() {
        row_of_tiles(&edges, &pixels, tile_y, &mut emit, t);
        tile_y += TILE;
    }
}

/// Decides the tiles of eight rows, joining their masks into one run a row.
fn row_of_tiles(
    edges: &[Edge; 3],
    pixels: &PixelRect,
    tile_y: i32,
    emit: &mut impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    let mut runs = [None; TILE as usize];
    let mut tile_x = pixels.x0() & -TILE;
    while tile_x < pixels.x1() {
        let (verdict, rows) = decide(edges, tile_x, tile_y);
        t.step(|| Step::Tile { x: tile_x, y: tile_y, verdict, rows });
        for (run, mask) in runs.iter_mut().zip(rows) {
            extend(run, tile_x, mask);
        }
        tile_x += TILE;
    }
    for (y, run) in (tile_y..).zip(runs) {
        if let Some((x0, x1)) = run
            && (pixels.y0()..pixels.y1()).contains(&y)
        {
            let (x0, x1): (i32, i32) = (x0, x1);
            Span::emit_unless_empty(y, x0.max(pixels.x0()), x1.min(pixels.x1()), emit);
        }
    }
}

/// Extends a run by the covered pixels of a mask: a triangle is convex, so they are one run and continue the run so
/// far.
fn extend(run: &mut Option<(i32, i32)>, tile_x: i32, mask: u8) {
    if mask != 0 {
        let x0 = tile_x + mask.trailing_zeros() as i32;
        let x1 = tile_x + TILE - mask.leading_zeros() as i32;
        *run = Some((run.map_or(x0, |(start, _)| start), x1));
    }
}

fn decide(edges: &[Edge; 3], x: i32, y: i32) -> (Verdict, [u8; TILE as usize]) {
    let at = edges.map(|e| e.at_center(x, y));
    let far = i64::from(TILE - 1);
    // The function is linear: its extremes over the tile's centres are at two opposite corners.
    let reach = |gain: fn(i64) -> i64| edges.map(|e| far * (gain(e.step_x()) + gain(e.step_y())));
    let (up, down) = (reach(|s| s.max(0)), reach(|s| s.min(0)));
    if (0..3).any(|k| at[k] + up[k] < 0) {
        (Verdict::Rejected, [0; TILE as usize])
    } else if (0..3).all(|k| at[k] + down[k] >= 0) {
        (Verdict::Accepted, [u8::MAX; TILE as usize])
    } else {
        (Verdict::Examined, examine(edges, at))
    }
}

/// Returns the mask of each row of a tile from the functions at its first pixel.
fn examine(edges: &[Edge; 3], at: [i64; 3]) -> [u8; TILE as usize] {
    let mut outside = [0u8; TILE as usize];
    for (edge, start) in edges.iter().zip(at) {
        let mut at_row = start;
        for mask in &mut outside {
            let mut value = at_row;
            for bit in 0..TILE {
                *mask |= u8::from(value < 0) << bit;
                value += edge.step_x();
            }
            at_row += edge.step_y();
        }
    }
    outside.map(|mask| !mask)
}
