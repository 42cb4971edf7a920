//! Places where edges and faces meet on the page, and which of them is nearer to the eye.

use super::{FaceNet, NetFace, side};
use crate::math::{DVec3, in_sector};

/// A place where a line runs across an edge on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Parameter on the page, from the line's first corner to its second.
    pub t: f64,
    /// True if the edge is nearer to the eye there than the line.
    pub nearer: bool,
    /// True if the line comes to the left side of the edge, as its corners are numbered.
    pub leftward: bool,
}

/// A place where a line goes through a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pierce {
    /// Parameter on the page, from the line's first corner to its second.
    pub t: f64,
    /// True if the line goes from the eye's side of the face to the other one.
    pub goes_behind: bool,
}

impl FaceNet {
    /// Returns where the line between two corners crosses an edge that begins at neither of them.
    pub(crate) fn crossing(&self, line: [usize; 2], edge: usize) -> Option<Crossing> {
        let ends = self.edges[edge].corners;
        if ends.iter().any(|end| line.contains(end)) {
            return None;
        }
        let [p, q] = line.map(|corner| self.points[corner]);
        let [a, b] = ends.map(|corner| self.points[corner]);
        let [of_a, of_b] = [side(p, q, a), side(p, q, b)];
        let [of_p, of_q] = [side(a, b, p), side(a, b, q)];
        // An end on the other line belongs to its right side, so that chains of edges are crossed once.
        if (of_a > 0.0) == (of_b > 0.0) || (of_p > 0.0) == (of_q > 0.0) {
            return None;
        }
        let (t, u) = (of_p / (of_p - of_q), of_a / (of_a - of_b));
        let [depth, other] = [p.z + t * (q.z - p.z), a.z + u * (b.z - a.z)];
        Some(Crossing { t, nearer: other < depth - self.small, leftward: of_q > 0.0 })
    }

    /// Returns where the line between two corners goes through a face that has neither of them.
    pub(crate) fn pierce(&self, line: [usize; 2], face: usize) -> Option<Pierce> {
        let own = &self.faces[face];
        if own.ring.iter().any(|corner| line.contains(corner)) {
            return None;
        }
        let [p, q] = line.map(|corner| self.points[corner]);
        let [from, to] = [p, q].map(|point| own.height(point));
        let on = |height: f64| height.abs() <= self.small;
        if on(from) || on(to) || (from > 0.0) == (to > 0.0) {
            return None;
        }
        let t = from / (from - to);
        self.covers(own, p.lerp(q, t)).then_some(Pierce { t, goes_behind: to < 0.0 })
    }

    /// Returns the faces that hide a corner, without those that it belongs to.
    pub(crate) fn faces_before(&self, corner: usize) -> Vec<usize> {
        let point = self.points[corner];
        let hides = |face: &usize| {
            let own = &self.faces[*face];
            let is_behind = own.height(point) < -self.small;
            self.is_hider(*face)
                && is_behind
                && !own.ring.contains(&corner)
                && self.covers(own, point)
        };
        (0..self.faces.len()).filter(hides).collect()
    }

    /// Returns the faces at a corner that hide the beginning of the line from there to another corner; those that the
    /// line belongs to do not.
    pub(crate) fn faces_over(&self, line @ [from, to]: [usize; 2]) -> Vec<usize> {
        let hides = |face: &usize| {
            let own = &self.faces[*face];
            self.is_hider(*face) && own.ring.contains(&from) && !own.has(line) && {
                own.height(self.points[to]) < -self.small && self.is_over(own, from, to)
            }
        };
        (0..self.faces.len()).filter(hides).collect()
    }

    /// Returns whether the angle of a face at its corner `from` has the direction to `to` in it.
    fn is_over(&self, face: &NetFace, from: usize, to: usize) -> bool {
        let (ring, count) = (&face.ring, face.ring.len());
        let place = |corner: usize| self.points[corner].truncate();
        let positions = (0..count).filter(|k| ring[*k] == from);
        let mut angles = positions.map(|k| [ring[(k + count - 1) % count], ring[(k + 1) % count]]);
        angles.any(|[before, after]| {
            // Fronts run counter-clockwise on the page.
            let [right, left] = if face.front { [after, before] } else { [before, after] };
            in_sector(place(from), place(right), place(to), place(left))
        })
    }

    /// Returns whether a face covers a point of the page, by the even-odd rule.
    fn covers(&self, face: &NetFace, point: DVec3) -> bool {
        let ends = face.edges.iter().map(|edge| self.edges[*edge].corners);
        let right = ends.filter(|corners| {
            let [a, b] = corners.map(|corner| self.points[corner]);
            let is_upward = b.y > a.y;
            (a.y > point.y) != (b.y > point.y) && (side(a, b, point) > 0.0) == is_upward
        });
        right.count() % 2 == 1
    }

    /// Returns whether the left side of an edge of a face, as the edge's corners are numbered, is in the face on the
    /// page.
    pub(crate) fn is_left_of(&self, face: usize, edge: usize) -> bool {
        let own = &self.faces[face];
        let [a, b] = self.edges[edge].corners;
        let count = own.ring.len();
        let runs_along = (0..count).any(|k| [own.ring[k], own.ring[(k + 1) % count]] == [a, b]);
        runs_along == own.front
    }
}

impl NetFace {
    /// Returns the numbers of the edges: the first one from the first corner to the second.
    pub(crate) fn edges(&self) -> &[usize] {
        &self.edges
    }

    /// Returns the distance of a point of the page from the plane, positive on the eye's side.
    fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point - self.center)
    }

    /// Returns whether two corners are those of one edge.
    fn has(&self, [a, b]: [usize; 2]) -> bool {
        let mut ends = self.ring.iter().zip(self.ring.iter().cycle().skip(1));
        ends.any(|(p, q)| [*p, *q] == [a, b] || [*p, *q] == [b, a])
    }
}
