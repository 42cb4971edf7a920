//! From the edges that bound the result to simple rings, and from rings to polygons.

use super::arrangement::{Arrangement, Half, NONE, Patch, Winding};
use super::lattice::{Coord, Point, cross};
use super::parallel;
use super::search::Search;

/// Which way an edge bounds the result, whose inside is on its left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Course {
    No,
    Up,
    Down,
}

/// Simple rings of nodes, grouped into polygons; canonical, whatever order the input had.
#[derive(Debug, Default)]
pub struct Rings {
    /// Ring after ring, each starting with its smallest node.
    pub nodes: Vec<u32>,
    pub ring_ends: Vec<u32>,
    /// Which rings, in their order: of each polygon the outer ring, then its holes.
    pub order: Vec<u32>,
    /// Where each polygon ends in `order`.
    pub polygon_ends: Vec<u32>,
}

impl Rings {
    /// The nodes of a ring.
    pub fn ring(&self, index: u32) -> &[u32] {
        let index = index as usize;
        let start = if index == 0 { 0 } else { self.ring_ends[index - 1] };
        &self.nodes[start as usize..self.ring_ends[index] as usize]
    }
}

/// A closed walk along the border of one connected piece of the result.
#[derive(Debug)]
struct Walk {
    first: u32,
    rings: std::ops::Range<u32>,
    outer: Option<u32>,
}

struct Linker<'a, 'b, C> {
    graph: &'a Arrangement<'b, C>,
    courses: Vec<Course>,
    /// The edge that follows an edge on the result's border.
    next: Vec<u32>,
    /// The walk that an edge belongs to.
    walk_of: Vec<u32>,
    walks: Vec<Walk>,
    rings: Rings,
}

/// Links the edges where `inside` differs between the two sides.
#[inline(never)]
pub fn link<C: Coord>(
    graph: &Arrangement<C>,
    search: &Search<C>,
    inside: impl Fn(Winding) -> bool + Sync,
) -> Rings {
    let mut linker = Linker {
        graph,
        courses: courses(graph, inside),
        next: Vec::new(),
        walk_of: Vec::new(),
        walks: Vec::new(),
        rings: Rings::default(),
    };
    linker.pair();
    linker.trace();
    linker.nest(search);
    linker.rings
}

#[inline(never)]
fn courses<C: Coord>(
    graph: &Arrangement<C>,
    inside: impl Fn(Winding) -> bool + Sync,
) -> Vec<Course> {
    let mut courses = vec![Course::No; graph.edges.len()];
    let tasks = parallel::cut(&mut courses, &graph.edge_ends()).into_iter().zip(&graph.patches);
    parallel::map(tasks.collect(), |(courses, patch): (&mut [Course], &Patch)| {
        for (course, e) in courses.iter_mut().zip(patch.edges.clone()) {
            *course = match (inside(graph.left(e)), inside(graph.right[e])) {
                (true, false) => Course::Up,
                (false, true) => Course::Down,
                _ => Course::No,
            };
        }
    });
    courses
}

impl<C: Coord> Linker<'_, '_, C> {
    /// At each node, an edge that arrives goes on with the edge that leaves on the other side of
    /// the piece of inside to its left, so that pieces that only touch stay apart.
    #[inline(never)]
    fn pair(&mut self) {
        let mut next = vec![NONE; self.graph.edges.len()];
        let tasks = parallel::cut(&mut next, &self.graph.edge_ends()).into_iter();
        let tasks = tasks.zip(&self.graph.patches).collect();
        let elsewhere = parallel::map(tasks, |(next, patch): (&mut [u32], &Patch)| {
            let mut elsewhere = Vec::new();
            for node in patch.nodes.clone() {
                self.pair_around(node as u32, |e, before| match patch.has_edge(e) {
                    true => next[e - patch.edges.start] = before,
                    false => elsewhere.push((e, before)),
                });
            }
            elsewhere
        });
        for (e, before) in elsewhere.into_iter().flatten() {
            next[e] = before;
        }
        self.next = next;
    }

