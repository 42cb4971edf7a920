//! The nesting of rings: the tree of shells, their holes, the islands in these, and so on.

use std::cmp::Ordering;

use super::{Shapes, Vertex};
use crate::clip::status::Status;
use crate::math::Orientation;

/// The rings of valid [`Shapes`] as a tree: the parent of a hole is the outer ring of its polygon,
/// the parent of an outer ring is the hole that it lies in.
///
/// Rings are named by their index, as [`Shapes::ring`] takes it. Rings may touch at vertices.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct NestingTree {
    parents: Vec<Option<usize>>,
    depths: Vec<usize>,
    /// The children of ring i are `children[starts[i]..starts[i + 1]]`.
    starts: Vec<usize>,
    children: Vec<usize>,
    roots: Vec<usize>,
}

impl NestingTree {
    /// Finds the tree by a sweep over all edges, which finds the edge below the first point of each ring.
    ///
    /// It is correct if the shapes are valid, like results of [`overlay()`](super::overlay()); for others it is an
    /// arbitrary tree. O(n log n) time and O(n) memory for n points. All decisions are exact.
    ///
    /// ```
    /// use durer::clip::polygon::{NestingTree, Shapes};
    /// use durer::math::DVec2;
    ///
    /// let square = |r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(DVec2::from);
    /// let mut shapes = Shapes::new();
    /// shapes.push_ring(square(3.0));
    /// shapes.push_ring(square(2.0).into_iter().rev());
    /// shapes.end_polygon();
    /// shapes.push_ring(square(1.0));
    /// shapes.end_polygon();
    /// let tree = NestingTree::of(&shapes);
    /// assert_eq!(tree.parent(2), Some(1), "the island lies in the hole");
    /// ```
    pub fn of<P: Vertex>(shapes: &Shapes<P>) -> Self {
        let mut sweep = Sweep::new(shapes);
        for polygon in shapes.polygons() {
            let rings = polygon.ring_indices();
            sweep.outers[rings.clone()].fill(rings.start);
        }
        sweep.run();
        Self::from_parents(sweep.parents.into_iter().map(Place::ring).collect(), &sweep.order)
    }

    /// Returns for each ring the one directly around it, of any polygon; correct if no edges cross or overlap and each
    /// ring has an area. Same cost.
    pub(super) fn rings_around<P: Vertex>(shapes: &Shapes<P>) -> Vec<Option<usize>> {
        let mut sweep = Sweep::new(shapes);
        sweep.by_sides = true;
        sweep.run();
        sweep.parents.into_iter().map(Place::ring).collect()
    }

    /// Creates the tree; `order` names every ring that has a parent, and that parent before it.
    fn from_parents(parents: Vec<Option<usize>>, order: &[usize]) -> Self {
        let mut depths = vec![0; parents.len()];
        let mut starts = vec![0; parents.len() + 1];
        for &ring in order {
            depths[ring] = parents[ring].map_or(0, |parent| depths[parent] + 1);
        }
        for parent in parents.iter().flatten() {
            starts[parent + 1] += 1;
        }
        for i in 0..parents.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut children = vec![0; starts.last().copied().unwrap_or(0)];
        let mut roots = Vec::new();
        for (ring, parent) in parents.iter().enumerate() {
            match *parent {
                Some(parent) => {
                    children[next[parent]] = ring;
                    next[parent] += 1;
                }
                None => roots.push(ring),
            }
        }
        Self { parents, depths, starts, children, roots }
    }

    /// Returns the number of rings.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Returns whether there is no ring.
    pub fn is_empty(&self) -> bool {
        self.parents.is_empty()
    }

    /// Returns the rings that lie in no other, in the order of their indices.
    pub fn roots(&self) -> &[usize] {
        &self.roots
    }

    /// Returns the ring directly around a ring; `None` for roots and if there is no such ring.
    pub fn parent(&self, ring: usize) -> Option<usize> {
        self.parents.get(ring).copied().flatten()
    }

    /// Returns the rings directly in a ring, in the order of their indices.
    pub fn children(&self, ring: usize) -> &[usize] {
        match (self.starts.get(ring), self.starts.get(ring.saturating_add(1))) {
            (Some(&start), Some(&end)) => &self.children[start..end],
            _ => &[],
        }
    }

    /// Returns the number of rings around a ring: 0 for roots, odd for holes.
    pub fn depth(&self, ring: usize) -> usize {
        self.depths.get(ring).copied().unwrap_or(0)
    }

