//! From the points of contours to edges: snapped, cut at the target, their joints found.

use std::ops::Range;

use super::edge::{BITS, Edge, MAX_SIDE, ONE, snap};
use super::joints::{Part, chain, chain_contour, chain_inner};
use crate::curve::Contours;
use crate::math::DVec2;
use crate::raster::bands::{CHUNK, Chunk, Edges, FEW_EDGES, by_chunks};
use crate::raster::clipped::{Lines, lines, pieces};

/// Extent of the edges of a path, and whether it has been cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    /// The least and the largest coordinates, 16.16.
    low: (i32, i32),
    high: (i32, i32),
    /// True if a line reached beyond the target.
    pub cut: bool,
}

impl Extent {
    /// Extent of nothing.
    pub const NONE: Self = Self { low: (i32::MAX, i32::MAX), high: (0, 0), cut: false };

    fn add(&mut self, (x, y): (i32, i32)) {
        self.low = (self.low.0.min(x), self.low.1.min(y));
        self.high = (self.high.0.max(x), self.high.1.max(y));
    }

    pub fn join(&mut self, other: Self) {
        self.low = (self.low.0.min(other.low.0), self.low.1.min(other.low.1));
        self.high = (self.high.0.max(other.high.0), self.high.1.max(other.high.1));
        self.cut |= other.cut;
    }

    /// Returns the first row touched and one past the last (not larger than the first if none is touched), then the
    /// first and last pixel touched.
    pub fn pixels(&self) -> [(i32, i32); 2] {
        if self.low.0 > self.high.0 {
            return [(i32::MAX, 0); 2];
        }
        let rows = (self.low.1 >> BITS, (self.high.1 + ONE - 1) >> BITS);
        [rows, (self.low.0 >> BITS, self.high.0 >> BITS)]
    }
}

/// Returns the edges of contours within a target of the given size in pixels, at most [`MAX_SIDE`] in each direction;
/// few edges are added to the list. Each contour is closed; points that are not finite are left out. The joints of
/// `convex` contours are not chained, because this is never needed.
pub(super) fn edges(
    contours: &Contours,
    (width, height): (u32, u32),
    convex: bool,
    list: &mut Vec<Edge>,
) -> (Edges<Edge>, Extent) {
    let size = size(width, height);
    let count = contours.points().len();
    if count <= FEW_EDGES {
        let first = list.len();
        let extent = Builder::new(list, size, !convex).add(contours, 0..count);
        return (Edges::from_list(list, first, Edge::rows), extent);
    }
    let (chunks, extent) = chunks(contours, size, convex, CHUNK);
    (Edges::from_chunks(chunks, list, Edge::rows), extent)
}

/// Returns the size of a target, at most [`MAX_SIDE`] in each direction.
pub(super) fn size(width: u32, height: u32) -> DVec2 {
    DVec2::new(f64::from(width.min(MAX_SIDE)), f64::from(height.min(MAX_SIDE)))
}

/// Returns the edges of contours in chunks of this many points; the number of points in a chunk changes nothing in
/// them.
pub(super) fn chunks(
    contours: &Contours,
    size: DVec2,
    convex: bool,
    points: usize,
) -> (Vec<Chunk<Edge>>, Extent) {
    let made = by_chunks(contours, points, |range| {
        let mut edges = Vec::with_capacity(range.len() + 1);
        let mut builder = Builder::new(&mut edges, size, !convex);
        let extent = builder.add(contours, range);
        let parts = builder.parts;
        // Most outlines far beyond the target have no edges on it.
        if edges.len() < edges.capacity() / 2 {
            edges.shrink_to_fit();
        }
        (Chunk::new(edges, Edge::rows), extent, parts)
    });
    let mut extent = Extent::NONE;
    let (mut chunks, mut parts) = (Vec::with_capacity(made.len()), Vec::new());
    for (at, (chunk, own, open)) in made.into_iter().enumerate() {
        extent.join(own);
        parts.extend(open.into_iter().map(|part| (at, part)));
        chunks.push(chunk);
    }
    for parts in parts.chunk_by(|a, b| a.1.contour == b.1.contour) {
        chain_parts(&mut chunks, parts);
    }
    (chunks, extent)
}

