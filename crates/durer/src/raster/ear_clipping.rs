//! Ear clipping corner by corner, as published: [`INFO`](super::triangulate::INFO).
//!
//! G. H. Meisters, *Polygons have ears*, American Mathematical Monthly 82(6), 1975; bridges to holes after D. Eberly, *Triangulation
//! by ear clipping*, 2002. Every corner is tried in turn: it is an ear if it is convex and the triangle with its neighbours holds
//! no other corner. O(n²) tests of corners, each against all others. [`triangulate`](super::triangulate::triangulate) finds
//! ears faster, in another order.
//!
//! All signs are exact. Rings may be given in either direction. Where rings cross, there may be no ear; then another
//! corner is cut off, so that the loop always ends.

use super::triangulate::{Step, Triangulation};
use crate::curve::Contours;
use crate::math::{DVec2, Orientation, orient2d, orient2d_value};
use crate::sorting::CompactSort;
use crate::trace::Tracer;

/// Triangulates a polygon: the first contour is its border, the others are holes in it.
///
/// ```
/// use durer::curve::Contours;
/// use durer::math::DVec2;
/// use durer::raster::ear_clipping::ears;
/// use durer::trace::NoTrace;
///
/// let arrow = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 1.0), (0.0, 4.0)].map(DVec2::from);
/// let found = ears(&Contours::polygon(arrow), &mut NoTrace);
/// assert_eq!(found.triangles, [[1, 2, 3], [3, 4, 0], [3, 0, 1]]);
/// ```
pub fn ears(polygon: &Contours, t: &mut impl Tracer<Step>) -> Triangulation {
    let (mut points, mut rings) = (Vec::new(), Vec::new());
    for (contour, _) in polygon.iter() {
        let first = points.len() as u32;
        points.extend(contour.iter().copied().filter(|p| p.is_finite()));
        rings.push((first..points.len() as u32).collect::<Vec<u32>>());
    }
    points.iter().for_each(|p| t.step(|| Step::Point(*p)));
    let mut cutting = Cutting { points, ring: Vec::new() };
    for (number, ring) in rings.iter_mut().enumerate() {
        // The border counter-clockwise, holes clockwise.
        if (cutting.area(ring) < 0.0) == (number == 0) {
            ring.reverse();
        }
    }
    rings.retain(|ring| !ring.is_empty());
    let mut rings = rings.into_iter();
    cutting.ring = rings.next().unwrap_or_default();
    cutting.join(rings.collect(), t);
    let triangles = cutting.cut(t);
    Triangulation { points: cutting.points, triangles }
}

/// Rest of a polygon.
struct Cutting {
    points: Vec<DVec2>,
    /// Corners in order, counter-clockwise; the ends of bridges appear twice.
    ring: Vec<u32>,
}

impl Cutting {
    fn at(&self, corner: u32) -> DVec2 {
        self.points.get(corner as usize).copied().unwrap_or_default()
    }

