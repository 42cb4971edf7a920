//! The intersections of faces.
//!
//! Pairs come from a hierarchy of boxes over the faces in the order of a Morton curve, descended
//! against itself (as in Stefan Gottschalk, Ming Lin and Dinesh Manocha, *OBBTree*, 1996, with
//! axis-parallel boxes); whether and where two triangles meet is decided by exact signs (after
//! Philippe Guigue and Olivier Devillers, *Fast and Robust Triangle-Triangle Overlap Test Using
//! Orientation Predicates*, 2003). Coplanar faces have no line of intersection.
//!
//! O(n log n) for the hierarchy, and as many tests as boxes overlap.

use super::edge_lines::Intersections;
use crate::math::{DVec3, by_coordinates};
use crate::visibility::object::{Bodies, Faces};
use std::cmp::Ordering::Greater;

/// A line in which two faces meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Meeting {
    pub ends: [DVec3; 2],
    pub items: [u32; 2],
}

/// Returns all of them, by pairs of items.
pub(super) fn intersections(faces: &Faces, bodies: &Bodies, which: Intersections) -> Vec<Meeting> {
    let between = which == Intersections::BetweenBodies;
    if between && bodies.all().len() < 2 {
        return Vec::new();
    }
    let tree = Tree::new(faces, bodies, between);
    let mut jobs = vec![(0u32, 0u32)];
    // Cut into jobs by descending a few levels: the same ones for any number of threads.
    for _ in 0..6 {
        let mut next = Vec::with_capacity(jobs.len() * 3);
        jobs.into_iter().for_each(|pair| tree.children(pair, &mut next));
        jobs = next;
    }
    let found = crate::parallel::map(jobs, |job| tree.meetings(job));
    let mut found: Vec<Meeting> = found.into_iter().flatten().collect();
    found.sort_unstable_by_key(|m| m.items);
    found
}

/// Faces per leaf.
const LEAF: usize = 4;

/// A body's number in a node that has several.
const MIXED: u32 = u32::MAX;

/// A box: its smallest coordinates, its largest with their signs turned, and two zeros. So one kind of comparison
/// decides whether two boxes touch, and processors make eight at once.
type Bounds = [f32; 8];

/// Bounds that nothing touches.
const NOTHING: Bounds = [
    f32::INFINITY,
    f32::INFINITY,
    f32::INFINITY,
    f32::INFINITY,
    f32::INFINITY,
    f32::INFINITY,
    0.0,
    0.0,
];

fn union(a: &Bounds, b: &Bounds) -> Bounds {
    std::array::from_fn(|k| a[k].min(b[k]))
}

/// Returns the largest coordinates of boxes that touch this one.
fn reach(of: &Bounds) -> Bounds {
    [-of[3], -of[4], -of[5], -of[0], -of[1], -of[2], 0.0, 0.0]
}

#[inline(always)]
fn touches(bounds: &Bounds, reach: &Bounds) -> bool {
    (0..8).fold(true, |all, k| all & (bounds[k] <= reach[k]))
}

/// A complete binary tree: node i has the children 2i + 1 and 2i + 2.
struct Tree<'a> {
    faces: &'a Faces,
    between: bool,
    nodes: Vec<Bounds>,
    /// The body of all faces below each node, or [`MIXED`]; empty if bodies do not matter.
    bodies: Vec<u32>,
    /// Nodes from here on are leaves.
    first_leaf: u32,
    /// The faces along the curve, and their boxes and bodies beside each other in memory.
    order: Vec<u32>,
    boxes: Vec<Bounds>,
    body_of: Vec<u32>,
}

