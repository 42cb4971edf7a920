//! The nesting of rings whose edges are apart.

use super::{Fault, Flaw};
use crate::clip::polygon::rectangle::Prepared;
use crate::clip::polygon::{NestingTree, Shapes};
use crate::math::{DVec2, Rect};
use std::cell::OnceCell;

/// Average number of rings that overlap a ring in x above which there are too many pairs.
const CROWD: usize = if cfg!(test) { 2 } else { 512 };

/// Returns whether holes lie in their outer rings, not in one another, and polygons not in one
/// another; the edges are apart.
pub fn nests(shapes: &Shapes) -> bool {
    if shapes.ring_count() == 1 {
        return true;
    }
    let rings = rings_of(shapes);
    if is_crowded(&rings) {
        return alternates(shapes);
    }
    let mut nests = true;
    each_misplaced_of(&rings, |_| {
        nests = false;
        false
    });
    nests
}

/// Calls `visit` for each misplaced ring, as long as it returns true; the edges do not meet. O(n log n) if no ring is
/// misplaced, otherwise O(n + k) for k pairs of rings of which one's box contains the other's.
pub fn each_misplaced(shapes: &Shapes, visit: impl FnMut(Flaw) -> bool) {
    let rings = rings_of(shapes);
    if !is_crowded(&rings) || !alternates(shapes) {
        each_misplaced_of(&rings, visit);
    }
}

/// Returns whether each hole is directly inside its outer ring, and each outer ring directly inside a hole or nothing:
/// then the rings around a ring are pairs of a hole and its outer ring, and no ring is misplaced.
fn alternates(shapes: &Shapes) -> bool {
    let around = NestingTree::rings_around(shapes);
    let mut is_hole = vec![true; around.len()];
    for polygon in shapes.polygons() {
        is_hole[polygon.ring_indices()].iter_mut().take(1).for_each(|hole| *hole = false);
    }
    shapes.polygons().all(|polygon| {
        let mut rings = polygon.ring_indices();
        let outer = rings.start;
        rings.all(|ring| match around[ring] {
            None => ring == outer,
            Some(around) if ring == outer => is_hole[around],
            Some(around) => around == outer,
        })
    })
}

/// Returns whether there are too many pairs of rings of which one may be in the other.
fn is_crowded(rings: &[Ring<'_>]) -> bool {
    let mut left = rings.len().saturating_mul(CROWD);
    let mut is_crowded = false;
    each_beside(rings, |_, beside| {
        let rest = left.checked_sub(beside.len());
        is_crowded = rest.is_none();
        left = rest.unwrap_or_default();
        !is_crowded
    });
    is_crowded
}

fn rings_of(shapes: &Shapes) -> Vec<Ring<'_>> {
    let numbers = shapes.polygons().map(|polygon| polygon.ring_indices()).enumerate();
    numbers
        .flat_map(|(polygon, all)| all.clone().map(move |ring| (polygon, all.start, ring)))
        .filter_map(|(polygon, outer, index)| {
            let points = shapes.ring(index);
            let around = Rect::around(points.iter().copied())?;
            let prepared = OnceCell::new();
            Some(Ring { points, around, polygon, outer, index, prepared })
        })
        .collect()
}

fn each_misplaced_of(rings: &[Ring<'_>], mut visit: impl FnMut(Flaw) -> bool) {
    let mut at_home = vec![false; rings.len()];
    let mut within = Vec::new();
    let mut go_on = true;
    each_within(rings, |inner, outer| {
        let (a, b) = (&rings[inner], &rings[outer]);
        match (a.polygon == b.polygon, (a.is_hole(), b.is_hole())) {
            (true, (true, false)) => at_home[inner] = a.lies_in(b),
            (true, (true, true)) if a.lies_in(b) => {
                go_on = visit(a.flaw(Fault::HoleInHole, b.index))
            }
            (false, (false, _)) if a.lies_in(b) => within.push((inner, b.polygon)),
            _ => {}
        }
        go_on
    });
    // In another polygon's ring and hole: in its hole.
    within.sort_unstable();
    let inside = within.chunk_by(|a, b| a == b).filter(|rings| rings.len() % 2 == 1);
    let inside = inside.filter_map(|rings_of| rings_of.first()).map(|&(inner, polygon)| {
        let around = rings.iter().find(|r| r.polygon == polygon).map_or(0, |r| r.outer);
        rings[inner].flaw(Fault::PolygonInPolygon, around)
    });
    let homeless = rings.iter().zip(at_home).filter(|(ring, home)| ring.is_hole() && !home);
    let homeless = homeless.map(|(ring, _)| ring.flaw(Fault::HoleOutside, ring.outer));
    for flaw in inside.chain(homeless) {
        go_on = go_on && visit(flaw);
    }
}

struct Ring<'a> {
    points: &'a [DVec2],
    around: Rect,
    polygon: usize,
    /// The outer ring of its polygon.
    outer: usize,
    index: usize,
    prepared: OnceCell<Option<Prepared>>,
}

