//! The lesson of the octree whose cells are filled from front to back.

use super::hierarchical::wall;
use super::{DEPTH, EXAMPLES, Scene, TAKES, name};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::octree::{INFO, Options, Step, items};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        EXAMPLES[0],
        Example {
            name: "wall",
            title: Word::new(
                "a wall before many things: far cells are left out",
                "eine Wand vor vielen Dingen: Ferne Zellen werden ausgelassen",
            ),
            input: || Input::Faces(wall()),
        },
        EXAMPLES[2],
        EXAMPLES[1],
        EXAMPLES[4],
        EXAMPLES[5],
    ],
    templates: &[&CELL, &LEAF_CELL, &VISIT, &LEAVE_OUT, &LEAF, &STORE],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static CELL: Template = Template::new(
    "cell",
    "Cell {cell}, z from {near} to {far}, is divided; its children with faces, near ones first, are {children}.",
    "Zelle {cell}, z von {near} bis {far}, wird geteilt; ihre Kinder mit Flächen, nahe zuerst, sind {children}.",
);
static LEAF_CELL: Template = Template::new(
    "cell",
    "Cell {cell}, z from {near} to {far}, is not divided any more.",
    "Zelle {cell}, z von {near} bis {far}, wird nicht weiter geteilt.",
);
static VISIT: Template = Template::new(
    "visit",
    "Cell {cell} is visited: its near children come before its far ones.",
    "Zelle {cell} wird besucht: Ihre nahen Kinder kommen vor den fernen.",
);
static LEAVE_OUT: Template = Template::new(
    "leave-out",
    "All pixels of cell {cell} are filled: it is left out. Cells in it, itself counted: {count}.",
    "Alle Pixel der Zelle {cell} sind gefüllt: Sie wird ausgelassen. Zellen darin, sie selbst mitgezählt: {count}.",
);
static LEAF: Template = Template::new(
    "leaf",
    "Cell {cell} is one of the smallest. Faces that meet it: {faces}; their depths are compared within it.",
    "Zelle {cell} ist eine der kleinsten. Flächen darin: {faces}; ihre Tiefen werden in ihr verglichen.",
);
static STORE: Template = Template::new(
    "store",
    "Pixel {pixel} is filled with {face} at depth {depth}, for good.",
    "Pixel {pixel} wird mit {face} in Tiefe {depth} gefüllt, endgültig.",
);

/// State of the run.
#[derive(Clone)]
struct State {
    scene: Scene,
    cells: Vec<[DVec3; 2]>,
    /// Cells visited so far, with what was found.
    visited: Vec<(usize, Word)>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let options = Options { capacity: 1, depth: 3, ..Options::default() };
    let steps = record(cap, |t| items(&scene.faces, &scene.screen(), &options, t))?;
    let mut state = State { scene, cells: Vec::new(), visited: Vec::new() };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        match step {
            Step::Cell { cell, corners, children } => {
                self.cells.push(*corners);
                let [near, far] = corners.map(|corner| Value::from(corner.z));
                let [cell, near, far] = [("cell", (*cell).into()), ("near", near), ("far", far)];
                if children.is_empty() {
                    return LEAF_CELL.with([cell, near, far]);
                }
                CELL.with([cell, near, far, ("children", children.clone().into())])
            }
            Step::Visit { cell } => {
                self.visited.push((*cell, Word::new("visited", "besucht")));
                VISIT.with([("cell", (*cell).into())])
            }
            Step::LeaveOut { cell, cells } => {
                self.visited.push((*cell, Word::new("left out", "ausgelassen")));
                LEAVE_OUT.with([("cell", (*cell).into()), ("count", (*cells).into())])
            }
            Step::Leaf { cell, faces } => {
                self.visited.push((*cell, Word::new("compared", "verglichen")));
                let faces: Vec<String> = faces.iter().copied().map(name).collect();
                LEAF.with([("cell", (*cell).into()), ("faces", faces.into())])
            }
            Step::Store { pixel, face, depth } => {
                self.scene.set(*pixel, *face);
                let at = DVec2::new(pixel[0].into(), pixel[1].into());
                let face = ("face", name(*face).into());
                STORE.with([("pixel", at.into()), face, ("depth", (*depth).into())])
            }
        }
    }

    /// Returns the last visits.
    fn table(&self) -> Table {
        let heads = [Word::new("cell", "Zelle"), DEPTH, Word::new("found", "Befund")];
        let mut table = Table::new(heads);
        let first = self.visited.len().saturating_sub(8);
        for (cell, found) in self.visited.iter().skip(first) {
            let near = self.cells.get(*cell).map_or(0.0, |corners| corners[0].z);
            table.row(*cell, [near.into(), (*found).into()]);
        }
        table
    }

    /// Draws the pixels and the cell in question.
    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.picture();
        let (cell, look) = match step {
            Step::Cell { cell, .. } => (*cell, Look::First),
            Step::LeaveOut { cell, .. } => (*cell, Look::Second),
            Step::Visit { cell } | Step::Leaf { cell, .. } => (*cell, Look::Now),
            Step::Store { .. } => (self.visited.last().map_or(0, |(cell, _)| *cell), Look::First),
        };
        if let Some([low, high]) = self.cells.get(cell).map(|c| c.map(|c| c.truncate())) {
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y), low];
            picture.chain(corners.to_vec(), look);
        }
        if let Step::Leaf { faces, .. } = step {
            let faces = faces.iter().map(|face| *face as usize);
            faces.for_each(|face| self.scene.outline(&mut picture, face, Look::Second));
        }
        picture
    }
}
