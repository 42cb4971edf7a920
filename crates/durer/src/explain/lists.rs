//! The lesson of display lists: a part is recorded once and called at several places; or it calls itself.

use super::frame::{Frames, Shown, Want, record};
use super::grid::NO_HEAD;
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::commands::{
    Command, CornerVertex, DisplayLists, INFO, ListId, MAX_NESTING, Pipeline, Primitive, Step,
    execute, execute_traced,
};
use crate::math::{DMat4, DVec2, DVec3, Rect, Vec4};
use crate::target::Framebuffer;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "cars",
            title: Word::new(
                "two cars, each calls the list of a wheel twice",
                "zwei Autos, jedes ruft die Liste eines Rades zweimal auf",
            ),
            input: || figure(&[WHEEL, BODY], &[(4.0, 2.0), (12.0, 2.0)]),
        },
        Example {
            name: "endless",
            title: Word::new(
                "a list that calls itself, up to the limit",
                "eine Liste, die sich selbst aufruft, bis zur Grenze",
            ),
            input: || figure(&[ARM], &[]),
        },
        Example::new(
            "one",
            "one place: recorded once, called twice all the same",
            "ein Ort: einmal aufgezeichnet und doch zweimal aufgerufen",
            || figure(&[WHEEL, BODY], &[(8.0, 2.0)]),
        ),
        Example::new(
            "part-alone",
            "a part without a body: only matrices between the calls",
            "ein Teil ohne Körper: nur Matrizen zwischen den Aufrufen",
            || figure(&[WHEEL], &[(4.0, 4.0), (12.0, 4.0), (8.0, 9.0)]),
        ),
        Example::new(
            "same-place",
            "two calls at one place: push and pop bring the matrix back",
            "zwei Aufrufe an einem Ort: Push und Pop stellen die Matrix wieder her",
            || figure(&[ARM, BODY], &[(4.0, 10.0), (4.0, 10.0)]),
        ),
        Example::new(
            "two-bodies",
            "two rings of the body in one list",
            "zwei Ringe des Körpers in einer Liste",
            || {
                figure(
                    &[WHEEL, BODY, &[(5.0, 6.0), (9.0, 6.0), (9.0, 8.0), (6.0, 8.0)]],
                    &[(4.0, 2.0), (12.0, 2.0)],
                )
            },
        ),
    ],
    templates: &[
        &RECORDED, &CALLED, &REFUSED, &RETURNED, &MATRIX, &PUSHED, &POPPED, &STATE, &DRAWN,
        &CLEARED,
    ],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "rings and points: the first ring is a part that is called at each point, the others are the body; without points, \
     the part calls itself",
    "Ringe und Punkte: Der erste Ring ist ein Teil, das an jedem Punkt aufgerufen wird, die übrigen sind der Körper; \
     ohne Punkte ruft das Teil sich selbst auf",
);

const WHEEL: &[(f64, f64)] = &[
    (-2.0, -1.0),
    (-1.0, -2.0),
    (1.0, -2.0),
    (2.0, -1.0),
    (2.0, 1.0),
    (1.0, 2.0),
    (-1.0, 2.0),
    (-2.0, 1.0),
];
const BODY: &[(f64, f64)] = &[
    (0.0, 3.0),
    (16.0, 3.0),
    (16.0, 6.0),
    (12.0, 6.0),
    (10.0, 9.0),
    (4.0, 9.0),
    (3.0, 6.0),
    (0.0, 6.0),
];
const ARM: &[(f64, f64)] = &[(0.0, 0.0), (6.0, 0.0), (6.0, 2.0)];

fn figure(rings: &[&[(f64, f64)]], points: &[(f64, f64)]) -> Input {
    let ring = |ring: &&[(f64, f64)]| ring.iter().copied().map(DVec2::from).collect();
    let points = points.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { rings: rings.iter().map(ring).collect(), points, ..Figure::default() })
}

