//! Edges in fixed point: snapped, clipped to the target's columns, directed from top to bottom.
//!
//! All values depend only on the two end points, not on the direction of travel, so two faces that share an edge get
//! the same integers with opposite signs.

use crate::math::DVec2;

/// Bits below the pixel: fine enough that snapping moves no area by more than 2⁻¹⁷ of a pixel.
pub(crate) const BITS: u32 = 16;
/// One pixel, and one whole pixel's area.
pub(crate) const ONE: i32 = 1 << BITS;
/// Largest side of a target in pixels: coordinates are 16.16.
pub const MAX_SIDE: u32 = 32_767;

/// The edge goes upwards in the path (horizontal: to the left).
const REVERSED: u32 = 1;
/// At its upper end it cannot meet another edge of its path but the one it continues.
const CHAINED_UPPER: u32 = 2;
/// At its lower end likewise.
const CHAINED_LOWER: u32 = 4;

/// An edge from top to bottom; coordinates are 16.16 pixels, x within the target.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Edge {
    pub x0: i32,
    pub y0: i32,
    pub x1: i32,
    /// Lower end's row: not above `y0`; equal for horizontal edges, which carry no area.
    pub y1: i32,
    flags: u32,
}

/// Step of an edge from row to row.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Steps {
    /// x where the edge first crosses a border of rows, at or below `y0`.
    pub crossing: i32,
    /// Change of x from one row to the next, 32.32 pixels.
    pub slope: i64,
}

impl Steps {
    /// Returns x at the border `rows` rows below the first one, 32.32.
    #[inline(always)]
    pub fn at(&self, rows: i32) -> i64 {
        (i64::from(self.crossing) << BITS) + self.slope.wrapping_mul(i64::from(rows))
    }
}

impl Edge {
    /// Creates an edge from one point in the target to another.
    #[inline(always)]
    pub(super) fn new(from: (i32, i32), to: (i32, i32)) -> Self {
        // In one number each, so that no branch is predicted wrongly.
        let key = |(x, y): (i32, i32)| (i64::from(y) << 32) | i64::from(x as u32);
        let (a, b) = (key(from), key(to));
        let (upper, lower) = (a.min(b), a.max(b));
        let flags = u32::from(b < a) * REVERSED;
        let (x0, y0) = (upper as i32, (upper >> 32) as i32);
        Self { x0, y0, x1: lower as i32, y1: (lower >> 32) as i32, flags }
    }

    /// Returns the steps from row to row; the only division of an edge, made when needed.
    #[inline(always)]
    pub fn steps(&self) -> Steps {
        let per_row = f64::from(self.x1 - self.x0) / f64::from((self.y1 - self.y0).max(1));
        let below = (ONE - (self.y0 & (ONE - 1))) & (ONE - 1);
        let crossing = self.x0.saturating_add((per_row * f64::from(below)) as i32);
        Steps {
            crossing: crossing.clamp(self.x0.min(self.x1), self.x0.max(self.x1)),
            slope: (per_row * 4_294_967_296.0) as i64,
        }
    }

    /// Returns +1 for an edge that goes down in its path (horizontal: to the right), −1 for others.
    pub fn sign(&self) -> i32 {
        1 - 2 * (self.flags & REVERSED) as i32
    }

    /// Returns the edge as seen from an x right of the target's border, 16.16.
    #[inline(always)]
    pub fn moved(&self, x: i32) -> Self {
        Self { x0: self.x0 - x, x1: self.x1 - x, ..*self }
    }

    /// Returns the first row touched and one past the last; a horizontal edge on a border of rows
    /// touches none.
    pub fn rows(&self) -> (i32, i32) {
        (self.y0 >> BITS, (self.y1 + ONE - 1) >> BITS)
    }

    /// Returns whether the upper and the lower end are chained.
    #[inline(always)]
    pub fn chained(&self) -> (bool, bool) {
        (self.flags & CHAINED_UPPER != 0, self.flags & CHAINED_LOWER != 0)
    }

    /// Returns the start and the end of the edge in its path.
    #[inline(always)]
    pub(super) fn course(&self) -> [(i32, i32); 2] {
        let (upper, lower) = ((self.x0, self.y0), (self.x1, self.y1));
        if self.flags & REVERSED != 0 { [lower, upper] } else { [upper, lower] }
    }

    /// Returns whether it stays within about a pixel.
    #[inline(always)]
    pub(super) fn is_short(&self) -> bool {
        share_pixel((self.x0, self.y0), (self.x1, self.y1))
    }

    /// Chains the end at which the edge starts, or ends, in its path. Ends on a border of pixels are not chained,
    /// because the edge and its neighbour may touch different pixels there.
    #[inline(always)]
    pub(super) fn chain(&mut self, start: bool) {
        if !is_on_border(self.course()[usize::from(!start)]) {
            let upper = start == (self.flags & REVERSED == 0);
            self.flags |= if upper { CHAINED_UPPER } else { CHAINED_LOWER };
        }
    }

    /// Takes over the chained edges of a copy.
    pub(super) fn chain_as(&mut self, copy: &Self) {
        self.flags |= copy.flags;
    }

    /// Returns which of eight half-planes of directions contain the edge's own direction.
    pub(super) fn directions(&self) -> u8 {
        let sign = self.sign();
        let (dx, dy) = ((self.x1 - self.x0) * sign, (self.y1 - self.y0) * sign);
        let (sum, difference) = (dx.saturating_add(dy), dx.saturating_sub(dy));
        let halves = [
            dx >= 0,
            dx <= 0,
            dy >= 0,
            dy <= 0,
            sum >= 0,
            sum <= 0,
            difference >= 0,
            difference <= 0,
        ];
        halves.iter().enumerate().fold(0, |bits, (i, half)| bits | (u8::from(*half) << i))
    }
}

/// Returns whether a 16.16 point is on a border of pixels.
#[inline(always)]
pub(super) fn is_on_border((x, y): (i32, i32)) -> bool {
    x & (ONE - 1) == 0 || y & (ONE - 1) == 0
}

/// Returns whether two 16.16 points are in the same pixel or on its border.
#[inline(always)]
fn share_pixel(a: (i32, i32), b: (i32, i32)) -> bool {
    let near = |a: i32, b: i32| ((a >> BITS) == (b >> BITS)) | ((a - b).abs() <= 1);
    near(a.0, b.0) & near(a.1, b.1)
}

/// Returns the nearest grid point to a point within the target, ties to even.
pub(super) fn snap(p: DVec2) -> (i32, i32) {
    // Adding 1.5 · 2⁵² leaves the rounded integer in the low bits of the mantissa.
    const MAGIC: f64 = 6_755_399_441_055_744.0;
    let fixed = |v: f64| (v * f64::from(ONE) + MAGIC).to_bits() as u32 as i32;
    (fixed(p.x), fixed(p.y))
}
