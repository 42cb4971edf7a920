//! The fonts that text is set in.

use super::Notes;
use crate::Place;
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};
use usvg::fontdb::{self, Database, Family, Query, Source};
use usvg::{FontFamily, FontResolver, FontStretch, FontStyle};

/// Families that may replace a generic one; the first that is installed is taken, if none is, the first of all.
const SANS: [&str; 7] =
    ["DejaVu Sans", "Noto Sans", "Liberation Sans", "Arial", "Helvetica", "Roboto", "Open Sans"];
const SERIF: [&str; 6] = [
    "DejaVu Serif",
    "Noto Serif",
    "Liberation Serif",
    "Times New Roman",
    "Times",
    "Source Serif 4",
];
const MONO: [&str; 6] = [
    "DejaVu Sans Mono",
    "Noto Sans Mono",
    "Liberation Mono",
    "Courier New",
    "Fira Mono",
    "Roboto Mono",
];

/// A set of fonts, from the bytes of TrueType and OpenType files and collections.
///
/// The appearance of text depends only on the added fonts and their order.
#[derive(Debug)]
pub struct Fonts {
    /// Made when first needed; `const` cannot do it.
    database: OnceLock<Arc<Database>>,
}

impl Default for Fonts {
    fn default() -> Self {
        Self::new()
    }
}

impl Fonts {
    /// Creates a set without fonts.
    pub const fn new() -> Self {
        Self { database: OnceLock::new() }
    }

    /// Adds the fonts of a file; returns how many there are in it, 0 where the bytes are no font.
    pub fn add(&mut self, bytes: Vec<u8>) -> usize {
        let mut database = self.database.take().unwrap_or_default();
        let all = Arc::make_mut(&mut database);
        let added = all.load_font_source(Source::Binary(Arc::new(bytes))).len();
        let pick = |names: &[&str], all: &Database| {
            let has = |name: &str| all.faces().any(|f| f.families.iter().any(|n| n.0 == name));
            let first = || all.faces().next().and_then(|f| f.families.first()).map(|n| n.0.clone());
            names.iter().find(|n| has(n)).map(|n| (*n).to_owned()).or_else(first)
        };
        if let Some(name) = pick(&SANS, all) {
            all.set_sans_serif_family(name.clone());
            all.set_cursive_family(name.clone());
            all.set_fantasy_family(name);
        }
        if let Some(name) = pick(&SERIF, all) {
            all.set_serif_family(name);
        }
        if let Some(name) = pick(&MONO, all) {
            all.set_monospace_family(name);
        }
        self.database = OnceLock::from(database);
        added
    }

    /// Returns whether there are no fonts.
    pub fn is_empty(&self) -> bool {
        self.database.get().is_none_or(|d| d.is_empty())
    }

    /// Returns the bytes of the font of the given family, or of the first for `None`, and its number in
    /// its file.
    pub fn find(&self, family: Option<&str>) -> Option<(&[u8], u32)> {
        let database = self.database.get()?;
        let face = match family {
            None => database.faces().next()?,
            Some(name) => {
                let query = Query { families: &[Family::Name(name)], ..Query::default() };
                database.face(database.query(&query)?)?
            }
        };
        bytes(face)
    }

    /// Returns the bytes of all fonts in their order, each with its number in its file.
    pub fn iter(&self) -> impl Iterator<Item = (&[u8], u32)> {
        let faces = self.database.get().into_iter().flat_map(|database| database.faces());
        faces.filter_map(bytes)
    }

    /// Returns the family of text that names none.
    pub(super) fn default_family(&self) -> String {
        let database = self.database.get();
        database.map_or_else(String::new, |d| d.family_name(&Family::SansSerif).to_owned())
    }

    pub(super) fn database(&self) -> Arc<Database> {
        self.database.get().cloned().unwrap_or_default()
    }
}

/// Returns the bytes of a font and its number in its file.
fn bytes(face: &fontdb::FaceInfo) -> Option<(&[u8], u32)> {
    match &face.source {
        Source::Binary(data) => Some(((**data).as_ref(), face.index)),
        #[allow(unreachable_patterns)]
        _ => None,
    }
}

/// Chooses fonts by family and style; warns about fonts that are not available.
pub(super) fn resolver(notes: &Notes) -> FontResolver<'_> {
    let fallback = FontResolver::default_fallback_selector();
    FontResolver {
        select_font: Box::new(move |font, database| {
            let id = select(font, database);
            if let Some(face) = id.and_then(|id| database.face(id)) {
                let add = |message| notes.add(Place::Whole, message);
                replaced(font, face).into_iter().for_each(add);
            }
            id
        }),
        select_fallback: Box::new(move |letter, used, database| {
            let id = fallback(letter, used, database);
            if id.is_none() {
                notes.miss(letter);
            }
            id
        }),
    }
}

/// Weights that differ by less look alike.
const SAME_WEIGHT: u16 = 200;

