//! Points by place: a tree that halves them along alternating axes, from which points can be removed (Bentley, *K-d
//! trees for semidynamic point sets*, 1990).

use crate::math::DVec2;

/// Points in a leaf.
const LEAF: usize = 8;

/// Points with their numbers.
pub struct Tree {
    /// Sorted so that each half of a range, recursively, is on one side of its middle.
    points: Vec<(DVec2, u32)>,
    /// Number of remaining points, by node; the children of node n are 2n and 2n + 1.
    left: Vec<u32>,
    /// Position of each number's point.
    place: Vec<u32>,
}

/// A node, the range of its points, and the axis that divides it.
#[derive(Clone, Copy)]
struct Node {
    id: usize,
    from: usize,
    to: usize,
    along_x: bool,
}

impl Node {
    fn is_leaf(self) -> bool {
        self.to - self.from <= LEAF
    }

    fn middle(self) -> usize {
        usize::midpoint(self.from, self.to)
    }

    fn halves(self) -> [Self; 2] {
        let (id, along_x, middle) = (self.id * 2, !self.along_x, self.middle());
        [
            Self { id, to: middle, along_x, ..self },
            Self { id: id + 1, from: middle, along_x, ..self },
        ]
    }

    fn key(self, p: DVec2) -> f64 {
        if self.along_x { p.x } else { p.y }
    }
}

impl Tree {
    /// Creates the tree of finite points, which are numbered as they come.
    pub fn new(points: impl Iterator<Item = DVec2>) -> Self {
        let points: Vec<(DVec2, u32)> = points.zip(0..).collect();
        let nodes = 4 * (points.len() / LEAF + 1).next_power_of_two();
        let place = vec![0; points.len()];
        let mut tree = Self { points, left: vec![0; nodes], place };
        tree.sort(tree.root());
        for (i, (_, number)) in tree.points.iter().enumerate() {
            tree.place[*number as usize] = i as u32;
        }
        tree
    }

    fn root(&self) -> Node {
        Node { id: 1, from: 0, to: self.points.len(), along_x: true }
    }

    /// Sorts the points of a node; the recursion is as deep as the logarithm of the number of points.
    fn sort(&mut self, node: Node) {
        self.left[node.id] = (node.to - node.from) as u32;
        if node.is_leaf() {
            return;
        }
        let order = |a: &(DVec2, u32), b: &(DVec2, u32)| {
            node.key(a.0).total_cmp(&node.key(b.0)).then(a.1.cmp(&b.1))
        };
        let middle = node.middle() - node.from;
        self.points[node.from..node.to].select_nth_unstable_by(middle, order);
        node.halves().into_iter().for_each(|half| self.sort(half));
    }

    /// Removes a point that is in it.
    pub fn remove(&mut self, number: u32) {
        let place = self.place[number as usize] as usize;
        let mut node = self.root();
        loop {
            self.left[node.id] -= 1;
            if node.is_leaf() {
                self.points[place].1 = u32::MAX;
                return;
            }
            let [low, high] = node.halves();
            node = if place < node.middle() { low } else { high };
        }
    }

    /// Finds the nearest points that `wanted` accepts, limited by the room in `found`: squared distances and numbers,
    /// the nearest first; equally near ones by their numbers if all have room.
    pub fn nearest(&self, to: DVec2, found: &mut Nearest, wanted: impl Fn(u32) -> bool) {
        found.list.clear();
        self.search(self.root(), to, found, &wanted);
    }

    fn search(&self, node: Node, to: DVec2, found: &mut Nearest, wanted: &impl Fn(u32) -> bool) {
        if self.left[node.id] == 0 {
            return;
        }
        if node.is_leaf() {
            for &(p, number) in &self.points[node.from..node.to] {
                if number != u32::MAX && wanted(number) {
                    found.add((p.distance_squared(to), number));
                }
            }
            return;
        }
        let beyond = node.key(to) - node.key(self.points[node.middle()].0);
        let [low, high] = node.halves();
        let (near, far) = if beyond < 0.0 { (low, high) } else { (high, low) };
        self.search(near, to, found, wanted);
        if found.has_room_at(beyond * beyond) {
            self.search(far, to, found, wanted);
        }
    }
}

/// A list of the nearest points found so far.
pub struct Nearest {
    /// Squared distances and numbers, sorted.
    pub list: Vec<(f64, u32)>,
    most: usize,
}

impl Nearest {
    /// Creates an empty list with room for `most` points.
    pub fn new(most: usize) -> Self {
        Self { list: Vec::with_capacity(most + 1), most }
    }

    fn has_room_at(&self, distance: f64) -> bool {
        self.list.len() < self.most || self.list.last().is_some_and(|last| distance < last.0)
    }

    fn add(&mut self, one: (f64, u32)) {
        if self.list.len() < self.most || self.list.last().is_some_and(|last| one < *last) {
            let at = self.list.partition_point(|other| *other < one);
            self.list.insert(at, one);
            self.list.truncate(self.most);
        }
    }
}
