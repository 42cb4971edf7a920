//! From the plane of a picture to paper: page, scale, pens, line types, layers.
//!
//! [`lay_out`] puts one [`Drawing`] onto a [`Sheet`], [`lay_out_views`] several views of an object with a title block;
//! [`paint`] makes pixels of a sheet, and [`SheetPainter`] makes a sheet of painting
//! operations. Writers of files take sheets.

mod areas;
mod broken;
pub mod dashes;
mod fitted;
mod multiview;
pub mod order;
mod page;
mod paint;
mod parts;
mod pens;
mod placed_view;
mod title_block;
mod vectors;

pub use broken::{Break, Breaks, ViewBreaks};
pub use multiview::{
    Angle, Callout, Contents, Detail, PartsListRow, SheetView, ViewKind, lay_out_views,
};
pub use page::{Page, Scale, scale_text, standard_scale};
pub use paint::paint;
pub use pens::Pens;
pub use placed_view::PlacedView;
pub use title_block::TitleBlock;
pub use vectors::SheetPainter;

use crate::curve::{pieces, stroke_font};
use crate::math::{DVec2, Rect};
use crate::target::dimension::DimensionText;
use crate::target::drawing::{Drawing, Line, LineClass, NEARNESS_STEPS, TextAnchor};
use crate::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};
use crate::target::{Curve, CurvePiece};
use crate::{Error, Result};

/// Treatment of hidden lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Hidden {
    /// They are left out.
    #[default]
    Drop,
    /// They are drawn dashed, in layers `hidden-CLASS`.
    Dashed,
    /// They are drawn thin and grey, in layers `hidden-N-CLASS` by the number N of surfaces in front
    /// of them; the last, N = [`DEEPEST`], has all lines behind that many surfaces or more.
    Layer,
}

/// Hidden lines behind more surfaces than this share a layer.
pub const DEEPEST: u32 = 9;

/// Part of the plane that the paper shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PaperFrame {
    /// All of the drawing, and no more.
    #[default]
    Content,
    /// The drawing's window, if it has one: the camera's field of view.
    Window,
}

/// Options for placing a drawing on paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The paper.
    pub page: Page,
    /// Margin at each side of the paper, in millimetres.
    pub margin: f64,
    /// Scale of the drawing.
    pub scale: Scale,
    /// Millimetres per unit of the model.
    pub unit: f64,
    /// Part of the plane to show.
    pub frame: PaperFrame,
    /// Treatment of hidden lines.
    pub hidden: Hidden,
    /// Pens of the line classes.
    pub pens: Pens,
    /// Largest distance of curves from the polylines that they are fitted to, in millimetres; with 0, lines are
    /// drawn as polylines. See [`crate::curve::fit::Options::tolerance`] and
    /// [`crate::curve::fit::Options::round`].
    pub fit: f64,
    /// True if borders that regions share are fitted too; not for regions that extend under others, which would end
    /// before those do.
    pub fit_areas: bool,
    /// Colour of the paper.
    pub background: Option<[u8; 4]>,
    /// Room around each view for the text beside it, millimetres, on top of the margin.
    pub around: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            page: Page::Fit,
            margin: 5.0,
            scale: Scale::Fit,
            unit: 1.0,
            frame: PaperFrame::Content,
            hidden: Hidden::Drop,
            pens: Pens::default(),
            fit: 0.0,
            fit_areas: false,
            background: None,
            around: 0.0,
        }
    }
}

/// The longer side, millimetres, of a drawing without a given page or scale: it fits the width of A4 with its margins.
const FITTED_SIDE: f64 = 180.0;

/// The largest sheet, in millimetres.
const LARGEST: f64 = 1e6;

