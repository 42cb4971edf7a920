//! The lesson of windows and viewports.

use super::frame::{Frames, record};
use super::input::{Figure, Input, Options};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::Result;
use crate::math::{DAffine2, DVec2, Rect};
use crate::trace::PseudocodeLine;
use crate::view::mapping::{self, INFO, Step, map};
use crate::view::window::{PixelRect, Viewport, Window, YAxis};

pub(super) const LESSONS: &[Lesson] = &[MAPPING, super::screens::LESSON];

const MAPPING: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "lecture",
            title: Word::new(
                "W = (0, 4, 0, 2), V = (100, 300, 50, 250): (1, 1) becomes (150, 150)",
                "W = (0, 4, 0, 2), V = (100, 300, 50, 250): aus (1; 1) wird (150; 150)",
            ),
            input: || house((0.0, 0.0), (4.0, 2.0)),
        },
        Example {
            name: "zoomed",
            title: Word::new(
                "a smaller window shows things larger",
                "ein kleineres Fenster zeigt alles größer",
            ),
            input: || house((1.0, 0.0), (3.0, 1.0)),
        },
        Example::new(
            "square",
            "a square window in a square viewport: shapes stay",
            "ein quadratisches Fenster im quadratischen Viewport: Formen bleiben",
            || house((0.5, -0.5), (3.5, 2.5)),
        ),
        Example::new(
            "wide",
            "a larger window shows things smaller",
            "ein größeres Fenster zeigt alles kleiner",
            || house((-3.0, -2.0), (7.0, 4.0)),
        ),
        Example::new(
            "tall",
            "a tall window in the same viewport: everything gets wider",
            "ein hohes Fenster im selben Viewport: Alles wird breiter",
            || house((0.8, -2.0), (3.2, 4.0)),
        ),
        Example::new(
            "corners",
            "the corners of the window become those of the viewport",
            "aus den Ecken des Fensters werden die des Viewports",
            || {
                let window = Rect::new(DVec2::new(-2.0, -1.0), DVec2::new(2.0, 3.0)).ok();
                let points = [(-2.0, -1.0), (2.0, -1.0), (2.0, 3.0), (-2.0, 3.0), (0.0, 1.0)];
                let points = points.map(DVec2::from).to_vec();
                Input::Figure(Figure { window, points, ..Figure::default() })
            },
        ),
    ],
    templates: &[&COLUMNS, &ROWS, &POINT],
    unreached: &[],
    make,
};

const TAKES: Word =
    Word::new("a window with lines or points", "ein Fenster mit Linien oder Punkten");

fn house(low: (f64, f64), high: (f64, f64)) -> Input {
    let outline = [(1.0, 1.0), (1.0, 0.5), (3.0, 0.5), (3.0, 1.0), (2.0, 1.6), (1.0, 1.0)];
    let lines = vec![outline.map(DVec2::from).to_vec()];
    Input::Figure(Figure {
        window: Rect::new(low.into(), high.into()).ok(),
        lines,
        ..Figure::default()
    })
}

static COLUMNS: Template = Template::new(
    "columns",
    "a = ({v1} − {v0}) / ({w1} − {w0}) = {a} and b = {v0} − a · {w0} = {b}.",
    "a = ({v1} − {v0}) / ({w1} − {w0}) = {a} und b = {v0} − a · {w0} = {b}.",
);
static ROWS: Template = Template::new(
    "rows",
    "c = ({v1} − {v0}) / ({w1} − {w0}) = {c} and d = {v0} − c · {w0} = {d}.",
    "c = ({v1} − {v0}) / ({w1} − {w0}) = {c} und d = {v0} − c · {w0} = {d}.",
);
static POINT: Template = Template::new(
    "point",
    "{from}: x' = {a} · {x} + {b} = {u}, y' = {c} · {y} + {d} = {v}.",
    "{from}: x' = {a} · {x} + {b} = {u} und y' = {c} · {y} + {d} = {v}.",
);

/// Columns and rows of the lecture's viewport.
const VIEWPORT: [i32; 4] = [100, 50, 300, 250];

#[derive(Clone)]
struct State {
    figure: Figure,
    window: Rect,
    coefficients: [f64; 4],
    done: Vec<[DVec2; 2]>,
}

