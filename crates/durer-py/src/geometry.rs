//! Geometries from ragged arrays, and back.
//!
//! The layout is GeoArrow's: coordinates, then offsets from the innermost level to the outermost.

use durer::clip::polygon::{Shapes, signed_area};
use durer::geometry::{Dimensions, Geometry, Points};
use durer::math::{DVec2, Rect};
use rayon::prelude::*;

/// Kinds of geometries with a layout, with their numbers in shapely.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Point = 0,
    LineString = 1,
    Polygon = 3,
    MultiPoint = 4,
    MultiLineString = 5,
    MultiPolygon = 6,
}

impl Kind {
    /// Returns the kind of a number.
    pub fn of_number(number: u8) -> Result<Self, String> {
        Ok(match number {
            0 => Self::Point,
            1 => Self::LineString,
            3 => Self::Polygon,
            4 => Self::MultiPoint,
            5 => Self::MultiLineString,
            6 => Self::MultiPolygon,
            _ => {
                return Err(format!(
                    "geometries of type {number} have no ragged arrays; there are types 0, 1, 3, 4, 5 and 6"
                ));
            }
        })
    }

    /// Returns the number of offset arrays.
    fn levels(self) -> usize {
        match self {
            Self::Point => 0,
            Self::LineString | Self::MultiPoint => 1,
            Self::Polygon | Self::MultiLineString => 2,
            Self::MultiPolygon => 3,
        }
    }
}

/// Geometries of one kind as arrays.
#[derive(Debug, Clone)]
pub struct Ragged<'a> {
    /// Kind of all of them.
    pub kind: Kind,
    /// Two or three numbers for each position.
    pub coords: &'a [f64],
    /// 2 or 3.
    pub width: usize,
    /// Offsets, from the innermost level to the outermost.
    pub offsets: Vec<&'a [i64]>,
}

impl Ragged<'_> {
    /// Returns the number of geometries.
    pub fn len(&self) -> usize {
        self.offsets
            .last()
            .map_or(self.coords.len() / self.width, |outer| outer.len().saturating_sub(1))
    }

    /// Checks that offsets are within their targets and never decrease.
    pub fn check(&self) -> Result<(), String> {
        let levels = self.kind.levels();
        if self.offsets.len() != levels {
            let found = self.offsets.len();
            return Err(format!("{:?} has {levels} arrays of offsets, got {found}", self.kind));
        }
        let mut below = self.coords.len() / self.width;
        for (level, offsets) in self.offsets.iter().enumerate() {
            let wrong = |at: usize, what: &str| {
                Err(format!("offsets[{level}][{at}] = {} {what}", offsets[at]))
            };
            let Some((&first, &last)) = offsets.first().zip(offsets.last()) else {
                return Err(format!("offsets[{level}] is empty; it begins with 0"));
            };
            if first < 0 {
                return wrong(0, "is below 0");
            }
            if let Some(at) = offsets.windows(2).position(|pair| pair[1] < pair[0]) {
                return wrong(at + 1, "is less than the one before");
            }
            if last as u64 > below as u64 {
                return wrong(
                    offsets.len() - 1,
                    &format!("is above {below}, the number of what it counts"),
                );
            }
            below = offsets.len() - 1;
        }
        Ok(())
    }

    /// Returns the box around a geometry; `None` if it is empty or not all of its coordinates are finite.
    pub fn bounds(&self, at: usize) -> Option<Rect> {
        let mut range = at..at + 1;
        for offsets in self.offsets.iter().rev() {
            range = offsets[range.start] as usize..offsets[range.end] as usize;
        }
        let mut positions = range.map(|at| self.position(at));
        let first = positions.next()?;
        let mut zero = first * 0.0;
        let (low, high) = positions.fold((first, first), |(low, high), p| {
            zero += p * 0.0;
            (low.min(p), high.max(p))
        });
        Rect::new(low, high).ok().filter(|_| zero == DVec2::ZERO)
    }

    /// Puts a polygon of x and y into shapes, as they are given; false for all other geometries.
    pub fn fill(&self, at: usize, shapes: &mut Shapes) -> bool {
        shapes.clear();
        let is_polygon = self.kind == Kind::Polygon && self.width == 2;
        if is_polygon {
            for ring in self.span(1, at) {
                shapes.push_ring(self.open(ring).map(|at| self.position(at)));
            }
            shapes.end_polygon();
        }
        is_polygon
    }

    fn position(&self, at: usize) -> DVec2 {
        DVec2::from_slice(&self.coords[at * self.width..])
    }

    /// Returns the positions of a ring without the last one if that repeats the first.
    fn open(&self, ring: usize) -> std::ops::Range<usize> {
        let all = self.span(0, ring);
        let closed = all.len() > 1 && self.position(all.start) == self.position(all.end - 1);
        all.start..all.end - usize::from(closed)
    }

    fn span(&self, level: usize, at: usize) -> std::ops::Range<usize> {
        let offsets = self.offsets[level];
        offsets[at] as usize..offsets[at + 1] as usize
    }

    fn points(&self, range: std::ops::Range<usize>) -> Points {
        let dimensions = if self.width == 3 { Dimensions::Xyz } else { Dimensions::Xy };
        let mut points = Points::new(dimensions);
        points.xy.reserve(range.len());
        for at in range {
            let p = &self.coords[at * self.width..][..self.width];
            points.push(DVec2::new(p[0], p[1]), [p.get(2).copied().unwrap_or(0.0), 0.0]);
        }
        points
    }

    fn rings(&self, level: usize, at: usize) -> Vec<Points> {
        let ring = |ring: usize| self.points(self.open(ring));
        self.span(level, at).map(ring).filter(|ring| ring.len() > 2).collect()
    }

    /// Returns a geometry; the arrays have been checked. A point of NaN is empty.
    pub fn geometry(&self, at: usize) -> Geometry {
        match self.kind {
            Kind::Point => {
                let points = self.points(at..at + 1);
                let empty = points.xy.iter().all(|p| p.x.is_nan() && p.y.is_nan());
                Geometry::Point(if empty { Points::default() } else { points })
            }
            Kind::LineString => Geometry::LineString(self.points(self.span(0, at))),
            Kind::MultiPoint => Geometry::MultiPoint(self.points(self.span(0, at))),
            Kind::Polygon => Geometry::Polygon(self.rings(1, at)),
            Kind::MultiLineString => {
                let lines = self.span(1, at).map(|line| self.points(self.span(0, line)));
                Geometry::MultiLineString(lines.collect())
            }
            Kind::MultiPolygon => {
                let polygons = self.span(2, at).map(|polygon| self.rings(1, polygon));
                Geometry::MultiPolygon(polygons.filter(|rings| !rings.is_empty()).collect())
            }
        }
    }
}

