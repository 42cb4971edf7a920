//! Tiles of web maps as masks: geometries are cut as they are, and keep their coordinates, heights and measures.

use super::mercator::{self, HALF_WORLD};
use super::ready::WORLDS;
use super::walk::{Content, count, walk};
use super::{Coordinates, Tile};
use crate::Result;
use crate::clip::mask::{Cutter, Mask, Rules};
use crate::clip::polygon::BooleanOp;
use crate::geometry::Geometry;
use crate::math::{DVec2, Rect};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Returns the bounds of a tile. Borders of neighbours are the same numbers.
fn bounds(tile: Tile, coordinates: Coordinates) -> Result<Rect> {
    let side = f64::from(1u32 << tile.zoom);
    let x = |x: u32| {
        let part = f64::from(x) / side * 2.0 - 1.0;
        part * half_world(coordinates)
    };
    let y = |y: u32| {
        let part = 1.0 - f64::from(y) / side * 2.0;
        match coordinates {
            Coordinates::LonLat => mercator::latitude(part),
            Coordinates::Mercator => part * HALF_WORLD,
        }
    };
    Rect::new(DVec2::new(x(tile.x), y(tile.y + 1)), DVec2::new(x(tile.x + 1), y(tile.y)))
}

/// Returns the distance from the middle of the world to its eastern border.
fn half_world(coordinates: Coordinates) -> f64 {
    match coordinates {
        Coordinates::LonLat => 180.0,
        Coordinates::Mercator => HALF_WORLD,
    }
}

/// Tiles of one level that geometries are cut to.
///
/// ```
/// use durer::clip::mask::Rules;
/// use durer::clip::tiles::{Coordinates, Subject, Tile, Tiling};
/// use durer::geometry::{Geometry, Points};
/// use durer::math::DVec2;
///
/// let road = Points::flat(vec![DVec2::new(-10.0, 50.0), DVec2::new(10.0, 50.0)]);
/// let road = Geometry::LineString(road);
/// let tiling = Tiling::new(1, Coordinates::LonLat);
/// let subjects = [Subject::new(&tiling, 0, &road, Rules::default())];
/// let mut tiles = Vec::new();
/// tiling.visit(&subjects, |_, parts| parts.len(), |tile, count| {
///     tiles.push((tile, count));
///     Ok::<(), durer::Error>(())
/// })?;
/// assert_eq!(tiles, [(Tile { zoom: 1, x: 0, y: 0 }, 1), (Tile { zoom: 1, x: 1, y: 0 }, 1)]);
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug)]
pub struct Tiling {
    zoom: u8,
    coordinates: Coordinates,
    /// The index of the first geometry that could not be cut; `usize::MAX` if all could.
    failed: AtomicUsize,
}

/// A geometry to be cut.
#[derive(Debug)]
pub struct Subject<'a> {
    tiling: &'a Tiling,
    index: usize,
    geometry: &'a Geometry,
    rules: Rules,
    /// True if it had to be made valid.
    repaired: AtomicBool,
}

/// Position of a geometry relative to the world.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// All of it is in the range of tiles, or in a neighbouring world.
    Within,
    /// Some or all of it is nearer to a pole than the tiles reach.
    BeyondLatitudes,
    /// More than four worlds away.
    TooFar,
}

impl Tiling {
    /// Creates the tiles of a level, at most [`Tile::MAX_ZOOM`].
    pub fn new(zoom: u8, coordinates: Coordinates) -> Self {
        let zoom = zoom.min(Tile::MAX_ZOOM);
        Self { zoom, coordinates, failed: AtomicUsize::new(usize::MAX) }
    }

    /// Returns the index of the first geometry that could not be cut, after [`Tiling::visit`] or [`Tiling::count`] gave
    /// an error.
    pub fn failed(&self) -> Option<usize> {
        Some(self.failed.load(Ordering::Relaxed)).filter(|index| *index != usize::MAX)
    }

