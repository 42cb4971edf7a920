//! Letters of cutting planes and details make room for dimensions and centre lines, which have only one place.

use super::board::text_quad;
use super::quad::Quad;
use crate::curve::pieces;
use crate::math::{DVec2, Rect};
use crate::target::sheet::{PaperMark, Sheet, SheetLayer};
use std::f64::consts::FRAC_PI_4;

/// Layers whose letters are moved, and whether those stay off the views.
const MOVED: [(&str, bool); 2] = [("cutting-planes", true), ("details", false)];

/// Layers that letters make room for.
const FIXED: [&str; 3] = ["center", "thread", "dimension"];

/// Layers with nothing that letters could cover.
const APART: [&str; 4] = ["regions", "frame", "title-block", "parts-list"];

/// Distances that letters are moved, the least first, in millimetres.
const MOVES: [f64; 5] = [3.0, 4.5, 6.0, 8.0, 10.0];

/// Additional space around a letter at its new position, in millimetres.
const SPARE: f64 = 0.6;

/// Distance from a letter beyond which other marks do not matter, in millimetres.
const REACH: f64 = 20.0;

/// Curves are examined as chords this near to them, millimetres.
const NEAR: f64 = 0.05;

/// Moves each letter that covers an annotation to the nearest free place, if there is one near by; returns the places
/// of all letters.
pub(super) fn make_room(sheet: &mut Sheet, views: &[Rect], page: &Rect) -> Vec<Quad> {
    let mut places = Vec::new();
    for (name, outside) in MOVED {
        let Some(layer) = sheet.layers.iter().position(|l| l.name == name) else { continue };
        for index in 0..sheet.layers[layer].marks.len() {
            let Some(quad) = text_quad(&sheet.layers[layer].marks[index]) else { continue };
            let views = if outside { views } else { &[] };
            let way = way(sheet, (layer, index), quad, views, page);
            places.push(moved(quad, way));
            if let PaperMark::Text { at, .. } = &mut sheet.layers[layer].marks[index] {
                *at += way;
            }
        }
    }
    places
}

fn moved(quad: Quad, way: DVec2) -> Quad {
    Quad(quad.0.map(|p| p + way))
}

/// Returns how far a letter is to be moved.
fn way(sheet: &Sheet, own: (usize, usize), quad: Quad, views: &[Rect], page: &Rect) -> DVec2 {
    let near = Near::new(sheet, own, quad, |l| FIXED.contains(&l.name.as_str()));
    if near.is_free(&quad) {
        return DVec2::ZERO;
    }
    let mut near = Near::new(sheet, own, quad, |l| !APART.contains(&l.name.as_str()));
    near.quads.extend(views.iter().copied().map(Quad::of_rect));
    let ways = MOVES.iter().flat_map(|length| {
        (0..8u32).map(move |eighth| {
            let (sin, cos) = libm::sincos(f64::from(eighth) * FRAC_PI_4);
            DVec2::new(cos, sin) * *length
        })
    });
    let is_free = |way: &DVec2| {
        let there = moved(quad, *way);
        there.is_within(page) && near.is_free(&there.wider(SPARE))
    };
    ways.into_iter().find(is_free).unwrap_or(DVec2::ZERO)
}

/// Marks near a letter.
struct Near {
    around: Quad,
    segments: Vec<[DVec2; 2]>,
    quads: Vec<Quad>,
}

impl Near {
    /// Creates all but the letter itself in some layers.
    fn new(
        sheet: &Sheet,
        own: (usize, usize),
        quad: Quad,
        counts: impl Fn(&SheetLayer) -> bool,
    ) -> Self {
        let around = quad.wider(REACH);
        let mut near = Self { around, segments: Vec::new(), quads: Vec::new() };
        for (i, layer) in sheet.layers.iter().enumerate().filter(|(_, l)| counts(l)) {
            let marks = layer.marks.iter().enumerate().filter(|(k, _)| (i, *k) != own);
            marks.for_each(|(_, mark)| near.add(mark));
        }
        near
    }

    fn add(&mut self, mark: &PaperMark) {
        match mark {
            PaperMark::Stroke { points, closed, .. } => self.chain(points, *closed),
            PaperMark::Curve { curve, .. } => {
                self.chain(&pieces::points(curve, NEAR), curve.closed)
            }
            PaperMark::Fill { rings, .. } => rings.iter().for_each(|ring| self.chain(ring, true)),
            PaperMark::Area { .. } | PaperMark::Gradient(_) => {}
            PaperMark::Group(group) => group.marks.iter().for_each(|mark| self.add(mark)),
            PaperMark::Text { .. } => self.quads.extend(text_quad(mark)),
            PaperMark::Dimension(dimension) => {
                dimension.marks.iter().for_each(|mark| self.add(mark));
                self.quads.push(Quad::of_dimension(&dimension.text));
            }
        }
    }

    fn chain(&mut self, points: &[DVec2], closed: bool) {
        let last = points.last().zip(points.first()).filter(|_| closed).map(|(a, b)| [*a, *b]);
        let all = points.windows(2).map(|w| [w[0], w[1]]).chain(last);
        let around = self.around;
        self.segments.extend(all.filter(|[a, b]| around.inside(*a, *b).is_some()));
    }

    fn is_free(&self, quad: &Quad) -> bool {
        !self.segments.iter().any(|[a, b]| quad.inside(*a, *b).is_some())
            && !self.quads.iter().any(|q| q.overlaps(quad))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::drawing::TextAnchor;

    fn stroke(points: [(f64, f64); 2]) -> PaperMark {
        let points = points.map(|(x, y)| DVec2::new(x, y)).to_vec();
        PaperMark::Stroke { points, closed: false, pen: 0 }
    }

    #[test]
    fn letters_go_where_nothing_is() {
        let letter = |x: f64| PaperMark::Text {
            at: DVec2::new(x, 50.0),
            text: "A".to_owned(),
            height: 5.0,
            anchor: TextAnchor::Middle,
            pen: 0,
        };
        let layer = |name: &str, marks| SheetLayer { name: name.to_owned(), marks };
        let mut sheet = Sheet {
            size: DVec2::splat(100.0),
            layers: vec![
                layer("visible-crease", vec![stroke([(84.0, 40.0), (84.0, 60.0)])]),
                layer("cutting-planes", vec![letter(20.0), letter(80.0), letter(50.0)]),
                layer(
                    "dimension",
                    vec![stroke([(21.0, 0.0), (21.0, 90.0)]), stroke([(80.0, 0.0), (80.0, 90.0)])],
                ),
            ],
            ..Sheet::default()
        };
        let page = Rect::new(DVec2::ZERO, sheet.size).expect("page");
        let view = Rect::new(DVec2::new(0.0, 0.0), DVec2::new(17.0, 100.0)).expect("view");
        let places = make_room(&mut sheet, &[view], &page);
        let x: Vec<f64> = sheet.layers[1]
            .marks
            .iter()
            .map(|m| if let PaperMark::Text { at, .. } = m { at.x } else { f64::NAN })
            .collect();
        // To the right, off the view; to the left, off the line at 84; and one that stays.
        assert!(x[0] > 23.0 && x[1] < 78.0 && x[2] == 50.0, "{x:?}");
        assert_eq!(places.len(), 3);
        assert!(places[0].inside(DVec2::new(21.0, 0.0), DVec2::new(21.0, 90.0)).is_none());
    }
}
