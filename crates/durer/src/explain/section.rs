//! The lesson of sections with caps: a body cut at half its height, seen aslant.

use super::frame::{Frames, Shown, Want, record};
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3, Plane};
use crate::scene::{Instance, Mesh, Scene};
use crate::trace::PseudocodeLine;
use crate::view::section::{INFO, Step, cut_traced};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "pyramid",
            title: Word::new("a pyramid at half its height", "eine Pyramide in halber Höhe"),
            input: || {
                let base = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
                let [a, b, c, d] = base.map(|(x, z)| DVec3::new(x, 0.0, z));
                let top = DVec3::new(2.0, 4.0, 2.0);
                let sides = [[a, b], [b, c], [c, d], [d, a]];
                let sides = sides.map(|[from, to]| vec![to, from, top]);
                Input::Faces([vec![a, b, c, d]].into_iter().chain(sides).collect())
            },
        },
        Example {
            name: "frame",
            title: Word::new(
                "a frame: the cap has a hole",
                "ein Rahmen: Die Deckfläche hat ein Loch",
            ),
            input: || Input::Faces(frame(false)),
        },
        Example {
            name: "open",
            title: Word::new("a wall is missing: no cap", "eine Wand fehlt: keine Deckfläche"),
            input: || Input::Faces(frame(true)),
        },
        Example::new(
            "corner",
            "the plane goes through four corners: edges without new vertices",
            "die Ebene geht durch vier Ecken: Kanten ohne neue Ecken",
            || {
                let around = [(0.0, 2.0), (2.0, 0.0), (4.0, 2.0), (2.0, 4.0)];
                let around = around.map(|(x, z)| DVec3::new(x, 2.0, z));
                let tip = |y: f64| DVec3::new(2.0, y, 2.0);
                let pair = |k: usize| [around[k], around[(k + 1) % 4]];
                let upper = (0..4).map(|k| vec![pair(k)[1], pair(k)[0], tip(4.0)]);
                let lower = (0..4).map(|k| vec![pair(k)[0], pair(k)[1], tip(0.0)]);
                Input::Faces(upper.chain(lower).collect())
            },
        ),
        Example::new(
            "angle",
            "an angle: the cap is concave",
            "ein Winkel: Die Deckfläche ist einspringend",
            || {
                Input::Faces(prism(&[
                    (0.0, 0.0),
                    (4.0, 0.0),
                    (4.0, 1.5),
                    (1.5, 1.5),
                    (1.5, 4.0),
                    (0.0, 4.0),
                ]))
            },
        ),
        Example::new(
            "two",
            "two bodies: two loops, two caps",
            "zwei Körper: zwei Schleifen, zwei Deckflächen",
            || {
                let first = prism(&[(0.0, 0.0), (1.5, 0.0), (1.5, 3.0), (0.0, 3.0)]);
                let second = prism(&[(2.5, 0.0), (4.5, 1.0), (2.5, 3.0)]);
                Input::Faces([first, second].concat())
            },
        ),
    ],
    templates: &[&PLANE, &KEPT, &AWAY, &DIVIDED, &EDGE, &CAP, &OPEN],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new("faces around a body", "Flächen um einen Körper");

/// Returns a prism of height 2 over a base, whose corners turn from x to z.
fn prism(base: &[(f64, f64)]) -> Vec<Vec<DVec3>> {
    let at = |y: f64| -> Vec<DVec3> { base.iter().map(|&(x, z)| DVec3::new(x, y, z)).collect() };
    let (low, high) = (at(0.0), at(2.0));
    let side = |k: usize| {
        let next = (k + 1) % base.len();
        vec![low[next], low[k], high[k], high[next]]
    };
    let sides = (0..base.len()).map(side);
    [low.clone(), high.iter().rev().copied().collect()].into_iter().chain(sides).collect()
}

