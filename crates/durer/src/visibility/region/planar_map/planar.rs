//! The planar map of the visible edges: vertices, edges, and the faces between them, with islands assigned to the faces
//! that contain them.

use super::faces::{Place, float};
use crate::Result;
use crate::clip::polygon::overlay::arrangement::Arrangement;
use crate::clip::polygon::overlay::grid::{self, Block, Grid, Spread};
use crate::clip::polygon::overlay::lattice::{Segment, cross};
use crate::clip::polygon::overlay::noding;
use crate::clip::polygon::overlay::search::Search;
use crate::math::DVec2;
use crate::work::Work;

const NONE: u32 = u32::MAX;

/// See the module. Half-edge 2e runs along edge e from its lower to its higher end, 2e + 1 back; each
/// has a face on its left.
#[derive(Debug, Default)]
pub struct Planar {
    pub points: Vec<Place>,
    /// Ends of the edges, the lexicographically smaller point first.
    pub edges: Vec<[u32; 2]>,
    /// Outgoing half-edges of all vertices, counter-clockwise around each.
    around: Vec<u32>,
    /// Those of vertex i are `around[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
    /// Face to the left of each half-edge. Face 0 is the outer face.
    pub face_of: Vec<u32>,
    pub face_count: usize,
    /// Connected parts.
    pub part_count: usize,
}

impl Planar {
    /// Nodes the segments and finds the faces that they bound.
    ///
    /// # Errors
    /// Those of the work.
    pub fn new(pieces: &[(Place, Place)], work: &Work) -> Result<Self> {
        let segments: Vec<Segment<i32>> = pieces.iter().map(|&(a, b)| Segment { a, b }).collect();
        let Some(block) = Block::around(&segments) else {
            return Ok(Self { face_count: 1, starts: vec![0], ..Self::default() });
        };
        let segments: Vec<Segment<i32>> = match grid::spatial_order(&segments, block) {
            Some(order) => order.iter().map(|&i| segments[i as usize]).collect(),
            None => segments,
        };
        let grid = Grid::new(&segments, block, Spread::of(&segments, block));
        let noding = noding::node(&segments, &grid, None, false, work)?;
        let graph = Arrangement::of_lines(&noding);
        let search = Search { grid: &grid, segments: &segments, noding: &noding };
        let mut planar = Self::of(&graph);
        planar.find_faces(&graph, &search);
        Ok(planar)
    }

    fn of(graph: &Arrangement<i32>) -> Self {
        let edges: Vec<[u32; 2]> = graph.edges.iter().map(|e| [e.low, e.high]).collect();
        let mut around = Vec::with_capacity(edges.len() * 2);
        let mut starts = Vec::with_capacity(graph.nodes.len() + 1);
        for node in 0..graph.nodes.len() as u32 {
            starts.push(around.len() as u32);
            around.extend(graph.around(node).iter().map(|half| half.0));
        }
        starts.push(around.len() as u32);
        Self { points: graph.nodes.to_vec(), edges, around, starts, ..Self::default() }
    }

    /// Returns the vertex that a half-edge starts at.
    #[inline(always)]
    pub fn start(&self, half: u32) -> u32 {
        self.edges[half as usize / 2][half as usize & 1]
    }

    /// Returns the half-edges that leave a vertex, counter-clockwise.
    #[inline(always)]
    pub fn around(&self, vertex: u32) -> &[u32] {
        let (from, to) = (self.starts[vertex as usize], self.starts[vertex as usize + 1]);
        &self.around[from as usize..to as usize]
    }

    /// Returns, for each half-edge, the next along the border of the face to its left, where only edges that `keep`
    /// accepts count; `NONE` for the others.
    pub fn successors(&self, keep: impl Fn(usize) -> bool) -> Vec<u32> {
        let mut next = vec![NONE; self.edges.len() * 2];
        for vertex in 0..self.points.len() as u32 {
            let around = self.around(vertex);
            let kept = |half: &&u32| keep(**half as usize / 2);
            let Some(mut before) = around.iter().rfind(kept).copied() else {
                continue;
            };
            for &half in around.iter().filter(kept) {
                next[half as usize ^ 1] = before;
                before = half;
            }
        }
        next
    }

    /// Returns twice the signed area of the ring through the starts of half-edges, as of a closed walk, in
    /// squared grid steps; exact.
    pub fn doubled_area(&self, walk: impl Iterator<Item = u32>) -> i128 {
        let mut starts = walk.map(|half| self.points[self.start(half) as usize]);
        let Some(origin) = starts.next() else { return 0 };
        let mut last = origin;
        starts.map(|p| i128::from(cross(origin, std::mem::replace(&mut last, p), p))).sum()
    }

