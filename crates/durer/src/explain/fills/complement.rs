//! The lessons of fills by complements: edge fill, fence fill, edge flags.

use super::{EXAMPLES, Filling, ROW, TAKES, X, add_row, on_row};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::raster::polygon::{edge_fill, edge_flag};
use crate::target::Pixels;
use crate::trace::PseudocodeLine;

pub(super) const EDGE_FILL: Lesson = Lesson {
    name: edge_fill::INFO.name,
    info: &edge_fill::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&COMPLEMENT],
    unreached: &[],
    make: |_, input, _, cap| complements(input, false, cap),
};

pub(super) const FENCE_FILL: Lesson = Lesson {
    name: edge_fill::FENCE.name,
    info: &edge_fill::FENCE,
    make: |_, input, _, cap| complements(input, true, cap),
    ..EDGE_FILL
};

pub(super) const EDGE_FLAG: Lesson = Lesson {
    name: edge_flag::INFO.name,
    info: &edge_flag::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&SET, &CLEARED, &INSIDE],
    unreached: &[],
    make: |_, input, _, cap| flags(input, cap),
};

static COMPLEMENT: Template = Template::new(
    "complement",
    "Row {row}: the pixels from {first} on, {count} of them, are complemented.",
    "Zeile {row}: Die Pixel ab {first}, {count} Stück, werden umgekehrt.",
);
static SET: Template = Template::new(
    "flag",
    "An edge crosses row {row} before pixel {x}: its flag is set.",
    "Eine Kante schneidet Zeile {row} vor Pixel {x}: Die Marke wird gesetzt.",
);
static CLEARED: Template = Template::new(
    "flag",
    "Another edge crosses row {row} before pixel {x}: its flag is cleared again.",
    "Noch eine Kante schneidet Zeile {row} vor Pixel {x}: Die Marke wird wieder gelöscht.",
);
static INSIDE: Template = Template::new(
    "inside",
    "Row {row}: from the flag at {first} to the next one, pixels up to {last} are inside.",
    "Zeile {row}: Von der Marke bei {first} bis zur nächsten sind die Pixel bis {last} innen.",
);

/// The pixels of a lesson, and how often they were touched.
#[derive(Clone)]
struct Plane {
    filling: Filling,
    pixels: Pixels<bool>,
    touched: usize,
}

impl Plane {
    fn new(input: &Input) -> Result<Self> {
        let filling = Filling::new(input)?;
        let pixels = Pixels::new(filling.raster.columns, filling.raster.rows, false);
        Ok(Self { filling, pixels, touched: 0 })
    }

    /// Draws the set pixels, and a row.
    fn picture(&self, row: i32) -> Picture {
        let mut picture = self.filling.picture(false);
        for y in 0..self.pixels.height() {
            for (x, _) in (0..).zip(self.pixels.row(y)).filter(|(_, set)| **set) {
                picture.cell([x, y as i32], "", Look::First);
            }
        }
        add_row(&mut picture, row);
        picture
    }
}

fn complements(input: &Input, fenced: bool, cap: usize) -> Result<Frames> {
    let mut plane = Plane::new(input)?;
    let contours = plane.filling.contours();
    let fence = fenced.then_some(plane.pixels.width() / 2);
    let options = edge_fill::Options { fence };
    let mut work = plane.pixels.clone();
    let steps = record(cap, |t| {
        edge_fill::fill(&contours, &mut work, &options, t);
        Ok(())
    })?;
    Ok(Frames::new(steps, move |step, want| {
        let columns = step.columns();
        for x in columns.clone() {
            let set = plane.pixels.get(x, step.y).unwrap_or(false);
            plane.pixels.set(x, step.y, !set);
        }
        plane.touched += columns.len();
        let values = [
            ("row", step.y.into()),
            ("first", columns.start.into()),
            ("count", columns.len().into()),
        ];
        let picture = || {
            let mut picture = plane.picture(step.y as i32);
            picture.dot(on_row(step.x.into(), step.y as i32), Look::Now);
            if fenced {
                let [low, high] = picture.extent;
                let x = f64::from(step.fence);
                let ends = [low.y, high.y].map(|y| crate::math::DVec2::new(x, y));
                picture.chain(ends, Look::Window);
            }
            picture
        };
        let table = || {
            let mut table = Table::new([ROW, X, Word::new("touched", "berührt")]);
            let cells: [Value; 3] = [step.y.into(), step.x.into(), plane.touched.into()];
            table.row("", cells);
            table
        };
        // Without a fence inside the polygon all crossings are left of it.
        let line = if fenced { step.line() } else { 6 };
        want.shown(line, COMPLEMENT.with(values), table, picture)
    }))
}

fn flags(input: &Input, cap: usize) -> Result<Frames> {
    use edge_flag::Step;
    let mut plane = Plane::new(input)?;
    let contours = plane.filling.contours();
    let mut work = plane.pixels.clone();
    let steps = record(cap, |t| {
        edge_flag::fill(&contours, &mut work, t);
        Ok(())
    })?;
    let mut marks: Vec<[u32; 2]> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let (caption, row): (Caption, i32) = match *step {
            Step::Flag { pixel: pixel @ [x, y], set } => {
                if set {
                    marks.push(pixel);
                } else {
                    marks.retain(|mark| *mark != pixel);
                }
                let template = if set { &SET } else { &CLEARED };
                (template.with([("row", y.into()), ("x", x.into())]), y as i32)
            }
            Step::Inside(span) => {
                for x in span.x0..span.x1 {
                    plane.pixels.set(x as u32, span.y as u32, true);
                }
                let [row, first, last] = [span.y, span.x0, span.x1 - 1].map(Value::from);
                (INSIDE.with([("row", row), ("first", first), ("last", last)]), span.y)
            }
        };
        let picture = || {
            let mut picture = plane.picture(row);
            for &[x, y] in &marks {
                let look = if y as i32 == row { Look::Now } else { Look::Second };
                picture.dot(on_row(x.into(), y as i32), look);
            }
            picture
        };
        want.shown(step.line(), caption, || table(&marks), picture)
    }))
}

/// Returns the flags of each row.
fn table(marks: &[[u32; 2]]) -> Table {
    let mut rows: Vec<u32> = marks.iter().map(|mark| mark[1]).collect();
    rows.sort_unstable();
    rows.dedup();
    let mut table = Table::new([ROW, X]);
    for y in rows {
        let mut of_row: Vec<i32> =
            marks.iter().filter(|mark| mark[1] == y).map(|mark| mark[0] as i32).collect();
        of_row.sort_unstable();
        table.row(y, [Value::from(of_row)]);
    }
    table
}
