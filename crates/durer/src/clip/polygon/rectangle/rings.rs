//! Chains of one polygon's rings inside the window, and how they close to rings again.

use super::Step;
use super::border::{BorderPoint, corners, exact_cut};
use crate::clip::attribute::{Provenance, VertexSource};
use crate::clip::exact;
use crate::clip::line::cut_inside;
use crate::clip::polygon::{Ring, Shapes, signed_area};
use crate::math::{DVec2, Rect};
use crate::trace::Tracer;
use std::cmp::Ordering;
use std::ops::Range;

/// A part of a ring in the open window, from border to border; its points are in the scratch buffer.
#[derive(Debug, Clone)]
struct Chain {
    points: Range<usize>,
    entry: BorderPoint,
    exit: BorderPoint,
}

/// The state of one call: the output, and buffers that all polygons share.
pub(super) struct Clipper<P> {
    window: Rect,
    output: Shapes,
    sources: P,
    /// Points of chains, and of rings strictly inside.
    points: Vec<DVec2>,
    point_sources: P,
    chains: Vec<Chain>,
    /// Rings that are strictly inside or touch the border in one point from within.
    islands: Vec<Range<usize>>,
    /// True if an odd number of rings surrounds the whole window.
    surrounded: bool,
}

/// One ring in the direction in which its inside is on the left.
pub(super) struct Directed<'a> {
    /// Its index over all polygons.
    pub(super) number: usize,
    ring: &'a Ring,
    first: usize,
    backwards: bool,
}

/// Knowledge about rings before their edges are examined.
pub(super) trait Guide {
    /// Returns whether a ring runs counter-clockwise.
    fn turns_left(&self, number: usize, ring: &Ring) -> bool;
    /// Finds the ranges of edges, in their order, in which a walk once around from `start` may meet the
    /// open window.
    fn stretches(
        &self,
        window: &Rect,
        ring: &Directed<'_>,
        start: usize,
    ) -> impl Iterator<Item = Range<usize>>;
    /// Returns whether a point lies in a ring by the even-odd rule; exact but for points on the
    /// ring.
    fn holds(&self, ring: &Directed<'_>, p: DVec2) -> bool;
}

/// Search that examines every edge.
pub(super) struct Unprepared;

impl Guide for Unprepared {
    fn turns_left(&self, _number: usize, ring: &Ring) -> bool {
        signed_area(ring) > 0.0
    }

    #[inline]
    fn stretches(
        &self,
        _window: &Rect,
        ring: &Directed<'_>,
        start: usize,
    ) -> impl Iterator<Item = Range<usize>> {
        std::iter::once(start..start + ring.len())
    }

    fn holds(&self, ring: &Directed<'_>, p: DVec2) -> bool {
        contains(ring.ring, p)
    }
}

impl<'a> Directed<'a> {
    pub(super) fn new(shapes: &'a Shapes, number: usize, backwards: bool) -> Self {
        let first = shapes.ring_range(number).start;
        Self { number, ring: shapes.ring(number), first, backwards }
    }

    pub(super) fn len(&self) -> usize {
        self.ring.len()
    }

    /// Returns the index in the ring of the k-th point, counted around and around.
    #[inline]
    fn index(&self, k: usize) -> usize {
        let n = self.ring.len();
        let k = if k >= n { k - n } else { k };
        if self.backwards { n - 1 - k } else { k }
    }

    #[inline]
    pub(super) fn point(&self, k: usize) -> DVec2 {
        self.ring[self.index(k)]
    }

    fn source(&self, k: usize) -> usize {
        self.first + self.index(k)
    }
}

impl<P: Provenance> Clipper<P> {
    pub(super) fn new(window: &Rect) -> Self {
        Self {
            window: *window,
            output: Shapes::new(),
            sources: P::default(),
            points: Vec::new(),
            point_sources: P::default(),
            chains: Vec::new(),
            islands: Vec::new(),
            surrounded: false,
        }
    }

    pub(super) fn finish(self) -> (Shapes, P) {
        (self.output, self.sources)
    }

