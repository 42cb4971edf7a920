//! Whole geometries with fewer points, and the removal of parts that become too small.

use super::coverage::{Coverage, Options};
use super::{LineSimplifier, tolerance_for_share};
use crate::Result;
use crate::clip::polygon::signed_area;
use crate::geometry::{Geometry, Points};
use crate::trace::NoTrace;

/// Number of points to leave out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amount {
    /// Largest weight of points that are left out, in units of the coordinates.
    Tolerance(f64),
    /// All but this share of the points that can be left out, 0 … 1.
    Keep(f64),
}

/// Leaves out points of the lines and borders of geometries, taken together: borders that neighbours share stay shared.
/// Heights and measures stay with their points. Returns the tolerance.
///
/// ```
/// use durer::clip::simplify::{Amount, LineSimplifier, simplify};
/// use durer::geometry::{Geometry, Points};
/// use durer::math::DVec2;
///
/// let line = [(0.0, 0.0), (2.0, 0.1), (4.0, 0.0), (4.0, 5.0)].map(DVec2::from);
/// let mut road = Geometry::LineString(Points::flat(line.to_vec()));
/// simplify(&mut [&mut road], LineSimplifier::DouglasPeucker, Amount::Tolerance(0.5))?;
/// assert_eq!(road.len(), 3);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// As [`Coverage::weights`].
pub fn simplify(
    geometries: &mut [&mut Geometry],
    method: LineSimplifier,
    amount: Amount,
) -> Result<f64> {
    let mut coverage = Coverage::default();
    for geometry in geometries.iter_mut() {
        chains(geometry, &mut |points, closed| {
            let xy = points.xy.iter().copied();
            if closed { coverage.push_ring(xy) } else { coverage.push_line(xy) }
        });
    }
    let limit = match amount {
        Amount::Tolerance(tolerance) => tolerance,
        Amount::Keep(_) => f64::INFINITY,
    };
    let weights = coverage.weights(&Options { method, limit }, &mut NoTrace)?;
    let tolerance = match amount {
        Amount::Tolerance(tolerance) => tolerance,
        Amount::Keep(share) => tolerance_for_share(&weights, share),
    };
    let mut weights = weights.into_iter();
    let mut thin = |points: &mut Points, _: bool| {
        let mut left = Points::new(points.dimensions);
        for (i, weight) in (0..points.len()).zip(weights.by_ref()) {
            if weight > tolerance {
                left.push(points.xy[i], points.zm(i));
            }
        }
        *points = left;
    };
    geometries.iter_mut().for_each(|geometry| chains(geometry, &mut thin));
    Ok(tolerance.max(0.0))
}

/// Calls for each line and ring, and says which it is.
fn chains(geometry: &mut Geometry, f: &mut dyn FnMut(&mut Points, bool)) {
    match geometry {
        Geometry::Point(_) | Geometry::MultiPoint(_) => {}
        Geometry::LineString(line) => f(line, false),
        Geometry::MultiLineString(lines) => lines.iter_mut().for_each(|line| f(line, false)),
        Geometry::Polygon(rings) => rings.iter_mut().for_each(|ring| f(ring, true)),
        Geometry::MultiPolygon(polygons) => {
            polygons.iter_mut().flatten().for_each(|ring| f(ring, true));
        }
        Geometry::Collection(parts) => parts.iter_mut().for_each(|part| chains(part, f)),
    }
}

/// Rings and lines that are left out because too little of them remains.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Dropped {
    /// Rings that enclose less than requested.
    pub small_rings: u64,
    /// Number of rings with fewer than three distinct points and lines with fewer than two, in the input.
    pub degenerate: u64,
}

impl Dropped {
    /// Adds other counts.
    pub fn add(&mut self, other: Self) {
        self.small_rings += other.small_rings;
        self.degenerate += other.degenerate;
    }

    /// Returns whether a ring stays.
    fn keeps(&mut self, ring: &Points, least: f64) -> bool {
        let degenerate = ring.len() < 3;
        let small = !degenerate && signed_area(&ring.xy).abs() < least;
        self.degenerate += u64::from(degenerate);
        self.small_rings += u64::from(small);
        !degenerate && !small
    }

    fn polygon(&mut self, mut rings: Vec<Points>, least: f64) -> Option<Vec<Points>> {
        // Without its outer ring a polygon is empty.
        let outer = rings.first().is_some_and(|ring| self.keeps(ring, least));
        let mut first = true;
        rings.retain(|ring| std::mem::take(&mut first) || self.keeps(ring, least));
        Some(rings).filter(|_| outer)
    }

    fn line(&mut self, line: &Points) -> bool {
        self.degenerate += u64::from(line.len() < 2);
        line.len() > 1
    }

    /// Counts and removes rings that enclose less than `least`, in squared units of the coordinates, and rings and
    /// lines of too few points; a polygon is removed with its outer ring. Returns the rest, or `None` if nothing is
    /// left. A geometry that was empty before stays.
    pub fn left(&mut self, geometry: Geometry, least: f64) -> Option<Geometry> {
        if geometry.is_empty() {
            return Some(geometry);
        }
        let left = match geometry {
            Geometry::LineString(line) if !self.line(&line) => return None,
            Geometry::MultiLineString(mut lines) => {
                lines.retain(|line| self.line(line));
                Geometry::MultiLineString(lines)
            }
            Geometry::Polygon(rings) => Geometry::Polygon(self.polygon(rings, least)?),
            Geometry::MultiPolygon(polygons) => {
                let left = polygons.into_iter().filter_map(|rings| self.polygon(rings, least));
                Geometry::MultiPolygon(left.collect())
            }
            Geometry::Collection(parts) => {
                let left = parts.into_iter().filter_map(|part| self.left(part, least));
                Geometry::Collection(left.collect())
            }
            other => other,
        };
        Some(left).filter(|left| !left.is_empty())
    }
}
