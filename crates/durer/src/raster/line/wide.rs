//! Wide lines: the outline of a stroke with caps, joins and dashes.
//!
//! Offsets of curves, caps and joins come from kurbo (R. Levien, *Parallel curves of cubic Béziers*,
//! 2022); this module states the style in the terms of SVG and keeps strange input out.

use kurbo::{Affine, BezPath, PathEl, Point, StrokeOpts};

use crate::curve::{Path, PathElement};
use crate::info::{Class, Info};
use crate::math::DVec2;
use crate::{Error, Result};

/// The facts of strokes.
pub const INFO: Info = Info {
    name: "stroke",
    title: "Outlines of strokes",
    authors: "Raph Levien",
    year: 2022,
    source: "Parallel curves of cubic Béziers; in the implementation of the crate kurbo",
    class: Class::ObjectSpace,
    cost: "O(n) pieces of curve for n pieces of the path, more where they bend",
    limits: "the outline crosses itself: fill it by the non-zero rule",
};

/// How a stroke ends where its path does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Cap {
    /// At the end point, straight.
    #[default]
    Butt,
    /// With a half circle.
    Round,
    /// Half a width beyond the end point, straight.
    Square,
}

/// How two pieces of a stroke meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Join {
    /// With a sharp corner, cut off where it would be longer than the miter limit.
    #[default]
    Miter,
    /// With a part of a circle.
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
    /// How far into the dashes the line starts.
    pub dash_offset: f64,
}

impl Default for Stroke {
    fn default() -> Self {
        let (cap, join) = (Cap::Butt, Join::Miter);
        Self { width: 1.0, cap, join, miter_limit: 4.0, dashes: vec![], dash_offset: 0.0 }
    }
}

/// No path gets more dashes and gaps than this; with more the line is drawn solid.
const MAX_DASHES: f64 = 100_000.0;

/// With more dashes and gaps than this, lengths are those of chords, not those of curves.
const MAX_MEASURED: f64 = 2000.0;

/// Paths that are longer are made this long while they are cut into dashes.
const MEASURED: f64 = 1e4;

/// Dots — dashes and contours without length, with round or square caps — are lines as long as this share
/// of the width: too short to be seen, long enough to have a direction.
const DOT: f64 = 1e-4;

/// The finest tolerance, in sizes of the path: a hundredth of a pixel of ten million.
const FINEST: f64 = 1e-9;

/// Points farther out and greater widths are moved here first, so that products stay finite.
const FARTHEST: f64 = 1e15;

/// The outline of a stroke, to be filled by the non-zero rule; its distance from the exact outline is
/// at most `tolerance`. Elements with points that are not finite are left out; coordinates and widths
/// beyond ±10¹⁵ count as that.
///
/// # Errors
/// [`Error::Parameter`] for a negative width, a miter limit below 1, or negative or non-finite dashes.
pub fn outline(path: &Path, stroke: &Stroke, tolerance: f64) -> Result<Path> {
    check(stroke)?;
    let stroke = &Stroke { width: stroke.width.min(FARTHEST), ..stroke.clone() };
    if let Some(line) = straight(path, stroke) {
        return Ok(rectangle(line, stroke.width));
    }
    let source = to_kurbo(path);
    if stroke.width == 0.0 || source.elements().is_empty() {
        return Ok(Path::new());
    }
    let source = if stroke.cap == Cap::Butt { source } else { with_dots(&source, stroke.width) };
    let mut style = style(stroke);
    // Not finer than the size of the whole allows: a path may be given in any unit.
    let extent = source.control_box();
    let size = extent.width().abs() + extent.height().abs() + stroke.width;
    let tolerance = tolerance.max(size * FINEST);
    let source = dashed(source, stroke, &mut style, tolerance);
    Ok(from_kurbo(&kurbo::stroke(source, &style, &StrokeOpts::default(), tolerance)))
}

/// Whether a style makes sense.
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

/// The ends of a single straight line without dashes, which needs no offsets of curves; square caps lengthen it.
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

/// The outline of a straight line.
fn rectangle((from, to): (DVec2, DVec2), width: f64) -> Path {
    let mut rectangle = Path::new();
    let Some(corners) = super::anti_aliased::corners(from, to, width) else { return rectangle };
    for (i, p) in corners.iter().enumerate() {
        rectangle.push(if i == 0 { PathElement::MoveTo(*p) } else { PathElement::LineTo(*p) });
    }
    rectangle.push(PathElement::Close);
    rectangle
}

fn style(stroke: &Stroke) -> kurbo::Stroke {
    let cap = match stroke.cap {
        Cap::Butt => kurbo::Cap::Butt,
        Cap::Round => kurbo::Cap::Round,
        Cap::Square => kurbo::Cap::Square,
    };
    let join = match stroke.join {
        Join::Miter => kurbo::Join::Miter,
        Join::Round => kurbo::Join::Round,
        Join::Bevel => kurbo::Join::Bevel,
    };
    kurbo::Stroke::new(stroke.width)
        .with_caps(cap)
        .with_join(join)
        .with_miter_limit(stroke.miter_limit)
}

