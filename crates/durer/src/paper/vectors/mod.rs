//! A sheet as the target of painting operations, for maps and SVG drawings as vectors.

mod contours;

use crate::Result;
use crate::clip::polygon::overlay::{self, overlay};
use crate::clip::polygon::{BooleanOp, Shapes, WindingRule, rectangle, sutherland_hodgman};
use crate::curve::{Path, flatten, pieces};
use crate::math::{DAffine2, DVec2, Rect};
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::{self, Cap, Join, Stroke};
use crate::raster::paint::{BlendFunction, MaskKind, Options, Paint, PaintTarget};
use crate::target::gradient::{Gradient, scale_of};
use crate::target::sheet::{ClipPath, GradientArea, MarkGroup, PaperMark, Pen, Sheet, SheetLayer};
use crate::target::{Curve, CurvePiece};
use crate::trace::NoTrace;
use crate::work::Work;
use contours::{contours, corners, upright};
use std::collections::BTreeSet;

/// Millimetres of a pixel: 96 of them are an inch, as in CSS.
const MILLIMETRES: f64 = 25.4 / 96.0;

/// Relative difference of areas that are the same by both rules: the curves of both are rounded to one grid.
const SAME: f64 = 1e-9;

/// Name of the recorded marks in errors about memory.
const NOTED: &str = "marks of the drawing";

/// Painter of marks onto a sheet, whose pixels are 1/96 inch.
///
/// Strokes with round joins become strokes with pens; other strokes, dashed and translucent ones become areas of the
/// same outline. Parts far beyond the sheet are cut off. For CAD, where lines are to be lines, it paints differently
/// ([`SheetPainter::set_cad`]).
///
/// ```
/// use durer::curve::Path;
/// use durer::math::DVec2;
/// use durer::paper::SheetPainter;
/// use durer::raster::coverage::FillRule;
/// use durer::raster::paint::{Paint, PaintTarget};
///
/// let mut painter = SheetPainter::new(96, 48);
/// painter.begin_layer("discs");
/// let red = Paint::Color([200, 0, 0, 255]);
/// painter.fill(&Path::circle(DVec2::splat(20.0), 8.0), FillRule::NonZero, &red, 1.0);
/// let sheet = painter.into_sheet().unwrap();
/// assert_eq!((sheet.size.x, sheet.layers[0].marks.len()), (25.4, 1));
/// ```
#[derive(Debug)]
pub struct SheetPainter {
    sheet: Sheet,
    options: Options,
    work: Work,
    paper_from_path: DAffine2,
    /// The marks of the current layer that are in no open clip path or group.
    marks: Vec<PaperMark>,
    open: Vec<Open>,
    refused: BTreeSet<&'static str>,
    /// Part of the paper to which marks are cut; only for CAD.
    cut: Option<Rect>,
}

/// Colours of a mark.
#[derive(Debug, Clone, PartialEq)]
enum Ink {
    Plain([u8; 4]),
    Gradient(Gradient),
}

/// A clip path, mask or group that is open, with its marks.
#[derive(Debug)]
struct Open {
    kind: Kind,
    marks: Vec<PaperMark>,
}

#[derive(Debug, Clone)]
enum Kind {
    Clip(ClipPath),
    /// A clip path that holds the whole sheet, or a finished mask.
    Everything,
    /// A clip path that holds nothing of the sheet.
    Nothing,
    /// A rectangle that marks are cut to, for which this one was in force before.
    Cut(Rect),
    Group,
    Mask,
}

impl SheetPainter {
    /// Creates a blank sheet of a size in pixels.
    pub fn new(width: u32, height: u32) -> Self {
        let size = DVec2::new(f64::from(width), f64::from(height)) * MILLIMETRES;
        Self {
            sheet: Sheet { size, ..Sheet::default() },
            options: Options::default(),
            work: Work::default(),
            paper_from_path: DAffine2::from_scale(DVec2::splat(MILLIMETRES)),
            marks: Vec::new(),
            open: Vec::new(),
            refused: BTreeSet::new(),
            cut: None,
        }
    }

    /// Prepares for CAD, whose files have neither clip paths nor groups and fill areas by the even-odd rule: strokes
    /// become strokes with pens whatever their joins, with the dashes of the pen; marks are cut at the border of the
    /// paper and at upright clip paths; areas that wind otherwise become areas of the even-odd rule. Gradients, other
    /// clip paths and groups with an opacity are refused.
    pub fn set_cad(&mut self) {
        self.cut = Rect::new(DVec2::ZERO, self.sheet.size).ok();
    }