impl<'a> Tree<'a> {
    fn new(faces: &'a Faces, bodies: &Bodies, between: bool) -> Self {
        let order = morton_order(faces, bodies);
        let boxes: Vec<Bounds> = order.iter().map(|&i| face_box(faces, i)).collect();
        let body_of: Vec<u32> = match between {
            true => order.iter().map(|&i| bodies.of(i).unwrap_or(MIXED)).collect(),
            false => Vec::new(),
        };
        let leaves = order.len().div_ceil(LEAF).max(1).next_power_of_two();
        let nodes = raised(&boxes, leaves, NOTHING, union);
        let same = |a: &u32, b: &u32| if a == b { *a } else { MIXED };
        let bodies = if between { raised(&body_of, leaves, MIXED, same) } else { Vec::new() };
        Self { faces, between, nodes, bodies, first_leaf: leaves as u32 - 1, order, boxes, body_of }
    }

    /// Returns whether a pair of nodes may contain a requested pair of faces.
    fn may_meet(&self, a: u32, b: u32) -> bool {
        let of = |node: u32| self.bodies[node as usize];
        let same_body = self.between && of(a) == of(b) && of(a) != MIXED;
        !same_body && touches(&self.nodes[a as usize], &reach(&self.nodes[b as usize]))
    }

    /// Divides a pair of nodes; leaves stay.
    fn children(&self, (a, b): (u32, u32), into: &mut Vec<(u32, u32)>) {
        if a >= self.first_leaf {
            into.push((a, b));
            return;
        }
        let (a, b) = ([2 * a + 1, 2 * a + 2], [2 * b + 1, 2 * b + 2]);
        let pairs = [(a[0], b[0]), (a[0], b[1]), (a[1], b[0]), (a[1], b[1])];
        // For a node with itself, one of the mixed pairs is enough.
        let pairs = pairs.into_iter().filter(|(x, y)| x <= y);
        into.extend(pairs.filter(|&(x, y)| self.may_meet(x, y)));
    }

    fn meetings(&self, job: (u32, u32)) -> Vec<Meeting> {
        let (mut stack, mut found) = (vec![job], Vec::new());
        while let Some(pair) = stack.pop() {
            if pair.0 < self.first_leaf {
                self.children(pair, &mut stack);
            } else {
                self.leaves(pair, &mut found);
            }
        }
        found
    }

    fn leaves(&self, (a, b): (u32, u32), found: &mut Vec<Meeting>) {
        let places = |node: u32| {
            let start = (node - self.first_leaf) as usize * LEAF;
            start..(start + LEAF).min(self.order.len())
        };
        let of_b = &self.nodes[b as usize];
        for i in places(a) {
            let reach = reach(&self.boxes[i]);
            if !touches(of_b, &reach) {
                continue;
            }
            let mut face = None;
            let others = if a == b { i + 1..places(b).end } else { places(b) };
            for k in others.filter(|&k| touches(&self.boxes[k], &reach)) {
                if self.between && self.body_of[i] == self.body_of[k] {
                    continue;
                }
                let (x, y) = (self.order[i], self.order[k]);
                let face = face.get_or_insert_with(|| Sided::new(self.faces, x));
                let other = Sided::new(self.faces, y);
                if let (Some(one), Some(other)) = (face, other)
                    && one.may_meet(&other)
                {
                    let items = [x.min(y), x.max(y)];
                    let ends = meeting(one.corners, other.corners);
                    found.extend(ends.map(|ends| Meeting { ends, items }));
                }
            }
        }
    }
}

/// Returns the nodes of a complete binary tree over leaves of [`LEAF`] values each.
fn raised<T: Copy>(values: &[T], leaves: usize, none: T, join: impl Fn(&T, &T) -> T) -> Vec<T> {
    let mut nodes = vec![none; 2 * leaves - 1];
    for (leaf, values) in values.chunks(LEAF).enumerate() {
        nodes[leaves - 1 + leaf] =
            values.iter().copied().reduce(|a, b| join(&a, &b)).unwrap_or(none);
    }
    for i in (0..leaves - 1).rev() {
        nodes[i] = join(&nodes[2 * i + 1], &nodes[2 * i + 2]);
    }
    nodes
}

/// A face, with data for a quick test of the side on which a point is.
struct Sided {
    vertices: [u32; 3],
    corners: [DVec3; 3],
    /// The product of two sides.
    normal: DVec3,
    /// Largest error of its product with a vector, for vectors no longer than 1 along the axes.
    error: f64,
}