    #[inline(always)]
    fn pair_around(&self, node: u32, mut f: impl FnMut(usize, u32)) {
        // The one before in the sense of the clock; around the first one, that is the last.
        let on = |half: &&Half| self.courses[half.edge()] != Course::No;
        let around = self.graph.around(node);
        let Some(&last) = around.iter().rev().find(on) else { return };
        let mut before = last;
        for &half in around.iter().filter(on) {
            if self.arrives(half) {
                f(half.edge(), before.edge() as u32);
            }
            before = half;
        }
    }

    /// Whether the border runs against a half-edge that leaves a node.
    fn arrives(&self, half: Half) -> bool {
        let arriving = if half.is_back() { Course::Up } else { Course::Down };
        self.courses[half.edge()] == arriving
    }

    /// Walks along the border of every piece and cuts each walk into simple rings where it comes
    /// back to a node: first the walks that stay within a patch, then the others.
    #[inline(never)]
    fn trace(&mut self) {
        let mut walk_of = vec![NONE; self.graph.edges.len()];
        let tasks = parallel::cut(&mut walk_of, &self.graph.edge_ends()).into_iter();
        let tasks = tasks.zip(&self.graph.patches).collect();
        let mut traces = parallel::map(tasks, |(walk_of, patch): (&mut [u32], &Patch)| {
            let trace = Trace {
                linker: &*self,
                patch,
                walk_of,
                position: Vec::new(),
                found: Found::default(),
            };
            trace.run()
        });
        let counts = parallel::ends(traces.iter().map(|trace| trace.walks.len()));
        let tasks = parallel::cut(&mut walk_of, &self.graph.edge_ends()).into_iter().enumerate();
        parallel::map(tasks.collect(), |(k, walk_of): (usize, &mut [u32])| {
            let first = parallel::range(&counts, k).start as u32;
            walk_of.iter_mut().filter(|walk| **walk < LEFT).for_each(|walk| *walk += first);
        });
        if traces.iter().any(|trace| trace.has_left) {
            walk_of.iter_mut().filter(|walk| **walk == LEFT).for_each(|walk| *walk = NONE);
            let all = Patch { nodes: 0..self.graph.nodes.len(), edges: 0..self.graph.edges.len() };
            let first = counts.last().copied().unwrap_or(0);
            let found = Found { first_walk: first, ..Found::default() };
            let walk_of = &mut walk_of[..];
            let trace = Trace { linker: &*self, patch: &all, walk_of, position: Vec::new(), found };
            traces.push(trace.run());
        }
        self.walk_of = walk_of;
        self.collect(&traces);
    }

    fn collect(&mut self, traces: &[Found]) {
        let lists = |f: fn(&Found) -> &[u32]| traces.iter().map(f).collect::<Vec<_>>();
        self.rings.nodes = parallel::concat(&lists(|trace| &trace.nodes));
        let (mut nodes, mut rings) = (0, 0);
        for trace in traces {
            self.rings.ring_ends.extend(trace.ring_ends.iter().map(|end| nodes + end));
            self.walks.extend(trace.walks.iter().map(|walk| Walk {
                first: walk.first,
                rings: rings + walk.rings.start..rings + walk.rings.end,
                outer: walk.outer.map(|outer| rings + outer),
            }));
            nodes += trace.nodes.len() as u32;
            rings += trace.ring_ends.len() as u32;
        }
    }

    /// Whether more than one ring passes the node: then it stays, so that the touch is a vertex.
    fn touched(&self, node: u32) -> bool {
        let on = |half: &&Half| self.courses[half.edge()] != Course::No;
        self.graph.around(node).iter().filter(on).count() > 2
    }

