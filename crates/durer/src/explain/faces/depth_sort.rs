//! The lesson of depth sort.

use super::{Scene, TAKES, beams, name, slab};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::depth_sort::{INFO, Options, Step, items};
use crate::visibility::surface::depth_sort::PaintTest;

pub(super) const LESSON: Lesson = Lesson {
    name: "depth-sort",
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&LOOK, &PASSED, &FAILED, &MOVE, &SPLIT, &PAINT, &PIXEL],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const EXAMPLES: &[Example] = &[
    Example {
        name: "cyclic",
        title: Word::new(
            "three beams, each before the next: they are split",
            "drei Balken, jeder vor dem nächsten: Sie werden geteilt",
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
    super::EXAMPLES[1],
    super::EXAMPLES[3],
    super::EXAMPLES[4],
    super::EXAMPLES[5],
];

static LOOK: Template = Template::new(
    "look",
    "{p} is the farthest one remaining: may it be painted next?",
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
    "{p} is marked and moved before the other: its turn comes first.",
    "{p} wird markiert und rückt vor das andere: Es kommt zuerst an die Reihe.",
);
static SPLIT: Template = Template::new(
    "split",
    "The other was marked already: they overlap cyclically, so {p} is split along {q} into {a} and {b}.",
    "Das andere war schon markiert: Sie überlappen sich zyklisch, {p} wird an {q} in {a} und {b} geteilt.",
);
static PAINT: Template = Template::new(
    "paint",
    "{p} is painted next, over the picture so far.",
    "{p} wird als Nächstes gemalt, über alles, was da ist.",
);
static PIXEL: Template =
    Template::new("pixel", "Pixel {pixel} gets {face}.", "Pixel {pixel} bekommt {face}.");

/// The list of polygons and verdicts.
#[derive(Clone)]
struct Sorting {
    scene: Scene,
    /// Names and faces of pieces, by their numbers after the faces.
    pieces: Vec<(u32, String, u32)>,
    verdicts: Vec<(String, String, Value)>,
    painted: Vec<String>,
    now: [Option<u32>; 2],
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let steps = record(cap, |t| items(&scene.faces, &scene.screen(), &Options::default(), t))?;
    let (pieces, verdicts, painted) = (Vec::new(), Vec::new(), Vec::new());
    let mut sorting = Sorting { scene, pieces, verdicts, painted, now: [None; 2] };
    Ok(Frames::new(steps, move |step, want| {
        let caption = sorting.take(step);
        want.shown(step.line(), caption, || sorting.table(), || sorting.picture())
    }))
}

impl Sorting {
    /// Returns the name of a polygon and its face.
    fn polygon(&self, number: u32) -> (String, u32) {
        let piece = self.pieces.iter().find(|piece| piece.0 == number);
        piece.map_or_else(|| (name(number), number), |(_, name, face)| (name.clone(), *face))
    }

    fn take(&mut self, step: &Step) -> Caption {
        let (Step::Look { polygon }
        | Step::Tested { polygon, .. }
        | Step::Move { polygon }
        | Step::Split { polygon, .. }
        | Step::Paint { polygon, .. }) = *step
        else {
            return self.pixel(step);
        };
        let (own, face) = self.polygon(polygon);
        self.now = [Some(face), None];
        let p = ("p", Value::from(own.clone()));
        match *step {
            Step::Look { .. } | Step::Pixel { .. } => {
                self.verdicts.clear();
                LOOK.with([p])
            }
            Step::Tested { other, passed, .. } => {
                let (other, face) = self.polygon(other);
                self.now[1] = Some(face);
                let number = passed.map_or("–", PaintTest::number);
                self.verdicts.push((own, other.clone(), number.into()));
                let q = ("q", Value::from(other));
                match passed {
                    Some(test) => {
                        PASSED.with([p, q, ("test", number.into()), ("why", why(test).into())])
                    }
                    None => FAILED.with([p, q]),
                }
            }
            Step::Move { .. } => MOVE.with([p]),
            Step::Split { pieces, along, .. } => {
                let names = ["′", "″"].map(|sign| format!("{own}{sign}"));
                let [a, b] = names.clone().map(Value::from);
                let q = ("q", Value::from(self.polygon(along).0));
                self.pieces.extend(pieces.into_iter().zip(names).map(|(n, name)| (n, name, face)));
                SPLIT.with([p, q, ("a", a), ("b", b)])
            }
            Step::Paint { .. } => {
                self.painted.push(own);
                PAINT.with([p])
            }
        }
    }

    fn pixel(&mut self, step: &Step) -> Caption {
        let Step::Pixel { pixel, face } = *step else { return PIXEL.with([]) };
        self.scene.set(pixel, face);
        let at = DVec2::new(pixel[0].into(), pixel[1].into());
        PIXEL.with([("pixel", at.into()), ("face", name(face).into())])
    }

    fn table(&self) -> Table {
        let heads = [Word::new("P", "P"), Word::new("Q", "Q"), Word::new("test", "Test")];
        let mut table = Table::new(heads);
        for (p, q, test) in &self.verdicts {
            table.row(p.as_str(), [q.as_str().into(), test.clone()]);
        }
        table.row(Word::new("painted", "gemalt"), [Value::from(self.painted.clone())]);
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = self.scene.picture();
        for (face, look) in self.now.iter().zip([Look::First, Look::Second]) {
            face.iter().for_each(|face| {
                self.scene.outline(&mut picture, *face as usize, look);
            });
        }
        picture
    }
}

/// Returns the finding of a test.
fn why(test: PaintTest) -> Word {
    match test {
        PaintTest::Depths => Word::new("their depths are apart", "die Tiefen sind getrennt"),
        PaintTest::Boxes => {
            Word::new("their boxes are apart", "die umgebenden Rechtecke sind getrennt")
        }
        PaintTest::InFrontOfPlane => {
            Word::new("Q lies before the plane of P", "Q liegt vor der Ebene von P")
        }
        PaintTest::BehindPlane => {
            Word::new("P lies behind the plane of Q", "P liegt hinter der Ebene von Q")
        }
        PaintTest::Projections => {
            Word::new("their projections are apart", "die Projektionen sind getrennt")
        }
        PaintTest::Pixels => Word::new("P is nearer at no pixel", "P liegt an keinem Pixel näher"),
    }
}
