//! Letters of text, changed as CSS asks for it.

use std::borrow::Cow;

/// How `text-transform` changes letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Case {
    #[default]
    AsWritten,
    Upper,
    Lower,
    /// The first letter of each word is large.
    Capitalized,
}

impl Case {
    /// What a value of `text-transform` asks for; `None` for others.
    pub fn of(value: &str) -> Option<Self> {
        Some(match value {
            "none" => Self::AsWritten,
            "uppercase" => Self::Upper,
            "lowercase" => Self::Lower,
            "capitalize" => Self::Capitalized,
            _ => return None,
        })
    }
}

/// What becomes of the letters of an element.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Letters {
    pub case: Case,
    /// They are not joined to ligatures, as there is space between them.
    pub are_apart: bool,
}

impl Letters {
    /// Whether they stay as they are.
    pub fn are_as_written(self) -> bool {
        !self.are_apart && self.case == Case::AsWritten
    }

    /// A text as it is to be set.
    pub fn set(self, text: &str) -> Cow<'_, str> {
        let cased = match self.case {
            Case::AsWritten => Cow::Borrowed(text),
            Case::Upper => Cow::Owned(text.to_uppercase()),
            Case::Lower => Cow::Owned(text.to_lowercase()),
            Case::Capitalized => Cow::Owned(capitalized(text)),
        };
        if self.are_apart { Cow::Owned(kept_apart(&cased)) } else { cased }
    }
}

fn capitalized(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut is_first = true;
    for c in text.chars() {
        match is_first && c.is_alphabetic() {
            true => out.extend(c.to_uppercase()),
            false => out.push(c),
        }
        is_first = !c.is_alphanumeric() && c != '\'' && c != '\u{2019}';
    }
    out
}

/// What keeps two letters from being joined.
const NON_JOINER: char = '\u{200c}';

/// A text with what keeps letters from being joined between them; not in scripts whose letters are joined by their nature.
fn kept_apart(text: &str) -> String {
    let is_apart = |c: char| c.is_alphabetic() && c < '\u{590}';
    let mut out = String::with_capacity(2 * text.len());
    let mut before = ' ';
    for c in text.chars() {
        if is_apart(before) && is_apart(c) {
            out.push(NON_JOINER);
        }
        out.push(c);
        before = c;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_changed_and_kept_apart() {
        let of = |case, are_apart, text| Letters { case, are_apart }.set(text).into_owned();
        assert_eq!(of(Case::Upper, false, "straße 1"), "STRASSE 1");
        assert_eq!(of(Case::Lower, false, "ÄB"), "äb");
        assert_eq!(of(Case::Capitalized, false, "it's a dog-house"), "It's A Dog-House");
        assert_eq!(of(Case::AsWritten, true, "fi 12 بت"), "f\u{200c}i 12 بت");
    }
}