impl Options {
    /// Checks the options.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a margin or a fit below 0, or a unit or scale that is not above 0.
    pub(crate) fn check(&self) -> Result<()> {
        if !(self.margin >= 0.0 && self.margin <= LARGEST) {
            return Err(Error::parameter("margin", self.margin, "at least 0 mm"));
        }
        if !(self.unit > 0.0 && self.unit.is_finite()) {
            return Err(Error::parameter("unit", self.unit, "a length above 0 mm"));
        }
        if !(self.fit >= 0.0 && self.fit.is_finite()) {
            return Err(Error::parameter("fit", self.fit, "at least 0 mm"));
        }
        match self.scale {
            Scale::Given(s) if !(s > 0.0 && s.is_finite()) => {
                Err(Error::parameter("scale", s, "finite and above 0"))
            }
            _ => Ok(()),
        }
    }

    /// Returns the page and the scale (paper over truth) for contents of a size in model units, where `taken`
    /// millimetres of the page are not available.
    fn page_and_scale(&self, size: DVec2, taken: DVec2) -> Result<(DVec2, f64)> {
        let size = size * self.unit;
        match self.page {
            Page::Fit => {
                let scale = match self.scale {
                    Scale::Given(scale) => scale,
                    Scale::Fit => largest_scale(size, DVec2::splat(FITTED_SIDE)),
                    Scale::Standard => {
                        standard_scale(largest_scale(size, DVec2::splat(FITTED_SIDE)))
                    }
                };
                let page = size * scale + taken;
                if page.max_element() > LARGEST {
                    let value = format!("{:.0} × {:.0} mm", page.x, page.y);
                    return Err(Error::parameter("the sheet", value, "at most 1000 m long"));
                }
                Ok((page, scale))
            }
            Page::Exact(page) => self.scale_on(page, size, taken).map(|scale| (page, scale)),
            Page::Either(page) => {
                let turned = DVec2::new(page.y, page.x);
                let wide = size.x > size.y;
                let (first, second) = if wide { (turned, page) } else { (page, turned) };
                match (self.scale_on(first, size, taken), self.scale_on(second, size, taken)) {
                    (Ok(a), Ok(b)) if b > a => Ok((second, b)),
                    (Err(_), Ok(b)) => Ok((second, b)),
                    (a, _) => a.map(|a| (first, a)),
                }
            }
        }
    }

    /// Returns the scale for contents of a true size in millimetres on a page.
    fn scale_on(&self, page: DVec2, size: DVec2, taken: DVec2) -> Result<f64> {
        let room = page - taken;
        if room.min_element() < 1.0 {
            let value = format!("{} × {} mm", page.x, page.y);
            return Err(Error::parameter("page", value, "larger than its margins"));
        }
        let largest = largest_scale(size, room);
        match self.scale {
            Scale::Fit => Ok(largest),
            Scale::Standard => Ok(standard_scale(largest)),
            Scale::Given(scale) if scale <= largest * (1.0 + 1e-9) => Ok(scale),
            Scale::Given(scale) => {
                let value = format!(
                    "{}, and the page has room for {} ({})",
                    scale_text(scale),
                    scale_text(largest),
                    scale_text(standard_scale(largest))
                );
                Err(Error::parameter("scale", value, "small enough for the page, or `auto`"))
            }
        }
    }
}

/// Returns the largest scale at which `size` has room.
fn largest_scale(size: DVec2, room: DVec2) -> f64 {
    let ratio = |room: f64, size: f64| if size > 0.0 { room / size } else { f64::INFINITY };
    let scale = ratio(room.x, size.x).min(ratio(room.y, size.y));
    if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
}

/// A drawing on paper.
#[derive(Debug, Clone, PartialEq)]
pub struct LaidOut {
    /// The paper.
    pub sheet: Sheet,
    /// Length on paper over true length.
    pub scale: f64,
    /// Placement of each view on the paper, in the order of the views that were given.
    pub views: Vec<PlacedView>,
    /// Warnings about parts that the paper does not show.
    pub notes: Vec<String>,
}

