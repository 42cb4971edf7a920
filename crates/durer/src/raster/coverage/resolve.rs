//! Pixels that several chains of edges cross: their covered area, exactly.
//!
//! The integral of the winding number decides a pixel only where that number takes two neighbouring
//! values. Where it may take more — two contours overlap, a contour crosses itself — the pixel is cut
//! into slabs at every end and crossing of its edges, and the area is summed where the rule says
//! "inside". The winding number at the pixel's corner follows from the integral and need not be
//! carried along: it is the integer that makes the two agree.

use super::FillRule;
use super::cells::{BAND_ROWS, Marks};
use super::edge::{BITS, Edge, ONE};

/// Pixels crossed by more edges than this keep the integral's answer: what they show is noise, and
/// the cost grows with the third power.
const MAX_PIECES: usize = 24;

/// What one edge does within one row, relative to a pixel that it touches.
#[derive(Debug, Clone, Copy)]
struct Piece {
    /// Row of the band · 65,536 + column.
    pixel: u32,
    sign: i32,
    /// Upper and lower end, 16.16 pixels from the pixel's upper left corner; x may lie outside it.
    ends: [(i32, i32); 2],
}

/// A straight piece inside the pixel, from top to bottom, in pixels.
#[derive(Debug, Clone, Copy)]
struct Segment {
    x0: f64,
    y0: f64,
    x1: f64,
    y1: f64,
    sign: i32,
}

impl Segment {
    fn x_at(&self, y: f64) -> f64 {
        self.x0 + (self.x1 - self.x0) * ((y - self.y0) / (self.y1 - self.y0))
    }
}

/// The shared pixels of one band and what crosses them; the memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Resolver {
    pieces: Vec<Piece>,
    segments: Vec<Segment>,
    cuts: Vec<f64>,
    active: Vec<(f64, i32)>,
}

impl Resolver {
    /// Collects what the edges do in the shared pixels. `marks` gives the marks of a row of the band.
    pub fn gather<'a>(
        &mut self,
        edges: impl Iterator<Item = &'a Edge>,
        top: i32,
        rows: u64,
        marks: impl Fn(i32) -> &'a [Marks],
    ) {
        self.pieces.clear();
        for edge in edges {
            let (first, last) = edge.rows();
            let (first, last) = ((first - top).max(0), (last - top).min(BAND_ROWS));
            if first >= last {
                continue;
            }
            let mut left = rows & (u64::MAX << first) & (u64::MAX >> (64 - last));
            while left != 0 {
                let row = left.trailing_zeros() as i32;
                left &= left - 1;
                self.row(edge, top, row, marks(row));
            }
        }
        self.pieces.sort_unstable_by_key(|p| p.pixel);
    }

    /// The pieces of one edge in one row of the band.
    fn row(&mut self, edge: &Edge, top: i32, row: i32, marks: &[Marks]) {
        let border = (top + row) << BITS;
        let (upper, lower) = (edge.y0.max(border), edge.y1.min(border + ONE));
        let x_upper = if upper == edge.y0 { edge.x0 } else { x_at_border(edge, border) };
        let x_lower = if lower == edge.y1 { edge.x1 } else { x_at_border(edge, border + ONE) };
        let (first, last) = (x_upper.min(x_lower) >> BITS, x_upper.max(x_lower) >> BITS);
        let (first, last) = (first.max(0) as usize, last.max(0) as usize);
        for word in first >> 6..=last >> 6 {
            let mut bits = marks.get(word).map_or(0, |m| m.shared);
            if word == first >> 6 {
                bits &= u64::MAX << (first & 63);
            }
            if word == last >> 6 {
                bits &= u64::MAX >> (63 - (last & 63));
            }
            while bits != 0 {
                let column = word * 64 + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                let x = (column as i32) << BITS;
                self.pieces.push(Piece {
                    pixel: (row as u32) << 16 | column as u32,
                    sign: edge.sign(),
                    ends: [(x_upper - x, upper - border), (x_lower - x, lower - border)],
                });
            }
        }
    }

    /// The shared pixels of a row in order of their column: calls `set(column, coverage 0 … 255)` for
    /// those whose coverage is not what the integral says. `sum` gives the integral of a pixel.
    pub fn row_coverage(
        &mut self,
        row: i32,
        rule: FillRule,
        mut sum: impl FnMut(usize) -> i32,
        mut set: impl FnMut(usize, u8),
    ) {
        let start = self.pieces.partition_point(|p| p.pixel < (row as u32) << 16);
        let end = self.pieces.partition_point(|p| p.pixel < (row as u32 + 1) << 16);
        let mut at = start;
        while at < end {
            let pixel = self.pieces[at].pixel;
            let count = self.pieces[at..end].iter().take_while(|p| p.pixel == pixel).count();
            let column = (pixel & 0xffff) as usize;
            let total = sum(column);
            if count <= MAX_PIECES
                && let Some(area) = self.area(at, count, total, rule)
            {
                set(column, (area.clamp(0.0, 1.0) * 255.0 + 0.5) as u8);
            }
            at += count;
        }
    }

    /// The covered area of one pixel; `None` where the integral already tells.
    fn area(&mut self, at: usize, count: usize, sum: i32, rule: FillRule) -> Option<f64> {
        self.segments.clear();
        for piece in &self.pieces[at..at + count] {
            push_segments(piece, &mut self.segments);
        }
        let local: f64 = self
            .segments
            .iter()
            .map(|s| f64::from(s.sign) * (1.0 - (s.x0 + s.x1) / 2.0) * (s.y1 - s.y0))
            .sum();
        let base = (f64::from(sum) / f64::from(ONE) - local + 0.5).floor() as i32;
        // Bounds of the winding number: they often decide at once.
        let up = self.segments.iter().filter(|s| s.sign > 0).count() as i32;
        let down = self.segments.len() as i32 - up;
        if up + down < 2 {
            return None;
        }
        if rule == FillRule::NonZero && (base - down > 0 || base + up < 0) {
            return Some(1.0);
        }
        Some(self.slabs(base, rule))
    }

    fn slabs(&mut self, base: i32, rule: FillRule) -> f64 {
        let inside = |winding: i32| match rule {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding & 1 != 0,
        };
        cuts(&self.segments, &mut self.cuts);
        let mut area = 0.0;
        for pair in self.cuts.windows(2) {
            let (upper, lower) = (pair[0], pair[1]);
            if lower <= upper {
                continue;
            }
            let middle = (upper + lower) / 2.0;
            self.active.clear();
            let crossing = self.segments.iter().filter(|s| s.y0 <= middle && s.y1 > middle);
            self.active.extend(crossing.map(|s| (s.x_at(middle), s.sign)));
            self.active.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (mut x, mut winding, mut covered) = (0.0, base, 0.0);
            for (next, sign) in &self.active {
                if inside(winding) {
                    covered += next - x;
                }
                x = *next;
                winding += sign;
            }
            if inside(winding) {
                covered += 1.0 - x;
            }
            area += covered * (lower - upper);
        }
        area
    }
}

