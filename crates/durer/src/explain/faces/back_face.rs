//! The lesson of back-face removal.

use super::bodies::{BOXES, cuboid};
use super::{TAKES, name, slab};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::letter;
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::view::cull::FaceSide;
use crate::visibility::back_face::{Eye, INFO, Options, Step, remove};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&FRONT, &BACK, &EDGE_ON],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "cube",
        title: Word::new(
            "a cube, seen along its axis: one face stays",
            "ein Würfel, längs der Achse gesehen: eine Fläche bleibt",
        ),
        input: || Input::Faces(cube()),
    },
    Example {
        name: "pyramid",
        title: Word::new(
            "a pyramid from above: only its base goes",
            "eine Pyramide von oben: Nur die Grundfläche fällt weg",
        ),
        input: || Input::Faces(pyramid()),
    },
    Example::new(
        "both",
        "one face from before, one from behind",
        "eine Fläche von vorn, eine von hinten",
        || {
            let front = slab((0.0, 0.0), (3.0, 3.0), (1.0, 2.0));
            let back = slab((4.0, 0.0), (7.0, 3.0), (2.0, 1.0)).into_iter().rev().collect();
            Input::Faces(vec![front, back])
        },
    ),
    Example::new(
        "turned",
        "a box in a general position: three faces stay",
        "ein Quader in allgemeiner Lage: drei Flächen bleiben",
        || Input::Faces(cuboid([0.0, 0.0, 0.0], [4.0, 2.0, 3.0])),
    ),
    Example::new(
        "open",
        "a box without its front: its back is seen from inside",
        "ein Quader ohne Vorderseite: Seine Rückwand ist von innen zu sehen",
        || Input::Faces(cube()[1..].to_vec()),
    ),
    BOXES,
];

static FRONT: Template = Template::new(
    "tested",
    "{face}: N = {normal}, N · sight = {dot} > 0: it turns its front to the eye and stays.",
    "{face}: N = {normal}, N · Blick = {dot} > 0: Sie zeigt dem Auge die Vorderseite und bleibt.",
);
static BACK: Template = Template::new(
    "tested",
    "{face}: N = {normal}, N · sight = {dot} < 0: it turns its back to the eye and goes.",
    "{face}: N = {normal}, N · Blick = {dot} < 0: Sie zeigt dem Auge die Rückseite und fällt weg.",
);
static EDGE_ON: Template = Template::new(
    "tested",
    "{face}: N = {normal}, N · sight = 0: it is seen edge-on and goes.",
    "{face}: N = {normal}, N · Blick = 0: Man sieht sie von der Kante, sie fällt weg.",
);

/// Returns the faces of a cube, their corners counter-clockwise from outside.
fn cube() -> Vec<Vec<DVec3>> {
    let corner = |n: usize| DVec3::new((n & 1) as f64, (n >> 1 & 1) as f64, (n >> 2) as f64) * 2.0;
    let faces =
        [[4, 5, 7, 6], [0, 2, 3, 1], [1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4]];
    faces.map(|face| face.map(corner).to_vec()).to_vec()
}

/// Returns the faces of a pyramid whose tip points to the eye.
fn pyramid() -> Vec<Vec<DVec3>> {
    let base = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let tip = DVec3::new(2.0, 1.0, 3.0);
    let side = |k: usize| vec![base[k], base[(k + 1) % 4], tip];
    let mut faces: Vec<Vec<DVec3>> = (0..4).map(side).collect();
    faces.push(base.iter().rev().copied().collect());
    faces
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(TAKES)?;
    let eye = Eye::Along(DVec3::NEG_Z);
    let rings = faces.iter().map(Vec::as_slice);
    let steps = record(cap, |t| {
        remove(rings, eye, &Options::default(), t);
        Ok(())
    })?;
    let faces = faces.to_vec();
    let mut tested: Vec<(DVec3, FaceSide)> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let Step::Tested { face, area, side } = *step;
        tested.push((area, side));
        let values =
            [("face", letter(face).into()), ("normal", area.into()), ("dot", area.z.into())];
        let [named, normal, dot] = values;
        let caption = match side {
            FaceSide::Front => FRONT.with([named, normal, dot]),
            FaceSide::Back => BACK.with([named, normal, dot]),
            FaceSide::Edge => EDGE_ON.with([named, normal]),
        };
        want.shown(step.line(), caption, || table(&tested), || picture(&faces, &tested))
    }))
}

fn table(tested: &[(DVec3, FaceSide)]) -> Table {
    let heads = [
        Word::new("face", "Fläche"),
        Word::new("N", "N"),
        Word::new("N · sight", "N · Blick"),
        Word::new("stays", "bleibt"),
    ];
    let mut table = Table::new(heads);
    for (number, (area, side)) in tested.iter().enumerate() {
        let stays =
            if *side == FaceSide::Front { Word::new("yes", "ja") } else { Word::new("no", "nein") };
        let cells: [Value; 3] = [(*area).into(), area.z.into(), stays.into()];
        table.row(name(number as u32), cells);
    }
    table
}

/// Draws the faces obliquely, with z to the lower left, and normals from their middles.
fn picture(faces: &[Vec<DVec3>], tested: &[(DVec3, FaceSide)]) -> Picture {
    let flat = |p: DVec3| DVec2::new(p.x - 0.45 * p.z, p.y - 0.3 * p.z);
    let mut picture = Picture::around(faces.iter().flatten().map(|&p| flat(p)), 0.3);
    picture.picture_from_input = None;
    for ring in faces {
        let closed = ring.iter().chain(ring.first()).map(|&p| flat(p));
        picture.chain(closed.collect::<Vec<_>>(), Look::Pale);
    }
    for (ring, (_, side)) in faces.iter().zip(tested) {
        let look = if *side == FaceSide::Front { Look::Result } else { Look::Thin };
        picture.ring(ring.iter().map(|&p| flat(p)).collect::<Vec<_>>(), look);
    }
    let now = tested.len().saturating_sub(1);
    if let (Some(ring), Some((area, side))) = (faces.get(now), tested.last()) {
        let center = ring.iter().sum::<DVec3>() / ring.len().max(1) as f64;
        let size = (picture.extent[1] - picture.extent[0]).max_element();
        let tip = center + area.normalize_or_zero() * size * 0.2;
        let look = if *side == FaceSide::Front { Look::First } else { Look::Second };
        picture.ring(ring.iter().map(|&p| flat(p)).collect::<Vec<_>>(), Look::Now);
        picture.arrow(flat(center), flat(tip), look);
        picture.label(flat(center), (-8.0, 8.0), letter(now));
    }
    picture
}
