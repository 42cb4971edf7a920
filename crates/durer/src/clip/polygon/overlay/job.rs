//! The stages of one overlay, from rings to rings.

use super::arrangement::Arrangement;
use super::bounds::{check, union};
use super::edge::Inside;
use super::grid::{Block, Grid, Spread};
use super::lattice::{self, Coord, GridMap, Segment};
use super::noding::{self, Cause, Noding};
use super::outlines::Outlines;
use super::rings::{self, Rings};
use super::search::Search;
use super::{EdgeId, Operand, Options, Origin, Output, Source, Step, Winder, edges, parallel};
use crate::Result;
use crate::clip::polygon::{BooleanOp, Shapes, Vertex};
use crate::math::{DVec2, I64Vec2, Rect};
use crate::trace::Tracer;

/// Bytes of the lists for each edge of the input, without the edges themselves.
const PER_EDGE: u64 = 24;

/// Bytes of the graph and of the result for each node that an edge passes.
const PER_HIT: u64 = 64;

/// Input and options of an overlay.
pub struct Task<'a, P: Vertex> {
    pub subject: &'a Shapes<P>,
    pub clip: &'a Shapes<P>,
    pub op: BooleanOp,
    pub options: &'a Options,
    pub(crate) winder: Winder,
}

/// Overlays of points of one kind. Its functions are not generic, so that they are compiled once and not in each crate that
/// has a tracer of its own.
pub trait Solve: Sized {
    /// Overlays shapes; `report` returns whether it has a use for the steps.
    ///
    /// # Errors
    /// As [`overlay()`](super::overlay()).
    fn solve(
        task: &Task<'_, Self>,
        report: &mut dyn FnMut(Step<Self>) -> bool,
    ) -> Result<Output<Self>>
    where
        Self: Vertex;
}

impl Solve for DVec2 {
    fn solve(
        task: &Task<'_, Self>,
        report: &mut dyn FnMut(Step<Self>) -> bool,
    ) -> Result<Output<Self>> {
        solve(task, report)
    }
}

impl Solve for I64Vec2 {
    fn solve(
        task: &Task<'_, Self>,
        report: &mut dyn FnMut(Step<Self>) -> bool,
    ) -> Result<Output<Self>> {
        solve(task, report)
    }
}

fn solve<P: Vertex>(
    task: &Task<'_, P>,
    report: &mut dyn FnMut(Step<P>) -> bool,
) -> Result<Output<P>> {
    let &Task { subject, clip, op, options, winder } = task;
    let corners = check(subject, clip)?;
    let Some([low, high]) = union(corners) else { return Ok(Output::default()) };
    let lattice = P::Lattice::between(low, high, options.grid)?;
    let bounds = corners.map(|some| Rect::around(some?.map(|corner| lattice.place(corner))));
    let listens = report(Step::Grid { cell: lattice.cell() });
    let causes = listens || options.origins;
    let job = Job { subject, clip, op, options, lattice: &lattice, winder, bounds, causes };
    let t = &mut Listener { listens, report };
    let mut run = || if lattice.fits::<i32>() { job.run::<i32>(t) } else { job.run::<i64>(t) };
    let few = subject.points().len() + clip.points().len() < FEW;
    if few { parallel::alone(run) } else { run() }
}

/// Number of points below which one thread is as fast as several; unit tests of a few points run on several, too.
const FEW: usize = if cfg!(test) { 1 } else { 1 << 9 };

/// A tracer behind a pointer.
struct Listener<'a, P> {
    listens: bool,
    report: &'a mut dyn FnMut(Step<P>) -> bool,
}

impl<P> Tracer<Step<P>> for Listener<'_, P> {
    fn step(&mut self, make: impl FnOnce() -> Step<P>) {
        if self.listens {
            (self.report)(make());
        }
    }
}

/// One overlay.
struct Job<'a, P: Vertex> {
    subject: &'a Shapes<P>,
    clip: &'a Shapes<P>,
    op: BooleanOp,
    options: &'a Options,
    lattice: &'a P::Lattice,
    winder: Winder,
    /// The boxes around subject and clip.
    bounds: [Option<Rect>; 2],
    /// True if the cause of each node is to be kept.
    causes: bool,
}

