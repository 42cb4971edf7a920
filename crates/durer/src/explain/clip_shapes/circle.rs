//! The lesson of clipping a circle.

use crate::Result;
use crate::clip::circle::{Arc, Circle, INFO, Step, clip};
use crate::clip::outcode::Outcode;
use crate::explain::clip_lines::{SIDES, border_name};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Figure, Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Rect};
use crate::trace::PseudocodeLine;
use std::f64::consts::TAU;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "corner",
            title: Word::new("over the upper right corner", "über die rechte obere Ecke"),
            input: || figure((9.0, 8.0), (5.0, 5.0), 5.0),
        },
        Example {
            name: "four-arcs",
            title: Word::new("four arcs at the corners", "vier Bögen an den Ecken"),
            input: || figure((8.0, 8.0), (4.0, 4.0), 5.0),
        },
        Example {
            name: "around",
            title: Word::new("around the window: nothing is left", "um das Fenster: Nichts bleibt"),
            input: || figure((8.0, 6.0), (4.0, 3.0), 6.5),
        },
        Example {
            name: "outside",
            title: Word::new("beside the window", "neben dem Fenster"),
            input: || figure((8.0, 6.0), (13.0, 3.0), 3.0),
        },
        Example {
            name: "inside",
            title: Word::new("in the window", "im Fenster"),
            input: || figure((8.0, 6.0), (4.0, 3.0), 2.5),
        },
        Example::new(
            "touching",
            "it touches a border from inside: d = r takes nothing",
            "er berührt einen Rand von innen: d = r nimmt nichts",
            || figure((8.0, 6.0), (5.0, 3.5), 3.0),
        ),
    ],
    templates: &[&CROSSED, &BEYOND, &WITHIN, &NOTHING, &TAKEN, &ARC, &WHOLE],
    unreached: &[],
    make,
};

const TAKES: Word = Word::new(
    "a window and a line from the centre of the circle to a point of it",
    "ein Fenster und eine Strecke von der Mitte des Kreises zu einem Punkt auf ihm",
);

static CROSSED: Template = Template::new(
    "box",
    "The square around the circle crosses borders, with the code {code}: each border is compared with the circle.",
    "Das Quadrat um den Kreis kreuzt Ränder, mit dem Code {code}: Jeder Rand wird mit dem Kreis verglichen.",
);
static BEYOND: Template = Template::new(
    "box",
    "The square around the circle is beyond a border, with the code {code}: rejected.",
    "Das Quadrat um den Kreis liegt jenseits eines Rands, mit dem Code {code}: abgelehnt.",
);
static WITHIN: Template = Template::new(
    "box",
    "The square around the circle is inside all borders: accepted.",
    "Das Quadrat um den Kreis liegt innerhalb aller Ränder: angenommen.",
);
static NOTHING: Template = Template::new(
    "border",
    "The {border} border: d = {d} ≥ r = {r}, so it takes nothing away.",
    "Am {border} Rand ist d = {d} ≥ r = {r}: Er nimmt nichts weg.",
);
static TAKEN: Template = Template::new(
    "border",
    "The {border} border: d = {d} < r = {r}, α = arccos(d / r) = {half}°. It takes the angles from {from}° to {to}° away.",
    "Am {border} Rand ist d = {d} < r = {r}, α = arccos(d / r) = {half}°. Er nimmt die Winkel von {from}° bis {to}° weg.",
);
static ARC: Template = Template::new(
    "arc",
    "The arc from {start} to {end}, {from}° to {to}°, is inside all borders.",
    "Der Bogen von {start} nach {end}, {from}° bis {to}°, liegt innerhalb aller Ränder.",
);
static WHOLE: Template =
    Template::new("arc", "The whole circle is left.", "Der ganze Kreis bleibt.");

/// Returns an input of a window from the origin and a circle.
fn figure(size: (f64, f64), center: (f64, f64), radius: f64) -> Input {
    let center = DVec2::from(center);
    Input::Figure(Figure {
        window: Rect::new(DVec2::ZERO, size.into()).ok(),
        lines: vec![vec![center, center + DVec2::new(radius, 0.0)]],
        ..Figure::default()
    })
}

