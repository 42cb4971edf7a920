//! The integer grid on which all decisions are made, and its exact predicates.
//!
//! Two widths share one code: [`i32`] with 64-bit products for up to 2³⁰ cells across, [`i64`] with
//! 128-bit products for up to 2⁴¹. Pixel (x, y) of the grid is the square
//! `[x − ½, x + ½) × [y − ½, y + ½)` around the grid point.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};

use crate::math::{DVec2, Rect};
use crate::{Error, Result};

/// A coordinate on the grid.
pub trait Coord: Copy + Ord + Debug + Send + Sync + Default + 'static {
    /// Wide enough for four times the difference of two products of coordinate differences.
    type Wide: Copy
        + Ord
        + Default
        + Add<Output = Self::Wide>
        + Sub<Output = Self::Wide>
        + Mul<Output = Self::Wide>
        + Neg<Output = Self::Wide>;
    /// Number that contains both coordinates of a point.
    type Key: Ord;
    /// Returns a word that orders points by x, then y.
    fn key(x: Self, y: Self) -> Self::Key;
    /// Coordinates lie in `−LIMIT … LIMIT`.
    const LIMIT: i64;
    /// Widens.
    fn wide(self) -> Self::Wide;
    /// Returns the coordinate of a whole number within ± LIMIT.
    fn from_i64(value: i64) -> Self;
    /// Widens.
    fn i64(self) -> i64;
    /// Widens a product.
    fn i128(wide: Self::Wide) -> i128;
    /// Returns a product as a float, rounded.
    fn approximate(wide: Self::Wide) -> f64;
    /// Converts to a float; exact as long as the coordinate keeps within LIMIT.
    fn f64(self) -> f64 {
        self.i64() as f64
    }
}

impl Coord for i32 {
    type Wide = i64;
    type Key = i64;
    #[inline(always)]
    fn key(x: i32, y: i32) -> i64 {
        i64::from(x) << 32 | i64::from(y as u32 ^ 1 << 31)
    }
    const LIMIT: i64 = 1 << 29;
    #[inline(always)]
    fn wide(self) -> i64 {
        i64::from(self)
    }
    #[inline(always)]
    fn from_i64(value: i64) -> Self {
        value as i32
    }
    #[inline(always)]
    fn i64(self) -> i64 {
        i64::from(self)
    }
    #[inline(always)]
    fn i128(wide: i64) -> i128 {
        i128::from(wide)
    }
    #[inline(always)]
    fn approximate(wide: i64) -> f64 {
        wide as f64
    }
    #[inline(always)]
    fn f64(self) -> f64 {
        f64::from(self)
    }
}

impl Coord for i64 {
    type Wide = i128;
    type Key = (i64, i64);
    #[inline(always)]
    fn key(x: i64, y: i64) -> (i64, i64) {
        (x, y)
    }
    const LIMIT: i64 = 1 << 40;
    #[inline(always)]
    fn wide(self) -> i128 {
        i128::from(self)
    }
    #[inline(always)]
    fn from_i64(value: i64) -> Self {
        value
    }
    #[inline(always)]
    fn i64(self) -> i64 {
        self
    }
    #[inline(always)]
    fn i128(wide: i128) -> i128 {
        wide
    }
    #[inline(always)]
    fn approximate(wide: i128) -> f64 {
        wide as f64
    }
}

/// A grid point; ordered by x, then y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Point<C> {
    /// Column of the cell, to the right.
    pub x: C,
    /// Row of the cell, upwards.
    pub y: C,
}

impl<C: Coord> PartialOrd for Point<C> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<C: Coord> Ord for Point<C> {
    #[inline(always)]
    fn cmp(&self, other: &Self) -> Ordering {
        C::key(self.x, self.y).cmp(&C::key(other.x, other.y))
    }
}

impl<C: Coord> Point<C> {
    /// Creates a point from whole numbers within ± [`Coord::LIMIT`].
    #[inline(always)]
    pub fn new(x: i64, y: i64) -> Self {
        Self { x: C::from_i64(x), y: C::from_i64(y) }
    }
}

/// Returns twice the signed area of the triangle a, b, c; exact.
#[inline(always)]
pub fn cross<C: Coord>(a: Point<C>, b: Point<C>, c: Point<C>) -> C::Wide {
    (b.x.wide() - a.x.wide()) * (c.y.wide() - a.y.wide())
        - (b.y.wide() - a.y.wide()) * (c.x.wide() - a.x.wide())
}

/// Returns the largest whole number that is not above `x`; without the call that [`f64::floor`] is
/// on processors of the oldest kind.
#[inline(always)]
pub fn whole(x: f64) -> i64 {
    let truncated = x as i64;
    truncated - i64::from(truncated as f64 > x)
}

