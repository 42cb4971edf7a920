//! Pictures of steps: a few kinds of marks in a small set of looks.

use super::words::Value;
use crate::math::{DAffine2, DVec2, Rect};

/// Part that a mark plays in a picture; drawings choose colour, width and hatching by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Look {
    /// Input that is not examined now: grey.
    Pale,
    /// Auxiliary lines: thin and grey.
    Thin,
    /// A grid: thinner.
    Grid,
    /// Windows and other frames: black.
    Window,
    /// Lines drawn on, rays, sweep lines: dashed.
    Dashed,
    /// The subject, or what enters: blue, areas hatched upwards, round dots.
    First,
    /// The other operand, or what leaves: vermilion, areas hatched downwards, square dots.
    Second,
    /// Found to belong to the result: green, areas filled, dots with a ring.
    Result,
    /// Looked at in this step: orange and thick.
    Now,
}

/// Shape of a mark, in the coordinates of its picture.
#[derive(Debug, Clone, PartialEq)]
pub enum MarkShape {
    /// Points joined by lines.
    Chain(Vec<DVec2>),
    /// Closed curves whose inside, by the even-odd rule, is an area.
    Rings(Vec<Vec<DVec2>>),
    /// A dot.
    Dot(DVec2),
    /// A line from the first point to the second, with a head.
    Arrow([DVec2; 2]),
    /// Text whose middle is at a point.
    Label {
        /// The point.
        at: DVec2,
        /// Offset of the text's middle from there, in pixels to the right and down; it moves elsewhere where it would
        /// cover another text.
        by: DVec2,
        /// The text.
        text: Value,
    },
    /// A pixel, that is a unit square.
    Cell {
        /// Column and row, or the corner with the smallest coordinates.
        at: [i32; 2],
        /// Colour in sRGB; without one, a light colour of the look.
        color: Option<[u8; 3]>,
        /// Text in the middle; may be empty.
        text: Value,
    },
}

/// A shape with its look.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Its shape and place.
    pub shape: MarkShape,
    /// Its part in the picture.
    pub look: Look,
}

/// Marks in a part of the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Corners of the part that is shown: smallest and largest coordinates.
    pub extent: [DVec2; 2],
    /// True if y grows downwards, as rows of pixels do.
    pub down: bool,
    /// Columns and rows of a grid of unit cells from the origin.
    pub grid: Option<[u32; 2]>,
    /// Map from the points of the input, for faces their x and y, to their places in the picture; `None` if it shows
    /// them in another way, or not at all.
    pub picture_from_input: Option<DAffine2>,
    /// Marks from the lowest to the uppermost.
    pub marks: Vec<Mark>,
}

impl Picture {
    /// Creates an empty picture with y upwards.
    pub(crate) fn new(extent: [DVec2; 2]) -> Self {
        let picture_from_input = Some(DAffine2::IDENTITY);
        Self { extent, down: false, grid: None, picture_from_input, marks: Vec::new() }
    }

    /// Creates an empty picture around points, with a margin in parts of its size; around the unit square where no
    /// point is finite.
    pub(crate) fn around(points: impl IntoIterator<Item = DVec2>, margin: f64) -> Self {
        let around = Rect::around(points);
        let [min, max] = around.map_or([DVec2::ZERO, DVec2::ONE], |r| [r.min(), r.max()]);
        let size = (max - min).max_element();
        let more = DVec2::splat(if size > 0.0 { size * margin } else { 1.0 });
        Self::new([min - more, max + more])
    }

    /// Creates a picture of pixels, with their grid and rows downwards.
    pub(crate) fn pixels(columns: u32, rows: u32) -> Self {
        let size = DVec2::new(columns.into(), rows.into());
        let extent = [DVec2::splat(-0.2), size + 0.2];
        Self { down: true, grid: Some([columns, rows]), ..Self::new(extent) }
    }

    /// Adds a mark on top.
    pub(crate) fn add(&mut self, shape: MarkShape, look: Look) {
        self.marks.push(Mark { shape, look });
    }

    /// Adds points joined by lines.
    pub(crate) fn chain(&mut self, points: impl Into<Vec<DVec2>>, look: Look) {
        self.add(MarkShape::Chain(points.into()), look);
    }

    /// Adds a closed curve.
    pub(crate) fn ring(&mut self, points: impl Into<Vec<DVec2>>, look: Look) {
        self.add(MarkShape::Rings(vec![points.into()]), look);
    }

    /// Adds closed curves that bound one area.
    pub(crate) fn rings(&mut self, rings: &[Vec<DVec2>], look: Look) {
        self.add(MarkShape::Rings(rings.to_vec()), look);
    }

    /// Adds a rectangle as a closed chain, whose inside stays free.
    pub(crate) fn frame(&mut self, window: &Rect, look: Look) {
        let mut corners = corners(window).to_vec();
        corners.push(window.min());
        self.chain(corners, look);
    }

    /// Adds a dot.
    pub(crate) fn dot(&mut self, at: DVec2, look: Look) {
        self.add(MarkShape::Dot(at), look);
    }

    /// Adds a line with a head at its end.
    pub(crate) fn arrow(&mut self, from: DVec2, to: DVec2, look: Look) {
        self.add(MarkShape::Arrow([from, to]), look);
    }

    /// Adds a text whose middle is moved from a point by pixels to the right and down.
    pub(crate) fn label(&mut self, at: DVec2, by: (f64, f64), text: impl Into<Value>) {
        self.add(MarkShape::Label { at, by: by.into(), text: text.into() }, Look::Window);
    }

    /// Adds a dot with a name above it.
    pub(crate) fn named(&mut self, at: DVec2, name: impl Into<Value>, look: Look) {
        self.dot(at, look);
        self.label(at, (0.0, -10.0), name);
    }

    /// Adds a pixel in the light colour of a look.
    pub(crate) fn cell(&mut self, at: [i32; 2], text: impl Into<Value>, look: Look) {
        self.add(MarkShape::Cell { at, color: None, text: text.into() }, look);
    }

    /// Adds a pixel in a colour.
    pub(crate) fn colored(&mut self, at: [i32; 2], color: [u8; 3], text: impl Into<Value>) {
        self.add(MarkShape::Cell { at, color: Some(color), text: text.into() }, Look::Pale);
    }
}

/// Returns the corners of a rectangle, counter-clockwise with y upwards.
pub(super) fn corners(window: &Rect) -> [DVec2; 4] {
    let (a, b) = (window.min(), window.max());
    [a, DVec2::new(b.x, a.y), b, DVec2::new(a.x, b.y)]
}
