//! The lessons of hidden lines whose visibility is carried along edges: by numbers, and by sets of faces.

use super::bodies::{BESIDE, BOX, BOXES, PIERCED, THREE, check_count, turned};
use super::{EXAMPLES, TAKES};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::grid::letter;
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::back_face::Eye;
use crate::visibility::line::appel::{self, Cause};
use crate::visibility::line::face_net::FaceNet;
use crate::visibility::line::galimberti_montanari as natures;
use crate::work::Work;
use std::collections::BTreeMap;

pub(super) const APPEL: Lesson = Lesson {
    name: appel::INFO.name,
    info: &appel::INFO,
    takes: BODIES,
    examples: &[STEP, BOXES, PIERCED, BESIDE, THREE, BOX],
    templates: &[&CONTOURS, &RAY, &EDGE, &EDGE_BEHIND, &CROSSES, &PIERCES, &CORNER, &CORNER_BEHIND],
    unreached: &[],
    make: |_, input, _, cap| by_numbers(input, cap),
};

pub(super) const GALIMBERTI_MONTANARI: Lesson = Lesson {
    name: natures::INFO.name,
    info: &natures::INFO,
    takes: TAKES,
    examples: &[super::hidden_line::STRIP, EXAMPLES[0], BOXES, PIERCED, BESIDE, BOX],
    templates: &[
        &HIDERS,
        &COMPARED,
        &BEGINS,
        &BEGINS_BEHIND,
        &ENTERS,
        &LEAVES,
        &ENTERS_PIERCED,
        &LEAVES_PIERCED,
        &ENDS,
        &ENDS_BEHIND,
    ],
    unreached: &[],
    make: |_, input, _, cap| by_sets(input, cap),
};

const BODIES: Word = Word::new(
    "faces of closed bodies, seen from +z",
    "Flächen geschlossener Körper, von +z gesehen",
);

/// A body that is not convex: of a corner's own faces, some hide edges there.
const STEP: Example = Example {
    name: "step",
    title: Word::new(
        "a step, which hides parts of itself",
        "eine Stufe, die Teile von sich verdeckt",
    ),
    input: || {
        let profile = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (2.0, 1.0), (2.0, 3.0), (0.0, 3.0)];
        let at = |z: f64| profile.map(|(x, y)| turned(DVec3::new(4.0 - x, y, 3.0 - z)));
        let (near, far) = (at(0.0), at(3.0));
        let side = |i: usize| {
            let next = (i + 1) % near.len();
            vec![near[i], near[next], far[next], far[i]]
        };
        let mut faces: Vec<Vec<DVec3>> = (0..near.len()).map(side).collect();
        faces.extend([near.to_vec(), far.to_vec()]);
        Input::Faces(faces)
    },
};

static CONTOURS: Template = Template::new(
    "contours",
    "Contour edges, between a front and a back: {edges}. Only behind them can the number of hiding faces change.",
    "Konturkanten, zwischen Vorder- und Rückseite: {edges}. Nur hinter ihnen kann sich die Zahl verdeckender Flächen ändern.",
);
static RAY: Template = Template::new(
    "ray",
    "A ray from corner {corner} to the eye meets {faces}: Q = {q}. It is the only ray for all corners joined with this one.",
    "Ein Strahl von Ecke {corner} zum Auge trifft {faces}: Q = {q}. Es ist der einzige für alle damit verbundenen Ecken.",
);
static EDGE: Template = Template::new(
    "edge",
    "Edge {edge} begins at corner {corner} with its Q = {q}: no face of the corner hides it.",
    "Kante {edge} beginnt an Ecke {corner} mit deren Q = {q}: Keine Fläche der Ecke verdeckt sie.",
);
static EDGE_BEHIND: Template = Template::new(
    "edge",
    "Edge {edge} begins at corner {corner}, Q = {q}; {faces} at this corner hide its beginning: Q = {after}.",
    "Kante {edge} beginnt an Ecke {corner}, Q = {q}; {faces} an dieser Ecke verdecken ihren Anfang: Q = {after}.",
);
static CROSSES: Template = Template::new(
    "change",
    "At t = {t} the edge {edge} crosses behind the contour edge {other}: Q goes from {q} to {after}.",
    "Bei t = {t} kreuzt die Kante {edge} hinter der Konturkante {other}: Q geht von {q} auf {after}.",
);
static PIERCES: Template = Template::new(
    "change",
    "At t = {t} the edge {edge} pierces face {other}: Q goes from {q} to {after}.",
    "Bei t = {t} durchdringt die Kante {edge} die Fläche {other}: Q geht von {q} auf {after}.",
);
static CORNER: Template = Template::new(
    "corner",
    "Edge {edge} ends at corner {corner}, whose Q is {after}.",
    "Kante {edge} endet an Ecke {corner}, deren Q {after} ist.",
);
static CORNER_BEHIND: Template = Template::new(
    "corner",
    "Edge {edge} ends with Q = {q}, hidden by {faces} of corner {corner} itself: the corner has Q = {after}.",
    "Kante {edge} endet mit Q = {q}, verdeckt von {faces} der Ecke {corner} selbst: Die Ecke hat Q = {after}.",
);

