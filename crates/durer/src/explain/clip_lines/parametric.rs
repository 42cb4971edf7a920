//! Lessons of the methods that find parameters of entry and exit: Cyrus–Beck, Liang–Barsky, and Blinn and Newell's
//! homogeneous coordinates.

use super::{BORDERS, Cutting, NO_HEAD, TAKES, end_name, figure, p};
use crate::Result;
use crate::clip::line::cyrus_beck::{Numbers, Step};
use crate::clip::line::{
    ConvexPolygon, End, HalfSpaceRelation, Segment, cyrus_beck, homogeneous, liang_barsky,
};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture, corners};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3, Rect};
use crate::trace::{PseudocodeLine, Recorder};

pub(super) const CYRUS_BECK: Lesson = Lesson {
    name: cyrus_beck::INFO.name,
    info: &cyrus_beck::INFO,
    takes: Word::new(
        "a line of two points, and a window or a convex ring",
        "eine Strecke und ein Fenster oder ein konvexer Ring",
    ),
    examples: &[
        Example {
            name: "pentagon",
            title: Word::new("a pentagon, entered and left", "ein Fünfeck, betreten und verlassen"),
            input: || pentagon((-3.0, 0.2), (12.5, 5.6)),
        },
        Example {
            name: "missed",
            title: Word::new("left before it is entered", "verlassen, bevor es betreten ist"),
            input: || pentagon((-2.0, 3.0), (7.0, 9.5)),
        },
        Example {
            name: "parallel",
            title: Word::new(
                "parallel to a border and outside",
                "parallel zu einem Rand und außerhalb",
            ),
            input: || figure((10.0, 6.0), (-2.0, 7.0), (12.0, 7.0)),
        },
        Example::new(
            "backwards",
            "from B to A: entering and leaving change places",
            "von B nach A: Betreten und Verlassen tauschen",
            || pentagon((12.5, 5.6), (-3.0, 0.2)),
        ),
        Example::new(
            "inside",
            "both ends inside: no bound changes",
            "beide Enden innen: keine Schranke ändert sich",
            || pentagon((3.0, 2.0), (6.0, 4.0)),
        ),
        Example::new(
            "vertex",
            "through a vertex of the window",
            "durch eine Ecke des Fensters",
            || pentagon((9.0, -1.0), (9.0, 8.0)),
        ),
    ],
    templates: TEMPLATES,
    unreached: &[],
    make: |_, input, _, cap| cyrus_beck(input, cap),
};

pub(super) const LIANG_BARSKY: Lesson = Lesson {
    name: liang_barsky::INFO.name,
    info: &liang_barsky::INFO,
    takes: TAKES,
    examples: RECTANGLES,
    templates: TEMPLATES,
    unreached: &[],
    make: |_, input, _, cap| liang_barsky(input, cap),
};

pub(super) const HOMOGENEOUS: Lesson = Lesson {
    name: homogeneous::INFO.name,
    info: &homogeneous::INFO,
    takes: TAKES,
    examples: RECTANGLES,
    templates: TEMPLATES,
    unreached: &[],
    make: |_, input, _, cap| homogeneous(input, cap),
};

const RECTANGLES: &[Example] = &[
    Example {
        name: "all-borders",
        title: Word::new("all four borders are crossed", "alle vier Ränder werden gekreuzt"),
        input: || figure((10.0, 6.0), (-4.0, -2.5), (12.5, 8.5)),
    },
    Example {
        name: "missed",
        title: Word::new("left before it is entered", "verlassen, bevor es betreten ist"),
        input: || figure((10.0, 6.0), (-4.0, 4.0), (4.0, 9.0)),
    },
    Example {
        name: "parallel",
        title: Word::new("parallel to two borders: p = 0", "parallel zu zwei Rändern: p = 0"),
        input: || figure((10.0, 6.0), (-3.0, 2.0), (7.0, 2.0)),
    },
    Example {
        name: "beyond",
        title: Word::new("both ends beyond one border", "beide Enden jenseits eines Rands"),
        input: || figure((10.0, 6.0), (-4.0, 1.0), (-1.0, 5.0)),
    },
    Example::new("corner", "through a corner: t_E = t_L", "durch eine Ecke: t_E = t_L", || {
        figure((10.0, 6.0), (8.0, 8.0), (12.0, 4.0))
    }),
    Example::new(
        "inside",
        "both ends inside: no bound changes",
        "beide Enden innen: keine Schranke ändert sich",
        || figure((10.0, 6.0), (1.0, 1.0), (8.0, 5.0)),
    ),
];

