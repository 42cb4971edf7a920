//! Wide lines: the outline of a stroke with caps, joins and dashes.
//!
//! Thick primitives as polygons (J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes, *Computer Graphics: Principles
//! and Practice*, 2nd ed. 1990, §3.9), with the joins, caps and dashes of PostScript and SVG. Class: object space.
//! Cost: O(n) points for n pieces of the flattened path, plus the points of its arcs.
//!
//! The path is flattened first. A stroke is the union of one rectangle for each piece, one wedge for each corner, and
//! the caps. Its outline walks along one side of the path and back along the other, and on the inner side of a corner
//! through the corner itself: then the outline's winding number is the sum of the winding numbers of rectangles and
//! wedges that all turn the same way, so the non-zero rule leaves no hole, however short the pieces are compared with
//! the width. Where both pieces are long enough the offset lines meet in one point instead. The number of points of an
//! arc and the rule for when two offset lines meet are durer's own; lengths of curves, which dashes need, are measured
//! by kurbo.

pub mod buffer;
mod contour;
mod dashes;
mod near;
mod sides;

use crate::curve::{Contours, Path, PathElement};
use crate::info::{Class, Info, Occluder};
use crate::math::DVec2;
use crate::trace::{PseudocodeLine, Tracer};
use crate::{Error, Result};
pub(crate) use near::parts_near;
use sides::Pen;

/// The facts of strokes.
pub const INFO: Info = Info {
    name: "stroke",
    title: "Outlines of strokes",
    authors: "J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes",
    year: 1990,
    source: "Computer Graphics: Principles and Practice, 2nd edition, 3.9",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) points for n pieces of the flattened path, more where corners and caps are round",
    limits: "the outline crosses itself: fill it by the non-zero rule",
    pseudocode: &[
        "flatten the path, cut it into dashes",
        "for each contour, there and back:",
        "    begin a ring; h ← half the width, n ← unit normal to the left of a piece",
        "    for each piece from P to Q: its side is P + h n … Q + h n",
        "    at each corner between two pieces:",
        "        outer side: a join – miter, round or bevel",
        "        inner side: where the two offset lines meet, if the pieces are long enough",
        "        else through the corner itself",
        "    at each end of an open contour: a cap – butt, round or square",
        "fill the rings by the non-zero rule",
    ],
};

/// Shape of a stroke's ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Cap {
    /// Straight end at the end point.
    #[default]
    Butt,
    /// Half circle.
    Round,
    /// Half a width beyond the end point, straight.
    Square,
}

/// Shape of a stroke where two pieces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Join {
    /// Sharp corner, bevelled if it would exceed the miter limit.
    #[default]
    Miter,
    /// Part of a circle.
    Round,
    /// Cut off straight.
    Bevel,
}

/// The look of a stroke; lengths in the unit of the path.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Width, at least 0; a stroke of width 0 has no area.
    pub width: f64,
    /// Both ends of open contours, and of dashes.
    pub cap: Cap,
    /// Corners.
    pub join: Join,
    /// Longest miter over the width, at least 1.
    pub miter_limit: f64,
    /// Lengths of dashes and gaps in turn; empty for a solid line.
    pub dashes: Vec<f64>,
    /// Distance into the dashes at which the line starts.
    pub dash_offset: f64,
}

impl Default for Stroke {
    fn default() -> Self {
        let (cap, join) = (Cap::Butt, Join::Miter);
        Self { width: 1.0, cap, join, miter_limit: 4.0, dashes: vec![], dash_offset: 0.0 }
    }
}

/// The finest tolerance, in sizes of the path: a hundredth of a pixel of ten million.
const FINEST: f64 = 1e-9;

/// Points farther out and greater widths are moved here first, so that products stay finite.
const FARTHEST: f64 = 1e15;

/// One step of the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// A new ring of the outline begins.
    Ring,
    /// The ring's next point.
    Point {
        /// The vertex of the flattened path that it belongs to.
        vertex: DVec2,
        /// Place of the outline's point.
        point: DVec2,
        /// Part of the stroke that it belongs to.
        part: StrokePart,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Ring => 3,
            Self::Point { part: StrokePart::Join, .. } => 6,
            Self::Point { part: StrokePart::Side, .. } => 7,
            Self::Point { part: StrokePart::Pivot, .. } => 8,
            Self::Point { part: StrokePart::Cap, .. } => 9,
        }
    }
}

