//! The scissor test: only pixels of a rectangle are drawn (OpenGL 4.6, 17.3.2).

/// A rectangle of pixels; x1 and y1 are exclusive, so x0 = x1 holds no pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Scissor {
    /// First column.
    pub x0: u32,
    /// First row.
    pub y0: u32,
    /// One more than the last column.
    pub x1: u32,
    /// One more than the last row.
    pub y1: u32,
}

impl Scissor {
    /// Returns whether the pixel is inside.
    #[inline(always)]
    pub fn contains(&self, x: u32, y: u32) -> bool {
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }

    /// Returns the pixels that are in both.
    pub(crate) fn intersection(&self, other: &Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_column_and_row_are_exclusive() {
        let a = Scissor { x0: 2, y0: 3, x1: 5, y1: 4 };
        let b = Scissor { x0: 4, y0: 0, x1: 9, y1: 9 };
        for (x, y) in (0..10).flat_map(|y| (0..10).map(move |x| (x, y))) {
            assert_eq!(a.contains(x, y), (2..5).contains(&x) && y == 3);
            assert_eq!(a.intersection(&b).contains(x, y), a.contains(x, y) && b.contains(x, y));
        }
    }
}
