//! From the edges that bound the result to simple rings, and from rings to polygons.

use std::cmp::Ordering;

use super::arrangement::{Arrangement, NONE, Patch};
use super::edge::{Half, Inside};
use super::lattice::{Coord, Point, cross};
use super::parallel;
use super::search::Search;

/// Direction in which an edge bounds the result, whose inside is on its left.
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
    /// Order of rings: of each polygon the outer ring, then its holes.
    pub order: Vec<u32>,
    /// End of each polygon in `order`.
    pub polygon_ends: Vec<u32>,
}

impl Rings {
    /// Returns the nodes of a ring.
    pub fn ring(&self, index: u32) -> &[u32] {
        let index = index as usize;
        let start = if index == 0 { 0 } else { self.ring_ends[index - 1] };
        &self.nodes[start as usize..self.ring_ends[index] as usize]
    }
}

/// A closed walk along the border of one connected piece of the result.
#[derive(Debug, Clone, Copy)]
struct Walk {
    /// Its smallest node.
    first: u32,
    /// Its rings start where those of the walk before end.
    ring_end: u32,
    /// Its outer ring, or `NONE`.
    outer: u32,
}

struct Linker<'b, C> {
    graph: Arrangement<'b, C>,
    courses: Vec<Course>,
    /// True for each node that stays on a straight border too; empty if none does.
    kept: &'b [bool],
    /// Successor of each edge on the result's border, as the word of a half-edge.
    next: Vec<u32>,
    /// The walk that an edge belongs to.
    walk_of: Vec<u32>,
    walks: Vec<Walk>,
    rings: Rings,
}

/// Links the edges where `inside` differs between the two sides. Nodes on straight borders stay where
/// `kept` says so of them.
#[inline(never)]
pub fn link<'b, C: Coord>(
    mut graph: Arrangement<'b, C>,
    kept: &'b [bool],
    search: &Search<C>,
    inside: Inside,
) -> Rings {
    let courses = courses(&graph, inside);
    // They are no longer needed, and the next steps need the memory.
    graph.right = Vec::new();
    let mut linker = Linker {
        graph,
        courses,
        kept,
        next: Vec::new(),
        walk_of: Vec::new(),
        walks: Vec::new(),
        rings: Rings::default(),
    };
    linker.pair();
    linker.trace();
    let owners = linker.owners(search);
    linker.next = Vec::new();
    linker.walk_of = Vec::new();
    linker.sort(&owners);
    linker.rings
}

#[inline(never)]
fn courses<C: Coord>(graph: &Arrangement<C>, inside: Inside) -> Vec<Course> {
    let mut courses = parallel::filled(Course::No, graph.edges.len());
    let tasks = parallel::cut(&mut courses, &graph.edge_ends()).into_iter().zip(&graph.patches);
    parallel::map(tasks.collect(), |(courses, patch): (&mut [Course], &Patch)| {
        for (course, e) in courses.iter_mut().zip(patch.edges.clone()) {
            *course = match (inside.contains(graph.left(e)), inside.contains(graph.right[e])) {
                (true, false) => Course::Up,
                (false, true) => Course::Down,
                _ => Course::No,
            };
        }
    });
    courses
}

