//! Insertion of vertices so that subject and mask meet bit for bit where they are within rounding of each other.
//!
//! Neighbours agree, because only a point and an edge themselves decide whether they are near.

use crate::clip::attribute::VertexSource;
use crate::clip::polygon::rectangle::Near;
use crate::clip::polygon::rectangle::tree::Tree;
use crate::clip::polygon::{Shapes, Vertex};
use crate::clip::touch::{are_one, is_on, is_within, reach};
use crate::math::{DVec2, Rect};
use std::ops::Range;

/// Polygons to cut, with the vertices that the mask adds to their edges.
#[derive(Debug)]
pub(super) struct Subject<'a> {
    input: &'a Shapes,
    /// Shapes with more vertices, if there are any, and the source of each point.
    divided: Option<(Shapes, Vec<VertexSource>)>,
}

impl<'a> Subject<'a> {
    /// Creates the subject from polygons as they are.
    pub fn plain(input: &'a Shapes) -> Self {
        Self { input, divided: None }
    }

    /// Returns the polygons as given.
    pub fn input(&self) -> &Shapes {
        self.input
    }

    /// Returns the polygons, with the vertices that the mask adds to their edges.
    pub fn shapes(&self) -> &Shapes {
        self.divided.as_ref().map_or(self.input, |(shapes, _)| shapes)
    }

    /// Returns the source of a point.
    pub fn source(&self, index: usize) -> VertexSource {
        let divided = self.divided.as_ref();
        divided
            .and_then(|(_, sources)| sources.get(index).copied())
            .unwrap_or(VertexSource::Vertex(index))
    }

    /// Returns the edge of the input that the edge from a point belongs to, by its points' indices.
    pub fn edge(&self, index: usize) -> [usize; 2] {
        match self.source(index) {
            VertexSource::Cut { from, to, .. } => [from, to],
            VertexSource::Vertex(from) => [from, self.input.next_point(from)],
            VertexSource::Corner => [index, index],
        }
    }
}

/// Mask near the subject.
#[derive(Debug, Default)]
pub(super) struct Mask {
    pub near: Near,
    /// Source of each point in the subject.
    pub sources: Vec<VertexSource>,
}

impl Mask {
    pub fn new(near: Near) -> Self {
        let sources = vec![VertexSource::Corner; near.shapes.points().len()];
        Self { near, sources }
    }

    /// Returns whether one of its polygons is smaller than a cell of the grid.
    pub fn loses(&self, cell: f64) -> bool {
        let size = |ring: &[DVec2]| Rect::around(ring.iter().copied()).map(|r| r.size());
        let sizes = self.near.shapes.polygons().filter_map(|polygon| size(polygon.outer()));
        sizes.into_iter().any(|size| size.max_element() < cell)
    }
}

/// Vertices that come near to the other side.
#[derive(Debug, Default)]
struct Touches {
    /// Edges of the mask by their first points, and the subject's vertex that lies on each.
    on_mask: Vec<(usize, usize)>,
    /// Vertices of the mask and the vertices of the subject that they coincide with.
    same: Vec<(usize, usize)>,
    /// Edges of the subject, and the mask's vertex that lies on each.
    on_subject: Vec<(usize, usize)>,
    /// Edges of the subject, and another of its vertices that lies on each.
    on_self: Vec<(usize, usize)>,
}

/// An edge, by the index of its first point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub ends: [DVec2; 2],
    pub index: usize,
}

impl Edge {
    pub fn all(shapes: &Shapes) -> Vec<Self> {
        let of_ring = |ring| {
            let (points, start) = (shapes.ring(ring), shapes.ring_range(ring).start);
            let ends = points.iter().zip(points.iter().cycle().skip(1));
            ends.zip(start..).map(|((&a, &b), index)| Self { ends: [a, b], index })
        };
        (0..shapes.ring_count()).flat_map(of_ring).collect()
    }
}

/// Returns the box around some edges, and what is near them.
fn around(edges: &[Edge]) -> Option<Rect> {
    Rect::around(edges.iter().flat_map(|edge| edge.ends))
}