/// Error of a determinant of three vectors, each no longer than 1 along the axes: six products of three
/// factors, each rounded eight times at most, are off by 48 · 2⁻⁵³ together; this is twice as much.
const ROUNDING: f64 = 1e-14;

impl Sided {
    #[inline(always)]
    fn new(faces: &Faces, item: u32) -> Option<Self> {
        let vertices = faces.triangle(item)?;
        let corners = vertices.map(|v| faces.points()[v as usize]);
        let (u, v) = (corners[1] - corners[0], corners[2] - corners[0]);
        let error = ROUNDING * u.abs().max_element() * v.abs().max_element();
        Some(Self { vertices, corners, normal: u.cross(v), error })
    }

    /// Returns the result of [`side`]: its sign is exact.
    #[inline(always)]
    fn side(&self, p: DVec3) -> f64 {
        let from = p - self.corners[0];
        let volume = self.normal.dot(from);
        if volume.abs() > self.error * from.abs().max_element() {
            -volume
        } else {
            side(&self.corners, p)
        }
    }

    /// Returns whether the two may meet in more than a vertex or side that they share.
    #[inline(always)]
    fn may_meet(&self, other: &Self) -> bool {
        let mut shared = (0..3).flat_map(|i| (0..3).map(move |k| (i, k)));
        let mut shared = shared.by_ref().filter(|&(i, k)| self.vertices[i] == other.vertices[k]);
        match (shared.next(), shared.next()) {
            (None, _) => !self.is_beside(other) && !other.is_beside(self),
            (Some(at), None) => self.may_meet_beyond(at, other),
            _ => false,
        }
    }

    /// Returns whether all corners of another face lie on one side.
    #[inline(always)]
    fn is_beside(&self, other: &Self) -> bool {
        let [a, b, c] = other.corners;
        let first = self.side(a);
        let same = |p: DVec3| first * self.side(p) > 0.0;
        same(b) && same(c)
    }

    /// Returns whether two faces that share one vertex may meet elsewhere too: neighbours at a vertex are the most of
    /// all pairs, and few of them do.
    #[inline(always)]
    fn may_meet_beyond(&self, (i, k): (usize, usize), other: &Self) -> bool {
        // The others of both faces, as they run around them.
        let [c, d] = [1, 2].map(|n| self.corners[(i + n) % 3]);
        let [a, b] = [1, 2].map(|n| other.corners[(k + n) % 3]);
        let (of_a, of_b) = (self.side(a), self.side(b));
        if of_a * of_b > 0.0 {
            return false;
        }
        let (of_c, of_d) = (other.side(c), other.side(d));
        if of_c * of_d > 0.0 {
            return false;
        }
        if [of_a, of_b, of_c, of_d].contains(&0.0) {
            return true;
        }
        // The line in which the planes meet runs between c and d, and it runs between a and b, on one side of the
        // vertex or the other: they meet if on the same. There the line from a to b passes the side to c
        // as it passes the face.
        side(&[self.corners[i], c, a], b) * of_b >= 0.0
    }
}

fn face_box(faces: &Faces, item: u32) -> Bounds {
    let Some([a, b, c]) = faces.corners(item) else { return NOTHING };
    let (min, max) = (a.min(b).min(c), a.max(b).max(c));
    let low = |v: f64| (v as f32).next_down();
    let high = |v: f64| -(v as f32).next_up();
    [low(min.x), low(min.y), low(min.z), high(max.x), high(max.y), high(max.z), 0.0, 0.0]
}

/// Returns the items that belong to a body, along a curve that keeps neighbours together.
fn morton_order(faces: &Faces, bodies: &Bodies) -> Vec<u32> {
    let bounds = crate::scene::Aabb::around(faces.points().iter().copied());
    let Some(bounds) = bounds else { return Vec::new() };
    let scale = 1023.0 / bounds.size().max_element().max(f64::MIN_POSITIVE);
    let mut keys: Vec<u64> = faces
        .triangles()
        .filter(|(item, _)| bodies.of(*item).is_some())
        .map(|(item, t)| {
            let [a, b, c] = t.map(|v| faces.points()[v as usize] - bounds.min);
            let middle = ((a + b + c) * (scale / 3.0)).to_array().map(|v| spread(v as u32 & 1023));
            let code = middle[0] | middle[1] << 1 | middle[2] << 2;
            u64::from(code) << 32 | u64::from(item)
        })
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(|k| k as u32).collect()
}

