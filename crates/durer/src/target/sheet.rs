//! A drawing on paper: pens, fills and text in millimetres, in named layers. What the writers of SVG,
//! PDF, DXF and HPGL take, and what is painted into pixels.

use super::Curve;
use super::dimension::{DimensionText, Measure};
use super::drawing::Anchor;
use crate::math::DVec2;

/// With what a stroke is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Pen {
    /// Width of the stroke, millimetres, > 0.
    pub width: f64,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
    /// Lengths of dashes and gaps in turn, millimetres; empty for a solid line. An even number of
    /// values, all > 0. They are nominal: each stroke stretches them a little, so that it begins and
    /// ends with a whole dash ([`crate::paper::dashes`]).
    pub dashes: Vec<f64>,
}

/// One thing on the paper.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A chain of straight pieces with round caps and joins.
    Stroke {
        /// At least two points.
        points: Vec<DVec2>,
        /// True if the last point is joined to the first.
        closed: bool,
        /// Index into [`Sheet::pens`].
        pen: usize,
    },
    /// A chain of lines and curves, with round caps and joins.
    Curve {
        /// At least one piece.
        curve: Curve,
        /// Index into [`Sheet::pens`].
        pen: usize,
    },
    /// A filled area.
    Fill {
        /// Open rings, filled by the non-zero rule: outer rings run one way, holes the other.
        rings: Vec<Vec<DVec2>>,
        /// sRGB with straight alpha.
        color: [u8; 4],
    },
    /// A filled area within lines and curves.
    Area {
        /// Closed rings, filled by the non-zero rule: outer rings run one way, holes the other.
        rings: Vec<Curve>,
        /// sRGB with straight alpha.
        color: [u8; 4],
    },
    /// A line of text.
    Text {
        /// Position of the base line.
        at: DVec2,
        /// Subject of the text.
        text: String,
        /// Height of capital letters, millimetres.
        height: f64,
        /// Alignment with `at`.
        anchor: Anchor,
        /// Index into [`Sheet::pens`].
        pen: usize,
    },
    /// A dimension with its lines, arrows and text.
    Dimension(Box<Dimension>),
}

/// A dimension: what it measures, for programs that measure anew, and how it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// Measured quantity.
    pub measure: Measure,
    /// True value: a length in units of the model, or an angle in radians.
    pub value: f64,
    /// Units of the model per millimetre of the sheet.
    pub units_per_millimetre: f64,
    /// True if the text says just the value, with the usual sign before it.
    pub is_plain: bool,
    /// Strokes and fills: the lines, and the arrows.
    pub marks: Vec<Mark>,
    /// The text.
    pub text: DimensionText,
}

/// Marks that are shown or hidden together.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetLayer {
    /// A name such as `visible-silhouette`; unique in its sheet.
    pub name: String,
    /// The marks, in the order of drawing.
    pub marks: Vec<Mark>,
}

impl Mark {
    /// Returns whether it is an area, which covers what is beneath.
    pub const fn is_area(&self) -> bool {
        matches!(self, Self::Fill { .. } | Self::Area { .. })
    }
}

/// A piece of paper. Coordinates are millimetres from the upper left corner, y down.
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
