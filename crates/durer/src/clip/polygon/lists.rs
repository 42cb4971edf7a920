//! Cyclic lists of the vertices of rings, with links from crossings to their twins in the other list.

use super::Shapes;
use crate::Error;
use crate::math::DVec2;

/// A vertex of a cyclic list.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub at: DVec2,
    pub next: usize,
    pub previous: usize,
    /// Crossing with the other border: the same point in the other list.
    pub twin: Option<usize>,
    /// True at a crossing where the list enters the other's inside.
    pub enters: bool,
}

/// A ring of a list.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    /// Its first vertex.
    pub vertex: usize,
    /// True if the edge from there, before a crossing at its end, is inside the other.
    pub inside: bool,
}

/// The rings of one operand as lists.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub vertices: Vec<Vertex>,
    pub starts: Vec<Start>,
}

impl Lists {
    /// Makes the lists of rings, without crossings.
    pub fn new(rings: &Shapes) -> Self {
        let mut lists = Self::default();
        for ring in rings.rings() {
            let vertex = lists.vertices.len();
            lists.starts.push(Start { vertex, inside: false });
            for (i, &at) in ring.iter().enumerate() {
                let next = vertex + (i + 1) % ring.len();
                let previous = vertex + (i + ring.len() - 1) % ring.len();
                lists.vertices.push(Vertex { at, next, previous, twin: None, enters: false });
            }
        }
        lists
    }

    /// Returns the vertices of the ring of a vertex, once around from it.
    pub fn ring(&self, start: usize) -> impl Iterator<Item = usize> + '_ {
        let follow = move |&v: &usize| Some(self.vertices[v].next).filter(|&next| next != start);
        std::iter::successors(Some(start), follow)
    }

    /// Returns the points before and after a vertex of the list.
    pub fn neighbours(&self, v: usize) -> [DVec2; 2] {
        [self.vertices[v].previous, self.vertices[v].next].map(|v| self.vertices[v].at)
    }

    /// Returns the edge that starts at a vertex.
    pub fn edge(&self, v: usize) -> [DVec2; 2] {
        [self.vertices[v].at, self.vertices[self.vertices[v].next].at]
    }

    /// Returns all edges, by the vertices where they start.
    pub fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        (0..self.vertices.len()).map(|v| self.edge(v))
    }

    /// Returns the last of the vertices that stand for one common point, from the first.
    pub fn leaves(&self, mut v: usize) -> usize {
        while self.vertices[self.vertices[v].next].at == self.vertices[v].at {
            v = self.vertices[v].next;
        }
        v
    }

    /// Makes crossings enter and leave in turn along each ring, as its start is outside or inside.
    pub fn alternate(&mut self) {
        for i in 0..self.starts.len() {
            let Start { vertex, mut inside } = self.starts[i];
            let ring: Vec<usize> = self.ring(vertex).collect();
            for v in ring {
                if self.vertices[v].twin.is_some() {
                    inside = !inside;
                    self.vertices[v].enters = inside;
                }
            }
        }
    }

    /// Puts a vertex after another one.
    pub fn insert(&mut self, after: usize, at: DVec2) -> usize {
        let (index, next) = (self.vertices.len(), self.vertices[after].next);
        self.vertices.push(Vertex { at, next, previous: after, twin: None, enters: false });
        self.vertices[after].next = index;
        self.vertices[next].previous = index;
        index
    }
}

/// Links the vertices of a crossing; `enters` is true if the subject enters.
pub(super) fn join(lists: &mut [Lists; 2], [s, c]: [usize; 2], enters: bool) {
    let vertex = &mut lists[0].vertices[s];
    (vertex.twin, vertex.enters) = (Some(c), enters);
    let vertex = &mut lists[1].vertices[c];
    (vertex.twin, vertex.enters) = (Some(s), !enters);
}

/// The refusal of rings of one operand that cross or overlap.
pub(super) const NOT_SIMPLE: Error = Error::Unsupported {
    what: "a polygon whose rings cross or overlap by this algorithm",
    instead: "choose overlay or vatti",
};

/// The refusal of rings that cross themselves and touch the other operand.
pub(super) const CROSSING_AND_TOUCHING: Error = Error::Unsupported {
    what: "a polygon whose rings cross or overlap, and of which a vertex or edge touches the other \
           polygon, by this algorithm",
    instead: "choose overlay or vatti",
};