    /// Returns the position of a geometry relative to the world.
    pub fn reach(&self, geometry: &Geometry) -> Reach {
        let world = bounds(Tile::WORLD, self.coordinates);
        let (Some(own), Ok(world)) = (geometry.bounds(), world) else { return Reach::Within };
        let last = half_world(self.coordinates) * (1.0 + 2.0 * WORLDS);
        if own.min().x < -last || own.max().x > last {
            Reach::TooFar
        } else if own.min().y < world.min().y || own.max().y > world.max().y {
            Reach::BeyondLatitudes
        } else {
            Reach::Within
        }
    }

    /// Returns a lower bound of the number of tiles, counted up to a limit.
    ///
    /// # Errors
    /// The errors of the cuts.
    pub fn count(&self, subjects: &[Subject<'_>], limit: u64) -> Result<u64> {
        let boxes = subjects.iter().map(Subject::count_of_box).fold(0, u64::saturating_add);
        let boxes = boxes.min(Tile::WORLD.count_at(self.zoom));
        if boxes <= limit {
            return Ok(boxes);
        }
        count(&contents(subjects), self.zoom, limit)
    }

    /// Visits the non-empty tiles in the order of their numbers, each with the parts of the geometries and their
    /// indices. Geometry beyond 180 degrees is moved to the other side. See [`walk()`](super::walk()).
    ///
    /// # Errors
    /// The errors of the cuts, and those of `take`.
    pub fn visit<R: Send, E: From<crate::Error>>(
        &self,
        subjects: &[Subject<'_>],
        make: impl Fn(Tile, Vec<(usize, Geometry)>) -> R + Sync + Send,
        take: impl FnMut(Tile, R) -> std::result::Result<(), E>,
    ) -> std::result::Result<(), E> {
        let make = |tile: Tile, parts: Vec<Part<'_>>| {
            let pieces = parts.into_iter().map(|part| (part.subject.index, part.geometry));
            make(tile, pieces.collect())
        };
        walk(&contents(subjects), self.zoom, make, take)
    }
}

impl<'a> Subject<'a> {
    /// Prepares a geometry, which `index` identifies.
    pub fn new(tiling: &'a Tiling, index: usize, geometry: &'a Geometry, rules: Rules) -> Self {
        Self { tiling, index, geometry, rules, repaired: AtomicBool::new(false) }
    }

    /// Returns the number that identifies the geometry.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Returns whether the geometry had to be made valid.
    pub fn is_repaired(&self) -> bool {
        self.repaired.load(Ordering::Relaxed)
    }

    /// Returns an upper bound of the number of tiles.
    fn count_of_box(&self) -> u64 {
        let Some(own) = self.geometry.bounds() else { return 0 };
        let square = |p: DVec2| match self.tiling.coordinates {
            Coordinates::LonLat => mercator::project(p),
            Coordinates::Mercator => mercator::of_metres(p),
        };
        let side = f64::from(1u32 << self.tiling.zoom);
        let (a, b) = (square(own.min()), square(own.max()));
        // Closed tiles meet at their borders.
        let tiles = |low: f64, high: f64| {
            ((high * side).floor() - (low * side).floor() + 2.0).min(2.0 * WORLDS * side)
        };
        let down = tiles(b.y.clamp(0.0, 1.0), a.y.clamp(0.0, 1.0));
        (tiles(a.x, b.x) * down) as u64
    }
}

/// A part of a geometry, in the first world.
struct Part<'a> {
    subject: &'a Subject<'a>,
    geometry: Geometry,
}

