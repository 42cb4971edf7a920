//! Lessons of polygon clipping.

mod beams;
mod edges;
mod point;
mod rectangle;
mod stages;
mod sweep;
mod turns;
mod walks;

pub(super) use stages::by_stages;

use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture, corners};
use super::words::{Value, Word};
use crate::Result;
use crate::clip::polygon::Shapes;
use crate::math::{DVec2, Rect};

pub(super) const LESSONS: &[Lesson] = &[
    stages::LESSON,
    edges::LESSON,
    turns::LESSON,
    walks::WEILER_ATHERTON,
    walks::GREINER_HORMANN,
    beams::LESSON,
    sweep::VATTI,
    sweep::OVERLAY,
    rectangle::LESSON,
    point::LESSON,
];

const TAKES: Word = Word::new(
    "a ring, and a second ring or a window",
    "ein Ring und ein zweiter Ring oder ein Fenster",
);
const TAKES_WINDOW: Word = Word::new("a ring and a window", "ein Ring und ein Fenster");
const YES: Word = Word::new("yes", "ja");
const NO: Word = Word::new("no", "nein");
const SUBJECT: Word = Word::new("subject", "Subjekt");
const CLIP: Word = Word::new("clip", "Clip");

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&p| p.into()).collect()
}

/// Returns a letter C, which windows cut in two.
fn letter() -> Vec<DVec2> {
    ring(&[
        (1.0, 0.0),
        (12.0, 0.0),
        (12.0, 3.0),
        (4.0, 3.0),
        (4.0, 6.0),
        (12.0, 6.0),
        (12.0, 9.0),
        (1.0, 9.0),
    ])
}

/// Returns a ring and a window.
fn windowed(points: Vec<DVec2>, low: (f64, f64), high: (f64, f64)) -> Input {
    let window = Rect::new(low.into(), high.into()).ok();
    Input::Figure(Figure { window, rings: vec![points], ..Figure::default() })
}

/// Returns a ring before a window of 10 × 10.
fn before_square(points: &[(f64, f64)]) -> Input {
    windowed(ring(points), (0.0, 0.0), (10.0, 10.0))
}

const CONTAINED: Example =
    Example::new("inside", "inside: every vertex is kept", "innen: Jede Ecke bleibt", || {
        before_square(&[(2.0, 2.0), (8.0, 3.0), (5.0, 8.0)])
    });
const BESIDE: Example = Example::new(
    "outside",
    "beside the window: nothing remains",
    "neben dem Fenster: nichts bleibt",
    || before_square(&[(12.0, 2.0), (18.0, 3.0), (15.0, 8.0)]),
);
const ALONG: Example =
    Example::new("along", "an edge along a border", "eine Kante auf einem Rand", || {
        before_square(&[(4.0, 2.0), (10.0, 2.0), (10.0, 8.0), (4.0, 8.0)])
    });
const AROUND: Example = Example::new(
    "around",
    "around the window: its four corners remain",
    "um das Fenster: Seine vier Ecken bleiben",
    || before_square(&[(-3.0, -3.0), (14.0, -2.0), (13.0, 13.0), (-2.0, 12.0)]),
);

/// Returns two rings.
fn pair(subject: Vec<DVec2>, clip: Vec<DVec2>) -> Input {
    Input::Figure(Figure { rings: vec![subject], clip: vec![clip], ..Figure::default() })
}

/// Returns the letter and a polygon across it.
fn letter_and_blade() -> Input {
    pair(
        letter(),
        ring(&[(3.0, -1.0), (9.0, 1.5), (10.0, 7.0), (6.0, 10.5), (2.5, 8.5), (6.5, 4.5)]),
    )
}

/// Returns two squares that overlap in a corner.
fn squares() -> Input {
    pair(
        ring(&[(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)]),
        ring(&[(3.0, 2.0), (9.0, 2.0), (9.0, 8.0), (3.0, 8.0)]),
    )
}

/// Returns two bars that cross.
fn bars() -> Input {
    pair(
        ring(&[(0.0, 3.0), (9.0, 3.0), (9.0, 6.0), (0.0, 6.0)]),
        ring(&[(3.0, 0.0), (6.0, 0.0), (6.0, 9.0), (3.0, 9.0)]),
    )
}

