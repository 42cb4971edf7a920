//! Pixels that several chains of edges cross: their covered area, exactly.
//!
//! The integral of the winding number decides a pixel only if that number takes just two neighbouring values in it.
//! Where it may take more, because contours overlap or a contour crosses itself, the pixel is cut into slabs at every
//! end and crossing of its edges, and the area is summed where the rule says "inside". The winding number at the
//! pixel's corner follows from the integral and need not be carried along: it is the integer that makes the two agree.

use super::FillRule;
use super::cells::{Cells, Marks};
use super::edge::{BITS, Edge, ONE};
use crate::raster::bands::BAND_ROWS;

/// Pixels crossed by more pieces than this are not cut into slabs, for which the cost grows with the third power, but
/// measured along lines.
const ALL: Limits = Limits { exact: 24, measured: u32::MAX, measures: 6144, lines: (16, 256) };
/// The same in noise that is to be measured.
const IN_NOISE: Limits = Limits { exact: 4, measured: 32, measures: 512, lines: (16, 64) };
/// Number of edges up to which a band is always resolved: that is quick, and small drawings get every pixel examined.
const FEW_EDGES: u32 = 256;
/// Number of shared pixels, two in a row on average, above which another band's content counts as noise as
/// well,
const FEW_SHARED: u32 = 2 * BAND_ROWS as u32;
/// more than one in this many of the touched ones,
const OFTEN: u32 = 5;
/// and so few of them for each edge that they do not come from long edges side by side.
const PER_EDGE: u32 = 4;
/// Number of edges in a band above which their lengths are not considered.
const MANY_EDGES: u32 = 1024;
/// End of a list.
const NONE: u32 = u32::MAX;

/// Limits of resolving pixels.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Largest number of pieces for the exact area,
    exact: usize,
    /// and for measuring along lines; pixels with more keep the integral's value.
    measured: u32,
    /// Number of measures for all pieces together,
    measures: usize,
    /// and the smallest and largest number of lines.
    lines: (usize, usize),
}

impl Default for Limits {
    fn default() -> Self {
        ALL
    }
}

/// Part of one edge within one row, relative to a pixel that it touches.
#[derive(Debug, Clone, Copy)]
struct Piece {
    sign: i32,
    /// Upper and lower end, 16.16 pixels from the pixel's upper left corner; x may be outside it.
    ends: [(i32, i32); 2],
    /// The pixel's next piece.
    next: u32,
}

/// A shared pixel: its last piece, and how many it has.
#[derive(Debug, Clone, Copy)]
struct Shared {
    piece: u32,
    count: u32,
}

/// A straight piece inside the pixel, from top to bottom, in pixels.
#[derive(Debug, Clone, Copy)]
struct Segment {
    x0: f64,
    y0: f64,
    y1: f64,
    /// Change of x per y.
    slope: f64,
    sign: i32,
}

impl Segment {
    fn new(x0: f64, y0: f64, x1: f64, y1: f64, sign: i32) -> Self {
        Self { x0, y0, y1, slope: (x1 - x0) / (y1 - y0), sign }
    }

    fn x_at(&self, y: f64) -> f64 {
        self.x0 + self.slope * (y - self.y0)
    }
}

/// The shared pixels of one band and the pieces of edges that cross them; the memory is reused.
#[derive(Debug, Default)]
pub(crate) struct Resolver {
    /// The number of the first shared pixel of each word of marks, row by row.
    ranks: Vec<u32>,
    /// Words per row.
    words: usize,
    pixels: Vec<Shared>,
    pieces: Vec<Piece>,
    segments: Vec<Segment>,
    cuts: Vec<f64>,
    active: Vec<(f64, i32)>,
    limits: Limits,
}

/// Bands that are resolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Noise {
    /// All.
    Resolved,
    /// All bands, those with noise only roughly.
    Measured {
        /// Edges of the band.
        edges: u32,
    },
    /// All bands except those with noise.
    Left {
        /// Edges of the band.
        edges: u32,
    },
}