    /// Gives every walk without an outer ring to the piece it is a hole of: that of the edge below
    /// its first node. Such walks that start further left are done before.
    #[inline(never)]
    fn nest(&mut self, search: &Search<C>) {
        let nodes = self.graph.nodes;
        // The outer ring of each walk's polygon, and of each ring.
        let mut outer_of: Vec<u32> = self.walks.iter().map(|w| w.outer.unwrap_or(NONE)).collect();
        let mut holes: Vec<(Point<C>, u32)> = (self.walks.iter().zip(0..))
            .filter(|(walk, _)| walk.outer.is_none() && walk.first != NONE)
            .map(|(walk, id)| (nodes[walk.first as usize], id))
            .collect();
        holes.sort_unstable();
        let on = |e: usize| self.courses[e] != Course::No;
        let below =
            parallel::map(holes.chunks(SEARCHES).collect(), |some: &[(Point<C>, u32)]| {
                let first = |id: u32| self.walks[id as usize].first;
                some.iter()
                    .map(|&(_, id)| search.below(self.graph, first(id), on))
                    .collect::<Vec<_>>()
            });
        for ((_, id), below) in holes.into_iter().zip(below.into_iter().flatten()) {
            let walk = below.map_or(NONE, |half| self.walk_of[half.edge()]);
            outer_of[id as usize] = outer_of.get(walk as usize).copied().unwrap_or(NONE);
        }
        let mut owners = vec![NONE; self.rings.ring_ends.len()];
        for (walk, outer) in self.walks.iter().zip(outer_of) {
            owners[walk.rings.start as usize..walk.rings.end as usize].fill(outer);
        }
        self.sort(&owners);
    }

    /// Puts polygons in the order of their outer rings' points, and the holes of each likewise.
    #[inline(never)]
    fn sort(&mut self, owners: &[u32]) {
        let nodes = self.graph.nodes;
        let rings = &self.rings;
        let points = |r: u32| rings.ring(r).iter().map(|&n| nodes[n as usize]);
        let first = |r: u32| points(r).next().unwrap_or_default();
        // The first points differ, but for rings that touch there.
        let compare = |a: &(Point<C>, u32), b: &(Point<C>, u32)| {
            a.0.cmp(&b.0).then_with(|| points(a.1).cmp(points(b.1)))
        };
        let all = 0..rings.ring_ends.len() as u32;
        let of = |keeps: &dyn Fn(u32) -> bool| -> Vec<(Point<C>, u32)> {
            all.clone().filter(|&r| keeps(r)).map(|r| (first(r), r)).collect()
        };
        let mut outers = of(&|r| owners[r as usize] == r);
        let mut holes = of(&|r| owners[r as usize] != r && owners[r as usize] != NONE);
        parallel::sort(&mut outers, compare);
        let mut rank = vec![NONE; owners.len()];
        for (&(_, outer), i) in outers.iter().zip(0..) {
            rank[outer as usize] = i;
        }
        let rank_of = |hole: u32| rank[owners[hole as usize] as usize];
        parallel::sort(&mut holes, |a, b| {
            rank_of(a.1).cmp(&rank_of(b.1)).then_with(|| compare(a, b))
        });
        let mut holes = holes.into_iter().map(|(_, hole)| hole).peekable();
        let (mut order, mut ends) =
            (Vec::with_capacity(owners.len()), Vec::with_capacity(outers.len()));
        for (&(_, outer), i) in outers.iter().zip(0..) {
            order.push(outer);
            while let Some(hole) = holes.next_if(|&h| rank_of(h) == i) {
                order.push(hole);
            }
            ends.push(order.len() as u32);
        }
        (self.rings.order, self.rings.polygon_ends) = (order, ends);
    }
}

/// How many searches one task does.
const SEARCHES: usize = if cfg!(test) { 2 } else { 64 };

/// Marks an edge whose walk does not stay within the patch.
const LEFT: u32 = NONE - 1;

/// What was found in a patch: rings, their ends, and walks.
#[derive(Debug, Default)]
struct Found {
    nodes: Vec<u32>,
    ring_ends: Vec<u32>,
    walks: Vec<Walk>,
    /// The name of the first walk.
    first_walk: u32,
    /// Whether some walks were left.
    has_left: bool,
}

/// The walks through one patch.
struct Trace<'a, 'b, 'c, C> {
    linker: &'a Linker<'b, 'c, C>,
    patch: &'a Patch,
    /// Of the patch's edges.
    walk_of: &'a mut [u32],
    /// Of the patch's nodes that are on the path, one more than their place on it.
    position: Vec<u32>,
    found: Found,
}

