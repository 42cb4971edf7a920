//! The lesson of Warnock's subdivision of windows.

use super::{EXAMPLES, Scene, TAKES, name, slab};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::warnock::{INFO, Options, Step, WindowRule, items};
use crate::visibility::surface::window::{SampleRect, WindowRelation};

pub(super) const LESSON: Lesson = Lesson {
    name: "warnock",
    info: &INFO,
    takes: TAKES,
    examples: &[
        EXAMPLES[0],
        EXAMPLES[1],
        EXAMPLES[2],
        Example {
            name: "one-look",
            title: Word::new(
                "a quad around the picture: one look",
                "ein Viereck um das Bild: ein Blick",
            ),
            input: || Input::Faces(vec![slab((0.0, 0.0), (8.9, 5.9), (2.0, 4.0))]),
        },
        Example {
            name: "corner",
            title: Word::new(
                "a small triangle before a quad around the picture",
                "ein kleines Dreieck vor einem Viereck um das Bild",
            ),
            input: || {
                let [a, b, c, _] = slab((1.0, 1.0), (4.0, 4.0), (1.0, 1.0))[..] else {
                    return Input::Faces(Vec::new());
                };
                let quad = slab((0.0, 0.0), (15.9, 15.9), (3.0, 3.0));
                Input::Faces(vec![quad, vec![a, b, c]])
            },
        },
        EXAMPLES[5],
    ],
    templates: &[&LOOK_AT, &EMPTY, &SINGLE, &SURROUNDED, &PIXEL, &DIVIDE, &DRAW],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static LOOK_AT: Template = Template::new(
    "look",
    "A window of {width} × {height} pixels at {at}: {relations}.",
    "Ein Fenster von {width} × {height} Pixeln bei {at}: {relations}.",
);
static EMPTY: Template = Template::new(
    "simple",
    "Rule 1: all polygons are outside, so the window shows the background.",
    "Regel 1: Alle Polygone liegen außerhalb, das Fenster zeigt den Hintergrund.",
);
static SINGLE: Template = Template::new(
    "simple",
    "Rule 2: only {face} concerns the window, so its part is drawn.",
    "Regel 2: Nur {face} betrifft das Fenster, sein Teil wird gezeichnet.",
);
static SURROUNDED: Template = Template::new(
    "simple",
    "Rule 3: {face} surrounds the window and is nearest at its four corners, so the window is filled.",
    "Regel 3: {face} umgibt das Fenster und liegt an seinen vier Ecken vorn, das Fenster wird gefüllt.",
);
static PIXEL: Template = Template::new(
    "simple",
    "Rule 4: the window is one pixel, and {face} is nearest there.",
    "Regel 4: Das Fenster ist ein Pixel, und dort liegt {face} vorn.",
);
static DIVIDE: Template = Template::new(
    "divide",
    "No rule holds: the window is divided in four at {at}.",
    "Keine Regel gilt: Das Fenster wird bei {at} in vier geteilt.",
);
static DRAW: Template = Template::new(
    "draw",
    "{face} is drawn from {from} to {to}.",
    "{face} wird von {from} bis {to} gezeichnet.",
);

/// Windows that wait, and the decisions so far.
#[derive(Clone)]
struct Windows {
    scene: Scene,
    stack: Vec<SampleRect>,
    now: Option<SampleRect>,
    relations: Vec<(u32, WindowRelation)>,
    decided: Vec<SampleRect>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let steps = record(cap, |t| items(&scene.faces, &scene.screen(), &Options::default(), t))?;
    let (stack, relations, decided) = (Vec::new(), Vec::new(), Vec::new());
    let mut windows = Windows { scene, stack, now: None, relations, decided };
    Ok(Frames::new(steps, move |step, want| {
        let caption = windows.take(step);
        want.shown(step.line(), caption, || windows.table(), || windows.picture())
    }))
}

impl Windows {
    fn take(&mut self, step: &Step) -> Caption {
        match step {
            Step::Look { window, relations } => {
                self.stack.retain(|other| other != window);
                self.now = Some(*window);
                self.relations.clone_from(relations);
                let [width, height] = [window.x1 - window.x0, window.y1 - window.y0];
                let [width, height] = [("width", width.into()), ("height", height.into())];
                let at = ("at", at(window.x0, window.y0).into());
                LOOK_AT.with([width, height, at, ("relations", self.relations())])
            }
            Step::Simple { window, rule, face } => {
                self.decided.push(*window);
                let face = ("face", Value::from(face.map_or(String::new(), name)));
                match rule {
                    WindowRule::Empty => EMPTY.with([]),
                    WindowRule::Single => SINGLE.with([face]),
                    WindowRule::Surrounded => SURROUNDED.with([face]),
                    WindowRule::Pixel => PIXEL.with([face]),
                }
            }
            Step::Divide { window, x, y } => {
                let (SampleRect { x0, y0, x1, y1 }, x, y) = (*window, *x, *y);
                let parts = [(x, y, x1, y1), (x0, y, x, y1), (x, y0, x1, y), (x0, y0, x, y)];
                let parts = parts.map(|(x0, y0, x1, y1)| SampleRect { x0, y0, x1, y1 });
                self.stack.extend(parts.iter().filter(|part| !part.is_empty()));
                DIVIDE.with([("at", at(x, y).into())])
            }
            Step::Draw { face, span: [y, x0, x1] } => {
                (*x0..*x1).for_each(|x| self.scene.set([x as u32, *y as u32], *face));
                let ends = [("from", at(*x0, *y).into()), ("to", at(*x1 - 1, *y).into())];
                let [from, to] = ends;
                DRAW.with([("face", name(*face).into()), from, to])
            }
        }
    }

    /// Returns the relations of the polygons to the window in words.
    fn relations(&self) -> Value {
        let word = |relation| match relation {
            WindowRelation::Outside => Word::new("outside", "außen"),
            WindowRelation::Inside => Word::new("inside", "innen"),
            WindowRelation::Crossing => Word::new("crossing", "schneidend"),
            WindowRelation::Surrounding => Word::new("surrounding", "umgebend"),
        };
        let one = |(face, relation): &(u32, WindowRelation)| {
            [Value::from(name(*face)), Value::from(word(*relation))]
        };
        Value::List(self.relations.iter().flat_map(one).collect())
    }

    /// Returns the windows that wait, the next one above.
    fn table(&self) -> Table {
        let heads =
            [Word::new("waits", "wartet"), Word::new("from", "von"), Word::new("to", "bis")];
        let mut table = Table::new(heads);
        for (place, window) in self.stack.iter().enumerate().rev() {
            let corners = [at(window.x0, window.y0), at(window.x1, window.y1)];
            table.row(place + 1, corners.map(Value::from));
        }
        table
    }

    fn picture(&self) -> Picture {
        let mut picture = self.scene.picture();
        self.decided.iter().for_each(|window| picture.chain(frame(window), Look::Thin));
        self.now.iter().for_each(|window| picture.chain(frame(window), Look::Now));
        picture
    }
}

fn at(x: i32, y: i32) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

fn frame(window: &SampleRect) -> Vec<DVec2> {
    let SampleRect { x0, y0, x1, y1 } = *window;
    [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)].map(|(x, y)| at(x, y)).to_vec()
}
