//! Lessons of simplification: points that lines and borders can do without.

use super::frame::{Frames, record};
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::clip::simplify::coverage::{self, Coverage};
use crate::clip::simplify::{LineSimplifier, douglas_peucker, visvalingam};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::{Error, Result};

pub(super) const LESSONS: &[Lesson] = &[DOUGLAS_PEUCKER, VISVALINGAM, COVERAGE];

const DOUGLAS_PEUCKER: Lesson = Lesson {
    name: douglas_peucker::INFO.name,
    info: &douglas_peucker::INFO,
    takes: TAKES,
    examples: LINES,
    templates: &[&END, &KEPT, &STRAIGHT, &EDGE],
    unreached: &[],
    make: |_, input, _, cap| by_distance(input, cap),
};

const VISVALINGAM: Lesson = Lesson {
    name: visvalingam::INFO.name,
    info: &visvalingam::INFO,
    templates: &[&BEGIN, &REMOVED],
    make: |_, input, _, cap| by_area(input, cap),
    ..DOUGLAS_PEUCKER
};

const COVERAGE: Lesson = Lesson {
    name: coverage::INFO.name,
    info: &coverage::INFO,
    takes: TAKES_RINGS,
    examples: RINGS,
    templates: &[&SHARED],
    unreached: &[],
    make: |_, input, _, cap| together(input, cap),
};

const TAKES: Word = Word::new("a line of points", "ein Linienzug");
const TAKES_RINGS: Word = Word::new(
    "rings that share points on their borders",
    "Ringe, die auf ihren Grenzen Punkte teilen",
);

const LINES: &[Example] = &[
    Example {
        name: "coast",
        title: Word::new("a coast of ten points", "eine Küste aus zehn Punkten"),
        input: || {
            line(&[
                (0.0, 0.0),
                (1.0, 0.4),
                (2.0, -0.3),
                (3.0, 3.0),
                (4.0, 3.6),
                (5.0, 3.1),
                (6.0, 0.5),
                (7.0, 0.2),
                (8.0, 0.6),
                (9.0, 0.0),
            ])
        },
    },
    Example {
        name: "spike",
        title: Word::new("a line that turns back", "eine Linie, die umkehrt"),
        input: || line(&[(0.0, 0.0), (3.0, 0.1), (8.0, 0.0), (2.0, 1.0), (5.0, 3.0)]),
    },
    Example::new(
        "straight",
        "on one straight line: only the ends stay",
        "auf einer Geraden: Nur die Enden bleiben",
        || line(&[(0.0, 0.0), (1.0, 0.5), (2.0, 1.0), (5.0, 2.5), (8.0, 4.0)]),
    ),
    Example::new(
        "two",
        "two points: nothing can be left out",
        "zwei Punkte: Nichts kann wegfallen",
        || line(&[(0.0, 0.0), (5.0, 2.0)]),
    ),
    Example::new(
        "zigzag",
        "a zigzag below the tolerance, then one above it",
        "ein Zickzack unter der Toleranz, dann eines darüber",
        || {
            line(&[
                (0.0, 0.0),
                (1.0, 0.3),
                (2.0, -0.3),
                (3.0, 0.3),
                (4.0, 0.0),
                (5.0, 2.0),
                (6.0, -2.0),
                (7.0, 2.0),
                (8.0, 0.0),
            ])
        },
    ),
    Example::new(
        "arch",
        "half of a circle: the ends of equal parts stay",
        "ein halber Kreis: Die Enden gleicher Teile bleiben",
        || {
            line(&[
                (0.0, 0.0),
                (0.4, 1.5),
                (1.2, 2.9),
                (2.5, 3.7),
                (4.0, 4.0),
                (5.5, 3.7),
                (6.8, 2.9),
                (7.6, 1.5),
                (8.0, 0.0),
            ])
        },
    ),
];