/// Spreads ten bits, with two zeros between each two.
fn spread(v: u32) -> u32 {
    let v = (v | v << 16) & 0x0300_00ff;
    let v = (v | v << 8) & 0x0300_f00f;
    let v = (v | v << 4) & 0x030c_30c3;
    (v | v << 2) & 0x0924_9249
}

/// Returns the side of the plane of a, b, c on which the point is; the sign is exact.
fn side([a, b, c]: &[DVec3; 3], p: DVec3) -> f64 {
    let coord = |p: &DVec3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(&p))
}

/// Returns the segment that two triangles share, unless they are coplanar or touch in a point. The same to
/// the bit whichever comes first, and wherever they begin.
fn meeting(mut s: [DVec3; 3], mut t: [DVec3; 3]) -> Option<[DVec3; 2]> {
    s.sort_unstable_by(by_coordinates);
    t.sort_unstable_by(by_coordinates);
    if s.iter().zip(&t).map(|(p, q)| by_coordinates(p, q)).find(|o| o.is_ne()) == Some(Greater) {
        std::mem::swap(&mut s, &mut t);
    }
    let apart = |d: &[f64; 3]| d.iter().all(|d| *d > 0.0) || d.iter().all(|d| *d < 0.0);
    let of_t = t.map(|p| side(&s, p));
    if apart(&of_t) || of_t == [0.0; 3] {
        return None;
    }
    let of_s = s.map(|p| side(&t, p));
    if apart(&of_s) || of_s == [0.0; 3] {
        return None;
    }
    let mut points: Vec<DVec3> = Vec::with_capacity(4);
    piercings(&s, &of_s, &t, &mut points);
    piercings(&t, &of_t, &s, &mut points);
    // The two that lie furthest apart; the others are the same points found twice.
    let mut best: Option<(f64, [DVec3; 2])> = None;
    for (i, &p) in points.iter().enumerate() {
        for &q in &points[i + 1..] {
            let d = p.distance_squared(q);
            if d > 0.0 && best.is_none_or(|(b, _)| d > b) {
                best = Some((d, [p, q]));
            }
        }
    }
    best.map(|(_, ends)| ends)
}

/// Finds the points at which the edges of one triangle, whose corners are sorted, pass through the other; `sides` are
/// those of its corners.
fn piercings(
    edges_of: &[DVec3; 3],
    sides: &[f64; 3],
    through: &[DVec3; 3],
    points: &mut Vec<DVec3>,
) {
    for i in 0..3 {
        // From the smaller to the larger corner: both faces at an edge find the same place.
        let [a, b] = [[0, 1], [1, 2], [0, 2]][i];
        let ((p, dp), (q, dq)) = ((edges_of[a], sides[a]), (edges_of[b], sides[b]));
        if sides[i] == 0.0 && inside(through, edges_of[i], edges_of[i] + normal(through)) {
            points.push(edges_of[i]);
        }
        if (dp > 0.0) != (dq > 0.0) && dp != 0.0 && dq != 0.0 && inside(through, p, q) {
            points.push(p + (q - p) * (dp / (dp - dq)));
        }
    }
}

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    let (u, v) = (*b - *a, *c - *a);
    u.cross(v).normalize_or_zero() * u.length().max(v.length())
}

/// Returns whether the line p → q passes through the closed triangle.
fn inside([a, b, c]: &[DVec3; 3], p: DVec3, q: DVec3) -> bool {
    let d = [(a, b), (b, c), (c, a)].map(|(u, v)| side(&[*u, *v, p], q));
    d.iter().all(|d| *d >= 0.0) || d.iter().all(|d| *d <= 0.0)
}
