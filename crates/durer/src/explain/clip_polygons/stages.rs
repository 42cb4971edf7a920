//! The lesson of Sutherland and Hodgman's stages.

use super::{ALONG, AROUND, BESIDE, TAKES_WINDOW, before, letter, ring, ring_and_window, windowed};
use crate::Result;
use crate::clip::line::HalfPlane;
use crate::clip::polygon::sutherland_hodgman::INFO;
use crate::clip::polygon::sutherland_hodgman::by_borders::{EdgeRule, Step, clip};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid;
use crate::explain::input::{Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Recorder};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES_WINDOW,
    examples: &[
        Example {
            name: "triangle",
            title: Word::new(
                "the lecture's triangle at four borders",
                "das Dreieck der Vorlesung an vier Rändern",
            ),
            input: || {
                windowed(ring(&[(-6.0, 12.0), (14.0, 4.0), (6.0, -8.0)]), (0.0, 0.0), (10.0, 10.0))
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
            name: "abcd",
            title: Word::new("of A, B, C, D only D is out", "von A, B, C, D liegt nur D außen"),
            input: || {
                windowed(
                    ring(&[(2.0, 8.0), (2.0, 2.0), (8.0, 2.0), (8.0, 14.0)]),
                    (0.0, 0.0),
                    (10.0, 10.0),
                )
            },
        },
        AROUND,
        ALONG,
        BESIDE,
    ],
    templates: &[&IN_IN, &IN_OUT, &OUT_IN, &OUT_OUT, &LIST, &LAST],
    unreached: &[],
    make,
};

static IN_IN: Template = Template::new(
    "edge",
    "{border} border, edge {from} → {to}: in→in, the end is emitted.",
    "{border} Rand, Kante {from} → {to}: innen→innen, das Ende wird ausgegeben.",
);
static IN_OUT: Template = Template::new(
    "edge",
    "{border} border, edge {from} → {to}: in→out, the cut {cut} is emitted.",
    "{border} Rand, Kante {from} → {to}: innen→außen, der Schnitt {cut} wird ausgegeben.",
);
static OUT_IN: Template = Template::new(
    "edge",
    "{border} border, edge {from} → {to}: out→in, the cut {cut} and the end are emitted.",
    "{border} Rand, Kante {from} → {to}: außen→innen, Schnitt {cut} und Ende werden ausgegeben.",
);
static OUT_OUT: Template = Template::new(
    "edge",
    "{border} border, edge {from} → {to}: out→out, nothing is emitted.",
    "{border} Rand, Kante {from} → {to}: außen→außen, nichts wird ausgegeben.",
);
static LIST: Template = Template::new(
    "list",
    "{border} border done: {count} {count|vertex is left and goes|vertices are left and go} to the next border.",
    "{border} Rand fertig: {count} {count|Ecke bleibt und geht|Ecken bleiben und gehen} zum nächsten Rand.",
);
static LAST: Template = Template::new(
    "list",
    "{border} border done, the last one: {count} {count|vertex is|vertices are} the result.",
    "{border} Rand fertig, der letzte: {count} {count|Ecke ist|Ecken sind} das Ergebnis.",
);

/// The most vertices that have room for their names.
const NAMED: usize = 40;

/// The borders in the order of the lecture.
const BORDERS: [Word; 4] = [
    Word::new("Top", "Oberer"),
    Word::new("Right", "Rechter"),
    Word::new("Bottom", "Unterer"),
    Word::new("Left", "Linker"),
];

#[derive(Clone)]
struct State {
    ring: Vec<DVec2>,
    window: Rect,
    /// The list that goes into the border.
    list: Vec<DVec2>,
    /// Vertices that have been emitted.
    out: Vec<DVec2>,
    border: usize,
    /// The lists after the borders that are done.
    lists: Vec<Vec<DVec2>>,
    /// All vertices, by which they are named: those of the subject by letters, then cuts by numbers.
    known: Vec<DVec2>,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    by_stages(input, cap, |borders, ring, t| clip(borders, ring, t).map(drop))
}

