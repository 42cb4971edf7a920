//! Coverage by cover and area in cells, as published; [`super::fill`] does the same with integers, bands and lanes.
//!
//! Each edge is cut at the sides of the pixels that it crosses. A piece adds its height to the *cover* of its pixel,
//! and its height times the distance of its middle from the pixel's right side to the pixel's *area*. Along a row, the
//! covers of all cells to the left and the area of the cell itself add up to the integral of the winding number over
//! the pixel.
//!
//! Deviations: numbers are f64; edges left of the target count as its left side. Class: image space. Cost: O(c log c +
//! p), c pixels crossed by edges and p covered. Limits: where contours overlap, the integral is not the area of their
//! union.

use super::{FillRule, check_size};
use crate::Result;
use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::DVec2;
use crate::target::Pixels;
use crate::trace::{PseudocodeLine, Tracer};
use std::collections::BTreeMap;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "cell-sums",
    title: "Coverage by cover and area in cells",
    authors: "D. Turner; R. Levien",
    year: 2000,
    source: "The smooth rasterizer of FreeType 2, after LibArt",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::ScanLine, Coherence::Span],
    cost: "O(c log c + p): c pixels crossed by edges, p pixels covered",
    limits: "where contours overlap, the integral of the winding number is rounded",
    pseudocode: &[
        "for each edge, cut at the sides of the pixels that it crosses:",
        "    for each piece from p to q, in pixel (x, y):",
        "        cover[x, y] ← cover[x, y] + (q.y − p.y)",
        "        area[x, y] ← area[x, y] + (q.y − p.y) · (x + 1 − (p.x + q.x) / 2)",
        "for each row y with cells:",
        "    sum ← 0",
        "    for each cell (x, y) of the row from left to right:",
        "        pixel(x, y) ← share of sum + area[x, y], by the fill rule",
        "        sum ← sum + cover[x, y]",
        "        pixels up to the next cell ← share of sum",
    ],
};

/// Sums of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellSum {
    /// Sum of the heights of the pieces of edges, positive for edges that run towards larger y; −1 … 1 without
    /// overlaps.
    pub cover: f64,
    /// Sum of those heights, each times the distance from the middle of the piece to the right side of the pixel.
    pub area: f64,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A piece of an edge is added to the cell of a pixel.
    Piece {
        /// Column and row.
        pixel: [u32; 2],
        /// Start and end of the piece, in pixels.
        ends: [DVec2; 2],
        /// Contribution of the piece.
        adds: CellSum,
        /// The cell's sums with it.
        cell: CellSum,
    },
    /// Coverage of a pixel with a cell.
    Pixel {
        /// Column and row.
        pixel: [u32; 2],
        /// Covers of the cells to the left in the row.
        sum: f64,
        /// The cell's own sums.
        cell: CellSum,
        /// Coverage 0 … 255.
        coverage: u8,
    },
    /// Coverage of the pixels between two cells.
    Span {
        /// Row.
        y: u32,
        /// First column, and one past the last.
        columns: [u32; 2],
        /// Covers of the cells to the left in the row.
        sum: f64,
        /// Coverage 0 … 255.
        coverage: u8,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Piece { .. } => 4,
            Self::Pixel { .. } => 8,
            Self::Span { .. } => 10,
        }
    }
}

/// Returns the coverage that a list of steps leads to, on a target of this size.
pub fn replay(steps: &[Step], width: u32, height: u32) -> Pixels<u8> {
    let mut mask = Pixels::new(width, height, 0);
    for step in steps {
        match *step {
            Step::Piece { .. } => {}
            Step::Pixel { pixel: [x, y], coverage, .. } => mask.set(x, y, coverage),
            Step::Span { y, columns: [x0, x1], coverage, .. } => {
                (x0..x1).for_each(|x| mask.set(x, y, coverage));
            }
        }
    }
    mask
}

