//! Plots of surfaces y = f(x, z): visible lines, filled cells, axes, laid out on paper.
//!
//! [`surface`] gives the plot's lines, regions and labels as a [`Drawing`], which [`Plot::into_sheet`] lays on paper;
//! the lines come from [`floating_horizon`].

mod axes;
mod cells;
mod color_bar;
pub(crate) mod color_map;
pub mod ticks;

pub use color_map::ColorMap;

use crate::math::{DVec2, DVec3, Rect};
use crate::scene::{Aabb, Camera, HeightField, Projection};
use crate::target::drawing::{Drawing, Line, LineClass, Region, TextLabel};
use crate::target::sheet::{PaperMark, Pen, Sheet, SheetLayer};
use crate::trace::NoTrace;
use crate::view::picture_plane::PicturePlane;
use crate::view::projection::{FitOptions, Lens, ViewDirection, fit_box};
use crate::visibility::line::floating_horizon::{self, GridChain, LineFamily};
use crate::{Error, Result};

/// Options for plotting a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Direction in which the plot is seen.
    pub direction: ViewDirection,
    /// Perspective or parallel.
    pub lens: Lens,
    /// Position of the eye and the point that it looks at, (x, height, z), instead of `direction`: in perspective only,
    /// and all of the surface's box must be in front of it. The plot is fitted to the paper as always.
    pub eye: Option<[DVec3; 2]>,
    /// Rows and columns that become lines, and the treatment of hidden parts.
    pub lines: floating_horizon::Options,
    /// Factor for heights; labels show the true ones.
    pub exaggeration: f64,
    /// Depth over width of the ground as it is seen; labels show the true coordinates. `None` has one scale for both.
    pub aspect: Option<f64>,
    /// True if there is a bar with the colours of heights, if there is a colour map.
    pub color_bar: bool,
    /// Colours by height; `None` draws all lines with `ink`, and fills with `paper`.
    pub color_map: Option<ColorMap>,
    /// True if cells are filled, too: with the colours of the map, lines then are `ink`.
    pub fill: bool,
    /// Colour of axes, labels, and lines without a colour of their own; sRGB with straight alpha.
    pub ink: [u8; 4],
    /// Colour of lines on the surface's lower side; `None` takes no notice of sides.
    pub underside: Option<[u8; 4]>,
    /// Axes with ticks and labels; `None` draws none.
    pub axes: Option<Axes>,
    /// Written above the plot; may be empty.
    pub title: String,
    /// Width and height of the paper, millimetres.
    pub page: DVec2,
    /// Colour of the paper; `None` leaves it blank.
    pub background: Option<[u8; 4]>,
    /// Width of the surface's lines, millimetres.
    pub pen: f64,
    /// Height of capitals in labels, millimetres.
    pub text: f64,
}

/// Names of the axes, and their directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// Names of x, y and z; empty ones are not written.
    pub names: [String; 3],
    /// True if labels along z show −z: the northing of a map.
    pub z_is_south: bool,
}

/// A plot.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Its geometry in the plane of the picture.
    pub drawing: Drawing,
    /// The camera, in coordinates with exaggerated heights.
    pub camera: Camera,
    layout: Layout,
    /// Layer and colour of each line of the drawing.
    inks: Vec<Ink>,
    /// The lowest and the highest height.
    heights: Option<[f64; 2]>,
    options: Options,
}

/// A margin around everything, millimetres.
const MARGIN: f64 = 4.0;
/// Steps of colour along a line: finer ones are not distinguished.
const SHADES: usize = 32;
/// Dashes and gaps of hidden lines, in widths of the pen.
const DASHES: [f64; 2] = [6.0, 4.0];
/// Hidden lines are this much thinner.
const HIDDEN_PEN: f64 = 0.6;
/// Half the height of the box around a level surface, over the longer side of its ground.
const FLAT_HEIGHT: f64 = 0.1;
/// Width of the bar of colours and its distance from the plot, in letter heights, and its height as a share of the
/// page's.
const BAR: [f64; 3] = [1.4, 2.0, 0.5];
/// Ratio of title letters to label letters, and distance of a title's lines in letter heights.
const TITLE: [f64; 2] = [1.4, 1.5];
/// Visible pieces shorter than this, in millimetres, are dots that a pen would only blot.
const SHORTEST: f64 = 0.02;

/// The layers of lines, the lowest first.
const LAYERS: [&str; 5] =
    ["hidden-along-x", "hidden-along-z", "lines-along-x", "lines-along-z", "axes"];

