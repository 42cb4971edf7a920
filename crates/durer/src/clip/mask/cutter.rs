//! Clipping of one geometry to a mask.

use super::area::{oriented, pieces};
use super::segments::by_segments;
use super::{Area, Mask, Rules};
use crate::clip::line::LineClipper;
use crate::clip::polygon::overlay::{self, overlay};
use crate::clip::polygon::rectangle;
use crate::clip::polygon::validity::{Touching, is_valid};
use crate::clip::polygon::{BooleanOp, PolygonClipper, Shapes, WindingRule, coverage};
use crate::clip::polyline::{self, KeptPart};
use crate::geometry::{Geometry, Points};
use crate::math::{DVec2, Rect};
use crate::trace::NoTrace;
use crate::{Error, Result};

/// Mask, operation and settings for clipping geometries.
#[derive(Debug, Clone)]
pub struct Cutter<'a> {
    /// Region to clip to.
    pub mask: &'a Mask,
    /// Intersection, or difference.
    pub op: BooleanOp,
    /// Fill rule of polygons and grid of their crossings.
    pub rules: Rules,
    /// Algorithm to use; `None` chooses by geometry and mask.
    pub algorithm: Option<Algorithm>,
}

/// Algorithm of the library, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Algorithm {
    /// Algorithm for polygons.
    Polygon(PolygonClipper),
    /// Algorithm for lines and axis-parallel windows.
    Line(LineClipper),
}

impl Algorithm {
    /// Returns all algorithms for geometries; midpoint subdivision works on pixels only.
    pub fn all() -> Vec<Self> {
        let polygons = PolygonClipper::ALL.iter().map(|&a| Self::Polygon(a));
        let lines = LineClipper::ALL.iter().filter(|&&a| a != LineClipper::Midpoint);
        polygons.chain(lines.map(|&a| Self::Line(a))).collect()
    }

    /// Returns its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Polygon(a) => a.name(),
            Self::Line(a) => a.name(),
        }
    }

    /// Returns whether it clips with rectangles only.
    pub fn needs_window(self) -> bool {
        match self {
            Self::Polygon(clipper) => clipper.needs_rectangle(),
            Self::Line(_) => true,
        }
    }

    /// Returns whether it joins the polygons of all features.
    pub fn joins(self) -> bool {
        matches!(self, Self::Polygon(PolygonClipper::Overlay | PolygonClipper::Vatti))
    }

    /// Returns whether polygons are cut on a grid and by a fill rule; this also holds with algorithms for lines.
    pub fn takes_rules(self) -> bool {
        self.joins() || matches!(self, Self::Line(_))
    }

    /// Returns whether it keeps the inside only.
    pub fn needs_intersection(self) -> bool {
        match self {
            Self::Polygon(clipper) => clipper.keeps_inside_only(),
            Self::Line(_) => true,
        }
    }
}

/// Result of clipping a geometry.
#[derive(Debug, Default)]
pub struct Cut {
    /// Part that remains; `None` if nothing does.
    pub geometry: Option<Geometry>,
    /// True if its polygons were not valid and have been made so.
    pub repaired: bool,
    /// True if a polygon of the mask was smaller than a cell of the grid there.
    pub lost: bool,
    /// Points of polygons that stay on the grid, not where edges cross or vertices were.
    pub snapped: usize,
    /// Lines without length, which vanish.
    pub flat: usize,
}

impl<'a> Cutter<'a> {
    /// Creates a cutter that keeps the part of geometries inside the mask, by the even-odd rule.
    pub fn new(mask: &'a Mask) -> Self {
        Self { mask, op: BooleanOp::Intersection, rules: Rules::default(), algorithm: None }
    }

