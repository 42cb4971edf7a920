//! Creases that fade out.
//!
//! Where two surfaces meet at an angle that decreases to zero, as a pipe and its elbow may, the line between them
//! begins as a crease and ends as a bend like others of the mesh. It differs from those in the part of its turn that
//! the surfaces beside it do not explain: on a smooth surface, an edge turns by half of the bends of the facets on both
//! sides. As in Andreas Hubeli and Markus Gross, *Multiresolution feature extraction for unstructured meshes*, IEEE
//! Visualization 2001, edges are weighted by more than their own two faces, and kept by hysteresis: a line begins at a
//! sharp corner with an edge that clearly does not belong to the surface, follows its smoothest continuation while it
//! fades, and must end at another sharp corner, because a coarse mesh loses it on the way. O(k) for k edges that may be
//! the first.

use super::vertex_normals::{Directions, direction};
use crate::math::{DVec3, by_coordinates};
use crate::visibility::object::{Edges, Faces};

/// The cosine of 15°: the first edge of a line turns by more.
pub(super) const FIRST_COSINE: f64 = 0.965_93;

/// The part in radians of the first edge's turn that the surface does not explain, 10°, and of the others', 3°: blunter
/// edges are ignored, for files have rounded coordinates.
const FIRST: f64 = 0.175;
const OTHERS: f64 = 0.052;

/// An edge that turns by less than this many times what the surface explains is a facet's.
const CLEAR: f64 = 2.0;

/// The turn from which an edge is no clearer than others, 40°: its direction decides.
const CLEAREST: f64 = 0.7;

/// The least part of a line along which its edges are clear.
const CLEAR_PART: f64 = 1.0 / 3.0;

/// The part of the first edge's turn that the last one may have: a line that does not fade is one of facets.
const FADED: f64 = 0.6;

/// The cosine of the angle up to which a line continues in the next edge: 15°.
const ON: f64 = 0.966;

/// The turn of an edge that makes up for an angle at which it leaves the line, as a part of that.
const ASIDE: f64 = 2.0;

/// The cosine of the angle up to which a sliver's side runs along its longest, 8°, and the least part of its turn that
/// the longest side then has.
const ALONG: f64 = 0.990;
const AS_MUCH: f64 = 0.8;

/// Edges that a line may have: surveys have longer ones, but no corners at their ends.
const LONGEST: usize = 256;

/// A vertex of more edges is a hub, through which no line runs.
const HUB: usize = 64;

/// An edge, the smaller vertex first.
type Ends = [u32; 2];

/// Surface on which creases fade.
pub(super) struct Fading<'a> {
    pub faces: &'a Faces,
    pub edges: &'a Edges,
    /// With creases from the angle on that no facet turns by.
    pub directions: &'a Directions<'a>,
    /// Number of sharp edges at each vertex.
    pub sharp: &'a [u8],
}

/// A line of edges from a corner on.
struct Line {
    vertices: Vec<u32>,
    length: f64,
    /// Length of its clear edges.
    clear: f64,
    convex: bool,
    /// The turn of its last edge that is like that of its first, radians.
    last: f64,
}

/// The turn of the surface at an edge.
struct Turn {
    /// In radians, above 0 where the surface is convex.
    angle: f64,
    /// The part of it that the surfaces at both sides do not explain.
    unexplained: f64,
    /// True if the edge is a side of a sliver that runs along its longest, which turns about as much: the sliver lies
    /// along the line, which is its longest side, and its apex beside it.
    is_of_sliver: bool,
}

impl Turn {
    fn is_clear(&self) -> bool {
        let explained = self.angle.abs() - self.unexplained;
        self.unexplained >= OTHERS && self.angle.abs() >= CLEAR * explained
    }
}