/// Result for a geometry.
#[derive(Debug)]
pub enum Row {
    /// Polygon of x and y that stays as it was given.
    Whole(usize),
    /// Another geometry, or nothing.
    Made(Option<Geometry>),
}

/// Arrays of geometries that are put together one by one.
#[derive(Debug, Clone)]
pub struct RaggedOut {
    /// Kind of all of them.
    pub kind: Kind,
    /// Two or three numbers for each position.
    pub coords: Vec<f64>,
    /// 2 or 3.
    pub width: usize,
    /// Offsets, from the innermost level to the outermost.
    pub offsets: Vec<Vec<i64>>,
}

impl RaggedOut {
    /// Puts runs of geometries, one after the other, into arrays of the kind of the given ones, or of its multiple kind if one
    /// has several parts. A missing or empty geometry has only its place in the arrays.
    pub fn new(given: &Ragged<'_>, runs: &[Vec<Row>]) -> Result<Self, String> {
        let is_multi = |row: &Row| match row {
            Row::Made(Some(Geometry::MultiPoint(points))) => points.len() != 1,
            Row::Made(Some(Geometry::MultiLineString(lines))) => lines.len() != 1,
            Row::Made(Some(Geometry::MultiPolygon(polygons))) => polygons.len() != 1,
            _ => false,
        };
        let multi = runs.par_iter().any(|run| run.iter().any(is_multi));
        let kind = match given.kind {
            Kind::Point if multi => Kind::MultiPoint,
            Kind::LineString if multi => Kind::MultiLineString,
            Kind::Polygon if multi => Kind::MultiPolygon,
            kind => kind,
        };
        let offsets = vec![vec![0]; kind.levels()];
        let mut all = Self { kind, coords: Vec::new(), width: given.width, offsets };
        let filled = |run: &Vec<Row>| {
            let (mut out, mut shapes) = (all.clone(), Shapes::new());
            let mut push = |row: &Row| match row {
                Row::Made(made) => out.push(made.as_ref()),
                Row::Whole(at) => {
                    given.fill(*at, &mut shapes);
                    out.push_polygon(&shapes);
                    Ok(())
                }
            };
            let failed = run.iter().enumerate().find_map(|(at, row)| Some((at, push(row).err()?)));
            (out, failed)
        };
        let parts: Vec<_> = runs.par_iter().map(filled).collect();
        let mut first = 0;
        all.coords.reserve_exact(parts.iter().map(|(part, _)| part.coords.len()).sum());
        for ((part, failed), run) in parts.into_iter().zip(runs) {
            if let Some((at, e)) = failed {
                return Err(format!("geometries[{}]: {e}", first + at));
            }
            all.append(&part);
            first += run.len();
        }
        Ok(all)
    }

