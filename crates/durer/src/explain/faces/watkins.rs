//! The lesson of Watkins' spanning scan line with its three tables.

use super::{EXAMPLES, Scene, TAKES, name};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::NO_HEAD;
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::watkins::{EdgeEntry, INFO, Step, items};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&EDGE, &POLYGON, &ROW, &ACTIVE, &IN, &OUT, &ONE, &TWO, &SPAN],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static EDGE: Template = Template::new(
    "edge",
    "An edge of {face} goes into the edge table: from row {first} to y_max = {end}, x = {x}.",
    "Eine Kante von {face} kommt in die Kantentabelle: von Zeile {first} bis y_max = {end}, x = {x}.",
);
static POLYGON: Template = Template::new(
    "polygon",
    "{face} goes into the polygon table: z = {z} + {dx} · x + {dy} · y, its flag is out.",
    "{face} kommt in die Polygontabelle: z = {z} + {dx} · x + {dy} · y, Flagge außen.",
);
static ROW: Template = Template::new(
    "row",
    "Row {row} begins: all flags are out.",
    "Zeile {row} beginnt: Alle Flaggen stehen auf außen.",
);
static ACTIVE: Template = Template::new(
    "active",
    "The active edge table, in the order of x: an edge of {face} at x = {x}.",
    "Die Tabelle der aktiven Kanten, nach x: eine Kante von {face} bei x = {x}.",
);
static IN: Template = Template::new(
    "flag",
    "At x = {x} an edge of {face} is passed: the flag of {face} is in.",
    "Bei x = {x} kommt eine Kante von {face}: Die Flagge von {face} steht auf innen.",
);
static OUT: Template = Template::new(
    "flag",
    "At x = {x} an edge of {face} is passed: the flag of {face} is out.",
    "Bei x = {x} kommt eine Kante von {face}: Die Flagge von {face} steht auf außen.",
);
static ONE: Template = Template::new(
    "ends",
    "Pixels {first} to {last}, {count} in: {face} is nearest at both ends, with depths {z0} and {z1}.",
    "Pixel {first} bis {last}, {count} innen: {face} liegt an beiden Enden vorn, mit den Tiefen {z0} und {z1}.",
);
static TWO: Template = Template::new(
    "ends",
    "Pixels {first} to {last}, {count} in: {face} is nearest at the left ({z0}), {other} at the right ({z1}): halve.",
    "Pixel {first} bis {last}, {count} innen: Links liegt {face} vorn ({z0}), rechts {other} ({z1}): halbieren.",
);
static SPAN: Template = Template::new(
    "span",
    "{face} is seen in row {row}, pixels {first} to {last}.",
    "{face} ist in Zeile {row} zu sehen, Pixel {first} bis {last}.",
);

