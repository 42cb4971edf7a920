//! The lesson of barycentric coordinates by areas.

use super::frame::{Frames, record};
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::raster::interpolate::{BARYCENTRIC, barycentric_2d, blend, doubled_area};
use crate::trace::Tracer;
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: BARYCENTRIC.name,
    info: &BARYCENTRIC,
    takes: TAKES,
    examples: &[
        Example {
            name: "lecture",
            title: Word::new("weights 0.2, 0.3 and 0.5", "Gewichte 0,2, 0,3 und 0,5"),
            input: || figure([(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)], &[(1.2, 1.5)]),
        },
        Example {
            name: "places",
            title: Word::new(
                "on an edge, at a corner, outside",
                "auf einer Kante, in einer Ecke, außerhalb",
            ),
            input: || {
                let points = [(3.0, 0.0), (2.0, 6.0), (6.0, 5.0)];
                figure([(0.0, 0.0), (6.0, 0.0), (2.0, 6.0)], &points)
            },
        },
        Example {
            name: "flat",
            title: Word::new("a triangle without area", "ein Dreieck ohne Fläche"),
            input: || figure([(0.0, 0.0), (2.0, 1.0), (4.0, 2.0)], &[(1.0, 1.0)]),
        },
        Example::new(
            "centroid",
            "the centre of area: three equal weights",
            "der Schwerpunkt: drei gleiche Gewichte",
            || figure([(0.0, 0.0), (6.0, 0.0), (0.0, 6.0)], &[(2.0, 2.0)]),
        ),
        Example::new(
            "beyond-a-corner",
            "beyond a corner: two weights are negative",
            "jenseits einer Ecke: zwei Gewichte sind negativ",
            || figure([(0.0, 0.0), (4.0, 0.0), (1.0, 3.0)], &[(-1.5, -1.0)]),
        ),
        Example::new(
            "clockwise",
            "clockwise: the areas are negative, the weights are not",
            "im Uhrzeigersinn: Die Flächen sind negativ, die Gewichte nicht",
            || figure([(0.0, 0.0), (0.0, 3.0), (4.0, 0.0)], &[(1.0, 1.0)]),
        ),
    ],
    templates: &[&AREA, &NO_AREA, &PART, &INSIDE, &OUTSIDE],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word =
    Word::new("a ring of three points, and points", "ein Ring aus drei Punkten, und Punkte");

static AREA: Template = Template::new(
    "area",
    "Twice the area of ABC: (B − A) × (C − A) = {area}.",
    "Die doppelte Fläche von ABC: (B − A) × (C − A) = {area}.",
);
static NO_AREA: Template = Template::new(
    "area",
    "(B − A) × (C − A) = 0: the three lie on a line, and there are no weights.",
    "(B − A) × (C − A) = 0: Die drei liegen auf einer Geraden, es gibt keine Gewichte.",
);
static PART: Template = Template::new(
    "part",
    "The triangle of P and the side opposite to {corner}: {part}; divided by {area} it is the weight of {corner}: {weight}.",
    "Das Dreieck aus P und der Seite gegenüber von {corner}: {part}; durch {area} geteilt ist das das Gewicht von {corner}: {weight}.",
);
static INSIDE: Template = Template::new(
    "weights",
    "P = {a} · A + {b} · B + {c} · C = {point}; no weight is negative: P is in the triangle.",
    "P = {a} · A + {b} · B + {c} · C = {point}; kein Gewicht ist negativ: P liegt im Dreieck.",
);
static OUTSIDE: Template = Template::new(
    "weights",
    "P = {a} · A + {b} · B + {c} · C = {point}; a weight is negative: P is outside, beyond that corner's opposite side.",
    "P = {a} · A + {b} · B + {c} · C = {point}; ein Gewicht ist negativ: P liegt außerhalb, jenseits der Seite gegenüber.",
);

/// Step of the calculation.
#[derive(Debug, Clone, Copy)]
enum Step {
    /// Twice the area of the triangle.
    Area(f64),
    /// Twice the area of the part opposite to a corner, and the weight that it gives.
    Part { point: DVec2, corner: usize, part: f64, weight: f64 },
    /// All weights of a point.
    Weights([f64; 3]),
}

