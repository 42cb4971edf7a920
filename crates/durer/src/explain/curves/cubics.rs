//! The lessons of cubic curves: Catmull–Rom splines, forward differences.

use super::{EXAMPLES, TAKES};
use crate::curve::bezier::de_casteljau;
use crate::curve::{catmull_rom, forward_difference};
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Template, Value, Word};
use crate::math::DVec2;
use crate::trace::{NoTrace, PseudocodeLine};
use crate::{Error, Result};

pub(super) const CATMULL_ROM: Lesson = Lesson {
    name: catmull_rom::INFO.name,
    info: &catmull_rom::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&TANGENT, &PIECE],
    unreached: &[],
    make: |_, input, _, cap| through(input, cap),
};

pub(super) const FORWARD: Lesson = Lesson {
    name: forward_difference::INFO.name,
    info: &forward_difference::INFO,
    templates: &[&FIRST, &NEXT],
    make: |_, input, _, cap| forward(input, cap),
    ..CATMULL_ROM
};

/// Steps of the curve that is shown.
const STEPS: u32 = 8;

static TANGENT: Template = Template::new(
    "tangent",
    "The tangent at P{index} is half the way from the point before to the one after: {tangent}.",
    "Die Tangente bei P{index} ist der halbe Weg vom Punkt davor zum Punkt danach: {tangent}.",
);
static PIECE: Template = Template::new(
    "piece",
    "From P{index} on: a Bézier curve by way of {second} and {third}, a third of the tangents away.",
    "Ab P{index}: eine Bézier-Kurve über {second} und {third}, ein Drittel der Tangenten entfernt.",
);
static FIRST: Template = Template::new(
    "point",
    "The curve begins at {point}; its differences are {first}, {second}, {third}.",
    "Die Kurve beginnt bei {point}; ihre Differenzen sind {first}, {second}, {third}.",
);
static NEXT: Template = Template::new(
    "point",
    "Point {index}: adding Δ1 gives {point}; the differences are {first}, {second}, {third} now.",
    "Punkt {index}: Δ1 addiert gibt {point}; die Differenzen sind jetzt {first}, {second}, {third}.",
);

fn line(input: &Input, least: usize) -> Result<&[DVec2]> {
    let line = input.figure(TAKES)?.lines.first().filter(|line| line.len() >= least);
    line.map(Vec::as_slice).ok_or_else(|| Error::parameter("input", "too short a line", TAKES.en))
}

/// Returns an empty picture around control points, with these.
fn before(control: &[DVec2]) -> Picture {
    let mut picture = Picture::around(control.iter().copied(), 0.4);
    picture.chain(control.to_vec(), Look::Pale);
    for (number, &p) in control.iter().enumerate() {
        picture.named(p, format!("P{number}"), Look::Window);
    }
    picture
}

fn curve(control: &[DVec2; 4]) -> Vec<DVec2> {
    let at = |k: i32| de_casteljau(control, f64::from(k) / 30.0, &mut NoTrace).unwrap_or_default();
    (0..=30).map(at).collect()
}

fn through(input: &Input, cap: usize) -> Result<Frames> {
    use catmull_rom::Step;
    let control = line(input, 2)?;
    let options = catmull_rom::Options::default();
    let steps = record(cap, |t| {
        catmull_rom::pieces(control, &options, t);
        Ok(())
    })?;
    let control = control.to_vec();
    let (mut tangents, mut pieces) = (Vec::new(), Vec::new());
    Ok(Frames::new(steps, move |step, want| {
        let caption = match *step {
            Step::Tangent { index, tangent } => {
                tangents.push(tangent);
                TANGENT.with([("index", index.into()), ("tangent", tangent.into())])
            }
            Step::Piece { index, control: [_, second, third, _] } => {
                let values =
                    [("index", index.into()), ("second", second.into()), ("third", third.into())];
                PIECE.with(values)
            }
        };
        let picture = || {
            let mut picture = before(&control);
            pieces.iter().for_each(|piece| picture.chain(curve(piece), Look::Result));
            match *step {
                Step::Tangent { index, tangent } => {
                    if let Some(&at) = control.get(index) {
                        picture.arrow(at, at + tangent, Look::Now);
                    }
                }
                Step::Piece { control, .. } => {
                    picture.chain(control.to_vec(), Look::First);
                    picture.chain(curve(&control), Look::Now);
                }
            }
            picture
        };
        let shown = want.shown(step.line(), caption, || tangents_table(&tangents), picture);
        if let Step::Piece { control, .. } = *step {
            pieces.push(control);
        }
        shown
    }))
}

fn tangents_table(tangents: &[DVec2]) -> Table {
    let mut table = Table::new([Word::new("point", "Punkt"), Word::new("tangent", "Tangente")]);
    for (number, tangent) in tangents.iter().enumerate() {
        table.row(format!("P{number}"), [Value::from(*tangent)]);
    }
    table
}

fn forward(input: &Input, cap: usize) -> Result<Frames> {
    let given = line(input, 4)?;
    let control = [given[0], given[1], given[2], given[3]];
    let steps = record(cap, |t| {
        forward_difference::points(&control, STEPS, t);
        Ok(())
    })?;
    let mut found: Vec<(DVec2, [DVec2; 3])> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let forward_difference::Step { index, point, differences } = *step;
        found.push((point, differences));
        let [first, second, third] = differences.map(Value::from);
        let [first, second, third] = [("first", first), ("second", second), ("third", third)];
        let point = ("point", point.into());
        let caption = if index == 0 {
            FIRST.with([point, first, second, third])
        } else {
            NEXT.with([("index", index.into()), point, first, second, third])
        };
        let picture = || {
            let mut picture = before(&control);
            picture.chain(found.iter().map(|(p, _)| *p).collect::<Vec<_>>(), Look::Result);
            found.iter().for_each(|(p, _)| picture.dot(*p, Look::First));
            picture.dot(step.point, Look::Now);
            picture.arrow(step.point, step.point + differences[0], Look::Second);
            picture
        };
        want.shown(step.line(), caption, || differences_table(&found), picture)
    }))
}

fn differences_table(found: &[(DVec2, [DVec2; 3])]) -> Table {
    let heads = [
        Word::new("point", "Punkt"),
        Word::new("p", "p"),
        Word::new("Δ1", "Δ1"),
        Word::new("Δ2", "Δ2"),
        Word::new("Δ3", "Δ3"),
    ];
    let mut table = Table::new(heads);
    for (number, (p, [d1, d2, d3])) in found.iter().enumerate() {
        table.row(number, [*p, *d1, *d2, *d3].map(Value::from));
    }
    table
}
