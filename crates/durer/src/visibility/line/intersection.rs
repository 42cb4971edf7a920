//! Where faces penetrate each other.
//!
//! Pairs come from a hierarchy of boxes over the faces in the order of a Morton curve, descended
//! against itself (as in Stefan Gottschalk, Ming Lin and Dinesh Manocha, *OBBTree*, 1996, with
//! axis-parallel boxes); whether and where two triangles meet is decided by exact signs (after
//! Philippe Guigue and Olivier Devillers, *Fast and Robust Triangle-Triangle Overlap Test Using
//! Orientation Predicates*, 2003). Coplanar faces have no line of intersection.
//!
//! O(n log n) for the hierarchy, and as many tests as boxes overlap.

use super::edge_lines::Intersections;
use crate::math::DVec3;
use crate::visibility::object::{Bodies, Faces};

/// A line in which two faces meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Meeting {
    pub ends: [DVec3; 2],
    pub items: [u32; 2],
}

/// All of them, by pairs of items.
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

#[derive(Debug, Clone, Copy)]
struct Node {
    min: [f32; 3],
    max: [f32; 3],
    /// The body of all faces below, or [`MIXED`].
    body: u32,
}

impl Node {
    const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3], body: MIXED };

    fn union(&self, other: &Self) -> Self {
        let mut joined = *self;
        for k in 0..3 {
            joined.min[k] = self.min[k].min(other.min[k]);
            joined.max[k] = self.max[k].max(other.max[k]);
        }
        joined.body = if self.body == other.body { self.body } else { MIXED };
        joined
    }

    fn touches(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }
}

/// A complete binary tree: node i has the children 2i + 1 and 2i + 2.
struct Tree<'a> {
    faces: &'a Faces,
    between: bool,
    nodes: Vec<Node>,
    /// Nodes from here on are leaves.
    first_leaf: u32,
    /// The faces along the curve, and their boxes beside each other in memory.
    order: Vec<u32>,
    boxes: Vec<Node>,
}

impl<'a> Tree<'a> {
    fn new(faces: &'a Faces, bodies: &Bodies, between: bool) -> Self {
        let order = morton_order(faces, bodies);
        let boxes: Vec<Node> = order.iter().map(|&i| face_box(faces, bodies, i)).collect();
        let leaves = order.len().div_ceil(LEAF).max(1).next_power_of_two();
        let mut nodes = vec![Node::EMPTY; 2 * leaves - 1];
        for (leaf, boxes) in boxes.chunks(LEAF).enumerate() {
            let joined = boxes.iter().copied().reduce(|a, b| a.union(&b));
            nodes[leaves - 1 + leaf] = joined.unwrap_or(Node::EMPTY);
        }
        for i in (0..leaves - 1).rev() {
            nodes[i] = nodes[2 * i + 1].union(&nodes[2 * i + 2]);
        }
        Self { faces, between, nodes, first_leaf: leaves as u32 - 1, order, boxes }
    }

    /// Whether a pair of nodes may hold a pair of faces that is asked for.
    fn may_meet(&self, a: u32, b: u32) -> bool {
        let (na, nb) = (&self.nodes[a as usize], &self.nodes[b as usize]);
        let same_body = self.between && na.body == nb.body && na.body != MIXED;
        !same_body && na.touches(nb)
    }

    /// What a pair of nodes divides into; leaves stay.
    fn children(&self, (a, b): (u32, u32), into: &mut Vec<(u32, u32)>) {
        if a >= self.first_leaf {
            into.push((a, b));
            return;
        }
        let (a, b) = ([2 * a + 1, 2 * a + 2], [2 * b + 1, 2 * b + 2]);
        let pairs = [(a[0], b[0]), (a[0], b[1]), (a[1], b[0]), (a[1], b[1])];
        // Of a node with itself, one of the mixed pairs is enough.
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
        for i in places(a).filter(|&i| self.boxes[i].touches(of_b)) {
            let others = if a == b { i + 1..places(b).end } else { places(b) };
            for k in others.filter(|&k| self.boxes[i].touches(&self.boxes[k])) {
                let apart = self.between && self.boxes[i].body == self.boxes[k].body;
                let (x, y) = (self.order[i], self.order[k]);
                if !apart && let Some(meeting) = self.pair(x.min(y), x.max(y)) {
                    found.push(meeting);
                }
            }
        }
    }

