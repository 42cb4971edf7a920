//! The lesson of culling by bounding volumes: a view volume from above, and the boxes of objects.

use super::frame::{Frames, Numbered, Shown, Want, record};
use super::grid::letter;
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::clip::line::ConvexPolygon;
use crate::math::{DVec2, Plane, Rect};
use crate::scene::Aabb;
use crate::trace::PseudocodeLine;
use crate::view::cull::{Containment, ConvexVolume, INFO, Step};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "volume",
            title: Word::new(
                "a view volume from above, and five objects",
                "ein Sichtvolumen von oben und fünf Objekte",
            ),
            input: || {
                let objects = [
                    vec![(-1.0, 4.0), (1.5, 5.0), (0.0, 6.0)],
                    vec![(4.5, 6.2), (7.0, 7.0), (5.5, 8.2)],
                    vec![(7.5, 2.0), (9.5, 2.5), (8.0, 4.0)],
                    vec![(7.1, 8.9), (8.1, 8.9), (8.1, 9.9), (7.1, 9.9)],
                    vec![(-3.0, -2.0), (-1.0, -1.5), (-2.0, -0.5)],
                ];
                scene(&[(-1.0, 1.0), (1.0, 1.0), (7.0, 9.0), (-7.0, 9.0)], &objects)
            },
        },
        Example {
            name: "false-crossing",
            title: Word::new(
                "outside near a corner, but reported as crossing",
                "außen an einer Ecke und doch „kreuzt“",
            ),
            input: || {
                let objects = [vec![(6.05, 2.5), (7.05, 2.5), (7.05, 3.5), (6.05, 3.5)]];
                scene(&[(0.0, 0.0), (6.0, 3.0), (0.0, 6.0)], &objects)
            },
        },
        Example::new(
            "around",
            "a box around everything: all planes cut it",
            "ein Kasten um alles: Alle Ebenen schneiden ihn",
            || {
                scene(
                    &[(0.0, 0.0), (6.0, 0.0), (3.0, 5.0)],
                    &[vec![(-3.0, -2.0), (9.0, -2.0), (9.0, 7.0), (-3.0, 7.0)]],
                )
            },
        ),
        Example::new(
            "touching",
            "boxes that touch a border from inside and from outside",
            "Kästen, die einen Rand von innen und von außen berühren",
            || {
                let box_at = |x: f64| vec![(x, 2.0), (x + 2.0, 2.0), (x + 2.0, 4.0), (x, 4.0)];
                scene(
                    &[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (0.0, 6.0)],
                    &[box_at(6.0), box_at(8.0)],
                )
            },
        ),
        Example::new(
            "diagonal",
            "a long diagonal object: its box is cut, it is not",
            "ein langes schräges Objekt: Sein Kasten wird geschnitten, es selbst nicht",
            || {
                let bar = vec![(4.0, 7.0), (9.0, 2.0), (9.4, 2.4), (4.4, 7.4)];
                scene(&[(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0)], &[bar])
            },
        ),
        Example::new(
            "all-inside",
            "three objects inside: every plane is tested for each",
            "drei Objekte innen: Für jedes wird jede Ebene geprüft",
            || {
                let small = |x: f64, y: f64| vec![(x, y), (x + 1.0, y), (x + 0.5, y + 1.0)];
                let objects = [small(1.0, 1.0), small(3.0, 1.5), small(2.0, 3.0)];
                scene(&[(0.0, 0.0), (5.0, 0.0), (6.0, 3.0), (3.0, 5.5), (0.0, 4.0)], &objects)
            },
        ),
    ],
    templates: &[&INSIDE, &CROSSING, &OUTSIDE, &ALL, &SOME, &NONE],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "rings as objects, and a convex ring around what is in view",
    "Ringe als Objekte und ein konvexer Ring um das, was im Blick ist",
);

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&p| p.into()).collect()
}

/// Returns a region and objects.
fn scene(region: &[(f64, f64)], objects: &[Vec<(f64, f64)>]) -> Input {
    let rings = objects.iter().map(|object| ring(object)).collect();
    Input::Figure(Figure { rings, clip: vec![ring(region)], ..Figure::default() })
}

static INSIDE: Template = Template::new(
    "plane",
    "Box {box}, plane {plane}: the centre is at s = {distance}, the reach is r = {reach}. s ≥ r: wholly inside.",
    "Kasten {box}, Ebene {plane}: Die Mitte liegt bei s = {distance}, die Reichweite ist r = {reach}. s ≥ r: ganz innen.",
);
static CROSSING: Template = Template::new(
    "plane",
    "Box {box}, plane {plane}: s = {distance}, r = {reach}. −r ≤ s < r: the plane cuts the box.",
    "Kasten {box}, Ebene {plane}: s = {distance}, r = {reach}. −r ≤ s < r: Die Ebene schneidet den Kasten.",
);
static OUTSIDE: Template = Template::new(
    "plane",
    "Box {box}, plane {plane}: s = {distance}, r = {reach}. s < −r: wholly outside, no other plane is tested.",
    "Kasten {box}, Ebene {plane}: s = {distance}, r = {reach}. s < −r: ganz außen, keine weitere Ebene wird geprüft.",
);
static ALL: Template = Template::new(
    "found",
    "Box {box} is inside all planes: the object is drawn without clipping.",
    "Kasten {box} liegt innerhalb aller Ebenen: Das Objekt wird ohne Clipping gezeichnet.",
);
static SOME: Template = Template::new(
    "found",
    "Box {box} is cut by a plane and outside none: the object is drawn and clipped.",
    "Kasten {box} wird von einer Ebene geschnitten und liegt außerhalb von keiner: Das Objekt wird geclippt gezeichnet.",
);
static NONE: Template = Template::new(
    "found",
    "Box {box} is outside: none of the object's faces is drawn.",
    "Kasten {box} liegt außen: Keine Fläche des Objekts wird gezeichnet.",
);