/// Factor on the usual reach, giving 32 to 64 ulp, within which a vertex of an invalid polygon counts as on another of
/// its edges, or a neighbour's vertex as on its edge: such vertices are mostly crossings that a program computed in
/// f64, several ulp beside the edges. A larger factor would bend borders by more than the precision of the coordinates.
pub(super) const OWN_REACH: f64 = 16.0;

/// Calls with all edges of ours and theirs whose boxes are near each other, within this many times the usual reach, and
/// some that are not.
pub(super) fn each_near(
    ours: &[Edge],
    theirs: &[Edge],
    times: f64,
    mut f: impl FnMut(&Edge, &Edge),
) {
    let tree = Tree::new(theirs.len(), &|some: Range<usize>| around(&theirs[some]));
    for run in ours.chunks(Tree::RUN) {
        let Some(bounds) = around(run) else { continue };
        let margin = 2.0 * times * reach(bounds.max().abs().max(bounds.min().abs()));
        let (low, high) = (bounds.min() - margin, bounds.max() + margin);
        let Ok(near) = Rect::new(low, high) else { continue };
        tree.visit(|node| {
            let look = node.around.overlaps(&near);
            if look && node.is_last() {
                for other in &theirs[node.items.clone()] {
                    let [a, b] = other.ends;
                    if a.min(b).cmple(high).all() && a.max(b).cmpge(low).all() {
                        run.iter().for_each(|edge| f(edge, other));
                    }
                }
            }
            look
        });
    }
}

impl Touches {
    fn between(subject: &Shapes, mask: &Mask) -> Self {
        let mut touches = Self::default();
        let (ours, theirs) = (Edge::all(subject), Edge::all(&mask.near.shapes));
        each_near(&ours, &theirs, 1.0, |edge, other| touches.look(edge, other, &mask.near.lines));
        touches
    }

    /// Adds where the subject comes near to itself.
    fn within(&mut self, subject: &Shapes) {
        let edges = Edge::all(subject);
        each_near(&edges, &edges, OWN_REACH, |edge, other| {
            let (p, [a, b]) = (edge.ends[0], other.ends);
            let lies_on = || is_within(OWN_REACH * reach(p), p, [a, b], [a, b]);
            if !are_one(p, a) && !are_one(p, b) && lies_on() {
                self.on_self.push((other.index, edge.index));
            }
        });
    }

    /// Checks whether the first point of either edge lies on the other one.
    #[inline]
    fn look(&mut self, ours: &Edge, theirs: &Edge, lines: &[[DVec2; 2]]) {
        let ([p, q], [a, b]) = (ours.ends, theirs.ends);
        if are_one(p, a) {
            self.same.push((theirs.index, ours.index));
            return;
        }
        if !are_one(p, b) && is_on(p, [a, b], lines[theirs.index]) {
            self.on_mask.push((theirs.index, ours.index));
        }
        if !are_one(q, a) && is_on(a, [p, q], [p, q]) {
            self.on_subject.push((ours.index, theirs.index));
        }
    }

    fn is_empty(&self) -> bool {
        self.on_mask.is_empty()
            && self.same.is_empty()
            && self.on_subject.is_empty()
            && self.on_self.is_empty()
    }

    /// Brings the touches of each edge in their order along it.
    fn sort(&mut self, subject: &Shapes, mask: &Shapes) {
        sort_along(&mut self.on_mask, mask, |&ours| subject.points()[ours]);
        self.same.sort_unstable();
        // Of several the first.
        self.same.dedup_by_key(|pair| pair.0);
    }
}

/// Brings points on edges, each with the index of its edge, in their order along that, each once.
fn sort_along<T>(touches: &mut Vec<(usize, T)>, of: &Shapes, place: impl Fn(&T) -> DVec2) {
    let along = |(edge, point): &(usize, T)| {
        let a = of.points()[*edge];
        let way = of.points()[of.next_point(*edge)] - a;
        (place(point) - a).dot(way)
    };
    let order = |p: DVec2, q: DVec2| p.order(q);
    touches.sort_by(|s, t| {
        let by_edge = s.0.cmp(&t.0).then_with(|| along(s).total_cmp(&along(t)));
        by_edge.then_with(|| order(place(&s.1), place(&t.1)))
    });
    touches.dedup_by(|s, t| s.0 == t.0 && place(&s.1) == place(&t.1));
}

