//! Lessons of curves.

mod cubics;
mod evaluator;
mod flatten;
mod levels;

use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::words::Word;

pub(super) const LESSONS: &[Lesson] = &[
    levels::DE_CASTELJAU,
    levels::DE_BOOR,
    levels::BOEHM,
    levels::OSLO,
    cubics::CATMULL_ROM,
    cubics::FORWARD,
    flatten::LESSON,
    evaluator::LESSON,
];

const TAKES: Word = Word::new("a line of control points", "ein Zug aus Kontrollpunkten");

/// Examples of all curves.
const EXAMPLES: &[Example] = &[
    Example {
        name: "cubic",
        title: Word::new("four control points", "vier Kontrollpunkte"),
        input: || control(&[(0.0, 0.0), (1.0, 4.0), (5.0, 5.0), (6.0, 1.0)]),
    },
    Example {
        name: "loop",
        title: Word::new("a curve that crosses itself", "eine Kurve, die sich selbst schneidet"),
        input: || control(&[(0.0, 0.0), (7.0, 5.0), (-1.0, 5.0), (6.0, 0.0)]),
    },
    Example {
        name: "many",
        title: Word::new("six control points", "sechs Kontrollpunkte"),
        input: || {
            control(&[(0.0, 1.0), (1.0, 4.0), (3.0, 5.0), (5.0, 0.0), (7.0, 1.0), (8.0, 4.0)])
        },
    },
    Example::new("cusp", "a curve with a cusp", "eine Kurve mit Spitze", || {
        control(&[(0.0, 0.0), (6.0, 6.0), (0.0, 6.0), (6.0, 0.0)])
    }),
    Example::new(
        "straight",
        "control points on a line",
        "Kontrollpunkte auf einer Geraden",
        || control(&[(0.0, 0.0), (2.0, 1.0), (4.0, 2.0), (8.0, 4.0)]),
    ),
    Example::new(
        "double",
        "two control points in one place",
        "zwei Kontrollpunkte an einer Stelle",
        || control(&[(0.0, 0.0), (3.0, 5.0), (3.0, 5.0), (6.0, 0.0), (8.0, 2.0)]),
    ),
];

fn control(points: &[(f64, f64)]) -> Input {
    let line = points.iter().copied().map(Into::into).collect();
    Input::Figure(Figure { lines: vec![line], ..Figure::default() })
}
