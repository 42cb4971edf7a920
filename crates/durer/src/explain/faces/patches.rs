//! The lesson of Catmull's subdivision of patches.

use super::{DEPTH, middle, name};
use crate::explain::frame::{Frames, record};
use crate::explain::grid::{Raster, color};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::Screen;
use crate::visibility::polygons::patch_subdivision::{
    BicubicPatch, INFO, Options, PatchPart, Step, render,
};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "leaf",
            title: Word::new(
                "a leaf that rolls up: parts of it are behind others",
                "ein Blatt, das sich einrollt: Teile liegen hinter anderen",
            ),
            input: || {
                let row = |j: usize| {
                    let across = [(0.6, 3.0), (6.5, 6.0), (5.5, -2.0), (2.0, 0.5)];
                    let place = |(x, depth): (f64, f64)| {
                        DVec3::new(x + 0.3 * j as f64, 0.4 + 1.5 * j as f64, -2.0 - depth)
                    };
                    across.map(place).to_vec()
                };
                Input::Faces((0..4).map(row).collect())
            },
        },
        Example {
            name: "two",
            title: Word::new(
                "a flat patch that pierces a bulging one",
                "eine ebene Fläche, die eine gewölbte durchdringt",
            ),
            input: || {
                let row = |j: usize, bulge: bool| {
                    let point = |i: usize| {
                        let is_inner = (1..3).contains(&i) && (1..3).contains(&j);
                        let z = if bulge && is_inner { 5.0 } else { 0.0 };
                        let shift = if bulge { DVec3::ZERO } else { DVec3::new(1.3, 1.4, 1.1) };
                        DVec3::new(0.2 + 1.6 * i as f64, 0.2 + 1.3 * j as f64, z) + shift
                    };
                    (0..4).map(point).collect::<Vec<_>>()
                };
                let all = [true, false].into_iter();
                Input::Faces(all.flat_map(|bulge| (0..4).map(move |j| row(j, bulge))).collect())
            },
        },
        Example::new(
            "flat",
            "a flat patch: it is flat enough at once, only its size divides it",
            "eine ebene Fläche: sofort eben genug, nur ihre Größe teilt sie",
            || bent(|i, j| (0.3 + 1.7 * i, 0.4 + 1.3 * j, -2.0)),
        ),
        Example::new(
            "small",
            "a patch as small as a few pixels",
            "eine Fläche, so klein wie wenige Pixel",
            || bent(|i, j| (2.2 + 0.5 * i, 2.3 + 0.4 * j, i * j - 3.0)),
        ),
        Example::new(
            "edge-on",
            "a patch seen from its edge: between pixels nothing is stored",
            "eine Fläche von der Kante: Zwischen Pixeln wird nichts gespeichert",
            || bent(|i, j| (0.4 + 1.8 * i, 2.05 + 0.1 * j, -2.0 * j)),
        ),
        Example::new(
            "saddle",
            "a saddle: bent both ways",
            "ein Sattel: in beide Richtungen gebogen",
            || bent(|i, j| (0.3 + 1.6 * i, 0.3 + 1.3 * j, i * (3.0 - i) - j * (3.0 - j))),
        ),
    ],
    templates: &[&CLEAR, &DROP, &DIVIDE, &UNEVEN, &MISSED, &NEARER, &FARTHER, &STORE],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

/// Returns the rows of control points of one patch, by their column and row.
fn bent(at: fn(f64, f64) -> (f64, f64, f64)) -> Input {
    let ends = [0.0, 1.0, 2.0, 3.0];
    Input::Faces(ends.map(|j| ends.map(|i| DVec3::from(at(i, j))).to_vec()).to_vec())
}

const TAKES: Word = Word::new(
    "rows of four control points, each given as a face, four rows for each patch, seen from +z",
    "Zeilen aus vier Kontrollpunkten, jede als Fläche gegeben, vier Zeilen je Flächenstück, von +z gesehen",
);

/// A coarse flatness, so that steps are few.
const FLATNESS: f64 = 0.25;

