//! The lessons of lines that light several pixels at a time: run-slice and double-step.

use super::{EXAMPLES, PIXEL, STEP, TAKES, line};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::{Raster, center, log, shown};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::IVec2;
use crate::raster::line::double_step::{self, StepPattern};
use crate::raster::line::run_slice::{self, RunKind};
use crate::trace::PseudocodeLine;

pub(super) const RUN_SLICE: Lesson = Lesson {
    name: run_slice::INFO.name,
    info: &run_slice::INFO,
    takes: TAKES,
    examples: &[SLICES, EXAMPLES[0], EXAMPLES[1], EXAMPLES[3], EXAMPLES[2], EXAMPLES[4]],
    templates: &[&FIRST, &SHORT, &LONG, &CUT],
    unreached: &[],
    make: |_, input, _, cap| make_runs(input, cap),
};

pub(super) const DOUBLE_STEP: Lesson = Lesson {
    name: double_step::INFO.name,
    info: &double_step::INFO,
    takes: TAKES,
    examples: &[
        SLICES,
        EXAMPLES[0],
        EXAMPLES[1],
        Example {
            name: "nearly-diagonal",
            title: Word::new(
                "(0, 0) to (9, 7): patterns 3 and 4",
                "(0; 0) bis (9; 7): Muster 3 und 4",
            ),
            input: || line((0.0, 0.0), (9.0, 7.0)),
        },
        EXAMPLES[2],
        EXAMPLES[3],
    ],
    templates: &[&START, &SIMPLE, &BEFORE, &AFTER, &LAST],
    unreached: &[],
    make: |_, input, _, cap| make_pairs(input, cap),
};

const SLICES: Example = Example {
    name: "slices",
    title: Word::new("(0, 0) to (15, 4): q = 3, r = 6", "(0; 0) bis (15; 4): q = 3, r = 6"),
    input: || line((0.0, 0.0), (15.0, 4.0)),
};

static FIRST: Template = Template::new(
    "run",
    "The first run ends half a step across: {count} {count|pixel|pixels} from {from} to {to}; E = {e}.",
    "Der erste Lauf endet einen halben Schritt weiter: {count} Pixel von {from} bis {to}; E = {e}.",
);
static SHORT: Template = Template::new(
    "run",
    "E − r = {e} is not negative: q = {count} {count|pixel|pixels} from {from} to {to}.",
    "E − r = {e} ist nicht negativ: q = {count} Pixel von {from} bis {to}.",
);
static LONG: Template = Template::new(
    "run",
    "E − r = {e} is negative: q + 1 = {count} {count|pixel|pixels} from {from} to {to}; E grows by 2Δy.",
    "E − r = {e} ist negativ: q + 1 = {count} Pixel von {from} bis {to}; E wächst um 2Δy.",
);
static CUT: Template = Template::new(
    "run",
    "E − r = {e}; the line ends before the run does: {count} {count|pixel|pixels} from {from} to {to}.",
    "E − r = {e}; die Strecke endet vor dem Lauf: {count} Pixel von {from} bis {to}.",
);
static START: Template = Template::new(
    "start",
    "The line is drawn from {pixel}; D = {d}.",
    "Die Strecke wird von {pixel} an gezeichnet; D = {d}.",
);
static SIMPLE: Template = Template::new(
    "pair",
    "D = {d} alone decides: pattern {pattern}, pixels {first} and {second}.",
    "D = {d} entscheidet allein: Muster {pattern}, Pixel {first} und {second}.",
);
static BEFORE: Template = Template::new(
    "pair",
    "D = {d} leaves patterns 2 and 3; beyond the second bound it is 3: diagonally to {first}, straight to {second}.",
    "D = {d} lässt die Muster 2 und 3; jenseits der zweiten Schranke ist es 3: schräg nach {first}, geradeaus nach {second}.",
);
static AFTER: Template = Template::new(
    "pair",
    "D = {d} leaves patterns 2 and 3; on this side of the second bound it is 2: straight to {first}, diagonally to {second}.",
    "D = {d} lässt die Muster 2 und 3; diesseits der zweiten Schranke ist es 2: geradeaus nach {first}, schräg nach {second}.",
);
static LAST: Template = Template::new(
    "last",
    "A single step is left: E = {e} leads to {pixel}.",
    "Ein einzelner Schritt bleibt: E = {e} führt nach {pixel}.",
);

/// A line on the grid, and the pixels of each step so far.
#[derive(Clone)]
struct State {
    raster: Raster,
    ends: [IVec2; 2],
    lit: Vec<Vec<IVec2>>,
}

