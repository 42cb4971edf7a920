//! The faces that can hide something, found by position.
//!
//! Only grid cells through which a line runs have lists; each list is in the order of the nearest depth, so that a line
//! stops once no nearer face follows.

use super::super::facing::{Facing, turned_on_grid};
use super::super::page::{Page, Projected, Vertex};
use super::cells::Lists;
use super::met::Met;
use crate::visibility::object::{Bodies, Faces};

/// Limit on the entries for each face: if large faces lie above one another all over the page, the cells are
/// larger.
const MOST_PER_FACE: usize = 256;

/// A face in a cell's list.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    /// Lower bound of the face's depth.
    nearest: f32,
    /// The item, or [`Occluders::cut_base`] + the index of a cut face.
    id: u32,
}

/// A face that may hide something.
#[derive(Debug, Clone, Copy)]
pub(super) struct Occluder {
    pub item: u32,
    /// Counter-clockwise on the page.
    pub corners: [Vertex; 3],
    /// See [`Cover::weight`](super::Cover::weight).
    pub weight: i8,
}

/// The faces that hide, by cell.
pub(super) struct Occluders<'a> {
    faces: &'a Faces,
    projected: &'a Projected,
    lists: Lists,
    starts: Vec<u32>,
    entries: Vec<Entry>,
    /// Ids from here on are cut faces.
    cut_base: u32,
    /// The body of each item, if requested.
    bodies: Vec<u32>,
    /// True for each item that approximates a smooth surface; empty if none does.
    smooth: Vec<bool>,
    /// True for each item that lies folded over an outline; empty if none does.
    folded: Vec<bool>,
    /// True for each list with such an item; empty if there is none.
    folds: Vec<bool>,
}

impl<'a> Occluders<'a> {
    /// Sorts the faces that hide into the cells that the lines run through.
    pub fn new(
        faces: &'a Faces,
        bodies: &Bodies,
        facing: &Facing,
        projected: &'a Projected,
        lines: impl Iterator<Item = [Vertex; 2]> + Clone,
    ) -> Self {
        let hides = hiding(faces, bodies, facing, projected);
        let count = hides.iter().filter(|h| **h).count();
        let lists = Lists::new(count, lines.clone());
        let cut_base = faces.len() as u32;
        let smooth = if facing.any_smooth() { cut_base } else { 0 };
        let mut found = Self {
            faces,
            projected,
            starts: Vec::new(),
            lists,
            entries: Vec::new(),
            cut_base,
            bodies: (0..smooth).map(|item| bodies.of(item).unwrap_or(u32::MAX)).collect(),
            smooth: where_any(smooth, |item| facing.is_smooth(item)),
            folded: where_any(smooth, |item| facing.folded(item)),
            folds: Vec::new(),
        };
        let ids = || {
            let whole = (0..cut_base).filter(|&item| hides[item as usize]);
            let cut = projected.cuts.iter().zip(cut_base..);
            whole.chain(cut.filter(|(c, _)| hides[c.item as usize]).map(|(_, id)| id))
        };
        let most = (found.count() * MOST_PER_FACE).min(u32::MAX as usize);
        let mut counted = found.ends(ids(), most);
        let entries = counted.as_ref().map_or(0, |(_, sum)| *sum as usize);
        if let Some(finer) = found.lists.finer((count, entries), lines.clone()) {
            found.lists = finer;
            counted = found.ends(ids(), most);
        }
        let (mut starts, sum) = loop {
            match counted {
                Some(counted) => break counted,
                None => found.lists = found.lists.coarser(lines.clone()),
            }
            counted = found.ends(ids(), most);
        };
        let mut entries = vec![Entry { nearest: 0.0, id: 0 }; sum as usize];
        for id in ids() {
            found.each_cell(id, |cell, nearest| {
                starts[cell] -= 1;
                entries[starts[cell] as usize] = Entry { nearest, id };
            });
        }
        for w in starts.windows(2) {
            entries[w[0] as usize..w[1] as usize]
                .sort_unstable_by(|a, b| a.nearest.total_cmp(&b.nearest).then(a.id.cmp(&b.id)));
        }
        (found.starts, found.entries) = (starts, entries);
        found.folds = found.lists_with_folds(ids());
        found
    }

    /// Computes [`Self::folds`].
    fn lists_with_folds(&self, ids: impl Iterator<Item = u32>) -> Vec<bool> {
        if self.folded.is_empty() {
            return Vec::new();
        }
        let mut folds = vec![false; self.lists.count()];
        for id in ids.filter(|id| self.is_folded(*id)) {
            self.each_cell(id, |cell, _| folds[cell] = true);
        }
        folds
    }

    /// Returns whether a face of a list lies folded over an outline.
    fn is_folded(&self, id: u32) -> bool {
        let cut = id.checked_sub(self.cut_base).map(|i| self.projected.cuts[i as usize].item);
        self.folded.get(cut.unwrap_or(id) as usize) == Some(&true)
    }

