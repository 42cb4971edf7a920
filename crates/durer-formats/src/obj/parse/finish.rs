//! The conversion of the statements after all are read.

use super::super::corners::NONE;
use super::{Parsed, Parser};
use crate::text::Tally;
use crate::{Error, Result};

impl Parser<'_> {
    pub(super) fn finish(mut self) -> Result<Parsed> {
        if self.out.positions.is_empty() {
            return Err(Error::whole(
                "holds no vertex; an OBJ file has lines like `v 0 0 0` and `f 1 2 3`",
            ));
        }
        self.check_something_left()?;
        if self.out.positions.len() < self.counts.positions
            || self.out.tex_coords.len() < self.counts.tex_coords
            || self.out.normals.len() < self.counts.normals
        {
            self.check_joined()?;
        }
        if !self.out.colors.is_empty() && self.brightest > 1.0 {
            self.out.repairs.byte_colors = self.brightest > 2.0;
            let scale = if self.brightest > 2.0 { 1.0 / 255.0 } else { 1.0 };
            self.out.colors.iter_mut().for_each(|c| *c *= scale);
        }
        self.out.repairs.sloppy = self.cursor.sloppy;
        self.out.repairs.commas = self.cursor.commas;
        Ok(self.out)
    }

    /// Checks that something is left to show.
    ///
    /// # Errors
    /// The first fault, if nothing can be shown because of it.
    fn check_something_left(&self) -> Result<()> {
        let (out, repairs) = (&self.out, &self.out.repairs);
        let no_element =
            out.triangles.indices.is_empty() && out.lines.is_empty() && out.points.is_empty();
        let error = |tally: &Tally, message: &String| {
            Err(Error::Decode { place: tally.first.clone(), message: message.clone() })
        };
        if no_element && repairs.bad_corners.count > 0 {
            return error(&repairs.bad_corners, &repairs.bad_corner);
        }
        if repairs.bad_numbers.count > 0 && !self.has_place(no_element) {
            return error(&repairs.bad_numbers, &repairs.bad_number);
        }
        Ok(())
    }

    /// Returns whether any triangle, line or point has all its coordinates; for a cloud of points, any vertex.
    fn has_place(&self, cloud: bool) -> bool {
        let out = &self.out;
        let finite = |&i: &u32| out.positions.get(i as usize).is_some_and(|p| p.is_finite());
        let keys = &out.triangles.keys;
        let corner = |i: &u32| match keys.get(*i as usize) {
            Some(key) => finite(&key.position),
            None => finite(i),
        };
        (cloud && out.positions.iter().any(|p| p.is_finite()))
            || out.triangles.indices.as_chunks::<3>().0.iter().any(|t| t.iter().all(corner))
            || out.lines.as_chunks::<2>().0.iter().any(|line| line.iter().all(finite))
            || out.points.iter().any(finite)
    }

    /// Checks files in which lines that look like vertices continued others: there are fewer items than counted, so an
    /// index may be out of range.
    fn check_joined(&self) -> Result<()> {
        let out = &self.out;
        let positions = out.lines.iter().chain(&out.points).copied();
        let largest = if out.triangles.keyed() {
            let keys = || out.triangles.keys.iter();
            [
                positions.chain(keys().map(|k| k.position)).max(),
                keys().map(|k| k.tex_coord).filter(|&t| t != NONE).max(),
                keys().map(|k| k.normal).filter(|&n| n < self.counts.normals as u32).max(),
            ]
        } else {
            [positions.chain(out.triangles.indices.iter().copied()).max(), None, None]
        };
        let counts = [out.positions.len(), out.tex_coords.len(), out.normals.len()];
        for (largest, count) in largest.into_iter().zip(counts) {
            if let Some(index) = largest.filter(|&i| i as usize >= count) {
                return Err(Error::whole(format!(
                    "an element refers to entry {} of {count}: a line ending in a backslash \
                     swallowed the one that would define it",
                    u64::from(index) + 1
                )));
            }
        }
        Ok(())
    }
}
