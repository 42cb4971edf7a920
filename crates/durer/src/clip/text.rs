//! Text clipped to a window, in the three ways of the textbooks: all or none of a string, all or none of each character, and
//! the outlines themselves.
//!
//! D. Hearn, M. P. Baker, *Computer Graphics*, 2nd ed. 1994, section 6-10; J. D. Foley, A. van Dam, S. K. Feiner, J. F. Hughes,
//! *Computer Graphics: Principles and Practice*, 2nd ed. 1990, section 3.15. Object space. Cost: one comparison of boxes for the
//! string, one for each character, and for outlines O(n) for the n points of characters that cross a border.
//!
//! Characters are boxes with outlines, of any font: [`of_strokes`] and [`of_glyphs`] make them. A ring is clipped by
//! [Sutherland and Hodgman](super::polygon::sutherland_hodgman), so that separate pieces keep a bridge along the border.

use super::outcode::Outcode;
use super::polygon::{rectangle, sutherland_hodgman};
use crate::curve::text::TextLine;
use crate::curve::{Contours, Path, flatten, stroke_font};
use crate::info::{Class, Info, Occluder};
use crate::math::{DAffine2, DVec2, Rect};
use crate::trace::{NoTrace, Tracer};
use crate::{Error, Result};

/// The three ways, one after the other.
const PSEUDOCODE: &[&str] = &[
    "by string: compare the box around the whole string with the window",
    "    within it: keep all characters",
    "    else: drop all",
    "by character: for each character, compare the box around it with the window",
    "    within it: keep the character",
    "    else: drop it",
    "by outline: for each character, compare the box around it with the window",
    "    within it: keep the character",
    "    beyond a border: drop it",
    "    else: for each stroke or ring of its outline:",
    "        clip a stroke as line segments, a ring as a polygon; keep the parts",
];

/// Facts about clipping whole strings.
pub const STRING: Info = Info {
    name: "text-by-string",
    title: "All-or-none string clipping",
    authors: "D. Hearn, M. P. Baker",
    year: 1994,
    source: "Computer Graphics, 2nd ed., section 6-10",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1) comparisons, after the box around all characters",
    limits: "a string that crosses a border is left out as a whole",
    pseudocode: PSEUDOCODE,
};

/// Facts about clipping whole characters.
pub const CHARACTER: Info = Info {
    name: "text-by-character",
    title: "All-or-none character clipping",
    cost: "O(c) for c characters",
    limits: "a character that crosses a border is left out as a whole",
    ..STRING
};

/// Facts about clipping outlines.
pub const OUTLINE: Info = Info {
    name: "text-by-outline",
    title: "Outline clipping of text",
    cost: "O(c + n) for c characters and the n points of those that cross a border",
    limits: "bridging edges along the border where a ring falls apart",
    ..STRING
};

crate::info::family! {
    /// The ways to clip text, from the fastest to the most exact.
    pub enum TextClipper {
        /// All characters or none.
        String => STRING,
        /// Each character or nothing of it.
        Character => CHARACTER,
        /// The part of each outline in the window.
        Outline => OUTLINE,
    }
}

/// Options for clipping text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Way to clip.
    pub clipper: TextClipper,
}

impl Default for Options {
    /// Returns the default: outlines.
    fn default() -> Self {
        Self { clipper: TextClipper::Outline }
    }
}

/// A character with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Character {
    /// Box of the character, with the space that belongs to it; the outline is within it.
    pub bounds: Rect,
    /// Strokes, which are open, and rings, which are closed; none for a space.
    pub outline: Contours,
}

/// Remaining part of a character.
#[derive(Debug, Clone, PartialEq)]
pub struct Kept {
    /// Its number in the string.
    pub character: usize,
    /// Its outline in the window.
    pub outline: Contours,
}

/// Relation of a box to the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BoxPlace {
    /// All of it is in the window.
    Within,
    /// All of it is beyond one border.
    Beyond,
    /// Neither.
    Crossing,
}

impl BoxPlace {
    /// Returns the relation of a box to a window.
    fn of(window: &Rect, bounds: &Rect) -> Self {
        let code = |p: DVec2| Outcode::of_point_2d(window, p);
        let (low, high) = (code(bounds.min()), code(bounds.max()));
        match ((low | high).is_inside(), (low & high).is_inside()) {
            (true, _) => Self::Within,
            (_, false) => Self::Beyond,
            _ => Self::Crossing,
        }
    }
}