    /// Puts a polygon out as it is.
    pub(super) fn copy(&mut self, shapes: &Shapes, rings: Range<usize>) {
        for ring in rings {
            self.output.push_ring(shapes.ring(ring).iter().copied());
            self.sources.push_vertices(shapes.ring_range(ring));
        }
        self.output.end_polygon();
    }

    /// Clips a polygon that crosses the window's border or surrounds the window, given by its outer ring and its holes
    /// that are not outside the window.
    pub(super) fn cut(
        &mut self,
        shapes: &Shapes,
        rings: impl Iterator<Item = usize>,
        guide: &impl Guide,
        t: &mut impl Tracer<Step>,
    ) {
        self.points.clear();
        self.point_sources.truncate(0);
        self.chains.clear();
        self.islands.clear();
        self.surrounded = false;
        let size = self.window.size();
        if size.x == 0.0 || size.y == 0.0 {
            return;
        }
        for (k, number) in rings.enumerate() {
            let ring = shapes.ring(number);
            if ring.len() >= 3 {
                let backwards = guide.turns_left(number, ring) != (k == 0);
                self.collect(&Directed::new(shapes, number, backwards), guide, t);
            }
        }
        self.assemble(t);
    }

    /// Returns whether a point lies in the open window.
    #[inline]
    fn strictly_inside(&self, p: DVec2) -> bool {
        let (min, max) = (self.window.min(), self.window.max());
        p.x > min.x && p.x < max.x && p.y > min.y && p.y < max.y
    }

    /// Returns whether both points lie beyond or on the same border: no part between is strictly
    /// inside.
    #[inline]
    fn apart(&self, a: DVec2, b: DVec2) -> bool {
        let (min, max) = (self.window.min(), self.window.max());
        (a.x <= min.x && b.x <= min.x)
            || (a.x >= max.x && b.x >= max.x)
            || (a.y <= min.y && b.y <= min.y)
            || (a.y >= max.y && b.y >= max.y)
    }

    fn push(&mut self, point: DVec2, source: impl FnOnce() -> VertexSource) {
        self.points.push(point);
        self.point_sources.push(source);
    }

    /// Finds the chains of one ring.
    fn collect(&mut self, ring: &Directed<'_>, guide: &impl Guide, t: &mut impl Tracer<Step>) {
        let n = ring.ring.len();
        let Some(start) = (0..n).find(|&k| !self.strictly_inside(ring.point(k))) else {
            self.collect_island(ring);
            return;
        };
        let found_before = self.chains.len() + self.islands.len();
        let mut k = start;
        let mut a = ring.point(k);
        let window = self.window;
        for stretch in guide.stretches(&window, ring, start) {
            if k < stretch.start {
                k = stretch.start;
                a = ring.point(k);
            }
            while k < stretch.end {
                let b = ring.point(k + 1);
                if self.apart(a, b) {
                    a = b;
                    k += 1;
                    continue;
                }
                (k, a) = self.follow(ring, k, a, t);
            }
        }
        let found = self.chains.len() + self.islands.len();
        if found == found_before && guide.holds(ring, self.middle()) {
            self.surrounded = !self.surrounded;
        }
    }

    fn collect_island(&mut self, ring: &Directed<'_>) {
        let from = self.points.len();
        for k in 0..ring.ring.len() {
            self.push(ring.point(k), || VertexSource::Vertex(ring.source(k)));
        }
        self.islands.push(from..self.points.len());
    }