    /// Sets the colour of the paper; a transparent one leaves it blank.
    pub fn set_background(&mut self, color: [u8; 4]) {
        self.sheet.background = (color[3] > 0).then_some(color);
    }

    /// Charges the memory for marks to a budget.
    pub fn set_work(&mut self, work: &Work) {
        self.work = work.part();
        self.work.enter(NOTED);
    }

    /// Begins a layer with a name; the names of several layers that would be the same get numbers. The clip paths that
    /// are open stay in force.
    pub fn begin_layer(&mut self, name: &str) {
        self.end_layer();
        let taken = |name: &str| self.sheet.layers.iter().any(|layer| layer.name == name);
        let mut unique = name.to_owned();
        let mut number = 2;
        while taken(&unique) {
            unique = format!("{name}-{number}");
            number += 1;
        }
        self.sheet.layers.push(SheetLayer { name: unique, marks: Vec::new() });
    }

    /// Returns the sheet; everything that is still open is closed.
    ///
    /// # Errors
    /// The kinds of content that have been painted but that vectors cannot show, such as `"bitmaps"`.
    pub fn into_sheet(mut self) -> std::result::Result<Sheet, BTreeSet<&'static str>> {
        self.end_layer();
        if self.refused.is_empty() { Ok(self.sheet) } else { Err(self.refused) }
    }

    /// Moves all marks to the current layer.
    fn end_layer(&mut self) {
        let kinds: Vec<Kind> = self.open.iter().map(|open| open.kind.clone()).collect();
        let cut = self.cut;
        while !self.open.is_empty() {
            self.pop(1.0);
        }
        self.cut = cut;
        self.open.extend(kinds.into_iter().map(|kind| Open { kind, marks: Vec::new() }));
        let marks = std::mem::take(&mut self.marks);
        match self.sheet.layers.last_mut() {
            Some(layer) => layer.marks.extend(marks),
            None if marks.is_empty() => {}
            None => self.sheet.layers.push(SheetLayer { name: "drawing".to_owned(), marks }),
        }
    }

    fn push(&mut self, mark: PaperMark) {
        if !self.work.keep_or_stop(NOTED, bytes(&mark)) {
            return;
        }
        match self.open.last_mut() {
            Some(open) => open.marks.push(mark),
            None => self.marks.push(mark),
        }
    }

    /// Returns the ink of a paint, unless nothing of it is visible; notes paints that no ink is like.
    fn ink(&mut self, paint: &Paint, opacity: f64) -> Option<Ink> {
        let faded = |[r, g, b, a]: [u8; 4]| {
            let alpha = (f64::from(a) * opacity.clamp(0.0, 1.0)).round() as u8;
            [r, g, b, alpha]
        };
        let plain = |color| Some(faded(color)).filter(|c| c[3] > 0).map(Ink::Plain);
        match paint {
            Paint::Color(color) => plain(*color),
            Paint::Gradient(gradient) => {
                let mut gradient = gradient.mapped(self.paper_from_path);
                if let Some(color) = gradient.only_color(gradient.transform) {
                    return plain(color);
                }
                gradient.stops.iter_mut().for_each(|(_, color)| *color = faded(*color));
                gradient.stops.iter().any(|(_, color)| color[3] > 0).then_some(())?;
                if self.cut.is_some() {
                    self.leave_out("gradients");
                    return None;
                }
                Some(Ink::Gradient(gradient))
            }
            Paint::Pattern(_) => {
                self.leave_out("bitmaps and patterns");
                None
            }
        }
    }

    /// Returns the part of the plane that marks are cut to: the sheet with as much room around it as its longer side,
    /// or less for CAD.
    fn around(&self) -> Option<Rect> {
        if self.cut.is_some() {
            return self.cut;
        }
        let room = DVec2::splat(self.sheet.size.max_element());
        Rect::new(-room, self.sheet.size + room).ok()
    }

    /// Returns the outline of a path on the paper that is filled; parts far away are cut off.
    fn outline(&self, path: &Path) -> Path {
        let path = path.transformed(self.paper_from_path);
        let (Some(around), Some(bounds)) = (self.around(), path.bounds()) else { return path };
        if around.contains(bounds.min()) && around.contains(bounds.max()) {
            return path;
        }
        let mut cut = Path::new();
        for (ring, _) in flatten(&path, self.options.tolerance * MILLIMETRES).iter() {
            // Points that are not finite have no place on the paper.
            let ring = sutherland_hodgman::clip(&around, ring, &mut NoTrace).unwrap_or_default();
            cut.extend(&Path::polygon(ring));
        }
        cut
    }

    fn add_area(&mut self, path: &Path, rule: FillRule, ink: Ink) {
        let even_odd = rule == FillRule::EvenOdd;
        let alternating = if even_odd { None } else { self.alternating(path) };
        let (curves, even_odd) = match &alternating {
            Some(path) => (contours(path, true), true),
            None => (contours(path, true), even_odd),
        };
        if curves.is_empty() {
            return;
        }
        let color = match ink {
            Ink::Plain(color) => color,
            Ink::Gradient(gradient) => {
                let area = GradientArea { rings: curves, even_odd, gradient };
                return self.push(PaperMark::Gradient(Box::new(area)));
            }
        };
        if curves.iter().all(Curve::is_straight) {
            let rings = curves.iter().map(corners).collect();
            return self.push(PaperMark::Fill { rings, color, even_odd });
        }
        self.push(PaperMark::Area { rings: curves, color, even_odd });
    }

    /// Returns the contours of a path on the paper as polygons of one ring each.
    fn rings(&self, path: &Path) -> Shapes {
        let flat = flatten(path, self.options.tolerance * MILLIMETRES);
        Shapes::from_rings(flat.iter().map(|(ring, _)| ring))
    }

    /// Returns what rings enclose by a rule; nothing if the work is stopped.
    fn filled(&self, rings: &Shapes, rule: WindingRule) -> Option<Shapes> {
        let options =
            overlay::Options { work: self.work.part(), ..overlay::Options::with_rule(rule) };
        let filled = overlay(rings, &Shapes::new(), BooleanOp::Union, &options, &mut NoTrace);
        filled.inspect_err(|error| self.work.stop(error.clone())).ok().map(|output| output.shapes)
    }

    /// Returns for CAD the area of a path that winds around points several times, as one to be filled by the even-odd
    /// rule.
    fn alternating(&self, path: &Path) -> Option<Path> {
        self.cut?;
        let rings = self.rings(path);
        let by_winding = self.filled(&rings, WindingRule::NonZero)?;
        let by_turns = self.filled(&rings, WindingRule::EvenOdd)?;
        let difference = by_winding.area().abs() - by_turns.area().abs();
        let is_same = difference.abs() <= SAME * by_winding.area().abs();
        (!is_same).then(|| polygons(&by_winding))
    }

    /// Returns whether a pen can draw a stroke along these curves.
    fn is_for_pen(&self, curves: &[Curve], stroke: &Stroke, alpha: u8) -> bool {
        if self.cut.is_some() {
            let has_dots = stroke.dashes.iter().any(|length| *length <= 0.0);
            return scale_of(&self.paper_from_path).is_some() && !has_dots;
        }
        let is_round = stroke.join == Join::Round
            && (stroke.cap == Cap::Round || curves.iter().all(|curve| curve.closed));
        // Translucent strokes that cross would be darker there.
        let is_plain = stroke.dashes.is_empty() && (alpha == 255 || curves.len() == 1);
        scale_of(&self.paper_from_path).is_some() && is_round && is_plain
    }

    /// Returns curves without the parts of their lines that are far from the sheet.
    fn near(&self, curves: Vec<Curve>, width: f64) -> Result<Vec<Curve>> {
        let reach = DVec2::splat(if self.cut.is_some() { 0.0 } else { width });
        let Some(around) = self.around() else { return Ok(curves) };
        let around = Rect::new(around.min() - reach, around.max() + reach)?;
        let is_near = |curve: &Curve| {
            let points = curve.pieces.iter().flat_map(|piece| match *piece {
                CurvePiece::Cubic(a, b, end) => [a, b, end],
                CurvePiece::Line(end) | CurvePiece::Arc(_, end) => [end; 3],
            });
            points.chain([curve.start]).all(|p| around.contains(p))
        };
        let mut near = Vec::new();
        for curve in curves {
            if is_near(&curve) {
                near.push(curve);
                continue;
            }
            let points = pieces::points(&curve, self.options.tolerance * MILLIMETRES);
            let last = points.first().filter(|_| curve.closed).copied();
            let points: Vec<DVec2> = points.into_iter().chain(last).collect();
            let cut = rectangle::clip_lines(&around, &points, &[points.len()], false)?;
            let mut start = 0;
            for end in cut.ends {
                let part = cut.points.get(start..end).unwrap_or_default();
                near.extend(contours(&Path::polyline(part.iter().copied()), false));
                start = end;
            }
        }
        Ok(near)
    }

    fn pen(&mut self, width: f64, color: [u8; 4], dashes: Vec<f64>) -> usize {
        let pen = Pen { width, color, dashes };
        let known = self.sheet.pens.iter().rposition(|other| *other == pen);
        known.unwrap_or_else(|| {
            self.sheet.pens.push(pen);
            self.sheet.pens.len() - 1
        })
    }
}

