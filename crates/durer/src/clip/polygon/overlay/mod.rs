//! Boolean operations on any polygons, with valid polygons as the result: the robust door.
//!
//! The points are snapped to a grid, all edges are noded exactly and snap-rounded (Hobby,
//! *Practical segment intersection with finite precision output*, 1999; Guibas and Marimont 1998):
//! each grid cell that holds an end or a crossing is hot, and every edge through a hot cell is bent
//! to the cell's centre. So no vertex moves further than half a cell's diagonal. On the graph of
//! these edges winding numbers decide, by connected parts, and the border of the result is cut into
//! simple rings. All decisions are made with integers.
//!
//! Everything is done in patches of the plane that are small enough for the cache and need not know
//! of each other: bands of the grid, runs of its leaves, the nodes and edges found there, the
//! windings and rings among these. So threads have independent work, and what crosses the patches'
//! borders is joined afterwards in a fixed order: the result does not depend on their number. In
//! tests the patches are tiny.
//!
//! It takes 130 to 210 bytes per edge beside the input, the result included. There is no mode that
//! does without hot pixels: they cost less than a tenth of the time, and without them the graph is
//! not planar, so that windings would be wrong far from the place.

pub(crate) mod arrangement;
mod edge;
mod edges;
pub(crate) mod grid;
pub(crate) mod lattice;
pub(crate) mod noding;
mod outlines;
mod parallel;
mod rings;
pub(crate) mod search;
mod strips;
#[cfg(test)]
mod tests;
mod whole;
mod winding;

use super::{BooleanOp, FillRule, NestingTree, Shapes, Vertex};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::Tracer;
use crate::work::Work;
use crate::{Error, Result};

use arrangement::Arrangement;
use edge::Winding;
use grid::{Block, Grid, Spread};
use lattice::{Coord, GridMap, Segment};
use noding::{Cause, Ends, Noding};
use outlines::Outlines;
use rings::Rings;
use search::Search;

/// The facts.
pub const INFO: Info = Info {
    name: "overlay",
    title: "Overlay by snap rounding",
    authors: "J. D. Hobby; L. J. Guibas, D. H. Marimont; I. J. Balaban",
    year: 1999,
    source: "Practical segment intersection with finite precision output, \
             Computational Geometry 13(4)",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O((n + k) log n) time for n edges and k crossings on usual data, O(n + k) memory",
    limits: "at most 2^41 grid cells across, 2^29 points in subject and clip",
    pseudocode: &[
        "choose a grid; move all points to its cells",
        "find where edges cross; divide them at the cells that they pass",
        "sort edges that lie on one another into one",
        "for the lowest edge of each connected part: its winding number by a ray",
        "    carry it around every node from edge to edge",
        "    both sides of each edge now have the windings of subject and clip",
        "    an edge is kept if the result is on one of its sides only",
        "from each kept edge walk to the next one, the inside on the left:",
        "    back at the start, the ring is complete",
        "give each hole to the ring around it",
    ],
};

/// Options for an overlay.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// Fill rule of the subject.
    pub subject_rule: FillRule,
    /// Fill rule of the clip.
    pub clip_rule: FillRule,
    /// The size of a grid cell, in units of the coordinates. `None` takes the smallest power of two
    /// that leaves at most 2³⁰ cells across the input. Sizes that leave up to 2⁴¹ cells across are
    /// possible, at about twice the time. Powers of two are best: other sizes make grid points that
    /// have to be rounded to f64. Whole numbers are their own grid: 1 or `None`.
    pub grid: Option<f64>,
    /// True if [`Output::origins`] is wanted.
    pub origins: bool,
    /// True if vertices of the input are left out where the border of the result goes straight on. Else
    /// only what noding added is: neighbours that share a border, and heights along one, need them.
    pub drop_collinear: bool,
    /// Budget of memory, and whether to go on.
    pub work: Work,
}

impl Options {
    /// Creates the same fill rule for both.
    pub fn with_rule(rule: FillRule) -> Self {
        Self { subject_rule: rule, clip_rule: rule, ..Self::default() }
    }
}