/// A border that was compared.
#[derive(Clone)]
struct Compared {
    border: Outcode,
    distance: f64,
    taken: Option<[f64; 2]>,
}

#[derive(Clone)]
struct State {
    window: Rect,
    circle: Circle,
    compared: Vec<Compared>,
    arcs: Vec<Arc>,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let [center, point] = figure.segment(TAKES)?;
    let way = point - center;
    let circle = Circle { center, radius: libm::hypot(way.x, way.y) };
    let window = figure.window(TAKES)?;
    let steps = record(cap, |t| clip(&window, &circle, t))?;
    let mut state = State { window, circle, compared: Vec::new(), arcs: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Box { beyond, .. } if !beyond.is_inside() => {
                BEYOND.with([("code", beyond.into())])
            }
            Step::Box { crossed, .. } if crossed.is_inside() => WITHIN.with([]),
            Step::Box { crossed, .. } => CROSSED.with([("code", crossed.into())]),
            Step::Border { border, distance, taken } => {
                self.compared.push(Compared { border, distance, taken });
                let [name, d] = [("border", border_name(border)), ("d", distance.into())];
                let r = ("r", self.circle.radius.into());
                let Some([from, to]) = taken else { return NOTHING.with([name, d, r]) };
                let half = ("half", degrees((to - from) / 2.0));
                TAKEN.with([name, d, r, half, ("from", degrees(from)), ("to", degrees(to))])
            }
            Step::Arc(arc) => {
                self.arcs.push(arc);
                let [from, to] = arc.angles;
                if to - from == TAU {
                    return WHOLE.with([]);
                }
                ARC.with([
                    ("start", arc.ends[0].into()),
                    ("end", arc.ends[1].into()),
                    ("from", degrees(from)),
                    ("to", degrees(to)),
                ])
            }
        }
    }

    fn table(&self) -> Table {
        let from = Word::new("taken from, °", "weg von, °");
        let mut table = Table::new([
            Word::new("border", "Rand"),
            Word::new("d", "d"),
            from,
            Word::new("to, °", "bis, °"),
        ]);
        for Compared { border, distance, taken } in &self.compared {
            let angles = match *taken {
                Some(angles) => angles.map(degrees),
                None => [NOT_CUT.into(), NOT_CUT.into()],
            };
            let [from, to] = angles;
            let name = SIDES.get(border.0.trailing_zeros() as usize).copied().unwrap_or_default();
            table.row(name, [(*distance).into(), from, to]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let Circle { center, radius } = self.circle;
        let [low, high] = [center - radius, center + radius];
        let mut picture = Picture::around([low, high, self.window.min(), self.window.max()], 0.12);
        picture.frame(&self.window, Look::Window);
        let arc = |[from, to]: [f64; 2]| -> Vec<DVec2> {
            let count = ((to - from) / TAU * 96.0).ceil().max(1.0);
            (0..=count as u32)
                .map(|k| self.circle.at(from + (to - from) * f64::from(k) / count))
                .collect()
        };
        picture.chain(arc([0.0, TAU]), Look::Pale);
        for own in &self.compared {
            own.taken.iter().for_each(|taken| picture.chain(arc(*taken), Look::Second));
        }
        self.arcs.iter().for_each(|own| picture.chain(arc(own.angles), Look::Result));
        picture.dot(center, Look::Thin);
        match *step {
            Step::Box { .. } => {
                let square = Rect::around([low, high]);
                square.iter().for_each(|square| picture.frame(square, Look::Now));
            }
            Step::Border { border, taken, .. } => {
                picture.chain(crate::explain::clip_lines::side(&self.window, border), Look::Now);
                for angle in taken.into_iter().flatten() {
                    picture.dot(self.circle.at(angle), Look::Now);
                }
            }
            Step::Arc(own) => own.ends.iter().for_each(|end| picture.dot(*end, Look::Result)),
        }
        picture
    }
}

const NOT_CUT: Word = Word::new("–", "–");

/// Returns an angle in degrees.
fn degrees(angle: f64) -> Value {
    angle.to_degrees().into()
}
