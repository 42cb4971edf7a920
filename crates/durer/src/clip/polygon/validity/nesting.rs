//! The nesting of rings whose edges are apart.

use super::{Fault, Flaw};
use crate::clip::polygon::Shapes;
use crate::clip::polygon::rectangle::Prepared;
use crate::math::{DVec2, Rect};
use std::cell::OnceCell;

/// Returns whether holes lie in their outer rings, not in one another, and polygons not in one
/// another; the edges are apart.
pub fn nests(shapes: &Shapes) -> bool {
    let mut nests = true;
    each_misplaced(shapes, |_| {
        nests = false;
        false
    });
    nests
}

/// Calls for each ring that lies where it must not, as long as the answer is yes; the edges are apart.
pub fn each_misplaced(shapes: &Shapes, mut tell: impl FnMut(Flaw) -> bool) {
    let numbers = shapes.polygons().map(|polygon| polygon.ring_indices()).enumerate();
    let rings: Vec<Ring<'_>> = numbers
        .flat_map(|(polygon, all)| all.clone().map(move |ring| (polygon, all.start, ring)))
        .filter_map(|(polygon, outer, index)| {
            let points = shapes.ring(index);
            let around = Rect::around(points.iter().copied())?;
            let prepared = OnceCell::new();
            Some(Ring { points, around, polygon, outer, index, prepared })
        })
        .collect();
    let mut at_home = vec![false; rings.len()];
    let mut within = Vec::new();
    let mut go_on = true;
    each_within(&rings, |inner, outer| {
        let (a, b) = (&rings[inner], &rings[outer]);
        match (a.polygon == b.polygon, (a.is_hole(), b.is_hole())) {
            (true, (true, false)) => at_home[inner] = a.lies_in(b),
            (true, (true, true)) if a.lies_in(b) => {
                go_on = tell(a.flaw(Fault::HoleInHole, b.index))
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
        go_on = go_on && tell(flaw);
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

/// Calls for each ring and each other one whose box holds its box, as long as the answer is yes: in the
/// order of their left ends, each with those that it may lie in or around.
fn each_within(rings: &[Ring<'_>], mut f: impl FnMut(usize, usize) -> bool) {
    let mut order: Vec<usize> = (0..rings.len()).collect();
    order.sort_by(|&i, &j| rings[i].around.min().x.total_cmp(&rings[j].around.min().x));
    let holds = |i: usize, j: usize| {
        let (outer, inner) = (&rings[i].around, &rings[j].around);
        outer.contains(inner.min()) && outer.contains(inner.max())
    };
    let mut active: Vec<usize> = Vec::new();
    for next in order {
        active.retain(|&i| rings[i].around.max().x >= rings[next].around.min().x);
        for &other in &active {
            let go_on =
                (!holds(other, next) || f(next, other)) && (!holds(next, other) || f(other, next));
            if !go_on {
                return;
            }
        }
        active.push(next);
    }
}
