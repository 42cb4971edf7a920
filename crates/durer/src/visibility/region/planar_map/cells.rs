//! The picture in cells, each with the faces over it from front to back, up to the first that covers the whole cell: so
//! each query examines only nearby faces, and none behind a face that hides everything (after Warnock 1969).

use super::faces::{CLEARLY, Face, Place, float};
use crate::math::DVec2;

/// Faces per cell, if they were spread evenly.
const PER_CELL: f64 = 1.0;

/// Cells along a side, at most.
const MOST: f64 = 2048.0;

/// Grid of cells over the picture, each with its faces from front to back.
#[derive(Debug)]
pub struct Cells {
    /// Lower left corner of the grid of cells.
    min: Place,
    /// Cells are 2^shift grid steps wide and high.
    shift: u32,
    columns: usize,
    rows: usize,
    /// The faces of cell i are `items[starts[i]..starts[i + 1]]`, by their nearest depth.
    starts: Vec<u32>,
    items: Vec<u32>,
    /// Everything in a cell behind this depth is hidden.
    covers: Vec<f64>,
}

/// One cell: its column and row.
pub type Cell = (usize, usize);

impl Cells {
    /// Distributes the faces, which must be sorted by `near`.
    pub fn new(faces: &[Face]) -> Self {
        let Some((min, max)) = bounds(faces) else { return Self::empty() };
        let size = |a: i32, b: i32| (i64::from(b) - i64::from(a) + 1) as f64;
        let (width, height) = (size(min.x, max.x), size(min.y, max.y));
        let side = (width * height / (faces.len() as f64 / PER_CELL)).sqrt();
        let side = side.max(width.max(height) / MOST);
        let shift = (side.max(8.0) as u64).ilog2();
        let count = |a: i32, b: i32| ((i64::from(b) - i64::from(a)) >> shift) as usize + 1;
        let (columns, rows) = (count(min.x, max.x), count(min.y, max.y));
        let covers = vec![f64::INFINITY; columns * rows];
        let mut cells =
            Self { min, shift, columns, rows, starts: Vec::new(), items: Vec::new(), covers };
        cells.fill(faces);
        cells
    }

    fn empty() -> Self {
        Self {
            min: Place::default(),
            shift: 0,
            columns: 0,
            rows: 0,
            starts: vec![0],
            items: Vec::new(),
            covers: Vec::new(),
        }
    }

    fn fill(&mut self, faces: &[Face]) {
        let mut entries: Vec<(u32, u32)> = Vec::with_capacity(faces.len() * 3);
        for (face, i) in faces.iter().zip(0..) {
            let (min, max) = face.bounds();
            let ((c0, r0), (c1, r1)) = (self.cell(min), self.cell(max));
            let alone = (c0, r0) == (c1, r1);
            for row in r0..=r1 {
                for column in c0..=c1 {
                    let cell = row * self.columns + column;
                    let over = if alone { Over::Part } else { self.over(face, column, row) };
                    if over == Over::Nothing {
                        continue;
                    }
                    let (near, far) = self.depths(face, column, row);
                    if near > self.covers[cell] {
                        continue;
                    }
                    if over == Over::All {
                        self.covers[cell] = self.covers[cell].min(far + CLEARLY * face.error);
                    }
                    entries.push((cell as u32, i));
                }
            }
        }
        let mut starts = vec![0u32; self.covers.len() + 2];
        for (cell, _) in &entries {
            starts[*cell as usize + 2] += 1;
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        self.items = vec![0; entries.len()];
        for (cell, i) in entries {
            let next = &mut starts[cell as usize + 1];
            self.items[*next as usize] = i;
            *next += 1;
        }
        starts.pop();
        self.starts = starts;
    }

    /// Returns the nearest and the farthest depth that a face has over a cell, its error taken off.
    fn depths(&self, face: &Face, column: usize, row: usize) -> (f64, f64) {
        let (min, size) = (self.corner(column, row), (1u64 << self.shift) as f64);
        let slope = face.plane.slope * size;
        let at = face.plane.depth(min);
        let (near, far) =
            (at + slope.min(DVec2::ZERO).element_sum(), at + slope.max(DVec2::ZERO).element_sum());
        (near.max(face.near) - face.error, far.min(face.far))
    }

    fn corner(&self, column: usize, row: usize) -> DVec2 {
        float(self.min) + DVec2::new((column << self.shift) as f64, (row << self.shift) as f64)
    }

    /// Returns how much of a closed cell a face covers; exact.
    fn over(&self, face: &Face, column: usize, row: usize) -> Over {
        let size = 1i64 << self.shift;
        let x = i64::from(self.min.x) + ((column as i64) << self.shift);
        let y = i64::from(self.min.y) + ((row as i64) << self.shift);
        let mut all = true;
        for (a, b) in face.sides() {
            let (dx, dy) = (i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y));
            let low = dx * (y - i64::from(a.y)) - dy * (x - i64::from(a.x));
            let (right, up) = (-dy * size, dx * size);
            if low + right.max(0) + up.max(0) < 0 {
                return Over::Nothing;
            }
            all &= low + right.min(0) + up.min(0) >= 0;
        }
        if all { Over::All } else { Over::Part }
    }