/// Returns the coverage 0 … 255 of every pixel of a `width` × `height` target by the outline, whose contours count as
/// closed; coordinates in pixels. Points that are not finite are left out; parts outside the target are clipped.
///
/// # Errors
/// [`crate::Error::TooLarge`] for sides beyond 32,767 pixels.
///
/// ```
/// use durer::curve::Contours;
/// use durer::math::DVec2;
/// use durer::raster::coverage::{FillRule, cell_sums};
/// use durer::trace::NoTrace;
///
/// let corners = [(0.25, 0.0), (1.5, 0.0), (1.5, 1.0), (0.25, 1.0)];
/// let strip = Contours::polygon(corners.map(|(x, y)| DVec2::new(x, y)));
/// let mask = cell_sums::fill(&strip, 3, 1, FillRule::NonZero, &mut NoTrace)?;
/// assert_eq!(mask.data(), [191, 128, 0]);
/// # Ok::<(), durer::Error>(())
/// ```
pub fn fill(
    contours: &Contours,
    width: u32,
    height: u32,
    rule: FillRule,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u8>> {
    check_size(width, height)?;
    let mut sums = Sums { size: [width, height], cells: BTreeMap::new() };
    for (contour, _) in contours.iter() {
        let points: Vec<DVec2> = contour.iter().copied().filter(|p| p.is_finite()).collect();
        for (&a, &b) in points.iter().zip(points.iter().cycle().skip(1)) {
            sums.edge(a, b, t);
        }
    }
    Ok(sums.sweep(rule, t))
}

/// Cells by row and column.
struct Sums {
    size: [u32; 2],
    cells: BTreeMap<[u32; 2], CellSum>,
}

impl Sums {
    /// Adds an edge row by row.
    fn edge(&mut self, a: DVec2, b: DVec2, t: &mut impl Tracer<Step>) {
        let height = f64::from(self.size[1]);
        let (low, high) = (a.y.min(b.y).clamp(0.0, height), a.y.max(b.y).clamp(0.0, height));
        let at = |y: f64| {
            let along = ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
            DVec2::new(a.x * (1.0 - along) + b.x * along, y)
        };
        for y in low.floor() as u32..high.ceil() as u32 {
            let (top, bottom) = (low.max(f64::from(y)), high.min(f64::from(y) + 1.0));
            let ends = if a.y < b.y { [at(top), at(bottom)] } else { [at(bottom), at(top)] };
            self.row(y, ends, t);
        }
    }

    /// Adds a part of an edge within one row, column by column in its direction.
    fn row(&mut self, y: u32, [p, q]: [DVec2; 2], t: &mut impl Tracer<Step>) {
        let width = f64::from(self.size[0]);
        let column = |x: f64| x.floor().clamp(-1.0, width) as i64;
        let (first, last) = (column(p.x.min(q.x)), column(p.x.max(q.x)));
        let at = |x: f64| {
            let along = ((x - p.x) / (q.x - p.x)).clamp(0.0, 1.0);
            DVec2::new(x, p.y * (1.0 - along) + q.y * along)
        };
        for k in 0..=last - first {
            let x = if p.x <= q.x { first + k } else { last - k };
            let (left, right) = (x as f64, x as f64 + 1.0);
            // The first column holds all that is left of the target.
            let within = |end: DVec2| (x < 0 || end.x >= left) && end.x <= right;
            let side = |end: DVec2| if end.x < left { at(left) } else { at(right) };
            let ends = [p, q].map(|end| if within(end) { end } else { side(end) });
            let Ok(x) = u32::try_from(x.max(0)) else { continue };
            if x < self.size[0] && ends[0].y != ends[1].y {
                self.piece([x, y], ends.map(|end| end.max(DVec2::ZERO)), t);
            }
        }
    }

    fn piece(&mut self, [x, y]: [u32; 2], ends: [DVec2; 2], t: &mut impl Tracer<Step>) {
        let [p, q] = ends;
        let cover = q.y - p.y;
        let adds = CellSum { cover, area: cover * (f64::from(x) + 1.0 - (p.x + q.x) / 2.0) };
        let cell = self.cells.entry([y, x]).or_default();
        cell.cover += adds.cover;
        cell.area += adds.area;
        let cell = *cell;
        t.step(|| Step::Piece { pixel: [x, y], ends, adds, cell });
    }

    /// Adds up the cells along the rows.
    fn sweep(self, rule: FillRule, t: &mut impl Tracer<Step>) -> Pixels<u8> {
        let [width, height] = self.size;
        let mut mask = Pixels::new(width, height, 0);
        let mut cells = self.cells.into_iter().peekable();
        let mut sum = 0.0;
        while let Some(([y, x], cell)) = cells.next() {
            let coverage = share(sum + cell.area, rule);
            t.step(|| Step::Pixel { pixel: [x, y], sum, cell, coverage });
            mask.set(x, y, coverage);
            sum += cell.cover;
            let next = cells.peek().filter(|([row, _], _)| *row == y);
            let end = next.map_or(width, |([_, x], _)| *x);
            let coverage = share(sum, rule);
            if x + 1 < end && coverage > 0 {
                t.step(|| Step::Span { y, columns: [x + 1, end], sum, coverage });
                (x + 1..end).for_each(|x| mask.set(x, y, coverage));
            }
            if next.is_none() {
                sum = 0.0;
            }
        }
        mask
    }
}

/// Returns the coverage 0 … 255 of an integral of the winding number over a pixel.
fn share(sum: f64, rule: FillRule) -> u8 {
    let part = match rule {
        FillRule::NonZero => sum.abs().min(1.0),
        FillRule::EvenOdd => {
            let folded = sum.rem_euclid(2.0);
            folded.min(2.0 - folded)
        }
    };
    (part * 255.0 + 0.5) as u8
}
