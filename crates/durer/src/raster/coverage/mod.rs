//! Anti-aliased fill by exact area coverage.
//!
//! The coverage of a pixel is the area of its part inside the outline, rounded once to 8 bits. Signed areas of edges
//! are accumulated per pixel and summed along the rows, as in Catmull, *A hidden-surface algorithm with anti-aliasing*
//! (SIGGRAPH 1978), and in the cells of D. Turner's and R. Levien's font rasterizers. This module goes beyond them in
//! two respects. Two bits per pixel mark the pixels in which windings overlap or cancel, and these are resolved
//! exactly. And an edge contributes the same integers to both of the faces that share it, so that the areas of a
//! partition add up to exactly one.
//!
//! Class: image space. Cost: O(pixels crossed by edges + pixels touched); rows are processed in bands, which are the
//! parallel tasks. Limits: sides of at most 32,767 pixels; winding numbers beyond ±32,767 wrap around; pixels crossed
//! by more than 24 edges are measured along 16 to 256 lines. Unless [`Overlap::Exact`] is requested, bands of noise use
//! the integral of the winding number as the area: these have more than 256 edges, short ones that cross each other in
//! more than a fifth of the pixels that they touch. To resolve those exactly takes twelve times as long (a random walk
//! of 10⁵ steps at 2048²: 180 ms instead of 15). The start and direction of a contour have no effect.

pub(crate) mod band;
pub mod cell_sums;
pub(crate) mod cells;
pub(crate) mod convex;
pub(crate) mod edge;
mod joints;
mod outline;
mod partition;
mod parts;
mod ramp;
mod resolve;
mod small;
pub(crate) mod sweep;

pub use partition::{INFO as PARTITION, PartitionFace, Step as PartitionStep, fill_partition};

use std::ops::Range;

use crate::simd::{Level, default_level, dispatch};
use fearless_simd::prelude::*;
use fearless_simd::u32x8;

use crate::curve::Contours;
use crate::info::{Class, Coherence, Info, Occluder};
use crate::raster::bands::BAND_ROWS;
use crate::target::Pixels;
use crate::trace::Tracer;
use crate::{Error, Result};
use band::{BandFiller, PathEdges};
use edge::Edge;
pub use edge::MAX_SIDE;
use sweep::Sink;

/// Rule that decides which winding numbers are inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FillRule {
    /// All winding numbers but 0.
    #[default]
    NonZero,
    /// Odd winding numbers.
    EvenOdd,
}

/// Treatment of pixels in which several contours, or several parts of one, overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Overlap {
    /// The area of the union, by the fill rule: opposite windings do not cancel.
    Exact,
    /// As [`Self::Exact`], except in bands of noise: bands of more than 256 short edges that cross each other in more
    /// than a fifth of the pixels that they touch. There, pixels of 5 to 32 edges are measured along 16 to 64 lines,
    /// and pixels of more edges take the integral of the winding number. Strokes use this in place of
    /// [`Overlap::Adaptive`], because their outlines overlap themselves.
    Measured,
    /// As [`Self::Exact`], except in bands of noise, where all pixels take the integral of the winding number.
    #[default]
    Adaptive,
    /// The integral of the winding number, as in most rasterizers: fast on drawings that cross themselves everywhere,
    /// but wrong by up to a whole pixel where windings of both signs meet.
    Accumulated,
}

/// Options for computing coverage from an outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Rule that decides which winding numbers are inside.
    pub rule: FillRule,
    /// Treatment of pixels in which contours overlap.
    pub overlap: Overlap,
}

/// Step of the algorithm: pixels of a row with the same coverage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Row, from the top.
    pub y: u32,
    /// First pixel.
    pub x0: u32,
    /// One past the last pixel.
    pub x1: u32,
    /// Coverage 1 … 255.
    pub coverage: u8,
}

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "area-coverage",
    title: "Exact area coverage",
    authors: "E. Catmull",
    year: 1978,
    source: "A hidden-surface algorithm with anti-aliasing, SIGGRAPH",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::ScanLine, Coherence::Span],
    cost: "O(c + p): c pixels crossed by edges, p pixels covered",
    limits: "sides up to 32,767 pixels; exact up to 24 edges through one pixel",
    pseudocode: &[],
};

