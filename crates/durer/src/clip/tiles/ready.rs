//! Features prepared for all levels of a pyramid.

use super::piece::TileBody;
use crate::clip::polygon::{Polygon, WindingRule, signed_area};
use crate::math::{DVec2, Rect};
use crate::{Error, Result};

/// A feature in the square of [`super::mercator`].
#[derive(Debug, Clone, PartialEq)]
pub struct TileFeature {
    /// Features of one layer are simplified together.
    pub layer: usize,
    /// Its geometry, within [`WORLDS`].
    pub body: TileBody,
    /// Fill rule of its areas.
    pub fill: WindingRule,
}

/// Distance from the square that features may reach, in its sides.
pub const WORLDS: f64 = 4.0;

/// A feature with the data common to all levels.
#[derive(Debug)]
pub(super) struct Ready {
    pub layer: usize,
    pub body: TileBody,
    pub fill: WindingRule,
    pub bounds: Rect,
    /// The first level that has each point; empty for points.
    pub levels: Vec<u8>,
    /// The area of each polygon.
    pub areas: Vec<f64>,
    /// Number of polygons in the features before.
    pub polygons_before: usize,
}

impl Ready {
    /// Checks a feature, and finds its bounds and areas.
    pub fn new(feature: TileFeature, levels: Vec<u8>, polygons_before: usize) -> Result<Self> {
        let TileFeature { layer, body, fill } = feature;
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
            TileBody::Areas(shapes) => shapes.polygons().map(area).collect(),
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

/// Returns the ranges between ends.
pub(super) fn runs(ends: &[usize]) -> impl Iterator<Item = std::ops::Range<usize>> {
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(ends.iter().copied()).map(|(start, end)| start..end)
}