static CLEAR: Template = Template::new(
    "clear",
    "All pixels are cleared: depth ∞, no patch.",
    "Alle Pixel werden gelöscht: Tiefe ∞, kein Flächenstück.",
);
static DROP: Template = Template::new(
    "drop",
    "{patch}, {part}: no centre of a pixel is in the rectangle around it. It is dropped.",
    "{patch}, {part}: Im Rechteck darum liegt keine Pixelmitte. Es fällt weg.",
);
static DIVIDE: Template = Template::new(
    "divide",
    "{patch}, {part}: {centers} centres are in the rectangle around it. It is divided into four.",
    "{patch}, {part}: Im Rechteck darum liegen {centers} Pixelmitten. Es wird in vier geteilt.",
);
static UNEVEN: Template = Template::new(
    "divide",
    "{patch}, {part}: one centre is in the rectangle around it, but it is not flat yet. It is divided into four.",
    "{patch}, {part}: Im Rechteck darum liegt eine Pixelmitte, doch es ist noch nicht eben. Es wird in vier geteilt.",
);
static MISSED: Template = Template::new(
    "compare",
    "{patch}, {part}: the one centre, of pixel {pixel}, is beside the piece.",
    "{patch}, {part}: Die eine Mitte, die von Pixel {pixel}, liegt neben dem Stück.",
);
static NEARER: Template = Template::new(
    "compare",
    "{patch}, {part} covers the centre of pixel {pixel}: z = {depth} < {stored}.",
    "{patch}, {part} bedeckt die Mitte von Pixel {pixel}: z = {depth} < {stored}.",
);
static FARTHER: Template = Template::new(
    "compare",
    "{patch}, {part} covers the centre of pixel {pixel}: z = {depth} is not less than {stored}, nothing changes.",
    "{patch}, {part} bedeckt die Mitte von Pixel {pixel}: z = {depth} ist nicht kleiner als {stored}, nichts ändert sich.",
);
static STORE: Template = Template::new(
    "store",
    "Pixel {pixel}: depth {depth} and patch {patch} are stored.",
    "Pixel {pixel}: Tiefe {depth} und Flächenstück {patch} werden gespeichert.",
);