/// Returns the coverage 0 … 255 of every pixel of a `width` × `height` target by the outline. All contours count as
/// closed; coordinates are in pixels, y down.
///
/// Points that are not finite are left out; parts outside the target are clipped. The error is at most the rounding to
/// 8 bits, plus 2⁻¹⁷ of a pixel for each edge through it.
///
/// # Errors
/// [`Error::TooLarge`] for sides beyond 32,767 pixels.
///
/// ```
/// use durer::curve::Contours;
/// use durer::math::DVec2;
/// use durer::raster::coverage::{Options, fill};
/// use durer::trace::NoTrace;
///
/// let corners = [(0.5, 0.5), (2.0, 0.5), (2.0, 2.0), (0.5, 2.0)];
/// let square = Contours::polygon(corners.map(|(x, y)| DVec2::new(x, y)));
/// let mask = fill(&square, 2, 2, &Options::default(), &mut NoTrace).unwrap();
/// assert_eq!(mask.data(), [64, 128, 128, 255]);
/// ```
pub fn fill(
    contours: &Contours,
    width: u32,
    height: u32,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u8>> {
    fill_at(default_level(), contours, width, height, options, t)
}

fn fill_at(
    level: Level,
    contours: &Contours,
    width: u32,
    height: u32,
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Pixels<u8>> {
    check_size(width, height)?;
    let mut mask = Pixels::new(width, height, 0);
    let mut list = Vec::new();
    let path = PathEdges::new(contours, width, height, &mut list);
    fill_path(level, &path, &list, &mut mask, options, t);
    Ok(mask)
}

/// Fills a path for a mask of that size.
fn fill_path(
    level: Level,
    path: &PathEdges,
    list: &[Edge],
    mask: &mut Pixels<u8>,
    options: &Options,
    t: &mut impl Tracer<Step>,
) {
    let mut filler = BandFiller::new(mask.width());
    for top in (0..mask.height() as i32).step_by(BAND_ROWS as usize).filter(|t| !path.misses(*t)) {
        let mut sink = Mask { mask, top, t };
        dispatch!(level, simd => {
            BandFiller::fill(simd, &mut filler, path.with(list), top, options, &mut sink);
        });
    }
}

/// Sink that writes coverage to a mask.
struct Mask<'a, T> {
    mask: &'a mut Pixels<u8>,
    /// First row of the band.
    top: i32,
    t: &'a mut T,
}

impl<S: Simd, T: Tracer<Step>> Sink<S> for Mask<'_, T> {
    #[inline(always)]
    fn eight(&mut self, _: S, row: i32, x: usize, coverage: u32x8<S>) {
        let mut own = [0; 8];
        coverage.store_slice(&mut own);
        let y = (self.top + row) as u32;
        for ((i, pixel), own) in self.mask.row_mut(y).iter_mut().enumerate().skip(x).zip(own) {
            *pixel = own as u8;
            if own != 0 {
                let x0 = i as u32;
                self.t.step(|| Step { y, x0, x1: x0 + 1, coverage: own as u8 });
            }
        }
    }

    #[inline(always)]
    fn span(&mut self, _: S, row: i32, x: Range<usize>, coverage: u8) {
        let y = (self.top + row) as u32;
        if let Some(pixels) = self.mask.row_mut(y).get_mut(x.clone()) {
            pixels.fill(coverage);
        }
        self.t.step(|| Step { y, x0: x.start as u32, x1: x.end as u32, coverage });
    }
}

/// Checks that targets of this size can be filled.
pub(crate) fn check_size(width: u32, height: u32) -> Result<()> {
    let side = width.max(height);
    if side > MAX_SIDE {
        return Err(Error::TooLarge {
            what: "number of pixels per side",
            value: u64::from(side),
            limit: u64::from(MAX_SIDE),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
mod turns;
