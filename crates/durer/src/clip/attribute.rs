//! The sources of a clipped shape's vertices, and values carried along: height, measure, colour,
//! texture coordinates, any tuple of numbers.
//!
//! Clippers do not touch attributes; they return the source of every output vertex, from which [`interpolate`] or any
//! callback computes the new values. Callers without attributes pay nothing.

use crate::math::DVec2;

/// Source of an output vertex; indices count the points of the input's flat buffer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VertexSource {
    /// An input point, bit for bit.
    Vertex(usize),
    /// A cut of the edge between two input points.
    Cut {
        /// The edge's first point.
        from: usize,
        /// The edge's last point.
        to: usize,
        /// 0 at `from`, 1 at `to`.
        t: f64,
    },
    /// A corner of the window, inside the shape or on its border.
    Corner,
}

impl VertexSource {
    /// Returns the source of a point on the edge between two input points, each given by index and
    /// place.
    pub(crate) fn on_edge(
        point: DVec2,
        (from, a): (usize, DVec2),
        (to, b): (usize, DVec2),
    ) -> Self {
        if point == a {
            return Self::Vertex(from);
        }
        if point == b {
            return Self::Vertex(to);
        }
        // Along the axis on which the edge is longer; quarters because a difference may overflow.
        let (a, b, p) = (a * 0.25, b * 0.25, point * 0.25);
        let d = b - a;
        let t = if d.x.abs() > d.y.abs() { (p.x - a.x) / d.x } else { (p.y - a.y) / d.y };
        Self::Cut { from, to, t }
    }
}

/// A tracer for the sources of output vertices: `Vec<Source>`, or [`NoSources`].
pub(crate) trait Provenance: Default {
    /// Adds the source of the next vertex.
    fn push(&mut self, source: impl FnOnce() -> VertexSource);
    /// Adds input points, one after the other.
    fn push_vertices(&mut self, range: std::ops::Range<usize>);
    /// Adds a range of another list.
    fn push_range(&mut self, other: &Self, range: std::ops::Range<usize>);
    /// Adds a range of this list once more.
    fn repeat(&mut self, range: std::ops::Range<usize>);
    /// Removes everything from a length on.
    fn truncate(&mut self, length: usize);
}

/// Sources that keep nothing and cost nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct NoSources;

impl Provenance for NoSources {
    #[inline(always)]
    fn push(&mut self, _source: impl FnOnce() -> VertexSource) {}
    #[inline(always)]
    fn push_vertices(&mut self, _range: std::ops::Range<usize>) {}
    #[inline(always)]
    fn push_range(&mut self, _other: &Self, _range: std::ops::Range<usize>) {}
    #[inline(always)]
    fn repeat(&mut self, _range: std::ops::Range<usize>) {}
    #[inline(always)]
    fn truncate(&mut self, _length: usize) {}
}

impl Provenance for Vec<VertexSource> {
    fn push(&mut self, source: impl FnOnce() -> VertexSource) {
        self.push(source());
    }

    fn push_vertices(&mut self, range: std::ops::Range<usize>) {
        self.extend(range.map(VertexSource::Vertex));
    }

    fn push_range(&mut self, other: &Self, range: std::ops::Range<usize>) {
        self.extend_from_slice(other.get(range).unwrap_or_default());
    }

    fn repeat(&mut self, range: std::ops::Range<usize>) {
        if range.end <= self.len() {
            self.extend_from_within(range);
        }
    }

    fn truncate(&mut self, length: usize) {
        self.truncate(length);
    }
}

/// Returns the values of all output vertices from those of the input.
///
/// `lerp(a, b, t)` mixes the values of an edge's two ends; `corner(i)` makes the value of output
/// vertex i, a corner of the window, which no edge of the input determines.
///
/// ```
/// use durer::clip::attribute::{VertexSource, interpolate};
///
/// let sources = [VertexSource::Vertex(1), VertexSource::Cut { from: 1, to: 0, t: 0.25 }, VertexSource::Corner];
/// let heights = [10.0, 20.0];
/// let clipped = interpolate(&sources, &heights, |a, b, t| a + (b - a) * t, |_| 0.0);
/// assert_eq!(clipped, Some(vec![20.0, 17.5, 0.0]));
/// ```
///
/// `None` if a source names a point that `values` does not have.
pub fn interpolate<V: Copy>(
    sources: &[VertexSource],
    values: &[V],
    mut lerp: impl FnMut(V, V, f64) -> V,
    mut corner: impl FnMut(usize) -> V,
) -> Option<Vec<V>> {
    let value = |i: usize| values.get(i).copied();
    let mut output = |(i, source): (usize, &VertexSource)| match *source {
        VertexSource::Vertex(k) => value(k),
        VertexSource::Cut { from, to, t } => Some(lerp(value(from)?, value(to)?, t)),
        VertexSource::Corner => Some(corner(i)),
    };
    sources.iter().enumerate().map(&mut output).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_points_are_noticed() {
        let sources = [VertexSource::Cut { from: 0, to: 2, t: 0.5 }];
        assert_eq!(interpolate(&sources, &[1.0, 2.0], |a, _, _| a, |_| 0.0), None);
    }
}
