//! The lesson of Skala's clipping by the signs of corners.

use super::parametric::NUMBERED;
use super::{BORDERS, Cutting, TAKES, end_name, figure};
use crate::Result;
use crate::clip::line::skala::{INFO, Step, clip, clip_polygon};
use crate::clip::line::{ConvexPolygon, End, Segment};
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture, corners};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use std::cmp::Ordering;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: super::parametric::CYRUS_BECK.takes,
    examples: &[
        Example {
            name: "all-outside",
            title: Word::new("in on the left, out on top", "links hinein, oben hinaus"),
            input: || figure((10.0, 6.0), (-4.0, 1.0), (10.0, 8.0)),
        },
        Example {
            name: "through-corner",
            title: Word::new(
                "through a corner: a sign is 0",
                "durch eine Ecke: Ein Vorzeichen ist 0",
            ),
            input: || figure((10.0, 6.0), (-2.0, 4.0), (2.0, 8.0)),
        },
        Example {
            name: "pentagon",
            title: Word::new("a pentagon as window", "ein Fünfeck als Fenster"),
            input: || super::parametric::pentagon((-3.0, 0.2), (12.5, 5.6)),
        },
        Example {
            name: "missed",
            title: Word::new("all corners on one side", "alle Ecken auf einer Seite"),
            input: || figure((10.0, 6.0), (-4.0, 3.0), (3.0, 9.5)),
        },
        Example {
            name: "beyond",
            title: Word::new("both ends beyond one border", "beide Enden jenseits eines Rands"),
            input: || figure((10.0, 6.0), (-4.0, 1.0), (-1.0, 5.0)),
        },
        Example {
            name: "inside",
            title: Word::new("inside: no line is computed", "innen: Keine Gerade wird berechnet"),
            input: || figure((10.0, 6.0), (2.0, 1.0), (8.0, 4.0)),
        },
    ],
    templates: &[&LINE, &CORNER, &CUT, &AT_ONCE, &ACCEPTED, &BEYOND, &ONE_SIDE],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static LINE: Template = Template::new(
    "line",
    "A × B = {line} is the line a·x + b·y + c = 0 through both ends.",
    "A × B = {line} ist die Gerade a·x + b·y + c = 0 durch beide Enden.",
);
static CORNER: Template = Template::new(
    "corner",
    "Corner {corner}: a·x + b·y + c = {value}; the code goes on with {sign}.",
    "Ecke {corner}: a·x + b·y + c = {value}; der Code geht mit {sign} weiter.",
);
static CUT: Template = Template::new(
    "cut",
    "Code {code}: the {border} border is crossed, and {end} is beyond it: it moves to {point}.",
    "Code {code}: Die Gerade kreuzt den {border} Rand, {end} liegt jenseits davon und wandert nach {point}.",
);
static AT_ONCE: Template = Template::new(
    "accepted",
    "Both ends are inside all borders: accepted, nothing is computed.",
    "Beide Enden liegen innerhalb aller Ränder: angenommen, nichts wird berechnet.",
);
static ACCEPTED: Template = Template::new(
    "accepted",
    "Accepted: {cuts} {cuts|crossing was|crossings were} computed, each an end of the result.",
    "Angenommen: {cuts} {cuts|Schnittpunkt wurde|Schnittpunkte wurden} berechnet, jeder ein Ende des Ergebnisses.",
);
static BEYOND: Template = Template::new(
    "rejected",
    "Both ends are beyond the {border} border: rejected, nothing is computed.",
    "Beide Enden liegen jenseits des {border} Rands: abgelehnt, nichts wird berechnet.",
);
static ONE_SIDE: Template = Template::new(
    "rejected",
    "Code {code}: the whole window is on one side of the line; rejected without a crossing.",
    "Code {code}: Das ganze Fenster liegt auf einer Seite der Geraden; abgelehnt ohne Schnittpunkt.",
);

