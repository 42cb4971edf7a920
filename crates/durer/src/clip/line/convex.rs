//! The code that algorithms for convex windows share: half spaces, exact sides, order of crossings.

use super::border::{Canonical, finite};
use crate::clip::exact::{EPSILON, Exact};
use crate::math::{DVec2, Orientation, Plane, Rect, orient2d};
use crate::sorting::CompactSort;
use crate::{Error, Result};
use std::cmp::Ordering;

/// A closed half-plane: the points p with E(p) = normal · (p − point) ≥ 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// Points to the inside; need not have unit length.
    pub normal: DVec2,
    /// Any point of the border.
    pub point: DVec2,
}

impl HalfPlane {
    /// Returns the four half-planes whose intersection is the rectangle: left, right, bottom, top.
    pub fn of_rect(window: &Rect) -> [Self; 4] {
        let (min, max) = (window.min(), window.max());
        [(DVec2::X, min), (-DVec2::X, max), (DVec2::Y, min), (-DVec2::Y, max)]
            .map(|(normal, point)| Self { normal, point })
    }
}

/// A convex polygon, its vertices counter-clockwise (y up).
///
/// # Guarantees
/// All coordinates are finite; at least three vertices; no two neighbours coincide; every turn is to the left or
/// straight, and the ring winds around once.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexPolygon {
    vertices: Vec<DVec2>,
}

impl ConvexPolygon {
    /// Creates the polygon with these vertices, in either direction; repeated neighbours are
    /// dropped.
    ///
    /// # Errors
    /// [`Error::NonFinite`]; [`Error::Parameter`] if the ring is not convex or has no area.
    pub fn new(vertices: &[DVec2]) -> Result<Self> {
        if let Some(index) = vertices.iter().position(|v| !v.is_finite()) {
            return Err(Error::NonFinite { what: "vertex", index });
        }
        let mut ring = vertices.to_vec();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        if turns(&ring).any(|t| t == Orientation::Clockwise) {
            ring.reverse();
        }
        let bends = turns(&ring).any(|t| t == Orientation::CounterClockwise);
        let convex = bends && turns(&ring).all(|t| t != Orientation::Clockwise);
        if convex && goes_round_once(&ring) {
            Ok(Self { vertices: ring })
        } else {
            let value = format!("a ring of {} vertices", vertices.len());
            Err(Error::parameter("polygon", value, "convex, with an area"))
        }
    }

    /// Returns the vertices, counter-clockwise.
    pub fn vertices(&self) -> &[DVec2] {
        &self.vertices
    }

    /// Returns the edges, each with the inside on its left.
    pub(crate) fn edges(&self) -> Vec<Edge> {
        pairs(&self.vertices).map(|(from, to)| Edge { from, to }).collect()
    }
}

fn pairs(ring: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

fn turns(ring: &[DVec2]) -> impl Iterator<Item = Orientation> + '_ {
    pairs(ring).zip(ring.iter().cycle().skip(2)).map(|((a, b), c)| orient2d(a, b, *c))
}

/// Returns whether a ring that only turns left winds around once: whether it goes up and down only once, and does not
/// turn back on itself.
fn goes_round_once(ring: &[DVec2]) -> bool {
    let ups: Vec<bool> =
        pairs(ring).filter(|(a, b)| a != b).map(|(a, b)| (b.y, b.x) > (a.y, a.x)).collect();
    let changes = ups.iter().zip(ups.iter().cycle().skip(1)).filter(|(a, b)| a != b).count();
    changes == 2
}

/// A half-plane given by two points: the points on the left of from → to, or on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Edge {
    /// Any point of the border.
    pub from: DVec2,
    /// Another point of it.
    pub to: DVec2,
}

/// A closed half space E ≥ 0 of N dimensions that knows how far its rounded E can be off:
/// [`HalfPlane`], [`Plane`] or an edge of a [`ConvexPolygon`].
pub trait HalfSpace<const N: usize> {
    /// Returns E(p) rounded, and a bound of its error; both may be infinite or NaN for huge coordinates.
    fn value(&self, p: [f64; N]) -> (f64, f64);
    /// Returns E(p) exactly.
    #[doc(hidden)]
    fn exact(&self, p: [f64; N]) -> Exact;
    /// Returns the gradient of E, rounded.
    fn normal(&self) -> [f64; N];
    /// Returns the axis and coordinate of a border that is parallel to all other axes and has such a number.
    fn coordinate(&self) -> Option<(usize, f64)>;
    /// Returns corners of the window on this border, if known.
    fn corners(&self) -> Vec<[f64; N]> {
        Vec::new()
    }

