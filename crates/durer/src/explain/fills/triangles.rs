//! The lessons of triangles in pixels: edge functions, edge walking, tiles.

use super::ring;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::{NO_HEAD, Raster, center};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, IVec2};
use crate::raster::triangle::tiles::{TILE, Verdict};
use crate::raster::triangle::{SnappedTriangle, edge_function, edge_walking, tiles};
use crate::trace::PseudocodeLine;
use crate::view::window::PixelRect;
use crate::{Error, Result};

pub(super) const EDGE_FUNCTION: Lesson = Lesson {
    name: edge_function::INFO.name,
    info: &edge_function::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&INSIDE, &OUTSIDE],
    unreached: &[],
    make: |_, input, _, cap| by_functions(input, cap),
};

pub(super) const EDGE_WALKING: Lesson = Lesson {
    name: edge_walking::INFO.name,
    info: &edge_walking::INFO,
    templates: &[&EDGES, &ROW_FILLED, &ROW_EMPTY],
    make: |_, input, _, cap| by_walking(input, cap),
    ..EDGE_FUNCTION
};

pub(super) const TILES: Lesson = Lesson {
    name: tiles::INFO.name,
    info: &tiles::INFO,
    examples: LARGE,
    templates: &[&REJECTED, &ACCEPTED, &EXAMINED],
    make: |_, input, _, cap| by_tiles(input, cap),
    ..EDGE_FUNCTION
};

const TAKES: Word = Word::new("a ring of three points", "ein Ring aus drei Punkten");

const EXAMPLES: &[Example] = &[
    Example {
        name: "corners-on-centres",
        title: Word::new(
            "corners on centres of pixels: the border rule decides",
            "Ecken auf Pixelmitten: Die Randregel entscheidet",
        ),
        input: || ring(&[(1.5, 1.5), (7.5, 1.5), (1.5, 6.5)]),
    },
    Example {
        name: "oblique",
        title: Word::new("a corner at half height", "eine Ecke auf halber Höhe"),
        input: || ring(&[(1.0, 3.0), (5.0, 0.0), (8.0, 7.0)]),
    },
    Example {
        name: "sliver",
        title: Word::new("a sliver: rows without pixels", "ein Splitter: Zeilen ohne Pixel"),
        input: || ring(&[(0.7, 0.6), (8.3, 4.1), (3.2, 1.6)]),
    },
    Example::new(
        "flat-top",
        "a horizontal upper edge: its pixels belong",
        "eine waagrechte obere Kante: Ihre Pixel gehören dazu",
        || ring(&[(1.5, 1.5), (8.5, 1.5), (4.5, 7.5)]),
    ),
    Example::new("clockwise", "in the other direction", "in der anderen Richtung", || {
        ring(&[(1.0, 1.0), (4.0, 7.0), (8.0, 2.0)])
    }),
    Example::new(
        "tiny",
        "smaller than a pixel, around its centre",
        "kleiner als ein Pixel, um dessen Mitte",
        || ring(&[(2.2, 2.2), (2.9, 2.4), (2.4, 2.9)]),
    ),
];

const LARGE: &[Example] = &[
    Example {
        name: "all-verdicts",
        title: Word::new("tiles of all three kinds", "Kacheln aller drei Arten"),
        input: || ring(&[(1.0, 1.0), (39.0, 2.0), (5.0, 38.0)]),
    },
    Example {
        name: "thin",
        title: Word::new(
            "a thin triangle: all tiles are examined",
            "ein dünnes Dreieck: Alle Kacheln werden untersucht",
        ),
        input: || ring(&[(1.0, 1.0), (30.0, 21.0), (28.0, 23.0)]),
    },
    Example::new("one-tile", "within one tile", "in einer Kachel", || {
        ring(&[(1.0, 1.0), (6.0, 2.0), (3.0, 7.0)])
    }),
    Example::new(
        "aligned",
        "corners in the corners of tiles",
        "Ecken in den Ecken von Kacheln",
        || ring(&[(0.0, 0.0), (32.0, 0.0), (0.0, 32.0)]),
    ),
    Example::new("tall", "tall and narrow", "hoch und schmal", || {
        ring(&[(10.0, 0.0), (16.0, 2.0), (12.0, 39.0)])
    }),
    Example::new("flat", "flat and wide", "flach und breit", || {
        ring(&[(0.0, 10.0), (39.0, 8.0), (36.0, 18.0)])
    }),
];

