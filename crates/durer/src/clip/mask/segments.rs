//! Clipping of polylines by algorithms for single segments.

use crate::Result;
use crate::clip::attribute::VertexSource;
use crate::clip::line::{LineClipper, Segment};
use crate::clip::polygon::rectangle::ClippedLines;
use crate::math::{DVec2, Rect};

/// Clips polylines segment by segment; a piece continues where a segment's end is inside.
pub(super) fn by_segments(
    clipper: LineClipper,
    window: &Rect,
    points: &[DVec2],
    ends: &[usize],
) -> Result<ClippedLines> {
    let mut out = ClippedLines::default();
    let mut first = 0;
    for (line, &end) in ends.iter().enumerate() {
        // Where the piece being built begins.
        let mut start: Option<usize> = None;
        let finish = |out: &mut ClippedLines, start: &mut Option<usize>| {
            let Some(from) = start.take() else { return };
            if out.points[from..].iter().any(|p| *p != out.points[from]) {
                out.ends.push(out.points.len());
                out.lines.push(line);
            } else {
                out.points.truncate(from);
                out.sources.truncate(from);
            }
        };
        for k in first + 1..end {
            let segment = Segment::new(points[k - 1], points[k]);
            let Some(seen) = clipper.clip(window, segment)? else {
                finish(&mut out, &mut start);
                continue;
            };
            if seen.start != segment.start {
                finish(&mut out, &mut start);
            }
            if start.is_none() {
                start = Some(out.points.len());
                push(&mut out, seen.start, segment, k);
            }
            // A segment that only touches the window has its point already.
            if seen.start != seen.end || segment.start == segment.end {
                push(&mut out, seen.end, segment, k);
            }
            if seen.end != segment.end {
                finish(&mut out, &mut start);
            }
        }
        finish(&mut out, &mut start);
        first = end;
    }
    Ok(out)
}

fn push(out: &mut ClippedLines, p: DVec2, segment: Segment<DVec2>, end: usize) {
    let d = segment.end - segment.start;
    let along = if d.x.abs() > d.y.abs() {
        (p.x - segment.start.x) / d.x
    } else {
        (p.y - segment.start.y) / d.y
    };
    out.points.push(p);
    out.sources.push(if p == segment.start {
        VertexSource::Vertex(end - 1)
    } else if p == segment.end {
        VertexSource::Vertex(end)
    } else {
        VertexSource::Cut { from: end - 1, to: end, t: along }
    });
}
