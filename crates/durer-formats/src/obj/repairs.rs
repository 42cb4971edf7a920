//! Faults of an OBJ file that cost only the element that contains them.

use crate::text::Tally;
use crate::{Error, Model, Place, Result};

/// Things that were left out or repaired.
#[derive(Debug, Default)]
pub(super) struct Repairs {
    pub unknown: Tally,
    pub unknown_word: String,
    pub short_faces: Tally,
    pub non_finite: Tally,
    pub sloppy: Tally,
    pub unnamed_parts: Tally,
    pub byte_colors: bool,
    /// Corners with references to texture coordinates or normals in a file without any.
    pub no_attributes: Tally,
    /// Vertices with no color, or no finite one, where others have one.
    pub no_color: Tally,
    /// Faces, lines and points that were left out for a corner, and the fault of the first.
    pub bad_corners: Tally,
    pub bad_corner: String,
    /// Vertices, texture coordinates and normals with invalid numbers, and the fault of the first.
    pub bad_numbers: Tally,
    pub bad_number: String,
}

impl Repairs {
    /// Adds one warning for each kind of repair.
    pub fn tell(&self, model: &mut Model) {
        let word = &self.unknown_word;
        let (corner, number) = (&self.bad_corner, &self.bad_number);
        for (tally, message) in [
            (
                &self.unknown,
                format!("statements are not known and were skipped, the first: `{word}`"),
            ),
            (
                &self.bad_corners,
                format!(
                    "faces, lines or points have a wrong corner and were left out, the first: {corner}"
                ),
            ),
            (
                &self.bad_numbers,
                format!(
                    "vertices, texture coordinates or normals are not readable, the first: {number}"
                ),
            ),
            (&self.short_faces, "elements have too few corners and were left out".to_owned()),
            (&self.non_finite, "vertices have a coordinate that is NaN or infinite".to_owned()),
            (&self.sloppy, "numbers have something behind them, which was ignored".to_owned()),
            (
                &self.no_attributes,
                "corners name texture coordinates or normals, of which the file has none"
                    .to_owned(),
            ),
            (
                &self.no_color,
                "vertices have no color where others have one; they are white".to_owned(),
            ),
            (&self.unnamed_parts, "further groups were joined to the last: too many".to_owned()),
        ] {
            if tally.count > 0 {
                model.warn(tally.first.clone(), format!("{} {message}", tally.count));
            }
        }
        if self.byte_colors {
            model.warn(Place::Whole, "vertex colors go up to 255 instead of 1; they were scaled");
        }
    }
}

/// Counts an error that only one element suffers from.
pub(super) fn note(tally: &mut Tally, first: &mut String, error: Error) -> Result<()> {
    let Error::Decode { place, message } = error else { return Err(error) };
    if tally.count == 0 {
        *first = message;
    }
    tally.add(|| place);
    Ok(())
}