static HIDERS: Template = Template::new(
    "hiders",
    "Faces that hide what is behind them: {faces}; the backs of closed bodies are left out.",
    "Flächen, die Dahinterliegendes verdecken: {faces}; Rückseiten geschlossener Körper fallen weg.",
);
static COMPARED: Template = Template::new(
    "compared",
    "Corner {corner} is compared with all faces: its nature is {nature}. All corners joined with it follow from this one.",
    "Ecke {corner} wird mit allen Flächen verglichen: Ihre Natur ist {nature}. Alle verbundenen Ecken folgen aus dieser.",
);
static BEGINS: Template = Template::new(
    "edge",
    "Edge {edge} begins at corner {corner} with its nature {nature}.",
    "Kante {edge} beginnt an Ecke {corner} mit deren Natur {nature}.",
);
static BEGINS_BEHIND: Template = Template::new(
    "edge",
    "Edge {edge} begins at corner {corner} behind {own} of the corner itself: its nature is {nature}.",
    "Kante {edge} beginnt an Ecke {corner} hinter {own} der Ecke selbst: Ihre Natur ist {nature}.",
);
static ENTERS: Template = Template::new(
    "change",
    "At t = {t} the edge {edge} comes behind {face} across its edge {other}: the nature is {nature}.",
    "Bei t = {t} gerät die Kante {edge} über deren Kante {other} hinter {face}: Die Natur ist {nature}.",
);
static LEAVES: Template = Template::new(
    "change",
    "At t = {t} the edge {edge} comes out from behind {face} across its edge {other}: the nature is {nature}.",
    "Bei t = {t} kommt die Kante {edge} über deren Kante {other} hinter {face} hervor: Die Natur ist {nature}.",
);
static ENTERS_PIERCED: Template = Template::new(
    "change",
    "At t = {t} the edge {edge} goes through {face} to its back: the nature is {nature}.",
    "Bei t = {t} geht die Kante {edge} durch {face} hindurch nach hinten: Die Natur ist {nature}.",
);
static LEAVES_PIERCED: Template = Template::new(
    "change",
    "At t = {t} the edge {edge} goes through {face} to the eye's side: the nature is {nature}.",
    "Bei t = {t} geht die Kante {edge} durch {face} hindurch zum Auge: Die Natur ist {nature}.",
);
static ENDS: Template = Template::new(
    "corner",
    "Edge {edge} ends at corner {corner}, whose nature is {nature}.",
    "Kante {edge} endet an Ecke {corner}, deren Natur {nature} ist.",
);
static ENDS_BEHIND: Template = Template::new(
    "corner",
    "Edge {edge} ends behind {own} of corner {corner} itself: the corner's nature is {nature}.",
    "Kante {edge} endet hinter {own} der Ecke {corner} selbst: Die Natur der Ecke ist {nature}.",
);

/// A part of an edge: its start, the faces that hide it or their number, and whether it is visible.
type Part = (f64, Value, bool);

/// The corners and lines that are known so far.
#[derive(Clone)]
struct State {
    net: FaceNet,
    /// Head of the columns of what hides a corner or a part.
    head: Word,
    known: BTreeMap<usize, Value>,
    lines: Vec<([usize; 2], Vec<Part>)>,
    /// True while the last line is carried along.
    is_open: bool,
    /// Edges and faces that the step is about.
    marked: Vec<usize>,
    face: Option<usize>,
    /// The corner that the step is about.
    corner: Option<usize>,
}

fn state(input: &Input, takes: Word, head: Word) -> Result<State> {
    let faces = input.faces(takes)?;
    check_count(faces)?;
    let net = FaceNet::new(faces, Eye::Along(DVec3::NEG_Z))?;
    let (known, lines, marked) = (BTreeMap::new(), Vec::new(), Vec::new());
    Ok(State { net, head, known, lines, is_open: false, marked, face: None, corner: None })
}

fn by_numbers(input: &Input, cap: usize) -> Result<Frames> {
    let mut state = state(input, BODIES, Word::new("Q", "Q"))?;
    let steps = record(cap, |t| appel::draw(&state.net, &Default::default(), &Work::default(), t))?;
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.number(step);
        want.shown(step.line(), caption, || state.table(), || state.picture())
    }))
}

