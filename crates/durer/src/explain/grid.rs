//! Inputs laid on a grid of pixels, and what is seen there.

use super::picture::{Look, Picture};
use super::table::Table;
use super::words::{Value, Word};
use crate::math::{DAffine2, DVec2, IVec2, Rect};

/// The largest coordinate that is taken as it is: more pixels across cannot be distinguished in a picture.
const LARGEST: f64 = 40.0;

/// Pixels that the longer side of a larger input is scaled to.
const SCALED: f64 = 24.0;

/// Head of a column without one.
pub(super) const NO_HEAD: Word = Word::new("", "");

/// A grid of pixels with y upwards, and the way from an input's coordinates to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Raster {
    /// Pixels across.
    pub columns: u32,
    /// Pixels up.
    pub rows: u32,
    origin: DVec2,
    scale: f64,
}

impl Raster {
    /// Creates a grid for points: with their own coordinates, or scaled where those are negative or too large.
    pub fn around(points: impl IntoIterator<Item = DVec2>) -> Self {
        let around = Rect::around(points);
        let [low, high] = around.map_or([DVec2::ZERO, DVec2::ONE], |r| [r.min(), r.max()]);
        let plain = low.min_element() >= 0.0 && high.max_element() <= LARGEST;
        let longest = (high - low).max_element();
        let fits = longest > 0.0 && longest.is_finite();
        let scale = if plain || !fits { 1.0 } else { SCALED / longest };
        let origin = if plain { DVec2::ZERO } else { low };
        let size = ((high - origin) * scale).floor() + 1.0;
        let [columns, rows] = size.to_array().map(|side| side.clamp(1.0, LARGEST + 1.0) as u32);
        Self { columns, rows, origin, scale }
    }

    /// Returns a point's place in pixels.
    pub fn at(&self, p: DVec2) -> DVec2 {
        (p - self.origin) * self.scale
    }

    /// Returns the pixel nearest to a point whose coordinates are those of pixels.
    pub fn pixel(&self, p: DVec2) -> IVec2 {
        let p = (self.at(p) + 0.5).floor().clamp(DVec2::ZERO, DVec2::splat(LARGEST));
        p.as_ivec2().min(IVec2::new(self.columns as i32 - 1, self.rows as i32 - 1))
    }

    /// Returns an empty picture of the grid.
    pub fn picture(&self) -> Picture {
        let shift = DAffine2::from_translation(-self.origin);
        let picture_from_input = Some(DAffine2::from_scale(DVec2::splat(self.scale)) * shift);
        Picture { picture_from_input, ..upright(self.columns, self.rows) }
    }

    /// Returns an empty picture of the grid for inputs whose coordinates are those of pixels: a point is in the middle
    /// of one.
    pub fn picture_of_pixels(&self) -> Picture {
        let mut picture = self.picture();
        let shift = DAffine2::from_translation(DVec2::splat(0.5));
        picture.picture_from_input = picture.picture_from_input.map(|map| shift * map);
        picture
    }
}

/// Returns an empty picture of a grid with rows upwards.
pub(super) fn upright(columns: u32, rows: u32) -> Picture {
    Picture { down: false, ..Picture::pixels(columns, rows) }
}

/// Returns the middle of a pixel.
pub(super) fn center(pixel: IVec2) -> DVec2 {
    pixel.as_dvec2() + 0.5
}

/// Returns a pixel as a value.
pub(super) fn shown(pixel: IVec2) -> Value {
    pixel.as_dvec2().into()
}

/// Adds pixels to a picture: those of the steps before, and the one that the step is about.
pub(super) fn add_pixels(picture: &mut Picture, pixels: &[IVec2]) {
    for (i, pixel) in pixels.iter().enumerate() {
        let look = if i + 1 == pixels.len() { Look::Now } else { Look::First };
        picture.cell(pixel.to_array(), "", look);
    }
}

/// Returns the letter of a numbered thing: A to Z, then A1 and so on.
pub(super) fn letter(number: usize) -> String {
    let letter = char::from(b'A' + (number % 26) as u8);
    if number < 26 { letter.to_string() } else { format!("{letter}{}", number / 26) }
}

/// Colours of numbered things, light ones of Okabe and Ito's, so that letters on them can be read.
const COLORS: [[u8; 3]; 6] = [
    [0x9c, 0xcb, 0xe8],
    [0xf4, 0xb7, 0x8a],
    [0x8f, 0xd9, 0xc0],
    [0xf4, 0xec, 0x9a],
    [0xe3, 0xb8, 0xd0],
    [0xc8, 0xc8, 0xc8],
];

/// Returns the colour of a numbered thing.
pub(super) fn color(number: usize) -> [u8; 3] {
    COLORS[number % COLORS.len()]
}

/// Returns a grey between white (0) and black (1).
pub(super) fn grey(ink: f64) -> [u8; 3] {
    [(255.0 - ink.clamp(0.0, 1.0) * 225.0) as u8; 3]
}

/// The last rows that a table of all steps shows: more would not be read.
const SHOWN: usize = 14;

/// Creates a table with a row per step so far, of which the last ones are shown.
pub(super) fn log<const N: usize, const M: usize>(heads: [Word; N], rows: &[[Value; M]]) -> Table {
    let mut table = Table::new(heads);
    let first = rows.len().saturating_sub(SHOWN);
    for (number, cells) in rows.iter().enumerate().skip(first) {
        table.row(number, cells.clone());
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_inputs_keep_their_coordinates() {
        let plain = Raster::around([DVec2::new(1.0, 2.5), DVec2::new(9.0, 4.0)]);
        assert_eq!((plain.columns, plain.rows), (10, 5));
        assert_eq!(plain.pixel(DVec2::new(1.0, 2.5)), IVec2::new(1, 3));
        let scaled = Raster::around([DVec2::new(-1e6, 0.0), DVec2::new(1e6, 5e5)]);
        assert_eq!((scaled.columns, scaled.rows), (25, 7));
        assert_eq!(scaled.at(DVec2::new(1e6, 5e5)), DVec2::new(24.0, 6.0));
        let point = Raster::around([DVec2::splat(1e90)]);
        assert_eq!((point.columns, point.pixel(DVec2::splat(1e90))), (1, IVec2::ZERO));
        assert_eq!([letter(0), letter(27)], ["A", "B1"]);
    }
}
