//! Line clipping in homogeneous coordinates.
//!
//! James Blinn and Martin Newell, "Clipping using homogeneous coordinates", SIGGRAPH 1978. Object
//! space; O(1), at most two cut points. A point (x, y, w) means (x/w, y/w). Each border has a boundary
//! coordinate, x − xmin·w for the left one, which is ≥ 0 inside; along a segment it is linear, so the
//! border is crossed at t = d₁ / (d₁ − d₂). The division by w comes after clipping, so w may be
//! anything: of a segment that runs behind the eye the part before it is found.
//!
//! The signs of boundary coordinates and the order of crossings are exact, and w ≥ 0 is one more
//! border, which windows without width need. In space there are six borders and w; polygons and the view volume with
//! −w ≤ x, y ≤ w: [`crate::clip::volume`].

use super::border::{Canonical, clamped, doubt};
use super::convex::HalfSpace;
use super::{ClipBox, Segment, convex, passage};
use crate::Result;
use crate::clip::exact::{EPSILON, Exact};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, DVec3, DVec4, Rect};
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
    cost: "O(1) per segment; five boundary coordinates per end, seven in space, at most two cut points",
    limits: "rectangles and boxes",
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
        "accept the part between; now divide by w",
    ],
};

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
    let clipped = clip_boundaries(&window, &boundaries::<2, 5>(&window), segment, &line, t);
    // The null vector lies on all borders, but has no place.
    Ok(clipped.filter(|s| s.start.z > 0.0 && s.end.z > 0.0))
}

/// Returns the part of a segment of homogeneous points (x, y, z, w) whose places (x/w, y/w, z/w) are in the closed box;
/// w > 0 at both of its ends. The boundary coordinates of the cube 0 … 1 are x, w − x, y, w − y, z, w − z.
///
/// ```
/// use durer::clip::line::{ClipBox, Segment, homogeneous::clip_homogeneous_box};
/// use durer::math::{DVec3, DVec4};
/// use durer::trace::NoTrace;
///
/// let cube = ClipBox::new(DVec3::ZERO, DVec3::ONE)?;
/// let segment = Segment::new(DVec4::new(-1.0, 0.0, 0.0, 1.0), DVec4::new(1.0, 0.0, 0.0, 1.0));
/// let seen = clip_homogeneous_box(&cube, segment, &mut NoTrace)?.unwrap();
/// assert_eq!(seen.start, DVec4::new(0.0, 0.0, 0.0, 1.0));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::NonFinite`] for a NaN or infinite coordinate.
pub fn clip_homogeneous_box(
    volume: &ClipBox<3>,
    segment: Segment<DVec4>,
    t: &mut impl Tracer<Step<DVec4>>,
) -> Result<Option<Segment<DVec4>>> {
    let line = Canonical::new(segment.start.to_array(), segment.end.to_array())?;
    let clipped = clip_boundaries(volume, &boundaries::<3, 7>(volume), segment, &line, t);
    Ok(clipped.filter(|s| s.start.w > 0.0 && s.end.w > 0.0))
}

/// A border of a window as a half space of homogeneous points: its boundary coordinate is x − border · w of an axis, or
/// border · w − x, or w itself.
#[derive(Debug, Clone, Copy)]
enum Boundary {
    Side { axis: usize, border: f64, upper: bool },
    Eye,
}

impl<const M: usize> HalfSpace<M> for Boundary {
    fn value(&self, p: [f64; M]) -> (f64, f64) {
        let w = p[M - 1];
        match *self {
            Self::Side { axis, border, upper } => {
                let (x, product) = (p[axis], border * w);
                let d = if upper { product - x } else { x - product };
                (d, (x.abs() + product.abs()) * (8.0 * EPSILON))
            }
            Self::Eye => (w, w.abs() * (8.0 * EPSILON)),
        }
    }

    fn exact(&self, p: [f64; M]) -> Exact {
        let w = p[M - 1];
        match *self {
            Self::Side { axis, border, upper } => {
                let (x, product) = (Exact::from(p[axis]), Exact::from(border) * Exact::from(w));
                if upper { product - x } else { x - product }
            }
            Self::Eye => Exact::from(w),
        }
    }

    fn normal(&self) -> [f64; M] {
        let mut normal = [0.0; M];
        match *self {
            Self::Side { axis, border, upper } => {
                let sign = if upper { -1.0 } else { 1.0 };
                (normal[axis], normal[M - 1]) = (sign, -sign * border);
            }
            Self::Eye => normal[M - 1] = 1.0,
        }
        normal
    }

    fn coordinate(&self) -> Option<(usize, f64)> {
        match *self {
            Self::Side { axis, border: 0.0, .. } => Some((axis, 0.0)),
            Self::Side { .. } => None,
            Self::Eye => Some((M - 1, 0.0)),
        }
    }
}

/// Returns the borders of each axis, the lower first, and w = 0: one more than twice the axes.
fn boundaries<const N: usize, const B: usize>(window: &ClipBox<N>) -> [Boundary; B] {
    std::array::from_fn(|i| match window.borders.get(i / 2) {
        Some(borders) => {
            let upper = i % 2 == 1;
            Boundary::Side { axis: i / 2, border: borders[i % 2], upper }
        }
        None => Boundary::Eye,
    })
}

fn clip_boundaries<const N: usize, const M: usize, P: From<[f64; M]>>(
    window: &ClipBox<N>,
    planes: &[Boundary],
    segment: Segment<P>,
    line: &Canonical<M>,
    t: &mut impl Tracer<Step<P>>,
) -> Option<Segment<P>> {
    passage::clip(planes, segment, line, |b| crossing(window, planes[b], b, line), t)
}

/// Returns the point on a border, exactly on it and inside the others, where rounding left it
/// beside.
fn crossing<const N: usize, const M: usize>(
    window: &ClipBox<N>,
    plane: Boundary,
    border: usize,
    line: &Canonical<M>,
) -> [f64; M] {
    let mut point = line.at(convex::parameter(&plane, line));
    if border == 2 * N || is_null(plane, line, point[M - 1]) {
        return [0.0; M];
    }
    let w = point[M - 1];
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
fn is_null<const M: usize>(border: Boundary, line: &Canonical<M>, w: f64) -> bool {
    if w.abs() > doubt(line.p[M - 1], line.q[M - 1]) {
        return false;
    }
    let (p, q) = (border.exact(line.p), border.exact(line.q));
    (Exact::from(line.p[M - 1]) * q - Exact::from(line.q[M - 1]) * p).sign() == Ordering::Equal
}
