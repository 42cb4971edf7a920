//! The lesson of Maillot's turning points.

use super::{BESIDE, CONTAINED, TAKES_WINDOW, letter, ring, ring_and_window, walked, windowed};
use crate::Result;
use crate::clip::polygon::maillot::{Code, CornerReason, INFO, Step, clip};
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
            name: "turns",
            title: Word::new("around borders and corners", "um Ränder und Ecken"),
            input: || {
                windowed(
                    ring(&[
                        (6.0, 4.0),
                        (-2.0, 1.0),
                        (12.0, -8.0),
                        (14.0, 3.0),
                        (9.0, 14.0),
                        (-3.0, 12.0),
                        (-2.0, -2.0),
                        (14.0, 13.0),
                    ]),
                    (0.0, 0.0),
                    (10.0, 10.0),
                )
            },
        },
        Example {
            name: "opposite",
            title: Word::new("from corner to opposite corner", "von Ecke zu Gegenecke"),
            input: || {
                windowed(
                    ring(&[(-9.0, -1.0), (11.0, 21.0), (5.0, 4.0), (4.0, -4.0)]),
                    (0.0, 0.0),
                    (10.0, 8.0),
                )
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
                    ring(&[(5.0, -9.0), (19.0, 5.0), (5.0, 19.0), (-9.0, 5.0)]),
                    (0.0, 0.0),
                    (10.0, 10.0),
                )
            },
        },
        CONTAINED,
        BESIDE,
    ],
    templates: &[&EDGE, &POINT, &BASIC, &TO_BORDER, &TO_CORNER, &OPPOSITE],
    unreached: &[],
    make,
};

static EDGE: Template = Template::new(
    "edge",
    "Edge {edge} from {from} to {to}: codes {start} and {end}; the first digit is set at corners.",
    "Kante {edge} von {from} nach {to}: Codes {start} und {end}; die erste Ziffer steht für eine Ecke.",
);
static POINT: Template = Template::new(
    "point",
    "The edge is visible: {point} is emitted.",
    "Die Kante ist sichtbar: {point} wird ausgegeben.",
);
static BASIC: Template = Template::new(
    "turn",
    "The edge ends in the region of the corner {corner}: this corner is emitted.",
    "Die Kante endet im Gebiet der Ecke {corner}: Diese Ecke wird ausgegeben.",
);
static TO_BORDER: Template = Template::new(
    "turn",
    "Not visible, from beside one border to beside another: their corner {corner} is emitted.",
    "Nicht sichtbar, von neben einem Rand nach neben einem anderen: Ihre Ecke {corner} wird ausgegeben.",
);
static TO_CORNER: Template = Template::new(
    "turn",
    "Not visible, between a border and a corner that is not on it: {corner} is in between and is emitted.",
    "Nicht sichtbar, zwischen einem Rand und einer Ecke, die nicht an ihm liegt: {corner} liegt dazwischen und wird ausgegeben.",
);
static OPPOSITE: Template = Template::new(
    "turn",
    "Not visible, from corner to opposite corner: the edge goes around {corner}, which is emitted.",
    "Nicht sichtbar, von Ecke zu Gegenecke: Die Kante geht um {corner} herum, das ausgegeben wird.",
);

#[derive(Clone)]
struct State {
    ring: Vec<DVec2>,
    window: Rect,
    edge: usize,
    codes: Option<[Code; 2]>,
    out: Vec<DVec2>,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let (ring, window) = ring_and_window(input)?;
    let steps = record(cap, |t| clip(&window, &ring, t))?;
    let mut state = State { ring, window, edge: 0, codes: None, out: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        let picture = || {
            let mut picture = self.picture();
            match *step {
                Step::Edge { .. } => {}
                Step::Point(p) | Step::Turn { corner: p, .. } => picture.dot(p, Look::Now),
            }
            picture
        };
        want.shown(step.line(), caption, || self.table(), picture)
    }

    /// Returns the start and the end of the edge.
    fn ends(&self) -> [DVec2; 2] {
        let at = |k: usize| self.ring.get(k % self.ring.len().max(1)).copied().unwrap_or_default();
        [at(self.edge), at(self.edge + 1)]
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Edge { edge, start, end } => {
                (self.edge, self.codes) = (edge, Some([start, end]));
                let [from, to] = self.ends();
                EDGE.with([
                    ("edge", edge.into()),
                    ("from", from.into()),
                    ("to", to.into()),
                    ("start", start.to_string().into()),
                    ("end", end.to_string().into()),
                ])
            }
            Step::Point(p) => {
                self.out.push(p);
                POINT.with([("point", p.into())])
            }
            Step::Turn { corner, turn } => {
                self.out.push(corner);
                let template = match turn {
                    CornerReason::Basic => &BASIC,
                    CornerReason::BorderToBorder => &TO_BORDER,
                    CornerReason::BorderToCorner => &TO_CORNER,
                    CornerReason::CornerToCorner => &OPPOSITE,
                };
                template.with([("corner", corner.into())])
            }
        }
    }

    fn table(&self) -> Table {
        let heads =
            [Word::new("end", "Ende"), Word::new("point", "Punkt"), Word::new("code", "Code")];
        let mut table = Table::new(heads);
        if let Some(codes) = self.codes {
            for ((name, point), code) in ["P", "Q"].into_iter().zip(self.ends()).zip(codes) {
                table.row(name, [point.into(), code.to_string().into()]);
            }
        }
        table.row(Word::new("emitted", "ausgegeben"), [self.out.clone().into()]);
        table
    }

    fn picture(&self) -> Picture {
        walked(&self.ring, &self.window, self.edge, &self.out)
    }
}
