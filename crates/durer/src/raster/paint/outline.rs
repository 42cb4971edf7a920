//! Outlines prepared for filling, with smooth or with hard edges.

use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

use crate::curve::Contours;
use crate::raster::coverage;
use crate::raster::coverage::band::{self, BandFiller, PartsOfPath, PathEdges};
use crate::raster::coverage::edge::Edge;
use crate::raster::coverage::sweep::Sink;
use crate::raster::polygon::crossings::{self, CrossingEdges, CrossingFiller};

/// The edges of outlines that have few.
#[derive(Debug, Default)]
pub(super) struct Lists {
    smooth: Vec<Edge>,
    hard: Vec<crossings::Edge>,
}

impl Lists {
    /// Empties them and keeps the memory.
    pub fn clear(&mut self) {
        self.smooth.clear();
        self.hard.clear();
    }

    /// Returns their size in bytes.
    pub fn bytes(&self) -> u64 {
        let smooth = self.smooth.capacity() * size_of::<Edge>();
        (smooth + self.hard.capacity() * size_of::<crossings::Edge>()) as u64
    }
}

/// The edges of a filled outline.
#[derive(Debug)]
pub(super) enum Outline {
    /// Pixels are covered by the area inside.
    Smooth(PathEdges),
    /// Pixels are covered whose centre is inside.
    Hard(CrossingEdges),
}

impl Outline {
    /// Creates the outline of contours in a target of the given size; a few edges are added to the
    /// lists.
    pub fn new(
        contours: &Contours,
        (width, height): (u32, u32),
        smooth: bool,
        lists: &mut Lists,
    ) -> Self {
        if smooth {
            Self::Smooth(PathEdges::new(contours, width, height, &mut lists.smooth))
        } else {
            Self::Hard(CrossingEdges::new(contours, width, height, &mut lists.hard))
        }
    }

    /// Returns the outline with smooth edges of a path that came in parts.
    pub fn of_parts(parts: PartsOfPath, lists: &mut Lists) -> Self {
        Self::Smooth(parts.path(&mut lists.smooth))
    }

    /// Returns its size besides the lists, in bytes.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Smooth(path) => path.bytes(),
            Self::Hard(path) => path.bytes(),
        }
    }

    /// Returns the first row touched and one past the last; the second is not larger if there is nothing to fill.
    pub fn rows(&self) -> (i32, i32) {
        match self {
            Self::Smooth(path) => path.rows,
            Self::Hard(path) => path.rows,
        }
    }

    /// Returns the outline with the lists it was made with.
    pub fn with<'a>(&'a self, lists: &'a Lists) -> Drawn<'a> {
        match self {
            Self::Smooth(path) => Drawn::Smooth(path.with(&lists.smooth)),
            Self::Hard(path) => Drawn::Hard(path.with(&lists.hard)),
        }
    }
}

/// An outline with all its edges.
#[derive(Debug, Clone, Copy)]
pub(super) enum Drawn<'a> {
    Smooth(band::Path<'a>),
    Hard(crossings::Path<'a>),
}

impl Drawn<'_> {
    /// Returns its rows as [`Outline::rows`] does.
    pub fn rows(&self) -> (i32, i32) {
        match self {
            Self::Smooth(path) => path.rows(),
            Self::Hard(path) => path.rows(),
        }
    }
}

/// The buffers of one thread for filling outlines.
#[derive(Debug, Default)]
pub(super) struct Filler {
    smooth: BandFiller,
    hard: CrossingFiller,
}

impl Filler {
    /// Creates buffers for rows of `width` pixels.
    pub fn new(width: u32) -> Self {
        Self { smooth: BandFiller::new(width), hard: CrossingFiller::new(width) }
    }

    /// Passes the coverage of an outline in the band at row `top` to the sink.
    #[simd]
    pub fn fill<S: Simd, K: Sink<S>>(
        simd: S,
        this: &mut Self,
        outline: Drawn<'_>,
        top: i32,
        how: &coverage::Options,
        sink: &mut K,
    ) {
        match outline {
            Drawn::Smooth(path) => {
                BandFiller::fill(simd, &mut this.smooth, path, top, how, sink);
            }
            Drawn::Hard(path) => {
                CrossingFiller::fill(simd, &mut this.hard, path, top, how.rule, sink);
            }
        }
    }
}