/// The region, the objects with their boxes, and the tests so far.
#[derive(Clone)]
struct State {
    region: Vec<DVec2>,
    objects: Vec<Vec<DVec2>>,
    boxes: Vec<Rect>,
    found: Vec<Option<Containment>>,
    rows: Vec<[Value; 4]>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    let missing = |what: &str| Error::parameter("input", format!("without {what}"), TAKES.en);
    let region = figure.clip.first().ok_or_else(|| missing("a region"))?;
    let region = ConvexPolygon::new(region)?.vertices().to_vec();
    let objects: Vec<_> = figure.rings.iter().filter(|ring| !ring.is_empty()).cloned().collect();
    if objects.is_empty() {
        return Err(missing("objects"));
    }
    let boxes: Vec<Rect> =
        objects.iter().filter_map(|ring| Rect::around(ring.iter().copied())).collect();
    let volume = volume(&region);
    let steps = record(cap, |t| {
        for (number, own) in boxes.iter().enumerate() {
            let own = Aabb { min: own.min().extend(0.0), max: own.max().extend(0.0) };
            volume.contains_box_traced(&own, &mut Numbered { number, t });
        }
        Ok(())
    })?;
    let found = vec![None; boxes.len()];
    let mut state = State { region, objects, boxes, found, rows: Vec::new() };
    Ok(Frames::new(steps, move |(number, step), want| state.show(*number, step, want)))
}

/// Returns the ends of each border of the region.
fn borders(region: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    region.iter().zip(region.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

/// Returns the upright planes through the borders of a region, whose vertices are counter-clockwise.
fn volume(region: &[DVec2]) -> ConvexVolume {
    let plane = |[a, b]: [DVec2; 2]| {
        let inwards = (b - a).perp().normalize_or_zero();
        Plane::through(a.extend(0.0), inwards.extend(0.0))
    };
    ConvexVolume::new(borders(region).map(plane).collect())
}

impl State {
    fn show(&mut self, number: usize, step: &Step, want: Want) -> Shown {
        let caption = self.take(number, step);
        want.shown(step.line(), caption, || self.table(), || self.picture(number, step))
    }

    fn take(&mut self, number: usize, step: &Step) -> Caption {
        let name = ("box", letter(number).into());
        match *step {
            Step::Plane { plane, distance, reach, relation } => {
                if plane == 0 {
                    self.rows.clear();
                }
                let word = relation_word(relation);
                self.rows.push([letter(number).into(), distance.into(), reach.into(), word]);
                let template = match relation {
                    Containment::Inside => &INSIDE,
                    Containment::Crossing => &CROSSING,
                    Containment::Outside => &OUTSIDE,
                };
                let plane = ("plane", (plane + 1).into());
                template.with([name, plane, ("distance", distance.into()), ("reach", reach.into())])
            }
            Step::Found(relation) => {
                if let Some(found) = self.found.get_mut(number) {
                    *found = Some(relation);
                }
                let template = match relation {
                    Containment::Inside => &ALL,
                    Containment::Crossing => &SOME,
                    Containment::Outside => &NONE,
                };
                template.with([name])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("plane", "Ebene"),
            Word::new("box", "Kasten"),
            Word::new("s", "s"),
            Word::new("r", "r"),
            Word::new("relation", "Lage"),
        ]);
        for (plane, cells) in self.rows.iter().enumerate() {
            table.row(plane + 1, cells.clone());
        }
        table
    }

    fn picture(&self, number: usize, step: &Step) -> Picture {
        let corners = self.boxes.iter().flat_map(|own| [own.min(), own.max()]);
        let mut picture = Picture::around(self.region.iter().copied().chain(corners), 0.08);
        picture.ring(self.region.clone(), Look::Pale);
        for (plane, ends) in borders(&self.region).enumerate() {
            let now = matches!(*step, Step::Plane { plane: own, .. } if own == plane);
            picture.chain(ends, if now { Look::Now } else { Look::Window });
            picture.label((ends[0] + ends[1]) / 2.0, (0.0, 0.0), plane + 1);
        }
        for (own, (object, around)) in self.objects.iter().zip(&self.boxes).enumerate() {
            let look = match self.found.get(own).copied().flatten() {
                None => Look::Pale,
                Some(Containment::Inside) => Look::Result,
                Some(Containment::Crossing) => Look::First,
                Some(Containment::Outside) => Look::Second,
            };
            picture.ring(object.clone(), look);
            picture.frame(around, if own == number { Look::Now } else { Look::Thin });
            picture.label((around.min() + around.max()) / 2.0, (0.0, 0.0), letter(own));
        }
        picture
    }
}

fn relation_word(relation: Containment) -> Value {
    match relation {
        Containment::Inside => Word::new("inside", "innen"),
        Containment::Crossing => Word::new("crosses", "kreuzt"),
        Containment::Outside => Word::new("outside", "außen"),
    }
    .into()
}
