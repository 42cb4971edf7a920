//! The zoom level whose grid shows the detail of features.
//!
//! The distances are compared with the grid as tippecanoe's `-zg` does (E. Fischer, Mapbox, 2016): the geometric mean
//! of the distances between vertices becomes eight cells, and features that are near each other are two cells apart.
//! Near are features at a distance of 1.5 standard deviations below the mean of the distances' logarithms, between
//! neighbours along Hilbert's curve. In addition, all features but the smallest 1 % are at least four cells long.

use super::piece::TileBody;
use super::ready::{TileFeature, runs};
use super::{Tile, hilbert};
use crate::math::{DVec2, Rect};
use crate::sorting::CompactSort;

/// Number of cells between vertices, on average.
const BETWEEN_VERTICES: f64 = 8.0;

/// Number of cells between near features.
const BETWEEN_FEATURES: f64 = 2.0;

/// Distance of near features below the mean, in standard deviations.
const NEAR: f64 = 1.5;

/// Number of cells of a small feature's longer side.
const SMALL: f64 = 4.0;

/// Share of features that may be smaller.
const SMALLER: f64 = 0.01;

/// Bits of a place on Hilbert's curve, per axis.
const BITS: u8 = 31;

/// The property of features that requires the finest grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reason {
    /// The distances between the vertices of lines and borders.
    Vertices,
    /// The distances between features.
    Distances,
    /// The sizes of lines and areas.
    Sizes,
}

/// Level at which the detail of features is visible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DetailLevel {
    /// The level, at most [`Tile::MAX_ZOOM`].
    pub zoom: u8,
    /// The property that requires it.
    pub reason: Reason,
}

impl DetailLevel {
    /// Returns the coarsest level whose grid, of `extent` cells per side of a tile, shows the detail of most features;
    /// `None` if there are not two different points.
    ///
    /// The time is O(n log n) for n features, and linear in the number of points.
    ///
    /// ```
    /// use durer::clip::polygon::WindingRule;
    /// use durer::clip::tiles::{TileBody, DetailLevel, TileFeature, Reason};
    /// use durer::math::DVec2;
    ///
    /// // Points that are 1/65536 of the world apart.
    /// let point = |i: u32| TileBody::Points(vec![DVec2::new(f64::from(i) / 65536.0, 0.25)]);
    /// let features: Vec<TileFeature> =
    ///     (0..100).map(|i| TileFeature { layer: 0, body: point(i), fill: WindingRule::EvenOdd }).collect();
    /// let detail = DetailLevel::of(&features, 4096).unwrap();
    /// assert_eq!((detail.zoom, detail.reason), (5, Reason::Distances));
    /// ```
    pub fn of(features: &[TileFeature], extent: u32) -> Option<Self> {
        let bounds: Vec<(bool, Rect)> = features
            .iter()
            .filter_map(|f| {
                let around = Rect::around(f.body.points().iter().copied())?;
                Some((matches!(f.body, TileBody::Points(_)), around))
            })
            .collect();
        let wanted = [
            (Reason::Vertices, between_vertices(features).map(|d| d / BETWEEN_VERTICES)),
            (Reason::Distances, between_features(&bounds).map(|d| d / BETWEEN_FEATURES)),
            (Reason::Sizes, small(&bounds).map(|d| d / SMALL)),
        ];
        let levels = wanted.into_iter().filter_map(|(reason, cell)| {
            let zoom = libm::ceil(-libm::log2(cell? * f64::from(extent)));
            Some(Self { zoom: zoom.clamp(0.0, f64::from(Tile::MAX_ZOOM)) as u8, reason })
        });
        // Of equal levels, the first reason counts.
        levels.reduce(|best, other| if other.zoom > best.zoom { other } else { best })
    }
}

/// Mean and variance of the logarithms of distances.
#[derive(Debug, Default)]
struct Logarithms {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Logarithms {
    fn add(&mut self, distance: f64) {
        if distance > 0.0 && distance.is_finite() {
            let log = libm::log2(distance);
            self.count += 1.0;
            self.sum += log;
            self.squares += log * log;
        }
    }