    /// Adds a polygon of x and y, its outer ring counter-clockwise, its holes clockwise.
    fn push_polygon(&mut self, shapes: &Shapes) {
        for (k, ring) in shapes.rings().enumerate() {
            let Some(&first) = ring.first() else { continue };
            self.coords.extend(first.to_array());
            let rest = ring[1..].iter();
            if (signed_area(ring) < 0.0) == (k == 0) {
                self.coords.extend(rest.rev().flat_map(|p| p.to_array()));
            } else {
                self.coords.extend(rest.flat_map(|p| p.to_array()));
            }
            self.coords.extend(first.to_array());
            self.end_points();
        }
        self.end(1);
        if self.kind == Kind::MultiPolygon {
            self.end(2);
        }
    }

    /// Adds the geometries of other arrays of the same kind.
    fn append(&mut self, other: &Self) {
        for (own, offsets) in self.offsets.iter_mut().zip(&other.offsets) {
            let before = own.last().copied().unwrap_or_default();
            own.extend(offsets.iter().skip(1).map(|end| before + end));
        }
        self.coords.extend_from_slice(&other.coords);
    }

    fn add(&mut self, points: &Points, closed: bool) {
        let again = if closed { points.len().min(1) } else { 0 };
        for at in (0..points.len()).chain(0..again) {
            let p = points.xy[at];
            self.coords.extend([p.x, p.y]);
            if self.width == 3 {
                self.coords.push(points.zm(at)[0]);
            }
        }
    }

    /// Ends a part of the innermost level.
    fn end_points(&mut self) {
        let count = self.coords.len() / self.width;
        self.offsets[0].push(count as i64);
    }

    /// Ends a part of a level above.
    fn end(&mut self, level: usize) {
        let count = self.offsets[level - 1].len() - 1;
        self.offsets[level].push(count as i64);
    }

    fn polygon(&mut self, rings: &[Points]) {
        for ring in rings {
            self.add(ring, true);
            self.end_points();
        }
    }

    fn push(&mut self, geometry: Option<&Geometry>) -> Result<(), String> {
        use Geometry::{LineString, MultiLineString, MultiPoint, MultiPolygon, Point, Polygon};
        let geometry = geometry.filter(|geometry| !geometry.is_empty());
        match (self.kind, geometry) {
            (Kind::Point, None) => self.coords.extend(std::iter::repeat_n(f64::NAN, self.width)),
            (Kind::Point, Some(Point(points) | MultiPoint(points))) => self.add(points, false),
            (Kind::MultiPoint, Some(Point(points) | MultiPoint(points))) => {
                self.add(points, false);
                self.end_points();
            }
            (Kind::LineString | Kind::MultiPoint, None) => self.end_points(),
            (Kind::LineString, Some(LineString(line))) => {
                self.add(line, false);
                self.end_points();
            }
            (Kind::LineString, Some(MultiLineString(lines))) => {
                lines.iter().for_each(|line| self.add(line, false));
                self.end_points();
            }
            (Kind::MultiLineString, Some(LineString(line))) => {
                self.add(line, false);
                self.end_points();
                self.end(1);
            }
            (Kind::MultiLineString, Some(MultiLineString(lines))) => {
                for line in lines {
                    self.add(line, false);
                    self.end_points();
                }
                self.end(1);
            }
            (Kind::Polygon | Kind::MultiLineString, None) => self.end(1),
            (Kind::Polygon, Some(Polygon(rings))) => {
                self.polygon(rings);
                self.end(1);
            }
            (Kind::Polygon, Some(MultiPolygon(polygons))) => {
                polygons.iter().for_each(|rings| self.polygon(rings));
                self.end(1);
            }
            (Kind::MultiPolygon, None) => self.end(2),
            (Kind::MultiPolygon, Some(Polygon(rings))) => {
                self.polygon(rings);
                self.end(1);
                self.end(2);
            }
            (Kind::MultiPolygon, Some(MultiPolygon(polygons))) => {
                for rings in polygons {
                    self.polygon(rings);
                    self.end(1);
                }
                self.end(2);
            }
            (kind, Some(other)) => {
                return Err(format!(
                    "the result is a {}, which arrays of {kind:?} do not hold",
                    other.name()
                ));
            }
        }
        Ok(())
    }
}
