//! The cells of the page that lines run through, each with a number for its list of faces.
//!
//! A uniform grid of about as many cells as there are faces. If the lines run through few of them, as for long thin
//! scenes or small objects far apart, the cells are smaller, and only those with lines are kept, so that the lists stay
//! short.

use super::super::page::{GridPoint, Vertex};
use std::ops::Range;

/// Side by side at most this many cells.
const MOST_ACROSS: f64 = 4096.0;

/// Limit on the number of smaller cells, few of which are kept.
const MOST_SMALL_ACROSS: f64 = 65_536.0;

/// Cells are made smaller where lines run through less than one in this many, and their lists have more entries than
/// this on average: round bodies with fine facets have some ten along their outlines.
const FEW: usize = 16;
const LONG: usize = 64;

/// Log₂ of the smallest cell's side in steps.
const LEAST_SHIFT: u32 = 4;

/// Steps beyond a cell that count as in it when the part of a line in the cell is determined: more than rounding
/// errors.
const MARGIN: f64 = 4.0;

/// The cells of the page.
#[derive(Debug, Clone, Copy)]
struct Cells {
    /// Log₂ of steps per cell.
    shift: u32,
    low: GridPoint,
    /// In steps.
    size: [i64; 2],
    columns: i32,
    rows: i32,
}

impl Cells {
    /// Creates about `count` square cells over the extent of the points.
    fn new(bounds: [GridPoint; 2], count: usize) -> Self {
        let [low, high] = bounds;
        let size = high.minus(low).map(|d| d.max(1));
        let [w, h] = size.map(|d| d as f64);
        let side = (w * h / count.max(1) as f64).sqrt().max(w.max(h) / MOST_ACROSS).max(16.0);
        // The next power of two that is not much larger than the side requested.
        Self::of_side(low, size, (libm::frexp(side).1 - 1).clamp(LEAST_SHIFT as i32, 30) as u32)
    }

    fn of_side(low: GridPoint, size: [i64; 2], shift: u32) -> Self {
        let [columns, rows] = size.map(|d| (d >> shift) as i32 + 1);
        Self { shift, low, size, columns, rows }
    }

    /// Returns cells of half the side.
    fn halved(&self) -> Self {
        Self::of_side(self.low, self.size, self.shift - 1)
    }

    fn can_be_halved(&self) -> bool {
        let across = f64::from(self.columns.max(self.rows)) * 2.0;
        self.shift > LEAST_SHIFT && across <= MOST_SMALL_ACROSS
    }

    /// Calls `f` with each row that a line runs through and the columns there, line by line.
    #[inline]
    fn each_of(
        &self,
        lines: impl Iterator<Item = [Vertex; 2]>,
        mut f: impl FnMut(i32, Range<i32>),
    ) {
        for [p, q] in lines {
            self.rows_of(&[p.at, q.at], |row, from, to| f(row, from..to + 1));
        }
    }

    /// Returns the rows and columns of the cells that lines run through, in order.
    fn run_through(&self, lines: impl Iterator<Item = [Vertex; 2]>) -> Vec<[i32; 2]> {
        let (mut found, mut most) = (Vec::new(), 1 << 16);
        let in_order = |found: &mut Vec<[i32; 2]>| {
            found.sort_unstable();
            found.dedup();
        };
        self.each_of(lines, |row, columns| {
            found.extend(columns.map(|column| [row, column]));
            // Many lines may run through the same cells.
            if found.len() > most {
                in_order(&mut found);
                most = most.max(2 * found.len());
            }
        });
        in_order(&mut found);
        found
    }

