//! Lessons of areas in pixels: cells of one outline, and faces that share edges.

use super::{EXAMPLES, Filling, ring};
use crate::Result;
use crate::curve::Contours;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::{color, grey, letter};
use crate::explain::input::{Figure, Input, Options};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::raster::coverage::cell_sums::{self, CellSum, Step};
use crate::raster::coverage::{self, PartitionFace, PartitionStep};
use crate::sorting::CompactSort;
use crate::target::Pixels;
use crate::trace::PseudocodeLine;

pub(super) const CELLS: Lesson = Lesson {
    name: cell_sums::INFO.name,
    info: &cell_sums::INFO,
    takes: super::TAKES,
    examples: &[
        STRIP,
        TRIANGLE,
        EXAMPLES[2],
        EXAMPLES[0],
        EXAMPLES[3],
        Example::new(
            "pixel",
            "exactly one pixel: its share is 1",
            "genau ein Pixel: Sein Anteil ist 1",
            || ring(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]),
        ),
    ],
    templates: &[&PIECE, &PIXEL, &SPAN],
    unreached: &[],
    make: |_, input, options, cap| by_cells(input, options, cap),
};

pub(super) const PARTITION: Lesson = Lesson {
    name: coverage::PARTITION.name,
    info: &coverage::PARTITION,
    takes: super::TAKES,
    examples: &[
        DIAGONAL,
        FAN,
        Example::new(
            "halves",
            "a common edge through the middle of pixels",
            "eine gemeinsame Kante mitten durch Pixel",
            || {
                faces(&[
                    &[(0.0, 0.0), (2.5, 0.0), (2.5, 3.0), (0.0, 3.0)],
                    &[(2.5, 0.0), (5.0, 0.0), (5.0, 3.0), (2.5, 3.0)],
                ])
            },
        ),
        Example::new(
            "aligned",
            "along the borders of pixels: whole pixels only",
            "auf den Grenzen der Pixel: nur ganze",
            || {
                faces(&[
                    &[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)],
                    &[(2.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0)],
                ])
            },
        ),
        Example::new(
            "sliver",
            "a thin face between two others",
            "eine dünne Fläche zwischen zwei anderen",
            || {
                faces(&[
                    &[(0.0, 0.0), (4.0, 0.0), (4.0, 1.4)],
                    &[(0.0, 0.0), (4.0, 1.4), (4.0, 1.6)],
                    &[(0.0, 0.0), (4.0, 1.6), (4.0, 3.0)],
                ])
            },
        ),
        Example::new(
            "overlap",
            "faces that overlap: more than the whole",
            "Flächen, die sich überlappen: mehr als das Ganze",
            || {
                faces(&[
                    &[(0.0, 0.0), (3.0, 0.0), (0.0, 3.0)],
                    &[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)],
                ])
            },
        ),
    ],
    templates: &[&AREA, &FULL, &PART],
    unreached: &[],
    make: |_, input, _, cap| by_faces(input, cap),
};

const STRIP: Example = Example {
    name: "strip",
    title: Word::new(
        "vertical edges at x = 2.25 and 5.5",
        "senkrechte Kanten bei x = 2,25 und 5,5",
    ),
    input: || ring(&[(2.25, 0.0), (2.25, 2.0), (5.5, 2.0), (5.5, 0.0)]),
};

const TRIANGLE: Example = Example {
    name: "triangle",
    title: Word::new("a triangle between pixels", "ein Dreieck zwischen den Pixeln"),
    input: || ring(&[(0.5, 0.5), (6.5, 2.0), (2.0, 4.5)]),
};

const DIAGONAL: Example = Example {
    name: "diagonal",
    title: Word::new(
        "a square of two triangles: no seam",
        "ein Quadrat aus zwei Dreiecken: keine Naht",
    ),
    input: || {
        faces(&[&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)], &[(0.0, 0.0), (4.0, 3.0), (0.0, 3.0)]])
    },
};

