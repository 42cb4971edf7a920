//! The lesson of the simple ordered edge list.

use super::{EXAMPLES, Filling, ROW, TAKES, X, add_row, on_row};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::{Input, Options};
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::raster::polygon::ordered_edge_list::{INFO, Step, fill};
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&CROSSING, &SPAN],
    unreached: &[],
    make,
};

static CROSSING: Template = Template::new(
    "crossing",
    "An edge that goes {way} crosses row {row}: pixels from {x} on lie right of it; (row, x) goes into the list.",
    "Eine Kante {way} schneidet Zeile {row}: Ab Pixel {x} liegt man rechts davon; (Zeile, x) kommt in die Liste.",
);
static SPAN: Template = Template::new(
    "span",
    "Row {row} of the sorted list: pixels {first} to {last} lie between two entries, inside by the rule.",
    "Zeile {row} der sortierten Liste: Die Pixel {first} bis {last} liegen zwischen zwei Einträgen, nach der Regel innen.",
);

const UP: Word = Word::new("up", "hinauf");
const DOWN: Word = Word::new("down", "hinab");

/// Entries of the list: row, x, and change of the winding number.
type Entry = (i32, i32, i32);

fn make(_: &Lesson, input: &Input, options: &Options, cap: usize) -> Result<Frames> {
    let mut filling = Filling::new(input)?;
    let (contours, how) = (filling.contours(), Filling::options(options)?);
    let (columns, rows) = (filling.raster.columns, filling.raster.rows);
    let steps = record(cap, |t| {
        fill(&contours, columns, rows, &how, |_| {}, t);
        Ok(())
    })?;
    let mut list: Vec<Entry> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let caption = take(step, &mut list, &mut filling);
        want.shown(step.line(), caption, || table(&list), || picture(step, &list, &filling))
    }))
}

fn take(step: &Step, list: &mut Vec<Entry>, filling: &mut Filling) -> Caption {
    match *step {
        Step::Crossing { y, x, winding } => {
            list.push((y, x, winding));
            let way = if winding > 0 { UP } else { DOWN };
            CROSSING.with([("way", way.into()), ("row", y.into()), ("x", x.into())])
        }
        Step::Span(span) => {
            list.sort_unstable();
            filling.spans.push(span);
            let [first, last] = [span.x0, span.x1 - 1].map(Value::from);
            SPAN.with([("row", span.y.into()), ("first", first), ("last", last)])
        }
    }
}

fn table(list: &[Entry]) -> Table {
    let mut rows: Vec<i32> = list.iter().map(|entry| entry.0).collect();
    rows.sort_unstable();
    rows.dedup();
    let mut table = Table::new([ROW, X]);
    for y in rows {
        let of_row = list.iter().filter(|entry| entry.0 == y).map(|entry| entry.1);
        table.row(y, [Value::from(of_row.collect::<Vec<i32>>())]);
    }
    table
}

fn picture(step: &Step, list: &[Entry], filling: &Filling) -> Picture {
    let mut picture = filling.picture(matches!(step, Step::Span(_)));
    let row = match *step {
        Step::Crossing { y, .. } => y,
        Step::Span(span) => span.y,
    };
    add_row(&mut picture, row);
    for &(y, x, _) in list {
        picture.dot(on_row(x.into(), y), if y == row { Look::Second } else { Look::Pale });
    }
    if let Step::Crossing { y, x, .. } = *step {
        picture.dot(on_row(x.into(), y), Look::Now);
    }
    picture
}