static RECORDED: Template = Template::new(
    "recorded",
    "List {list} is recorded: {commands}. Nothing is executed, and the state stays.",
    "Liste {list} wird aufgezeichnet: {commands}. Nichts wird ausgeführt, und der Zustand bleibt.",
);
static CALLED: Template = Template::new(
    "called",
    "List {list} is called, with the state as it is; lists in each other: {depth} of at most {limit}.",
    "Liste {list} wird aufgerufen, mit dem Zustand, wie er ist; Listen ineinander: {depth} von höchstens {limit}.",
);
static REFUSED: Template = Template::new(
    "refused",
    "The call of list {list} is an error: {depth} lists are in each other, the most that there may be. What was drawn stays.",
    "Der Aufruf von Liste {list} ist ein Fehler: {depth} Listen sind ineinander, mehr dürfen es nicht sein. Was gezeichnet ist, bleibt.",
);
static RETURNED: Template = Template::new(
    "returned",
    "List {list} is at its end; execution goes on behind its call. What the list changed stays changed.",
    "Liste {list} ist zu Ende; es geht hinter ihrem Aufruf weiter. Was sie geändert hat, bleibt geändert.",
);
static MATRIX: Template = Template::new(
    "executed",
    "{name}: x' = {a} · x + {c} · y + {e} and y' = {b} · x + {d} · y + {f} from now on.",
    "{name}: Ab jetzt gilt x' = {a} · x + {c} · y + {e} und y' = {b} · x + {d} · y + {f}.",
);
static PUSHED: Template = Template::new(
    "executed",
    "{name}: a copy of the model-view matrix goes onto its stack, which holds {kept} now.",
    "{name}: Eine Kopie der Model-View-Matrix kommt auf ihren Stapel, der jetzt {kept} enthält.",
);
static POPPED: Template = Template::new(
    "executed",
    "{name}: the matrix on top of the stack becomes the model-view matrix again, its origin is at {origin}; {kept} are left.",
    "{name}: Die oberste Matrix des Stapels wird wieder zur Model-View-Matrix, ihr Ursprung liegt bei {origin}; {kept} bleiben.",
);
static STATE: Template = Template::new(
    "executed",
    "{name}: the state has a new value, which stays until another one is set.",
    "{name}: Der Zustand hat einen neuen Wert, der bleibt, bis ein anderer gesetzt wird.",
);
static DRAWN: Template = Template::new(
    "executed",
    "{name}: {vertices} vertices go through the matrix; {pixels} pixels get another colour.",
    "{name}: {vertices} Ecken gehen durch die Matrix; {pixels} Pixel bekommen eine andere Farbe.",
);

static CLEARED: Template = Template::new(
    "executed",
    "{name}: {pixels} pixels get the colour of the background.",
    "{name}: {pixels} Pixel bekommen die Farbe des Hintergrunds.",
);

/// Columns and rows of the framebuffer.
const SIZE: [u32; 2] = [37, 24];

/// Colours of the commands.
const BLUE: Vec4 = Vec4::new(0.0, 0.2, 0.6, 1.0);
const RED: Vec4 = Vec4::new(0.7, 0.1, 0.0, 1.0);
const WHITE: Vec4 = Vec4::ONE;

/// Returns the ring as a closed line.
fn outline(ring: &[DVec2]) -> Command {
    let closed = ring.iter().chain(ring.first());
    Command::Draw(Primitive::LineStrip, closed.map(|p| CornerVertex::from(p.extend(0.0))).collect())
}

fn moved(by: DVec2) -> Command {
    Command::MultiplyModelView(DMat4::from_translation(by.extend(0.0)))
}

/// Records the lists of an input and executes them; an error of theirs ends the run as it ends a program.
fn run(figure: &Figure, view: DMat4, step: DVec2, t: &mut impl Tracer<Step>) -> Result<()> {
    let Some((part, body)) = figure.rings.split_first() else {
        return Err(Error::parameter("input", "without a ring", TAKES.en));
    };
    let mut lists = DisplayLists::default();
    let mut main = vec![clear(), Command::LoadProjection(view)];
    if figure.points.is_empty() {
        let list = lists.record(Vec::new());
        let turn = DMat4::from_rotation_z(0.6) * DMat4::from_scale(DVec3::splat(0.9));
        let commands = vec![outline(part), Command::MultiplyModelView(turn), Command::Call(list)];
        lists.replace(list, commands.clone())?;
        t.step(|| Step::Recorded { list, commands });
        main.extend([Command::Color(BLUE), Command::Call(list)]);
    } else {
        let wheel = lists.record_traced(vec![Command::Color(RED), outline(part)], t);
        let mut car = vec![Command::Color(BLUE)];
        car.extend(body.iter().map(|ring| outline(ring)));
        for &place in &figure.points {
            car.extend([Command::PushModelView, moved(place)]);
            car.extend([Command::Call(wheel), Command::PopModelView]);
        }
        let car = lists.record_traced(car, t);
        main.extend([Command::Call(car), moved(step), Command::Call(car)]);
    }
    let mut target = Framebuffer::new(SIZE[0], SIZE[1]);
    match execute_traced(&main, &lists, &mut Pipeline::default(), &mut target, t) {
        // The last step says so.
        Err(Error::Limit { .. }) => Ok(()),
        result => result,
    }
}