fn by_sets(input: &Input, cap: usize) -> Result<Frames> {
    let mut state = state(input, TAKES, Word::new("nature", "Natur"))?;
    let steps =
        record(cap, |t| natures::draw(&state.net, &Default::default(), &Work::default(), t))?;
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.nature(step);
        want.shown(step.line(), caption, || state.table(), || state.picture())
    }))
}

impl State {
    fn number(&mut self, step: &appel::Step) -> Caption {
        use appel::Step;
        (self.marked, self.face, self.corner) = (Vec::new(), None, None);
        match step {
            Step::Contours { edges } => {
                self.marked.clone_from(edges);
                let edges: Vec<Value> = edges.iter().map(|edge| self.edge(*edge)).collect();
                CONTOURS.with([("edges", edges.into())])
            }
            Step::Ray { corner, faces } => {
                self.know(*corner, faces.len().into());
                let q = ("q", faces.len().into());
                RAY.with([("corner", (corner + 1).into()), ("faces", named(faces)), q])
            }
            Step::Edge { edge, corners, faces, invisibility: [q, after] } => {
                self.begin(*corners, (*after).into(), *after == 0);
                let [edge, corner] =
                    [("edge", self.edge(*edge)), ("corner", (corners[0] + 1).into())];
                let [q, after] = [("q", (*q).into()), ("after", (*after).into())];
                if faces.is_empty() {
                    return EDGE.with([edge, corner, q]);
                }
                EDGE_BEHIND.with([edge, corner, q, ("faces", named(faces)), after])
            }
            Step::Change { edge, t, cause, invisibility: [q, after] } => {
                self.change(*t, (*after).into(), *after == 0);
                let values = [("t", (*t).into()), ("q", (*q).into()), ("after", (*after).into())];
                let ([t, q, after], edge) = (values, ("edge", self.edge(*edge)));
                match *cause {
                    Cause::Contour(other) => {
                        self.marked.push(other);
                        CROSSES.with([t, edge, ("other", self.edge(other)), q, after])
                    }
                    Cause::Face(face) => {
                        self.face = Some(face);
                        PIERCES.with([t, edge, ("other", letter(face).into()), q, after])
                    }
                }
            }
            Step::Corner { edge, corner, faces, invisibility: [q, after] } => {
                self.know(*corner, (*after).into());
                let [edge, corner] = [("edge", self.edge(*edge)), ("corner", (corner + 1).into())];
                let [q, after] = [("q", (*q).into()), ("after", (*after).into())];
                if faces.is_empty() {
                    return CORNER.with([edge, corner, after]);
                }
                CORNER_BEHIND.with([edge, q, ("faces", named(faces)), corner, after])
            }
        }
    }

    fn nature(&mut self, step: &natures::Step) -> Caption {
        use natures::Step;
        (self.marked, self.face, self.corner) = (Vec::new(), None, None);
        match step {
            Step::Hiders { faces } => HIDERS.with([("faces", named(faces))]),
            Step::Compared { corner, nature } => {
                self.know(*corner, set(nature));
                COMPARED.with([("corner", (corner + 1).into()), ("nature", set(nature))])
            }
            Step::Edge { edge, corners, own, nature } => {
                self.begin(*corners, set(nature), nature.is_empty());
                let [edge, corner] =
                    [("edge", self.edge(*edge)), ("corner", (corners[0] + 1).into())];
                let nature = ("nature", set(nature));
                if own.is_empty() {
                    return BEGINS.with([edge, corner, nature]);
                }
                BEGINS_BEHIND.with([edge, corner, ("own", named(own)), nature])
            }
            Step::Change { edge, t, face, crossed, nature } => {
                self.change(*t, set(nature), nature.is_empty());
                self.face = Some(*face);
                let is_entering = nature.contains(face);
                let values = [("t", (*t).into()), ("face", letter(*face).into())];
                let ([t, face], edge) = (values, ("edge", self.edge(*edge)));
                let nature = ("nature", set(nature));
                match (*crossed, is_entering) {
                    (Some(other), true) => {
                        ENTERS.with([t, edge, face, ("other", self.edge(other)), nature])
                    }
                    (Some(other), false) => {
                        LEAVES.with([t, edge, face, ("other", self.edge(other)), nature])
                    }
                    (None, true) => ENTERS_PIERCED.with([t, edge, face, nature]),
                    (None, false) => LEAVES_PIERCED.with([t, edge, face, nature]),
                }
            }
            Step::Corner { edge, corner, own, nature } => {
                self.know(*corner, set(nature));
                let [edge, corner] = [("edge", self.edge(*edge)), ("corner", (corner + 1).into())];
                let nature = ("nature", set(nature));
                if own.is_empty() {
                    return ENDS.with([edge, corner, nature]);
                }
                ENDS_BEHIND.with([edge, ("own", named(own)), corner, nature])
            }
        }
    }