impl Resolver {
    /// Numbers the shared pixels of a band; returns a bit for each row that has some, or 0 for noise that is not
    /// resolved.
    pub fn begin(&mut self, cells: &Cells, rows: (i32, i32), noise: Noise) -> u64 {
        self.words = cells.marks_of(0).len();
        self.ranks.clear();
        self.ranks.resize(rows.0.max(0) as usize * self.words, 0);
        let (mut shared, mut touched, mut found) = (0, 0, 0);
        for row in rows.0..rows.1 {
            for mark in cells.marks_of(row) {
                self.ranks.push(shared);
                shared += mark.shared.count_ones();
                touched += mark.touched.count_ones();
                found |= u64::from(mark.shared != 0) << row;
            }
        }
        let is_noise = |edges: u32| {
            edges > FEW_EDGES
                && shared > FEW_SHARED
                && shared > touched / OFTEN
                && (edges > MANY_EDGES || shared < edges.saturating_mul(PER_EDGE))
        };
        self.limits = ALL;
        match noise {
            Noise::Left { edges } if is_noise(edges) => return 0,
            Noise::Measured { edges } if is_noise(edges) => self.limits = IN_NOISE,
            _ => {}
        }
        self.pieces.clear();
        self.pixels.clear();
        self.pixels.resize(shared as usize, Shared { piece: NONE, count: 0 });
        found
    }

