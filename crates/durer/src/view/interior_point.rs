//! The point farthest from a polygon's border, the place for its label.
//!
//! Best-first search over a quadtree: a square cannot hold a point farther from the border than its
//! centre's distance plus its half diagonal, so squares that cannot beat the best point found are
//! dropped. Garcia-Castellanos and Lombardo, *Poles of inaccessibility* (2007), state the problem; the
//! search with bounds is V. Agafonkin's (2016).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};

/// Options for the extent of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Largest difference between the distances from the border of the farthest point and of the one
    /// found, in units of the coordinates; cost grows with its inverse.
    pub precision: f64,
    /// Limit on the squares that are examined; then the best point so far is taken.
    pub max_squares: usize,
}

impl Default for Options {
    /// Returns half a unit, for coordinates in pixels; 2,000 squares.
    fn default() -> Self {
        Self { precision: 0.5, max_squares: 2_000 }
    }
}

/// One step: a square has been examined, or, with a half side of 0, a point in the middle of the equally far ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Its centre.
    pub center: DVec2,
    /// Half its side.
    pub half: f64,
    /// The distance of the centre from the border, negative outside.
    pub distance: f64,
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        if self.half > 0.0 { 2 } else { 7 }
    }
}

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "interior-point",
    title: "Pole of inaccessibility",
    authors: "D. Garcia-Castellanos, U. Lombardo; V. Agafonkin",
    year: 2007,
    source: "Poles of inaccessibility, Scottish Geographical Journal 123(3); search with bounds: 2016",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(s n): s squares examined, some tens to hundreds, n vertices",
    limits: "distances in f64",
    pseudocode: &[
        "cover the bounding box with squares",
        "for each square: d ← distance of its centre from the border, negative outside",
        "    bound ← d + half of its diagonal",
        "    best ← the centre with the largest d",
        "while the largest bound is more than best + precision:",
        "    divide its square in four, with d and bound of each",
        "if the centroid of the largest ring is equally far: take it",
        "else: move the best point to the middle of the equally far ones",
    ],
};

/// A point within a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interior {
    /// The point.
    pub point: DVec2,
    /// Its distance from the border; a circle of this radius is within the polygon.
    pub distance: f64,
}

/// Returns the point of a polygon that is farthest from its rings — the inside by the even-odd rule — to within
/// `options.precision`; `None` if nothing is inside. Of equally far points, as in long rectangles, the centroid of the
/// largest ring is chosen if it is one of them, else one in their middle. Points that are not finite are left out.
///
/// ```
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
/// use durer::view::interior_point::{Options, interior_point};
///
/// let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)];
/// let ring = corners.map(|(x, y)| DVec2::new(x, y));
/// let found = interior_point(&[&ring[..]], &Options::default(), &mut NoTrace).unwrap();
/// assert!(found.distance >= 1.5 && found.point.y > 1.0 && found.point.y < 3.0);
/// ```
pub fn interior_point(
    rings: &[&[DVec2]],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Option<Interior> {
    let rings: Vec<Vec<DVec2>> =
        rings.iter().map(|ring| ring.iter().copied().filter(|p| p.is_finite()).collect()).collect();
    let bounds = Rect::around(rings.iter().flatten().copied())?;
    let side = bounds.size().min_element();
    let precision = if options.precision > 0.0 { options.precision } else { 0.0 };
    if side <= 0.0 || !bounds.size().is_finite() {
        return None;
    }
    let mut search = Search { rings: &rings, best: None, heap: BinaryHeap::new(), number: 0 };
    // A long box is covered by squares of its shorter side, few enough for any box.
    let squares = (bounds.size() / side).ceil().min(DVec2::splat(64.0));
    let half = (bounds.size() / squares).max_element() * 0.5;
    for j in 0..squares.y as u32 {
        for i in 0..squares.x as u32 {
            let at = DVec2::new(f64::from(i), f64::from(j)) + 0.5;
            search.look_at(bounds.min() + bounds.size() / squares * at, half, t);
        }
    }
    while let Some(square) = search.heap.pop() {
        let best = search.best.map_or(0.0, |b: Interior| b.distance);
        if square.bound - best <= precision || search.number >= options.max_squares {
            break;
        }
        let half = square.half * 0.5;
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            search.look_at(square.center + half * DVec2::new(x, y), half, t);
        }
    }
    let best = search.best?;
    let center = center_of_largest(&rings).unwrap_or(best.point);
    let distance = distance_to_border(center, &rings);
    t.step(|| Step { center, half: 0.0, distance });
    let least = best.distance - precision;
    if distance > 0.0 && distance >= least {
        return Some(Interior { point: center, distance });
    }
    let Interior { point: center, distance } = balanced(best, least, &rings, bounds.size());
    t.step(|| Step { center, half: 0.0, distance });
    Some(Interior { point: center, distance })
}

