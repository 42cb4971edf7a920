//! Occupied places on a sheet: convex quadrilaterals.

use super::style::HALO;
use crate::math::{DVec2, Rect};
use crate::paper::text_strokes;
use crate::target::dimension::DimensionText;
use crate::target::drawing::TextAnchor;

/// A convex quadrilateral in the sheet's millimetres; may be as flat as a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quad(pub [DVec2; 4]);

impl Quad {
    pub fn of_rect(rect: Rect) -> Self {
        let (a, b) = (rect.min(), rect.max());
        Self([a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)])
    }

    /// Returns an upright one, this much larger on each side.
    pub fn wider(self, by: f64) -> Self {
        let signs = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let mut corners = self.0;
        for (corner, (x, y)) in corners.iter_mut().zip(signs) {
            *corner += DVec2::new(x, y) * by;
        }
        Self(corners)
    }

    /// Creates a segment, so much wide to each side.
    pub fn of_segment(a: DVec2, b: DVec2, half: f64) -> Self {
        let side = (b - a).normalize_or_zero().perp() * half;
        Self([a - side, b - side, b + side, a + side])
    }

    /// Returns the area of a line of text with `space` around it: it runs `along` from where `anchor` says, with its
    /// base line at `at`.
    pub fn of_text(
        text: &str,
        (at, along): (DVec2, DVec2),
        height: f64,
        anchor: TextAnchor,
        space: f64,
    ) -> Self {
        let strokes = text_strokes(DVec2::ZERO, text, height, anchor);
        let mut around = Rect::around(strokes.into_iter().flatten());
        around = around.or_else(|| Rect::around([DVec2::ZERO]));
        let (min, max) = around.map_or((DVec2::ZERO, DVec2::ZERO), |r| (r.min(), r.max()));
        // The height of capitals is used for all letters.
        let (min, max) = (DVec2::new(min.x, min.y.min(-height)), DVec2::new(max.x, max.y.max(0.0)));
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        Self(Self(corners).wider(space).0.map(|corner| at + along.rotate(corner)))
    }

    /// Returns the room that the text of a dimension takes, with space around it.
    pub fn of_dimension(text: &DimensionText) -> Self {
        Self::of_text(&text.text, (text.at, text.along), text.height, TextAnchor::Middle, HALO)
    }

    fn sides(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        (0..4).map(|i| [self.0[i], self.0[(i + 1) % 4]])
    }

    /// Returns whether the two have more than a border in common: no side's direction parts them.
    pub fn overlaps(&self, other: &Self) -> bool {
        let axes = self.sides().chain(other.sides()).map(|[a, b]| (b - a).perp());
        let ways = [self.0[2] - self.0[0], other.0[2] - other.0[0]];
        !axes.chain(ways).filter(|axis| *axis != DVec2::ZERO).any(|axis| {
            let range = |q: &Self| {
                let along = q.0.map(|p| p.dot(axis));
                along
                    .into_iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
            };
            let ((a, b), (c, d)) = (range(self), range(other));
            b <= c + 1e-9 * axis.length() || d <= a + 1e-9 * axis.length()
        })
    }

    /// Returns whether all of it is in a rectangle.
    pub fn is_within(&self, rect: &Rect) -> bool {
        let (min, max) = (rect.min(), rect.max());
        self.0.iter().all(|p| p.cmpge(min).all() && p.cmple(max).all())
    }

    /// Returns the part of a segment inside, as shares of its length; `None` if there is none.
    pub fn inside(&self, a: DVec2, b: DVec2) -> Option<(f64, f64)> {
        let middle = self.0.iter().sum::<DVec2>() / 4.0;
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for [p, q] in self.sides() {
            let normal = (q - p).perp();
            let sign = (middle - p).dot(normal).signum();
            let (at_a, at_b) = ((a - p).dot(normal) * sign, (b - p).dot(normal) * sign);
            match (at_a >= 0.0, at_b >= 0.0) {
                (true, true) => {}
                (false, false) => return None,
                (true, false) => to = to.min(at_a / (at_a - at_b)),
                (false, true) => from = from.max(at_a / (at_a - at_b)),
            }
        }
        (from < to).then_some((from, to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_overlap_where_nothing_parts_them() {
        let p = DVec2::new;
        let square = Quad([p(0.0, 0.0), p(2.0, 0.0), p(2.0, 2.0), p(0.0, 2.0)]);
        let beside = Quad(square.0.map(|q| q + p(2.0, 0.0)));
        let turned = Quad([p(3.0, -1.0), p(5.0, 1.0), p(3.0, 3.0), p(1.9, 1.0)]);
        assert!(!square.overlaps(&beside) && square.overlaps(&turned));
        let across = Quad::of_segment(p(-1.0, 1.0), p(3.0, 1.5), 0.0);
        let past = Quad::of_segment(p(-1.0, 1.0), p(0.5, 3.0), 0.0);
        assert!(square.overlaps(&across) && !square.overlaps(&past));
        assert_eq!(square.inside(p(-1.0, 1.0), p(3.0, 1.0)), Some((0.25, 0.75)));
        assert_eq!(square.inside(p(-1.0, 1.0), p(-1.0, 3.0)), None);
    }
}