/// Returns the walls of a square frame, without floor and lid; one outer wall may be missing.
fn frame(open: bool) -> Vec<Vec<DVec3>> {
    let ring = |low: f64, high: f64| {
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, z)| [x, z])
    };
    let wall = |[[x0, z0], [x1, z1]]: [[f64; 2]; 2]| {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        vec![at(x1, 0.0, z1), at(x0, 0.0, z0), at(x0, 2.0, z0), at(x1, 2.0, z1)]
    };
    let walls = |ring: [[f64; 2]; 4]| {
        let [a, b, c, d] = ring;
        [[a, b], [b, c], [c, d], [d, a]]
    };
    let outer = walls(ring(0.0, 4.0)).into_iter().skip(usize::from(open)).map(wall);
    // Inner walls are seen from the other side.
    let inner = walls(ring(1.0, 3.0)).into_iter().map(|[from, to]| wall([to, from]));
    outer.chain(inner).collect()
}

static PLANE: Template = Template::new(
    "plane",
    "The plane y = {height} cuts; what is below stays.",
    "Die Ebene y = {height} schneidet; was darunter ist, bleibt.",
);
static KEPT: Template = Template::new(
    "triangle",
    "Triangle {triangle}: all corners are inside the plane, it is kept.",
    "Dreieck {triangle}: Alle Ecken liegen innerhalb der Ebene, es bleibt.",
);
static AWAY: Template = Template::new(
    "triangle",
    "Triangle {triangle}: no corner is inside, it is cut away.",
    "Dreieck {triangle}: Keine Ecke liegt innen, es fällt weg.",
);
static DIVIDED: Template = Template::new(
    "triangle",
    "Triangle {triangle}: {count} of its corners {count|is|are} inside; two of its edges get a vertex on the plane.",
    "Dreieck {triangle}: Innen {count|liegt|liegen} {count} seiner Ecken; zwei seiner Kanten bekommen eine Ecke auf der Ebene.",
);
static EDGE: Template = Template::new(
    "edge",
    "The new edge from {from} to {to} goes into the border of the cap.",
    "Die neue Kante von {from} nach {to} kommt in den Rand der Deckfläche.",
);
static CAP: Template = Template::new(
    "cap",
    "A triangle of the cap has the area {area}: together {sum}.",
    "Ein Dreieck der Deckfläche hat den Inhalt {area}: zusammen {sum}.",
);
static OPEN: Template = Template::new(
    "open",
    "The edges do not close to loops: the mesh was open, and it gets no cap.",
    "Die Kanten schließen sich nicht zu Schleifen: Das Netz war offen und bekommt keine Deckfläche.",
);

/// The triangles of a body and what the cut has made.
#[derive(Clone)]
struct State {
    triangles: Vec<[DVec3; 3]>,
    height: f64,
    /// For each triangle examined, the number of corners inside.
    inside: Vec<usize>,
    edges: Vec<[DVec3; 2]>,
    caps: Vec<[DVec3; 3]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(TAKES)?;
    let fan = |face: &Vec<DVec3>| {
        let first = face.first().copied().unwrap_or_default();
        face.windows(2).skip(1).map(move |pair| [first, pair[0], pair[1]]).collect::<Vec<_>>()
    };
    let triangles: Vec<[DVec3; 3]> = faces.iter().flat_map(fan).collect();
    if triangles.is_empty() {
        return Err(Error::parameter("input", "without a face of three points", TAKES.en));
    }
    let heights = || triangles.iter().flatten().map(|p| p.y);
    let [low, high] = [heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max)];
    let height = (low + high) / 2.0;
    let mesh = Mesh::from_triangles(triangles.iter().map(|t| t.map(|p| p.as_vec3())));
    let scene = Scene { meshes: vec![mesh], instances: vec![Instance::of(0)], ..Scene::default() };
    let plane = Plane { normal: DVec3::NEG_Y, distance: height };
    let steps = record(cap, |t| cut_traced(&scene, &[plane], &Default::default(), t))?;
    let (inside, edges, caps) = (Vec::new(), Vec::new(), Vec::new());
    let mut state = State { triangles, height, inside, edges, caps };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns a point as it is seen from the right above.