/// Layer and colour of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ink {
    /// Index into [`LAYERS`].
    layer: usize,
    color: [u8; 4],
}

/// A line with its pen.
type Inked = (Line, Ink);

/// Plots a surface.
///
/// ```
/// use durer::math::DVec2;
/// use durer::plot::{Options, surface};
/// use durer::scene::HeightField;
/// let field = HeightField::from_fn([30, 30], [-2.0, 2.0], [-2.0, 2.0], |x, z| x * x - z * z)?;
/// let plot = surface(&field, &Options::default())?;
/// let sheet = plot.into_sheet();
/// assert_eq!(sheet.size, DVec2::new(180.0, 135.0));
/// assert!(sheet.layers.iter().any(|l| l.name == "axes"));
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for a number out of its range, or a field without heights; the errors of the camera and the
/// projection.
pub fn surface(field: &HeightField, options: &Options) -> Result<Plot> {
    options.check()?;
    let seen = as_seen(field, options)?;
    let bounds = seen.bounds().ok_or_else(|| {
        Error::parameter("height field", "without any height", "a surface with heights")
    })?;
    let bounds = with_height(&bounds);
    let room = (options.page - DVec2::splat(2.0 * MARGIN)).max(DVec2::ONE);
    let fit = FitOptions { lens: options.lens, aspect: room.x / room.y, margin: 0.0 };
    let camera = match options.eye {
        Some(places) => standing(&bounds, places, field, options)?,
        None => fit_box(Some(&bounds), &options.direction, &fit)?,
    };
    let plane = PicturePlane::of_camera(&camera, fit.aspect)?;
    let heights = field.range();
    let mut layout = Layout::new(&bounds, &plane, heights, &[], 1.0, options);
    let mut marks = Marks::default();
    if let Some(axes) = &options.axes {
        // How much room labels take follows from the scale, and the scale from that.
        for _ in 0..4 {
            marks = axes::draw(field, &seen, &bounds, &plane, axes, options, layout.scale);
            layout = Layout::new(&bounds, &plane, heights, &marks.labels, layout.scale, options);
        }
        marks = axes::draw(field, &seen, &bounds, &plane, axes, options, layout.scale);
    }
    let mut inked = surface_lines(&seen, &camera, &plane, options)?;
    let least = SHORTEST / layout.scale;
    inked.retain(|(line, _)| line.length() >= least);
    let ink = Ink { layer: LAYERS.len() - 1, color: options.ink };
    inked.extend(marks.lines.into_iter().map(|line| (line, ink)));
    let (lines, inks): (Vec<Line>, Vec<Ink>) = inked.into_iter().unzip();
    if lines.iter().flat_map(|l| &l.points).any(|p| !p.is_finite()) {
        return Err(Error::NonFinite { what: "projected line", index: 0 });
    }
    let mut drawing = Drawing { lines, labels: marks.labels, ..Drawing::default() };
    if options.fill {
        drawing.regions = cells::regions(&seen, &camera, &plane, options)?;
    }
    Ok(Plot { drawing, camera, layout, inks, heights, options: options.clone() })
}

/// Returns the lines of the grid.
fn surface_lines(
    field: &HeightField,
    camera: &Camera,
    plane: &PicturePlane,
    options: &Options,
) -> Result<Vec<Inked>> {
    let mut lines = Vec::new();
    for curve in floating_horizon::curves(field, camera, &options.lines, &mut NoTrace)? {
        colored(&curve, field, plane, options, &mut lines);
    }
    Ok(lines)
}

/// Returns the factor by which depth is stretched.
fn stretch(field: &HeightField, options: &Options) -> f64 {
    let extent = |[from, to]: [f64; 2]| (to - from).abs();
    let true_aspect = extent(field.z_range()) / extent(field.x_range());
    let by = options.aspect.map_or(1.0, |aspect| aspect / true_aspect);
    if by > 0.0 && by.is_finite() { by } else { 1.0 }
}

/// Returns a field with its heights and depths as they are seen.
fn as_seen(field: &HeightField, options: &Options) -> Result<HeightField> {
    let by = stretch(field, options);
    let seen = field.map(|y| y * options.exaggeration);
    if by == 1.0 {
        Ok(seen)
    } else {
        seen.with_ranges(field.x_range(), field.z_range().map(|z| z * by))
    }
}

