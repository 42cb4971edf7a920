//! The lessons of smooth lines: Wu, Gupta and Sproull.

use super::{EXAMPLES, PIXEL, STEP, TAKES};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::{Raster, center, grey, log, shown};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::words::{Template, Value, Word};
use crate::math::IVec2;
use crate::raster::line::anti_aliased::{self, SmoothLine, Step};
use crate::trace::PseudocodeLine;

pub(super) const WU: Lesson = Lesson {
    name: anti_aliased::WU.name,
    info: &anti_aliased::WU,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&SHARED],
    unreached: &[],
    make: |_, input, _, cap| make(SmoothLine::Wu, input, cap),
};

pub(super) const GUPTA_SPROULL: Lesson = Lesson {
    name: anti_aliased::INFO.name,
    info: &anti_aliased::INFO,
    templates: &[&FILTERED],
    make: |_, input, _, cap| make(SmoothLine::GuptaSproull, input, cap),
    ..WU
};

static SHARED: Template = Template::new(
    "pixel",
    "{pixel} is {d} from the line across: it gets {share} = 1 − {d} of the light, {i} of 255.",
    "{pixel} liegt quer gemessen {d} neben der Strecke und bekommt {share} = 1 − {d} des Lichts, {i} von 255.",
);
static FILTERED: Template = Template::new(
    "pixel",
    "{pixel} is at a perpendicular distance of {d} from the line: entry {entry} of the table gives {i} of 255.",
    "{pixel} liegt im rechten Winkel {d} neben der Strecke: Eintrag {entry} der Tabelle gibt {i} von 255.",
);

const DISTANCE: Word = Word::new("distance", "Abstand");
const LIGHT: Word = Word::new("of 255", "von 255");

fn make(method: SmoothLine, input: &Input, cap: usize) -> Result<Frames> {
    let ends = input.figure(TAKES)?.segment(TAKES)?;
    let raster = Raster::around(ends);
    let ends @ [from, to] = ends.map(|end| raster.pixel(end));
    let steps = record(cap, |t| {
        anti_aliased::draw(method, from, to, &Default::default(), |_, _| {}, t);
        Ok(())
    })?;
    let (mut done, mut rows): (Vec<Step>, Vec<[Value; 3]>) = (Vec::new(), Vec::new());
    Ok(Frames::new(steps, move |step, want| {
        done.push(*step);
        let d = (step.distance * 1000.0).round() / 1000.0;
        rows.push([shown(step.pixel), d.into(), i32::from(step.intensity).into()]);
        let (pixel, i) = (("pixel", shown(step.pixel)), ("i", i32::from(step.intensity).into()));
        let caption = match method {
            SmoothLine::Wu => SHARED.with([pixel, ("d", d.into()), ("share", (1.0 - d).into()), i]),
            SmoothLine::GuptaSproull => {
                let entry = (step.distance * 32.0 + 0.5).floor();
                FILTERED.with([pixel, ("d", d.into()), ("entry", entry.into()), i])
            }
        };
        let table = || log([STEP, PIXEL, DISTANCE, LIGHT], &rows);
        want.shown(step.line(), caption, table, || picture(&raster, ends, &done))
    }))
}

fn picture(raster: &Raster, ends: [IVec2; 2], done: &[Step]) -> Picture {
    let mut picture = raster.picture_of_pixels();
    for step in done.iter().filter(|step| step.pixel.min_element() >= 0) {
        let color = grey(f64::from(step.intensity) / 255.0);
        picture.colored(step.pixel.to_array(), color, "");
    }
    picture.chain(ends.map(center), Look::Second);
    if let Some(last) = done.last() {
        picture.dot(center(last.pixel), Look::Now);
    }
    picture
}
