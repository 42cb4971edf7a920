//! Polylines against the rectangle.

use super::border::exact_cut;
use super::{Extent, extent, non_finite};
use crate::Result;
use crate::clip::attribute::VertexSource;
use crate::clip::line::cut_inside;
use crate::clip::outcode::Outcode;
use crate::math::{DVec2, Rect};

/// Pieces of polylines in one flat buffer, in the order and direction of the input.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ClippedLines {
    /// All points, piece after piece.
    pub points: Vec<DVec2>,
    /// End of each piece in `points`.
    pub ends: Vec<usize>,
    /// Index of the input polyline that each piece is a part of.
    pub lines: Vec<usize>,
    /// The source of each point; empty unless requested.
    pub sources: Vec<VertexSource>,
}

impl ClippedLines {
    /// Returns the pieces, each with the index of its polyline.
    pub fn pieces(&self) -> impl Iterator<Item = (usize, &[DVec2])> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let ranges = starts.zip(self.ends.iter().copied());
        self.lines.iter().copied().zip(ranges.map(|(a, b)| &self.points[a..b]))
    }

    fn begin(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Ends the piece being built; one without length is dropped.
    pub(crate) fn end_piece(&mut self, line: usize) {
        let from = self.begin();
        let piece = self.points.get(from..).unwrap_or_default();
        if piece.iter().any(|p| *p != piece[0]) {
            self.ends.push(self.points.len());
            self.lines.push(line);
        } else {
            self.points.truncate(from);
            self.sources.truncate(from);
        }
    }
}

/// Returns the parts of polylines in the closed rectangle; `ends[i]` is where polyline i ends in
/// `points`.
///
/// A polyline is cut where it leaves the window and nowhere else, not where it crosses itself; parts
/// along the border are kept; parts that are single points are dropped. With `sources`, the source of
/// every point of the result is reported.
///
/// # Errors
/// [`crate::Error::NonFinite`] names the first point with a NaN or infinite coordinate;
/// [`crate::Error::Dangling`] an end beyond the points or before the end of the polyline before.
pub fn clip_lines(
    window: &Rect,
    points: &[DVec2],
    ends: &[usize],
    sources: bool,
) -> Result<ClippedLines> {
    let mut out = ClippedLines::default();
    let mut first = 0;
    for (line, &end) in ends.iter().enumerate() {
        let part = points.get(first..end).ok_or(crate::Error::Dangling {
            what: "point",
            index: end,
            count: points.len(),
        })?;
        match extent(window, part) {
            Extent::Outside => {}
            Extent::Inside => {
                out.points.extend_from_slice(part);
                if sources {
                    out.sources.extend((first..end).map(VertexSource::Vertex));
                }
                out.end_piece(line);
            }
            Extent::Crossing => cut(window, part, first, line, sources, &mut out),
            Extent::NonFinite => return Err(non_finite(points)),
        }
        first = end;
    }
    Ok(out)
}

/// Returns the number of leading points that satisfy a condition; eight are tested at a time,
/// without a branch.
#[inline(always)]
fn run(points: &[DVec2], wanted: impl Fn(DVec2) -> bool) -> usize {
    let (eights, _) = points.as_chunks::<8>();
    let whole = |eight: &[DVec2; 8]| eight.iter().fold(true, |all, p| all & wanted(*p));
    let first = eights.iter().position(|eight| !whole(eight)).unwrap_or(eights.len()) * 8;
    let rest = points.get(first..).unwrap_or_default();
    first + rest.iter().position(|p| !wanted(*p)).unwrap_or(rest.len())
}

/// Returns the number of leading points that lie in the window.
fn run_inside(window: &Rect, points: &[DVec2]) -> usize {
    let (min, max) = (window.min(), window.max());
    run(points, |p| (p.x >= min.x) & (p.x <= max.x) & (p.y >= min.y) & (p.y <= max.y))
}

/// Returns the number of leading points that lie beyond the same one of some borders.
fn run_beyond(window: &Rect, borders: Outcode, points: &[DVec2]) -> usize {
    let (min, max) = (window.min(), window.max());
    if borders.contains(Outcode::LEFT) {
        run(points, |p| p.x < min.x)
    } else if borders.contains(Outcode::RIGHT) {
        run(points, |p| p.x > max.x)
    } else if borders.contains(Outcode::BOTTOM) {
        run(points, |p| p.y < min.y)
    } else {
        run(points, |p| p.y > max.y)
    }
}

fn cut(
    window: &Rect,
    part: &[DVec2],
    first: usize,
    line: usize,
    sources: bool,
    out: &mut ClippedLines,
) {
    // An edge whose ends have a bit in common lies beyond that border.
    let code = |p: DVec2| Outcode::of_point_2d(window, p);
    let mut before = part.first().map_or(Outcode::INSIDE, |&p| code(p));
    // Whether the piece being built ends with the point reached.
    let mut open = false;
    let mut next = 1;
    while next < part.len() {
        if open {
            // The whole run of points inside at once.
            let end = next + run_inside(window, &part[next..]);
            out.points.extend_from_slice(&part[next..end]);
            if sources {
                out.sources.extend((first + next..first + end).map(VertexSource::Vertex));
            }
            next = end;
            if next == part.len() {
                break;
            }
            before = Outcode::INSIDE;
        }
        let (k, a, b) = (next - 1, part[next - 1], part[next]);
        next += 1;
        let after = code(b);
        let shared = before & after;
        before = after;
        if !shared.is_inside() {
            // The whole run of points beyond that border at once.
            let run = run_beyond(window, shared, &part[next..]);
            if run > 0 {
                next += run;
                before = code(part[next - 1]);
            }
            continue;
        }
        let mut push = |point: DVec2| {
            let point = exact_cut(window, point, [a, b]);
            out.points.push(point);
            if sources {
                out.sources.push(VertexSource::on_edge(point, (first + k, a), (first + k + 1, b)));
            }
        };
        let Some(visible) = cut_inside(window, a, b) else { continue };
        // If an edge only touches the window at its first or last point, that point is in the list already or will be
        // added once.
        let touches = visible.start == visible.end && a != b;
        if !open {
            push(visible.start);
        }
        if !touches {
            push(visible.end);
        }
        open = visible.end == b;
        if !open {
            out.end_piece(line);
        }
    }
    if open {
        out.end_piece(line);
    }
}
