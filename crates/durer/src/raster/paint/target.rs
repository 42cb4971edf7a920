//! The painting operations that pixels and vectors have in common.

use super::{BlendFunction, Canvas, MaskKind, Options, Paint};
use crate::Result;
use crate::curve::Path;
use crate::math::DAffine2;
use crate::raster::coverage::FillRule;
use crate::raster::line::wide::Stroke;
use crate::work::Work;

/// Target of painting operations: a [`Canvas`] for pixels, or a [`crate::paper::SheetPainter`] for vectors.
///
/// The operations are those of [`Canvas`], which explains them.
pub trait PaintTarget {
    /// Returns the options.
    fn options(&self) -> &Options;

    /// Returns the work that it is a part of.
    fn work(&self) -> &Work;

    /// Sets the map from the space of paths and paints to pixels, for later marks.
    fn set_transform(&mut self, pixel_from_path: DAffine2);

    /// Sets whether the edges of later shapes are smoothed.
    fn set_anti_alias(&mut self, smooth: bool);

    /// Fills a path.
    fn fill(&mut self, path: &Path, rule: FillRule, paint: &Paint, opacity: f64);

    /// Strokes a path.
    ///
    /// # Errors
    /// The errors of [`Canvas::stroke`].
    fn stroke(&mut self, path: &Path, stroke: &Stroke, paint: &Paint, opacity: f64) -> Result<()>;

    /// Restricts later marks to the inside of a path.
    fn push_clip(&mut self, path: &Path, rule: FillRule);

    /// Restricts later marks to the inside of any of several paths, if the target needs no mask for that; returns
    /// whether it does.
    fn push_united_clip(&mut self, _paths: &[(Path, FillRule)]) -> bool {
        false
    }

    /// Starts a group.
    fn push_group(&mut self);

    /// Starts a mask.
    fn begin_mask(&mut self);

    /// Ends the mask begun last.
    fn end_mask(&mut self, kind: MaskKind);

    /// Ends the clip path, mask or group opened last, and lays a group over the marks below it.
    fn pop_blended(&mut self, opacity: f64, blend: BlendFunction);

    /// Ends what was opened last as [`PaintTarget::pop_blended`] does, without a blend mode.
    fn pop(&mut self, opacity: f64) {
        self.pop_blended(opacity, BlendFunction::Normal);
    }

    /// Notes that a kind of content is left out because nothing paints it, such as `"filters"`.
    fn leave_out(&mut self, _what: &'static str) {}
}

impl PaintTarget for Canvas {
    fn options(&self) -> &Options {
        self.options()
    }

    fn work(&self) -> &Work {
        self.work()
    }

    fn set_transform(&mut self, pixel_from_path: DAffine2) {
        self.set_transform(pixel_from_path);
    }

    fn set_anti_alias(&mut self, smooth: bool) {
        self.set_anti_alias(smooth);
    }

    fn fill(&mut self, path: &Path, rule: FillRule, paint: &Paint, opacity: f64) {
        self.fill(path, rule, paint, opacity);
    }

    fn stroke(&mut self, path: &Path, stroke: &Stroke, paint: &Paint, opacity: f64) -> Result<()> {
        self.stroke(path, stroke, paint, opacity)
    }

    fn push_clip(&mut self, path: &Path, rule: FillRule) {
        self.push_clip(path, rule);
    }

    fn push_group(&mut self) {
        self.push_group();
    }

    fn begin_mask(&mut self) {
        self.begin_mask();
    }

    fn end_mask(&mut self, kind: MaskKind) {
        self.end_mask(kind);
    }

    fn pop_blended(&mut self, opacity: f64, blend: BlendFunction) {
        self.pop_blended(opacity, blend);
    }
}
