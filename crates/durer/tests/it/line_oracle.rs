//! The expected lines, found independently of the solver: edges by a map of positions, visibility by rays through
//! points of them.

use crate::line_scenes::Triangle;
use durer::math::{DVec2, DVec3};
use durer::target::drawing::{Drawing, Line};
use durer::view::View;
use std::collections::BTreeMap;

/// A scene as triangles, with the view's axes.
pub struct Oracle {
    triangles: Vec<Triangle>,
    view: View,
    extent: f64,
    /// Triangles by cell of the picture.
    cells: Vec<Vec<u32>>,
    low: DVec2,
    size: f64,
}

const SIDE: usize = 128;

/// An edge with its triangles.
pub struct Edge {
    pub ends: [DVec3; 2],
    pub triangles: Vec<u32>,
}

/// Number of samples, and of the right ones among them.
#[derive(Debug, Default, Clone, Copy)]
pub struct Score {
    pub right: usize,
    pub all: usize,
}

impl Score {
    pub fn add(&mut self, right: bool) {
        self.all += 1;
        self.right += usize::from(right);
    }

    pub fn share(&self) -> f64 {
        if self.all == 0 { 1.0 } else { self.right as f64 / self.all as f64 }
    }
}

impl Oracle {
    pub fn new(triangles: &[Triangle], view: &View) -> Self {
        let mut distinct: Vec<Triangle> = Vec::new();
        for t in triangles {
            // For small scenes only, which repeat triangles.
            if triangles.len() > 1000 || !distinct.contains(t) {
                distinct.push(*t);
            }
        }
        let triangles = &distinct[..];
        let mut oracle = Self {
            triangles: triangles.to_vec(),
            view: *view,
            extent: 0.0,
            cells: vec![Vec::new(); SIDE * SIDE],
            low: DVec2::INFINITY,
            size: 0.0,
        };
        let points: Vec<[DVec2; 3]> =
            triangles.iter().map(|t| t.map(|p| oracle.project(p).0)).collect();
        let mut high = DVec2::NEG_INFINITY;
        for p in points.iter().flatten() {
            oracle.low = oracle.low.min(*p);
            high = high.max(*p);
        }
        oracle.extent = (high - oracle.low).max_element();
        oracle.size = oracle.extent / (SIDE as f64 - 2.0);
        for (i, t) in points.iter().enumerate() {
            let (lo, hi) = (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
            let ([x0, y0], [x1, y1]) = (oracle.cell(lo), oracle.cell(hi));
            for y in y0..=y1 {
                (x0..=x1).for_each(|x| oracle.cells[y * SIDE + x].push(i as u32));
            }
        }
        oracle
    }

    /// Returns each edge once.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Returns the larger side of the picture.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    fn cell(&self, p: DVec2) -> [usize; 2] {
        let c = (p - self.low) / self.size;
        [c.x, c.y].map(|v| (v.max(0.0) as usize).min(SIDE - 1))
    }

    /// Returns the point in the plane and the distance along the line of sight.
    pub fn project(&self, p: DVec3) -> (DVec2, f64) {
        let camera = self.view.camera();
        let [right, up, back] = camera.axes();
        let d = p - camera.eye;
        let (at, z) = (DVec2::new(right.dot(d), up.dot(d)), -back.dot(d));
        match camera.projection {
            durer::scene::Projection::Orthographic { .. } => (at, z),
            durer::scene::Projection::Perspective { .. } => {
                (at * ((camera.target - camera.eye).length() / z), z)
            }
        }
    }

    /// Returns the origin and direction of the line of sight through a point of the plane.
    pub fn sight(&self, at: DVec2) -> (DVec3, DVec3) {
        let camera = self.view.camera();
        let [right, up, back] = camera.axes();
        let distance = (camera.target - camera.eye).length();
        let offset = right * at.x + up * at.y;
        match camera.projection {
            durer::scene::Projection::Orthographic { .. } => (camera.eye + offset, -back),
            durer::scene::Projection::Perspective { .. } => (camera.eye, offset / distance - back),
        }
    }