    /// Returns the cell of a grid point.
    pub fn cell(&self, p: Place) -> Cell {
        let index = |v: i32, min: i32, count: usize| {
            let offset = (i64::from(v) - i64::from(min)).max(0) >> self.shift;
            (offset as usize).min(count.saturating_sub(1))
        };
        (index(p.x, self.min.x, self.columns), index(p.y, self.min.y, self.rows))
    }

    /// Returns all cells' numbers.
    pub fn count(&self) -> usize {
        self.covers.len()
    }

    /// Returns the faces over a cell, front to back.
    pub fn items(&self, cell: usize) -> &[u32] {
        &self.items[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Returns the depth behind which all is hidden in a cell.
    pub fn cover(&self, cell: usize) -> f64 {
        self.covers[cell]
    }

    /// Calls `f` with each cell that a segment passes, and from where to where, as parts of its length.
    pub fn walk(&self, a: DVec2, b: DVec2, mut f: impl FnMut(usize, f64, f64)) {
        if self.covers.is_empty() {
            return;
        }
        let size = (1u64 << self.shift) as f64;
        let (p, q) = ((a - float(self.min)) / size, (b - float(self.min)) / size);
        let last = [self.columns as i64 - 1, self.rows as i64 - 1];
        let index = |v: f64, k: usize| (v.floor() as i64).clamp(0, last[k]);
        let mut cell = [index(p.x, 0), index(p.y, 1)];
        let end = [index(q.x, 0), index(q.y, 1)];
        let d = q - p;
        // When a border between columns or rows is met next; borders beyond the end are never met.
        let meet = |cell: &[i64; 2], k: usize| {
            let border = if d[k] > 0.0 { cell[k] + 1 } else { cell[k] };
            if cell[k] == end[k] {
                f64::INFINITY
            } else {
                ((border as f64 - p[k]) / d[k]).clamp(0.0, 1.0)
            }
        };
        let mut t = 0.0;
        loop {
            let next = [meet(&cell, 0), meet(&cell, 1)];
            let k = usize::from(next[1] < next[0]);
            let until = next[k].min(1.0).max(t);
            f(cell[1] as usize * self.columns + cell[0] as usize, t, until);
            if next[k] == f64::INFINITY {
                return;
            }
            cell[k] += if d[k] > 0.0 { 1 } else { -1 };
            t = until;
        }
    }

    /// Returns the face that is visible at a point: the nearest, and of equally near ones the one with the lowest item.
    pub fn nearest(&self, faces: &[Face], p: DVec2) -> Option<u32> {
        let cell = self.at(p)?;
        let mut best: Option<(f64, f64, u32)> = None;
        for &i in self.items(cell) {
            let face = &faces[i as usize];
            if best.is_some_and(|(depth, error, _)| face.near > depth + error + face.error) {
                break;
            }
            if !face.covers(p) {
                continue;
            }
            let depth = face.depth(p);
            best = Some(match best {
                None => (depth, face.error, i),
                Some(old @ (before, error, chosen)) => {
                    let tolerance = error + face.error;
                    if depth < before - tolerance {
                        (depth, face.error, i)
                    } else if depth <= before + tolerance && face.item < faces[chosen as usize].item
                    {
                        (depth.min(before), face.error, i)
                    } else {
                        old
                    }
                }
            });
        }
        best.map(|(_, _, i)| i)
    }

    /// Returns the number of the cell that holds a point.
    pub fn at(&self, p: DVec2) -> Option<usize> {
        if self.covers.is_empty() {
            return None;
        }
        let (column, row) = self.cell(super::faces::nearest(p));
        Some(row * self.columns + column)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Over {
    Nothing,
    Part,
    All,
}

fn bounds(faces: &[Face]) -> Option<(Place, Place)> {
    let mut boxes = faces.iter().map(Face::bounds);
    let first = boxes.next()?;
    Some(boxes.fold(first, |(lo, hi), (min, max)| {
        let lo = Place { x: lo.x.min(min.x), y: lo.y.min(min.y) };
        (lo, Place { x: hi.x.max(max.x), y: hi.y.max(max.y) })
    }))
}
