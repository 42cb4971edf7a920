//! Dimensions on a sheet ([`Dimension`](super::sheet::Dimension)): the measured points or circles, and the text.

use crate::math::DVec2;

/// Measured quantity of a dimension; all points in the sheet's millimetres, y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// The distance of two points along a direction.
    Linear {
        /// The points.
        ends: [DVec2; 2],
        /// A point of the dimension line.
        line: DVec2,
        /// The direction of the dimension line, of unit length.
        along: DVec2,
    },
    /// The diameter of a circle.
    Diameter {
        /// The far and the near end, as seen from the text, of the diameter that the leader is in line with.
        ends: [DVec2; 2],
    },
    /// The radius of an arc.
    Radius {
        /// The centre of the circle.
        center: DVec2,
        /// The point of the arc that the leader ends in.
        at: DVec2,
    },
    /// The angle at a point between two others.
    Angle {
        /// The point.
        vertex: DVec2,
        /// The others, counter-clockwise as seen.
        ends: [DVec2; 2],
        /// A point of the arc.
        arc: DVec2,
    },
}

/// The text of a dimension, in its middle.
#[derive(Debug, Clone, PartialEq)]
pub struct DimensionText {
    /// Middle of the base line, in millimetres.
    pub at: DVec2,
    /// Direction, of unit length.
    pub along: DVec2,
    /// The text itself.
    pub text: String,
    /// Height of capital letters, millimetres.
    pub height: f64,
    /// Index into [`super::sheet::Sheet::pens`].
    pub pen: usize,
}
