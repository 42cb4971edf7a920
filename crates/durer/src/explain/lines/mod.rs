//! Lessons of points, lines and conics in pixels.

mod conics;
mod pattern;
mod points;
mod slices;
mod smooth;
mod thin;
mod wide;

pub(super) use thin::by_pixels;

use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::words::Word;

pub(super) const LESSONS: &[Lesson] = &[
    points::SQUARES,
    points::DISCS,
    thin::EQUATION,
    thin::DDA,
    thin::BRESENHAM,
    slices::RUN_SLICE,
    slices::DOUBLE_STEP,
    smooth::WU,
    smooth::GUPTA_SPROULL,
    pattern::LESSON,
    wide::LESSON,
    conics::CIRCLE,
    conics::ELLIPSE,
];

const TAKES: Word = Word::new("a line of two points, in pixels", "eine Strecke in Pixeln");
const PIXEL: Word = Word::new("pixel", "Pixel");
const STEP: Word = Word::new("step", "Schritt");

/// Examples of all ways to draw lines.
const EXAMPLES: &[Example] = &[
    Example {
        name: "lecture",
        title: Word::new(
            "(0, 0) to (5, 3): E = 1, −3, 3, −1, 5",
            "(0; 0) bis (5; 3): E = 1, −3, 3, −1, 5",
        ),
        input: || line((0.0, 0.0), (5.0, 3.0)),
    },
    Example {
        name: "steep-and-back",
        title: Word::new(
            "a steep line from top to bottom",
            "eine steile Strecke von oben nach unten",
        ),
        input: || line((4.0, 9.0), (1.0, 0.0)),
    },
    Example {
        name: "ties",
        title: Word::new(
            "slope ½: every other pixel is a tie",
            "Steigung ½: jedes zweite Pixel ein Gleichstand",
        ),
        input: || line((0.0, 1.0), (10.0, 6.0)),
    },
    Example {
        name: "flat",
        title: Word::new("horizontal", "waagrecht"),
        input: || line((1.0, 2.0), (9.0, 2.0)),
    },
    Example::new(
        "diagonal",
        "slope 1: every step goes to the next row",
        "Steigung 1: jeder Schritt geht in die nächste Zeile",
        || line((0.0, 0.0), (8.0, 8.0)),
    ),
    Example::new(
        "point",
        "one pixel: start and end are the same",
        "ein Pixel: Anfang und Ende sind gleich",
        || line((3.0, 2.0), (3.0, 2.0)),
    ),
];

fn line(from: (f64, f64), to: (f64, f64)) -> Input {
    Input::Figure(Figure { lines: vec![vec![from.into(), to.into()]], ..Figure::default() })
}