impl Step {
    /// Returns the line of the pseudocode.
    fn line(self) -> usize {
        match self {
            Self::Area(area) => 1 + usize::from(area == 0.0),
            Self::Part { .. } => 5,
            Self::Weights(_) => 7,
        }
    }
}

/// Returns an input of a triangle and points.
fn figure(ring: [(f64, f64); 3], points: &[(f64, f64)]) -> Input {
    let points = points.iter().copied().map(DVec2::from).collect();
    Input::Figure(Figure {
        rings: vec![ring.map(DVec2::from).to_vec()],
        points,
        ..Figure::default()
    })
}

/// A triangle, and what is known of its points.
#[derive(Clone)]
struct State {
    corners: [DVec2; 3],
    area: f64,
    weights: Vec<f64>,
    point: Option<DVec2>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let Some(&[a, b, c]) = figure.rings.first().map(Vec::as_slice) else {
        return Err(Error::parameter("input", "without a ring of three points", TAKES.en));
    };
    let corners = [a, b, c];
    let steps = record(cap, |t| {
        run(corners, &figure.points, t);
        Ok(())
    })?;
    let area = doubled_area(corners);
    let mut state = State { corners, area, weights: Vec::new(), point: None };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(*step);
        want.shown(step.line(), caption, || state.table(), || state.picture(*step))
    }))
}

/// Reports the weights of all points.
fn run(corners: [DVec2; 3], points: &[DVec2], t: &mut impl Tracer<Step>) {
    t.step(|| Step::Area(doubled_area(corners)));
    for &point in points {
        let Some(weights) = barycentric_2d(corners, point) else { return };
        for (corner, weight) in weights.into_iter().enumerate() {
            let others = [1, 2].map(|k| corners[(corner + k) % 3]);
            let part = doubled_area([point, others[0], others[1]]);
            t.step(|| Step::Part { point, corner, part, weight });
        }
        t.step(|| Step::Weights(weights));
    }
}

impl State {
    fn take(&mut self, step: Step) -> Caption {
        match step {
            Step::Area(0.0) => NO_AREA.with([]),
            Step::Area(area) => AREA.with([("area", area.into())]),
            Step::Part { point, corner, part, weight } => {
                if corner == 0 {
                    self.weights.clear();
                }
                self.point = Some(point);
                self.weights.push(weight);
                let area = ("area", self.area.into());
                let corner = ("corner", NAMES[corner].into());
                PART.with([corner, ("part", part.into()), area, ("weight", weight.into())])
            }
            Step::Weights(weights) => {
                let point = ("point", blend(weights, self.corners).into());
                let [a, b, c] = weights.map(Value::from);
                let is_inside = weights.iter().all(|weight| *weight >= 0.0);
                let template = if is_inside { &INSIDE } else { &OUTSIDE };
                template.with([("a", a), ("b", b), ("c", c), point])
            }
        }
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("corner", "Ecke"),
            Word::new("place", "Ort"),
            Word::new("weight", "Gewicht"),
        ];
        let mut table = Table::new(heads);
        for (k, corner) in self.corners.into_iter().enumerate() {
            let weight = self.weights.get(k).map_or(Value::from(""), |weight| (*weight).into());
            table.row(NAMES[k], [corner.into(), weight]);
        }
        if let Some(point) = self.point {
            table.row("P", [point.into(), "".into()]);
        }
        table
    }

    fn picture(&self, step: Step) -> Picture {
        let [a, b, c] = self.corners;
        let mut picture = Picture::around([a, b, c].into_iter().chain(self.point), 0.15);
        picture.chain([a, b, c, a], Look::Window);
        if let (Some(point), Step::Part { corner, .. }) = (self.point, step) {
            let others = [1, 2].map(|k| self.corners[(corner + k) % 3]);
            picture.ring([point, others[0], others[1]], Look::First);
        }
        if let Some(point) = self.point {
            self.corners.iter().for_each(|corner| picture.chain([point, *corner], Look::Thin));
            picture.named(point, "P", Look::Now);
        }
        for (name, corner) in NAMES.into_iter().zip(self.corners) {
            picture.named(corner, name, Look::Second);
        }
        picture
    }
}

const NAMES: [&str; 3] = ["A", "B", "C"];
