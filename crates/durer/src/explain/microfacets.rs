//! The lesson of the metallic-roughness formula: one light on one point, term by term.

use super::frame::{Frames, Numbered, Shown, Want, record};
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, Vec3};
use crate::shade::metallic_roughness::{INFO, Lit, Step, reflect_one};
use crate::trace::{NoTrace, PseudocodeLine};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example::new(
            "plastic-and-metal",
            "the same roughness as plastic and as metal",
            "dieselbe Rauheit als Kunststoff und als Metall",
            || point((-3.0, 4.0), (3.0, 4.0), &[(0.5, 0.0), (0.5, 1.0)]),
        ),
        Example::new(
            "three-roughnesses",
            "beside the mirrored direction: smooth, satin, rough",
            "neben der gespiegelten Richtung: glatt, seidig, rau",
            || point((-3.0, 4.0), (0.0, 1.0), &[(0.2, 0.0), (0.5, 0.0), (1.0, 0.0)]),
        ),
        Example::new(
            "grazing",
            "at a grazing angle plastic is a mirror, too",
            "im flachen Winkel spiegelt auch Kunststoff",
            || point((-12.0, 1.0), (12.0, 1.0), &[(0.3, 0.0)]),
        ),
        Example::new(
            "straight-on",
            "light, eye and normal in one direction: F = F0",
            "Licht, Auge und Normale in einer Richtung: F = F0",
            || point((0.0, 1.0), (0.0, 1.0), &[(1.0, 0.0), (1.0, 1.0)]),
        ),
        Example::new(
            "half-metal",
            "between plastic and metal: both parts",
            "zwischen Kunststoff und Metall: beide Anteile",
            || point((-3.0, 4.0), (5.0, 12.0), &[(0.4, 0.5)]),
        ),
        Example::new(
            "behind",
            "the light is behind the surface",
            "das Licht ist hinter der Fläche",
            || point((-4.0, -3.0), (3.0, 4.0), &[(0.5, 0.0)]),
        ),
    ],
    templates: &[&COSINES, &DISTRIBUTION, &VISIBILITY, &FRESNEL, &DIFFUSE, &METAL, &SUM, &DARK],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "a line from the surface to the light, one to the eye, the normal upwards; and points (roughness, metalness) from 0 to 1",
    "eine Strecke von der Fläche zum Licht, eine zum Auge, die Normale nach oben; dazu Punkte (Rauheit; Metallanteil) von 0 bis 1",
);

/// Returns an input from directions to the light and the eye, and from roughnesses with metalnesses.
fn point(light: (f64, f64), eye: (f64, f64), surfaces: &[(f64, f64)]) -> Input {
    let line = |to: (f64, f64)| vec![DVec2::ZERO, DVec2::from(to)];
    let points = surfaces.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { lines: vec![line(light), line(eye)], points, ..Figure::default() })
}

static COSINES: Template = Template::new(
    "cosines",
    "Roughness {roughness}, metalness {metallic}. With h halfway between l and v: n·l = {nl}, n·v = {nv}, n·h = {nh}, v·h = {vh}.",
    "Rauheit {roughness}, Metallanteil {metallic}. Mit h auf halbem Weg zwischen l und v: n·l = {nl}, n·v = {nv}, n·h = {nh}, v·h = {vh}.",
);
static DISTRIBUTION: Template = Template::new(
    "distribution",
    "α = roughness² = {alpha}, so D = α² / ((n·h)² (α² − 1) + 1)² = {value}, the density of the facets that face h, times π.",
    "α = Rauheit² = {alpha}, also D = α² / ((n·h)² (α² − 1) + 1)² = {value}, die Dichte der Facetten, die nach h zeigen, mal π.",
);
static VISIBILITY: Template = Template::new(
    "visibility",
    "V = {value}: with n·l = {nl} and n·v = {nv}, facets are hidden from the light or from the eye by others.",
    "V = {value}: Bei n·l = {nl} und n·v = {nv} sind Facetten dem Licht oder dem Auge durch andere verdeckt.",
);
static FRESNEL: Template = Template::new(
    "fresnel",
    "F0 = {straight}, F90 = {grazing}, with what is reflected more than once; (1 − v·h)⁵ = {away}, so F = {value}.",
    "F0 = {straight}, F90 = {grazing}, mit dem mehrfach Gespiegelten; (1 − v·h)⁵ = {away}, also F = {value}.",
);
static DIFFUSE: Template = Template::new(
    "diffuse",
    "{through} of the light enters the dielectric part and comes back in all directions: (1 − {metallic}) · {base} · {through} = {value}.",
    "{through} des Lichts dringt in den Anteil ohne Metall ein und kommt nach allen Seiten zurück: (1 − {metallic}) · {base} · {through} = {value}.",
);
static METAL: Template = Template::new(
    "diffuse",
    "A metal lets no light in: there is no diffuse part.",
    "Ein Metall lässt kein Licht ein: Es gibt keinen diffusen Anteil.",
);
static SUM: Template = Template::new(
    "sum",
    "n·l · (diffuse + D · V · F) = {nl} · ({diffuse} + {dv} · {fresnel}) = {value}.",
    "n·l · (diffus + D · V · F) = {nl} · ({diffuse} + {dv} · {fresnel}) = {value}.",
);
static DARK: Template = Template::new(
    "sum",
    "n·l = 0: the light is behind the surface, and nothing is reflected.",
    "n·l = 0: Das Licht ist hinter der Fläche, nichts wird gespiegelt.",
);

