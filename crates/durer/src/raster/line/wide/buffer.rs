//! Buffers: all places within a distance of points, lines and polygons, or of polygons all those farther than
//! it from their border.
//!
//! The Minkowski sum with a disc (R. Wein, *Exact and efficient construction of planar Minkowski sums using the
//! convolution method*, ESA 2006), by the outline of a wide line: the border of a polygon is stroked with twice the
//! distance as width, and the stroke is united with the polygon or subtracted from it by [`overlay()`]. Class: object
//! space. Cost: an overlay of the outline, O((n + k) log n) for n points of it and k crossings. Limits: arcs are
//! polygons within a tolerance.

use super::{Cap, Join, Stroke, outline};
use crate::clip::mask::Area;
use crate::clip::polygon::{
    BooleanOp, Shapes, WindingRule, overlay::Options as OverlayOptions, overlay::overlay,
};
use crate::curve::{Contours, Path};
use crate::geometry::Geometry;
use crate::info::{Class, Info, Occluder};
use crate::math::{DAffine2, DVec2};
use crate::trace::NoTrace;
use crate::work::Work;
use crate::{Error, Result};

/// The facts of buffers.
pub const INFO: Info = Info {
    name: "buffer",
    title: "Buffers by strokes and an overlay",
    authors: "R. Wein",
    year: 2006,
    source: "Exact and efficient construction of planar Minkowski sums using the convolution method, ESA",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O((n + k) log n) for n points of the outline and k crossings",
    limits: "arcs become polygons within a tolerance",
    pseudocode: &[],
};

/// Options for the distance of a buffer, and for its corners and ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The distance, in units of the coordinates. Below 0 polygons shrink, and lines and points vanish.
    pub distance: f64,
    /// Corners.
    pub join: Join,
    /// The ends of lines, and points: a disc by [`Cap::Round`], a square by [`Cap::Square`], nothing by [`Cap::Butt`].
    pub cap: Cap,
    /// The longest miter over twice the distance, at least 1.
    pub miter_limit: f64,
    /// Largest distance of polygons from the arcs that they approximate, above 0; `None`: a thousandth of the
    /// distance.
    pub tolerance: Option<f64>,
    /// Budget of memory, and whether to go on.
    pub work: Work,
}

impl Default for Options {
    fn default() -> Self {
        let (join, cap) = (Join::Round, Cap::Round);
        let work = Work::default();
        Self { distance: 1.0, join, cap, miter_limit: 5.0, tolerance: None, work }
    }
}

impl Options {
    /// Returns the stroke for these options, and its tolerance.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a distance or tolerance that is not finite, and for a tolerance that is not above 0.
    fn stroke(&self) -> Result<(Stroke, f64)> {
        if !self.distance.is_finite() {
            return Err(Error::parameter("distance", self.distance, "a finite number"));
        }
        let width = 2.0 * self.distance.abs();
        let tolerance = self.tolerance.unwrap_or(width * 0.0005);
        if !tolerance.is_finite() || tolerance < 0.0 || tolerance == 0.0 && width > 0.0 {
            return Err(Error::parameter("tolerance", tolerance, "a finite number above 0"));
        }
        let Self { join, cap, miter_limit, .. } = *self;
        Ok((Stroke { width, join, cap, miter_limit, ..Stroke::default() }, tolerance))
    }
}

