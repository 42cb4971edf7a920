//! Polylines against a polygon with holes: the part inside or outside, in pieces.
//!
//! Every piece keeps its polyline's index and direction; it is cut only where it crosses the polygon's border, not
//! where it crosses itself. The polygon is closed: a run along its border is inside. Attributes are carried by the
//! sources of the vertices ([`crate::clip::attribute`]). For a rectangle call
//! [`crate::clip::polygon::rectangle::clip_lines`], which is much faster.
//!
//! Which edges a segment meets is decided exactly, by orientations; a vertex of either that is on the other up to the
//! rounding of its coordinates counts as on it, so that clipping again changes nothing. The places of other cuts are
//! correctly rounded, and parts of a segment between two cuts that round to one point are ignored. The middle of the
//! part between two cuts decides, exactly, whether it is inside, by the even-odd rule.
//!
//! Object space. The border's edges are kept in horizontal slabs, so a segment is compared only with edges at its own
//! heights: O(n·e/s) for n segments, e edges, s ≈ √e slabs crossed by a segment's extent.

use crate::clip::attribute::VertexSource;
use crate::clip::exact::{crossing, side};
use crate::clip::polygon::Shapes;
use crate::clip::polygon::rectangle::{ClippedLines, Near, Prepared};
use crate::clip::touch::{are_one, is_on, reach};
use crate::info::{Class, Info, Occluder};
use crate::math::{DVec2, Rect};
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::cmp::Ordering;

/// The facts of clipping polylines.
pub const INFO: Info = Info {
    name: "polyline",
    title: "Polylines against a polygon",
    authors: "M. Shimrat",
    year: 1962,
    source: "Algorithm 112: position of point relative to polygon, Communications of the ACM \
             5(8); applied to the middle of each piece between two crossings",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n e / s + k log k) for n segments, e edges of the polygon in s slabs, s about \
             the root of e, k cuts; O(e) memory",
    limits: "even-odd rule; parts between cuts that round to one point are ignored",
    pseudocode: &[
        "for each segment of each polyline:",
        "    find the edges of the polygon that it crosses",
        "    sort the crossings along the segment",
        "    for each part between two neighbouring crossings:",
        "        M := middle of the part",
        "        M is inside if a ray from it crosses an odd number of edges",
        "        judge the part as M",
        "    join parts that are kept to pieces",
    ],
};

/// Part of the polylines to keep: inside or outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KeptPart {
    /// In the closed polygon.
    #[default]
    Inside,
    /// Outside the closed polygon.
    Outside,
}

/// Options for clipping polylines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Part of the polylines to keep: inside or outside.
    pub part: KeptPart,
}

/// Step of the algorithm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A part of a segment, between cuts or ends, was judged.
    Part {
        /// The polyline.
        line: usize,
        /// The segment: the index of its first point in the flat buffer.
        segment: usize,
        /// Start of the part.
        start: DVec2,
        /// End of the part.
        end: DVec2,
        /// True if it is in the closed polygon.
        inside: bool,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Part { .. } => 7,
        }
    }
}

/// Returns the pieces that a list of steps leads to, each with its polyline.
pub fn replay(options: &Options, steps: &[Step]) -> Vec<(usize, Vec<DVec2>)> {
    let mut pieces: Vec<(usize, Vec<DVec2>)> = Vec::new();
    let mut open = None;
    for step in steps {
        let Step::Part { line, start, end, inside, .. } = *step;
        if inside != (options.part == KeptPart::Inside) {
            open = None;
            continue;
        }
        match pieces.last_mut() {
            Some((_, piece)) if open == Some(line) => piece.push(end),
            _ => pieces.push((line, vec![start, end])),
        }
        open = Some(line);
    }
    pieces
}

/// Returns the part of polylines inside or outside a polygon with holes, given by all its rings (any direction,
/// even-odd); `ends[i]` is where polyline i ends in `points`.
///
/// ```
/// use durer::clip::polyline::{Options, clip};
/// use durer::clip::polygon::Shapes;
/// use durer::math::DVec2;
/// use durer::trace::NoTrace;
///
/// let p = DVec2::new;
/// let diamond = Shapes::from_rings([[p(2.0, 0.0), p(4.0, 2.0), p(2.0, 4.0), p(0.0, 2.0)]]);
/// let line = [p(-1.0, 2.0), p(2.0, 2.0), p(2.0, 9.0)];
/// let clipped = clip(&diamond, &line, &[3], &Options::default(), &mut NoTrace)?;
/// assert_eq!(clipped.points, [p(0.0, 2.0), p(2.0, 2.0), p(2.0, 4.0)]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a NaN or infinite coordinate; [`Error::Dangling`] for an end beyond the
/// points or before the end of the polyline before.
pub fn clip(
    polygon: &Shapes,
    points: &[DVec2],
    ends: &[usize],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<ClippedLines> {
    for (what, all) in [("polygon point", polygon.points()), ("point", points)] {
        if let Some(index) = all.iter().position(|p| !p.is_finite()) {
            return Err(Error::NonFinite { what, index });
        }
    }
    run(&Near::all(polygon.clone()), points, ends, options, t)
}

/// Clips polylines as [`clip`], for prepared polygons: only those near the polylines are examined.
///
/// # Errors
/// As [`clip`].
pub fn clip_prepared(
    polygons: &Prepared,
    points: &[DVec2],
    ends: &[usize],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<ClippedLines> {
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "point", index });
    }
    let bounds = Rect::around(points.iter().copied());
    let near = bounds.map(|bounds| Near::around(polygons, &bounds)).unwrap_or_default();
    run(&near, points, ends, options, t)
}

