//! Whole numbers as they are: each is a grid point, counted from the middle of the input.

use super::lattice::{Coord, GridMap, GridPoint, Point};
use crate::math::{DVec2, I64Vec2};
use crate::{Error, Result};

/// The largest distance between two coordinates of an axis.
pub const WIDEST: u64 = (<i64 as Coord>::LIMIT as u64 - 1) * 2;

/// The map between the caller's whole numbers and the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whole {
    origin: I64Vec2,
    /// The largest grid coordinate that occurs, without its sign.
    reach: i64,
}

impl GridPoint for I64Vec2 {
    type Lattice = Whole;
}

impl GridMap<I64Vec2> for Whole {
    fn between(low: I64Vec2, high: I64Vec2, cell: Option<f64>) -> Result<Self> {
        if let Some(size) = cell.filter(|&size| size != 1.0) {
            let expected = "1 or none: whole numbers are not snapped";
            return Err(Error::parameter("grid", size, expected));
        }
        let across = low.x.abs_diff(high.x).max(low.y.abs_diff(high.y));
        if across > WIDEST {
            return Err(Error::Limit {
                what: "number of cells across",
                value: across,
                limit: WIDEST,
            });
        }
        // No overflow: half of the difference is added.
        let middle = |low: i64, high: i64| low + (high - low) / 2;
        let origin = I64Vec2::new(middle(low.x, high.x), middle(low.y, high.y));
        Ok(Self { origin, reach: across.div_ceil(2) as i64 + 1 })
    }

    fn fits<C: Coord>(&self) -> bool {
        self.reach <= C::LIMIT
    }

    #[inline]
    fn snap<C: Coord>(&self, p: I64Vec2) -> Point<C> {
        Point::new(p.x - self.origin.x, p.y - self.origin.y)
    }

    #[inline]
    fn unsnap<C: Coord>(&self, p: Point<C>) -> I64Vec2 {
        I64Vec2::new(self.origin.x + p.x.i64(), self.origin.y + p.y.i64())
    }

    fn cell(&self) -> f64 {
        1.0
    }

    #[inline]
    fn place(&self, p: I64Vec2) -> DVec2 {
        (p - self.origin).as_dvec2()
    }
}
