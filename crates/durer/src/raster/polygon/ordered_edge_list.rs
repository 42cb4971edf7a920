//! Polygon scan conversion by the simple ordered edge list: all crossings of edges with rows first, sorted by row
//! and column, then pairs of them filled.
//!
//! D. F. Rogers, *Procedural Elements for Computer Graphics*, McGraw-Hill 1985, section 2-19. Class: image space. Cost:
//! O(crossings · crossings of their row) if a row has few, O(crossings + pixels) if it has many; an edge costs two
//! divisions, and rows cost none. Limits: vertices are snapped to 1/256 of a pixel; sides of at most 32,767 pixels.
//!
//! Deviations: rows are processed in bands of 32, winding numbers take the place of pairs, and a band in which a row
//! has more than 32 crossings counts them per pixel instead of sorting them (a winding number's difference from
//! pixel to pixel, summed along the row).

use std::ops::Range;

use crate::simd::{Level, default_level, dispatch};
use fearless_simd::prelude::*;
use fearless_simd::u32x8;

pub use super::Options;
use super::crossings::{CrossingEdges, CrossingFiller, Path};
use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::raster::bands::BAND_ROWS;
use crate::raster::coverage::sweep::Sink;
use crate::raster::span::Span;
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "ordered-edge-list",
    title: "Simple ordered edge list",
    authors: "D. F. Rogers",
    year: 1985,
    source: "Procedural Elements for Computer Graphics, McGraw-Hill",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::Span],
    cost: "O(c + p): c crossings of edges with rows, p pixels covered",
    limits: "vertices are snapped to 1/256 of a pixel; sides up to 32,767 pixels",
    pseudocode: &[
        "list ← ∅",
        "for each edge of the polygon:",
        "    for each row whose centre it crosses:",
        "        x ← first pixel right of the crossing",
        "        add (y, x, direction) to the list",
        "sort the list by y, then by x",
        "for each row:",
        "    for each two neighbours with the inside between them, by the rule:",
        "        fill from the x of the first to that of the second, exclusive",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// An edge crosses the centre of a row.
    Crossing {
        /// Row.
        y: i32,
        /// First pixel whose centre is not left of the edge, from 0 to one past the last column.
        x: i32,
        /// Change of the winding number there.
        winding: i32,
    },
    /// A span is emitted.
    Span(Span),
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Crossing { .. } => 5,
            Self::Span(_) => 9,
        }
    }
}

/// Calls `emit` for the spans of the polygon within a `width` × `height` target, row by row and from left to right;
/// contours count as closed, points that are not finite are left out. Coordinates in pixels. Of targets larger than
/// 32,767 pixels in a direction, only that part is filled.
pub fn fill(
    contours: &Contours,
    width: u32,
    height: u32,
    options: &Options,
    mut emit: impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    fill_at(default_level(), contours, (width, height), options, &mut emit, t);
}

fn fill_at(
    level: Level,
    contours: &Contours,
    (width, height): (u32, u32),
    options: &Options,
    emit: &mut impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    const LARGEST: u32 = crate::raster::coverage::edge::MAX_SIDE;
    let (width, height) = (width.min(LARGEST), height.min(LARGEST));
    let mut list = Vec::new();
    let path = CrossingEdges::new(contours, width, height, &mut list);
    let mut filler = CrossingFiller::new(width);
    for top in (0..height as i32).step_by(BAND_ROWS as usize).filter(|top| !path.misses(*top)) {
        trace_crossings(path.with(&list), top, width as usize, t);
        let mut sink = Spans { top, width: width as i32, open: NONE, emit, t };
        dispatch!(level, simd => {
            CrossingFiller::fill(simd, &mut filler, path.with(&list), top, options.rule, &mut sink);
        });
        sink.close();
    }
}

fn trace_crossings(path: Path<'_>, top: i32, width: usize, t: &mut impl Tracer<Step>) {
    path.for_each(top, width, |row, x, down| {
        let mut listens = false;
        t.step(|| {
            listens = true;
            let winding = if down { 1 } else { -1 };
            Step::Crossing { y: top + row as i32, x: x as i32, winding }
        });
        listens
    });
}

/// No span.
const NONE: Span = Span { y: 0, x0: 0, x1: 0 };

/// Spans that are joined from the band's output.
struct Spans<'a, E, T> {
    top: i32,
    width: i32,
    open: Span,
    emit: &'a mut E,
    t: &'a mut T,
}

impl<E: FnMut(Span), T: Tracer<Step>> Spans<'_, E, T> {
    fn add(&mut self, y: i32, x0: i32, x1: i32) {
        if (self.open.y, self.open.x1) != (y, x0) {
            self.close();
            self.open = Span { y, x0, x1 };
        }
        self.open.x1 = x1;
    }

    fn close(&mut self) {
        let span = std::mem::replace(&mut self.open, NONE);
        if span.x0 < span.x1 {
            self.t.step(|| Step::Span(span));
            (self.emit)(span);
        }
    }
}

impl<S: Simd, E: FnMut(Span), T: Tracer<Step>> Sink<S> for Spans<'_, E, T> {
    #[inline(always)]
    fn eight(&mut self, _: S, row: i32, x: usize, coverage: u32x8<S>) {
        let mut own = [0; 8];
        coverage.store_slice(&mut own);
        for (x, _) in (x as i32..self.width).zip(own).filter(|(_, c)| *c != 0) {
            self.add(self.top + row, x, x + 1);
        }
    }

    #[inline(always)]
    fn span(&mut self, _: S, row: i32, x: Range<usize>, _: u8) {
        self.add(self.top + row, x.start as i32, x.end as i32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec2;
    use crate::raster::coverage::FillRule;
    use crate::trace::NoTrace;

    #[test]
    fn every_simd_level_gives_the_same_spans() {
        let mut seed = 3_u64;
        let mut random = || {
            let (a, c) = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            seed = seed.wrapping_mul(a).wrapping_add(c);
            (seed >> 33) as f64 / f64::from(1_u32 << 31) * 300.0 - 20.0
        };
        let contours = Contours::polygon((0..90).map(|_| DVec2::new(random(), random())));
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let at = |level| {
                let mut spans = Vec::new();
                let mut keep = |s| spans.push(s);
                fill_at(level, &contours, (257, 261), &Options { rule }, &mut keep, &mut NoTrace);
                spans
            };
            let reference = at(Level::baseline());
            assert_eq!(at(Level::new()), reference);
            assert!(reference.len() > 261);
        }
    }
}