fn run(
    polygon: &Near,
    points: &[DVec2],
    ends: &[usize],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<ClippedLines> {
    let border = Border::new(polygon);
    let mut out = ClippedLines::default();
    let mut first = 0;
    for (line, &end) in ends.iter().enumerate() {
        let count = points.len();
        let part =
            points.get(first..end).ok_or(Error::Dangling { what: "point", index: end, count })?;
        clip_one(&border, part, (line, first), options, &mut out, t);
        first = end;
    }
    Ok(out)
}

fn clip_one(
    border: &Border,
    part: &[DVec2],
    (line, first): (usize, usize),
    options: &Options,
    out: &mut ClippedLines,
    t: &mut impl Tracer<Step>,
) {
    let mut open = false;
    // Whether the polyline's last part was inside; known as long as no edge has been met since.
    let mut known = None;
    for (k, pair) in part.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let segment = first + k;
        let source = |p: DVec2| VertexSource::on_edge(p, (segment, a), (segment + 1, b));
        let cuts = border.cuts(a, b);
        if !cuts.is_empty() {
            known = None;
        }
        // Parts on the same side are joined: where the line only touches the border, it is not cut.
        let mut parts: Vec<(DVec2, DVec2, bool)> = Vec::new();
        for (start, end) in cuts.parts(a, b) {
            let inside = known.unwrap_or_else(|| {
                cuts.on_border(start, end) || border.contains_middle(start, end)
            });
            // Kept or not: which part is requested has no say in it.
            if cuts.is_empty() {
                known = Some(inside);
            }
            match parts.last_mut() {
                Some(last) if last.2 == inside => last.1 = end,
                _ => parts.push((start, end, inside)),
            }
        }
        for (start, end, inside) in parts {
            t.step(|| Step::Part { line, segment, start, end, inside });
            if inside != (options.part == KeptPart::Inside) {
                out.end_piece(line);
                open = false;
                continue;
            }
            if !open {
                out.points.push(start);
                out.sources.push(source(start));
            }
            out.points.push(end);
            out.sources.push(source(end));
            open = true;
        }
    }
    out.end_piece(line);
}

/// Intersections of a segment with the border: points in its order, and stretches that run along an
/// edge.
struct Cuts {
    points: Vec<DVec2>,
    along: Vec<(DVec2, DVec2)>,
}

impl Cuts {
    fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the parts between the cuts, those without length left out.
    fn parts(&self, a: DVec2, b: DVec2) -> Vec<(DVec2, DVec2)> {
        let stops: Vec<DVec2> =
            std::iter::once(a).chain(self.points.iter().copied()).chain([b]).collect();
        stops.windows(2).map(|w| (w[0], w[1])).filter(|(p, q)| p != q).collect()
    }

    /// Returns whether a part between two neighbouring cuts lies in a stretch along the border.
    fn on_border(&self, start: DVec2, end: DVec2) -> bool {
        let between = |p: DVec2, (from, to): (DVec2, DVec2)| {
            let (low, high) = (from.min(to), from.max(to));
            p.cmpge(low).all() && p.cmple(high).all()
        };
        self.along.iter().any(|&s| between(start, s) && between(end, s))
    }
}

/// The polygon's edges in horizontal slabs of equal height.
struct Border {
    bounds: Option<Rect>,
    slabs: Vec<Vec<Edge>>,
}

/// An edge of the polygon.
#[derive(Debug, Clone, Copy)]
struct Edge {
    ends: [DVec2; 2],
    /// The edge that it is part of.
    line: [DVec2; 2],
}