static INSIDE: Template = Template::new(
    "sample",
    "Pixel {pixel}: {e1}, {e2} and {e3} are all ≥ 0, so it is inside.",
    "Pixel {pixel}: {e1}, {e2} und {e3} sind alle ≥ 0, es liegt innen.",
);
static OUTSIDE: Template = Template::new(
    "sample",
    "Pixel {pixel}: of {e1}, {e2} and {e3} not all are ≥ 0, so it is outside.",
    "Pixel {pixel}: Von {e1}, {e2} und {e3} sind nicht alle ≥ 0, es liegt außen.",
);
static EDGES: Template = Template::new(
    "edges",
    "Two edges bound rows {first} to {last}: they are followed from row to row.",
    "Zwei Kanten begrenzen die Zeilen {first} bis {last}: Ihnen wird von Zeile zu Zeile gefolgt.",
);
static ROW_FILLED: Template = Template::new(
    "row",
    "Row {row}: the left edge gives {left}, the right one {right}; pixels {left} to {last} are filled.",
    "Zeile {row}: Die linke Kante gibt {left}, die rechte {right}; Pixel {left} bis {last} werden gefüllt.",
);
static ROW_EMPTY: Template = Template::new(
    "row",
    "Row {row}: the left edge gives {left}, the right one {right}; no pixel lies between.",
    "Zeile {row}: Die linke Kante gibt {left}, die rechte {right}; dazwischen liegt kein Pixel.",
);
static REJECTED: Template = Template::new(
    "tile",
    "Tile {tile}: even its best corner is outside one edge, so it is rejected.",
    "Kachel {tile}: Selbst ihre beste Ecke liegt außerhalb einer Kante, sie wird verworfen.",
);
static ACCEPTED: Template = Template::new(
    "tile",
    "Tile {tile}: even its worst corners are inside all edges, so all 64 pixels are set.",
    "Kachel {tile}: Selbst ihre schlechtesten Ecken liegen innerhalb aller Kanten, alle 64 Pixel werden gesetzt.",
);
static EXAMINED: Template = Template::new(
    "tile",
    "Tile {tile}: an edge passes through it, so each pixel is tested; {count} {count|is|are} inside.",
    "Kachel {tile}: Eine Kante geht hindurch, jedes Pixel wird geprüft; {count} {count|liegt|liegen} innen.",
);

/// A triangle on its grid, and the pixels that are set.
#[derive(Clone)]
struct Work {
    raster: Raster,
    corners: Vec<DVec2>,
    triangle: SnappedTriangle,
    pixels: Vec<IVec2>,
}

impl Work {
    fn new(input: &Input) -> Result<Self> {
        let ring = input.figure(TAKES)?.ring(TAKES)?;
        if ring.len() != 3 {
            return Err(Error::parameter("points of the ring", ring.len(), TAKES.en));
        }
        let raster = Raster::around(ring.iter().copied());
        let corners: Vec<DVec2> = ring.iter().map(|&p| raster.at(p)).collect();
        let of = |k: usize| corners.get(k).copied().unwrap_or_default();
        let triangle = SnappedTriangle::snap([of(0), of(1), of(2)])?;
        Ok(Self { raster, corners, triangle, pixels: Vec::new() })
    }

    /// Returns the options that keep to the grid.
    fn options(&self) -> crate::raster::triangle::Options {
        let (columns, rows) = (self.raster.columns as i32, self.raster.rows as i32);
        crate::raster::triangle::Options { clip: PixelRect::spanning(0, 0, columns, rows) }
    }

    fn set(&mut self, y: i32, columns: std::ops::Range<i32>) {
        let (width, height) = (self.raster.columns as i32, self.raster.rows as i32);
        if (0..height).contains(&y) {
            let within = columns.start.max(0)..columns.end.min(width);
            self.pixels.extend(within.map(|x| IVec2::new(x, y)));
        }
    }

    fn picture(&self) -> Picture {
        let mut picture = self.raster.picture();
        for pixel in &self.pixels {
            picture.cell(pixel.to_array(), "", Look::First);
        }
        let ring = self.corners.iter().chain(self.corners.first()).copied();
        picture.chain(ring.collect::<Vec<_>>(), Look::Second);
        picture
    }
}

fn by_functions(input: &Input, cap: usize) -> Result<Frames> {
    let mut work = Work::new(input)?;
    let (triangle, options) = (work.triangle, work.options());
    let steps = record(cap, |t| {
        edge_function::rasterize(&triangle, &options, |_| {}, t);
        Ok(())
    })?;
    Ok(Frames::new(steps, move |step, want| {
        let edge_function::Step::Sample { x, y, edges } = *step;
        let pixel = IVec2::new(x, y);
        let inside = edges.iter().all(|e| *e >= 0);
        if inside {
            work.pixels.push(pixel);
        }
        let picture = || {
            let mut picture = work.picture();
            picture.dot(center(pixel), if inside { Look::Result } else { Look::Now });
            picture
        };
        let template = if inside { &INSIDE } else { &OUTSIDE };
        let values = edges.map(square_pixels);
        let [e1, e2, e3] = values.clone();
        let named = ("pixel", pixel.as_dvec2().into());
        let caption = template.with([named, ("e1", e1), ("e2", e2), ("e3", e3)]);
        want.shown(step.line(), caption, || functions(values), picture)
    }))
}