/// A segment whose first end is the lexicographically smaller one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Segment<C> {
    /// The left end; the lower one of a vertical segment.
    pub a: Point<C>,
    /// The right end; the upper one of a vertical segment.
    pub b: Point<C>,
}

impl<C: Coord> Segment<C> {
    /// Returns the smaller and the larger y of its ends.
    #[inline(always)]
    pub fn y_range(&self) -> (C, C) {
        if self.a.y <= self.b.y { (self.a.y, self.b.y) } else { (self.b.y, self.a.y) }
    }

    /// Compares the pixel around `p` with the segment's line: `Less` if it is entirely below the
    /// line, `Greater` if it is entirely above, `Equal` if the line passes through it.
    ///
    /// The line |cross| ≤ (|dx| + |dy|)/2 reaches the square; where it is equal it only touches a
    /// corner, and of the corners only the lower left one belongs to the pixel.
    #[inline(always)]
    pub fn side_of_pixel(&self, p: Point<C>) -> Ordering {
        let (dx, dy) = (self.b.x.wide() - self.a.x.wide(), self.b.y.wide() - self.a.y.wide());
        let zero = C::Wide::default();
        let reach = dx + if dy < zero { -dy } else { dy };
        let side = dx * (p.y.wide() - self.a.y.wide()) - dy * (p.x.wide() - self.a.x.wide());
        let side = side + side;
        if side > reach || (side == reach && dy >= zero) {
            Ordering::Greater
        } else if side <= -reach {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }

    /// Returns whether the segment passes through the pixel around `p`; exact.
    #[inline(always)]
    pub fn hits_pixel(&self, p: Point<C>) -> bool {
        let (low, high) = self.y_range();
        let in_box = self.a.x <= p.x && p.x <= self.b.x && low <= p.y && p.y <= high;
        in_box && self.side_of_pixel(p) == Ordering::Equal
    }

    /// Returns the pixel in which two segments cross, each in the other's interior; `None` if they touch, overlap or
    /// are apart. Exact, and the same whichever comes first.
    #[inline(always)]
    pub fn crossing(&self, other: &Self) -> Option<Point<C>> {
        let zero = C::Wide::default();
        let (from, to) = (cross(self.a, self.b, other.a), cross(self.a, self.b, other.b));
        if from == zero || to == zero || (from > zero) == (to > zero) {
            return None;
        }
        let (left, right) = (cross(other.a, other.b, self.a), cross(other.a, other.b, self.b));
        if left == zero || right == zero || (left > zero) == (right > zero) {
            return None;
        }
        Some(self.point_at(left, left - right))
    }

    /// Returns the pixel of the point a + (b − a)·num/den, for 0 < num/den < 1.
    #[inline]
    fn point_at(&self, num: C::Wide, den: C::Wide) -> Point<C> {
        let t = C::approximate(num) / C::approximate(den);
        let axis = |a: C, b: C| {
            let delta = b.f64() - a.f64();
            let value = a.f64() + delta * t + 0.5;
            // t carries four roundings, the rest two more: 2⁻⁵⁰ bounds them all.
            let error = (delta.abs() + a.f64().abs() + 1.0) * (1.0 / (1u64 << 50) as f64);
            let below = whole(value);
            let rest = value - below as f64;
            if rest > error && 1.0 - rest > error {
                return C::from_i64(below);
            }
            let (num, den) = (C::i128(num), C::i128(den));
            let (num, den) = if den < 0 { (-num, -den) } else { (num, den) };
            let offset = (2 * i128::from(b.i64() - a.i64()) * num + den).div_euclid(2 * den);
            C::from_i64(a.i64() + offset as i64)
        };
        Point { x: axis(self.a.x, self.b.x), y: axis(self.a.y, self.b.y) }
    }

    /// Returns roughly how high the segment is at x = `doubled`/2, which it must span.
    #[inline]
    pub fn height_at(&self, doubled: i64) -> Height {
        let (dx, dy) = (self.b.x.f64() - self.a.x.f64(), self.b.y.f64() - self.a.y.f64());
        let near = self.a.y.f64() + dy * ((doubled as f64 * 0.5 - self.a.x.f64()) / dx);
        let doubt = (dy.abs() + near.abs() + 0.5) * (1.0 / (1u64 << 50) as f64);
        Height { near, doubt }
    }

    /// Returns both heights as fractions over twice the segment's width, multiplied out.
    #[cold]
    pub fn compare_exactly(&self, other: &Self, doubled: i64) -> Ordering {
        // Heights relative to one point, so that 2 · 2⁴¹ · 2⁴¹ · 2 · 2⁴¹ stays below 2¹²⁷.
        let base = i128::from(self.a.y.i64());
        let fraction = |s: &Self| {
            let dx = i128::from(s.b.x.i64() - s.a.x.i64());
            let dy = i128::from(s.b.y.i64() - s.a.y.i64());
            let run = i128::from(doubled - 2 * s.a.x.i64());
            (2 * (i128::from(s.a.y.i64()) - base) * dx + dy * run, dx)
        };
        let ((n, d), (m, e)) = (fraction(self), fraction(other));
        (n * e).cmp(&(m * d))
    }
}

/// A rounded height, and by how much it may be off.
#[derive(Debug, Clone, Copy, Default)]
pub struct Height {
    near: f64,
    doubt: f64,
}

impl Height {
    /// Returns the order of the true heights, where rounding leaves no doubt of it.
    #[inline(always)]
    pub fn compare(self, other: Self) -> Option<Ordering> {
        if (self.near - other.near).abs() > self.doubt + other.doubt {
            Some(if self.near < other.near { Ordering::Less } else { Ordering::Greater })
        } else {
            None
        }
    }
}

/// A point of a kind that has a map to grid points.
pub trait GridPoint: Sized {
    /// The map.
    type Lattice: GridMap<Self>;
}

/// The map between points of one kind and the grid.
pub trait GridMap<P>: Copy + Sync + Sized {
    /// Returns the grid for points between two corners, with cells of the given size or of the
    /// kind's own.
    fn between(low: P, high: P, cell: Option<f64>) -> Result<Self>;
    /// Returns whether all coordinates fit the width.
    fn fits<C: Coord>(&self) -> bool;
    /// Returns the grid point whose pixel holds `p`.
    fn snap<C: Coord>(&self, p: P) -> Point<C>;
    /// Returns the grid point in the caller's coordinates.
    fn unsnap<C: Coord>(&self, p: Point<C>) -> P;
    /// Returns the size of a cell in the caller's units.
    fn cell(&self) -> f64;
    /// Returns roughly where a point is, in the caller's units; never exchanges two points on an axis.
    fn place(&self, p: P) -> DVec2;
}

impl GridPoint for DVec2 {
    type Lattice = Lattice;
}

/// The map between the caller's coordinates in f64 and the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    origin: DVec2,
    cell: f64,
    /// The largest grid coordinate that occurs, without its sign.
    reach: f64,
}