/// Base colour of the surfaces.
const BASE: Vec3 = Vec3::new(0.9, 0.6, 0.4);

/// The surfaces, and the terms of the current one.
#[derive(Clone)]
struct State {
    surfaces: Vec<Lit>,
    cosines: [f32; 4],
    distribution: Option<f32>,
    visibility: Option<f32>,
    fresnel: Option<Vec3>,
    diffuse: Option<Vec3>,
    sums: Vec<Vec3>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let way = |line: &Vec<DVec2>| Some((*line.last()? - *line.first()?).normalize_or_zero());
    let mut ways = figure.lines.iter().filter_map(way).filter(|way| *way != DVec2::ZERO);
    let missing = |what: &str| Error::parameter("input", format!("without {what}"), TAKES.en);
    let [Some(light), Some(eye)] = [ways.next(), ways.next()] else {
        return Err(missing("two lines"));
    };
    let vector = |way: DVec2| way.extend(0.0).as_vec3();
    let surface = |p: &DVec2| Lit {
        base: BASE,
        metallic: p.y.clamp(0.0, 1.0) as f32,
        roughness: p.x.clamp(0.0, 1.0) as f32,
        normal: Vec3::Y,
        to_eye: vector(eye),
        to_light: vector(light),
    };
    let surfaces: Vec<Lit> = figure.points.iter().map(surface).collect();
    if surfaces.is_empty() {
        return Err(missing("a point"));
    }
    let steps = record(cap, |t| {
        for (number, surface) in surfaces.iter().enumerate() {
            reflect_one(surface, &mut Numbered { number, t: &mut *t });
        }
        Ok(())
    })?;
    let mut state = State {
        surfaces,
        cosines: [0.0; 4],
        distribution: None,
        visibility: None,
        fresnel: None,
        diffuse: None,
        sums: Vec::new(),
    };
    Ok(Frames::new(steps, move |(number, step), want| state.show(*number, step, want)))
}

/// Returns a number with the digits that are shown.
fn short(x: f32) -> Value {
    ((f64::from(x) * 1000.0).round() / 1000.0).into()
}

/// Returns a colour as a value.
fn rgb(color: Vec3) -> Value {
    ((color.as_dvec3() * 1000.0).round() / 1000.0).into()
}

impl State {
    fn show(&mut self, number: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(number, step);
        want.shown(step.line(), caption, || self.table(number), || self.picture(number))
    }