/// Step of each of the algorithms.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// A box was compared with the window.
    Box {
        /// The character; none for the whole string.
        character: Option<usize>,
        /// Its box.
        bounds: Rect,
        /// Its relation to the window.
        place: BoxPlace,
    },
    /// A character is kept as it is.
    Keep {
        /// Its number.
        character: usize,
        /// Its outline.
        outline: Contours,
    },
    /// A character is left out.
    Drop {
        /// Its number.
        character: usize,
    },
    /// A stroke or a ring was clipped.
    Cut {
        /// Number of the character.
        character: usize,
        /// Its points.
        contour: Vec<DVec2>,
        /// True for a ring.
        closed: bool,
        /// Its parts in the window.
        parts: Vec<Vec<DVec2>>,
    },
}

impl Step {
    /// Returns the line of the pseudocode that runs, counted from 1; each way to clip has its own lines.
    pub fn line(&self, clipper: TextClipper) -> usize {
        let first = match clipper {
            TextClipper::String => 1,
            TextClipper::Character => 4,
            TextClipper::Outline => 7,
        };
        match self {
            Self::Box { .. } => first,
            Self::Keep { .. } => first + 1,
            Self::Drop { .. } => first + 2,
            Self::Cut { .. } => first + 4,
        }
    }
}

/// Returns the result that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<Kept> {
    let mut kept: Vec<Kept> = Vec::new();
    for step in steps {
        match step {
            Step::Keep { character, outline } => {
                kept.push(Kept { character: *character, outline: outline.clone() });
            }
            Step::Cut { character, closed, parts, .. } if !parts.is_empty() => {
                if kept.last().is_none_or(|last| last.character != *character) {
                    kept.push(Kept { character: *character, outline: Contours::new() });
                }
                if let Some(last) = kept.last_mut() {
                    parts.iter().for_each(|part| last.outline.push(part.iter().copied(), *closed));
                }
            }
            Step::Box { .. } | Step::Drop { .. } | Step::Cut { .. } => {}
        }
    }
    kept
}