impl PaintTarget for SheetPainter {
    fn options(&self) -> &Options {
        &self.options
    }

    fn work(&self) -> &Work {
        &self.work
    }

    fn set_transform(&mut self, pixel_from_path: DAffine2) {
        self.paper_from_path = DAffine2::from_scale(DVec2::splat(MILLIMETRES)) * pixel_from_path;
    }

    fn set_anti_alias(&mut self, _smooth: bool) {}

    fn fill(&mut self, path: &Path, rule: FillRule, paint: &Paint, opacity: f64) {
        if let Some(ink) = self.ink(paint, opacity) {
            self.add_area(&self.outline(path), rule, ink);
        }
    }

    fn stroke(&mut self, path: &Path, stroke: &Stroke, paint: &Paint, opacity: f64) -> Result<()> {
        wide::check(stroke)?;
        self.work.check()?;
        let Some(ink) = self.ink(paint, opacity).filter(|_| stroke.width > 0.0) else {
            return Ok(());
        };
        let path_from_paper = self.paper_from_path.inverse();
        let window = self.around().filter(|_| path_from_paper.is_finite()).and_then(|around| {
            let (low, high) = (around.min(), around.max());
            let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
            Rect::around(corners.map(|p| path_from_paper.transform_point2(p)))
        });
        let near = window.and_then(|window| wide::parts_near(path, stroke, window));
        let path = near.as_ref().unwrap_or(path);
        let width = stroke.width * self.paper_from_path.matrix2.x_axis.length();
        let curves = self.near(contours(&path.transformed(self.paper_from_path), false), width)?;
        if let Ink::Plain(color) = ink
            && self.is_for_pen(&curves, stroke, color[3])
        {
            // An odd number of lengths is taken twice.
            let times = 1 + stroke.dashes.len() % 2;
            let scale = width / stroke.width;
            let lengths = std::iter::repeat_n(&stroke.dashes, times).flatten();
            let pen = self.pen(width, color, lengths.map(|length| length * scale).collect());
            for curve in curves {
                self.push(match curve.is_straight() {
                    true => {
                        PaperMark::Stroke { points: corners(&curve), closed: curve.closed, pen }
                    }
                    false => PaperMark::Curve { curve, pen },
                });
            }
            return Ok(());
        }
        let scale = self.paper_from_path.matrix2.determinant().abs().sqrt();
        let tolerance = self.options.tolerance * MILLIMETRES / scale.max(f64::MIN_POSITIVE);
        let outline = wide::outline(path, stroke, tolerance, &mut NoTrace)?;
        let mut filled = Path::new();
        for (ring, _) in outline.iter() {
            filled.extend(&Path::polygon(ring.iter().copied()));
        }
        self.add_area(&self.outline(&filled), FillRule::NonZero, ink);
        Ok(())
    }