/// Lays a drawing onto a sheet, in its middle.
///
/// Layers, the lowest first: `regions`, `hidden-…`, `visible-CLASS` with silhouettes on top, `text`;
/// empty ones are left out.
///
/// ```
/// use durer::math::DVec2;
/// use durer::paper::{Options, lay_out};
/// use durer::target::drawing::{Drawing, Line, LineClass};
/// let points = vec![DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 20.0)];
/// let line = Line { class: LineClass::Crease, invisibility: 0, points, closed: true };
/// let drawing = Drawing { lines: vec![line], ..Drawing::default() };
/// let options = Options { page: "A4".parse()?, scale: "2:1".parse()?, ..Options::default() };
/// let laid = lay_out(&drawing, "triangle", &options)?;
/// assert_eq!(laid.sheet.size, DVec2::new(297.0, 210.0)); // turned: the drawing is wider than high
/// assert_eq!(laid.sheet.layers[0].name, "visible-crease");
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for options out of their ranges, and for a scale at which the page is too small.
pub fn lay_out(drawing: &Drawing, title: &str, options: &Options) -> Result<LaidOut> {
    options.check()?;
    let frame = frame_of(drawing, options.frame);
    // Half of the widest pen reaches beyond the points.
    let contours = drawing.lines.iter().any(|l| l.class == LineClass::Contour);
    let wider = if drawing.nearness.is_empty() { 1.0 } else { pens::NEARNESS[0].0 };
    let pen = options.pens.widest(contours) * wider;
    let taken = DVec2::splat(2.0 * (options.margin + options.around) + pen);
    let (size, scale) = options.page_and_scale(frame.size(), taken)?;
    let factor = scale * options.unit;
    let middle = (frame.min() + frame.max()) * 0.5;
    let origin = size * 0.5 - DVec2::new(middle.x, -middle.y) * factor;
    let mut sheet =
        Sheet { title: title.to_owned(), size, background: options.background, ..Sheet::default() };
    put(&mut sheet, &[Placed { drawing, origin, factor }], options);
    let view = PlacedView::new("", None, frame, origin, factor);
    Ok(LaidOut { sheet, scale, views: vec![view], notes: Vec::new() })
}

/// Returns the frame of a drawing; a drawing without extent gets one around the origin.
fn frame_of(drawing: &Drawing, frame: PaperFrame) -> Rect {
    let window = drawing.window.filter(|_| frame == PaperFrame::Window);
    let found = window.or_else(|| drawing.bounds()).or(drawing.window);
    found.or_else(|| Rect::around([DVec2::ZERO])).unwrap_or_else(unit_square)
}

fn unit_square() -> Rect {
    // `around` of a finite point is never `None`; this keeps the promise without a panic.
    Rect::new(DVec2::ZERO, DVec2::ONE).unwrap_or_else(|_| unit_square())
}

/// A drawing whose plane's origin is at a place of the sheet.
struct Placed<'a> {
    drawing: &'a Drawing,
    /// Millimetres.
    origin: DVec2,
    /// Millimetres per plane unit.
    factor: f64,
}

