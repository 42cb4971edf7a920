//! The lessons of thin lines: the equation, the digital differential analyzer, Bresenham.

use super::{EXAMPLES, PIXEL, STEP, TAKES};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::{Raster, add_pixels, center, log, shown};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, IVec2};
use crate::raster::line::{self, LineRasterizer, Step, bresenham, dda, equation};
use crate::trace::{PseudocodeLine, Recorder};

pub(super) const EQUATION: Lesson = Lesson {
    name: equation::INFO.name,
    info: &equation::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&COMPUTED],
    unreached: &[],
    make: |_, input, _, cap| make(LineRasterizer::Equation, input, cap),
};

pub(super) const DDA: Lesson = Lesson {
    name: dda::INFO.name,
    info: &dda::INFO,
    templates: &[&SUMMED],
    make: |_, input, _, cap| make(LineRasterizer::Dda, input, cap),
    ..EQUATION
};

pub(super) const BRESENHAM: Lesson = Lesson {
    name: bresenham::INFO.name,
    info: &bresenham::INFO,
    templates: &[&ASLANT, &STRAIGHT, &LAST],
    make: |_, input, _, cap| make(LineRasterizer::Bresenham, input, cap),
    ..EQUATION
};

static COMPUTED: Template = Template::new(
    "pixel",
    "{from} + {m} · {done} = {across}, rounded: pixel {pixel}.",
    "{from} + {m} · {done} = {across}, gerundet: Pixel {pixel}.",
);
static SUMMED: Template = Template::new(
    "pixel",
    "The sum is {across}, rounded: pixel {pixel}; then {m} is added.",
    "Die Summe ist {across}, gerundet: Pixel {pixel}; dann wird {m} addiert.",
);
static ASLANT: Template = Template::new(
    "aslant",
    "Pixel {pixel}. E = {e}: the line passes beyond the midpoint, so the step is diagonal; E ← {e} {change} = {sum}.",
    "Pixel {pixel}. E = {e}: Die Strecke läuft jenseits der Mitte, das nächste Pixel liegt schräg; E ← {e} {change} = {sum}.",
);
static STRAIGHT: Template = Template::new(
    "straight",
    "Pixel {pixel}. E = {e}: the line stays on this side of the midpoint, so the step is straight; E ← {e} {change} = {sum}.",
    "Pixel {pixel}. E = {e}: Die Strecke bleibt diesseits der Mitte, es geht geradeaus; E ← {e} {change} = {sum}.",
);
static LAST: Template = Template::new(
    "last",
    "Pixel {pixel} is the end of the line.",
    "Pixel {pixel} ist das Ende der Strecke.",
);

/// A line and its pixels so far.
#[derive(Clone)]
struct State {
    method: LineRasterizer,
    ends: [IVec2; 2],
    raster: Raster,
    /// Pixels of all steps.
    all: Vec<IVec2>,
    pixels: Vec<IVec2>,
    rows: Vec<[Value; 3]>,
}

fn make(method: LineRasterizer, input: &Input, cap: usize) -> Result<Frames> {
    by_pixels(method, input, cap, |from, to, t| {
        method.draw(from, to, &line::Options::default(), |_| {}, t);
    })
}

