//! Cutting one geometry with the mask.

use super::mask::Mask;
use super::shapes::{Area, oriented, pieces};
use durer::clip::line::polyline::{self, Part};
use durer::clip::line::{LineClipper, Segment};
use durer::clip::polygon::overlay::{self, overlay};
use durer::clip::polygon::rectangle::{self, ClippedLines};
use durer::clip::polygon::validity::{Touching, is_valid};
use durer::clip::polygon::{BooleanOp, FillRule, PolygonClipper, Shapes, coverage, vatti};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;
use durer_formats::geo::{Geometry, Points};

type Result<T> = durer::Result<T>;

/// How a geometry is cut.
#[derive(Debug, Clone, Copy)]
pub struct Cutter<'a> {
    pub mask: &'a Mask,
    /// Intersection, or difference.
    pub op: BooleanOp,
    pub rules: Rules,
    pub algorithm: Option<Algorithm>,
}

/// What polygons enclose, and where their crossings may lie.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rules {
    pub fill: FillRule,
    /// Size of a grid cell, in units of the coordinates.
    pub grid: Option<f64>,
}

/// An algorithm of the library by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Algorithm {
    Polygon(PolygonClipper),
    Line(LineClipper),
}

impl Algorithm {
    /// All that the command can use; midpoint subdivision works on pixels only.
    pub fn all() -> Vec<Self> {
        let polygons = PolygonClipper::ALL.iter().map(|&a| Self::Polygon(a));
        let lines = LineClipper::ALL.iter().filter(|&&a| a != LineClipper::Midpoint);
        polygons.chain(lines.map(|&a| Self::Line(a))).collect()
    }

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Polygon(a) => a.name(),
            Self::Line(a) => a.name(),
        }
    }

    /// Whether it clips with rectangles only.
    pub fn needs_window(self) -> bool {
        match self {
            Self::Polygon(clipper) => clipper.needs_rectangle(),
            Self::Line(_) => true,
        }
    }

    /// Whether it joins the polygons of all features.
    pub fn joins(self) -> bool {
        matches!(self, Self::Polygon(PolygonClipper::Overlay | PolygonClipper::Vatti))
    }

    /// Whether polygons are cut on a grid and by a fill rule; so they are beside algorithms for lines.
    pub fn takes_rules(self) -> bool {
        self.joins() || matches!(self, Self::Line(_))
    }

    /// Whether it keeps the inside only.
    pub fn needs_intersection(self) -> bool {
        match self {
            Self::Polygon(clipper) => clipper.keeps_inside_only(),
            Self::Line(_) => true,
        }
    }
}

/// What is left of a geometry.
#[derive(Debug, Default)]
pub struct Cut {
    pub geometry: Option<Geometry>,
    /// Whether its polygons were not valid and have been made so.
    pub repaired: bool,
    /// Whether a polygon of the mask was smaller than a cell of the grid there.
    pub lost: bool,
    /// Points of polygons that stay on the grid, not where edges cross or vertices were.
    pub snapped: usize,
    /// Lines without length, of which nothing is left.
    pub flat: usize,
}

/// Polygons made of others.
#[derive(Debug, Default)]
pub struct Made {
    pub area: Area,
    /// The others were not valid.
    pub repaired: bool,
    /// As of [`Cut`].
    pub snapped: usize,
}