    fn know(&mut self, corner: usize, state: Value) {
        self.known.insert(corner, state);
        self.corner = Some(corner);
        self.is_open = false;
    }

    fn begin(&mut self, corners: [usize; 2], state: Value, is_seen: bool) {
        self.lines.push((corners, vec![(0.0, state, is_seen)]));
        self.corner = Some(corners[0]);
        self.is_open = true;
    }

    fn change(&mut self, t: f64, state: Value, is_seen: bool) {
        let Some((_, parts)) = self.lines.last_mut() else { return };
        parts.push((t, state, is_seen));
    }

    /// Returns the name of an edge: the numbers of its corners.
    fn edge(&self, edge: usize) -> Value {
        let corners = self.net.edges().get(edge).map(|edge| edge.corners);
        corners.map(|[a, b]| format!("{}–{}", a + 1, b + 1)).unwrap_or_default().into()
    }

    /// Returns the parts of the last edge, then the corners that are known.
    fn table(&self) -> Table {
        let mut table = Table::new([Word::new("corner, t", "Ecke, t"), self.head]);
        if let Some((_, parts)) = self.lines.last().filter(|_| self.is_open) {
            for (from, state, _) in parts {
                table.row(Value::List(vec!["t ≥".into(), (*from).into()]), [state.clone()]);
            }
        }
        for (corner, state) in &self.known {
            table.row(corner + 1, [state.clone()]);
        }
        table
    }

    fn picture(&self) -> Picture {
        let place = |corner: usize| self.net.corners()[corner].truncate();
        let all = self.net.corners();
        let mut picture = Picture::around(all.iter().map(|corner| corner.truncate()), 0.1);
        for edge in self.net.edges().iter().filter(|edge| !edge.flat) {
            picture.chain(edge.corners.map(place), Look::Pale);
        }
        if let Some(face) = self.face.and_then(|face| self.net.faces().get(face)) {
            picture.ring(face.ring.iter().map(|c| place(*c)).collect::<Vec<_>>(), Look::First);
        }
        let last = self.lines.len().saturating_sub(usize::from(self.is_open));
        for (number, (corners, parts)) in self.lines.iter().enumerate() {
            let [p, q] = corners.map(place);
            if number == last {
                picture.chain([p, q], Look::Now);
            }
            for (k, (from, _, is_seen)) in parts.iter().enumerate() {
                let to = parts.get(k + 1).map_or(1.0, |next| next.0);
                let look = match (number == last, *is_seen) {
                    (true, true) => Look::Result,
                    (true, false) => Look::Second,
                    (false, true) => Look::Window,
                    (false, false) => Look::Dashed,
                };
                // Beyond the last change nothing is known yet.
                let is_known = number < last || k + 1 < parts.len();
                if is_known {
                    picture.chain([p.lerp(q, *from), p.lerp(q, to)], look);
                } else {
                    picture.dot(p.lerp(q, *from), look);
                }
            }
        }
        for &edge in &self.marked {
            let ends = self.net.edges().get(edge).map(|edge| edge.corners.map(place));
            ends.into_iter().for_each(|ends| picture.chain(ends, Look::First));
        }
        let middle = all.iter().sum::<DVec3>().truncate() / all.len().max(1) as f64;
        for corner in 0..all.len() {
            let at = place(corner);
            let away = (at - middle).normalize_or(DVec2::X) * 9.0;
            picture.label(at, (away.x, -away.y), corner + 1);
        }
        for (number, face) in self.net.faces().iter().enumerate() {
            let corners = face.ring.iter().map(|corner| place(*corner));
            let middle = corners.sum::<DVec2>() / face.ring.len().max(1) as f64;
            if self.net.is_hider(number) {
                picture.label(middle, (0.0, 0.0), letter(number));
            }
        }
        self.corner.into_iter().for_each(|corner| picture.dot(place(corner), Look::Now));
        picture
    }
}

/// Returns the letters of faces.
fn named(faces: &[usize]) -> Value {
    if faces.is_empty() {
        return Word::new("no face", "keine Fläche").into();
    }
    faces.iter().map(|face| letter(*face)).collect::<Vec<_>>().into()
}

/// Returns a nature as a set.
fn set(nature: &[usize]) -> Value {
    if nature.is_empty() {
        return "∅".into();
    }
    nature.iter().map(|face| letter(*face)).collect::<Vec<_>>().join(", ").into()
}
