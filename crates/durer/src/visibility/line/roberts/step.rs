//! Steps of Roberts' algorithm.

use super::VisibleLine;
use crate::math::DVec3;
use crate::trace::PseudocodeLine;

/// Values of one plane of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Values {
    /// Value at the start of the line, p of the textbooks: positive inside.
    pub start: f64,
    /// Value at its end, p + q.
    pub end: f64,
    /// Value at the eye, w.
    pub eye: f64,
}

/// A restriction of the part of a line that may be hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// The planes whose equations are solved together: one that bounds α from below, where none means α = 0, and one
    /// that bounds it from above.
    pub planes: [Option<usize>; 2],
    /// Parameter of the solution; none if the two exclude each other along the whole line.
    pub t: Option<f64>,
    /// Part of the line that may still be hidden.
    pub part: [f64; 2],
}

/// Step of the algorithm. Bodies, planes and lines have the numbers of their order.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// The planes of a body are compared with the eye.
    Body {
        /// The body.
        body: usize,
        /// Value of each plane at the eye; negative for the faces that are seen.
        eye: Vec<f64>,
    },
    /// A line between two faces that look away: its own body hides it.
    SelfHidden {
        /// The body.
        body: usize,
        /// Ends of the line.
        ends: [DVec3; 2],
    },
    /// A line that its own body does not hide.
    Line {
        /// Its number.
        line: usize,
        /// The body that has this edge, or the two whose faces meet along it.
        bodies: [usize; 2],
        /// Its ends.
        ends: [DVec3; 2],
    },
    /// A plane of a body has the line on the eye's side: the body does not hide it.
    Apart {
        /// The line.
        line: usize,
        /// The body.
        body: usize,
        /// The plane.
        plane: usize,
        /// Values of all planes.
        values: Vec<Values>,
    },
    /// The inequalities of a body are set up.
    Compare {
        /// The line.
        line: usize,
        /// The body.
        body: usize,
        /// Values of all planes.
        values: Vec<Values>,
    },
    /// Two of the inequalities bound the parameter of the line.
    Bound {
        /// The line.
        line: usize,
        /// The body.
        body: usize,
        /// The bound.
        bound: Bound,
    },
    /// The body hides a part of the line.
    Hidden {
        /// The line.
        line: usize,
        /// The body.
        body: usize,
        /// Parameters between which it is hidden.
        part: [f64; 2],
    },
    /// The line has been compared with all bodies.
    Visible {
        /// The line.
        line: usize,
        /// Parameters of the parts that are seen, in their order.
        parts: Vec<[f64; 2]>,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Body { .. } => 3,
            Self::SelfHidden { .. } => 4,
            Self::Line { .. } => 6,
            Self::Apart { .. } => 8,
            Self::Compare { .. } => 9,
            Self::Bound { .. } => 11,
            Self::Hidden { .. } => 12,
            Self::Visible { .. } => 13,
        }
    }
}

/// Returns the lines that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<VisibleLine> {
    let mut lines: Vec<VisibleLine> = Vec::new();
    for step in steps {
        match step {
            Step::Line { bodies, ends, .. } => {
                lines.push(VisibleLine { bodies: *bodies, ends: *ends, visible: vec![[0.0, 1.0]] });
            }
            Step::Hidden { line, part, .. } => {
                if let Some(line) = lines.get_mut(*line) {
                    line.hide(*part);
                }
            }
            _ => {}
        }
    }
    lines
}
