//! Lessons of clipping to the view volume: in homogeneous coordinates, and at five places of the pipeline.

use super::frame::{Frames, Shown, Want, record};
use super::input::Input;
use super::lesson::{Example, Lesson};
use super::picture::{Look, Picture};
use super::table::Table;
use super::wedges::{
    ACCEPTED, BORDER, CLIP_SPACE, DROPPED, REJECTED, begun, clip_space, number, seen, wedge,
};
use super::words::{Caption, Template, Value, Word};
use crate::clip::outcode::{ClipDepths, Outcode};
use crate::clip::place::{self, ClipPlace};
use crate::clip::volume::{self, ClipVertex, Step};
use crate::math::{DMat4, DVec3, DVec4};
use crate::trace::{PseudocodeLine, Recorder};
use crate::{Error, Result};

pub(super) const LESSONS: &[Lesson] = &[
    Lesson {
        name: volume::INFO.name,
        info: &volume::INFO,
        takes: CLIP_SPACE,
        examples: RINGS,
        templates: &[&CODE, &BORDER, &KEEP, &CUT, &ACCEPTED, &REJECTED, &DROPPED],
        unreached: &[],
        make: |_, input, _, cap| volume(input, cap),
    },
    super::new_vertices::LESSON,
    place(ClipPlace::World, WITHOUT_CODES),
    place(ClipPlace::ClipSpace, WITH_CODES),
    place(ClipPlace::AfterDivision, WITHOUT_CODES),
    place(ClipPlace::Viewport, WITHOUT_CODES),
    place(ClipPlace::PerPixel, WITHOUT_CODES),
    super::section::LESSON,
];

const WITH_CODES: &[&Template] = &[&CODE, &BORDER, &KEEP, &CUT, &ACCEPTED, &REJECTED];
const WITHOUT_CODES: &[&Template] = &[&BORDER, &KEEP, &CUT];

/// Returns the lesson of a place.
const fn place(place: ClipPlace, templates: &'static [&'static Template]) -> Lesson {
    Lesson {
        name: place.name(),
        info: place.info(),
        takes: FACE,
        examples: FACES,
        templates,
        unreached: &[],
        make: |lesson, input, _, cap| at_place(lesson, input, cap),
    }
}

const FACE: Word = Word::new(
    "a face in space; the eye is in the origin and looks along −z, from 1 to 10",
    "eine Fläche im Raum; das Auge ist im Ursprung und blickt nach −z, von 1 bis 10",
);

const RINGS: &[Example] = &[
    Example {
        name: "behind-the-eye",
        title: Word::new(
            "a triangle with a corner behind the eye",
            "ein Dreieck mit einer Ecke hinter dem Auge",
        ),
        input: || clip_space(&[(0.0, 0.0, 0.0, 1.0), (0.5, 0.0, 0.0, 1.0), (0.0, 3.0, -3.0, -2.0)]),
    },
    Example {
        name: "line-pq",
        title: Word::new(
            "P = (−1, 0, 0, 1), Q = (1, 0, 0, 1) of the cube, too long",
            "P = (−1, 0, 0, 1), Q = (1, 0, 0, 1) des Würfels, zu lang",
        ),
        input: || clip_space(&[(-3.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 1.0)]),
    },
    Example {
        name: "through-the-eye",
        title: Word::new("an edge through the eye itself", "eine Kante durch das Auge selbst"),
        input: || {
            clip_space(&[(1.0, 1.0, 1.0, 1.0), (-1.0, -1.0, -1.0, -1.0), (1.0, -1.0, 0.5, 1.0)])
        },
    },
    Example {
        name: "inside",
        title: Word::new("inside: accepted at once", "innen: sofort angenommen"),
        input: || clip_space(&[(0.0, 0.0, 0.0, 1.0), (0.5, 0.0, 0.0, 1.0), (0.0, 0.5, 0.5, 2.0)]),
    },
    Example {
        name: "beyond",
        title: Word::new("all beyond one border", "alles jenseits eines Rands"),
        input: || clip_space(&[(2.0, 0.0, 0.0, 1.0), (3.0, 0.0, 0.0, 1.0), (4.0, 1.0, 0.0, 2.0)]),
    },
    Example::new(
        "two-borders",
        "a corner beyond two borders: five corners are left",
        "eine Ecke jenseits zweier Ränder: Fünf Ecken bleiben",
        || clip_space(&[(-0.5, -0.5, 0.0, 1.0), (3.0, 2.5, 0.0, 1.0), (-0.5, 0.5, 0.0, 1.0)]),
    ),
];

