//! The sheet while it is annotated: its pens, occupied areas and new marks.

use super::quad::Quad;
use super::style::{CENTER, HALO, Style, THIN};
use crate::math::{DVec2, Rect};
use crate::paper::pen_index;
use crate::target::drawing::TextAnchor;
use crate::target::sheet::Dimension;
use crate::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};
use crate::target::{Curve, CurvePiece, EllipticArc};

/// Distance that annotations keep from the frame or the border of the paper, millimetres.
const INSIDE: f64 = 1.0;

/// Layers whose marks nothing may be written on.
const SOLID: &[&str] =
    &["title-block", "parts-list", "view-titles", "text", "callouts", "cutting-planes", "details"];

pub(super) struct Board<'a> {
    sheet: &'a mut Sheet,
    pub style: Style,
    /// Area for annotations.
    page: Rect,
    /// Areas that are occupied.
    taken: Vec<Quad>,
    /// Number of areas that were occupied before.
    old: usize,
    /// Texts of annotations, with their halos.
    texts: Vec<Quad>,
    leaders: Vec<[DVec2; 2]>,
    layers: [Vec<PaperMark>; 3],
}

/// The layers of annotations, the lowest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layer {
    Center,
    Thread,
    Dimension,
}

const NAMES: [&str; 3] = ["center", "thread", "dimension"];

/// An annotation that has not been placed yet.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    /// Marks on the sheet.
    pub mark: Vec<PaperMark>,
    /// Areas of its text and dimension line.
    pub solid: Vec<Quad>,
    /// Its text.
    pub text: Quad,
    /// Line to the annotated place.
    pub leader: Option<[DVec2; 2]>,
}

impl<'a> Board<'a> {
    /// Creates the board of a sheet with the areas that its views occupy; `None` without any.
    pub fn new(sheet: &'a mut Sheet, views: &[Rect], color: [u8; 4]) -> Option<Self> {
        let first = *views.first()?;
        let whole = Rect::around([DVec2::ZERO, sheet.size]);
        let frame = sheet.layers.iter().find(|l| l.name == "frame").and_then(|l| bounds(&l.marks));
        let page = frame.or(whole).and_then(|r| {
            Rect::around([r.min() + DVec2::splat(INSIDE), r.max() - DVec2::splat(INSIDE)])
        });
        let page = page.unwrap_or(first);
        let solid = sheet.layers.iter().filter(|l| SOLID.contains(&l.name.as_str()));
        let blocks = solid.flat_map(|l| match l.name.as_str() {
            "title-block" | "parts-list" => {
                bounds(&l.marks).map(Quad::of_rect).into_iter().collect()
            }
            "callouts" => l.marks.iter().filter_map(circle_quad).collect(),
            "cutting-planes" => l.marks.iter().flat_map(thin_quads).collect(),
            _ => l.marks.iter().filter_map(text_quad).collect::<Vec<_>>(),
        });
        let taken: Vec<Quad> = blocks.chain(views.iter().copied().map(Quad::of_rect)).collect();
        let old = taken.len();
        let style = Style::of_sheet(sheet.size, color);
        let (texts, leaders, layers) = (Vec::new(), Vec::new(), Default::default());
        Some(Self { sheet, style, page, taken, old, texts, leaders, layers })
    }

    pub fn thin(&mut self) -> usize {
        self.pen(THIN, Vec::new())
    }

    pub fn center(&mut self) -> usize {
        self.pen(THIN, CENTER.to_vec())
    }

    /// Returns the pen for letters: a tenth of their height (ISO 3098, type B).
    pub fn letters(&mut self) -> usize {
        self.pen(self.style.text * 0.1, Vec::new())
    }

    pub fn pen(&mut self, width: f64, dashes: Vec<f64>) -> usize {
        pen_index(self.sheet, Pen { width, color: self.style.color, dashes })
    }

    pub fn add(&mut self, layer: Layer, mark: PaperMark) {
        self.layers[layer as usize].push(mark);
    }

    pub fn is_free(&self, solid: &[Quad]) -> bool {
        self.is_free_but_for(solid, &[])
    }