/// Number of bisections towards the first point that is too near.
const HALVINGS: u32 = 24;

/// Moves a point vertically, then horizontally, to the middle of the points that are at least as far from the border.
fn balanced(best: Interior, least: f64, rings: &[Vec<DVec2>], size: DVec2) -> Interior {
    [DVec2::new(0.0, size.y), DVec2::new(size.x, 0.0)].into_iter().fold(best, |best, way| {
        let reach = |way: DVec2| {
            let (mut near, mut far) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let middle = (near + far) * 0.5;
                let is_far = distance_to_border(best.point + way * middle, rings) >= least;
                *(if is_far { &mut near } else { &mut far }) = middle;
            }
            near
        };
        let point = best.point + way * ((reach(way) - reach(-way)) * 0.5);
        let distance = distance_to_border(point, rings);
        if distance > 0.0 && distance >= least { Interior { point, distance } } else { best }
    })
}

/// Returns the centre of the area of the ring that holds the most.
fn center_of_largest(rings: &[Vec<DVec2>]) -> Option<DVec2> {
    let centers = rings.iter().filter_map(|ring| {
        let origin = *ring.first()?;
        let (mut area, mut sum) = (0.0, DVec2::ZERO);
        for pair in ring.windows(2) {
            let (a, b) = (pair[0] - origin, pair[1] - origin);
            area += a.perp_dot(b);
            sum += (a + b) * a.perp_dot(b);
        }
        Some((area.abs(), origin + sum / (3.0 * area)))
    });
    let largest = centers.max_by(|a, b| a.0.total_cmp(&b.0))?.1;
    largest.is_finite().then_some(largest)
}

struct Search<'a> {
    rings: &'a [Vec<DVec2>],
    best: Option<Interior>,
    heap: BinaryHeap<Square>,
    number: usize,
}

impl Search<'_> {
    fn look_at(&mut self, center: DVec2, half: f64, t: &mut impl Tracer<Step>) {
        let distance = distance_to_border(center, self.rings);
        t.step(|| Step { center, half, distance });
        if distance > 0.0 && self.best.is_none_or(|b| distance > b.distance) {
            self.best = Some(Interior { point: center, distance });
        }
        let bound = distance + half * std::f64::consts::SQRT_2;
        if bound > 0.0 {
            self.heap.push(Square { bound, number: self.number, center, half });
        }
        self.number += 1;
    }
}

/// A square that may hold a better point.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Square {
    /// Upper bound of the distance of its points from the border.
    bound: f64,
    /// Number in order of creation; the earlier of two equal ones comes first.
    number: usize,
    center: DVec2,
    half: f64,
}

impl Eq for Square {}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Returns the distance to the border: positive inside by the even-odd rule, negative outside.
fn distance_to_border(p: DVec2, rings: &[Vec<DVec2>]) -> f64 {
    let (mut inside, mut nearest) = (false, f64::INFINITY);
    for ring in rings {
        let Some(mut a) = ring.last().copied() else { continue };
        for &b in ring {
            let crosses = (a.y > p.y) != (b.y > p.y);
            if crosses && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x {
                inside = !inside;
            }
            nearest = nearest.min(squared_distance(p, a, b));
            a = b;
        }
    }
    if inside { nearest.sqrt() } else { -nearest.sqrt() }
}

fn squared_distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let d = b - a;
    let length = d.length_squared();
    let along = if length > 0.0 { ((p - a).dot(d) / length).clamp(0.0, 1.0) } else { 0.0 };
    (p - (a + d * along)).length_squared()
}