/// Part of a stroke that a point of its outline belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StrokePart {
    /// The end of a piece's offset line, or where two of them meet.
    Side,
    /// The path through the vertex, on the inner side of a corner beside short pieces.
    Pivot,
    /// A join on the outer side of a corner.
    Join,
    /// A cap.
    Cap,
}

/// Returns the outline of a stroke, to be filled by the non-zero rule; its distance from the exact outline is at most
/// `tolerance`. Elements with points that are not finite are left out; coordinates and widths beyond ±10¹⁵ are clamped
/// to that.
///
/// ```
/// use durer::curve::Path;
/// use durer::raster::line::wide::{Join, Stroke, outline};
/// use durer::trace::NoTrace;
///
/// let small = Path::rectangle(95.0, 95.0, 10.0, 10.0);
/// let stroke = Stroke { width: 60.0, join: Join::Miter, ..Stroke::default() };
/// let outline = outline(&small, &stroke, 0.025, &mut NoTrace).unwrap();
/// // The inner ring goes through all corners and covers what is inside; the outer one is a square.
/// assert_eq!(outline.iter().map(|(ring, _)| ring.len()).collect::<Vec<_>>(), [12, 4]);
/// ```
///
/// # Errors
/// [`Error::Parameter`] for a negative width, a miter limit below 1, or negative or non-finite dashes.
pub fn outline(
    path: &Path,
    stroke: &Stroke,
    tolerance: f64,
    t: &mut impl Tracer<Step>,
) -> Result<Contours> {
    outline_in_parts(path, stroke, tolerance, t, |_| {})
}

/// Returns the outline as [`outline`] does; `part` is called with the outline after each contour or dash and may take
/// it.
///
/// # Errors
/// As [`outline`].
pub(crate) fn outline_in_parts(
    path: &Path,
    stroke: &Stroke,
    tolerance: f64,
    t: &mut impl Tracer<Step>,
    mut part: impl FnMut(&mut Contours),
) -> Result<Contours> {
    check(stroke)?;
    let stroke = &Stroke { width: stroke.width.min(FARTHEST), ..stroke.clone() };
    if let Some((from, to)) = straight(path, stroke) {
        let outline = super::anti_aliased::outline(from, to, stroke.width);
        trace(&outline, t);
        return Ok(outline);
    }
    let mut out = Contours::new();
    let Some(bounds) = path.bounds().filter(|_| stroke.width > 0.0) else { return Ok(out) };
    // Not finer than the size of the whole allows: a path may be given in any unit.
    let size = near(bounds.max()) - near(bounds.min());
    let tolerance = tolerance.max((size.x + size.y + stroke.width) * FINEST);
    let mut pen = Pen::new(stroke, tolerance, &mut out, t);
    match dashes::dashed(elements(path), stroke, tolerance) {
        Some(dashed) => {
            if dashes::only_dots(stroke) {
                pen.join = Join::Round;
            }
            contour::each(elements(&dashed), tolerance, |c| pen.stroke(c, &mut part));
        }
        None => contour::each(elements(path), tolerance, |c| pen.stroke(c, &mut part)),
    }
    Ok(out)
}

/// Returns whether a path has more than 100,000 dashes and gaps: then [`outline`] leaves it solid.
///
/// ```
/// use durer::curve::Path;
/// use durer::raster::line::wide::{Stroke, has_too_many_dashes};
///
/// let line = Path::rectangle(0.0, 0.0, 1000.0, 1000.0);
/// let dashed = |length| Stroke { dashes: vec![length], ..Stroke::default() };
/// assert!(has_too_many_dashes(&line, &dashed(0.01)));
/// assert!(!has_too_many_dashes(&line, &dashed(1.0)));
/// ```
pub fn has_too_many_dashes(path: &Path, stroke: &Stroke) -> bool {
    dashes::are_too_many(elements(path), stroke)
}

/// Reports the steps of the outline of one straight line, whose corners are at its ends.
fn trace(outline: &Contours, t: &mut impl Tracer<Step>) {
    for (i, point) in outline.points().iter().enumerate() {
        if i == 0 {
            t.step(|| Step::Ring);
        }
        t.step(|| Step::Point { vertex: *point, point: *point, part: StrokePart::Cap });
    }
}

