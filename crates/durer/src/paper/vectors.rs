//! A sheet as the target of painting operations, for maps and SVG drawings as vectors.

use crate::Result;
use crate::clip::polygon::{rectangle, sutherland_hodgman};
use crate::curve::{Path, PathElement, flatten, pieces};
use crate::math::{DAffine2, DVec2, Rect};
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::{self, Cap, Join, Stroke};
use crate::raster::paint::{Blend, MaskKind, Options, Paint, PaintTarget};
use crate::target::sheet::{ClipPath, Mark, MarkGroup, Pen, Sheet, SheetLayer};
use crate::target::{Curve, Piece};
use crate::trace::NoTrace;
use crate::work::Work;
use std::collections::BTreeSet;

/// Millimetres of a pixel: 96 of them are an inch, as in CSS.
const MILLIMETRES: f64 = 25.4 / 96.0;

/// Largest relative difference of the axes of a map that keeps the shape of pens.
const SIMILAR: f64 = 1e-9;

/// Name of the recorded marks in errors about memory.
const NOTED: &str = "marks of the drawing";

/// Painter of marks onto a sheet, whose pixels are 1/96 inch.
///
/// Strokes with round joins become strokes with pens; other strokes, dashed and translucent ones become areas of the
/// same outline. Parts far beyond the sheet are cut off.
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
    marks: Vec<Mark>,
    open: Vec<Open>,
    refused: BTreeSet<&'static str>,
}

/// A clip path, mask or group that is open, with its marks.
#[derive(Debug)]
struct Open {
    kind: Kind,
    marks: Vec<Mark>,
}