/// Returns the polygons of `shapes` enlarged by a distance, or reduced if it is below 0; the rings of
/// `shapes` may cross, and `rule` decides which points they enclose.
///
/// ```
/// use durer::clip::polygon::{WindingRule, Shapes};
/// use durer::math::DVec2;
/// use durer::raster::line::wide::{Join, buffer::{Options, of_polygons}};
///
/// let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let square = Shapes::from_rings([square]);
/// let by = |distance| Options { distance, join: Join::Miter, ..Options::default() };
/// assert_eq!(of_polygons(&square, WindingRule::EvenOdd, &by(1.0))?.area(), 36.0);
/// assert_eq!(of_polygons(&square, WindingRule::EvenOdd, &by(-1.0))?.area(), 4.0);
/// assert!(of_polygons(&square, WindingRule::EvenOdd, &by(-2.0))?.is_empty());
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for options out of range; otherwise as [`overlay()`].
pub fn of_polygons(shapes: &Shapes, rule: WindingRule, options: &Options) -> Result<Shapes> {
    let mut border = Path::new();
    for ring in shapes.rings() {
        border.extend(&Path::polygon(ring.iter().copied()));
    }
    let op = if options.distance < 0.0 { BooleanOp::Difference } else { BooleanOp::Union };
    joined(shapes, rule, op, &border, options)
}

/// Returns the polygons within a distance of lines; a line of one point is a point.
///
/// # Errors
/// As [`of_polygons`].
pub fn of_lines<'a>(
    lines: impl IntoIterator<Item = &'a [DVec2]>,
    options: &Options,
) -> Result<Shapes> {
    if options.distance <= 0.0 {
        return options.stroke().map(|_| Shapes::new());
    }
    let mut path = Path::new();
    for line in lines {
        // A contour without length has the caps of a point.
        let twice = line.iter().chain(line.first().filter(|_| line.len() == 1));
        path.extend(&Path::polyline(twice.copied()));
    }
    joined(&Shapes::new(), WindingRule::EvenOdd, BooleanOp::Union, &path, options)
}

/// Returns the polygons within a distance of all parts of a geometry; its own polygons are taken by a fill rule.
///
/// ```
/// use durer::clip::polygon::WindingRule;
/// use durer::geometry::{Geometry, Points};
/// use durer::math::DVec2;
/// use durer::raster::line::wide::Cap;
/// use durer::raster::line::wide::buffer::{Options, of_geometry};
///
/// let road = Geometry::LineString(Points::flat(vec![DVec2::ZERO, DVec2::new(10.0, 0.0)]));
/// let options = Options { distance: 1.0, cap: Cap::Butt, ..Options::default() };
/// assert_eq!(of_geometry(&road, WindingRule::EvenOdd, &options)?.area(), 20.0);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// As [`of_polygons`].
pub fn of_geometry(geometry: &Geometry, rule: WindingRule, options: &Options) -> Result<Shapes> {
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    chains(geometry, &mut lines);
    let area = Area::of_geometry(geometry);
    let around = match lines.is_empty() {
        true => Shapes::new(),
        false => of_lines(lines.iter().map(|line| &line[..]), options)?,
    };
    if area.shapes.is_empty() {
        return Ok(around);
    }
    let mut all = of_polygons(&area.shapes, rule, options)?;
    if around.is_empty() {
        return Ok(all);
    }
    all.append(&around);
    Ok(Area::flat(all).union(&options.work)?.shapes)
}

/// Collects the lines of a geometry, and its points as lines of one point.
fn chains(geometry: &Geometry, out: &mut Vec<Vec<DVec2>>) {
    match geometry {
        Geometry::Point(points) | Geometry::MultiPoint(points) => {
            out.extend(points.xy.iter().map(|p| vec![*p]));
        }
        Geometry::LineString(line) => out.push(line.xy.clone()),
        Geometry::MultiLineString(lines) => out.extend(lines.iter().map(|line| line.xy.clone())),
        Geometry::Collection(parts) => parts.iter().for_each(|part| chains(part, out)),
        Geometry::Polygon(_) | Geometry::MultiPolygon(_) => {}
    }
}

/// Coordinates of buffers are at most this: 10³⁰⁰ less room for products in the overlay.
const FARTHEST: f64 = 1e299;

/// Farther coordinates are scaled for the stroke, whose points lie within ±10¹⁵.
const FAR: f64 = 1e12;

