//! Steps of the algorithm, and the drawing that follows from them.

use super::super::arrange::{Pieces, arrange, corners};
use super::super::page::Page;
use super::super::piece::Piece;
use super::cover::{Cover, spans};
use super::span::HiddenSpan;
use super::{Options, cut};
use crate::math::DVec2;
use crate::target::drawing::{Line, LineClass};
use crate::trace::PseudocodeLine;

/// Step of the algorithm.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// The grid was laid.
    Page(Page),
    /// One line was held against the faces that overlap it.
    Line {
        /// Class of the line.
        class: LineClass,
        /// True if it is a silhouette across a part of the surface that is not sharp there.
        smooth: bool,
        /// Its ends in the plane of the picture.
        ends: [DVec2; 2],
        /// Items of the faces that it was compared with, each once: those in the cells of the grid that it crosses,
        /// less the faces that it lies on.
        tried: Vec<u32>,
        /// Parts that hide it, by item.
        covers: Vec<Cover>,
        /// From where to where along it the surface hides its own outline, 0 … 1; nowhere if the same.
        fold: [f64; 2],
    },
}

impl Step {
    /// Returns the parts of a line by their invisibility, in their order along it; none for other steps.
    pub fn spans(&self) -> Vec<HiddenSpan> {
        let mut found = Vec::new();
        if let Self::Line { covers, fold, .. } = self {
            spans(covers, *fold, 0.0, true, &mut found);
        }
        found
    }
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Page(_) => 1,
            Self::Line { covers, .. } if covers.is_empty() => 12,
            Self::Line { .. } => 10,
        }
    }
}

/// Returns the lines that a list of steps leads to.
pub fn replay(steps: &[Step], options: &Options) -> Vec<Line> {
    let Some(Step::Page(page)) = steps.first() else { return Vec::new() };
    let (mut all, mut spans, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for step in steps {
        if let Step::Line { class, smooth, ends, covers, fold, .. } = step {
            let ends = ends.map(|p| page.grid_from_plane(p));
            let like = Piece { ends, class: *class, invisibility: 0, smooth: *smooth };
            cut(like, covers, *fold, options.hidden, &mut spans, &mut all);
            lines.push((*class, *smooth, ends));
        }
    }
    let corners = corners(lines.into_iter());
    arrange(page, Pieces { all, corners }, options.how())
}
