//! The lesson of binary space partition trees.

use super::{EXAMPLES, Scene, TAKES, name};
use crate::Result;
use crate::explain::frame::{Frames, Shown, Want, record};
use crate::explain::input::Input;
use crate::explain::lesson::Lesson;
use crate::explain::picture::{Look, Picture};
use crate::explain::table::Table;
use crate::explain::words::{Caption, Template, Value, Word};
use crate::math::DVec2;
use crate::trace::PseudocodeLine;
use crate::visibility::polygons::bsp::{INFO, Options, PlaneSide, Step, items};

pub(super) const LESSON: Lesson = Lesson {
    name: INFO.name,
    info: &INFO,
    takes: TAKES,
    examples: EXAMPLES,
    templates: &[&TRIED, &NODE, &SORTED, &SPLIT, &VISIT, &PAINT, &PIXEL],
    unreached: &[],
    make: |_, input, _, cap| make(input, cap),
};

static TRIED: Template = Template::new(
    "tried",
    "{piece} is tried as root: its plane would split {count} {count|other|others}.",
    "{piece} wird als Wurzel versucht: Die Ebene würde {count} andere teilen.",
);
static NODE: Template = Template::new(
    "node",
    "{piece} becomes node {node} of the tree, {place}.",
    "{piece} wird Knoten {node} des Baums, {place}.",
);
static SORTED: Template = Template::new(
    "sorted",
    "{piece} lies {side} the plane of node {node}.",
    "{piece} liegt {side} der Ebene von Knoten {node}.",
);
static SPLIT: Template = Template::new(
    "split",
    "{piece} is split by the plane: {front} in front, {back} behind.",
    "{piece} wird von der Ebene geteilt: {front} davor, {back} dahinter.",
);
static VISIT: Template = Template::new(
    "visit",
    "Node {node} ({piece}): the eye is {side} its plane, so the other side is painted first.",
    "Knoten {node} ({piece}): Das Auge ist {side} der Ebene, zuerst wird die andere Seite gemalt.",
);
static PAINT: Template = Template::new(
    "paint",
    "{piece} is painted over the picture so far.",
    "{piece} wird über alles gemalt, was da ist.",
);
static PIXEL: Template = Template::new(
    "pixel",
    "Pixel {pixel} gets face {face}.",
    "Pixel {pixel} bekommt Fläche {face}.",
);

/// A node of the tree.
#[derive(Clone)]
struct Node {
    piece: u32,
    front: String,
    back: String,
}

/// The tree so far, and names of pieces.
#[derive(Clone)]
struct State {
    scene: Scene,
    names: Vec<(u32, String)>,
    nodes: Vec<Node>,
    now: u32,
}

fn make(input: &Input, cap: usize) -> Result<Frames> {
    let scene = Scene::new(input)?;
    let options = Options::default();
    let steps = record(cap, |t| items(&scene.faces, &scene.screen(), &options, t))?;
    let mut state = State { scene, names: Vec::new(), nodes: Vec::new(), now: 0 };
    Ok(Frames::new(steps, move |step, want| state.show(step, want)))
}

impl State {
    fn show(&mut self, step: &Step, want: Want) -> Shown {
        let caption = self.take(step);
        want.shown(step.line(), caption, || self.table(), || self.picture(step))
    }

    /// Returns a piece's name: a face's letter, with + for the part in front and − for that behind.
    fn piece(&self, piece: u32) -> String {
        let own = self.names.iter().find(|(number, _)| *number == piece);
        own.map_or_else(|| name(piece), |(_, own)| own.clone())
    }

    fn take(&mut self, step: &Step) -> Caption {
        let piece = |number| ("piece", Value::from(self.piece(number)));
        match *step {
            Step::Tried { piece: number, splits } => {
                TRIED.with([piece(number), ("count", splits.into())])
            }
            Step::Node { node, piece: number, below } => {
                let place = place(below);
                let caption = NODE.with([piece(number), ("node", node.into()), ("place", place)]);
                self.add(node, number, below);
                caption
            }
            Step::Sorted { piece: number, side } => {
                SORTED.with([piece(number), ("side", word(side).into()), ("node", self.now.into())])
            }
            Step::Split { piece: number, into: [front, back] } => {
                let names = [(front, "+"), (back, "−")]
                    .map(|(part, sign)| (part, self.piece(number) + sign));
                let [front, back] = [0, 1].map(|k: usize| Value::from(names[k].1.clone()));
                let caption = SPLIT.with([piece(number), ("front", front), ("back", back)]);
                self.names.extend(names);
                caption
            }
            Step::Visit { node, eye } => {
                let own = self.nodes.get(node as usize).map_or(0, |node| node.piece);
                VISIT.with([("node", node.into()), piece(own), ("side", word(eye).into())])
            }
            Step::Paint { piece: number, .. } => PAINT.with([piece(number)]),
            Step::Pixel { pixel: pixel @ [x, y], face } => {
                self.scene.set(pixel, face);
                let at = DVec2::new(x.into(), y.into());
                PIXEL.with([("pixel", at.into()), ("face", name(face).into())])
            }
        }
    }

