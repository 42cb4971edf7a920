//! The lesson of Liang and Barsky's polygon clipping.

use super::{
    ALONG, BESIDE, CONTAINED, TAKES_WINDOW, letter, ring, ring_and_window, walked, windowed,
};
use crate::Result;
use crate::clip::polygon::liang_barsky::{INFO, Step, clip};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Word};
use crate::math::{DVec2, Rect};
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES_WINDOW,
    examples: &[
        Example {
            name: "corner",
            title: Word::new("around a corner of the window", "um eine Ecke des Fensters"),
            input: || {
                windowed(ring(&[(5.0, 5.0), (25.0, 5.0), (5.0, 25.0)]), (0.0, 0.0), (10.0, 10.0))
            },
        },
        Example {
            name: "bridge",
            title: Word::new(
                "a ring that falls apart keeps a bridge",
                "ein Ring, der zerfällt, behält eine Brücke",
            ),
            input: || windowed(letter(), (6.0, 1.0), (10.0, 8.0)),
        },
        Example {
            name: "around",
            title: Word::new("around the window: four corners", "um das Fenster: vier Ecken"),
            input: || {
                windowed(
                    ring(&[(-3.0, -3.0), (14.0, -2.0), (13.0, 13.0), (-2.0, 12.0)]),
                    (0.0, 0.0),
                    (10.0, 10.0),
                )
            },
        },
        CONTAINED,
        BESIDE,
        ALONG,
    ],
    templates: &[&EDGE, &POINT, &TURN],
    unreached: &[],
    make,
};

static EDGE: Template = Template::new(
    "edge",
    "Edge {edge}: enters x at t = {x_in} and y at {y_in}, leaves x at {x_out} and y at {y_out}.",
    "Kante {edge}: betritt x bei t = {x_in} und y bei {y_in}, verlässt x bei {x_out} und y bei {y_out}.",
);
static POINT: Template = Template::new(
    "point",
    "The edge is seen: {point} is emitted.",
    "Die Kante ist zu sehen: {point} wird ausgegeben.",
);
static TURN: Template = Template::new(
    "turn",
    "The edge passes a corner of the window: {point} is emitted as a turning point.",
    "Die Kante passiert eine Ecke des Fensters: {point} wird als Wendepunkt ausgegeben.",
);

#[derive(Clone)]
struct State {
    ring: Vec<DVec2>,
    window: Rect,
    edge: usize,
    enters: [f64; 2],
    leaves: [f64; 2],
    out: Vec<DVec2>,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let (ring, window) = ring_and_window(input)?;
    let steps = record(cap, |t| clip(&window, &ring, t))?;
    let mut state =
        State { ring, window, edge: 0, enters: [0.0; 2], leaves: [1.0; 2], out: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(
            step.line(),
            caption,
            || self.table(),
            || {
                let mut picture = self.picture();
                match *step {
                    Step::Edge { .. } => {}
                    Step::Point(p) | Step::Turn(p) => picture.dot(p, Look::Now),
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Edge { edge, enters, leaves } => {
                (self.edge, self.enters, self.leaves) = (edge, enters, leaves);
                EDGE.with([
                    ("edge", edge.into()),
                    ("x_in", enters[0].into()),
                    ("y_in", enters[1].into()),
                    ("x_out", leaves[0].into()),
                    ("y_out", leaves[1].into()),
                ])
            }
            Step::Point(p) => {
                self.out.push(p);
                POINT.with([("point", p.into())])
            }
            Step::Turn(p) => {
                self.out.push(p);
                TURN.with([("point", p.into())])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("slab", "Streifen"),
            Word::new("enters", "betritt"),
            Word::new("leaves", "verlässt"),
        ]);
        for (k, name) in ["x", "y"].into_iter().enumerate() {
            table.row(name, [self.enters[k].into(), self.leaves[k].into()]);
        }
        table.row(Word::new("emitted", "ausgegeben"), [self.out.clone().into()]);
        table
    }

    fn picture(&self) -> Picture {
        walked(&self.ring, &self.window, self.edge, &self.out)
    }
}
