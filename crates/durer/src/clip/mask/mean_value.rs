//! Heights and measures within polygons, by mean value coordinates.
//!
//! K. Hormann, M. S. Floater, *Mean value coordinates for arbitrary planar polygons*, ACM Transactions on
//! Graphics 25(4), 2006: smooth within, equal to the values along the border, exact for planes. O(n) for each
//! place among n vertices. Values are kept within the range of the polygon's own.

use super::values::{Values, Zm};
use crate::clip::polygon::signed_area;
use crate::math::DVec2;

/// A ring with its values.
struct Ring<'a> {
    points: &'a [DVec2],
    zm: &'a [Zm],
    /// 1 where it runs as its kind should, outer ones counter-clockwise; else −1.
    sign: f64,
}

/// Polygons with values along their borders, which determine the values within.
pub struct MeanValues<'a> {
    polygons: Vec<Vec<Ring<'a>>>,
}

/// Sums over the edges around a place.
#[derive(Default)]
struct Sums {
    weight: f64,
    values: Zm,
    /// True if a ray to the right crosses the polygon's border an odd number of times.
    odd: bool,
}

impl<'a> MeanValues<'a> {
    /// Builds the edges of all polygons.
    pub fn new(values: &Values<'a>) -> Self {
        let shapes = values.shapes;
        let ring = |index: usize, outer: bool| {
            let points = shapes.ring(index);
            let zm = values.zm.get(shapes.ring_range(index)).unwrap_or_default();
            let sign = if (signed_area(points) > 0.0) == outer { 1.0 } else { -1.0 };
            Ring { points, zm, sign }
        };
        let polygon = |rings: std::ops::Range<usize>| {
            rings.clone().map(|index| ring(index, index == rings.start)).collect()
        };
        let all = shapes.polygons().map(|p| p.ring_indices());
        Self { polygons: all.map(polygon).collect() }
    }

    /// Returns the values at a place within a polygon; `None` if it is in none.
    pub fn at(&self, place: DVec2) -> Option<Zm> {
        self.polygons.iter().find_map(|polygon| within(polygon, place))
    }
}

fn within(polygon: &[Ring<'_>], place: DVec2) -> Option<Zm> {
    // Relative to one of the values, so that a constant is reproduced exactly.
    let base = *polygon.first()?.zm.first()?;
    let mut sums = Sums::default();
    polygon.iter().for_each(|ring| sums.add(ring, place, base));
    let mut value = [0.0; 2];
    for k in 0..2 {
        let of_all = || polygon.iter().flat_map(|ring| ring.zm).map(|zm| zm[k]);
        let (low, high) = (of_all().fold(base[k], f64::min), of_all().fold(base[k], f64::max));
        value[k] = (base[k] + sums.values[k] / sums.weight).max(low).min(high);
    }
    (sums.odd && value.iter().all(|v| v.is_finite())).then_some(value)
}

impl Sums {
    fn add(&mut self, ring: &Ring<'_>, place: DVec2, base: Zm) {
        let ends =
            ring.points.iter().zip(ring.zm).zip(ring.points.iter().zip(ring.zm).cycle().skip(1));
        for ((&a, u), (&b, v)) in ends {
            self.odd ^= (a.y > place.y) != (b.y > place.y) && {
                let left = (b - a).perp_dot(place - a) > 0.0;
                left == (b.y > a.y)
            };
            let (a, b) = (a - place, b - place);
            let (near, far) = (a.length(), b.length());
            // The tangent of half the angle at which the edge is seen.
            let half = ring.sign * a.perp_dot(b) / (near * far + a.dot(b));
            let (to_a, to_b) = (half / near, half / far);
            self.weight += to_a + to_b;
            for k in 0..2 {
                self.values[k] += to_a * (u[k] - base[k]) + to_b * (v[k] - base[k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::polygon::Shapes;

    #[test]
    fn planes_come_out_as_they_are_around_holes_too() {
        let mut shapes = Shapes::new();
        let outer = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (5.0, 3.0), (0.0, 9.0)].map(DVec2::from);
        let hole = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)].map(DVec2::from);
        shapes.push_ring(outer);
        shapes.push_ring(hole);
        shapes.end_polygon();
        let plane = |p: DVec2| [3.0 * p.x - p.y, 7.0];
        let zm: Vec<Zm> = shapes.points().iter().map(|&p| plane(p)).collect();
        let mean = MeanValues::new(&Values { shapes: &shapes, zm: &zm });
        for place in [(0.5, 5.0), (3.0, 1.0), (8.0, 7.0), (1.2, 1.8)].map(DVec2::from) {
            let [z, m] = mean.at(place).expect("inside");
            assert!((z - plane(place)[0]).abs() < 1e-12 && m == 7.0, "{place}: {z} {m}");
        }
        for place in [(5.0, 5.0), (1.8, 1.4), (-1.0, 2.0)].map(DVec2::from) {
            assert_eq!(mean.at(place), None, "{place}");
        }
    }
}