    fn push_clip(&mut self, path: &Path, rule: FillRule) {
        let path = self.outline(path);
        let paper = [DVec2::ZERO, self.sheet.size];
        if let Some(cut) = self.cut {
            let kind = match upright(&path) {
                Some(inside) => {
                    self.cut = Some(inside);
                    Kind::Cut(cut)
                }
                None if contours(&path, true).is_empty() => Kind::Nothing,
                None => {
                    self.leave_out("clip paths");
                    Kind::Everything
                }
            };
            return self.open.push(Open { kind, marks: Vec::new() });
        }
        let kind = match upright(&path) {
            Some(inside) if paper.iter().all(|corner| inside.contains(*corner)) => Kind::Everything,
            _ => {
                let (rings, even_odd) = (contours(&path, true), rule == FillRule::EvenOdd);
                if rings.is_empty() {
                    Kind::Nothing
                } else {
                    Kind::Clip(ClipPath { rings, even_odd })
                }
            }
        };
        self.open.push(Open { kind, marks: Vec::new() });
    }

    fn push_united_clip(&mut self, paths: &[(Path, FillRule)]) -> bool {
        let mut all = Shapes::new();
        for (path, rule) in paths {
            let rings = self.rings(&self.outline(path));
            let rule = match rule {
                FillRule::NonZero => WindingRule::NonZero,
                FillRule::EvenOdd => WindingRule::EvenOdd,
            };
            let Some(inside) = self.filled(&rings, rule) else { return false };
            all.append(&inside);
        }
        let Some(union) = self.filled(&all, WindingRule::NonZero) else { return false };
        let map = std::mem::replace(&mut self.paper_from_path, DAffine2::IDENTITY);
        self.push_clip(&polygons(&union), FillRule::EvenOdd);
        self.paper_from_path = map;
        true
    }

