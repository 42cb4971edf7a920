//! The lesson of mip maps: a face in perspective, each pixel with its level of detail.

use super::{BILINEAR, DIVIDED, OPAQUE, VALUE, WRAPPED};
use super::{bilinear, divided, grey, image, nearest, number, pair, shade, wrapped};
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::{NO_HEAD, Raster, center, shown};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3, IVec2, Rect, Vec2};
use crate::raster::interpolate::rows::{Corner, interpolate};
use crate::raster::interpolate::{barycentric_2d, blend};
use crate::raster::triangle::Options;
use crate::scene::{Image, MipFilter, Sampler, TextureFilter, Wrap};
use crate::shade::texture::{MIP_MAP, Step, Usage};
use crate::shade::{PreparedTexture, TexCoord};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::view::window::PixelRect;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: MIP_MAP.name,
    info: &MIP_MAP,
    takes: TAKES,
    examples: &[
        Example {
            name: "into-depth",
            title: Word::new(
                "the second corner is four times as far",
                "die zweite Ecke ist viermal so weit",
            ),
            input: || face([(0.0, 0.0, -1.0), (9.0, 1.0, -4.0), (2.0, 6.0, -1.0)]),
        },
        Example {
            name: "parallel",
            title: Word::new(
                "all corners equally far: one level of detail",
                "alle Ecken gleich weit: eine Detailstufe",
            ),
            input: || face([(0.0, 0.0, -2.0), (6.0, 0.0, -2.0), (0.0, 4.0, -2.0)]),
        },
        Example::new(
            "one-texel",
            "one texel a pixel: the image itself",
            "ein Texel je Pixel: das Bild selbst",
            || face([(0.0, 0.0, -2.0), (12.0, 0.0, -2.0), (0.0, 4.0, -2.0)]),
        ),
        Example::new(
            "across",
            "depth across the image: the longer way decides",
            "die Tiefe quer zum Bild: Der längere Weg entscheidet",
            || face([(0.0, 0.0, -1.0), (6.0, 0.0, -1.0), (1.0, 5.0, -6.0)]),
        ),
        Example::new(
            "far-corner",
            "sixteen times as far: up to the last level",
            "sechzehnmal so weit: bis zur letzten Stufe",
            || face([(0.0, 0.0, -1.0), (8.0, 1.0, -16.0), (1.0, 5.0, -1.0)]),
        ),
        Example::new(
            "tiny",
            "a few pixels for the whole image: one mean value",
            "wenige Pixel für das ganze Bild: ein Mittelwert",
            || face([(0.0, 0.0, -2.0), (2.4, 0.2, -2.0), (0.2, 2.4, -2.0)]),
        ),
    ],
    templates: &[&PIXEL, &MAGNIFIED, &ONE, &TWO, &WRAPPED, &BILINEAR, &BETWEEN, &DIVIDED],
    unreached: &[OPAQUE],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "a face of three points, seen from +z",
    "eine Fläche aus drei Punkten, von +z gesehen",
);

fn face(corners: [(f64, f64, f64); 3]) -> Input {
    Input::Faces(vec![corners.map(DVec3::from).to_vec()])
}

static PIXEL: Template = Template::new(
    "pixel",
    "Pixel {pixel}: (u, v) = {uv}; to the right of it {right}, below it {below}.",
    "Pixel {pixel}: (u; v) = {uv}; rechts davon {right}, darunter {below}.",
);
static MAGNIFIED: Template = Template::new(
    "detail",
    "The neighbours are {x} and {y} texels away; the longer way is ρ = {rho}, so λ = log2 ρ = {lod}: the image itself suffices.",
    "Die Nachbarn sind {x} und {y} Texel entfernt; der längere Weg ist ρ = {rho}, also λ = log2 ρ = {lod}: Das Bild selbst genügt.",
);
static ONE: Template = Template::new(
    "detail",
    "The neighbours are {x} and {y} texels away; the longer way is ρ = {rho}, so λ = log2 ρ = {lod}: level {level}, the last one.",
    "Die Nachbarn sind {x} und {y} Texel entfernt; der längere Weg ist ρ = {rho}, also λ = log2 ρ = {lod}: Stufe {level}, die letzte.",
);
static TWO: Template = Template::new(
    "detail",
    "The neighbours are {x} and {y} texels away; the longer way is ρ = {rho}, so λ = log2 ρ = {lod}: levels {level} and {next}, the second with the weight {weight}.",
    "Die Nachbarn sind {x} und {y} Texel entfernt; der längere Weg ist ρ = {rho}, also λ = log2 ρ = {lod}: Stufen {level} und {next}, die zweite mit dem Gewicht {weight}.",
);
static BETWEEN: Template = Template::new(
    "between",
    "{rest} · {near} + {weight} · {far} = {value}: the value of the pixel, between the levels.",
    "{rest} · {near} + {weight} · {far} = {value}: der Wert des Pixels, zwischen den Stufen.",
);