/// Step of the overlay; coordinates are the caller's.
#[derive(Debug, Clone, PartialEq)]
pub enum Step<P = DVec2> {
    /// The grid was chosen.
    Grid {
        /// The size of a cell.
        cell: f64,
    },
    /// Two edges cross in this grid cell.
    Crossing {
        /// The centre of the cell.
        at: P,
    },
    /// The sweep line of [`super::vatti`] passed a node.
    Sweep {
        /// The node.
        at: P,
        /// Number of edges that the sweep line cuts just after it.
        active: usize,
    },
    /// A ring of the result.
    Ring {
        /// Its points.
        points: Vec<P>,
        /// True if it is a hole of the last ring that was none.
        hole: bool,
    },
}

impl<P> Step<P> {
    /// Returns the line of [`INFO`]'s pseudocode that runs, counted from 1.
    pub fn line(&self) -> usize {
        match self {
            Self::Grid { .. } => 1,
            Self::Crossing { .. } => 2,
            Self::Sweep { .. } => 5,
            Self::Ring { .. } => 9,
        }
    }
}

/// Rebuilds the result of an overlay from its steps.
pub fn replay<P: Vertex>(steps: &[Step<P>]) -> Shapes<P> {
    let mut shapes = Shapes::new();
    for step in steps {
        if let Step::Ring { points, hole } = step {
            if !hole {
                shapes.end_polygon();
            }
            shapes.push_ring(points.iter().copied());
        }
    }
    shapes.end_polygon();
    shapes
}

/// One of the two inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operand {
    /// The first.
    Subject,
    /// The second.
    Clip,
}

/// An edge of the input: from a point of a ring to the next point of that ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeId {
    /// Whose edge.
    pub operand: Operand,
    /// Index into [`Shapes::points`] of its first point.
    pub from: usize,
    /// Index into [`Shapes::points`] of its second point.
    pub to: usize,
}

/// Origin of a vertex of the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Origin {
    /// A point of the input.
    Vertex {
        /// Whose point.
        operand: Operand,
        /// Its index into [`Shapes::points`].
        index: usize,
    },
    /// A crossing of two edges; of more than two, one pair.
    Crossing {
        /// An edge, and how far along it the vertex lies: 0 at its first point, 1 at its second.
        first: (EdgeId, f64),
        /// The other edge, likewise.
        second: (EdgeId, f64),
    },
}

/// The result of [`overlay()`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Output<P = DVec2> {
    /// Valid polygons: outer rings run counter-clockwise (y up), holes clockwise; every ring starts
    /// with its smallest point (by x, then y), polygons and holes are sorted by their points.
    pub shapes: Shapes<P>,
    /// The origin of each of the shapes' points, if [`Options::origins`] requested them.
    pub origins: Vec<Origin>,
    /// The size of a grid cell.
    pub cell: f64,
}

impl<P: Vertex> Output<P> {
    /// Builds the tree of rings: islands in the holes that contain them.
    ///
    /// ```
    /// use durer::clip::polygon::{BooleanOp, Shapes, overlay::overlay};
    /// use durer::math::DVec2;
    /// use durer::trace::NoTrace;
    ///
    /// let square = |r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)].map(DVec2::from);
    /// let rings = Shapes::from_rings([1.0, 2.0, 3.0, 4.0].map(square));
    /// let out = overlay(&rings, &Shapes::new(), BooleanOp::Union, &Default::default(), &mut NoTrace)?;
    /// // Two polygons side by side: the outermost ring with its hole, and the island with its own.
    /// assert_eq!((out.shapes.polygon_count(), out.shapes.ring_count()), (2, 4));
    /// let tree = out.tree();
    /// assert_eq!(tree.roots(), [0]);
    /// assert_eq!((tree.children(0), tree.children(1), tree.children(2)), (&[1][..], &[2][..], &[3][..]));
    /// assert_eq!((tree.parent(3), tree.depth(3), tree.is_hole(3)), (Some(2), 3, true));
    /// # Ok::<(), durer::Error>(())
    /// ```
    pub fn tree(&self) -> NestingTree {
        NestingTree::of(&self.shapes)
    }