    fn push_group(&mut self) {
        self.open.push(Open { kind: Kind::Group, marks: Vec::new() });
    }

    fn begin_mask(&mut self) {
        self.leave_out("masks");
        self.open.push(Open { kind: Kind::Mask, marks: Vec::new() });
    }

    fn end_mask(&mut self, _kind: MaskKind) {
        let Some(mask) = self.open.iter().rposition(|open| matches!(open.kind, Kind::Mask)) else {
            return;
        };
        self.open.truncate(mask);
        self.open.push(Open { kind: Kind::Everything, marks: Vec::new() });
    }

    fn pop_blended(&mut self, opacity: f64, blend: BlendFunction) {
        let Some(Open { kind, marks }) = self.open.pop() else { return };
        if blend != BlendFunction::Normal {
            self.leave_out("blend modes");
        }
        if let Kind::Cut(before) = kind {
            self.cut = Some(before);
        }
        let (clip, opacity) = match kind {
            _ if marks.is_empty() => return,
            Kind::Mask | Kind::Nothing => return,
            Kind::Clip(clip) => (Some(clip), 1.0),
            Kind::Group if opacity < 1.0 => (None, opacity.max(0.0)),
            Kind::Group | Kind::Everything | Kind::Cut(..) => {
                let below = self.open.last_mut().map_or(&mut self.marks, |open| &mut open.marks);
                return below.extend(marks);
            }
        };
        if self.cut.is_some() {
            return self.leave_out("opacities of whole layers");
        }
        self.push(PaperMark::Group(Box::new(MarkGroup { marks, clip, opacity })));
    }

    fn leave_out(&mut self, what: &'static str) {
        self.refused.insert(what);
    }
}

/// Returns polygons as a path.
fn polygons(shapes: &Shapes) -> Path {
    let mut path = Path::new();
    for ring in shapes.rings() {
        path.extend(&Path::polygon(ring.iter().copied()));
    }
    path
}

/// Returns about the bytes that a mark takes, without those of marks in it.
fn bytes(mark: &PaperMark) -> u64 {
    let of_curves =
        |rings: &[Curve]| -> usize { rings.iter().map(|r| size_of_val(&r.pieces[..]) + 48).sum() };
    let own = match mark {
        PaperMark::Fill { rings, .. } => rings.iter().map(|r| size_of_val(&r[..]) + 24).sum(),
        PaperMark::Stroke { points, .. } => size_of_val(&points[..]),
        PaperMark::Curve { curve, .. } => size_of_val(&curve.pieces[..]),
        PaperMark::Area { rings, .. } => of_curves(rings),
        PaperMark::Gradient(area) => {
            size_of::<GradientArea>()
                + of_curves(&area.rings)
                + size_of_val(&area.gradient.stops[..])
        }
        PaperMark::Text { .. } | PaperMark::Dimension(_) | PaperMark::Group(_) => 0,
    };
    (size_of::<PaperMark>() + own) as u64
}

#[cfg(test)]
mod tests;