/// Makes the frames of a program that sets the pixels of a line one after the other.
pub(in crate::explain) fn by_pixels(
    method: LineRasterizer,
    input: &Input,
    cap: usize,
    program: impl FnOnce(IVec2, IVec2, &mut Recorder<Step>),
) -> Result<Frames> {
    let ends = input.figure(TAKES)?.segment(TAKES)?;
    let raster = Raster::around(ends);
    let ends @ [from, to] = ends.map(|end| raster.pixel(end));
    let steps = record(cap, |t| {
        program(from, to, t);
        Ok(())
    })?;
    let all = steps.steps().iter().map(|step| step.pixel).collect();
    let (pixels, rows) = (Vec::new(), Vec::new());
    let mut state = State { method, ends, raster, all, pixels, rows };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let next = self.all.get(self.pixels.len() + 1).copied();
        let caption = self.caption(step, next);
        self.pixels.push(step.pixel);
        let what = match self.method {
            LineRasterizer::Bresenham => [Value::from(step.e), turn(step.pixel, next)],
            _ => [step.across.into(), nearest(step, self.is_steep()).into()],
        };
        let [a, b] = what;
        self.rows.push([shown(step.pixel), a, b]);
        let [third, fourth] = self.heads();
        let table = || log([STEP, PIXEL, third, fourth], &self.rows);
        want.shown(step.line(), caption, table, || self.picture(step, next))
    }

    fn heads(&self) -> [Word; 2] {
        let value = if self.is_steep() { Word::new("x", "x") } else { Word::new("y", "y") };
        match self.method {
            LineRasterizer::Bresenham => [Word::new("E", "E"), Word::new("next", "weiter")],
            _ => [value, Word::new("rounded", "gerundet")],
        }
    }

    fn is_steep(&self) -> bool {
        let way = (self.ends[1] - self.ends[0]).abs();
        way.y > way.x
    }

    /// Returns the lengths along and across, both positive.
    fn extent(&self) -> [i64; 2] {
        let way = (self.ends[1] - self.ends[0]).abs();
        [way.max_element(), way.min_element()].map(i64::from)
    }

    fn caption(&self, step: &Step, next: Option<IVec2>) -> Caption {
        let pixel = ("pixel", shown(step.pixel));
        let [run, rise] = self.extent();
        let way = self.ends[1] - self.ends[0];
        let down = if self.is_steep() { way.x < 0 } else { way.y < 0 };
        let sign = if down { -1.0 } else { 1.0 };
        let m = sign * rise as f64 / run.max(1) as f64;
        let across = ("across", step.across.into());
        match (self.method, next) {
            (LineRasterizer::Equation, _) => {
                let [from, _] = self.ends;
                let from = if self.is_steep() { from.x } else { from.y };
                let done = ("done", self.pixels.len().into());
                COMPUTED.with([("from", from.into()), ("m", m.into()), done, across, pixel])
            }
            (LineRasterizer::Dda, _) => SUMMED.with([across, pixel, ("m", m.into())]),
            (_, None) => LAST.with([pixel]),
            (_, Some(next)) => {
                let aslant = is_aslant(step.pixel, next);
                let add = if aslant { 2 * rise - 2 * run } else { 2 * rise };
                let template = if aslant { &ASLANT } else { &STRAIGHT };
                let sign = if add < 0 { '−' } else { '+' };
                let change = format!("{sign} {}", add.abs());
                let sum = ("sum", (step.e + add).into());
                template.with([pixel, ("e", step.e.into()), ("change", change.into()), sum])
            }
        }
    }

    fn picture(&self, step: &Step, next: Option<IVec2>) -> Picture {
        let mut picture = self.raster.picture_of_pixels();
        add_pixels(&mut picture, &self.pixels);
        picture.chain(self.ends.map(center), Look::Second);
        let across = step.across + 0.5;
        let middle = center(step.pixel);
        let on_line = if self.is_steep() {
            DVec2::new(across, middle.y)
        } else {
            DVec2::new(middle.x, across)
        };
        match next.filter(|_| self.method == LineRasterizer::Bresenham) {
            // The midpoint of the two pixels that may come next.
            Some(_) => picture.dot(self.midpoint(step.pixel), Look::Window),
            None => picture.chain([middle, on_line], Look::Window),
        }
        picture.dot(on_line, Look::Second);
        picture
    }

    fn midpoint(&self, pixel: IVec2) -> DVec2 {
        let way = (self.ends[1] - self.ends[0]).signum();
        let along = if self.is_steep() { IVec2::new(0, way.y) } else { IVec2::new(way.x, 0) };
        center(pixel) + along.as_dvec2() + (way - along).as_dvec2() * 0.5
    }
}

fn is_aslant(pixel: IVec2, next: IVec2) -> bool {
    (next - pixel).abs() == IVec2::ONE
}

/// Returns whether the next pixel lies straight on or aslant.
fn turn(pixel: IVec2, next: Option<IVec2>) -> Value {
    match next {
        None => "".into(),
        Some(next) if is_aslant(pixel, next) => Word::new("aslant", "schräg").into(),
        Some(_) => Word::new("straight on", "geradeaus").into(),
    }
}

/// Returns the coordinate across of a step's pixel.
fn nearest(step: &Step, steep: bool) -> i32 {
    if steep { step.pixel.x } else { step.pixel.y }
}