/// Columns and rows of the image.
const SIDE: u32 = 8;

/// Sizes of the levels.
const SIZES: [u32; 4] = [8, 4, 2, 1];

/// Texture coordinates of the corners.
const COORDINATES: [DVec2; 3] = [DVec2::new(0.0, 0.0), DVec2::new(1.5, 0.0), DVec2::new(0.0, 0.5)];

/// Returns the image: a chequer of two by two texels, darker on the right, so that each level differs from the next.
fn chequer() -> Image {
    let texel = |x: u32, y: u32| {
        let high = (x / 2 + y / 2).is_multiple_of(2);
        [[0, 51, 102][x as usize / 3], [255, 204, 153][x as usize / 3]][usize::from(high)]
    };
    let rows: Vec<[u8; SIDE as usize]> =
        (0..SIDE).map(|y| std::array::from_fn(|x| texel(x as u32, y))).collect();
    image(&rows)
}

/// Step of the lesson: the coordinates of a pixel, or a step of its sample.
#[derive(Debug, Clone, Copy)]
enum Taken {
    Pixel(IVec2, TexCoord),
    Sample(Step),
}

impl Taken {
    fn line(&self) -> usize {
        match self {
            Self::Pixel(..) => 1,
            Self::Sample(step) => step.line(),
        }
    }
}

/// Tracer that adds the steps of a sample to those of the lesson.
struct Sampling<'a, T>(&'a mut T);

impl<T: Tracer<Taken>> Tracer<Step> for Sampling<'_, T> {
    fn step(&mut self, make: impl FnOnce() -> Step) {
        self.0.step(|| Taken::Sample(make()));
    }
}