    /// Clips a geometry. The resulting polygons are valid, with outer rings counter-clockwise and holes clockwise.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a geometry that the named algorithm does not take; [`Error::Parameter`] for
    /// coordinates that are not finite.
    pub fn cut(&self, geometry: &Geometry) -> Result<Cut> {
        let inside = self.op == BooleanOp::Intersection;
        let Some(bounds) = geometry.bounds() else { return Ok(Cut::default()) };
        if inside && !self.mask.meets(&bounds) {
            return Ok(Cut::default());
        }
        Ok(match geometry {
            Geometry::Point(points) => {
                let kept = self.points(points);
                Cut::of((!kept.is_empty()).then_some(Geometry::Point(kept)))
            }
            Geometry::MultiPoint(points) => {
                let kept = self.points(points);
                Cut::of((!kept.is_empty()).then_some(Geometry::MultiPoint(kept)))
            }
            Geometry::LineString(line) => self.cut_lines(&[line])?,
            Geometry::MultiLineString(lines) => {
                self.cut_lines(&lines.iter().collect::<Vec<_>>())?
            }
            Geometry::Polygon(_) | Geometry::MultiPolygon(_) => self.polygons(geometry, &bounds)?,
            Geometry::Collection(parts) => self.collection(parts)?,
        })
    }

    fn collection(&self, parts: &[Geometry]) -> Result<Cut> {
        let cuts: Vec<Cut> = parts.iter().map(|part| self.cut(part)).collect::<Result<_>>()?;
        let repaired = cuts.iter().any(|cut| cut.repaired);
        let lost = cuts.iter().any(|cut| cut.lost);
        let snapped = cuts.iter().map(|cut| cut.snapped).sum();
        let flat = cuts.iter().map(|cut| cut.flat).sum();
        let left: Vec<Geometry> = cuts.into_iter().filter_map(|cut| cut.geometry).collect();
        let geometry = (!left.is_empty()).then_some(Geometry::Collection(left));
        Ok(Cut { geometry, repaired, lost, snapped, flat })
    }

    fn points(&self, points: &Points) -> Points {
        let mut kept = Points::new(points.dimensions);
        for (i, &p) in points.xy.iter().enumerate() {
            if self.mask.contains(p) == (self.op == BooleanOp::Intersection) {
                kept.push(p, points.zm(i));
            }
        }
        kept
    }

    fn cut_lines(&self, lines: &[&Points]) -> Result<Cut> {
        let wanted = |p: DVec2| self.mask.contains(p) == (self.op == BooleanOp::Intersection);
        let is_flat = |line: &&&Points| {
            let first = line.xy.first().copied();
            first.is_some_and(|first| line.xy.iter().all(|&p| p == first) && wanted(first))
        };
        let flat = lines.iter().filter(is_flat).count();
        Ok(Cut { geometry: one_or_many(self.lines(lines)?), flat, ..Cut::default() })
    }

    fn lines(&self, lines: &[&Points]) -> Result<Vec<Points>> {
        let points: Vec<DVec2> = lines.iter().flat_map(|line| line.xy.iter().copied()).collect();
        let ends: Vec<usize> = lines
            .iter()
            .scan(0, |end, line| {
                *end += line.len();
                Some(*end)
            })
            .collect();
        let inside = self.op == BooleanOp::Intersection;
        let cut = match (self.mask.window, self.algorithm) {
            (Some(window), Some(Algorithm::Line(clipper))) if inside => {
                by_segments(clipper, &window, &points, &ends)?
            }
            (Some(window), _) if inside => rectangle::clip_lines(&window, &points, &ends, true)?,
            _ => {
                let part = if inside { KeptPart::Inside } else { KeptPart::Outside };
                let options = polyline::Options { part };
                let mask = self.mask.prepared();
                polyline::clip_prepared(mask, &points, &ends, &options, &mut NoTrace)?
            }
        };
        Ok(pieces(lines, &cut))
    }

    fn polygons(&self, geometry: &Geometry, bounds: &Rect) -> Result<Cut> {
        let area = Area::of_geometry(geometry);
        match self.algorithm {
            None | Some(Algorithm::Line(_)) => self.production(geometry, &area, bounds),
            Some(Algorithm::Polygon(clipper)) => {
                // The fill rule of an SVG's paths, for algorithms that take polygons as they are.
                let as_they_are = !Algorithm::Polygon(clipper).takes_rules();
                let ruled = as_they_are && self.rules.fill != WindingRule::EvenOdd;
                let area = if ruled { self.rules.clean(geometry)?.area } else { area };
                Ok(Cut::of(self.by_name(clipper, &area)?.into_geometry().map(oriented)))
            }
        }
    }

