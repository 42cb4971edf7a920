//! Two sets of rings as cyclic lists of vertices with their common points linked: what
//! Weiler–Atherton and Greiner–Hormann walk on.
//!
//! Touching vertices and common edges are told from true crossings after E. L. Foster, K. Hormann
//! and R. T. Popa (*Clipping simple polygons with degenerate intersections*, Computers & Graphics:
//! X 2, 2019): where the lists run together, they cross only if they part to the other side.

use super::locate::{Place, group, locate, on_segment};
use super::{BooleanOp, Ring, Shapes, signed_area};
use crate::math::{DVec2, Orientation, orient2d};

/// What a vertex of a list is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A point of the input, on the other's border or not.
    Point,
    /// Where two edges cross inside both; its coordinates are rounded.
    Crossing,
}

/// A vertex of a cyclic list.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub at: DVec2,
    pub next: usize,
    pub previous: usize,
    pub kind: Kind,
    /// The same point in the other list.
    pub twin: Option<usize>,
    /// Whether the border truly changes sides of the other here.
    pub crosses: bool,
    /// Where it crosses: whether the subject comes into the clip's inside here.
    pub enters: bool,
}

/// The rings of one operand as lists; `starts` has one vertex of each.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub vertices: Vec<Vertex>,
    pub starts: Vec<usize>,
}

/// On which side of the other border a list comes or goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
    On,
}

impl Lists {
    fn new(rings: &[Vec<DVec2>]) -> Self {
        let mut lists = Self::default();
        for ring in rings {
            let start = lists.vertices.len();
            lists.starts.push(start);
            for (i, &at) in ring.iter().enumerate() {
                let next = start + (i + 1) % ring.len();
                let previous = start + (i + ring.len() - 1) % ring.len();
                let kind = Kind::Point;
                let vertex =
                    Vertex { at, next, previous, kind, twin: None, crosses: false, enters: false };
                lists.vertices.push(vertex);
            }
        }
        lists
    }

    /// The vertices of the ring that starts at `start`, once around.
    pub fn ring(&self, start: usize) -> impl Iterator<Item = usize> + '_ {
        let follow = move |&v: &usize| Some(self.vertices[v].next).filter(|&next| next != start);
        std::iter::successors(Some(start), follow)
    }

    /// The next input point in a direction: crossings, being rounded, are passed over.
    fn point(&self, from: usize, forward: bool) -> usize {
        let step = |v: usize| {
            let vertex = &self.vertices[v];
            if forward { vertex.next } else { vertex.previous }
        };
        let mut v = step(from);
        while self.vertices[v].kind == Kind::Crossing && v != from {
            v = step(v);
        }
        v
    }

    /// Puts a vertex on the edge that starts at `edge` (before insertions), `along` from its start.
    fn insert(&mut self, after: usize, at: DVec2, kind: Kind) -> usize {
        let (index, next) = (self.vertices.len(), self.vertices[after].next);
        let (crosses, enters) = (false, false);
        self.vertices.push(Vertex { at, next, previous: after, kind, twin: None, crosses, enters });
        self.vertices[after].next = index;
        self.vertices[next].previous = index;
        index
    }
}

/// Subject and clip with all common points linked and true crossings marked.
#[derive(Debug)]
pub(super) struct Linked {
    pub subject: Lists,
    pub clip: Lists,
    pub subject_rings: Vec<Vec<DVec2>>,
    pub clip_rings: Vec<Vec<DVec2>>,
}

/// The rings without repeated points and rings of no area, outer ones counter-clockwise, holes
/// clockwise.
fn tidy(shapes: &Shapes) -> Vec<Vec<DVec2>> {
    let rings = shapes.rings().map(|ring| {
        let mut ring = ring.to_vec();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    });
    let rings = rings.filter(|r| r.len() > 2 && signed_area(r) != 0.0).collect();
    let grouped = group(rings);
    grouped.rings().map(<[DVec2]>::to_vec).collect()
}

/// Links two sets of rings; each must be simple polygons whose rings do not touch one another.
pub(super) fn link(subject: &Shapes, clip: &Shapes) -> Linked {
    let (subject_rings, clip_rings) = (tidy(subject), tidy(clip));
    let mut linked = Linked {
        subject: Lists::new(&subject_rings),
        clip: Lists::new(&clip_rings),
        subject_rings,
        clip_rings,
    };
    linked.intersect();
    linked.mark();
    linked
}

/// A common point to be inserted: on which edge, how far along, and what it is.
#[derive(Debug, Clone, Copy)]
struct Hit {
    edge: usize,
    along: f64,
    at: DVec2,
    kind: Kind,
    /// Which pair of hits or vertices belongs together.
    pair: usize,
}