impl State {
    fn new(input: &Input) -> Result<Self> {
        let ends = input.figure(TAKES)?.segment(TAKES)?;
        let raster = Raster::around(ends);
        Ok(Self { raster, ends: ends.map(|end| raster.pixel(end)), lit: Vec::new() })
    }

    /// Draws the pixels, those of the last step in another colour.
    fn picture(&self) -> Picture {
        let mut picture = self.raster.picture_of_pixels();
        for (number, pixels) in self.lit.iter().enumerate() {
            let is_last = number + 1 == self.lit.len();
            let look = match (is_last, number % 2) {
                (true, _) => Look::Now,
                (false, 0) => Look::First,
                (false, _) => Look::Result,
            };
            pixels.iter().for_each(|pixel| picture.cell(pixel.to_array(), "", look));
        }
        picture.chain(self.ends.map(center), Look::Second);
        picture
    }
}

fn make_runs(input: &Input, cap: usize) -> Result<Frames> {
    let mut state = State::new(input)?;
    let [from, to] = state.ends;
    let steps = record(cap, |t| {
        run_slice::draw(from, to, &Default::default(), |_| {}, t);
        Ok(())
    })?;
    let mut rows: Vec<[Value; 4]> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        state.lit.push(step.pixels().collect());
        let count = Value::from(state.lit.last().map_or(0, Vec::len));
        let kind = match step.run {
            RunKind::First => Word::new("first", "erster"),
            RunKind::Short => Word::new("q", "q"),
            RunKind::Long => Word::new("q + 1", "q + 1"),
        };
        let row = rows.len().into();
        rows.push([row, step.e.into(), kind.into(), count]);
        let heads = [
            STEP,
            Word::new("row", "Reihe"),
            Word::new("E − r", "E − r"),
            Word::new("length", "Länge"),
            Word::new("pixels", "Pixel"),
        ];
        let (line, caption) = (step.line(), run_caption(step));
        want.shown(line, caption, || log(heads, &rows), || state.picture())
    }))
}

fn run_caption(step: &run_slice::Step) -> Caption {
    let [from, to] = step.ends.map(shown);
    let count = step.pixels().count().into();
    let template = match (step.run, step.is_cut) {
        (RunKind::First, _) => &FIRST,
        (_, true) => &CUT,
        (RunKind::Short, false) => &SHORT,
        (RunKind::Long, false) => &LONG,
    };
    template.with([("count", count), ("from", from), ("to", to), ("e", step.e.into())])
}

fn make_pairs(input: &Input, cap: usize) -> Result<Frames> {
    let mut state = State::new(input)?;
    let [from, to] = state.ends;
    let steps = record(cap, |t| {
        double_step::draw(from, to, &Default::default(), |_| {}, t);
        Ok(())
    })?;
    let mut rows: Vec<[Value; 4]> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        state.lit.push(step.pixels().to_vec());
        let lit: Value = step.pixels().iter().copied().map(shown).collect::<Vec<_>>().into();
        let (d, pattern, decisions) = match *step {
            double_step::Step::Start { d, .. } => (d, "".into(), 0),
            double_step::Step::Pair { pattern, d, .. } => {
                (d, Value::from(u32::from(pattern.number())), pattern.decisions())
            }
            double_step::Step::Last { e, .. } => (e, "".into(), 1),
        };
        rows.push([d.into(), pattern, decisions.into(), lit]);
        let heads = [
            STEP,
            Word::new("D", "D"),
            Word::new("pattern", "Muster"),
            Word::new("decisions", "Entscheidungen"),
            PIXEL,
        ];
        let (line, caption) = (step.line(), pair_caption(step));
        want.shown(line, caption, || log(heads, &rows), || state.picture())
    }))
}

fn pair_caption(step: &double_step::Step) -> Caption {
    match *step {
        double_step::Step::Start { pixel, d } => {
            START.with([("pixel", shown(pixel)), ("d", d.into())])
        }
        double_step::Step::Last { e, pixel } => {
            LAST.with([("e", e.into()), ("pixel", shown(pixel))])
        }
        double_step::Step::Pair { pattern, d, pixels } => {
            let [first, second] = pixels.map(shown);
            let [d, first, second] = [("d", d.into()), ("first", first), ("second", second)];
            match pattern {
                StepPattern::Straight | StepPattern::Aslant => {
                    let number = ("pattern", u32::from(pattern.number()).into());
                    SIMPLE.with([d, number, first, second])
                }
                StepPattern::First => BEFORE.with([d, first, second]),
                StepPattern::Second => AFTER.with([d, first, second]),
            }
        }
    }
}