    fn find_faces(&mut self, graph: &Arrangement<i32>, search: &Search<i32>) {
        let next = self.successors(|_| true);
        let (cycle_of, cycles) = cycles(&next);
        let areas: Vec<i128> =
            cycles.iter().map(|&half| self.doubled_area(walk(&next, half))).collect();
        // Walks around a face come first, in order; walks around a part are in a face or outside all.
        let mut face_of_cycle = vec![NONE; cycles.len()];
        let mut count = 1;
        for (face, _) in face_of_cycle.iter_mut().zip(&areas).filter(|(_, area)| **area > 0) {
            *face = count;
            count += 1;
        }
        let mut parts: Vec<(Place, u32, u32)> = Vec::new();
        for (cycle, &half) in cycles.iter().enumerate() {
            if face_of_cycle[cycle] == NONE {
                let first = walk(&next, half).map(|h| self.start(h));
                let first = first.min_by_key(|&v| self.points[v as usize]).unwrap_or(0);
                parts.push((self.points[first as usize], first, cycle as u32));
            }
        }
        parts.sort_unstable();
        self.part_count = parts.len();
        let below = search.below_each(graph, parts.iter().map(|part| part.1), |_| true);
        for ((_, _, cycle), below) in parts.into_iter().zip(below) {
            let face = below.map_or(0, |half| face_of_cycle[cycle_of[half.0 as usize] as usize]);
            // Parts further left are processed first; if none is found, the part is in the outside.
            face_of_cycle[cycle as usize] = if face == NONE { 0 } else { face };
        }
        self.face_of = cycle_of.iter().map(|&c| face_of_cycle[c as usize]).collect();
        self.face_count = count as usize;
    }

    /// Returns the half-edges by the face to their left: those of face i are `list[starts[i]..starts[i + 1]]`.
    pub fn borders(&self) -> (Vec<u32>, Vec<u32>) {
        let mut starts = vec![0u32; self.face_count + 2];
        for &face in &self.face_of {
            starts[face as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut list = vec![0; self.face_of.len()];
        for (half, &face) in self.face_of.iter().enumerate() {
            let next = &mut starts[face as usize + 1];
            list[*next as usize] = half as u32;
            *next += 1;
        }
        starts.pop();
        (starts, list)
    }

    /// Returns a point inside a face with this border, away from it where the face is not all
    /// narrow.
    pub fn inner_point(&self, border: &[u32]) -> Option<DVec2> {
        let ends = |half: u32| {
            [self.start(half), self.start(half ^ 1)].map(|v| float(self.points[v as usize]))
        };
        if let &[a, b, c] = border {
            let [a, b, c] = [a, b, c].map(|half| ends(half)[0]);
            return Some((a + b + c) / 3.0);
        }
        let mut longest = [(0.0, NONE); 3];
        for &half in border {
            let [a, b] = ends(half);
            let length = a.distance_squared(b);
            if let Some(k) = longest.iter().position(|l| length > l.0) {
                longest[k..].rotate_right(1);
                longest[k] = (length, half);
            }
        }
        let mut best: Option<(f64, DVec2)> = None;
        for (_, half) in longest.into_iter().filter(|l| l.1 != NONE) {
            let [a, b] = ends(half);
            let middle = (a + b) * 0.5;
            let inward = (b - a).perp().normalize_or_zero();
            let others = border.iter().filter(|&&other| other / 2 != half / 2);
            let reach = others
                .filter_map(|&other| hit(middle, inward, ends(other)))
                .fold(f64::INFINITY, f64::min);
            if reach.is_finite() && best.is_none_or(|(r, _)| reach > r) {
                best = Some((reach, middle + inward * (reach * 0.5)));
            }
        }
        best.map(|(_, p)| p)
    }
}

/// Returns the distance along a ray from `p` at which it meets a segment.
fn hit(p: DVec2, direction: DVec2, [a, b]: [DVec2; 2]) -> Option<f64> {
    let (u, v) = (a - p, b - p);
    let (s, t) = (direction.perp_dot(u), direction.perp_dot(v));
    if (s > 0.0) == (t > 0.0) {
        return None;
    }
    let along = (u * t - v * s).dot(direction) / (t - s);
    (along > 0.0).then_some(along)
}

/// Returns the half-edges of a closed walk from one of them.
pub fn walk(next: &[u32], first: u32) -> impl Iterator<Item = u32> + '_ {
    let mut half = Some(first);
    std::iter::from_fn(move || {
        let this = half?;
        let following = next[this as usize];
        half = (following != first).then_some(following);
        Some(this)
    })
}

/// Returns the closed walks of a permutation: for each half-edge its walk, and the first half-edge
/// of each.
pub fn cycles(next: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut cycle_of = vec![NONE; next.len()];
    let mut firsts = Vec::new();
    for first in 0..next.len() as u32 {
        if next[first as usize] == NONE || cycle_of[first as usize] != NONE {
            continue;
        }
        for half in walk(next, first) {
            cycle_of[half as usize] = firsts.len() as u32;
        }
        firsts.push(first);
    }
    (cycle_of, firsts)
}