/// Returns a convex window of five corners and a segment.
pub(super) fn pentagon(start: (f64, f64), end: (f64, f64)) -> Input {
    let corners = vec![p(1.0, 0.5), p(6.5, 0.0), p(9.0, 3.5), p(5.5, 6.5), p(0.5, 5.0)];
    let lines = vec![vec![start.into(), end.into()]];
    Input::Figure(Figure { lines, clip: vec![corners], ..Figure::default() })
}

const TEMPLATES: &[&Template] =
    &[&ENTERING, &LEAVING, &INSIDE, &OUTSIDE, &CUT, &ACCEPTED, &REJECTED];

static ENTERING: Template = Template::new(
    "border",
    "The {border} border: A is outside, B inside; entered at t = {t}. The lower bound is now {lower}.",
    "Am {border} Rand liegt A außen, B innen: betreten bei t = {t}. Die untere Schranke ist nun {lower}.",
);
static LEAVING: Template = Template::new(
    "border",
    "The {border} border: A is inside, B outside; left at t = {t}. The upper bound is now {upper}.",
    "Am {border} Rand liegt A innen, B außen: verlassen bei t = {t}. Die obere Schranke ist nun {upper}.",
);
static INSIDE: Template = Template::new(
    "border",
    "The {border} border: both ends are inside (E = {start} and {end}); the bounds stay.",
    "Am {border} Rand liegen beide Enden innen (E = {start} und {end}): Die Schranken bleiben.",
);
static OUTSIDE: Template = Template::new(
    "border",
    "The {border} border: both ends are outside (E = {start} and {end}).",
    "Am {border} Rand liegen beide Enden außen (E = {start} und {end}).",
);
static CUT: Template = Template::new(
    "cut",
    "Cut at the {border} border: {end} moves to {point}.",
    "Schnitt am {border} Rand: {end} wandert nach {point}.",
);
static ACCEPTED: Template = Template::new(
    "accepted",
    "The lower bound {lower} is not above the upper {upper}: the part between is visible.",
    "Die untere Schranke {lower} liegt nicht über der oberen {upper}: Das Stück dazwischen ist sichtbar.",
);
static REJECTED: Template = Template::new(
    "rejected",
    "Nothing is between the bounds {lower} and {upper}, or everything is beyond one border: rejected.",
    "Zwischen den Schranken {lower} und {upper} liegt nichts, oder alles jenseits eines Rands: abgelehnt.",
);