    /// Where two faces meet whose boxes touch.
    fn pair(&self, a: u32, b: u32) -> Option<Meeting> {
        let (ta, tb) = (self.faces.triangle(a)?, self.faces.triangle(b)?);
        let shared = ta.iter().filter(|v| tb.contains(v)).count();
        if shared > 1 {
            return None;
        }
        let (ca, cb) = (self.faces.corners(a)?, self.faces.corners(b)?);
        // Neighbours at a vertex are the most of all pairs, and few of them meet elsewhere too: the
        // two other corners of one would have to lie on different sides of the other.
        if shared == 1 && (one_sided(ta, &ca, tb, &cb) || one_sided(tb, &cb, ta, &ca)) {
            return None;
        }
        let ends = meeting(ca, cb)?;
        Some(Meeting { ends, items: [a, b] })
    }
}

/// Whether the corners of the second triangle that the first has not lie on one side of its plane.
fn one_sided(t: [u32; 3], corners: &[DVec3; 3], other: [u32; 3], of_other: &[DVec3; 3]) -> bool {
    let own = (0..3).filter(|&k| !t.contains(&other[k]));
    let mut sides = own.map(|k| side(corners, of_other[k]));
    match (sides.next(), sides.next()) {
        (Some(a), Some(b)) => (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0),
        _ => false,
    }
}

fn face_box(faces: &Faces, bodies: &Bodies, item: u32) -> Node {
    let Some(corners) = faces.corners(item) else { return Node::EMPTY };
    let [a, b, c] = corners;
    let (min, max) = (a.min(b).min(c).to_array(), a.max(b).max(c).to_array());
    Node {
        min: min.map(|v| (v as f32).next_down()),
        max: max.map(|v| (v as f32).next_up()),
        body: bodies.of(item).unwrap_or(MIXED),
    }
}

/// Items that belong to a body, along a curve that keeps neighbours together.
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

/// Ten bits, two zeros between each two.
fn spread(v: u32) -> u32 {
    let v = (v | v << 16) & 0x0300_00ff;
    let v = (v | v << 8) & 0x0300_f00f;
    let v = (v | v << 4) & 0x030c_30c3;
    (v | v << 2) & 0x0924_9249
}

/// On which side of the plane of a, b, c the point lies; its sign is exact.
fn side([a, b, c]: &[DVec3; 3], p: DVec3) -> f64 {
    let coord = |p: &DVec3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(&p))
}

/// The segment that two triangles share, unless they are coplanar or touch in a point.
fn meeting(s: [DVec3; 3], t: [DVec3; 3]) -> Option<[DVec3; 2]> {
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

/// Where the edges of one triangle go through the other; `sides` are those of its corners.
fn piercings(
    edges_of: &[DVec3; 3],
    sides: &[f64; 3],
    through: &[DVec3; 3],
    points: &mut Vec<DVec3>,
) {
    for i in 0..3 {
        let k = (i + 1) % 3;
        let ((p, dp), (q, dq)) = ((edges_of[i], sides[i]), (edges_of[k], sides[k]));
        if dp == 0.0 && inside(through, p, edges_of[i] + normal(through)) {
            points.push(p);
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

/// Whether the line p → q passes through the closed triangle.
fn inside([a, b, c]: &[DVec3; 3], p: DVec3, q: DVec3) -> bool {
    let d = [(a, b), (b, c), (c, a)].map(|(u, v)| side(&[*u, *v, p], q));
    d.iter().all(|d| *d >= 0.0) || d.iter().all(|d| *d <= 0.0)
}