/// Returns the bounds with some height, where all heights are one: an upright axis needs it.
fn with_height(bounds: &Aabb) -> Aabb {
    let size = bounds.max - bounds.min;
    let up = if size.y > 0.0 { 0.0 } else { size.x.max(size.z) * FLAT_HEIGHT };
    Aabb { min: bounds.min - DVec3::Y * up, max: bounds.max + DVec3::Y * up }
}

/// Returns the camera of an eye at a given place, in coordinates with exaggerated heights.
fn standing(
    bounds: &Aabb,
    places: [DVec3; 2],
    field: &HeightField,
    options: &Options,
) -> Result<Camera> {
    let Lens::Perspective { fov_y } = options.lens else {
        return Err(Error::parameter("eye", "in parallel projection", "perspective"));
    };
    let seen = DVec3::new(1.0, options.exaggeration, stretch(field, options));
    let [eye, target] = places.map(|p| p * seen);
    let sight = (target - eye).normalize_or_zero();
    let depths = bounds.corners().map(|c| (c - eye).dot(sight));
    let near = depths.into_iter().fold(f64::INFINITY, f64::min);
    let far = depths.into_iter().fold(0.0, f64::max);
    // The minimum at which the axes are visible.
    if !(near > 1e-3 * far && far.is_finite()) {
        let expected = "a place with the whole surface in front of it";
        return Err(Error::parameter("eye", places[0], expected));
    }
    let up = if sight.y.abs() < 0.9999 { DVec3::Y } else { DVec3::NEG_Z };
    let projection = Projection::Perspective { fov_y };
    let camera = Camera { eye, target, up, projection, near: near * 0.5, far: far * 2.0 };
    camera.check()?;
    Ok(camera)
}

impl Default for Options {
    /// Returns all lines, black, in parallel projection from azimuth 30° and elevation 30°, on 180 × 135
    /// mm, with axes; true heights.
    fn default() -> Self {
        let direction = crate::view::projection::NamedView::Iso.direction(crate::scene::UpAxis::Y);
        Self {
            direction,
            lens: Lens::Orthographic,
            eye: None,
            lines: floating_horizon::Options::default(),
            exaggeration: 1.0,
            aspect: None,
            color_bar: true,
            color_map: None,
            fill: false,
            ink: [0, 0, 0, 255],
            underside: None,
            axes: Some(Axes::default()),
            title: String::new(),
            page: DVec2::new(180.0, 135.0),
            background: Some([255; 4]),
            pen: 0.18,
            text: 2.5,
        }
    }
}

impl Default for Axes {
    fn default() -> Self {
        Self { names: ["x", "y", "z"].map(str::to_owned), z_is_south: false }
    }
}

impl Options {
    fn check(&self) -> Result<()> {
        let positive = |name, value: f64, most: f64, expected| {
            if value > 0.0 && value <= most {
                Ok(())
            } else {
                Err(Error::parameter(name, value, expected))
            }
        };
        positive("exaggeration", self.exaggeration, 1e50, "above 0, at most 1e50")?;
        positive("aspect", self.aspect.unwrap_or(1.0), 1e6, "above 0, at most 1e6")?;
        positive("pen", self.pen, 100.0, "above 0, at most 100 mm")?;
        positive("text height", self.text, 100.0, "above 0, at most 100 mm")?;
        positive("page", self.page.x.min(self.page.y), 1e5, "20 mm to 100 m")?;
        if !(self.page.min_element() >= 20.0 && self.page.max_element() <= 1e5) {
            let value = format!("{} × {} mm", self.page.x, self.page.y);
            return Err(Error::parameter("page", value, "20 mm to 100 m"));
        }
        Ok(())
    }

    /// Returns the colour of a height, 0 the lowest and 1 the highest.
    fn color_at(&self, part: f64) -> Option<[u8; 4]> {
        self.color_map.map(|map| map.at(part))
    }
}