/// Returns a warning if a face is not the one that was requested.
fn replaced(font: &usvg::Font, face: &fontdb::FaceInfo) -> Option<String> {
    let is_one_of = |names: &[&str]| face.families.iter().any(|f| names.contains(&f.0.as_str()));
    let (wanted, same_family) = match font.families().first() {
        None => return None,
        Some(FontFamily::Named(name)) => {
            (name.as_str(), face.families.iter().any(|f| f.0.eq_ignore_ascii_case(name)))
        }
        Some(FontFamily::Serif) => ("serif", is_one_of(&SERIF)),
        Some(FontFamily::SansSerif) => ("sans-serif", true),
        Some(FontFamily::Cursive) => ("cursive", false),
        Some(FontFamily::Fantasy) => ("fantasy", false),
        Some(FontFamily::Monospace) => ("monospace", face.monospaced),
    };
    let slanted = (font.style() != FontStyle::Normal, face.style != fontdb::Style::Normal);
    let same_style = font.weight().abs_diff(face.weight.0) < SAME_WEIGHT
        && slanted.0 == slanted.1
        && stretch(font) == face.stretch;
    if same_family && same_style {
        return None;
    }
    let found = face.families.first().map_or("another", |f| f.0.as_str());
    let wanted = described(wanted, font.weight(), slanted.0, stretch(font));
    let found = described(found, face.weight.0, slanted.1, face.stretch);
    Some(format!("font {wanted} is missing; {found} is used in its place"))
}

/// Returns a family with the parts of its style that are not normal.
fn described(family: &str, weight: u16, slanted: bool, stretch: fontdb::Stretch) -> String {
    let weight = match weight {
        300..500 => String::new(),
        700 => " bold".to_owned(),
        _ => format!(" of weight {weight}"),
    };
    let slanted = if slanted { " italic" } else { "" };
    let number = stretch.to_number();
    let width = match number.cmp(&fontdb::Stretch::Normal.to_number()) {
        std::cmp::Ordering::Less => " condensed",
        std::cmp::Ordering::Equal => "",
        std::cmp::Ordering::Greater => " expanded",
    };
    format!("`{family}`{weight}{slanted}{width}")
}

/// Letters that are named in a warning, at most.
const NAMED: usize = 12;

/// Returns a warning about letters that no font has: those known to be `missing`, and those without a glyph.
pub(super) fn missing_letters(tree: &usvg::Tree, mut missing: BTreeSet<char>) -> Option<String> {
    let mut groups = vec![tree.root()];
    while let Some(group) = groups.pop() {
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => groups.push(group),
                usvg::Node::Text(text) => {
                    let glyphs = text.layouted().iter().flat_map(|span| &span.positioned_glyphs);
                    let without = glyphs.filter(|glyph| glyph.id.0 == 0);
                    missing.extend(without.flat_map(|glyph| glyph.text.chars()));
                }
                _ => {}
            }
        }
    }
    let is_seen = |c: &char| {
        let joins = matches!(c, '\u{34f}' | '\u{200b}'..='\u{200f}' | '\u{2060}'..='\u{2064}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}');
        !joins && !c.is_control() && !c.is_whitespace()
    };
    no_glyphs(missing.into_iter().filter(is_seen))
}

/// Returns the warning that there are no glyphs for some letters, if there are such letters.
pub fn no_glyphs(letters: impl Iterator<Item = char>) -> Option<String> {
    let letters: Vec<char> = letters.collect();
    let named = letters.iter().take(NAMED).map(|c| format!("{c} (U+{:04X})", u32::from(*c)));
    let named = named.collect::<Vec<_>>().join(", ");
    let rest = match letters.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let message = format!("there is no glyph for {named}{rest}: left blank, or a box");
    (!letters.is_empty()).then_some(message)
}

fn select(font: &usvg::Font, database: &Database) -> Option<fontdb::ID> {
    let mut families: Vec<Family<'_>> = font
        .families()
        .iter()
        .map(|family| match family {
            FontFamily::Serif => Family::Serif,
            FontFamily::SansSerif => Family::SansSerif,
            FontFamily::Cursive => Family::Cursive,
            FontFamily::Fantasy => Family::Fantasy,
            FontFamily::Monospace => Family::Monospace,
            FontFamily::Named(name) => Family::Name(name),
        })
        .collect();
    families.push(Family::SansSerif);
    let style = match font.style() {
        FontStyle::Normal => fontdb::Style::Normal,
        FontStyle::Italic => fontdb::Style::Italic,
        FontStyle::Oblique => fontdb::Style::Oblique,
    };
    let weight = fontdb::Weight(font.weight());
    database.query(&Query { families: &families, weight, stretch: stretch(font), style })
}

fn stretch(font: &usvg::Font) -> fontdb::Stretch {
    match font.stretch() {
        FontStretch::UltraCondensed => fontdb::Stretch::UltraCondensed,
        FontStretch::ExtraCondensed => fontdb::Stretch::ExtraCondensed,
        FontStretch::Condensed => fontdb::Stretch::Condensed,
        FontStretch::SemiCondensed => fontdb::Stretch::SemiCondensed,
        FontStretch::Normal => fontdb::Stretch::Normal,
        FontStretch::SemiExpanded => fontdb::Stretch::SemiExpanded,
        FontStretch::Expanded => fontdb::Stretch::Expanded,
        FontStretch::ExtraExpanded => fontdb::Stretch::ExtraExpanded,
        FontStretch::UltraExpanded => fontdb::Stretch::UltraExpanded,
    }
}
