//! Creases that no single angle distinguishes.
//!
//! A mesh of round parts turns from facet to facet by about equal steps, while an edge is a single step. So the turns
//! straight across an edge on both sides of it classify it: an edge between two flat faces that bend no further is a
//! crease, however obtuse; and a few edges above the crease angle, between facets that continue to bend by about as
//! much, are no crease if they begin and end in the open. As in Tamal Dey and Lei Wang, *Voronoi-based feature curves
//! extraction for sampled singular surfaces*, Computers & Graphics, 2013, a feature is recognized by its surroundings,
//! not by one threshold. O(n), and O(k log k) for k such edges.
//!
//! Flat faces consist of two triangles or more: scanned meshes consist of single triangles turned against each other.

use super::fading::{FIRST_COSINE, Fading};
use super::planes::Planes;
use super::roundness::FLAT;
use super::vertex_normals::Directions;
use crate::parallel;
use crate::sorting::CompactSort;
use crate::visibility::object::{EdgeSide, Edges, Faces};
use std::ops::Range;

/// The cosine of 3°: blunter edges are ignored, for files have rounded coordinates.
const BLUNTEST: f64 = 0.998_63;

/// The angle in radians from which an edge is not a step of a round part, 60°, and its cosine.
const NO_STEP: f64 = std::f64::consts::FRAC_PI_3;
const NO_STEP_COSINE: f64 = 0.5;

/// Vertices per job.
const JOB: usize = 1 << 15;

/// An edge, the smaller vertex first.
type Ends = [u32; 2];

/// Edges of the mesh that are creases, and edges that are not, whatever their angles; each list in order.
pub(super) struct Steps {
    creases: Vec<Ends>,
    facets: Vec<Ends>,
    /// True for each item at one of them; empty if there are none.
    items: Vec<bool>,
}

impl Steps {
    /// Finds the steps of faces with creases from the angle `crease` on, in radians.
    pub fn new((faces, edges): (&Faces, &Edges), planes: &Planes, crease: f64) -> Self {
        let seen = Seen { faces, edges, planes, crease: libm::cos(crease) };
        let mut turns = Turns::default();
        seen.each_job(|vertices| seen.turns(vertices)).into_iter().for_each(|t| turns.add(t));
        let blunt = seen.blunt(&turns.flat);
        let count = faces.points().len();
        let loose = turns.loose(count);
        let fading = turns.fading(count);
        if blunt.is_empty() && loose.is_empty() && fading.is_empty() {
            return Self { creases: Vec::new(), facets: Vec::new(), items: Vec::new() };
        }
        // Slivers that rounding has turned lie in no plane with others, and are few along lines.
        let directions = |crease| Directions::new((faces, edges), planes, crease, &[]);
        let fine = directions(crease);
        let blunt = blunt.into_iter().filter(|t| !fine.is_round(t.ends, t.items));
        let mut creases = turns.held(blunt.map(|t| t.ends).collect(), count);
        let sharp = turns.sharp_at(&creases, count);
        let coarse = directions(NO_STEP);
        let fades = Fading { faces, edges, directions: &coarse, sharp: &sharp };
        creases.extend(fades.creases(&fading));
        creases.sort_unstable();
        creases.dedup();
        let bends_on = |line: &Vec<Turn>| {
            let on = line.iter().filter(|t| coarse.bends_on(t.ends, t.items));
            2 * on.count() >= line.len()
        };
        let facets = loose.into_iter().filter(bends_on).flatten();
        let mut facets: Vec<Ends> = facets.map(|t| t.ends).collect();
        facets.sort_unstable();
        let mut items = vec![false; faces.len()];
        let known = creases.iter().chain(&facets).flat_map(|ends| edges.at(*ends));
        known.for_each(|side| items[side.item() as usize] = true);
        Self { creases, facets, items }
    }

    /// Returns whether an edge is a crease, if that is known.
    pub fn is_crease(&self, ends: Ends) -> Option<bool> {
        if self.creases.binary_search(&ends).is_ok() {
            Some(true)
        } else {
            self.facets.binary_search(&ends).ok().map(|_| false)
        }
    }

    /// Returns whether something may be known of the edge between two triangles.
    pub fn may_know(&self, items: [u32; 2]) -> bool {
        items.iter().all(|item| self.items.get(*item as usize) == Some(&true))
    }

    /// Returns whether nothing is known of any edge.
    pub fn is_empty(&self) -> bool {
        self.creases.is_empty() && self.facets.is_empty()
    }
}

/// Two triangles at an edge.
#[derive(Clone, Copy)]
struct Turn {
    ends: Ends,
    items: [u32; 2],
}