const RINGS: &[Example] = &[
    Example {
        name: "border",
        title: Word::new(
            "two areas with a crooked border",
            "zwei Flächen mit einer krummen Grenze",
        ),
        input: || {
            let border = [(4.0, 0.0), (4.3, 0.8), (3.8, 1.6), (4.2, 2.4), (3.9, 3.2), (4.0, 4.0)];
            let left = border.into_iter().chain([(0.0, 4.0), (0.0, 0.0)]);
            let right = [(4.0, 0.0), (8.0, 0.0), (8.0, 4.0)].into_iter();
            let right = right.chain(border.into_iter().skip(1).rev());
            rings(vec![left.map(DVec2::from).collect(), right.map(DVec2::from).collect()])
        },
    },
    Example {
        name: "island",
        title: Word::new(
            "the notch with the island must stay, the other one goes",
            "die Kerbe mit der Insel muss bleiben, die andere fällt weg",
        ),
        input: || {
            let bottom = [(0.0, 0.0), (4.0, 0.08), (8.0, 0.0), (8.0, 4.0)].into_iter();
            let notches = [(5.0, 4.0), (4.2, 3.6), (3.4, 4.0), (2.6, 4.0), (1.8, 3.6), (1.0, 4.0)];
            let land = bottom.chain(notches).chain([(0.0, 4.0)]).map(DVec2::from).collect();
            let island = [(4.15, 3.8), (4.25, 3.8), (4.2, 3.9)];
            rings(vec![land, island.map(DVec2::from).to_vec()])
        },
    },
    Example::new(
        "three",
        "three areas that meet in one point: the point stays",
        "drei Flächen, die sich in einem Punkt treffen: Er bleibt",
        || {
            let lower = [
                (0.0, 0.0),
                (8.0, 0.0),
                (8.0, 3.0),
                (6.0, 3.3),
                (4.0, 3.0),
                (2.0, 2.7),
                (0.0, 3.0),
            ];
            let left = [(0.0, 3.0), (2.0, 2.7), (4.0, 3.0), (4.3, 4.5), (4.0, 6.0), (0.0, 6.0)];
            let right = [(4.0, 3.0), (6.0, 3.3), (8.0, 3.0), (8.0, 6.0), (4.0, 6.0), (4.3, 4.5)];
            rings(vec![
                lower.map(DVec2::from).to_vec(),
                left.map(DVec2::from).to_vec(),
                right.map(DVec2::from).to_vec(),
            ])
        },
    ),
    Example::new(
        "hole",
        "an area in another one: both borders go on together",
        "eine Fläche in einer anderen: Beide Grenzen bleiben beisammen",
        || {
            let land = [(0.0, 0.0), (4.0, 0.2), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)];
            let lake = [(2.0, 2.0), (2.0, 4.0), (4.0, 4.2), (6.0, 4.0), (6.0, 2.0), (4.0, 1.8)];
            let [land, lake] = [land.map(DVec2::from).to_vec(), lake.map(DVec2::from).to_vec()];
            rings(vec![land, lake.clone(), lake.into_iter().rev().collect()])
        },
    ),
    Example::new(
        "small",
        "a small area beside a large one: it keeps three points",
        "eine kleine Fläche neben einer großen: Sie behält drei Punkte",
        || {
            let large = [(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (4.0, 5.2), (0.0, 5.0)];
            let small = [(8.4, 0.0), (8.8, 0.0), (8.9, 0.2), (8.8, 0.4), (8.4, 0.4)];
            rings(vec![large.map(DVec2::from).to_vec(), small.map(DVec2::from).to_vec()])
        },
    ),
    Example::new(
        "square",
        "a square with a point on each side: only its corners stay",
        "ein Quadrat mit einem Punkt auf jeder Seite: Nur die Ecken bleiben",
        || {
            let [side, half] = [5.0, 2.5];
            let lower = [(0.0, 0.0), (half, 0.0), (side, 0.0), (side, half)];
            let upper = [(side, side), (half, side), (0.0, side), (0.0, half)];
            rings(vec![lower.into_iter().chain(upper).map(DVec2::from).collect()])
        },
    ),
];

fn line(points: &[(f64, f64)]) -> Input {
    let line = points.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure { lines: vec![line], ..Figure::default() })
}

fn rings(rings: Vec<Vec<DVec2>>) -> Input {
    Input::Figure(Figure { rings, ..Figure::default() })
}

