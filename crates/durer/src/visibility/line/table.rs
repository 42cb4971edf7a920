//! Pieces of lines by place: a uniform grid.

use super::page::GridPoint;
use super::piece::Piece;

/// A uniform grid of lists of pieces.
pub(super) struct Table {
    low: GridPoint,
    shift: u32,
    columns: usize,
    rows: usize,
    /// Head of each cell's chain, + 1.
    heads: Vec<u32>,
    /// (piece, next + 1).
    links: Vec<(u32, u32)>,
    scratch: Vec<u32>,
}

impl Table {
    /// `None` where there are no pieces. `close` is the largest margin of entries and questions.
    pub fn new(pieces: &[Piece], close: f64) -> Option<Self> {
        let mut points = pieces.iter().flat_map(|p| p.ends);
        let first = points.next()?;
        let (low, high) = points.fold((first, first), |(lo, hi), p| {
            (
                GridPoint { x: lo.x.min(p.x), y: lo.y.min(p.y) },
                GridPoint { x: hi.x.max(p.x), y: hi.y.max(p.y) },
            )
        });
        let [w, h] = high.minus(low).map(|d| d.max(1) as f64);
        let side = (w * h / pieces.len() as f64).sqrt().max(w.max(h) / 2048.0).max(4.0 * close);
        let shift = libm::frexp(side.max(16.0)).1.clamp(4, 30) as u32;
        let cells = |d: f64| (d as i64 >> shift) as usize + 1;
        let (columns, rows) = (cells(w), cells(h));
        Some(Self {
            low,
            shift,
            columns,
            rows,
            heads: vec![0; columns * rows],
            links: Vec::with_capacity(pieces.len() * 2),
            scratch: Vec::new(),
        })
    }

    /// The cells within `close` of a segment.
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
                f(row * self.columns + column);
            }
        }
    }

    /// Calls `f` with the pieces that are near a segment, some several times.
    pub fn cells(&mut self, ends: &[GridPoint; 2], close: f64, mut f: impl FnMut(&[u32])) {
        let mut found = std::mem::take(&mut self.scratch);
        found.clear();
        self.each(ends, close, |cell| {
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
        self.each(&ends, close, |cell| found.push(cell as u32));
        for &cell in &found {
            self.links.push((piece, self.heads[cell as usize]));
            self.heads[cell as usize] = self.links.len() as u32;
        }
        self.scratch = found;
    }
}
