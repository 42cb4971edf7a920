//! Glyph outlines in a line of text: left to right, with the font's advance widths and pair kerning.
//!
//! Enough for labels. Limits: no shaping — ligatures, marks and right-to-left scripts are laid out glyph by
//! glyph — and kerning from the font's `kern` table only, not from GPOS.

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::raw::TableProvider;
use skrifa::raw::tables::kern::SubtableKind;
use skrifa::{FontRef, GlyphId, MetadataProvider};

use super::Path;
use crate::math::{DAffine2, DVec2};
use crate::{Error, Result};

/// A font, read from the bytes of a TrueType or OpenType file.
#[derive(Clone)]
pub struct Font<'a> {
    font: FontRef<'a>,
}

/// A line of text as outlines.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextLine {
    /// The outlines, y down, the first glyph's origin on the base line at (0, 0).
    pub path: Path,
    /// Offset of the next glyph.
    pub advance: f64,
    /// Places of the glyphs: where each starts on the base line, where the next one does, and before which element of
    /// the path its outline ends.
    pub glyphs: Vec<PlacedGlyph>,
    /// Height of ascenders above the base line, positive.
    pub ascent: f64,
    /// Depth of descenders below the base line, positive.
    pub descent: f64,
}

/// A glyph of a [`TextLine`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedGlyph {
    /// Its origin on the base line.
    pub start: f64,
    /// The origin of a glyph after it, without kerning.
    pub end: f64,
    /// Number of the elements of the line's path that belong to it and to those before.
    pub elements: usize,
}

impl TextLine {
    /// Returns the outlines along a polyline: each glyph is turned by the direction at its middle, as SVG's `textPath`
    /// does. The text's start is `start` along the polyline, its base line `below` that far on its right (y down);
    /// glyphs before or after the polyline continue it straight.
    pub fn along(&self, polyline: &[DVec2], start: f64, below: f64) -> Path {
        let mut out = Path::new();
        let mut first = 0;
        for glyph in &self.glyphs {
            let middle = (glyph.start + glyph.end) * 0.5;
            let elements = self.path.elements().get(first..glyph.elements).unwrap_or_default();
            first = glyph.elements;
            let Some((at, direction)) = place_along(polyline, start + middle) else { continue };
            let turned = DAffine2::from_cols(direction, direction.perp(), at)
                * DAffine2::from_translation(DVec2::new(-middle, below));
            let mut own = Path::new();
            elements.iter().for_each(|element| {
                own.push(*element);
            });
            out.extend(&own.transformed(turned));
        }
        out
    }
}

/// Returns the point so far along a polyline, and the unit direction there; `None` if it has no
/// length.
pub fn place_along(polyline: &[DVec2], mut along: f64) -> Option<(DVec2, DVec2)> {
    let mut last = None;
    for pair in polyline.windows(2) {
        let (way, length) = (pair[1] - pair[0], pair[0].distance(pair[1]));
        if !(length > 0.0 && length.is_finite()) {
            continue;
        }
        let direction = way / length;
        if along <= length {
            return Some((pair[0] + direction * along, direction));
        }
        along -= length;
        last = Some((pair[1], direction));
    }
    last.map(|(end, direction)| (end + direction * along, direction))
}

impl std::fmt::Debug for Font<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Font").finish_non_exhaustive()
    }
}

impl<'a> Font<'a> {
    /// Reads a font file, or the font with the given index of a collection.
    ///
    /// # Errors
    /// [`Error::Parameter`] if the bytes are not a font.
    pub fn new(bytes: &'a [u8], index: u32) -> Result<Self> {
        let font = FontRef::from_index(bytes, index)
            .map_err(|e| Error::parameter("font", e, "the bytes of a TrueType or OpenType file"))?;
        Ok(Self { font })
    }

    /// Returns whether the font has a glyph for a character, or the character needs none.
    pub fn has(&self, character: char) -> bool {
        character.is_control() || self.font.charmap().map(character).is_some()
    }

    /// Lays out one line of text; `size` is the height of the em square in pixels. Characters that the
    /// font does not have appear as its missing-glyph box; control characters are left out.
    pub fn line(&self, text: &str, size: f64) -> TextLine {
        let size = if size.is_finite() { size.clamp(0.0, 1e6) } else { 0.0 };
        let (em, at) = (Size::new(size as f32), LocationRef::default());
        let (characters, metrics) = (self.font.charmap(), self.font.metrics(em, at));
        let (glyphs, outlines) = (self.font.glyph_metrics(em, at), self.font.outline_glyphs());
        let per_unit = size / f64::from(metrics.units_per_em.max(1));
        let mut line = TextLine {
            ascent: f64::from(metrics.ascent),
            descent: -f64::from(metrics.descent),
            ..TextLine::default()
        };
        let mut previous = None;
        for character in text.chars().filter(|c| !c.is_control()) {
            let glyph = characters.map(character).unwrap_or(GlyphId::NOTDEF);
            if let Some(left) = previous {
                line.advance += f64::from(self.kerning(left, glyph)) * per_unit;
            }
            let mut pen = Pen::default();
            let settings = DrawSettings::unhinted(em, at);
            if outlines.get(glyph).is_some_and(|o| o.draw(settings, &mut pen).is_ok()) {
                let moved = DAffine2::from_translation(DVec2::new(line.advance, 0.0));
                line.path.extend(&pen.0.transformed(moved));
            }
            let start = line.advance;
            line.advance += f64::from(glyphs.advance_width(glyph).unwrap_or(0.0));
            let elements = line.path.elements().len();
            line.glyphs.push(PlacedGlyph { start, end: line.advance, elements });
            previous = Some(glyph);
        }
        line
    }

    /// Returns the kerning of two glyphs: how much closer they are set, in font units.
    fn kerning(&self, left: GlyphId, right: GlyphId) -> i32 {
        let Ok(kern) = self.font.kern() else { return 0 };
        let tables = kern.subtables().filter_map(|t| t.ok());
        tables
            .filter(|t| t.is_horizontal() && !t.is_cross_stream())
            .filter_map(|t| match t.kind().ok()? {
                SubtableKind::Format0(t) => t.kerning(left, right),
                SubtableKind::Format2(t) => t.kerning(left, right),
                SubtableKind::Format3(t) => t.kerning(left, right),
                _ => None,
            })
            .sum()
    }
}

/// Pen that draws into a path with y reversed.
#[derive(Default)]
struct Pen(Path);

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x.into(), -f64::from(y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x.into(), -f64::from(y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.0.quad_to(cx.into(), -f64::from(cy), x.into(), -f64::from(y));
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        let at = |x: f32, y: f32| DVec2::new(x.into(), -f64::from(y));
        self.0.cubic_to(at(ax, ay), at(bx, by), at(x, y));
    }

    fn close(&mut self) {
        self.0.close();
    }
}
