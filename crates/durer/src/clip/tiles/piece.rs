//! Geometry in the tiles' plane, and on the tiles' grid.

use super::{Tile, apart, mercator};
use crate::Result;
use crate::clip::polygon::{
    BooleanOp, Shapes, WindingRule,
    overlay::{self, overlay},
    rectangle,
};
use crate::geometry::{Geometry, Points};
use crate::math::{DVec2, I64Vec2, Rect};
use crate::trace::NoTrace;

/// Points, lines or areas.
#[derive(Debug, Clone, PartialEq)]
pub enum TileBody {
    /// Points.
    Points(Vec<DVec2>),
    /// Lines in one flat buffer.
    Lines {
        /// All points, line after line.
        points: Vec<DVec2>,
        /// End of each line among the points.
        ends: Vec<usize>,
    },
    /// Polygons.
    Areas(Shapes),
}

/// Points, lines or areas on a grid of whole numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum GridShape {
    /// Points.
    Points(Vec<I64Vec2>),
    /// Lines of at least two points, without repeated points.
    Lines(Vec<Vec<I64Vec2>>),
    /// Valid polygons.
    Areas(Shapes<I64Vec2>),
}

/// A part of a feature in a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct TilePiece {
    /// The index of the feature.
    pub feature: usize,
    /// Shape on the grid of the tile: (0, 0) is its upper left corner, y counts downwards. Outer rings have positive
    /// signed areas in these coordinates, holes negative ones.
    pub shape: GridShape,
}

impl TileBody {
    /// Returns all points.
    pub fn points(&self) -> &[DVec2] {
        match self {
            Self::Points(points) | Self::Lines { points, .. } => points,
            Self::Areas(shapes) => shapes.points(),
        }
    }

    /// Returns the part in a closed window; parts of areas that have no area are left out. Areas must be valid.
    ///
    /// # Errors
    /// [`crate::Error::NonFinite`] names the first point with a NaN or infinite coordinate.
    pub(crate) fn clip(&self, window: &Rect) -> Result<Option<Self>> {
        let part = match self {
            Self::Points(points) => {
                Self::Points(points.iter().copied().filter(|p| window.contains(*p)).collect())
            }
            Self::Lines { points, ends } => {
                let cut = rectangle::clip_lines(window, points, ends, false)?;
                Self::Lines { points: cut.points, ends: cut.ends }
            }
            Self::Areas(shapes) => {
                Self::Areas(rectangle::clip(window, shapes, &rectangle::Options, &mut NoTrace)?)
            }
        };
        Ok((!part.points().is_empty()).then_some(part))
    }

    /// Returns the geometry on the grid, with `origin` as its zero: every place is rounded to the nearest whole
    /// numbers, halves up. Lines that become points are left out, and so are parts that lose their area. Areas are made
    /// valid.
    ///
    /// # Errors
    /// As [`overlay()`].
    pub fn snapped(&self, origin: I64Vec2, fill: WindingRule) -> Result<GridShape> {
        let snap = |p: DVec2| I64Vec2::new(nearest(p.x, origin.x), nearest(p.y, origin.y));
        Ok(match self {
            Self::Points(points) => GridShape::Points(points.iter().copied().map(snap).collect()),
            Self::Lines { points, ends } => {
                let mut start = 0;
                let line = |&end: &usize| {
                    let line = points.get(start..end).unwrap_or_default();
                    start = end;
                    let mut line: Vec<I64Vec2> = line.iter().copied().map(snap).collect();
                    line.dedup();
                    (line.len() > 1).then_some(line)
                };
                GridShape::Lines(ends.iter().filter_map(line).collect())
            }
            Self::Areas(shapes) => GridShape::Areas(valid(shapes, snap, fill)?),
        })
    }
}

impl GridShape {
    /// Returns whether there is nothing of it.
    pub(crate) fn is_empty(&self) -> bool {
        match self {
            Self::Points(points) => points.is_empty(),
            Self::Lines(lines) => lines.is_empty(),
            Self::Areas(shapes) => shapes.is_empty(),
        }
    }

    /// Returns a shape of a tile whose side has this many cells as a geometry in longitude and latitude; outer rings
    /// run counter-clockwise.
    pub fn in_degrees(&self, tile: Tile, extent: u32) -> Geometry {
        let side = 1.0 / f64::from(1u32 << tile.zoom);
        let corner = DVec2::new(tile.x.into(), tile.y.into());
        let degrees =
            |p: &I64Vec2| mercator::unproject((corner + p.as_dvec2() / f64::from(extent)) * side);
        let run = |points: &[I64Vec2]| Points::flat(points.iter().map(degrees).collect());
        let ring = |points: &[I64Vec2]| Points::flat(points.iter().rev().map(degrees).collect());
        match self {
            Self::Points(points) if points.len() == 1 => Geometry::Point(run(points)),
            Self::Points(points) => Geometry::MultiPoint(run(points)),
            Self::Lines(lines) if lines.len() == 1 => Geometry::LineString(run(&lines[0])),
            Self::Lines(lines) => {
                Geometry::MultiLineString(lines.iter().map(|line| run(line)).collect())
            }
            Self::Areas(shapes) => {
                let polygon = shapes.polygons().map(|p| p.rings().map(ring).collect());
                let mut polygons: Vec<Vec<Points>> = polygon.collect();
                match polygons.len() {
                    1 => Geometry::Polygon(polygons.remove(0)),
                    _ => Geometry::MultiPolygon(polygons),
                }
            }
        }
    }

    /// Returns the geometry with coordinates of f64.
    pub(crate) fn to_body(&self) -> TileBody {
        let float = |p: &I64Vec2| p.as_dvec2();
        match self {
            Self::Points(points) => TileBody::Points(points.iter().map(float).collect()),
            Self::Lines(lines) => {
                let (mut points, mut ends) = (Vec::new(), Vec::new());
                for line in lines {
                    points.extend(line.iter().map(float));
                    ends.push(points.len());
                }
                TileBody::Lines { points, ends }
            }
            Self::Areas(shapes) => {
                let mut areas = Shapes::new();
                for polygon in shapes.polygons() {
                    polygon.rings().for_each(|ring| areas.push_ring(ring.iter().map(float)));
                    areas.end_polygon();
                }
                TileBody::Areas(areas)
            }
        }
    }
}

/// Returns the nearest whole number, halves rounded up so that all tiles have the same grid, minus `origin`.
fn nearest(value: f64, origin: i64) -> i64 {
    ((value + 0.5).floor() as i64).saturating_sub(origin)
}

/// Returns the polygons on the grid, made valid: by the overlay where rings cross or touch.
fn valid(
    shapes: &Shapes,
    snap: impl Fn(DVec2) -> I64Vec2,
    fill: WindingRule,
) -> Result<Shapes<I64Vec2>> {
    let mut snapped: Shapes<I64Vec2> = Shapes::new();
    for ring in shapes.rings() {
        // On whole numbers no neighbour needs a point in the middle of a straight border.
        let ring = apart::cleaned(ring.iter().copied().map(&snap));
        if !ring.is_empty() {
            snapped.push_ring(ring);
        }
    }
    snapped.end_polygon();
    if let Some(polygons) = apart::polygons(&snapped, fill) {
        return Ok(polygons);
    }
    let none = Shapes::new();
    let options = overlay::Options { drop_collinear: true, ..overlay::Options::with_rule(fill) };
    Ok(overlay(&snapped, &none, BooleanOp::Union, &options, &mut NoTrace)?.shapes)
}
