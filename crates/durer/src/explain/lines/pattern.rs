//! The lesson of thick and stippled lines on pixels.

use super::{PIXEL, STEP};
use crate::explain::frame::{Frames, Numbered, record};
use crate::explain::grid::{Raster, center, log, shown};
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::words::{Template, Value, Word};
use crate::math::{DVec2, IVec2};
use crate::raster::line::pattern::{INFO, Options, PenShape, Step, draw, replay};
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&DOWN, &UP],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "lines, in pixels: the first is drawn one pixel wide, the second three, the third with a square pen",
    "Linien in Pixeln: die erste ein Pixel breit, die zweite drei, die dritte mit quadratischem Stift",
);

const EXAMPLES: &[Example] = &[
    Example {
        name: "corner",
        title: Word::new(
            "the pattern continues around a corner",
            "das Muster läuft um eine Ecke weiter",
        ),
        input: || lines(&[&[(0.0, 1.0), (11.0, 1.0), (11.0, 7.0)]]),
    },
    Example {
        name: "pens",
        title: Word::new("three pens along one slope", "drei Stifte bei einer Steigung"),
        input: || {
            lines(&[
                &[(1.0, 9.0), (9.0, 13.0)],
                &[(1.0, 5.0), (9.0, 9.0)],
                &[(1.0, 1.0), (9.0, 5.0)],
            ])
        },
    },
    Example::new(
        "short",
        "a line shorter than one dash",
        "eine Linie, kürzer als ein Strich",
        || lines(&[&[(1.0, 1.0), (3.0, 1.0)]]),
    ),
    Example::new(
        "diagonal",
        "along the diagonal: a step counts as one pixel",
        "längs der Diagonalen: ein Schritt zählt als ein Pixel",
        || lines(&[&[(0.0, 0.0), (11.0, 11.0)]]),
    ),
    Example::new("steep", "steep and downwards", "steil und abwärts", || {
        lines(&[&[(4.0, 14.0), (1.0, 0.0)]])
    }),
    Example::new(
        "zigzag",
        "a zigzag of short pieces: the pattern does not begin anew",
        "ein Zickzack aus kurzen Stücken: Das Muster beginnt nicht neu",
        || lines(&[&[(0.0, 0.0), (3.0, 3.0), (6.0, 0.0), (9.0, 3.0), (12.0, 0.0)]]),
    ),
];

fn lines(all: &[&[(f64, f64)]]) -> Input {
    let line = |line: &&[(f64, f64)]| line.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { lines: all.iter().map(line).collect(), ..Figure::default() })
}

static DOWN: Template = Template::new(
    "pixel",
    "{pixel}, step {step}: bit ⌊{step} / {repeat}⌋ mod 16 = {bit} of the pattern is 1, the pen is down.",
    "{pixel}, Schritt {step}: Bit ⌊{step} / {repeat}⌋ mod 16 = {bit} des Musters ist 1, der Stift ist unten.",
);
static UP: Template = Template::new(
    "pixel",
    "{pixel}, step {step}: bit ⌊{step} / {repeat}⌋ mod 16 = {bit} of the pattern is 0, the pen is up.",
    "{pixel}, Schritt {step}: Bit ⌊{step} / {repeat}⌋ mod 16 = {bit} des Musters ist 0, der Stift ist oben.",
);

/// Dots and dashes, the lowest bit first: four on, two off, one on, one off, twice.
const PATTERN: u16 = 0b0100_1111_0100_1111;

/// Pens of the lines in turn.
const PENS: [PenShape; 3] = [PenShape::Replicated(1), PenShape::Replicated(3), PenShape::Square(3)];

/// A straight piece with its options.
#[derive(Clone)]
struct Piece {
    ends: [IVec2; 2],
    options: Options,
    steps: Vec<Step>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let given = &input.figure(TAKES)?.lines;
    let points = || given.iter().filter(|line| line.len() > 1);
    if points().next().is_none() {
        return Err(Error::parameter("input", "without a line", TAKES.en));
    }
    let raster = Raster::around(points().flatten().copied());
    let mut pieces: Vec<Piece> = Vec::new();
    for (line, pen) in points().zip(PENS.into_iter().cycle()) {
        let mut offset = 0;
        for pair in line.windows(2) {
            let ends @ [from, to] = [pair[0], pair[1]].map(|p| raster.pixel(p));
            let options = Options { pen, pattern: PATTERN, repeat: 1, offset };
            offset += (to - from).abs().max_element() as u64;
            pieces.push(Piece { ends, options, steps: Vec::new() });
        }
    }
    // One recorder for all pieces, each step with the number of its piece.
    let steps = record(cap, |t| {
        for (number, Piece { ends: [from, to], options, .. }) in pieces.iter().enumerate() {
            draw(*from, *to, options, |_| {}, &mut Numbered { number, t: &mut *t });
        }
        Ok(())
    })?;
    let mut rows: Vec<[Value; 4]> = Vec::new();
    Ok(Frames::new(steps, move |(number, step), want| {
        let options = pieces[*number].options;
        pieces[*number].steps.push(*step);
        let place = options.offset + step.step;
        let bit = place / u64::from(options.repeat) % 16;
        let [at, bit_at] = [place as f64, bit as f64].map(Value::from);
        let down = u32::from(step.down);
        rows.push([shown(step.pixel), at.clone(), bit_at.clone(), down.into()]);
        let template = if step.down { &DOWN } else { &UP };
        let caption = template.with([
            ("pixel", shown(step.pixel)),
            ("step", at),
            ("repeat", options.repeat.into()),
            ("bit", bit_at),
        ]);
        let heads =
            [STEP, PIXEL, Word::new("s", "s"), Word::new("bit", "Bit"), Word::new("value", "Wert")];
        want.shown(
            step.line(),
            caption,
            || log(heads, &rows),
            || picture(&raster, &pieces, step.pixel),
        )
    }))
}

fn picture(raster: &Raster, pieces: &[Piece], now: IVec2) -> Picture {
    let mut picture = raster.picture_of_pixels();
    for Piece { ends: [from, to], options, steps } in pieces {
        for pixel in replay(*from, *to, options, steps) {
            picture.cell(pixel.to_array(), "", Look::First);
        }
    }
    for Piece { ends, steps, .. } in pieces {
        picture.chain(ends.map(center), Look::Second);
        let up = steps.iter().filter(|step| !step.down);
        up.for_each(|step| picture.dot(center(step.pixel), Look::Pale));
    }
    picture.dot(center(now), Look::Now);
    picture
}
