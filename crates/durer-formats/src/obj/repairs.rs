//! Faults of an OBJ file that cost only the element that contains them.

use crate::text::Tally;
use crate::wording::agreeing;
use crate::{Error, Model, Place, Result};

/// Things that were left out or repaired.
#[derive(Debug, Default)]
pub(super) struct Repairs {
    pub unknown: Tally,
    pub unknown_word: String,
    pub free_form: Tally,
    pub short_faces: Tally,
    pub non_finite: Tally,
    pub sloppy: Tally,
    pub commas: Tally,
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
    pub fn warn(&self, model: &mut Model) {
        let quoted = format!("`{}`", self.unknown_word);
        let (corner, number) = (&self.bad_corner, &self.bad_number);
        for (tally, words, first) in [
            (
                &self.unknown,
                "{statement is not known and was|statements are not known and were} skipped",
                quoted,
            ),
            (
                &self.bad_corners,
                "{face, line or point has a wrong corner and was|faces, lines or points have a wrong corner and were} left out",
                corner.clone(),
            ),
            (
                &self.bad_numbers,
                "{vertex, texture coordinate or normal is|vertices, texture coordinates or normals are} not readable",
                number.clone(),
            ),
        ] {
            if tally.count > 0 {
                let first = if tally.count == 1 { first } else { format!("the first: {first}") };
                let message = format!("{}: {first}", agreeing(tally.count, words));
                model.warn(tally.first.clone(), message);
            }
        }
        for (tally, words) in [
            (
                &self.free_form,
                "{statement of a free-form curve or surface is|statements of free-form curves and surfaces are} not read",
            ),
            (
                &self.short_faces,
                "{element has too few corners and was|elements have too few corners and were} left out",
            ),
            (&self.non_finite, "{vertex has|vertices have} a coordinate that is NaN or infinite"),
            (
                &self.sloppy,
                "{number has something behind it|numbers have something behind them}, which was ignored",
            ),
            (&self.commas, crate::text::COMMAS),
            (
                &self.no_attributes,
                "{corner names|corners name} texture coordinates or normals, of which the file has none",
            ),
            (
                &self.no_color,
                "{vertex has no color where others have one; it is|vertices have no color where others have one; they are} white",
            ),
            (&self.unnamed_parts, "further {group was|groups were} joined to the last: too many"),
        ] {
            model.warn_of(tally, words);
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