impl Border {
    fn new(polygon: &Near) -> Self {
        let count = libm::sqrt(polygon.lines.len() as f64) as usize + 1;
        let mut border = Self { bounds: polygon.shapes.bounds(), slabs: vec![Vec::new(); count] };
        let ends = polygon
            .shapes
            .rings()
            .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]));
        for (ends, &line) in ends.zip(&polygon.lines).filter(|([a, b], _)| a != b) {
            let [a, b] = ends;
            for slab in border.slabs_of(a.y.min(b.y), a.y.max(b.y)) {
                border.slabs[slab].push(Edge { ends, line });
            }
        }
        border
    }

    /// Returns the slabs that the heights from `low` to `high` touch.
    fn slabs_of(&self, low: f64, high: f64) -> std::ops::RangeInclusive<usize> {
        let index = |y: f64| {
            let Some(bounds) = self.bounds else { return 0 };
            // Halves, because the height of the whole may overflow.
            let (from, height) = (bounds.min().y, bounds.max().y * 0.5 - bounds.min().y * 0.5);
            let slab = (y * 0.5 - from * 0.5) / height * self.slabs.len() as f64;
            (slab.max(0.0) as usize).min(self.slabs.len() - 1)
        };
        index(low)..=index(high)
    }

    /// Returns all places where the closed segment meets the border, in the segment's direction.
    fn cuts(&self, a: DVec2, b: DVec2) -> Cuts {
        let mut cuts = Cuts { points: Vec::new(), along: Vec::new() };
        let Some(extent) = Rect::around([a, b]) else { return cuts };
        let margin = 2.0 * reach(a.abs().max(b.abs()));
        let near = Rect::new(extent.min() - margin, extent.max() + margin).unwrap_or(extent);
        if self.bounds.is_none_or(|bounds| !bounds.overlaps(&near)) {
            return cuts;
        }
        for slab in self.slabs_of(near.min().y, near.max().y) {
            for edge in &self.slabs[slab] {
                let [c, d] = edge.ends;
                let beside = c.min(d).cmple(near.max()).all() && c.max(d).cmpge(near.min()).all();
                if beside {
                    meet([a, b], edge, &mut cuts);
                }
            }
        }
        // Keeps rounding from changing the order.
        let axis = longer_axis(a, b);
        cuts.points
            .sort_by(|p, q| p[axis].total_cmp(&q[axis]).then(p[1 - axis].total_cmp(&q[1 - axis])));
        if a[axis] > b[axis] {
            cuts.points.reverse();
        }
        cuts.points.dedup();
        cuts
    }

    /// Returns whether the middle of a part that crosses no edge is inside, by the even-odd rule.
    fn contains_middle(&self, start: DVec2, end: DVec2) -> bool {
        let p = start * 0.5 + end * 0.5;
        if self.bounds.is_none_or(|bounds| !bounds.contains(p)) {
            return false;
        }
        let crosses = |edge: &&Edge| {
            let [a, b] = &edge.ends;
            let upwards = a.y <= p.y;
            let wanted = if upwards { Ordering::Greater } else { Ordering::Less };
            upwards != (b.y <= p.y) && side(*a, *b, p) == wanted
        };
        let slab = *self.slabs_of(p.y, p.y).start();
        self.slabs[slab].iter().filter(crosses).count() % 2 == 1
    }
}

/// Returns the axis on which a segment is longer; halves, because the difference may overflow.
fn longer_axis(a: DVec2, b: DVec2) -> usize {
    let d = (b * 0.5 - a * 0.5).abs();
    usize::from(d.y > d.x)
}