impl<P: Vertex> Job<'_, P> {
    /// Runs the stages in their order.
    fn run<C: Coord>(&self, t: &mut Listener<P>) -> Result<Output<P>> {
        let work = &self.options.work;
        let points = (self.subject.points().len() + self.clip.points().len()) as u64;
        let _edges = work
            .charge("edges of the overlay", points * (size_of::<Segment<C>>() as u64 + PER_EDGE))?;
        let inputs = [(self.subject, Operand::Subject), (self.clip, Operand::Clip)];
        let corners = self.bounds.iter().flatten().flat_map(|r| [r.min(), r.max()]);
        let Some(around) = Rect::around(corners) else { return Ok(Output::default()) };
        let matters = |operand, ring: &[P]| self.matters(operand, ring);
        let outlines = Outlines::new(inputs, self.lattice, around, matters);
        let (segments, sources) =
            outlines.segments::<P, C>([self.subject, self.clip], self.lattice);
        let Some(block) = Block::around(&segments) else {
            return Ok(Output { cell: self.lattice.cell(), ..Output::default() });
        };
        let grid = Grid::new(&segments, block, Spread::of(&segments, block));
        let noding = noding::node(&segments, &grid, Some(&sources), self.causes, work)?;
        let _graph = work.charge("graph of the overlay", noding.hits.len() as u64 * PER_HIT)?;
        let search = Search { grid: &grid, segments: &segments, noding: &noding };
        let rings = edges::Rings { ends: &outlines.ends, sources: &sources };
        let graph = match self.winder {
            Winder::Parts => {
                let mut graph = Arrangement::of_rings(&noding, rings);
                graph.wind(&search);
                graph
            }
            Winder::Sweep => {
                let mut graph = Arrangement::of_straight(&noding, &sources);
                graph.sweep(&mut |p, active| {
                    t.step(|| Step::Sweep { at: self.lattice.unsnap(p), active });
                });
                graph
            }
        };
        let Options { subject_rule: subject, clip_rule: clip, .. } = *self.options;
        let inside = Inside { op: self.op, subject, clip };
        let kept = if self.options.drop_collinear { &[][..] } else { &noding.ends[..] };
        let rings = rings::link(graph, kept, &search, inside);
        self.report(&noding, t);
        work.check()?;
        Ok(self.output(&rings, &noding, &segments, &sources, t))
    }

    /// Returns whether a ring can affect the result, by bounding boxes alone: outside its box a
    /// ring encloses nothing, and an intersection lies in both boxes, a difference in the
    /// subject's.
    fn matters(&self, operand: Operand, ring: &[P]) -> bool {
        let other = match (self.op, operand) {
            (BooleanOp::Intersection, Operand::Subject) => self.bounds[1],
            (BooleanOp::Intersection | BooleanOp::Difference, Operand::Clip) => self.bounds[0],
            _ => return true,
        };
        let around = Rect::around(ring.iter().map(|&p| self.lattice.place(p)));
        matches!((around, other), (Some(a), Some(b)) if a.overlaps(&b))
    }

    #[inline(never)]
    fn report<C: Coord>(&self, noding: &Noding<C>, t: &mut Listener<P>) {
        for (&p, cause) in noding.nodes.iter().zip(noding.causes()) {
            if matches!(cause.get(), Cause::Crossing(..)) {
                t.step(|| Step::Crossing { at: self.lattice.unsnap(p) });
            }
        }
    }

    #[inline(never)]
    fn output<C: Coord>(
        &self,
        rings: &Rings,
        noding: &Noding<C>,
        segments: &[Segment<C>],
        sources: &[Source],
        t: &mut Listener<P>,
    ) -> Output<P> {
        let shapes = self.shapes(rings, noding);
        let mut origins = Vec::new();
        if self.options.origins {
            let nodes = rings.order.iter().flat_map(|&ring| rings.ring(ring));
            origins.extend(nodes.map(|&n| self.origin(n, noding, segments, sources)));
        }
        for polygon in shapes.polygons() {
            for (k, ring) in polygon.rings().enumerate() {
                t.step(|| Step::Ring { points: ring.to_vec(), hole: k > 0 });
            }
        }
        Output { shapes, origins, cell: self.lattice.cell() }
    }

    #[inline(never)]
    fn shapes<C: Coord>(&self, rings: &Rings, noding: &Noding<C>) -> Shapes<P> {
        /// Number of rings in one task.
        const TASK: usize = if cfg!(test) { 2 } else { 1 << 12 };
        let mut end = 0;
        let ring_ends = rings.order.iter().map(|&ring| {
            end += rings.ring(ring).len();
            end
        });
        let ring_ends: Vec<usize> = ring_ends.collect();
        let point = |node: &u32| self.lattice.unsnap(noding.nodes[*node as usize]);
        let points = if parallel::threads() == 1 {
            let mut points = Vec::with_capacity(end);
            rings.order.iter().for_each(|&ring| points.extend(rings.ring(ring).iter().map(point)));
            points
        } else {
            let mut points = parallel::filled(P::default(), end);
            let ends: Vec<u32> =
                ring_ends.chunks(TASK).filter_map(|some| Some(*some.last()? as u32)).collect();
            let tasks = parallel::cut(&mut points, &ends).into_iter();
            let tasks = tasks.zip(rings.order.chunks(TASK)).collect();
            parallel::map(tasks, |(points, order): (&mut [P], &[u32])| {
                let nodes = order.iter().flat_map(|&ring| rings.ring(ring));
                points.iter_mut().zip(nodes).for_each(|(to, node)| *to = point(node));
            });
            points
        };
        let polygon_ends = rings.polygon_ends.iter().map(|&end| end as usize).collect();
        Shapes::from_parts(points, ring_ends, polygon_ends)
    }

    fn origin<C: Coord>(
        &self,
        node: u32,
        noding: &Noding<C>,
        segments: &[Segment<C>],
        sources: &[Source],
    ) -> Origin {
        match noding.cause(node) {
            Cause::End(end) => {
                let source = sources[(end / 2) as usize];
                let edge = self.edge(source);
                let first = (end % 2 == 1) == source.reversed();
                let index = if first { edge.from } else { edge.to };
                Origin::Vertex { operand: edge.operand, index }
            }
            Cause::Crossing(i, j) => {
                let (s, t) = (&segments[i as usize], &segments[j as usize]);
                let (ts, tt) = (parameter(s, t), parameter(t, s));
                let along = |i: u32, t: f64| {
                    let source = sources[i as usize];
                    (self.edge(source), if source.reversed() { 1.0 - t } else { t })
                };
                Origin::Crossing { first: along(i, ts), second: along(j, tt) }
            }
        }
    }

    fn edge(&self, source: Source) -> EdgeId {
        let operand = source.operand();
        let shapes = match operand {
            Operand::Subject => self.subject,
            Operand::Clip => self.clip,
        };
        let from = source.point();
        EdgeId { operand, from, to: shapes.next_point(from) }
    }
}

/// Returns the parameter on `s` at which it crosses `other`, from 0 at its left end to 1.
fn parameter<C: Coord>(s: &Segment<C>, other: &Segment<C>) -> f64 {
    let left = C::approximate(lattice::cross(other.a, other.b, s.a));
    let right = C::approximate(lattice::cross(other.a, other.b, s.b));
    left / (left - right)
}
