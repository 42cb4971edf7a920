//! The lesson of the A-buffer's masks and shares in one pixel.

use super::{DEPTH, Scene, TAKES, middle, name, slab};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::{color, upright};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::Vec4;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::a_buffer::{FULL, FaceFragment, INFO, Step, weights};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&LOOK, &OVERLAP, &WEIGHT, &BACKGROUND],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "shared",
        title: Word::new(
            "two faces that overlap in depth share sub-pixels",
            "zwei Flächen mit gleichen Tiefen teilen sich Subpixel",
        ),
        input: || {
            Input::Faces(vec![
                slab((0.0, 0.0), (3.0, 3.0), (1.0, 3.0)),
                slab((0.0, 1.0), (3.9, 3.9), (2.0, 4.0)),
            ])
        },
    },
    Example {
        name: "hidden",
        title: Word::new(
            "one behind the other: masks decide",
            "hintereinander: Masken entscheiden",
        ),
        input: || {
            Input::Faces(vec![
                slab((0.0, 0.0), (2.0, 3.9), (1.0, 1.0)),
                slab((0.0, 0.0), (3.9, 2.0), (2.0, 2.0)),
            ])
        },
    },
    Example::new(
        "halves",
        "side by side: each has its half",
        "nebeneinander: jede hat ihre Hälfte",
        || {
            Input::Faces(vec![
                slab((0.0, 0.0), (2.0, 3.9), (1.0, 1.0)),
                slab((2.0, 0.0), (3.9, 3.9), (2.0, 2.0)),
            ])
        },
    ),
    Example::new(
        "covered",
        "the near face covers the pixel: the search ends",
        "die nahe Fläche bedeckt das Pixel: Die Suche endet",
        || {
            Input::Faces(vec![
                slab((0.0, 0.0), (3.9, 3.9), (1.0, 1.0)),
                slab((0.0, 0.0), (3.9, 2.0), (3.0, 3.0)),
            ])
        },
    ),
    Example::new(
        "three",
        "three layers, each larger than the one before it",
        "drei Schichten, jede größer als die davor",
        || {
            Input::Faces(vec![
                slab((0.0, 0.0), (2.0, 2.0), (1.0, 1.0)),
                slab((0.0, 0.0), (3.0, 3.0), (2.0, 2.0)),
                slab((0.0, 0.0), (3.9, 3.9), (3.0, 3.0)),
            ])
        },
    ),
    Example::new(
        "background",
        "a corner only: the background has the rest",
        "nur eine Ecke: Der Hintergrund hat den Rest",
        || {
            Input::Faces(vec![
                slab((0.0, 0.0), (2.0, 1.0), (1.0, 1.0)),
                slab((3.0, 3.0), (3.9, 3.9), (1.0, 1.0)),
            ])
        },
    ),
];

static LOOK: Template = Template::new(
    "look",
    "{face}: of {search} sub-pixels still searched for it covers {inside}.",
    "{face}: Von {search} noch gesuchten Subpixeln bedeckt sie {inside}.",
);
static OVERLAP: Template = Template::new(
    "overlap",
    "{face} and {other} overlap in depth in {count} {count|sub-pixel|sub-pixels}: {face} takes {share} of each.",
    "{face} und {other} überlappen sich in {count} {count|Subpixel|Subpixeln} in der Tiefe: {face} nimmt von jedem {share}.",
);
static WEIGHT: Template = Template::new(
    "weight",
    "{face} gets a weight of {weight} in the pixel's colour.",
    "{face} bekommt in der Farbe des Pixels das Gewicht {weight}.",
);
static BACKGROUND: Template = Template::new(
    "weight",
    "The background gets the rest: {weight}.",
    "Der Hintergrund bekommt den Rest: {weight}.",
);

const SUBPIXELS: u32 = 4;

