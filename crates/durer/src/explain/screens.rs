//! The lesson of several viewports on one screen: one window in all of them.

use super::frame::{Frames, record};
use super::grid::{NO_HEAD, letter};
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Word};
use crate::clip::line::{LineClipper, Segment};
use crate::math::{DVec2, Rect};
use crate::trace::PseudocodeLine;
use crate::view::layout::{INFO, Layout, Step};
use crate::view::window::{Aspect, PixelRect, Viewport, Window, WindowToViewport, YAxis};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "five",
            title: Word::new(
                "five viewports: the last row has two",
                "fünf Viewports: die letzte Zeile hat zwei",
            ),
            input: || house(5),
        },
        Example {
            name: "two",
            title: Word::new("two viewports side by side", "zwei Viewports nebeneinander"),
            input: || house(2),
        },
        Example::new(
            "one",
            "one viewport: the whole screen",
            "ein Viewport: der ganze Schirm",
            || house(1),
        ),
        Example::new(
            "four",
            "four viewports: 37 and 23 pixels are odd",
            "vier Viewports: 37 und 23 Pixel sind ungerade",
            || house(4),
        ),
        Example::new(
            "seven",
            "seven viewports: one alone in the last row",
            "sieben Viewports: einer allein in der letzten Zeile",
            || house(7),
        ),
        Example::new(
            "twelve",
            "twelve viewports: differences of one pixel",
            "zwölf Viewports: Unterschiede von einem Pixel",
            || house(12),
        ),
    ],
    templates: &[&ROW, &CELL],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "a window with lines, and a point for each viewport that is to show them",
    "ein Fenster mit Linien, und ein Punkt für jeden Viewport, der sie zeigen soll",
);

fn house(viewports: usize) -> Input {
    let outline = [(1.0, 1.0), (1.0, 0.2), (3.0, 0.2), (3.0, 1.0), (2.0, 1.8), (1.0, 1.0)];
    Input::Figure(Figure {
        window: Rect::new(DVec2::ZERO, DVec2::new(4.0, 2.0)).ok(),
        lines: vec![outline.map(DVec2::from).to_vec()],
        points: vec![DVec2::ZERO; viewports],
        ..Figure::default()
    })
}

static ROW: Template = Template::new(
    "row",
    "Row {row}: y0 = ⌊{h} · {row} / {rows}⌋ = {y0} and y1 = ⌊{h} · {next} / {rows}⌋ = {y1}; viewports in it: {cells}.",
    "Zeile {row}: y0 = ⌊{h} · {row} / {rows}⌋ = {y0} und y1 = ⌊{h} · {next} / {rows}⌋ = {y1}; Viewports darin: {cells}.",
);
static CELL: Template = Template::new(
    "cell",
    "{name}: x0 = ⌊{w} · {column} / {cells}⌋ = {x0} and x1 = ⌊{w} · {next} / {cells}⌋ = {x1}, so {width} × {height} pixels; the window is mapped onto them.",
    "{name}: x0 = ⌊{w} · {column} / {cells}⌋ = {x0} und x1 = ⌊{w} · {next} / {cells}⌋ = {x1}, also {width} × {height} Pixel; das Fenster wird auf sie abgebildet.",
);

/// Columns and rows of the screen, which neither two nor three divide.
const SCREEN: [u32; 2] = [37, 23];

/// The window with its lines, and the viewports so far.
#[derive(Clone)]
struct State {
    window: Window,
    lines: Vec<Vec<DVec2>>,
    rows: usize,
    /// Viewports in the current row.
    cells: usize,
    done: Vec<PixelRect>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let rect = figure.window(TAKES)?;
    if figure.points.is_empty() {
        return Err(Error::parameter("input", "without a point", TAKES.en));
    }
    let window = Window::new(rect.min().x, rect.max().x, rect.min().y, rect.max().y)?;
    let names: Vec<String> = (0..figure.points.len()).map(letter).collect();
    let layout: Layout = names.join(",").parse()?;
    let steps = record(cap, |t| {
        layout.viewports_traced(SCREEN[0], SCREEN[1], t)?;
        Ok(())
    })?;
    let (lines, rows) = (figure.lines.clone(), layout.rows());
    let mut state = State { window, lines, rows, cells: 0, done: Vec::new() };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        let [w, h] = SCREEN;
        match *step {
            Step::Row { row, y: [y0, y1], cells } => {
                self.cells = cells;
                ROW.with([
                    ("row", row.into()),
                    ("next", (row + 1).into()),
                    ("rows", self.rows.into()),
                    ("h", h.into()),
                    ("y0", y0.into()),
                    ("y1", y1.into()),
                    ("cells", cells.into()),
                ])
            }
            Step::Cell { column, pixels } => {
                self.done.push(pixels);
                CELL.with([
                    ("name", letter(self.done.len() - 1).into()),
                    ("column", column.into()),
                    ("next", (column + 1).into()),
                    ("cells", self.cells.into()),
                    ("w", w.into()),
                    ("x0", pixels.x0().into()),
                    ("x1", pixels.x1().into()),
                    ("width", pixels.width().into()),
                    ("height", pixels.height().into()),
                ])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            NO_HEAD,
            Word::new("x0", "x0"),
            Word::new("y0", "y0"),
            Word::new("x1", "x1"),
            Word::new("y1", "y1"),
        ]);
        for (number, pixels) in self.done.iter().enumerate() {
            let all = [pixels.x0(), pixels.y0(), pixels.x1(), pixels.y1()];
            table.row(letter(number), all.map(Into::into));
        }
        table
    }

    /// Draws the screen with its viewports, and the window's lines in each.
    fn picture(&self, step: &Step) -> Picture {
        let mut picture = Picture::pixels(SCREEN[0], SCREEN[1]);
        picture.picture_from_input = None;
        if let Step::Row { y, .. } = step {
            for y in y.map(f64::from) {
                picture.chain([DVec2::new(0.0, y), DVec2::new(SCREEN[0].into(), y)], Look::Now);
            }
        }
        for (number, pixels) in self.done.iter().enumerate() {
            let [low, high] = [(pixels.x0(), pixels.y0()), (pixels.x1(), pixels.y1())]
                .map(|(x, y)| DVec2::new(x.into(), y.into()));
            let is_last = number + 1 == self.done.len() && matches!(step, Step::Cell { .. });
            if let Ok(frame) = Rect::new(low, high) {
                picture.frame(&frame, if is_last { Look::Now } else { Look::Window });
                let clipped =
                    self.lines.iter().flat_map(|line| clipped(&self.map(pixels), line, &frame));
                clipped.for_each(|ends| picture.chain(ends, Look::First));
            }
            picture.label(low, (9.0, 9.0), letter(number));
        }
        picture
    }

    /// Returns the mapping onto a viewport; `None` for one without pixels.
    fn map(&self, pixels: &PixelRect) -> Option<WindowToViewport> {
        let viewport = Viewport::new(*pixels).ok()?;
        Some(WindowToViewport::new(&self.window, &viewport, Aspect::Fit, YAxis::Down))
    }
}

/// Returns the parts of a line that are in a viewport.
fn clipped(map: &Option<WindowToViewport>, line: &[DVec2], frame: &Rect) -> Vec<[DVec2; 2]> {
    let Some(map) = map else { return Vec::new() };
    let segments = line.windows(2).filter_map(|ends| {
        let [p, q] = [ends[0], ends[1]].map(|p| map.to_screen(p));
        let seen = LineClipper::LiangBarsky.clip(frame, Segment::new(p, q)).ok()??;
        Some([seen.start, seen.end])
    });
    segments.collect()
}