    /// Follows a ring from point k, which is not strictly inside, through the window if the edge
    /// leads there; the index and place of the next point that is not strictly inside.
    fn follow(
        &mut self,
        ring: &Directed<'_>,
        mut k: usize,
        a: DVec2,
        t: &mut impl Tracer<Step>,
    ) -> (usize, DVec2) {
        let from = self.points.len();
        let mut b = ring.point(k + 1);
        let Some(visible) = cut_inside(&self.window, a, b) else { return (k + 1, b) };
        if self.apart(visible.start, visible.end) {
            return (k + 1, b);
        }
        let entry = exact_cut(&self.window, visible.start, [a, b]);
        self.push_end(ring, k, entry);
        let entry = BorderPoint::new(&self.window, entry, [a, b]);
        let mut before = a;
        while self.strictly_inside(b) {
            k += 1;
            if self.points.last() != Some(&b) {
                self.push(b, || VertexSource::Vertex(ring.source(k)));
            }
            before = b;
            b = ring.point(k + 1);
        }
        let exit = cut_inside(&self.window, before, b).map_or(b, |visible| visible.end);
        let exit = exact_cut(&self.window, exit, [before, b]);
        let exit_edge = [b, before];
        self.push_end(ring, k, exit);
        let exit = BorderPoint::new(&self.window, exit, exit_edge);
        t.step(|| Step::Chain { entry: entry.point, exit: exit.point });
        let points = from..self.points.len();
        // A hole that touches the border in one point stays a hole: a ring must not touch itself.
        if entry.point == exit.point && signed_area(&self.points[points.clone()]) <= 0.0 {
            self.points.pop();
            self.point_sources.truncate(self.points.len());
            self.islands.push(from..self.points.len());
        } else {
            self.chains.push(Chain { points, entry, exit });
        }
        (k + 1, b)
    }

    /// Adds the end of a chain on the edge from point k: a vertex of the ring, or a cut.
    fn push_end(&mut self, ring: &Directed<'_>, k: usize, point: DVec2) {
        let (a, b) = (ring.point(k), ring.point(k + 1));
        let (from, to) = (ring.source(k), ring.source(k + 1));
        self.push(point, || VertexSource::on_edge(point, (from, a), (to, b)));
    }

    /// Returns the window's middle: inside of those rings that have no edge in the window and are
    /// around it.
    fn middle(&self) -> DVec2 {
        let (min, max) = (self.window.min(), self.window.max());
        min + (max - min) * 0.5
    }

    /// Closes the chains to rings and gives each its holes.
    fn assemble(&mut self, t: &mut impl Tracer<Step>) {
        let outlines = if self.chains.is_empty() { self.whole_window() } else { self.link() };
        let mut holes: Vec<(usize, Range<usize>)> = Vec::new();
        let mut outers: Vec<Range<usize>> = outlines;
        for island in std::mem::take(&mut self.islands) {
            if signed_area(&self.points[island.clone()]) > 0.0 {
                outers.push(island);
            } else {
                // The first point may be one in which the hole touches the outline.
                let second = self.points[(island.start + 1).min(island.end - 1)];
                let inside = |o: &Range<usize>| contains(&self.points[o.clone()], second);
                let owner = match &outers[..] {
                    [_] => Some(0),
                    several => several.iter().position(inside),
                };
                holes.extend(owner.map(|o| (o, island)));
            }
        }
        for (index, outer) in outers.into_iter().enumerate() {
            if outer.len() < 3 {
                continue;
            }
            self.put_out(outer, t);
            for (_, hole) in holes.iter().filter(|(owner, hole)| *owner == index && hole.len() > 2)
            {
                self.put_out(hole.clone(), t);
            }
            self.output.end_polygon();
            t.step(|| Step::PolygonDone);
        }
    }

    fn put_out(&mut self, ring: Range<usize>, t: &mut impl Tracer<Step>) {
        let points = &self.points[ring.clone()];
        for &point in points {
            t.step(|| Step::Vertex { point });
        }
        t.step(|| Step::RingDone);
        self.output.push_ring(points.iter().copied());
        self.sources.push_range(&self.point_sources, ring);
    }

    /// Adds the window as a ring, if no edge crosses it and it is inside the polygon; returns the range of its points.
    fn whole_window(&mut self) -> Vec<Range<usize>> {
        if !self.surrounded {
            return Vec::new();
        }
        let from = self.points.len();
        for corner in corners(&self.window) {
            self.push(corner, || VertexSource::Corner);
        }
        std::iter::once(from..self.points.len()).collect()
    }

