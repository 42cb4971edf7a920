//! Texts in two languages: words, values, and captions made from templates.

use crate::math::{DVec2, DVec3};
use std::fmt::Write;

/// Language of captions and tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Language {
    /// English, with a decimal point.
    #[default]
    English,
    /// German, with a decimal comma.
    German,
}

impl Language {
    /// Every language, in the order of the documentation.
    pub const ALL: &'static [Self] = &[Self::English, Self::German];

    /// Returns the two letters of ISO 639.
    pub const fn code(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::German => "de",
        }
    }
}

/// A fixed text in every language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Word {
    /// English text.
    pub en: &'static str,
    /// German text.
    pub de: &'static str,
}

impl Word {
    /// Creates a text from its translations.
    pub const fn new(en: &'static str, de: &'static str) -> Self {
        Self { en, de }
    }

    /// Returns the text in one language.
    pub const fn text(self, language: Language) -> &'static str {
        match language {
            Language::English => self.en,
            Language::German => self.de,
        }
    }
}

/// A value that captions, tables and pictures show.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Text that is the same in every language, such as a name or an outcode.
    Text(String),
    /// Text with translations.
    Word(Word),
    /// A number, printed with at most three decimals.
    Number(f64),
    /// A point of the plane.
    Point(DVec2),
    /// A point of space.
    Space(DVec3),
    /// Several values in their order.
    List(Vec<Self>),
}

impl Value {
    /// Returns the value as text: numbers short, with the decimal mark of the language.
    pub fn text(&self, language: Language) -> String {
        let tuple = |numbers: &[f64]| {
            // Beside large coordinates, those that rounding leaves are zero.
            let most =
                numbers.iter().filter(|x| x.is_finite()).fold(0.0_f64, |m, x| m.max(x.abs()));
            let rounded = |x: f64| if x.abs() < 1e-6 * most { 0.0 } else { x };
            let all: Vec<_> = numbers.iter().map(|&x| number(rounded(x), language)).collect();
            format!("({})", all.join(separator(language)))
        };
        match self {
            Self::Text(text) => text.clone(),
            Self::Word(word) => word.text(language).to_owned(),
            Self::Number(x) => number(*x, language),
            Self::Point(p) => tuple(&p.to_array()),
            Self::Space(p) => tuple(&p.to_array()),
            Self::List(all) => {
                let all: Vec<_> = all.iter().map(|value| value.text(language)).collect();
                if all.is_empty() { "–".to_owned() } else { all.join(" ") }
            }
        }
    }
}

/// Returns the separator of two numbers: a comma would be read as a decimal one in German.
const fn separator(language: Language) -> &'static str {
    match language {
        Language::English => ", ",
        Language::German => "; ",
    }
}

/// Returns a number with at most three decimals; with an exponent where that would hide it.
fn number(x: f64, language: Language) -> String {
    if x.is_infinite() {
        return if x > 0.0 { "∞" } else { "−∞" }.to_owned();
    }
    let size = x.abs();
    let plain = size == 0.0 || (0.001..1e7).contains(&size);
    let mut text = if plain { format!("{x:.3}") } else { format!("{x:.2e}") };
    if plain {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    if text == "-0" {
        text = "0".to_owned();
    }
    let text = text.replace('-', "−");
    if language == Language::German { text.replace('.', ",") } else { text }
}

macro_rules! values {
    ($($from:ty, $value:ident => $made:expr;)+) => {$(
        impl From<$from> for Value {
            fn from($value: $from) -> Self {
                $made
            }
        }
    )+};
}

values! {
    &str, text => Self::Text(text.to_owned());
    String, text => Self::Text(text);
    Word, word => Self::Word(word);
    f64, x => Self::Number(x);
    i32, x => Self::Number(x.into());
    u32, x => Self::Number(x.into());
    usize, x => Self::Number(x as f64);
    i64, x => Self::Number(x as f64);
    DVec2, p => Self::Point(p);
    DVec3, p => Self::Space(p);
    crate::clip::outcode::Outcode, code => Self::Text(code.to_string());
}

impl<T: Into<Self>> From<Vec<T>> for Value {
    fn from(values: Vec<T>) -> Self {
        Self::List(values.into_iter().map(Into::into).collect())
    }
}

/// Sentence about a kind of step, with `{name}` in place of values, and `{name|one|many}` in place of words that depend on
/// a number: the first for 1, the second for others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Template {
    /// Kind of the step: the variant of `Step` in kebab case.
    pub kind: &'static str,
    /// English and German sentence.
    pub text: Word,
}

impl Template {
    /// Creates a template from its translations.
    pub(crate) const fn new(kind: &'static str, en: &'static str, de: &'static str) -> Self {
        Self { kind, text: Word::new(en, de) }
    }