    /// Returns the stretch of a line as [`Lists::stretch`] does.
    fn stretch(&self, row: i64, column: i64, [p, q]: &[Vertex; 2]) -> [f64; 2] {
        let [dx, dy] = q.at.minus(p.at);
        let axis = |low: i32, cell: i64, from: i32, delta: i64| {
            if delta == 0 {
                return [0.0, 1.0];
            }
            let low = (i64::from(low) + (cell << self.shift) - i64::from(from)) as f64;
            let high = low + f64::from(1u32 << self.shift);
            let [a, b] = [low - MARGIN, high + MARGIN].map(|at| at / delta as f64);
            [a.min(b), a.max(b)]
        };
        let x = axis(self.low.x, column, p.at.x, dx);
        let y = axis(self.low.y, row, p.at.y, dy);
        [x[0].max(y[0]), x[1].min(y[1])]
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
    #[inline]
    fn rows_of(&self, points: &[GridPoint], mut f: impl FnMut(i32, i32, i32)) {
        let (mut lo, mut hi) = (points[0], points[0]);
        for p in points {
            lo = GridPoint { x: lo.x.min(p.x), y: lo.y.min(p.y) };
            hi = GridPoint { x: hi.x.max(p.x), y: hi.y.max(p.y) };
        }
        let [x0, x1] = [i64::from(lo.x) - 1, i64::from(hi.x) + 1].map(|x| self.column(x));
        let [y0, y1] = [i64::from(lo.y) - 1, i64::from(hi.y) + 1].map(|y| self.row(y));
        let all = x1 - x0 < 2 || y0 == y1;
        for row in y0..=y1 {
            if all {
                f(row, x0, x1);
            } else if let Some([from, to]) = self.columns_at(row, points) {
                f(row, from.max(x0), to.min(x1));
            }
        }
    }

    /// Returns the first and last column that the polygon of the points touches in a row.
    fn columns_at(&self, row: i32, points: &[GridPoint]) -> Option<[i32; 2]> {
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
        (from <= to).then(|| [from as i64 - 2, to as i64 + 2].map(|x| self.column(x)))
    }
}

/// The cells that lines run through, with a list each.
pub(super) struct Lists {
    cells: Cells,
    kept: Kept,
}

/// For which cells there are lists.
enum Kept {
    /// For all; in those where it says so lines run.
    All(Vec<bool>),
    /// For those of the columns that follow one another from a row's start to the next.
    Some { rows: Vec<u32>, columns: Vec<i32> },
}

impl Lists {
    /// Creates as many cells as there are faces, for the lines.
    pub fn new(faces: usize, lines: impl Iterator<Item = [Vertex; 2]> + Clone) -> Self {
        Self::all(Cells::new(bounds(lines.clone()), faces), lines)
    }

    /// Returns smaller cells, where lines run through few of these and their lists, of this many entries together, are
    /// long.
    pub fn finer(
        &self,
        (faces, entries): (usize, usize),
        lines: impl Iterator<Item = [Vertex; 2]> + Clone,
    ) -> Option<Self> {
        let Kept::All(marked) = &self.kept else { return None };
        let run_through = marked.iter().filter(|marked| **marked).count();
        let few = run_through.saturating_mul(FEW) < faces;
        let long = entries > run_through.saturating_mul(LONG);
        (few && long).then(|| Self::small(self.cells, faces, lines))
    }

    fn all(cells: Cells, lines: impl Iterator<Item = [Vertex; 2]>) -> Self {
        let mut marked = vec![false; cells.count()];
        cells.each_of(lines, |row, columns| {
            let start = row as usize * cells.columns as usize;
            marked[start + columns.start as usize..start + columns.end as usize].fill(true);
        });
        Self { cells, kept: Kept::All(marked) }
    }

    /// Returns cells of at least twice the side, all of them kept.
    pub fn coarser(&self, lines: impl Iterator<Item = [Vertex; 2]>) -> Self {
        let Cells { low, size, shift, .. } = self.cells;
        let mut cells = Cells::of_side(low, size, shift + 1);
        while cells.count() > self.count().max(64) {
            cells = Cells::of_side(low, size, cells.shift + 1);
        }
        Self::all(cells, lines)
    }

    /// Returns whether there is but one cell.
    pub fn is_one(&self) -> bool {
        self.cells.count() == 1
    }

    /// Creates smaller and smaller cells, as long as lines run through fewer than there are faces.
    fn small(
        mut cells: Cells,
        faces: usize,
        lines: impl Iterator<Item = [Vertex; 2]> + Clone,
    ) -> Self {
        let mut places = cells.run_through(lines.clone());
        while places.len() * 2 <= faces && cells.can_be_halved() {
            cells = cells.halved();
            places = cells.run_through(lines.clone());
        }
        let mut rows = vec![0u32; cells.rows as usize + 1];
        places.iter().for_each(|[row, _]| rows[*row as usize + 1] += 1);
        (1..rows.len()).for_each(|row| rows[row] += rows[row - 1]);
        let columns = places.into_iter().map(|[_, column]| column).collect();
        Self { cells, kept: Kept::Some { rows, columns } }
    }

