//! The tree, and the walk through it.

use super::{Options, Side, Step};
use crate::math::{DVec3, Plane};
use crate::trace::Tracer;
use crate::view::cull::Face as Seen;
use crate::visibility::back_face::Eye;
use crate::visibility::polygons::Face;
use crate::{Error, Result};

/// So near to a plane, in units of the largest coordinate, a corner lies in it: corners that splitting made are
/// rounded.
const IN_PLANE: f64 = 1e-10;

/// Part of a face after splitting.
#[derive(Debug, Clone)]
struct Piece {
    face: u32,
    corners: Vec<DVec3>,
    /// The last cut that made it.
    cut: Option<u32>,
}

/// A side of a plane that pieces keep to, and the cut before it.
#[derive(Debug, Clone, Copy)]
struct Cut {
    plane: Plane,
    front: bool,
    before: Option<u32>,
}

/// A plane, the polygons in it, and the halves.
#[derive(Debug, Clone)]
struct Node {
    plane: Plane,
    /// Any point of the plane.
    point: DVec3,
    on: Vec<u32>,
    /// In front and behind.
    halves: [Option<u32>; 2],
}

/// A tree of planes over polygons.
///
/// ```
/// use durer::math::DVec3;
/// use durer::trace::NoTrace;
/// use durer::visibility::back_face::Eye;
/// use durer::visibility::polygons::{Face, bsp::Tree};
///
/// let wall = |z: f64| {
///     Face::new(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z)))
/// };
/// let tree = Tree::new(&[wall(1.0)?, wall(2.0)?], &Default::default(), &mut NoTrace)?;
/// // One tree, two eyes.
/// let order = |z: f64| tree.back_to_front(Eye::At(DVec3::new(0.0, 0.0, z)), &mut NoTrace);
/// assert_eq!((order(0.0), order(3.0)), (vec![1, 0], vec![0, 1]));
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Tree {
    pieces: Vec<Piece>,
    cuts: Vec<Cut>,
    nodes: Vec<Node>,
    /// So near to a plane corners lie in it.
    tolerance: f64,
}

impl Tree {
    /// Creates the tree of polygons.
    ///
    /// # Errors
    /// [`Error::Limit`] for more pieces than the options allow.
    pub fn new(faces: &[Face], options: &Options, t: &mut impl Tracer<Step>) -> Result<Self> {
        let piece =
            |(face, own): (u32, &Face)| Piece { face, corners: own.corners().to_vec(), cut: None };
        let largest = faces.iter().flat_map(Face::corners);
        let largest = largest.fold(0.0, |all: f64, c| all.max(c.abs().max_element()));
        let mut tree = Self {
            pieces: (0..).zip(faces).map(piece).collect(),
            tolerance: largest * IN_PLANE,
            ..Self::default()
        };
        let mut lists = vec![((0..faces.len() as u32).collect::<Vec<u32>>(), None)];
        while let Some((list, below)) = lists.pop() {
            let Some(root) = tree.root(faces, &list, options, t) else { continue };
            let node = tree.grow(faces, root, below, t);
            let halves = tree.divide(node, root, list, options, t)?;
            for (list, side) in halves.into_iter().zip([Side::Front, Side::Back]) {
                lists.push((list, Some((node, side))));
            }
        }
        Ok(tree)
    }

    /// Returns the first of the candidates whose plane splits the fewest others.
    fn root(
        &self,
        faces: &[Face],
        list: &[u32],
        options: &Options,
        t: &mut impl Tracer<Step>,
    ) -> Option<u32> {
        if options.candidates <= 1 || list.len() <= 2 {
            return list.first().copied();
        }
        let mut splits = |&piece: &u32| {
            let plane = faces[self.face(piece) as usize].plane();
            let split = |other: &&u32| self.side(plane, **other) == Side::Both;
            let splits = list.iter().filter(split).count();
            t.step(|| Step::Tried { piece, splits });
            splits
        };
        // Candidates from all over the list: neighbours are alike.
        let stride = list.len().div_ceil(options.candidates);
        list.iter().step_by(stride).min_by_key(|piece| splits(piece)).copied()
    }

    /// Adds a node with a piece's plane.
    fn grow(
        &mut self,
        faces: &[Face],
        piece: u32,
        below: Option<(u32, Side)>,
        t: &mut impl Tracer<Step>,
    ) -> u32 {
        let node = self.nodes.len() as u32;
        t.step(|| Step::Node { node, piece, below });
        let face = &faces[self.face(piece) as usize];
        let (plane, point) = (*face.plane(), face.corners()[0]);
        self.nodes.push(Node { plane, point, on: vec![piece], halves: [None; 2] });
        if let Some((above, side)) = below {
            self.nodes[above as usize].halves[usize::from(side == Side::Back)] = Some(node);
        }
        node
    }