static END: Template = Template::new(
    "kept",
    "Point {point} is an end of the line and stays.",
    "Punkt {point} ist ein Ende der Linie und bleibt.",
);
static KEPT: Template = Template::new(
    "kept",
    "Between {a} and {b}, {point} is farthest from their segment: {distance} > {tolerance}, so it stays and divides the part.",
    "Zwischen {a} und {b} liegt {point} am weitesten von der Strecke: {distance} > {tolerance}, er bleibt und teilt das Stück.",
);
static STRAIGHT: Template = Template::new(
    "straight",
    "Between {a} and {b} no point is farther away than {distance} ≤ {tolerance}: all are left out.",
    "Zwischen {a} und {b} ist kein Punkt weiter entfernt als {distance} ≤ {tolerance}: Alle fallen weg.",
);
static EDGE: Template = Template::new(
    "straight",
    "Between {a} and {b} there is no point.",
    "Zwischen {a} und {b} liegt kein Punkt.",
);
static BEGIN: Template = Template::new(
    "begin",
    "Every inner one of {count} points makes a triangle with its neighbours; up to √area = {tolerance} it goes.",
    "Jeder innere von {count} Punkten bildet mit seinen Nachbarn ein Dreieck; bis √Fläche = {tolerance} fällt er weg.",
);
static REMOVED: Template = Template::new(
    "removed",
    "{point} has the smallest triangle: √area counts as {side} ≤ {tolerance}, so it goes and its neighbours are joined.",
    "{point} hat das kleinste Dreieck: √Fläche zählt als {side} ≤ {tolerance}, er fällt weg, seine Nachbarn werden verbunden.",
);
static SHARED: Template = Template::new(
    "removed",
    "The place {at}, weight {weight} ≤ {tolerance}, is left out; number of rings that pass it: {count}.",
    "Der Ort {at}, Gewicht {weight} ≤ {tolerance}, fällt weg; Zahl der Ringe durch ihn: {count}.",
);

/// Parts of the picture's longer side that may be lost.
const PART: f64 = 0.1;

/// Returns the tolerance for points.
fn tolerance<'a>(points: impl IntoIterator<Item = &'a DVec2>) -> f64 {
    let [low, high] = Picture::around(points.into_iter().copied(), 0.0).extent;
    (high - low).max_element() * PART
}

/// Returns the name of a point of the line: its number.
fn named(point: usize) -> Value {
    format!("P{point}").into()
}

/// Returns the points of the first line.
fn points(input: &Input) -> Result<Vec<DVec2>> {
    let line = input.figure(TAKES)?.lines.iter().find(|line| line.len() > 1);
    let missing = || Error::parameter("input", "without a line of two points", TAKES.en);
    line.cloned().ok_or_else(missing)
}

/// Returns an empty picture around points, with them and a line.
fn before(all: &[DVec2], stays: &[usize], look: Look) -> Picture {
    let mut picture = Picture::around(all.iter().copied(), 0.12);
    picture.chain(all.to_vec(), Look::Pale);
    let at = |&point: &usize| all.get(point).copied();
    picture.chain(stays.iter().filter_map(at).collect::<Vec<_>>(), look);
    picture
}

fn number_all(picture: &mut Picture, all: &[DVec2]) {
    for (number, &point) in all.iter().enumerate() {
        picture.label(point, (0.0, -10.0), named(number));
    }
}

fn by_distance(input: &Input, cap: usize) -> Result<Frames> {
    use douglas_peucker::{Options, Step, simplify};
    let all = points(input)?;
    let tolerance = tolerance(&all);
    let steps = record(cap, |t| simplify(&all, &Options { tolerance }, t))?;
    let mut kept: Vec<usize> = Vec::new();
    let mut table = Table::new([
        Word::new("part", "Stück"),
        Word::new("farthest", "weitester"),
        Word::new("distance", "Abstand"),
    ]);
    Ok(Frames::new(steps, move |step, want| {
        let (Step::Kept { part, distance, .. } | Step::Straight { part, distance }) = *step;
        let values = [("a", named(part[0])), ("b", named(part[1])), ("distance", distance.into())];
        let [a, b, distance_of] = values;
        let ends = format!("P{} … P{}", part[0], part[1]);
        let limit = ("tolerance", tolerance.into());
        let caption: Caption = match *step {
            Step::Kept { point, distance: f64::INFINITY, .. } => {
                kept.push(point);
                END.with([("point", named(point))])
            }
            Step::Kept { point, .. } => {
                kept.push(point);
                table.row(ends, [named(point), distance.into()]);
                KEPT.with([a, b, ("point", named(point)), distance_of, limit])
            }
            Step::Straight { part: [from, to], .. } if to <= from + 1 => {
                table.row(ends, ["–".into(), "".into()]);
                EDGE.with([a, b])
            }
            Step::Straight { .. } => {
                table.row(ends, ["–".into(), distance.into()]);
                STRAIGHT.with([a, b, distance_of, limit])
            }
        };
        kept.sort_unstable();
        let picture = || {
            let mut picture = before(&all, &kept, Look::Result);
            let at = |point: usize| all.get(point).copied().unwrap_or_default();
            let [from, to] = part.map(at);
            picture.chain([from, to], Look::Dashed);
            kept.iter().for_each(|&point| picture.dot(at(point), Look::Result));
            if let Step::Kept { point, .. } = *step {
                let along = to - from;
                let length = along.length_squared();
                let share = if length > 0.0 { (at(point) - from).dot(along) / length } else { 0.0 };
                picture.chain([at(point), from + along * share.clamp(0.0, 1.0)], Look::Now);
                picture.dot(at(point), Look::Now);
            }
            number_all(&mut picture, &all);
            picture
        };
        want.shown(step.line(), caption, || table.clone(), picture)
    }))
}

