//! The lesson of the orientation of faces.

use super::{TAKES, name};
use crate::Result;
use crate::explain::frame::{Frames, record};
use crate::explain::input::Input;
use crate::explain::lesson::{Example, Lesson};
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::{DVec2, DVec3};
use crate::trace::PseudocodeLine;
use crate::visibility::object::orientation::{INFO, Options, Step, orient};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: &[
        Example {
            name: "inside-out",
            title: Word::new(
                "a pyramid turned inwards, with one face that is right",
                "eine nach innen gewendete Pyramide mit einer Fläche, die stimmt",
            ),
            input: || Input::Faces(pyramid(&[0, 1, 2, 4])),
        },
        Example {
            name: "flipped",
            title: Word::new("one flipped face", "eine gewendete Fläche"),
            input: || Input::Faces(pyramid(&[2])),
        },
        Example {
            name: "strip",
            title: Word::new(
                "a strip with a half twist has no outside",
                "ein Band mit halber Drehung hat kein Außen",
            ),
            input: || Input::Faces(strip()),
        },
        Example::new(
            "right",
            "all faces right: none is turned",
            "alle Flächen richtig: Keine wird gewendet",
            || Input::Faces(pyramid(&[])),
        ),
        Example::new(
            "open",
            "without its base: an open piece with two flipped faces",
            "ohne Grundfläche: ein offenes Stück mit zwei gewendeten Flächen",
            || Input::Faces(pyramid(&[1, 3])[..4].to_vec()),
        ),
        Example::new(
            "two",
            "two pieces, one of them inside out",
            "zwei Stücke, eines von innen nach außen",
            || {
                let aside = |face: &Vec<DVec3>| face.iter().map(|p| *p + DVec3::X * 6.0).collect();
                let second = pyramid(&[0, 1, 2, 3, 4]).iter().map(aside).collect();
                Input::Faces([pyramid(&[]), second].concat())
            },
        ),
    ],
    templates: &[&BEGIN, &AGREES, &TURNED, &TORN, &RIGHT, &INSIDE_OUT, &COMPARED],
    unreached: &[("compared", "the test for convex bodies is an option of the library")],
    make: |_, input, _, cap| make(input, cap),
};

static BEGIN: Template = Template::new(
    "begin",
    "{face} begins piece {piece} and stays as it is.",
    "{face} beginnt Stück {piece} und bleibt, wie sie ist.",
);
static AGREES: Template = Template::new(
    "reached",
    "Across edge {edge} lies {face}, which runs through it against {from}: it agrees.",
    "Jenseits der Kante {edge} liegt {face}, die sie gegen {from} durchläuft: Sie passt.",
);
static TURNED: Template = Template::new(
    "reached",
    "Across edge {edge} lies {face}, which runs through it as {from} does: it is turned.",
    "Jenseits der Kante {edge} liegt {face}, die sie wie {from} durchläuft: Sie wird gewendet.",
);
static TORN: Template = Template::new(
    "torn",
    "{from} and {face} both run through edge {edge} the same way: the piece has no outside.",
    "{from} und {face} durchlaufen die Kante {edge} gleich: Das Stück hat kein Außen.",
);
static RIGHT: Template = Template::new(
    "volume",
    "The volume of piece {piece} is {volume} > 0: its faces look outwards.",
    "Das Volumen von Stück {piece} ist {volume} > 0: Die Flächen zeigen nach außen.",
);
static INSIDE_OUT: Template = Template::new(
    "volume",
    "The volume of piece {piece} is {volume} < 0: all of its faces are turned.",
    "Das Volumen von Stück {piece} ist {volume} < 0: Alle Flächen werden gewendet.",
);
static COMPARED: Template = Template::new(
    "compared",
    "{face}: N · (P − mean) = {product}.",
    "{face}: N · (P − Mitte) = {product}.",
);

/// Returns the faces of a pyramid, some of them turned.
fn pyramid(turned: &[usize]) -> Vec<Vec<DVec3>> {
    let base = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let tip = DVec3::new(2.5, 2.5, 3.0);
    let side = |k: usize| vec![base[k], base[(k + 1) % 4], tip];
    let mut faces: Vec<Vec<DVec3>> = (0..4).map(side).collect();
    faces.push(base.iter().rev().copied().collect());
    turned.iter().for_each(|face| faces[*face].reverse());
    faces
}

/// Returns a Möbius strip of five triangles.
fn strip() -> Vec<Vec<DVec3>> {
    let corner = |k: usize| {
        let at = [
            (0.0, 4.0, 0.0),
            (4.0, 1.5, 1.0),
            (2.5, -3.0, -1.0),
            (-2.5, -3.0, 1.0),
            (-4.0, 1.5, -1.0),
        ];
        DVec3::from(at[k % 5])
    };
    // Each corner belongs to three neighbours: an odd number of triangles closes with a half twist.
    (0..5)
        .map(|k| {
            if k % 2 == 0 { [k, k + 1, k + 2] } else { [k + 1, k, k + 2] }.map(corner).to_vec()
        })
        .collect()
}

