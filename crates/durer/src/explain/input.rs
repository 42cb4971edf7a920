//! Inputs that algorithms are explained on: an example by name, or data of one's own.

use super::words::Word;
use crate::clip::polygon::{BooleanOp, WindingRule};
use crate::math::{DVec2, DVec3, DVec4, Rect};
use crate::{Error, Result};

/// Points of an input that can be explained: more cannot be read in a picture.
pub const MAX_POINTS: usize = 2_000;

/// Input of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    /// An example of the lesson, by its name; the first one for an empty name.
    Example(String),
    /// Windows, lines and polygons in the plane.
    Figure(Figure),
    /// Faces in space, corner by corner, seen from +z.
    Faces(Vec<Vec<DVec3>>),
    /// A ring of homogeneous points, or a segment of two, in clip space.
    ClipSpace(Vec<DVec4>),
    /// A picture to be filled.
    Grid(Grid),
}

/// Windows, lines and polygons in the plane; each algorithm takes those that it needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// The window, if there is one.
    pub window: Option<Rect>,
    /// Lines from point to point, or control points.
    pub lines: Vec<Vec<DVec2>>,
    /// Rings of the subject, closed by themselves.
    pub rings: Vec<Vec<DVec2>>,
    /// Rings of the clip; without any, the window's border.
    pub clip: Vec<Vec<DVec2>>,
    /// Single points.
    pub points: Vec<DVec2>,
}

/// A picture with few colours.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Grid {
    /// Columns of the picture.
    pub columns: u32,
    /// Colours row by row from the top, as numbers.
    pub cells: Vec<u8>,
    /// Column and row of the seed.
    pub seed: [u32; 2],
}

/// Choices for a run; each algorithm uses those that it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Operation on two regions.
    pub operation: BooleanOp,
    /// Rule that decides which points are inside rings.
    pub rule: WindingRule,
}

impl Input {
    /// Returns what kind of input it is, for messages.
    fn kind(&self) -> &'static str {
        match self {
            Self::Example(_) => "an example",
            Self::Figure(_) => "shapes of the plane",
            Self::Faces(_) => "faces in space",
            Self::ClipSpace(_) => "points of clip space",
            Self::Grid(_) => "a picture",
        }
    }

    /// Returns the number of points, or of pixels.
    fn size(&self) -> usize {
        match self {
            Self::Example(_) => 0,
            Self::Figure(figure) => figure.points().count(),
            Self::Faces(faces) => faces.iter().map(Vec::len).sum(),
            Self::ClipSpace(points) => points.len(),
            Self::Grid(grid) => grid.cells.len(),
        }
    }

    /// Checks that the input can be drawn: finite and not too large.
    pub(super) fn check(&self) -> Result<()> {
        let size = self.size();
        if size > MAX_POINTS {
            let (value, limit) = (size as u64, MAX_POINTS as u64);
            return Err(Error::Limit { what: "number of points to be explained", value, limit });
        }
        let wrong = match self {
            Self::Example(_) => None,
            Self::Figure(figure) => figure.points().position(|p| !drawable(p.to_array())),
            Self::Faces(faces) => faces.iter().flatten().position(|p| !drawable(p.to_array())),
            Self::ClipSpace(points) => points.iter().position(|p| !drawable(p.to_array())),
            Self::Grid(grid) => return grid.check(),
        };
        match wrong {
            Some(index) => {
                let value = format!("one whose point {index} is not finite, or is huge");
                Err(Error::parameter("input", value, "of coordinates between −1e100 and 1e100"))
            }
            None => Ok(()),
        }
    }

    /// Returns the shapes of the plane.
    ///
    /// # Errors
    /// [`Error::Parameter`] for another kind of input; the error names `wanted` as the right one.
    pub(crate) fn figure(&self, wanted: Word) -> Result<&Figure> {
        if let Self::Figure(figure) = self { Ok(figure) } else { Err(self.wrong(wanted)) }
    }

    /// Returns the faces.
    ///
    /// # Errors
    /// [`Error::Parameter`] for another kind of input; the error names `wanted` as the right one.
    pub(crate) fn faces(&self, wanted: Word) -> Result<&[Vec<DVec3>]> {
        if let Self::Faces(faces) = self { Ok(faces) } else { Err(self.wrong(wanted)) }
    }

    /// Returns the points of clip space.
    ///
    /// # Errors
    /// [`Error::Parameter`] for another kind of input; the error names `wanted` as the right one.
    pub(crate) fn clip_space(&self, wanted: Word) -> Result<&[DVec4]> {
        if let Self::ClipSpace(points) = self { Ok(points) } else { Err(self.wrong(wanted)) }
    }

    /// Returns the picture.
    ///
    /// # Errors
    /// [`Error::Parameter`] for another kind of input; the error names `wanted` as the right one.
    pub(crate) fn grid(&self, wanted: Word) -> Result<&Grid> {
        if let Self::Grid(grid) = self { Ok(grid) } else { Err(self.wrong(wanted)) }
    }

    fn wrong(&self, wanted: Word) -> Error {
        Error::parameter("input", self.kind(), wanted.en)
    }
}

/// Returns whether a point is finite, and small enough for arithmetic with it to be so.
fn drawable<const N: usize>(p: [f64; N]) -> bool {
    p.iter().all(|x| x.abs() < 1e100)
}

impl Figure {
    /// Returns all points.
    pub fn points(&self) -> impl Iterator<Item = DVec2> + '_ {
        let window = self.window.iter().flat_map(|w| [w.min(), w.max()]);
        let rings = self.lines.iter().chain(&self.rings).chain(&self.clip).flatten();
        window.chain(rings.chain(&self.points).copied())
    }

    /// Returns the window.
    pub(super) fn window(&self, wanted: Word) -> Result<Rect> {
        self.window.ok_or_else(|| Error::parameter("input", "without a window", wanted.en))
    }

    /// Returns the ends of the first line.
    pub(super) fn segment(&self, wanted: Word) -> Result<[DVec2; 2]> {
        let ends = self.lines.first().and_then(|line| Some([*line.first()?, *line.last()?]));
        ends.ok_or_else(|| Error::parameter("input", "without a line", wanted.en))
    }

    /// Returns the subject's first ring.
    pub(super) fn ring(&self, wanted: Word) -> Result<&[DVec2]> {
        let ring = self.rings.iter().find(|ring| ring.len() > 2);
        let missing = || Error::parameter("input", "without a ring of three points", wanted.en);
        ring.map(Vec::as_slice).ok_or_else(missing)
    }

    /// Returns the rings of both operands; those of the clip are the window's border if there are none.
    pub(super) fn operands(&self, wanted: Word) -> Result<[Vec<Vec<DVec2>>; 2]> {
        self.ring(wanted)?;
        if !self.clip.is_empty() {
            return Ok([self.rings.clone(), self.clip.clone()]);
        }
        let window = self.window(wanted)?;
        Ok([self.rings.clone(), vec![super::picture::corners(&window).to_vec()]])
    }
}

impl Grid {
    /// Returns the number of rows.
    pub(crate) fn rows(&self) -> u32 {
        (self.cells.len() / (self.columns.max(1) as usize)) as u32
    }

    fn check(&self) -> Result<()> {
        let whole =
            self.columns > 0 && self.cells.len() == self.columns as usize * self.rows() as usize;
        let [x, y] = self.seed;
        if whole && x < self.columns && y < self.rows() {
            return Ok(());
        }
        let value =
            format!("{} cells in {} columns with seed {x},{y}", self.cells.len(), self.columns);
        Err(Error::parameter("picture", value, "whole rows, with the seed in it"))
    }
}
