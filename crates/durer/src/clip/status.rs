//! The edges or segments that a sweep line cuts, from below to above, in a balanced tree.
//!
//! A treap (C. R. Aragon, R. G. Seidel, *Randomized search trees*, 1989) whose priorities are hashes
//! of the edges' numbers, so that it is the same for the same input.

const NONE: usize = usize::MAX;

#[derive(Debug, Clone, Copy)]
struct Node {
    parent: usize,
    /// The next ones below and above.
    children: [usize; 2],
}

/// The edges that a sweep line cuts, from below to above.
#[derive(Debug)]
pub struct Status {
    /// One for each edge, on the sweep line or not.
    nodes: Vec<Node>,
    root: usize,
}

impl Status {
    /// Creates the status of `edges` edges, none of them on the line.
    pub fn new(edges: usize) -> Self {
        Self { nodes: vec![Node { parent: NONE, children: [NONE; 2] }; edges], root: NONE }
    }

    /// Inserts an edge that is not on the line; `is_above` returns whether it is above another one.
    pub fn insert(&mut self, edge: usize, mut is_above: impl FnMut(usize) -> bool) {
        let (mut parent, mut side, mut at) = (NONE, 0, self.root);
        while at != NONE {
            (parent, side) = (at, usize::from(is_above(at)));
            at = self.nodes[at].children[side];
        }
        self.nodes[edge] = Node { parent, children: [NONE; 2] };
        match self.nodes.get_mut(parent) {
            Some(node) => node.children[side] = edge,
            None => self.root = edge,
        }
        while let parent @ 0..NONE = self.nodes[edge].parent {
            if priority(parent) >= priority(edge) {
                break;
            }
            self.rise(edge);
        }
    }

    /// Removes an edge that is on the line.
    pub fn remove(&mut self, edge: usize) {
        loop {
            let child = match self.nodes[edge].children {
                [NONE, NONE] => break,
                [child, NONE] | [NONE, child] => child,
                [low, high] if priority(low) > priority(high) => low,
                [_, high] => high,
            };
            self.rise(child);
        }
        self.replace(self.nodes[edge].parent, edge, NONE);
    }

    /// Returns the edge next below one that is on the line.
    pub fn below(&self, edge: usize) -> Option<usize> {
        self.next(edge, 0)
    }

    /// Returns the edge next above one that is on the line.
    pub fn above(&self, edge: usize) -> Option<usize> {
        self.next(edge, 1)
    }

    /// Returns the lowest edge of which a predicate is true that is false for all below it and true for all above it.
    pub fn first(&self, mut is_late: impl FnMut(usize) -> bool) -> Option<usize> {
        let (mut found, mut at) = (None, self.root);
        while at != NONE {
            let late = is_late(at);
            found = if late { Some(at) } else { found };
            at = self.nodes[at].children[usize::from(!late)];
        }
        found
    }

    /// Returns the highest edge on the line.
    pub fn last(&self) -> Option<usize> {
        let (mut found, mut at) = (None, self.root);
        while at != NONE {
            found = Some(at);
            at = self.nodes[at].children[1];
        }
        found
    }

    /// Returns the edge next to one that is on the line: below it for side 0, above it for side 1.
    fn next(&self, edge: usize, side: usize) -> Option<usize> {
        let mut at = self.nodes[edge].children[side];
        if at != NONE {
            while self.nodes[at].children[1 - side] != NONE {
                at = self.nodes[at].children[1 - side];
            }
            return Some(at);
        }
        at = edge;
        loop {
            let parent = self.nodes[at].parent;
            let node = self.nodes.get(parent)?;
            if node.children[1 - side] == at {
                return Some(parent);
            }
            at = parent;
        }
    }

    /// Exchanges an edge with its parent, so that their order stays.
    fn rise(&mut self, edge: usize) {
        let parent = self.nodes[edge].parent;
        let side = usize::from(self.nodes[parent].children[1] == edge);
        let inner = self.nodes[edge].children[1 - side];
        let above = self.nodes[parent].parent;
        self.nodes[parent].children[side] = inner;
        if let Some(node) = self.nodes.get_mut(inner) {
            node.parent = parent;
        }
        self.nodes[edge].children[1 - side] = parent;
        self.nodes[parent].parent = edge;
        self.nodes[edge].parent = above;
        self.replace(above, parent, edge);
    }

    fn replace(&mut self, parent: usize, old: usize, new: usize) {
        match self.nodes.get_mut(parent) {
            Some(node) => node.children[usize::from(node.children[1] == old)] = new,
            None => self.root = new,
        }
    }
}

/// Returns bits that look random (S. Vigna's finalizer of splitmix64).
fn priority(edge: usize) -> u64 {
    let mut z = (edge as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
