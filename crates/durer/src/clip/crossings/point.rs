//! Points where segments meet, with exact coordinates.

use crate::clip::exact::{self, Exact};
use crate::math::DVec2;
use std::cmp::Ordering;

/// A point of the plane, x / w and y / w with w > 0. Points are ordered as in the sweep: by x, then by y.
#[derive(Debug, Clone)]
pub struct Point {
    x: Exact,
    y: Exact,
    w: Exact,
    /// Coordinates, correctly rounded.
    near: DVec2,
    /// True if these are exact.
    is_rounded: bool,
}

impl From<DVec2> for Point {
    fn from(p: DVec2) -> Self {
        let [x, y, w] = [p.x, p.y, 1.0].map(Exact::from);
        Self { x, y, w, near: p + DVec2::ZERO, is_rounded: false }
    }
}

impl Ord for Point {
    fn cmp(&self, other: &Self) -> Ordering {
        // Rounding keeps the order, so only equal numbers need their fractions.
        let axis = |k: usize, a: &Exact, b: &Exact| {
            let near = self.near[k].partial_cmp(&other.near[k]).unwrap_or(Ordering::Equal);
            if near.is_ne() || !(self.is_rounded || other.is_rounded) {
                return near;
            }
            (a.clone() * other.w.clone() - b.clone() * self.w.clone()).sign()
        };
        axis(0, &self.x, &other.x).then_with(|| axis(1, &self.y, &other.y))
    }
}

impl PartialOrd for Point {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Point {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Point {}

impl Point {
    /// Returns the coordinates, correctly rounded.
    pub fn near(&self) -> DVec2 {
        self.near
    }

    /// Returns whether it is this end of a segment.
    pub fn is(&self, end: DVec2) -> bool {
        !self.is_rounded && self.near == end
    }

    /// Returns the side of the directed line a → b on which it lies: `Greater` left, `Less` right.
    pub fn side(&self, [a, b]: [DVec2; 2]) -> Ordering {
        if !self.is_rounded {
            return exact::side(a, b, self.near);
        }
        let offset = |value: &Exact, from: f64| value.clone() - Exact::from(from) * self.w.clone();
        let left = minus(b.x, a.x) * offset(&self.y, a.y);
        (left - minus(b.y, a.y) * offset(&self.x, a.x)).sign()
    }
}

fn minus(p: f64, q: f64) -> Exact {
    Exact::from(p) - Exact::from(q)
}

/// Returns (b − a) × (d − c).
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Exact {
    minus(b.x, a.x) * minus(d.y, c.y) - minus(b.y, a.y) * minus(d.x, c.x)
}

/// Returns the side to which the second of two segments turns from the direction of the first: `Greater` left.
pub fn turn(first: [DVec2; 2], second: [DVec2; 2]) -> Ordering {
    cross(first, second).sign()
}

/// The points that two segments have in common.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Meeting {
    /// None.
    Apart,
    /// One.
    At(Point),
    /// A piece of one line, with these ends.
    Along([Point; 2]),
}

/// Returns what two closed segments have in common, each given from its smaller end to its larger one.
pub fn meeting([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Meeting {
    let [at_c, at_d] = [c, d].map(|p| exact::side(a, b, p));
    let [at_a, at_b] = [a, b].map(|p| exact::side(c, d, p));
    if [at_a, at_b, at_c, at_d].iter().all(|side| side.is_eq()) {
        return along([a, b], [c, d]);
    }
    if at_c == at_d || at_a == at_b {
        return Meeting::Apart;
    }
    let ends = [(at_a, a), (at_b, b), (at_c, c), (at_d, d)];
    if let Some((_, end)) = ends.into_iter().find(|(side, _)| side.is_eq()) {
        return Meeting::At(end.into());
    }
    let (num, den) = (cross([a, c], [c, d]), cross([a, b], [c, d]));
    let axis = |k: usize| Exact::from(a[k]) * den.clone() + minus(b[k], a[k]) * num.clone();
    let (x, y) = (axis(0), axis(1));
    let near = DVec2::new(x.rounded_ratio(&den), y.rounded_ratio(&den));
    let positive = |v: Exact| if den.sign().is_lt() { Exact::from(0.0) - v } else { v };
    let (x, y, w) = (positive(x), positive(y), positive(den.clone()));
    Meeting::At(Point { x, y, w, near, is_rounded: true })
}

/// Returns the common piece of two segments on one line, each of which may be a point.
fn along([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Meeting {
    let [from, to] = [Point::from(a).max(c.into()), Point::from(b).min(d.into())];
    match from.cmp(&to) {
        Ordering::Less => Meeting::Along([from, to]),
        Ordering::Equal => Meeting::At(from),
        Ordering::Greater => Meeting::Apart,
    }
}

/// Returns the ends of a segment in the order of the sweep.
pub fn ordered([a, b]: [DVec2; 2]) -> [DVec2; 2] {
    if (a.x, a.y) <= (b.x, b.y) { [a, b] } else { [b, a] }
}
