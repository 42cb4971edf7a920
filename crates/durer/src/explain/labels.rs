//! The lesson of greedy label placement.

use super::frame::{Frames, Numbered, Shown, Want, record};
use super::grid::letter;
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::Result;
use crate::math::{DVec2, Rect};
use crate::trace::PseudocodeLine;
use crate::view::label::{INFO, Obstacle, Placer, Step};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "cities",
            title: Word::new(
                "six places, one of them without a label",
                "sechs Orte, von denen einer leer ausgeht",
            ),
            input: || {
                map(&[
                    (10.0, 12.0),
                    (13.0, 13.0),
                    (36.0, 20.0),
                    (38.0, 2.0),
                    (22.0, 13.0),
                    (28.0, 12.0),
                ])
            },
        },
        Example {
            name: "row",
            title: Word::new("places in a row", "Orte in einer Reihe"),
            input: || map(&[(8.0, 12.0), (13.0, 12.0), (18.0, 12.0), (23.0, 12.0), (28.0, 12.0)]),
        },
        Example::new(
            "corners",
            "places in the corners: labels turn inwards",
            "Orte in den Ecken: Die Beschriftungen weichen nach innen aus",
            || map(&[(1.0, 1.0), (39.0, 1.0), (39.0, 23.0), (1.0, 23.0)]),
        ),
        Example::new(
            "crowd",
            "nine places on little room: some are left out",
            "neun Orte auf engem Raum: Einige gehen leer aus",
            || {
                let row = |y: f64| [(16.0, y), (20.0, y), (24.0, y)];
                map(&[row(14.0), row(12.0), row(10.0)].concat())
            },
        ),
        Example::new(
            "same",
            "four places at one point, and a fifth",
            "vier Orte auf einem Punkt, und ein fünfter",
            || map(&[(20.0, 12.0); 5]),
        ),
        Example::new(
            "border",
            "along the right border: all labels are on the left",
            "am rechten Rand: Alle Beschriftungen stehen links",
            || map(&[(36.0, 20.0), (38.0, 15.0), (36.0, 10.0), (38.0, 4.0)]),
        ),
    ],
    templates: &[&FREE, &TAKEN, &BEYOND, &PLACED, &LEFT_OUT],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "a window and points, the most important first",
    "ein Fenster und Punkte, der wichtigste zuerst",
);

fn map(points: &[(f64, f64)]) -> Input {
    let points = points.iter().map(|&p| p.into()).collect();
    let window = Rect::new(DVec2::ZERO, DVec2::new(40.0, 24.0)).ok();
    Input::Figure(Figure { window, points, ..Figure::default() })
}

static FREE: Template = Template::new(
    "candidate",
    "Label {label}, {place}: nothing is in the way.",
    "Beschriftung {label}, {place}: Nichts ist im Weg.",
);
static TAKEN: Template = Template::new(
    "candidate",
    "Label {label}, {place}: it would overlap that of {other}.",
    "Beschriftung {label}, {place}: Sie würde die von {other} überlappen.",
);
static BEYOND: Template = Template::new(
    "candidate",
    "Label {label}, {place}: it would reach beyond the border of the map.",
    "Beschriftung {label}, {place}: Sie würde über den Kartenrand reichen.",
);
static PLACED: Template = Template::new(
    "placed",
    "Label {label} stays {place}: the place is taken from now on.",
    "Beschriftung {label} bleibt {place}: Der Platz ist von nun an vergeben.",
);
static LEFT_OUT: Template = Template::new(
    "left-out",
    "Label {label} has no free place: it is left out.",
    "Beschriftung {label} hat keinen freien Platz: Sie entfällt.",
);

/// Places of a label beside its point, the best first, as cartographers prefer them (Imhof 1975): the direction from
/// the point, with names.
const PLACES: [([f64; 2], Word); 4] = [
    ([0.0, 0.0], Word::new("right above", "rechts oben")),
    ([0.0, -1.0], Word::new("right below", "rechts unten")),
    ([-1.0, 0.0], Word::new("left above", "links oben")),
    ([-1.0, -1.0], Word::new("left below", "links unten")),
];

