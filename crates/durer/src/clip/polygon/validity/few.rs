//! The test of few edges, each with each: the boxes of all fit into the first-level cache, and comparing them takes less
//! time than sorting the edges.

use crate::clip::exact::side;
use crate::clip::polygon::Shapes;
use crate::math::DVec2;
use std::cmp::Ordering;

/// Number of points up to which all pairs of edges are compared. The comparisons grow with its square: from about a hundred
/// points on, sorting is faster.
pub const FEW: usize = 64;

/// Boxes that are compared at a time.
const LANES: usize = 4;

/// Edges in the order of the points, each from a point to the next of its ring.
struct Edges {
    count: usize,
    ends: [[DVec2; 2]; FEW],
    /// Index of the edge that follows on the ring.
    next: [u8; FEW],
    /// Smallest and largest x, smallest and largest y; NaN beyond the last edge, so that no box meets those there.
    boxes: [[[f64; LANES]; 4]; FEW / LANES],
}

/// Returns whether no two edges have a point in common but the one in which one follows the other, no edge is a point, and
/// all rings have three points or more. There are at most [`FEW`] points.
pub fn are_apart(shapes: &Shapes) -> bool {
    let Some(edges) = Edges::new(shapes) else { return false };
    (0..edges.count).all(|i| edges.leaves(i) && edges.keeps_off(i))
}

impl Edges {
    /// Returns the edges; `None` for a ring of fewer than three points, or an edge without length.
    fn new(shapes: &Shapes) -> Option<Self> {
        let mut edges = Self {
            count: 0,
            ends: [[DVec2::ZERO; 2]; FEW],
            next: [0; FEW],
            boxes: [[[f64::NAN; LANES]; 4]; FEW / LANES],
        };
        for ring in shapes.rings() {
            let first = edges.count;
            let (&start, 3..) = (ring.first()?, ring.len()) else { return None };
            for (k, &a) in ring.iter().enumerate() {
                let next = if k + 1 < ring.len() { first + k + 1 } else { first };
                let b = ring.get(k + 1).copied().unwrap_or(start);
                edges.push(a, b, next)?;
            }
        }
        Some(edges)
    }

    fn push(&mut self, a: DVec2, b: DVec2, next: usize) -> Option<()> {
        let i = self.count;
        *self.ends.get_mut(i)? = [a, b];
        self.next[i] = next as u8;
        let (low, high) = (a.min(b), a.max(b));
        for (side, value) in [low.x, high.x, low.y, high.y].into_iter().enumerate() {
            self.boxes[i / LANES][side][i % LANES] = value;
        }
        self.count += 1;
        (a != b).then_some(())
    }

    /// Returns whether the next edge does not run back along an edge.
    fn leaves(&self, i: usize) -> bool {
        let ([a, b], [_, c]) = (self.ends[i], self.ends[usize::from(self.next[i])]);
        let axis = usize::from((b.y - a.y).abs() > (b.x - a.x).abs());
        side(a, b, c) != Ordering::Equal || (a[axis] < b[axis]) == (b[axis] < c[axis])
    }

    /// Returns whether no later edge, but the neighbours on the ring, has a point in common with an edge.
    fn keeps_off(&self, i: usize) -> bool {
        let [a, b] = self.ends[i];
        let (low, high) = (a.min(b), a.max(b));
        (i / LANES..self.count.div_ceil(LANES)).all(|chunk| {
            let [low_x, high_x, low_y, high_y] = &self.boxes[chunk];
            let near: [bool; LANES] = std::array::from_fn(|k| {
                (low_x[k] <= high.x)
                    & (high_x[k] >= low.x)
                    & (low_y[k] <= high.y)
                    & (high_y[k] >= low.y)
            });
            !near.contains(&true)
                || (0..LANES).filter(|&k| near[k]).all(|k| {
                    let j = chunk * LANES + k;
                    j <= i || self.are_neighbours(i, j) || !meet(self.ends[i], self.ends[j])
                })
        })
    }

    fn are_neighbours(&self, i: usize, j: usize) -> bool {
        usize::from(self.next[i]) == j || usize::from(self.next[j]) == i
    }
}

/// Returns whether two edges whose boxes overlap have a point in common.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = |s: Ordering, t: Ordering| s == t && s != Ordering::Equal;
    // On one line, their boxes overlap only if they do.
    !apart(side(a, b, c), side(a, b, d)) && !apart(side(c, d, a), side(c, d, b))
}