    /// Joins chains along the border to rings, appended to the scratch buffer.
    fn link(&mut self) -> Vec<Range<usize>> {
        let mut ends: Vec<ChainEnd> = (0..self.chains.len())
            .flat_map(|chain| [true, false].map(|is_entry| ChainEnd { chain, is_entry }))
            .collect();
        ends.sort_by(|a, b| a.place(&self.chains).order(b.place(&self.chains)));
        let next = followers(&ends, self.chains.len());
        let mut rank = vec![[0, 0]; self.chains.len()];
        for (i, end) in ends.iter().enumerate() {
            rank[end.chain][usize::from(end.is_entry)] = i;
        }
        let mut done = vec![false; self.chains.len()];
        let mut outlines = Vec::new();
        for first in 0..self.chains.len() {
            let from = self.points.len();
            let mut chain = first;
            while !done[chain] {
                done[chain] = true;
                self.append(chain, from);
                let follower = next[chain];
                let passes_start = rank[follower][1] < rank[chain][0];
                self.append_corners(chain, follower, passes_start, from);
                chain = follower;
            }
            // The last point may be the first again.
            while self.points.len() > from + 1 && self.points.last() == Some(&self.points[from]) {
                self.points.pop();
            }
            self.point_sources.truncate(self.points.len());
            if self.points.len() > from {
                outlines.push(from..self.points.len());
            }
        }
        outlines
    }

    /// Appends a chain's points to the ring that began at `from`, without doubling its last point.
    fn append(&mut self, chain: usize, from: usize) {
        let mut range = self.chains[chain].points.clone();
        if self.points.len() > from && self.points.last() == self.points.get(range.start) {
            range.start += 1;
        }
        self.points.extend_from_within(range.clone());
        self.point_sources.repeat(range);
    }

    /// Appends the corners between the end of a chain and the beginning of the next.
    fn append_corners(&mut self, chain: usize, follower: usize, passes_start: bool, from: usize) {
        let leaving = self.chains[chain].exit.side;
        let entering = self.chains[follower].entry.side;
        let round = if passes_start { 4 } else { 0 };
        let corners = corners(&self.window);
        for side in leaving + 1..=entering + round {
            let corner = corners[side % 4];
            if self.points.last() != Some(&corner) && self.points.get(from) != Some(&corner) {
                self.push(corner, || VertexSource::Corner);
            }
        }
    }
}

/// One end of a chain, by the chain's index.
#[derive(Debug, Clone, Copy)]
struct ChainEnd {
    chain: usize,
    is_entry: bool,
}

impl ChainEnd {
    fn place<'a>(&self, chains: &'a [Chain]) -> &'a BorderPoint {
        let chain = &chains[self.chain];
        if self.is_entry { &chain.entry } else { &chain.exit }
    }
}

/// Returns for each chain the one that follows it on the border, given all ends in the order of the border.
///
/// If the polygon is valid, exits and entries alternate; otherwise they pair like brackets.
fn followers(ends: &[ChainEnd], chains: usize) -> Vec<usize> {
    let mut next = vec![usize::MAX; chains];
    let mut taken = vec![false; chains];
    let mut queued = vec![false; chains];
    let mut waiting = Vec::new();
    for end in ends.iter().chain(ends) {
        if !end.is_entry {
            if !std::mem::replace(&mut queued[end.chain], true) {
                waiting.push(end.chain);
            }
        } else if !taken[end.chain]
            && let Some(chain) = waiting.pop()
        {
            taken[end.chain] = true;
            next[chain] = end.chain;
        }
    }
    next
}

/// Returns whether a point lies in a ring by the even-odd rule; exact but for points on the ring.
pub(super) fn contains(ring: &Ring, p: DVec2) -> bool {
    let previous = ring.iter().cycle().skip(ring.len().saturating_sub(1));
    previous.zip(ring).filter(|(a, b)| crosses(**a, **b, p)).count() % 2 == 1
}

/// Returns whether an edge crosses the ray from a point to the right.
#[inline]
pub(super) fn crosses(a: DVec2, b: DVec2, p: DVec2) -> bool {
    let upwards = a.y <= p.y;
    let wanted = if upwards { Ordering::Greater } else { Ordering::Less };
    upwards != (b.y <= p.y) && exact::side(a, b, p) == wanted
}