#[derive(Debug, Clone)]
enum Kind {
    Clip(ClipPath),
    /// A clip path that holds the whole sheet, or a finished mask.
    Everything,
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
        }
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
        while !self.open.is_empty() {
            self.pop(1.0);
        }
        self.open.extend(kinds.into_iter().map(|kind| Open { kind, marks: Vec::new() }));
        let marks = std::mem::take(&mut self.marks);
        match self.sheet.layers.last_mut() {
            Some(layer) => layer.marks.extend(marks),
            None if marks.is_empty() => {}
            None => self.sheet.layers.push(SheetLayer { name: "drawing".to_owned(), marks }),
        }
    }

    fn push(&mut self, mark: Mark) {
        if !self.work.keep_or_stop(NOTED, bytes(&mark)) {
            return;
        }
        match self.open.last_mut() {
            Some(open) => open.marks.push(mark),
            None => self.marks.push(mark),
        }
    }

    /// Returns the colour of a paint; notes other paints.
    fn color(&mut self, paint: &Paint, opacity: f64) -> Option<[u8; 4]> {
        match paint {
            Paint::Color([r, g, b, a]) => {
                let alpha = (f64::from(*a) * opacity.clamp(0.0, 1.0)).round() as u8;
                return (alpha > 0).then_some([*r, *g, *b, alpha]);
            }
            Paint::Gradient(_) => self.leave_out("gradients"),
            Paint::Pattern(_) => self.leave_out("bitmaps and patterns"),
        }
        None
    }

    /// Returns the sheet with as much room around it as its longer side.
    fn around(&self) -> Option<Rect> {
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

    fn add_area(&mut self, path: &Path, rule: FillRule, color: [u8; 4]) {
        let (curves, even_odd) = (contours(path, true), rule == FillRule::EvenOdd);
        if curves.is_empty() {
            return;
        }
        if curves.iter().all(Curve::is_straight) {
            let rings = curves.iter().map(corners).collect();
            return self.push(Mark::Fill { rings, color, even_odd });
        }
        self.push(Mark::Area { rings: curves, color, even_odd });
    }

    /// Returns whether a pen can draw a stroke along these curves.
    fn is_for_pen(&self, curves: &[Curve], stroke: &Stroke, alpha: u8) -> bool {
        let [x, y] = [self.paper_from_path.matrix2.x_axis, self.paper_from_path.matrix2.y_axis];
        let (scale, skew) = (x.length(), x.dot(y).abs());
        let is_similar = (y.length() - scale).abs() <= SIMILAR * scale
            && skew <= SIMILAR * scale * scale
            && scale > 0.0;
        let is_round = stroke.join == Join::Round
            && (stroke.cap == Cap::Round || curves.iter().all(|curve| curve.closed));
        // Translucent strokes that cross would be darker there.
        let is_plain = stroke.dashes.is_empty() && (alpha == 255 || curves.len() == 1);
        is_similar && is_round && is_plain
    }

    /// Returns curves without the parts of their lines that are far from the sheet.
    fn near(&self, curves: Vec<Curve>, width: f64) -> Result<Vec<Curve>> {
        let reach = DVec2::splat(width);
        let Some(around) = self.around() else { return Ok(curves) };
        let around = Rect::new(around.min() - reach, around.max() + reach)?;
        let is_near = |curve: &Curve| {
            let points = curve.pieces.iter().flat_map(|piece| match *piece {
                Piece::Cubic(a, b, end) => [a, b, end],
                Piece::Line(end) | Piece::Arc(_, end) => [end; 3],
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

    fn pen(&mut self, width: f64, color: [u8; 4]) -> usize {
        let pen = Pen { width, color, dashes: Vec::new() };
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
        if let Some(color) = self.color(paint, opacity) {
            self.add_area(&self.outline(path), rule, color);
        }
    }

    fn stroke(&mut self, path: &Path, stroke: &Stroke, paint: &Paint, opacity: f64) -> Result<()> {
        wide::check(stroke)?;
        self.work.check()?;
        let Some(color) = self.color(paint, opacity).filter(|_| stroke.width > 0.0) else {
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
        if self.is_for_pen(&curves, stroke, color[3]) {
            let pen = self.pen(width, color);
            for curve in curves {
                self.push(match curve.is_straight() {
                    true => Mark::Stroke { points: corners(&curve), closed: curve.closed, pen },
                    false => Mark::Curve { curve, pen },
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
        self.add_area(&self.outline(&filled), FillRule::NonZero, color);
        Ok(())
    }

    fn push_clip(&mut self, path: &Path, rule: FillRule) {
        let path = self.outline(path);
        let paper = [DVec2::ZERO, self.sheet.size];
        let kind = match upright(&path) {
            Some(inside) if paper.iter().all(|corner| inside.contains(*corner)) => Kind::Everything,
            _ => Kind::Clip(ClipPath {
                rings: contours(&path, true),
                even_odd: rule == FillRule::EvenOdd,
            }),
        };
        self.open.push(Open { kind, marks: Vec::new() });
    }

    fn push_group(&mut self) {
        self.open.push(Open { kind: Kind::Group, marks: Vec::new() });
    }

    fn begin_mask(&mut self) {
        self.leave_out("masks and clip paths of several shapes");
        self.open.push(Open { kind: Kind::Mask, marks: Vec::new() });
    }

    fn end_mask(&mut self, _kind: MaskKind) {
        let Some(mask) = self.open.iter().rposition(|open| matches!(open.kind, Kind::Mask)) else {
            return;
        };
        self.open.truncate(mask);
        self.open.push(Open { kind: Kind::Everything, marks: Vec::new() });
    }

    fn pop_blended(&mut self, opacity: f64, blend: Blend) {
        let Some(Open { kind, marks }) = self.open.pop() else { return };
        if blend != Blend::Normal {
            self.leave_out("blend modes");
        }
        let (clip, opacity) = match kind {
            _ if marks.is_empty() => return,
            Kind::Mask => return,
            Kind::Clip(clip) => (Some(clip), 1.0),
            Kind::Group if opacity < 1.0 => (None, opacity.max(0.0)),
            Kind::Group | Kind::Everything => {
                let below = self.open.last_mut().map_or(&mut self.marks, |open| &mut open.marks);
                return below.extend(marks);
            }
        };
        self.push(Mark::Group(Box::new(MarkGroup { marks, clip, opacity })));
    }

    fn leave_out(&mut self, what: &'static str) {
        self.refused.insert(what);
    }
}

/// Returns about the bytes that a mark takes, without those of marks in it.
fn bytes(mark: &Mark) -> u64 {
    let own = match mark {
        Mark::Fill { rings, .. } => rings.iter().map(|r| size_of_val(&r[..]) + 24).sum(),
        Mark::Stroke { points, .. } => size_of_val(&points[..]),
        Mark::Curve { curve, .. } => size_of_val(&curve.pieces[..]),
        Mark::Area { rings, .. } => rings.iter().map(|r| size_of_val(&r.pieces[..]) + 48).sum(),
        Mark::Text { .. } | Mark::Dimension(_) | Mark::Group(_) => 0,
    };
    (size_of::<Mark>() + own) as u64
}

/// Returns the contours of a path that have an extent, all of them closed where areas are meant.
fn contours(path: &Path, areas: bool) -> Vec<Curve> {
    let mut found: Vec<Curve> = Vec::new();
    let mut open: Option<Curve> = None;
    let mut end = |open: &mut Option<Curve>, closes: bool| {
        let Some(mut curve) = open.take().filter(|curve| !curve.pieces.is_empty()) else { return };
        if closes || areas {
            if curve.end() != curve.start {
                curve.pieces.push(Piece::Line(curve.start));
            }
            curve.closed = true;
        }
        let points = curve.pieces.iter().map(Piece::end).chain([curve.start]);
        if points.into_iter().all(DVec2::is_finite) {
            found.push(curve);
        }
    };
    let mut start = DVec2::ZERO;
    for element in path.elements() {
        let piece = match *element {
            PathElement::MoveTo(p) => {
                end(&mut open, false);
                start = p;
                open = Some(Curve { start: p, pieces: Vec::new(), closed: false });
                continue;
            }
            PathElement::Close => {
                end(&mut open, true);
                continue;
            }
            PathElement::LineTo(p) => Piece::Line(p),
            PathElement::QuadTo(c, p) => {
                let from = open.as_ref().map_or(start, Curve::end);
                Piece::Cubic(from.lerp(c, 2.0 / 3.0), p.lerp(c, 2.0 / 3.0), p)
            }
            PathElement::CubicTo(a, b, p) => Piece::Cubic(a, b, p),
        };
        // After its end, a contour continues at its start.
        let curve = open.get_or_insert(Curve { start, pieces: Vec::new(), closed: false });
        curve.pieces.push(piece);
    }
    end(&mut open, false);
    found
}

/// Returns the points of a straight curve; of a closed one, the first is not repeated.
fn corners(curve: &Curve) -> Vec<DVec2> {
    let mut points: Vec<DVec2> =
        std::iter::once(curve.start).chain(curve.pieces.iter().map(Piece::end)).collect();
    if curve.closed && points.len() > 1 {
        points.pop();
    }
    points
}

/// Returns the rectangle that a path is, if it is an upright one.
fn upright(path: &Path) -> Option<Rect> {
    let curves = contours(path, true);
    let [curve] = &curves[..] else { return None };
    let points = corners(curve);
    let &[a, b, c, d] = &points[..] else { return None };
    let is_upright = (a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y)
        || (a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x);
    if is_upright && curve.is_straight() { Rect::around(points) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::paint;
    use crate::raster::paint::Canvas;
    use crate::target::Pixels;

    const SIDE: u32 = 64;

    /// Returns the largest difference of a picture that is drawn directly from one that is drawn by way of a sheet.
    fn difference(draw: impl Fn(&mut dyn PaintTarget)) -> u8 {
        let mut canvas = Canvas::new(SIDE, SIDE, Options::default()).expect("canvas");
        let mut painter = SheetPainter::new(SIDE, SIDE);
        canvas.clear([255; 4]);
        draw(&mut canvas);
        draw(&mut painter);
        let mut direct = Pixels::new(SIDE, SIDE, [255; 4]);
        canvas.render(&mut direct).expect("rendered");
        assert!(direct.data().iter().any(|pixel| *pixel != [255; 4]), "nothing is painted");
        let sheet = painter.into_sheet().expect("vectors");
        let by_sheet = paint(sheet, SIDE, SIDE, [255; 4]).expect("painted");
        let channels = direct.data().iter().flatten().zip(by_sheet.data().iter().flatten());
        channels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    }

    fn star(far: f64) -> Path {
        let corners = [(32.0, 4.0), (50.0, 60.0), (4.0, 24.0), (60.0, 24.0), (14.0, far)];
        Path::polygon(corners.map(DVec2::from))
    }

    #[test]
    fn a_sheet_shows_what_a_canvas_shows() {
        let red = Paint::Color([200, 0, 0, 255]);
        let thin = Paint::Color([0, 0, 90, 120]);
        let round = Stroke { width: 3.0, cap: Cap::Round, join: Join::Round, ..Stroke::default() };
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            for far in [60.0, 1e7] {
                assert!(difference(|t| t.fill(&star(far), rule, &red, 0.7)) <= 2, "{rule:?} {far}");
                let clipped = difference(|t| {
                    t.push_clip(&star(far), rule);
                    t.fill(&Path::circle(DVec2::splat(30.0), 25.0), FillRule::NonZero, &red, 1.0);
                    t.pop(1.0);
                    t.fill(&Path::circle(DVec2::splat(9.0), 5.0), FillRule::NonZero, &red, 1.0);
                });
                assert!(clipped <= 3, "{rule:?} {far}: {clipped}");
            }
        }
        let dashed = Stroke { dashes: vec![5.0, 3.0], cap: Cap::Butt, ..round.clone() };
        let mitred = Stroke { join: Join::Miter, cap: Cap::Square, ..round.clone() };
        for stroke in [&round, &dashed, &mitred] {
            for (paint, far) in [(&red, 60.0), (&thin, 60.0), (&red, 1e5)] {
                let found = difference(|t| {
                    t.set_transform(DAffine2::from_scale(DVec2::new(1.0, 0.8)));
                    t.stroke(&star(far), stroke, paint, 1.0).expect("stroke");
                    t.set_transform(DAffine2::IDENTITY);
                    t.stroke(&star(far), stroke, paint, 0.5).expect("stroke");
                });
                assert!(found <= 6, "{stroke:?} {far}: {found}");
            }
        }
        let group = difference(|t| {
            t.push_group();
            t.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
            t.push_group();
            t.fill(&Path::circle(DVec2::splat(30.0), 25.0), FillRule::NonZero, &thin, 1.0);
            t.pop(1.0);
            t.pop(0.4);
        });
        assert!(group <= 3, "{group}");
    }

    #[test]
    fn layers_keep_the_clip_paths_that_are_open() {
        let mut painter = SheetPainter::new(SIDE, SIDE);
        let red = Paint::Color([200, 0, 0, 255]);
        painter.push_clip(&Path::rectangle(-1.0, -1.0, 99.0, 99.0), FillRule::NonZero);
        painter.push_clip(&Path::rectangle(8.0, 8.0, 9.0, 9.0), FillRule::NonZero);
        for name in ["a", "a", "b"] {
            painter.begin_layer(name);
            painter.fill(&star(60.0), FillRule::NonZero, &red, 1.0);
        }
        let sheet = painter.into_sheet().expect("vectors");
        let names: Vec<&str> = sheet.layers.iter().map(|layer| &layer.name[..]).collect();
        assert_eq!(names, ["a", "a-2", "b"]);
        for layer in &sheet.layers {
            let [Mark::Group(group)] = &layer.marks[..] else { panic!("{:?}", layer.marks) };
            assert!(group.clip.is_some() && group.marks.len() == 1);
        }
    }

    #[test]
    fn content_without_vectors_is_named() {
        let mut painter = SheetPainter::new(SIDE, SIDE);
        painter.begin_mask();
        painter.end_mask(MaskKind::Alpha);
        painter.push_group();
        painter.pop_blended(1.0, Blend::Multiply);
        let refused = painter.into_sheet().expect_err("refused");
        let names = ["blend modes", "masks and clip paths of several shapes"];
        assert_eq!(Vec::from_iter(refused), names);
    }
}