    /// Returns the number of lists.
    pub fn count(&self) -> usize {
        match &self.kept {
            Kept::All(marked) => marked.len(),
            Kept::Some { columns, .. } => columns.len(),
        }
    }

    /// Returns whether lines run through the cell of a list.
    pub fn is_marked(&self, list: usize) -> bool {
        match &self.kept {
            Kept::All(marked) => marked[list],
            Kept::Some { .. } => true,
        }
    }

    /// Calls `f` with each row that the polygon of the points touches and the lists of its cells there.
    #[inline]
    pub fn each_of(&self, points: &[GridPoint], mut f: impl FnMut(i32, Range<usize>)) {
        self.cells.rows_of(points, |row, from, to| match &self.kept {
            Kept::All(_) => {
                let start = row as usize * self.cells.columns as usize;
                f(row, start + from as usize..start + to as usize + 1);
            }
            Kept::Some { rows, columns } => {
                let [start, end] = [row, row + 1].map(|row| rows[row as usize] as usize);
                let of_row = &columns[start..end];
                let place = |least: i32| start + of_row.partition_point(|column| *column < least);
                f(row, place(from)..place(to + 1));
            }
        });
    }

    /// Returns the range of a line, within 0 … 1, in which it may be in the cell of a list of that row.
    pub fn stretch(&self, row: i32, list: usize, line: &[Vertex; 2]) -> [f64; 2] {
        let column = match &self.kept {
            Kept::All(_) => list as i64 - i64::from(row) * i64::from(self.cells.columns),
            Kept::Some { columns, .. } => columns[list].into(),
        };
        self.cells.stretch(row.into(), column, line)
    }
}

/// Returns the smallest and the largest coordinates.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn line([x0, y0, x1, y1]: [i32; 4]) -> [Vertex; 2] {
        [[x0, y0], [x1, y1]].map(|[x, y]| Vertex { at: GridPoint { x, y }, depth: 0.0 })
    }

    #[test]
    fn lists_stay_short_where_lines_run_through_little_of_the_page() {
        let count = 10_000;
        let step = 1 << 12;
        let lines = (0..count).map(|i| line([i * step, i * step, i * step + step, i * step]));
        let coarse = Lists::new(count as usize, lines.clone());
        assert!(coarse.finer((count as usize, 0), lines.clone()).is_none());
        let finer = coarse.finer((count as usize, 1 << 30), lines.clone());
        let lists = finer.expect("lines run through the diagonal only");
        assert!(lists.count() > count as usize / 2 && lists.count() < 8 * count as usize);
        let mut longest = 0;
        let mut of_list = vec![0; lists.count()];
        for line in lines {
            let mut met = 0;
            lists.each_of(&line.map(|v| v.at), |row, cells| {
                for cell in cells {
                    of_list[cell] += 1;
                    met += 1;
                    let [from, to] = lists.stretch(row, cell, &line);
                    assert!(from <= 1.0 && to >= -0.1, "{from} {to}");
                }
            });
            longest = longest.max(met);
        }
        assert!(of_list.iter().all(|lines| *lines > 0));
        assert!(of_list.iter().max() <= Some(&8) && longest <= 8);
    }

    #[test]
    fn stretches_of_a_line_follow_one_another() {
        let line = line([100, 7, 90_000, 60_000]);
        let lists = Lists::new(64, [line].into_iter());
        let mut all = Vec::new();
        lists.each_of(&line.map(|v| v.at), |row, cells| {
            all.extend(cells.map(|cell| lists.stretch(row, cell, &line)).filter(|[a, b]| a <= b));
        });
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert!(all[0][0] <= 0.0 && all.iter().any(|[_, to]| *to >= 1.0));
        assert!(all.windows(2).all(|w| w[1][0] <= w[0][1]), "{all:?}");
    }
}
