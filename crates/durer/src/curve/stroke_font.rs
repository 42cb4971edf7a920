//! A small font of strokes for labels: no file, no licence, the same everywhere.
//!
//! Glyphs are polylines on a grid of 4 × 8 units, to be stroked with round caps and joins, as plotters
//! and vector displays drew them. ASCII only; other characters appear as a box. For real text there is
//! [`super::text`].

use super::Path;
use super::text::TextLine;
use crate::math::{DAffine2, DVec2};

/// Grid units from the top of capitals to the lowest descender; the base line is at 6.
const HEIGHT: f64 = 8.0;
const BASE_LINE: f64 = 6.0;
/// Free units between two glyphs.
const GAP: f64 = 2.0;

/// The width of the strokes that looks right, as a part of the size.
pub const STROKE_WIDTH: f64 = 0.09;

/// What a character that is not here looks like.
const MISSING: (char, &str) = ('\u{fffd}', "00 40 46 06 00");

/// Characters with their strokes: points are column and row, `,` begins a new stroke, one point alone
/// is a dot.
const GLYPHS: &[(char, &str)] = &[
    ('!', "00 04,06"),
    ('"', "00 01,20 21"),
    ('#', "10 16,30 36,02 42,04 44"),
    ('%', "06 40,01,45"),
    ('\'', "00 01"),
    ('(', "10 01 05 16"),
    (')', "00 11 15 06"),
    ('*', "21 25,02 44,04 42"),
    ('+', "22 26,04 44"),
    (',', "15 07"),
    ('-', "04 34"),
    ('.', "06"),
    ('/', "06 40"),
    ('0', "10 30 41 45 36 16 05 01 10,14 32"),
    ('1', "01 20 26,06 46"),
    ('2', "01 10 30 41 42 06 46"),
    ('3', "01 10 30 41 42 33 44 45 36 16 05,13 33"),
    ('4', "36 30 04 44"),
    ('5', "40 00 03 33 44 45 36 16 05"),
    ('6', "41 30 10 01 05 16 36 45 44 33 13 04"),
    ('7', "00 40 41 16"),
    ('8', "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33"),
    ('9', "05 16 36 45 41 30 10 01 02 13 33 42"),
    (':', "03,06"),
    (';', "13,15 07"),
    ('<', "32 04 36"),
    ('=', "03 43,05 45"),
    ('>', "02 34 06"),
    ('?', "01 10 30 41 42 23 24,26"),
    ('A', "06 02 20 42 46,04 44"),
    ('B', "03 33 42 41 30 00 06 36 45 44 33"),
    ('C', "41 30 10 01 05 16 36 45"),
    ('D', "00 06 26 44 42 20 00"),
    ('E', "40 00 06 46,03 33"),
    ('F', "40 00 06,03 33"),
    ('G', "41 30 10 01 05 16 36 45 43 23"),
    ('H', "00 06,40 46,03 43"),
    ('I', "00 20,10 16,06 26"),
    ('J', "40 45 36 16 05"),
    ('K', "00 06,40 03 46"),
    ('L', "00 06 46"),
    ('M', "06 00 23 40 46"),
    ('N', "06 00 46 40"),
    ('O', "10 30 41 45 36 16 05 01 10"),
    ('P', "06 00 30 41 42 33 03"),
    ('Q', "10 30 41 45 36 16 05 01 10,24 46"),
    ('R', "06 00 30 41 42 33 03,23 46"),
    ('S', "41 30 10 01 02 13 33 44 45 36 16 05"),
    ('T', "00 40,20 26"),
    ('U', "00 05 16 36 45 40"),
    ('V', "00 26 40"),
    ('W', "00 16 23 36 40"),
    ('X', "00 46,40 06"),
    ('Y', "00 23 40,23 26"),
    ('Z', "00 40 06 46"),
    ('[', "10 00 06 16"),
    ('\\', "00 46"),
    (']', "00 10 16 06"),
    ('^', "02 20 42"),
    ('_', "07 47"),
    ('a', "43 32 12 03 05 16 36 45,42 46"),
    ('b', "00 06,03 12 32 43 45 36 16 05"),
    ('c', "43 32 12 03 05 16 36 45"),
    ('d', "40 46,43 32 12 03 05 16 36 45"),
    ('e', "04 44 43 32 12 03 05 16 36 45"),
    ('f', "30 20 11 16,02 22"),
    ('g', "42 47 38 18 07,43 32 12 03 05 16 36 45"),
    ('h', "00 06,03 12 32 43 46"),
    ('i', "02 06,00"),
    ('j', "22 27 18 07,20"),
    ('k', "00 06,32 04 36"),
    ('l', "00 05 16"),
    ('m', "02 06,03 12 23 26,23 32 43 46"),
    ('n', "02 06,03 12 32 43 46"),
    ('o', "12 32 43 45 36 16 05 03 12"),
    ('p', "02 08,03 12 32 43 45 36 16 05"),
    ('q', "42 48,43 32 12 03 05 16 36 45"),
    ('r', "02 06,04 13 22 32"),
    ('s', "43 32 12 03 14 34 45 36 16 05"),
    ('t', "10 15 26 36,02 32"),
    ('u', "02 05 16 36 45,42 46"),
    ('v', "02 26 42"),
    ('w', "02 16 23 36 42"),
    ('x', "02 46,42 06"),
    ('y', "02 26,42 26 17 08"),
    ('z', "02 42 06 46"),
    ('{', "20 11 12 03 14 15 26"),
    ('|', "00 07"),
    ('}', "00 11 12 23 14 15 06"),
    ('~', "04 13 34 43"),
];