/// Returns the visible parts of a string's characters in a closed window, in order. A character that is only space is
/// kept by its box like any other, and is left out where its outline is clipped.
///
/// ```
/// use durer::clip::text::{Options, TextClipper, clip, of_strokes};
/// use durer::math::{DVec2, Rect};
/// use durer::trace::NoTrace;
///
/// let text = of_strokes("HI", 12.0, DVec2::ZERO)?;
/// // A window through the middle of the H.
/// let middle = text[0].bounds.min().midpoint(text[0].bounds.max()).x;
/// let window = Rect::new(DVec2::new(middle, -20.0), DVec2::new(99.0, 20.0))?;
/// let kept = |clipper| {
///     let kept = clip(&window, &text, &Options { clipper }, &mut NoTrace)?;
///     Ok::<_, durer::Error>(kept.iter().map(|kept| kept.character).collect::<Vec<_>>())
/// };
/// assert!(kept(TextClipper::String)?.is_empty());
/// assert_eq!(kept(TextClipper::Character)?, [1]);
/// assert_eq!(kept(TextClipper::Outline)?, [0, 1]);
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::NonFinite`] for a point of an outline that is NaN or infinite, with the index of its character.
pub fn clip(
    window: &Rect,
    text: &[Character],
    options: &Options,
    t: &mut impl Tracer<Step>,
) -> Result<Vec<Kept>> {
    let finite = |character: &Character| character.outline.points().iter().all(|p| p.is_finite());
    if let Some(index) = text.iter().position(|character| !finite(character)) {
        return Err(Error::NonFinite { what: "character", index });
    }
    let mut kept = Vec::new();
    let whole = match options.clipper {
        TextClipper::String => {
            let corners = text.iter().flat_map(|own| [own.bounds.min(), own.bounds.max()]);
            let Some(bounds) = Rect::around(corners) else { return Ok(kept) };
            let place = BoxPlace::of(window, &bounds);
            t.step(|| Step::Box { character: None, bounds, place });
            Some(place)
        }
        TextClipper::Character | TextClipper::Outline => None,
    };
    for (character, own) in text.iter().enumerate() {
        let place = whole.unwrap_or_else(|| {
            let place = BoxPlace::of(window, &own.bounds);
            t.step(|| Step::Box { character: Some(character), bounds: own.bounds, place });
            place
        });
        if place == BoxPlace::Within {
            t.step(|| Step::Keep { character, outline: own.outline.clone() });
            kept.push(Kept { character, outline: own.outline.clone() });
        } else if place == BoxPlace::Beyond || options.clipper != TextClipper::Outline {
            t.step(|| Step::Drop { character });
        } else {
            let outline = cut(window, (character, &own.outline), t)?;
            if !outline.points().is_empty() {
                kept.push(Kept { character, outline });
            }
        }
    }
    Ok(kept)
}

/// Returns the part of an outline in a window.
fn cut(
    window: &Rect,
    (character, outline): (usize, &Contours),
    t: &mut impl Tracer<Step>,
) -> Result<Contours> {
    let mut left = Contours::new();
    for (contour, closed) in outline.iter() {
        let parts: Vec<Vec<DVec2>> = if closed {
            let ring = sutherland_hodgman::clip(window, contour, &mut NoTrace)?;
            if ring.is_empty() { Vec::new() } else { vec![ring] }
        } else {
            let clipped = rectangle::clip_lines(window, contour, &[contour.len()], false)?;
            clipped.pieces().map(|(_, piece)| piece.to_vec()).collect()
        };
        parts.iter().for_each(|part| left.push(part.iter().copied(), closed));
        t.step(|| Step::Cut { character, contour: contour.to_vec(), closed, parts });
    }
    Ok(left)
}

/// Returns a line of text in the [stroke font](stroke_font), y up, with the first character's origin on the base line: each
/// box reaches from the bottom of descenders to the top of capitals, and as wide as the pen moves on.
///
/// # Errors
/// [`Error::Parameter`] for a height or an origin that is not finite, and for a negative height.
pub fn of_strokes(text: &str, cap_height: f64, origin: DVec2) -> Result<Vec<Character>> {
    if !(cap_height >= 0.0 && cap_height.is_finite()) {
        return Err(Error::parameter("height of capitals", cap_height, "finite and at least 0"));
    }
    let mut x = origin.x;
    let mut characters = Vec::new();
    for character in text.chars().filter(|c| !c.is_control()) {
        let own = stroke_font::line(character.encode_utf8(&mut [0; 4]), cap_height);
        let mut outline = Contours::new();
        for stroke in &own.strokes {
            outline.push(stroke.iter().map(|p| DVec2::new(x + p.x, origin.y - p.y)), false);
        }
        let low = DVec2::new(x, origin.y - cap_height * DESCENT);
        let high = DVec2::new(x + own.advance, origin.y + cap_height);
        characters.push(Character { bounds: around(&outline, low, high)?, outline });
        x += own.advance;
    }
    Ok(characters)
}

/// Depth of descenders in the stroke font, in parts of the height of capitals.
const DESCENT: f64 = 4.0 / 12.0;

/// Returns a line of text in an outline font, y down as the line has it, with its origin at a point; curves become chains of
/// lines within `tolerance`. Each box reaches from ascenders to descenders, and from the glyph's origin to the next one.
///
/// # Errors
/// [`Error::Parameter`] for an origin that is not finite.
pub fn of_glyphs(line: &TextLine, origin: DVec2, tolerance: f64) -> Result<Vec<Character>> {
    let mut first = 0;
    let character = |glyph: &crate::curve::text::PlacedGlyph| {
        let mut path = Path::new();
        let own = line.path.elements().get(first..glyph.elements).unwrap_or_default();
        own.iter().for_each(|element| {
            path.push(*element);
        });
        first = glyph.elements;
        let outline = flatten(&path.transformed(DAffine2::from_translation(origin)), tolerance);
        let low = origin + DVec2::new(glyph.start.min(glyph.end), -line.ascent);
        let high = origin + DVec2::new(glyph.start.max(glyph.end), line.descent);
        Ok(Character { bounds: around(&outline, low, high)?, outline })
    };
    line.glyphs.iter().map(character).collect()
}

/// Returns the rectangle around an outline and two corners of its cell: accents and overhangs are in it.
fn around(outline: &Contours, low: DVec2, high: DVec2) -> Result<Rect> {
    let points = outline.points();
    let fold = |of: fn(DVec2, DVec2) -> DVec2, first| points.iter().copied().fold(first, of);
    Rect::new(fold(DVec2::min, low), fold(DVec2::max, high))
}
