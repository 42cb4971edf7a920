//! The features of a pyramid on one of its levels.

use super::Tile;
use super::options::{Options, cells};
use super::piece::{GridShape, TileBody, TilePiece};
use super::ready::{Ready, runs};
use super::walk::Content;
use crate::Result;
use crate::clip::polygon::{Shapes, WindingRule};
use crate::math::{DVec2, I64Vec2, Rect};
use std::collections::BTreeMap;

/// All features on one level.
pub struct Level<'a> {
    features: &'a [Ready],
    options: &'a Options,
    pub zoom: u8,
    /// The side of the world in cells.
    cells: f64,
    /// True for each tiny polygon that a square replaces.
    squares: Vec<bool>,
}

impl<'a> Level<'a> {
    /// Creates the features of a pyramid.
    pub fn new(features: &'a [Ready], options: &'a Options, zoom: u8) -> Self {
        let cells = cells(options, zoom);
        let level = Self { features, options, zoom, cells, squares: Vec::new() };
        Self { squares: level.squares(), ..level }
    }

    /// Returns the side of a square that polygons smaller than it are joined to, in cells. The last level has
    /// all that have an area there.
    fn tiny(&self) -> f64 {
        let Options { tiny, zooms, .. } = self.options;
        if self.zoom == *zooms.end() { tiny.min(1.0) } else { *tiny }
    }

    fn is_tiny(&self, area: f64) -> bool {
        let side = self.tiny() / self.cells;
        area < side * side
    }

    /// Returns the tiny polygons that are replaced by a square: those whose areas add up to one.
    fn squares(&self) -> Vec<bool> {
        /// Side of the squares in which tiny polygons are added up, as a multiple of their size limit.
        const NEAR: f64 = 8.0;
        let side = self.tiny() / self.cells;
        let (mut squares, mut sums) = (Vec::new(), BTreeMap::<(usize, i64, i64), f64>::new());
        for feature in self.features {
            let TileBody::Areas(shapes) = &feature.body else { continue };
            for (polygon, &area) in shapes.polygons().zip(&feature.areas) {
                let mut full = false;
                if self.is_tiny(area) {
                    let at = polygon.outer().first().copied().unwrap_or_default() / (side * NEAR);
                    let place = (feature.layer, at.x.floor() as i64, at.y.floor() as i64);
                    let sum = sums.entry(place).or_default();
                    *sum += area;
                    full = *sum >= side * side;
                    *sum -= if full { side * side } else { 0.0 };
                }
                squares.push(full);
            }
        }
        squares
    }

    /// Returns all features, in all worlds from which they are seen in the first.
    pub fn contents(&'a self) -> Vec<Part<'a>> {
        let reach = f64::from(self.options.buffer) / self.cells + self.margin();
        let mut contents = Vec::new();
        for (i, feature) in self.features.iter().enumerate() {
            if feature.body.points().is_empty() {
                continue;
            }
            let first = (-reach - feature.bounds.max().x).ceil() as i64;
            let last = (1.0 + reach - feature.bounds.min().x).floor() as i64;
            contents.extend((first..=last).rev().map(|shift| Part {
                level: self,
                feature: i,
                shift: shift as f64,
                cut: None,
            }));
        }
        contents
    }

    /// Returns the largest distance of a feature's points on the grid beyond its bounds.
    fn margin(&self) -> f64 {
        (self.tiny() + 1.0) / self.cells
    }

    /// Returns a tile, in cells.
    fn square(&self, tile: Tile) -> Option<Rect> {
        let side = self.cells / f64::from(1u32 << tile.zoom);
        let corner = DVec2::new(tile.x.into(), tile.y.into()) * side;
        Rect::around([corner, corner + side])
    }

    /// Returns the window that a tile's features are clipped to, in cells.
    fn window(&self, tile: Tile) -> Result<Rect> {
        let buffer = DVec2::splat(self.options.buffer.into());
        let square = self.square(tile).map_or([DVec2::ZERO; 2], |s| [s.min(), s.max()]);
        Rect::new(square[0] - buffer, square[1] + buffer)
    }

    /// Returns an upper bound of the number of tiles: those that the boxes around the features meet.
    pub fn count_of_boxes(&self) -> u64 {
        let side = self.cells / f64::from(1u32 << self.zoom);
        let last = f64::from((1u32 << self.zoom) - 1);
        let reach = f64::from(self.options.buffer);
        let mut count = 0u64;
        for part in self.contents() {
            let around = part.around();
            let first = ((around.min() - reach) / side).floor().max(DVec2::ZERO);
            let end = ((around.max() + reach) / side).floor().min(DVec2::splat(last));
            let tiles = (end - first + 1.0).max(DVec2::ZERO);
            count = count.saturating_add((tiles.x * tiles.y) as u64);
        }
        count.min(Tile::WORLD.count_at(self.zoom))
    }
}

/// A feature, or the part of it in a tile.
pub struct Part<'a> {
    level: &'a Level<'a>,
    feature: usize,
    /// Number of worlds by which it is moved to the east.
    shift: f64,
    /// The part in cells; `None` until something is cut off.
    cut: Option<TileBody>,
}

