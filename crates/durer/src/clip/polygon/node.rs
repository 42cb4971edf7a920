//! A point that several borders pass through: the borders that cross there, and their order.
//!
//! Within a small circle around the point each passage is a chord. Chords of one operand do not cross; one of the
//! subject crosses one of the clip where its ends lie on different sides of it. Every such pair gets its own two linked
//! vertices, all at the same place. Where edges coincide, the subject is treated as beside the clip, on the side that
//! the operation requires.

use super::lists::{Lists, NOT_SIMPLE, join};
use crate::Result;
use crate::math::{DVec2, in_sector};
use std::cmp::Ordering;

/// A border's passage through the point.
#[derive(Debug, Clone, Copy)]
struct Passage {
    /// Index in the operand's list.
    vertex: usize,
    from: DVec2,
    to: DVec2,
}

/// A point that several borders pass.
#[derive(Debug)]
pub(super) struct Node {
    at: DVec2,
    /// Passages of subject and clip.
    passages: [Vec<Passage>; 2],
}

/// Returns the points that are passed more than once, by their coordinates.
pub(super) fn common(lists: &[Lists; 2]) -> Vec<Node> {
    let of = |k: usize| (0..lists[k].vertices.len()).map(move |v| (lists[k].vertices[v].at, k, v));
    let mut all: Vec<(DVec2, usize, usize)> = of(0).chain(of(1)).collect();
    all.sort_by(|a, b| order(a.0, b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let shared = all.chunk_by(|a, b| a.0 == b.0).filter(|members| members.len() > 1);
    let node = |members: &[(DVec2, usize, usize)]| {
        let mut passages = [Vec::new(), Vec::new()];
        for &(_, k, vertex) in members {
            let [from, to] = lists[k].neighbours(vertex);
            passages[k].push(Passage { vertex, from, to });
        }
        Node { at: members[0].0, passages }
    };
    shared.map(node).collect()
}

/// Compares by x, then y; zeros of either sign are one place.
fn order(a: DVec2, b: DVec2) -> Ordering {
    (a.x + 0.0).total_cmp(&(b.x + 0.0)).then((a.y + 0.0).total_cmp(&(b.y + 0.0)))
}

impl Node {
    /// Compares its place with a point.
    pub fn compare(&self, p: DVec2) -> Ordering {
        order(self.at, p)
    }

    /// Returns whether a direction that is not one of the passage's own is to its left.
    fn is_left(&self, of: &Passage, x: DVec2) -> bool {
        in_sector(self.at, of.to, x, of.from)
    }

    /// Checks that the passages of each operand keep apart from one another.
    pub fn check(&self) -> Result<()> {
        for passages in &self.passages {
            for (i, p) in passages.iter().enumerate() {
                let apart = |q: &Passage| {
                    let common = [q.from, q.to].iter().any(|&x| x == p.from || x == p.to);
                    !common && self.is_left(p, q.from) == self.is_left(p, q.to)
                };
                if p.from == p.to || !passages[..i].iter().all(apart) {
                    return Err(NOT_SIMPLE);
                }
            }
        }
        Ok(())
    }

    /// Returns whether the subject arrives, and whether it departs, on the left of a passage of the clip.
    fn sides(&self, s: &Passage, c: &Passage, grown: bool) -> [bool; 2] {
        // Subject shrunk: to its own left, which is the clip's left where they run the same way.
        let side = |x: DVec2, along: DVec2, against: DVec2| match x {
            _ if x == along => !grown,
            _ if x == against => grown,
            _ => self.is_left(c, x),
        };
        [side(s.from, c.from, c.to), side(s.to, c.to, c.from)]
    }

    /// Returns whether the edge from a vertex of an operand leads into the other's inside; `None` if the other does not
    /// pass here.
    pub fn inside(&self, k: usize, vertex: usize, grown: bool) -> Option<bool> {
        let x = self.passages[k].iter().find(|p| p.vertex == vertex)?.to;
        let rays = self.passages[1 - k].iter().flat_map(|p| [(p.to, true), (p.from, false)]);
        let mut nearest: Option<(DVec2, bool)> = None;
        for (ray, goes) in rays {
            if ray == x {
                let subject = if goes { !grown } else { grown };
                return Some(if k == 0 { subject } else { grown });
            }
            // The first clockwise: a departing edge has its inside there.
            if nearest.is_none_or(|(other, _)| in_sector(self.at, other, ray, x)) {
                nearest = Some((ray, goes));
            }
        }
        nearest.map(|(_, goes)| goes)
    }

    /// Adds two linked vertices for every crossing.
    pub fn link(&self, lists: &mut [Lists; 2], grown: bool) {
        let [ours, theirs] = &self.passages;
        let mut crossings: Vec<[usize; 2]> = Vec::new();
        for (i, s) in ours.iter().enumerate() {
            for (j, c) in theirs.iter().enumerate() {
                let [comes, goes] = self.sides(s, c, grown);
                if comes != goes {
                    crossings.push([i, j]);
                }
            }
        }
        if crossings.is_empty() {
            return;
        }
        let mut vertices = vec![[0; 2]; crossings.len()];
        for k in 0..2 {
            for (i, passage) in self.passages[k].iter().enumerate() {
                let mut met: Vec<usize> =
                    (0..crossings.len()).filter(|&n| crossings[n][k] == i).collect();
                let before = |&m: &usize, &n: &usize| {
                    let other = |n: usize| &self.passages[1 - k][crossings[n][1 - k]];
                    self.is_before([k, i], other(m), other(n), grown)
                };
                for end in 1..met.len() {
                    let place = (0..end).find(|&at| before(&met[end], &met[at])).unwrap_or(end);
                    met[place..=end].rotate_right(1);
                }
                let mut v = passage.vertex;
                for (nth, &n) in met.iter().enumerate() {
                    if nth > 0 {
                        v = lists[k].insert(v, self.at);
                    }
                    vertices[n][k] = v;
                }
            }
        }
        for (&[i, j], &pair) in crossings.iter().zip(&vertices) {
            let [_, enters] = self.sides(&ours[i], &theirs[j], grown);
            join(lists, pair, enters);
        }
    }

    /// Returns whether a passage crosses one of two others first: it arrives on the side away from the second.
    fn is_before(&self, [k, i]: [usize; 2], m: &Passage, n: &Passage, grown: bool) -> bool {
        let own = &self.passages[k][i];
        let [_, goes] = if k == 0 {
            self.sides(own, m, grown)
        } else {
            // The clip is on the subject's left where the subject is on its right, and vice versa.
            let [comes, _] = self.sides(m, own, grown);
            [false, comes]
        };
        self.is_left(m, n.to) == goes
    }
}