    fn take(&mut self, number: usize, step: &Step) -> Caption {
        let surface = self.surfaces[number];
        let metallic = ("metallic", short(surface.metallic));
        match *step {
            Step::Cosines(cosines) => {
                (self.distribution, self.visibility) = (None, None);
                (self.fresnel, self.diffuse) = (None, None);
                self.cosines = cosines;
                let [nl, nv, nh, vh] = cosines.map(short);
                let roughness = ("roughness", short(surface.roughness));
                let cosines = [("nl", nl), ("nv", nv), ("nh", nh), ("vh", vh)];
                let [nl, nv, nh, vh] = cosines;
                COSINES.with([roughness, metallic, nl, nv, nh, vh])
            }
            Step::Distribution { alpha, value } => {
                self.distribution = Some(value);
                DISTRIBUTION.with([("alpha", short(alpha)), ("value", short(value))])
            }
            Step::Visibility(value) => {
                self.visibility = Some(value);
                let [nl, nv, ..] = self.cosines.map(short);
                VISIBILITY.with([("value", short(value)), ("nl", nl), ("nv", nv)])
            }
            Step::Fresnel { straight, grazing, away, value } => {
                self.fresnel = Some(value);
                FRESNEL.with([
                    ("straight", rgb(straight)),
                    ("grazing", rgb(grazing)),
                    ("away", f64::from(away).into()),
                    ("value", rgb(value)),
                ])
            }
            Step::Diffuse { through, value } => {
                self.diffuse = Some(value);
                if surface.metallic == 1.0 {
                    return METAL.with([]);
                }
                let through = ("through", short(through));
                DIFFUSE.with([through, metallic, ("base", rgb(BASE)), ("value", rgb(value))])
            }
            Step::Sum(value) => {
                self.sums.push(value);
                if self.cosines[0] == 0.0 {
                    return DARK.with([]);
                }
                let both = self.distribution.unwrap_or(0.0) * self.visibility.unwrap_or(0.0);
                SUM.with([
                    ("nl", short(self.cosines[0])),
                    ("diffuse", rgb(self.diffuse.unwrap_or_default())),
                    ("dv", short(both)),
                    ("fresnel", rgb(self.fresnel.unwrap_or_default())),
                    ("value", rgb(value)),
                ])
            }
        }
    }

    /// Returns the terms of the current surface, and the sums of all.
    fn table(&self, number: usize) -> Table {
        let mut table = Table::default();
        for (name, cosine) in ["n·l", "n·v", "n·h", "v·h"].into_iter().zip(self.cosines) {
            table.row(name, [short(cosine)]);
        }
        let known = |x: Option<f32>| x.map_or(Value::from(""), short);
        table.row("D", [known(self.distribution)]);
        table.row("V", [known(self.visibility)]);
        table.row("F", [self.fresnel.map_or("".into(), rgb)]);
        table.row(Word::new("diffuse", "diffus"), [self.diffuse.map_or("".into(), rgb)]);
        for (k, surface) in self.surfaces.iter().enumerate().take(number + 1) {
            let sum = self.sums.get(k).map_or("".into(), |sum| rgb(*sum));
            let numbers = [surface.roughness, surface.metallic].map(short);
            let name = [Word::new("sum of", "Summe von").into()].into_iter().chain(numbers);
            table.row(Value::List(name.collect()), [sum]);
        }
        table
    }

    /// Draws the surface from the side, with l, v and h, and how much light would leave in each direction.
    fn picture(&self, number: usize) -> Picture {
        let mut picture = Picture::new([DVec2::new(-1.35, -0.35), DVec2::new(1.35, 1.3)]);
        picture.picture_from_input = None;
        picture.chain([DVec2::new(-1.3, 0.0), DVec2::new(1.3, 0.0)], Look::Window);
        for (k, surface) in self.surfaces.iter().enumerate().take(number + 1) {
            let look = if k == number { Look::First } else { Look::Pale };
            picture.chain(lobe(surface), look);
        }
        let surface = &self.surfaces[number];
        let flat = |v: Vec3| v.truncate().as_dvec2();
        let (light, eye) = (flat(surface.to_light), flat(surface.to_eye));
        picture.arrow(DVec2::ZERO, DVec2::Y, Look::Thin);
        picture.arrow(light, light * 0.04, Look::Second);
        picture.arrow(DVec2::ZERO, eye, Look::Now);
        let half = (light + eye).normalize_or_zero();
        picture.chain([DVec2::ZERO, half], Look::Dashed);
        for (end, name) in [(DVec2::Y, "n"), (light, "l"), (eye, "v"), (half, "h")] {
            picture.label(end * 1.12, (0.0, 0.0), name);
        }
        picture
    }
}

/// Returns the curve of the light that leaves in each direction of the plane, the largest one of length 0.9.
fn lobe(surface: &Lit) -> Vec<DVec2> {
    let place = |k: i32| {
        let (sine, cosine) = libm::sincos(f64::from(k) * 2.0_f64.to_radians());
        DVec2::new(sine, cosine)
    };
    let leaving = |way: DVec2| {
        let to_eye = way.extend(0.0).as_vec3();
        f64::from(reflect_one(&Lit { to_eye, ..*surface }, &mut NoTrace).element_sum())
    };
    let all: Vec<(DVec2, f64)> = (-44..=44).map(place).map(|way| (way, leaving(way))).collect();
    let most = all.iter().map(|(_, light)| *light).fold(1e-9, f64::max);
    all.into_iter().map(|(way, light)| way * (0.9 * light / most)).collect()
}
