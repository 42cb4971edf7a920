//! The triangles that meet at each edge.

use super::Faces;
use crate::target::drawing::EdgeCount;

/// One triangle at an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeSide {
    other: u32,
    packed: u32,
}

impl EdgeSide {
    fn new(item: u32, a: u32, b: u32) -> Self {
        Self { other: a.max(b), packed: item << 1 | u32::from(a < b) }
    }

    /// Returns the triangle.
    #[inline]
    pub(crate) fn item(self) -> u32 {
        self.packed >> 1
    }

    /// Returns whether the triangle runs through the edge from the smaller to the larger vertex
    /// number: the triangle is then to the left of that direction, seen from its front.
    #[inline]
    pub(crate) fn forward(self) -> bool {
        self.packed & 1 == 1
    }
}

/// All edges of the faces, with the triangles at each.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Edges {
    /// Start of each vertex's sides; one more at the end.
    starts: Vec<u32>,
    /// Sides by smaller vertex, then larger vertex, then item.
    sides: Vec<EdgeSide>,
}

impl Edges {
    /// Finds the edges of those triangles that `filter` lets through. O(n) for vertices of bounded
    /// degree: sides are counted into the lists of their smaller vertices and sorted there.
    pub fn new(faces: &Faces, filter: impl Fn(u32) -> bool) -> Self {
        let mut starts = vec![0u32; faces.points().len() + 1];
        for (item, t) in faces.triangles() {
            if filter(item) {
                faces.each_side(item, t, |a, b| starts[a.min(b) as usize] += 1);
            }
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        // Filled from the end, so that each start reaches its place and items stay in order.
        let mut sides = vec![EdgeSide { other: 0, packed: 0 }; sum as usize];
        for item in (0..faces.len() as u32).rev() {
            let Some(t) = faces.triangle(item).filter(|_| filter(item)) else { continue };
            faces.each_side(item, t, |a, b| {
                let start = &mut starts[a.min(b) as usize];
                *start -= 1;
                sides[*start as usize] = EdgeSide::new(item, a, b);
            });
        }
        for w in starts.windows(2) {
            sides[w[0] as usize..w[1] as usize].sort_unstable();
        }
        Self { starts, sides }
    }

    /// Returns the edges after changes of some triangles, given in item order. If they are few, that costs less than
    /// finding all edges again.
    pub(super) fn renewed(self, faces: &Faces, changed: &[u32]) -> Self {
        let mut is_changed = vec![false; faces.len()];
        changed.iter().for_each(|item| is_changed[*item as usize] = true);
        self.with(faces, changed, |item| (!is_changed[item as usize]).then_some(item))
    }

    /// Returns the edges of faces some of whose triangles are divided: `origins` has, for each item, the item that it
    /// was part of, in order.
    pub(super) fn divided(&self, faces: &Faces, origins: &[u32]) -> Self {
        let before = origins.last().map_or(0, |last| *last as usize + 1);
        let mut number = vec![None; before];
        let (mut parts, mut item) = (Vec::new(), 0);
        for of_one in origins.chunk_by(|a, b| a == b) {
            match of_one {
                [whole] => number[*whole as usize] = Some(item),
                _ => parts.extend(item..item + of_one.len() as u32),
            }
            item += of_one.len() as u32;
        }
        self.with(faces, &parts, |item| number.get(item as usize).copied().flatten())
    }

    /// Returns the edges with the triangles `new`, in item order, and those old ones that have a `number` now, which
    /// keeps their order.
    fn with(&self, faces: &Faces, new: &[u32], number: impl Fn(u32) -> Option<u32>) -> Self {
        if new.len() > faces.len() / 4 {
            return Self::new(faces, |_| true);
        }
        let triangles = new.iter().filter_map(|item| Some((*item, faces.triangle(*item)?)));
        let mut new: Vec<(u32, EdgeSide)> = Vec::new();
        for (item, t) in triangles {
            faces.each_side(item, t, |a, b| new.push((a.min(b), EdgeSide::new(item, a, b))));
        }
        new.sort_unstable();
        let renumbered = |side: &EdgeSide| {
            let packed = number(side.item())? << 1 | side.packed & 1;
            Some(EdgeSide { packed, ..*side })
        };
        let mut new = new.into_iter().peekable();
        let vertices = faces.points().len();
        let mut starts = Vec::with_capacity(vertices + 1);
        let mut sides = Vec::with_capacity(self.sides.len() + new.len());
        for v in 0..vertices as u32 {
            let first = sides.len();
            starts.push(first as u32);
            sides.extend(self.of_vertex(v).iter().filter_map(renumbered));
            let kept = sides.len();
            sides.extend(std::iter::from_fn(|| new.next_if(|n| n.0 == v)).map(|n| n.1));
            if sides.len() > kept {
                sides[first..].sort_unstable();
            }
        }
        starts.push(sides.len() as u32);
        Self { starts, sides }
    }

    /// Returns the number of edges, and of those with one triangle only.
    pub fn count(&self) -> EdgeCount {
        let mut count = EdgeCount::default();
        for (_, sides) in self.iter() {
            count.edges += 1;
            count.borders += u64::from(sides.len() == 1);
        }
        count
    }

    /// Returns the edges with one triangle, which comes with them.
    pub(super) fn borders(&self) -> impl Iterator<Item = ([u32; 2], u32)> + '_ {
        self.iter().filter_map(|(ends, sides)| match sides {
            [side] => Some((ends, side.item())),
            _ => None,
        })
    }

