//! From the faces of a planar map to regions: neighbours with one label are joined, borders traced.

use super::faces::{Place, float};
use super::planar::{Planar, cycles, walk};
use crate::clip::polygon::overlay::lattice::cross;

/// The label of faces that are not shown.
pub const NOTHING: u32 = u32::MAX;

/// Joined faces of the planar map.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// The label of its faces.
    pub label: u32,
    /// The outer ring, counter-clockwise, then the holes, clockwise: the half-edge that leaves each corner.
    /// A ring may pass a vertex more than once, never an edge.
    pub rings: Vec<Vec<u32>>,
}

/// See [`patches`].
#[derive(Debug, Clone, Default)]
pub struct Patches {
    /// In the order of their first half-edges.
    pub list: Vec<Patch>,
    /// For each face of the map its patch; [`NOTHING`] if it has none.
    pub of_face: Vec<u32>,
}

/// Returns the patches of a map, given the label of each of its faces.
pub fn patches(map: &Planar, labels: &[u32]) -> Patches {
    let label = |half: usize| labels[map.face_of[half] as usize];
    let keep = |edge: usize| label(2 * edge) != label(2 * edge + 1);
    let groups = join(map, keep);
    let next = map.successors(keep);
    let corners = corners(map, keep);
    let (_, firsts) = cycles(&next);
    let mut patch_of = vec![NOTHING; map.face_count];
    let mut list: Vec<Patch> = Vec::new();
    for first in firsts {
        let label = label(first as usize);
        if label == NOTHING {
            continue;
        }
        let is_outer = map.doubled_area(walk(&next, first)) > 0;
        let corner = |half: &u32| corners[map.start(*half) as usize];
        let ring: Vec<u32> = walk(&next, first).filter(corner).collect();
        // Slivers less than a grid step wide vanish, or turn over, with the vertices left out.
        let turns = |doubled: i128| if is_outer { doubled > 0 } else { doubled < 0 };
        if ring.len() < 3 || !turns(map.doubled_area(ring.iter().copied())) {
            continue;
        }
        let group = groups[map.face_of[first as usize] as usize] as usize;
        if patch_of[group] == NOTHING {
            patch_of[group] = list.len() as u32;
            list.push(Patch { label, rings: Vec::new() });
        }
        let rings = &mut list[patch_of[group] as usize].rings;
        let place = if is_outer { 0 } else { rings.len() };
        rings.insert(place, ring);
    }
    let of_face = groups.iter().map(|&group| patch_of[group as usize]).collect();
    Patches { list, of_face }
}

/// Returns, for each face, the representative of all faces joined to it.
fn join(map: &Planar, keep: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..map.face_count as u32).collect();
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            let up = parent[parent[i as usize] as usize];
            parent[i as usize] = up;
            i = up;
        }
        i
    }
    for edge in (0..map.edges.len()).filter(|&e| !keep(e)) {
        let [a, b] = [2 * edge, 2 * edge + 1].map(|half| root(&mut parent, map.face_of[half]));
        parent[a.max(b) as usize] = a.min(b);
    }
    (0..map.face_count as u32).map(|i| root(&mut parent, i)).collect()
}

/// Returns which vertices stay: those at which the kept edges make a corner, or more than two of
/// them meet. A vertex that is left out by one ring is left out by its neighbour too.
fn corners(map: &Planar, keep: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut corners = vec![true; map.points.len()];
    chains(map, keep, |chain| {
        straight(map, chain, |v| corners[v as usize] = false);
    });
    corners
}

/// Calls `f` with the vertices of each chain of kept edges between two vertices where other than two edges meet; a loop
/// without such a vertex returns to its first one.
fn chains(map: &Planar, keep: impl Fn(usize) -> bool, mut f: impl FnMut(&[u32])) {
    let mut done = vec![false; map.edges.len()];
    let kept = |v: u32| map.around(v).iter().copied().filter(|&h| keep(h as usize / 2));
    let through = |v: u32| {
        let mut halves = kept(v);
        match (halves.next(), halves.next(), halves.next()) {
            (Some(a), Some(b), None) => Some((a, b)),
            _ => None,
        }
    };
    let mut chain: Vec<u32> = Vec::new();
    let mut follow = |first: u32, done: &mut [bool]| {
        chain.clear();
        chain.push(map.start(first));
        let mut half = first;
        loop {
            done[half as usize / 2] = true;
            let vertex = map.start(half ^ 1);
            chain.push(vertex);
            match through(vertex) {
                Some((a, b)) if vertex != chain[0] => half = if a == half ^ 1 { b } else { a },
                _ => break,
            }
        }
        f(&chain);
    };
    for v in (0..map.points.len() as u32).filter(|&v| through(v).is_none()) {
        for half in kept(v) {
            if !done[half as usize / 2] {
                follow(half, &mut done);
            }
        }
    }
    for edge in (0..map.edges.len()).filter(|&e| keep(e)) {
        if !done[edge] {
            follow(2 * edge as u32, &mut done);
        }
    }
}

/// Returns the chains of kept edges as lines: their vertices, and whether the last is joined to the
/// first.
pub fn lines(map: &Planar, keep: impl Fn(usize) -> bool) -> Vec<(Vec<u32>, bool)> {
    let mut lines = Vec::new();
    chains(map, keep, |chain| {
        let mut dropped = Vec::new();
        straight(map, chain, |v| dropped.push(v));
        let closed = chain.len() > 3 && chain.first() == chain.last();
        let points = chain[..chain.len() - usize::from(closed)].iter().copied();
        // Vertices are dropped in the order of the chain.
        let mut dropped = dropped.into_iter().peekable();
        lines.push((points.filter(|v| dropped.next_if_eq(v).is_none()).collect(), closed));
    });
    lines
}

/// Vertices looked back at, at most.
const MOST_DROPPED: usize = 64;

/// Reports the inner vertices of a chain that lie within a grid step of the line past them.
fn straight(map: &Planar, chain: &[u32], mut visit: impl FnMut(u32)) {
    let at = |i: usize| map.points[chain[i] as usize];
    let mut from = 0;
    let inner = chain.iter().enumerate().take(chain.len().saturating_sub(1)).skip(1);
    for (i, &vertex) in inner {
        let (a, b) = (at(from), at(i + 1));
        let reach = (float(b) - float(a)).length();
        let near = |k: usize| {
            let p: Place = at(k);
            let forward = (float(p) - float(a)).dot(float(b) - float(p)) > 0.0;
            forward && (cross(a, b, p) as f64).abs() <= reach
        };
        if i - from <= MOST_DROPPED && (from + 1..=i).all(near) {
            visit(vertex);
        } else {
            from = i;
        }
    }
}