    /// Returns the exact sign of E(p).
    #[inline]
    fn sign(&self, p: [f64; N]) -> Ordering {
        let (value, bound) = self.value(p);
        if value.abs() > bound && bound > 1e-280 {
            return if value > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        self.exact(p).sign()
    }
}

impl HalfSpace<2> for HalfPlane {
    fn value(&self, p: [f64; 2]) -> (f64, f64) {
        let x = self.normal.x * (p[0] - self.point.x);
        let y = self.normal.y * (p[1] - self.point.y);
        (x + y, (x.abs() + y.abs()) * (8.0 * EPSILON))
    }

    fn exact(&self, p: [f64; 2]) -> Exact {
        let e = Exact::from;
        e(self.normal.x) * (e(p[0]) - e(self.point.x))
            + e(self.normal.y) * (e(p[1]) - e(self.point.y))
    }

    fn normal(&self) -> [f64; 2] {
        self.normal.to_array()
    }

    fn coordinate(&self) -> Option<(usize, f64)> {
        match self.normal.to_array() {
            [_, 0.0] => Some((0, self.point.x)),
            [0.0, _] => Some((1, self.point.y)),
            _ => None,
        }
    }
}

impl HalfSpace<2> for Edge {
    fn value(&self, p: [f64; 2]) -> (f64, f64) {
        let along = self.to - self.from;
        let left = along.x * (p[1] - self.from.y);
        let right = along.y * (p[0] - self.from.x);
        (left - right, (left.abs() + right.abs()) * (8.0 * EPSILON))
    }

    fn exact(&self, p: [f64; 2]) -> Exact {
        let e = Exact::from;
        (e(self.to.x) - e(self.from.x)) * (e(p[1]) - e(self.from.y))
            - (e(self.to.y) - e(self.from.y)) * (e(p[0]) - e(self.from.x))
    }

    fn normal(&self) -> [f64; 2] {
        (self.to - self.from).perp().to_array()
    }

    fn corners(&self) -> Vec<[f64; 2]> {
        vec![self.from.to_array(), self.to.to_array()]
    }

    fn coordinate(&self) -> Option<(usize, f64)> {
        if self.from.x == self.to.x {
            Some((0, self.from.x))
        } else {
            (self.from.y == self.to.y).then_some((1, self.from.y))
        }
    }
}

impl HalfSpace<3> for Plane {
    fn value(&self, p: [f64; 3]) -> (f64, f64) {
        let [x, y, z] = (self.normal * crate::math::DVec3::from_array(p)).to_array();
        let size = x.abs() + y.abs() + z.abs() + self.distance.abs();
        (x + y + z + self.distance, size * (8.0 * EPSILON))
    }

    fn exact(&self, p: [f64; 3]) -> Exact {
        let product = |n: f64, x: f64| Exact::from(n) * Exact::from(x);
        product(self.normal.x, p[0])
            + product(self.normal.y, p[1])
            + (product(self.normal.z, p[2]) + Exact::from(self.distance))
    }

    fn normal(&self) -> [f64; 3] {
        self.normal.to_array()
    }