/// Chains the joints of a contour between the parts that were made in several chunks.
fn chain_parts(chunks: &mut [Chunk<Edge>], parts: &[(usize, Part)]) {
    let gaps = parts.iter().any(|(_, part)| part.gaps);
    let places = |parts: &[(usize, Part)]| -> Vec<(usize, usize)> {
        parts.iter().flat_map(|(at, part)| part.edges.clone().map(|i| (*at, i))).collect()
    };
    let with_ends: Vec<usize> = (0..parts.len()).filter(|i| parts[*i].1.ends.is_some()).collect();
    // Chaining needs consecutive edges: copies are chained, and the results written back.
    let mut on = |places: &[(usize, usize)], chain: &dyn Fn(&mut [Edge])| {
        let mut copy: Vec<Edge> = places.iter().map(|(at, i)| chunks[*at].edges[*i]).collect();
        chain(&mut copy);
        for ((at, i), copy) in places.iter().zip(&copy) {
            chunks[*at].edges[*i].chain_as(copy);
        }
    };
    // Without an end of a group anywhere, the whole contour is chained at once.
    let (Some(first), Some(last)) = (with_ends.first(), with_ends.last()) else {
        return on(&places(parts), &|edges| chain_contour(edges, gaps));
    };
    // From the last end of a part to the first one of the next.
    let after = |i: usize| {
        let (at, part) = &parts[i];
        let from = part.ends.map_or(part.edges.end, |ends| ends.1);
        (from..part.edges.end).map(move |i| (*at, i))
    };
    let until = |i: usize| {
        let (at, part) = &parts[i];
        let to = part.ends.map_or(part.edges.start, |ends| ends.0 + 1);
        (part.edges.start..to).map(move |i| (*at, i))
    };
    for pair in with_ends.windows(2) {
        let between = places(&parts[pair[0] + 1..pair[1]]);
        let all: Vec<_> = after(pair[0]).chain(between).chain(until(pair[1])).collect();
        on(&all, &|edges| chain(edges, None, gaps));
    }
    // The last chain closes the contour: from its last end, across its first point, to its first end.
    let before_closing: Vec<_> = after(*last).chain(places(&parts[last + 1..])).collect();
    let closing = before_closing.len();
    let begin = places(&parts[..*first]).into_iter().chain(until(*first));
    let all: Vec<_> = before_closing.into_iter().chain(begin).collect();
    on(&all, &|edges| chain(edges, Some(closing), gaps));
}

/// Builder of edges.
struct Builder<'a> {
    edges: &'a mut Vec<Edge>,
    /// Size of the target in pixels.
    size: DVec2,
    /// True if joints are to be chained.
    joints: bool,
    extent: Extent,
    /// Contours that others make parts of too.
    parts: Vec<Part>,
}

impl<'a> Builder<'a> {
    fn new(edges: &'a mut Vec<Edge>, size: DVec2, joints: bool) -> Self {
        Self { edges, size, joints, extent: Extent::NONE, parts: Vec::new() }
    }

    /// Adds the edges that begin in a range of all points.
    fn add(&mut self, contours: &Contours, range: Range<usize>) -> Extent {
        let mut before = range.start;
        for (points, own) in contours.within(range) {
            let contour = before - own.start;
            before += own.len();
            let (start, cut) = (self.edges.len(), self.extent.cut);
            self.extent.cut = false;
            self.lines(points, own.clone());
            let gaps = self.extent.cut;
            self.extent.cut |= cut;
            let edges = self.edges.get_mut(start..).filter(|_| self.joints).unwrap_or_default();
            if own.len() == points.len() {
                chain_contour(edges, gaps);
            } else if self.joints {
                let ends = chain_inner(edges, gaps).map(|(a, b)| (a + start, b + start));
                self.parts.push(Part { contour, edges: start..self.edges.len(), ends, gaps });
            }
        }
        self.extent
    }

    /// Adds the edges that begin at a range of a contour's points.
    fn lines(&mut self, points: &[DVec2], mut own: Range<usize>) {
        let size = self.size;
        let is_inside = |p: DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(size).all();
        while let Some(some) = Lines::next(points, &mut own, DVec2::ZERO, size) {
            match some {
                Lines::Inside(from, rest, next) => self.inside(from, rest, next),
                Lines::Any(points, own) => {
                    for (a, b) in lines(points, own) {
                        if is_inside(a) && is_inside(b) {
                            self.edge(snap(a), snap(b));
                        } else {
                            self.extent.cut = true;
                            self.clipped(a, b);
                        }
                    }
                }
            }
        }
    }

    /// Adds the edges along points that are all inside the target.
    #[inline(always)]
    fn inside(&mut self, from: &DVec2, rest: &[DVec2], next: &DVec2) {
        let mut extent = self.extent;
        let mut from = snap(*from);
        extent.add(from);
        for i in 0..=rest.len() {
            let to = snap(*rest.get(i).unwrap_or(next));
            extent.add(to);
            if from != to {
                self.edges.push(Edge::new(from, to));
            }
            from = to;
        }
        self.extent = extent;
    }

    /// Adds the part of a line that matters: within the rows, and left of the right border.
    fn clipped(&mut self, a: DVec2, b: DVec2) {
        if a.x.min(b.x) > self.size.x {
            return;
        }
        for (p, q) in pieces(a, b, DVec2::ZERO, self.size).into_iter().flatten() {
            if p != q && p.x.min(q.x) < self.size.x {
                self.edge(snap(p), snap(q));
            }
        }
    }

    fn edge(&mut self, from: (i32, i32), to: (i32, i32)) {
        if from != to {
            self.extent.add(from);
            self.extent.add(to);
            self.edges.push(Edge::new(from, to));
        }
    }
}
