//! The lessons of the midpoint circle and ellipse.

use super::{STEP, line};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::{center, log, shown, upright};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DAffine2, IVec2};
use crate::raster::conic::{self, CurveRegion, Step, replay};
use crate::trace::PseudocodeLine;

pub(super) const CIRCLE: Lesson = Lesson {
    name: conic::CIRCLE.name,
    info: &conic::CIRCLE,
    takes: TAKES,
    examples: CIRCLES,
    templates: &[&STRAIGHT, &ASLANT],
    unreached: &[],
    make: |_, input, _, cap| make(true, input, cap),
};

pub(super) const ELLIPSE: Lesson = Lesson {
    name: conic::INFO.name,
    info: &conic::INFO,
    takes: TAKES,
    examples: ELLIPSES,
    templates: &[&FLAT_STRAIGHT, &FLAT_ASLANT, &STEEP_ASLANT, &STEEP_STRAIGHT],
    unreached: &[],
    make: |_, input, _, cap| make(false, input, cap),
};

const TAKES: Word = Word::new(
    "a line from the centre to a point: of a circle, or the corner of an ellipse's box",
    "eine Strecke von der Mitte zu einem Punkt: des Kreises oder der Ecke um die Ellipse",
);

const CIRCLES: &[Example] = &[
    Example {
        name: "radius-10",
        title: Word::new(
            "radius 10: d = −9, −6, −1, 6, −3 …",
            "Radius 10: d = −9, −6, −1, 6, −3 …",
        ),
        input: || line((0.0, 0.0), (10.0, 0.0)),
    },
    Example {
        name: "radius-1",
        title: Word::new("radius 1: four pixels", "Radius 1: vier Pixel"),
        input: || line((0.0, 0.0), (0.0, 1.0)),
    },
    Example::new("radius-2", "radius 2: twelve pixels", "Radius 2: zwölf Pixel", || {
        line((0.0, 0.0), (2.0, 0.0))
    }),
    Example::new(
        "radius-7",
        "radius 7: the octant ends on the diagonal",
        "Radius 7: Der Oktant endet auf der Diagonalen",
        || line((0.0, 0.0), (7.0, 0.0)),
    ),
    Example::new("moved", "centre (6, 4), radius 5", "Mitte (6; 4), Radius 5", || {
        line((6.0, 4.0), (6.0, 9.0))
    }),
    Example::new(
        "radius-20",
        "radius 20: long flat runs at first",
        "Radius 20: zuerst lange flache Läufe",
        || line((0.0, 0.0), (20.0, 0.0)),
    ),
];

const ELLIPSES: &[Example] = &[
    Example {
        name: "8-by-6",
        title: Word::new("radii 8 and 6", "Halbachsen 8 und 6"),
        input: || line((0.0, 0.0), (8.0, 6.0)),
    },
    Example {
        name: "flat",
        title: Word::new("radii 9 and 2: long tips", "Halbachsen 9 und 2: lange Spitzen"),
        input: || line((0.0, 0.0), (9.0, 2.0)),
    },
    Example::new(
        "tall",
        "radii 2 and 9: nearly all rows are in the second region",
        "Halbachsen 2 und 9: fast alle Zeilen liegen im zweiten Bereich",
        || line((0.0, 0.0), (2.0, 9.0)),
    ),
    Example::new("circle", "equal radii: a circle", "gleiche Halbachsen: ein Kreis", || {
        line((0.0, 0.0), (6.0, 6.0))
    }),
    Example::new("1-by-1", "radii 1 and 1", "Halbachsen 1 und 1", || line((0.0, 0.0), (1.0, 1.0))),
    Example::new(
        "moved",
        "centre (9, 5), radii 7 and 3",
        "Mitte (9; 5), Halbachsen 7 und 3",
        || line((9.0, 5.0), (16.0, 8.0)),
    ),
];

static STRAIGHT: Template = Template::new(
    "octant",
    "({x}, {y}) eight times. d = {d} < 0: the midpoint is inside, so the next pixel is beside it; d ← d + 2 · {x} + 3.",
    "({x}; {y}) achtmal. d = {d} < 0: Die Mitte liegt innen, das nächste Pixel daneben; d ← d + 2 · {x} + 3.",
);
static ASLANT: Template = Template::new(
    "octant",
    "({x}, {y}) eight times. d = {d} ≥ 0: the midpoint is not inside, so the step is diagonal; d ← d + 2 · ({x} − {y}) + 5.",
    "({x}; {y}) achtmal. d = {d} ≥ 0: Die Mitte liegt nicht innen, also schräg; d ← d + 2 · ({x} − {y}) + 5.",
);
static FLAT_STRAIGHT: Template = Template::new(
    "flat",
    "({x}, {y}) four times. d = {d} < 0: the midpoint is inside, so the next pixel is beside it.",
    "({x}; {y}) viermal. d = {d} < 0: Die Mitte liegt innen, das nächste Pixel daneben.",
);
static FLAT_ASLANT: Template = Template::new(
    "flat",
    "({x}, {y}) four times. d = {d} ≥ 0: the midpoint is not inside, so the step is diagonal.",
    "({x}; {y}) viermal. d = {d} ≥ 0: Die Mitte liegt nicht innen, das nächste Pixel schräg darunter.",
);
static STEEP_ASLANT: Template = Template::new(
    "steep",
    "({x}, {y}) four times, steep part. d = {d} < 0: the midpoint is inside, so the step is diagonal.",
    "({x}; {y}) viermal, steiler Teil. d = {d} < 0: Die Mitte liegt innen, das nächste Pixel schräg darunter.",
);
static STEEP_STRAIGHT: Template = Template::new(
    "steep",
    "({x}, {y}) four times, steep part. d = {d} ≥ 0: the midpoint is not inside, so it goes straight down.",
    "({x}; {y}) viermal, steiler Teil. d = {d} ≥ 0: Die Mitte liegt nicht innen, es geht gerade hinab.",
);