/// Cells from the middle of the extent to its border, where the caller names no cell size.
const DEFAULT_REACH: f64 = (1u64 << 29) as f64;

/// Largest coordinate: beyond, differences and products of coordinates could overflow f64.
const FARTHEST: f64 = 1e300;

impl Lattice {
    /// Creates the grid for points in `bounds`, with cells of the given size, or the smallest power
    /// of two that leaves at most 2³⁰ cells across.
    fn new(bounds: Rect, cell: Option<f64>) -> Result<Self> {
        let farthest = bounds.min().abs().max(bounds.max().abs()).max_element();
        if farthest > FARTHEST {
            let value = format!("{farthest:e}");
            return Err(Error::parameter("coordinate", value, "within ±1e300"));
        }
        let middle = bounds.min() * 0.5 + bounds.max() * 0.5;
        let half = (bounds.max() - middle).max(middle - bounds.min()).max_element();
        let cell = match cell {
            None => power_of_two((half / (DEFAULT_REACH - 2.0)).max(farthest * f64::EPSILON)),
            Some(size) if size.is_normal() && size > 0.0 => size,
            Some(size) => {
                let expected = "a finite size above zero, from 2.3e-308 on";
                return Err(Error::parameter("grid", format!("{size:e}"), expected));
            }
        };
        let origin = (middle / cell).round() * cell;
        let origin = if origin.is_finite() { origin } else { middle };
        let reach = (half / cell).ceil() + 1.0;
        if reach > i64::LIMIT as f64 || farthest / cell > 2f64.powi(53) {
            // Twice the finest possible grid, for a message with one digit.
            let enough = 2.0 * (half / (i64::LIMIT - 2) as f64).max(farthest / 2f64.powi(53));
            let value = format!("{cell:e}, where {enough:.0e} would do");
            let expected = "coarse enough for 2^41 cells across and 2^53 from the origin";
            return Err(Error::parameter("grid", value, expected));
        }
        Ok(Self { origin, cell, reach })
    }
}

impl GridMap<DVec2> for Lattice {
    fn between(low: DVec2, high: DVec2, cell: Option<f64>) -> Result<Self> {
        Self::new(Rect::new(low, high)?, cell)
    }

    fn fits<C: Coord>(&self) -> bool {
        self.reach <= C::LIMIT as f64
    }

    #[inline]
    fn snap<C: Coord>(&self, p: DVec2) -> Point<C> {
        let q = ((p - self.origin) / self.cell)
            .clamp(DVec2::splat(-self.reach), DVec2::splat(self.reach));
        Point::new(whole(q.x + 0.5), whole(q.y + 0.5))
    }

    #[inline]
    fn unsnap<C: Coord>(&self, p: Point<C>) -> DVec2 {
        self.origin + DVec2::new(p.x.f64(), p.y.f64()) * self.cell
    }