fn aslant(p: DVec3) -> DVec2 {
    DVec2::new(p.x - 0.45 * p.z, p.y - 0.35 * p.z)
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    crate::view::cull::triangle_area([a, b, c]).length()
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Plane(_) => PLANE.with([("height", self.height.into())]),
            Step::Triangle { triangle, inside, .. } => {
                let count = inside.into_iter().filter(|inside| *inside).count();
                self.inside.push(count);
                let template = match count {
                    3 => &KEPT,
                    0 => &AWAY,
                    _ => &DIVIDED,
                };
                template.with([("triangle", (triangle + 1).into()), ("count", count.into())])
            }
            Step::Edge([from, to]) => {
                self.edges.push([from, to]);
                EDGE.with([("from", from.into()), ("to", to.into())])
            }
            Step::Cap(corners) => {
                self.caps.push(corners);
                let sum: f64 = self.caps.iter().map(|corners| area(*corners)).sum();
                CAP.with([("area", area(corners).into()), ("sum", sum.into())])
            }
            Step::Open { .. } => OPEN.with([]),
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([Word::new("list", "Liste"), Word::new("entries", "Einträge")]);
        let count = |wanted: fn(usize) -> bool| -> Value {
            self.inside.iter().filter(|count| wanted(**count)).count().into()
        };
        table.row(Word::new("kept whole", "ganz behalten"), [count(|n| n == 3)]);
        table.row(Word::new("cut away", "weggefallen"), [count(|n| n == 0)]);
        table.row(Word::new("divided", "geteilt"), [count(|n| n == 1 || n == 2)]);
        table
            .row(Word::new("edges of the cap", "Kanten der Deckfläche"), [self.edges.len().into()]);
        table.row(
            Word::new("triangles of the cap", "Dreiecke der Deckfläche"),
            [self.caps.len().into()],
        );
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let all = || self.triangles.iter().flatten();
        let mut picture = Picture::around(all().map(|p| aslant(*p)), 0.12);
        picture.picture_from_input = None;
        let outline = |t: &[DVec3; 3]| [t[0], t[1], t[2], t[0]].map(aslant);
        for (index, triangle) in self.triangles.iter().enumerate() {
            let look = match self.inside.get(index) {
                None => Look::Window,
                Some(0) => Look::Thin,
                Some(3) => Look::First,
                Some(_) => Look::Pale,
            };
            picture.chain(outline(triangle), look);
        }
        self.add_plane(&mut picture);
        for corners in &self.caps {
            picture.ring(corners.map(aslant), Look::Result);
        }
        for edge in &self.edges {
            picture.chain(edge.map(aslant), Look::Second);
        }
        match *step {
            Step::Triangle { triangle, .. } => {
                if let Some(corners) = self.triangles.get(triangle) {
                    picture.chain(outline(corners), Look::Now);
                }
            }
            Step::Edge([from, to]) => picture.arrow(aslant(from), aslant(to), Look::Now),
            Step::Cap(corners) => picture.chain(outline(&corners), Look::Now),
            Step::Plane(_) | Step::Open { .. } => {}
        }
        picture
    }

    /// Draws the plane's part around the body.
    fn add_plane(&self, picture: &mut Picture) {
        let all = || self.triangles.iter().flatten();
        let low = all().fold(DVec3::MAX, |low, p| low.min(*p));
        let high = all().fold(DVec3::MIN, |high, p| high.max(*p));
        let sides = [(low.x, low.z), (high.x, low.z), (high.x, high.z), (low.x, high.z)];
        let corners = sides.map(|(x, z)| aslant(DVec3::new(x, self.height, z)));
        let [a, b, c, d] = corners;
        picture.chain([a, b, c, d, a], Look::Dashed);
    }
}