impl<C: Coord> Linker<'_, C> {
    /// Links edges at each node: an arriving edge continues with the departing edge on the other side of the piece of
    /// inside to its left, so that pieces that only touch stay separate.
    #[inline(never)]
    fn pair(&mut self) {
        let mut next = parallel::filled(NONE, self.graph.edges.len());
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
                f(half.edge(), before.0);
            }
            before = half;
        }
    }

    /// Returns whether the border runs against a half-edge that leaves a node.
    fn arrives(&self, half: Half) -> bool {
        let arriving = if half.is_back() { Course::Up } else { Course::Down };
        self.courses[half.edge()] == arriving
    }

    /// Walks along the border of every piece and cuts each walk into simple rings where it comes
    /// back to a node: first the walks that stay within a patch, then the others.
    #[inline(never)]
    fn trace(&mut self) {
        let mut walk_of = parallel::filled(NONE, self.graph.edges.len());
        let groups = parallel::groups(self.graph.patches.iter().collect());
        let group_ends: Vec<u32> =
            groups.iter().map(|group| group.last().map_or(0, |p| p.edges.end as u32)).collect();
        let tasks = groups.iter().zip(parallel::cut(&mut walk_of, &group_ends)).collect();
        let mut found = parallel::map(tasks, |(group, walk_of): (&Vec<&Patch>, &mut [u32])| {
            self.trace_group(group, walk_of)
        });
        // Walks are named from zero in each group.
        let first_walks = parallel::ends(found.iter().map(|found| found.walks.len()));
        let tasks = parallel::cut(&mut walk_of, &group_ends).into_iter().enumerate();
        parallel::map(tasks.collect(), |(k, walk_of): (usize, &mut [u32])| {
            let first = parallel::range(&first_walks, k).start as u32;
            let has_left = !found[k].left.is_empty();
            if first > 0 || has_left {
                for walk in walk_of {
                    *walk = if *walk < LEFT { *walk + first } else { NONE };
                }
            }
        });
        let left: Vec<u32> = found.iter().flat_map(|found| found.left.iter().copied()).collect();
        if !left.is_empty() {
            let all = Patch { nodes: 0..self.graph.nodes.len(), edges: 0..self.graph.edges.len() };
            let mut last = found.pop().unwrap_or_default();
            last.first_walk = parallel::range(&first_walks, found.len()).start as u32;
            let walk_of = &mut walk_of[..];
            let trace = Trace { linker: &*self, patch: &all, walk_of, found: last };
            found.push(trace.run(left.into_iter()));
        }
        self.walk_of = walk_of;
        self.collect(found);
    }

    /// Walks within a patch of a group first, then walks within the group.
    fn trace_group(&self, group: &[&Patch], walk_of: &mut [u32]) -> Found {
        let mut found = Found::default();
        let [Some(first), Some(last)] = [group.first(), group.last()] else { return found };
        let all = Patch {
            nodes: first.nodes.start..last.nodes.end,
            edges: first.edges.start..last.edges.end,
        };
        let on = all.edges.clone().filter(|&e| self.courses[e] != Course::No);
        found.nodes.reserve(on.map(|e| 1 + self.graph.inner(e).len()).sum());
        for patch in group {
            let starts = patch.edges.clone().map(|e| e as u32);
            let place = |e: usize| e - all.edges.start;
            let walk_of = &mut walk_of[place(patch.edges.start)..place(patch.edges.end)];
            found = Trace { linker: self, patch, walk_of, found }.run(starts);
        }
        let left = std::mem::take(&mut found.left);
        if group.len() > 1 && !left.is_empty() {
            walk_of.iter_mut().filter(|walk| **walk == LEFT).for_each(|walk| *walk = NONE);
            found = Trace { linker: self, patch: &all, walk_of, found }.run(left.into_iter());
        } else {
            found.left = left;
        }
        found
    }

    fn collect(&mut self, mut found: Vec<Found>) {
        if let [found] = &mut found[..] {
            self.rings.nodes = std::mem::take(&mut found.nodes);
            self.rings.ring_ends = std::mem::take(&mut found.ring_ends);
            self.walks = std::mem::take(&mut found.walks);
            return;
        }
        let lists = |f: fn(&Found) -> &[u32]| found.iter().map(f).collect::<Vec<_>>();
        self.rings.nodes = parallel::concat(&lists(|found| &found.nodes));
        self.rings.ring_ends.reserve(found.iter().map(|found| found.ring_ends.len()).sum());
        self.walks.reserve(found.iter().map(|found| found.walks.len()).sum());
        let (mut nodes, mut rings) = (0, 0);
        for found in found {
            self.rings.ring_ends.extend(found.ring_ends.iter().map(|end| nodes + end));
            self.walks.extend(found.walks.iter().map(|walk| Walk {
                first: walk.first,
                ring_end: rings + walk.ring_end,
                outer: if walk.outer == NONE { NONE } else { rings + walk.outer },
            }));
            nodes += found.nodes.len() as u32;
            rings += found.ring_ends.len() as u32;
        }
    }

    /// Returns whether a node is kept where the border is straight.
    fn stays(&self, node: u32) -> bool {
        self.kept.get(node as usize).is_some_and(|&kept| kept) || self.touched(node)
    }

    /// Returns whether more than one ring passes the node: then it stays, so that the touch is a
    /// vertex.
    fn touched(&self, node: u32) -> bool {
        let on = |half: &&Half| self.courses[half.edge()] != Course::No;
        self.graph.around(node).iter().filter(on).count() > 2
    }

    /// Returns the outer ring of each ring's polygon. Every walk without an outer ring is a hole of the piece at the
    /// edge below its first node. Walks that start further left are processed first.
    #[inline(never)]
    fn owners(&self, search: &Search<C>) -> Vec<u32> {
        let nodes = self.graph.nodes;
        // The outer ring of each walk's polygon.
        let mut outer_of: Vec<u32> = self.walks.iter().map(|walk| walk.outer).collect();
        let mut holes: Vec<(Point<C>, u32)> = (self.walks.iter().zip(0..))
            .filter(|(walk, _)| walk.outer == NONE && walk.first != NONE)
            .map(|(walk, id)| (nodes[walk.first as usize], id))
            .collect();
        holes.sort_unstable();
        let on = |e: usize| self.courses[e] != Course::No;
        let below =
            parallel::map(holes.chunks(SEARCHES).collect(), |some: &[(Point<C>, u32)]| {
                let firsts = some.iter().map(|&(_, id)| self.walks[id as usize].first);
                search.below_each(&self.graph, firsts, on)
            });
        for ((_, id), below) in holes.into_iter().zip(below.into_iter().flatten()) {
            let walk = below.map_or(NONE, |half| self.walk_of[half.edge()]);
            outer_of[id as usize] = outer_of.get(walk as usize).copied().unwrap_or(NONE);
        }
        let mut owners = Vec::with_capacity(self.rings.ring_ends.len());
        for (walk, outer) in self.walks.iter().zip(outer_of) {
            owners.resize(walk.ring_end as usize, outer);
        }
        owners
    }

    /// Puts polygons in the order of their outer rings' points, and the holes of each likewise.
    #[inline(never)]
    fn sort(&mut self, owners: &[u32]) {
        let nodes = self.graph.nodes;
        let rings = &self.rings;
        let points = |r: u32| rings.ring(r).iter().map(|&n| nodes[n as usize]);
        let first = |r: u32| points(r).next().unwrap_or_default();
        // The first points differ, except for rings that touch there.
        let compare = |a: &(Point<C>, u32), b: &(Point<C>, u32)| {
            a.0.cmp(&b.0).then_with(|| points(a.1).cmp(points(b.1)))
        };
        let count = rings.ring_ends.len();
        let mut outers = Vec::with_capacity(count);
        let mut holes = Vec::new();
        for (&owner, r) in owners.iter().zip(0..) {
            if owner == r {
                outers.push((first(r), r));
            } else if owner != NONE {
                holes.push((first(r), r));
            }
        }
        sort_by_columns(&mut outers, compare);
        let mut order = Vec::with_capacity(count);
        let mut ends = Vec::with_capacity(outers.len());
        if holes.is_empty() {
            order.extend(outers.iter().map(|&(_, outer)| outer));
            ends.extend(1..=outers.len() as u32);
        } else {
            let mut rank = vec![NONE; owners.len()];
            for (&(_, outer), i) in outers.iter().zip(0..) {
                rank[outer as usize] = i;
            }
            let rank_of = |hole: u32| rank[owners[hole as usize] as usize];
            parallel::sort(&mut holes, |a, b| {
                rank_of(a.1).cmp(&rank_of(b.1)).then_with(|| compare(a, b))
            });
            let mut holes = holes.into_iter().map(|(_, hole)| hole).peekable();
            for (&(_, outer), i) in outers.iter().zip(0..) {
                order.push(outer);
                while let Some(hole) = holes.next_if(|&h| rank_of(h) == i) {
                    order.push(hole);
                }
                ends.push(order.len() as u32);
            }
        }
        (self.rings.order, self.rings.polygon_ends) = (order, ends);
    }
}