    fn cell(&self) -> f64 {
        self.cell
    }

    #[inline]
    fn place(&self, p: DVec2) -> DVec2 {
        p
    }
}

/// Returns the smallest power of two that is not below `x`; 2⁻¹⁰⁰⁰ for anything smaller.
fn power_of_two(x: f64) -> f64 {
    let smallest = f64::from_bits(23 << 52);
    if x <= smallest {
        return smallest;
    }
    let bits = x.to_bits();
    let floor = f64::from_bits(bits & 0x7ff0_0000_0000_0000);
    if floor == x { x } else { floor * 2.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment<C: Coord>(a: (i64, i64), b: (i64, i64)) -> Segment<C> {
        let (a, b) = (Point::new(a.0, a.1), Point::new(b.0, b.1));
        if a <= b { Segment { a, b } } else { Segment { a: b, b: a } }
    }

    /// Tests the half-open pixel by definition, in doubled coordinates, on fine samples of the segment.
    fn hits_slowly(s: &Segment<i32>, p: Point<i32>) -> bool {
        let (dx, dy) = (s.b.x - s.a.x, s.b.y - s.a.y);
        // The parameter enters and leaves each slab at multiples of 1/(2·dx·dy).
        let n = (4 * dx.abs().max(1) * dy.abs().max(1)) as i64;
        (0..=n).any(|i| {
            let x2 = 2 * s.a.x as i64 * n + 2 * dx as i64 * i;
            let y2 = 2 * s.a.y as i64 * n + 2 * dy as i64 * i;
            let (l, r) = ((2 * p.x as i64 - 1) * n, (2 * p.x as i64 + 1) * n);
            let (b, t) = ((2 * p.y as i64 - 1) * n, (2 * p.y as i64 + 1) * n);
            l <= x2 && x2 < r && b <= y2 && y2 < t
        })
    }

    #[test]
    fn pixels_are_hit_as_defined() {
        let ends = (-5..=5).flat_map(|x| (-5..=5).map(move |y| (x, y)));
        for (x, y) in ends.filter(|&end| end != (0, 0)) {
            let s = segment::<i32>((0, 0), (x, y));
            for (u, v) in (-6..=6).flat_map(|x| (-6..=6).map(move |y| (x, y))) {
                let p = Point::new(u, v);
                assert_eq!(s.hits_pixel(p), hits_slowly(&s, p), "{s:?} {p:?}");
            }
        }
    }

    #[test]
    fn crossings_round_alike_from_all_sides() {
        let far = i32::LIMIT;
        let s = segment::<i32>((-far, -far), (far, far - 1));
        let t = segment::<i32>((-far, far), (far, -far));
        assert_eq!(s.crossing(&t), t.crossing(&s));
        let wide = segment::<i64>((-i64::LIMIT, -i64::LIMIT), (i64::LIMIT, i64::LIMIT - 1));
        let other = segment::<i64>((-i64::LIMIT, i64::LIMIT), (i64::LIMIT, -i64::LIMIT));
        assert_eq!(wide.crossing(&other), other.crossing(&wide));
        assert_eq!(wide.compare_exactly(&other, 1), Ordering::Greater);
        let half = segment::<i32>((0, 0), (1, 1)).crossing(&segment((0, 1), (1, 0)));
        assert_eq!(half, Some(Point::new(1, 1)), "ties go up and right");
    }

    #[test]
    fn heights_that_round_alike_are_reported_apart() {
        let (far, mut state) = (i64::LIMIT, 11_u64);
        let mut random = |range: i64| {
            let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            state = state.wrapping_mul(step.0).wrapping_add(step.1);
            (state >> 20) as i64 % range
        };
        for _ in 0..2000 {
            let heights = [random(far), random(far)];
            let s = segment::<i64>((-far, heights[0]), (far, heights[1]));
            let beside = heights.map(|y| y + random(2));
            let t = segment::<i64>((-far + random(3), beside[0]), (far - random(3), beside[1]));
            let doubled = 2 * random(far) - far;
            let order = s.compare_exactly(&t, doubled);
            assert_eq!(t.compare_exactly(&s, doubled), order.reverse());
            let rounded = s.height_at(doubled).compare(t.height_at(doubled));
            assert!(rounded.is_none_or(|rounded| rounded == order), "{s:?} {t:?}");
        }
    }

    #[test]
    fn integers_stay_as_they_are() {
        let bounds = Rect::new(DVec2::splat(-3.0), DVec2::splat(1000.0)).expect("valid");
        let lattice = Lattice::new(bounds, None).expect("fits");
        for p in [DVec2::splat(-3.0), DVec2::new(17.0, 1000.0)] {
            assert_eq!(lattice.unsnap(lattice.snap::<i32>(p)), p);
        }
    }
}
