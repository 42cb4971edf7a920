//! Outlines that cross themselves: their detection and the region that they enclose.

use super::Budget;
use durer::clip::polygon::overlay::{self, EdgeId, Origin};
use durer::clip::polygon::{BooleanOp, Shapes, WindingRule};
use durer::curve::Contours;
use durer::math::{DVec2, Orientation, orient2d};
use durer::raster::triangulate;
use durer::trace::NoTrace;
use std::collections::HashMap;

/// Outlines of more crossings per corner are noise, and would take memory without end.
const CROSSINGS_PER_CORNER: usize = 4;

/// Returns the number of pairs of edges that cross properly, each through the inside of the other;
/// `None` if the budget is used up, or there are too many.
pub(super) fn count(points: &[DVec2], budget: &mut Budget) -> Option<usize> {
    let n = points.len();
    let edge = |i: usize| [points[i], points[(i + 1) % n]];
    let left = |i: &usize| edge(*i).map(|p| p.x).into_iter().fold(f64::INFINITY, f64::min);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| left(a).total_cmp(&left(b)));
    let mut found = 0;
    for (k, &i) in order.iter().enumerate() {
        let [a, b] = edge(i);
        let right = a.x.max(b.x);
        for &j in order.iter().skip(k + 1).take_while(|j| left(j) <= right) {
            budget.spend(1)?;
            found += usize::from(cross([a, b], edge(j)));
        }
        if found > CROSSINGS_PER_CORNER * n {
            return None;
        }
    }
    Some(found)
}

fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    if a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y) {
        return false;
    }
    let apart = |p, q, r, s| {
        let sides = [orient2d(p, q, r), orient2d(p, q, s)];
        !sides.contains(&Orientation::Collinear) && sides[0] != sides[1]
    };
    apart(a, b, c, d) && apart(c, d, a, b)
}

/// A corner of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Corner {
    /// One of the outline, by number.
    Old(usize),
    /// One of [`Resolved::crossings`], by number.
    New(usize),
}

/// A point on two edges: the numbers of the corners at their ends, and its position along each.
pub(super) type Crossing = [([usize; 2], f64); 2];

/// The points that an outline winds around, as triangles that run counter-clockwise.
#[derive(Debug, Default)]
pub(super) struct Resolved {
    pub crossings: Vec<Crossing>,
    pub triangles: Vec<[Corner; 3]>,
    /// Crossings by the edges that cross: regions that touch there have it in common.
    numbers: HashMap<[[usize; 2]; 2], usize>,
}

/// Finds the region that an outline encloses by the non-zero rule. `None` if this cannot be decided.
pub(super) fn resolve(points: &[DVec2], budget: &mut Budget) -> Option<Resolved> {
    budget.spend(100 * points.len())?;
    let outline = Shapes::from_rings([points]);
    let rule = overlay::Options::with_rule(WindingRule::NonZero);
    let options = overlay::Options { origins: true, drop_collinear: true, ..rule };
    let union = BooleanOp::Union;
    let out = overlay::overlay(&outline, &Shapes::new(), union, &options, &mut NoTrace).ok()?;
    let mut resolved = Resolved::default();
    let corners: Vec<Corner> = out.origins.iter().map(|origin| resolved.corner(origin)).collect();
    for polygon in out.shapes.polygons() {
        let mut contours = Contours::new();
        polygon.rings().for_each(|ring| contours.push(ring.iter().copied(), true));
        let first = out.shapes.ring_range(polygon.ring_indices().start).start;
        let cut = triangulate::triangulate(&contours, &mut NoTrace);
        for triangle in &cut.triangles {
            let triangle = counter_clockwise(triangle.map(|i| i as usize), &cut.points)?;
            let corner = |i: usize| corners.get(first + i).copied();
            let [Some(a), Some(b), Some(c)] = triangle.map(corner) else { return None };
            resolved.triangles.push([a, b, c]);
        }
    }
    Some(resolved)
}

fn counter_clockwise([a, b, c]: [usize; 3], points: &[DVec2]) -> Option<[usize; 3]> {
    let turn = orient2d(*points.get(a)?, *points.get(b)?, *points.get(c)?);
    Some(if turn == Orientation::Clockwise { [a, c, b] } else { [a, b, c] })
}

impl Resolved {
    /// Returns the corner that a point of the overlay is; crossings are kept.
    fn corner(&mut self, origin: &Origin) -> Corner {
        let along = |(edge, t): (EdgeId, f64)| ([edge.from, edge.to], t);
        match *origin {
            Origin::Vertex { index, .. } => Corner::Old(index),
            Origin::Crossing { first, second } => {
                let crossing = [along(first), along(second)];
                let mut edges = crossing.map(|(edge, _)| edge);
                edges.sort_unstable();
                let number = *self.numbers.entry(edges).or_insert(self.crossings.len());
                if number == self.crossings.len() {
                    self.crossings.push(crossing);
                }
                Corner::New(number)
            }
        }
    }
}