/// Splits a curve where its colour changes, and projects its parts.
fn colored(
    curve: &GridChain,
    field: &HeightField,
    plane: &PicturePlane,
    options: &Options,
    out: &mut Vec<Inked>,
) {
    let layer = match (curve.visible, curve.family) {
        (false, LineFamily::AlongX) => 0,
        (false, LineFamily::AlongZ) => 1,
        (true, LineFamily::AlongX) => 2,
        (true, LineFamily::AlongZ) => 3,
    };
    let plain = if curve.underside { options.underside } else { None };
    let mut add = |points: &[DVec3], color: [u8; 4]| {
        for points in floating_horizon::projected(points, plane) {
            let invisibility = u32::from(!curve.visible);
            let line = Line { class: LineClass::Grid, invisibility, points, closed: false };
            out.push((line, Ink { layer, color }));
        }
    };
    let (Some(map), None, false) = (options.color_map, plain, options.fill) else {
        return add(&curve.points, plain.unwrap_or(options.ink));
    };
    let Some([low, high]) = field.range() else { return };
    let shade = |y: f64| part(y, low, high) * SHADES as f64;
    let color = |shade: usize| map.at((shade.min(SHADES - 1) as f64 + 0.5) / SHADES as f64);
    let mut chain = vec![curve.points[0]];
    let mut now = (shade(curve.points[0].y) as usize).min(SHADES - 1);
    for pair in curve.points.windows(2) {
        let (from, to) = (shade(pair[0].y), shade(pair[1].y));
        loop {
            // The next border between two shades along the line, if there is one.
            let up = to > from;
            let border = if up { now as f64 + 1.0 } else { now as f64 };
            let beyond = if up { to > border && now + 1 < SHADES } else { to < border && now > 0 };
            if !beyond {
                break;
            }
            let t = ((border - from) / (to - from)).clamp(0.0, 1.0);
            let cut = pair[0].lerp(pair[1], t);
            chain.push(cut);
            add(&chain, color(now));
            chain = vec![cut];
            now = if up { now + 1 } else { now - 1 };
        }
        chain.push(pair[1]);
    }
    add(&chain, color(now));
}

/// Returns the position of a height between the lowest and the highest, 0 … 1; a half if all are
/// equal.
fn part(y: f64, low: f64, high: f64) -> f64 {
    let part = (y - low) / (high - low);
    if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 }
}

/// Placement of the plot on the paper.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layout {
    /// Millimetres per plane unit.
    scale: f64,
    /// Position of the plane's origin on the paper.
    origin: DVec2,
}

impl Layout {
    /// Creates the largest plot for which its labels, laid out at a scale, the title and the bar of colours
    /// have room.
    fn new(
        bounds: &Aabb,
        plane: &PicturePlane,
        heights: Option<[f64; 2]>,
        labels: &[TextLabel],
        scale: f64,
        options: &Options,
    ) -> Self {
        let corners = bounds.corners().into_iter().filter_map(|c| plane.project(c));
        let frame = Rect::around(corners);
        let (min, max) = frame.map_or((DVec2::ZERO, DVec2::ZERO), |r| (r.min(), r.max()));
        // By how much labels reach beyond the plot, in millimetres.
        let boxes = labels.iter().filter_map(|label| axes::box_of(label, options.text / scale));
        let (mut low, mut high) = (min, max);
        boxes.for_each(|b| (low, high) = (low.min(b.min()), high.max(b.max())));
        let (before, after) = ((min - low) * scale, (high - max) * scale);
        let title = title_lines(options).len() as f64 * options.text * TITLE[0] * TITLE[1];
        let (left, right) = (MARGIN + before.x, MARGIN + after.x + bar_width(heights, options));
        let (below, above) = (MARGIN + before.y, MARGIN + after.y + title);
        let room = options.page - DVec2::new(left + right, below + above);
        let room = room.max(options.page * 0.2);
        let size = max - min;
        let ratio = |room: f64, size: f64| if size > 0.0 { room / size } else { f64::INFINITY };
        let scale = ratio(room.x, size.x).min(ratio(room.y, size.y));
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let middle = DVec2::new(left, above) + room * 0.5;
        let center = (min + max) * 0.5;
        Self { scale, origin: middle - DVec2::new(center.x, -center.y) * scale }
    }

    fn place(&self, p: DVec2) -> DVec2 {
        self.origin + DVec2::new(p.x, -p.y) * self.scale
    }

    /// Returns the points of a line or ring on the paper.
    fn placed(&self, mut points: Vec<DVec2>) -> Vec<DVec2> {
        points.iter_mut().for_each(|p| *p = self.place(*p));
        points
    }
}