const FACES: &[Example] = &[
    Example {
        name: "wide",
        title: Word::new(
            "a triangle that reaches beyond three borders",
            "ein Dreieck, das über drei Ränder reicht",
        ),
        input: || face(&[(-6.0, -1.0, -4.0), (6.0, -1.0, -4.0), (0.0, 6.0, -6.0)]),
    },
    Example {
        name: "behind-the-eye",
        title: Word::new(
            "a triangle that reaches behind the eye",
            "ein Dreieck, das hinter das Auge reicht",
        ),
        input: || face(&[(-1.0, -0.5, -5.0), (1.0, -0.5, -5.0), (0.5, 0.5, 3.0)]),
    },
    Example {
        name: "beside",
        title: Word::new("a triangle beside the volume", "ein Dreieck neben dem Volumen"),
        input: || face(&[(6.0, 0.0, -3.0), (9.0, 0.0, -3.0), (7.0, 2.0, -4.0)]),
    },
    Example::new(
        "around",
        "a face around the whole view: only its borders are left",
        "eine Fläche um die ganze Sicht: Nur deren Ränder bleiben",
        || face(&[(-9.0, -8.0, -5.0), (9.0, -8.0, -5.0), (9.0, 8.0, -5.0), (-9.0, 8.0, -5.0)]),
    ),
    Example::new(
        "into-depth",
        "from before the near plane to behind the far one",
        "von vor der vorderen bis hinter die hintere Ebene",
        || face(&[(-0.2, -0.1, -0.5), (1.0, -0.5, -14.0), (0.5, 2.0, -8.0)]),
    ),
    Example::new(
        "inside",
        "wholly in the volume: every corner stays",
        "ganz im Volumen: Jede Ecke bleibt",
        || face(&[(-1.0, -1.0, -4.0), (1.5, -1.0, -6.0), (0.0, 1.5, -5.0)]),
    ),
];

fn face(points: &[(f64, f64, f64)]) -> Input {
    Input::Faces(vec![points.iter().map(|&p| p.into()).collect()])
}

static CODE: Template = Template::new(
    "code",
    "Vertex {vertex} = {p}, w = {w}: d1 … d6 are {d}, the outcode is {code}.",
    "Ecke {vertex} = {p}, w = {w}: d1 … d6 sind {d}, der Outcode ist {code}.",
);
static KEEP: Template = Template::new(
    "keep",
    "Vertex {vertex} is inside and is kept.",
    "Ecke {vertex} liegt innen und bleibt.",
);
static CUT: Template = Template::new(
    "cut",
    "From {inside} inside to {outside} outside: d is {d_in} and {d_out}, so t = {t}; the new vertex is {p}, w = {w}.",
    "Von {inside} innen nach {outside} außen: d ist {d_in} und {d_out}, also t = {t}; die neue Ecke ist {p}, w = {w}.",
);
fn volume(input: &Input, cap: usize) -> Result<Frames> {
    let points = input.clip_space(CLIP_SPACE)?;
    let vertex = |&position: &DVec4| ClipVertex { position, attributes: () };
    let options = volume::Options::default();
    let steps = match points {
        [] | [_] => return Err(Error::parameter("input", "too few points", CLIP_SPACE.en)),
        [a, b] => record(cap, |t| Ok(volume::clip_segment([vertex(a), vertex(b)], &options, t)))?,
        _ => {
            let ring: Vec<_> = points.iter().map(vertex).collect();
            record(cap, |t| Ok(volume::clip_polygon(&ring, &options, t)))?
        }
    };
    Ok(show_all(points.to_vec(), steps))
}

/// Returns a projection with the eye in the origin: x and y are 1 at the border where they are as large as −z, z from 1
/// to 10.
fn projection() -> DMat4 {
    let (near, far) = (1.0, 10.0);
    let depth = (far + near) / (near - far);
    DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, depth, -1.0),
        DVec4::new(0.0, 0.0, 2.0 * far * near / (near - far), 0.0),
    )
}

fn at_place(lesson: &Lesson, input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(FACE)?;
    let missing = || Error::parameter("input", "without a face", FACE.en);
    let corners = faces.iter().find(|face| face.len() > 2).ok_or_else(missing)?;
    let place: ClipPlace = lesson.name.parse()?;
    let (matrix, depth) = (projection(), ClipDepths::default());
    let polygon: Vec<(DVec3, ())> = corners.iter().map(|&p| (p, ())).collect();
    let steps = record(cap, |t| Ok(place::clip(place, &polygon, &matrix, depth, t)))?;
    let start: Vec<DVec4> = match place {
        ClipPlace::World => corners.iter().map(|p| p.extend(1.0)).collect(),
        _ => corners.iter().map(|&p| matrix * p.extend(1.0)).collect(),
    };
    Ok(show_all(start, steps))
}

