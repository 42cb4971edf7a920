//! Octrees of faces.

use crate::math::{DVec3, Plane};
use crate::visibility::polygons::Face;
use crate::work::{Charge, Work};
use crate::{Error, Result};

/// Part of a cell's size by which a face may pass beside it and still be in it, so that rounding loses none.
const SLACK: f64 = 1e-9;

/// The cells that hold a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holding {
    /// The smallest cell that holds all of it.
    Whole,
    /// Each of the smallest cells that hold a part of it.
    Parts,
}

/// When to divide.
#[derive(Debug, Clone, Copy)]
pub struct Division {
    /// Cells that hold a face.
    pub holding: Holding,
    /// A cell with more faces than this is divided.
    pub capacity: usize,
    /// Divisions of a cell by a cell at most.
    pub depth: u32,
    /// Largest total number of faces in all cells; a face counts in each of its cells.
    pub most: usize,
}

/// A box that is divided into eight.
pub struct Cell {
    pub low: DVec3,
    pub high: DVec3,
    /// Faces that belong to it and to no child.
    pub faces: Vec<u32>,
    /// Children that hold faces, from front to back.
    pub children: Vec<usize>,
}

/// The cells; the first is the root, if there is one.
pub struct Octree {
    pub cells: Vec<Cell>,
    charge: Charge,
}

/// Returns the box around a face; its depths include those of the plane, which differ from the corners' by rounding.
pub fn bounds(face: &Face) -> [DVec3; 2] {
    let corners = face.corners().iter();
    let around = |[low, high]: [DVec3; 2], corner: &DVec3| {
        let plane = corner.truncate().extend(face.depth(corner.truncate()));
        [low.min(*corner).min(plane), high.max(*corner).max(plane)]
    };
    corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], around)
}

impl Octree {
    /// Divides the box around all faces.
    ///
    /// # Errors
    /// [`Error::Limit`] if parts of faces are in too many cells; [`Error::Memory`] if the budget does not suffice.
    pub fn new(faces: &[Face], division: &Division, work: &Work) -> Result<Self> {
        let of_boxes = (faces.len() * size_of::<[DVec3; 2]>()) as u64;
        let charge = work.charge("octree", of_boxes)?;
        let boxes: Vec<[DVec3; 2]> = faces.iter().map(bounds).collect();
        let join = |[a, b]: [DVec3; 2], [c, d]: &[DVec3; 2]| [a.min(*c), b.max(*d)];
        let mut octree = Self { cells: Vec::new(), charge };
        if faces.is_empty() {
            return Ok(octree);
        }
        let [low, high] = boxes.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], join);
        let mut count = faces.len();
        let all = (0..faces.len() as u32).collect();
        octree.cells.push(Cell { low, high, faces: all, children: Vec::new() });
        let mut waiting = vec![(0, 0)];
        while let Some((cell, depth)) = waiting.pop() {
            let held = octree.cells[cell].faces.len();
            if held <= division.capacity || depth >= division.depth {
                continue;
            }
            let children = octree.divide(cell, (faces, &boxes), division.holding);
            let of = |cell: &usize| octree.cells[*cell].faces.len();
            count = count + of(&cell) + children.iter().map(of).sum::<usize>() - held;
            if count > division.most {
                let (value, limit) = (count as u64, division.most as u64);
                return Err(Error::Limit {
                    what: "number of faces in the cells of an octree",
                    value,
                    limit,
                });
            }
            let cells = octree.cells.len() * size_of::<Cell>() + count * size_of::<u32>();
            octree.charge.grow_to(of_boxes + cells as u64)?;
            waiting.extend(children.into_iter().rev().map(|child| (child, depth + 1)));
        }
        Ok(octree)
    }

    /// Divides a cell at its middle; returns the children that hold faces.
    fn divide(
        &mut self,
        cell: usize,
        (faces, boxes): (&[Face], &[[DVec3; 2]]),
        holding: Holding,
    ) -> Vec<usize> {
        let Cell { low, high, faces: own, .. } = &mut self.cells[cell];
        let (low, high) = (*low, *high);
        let middle = (low + high) * 0.5;
        // z is the highest bit: the nearer four come first.
        let corners = |octant: u8| {
            let is_high = |k: usize| octant >> k & 1 == 1;
            let from = |k: usize| if is_high(k) { middle[k] } else { low[k] };
            let to = |k: usize| if is_high(k) { high[k] } else { middle[k] };
            [DVec3::from([0, 1, 2].map(from)), DVec3::from([0, 1, 2].map(to))]
        };
        let mut octants: [Vec<u32>; 8] = Default::default();
        own.retain(|&face| {
            let [from, to] = boxes[face as usize];
            let (above, below) = (from.cmpge(middle), to.cmple(middle));
            let is_whole = (above | below).all();
            match holding {
                Holding::Whole if is_whole => {
                    octants[(above & !below).bitmask() as usize].push(face);
                }
                Holding::Whole => return true,
                Holding::Parts => {
                    let plane = faces[face as usize].plane();
                    let meets = |octant: &u8| meets(corners(*octant), [from, to], plane);
                    let met = (0..8).filter(meets);
                    met.for_each(|octant| octants[octant as usize].push(face));
                }
            }
            false
        });
        let mut children = Vec::new();
        for (octant, faces) in (0..).zip(octants).filter(|(_, faces)| !faces.is_empty()) {
            let [low, high] = corners(octant);
            children.push(self.cells.len());
            self.cells.push(Cell { low, high, faces, children: Vec::new() });
        }
        self.cells[cell].children.clone_from(&children);
        children
    }

    /// Returns the number of faces in a cell and below it.
    pub fn count(&self, cell: usize) -> usize {
        self.below(cell).map(|cell| cell.faces.len()).sum()
    }

    /// Returns the number of cells in a cell, itself one of them.
    pub fn cells_in(&self, cell: usize) -> usize {
        self.below(cell).count()
    }

    /// Returns a cell and all below it.
    fn below(&self, cell: usize) -> impl Iterator<Item = &Cell> {
        let mut waiting = vec![cell];
        std::iter::from_fn(move || {
            let own = &self.cells[waiting.pop()?];
            waiting.extend(&own.children);
            Some(own)
        })
    }
}

/// Returns whether a face with a box around it and its plane may meet a cell.
fn meets([low, high]: [DVec3; 2], [from, to]: [DVec3; 2], plane: &Plane) -> bool {
    let slack = (high - low).max_element() * SLACK;
    let half = (high - low) * 0.5 + slack;
    let boxes_meet = (from - slack).cmple(high).all() && (to + slack).cmpge(low).all();
    boxes_meet && plane.evaluate((low + high) * 0.5).abs() <= plane.normal.abs().dot(half)
}