/// Data for the first pass over all edges.
#[derive(Default)]
struct Turns {
    /// Items that lie in a plane with a neighbour.
    flat: Vec<u32>,
    /// Edges that may be steps of a round part, though they are above the crease angle.
    coarse: Vec<Turn>,
    /// Vertices of others that are not smooth surface.
    sharp: Vec<u32>,
    /// Edges that may be the first of a crease that fades; some are `coarse`, too.
    first: Vec<Ends>,
}

impl Turns {
    fn add(&mut self, mut more: Self) {
        self.flat.append(&mut more.flat);
        self.coarse.append(&mut more.coarse);
        self.sharp.append(&mut more.sharp);
        self.first.append(&mut more.first);
    }

    /// Returns the edges without those that begin or end in the open, where neither one of them goes on nor a
    /// sharp edge.
    fn held(&self, edges: Vec<Ends>, vertices: usize) -> Vec<Ends> {
        if edges.is_empty() {
            return edges;
        }
        let mut holds = vec![false; vertices];
        let coarse = self.coarse.iter().flat_map(|t| t.ends);
        self.sharp.iter().copied().chain(coarse).for_each(|v| holds[v as usize] = true);
        let mut count = vec![0_u32; vertices];
        edges.iter().flatten().for_each(|v| count[*v as usize] += 1);
        let mut at: Vec<(u32, usize)> =
            edges.iter().enumerate().flat_map(|(i, ends)| ends.map(|v| (v, i))).collect();
        at.sort_unstable();
        let mut kept = vec![true; edges.len()];
        let mut open: Vec<u32> = at.iter().map(|(v, _)| *v).collect();
        while let Some(v) = open.pop() {
            if holds[v as usize] || count[v as usize] != 1 {
                continue;
            }
            let here = at[at.partition_point(|a| a.0 < v)..].iter().take_while(|a| a.0 == v);
            for (_, i) in here.filter(|(_, i)| kept[*i]).collect::<Vec<_>>() {
                kept[*i] = false;
                edges[*i].iter().for_each(|v| count[*v as usize] -= 1);
                open.extend(edges[*i]);
            }
        }
        edges.into_iter().zip(kept).filter(|(_, kept)| *kept).map(|(ends, _)| ends).collect()
    }

    /// Returns the number of sharp edges at each vertex, these included.
    fn sharp_at(&self, creases: &[Ends], vertices: usize) -> Vec<u8> {
        let mut count = vec![0_u8; vertices];
        for v in self.sharp.iter().chain(creases.iter().flatten()) {
            let count = &mut count[*v as usize];
            *count = count.saturating_add(1);
        }
        count
    }

    /// Returns the edges with exactly one end on a sharp edge, which may be the first of a fading crease.
    fn fading(&self, vertices: usize) -> Vec<Ends> {
        if self.first.is_empty() || self.sharp.is_empty() {
            return Vec::new();
        }
        let sharp = self.sharp_at(&[], vertices);
        let is_first = |[a, b]: &Ends| (sharp[*a as usize] > 0) != (sharp[*b as usize] > 0);
        self.first.iter().copied().filter(is_first).collect()
    }

    /// Returns lines of edges, in any number at a vertex, that meet no sharp edge and no loop.
    fn loose(&self, vertices: usize) -> Vec<Vec<Turn>> {
        if self.coarse.is_empty() {
            return Vec::new();
        }
        let mut lines = Lines((0..vertices as u32).collect());
        let mut closed = vec![false; vertices];
        self.sharp.iter().for_each(|v| closed[*v as usize] = true);
        for turn in &self.coarse {
            let [a, b] = turn.ends.map(|v| lines.first(v));
            // Ends that are joined already make a loop.
            let shut = a == b || closed[a as usize] || closed[b as usize];
            lines.0[a.max(b) as usize] = a.min(b);
            closed[a.min(b) as usize] = shut;
        }
        let mut of: Vec<(u32, Turn)> =
            self.coarse.iter().map(|t| (lines.first(t.ends[0]), *t)).collect();
        of.retain(|(first, _)| !closed[*first as usize]);
        of.compact_sort_by_key(|(first, turn)| (*first, turn.ends));
        let lines = of.chunk_by(|a, b| a.0 == b.0);
        lines.map(|line| line.iter().map(|(_, turn)| *turn).collect()).collect()
    }
}

/// Vertices that are joined, each with one before it or itself.
struct Lines(Vec<u32>);

impl Lines {
    /// Returns the first of the vertices with which a vertex is joined.
    fn first(&mut self, mut vertex: u32) -> u32 {
        while self.0[vertex as usize] != vertex {
            let before = self.0[vertex as usize];
            self.0[vertex as usize] = self.0[before as usize];
            vertex = before;
        }
        vertex
    }
}

