//! Curves to chains of lines with a bounded distance between the two.
//!
//! Each Bézier curve is cut into equal steps of its parameter; their number follows from the bound
//! on the second derivative (G.-Z. Wang, *The subdivision method for finding the intersection
//! between two Bézier curves or surfaces*, 1984): a curve of degree n whose largest second
//! difference of control points is m stays within n(n − 1)/8 · m/k² of its chain of k chords.

use std::ops::Range;

use super::path::{Path, PathElement};
use crate::info::{Class, Info, Occluder};
use crate::math::{DAffine2, DVec2};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// The facts of flattening.
pub const INFO: Info = Info {
    name: "flatten",
    title: "Adaptive flattening",
    authors: "Guo-Zhao Wang",
    year: 1984,
    source: "The subdivision method for finding the intersection between two Bézier curves or \
             surfaces, Journal of Zhejiang University",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(k) points, k of the order of the root of (size / tolerance)",
    limits: "at most 4096 pieces per curve",
    pseudocode: &[
        "for each contour of the path:",
        "    begin a chain at its first point",
        "    for each curve of degree n with control points P_0 … P_n:",
        "        b ← largest length of P_i − 2 P_(i+1) + P_(i+2)",
        "        // a chord over 1/s of the curve is at most n (n − 1) / 8 · b / s² away",
        "        s ← smallest number of chords that keeps the tolerance",
        "        for i = 1 … s:",
        "            append the point of the curve at t = i / s",
        "    end the chain, closed or open",
    ],
};

/// Largest number of pieces per curve: with control points a billion pixels away the tolerance is exceeded instead.
const MAX_SEGMENTS: f64 = 4096.0;

/// Chains of points, one after the other: flattened paths.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contours {
    points: Vec<DVec2>,
    /// Ends of the contours: index one past its last point, and whether it was closed.
    ends: Vec<(usize, bool)>,
}

impl Contours {
    /// Creates an empty list of contours.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends one contour.
    pub fn push(&mut self, points: impl IntoIterator<Item = DVec2>, closed: bool) {
        self.points.extend(points);
        self.end(closed);
    }

    /// Returns one closed contour.
    pub fn polygon(points: impl IntoIterator<Item = DVec2>) -> Self {
        let mut contours = Self::new();
        contours.push(points, true);
        contours
    }

    /// Returns each contour's points and whether it was closed.
    pub fn iter(&self) -> impl Iterator<Item = (&[DVec2], bool)> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|e| e.0));
        starts
            .zip(&self.ends)
            .map(|(start, (end, closed))| (self.points.get(start..*end).unwrap_or(&[]), *closed))
    }

    /// Returns all points of all contours.
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Returns the contours that have points in a range of all points: the points of each, and which of them
    /// are in the range.
    pub(crate) fn within(
        &self,
        range: Range<usize>,
    ) -> impl Iterator<Item = (&[DVec2], Range<usize>)> {
        let first = self.ends.partition_point(|end| end.0 <= range.start);
        let mut start = first.checked_sub(1).and_then(|i| self.ends.get(i)).map_or(0, |end| end.0);
        let ends = self.ends.get(first..).unwrap_or_default();
        ends.iter().map_while(move |(end, _)| {
            if start >= range.end {
                return None;
            }
            let own = range.start.max(start) - start..range.end.min(*end) - start;
            let points = self.points.get(std::mem::replace(&mut start, *end)..*end);
            Some((points.unwrap_or_default(), own))
        })
    }

    /// Returns the contours with every point mapped.
    pub fn transformed(mut self, map: DAffine2) -> Self {
        if map != DAffine2::IDENTITY {
            self.points.iter_mut().for_each(|p| *p = map.transform_point2(*p));
        }
        self
    }

    /// Forgets the contours and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
    }

    fn start(&self) -> usize {
        self.ends.last().map_or(0, |e| e.0)
    }

    fn end(&mut self, closed: bool) {
        if self.points.len() > self.start() {
            self.ends.push((self.points.len(), closed));
        }
    }
}

