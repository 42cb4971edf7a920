//! Rectangles of samples, into which subdivision divides the screen.

/// Relation of a triangle to a window of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WindowRelation {
    /// It covers no sample.
    Outside,
    /// It is within the window.
    Inside,
    /// It may cover some samples.
    Crossing,
    /// It covers all samples.
    Surrounding,
}

/// A rectangle of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SampleRect {
    /// First column.
    pub x0: i32,
    /// First row.
    pub y0: i32,
    /// After the last column.
    pub x1: i32,
    /// After the last row.
    pub y1: i32,
}

impl SampleRect {
    /// Returns whether it contains no sample.
    pub(crate) fn is_empty(&self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }

    /// Returns the common part.
    pub(crate) fn and(&self, o: &Self) -> Self {
        Self {
            x0: self.x0.max(o.x0),
            y0: self.y0.max(o.y0),
            x1: self.x1.min(o.x1),
            y1: self.y1.min(o.y1),
        }
    }

    /// Returns whether it is within another window.
    pub(crate) fn within(&self, o: &Self) -> bool {
        self.x0 >= o.x0 && self.y0 >= o.y0 && self.x1 <= o.x1 && self.y1 <= o.y1
    }

    /// Returns the samples in its corners.
    pub(crate) fn corners(&self) -> [[i32; 2]; 4] {
        let (x, y) = (self.x1 - 1, self.y1 - 1);
        [[self.x0, self.y0], [x, self.y0], [self.x0, y], [x, y]]
    }
}