/// The face, the levels, and the samples so far.
#[derive(Clone)]
struct State {
    raster: Raster,
    corners: [DVec2; 3],
    /// Values of the texels of each level.
    levels: Vec<Vec<f64>>,
    pixels: Vec<(IVec2, f64)>,
    pixel: Option<IVec2>,
    /// Values of the levels of the pixel, the last one last.
    values: [f64; 2],
    /// Rows of the table: what is known of the pixel.
    known: Vec<(Word, Value)>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(TAKES)?;
    let Some(&[a, b, c]) = faces.first().map(Vec::as_slice) else {
        return Err(Error::parameter("input", "without a face of three points", TAKES.en));
    };
    let points = [a, b, c];
    let raster = Raster::around(points.map(|p| p.truncate()));
    let corners = points.map(|p| raster.at(p.truncate()));
    let nearest = points.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    let eye = if nearest < 0.0 { 0.0 } else { nearest + 1.0 };
    let corner = |k: usize| {
        let inv_w = 1.0 / (eye - points[k].z);
        Corner { at: corners[k], inv_w, value: COORDINATES[k].extend(0.0) }
    };
    let own = std::array::from_fn(corner);
    let image = chequer();
    let texture = PreparedTexture::new(&image, SAMPLER, Usage::Data);
    let steps = record(cap, |t| run(&own, &raster, &texture, t))?;
    let levels = levels(&texture);
    let mut state = State {
        raster,
        corners,
        levels,
        pixels: Vec::new(),
        pixel: None,
        values: [0.0; 2],
        known: Vec::new(),
    };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Bilinear within levels, linear between them.
const SAMPLER: Sampler = Sampler {
    mag: TextureFilter::Linear,
    min: TextureFilter::Linear,
    mip: MipFilter::Linear,
    wrap_u: Wrap::Repeat,
    wrap_v: Wrap::Repeat,
};

/// Samples the texture at each pixel of the face.
fn run(
    corners: &[Corner; 3],
    raster: &Raster,
    texture: &PreparedTexture<'_>,
    t: &mut impl Tracer<Taken>,
) -> Result<()> {
    let clip = PixelRect::spanning(0, 0, raster.columns as i32, raster.rows as i32);
    let mut pixels = Vec::new();
    interpolate(
        corners,
        &Options { clip },
        |pixel, value| pixels.push((pixel, value)),
        &mut NoTrace,
    )?;
    for (pixel, value) in pixels {
        let uv = value.truncate();
        // Rows are counted upwards here.
        let [right, below] = [DVec2::X, DVec2::NEG_Y].map(|way| at(corners, center(pixel) + way));
        let [ddx, ddy] = [right, below].map(|there| (there.unwrap_or(uv) - uv).as_vec2());
        let place = TexCoord { uv: uv.as_vec2(), ddx, ddy };
        t.step(|| Taken::Pixel(pixel, place));
        texture.sample_traced(place.uv, ddx, ddy, &mut Sampling(t));
    }
    Ok(())
}

/// Returns the texture coordinates at a point of the screen; `None` where the plane of the face is behind the eye.
fn at(corners: &[Corner; 3], p: DVec2) -> Option<DVec2> {
    let weights = barycentric_2d(corners.map(|corner| corner.at), p)?;
    let inv_w = blend(weights, corners.map(|corner| corner.inv_w));
    let over_w = blend(weights, corners.map(|corner| corner.value * corner.inv_w));
    (inv_w > 0.0).then(|| over_w.truncate() / inv_w)
}

/// Returns the values of the texels of each level, sampled at their centres.
fn levels(texture: &PreparedTexture<'_>) -> Vec<Vec<f64>> {
    let level = |size: u32| {
        // A way as long as one of its texels selects the level alone.
        let way = Vec2::new(1.0 / size as f32, 0.0);
        let middle = |i: u32| (i as f32 + 0.5) / size as f32;
        let texels = (0..size * size).map(|i| Vec2::new(middle(i % size), middle(i / size)));
        texels.map(|uv| grey(texture.sample(uv, way, Vec2::ZERO))).collect()
    };
    SIZES.into_iter().map(level).collect()
}

impl State {
    fn show(&mut self, step: &Taken, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Taken) -> Caption {
        let step = match step {
            Taken::Pixel(pixel, at) => return self.begin(*pixel, at),
            Taken::Sample(step) => step,
        };
        match *step {
            Step::Detail { ways: [x, y], lod, level, weight, .. } => {
                let rho = x.length().max(y.length());
                self.known.push((Word::new("ρ", "ρ"), number(rho)));
                self.known.push((Word::new("λ", "λ"), number(lod)));
                let [x, y] = [x, y].map(|way| number(way.length()));
                let all = [("x", x), ("y", y), ("rho", number(rho)), ("lod", number(lod))];
                let [x, y, rho, lod_value] = all;
                let first = ("level", level.into());
                match weight {
                    Some(weight) => {
                        let next = ("next", (level + 1).into());
                        let weight = ("weight", number(weight));
                        TWO.with([x, y, rho, lod_value, first, next, weight])
                    }
                    None if lod <= 0.0 => MAGNIFIED.with([x, y, rho, lod_value]),
                    None => ONE.with([x, y, rho, lod_value, first]),
                }
            }
            Step::Wrapped { level, size, from, to } => {
                wrapped(Word::new("repeat", "wiederholen"), level, size, [from, to])
            }
            Step::Nearest { level, texel, value } => {
                self.keep(level, grey(value));
                nearest(texel, value)
            }
            Step::Bilinear { level, fractions, values, value, .. } => {
                self.keep(level, grey(value));
                bilinear(fractions, values, value)
            }
            Step::Between { weight, value } => {
                self.known.push((VALUE, number(value.x)));
                if let Some(last) = self.pixels.last_mut() {
                    last.1 = grey(value);
                }
                let [near, far] = self.values.map(Value::from);
                BETWEEN.with([
                    ("rest", number(1.0 - weight)),
                    ("near", near),
                    ("weight", number(weight)),
                    ("far", far),
                    ("value", number(value.x)),
                ])
            }
            Step::Divided(value) => divided(value),
        }
    }

