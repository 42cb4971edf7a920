//! Points, lines and polygons of maps and plans, after the OGC's Simple Features.
//!
//! Source: OGC 06-103r4, *Simple Feature Access – Part 1: Common Architecture*, 2011.

use crate::math::{DVec2, Rect};

/// Ordinates of positions beside x and y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Dimensions {
    /// x and y only.
    #[default]
    Xy,
    /// x, y and a height.
    Xyz,
    /// x, y and a measure.
    Xym,
    /// x, y, a height and a measure.
    Xyzm,
}

impl Dimensions {
    /// Creates the dimensions with or without height and measure.
    pub fn new(z: bool, m: bool) -> Self {
        match (z, m) {
            (false, false) => Self::Xy,
            (true, false) => Self::Xyz,
            (false, true) => Self::Xym,
            (true, true) => Self::Xyzm,
        }
    }

    /// Returns whether there is a height.
    pub fn has_z(self) -> bool {
        matches!(self, Self::Xyz | Self::Xyzm)
    }

    /// Returns whether there is a measure.
    pub fn has_m(self) -> bool {
        matches!(self, Self::Xym | Self::Xyzm)
    }

    /// Returns the ordinates that either of two dimensions has.
    pub(crate) fn with(self, other: Self) -> Self {
        Self::new(self.has_z() || other.has_z(), self.has_m() || other.has_m())
    }

    /// Returns the number of ordinates in a position.
    pub fn count(self) -> usize {
        2 + usize::from(self.has_z()) + usize::from(self.has_m())
    }
}

/// Positions in the units and space of their file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Points {
    /// Ordinates of the positions.
    pub dimensions: Dimensions,
    /// x and y of each position; all are finite.
    pub xy: Vec<DVec2>,
    /// Height and measure of each position, 0 for an ordinate that the dimensions lack; empty if they have neither.
    pub zm: Vec<[f64; 2]>,
}

impl Points {
    /// Creates an empty list of positions.
    pub fn new(dimensions: Dimensions) -> Self {
        Self { dimensions, ..Self::default() }
    }

    /// Creates positions without height and measure.
    pub fn flat(xy: Vec<DVec2>) -> Self {
        Self { dimensions: Dimensions::Xy, xy, zm: Vec::new() }
    }

    /// Adds a position; height and measure are dropped if the dimensions have neither.
    pub fn push(&mut self, xy: DVec2, zm: [f64; 2]) {
        self.xy.push(xy);
        if self.dimensions != Dimensions::Xy {
            self.zm.push(zm);
        }
    }

    /// Adds the ordinates of other dimensions to all positions, 0 where they had none.
    pub fn lift(&mut self, dimensions: Dimensions) {
        self.dimensions = self.dimensions.with(dimensions);
        if self.dimensions != Dimensions::Xy {
            self.zm.resize(self.xy.len(), [0.0; 2]);
        }
    }

    /// Adds all positions of another list, with the ordinates that either has.
    pub(crate) fn append(&mut self, other: &Self) {
        if self.is_empty() {
            self.clone_from(other);
            return;
        }
        let own = self.len();
        let dimensions = self.dimensions.with(other.dimensions);
        if dimensions != Dimensions::Xy {
            self.zm.resize(own, [0.0; 2]);
            self.zm.extend((0..other.len()).map(|i| other.zm(i)));
        }
        self.dimensions = dimensions;
        self.xy.extend_from_slice(&other.xy);
    }

    /// Removes the last position.
    pub fn pop(&mut self) {
        self.xy.pop();
        self.zm.pop();
    }

    /// Returns the number of positions.
    pub fn len(&self) -> usize {
        self.xy.len()
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.xy.is_empty()
    }

    /// Returns the height and measure of a position; zeros if there are none.
    pub fn zm(&self, index: usize) -> [f64; 2] {
        self.zm.get(index).copied().unwrap_or_default()
    }

    /// Returns all numbers of a position, in the file's order: x, y, then height, then measure.
    pub fn ordinates(&self, index: usize) -> impl Iterator<Item = f64> {
        let (p, [z, m]) = (self.xy.get(index).copied().unwrap_or_default(), self.zm(index));
        let z = self.dimensions.has_z().then_some(z);
        let m = self.dimensions.has_m().then_some(m);
        [p.x, p.y].into_iter().chain(z).chain(m)
    }
}

/// A geometry of the OGC's Simple Features.
///
/// # Guarantees
/// Readers return finite coordinates, rings of at least three positions and line strings of at least two. Rings are
/// open: the first position is not repeated at the end. Rings may cross themselves or one another.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// Point: one position, or none.
    Point(Points),
    /// Line, or no positions.
    LineString(Points),
    /// Polygon: an outer ring, then its holes; or no rings.
    Polygon(Vec<Points>),
    /// Points.
    MultiPoint(Points),
    /// Lines.
    MultiLineString(Vec<Points>),
    /// Polygons, each as in [`Self::Polygon`].
    MultiPolygon(Vec<Vec<Points>>),
    /// Geometries of any types.
    Collection(Vec<Geometry>),
}

impl Geometry {
    /// Returns its name in GeoJSON.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Point(_) => "Point",
            Self::LineString(_) => "LineString",
            Self::Polygon(_) => "Polygon",
            Self::MultiPoint(_) => "MultiPoint",
            Self::MultiLineString(_) => "MultiLineString",
            Self::MultiPolygon(_) => "MultiPolygon",
            Self::Collection(_) => "GeometryCollection",
        }
    }

    /// Calls `f` for each run of positions: of points, of a line, of a ring.
    pub fn for_each(&self, f: &mut impl FnMut(&Points)) {
        match self {
            Self::Point(points) | Self::LineString(points) | Self::MultiPoint(points) => f(points),
            Self::Polygon(runs) | Self::MultiLineString(runs) => runs.iter().for_each(f),
            Self::MultiPolygon(polygons) => polygons.iter().flatten().for_each(f),
            Self::Collection(parts) => parts.iter().for_each(|part| part.for_each(f)),
        }
    }

    /// Returns the number of positions.
    pub fn len(&self) -> usize {
        let mut count = 0;
        self.for_each(&mut |points| count += points.len());
        count
    }

    /// Returns whether there are no positions.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the ordinates that any position has; `Xy` if there is none.
    pub fn dimensions(&self) -> Dimensions {
        let mut all = Dimensions::Xy;
        self.for_each(&mut |points| {
            if !points.is_empty() {
                all = all.with(points.dimensions);
            }
        });
        all
    }

    /// Returns the smallest rectangle around the geometry; `None` if it is empty.
    pub fn bounds(&self) -> Option<Rect> {
        let mut bounds: Option<Rect> = None;
        self.for_each(&mut |points| {
            let part = Rect::around(points.xy.iter().copied());
            bounds = match (bounds, part) {
                (Some(a), Some(b)) => Rect::around([a.min(), a.max(), b.min(), b.max()]),
                (a, b) => a.or(b),
            };
        });
        bounds
    }
}
