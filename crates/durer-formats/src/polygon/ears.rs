//! Ear clipping that keeps corners on straight borders, and takes outlines that touch themselves.

use super::Budget;
use durer::math::{DVec2, Orientation, orient2d, orient2d_value};
use std::collections::VecDeque;

/// Ears that are thinner than this part of their length are cut when there are no others.
const THIN: f64 = 1e-6;

/// Preference among corners to cut: good ones first, then any.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Taste {
    /// No slivers.
    Good,
    /// Slivers too.
    Any,
    /// Also where the cut runs through a point at which the outline touches it.
    Touching,
}

/// Cuts a polygon that runs counter-clockwise into triangles of its corners' numbers, which run so too.
///
/// Returns whether they are all of it: not where the outline crosses itself. `None` if the budget is
/// used up.
pub(super) fn cut(
    points: &[DVec2],
    budget: &mut Budget,
    triangles: &mut Vec<[u32; 3]>,
) -> Option<bool> {
    let mut ring = Ring::new(points);
    let mut queue = Queue::of(points.len());
    let mut taste = Taste::Good;
    while ring.left > 2 {
        budget.spend(1)?;
        let Some(at) = queue.pop() else {
            taste = match taste {
                Taste::Good => Taste::Any,
                Taste::Any => Taste::Touching,
                Taste::Touching => return Some(ring.has_no_area()),
            };
            ring.corners().for_each(|i| queue.push(i));
            continue;
        };
        if !ring.there[at] {
            continue;
        }
        if !ring.is_nothing(at) {
            match ring.ear(at, taste, budget)? {
                Ear::Whole => triangles.push(ring.around(at).map(|i| i as u32)),
                Ear::Blocked(by) => {
                    queue.waiting[by].push(at);
                    continue;
                }
                Ear::No => continue,
            }
        }
        let [before, _, after] = ring.around(at);
        ring.remove(at);
        queue.free(at);
        for i in [ring.prev[before], before, after, ring.next[after]] {
            queue.push(i);
            if !ring.blunt[i] {
                queue.free(i);
            }
        }
    }
    Some(true)
}

/// State of a corner.
enum Ear {
    /// It can be cut off.
    Whole,
    /// It could be if it were not for another corner.
    Blocked(usize),
    No,
}

/// Corners to examine, again whenever something near them changes.
struct Queue {
    corners: VecDeque<usize>,
    queued: Vec<bool>,
    /// Per corner, the corners whose ears it blocks.
    waiting: Vec<Vec<usize>>,
}

impl Queue {
    /// Returns all of n corners.
    fn of(n: usize) -> Self {
        Self { corners: (0..n).collect(), queued: vec![true; n], waiting: vec![Vec::new(); n] }
    }

    fn push(&mut self, i: usize) {
        if !std::mem::replace(&mut self.queued[i], true) {
            self.corners.push_back(i);
        }
    }

    fn pop(&mut self) -> Option<usize> {
        let i = self.corners.pop_front()?;
        self.queued[i] = false;
        Some(i)
    }

    /// Queues all corners whose ears a corner blocked.
    fn free(&mut self, other: usize) {
        std::mem::take(&mut self.waiting[other]).into_iter().for_each(|i| self.push(i));
    }
}

/// Rest of the outline: corners by number, each with its neighbours.
struct Ring<'a> {
    points: &'a [DVec2],
    next: Vec<usize>,
    prev: Vec<usize>,
    left: usize,
    there: Vec<bool>,
    /// Remaining corners that do not turn left: only these can block ears.
    blunt: Vec<bool>,
    cells: Cells,
}

impl<'a> Ring<'a> {
    fn new(points: &'a [DVec2]) -> Self {
        let n = points.len();
        let next: Vec<usize> = (1..n).chain([0]).collect();
        let prev: Vec<usize> = (n - 1..n).chain(0..n - 1).collect();
        let (there, blunt, cells) = (vec![true; n], Vec::new(), Cells::default());
        let mut ring = Self { points, next, prev, left: n, there, blunt, cells };
        ring.blunt = (0..n).map(|i| !ring.turns_left(i)).collect();
        let blunt: Vec<usize> = (0..n).filter(|&i| ring.blunt[i]).collect();
        ring.cells = Cells::new(points, blunt);
        ring
    }

    /// Returns the corners that are left.
    fn corners(&self) -> impl Iterator<Item = usize> {
        (0..self.points.len()).filter(|&i| self.there[i])
    }

    fn turn(&self, corners: [usize; 3]) -> Orientation {
        let [a, b, c] = corners.map(|i| self.points[i]);
        orient2d(a, b, c)
    }

    fn around(&self, i: usize) -> [usize; 3] {
        [self.prev[i], i, self.next[i]]
    }

    fn turns_left(&self, i: usize) -> bool {
        self.turn(self.around(i)) == Orientation::CounterClockwise
    }

    /// Takes a corner out; its own links stay.
    fn remove(&mut self, i: usize) {
        let (before, after) = (self.prev[i], self.next[i]);
        (self.next[before], self.prev[after]) = (after, before);
        self.left -= 1;
        (self.there[i], self.blunt[i]) = (false, false);
        for neighbour in [before, after] {
            if self.blunt[neighbour] {
                self.blunt[neighbour] = !self.turns_left(neighbour);
            }
        }
    }