    /// Begins a pixel.
    fn begin(&mut self, pixel: IVec2, at: &TexCoord) -> Caption {
        self.pixel = Some(pixel);
        self.known = vec![
            (Word::new("pixel", "Pixel"), shown(pixel)),
            (Word::new("(u, v)", "(u; v)"), pair(at.uv)),
        ];
        PIXEL.with([
            ("pixel", shown(pixel)),
            ("uv", pair(at.uv)),
            ("right", pair(at.uv + at.ddx)),
            ("below", pair(at.uv + at.ddy)),
        ])
    }

    /// Keeps the value of a level: that of the pixel unless another level follows.
    fn keep(&mut self, level: usize, value: f64) {
        self.values = [self.values[1], value];
        let name = LEVELS.get(level).copied().unwrap_or_default();
        self.known.push((name, value.into()));
        let Some(pixel) = self.pixel else { return };
        match self.pixels.last_mut() {
            Some(last) if last.0 == pixel => last.1 = value,
            _ => self.pixels.push((pixel, value)),
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([NO_HEAD, VALUE]);
        for (name, value) in &self.known {
            table.row(*name, [value.clone()]);
        }
        table
    }

    /// Draws the pixels on the left and the levels on the right.
    fn picture(&self, step: &Taken) -> Picture {
        let mut picture = self.raster.picture();
        let rows = self.raster.rows.max(SIDE);
        let end = f64::from(self.raster.columns) + 2.0 + f64::from(SIDE) + 5.0;
        picture.extent[1] = DVec2::new(end + 0.2, f64::from(rows) + 0.2);
        for (pixel, value) in &self.pixels {
            picture.colored(pixel.to_array(), shade(*value), "");
        }
        let [a, b, c] = self.corners;
        picture.chain([a, b, c, a], Look::Second);
        for (name, corner) in ["A", "B", "C"].into_iter().zip(self.corners) {
            picture.named(corner, name, Look::Second);
        }
        if let Some(pixel) = self.pixel {
            picture.dot(center(pixel), Look::Now);
        }
        for (level, values) in self.levels.iter().enumerate() {
            let size = SIZES[level];
            for (i, value) in (0..).zip(values) {
                picture.colored(self.cell(level, [i % size, i / size]), shade(*value), "");
            }
        }
        match *step {
            Taken::Sample(Step::Wrapped { level, size: [w, h], to, .. }) => {
                let [x, y] = self.cell(level, [0, 0]).map(f64::from);
                let place = to.as_dvec2() * DVec2::new(w.into(), h.into());
                picture.dot(DVec2::new(x + place.x, y + 1.0 - place.y), Look::Now);
            }
            Taken::Sample(Step::Bilinear { level, texels, .. }) => {
                for texel in texels {
                    let low = IVec2::from(self.cell(level, texel)).as_dvec2();
                    if let Ok(cell) = Rect::new(low, low + 1.0) {
                        picture.frame(&cell, Look::Now);
                    }
                }
            }
            Taken::Pixel(..) | Taken::Sample(_) => {}
        }
        picture
    }

    /// Returns the cell in which a texel of a level is drawn: the image, and to the right of it the smaller levels from
    /// the top down. Rows of texels count downwards.
    fn cell(&self, level: usize, [column, row]: [u32; 2]) -> [i32; 2] {
        let rows = self.raster.rows.max(SIDE) as i32;
        let first = self.raster.columns as i32 + 2;
        let (x, top) = match level {
            0 => (first, rows),
            1 => (first + SIDE as i32 + 1, rows),
            2 => (first + SIDE as i32 + 1, rows - 5),
            _ => (first + SIDE as i32 + 4, rows - 5),
        };
        [x + column as i32, top - 1 - row as i32]
    }
}

/// Names of the levels.
const LEVELS: [Word; 4] = [
    Word::new("level 0", "Stufe 0"),
    Word::new("level 1", "Stufe 1"),
    Word::new("level 2", "Stufe 2"),
    Word::new("level 3", "Stufe 3"),
];