#[derive(Clone)]
struct State {
    start: Vec<DVec4>,
    /// The ring that goes into the border.
    ring: Vec<DVec4>,
    /// Vertices that have come out.
    out: Vec<DVec4>,
    codes: Vec<Outcode>,
    /// Index of the border whose turn it is.
    border: Option<usize>,
    gone: bool,
}

fn show_all(start: Vec<DVec4>, steps: Recorder<Step>) -> Frames {
    let (ring, codes) = (start.clone(), Vec::new());
    let mut state = State { start, ring, out: Vec::new(), codes, border: None, gone: false };
    Frames::new(steps, move |step, want| state.show(step, want))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(
            step.line(),
            caption,
            || self.table(),
            || {
                let mut picture = self.picture();
                let axis = self.axis();
                match *step {
                    Step::Code { vertex, .. } | Step::Keep { vertex } => {
                        let from = if matches!(step, Step::Code { .. }) {
                            &self.start
                        } else {
                            &self.ring
                        };
                        from.get(vertex)
                            .into_iter()
                            .for_each(|&p| picture.dot(seen(p, axis), Look::Now));
                    }
                    Step::Cut { position, .. } => picture.dot(seen(position, axis), Look::Now),
                    Step::Border(_) | Step::Accepted | Step::Rejected | Step::Dropped => {}
                }
                picture
            },
        )
    }

    fn take(&mut self, step: &Step) -> Caption {
        match *step {
            Step::Code { vertex, code, distances } => {
                self.codes.push(code);
                let p = self.start.get(vertex).copied().unwrap_or_default();
                let d = Value::from(distances.to_vec());
                let values =
                    [("vertex", vertex.into()), ("p", p.truncate().into()), ("w", p.w.into())];
                let mut caption = CODE.with(values);
                caption.values.extend([("d", d), ("code", code.into())]);
                caption
            }
            Step::Border(border) => self.turn(border),
            Step::Keep { vertex } => {
                self.out.extend(self.ring.get(vertex).copied());
                KEEP.with([("vertex", vertex.into())])
            }
            Step::Cut { inside, outside, distances: [d_in, d_out], position, .. } => {
                self.out.push(position);
                let t = d_in / (d_in - d_out);
                CUT.with([
                    ("inside", inside.into()),
                    ("outside", outside.into()),
                    ("d_in", d_in.into()),
                    ("d_out", d_out.into()),
                    ("t", t.into()),
                    ("p", position.truncate().into()),
                    ("w", position.w.into()),
                ])
            }
            Step::Accepted => ACCEPTED.with([]),
            Step::Rejected => {
                self.gone = true;
                REJECTED.with([])
            }
            Step::Dropped => {
                self.out.retain(|p| p.w > 0.0);
                DROPPED.with([])
            }
        }
    }

    /// Begins a border: what came out of the one before goes in.
    fn turn(&mut self, border: Outcode) -> Caption {
        if self.border.is_some() {
            self.ring = std::mem::take(&mut self.out);
        }
        self.border = Some(number(border));
        begun(border, self.ring.len())
    }

    /// Returns the axis that the border is about: 0 for x, 1 for y, 2 for z.
    fn axis(&self) -> usize {
        self.border.map_or(0, |border| if border == 6 { 0 } else { border / 2 })
    }

    fn table(&self) -> Table {
        let word = |text| Word::new(text, text);
        let mut table = Table::new([
            Word::new("vertex", "Ecke"),
            word("x"),
            word("y"),
            word("z"),
            word("w"),
            Word::new("outcode", "Outcode"),
        ]);
        for (i, p) in self.ring.iter().enumerate() {
            let code = self.codes.get(i).filter(|_| self.border.is_none());
            let code = code.map_or(Value::from("–"), |&code| code.into());
            table.row(i, p.to_array().map(Value::from).into_iter().chain([code]));
        }
        for (i, p) in self.out.iter().enumerate() {
            let name = Value::List(vec![Word::new("out", "aus").into(), i.into()]);
            table.row(name, p.to_array().map(Value::from));
        }
        table
    }

    /// Draws the wedge −w ≤ c ≤ w of one coordinate c across w upwards, as Blinn and Newell do.
    fn picture(&self) -> Picture {
        let names = (0..self.ring.len()).map(Value::from);
        let ring: Vec<_> = names.zip(self.ring.iter().copied()).collect();
        let rings = if self.gone { None } else { Some((&*ring, &*self.out)) };
        wedge(self.axis(), &self.start, rings)
    }
}
