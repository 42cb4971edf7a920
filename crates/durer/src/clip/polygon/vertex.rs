//! The points of polygons, with f64 or integer coordinates.

use std::cmp::Ordering;
use std::fmt::Debug;

use super::overlay::job::Solve;
use super::overlay::lattice::GridPoint;
use crate::math::{DVec2, I64Vec2, Orientation, orient2d};

/// A point of [`Shapes`](super::Shapes): [`DVec2`] or [`I64Vec2`], and no other type.
pub trait Vertex:
    Copy + PartialEq + Default + Debug + Send + Sync + GridPoint + Solve + 'static
{
    /// Returns whether no coordinate is infinite or no number.
    fn is_finite(self) -> bool;

    /// Compares by x, then by y.
    fn order(self, other: Self) -> Ordering;

    /// Returns the smaller x and the smaller y of two points.
    fn low(self, other: Self) -> Self;

    /// Returns the larger x and the larger y of two points.
    fn high(self, other: Self) -> Self;

    /// Returns the vector from `origin`, rounded to f64.
    fn minus(self, origin: Self) -> DVec2;

    /// Returns the orientation of three points; exact, of f64 as [`orient2d`] is.
    fn turn(a: Self, b: Self, c: Self) -> Orientation;
}

impl Vertex for DVec2 {
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }

    fn order(self, other: Self) -> Ordering {
        // Zeros of either sign are one place.
        (self.x + 0.0).total_cmp(&(other.x + 0.0)).then((self.y + 0.0).total_cmp(&(other.y + 0.0)))
    }

    fn low(self, other: Self) -> Self {
        self.min(other)
    }

    fn high(self, other: Self) -> Self {
        self.max(other)
    }

    fn minus(self, origin: Self) -> DVec2 {
        self - origin
    }

    fn turn(a: Self, b: Self, c: Self) -> Orientation {
        orient2d(a, b, c)
    }
}

impl Vertex for I64Vec2 {
    fn is_finite(self) -> bool {
        true
    }

    fn order(self, other: Self) -> Ordering {
        self.x.cmp(&other.x).then(self.y.cmp(&other.y))
    }

    fn low(self, other: Self) -> Self {
        self.min(other)
    }

    fn high(self, other: Self) -> Self {
        self.max(other)
    }

    fn minus(self, origin: Self) -> DVec2 {
        let axis = |a: i64, b: i64| (i128::from(a) - i128::from(b)) as f64;
        DVec2::new(axis(self.x, origin.x), axis(self.y, origin.y))
    }

    fn turn(a: Self, b: Self, c: Self) -> Orientation {
        let (right, left) = (product(b.x, a.x, c.y, a.y), product(b.y, a.y, c.x, a.x));
        match right.cmp(&left) {
            Ordering::Greater => Orientation::CounterClockwise,
            Ordering::Less => Orientation::Clockwise,
            Ordering::Equal => Orientation::Collinear,
        }
    }
}

/// Returns a value that compares like (a − b)(c − d): two differences of 65 bits make a product that i128 does not
/// hold, but its sign and size in u128 do.
fn product(a: i64, b: i64, c: i64, d: i64) -> (i8, u128) {
    let size = u128::from(a.abs_diff(b)) * u128::from(c.abs_diff(d));
    let positive = (a > b) == (c > d);
    match (size, positive) {
        (0, _) => (0, 0),
        (size, true) => (1, size),
        (size, false) => (-1, u128::MAX - size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_of_whole_numbers_are_exact_to_the_corners_of_their_range() {
        let (low, high) = (I64Vec2::splat(i64::MIN), I64Vec2::splat(i64::MAX));
        let beside = |dx, dy| high + I64Vec2::new(dx, dy);
        let turn = |c| <I64Vec2 as Vertex>::turn(low, high, c);
        assert_eq!(turn(beside(-1, -1)), Orientation::Collinear);
        assert_eq!(turn(beside(-2, -1)), Orientation::CounterClockwise);
        assert_eq!(turn(beside(-1, -2)), Orientation::Clockwise);
        assert_eq!(turn(I64Vec2::new(i64::MIN, i64::MAX)), Orientation::CounterClockwise);
        assert_eq!(turn(I64Vec2::new(i64::MAX, i64::MIN)), Orientation::Clockwise);
    }

    #[test]
    fn both_kinds_of_points_turn_alike() {
        let all = (-2..=2).flat_map(|x| (-2..=2).map(move |y| I64Vec2::new(x, y)));
        let float = |p: I64Vec2| p.as_dvec2();
        for b in all.clone() {
            for c in all.clone() {
                let a = I64Vec2::new(1, -1);
                let exact = <I64Vec2 as Vertex>::turn(a, b, c);
                assert_eq!(exact, orient2d(float(a), float(b), float(c)), "{b} {c}");
                assert_eq!(b.order(c), float(b).order(float(c)));
            }
        }
    }
}
