//! A plane polygon in front of the eye.

use super::Screen;
use crate::curve::Contours;
use crate::math::{DVec2, DVec3, Plane};
use crate::raster::coverage::FillRule;
use crate::raster::polygon::{Options, edge_table};
use crate::raster::span::Span;
use crate::trace::NoTrace;
use crate::view::cull::newell_area;
use crate::{Error, Result};

/// Largest distance of corners from the plane, in units of the polygon's extent.
const FLATNESS: f64 = 1e-6;

/// A plane polygon: x right and y down in pixels, z the distance from the eye.
///
/// # Guarantees
/// At least three corners, all finite and in one plane; an area.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    corners: Vec<DVec3>,
    /// Plane through the mean of the corners; its normal by Newell's method, of unit length.
    plane: Plane,
    center: DVec3,
    /// Increase of z per pixel to the right and down; zero for a face seen edge-on.
    slope: DVec2,
}

impl Face {
    /// Creates the polygon with these corners, in either direction; it may be concave.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; [`Error::Parameter`] for a polygon without area, and for one whose corners are further
    /// from a common plane than a millionth of its extent.
    pub fn new(corners: &[DVec3]) -> Result<Self> {
        if let Some(index) = corners.iter().position(|c| !c.is_finite()) {
            return Err(Error::NonFinite { what: "corner", index });
        }
        let of = |expected| {
            Error::parameter("polygon", format!("of {} corners", corners.len()), expected)
        };
        let center = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
        let plane = Plane::through(center, newell_area(corners)).normalized();
        let Some(plane) = plane.filter(|plane| plane.distance.is_finite()) else {
            return Err(of("with an area"));
        };
        let normal = plane.normal;
        let extent = corners.iter().map(|c| c.distance(center)).fold(0.0, f64::max);
        if corners.iter().any(|&c| normal.dot(c - center).abs() > extent * FLATNESS) {
            return Err(of("plane"));
        }
        let slope = DVec2::new(-normal.x / normal.z, -normal.y / normal.z);
        let slope = if slope.is_finite() { slope } else { DVec2::ZERO };
        Ok(Self { corners: corners.to_vec(), plane, center, slope })
    }

    /// Returns the corners.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Returns the plane, its normal of unit length on the side from which the corners run
    /// counter-clockwise.
    pub fn plane(&self) -> &Plane {
        &self.plane
    }

    /// Returns the corners on the screen.
    pub fn outline(&self) -> Vec<DVec2> {
        self.corners.iter().map(|c| c.truncate()).collect()
    }

    /// Returns the distance of the face's plane from the eye at a point of the screen.
    pub fn depth(&self, p: DVec2) -> f64 {
        self.center.z + self.slope.dot(p - self.center.truncate())
    }

    /// Returns the nearest and the farthest corner's z.
    pub(crate) fn depths(&self) -> [f64; 2] {
        let z = || self.corners.iter().map(|c| c.z);
        [z().fold(f64::INFINITY, f64::min), z().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Returns the outline as contours.
    pub(super) fn contours(&self) -> Contours {
        Contours::polygon(self.outline())
    }

    /// Calls `emit` for the runs of pixels whose centres the polygon covers, by the even-odd rule.
    pub(crate) fn spans(&self, screen: &Screen, emit: impl FnMut(Span)) {
        let options = Options { rule: FillRule::EvenOdd };
        let (width, height) = (screen.width, screen.height);
        edge_table::fill(&self.contours(), width, height, &options, emit, &mut NoTrace);
    }

    /// Calls `f` for the pixels whose centres the polygon covers, with the point of the polygon there.
    pub(crate) fn pixels(&self, screen: &Screen, mut f: impl FnMut([u32; 2], DVec3)) {
        self.spans(screen, |span| {
            for x in span.x0..span.x1 {
                f([x as u32, span.y as u32], self.at(x, span.y));
            }
        });
    }

    /// Returns the plane's point at a pixel's centre.
    pub(super) fn at(&self, x: i32, y: i32) -> DVec3 {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        p.extend(self.depth(p))
    }
}
