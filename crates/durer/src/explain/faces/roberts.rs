//! The lesson of Roberts' hidden lines of convex bodies.

use super::bodies::{BESIDE, BOX, BOXES, PIERCED, THREE, check_count, upright};
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
use crate::visibility::line::roberts::{
    Bound, ConvexBody, INFO, Options, Step, Values, VisibleLine, draw,
};
use crate::work::Work;

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        BOXES,
        PIERCED,
        Example {
            name: "hidden",
            title: Word::new(
                "a box that another one hides wholly",
                "ein Quader, den ein anderer ganz verdeckt",
            ),
            input: || {
                let mut faces = upright([2.0, 1.0, 0.0], [4.0, 2.0, 1.0]);
                faces.extend(upright([0.0, 0.0, 3.0], [6.0, 3.0, 4.0]));
                Input::Faces(faces)
            },
        },
        BESIDE,
        THREE,
        BOX,
    ],
    templates: &[
        &BODY,
        &SELF_HIDDEN,
        &EDGE,
        &JUNCTION,
        &APART,
        &COMPARE,
        &BOUND,
        &EXCLUDED,
        &HIDDEN,
        &VISIBLE,
        &INVISIBLE,
    ],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

const TAKES: Word = Word::new(
    "faces of closed convex bodies, seen from +z",
    "Flächen geschlossener konvexer Körper, von +z gesehen",
);

static BODY: Template = Template::new(
    "body",
    "Body {body}: E · V = {values}. Negative values belong to faces that the eye sees: {seen} of them.",
    "Körper {body}: E · V = {values}. Negative Werte gehören zu Flächen, die das Auge sieht: {seen} an der Zahl.",
);
static SELF_HIDDEN: Template = Template::new(
    "self-hidden",
    "The edge from {p} to {q} lies between two faces of {body} that look away: its own body hides it.",
    "Die Kante von {p} nach {q} liegt zwischen zwei abgewandten Flächen von {body}: Ihr eigener Körper verdeckt sie.",
);
static EDGE: Template = Template::new(
    "line",
    "The edge of {body} from P = {p} to Q = {q} is compared with the other bodies.",
    "Die Kante von {body} von P = {p} nach Q = {q} wird mit den anderen Körpern verglichen.",
);
static JUNCTION: Template = Template::new(
    "line",
    "{body} and {other} pierce each other from P = {p} to Q = {q}; this line is compared with other bodies.",
    "{body} und {other} durchdringen sich von P = {p} bis Q = {q}; diese Linie wird mit anderen Körpern verglichen.",
);
static APART: Template = Template::new(
    "apart",
    "Plane {plane} of {body}: p = {p}, p + q = {q}, w = {w}, none positive. The line is on the eye's side: not hidden.",
    "Ebene {plane} von {body}: p = {p}, p + q = {q}, w = {w}, nichts positiv. Die Linie liegt auf der Seite des Auges: nicht verdeckt.",
);
static COMPARE: Template = Template::new(
    "compare",
    "No plane of {body} settles it: p + t q + α w > 0 is solved for all {count} planes.",
    "Keine Ebene von {body} entscheidet allein: p + t q + α w > 0 wird für alle {count} Ebenen gelöst.",
);
static BOUND: Template = Template::new(
    "bound",
    "{near} and plane {far} of {body}: both are 0 at t = {t}. The hidden part is within {from} … {to}.",
    "{near} und Ebene {far} von {body}: Beide sind 0 bei t = {t}. Der verdeckte Teil liegt in {from} … {to}.",
);
static EXCLUDED: Template = Template::new(
    "bound",
    "{near} and plane {far} of {body} exclude each other along what is left: nothing is hidden.",
    "{near} und Ebene {far} von {body} schließen sich auf dem ganzen Rest aus: Nichts ist verdeckt.",
);
static HIDDEN: Template = Template::new(
    "hidden",
    "{body} hides the line from t = {from} to t = {to}.",
    "{body} verdeckt die Linie von t = {from} bis t = {to}.",
);
static VISIBLE: Template = Template::new(
    "visible",
    "All bodies are compared: drawn from t = {parts}.",
    "Alle Körper sind verglichen: gezeichnet von t = {parts}.",
);
static INVISIBLE: Template = Template::new(
    "visible",
    "Nothing of the line is left: it is not drawn.",
    "Von der Linie bleibt nichts: Sie wird nicht gezeichnet.",
);

/// Bodies, and their lines as far as they are decided.
#[derive(Clone)]
struct State {
    bodies: Vec<ConvexBody>,
    lines: Vec<VisibleLine>,
    /// The body that the last line is compared with, and the values of its planes.
    now: Option<(usize, Vec<Values>)>,
    /// Values of the planes of a body at the eye.
    eye: Vec<f64>,
    bound: Option<Bound>,
    done: usize,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(TAKES)?;
    check_count(faces)?;
    let bodies = ConvexBody::several(faces)?;
    let steps = record(cap, |t| {
        draw(&bodies, Eye::Along(DVec3::NEG_Z), &Options::default(), &Work::default(), t)
    })?;
    let (lines, eye) = (Vec::new(), Vec::new());
    let mut state = State { bodies, lines, now: None, eye, bound: None, done: 0 };
    Ok(Frames::new(steps, move |step, want| {
        let caption = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(step))
    }))
}

