//! Sizes of which one side may be open and follows from the shape of the contents.

use crate::values::Size;
use durer::math::DVec2;

/// Part of a pixel that lengths in other units may exceed whole pixels by, as they are rounded.
const ROUNDING: f64 = 0.01;

/// A size of which one side may be open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sides {
    /// Columns.
    pub width: Option<u32>,
    /// Rows of pixels.
    pub height: Option<u32>,
}

/// Parses `WxH`, `Wx` or `xH`; a single number makes a square.
pub fn sides(text: &str) -> Result<Sides, String> {
    let wrong = || {
        "a size is WIDTHxHEIGHT in whole pixels from 1, e.g. 1920x1080; one side may be left out, \
         e.g. 1920x or x1080"
            .to_owned()
    };
    let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    let side = |side: &str| match side.trim() {
        "" => Ok(None),
        digits => digits.parse().ok().filter(|n| *n > 0).map(Some).ok_or_else(wrong),
    };
    let sides = Sides { width: side(width)?, height: side(height)? };
    if sides.width.or(sides.height).is_some() { Ok(sides) } else { Err(wrong()) }
}

impl Sides {
    /// Returns whether a side is open.
    pub fn is_open(self) -> bool {
        self.width.is_none() || self.height.is_none()
    }

    /// Returns both sides, an open one so that the picture has the shape of `natural`.
    pub fn of_shape(self, natural: DVec2) -> Size {
        let (width, height) = match (self.width, self.height) {
            (Some(width), Some(height)) => (width, height),
            (Some(width), None) => (width, whole(f64::from(width) * (natural.y / natural.x))),
            (None, Some(height)) => (whole(f64::from(height) * (natural.x / natural.y)), height),
            (None, None) => {
                let sides = (natural - ROUNDING).ceil();
                (whole(sides.x), whole(sides.y))
            }
        };
        Size { width, height }
    }
}

/// Returns the nearest number of pixels.
fn whole(side: f64) -> u32 {
    side.round().clamp(1.0, f64::from(u32::MAX)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_may_be_open() {
        let both = |w, h| Ok(Sides { width: w, height: h });
        assert_eq!(sides("800x600"), both(Some(800), Some(600)));
        assert_eq!(sides("800x"), both(Some(800), None));
        assert_eq!(sides("x600"), both(None, Some(600)));
        assert_eq!(sides("64"), both(Some(64), Some(64)));
        for wrong in ["", "x", "0x", "x-1", "1.5x", "axb", "1x2x3", "4294967296x1"] {
            assert!(sides(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn an_open_side_follows_the_shape() {
        let size = |text: &str| sides(text).unwrap().of_shape(DVec2::new(3.0, 2.0));
        let is = |width, height| Size { width, height };
        assert_eq!(size("640x"), is(640, 427));
        assert_eq!(size("x480"), is(720, 480));
        assert_eq!(size("10x10"), is(10, 10));
        // 200 pixels are 52.917 millimetres, rounded.
        let open = Sides { width: None, height: None };
        assert_eq!(open.of_shape(DVec2::new(52.917 / 25.4 * 96.0, 7.1)), is(200, 8));
        let flat = sides("640x").unwrap().of_shape(DVec2::new(1e9, 1.0));
        assert_eq!(flat, is(640, 1));
    }
}
