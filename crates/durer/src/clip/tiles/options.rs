//! The options of a pyramid.

use super::Tile;
use crate::clip::simplify::LineSimplifier;
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// Options for tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The levels, within 0 … [`Tile::MAX_ZOOM`].
    pub zooms: RangeInclusive<u8>,
    /// The side of a tile in cells of its grid; 1 to 8192.
    pub extent: u32,
    /// Distance that features continue beyond the borders, in cells; less than `extent`.
    pub buffer: u32,
    /// Method that chooses the points to leave out.
    pub method: LineSimplifier,
    /// Largest distance that lines may move on levels before the last, in cells: 3 of 4096 is three eighths of a
    /// pixel for tiles of 512. 0 leaves out only points on straight lines. The last level has all points.
    pub tolerance: f64,
    /// Polygons smaller than a square of this side, in cells, are left out; when nearby ones add up to the area of such
    /// a square, it replaces them. On the last level it is at most 1; 0 keeps all.
    pub tiny: f64,
}

impl Default for Options {
    fn default() -> Self {
        let method = LineSimplifier::Visvalingam;
        Self { zooms: 0..=14, extent: 4096, buffer: 64, method, tolerance: 3.0, tiny: 4.0 }
    }
}

/// Checks that all are within their domains.
pub(super) fn check(options: &Options) -> Result<()> {
    if options.zooms.is_empty() || *options.zooms.end() > Tile::MAX_ZOOM {
        let (a, b) = (options.zooms.start(), options.zooms.end());
        let value = format!("{a}-{b}");
        return Err(Error::parameter(
            "zoom",
            value,
            "a range within 0 to 24, the smaller one first",
        ));
    }
    if !(1..=8192).contains(&options.extent) {
        return Err(Error::parameter("extent", options.extent, "1 to 8192"));
    }
    if options.buffer >= options.extent {
        return Err(Error::parameter("buffer", options.buffer, "less than the extent"));
    }
    for (name, value) in [("tolerance", options.tolerance), ("tiny", options.tiny)] {
        if !(0.0..=8192.0).contains(&value) {
            return Err(Error::parameter(name, value, "0 to 8192"));
        }
    }
    Ok(())
}

/// Returns the side of the world in cells.
pub(super) fn cells(options: &Options, zoom: u8) -> f64 {
    f64::from(options.extent) * f64::from(1u32 << zoom)
}