    /// Returns whether `solid` is within the page and overlaps no occupied area except those in `allowed`.
    pub fn is_free_but_for(&self, solid: &[Quad], allowed: &[Quad]) -> bool {
        let taken = || self.taken.iter().filter(|t| !allowed.contains(t));
        solid.iter().all(|q| q.is_within(&self.page) && !taken().any(|t| t.overlaps(q)))
    }

    /// Returns the number of texts, dimension lines and leaders that a line crosses.
    pub fn crossings(&self, [a, b]: [DVec2; 2]) -> usize {
        let line = Quad::of_segment(a, b, 0.0);
        let leaders = self.leaders.iter().map(|[p, q]| Quad::of_segment(*p, *q, 0.2));
        let new = self.taken.iter().skip(self.old).copied();
        new.chain(leaders).filter(|q| q.overlaps(&line)).count()
    }

    /// Places an annotation as drafted.
    pub fn put(&mut self, draft: Draft) {
        draft.mark.into_iter().for_each(|mark| self.add(Layer::Dimension, mark));
        self.taken.extend(draft.solid);
        self.texts.push(draft.text);
        self.leaders.extend(draft.leader);
    }

    /// Puts the new layers on the sheet; the texts, and where annotations may be.
    pub fn finish(self) -> (Vec<Quad>, Rect) {
        for (name, marks) in NAMES.iter().zip(self.layers) {
            if !marks.is_empty() {
                self.sheet.layers.push(SheetLayer { name: (*name).to_owned(), marks });
            }
        }
        (self.texts, self.page)
    }
}

/// Returns the area of a text on the sheet.
pub(super) fn text_quad(mark: &PaperMark) -> Option<Quad> {
    match mark {
        PaperMark::Text { at, text, height, anchor, .. } => {
            Some(Quad::of_text(text, (*at, DVec2::X), *height, *anchor, HALO))
        }
        _ => None,
    }
}

/// Returns the room that the circle around a number takes.
fn circle_quad(mark: &PaperMark) -> Option<Quad> {
    match mark {
        PaperMark::Stroke { points, closed: true, .. } => {
            Rect::around(points.iter().copied()).map(Quad::of_rect)
        }
        _ => None,
    }
}

/// Returns the room that a text, a line or an arrow takes.
fn thin_quads(mark: &PaperMark) -> Vec<Quad> {
    let along = |points: &[DVec2]| {
        points.windows(2).map(|w| Quad::of_segment(w[0], w[1], HALO)).collect::<Vec<_>>()
    };
    match mark {
        PaperMark::Stroke { points, .. } => along(points),
        PaperMark::Fill { rings, .. } => rings.iter().flat_map(|ring| along(ring)).collect(),
        mark => text_quad(mark).into_iter().collect(),
    }
}

/// Returns the rectangle around strokes and texts.
fn bounds(marks: &[PaperMark]) -> Option<Rect> {
    let points = marks.iter().flat_map(|m| match m {
        PaperMark::Stroke { points, .. } => points.clone(),
        mark => text_quad(mark).map_or_else(Vec::new, |q| q.0.to_vec()),
    });
    Rect::around(points)
}

/// Returns an arc as a mark: around a centre, from an angle on, radians, counter-clockwise as seen.
pub(super) fn arc_mark(center: DVec2, radius: f64, start: f64, turn: f64, pen: usize) -> PaperMark {
    // On the sheet y runs down.
    let arc = EllipticArc {
        center,
        axis: DVec2::new(radius, 0.0),
        ratio: 1.0,
        start: -start,
        turn: -turn,
    };
    let closed = arc.is_whole();
    let first = arc.at(-start);
    let last = if closed { first } else { arc.at(-start - turn) };
    PaperMark::Curve {
        curve: Curve { start: first, pieces: vec![CurvePiece::Arc(arc, last)], closed },
        pen,
    }
}

/// Returns a dimension as a mark.
pub(super) fn mark(dimension: Dimension) -> PaperMark {
    PaperMark::Dimension(Box::new(dimension))
}

/// Returns a text to be laid horizontally.
pub(super) fn text_mark(at: DVec2, text: String, height: f64, pen: usize) -> PaperMark {
    PaperMark::Text { at, text, height, anchor: TextAnchor::Middle, pen }
}