    /// Returns whether a surface precedes a distance along the line of sight through a point of the plane.
    fn blocked(&self, at: DVec2, z: f64) -> bool {
        let (origin, direction) = self.sight(at);
        let [x, y] = self.cell(at);
        self.cells[y * SIDE + x].iter().any(|&i| {
            let [a, b, c] = self.triangles[i as usize];
            // Möller and Trumbore, 1997.
            let (e1, e2) = (b - a, c - a);
            let p = direction.cross(e2);
            let det = e1.dot(p);
            if det.abs() < 1e-12 * self.extent * self.extent {
                return false;
            }
            let s = origin - a;
            let u = s.dot(p) / det;
            let q = s.cross(e1);
            let v = direction.dot(q) / det;
            let t = e2.dot(q) / det;
            u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t < z - 2e-5 * self.extent
        })
    }

    /// Returns whether a point of an edge is hidden on both sides of the edge.
    pub fn hidden(&self, edge: &Edge, t: f64) -> bool {
        let (a, b) = (self.project(edge.ends[0]).0, self.project(edge.ends[1]).0);
        let (at, z) = self.project(edge.ends[0].lerp(edge.ends[1], t));
        let aside = (b - a).perp().normalize_or_zero() * (2e-6 * self.extent);
        self.blocked(at + aside, z) && self.blocked(at - aside, z)
    }

    pub fn edges(&self) -> Vec<Edge> {
        let key = |p: DVec3| (p / self.extent * 1e7).round().to_array().map(|v| v as i64);
        let mut edges: BTreeMap<[[i64; 3]; 2], Edge> = BTreeMap::new();
        for (i, t) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let (mut p, mut q) = (t[k], t[(k + 1) % 3]);
                if key(p) > key(q) {
                    (p, q) = (q, p);
                }
                let edge = edges
                    .entry([key(p), key(q)])
                    .or_insert(Edge { ends: [p, q], triangles: Vec::new() });
                edge.triangles.push(i as u32);
            }
        }
        edges.into_values().filter(|e| e.ends[0] != e.ends[1]).collect()
    }

    /// Returns whether an edge must be drawn whatever the rounding.
    pub fn surely_drawn(&self, edge: &Edge) -> bool {
        let [a, b] = edge.triangles[..] else { return true };
        let normal = |i: u32| {
            let [a, b, c] = self.triangles[i as usize];
            (b - a).cross(c - a).normalize_or_zero()
        };
        let (na, nb) = (normal(a), normal(b));
        if na.dot(nb) < 45.0_f64.to_radians().cos() {
            return true;
        }
        let (_, sight) = self.sight(self.project(edge.ends[0]).0);
        let (fa, fb) = (na.dot(sight), nb.dot(sight));
        fa * fb < 0.0 && fa.abs() > 1e-3 && fb.abs() > 1e-3
    }

    /// Samples all lines of a drawing: visible ones must show something visible, and hidden ones something hidden.
    pub fn precision(&self, drawing: &Drawing, per_line: usize) -> [Score; 2] {
        let edges = self.edges();
        let mut near: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (i, edge) in edges.iter().enumerate() {
            let [a, b] = edge.ends.map(|p| self.project(p).0);
            let steps = (a.distance(b) / self.size * 2.0).ceil().max(1.0) as usize;
            let mut last = None;
            for s in 0..=steps {
                let cell = self.cell(a.lerp(b, s as f64 / steps as f64));
                if last != Some(cell) {
                    for (dx, dy) in (0..9).map(|k| (k % 3, k / 3)) {
                        let c =
                            [(cell[0] + dx).saturating_sub(1), (cell[1] + dy).saturating_sub(1)];
                        near.entry(c).or_default().push(i);
                    }
                    last = Some(cell);
                }
            }
        }
        let mut scores = [Score::default(); 2];
        for line in &drawing.lines {
            let class = usize::from(!line.is_visible());
            for p in samples(line, per_line) {
                let candidates = near.get(&self.cell(p)).map_or(&[][..], Vec::as_slice);
                let fits = candidates.iter().any(|&i| {
                    let (t, d) = self.nearest(&edges[i], p);
                    d < 6e-5 * self.extent && self.hidden(&edges[i], t) != line.is_visible()
                });
                let meets = line.class == durer::target::drawing::LineClass::Intersection;
                if !meets {
                    scores[class].add(fits);
                }
            }
        }
        scores
    }

    /// Returns the parameter of the point of an edge that is nearest in the picture, and its distance in the picture.
    pub fn nearest(&self, edge: &Edge, p: DVec2) -> (f64, f64) {
        let ((a, za), (b, zb)) = (self.project(edge.ends[0]), self.project(edge.ends[1]));
        let s = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
        let d = a.lerp(b, s).distance(p);
        let perspective =
            matches!(self.view.camera().projection, durer::scene::Projection::Perspective { .. });
        // From the parameter in the picture to the one in space.
        let t = if perspective { s * za / (zb + s * (za - zb)) } else { s };
        (t, d)
    }

    /// Samples edges that must be drawn: their visible parts must be drawn as visible.
    pub fn recall(&self, drawing: &Drawing, per_edge: usize) -> Score {
        let mut cells: BTreeMap<[usize; 2], Vec<[DVec2; 2]>> = BTreeMap::new();
        for line in drawing.lines.iter().filter(|l| l.is_visible()) {
            for [a, b] in segments(line) {
                let steps = (a.distance(b) / self.size * 2.0).ceil().max(1.0) as usize;
                for s in 0..=steps {
                    let cell = self.cell(a.lerp(b, s as f64 / steps as f64));
                    for (dx, dy) in (0..9).map(|k| (k % 3, k / 3)) {
                        let c =
                            [(cell[0] + dx).saturating_sub(1), (cell[1] + dy).saturating_sub(1)];
                        let list = cells.entry(c).or_default();
                        if list.last() != Some(&[a, b]) {
                            list.push([a, b]);
                        }
                    }
                }
            }
        }
        let mut score = Score::default();
        for edge in self.edges().iter().filter(|e| self.surely_drawn(e)) {
            for k in 0..per_edge {
                let t = (k as f64 + 0.37) / per_edge as f64;
                if self.hidden(edge, t) {
                    continue;
                }
                let p = self.project(edge.ends[0].lerp(edge.ends[1], t)).0;
                let near = cells.get(&self.cell(p)).map_or(&[][..], Vec::as_slice);
                score.add(near.iter().any(|s| distance(p, *s) < 1e-4 * self.extent));
            }
        }
        score
    }
}

