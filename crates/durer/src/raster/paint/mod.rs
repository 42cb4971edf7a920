//! Painting: filled and stroked paths with colours, gradients, opacity, groups and clip paths.
//!
//! A [`Canvas`] records painting commands and then renders the target in bands of rows, each band with all commands in
//! order. Bands are the parallel task; the picture is the same for any number of threads.

mod bands;
mod blend;
mod color;
mod command;
mod outline;
mod source;
mod target;

pub use blend::BlendFunction;
pub use source::{Color, ImageFilter, Paint, Pattern};
pub use target::PaintTarget;

use std::sync::{Mutex, PoisonError};

use super::coverage::band::PartsOfPath;
use super::coverage::convex::Strip;
use super::coverage::{self, FillRule, Overlap, check_size};
use super::line::anti_aliased;
use super::line::wide::{self, Stroke};
use crate::curve::{Contours, Path, flatten};
use crate::math::{DAffine2, DVec2, Rect};
use crate::simd::{Level, default_level};
use crate::target::Pixels;
use crate::trace::NoTrace;
use crate::work::{Charge, Work};
use crate::{Error, Result};
use color::{Linear, Space, Srgb};
use command::{Brush, Command, Line, Open, Prepared};
use outline::{Filler, Lists, Outline};

/// Property of a picture that becomes the coverage of a mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MaskKind {
    /// Opacity.
    #[default]
    Alpha,
    /// Luminance: 0.2126 R + 0.7152 G + 0.0722 B of the colours as they are mixed, over black.
    Luminance,
}

/// Space in which colours are mixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Blending {
    /// The sRGB bytes themselves, as browsers and SVG viewers do.
    #[default]
    Srgb,
    /// Linear light, as nature does; 16 bits per channel.
    Linear,
}

/// Options of a canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Space in which colours are mixed.
    pub blending: Blending,
    /// Treatment of pixels in which a path overlaps itself. For strokes, which do so wherever they bend,
    /// [`Overlap::Adaptive`] means [`Overlap::Measured`].
    pub overlap: Overlap,
    /// Largest distance between a curve and its chords in pixels. 0.025 is at most 6/255 of coverage
    /// where a curve bends most; the number of chords grows with its inverse square root.
    pub tolerance: f64,
    /// True if edges are smoothed; otherwise a pixel is painted when its centre is inside
    /// ([`super::polygon`]). [`Canvas::set_anti_alias`] changes it for later commands.
    pub anti_alias: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            blending: Blending::Srgb,
            overlap: Overlap::Adaptive,
            tolerance: 0.025,
            anti_alias: true,
        }
    }
}

/// A list of commands that paint onto a target of a given size.
///
/// ```
/// use durer::curve::Path;
/// use durer::math::DVec2;
/// use durer::raster::coverage::FillRule;
/// use durer::raster::paint::{Canvas, Options, Paint};
/// use durer::target::Pixels;
///
/// let mut canvas = Canvas::new(20, 20, Options::default()).unwrap();
/// let red = Paint::Color([200, 0, 0, 255]);
/// canvas.fill(&Path::circle(DVec2::splat(10.0), 8.0), FillRule::NonZero, &red, 1.0);
/// let mut target = Pixels::new(20, 20, [255; 4]);
/// canvas.render(&mut target).unwrap();
/// assert_eq!(target.get(10, 10), Some([200, 0, 0, 255]));
/// assert_eq!(target.get(0, 0), Some([255; 4]));
/// ```
#[derive(Debug)]
pub struct Canvas {
    width: u32,
    height: u32,
    options: Options,
    transform: DAffine2,
    /// Colour that every pixel is set to first; `None` keeps the target's.
    background: Option<Color>,
    commands: Vec<Command>,
    /// Thin straight lines, which commands count through.
    lines: Vec<Line>,
    /// Clips, groups and masks that are open, in order of opening.
    open: Vec<Open>,
    anti_alias: bool,
    /// Edges of the commands.
    lists: Lists,
    /// Buffers that threads have painted with, for the next picture.
    fillers: Mutex<Vec<Filler>>,
    /// Budget for the recorded commands, and their cancellation.
    work: Work,
    /// Bytes of edges that commands have for themselves.
    own_edges: u64,
    /// Bytes that are charged.
    charged: u64,
}

/// Number of bytes recorded between two charges.
const CHARGE: u64 = 1 << 18;

/// Number of points of a stroke's outline after which their edges are made before the outline continues.
const PART: usize = 1 << 16;

/// Name of the recorded commands in errors about memory.
const NOTED: &str = "outlines of what is painted";

