//! Invisible text for searching and copying: viewers search only text written with a font, not the strokes of the
//! single-stroke font. So beneath the strokes there is text in render mode 3, "neither fill nor stroke" (ISO 32000-1,
//! 9.3.6), in a font that every viewer has.

use super::number::{push, short};
use durer::curve::stroke_font;
use durer::math::DVec2;
use durer::target::drawing::TextAnchor;
use pdf_writer::types::{SystemInfo, UnicodeCmap};
use pdf_writer::{Name, Pdf, Ref, Str};
use std::collections::BTreeMap;

/// The font's name in the page's resources.
pub const FONT: &[u8] = b"F";
/// Width of all its letters, in thousandths of its size,
const WIDTH: f64 = 600.0;
/// and its capitals so high.
const CAPITALS: f64 = 562.0;
/// Codes for letters beyond Latin-1, whose own codes are the same in the font's encoding.
const OTHERS: std::ops::RangeInclusive<u8> = 0x80..=0x9f;

/// Texts of a document.
#[derive(Debug, Default)]
pub struct Words {
    /// True if there is any text.
    pub any: bool,
    /// Codes of letters beyond Latin-1.
    others: BTreeMap<char, u8>,
}

impl Words {
    /// Appends the operators for a text at a place, in millimetres, y down, as high and as wide as the strokes; the
    /// unit vector beside the place is the writing direction.
    pub fn write(
        &mut self,
        text: &mut String,
        (at, along): (DVec2, DVec2),
        words: &str,
        height: f64,
        anchor: TextAnchor,
    ) {
        let codes: Vec<u8> =
            words.chars().filter(|c| !c.is_control()).map(|c| self.code(c)).collect();
        let size = height * 1000.0 / CAPITALS;
        let advance = stroke_font::line(words, height).advance;
        let natural = codes.len() as f64 * WIDTH / 1000.0 * size;
        if !(natural > 0.0 && advance > 0.0 && natural.is_finite() && advance.is_finite()) {
            return;
        }
        if !self.any {
            *text += "3 Tr\n";
            self.any = true;
        }
        let start = at - along * (advance * anchor.share());
        let [size, stretch] = [short(size, 3), short(100.0 * advance / natural, 2)];
        *text += &format!("BT /F {size} Tf {stretch} Tz");
        // The letters' up is at a right angle to their direction.
        for value in [along.x, along.y, along.y, -along.x, start.x, start.y] {
            text.push(' ');
            push(text, value, 3);
        }
        *text += " Tm <";
        codes.iter().for_each(|code| *text += &format!("{code:02X}"));
        *text += "> Tj ET\n";
    }

    /// Returns the code of a letter; if no codes are left, the question mark's.
    fn code(&mut self, letter: char) -> u8 {
        match letter {
            ' '..='~' | '\u{a0}'..='\u{ff}' => letter as u8,
            _ => {
                let next = OTHERS.start() + self.others.len().min(OTHERS.count()) as u8;
                let known = self.others.get(&letter).copied();
                known.or_else(|| OTHERS.contains(&next).then_some(next)).map_or(b'?', |code| {
                    self.others.insert(letter, code);
                    code
                })
            }
        }
    }

    /// Writes the font as one object, and the letters of its codes as another.
    pub fn font(&self, pdf: &mut Pdf, font: Ref, letters: Ref) {
        if !self.any {
            return;
        }
        let mut dictionary = pdf.type1_font(font);
        dictionary.base_font(Name(b"Courier"));
        dictionary.encoding_predefined(Name(b"WinAnsiEncoding"));
        if self.others.is_empty() {
            return;
        }
        dictionary.to_unicode(letters);
        drop(dictionary);
        let info = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"UCS"), supplement: 0 };
        let mut map = UnicodeCmap::<u8>::new(Name(b"Letters"), info);
        let latin = (b' '..=b'~').chain(0xa0..=0xff).map(|code| (code, char::from(code)));
        let others = self.others.iter().map(|(letter, code)| (*code, *letter));
        latin.chain(others).for_each(|(code, letter)| map.pair(code, letter));
        pdf.cmap(letters, &map.finish());
    }
}
