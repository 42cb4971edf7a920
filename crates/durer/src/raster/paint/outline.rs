//! Outlines made ready for filling, with smooth or with hard edges.

use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use super::FillRule;
use crate::curve::Contours;
use crate::raster::coverage::band::{BandFiller, PathEdges};
use crate::raster::coverage::sweep::Sink;
use crate::raster::polygon::crossings::{CrossingEdges, CrossingFiller};

/// The edges of something filled.
#[derive(Debug)]
pub(super) enum Outline {
    /// Pixels are covered by the area inside.
    Smooth(PathEdges),
    /// Pixels are covered whose centre is inside.
    Hard(CrossingEdges),
}

impl Outline {
    /// The outline of contours in a target of the given size.
    pub fn new(contours: &Contours, width: u32, height: u32, smooth: bool) -> Self {
        if smooth {
            Self::Smooth(PathEdges::new(contours, width, height))
        } else {
            Self::Hard(CrossingEdges::new(contours, width, height))
        }
    }

    /// First row touched and one past the last; the second is not larger where there is nothing to fill.
    pub fn rows(&self) -> (i32, i32) {
        match self {
            Self::Smooth(path) => path.rows,
            Self::Hard(path) => path.rows,
        }
    }

    /// Whether no row of the band that starts at row `top` is touched.
    pub fn misses(&self, top: i32) -> bool {
        match self {
            Self::Smooth(path) => path.misses(top),
            Self::Hard(path) => path.misses(top),
        }
    }
}

/// The buffers of one thread for filling outlines.
#[derive(Debug)]
pub(super) struct Filler {
    smooth: BandFiller,
    hard: CrossingFiller,
    /// Whether areas are exact where outlines overlap.
    exact: bool,
}

impl Filler {
    /// Buffers for rows of `width` pixels.
    pub fn new(width: u32, exact: bool) -> Self {
        Self { smooth: BandFiller::new(width), hard: CrossingFiller::new(width), exact }
    }

    /// Hands what an outline covers of the band at row `top` to the sink.
    #[simd]
    pub fn fill<S: Simd, K: Sink<S>>(
        simd: S,
        this: &mut Self,
        outline: &Outline,
        top: i32,
        rule: FillRule,
        sink: &mut K,
    ) {
        match outline {
            Outline::Smooth(path) => {
                BandFiller::fill(simd, &mut this.smooth, path, top, rule, this.exact, sink);
            }
            Outline::Hard(path) => {
                CrossingFiller::fill(simd, &mut this.hard, path, top, rule, sink);
            }
        }
    }
}