/// Joins `shapes` and a stroke along a path, or subtracts the stroke.
///
/// # Errors
/// [`Error::Parameter`] if places would be farther than [`FARTHEST`].
fn joined(
    shapes: &Shapes,
    rule: WindingRule,
    op: BooleanOp,
    path: &Path,
    options: &Options,
) -> Result<Shapes> {
    let size = path.bounds().map_or(0.0, |b| b.min().abs().max(b.max().abs()).max_element());
    let farthest = size + options.distance.abs();
    if farthest > FARTHEST && options.distance.is_finite() {
        return Err(Error::parameter("distance", options.distance, "within ±1e299 of all places"));
    }
    // Halves, as often as needed: scaling by powers of two is exact.
    let mut scale = 1.0;
    while farthest * scale > FAR {
        scale *= 0.5;
    }
    if scale == 1.0 || !farthest.is_finite() {
        return joined_near(shapes, rule, op, path, options);
    }
    let scaled = |shapes: &Shapes, scale: f64| {
        let mut shapes = shapes.clone();
        shapes.points_mut().iter_mut().for_each(|p| *p *= scale);
        shapes
    };
    let (distance, tolerance) =
        (options.distance * scale, options.tolerance.map(|length| length * scale));
    let options = Options { distance, tolerance, ..options.clone() };
    let path = path.transformed(DAffine2::from_scale(DVec2::splat(scale)));
    let near = joined_near(&scaled(shapes, scale), rule, op, &path, &options)?;
    Ok(scaled(&near, scale.recip()))
}

fn joined_near(
    shapes: &Shapes,
    rule: WindingRule,
    op: BooleanOp,
    path: &Path,
    options: &Options,
) -> Result<Shapes> {
    let (stroke, tolerance) = options.stroke()?;
    let _walk = options.work.charge("outline of the buffer", super::cost(path, tolerance))?;
    let outline = rings(&outline(path, &stroke, tolerance, &mut NoTrace)?);
    let rules = OverlayOptions {
        subject_rule: rule,
        clip_rule: WindingRule::NonZero,
        drop_collinear: true,
        work: options.work.clone(),
        ..OverlayOptions::default()
    };
    Ok(overlay(shapes, &outline, op, &rules, &mut NoTrace)?.shapes)
}

