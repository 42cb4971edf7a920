//! Lines that lie on each other are drawn once.
//!
//! Pieces are taken in the order of preference (visible before hidden, then by class); what an earlier
//! one covers is cut from a later one. Candidates come from a uniform grid; O(n) for lines that do
//! not crowd.

use super::page::GridPoint;
use crate::target::drawing::LineClass;

/// A straight piece on the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub ends: [GridPoint; 2],
    pub class: LineClass,
    pub invisibility: u32,
}

impl Piece {
    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }
}

/// Two lines that diverge more than this lie beside each other, however close: they are the two
/// sides of a corner.
const PARALLEL: f64 = 0.02;

/// What is left of the pieces where none lies within `close` steps of another along its length;
/// pieces not longer than `sliver` that a cut leaves are dropped.
pub(super) fn drawn_once(mut pieces: Vec<Piece>, close: f64, sliver: f64) -> Vec<Piece> {
    pieces.retain(|p| p.ends[0] != p.ends[1]);
    pieces.sort_by_key(|p| (p.invisibility, p.class));
    let Some(table) = Table::new(&pieces, close) else { return pieces };
    let mut table = table;
    let mut kept: Vec<Piece> = Vec::with_capacity(pieces.len());
    let mut near: Vec<u32> = Vec::new();
    let mut gone: Vec<(f64, f64)> = Vec::new();
    for piece in pieces {
        near.clear();
        table.cells(&piece.ends, close, |list| near.extend_from_slice(list));
        near.sort_unstable();
        near.dedup();
        gone.clear();
        gone.extend(near.iter().filter_map(|&i| overlap(&piece, &kept[i as usize], close)));
        let first = kept.len();
        if gone.is_empty() {
            kept.push(piece);
        } else {
            gone.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            rest(&piece, &gone, sliver, &mut kept);
        }
        for (i, piece) in kept.iter().enumerate().skip(first) {
            table.enter(piece.ends, close, i as u32);
        }
    }
    kept
}

/// Which part of `piece`, in steps from its first end, lies on `other`.
fn overlap(piece: &Piece, other: &Piece, close: f64) -> Option<(f64, f64)> {
    let length = piece.length();
    let [ux, uy] = piece.ends[1].minus(piece.ends[0]).map(|d| d as f64 / length);
    let ends = other.ends.map(|e| {
        let [x, y] = e.minus(piece.ends[0]).map(|d| d as f64);
        (ux * x + uy * y, ux * y - uy * x)
    });
    let [a, b] = if ends[0].0 <= ends[1].0 { ends } else { [ends[1], ends[0]] };
    let (from, to) = (a.0.max(0.0), b.0.min(length));
    if to - from <= 1.0 {
        return None;
    }
    let aside = |s: f64| (a.1 + (b.1 - a.1) * ((s - a.0) / (b.0 - a.0))).abs();
    let near = close.min(2.0 + PARALLEL * (to - from));
    (aside(from) <= near && aside(to) <= near).then_some((from, to))
}

/// What the sorted parts leave of a piece.
fn rest(piece: &Piece, gone: &[(f64, f64)], sliver: f64, kept: &mut Vec<Piece>) {
    let length = piece.length();
    let at = |s: f64| {
        let [dx, dy] = piece.ends[1].minus(piece.ends[0]).map(|d| d as f64 * (s / length));
        let [x, y] = [dx.round() as i32, dy.round() as i32];
        GridPoint { x: piece.ends[0].x + x, y: piece.ends[0].y + y }
    };
    let mut keep = |from: f64, to: f64| {
        let start = if from <= 0.0 { piece.ends[0] } else { at(from) };
        let end = if to >= length { piece.ends[1] } else { at(to) };
        if to - from > sliver && start != end {
            kept.push(Piece { ends: [start, end], ..*piece });
        }
    };
    let mut done = 0.0_f64;
    for &(from, to) in gone {
        keep(done, from);
        done = done.max(to);
    }
    keep(done, length);
}

/// A uniform grid of lists of pieces.
struct Table {
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
    fn new(pieces: &[Piece], close: f64) -> Option<Self> {
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

    fn cells(&mut self, ends: &[GridPoint; 2], close: f64, mut f: impl FnMut(&[u32])) {
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

    fn enter(&mut self, ends: [GridPoint; 2], close: f64, piece: u32) {
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
