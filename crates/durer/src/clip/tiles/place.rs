//! Geometries on the square of Web Mercator.

use super::ready::WORLDS;
use super::{Coordinates, TileBody, TileFeature, mercator};
use crate::clip::polygon::Shapes;
use crate::geometry::{Geometry, Points};
use crate::math::{DVec2, Rect};

/// A geometry by kinds, and its peculiarities.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlacedGeometry {
    /// Its areas, lines and points, as far as present; empty if it is far.
    pub bodies: Vec<TileBody>,
    /// True if it is beyond all worlds.
    pub far: bool,
    /// True if it has a latitude beyond ±90°.
    pub latitude: bool,
    /// True if it goes around a pole.
    pub pole: bool,
    /// True if it has an edge around more than half of the world.
    pub long: bool,
}

/// The meaning of coordinates, and the direction of long edges.
#[derive(Clone, Copy)]
struct Way {
    coordinates: Coordinates,
    short: bool,
}

/// Returns west, south, east and north of all features within the world, in degrees; `None` if there is no place.
pub fn extent(features: &[TileFeature]) -> Option<[f64; 4]> {
    let around = Rect::around(features.iter().flat_map(|f| f.body.points().iter().copied()))?;
    let (mut low, mut high) = (around.min(), around.max());
    if low.x < 0.0 || high.x > 1.0 {
        (low.x, high.x) = (0.0, 1.0);
    }
    let [first, last] = [low, high].map(|p| mercator::unproject(p.clamp(DVec2::ZERO, DVec2::ONE)));
    Some([first.x, last.y, last.x, first.y])
}

/// The parts of a geometry by kinds.
#[derive(Default)]
struct Parts {
    points: Vec<DVec2>,
    lines: Vec<DVec2>,
    ends: Vec<usize>,
    areas: Shapes,
}

/// Places a geometry on the map, for [`Pyramid::new`](super::Pyramid::new).
///
/// With `short_way`, lines and borders never extend more than half around the world: a longer edge goes the other way,
/// across the date line, and rings around a pole are closed along it.
///
/// ```
/// use durer::clip::tiles::{Coordinates, place};
/// use durer::geometry::{Geometry, Points};
/// use durer::math::DVec2;
///
/// let line = Points::flat(vec![DVec2::new(170.0, 0.0), DVec2::new(-170.0, 0.0)]);
/// let line = Geometry::LineString(line);
/// assert!(place(&line, Coordinates::LonLat, false).long);
/// let short = place(&line, Coordinates::LonLat, true);
/// assert!(!short.long && short.bodies[0].points()[1].x > 1.0);
/// ```
pub fn place(geometry: &Geometry, coordinates: Coordinates, short_way: bool) -> PlacedGeometry {
    let (mut parts, mut placed) = (Parts::default(), PlacedGeometry::default());
    let way = Way { coordinates, short: short_way };
    parts.add(geometry, way, &mut placed);
    let Parts { points, lines, ends, areas } = parts;
    let bodies =
        [TileBody::Areas(areas), TileBody::Lines { points: lines, ends }, TileBody::Points(points)];
    for body in bodies {
        let near = |p: &DVec2| p.x.abs().max(p.y.abs()) < WORLDS;
        placed.far |= !body.points().iter().all(near);
        if !body.points().is_empty() {
            placed.bodies.push(body);
        }
    }
    if placed.far {
        placed.bodies.clear();
    }
    placed
}

impl Parts {
    fn add(&mut self, geometry: &Geometry, way: Way, doubts: &mut PlacedGeometry) {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                self.points.extend(run(points, false, way, doubts));
            }
            Geometry::LineString(line) => self.add_line(line, way, doubts),
            Geometry::MultiLineString(lines) => {
                lines.iter().for_each(|line| self.add_line(line, way, doubts));
            }
            Geometry::Polygon(rings) => self.add_polygon(rings, way, doubts),
            Geometry::MultiPolygon(polygons) => {
                polygons.iter().for_each(|rings| self.add_polygon(rings, way, doubts));
            }
            Geometry::Collection(parts) => {
                parts.iter().for_each(|part| self.add(part, way, doubts));
            }
        }
    }

    fn add_line(&mut self, line: &Points, way: Way, doubts: &mut PlacedGeometry) {
        self.lines.extend(run(line, way.short, way, doubts));
        self.ends.push(self.lines.len());
    }

    fn add_polygon(&mut self, rings: &[Points], way: Way, doubts: &mut PlacedGeometry) {
        let mut first: Option<f64> = None;
        for ring in rings {
            let mut places = run(ring, way.short, way, doubts);
            if let ([first, .., last], false) = (&places[..], way.short) {
                doubts.long |= is_long(*last, *first);
            }
            if way.short {
                if goes_around(&places) {
                    doubts.pole = true;
                    close_along_pole(&mut places);
                }
                // Holes are where their polygon is.
                let start = places.first().map_or(0.0, |p| p.x);
                let shift = (first.unwrap_or(start) - start).round();
                places.iter_mut().for_each(|p| p.x += shift);
                first = first.or(Some(start));
            }
            self.areas.push_ring(places);
        }
        self.areas.end_polygon();
    }
}

/// Returns whether a ring ends in another world than it begins.
fn goes_around(ring: &[DVec2]) -> bool {
    matches!((ring.first(), ring.last()), (Some(a), Some(b)) if (a.x - b.x).abs() > 0.5)
}

/// Leads a ring that goes around a pole back along it, far beyond the last latitude of the map.
fn close_along_pole(ring: &mut Vec<DVec2>) {
    /// Beyond 0 … 1.
    const POLES: [f64; 2] = [-0.5, 1.5];
    let (Some(&first), Some(&last)) = (ring.first(), ring.last()) else { return };
    let middle = ring.iter().map(|p| p.y).sum::<f64>() / ring.len() as f64;
    let pole = POLES[usize::from(middle > 0.5)];
    let end = first.x + (last.x - first.x).round();
    ring.extend([(end, first.y), (end, pole), (first.x, pole)].map(DVec2::from));
}

/// Returns whether an edge goes around more than half of the world, except along a pole, where no map shows its
/// direction.
fn is_long(from: DVec2, to: DVec2) -> bool {
    let is_on_map = |p: DVec2| (0.0..=1.0).contains(&p.y);
    (to.x - from.x).abs() > 0.5 && (is_on_map(from) || is_on_map(to))
}

/// Returns the places of positions; where it matters, each in the world nearest to the one before.
fn run(points: &Points, short_way: bool, way: Way, doubts: &mut PlacedGeometry) -> Vec<DVec2> {
    let degrees = way.coordinates == Coordinates::LonLat;
    let mut before: Option<DVec2> = None;
    let place = |&p: &DVec2| {
        doubts.latitude |= degrees && p.y.abs() > 90.0;
        let mut place = if degrees { mercator::project(p) } else { mercator::of_metres(p) };
        if let Some(before) = before {
            let across = place.x - before.x;
            if short_way {
                place.x -= across.round();
            } else {
                doubts.long |= is_long(before, place);
            }
        }
        before = Some(place);
        place
    };
    points.xy.iter().map(place).collect()
}