impl Part<'_> {
    fn ready(&self) -> &Ready {
        &self.level.features[self.feature]
    }

    /// Returns a box around the whole feature, in cells.
    fn around(&self) -> Rect {
        let Ready { bounds, .. } = self.ready();
        let (margin, shift) = (DVec2::splat(self.level.margin()), DVec2::new(self.shift, 0.0));
        let corners = [bounds.min() + shift - margin, bounds.max() + shift + margin];
        Rect::around(corners.map(|p| p * self.level.cells)).unwrap_or(*bounds)
    }

    /// Returns the whole feature on the grid, with `origin` as its zero.
    fn on_grid(&self, origin: I64Vec2) -> Result<GridShape> {
        let ready = self.ready();
        let place = |p: DVec2| DVec2::new(p.x + self.shift, p.y) * self.level.cells;
        let kept = |run: std::ops::Range<usize>| {
            let levels = ready.levels.get(run.clone()).unwrap_or_default();
            let points = ready.body.points().get(run).unwrap_or_default();
            let here = points.iter().zip(levels).filter(|(_, level)| **level <= self.level.zoom);
            here.map(|(&p, _)| place(p))
        };
        let body = match &ready.body {
            TileBody::Points(points) => {
                TileBody::Points(points.iter().copied().map(place).collect())
            }
            TileBody::Lines { ends, .. } => {
                let (mut points, mut new_ends) = (Vec::new(), Vec::new());
                for run in runs(ends) {
                    points.extend(kept(run));
                    new_ends.push(points.len());
                }
                TileBody::Lines { points, ends: new_ends }
            }
            TileBody::Areas(shapes) => {
                let mut areas = Shapes::new();
                for (i, polygon) in shapes.polygons().enumerate() {
                    if !self.level.is_tiny(ready.areas[i]) {
                        let rings = polygon.ring_indices();
                        rings.for_each(|ring| areas.push_ring(kept(shapes.ring_range(ring))));
                    } else if self.level.squares.get(ready.polygons_before + i) == Some(&true) {
                        let at = polygon.outer().first().copied().unwrap_or_default();
                        areas.push_ring(self.square(place(at)));
                    }
                    areas.end_polygon();
                }
                TileBody::Areas(areas)
            }
        };
        body.snapped(origin, ready.fill)
    }

    /// Returns the square that replaces tiny polygons.
    fn square(&self, around: DVec2) -> [DVec2; 4] {
        let half = (self.level.tiny() * 0.5).max(0.5);
        [(-half, -half), (half, -half), (half, half), (-half, half)]
            .map(|(x, y)| around + DVec2::new(x, y))
    }

    /// Returns the finished piece for its tile.
    pub fn finished(self, tile: Tile) -> Result<Option<TilePiece>> {
        let side = i64::from(self.level.options.extent);
        let origin = I64Vec2::new(tile.x.into(), tile.y.into()) * side;
        let shape = match &self.cut {
            Some(cut) => cut.snapped(origin, WindingRule::EvenOdd)?,
            None => self.on_grid(origin)?,
        };
        Ok((!shape.is_empty()).then_some(TilePiece { feature: self.feature, shape }))
    }
}

impl Content for Part<'_> {
    fn within(&self, tiles: &[Tile]) -> Result<Vec<Option<Self>>> {
        let part = |cut: Option<TileBody>| Self { cut, ..*self };
        if let Some(body) = &self.cut {
            let cut = |&tile: &Tile| {
                Ok(body.clip(&self.level.window(tile)?)?.map(|body| part(Some(body))))
            };
            return tiles.iter().map(cut).collect();
        }
        let around = self.around();
        let mut body: Option<TileBody> = None;
        let mut parts = Vec::with_capacity(tiles.len());
        for &tile in tiles {
            let window = self.level.window(tile)?;
            parts.push(if !window.overlaps(&around) {
                None
            } else if window.contains(around.min()) && window.contains(around.max()) {
                Some(part(None))
            } else {
                let whole = match body.take() {
                    Some(body) => body,
                    None => self.on_grid(I64Vec2::ZERO)?.to_body(),
                };
                let cut = whole.clip(&window)?;
                body = Some(whole);
                cut.map(|cut| part(Some(cut)))
            });
        }
        Ok(parts)
    }

    fn size(&self) -> usize {
        self.cut.as_ref().unwrap_or(&self.ready().body).points().len()
    }

    fn covers(&self, tile: Tile) -> bool {
        let Some(TileBody::Areas(shapes)) = &self.cut else { return false };
        let (Some(around), Some(square)) = (shapes.bounds(), self.level.square(tile)) else {
            return false;
        };
        let corner = |p: &DVec2| (p.cmpeq(around.min()) | p.cmpeq(around.max())).all();
        let is_rectangle = shapes.points().len() == 4 && shapes.points().iter().all(corner);
        is_rectangle && around.contains(square.min()) && around.contains(square.max())
    }
}
