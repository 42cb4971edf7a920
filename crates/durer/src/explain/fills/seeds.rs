//! The lessons of seed fills: with a stack of pixels, and by runs.

use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::{NO_HEAD, center};
use crate::explain::input::{Grid, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, IVec2};
use crate::raster::seed_fill::{self, FillRun, SeedFill, Step, flood_fill};
use crate::target::Pixels;
use crate::trace::PseudocodeLine;

pub(super) const NAIVE: Lesson = Lesson {
    name: seed_fill::NAIVE.name,
    info: &seed_fill::NAIVE,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&SEED, &FILL_PIXEL, &PUSH_PIXEL, &SKIP],
    unreached: &[],
    make: |_, input, _, cap| make(SeedFill::Naive, input, cap),
};

pub(super) const SPANS: Lesson = Lesson {
    name: seed_fill::INFO.name,
    info: &seed_fill::INFO,
    templates: &[&SEED, &FILL_RUN, &PUSH_RUN],
    make: |_, input, _, cap| make(SeedFill::Spans, input, cap),
    ..NAIVE
};

const TAKES: Word = Word::new("a picture with a seed", "ein Bild mit einem Saatpixel");

const EXAMPLES: &[Example] = &[
    Example {
        name: "room",
        title: Word::new("a room with a pillar and a door", "ein Raum mit Pfeiler und Tür"),
        input: || {
            walls(&["########", "#......#", "#.##...#", "#.##....", "#......#", "########"], [2, 1])
        },
    },
    Example {
        name: "diagonal",
        title: Word::new(
            "a wall with corners only: it holds with four neighbours",
            "eine Wand nur aus Ecken: Bei vier Nachbarn hält sie",
        ),
        input: || walls(&["...#.", "..#..", ".#...", "#...."], [0, 0]),
    },
    Example {
        name: "spiral",
        title: Word::new(
            "a spiral: long runs, few at a time",
            "eine Spirale: lange Läufe, wenige zugleich",
        ),
        input: || {
            walls(
                &[
                    "########", "#......#", "#.####.#", "#.#..#.#", "#.#.##.#", "#.#....#",
                    "#.######", "#.......",
                ],
                [3, 3],
            )
        },
    },
    Example::new("enclosed", "walls all around: one pixel", "ringsum Wände: ein Pixel", || {
        walls(&["###", "#.#", "###"], [1, 1])
    }),
    Example::new(
        "open",
        "no wall: the border of the picture holds",
        "keine Wand: Der Bildrand hält",
        || walls(&["......", "......", "......", "......"], [2, 1]),
    ),
    Example::new(
        "comb",
        "a comb: each tooth is a run of its own",
        "ein Kamm: Jeder Zahn ist ein eigener Lauf",
        || walls(&[".#.#.#.", ".#.#.#.", ".#.#.#.", "......."], [3, 3]),
    ),
];

static SEED: Template =
    Template::new("fill", "The seed {run} is filled.", "Das Saatpixel {run} wird gefüllt.");
static FILL_PIXEL: Template = Template::new(
    "fill",
    "Pixel {run} is popped, belongs to the region and is filled; {count} {count|waits|wait}.",
    "Pixel {run} wird vom Stapel genommen, gehört zum Gebiet und wird gefüllt; {count} {count|wartet|warten}.",
);
static PUSH_PIXEL: Template = Template::new(
    "push",
    "Its neighbour {run} is pushed, whatever it is.",
    "Der Nachbar {run} kommt auf den Stapel, was immer er ist.",
);
static SKIP: Template = Template::new(
    "skip",
    "Pixel {run} is popped: outside the picture, not of the region, or filled already.",
    "Pixel {run} wird vom Stapel genommen: außerhalb, nicht vom Gebiet oder schon gefüllt.",
);
static FILL_RUN: Template = Template::new(
    "fill",
    "Run {run} is popped and filled; {count} {count|waits|wait}.",
    "Der Lauf {run} wird vom Stapel genommen und gefüllt; {count} {count|wartet|warten}.",
);
static PUSH_RUN: Template = Template::new(
    "push",
    "Run {run} beside it belongs to the region and is pushed.",
    "Der Lauf {run} daneben gehört zum Gebiet und kommt auf den Stapel.",
);

/// Value of filled pixels, which no picture has.
const FILLED: u16 = 256;