/// Adds where a segment meets an edge.
fn meet(segment: [DVec2; 2], edge: &Edge, cuts: &mut Cuts) {
    let [a, b] = segment;
    // A vertex of the edge that is as good as an end of the segment is that.
    let own = |p: DVec2| segment.into_iter().find(|&end| are_one(end, p)).unwrap_or(p);
    let [c, d] = edge.ends.map(own);
    let met = |p: DVec2| p == c || p == d || is_on(p, edge.ends, edge.line);
    let mut touches = [a, b].into_iter().filter(|&p| met(p)).collect::<Vec<_>>();
    touches.extend([c, d].into_iter().filter(|&p| p != a && p != b && is_on(p, segment, segment)));
    let axis = longer_axis(a, b);
    touches.sort_by(|p, q| p[axis].total_cmp(&q[axis]));
    let [Some(&first), Some(&last)] = [touches.first(), touches.last()] else {
        let crossed = side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
        let point = if crossed { crossing(segment, edge.line) } else { None };
        // A point cut from the edge's line may miss it by its own rounding.
        let point = point.or_else(|| if crossed { crossing(segment, edge.ends) } else { None });
        return cuts.points.extend(point);
    };
    // With two points in common they run along each other.
    if first != last {
        cuts.along.push((first, last));
    }
    cuts.points.extend(touches);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::polygon::rectangle::clip_lines;
    use crate::trace::{NoTrace, Recorder};
    use proptest::prelude::*;

    fn p(x: i32, y: i32) -> DVec2 {
        DVec2::new(x.into(), y.into())
    }

    fn frame() -> Shapes {
        Shapes::from_rings([
            [p(0, 0), p(6, 0), p(6, 6), p(0, 6)],
            [p(2, 2), p(2, 4), p(4, 4), p(4, 2)],
        ])
    }

    #[test]
    fn a_hole_splits_and_a_crossing_of_itself_does_not() {
        let line = [p(-1, 1), p(5, 1), p(5, 5), p(1, 5), p(1, -1)];
        let out = clip(&frame(), &line, &[5], &Options::default(), &mut NoTrace).unwrap();
        assert_eq!(out.points, [p(0, 1), p(5, 1), p(5, 5), p(1, 5), p(1, 0)]);
        let across = [p(-1, 3), p(7, 3)];
        let out = clip(&frame(), &across, &[2], &Options::default(), &mut NoTrace).unwrap();
        let pieces: Vec<_> = out.pieces().map(|(_, piece)| piece.to_vec()).collect();
        assert_eq!(pieces, [vec![p(0, 3), p(2, 3)], vec![p(4, 3), p(6, 3)]]);
        assert_eq!(out.sources[1], VertexSource::Cut { from: 0, to: 1, t: 0.375 });
    }

    #[test]
    fn runs_along_the_border_are_inside() {
        for line in [[p(-1, 0), p(7, 0)], [p(2, 1), p(2, 5)]] {
            let inside = clip(&frame(), &line, &[2], &Options::default(), &mut NoTrace).unwrap();
            let ends = (inside.points[0], inside.points[inside.points.len() - 1]);
            assert_eq!(
                (inside.ends.len(), ends),
                (1, (line[0].max(p(0, 0)), line[1].min(p(6, 6))))
            );
            let part = KeptPart::Outside;
            let outside = clip(&frame(), &line, &[2], &Options { part }, &mut NoTrace).unwrap();
            assert_eq!(outside.ends.len(), if line[0].y == 0.0 { 2 } else { 0 });
        }
    }

    #[test]
    fn what_only_touches_the_border_is_not_cut() {
        // Past a corner of the frame; inside it, past corners of its hole and along an edge of the hole.
        for (line, part) in [
            ([p(-1, 1), p(1, -1)], KeptPart::Outside),
            ([p(1, 3), p(3, 1)], KeptPart::Inside),
            ([p(2, 1), p(2, 5)], KeptPart::Inside),
        ] {
            let out = clip(&frame(), &line, &[2], &Options { part }, &mut NoTrace).unwrap();
            assert_eq!(out.points, line, "{part:?}");
        }
    }

    fn length(lines: &ClippedLines) -> f64 {
        lines
            .pieces()
            .map(|(_, piece)| piece.windows(2).map(|w| (w[1] - w[0]).length()).sum::<f64>())
            .sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(10_000))]

        #[test]
        fn inside_and_outside_make_the_whole(points in prop::collection::vec((-2i32..=8, -2i32..=8), 2..8)) {
            let line: Vec<DVec2> = points.iter().map(|&(x, y)| p(x, y)).collect();
            let whole: f64 = line.windows(2).map(|w| (w[1] - w[0]).length()).sum();
            let mut sum = 0.0;
            for part in [KeptPart::Inside, KeptPart::Outside] {
                let mut steps = Recorder::default();
                let options = Options { part };
                let out = clip(&frame(), &line, &[line.len()], &options, &mut steps).unwrap();
                let pieces: Vec<_> = out.pieces().map(|(line, piece)| (line, piece.to_vec())).collect();
                prop_assert_eq!(replay(&options, steps.steps()), pieces);
                sum += length(&out);
            }
            prop_assert!((sum - whole).abs() < 1e-9, "{} {}", sum, whole);
        }

        #[test]
        fn a_square_agrees_with_the_rectangle_clip(points in prop::collection::vec((-2i32..=8, -2i32..=8), 2..8)) {
            let line: Vec<DVec2> = points.iter().map(|&(x, y)| p(x, y)).collect();
            let square = Shapes::from_rings([[p(0, 0), p(6, 0), p(6, 6), p(0, 6)]]);
            let out = clip(&square, &line, &[line.len()], &Options::default(), &mut NoTrace).unwrap();
            let window = Rect::new(p(0, 0), p(6, 6)).unwrap();
            let fast = clip_lines(&window, &line, &[line.len()], false).unwrap();
            prop_assert!((length(&out) - length(&fast)).abs() < 1e-9);
            prop_assert_eq!(out.ends.len(), fast.ends.len());
        }
    }
}