/// Fragments of the pixel, and the share that each has got.
#[derive(Clone)]
struct State {
    fragments: Vec<FaceFragment>,
    weights: Vec<Option<f64>>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let fragments = fragments(&Scene::new(input)?);
    let steps = record(cap, |t| {
        weights(&fragments, t);
        Ok(())
    })?;
    let weights = vec![None; fragments.len()];
    let mut state = State { fragments, weights };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns the fragment of each face in the pixel from (0, 0) to (4, 4): its sub-pixels are the grid's pixels.
fn fragments(scene: &Scene) -> Vec<FaceFragment> {
    let screen = crate::visibility::polygons::Screen {
        width: SUBPIXELS,
        height: SUBPIXELS,
        ..scene.screen()
    };
    let fragment = |face: &crate::visibility::polygons::Face| {
        let mut mask = 0_u16;
        face.pixels(&screen, |[x, y], _| mask |= 1 << (SUBPIXELS * y + x));
        FaceFragment { mask, z: face.depths(), color: Vec4::ONE }
    };
    scene.faces.iter().map(fragment).collect()
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let (caption, mask) = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step, mask))
    }

    fn take(&mut self, step: &Step) -> (Caption, u16) {
        let named = |fragment: usize| Value::from(name(fragment as u32));
        match *step {
            Step::Look { fragment, search, inside } => {
                let counts = [search, inside].map(|mask| Value::from(mask.count_ones()));
                let [searched, covered] = counts;
                let face = ("face", named(fragment));
                (LOOK.with([face, ("search", searched), ("inside", covered)]), inside)
            }
            Step::Overlap { fragments: [face, other], mask, share } => {
                let names = [("face", named(face)), ("other", named(other))];
                let [face, other] = names;
                let count = ("count", mask.count_ones().into());
                (OVERLAP.with([face, other, count, ("share", share.into())]), mask)
            }
            Step::Weight { fragment: Some(fragment), weight } => {
                if let Some(own) = self.weights.get_mut(fragment) {
                    *own = Some(weight);
                }
                let mask = self.fragments.get(fragment).map_or(0, |own| own.mask);
                (WEIGHT.with([("face", named(fragment)), ("weight", weight.into())]), mask)
            }
            Step::Weight { fragment: None, weight } => {
                let covered = self.fragments.iter().fold(0, |all, own| all | own.mask);
                (BACKGROUND.with([("weight", weight.into())]), FULL & !covered)
            }
        }
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("face", "Fläche"),
            Word::new("mask", "Maske"),
            DEPTH,
            Word::new("weight", "Gewicht"),
        ];
        let mut table = Table::new(heads);
        for (number, (own, weight)) in self.fragments.iter().zip(&self.weights).enumerate() {
            let depths = Value::List(vec![own.z[0].into(), "…".into(), own.z[1].into()]);
            let weight = weight.map_or_else(|| "".into(), Value::from);
            table.row(name(number as u32), [mask(own.mask), depths, weight]);
        }
        table
    }

    fn picture(&self, step: &Step, now: u16) -> Picture {
        let mut picture = upright(SUBPIXELS, SUBPIXELS);
        picture.picture_from_input = None;
        let owner = match *step {
            Step::Look { fragment, .. } | Step::Overlap { fragments: [fragment, _], .. } => {
                Some(fragment)
            }
            Step::Weight { fragment, .. } => fragment,
        };
        for bit in (0..16).filter(|bit| now >> bit & 1 == 1) {
            let at = [bit % SUBPIXELS, bit / SUBPIXELS];
            picture.colored(at.map(|side| side as i32), owner.map_or([255; 3], color), "");
            let others =
                self.fragments.iter().enumerate().filter(|(_, own)| own.mask >> bit & 1 == 1);
            let letters: String = others.map(|(number, _)| name(number as u32)).collect();
            picture.label(middle(at), (0.0, 0.0), letters);
        }
        let side = f64::from(SUBPIXELS);
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side), (0.0, 0.0)];
        picture.chain(corners.map(crate::math::DVec2::from), Look::Window);
        picture
    }
}

/// Returns a mask row by row, the uppermost first.
fn mask(mask: u16) -> Value {
    let row = |y: u16| format!("{:04b}", (mask >> (4 * y) & 15).reverse_bits() >> 12);
    [3, 2, 1, 0].map(row).join(" ").into()
}
