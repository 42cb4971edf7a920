//! The bodies that faces bound: connected pieces of surface, whether they are closed, and their outward direction.

use super::{Edges, Faces};
use crate::math::DVec3;

/// A connected piece of surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Body {
    /// True if each edge has as many triangles on one side as on the other, after turning triangles that run against
    /// their neighbours: the piece bounds a volume, and seen from outside the first face is a front face.
    pub closed: bool,
    /// Number of its triangles, without duplicates.
    pub triangles: u32,
    /// Its volume in cubic units; meaningful where closed. Never negative: triangles are counted as
    /// turned outwards.
    pub volume: f64,
}

/// The bodies of the faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bodies {
    bodies: Vec<Body>,
    /// Body · 2 + whether the triangle is turned; [`ABSENT`] for triangles that count for nothing.
    of_item: Vec<u32>,
}

/// Mark of triangles that belong to no body: degenerate ones and second copies.
const ABSENT: u32 = u32::MAX;

impl Bodies {
    /// Finds the bodies, and returns the edges with them: of two triangles with the same three vertices only the first
    /// counts. O(n α(n)).
    pub fn find(faces: &Faces) -> (Self, Edges) {
        Self::of_edges(faces, Edges::new(faces, |_| true))
    }

    /// Finds the bodies where the edges of all triangles are known.
    pub(in crate::visibility) fn of_edges(faces: &Faces, mut edges: Edges) -> (Self, Edges) {
        if let Some(copy) = copies(faces, &edges) {
            edges = Edges::new(faces, |item| !copy[item as usize]);
            let bodies = Self::new(faces, &edges, |item| !copy[item as usize]);
            return (bodies, edges);
        }
        let bodies = Self::new(faces, &edges, |_| true);
        (bodies, edges)
    }

