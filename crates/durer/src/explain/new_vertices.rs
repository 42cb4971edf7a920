//! The lesson of what new vertices get: values mixed in clip space, and the error of mixing them on the screen.

use super::frame::{Frames, Shown, Want, record};
use super::grid::letter;
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::wedges::{
    ACCEPTED, BORDER, CLIP_SPACE, DROPPED, REJECTED, begun, clip_space, number, seen, wedge,
};
use super::words::{Caption, Template, Value, Word};
use crate::clip::volume::{self, ATTRIBUTES, ClipVertex, Step};
use crate::math::{DVec2, DVec3, DVec4, Rect};
use crate::raster::interpolate::perspective_correct;
use crate::trace::{PseudocodeLine, Recorder, Tracer};
use crate::{Error, Result};

pub(super) const LESSON: Lesson = Lesson {
    name: ATTRIBUTES.name,
    info: &ATTRIBUTES,
    takes: CLIP_SPACE,
    examples: &[
        Example::new(
            "one-to-three",
            "w = 1 and w = 3: t = ¼ in space, s = ½ on the screen",
            "w = 1 und w = 3: t = ¼ im Raum, s = ½ am Schirm",
            || clip_space(&[(0.0, 0.0, 0.0, 1.0), (6.0, 0.0, 0.0, 3.0), (-0.5, 0.75, 0.0, 1.0)]),
        ),
        Example::new(
            "same-w",
            "the same w everywhere: both ways agree",
            "überall dasselbe w: beide Wege stimmen überein",
            || clip_space(&[(-1.0, -1.0, 0.0, 2.0), (4.0, 0.0, 0.0, 2.0), (-1.0, 1.5, 0.0, 2.0)]),
        ),
        Example::new(
            "behind-the-eye",
            "a corner behind the eye has no place on the screen",
            "eine Ecke hinter dem Auge hat keinen Ort am Schirm",
            || clip_space(&[(0.0, 0.0, 0.0, 1.0), (0.5, 0.0, 0.0, 1.0), (0.0, 3.0, -3.0, -2.0)]),
        ),
        Example::new(
            "two-borders",
            "a corner beyond two borders: mixtures are mixed again",
            "eine Ecke jenseits zweier Ränder: Mischungen werden nochmals gemischt",
            || clip_space(&[(0.0, 0.0, 0.0, 1.0), (4.0, 3.0, 0.0, 2.0), (-0.5, 0.75, 0.0, 1.0)]),
        ),
        Example::new(
            "on-the-border",
            "a corner on the border is kept and not cut",
            "eine Ecke auf dem Rand bleibt und wird nicht geschnitten",
            || clip_space(&[(1.0, -0.5, 0.0, 1.0), (3.0, 0.5, 0.0, 2.0), (-0.5, 0.5, 0.0, 1.0)]),
        ),
        Example::new(
            "through-the-eye",
            "an edge through the eye: its point has w = 0",
            "eine Kante durch das Auge: Ihr Punkt hat w = 0",
            || clip_space(&[(1.0, 1.0, 1.0, 1.0), (-1.0, -1.0, -1.0, -1.0), (1.0, -1.0, 0.5, 1.0)]),
        ),
        Example::new("inside", "inside: all values stay", "innen: alle Werte bleiben", || {
            clip_space(&[(0.0, 0.0, 0.0, 1.0), (0.5, 0.0, 0.0, 1.0), (0.0, 0.5, 0.5, 2.0)])
        }),
        Example::new("beyond", "all beyond one border", "alles jenseits eines Rands", || {
            clip_space(&[(2.0, 0.0, 0.0, 1.0), (3.0, 0.0, 0.0, 1.0), (4.0, 1.0, 0.0, 2.0)])
        }),
    ],
    templates: &[
        &CODE, &BORDER, &KEEP, &CUT, &DIVIDED, &EQUAL, &BEHIND, &ACCEPTED, &REJECTED, &DROPPED,
    ],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static CODE: Template = Template::new(
    "code",
    "Vertex {name} = {p}, w = {w}, outcode {code}. Its values: colour {color}, texture coordinate {uv}, normal {normal}.",
    "Ecke {name} = {p}, w = {w}, Outcode {code}. Ihre Werte: Farbe {color}, Texturkoordinate {uv}, Normale {normal}.",
);
static KEEP: Template = Template::new(
    "keep",
    "Vertex {name} is inside and keeps its values.",
    "Ecke {name} liegt innen und behält ihre Werte.",
);
static CUT: Template = Template::new(
    "cut",
    "From {inside} inside to {outside} outside: t = {d_in} / ({d_in} + {less}) = {t}. {name} gets {k} = {from} + t · ({to} − {from}) = {value}, and by the same t the colour {color} and the normal {normal}, which is {length} long.",
    "Von {inside} innen nach {outside} außen: t = {d_in} / ({d_in} + {less}) = {t}. {name} bekommt {k} = {from} + t · ({to} − {from}) = {value} und mit demselben t die Farbe {color} und die Normale {normal}, die {length} lang ist.",
);
static DIVIDED: Template = Template::new(
    "divided",
    "On the screen, with 1/w = {inv_in} at {inside} and {inv_out} at {outside}, {name} is s = {s} of the way, not t = {t}. Mixed by s, {k} would be {wrong}: wrong by {error}.",
    "Am Schirm, mit 1/w = {inv_in} bei {inside} und {inv_out} bei {outside}, liegt {name} bei s = {s} des Wegs, nicht bei t = {t}. Mit s gemischt wäre {k} = {wrong}: falsch um {error}.",
);
static EQUAL: Template = Template::new(
    "divided",
    "On the screen, with 1/w = {inv} at both {inside} and {outside}, {name} is s = t = {t} of the way: only here mixing after the division is right.",
    "Am Schirm, mit 1/w = {inv} bei {inside} und bei {outside}, liegt {name} bei s = t = {t} des Wegs: Nur hier ist das Mischen nach der Division richtig.",
);
static BEHIND: Template = Template::new(
    "divided",
    "{end} has w = {w} ≤ 0: no place on the screen, so after the division there would be no s to mix by. In clip space t needs no division by w.",
    "{end} hat w = {w} ≤ 0: keinen Ort am Schirm, also gäbe es nach der Division kein s zum Mischen. Im Clip-Raum braucht t keine Division durch w.",
);

/// Values of a vertex: linear colour, texture coordinate, normal.
type Values = (DVec3, (DVec2, DVec3));

/// Values of the corners of the input, in turns.
const VALUES: [Values; 4] = [
    (DVec3::X, (DVec2::ZERO, DVec3::new(-0.6, 0.0, 0.8))),
    (DVec3::Y, (DVec2::X, DVec3::new(0.6, 0.0, 0.8))),
    (DVec3::Z, (DVec2::Y, DVec3::new(0.0, 0.6, 0.8))),
    (DVec3::new(1.0, 1.0, 0.0), (DVec2::ONE, DVec3::new(0.0, -0.6, 0.8))),
];

/// Something that is shown: a step, or what the last new vertex would get on the screen.
#[derive(Debug, Clone, Copy)]
enum Moment {
    Clip(Step<Values>),
    Divided,
}

/// A vertex with its name.
#[derive(Clone)]
struct Named {
    name: String,
    vertex: ClipVertex<Values>,
}

/// A new vertex between two others.
#[derive(Clone)]
struct New {
    ends: [Named; 2],
    t: f64,
    vertex: Named,
}

#[derive(Clone)]
struct State {
    start: Vec<DVec4>,
    /// Ring that goes into the border.
    ring: Vec<Named>,
    /// Vertices that have come out.
    out: Vec<Named>,
    /// Index of the border whose turn it is.
    border: Option<usize>,
    gone: bool,
    count: usize,
    new: Option<New>,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let points = input.clip_space(CLIP_SPACE)?;
    let valued = points.iter().zip(VALUES.iter().cycle());
    let ring: Vec<_> =
        valued.map(|(&position, &attributes)| ClipVertex { position, attributes }).collect();
    let options = volume::Options::default();
    let mut clip = Recorder::with_cap(cap);
    match *ring {
        [] | [_] => return Err(Error::parameter("input", "too few points", CLIP_SPACE.en)),
        [a, b] => drop(volume::clip_segment([a, b], &options, &mut clip)),
        _ => drop(volume::clip_polygon(&ring, &options, &mut clip)),
    }
    let steps = record(cap, |t| {
        for step in clip.into_steps() {
            t.step(|| Moment::Clip(step));
            if matches!(step, Step::Cut { .. }) {
                t.step(|| Moment::Divided);
            }
        }
        Ok(())
    })?;
    let named = |(i, vertex)| Named { name: letter(i), vertex };
    let mut state = State {
        start: points.to_vec(),
        ring: ring.into_iter().enumerate().map(named).collect(),
        out: Vec::new(),
        border: None,
        gone: false,
        count: 0,
        new: None,
    };
    Ok(Frames::new(steps, move |moment, want| state.show(moment, want)))
}

impl State {
    fn show(&mut self, moment: &Moment, want: Want) -> Shown {
        match moment {
            Moment::Clip(step) => {
                let caption = self.take(step);
                want.shown(step.line(), caption, || self.table(), || self.in_clip_space(step))
            }
            Moment::Divided => {
                let caption = self.new.as_ref().map_or(ACCEPTED.with([]), New::divided);
                want.shown(10, caption, || self.table(), || self.on_screen())
            }
        }
    }

    fn name(&self, vertex: usize) -> Value {
        self.ring.get(vertex).map_or(vertex.into(), |named| named.name.clone().into())
    }

    fn take(&mut self, step: &Step<Values>) -> Caption {
        match *step {
            Step::Code { vertex, code, .. } => {
                let name = ("name", self.name(vertex));
                let Some(named) = self.ring.get(vertex) else { return CODE.with([name]) };
                let (position, (color, (uv, normal))) = named.vertex.parts();
                CODE.with([
                    name,
                    ("p", position.truncate().into()),
                    ("w", position.w.into()),
                    ("code", code.into()),
                    ("color", color.into()),
                    ("uv", uv.into()),
                    ("normal", normal.into()),
                ])
            }
            Step::Border(border) => {
                if self.border.is_some() {
                    self.ring = std::mem::take(&mut self.out);
                }
                self.border = Some(number(border));
                begun(border, self.ring.len())
            }
            Step::Keep { vertex } => {
                self.out.extend(self.ring.get(vertex).cloned());
                KEEP.with([("name", self.name(vertex))])
            }
            Step::Cut { inside, outside, distances, position, attributes } => {
                self.count += 1;
                let name = format!("S{}", self.count);
                let vertex = Named { name, vertex: ClipVertex { position, attributes } };
                self.out.push(vertex.clone());
                let [Some(a), Some(b)] = [inside, outside].map(|i| self.ring.get(i).cloned())
                else {
                    return CUT.with([]);
                };
                let t = distances[0] / (distances[0] - distances[1]);
                let new = New { ends: [a, b], t, vertex };
                let caption = new.cut(distances);
                self.new = Some(new);
                caption
            }
            Step::Accepted => ACCEPTED.with([]),
            Step::Rejected => {
                self.gone = true;
                REJECTED.with([])
            }
            Step::Dropped => {
                self.out.retain(|named| named.vertex.position.w > 0.0);
                DROPPED.with([])
            }
        }
    }

    fn table(&self) -> Table {
        let mut table = Table::new([
            Word::new("vertex", "Ecke"),
            Word::new("w", "w"),
            Word::new("colour", "Farbe"),
            Word::new("u, v", "u; v"),
            Word::new("normal", "Normale"),
        ]);
        let mut add = |name: Value, vertex: &ClipVertex<Values>| {
            let (position, (color, (uv, normal))) = vertex.parts();
            table.row(name, [position.w.into(), color.into(), uv.into(), normal.into()]);
        };
        for named in &self.ring {
            add(named.name.clone().into(), &named.vertex);
        }
        for named in &self.out {
            let out = Word::new("out", "aus");
            add(Value::List(vec![out.into(), named.name.clone().into()]), &named.vertex);
        }
        table
    }

    /// Draws the wedge of the border's coordinate, as the lesson of the volume does.
    fn in_clip_space(&self, step: &Step<Values>) -> Picture {
        let axis = self.border.map_or(0, |border| border / 2);
        let ring: Vec<_> = self
            .ring
            .iter()
            .map(|named| (named.name.clone().into(), named.vertex.position))
            .collect();
        let out: Vec<_> = self.out.iter().map(|named| named.vertex.position).collect();
        let rings = if self.gone { None } else { Some((&*ring, &*out)) };
        let mut picture = wedge(axis, &self.start, rings);
        let now = match *step {
            Step::Code { vertex, .. } | Step::Keep { vertex } => ring.get(vertex).map(|(_, p)| *p),
            Step::Cut { position, .. } => Some(position),
            Step::Border(_) | Step::Accepted | Step::Rejected | Step::Dropped => None,
        };
        now.iter().for_each(|&p| picture.dot(seen(p, axis), Look::Now));
        picture
    }

    /// Draws the ring after the division, with the new vertex, and where t would put it.
    fn on_screen(&self) -> Picture {
        let seen = |named: &Named| divided(named.vertex.position);
        let window = Rect::new(DVec2::NEG_ONE, DVec2::ONE);
        let corners = window.iter().flat_map(|window| [window.min(), window.max()]);
        let shown = self.ring.iter().filter_map(seen);
        let mut picture = Picture::around(corners.chain(shown), 0.12);
        picture.picture_from_input = None;
        window.iter().for_each(|window| picture.frame(window, Look::Window));
        for (i, named) in self.ring.iter().enumerate() {
            let next = &self.ring[(i + 1) % self.ring.len()];
            if let (Some(a), Some(b)) = (seen(named), seen(next)) {
                picture.chain([a, b], Look::First);
            }
        }
        for named in &self.ring {
            seen(named).iter().for_each(|&p| picture.named(p, named.name.clone(), Look::First));
        }
        let Some(new) = &self.new else { return picture };
        if let [Some(a), Some(b)] = [&new.ends[0], &new.ends[1]].map(seen) {
            let by_t = a + (b - a) * new.t;
            picture.dot(by_t, Look::Second);
            picture.label(by_t, (0.0, 14.0), "t");
        }
        if let Some(at) = seen(&new.vertex) {
            picture.named(at, new.vertex.name.clone(), Look::Now);
        }
        picture
    }
}

impl New {
    /// Returns the name of the texture coordinate in which the ends differ more, and its values at the ends and here.
    fn coordinate(&self) -> (&'static str, [f64; 3]) {
        let [a, b] = &self.ends;
        let uvs = [a, b, &self.vertex].map(|named| named.vertex.attributes.1.0);
        let difference = (uvs[1] - uvs[0]).abs();
        if difference.y > difference.x {
            ("v", uvs.map(|uv| uv.y))
        } else {
            ("u", uvs.map(|uv| uv.x))
        }
    }

    fn cut(&self, [d_in, d_out]: [f64; 2]) -> Caption {
        let (k, [from, to, value]) = self.coordinate();
        let (color, (_, normal)) = self.vertex.vertex.attributes;
        CUT.with([
            ("inside", self.ends[0].name.clone().into()),
            ("outside", self.ends[1].name.clone().into()),
            ("name", self.vertex.name.clone().into()),
            ("d_in", d_in.into()),
            ("less", (-d_out).into()),
            ("t", self.t.into()),
            ("k", k.into()),
            ("from", from.into()),
            ("to", to.into()),
            ("value", value.into()),
            ("color", color.into()),
            ("normal", normal.into()),
            ("length", normal.length().into()),
        ])
    }

    /// Returns what mixing after the division would give.
    fn divided(&self) -> Caption {
        let [w_in, w_out] = [&self.ends[0], &self.ends[1]].map(|end| end.vertex.position.w);
        let name = ("name", self.vertex.name.clone().into());
        let inside = ("inside", self.ends[0].name.clone().into());
        let outside = ("outside", self.ends[1].name.clone().into());
        let hidden = self.ends.iter().rfind(|end| end.vertex.position.w <= 0.0);
        if let Some(Named { name, vertex }) = hidden {
            return BEHIND.with([("end", name.clone().into()), ("w", vertex.position.w.into())]);
        }
        let t = ("t", self.t.into());
        if w_in == w_out {
            return EQUAL.with([name, inside, outside, ("inv", w_in.recip().into()), t]);
        }
        // From space to the screen the roles of w and 1/w are exchanged.
        let [_, s, _] = perspective_correct([1.0 - self.t, self.t, 0.0], [w_in, w_out, 1.0]);
        let (k, [from, to, value]) = self.coordinate();
        let wrong = from + (to - from) * s;
        DIVIDED.with([
            name,
            inside,
            outside,
            ("inv_in", w_in.recip().into()),
            ("inv_out", w_out.recip().into()),
            ("s", s.into()),
            t,
            ("k", k.into()),
            ("wrong", wrong.into()),
            ("error", (wrong - value).abs().into()),
        ])
    }
}

/// Returns the place on the screen; `None` for a vertex that has none, or one too far away for a picture.
fn divided(p: DVec4) -> Option<DVec2> {
    let at = p.truncate().truncate() / p.w;
    (p.w > 0.0 && at.abs().max_element() < 20.0).then_some(at)
}
