//! Painting: filled and stroked paths with colours, gradients, opacity, groups and clip paths.
//!
//! A [`Canvas`] takes note of what is to be painted and then works through the target in bands of
//! rows, each band through all commands in their order. Bands are the parallel task; the picture is the
//! same for any number of threads.

mod bands;
mod color;
mod source;

pub use source::{Color, Gradient, Paint, Pattern, Shape, Spread};

use fearless_simd::Level;

use super::coverage::band::PathEdges;
use super::coverage::{FillRule, Overlap, check_size};
use super::line::wide::{Stroke, outline};
use crate::curve::{Contours, Path, flatten};
use crate::math::DAffine2;
use crate::target::Pixels;
use crate::{Error, Result};
use color::{Linear, Space, Srgb};
use source::Source;

/// In which space colours are mixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Blending {
    /// The sRGB bytes themselves, as browsers and SVG viewers do.
    #[default]
    Srgb,
    /// Linear light, as nature does; 16 bits per channel.
    Linear,
}

/// How a canvas paints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// In which space colours are mixed.
    pub blending: Blending,
    /// What happens where a path overlaps itself inside a pixel.
    pub overlap: Overlap,
    /// Largest distance between a curve and its chords in pixels. 0.05 is at most
    /// 13/255 of coverage where a curve bends most; cost grows with its inverse square root.
    pub tolerance: f64,
    /// Whether edges are smoothed; otherwise a pixel is painted when at least half of it is covered.
    pub anti_alias: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { blending: Blending::Srgb, overlap: Overlap::Exact, tolerance: 0.1, anti_alias: true }
    }
}

/// One thing to do, in order.
#[derive(Debug)]
enum Command {
    Fill { path: PathEdges, rule: FillRule, paint: Paint, opacity: f64, transform: DAffine2 },
    PushClip { path: PathEdges, rule: FillRule },
    PopClip,
    PushGroup,
    PopGroup { opacity: f64 },
}

impl Command {
    fn prepared<P: Space>(&self) -> Prepared<'_, P> {
        match self {
            Self::Fill { path, rule, paint, opacity, transform } => Prepared::Fill {
                path,
                rule: *rule,
                source: Source::new(paint, *transform, *opacity),
            },
            Self::PushClip { path, rule } => Prepared::PushClip { path, rule: *rule },
            Self::PopClip => Prepared::PopClip,
            Self::PushGroup => Prepared::PushGroup,
            Self::PopGroup { opacity } => {
                Prepared::PopGroup { opacity: (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8 }
            }
        }
    }
}

/// A command with its paint made ready for one colour space.
enum Prepared<'a, P> {
    Fill { path: &'a PathEdges, rule: FillRule, source: Source<P> },
    PushClip { path: &'a PathEdges, rule: FillRule },
    PopClip,
    PushGroup,
    PopGroup { opacity: u8 },
}

/// A list of things to paint onto a target of a given size.
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
    /// What every pixel is set to first; `None` keeps the target's.
    background: Option<Color>,
    commands: Vec<Command>,
    /// Clips and groups that are open, in order of opening: `true` for a group.
    open: Vec<bool>,
}

impl Canvas {
    /// An empty list for targets of `width` × `height` pixels.
    ///
    /// # Errors
    /// [`Error::Limit`] for sides beyond 32,767 pixels.
    pub fn new(width: u32, height: u32, options: Options) -> Result<Self> {
        check_size(width, height)?;
        let transform = DAffine2::IDENTITY;
        let (background, commands, open) = (None, vec![], vec![]);
        Ok(Self { width, height, options, transform, background, commands, open })
    }

    /// Forgets what has been painted so far and sets every pixel to one colour instead, cheaper than
    /// filling the target before.
    pub fn clear(&mut self, color: Color) {
        self.background = Some(color);
        self.commands.clear();
        self.open.clear();
    }

