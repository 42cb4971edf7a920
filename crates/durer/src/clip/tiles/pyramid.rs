//! Features as vector tiles have them: simplified, on a grid of whole numbers, cut at the tiles' borders.
//!
//! All of a layer is simplified together, so that what neighbours share stays shared
//! ([`crate::clip::simplify::coverage`]); once for all levels. The grid of a level is the same in all tiles, so
//! that features are put on it, and made valid there, before they are cut, and meet across borders. Where a
//! cut makes new points, those are put on the grid too, and the part is made valid again.
//!
//! What lies beyond the world, or reaches beyond it by its buffer, comes from the other side as well.

use super::Tile;
use super::level::{Level, Part};
use super::piece::{Body, Shape};
use super::walk::{count as count_tiles, walk};
use crate::clip::polygon::{FillRule, Polygon, signed_area};
use crate::clip::simplify::coverage::Options as Simplify;
use crate::clip::simplify::{Coverage, LineSimplifier};
use crate::math::{DVec2, Rect};
use crate::trace::NoTrace;
use crate::{Error, Result, parallel};
use std::ops::RangeInclusive;

/// A feature in the square of [`super::mercator`].
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// Features of one layer are simplified together.
    pub layer: usize,
    /// Its geometry, within [`WORLDS`].
    pub body: Body,
    /// Fill rule of its areas.
    pub fill: FillRule,
}

/// Distance from the square that features may reach, in its sides.
pub const WORLDS: f64 = 4.0;

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
    /// Polygons smaller than a square of this side, in cells, are left out; whenever those near to each other
    /// are together as large, such a square stands for them. On the last level it is 1 at most; 0 leaves all in.
    pub tiny: f64,
}

impl Default for Options {
    fn default() -> Self {
        let method = LineSimplifier::Visvalingam;
        Self { zooms: 0..=14, extent: 4096, buffer: 64, method, tolerance: 3.0, tiny: 4.0 }
    }
}

/// A part of a feature in a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The index of the feature.
    pub feature: usize,
    /// On the grid of the tile: (0, 0) is its upper left corner, y counts downwards. Outer rings have positive signed
    /// areas in these coordinates, holes negative ones.
    pub shape: Shape,
}

/// Features made ready for all levels.
#[derive(Debug)]
pub struct Pyramid {
    pub(super) features: Vec<Ready>,
    pub(super) options: Options,
}

/// A feature with what is known of it for all levels.
#[derive(Debug)]
pub(super) struct Ready {
    pub layer: usize,
    pub body: Body,
    pub fill: FillRule,
    pub bounds: Rect,
    /// The first level that has each point; empty for points.
    pub levels: Vec<u8>,
    /// The area of each polygon.
    pub areas: Vec<f64>,
    /// Number of polygons in the features before.
    pub polygons_before: usize,
}

impl Pyramid {
    /// Makes features ready: finds out which points each level has. Those without a point are in no tile.
    ///
    /// # Errors
    /// [`Error::NonFinite`] and [`Error::Parameter`] for places beyond [`WORLDS`] and for options outside of their domains;
    /// [`Error::Limit`] for 2³² points of one layer and more.
    pub fn new(features: Vec<Feature>, options: Options) -> Result<Self> {
        check(&options)?;
        let layers = features.iter().map(|f| f.layer + 1).max().unwrap_or(0);
        let mut levels: Vec<Vec<u8>> = vec![Vec::new(); features.len()];
        let found =
            parallel::map((0..layers).collect(), |layer| layer_levels(&features, layer, &options));
        for (feature, of_feature) in
            found.into_iter().collect::<Result<Vec<_>>>()?.into_iter().flatten()
        {
            levels[feature] = of_feature;
        }
        let mut polygons_before = 0;
        let ready = |(feature, levels): (Feature, Vec<u8>)| {
            let ready = Ready::new(feature, levels, polygons_before)?;
            polygons_before += ready.areas.len();
            Ok(ready)
        };
        let features = features.into_iter().zip(levels).map(ready).collect::<Result<_>>()?;
        Ok(Self { features, options })
    }