impl State {
    fn take(&mut self, step: &Step) -> Caption {
        self.bound = None;
        match step {
            Step::Body { body, eye } => {
                self.eye.clone_from(eye);
                let seen = eye.iter().filter(|w| **w < 0.0).count();
                let values = ("values", eye.clone().into());
                BODY.with([("body", named(*body)), values, ("seen", seen.into())])
            }
            Step::SelfHidden { body, ends } => {
                let [p, q] = ends.map(Value::from);
                SELF_HIDDEN.with([("body", named(*body)), ("p", p), ("q", q)])
            }
            Step::Line { bodies, ends, .. } => {
                self.eye.clear();
                self.lines.push(VisibleLine {
                    bodies: *bodies,
                    ends: *ends,
                    visible: vec![[0.0, 1.0]],
                });
                let [p, q] = ends.map(Value::from);
                let [body, other] = bodies.map(named);
                let [body, p, q] = [("body", body), ("p", p), ("q", q)];
                if bodies[0] == bodies[1] {
                    EDGE.with([body, p, q])
                } else {
                    JUNCTION.with([body, ("other", other), p, q])
                }
            }
            Step::Apart { body, plane, values, .. } => {
                self.now = Some((*body, values.clone()));
                let v = values.get(*plane).copied();
                let v = v.unwrap_or(Values { start: 0.0, end: 0.0, eye: 0.0 });
                let numbers = [("p", v.start.into()), ("q", v.end.into()), ("w", v.eye.into())];
                let [p, q, w] = numbers;
                APART.with([("plane", (plane + 1).into()), ("body", named(*body)), p, q, w])
            }
            Step::Compare { body, values, .. } => {
                self.now = Some((*body, values.clone()));
                COMPARE.with([("body", named(*body)), ("count", values.len().into())])
            }
            Step::Bound { body, bound, .. } => self.bound(*body, *bound),
            Step::Hidden { body, part, .. } => {
                if let Some(line) = self.lines.last_mut() {
                    line.hide(*part);
                }
                let [from, to] = part.map(Value::from);
                HIDDEN.with([("body", named(*body)), ("from", from), ("to", to)])
            }
            Step::Visible { parts, .. } => {
                self.now = None;
                self.done = self.lines.len();
                let part = |[from, to]: &[f64; 2]| {
                    let to_word = Word::new("to", "bis");
                    Value::List(vec![(*from).into(), to_word.into(), (*to).into()])
                };
                let mut all: Vec<Value> = Vec::new();
                for one in parts {
                    if !all.is_empty() {
                        all.push(Word::new("and", "und").into());
                    }
                    all.push(part(one));
                }
                if parts.is_empty() {
                    return INVISIBLE.with([]);
                }
                VISIBLE.with([("parts", Value::List(all))])
            }
        }
    }

    fn bound(&mut self, body: usize, bound: Bound) -> Caption {
        self.bound = Some(bound);
        let number = |plane: Option<usize>| Value::from(plane.map_or(0, |plane| plane + 1));
        let near = match bound.planes[0] {
            None => Value::from("α = 0"),
            near => Value::List(vec![Word::new("Plane", "Ebene").into(), number(near)]),
        };
        let [near, far] = [("near", near), ("far", number(bound.planes[1]))];
        let body = ("body", named(body));
        let Some(t) = bound.t else { return EXCLUDED.with([near, far, body]) };
        let [from, to] = bound.part.map(Value::from);
        BOUND.with([near, far, body, ("t", t.into()), ("from", from), ("to", to)])
    }

    /// Returns the values of the planes of the body in question.
    fn table(&self) -> Table {
        let heads = [
            Word::new("plane", "Ebene"),
            Word::new("p", "p"),
            Word::new("p + q", "p + q"),
            Word::new("w", "w"),
        ];
        let mut table = Table::new(heads);
        if let Some((_, values)) = &self.now {
            for (plane, v) in values.iter().enumerate() {
                table.row(plane + 1, [v.start.into(), v.end.into(), v.eye.into()]);
            }
        } else {
            for (plane, w) in self.eye.iter().enumerate() {
                table.row(plane + 1, ["".into(), "".into(), (*w).into()]);
            }
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let corners = self.bodies.iter().flat_map(ConvexBody::corners);
        let mut picture = Picture::around(corners.map(|corner| corner.truncate()), 0.1);
        let now = match step {
            Step::Body { body, .. } | Step::SelfHidden { body, .. } => Some(*body),
            _ => self.now.as_ref().map(|(body, _)| *body),
        };
        for (number, body) in self.bodies.iter().enumerate() {
            let look = if now == Some(number) { Look::First } else { Look::Pale };
            for edge in body.edges() {
                picture.chain(flat(body.ends(edge)), look);
            }
            let all = body.corners();
            let middle = all.iter().sum::<DVec3>() / all.len().max(1) as f64;
            picture.label(middle.truncate(), (0.0, 0.0), named(number));
        }
        for line in self.lines.iter().take(self.done) {
            line.parts().for_each(|part| picture.chain(flat(part), Look::Window));
        }
        if let Step::SelfHidden { ends, .. } = step {
            picture.chain(flat(*ends), Look::Now);
        }
        if let Some(line) = self.lines.get(self.done) {
            let [p, q] = flat(line.ends);
            picture.chain([p, q], Look::Now);
            if self.now.is_none() || !matches!(step, Step::Line { .. }) {
                line.parts().for_each(|part| picture.chain(flat(part), Look::Result));
            }
            if let Some(Bound { part: [from, to], t, .. }) = self.bound {
                picture.chain([p.lerp(q, from), p.lerp(q, to)], Look::Second);
                t.into_iter().for_each(|t| picture.dot(p.lerp(q, t), Look::Now));
            }
            let along = (q - p).normalize_or(DVec2::X) * 11.0;
            picture.label(p, (-along.x, along.y), "P");
            picture.label(q, (along.x, -along.y), "Q");
        }
        picture
    }
}

fn flat(ends: [DVec3; 2]) -> [DVec2; 2] {
    ends.map(|end| end.truncate())
}

fn named(body: usize) -> Value {
    letter(body).into()
}