/// Surface on which edges are examined.
struct Seen<'a> {
    faces: &'a Faces,
    edges: &'a Edges,
    planes: &'a Planes,
    /// Cosine of the crease angle.
    crease: f64,
}

impl Seen<'_> {
    fn each_job<T: Send>(&self, f: impl Fn(Range<u32>) -> T + Sync + Send) -> Vec<T> {
        let count = self.faces.points().len() as u32;
        let jobs: Vec<_> =
            (0..count).step_by(JOB).map(|v| v..(v + JOB as u32).min(count)).collect();
        parallel::map(jobs, f)
    }

    /// Returns the first pass over the edges whose smaller vertices lie in a range.
    fn turns(&self, vertices: Range<u32>) -> Turns {
        let mut found = Turns::default();
        for (ends, sides) in self.edges.of_vertices(vertices) {
            let Some((items, cosine)) = self.turn(sides) else {
                found.sharp.extend(ends);
                continue;
            };
            if cosine >= FLAT {
                found.flat.extend(items);
                continue;
            }
            if (NO_STEP_COSINE..FIRST_COSINE).contains(&cosine) {
                found.first.push(ends);
            }
            if cosine < self.crease && cosine >= NO_STEP_COSINE {
                found.coarse.push(Turn { ends, items });
            } else if cosine < self.crease {
                found.sharp.extend(ends);
            }
        }
        found
    }

    /// Returns the edges below the crease angle between faces of several triangles, of which `flat`
    /// are some.
    fn blunt(&self, flat: &[u32]) -> Vec<Turn> {
        if flat.is_empty() {
            return Vec::new();
        }
        let mut has_mate = vec![false; self.faces.len()];
        flat.iter().for_each(|item| has_mate[*item as usize] = true);
        self.each_job(|vertices| self.blunt_from(vertices, &has_mate)).concat()
    }

    /// Returns the same of those whose smaller vertices lie in a range.
    fn blunt_from(&self, vertices: Range<u32>, has_mate: &[bool]) -> Vec<Turn> {
        let mut found = Vec::new();
        for (ends, sides) in self.edges.of_vertices(vertices) {
            if !sides.iter().all(|s| has_mate[s.item() as usize]) {
                continue;
            }
            let Some((items, cosine)) = self.turn(sides) else { continue };
            if cosine >= self.crease && cosine < BLUNTEST {
                found.push(Turn { ends, items });
            }
        }
        found
    }

    /// Returns the triangles at an edge of two, and the cosine of what the surface turns by there. None if
    /// there is no surface, or a triangle has no direction.
    fn turn(&self, sides: &[EdgeSide]) -> Option<([u32; 2], f64)> {
        let [a, b] = sides else { return None };
        let cosine = self.planes.cosine(*a, *b);
        (!cosine.is_nan()).then_some(([a.item(), b.item()], cosine))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turns(coarse: &[Ends], sharp: &[u32]) -> Turns {
        let coarse = coarse.iter().map(|ends| Turn { ends: *ends, items: [0, 1] }).collect();
        Turns { coarse, sharp: sharp.to_vec(), ..Turns::default() }
    }

    #[test]
    fn blunt_edges_hold_at_both_ends() {
        let row = vec![[0, 1], [1, 2], [2, 3]];
        let held = |turns: Turns| turns.held(row.clone(), 8);
        assert_eq!(held(turns(&[], &[0, 3])), row);
        assert_eq!(held(turns(&[[3, 7]], &[0])), row);
        assert_eq!(held(turns(&[], &[0, 2])), row[..2]);
        assert_eq!(held(turns(&[], &[0])), [[0; 2]; 0]);
        // A loop has no ends, but a branch of it has one.
        let ring = vec![[0, 1], [0, 2], [1, 2], [2, 5]];
        assert_eq!(turns(&[], &[]).held(ring.clone(), 8), ring[..3]);
    }

    #[test]
    fn loose_lines_meet_no_sharp_edge_and_no_loop() {
        let loose = |coarse: &[Ends], sharp: &[u32]| {
            let lines = turns(coarse, sharp).loose(9);
            lines.iter().map(|l| l.iter().map(|t| t.ends).collect()).collect::<Vec<Vec<_>>>()
        };
        let two = [[0, 1], [1, 2], [4, 5]];
        assert_eq!(loose(&two, &[]), [vec![[0, 1], [1, 2]], vec![[4, 5]]]);
        assert_eq!(loose(&two, &[2]), [[[4, 5]]]);
        assert_eq!(loose(&[[0, 1], [0, 2], [1, 2], [4, 5]], &[]), [[[4, 5]]]);
    }
}