/// A segment before a window, and the signs so far.
#[derive(Clone)]
struct State {
    corners: Vec<DVec2>,
    is_rectangle: bool,
    whole: Segment<DVec2>,
    left: Segment<DVec2>,
    gone: bool,
    signs: Vec<(f64, Ordering)>,
    cuts: usize,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(LESSON.takes)?;
    let [start, end] = figure.segment(TAKES)?;
    let whole = Segment::new(start, end);
    let ring = figure.clip.first();
    let (steps, corners) = if let Some(ring) = ring {
        let window = ConvexPolygon::new(ring)?;
        (record(cap, |t| clip_polygon(&window, whole, t))?, window.vertices().to_vec())
    } else {
        let window = Cutting::new(input)?.window;
        (record(cap, |t| clip(&window, whole, t))?, corners(&window).to_vec())
    };
    let is_rectangle = ring.is_none();
    let (signs, left, gone, cuts) = (Vec::new(), whole, false, 0);
    let mut state = State { corners, is_rectangle, whole, left, gone, signs, cuts };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Line { coefficients } => LINE.with([("line", coefficients.into())]),
            Step::Corner { corner, value, side } => {
                self.signs.push((value, side));
                CORNER.with([
                    ("corner", self.corner(corner).into()),
                    ("value", value.into()),
                    ("sign", sign(side).into()),
                ])
            }
            Step::Cut { end, border, point } => {
                self.left = match end {
                    End::Start => Segment::new(point, self.left.end),
                    End::End => Segment::new(self.left.start, point),
                };
                self.cuts += 1;
                let border = ("border", self.border(border));
                let code = ("code", self.code());
                CUT.with([code, border, ("end", end_name(end)), ("point", point.into())])
            }
            Step::Accepted { at_once: true } => AT_ONCE.with([]),
            Step::Accepted { at_once: false } => ACCEPTED.with([("cuts", self.cuts.into())]),
            Step::Rejected { beyond } => {
                self.gone = true;
                match beyond {
                    Some(border) => BEYOND.with([("border", self.border(border))]),
                    None => ONE_SIDE.with([("code", self.code())]),
                }
            }
        }
    }

    fn corner(&self, corner: usize) -> DVec2 {
        self.corners.get(corner).copied().unwrap_or_default()
    }

    /// Returns the adjective for a border.
    fn border(&self, border: usize) -> Value {
        let names: &[Word] = if self.is_rectangle { &BORDERS } else { &NUMBERED };
        names.get(border).map_or_else(|| format!("{}.", border + 1).into(), |name| (*name).into())
    }

    /// Returns the signs so far, the first corner's first.
    fn code(&self) -> Value {
        self.signs.iter().map(|(_, side)| sign(*side)).collect::<String>().into()
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("corner", "Ecke"),
            Word::new("a·x + b·y + c", "a·x + b·y + c"),
            Word::new("sign", "Vorzeichen"),
        ];
        let mut table = Table::new(heads);
        for (corner, &(value, side)) in self.signs.iter().enumerate() {
            table.row(self.corner(corner), [value.into(), sign(side).into()]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let Segment { start, end } = self.whole;
        let points = self.corners.iter().copied().chain([start, end]);
        let mut picture = Picture::around(points, 0.18);
        let ring: Vec<DVec2> = self.corners.iter().chain(self.corners.first()).copied().collect();
        picture.chain(ring, Look::Window);
        if !matches!(step, Step::Accepted { at_once: true } | Step::Rejected { beyond: Some(_) }) {
            let along = (end - start).normalize_or_zero();
            let far = (picture.extent[1] - picture.extent[0]).length();
            picture.chain([start - along * far, end + along * far], Look::Dashed);
        }
        picture.chain([start, end], Look::Pale);
        if !self.gone {
            let look =
                if matches!(step, Step::Accepted { .. }) { Look::Result } else { Look::First };
            picture.chain([self.left.start, self.left.end], look);
        }
        for (corner, (_, side)) in self.signs.iter().enumerate() {
            let look = match side {
                Ordering::Greater => Look::First,
                Ordering::Equal => Look::Result,
                Ordering::Less => Look::Second,
            };
            picture.named(self.corner(corner), sign(*side), look);
        }
        match *step {
            Step::Corner { corner, .. } => picture.dot(self.corner(corner), Look::Now),
            Step::Cut { point, .. } => picture.dot(point, Look::Now),
            _ => {}
        }
        let apart = if start.x <= end.x { 9.0 } else { -9.0 };
        picture.label(start, (-apart, 0.0), "A");
        picture.label(end, (apart, 0.0), "B");
        picture
    }
}

fn sign(side: Ordering) -> &'static str {
    match side {
        Ordering::Less => "−",
        Ordering::Equal => "0",
        Ordering::Greater => "+",
    }
}