impl Linked {
    /// Finds all common points of the two borders and links them.
    fn intersect(&mut self) {
        let edges = |lists: &Lists| -> Vec<(usize, DVec2, DVec2)> {
            let v = &lists.vertices;
            (0..v.len()).map(|i| (i, v[i].at, v[v[i].next].at)).collect()
        };
        let (ours, theirs) = (edges(&self.subject), edges(&self.clip));
        let (mut on_subject, mut on_clip): (Vec<Hit>, Vec<Hit>) = (Vec::new(), Vec::new());
        // Of each pair: the vertex in the subject's list and in the clip's, once known.
        let mut pairs: Vec<(Option<usize>, Option<usize>)> = Vec::new();
        for &(i, a, b) in &ours {
            for &(j, c, d) in &theirs {
                let apart = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
                if apart {
                    continue;
                }
                let pair = pairs.len();
                let hit = |edge, along, at, kind| Hit { edge, along, at, kind, pair };
                if a == c {
                    pairs.push((Some(i), Some(j)));
                } else if a != d && on_segment(c, d, a) {
                    on_clip.push(hit(j, c.distance(a), a, Kind::Point));
                    pairs.push((Some(i), None));
                }
                let pair = pairs.len();
                let hit = |edge, along, at, kind| Hit { edge, along, at, kind, pair };
                if c != a && c != b && on_segment(a, b, c) {
                    on_subject.push(hit(i, a.distance(c), c, Kind::Point));
                    pairs.push((None, Some(j)));
                } else if let Some(at) = crossing(a, b, c, d) {
                    on_subject.push(hit(i, a.distance(at), at, Kind::Crossing));
                    on_clip.push(hit(j, c.distance(at), at, Kind::Crossing));
                    pairs.push((None, None));
                }
            }
        }
        insert_all(&mut self.subject, on_subject, |pair, v| pairs[pair].0 = Some(v));
        insert_all(&mut self.clip, on_clip, |pair, v| pairs[pair].1 = Some(v));
        for pair in pairs {
            if let (Some(s), Some(c)) = pair {
                self.subject.vertices[s].twin = Some(c);
                self.clip.vertices[c].twin = Some(s);
            }
        }
    }

    /// Marks true crossings, walking every ring of the subject once.
    fn mark(&mut self) {
        for k in 0..self.subject.starts.len() {
            let ring: Vec<usize> = self.subject.ring(self.subject.starts[k]).collect();
            let comes = |v: usize| self.side(v, false);
            // Start where a run of common edges starts, not within it.
            let start = ring.iter().position(|&v| comes(v).is_some_and(|s| s != Side::On));
            let Some(start) = start else { continue };
            let mut from = Side::On;
            let mut crossings = Vec::new();
            for &v in ring[start..].iter().chain(&ring[..start]) {
                let Some(come) = self.side(v, false) else { continue };
                if come != Side::On {
                    from = come;
                }
                let go = self.side(v, true).unwrap_or(Side::On);
                if go != Side::On && go != from {
                    crossings.push((v, go == Side::Left));
                }
            }
            for (v, enters) in crossings {
                let vertex = &mut self.subject.vertices[v];
                (vertex.crosses, vertex.enters) = (true, enters);
                if let Some(twin) = vertex.twin {
                    let vertex = &mut self.clip.vertices[twin];
                    (vertex.crosses, vertex.enters) = (true, enters);
                }
            }
        }
    }

    /// On which side of the clip's border the subject goes from, or comes to, a common vertex.
    fn side(&self, v: usize, going: bool) -> Option<Side> {
        let twin = self.subject.vertices[v].twin?;
        let (subject, clip) = (&self.subject.vertices, &self.clip.vertices);
        let other = self.subject.point(v, going);
        let (before, after) = (self.clip.point(twin, false), self.clip.point(twin, true));
        if subject[other].twin.is_some_and(|t| t == before || t == after) {
            return Some(Side::On);
        }
        let turn =
            |a: DVec2, b: DVec2, c: DVec2| orient2d(a, b, c) == Orientation::CounterClockwise;
        let (a, b, p) = (clip[before].at, clip[after].at, subject[other].at);
        if subject[v].kind == Kind::Crossing {
            return Some(if turn(a, b, p) { Side::Left } else { Side::Right });
        }
        let i = subject[v].at;
        let (first, second) = (turn(a, i, p), turn(i, b, p));
        let left = if turn(a, i, b) { first && second } else { first || second };
        Some(if left { Side::Left } else { Side::Right })
    }
}