    /// Returns the distance at a number of standard deviations below the mean.
    fn below(&self, deviations: f64) -> Option<f64> {
        if self.count == 0.0 {
            return None;
        }
        let mean = self.sum / self.count;
        let variance = (self.squares / self.count - mean * mean).max(0.0);
        Some(libm::exp2(mean - deviations * variance.sqrt()))
    }
}

/// Returns the geometric mean of the distances between neighbouring vertices.
fn between_vertices(features: &[TileFeature]) -> Option<f64> {
    let mut distances = Logarithms::default();
    let mut add = |run: &[DVec2]| {
        run.windows(2).for_each(|pair| distances.add(pair[0].distance(pair[1])));
    };
    for feature in features {
        match &feature.body {
            TileBody::Points(_) => {}
            TileBody::Lines { points, ends } => {
                runs(ends).for_each(|run| add(points.get(run).unwrap_or_default()));
            }
            TileBody::Areas(shapes) => shapes.rings().for_each(&mut add),
        }
    }
    distances.below(0.0)
}

/// Returns the distance of features that are near each other.
fn between_features(bounds: &[(bool, Rect)]) -> Option<f64> {
    let side = f64::from(1u32 << BITS);
    let mut places: Vec<(u64, DVec2)> = bounds
        .iter()
        .map(|(_, around)| {
            let middle = 0.5 * (around.min() + around.max());
            let [x, y] = [middle.x.rem_euclid(1.0), middle.y.clamp(0.0, 1.0)];
            let cell = |v: f64| (v * side).min(side - 1.0) as u32;
            (hilbert::index(BITS, cell(x), cell(y)), DVec2::new(x, y))
        })
        .collect();
    // The sort is stable, so equal places keep their order.
    places.compact_sort_by_key(|place| place.0);
    let mut distances = Logarithms::default();
    places.windows(2).for_each(|pair| distances.add(pair[0].1.distance(pair[1].1)));
    distances.below(NEAR)
}

/// Returns the longer side of a small feature.
fn small(bounds: &[(bool, Rect)]) -> Option<f64> {
    let sides = bounds.iter().filter(|(is_point, _)| !is_point);
    let mut sides: Vec<f64> = sides.map(|(_, around)| around.size().max_element()).collect();
    sides.retain(|side| *side > 0.0);
    sides.sort_by(f64::total_cmp);
    sides.get((sides.len() as f64 * SMALLER) as usize).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::polygon::{Shapes, WindingRule};

    fn feature(body: TileBody) -> TileFeature {
        TileFeature { layer: 0, body, fill: WindingRule::EvenOdd }
    }

    fn square(x: f64, side: f64) -> TileFeature {
        let mut shapes = Shapes::new();
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        shapes.push_ring(corners.map(|c| DVec2::new(x, 0.4) + DVec2::from(c) * side));
        shapes.end_polygon();
        feature(TileBody::Areas(shapes))
    }

    #[test]
    fn vertices_are_eight_cells_apart() {
        let step = 8.0 / 4096.0 / 64.0;
        let points: Vec<DVec2> = (0..50).map(|i| DVec2::new(f64::from(i) * step, 0.3)).collect();
        let line = |points: Vec<DVec2>| {
            let ends = vec![points.len()];
            feature(TileBody::Lines { points, ends })
        };
        let of = |points: Vec<DVec2>| DetailLevel::of(&[line(points)], 4096);
        assert_eq!(of(points.clone()), Some(DetailLevel { zoom: 6, reason: Reason::Vertices }));
        // Repeated points say nothing, and half the grid needs a level more.
        let twice: Vec<DVec2> = points.iter().flat_map(|p| [*p; 2]).collect();
        assert_eq!(of(twice), of(points.clone()));
        let coarse = DetailLevel::of(&[line(points)], 2048);
        assert_eq!(coarse, Some(DetailLevel { zoom: 7, reason: Reason::Vertices }));
    }

    #[test]
    fn all_but_few_features_are_visible() {
        let small = 2f64.powi(-20);
        let mut squares: Vec<TileFeature> =
            (0..200).map(|i| square(f64::from(i) / 200.0, 2f64.powi(-12))).collect();
        squares[7] = square(0.8, small);
        let without = DetailLevel::of(&squares, 4096).unwrap();
        assert!(without.zoom < 8, "{without:?}");
        squares[100..110].iter_mut().for_each(|some| *some = square(0.1, small));
        let with = DetailLevel::of(&squares, 4096);
        assert_eq!(with, Some(DetailLevel { zoom: 10, reason: Reason::Sizes }));
    }

    #[test]
    fn one_place_has_no_detail() {
        let point = || feature(TileBody::Points(vec![DVec2::splat(0.5)]));
        assert_eq!(DetailLevel::of(&[], 4096), None);
        assert_eq!(DetailLevel::of(&[point(), point()], 4096), None);
    }
}
