//! The lesson of flattening: as few chords as keep a tolerance.

use super::{EXAMPLES, TAKES};
use crate::Error;
use crate::Result;
use crate::curve::bezier::de_casteljau;
use crate::curve::{FLATTEN, FlattenStep as Step, Path, PathElement, flatten_traced};
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Word};
use crate::math::DVec2;
use crate::trace::{NoTrace, PseudocodeLine};

pub(super) const LESSON: Lesson = Lesson {
    name: FLATTEN.name,
    info: &FLATTEN,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&START, &CHORD, &END],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static START: Template =
    Template::new("start", "The chain begins at {point}.", "Der Linienzug beginnt bei {point}.");
static CHORD: Template = Template::new(
    "chord",
    "Chord {count} goes to {point}: the curve is at most {error} away, and {tolerance} is allowed.",
    "Sehne {count} führt nach {point}: Die Kurve ist höchstens {error} entfernt, erlaubt sind {tolerance}.",
);
static END: Template = Template::new(
    "end",
    "The contour ends after {count} {count|chord|chords}.",
    "Der Zug endet nach {count} {count|Sehne|Sehnen}.",
);

/// Part of the picture's size that chords may be away from the curve.
const TOLERANCE: f64 = 0.02;

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let line = input.figure(TAKES)?.lines.first().filter(|line| line.len() > 2);
    let control =
        line.ok_or_else(|| Error::parameter("input", "without three control points", TAKES.en))?;
    let mut path = Path::new();
    let mut exact = Vec::new();
    let first = control.first().copied().unwrap_or_default();
    path.move_to(first.x, first.y);
    // Cubic curves that begin where the one before ends; what is left is a quadratic one or a line.
    let mut at = first;
    for part in control.get(1..).unwrap_or_default().chunks(3) {
        let (element, end) = match *part {
            [b, c, d] => (PathElement::CubicTo(b, c, d), d),
            [b, c] => (PathElement::QuadTo(b, c), c),
            [b] => (PathElement::LineTo(b), b),
            _ => continue,
        };
        path.push(element);
        let own: Vec<DVec2> = std::iter::once(at).chain(part.iter().copied()).collect();
        let point =
            |k: i32| de_casteljau(&own, f64::from(k) / 60.0, &mut NoTrace).unwrap_or_default();
        exact.extend((0..=60).map(point));
        at = end;
    }
    let around = Picture::around(control.iter().copied(), 0.12);
    let tolerance = (around.extent[1] - around.extent[0]).max_element() * TOLERANCE;
    let steps = record(cap, |t| {
        flatten_traced(&path, tolerance, t);
        Ok(())
    })?;
    let (mut chain, mut table) = (
        Vec::new(),
        Table::new([
            Word::new("chord", "Sehne"),
            Word::new("to", "nach"),
            Word::new("error", "Fehler"),
        ]),
    );
    let control = control.clone();
    Ok(Frames::new(steps, move |step, want| {
        let caption = take(step, tolerance, &mut chain, &mut table);
        let picture = || {
            let mut picture = around.clone();
            picture.chain(control.clone(), Look::Thin);
            picture.chain(exact.clone(), Look::Second);
            picture.chain(chain.clone(), Look::First);
            chain.iter().for_each(|p| picture.dot(*p, Look::First));
            chain.last().into_iter().for_each(|p| picture.dot(*p, Look::Now));
            picture
        };
        want.shown(step.line(), caption, || table.clone(), picture)
    }))
}

fn take(step: &Step, tolerance: f64, chain: &mut Vec<DVec2>, table: &mut Table) -> Caption {
    match *step {
        Step::Start(point) => {
            *chain = vec![point];
            START.with([("point", point.into())])
        }
        Step::Chord { end, error, .. } => {
            let count = chain.len();
            chain.push(end);
            table.row(count, [end.into(), error.into()]);
            let values = [("count", count.into()), ("point", end.into())];
            let [count, point] = values;
            CHORD.with([count, point, ("error", error.into()), ("tolerance", tolerance.into())])
        }
        Step::End { .. } => END.with([("count", chain.len().saturating_sub(1).into())]),
    }
}
