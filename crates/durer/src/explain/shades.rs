//! Lessons of shading: unlit, flat, Gouraud, Phong, perspective-correct values.

use super::frame::{Frames, Shown, Want, record};
use super::grid::{NO_HEAD, Raster, grey};
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3, IVec2};
use crate::raster::interpolate;
use crate::raster::interpolate::rows::{Corner, Step};
use crate::raster::triangle::Options;
use crate::shade::{flat, gouraud, phong, unlit};
use crate::trace::PseudocodeLine;
use crate::view::window::PixelRect;
use crate::{Error, Result};

pub(super) const LESSONS: &[Lesson] = &[
    super::barycentric::LESSON,
    UNLIT,
    FLAT,
    GOURAUD,
    PHONG,
    super::microfacets::LESSON,
    PERSPECTIVE,
];

const UNLIT: Lesson = Lesson {
    name: unlit::INFO.name,
    info: &unlit::INFO,
    examples: DEEP,
    templates: &[&TEXTURE, &TEXEL],
    make: |_, input, _, cap| make(Kind::Unlit, input, cap),
    ..GOURAUD
};

const FLAT: Lesson = Lesson {
    name: flat::INFO.name,
    info: &flat::INFO,
    templates: &[&ONE, &SAME],
    make: |_, input, _, cap| make(Kind::Flat, input, cap),
    ..GOURAUD
};

const GOURAUD: Lesson = Lesson {
    name: gouraud::INFO.name,
    info: &gouraud::INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&INTENSITIES, &INTENSITY],
    unreached: &[],
    make: |_, input, _, cap| make(Kind::Gouraud, input, cap),
};

const PHONG: Lesson = Lesson {
    name: phong::INFO.name,
    info: &phong::INFO,
    templates: &[&NORMALS, &LIT],
    make: |_, input, _, cap| make(Kind::Phong, input, cap),
    ..GOURAUD
};

const PERSPECTIVE: Lesson = Lesson {
    name: interpolate::INFO.name,
    info: &interpolate::INFO,
    examples: DEEP,
    templates: &[&QUOTIENTS, &QUOTIENT],
    make: |_, input, _, cap| make(Kind::Perspective, input, cap),
    ..GOURAUD
};

const TAKES: Word = Word::new(
    "a face of three points, seen from +z",
    "eine Fläche aus drei Punkten, von +z gesehen",
);