    fn area(&self, ring: &[u32]) -> f64 {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| self.at(*a).perp_dot(self.at(*b))).sum()
    }

    /// Joins holes to the ring, the one that reaches farthest to the right first.
    fn join(&mut self, mut holes: Vec<Vec<u32>>, t: &mut impl Tracer<Step>) {
        let right = |hole: &[u32]| {
            let place = (0..hole.len()).max_by(|a, b| {
                let [a, b] = [a, b].map(|k| self.at(hole[*k]));
                a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
            });
            place.unwrap_or_default()
        };
        for hole in &mut holes {
            let place = right(hole);
            hole.rotate_left(place);
        }
        holes.compact_sort_by(|a, b| self.at(b[0]).x.total_cmp(&self.at(a[0]).x));
        while !holes.is_empty() {
            let hole = holes.remove(0);
            let from = hole[0];
            let mut near: Vec<usize> = (0..self.ring.len()).collect();
            let distance = |k: &usize| self.at(self.ring[*k]).distance_squared(self.at(from));
            near.compact_sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
            let sees = |place: &&usize| {
                let rings = [&self.ring, &hole].into_iter().chain(&holes);
                self.is_inner(**place, from)
                    && rings.into_iter().all(|r| self.is_clear(r, [from, self.ring[**place]]))
            };
            let place = near.iter().find(sees).or(near.first()).copied().unwrap_or_default();
            let Some(&to) = self.ring.get(place) else { return };
            t.step(|| Step::Bridge([from, to]));
            // There along the bridge, around the hole, and back.
            let way = hole.iter().copied().chain([from, to]);
            self.ring.splice(place + 1..place + 1, way);
        }
    }

    /// Returns whether a point is within the angle of the ring at a corner.
    fn is_inner(&self, place: usize, point: u32) -> bool {
        let [a, b, c] = self.around(place).map(|corner| self.at(corner));
        let p = self.at(point);
        let is_left = |a, b| orient2d(a, b, p) == Orientation::CounterClockwise;
        if orient2d(a, b, c) == Orientation::CounterClockwise {
            is_left(a, b) && is_left(b, c)
        } else {
            is_left(a, b) || is_left(b, c)
        }
    }

    /// Returns whether a bridge meets no edge of a ring but at its own ends.
    fn is_clear(&self, ring: &[u32], bridge: [u32; 2]) -> bool {
        let [p, q] = bridge.map(|corner| self.at(corner));
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).all(|(&a, &b)| {
            let [a, b] = [a, b].map(|corner| self.at(corner));
            if [a, b].iter().any(|end| *end == p || *end == q) {
                return true;
            }
            let apart = |u, v, a, b| {
                let sides = [orient2d(u, v, a), orient2d(u, v, b)];
                sides[0] == sides[1] && sides[0] != Orientation::Collinear
            };
            let boxes_apart = p.max(q).cmplt(a.min(b)).any() || a.max(b).cmplt(p.min(q)).any();
            boxes_apart || apart(p, q, a, b) || apart(a, b, p, q)
        })
    }

    /// Returns the corners before, at and after a place of the ring.
    fn around(&self, place: usize) -> [u32; 3] {
        let count = self.ring.len();
        [count - 1, 0, 1].map(|k| self.ring[(place + k) % count])
    }

    /// Cuts off ears until nothing is left.
    fn cut(&mut self, t: &mut impl Tracer<Step>) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        let mut place = 0;
        while self.ring.len() > 2 {
            let count = self.ring.len();
            let turns = (place..place + count).map(|place| place % count);
            let ear = turns.clone().find(|&place| count == 3 || self.is_ear(place, t));
            // In rings that cross themselves, any convex corner, or else any corner.
            let convex = || turns.clone().find(|&place| self.cross(place) > 0.0);
            let ear = ear.or_else(convex).unwrap_or_default();
            let corners = self.around(ear);
            t.step(|| Step::Triangle(corners));
            triangles.push(corners);
            self.ring.remove(ear);
            if count == 3 {
                break;
            }
            place = ear % self.ring.len();
        }
        triangles
    }

    /// Returns (B − A) × (C − B) of the corner at a place; its sign is exact.
    fn cross(&self, place: usize) -> f64 {
        let [a, b, c] = self.around(place).map(|corner| self.at(corner));
        orient2d_value(a, b, c)
    }

    fn is_ear(&self, place: usize, t: &mut impl Tracer<Step>) -> bool {
        let (corners, cross) = (self.around(place), self.cross(place));
        if cross <= 0.0 {
            t.step(|| Step::Reflex { corners, cross });
            return false;
        }
        let [a, b, c] = corners.map(|corner| self.at(corner));
        let holds = |p: DVec2| {
            let is_right = |a, b| orient2d(a, b, p) == Orientation::Clockwise;
            ![a, b, c].contains(&p) && !is_right(a, b) && !is_right(b, c) && !is_right(c, a)
        };
        let by = self.ring.iter().copied().find(|corner| holds(self.at(*corner)));
        if let Some(by) = by {
            t.step(|| Step::Blocked { corners, by });
        }
        by.is_none()
    }
}