const FAN: Example = Example {
    name: "fan",
    title: Word::new(
        "three faces that meet within a pixel",
        "drei Flächen, die in einem Pixel zusammentreffen",
    ),
    input: || {
        faces(&[
            &[(0.5, 0.5), (4.5, 0.5), (2.25, 2.25)],
            &[(4.5, 0.5), (2.5, 4.0), (2.25, 2.25)],
            &[(2.5, 4.0), (0.5, 0.5), (2.25, 2.25)],
        ])
    },
};

fn faces(rings: &[&[(f64, f64)]]) -> Input {
    let ring = |ring: &&[(f64, f64)]| ring.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { rings: rings.iter().map(ring).collect(), ..Figure::default() })
}

static PIECE: Template = Template::new(
    "piece",
    "Pixel {pixel}: a piece from {p} to {q} adds {dy} to the cover and {dy} · {distance} to the area: {cover}, {area}.",
    "Pixel {pixel}: Ein Stück von {p} nach {q} gibt {dy} zur Höhe und {dy} · {distance} zur Fläche: {cover}; {area}.",
);
static PIXEL: Template = Template::new(
    "pixel",
    "Pixel {pixel}: covers to the left {sum}, own area {area}: |{total}| of it is covered, {coverage} of 255.",
    "Pixel {pixel}: Höhen links davon {sum}, eigene Fläche {area}: |{total}| davon ist bedeckt, {coverage} von 255.",
);
static SPAN: Template = Template::new(
    "span",
    "Row {row}: no edge from x = {first} to {last}, so all get |{sum}|, {coverage} of 255.",
    "Zeile {row}: keine Kante von x = {first} bis {last}, alle bekommen |{sum}|, {coverage} von 255.",
);
static AREA: Template = Template::new(
    "area",
    "Face {face} covers {area} of pixel {pixel}; together it is {sum}.",
    "Fläche {face} bedeckt {area} von Pixel {pixel}; zusammen sind es {sum}.",
);
static FULL: Template = Template::new(
    "pixel",
    "Pixel {pixel}: the areas sum to exactly 1, so nothing of the background shines through.",
    "Pixel {pixel}: Die Flächen ergeben genau 1, vom Hintergrund scheint nichts durch.",
);
static PART: Template = Template::new(
    "pixel",
    "Pixel {pixel}: the areas sum to {sum}, so 1 − {sum} of the background remains.",
    "Pixel {pixel}: Die Flächen ergeben {sum}, es bleibt 1 − {sum} vom Hintergrund.",
);

/// Returns a pixel as a value.
fn at([x, y]: [u32; 2]) -> Value {
    DVec2::new(x.into(), y.into()).into()
}

fn signed([x, y]: [u32; 2]) -> [i32; 2] {
    [x as i32, y as i32]
}

/// The cells and pixels of an outline so far.
#[derive(Clone)]
struct Cells {
    filling: Filling,
    cells: Vec<([u32; 2], CellSum)>,
    pixels: Vec<([u32; 2], u8)>,
}

