//! The tree, and the walk through it.

use super::{Options, PlaneSide, Step};
use crate::Result;
use crate::math::{DVec3, Plane};
use crate::sorting::CompactSort;
use crate::trace::Tracer;
use crate::view::cull::FaceSide as Seen;
use crate::visibility::back_face::Eye;
use crate::visibility::polygons::Face;
use crate::visibility::polygons::pieces::Pieces;
use crate::work::Work;

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
/// use durer::work::Work;
///
/// let wall = |z: f64| {
///     Face::new(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, z)))
/// };
/// let (faces, work) = ([wall(1.0)?, wall(2.0)?], Work::default());
/// let tree = Tree::new(&faces, &Default::default(), &work, &mut NoTrace)?;
/// // One tree, two eyes.
/// let order = |z: f64| tree.back_to_front(Eye::At(DVec3::new(0.0, 0.0, z)), &mut NoTrace);
/// assert_eq!((order(0.0), order(3.0)), (vec![1, 0], vec![0, 1]));
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Tree {
    pieces: Pieces,
    nodes: Vec<Node>,
}

impl Tree {
    /// Creates the tree of polygons; the memory for their pieces is charged to `work` as long as the tree is there.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] for more pieces than the options allow; [`crate::Error::Memory`] where the budget does
    /// not suffice.
    pub fn new(
        faces: &[Face],
        options: &Options,
        work: &Work,
        t: &mut impl Tracer<Step>,
    ) -> Result<Self> {
        let mut tree = Self { pieces: Pieces::new(faces, work)?, nodes: Vec::new() };
        let mut lists = vec![((0..faces.len() as u32).collect::<Vec<u32>>(), None)];
        while let Some((list, below)) = lists.pop() {
            let Some(root) = tree.root(faces, &list, options, t) else { continue };
            let node = tree.grow(faces, root, below, t);
            let halves = tree.divide(node, root, list, options, t)?;
            for (list, side) in halves.into_iter().zip([PlaneSide::Front, PlaneSide::Back]) {
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
            let split = |other: &&u32| self.pieces.side(plane, **other) == PlaneSide::Both;
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
        below: Option<(u32, PlaneSide)>,
        t: &mut impl Tracer<Step>,
    ) -> u32 {
        let node = self.nodes.len() as u32;
        t.step(|| Step::Node { node, piece, below });
        let face = &faces[self.face(piece) as usize];
        let (plane, point) = (*face.plane(), face.corners()[0]);
        self.nodes.push(Node { plane, point, on: vec![piece], halves: [None; 2] });
        if let Some((above, side)) = below {
            self.nodes[above as usize].halves[usize::from(side == PlaneSide::Back)] = Some(node);
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
            let side = self.pieces.side(&plane, piece);
            t.step(|| Step::Sorted { piece, side });
            match side {
                PlaneSide::Front => halves[0].push(piece),
                PlaneSide::Back => halves[1].push(piece),
                PlaneSide::On => self.nodes[node as usize].on.push(piece),
                PlaneSide::Both => {
                    let limit = ("number of pieces of a tree", options.max_pieces);
                    let into = self.pieces.split(&plane, piece, limit)?;
                    t.step(|| Step::Split { piece, into });
                    halves.iter_mut().zip(into).for_each(|(half, piece)| half.push(piece));
                }
            }
        }
        Ok(halves)
    }

    /// Returns the face that a piece is of.
    pub fn face(&self, piece: u32) -> u32 {
        self.pieces.face(piece)
    }

    /// Returns the corners of a piece; if it was concave, parts may be joined by doubled edges along a cut.
    pub fn corners(&self, piece: u32) -> &[DVec3] {
        self.pieces.corners(piece)
    }

    /// Returns whether a point of a piece's face belongs to the piece.
    pub fn holds(&self, piece: u32, point: DVec3) -> bool {
        self.pieces.holds(piece, point)
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
                on.compact_sort_by_key(|&piece| std::cmp::Reverse(self.face(piece)));
                order.extend(on);
                continue;
            }
            let behind = eye.side(node.plane.normal, node.point) == Seen::Back;
            let side = if behind { PlaneSide::Back } else { PlaneSide::Front };
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