impl Canvas {
    /// Creates an empty list for targets of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`Error::TooLarge`] for sides beyond 32,767 pixels.
    pub fn new(width: u32, height: u32, options: Options) -> Result<Self> {
        check_size(width, height)?;
        let transform = DAffine2::IDENTITY;
        let (background, commands, lines, open) = (None, vec![], vec![], vec![]);
        let anti_alias = options.anti_alias;
        let (lists, fillers) = (Lists::default(), Mutex::default());
        Ok(Self {
            width,
            height,
            options,
            transform,
            background,
            commands,
            lines,
            open,
            anti_alias,
            lists,
            fillers,
            work: Work::default(),
            own_edges: 0,
            charged: 0,
        })
    }

    /// Charges the memory for recorded commands to a budget. If the budget is exceeded or the work is stopped, nothing
    /// more is recorded and [`Self::render`] returns the error.
    pub fn set_work(&mut self, work: &Work) {
        self.work = work.part();
        self.work.enter(NOTED);
        self.charged = 0;
    }

    /// Returns the work that it is a part of.
    pub(crate) fn work(&self) -> &Work {
        &self.work
    }

    /// Returns the width of the target in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height of the target in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the options.
    pub(crate) fn options(&self) -> &Options {
        &self.options
    }

    /// Forgets all that has been painted so far and sets every pixel to one colour instead, cheaper than filling the
    /// target before. Keeps the memory, so that picture after picture costs less on one canvas than on a new one each.
    pub fn clear(&mut self, color: Color) {
        self.restart();
        self.background = Some(color);
    }

    /// Forgets all that has been painted so far and all that is open, and paints later marks over the pixels of the
    /// target: so a long list is painted in parts. Keeps the memory.
    ///
    /// If the target is opaque and colours are mixed in sRGB, parts give the same bytes as the whole.
    pub(crate) fn restart(&mut self) {
        self.background = None;
        self.commands.clear();
        self.lines.clear();
        self.open.clear();
        self.lists.clear();
        self.own_edges = 0;
        let work = self.work.part();
        self.set_work(&work);
    }

    /// Charges the memory recorded since the last charge, if it is much.
    fn charge(&mut self) {
        let commands = self.commands.capacity() * size_of::<Command>();
        let lines = self.lines.capacity() * size_of::<Line>();
        let bytes = (commands + lines) as u64 + self.lists.bytes() + self.own_edges;
        if bytes >= self.charged + CHARGE && self.work.keep_or_stop(NOTED, bytes - self.charged) {
            self.charged = bytes;
        }
    }

    /// Sets the map from the space of paths and paints to pixels, for later commands.
    pub fn set_transform(&mut self, pixel_from_path: DAffine2) {
        self.transform = pixel_from_path;
    }

    /// Sets whether the edges of later shapes are smoothed; initially by the options.
    pub fn set_anti_alias(&mut self, smooth: bool) {
        self.anti_alias = smooth;
    }

    /// Fills a path; open contours are closed. `opacity` 0 … 1 multiplies the paint's own.
    pub fn fill(&mut self, path: &Path, rule: FillRule, paint: &Paint, opacity: f64) {
        self.fill_contours(&self.flattened(path), rule, paint, opacity);
    }

    /// Strokes a path: its outline is made in the path's space, so that a transform shapes the pen too.
    ///
    /// # Errors
    /// The errors of [`wide::outline`] for a wrong style.
    pub fn stroke(
        &mut self,
        path: &Path,
        stroke: &Stroke,
        paint: &Paint,
        opacity: f64,
    ) -> Result<()> {
        wide::check(stroke)?;
        self.work.check()?;
        if let Some(line) = self.line(path, stroke, paint, opacity) {
            self.push_line(line);
            return Ok(());
        }
        let near = self.window().and_then(|window| wide::parts_near(path, stroke, window));
        let outline = self.stroked(near.as_ref().unwrap_or(path), stroke)?;
        let overlap = match self.options.overlap {
            Overlap::Adaptive => Overlap::Measured,
            chosen => chosen,
        };
        let how = coverage::Options { rule: FillRule::NonZero, overlap };
        self.push_fill(outline, how, paint, opacity);
        Ok(())
    }

    /// Returns the target, and a pixel around it, in the space of paths.
    fn window(&self) -> Option<Rect> {
        let (low, high) =
            (DVec2::splat(-1.0), DVec2::new(f64::from(self.width), f64::from(self.height)) + 1.0);
        let inverse = self.transform.inverse();
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        let corners = corners.map(|p| inverse.transform_point2(p));
        // A map that cannot be inverted has no window.
        if corners.iter().all(|p| p.is_finite()) { Rect::around(corners) } else { None }
    }