fn by_area(input: &Input, cap: usize) -> Result<Frames> {
    use visvalingam::{Options, Step, simplify};
    let all = points(input)?;
    let tolerance = tolerance(&all);
    let steps = record(cap, |t| simplify(&all, &Options { tolerance }, t))?;
    let mut left: Vec<usize> = (0..all.len()).collect();
    Ok(Frames::new(steps, move |step, want| {
        let at = |point: usize| all.get(point).copied().unwrap_or_default();
        let limit = ("tolerance", tolerance.into());
        let mut triangle = Vec::new();
        let caption = match *step {
            Step::Begin { points } => BEGIN.with([("count", points.into()), limit]),
            Step::Removed { point, side } => {
                if let Some(place) = left.iter().position(|&other| other == point) {
                    let around = left.get(place.saturating_sub(1)..place + 2).unwrap_or_default();
                    triangle = around.iter().map(|&corner| at(corner)).collect();
                    left.remove(place);
                }
                REMOVED.with([("point", named(point)), ("side", side.into()), limit])
            }
        };
        let table = || {
            let mut table =
                Table::new([Word::new("point", "Punkt"), Word::new("√area", "√Fläche")]);
            for corners in left.windows(3) {
                let [a, b, c] = [corners[0], corners[1], corners[2]].map(at);
                let side = ((b - a).perp_dot(c - a).abs() * 0.5).sqrt();
                table.row(named(corners[1]), [side.into()]);
            }
            table
        };
        let picture = || {
            let mut picture = before(&all, &left, Look::Result);
            left.iter().for_each(|&point| picture.dot(at(point), Look::Result));
            if let [_, corner, _] = triangle[..] {
                picture.ring(triangle.clone(), Look::Second);
                picture.dot(corner, Look::Now);
            }
            number_all(&mut picture, &all);
            picture
        };
        want.shown(step.line(), caption, table, picture)
    }))
}

fn together(input: &Input, cap: usize) -> Result<Frames> {
    use coverage::{Options, Step};
    let figure = input.figure(TAKES_RINGS)?;
    figure.ring(TAKES_RINGS)?;
    let mut all = Coverage::default();
    figure.rings.iter().for_each(|ring| all.push_ring(ring.iter().copied()));
    let limit = tolerance(figure.rings.iter().flatten());
    let options = Options { method: LineSimplifier::Visvalingam, limit };
    let steps = record(cap, |t| all.weights(&options, t))?;
    let given = figure.rings.clone();
    let mut rings = given.clone();
    let mut table = Table::new([
        Word::new("left out", "fällt weg"),
        Word::new("weight", "Gewicht"),
        Word::new("rings", "Ringe"),
    ]);
    Ok(Frames::new(steps, move |step, want| {
        let Step::Removed { at, weight } = *step;
        let of = rings.iter().filter(|ring| ring.contains(&at)).count();
        rings.iter_mut().for_each(|ring| ring.retain(|point| *point != at));
        table.row(at, [weight.into(), of.into()]);
        let values = [("at", at.into()), ("weight", weight.into())];
        let [place, weight] = values;
        let caption =
            SHARED.with([place, weight, ("tolerance", limit.into()), ("count", of.into())]);
        let picture = || {
            let mut picture = Picture::around(given.iter().flatten().copied(), 0.1);
            picture.rings(&given, Look::Pale);
            for ring in &rings {
                picture.ring(ring.clone(), Look::Result);
                ring.iter().for_each(|point| picture.dot(*point, Look::First));
            }
            picture.dot(at, Look::Now);
            picture
        };
        want.shown(step.line(), caption, || table.clone(), picture)
    }))
}
