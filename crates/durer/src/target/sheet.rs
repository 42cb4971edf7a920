//! A drawing on paper: pens, fills and text in millimetres, in named layers. It is the input of the writers of SVG,
//! PDF, DXF and HPGL, and of painting into pixels.

use super::Curve;
use super::dimension::{DimensionText, Measure};
use super::drawing::TextAnchor;
use super::gradient::Gradient;
use crate::math::DVec2;

/// Pen that draws a stroke.
#[derive(Debug, Clone, PartialEq)]
pub struct Pen {
    /// Width of the stroke, millimetres, > 0.
    pub width: f64,
    /// Colour: sRGB with straight alpha.
    pub color: [u8; 4],
    /// Lengths of dashes and gaps in turn, millimetres: an even number of values, all > 0; empty for a solid line. The
    /// lengths are nominal: each stroke stretches them a little, so that it begins and ends with a whole dash
    /// ([`crate::paper::dashes`]).
    pub dashes: Vec<f64>,
}

/// Mark on the paper.
#[derive(Debug, Clone, PartialEq)]
pub enum PaperMark {
    /// Chain of straight pieces with round caps and joins.
    Stroke {
        /// Points, at least two.
        points: Vec<DVec2>,
        /// True if the last point is joined to the first.
        closed: bool,
        /// Index into [`Sheet::pens`].
        pen: usize,
    },
    /// Chain of lines and curves, with round caps and joins.
    Curve {
        /// Curve of at least one piece.
        curve: Curve,
        /// Index into [`Sheet::pens`].
        pen: usize,
    },
    /// Filled area bounded by straight lines.
    Fill {
        /// Open rings. By the non-zero rule, outer rings run in one direction, holes in the other.
        rings: Vec<Vec<DVec2>>,
        /// Colour: sRGB with straight alpha.
        color: [u8; 4],
        /// True if the rings are filled by the even-odd rule instead of the non-zero rule.
        even_odd: bool,
    },
    /// Filled area bounded by lines and curves.
    Area {
        /// Closed rings. By the non-zero rule, outer rings run in one direction, holes in the other.
        rings: Vec<Curve>,
        /// Colour: sRGB with straight alpha.
        color: [u8; 4],
        /// True if the rings are filled by the even-odd rule instead of the non-zero rule.
        even_odd: bool,
    },
    /// Filled area whose colour changes. SVG and PDF files and pixels have them.
    Gradient(Box<GradientArea>),
    /// Line of text.
    Text {
        /// Point of the base line.
        at: DVec2,
        /// The text itself.
        text: String,
        /// Height of capital letters, millimetres.
        height: f64,
        /// Alignment with `at`.
        anchor: TextAnchor,
        /// Index into [`Sheet::pens`].
        pen: usize,
    },
    /// Dimension with its lines, arrows and text.
    Dimension(Box<Dimension>),
    /// Marks with a common clip path and opacity. SVG and PDF files and pixels have them.
    Group(Box<MarkGroup>),
}

/// Filled area whose colour changes along a line or between two circles.
#[derive(Debug, Clone, PartialEq)]
pub struct GradientArea {
    /// Closed rings. By the non-zero rule, outer rings run in one direction, holes in the other.
    pub rings: Vec<Curve>,
    /// True if the rings are filled by the even-odd rule instead of the non-zero rule.
    pub even_odd: bool,
    /// The colours; lengths in millimetres of the paper.
    pub gradient: Gradient,
}

/// Marks that are painted onto an empty layer, which is then laid over the marks below it.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkGroup {
    /// The marks, in the order of drawing.
    pub marks: Vec<PaperMark>,
    /// Area outside of which nothing is shown.
    pub clip: Option<ClipPath>,
    /// Opacity of the layer, 0 … 1.
    pub opacity: f64,
}

/// Area that marks are restricted to.
#[derive(Debug, Clone, PartialEq)]
pub struct ClipPath {
    /// Closed rings.
    pub rings: Vec<Curve>,
    /// True if the even-odd rule decides which points are inside; otherwise the non-zero rule.
    pub even_odd: bool,
}

/// Dimension: the measured points, for programs that measure again, and the marks that draw it.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// Measured quantity.
    pub measure: Measure,
    /// True value: a length in units of the model, or an angle in radians.
    pub value: f64,
    /// Units of the model per millimetre of the sheet.
    pub units_per_millimetre: f64,
    /// True if the text is just the value, with the usual sign before it.
    pub is_plain: bool,
    /// Strokes and fills: the lines, and the arrows.
    pub marks: Vec<PaperMark>,
    /// The text.
    pub text: DimensionText,
}

/// Marks that are shown or hidden together.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetLayer {
    /// A name such as `visible-silhouette`; unique in its sheet.
    pub name: String,
    /// The marks, in the order of drawing.
    pub marks: Vec<PaperMark>,
}

impl PaperMark {
    /// Returns whether the mark is an area, which covers the marks beneath.
    pub(crate) const fn is_area(&self) -> bool {
        matches!(self, Self::Fill { .. } | Self::Area { .. } | Self::Gradient(_))
    }
}

/// Sheet of paper. Coordinates are millimetres from the upper left corner, y down.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// Title of the file; may be empty.
    pub title: String,
    /// Width and height, millimetres.
    pub size: DVec2,
    /// Colour of the paper; `None` leaves it blank.
    pub background: Option<[u8; 4]>,
    /// The pens that marks refer to.
    pub pens: Vec<Pen>,
    /// The layers, the lowest first.
    pub layers: Vec<SheetLayer>,
}