/// The three tables.
#[derive(Clone)]
struct State {
    scene: Scene,
    waiting: Vec<EdgeEntry>,
    planes: Vec<(u32, DVec2, f64)>,
    active: Vec<EdgeEntry>,
    inside: Vec<u32>,
    row: i32,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let steps = record(cap, |t| items(&scene.faces, &scene.screen(), t))?;
    let (waiting, active, inside) = (Vec::new(), Vec::new(), Vec::new());
    let mut state = State { scene, waiting, planes: Vec::new(), active, inside, row: -1 };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Edge(entry) => {
                self.waiting.push(entry);
                let (first, end) = entry.edge.rows;
                let values = [first.into(), end.into(), entry.edge.x.into()];
                let [first, end, x]: [Value; 3] = values;
                EDGE.with([face(entry.face), ("first", first), ("end", end), ("x", x)])
            }
            Step::Polygon { face: number, slope, origin } => {
                self.planes.push((number, slope, origin));
                let [dx, dy, z] = [slope.x, slope.y, origin].map(Value::from);
                POLYGON.with([face(number), ("dx", dx), ("dy", dy), ("z", z)])
            }
            Step::Row { y } => {
                self.row = y;
                self.active.clear();
                self.inside.clear();
                self.waiting.retain(|entry| entry.edge.rows.0 > y);
                ROW.with([("row", y.into())])
            }
            Step::Active(entry) => {
                self.active.push(entry);
                ACTIVE.with([face(entry.face), ("x", entry.edge.x.into())])
            }
            Step::Flag { face: number, x, inside } => {
                self.inside.retain(|other| *other != number);
                self.inside.extend(inside.then_some(number));
                let template = if inside { &IN } else { &OUT };
                template.with([face(number), ("x", x.into())])
            }
            Step::Ends { columns, polygons, nearest, depths } => {
                ends(columns, polygons, nearest, depths)
            }
            Step::Span { face: number, y, columns: [x0, x1] } => {
                let pixels = u32::try_from(y).into_iter();
                let pixels = pixels.flat_map(|y| (x0.max(0)..x1).map(move |x| [x as u32, y]));
                pixels.for_each(|pixel| self.scene.set(pixel, number));
                let [row, first, last] = [y, x0, x1 - 1].map(Value::from);
                SPAN.with([face(number), ("row", row), ("first", first), ("last", last)])
            }
        }
    }

    fn table(&self) -> Table {
        let heads = [
            NO_HEAD,
            Word::new("face", "Fläche"),
            Word::new("x", "x"),
            Word::new("y_max", "y_max"),
            Word::new("plane, flag", "Ebene, Flagge"),
        ];
        let mut table = Table::new(heads);
        let rows = [("ET", &self.waiting), ("AET", &self.active)];
        let [waiting, active] = rows;
        let mut add = |(kind, entries): (&str, &Vec<EdgeEntry>)| {
            for (place, EdgeEntry { edge, face }) in entries.iter().enumerate() {
                let cells = [name(*face).into(), edge.x.into(), edge.rows.1.into(), "".into()];
                table.row(format!("{kind} {}", place + 1), cells);
            }
        };
        add(waiting);
        add(active);
        for &(face, slope, origin) in &self.planes {
            let flag = if self.inside.contains(&face) {
                Word::new("in", "innen")
            } else {
                Word::new("out", "außen")
            };
            let plane: Vec<Value> = vec![origin.into(), slope.into(), flag.into()];
            table.row(
                format!("PT {}", name(face)),
                [name(face).into(), "".into(), "".into(), Value::List(plane)],
            );
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.picture();
        let on_row = |x: f64| DVec2::new(x, f64::from(self.row) + 0.5);
        if self.row >= 0 {
            let [low, high] = picture.extent;
            picture.chain([on_row(low.x), on_row(high.x)], Look::Dashed);
        }
        for entry in &self.active {
            picture.dot(on_row(entry.edge.x as f64), Look::Second);
        }
        match *step {
            Step::Ends { columns: [x0, x1], .. } | Step::Span { columns: [x0, x1], .. } => {
                picture.chain([x0, x1].map(|x| on_row(x.into())), Look::Now);
            }
            Step::Flag { x, .. } => picture.dot(on_row(x.into()), Look::Now),
            Step::Edge(EdgeEntry { face, .. }) | Step::Polygon { face, .. } => {
                self.scene.outline(&mut picture, face as usize, Look::Now);
            }
            Step::Row { .. } | Step::Active(_) => {}
        }
        picture
    }
}

fn face(number: u32) -> (&'static str, Value) {
    ("face", name(number).into())
}

/// Returns the caption of a comparison at both ends of a span.
fn ends([x0, x1]: [i32; 2], polygons: usize, nearest: [u32; 2], depths: [f64; 2]) -> Caption {
    let span = [("first", x0.into()), ("last", (x1 - 1).into()), ("count", polygons.into())];
    let [first, last, count] = span;
    let [z0, z1] = depths.map(Value::from);
    if nearest[0] == nearest[1] {
        return ONE.with([first, last, count, face(nearest[0]), ("z0", z0), ("z1", z1)]);
    }
    let other = ("other", name(nearest[1]).into());
    TWO.with([first, last, count, face(nearest[0]), other, ("z0", z0), ("z1", z1)])
}