    /// Keeps or drops polygons as a whole if the mask's border does not come near them; clips valid polygons by the
    /// rectangle clip, all others by the overlay.
    fn production(&self, geometry: &Geometry, area: &Area, bounds: &Rect) -> Result<Cut> {
        let inside = self.op == BooleanOp::Intersection;
        let side = self.mask.side(bounds);
        if side.is_some_and(|side| side != inside) {
            return Ok(Cut::default());
        }
        let keeps = self.rules.keep_valid(&area.shapes);
        let apart = keeps && is_valid(&area.shapes, Touching::No);
        // Rings that touch in points are valid, but the rectangle clip does not take them.
        if side.is_some() && (apart || keeps && is_valid(&area.shapes, Touching::AtPoints)) {
            return Ok(Cut::of(Some(oriented(geometry.clone()))));
        }
        if let Some(window) = self.mask.window.filter(|_| inside && apart) {
            let cut = clip_area(&window, area)?.into_geometry();
            return Ok(Cut::of(cut.map(oriented)));
        }
        let repaired = self.rules.fill == WindingRule::EvenOdd
            && !apart
            && !is_valid(&area.shapes, Touching::AtPoints);
        if self.rules.grid.is_some() {
            let near = self.mask.near(bounds);
            let cut = self.rules.snapped(area, &near, self.op, self.rules.fill)?;
            let lost = self.rules.loses(area, &near);
            return Ok(Cut { geometry: cut.into_geometry(), repaired, lost, ..Cut::default() });
        }
        let work = self.rules.work.clone();
        let options = coverage::Options { rule: self.rules.fill, mend: !apart, keep: false, work };
        let cut = coverage::cut(&area.shapes, self.mask.prepared(), self.op, &options)?;
        let (lost, snapped) = (cut.lost, cut.snapped);
        if cut.whole {
            return Ok(Cut::of(Some(oriented(geometry.clone()))));
        }
        let geometry = area.cut(cut.shapes, &cut.sources).into_geometry();
        Ok(Cut { geometry, repaired, lost, snapped, flat: 0 })
    }

    fn by_name(&self, clipper: PolygonClipper, area: &Area) -> Result<Area> {
        let mask = self.mask.shapes();
        let valid = |shapes: &Shapes| is_valid(shapes, Touching::AtPoints);
        Ok(match (clipper, self.mask.window) {
            (PolygonClipper::Rectangle, Some(window)) => {
                let cut = clip_area(&window, area)?;
                // Where rings touch, their clipped parts may be one ring that touches itself.
                if !valid(&area.shapes) || !valid(&cut.shapes) {
                    const WHAT: &str =
                        "a polygon whose rings cross, overlap or touch there by the rectangle clip";
                    return refused(WHAT);
                }
                cut
            }
            (PolygonClipper::Overlay, _) => {
                self.rules.overlay(area, mask, self.op, self.rules.fill)?.area
            }
            (PolygonClipper::Vatti, _) => self.rules.vatti(area, mask, self.op, self.rules.fill)?,
            (clipper, _) => {
                // The walks find that themselves.
                if clipper == PolygonClipper::SutherlandHodgman && !valid(&area.shapes) {
                    return refused("a polygon whose rings cross or overlap by Sutherland–Hodgman");
                }
                let mut cut = clipper.clip(&area.shapes, mask, self.op)?;
                // Crossing rings are divided at the crossings, because a geometry has valid polygons.
                if clipper == PolygonClipper::GreinerHormann && !valid(&cut) {
                    let options = overlay::Options::with_rule(WindingRule::EvenOdd);
                    let union = BooleanOp::Union;
                    cut = overlay(&cut, &Shapes::new(), union, &options, &mut NoTrace)?.shapes;
                }
                // Heights and measures are interpolated at the new vertices.
                area.cut(cut, &[])
            }
        })
    }
}

impl Cut {
    fn of(geometry: Option<Geometry>) -> Self {
        Self { geometry, ..Self::default() }
    }
}

/// Returns the error for a request that the chosen algorithm does not support.
fn refused(what: &'static str) -> Result<Area> {
    Err(Error::Unsupported { what, instead: "choose another algorithm, or none" })
}

fn one_or_many(mut lines: Vec<Points>) -> Option<Geometry> {
    match lines.len() {
        0 => None,
        1 => lines.pop().map(Geometry::LineString),
        _ => Some(Geometry::MultiLineString(lines)),
    }
}

