//! Lessons of line clipping.

mod cohen_sutherland;
mod midpoint;
mod nicholl_lee_nicholl;
mod parametric;
mod polyline;
mod skala;
mod sobkow_pospisil_yang;

pub(super) use cohen_sutherland::by_codes;
pub(super) use parametric::{SIDES, by_parameters};

use super::input::{Figure, Input};
use super::lesson::Lesson;
use super::picture::{Look, Picture, corners};
use super::words::{Value, Word};
use crate::Result;
use crate::clip::line::{End, Segment};
use crate::clip::outcode::Outcode;
use crate::math::{DVec2, Rect};

pub(super) const LESSONS: &[Lesson] = &[
    cohen_sutherland::LESSON,
    midpoint::LESSON,
    parametric::CYRUS_BECK,
    parametric::LIANG_BARSKY,
    nicholl_lee_nicholl::LESSON,
    skala::LESSON,
    sobkow_pospisil_yang::LESSON,
    parametric::HOMOGENEOUS,
    polyline::LESSON,
];

const TAKES: Word = Word::new("a window and a line of two points", "ein Fenster und eine Strecke");
const NO_HEAD: Word = Word::new("", "");
const POINT: Word = Word::new("point", "Punkt");
const CODE: Word = Word::new("code", "Code");
const START: Word = Word::new("the start", "der Anfang");
const END: Word = Word::new("the end", "das Ende");

/// Returns the name of an end.
fn end_name(end: End) -> Value {
    match end {
        End::Start => START,
        End::End => END,
    }
    .into()
}

/// The borders of a rectangle in the order of their indices, as adjectives.
const BORDERS: [Word; 4] = [
    Word::new("left", "linken"),
    Word::new("right", "rechten"),
    Word::new("bottom", "unteren"),
    Word::new("top", "oberen"),
];

fn p(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

/// Returns an input of a window from the origin and a segment.
fn figure(size: (f64, f64), start: (f64, f64), end: (f64, f64)) -> Input {
    Input::Figure(Figure {
        window: Rect::new(DVec2::ZERO, size.into()).ok(),
        lines: vec![vec![start.into(), end.into()]],
        ..Figure::default()
    })
}

/// Returns the adjective for a border of one bit.
pub(super) fn border_name(border: Outcode) -> Value {
    BORDERS.get(border.0.trailing_zeros() as usize).copied().unwrap_or_default().into()
}

/// Returns the ends of a window's border.
pub(super) fn side(window: &Rect, border: Outcode) -> [DVec2; 2] {
    let [a, b, c, d] = corners(window);
    match border {
        Outcode::LEFT => [a, d],
        Outcode::RIGHT => [b, c],
        Outcode::BOTTOM => [a, b],
        _ => [d, c],
    }
}

/// A segment before a window, and what is left of it.
#[derive(Clone)]
struct Cutting {
    window: Rect,
    whole: Segment<DVec2>,
    left: Segment<DVec2>,
    gone: bool,
}

impl Cutting {
    fn new(input: &Input) -> Result<Self> {
        let figure = input.figure(TAKES)?;
        let [start, end] = figure.segment(TAKES)?;
        let whole = Segment::new(start, end);
        Ok(Self { window: figure.window(TAKES)?, whole, left: whole, gone: false })
    }

    /// Moves an end to a point.
    fn cut(&mut self, end: End, point: DVec2) {
        match end {
            End::Start => self.left.start = point,
            End::End => self.left.end = point,
        }
    }

    /// Returns the part of the plane that is shown: window and segment with room around.
    fn extent(&self) -> [DVec2; 2] {
        let (min, max) = (self.window.min(), self.window.max());
        Picture::around([min, max, self.whole.start, self.whole.end], 0.18).extent
    }

    /// Draws the nine regions with their codes, and the window.
    fn regions(&self) -> Picture {
        let [low, high] = self.extent();
        let (a, b) = (self.window.min(), self.window.max());
        let mut picture = Picture::new([low, high]);
        for x in [a.x, b.x] {
            picture.chain([p(x, low.y), p(x, high.y)], Look::Thin);
        }
        for y in [a.y, b.y] {
            picture.chain([p(low.x, y), p(high.x, y)], Look::Thin);
        }
        picture.frame(&self.window, Look::Window);
        for (x0, x1) in [(low.x, a.x), (a.x, b.x), (b.x, high.x)] {
            for (y0, y1) in [(low.y, a.y), (a.y, b.y), (b.y, high.y)] {
                let middle = p(x0.midpoint(x1), y0.midpoint(y1));
                // In a corner, where lines are rare.
                let code = Outcode::of_point_2d(&self.window, middle);
                picture.label(p(x0, y1), (24.0, 12.0), code);
            }
        }
        picture
    }

    fn add_segment(&self, picture: &mut Picture) {
        picture.chain([self.whole.start, self.whole.end], Look::Pale);
        if !self.gone {
            picture.chain([self.left.start, self.left.end], Look::First);
        }
        let apart = if self.whole.start.x <= self.whole.end.x { 9.0 } else { -9.0 };
        picture.label(self.whole.start, (-apart, 0.0), "A");
        picture.label(self.whole.end, (apart, 0.0), "B");
    }
}