/// Returns the contours as polygons of one ring each.
fn rings(contours: &Contours) -> Shapes {
    Shapes::from_rings(contours.iter().map(|(ring, _)| ring))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const RULE: WindingRule = WindingRule::EvenOdd;

    fn square(low: f64, side: f64) -> Vec<DVec2> {
        let high = low + side;
        [(low, low), (high, low), (high, high), (low, high)].map(DVec2::from).to_vec()
    }

    fn round(distance: f64) -> Options {
        Options { distance, tolerance: Some(1e-6), ..Options::default() }
    }

    fn area(shapes: &Shapes, options: &Options) -> f64 {
        of_polygons(shapes, RULE, options).expect("buffer").area()
    }

    #[test]
    fn areas_are_those_of_minkowski_sums() {
        let block = Shapes::from_rings([square(0.0, 10.0)]);
        let about =
            |found: f64, right: f64| assert!((found - right).abs() < 1e-3, "{found} {right}");
        about(area(&block, &round(2.0)), 100.0 + 80.0 + 4.0 * PI);
        about(area(&block, &round(-2.0)), 36.0);
        about(area(&block, &Options { join: Join::Bevel, ..round(2.0) }), 100.0 + 80.0 + 8.0);
        about(area(&block, &Options { join: Join::Miter, ..round(2.0) }), 196.0);
        // A hole shrinks as its polygon grows, and finally disappears.
        let frame = Shapes::from_rings([square(0.0, 10.0), square(3.0, 4.0)]);
        about(area(&frame, &round(1.0)), 100.0 + 40.0 + PI - 4.0);
        about(area(&frame, &round(2.5)), 100.0 + 100.0 + 6.25 * PI);
        about(area(&frame, &round(-1.0)), 64.0 - (16.0 + 16.0 + PI));
        // Between the grown hole and the border, only the rounded corners remain.
        about(area(&frame, &round(-1.5)), 2.25 * (4.0 - PI));
        about(area(&frame, &round(-2.5)), 0.0);
    }

    #[test]
    fn large_distances_and_coordinates_are_those_of_small_ones() {
        let block = Shapes::from_rings([square(0.0, 10.0)]);
        let options = |distance: f64| Options { distance, ..Options::default() };
        for exponent in [3, 12, 15, 16, 40, 150, 290] {
            let distance = 10_f64.powi(exponent);
            let found = of_polygons(&block, RULE, &options(distance)).expect("buffer");
            let bounds = found.bounds().expect("something");
            for side in [-bounds.min(), bounds.max() - 10.0] {
                let error = (side / distance - 1.0).abs().max_element();
                assert!(error < 1e-3, "{distance}: {bounds:?}");
            }
        }
        let far = square(1e17, 4e17);
        let found = of_polygons(&Shapes::from_rings([far]), RULE, &options(1e17)).expect("buffer");
        assert!((found.bounds().expect("something").max() / 6e17 - 1.0).abs().max_element() < 1e-3);
        for distance in [1e300, -1e300, f64::MAX] {
            let refusal = of_polygons(&block, RULE, &options(distance)).expect_err("too far");
            assert!(refusal.to_string().contains("within ±1e299"), "{refusal}");
        }
    }

    #[test]
    fn lines_and_points_get_caps() {
        let line = [(0.0, 0.0), (10.0, 0.0)].map(DVec2::from);
        let of =
            |line: &[DVec2], options: &Options| of_lines([line], options).expect("buffer").area();
        let about =
            |found: f64, right: f64| assert!((found - right).abs() < 1e-3, "{found} {right}");
        about(of(&line, &round(2.0)), 40.0 + 4.0 * PI);
        about(of(&line, &Options { cap: Cap::Butt, ..round(2.0) }), 40.0);
        about(of(&line, &Options { cap: Cap::Square, ..round(2.0) }), 56.0);
        about(of(&line[..1], &round(2.0)), 4.0 * PI);
        about(of(&line[..1], &Options { cap: Cap::Square, ..round(2.0) }), 16.0);
        about(of(&line[..1], &Options { cap: Cap::Butt, ..round(2.0) }), 0.0);
        about(of(&line, &round(-2.0)), 0.0);
        let crossing =
            [[(0.0, 0.0), (10.0, 0.0)], [(5.0, -5.0), (5.0, 5.0)]].map(|l| l.map(DVec2::from));
        let cap = Options { cap: Cap::Butt, ..round(1.0) };
        let both = of_lines(crossing.iter().map(|l| &l[..]), &cap).expect("buffer");
        about(both.area(), 36.0);
        assert_eq!(both.polygon_count(), 1);
    }

    #[test]
    fn a_distance_of_zero_makes_valid() {
        let bow = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from);
        let whole = of_polygons(&Shapes::from_rings([bow]), RULE, &round(0.0)).expect("buffer");
        assert_eq!((whole.area(), whole.polygon_count()), (8.0, 2));
    }

    #[test]
    fn options_out_of_range_are_errors() {
        let block = Shapes::from_rings([square(0.0, 10.0)]);
        let fails = |options: Options| of_polygons(&block, RULE, &options).is_err();
        assert!(fails(round(f64::NAN)) && fails(round(f64::INFINITY)));
        assert!(fails(Options { tolerance: Some(0.0), ..round(1.0) }));
        assert!(fails(Options { tolerance: Some(-1.0), ..round(1.0) }));
        assert!(fails(Options { miter_limit: 0.5, ..round(1.0) }));
        assert!(of_lines([], &round(f64::NAN)).is_err());
    }
}
