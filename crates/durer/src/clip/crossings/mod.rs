//! All crossings of many segments: where two or more of them meet.
//!
//! Segments are closed, and every point that at least two of them have in common counts, at ends too. These cases are defined
//! as follows, exactly and for all finite coordinates:
//!
//! - segments that share an end meet there;
//! - a segment that ends on another one meets it there;
//! - segments of one line that overlap meet at the two ends of their common piece;
//! - vertical segments run upwards, and a segment of length zero is a point, which may lie on others.
//!
//! ```
//! use durer::clip::crossings::{Options, all_pairs, bentley_ottmann};
//! use durer::clip::line::Segment;
//! use durer::math::DVec2;
//! use durer::trace::NoTrace;
//!
//! let segment = |a: [f64; 2], b: [f64; 2]| Segment::new(DVec2::from(a), DVec2::from(b));
//! let segments = [segment([0.0, 0.0], [4.0, 4.0]), segment([0.0, 4.0], [4.0, 0.0]), segment([2.0, 0.0], [2.0, 9.0])];
//! let found = bentley_ottmann::crossings(&segments, &Options::default(), &mut NoTrace)?;
//! assert_eq!((found[0].at, &found[0].segments[..]), (DVec2::splat(2.0), &[0, 1, 2][..]));
//! assert_eq!(found, all_pairs(&segments, &Options::default())?);
//! # Ok::<(), durer::Error>(())
//! ```

pub mod bentley_ottmann;
mod point;

use super::line::Segment;
use crate::math::DVec2;
use crate::{Error, Result};
use point::{Meeting, Point, meeting, ordered};
use std::collections::{BTreeMap, BTreeSet};

/// Options for finding crossings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// The most crossings that may be found.
    pub max_crossings: usize,
}

impl Default for Options {
    /// Returns the default: at most a million crossings.
    fn default() -> Self {
        Self { max_crossings: 1 << 20 }
    }
}

impl Options {
    fn check(&self, found: usize) -> Result<()> {
        if found <= self.max_crossings {
            return Ok(());
        }
        let (value, limit) = (found as u64, self.max_crossings as u64);
        Err(Error::Limit { what: "number of crossings of segments", value, limit })
    }
}

/// A point where segments meet.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// The point, each coordinate correctly rounded; points that differ by less than that may have the same numbers.
    pub at: DVec2,
    /// Indices of all segments through it, the smallest first; at least two.
    pub segments: Vec<u32>,
}

/// Returns the ends of the segments in the order of the sweep.
fn checked(segments: &[Segment<DVec2>]) -> Result<Vec<[DVec2; 2]>> {
    let is_finite = |s: &Segment<DVec2>| s.start.is_finite() && s.end.is_finite();
    match segments.iter().position(|segment| !is_finite(segment)) {
        Some(index) => Err(Error::NonFinite { what: "segment", index }),
        None => Ok(segments.iter().map(|s| ordered([s.start, s.end])).collect()),
    }
}

/// Returns all crossings in the order of their x and y, by comparing each segment with each other: O(n²).
///
/// # Errors
/// [`Error::NonFinite`]; [`Error::Limit`] for more crossings than the options allow.
pub fn all_pairs(segments: &[Segment<DVec2>], options: &Options) -> Result<Vec<Crossing>> {
    let segments = checked(segments)?;
    let mut found = BTreeMap::<Point, BTreeSet<u32>>::new();
    for (b, second) in segments.iter().enumerate() {
        for (a, first) in segments[..b].iter().enumerate() {
            let points = match meeting(*first, *second) {
                Meeting::Apart => continue,
                Meeting::At(point) => vec![point],
                Meeting::Along(ends) => ends.into(),
            };
            for point in points {
                found.entry(point).or_default().extend([a as u32, b as u32]);
            }
            options.check(found.len())?;
        }
    }
    let crossing = |(at, segments): (Point, BTreeSet<u32>)| Crossing {
        at: at.near(),
        segments: segments.into_iter().collect(),
    };
    Ok(found.into_iter().map(crossing).collect())
}
