//! The lesson of the hierarchical z-buffer.

use super::{DEPTH, EXAMPLES, Scene, TAKES, beams, name, slab};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::hierarchical_z::{INFO, Options, PyramidTest, Step, items};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "wall",
            title: Word::new(
                "a wall before many things: their cells are left out",
                "eine Wand vor vielen Dingen: Ihre Zellen werden ausgelassen",
            ),
            input: || Input::Faces(wall()),
        },
        EXAMPLES[0],
        EXAMPLES[1],
        EXAMPLES[2],
        EXAMPLES[4],
        EXAMPLES[5],
    ],
    templates: &[&CELL, &VISIT, &LEAVE_OUT, &HIDDEN, &DRAWN, &STORE, &LOWER],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static CELL: Template = Template::new(
    "cell",
    "Cell {cell} of the octree, z from {near} to {far}: {faces} {faces|face belongs|faces belong} to it and to no child.",
    "Zelle {cell} des Octrees, z von {near} bis {far}: {faces} {faces|Fläche gehört|Flächen gehören} ihr und keinem Kind.",
);
static VISIT: Template = Template::new(
    "visit",
    "Cell {cell} begins at z = {near}; level {level} of the pyramid has {stored} there.",
    "Zelle {cell} beginnt bei z = {near}; Ebene {level} der Pyramide hat dort {stored}.",
);
static LEAVE_OUT: Template = Template::new(
    "leave-out",
    "Cell {cell} is hidden: {faces} {faces|face is|faces are} left out unseen.",
    "Zelle {cell} ist verdeckt: {faces} {faces|Fläche wird|Flächen werden} ungesehen ausgelassen.",
);
static HIDDEN: Template = Template::new(
    "face",
    "{face} begins at z = {near}, level {level} has {stored}: it is hidden.",
    "{face} beginnt bei z = {near}, Ebene {level} hat {stored}: Sie ist verdeckt.",
);
static DRAWN: Template = Template::new(
    "face",
    "{face} begins at z = {near}, level {level} has {stored}: its pixels are compared.",
    "{face} beginnt bei z = {near}, Ebene {level} hat {stored}: Ihre Pixel werden verglichen.",
);
static STORE: Template = Template::new(
    "store",
    "Pixel {pixel}: depth {depth} and face {face} are stored.",
    "Pixel {pixel}: Tiefe {depth} und Fläche {face} werden gespeichert.",
);
static LOWER: Template = Template::new(
    "lower",
    "Level {level}: the farthest of the four below is {stored} now.",
    "Ebene {level}: Die fernste der vier darunter ist jetzt {stored}.",
);

/// Returns a wall over the whole picture, and small things behind it and one before.
pub(super) fn wall() -> Vec<Vec<DVec3>> {
    let small = |x: f64, y: f64, depth: f64| slab((x, y), (x + 1.0, y + 1.0), (depth, depth));
    let mut faces = vec![
        small(0.5, 0.5, 7.0),
        small(2.5, 1.5, 8.0),
        small(6.5, 0.5, 7.5),
        small(5.5, 5.5, 8.0),
        small(1.0, 6.0, 1.0),
    ];
    faces.push(slab((0.0, 0.0), (8.0, 8.0), (3.0, 3.0)));
    faces.extend(beams().into_iter().take(1).map(|beam| {
        let shrunk = |p: &DVec3| DVec3::new(p.x * 0.8, p.y * 0.8, p.z - 5.0);
        beam.iter().map(shrunk).collect()
    }));
    faces
}

/// State of the run.
#[derive(Clone)]
struct State {
    scene: Scene,
    cells: Vec<[DVec3; 2]>,
    /// Comparisons so far: of what, and with what.
    tests: Vec<(String, PyramidTest)>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let options = Options { capacity: 1, depth: 3 };
    let steps = record(cap, |t| items(&scene.faces, &scene.screen(), &options, t))?;
    let mut state = State { scene, cells: Vec::new(), tests: Vec::new() };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Cell { cell, corners, faces } => {
                self.cells.push(corners);
                let [near, far] = corners.map(|corner| Value::from(corner.z));
                let values =
                    [("cell", cell.into()), ("near", near), ("far", far), ("faces", faces.into())];
                CELL.with(values)
            }
            Step::Visit { cell, test } => {
                self.tests.push((cell.to_string(), test));
                let [near, level, stored] = numbers(&test);
                VISIT.with([("cell", cell.into()), near, level, stored])
            }
            Step::LeaveOut { cell, faces } => {
                LEAVE_OUT.with([("cell", cell.into()), ("faces", faces.into())])
            }
            Step::Face { face, test } => {
                self.tests.push((name(face), test));
                let template = if test.is_hidden() { &HIDDEN } else { &DRAWN };
                let [near, level, stored] = numbers(&test);
                template.with([("face", name(face).into()), near, level, stored])
            }
            Step::Store { pixel, face, depth } => {
                self.scene.set(pixel, face);
                let at = Value::from(DVec2::new(pixel[0].into(), pixel[1].into()));
                STORE.with([("pixel", at), ("depth", depth.into()), ("face", name(face).into())])
            }
            Step::Lower { level, farthest, .. } => {
                LOWER.with([("level", level.into()), ("stored", farthest.into())])
            }
        }
    }

    /// Returns the last comparisons.
    fn table(&self) -> Table {
        let heads = [
            Word::new("cell or face", "Zelle oder Fläche"),
            DEPTH,
            Word::new("level", "Ebene"),
            Word::new("stored", "gespeichert"),
            Word::new("hidden", "verdeckt"),
        ];
        let mut table = Table::new(heads);
        let first = self.tests.len().saturating_sub(8);
        for (thing, test) in &self.tests[first..] {
            let hidden =
                if test.is_hidden() { Word::new("yes", "ja") } else { Word::new("no", "nein") };
            let cells: [Value; 4] =
                [test.nearest.into(), test.level.into(), test.farthest.into(), hidden.into()];
            table.row(thing.clone(), cells);
        }
        table
    }

    /// Draws the pixels, the cell in question, and the entry of the pyramid.
    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.picture();
        let mut frame = |low: DVec2, high: DVec2, look| {
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y), low];
            picture.chain(corners.to_vec(), look);
        };
        let mut entry = |level: u32, at: [u32; 2]| {
            let size = f64::from(1_u32 << level.min(31));
            let low = DVec2::new(at[0].into(), at[1].into()) * size;
            frame(low, low + size, Look::Now);
        };
        let mut cell = None;
        match *step {
            Step::Cell { cell: number, .. } | Step::LeaveOut { cell: number, .. } => {
                cell = Some(number);
            }
            Step::Visit { cell: number, test } => {
                entry(test.level, test.entry);
                cell = Some(number);
            }
            Step::Face { test, .. } => entry(test.level, test.entry),
            Step::Store { pixel, .. } => entry(0, pixel),
            Step::Lower { level, entry: at, .. } => entry(level, at),
        }
        if let Some([low, high]) = cell.and_then(|cell| self.cells.get(cell)) {
            frame(low.truncate(), high.truncate(), Look::First);
        }
        if let Step::Face { face, .. } = *step {
            self.scene.outline(&mut picture, face as usize, Look::Second);
        }
        picture
    }
}

fn numbers(test: &PyramidTest) -> [(&'static str, Value); 3] {
    [("near", test.nearest.into()), ("level", test.level.into()), ("stored", test.farthest.into())]
}