/// Rings per column: few enough to be sorted in the cache.
const PER_COLUMN: usize = if cfg!(test) { 2 } else { 64 };

/// Number of rings that one task sorts.
const SORTS: usize = if cfg!(test) { 4 } else { 1 << 14 };

/// Sorts rings by their first points and, if these are equal, by `compare`: first into columns of the plane, each of
/// which is mostly in order already.
#[inline(never)]
fn sort_by_columns<C: Coord>(
    rings: &mut Vec<(Point<C>, u32)>,
    compare: impl Fn(&(Point<C>, u32), &(Point<C>, u32)) -> Ordering + Sync,
) {
    let xs = || rings.iter().map(|ring| ring.0.x.i64());
    let (Some(left), Some(right)) = (xs().min(), xs().max()) else { return };
    let columns = (rings.len() / PER_COLUMN + 1) as u64;
    // The smallest power of two with at most the allowed number of columns.
    let shift = u64::BITS - ((right - left) as u64 / columns).leading_zeros();
    let column = |ring: &(Point<C>, u32)| ((ring.0.x.i64() - left) as u64 >> shift) as usize;
    let mut ends = vec![0u32; ((right - left) as u64 >> shift) as usize + 1];
    rings.iter().for_each(|ring| ends[column(ring)] += 1);
    let mut start = 0;
    for end in &mut ends {
        start += std::mem::replace(end, start);
    }
    let mut sorted = vec![(Point::default(), 0); rings.len()];
    for ring in rings.iter() {
        let next = &mut ends[column(ring)];
        sorted[*next as usize] = *ring;
        *next += 1;
    }
    let mut task_ends = Vec::new();
    for (&end, k) in ends.iter().zip(1..) {
        let start = task_ends.last().copied().unwrap_or(0);
        if (end - start) as usize >= SORTS || k == ends.len() {
            task_ends.push(end);
        }
    }
    parallel::map(parallel::cut(&mut sorted, &task_ends), |rings: &mut [(Point<C>, u32)]| {
        let alike = |a: &(Point<C>, u32), b: &(Point<C>, u32)| column(a) == column(b);
        rings.chunk_by_mut(alike).for_each(|rings| rings.sort_by(&compare));
    });
    *rings = sorted;
}

