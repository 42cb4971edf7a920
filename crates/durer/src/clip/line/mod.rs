//! Line clipping: one file per algorithm.
//!
//! All agree on these rules. Windows are closed: a point on the border is inside, so a segment that
//! only touches a corner gives a point (a segment of length zero), and a segment along a border is
//! kept. End points that are inside come back bit for bit. Whether a segment meets the window, and
//! through which border, is decided exactly; a cut point lies exactly on its border and, within
//! 4 ulp of the largest coordinate, on the segment. Cut points are always computed from the
//! lexicographically smaller end point to the larger, so swapping the ends swaps the result and
//! changes no bit. Non-finite coordinates are a typed error.
//!
//! ```
//! use durer::clip::line::{LineClipper, Segment};
//! use durer::math::{DVec2, Rect};
//!
//! let window = Rect::new(DVec2::ZERO, DVec2::new(10.0, 5.0))?;
//! let segment = Segment::new(DVec2::new(-5.0, 0.0), DVec2::new(5.0, 5.0));
//! let clipped = LineClipper::CohenSutherland.clip(&window, segment)?;
//! assert_eq!(clipped, Some(Segment::new(DVec2::new(0.0, 2.5), DVec2::new(5.0, 5.0))));
//! # Ok::<(), durer::Error>(())
//! ```

pub mod batch;
pub(crate) mod border;
pub mod cohen_sutherland;
pub(crate) mod convex;
pub mod cyrus_beck;
pub mod homogeneous;
pub mod liang_barsky;
pub mod midpoint;
pub mod nicholl_lee_nicholl;
mod passage;
pub mod skala;
pub mod sobkow_pospisil_yang;

pub use border::{ClipBox, End};
pub(crate) use convex::Edge;
pub use convex::{ConvexPolygon, HalfPlane, HalfSpace};
pub use passage::HalfSpaceRelation;

use crate::math::{DVec2, Rect};
use crate::trace::NoTrace;
use crate::{Error, Result};

/// A straight piece from `start` to `end`, both included.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Segment<P> {
    /// Start of the segment.
    pub start: P,
    /// End of the segment.
    pub end: P,
}

impl<P> Segment<P> {
    /// Creates the segment from `start` to `end`.
    pub const fn new(start: P, end: P) -> Self {
        Self { start, end }
    }

    /// Returns the segment in the other direction.
    pub fn reversed(self) -> Self {
        Self { start: self.end, end: self.start }
    }
}

crate::info::family! {
    /// The line clipping algorithms.
    pub enum LineClipper {
        /// Outcodes and repeated cuts.
        CohenSutherland => cohen_sutherland::INFO,
        /// Bisection on integer pixels.
        Midpoint => midpoint::INFO,
        /// Parameters of entry and exit against convex windows.
        CyrusBeck => cyrus_beck::INFO,
        /// Parameters of entry and exit against the four borders.
        LiangBarsky => liang_barsky::INFO,
        /// Regions around the first end point.
        NichollLeeNicholl => nicholl_lee_nicholl::INFO,
        /// Signs of the window's corners against the line.
        Skala => skala::INFO,
        /// A case for each pair of regions.
        SobkowPospisilYang => sobkow_pospisil_yang::INFO,
        /// Boundary coordinates before the division by w.
        Homogeneous => homogeneous::INFO,
    }
}

impl LineClipper {
    /// Returns the part of the segment in the closed window; `None` if there is none.
    ///
    /// # Errors
    /// [`Error::NonFinite`] for a NaN or infinite coordinate; [`Error::Unsupported`] for
    /// [`LineClipper::Midpoint`], which works on integer pixels only: see [`midpoint::clip`].
    pub fn clip(self, window: &Rect, segment: Segment<DVec2>) -> Result<Option<Segment<DVec2>>> {
        let t = &mut NoTrace;
        match self {
            Self::CohenSutherland => cohen_sutherland::clip(window, segment, t),
            Self::CyrusBeck => cyrus_beck::clip(window, segment, t),
            Self::LiangBarsky => liang_barsky::clip(window, segment, t),
            Self::NichollLeeNicholl => nicholl_lee_nicholl::clip(window, segment, t),
            Self::Skala => skala::clip(window, segment, t),
            Self::SobkowPospisilYang => sobkow_pospisil_yang::clip(window, segment, t),
            Self::Homogeneous => homogeneous::clip(window, segment, t),
            Self::Midpoint => Err(Error::Unsupported {
                what: "midpoint subdivision on floating-point coordinates",
                instead: "call midpoint::clip with integer pixels, or choose another algorithm",
            }),
        }
    }
}

/// Returns the part of a segment with finite ends in the closed rectangle, for other clippers.
#[inline]
pub(crate) fn cut_inside(window: &Rect, start: DVec2, end: DVec2) -> Option<Segment<DVec2>> {
    let segment = Segment::new(start, end);
    cohen_sutherland::clip(window, segment, &mut NoTrace).ok().flatten()
}

#[cfg(test)]
mod tests;