/// The point where two segments cross inside both; `None` otherwise. Whether they do is exact.
fn crossing(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<DVec2> {
    let opposite = |s: Orientation, t: Orientation| {
        s != t && s != Orientation::Collinear && t != Orientation::Collinear
    };
    let crosses = opposite(orient2d(a, b, c), orient2d(a, b, d))
        && opposite(orient2d(c, d, a), orient2d(c, d, b));
    crosses.then(|| {
        let (left, right) = ((d - c).perp_dot(a - c), (d - c).perp_dot(b - c));
        let t = left / (left - right);
        if t.is_finite() { a + (b - a) * t.clamp(0.0, 1.0) } else { a }
    })
}

fn insert_all(lists: &mut Lists, mut hits: Vec<Hit>, mut known: impl FnMut(usize, usize)) {
    hits.sort_by(|a, b| a.edge.cmp(&b.edge).then(a.along.total_cmp(&b.along)));
    let mut last = None;
    for hit in hits {
        let after = match last {
            Some((edge, vertex)) if edge == hit.edge => vertex,
            _ => hit.edge,
        };
        let vertex = lists.insert(after, hit.at, hit.kind);
        known(hit.pair, vertex);
        last = Some((hit.edge, vertex));
    }
}

impl Linked {
    /// The rings that nothing crosses and that belong to the result as they are.
    pub fn whole_rings(&self, op: BooleanOp) -> Vec<Vec<DVec2>> {
        let lists = [(&self.subject, &self.clip_rings), (&self.clip, &self.subject_rings)];
        let mut rings = Vec::new();
        for (k, (list, other)) in lists.into_iter().enumerate() {
            let points = |start: usize| list.ring(start).map(|v| list.vertices[v].at).collect();
            let kept = |start: &usize| self.keeps(list, k == 1, *start, other, op);
            rings.extend(list.starts.iter().copied().filter(kept).map(points));
        }
        rings
    }

    fn keeps(
        &self,
        list: &Lists,
        is_clip: bool,
        start: usize,
        other: &[Vec<DVec2>],
        op: BooleanOp,
    ) -> bool {
        if list.ring(start).any(|v| list.vertices[v].crosses) {
            return false;
        }
        match (place(list, start, other), op) {
            // Rings that coincide are told by the subject's; the clip's would be a second copy.
            (Place::Border, _) if is_clip => false,
            (Place::Border, BooleanOp::Difference) => !same_side(list, start, &self.clip),
            (Place::Border, _) => same_side(list, start, &self.clip),
            (place, BooleanOp::Intersection) => place == Place::Inside,
            (place, BooleanOp::Union) => place == Place::Outside,
            (place, _) => (place == Place::Inside) == is_clip,
        }
    }
}

/// Where a ring that nothing crosses lies of the other's rings: told by a point of it that is not
/// on their border. `Border` where it runs along it everywhere.
fn place(lists: &Lists, start: usize, other: &[Vec<DVec2>]) -> Place {
    let at = |v: usize| lists.vertices[v].at;
    let middle = |v: usize| (at(v) + at(lists.vertices[v].next)) * 0.5;
    let free = lists.ring(start).filter(|&v| lists.vertices[v].twin.is_none()).map(at);
    // Between two common points the ring may leave the border: the middle tells.
    let mut places = free
        .chain(lists.ring(start).map(middle))
        .map(|p| locate(other.iter().map(Vec::as_slice), p));
    places.find(|&p| p != Place::Border).unwrap_or(Place::Border)
}

/// Whether a ring of the subject runs along the clip's with the inside on the same side.
fn same_side(lists: &Lists, start: usize, other: &Lists) -> bool {
    let next = lists.vertices[start].next;
    let twins = (lists.vertices[start].twin, lists.vertices[next].twin);
    matches!(twins, (Some(a), Some(b)) if other.vertices[a].next == b)
}

/// Polygons of the rings walked, without spikes; `tell` hears of every ring that is left.
pub(super) fn finish(found: Vec<Vec<DVec2>>, mut tell: impl FnMut(&Ring)) -> Shapes {
    let mut rings: Vec<Vec<DVec2>> = found.iter().map(|ring| without_spikes(ring)).collect();
    rings.retain(|ring| !ring.is_empty());
    rings.iter().for_each(|ring| tell(ring));
    group(rings)
}

/// A ring without the spikes that walks along common edges leave behind.
fn without_spikes(ring: &Ring) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = Vec::with_capacity(ring.len());
    for &p in ring {
        out.push(p);
        while let [.., a, _, c] = out[..] {
            if a != c {
                break;
            }
            out.truncate(out.len() - 2);
        }
        out.dedup();
    }
    while out.len() > 2 {
        let n = out.len();
        if out[0] == out[n - 1] {
            out.pop();
        } else if out[1] == out[n - 1] {
            out.remove(0);
        } else if out[0] == out[n - 2] {
            out.pop();
        } else {
            break;
        }
    }
    if out.len() < 3 { Vec::new() } else { out }
}
