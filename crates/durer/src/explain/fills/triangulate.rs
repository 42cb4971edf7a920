//! The lesson of triangulation by cutting off ears.

use super::{EXAMPLES, TAKES, ring};
use crate::Result;
use crate::curve::Contours;
use crate::explain::frame::{Frames, Shown, frames, record};
use crate::explain::grid::letter;
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::raster::triangulate::{INFO, Step, triangulate};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[ARROW, FRAME, EXAMPLES[0]],
    templates: &[&POINT, &TRIANGLE, &LAST],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const ARROW: Example = Example {
    name: "arrow",
    title: Word::new(
        "a reflex corner, which two others must not cut off",
        "eine einspringende Ecke, die zwei andere nicht abschneiden dürfen",
    ),
    input: || ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)]),
};

const FRAME: Example = Example {
    name: "frame",
    title: Word::new("a square with a hole: 8 triangles", "ein Quadrat mit Loch: 8 Dreiecke"),
    input: || {
        let square = |low: f64, high: f64| {
            vec![(low, low), (high, low), (high, high), (low, high)].into_iter()
        };
        let outer = square(0.0, 6.0).map(DVec2::from).collect();
        let hole = square(2.0, 4.0).rev().map(DVec2::from).collect();
        Input::Figure(Figure { rings: vec![outer, hole], ..Figure::default() })
    },
};

static POINT: Template =
    Template::new("point", "Corner {name} is at {point}.", "Ecke {name} liegt bei {point}.");
static TRIANGLE: Template = Template::new(
    "triangle",
    "The ear at {b} is cut off, triangle {a} {b} {c}: ({b} − {a}) × ({c} − {b}) = {cross}, area {area}.",
    "Das Ohr bei {b} wird abgeschnitten, Dreieck {a} {b} {c}: ({b} − {a}) × ({c} − {b}) = {cross}, Fläche {area}.",
);
static LAST: Template = Template::new(
    "triangle",
    "Three corners are left: {a} {b} {c}, area {area}. All {count} triangles together have {sum}.",
    "Drei Ecken sind übrig: {a} {b} {c}, Fläche {area}. Alle {count} Dreiecke zusammen haben {sum}.",
);

/// The polygon, its corners so far, and its triangles so far.
struct State {
    rings: Vec<Vec<DVec2>>,
    points: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    /// Number of triangles in the end.
    count: usize,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    figure.ring(TAKES)?;
    let rings: Vec<Vec<DVec2>> =
        figure.rings.iter().filter(|ring| ring.len() > 2).cloned().collect();
    let mut contours = Contours::new();
    rings.iter().for_each(|ring| contours.push(ring.iter().copied(), true));
    let mut count = 0;
    let steps = record(cap, |t| {
        count = triangulate(&contours, t).triangles.len();
        Ok(())
    })?;
    let mut state = State { rings, points: Vec::new(), triangles: Vec::new(), count };
    Ok(frames(&steps, |step| state.show(step)))
}

impl State {
    fn show(&mut self, step: &Step) -> Shown {
        let caption = self.take(step);
        Shown { line: step.line(), caption, table: self.table(), picture: self.picture(step) }
    }

    fn corners(&self, triangle: [u32; 3]) -> [DVec2; 3] {
        triangle.map(|corner| self.points.get(corner as usize).copied().unwrap_or_default())
    }

    fn area(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = self.corners(triangle);
        (b - a).perp_dot(c - b).abs() / 2.0
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Point(point) => {
                self.points.push(point);
                let name = letter(self.points.len() - 1);
                POINT.with([("name", name.into()), ("point", point.into())])
            }
            Step::Triangle(triangle) => {
                self.triangles.push(triangle);
                let [p, q, r] = self.corners(triangle);
                let cross = (q - p).perp_dot(r - q);
                let [a, b, c] = triangle.map(|corner| Value::from(letter(corner as usize)));
                let area = ("area", self.area(triangle).into());
                let names = [("a", a), ("b", b), ("c", c)];
                let [a, b, c] = names;
                if self.triangles.len() < self.count {
                    return TRIANGLE.with([a, b, c, ("cross", cross.into()), area]);
                }
                let sum = self.triangles.iter().map(|&triangle| self.area(triangle)).sum::<f64>();
                LAST.with([a, b, c, area, ("count", self.count.into()), ("sum", sum.into())])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("triangle", "Dreieck"),
            Word::new("corners", "Ecken"),
            Word::new("area", "Fläche"),
        ]);
        for (number, &triangle) in self.triangles.iter().enumerate() {
            let names: String = triangle.map(|corner| letter(corner as usize)).join(" ");
            table.row(number + 1, [names.into(), self.area(triangle).into()]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = Picture::around(self.rings.iter().flatten().copied(), 0.12);
        picture.rings(&self.rings, Look::First);
        for (number, &triangle) in self.triangles.iter().enumerate() {
            let is_now = number + 1 == self.triangles.len();
            let corners = self.corners(triangle);
            picture.ring(corners, if is_now { Look::Now } else { Look::Result });
        }
        let count = self.rings.iter().map(Vec::len).sum::<usize>().max(1);
        let middle = self.rings.iter().flatten().sum::<DVec2>() / count as f64;
        for (number, &point) in self.points.iter().enumerate() {
            let out = (point - middle).normalize_or(DVec2::Y) * 10.0;
            picture.dot(point, Look::First);
            picture.label(point, (out.x, -out.y), letter(number));
        }
        if let Step::Point(point) = *step {
            picture.dot(point, Look::Now);
        }
        picture
    }
}
