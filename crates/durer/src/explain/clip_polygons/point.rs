//! The lesson of points in polygons.

use super::{letter, ring, yes_or_no};
use crate::clip::polygon::point::{INFO, Step, winding_number};
use crate::explain::frame::{Frames, record};
use crate::explain::input::{Figure, Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

const TAKES: Word = Word::new("rings and a point", "Ringe und ein Punkt");

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "star",
            title: Word::new(
                "in the middle of a star: winding number 2",
                "in der Mitte eines Sterns: Windungszahl 2",
            ),
            input: || {
                at(
                    ring(&[(5.0, 10.0), (2.0, 0.5), (10.0, 6.4), (0.0, 6.4), (8.0, 0.5)]),
                    (5.0, 5.0),
                )
            },
        },
        Example {
            name: "beside",
            title: Word::new(
                "beside a letter: two edges cancel",
                "neben einem Buchstaben: zwei Kanten heben sich auf",
            ),
            input: || at(letter(), (0.0, 4.5)),
        },
        Example {
            name: "vertex",
            title: Word::new(
                "a vertex on the ray counts once",
                "eine Ecke auf dem Strahl zählt einmal",
            ),
            input: || at(ring(&[(0.0, 0.0), (8.0, 3.0), (0.0, 6.0)]), (2.0, 3.0)),
        },
        Example {
            name: "border",
            title: Word::new("on the border", "auf dem Rand"),
            input: || at(letter(), (4.0, 4.0)),
        },
        Example::new(
            "horizontal",
            "a horizontal edge on the ray counts for nothing",
            "eine waagrechte Kante auf dem Strahl zählt nicht",
            || {
                at(
                    ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (8.0, 3.0), (8.0, 6.0), (0.0, 6.0)]),
                    (1.0, 3.0),
                )
            },
        ),
        Example::new(
            "inside",
            "inside a letter: three edges to the right",
            "in einem Buchstaben: drei Kanten rechts",
            || at(letter(), (2.0, 4.5)),
        ),
    ],
    templates: &[&UP, &DOWN, &BORDER],
    unreached: &[],
    make,
};

fn at(points: Vec<DVec2>, p: (f64, f64)) -> Input {
    Input::Figure(Figure { rings: vec![points], points: vec![p.into()], ..Figure::default() })
}

static UP: Template = Template::new(
    "crosses",
    "The edge {from} → {to} crosses the ray upwards: w = {w}.",
    "Die Kante {from} → {to} kreuzt den Strahl aufwärts: w = {w}.",
);
static DOWN: Template = Template::new(
    "crosses",
    "The edge {from} → {to} crosses the ray downwards: w = {w}.",
    "Die Kante {from} → {to} kreuzt den Strahl abwärts: w = {w}.",
);
static BORDER: Template = Template::new(
    "border",
    "The point lies on the edge {from} → {to}: on the border.",
    "Der Punkt liegt auf der Kante {from} → {to}: auf dem Rand.",
);

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    figure.ring(TAKES)?;
    let missing = || Error::parameter("input", "without a point", TAKES.en);
    let p = *figure.points.first().ok_or_else(missing)?;
    let steps = record(cap, |t| {
        winding_number(figure.rings.iter().map(Vec::as_slice), p, t);
        Ok(())
    })?;
    let figure = figure.clone();
    let mut w = 0;
    let mut crossed: Vec<[DVec2; 2]> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let (Step::Crosses { edge, .. } | Step::Border { edge }) = *step;
        let caption = caption(step, &mut w);
        let picture = || {
            let mut picture = Picture::around(figure.points(), 0.1);
            picture.rings(&figure.rings, Look::First);
            picture.arrow(p, DVec2::new(picture.extent[1].x, p.y), Look::Dashed);
            crossed.iter().for_each(|edge| picture.chain(*edge, Look::Second));
            picture.arrow(edge[0], edge[1], Look::Now);
            picture.named(p, "P", Look::Result);
            picture
        };
        let shown = want.shown(step.line(), caption, || table(w), picture);
        crossed.push(edge);
        shown
    }))
}

fn caption(step: &Step, w: &mut i32) -> Caption {
    match *step {
        Step::Crosses { edge: [from, to], winding } => {
            *w += winding;
            let template = if winding > 0 { &UP } else { &DOWN };
            template.with([("from", from.into()), ("to", to.into()), ("w", (*w).into())])
        }
        Step::Border { edge: [from, to] } => {
            BORDER.with([("from", from.into()), ("to", to.into())])
        }
    }
}

fn table(w: i32) -> Table {
    let mut table = Table::new([Word::new("rule", "Regel"), Word::new("inside", "innen")]);
    table.row(Word::new("winding number w", "Windungszahl w"), [w.into()]);
    table.row(Word::new("even-odd", "gerade/ungerade"), [yes_or_no(w % 2 != 0)]);
    table.row(Word::new("non-zero", "nicht null"), [yes_or_no(w != 0)]);
    table
}