/// Number of searches in one task.
const SEARCHES: usize = if cfg!(test) { 2 } else { 64 };

/// Marks an edge whose walk does not stay within the patch.
const LEFT: u32 = NONE - 1;

/// Rings, their ends, and walks found in some patches.
#[derive(Debug, Default)]
struct Found {
    nodes: Vec<u32>,
    ring_ends: Vec<u32>,
    walks: Vec<Walk>,
    /// The name of the first walk.
    first_walk: u32,
    /// Starts of walks that leave their patch.
    left: Vec<u32>,
    /// One more than the place on the path of each node of a patch; 0 for nodes that are not on it.
    position: Vec<u32>,
}

/// The walks through one patch.
struct Trace<'a, 'b, C> {
    linker: &'a Linker<'b, C>,
    patch: &'a Patch,
    /// Walk of each of the patch's edges.
    walk_of: &'a mut [u32],
    found: Found,
}

impl<C: Coord> Trace<'_, '_, C> {
    /// Follows the walks through edges that no walk was through before.
    fn run(mut self, starts: impl Iterator<Item = u32>) -> Found {
        if self.found.position.len() < self.patch.nodes.len() {
            self.found.position.resize(self.patch.nodes.len(), 0);
        }
        let mut path: Vec<u32> = Vec::new();
        for start in starts {
            let walk = self.walk_of[start as usize - self.patch.edges.start];
            let course = self.linker.courses[start as usize];
            if course != Course::No && walk == NONE {
                let start = Half(start << 1 | u32::from(course == Course::Down));
                self.walk(start, &mut path);
            }
        }
        self.found
    }

