//! The lesson of shadow volumes: counts of the volume sides in front of each visible point.

use super::bodies::{turned, upright};
use super::{FACE, Scene, TAKES, middle, name, slab};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::color;
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::back_face::Eye;
use crate::visibility::polygons::Face;
use crate::visibility::polygons::shadow_volumes::{INFO, Options, Step, VolumeSide, render};

pub(in crate::explain) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "plates",
            title: Word::new(
                "two plates above a floor: where their shadows meet, the count is 2",
                "zwei Platten über einem Boden: Wo ihre Schatten sich treffen, ist die Zahl 2",
            ),
            input: || {
                let floor = slab((0.0, 0.0), (10.0, 7.0), (5.0, 5.0));
                let high = slab((2.0, 4.0), (7.0, 6.5), (1.0, 1.0));
                let low = slab((5.2, 3.2), (8.2, 5.2), (3.0, 3.0));
                Input::Faces(vec![high, low, floor])
            },
        },
        Example {
            name: "box",
            title: Word::new(
                "a box on a slope: edges between lit and dark faces count twice",
                "ein Quader über einer Schräge: Kanten zwischen hellen und dunklen Flächen zählen doppelt",
            ),
            input: || {
                let floor = slab((0.0, 0.0), (9.0, 7.0), (8.0, 6.0));
                let body = upright([0.0, 0.0, 0.0], [2.0, 2.0, 2.0]);
                let place = |p: &DVec3| turned(*p) + DVec3::new(1.6, 3.2, -4.0);
                let body = body.iter().map(|face| face.iter().map(place).collect());
                Input::Faces(body.chain([floor]).collect())
            },
        },
        Example::new(
            "one",
            "one plate: a face in before its shadow, one out behind it",
            "eine Platte: eine Seite hinein, eine hinaus",
            || {
                let floor = slab((0.0, 0.0), (8.0, 6.0), (5.0, 5.0));
                Input::Faces(vec![slab((2.0, 3.0), (5.0, 5.0), (2.0, 2.0)), floor])
            },
        ),
        Example::new(
            "low",
            "a plate close above the floor: its shadow hides beside it",
            "eine Platte dicht über dem Boden: Ihr Schatten liegt gleich daneben",
            || {
                let floor = slab((0.0, 0.0), (8.0, 6.0), (5.0, 5.0));
                Input::Faces(vec![slab((2.0, 2.0), (5.0, 4.0), (4.0, 4.0)), floor])
            },
        ),
        Example::new(
            "steps",
            "two floors at different depths: the shadow jumps",
            "zwei Böden in verschiedener Tiefe: Der Schatten springt",
            || {
                let near = slab((0.0, 0.0), (4.0, 6.0), (4.0, 4.0));
                let far = slab((4.0, 0.0), (9.0, 6.0), (7.0, 7.0));
                Input::Faces(vec![slab((1.0, 3.5), (5.0, 5.0), (1.0, 1.0)), near, far])
            },
        ),
        Example::new(
            "stack",
            "a plate in the shadow of another one",
            "eine Platte im Schatten einer anderen",
            || {
                let floor = slab((0.0, 0.0), (9.0, 7.0), (7.0, 7.0));
                let high = slab((1.0, 4.0), (5.0, 6.5), (1.0, 1.0));
                Input::Faces(vec![high, slab((2.0, 3.0), (5.5, 5.5), (3.0, 3.0)), floor])
            },
        ),
    ],
    templates: &[&PIXEL, &LIT, &TURNED, &FRONT, &BACK, &EDGE_ON, &ADDED, &TAKEN, &BEYOND, &CAP],
    unreached: &[("cap", "casters count only from the far end, and lessons count from the eye")],
    make: |_, input, _, cap| make(input, cap),
};

/// Direction of the light's rays: to the right, downwards on the picture, and away from the eye.
const RAYS: DVec3 = DVec3::new(1.0, -1.0, 2.0);

