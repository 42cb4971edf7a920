//! The lesson of Vatti's scan beams.

use super::{
    Operands, TAKES, apart, bars, letter_and_blade, pair, pentagram, ring, squares, yes_or_no,
};
use crate::Result;
use crate::clip::polygon::scan_beams::{self, INFO, Step, Trapezoid, scan_beams};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "squares",
            title: Word::new("two squares: three beams", "zwei Quadrate: drei Streifen"),
            input: squares,
        },
        Example {
            name: "crossing",
            title: Word::new(
                "edges change places within a beam",
                "Kanten tauschen innerhalb eines Streifens",
            ),
            input: || {
                pair(
                    ring(&[(0.0, 0.0), (8.0, 0.0), (4.0, 8.0)]),
                    ring(&[(0.0, 6.0), (4.0, -2.0), (8.0, 6.0)]),
                )
            },
        },
        Example {
            name: "letter",
            title: Word::new(
                "a letter and a concave polygon",
                "ein Buchstabe und ein konkaves Polygon",
            ),
            input: letter_and_blade,
        },
        Example::new(
            "bars",
            "two bars across: four crossings",
            "zwei gekreuzte Balken: vier Schnittpunkte",
            bars,
        ),
        Example::new(
            "pentagram",
            "a star that crosses itself",
            "ein Stern, der sich selbst kreuzt",
            pentagram,
        ),
        Example::new("apart", "nothing in common", "nichts gemeinsam", apart),
    ],
    templates: &[&MINIMUM, &BEAM, &CROSSING, &ACTIVE, &CONTRIBUTES, &PART],
    unreached: &[],
    make,
};

static MINIMUM: Template = Template::new(
    "minimum",
    "{at} is a local minimum of the {list}: a left and a right bound begin here.",
    "{at} ist ein lokales Minimum von {list}: Ein linker und ein rechter Zug beginnen hier.",
);
static BEAM: Template = Template::new(
    "beam",
    "The beam from y = {from} to {to}: {active} {active|edge is|edges are} active.",
    "Der Streifen von y = {from} bis {to}: {active} {active|Kante ist|Kanten sind} aktiv.",
);
static CROSSING: Template = Template::new(
    "crossing",
    "Two edges change places within the beam: they cross at {at}.",
    "Zwei Kanten tauschen innerhalb des Streifens: Sie kreuzen sich bei {at}.",
);
static ACTIVE: Template = Template::new(
    "active",
    "The edge at x = {x}: windings to the right are {subject} and {clip}; the result does not change here.",
    "Die Kante bei x = {x}: Windungen rechts davon sind {subject} und {clip}; am Ergebnis ändert sich nichts.",
);
static CONTRIBUTES: Template = Template::new(
    "active",
    "The edge at x = {x}: windings to the right are {subject} and {clip}; it contributes.",
    "Die Kante bei x = {x}: Windungen rechts davon sind {subject} und {clip}; sie trägt bei.",
);
static PART: Template = Template::new(
    "part",
    "Between two contributing edges lies a trapezoid of area {area}; the sum is {sum}.",
    "Zwischen zwei beitragenden Kanten liegt ein Trapez der Fläche {area}; die Summe ist {sum}.",
);

#[derive(Clone)]
struct State {
    operands: Operands,
    /// Heights that bound the beam, and those of crossings in it, from below to above.
    heights: Vec<f64>,
    /// Number of edges active in it.
    width: usize,
    /// Number of edges of the beam that have been reported.
    reported: usize,
    /// Active edges of the part of the beam: x below and above, windings, whether it contributes.
    active: Vec<([f64; 2], [i32; 2], bool)>,
    parts: Vec<Trapezoid>,
    /// Their area.
    sum: f64,
}

fn make(_: &Lesson, input: &Input, options: &Options, cap: usize) -> Result<Frames> {
    let operands = Operands::new(input)?;
    let [subject, clip] = operands.shapes();
    let rules = scan_beams::Options {
        subject_rule: options.rule,
        clip_rule: options.rule,
        ..Default::default()
    };
    let steps = record(cap, |t| scan_beams(&subject, &clip, options.operation, &rules, t))?;
    let mut state = State {
        operands,
        heights: Vec::new(),
        width: 0,
        reported: 0,
        active: Vec::new(),
        parts: Vec::new(),
        sum: 0.0,
    };
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
                    Step::Minimum { at, .. } | Step::Crossing { at } => picture.dot(at, Look::Now),
                    Step::Active { x, .. } => picture.chain(self.edge(x), Look::Now),
                    Step::Beam { .. } | Step::Part(_) => {}
                }
                picture
            },
        )
    }

    /// Returns the sides of the part of the beam that the last reported edge belongs to: each part reports all edges.
    fn part(&self) -> [f64; 2] {
        let k = self.reported.saturating_sub(1) / self.width.max(1);
        let height =
            |k: usize| self.heights.get(k).or(self.heights.last()).copied().unwrap_or_default();
        [height(k), height(k + 1)]
    }

    /// Returns an edge between the sides of the part of the beam.
    fn edge(&self, x: [f64; 2]) -> [DVec2; 2] {
        let y = self.part();
        [DVec2::new(x[0], y[0]), DVec2::new(x[1], y[1])]
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Minimum { at, clip } => {
                let list = if clip { super::CLIP } else { super::SUBJECT };
                MINIMUM.with([("at", at.into()), ("list", list.into())])
            }
            Step::Beam { y, active } => {
                self.heights = y.to_vec();
                (self.width, self.reported) = (active, 0);
                self.active.clear();
                BEAM.with([("from", y[0].into()), ("to", y[1].into()), ("active", active.into())])
            }
            Step::Crossing { at } => {
                self.heights.push(at.y);
                self.heights.sort_by(f64::total_cmp);
                self.heights.dedup();
                CROSSING.with([("at", at.into())])
            }
            Step::Active { x, winding, contributes } => {
                if self.reported.is_multiple_of(self.width.max(1)) {
                    self.active.clear();
                }
                self.reported += 1;
                self.active.push((x, winding, contributes));
                let template = if contributes { &CONTRIBUTES } else { &ACTIVE };
                let [subject, clip] = winding;
                template.with([
                    ("x", x[0].into()),
                    ("subject", subject.into()),
                    ("clip", clip.into()),
                ])
            }
            Step::Part(part) => {
                self.parts.push(part);
                self.sum += part.area();
                PART.with([("area", part.area().into()), ("sum", self.sum.into())])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("active edge", "aktive Kante"),
            Word::new("x below", "x unten"),
            Word::new("x above", "x oben"),
            Word::new("w of subject", "w des Subjekts"),
            Word::new("w of clip", "w des Clips"),
            Word::new("contributes", "trägt bei"),
        ]);
        for (i, &(x, [subject, clip], contributes)) in self.active.iter().enumerate() {
            let cells =
                [x[0].into(), x[1].into(), subject.into(), clip.into(), yes_or_no(contributes)];
            table.row(Value::from(i + 1), cells);
        }
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = self.operands.picture();
        let [low, high] = picture.extent;
        for part in &self.parts {
            let ([y0, y1], [b0, b1], [t0, t1]) = (part.y, part.bottom, part.top);
            let corners = [(b0, y0), (b1, y0), (t1, y1), (t0, y1)];
            picture.ring(corners.map(DVec2::from), Look::Result);
        }
        for &y in &self.heights {
            picture.chain([DVec2::new(low.x, y), DVec2::new(high.x, y)], Look::Dashed);
        }
        picture
    }
}