/// Returns the number of equal parameter steps that keep a Bézier curve of the given degree and
/// largest second difference of control points within `tolerance` of its chords.
pub fn segments_for(degree: u32, second_difference: f64, tolerance: f64) -> u32 {
    let bound = f64::from(degree) * f64::from(degree.saturating_sub(1)) / 8.0 * second_difference;
    let steps = (bound / tolerance.max(1e-9)).sqrt().ceil();
    if steps.is_finite() { steps.clamp(1.0, MAX_SEGMENTS) as u32 } else { 1 }
}

/// Replaces the curves of a path by chains of lines that stay within `tolerance` of them, in the
/// path's unit.
///
/// For pixels, 0.025 cannot be seen under anti-aliasing (at most 6/255 of coverage where a curve bends most) and is the
/// tolerance of [`crate::raster::paint`]; 0.1 is visible only by comparison. The number of lines grows with
/// 1/√tolerance. Contours that are not closed stay marked as open.
pub fn flatten(path: &Path, tolerance: f64) -> Contours {
    flatten_traced(path, tolerance, &mut NoTrace)
}

/// One step of flattening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A contour begins.
    Start(DVec2),
    /// The next chord of an element.
    Chord {
        /// Index of the element in the path.
        element: usize,
        /// End of the chord.
        end: DVec2,
        /// Bound on the distance of the curve from the chord, in the path's unit.
        error: f64,
    },
    /// The contour ends, closed or open.
    End {
        /// True if it was closed.
        closed: bool,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Start(_) => 2,
            Self::Chord { .. } => 8,
            Self::End { .. } => 9,
        }
    }
}

/// Flattens like [`flatten`], with a tracer for its steps.
pub fn flatten_traced(path: &Path, tolerance: f64, t: &mut impl Tracer<Step>) -> Contours {
    let mut out = Contours::new();
    let (mut start, mut at) = (None, DVec2::ZERO);
    for (index, element) in path.elements().iter().enumerate() {
        match *element {
            PathElement::MoveTo(p) => {
                end(&mut out, false, t);
                out.points.push(p);
                t.step(|| Step::Start(p));
                (start, at) = (Some(p), p);
            }
            PathElement::Close => {
                end(&mut out, true, t);
                at = start.take().unwrap_or(at);
            }
            PathElement::LineTo(p) | PathElement::QuadTo(_, p) | PathElement::CubicTo(_, _, p) => {
                if start.is_none() {
                    let first = if out.ends.is_empty() { p } else { at };
                    out.points.push(first);
                    t.step(|| Step::Start(first));
                    (start, at) = (Some(first), first);
                }
                let before = out.points.len();
                chain(at, element, tolerance, &mut out.points);
                let chords = &out.points[before..];
                for end in chords {
                    t.step(|| {
                        let error = chord_error(at, element, chords.len());
                        Step::Chord { element: index, end: *end, error }
                    });
                }
                at = p;
            }
        }
    }
    end(&mut out, false, t);
    out
}

/// Returns the bound that [`segments_for`] keeps, for this many chords of an element.
fn chord_error(a: DVec2, element: &PathElement, chords: usize) -> f64 {
    let bound = match *element {
        PathElement::QuadTo(b, c) => bend(a, b, c) / 4.0,
        PathElement::CubicTo(b, c, d) => bend(a, b, c).max(bend(b, c, d)) * 0.75,
        _ => 0.0,
    };
    bound / (chords * chords).max(1) as f64
}

/// Returns the length of the second difference of three control points.
fn bend(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (a - 2.0 * b + c).length()
}

/// Ends a contour, if one is open.
fn end(out: &mut Contours, closed: bool, t: &mut impl Tracer<Step>) {
    if out.points.len() > out.start() {
        t.step(|| Step::End { closed });
    }
    out.end(closed);
}

