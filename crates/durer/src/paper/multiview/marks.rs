//! Lines, letters and arrows on sheets, beside the drawings.

use super::SheetView;
use crate::math::DVec2;
use crate::paper::{Options, PlacedView, pen_index, scale_text, text_pen};
use crate::target::drawing::TextAnchor;
use crate::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};

/// Height of the letters of titles and references, millimetres: larger than all other text (ISO 128-3).
pub const LETTER: f64 = 5.0;
/// Space between a view and its title.
const TITLE_GAP: f64 = 4.0;
/// Height of a title above its view.
pub const TITLE_ROOM: f64 = LETTER + TITLE_GAP;

/// Widths of lines, millimetres (ISO 128-2).
pub const THIN: f64 = 0.25;
pub const THICK: f64 = 0.5;

/// Length and half the width of an arrow's head.
const HEAD: f64 = 3.5;
const HEAD_HALF_WIDTH: f64 = 0.6;

/// Corners of a circle.
const AROUND: u32 = 96;

/// Annotator that adds layers of marks to a sheet.
pub struct Annotator<'a> {
    sheet: &'a mut Sheet,
    options: &'a Options,
    marks: Vec<PaperMark>,
}

impl<'a> Annotator<'a> {
    pub fn new(sheet: &'a mut Sheet, options: &'a Options) -> Self {
        Self { sheet, options, marks: Vec::new() }
    }

    /// Makes a layer of the marks since the last one, if there are any.
    pub fn end_layer(&mut self, name: &str) {
        if !self.marks.is_empty() {
            let marks = std::mem::take(&mut self.marks);
            self.sheet.layers.push(SheetLayer { name: name.to_owned(), marks });
        }
    }

    /// Draws a line.
    pub fn line(&mut self, points: Vec<DVec2>, width: f64, dashes: &[f64]) {
        self.stroke(points, false, width, dashes);
    }

    fn stroke(&mut self, points: Vec<DVec2>, closed: bool, width: f64, dashes: &[f64]) {
        if points.iter().all(|p| p.is_finite()) {
            let pen = Pen { width, color: self.options.pens.color, dashes: dashes.to_vec() };
            let pen = pen_index(self.sheet, pen);
            self.marks.push(PaperMark::Stroke { points, closed, pen });
        }
    }

    /// Draws a thin circle.
    pub fn circle(&mut self, center: DVec2, radius: f64) {
        self.stroke(circle(center, radius), true, THIN, &[]);
    }

    /// Draws a filled dot.
    pub fn dot(&mut self, center: DVec2, radius: f64) {
        self.fill(circle(center, radius));
    }

    fn fill(&mut self, ring: Vec<DVec2>) {
        if ring.iter().all(|p| p.is_finite()) {
            self.marks.push(PaperMark::Fill {
                rings: vec![ring],
                color: self.options.pens.color,
                even_odd: false,
            });
        }
    }

    /// Draws a rectangle.
    pub fn rectangle(&mut self, min: DVec2, max: DVec2, width: f64) {
        let corners = vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        self.stroke(corners, true, width, &[]);
    }

    /// Draws a thin arrow.
    pub fn arrow(&mut self, tail: DVec2, tip: DVec2) {
        let along = (tip - tail).normalize_or_zero();
        let neck = tip - along * HEAD;
        let side = along.perp() * HEAD_HALF_WIDTH;
        let head = vec![tip, neck + side, neck - side];
        self.fill(head.clone());
        self.stroke(head, true, THIN, &[]);
        self.line(vec![tail, neck], THIN, &[]);
    }

    /// Writes letters whose middle is at a place.
    pub fn letters(&mut self, middle: DVec2, text: &str, height: f64) {
        self.text(middle + DVec2::new(0.0, height * 0.5), text, height, TextAnchor::Middle);
    }

    /// Writes letters on a base line.
    pub fn text(&mut self, at: DVec2, text: &str, height: f64, anchor: TextAnchor) {
        if at.is_finite() {
            let pen = text_pen(self.sheet, height, self.options);
            self.marks.push(PaperMark::Text { at, text: text.to_owned(), height, anchor, pen });
        }
    }
}

/// Returns the corners of a circle, counter-clockwise with y up.
pub fn circle(center: DVec2, radius: f64) -> Vec<DVec2> {
    let corner = |i: u32| {
        let turn = f64::from(i) * std::f64::consts::TAU / f64::from(AROUND);
        center + DVec2::new(libm::cos(turn), libm::sin(turn)) * radius
    };
    (0..AROUND).map(corner).collect()
}

/// Writes the titles of sections and details above them, with their scale if it differs: layer `view-titles`.
pub fn put_titles(
    annotator: &mut Annotator,
    views: &[SheetView],
    placed: &[PlacedView],
    scale: f64,
    options: &Options,
) {
    for (view, place) in views.iter().zip(placed) {
        if view.is_principal() {
            continue;
        }
        let own = place.factor / options.unit;
        let same = (own / scale - 1.0).abs() < 1e-9;
        let title =
            if same { place.name.clone() } else { format!("{} ({})", place.name, scale_text(own)) };
        let (min, max) = (place.bounds.min(), place.bounds.max());
        let at = DVec2::new((min.x + max.x) * 0.5, min.y - TITLE_GAP);
        annotator.text(at, &title, LETTER, TextAnchor::Middle);
    }
    annotator.end_layer("view-titles");
}