/// The largest radius that is shown.
const LARGEST: f64 = 20.0;

/// Returns the radii across and up of a figure: whole, and no larger than can be shown.
fn radii(circle: bool, input: &Input) -> Result<[u32; 2]> {
    let [center, point] = input.figure(TAKES)?.segment(TAKES)?;
    let way = (point - center).abs();
    let size = if circle { libm::hypot(way.x, way.y) } else { way.max_element() };
    let scale = if size > LARGEST { LARGEST / size } else { 1.0 };
    let whole = |side: f64| (side * scale + 0.5).floor().clamp(0.0, LARGEST) as u32;
    Ok(if circle { [whole(size); 2] } else { way.to_array().map(whole) })
}

/// Returns the map that takes the input's centre to that of the picture, if radii are drawn as they are.
fn placed(input: &Input, [a, b]: [u32; 2]) -> Result<Option<DAffine2>> {
    let [middle, point] = input.figure(TAKES)?.segment(TAKES)?;
    let scaled = (point - middle).abs().max_element() > LARGEST;
    let shift = center(IVec2::new(a as i32, b as i32)) - middle;
    Ok((!scaled).then(|| DAffine2::from_translation(shift)))
}

fn make(circle: bool, input: &Input, cap: usize) -> Result<Frames> {
    let radii = radii(circle, input)?;
    let picture_from_input = placed(input, radii)?;
    let steps = record(cap, |t| match circle {
        true => conic::circle(IVec2::ZERO, radii[0], |_| {}, t),
        false => conic::ellipse(IVec2::ZERO, radii, |_| {}, t),
    })?;
    let (mut done, mut rows): (Vec<Step>, Vec<[Value; 2]>) = (Vec::new(), Vec::new());
    Ok(Frames::new(steps, move |step, want| {
        done.push(*step);
        let d = decision(step);
        rows.push([shown(step.pixel), d.clone()]);
        let heads = [STEP, Word::new("pixel", "Pixel"), Word::new("d", "d")];
        let picture = || Picture { picture_from_input, ..picture(radii, &done) };
        want.shown(step.line(), caption(step, d), || log(heads, &rows), picture)
    }))
}

/// Returns the decision variable: that of an ellipse is kept four times as large, so that it is whole.
fn decision(step: &Step) -> Value {
    let parts = if step.region == CurveRegion::Octant { 1.0 } else { 4.0 };
    (step.d as f64 / parts).into()
}

fn caption(step: &Step, d: Value) -> Caption {
    let template = match (step.region, step.d < 0) {
        (CurveRegion::Octant, true) => &STRAIGHT,
        (CurveRegion::Octant, false) => &ASLANT,
        (CurveRegion::Flat, true) => &FLAT_STRAIGHT,
        (CurveRegion::Flat, false) => &FLAT_ASLANT,
        (CurveRegion::Steep, true) => &STEEP_ASLANT,
        (CurveRegion::Steep, false) => &STEEP_STRAIGHT,
    };
    let [x, y] = step.pixel.to_array().map(Value::from);
    template.with([("x", x), ("y", y), ("d", d)])
}

/// Draws all pixels so far around the centre, and the midpoint that decides.
fn picture(radii: [u32; 2], done: &[Step]) -> Picture {
    let [a, b] = radii;
    let mut picture = upright(2 * a + 1, 2 * b + 1);
    let middle = IVec2::new(a as i32, b as i32);
    for pixel in replay(done) {
        picture.cell((middle + pixel).to_array(), "", Look::Pale);
    }
    for step in done {
        picture.cell((middle + step.pixel).to_array(), "", Look::First);
    }
    picture.chain(outline(radii), Look::Second);
    picture.dot(center(middle), Look::Thin);
    if let Some(step) = done.last() {
        let at = middle + step.pixel;
        picture.cell(at.to_array(), "", Look::Now);
        let ahead = if step.region == CurveRegion::Steep { (0.5, -1.0) } else { (1.0, -0.5) };
        picture.dot(center(at) + crate::math::DVec2::from(ahead), Look::Window);
    }
    picture
}

/// Returns the curve itself.
fn outline([a, b]: [u32; 2]) -> Vec<crate::math::DVec2> {
    let middle = center(IVec2::new(a as i32, b as i32));
    let at = |k: i32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 96.0;
        let way = crate::math::DVec2::new(libm::cos(angle), libm::sin(angle));
        middle + way * crate::math::DVec2::new(a.into(), b.into())
    };
    (0..=96).map(at).collect()
}
