//! The lesson of evaluators: a patch point by point.

use crate::curve::evaluator::{INFO, Step, patch};
use crate::explain::frame::{Frames, Numbered, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Template, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&ROW, &POINT],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "rows of control points in space, each given as a face",
    "Zeilen aus Kontrollpunkten im Raum, jede als Fläche gegeben",
);

const EXAMPLES: &[Example] = &[
    Example {
        name: "saddle",
        title: Word::new(
            "four points: a hyperbolic paraboloid",
            "vier Punkte: ein hyperbolisches Paraboloid",
        ),
        input: || {
            let rows = [[(0.0, 0.0, 0.0), (4.0, 0.0, 2.0)], [(0.0, 4.0, 2.0), (4.0, 4.0, 0.0)]];
            Input::Faces(rows.map(|row| row.map(DVec3::from).to_vec()).to_vec())
        },
    },
    Example {
        name: "hill",
        title: Word::new("a hill of nine points", "ein Hügel aus neun Punkten"),
        input: || {
            let height = |i: u32, j: u32| if (i, j) == (1, 1) { 6.0 } else { 0.0 };
            let row = |j: u32| {
                let point = |i: u32| DVec3::new(f64::from(i * 2), f64::from(j * 2), height(i, j));
                (0..3).map(point).collect()
            };
            Input::Faces((0..3).map(row).collect())
        },
    },
    Example::new(
        "flat",
        "an even grid: the patch is a plane, its points evenly spaced",
        "ein gleichmäßiges Gitter: eine Ebene mit gleichmäßigen Punkten",
        || patch_of(3, 3, |i, j| (2.0 * i, 2.0 * j, 0.0)),
    ),
    Example::new(
        "vault",
        "rows of a vault: curved across, straight along",
        "Zeilen eines Gewölbes: quer gekrümmt, längs gerade",
        || patch_of(3, 2, |i, j| (2.0 * i, 4.0 * j, if i == 1.0 { 4.0 } else { 0.0 })),
    ),
    Example::new(
        "pinched",
        "a row that is one point: the patch has a tip",
        "eine Zeile, die ein Punkt ist: Die Fläche hat eine Spitze",
        || patch_of(3, 2, |i, j| ((2.0 * i - 2.0) * j + 2.0, 4.0 * j, i * (2.0 - i) * j)),
    ),
    Example::new(
        "uneven",
        "points crowded at one side: equal steps of u are not equal lengths",
        "Punkte an einer Seite gedrängt: gleiche Schritte von u, ungleiche Längen",
        || patch_of(4, 2, |i, j| (i * i * 0.6, 4.0 * j, 0.0)),
    ),
];

/// Returns rows of control points by their column and row, counted from 0.
fn patch_of(columns: u32, rows: u32, at: fn(f64, f64) -> (f64, f64, f64)) -> Input {
    let row = |j: u32| (0..columns).map(|i| DVec3::from(at(i.into(), j.into()))).collect();
    Input::Faces((0..rows).map(row).collect())
}

static ROW: Template = Template::new(
    "row",
    "Point {i}|{j}: the curve of row {row} is at {point} for u = {u}.",
    "Punkt {i}|{j}: Die Kurve der Zeile {row} ist bei u = {u} in {point}.",
);
static POINT: Template = Template::new(
    "point",
    "Point {i}|{j}: across the points of the rows, v = {v} gives {point}.",
    "Punkt {i}|{j}: Quer über die Punkte der Zeilen gibt v = {v} den Punkt {point}.",
);

/// Steps of the grid in each direction.
const STEPS: usize = 3;

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let rows = input.faces(TAKES)?;
    if rows.is_empty() || rows.iter().any(Vec::is_empty) {
        return Err(Error::parameter("input", "without control points", TAKES.en));
    }
    let steps = record(cap, |t| {
        for number in 0..(STEPS + 1) * (STEPS + 1) {
            let [u, v] = [number % (STEPS + 1), number / (STEPS + 1)];
            let at = [u, v].map(|k| k as f64 / STEPS as f64);
            patch(rows, at, &mut Numbered { number, t: &mut *t });
        }
        Ok(())
    })?;
    let rows = rows.to_vec();
    let mut points: Vec<DVec3> = Vec::new();
    let mut column: Vec<DVec3> = Vec::new();
    Ok(Frames::new(steps, move |(number, step), want| {
        let place = [number % (STEPS + 1), number / (STEPS + 1)];
        let [i, j] = [("i", place[0].into()), ("j", place[1].into())];
        let caption = match *step {
            Step::Row { row, u, point } => {
                if row == 0 {
                    column.clear();
                }
                column.push(point);
                ROW.with([i, j, ("row", row.into()), ("point", point.into()), ("u", u.into())])
            }
            Step::Point { parameters: [_, v], point } => {
                points.push(point);
                POINT.with([i, j, ("v", v.into()), ("point", point.into())])
            }
        };
        let table = || {
            let mut table = Table::new([Word::new("row", "Zeile"), Word::new("point", "Punkt")]);
            for (row, point) in column.iter().enumerate() {
                table.row(row, [(*point).into()]);
            }
            if let (Step::Point { point, .. }, false) = (step, points.is_empty()) {
                table.row("P", [(*point).into()]);
            }
            table
        };
        let is_point = matches!(step, Step::Point { .. });
        want.shown(step.line(), caption, table, || picture(&rows, &points, &column, is_point))
    }))
}

/// Draws the control points obliquely, z upwards, the grid of points so far, and the rows' points.
fn picture(rows: &[Vec<DVec3>], points: &[DVec3], column: &[DVec3], is_point: bool) -> Picture {
    let flat = |p: DVec3| DVec2::new(p.x + 0.45 * p.y, 0.4 * p.y + 0.8 * p.z);
    let chain = |points: &[DVec3]| points.iter().map(|&p| flat(p)).collect::<Vec<_>>();
    let mut picture = Picture::around(rows.iter().flatten().map(|&p| flat(p)), 0.12);
    picture.picture_from_input = None;
    for row in rows {
        picture.chain(chain(row), Look::Thin);
        row.iter().for_each(|&p| picture.dot(flat(p), Look::Pale));
    }
    for row in points.chunks(STEPS + 1) {
        picture.chain(chain(row), Look::Result);
    }
    for (above, below) in points.iter().zip(points.iter().skip(STEPS + 1)) {
        picture.chain(chain(&[*above, *below]), Look::Result);
    }
    picture.chain(chain(column), Look::First);
    column.iter().for_each(|&p| picture.dot(flat(p), Look::First));
    let now = if is_point { points.last() } else { column.last() };
    now.into_iter().for_each(|&p| picture.dot(flat(p), Look::Now));
    picture
}
