//! Features as vector tiles have them: simplified, on a grid of whole numbers, cut at the tiles' borders.
//!
//! A whole layer is simplified together, once for all levels, so that shared borders stay shared
//! ([`crate::clip::simplify::coverage`]). The grid of a level is the same in all tiles, so features are put on it, and
//! made valid there, before they are clipped, and match across tile borders. New points of a cut are put on the grid
//! too, and the part is made valid again.
//!
//! Parts beyond the world, or within the buffer of its edge, also appear on the other side.

use super::Tile;
use super::level::{Level, Part};
use super::options::{Options, cells, check};
use super::piece::{TileBody, TilePiece};
use super::ready::{Ready, TileFeature, runs};
use super::walk::{count as count_tiles, walk};
use crate::clip::simplify::coverage::{Coverage, Options as Simplify};
use crate::trace::NoTrace;
use crate::{Error, Result, parallel};
use std::ops::RangeInclusive;

/// Features prepared for all levels.
#[derive(Debug)]
pub struct Pyramid {
    features: Vec<Ready>,
    options: Options,
}

impl Pyramid {
    /// Prepares features: finds the points that each level has. Those without a point are in no tile.
    ///
    /// # Errors
    /// [`Error::NonFinite`] and [`Error::Parameter`] for places beyond [`WORLDS`](super::WORLDS) and for options
    /// outside of their domains; [`Error::Limit`] for 2³² points of one layer and more.
    pub fn new(features: Vec<TileFeature>, options: Options) -> Result<Self> {
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
        let ready = |(feature, levels): (TileFeature, Vec<u8>)| {
            let ready = Ready::new(feature, levels, polygons_before)?;
            polygons_before += ready.areas.len();
            Ok(ready)
        };
        let features = features.into_iter().zip(levels).map(ready).collect::<Result<_>>()?;
        Ok(Self { features, options })
    }

    /// Returns the levels.
    pub fn zooms(&self) -> RangeInclusive<u8> {
        self.options.zooms.clone()
    }

    /// Leaves out levels from the highest down until there are at most `limit` tiles, as [`Pyramid::count`] counts
    /// them; the first level stays. The result is that of a pyramid made with these levels.
    ///
    /// # Errors
    /// The errors of the overlay.
    pub fn reduce(&mut self, limit: u64) -> Result<()> {
        let (first, mut last) = (*self.options.zooms.start(), *self.options.zooms.end());
        while last > first && self.count(limit)? > limit {
            last -= 1;
            self.options.zooms = first..=last;
        }
        for level in self.features.iter_mut().flat_map(|feature| &mut feature.levels) {
            *level = (*level).min(last);
        }
        Ok(())
    }

    fn level(&self, zoom: u8) -> Level<'_> {
        Level::new(&self.features, &self.options, zoom)
    }

    /// Visits the non-empty tiles of a level in the order of their numbers; the pieces are in the order of the
    /// features. See [`walk()`](super::walk()).
    ///
    /// # Errors
    /// Those of the overlay, and of `take`.
    pub fn visit<R: Send, E: From<Error>>(
        &self,
        zoom: u8,
        make: impl Fn(Tile, Vec<TilePiece>) -> R + Sync + Send,
        mut take: impl FnMut(Tile, R) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let level = self.level(zoom.min(Tile::MAX_ZOOM));
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
    /// The errors of the overlay.
    pub fn count(&self, limit: u64) -> Result<u64> {
        let zooms = || self.options.zooms.clone();
        let levels = zooms().map(|zoom| self.level(zoom).count_of_boxes());
        let boxes = levels.fold(0u64, u64::saturating_add);
        if boxes <= limit {
            return Ok(boxes);
        }
        let mut count = 0u64;
        // The last level has the most of them.
        for zoom in zooms().rev() {
            let level = self.level(zoom);
            let left = limit.saturating_sub(count);
            count = count.saturating_add(count_tiles(&level.contents(), zoom, left)?);
            if count > limit {
                break;
            }
        }
        Ok(count)
    }
}

/// Returns the first level that has each point, of the lines and areas of a layer.
fn layer_levels(
    features: &[TileFeature],
    layer: usize,
    options: &Options,
) -> Result<Vec<(usize, Vec<u8>)>> {
    let mut coverage = Coverage::default();
    let own = || features.iter().enumerate().filter(|(_, f)| f.layer == layer);
    for (_, feature) in own() {
        match &feature.body {
            TileBody::Points(_) => {}
            TileBody::Lines { points, ends } => runs(ends).for_each(|run| {
                coverage.push_line(points.get(run).unwrap_or_default().iter().copied());
            }),
            TileBody::Areas(shapes) => {
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
        .filter(|(_, f)| !matches!(f.body, TileBody::Points(_)))
        .map(|(i, f)| (i, weights.by_ref().take(f.body.points().len()).map(level).collect()));
    Ok(levels.collect())
}