fn clear() -> Command {
    Command::Clear { color: Some(WHITE), depth: None, stencil: None, index: None }
}

/// The framebuffer and the state after the steps so far.
#[derive(Clone)]
struct State {
    view: DMat4,
    pipeline: Pipeline,
    target: Framebuffer,
    /// Lists that have begun and not ended.
    calls: Vec<ListId>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let rings = figure.rings.iter().flatten();
    // Cars side by side; a part that calls itself turns around the origin.
    let (step, seen) = if figure.points.is_empty() {
        let reach = DVec2::splat(rings.map(|p| p.length()).fold(0.0, f64::max));
        (DVec2::ZERO, [-reach, reach])
    } else {
        let part = figure.rings.first().map_or(&[][..], Vec::as_slice);
        let parts = figure.points.iter().flat_map(|at| part.iter().map(move |p| at + p));
        let all = rings.skip(part.len()).copied().chain(parts);
        let [low, high] = Rect::around(all)
            .map_or([DVec2::ZERO, DVec2::ONE], |around| [around.min(), around.max()]);
        let step = DVec2::new((high.x - low.x) * 1.125, 0.0);
        (step, [low, high + step])
    };
    let view = seen_between(seen);
    let steps = record(cap, |t| run(figure, view, step, t))?;
    let (pipeline, target) = (Pipeline::default(), Framebuffer::new(SIZE[0], SIZE[1]));
    let mut state = State { view, pipeline, target, calls: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Columns left and right of the drawing together, and rows above and below it.
const MARGIN: f64 = 3.0;

/// Returns the projection that shows a part of the plane in the middle of the framebuffer, with a margin.
fn seen_between([low, high]: [DVec2; 2]) -> DMat4 {
    let pixels = DVec2::from(SIZE.map(f64::from));
    let per_pixel = ((high - low) / (pixels - MARGIN)).max_element();
    let per_pixel = if per_pixel > 0.0 { per_pixel } else { 1.0 };
    let scale = 2.0 / (pixels * per_pixel);
    DMat4::from_scale(scale.extend(1.0))
        * DMat4::from_translation(-((low + high) * 0.5).extend(0.0))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture())
    }

    fn take(&mut self, step: &Step) -> Caption {
        let name = |list: ListId| ("list", list.number().into());
        match step {
            Step::Recorded { list, commands } => {
                let names: Vec<_> = commands.iter().map(Command::name).collect();
                RECORDED.with([name(*list), ("commands", names.into())])
            }
            Step::Called { list, depth } => {
                self.calls.push(*list);
                CALLED.with([
                    name(*list),
                    ("depth", (*depth).into()),
                    ("limit", MAX_NESTING.into()),
                ])
            }
            Step::Refused { list, depth } => {
                REFUSED.with([name(*list), ("depth", (*depth).into())])
            }
            Step::Returned { .. } => {
                let ended = self.calls.pop().map_or(Value::from(""), |list| list.number().into());
                RETURNED.with([("list", ended)])
            }
            Step::Executed { command, model_view, kept, .. } => {
                let pixels = self.execute(command);
                executed(command, model_view, *kept, pixels)
            }
        }
    }

    /// Executes a command and returns how many pixels it changed. It cannot fail: it did not when it was recorded.
    fn execute(&mut self, command: &Command) -> usize {
        let before = self.target.color.clone();
        let commands = std::slice::from_ref(command);
        let lists = DisplayLists::default();
        let _ = execute(commands, &lists, &mut self.pipeline, &mut self.target);
        let both = before.data().iter().zip(self.target.color.data());
        both.filter(|(before, after)| before != after).count()
    }

