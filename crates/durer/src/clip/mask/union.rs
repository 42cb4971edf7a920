//! Several geometries as one.

use super::{Area, Rules};
use crate::Result;
use crate::clip::polygon::{BooleanOp, Shapes, WindingRule};
use crate::geometry::{Geometry, Points};
use crate::work::Work;

impl Area {
    /// Returns the union of polygons, each of which is valid, with outer rings counter-clockwise: borders between them
    /// vanish, and overlaps count once.
    ///
    /// # Errors
    /// As [`Rules::overlay`].
    pub fn union(&self, work: &Work) -> Result<Self> {
        let rules = Rules { fill: WindingRule::Positive, grid: None, work: work.clone() };
        Ok(rules.overlay(self, &Shapes::new(), BooleanOp::Union, WindingRule::Positive)?.area)
    }
}

/// Geometries that become one: their polygons are united, their lines and points collected unchanged.
///
/// ```
/// use durer::clip::mask::{Rules, Union};
/// use durer::geometry::{Geometry, Points};
/// use durer::math::DVec2;
/// use durer::work::Work;
///
/// let mut union = Union::default();
/// for x in [0.0, 1.0] {
///     let square = [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)].map(DVec2::from);
///     let square = Geometry::Polygon(vec![Points::flat(square.to_vec())]);
///     union.add(&square, &Rules::default().clean(&square)?.area);
/// }
/// let Some(Geometry::Polygon(rings)) = union.finish(&Work::default())? else { panic!("one polygon") };
/// assert_eq!(rings.len(), 1);
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Default)]
pub struct Union {
    area: Area,
    lines: Vec<Points>,
    points: Points,
}

impl Union {
    /// Adds a geometry, with its valid polygons as returned by [`Rules::clean`]. Heights and measures that only some of
    /// the geometries have are 0 in the others; returns whether that happened.
    pub fn add(&mut self, geometry: &Geometry, valid: &Area) -> bool {
        let mixed = self.area.append(valid);
        self.add_rest(geometry) | mixed
    }

    /// Adds the lines and points; returns whether points have other ordinates than those before.
    fn add_rest(&mut self, geometry: &Geometry) -> bool {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                let (dimensions, first) = (self.points.dimensions, self.points.is_empty());
                self.points.append(points);
                return !first && points.dimensions != dimensions;
            }
            Geometry::LineString(line) => self.lines.push(line.clone()),
            Geometry::MultiLineString(lines) => self.lines.extend(lines.iter().cloned()),
            Geometry::Collection(parts) => {
                return parts.iter().fold(false, |mixed, part| self.add_rest(part) | mixed);
            }
            Geometry::Polygon(_) | Geometry::MultiPolygon(_) => {}
        }
        false
    }

    /// Returns all as one geometry, a collection if there are several kinds; `None` if there is nothing.
    ///
    /// # Errors
    /// As [`Area::union`].
    pub fn finish(mut self, work: &Work) -> Result<Option<Geometry>> {
        let area = self.area.union(work)?.into_geometry();
        let lines = match self.lines.len() {
            0 => None,
            1 => self.lines.pop().map(Geometry::LineString),
            _ => Some(Geometry::MultiLineString(self.lines)),
        };
        let points = match self.points.len() {
            0 => None,
            1 => Some(Geometry::Point(self.points)),
            _ => Some(Geometry::MultiPoint(self.points)),
        };
        let mut parts: Vec<Geometry> = [area, lines, points].into_iter().flatten().collect();
        Ok(if parts.len() > 1 { Some(Geometry::Collection(parts)) } else { parts.pop() })
    }
}