/// Appends the points of one element after its start `a`, its end last and exact.
pub(crate) fn chain(a: DVec2, element: &PathElement, tolerance: f64, out: &mut Vec<DVec2>) {
    match *element {
        PathElement::LineTo(p) => out.push(p),
        PathElement::QuadTo(b, c) => {
            let steps = segments_for(2, bend(a, b, c), tolerance);
            out.extend((1..steps).map(|i| {
                let t = f64::from(i) / f64::from(steps);
                a.lerp(b, t).lerp(b.lerp(c, t), t)
            }));
            out.push(c);
        }
        PathElement::CubicTo(b, c, d) => {
            let steps = segments_for(3, bend(a, b, c).max(bend(b, c, d)), tolerance);
            out.extend((1..steps).map(|i| {
                let t = f64::from(i) / f64::from(steps);
                let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
                ab.lerp(bc, t).lerp(bc.lerp(cd, t), t)
            }));
            out.push(d);
        }
        PathElement::MoveTo(_) | PathElement::Close => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Numbers;
    use crate::trace::Recorder;

    /// Returns the distance of a point from a chain of lines.
    fn distance(p: DVec2, chain: &[DVec2]) -> f64 {
        let to = |w: &[DVec2]| {
            let d = w[1] - w[0];
            let t = if d == DVec2::ZERO { 0.0 } else { (p - w[0]).dot(d) / d.length_squared() };
            (w[0] + d * t.clamp(0.0, 1.0)).distance(p)
        };
        chain.windows(2).map(to).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn chords_stay_within_the_tolerance() {
        let mut numbers = Numbers(7);
        let mut random = || f64::from(numbers.unit()) * 256.0;
        for _ in 0..200 {
            let p: Vec<DVec2> = (0..4).map(|_| DVec2::new(random(), random())).collect();
            for tolerance in [1.0, 0.1, 0.01] {
                let mut path = Path::new();
                path.move_to(p[0].x, p[0].y).cubic_to(p[1], p[2], p[3]);
                let chain = flatten(&path, tolerance);
                for i in 0..=100 {
                    let t = f64::from(i) / 100.0;
                    let s = 1.0 - t;
                    let q = p[0] * (s * s * s)
                        + p[1] * (3.0 * s * s * t)
                        + p[2] * (3.0 * s * t * t)
                        + p[3] * (t * t * t);
                    let d = distance(q, chain.points());
                    assert!(d <= tolerance * (1.0 + 1e-9), "{d} > {tolerance}");
                }
            }
        }
    }

    #[test]
    fn contours_keep_their_ends() {
        let mut path = Path::rectangle(0.0, 0.0, 2.0, 1.0);
        path.move_to(5.0, 5.0).line_to(6.0, 5.0);
        path.push(PathElement::LineTo(DVec2::NAN));
        let contours = flatten(&path, 0.1);
        let found: Vec<(usize, bool)> = contours.iter().map(|(p, c)| (p.len(), c)).collect();
        assert_eq!(found, [(4, true), (3, false)]);
    }

    #[test]
    fn the_steps_rebuild_the_contours() {
        let mut path = Path::circle(DVec2::ONE, 7.0);
        path.line_to(3.0, 4.0).quad_to(9.0, 1.0, 2.0, -5.0).close().close();
        path.move_to(1.0, 1.0).move_to(5.0, 5.0).cubic_to(DVec2::X, DVec2::Y, DVec2::ONE);
        let mut recorder = Recorder::default();
        let traced = flatten_traced(&path, 0.1, &mut recorder);
        assert_eq!(traced, flatten(&path, 0.1));
        let (mut replayed, mut points) = (Contours::new(), Vec::new());
        for step in recorder.steps() {
            match *step {
                Step::Start(p) => points = vec![p],
                Step::Chord { element, end, error } => {
                    assert!(error <= 0.1);
                    assert!(!matches!(path.elements()[element], PathElement::Close));
                    points.push(end);
                }
                Step::End { closed } => replayed.push(points.drain(..), closed),
            }
        }
        assert_eq!(replayed, traced);
        assert_eq!(traced.iter().count(), 4);
    }
}