/// Returns a picture of walls; rows come from the top.
fn walls(rows: &[&str], seed: [u32; 2]) -> Input {
    let columns = rows.first().map_or(0, |row| row.len()) as u32;
    let cells = rows.concat().bytes().map(|byte| u8::from(byte == b'#')).collect();
    Input::Grid(Grid { columns, cells, seed })
}

/// The picture and the stack.
#[derive(Clone)]
struct State {
    grid: Grid,
    by_pixels: bool,
    filled: Vec<FillRun>,
    stack: Vec<FillRun>,
}

fn make(method: SeedFill, input: &Input, cap: usize) -> Result<Frames> {
    let grid = input.grid(TAKES)?.clone();
    let cells = grid.cells.iter().map(|&cell| u16::from(cell)).collect();
    let mut image = Pixels::from_data(grid.columns, grid.rows(), cells)?;
    let [x, y] = grid.seed;
    let steps =
        record(cap, |t| flood_fill(&mut image, (x, y), FILLED, 0, method, &Default::default(), t))?;
    let (filled, stack) = (Vec::new(), Vec::new());
    let mut state = State { grid, by_pixels: method == SeedFill::Naive, filled, stack };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Fill { run, waiting } => {
                self.stack.pop();
                self.filled.push(run);
                let run = ("run", self.name(run));
                if self.filled.len() == 1 {
                    return SEED.with([run]);
                }
                let template = if self.by_pixels { &FILL_PIXEL } else { &FILL_RUN };
                template.with([run, ("count", waiting.into())])
            }
            Step::Push(run) => {
                self.stack.push(run);
                let template = if self.by_pixels { &PUSH_PIXEL } else { &PUSH_RUN };
                template.with([("run", self.name(run))])
            }
            Step::Skip(run) => {
                self.stack.pop();
                SKIP.with([("run", self.name(run))])
            }
        }
    }

    /// Returns a pixel as a point, a run by its columns and row.
    fn name(&self, run: FillRun) -> Value {
        if run.x1 - run.x0 == 1 {
            return DVec2::new(run.x0 as f64, run.y as f64).into();
        }
        let columns = format!("{}…{}", run.x0, run.x1 - 1).replace('-', "−");
        Value::List(vec![columns.into(), Word::new("in row", "in Zeile").into(), run.y.into()])
    }

    /// Returns the stack, the top above.
    fn table(&self) -> Table {
        let mut table = Table::new([Word::new("stack", "Stapel"), NO_HEAD]);
        for (place, &run) in self.stack.iter().enumerate().rev() {
            table.row(place + 1, [self.name(run)]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let grid = &self.grid;
        let mut picture = Picture::pixels(grid.columns, grid.rows());
        let cell = |picture: &mut Picture, run: &FillRun, look| {
            let all = run.x0..run.x1;
            all.for_each(|x| picture.cell([x as i32, run.y as i32], "", look));
        };
        let inside = |run: &&FillRun| {
            run.y >= 0 && run.x0 >= 0 && run.y < grid.rows().into() && run.x1 <= grid.columns.into()
        };
        let [x, y] = grid.seed.map(|side| side as usize);
        let own = grid.cells.get(y * grid.columns as usize + x).copied();
        for (i, _) in grid.cells.iter().enumerate().filter(|(_, value)| Some(**value) != own) {
            let columns = grid.columns as usize;
            picture.cell([(i % columns) as i32, (i / columns) as i32], "", Look::Window);
        }
        self.filled.iter().for_each(|run| cell(&mut picture, run, Look::First));
        let middle = |x: i64, y: i64| center(IVec2::new(x as i32, y as i32));
        for run in self.stack.iter().filter(inside) {
            picture.chain([middle(run.x0, run.y), middle(run.x1 - 1, run.y)], Look::Second);
            picture.dot(middle(run.x0, run.y), Look::Second);
        }
        let now = match step {
            Step::Fill { run, .. } | Step::Push(run) | Step::Skip(run) => run,
        };
        match step {
            Step::Fill { .. } => cell(&mut picture, now, Look::Now),
            _ if inside(&now) => {
                picture.chain([middle(now.x0, now.y), middle(now.x1 - 1, now.y)], Look::Now);
                picture.dot(middle(now.x0, now.y), Look::Now);
            }
            _ => {}
        }
        picture
    }
}