/// x where an edge crosses a border of rows between its ends, as the cells have it.
fn x_at_border(edge: &Edge, border: i32) -> i32 {
    let first = (edge.y0 + ONE - 1) >> BITS;
    let rows = i64::from((border >> BITS) - first);
    let x = (i64::from(edge.crossing) << BITS) + edge.slope.wrapping_mul(rows);
    ((x >> BITS) as i32).clamp(edge.x0.min(edge.x1), edge.x0.max(edge.x1))
}

/// The part of a piece inside the pixel, and what it means for the pixel's left border.
fn push_segments(piece: &Piece, out: &mut Vec<Segment>) {
    let unit = |v: i32| f64::from(v) / f64::from(ONE);
    let [upper, lower] = piece.ends;
    let (mut x0, mut y0) = (unit(upper.0), unit(upper.1));
    let (mut x1, mut y1) = (unit(lower.0), unit(lower.1));
    let sign = piece.sign;
    let y_at = |x: f64| y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
    let (left, right) = (y_at(0.0), y_at(1.0));
    // Crossing the left border changes the winding number along it from there on.
    let mut border = |y0: f64, y1: f64| {
        if y1 > y0 {
            out.push(Segment { x0: 0.0, y0, x1: 0.0, y1, sign });
        }
    };
    match (upper.0 < 0, lower.0 < 0) {
        (true, true) => return,
        (true, false) => {
            border(0.0, left);
            (x0, y0) = (0.0, left);
        }
        (false, true) => {
            border(left, 1.0);
            (x1, y1) = (0.0, left);
        }
        (false, false) => {}
    }
    match (upper.0 > ONE, lower.0 > ONE) {
        (true, true) => return,
        (true, false) => (x0, y0) = (1.0, right),
        (false, true) => (x1, y1) = (1.0, right),
        (false, false) => {}
    }
    if y1 > y0 {
        out.push(Segment { x0, y0, x1, y1, sign });
    }
}

/// The heights at which a segment ends or two of them cross, in order, from 0 to 1.
fn cuts(segments: &[Segment], cuts: &mut Vec<f64>) {
    cuts.clear();
    cuts.extend([0.0, 1.0]);
    for (i, a) in segments.iter().enumerate() {
        cuts.extend([a.y0, a.y1]);
        for b in &segments[..i] {
            let (upper, lower) = (a.y0.max(b.y0), a.y1.min(b.y1));
            if upper >= lower {
                continue;
            }
            let (d0, d1) = (a.x_at(upper) - b.x_at(upper), a.x_at(lower) - b.x_at(lower));
            if d0 * d1 < 0.0 {
                cuts.push(upper + (lower - upper) * (d0 / (d0 - d1)));
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
}