impl Fading<'_> {
    /// Returns the edges of lines that begin with some of these, in order.
    pub fn creases(&self, first: &[Ends]) -> Vec<Ends> {
        let both = first.iter().flat_map(|&[a, b]| [[a, b], [b, a]]);
        let from_corners = both
            .filter(|[from, to]| self.sharp[*from as usize] > 0 && self.sharp[*to as usize] == 0);
        let lines = from_corners.filter_map(|[from, to]| self.line(from, to));
        let mut found: Vec<Ends> =
            apart(lines.collect()).iter().flat_map(|line| edges(line)).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Returns the vertices of the line that begins with an edge, if it is a crease.
    fn line(&self, from: u32, to: u32) -> Option<Vec<u32>> {
        let first = self.turn(sorted(from, to))?;
        if first.unexplained < FIRST || !first.is_clear() || first.is_of_sliver {
            return None;
        }
        let length = self.along(from, to).length();
        let vertices = vec![from, to];
        let convex = first.angle > 0.0;
        let mut line = Line { vertices, length, clear: length, convex, last: first.angle.abs() };
        // Where a single one ends, nothing holds a line.
        while self.sharp[*line.vertices.last()? as usize] < 2 {
            if line.vertices.len() > LONGEST {
                return None;
            }
            self.go_on(&mut line)?;
        }
        let fades = line.last <= FADED * first.angle.abs();
        (fades && line.clear >= CLEAR_PART * line.length).then_some(line.vertices)
    }

    /// Adds the next edge to a line, if one continues it.
    fn go_on(&self, line: &mut Line) -> Option<()> {
        let [.., before, at] = line.vertices[..] else { return None };
        let last = self.along(before, at);
        let straight = last.try_normalize()?;
        // Half the curvature at the vertex before.
        let bend = match line.vertices[..] {
            [.., first, _, _] => {
                let earlier = self.along(first, before);
                let lengths = last.length() + earlier.length();
                (straight - earlier.normalize_or_zero()) / lengths
            }
            _ => DVec3::ZERO,
        };
        let mut best: Option<(f64, u32, Option<Turn>)> = None;
        for next in self.around(before, at)? {
            let step = self.along(at, next);
            let (length, Some(way)) = (step.length(), step.try_normalize()) else { continue };
            if way.dot(straight) < ON || line.vertices.contains(&next) {
                continue;
            }
            let turn = self.turn(sorted(at, next)).filter(|t| (t.angle > 0.0) == line.convex);
            if turn.as_ref().is_some_and(|t| t.angle.abs() >= OTHERS && t.is_of_sliver) {
                continue;
            }
            let expected = straight + bend * (last.length() + length);
            let unexplained = turn.as_ref().map_or(0.0, |t| t.unexplained.min(CLEAREST));
            let off = ASIDE * way.distance(expected.normalize_or_zero()) - unexplained;
            let point = |v: u32| &self.faces.points()[v as usize];
            let better = |b: &(f64, u32, Option<Turn>)| {
                off.total_cmp(&b.0).then_with(|| by_coordinates(point(next), point(b.1))).is_lt()
            };
            if best.as_ref().is_none_or(better) {
                best = Some((off, next, turn));
            }
        }
        let (_, next, turn) = best?;
        let length = self.along(at, next).length();
        line.length += length;
        line.clear += if turn.as_ref().is_some_and(Turn::is_clear) { length } else { 0.0 };
        line.last = turn.map_or(0.0, |t| t.angle.abs());
        line.vertices.push(next);
        Some(())
    }

    /// Returns the vertices that have an edge to one, without one of them; none at a border, or at a hub.
    fn around(&self, without: u32, vertex: u32) -> Option<Vec<u32>> {
        let first = self.edges.at(sorted(without, vertex)).first()?.item();
        let (mut item, mut at, mut found) = (first, without, Vec::new());
        while found.len() < HUB {
            at = self.faces.triangle(item)?.into_iter().find(|v| *v != vertex && *v != at)?;
            if at == without {
                return Some(found);
            }
            found.push(at);
            item = self.edges.across([vertex, at], item)?;
        }
        None
    }

    /// Returns the turn of an edge; `None` if there is no surface.
    fn turn(&self, ends: Ends) -> Option<Turn> {
        let (angle, items) = self.angle(ends)?;
        let explained = items.map(|item| {
            let (width, curvature) = self.directions.next_bend(ends, item);
            width * curvature.unwrap_or(0.0)
        });
        let explained = ((explained[0] + explained[1]) / 2.0 * angle.signum()).max(0.0);
        Some(Turn {
            angle,
            unexplained: (angle.abs() - explained).max(0.0),
            is_of_sliver: items.into_iter().any(|item| self.is_of_sliver(ends, item, angle)),
        })
    }

    /// Returns the angle of an edge, as [`Turn`] has it, and its triangles.
    fn angle(&self, ends: Ends) -> Option<(f64, [u32; 2])> {
        let [a, b] = self.edges.at(ends) else { return None };
        let (item, other) = (a.item(), b.item());
        if a.forward() == b.forward() {
            return None;
        }
        let apex = self.faces.triangle(other)?.into_iter().find(|v| !ends.contains(v))?;
        let normal = self.directions.of(item);
        let height = normal.dot(self.along(ends[0], apex));
        // A chord of the angle.
        let turn = normal.distance(self.directions.of(other));
        Some((if height < 0.0 { turn } else { -turn }, [item, other]))
    }

    /// Returns whether an edge, which turns by an angle, is a side of a sliver; see [`Turn::is_of_sliver`].
    fn is_of_sliver(&self, ends: Ends, item: u32, angle: f64) -> bool {
        let is_sliver = self.faces.corners(item).is_some_and(|corners| direction(corners).1);
        let Some([a, b, c]) = self.faces.triangle(item).filter(|_| is_sliver) else { return false };
        let sides = [sorted(a, b), sorted(b, c), sorted(c, a)];
        let way = |[a, b]: Ends| self.along(a, b);
        let length = |ends: &Ends| way(*ends).length_squared();
        let longest = sides.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        let Some(longest) = longest.filter(|longest| *longest != ends) else { return false };
        let [own, other] = [ends, longest].map(|ends| way(ends).normalize_or_zero());
        own.dot(other).abs() > ALONG
            && self.angle(longest).is_some_and(|turn| turn.0.abs() >= AS_MUCH * angle.abs())
    }

    fn along(&self, from: u32, to: u32) -> DVec3 {
        self.faces.points()[to as usize] - self.faces.points()[from as usize]
    }
}

