//! The lesson of triangulation by cutting off ears.

use super::{EXAMPLES, TAKES, ring};
use crate::Result;
use crate::curve::Contours;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::grid::letter;
use crate::explain::input::{Figure, Input};
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::raster::ear_clipping::ears;
use crate::raster::triangulate::{INFO, Step};
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        ARROW,
        FRAME,
        EXAMPLES[0],
        EXAMPLES[4],
        Example::new("hexagon", "convex: any ear will do", "konvex: Jedes Ohr ist recht", || {
            ring(&[(2.0, 0.0), (5.0, 0.0), (7.0, 3.0), (5.0, 6.0), (2.0, 6.0), (0.0, 3.0)])
        }),
        Example::new(
            "spiral",
            "a spiral: few corners are ears",
            "eine Spirale: wenige Ecken sind Ohren",
            || {
                ring(&[
                    (0.0, 0.0),
                    (7.0, 0.0),
                    (7.0, 7.0),
                    (1.0, 7.0),
                    (1.0, 3.0),
                    (4.0, 3.0),
                    (4.0, 4.0),
                    (2.0, 4.0),
                    (2.0, 6.0),
                    (6.0, 6.0),
                    (6.0, 1.0),
                    (0.0, 1.0),
                ])
            },
        ),
    ],
    templates: &[&POINT, &BRIDGE, &REFLEX, &BLOCKED, &TRIANGLE, &LAST],
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
static BRIDGE: Template = Template::new(
    "bridge",
    "{a} of the hole is joined to {b}, the nearest visible corner.",
    "{a} vom Loch wird mit {b} verbunden, der nächsten Ecke, die es sieht.",
);
static REFLEX: Template = Template::new(
    "reflex",
    "{b} is no ear: ({b} − {a}) × ({c} − {b}) = {cross}, it is not convex.",
    "{b} ist kein Ohr: ({b} − {a}) × ({c} − {b}) = {cross}, die Ecke ist nicht konvex.",
);
static BLOCKED: Template = Template::new(
    "blocked",
    "{b} is no ear: corner {by} lies in the triangle {a} {b} {c}.",
    "{b} ist kein Ohr: Ecke {by} liegt im Dreieck {a} {b} {c}.",
);
static TRIANGLE: Template = Template::new(
    "triangle",
    "The ear at {b} is cut off, triangle {a} {b} {c}: ({b} − {a}) × ({c} − {b}) = {cross}, area {area}.",
    "Das Ohr bei {b} wird abgeschnitten, Dreieck {a} {b} {c}: ({b} − {a}) × ({c} − {b}) = {cross}, Fläche {area}.",
);
static LAST: Template = Template::new(
    "triangle",
    "Three corners are left: {a} {b} {c}, area {area}. {count} {count|triangle has|triangles together have} {sum}.",
    "Drei Ecken sind übrig: {a} {b} {c}, Fläche {area}. {count} {count|Dreieck hat|Dreiecke zusammen haben} {sum}.",
);

/// The polygon, its corners so far, and its triangles so far.
#[derive(Clone)]
struct State {
    rings: Vec<Vec<DVec2>>,
    points: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    bridges: Vec<[u32; 2]>,
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
        count = ears(&contours, t).triangles.len();
        Ok(())
    })?;
    let (points, triangles, bridges) = (Vec::new(), Vec::new(), Vec::new());
    let mut state = State { rings, points, triangles, bridges, count };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
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
            Step::Bridge(ends) => {
                self.bridges.push(ends);
                let [a, b] = ends.map(|corner| Value::from(letter(corner as usize)));
                BRIDGE.with([("a", a), ("b", b)])
            }
            Step::Reflex { corners, cross } => {
                let [a, b, c] = names(corners);
                REFLEX.with([a, b, c, ("cross", cross.into())])
            }
            Step::Blocked { corners, by } => {
                let [a, b, c] = names(corners);
                BLOCKED.with([a, b, c, ("by", letter(by as usize).into())])
            }
            Step::Triangle(triangle) => {
                self.triangles.push(triangle);
                let [p, q, r] = self.corners(triangle);
                let cross = (q - p).perp_dot(r - q);
                let area = ("area", self.area(triangle).into());
                let [a, b, c] = names(triangle);
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
            let is_now = number + 1 == self.triangles.len() && matches!(step, Step::Triangle(_));
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
        for &[a, b] in &self.bridges {
            let [a, b, _] = self.corners([a, b, b]);
            picture.chain([a, b], Look::Dashed);
        }
        match *step {
            Step::Point(point) => picture.dot(point, Look::Now),
            Step::Reflex { corners, .. } | Step::Blocked { corners, .. } => {
                picture.ring(self.corners(corners), Look::Second);
                let [_, corner, _] = self.corners(corners);
                picture.dot(corner, Look::Now);
                if let Step::Blocked { by, .. } = *step {
                    picture.dot(self.corners([by; 3])[0], Look::Now);
                }
            }
            Step::Bridge(_) | Step::Triangle(_) => {}
        }
        picture
    }
}

/// Returns the letters of a triangle's corners.
fn names(corners: [u32; 3]) -> [(&'static str, Value); 3] {
    let [a, b, c] = corners.map(|corner| Value::from(letter(corner as usize)));
    [("a", a), ("b", b), ("c", c)]
}