    /// Returns values at the result's points, from values at the input's points: copied at
    /// vertices, and at crossings interpolated along both edges and joined by `join` (subject's
    /// edge first where the edges are of both).
    pub fn attributes<V: Clone>(
        &self,
        at: impl Fn(Operand, usize) -> V,
        lerp: impl Fn(V, V, f64) -> V,
        join: impl Fn(V, V) -> V,
    ) -> Vec<V> {
        let along = |(edge, t): (EdgeId, f64)| {
            lerp(at(edge.operand, edge.from), at(edge.operand, edge.to), t)
        };
        let value = |origin: &Origin| match *origin {
            Origin::Vertex { operand, index } => at(operand, index),
            Origin::Crossing { first, second } => join(along(first), along(second)),
        };
        self.origins.iter().map(value).collect()
    }
}

/// Overlays two sets of polygons.
///
/// The input may be anything: rings that cross themselves or each other, spikes, repeated points;
/// the fill rules over all its rings decide which points it encloses. The result is valid in the
/// sense of OGC Simple Features: simple rings, disjoint interiors, holes inside their own outer
/// ring, each polygon's interior connected. It does not depend on the order of the rings, their
/// starting points, or the number of threads.
///
/// Points are [`DVec2`], which are snapped to a grid, or [`I64Vec2`](crate::math::I64Vec2), which are
/// taken as they are: any coordinates of which no two lie further apart than 2⁴¹ − 2, also beyond the
/// 2⁵³ that f64 holds. Crossings are rounded to the nearest whole numbers, ties up and to the right.
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, overlay};
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let square = |x: f64| [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0.0)]), Shapes::from_rings([square(1.0)]));
/// let both = overlay::overlay(&a, &b, BooleanOp::Intersection, &Default::default(), &mut NoTrace)?;
/// assert_eq!(both.shapes.area(), 1.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// With whole numbers:
///
/// ```
/// use durer::clip::polygon::{BooleanOp, Shapes, overlay};
/// use durer::math::I64Vec2;
/// use durer::trace::NoTrace;
///
/// let far = i64::MAX - 10;
/// let square = |x: i64| [(0, 0), (3, 0), (3, 3), (0, 3)].map(|(u, v)| I64Vec2::new(far + x + u, x + v));
/// let (a, b) = (Shapes::from_rings([square(0)]), Shapes::from_rings([square(1)]));
/// let both = overlay::overlay(&a, &b, BooleanOp::Intersection, &Default::default(), &mut NoTrace)?;
/// assert_eq!(both.shapes.ring(0)[0], I64Vec2::new(far + 1, 1));
/// assert_eq!(both.shapes.area(), 4.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a coordinate that is not finite, [`Error::Parameter`] for a grid that is
/// not positive or too fine and for coordinates beyond ±1e300, [`Error::Limit`] for too many points
/// and for whole numbers too far apart; those of [`Options::work`].
pub fn overlay<P: Vertex>(
    subject: &Shapes<P>,
    clip: &Shapes<P>,
    op: BooleanOp,
    options: &Options,
    t: &mut impl Tracer<Step<P>>,
) -> Result<Output<P>> {
    solve(subject, clip, op, options, Winder::Parts, t)
}

/// Method for finding winding numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Winder {
    /// By connected parts of the graph.
    Parts,
    /// By a sweep with a list of active edges.
    Sweep,
}

pub(super) fn solve<P: Vertex>(
    subject: &Shapes<P>,
    clip: &Shapes<P>,
    op: BooleanOp,
    options: &Options,
    winder: Winder,
    t: &mut impl Tracer<Step<P>>,
) -> Result<Output<P>> {
    let corners = check(subject, clip)?;
    let Some([low, high]) = union(corners) else { return Ok(Output::default()) };
    let lattice = P::Lattice::between(low, high, options.grid)?;
    let bounds = corners.map(|some| Rect::around(some?.map(|corner| lattice.place(corner))));
    let mut listens = false;
    t.step(|| {
        listens = true;
        Step::Grid { cell: lattice.cell() }
    });
    let causes = listens || options.origins;
    let job = Job { subject, clip, op, options, lattice: &lattice, winder, bounds, causes };
    if lattice.fits::<i32>() { job.run::<i32>(t) } else { job.run::<i64>(t) }
}

/// Bytes of the lists for each edge of the input, the edges themselves aside.
const PER_EDGE: u64 = 24;

/// Bytes of the graph and of the result for each node that an edge passes.
const PER_HIT: u64 = 64;