    /// Visits the tiles of a level that something lies in, in the order of their numbers; the pieces are in the
    /// order of the features. See [`walk()`](super::walk()).
    ///
    /// # Errors
    /// Of the overlay, and what `take` says.
    pub fn visit<R: Send, E: From<Error>>(
        &self,
        zoom: u8,
        make: impl Fn(Tile, Vec<Piece>) -> R + Sync + Send,
        mut take: impl FnMut(Tile, R) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let level = Level::new(self, zoom.min(Tile::MAX_ZOOM));
        let finish = |tile: Tile, parts: Vec<Part<'_>>| {
            let pieces = parts.into_iter().filter_map(|part| part.finished(tile).transpose());
            let pieces = pieces.collect::<Result<Vec<_>>>()?;
            Ok((!pieces.is_empty()).then(|| make(tile, pieces)))
        };
        walk(&level.contents(), level.zoom, finish, |tile, made: Result<Option<R>>| match made? {
            Some(made) => take(tile, made),
            None => Ok(()),
        })
    }

    /// Returns a lower bound of the number of tiles on all levels, counted up to a limit. See
    /// [`count()`](super::count()).
    ///
    /// # Errors
    /// Of the overlay.
    pub fn count(&self, limit: u64) -> Result<u64> {
        let zooms = || self.options.zooms.clone();
        let levels = zooms().map(|zoom| Level::new(self, zoom).count_of_boxes());
        let boxes = levels.fold(0u64, u64::saturating_add);
        if boxes <= limit {
            return Ok(boxes);
        }
        let mut count = 0u64;
        // The last level has the most of them.
        for zoom in zooms().rev() {
            let level = Level::new(self, zoom);
            let left = limit.saturating_sub(count);
            count = count.saturating_add(count_tiles(&level.contents(), zoom, left)?);
            if count > limit {
                break;
            }
        }
        Ok(count)
    }
}

fn check(options: &Options) -> Result<()> {
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

/// Returns the first level that has each point, of the lines and areas of a layer.
fn layer_levels(
    features: &[Feature],
    layer: usize,
    options: &Options,
) -> Result<Vec<(usize, Vec<u8>)>> {
    let mut coverage = Coverage::default();
    let own = || features.iter().enumerate().filter(|(_, f)| f.layer == layer);
    for (_, feature) in own() {
        match &feature.body {
            Body::Points(_) => {}
            Body::Lines { points, ends } => runs(ends).for_each(|run| {
                coverage.push_line(points.get(run).unwrap_or_default().iter().copied());
            }),
            Body::Areas(shapes) => {
                shapes.rings().for_each(|ring| coverage.push_ring(ring.iter().copied()));
            }
        }
    }
    let (first, last) = (*options.zooms.start(), *options.zooms.end());
    let tolerance = |zoom: u8| options.tolerance / cells(options, zoom);
    let limit = if first < last { tolerance(first) } else { 0.0 };
    let simplify = Simplify { method: options.method, limit };
    let mut weights = coverage.weights(&simplify, &mut NoTrace)?.into_iter();
    let level = |weight: f64| (first..last).find(|&zoom| weight > tolerance(zoom)).unwrap_or(last);
    let levels = own()
        .filter(|(_, f)| !matches!(f.body, Body::Points(_)))
        .map(|(i, f)| (i, weights.by_ref().take(f.body.points().len()).map(level).collect()));
    Ok(levels.collect())
}

/// Returns the side of the world in cells.
pub(super) fn cells(options: &Options, zoom: u8) -> f64 {
    f64::from(options.extent) * f64::from(1u32 << zoom)
}

/// Returns the ranges between ends.
pub(super) fn runs(ends: &[usize]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(ends.iter().copied()).map(|(start, end)| start..end)
}

impl Ready {
    fn new(feature: Feature, levels: Vec<u8>, polygons_before: usize) -> Result<Self> {
        let Feature { layer, body, fill } = feature;
        let points = body.points();
        if let Some(index) = points.iter().position(|p| !p.is_finite()) {
            return Err(Error::NonFinite { what: "point", index });
        }
        let bounds = Rect::around(points.iter().copied());
        let bounds = bounds.map_or_else(|| Rect::new(DVec2::ZERO, DVec2::ZERO), Ok)?;
        let far = bounds.min().cmplt(DVec2::splat(-WORLDS))
            | bounds.max().cmpgt(DVec2::splat(1.0 + WORLDS));
        if far.any() {
            return Err(Error::parameter("place", bounds.max(), "within four worlds of the first"));
        }
        let areas = match &body {
            Body::Areas(shapes) => shapes.polygons().map(area).collect(),
            _ => Vec::new(),
        };
        Ok(Self { layer, body, fill, bounds, levels, areas, polygons_before })
    }
}

/// Returns the area of a polygon, whichever way its rings run.
fn area(polygon: Polygon<'_>) -> f64 {
    let holes: f64 = polygon.holes().map(|hole| signed_area(hole).abs()).sum();
    (signed_area(polygon.outer()).abs() - holes).max(0.0)
}