impl Ring<'_> {
    fn is_hole(&self) -> bool {
        self.index != self.outer
    }

    fn flaw(&self, fault: Fault, other: usize) -> Flaw {
        let at = self.points.first().copied().unwrap_or_default();
        Flaw { fault, at, rings: [self.index.min(other), self.index.max(other)] }
    }

    /// Returns whether it lies in another, which it may touch, by a vertex, or else the middle of an
    /// edge, that is not on its border.
    fn lies_in(&self, outer: &Self) -> bool {
        let prepare = || Prepared::new(Shapes::from_rings([outer.points])).ok();
        let Some(outer) = outer.prepared.get_or_init(prepare) else { return false };
        let inner = self.points;
        let ends = inner.iter().zip(inner.iter().cycle().skip(1));
        let middles = ends.map(|(&a, &b)| a * 0.5 + b * 0.5);
        let free = inner.iter().copied().chain(middles).find(|&p| !outer.has_on_border(p));
        free.is_some_and(|p| outer.contains(p))
    }
}

/// Calls `f` for each pair of rings of which one's box contains the other's, as long as it returns true; the rings are
/// visited in the order of their left ends.
fn each_within(rings: &[Ring<'_>], mut f: impl FnMut(usize, usize) -> bool) {
    let holds = |i: usize, j: usize| {
        let (outer, inner) = (&rings[i].around, &rings[j].around);
        outer.contains(inner.min()) && outer.contains(inner.max())
    };
    each_beside(rings, |next, beside| {
        beside.iter().all(|&other| {
            (!holds(other, next) || f(next, other)) && (!holds(next, other) || f(other, next))
        })
    });
}

/// Calls `f` for each ring, in the order of their left ends, with the rings before it that overlap it in x, as long as
/// it returns true.
fn each_beside(rings: &[Ring<'_>], mut f: impl FnMut(usize, &[usize]) -> bool) {
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by(|&i, &j| rings[i].around.min().x.total_cmp(&rings[j].around.min().x));
    let mut active: Vec<usize> = Vec::new();
    for next in order {
        active.retain(|&i| rings[i].around.max().x >= rings[next].around.min().x);
        if !f(next, &active) {
            return;
        }
        active.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns nested squares, each a polygon with or without a square hole; `odd` is moved out of line.
    fn squares(count: i32, odd: Option<i32>) -> Shapes {
        let ring = |left: i32, right: i32| {
            [(left, left), (right, left), (right, right), (left, right)]
                .map(|(x, y)| DVec2::new(x.into(), y.into()))
        };
        let mut shapes = Shapes::new();
        for i in 0..count {
            let (low, high) = (4 * i, 1000 - 4 * i);
            let moved = if odd == Some(i) { 5 } else { 1 };
            shapes.push_ring(ring(low, high));
            let mut hole = ring(low + moved, high - moved).to_vec();
            hole.rotate_left(i as usize % 4);
            if i % 2 == 0 {
                hole.reverse();
            }
            shapes.push_ring(hole);
            shapes.end_polygon();
        }
        shapes
    }

    #[test]
    fn many_rings_in_one_another_are_reported_as_few_are() {
        for (shapes, right) in [(squares(100, None), true), (squares(100, Some(60)), false)] {
            let rings = rings_of(&shapes);
            assert!(is_crowded(&rings));
            let mut count = 0;
            each_misplaced_of(&rings, |_| {
                count += 1;
                true
            });
            assert_eq!((count == 0, alternates(&shapes), nests(&shapes)), (right, right, right));
        }
        assert!(!is_crowded(&rings_of(&squares(2, None))));
    }
}
