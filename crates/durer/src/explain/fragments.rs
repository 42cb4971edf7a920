//! The lesson of the fragment operations: the fragments of one row of pixels, from test to test.

use super::faces::Row;
use super::frame::{Frames, Shown, Want, record};
use super::grid::{color, letter};
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::Result;
use crate::fragment::{
    AlphaTest, Blend, Compare, Fragment, FragmentState, INFO, Scissor, Stencil, StencilFace,
    StencilOp, Step, apply_traced, replay,
};
use crate::math::{DVec2, DVec3};
use crate::shade::color::decode_rgba8;
use crate::target::Framebuffer;
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[
        &INSIDE, &OUTSIDE, &OPAQUE, &CLEAR, &COUNTED, &FULL, &NEARER, &BEHIND, &BLENDED, &WRITTEN,
    ],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "plane faces, seen from +z: every second one lets half of the light through, every third one nearly all",
    "ebene Flächen, von +z gesehen: jede zweite lässt das halbe Licht durch, jede dritte fast alles",
);

const EXAMPLES: &[Example] = &[
    Example {
        name: "all-tests",
        title: Word::new(
            "five faces: every test drops something",
            "fünf Flächen, von denen jeder Test etwas verwirft",
        ),
        input: || {
            let all = [(0.0, 5.0, 4.0), (2.0, 7.0, 3.0), (3.0, 6.0, 2.0), (3.0, 5.0, 1.0)];
            Input::Faces(all.into_iter().chain([(0.0, 2.0, 5.0)]).map(strip).collect())
        },
    },
    Example {
        name: "back-to-front",
        title: Word::new(
            "a wall, and a half-transparent plate before it",
            "eine Wand und eine halb durchsichtige Platte davor",
        ),
        input: || Input::Faces([(0.0, 6.0, 4.0), (2.0, 4.0, 1.0)].map(strip).to_vec()),
    },
    Example::new(
        "near-first",
        "the nearer face first: what is behind it is dropped",
        "die nähere Fläche zuerst: Was dahinter liegt, wird verworfen",
        || Input::Faces([(2.0, 4.0, 1.0), (0.0, 6.0, 4.0)].map(strip).to_vec()),
    ),
    Example::new(
        "equal-depths",
        "equal depths: z < z does not hold, the first one stays",
        "gleiche Tiefen: z < z gilt nicht, die erste bleibt",
        || Input::Faces([(0.0, 4.0, 3.0), (2.0, 6.0, 3.0)].map(strip).to_vec()),
    ),
    Example::new(
        "faint",
        "a faint third face: the alpha test drops it before it is counted",
        "eine blasse dritte Fläche: Der Alpha-Test verwirft sie, bevor sie zählt",
        || Input::Faces([(0.0, 5.0, 4.0), (1.0, 3.0, 3.0), (2.0, 5.0, 2.0)].map(strip).to_vec()),
    ),
    Example::new(
        "third-layer",
        "the third layer is refused, though it is the nearest",
        "die dritte Schicht wird verweigert, obwohl sie die nächste ist",
        || {
            let all = [(0.0, 5.0, 5.0), (0.0, 5.0, 4.0), (0.0, 1.0, 3.0), (2.0, 4.0, 1.0)];
            Input::Faces(all.map(strip).to_vec())
        },
    ),
];

/// Returns a rectangle from one x to another at a depth.
fn strip((left, right, depth): (f64, f64, f64)) -> Vec<DVec3> {
    [(left, 0.0), (right, 0.0), (right, 2.0), (left, 2.0)]
        .map(|(x, y)| DVec3::new(x, y, -depth))
        .to_vec()
}