impl Plot {
    /// Lays the plot on paper, with pens and colours. Layers, the lowest first: `surface`, `hidden-along-x`,
    /// `hidden-along-z`, `lines-along-x`, `lines-along-z`, `axes`, `labels`, `colour-bar`; empty ones are left out.
    ///
    /// The geometry is moved, not copied: a clone keeps the [drawing](Self::drawing). Lines and labels added to it are
    /// left out.
    pub fn into_sheet(self) -> Sheet {
        let Self { drawing, layout, inks, heights, options, .. } = self;
        let mut sheet = Sheet {
            title: options.title.clone(),
            size: options.page,
            background: options.background,
            ..Sheet::default()
        };
        let mut layers = vec![("surface", layout.fills(drawing.regions))];
        let mut strokes = [(); LAYERS.len()].map(|()| Vec::new());
        for (line, ink) in drawing.lines.into_iter().zip(inks) {
            let pen = pen_for(&mut sheet.pens, &line, ink.color, &options);
            let points = layout.placed(line.points);
            strokes[ink.layer].push(PaperMark::Stroke { points, closed: line.closed, pen });
        }
        layers.extend(LAYERS.into_iter().zip(strokes));
        layers.push(("labels", layout.texts(&mut sheet, &drawing.labels, &options)));
        layers.push(("colour-bar", color_bar::marks(&mut sheet, heights, &options)));
        layers.retain(|(_, marks)| !marks.is_empty());
        let layer = |(name, marks): (&str, _)| SheetLayer { name: name.to_owned(), marks };
        sheet.layers = layers.into_iter().map(layer).collect();
        sheet
    }
}

impl Layout {
    /// Converts regions to marks; the memory of finished ones is freed along the way.
    fn fills(&self, mut regions: Vec<Region>) -> Vec<PaperMark> {
        let mut marks = Vec::with_capacity(regions.len());
        regions.reverse();
        while let Some(Region { rings, color, .. }) = regions.pop() {
            let rings = rings.into_iter().map(|ring| self.placed(ring)).collect();
            marks.push(PaperMark::Fill { rings, color, even_odd: false });
            if regions.len() < regions.capacity() / 2 {
                regions.shrink_to_fit();
            }
        }
        marks
    }

    fn texts(&self, sheet: &mut Sheet, labels: &[TextLabel], options: &Options) -> Vec<PaperMark> {
        let mut marks = Vec::new();
        let mut pen = |height: f64| {
            let pen = Pen { width: height * 0.1, color: options.ink, dashes: Vec::new() };
            index_of(&mut sheet.pens, pen)
        };
        for label in labels {
            let (at, text) = (self.place(label.at), label.text.clone());
            let (height, anchor) = (label.height, label.anchor);
            marks.push(PaperMark::Text { at, text, height, anchor, pen: pen(height) });
        }
        let height = options.text * TITLE[0];
        for (line, text) in title_lines(options).into_iter().enumerate() {
            let down = MARGIN + height * (1.0 + line as f64 * TITLE[1]);
            marks.push(PaperMark::Text {
                at: DVec2::new(options.page.x * 0.5, down),
                text,
                height,
                anchor: crate::target::drawing::TextAnchor::Middle,
                pen: pen(height),
            });
        }
        marks
    }
}

/// Returns the title in lines that fit the page, broken at blanks.
fn title_lines(options: &Options) -> Vec<String> {
    let width = options.text * TITLE[0] * axes::LETTER;
    let most = (((options.page.x - 2.0 * MARGIN) / width) as usize).max(1);
    let mut lines: Vec<String> = Vec::new();
    for word in options.title.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns the room of the bar of colours with its labels, millimetres.
fn bar_width(heights: Option<[f64; 2]>, options: &Options) -> f64 {
    let labels = color_bar::labels(heights, options);
    let widest = labels.iter().map(|(_, text)| text.chars().count()).max();
    widest.map_or(0.0, |count| (BAR[0] + BAR[1] + 1.0 + count as f64 * axes::LETTER) * options.text)
}

fn pen_for(pens: &mut Vec<Pen>, line: &Line, color: [u8; 4], options: &Options) -> usize {
    let hidden = !line.is_visible();
    let width = options.pen * if hidden { HIDDEN_PEN } else { 1.0 };
    let dashes = if hidden { DASHES.map(|d| d * options.pen).to_vec() } else { Vec::new() };
    index_of(pens, Pen { width, color, dashes })
}

fn index_of(pens: &mut Vec<Pen>, pen: Pen) -> usize {
    pens.iter().position(|p| *p == pen).unwrap_or_else(|| {
        pens.push(pen);
        pens.len() - 1
    })
}

/// Lines and texts of a part of the plot.
#[derive(Default)]
struct Marks {
    lines: Vec<Line>,
    labels: Vec<TextLabel>,
}