/// Lays out one line of text; `size` is the distance from the top of capitals to the lowest descender.
/// Control characters are left out. The path is to be stroked, e.g. [`STROKE_WIDTH`] · `size` wide with
/// round caps and joins.
///
/// ```
/// let line = durer::curve::stroke_font::line("z-buffer: 0", 16.0);
/// assert!(line.advance > 16.0 && !line.path.is_empty());
/// ```
pub fn line(text: &str, size: f64) -> TextLine {
    let size = if size.is_finite() { size.clamp(0.0, 1e6) } else { 0.0 };
    let unit = size / HEIGHT;
    let (ascent, descent) = (BASE_LINE * unit, (HEIGHT - BASE_LINE) * unit);
    let mut line = TextLine { ascent, descent, ..TextLine::default() };
    for character in text.chars().filter(|c| !c.is_control()) {
        let (path, width) = glyph(character);
        let place = DVec2::new(line.advance, -ascent);
        let placed = DAffine2::from_scale_angle_translation(DVec2::splat(unit), 0.0, place);
        line.path.extend(&path.transformed(placed));
        line.advance += (width + GAP) * unit;
    }
    line
}

/// The strokes of a character in grid units, and its width.
fn glyph(character: char) -> (Path, f64) {
    if character == ' ' {
        return (Path::new(), 2.0);
    }
    let found = GLYPHS.binary_search_by_key(&character, |g| g.0).ok();
    let (_, strokes) = found.and_then(|i| GLYPHS.get(i)).unwrap_or(&MISSING);
    let (mut path, mut width) = (Path::new(), 0.0f64);
    for stroke in strokes.split(',') {
        let points = || stroke.split(' ').filter_map(point);
        width = points().map(|p| p.x).fold(width, f64::max);
        let dot = DVec2::new(0.0, 0.01);
        let end = points().next().filter(|_| points().nth(1).is_none()).map(|p| p + dot);
        path.extend(&Path::polyline(points().chain(end)));
    }
    (path, width)
}

/// Column and row, a digit each.
fn point(text: &str) -> Option<DVec2> {
    let mut digits = text.chars().filter_map(|c| c.to_digit(10));
    Some(DVec2::new(f64::from(digits.next()?), f64::from(digits.next()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_printable_character_has_its_own_strokes() {
        assert!(GLYPHS.is_sorted_by_key(|g| g.0));
        let absent: String = (' '..='~')
            .filter(|c| *c != ' ' && GLYPHS.binary_search_by_key(c, |g| g.0).is_err())
            .collect();
        assert_eq!(absent, "$&@`");
        for (i, (c, strokes)) in GLYPHS.iter().enumerate() {
            assert!(GLYPHS[..i].iter().all(|g| g.1 != *strokes), "{c} looks like another");
            for stroke in strokes.split(',') {
                assert!(stroke.split(' ').all(|p| p.len() == 2 && point(p).is_some()), "{c}");
            }
        }
    }

    #[test]
    fn lines_grow_with_their_size_and_stay_within_it() {
        let small = line("Hg", 8.0);
        assert_eq!((small.advance, small.ascent, small.descent), (12.0, 6.0, 2.0));
        let bounds = small.path.bounds().expect("strokes");
        assert_eq!((bounds.min().y, bounds.max().y), (-6.0, 2.0));
        assert_eq!(line("Hg", 16.0).advance, 24.0);
        assert_eq!(line("a\u{7}é", f64::NAN).advance, 0.0);
    }
}