    /// Sets the map from the space of paths and paints to pixels, for what follows.
    pub fn set_transform(&mut self, pixel_from_path: DAffine2) {
        self.transform = pixel_from_path;
    }

    /// Fills a path; open contours are closed. `opacity` 0 … 1 multiplies the paint's own.
    pub fn fill(&mut self, path: &Path, rule: FillRule, paint: &Paint, opacity: f64) {
        self.fill_contours(&self.flattened(path), rule, paint, opacity);
    }

    /// Strokes a path: its outline is made in the path's space, so that a transform shapes the pen too.
    ///
    /// # Errors
    /// What [`outline`] finds wrong with the style.
    pub fn stroke(
        &mut self,
        path: &Path,
        stroke: &Stroke,
        paint: &Paint,
        opacity: f64,
    ) -> Result<()> {
        let scale = self.transform.matrix2.determinant().abs().sqrt();
        let tolerance = self.options.tolerance / scale.max(1e-9);
        self.fill(&outline(path, stroke, tolerance)?, FillRule::NonZero, paint, opacity);
        Ok(())
    }

    /// Fills contours that are already straight and in pixels; the paint still follows the transform.
    pub fn fill_contours(
        &mut self,
        contours: &Contours,
        rule: FillRule,
        paint: &Paint,
        opacity: f64,
    ) {
        let path = PathEdges::new(contours, self.width, self.height);
        if path.rows.0 < path.rows.1 {
            let (paint, transform) = (paint.clone(), self.transform);
            self.commands.push(Command::Fill { path, rule, paint, opacity, transform });
        }
    }

    /// Restricts what follows to the inside of a path, within the clip paths already in force.
    pub fn push_clip(&mut self, path: &Path, rule: FillRule) {
        let path = PathEdges::new(&self.flattened(path), self.width, self.height);
        self.commands.push(Command::PushClip { path, rule });
        self.open.push(false);
    }

    /// Starts a group: what follows is painted onto an empty layer.
    pub fn push_group(&mut self) {
        self.commands.push(Command::PushGroup);
        self.open.push(true);
    }

    /// Ends the clip path or group opened last; the layer of a group is laid over what is below it with
    /// the given opacity 0 … 1. Without anything open nothing happens.
    pub fn pop(&mut self, opacity: f64) {
        match self.open.pop() {
            Some(true) => self.commands.push(Command::PopGroup { opacity }),
            Some(false) => self.commands.push(Command::PopClip),
            None => {}
        }
    }

    fn flattened(&self, path: &Path) -> Contours {
        if self.transform == DAffine2::IDENTITY {
            flatten(path, self.options.tolerance)
        } else {
            flatten(&path.transformed(self.transform), self.options.tolerance)
        }
    }

    /// Paints everything over the target, which keeps straight alpha. Groups still open are laid down
    /// fully opaque.
    ///
    /// # Errors
    /// [`Error::Parameter`] where the target has another size than the canvas.
    pub fn render(&self, target: &mut Pixels<Color>) -> Result<()> {
        self.render_at(Level::new(), target)
    }

    fn render_at(&self, level: Level, target: &mut Pixels<Color>) -> Result<()> {
        if (target.width(), target.height()) != (self.width, self.height) {
            let size = format!("{}x{}", target.width(), target.height());
            return Err(Error::parameter("target size", size, "the size of the canvas"));
        }
        match self.options.blending {
            Blending::Srgb => bands::render::<Srgb>(level, self, &self.prepared(), target),
            Blending::Linear => bands::render::<Linear>(level, self, &self.prepared(), target),
        }
        Ok(())
    }

    fn prepared<P: Space>(&self) -> Vec<Prepared<'_, P>> {
        // What was left open is closed.
        let close = |group: &bool| {
            if *group { Prepared::PopGroup { opacity: 255 } } else { Prepared::PopClip }
        };
        let closing = self.open.iter().rev().map(close);
        self.commands.iter().map(Command::prepared).chain(closing).collect()
    }
}

#[cfg(test)]
mod tests;
