//! The lesson of the check that polygons are valid.

use super::frame::{Frames, Shown, Want, record};
use super::grid::letter;
use super::input::{Figure, Input};
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Caption, Template, Value, Word};
use crate::Result;
use crate::clip::polygon::Shapes;
use crate::clip::polygon::validity::{EdgeRelation, Fault, Flaw, INFO, Step, flaws_traced};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example::new(
            "divided",
            "two holes that touch the border and each other cut the inside in two",
            "zwei Löcher, die den Rand und einander berühren, teilen das Innere",
            || {
                let lower = &[(2.0, 0.0), (3.0, 2.0), (2.0, 3.0), (1.0, 2.0)];
                let upper = &[(2.0, 3.0), (3.0, 4.0), (2.0, 6.0), (1.0, 4.0)];
                polygons(&[SQUARE, lower, upper], &[])
            },
        ),
        Example::new(
            "bow",
            "a bow: two edges cross",
            "eine Schleife: Zwei Kanten kreuzen sich",
            || polygons(&[&[(0.0, 0.0), (6.0, 4.0), (6.0, 0.0), (0.0, 4.0)]], &[]),
        ),
        Example::new(
            "spike",
            "a spike: edges run along each other",
            "ein Dorn: Kanten laufen aneinander entlang",
            || polygons(&[&[(0.0, 0.0), (4.0, 0.0), (4.0, 6.0), (4.0, 3.0), (0.0, 3.0)]], &[]),
        ),
        Example::new(
            "self-touch",
            "a ring that touches itself in a vertex",
            "ein Ring, der sich in einer Ecke selbst berührt",
            || {
                let ring = [(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (3.0, 0.0), (0.0, 4.0)];
                polygons(&[&ring], &[])
            },
        ),
        Example::new(
            "touching-hole",
            "a hole that touches the border in one point: valid",
            "ein Loch, das den Rand in einem Punkt berührt: gültig",
            || polygons(&[SQUARE, &[(0.0, 3.0), (3.0, 2.0), (3.0, 4.0)]], &[]),
        ),
        Example::new(
            "passing",
            "a hole that passes through the border at two vertices",
            "ein Loch, das in zwei Ecken durch den Rand geht",
            || {
                let outer =
                    &[(0.0, 0.0), (6.0, 0.0), (4.0, 2.0), (4.0, 4.0), (6.0, 6.0), (0.0, 6.0)];
                polygons(&[outer, &[(2.0, 3.0), (4.0, 2.0), (5.0, 3.0), (4.0, 4.0)]], &[])
            },
        ),
        Example::new(
            "nested-holes",
            "a hole in a hole, and one outside",
            "ein Loch in einem Loch, und eines außerhalb",
            || {
                let hole = &[(1.0, 1.0), (5.0, 1.0), (5.0, 5.0), (1.0, 5.0)];
                let inner = &[(2.0, 2.0), (4.0, 2.0), (3.0, 4.0)];
                polygons(&[SQUARE, hole, inner, &[(7.0, 1.0), (9.0, 1.0), (8.0, 3.0)]], &[])
            },
        ),
        Example::new(
            "in-another",
            "a polygon in another one",
            "ein Polygon in einem anderen",
            || polygons(&[SQUARE], &[&[(2.0, 2.0), (4.0, 2.0), (3.0, 4.0)]]),
        ),
        Example::new(
            "two-points",
            "a ring of two different points",
            "ein Ring aus zwei verschiedenen Punkten",
            || polygons(&[SQUARE, &[(2.0, 2.0), (2.0, 2.0), (4.0, 4.0)]], &[]),
        ),
    ],
    templates: &[
        &RING,
        &NO_RING,
        &APART,
        &NEIGHBOURS,
        &CROSSES,
        &OVERLAPS,
        &SELF_TOUCH,
        &TOUCHES,
        &FEW,
        &PASSES,
        &DIVIDES,
        &HOLE_OUTSIDE,
        &HOLE_IN_HOLE,
        &IN_POLYGON,
        &STOPPED,
        &FAULTS,
        &VALID,
    ],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "rings of a polygon, the outer one first, then its holes; the rings of the clip are a second polygon",
    "Ringe eines Polygons, erst der äußere, dann seine Löcher; die Ringe des Clips sind ein zweites Polygon",
);

type Points<'a> = &'a [(f64, f64)];

const SQUARE: Points<'static> = &[(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)];

/// Returns an input of one or two polygons.
fn polygons(first: &[Points], second: &[Points]) -> Input {
    let ring = |ring: &Points| ring.iter().copied().map(DVec2::from).collect();
    let [rings, clip] = [first, second].map(|polygon| polygon.iter().map(ring).collect());
    Input::Figure(Figure { rings, clip, ..Figure::default() })
}

