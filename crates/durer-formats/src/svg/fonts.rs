//! The fonts that text is set in.

use super::Told;
use std::sync::{Arc, OnceLock};
use usvg::fontdb::{self, Database, Family, Query, Source};
use usvg::{FontFamily, FontResolver, FontStretch, FontStyle};

/// Families that may stand for a generic one, the first that is there; if none is, the first of all.
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
/// What text looks like depends on the fonts that were added and on their order, on nothing else.
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
    pub(super) const NONE: Self = Self { database: OnceLock::new() };

    /// No fonts.
    pub fn new() -> Self {
        Self::NONE
    }

    /// Adds the fonts of a file; gives how many there are in it, 0 where the bytes are no font.
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

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.database.get().is_none_or(|d| d.is_empty())
    }

    /// The bytes of the font of the given family, or of the first for `None`, and its number in its file.
    pub fn find(&self, family: Option<&str>) -> Option<(&[u8], u32)> {
        let database = self.database.get()?;
        let face = match family {
            None => database.faces().next()?,
            Some(name) => {
                let query = Query { families: &[Family::Name(name)], ..Query::default() };
                database.face(database.query(&query)?)?
            }
        };
        match &face.source {
            Source::Binary(data) => Some(((**data).as_ref(), face.index)),
            #[allow(unreachable_patterns)]
            _ => None,
        }
    }

    /// The family of text that names none.
    pub(super) fn default_family(&self) -> String {
        let database = self.database.get();
        database.map_or_else(String::new, |d| d.family_name(&Family::SansSerif).to_owned())
    }

    pub(super) fn database(&self) -> Arc<Database> {
        self.database.get().cloned().unwrap_or_default()
    }
}

/// Chooses fonts by family and style; tells where a family that was asked for is not there.
pub(super) fn resolver(told: &Told) -> FontResolver<'_> {
    FontResolver {
        select_font: Box::new(move |font, database| {
            let id = select(font, database);
            let wanted = font.families().first();
            if let (Some(FontFamily::Named(wanted)), Some(id)) = (wanted, id)
                && let Some(face) = database.face(id)
                && !face.families.iter().any(|f| f.0.eq_ignore_ascii_case(wanted))
            {
                let name = face.families.first().map_or("another", |f| f.0.as_str());
                told.tell(format!("font `{wanted}` is missing; `{name}` is used in its place"));
            }
            id
        }),
        select_fallback: FontResolver::default_fallback_selector(),
    }
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
    let stretch = match font.stretch() {
        FontStretch::UltraCondensed => fontdb::Stretch::UltraCondensed,
        FontStretch::ExtraCondensed => fontdb::Stretch::ExtraCondensed,
        FontStretch::Condensed => fontdb::Stretch::Condensed,
        FontStretch::SemiCondensed => fontdb::Stretch::SemiCondensed,
        FontStretch::Normal => fontdb::Stretch::Normal,
        FontStretch::SemiExpanded => fontdb::Stretch::SemiExpanded,
        FontStretch::Expanded => fontdb::Stretch::Expanded,
        FontStretch::ExtraExpanded => fontdb::Stretch::ExtraExpanded,
        FontStretch::UltraExpanded => fontdb::Stretch::UltraExpanded,
    };
    let style = match font.style() {
        FontStyle::Normal => fontdb::Style::Normal,
        FontStyle::Italic => fontdb::Style::Italic,
        FontStyle::Oblique => fontdb::Style::Oblique,
    };
    let weight = fontdb::Weight(font.weight());
    database.query(&Query { families: &families, weight, stretch, style })
}