pub fn segments(line: &Line) -> Vec<[DVec2; 2]> {
    let mut found: Vec<[DVec2; 2]> = line.points.windows(2).map(|w| [w[0], w[1]]).collect();
    if let (true, Some(&a), Some(&b)) = (line.closed, line.points.last(), line.points.first()) {
        found.push([a, b]);
    }
    found
}

fn samples(line: &Line, count: usize) -> Vec<DVec2> {
    let segments = segments(line);
    let each = count.div_ceil(segments.len().max(1));
    let at = |k: usize| (k as f64 + 0.41) / each as f64;
    segments.iter().flat_map(|[a, b]| (0..each).map(move |k| a.lerp(*b, at(k)))).collect()
}

pub fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let s = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-300)).clamp(0.0, 1.0);
    a.lerp(b, s).distance(p)
}

/// Returns the length of pieces with a parallel piece within `close` of their middle.
pub fn drawn_twice(drawing: &Drawing, close: f64) -> f64 {
    let all: Vec<[DVec2; 2]> = drawing.lines.iter().flat_map(segments).collect();
    let twice = |i: usize, [a, b]: [DVec2; 2]| {
        let direction = (b - a).normalize_or_zero();
        all.iter().enumerate().any(|(k, other)| {
            let parallel =
                direction.perp_dot((other[1] - other[0]).normalize_or_zero()).abs() < 0.01;
            k != i && parallel && distance(a.lerp(b, 0.5), *other) < close
        })
    };
    all.iter().enumerate().filter(|(i, s)| twice(*i, **s)).map(|(_, [a, b])| a.distance(*b)).sum()
}
