//! Pieces of lines by position: a uniform grid. If the pieces are in few of its cells, as in a long row, cells are
//! smaller and share lists by a hash of their number.

use super::page::GridPoint;
use super::piece::Piece;

/// Cells are made smaller if there are more than this many pieces for each one in which a piece
/// begins.
const CROWD: usize = 8;

/// Side by side at most this many smaller cells.
const MOST_SMALL_ACROSS: f64 = 16_384.0;

/// A uniform grid of lists of pieces.
pub(super) struct Table {
    cells: Cells,
    /// Head of each cell's chain, + 1.
    heads: Vec<u32>,
    /// (piece, next + 1).
    links: Vec<(u32, u32)>,
    scratch: Vec<u32>,
}

/// The cells of a table.
#[derive(Debug, Clone, Copy)]
struct Cells {
    low: GridPoint,
    /// Log₂ of steps per cell.
    shift: u32,
    columns: usize,
    rows: usize,
    /// Number of lists: one for each cell, or a power of two.
    lists: usize,
}

impl Cells {
    /// Creates cells over a size in steps, for this many pieces.
    fn new(low: GridPoint, size: [i64; 2], shift: u32, pieces: usize) -> Self {
        let [columns, rows] = size.map(|d| (d >> shift) as usize + 1);
        let all = columns * rows;
        let most = 4 * pieces + 4096;
        let lists = if all <= most { all } else { most.next_power_of_two() };
        Self { low, shift, columns, rows, lists }
    }

    /// Returns the list of a cell.
    #[inline(always)]
    fn list_of(&self, row: usize, column: usize) -> usize {
        let cell = row * self.columns + column;
        if self.lists == self.columns * self.rows {
            return cell;
        }
        // The golden ratio's bits: neighbours come far from each other.
        let spread = (cell as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (spread >> 32) as usize & (self.lists - 1)
    }

    /// Returns whether pieces are many beside the cells in which they begin, and smaller cells would not cut them much.
    fn are_crowded(&self, pieces: &[Piece]) -> bool {
        let mut begun = vec![false; self.lists];
        let (mut count, mut length) = (0_usize, 0_i64);
        for piece in pieces {
            let [a, b] = piece.ends;
            self.each(&[a, a], 0.0, |list| {
                count += usize::from(!std::mem::replace(&mut begun[list], true));
            });
            length += b.minus(a).map(i64::abs).iter().max().unwrap_or(&0) >> self.shift;
        }
        count.saturating_mul(CROWD) < pieces.len() && length < 2 * pieces.len() as i64
    }

    /// Calls `f` with the lists of the cells within `close` of a segment.
    fn each(&self, ends: &[GridPoint; 2], close: f64, mut f: impl FnMut(usize)) {
        let margin = close as i64 + 2;
        let cell = |v: i64, low: i32, count: usize| {
            ((v - i64::from(low)) >> self.shift).clamp(0, count as i64 - 1) as usize
        };
        let [a, b] = if ends[0].y <= ends[1].y { *ends } else { [ends[1], ends[0]] };
        let (ay, by) = (i64::from(a.y), i64::from(b.y));
        let rows =
            cell(ay - margin, self.low.y, self.rows)..=cell(by + margin, self.low.y, self.rows);
        for row in rows {
            let bottom = i64::from(self.low.y) + ((row as i64) << self.shift) - margin;
            let top = bottom + (1i64 << self.shift) + 2 * margin;
            let x_at = |y: i64| {
                let y = y.clamp(ay, by);
                let t = if by > ay {
                    (y - ay) as f64 / (by - ay) as f64
                } else {
                    f64::from(u8::from(y > ay))
                };
                f64::from(a.x) + t * (f64::from(b.x) - f64::from(a.x))
            };
            let (mut from, mut to) =
                if ay == by { (f64::from(a.x), f64::from(b.x)) } else { (x_at(bottom), x_at(top)) };
            if from > to {
                std::mem::swap(&mut from, &mut to);
            }
            let columns = cell(from as i64 - margin, self.low.x, self.columns)
                ..=cell(to as i64 + margin, self.low.x, self.columns);
            for column in columns {
                f(self.list_of(row, column));
            }
        }
    }
}

/// Returns log₂ of the side of cells that are not smaller than this.
fn shift_of(side: f64) -> u32 {
    libm::frexp(side.max(16.0)).1.clamp(4, 30) as u32
}

impl Table {
    /// Creates the table of the pieces; returns `None` if there are none. `close` is the largest margin of entries and
    /// queries.
    pub fn new(pieces: &[Piece], close: f64) -> Option<Self> {
        let mut points = pieces.iter().flat_map(|p| p.ends);
        let first = points.next()?;
        let (low, high) = points.fold((first, first), |(lo, hi), p| {
            (
                GridPoint { x: lo.x.min(p.x), y: lo.y.min(p.y) },
                GridPoint { x: hi.x.max(p.x), y: hi.y.max(p.y) },
            )
        });
        let size = high.minus(low).map(|d| d.max(1));
        let [w, h] = size.map(|d| d as f64);
        let side = (w * h / pieces.len() as f64).sqrt().max(w.max(h) / 2048.0).max(4.0 * close);
        let least = shift_of((4.0 * close).max(w.max(h) / MOST_SMALL_ACROSS));
        let mut cells = Cells::new(low, size, shift_of(side), pieces.len());
        while cells.shift > least && cells.are_crowded(pieces) {
            cells = Cells::new(low, size, cells.shift - 1, pieces.len());
        }
        Some(Self {
            cells,
            heads: vec![0; cells.lists],
            links: Vec::with_capacity(pieces.len() * 2),
            scratch: Vec::new(),
        })
    }

    /// Calls `f` with the pieces that are near a segment, some several times.
    pub fn cells(&mut self, ends: &[GridPoint; 2], close: f64, mut f: impl FnMut(&[u32])) {
        let mut found = std::mem::take(&mut self.scratch);
        found.clear();
        self.cells.each(ends, close, |cell| {
            let mut next = self.heads[cell];
            while let Some(link) = next.checked_sub(1) {
                let (piece, after) = self.links[link as usize];
                found.push(piece);
                next = after;
            }
        });
        f(&found);
        self.scratch = found;
    }

    /// Enters a piece.
    pub fn enter(&mut self, ends: [GridPoint; 2], close: f64, piece: u32) {
        let mut found = std::mem::take(&mut self.scratch);
        found.clear();
        self.cells.each(&ends, close, |cell| found.push(cell as u32));
        for &cell in &found {
            self.links.push((piece, self.heads[cell as usize]));
            self.heads[cell as usize] = self.links.len() as u32;
        }
        self.scratch = found;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::drawing::LineClass;

    fn piece(i: i32) -> Piece {
        let at = |k: i32| GridPoint { x: 1000 * k, y: 1000 * k + 7 };
        let (ends, class) = ([at(i), at(i + 1)], LineClass::Border);
        Piece { ends, class, invisibility: 0, smooth: false }
    }

    #[test]
    fn a_long_row_has_short_lists() {
        let pieces: Vec<Piece> = (0..4000).map(piece).collect();
        let mut table = Table::new(&pieces, 2.0).unwrap();
        (0..).zip(&pieces).for_each(|(i, piece)| table.enter(piece.ends, 2.0, i));
        let mut most = 0;
        for (i, piece) in (0..).zip(&pieces) {
            table.cells(&piece.ends, 2.0, |near| {
                assert!(near.contains(&i), "{i}");
                most = most.max(near.len());
            });
        }
        assert!(most < 100, "{most}");
    }
}