    fn new(faces: &Faces, edges: &Edges, counts: impl Fn(u32) -> bool) -> Self {
        let mut sets = TurnedSets::new(faces.len());
        // Neighbours across an edge of two are turned alike; across more, the orientation is undefined.
        for (_, sides) in edges.iter() {
            if let [a, b] = sides {
                sets.unite(a.item(), b.item(), a.forward() == b.forward());
            }
        }
        let mut number = vec![ABSENT; faces.len()];
        let mut of_item = vec![ABSENT; faces.len()];
        let mut bodies: Vec<Body> = Vec::new();
        let mut origins: Vec<DVec3> = Vec::new();
        for (item, t) in faces.triangles().filter(|(item, _)| counts(*item)) {
            let (root, turned) = sets.find(item);
            let [a, b, c] = t.map(|v| faces.points()[v as usize]);
            if number[root as usize] == ABSENT {
                number[root as usize] = bodies.len() as u32;
                bodies.push(Body { closed: !sets.torn(root), ..Body::default() });
                origins.push(a);
            }
            let index = number[root as usize];
            let (body, origin) = (&mut bodies[index as usize], origins[index as usize]);
            let volume = (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
            body.volume += if turned { -volume } else { volume };
            body.triangles += 1;
            of_item[item as usize] = index << 1 | u32::from(turned);
        }
        drop((sets, number));
        let mut found = Self { bodies, of_item };
        found.open_unbalanced(edges);
        found.turn_outwards();
        found
    }

    /// Marks bodies open that have an edge with more triangles on one side than on the other.
    fn open_unbalanced(&mut self, edges: &Edges) {
        for (_, sides) in edges.iter() {
            let packed = |s: &super::EdgeSide| self.of_item[s.item() as usize];
            if let [a, b] = sides {
                let (pa, pb) = (packed(a), packed(b));
                if (pa ^ pb) & 1 == u32::from(a.forward() == b.forward()) {
                    continue;
                }
            }
            for side in sides {
                let body = packed(side) >> 1;
                let of_body = sides.iter().filter(|s| packed(s) >> 1 == body);
                let balance: i64 =
                    of_body.map(|s| if s.forward() ^ (packed(s) & 1 == 1) { 1 } else { -1 }).sum();
                if balance != 0 {
                    self.bodies[body as usize].closed = false;
                }
            }
        }
    }

    /// Turns closed bodies that are inside out. Open ones are oriented as their first triangle is in the file.
    fn turn_outwards(&mut self) {
        let inside_out: Vec<bool> =
            self.bodies.iter().map(|b| b.closed && b.volume < 0.0).collect();
        for packed in self.of_item.iter_mut().filter(|p| **p != ABSENT) {
            *packed ^= u32::from(inside_out[(*packed >> 1) as usize]);
        }
        for body in &mut self.bodies {
            body.volume = body.volume.abs();
        }
    }

    /// Returns all bodies, in the order of their first triangles.
    pub(crate) fn all(&self) -> &[Body] {
        &self.bodies
    }

    /// Returns the index of a triangle's body; `None` for triangles without area, and for those
    /// that repeat the three vertices of an earlier one.
    #[inline]
    pub(crate) fn of(&self, item: u32) -> Option<u32> {
        self.of_item.get(item as usize).filter(|p| **p != ABSENT).map(|p| p >> 1)
    }

    /// Returns whether a triangle must be turned over for its front to look out of its body (for an
    /// open one: for neighbours to agree).
    #[inline]
    pub(crate) fn turned(&self, item: u32) -> bool {
        self.of_item.get(item as usize).is_some_and(|p| *p != ABSENT && p & 1 == 1)
    }
}

/// Returns true for each triangle with the same three vertices as an earlier one; `None` if there
/// are none.
fn copies(faces: &Faces, edges: &Edges) -> Option<Vec<bool>> {
    let vertices = |item: u32| {
        let mut t = faces.triangle(item)?;
        t.sort_unstable();
        Some(t)
    };
    let mut copy: Option<Vec<bool>> = None;
    for (_, sides) in edges.iter().filter(|(_, sides)| sides.len() > 1) {
        // A fan of many triangles around one edge is sorted by its tips.
        let mut tips: Vec<(Option<[u32; 3]>, u32)> = Vec::new();
        if let [a, b] = sides {
            if vertices(a.item()) == vertices(b.item()) {
                copy.get_or_insert_with(|| vec![false; faces.len()])[b.item() as usize] = true;
            }
            continue;
        }
        tips.extend(sides.iter().map(|s| (vertices(s.item()), s.item())));
        tips.sort_unstable();
        for pair in tips.windows(2).filter(|p| p[0].0 == p[1].0) {
            copy.get_or_insert_with(|| vec![false; faces.len()])[pair[1].1 as usize] = true;
        }
    }
    copy
}

/// Disjoint sets of triangles, each with its turn against the set's root (Tarjan, *Efficiency of a
/// good but not linear set union algorithm*, 1975, with parities).
struct TurnedSets {
    /// Parent · 2 + turned against it.
    parent: Vec<u32>,
    torn: std::collections::BTreeSet<u32>,
}

impl TurnedSets {
    fn new(count: usize) -> Self {
        let parent = (0..count as u32).map(|i| i << 1).collect();
        Self { parent, torn: std::collections::BTreeSet::new() }
    }

    /// Finds the root of an item and whether it is turned against it; halves paths.
    fn find(&mut self, mut item: u32) -> (u32, bool) {
        let mut turned = 0;
        loop {
            let up = self.parent[item as usize];
            let upper = self.parent[(up >> 1) as usize];
            if up >> 1 == item {
                return (item, turned == 1);
            }
            // Skips one: turn against the grandparent is the sum of both turns.
            let skip = upper ^ (up & 1);
            self.parent[item as usize] = if upper >> 1 == up >> 1 { up } else { skip };
            let now = self.parent[item as usize];
            turned ^= now & 1;
            item = now >> 1;
        }
    }

    fn unite(&mut self, a: u32, b: u32, turned: bool) {
        let ((a, ta), (b, tb)) = (self.find(a), self.find(b));
        let turn = ta ^ tb ^ turned;
        if a == b {
            if turn {
                self.torn.insert(a);
            }
            return;
        }
        // The smaller number leads: a set's root does not depend on the order of unions.
        let (root, child) = (a.min(b), a.max(b));
        self.parent[child as usize] = root << 1 | u32::from(turn);
        if self.torn.remove(&child) {
            self.torn.insert(root);
        }
    }

    /// Returns whether its triangles cannot be turned so that all neighbours agree.
    fn torn(&self, root: u32) -> bool {
        self.torn.contains(&root)
    }
}
