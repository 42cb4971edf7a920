//! From pieces between two points of the grid to long chains.

use super::{GridChain, LineFamily, LinePiece};
use crate::math::{DVec2, DVec3};
use crate::scene::HeightField;
use crate::view::picture_plane::PicturePlane;

/// Ends of two pieces of a segment that are nearer than this part of it are one: quarters around the
/// eye are cut at the same point, but for rounding.
const JOIN: f64 = 1e-9;

/// Joins pieces to curves, in the order of families, lines, and along the lines.
pub fn curves(field: &HeightField, mut pieces: Vec<LinePiece>) -> Vec<GridChain> {
    pieces.sort_unstable_by(|a, b| {
        let key = |p: &LinePiece| (p.family, p.line, p.segment);
        key(a).cmp(&key(b)).then(a.range[0].total_cmp(&b.range[0]))
    });
    let mut curves: Vec<GridChain> = Vec::new();
    let mut last: Option<LinePiece> = None;
    for piece in pieces {
        let points = piece.range.map(|t| point(field, &piece, t));
        match (last, curves.last_mut()) {
            (Some(before), Some(curve)) if continues(&before, &piece) => {
                curve.points.push(points[1]);
            }
            _ => curves.push(GridChain {
                family: piece.family,
                line: piece.line,
                visible: piece.visible,
                underside: piece.underside,
                points: points.to_vec(),
            }),
        }
        last = Some(piece);
    }
    curves
}

fn continues(before: &LinePiece, piece: &LinePiece) -> bool {
    let alike = before.family == piece.family
        && before.line == piece.line
        && before.visible == piece.visible
        && before.underside == piece.underside;
    let end = before.segment as f64 + before.range[1];
    alike && (piece.segment as f64 + piece.range[0] - end).abs() <= JOIN
}

/// Returns the ends of the segment of a piece.
pub fn ends(
    field: &HeightField,
    family: LineFamily,
    line: usize,
    segment: usize,
) -> [Option<DVec3>; 2] {
    match family {
        LineFamily::AlongX => [field.point(segment, line), field.point(segment + 1, line)],
        LineFamily::AlongZ => [field.point(line, segment), field.point(line, segment + 1)],
    }
}

fn point(field: &HeightField, piece: &LinePiece, t: f64) -> DVec3 {
    let [from, to] = ends(field, piece.family, piece.line, piece.segment);
    // Pieces are made of segments whose ends are there.
    let (from, to) = (from.unwrap_or_default(), to.unwrap_or_default());
    match t {
        0.0 => from,
        1.0 => to,
        _ => from + (to - from) * t,
    }
}

/// Returns the parts of a chain of points of the world that lie behind the near plane, on the plane
/// of the picture; neighbours that fall together are one.
pub fn projected(points: &[DVec3], plane: &PicturePlane) -> Vec<Vec<DVec2>> {
    let mut chains: Vec<Vec<DVec2>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let Some([a, b]) = plane.project_segment(pair[0], pair[1]) else {
            open = false;
            continue;
        };
        if !open {
            chains.push(vec![a]);
        }
        if let Some(chain) = chains.last_mut()
            && chain.last() != Some(&b)
        {
            chain.push(b);
        }
        open = plane.is_behind_near(pair[1]);
    }
    chains.retain(|c| c.len() > 1);
    chains
}