/// The map with the labels that have been placed.
#[derive(Clone)]
struct State {
    bounds: Rect,
    points: Vec<DVec2>,
    /// Labels with their places, in the order in which they were placed.
    taken: Vec<(usize, Rect, Word)>,
    /// Candidate of the last step.
    candidate: Option<(Rect, Word)>,
    left_out: Vec<usize>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let bounds = figure.window(TAKES)?;
    let size = bounds.size() / DVec2::new(5.0, 8.0);
    let steps = record(cap, |t| {
        let mut placer = Placer::new(bounds);
        for (number, &point) in figure.points.iter().enumerate() {
            let place = |(way, _): ([f64; 2], Word)| {
                let low = point + DVec2::from(way) * size;
                Rect::new(low, low + size).ok()
            };
            let candidates = PLACES.into_iter().filter_map(place);
            placer.place_traced(candidates, &mut Numbered { number, t });
        }
        Ok(())
    })?;
    let points = figure.points.clone();
    let mut state =
        State { bounds, points, taken: Vec::new(), candidate: None, left_out: Vec::new() };
    Ok(Frames::new(steps, move |(number, step), want| state.show(*number, step, want)))
}

impl State {
    fn show(&mut self, number: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(number, step);
        want.shown(step.line(), caption, || self.table(), || self.picture(number, step))
    }

    fn take(&mut self, label: usize, step: &Step) -> Caption {
        let name = ("label", letter(label).into());
        match *step {
            Step::Candidate { number, place, obstacle } => {
                let word = PLACES.get(number).map_or(Word::default(), |(_, word)| *word);
                self.candidate = Some((place, word));
                let place = ("place", word.into());
                match obstacle {
                    None => FREE.with([name, place]),
                    Some(Obstacle::Bounds) => BEYOND.with([name, place]),
                    Some(Obstacle::Taken(other)) => {
                        let other = self.taken.get(other).map_or(0, |(label, ..)| *label);
                        TAKEN.with([name, place, ("other", letter(other).into())])
                    }
                }
            }
            Step::Placed { .. } => {
                let (place, word) = self.candidate.unwrap_or((self.bounds, Word::default()));
                self.taken.push((label, place, word));
                PLACED.with([name, ("place", word.into())])
            }
            Step::LeftOut => {
                self.left_out.push(label);
                LEFT_OUT.with([name])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table =
            Table::new([Word::new("label", "Beschriftung"), Word::new("place", "Platz")]);
        for label in 0..self.points.len() {
            let placed = self.taken.iter().find(|(own, ..)| *own == label);
            let place: Value = match placed {
                Some((_, _, word)) => (*word).into(),
                None if self.left_out.contains(&label) => Word::new("left out", "entfällt").into(),
                None => "".into(),
            };
            table.row(letter(label), [place]);
        }
        table
    }

    fn picture(&self, number: usize, step: &Step) -> Picture {
        let mut picture = Picture::around([self.bounds.min(), self.bounds.max()], 0.2);
        picture.frame(&self.bounds, Look::Window);
        for (label, place, _) in &self.taken {
            picture.ring(super::picture::corners(place), Look::Result);
            picture.label((place.min() + place.max()) / 2.0, (0.0, 0.0), letter(*label));
        }
        if let (Step::Candidate { obstacle, .. }, Some((place, _))) = (step, &self.candidate) {
            let look = if obstacle.is_some() { Look::Second } else { Look::First };
            picture.ring(super::picture::corners(place), look);
            picture.frame(place, Look::Now);
        }
        for (own, &point) in self.points.iter().enumerate() {
            let look = if self.left_out.contains(&own) { Look::Second } else { Look::First };
            picture.dot(point, if own == number { Look::Now } else { look });
            // Unlabelled points keep their letter beside them.
            if !self.taken.iter().any(|(label, ..)| *label == own) {
                picture.label(point, (0.0, 9.0), letter(own));
            }
        }
        picture
    }
}