static RING: Template = Template::new(
    "ring",
    "Ring {ring} has {count} points without repeated ones.",
    "Ring {ring} hat ohne wiederholte {count} Punkte.",
);
static NO_RING: Template = Template::new(
    "ring",
    "Ring {ring} has fewer than three different points: it is left out.",
    "Ring {ring} hat weniger als drei verschiedene Punkte: Er fällt weg.",
);
static APART: Template = Template::new(
    "pair",
    "Edges {p} and {q} have nothing in common.",
    "Die Kanten {p} und {q} haben nichts gemeinsam.",
);
static NEIGHBOURS: Template = Template::new(
    "pair",
    "Edges {p} and {q} follow each other: their common vertex is no fault.",
    "Die Kanten {p} und {q} folgen aufeinander: Ihre gemeinsame Ecke ist kein Fehler.",
);
static CROSSES: Template = Template::new(
    "pair",
    "Edges {p} and {q} cross in {at}: a fault.",
    "Die Kanten {p} und {q} kreuzen sich in {at}: ein Fehler.",
);
static OVERLAPS: Template = Template::new(
    "pair",
    "Edges {p} and {q} run along each other, as in {at}: a fault.",
    "Die Kanten {p} und {q} laufen aneinander entlang, so in {at}: ein Fehler.",
);
static SELF_TOUCH: Template = Template::new(
    "pair",
    "Edges {p} and {q} of one ring touch in {at}: a fault, the ring touches itself.",
    "Die Kanten {p} und {q} eines Rings berühren sich in {at}: ein Fehler, der Ring berührt sich selbst.",
);
static TOUCHES: Template = Template::new(
    "pair",
    "Edges {p} and {q} of two rings touch in {at}: the point is kept for later.",
    "Die Kanten {p} und {q} zweier Ringe berühren sich in {at}: Der Punkt wird für später gemerkt.",
);
static FEW: Template = Template::new(
    "flaw",
    "A fault: ring {ring} has less than three different points.",
    "Ein Fehler: Ring {ring} hat weniger als drei verschiedene Punkte.",
);
static PASSES: Template = Template::new(
    "flaw",
    "A fault: in {at} the rings {ring} and {other} do not only touch, one passes through the other.",
    "Ein Fehler: In {at} berühren sich die Ringe {ring} und {other} nicht nur, einer geht durch den anderen.",
);
static DIVIDES: Template = Template::new(
    "flaw",
    "A fault: the touch of {ring} and {other} in {at} closes a cycle of rings, and the inside is in two pieces.",
    "Ein Fehler: Die Berührung von {ring} und {other} in {at} schließt einen Kreis von Ringen, und das Innere zerfällt.",
);
static HOLE_OUTSIDE: Template = Template::new(
    "flaw",
    "A fault: hole {other} lies outside its outer ring {ring}.",
    "Ein Fehler: Loch {other} liegt außerhalb seines äußeren Rings {ring}.",
);
static HOLE_IN_HOLE: Template = Template::new(
    "flaw",
    "A fault: of the holes {ring} and {other} one lies in the other.",
    "Ein Fehler: Von den Löchern {ring} und {other} liegt eines im anderen.",
);
static IN_POLYGON: Template = Template::new(
    "flaw",
    "A fault: of the polygons with the rings {ring} and {other} one lies in the other.",
    "Ein Fehler: Von den Polygonen mit den Ringen {ring} und {other} liegt eines im anderen.",
);
static STOPPED: Template = Template::new(
    "stopped",
    "With such faults inside and outside are not defined: the nesting of rings is not checked.",
    "Bei solchen Fehlern ist nicht bestimmt, was innen ist: Die Verschachtelung der Ringe wird nicht geprüft.",
);
static FAULTS: Template = Template::new(
    "sorted",
    "{count} {count|fault|faults}, each place once: the polygons are not valid.",
    "{count} Fehler, jeder Ort einmal: Die Polygone sind ungültig.",
);
static VALID: Template = Template::new(
    "sorted",
    "No fault was found: the polygons are valid.",
    "Kein Fehler wurde gefunden: Die Polygone sind gültig.",
);