    /// Returns each edge once: its vertices, the smaller first, and the triangles at it in item
    /// order.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], &[EdgeSide])> + '_ {
        self.of_vertices(0..self.starts.len().saturating_sub(1) as u32)
    }

    /// Returns the triangle at the other side of an edge of two triangles with the same orientation.
    pub(in crate::visibility) fn across(&self, ends: [u32; 2], item: u32) -> Option<u32> {
        match self.at([ends[0].min(ends[1]), ends[0].max(ends[1])]) {
            [a, b] if a.forward() != b.forward() => {
                Some(if a.item() == item { b.item() } else { a.item() })
            }
            _ => None,
        }
    }

    /// Returns the sides whose smaller vertex is this one.
    fn of_vertex(&self, vertex: u32) -> &[EdgeSide] {
        match self.starts.get(vertex as usize..).and_then(|s| s.first_chunk::<2>()) {
            Some([from, to]) => &self.sides[*from as usize..*to as usize],
            None => &[],
        }
    }

    /// Returns the triangles at the edge between two vertices, the smaller first; none if there is no
    /// such edge.
    pub(crate) fn at(&self, [a, b]: [u32; 2]) -> &[EdgeSide] {
        let sides = self.of_vertex(a);
        let start = sides.partition_point(|s| s.other < b);
        let end = sides.partition_point(|s| s.other <= b);
        &sides[start..end]
    }

    /// Returns the edges whose smaller vertex lies in a range.
    pub(crate) fn of_vertices(
        &self,
        vertices: std::ops::Range<u32>,
    ) -> impl Iterator<Item = ([u32; 2], &[EdgeSide])> + '_ {
        let of = |v: u32| {
            let edges = self.of_vertex(v).chunk_by(|a, b| a.other == b.other);
            edges.map(move |s| ([v, s[0].other], s))
        };
        let end = vertices.end.min(self.starts.len().saturating_sub(1) as u32);
        (vertices.start..end).flat_map(of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::scene::{Instance, Mesh, Scene};

    #[test]
    fn edges_of_divided_faces_are_those_that_are_found_anew() {
        let strip = |i: u32| {
            let at = |k: u32| Vec3::new((k / 2) as f32, (k % 2) as f32, 0.0);
            if i.is_multiple_of(2) {
                [at(i), at(i + 2), at(i + 1)]
            } else {
                [at(i), at(i + 1), at(i + 2)]
            }
        };
        let positions = (0..24).flat_map(strip).collect();
        let scene = Scene {
            meshes: vec![Mesh { positions, ..Mesh::default() }],
            instances: vec![Instance::of(0)],
            ..Scene::default()
        };
        let faces = Faces::new(&scene).expect("faces");
        let edges = Edges::new(&faces, |_| true);
        let [a, b, c] = faces.triangle(5).expect("a triangle");
        let mut points = faces.points().to_vec();
        points.push(points[a as usize].midpoint(points[b as usize]));
        let middle = points.len() as u32 - 1;
        let [d, e, f] = faces.triangle(9).expect("a triangle");
        let parts = [(5, [a, middle, c]), (5, [middle, b, c]), (9, [d, e, f]), (9, [f, e, d])];
        let (mut refined, origins) = faces.refined(&edges, points, &parts);
        assert_eq!(origins.len(), 26);
        let taken = refined.take_edges();
        assert_eq!(taken, Edges::new(&refined, |_| true));
        assert_eq!(taken.at([c.min(middle), c.max(middle)]).len(), 2);
    }
}