    /// Returns the edges of a stroke. They are made part by part, because outlines have many times as many points as
    /// paths.
    fn stroked(&mut self, path: &Path, stroke: &Stroke) -> Result<Outline> {
        let tolerance = self.options.tolerance / stretch(self.transform).max(1e-9);
        let (map, size) = (self.transform, (self.width, self.height));
        let is_whole = !self.anti_alias;
        let mut parts: Option<PartsOfPath> = None;
        let cost = wide::cost(path, tolerance);
        let _walk = self.hold(if cost < CHARGE { 0 } else { cost })?;
        let (mut charge, mut bytes) = (self.hold(0)?, 0);
        let mut refused = None;
        let part = |contours: &mut Contours| {
            if refused.is_some() {
                contours.clear();
            }
            if is_whole || contours.points().len() < PART {
                return;
            }
            let taken = std::mem::take(contours).transformed(map);
            bytes += parts.get_or_insert_with(PartsOfPath::new).add(&taken, size);
            refused = charge.grow_to(bytes).err();
        };
        let rest = wide::outline_in_parts(path, stroke, tolerance, &mut NoTrace, part)?;
        if let Some(error) = refused {
            self.work.stop(error.clone());
            return Err(error);
        }
        // From here on it is counted with the rest.
        drop(charge);
        let rest = rest.transformed(map);
        let Some(mut parts) = parts else { return Ok(self.outline(&rest)) };
        parts.add(&rest, size);
        let outline = Outline::of_parts(parts, &mut self.lists);
        self.own_edges += outline.bytes();
        self.charge();
        Ok(outline)
    }

    /// Charges memory for a while; if it does not fit the work is stopped.
    fn hold(&self, bytes: u64) -> Result<Charge> {
        self.work.charge(NOTED, bytes).inspect_err(|error| self.work.stop(error.clone()))
    }

    /// Returns a thin straight line of one colour inside the target, which needs no path; `None` for anything else.
    fn line(&self, path: &Path, stroke: &Stroke, paint: &Paint, opacity: f64) -> Option<Line> {
        let Paint::Color(color) = *paint else { return None };
        let (from, to) = wide::straight(path, stroke).filter(|_| self.anti_alias)?;
        let corners = anti_aliased::corners(from, to, stroke.width)?;
        let corners = corners.map(|p| self.transform.transform_point2(p));
        let strip = Strip::new(corners, self.width, self.height)?;
        Some(Line { strip, color, opacity: source::opacity(opacity) as f32 })
    }

    fn push_line(&mut self, line: Line) {
        let at = self.lines.len() as u32;
        match self.commands.last_mut() {
            Some(Command::Lines { last, .. }) => *last = at + 1,
            _ => self.commands.push(Command::Lines { first: at, last: at + 1 }),
        }
        let grows = self.lines.len() == self.lines.capacity();
        self.lines.push(line);
        if grows {
            self.charge();
        }
    }

    /// Fills contours that are already straight and in pixels; the paint still follows the transform.
    pub fn fill_contours(
        &mut self,
        contours: &Contours,
        rule: FillRule,
        paint: &Paint,
        opacity: f64,
    ) {
        let overlap = self.options.overlap;
        self.fill_as(contours, coverage::Options { rule, overlap }, paint, opacity);
    }

    fn fill_as(
        &mut self,
        contours: &Contours,
        how: coverage::Options,
        paint: &Paint,
        opacity: f64,
    ) {
        if self.work.is_stopped() {
            return;
        }
        let outline = self.outline(contours);
        self.push_fill(outline, how, paint, opacity);
    }

    fn push_fill(&mut self, outline: Outline, how: coverage::Options, paint: &Paint, opacity: f64) {
        if outline.rows().0 < outline.rows().1 {
            let brush = Brush::new(paint, self.transform, opacity);
            self.commands.push(Command::Fill { outline, how, brush });
        }
    }

    fn outline(&mut self, contours: &Contours) -> Outline {
        let size = (self.width, self.height);
        let outline = Outline::new(contours, size, self.anti_alias, &mut self.lists);
        self.own_edges += outline.bytes();
        self.charge();
        outline
    }

    /// Restricts later marks to the inside of a path, within the clip paths already in force.
    pub fn push_clip(&mut self, path: &Path, rule: FillRule) {
        let contours = self.flattened(path);
        if holds_all(&contours, [self.width, self.height].map(f64::from)) {
            // Fills that are not cut need no mask.
            return self.open.push(Open::Everything);
        }
        let outline = self.outline(&contours);
        let how = coverage::Options { rule, overlap: self.options.overlap };
        self.commands.push(Command::PushClip { outline, how });
        self.open.push(Open::Clip);
    }

    /// Starts a group: later marks are painted onto an empty layer.
    pub fn push_group(&mut self) {
        self.commands.push(Command::PushGroup);
        self.open.push(Open::Group);
    }