/// Returns all geometries in all worlds, moved to the first.
fn contents<'a>(subjects: &'a [Subject<'a>]) -> Vec<Part<'a>> {
    let mut contents = Vec::new();
    for subject in subjects {
        let Some(own) = subject.geometry.bounds() else { continue };
        let half = half_world(subject.tiling.coordinates);
        // Geometry that only touches the border of another world is in this one.
        let first = (((own.min().x - half) / (2.0 * half)).floor() as i64 + 1).min(0);
        let last = (((own.max().x + half) / (2.0 * half)).ceil() as i64 - 1).max(0);
        for world in first..=last {
            let mut geometry = subject.geometry.clone();
            if world != 0 {
                shift(&mut geometry, -2.0 * half * world as f64);
            }
            contents.push(Part { subject, geometry });
        }
    }
    contents
}

/// Moves a geometry to the east.
fn shift(geometry: &mut Geometry, by: f64) {
    match geometry {
        Geometry::Point(run) | Geometry::LineString(run) | Geometry::MultiPoint(run) => {
            run.xy.iter_mut().for_each(|p| p.x += by);
        }
        Geometry::Polygon(runs) | Geometry::MultiLineString(runs) => {
            runs.iter_mut().flat_map(|run| &mut run.xy).for_each(|p| p.x += by);
        }
        Geometry::MultiPolygon(polygons) => {
            polygons.iter_mut().flatten().flat_map(|run| &mut run.xy).for_each(|p| p.x += by);
        }
        Geometry::Collection(parts) => parts.iter_mut().for_each(|part| shift(part, by)),
    }
}

impl Content for Part<'_> {
    fn within(&self, tiles: &[Tile]) -> Result<Vec<Option<Self>>> {
        let Subject { tiling, rules, index, repaired, .. } = self.subject;
        let cut = |&tile: &Tile| {
            let mask = &Mask::window(bounds(tile, tiling.coordinates)?)?;
            let cutter =
                Cutter { mask, op: BooleanOp::Intersection, rules: rules.clone(), algorithm: None };
            let cut = cutter.cut(&self.geometry)?;
            repaired.fetch_or(cut.repaired, Ordering::Relaxed);
            Ok(cut.geometry.map(|geometry| Part { subject: self.subject, geometry }))
        };
        let parts = tiles.iter().map(cut).collect::<Result<_>>();
        parts.inspect_err(|_| {
            tiling.failed.fetch_min(*index, Ordering::Relaxed);
        })
    }

    fn size(&self) -> usize {
        self.geometry.len()
    }

    fn covers(&self, tile: Tile) -> bool {
        let (Geometry::Polygon(rings), Ok(window)) =
            (&self.geometry, bounds(tile, self.subject.tiling.coordinates))
        else {
            return false;
        };
        let corner = |p: &DVec2| (p.cmpeq(window.min()) | p.cmpeq(window.max())).all();
        matches!(&rings[..], [ring] if ring.len() == 4 && ring.xy.iter().all(corner))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_the_world() {
        let world = bounds(Tile::WORLD, Coordinates::LonLat).expect("bounds");
        assert_eq!((world.min().x, world.max().x), (-180.0, 180.0));
        // The latitude where Web Mercator ends.
        assert!((world.max().y - 85.051_128_779_806_59).abs() < 1e-12);
        let child = |y| bounds(Tile { zoom: 1, x: 0, y }, Coordinates::Mercator);
        let (a, b) = (child(0).expect("bounds"), child(1).expect("bounds"));
        assert_eq!((a.min().y, a.max().y), (0.0, HALF_WORLD));
        assert_eq!(a.min().y, b.max().y);
    }

    #[test]
    fn what_lies_beyond_the_world_comes_from_the_other_side() {
        let line = |a: f64, b: f64| {
            let xy = vec![DVec2::new(a, 1.0), DVec2::new(b, 1.0)];
            Geometry::LineString(crate::geometry::Points::flat(xy))
        };
        let tiling = Tiling::new(0, Coordinates::LonLat);
        let starts = |a, b| {
            let line = line(a, b);
            let subject = [Subject::new(&tiling, 0, &line, Rules::default())];
            let parts = contents(&subject);
            let boxes = parts.iter().filter_map(|p| p.geometry.bounds());
            boxes.map(|r| r.min().x).collect::<Vec<_>>()
        };
        assert_eq!(starts(-180.0, 180.0), [-180.0]);
        assert_eq!(starts(170.0, 190.0), [170.0, -190.0]);
        assert_eq!(starts(200.0, 210.0), [200.0, -160.0]);
        assert_eq!(starts(-541.0, -539.0), [179.0, -181.0, -541.0]);
        assert_eq!(tiling.reach(&line(0.0, 1e9)), Reach::TooFar);
    }
}
