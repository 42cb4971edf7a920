//! Lessons of the arrangement on a grid: the overlay, and Vatti's way by a sweep line.

use super::{Operands, TAKES, apart, bars, letter_and_blade, neighbours, pair, ring};
use crate::clip::polygon::overlay::{self, Step};
use crate::clip::polygon::vatti;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Figure, Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Recorder};

pub(super) const VATTI: Lesson = Lesson {
    name: vatti::INFO.name,
    info: &vatti::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&GRID, &CROSSING, &SWEEP, &RING, &HOLE],
    unreached: &[],
    make: |_, input, options, cap| {
        let operands = Operands::new(input)?;
        let [a, b] = operands.shapes();
        let steps = record(cap, |t| vatti::vatti(&a, &b, options.operation, &rules(options), t))?;
        Ok(show_all(operands, steps))
    },
};

pub(super) const OVERLAY: Lesson = Lesson {
    name: overlay::INFO.name,
    info: &overlay::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&GRID, &CROSSING, &RING, &HOLE],
    unreached: &[],
    make: |_, input, options, cap| {
        let operands = Operands::new(input)?;
        let [a, b] = operands.shapes();
        let steps =
            record(cap, |t| overlay::overlay(&a, &b, options.operation, &rules(options), t))?;
        Ok(show_all(operands, steps))
    },
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "letter",
        title: Word::new(
            "a letter and a concave polygon",
            "ein Buchstabe und ein konkaves Polygon",
        ),
        input: letter_and_blade,
    },
    Example {
        name: "star",
        title: Word::new("a star that crosses itself", "ein Stern, der sich selbst kreuzt"),
        input: || pair(star(), ring(&[(-1.0, 2.0), (11.0, 2.0), (11.0, 9.0), (-1.0, 9.0)])),
    },
    Example {
        name: "frame",
        title: Word::new("a frame: the result has a hole", "ein Rahmen: Das Ergebnis hat ein Loch"),
        input: frame,
    },
    Example::new(
        "bars",
        "two bars across: four crossings",
        "zwei gekreuzte Balken: vier Schnittpunkte",
        bars,
    ),
    Example::new(
        "neighbours",
        "a common border: it cancels in the union",
        "eine gemeinsame Grenze: In der Vereinigung fällt sie weg",
        neighbours,
    ),
    Example::new("apart", "nothing in common", "nichts gemeinsam", apart),
];

/// Returns a square with a hole, and a window around the hole.
fn frame() -> Input {
    let square = |low: f64, high: f64| ring(&[(low, low), (high, low), (high, high), (low, high)]);
    let rings = vec![square(0.0, 8.0), square(3.0, 5.0)];
    Input::Figure(Figure { rings, clip: vec![square(1.0, 9.0)], ..Figure::default() })
}

fn star() -> Vec<DVec2> {
    ring(&[(5.0, 10.0), (2.0, 0.5), (10.0, 6.4), (0.0, 6.4), (8.0, 0.5)])
}

static GRID: Template = Template::new(
    "grid",
    "Points move to a grid with cells of {cell}: so crossings are exact.",
    "Punkte wandern auf ein Gitter mit Zellen von {cell}: So werden Kreuzungen exakt.",
);
static CROSSING: Template = Template::new(
    "crossing",
    "Two edges cross at {at}: both are divided there.",
    "Zwei Kanten kreuzen sich bei {at}: Beide werden dort geteilt.",
);
static SWEEP: Template = Template::new(
    "sweep",
    "The sweep line passes the node {at}; after it {active} {active|edge is|edges are} active.",
    "Die Sweep-Linie passiert den Knoten {at}; danach {active|ist|sind} {active} {active|Kante|Kanten} aktiv.",
);
static RING: Template = Template::new(
    "ring",
    "A ring of the result with {count} vertices.",
    "Ein Ring des Ergebnisses mit {count} Ecken.",
);
static HOLE: Template = Template::new(
    "ring",
    "A hole of the ring before, with {count} vertices.",
    "Ein Loch im Ring davor, mit {count} Ecken.",
);

fn rules(options: &Options) -> overlay::Options {
    overlay::Options::with_rule(options.rule)
}

#[derive(Clone)]
struct State {
    operands: Operands,
    crossings: Vec<DVec2>,
    passed: Vec<DVec2>,
    active: usize,
    rings: Vec<Vec<DVec2>>,
}

fn show_all(operands: Operands, steps: Recorder<Step>) -> Frames {
    let (crossings, passed, rings) = (Vec::new(), Vec::new(), Vec::new());
    let mut state = State { operands, crossings, passed, active: 0, rings };
    Frames::new(steps, move |step, want| state.show(step, want))
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
                match step {
                    Step::Crossing { at } => picture.dot(*at, Look::Now),
                    Step::Sweep { at, .. } => {
                        let [low, high] = picture.extent;
                        picture.chain(
                            [DVec2::new(at.x, low.y), DVec2::new(at.x, high.y)],
                            Look::Dashed,
                        );
                        picture.dot(*at, Look::Now);
                    }
                    Step::Grid { .. } | Step::Ring { .. } => {}
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step) -> Caption {
        match step {
            Step::Grid { cell } => GRID.with([("cell", (*cell).into())]),
            Step::Crossing { at } => {
                self.crossings.push(*at);
                CROSSING.with([("at", (*at).into())])
            }
            Step::Sweep { at, active } => {
                self.passed.push(*at);
                self.active = *active;
                SWEEP.with([("at", (*at).into()), ("active", (*active).into())])
            }
            Step::Ring { points, hole } => {
                self.rings.push(points.clone());
                let template = if *hole { &HOLE } else { &RING };
                template.with([("count", points.len().into())])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::default();
        let count = |n: usize| [Value::from(n)];
        table.row(Word::new("crossings", "Kreuzungen"), count(self.crossings.len()));
        table.row(Word::new("nodes passed", "Knoten passiert"), count(self.passed.len()));
        table.row(Word::new("active edges", "aktive Kanten"), count(self.active));
        for (i, ring) in self.rings.iter().enumerate() {
            let name = Value::List(vec![Word::new("ring", "Ring").into(), (i + 1).into()]);
            table.row(name, [ring.clone().into()]);
        }
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = self.operands.picture();
        picture.rings(&self.rings, Look::Result);
        self.crossings.iter().for_each(|&p| picture.dot(p, Look::Result));
        self.passed.iter().for_each(|&p| picture.dot(p, Look::Window));
        picture
    }
}