    fn coordinate(&self) -> Option<(usize, f64)> {
        let axis = match self.normal.to_array().map(|n| n != 0.0) {
            [true, false, false] => 0,
            [false, true, false] => 1,
            [false, false, true] => 2,
            _ => return None,
        };
        // Only with a unit normal along an axis is the border's coordinate certainly a floating-point number.
        let n = self.normal.to_array()[axis];
        (n.abs() == 1.0).then_some((axis, -self.distance * n))
    }
}

/// Returns the point where the segment crosses the border of half space `index`, inside all half
/// spaces if a floating-point point that close is.
pub(super) fn crossing<const N: usize, H: HalfSpace<N>>(
    spaces: &[H],
    index: usize,
    line: &Canonical<N>,
) -> [f64; N] {
    let space = &spaces[index];
    let scale = size(line.p).max(size(line.q));
    let on_border = |mut point: [f64; N]| {
        if let Some((axis, border)) = space.coordinate() {
            point[axis] = border;
        }
        point
    };
    let point = on_border(line.at(parameter(space, line)));
    let near = |point| {
        let exact = on_border(exact_crossing(space, line));
        settled(spaces, exact, scale)
            .or_else(|| slid(spaces, exact, scale))
            .or_else(|| nearest_corner(space, point, scale))
    };
    settled(spaces, point, scale).or_else(|| near(point)).unwrap_or(point)
}

fn size<const N: usize>(v: [f64; N]) -> f64 {
    v.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Returns the crossing with every coordinate computed exactly and rounded once: for windows so
/// thin that an ulp of the segment's ends is too much.
fn exact_crossing<const N: usize, H: HalfSpace<N>>(space: &H, line: &Canonical<N>) -> [f64; N] {
    let (p, q) = (space.exact(line.p), space.exact(line.q));
    let divisor = q.clone() - p.clone();
    std::array::from_fn(|k| {
        let (a, b) = (Exact::from(line.p[k]), Exact::from(line.q[k]));
        (a * q.clone() - b * p.clone()).ratio(&divisor)
    })
}

/// Returns a corner that equals the cut up to rounding: in the tip of a needle no other floating-point number is
/// inside.
fn nearest_corner<const N: usize, H: HalfSpace<N>>(
    space: &H,
    cut: [f64; N],
    scale: f64,
) -> Option<[f64; N]> {
    let offset = |c: &[f64; N]| size::<N>(std::array::from_fn(|k| c[k] - cut[k]));
    space.corners().into_iter().find(|c| offset(c) <= scale * (64.0 * EPSILON))
}

/// Returns t of the crossing: 0 at p, 1 at q; to within a few ulp.
pub(crate) fn parameter<const N: usize, H: HalfSpace<N>>(space: &H, line: &Canonical<N>) -> f64 {
    let ((p, p_off), (q, q_off)) = (space.value(line.p), space.value(line.q));
    let accurate = |v: f64, off: f64| off <= v.abs() * 1e-14 && off > 1e-280 && v.is_finite();
    if accurate(p, p_off) && accurate(q, q_off) {
        // A quarter of each, because the difference of two huge values overflows.
        return p * 0.25 / (p * 0.25 - q * 0.25);
    }
    let (p, q) = (space.exact(line.p), space.exact(line.q));
    p.ratio(&(p.clone() - q))
}

/// Moves a cut point that rounding has put outside to the inside, by a few ulp at most, so that
/// clipping its segment again finds it inside and leaves it alone; `None` if that fails.
fn settled<const N: usize, H: HalfSpace<N>>(
    spaces: &[H],
    mut point: [f64; N],
    scale: f64,
) -> Option<[f64; N]> {
    for round in 0..SETTLE_ROUNDS {
        let Some(space) = spaces.iter().find(|s| s.sign(point) == Ordering::Less) else {
            return Some(point);
        };
        // Twice as far each time: the error may be an ulp of the point or of the segment's ends.
        let step = size(point).max(scale * 1e-18) * libm::scalbn(1.0, round);
        point = pushed(space, point, step.min(scale * 16.0));
    }
    None
}

/// Number of turns around the borders after which a window is taken to hold no floating-point point near the cut:
/// enough for steps to grow from an ulp of the point to one of the segment's ends.
const SETTLE_ROUNDS: i32 = 64;

/// Moves a cut point that rounding has put outside along one axis to the first number inside the border
/// that it is beyond, if that is inside all others and near; `None` if no axis does.
///
/// Where coordinates differ much in size, a step of an ulp of the larger one leads through the tip of
/// a needle and out again; the smaller one has numbers inside.
fn slid<const N: usize, H: HalfSpace<N>>(
    spaces: &[H],
    point: [f64; N],
    scale: f64,
) -> Option<[f64; N]> {
    let outside = |p: [f64; N]| spaces.iter().find(move |s| s.sign(p) == Ordering::Less);
    let Some(space) = outside(point) else { return Some(point) };
    if space.coordinate().is_some() {
        // The border itself; there is nothing to look for.
        let moved = pushed(space, point, scale);
        return outside(moved).is_none().then_some(moved);
    }
    let normal = space.normal();
    let (mut axes, off) = (std::array::from_fn::<usize, N, _>(|k| k), space.exact(point));
    axes.compact_sort_by(|&a, &b| normal[b].abs().total_cmp(&normal[a].abs()));
    axes.into_iter().filter(|&k| normal[k] != 0.0 && normal[k].is_finite()).find_map(|k| {
        let mut moved = point;
        moved[k] -= off.ratio(&Exact::from(normal[k]));
        // The quotient and the difference are rounded: an ulp or two are missing at most.
        for _ in 0..4 {
            if moved[k].is_finite() && space.sign(moved) == Ordering::Less {
                moved[k] = if normal[k] > 0.0 { moved[k].next_up() } else { moved[k].next_down() };
            }
        }
        let near = (moved[k] - point[k]).abs() <= scale * (64.0 * EPSILON);
        (near && outside(moved).is_none()).then_some(moved)
    })
}

/// Returns the point moved inwards by a quarter ulp of `scale`.
fn pushed<const N: usize, H: HalfSpace<N>>(space: &H, point: [f64; N], scale: f64) -> [f64; N] {
    if let Some((axis, border)) = space.coordinate() {
        let mut point = point;
        point[axis] = border;
        return point;
    }
    let normal = space.normal();
    let step = scale * (0.5 * EPSILON) / size(normal);
    let moved: [f64; N] = std::array::from_fn(|k| {
        let target = point[k] + normal[k] * step;
        // A step below half an ulp of this coordinate would be lost.
        match (target == point[k], normal[k] > 0.0) {
            (false, _) => target,
            (true, true) if normal[k].abs() * 2.0 > size(normal) => point[k].next_up(),
            (true, false) if normal[k].abs() * 2.0 > size(normal) => point[k].next_down(),
            (true, _) => target,
        }
    });
    if finite(&moved) { moved } else { point }
}