impl Cutter<'_> {
    /// The wanted part of a geometry.
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
                let part = if inside { Part::Inside } else { Part::Outside };
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
                // What an SVG says of its paths, for algorithms that take polygons as they are.
                let as_they_are = !Algorithm::Polygon(clipper).takes_rules();
                let ruled = as_they_are && self.rules.fill != FillRule::EvenOdd;
                let area = if ruled { self.rules.clean(geometry)?.area } else { area };
                Ok(Cut::of(self.by_name(clipper, &area)?.into_geometry().map(oriented)))
            }
        }
    }

    /// Keeps or drops whole what the mask does not come near; cuts valid polygons by the rectangle clip,
    /// all others by the overlay.
    fn production(&self, geometry: &Geometry, area: &Area, bounds: &Rect) -> Result<Cut> {
        let keeps = self.rules.keep_valid(&area.shapes);
        let apart = keeps && is_valid(&area.shapes, Touching::No);
        // Rings that touch in points are valid, but nothing for the rectangle clip.
        let valid = || apart || keeps && is_valid(&area.shapes, Touching::AtPoints);
        let inside = self.op == BooleanOp::Intersection;
        match self.mask.side(bounds) {
            Some(side) if side != inside => return Ok(Cut::default()),
            Some(_) if valid() => return Ok(Cut::of(Some(oriented(geometry.clone())))),
            _ => {}
        }
        if let Some(window) = self.mask.window.filter(|_| inside && apart) {
            let cut = clip_area(&window, area)?.into_geometry();
            return Ok(Cut::of(cut.map(oriented)));
        }
        let repaired = self.rules.fill == FillRule::EvenOdd
            && !apart
            && !is_valid(&area.shapes, Touching::AtPoints);
        if self.rules.grid.is_some() {
            let near = self.mask.near(bounds);
            let cut = self.rules.snapped(area, &near, self.op, self.rules.fill)?;
            let lost = self.rules.loses(area, &near);
            return Ok(Cut { geometry: cut.into_geometry(), repaired, lost, ..Cut::default() });
        }
        let options = coverage::Options { rule: self.rules.fill, mend: !apart, keep: false };
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
                // Where rings touch, what is left of them may be one ring that touches itself.
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
                // Heights and measures are looked for where the new vertices lie.
                area.cut(clipper.clip(&area.shapes, mask, self.op)?, &[])
            }
        })
    }
}

impl Cut {
    fn of(geometry: Option<Geometry>) -> Self {
        Self { geometry, ..Self::default() }
    }
}

/// What an algorithm that was asked for cannot do.
fn refused(what: &'static str) -> Result<Area> {
    Err(durer::Error::Unsupported { what, instead: "choose another algorithm, or none" })
}

fn one_or_many(mut lines: Vec<Points>) -> Option<Geometry> {
    match lines.len() {
        0 => None,
        1 => lines.pop().map(Geometry::LineString),
        _ => Some(Geometry::MultiLineString(lines)),
    }
}

/// The part of valid polygons in a window.
fn clip_area(window: &Rect, area: &Area) -> Result<Area> {
    let options = rectangle::Options;
    let (shapes, sources) =
        rectangle::clip_with_sources(window, &area.shapes, &options, &mut NoTrace)?;
    Ok(area.cut(shapes, &sources))
}

/// Polylines cut segment by segment; pieces go on where a segment's end is inside.
fn by_segments(
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
    use durer::clip::attribute::Source;
    let d = segment.end - segment.start;
    let along = if d.x.abs() > d.y.abs() {
        (p.x - segment.start.x) / d.x
    } else {
        (p.y - segment.start.y) / d.y
    };
    out.points.push(p);
    out.sources.push(if p == segment.start {
        Source::Vertex(end - 1)
    } else if p == segment.end {
        Source::Vertex(end)
    } else {
        Source::Cut { from: end - 1, to: end, t: along }
    });
}

impl Rules {
    /// Whether valid polygons enclose what they enclose by the even-odd rule, and stay where they are.
    fn keep_valid(&self, shapes: &Shapes) -> bool {
        let as_even_odd = match self.fill {
            FillRule::EvenOdd => true,
            // Holes may run the same way as the rings around them.
            FillRule::NonZero => shapes.polygons().all(|p| p.holes().len() == 0),
            FillRule::Positive | FillRule::Negative => false,
        };
        as_even_odd && self.grid.is_none()
    }

    /// Whether the grid is coarser than a polygon of the mask is large: it may be gone.
    pub fn loses(&self, area: &Area, mask: &Shapes) -> bool {
        let Some(cell) = self.options(area, mask, self.fill).grid else { return false };
        let size = |ring: &[DVec2]| Rect::around(ring.iter().copied()).map(|r| r.size());
        mask.polygons().filter_map(|p| size(p.outer())).any(|size| size.max_element() < cell)
    }

    /// The overlay's options: the finest grid that it takes, unless one is given.
    fn options(&self, area: &Area, clip: &Shapes, subject_rule: FillRule) -> overlay::Options {
        let fit = || coverage::finest_grid([area.shapes.bounds(), clip.bounds()]);
        overlay::Options {
            subject_rule,
            clip_rule: FillRule::EvenOdd,
            grid: self.grid.or_else(fit),
            origins: true,
            drop_collinear: false,
        }
    }