/// Returns about how many bytes the walk along a path takes at most: the vertices and pieces of its longest contour,
/// and both sides of them.
pub(crate) fn cost(path: &Path, tolerance: f64) -> u64 {
    const BYTES: f64 = 128.0;
    let (mut chords, mut at) = (0.0, DVec2::ZERO);
    for element in path.elements() {
        let (length, end) = match *element {
            PathElement::MoveTo(p) | PathElement::LineTo(p) => (0.0, p),
            PathElement::QuadTo(a, p) => (at.distance(a) + a.distance(p), p),
            PathElement::CubicTo(a, b, p) => (at.distance(a) + a.distance(b) + b.distance(p), p),
            PathElement::Close => continue,
        };
        chords += 1.0 + (length / (8.0 * tolerance)).sqrt();
        at = end;
    }
    (chords * BYTES) as u64
}

/// Returns how far from its path a stroke reaches at most.
fn reach(stroke: &Stroke) -> f64 {
    let join = if stroke.join == Join::Miter { stroke.miter_limit } else { 1.0 };
    stroke.width / 2.0 * join.max(std::f64::consts::SQRT_2)
}

/// Returns a point moved to where products of its coordinates stay finite.
fn near(p: DVec2) -> DVec2 {
    p.clamp(DVec2::splat(-FARTHEST), DVec2::splat(FARTHEST))
}

/// Returns the elements of a path whose points are finite, moved near, every contour with its
/// start.
fn elements(path: &Path) -> impl Iterator<Item = PathElement> {
    use PathElement::{Close, CubicTo, LineTo, MoveTo, QuadTo};
    let (mut start, mut open) = (None, false);
    path.elements()
        .iter()
        .flat_map(move |element| {
            // Infinity must not become finite.
            let finite = |points: &[DVec2]| points.iter().all(|p| p.is_finite());
            let (element, end) = match *element {
                MoveTo(p) if p.is_finite() => (MoveTo(near(p)), Some(near(p))),
                LineTo(p) if p.is_finite() => (LineTo(near(p)), Some(near(p))),
                QuadTo(a, p) if finite(&[a, p]) => (QuadTo(near(a), near(p)), Some(near(p))),
                CubicTo(a, b, p) if finite(&[a, b, p]) => {
                    (CubicTo(near(a), near(b), near(p)), Some(near(p)))
                }
                Close if open => (Close, None),
                _ => return [None, None],
            };
            let first = match element {
                MoveTo(_) => {
                    start = end;
                    None
                }
                Close => None,
                _ if open => None,
                _ => {
                    start = start.or(end);
                    start.map(MoveTo)
                }
            };
            open = element != Close;
            [first, Some(element)]
        })
        .flatten()
}

/// Checks that a style makes sense.
///
/// # Errors
/// Those of [`outline`].
pub(crate) fn check(stroke: &Stroke) -> Result<()> {
    let not_negative = |v: f64| v.is_finite() && v >= 0.0;
    if !not_negative(stroke.width) {
        return Err(Error::parameter("stroke width", stroke.width, "finite and at least 0"));
    }
    if stroke.miter_limit.is_nan() || stroke.miter_limit < 1.0 {
        return Err(Error::parameter("miter limit", stroke.miter_limit, "at least 1"));
    }
    if !stroke.dashes.iter().all(|d| not_negative(*d)) || !stroke.dash_offset.is_finite() {
        return Err(Error::parameter("dashes", "given", "finite lengths of at least 0"));
    }
    Ok(())
}

/// Returns the ends of a single straight line without dashes, which needs no offsets of curves; square caps
/// lengthen it.
pub(crate) fn straight(path: &Path, stroke: &Stroke) -> Option<(DVec2, DVec2)> {
    let &[PathElement::MoveTo(a), PathElement::LineTo(b)] = path.elements() else { return None };
    let near = |p: DVec2| p.abs().max_element() <= FARTHEST;
    if stroke.cap == Cap::Round || !stroke.dashes.is_empty() || !near(a) || !near(b) {
        return None;
    }
    if stroke.cap == Cap::Butt {
        return Some((a, b));
    }
    // Dots have no direction of their own.
    let cap = (b - a).try_normalize()? * (stroke.width / 2.0);
    Some((a - cap, b + cap))
}