    /// Returns the end of each cell's list, and of all together; `None` if it takes more entries than `most`.
    fn ends(&self, ids: impl Iterator<Item = u32>, most: usize) -> Option<(Vec<u32>, u32)> {
        let mut ends = vec![0u32; self.lists.count() + 1];
        let mut left = if self.lists.is_one() { u32::MAX as usize } else { most };
        for id in ids {
            let mut met = 0;
            self.each_cell(id, |cell, _| {
                ends[cell] += 1;
                met += 1;
            });
            left = left.checked_sub(met)?;
        }
        let mut sum = 0;
        for end in &mut ends {
            sum += *end;
            *end = sum;
        }
        Some((ends, sum))
    }

    /// Calls `f` with the marked cells of a face and its nearest depth.
    #[inline]
    fn each_cell(&self, id: u32, mut f: impl FnMut(usize, f32)) {
        let Some(occluder) = self.get(id) else { return };
        let depth = occluder.corners.map(|c| c.depth);
        let nearest = (depth[0].min(depth[1]).min(depth[2]) as f32).next_down();
        self.lists.each_of(&occluder.corners.map(|c| c.at), |_, cells| {
            cells.filter(|&cell| self.lists.is_marked(cell)).for_each(|cell| f(cell, nearest));
        });
    }

    /// Returns the face of a list's entry; `None` if it is seen edge-on.
    fn get(&self, id: u32) -> Option<Occluder> {
        let (item, corners) = if id < self.cut_base {
            (id, self.projected.corners(self.faces.triangle(id)?)?)
        } else {
            let cut = self.projected.cuts[(id - self.cut_base) as usize];
            (cut.item, cut.corners)
        };
        let [a, b, c] = corners;
        let [a, b, c] = match turned_on_grid(corners.map(|c| c.at)) {
            1 => [a, b, c],
            -1 => [a, c, b],
            _ => return None,
        };
        // From the smallest corner on: copies of a face that begin elsewhere are rounded alike.
        let corners = if b.at < a.at && b.at < c.at {
            [b, c, a]
        } else if c.at < a.at {
            [c, a, b]
        } else {
            [a, b, c]
        };
        let weight = if self.is_folded(id) { -1 } else { 1 };
        Some(Occluder { item, corners, weight })
    }

    /// Returns whether two faces are of one body; of none if that was not requested.
    pub fn same_body(&self, a: u32, b: u32) -> bool {
        let of = |item: u32| self.bodies.get(item as usize).filter(|b| **b != u32::MAX);
        of(a).is_some() && of(a) == of(b)
    }

    /// Returns whether a face approximates a smooth surface and has one of two vertices.
    pub fn is_beside(&self, item: u32, vertices: [u32; 2]) -> bool {
        let touches = |t: [u32; 3]| t.iter().any(|v| vertices.contains(v));
        self.smooth.get(item as usize) == Some(&true)
            && self.faces.triangle(item).is_some_and(touches)
    }

    /// Returns the number of faces.
    pub fn count(&self) -> usize {
        self.cut_base as usize + self.projected.cuts.len()
    }

    /// Returns the grid.
    pub fn page(&self) -> &Page {
        &self.projected.page
    }

    /// Calls `f` once, or now and then more often, with each face that may hide a part of the line; in the order of
    /// cells and depths. In cells in which the line is known to be hidden, the rest is ignored, unless a face there may
    /// make up for another.
    pub fn along(
        &self,
        line: &[Vertex; 2],
        met: &mut Met,
        mut f: impl FnMut(u32, &dyn Fn() -> Option<Occluder>, &mut Met),
    ) {
        let farthest = line[0].depth.max(line[1].depth) as f32;
        let farthest = farthest.next_up();
        met.begin();
        self.lists.each_of(&line.map(|v| v.at), |row, lists| {
            for list in lists {
                let [from, to] = [list, list + 1].map(|c| self.starts[c] as usize);
                let is_hidden = |met: &Met| {
                    !met.hides_nothing()
                        && self.folds.get(list) != Some(&true)
                        && met.hides(self.lists.stretch(row, list, line))
                };
                if from == to || is_hidden(met) {
                    continue;
                }
                for entry in &self.entries[from..to] {
                    if entry.nearest > farthest {
                        break;
                    }
                    if !met.is_first(entry.id) {
                        continue;
                    }
                    let before = met.times();
                    f(entry.id, &|| self.get(entry.id), met);
                    if met.times() != before && is_hidden(met) {
                        break;
                    }
                }
            }
        });
    }
}

/// Returns the value of `is` for each item, or nothing if it is false for all.
fn where_any(count: u32, is: impl Fn(u32) -> bool) -> Vec<bool> {
    if (0..count).any(&is) { (0..count).map(is).collect() } else { Vec::new() }
}

/// Returns the faces that hide others behind them. Of a closed body seen from outside those that
/// show their front do, for whatever lies behind a back lies behind a front too; of others all.
fn hiding(faces: &Faces, bodies: &Bodies, facing: &Facing, projected: &Projected) -> Vec<bool> {
    let mut front_only: Vec<bool> = bodies.all().iter().map(|b| b.closed).collect();
    if projected.any_cut() {
        // The eye may be inside the cut body.
        for (item, t) in faces.triangles() {
            if let (None, Some(body)) = (projected.corners(t), bodies.of(item)) {
                front_only[body as usize] = false;
            }
        }
    }
    let hides = |item: u32| {
        bodies.of(item).is_some_and(|body| !front_only[body as usize] || facing.front(item))
    };
    (0..faces.len() as u32).map(hides).collect()
}
