//! Whole geometries made valid, and neighbours given the same points on the borders that they share.

use super::{Area, Rules};
use crate::Result;
use crate::clip::polygon::coverage::matched;
use crate::clip::polygon::validity::{self, Touching};
use crate::clip::polygon::{Shapes, WindingRule};
use crate::geometry::Geometry;

/// A geometry whose polygons are valid.
#[derive(Debug, Clone, PartialEq)]
pub struct Fixed {
    /// The geometry; `None` if nothing of it is left.
    pub geometry: Option<Geometry>,
    /// True if its polygons were not valid.
    pub changed: bool,
}

/// Returns whether no polygons of a geometry cross, pinch or overlap themselves or one another; points and lines
/// always are valid.
///
/// ```
/// use durer::clip::mask::{Rules, is_valid};
/// use durer::geometry::{Geometry, Points};
/// use durer::math::DVec2;
///
/// let bow_tie = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)].map(DVec2::from);
/// let bow_tie = Geometry::Polygon(vec![Points::flat(bow_tie.to_vec())]);
/// assert!(!is_valid(&bow_tie));
/// let fixed = Rules::default().fix(&bow_tie)?;
/// assert!(fixed.changed);
/// assert!(fixed.geometry.is_some_and(|geometry| is_valid(&geometry)));
/// # Ok::<(), durer::Error>(())
/// ```
pub fn is_valid(geometry: &Geometry) -> bool {
    let area = Area::of_geometry(geometry);
    area.shapes.is_empty() || validity::is_valid(&area.shapes, Touching::AtPoints)
}

impl Rules {
    /// Makes the polygons of a geometry valid: edges that cross are cut there, spikes and doubled rings vanish.
    /// Geometries that are valid by the even-odd rule stay as they are; members of collections are taken one by one.
    ///
    /// # Errors
    /// As [`Rules::clean`].
    pub fn fix(&self, geometry: &Geometry) -> Result<Fixed> {
        let mut changed = false;
        let geometry = self.fix_parts(geometry, &mut changed)?;
        Ok(Fixed { geometry, changed })
    }

    fn fix_parts(&self, geometry: &Geometry, changed: &mut bool) -> Result<Option<Geometry>> {
        match geometry {
            Geometry::Polygon(_) | Geometry::MultiPolygon(_) => {
                let valid = is_valid(geometry);
                if self.fill == WindingRule::EvenOdd && valid {
                    return Ok(Some(geometry.clone()));
                }
                *changed |= !valid;
                Ok(self.clean(geometry)?.area.into_geometry())
            }
            Geometry::Collection(parts) => {
                let parts = parts.iter().map(|part| self.fix_parts(part, changed));
                let parts: Vec<Geometry> =
                    parts.filter_map(Result::transpose).collect::<Result<_>>()?;
                Ok((!parts.is_empty()).then_some(Geometry::Collection(parts)))
            }
            other => Ok(Some(other.clone())),
        }
    }
}

/// Adds to polygons the points that their neighbours have on shared borders, up to the rounding of coordinates
/// ([`matched()`]); returns the number of geometries changed. Collections, lines and points stay as they are.
pub fn match_points(geometries: &mut [Option<Geometry>]) -> usize {
    let area = |geometry: &Option<Geometry>| match geometry {
        Some(geometry @ (Geometry::Polygon(_) | Geometry::MultiPolygon(_))) => {
            Area::of_geometry(geometry)
        }
        _ => Area::default(),
    };
    let areas: Vec<Area> = geometries.iter().map(area).collect();
    let shapes: Vec<Shapes> = areas.iter().map(|area| area.shapes.clone()).collect();
    let mut count = 0;
    for ((geometry, area), found) in geometries.iter_mut().zip(areas).zip(matched(&shapes)) {
        if let Some(found) = found {
            *geometry = area.cut(found.shapes, &found.sources).into_geometry();
            count += 1;
        }
    }
    count
}