fn by_cells(input: &Input, options: &Options, cap: usize) -> Result<Frames> {
    let filling = Filling::new(input)?;
    let rule = Filling::options(options)?.rule;
    let [width, height] = [filling.raster.columns, filling.raster.rows];
    let contours = filling.contours();
    let steps = record(cap, |t| cell_sums::fill(&contours, width, height, rule, t))?;
    let mut state = Cells { filling, cells: Vec::new(), pixels: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl Cells {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(step), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Piece { pixel, ends, adds, cell } => {
                self.cells.retain(|(other, _)| *other != pixel);
                self.cells.push((pixel, cell));
                let [p, q] = ends.map(Value::from);
                PIECE.with([
                    ("pixel", at(pixel)),
                    ("p", p),
                    ("q", q),
                    ("dy", adds.cover.into()),
                    ("distance", (adds.area / adds.cover).into()),
                    ("cover", cell.cover.into()),
                    ("area", cell.area.into()),
                ])
            }
            Step::Pixel { pixel, sum, cell, coverage } => {
                self.pixels.push((pixel, coverage));
                let [sum, area, total] = [sum, cell.area, sum + cell.area].map(Value::from);
                let coverage = ("coverage", i32::from(coverage).into());
                PIXEL.with([
                    ("pixel", at(pixel)),
                    ("sum", sum),
                    ("area", area),
                    ("total", total),
                    coverage,
                ])
            }
            Step::Span { y, columns: [x0, x1], sum, coverage } => {
                self.pixels.extend((x0..x1).map(|x| ([x, y], coverage)));
                let [row, first, last] = [y, x0, x1 - 1].map(Value::from);
                let coverage = ("coverage", i32::from(coverage).into());
                let sum = ("sum", sum.into());
                SPAN.with([("row", row), ("first", first), ("last", last), sum, coverage])
            }
        }
    }

    /// Returns the cells of the row.
    fn table(&self, step: &Step) -> Table {
        let heads = [
            Word::new("cell", "Zelle"),
            Word::new("cover", "Höhe"),
            Word::new("area", "Fläche"),
            Word::new("of 255", "von 255"),
        ];
        let (Step::Piece { pixel: [_, y], .. }
        | Step::Pixel { pixel: [_, y], .. }
        | Step::Span { y, .. }) = *step;
        let mut row: Vec<_> = self.cells.iter().filter(|(pixel, _)| pixel[1] == y).collect();
        row.compact_sort_by_key(|(pixel, _)| pixel[0]);
        let mut table = Table::new(heads);
        for (pixel, cell) in row {
            let own = self.pixels.iter().find(|(other, _)| other == pixel);
            let coverage = own.map_or("".into(), |(_, own)| Value::from(i32::from(*own)));
            table.row(at(*pixel), [cell.cover.into(), cell.area.into(), coverage]);
        }
        table
    }

    /// Writes a number over a pixel, if pixels are large enough.
    fn number(&self, picture: &mut Picture, pixel: [u32; 2], value: Value) {
        number(picture, self.filling.raster.columns, pixel, value);
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.filling.raster.picture();
        for (pixel, coverage) in &self.pixels {
            let ink = f64::from(*coverage) / 255.0 * 0.55;
            picture.colored(signed(*pixel), grey(ink), "");
        }
        let waits = |pixel: &[u32; 2]| !self.pixels.iter().any(|(other, _)| other == pixel);
        for (pixel, cell) in self.cells.iter().filter(|(pixel, _)| waits(pixel)) {
            let hundredths = (cell.area * 100.0).round() / 100.0;
            picture.cell(signed(*pixel), "", Look::First);
            self.number(&mut picture, *pixel, hundredths.into());
        }
        for (pixel, coverage) in &self.pixels {
            self.number(&mut picture, *pixel, i32::from(*coverage).into());
        }
        for ring in &self.filling.rings {
            let closed: Vec<DVec2> = ring.iter().chain(ring.first()).copied().collect();
            picture.chain(closed, Look::Second);
        }
        match *step {
            Step::Piece { ends: [p, q], .. } => picture.arrow(p, q, Look::Now),
            Step::Pixel { pixel, .. } => picture.chain(around(pixel, pixel[0] + 1), Look::Now),
            Step::Span { y, columns: [x0, x1], .. } => {
                picture.chain(around([x0, y], x1), Look::Now);
            }
        }
        picture
    }
}

/// The most columns whose pixels have room for a number.
const ROOMY: u32 = 8;

/// Writes a number over a pixel, if pixels are large enough.
fn number(picture: &mut Picture, columns: u32, [x, y]: [u32; 2], value: Value) {
    if columns <= ROOMY {
        let middle = DVec2::new(x.into(), y.into()) + 0.5;
        picture.label(middle, (0.0, 0.0), value);
    }
}

/// Returns the border of pixels of a row, from one to before a column.
fn around([x, y]: [u32; 2], end: u32) -> [DVec2; 5] {
    let [left, right, low] = [x, end, y].map(f64::from);
    [(left, low), (right, low), (right, low + 1.0), (left, low + 1.0), (left, low)].map(DVec2::from)
}