/// Inserts the vertices of each operand into the edges of the other that they lie on; with `mend`, also the subject's
/// vertices into its own edges.
pub(super) fn conform(input: &Shapes, mask: Mask, mend: bool) -> (Subject<'_>, Mask) {
    let mut touches = Touches::between(input, &mask);
    if mend {
        touches.within(input);
    }
    if touches.is_empty() {
        return (Subject::plain(input), mask);
    }
    touches.sort(input, &mask.near.shapes);
    let subject = divide_subject(input, &mask, &touches);
    (subject, divide_mask(input, &mask, &touches))
}

fn divide_mask(input: &Shapes, mask: &Mask, touches: &Touches) -> Mask {
    let mut sources = mask.sources.clone();
    for &(edge, vertex) in &touches.on_subject {
        let p = mask.near.shapes.points()[vertex];
        sources[vertex] = on_edge(input, edge, p);
    }
    let mut points = mask.near.shapes.points().to_vec();
    for &(vertex, ours) in &touches.same {
        points[vertex] = input.points()[ours];
        sources[vertex] = VertexSource::Vertex(ours);
    }
    let mut divided = Mask::default();
    let mut inserted = touches.on_mask.iter().peekable();
    rebuild(&mask.near.shapes, &mut divided.near.shapes, |k, ring| {
        let mut push = |p: DVec2, source: VertexSource| {
            ring.push(p);
            divided.near.lines.push(mask.near.lines[k]);
            divided.sources.push(source);
        };
        push(points[k], sources[k]);
        while let Some(&(_, ours)) = inserted.next_if(|touch| touch.0 == k) {
            push(input.points()[ours], VertexSource::Vertex(ours));
        }
    });
    divided
}

fn divide_subject<'a>(input: &'a Shapes, mask: &Mask, touches: &Touches) -> Subject<'a> {
    let theirs = |&(edge, vertex): &(usize, usize)| (edge, mask.near.shapes.points()[vertex]);
    let own = |&(edge, vertex): &(usize, usize)| (edge, input.points()[vertex]);
    let inserted: Vec<(usize, DVec2)> =
        touches.on_subject.iter().map(theirs).chain(touches.on_self.iter().map(own)).collect();
    if inserted.is_empty() {
        return Subject::plain(input);
    }
    let divided = Some(with_points(input, inserted));
    Subject { input, divided }
}

/// Returns the shapes with points on edges, each with the first point of its edge, and where each point
/// comes from.
pub(super) fn with_points(
    input: &Shapes,
    mut inserted: Vec<(usize, DVec2)>,
) -> (Shapes, Vec<VertexSource>) {
    sort_along(&mut inserted, input, |&p| p);
    let (mut shapes, mut sources) = (Shapes::new(), Vec::new());
    let mut inserted = inserted.into_iter().peekable();
    rebuild(input, &mut shapes, |k, ring| {
        ring.push(input.points()[k]);
        sources.push(VertexSource::Vertex(k));
        while let Some((_, p)) = inserted.next_if(|touch| touch.0 == k) {
            ring.push(p);
            sources.push(on_edge(input, k, p));
        }
    });
    (shapes, sources)
}

fn on_edge(input: &Shapes, edge: usize, p: DVec2) -> VertexSource {
    let (a, next) = (input.points()[edge], input.next_point(edge));
    VertexSource::on_edge(p, (edge, a), (next, input.points()[next]))
}

/// Makes the same polygons with rings to which `push` adds the points for each point.
fn rebuild(from: &Shapes, to: &mut Shapes, mut push: impl FnMut(usize, &mut Vec<DVec2>)) {
    let mut points = Vec::new();
    for polygon in from.polygons() {
        for ring in polygon.ring_indices() {
            from.ring_range(ring).for_each(|k| push(k, &mut points));
            to.push_ring(points.drain(..));
        }
        to.end_polygon();
    }
}