/// Returns an edge function in square pixels.
fn square_pixels(e: i64) -> Value {
    (e as f64 / 65_536.0).into()
}

fn functions(values: [Value; 3]) -> Table {
    let mut table = Table::new([NO_HEAD, Word::new("value", "Wert")]);
    for (k, value) in values.into_iter().enumerate() {
        table.row(format!("E{}", k + 1), [value]);
    }
    table
}

fn by_walking(input: &Input, cap: usize) -> Result<Frames> {
    use edge_walking::Step;
    let mut work = Work::new(input)?;
    let (triangle, options) = (work.triangle, work.options());
    let steps = record(cap, |t| {
        edge_walking::rasterize(&triangle, &options, |_| {}, t);
        Ok(())
    })?;
    Ok(Frames::new(steps, move |step, want| {
        let (caption, row) = walked(step);
        if let Step::Row { y, left, right } = *step {
            work.set(y, left.max(0) as i32..right.min(i32::MAX.into()) as i32);
        }
        let table = || {
            let mut table = Table::new([NO_HEAD, Word::new("pixel", "Pixel")]);
            if let Step::Row { y, left, right } = *step {
                table.row(Word::new("row", "Zeile"), [y.into()]);
                table.row(Word::new("left", "links"), [left.into()]);
                table.row(Word::new("right", "rechts"), [right.into()]);
            }
            table
        };
        let picture = || {
            let mut picture = work.picture();
            super::add_row(&mut picture, row);
            if let Step::Row { y, left, right } = *step {
                for x in [left, right] {
                    picture.dot(super::on_row(x as f64, y), Look::Now);
                }
            }
            picture
        };
        want.shown(step.line(), caption, table, picture)
    }))
}

/// Returns the caption of a step of edge walking, and its row.
fn walked(step: &edge_walking::Step) -> (Caption, i32) {
    match *step {
        edge_walking::Step::Edges { y0, y1 } => {
            (EDGES.with([("first", y0.into()), ("last", (y1 - 1).into())]), y0)
        }
        edge_walking::Step::Row { y, left, right } => {
            let ends = [("row", y.into()), ("left", left.into()), ("right", right.into())];
            let [row, from, to] = ends;
            let caption = if left < right {
                ROW_FILLED.with([row, from, to, ("last", (right - 1).into())])
            } else {
                ROW_EMPTY.with([row, from, to])
            };
            (caption, y)
        }
    }
}

fn by_tiles(input: &Input, cap: usize) -> Result<Frames> {
    let mut work = Work::new(input)?;
    let (triangle, options) = (work.triangle, work.options());
    let steps = record(cap, |t| {
        tiles::rasterize(&triangle, &options, |_| {}, t);
        Ok(())
    })?;
    let mut counts = [0_usize; 3];
    Ok(Frames::new(steps, move |step, want| {
        let tiles::Step::Tile { x, y, verdict, rows } = *step;
        for (row, mask) in (y..).zip(rows) {
            let set = (0..TILE).filter(|bit| mask >> bit & 1 == 1);
            set.for_each(|bit| work.set(row, x + bit..x + bit + 1));
        }
        let place = match verdict {
            Verdict::Rejected => 0,
            Verdict::Accepted => 1,
            Verdict::Examined => 2,
        };
        counts[place] += 1;
        let [low, size] = [DVec2::new(x.into(), y.into()), DVec2::splat(TILE.into())];
        let picture = || {
            let mut picture = work.picture();
            let looks = [Look::Second, Look::Result, Look::Now];
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
            picture.chain(corners.map(|at| low + size * DVec2::from(at)), looks[place]);
            picture
        };
        let tile = ("tile", low.into());
        let caption = match verdict {
            Verdict::Rejected => REJECTED.with([tile]),
            Verdict::Accepted => ACCEPTED.with([tile]),
            Verdict::Examined => {
                let count: u32 = rows.iter().map(|mask| mask.count_ones()).sum();
                EXAMINED.with([tile, ("count", count.into())])
            }
        };
        want.shown(step.line(), caption, || verdicts(counts), picture)
    }))
}

/// Returns the numbers of tiles that were rejected, accepted and examined.
fn verdicts(counts: [usize; 3]) -> Table {
    let mut table = Table::new([NO_HEAD, Word::new("tiles", "Kacheln")]);
    let names = [("rejected", "verworfen"), ("accepted", "angenommen"), ("examined", "untersucht")];
    for ((en, de), count) in names.into_iter().zip(counts) {
        table.row(Word::new(en, de), [count.into()]);
    }
    table
}
