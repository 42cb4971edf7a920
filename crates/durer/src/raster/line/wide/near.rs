//! The parts of a path whose stroke can reach a window, for paths that extend far beyond it.
//!
//! Curves many times larger than the window have thousands of chords, of which hardly any are visible. Halving curves
//! until their pieces are small or away from the window makes the cost depend on the visible part.

use super::{Stroke, elements, reach};
use crate::curve::{Path, PathElement};
use crate::math::{DVec2, Rect};

/// Paths that are not this many times larger than the window are left as they are.
const FAR: f64 = 64.0;

/// Curves are halved until they are at most this many windows large, or have been so often.
const LARGE: f64 = 4.0;
const MOST_HALVINGS: u32 = 40;

/// A piece of a contour: where it begins, and the element itself.
type Piece = (DVec2, PathElement);

/// Returns the parts of a path whose stroke may reach the window, which is in the path's space; `None` if that saves
/// nothing, or if the stroke has dashes, which must be counted from the start.
///
/// Contours are cut where they are away from the window, and have ends there.
pub(crate) fn parts_near(path: &Path, stroke: &Stroke, window: Rect) -> Option<Path> {
    let reach = DVec2::splat(reach(stroke));
    let window = Rect::new(window.min() - reach, window.max() + reach).ok()?;
    let large = window.size().max_element();
    let is_far = path.bounds()?.size().max_element() > FAR * large;
    if !is_far || !stroke.dashes.is_empty() {
        return None;
    }
    let mut cut = Cut { window, large: LARGE * large, out: Path::new(), pieces: Vec::new() };
    let (mut start, mut at) = (DVec2::ZERO, DVec2::ZERO);
    for element in elements(path) {
        match element {
            PathElement::MoveTo(p) => {
                cut.end(false);
                (start, at) = (p, p);
            }
            PathElement::Close => {
                // A path without length is a dot.
                if at != start || cut.pieces.is_empty() {
                    cut.add((at, PathElement::LineTo(start)));
                }
                cut.end(true);
                at = start;
            }
            PathElement::LineTo(p) | PathElement::QuadTo(_, p) | PathElement::CubicTo(_, _, p) => {
                cut.add((at, element));
                at = p;
            }
        }
    }
    cut.end(false);
    Some(cut.out)
}

/// The contours that are kept, and the one that is being cut.
struct Cut {
    window: Rect,
    /// Side of the largest curves that are not halved.
    large: f64,
    out: Path,
    /// Its pieces near the window, and `None` if there are others.
    pieces: Vec<Option<Piece>>,
}

impl Cut {
    fn add(&mut self, piece: Piece) {
        let mut open = vec![(piece, 0)];
        while let Some((piece, halvings)) = open.pop() {
            let (low, high) = extent(&piece);
            let meets = low.cmple(self.window.max()).all() && high.cmpge(self.window.min()).all();
            if !meets {
                if !matches!(self.pieces.last(), Some(None)) {
                    self.pieces.push(None);
                }
                continue;
            }
            match halves(&piece) {
                Some([first, second])
                    if halvings < MOST_HALVINGS && (high - low).max_element() > self.large =>
                {
                    open.extend([(second, halvings + 1), (first, halvings + 1)]);
                }
                _ => self.pieces.push(Some(piece)),
            }
        }
    }

    /// Ends a contour. A closed one that is cut begins after a gap.
    fn end(&mut self, closed: bool) {
        let gap = self.pieces.iter().position(Option::is_none);
        if let Some(gap) = gap.filter(|_| closed) {
            self.pieces.rotate_left(gap);
        }
        let mut open = false;
        for piece in self.pieces.drain(..) {
            if let Some((from, element)) = piece {
                if !std::mem::replace(&mut open, true) {
                    self.out.push(PathElement::MoveTo(from));
                }
                self.out.push(element);
            } else {
                open = false;
            }
        }
        if closed && open && gap.is_none() {
            self.out.push(PathElement::Close);
        }
    }
}

/// Returns the box around the points of a piece, which holds all of it.
fn extent(&(from, element): &Piece) -> (DVec2, DVec2) {
    let points = match element {
        PathElement::MoveTo(p) | PathElement::LineTo(p) => [p; 3],
        PathElement::QuadTo(a, p) => [a, p, p],
        PathElement::CubicTo(a, b, p) => [a, b, p],
        PathElement::Close => [from; 3],
    };
    points.iter().fold((from, from), |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Returns a curve as two, after de Casteljau; `None` for a line.
fn halves(&(a, element): &Piece) -> Option<[Piece; 2]> {
    let middle = |p: DVec2, q: DVec2| p * 0.5 + q * 0.5;
    match element {
        PathElement::QuadTo(b, c) => {
            let (ab, bc) = (middle(a, b), middle(b, c));
            let at = middle(ab, bc);
            Some([(a, PathElement::QuadTo(ab, at)), (at, PathElement::QuadTo(bc, c))])
        }
        PathElement::CubicTo(b, c, d) => {
            let (ab, bc, cd) = (middle(a, b), middle(b, c), middle(c, d));
            let (abc, bcd) = (middle(ab, bc), middle(bc, cd));
            let at = middle(abc, bcd);
            Some([(a, PathElement::CubicTo(ab, abc, at)), (at, PathElement::CubicTo(bcd, cd, d))])
        }
        _ => None,
    }
}
