//! The lesson of polylines against a polygon.

use super::{NO_HEAD, p};
use crate::Result;
use crate::clip::polygon::Shapes;
use crate::clip::polyline::{self, INFO, Step, clip};
use crate::explain::frame::{Frames, record};
use crate::explain::input::{Figure, Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;

const TAKES: Word =
    Word::new("lines, and rings or a window", "Linienzüge und Ringe oder ein Fenster");

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "hole",
            title: Word::new("through a polygon with a hole", "durch ein Polygon mit Loch"),
            input: || with_hole(vec![p(-1.0, 5.0), p(5.0, 5.5), p(12.0, 3.0)]),
        },
        Example {
            name: "along",
            title: Word::new("along a border", "an einem Rand entlang"),
            input: || with_hole(vec![p(2.0, 0.0), p(8.0, 0.0), p(8.0, -2.0), p(5.0, 3.5)]),
        },
        Example::new("inside", "inside: one piece", "innen: ein Stück", || {
            with_hole(vec![p(1.0, 1.0), p(8.0, 2.0), p(9.0, 9.0)])
        }),
        Example::new(
            "zigzag",
            "in and out again and again",
            "immer wieder hinein und hinaus",
            || {
                with_hole(vec![
                    p(-1.0, 1.0),
                    p(11.0, 2.5),
                    p(-1.0, 4.0),
                    p(11.0, 5.5),
                    p(-1.0, 7.0),
                ])
            },
        ),
        Example::new(
            "in-the-hole",
            "wholly in the hole: nothing remains",
            "ganz im Loch: nichts bleibt",
            || with_hole(vec![p(4.0, 4.0), p(6.0, 6.0)]),
        ),
        Example::new(
            "corner",
            "it touches a corner from outside",
            "berührt eine Ecke von außen",
            || with_hole(vec![p(-2.0, 2.0), p(2.0, -2.0)]),
        ),
    ],
    templates: &[&INSIDE, &OUTSIDE],
    unreached: &[],
    make,
};

fn with_hole(line: Vec<DVec2>) -> Input {
    let outer = vec![p(0.0, 0.0), p(10.0, 0.0), p(10.0, 10.0), p(0.0, 10.0)];
    let hole = vec![p(3.0, 3.0), p(3.0, 7.0), p(7.0, 7.0), p(7.0, 3.0)];
    Input::Figure(Figure { lines: vec![line], rings: vec![outer, hole], ..Figure::default() })
}

static INSIDE: Template = Template::new(
    "part",
    "The part from {start} to {end}: its middle {middle} is inside, so it is kept.",
    "Das Stück von {start} bis {end}: Seine Mitte {middle} liegt innen, es bleibt.",
);
static OUTSIDE: Template = Template::new(
    "part",
    "The part from {start} to {end}: its middle {middle} is outside, so it goes.",
    "Das Stück von {start} bis {end}: Seine Mitte {middle} liegt außen, es fällt weg.",
);

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    figure.segment(TAKES)?;
    let rings = if figure.rings.is_empty() {
        let window = figure.window(TAKES)?;
        vec![crate::explain::picture::corners(&window).to_vec()]
    } else {
        figure.rings.clone()
    };
    let shapes = Shapes::from_rings(&rings);
    let points = figure.lines.concat();
    let ends: Vec<usize> = figure
        .lines
        .iter()
        .scan(0, |sum, line| {
            *sum += line.len();
            Some(*sum)
        })
        .collect();
    let options = polyline::Options::default();
    let steps = record(cap, |t| clip(&shapes, &points, &ends, &options, t))?;
    let figure = figure.clone();
    let mut done: Vec<([DVec2; 2], bool)> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let Step::Part { start, end, inside, .. } = *step;
        done.push(([start, end], inside));
        let middle = (start + end) / 2.0;
        let picture = || {
            let mut picture = Picture::around(figure.points(), 0.1);
            picture.rings(&rings, Look::Pale);
            figure.lines.iter().for_each(|line| picture.chain(line.clone(), Look::Thin));
            for &(part, inside) in &done {
                picture.chain(part, if inside { Look::Result } else { Look::Dashed });
            }
            picture.dot(start, Look::First);
            picture.dot(end, Look::First);
            picture.dot(middle, Look::Now);
            picture
        };
        let template = if inside { &INSIDE } else { &OUTSIDE };
        let values = [("start", start.into()), ("end", end.into()), ("middle", middle.into())];
        want.shown(step.line(), template.with(values), || table(&done), picture)
    }))
}

fn table(done: &[([DVec2; 2], bool)]) -> Table {
    let mut table = Table::new([
        NO_HEAD,
        Word::new("from", "von"),
        Word::new("to", "bis"),
        Word::new("inside", "innen"),
    ]);
    for (i, &([start, end], inside)) in done.iter().enumerate() {
        let word = if inside { Word::new("yes", "ja") } else { Word::new("no", "nein") };
        table.row(i + 1, [start.into(), end.into(), Value::from(word)]);
    }
    table
}
