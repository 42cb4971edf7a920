//! The lesson of scan lines through solids that are combined.

use super::{FACE, Scene, TAKES, name};
use crate::clip::polygon::BooleanOp;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DMat4, DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::Face;
use crate::visibility::polygons::csg::{Expression, INFO, RowPart, Step, items};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "blocks",
            title: Word::new(
                "two blocks that pierce each other",
                "zwei Blöcke, die sich durchdringen",
            ),
            input: || {
                let first =
                    block(DVec3::new(4.0, 3.0, -4.0), DVec3::new(3.0, 2.0, 2.0), (0.5, 0.3));
                let second =
                    block(DVec3::new(6.0, 4.0, -3.5), DVec3::new(2.5, 1.5, 2.0), (-0.7, 0.4));
                Input::Faces(first.into_iter().chain(second).collect())
            },
        },
        Example {
            name: "apart",
            title: Word::new("two blocks behind each other", "zwei Blöcke hintereinander"),
            input: || {
                let near = block(DVec3::new(3.0, 3.0, -3.0), DVec3::new(2.0, 1.5, 1.0), (0.5, 0.4));
                let far = block(DVec3::new(4.0, 3.5, -9.0), DVec3::new(2.5, 2.0, 1.0), (-0.4, 0.3));
                Input::Faces(near.into_iter().chain(far).collect())
            },
        },
        Example::new(
            "inside",
            "a small block within a large one",
            "ein kleiner Block in einem großen",
            || {
                let large =
                    block(DVec3::new(4.0, 4.0, -6.0), DVec3::new(3.0, 2.5, 2.0), (0.3, 0.2));
                let small =
                    block(DVec3::new(4.0, 4.0, -6.0), DVec3::new(1.2, 1.0, 0.8), (0.3, 0.2));
                Input::Faces([large, small].concat())
            },
        ),
        Example::new(
            "beam",
            "a beam right through a block",
            "ein Balken mitten durch einen Block",
            || {
                let body = block(DVec3::new(5.0, 4.0, -6.0), DVec3::new(2.0, 2.5, 2.0), (0.4, 0.3));
                let beam = block(DVec3::new(5.0, 4.0, -6.0), DVec3::new(4.5, 0.8, 0.8), (0.4, 0.3));
                Input::Faces([body, beam].concat())
            },
        ),
        Example::new(
            "beside",
            "two blocks side by side: no row has an order to decide",
            "zwei Blöcke nebeneinander: In keiner Zeile ist eine Reihenfolge zu klären",
            || {
                let left = block(DVec3::new(2.5, 3.0, -4.0), DVec3::new(1.2, 2.0, 1.0), (0.5, 0.3));
                let right =
                    block(DVec3::new(8.0, 3.5, -4.0), DVec3::new(1.2, 2.0, 1.0), (-0.5, 0.3));
                Input::Faces([left, right].concat())
            },
        ),
        Example::new(
            "plate",
            "a thin plate cuts a block in two",
            "eine dünne Platte teilt einen Block",
            || {
                let body = block(DVec3::new(4.5, 3.5, -5.0), DVec3::new(3.0, 2.0, 1.5), (0.4, 0.3));
                let plate =
                    block(DVec3::new(4.5, 3.5, -5.0), DVec3::new(0.3, 3.0, 2.5), (0.4, 0.3));
                Input::Faces([body, plate].concat())
            },
        ),
    ],
    templates: &[&SPAN, &DIVIDE, &INTO, &OUT_OF, &HOLDS, &FILL, &EMPTY],
    unreached: &[],
    make: |_, input, options, cap| make(input, options.operation, cap),
};

/// Returns the six faces of a block, turned about x and then about y.
fn block(center: DVec3, half: DVec3, (about_y, about_x): (f64, f64)) -> Vec<Vec<DVec3>> {
    let turn = DMat4::from_rotation_y(about_y) * DMat4::from_rotation_x(about_x);
    let face = |[a, b, c]: [DVec3; 3]| {
        let sides = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let corner =
            |(u, v): (f64, f64)| turn.transform_vector3((a + b * u + c * v) * half) + center;
        sides.map(corner).to_vec()
    };
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    [[z, x, y], [-z, x, y], [x, y, z], [-x, y, z], [y, z, x], [-y, z, x]].map(face).to_vec()
}

static SPAN: Template = Template::new(
    "span",
    "Row {row}, columns {from} to {to}: the faces {faces} in this order, which is the same at both ends.",
    "Zeile {row}, Spalten {from} bis {to}: die Flächen {faces} in dieser Reihenfolge, die an beiden Enden gilt.",
);
static DIVIDE: Template = Template::new(
    "divide",
    "Row {row}, columns {from} to {to}: the order at both ends differs, so the span is divided at {at}.",
    "Zeile {row}, Spalten {from} bis {to}: Die Reihenfolge an den Enden ist verschieden, also wird die Strecke bei {at} geteilt.",
);
static INTO: Template = Template::new(
    "cross",
    "{face} leads into solid {solid}: inside {inside}, and the expression does not hold.",
    "{face} führt in Körper {solid} hinein: innen {inside}, und der Ausdruck gilt nicht.",
);
static OUT_OF: Template = Template::new(
    "cross",
    "{face} leads out of solid {solid}: inside {inside}, and the expression does not hold.",
    "{face} führt aus Körper {solid} heraus: innen {inside}, und der Ausdruck gilt nicht.",
);
static HOLDS: Template = Template::new(
    "cross",
    "{face}, at solid {solid}: inside {inside}. Now the expression holds.",
    "{face}, an Körper {solid}: innen {inside}. Nun gilt der Ausdruck.",
);
static FILL: Template = Template::new(
    "fill",
    "Columns {from} to {to} are filled with {face}.",
    "Die Spalten {from} bis {to} werden mit {face} gefüllt.",
);
static EMPTY: Template = Template::new(
    "fill",
    "The expression holds behind no face: columns {from} to {to} stay empty.",
    "Hinter keiner Fläche gilt der Ausdruck: Die Spalten {from} bis {to} bleiben leer.",
);