    /// Shares a list out to both sides of a node's plane; polygons in it stay there.
    fn divide(
        &mut self,
        node: u32,
        root: u32,
        list: Vec<u32>,
        options: &Options,
        t: &mut impl Tracer<Step>,
    ) -> Result<[Vec<u32>; 2]> {
        let plane = self.nodes[node as usize].plane;
        let mut halves = [Vec::new(), Vec::new()];
        for piece in list.into_iter().filter(|&piece| piece != root) {
            let side = self.side(&plane, piece);
            t.step(|| Step::Sorted { piece, side });
            match side {
                Side::Front => halves[0].push(piece),
                Side::Back => halves[1].push(piece),
                Side::On => self.nodes[node as usize].on.push(piece),
                Side::Both => {
                    let into = self.split(&plane, piece, options)?;
                    t.step(|| Step::Split { piece, into });
                    halves.iter_mut().zip(into).for_each(|(half, piece)| half.push(piece));
                }
            }
        }
        Ok(halves)
    }

    fn side(&self, plane: &Plane, piece: u32) -> Side {
        let (mut front, mut back) = (false, false);
        for corner in &self.pieces[piece as usize].corners {
            let distance = plane.evaluate(*corner);
            front |= distance > self.tolerance;
            back |= distance < -self.tolerance;
        }
        match (front, back) {
            (true, true) => Side::Both,
            (true, false) => Side::Front,
            (false, true) => Side::Back,
            (false, false) => Side::On,
        }
    }

    /// Splits a piece into its parts in front of a plane and behind it.
    fn split(&mut self, plane: &Plane, piece: u32, options: &Options) -> Result<[u32; 2]> {
        let limit = options.max_pieces as u64;
        if self.pieces.len() as u64 + 2 > limit {
            let value = self.pieces.len() as u64 + 2;
            return Err(Error::Limit { what: "pieces of a tree", value, limit });
        }
        let Piece { face, ref corners, cut: before } = self.pieces[piece as usize];
        let parts = [1.0, -1.0].map(|sign| part(plane, sign, corners));
        let first = self.pieces.len() as u32;
        for (corners, front) in parts.into_iter().zip([true, false]) {
            let cut = Some(self.cuts.len() as u32);
            self.cuts.push(Cut { plane: *plane, front, before });
            self.pieces.push(Piece { face, corners, cut });
        }
        Ok([first, first + 1])
    }

    /// Returns the face that a piece is of.
    pub fn face(&self, piece: u32) -> u32 {
        self.pieces[piece as usize].face
    }

    /// Returns the corners of a piece; where it was concave, they may be joined by edges to and fro
    /// along a cut.
    pub fn corners(&self, piece: u32) -> &[DVec3] {
        &self.pieces[piece as usize].corners
    }

    /// Returns the number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Returns whether a point of a piece's face belongs to the piece.
    pub fn holds(&self, piece: u32, point: DVec3) -> bool {
        let mut next = self.pieces[piece as usize].cut;
        while let Some(cut) = next.and_then(|cut| self.cuts.get(cut as usize)) {
            if (cut.plane.evaluate(point) >= 0.0) != cut.front {
                return false;
            }
            next = cut.before;
        }
        true
    }

    /// Returns the pieces from back to front as an eye sees them: each may be painted over those before it.
    /// Pieces in one plane come in the reverse order of their faces, so that the first face is painted last.
    pub fn back_to_front(&self, eye: Eye, t: &mut impl Tracer<Step>) -> Vec<u32> {
        let mut order = Vec::new();
        // A node that is to be walked through, or whose own pieces are next.
        let mut waiting: Vec<(u32, bool)> =
            self.nodes.first().map(|_| (0, false)).into_iter().collect();
        while let Some((number, passed)) = waiting.pop() {
            let node = &self.nodes[number as usize];
            if passed {
                let mut on = node.on.clone();
                on.sort_by_key(|&piece| std::cmp::Reverse(self.face(piece)));
                order.extend(on);
                continue;
            }
            let behind = eye.side(node.plane.normal, node.point) == Seen::Back;
            let side = if behind { Side::Back } else { Side::Front };
            t.step(|| Step::Visit { node: number, eye: side });
            let [front, back] = node.halves;
            let (near, far) = if behind { (back, front) } else { (front, back) };
            waiting.extend(near.map(|near| (near, false)));
            waiting.push((number, true));
            waiting.extend(far.map(|far| (far, false)));
        }
        order
    }
}

/// Returns the corners of what lies on one side of a plane, by Sutherland and Hodgman.
fn part(plane: &Plane, sign: f64, corners: &[DVec3]) -> Vec<DVec3> {
    let mut part = Vec::with_capacity(corners.len() + 1);
    let next = corners.iter().cycle().skip(1);
    for (&a, &b) in corners.iter().zip(next) {
        let [da, db] = [a, b].map(|p| plane.evaluate(p) * sign);
        if da >= 0.0 {
            part.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            part.push(a + (b - a) * (da / (da - db)));
        }
    }
    part
}