    /// Starts a mask: until [`Canvas::end_mask`], marks are not shown but painted onto a separate layer, without the
    /// clip paths in force.
    pub fn begin_mask(&mut self) {
        self.commands.push(Command::BeginMask);
        self.open.push(Open::Mask);
    }

    /// Ends the mask begun last, and everything still open inside it: from here on the marks painted since then
    /// restrict later ones, as a clip path does, until the mask is popped. If no mask is open, nothing happens.
    pub fn end_mask(&mut self, kind: MaskKind) {
        if !self.open.contains(&Open::Mask) {
            return;
        }
        while self.open.last().is_some_and(|open| *open != Open::Mask) {
            self.pop(1.0);
        }
        self.open.pop();
        self.commands.push(Command::EndMask { kind });
        self.open.push(Open::Clip);
    }

    /// Ends the clip path, mask or group opened last; the layer of a group is laid over the layers below it with the
    /// given opacity 0 … 1. If nothing is open, nothing happens.
    pub fn pop(&mut self, opacity: f64) {
        self.pop_blended(opacity, BlendFunction::Normal);
    }

    /// Ends what was opened last as [`Canvas::pop`] does, and blends the colours of a group's layer with those below it
    /// in the layer that the group was started on. Groups are isolated: marks within a group blend only with the
    /// group's own layer.
    pub fn pop_blended(&mut self, opacity: f64, blend: BlendFunction) {
        if self.open.last() == Some(&Open::Mask) {
            self.end_mask(MaskKind::Alpha);
        }
        match self.open.pop() {
            Some(Open::Group) => self.commands.push(Command::PopGroup { opacity, blend }),
            Some(Open::Clip | Open::Mask) => self.commands.push(Command::PopClip),
            Some(Open::Everything) | None => {}
        }
    }

    fn flattened(&self, path: &Path) -> Contours {
        if self.transform == DAffine2::IDENTITY {
            flatten(path, self.options.tolerance)
        } else {
            flatten(&path.transformed(self.transform), self.options.tolerance)
        }
    }

    /// Paints everything over the target, which keeps straight alpha. Groups still open are composited with full
    /// opacity.
    ///
    /// # Errors
    /// [`Error::Parameter`] if the target differs in size from the canvas; the error of stopped work, after which the
    /// target's contents are unspecified.
    pub fn render(&self, target: &mut Pixels<Color>) -> Result<()> {
        self.render_at(default_level(), target)
    }

    fn render_at(&self, level: Level, target: &mut Pixels<Color>) -> Result<()> {
        if (target.width(), target.height()) != (self.width, self.height) {
            let size = format!("{}x{}", target.width(), target.height());
            return Err(Error::parameter("target size", size, "the size of the canvas"));
        }
        self.work.check()?;
        self.work.enter("painting");
        match self.options.blending {
            Blending::Srgb => bands::render::<Srgb>(level, self, &self.prepared(), target),
            Blending::Linear => bands::render::<Linear>(level, self, &self.prepared(), target),
        }
        self.work.check()
    }

    /// Returns buffers used before, or new ones.
    fn filler(&self) -> Filler {
        let spare = self.fillers.lock().unwrap_or_else(PoisonError::into_inner).pop();
        spare.unwrap_or_else(|| Filler::new(self.width))
    }

    fn keep(&self, filler: Filler) {
        self.fillers.lock().unwrap_or_else(PoisonError::into_inner).push(filler);
    }

    fn prepared<P: Space>(&self) -> Vec<Prepared<'_, P>> {
        // Clip paths, masks and groups left open are closed.
        let closing = self.open.iter().rev().flat_map(Open::closing);
        self.commands.iter().map(|command| command.prepared(&self.lists)).chain(closing).collect()
    }
}

/// Returns the length of the longest image of a unit vector.
fn stretch(map: DAffine2) -> f64 {
    let (a, b) = (map.matrix2.x_axis, map.matrix2.y_axis);
    let (sum, difference) = (a.dot(a) + b.dot(b), a.dot(a) - b.dot(b));
    ((sum + libm::hypot(difference, 2.0 * a.dot(b))) / 2.0).sqrt()
}

/// Returns whether contours are one upright rectangle that holds a picture of this size.
fn holds_all(contours: &Contours, [width, height]: [f64; 2]) -> bool {
    let points = match contours.points() {
        [points @ .., last] if points.len() == 4 && *last == points[0] => points,
        points => points,
    };
    let &[a, b, c, d] = points else { return false };
    let upright = (a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y)
        || (a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x);
    let (min, max) = (a.min(c), a.max(c));
    contours.iter().count() == 1
        && upright
        && min.cmple(DVec2::ZERO).all()
        && max.cmpge(DVec2::new(width, height)).all()
}

#[cfg(test)]
mod tests;
