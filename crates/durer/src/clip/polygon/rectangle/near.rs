//! The part of many polygons near a box, which remembers the edges that it was cut from.

use super::Prepared;
use crate::clip::attribute::VertexSource;
use crate::clip::polygon::Shapes;
use crate::math::{DVec2, Rect};

/// The part of many polygons near a box.
#[derive(Debug, Default)]
pub(crate) struct Near {
    pub shapes: Shapes,
    /// Edge of the whole that the edge from each point is a part of. Edges along the border of the near
    /// part are their own.
    pub lines: Vec<[DVec2; 2]>,
}

impl Near {
    /// Returns all polygons.
    pub fn all(shapes: Shapes) -> Self {
        let of_ring = |ring: &'_ [DVec2]| -> Vec<[DVec2; 2]> {
            ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]).collect()
        };
        let lines = shapes.rings().flat_map(of_ring).collect();
        Self { shapes, lines }
    }

    /// Returns the part around a box and a little more on every side, so that no other part reaches far.
    pub fn around(whole: &Prepared, bounds: &Rect) -> Self {
        let farthest = bounds.max().abs().max(bounds.min().abs()).max_element();
        // A window needs a size, also around a line along an axis.
        let margin = bounds.size() * (1.0 / 64.0) + (farthest * 1e-9).max(f64::MIN_POSITIVE);
        let holds =
            |window: &Rect, own: Rect| window.contains(own.min()) && window.contains(own.max());
        match (Rect::new(bounds.min() - margin, bounds.max() + margin), whole.bounds()) {
            (Ok(window), Some(own)) if !holds(&window, own) => Self::within(whole, &window),
            _ => Self::all(whole.shapes().clone()),
        }
    }

    fn within(whole: &Prepared, window: &Rect) -> Self {
        let (shapes, sources) = whole.clip_with_sources(window);
        let mut near = Self::all(shapes);
        let points = whole.shapes().points();
        let line = |edge: [usize; 2]| {
            let [from, to] = edge.map(|i| points.get(i).copied());
            from.zip(to).map(|(from, to)| [from, to])
        };
        for ring in 0..near.shapes.ring_count() {
            let range = near.shapes.ring_range(ring);
            for k in range.clone() {
                let next = if k + 1 < range.end { k + 1 } else { range.start };
                let ends =
                    [k, next].map(|k| sources.get(k).copied().unwrap_or(VertexSource::Corner));
                if let Some(line) = common_edge(ends).and_then(line) {
                    near.lines[k] = line;
                }
            }
        }
        near
    }
}

/// Returns the edge that was cut at one or both of its ends, if both are of one edge.
fn common_edge(ends: [VertexSource; 2]) -> Option<[usize; 2]> {
    match ends {
        [VertexSource::Cut { from, to, .. }, VertexSource::Vertex(v)]
        | [VertexSource::Vertex(v), VertexSource::Cut { from, to, .. }] => {
            (v == from || v == to).then_some([from, to])
        }
        [VertexSource::Cut { from, to, .. }, VertexSource::Cut { from: a, to: b, .. }] => {
            ([from, to] == [a, b] || [to, from] == [a, b]).then_some([from, to])
        }
        _ => None,
    }
}