/// Returns the part of valid polygons in a window.
fn clip_area(window: &Rect, area: &Area) -> Result<Area> {
    let options = rectangle::Options;
    let (shapes, sources) =
        rectangle::clip_with_sources(window, &area.shapes, &options, &mut NoTrace)?;
    Ok(area.cut(shapes, &sources))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::polygon::validity::edges_are_apart;

    fn line(points: &[(f64, f64)]) -> Points {
        Points::flat(points.iter().map(|&p| DVec2::from(p)).collect())
    }

    fn cut(geometry: &Geometry, algorithm: Option<Algorithm>) -> Option<Geometry> {
        let window = Rect::new(DVec2::ZERO, DVec2::splat(10.0)).expect("a window");
        let mask = &Mask::window(window).expect("finite");
        let op = BooleanOp::Intersection;
        let cutter = Cutter { mask, op, rules: Rules::default(), algorithm };
        cutter.cut(geometry).expect("cut").geometry
    }

    #[test]
    fn every_line_algorithm_cuts_as_the_production_path() {
        let zigzag =
            line(&[(-5.0, 5.0), (5.0, 5.0), (5.0, 15.0), (7.0, 5.0), (9.0, 9.0), (20.0, 9.0)]);
        let geometry = Geometry::LineString(zigzag);
        let expected = cut(&geometry, None);
        assert!(matches!(&expected, Some(Geometry::MultiLineString(parts)) if parts.len() == 2));
        for algorithm in Algorithm::all() {
            assert_eq!(cut(&geometry, Some(algorithm)), expected, "{}", algorithm.name());
        }
    }

    #[test]
    fn every_polygon_algorithm_gives_the_same_area() {
        let ring = line(&[(-5.0, 2.0), (5.0, 2.0), (5.0, 8.0), (-5.0, 8.0)]);
        let hole = line(&[(-1.0, 3.0), (2.0, 3.0), (2.0, 4.0), (-1.0, 4.0)]);
        let geometry = Geometry::Polygon(vec![ring, hole]);
        for algorithm in [None].into_iter().chain(Algorithm::all().into_iter().map(Some)) {
            let area = Area::of_geometry(&cut(&geometry, algorithm).expect("a part")).shapes;
            let size: f64 = area.rings().map(|r| crate::clip::polygon::signed_area(r).abs()).sum();
            let holes: f64 = area
                .polygons()
                .flat_map(|p| p.holes().collect::<Vec<_>>())
                .map(|r| crate::clip::polygon::signed_area(r).abs())
                .sum();
            // A hole that is cut open is part of the outer ring, or a hole on the border.
            assert!((size - 2.0 * holes - 28.0).abs() < 1e-9, "{algorithm:?}: {size} {holes}");
        }
    }

    #[test]
    fn vertices_nearer_than_a_grid_cell_stay_valid() {
        // A long border, and teeth that reach down to within a cell of the grid.
        let (length, mut state) = (1_048_576.0, 3_u64);
        let cell = length / 2f64.powi(40);
        let mut random = || {
            let step = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
            state = state.wrapping_mul(step.0).wrapping_add(step.1);
            (state >> 40) as f64 / (1 << 24) as f64
        };
        for _ in 0..200 {
            let border = [random() * 2.0 * cell, random() * 2.0 * cell];
            let mut ring = vec![DVec2::new(0.0, border[0]), DVec2::new(length, border[1])];
            ring.push(DVec2::new(length, 9.0));
            for i in (1..8).rev() {
                let x = length * (f64::from(i) + 0.3 * random()) / 8.5;
                let y = border[0] + (border[1] - border[0]) * (x / length);
                ring.push(DVec2::new(x, y + 0.7 * random() * cell + 1e-12));
                ring.push(DVec2::new(x - 0.1, 8.0));
            }
            ring.push(DVec2::new(0.0, 9.0));
            let mut area = Area::default();
            area.shapes = Shapes::from_rings([ring]);
            let far = super::super::rectangle_shape(
                &Rect::new(DVec2::splat(5.0), DVec2::splat(6.0)).unwrap(),
            );
            for op in BooleanOp::ALL {
                let cut = Rules::default().overlay(&area, &far, *op, WindingRule::EvenOdd);
                let cut = cut.expect("finite").area.shapes;
                assert!(edges_are_apart(&cut, Touching::AtVertices), "{op}: {cut:?}");
            }
        }
    }
}