/// Cuts the path into its dashes, where it has any and not too many. Changes the style where dots need it.
fn dashed(source: BezPath, stroke: &Stroke, style: &mut kurbo::Stroke, tolerance: f64) -> BezPath {
    let period: f64 = stroke.dashes.iter().sum();
    let length = control_length(&source);
    let count = length / period * stroke.dashes.len() as f64;
    if !(period > 0.0 && length > 0.0 && count < MAX_DASHES) {
        return source;
    }
    // SVG repeats a list of odd length, so that dashes and gaps change places.
    let twice = if stroke.dashes.len() % 2 == 1 { 2 } else { 1 };
    let mut dashes: Vec<f64> = (0..twice).flat_map(|_| stroke.dashes.iter().copied()).collect();
    if stroke.cap != Cap::Butt {
        if dashes.iter().step_by(2).all(|d| *d == 0.0) {
            // Dots at corners have none themselves.
            style.join = kurbo::Join::Round;
        }
        lengthen_dots(&mut dashes, stroke.width * DOT);
    }
    let offset = stroke.dash_offset.rem_euclid(dashes.iter().sum());
    // kurbo measures to a fixed accuracy, which takes for ever on paths much longer than this.
    let scale = libm::exp2(-libm::ceil(libm::log2((length / MEASURED).max(1.0))));
    let source = if count < MAX_MEASURED { source } else { chords(&source, length, tolerance) };
    dashes.iter_mut().for_each(|d| *d *= scale);
    let small = Affine::scale(scale) * source;
    let start = small.elements().first().copied();
    let mut dashed = kurbo::dash(small.into_iter(), offset * scale, &dashes).peekable();
    // Where a dash ends within rounding of the start, what follows comes without its first point.
    let start = start.filter(|_| !matches!(dashed.peek(), None | Some(PathEl::MoveTo(_))));
    let dashed: BezPath = start.into_iter().chain(dashed).collect();
    Affine::scale(1.0 / scale) * dashed
}

/// The curves as chains of chords.
fn chords(path: &BezPath, length: f64, tolerance: f64) -> BezPath {
    let mut out = BezPath::new();
    kurbo::flatten(path.iter(), tolerance.max(length * 1e-7), |element| out.push(element));
    out
}

/// The lengths of the lines through all control points, which are not less than those of the curves.
fn control_length(path: &BezPath) -> f64 {
    let (mut start, mut at, mut sum) = (Point::ORIGIN, Point::ORIGIN, 0.0);
    for element in path.elements() {
        let chain = match *element {
            PathEl::MoveTo(p) => {
                (start, at) = (p, p);
                continue;
            }
            PathEl::LineTo(p) => [p, p, p],
            PathEl::QuadTo(a, p) => [a, p, p],
            PathEl::CurveTo(a, b, p) => [a, b, p],
            PathEl::ClosePath => [start; 3],
        };
        for p in chain {
            sum += at.distance(p);
            at = p;
        }
    }
    sum
}

/// Dashes without length get one, at the cost of the gap after them, where it has enough.
fn lengthen_dots(dashes: &mut [f64], length: f64) {
    for pair in dashes.chunks_exact_mut(2).filter(|p| p[0] == 0.0 && p[1] > length) {
        pair[0] += length;
        pair[1] -= length;
    }
}

/// The path with contours that stay in one point made a line as long as a dot, along x, as SVG wants it;
/// what only moves makes no dot.
fn with_dots(path: &BezPath, width: f64) -> BezPath {
    let mut out = BezPath::new();
    let elements = path.elements();
    let starts = |e: &PathEl| matches!(e, PathEl::MoveTo(_));
    for contour in elements.chunk_by(|_, next| !starts(next)) {
        let start = contour.first().and_then(PathEl::end_point);
        let stays = |p: Point| start.is_some_and(|s| s == p);
        let dot = contour.iter().all(|e| match *e {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => stays(p),
            PathEl::QuadTo(a, p) => stays(a) && stays(p),
            PathEl::CurveTo(a, b, p) => stays(a) && stays(b) && stays(p),
            PathEl::ClosePath => true,
        });
        match start {
            Some(p) if dot && contour.len() > 1 => {
                out.move_to((p.x - 0.5 * DOT * width, p.y));
                out.line_to((p.x + 0.5 * DOT * width, p.y));
            }
            _ => out.extend(contour.iter().copied()),
        }
    }
    out
}

fn to_kurbo(path: &Path) -> BezPath {
    // Clamping leaves NaN as it is, infinity must not become finite.
    let near = |v: f64| if v.is_finite() { v.clamp(-FARTHEST, FARTHEST) } else { v };
    let at = |p: DVec2| Point::new(near(p.x), near(p.y));
    let mut out = BezPath::new();
    let mut open = false;
    for element in path.elements() {
        let element = match *element {
            PathElement::MoveTo(p) => PathEl::MoveTo(at(p)),
            PathElement::LineTo(p) => PathEl::LineTo(at(p)),
            PathElement::QuadTo(c, p) => PathEl::QuadTo(at(c), at(p)),
            PathElement::CubicTo(a, b, p) => PathEl::CurveTo(at(a), at(b), at(p)),
            PathElement::Close => PathEl::ClosePath,
        };
        if !element.is_finite() || (element == PathEl::ClosePath && !open) {
            continue;
        }
        if let (false, Some(end)) = (open, element.end_point())
            && !matches!(element, PathEl::MoveTo(_))
        {
            out.move_to(end);
        }
        open = element != PathEl::ClosePath;
        out.push(element);
    }
    out
}

fn from_kurbo(path: &BezPath) -> Path {
    let at = |p: Point| DVec2::new(p.x, p.y);
    let mut out = Path::new();
    // Offsets of curves that turn back in one point can have no direction.
    for element in path.elements().iter().filter(|e| e.is_finite()) {
        out.push(match *element {
            PathEl::MoveTo(p) => PathElement::MoveTo(at(p)),
            PathEl::LineTo(p) => PathElement::LineTo(at(p)),
            PathEl::QuadTo(c, p) => PathElement::QuadTo(at(c), at(p)),
            PathEl::CurveTo(a, b, p) => PathElement::CubicTo(at(a), at(b), at(p)),
            PathEl::ClosePath => PathElement::Close,
        });
    }
    out
}
