//! The lesson of depth sort, on the triangles of faces.

use super::triangles::Triangles;
use super::{Scene, TAKES, beams, slab};
use crate::Result;
use crate::explain::frame::{Frames, Shown, frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::visibility::surface::Cull;
use crate::visibility::surface::depth_sort::{INFO, Step, Test, order};
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::setup::Filter;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&LOOK, &PASSED, &FAILED, &MOVE, &SPLIT, &PLACE],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "cyclic",
        title: Word::new(
            "three beams, each before the next: a split",
            "drei Balken, jeder vor dem nächsten: eine Teilung",
        ),
        input: || Input::Faces(beams()),
    },
    Example {
        name: "penetration",
        title: Word::new("two faces that pierce each other", "zwei Flächen, die sich durchdringen"),
        input: || {
            let a = slab((0.0, 1.0), (7.0, 4.0), (1.0, 4.0));
            let b = slab((2.0, 0.0), (9.0, 3.0), (4.0, 1.0));
            Input::Faces(vec![a, b])
        },
    },
];

static LOOK: Template = Template::new(
    "look",
    "{p} is the farthest that is left: may it be painted next?",
    "{p} ist das fernste, das übrig ist: Darf es als Nächstes gemalt werden?",
);
static PASSED: Template = Template::new(
    "tested",
    "{p} against {q}: test {test} holds, {why}, so {p} may be painted before {q}.",
    "{p} gegen {q}: Test {test} gilt, {why}; {p} darf vor {q} gemalt werden.",
);
static FAILED: Template = Template::new(
    "tested",
    "{p} against {q}: no test holds, so {p} may hide {q}.",
    "{p} gegen {q}: Kein Test gilt, {p} könnte {q} verdecken.",
);
static MOVE: Template = Template::new(
    "move",
    "{p} is marked and moved before the other: it is looked at first.",
    "{p} wird markiert und rückt vor das andere: Es kommt zuerst an die Reihe.",
);
static SPLIT: Template = Template::new(
    "split",
    "{p} was marked already: they overlap cyclically, so it is split into {a} and {b}.",
    "{p} war schon markiert: Sie überlappen sich zyklisch, es wird in {a} und {b} geteilt.",
);
static PLACE: Template = Template::new(
    "place",
    "{p} is painted next, over what is there.",
    "{p} wird als Nächstes gemalt, über alles, was da ist.",
);

/// The list of polygons and verdicts.
struct Sorting {
    scene: Scene,
    triangles: Triangles,
    items: Vec<u32>,
    /// Names and triangles of pieces, after the triangles.
    pieces: Vec<(u32, String, u32)>,
    verdicts: Vec<(String, String, Value)>,
    painted: Vec<u32>,
    now: [Option<u32>; 2],
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let triangles = Triangles::new(&scene)?;
    let (model, view) = triangles.prepared(&scene)?;
    let surfaces = SurfaceInput::new(&model, &view, Filter::new(Cull::None, 0))?;
    let steps = record(cap, |t| order(&surfaces, t))?;
    let items = surfaces.triangles.iter().map(|triangle| triangle.item).collect();
    let (pieces, verdicts, painted) = (Vec::new(), Vec::new(), Vec::new());
    let mut sorting =
        Sorting { scene, triangles, items, pieces, verdicts, painted, now: [None; 2] };
    Ok(frames(&steps, |step| sorting.show(step)))
}

impl Sorting {
    fn show(&mut self, step: &Step) -> Shown {
        let caption = self.take(step);
        Shown { line: step.line(), caption, table: self.table(), picture: self.picture() }
    }

    /// Returns the name of a polygon and its triangle's item.
    fn polygon(&self, number: u32) -> (String, u32) {
        if let Some((_, name, item)) = self.pieces.iter().find(|piece| piece.0 == number) {
            return (name.clone(), *item);
        }
        let item = self.items.get(number as usize).copied().unwrap_or_default();
        (self.triangles.name(item), item)
    }

    fn take(&mut self, step: &Step) -> Caption {
        let (Step::Look { polygon }
        | Step::Tested { polygon, .. }
        | Step::Move { polygon }
        | Step::Split { polygon, .. }
        | Step::Place { polygon }) = *step;
        let (name, item) = self.polygon(polygon);
        self.now = [Some(item), None];
        let p = ("p", Value::from(name.clone()));
        match *step {
            Step::Look { .. } => {
                self.verdicts.clear();
                LOOK.with([p])
            }
            Step::Tested { other, passed, .. } => {
                let (other, item) = self.polygon(other);
                self.now[1] = Some(item);
                let number = passed.map_or("–", Test::number);
                self.verdicts.push((name, other.clone(), number.into()));
                let q = ("q", Value::from(other));
                match passed {
                    Some(test) => {
                        PASSED.with([p, q, ("test", number.into()), ("why", why(test).into())])
                    }
                    None => FAILED.with([p, q]),
                }
            }
            Step::Move { .. } => MOVE.with([p]),
            Step::Split { pieces, .. } => {
                let names = ["′", "″"].map(|sign| format!("{name}{sign}"));
                let [a, b] = names.clone().map(Value::from);
                self.pieces.extend(pieces.into_iter().zip(names).map(|(n, name)| (n, name, item)));
                SPLIT.with([p, ("a", a), ("b", b)])
            }
            Step::Place { .. } => {
                self.painted.push(polygon);
                PLACE.with([p])
            }
        }
    }

    fn table(&self) -> Table {
        let heads = [Word::new("P", "P"), Word::new("Q", "Q"), Word::new("test", "Test")];
        let mut table = Table::new(heads);
        for (p, q, test) in &self.verdicts {
            table.row(p.as_str(), [q.as_str().into(), test.clone()]);
        }
        let painted: Vec<String> =
            self.painted.iter().map(|number| self.polygon(*number).0).collect();
        table.row(Word::new("painted", "gemalt"), [Value::from(painted)]);
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = self.scene.raster.picture();
        picture.grid = None;
        for item in 0..self.triangles.corners.len() as u32 {
            picture.chain(self.triangles.outline(item), Look::Pale);
            let outline = self.triangles.outline(item);
            let middle = outline.iter().take(3).sum::<DVec2>() / 3.0;
            picture.label(middle, (0.0, 0.0), self.triangles.name(item));
        }
        for number in &self.painted {
            let outline = self.triangles.outline(self.polygon(*number).1);
            picture.ring(outline, Look::Result);
        }
        for (item, look) in self.now.iter().zip([Look::First, Look::Second]) {
            item.iter().for_each(|item| picture.ring(self.triangles.outline(*item), look));
        }
        picture
    }
}

/// Returns the finding of a test.
fn why(test: Test) -> Word {
    match test {
        Test::Depths => Word::new("their depths are apart", "die Tiefen sind getrennt"),
        Test::Boxes => Word::new("their boxes are apart", "die umgebenden Rechtecke sind getrennt"),
        Test::InFrontOfPlane => {
            Word::new("Q lies before the plane of P", "Q liegt vor der Ebene von P")
        }
        Test::BehindPlane => {
            Word::new("P lies behind the plane of Q", "P liegt hinter der Ebene von Q")
        }
        Test::Projections => {
            Word::new("their projections are apart", "die Projektionen sind getrennt")
        }
        Test::Pixels => Word::new("P is nearer at no pixel", "P liegt an keinem Pixel näher"),
    }
}
