//! The look of annotations (ISO 128, ISO 129-1, ISO 3098), and numbers as texts.

use crate::math::DVec2;

/// Lengths in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Style {
    /// Height of capitals.
    pub text: f64,
    /// Length of an arrow.
    pub arrow: f64,
    /// sRGB with straight alpha.
    pub color: [u8; 4],
}

/// Width of thin lines.
pub(super) const THIN: f64 = 0.25;
/// Gap between the measured part and its extension line, and between a line and the text over it.
pub(super) const GAP: f64 = 1.0;
/// Length of extension lines beyond the dimension line.
pub(super) const OVER: f64 = 2.0;
/// Length of centre lines beyond their feature.
pub(super) const BEYOND: f64 = 2.5;
/// Long dash, gap, dot, gap (ISO 128, line 04.1), for thin lines; the dot is made by the pen's round ends.
pub(super) const CENTER: [f64; 4] = [6.0, 1.0, 0.05, 1.0];
/// Space around text within which no line is drawn.
pub(super) const HALO: f64 = 0.5;
/// Distance from a view to its first dimension line, and from one to the next.
pub(super) const FIRST: f64 = 9.0;
pub(super) const STEP: f64 = 8.0;

/// Sheets with shorter sides have smaller letters: below A4.
const SMALL: f64 = 290.0;

impl Style {
    /// Creates the style for a sheet of the given size.
    pub fn of_sheet(size: DVec2, color: [u8; 4]) -> Self {
        let text = if size.max_element() < SMALL { 2.5 } else { 3.5 };
        Self { text, arrow: text * 6.0 / 7.0, color }
    }
}

/// Returns a length in units of the model, to a hundredth of a millimetre where a unit is this many
/// millimetres; no trailing zeros.
pub(super) fn length(value: f64, unit: f64) -> String {
    let digits = (2.0 + libm::log10(unit.max(1.0)).ceil()).clamp(2.0, 8.0) as usize;
    short(value, digits)
}

/// Returns an angle in radians as degrees, to a tenth.
pub(super) fn angle(value: f64) -> String {
    format!("{}°", short(value.to_degrees(), 1))
}

fn short(value: f64, digits: usize) -> String {
    // Rounded twice, so that noise in the seventh digit does not decide.
    let text = format!("{:.digits$}", value + value.abs() * 1e-7);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::{angle, length};

    #[test]
    fn lengths_are_as_precise_as_their_unit() {
        assert_eq!(length(40.0, 1.0), "40");
        assert_eq!(length(7.999_999_96, 1.0), "8");
        assert_eq!(length(0.125, 1.0), "0.13");
        assert_eq!(length(0.012_345_6, 1000.0), "0.01235");
        assert_eq!(length(1.0625, 25.4), "1.0625");
        assert_eq!(angle(std::f64::consts::FRAC_PI_8), "22.5°");
    }
}
