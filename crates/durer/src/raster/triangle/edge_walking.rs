//! Triangles by following two edges from scan line to scan line.
//!
//! The scan-line method of Wylie, Romney, Evans and Erdahl, *Half-Tone Perspective Drawings by
//! Computer*, AFIPS FJCC 1967, with the integer error term of Bresenham (1965): an edge advances by
//! one addition and one comparison a row, without division or rounding. Image space. Time is
//! proportional to the rows plus the pixels covered.

pub use super::Options;
use super::{SnappedTriangle, Span};
use crate::info::{Class, Coherence, Info, Occluder};
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS, first_center};
use crate::trace::{PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "edge-walking",
    title: "Edge walking by scan line",
    authors: "Chris Wylie, Gordon Romney, David Evans, Alan Erdahl",
    year: 1967,
    source: "Half-Tone Perspective Drawings by Computer, AFIPS Fall Joint Computer Conference",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Edge, Coherence::ScanLine],
    cost: "O(rows + pixels covered) time, O(1) memory",
    limits: "coordinates within the guard band",
    pseudocode: &[
        "sort the corners by y: top, middle, bottom",
        "for the part above the middle corner, then for the part below it:",
        "    take the two edges that bound it",
        "    for each row whose centre lies in the part:",
        "        left ← first pixel right of the left edge",
        "        right ← first pixel right of the right edge",
        "        fill from left to right, exclusive",
        "        // the next row: both move by Δx/Δy, in whole numbers",
        "        left ← left + Δx/Δy, right ← right + Δx/Δy",
    ],
};

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The walk turned from the two upper edges to the lower ones, or began.
    Edges {
        /// First row of the two edges.
        y0: i32,
        /// Last row, exclusive.
        y1: i32,
    },
    /// Both edges reached a row; empty if `left ≥ right`.
    Row {
        /// Row.
        y: i32,
        /// First column of the triangle, inclusive, not clipped.
        left: i64,
        /// Last column of the triangle, exclusive, not clipped.
        right: i64,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Edges { .. } => 3,
            Self::Row { .. } => 7,
        }
    }
}

/// Emits the covered pixels, row by row from the top, one span a row.
pub fn rasterize(
    triangle: &SnappedTriangle,
    options: &Options,
    mut emit: impl FnMut(Span),
    t: &mut impl Tracer<Step>,
) {
    let Some(chains) = Chains::new(triangle) else { return };
    let clip = &options.clip;
    for half in chains.halves() {
        let (y0, y1) = (half.y0.max(clip.y0()), half.y1.min(clip.y1()));
        if y0 >= y1 {
            continue;
        }
        t.step(|| Step::Edges { y0, y1 });
        let mut left = Walk::start(half.left, y0);
        let mut right = Walk::start(half.right, y0);
        for y in y0..y1 {
            t.step(|| Step::Row { y, left: left.x, right: right.x });
            let within = |x: i64| x.clamp(clip.x0().into(), clip.x1().into()) as i32;
            Span::emit_unless_empty(y, within(left.x), within(right.x), &mut emit);
            left.advance();
            right.advance();
        }
    }
}

/// The two bounds of a triangle, followed downwards, for callers with many triangles at a time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowWalk {
    left: Walk,
    right: Walk,
    /// The first row of the lower two edges.
    turn: i32,
    /// The row after the last.
    end: i32,
}

impl RowWalk {
    /// Begins at the first row that is not above `y`; `None` if there is none.
    pub fn start(triangle: &SnappedTriangle, y: i32) -> Option<(Self, i32)> {
        let [upper, lower] = Chains::new(triangle)?.halves();
        let y = y.max(upper.y0);
        let half = if y < upper.y1 { &upper } else { &lower };
        if y >= half.y1 {
            return None;
        }
        let (left, right) = (Walk::start(half.left, y), Walk::start(half.right, y));
        Some((Self { left, right, turn: upper.y1, end: lower.y1 }, y))
    }

    /// Returns the first column, and the column after the last; empty if `x0 ≥ x1`.
    #[inline]
    pub fn span(&self) -> [i64; 2] {
        [self.left.x, self.right.x]
    }

    /// Goes on to row `y`, the one below the latest; returns whether the triangle reaches it.
    #[inline]
    pub fn advance(&mut self, y: i32, triangle: impl FnOnce() -> SnappedTriangle) -> bool {
        if y >= self.end {
            return false;
        }
        if y == self.turn {
            match Self::start(&triangle(), y) {
                Some((walk, _)) => *self = walk,
                None => return false,
            }
        } else {
            self.left.advance();
            self.right.advance();
        }
        true
    }
}

/// The corners from top to bottom, and the side of the long edge that the middle one is on.
struct Chains {
    top: [i32; 2],
    middle: [i32; 2],
    bottom: [i32; 2],
    middle_is_right: bool,
}

/// Rows in which the same two edges bound the triangle.
struct Half {
    left: [[i32; 2]; 2],
    right: [[i32; 2]; 2],
    y0: i32,
    y1: i32,
}

impl Chains {
    fn new(triangle: &SnappedTriangle) -> Option<Self> {
        let mut v = triangle.vertices();
        v.sort_by_key(|p| p[1]);
        let [top, middle, bottom] = v;
        // Clockwise on the screen from the top: the middle corner comes before the bottom one.
        let area = SnappedTriangle(v).doubled_area();
        (area != 0).then_some(Self { top, middle, bottom, middle_is_right: area > 0 })
    }

    /// Returns the halves above and below the middle corner. A row belongs where its centre is not above the upper end
    /// and strictly above the lower one: that is the top rule.
    fn halves(&self) -> [Half; 2] {
        let long = [self.top, self.bottom];
        [[self.top, self.middle], [self.middle, self.bottom]].map(|short| {
            let (left, right) = if self.middle_is_right { (long, short) } else { (short, long) };
            Half { left, right, y0: first_center(short[0][1]), y1: first_center(short[1][1]) }
        })
    }
}

/// Walk down an edge: x is the first column whose centre is not left of it.
///
/// The same number is used on both sides: as inclusive start on the left, as exclusive end on the right. x = ⌈n / d⌉
/// with n = the edge's abscissa times d; `error` = n − x · d is in (−d, 0].
#[derive(Debug, Clone, Copy)]
struct Walk {
    x: i64,
    error: i64,
    step: i64,
    rest: i64,
    d: i64,
}

impl Walk {
    /// Starts at row `y`, whose centre is in the edge's range of y, so that the edge is not horizontal.
    fn start([from, to]: [[i32; 2]; 2], y: i32) -> Self {
        let per_pixel = i64::from(SUBPIXELS);
        let [dx, dy] = [0, 1].map(|k| i64::from(to[k]) - i64::from(from[k]));
        let center = i64::from(y) * per_pixel + i64::from(HALF_PIXEL);
        // Below 2⁶³: the products are at most 2³⁰·2³¹ and 2³¹·2³¹.
        let n =
            (i64::from(from[0]) - i64::from(HALF_PIXEL)) * dy + (center - i64::from(from[1])) * dx;
        let d = per_pixel * dy;
        let x = -(-n).div_euclid(d);
        let step = dx.div_euclid(dy);
        Self { x, error: n - x * d, step, rest: per_pixel * dx.rem_euclid(dy), d }
    }

    fn advance(&mut self) {
        self.x += self.step;
        self.error += self.rest;
        if self.error > 0 {
            self.x += 1;
            self.error -= self.d;
        }
    }
}