/// Limit on points, so that an edge's index and two flags fit 32 bits, and twice an edge's index
/// too.
const MOST_POINTS: usize = 1 << 29;

/// The smallest and the largest coordinates.
type Corners<P> = [P; 2];

/// Returns the boxes around subject and clip.
fn check<P: Vertex>(subject: &Shapes<P>, clip: &Shapes<P>) -> Result<[Option<Corners<P>>; 2]> {
    let count = subject.points().len() + clip.points().len();
    if count > MOST_POINTS {
        let (value, limit) = (count as u64, MOST_POINTS as u64);
        return Err(Error::Limit { what: "points", value, limit });
    }
    Ok([corners(subject.points(), 0)?, corners(clip.points(), subject.points().len())?])
}

/// Returns the box around points; `before` is how many points come before them in the caller's
/// count.
fn corners<P: Vertex>(points: &[P], before: usize) -> Result<Option<Corners<P>>> {
    /// Number of points in one task.
    const TASK: usize = if cfg!(test) { 8 } else { 1 << 16 };
    let tasks = parallel::ranges(points.len(), TASK);
    let boxes = parallel::map(tasks, |range| {
        let points = &points[range.clone()];
        match points.iter().position(|p| !p.is_finite()) {
            Some(i) => Err(range.start + i),
            None => Ok(around(points.iter().copied())),
        }
    });
    let mut all = None;
    for one in boxes {
        let one = one.map_err(|i| Error::NonFinite { what: "point", index: before + i })?;
        all = union([all, one]);
    }
    Ok(all)
}

fn around<P: Vertex>(mut points: impl Iterator<Item = P>) -> Option<Corners<P>> {
    let first = points.next()?;
    Some(points.fold([first; 2], |[low, high], p| [low.low(p), high.high(p)]))
}

fn union<P: Vertex>(boxes: [Option<Corners<P>>; 2]) -> Option<Corners<P>> {
    around(boxes.into_iter().flatten().flatten())
}

/// An input edge behind a segment: the index of its first point, whether the segment runs against
/// it, and whose it is.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Source(u32);

impl Source {
    fn new(point: usize, reversed: bool, operand: Operand) -> Self {
        let clip = operand == Operand::Clip;
        Self((point as u32) << 2 | u32::from(reversed) << 1 | u32::from(clip))
    }

    fn point(self) -> usize {
        (self.0 >> 2) as usize
    }

    fn reversed(self) -> bool {
        self.0 & 2 != 0
    }

    fn operand(self) -> Operand {
        if self.0 & 1 == 0 { Operand::Subject } else { Operand::Clip }
    }

    /// Winding on the left less winding on the right, in the direction of its ring.
    fn across(self) -> Winding {
        match self.operand() {
            Operand::Subject => Winding { subject: 1, clip: 0 },
            Operand::Clip => Winding { subject: 0, clip: 1 },
        }
    }
}

struct Job<'a, P: Vertex> {
    subject: &'a Shapes<P>,
    clip: &'a Shapes<P>,
    op: BooleanOp,
    options: &'a Options,
    lattice: &'a P::Lattice,
    winder: Winder,
    /// The boxes around subject and clip.
    bounds: [Option<Rect>; 2],
    /// True if somebody wants to know what made each node.
    causes: bool,
}

impl<P: Vertex> Job<'_, P> {
    /// Returns the order of the stages.
    fn run<C: Coord>(&self, t: &mut impl Tracer<Step<P>>) -> Result<Output<P>> {
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
        let ends = |i: u32| if sources[i as usize].reversed() { Ends::Second } else { Ends::First };
        let noding = noding::node(&segments, &grid, ends, self.causes, work)?;
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
                graph.sweep(|p, active| {
                    t.step(|| Step::Sweep { at: self.lattice.unsnap(p), active });
                });
                graph
            }
        };
        let (subject, clip) = (self.options.subject_rule, self.options.clip_rule);
        let inside = |w: Winding| self.op.keeps(subject.fills(w.subject), clip.fills(w.clip));
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
    fn report<C: Coord>(&self, noding: &Noding<C>, t: &mut impl Tracer<Step<P>>) {
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
        t: &mut impl Tracer<Step<P>>,
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