/// Returns two triangles that have nothing in common.
fn apart() -> Input {
    pair(ring(&[(0.0, 0.0), (4.0, 0.0), (2.0, 5.0)]), ring(&[(6.0, 1.0), (9.0, 2.0), (7.0, 6.0)]))
}

/// Returns a polygon within another one.
fn nested() -> Input {
    pair(
        ring(&[(0.0, 0.0), (9.0, 0.0), (10.0, 8.0), (1.0, 7.0)]),
        ring(&[(3.0, 2.0), (6.0, 2.5), (5.0, 5.0)]),
    )
}

/// Returns two rectangles with a part of an edge in common.
fn neighbours() -> Input {
    pair(
        ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 6.0), (0.0, 6.0)]),
        ring(&[(4.0, 2.0), (8.0, 2.0), (8.0, 8.0), (4.0, 8.0)]),
    )
}

/// Returns a star of five points, which crosses itself, and a square over its right half.
fn pentagram() -> Input {
    pair(
        ring(&[(5.0, 10.0), (8.0, 0.5), (0.0, 6.5), (10.0, 6.5), (2.0, 0.5)]),
        ring(&[(5.5, 1.0), (11.0, 1.0), (11.0, 9.0), (5.5, 9.0)]),
    )
}

/// Returns subject and window of the lecture, clockwise.
fn lecture() -> Input {
    let subject = [
        (5.0, 9.0),
        (15.0, 9.0),
        (18.0, 5.0),
        (15.0, 1.0),
        (5.0, 1.0),
        (5.0, 3.0),
        (15.0, 3.0),
        (14.0, 5.0),
        (15.0, 7.0),
        (5.0, 7.0),
    ];
    pair(ring(&subject), ring(&[(0.0, 10.0), (10.0, 10.0), (10.0, 0.0), (0.0, 0.0)]))
}

/// The two operands of an operation.
#[derive(Clone)]
struct Operands {
    rings: [Vec<Vec<DVec2>>; 2],
}

impl Operands {
    fn new(input: &Input) -> Result<Self> {
        Ok(Self { rings: input.figure(TAKES)?.operands(TAKES)? })
    }

    fn shapes(&self) -> [Shapes; 2] {
        [&self.rings[0], &self.rings[1]].map(Shapes::from_rings)
    }

    fn picture(&self) -> Picture {
        let points = self.rings.iter().flatten().flatten().copied();
        let mut picture = Picture::around(points, 0.1);
        picture.rings(&self.rings[0], Look::First);
        picture.rings(&self.rings[1], Look::Second);
        picture
    }
}

/// Returns subject and window of a lesson with one ring.
fn ring_and_window(input: &Input) -> Result<(Vec<DVec2>, Rect)> {
    let figure = input.figure(TAKES_WINDOW)?;
    Ok((figure.ring(TAKES_WINDOW)?.to_vec(), figure.window(TAKES_WINDOW)?))
}

/// Returns an empty picture around a ring and a window, with both drawn.
fn before(points: &[DVec2], window: &Rect) -> Picture {
    let all = points.iter().copied().chain(corners(window));
    let mut picture = Picture::around(all, 0.1);
    picture.ring(points, Look::Pale);
    picture.frame(window, Look::Window);
    picture
}

/// Returns the picture of one edge of a ring, with the window's borders prolonged and the points emitted so far.
fn walked(ring: &[DVec2], window: &Rect, edge: usize, out: &[DVec2]) -> Picture {
    let mut picture = before(ring, window);
    let [low, high] = picture.extent;
    let (min, max) = (window.min(), window.max());
    for x in [min.x, max.x] {
        picture.chain([DVec2::new(x, low.y), DVec2::new(x, high.y)], Look::Thin);
    }
    for y in [min.y, max.y] {
        picture.chain([DVec2::new(low.x, y), DVec2::new(high.x, y)], Look::Thin);
    }
    if let [Some(&from), Some(&to)] = [edge, edge + 1].map(|k| ring.get(k % ring.len().max(1))) {
        picture.arrow(from, to, Look::First);
    }
    picture.chain(out, Look::Result);
    out.iter().for_each(|&p| picture.dot(p, Look::Result));
    picture
}

/// Returns the answer to a question of a table.
fn yes_or_no(yes: bool) -> Value {
    if yes { YES } else { NO }.into()
}