    /// Returns whether a ring is a hole.
    pub fn is_hole(&self, ring: usize) -> bool {
        self.depth(ring) % 2 == 1
    }
}

/// Knowledge about the parent of a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Unknown,
    Root,
    In(usize),
}

impl Place {
    fn ring(self) -> Option<usize> {
        match self {
            Self::In(ring) => Some(ring),
            Self::Unknown | Self::Root => None,
        }
    }
}

/// An edge of a ring, from its smaller to its larger point.
#[derive(Debug, Clone, Copy)]
struct Edge<P> {
    a: P,
    b: P,
    ring: usize,
}

impl<P: Vertex> Edge<P> {
    /// Returns whether it passes above another one, where one line of the sweep cuts both and they
    /// do not cross; upright edges count as leaning to the right.
    fn is_above(&self, other: &Self) -> bool {
        let side = |of: &Self, from: &Self| match P::turn(from.a, from.b, of.a) {
            Orientation::Collinear => P::turn(from.a, from.b, of.b),
            side => side,
        };
        if self.a.order(other.a).is_lt() {
            side(other, self) == Orientation::Clockwise
        } else {
            side(self, other) == Orientation::CounterClockwise
        }
    }
}

struct Sweep<P> {
    edges: Vec<Edge<P>>,
    /// True for each edge along which its ring runs from the smaller to the larger point.
    forward: Vec<bool>,
    /// Outer ring of each ring's polygon; itself for outer rings.
    outers: Vec<usize>,
    /// True if the edges' directions, not the rules of valid polygons, determine the side that is inside.
    by_sides: bool,
    parents: Vec<Place>,
    /// The lower of the two edges at the first point of each outer ring, once the sweep met it.
    lowest: Vec<Option<usize>>,
    /// The rings in the order in which their parents were found.
    order: Vec<usize>,
}

impl<P: Vertex> Sweep<P> {
    fn new(shapes: &Shapes<P>) -> Self {
        let count = shapes.ring_count();
        let mut edges = Vec::with_capacity(shapes.points().len());
        let mut forward = Vec::with_capacity(shapes.points().len());
        for (ring, points) in shapes.rings().enumerate() {
            for (&p, i) in points.iter().zip(1..) {
                let q = points[if i < points.len() { i } else { 0 }];
                let order = p.order(q);
                match order {
                    Ordering::Less => edges.push(Edge { a: p, b: q, ring }),
                    Ordering::Greater => edges.push(Edge { a: q, b: p, ring }),
                    Ordering::Equal => continue,
                }
                forward.push(order.is_lt());
            }
        }
        Self {
            edges,
            forward,
            outers: (0..count).collect(),
            by_sides: false,
            parents: vec![Place::Unknown; count],
            lowest: vec![None; count],
            order: Vec::new(),
        }
    }

    fn run(&mut self) {
        let mut starts: Vec<usize> = (0..self.edges.len()).collect();
        let mut ends = starts.clone();
        starts.sort_unstable_by(|&i, &j| self.edges[i].a.order(self.edges[j].a).then(i.cmp(&j)));
        ends.sort_unstable_by(|&i, &j| self.edges[i].b.order(self.edges[j].b).then(i.cmp(&j)));
        let mut ends = ends.into_iter().peekable();
        let mut status = Status::new(self.edges.len());
        let alike = |i: &usize, j: &usize| self.edges[*i].a.order(self.edges[*j].a).is_eq();
        let groups: Vec<&[usize]> = starts.chunk_by(alike).collect();
        for group in groups {
            let at = self.edges[group[0]].a;
            while let Some(i) = ends.next_if(|&i| self.edges[i].b.order(at).is_le()) {
                status.remove(i);
            }
            for &i in group {
                status.insert(i, |other| self.edges[i].is_above(&self.edges[other]));
            }
            // A ring comes here for the first time, with its two edges in one group.
            let new = |i: &usize| self.lowest[self.edges[*i].ring].is_none();
            let firsts: Vec<usize> = group.iter().copied().filter(new).collect();
            for &i in &firsts {
                let lowest = &mut self.lowest[self.edges[i].ring];
                match *lowest {
                    Some(j) if !self.edges[j].is_above(&self.edges[i]) => {}
                    _ => *lowest = Some(i),
                }
            }
            for &i in &firsts {
                self.resolve(self.edges[i].ring, &status);
            }
        }
    }

