//! Borders of a layer's areas, each part once: dashed or translucent borders shared by two neighbours would be visible
//! twice.

use crate::math::DVec2;
use std::collections::HashSet;

/// The edges that have been taken, from the smaller end to the larger.
#[derive(Debug, Default)]
pub struct Borders {
    taken: HashSet<[u64; 4]>,
}

/// A part of a ring.
#[derive(Debug, Clone, PartialEq)]
pub struct Border {
    pub points: Vec<DVec2>,
    /// True for a whole ring, whose first point is not repeated.
    pub closed: bool,
}

impl Borders {
    /// Adds a ring; returns the parts of it that no ring before had.
    pub fn take(&mut self, ring: &[DVec2]) -> Vec<Border> {
        let ring = match ring {
            [first, open @ .., last] if first == last => &ring[..=open.len()],
            _ => ring,
        };
        let count = ring.len();
        if count < 2 {
            return Vec::new();
        }
        let next = |i: usize| ring[(i + 1) % count];
        let is_new: Vec<bool> =
            (0..count).map(|i| self.taken.insert(key(ring[i], next(i)))).collect();
        let Some(known) = is_new.iter().position(|new| !new) else {
            return vec![Border { points: ring.to_vec(), closed: true }];
        };
        // Parts begin after an edge that is known.
        let edges: Vec<usize> = (1..=count).map(|i| (known + i) % count).collect();
        let parts = edges.chunk_by(|a, b| is_new[*a] == is_new[*b]).filter(|part| is_new[part[0]]);
        let border = |part: &[usize]| {
            let ends = part.iter().map(|edge| next(*edge));
            Border { points: std::iter::once(ring[part[0]]).chain(ends).collect(), closed: false }
        };
        parts.map(border).collect()
    }
}

/// Returns the key of an edge, the same for both directions.
fn key(a: DVec2, b: DVec2) -> [u64; 4] {
    // −0 is 0.
    let bits = |p: DVec2| [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()];
    let ([ax, ay], [bx, by]) = (bits(a), bits(b));
    if (ax, ay) <= (bx, by) { [ax, ay, bx, by] } else { [bx, by, ax, ay] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn what_neighbours_share_is_taken_once() {
        let mut borders = Borders::default();
        let left = ring(&[(0., 0.), (1., 0.), (1., 1.), (0., 1.), (0., 0.)]);
        let whole = borders.take(&left);
        assert_eq!(whole, [Border { points: left[..4].to_vec(), closed: true }]);
        let right = ring(&[(1., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 0.)]);
        let rest = borders.take(&right);
        let wanted = ring(&[(1., 0.), (2., 0.), (2., 1.), (1., 1.)]);
        assert_eq!(rest, [Border { points: wanted, closed: false }]);
        assert!(borders.take(&left).is_empty());
    }
}