/// Areas of one pixel: those of the faces, and their sum.
type Areas = Vec<(usize, f64)>;

fn by_faces(input: &Input, cap: usize) -> Result<Frames> {
    let filling = Filling::new(input)?;
    let face = |(number, ring): (usize, &Vec<DVec2>)| {
        let [r, g, b] = color(number);
        PartitionFace { contours: Contours::polygon(ring.iter().copied()), color: [r, g, b, 255] }
    };
    let faces: Vec<PartitionFace> = filling.rings.iter().enumerate().map(face).collect();
    let mut target = Pixels::new(filling.raster.columns, filling.raster.rows, [255; 4]);
    let steps = record(cap, |t| coverage::fill_partition(&faces, &mut target, t))?;
    let mut areas: Vec<([u32; 2], Areas)> = Vec::new();
    let mut done: Vec<([u32; 2], [u8; 3])> = Vec::new();
    Ok(Frames::new(steps, move |step, want| {
        let (PartitionStep::Area { pixel: (x, y), .. }
        | PartitionStep::Pixel { pixel: (x, y), .. }) = *step;
        let pixel = [x, y];
        if let PartitionStep::Area { face, area, .. } = *step {
            let part = (face, f64::from(area) / 65_536.0);
            match areas.iter_mut().find(|(other, _)| *other == pixel) {
                Some((_, own)) => own.push(part),
                None => areas.push((pixel, vec![part])),
            }
        }
        let own = areas.iter().find(|(other, _)| *other == pixel).map(|(_, own)| own.as_slice());
        let own = own.unwrap_or_default();
        let sum = own.iter().map(|(_, area)| area).sum::<f64>();
        let caption = match *step {
            PartitionStep::Area { face, area, .. } => AREA.with([
                ("face", letter(face).into()),
                ("area", (f64::from(area) / 65_536.0).into()),
                ("pixel", at(pixel)),
                ("sum", sum.into()),
            ]),
            PartitionStep::Pixel { color: [r, g, b, _], .. } => {
                done.push((pixel, [r, g, b]));
                if sum == 1.0 {
                    FULL.with([("pixel", at(pixel))])
                } else {
                    PART.with([("pixel", at(pixel)), ("sum", sum.into())])
                }
            }
        };
        let table = || {
            let mut table = Table::new([Word::new("face", "Fläche"), Word::new("area", "Anteil")]);
            own.iter().for_each(|(face, area)| table.row(letter(*face), [(*area).into()]));
            table.row(Word::new("sum", "Summe"), [sum.into()]);
            table
        };
        let picture = || partition_picture(&filling, &areas, &done, pixel);
        want.shown(step.line(), caption, table, picture)
    }))
}

/// Draws the sums of areas in the pixels that wait, the colours of those that are done, and the faces.
fn partition_picture(
    filling: &Filling,
    areas: &[([u32; 2], Areas)],
    done: &[([u32; 2], [u8; 3])],
    now: [u32; 2],
) -> Picture {
    let mut picture = filling.raster.picture();
    for (pixel, own) in areas {
        let sum = own.iter().map(|(_, area)| area).sum::<f64>();
        picture.cell(signed(*pixel), "", Look::Thin);
        let hundredths = (sum * 100.0).round() / 100.0;
        if !done.iter().any(|(other, _)| other == pixel) {
            number(&mut picture, filling.raster.columns, *pixel, hundredths.into());
        }
    }
    for (pixel, color) in done {
        picture.colored(signed(*pixel), *color, "");
    }
    for (index, ring) in filling.rings.iter().enumerate() {
        let closed: Vec<DVec2> = ring.iter().chain(ring.first()).copied().collect();
        picture.chain(closed, Look::Window);
        if let Some(&first) = ring.first() {
            let middle = ring.iter().sum::<DVec2>() / ring.len() as f64;
            let out = (first - middle).normalize_or(DVec2::Y) * 9.0;
            picture.label(first, (out.x, -out.y), letter(index));
        }
    }
    picture.chain(around(now, now[0] + 1), Look::Now);
    picture
}
