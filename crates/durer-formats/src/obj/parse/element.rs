//! Faces, lines and points, and the runs of them that share a material and a name.

use super::super::corners::Corner;
use super::super::repairs::note;
use super::{Parser, Run};
use crate::{Error, Place, Result, text};
use durer::scene::Topology;

/// Number of parts above which a change of name alone does not start a new one: a name per face would take more memory
/// than the file.
const MAX_NAMED_PARTS: usize = 1 << 16;

impl Parser<'_> {
    pub(super) fn face(&mut self) -> Result<()> {
        let line = self.cursor.line();
        let start = self.out.triangles.indices.len();
        match self.fan(start) {
            Ok(true) => self.note_face(start / 3),
            Ok(false) => self.short_face(line),
            Err(error) => {
                self.out.triangles.indices.truncate(start);
                self.leave_out(error)?;
            }
        }
        self.check_limit()
    }

    /// Adds a face's corners as triangles from the first; false if there are fewer than three.
    fn fan(&mut self, start: usize) -> Result<bool> {
        let (Some(first), Some(second)) = (self.corner()?, self.corner()?) else {
            return Ok(false);
        };
        let Some(third) = self.corner()? else { return Ok(false) };
        self.begin(start / 3, Topology::Triangles);
        for corner in [first, second, third] {
            self.out.triangles.push(corner);
        }
        while let Some(next) = self.corner()? {
            let last = self.out.triangles.indices.len() - 1;
            self.out.triangles.repeat(start);
            self.out.triangles.repeat(last);
            self.out.triangles.push(next);
        }
        Ok(true)
    }

    fn short_face(&mut self, line: u64) {
        self.out.repairs.short_faces.add(|| Place::Line(line, 0));
    }

    /// Counts an element that is left out for one of its corners.
    fn leave_out(&mut self, error: Error) -> Result<()> {
        let repairs = &mut self.out.repairs;
        note(&mut repairs.bad_corners, &mut repairs.bad_corner, error)
    }

    /// Keeps the first triangle of each face once a face has several.
    fn note_face(&mut self, first: usize) {
        let several = self.out.triangles.indices.len() / 3 > first + 1;
        let faces = &mut self.out.faces;
        if several && faces.is_empty() {
            faces.extend(0..self.faces as u32);
        }
        if several || !faces.is_empty() {
            faces.push(first as u32);
        }
        self.faces += 1;
    }

    pub(super) fn line(&mut self) -> Result<()> {
        let start = self.out.lines.len();
        if let Err(error) = self.polyline(start / 2) {
            self.out.lines.truncate(start);
            self.leave_out(error)?;
        } else if start == self.out.lines.len() {
            self.short_face(self.cursor.line());
        }
        self.check_limit()
    }

    fn polyline(&mut self, start: usize) -> Result<()> {
        let mut last = None;
        while let Some(Corner { position, .. }) = self.corner()? {
            if let Some(from) = last.replace(position) {
                self.begin(start, Topology::Lines);
                self.out.lines.extend([from, position]);
            }
        }
        Ok(())
    }

    pub(super) fn points(&mut self) -> Result<()> {
        let start = self.out.points.len();
        if let Err(error) = self.some_points() {
            self.out.points.truncate(start);
            self.leave_out(error)?;
        }
        self.check_limit()
    }

    fn some_points(&mut self) -> Result<()> {
        while let Some(Corner { position, .. }) = self.corner()? {
            self.begin(self.out.points.len(), Topology::Points);
            self.out.points.push(position);
        }
        Ok(())
    }

    /// Starts a run at primitive `start` where material or name change.
    fn begin(&mut self, start: usize, topology: Topology) {
        let part = Part { material: self.material, object: self.object, group: self.group };
        let (slot, runs) = match topology {
            Topology::Triangles => (&mut self.open[0], &mut self.out.triangle_runs),
            Topology::Lines => (&mut self.open[1], &mut self.out.line_runs),
            Topology::Points => (&mut self.open[2], &mut self.out.point_runs),
        };
        if slot.is_some_and(|open| open.is(&part)) {
            return;
        }
        let same_material = slot.replace(part).is_some_and(|open| open.material == part.material);
        if same_material && runs.len() >= MAX_NAMED_PARTS {
            self.out.repairs.unnamed_parts.add(|| Place::Line(self.cursor.line(), 0));
        } else {
            let [object, group] = [part.object, part.group].map(|n| text::name(n).into_owned());
            runs.push(Run { start, material: part.material, object, group });
        }
    }

    /// Checks the number of primitives against the limit.
    ///
    /// # Errors
    /// More primitives than allowed; only joined lines can exceed the number counted before.
    fn check_limit(&self) -> Result<()> {
        let out = &self.out;
        let value = out.triangles.indices.len() / 3 + out.lines.len() / 2 + out.points.len();
        let limit = self.limit.min(u64::from(u32::MAX));
        if value as u64 <= limit {
            return Ok(());
        }
        let place = Place::Line(self.cursor.line(), 0);
        let what = "number of triangles, lines and points";
        Err(Error::Limit { place, what, value: value as u64, limit })
    }
}

/// Part that names the primitives after it.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    material: Option<usize>,
    object: &'a [u8],
    group: &'a [u8],
}

impl Part<'_> {
    /// Returns whether material and names are equal. Called for every face. Equal names mostly have the same address in
    /// the text. Most files have no names, and `memcmp` of an empty slice at a dangling pointer takes hundreds of
    /// cycles on some machines.
    fn is(&self, other: &Self) -> bool {
        let same = |a: &[u8], b: &[u8]| {
            a.len() == b.len() && (a.is_empty() || a.as_ptr() == b.as_ptr() || a == b)
        };
        self.material == other.material
            && same(self.object, other.object)
            && same(self.group, other.group)
    }
}