static INSIDE: Template = Template::new(
    "scissor",
    "Fragment of {face} at x = {x}, z = {z}, α = {alpha}: within the scissor rectangle.",
    "Fragment von {face} bei x = {x}, z = {z}, α = {alpha}: innerhalb des Scissor-Rechtecks.",
);
static OUTSIDE: Template = Template::new(
    "scissor",
    "Fragment of {face} at x = {x}, z = {z}, α = {alpha}: outside the scissor rectangle, dropped.",
    "Fragment von {face} bei x = {x}, z = {z}, α = {alpha}: außerhalb des Scissor-Rechtecks, verworfen.",
);
static OPAQUE: Template = Template::new(
    "alpha",
    "Alpha test: {alpha} > {reference}, so it goes on.",
    "Alpha-Test: {alpha} > {reference}, es geht weiter.",
);
static CLEAR: Template = Template::new(
    "alpha",
    "Alpha test: {alpha} ≤ {reference}: dropped.",
    "Alpha-Test: {alpha} ≤ {reference}: verworfen.",
);
static COUNTED: Template = Template::new(
    "stencil",
    "Stencil test: {reference} > {stored} passes; the stored value is now {new}.",
    "Stencil-Test: {reference} > {stored} gilt; der gespeicherte Wert ist jetzt {new}.",
);
static FULL: Template = Template::new(
    "stencil",
    "Stencil test: {reference} > {stored} fails, the pixel has its two layers: dropped.",
    "Stencil-Test: {reference} > {stored} gilt nicht, das Pixel hat schon zwei Schichten: verworfen.",
);
static NEARER: Template = Template::new(
    "depth",
    "Depth test: {z} < {stored}, so it goes on.",
    "Tiefentest: {z} < {stored}, es geht weiter.",
);
static BEHIND: Template = Template::new(
    "depth",
    "Depth test: {z} ≥ {stored}, something is in front: dropped.",
    "Tiefentest: {z} ≥ {stored}, etwas liegt davor: verworfen.",
);
static BLENDED: Template = Template::new(
    "blend",
    "Blending, in linear light: α · {source} + (1 − α) · {stored} = {result}.",
    "Mischen, in linearem Licht: α · {source} + (1 − α) · {stored} = {result}.",
);
static WRITTEN: Template = Template::new(
    "write",
    "Written: colour {color}, depth {z}.",
    "Geschrieben: Farbe {color}, Tiefe {z}.",
);

/// Alpha of faces in turn, of 255.
const ALPHAS: [u8; 3] = [255, 128, 20];

/// Returns the state of all tests: two columns are cut off, faint fragments and the third layer of a pixel dropped.
fn state(columns: u32) -> FragmentState {
    let layers = StencilFace {
        compare: Compare::Greater,
        reference: 2,
        pass: StencilOp::Increment,
        ..StencilFace::default()
    };
    let right = columns.saturating_sub(2).max(1);
    FragmentState {
        scissor: Some(Scissor { x0: 0, y0: 0, x1: right, y1: 1 }),
        alpha_test: Some(AlphaTest { compare: Compare::Greater, reference: 0.1 }),
        stencil: Some(Stencil::both(layers)),
        blend: Some(Blend::Over),
        ..FragmentState::default()
    }
}

/// The planes so far, and the fragment on its way.
#[derive(Clone)]
struct State {
    row: Row,
    planes: Framebuffer,
    now: Option<Fragment>,
}