fn cyrus_beck(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(CYRUS_BECK.takes)?;
    let Some(ring) = figure.clip.first() else {
        let cutting = Cutting::new(input)?;
        let steps = record(cap, |t| cyrus_beck::clip(&cutting.window, cutting.whole, t))?;
        let mut state = State::of_rectangle(cutting.whole, corners(&cutting.window));
        return Ok(Frames::new(steps, move |step, want| state.show(step, want)));
    };
    let window = ConvexPolygon::new(ring)?;
    let [start, end] = figure.segment(CYRUS_BECK.takes)?;
    let whole = Segment::new(start, end);
    let steps = record(cap, |t| cyrus_beck::clip_polygon(&window, whole, t))?;
    let mut state = State::new(whole, window.vertices().to_vec());
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

fn liang_barsky(input: &Input, cap: usize) -> Result<Frames> {
    by_parameters(input, cap, |window, segment, t| liang_barsky::clip(window, segment, t).map(drop))
}

/// Makes the frames of a program that reports steps of parameters at the borders of a window.
pub(in crate::explain) fn by_parameters(
    input: &Input,
    cap: usize,
    program: impl FnOnce(&Rect, Segment<DVec2>, &mut Recorder<Step<DVec2>>) -> Result<()>,
) -> Result<Frames> {
    let cutting = Cutting::new(input)?;
    let steps = record(cap, |t| program(&cutting.window, cutting.whole, t))?;
    let mut state = State::of_rectangle(cutting.whole, corners(&cutting.window));
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

fn homogeneous(input: &Input, cap: usize) -> Result<Frames> {
    let cutting = Cutting::new(input)?;
    let steps = record(cap, |t| homogeneous::clip(&cutting.window, cutting.whole, t))?;
    let mut state = State::of_rectangle(cutting.whole, corners(&cutting.window));
    Ok(Frames::new(steps, move |step, want| state.show(&flat(step), want)))
}

/// Returns the step with its point in the plane.
fn flat(step: &Step<DVec3>) -> Step<DVec2> {
    match *step {
        Step::Border { border, relation, numbers } => Step::Border { border, relation, numbers },
        Step::Cut { end, border, point } => {
            // The null vector has no place; it is shown where its numbers are.
            let w = if point.z == 0.0 { 1.0 } else { point.z };
            Step::Cut { end, border, point: point.truncate() / w }
        }
        Step::Accepted => Step::Accepted,
        Step::Rejected => Step::Rejected,
    }
}

/// A segment before a convex window, with what is known of the borders.
#[derive(Clone)]
struct State {
    whole: Segment<DVec2>,
    left: Segment<DVec2>,
    gone: bool,
    /// Corners of the window, counter-clockwise.
    ring: Vec<DVec2>,
    /// The two corners of each border, in the order of their indices, and its names in sentences and tables.
    borders: Vec<([DVec2; 2], [Word; 2])>,
    seen: Vec<(usize, HalfSpaceRelation, Numbers)>,
}

impl State {
    fn new(whole: Segment<DVec2>, ring: Vec<DVec2>) -> Self {
        let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
        let borders = pairs.zip(NUMBERED.iter().cycle());
        let borders = borders.map(|((&a, &b), &name)| ([a, b], [name; 2])).collect();
        Self { whole, left: whole, gone: false, ring, borders, seen: Vec::new() }
    }

    fn of_rectangle(whole: Segment<DVec2>, [a, b, c, d]: [DVec2; 4]) -> Self {
        let sides = [[d, a], [b, c], [a, b], [c, d]];
        let mut state = Self::new(whole, vec![a, b, c, d]);
        let names = BORDERS.into_iter().zip(SIDES).map(|(sentence, table)| [sentence, table]);
        state.borders = sides.into_iter().zip(names).collect();
        state.borders.push(([a, a], [W_IS_ZERO; 2]));
        state
    }

    fn border(&self, index: usize) -> Value {
        self.borders.get(index).map_or(Value::from(index), |(_, [name, _])| (*name).into())
    }

    /// Returns the name of a border in the table.
    fn row(&self, index: usize) -> Value {
        self.borders.get(index).map_or(Value::from(index), |(_, [_, name])| (*name).into())
    }

    fn bounds(&self) -> [Value; 2] {
        let (lower, upper) = self.seen.last().map_or((0.0, 1.0), |(.., n)| (n.lower, n.upper));
        [lower.into(), upper.into()]
    }

    fn show(&mut self, step: &Step<DVec2>, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(
            step.line(),
            caption,
            || self.table(),
            || {
                let mut picture = self.picture();
                match *step {
                    Step::Border { border, numbers, .. } => {
                        self.add_border(&mut picture, border, numbers)
                    }
                    Step::Cut { point, .. } => picture.dot(point, Look::Now),
                    Step::Accepted => picture.chain([self.left.start, self.left.end], Look::Result),
                    Step::Rejected => {}
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step<DVec2>) -> Caption {
        match *step {
            Step::Border { border, relation, numbers } => {
                self.seen.push((border, relation, numbers));
                border_caption(self.border(border), relation, numbers)
            }
            Step::Cut { end, border, point } => {
                match end {
                    End::Start => self.left.start = point,
                    End::End => self.left.end = point,
                }
                let values = [
                    ("end", end_name(end)),
                    ("border", self.border(border)),
                    ("point", point.into()),
                ];
                CUT.with(values)
            }
            Step::Accepted => {
                let [lower, upper] = self.bounds();
                ACCEPTED.with([("lower", lower), ("upper", upper)])
            }
            Step::Rejected => {
                self.gone = true;
                let [lower, upper] = self.bounds();
                REJECTED.with([("lower", lower), ("upper", upper)])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            NO_HEAD,
            Word::new("E(A) = q", "E(A) = q"),
            Word::new("E(B)", "E(B)"),
            Word::new("p", "p"),
            Word::new("t = q/p", "t = q/p"),
            Word::new("t_E = u1", "t_E = u1"),
            Word::new("t_L = u2", "t_L = u2"),
        ]);
        for (border, _, n) in &self.seen {
            let t = n.t().map_or(Value::from("–"), Value::from);
            let [q, end, p, lower, upper] =
                [n.start, n.end, n.p(), n.lower, n.upper].map(Value::from);
            table.row(self.row(*border), [q, end, p, t, lower, upper]);
        }
        table
    }

    fn picture(&self) -> Picture {
        let ends = [self.whole.start, self.whole.end];
        let mut picture = Picture::around(self.ring.iter().copied().chain(ends), 0.18);
        let mut ring = self.ring.clone();
        ring.extend(self.ring.first());
        picture.chain(ring, Look::Window);
        picture.chain(ends, Look::Pale);
        if !self.gone {
            picture.chain([self.left.start, self.left.end], Look::First);
        }
        for &(_, relation, numbers) in &self.seen {
            let (Some(t), Some(look)) = (numbers.t(), look(relation)) else { continue };
            picture.dot(self.whole.start.lerp(self.whole.end, t), look);
        }
        let apart = if self.whole.start.x <= self.whole.end.x { 9.0 } else { -9.0 };
        picture.label(self.whole.start, (-apart, 0.0), "A");
        picture.label(self.whole.end, (apart, 0.0), "B");
        picture
    }

    /// Draws the line of a border through the whole picture, and the parameter where it is crossed.
    fn add_border(&self, picture: &mut Picture, border: usize, numbers: Numbers) {
        let Some(([a, b], _)) = self.borders.get(border).copied() else { return };
        let [low, high] = picture.extent;
        let along = (b - a).normalize_or_zero() * (high - low).length();
        picture.chain([a - along, b + along], Look::Dashed);
        picture.chain([a, b], Look::Now);
        if let Some(t) = numbers.t().filter(|t| t.abs() < 4.0) {
            let at = self.whole.start.lerp(self.whole.end, t);
            picture.dot(at, Look::Now);
            picture.label(at, (0.0, -12.0), t);
        }
    }
}

/// Returns the look of a crossing that counts: first for entries, second for exits.
fn look(relation: HalfSpaceRelation) -> Option<Look> {
    match relation {
        HalfSpaceRelation::Entering => Some(Look::First),
        HalfSpaceRelation::Leaving => Some(Look::Second),
        HalfSpaceRelation::Inside | HalfSpaceRelation::Outside => None,
    }
}

fn border_caption(border: Value, relation: HalfSpaceRelation, n: Numbers) -> Caption {
    let border = ("border", border);
    let t = ("t", n.t().unwrap_or_default().into());
    let ends = [("start", n.start.into()), ("end", n.end.into())];
    match (relation, ends) {
        (HalfSpaceRelation::Entering, _) => ENTERING.with([border, t, ("lower", n.lower.into())]),
        (HalfSpaceRelation::Leaving, _) => LEAVING.with([border, t, ("upper", n.upper.into())]),
        (HalfSpaceRelation::Inside, [start, end]) => INSIDE.with([border, start, end]),
        (HalfSpaceRelation::Outside, [start, end]) => OUTSIDE.with([border, start, end]),
    }
}

/// The fifth border of homogeneous coordinates.
const W_IS_ZERO: Word = Word::new("w = 0", "w = 0");

/// Names of the borders of a rectangle in tables.
pub(in super::super) const SIDES: [Word; 4] = [
    Word::new("left", "links"),
    Word::new("right", "rechts"),
    Word::new("bottom", "unten"),
    Word::new("top", "oben"),
];

/// Names of the borders of a polygon.
pub(super) const NUMBERED: [Word; 8] = [
    Word::new("first", "ersten"),
    Word::new("second", "zweiten"),
    Word::new("third", "dritten"),
    Word::new("fourth", "vierten"),
    Word::new("fifth", "fünften"),
    Word::new("sixth", "sechsten"),
    Word::new("seventh", "siebten"),
    Word::new("eighth", "achten"),
];
