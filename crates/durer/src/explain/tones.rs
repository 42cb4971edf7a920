//! Lessons of halftones: error diffusion and clustered dots.

use super::frame::{Frames, record};
use super::grid::{NO_HEAD, grey};
use super::input::{Grid, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Template, Value, Word};
use crate::Result;
use crate::fragment::halftone::{clustered_dot, error_diffusion};
use crate::target::Pixels;
use crate::trace::PseudocodeLine;

pub(super) const LESSONS: &[Lesson] = &[FLOYD_STEINBERG, CLUSTERED_DOT];

const FLOYD_STEINBERG: Lesson = Lesson {
    name: error_diffusion::INFO.name,
    info: &error_diffusion::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&DIFFUSED],
    unreached: &[],
    make: |_, input, _, cap| by_errors(input, cap),
};

const CLUSTERED_DOT: Lesson = Lesson {
    name: clustered_dot::INFO.name,
    info: &clustered_dot::INFO,
    templates: &[&WHITE, &BLACK],
    make: |_, input, _, cap| by_screen(input, cap),
    ..FLOYD_STEINBERG
};

const TAKES: Word = Word::new("a picture of greys 0 … 255", "ein Bild aus Grauwerten 0 … 255");

const EXAMPLES: &[Example] = &[
    Example {
        name: "ramp",
        title: Word::new("a ramp from black to white", "ein Verlauf von Schwarz nach Weiß"),
        input: || greys(8, 6, |x, _| (x * 255 / 7) as u8),
    },
    Example {
        name: "quarter",
        title: Word::new("a quarter of the light everywhere", "überall ein Viertel des Lichts"),
        input: || greys(8, 8, |_, _| 64),
    },
    Example::new(
        "half",
        "half of the light: the pattern of a chessboard, or grown dots",
        "die Hälfte des Lichts: ein Schachbrett, oder gewachsene Punkte",
        || greys(8, 6, |_, _| 128),
    ),
    Example::new(
        "nearly-black",
        "nearly black: few white pixels, far apart",
        "fast schwarz: wenige weiße Pixel, weit auseinander",
        || greys(8, 8, |_, _| 16),
    ),
    Example::new(
        "edge",
        "a sharp edge between dark and light",
        "eine scharfe Kante zwischen Dunkel und Hell",
        || greys(8, 6, |x, _| if x < 4 { 48 } else { 208 }),
    ),
    Example::new(
        "black-and-white",
        "only black and white: nothing is left over",
        "nur Schwarz und Weiß: Nichts bleibt übrig",
        || greys(6, 4, |x, y| if (x + y) % 2 == 0 { 255 } else { 0 }),
    ),
];

static DIFFUSED: Template = Template::new(
    "pixel",
    "{pixel}: with its errors it has {value}, so it becomes {level}; the error {error} goes on: {a}, {b}, {c}, {d}.",
    "{pixel}: Mit den Fehlern hat es {value} und wird {level}; der Fehler {error} wandert weiter: {a}, {b}, {c}, {d}.",
);
static WHITE: Template = Template::new(
    "white",
    "{pixel}: light {value} is above the threshold {threshold}: white.",
    "{pixel}: Licht {value} liegt über der Schwelle {threshold}: weiß.",
);
static BLACK: Template = Template::new(
    "black",
    "{pixel}: light {value} is not above the threshold {threshold}: black.",
    "{pixel}: Licht {value} liegt nicht über der Schwelle {threshold}: schwarz.",
);

fn greys(columns: u32, rows: u32, at: fn(u32, u32) -> u8) -> Input {
    let cells = (0..rows).flat_map(|y| (0..columns).map(move |x| at(x, y))).collect();
    Input::Grid(Grid { columns, cells, seed: [0, 0] })
}

fn light(grid: &Grid) -> Result<Pixels<f32>> {
    let cells = grid.cells.iter().map(|&grey| f32::from(grey) / 255.0).collect();
    Pixels::from_data(grid.columns, grid.rows(), cells)
}

/// Returns a number with the digits that are shown.
fn value(x: f32) -> Value {
    f64::from(x).into()
}

fn shown([x, y]: [u32; 2]) -> Value {
    crate::math::DVec2::new(x.into(), y.into()).into()
}