impl<'a> Placed<'a> {
    /// Returns the lines, and how near they are.
    fn lines(&self) -> impl Iterator<Item = (Option<u8>, &'a Line)> + use<'a> {
        let drawing = self.drawing;
        let near = |i: usize| drawing.nearness.get(i).copied().flatten();
        drawing.lines.iter().enumerate().map(move |(i, line)| (near(i), line))
    }
}

/// Puts drawings onto a sheet.
fn put(sheet: &mut Sheet, views: &[Placed], options: &Options) {
    put_regions(sheet, views, if options.fit_areas { options.fit } else { 0.0 });
    let deepest = match options.hidden {
        Hidden::Drop => 0,
        Hidden::Dashed => 1,
        Hidden::Layer => DEEPEST,
    };
    let is_drawn = |l: &&Line| deepest > 0 || l.is_visible();
    let all: Vec<Strokes> = views.iter().map(|v| Strokes::new(v, options.fit, is_drawn)).collect();
    for depth in (0..=deepest).rev() {
        let steps = steps(views, depth);
        let classes = LineClass::ALL.iter().rev();
        for (&class, &step) in classes.flat_map(|class| steps.iter().map(move |s| (class, s))) {
            let (name, pen) = layer_and_pen(class, depth, step, options);
            let here = |(near, l): &(Option<u8>, &Line)| {
                l.class == class && *near == step && l.invisibility.min(deepest) == depth
            };
            let mut marks = Vec::new();
            let pen_index = sheet.pens.iter().position(|p| *p == pen).unwrap_or(sheet.pens.len());
            for strokes in &all {
                for i in (0..strokes.lines.len()).filter(|i| here(&strokes.lines[*i])) {
                    strokes.put(&mut marks, i, pen_index, !pen.dashes.is_empty());
                }
            }
            if !marks.is_empty() {
                if pen_index == sheet.pens.len() {
                    sheet.pens.push(pen);
                }
                sheet.layers.push(SheetLayer { name, marks });
            }
        }
    }
    put_labels(sheet, views, options);
}

/// Returns the steps of nearness that lines behind this many surfaces have, the farthest first.
fn steps(views: &[Placed], depth: u32) -> Vec<Option<u8>> {
    let is_known = depth == 0 && views.iter().any(|v| !v.drawing.nearness.is_empty());
    let near = if is_known { NEARNESS_STEPS } else { 0 };
    [None].into_iter().chain((0..near).rev().map(Some)).collect()
}

fn layer_and_pen(
    class: LineClass,
    depth: u32,
    step: Option<u8>,
    options: &Options,
) -> (String, Pen) {
    match (depth, options.hidden) {
        (0, _) => {
            let suffix = step.map(|s| format!("-near-{}", s + 1)).unwrap_or_default();
            (format!("visible-{class}{suffix}"), options.pens.at_nearness(class, step))
        }
        (_, Hidden::Layer) => {
            (format!("hidden-{depth}-{class}"), options.pens.hidden(class, false))
        }
        _ => (format!("hidden-{class}"), options.pens.hidden(class, true)),
    }
}

/// Converts a point in plane units, y up, to millimetres, y down.
fn onto_paper(p: DVec2, origin: DVec2, factor: f64) -> DVec2 {
    origin + DVec2::new(p.x, -p.y) * factor
}

/// The lines of a view that are drawn.
struct Strokes<'a> {
    /// Lines with their nearness.
    lines: Vec<(Option<u8>, &'a Line)>,
    /// Curve of each line on paper, if it is not drawn as a polyline; none at all without fitting.
    curves: Vec<Option<Curve>>,
    /// Position of the origin, as in [`onto_paper`].
    origin: DVec2,
    factor: f64,
}

impl<'a> Strokes<'a> {
    fn new(view: &Placed<'a>, tolerance: f64, is_drawn: impl Fn(&&Line) -> bool) -> Self {
        let lines: Vec<_> = view.lines().filter(|(_, line)| is_drawn(line)).collect();
        let (origin, factor) = (view.origin, view.factor);
        let curves = match tolerance > 0.0 {
            true => {
                let alone: Vec<&Line> = lines.iter().map(|(_, line)| *line).collect();
                fitted::curves(&alone, origin, factor, tolerance)
            }
            false => Vec::new(),
        };
        Self { lines, curves, origin, factor }
    }