    /// Finds the parent of a ring, and of the rings below it that start at the same point.
    fn resolve(&mut self, ring: usize, status: &Status) {
        let mut chain = Vec::new();
        let mut at = ring;
        while self.parents[at] == Place::Unknown {
            // Marked, so that invalid polygons do not cause an endless loop.
            self.parents[at] = Place::Root;
            let below = self.lowest[at].and_then(|edge| status.below(edge));
            chain.push((at, below));
            let Some(edge) = below else { break };
            at = self.edges[edge].ring;
        }
        for (ring, below) in chain.into_iter().rev() {
            let place = below.map_or(Place::Root, |edge| self.above(edge));
            let outer = self.outers[ring];
            self.parents[ring] = if outer == ring { place } else { Place::In(outer) };
            self.order.push(ring);
        }
    }

    /// Returns the place of a ring that starts just above an edge: of valid polygons an outer ring.
    fn above(&self, edge: usize) -> Place {
        let ring = self.edges[edge].ring;
        let is_inside = match self.lowest[ring] {
            // Just above the lower edge at its first point is the inside of a ring.
            Some(lowest) if self.by_sides => self.forward[edge] == self.forward[lowest],
            _ => self.outers[ring] != ring,
        };
        if is_inside { Place::In(ring) } else { self.parents[ring] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DVec2, I64Vec2};

    fn square(x: i64, y: i64, size: i64) -> [I64Vec2; 4] {
        [(0, 0), (size, 0), (size, size), (0, size)].map(|(u, v)| I64Vec2::new(x + u, y + v))
    }

    /// Returns polygons, each a shell with its holes.
    fn shapes(polygons: &[&[[I64Vec2; 4]]]) -> Shapes<I64Vec2> {
        let mut shapes = Shapes::new();
        for polygon in polygons {
            polygon.iter().for_each(|ring| shapes.push_ring(*ring));
            shapes.end_polygon();
        }
        shapes
    }

    #[test]
    fn islands_that_touch_their_hole_at_its_first_point_lie_in_it() {
        // A diamond's left corner on the hole's left corner; another on the shell from outside.
        let diamond =
            |x: i64, r: i64, h: i64| [(x - r, 0), (x, -h), (x + r, 0), (x, h)].map(I64Vec2::from);
        let shell: [_; 2] = [diamond(0, 8, 8), diamond(0, 6, 6)];
        let nested = shapes(&[&shell, &[diamond(-2, 4, 2)], &[diamond(12, 4, 4)]]);
        let tree = NestingTree::of(&nested);
        assert_eq!([0, 1, 2, 3].map(|r| tree.parent(r)), [None, Some(0), Some(1), None]);
        assert_eq!([0, 1, 2, 3].map(|r| tree.depth(r)), [0, 1, 2, 0]);
        assert_eq!((tree.roots(), tree.children(1)), (&[0, 3][..], &[2][..]));
    }

    #[test]
    fn rings_that_start_at_one_point_find_each_other_in_any_order() {
        let point = |x, y| I64Vec2::new(x, y);
        // Three thin triangles fan out from one point within a hole, listed from top to bottom.
        let fan = |y: i64| [point(2, 2), point(9, y), point(9, y + 1), point(9, y + 1)];
        let nested =
            shapes(&[&[fan(6)], &[fan(4)], &[fan(2)], &[square(0, 0, 12), square(1, 1, 10)]]);
        let tree = NestingTree::of(&nested);
        assert_eq!([0, 1, 2].map(|r| tree.parent(r)), [Some(4); 3]);
        assert_eq!(tree.children(4), [0, 1, 2]);
    }

    #[test]
    fn what_is_not_valid_gives_some_tree() {
        let far = f64::MAX;
        let mut bad = Shapes::new();
        let ring = |p: [(f64, f64); 4]| p.map(DVec2::from);
        bad.push_ring(ring([(0.0, 0.0), (far, -far), (-far, far), (f64::NAN, 1.0)]));
        bad.push_ring(ring([(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)]));
        bad.end_polygon();
        bad.push_ring([]);
        bad.end_polygon();
        bad.push_ring(ring([(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)]));
        let tree = NestingTree::of(&bad);
        assert_eq!((tree.len(), tree.children(usize::MAX), tree.parent(9)), (4, &[][..], None));
    }
}