/// Returns the lines of which no other one passes a vertex between their ends: on a mesh so coarse that lines cross,
/// they cannot be told from facets.
fn apart(mut lines: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
    for line in &mut lines {
        if line.first() > line.last() {
            line.reverse();
        }
    }
    lines.sort_unstable();
    lines.dedup();
    let between = |line: &[u32]| line.get(1..line.len() - 1).unwrap_or_default().to_vec();
    let mut passed: Vec<u32> = lines.iter().flat_map(|line| between(line)).collect();
    passed.sort_unstable();
    let times = |v: u32| passed.partition_point(|p| *p <= v) - passed.partition_point(|p| *p < v);
    lines.retain(|line| between(line).into_iter().all(|v| times(v) == 1));
    lines
}

/// Returns the edges of a line.
fn edges(line: &[u32]) -> impl Iterator<Item = Ends> {
    line.windows(2).map(|ends| sorted(ends[0], ends[1]))
}

fn sorted(a: u32, b: u32) -> Ends {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_cross_are_left_out() {
        // The second one is the first from its other end; the last two meet in vertex 8.
        let lines =
            vec![vec![1, 2, 3], vec![3, 2, 1], vec![4, 5], vec![6, 8, 9], vec![11, 8, 10, 7]];
        assert_eq!(apart(lines), [vec![1, 2, 3], vec![4, 5]]);
        assert_eq!(apart(vec![vec![1, 2, 3], vec![1, 4, 3]]).len(), 2);
    }
}
