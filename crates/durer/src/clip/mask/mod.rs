//! Clipping of any geometry to a window or to polygons: the production path, which chooses the algorithm by the
//! geometry and the mask, keeps heights and measures, and gives valid polygons.
//!
//! Points are located, lines are clipped by [`rectangle::clip_lines`](super::polygon::rectangle::clip_lines) or
//! [`polyline`](super::polyline), valid polygons by the rectangle clip, all others by
//! [`coverage`](super::polygon::coverage), which gives both sides of a common border the same points. A named
//! [`Algorithm`] can be requested in its place.
//!
//! ```
//! use durer::clip::mask::{Cutter, Mask};
//! use durer::geometry::{Geometry, Points};
//! use durer::math::{DVec2, Rect};
//!
//! let mask = Mask::window(Rect::new(DVec2::ZERO, DVec2::splat(10.0))?)?;
//! let line = Points::flat(vec![DVec2::new(-5.0, 5.0), DVec2::new(5.0, 5.0)]);
//! let cut = Cutter::new(&mask).cut(&Geometry::LineString(line))?;
//! let inside = Points::flat(vec![DVec2::new(0.0, 5.0), DVec2::new(5.0, 5.0)]);
//! assert_eq!(cut.geometry, Some(Geometry::LineString(inside)));
//! # Ok::<(), durer::Error>(())
//! ```
//!
//! Cost: the algorithm's; for geometries that the mask does not touch, O(their positions).

mod area;
mod cutter;
mod fix;
mod mean_value;
mod rules;
mod segments;
mod union;
mod values;

pub use area::{Area, oriented};
pub use cutter::{Algorithm, Cut, Cutter};
pub use fix::{Fixed, is_valid, match_points};
pub use rules::{Made, Rules};
pub use union::Union;

use super::polygon::Shapes;
use super::polygon::rectangle::Prepared;
use crate::Result;
use crate::math::{DVec2, Rect};

/// Region that geometries are clipped to: a window, or valid polygons.
#[derive(Debug, Clone)]
pub struct Mask {
    /// Valid polygons, or none; prepared for many geometries.
    polygons: Prepared,
    /// The mask as a rectangle, if it is one.
    pub window: Option<Rect>,
}

impl Mask {
    /// Creates the mask of a window.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for a window that is not finite.
    pub fn window(window: Rect) -> Result<Self> {
        Ok(Self { polygons: Prepared::new(rectangle_shape(&window))?, window: Some(window) })
    }

    /// Creates the mask of windows that have no point in common.
    ///
    /// # Errors
    /// As [`Mask::window`].
    pub fn windows(windows: &[Rect]) -> Result<Self> {
        let mut shapes = Shapes::new();
        windows.iter().for_each(|window| shapes.append(&rectangle_shape(window)));
        Self::polygons(shapes)
    }

    /// Creates the mask of valid polygons, or of none. [`Rules::clean`] makes polygons valid,
    /// [`crate::clip::polygon::validity`] checks them.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for coordinates that are not finite.
    pub fn polygons(shapes: Shapes) -> Result<Self> {
        Ok(Self { polygons: Prepared::new(shapes)?, window: None })
    }

    /// Returns whether it may have a point in common with anything in a box.
    pub(crate) fn meets(&self, bounds: &Rect) -> bool {
        self.polygons.bounds().is_some_and(|own| own.overlaps(bounds))
    }

    /// Returns whether a box is wholly inside; `None` if the mask's border comes near.
    pub fn side(&self, bounds: &Rect) -> Option<bool> {
        if !self.meets(bounds) {
            return Some(false);
        }
        if let Some(window) = self.window {
            let covers = window.contains(bounds.min()) && window.contains(bounds.max());
            return covers.then_some(true);
        }
        (!self.polygons.has_edges_near(bounds)).then(|| self.polygons.contains(bounds.min()))
    }

    /// Returns its polygons, prepared for many geometries.
    pub(crate) fn prepared(&self) -> &Prepared {
        &self.polygons
    }

    /// Returns its polygons.
    pub fn shapes(&self) -> &Shapes {
        self.polygons.shapes()
    }

    /// Returns whether a point is inside it or on its border.
    pub(crate) fn contains(&self, p: DVec2) -> bool {
        match self.window {
            Some(window) => window.contains(p),
            None => self.polygons.contains(p),
        }
    }

    /// Returns the polygons near a box; many are clipped to its surroundings.
    pub(crate) fn near(&self, bounds: &Rect) -> Shapes {
        /// Cutting fewer points away saves nothing.
        const FEW: usize = 64;
        let margin = bounds.size() * (1.0 / 64.0) + bounds.max().abs() * 1e-9;
        let around = Rect::new(bounds.min() - margin, bounds.max() + margin);
        match around {
            Ok(around) if self.shapes().points().len() > FEW => self.polygons.clip(&around),
            _ => self.shapes().clone(),
        }
    }
}

/// Returns a rectangle as a polygon.
fn rectangle_shape(window: &Rect) -> Shapes {
    let (a, b) = (window.min(), window.max());
    Shapes::from_rings([[a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)]])
}