    /// Any polygons with valid polygons: on the grid where one is given, else exactly.
    pub fn overlay(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: FillRule,
    ) -> Result<Made> {
        self.join(area, clip, op, subject_rule, false)
    }

    fn join(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: FillRule,
        mend: bool,
    ) -> Result<Made> {
        if self.grid.is_some() {
            let area = self.snapped(area, clip, op, subject_rule)?;
            return Ok(Made { area, ..Made::default() });
        }
        let options = coverage::Options { rule: subject_rule, mend, keep: false };
        let cut = coverage::join(&area.shapes, clip, op, &options)?;
        let snapped = cut.snapped;
        Ok(Made { area: area.cut(cut.shapes, &cut.sources), repaired: false, snapped })
    }

    /// The same with all vertices on the grid.
    fn snapped(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: FillRule,
    ) -> Result<Area> {
        let options = self.options(area, clip, subject_rule);
        Ok(area.overlaid(&overlay(&area.shapes, clip, op, &options, &mut NoTrace)?))
    }

    /// The same by Vatti's sweep; all vertices are on the grid.
    pub fn vatti(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: FillRule,
    ) -> Result<Area> {
        let options = self.options(area, clip, subject_rule);
        let output = vatti::vatti(&area.shapes, clip, op, &options, &mut NoTrace)?;
        Ok(area.overlaid(&output))
    }

    /// The same region by polygons that are valid, with outer rings counter-clockwise. The polygons of
    /// a collection are sets of points, joined whatever rule each follows.
    pub fn clean(&self, geometry: &Geometry) -> Result<Made> {
        let Geometry::Collection(parts) = geometry else { return self.clean_polygons(geometry) };
        let mut all = Made::default();
        for part in parts {
            let made = self.clean(part)?;
            all.area.append(&made.area);
            all.repaired |= made.repaired;
            all.snapped += made.snapped;
        }
        if all.area.shapes.polygon_count() > 1 {
            let rule = FillRule::Positive;
            let joined = self.overlay(&all.area, &Shapes::new(), BooleanOp::Union, rule)?;
            (all.area, all.snapped) = (joined.area, all.snapped + joined.snapped);
        }
        Ok(all)
    }

    fn clean_polygons(&self, geometry: &Geometry) -> Result<Made> {
        let area = Area::of_geometry(geometry);
        let keeps = self.keep_valid(&area.shapes);
        if keeps && is_valid(&area.shapes, Touching::No) {
            let area = Area::of_geometry(&oriented(geometry.clone()));
            return Ok(Made { area, ..Made::default() });
        }
        let repaired =
            self.fill == FillRule::EvenOdd && !is_valid(&area.shapes, Touching::AtPoints);
        let made = self.join(&area, &Shapes::new(), BooleanOp::Union, self.fill, true)?;
        Ok(Made { repaired, ..made })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::clip::polygon::validity::edges_are_apart;

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
            let size: f64 = area.rings().map(|r| durer::clip::polygon::signed_area(r).abs()).sum();
            let holes: f64 = area
                .polygons()
                .flat_map(|p| p.holes().collect::<Vec<_>>())
                .map(|r| durer::clip::polygon::signed_area(r).abs())
                .sum();
            // Where the hole is cut open it is part of the outer ring, or a hole on the border.
            assert!((size - 2.0 * holes - 28.0).abs() < 1e-9, "{algorithm:?}: {size} {holes}");
        }
    }

    #[test]
    fn vertices_nearer_than_a_grid_cell_stay_valid() {
        // A long border, and teeth that reach down to it but for less than a cell of the grid.
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
            let far = super::super::mask::rectangle_shape(
                &Rect::new(DVec2::splat(5.0), DVec2::splat(6.0)).unwrap(),
            );
            for op in BooleanOp::ALL {
                let cut = Rules::default().overlay(&area, &far, *op, FillRule::EvenOdd);
                let cut = cut.expect("finite").area.shapes;
                assert!(edges_are_apart(&cut, Touching::AtVertices), "{op}: {cut:?}");
            }
        }
    }
}