/// Makes the frames of a program that clips a ring to one border after the other.
pub(in crate::explain) fn by_stages(
    input: &Input,
    cap: usize,
    program: impl FnOnce(&[HalfPlane; 4], &[DVec2], &mut Recorder<Step<DVec2>>) -> Result<()>,
) -> Result<Frames> {
    let (ring, window) = ring_and_window(input)?;
    let [left, right, bottom, top] = HalfPlane::of_rect(&window);
    let steps = record(cap, |t| program(&[top, right, bottom, left], &ring, t))?;
    let (list, known) = (ring.clone(), ring.clone());
    let (out, lists) = (Vec::new(), Vec::new());
    let mut state = State { ring, window, list, out, border: 0, lists, known };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

fn name(border: usize) -> Value {
    BORDERS.get(border).copied().unwrap_or_default().into()
}

impl State {
    fn show(&mut self, step: &Step<DVec2>, want: Want) -> Shown {
        let caption = self.take(step);
        let picture = || {
            let mut picture = self.picture();
            let dots = |picture: &mut Picture, p: &DVec2| picture.dot(*p, Look::Result);
            match step {
                Step::Edge { from, to, emitted, .. } => {
                    picture.arrow(*from, *to, Look::Now);
                    emitted.iter().flatten().for_each(|p| dots(&mut picture, p));
                }
                Step::List { vertices, .. } => {
                    if self.lists.len() == BORDERS.len() {
                        picture.ring(vertices.clone(), Look::Result);
                    }
                    vertices.iter().for_each(|p| dots(&mut picture, p));
                }
            }
            picture
        };
        let shown = want.shown(step.line(), caption, || self.table(), picture);
        if let Step::List { vertices, .. } = step {
            self.list.clone_from(vertices);
            self.out.clear();
            self.border += 1;
        }
        shown
    }

    fn take(&mut self, step: &Step<DVec2>) -> Caption {
        match step {
            Step::Edge { border, from, to, rule, emitted } => {
                self.out.extend(emitted.iter().flatten());
                emitted.iter().flatten().for_each(|&p| self.learn(p));
                let border = ("border", name(*border));
                let (from, to) = (("from", self.placed(*from)), ("to", self.placed(*to)));
                let on = Word::new("(an end on the border)", "(ein Ende auf dem Rand)");
                let cut = ("cut", emitted[0].map_or(Value::from(on), |cut| self.placed(cut)));
                match rule {
                    EdgeRule::InIn => IN_IN.with([border, from, to]),
                    EdgeRule::InOut => IN_OUT.with([border, from, to, cut]),
                    EdgeRule::OutIn => OUT_IN.with([border, from, to, cut]),
                    EdgeRule::OutOut => OUT_OUT.with([border, from, to]),
                }
            }
            Step::List { border, vertices } => {
                self.lists.push(vertices.clone());
                self.out.clone_from(vertices);
                let template = if self.lists.len() == BORDERS.len() { &LAST } else { &LIST };
                template.with([("border", name(*border)), ("count", vertices.len().into())])
            }
        }
    }

    /// Names a vertex that has no name yet.
    fn learn(&mut self, p: DVec2) {
        if !self.known.contains(&p) {
            self.known.push(p);
        }
    }

    /// Returns the name of a vertex: a letter of the subject, or the number of a cut.
    fn vertex(&self, p: DVec2) -> Value {
        match self.known.iter().position(|&known| known == p) {
            Some(cut) if cut >= self.ring.len() => (cut - self.ring.len() + 1).into(),
            Some(vertex) => grid::letter(vertex).into(),
            None => p.into(),
        }
    }

    /// Returns the name of a vertex, and its place.
    fn placed(&self, p: DVec2) -> Value {
        Value::List(vec![self.vertex(p), p.into()])
    }

    fn names(&self, list: &[DVec2]) -> Value {
        Value::List(list.iter().map(|&p| self.vertex(p)).collect())
    }

    fn table(&self) -> Table {
        let mut table = Table::new([Word::new("after", "nach"), Word::new("vertices", "Ecken")]);
        table.row(Word::new("subject", "Subjekt"), [self.names(&self.ring)]);
        for (border, list) in self.lists.iter().enumerate() {
            table.row(name(border), [self.names(list)]);
        }
        if self.lists.len() == self.border {
            table.row(name(self.border), [self.names(&self.out)]);
        }
        table
    }

    /// Draws the list that goes in, the whole line of the border, and the list that comes out.
    fn picture(&self) -> Picture {
        let mut picture = before(&self.ring, &self.window);
        picture.ring(self.list.clone(), Look::First);
        let (low, high) = (self.window.min(), self.window.max());
        let [from, to] = picture.extent;
        let through = match self.border {
            0 => [DVec2::new(from.x, high.y), DVec2::new(to.x, high.y)],
            1 => [DVec2::new(high.x, from.y), DVec2::new(high.x, to.y)],
            2 => [DVec2::new(from.x, low.y), DVec2::new(to.x, low.y)],
            _ => [DVec2::new(low.x, from.y), DVec2::new(low.x, to.y)],
        };
        picture.chain(through, Look::Dashed);
        picture.chain(self.out.clone(), Look::Result);
        // Which side counts as inside is marked at an end of the line.
        let (end, inward) = match self.border {
            0 => (through[1], (-22.0, 11.0)),
            1 => (through[1], (-22.0, 11.0)),
            2 => (through[1], (-22.0, -11.0)),
            _ => (through[1], (22.0, 11.0)),
        };
        let outward = if self.border.is_multiple_of(2) {
            (inward.0, -inward.1)
        } else {
            (-inward.0, inward.1)
        };
        picture.label(end, inward, Word::new("in", "innen"));
        picture.label(end, outward, Word::new("out", "außen"));
        self.add_names(&mut picture);
        picture
    }

    /// Writes the names of the vertices that go in and come out beside them, away from the middle.
    fn add_names(&self, picture: &mut Picture) {
        let mut all: Vec<DVec2> = Vec::new();
        for p in self.list.iter().chain(&self.out) {
            if !all.contains(p) {
                all.push(*p);
            }
        }
        if all.len() > NAMED {
            return;
        }
        let middle = all.iter().sum::<DVec2>() / all.len().max(1) as f64;
        for p in all {
            let out = (p - middle).normalize_or(DVec2::Y) * 12.0;
            picture.label(p, (out.x, -out.y), self.vertex(p));
        }
    }
}