    fn table(&self) -> Table {
        let mut table = Table::new([NO_HEAD, VALUE]);
        let current = self
            .calls
            .last()
            .map_or(Word::new("none", "keine").into(), |list| Value::from(list.number()));
        table.row(Word::new("current list", "aktuelle Liste"), [current]);
        table.row(Word::new("lists in each other", "Listen ineinander"), [self.calls.len().into()]);
        let color = self.pipeline.color.truncate().as_dvec3();
        table.row(Word::new("colour", "Farbe"), [color.into()]);
        let matrix = self.pipeline.model_view;
        let [x, y, origin] = [0, 1, 3].map(|k| Value::from(matrix.col(k).truncate().truncate()));
        table.row(Word::new("x axis", "x-Achse"), [x]);
        table.row(Word::new("y axis", "y-Achse"), [y]);
        table.row(Word::new("origin", "Ursprung"), [origin]);
        let kept = self.pipeline.stack.iter().enumerate().rev().take(SHOWN);
        for (k, matrix) in kept {
            let origin = Value::from(matrix.w_axis.truncate().truncate());
            table.row(Value::List(vec![STACK.into(), (k + 1).into()]), [origin]);
        }
        table
    }

    /// Draws the pixels, and the axes of the model-view matrix.
    fn picture(&self) -> Picture {
        let [columns, rows] = SIZE;
        let mut picture = Picture::pixels(columns, rows);
        picture.picture_from_input = None;
        for y in 0..rows {
            for x in 0..columns {
                let color = self.target.color.get(x, y).unwrap_or_default();
                if let [r, g, b, 255] = color
                    && [r, g, b] != [255; 3]
                {
                    picture.colored([x as i32, y as i32], [r, g, b], "");
                }
            }
        }
        let size = DVec2::from(SIZE.map(f64::from));
        let full = self.view * self.pipeline.model_view;
        let at = |p: DVec3| {
            let ndc = full.project_point3(p).truncate();
            let at = (DVec2::new(ndc.x, -ndc.y) + 1.0) * 0.5 * size;
            if at.is_finite() { at.clamp(-size, size * 2.0) } else { DVec2::ZERO }
        };
        let origin = at(DVec3::ZERO);
        for axis in [DVec3::X, DVec3::Y] {
            let way = at(axis) - origin;
            // As long as a unit, but at least four pixels.
            let long = way * (4.0 / way.length().max(1e-9)).max(1.0);
            let look = if axis == DVec3::X { Look::First } else { Look::Second };
            picture.arrow(origin, (origin + long).clamp(-size, size * 2.0), look);
        }
        let inside = origin.clamp(DVec2::ZERO, size);
        picture.dot(inside, Look::Now);
        picture
    }
}

/// Returns the caption of an executed command.
fn executed(command: &Command, model_view: &DMat4, kept: usize, pixels: usize) -> Caption {
    let name = ("name", command.name().into());
    let [x, y, origin] = [0, 1, 3].map(|k| model_view.col(k).truncate().truncate());
    match command {
        Command::LoadModelView(_) | Command::MultiplyModelView(_) => MATRIX.with([
            name,
            ("a", x.x.into()),
            ("b", x.y.into()),
            ("c", y.x.into()),
            ("d", y.y.into()),
            ("e", origin.x.into()),
            ("f", origin.y.into()),
        ]),
        Command::PushModelView => PUSHED.with([name, ("kept", kept.into())]),
        Command::PopModelView => {
            POPPED.with([name, ("origin", origin.into()), ("kept", kept.into())])
        }
        Command::Draw(_, vertices) => {
            DRAWN.with([name, ("vertices", vertices.len().into()), ("pixels", pixels.into())])
        }
        Command::Clear { .. } => CLEARED.with([name, ("pixels", pixels.into())]),
        _ => STATE.with([name]),
    }
}

/// The most matrices of the stack that the table shows.
const SHOWN: usize = 4;

const VALUE: Word = Word::new("value", "Wert");
const STACK: Word = Word::new("stack", "Stapel");
