//! Polygons in one flat buffer: points, where each ring ends, where each polygon ends.

use super::Vertex;
use crate::math::{DVec2, Rect};

/// A closed curve of straight edges; the edge from the last point to the first is implied.
///
/// Units and space are the caller's; orientations are for y up.
pub type Ring = [DVec2];

/// Returns the shoelace sum: the signed area of a ring, positive where it runs counter-clockwise (y
/// up), in squared units of its coordinates.
///
/// Taken relative to the first point, so that small rings far from the origin keep their digits.
pub fn signed_area<P: Vertex>(ring: &[P]) -> f64 {
    let Some((&origin, rest)) = ring.split_first() else { return 0.0 };
    let from = |p: P| p.minus(origin);
    let twice: f64 = rest.windows(2).map(|w| from(w[0]).perp_dot(from(w[1]))).sum();
    twice * 0.5
}

/// Any number of polygons, each an outer ring with its holes, in one flat buffer.
///
/// Shapes from a file may be a mere list of rings: then each ring is its own polygon. Rings are open: the first point
/// is not repeated at the end. Points are [`DVec2`], or [`I64Vec2`](crate::math::I64Vec2) where all coordinates are
/// whole numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shapes<P = DVec2> {
    points: Vec<P>,
    ring_ends: Vec<usize>,
    polygon_ends: Vec<usize>,
}

impl<P> Shapes<P> {
    /// Creates an empty set of polygons.
    pub const fn new() -> Self {
        Self { points: Vec::new(), ring_ends: Vec::new(), polygon_ends: Vec::new() }
    }

    /// Creates a set of polygons from all points, the end of each ring among them, and the end of each polygon among
    /// the rings.
    pub(crate) const fn from_parts(
        points: Vec<P>,
        ring_ends: Vec<usize>,
        polygon_ends: Vec<usize>,
    ) -> Self {
        Self { points, ring_ends, polygon_ends }
    }

    /// Adds a ring to the polygon being built: first its outer ring, then its holes.
    pub fn push_ring(&mut self, ring: impl IntoIterator<Item = P>) {
        self.points.extend(ring);
        self.ring_ends.push(self.points.len());
    }

    /// Ends the polygon being built; does nothing if it has no ring.
    pub fn end_polygon(&mut self) {
        if self.polygon_ends.last().copied().unwrap_or(0) < self.ring_ends.len() {
            self.polygon_ends.push(self.ring_ends.len());
        }
    }

    /// Removes all polygons; the memory stays.
    pub fn clear(&mut self) {
        self.points.clear();
        self.ring_ends.clear();
        self.polygon_ends.clear();
    }

    /// Returns all points, ring after ring.
    pub fn points(&self) -> &[P] {
        &self.points
    }

    /// Returns all points, to be moved in place.
    pub fn points_mut(&mut self) -> &mut [P] {
        &mut self.points
    }

    /// Returns the number of rings in all polygons.
    pub fn ring_count(&self) -> usize {
        self.ring_ends.len()
    }

    /// Returns all rings, polygon after polygon.
    pub fn rings(&self) -> impl ExactSizeIterator<Item = &[P]> {
        (0..self.ring_ends.len()).map(|i| self.ring(i))
    }

    /// Returns the indices into [`Shapes::points`] of a ring; empty if there is no such ring.
    pub fn ring_range(&self, index: usize) -> std::ops::Range<usize> {
        let Some(&end) = self.ring_ends.get(index) else { return 0..0 };
        let start = index.checked_sub(1).and_then(|i| self.ring_ends.get(i)).copied();
        start.unwrap_or(0)..end
    }

    /// Returns a ring by its index over all polygons; empty if there is none.
    pub fn ring(&self, index: usize) -> &[P] {
        self.points.get(self.ring_range(index)).unwrap_or_default()
    }

    /// Returns the index of the point that follows a point on its ring, around its end.
    pub(crate) fn next_point(&self, index: usize) -> usize {
        let ring = self.ring_ends.partition_point(|&end| end <= index);
        let range = self.ring_range(ring);
        if index + 1 < range.end { index + 1 } else { range.start }
    }