    /// Records the effect of an edge in the shared pixels of the given rows.
    pub fn add<'a>(
        &mut self,
        edge: &Edge,
        top: i32,
        rows: u64,
        marks: impl Fn(i32) -> &'a [Marks],
    ) {
        let (first, last) = edge.rows();
        let (first, last) = ((first - top).max(0), (last - top).min(BAND_ROWS));
        if first >= last {
            return;
        }
        let mut left = rows & (u64::MAX << first) & (u64::MAX >> (64 - last));
        if left == 0 {
            return;
        }
        let steps = edge.steps();
        let first_border = (edge.y0 + ONE - 1) >> BITS;
        let x_at = |border: i32| {
            let x = (steps.at((border >> BITS) - first_border) >> BITS) as i32;
            x.clamp(edge.x0.min(edge.x1), edge.x0.max(edge.x1))
        };
        while left != 0 {
            let row = left.trailing_zeros() as i32;
            left &= left - 1;
            let border = (top + row) << BITS;
            let (upper, lower) = (edge.y0.max(border), edge.y1.min(border + ONE));
            let x_upper = if upper == edge.y0 { edge.x0 } else { x_at(border) };
            let x_lower = if lower == edge.y1 { edge.x1 } else { x_at(border + ONE) };
            let ends = [(x_upper, upper - border), (x_lower, lower - border)];
            self.row(row, marks(row), ends, edge.sign());
        }
    }

    /// Collects the pieces of an edge in one row of the band, between its ends.
    fn row(&mut self, row: i32, marks: &[Marks], ends: [(i32, i32); 2], sign: i32) {
        let (x_upper, x_lower) = (ends[0].0, ends[1].0);
        let (first, last) = (x_upper.min(x_lower) >> BITS, x_upper.max(x_lower) >> BITS);
        let (first, last) = (first.max(0) as usize, last.max(0) as usize);
        for word in first >> 6..=last >> 6 {
            let shared = marks.get(word).map_or(0, |m| m.shared);
            let mut bits = shared;
            if word == first >> 6 {
                bits &= u64::MAX << (first & 63);
            }
            if word == last >> 6 {
                bits &= u64::MAX >> (63 - (last & 63));
            }
            while bits != 0 {
                let bit = bits.trailing_zeros();
                bits &= bits - 1;
                let number = self.number((row, word), shared, bit);
                let Some(pixel) = self.pixels.get_mut(number) else { continue };
                let next = std::mem::replace(&mut pixel.piece, self.pieces.len() as u32);
                pixel.count += 1;
                let x = ((word * 64) as i32 + bit as i32) << BITS;
                let ends = [(x_upper - x, ends[0].1), (x_lower - x, ends[1].1)];
                self.pieces.push(Piece { sign, ends, next });
            }
        }
    }

    /// Returns the number of the shared pixel at a bit of a word of a row.
    #[inline(always)]
    fn number(&self, (row, word): (i32, usize), shared: u64, bit: u32) -> usize {
        let word = (row.max(0) as usize) * self.words + word;
        let before = (shared & !(u64::MAX << bit)).count_ones();
        self.ranks.get(word).map_or(usize::MAX, |rank| (rank + before) as usize)
    }

    /// Corrects the coverage 0 … 255 of the shared pixels among eight, whose integrals are `sums`; the first is at a
    /// bit of a word of a row.
    #[inline(never)]
    pub fn eight(
        &mut self,
        at: (i32, usize),
        shared: u64,
        first: u32,
        rule: FillRule,
        sums: &[i32; 8],
        coverage: &mut [u32; 8],
    ) {
        let mut bits = (shared >> first) & 255;
        while bits != 0 {
            let lane = bits.trailing_zeros();
            bits &= bits - 1;
            let number = self.number(at, shared, first + lane);
            let Some(pixel) = self.pixels.get(number).copied() else { continue };
            if let Some(area) = self.area(pixel, sums[lane as usize], rule) {
                coverage[lane as usize] = (area.clamp(0.0, 1.0) * 255.0 + 0.5) as u32;
            }
        }
    }

    /// Returns the covered area of one pixel; `None` if the integral is enough.
    fn area(&mut self, pixel: Shared, sum: i32, rule: FillRule) -> Option<f64> {
        // Each piece changes the winding number by one, so a mean this far from zero means one sign all over the pixel.
        let mean = sum.unsigned_abs() >> BITS;
        let many = pixel.count > self.limits.measured;
        if many || (rule == FillRule::NonZero && mean >= pixel.count) {
            return None;
        }
        self.segments.clear();
        let mut at = pixel.piece;
        while let Some(piece) = self.pieces.get(at as usize) {
            push_segments(piece, &mut self.segments);
            at = piece.next;
        }
        let up = self.segments.iter().filter(|s| s.sign > 0).count() as i32;
        let down = self.segments.len() as i32 - up;
        if up + down < 2 {
            return None;
        }
        let right = |s: &Segment| {
            let height = s.y1 - s.y0;
            f64::from(s.sign) * (1.0 - s.x0 - s.slope * height / 2.0) * height
        };
        let local: f64 = self.segments.iter().map(right).sum();
        let base = (f64::from(sum) / f64::from(ONE) - local + 0.5).floor() as i32;
        // Bounds of the winding number: they often decide at once.
        if rule == FillRule::NonZero && (base - down > 0 || base + up < 0) {
            return Some(1.0);
        }
        if self.segments.len() > self.limits.exact {
            lines(self.segments.len(), &self.limits, &mut self.cuts);
        } else {
            cuts(&self.segments, &mut self.cuts);
        }
        Some(self.slabs(base, rule))
    }

    /// Returns the area inside, of slabs that are as wide everywhere as in the middle.
    fn slabs(&mut self, base: i32, rule: FillRule) -> f64 {
        let inside = |winding: i32| match rule {
            FillRule::NonZero => winding != 0,
            FillRule::EvenOdd => winding & 1 != 0,
        };
        let many = self.segments.len() > ALL.exact;
        let mut area = 0.0;
        for pair in self.cuts.windows(2) {
            let (upper, lower) = (pair[0], pair[1]);
            if lower <= upper {
                continue;
            }
            let middle = (upper + lower) / 2.0;
            // Segments crossed in the middle of the slab, from left to right.
            self.active.clear();
            let crossed = self.segments.iter().filter(|s| s.y0 <= middle && s.y1 > middle);
            let crossings = crossed.map(|s| (s.x_at(middle), s.sign));
            if many {
                self.active.extend(crossings);
                self.active.sort_by(|a, b| a.0.total_cmp(&b.0));
            } else {
                crossings.for_each(|c| insert(&mut self.active, c, |a, b| a.0 < b.0));
            }
            // Widths between crossings, where the winding number is inside; `base` is that of the left border.
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

/// Puts an item where it belongs in a short list in order.
#[inline(always)]
fn insert<T: Copy>(list: &mut Vec<T>, item: T, before: impl Fn(&T, &T) -> bool) {
    let mut at = list.len();
    list.push(item);
    while at > 0 && before(&item, &list[at - 1]) {
        list[at] = list[at - 1];
        at -= 1;
    }
    list[at] = item;
}

/// Adds the part of a piece inside the pixel, and its effect on the pixel's left border.
fn push_segments(piece: &Piece, out: &mut Vec<Segment>) {
    let unit = |v: i32| f64::from(v) / f64::from(ONE);
    let [upper, lower] = piece.ends;
    let (mut x0, mut y0) = (unit(upper.0), unit(upper.1));
    let (mut x1, mut y1) = (unit(lower.0), unit(lower.1));
    let sign = piece.sign;
    // Most pieces are inside the pixel and need no division.
    let (height, width) = (y1 - y0, x1 - x0);
    let y_at = move |x: f64| y0 + height * ((x - x0) / width);
    // Crossing the left border changes the winding number along it from there on.
    let mut border = |y0: f64, y1: f64| {
        if y1 > y0 {
            out.push(Segment::new(0.0, y0, 0.0, y1, sign));
        }
    };
    match (upper.0 < 0, lower.0 < 0) {
        (true, true) => return,
        (true, false) => {
            let left = y_at(0.0);
            border(0.0, left);
            (x0, y0) = (0.0, left);
        }
        (false, true) => {
            let left = y_at(0.0);
            border(left, 1.0);
            (x1, y1) = (0.0, left);
        }
        (false, false) => {}
    }
    // Parts beyond the right border do not change the pixel.
    match (upper.0 > ONE, lower.0 > ONE) {
        (true, true) => return,
        (true, false) => (x0, y0) = (1.0, y_at(1.0)),
        (false, true) => (x1, y1) = (1.0, y_at(1.0)),
        (false, false) => {}
    }
    if y1 > y0 {
        out.push(Segment::new(x0, y0, x1, y1, sign));
    }
}

/// Sets `cuts` to the heights, from 0 to 1, between which a pixel with this many segments is measured in the middle.
fn lines(segments: usize, limits: &Limits, cuts: &mut Vec<f64>) {
    let count = (limits.measures / segments).clamp(limits.lines.0, limits.lines.1);
    cuts.clear();
    cuts.extend((0..=count).map(|i| i as f64 / count as f64));
}

/// Finds the heights at which a segment ends or two of them cross, in order, from 0 to 1.
fn cuts(segments: &[Segment], cuts: &mut Vec<f64>) {
    cuts.clear();
    cuts.extend([0.0, 1.0]);
    let mut cut = |y: f64| insert(cuts, y, |a, b| a < b);
    for (i, a) in segments.iter().enumerate() {
        if a.y0 > 0.0 {
            cut(a.y0);
        }
        if a.y1 < 1.0 {
            cut(a.y1);
        }
        for b in &segments[..i] {
            let (upper, lower) = (a.y0.max(b.y0), a.y1.min(b.y1));
            if upper >= lower {
                continue;
            }
            let (d0, d1) = (a.x_at(upper) - b.x_at(upper), a.x_at(lower) - b.x_at(lower));
            if d0 * d1 < 0.0 {
                cut(upper + (lower - upper) * (d0 / (d0 - d1)));
            }
        }
    }
}