    /// Returns whether a corner coincides with the one before it, or is the tip of a spike.
    fn is_nothing(&self, i: usize) -> bool {
        let [a, b, c] = self.around(i).map(|i| self.points[i]);
        a == b || (orient2d(a, b, c) == Orientation::Collinear && (a - b).dot(c - b) > 0.0)
    }

    fn ear(&self, i: usize, taste: Taste, budget: &mut Budget) -> Option<Ear> {
        let corners @ [a, b, c] = self.around(i);
        if !self.turns_left(i) || (taste == Taste::Good && is_thin(corners.map(|i| self.points[i])))
        {
            return Some(Ear::No);
        }
        let right = |corners| self.turn(corners) == Orientation::Clockwise;
        let (before, after) = (self.prev[a], self.next[c]);
        let leaves_a = self.turns_left(a) && right([before, a, c]);
        let leaves_c = self.turns_left(c) && right([a, c, after]);
        if leaves_a || leaves_c {
            return Some(Ear::No);
        }
        let ends = [a, b, c].map(|i| self.points[i]);
        for &q in self.cells.near(ends) {
            budget.spend(1)?;
            if self.blunt[q as usize] && self.is_in_the_way(q as usize, corners, taste) {
                return Some(Ear::Blocked(q as usize));
            }
        }
        Some(Ear::Whole)
    }

    /// Returns whether the outline enters a triangle at corner q.
    fn is_in_the_way(&self, q: usize, corners: [usize; 3], taste: Taste) -> bool {
        let point = self.points[q];
        if corners.iter().any(|&i| i == q || self.points[i] == point) {
            return false;
        }
        let [a, b, c] = corners;
        let enters = |from: usize, to: usize| {
            let inside = |r| self.turn([from, to, r]) == Orientation::CounterClockwise;
            inside(self.prev[q]) || inside(self.next[q])
        };
        let mut in_the_way = true;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            match self.turn([from, to, q]) {
                Orientation::Clockwise => return false,
                Orientation::Collinear => {
                    let is_cut = from == c && taste < Taste::Touching;
                    in_the_way = is_cut || enters(from, to);
                }
                Orientation::CounterClockwise => {}
            }
        }
        in_the_way
    }

    /// Returns whether the rest has no area up to rounding errors.
    fn has_no_area(&self) -> bool {
        let Some(origin) = self.corners().next().map(|i| self.points[i]) else { return true };
        let from = |i: usize| self.points[i] - origin;
        let area: f64 = self.corners().map(|i| from(i).perp_dot(from(self.next[i]))).sum();
        let size = self.corners().map(|i| from(i).length_squared()).fold(0.0, f64::max);
        area.abs() <= 1e-14 * size
    }
}

fn is_thin([a, b, c]: [DVec2; 3]) -> bool {
    let longest =
        [a - b, b - c, c - a].map(|edge| edge.length_squared()).into_iter().fold(0.0, f64::max);
    orient2d_value(a, b, c) < THIN * longest
}

/// Corners by their cells of a grid.
#[derive(Default)]
struct Cells {
    low: DVec2,
    /// Cells per unit.
    scale: DVec2,
    side: usize,
    /// Start of each cell's corners, row by row.
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Cells {
    /// Creates cells for about one corner each.
    fn new(points: &[DVec2], mut chosen: Vec<usize>) -> Self {
        let at = || chosen.iter().map(|&i| points[i]);
        let low = at().fold(DVec2::INFINITY, DVec2::min);
        let size = at().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
        let side = (chosen.len().isqrt()).clamp(1, 1024);
        let per_unit = |size: f64| if size > 0.0 { side as f64 / size } else { 0.0 };
        let scale = DVec2::new(per_unit(size.x), per_unit(size.y));
        let mut cells = Self { low, scale, side, ..Self::default() };
        chosen.sort_by_cached_key(|&i| cells.cell(points[i]));
        let mut starts = vec![0; side * side + 1];
        for &i in &chosen {
            starts[cells.cell(points[i]) + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        cells.starts = starts;
        cells.corners = chosen.into_iter().map(|i| i as u32).collect();
        cells
    }

    /// Returns the column and row, clamped to the grid.
    fn place(&self, p: DVec2) -> [usize; 2] {
        ((p - self.low) * self.scale).to_array().map(|v| (v as usize).min(self.side - 1))
    }

    fn cell(&self, p: DVec2) -> usize {
        let [column, row] = self.place(p);
        row * self.side + column
    }

    /// Returns the corners of all cells that the box around a triangle touches.
    fn near(&self, triangle: [DVec2; 3]) -> impl Iterator<Item = &u32> {
        let [a, b, c] = triangle;
        let [left, bottom] = self.place(a.min(b).min(c));
        let [right, top] = self.place(a.max(b).max(c));
        (bottom..=top).flat_map(move |row| {
            let start = |column: usize| self.starts[row * self.side + column] as usize;
            &self.corners[start(left)..start(right + 1)]
        })
    }
}