/// Numbers corners, equal ones alike.
fn shared(faces: &[Vec<DVec3>]) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let mut points: Vec<DVec3> = Vec::new();
    let mut number = |p: &DVec3| {
        points.iter().position(|q| q == p).unwrap_or_else(|| {
            points.push(*p);
            points.len() - 1
        })
    };
    let rings = faces.iter().map(|ring| ring.iter().map(&mut number).collect()).collect();
    (points, rings)
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let faces = input.faces(TAKES)?;
    let (points, rings) = shared(faces);
    let steps = record(cap, |t| orient(&points, &rings, &Options::default(), t))?;
    let (turned, piece) = (vec![None; faces.len()], vec![0; faces.len()]);
    let mut state = State { faces: faces.to_vec(), points, turned, piece };
    Ok(Frames::new(steps, move |step, want| {
        let (caption, now) = state.take(step);
        want.shown(step.line(), caption, || state.table(), || state.picture(&now, step))
    }))
}

/// State of the run.
#[derive(Clone)]
struct State {
    faces: Vec<Vec<DVec3>>,
    points: Vec<DVec3>,
    /// True for each reached face that is turned; `None` for faces not reached.
    turned: Vec<Option<bool>>,
    piece: Vec<usize>,
}

impl State {
    /// Returns the caption, and the faces in question.
    fn take(&mut self, step: &Step) -> (Caption, Vec<usize>) {
        let letter = |face: usize| Value::from(name(face as u32));
        let ends = |[a, b]: [usize; 2]| Value::from(format!("{a}{b}"));
        match *step {
            Step::Begin { face, piece } => {
                (self.turned[face], self.piece[face]) = (Some(false), piece);
                (BEGIN.with([("face", letter(face)), ("piece", (piece + 1).into())]), vec![face])
            }
            Step::Reached { from, face, edge, turned } => {
                (self.turned[face], self.piece[face]) = (Some(turned), self.piece[from]);
                let template = if turned { &TURNED } else { &AGREES };
                let values = [("edge", ends(edge)), ("face", letter(face)), ("from", letter(from))];
                (template.with(values), vec![from, face])
            }
            Step::Torn { faces: [from, face], edge } => {
                let values = [("from", letter(from)), ("face", letter(face)), ("edge", ends(edge))];
                (TORN.with(values), vec![from, face])
            }
            Step::Volume { piece, volume } => {
                let template = if volume < 0.0 { &INSIDE_OUT } else { &RIGHT };
                let members: Vec<usize> =
                    (0..self.faces.len()).filter(|face| self.piece[*face] == piece).collect();
                if volume < 0.0 {
                    let all =
                        members.iter().filter_map(|face| self.turned.get(*face).map(|_| *face));
                    for face in all.collect::<Vec<_>>() {
                        self.turned[face] = self.turned[face].map(|turned| !turned);
                    }
                }
                (template.with([("piece", (piece + 1).into()), ("volume", volume.into())]), members)
            }
            Step::Compared { face, product } => {
                self.turned[face] = Some(product < 0.0);
                (COMPARED.with([("face", letter(face)), ("product", product.into())]), vec![face])
            }
        }
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("face", "Fläche"),
            Word::new("piece", "Stück"),
            Word::new("turned", "gewendet"),
        ];
        let mut table = Table::new(heads);
        for (face, turned) in self.turned.iter().enumerate() {
            let (piece, word) = match turned {
                None => ("".into(), "".into()),
                Some(true) => ((self.piece[face] + 1).into(), Word::new("yes", "ja").into()),
                Some(false) => ((self.piece[face] + 1).into(), Word::new("no", "nein").into()),
            };
            let cells: [Value; 2] = [piece, word];
            table.row(name(face as u32), cells);
        }
        table
    }

    /// Draws the faces obliquely, with z to the lower left, and numbers their corners.
    fn picture(&self, now: &[usize], step: &Step) -> Picture {
        let flat = |p: DVec3| DVec2::new(p.x - 0.45 * p.z, p.y - 0.3 * p.z);
        let mut picture = Picture::around(self.points.iter().map(|&p| flat(p)), 0.3);
        picture.picture_from_input = None;
        for (face, ring) in self.faces.iter().enumerate() {
            let look = match self.turned[face] {
                None => Look::Pale,
                Some(false) => Look::Result,
                Some(true) => Look::Second,
            };
            let closed = ring.iter().chain(ring.first()).map(|&p| flat(p));
            picture.chain(closed.collect::<Vec<_>>(), look);
        }
        for &face in now {
            let ring = &self.faces[face];
            picture.ring(ring.iter().map(|&p| flat(p)).collect::<Vec<_>>(), Look::Now);
            let middle = ring.iter().sum::<DVec3>() / ring.len().max(1) as f64;
            picture.label(flat(middle), (0.0, 0.0), name(face as u32));
        }
        if let Step::Reached { edge: [a, b], .. } | Step::Torn { edge: [a, b], .. } = *step {
            picture.arrow(flat(self.points[a]), flat(self.points[b]), Look::First);
        }
        for (number, &p) in self.points.iter().enumerate() {
            picture.label(flat(p), (6.0, -6.0), number);
        }
        picture
    }
}
