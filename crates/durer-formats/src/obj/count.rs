//! The amount of data in an OBJ file, counted before anything is allocated for it.

use crate::budget::MODEL;
use crate::{Error, Limits, Place, Result};

/// Numbers of statements and of the elements they create.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub positions: usize,
    pub tex_coords: usize,
    pub normals: usize,
    pub triangles: usize,
    pub lines: usize,
    pub points: usize,
    /// True if there is a smoothing group: a statement that only switches smoothing off names none.
    pub smoothing: bool,
}

/// Counts statements by the first letters of each line. Lines joined by a backslash are seen as
/// separate lines, so that these are capacities, and upper bounds for vertices.
pub(super) fn count(text: &[u8]) -> Counts {
    let mut counts = Counts::default();
    for line in text.split(|b| matches!(b, b'\n' | b'\r')) {
        let line = line.trim_ascii_start();
        let blank = |i: usize| line.get(i).is_none_or(|b| b.is_ascii_whitespace() || *b == b'\\');
        match (line.first(), line.get(1)) {
            (Some(b'v'), Some(b't')) if blank(2) => counts.tex_coords += 1,
            (Some(b'v'), Some(b'n')) if blank(2) => counts.normals += 1,
            (Some(b'v'), _) if blank(1) => counts.positions += 1,
            (Some(b'f'), _) if blank(1) => counts.triangles += words(line).saturating_sub(3),
            (Some(b'l'), _) if blank(1) => counts.lines += words(line).saturating_sub(2),
            (Some(b'p'), _) if blank(1) => counts.points += words(line).saturating_sub(1),
            (Some(b's'), _) if blank(1) => counts.smoothing |= !is_off(line.get(1..)),
            _ => {}
        }
    }
    counts
}

/// Returns whether the operand of `s` means that faces are flat.
pub(super) fn is_off(operand: Option<&[u8]>) -> bool {
    let operand = operand.unwrap_or_default().trim_ascii();
    operand.is_empty() || operand == b"0" || operand.eq_ignore_ascii_case(b"off")
}

fn words(line: &[u8]) -> usize {
    let mut inside = false;
    let mut words = 0;
    for byte in line {
        let blank = byte.is_ascii_whitespace();
        words += usize::from(!blank && !inside);
        inside = !blank;
    }
    words
}

impl Counts {
    /// Returns triangles, lines and points together.
    fn primitives(&self) -> u64 {
        self.triangles as u64 + self.lines as u64 + self.points as u64
    }

    /// Checks the counts against the limits.
    ///
    /// # Errors
    /// More primitives than allowed, or more vertices than 32 bits can number.
    pub fn check(&self, limits: &Limits) -> Result<()> {
        let vertices = self.positions.max(self.tex_coords).max(self.normals) as u64;
        for (what, value, limit) in [
            ("number of triangles, lines and points", self.primitives(), limits.primitives),
            ("number of vertices", vertices, u64::from(u32::MAX) - 1),
        ] {
            if value > limit {
                return Err(Error::Limit { place: Place::Whole, what, value, limit });
            }
        }
        Ok(limits.work.keep(MODEL, self.bytes())?)
    }

    /// Returns an estimate of the bytes for the numbers and the meshes made from them.
    fn bytes(&self) -> u64 {
        let numbers = 3 * (self.positions + self.normals) + 2 * self.tex_coords;
        let corners = 3 * self.triangles + 2 * self.lines + self.points;
        16 * numbers as u64 + 16 * corners as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_are_counted() {
        let text =
            b"v 0 0 0\r\n v 1 1 1\rvt 0 0\nvn 0 0 1\nf 1 1 1 1 1\nl 1 2 1\np 1 2\nvp 1\n# v 1\nv";
        let expected = Counts {
            positions: 3,
            tex_coords: 1,
            normals: 1,
            triangles: 3,
            lines: 2,
            points: 2,
            smoothing: false,
        };
        assert_eq!(count(text), expected);
        assert!(!count(b"s off\ns 0\ns\nsmooth 1").smoothing && count(b"s off\n s\t3").smoothing);
    }
}