static PIXEL: Template = Template::new(
    "pixel",
    "Pixel {pixel} shows {face} at depth {depth}. Volumes that contain the eye's end of the ray: {count}.",
    "Pixel {pixel} zeigt {face} in Tiefe {depth}. Volumina, die das Ende des Strahls beim Auge enthalten: {count}.",
);
static LIT: Template = Template::new(
    "caster",
    "{face} casts a shadow; its corners run counter-clockwise as the light sees it.",
    "{face} wirft einen Schatten; vom Licht gesehen laufen die Ecken gegen den Uhrzeigersinn.",
);
static TURNED: Template = Template::new(
    "caster",
    "{face} turns its back to the light: its corners are taken in the opposite direction.",
    "{face} zeigt dem Licht die Rückseite: Die Ecken werden in Gegenrichtung genommen.",
);
static FRONT: Template = Template::new(
    "side",
    "Side {side} turns its front to the eye: where a ray passes it, the count grows by {weight}.",
    "Seite {side} zeigt dem Auge die Vorderseite: Wo ein Strahl sie passiert, wächst die Zahl um {weight}.",
);
static BACK: Template = Template::new(
    "side",
    "Side {side} turns its back to the eye: where a ray passes it, the count shrinks by {weight}.",
    "Seite {side} zeigt dem Auge die Rückseite: Wo ein Strahl sie passiert, sinkt die Zahl um {weight}.",
);
static EDGE_ON: Template = Template::new(
    "side",
    "Side {side} is seen edge-on and covers no pixel.",
    "Seite {side} ist nur als Kante zu sehen und bedeckt kein Pixel.",
);
static ADDED: Template = Template::new(
    "count",
    "Pixel {pixel}: the side has z = {depth} < {stored}, in front of the visible point: + {change} = {count}.",
    "Pixel {pixel}: Die Seite hat z = {depth} < {stored}, liegt also vor dem Sichtbaren: + {change} = {count}.",
);
static TAKEN: Template = Template::new(
    "count",
    "Pixel {pixel}: the side has z = {depth} < {stored}, in front of the visible point: − {change} = {count}.",
    "Pixel {pixel}: Die Seite hat z = {depth} < {stored}, liegt also vor dem Sichtbaren: − {change} = {count}.",
);
static BEYOND: Template = Template::new(
    "count",
    "Pixel {pixel}: the side has z = {depth}, not before {stored}: it does not count, {count} stays.",
    "Pixel {pixel}: Die Seite hat z = {depth}, nicht vor {stored}: Sie zählt nicht, {count} bleibt.",
);
static CAP: Template = Template::new(
    "cap",
    "{face} is the near end of its volume.",
    "{face} ist das nahe Ende seines Volumens.",
);