    fn add(&mut self, node: u32, piece: u32, below: Option<(u32, PlaneSide)>) {
        self.now = node;
        self.nodes.push(Node { piece, front: String::new(), back: String::new() });
        if let Some((above, side)) = below
            && let Some(above) = self.nodes.get_mut(above as usize)
        {
            let child = if side == PlaneSide::Front { &mut above.front } else { &mut above.back };
            *child = node.to_string();
        }
    }

    fn table(&self) -> Table {
        let heads = [
            Word::new("node", "Knoten"),
            Word::new("polygon", "Polygon"),
            Word::new("in front", "davor"),
            Word::new("behind", "dahinter"),
        ];
        let mut table = Table::new(heads);
        for (number, node) in self.nodes.iter().enumerate() {
            let cells = [self.piece(node.piece), node.front.clone(), node.back.clone()];
            table.row(number, cells.map(Value::from));
        }
        table
    }

    fn picture(&self, step: &Step) -> Picture {
        let mut picture = self.scene.picture();
        let piece = match *step {
            Step::Tried { piece, .. }
            | Step::Node { piece, .. }
            | Step::Sorted { piece, .. }
            | Step::Split { piece, .. }
            | Step::Paint { piece, .. } => Some(piece),
            Step::Visit { node, .. } => self.nodes.get(node as usize).map(|node| node.piece),
            Step::Pixel { .. } => None,
        };
        if let Some(face) = piece.and_then(|piece| self.face_of(piece)) {
            self.scene.outline(&mut picture, face, Look::Now);
        }
        match *step {
            Step::Pixel { pixel, .. } => picture.dot(super::middle(pixel), Look::Now),
            Step::Split { piece, .. } => {
                let ends = self.split(piece);
                picture.chain(ends.clone(), Look::Second);
                ends.into_iter().for_each(|end| picture.dot(end, Look::Second));
            }
            _ => {}
        }
        picture
    }

    /// Returns the face that a piece is a part of.
    fn face_of(&self, piece: u32) -> Option<usize> {
        let letter = self.piece(piece);
        (0..self.scene.faces.len())
            .find(|&face| name(face as u32) == letter.trim_end_matches(['+', '−']))
    }

    /// Returns where the outline of a piece's face meets the plane of the node, on the screen.
    fn split(&self, piece: u32) -> Vec<DVec2> {
        let node = self.nodes.get(self.now as usize).and_then(|node| self.face_of(node.piece));
        let faces = [self.face_of(piece), node].map(|face| self.scene.faces.get(face?));
        let [Some(own), Some(plane)] = faces else { return Vec::new() };
        let before = |p: DVec2| own.depth(p) - plane.depth(p);
        let outline = own.outline();
        let next = outline.iter().cycle().skip(1);
        let crossing = |(&p, &q): (&DVec2, &DVec2)| {
            let (from, to) = (before(p), before(q));
            (from * to < 0.0).then(|| p.lerp(q, from / (from - to)))
        };
        outline.iter().zip(next).filter_map(crossing).collect()
    }
}

/// Returns where a node hangs.
fn place(below: Option<(u32, PlaneSide)>) -> Value {
    match below {
        None => Word::new("the root", "die Wurzel").into(),
        Some((above, PlaneSide::Front)) => {
            Value::List(vec![Word::new("in front of node", "vor Knoten").into(), above.into()])
        }
        Some((above, _)) => {
            Value::List(vec![Word::new("behind node", "hinter Knoten").into(), above.into()])
        }
    }
}

fn word(side: PlaneSide) -> Word {
    match side {
        PlaneSide::Front => Word::new("in front of", "vor"),
        PlaneSide::Back => Word::new("behind", "hinter"),
        PlaneSide::On => Word::new("in", "in"),
        PlaneSide::Both => Word::new("on both sides of", "auf beiden Seiten"),
    }
}