    fn walk(&mut self, start: Half, path: &mut Vec<u32>) {
        let Linker { graph, next, .. } = self.linker;
        let first_ring = self.found.ring_ends.len();
        let first_node = self.found.nodes.len();
        let id = self.found.first_walk + self.found.walks.len() as u32;
        let mut walk = Walk { first: NONE, ring_end: 0, outer: NONE };
        let mut half = start;
        path.clear();
        loop {
            let node = graph.start(half);
            let edge = half.edge();
            let place = edge.wrapping_sub(self.patch.edges.start);
            let known = self.walk_of.get(place).copied().unwrap_or(LEFT);
            if known == LEFT || !self.patch.has_node(node) {
                return self.leave(start, path, (first_ring, first_node));
            }
            let position = &mut self.found.position[node as usize - self.patch.nodes.start];
            let at = *position;
            if at != 0 {
                self.close(&path[at as usize - 1..], &mut walk);
                path.truncate(at as usize - 1);
            }
            if known != NONE {
                break;
            }
            path.push(node);
            self.found.position[node as usize - self.patch.nodes.start] = path.len() as u32;
            let inner = graph.inner(edge).iter();
            if half.is_back() {
                path.extend(inner.rev())
            } else {
                path.extend(inner)
            }
            self.walk_of[place] = id;
            half = Half(next[edge]);
        }
        walk.ring_end = self.found.ring_ends.len() as u32;
        self.found.walks.push(walk);
    }

    /// Discards what was found on a walk that leaves the patch.
    fn leave(&mut self, start: Half, path: &[u32], (rings, nodes): (usize, usize)) {
        self.found.left.push(start.edge() as u32);
        self.found.ring_ends.truncate(rings);
        self.found.nodes.truncate(nodes);
        for &node in path.iter().filter(|&&node| self.patch.has_node(node)) {
            self.found.position[node as usize - self.patch.nodes.start] = 0;
        }
        let mut half = start;
        loop {
            let place = half.edge().wrapping_sub(self.patch.edges.start);
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
            half = Half(self.linker.next[half.edge()]);
        }
    }

    /// Stores a simple ring, from its smallest node on; of the nodes on straight edges only those to be kept.
    fn close(&mut self, path: &[u32], walk: &mut Walk) {
        let nodes = self.linker.graph.nodes;
        let point = |n: u32| nodes[n as usize];
        let mut smallest = 0;
        for (i, &n) in path.iter().enumerate() {
            if self.patch.has_node(n) {
                self.found.position[n as usize - self.patch.nodes.start] = 0;
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
        // The smallest node is a corner, and the turn there gives the orientation.
        if cross(point(before), point(first), point(after)) > C::Wide::default() {
            walk.outer = self.found.ring_ends.len() as u32;
        }
        let mut at = first;
        for &after in head[1..].iter().chain(tail).chain([&first]) {
            let straight = cross(point(before), point(at), point(after)) == C::Wide::default();
            if !straight || self.linker.stays(at) {
                self.found.nodes.push(at);
            }
            (before, at) = (at, after);
        }
        self.found.ring_ends.push(self.found.nodes.len() as u32);
    }
}