/// The solids and the span in question.
#[derive(Clone)]
struct State {
    scene: Scene,
    inside: Vec<bool>,
    rows: Vec<[Value; 3]>,
    part: Option<RowPart>,
}

fn make(input: &Input, op: BooleanOp, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let given = input.faces(TAKES)?;
    let solid_of = solids(given);
    let count = solid_of.iter().max().map_or(0, |last| last + 1);
    if count == 0 {
        return Err(Error::parameter("input", "without a face", TAKES.en));
    }
    // Faces are numbered through the solids in the order of the input only if each solid's faces follow each other.
    if !solid_of.is_sorted() {
        let value = "of solids whose faces are mixed";
        return Err(Error::parameter("input", value, "of solids one after the other"));
    }
    let mut solids: Vec<Vec<Face>> = vec![Vec::new(); count];
    for (face, solid) in scene.faces.iter().zip(&solid_of) {
        solids[*solid].push(face.clone());
    }
    let expression = Expression::fold(op, count)?;
    let steps = record(cap, |t| items(&solids, &expression, &scene.screen(), t))?;
    let (inside, rows) = (vec![false; count], Vec::new());
    let mut state = State { scene, inside, rows, part: None };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

/// Returns the solid of each face: faces that have a corner in common belong together.
fn solids(faces: &[Vec<DVec3>]) -> Vec<usize> {
    let mut solid_of: Vec<usize> = (0..faces.len()).collect();
    for (face, corners) in faces.iter().enumerate() {
        for before in 0..face {
            let touches = faces[before].iter().any(|corner| corners.contains(corner));
            let (old, new) = (solid_of[face], solid_of[before]);
            if touches && old != new {
                let (low, high) = (old.min(new), old.max(new));
                solid_of.iter_mut().filter(|solid| **solid == high).for_each(|solid| *solid = low);
            }
        }
    }
    let mut numbers = solid_of.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let number = |solid: usize| numbers.binary_search(&solid).unwrap_or(0);
    solid_of.into_iter().map(number).collect()
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        let row = |part: RowPart| ("row", Value::from(part.y));
        let ends = |part: RowPart| [("from", part.x0.into()), ("to", (part.x1 - 1).into())];
        match step {
            Step::Span { part, faces } => {
                self.part = Some(*part);
                self.inside.fill(false);
                self.rows.clear();
                let faces: Vec<String> = faces.iter().copied().map(name).collect();
                let [from, to] = ends(*part);
                SPAN.with([row(*part), from, to, ("faces", faces.into())])
            }
            Step::Divide { part, at } => {
                self.part = Some(*part);
                self.rows.clear();
                let [from, to] = ends(*part);
                DIVIDE.with([row(*part), from, to, ("at", (*at).into())])
            }
            Step::Cross { face, solid, inside, holds } => {
                if let Some(own) = self.inside.get_mut(*solid) {
                    *own = *inside;
                }
                let list = self.inside();
                let answer = if *holds { Word::new("yes", "ja") } else { Word::new("no", "nein") };
                self.rows.push([name(*face).into(), list.clone(), answer.into()]);
                let template = match (holds, inside) {
                    (true, _) => &HOLDS,
                    (false, true) => &INTO,
                    (false, false) => &OUT_OF,
                };
                let face = ("face", name(*face).into());
                template.with([face, ("solid", (solid + 1).into()), ("inside", list)])
            }
            Step::Fill { part, face } => {
                let [from, to] = ends(*part);
                match face {
                    Some(face) => {
                        (part.x0..part.x1).for_each(|x| self.scene.set([x, part.y], *face));
                        FILL.with([from, to, ("face", name(*face).into())])
                    }
                    None => EMPTY.with([from, to]),
                }
            }
        }
    }

    /// Returns the numbers of the solids that the ray is inside.
    fn inside(&self) -> Value {
        let solids = (1_usize..).zip(&self.inside).filter(|(_, inside)| **inside);
        solids.map(|(solid, _)| solid).collect::<Vec<_>>().into()
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("passed", "passiert"),
            FACE,
            Word::new("inside solids", "in Körpern"),
            Word::new("holds", "gilt"),
        ]);
        for (number, cells) in self.rows.iter().enumerate() {
            table.row(number + 1, cells.clone());
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.picture();
        if let Some(RowPart { y, x0, x1 }) = self.part {
            let [low, high] = [(x0, y), (x1, y + 1)].map(|(x, y)| DVec2::new(x.into(), y.into()));
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y), low];
            let look = if matches!(step, Step::Divide { .. }) { Look::Second } else { Look::Now };
            picture.chain(corners, look);
        }
        if let Step::Cross { face, .. } = step {
            self.scene.outline(&mut picture, *face as usize, Look::Now);
        }
        picture
    }
}