/// Patches on a grid, and the z-buffer so far.
#[derive(Clone)]
struct State {
    raster: Raster,
    patches: Vec<BicubicPatch>,
    stored: Vec<Option<(u32, f64)>>,
    /// The piece that the step is about, and its patch.
    piece: Option<(u32, PatchPart)>,
    pixel: Option<[u32; 2]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let rows = input.faces(TAKES)?;
    let is_whole = !rows.is_empty() && rows.len().is_multiple_of(4);
    if !is_whole || rows.iter().any(|row| row.len() != 4) {
        let value = format!("{} rows", rows.len());
        return Err(Error::parameter("input", value, TAKES.en));
    }
    let points = || rows.iter().flatten();
    let raster = Raster::around(points().map(|point| point.truncate()));
    let nearest = points().map(|point| point.z).fold(f64::NEG_INFINITY, f64::max);
    let eye = if nearest < 0.0 { 0.0 } else { nearest + 1.0 };
    let laid = |point: &DVec3| raster.at(point.truncate()).extend(eye - point.z);
    let patch = |rows: &[Vec<DVec3>]| {
        BicubicPatch::new([0, 1, 2, 3].map(|j| [0, 1, 2, 3].map(|i| laid(&rows[j][i]))))
    };
    let patches = rows.chunks(4).map(patch).collect::<Result<Vec<_>>>()?;
    let (width, height) = (raster.columns, raster.rows);
    let screen = Screen { width, height, ..Screen::default() };
    let options = Options { flatness: FLATNESS, ..Options::default() };
    let steps = record(cap, |t| render(&patches, &screen, &options, t))?;
    let stored = vec![None; (width * height) as usize];
    let mut state = State { raster, patches, stored, piece: None, pixel: None };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture())
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        self.pixel = None;
        let at = |[x, y]: [u32; 2]| ("pixel", Value::from(DVec2::new(x.into(), y.into())));
        let mut piece = |patch: u32, part: PatchPart| {
            self.piece = Some((patch, part));
            [("patch", name(patch).into()), ("part", shown(part))]
        };
        match *step {
            Step::Clear => CLEAR.with([]),
            Step::Drop { patch, part } => DROP.with(piece(patch, part)),
            Step::Divide { patch, part, centers } => {
                let [patch, part] = piece(patch, part);
                match centers {
                    1 => UNEVEN.with([patch, part]),
                    _ => DIVIDE.with([patch, part, ("centers", (centers as f64).into())]),
                }
            }
            Step::Compare { patch, part, pixel, depth, stored } => {
                let [patch, part] = piece(patch, part);
                self.pixel = Some(pixel);
                let Some(depth) = depth else { return MISSED.with([patch, part, at(pixel)]) };
                let template = if depth < stored { &NEARER } else { &FARTHER };
                let depths = [("depth", depth.into()), ("stored", stored.into())];
                let [depth, stored] = depths;
                template.with([patch, part, at(pixel), depth, stored])
            }
            Step::Store { pixel: pixel @ [x, y], patch, depth } => {
                self.pixel = Some(pixel);
                let place = y as usize * self.raster.columns as usize + x as usize;
                if let Some(stored) = self.stored.get_mut(place) {
                    *stored = Some((patch, depth));
                }
                let patch = ("patch", name(patch).into());
                STORE.with([at(pixel), ("depth", depth.into()), patch])
            }
        }
    }

    /// Returns the corners of the piece.
    fn table(&self) -> Table {
        let heads = [Word::new("corner", "Ecke"), Word::new("x, y", "x, y"), DEPTH];
        let mut table = Table::new(heads);
        let Some((patch, part)) = self.piece else { return table };
        let Some(patch) = self.patches.get(patch as usize) else { return table };
        for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let [u, v] = [part[0][u], part[1][v]];
            let point = patch.point([u, v]);
            table.row(DVec2::new(u, v), [point.truncate().into(), point.z.into()]);
        }
        table
    }

    /// Draws the z-buffer, the outlines of the patches, and the piece.
    fn picture(&self) -> Picture {
        let mut picture = self.raster.picture();
        let columns = self.raster.columns as usize;
        for (place, stored) in self.stored.iter().enumerate() {
            let Some((patch, depth)) = stored else { continue };
            let at = [(place % columns) as i32, (place / columns) as i32];
            let tenths = if columns <= 12 { (depth * 10.0).round() / 10.0 } else { f64::NAN };
            let text: Value = if tenths.is_finite() { tenths.into() } else { "".into() };
            picture.colored(at, color(*patch as usize), text);
        }
        let is_empty = |place: &usize| columns <= 12 && self.stored[*place].is_none();
        for place in (0..self.stored.len()).filter(is_empty) {
            picture.dot(middle([(place % columns) as u32, (place / columns) as u32]), Look::Grid);
        }
        for patch in &self.patches {
            picture.chain(outline(patch, [[0.0, 1.0]; 2]), Look::Window);
        }
        if let Some((patch, part)) = self.piece {
            let own = self.patches.get(patch as usize);
            own.into_iter().for_each(|patch| picture.chain(outline(patch, part), Look::Now));
        }
        if let Some(pixel) = self.pixel {
            picture.dot(middle(pixel), Look::Now);
        }
        picture
    }
}

/// Returns the border of a piece as a chain.
fn outline(patch: &BicubicPatch, [[u0, u1], [v0, v1]]: PatchPart) -> Vec<DVec2> {
    const STEPS: usize = 12;
    let corners = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]].map(DVec2::from);
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let points = sides
        .flat_map(|(a, b)| (0..STEPS).map(move |k| a.lerp(*b, k as f64 / STEPS as f64).to_array()));
    points.chain([[u0, v0]]).map(|at| patch.point(at).truncate()).collect()
}

/// Returns the parameters of a piece.
fn shown([[u0, u1], [v0, v1]]: PatchPart) -> Value {
    let all: [Value; 8] = [
        "u =".into(),
        u0.into(),
        "…".into(),
        u1.into(),
        "v =".into(),
        v0.into(),
        "…".into(),
        v1.into(),
    ];
    Value::List(all.to_vec())
}
