//! The lesson of the rectangle clip.

use super::{ALONG, AROUND, TAKES_WINDOW, letter, ring, windowed};
use crate::Result;
use crate::clip::polygon::Shapes;
use crate::clip::polygon::rectangle::{self, INFO, Step, clip};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Figure, Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture, corners};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Rect};
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES_WINDOW,
    examples: &[
        Example {
            name: "letter",
            title: Word::new(
                "a ring that falls apart makes two",
                "ein Ring, der zerfällt, gibt zwei",
            ),
            input: || windowed(letter(), (6.0, 1.0), (10.0, 8.0)),
        },
        Example {
            name: "corner",
            title: Word::new(
                "a corner of the window is covered",
                "eine Ecke des Fensters ist bedeckt",
            ),
            input: || {
                windowed(ring(&[(5.0, 5.0), (25.0, 5.0), (5.0, 25.0)]), (0.0, 0.0), (10.0, 10.0))
            },
        },
        Example {
            name: "inside",
            title: Word::new("inside: copied", "innen: kopiert"),
            input: || {
                windowed(ring(&[(2.0, 2.0), (8.0, 3.0), (5.0, 8.0)]), (0.0, 0.0), (10.0, 10.0))
            },
        },
        Example {
            name: "outside",
            title: Word::new("beside the window: left out", "neben dem Fenster: weggelassen"),
            input: || {
                windowed(ring(&[(12.0, 2.0), (18.0, 3.0), (15.0, 8.0)]), (0.0, 0.0), (10.0, 10.0))
            },
        },
        AROUND,
        ALONG,
    ],
    templates: &[&INSIDE, &OUTSIDE, &CHAIN, &VERTEX, &RING_DONE, &POLYGON_DONE],
    unreached: &[],
    make,
};

static INSIDE: Template = Template::new(
    "inside",
    "The box of polygon {polygon} lies in the window: it is copied.",
    "Das Rechteck um Polygon {polygon} liegt im Fenster: Es wird kopiert.",
);
static OUTSIDE: Template = Template::new(
    "outside",
    "The box of polygon {polygon} misses the window: it is left out.",
    "Das Rechteck um Polygon {polygon} verfehlt das Fenster: Es fällt weg.",
);
static CHAIN: Template = Template::new(
    "chain",
    "A part inside: from the entry {entry} to the exit {exit}.",
    "Ein Stück innen: vom Eintritt {entry} zum Austritt {exit}.",
);
static VERTEX: Template = Template::new(
    "vertex",
    "{point} is emitted: the ring has {count} {count|vertex|vertices}.",
    "{point} wird ausgegeben: Der Ring hat {count} {count|Ecke|Ecken}.",
);
static RING_DONE: Template = Template::new(
    "ring-done",
    "The next entry is the first one: the ring of {count} vertices is complete.",
    "Der nächste Eintritt ist der erste: Der Ring mit {count} Ecken ist fertig.",
);
static POLYGON_DONE: Template = Template::new(
    "polygon-done",
    "The ring has all its holes: the polygon is complete.",
    "Der Ring hat alle seine Löcher: Das Polygon ist fertig.",
);

#[derive(Clone)]
struct State {
    figure: Figure,
    window: Rect,
    chains: Vec<[DVec2; 2]>,
    ring: Vec<DVec2>,
    rings: Vec<Vec<DVec2>>,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES_WINDOW)?;
    figure.ring(TAKES_WINDOW)?;
    let window = figure.window(TAKES_WINDOW)?;
    let shapes = Shapes::from_rings(&figure.rings);
    let steps = record(cap, |t| clip(&window, &shapes, &rectangle::Options, t))?;
    let figure = figure.clone();
    let mut state =
        State { figure, window, chains: Vec::new(), ring: Vec::new(), rings: Vec::new() };
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
                    Step::Chain { entry, exit } => {
                        [entry, exit].into_iter().for_each(|p| picture.dot(p, Look::Now))
                    }
                    Step::Vertex { point } => picture.dot(point, Look::Now),
                    Step::Inside { .. }
                    | Step::Outside { .. }
                    | Step::RingDone
                    | Step::PolygonDone => {}
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Inside { polygon } => {
                self.rings.clone_from(&self.figure.rings);
                INSIDE.with([("polygon", (polygon + 1).into())])
            }
            Step::Outside { polygon } => OUTSIDE.with([("polygon", (polygon + 1).into())]),
            Step::Chain { entry, exit } => {
                self.chains.push([entry, exit]);
                CHAIN.with([("entry", entry.into()), ("exit", exit.into())])
            }
            Step::Vertex { point } => {
                self.ring.push(point);
                VERTEX.with([("point", point.into()), ("count", self.ring.len().into())])
            }
            Step::RingDone => {
                let ring = std::mem::take(&mut self.ring);
                let count = ring.len().into();
                self.rings.push(ring);
                RING_DONE.with([("count", count)])
            }
            Step::PolygonDone => POLYGON_DONE.with([]),
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::default();
        for (i, [entry, exit]) in self.chains.iter().enumerate() {
            let name = Word::new("entry and exit", "Eintritt und Austritt");
            let name = Value::List(vec![name.into(), (i + 1).into()]);
            table.row(name, [(*entry).into(), (*exit).into()]);
        }
        table.row(Word::new("ring", "Ring"), [self.ring.clone().into()]);
        table.row(Word::new("rings done", "Ringe fertig"), [self.rings.len().into()]);
        table
    }

    fn picture(&self) -> Picture {
        let all = self.figure.rings.iter().flatten().copied().chain(corners(&self.window));
        let mut picture = Picture::around(all, 0.1);
        picture.rings(&self.figure.rings, Look::First);
        picture.frame(&self.window, Look::Window);
        picture.rings(&self.rings, Look::Result);
        for &[entry, exit] in &self.chains {
            picture.dot(entry, Look::First);
            picture.dot(exit, Look::Second);
        }
        picture.chain(self.ring.clone(), Look::Result);
        picture
    }
}