/// The counts so far.
#[derive(Clone)]
struct State {
    scene: Scene,
    counts: Vec<Option<i32>>,
    /// Sides so far, and whether their fronts are seen.
    sides: Vec<(VolumeSide, Option<bool>)>,
    face: Option<u32>,
    pixel: Option<[u32; 2]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let (screen, options) = (scene.screen(), Options::default());
    // The grid has y upwards, a screen has it downwards: what runs counter-clockwise here runs clockwise there.
    let mirrored =
        |face: &Face| Face::new(&face.corners().iter().rev().copied().collect::<Vec<_>>());
    let faces = scene.faces.iter().map(mirrored).collect::<Result<Vec<_>>>()?;
    let steps = record(cap, |t| render(&faces, &screen, Eye::Along(RAYS), &options, t))?;
    let counts = vec![None; scene.items.len()];
    let mut state = State { scene, counts, sides: Vec::new(), face: None, pixel: None };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture())
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        (self.face, self.pixel) = (None, None);
        let at = |[x, y]: [u32; 2]| ("pixel", Value::from(DVec2::new(x.into(), y.into())));
        match *step {
            Step::Caster { face, turned } => {
                self.face = Some(face);
                let template = if turned { &TURNED } else { &LIT };
                template.with([("face", name(face).into())])
            }
            Step::Pixel { pixel, face, depth, count } => {
                self.scene.set(pixel, face);
                self.set(pixel, count);
                let values = [("depth", depth.into()), ("count", count.into())];
                let ([depth, count], face) = (values, ("face", name(face).into()));
                PIXEL.with([at(pixel), face, depth, count])
            }
            Step::Side { number, side, front } => {
                self.sides.push((side, front));
                let values = [("side", (number + 1).into()), ("weight", side.weight.into())];
                let [number, weight] = values;
                match front {
                    Some(true) => FRONT.with([number, weight]),
                    Some(false) => BACK.with([number, weight]),
                    None => EDGE_ON.with([number]),
                }
            }
            Step::Cap { face, .. } => {
                self.face = Some(face);
                CAP.with([("face", name(face).into())])
            }
            Step::Count { pixel, depth, stored, change, count } => {
                self.set(pixel, count);
                let values = [("depth", depth.into()), ("stored", stored.into())];
                let ([depth, stored], count) = (values, ("count", count.into()));
                let size = ("change", change.abs().into());
                match change {
                    0 => BEYOND.with([at(pixel), depth, stored, count]),
                    1.. => ADDED.with([at(pixel), depth, stored, size, count]),
                    _ => TAKEN.with([at(pixel), depth, stored, size, count]),
                }
            }
        }
    }

    fn set(&mut self, pixel @ [x, y]: [u32; 2], count: i32) {
        self.pixel = Some(pixel);
        let place = y as usize * self.scene.raster.columns as usize + x as usize;
        if let Some(known) = self.counts.get_mut(place) {
            *known = Some(count);
        }
    }

    /// Returns the sides so far.
    fn table(&self) -> Table {
        let heads = [
            Word::new("side", "Seite"),
            Word::new("from", "von"),
            Word::new("to", "nach"),
            Word::new("change", "Änderung"),
        ];
        let mut table = Table::new(heads);
        if let Some(face) = self.face {
            table.row(Value::List(vec![FACE.into(), name(face).into()]), []);
        }
        let first = self.sides.len().saturating_sub(12);
        for (number, (side, front)) in self.sides.iter().enumerate().skip(first) {
            let [a, b] = side.ends.map(Value::from);
            let change = match front {
                Some(true) => side.weight,
                Some(false) => -side.weight,
                None => 0,
            };
            table.row(number + 1, [a, b, change.into()]);
        }
        table
    }

    /// Draws the pixels with their counts, darker in shadow, and the last side as far as the picture goes.
    fn picture(&self) -> Picture {
        let mut picture = self.scene.raster.picture();
        let columns = self.scene.raster.columns as usize;
        for (place, count) in self.counts.iter().enumerate() {
            let (Some(count), Some(&face)) = (count, self.scene.items.get(place)) else { continue };
            let at = [(place % columns) as i32, (place / columns) as i32];
            let tone = color(face as usize);
            let tone = if *count > 0 { tone.map(|part| part / 2 + part / 8) } else { tone };
            picture.colored(at, tone, *count);
        }
        for face in 0..self.scene.faces.len() {
            self.scene.outline(&mut picture, face, Look::Window);
        }
        if let Some(face) = self.face {
            self.scene.outline(&mut picture, face as usize, Look::First);
        }
        if let Some((side, front)) = self.sides.last() {
            let look = if *front == Some(true) { Look::First } else { Look::Second };
            let [a, b] = side.ends.map(|end| end.truncate());
            let [to_a, to_b] = [0, 1].map(|k| self.end(side, k));
            picture.chain([to_a, a, b, to_b], look);
        }
        if let Some([x, y]) = self.pixel {
            let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)];
            picture.chain(corners.map(|d| middle([x, y]) + DVec2::from(d)), Look::Now);
        }
        picture
    }

    /// Returns the point at which the border of a side leaves the picture.
    fn end(&self, side: &VolumeSide, k: usize) -> DVec2 {
        let (from, along) = (side.ends[k].truncate(), side.away[k].truncate());
        let size = DVec2::new(self.scene.raster.columns.into(), self.scene.raster.rows.into());
        let times = (0..2).map(|axis| {
            let border = if along[axis] > 0.0 { size[axis] } else { 0.0 };
            (border - from[axis]) / along[axis]
        });
        let t = times.filter(|t| t.is_finite()).fold(f64::INFINITY, f64::min);
        if t.is_finite() { from + along * t.max(0.0) } else { from }
    }
}
