//! The rings of both inputs in the order of processing, and their edges on the grid.

use std::ops::Range;

use super::grid::order_by_squares;
use super::lattice::{Coord, GridMap, Segment};
use super::parallel;
use super::{Operand, Source};
use crate::clip::polygon::{Shapes, Vertex};
use crate::math::{DVec2, Rect};

/// Number of points in one task: large enough to hide the cost of a task.
const TASK: usize = if cfg!(test) { 8 } else { 1 << 14 };

/// Rings per square of the rough grid that their order is taken from.
const PER_SQUARE: f64 = 4.0;

/// Rings stay in their order if at most one in this number starts away from the one before.
const FEW_JUMPS: usize = 8;

/// A ring of the input.
#[derive(Debug, Clone, Copy)]
struct Outline {
    operand: Operand,
    /// Indices into its operand's points: the first, and that behind the last.
    points: [u32; 2],
}

impl Outline {
    fn points(&self) -> Range<usize> {
        self.points[0] as usize..self.points[1] as usize
    }
}

/// The rings of both inputs, in the order in which they are processed.
#[derive(Debug)]
pub struct Outlines {
    rings: Vec<Outline>,
    /// End of each ring's edges among all edges.
    pub ends: Vec<u32>,
}

impl Outlines {
    /// Creates the rings that `matters` accepts, rings that start close together one after the other, so that later
    /// steps find their data in the cache.
    pub fn new<P: Vertex>(
        inputs: [(&Shapes<P>, Operand); 2],
        lattice: &P::Lattice,
        bounds: Rect,
        matters: impl Fn(Operand, &[P]) -> bool,
    ) -> Self {
        let count = inputs.iter().map(|(shapes, _)| shapes.ring_count()).sum();
        let (mut rings, mut starts) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for (shapes, operand) in inputs {
            for ring in 0..shapes.ring_count() {
                let points = shapes.ring_range(ring);
                let ring = &shapes.points()[points.clone()];
                let Some(&first) = ring.first() else { continue };
                if matters(operand, ring) {
                    let points = [points.start as u32, points.end as u32];
                    rings.push(Outline { operand, points });
                    starts.push(lattice.place(first));
                }
            }
        }
        if let Some(order) = order(&starts, bounds) {
            rings = order.iter().map(|&i| rings[i as usize]).collect();
        }
        let ends = parallel::ends(rings.iter().map(|ring: &Outline| ring.points().len()));
        Self { rings, ends }
    }

    /// Returns one segment for each point, that to the next point of its ring, which may be the
    /// same one.
    #[inline(never)]
    pub fn segments<P: Vertex, C: Coord>(
        &self,
        inputs: [&Shapes<P>; 2],
        lattice: &P::Lattice,
    ) -> (Vec<Segment<C>>, Vec<Source>) {
        let count = self.ends.last().copied().unwrap_or(0) as usize;
        let mut segments = parallel::filled(Segment::default(), count);
        let mut sources = parallel::filled(Source::default(), count);
        let tasks =
            segments.chunks_mut(TASK).zip(sources.chunks_mut(TASK)).zip((0..).step_by(TASK));
        parallel::map(tasks.collect(), |((segments, sources), start)| {
            self.fill(inputs, lattice, start, segments, sources);
        });
        (segments, sources)
    }

    /// Computes the edges from index `start` on.
    fn fill<P: Vertex, C: Coord>(
        &self,
        inputs: [&Shapes<P>; 2],
        lattice: &P::Lattice,
        start: usize,
        segments: &mut [Segment<C>],
        sources: &mut [Source],
    ) {
        let mut out = segments.iter_mut().zip(sources);
        let mut at = start;
        let end = start + out.len();
        let mut index = self.ends.partition_point(|&end| end as usize <= start);
        while at < end {
            let Outline { operand, .. } = self.rings[index];
            let points = self.rings[index].points();
            let range = parallel::range(&self.ends, index);
            let shapes = inputs[operand as usize];
            let point = |i: usize| lattice.snap::<C>(shapes.points()[i]);
            let first = points.start + (at - range.start);
            let last = points.start + (range.end.min(end) - range.start);
            let mut from = point(first);
            for ((segment, source), i) in out.by_ref().take(last - first).zip(first..last) {
                let to = point(if i + 1 < points.end { i + 1 } else { points.start });
                let reversed = from > to;
                let (a, b) = if reversed { (to, from) } else { (from, to) };
                *segment = Segment { a, b };
                *source = Source::new(i, reversed, operand);
                from = to;
            }
            at = range.end.min(end);
            index += 1;
        }
    }
}

/// Returns the order of points by the squares of a rough grid; `None` if they are in such an order.
fn order(points: &[DVec2], bounds: Rect) -> Option<Vec<u32>> {
    let size = bounds.max() - bounds.min();
    let squares = points.len() as f64 / PER_SQUARE;
    let side = (size.x / squares).max(1e-300) * size.y;
    let side = side.sqrt().max(size.max_element() / squares.max(1.0));
    if squares <= 1.0 || !side.is_normal() {
        return None;
    }
    let columns = (size.x / side) as usize + 1;
    let rows = (size.y / side) as usize + 1;
    let square = |i: usize| {
        let at = (points[i] - bounds.min()) / side;
        (at.y as usize).min(rows - 1) * columns + (at.x as usize).min(columns - 1)
    };
    order_by_squares(points.len(), [columns, rows], square, FEW_JUMPS)
}
