//! The faces that can hide something, found by place.
//!
//! A uniform grid of about as many cells as there are faces, but only those cells have lists that a
//! line runs through; each list is in the order of the nearest depth, so that a line stops where
//! nothing nearer comes.

use super::super::facing::{Facing, turned_on_grid};
use super::super::page::{GridPoint, Page, Projected, Vertex};
use super::Cover;
use crate::visibility::object::{Bodies, Faces};

/// A face in a cell's list.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    /// Not above the smallest depth of the face.
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

/// The cells of the page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    /// Log₂ of steps per cell.
    shift: u32,
    low: GridPoint,
    columns: i32,
    rows: i32,
}

impl Cells {
    /// About `count` square cells over what the points span.
    fn new(bounds: [GridPoint; 2], count: usize) -> Self {
        let [low, high] = bounds;
        let [w, h] = high.minus(low).map(|d| d.max(1) as f64);
        let side = (w * h / count.max(1) as f64).sqrt().max(w.max(h) / 4096.0).max(16.0);
        // The next power of two that is not much larger than the side asked for.
        let shift = (libm::frexp(side).1 - 1).clamp(4, 30) as u32;
        let cells = |d: f64| (d as i64 >> shift) as i32 + 1;
        Self { shift, low, columns: cells(w), rows: cells(h) }
    }

    fn count(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    fn column(&self, x: i64) -> i32 {
        ((x - i64::from(self.low.x)) >> self.shift).clamp(0, i64::from(self.columns) - 1) as i32
    }

    fn row(&self, y: i64) -> i32 {
        ((y - i64::from(self.low.y)) >> self.shift).clamp(0, i64::from(self.rows) - 1) as i32
    }

    /// Calls `f` with each row that the polygon of the points touches, and its first and last column
    /// there; a step of margin makes up for rounding.
    fn rows_of(&self, points: &[GridPoint], mut f: impl FnMut(i32, i32, i32)) {
        let (mut lo, mut hi) = (points[0], points[0]);
        for p in points {
            lo = GridPoint { x: lo.x.min(p.x), y: lo.y.min(p.y) };
            hi = GridPoint { x: hi.x.max(p.x), y: hi.y.max(p.y) };
        }
        let [x0, x1] = [i64::from(lo.x) - 1, i64::from(hi.x) + 1].map(|x| self.column(x));
        let [y0, y1] = [i64::from(lo.y) - 1, i64::from(hi.y) + 1].map(|y| self.row(y));
        if x1 - x0 < 2 || y0 == y1 {
            (y0..=y1).for_each(|y| f(y, x0, x1));
            return;
        }
        for row in y0..=y1 {
            let bottom = (i64::from(self.low.y) + (i64::from(row) << self.shift)) as f64 - 2.0;
            let top = bottom + f64::from(1u32 << self.shift) + 4.0;
            let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
            let mut reach = |x: f64| {
                from = from.min(x);
                to = to.max(x);
            };
            for (i, p) in points.iter().enumerate() {
                let q = points[(i + 1) % points.len()];
                let (px, py) = (f64::from(p.x), f64::from(p.y));
                let (dx, dy) = (f64::from(q.x) - px, f64::from(q.y) - py);
                if py >= bottom && py <= top {
                    reach(px);
                }
                for y in [bottom, top] {
                    let t = (y - py) / dy;
                    if t > 0.0 && t < 1.0 {
                        reach(px + t * dx);
                    }
                }
            }
            if from <= to {
                f(row, self.column(from as i64 - 2).max(x0), self.column(to as i64 + 2).min(x1));
            }
        }
    }
}

/// The faces that hide, by cell.
pub(super) struct Occluders<'a> {
    faces: &'a Faces,
    projected: &'a Projected,
    pub cells: Cells,
    starts: Vec<u32>,
    entries: Vec<Entry>,
    /// Ids from here on are cut faces.
    cut_base: u32,
    /// The body of each item, where that is asked for.
    bodies: Vec<u32>,
    /// Of each item whether it stands for a smooth surface; empty where none does.
    smooth: Vec<bool>,
    /// Of each item whether it lies folded over an outline; empty where none does.
    folded: Vec<bool>,
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
        let cells = Cells::new(bounds(lines.clone()), count);
        let mut marked = vec![false; cells.count()];
        for [p, q] in lines {
            cells.rows_of(&[p.at, q.at], |row, from, to| {
                let start = (row * cells.columns) as usize;
                marked[start + from as usize..=start + to as usize].fill(true);
            });
        }
        let cut_base = faces.len() as u32;
        let smooth = if facing.any_smooth() { cut_base } else { 0 };
        let mut found = Self {
            faces,
            projected,
            cells,
            starts: vec![0; cells.count() + 1],
            entries: Vec::new(),
            cut_base,
            bodies: (0..smooth).map(|item| bodies.of(item).unwrap_or(u32::MAX)).collect(),
            smooth: where_any(smooth, |item| facing.is_smooth(item)),
            folded: where_any(smooth, |item| facing.folded(item)),
        };
        let ids = || {
            let whole = (0..cut_base).filter(|&item| hides[item as usize]);
            let cut = projected.cuts.iter().zip(cut_base..);
            whole.chain(cut.filter(|(c, _)| hides[c.item as usize]).map(|(_, id)| id))
        };
        let mut starts = std::mem::take(&mut found.starts);
        for id in ids() {
            found.each_cell(id, &marked, |cell, _| starts[cell] += 1);
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut entries = vec![Entry { nearest: 0.0, id: 0 }; sum as usize];
        for id in ids() {
            found.each_cell(id, &marked, |cell, nearest| {
                starts[cell] -= 1;
                entries[starts[cell] as usize] = Entry { nearest, id };
            });
        }
        for w in starts.windows(2) {
            entries[w[0] as usize..w[1] as usize]
                .sort_unstable_by(|a, b| a.nearest.total_cmp(&b.nearest).then(a.id.cmp(&b.id)));
        }
        (found.starts, found.entries) = (starts, entries);
        found
    }