    /// Appends the marks of a line; dashed ones are divided at corners.
    fn put(&self, marks: &mut Vec<PaperMark>, i: usize, pen: usize, dashed: bool) {
        let curve = self.curves.get(i).and_then(Option::as_ref);
        if let Some(curve) = curve.filter(|c| !c.is_straight()) {
            let parts = match dashed {
                true => pieces::at_corners(curve, dashes::CORNER),
                false => vec![curve.clone()],
            };
            marks.extend(parts.into_iter().map(|curve| PaperMark::Curve { curve, pen }));
            return;
        }
        let (_, line) = self.lines[i];
        let place = |p: &DVec2| onto_paper(*p, self.origin, self.factor);
        let points: Vec<DVec2> = match curve {
            Some(curve) => corners(curve),
            None => line.points.iter().map(place).collect(),
        };
        if points.len() < 2 || !points.iter().all(|p| p.is_finite()) {
            return;
        }
        let parts = match dashed {
            true => dashes::at_corners(&points, line.closed),
            false => vec![(points, line.closed)],
        };
        let stroke = |(points, closed)| PaperMark::Stroke { points, closed, pen };
        marks.extend(parts.into_iter().map(stroke));
    }
}

/// Returns the points of a curve of lines; the first one is not repeated.
fn corners(curve: &Curve) -> Vec<DVec2> {
    let last = curve.pieces.last().map(CurvePiece::end).filter(|_| !curve.closed);
    curve.iter().map(|(start, _)| start).chain(last).collect()
}

fn put_regions(sheet: &mut Sheet, views: &[Placed], tolerance: f64) {
    let mut marks = Vec::new();
    for view in views {
        let regions = &view.drawing.regions;
        let mut curves = match tolerance > 0.0 {
            true => areas::borders(regions, view.origin, view.factor, tolerance),
            false => Vec::new(),
        }
        .into_iter();
        for region in regions {
            let ring = |r: &Vec<DVec2>| -> Vec<DVec2> {
                r.iter().map(|p| onto_paper(*p, view.origin, view.factor)).collect()
            };
            if let Some(rings) = curves.next().flatten() {
                marks.push(PaperMark::Area { rings, color: region.color, even_odd: false });
                continue;
            }
            let rings: Vec<Vec<DVec2>> = region.rings.iter().map(ring).collect();
            if rings.iter().flatten().all(|p| p.is_finite()) && !rings.is_empty() {
                marks.push(PaperMark::Fill { rings, color: region.color, even_odd: false });
            }
        }
    }
    if !marks.is_empty() {
        sheet.layers.push(SheetLayer { name: "regions".to_owned(), marks });
    }
}

fn put_labels(sheet: &mut Sheet, views: &[Placed], options: &Options) {
    let mut marks = Vec::new();
    for view in views {
        for label in view.drawing.labels.iter().filter(|l| l.at.is_finite() && l.height > 0.0) {
            let pen = text_pen(sheet, label.height, options);
            let at = onto_paper(label.at, view.origin, view.factor);
            let (text, height, anchor) = (label.text.clone(), label.height, label.anchor);
            marks.push(PaperMark::Text { at, text, height, anchor, pen });
        }
    }
    if !marks.is_empty() {
        sheet.layers.push(SheetLayer { name: "text".to_owned(), marks });
    }
}

/// Returns the pen for letters of a height: a tenth of it (ISO 3098, type B). Its index in the
/// sheet.
fn text_pen(sheet: &mut Sheet, height: f64, options: &Options) -> usize {
    pen_index(sheet, Pen { width: height * 0.1, color: options.pens.color, dashes: Vec::new() })
}

/// Returns the index of a pen, which is added to the sheet if needed.
pub(crate) fn pen_index(sheet: &mut Sheet, pen: Pen) -> usize {
    match sheet.pens.iter().position(|p| *p == pen) {
        Some(index) => index,
        None => {
            sheet.pens.push(pen);
            sheet.pens.len() - 1
        }
    }
}

/// Returns the strokes of a [`PaperMark::Text`], in the sheet's millimetres: letters of the
/// [single-stroke font](stroke_font).
pub fn text_strokes(at: DVec2, text: &str, height: f64, anchor: TextAnchor) -> Vec<Vec<DVec2>> {
    let line = stroke_font::line(text, height);
    let start = at - DVec2::new(line.advance * anchor.share(), 0.0);
    line.strokes.into_iter().map(|s| s.into_iter().map(|p| p + start).collect()).collect()
}

/// Returns the strokes of a dimension's text, in the sheet's millimetres.
pub fn dimension_strokes(text: &DimensionText) -> Vec<Vec<DVec2>> {
    let strokes = text_strokes(DVec2::ZERO, &text.text, text.height, TextAnchor::Middle);
    // With y down as on the sheet: rotating by `along` takes x to it.
    let turn = |p: DVec2| text.at + text.along.rotate(p);
    strokes.into_iter().map(|s| s.into_iter().map(turn).collect()).collect()
}
