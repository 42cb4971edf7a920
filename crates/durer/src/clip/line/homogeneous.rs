//! Line clipping in homogeneous coordinates.
//!
//! James Blinn and Martin Newell, "Clipping using homogeneous coordinates", SIGGRAPH 1978. Object
//! space; O(1), at most two cut points. A point (x, y, w) means (x/w, y/w). Each border has a boundary
//! coordinate, x − xmin·w for the left one, which is ≥ 0 inside; along a segment it is linear, so the
//! border is crossed at t = d₁ / (d₁ − d₂). The division by w comes after clipping, so w may be
//! anything: of a segment that runs behind the eye the part before it is found.
//!
//! The signs of boundary coordinates and the order of crossings are exact, and w ≥ 0 is one more
//! border, which windows without width need. Points of space and their view volume:
//! [`crate::clip::volume`].

use super::border::{Canonical, clamped, doubt};
use super::convex::HalfSpace;
use super::{ClipBox, Segment, convex, passage};
use crate::Result;
use crate::clip::exact::Exact;
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, Plane, Rect};
use crate::trace::Tracer;
use std::cmp::Ordering;

pub use super::passage::{Numbers, Step, replay};

/// The facts of clipping in homogeneous coordinates.
pub const INFO: Info = Info {
    name: "homogeneous",
    title: "Homogeneous clipping",
    authors: "James Blinn, Martin Newell",
    year: 1978,
    source: "Clipping using homogeneous coordinates, SIGGRAPH 1978",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) per segment; five boundary coordinates per end, at most two cut points",
    limits: "rectangles; in space the view volume, by clip::volume",
    pseudocode: &[
        "α1 := 0; α2 := 1",
        "for each border with boundary coordinate d(x, y, w), ≥ 0 inside:",
        "    d1 := d(A); d2 := d(B); α := d1 / (d1 − d2), if the signs differ",
        "    d1 < 0 ≤ d2: entered, α1 := max(α1, α)",
        "    d2 < 0 ≤ d1: left, α2 := min(α2, α)",
        "    d1 < 0 and d2 < 0: nothing is visible",
        "if α1 > α2, or all is outside a border: reject, stop",
        "if α1 > 0: the start is A + α1·(B − A), in x, y and w",
        "if α2 < 1: the end is A + α2·(B − A)",
        "accept what is between; now divide by w",
    ],
};

/// There is nothing to choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options;

/// Returns the part of a segment in the closed rectangle: with w = 1 at both ends.
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip(
    window: &Rect,
    segment: Segment<DVec2>,
    t: &mut impl Tracer<Step<DVec3>>,
) -> Result<Option<Segment<DVec2>>> {
    let lifted = Segment::new(segment.start.extend(1.0), segment.end.extend(1.0));
    let clipped = clip_homogeneous(window, lifted, t)?;
    Ok(clipped.map(|s| Segment::new(s.start.truncate(), s.end.truncate())))
}

/// Returns the part of a segment of homogeneous points (x, y, w) whose places (x/w, y/w) are in the
/// closed rectangle; w > 0 at both of its ends.
///
/// ```
/// use durer::clip::line::{Segment, homogeneous::clip_homogeneous};
/// use durer::math::{DVec2, DVec3, Rect};
/// use durer::trace::NoTrace;
///
/// // The end lies behind the eye: its place (−8, 0) is not where the segment leads.
/// let window = Rect::new(DVec2::splat(-1.0), DVec2::splat(1.0))?;
/// let segment = Segment::new(DVec3::new(0.0, 0.0, 1.0), DVec3::new(8.0, 0.0, -1.0));
/// let seen = clip_homogeneous(&window, segment, &mut NoTrace)?.unwrap();
/// assert_eq!(seen.end.truncate() / seen.end.z, DVec2::new(1.0, 0.0));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip_homogeneous(
    window: &Rect,
    segment: Segment<DVec3>,
    t: &mut impl Tracer<Step<DVec3>>,
) -> Result<Option<Segment<DVec3>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    let window = ClipBox::<2>::from(window);
    let planes = boundary_planes(&window);
    let clipped =
        passage::clip(&planes, segment, &line, |b| crossing(&window, &planes, b, &line), t);
    // The null vector lies on all borders, but has no place.
    Ok(clipped.filter(|s| s.start.z > 0.0 && s.end.z > 0.0))
}

/// Returns the borders as planes through the origin of (x, y, w): left, right, bottom, top, and w =
/// 0.
fn boundary_planes(window: &ClipBox<2>) -> [Plane; 5] {
    let [[left, right], [bottom, top]] = window.borders;
    let normals = [
        DVec3::new(1.0, 0.0, -left),
        DVec3::new(-1.0, 0.0, right),
        DVec3::new(0.0, 1.0, -bottom),
        DVec3::new(0.0, -1.0, top),
        DVec3::Z,
    ];
    normals.map(|normal| Plane { normal, distance: 0.0 })
}

/// Returns the point on a border, exactly on it and inside the others, where rounding left it
/// beside.
fn crossing(
    window: &ClipBox<2>,
    planes: &[Plane; 5],
    border: usize,
    line: &Canonical<3>,
) -> [f64; 3] {
    let mut point = line.at(convex::parameter(&planes[border], line));
    if border == 4 || is_null(&planes[border], line, point[2]) {
        return [0.0; 3];
    }
    let w = point[2];
    for (axis, (value, borders)) in point.iter_mut().zip(window.borders).enumerate() {
        let [min, max] = borders.map(|border| border * w);
        *value = match border.wrapping_sub(2 * axis) {
            0 => min,
            1 => max,
            _ => clamped(*value, min, max),
        };
    }
    point
}

/// Returns whether a segment crosses a border in the null vector, where all borders meet: w, given
/// rounded, is exactly 0 there.
fn is_null(border: &Plane, line: &Canonical<3>, w: f64) -> bool {
    if w.abs() > doubt(line.p[2], line.q[2]) {
        return false;
    }
    let (p, q) = (border.exact(line.p), border.exact(line.q));
    (Exact::from(line.p[2]) * q - Exact::from(line.q[2]) * p).sign() == Ordering::Equal
}