fn planes(columns: u32) -> Framebuffer {
    let mut planes = Framebuffer::new(columns, 1).with_depth().with_stencil();
    planes.color.data_mut().fill([255; 4]);
    planes
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let row = Row::new(input)?;
    let tests = state(row.columns());
    let mut target = planes(row.columns());
    let steps = record(cap, |t| {
        for (face, x, z) in row.points() {
            let [r, g, b] = color(face);
            let fragment = Fragment {
                x,
                y: 0,
                depth: (z / row.far()) as f32,
                color: decode_rgba8([r, g, b, ALPHAS[face % ALPHAS.len()]]),
                index: 0.0,
                front_facing: true,
                item: face as u32,
                normal: [0.0, 0.0, 1.0],
            };
            apply_traced(&tests, fragment, &mut target, t);
        }
        Ok(())
    })?;
    let planes = planes(row.columns());
    let mut state = State { row, planes, now: None };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns a number with the digits that are shown.
fn short(x: f32) -> Value {
    ((f64::from(x) * 1000.0).round() / 1000.0).into()
}

/// Returns red, green and blue as a value.
fn rgb(color: crate::math::Vec4) -> Value {
    color.truncate().as_dvec3().into()
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        if let Step::Scissor { fragment, .. } = *step {
            self.now = Some(fragment);
        }
        // Replaying needs the place, which is in the first step of a fragment.
        let place = self.now.map(|fragment| Step::Scissor { fragment, passes: true });
        let both: Vec<Step> = place.into_iter().chain([*step]).collect();
        replay(&both, &mut self.planes);
        let caption = caption(step);
        want.shown(step.line(), caption, || self.table(), || self.picture())
    }

    /// Returns the planes, column by column.
    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("x", "x"),
            Word::new("colour", "Farbe"),
            Word::new("depth", "Tiefe"),
            Word::new("stencil", "Stencil"),
        ]);
        for x in 0..self.row.columns() {
            let [r, g, b, _] = self.planes.color.get(x, 0).unwrap_or_default();
            let depth = self.planes.depth.as_ref().and_then(|plane| plane.get(x, 0));
            let stencil = self.planes.stencil.as_ref().and_then(|plane| plane.get(x, 0));
            let color = DVec3::new(r.into(), g.into(), b.into());
            let cells: [Value; 3] = [
                color.into(),
                short(depth.unwrap_or(1.0)),
                i32::from(stencil.unwrap_or_default()).into(),
            ];
            table.row(x, cells);
        }
        table
    }

    /// Draws the faces of the row from the side, far ones above, and under them the pixels.
    fn picture(&self) -> Picture {
        let columns = self.row.columns();
        let width = f64::from(columns);
        let tall = width * 0.6;
        let at = |x: f64, z: f64| DVec2::new(x, 1.6 + z / self.row.far() * tall);
        let mut picture =
            Picture::new([DVec2::new(-0.6, -0.7), DVec2::new(width + 0.6, tall + 2.0)]);
        picture.picture_from_input = None;
        picture.grid = Some([columns, 1]);
        for x in 0..columns {
            let [r, g, b, _] = self.planes.color.get(x, 0).unwrap_or_default();
            picture.colored([x as i32, 0], [r, g, b], "");
            let stencil = self.planes.stencil.as_ref().and_then(|plane| plane.get(x, 0));
            let count = i32::from(stencil.unwrap_or_default());
            picture.label(DVec2::new(f64::from(x) + 0.5, 0.0), (0.0, 8.0), count);
        }
        let mut named = Vec::new();
        for (face, x, z) in self.row.points() {
            let x = f64::from(x);
            picture.chain([at(x, z), at(x + 1.0, z)], Look::First);
            if !named.contains(&face) {
                named.push(face);
                picture.label(at(x, z), (-7.0, 0.0), letter(face));
            }
        }
        let right = f64::from(columns.saturating_sub(2).max(1));
        picture.chain([at(right, -0.2), at(right, self.row.far())], Look::Dashed);
        if let Some(now) = self.now {
            let (x, z) = (f64::from(now.x), f64::from(now.depth) * self.row.far());
            picture.chain([at(x, z), at(x + 1.0, z)], Look::Now);
            let border = [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0), (x, 0.0)];
            picture.chain(border.map(DVec2::from), Look::Now);
        }
        picture
    }
}

fn caption(step: &Step) -> Caption {
    match *step {
        Step::Scissor { fragment, passes } => {
            let template = if passes { &INSIDE } else { &OUTSIDE };
            template.with([
                ("face", letter(fragment.item as usize).into()),
                ("x", fragment.x.into()),
                ("z", short(fragment.depth)),
                ("alpha", short(fragment.color.w)),
            ])
        }
        Step::Alpha { alpha, reference, passes } => {
            let template = if passes { &OPAQUE } else { &CLEAR };
            template.with([("alpha", short(alpha)), ("reference", short(reference))])
        }
        Step::Stencil { stored, reference, passes, new } => {
            let [stored, reference, new] = [stored, reference, new].map(i32::from);
            let values = [("stored", stored.into()), ("reference", reference.into())];
            let [stored, reference] = values;
            if passes {
                COUNTED.with([reference, stored, ("new", new.into())])
            } else {
                FULL.with([reference, stored])
            }
        }
        Step::Depth { depth, stored, passes } => {
            let template = if passes { &NEARER } else { &BEHIND };
            template.with([("z", short(depth)), ("stored", short(stored))])
        }
        Step::Blend { source, stored, result } => BLENDED.with([
            ("source", rgb(source)),
            ("stored", rgb(stored)),
            ("result", rgb(result)),
        ]),
        Step::Write { color, depth, .. } => {
            let [r, g, b, _] = color.unwrap_or_default().map(f64::from);
            let color = ("color", DVec3::new(r, g, b).into());
            WRITTEN.with([color, ("z", depth.map_or("–".into(), short))])
        }
    }
}