const EXAMPLES: &[Example] = &[
    Example {
        name: "highlight",
        title: Word::new(
            "the highlight lies between the corners",
            "das Glanzlicht liegt zwischen den Ecken",
        ),
        input: || face([(0.0, 0.0, 0.0), (11.0, 1.0, 0.0), (4.0, 8.0, 0.0)]),
    },
    Example {
        name: "corner",
        title: Word::new("a corner turned to the light", "eine Ecke zum Licht gewandt"),
        input: || face([(1.0, 8.0, 0.0), (0.0, 2.0, 0.0), (8.0, 0.0, 0.0)]),
    },
    Example::new(
        "tilted",
        "tilted in depth: only the normal of the face changes",
        "in die Tiefe gekippt: nur die Normale der Fläche ändert sich",
        || face([(0.0, 0.0, 0.0), (11.0, 1.0, -9.0), (4.0, 8.0, -2.0)]),
    ),
    Example::new(
        "other-order",
        "the corners in the other order: the same pixels",
        "die Ecken in der anderen Reihenfolge: dieselben Pixel",
        || face([(0.0, 0.0, 0.0), (4.0, 8.0, 0.0), (11.0, 1.0, 0.0)]),
    ),
    Example::new(
        "level-side",
        "a level side: the lowest row runs from corner to corner",
        "eine waagrechte Seite: Die unterste Zeile läuft von Ecke zu Ecke",
        || face([(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (3.0, 6.0, 0.0)]),
    ),
    Example::new(
        "sliver",
        "a sliver: few pixels, and rows without any",
        "ein Splitter: wenige Pixel und Zeilen ohne eines",
        || face([(0.0, 0.0, 0.0), (12.0, 4.0, 0.0), (6.0, 1.6, 0.0)]),
    ),
];

const DEEP: &[Example] = &[
    Example {
        name: "one-to-four",
        title: Word::new(
            "the second corner is four times as far",
            "die zweite Ecke ist viermal so weit",
        ),
        input: || face([(0.0, 0.0, -1.0), (11.0, 1.0, -4.0), (4.0, 8.0, -1.0)]),
    },
    Example {
        name: "parallel",
        title: Word::new(
            "all corners equally far: linear is right",
            "alle Ecken gleich weit: linear ist richtig",
        ),
        input: || face([(0.0, 0.0, -2.0), (11.0, 1.0, -2.0), (4.0, 8.0, -2.0)]),
    },
    Example::new(
        "slight",
        "one corner a little farther: the error is small",
        "eine Ecke etwas weiter: Der Fehler ist klein",
        || face([(0.0, 0.0, -4.0), (11.0, 1.0, -5.0), (4.0, 8.0, -4.0)]),
    ),
    Example::new(
        "extreme",
        "forty times as far: half of u lies in the last pixels",
        "vierzigmal so weit: Die Hälfte von u liegt in den letzten Pixeln",
        || face([(0.0, 0.0, -1.0), (11.0, 1.0, -40.0), (4.0, 8.0, -1.0)]),
    ),
    Example::new(
        "by-rows",
        "depth grows with the rows only: each row is linear",
        "die Tiefe wächst nur mit den Zeilen: Jede Zeile ist linear",
        || face([(0.0, 0.0, -1.0), (10.0, 0.0, -1.0), (5.0, 8.0, -4.0)]),
    ),
    Example::new("sliver", "a sliver into the depth", "ein Splitter in die Tiefe", || {
        face([(0.0, 0.0, -1.0), (12.0, 4.0, -6.0), (6.0, 1.6, -2.0)])
    }),
];

static TEXTURE: Template = Template::new(
    "ends",
    "Row {row}: along the edges u/w is {a} at x = {x0} and {b} at x = {x1}. Normals and lights play no part.",
    "Zeile {row}: Längs der Kanten ist u/w {a} bei x = {x0} und {b} bei x = {x1}. Normalen und Lichter zählen nicht.",
);
static TEXEL: Template = Template::new(
    "pixel",
    "Pixel {pixel}: u = {u}, the texel there is {texel}; times the base colour {base} it is {value}.",
    "Pixel {pixel}: u = {u}, das Texel dort ist {texel}; mal der Grundfarbe {base} gibt das {value}.",
);
static ONE: Template = Template::new(
    "ends",
    "Row {row} from x = {x0} to x = {x1}: all of the face has the intensity at its centre, {a}.",
    "Zeile {row} von x = {x0} bis x = {x1}: Die ganze Fläche hat die Helligkeit ihrer Mitte, {a}.",
);
static SAME: Template = Template::new(
    "pixel",
    "Pixel {pixel}: {value}, as everywhere on the face; nothing is interpolated.",
    "Pixel {pixel}: {value}, wie überall auf der Fläche; nichts wird interpoliert.",
);
static INTENSITIES: Template = Template::new(
    "ends",
    "Row {row}: along the edges the intensities are {a} at x = {x0} and {b} at x = {x1}.",
    "Zeile {row}: Längs der Kanten sind die Helligkeiten {a} bei x = {x0} und {b} bei x = {x1}.",
);
static INTENSITY: Template = Template::new(
    "pixel",
    "Pixel {pixel}: between them the intensity is {value}; no light is calculated.",
    "Pixel {pixel}: Dazwischen ist die Helligkeit {value}; kein Licht wird berechnet.",
);
static NORMALS: Template = Template::new(
    "ends",
    "Row {row}: along the edges the normals are {a} at x = {x0} and {b} at x = {x1}.",
    "Zeile {row}: Längs der Kanten sind die Normalen {a} bei x = {x0} und {b} bei x = {x1}.",
);
static LIT: Template = Template::new(
    "pixel",
    "Pixel {pixel}: the normal {before} is {length} long, after division {normal}; it is lit: {value}.",
    "Pixel {pixel}: Die Normale {before} ist {length} lang, nach der Division {normal}; beleuchtet: {value}.",
);
static QUOTIENTS: Template = Template::new(
    "ends",
    "Row {row}: along the edges u/w is {a} at x = {x0} and {b} at x = {x1}, 1/w is {w0} and {w1}.",
    "Zeile {row}: Längs der Kanten ist u/w {a} bei x = {x0} und {b} bei x = {x1}, 1/w ist {w0} und {w1}.",
);
static QUOTIENT: Template = Template::new(
    "pixel",
    "Pixel {pixel}: u/w = {over}, 1/w = {inv}, so u = {value}; linear on the screen it would be {linear}.",
    "Pixel {pixel}: u/w = {over}, 1/w = {inv}, also u = {value}; linear am Schirm wäre es {linear}.",
);

fn face(corners: [(f64, f64, f64); 3]) -> Input {
    Input::Faces(vec![corners.map(DVec3::from).to_vec()])
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Unlit,
    Flat,
    Gouraud,
    Phong,
    Perspective,
}

/// Direction to the light, from the upper left before the picture, 3 : 4 : 12 of 13.
const LIGHT: DVec3 = DVec3::new(-3.0 / 13.0, 4.0 / 13.0, 12.0 / 13.0);

/// Returns ambient, diffuse and specular light, seen along z.
fn light(normal: DVec3) -> f64 {
    let cosine = normal.dot(LIGHT);
    let mirrored = normal * (2.0 * cosine) - LIGHT;
    let shine = if cosine > 0.0 { mirrored.z.max(0.0) } else { 0.0 };
    // To the 16th.
    let gloss = [0; 4].iter().fold(shine, |power, _| power * power);
    (0.1 + 0.6 * cosine.max(0.0) + 0.3 * gloss).min(1.0)
}

/// Base colour of the unlit face, grey.
const BASE: f64 = 0.9;

/// Returns the texel at u of a texture with four stripes.
fn texel(u: f64) -> f64 {
    if (u * 4.0).floor() % 2.0 == 0.0 { 1.0 } else { 0.4 }
}

/// Value of texture coordinates at the corners.
const COORDINATES: [f64; 3] = [0.0, 1.0, 0.0];

/// A triangle and its pixels so far.
#[derive(Clone)]
struct State {
    kind: Kind,
    raster: Raster,
    corners: [Corner; 3],
    pixels: Vec<(IVec2, f64)>,
}

fn make(kind: Kind, input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(TAKES)?;
    let Some(&[a, b, c]) = faces.first().map(Vec::as_slice) else {
        return Err(Error::parameter("input", "without a face of three points", TAKES.en));
    };
    let points = [a, b, c];
    let raster = Raster::around(points.map(|p| p.truncate()));
    let corners = corners(kind, &raster, points);
    let (width, height) = (raster.columns as i32, raster.rows as i32);
    let options = Options { clip: PixelRect::spanning(0, 0, width, height) };
    let steps = record(cap, |t| interpolate::rows::interpolate(&corners, &options, |_, _| {}, t))?;
    let mut state = State { kind, raster, corners, pixels: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns corners with what is interpolated: normals lean outwards, as on a ball.
fn corners(kind: Kind, raster: &Raster, points: [DVec3; 3]) -> [Corner; 3] {
    let at = points.map(|p| raster.at(p.truncate()));
    let middle = at.iter().sum::<DVec2>() / 3.0;
    let reach = at.iter().map(|p| p.distance(middle)).fold(1.0, f64::max);
    let nearest = points.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    let eye = if nearest < 0.0 { 0.0 } else { nearest + 1.0 };
    let face = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or(DVec3::Z);
    let face = if face.z < 0.0 { -face } else { face };
    std::array::from_fn(|k| {
        let normal = ((at[k] - middle) / reach).extend(1.0).normalize();
        let (inv_w, value) = match kind {
            Kind::Flat => (1.0, DVec3::splat(light(face))),
            Kind::Gouraud => (1.0, DVec3::splat(light(normal))),
            Kind::Phong => (1.0, normal),
            Kind::Perspective | Kind::Unlit => {
                (1.0 / (eye - points[k].z), DVec3::splat(COORDINATES[k]))
            }
        };
        Corner { at: at[k], inv_w, value }
    })
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(step), || self.picture(step))
    }

    /// Returns a value as it is shown: a normal, or a number.
    fn value(&self, value: DVec3) -> Value {
        if self.kind == Kind::Phong { value.into() } else { value.x.into() }
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Ends { y, x: [x0, x1], inv_w: [w0, w1], over_w: [a, b] } => {
                let [a, b] = [("a", self.value(a)), ("b", self.value(b))];
                let [row, x0, x1] = [("row", y.into()), ("x0", x0.into()), ("x1", x1.into())];
                match self.kind {
                    Kind::Unlit => TEXTURE.with([row, a, b, x0, x1]),
                    Kind::Flat => ONE.with([row, a, x0, x1]),
                    Kind::Gouraud => INTENSITIES.with([row, a, b, x0, x1]),
                    Kind::Phong => NORMALS.with([row, a, b, x0, x1]),
                    Kind::Perspective => {
                        QUOTIENTS.with([row, a, b, x0, x1, ("w0", w0.into()), ("w1", w1.into())])
                    }
                }
            }
            Step::Pixel { pixel, inv_w, over_w, value } => {
                let at = ("pixel", pixel.as_dvec2().into());
                let normal = value.normalize_or_zero();
                let shown = match self.kind {
                    Kind::Phong => light(normal),
                    Kind::Unlit => BASE * texel(value.x),
                    Kind::Flat | Kind::Gouraud | Kind::Perspective => value.x,
                };
                self.pixels.push((pixel, shown));
                let result = ("value", shown.into());
                match self.kind {
                    Kind::Unlit => TEXEL.with([
                        at,
                        ("u", value.x.into()),
                        ("texel", texel(value.x).into()),
                        ("base", BASE.into()),
                        result,
                    ]),
                    Kind::Flat => SAME.with([at, result]),
                    Kind::Gouraud => INTENSITY.with([at, result]),
                    Kind::Phong => {
                        let length = ("length", value.length().into());
                        LIT.with([
                            at,
                            ("before", value.into()),
                            length,
                            ("normal", normal.into()),
                            result,
                        ])
                    }
                    Kind::Perspective => {
                        let linear = ("linear", self.linear(pixel).into());
                        let (over, inv) = (("over", over_w.x.into()), ("inv", inv_w.into()));
                        QUOTIENT.with([at, over, inv, result, linear])
                    }
                }
            }
        }
    }

    /// Returns the value that linear interpolation on the screen would give.
    fn linear(&self, pixel: IVec2) -> f64 {
        let points = self.corners.map(|corner| corner.at);
        let weights = interpolate::barycentric_2d(points, pixel.as_dvec2() + 0.5);
        weights.map_or(0.0, |weights| interpolate::blend(weights, self.corners.map(|c| c.value.x)))
    }

    fn table(&self, step: &Step) -> Table {
        let mut table = Table::new([NO_HEAD, Word::new("x", "x"), Word::new("value", "Wert")]);
        let names = ["A", "B", "C"];
        for (name, corner) in names.into_iter().zip(&self.corners) {
            table.row(name, [corner.at.x.into(), self.value(corner.value)]);
        }
        match *step {
            Step::Ends { x, inv_w, over_w, .. } => {
                let sides = [Word::new("left", "links"), Word::new("right", "rechts")];
                for (k, side) in sides.into_iter().enumerate() {
                    table.row(side, [x[k].into(), self.value(over_w[k] / inv_w[k])]);
                }
            }
            Step::Pixel { pixel, value, .. } => {
                table.row(Word::new("pixel", "Pixel"), [pixel.x.into(), self.value(value)]);
            }
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.raster.picture();
        for (pixel, value) in &self.pixels {
            picture.colored(pixel.to_array(), grey(1.0 - value), "");
        }
        let points = self.corners.map(|corner| corner.at);
        picture.chain([points[0], points[1], points[2], points[0]], Look::Second);
        for (name, corner) in ["A", "B", "C"].into_iter().zip(&self.corners) {
            picture.named(corner.at, name, Look::Second);
        }
        match *step {
            Step::Ends { y, x, .. } => {
                let ends = x.map(|x| DVec2::new(x, f64::from(y) + 0.5));
                picture.chain(ends, Look::Now);
                ends.into_iter().for_each(|end| picture.dot(end, Look::First));
            }
            Step::Pixel { pixel, .. } => picture.dot(pixel.as_dvec2() + 0.5, Look::Now),
        }
        picture
    }
}
