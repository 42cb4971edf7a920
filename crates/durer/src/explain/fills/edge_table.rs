//! The lesson of the edge table and the active edge table.

use super::{EXAMPLES, Filling, TAKES, X, add_row, on_row};
use crate::Result;
use crate::curve::Contours;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::{NO_HEAD, letter};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::raster::polygon::edge_table::{INFO, Step, TableEdge, fill};
use crate::trace::{PseudocodeLine, Recorder};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&TABLE, &ENTER, &ACTIVE, &SPAN, &LEAVE],
    unreached: &[],
    make,
};

static TABLE: Template = Template::new(
    "table",
    "Edge {edge} begins in row {row}: it goes into that row's bucket of the edge table, with y_max = {end}.",
    "Kante {edge} beginnt in Zeile {row} und kommt in deren Fach der Kantentabelle, mit y_max = {end}.",
);
static ENTER: Template = Template::new(
    "enter",
    "Row {row}: edge {edge} enters the active edge table at x = {x}.",
    "Zeile {row}: Kante {edge} kommt mit x = {x} in die Tabelle der aktiven Kanten.",
);
static ACTIVE: Template = Template::new(
    "active",
    "Row {row}: edge {edge} is number {place} by x: it crosses at {at}, so pixels from {x} on are right of it.",
    "Zeile {row}: Kante {edge} ist nach x die {place}.: Sie schneidet bei {at}, ab Pixel {x} liegt man rechts.",
);
static SPAN: Template = Template::new(
    "span",
    "Row {row}: between two edges that make a pair pixels {first} to {last} are filled.",
    "Zeile {row}: Zwischen zwei Kanten, die ein Paar bilden, werden die Pixel {first} bis {last} gefüllt.",
);
static LEAVE: Template = Template::new(
    "leave",
    "Edges with y_max = {row} leave, {count} {count|stays; its|stay; their} x grows by Δx/Δy for row {row}.",
    "Kanten mit y_max = {row} gehen, {count} {count|bleibt|bleiben}; deren x wächst für Zeile {row} um Δx/Δy.",
);

/// The two tables.
#[derive(Clone)]
struct State {
    filling: Filling,
    /// All edges, in the order of the edge table; those that wait are the last ones.
    edges: Vec<TableEdge>,
    entered: usize,
    active: Vec<(usize, TableEdge)>,
    row: i32,
    /// Entries of the active edge table that have come for this row.
    entries: usize,
}

fn make(_: &Lesson, input: &Input, options: &Options, cap: usize) -> Result<Frames> {
    let how = Filling::options(options)?;
    by_rows(input, cap, |contours, [columns, rows], t| {
        fill(contours, columns, rows, &how, |_| {}, t);
    })
}