impl<C: Coord> Trace<'_, '_, '_, C> {
    fn run(mut self) -> Found {
        self.position = vec![0; self.patch.nodes.len()];
        let mut path: Vec<u32> = Vec::new();
        for start in self.patch.edges.clone() {
            let walk = self.walk_of[start - self.patch.edges.start];
            if self.linker.courses[start] != Course::No && walk == NONE {
                self.walk(start as u32, &mut path);
            }
        }
        self.found
    }

    fn walk(&mut self, start: u32, path: &mut Vec<u32>) {
        let Linker { graph, courses, next, .. } = self.linker;
        let first_ring = self.found.ring_ends.len() as u32;
        let first_node = self.found.nodes.len();
        let id = self.found.first_walk + self.found.walks.len() as u32;
        let mut walk = Walk { first: NONE, rings: first_ring..first_ring, outer: None };
        let mut edge = start;
        path.clear();
        loop {
            let up = courses[edge as usize] == Course::Up;
            let inside = self.patch.has_edge(edge as usize);
            let ends = &graph.edges[edge as usize];
            let node = if up { ends.low } else { ends.high };
            let place = (edge as usize).wrapping_sub(self.patch.edges.start);
            let known = self.walk_of.get(place).is_some_and(|&walk| walk == LEFT);
            if !inside || known || !self.patch.has_node(node) {
                return self.leave(start, path, (first_ring, first_node));
            }
            let at = self.position[node as usize - self.patch.nodes.start];
            if at != 0 {
                self.close(&path[at as usize - 1..], &mut walk);
                path.truncate(at as usize - 1);
            }
            if self.walk_of[place] != NONE {
                break;
            }
            path.push(node);
            self.position[node as usize - self.patch.nodes.start] = path.len() as u32;
            let inner = graph.inner(edge as usize).iter();
            if up {
                path.extend(inner)
            } else {
                path.extend(inner.rev())
            }
            self.walk_of[place] = id;
            edge = next[edge as usize];
        }
        walk.rings.end = self.found.ring_ends.len() as u32;
        self.found.walks.push(walk);
    }

    /// Takes back what was found on a walk that leaves the patch.
    fn leave(&mut self, start: u32, path: &[u32], (rings, nodes): (u32, usize)) {
        self.found.has_left = true;
        self.found.ring_ends.truncate(rings as usize);
        self.found.nodes.truncate(nodes);
        for &node in path.iter().filter(|&&node| self.patch.has_node(node)) {
            self.position[node as usize - self.patch.nodes.start] = 0;
        }
        let mut edge = start;
        loop {
            let place = (edge as usize).wrapping_sub(self.patch.edges.start);
            match self.walk_of.get_mut(place) {
                Some(walk) if *walk != LEFT && *walk != NONE => *walk = LEFT,
                _ => {
                    // The edge that leaves is not to be tried again either.
                    if let Some(walk) = self.walk_of.get_mut(place) {
                        *walk = LEFT;
                    }
                    return;
                }
            }
            edge = self.linker.next[edge as usize];
        }
    }

    /// Stores a simple ring, from its smallest node on, without nodes on straight edges.
    fn close(&mut self, path: &[u32], walk: &mut Walk) {
        let nodes = self.linker.graph.nodes;
        let point = |n: u32| nodes[n as usize];
        let mut smallest = 0;
        for (i, &n) in path.iter().enumerate() {
            if self.patch.has_node(n) {
                self.position[n as usize - self.patch.nodes.start] = 0;
            }
            if point(n) < point(path[smallest]) {
                smallest = i;
            }
        }
        let first = path[smallest];
        if walk.first == NONE || point(first) < point(walk.first) {
            walk.first = first;
        }
        let (tail, head) = path.split_at(smallest);
        let mut before = *tail.last().or(path.last()).unwrap_or(&first);
        let after = *path.get(smallest + 1).or(path.first()).unwrap_or(&first);
        // The smallest node is a corner, and the turn there tells the orientation.
        if cross(point(before), point(first), point(after)) > C::Wide::default() {
            walk.outer = Some(self.found.ring_ends.len() as u32);
        }
        let mut at = first;
        for &after in head[1..].iter().chain(tail).chain([&first]) {
            let straight = cross(point(before), point(at), point(after)) == C::Wide::default();
            if !straight || self.linker.touched(at) {
                self.found.nodes.push(at);
            }
            (before, at) = (at, after);
        }
        self.found.ring_ends.push(self.found.nodes.len() as u32);
    }
}