fn by_errors(input: &Input, cap: usize) -> Result<Frames> {
    let grid = input.grid(TAKES)?;
    let image = light(grid)?;
    let steps = record(cap, |t| {
        error_diffusion::dither(&image, &Default::default(), t);
        Ok(())
    })?;
    let grid = grid.clone();
    let mut done: Vec<([u32; 2], bool)> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        done.push((step.pixel, step.level > 0));
        let parts = [7.0, 3.0, 5.0, 1.0].map(|part| step.error * (part / 16.0));
        let [a, b, c, d] = parts.map(value);
        let level = if step.level > 0 {
            Word::new("white", "weiß")
        } else {
            Word::new("black", "schwarz")
        };
        let caption = DIFFUSED.with([
            ("pixel", shown(step.pixel)),
            ("value", value(step.value)),
            ("level", level.into()),
            ("error", value(step.error)),
            ("a", a),
            ("b", b),
            ("c", c),
            ("d", d),
        ]);
        let picture = || {
            let mut picture = picture(&grid, &done);
            let [x, y] = step.pixel.map(|side| side as i32);
            let to = [[x + 1, y], [x - 1, y + 1], [x, y + 1], [x + 1, y + 1]];
            let inside =
                |[x, y]: [i32; 2]| x >= 0 && (x as u32) < grid.columns && (y as u32) < grid.rows();
            let middle = |[x, y]: [i32; 2]| crate::math::DVec2::new(x.into(), y.into()) + 0.5;
            to.into_iter()
                .filter(|at| inside(*at))
                .for_each(|at| picture.arrow(middle([x, y]), middle(at), Look::Now));
            picture
        };
        let table = || {
            let mut table = Table::new([NO_HEAD, Word::new("value", "Wert")]);
            table.row(Word::new("value", "Wert"), [value(step.value)]);
            table.row(Word::new("error", "Fehler"), [value(step.error)]);
            for (name, part) in ["7/16 →", "3/16 ↙", "5/16 ↓", "1/16 ↘"].into_iter().zip(parts)
            {
                table.row(name, [value(part)]);
            }
            table
        };
        want.shown(step.line(), caption, table, picture)
    }))
}

fn by_screen(input: &Input, cap: usize) -> Result<Frames> {
    let grid = input.grid(TAKES)?;
    let image = light(grid)?;
    let steps = record(cap, |t| {
        clustered_dot::dither(&image, t);
        Ok(())
    })?;
    let grid = grid.clone();
    let mut done: Vec<([u32; 2], bool)> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        done.push((step.pixel, step.white));
        let template = if step.white { &WHITE } else { &BLACK };
        let threshold = ("threshold", value(step.threshold));
        let caption =
            template.with([("pixel", shown(step.pixel)), ("value", value(step.value)), threshold]);
        // The rows of the screen around the pixel.
        let table = || {
            let mut table = Table::new([Word::new("screen", "Raster"), NO_HEAD]);
            for (y, row) in clustered_dot::SCREEN.iter().enumerate() {
                let now = step.pixel[1] as usize % 8 == y;
                let cells: Vec<Value> = row.iter().map(|&entry| i32::from(entry).into()).collect();
                table.row(if now { format!("→ {y}") } else { y.to_string() }, [Value::List(cells)]);
            }
            table
        };
        want.shown(step.line(), caption, table, || picture(&grid, &done))
    }))
}

/// Draws the greys, over them the pixels that are done, in black and white.
fn picture(grid: &Grid, done: &[([u32; 2], bool)]) -> Picture {
    let mut picture = Picture::pixels(grid.columns, grid.rows());
    for (place, &own) in grid.cells.iter().enumerate().skip(done.len()) {
        let columns = grid.columns as usize;
        let at = [(place % columns) as i32, (place / columns) as i32];
        picture.colored(at, [own; 3], "");
    }
    for &(pixel, white) in done {
        let color = if white { [255; 3] } else { grey(1.0) };
        picture.colored(pixel.map(|side| side as i32), color, "");
    }
    if let Some(([x, y], _)) = done.last() {
        picture.dot(crate::math::DVec2::new((*x).into(), (*y).into()) + 0.5, Look::Now);
    }
    picture
}
