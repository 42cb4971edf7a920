//! Cyrus–Beck line clipping.
//!
//! Mike Cyrus and Jay Beck, "Generalized two- and three-dimensional clipping", Computers & Graphics 3(1), 1978. Object
//! space; O(n) for a window with n borders. Every border is crossed inwards or outwards; the last entry and the first
//! exit bound the visible part.
//!
//! Special cases have rules: a segment parallel to a border, or of length zero, does not cross it and is judged by the
//! side of its ends. Sides and the order of crossings are exact; a cut point that rounding puts outside is moved inside
//! by a few ulp.

use super::border::Canonical;
use super::passage::clip_convex;
use super::{ConvexPolygon, HalfPlane, Segment};
use crate::Result;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, Plane, Rect};
use crate::trace::Tracer;

pub use super::passage::{Numbers, Step, replay};

/// The facts of Cyrus–Beck clipping.
pub const INFO: Info = Info {
    name: "cyrus-beck",
    title: "Cyrus–Beck",
    authors: "Mike Cyrus, Jay Beck",
    year: 1978,
    source: "Generalized two- and three-dimensional clipping, Computers & Graphics 3(1)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) per segment, n borders",
    limits: "convex windows; cut points lie within a few ulp of a slanted border",
    pseudocode: &[
        "t_E := 0; t_L := 1; v := B − A",
        "for each border with outer normal n and a point Q on it:",
        "    t := −(A − Q)·n / (v·n), unless v·n = 0",
        "    A outside, B inside (v·n < 0): entered, t_E := max(t_E, t)",
        "    A inside, B outside (v·n > 0): left, t_L := min(t_L, t)",
        "    A and B outside: nothing is visible",
        "if t_E > t_L, or all is outside a border: reject, stop",
        "if t_E > 0: the start is A + t_E·v",
        "if t_L < 1: the end is A + t_L·v",
        "accept the part between",
    ],
};

/// Returns the part of a segment in the closed rectangle, taken as four half-planes.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip(
    window: &Rect,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step<DVec2>>,
) -> Result<Option<Segment<DVec2>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    Ok(clip_convex(&HalfPlane::of_rect(window), segment, &line, t))
}

/// Returns the part of a segment in a closed convex polygon.
///
/// ```
/// use durer::clip::line::{ConvexPolygon, Segment, cyrus_beck};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let p = DVec2::new;
/// let triangle = ConvexPolygon::new(&[p(0.0, 0.0), p(4.0, 0.0), p(0.0, 4.0)])?;
/// let clipped = cyrus_beck::clip_polygon(&triangle, Segment::new(p(1.0, 1.0), p(5.0, 1.0)), &mut NoTrace)?;
/// assert_eq!(clipped, Some(Segment::new(p(1.0, 1.0), p(3.0, 1.0))));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip_polygon(
    window: &ConvexPolygon,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step<DVec2>>,
) -> Result<Option<Segment<DVec2>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    Ok(clip_convex(&window.edges(), segment, &line, t))
}

/// Returns the part of a segment in the closed convex polyhedron that is the intersection of the
/// positive sides of the planes; it may be unbounded.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate; the same for a plane
/// that has one.
pub fn clip_polyhedron(
    window: &[Plane],
    segment: Segment<DVec3>,
    t: &mut impl Tracer<Step<DVec3>>,
) -> Result<Option<Segment<DVec3>>> {
    for (index, plane) in window.iter().enumerate() {
        if !(plane.normal.is_finite() && plane.distance.is_finite()) {
            return Err(crate::Error::NonFinite { what: "plane", index });
        }
    }
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    Ok(clip_convex(window, segment, &line, t))
}