    /// Returns the index of the point that precedes a point on its ring, around its start.
    pub(crate) fn previous_point(&self, index: usize) -> usize {
        let ring = self.ring_ends.partition_point(|&end| end <= index);
        let range = self.ring_range(ring);
        if index > range.start { index - 1 } else { range.end.saturating_sub(1) }
    }

    /// Returns the number of polygons; rings after the last [`Shapes::end_polygon`] are in none.
    pub fn polygon_count(&self) -> usize {
        self.polygon_ends.len()
    }

    /// Returns all polygons.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = Polygon<'_, P>> {
        (0..self.polygon_ends.len()).map(move |i| {
            let start = i.checked_sub(1).map_or(0, |before| self.polygon_ends[before]);
            Polygon { shapes: self, start, end: self.polygon_ends[i] }
        })
    }

    /// Returns whether there is no point at all.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Adds all polygons of another collection.
    pub fn append(&mut self, other: &Self)
    where
        P: Copy,
    {
        for polygon in other.polygons() {
            for ring in polygon.rings() {
                self.push_ring(ring.iter().copied());
            }
            self.end_polygon();
        }
    }
}

impl<P: Vertex> Shapes<P> {
    /// Returns each ring as a separate polygon.
    pub fn from_rings<R: AsRef<[P]>>(rings: impl IntoIterator<Item = R>) -> Self {
        let mut shapes = Self::new();
        for ring in rings {
            shapes.push_ring(ring.as_ref().iter().copied());
            shapes.end_polygon();
        }
        shapes
    }

    /// Returns the sum of the signed areas of all rings: the area of the region where the shapes
    /// are valid.
    pub fn area(&self) -> f64 {
        self.rings().map(signed_area).sum()
    }
}

impl Shapes {
    /// Returns the smallest rectangle around all finite points; `None` if there is none.
    pub fn bounds(&self) -> Option<Rect> {
        Rect::around(self.points.iter().copied())
    }
}

/// One polygon of [`Shapes`]: an outer ring and its holes.
#[derive(Debug, Clone, Copy)]
pub struct Polygon<'a, P = DVec2> {
    shapes: &'a Shapes<P>,
    start: usize,
    end: usize,
}

impl<'a, P> Polygon<'a, P> {
    /// Returns the outer ring.
    pub fn outer(&self) -> &'a [P] {
        self.shapes.ring(self.start)
    }

    /// Returns the holes.
    pub fn holes(&self) -> impl ExactSizeIterator<Item = &'a [P]> {
        let shapes = self.shapes;
        (self.start + 1..self.end).map(move |i| shapes.ring(i))
    }

    /// Returns the outer ring, then the holes.
    pub fn rings(&self) -> impl ExactSizeIterator<Item = &'a [P]> {
        let shapes = self.shapes;
        (self.start..self.end).map(move |i| shapes.ring(i))
    }

    /// Returns the indices of its rings, as [`Shapes::ring`] takes them.
    pub fn ring_indices(&self) -> std::ops::Range<usize> {
        self.start..self.end
    }

    /// Returns the sum of the signed areas of its rings.
    pub fn area(&self) -> f64
    where
        P: Vertex,
    {
        self.rings().map(signed_area).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, size: f64) -> [DVec2; 4] {
        [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)].map(|(a, b)| DVec2::new(x + a, x + b))
    }

    #[test]
    fn flat_buffer_keeps_rings_and_polygons() {
        let mut shapes = Shapes::new();
        shapes.push_ring(square(0.0, 4.0));
        shapes.push_ring(square(1.0, 1.0).into_iter().rev());
        shapes.end_polygon();
        shapes.push_ring(square(9.0, 1.0));
        shapes.end_polygon();
        shapes.end_polygon();
        assert_eq!((shapes.polygon_count(), shapes.ring_count()), (2, 3));
        let areas: Vec<f64> = shapes.polygons().map(|p| p.area()).collect();
        assert_eq!(areas, [15.0, 1.0]);
        assert_eq!(shapes.polygons().next().map(|p| p.holes().len()), Some(1));
        assert_eq!(shapes.ring(7).len(), 0);
    }
}
