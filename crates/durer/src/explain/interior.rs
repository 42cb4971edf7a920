//! The lesson of the pole of inaccessibility, where labels go.

use super::frame::{Frames, record};
use super::grid::log;
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::words::{Template, Value, Word};
use crate::Result;
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::view::interior_point::{INFO, Options, Step, interior_point};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&BEST, &WAITS, &DROPPED, &TRIED, &BALANCED],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new("rings of an area", "Ringe einer Fläche");

const EXAMPLES: &[Example] = &[
    Example {
        name: "hook",
        title: Word::new(
            "a hook, whose centre of area is outside",
            "ein Haken, dessen Schwerpunkt außerhalb liegt",
        ),
        input: || {
            area(vec![vec![
                (0.0, 0.0),
                (10.0, 0.0),
                (10.0, 2.0),
                (3.5, 2.0),
                (3.5, 7.0),
                (9.0, 7.0),
                (9.0, 10.0),
                (0.0, 10.0),
            ]])
        },
    },
    Example {
        name: "strip",
        title: Word::new(
            "a strip: many points are equally far, the middle is taken",
            "ein Streifen: viele Punkte gleich weit, die Mitte gilt",
        ),
        input: || area(vec![vec![(0.0, 0.0), (9.0, 0.0), (9.0, 3.0), (0.0, 3.0)]]),
    },
    Example {
        name: "lake",
        title: Word::new("a square with a lake", "ein Quadrat mit einem See"),
        input: || {
            let land = vec![(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
            let lake = vec![(4.0, 4.0), (4.0, 9.0), (8.0, 9.0), (8.0, 4.0)];
            area(vec![land, lake])
        },
    },
    Example::new(
        "triangle",
        "a triangle: the centre of its inscribed circle",
        "ein Dreieck: die Mitte seines Inkreises",
        || area(vec![vec![(0.0, 0.0), (8.0, 0.0), (0.0, 6.0)]]),
    ),
    Example::new(
        "rooms",
        "two rooms and a corridor: the larger room has it",
        "zwei Räume und ein Gang: Der größere Raum hat ihn",
        || {
            area(vec![vec![
                (0.0, 0.0),
                (3.0, 0.0),
                (3.0, 2.0),
                (7.0, 2.0),
                (7.0, -1.0),
                (12.0, -1.0),
                (12.0, 5.0),
                (7.0, 5.0),
                (7.0, 3.0),
                (3.0, 3.0),
                (3.0, 4.0),
                (0.0, 4.0),
            ]])
        },
    ),
    Example::new(
        "moat",
        "a ring around an island: equally far all around",
        "ein Ring um eine Insel: ringsum gleich weit",
        || {
            let land = vec![(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)];
            let island = vec![(3.0, 3.0), (3.0, 6.0), (6.0, 6.0), (6.0, 3.0)];
            area(vec![land, island])
        },
    ),
];

fn area(rings: Vec<Vec<(f64, f64)>>) -> Input {
    let ring = |ring: Vec<(f64, f64)>| ring.into_iter().map(DVec2::from).collect();
    Input::Figure(Figure { rings: rings.into_iter().map(ring).collect(), ..Figure::default() })
}

static BEST: Template = Template::new(
    "square",
    "The centre {center} is {distance} from the border, the farthest so far; its square may hold {bound}.",
    "Die Mitte {center} ist {distance} vom Rand, bisher am weitesten; ihr Quadrat kann {bound} enthalten.",
);
static WAITS: Template = Template::new(
    "square",
    "The centre {center} is {distance} from the border; the square may hold {bound} > {best}, so it waits.",
    "Die Mitte {center} ist {distance} vom Rand; das Quadrat kann {bound} > {best} enthalten und wartet.",
);
static DROPPED: Template = Template::new(
    "square",
    "The centre {center} is {distance} from the border; the square can hold no more than {bound} ≤ {best}.",
    "Die Mitte {center} ist {distance} vom Rand; das Quadrat kann nicht mehr als {bound} ≤ {best} enthalten.",
);
static TRIED: Template = Template::new(
    "center",
    "The ring's centre of area {center} is {distance} from the border; {best} was found.",
    "Der Schwerpunkt des Rings {center} ist {distance} vom Rand; gefunden wurde {best}.",
);
static BALANCED: Template = Template::new(
    "center",
    "In the middle of the equally far ones: {center}, {distance} from the border.",
    "In der Mitte der gleich weiten: {center}, {distance} vom Rand.",
);

/// Part of the area's longer side that the result may miss.
const PRECISION: f64 = 0.02;

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    figure.ring(TAKES)?;
    let rings: Vec<&[DVec2]> = figure.rings.iter().map(Vec::as_slice).collect();
    let around = Picture::around(figure.rings.iter().flatten().copied(), 0.08);
    let size = (around.extent[1] - around.extent[0]).max_element();
    let options = Options { precision: size * PRECISION, ..Options::default() };
    let steps = record(cap, |t| {
        interior_point(&rings, &options, t);
        Ok(())
    })?;
    let rings = figure.rings.clone();
    let mut squares: Vec<Step> = Vec::new();
    let mut best: Option<Step> = None;
    let mut rows: Vec<[Value; 3]> = Vec::new();
    let mut tried = false;
    Ok(Frames::new(steps, move |step, want| {
        let farthest = best.map_or(0.0, |best| best.distance);
        let bound = step.distance + step.half * std::f64::consts::SQRT_2;
        let values = [("center", step.center.into()), ("distance", step.distance.into())];
        let [center, distance] = values;
        let (bound_of, best_of) = (("bound", bound.into()), ("best", farthest.into()));
        let caption = if step.half > 0.0 {
            squares.push(*step);
            rows.push([step.center.into(), step.distance.into(), bound.into()]);
            if step.distance > farthest {
                best = Some(*step);
                BEST.with([center, distance, bound_of])
            } else if bound > farthest {
                WAITS.with([center, distance, bound_of, best_of])
            } else {
                DROPPED.with([center, distance, bound_of, best_of])
            }
        } else if tried {
            best = Some(*step);
            BALANCED.with([center, distance])
        } else {
            tried = true;
            TRIED.with([center, distance, best_of])
        };
        let heads = [
            Word::new("square", "Quadrat"),
            Word::new("centre", "Mitte"),
            Word::new("d", "d"),
            Word::new("bound", "Schranke"),
        ];
        want.shown(
            step.line(),
            caption,
            || log(heads, &rows),
            || picture(&around, &rings, &squares, (step, best)),
        )
    }))
}

fn picture(
    around: &Picture,
    rings: &[Vec<DVec2>],
    squares: &[Step],
    (now, best): (&Step, Option<Step>),
) -> Picture {
    let mut picture = around.clone();
    picture.rings(rings, Look::First);
    let border = |step: &Step| {
        let sides = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
        sides.map(|side| step.center + DVec2::from(side) * step.half)
    };
    squares.iter().for_each(|step| picture.chain(border(step), Look::Thin));
    if let Some(best) = best {
        // The largest circle so far.
        let circle = (0..=48).map(|k| {
            let (sine, cosine) = libm::sincos(f64::from(k) / 48.0 * std::f64::consts::TAU);
            best.center + DVec2::new(cosine, sine) * best.distance
        });
        picture.chain(circle.collect::<Vec<_>>(), Look::Result);
        picture.dot(best.center, Look::Result);
    }
    picture.chain(border(now), Look::Now);
    picture.dot(now.center, Look::Now);
    picture
}
