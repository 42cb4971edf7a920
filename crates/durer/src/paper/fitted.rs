//! Lines of a drawing as curves on paper: where they stay joined, and which arcs are of one circle.

use super::onto_paper;
use crate::curve::fit::{self, Options, Polyline};
use crate::math::DVec2;
use crate::parallel;
use crate::sorting::CompactSort;
use crate::target::drawing::{Line, LineClass};
use crate::target::{Curve, CurvePiece, EllipticArc};

/// Lines that end this near to a chord, as a part of the tolerance, end on it.
const MEETS: f64 = 0.1;

/// Returns the curve for each line, in millimetres on paper, if it is not the polyline that it was; all of it within
/// `tolerance` millimetres.
///
/// Points that lines share, and ends, stay points of both to the bit.
pub(super) fn curves(
    lines: &[&Line],
    origin: DVec2,
    factor: f64,
    tolerance: f64,
) -> Vec<Option<Curve>> {
    let shared = Shared::new(lines, origin, factor, tolerance * MEETS);
    let one = |line: &Line| {
        if line.points.len() < LEAST || !is_fitted(line.class) {
            return None;
        }
        let points: Vec<DVec2> =
            line.points.iter().map(|p| onto_paper(*p, origin, factor)).collect();
        let kept: Vec<bool> = line.points.iter().map(|p| shared.has(*p)).collect();
        let polyline = Polyline { points: &points, closed: line.closed, kept: &kept };
        let options = Options { tolerance, round: is_round(line.class) };
        let fitted = fit::fit(polyline, |a, b| shared.meets(a, b), options)?;
        (!is_as_it_was(&fitted.curve, points.len())).then_some(fitted.curve)
    };
    let mut curves = parallel::map(lines.to_vec(), one);
    unite(&mut curves, tolerance);
    curves
}

/// Returns whether a curve is no better than the polyline of this many points that it was fitted
/// to.
pub(super) fn is_as_it_was(curve: &Curve, points: usize) -> bool {
    let pieces = curve.pieces.len();
    curve.is_straight() && (pieces + 1 >= points || pieces < 3)
}

/// Shorter polylines are left as they are.
const LEAST: usize = 5;

/// Returns whether curves are fitted to lines of a class; lines of meshes, hatching and axes are straight.
fn is_fitted(class: LineClass) -> bool {
    use LineClass::{Axis, Break, Hatch, Stipple, Wire};
    !matches!(class, Wire | Hatch | Stipple | Axis | Break)
}

/// Returns whether the class's lines come from faces, which may approximate round surfaces.
fn is_round(class: LineClass) -> bool {
    !matches!(class, LineClass::Grid | LineClass::Mark)
}

/// The points common to several lines, and the ends of lines that end elsewhere.
struct Shared {
    /// Points on the plane, sorted.
    points: Vec<[u64; 2]>,
    /// Ends on paper, sorted by x.
    ends: Vec<DVec2>,
    /// Millimetres.
    near: f64,
}

/// Returns a point by its bits; zeros are one.
pub(super) fn key(p: DVec2) -> [u64; 2] {
    [p.x + 0.0, p.y + 0.0].map(f64::to_bits)
}

impl Shared {
    fn new(lines: &[&Line], origin: DVec2, factor: f64, near: f64) -> Self {
        let lines =
            || lines.iter().filter(|l| !matches!(l.class, LineClass::Hatch | LineClass::Stipple));
        let mut all: Vec<[u64; 2]> =
            lines().flat_map(|l| l.points.iter().map(|p| key(*p))).collect();
        all.sort_unstable();
        let points: Vec<[u64; 2]> =
            all.chunk_by(|a, b| a == b).filter(|same| same.len() > 1).map(|same| same[0]).collect();
        let open = lines().filter(|l| !l.closed);
        let tips = open.flat_map(|l| [l.points.first(), l.points.last()].into_iter().flatten());
        let lone = tips.filter(|p| points.binary_search(&key(**p)).is_err());
        let mut ends: Vec<DVec2> = lone.map(|p| onto_paper(*p, origin, factor)).collect();
        ends.compact_sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        Self { points, ends, near }
    }

    fn has(&self, p: DVec2) -> bool {
        self.points.binary_search(&key(p)).is_ok()
    }

    /// Returns whether a line ends on a chord, other than in its ends.
    fn meets(&self, a: DVec2, b: DVec2) -> bool {
        let (left, right) = (a.x.min(b.x) - self.near, a.x.max(b.x) + self.near);
        let first = self.ends.partition_point(|p| p.x < left);
        let along = b - a;
        let on = |p: &DVec2| {
            let t = (*p - a).dot(along) / along.length_squared();
            *p != a && *p != b && (0.0..=1.0).contains(&t) && p.distance(a + along * t) <= self.near
        };
        self.ends[first..].iter().take_while(|p| p.x <= right).any(on)
    }
}

/// Moves arcs of one circle or ellipse, of any lines, to the same centre and axes: those of the longest arc. Arcs whose
/// ends would be detached from their neighbours stay.
fn unite(curves: &mut [Option<Curve>], tolerance: f64) {
    let mut arcs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, curve) in curves.iter().enumerate() {
        let pieces = curve.iter().flat_map(|c| c.pieces.iter().enumerate());
        arcs.extend(pieces.filter_map(|(k, piece)| match piece {
            CurvePiece::Arc(arc, _) => Some((arc.turn.abs(), i, k)),
            _ => None,
        }));
    }
    arcs.compact_sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut leaders = Leaders::new(tolerance);
    for (_, i, k) in arcs {
        let Some(curve) = curves.get_mut(i).and_then(Option::as_mut) else { continue };
        let start = k.checked_sub(1).map_or(curve.start, |before| curve.pieces[before].end());
        if let CurvePiece::Arc(arc, end) = &mut curve.pieces[k] {
            match leaders.like(arc, start, *end) {
                Some(united) => *arc = united,
                None => leaders.add(*arc),
            }
        }
    }
}

/// Arcs that others may be parts of, by the grid cells of their centres.
struct Leaders {
    cells: std::collections::BTreeMap<[i64; 2], Vec<EllipticArc>>,
    tolerance: f64,
}

/// Arcs with more others in a cell are left as they are.
const MOST_IN_CELL: usize = 32;

impl Leaders {
    fn new(tolerance: f64) -> Self {
        Self { cells: std::collections::BTreeMap::new(), tolerance }
    }

    fn cell(&self, center: DVec2) -> [i64; 2] {
        // A cast saturates.
        (center / (self.tolerance * 2.0)).floor().to_array().map(|v| v as i64)
    }

    fn add(&mut self, arc: EllipticArc) {
        let cell = self.cells.entry(self.cell(arc.center)).or_default();
        if cell.len() < MOST_IN_CELL {
            cell.push(arc);
        }
    }

    /// Returns the arc as a part of one known already.
    fn like(&self, arc: &EllipticArc, start: DVec2, end: DVec2) -> Option<EllipticArc> {
        let [x, y] = self.cell(arc.center);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |k| (i, k)));
        let cells =
            around.filter_map(|(i, k)| self.cells.get(&[x.saturating_add(i), y.saturating_add(k)]));
        cells.flatten().find_map(|leader| fit::part_of(leader, arc, start, end, self.tolerance))
    }
}