    /// Calls `f` with the marked cells of a face and its nearest depth.
    fn each_cell(&self, id: u32, marked: &[bool], mut f: impl FnMut(usize, f32)) {
        let Some(occluder) = self.get(id) else { return };
        let depth = occluder.corners.map(|c| c.depth);
        let nearest = (depth[0].min(depth[1]).min(depth[2]) as f32).next_down();
        self.cells.rows_of(&occluder.corners.map(|c| c.at), |row, from, to| {
            let start = (row * self.cells.columns) as usize;
            let cells = start + from as usize..=start + to as usize;
            cells.filter(|&cell| marked[cell]).for_each(|cell| f(cell, nearest));
        });
    }

    /// The face of a list's entry; `None` where it is seen edge-on.
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
        let weight = if self.folded.get(item as usize) == Some(&true) { -1 } else { 1 };
        Some(Occluder { item, corners, weight })
    }

    /// Whether two faces are of one body; of none where that was not asked for.
    pub fn same_body(&self, a: u32, b: u32) -> bool {
        let of = |item: u32| self.bodies.get(item as usize).filter(|b| **b != u32::MAX);
        of(a).is_some() && of(a) == of(b)
    }

    /// Whether a face stands for a smooth surface and has one of two vertices.
    pub fn is_beside(&self, item: u32, vertices: [u32; 2]) -> bool {
        let touches = |t: [u32; 3]| t.iter().any(|v| vertices.contains(v));
        self.smooth.get(item as usize) == Some(&true)
            && self.faces.triangle(item).is_some_and(touches)
    }

    /// Whether what lies behind a face is hidden whatever else lies there.
    pub fn hides_for_certain(&self, cover: &Cover) -> bool {
        let whole = cover.from <= 0.0 && cover.to >= 1.0 && cover.left && cover.right;
        whole && self.folded.is_empty()
    }

    /// The grid.
    pub fn page(&self) -> &Page {
        &self.projected.page
    }

    /// Calls `f` once or more with each face that may hide a part of the line; in the order of cells
    /// and depths, until it says that it has seen enough.
    pub fn along(
        &self,
        [p, q]: &[Vertex; 2],
        mut f: impl FnMut(u32, &dyn Fn() -> Option<Occluder>) -> bool,
    ) {
        let farthest = p.depth.max(q.depth) as f32;
        let farthest = farthest.next_up();
        let mut more = true;
        self.cells.rows_of(&[p.at, q.at], |row, from, to| {
            let start = (row * self.cells.columns) as usize;
            for cell in start + from as usize..=start + to as usize {
                let [from, to] = [cell, cell + 1].map(|c| self.starts[c] as usize);
                for entry in &self.entries[from..to] {
                    if !more || entry.nearest > farthest {
                        break;
                    }
                    more = f(entry.id, &|| self.get(entry.id));
                }
            }
        });
    }
}

/// Of each of so many items what `is` says, if that is true of any.
fn where_any(count: u32, is: impl Fn(u32) -> bool) -> Vec<bool> {
    if (0..count).any(&is) { (0..count).map(is).collect() } else { Vec::new() }
}

/// Which faces hide what is behind them. Of a closed body seen from outside those that show their
/// front do, for whatever lies behind a back lies behind a front too; of others all.
fn hiding(faces: &Faces, bodies: &Bodies, facing: &Facing, projected: &Projected) -> Vec<bool> {
    let mut front_only: Vec<bool> = bodies.all().iter().map(|b| b.closed).collect();
    if projected.any_cut() {
        // The eye may be inside of what is cut.
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

/// The smallest and the largest coordinates.
fn bounds(lines: impl Iterator<Item = [Vertex; 2]>) -> [GridPoint; 2] {
    let mut points = lines.flatten().map(|v| v.at);
    let first = points.next().unwrap_or_default();
    points.fold([first, first], |[lo, hi], p| {
        [
            GridPoint { x: lo.x.min(p.x), y: lo.y.min(p.y) },
            GridPoint { x: hi.x.max(p.x), y: hi.y.max(p.y) },
        ]
    })
}
