//! Letters of text, changed as CSS requires.

use std::borrow::Cow;

/// Change of letters by `text-transform`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Case {
    #[default]
    AsWritten,
    Upper,
    Lower,
    /// The first letter of each word in upper case.
    Capitalized,
}

impl Case {
    /// Parses a value of `text-transform`; `None` for others.
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

/// Changes to the letters of an element.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Letters {
    pub case: Case,
    /// No ligatures are formed, because there is space between the letters.
    pub are_apart: bool,
}

impl Letters {
    /// Returns whether they stay as they are.
    pub fn are_as_written(self) -> bool {
        !self.are_apart && self.case == Case::AsWritten
    }

    /// Returns a text as it is typeset; `beside` tells whether there are texts before it and after it.
    pub fn set(self, text: &str, beside: [bool; 2]) -> Cow<'_, str> {
        let cased = match self.case {
            Case::AsWritten => Cow::Borrowed(text),
            Case::Upper => Cow::Owned(text.to_uppercase()),
            Case::Lower => Cow::Owned(text.to_lowercase()),
            Case::Capitalized => Cow::Owned(capitalized(text)),
        };
        if self.are_apart { Cow::Owned(kept_apart(&cased, beside)) } else { cased }
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

/// Character that keeps two letters from being joined. It has space of its own.
const NON_JOINER: char = '\u{200c}';

/// Share of the letter spacing that a letter gets, and that the non-joiner after it gets.
pub(super) const SHARE: f64 = 0.5;

/// Returns a text with a non-joiner after each letter that is followed by another one, so that all gaps are equal.
/// Blanks at the ends of the line and repeated blanks get none: they vanish.
fn kept_apart(text: &str, [has_before, has_after]: [bool; 2]) -> String {
    let mut out = String::with_capacity(2 * text.len());
    let mut left = text.chars().filter(|c| !c.is_whitespace()).count();
    let (mut has_begun, mut chars) = (has_before, text.chars().peekable());
    while let Some(c) = chars.next() {
        out.push(c);
        has_begun |= !c.is_whitespace();
        left -= usize::from(!c.is_whitespace());
        let is_between = match chars.peek() {
            Some(next) => (left > 0 || has_after) && !(c.is_whitespace() && next.is_whitespace()),
            None => has_after,
        };
        let is_last = left == 0 && !has_after && !c.is_whitespace();
        // Cursive scripts stay joined: Arabic and others get no letter spacing anyway.
        if is_joined(c) {
            continue;
        }
        if is_last {
            // Browsers put space after the last letter too; the very last character gets none.
            out.extend([NON_JOINER; 2]);
        } else if has_begun && is_between {
            out.push(NON_JOINER);
        }
    }
    out
}

/// Returns whether a letter by nature joins with the next one.
fn is_joined(c: char) -> bool {
    matches!(c, '\u{600}'..='\u{8ff}' | '\u{900}'..='\u{9ff}' | '\u{a00}'..='\u{a7f}' | '\u{1680}'..='\u{169f}' | '\u{1800}'..='\u{18af}' | '\u{a840}'..='\u{a87f}' | '\u{300}'..='\u{36f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_changed_and_kept_apart() {
        let of =
            |case, are_apart, text| Letters { case, are_apart }.set(text, [false; 2]).into_owned();
        assert_eq!(of(Case::Upper, false, "straße 1"), "STRASSE 1");
        assert_eq!(of(Case::Lower, false, "ÄB"), "äb");
        assert_eq!(of(Case::Capitalized, false, "it's a dog-house"), "It's A Dog-House");
        assert_eq!(
            of(Case::AsWritten, true, " fi  1 "),
            " f\u{200c}i\u{200c}  \u{200c}1\u{200c}\u{200c} "
        );
        assert_eq!(of(Case::AsWritten, true, "بت"), "بت");
        let apart = Letters { are_apart: true, ..Letters::default() };
        assert_eq!(apart.set("a ", [false, true]), "a\u{200c} \u{200c}");
        assert_eq!(apart.set(" a", [true, false]), " \u{200c}a\u{200c}\u{200c}");
    }
}