    /// Returns the caption of the template with values.
    pub(crate) fn with<const N: usize>(
        &'static self,
        values: [(&'static str, Value); N],
    ) -> Caption {
        Caption { template: self, values: values.into() }
    }
}

/// A sentence about one step: a template and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Caption {
    /// The sentence.
    pub template: &'static Template,
    /// Values by the names that the template has for them.
    pub values: Vec<(&'static str, Value)>,
}

impl Caption {
    /// Returns the sentence in one language, its values filled in. A name without a value stays as it is written.
    pub fn text(&self, language: Language) -> String {
        let mut out = String::new();
        for piece in pieces(self.template.text.text(language)) {
            match piece {
                Piece::Plain(text) => out.push_str(text),
                Piece::Words { name, one, many } => {
                    let is_one = |(n, v): &(&str, Value)| *n == name && *v == Value::Number(1.0);
                    out.push_str(if self.values.iter().any(is_one) { one } else { many });
                }
                Piece::Name(name) => match self.values.iter().find(|(n, _)| *n == name) {
                    Some((_, value)) => out.push_str(&value.text(language)),
                    None => {
                        let _ = write!(out, "{{{name}}}");
                    }
                },
            }
        }
        out
    }
}

/// Part of a template.
enum Piece<'a> {
    /// Text to print as it is.
    Plain(&'a str),
    /// Name of a value.
    Name(&'a str),
    /// Words that depend on a number: for 1, and for others.
    Words { name: &'a str, one: &'a str, many: &'a str },
}

/// Divides a template at its names.
fn pieces(text: &str) -> impl Iterator<Item = Piece<'_>> {
    text.split('{').enumerate().flat_map(|(i, part)| match part.split_once('}') {
        Some((name, rest)) if i > 0 => [named(name), Piece::Plain(rest)],
        _ => [Piece::Plain(part), Piece::Plain("")],
    })
}

fn named(text: &str) -> Piece<'_> {
    let words = text.split_once('|').and_then(|(name, rest)| Some((name, rest.split_once('|')?)));
    match words {
        Some((name, (one, many))) => Piece::Words { name, one, many },
        None => Piece::Name(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the names of a template's values, in the order of the text.
    fn names(text: &'static str) -> Vec<&'static str> {
        let name = |piece| if let Piece::Name(name) = piece { Some(name) } else { None };
        pieces(text).filter_map(name).collect()
    }

    #[test]
    fn numbers_are_short() {
        let text = |x| number(x, Language::English);
        let all = [0.0, -0.0001, 0.5, -2.0, 1.0 / 3.0, 1e9, 2e-5, 100.0, f64::NEG_INFINITY];
        let texts = ["0", "−1.00e−4", "0.5", "−2", "0.333", "1.00e9", "2.00e−5", "100", "−∞"];
        assert_eq!(all.map(text), texts);
        assert_eq!(number(f64::NAN, Language::German), "NaN");
        assert_eq!(number(-0.0, Language::German), "0");
    }

    #[test]
    fn captions_are_filled_in_every_language() {
        static CUT: Template =
            Template::new("cut", "{end} moves to {p}.", "{end} wandert nach {p}.");
        let end = Word::new("The start", "Der Anfang");
        let mut caption = CUT.with([("end", end.into()), ("p", DVec2::new(1.5, -2.0).into())]);
        assert_eq!(caption.text(Language::English), "The start moves to (1.5, −2).");
        assert_eq!(caption.text(Language::German), "Der Anfang wandert nach (1,5; −2).");
        assert_eq!(
            Value::from(DVec3::new(0.5, -6e-14, 1e-4)).text(Language::English),
            "(0.5, 0, 1.00e−4)"
        );
        caption.values.pop();
        assert_eq!(caption.text(Language::English), "The start moves to {p}.");
        assert_eq!(names(CUT.text.en), ["end", "p"]);
    }

    #[test]
    fn words_agree_with_numbers() {
        static LEFT: Template = Template::new(
            "left",
            "{count} {count|vertex is|vertices are} left.",
            "{count} {count|Ecke bleibt|Ecken bleiben}.",
        );
        let text = |count: usize, language| LEFT.with([("count", count.into())]).text(language);
        assert_eq!(text(1, Language::English), "1 vertex is left.");
        assert_eq!(text(0, Language::English), "0 vertices are left.");
        assert_eq!(text(1, Language::German), "1 Ecke bleibt.");
        assert_eq!(text(5, Language::German), "5 Ecken bleiben.");
        assert_eq!(names(LEFT.text.en), ["count"]);
    }
}