fn make(_: &Lesson, input: &Input, _: &Options, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?.clone();
    let rect = figure.window(TAKES)?;
    let window = Window::new(rect.min().x, rect.max().x, rect.min().y, rect.max().y)?;
    let [x0, y0, x1, y1] = VIEWPORT;
    let viewport = Viewport::new(PixelRect::new(x0, y0, x1, y1)?)?;
    let points: Vec<DVec2> = figure.lines.iter().flatten().chain(&figure.points).copied().collect();
    let options = mapping::Options { y_axis: YAxis::Up, ..Default::default() };
    let steps = record(cap, |t| Ok(map(&window, &viewport, &points, &options, t)))?;
    let mut state = State { figure, window: rect, coefficients: [0.0; 4], done: Vec::new() };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture())
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        let (low, high) = (self.window.min(), self.window.max());
        let [x0, y0, x1, y1] = VIEWPORT.map(Value::from);
        match *step {
            Step::Columns { a, b } => {
                (self.coefficients[0], self.coefficients[1]) = (a, b);
                let world = [("w0", low.x.into()), ("w1", high.x.into())];
                let [w0, w1] = world;
                COLUMNS.with([("v0", x0), ("v1", x1), w0, w1, ("a", a.into()), ("b", b.into())])
            }
            Step::Rows { c, d } => {
                (self.coefficients[2], self.coefficients[3]) = (c, d);
                let world = [("w0", low.y.into()), ("w1", high.y.into())];
                let [w0, w1] = world;
                ROWS.with([("v0", y0), ("v1", y1), w0, w1, ("c", c.into()), ("d", d.into())])
            }
            Step::Point { from, to } => {
                self.done.push([from, to]);
                let [a, b, c, d] = self.coefficients.map(Value::from);
                POINT.with([
                    ("from", from.into()),
                    ("a", a),
                    ("x", from.x.into()),
                    ("b", b),
                    ("u", to.x.into()),
                    ("c", c),
                    ("y", from.y.into()),
                    ("d", d),
                    ("v", to.y.into()),
                ])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::default();
        for (name, x) in ["a", "b", "c", "d"].into_iter().zip(self.coefficients) {
            table.row(name, [x.into()]);
        }
        for (i, &[from, to]) in self.done.iter().enumerate() {
            table.row(i + 1, [from.into(), to.into()]);
        }
        table
    }

    /// Draws the world on the left and the screen on the right, both as large.
    fn picture(&self) -> Picture {
        let mut picture = Picture::new([DVec2::new(-0.1, -0.35), DVec2::new(2.4, 1.15)]);
        let (low, size) = (self.window.min(), self.window.size());
        picture.picture_from_input =
            Some(DAffine2::from_scale(1.0 / size) * DAffine2::from_translation(-low));
        let world = |p: DVec2| (p - low) / size;
        let [x0, y0, x1, y1] = VIEWPORT.map(f64::from);
        let screen = |p: DVec2| {
            (p - DVec2::new(x0, y0)) / DVec2::new(x1 - x0, y1 - y0) + DVec2::new(1.3, 0.0)
        };
        let unit = |x: f64| {
            [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0), (x, 0.0)].map(DVec2::from)
        };
        picture.chain(unit(0.0), Look::Window);
        picture.chain(unit(1.3), Look::Window);
        for (x, low, high) in
            [(0.0, low, self.window.max()), (1.3, DVec2::new(x0, y0), DVec2::new(x1, y1))]
        {
            picture.label(DVec2::new(x + 0.12, -0.1), (0.0, 0.0), low);
            picture.label(DVec2::new(x + 0.8, -0.22), (0.0, 0.0), high);
        }
        picture.label(DVec2::new(0.5, 1.08), (0.0, 0.0), Word::new("window", "Fenster"));
        picture.label(DVec2::new(1.8, 1.08), (0.0, 0.0), Word::new("viewport", "Viewport"));
        for line in &self.figure.lines {
            let line: Vec<DVec2> = line.iter().map(|&p| world(p)).collect();
            picture.chain(line, Look::First);
        }
        let mapped: Vec<DVec2> = self.done.iter().map(|&[_, to]| screen(to)).collect();
        picture.chain(mapped, Look::Second);
        if let Some(&[from, to]) = self.done.last() {
            picture.arrow(world(from), screen(to), Look::Dashed);
            picture.dot(world(from), Look::Now);
            picture.dot(screen(to), Look::Now);
        }
        picture
    }
}