/// The rings without repeated points, and what has been found.
#[derive(Clone)]
struct State {
    rings: Vec<Vec<DVec2>>,
    touches: Vec<DVec2>,
    flaws: Vec<Flaw>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let figure = input.figure(TAKES)?;
    figure.ring(TAKES)?;
    let mut shapes = Shapes::new();
    for polygon in [&figure.rings, &figure.clip] {
        for ring in polygon {
            shapes.push_ring(ring.iter().copied());
        }
        shapes.end_polygon();
    }
    let steps = record(cap, |t| flaws_traced(&shapes, t))?;
    let rings = shapes.rings().map(|ring| {
        let mut points = ring.to_vec();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points
    });
    let mut state = State { rings: rings.collect(), touches: Vec::new(), flaws: Vec::new() };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

/// Returns the name of an edge: the letter of its ring and the number of its first point.
fn edge_name([ring, index]: [usize; 2]) -> Value {
    format!("{}{index}", letter(ring)).into()
}

/// Returns the words for a fault in a table.
const fn words(fault: Fault) -> Word {
    match fault {
        Fault::FewPoints => Word::new("few points", "wenige Punkte"),
        Fault::Crossing => Word::new("crossing", "Kreuzung"),
        Fault::Overlap => Word::new("overlap", "Überlappung"),
        Fault::SelfTouch => Word::new("self-touch", "Selbstberührung"),
        Fault::HoleOutside => Word::new("hole outside", "Loch außerhalb"),
        Fault::HoleInHole => Word::new("hole in hole", "Loch im Loch"),
        Fault::PolygonInPolygon => Word::new("polygon in polygon", "Polygon im Polygon"),
        Fault::Divided => Word::new("divided", "geteilt"),
    }
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Ring { ring, points: 0 } => NO_RING.with([("ring", letter(ring).into())]),
            Step::Ring { ring, points } => {
                RING.with([("ring", letter(ring).into()), ("count", points.into())])
            }
            Step::Pair { edges, relation } => self.compared(edges, relation),
            Step::Found(flaw) => {
                self.flaws.push(flaw);
                let ring = ("ring", letter(flaw.rings[0]).into());
                let other = ("other", letter(flaw.rings[1]).into());
                let at = ("at", flaw.at.into());
                match flaw.fault {
                    Fault::FewPoints => FEW.with([ring]),
                    Fault::Divided => DIVIDES.with([ring, other, at]),
                    Fault::HoleOutside => HOLE_OUTSIDE.with([ring, other]),
                    Fault::HoleInHole => HOLE_IN_HOLE.with([ring, other]),
                    Fault::PolygonInPolygon => IN_POLYGON.with([ring, other]),
                    Fault::Crossing | Fault::Overlap | Fault::SelfTouch => {
                        PASSES.with([ring, other, at])
                    }
                }
            }
            Step::Stopped => STOPPED.with([]),
            Step::Sorted { count: 0 } => VALID.with([]),
            Step::Sorted { count } => FAULTS.with([("count", count.into())]),
        }
    }

    fn compared(&mut self, edges: [[usize; 2]; 2], relation: EdgeRelation) -> Caption {
        let [p, q] = edges.map(edge_name);
        let (p, q) = (("p", p), ("q", q));
        match relation {
            EdgeRelation::Apart => APART.with([p, q]),
            EdgeRelation::Neighbours => NEIGHBOURS.with([p, q]),
            EdgeRelation::Touch(at) => {
                if !self.touches.contains(&at) {
                    self.touches.push(at);
                }
                TOUCHES.with([p, q, ("at", at.into())])
            }
            EdgeRelation::Flaw(flaw) => {
                if !self.flaws.contains(&flaw) {
                    self.flaws.push(flaw);
                }
                let template = match flaw.fault {
                    Fault::Overlap => &OVERLAPS,
                    Fault::SelfTouch => &SELF_TOUCH,
                    _ => &CROSSES,
                };
                template.with([p, q, ("at", flaw.at.into())])
            }
        }
    }

    /// Returns the faults so far.
    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("fault", "Fehler"),
            Word::new("kind", "Art"),
            Word::new("place", "Ort"),
            Word::new("rings", "Ringe"),
        ]);
        for (number, flaw) in self.flaws.iter().enumerate() {
            let rings: Vec<String> = flaw.rings.map(letter).to_vec();
            table.row(number + 1, [words(flaw.fault).into(), flaw.at.into(), rings.into()]);
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = Picture::around(self.rings.iter().flatten().copied(), 0.12);
        picture.rings(&self.rings, Look::First);
        for (number, ring) in self.rings.iter().enumerate() {
            let closed: Vec<DVec2> = ring.iter().chain(ring.first()).copied().collect();
            picture.chain(closed, Look::Window);
            // Away from the middle of the ring, where edges are fewer; offsets count downwards.
            let middle = ring.iter().sum::<DVec2>() / ring.len().max(1) as f64;
            for (k, &at) in ring.iter().enumerate() {
                let by = (at - middle).normalize_or(DVec2::ONE) * DVec2::new(13.0, -13.0);
                picture.label(at, by.into(), format!("{}{k}", letter(number)));
            }
        }
        let ends = |[ring, index]: [usize; 2]| {
            let ring = self.rings.get(ring)?;
            Some([*ring.get(index)?, *ring.get((index + 1) % ring.len())?])
        };
        match *step {
            Step::Pair { edges, .. } => {
                for ends in edges.into_iter().filter_map(ends) {
                    picture.chain(ends, Look::Now);
                }
            }
            Step::Ring { ring, .. } => {
                let ring = self.rings.get(ring).into_iter();
                let closed = ring.flat_map(|ring| ring.iter().chain(ring.first()).copied());
                picture.chain(closed.collect::<Vec<_>>(), Look::Now);
            }
            Step::Found(_) | Step::Stopped | Step::Sorted { .. } => {}
        }
        self.touches.iter().for_each(|&at| picture.dot(at, Look::Result));
        self.flaws.iter().for_each(|flaw| picture.dot(flaw.at, Look::Second));
        if let Step::Found(flaw) = step {
            picture.dot(flaw.at, Look::Now);
        }
        picture
    }
}