/// Makes the frames of a program that fills contours row by row by the two tables.
pub(in crate::explain) fn by_rows(
    input: &Input,
    cap: usize,
    program: impl FnOnce(&Contours, [u32; 2], &mut Recorder<Step>),
) -> Result<Frames> {
    let filling = Filling::new(input)?;
    let contours = filling.contours();
    let size = [filling.raster.columns, filling.raster.rows];
    let steps = record(cap, |t| {
        program(&contours, size, t);
        Ok(())
    })?;
    let edges = Vec::new();
    let mut state = State { filling, edges, entered: 0, active: Vec::new(), row: -1, entries: 0 };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Table(edge) => {
                self.edges.push(edge);
                let name = letter(self.edges.len() - 1);
                let (row, end) = edge.rows;
                TABLE.with([("edge", name.into()), ("row", row.into()), ("end", end.into())])
            }
            Step::Enter { y, x } => {
                let number = self.entered;
                self.entered += 1;
                self.active.extend(self.edges.get(number).map(|&edge| (number, edge)));
                ENTER.with([("row", y.into()), ("edge", letter(number).into()), ("x", x.into())])
            }
            Step::Active { y, edge } => self.take_active(y, edge),
            Step::Span(span) => {
                self.filling.spans.push(span);
                let ends = [("first", span.x0.into()), ("last", (span.x1 - 1).into())];
                let [first, last] = ends;
                SPAN.with([("row", span.y.into()), first, last])
            }
            Step::Leave { y, active } => {
                self.active.retain(|(_, edge)| edge.rows.1 > y);
                self.active.iter_mut().for_each(|(_, edge)| edge.advance());
                LEAVE.with([("row", y.into()), ("count", active.into())])
            }
        }
    }

    /// Puts an entry of the row in its place.
    fn take_active(&mut self, y: i32, edge: TableEdge) -> Caption {
        self.entries = if y == self.row { self.entries + 1 } else { 1 };
        self.row = y;
        let place = self.entries - 1;
        // A faulty program may report entries that another row has, or no row.
        let rest = || self.active.iter().skip(place).map(|(_, other)| other);
        let found = rest().position(|other| *other == edge);
        let found = found.or_else(|| rest().position(|other| is_same(other, &edge)));
        let number = match found.map(|k| place + k) {
            Some(found) => Some(self.active.remove(found).0),
            None => self.edges.iter().position(|other| is_same(other, &edge)),
        };
        if let Some(number) = number {
            self.active.insert(place.min(self.active.len()), (number, edge));
        }
        let name = self.active.get(place).map(|(number, _)| letter(*number)).unwrap_or_default();
        ACTIVE.with([
            ("row", y.into()),
            ("edge", name.into()),
            ("place", self.entries.into()),
            ("at", (edge.crossing() + 0.5).into()),
            ("x", edge.x.into()),
        ])
    }

    fn table(&self) -> Table {
        let heads = [("y_max", "y_max"), ("Δx/Δy", "Δx/Δy"), ("acc", "acc")];
        let [end, slope, rest] = heads.map(|(en, de)| Word::new(en, de));
        let mut table = Table::new([NO_HEAD, end, X, slope, rest]);
        for (number, edge) in self.edges.iter().enumerate().skip(self.entered) {
            table.row(format!("ET {}: {}", edge.rows.0, letter(number)), cells(edge));
        }
        for (number, edge) in &self.active {
            table.row(format!("AET {}", letter(*number)), cells(edge));
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.filling.picture(matches!(step, Step::Span(_)));
        let row = match *step {
            Step::Table(edge) => edge.rows.0,
            Step::Enter { y, .. } | Step::Active { y, .. } | Step::Leave { y, .. } => y,
            Step::Span(span) => span.y,
        };
        add_row(&mut picture, row);
        for (number, edge) in self.active.iter().filter(|(_, edge)| edge.rows.1 > row) {
            picture.named(on_row(edge.crossing() + 0.5, row), letter(*number), Look::Second);
        }
        match *step {
            Step::Table(edge) => {
                // The edge from its first row to its last one.
                let at = on_row(edge.crossing() + 0.5, row);
                let rows = f64::from(edge.rows.1 - 1 - edge.rows.0);
                picture.chain([at, at + DVec2::new(slope(&edge), 1.0) * rows], Look::Now);
                picture.dot(at, Look::Now);
                picture.label(at, (10.0, -9.0), letter(self.edges.len() - 1));
            }
            Step::Active { edge, .. } => picture.dot(on_row(edge.crossing() + 0.5, row), Look::Now),
            Step::Enter { .. } => {
                let last = self.active.last().map(|(_, edge)| edge.crossing() + 0.5);
                last.into_iter().for_each(|x| picture.dot(on_row(x, row), Look::Now));
            }
            Step::Span(_) | Step::Leave { .. } => {}
        }
        picture
    }
}

/// Returns whether two entries are of one edge, in whatever row.
fn is_same(a: &TableEdge, b: &TableEdge) -> bool {
    let fixed = |e: &TableEdge| (e.rows, e.step, e.remainder, e.whole, e.winding);
    fixed(a) == fixed(b)
}

/// Returns y_max, x, Δx/Δy and the accumulator of an edge, the last two in parts of a pixel.
fn cells(edge: &TableEdge) -> [Value; 4] {
    let part = edge.error as f64 / edge.whole as f64;
    [edge.rows.1.into(), edge.x.into(), slope(edge).into(), part.into()]
}

/// Returns the change of an edge's x from row to row.
fn slope(edge: &TableEdge) -> f64 {
    edge.step as f64 + edge.remainder as f64 / edge.whole as f64
}
