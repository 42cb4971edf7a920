//! An octree of faces.

use super::Options;
use crate::math::DVec3;
use crate::visibility::polygons::Face;

/// A box that is divided into eight.
pub struct Cell {
    pub low: DVec3,
    pub high: DVec3,
    /// Faces that no child holds.
    pub faces: Vec<u32>,
    /// Children that hold faces, from front to back.
    pub children: Vec<usize>,
}

/// The cells; the first is the root, if there is one.
pub struct Octree {
    pub cells: Vec<Cell>,
}

/// Returns the box around a face; its depths are those of the plane, too, which is through the corners but for
/// rounding.
pub fn bounds(face: &Face) -> [DVec3; 2] {
    let corners = face.corners().iter();
    let around = |[low, high]: [DVec3; 2], corner: &DVec3| {
        let plane = corner.truncate().extend(face.depth(corner.truncate()));
        [low.min(*corner).min(plane), high.max(*corner).max(plane)]
    };
    corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], around)
}

impl Octree {
    /// Puts each face into the smallest cell that holds it.
    pub fn new(faces: &[Face], options: &Options) -> Self {
        let boxes: Vec<[DVec3; 2]> = faces.iter().map(bounds).collect();
        let join = |[a, b]: [DVec3; 2], [c, d]: &[DVec3; 2]| [a.min(*c), b.max(*d)];
        let mut octree = Self { cells: Vec::new() };
        if faces.is_empty() {
            return octree;
        }
        let [low, high] = boxes.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], join);
        let all = (0..faces.len() as u32).collect();
        octree.cells.push(Cell { low, high, faces: all, children: Vec::new() });
        let mut waiting = vec![(0, 0)];
        while let Some((cell, depth)) = waiting.pop() {
            if octree.cells[cell].faces.len() <= options.capacity || depth >= options.depth {
                continue;
            }
            let children = octree.divide(cell, &boxes);
            waiting.extend(children.into_iter().rev().map(|child| (child, depth + 1)));
        }
        octree
    }

    /// Divides a cell at its middle; returns the children that hold faces.
    fn divide(&mut self, cell: usize, boxes: &[[DVec3; 2]]) -> Vec<usize> {
        let Cell { low, high, faces, .. } = &mut self.cells[cell];
        let (low, high, middle) = (*low, *high, (*low + *high) * 0.5);
        let mut octants: [Vec<u32>; 8] = Default::default();
        faces.retain(|&face| {
            let [from, to] = boxes[face as usize];
            let (above, below) = (from.cmpge(middle), to.cmple(middle));
            let is_whole = (above | below).all();
            if is_whole {
                // z is the highest bit: the nearer four come first.
                let above = above & !below;
                octants[above.bitmask() as usize].push(face);
            }
            !is_whole
        });
        let mut children = Vec::new();
        for (octant, faces) in (0..).zip(octants).filter(|(_, faces)| !faces.is_empty()) {
            let pick = |bit: u32, k: usize| {
                if octant >> bit & 1 == 1 { (middle[k], high[k]) } else { (low[k], middle[k]) }
            };
            let [x, y, z] = [pick(0, 0), pick(1, 1), pick(2, 2)];
            children.push(self.cells.len());
            self.cells.push(Cell {
                low: DVec3::new(x.0, y.0, z.0),
                high: DVec3::new(x.1, y.1, z.1),
                faces,
                children: Vec::new(),
            });
        }
        self.cells[cell].children.clone_from(&children);
        children
    }

    /// Returns the number of faces in a cell and below it.
    pub fn count(&self, cell: usize) -> usize {
        let (mut count, mut waiting) = (0, vec![cell]);
        while let Some(cell) = waiting.pop() {
            let own = &self.cells[cell];
            count += own.faces.len();
            waiting.extend(&own.children);
        }
        count
    }
}
