//! From the grid back to exact places.

use super::CoverageCut;
use super::conform::{Mask, Subject};
use crate::clip::attribute::VertexSource;
use crate::clip::exact;
use crate::clip::polygon::Operand;
use crate::clip::polygon::overlay::{EdgeId, Origin, Output};
use crate::clip::polygon::validity::{Touching, faults};
use crate::clip::polygon::{Shapes, Vertex};
use crate::math::DVec2;

/// A point of the result.
#[derive(Debug, Clone, Copy)]
struct Point {
    exact: DVec2,
    /// Position on the grid.
    snapped: DVec2,
    source: VertexSource,
    /// True if it stays there.
    stays: bool,
}

impl Point {
    fn place(&self) -> DVec2 {
        if self.stays { self.snapped } else { self.exact }
    }
}

/// Moves the points of an overlay to the input's points and to the crossings of its edges; `keep` is the one of the
/// options.
pub(super) fn place(subject: &Subject, mask: &Mask, keep: bool, output: Output) -> CoverageCut {
    let placer = Placer { subject, mask, keep };
    let points = output.shapes.points().iter().zip(&output.origins);
    let mut points: Vec<Point> = points.map(|(&at, origin)| placer.point(at, origin)).collect();
    let kept = placer.kept(&output, &points);
    let shapes = settled(&output.shapes, &mut points, &kept);
    let left = || points.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(point, _)| point);
    let sources: Vec<VertexSource> = left().map(|point| point.source).collect();
    let snapped = left().filter(|point| point.stays).count();
    let whole = snapped == 0 && is_whole(subject.input(), &shapes, &sources);
    CoverageCut { shapes, sources, snapped, whole, lost: mask.loses(output.cell) }
}

struct Placer<'a> {
    subject: &'a Subject<'a>,
    mask: &'a Mask,
    keep: bool,
}

impl Placer<'_> {
    fn point(&self, snapped: DVec2, origin: &Origin) -> Point {
        match *origin {
            Origin::Vertex { operand, index } => {
                let (shapes, source) = match operand {
                    Operand::Subject => (self.subject.shapes(), self.subject.source(index)),
                    Operand::Clip => (&self.mask.near.shapes, self.mask.sources[index]),
                };
                Point { exact: shapes.points()[index], snapped, source, stays: false }
            }
            Origin::Crossing { first: (first, _), second: (second, _) } => {
                let exact = exact::crossing(self.line(first), self.line(second));
                let (at, stays) = (exact.unwrap_or(snapped), exact.is_none());
                let ours = [first, second].into_iter().find(|e| e.operand == Operand::Subject);
                let source = ours.map_or(VertexSource::Corner, |edge| self.source(edge, at));
                Point { exact: at, snapped, source, stays }
            }
        }
    }

    fn line(&self, edge: EdgeId) -> [DVec2; 2] {
        match edge.operand {
            Operand::Subject => {
                self.subject.edge(edge.from).map(|i| self.subject.input().points()[i])
            }
            Operand::Clip => self.mask.near.lines[edge.from],
        }
    }

    fn source(&self, edge: EdgeId, at: DVec2) -> VertexSource {
        let [from, to] = self.subject.edge(edge.from);
        let points = self.subject.input().points();
        VertexSource::on_edge(at, (from, points[from]), (to, points[to]))
    }

    /// Returns for each point whether it is needed. Not needed are points that coincide with the next of their ring,
    /// and vertices of the mask inside an edge of the subject that the mask's border follows on both sides of the
    /// vertex, where no neighbour shares them.
    fn kept(&self, output: &Output, points: &[Point]) -> Vec<bool> {
        let mut kept = vec![true; points.len()];
        for ring in 0..output.shapes.ring_count() {
            let range = output.shapes.ring_range(ring);
            let mut left = range.len();
            for k in range.clone() {
                let next = if k + 1 < range.end { k + 1 } else { range.start };
                let before = if k > range.start { k - 1 } else { range.end - 1 };
                let at = |k: usize| points[k].place();
                let drop = at(k) == at(next)
                    && !matches!(points[k].source, VertexSource::Vertex(_))
                    || !self.keep
                        && self.runs_along(&output.origins[k], &points[k], at(before), at(next));
                if drop && left > 3 {
                    kept[k] = false;
                    left -= 1;
                }
            }
        }
        kept
    }

    fn runs_along(&self, origin: &Origin, point: &Point, before: DVec2, next: DVec2) -> bool {
        let &Origin::Vertex { index, .. } = origin else { return false };
        let Origin::Vertex { operand: Operand::Clip, .. } = origin else {
            return false;
        };
        if !matches!(point.source, VertexSource::Cut { .. }) {
            return false;
        }
        let shapes = &self.mask.near.shapes;
        let around = [shapes.previous_point(index), shapes.next_point(index)];
        let [a, b] = around.map(|i| shapes.points()[i]);
        (a, b) == (before, next) || (b, a) == (before, next)
    }
}

/// Number of rounds in which only points around faults are put back on the grid; after them, all points are.
const ROUNDS: usize = 8;

/// Returns the polygons with the points that are kept; points at which rings would cross stay on the grid, where they
/// do not cross.
fn settled(output: &Shapes, points: &mut [Point], kept: &[bool]) -> Shapes {
    let names: Vec<usize> = (0..points.len()).filter(|&k| kept[k]).collect();
    for _ in 0..ROUNDS {
        let shapes = built(output, points, kept);
        let Some(faults) = faults(&shapes, Touching::AtVertices) else { break };
        if faults.is_empty() {
            return shapes;
        }
        let mut changed = false;
        for fault in faults {
            let point = &mut points[names[fault]];
            changed |= !point.stays;
            point.stays = true;
        }
        if !changed {
            break;
        }
    }
    points.iter_mut().for_each(|point| point.stays = true);
    built(output, points, kept)
}

fn built(output: &Shapes, points: &[Point], kept: &[bool]) -> Shapes {
    let mut shapes = Shapes::new();
    for polygon in output.polygons() {
        for ring in polygon.ring_indices() {
            let places = output.ring_range(ring).filter(|&k| kept[k]).map(|k| points[k].place());
            shapes.push_ring(places);
        }
        shapes.end_polygon();
    }
    shapes
}

/// Returns whether the result has the subject's points, edges and rings and no others.
fn is_whole(input: &Shapes, shapes: &Shapes, sources: &[VertexSource]) -> bool {
    let counts =
        |shapes: &Shapes| (shapes.points().len(), shapes.ring_count(), shapes.polygon_count());
    let all_vertices = sources.iter().all(|source| matches!(source, VertexSource::Vertex(_)));
    all_vertices && counts(input) == counts(shapes) && edges(input) == edges(shapes)
}

/// Returns all edges in an order of their own, without direction.
fn edges(shapes: &Shapes) -> Vec<[DVec2; 2]> {
    let order = |p: &DVec2, q: &DVec2| p.order(*q);
    let of_ring = |ring: &[DVec2]| -> Vec<[DVec2; 2]> {
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        ends.map(|(&a, &b)| if a.order(b).is_le() { [a, b] } else { [b, a] }).collect()
    };
    let mut edges: Vec<[DVec2; 2]> = shapes.rings().flat_map(of_ring).collect();
    edges.sort_by(|e, f| order(&e[0], &f[0]).then(order(&e[1], &f[1])));
    edges
}
