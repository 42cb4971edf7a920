//! The conditions of `@media`.
//!
//! Source: *Media Queries Level 4*, W3C. Answered as for a light screen that is as large as the drawing.

use crate::css::{Piece, Token, Units, split, words};

/// Screen that the drawing is seen on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Screen {
    /// Width in pixels.
    pub width: f64,
    pub height: f64,
}

impl Default for Screen {
    fn default() -> Self {
        Self { width: 100.0, height: 100.0 }
    }
}

impl Screen {
    /// Returns whether one of the queries holds.
    ///
    /// # Errors
    /// If none holds and one is not understood.
    pub fn matches(&self, queries: &[Piece<'_>]) -> Result<bool, ()> {
        let mut is_unknown = false;
        for query in split(queries, ',') {
            match self.query(query) {
                Some(true) => return Ok(true),
                Some(false) => {}
                None => is_unknown = true,
            }
        }
        if is_unknown { Err(()) } else { Ok(false) }
    }

    /// Returns whether a query holds: a medium and features, joined by `and`.
    fn query(&self, query: &[Piece<'_>]) -> Option<bool> {
        let (mut holds, mut is_not) = (true, false);
        for (i, part) in words(query).into_iter().enumerate() {
            let [first, rest @ ..] = part else { return None };
            holds &= match &first.token {
                Token::Ident(word) => match word.to_ascii_lowercase().as_str() {
                    "not" if i == 0 => {
                        is_not = true;
                        true
                    }
                    "only" | "and" | "all" | "screen" => true,
                    "print" | "speech" | "tty" | "tv" | "projection" | "handheld" | "braille"
                    | "embossed" | "aural" => false,
                    _ => return None,
                },
                Token::Open('(') => self.feature(rest)?,
                _ => return None,
            };
        }
        Some(holds != is_not)
    }

    /// Returns whether the condition in parentheses holds.
    fn feature(&self, inside: &[Piece<'_>]) -> Option<bool> {
        let inside = inside.split_last().map_or(inside, |(_, rest)| rest);
        let parts = split(inside, ':');
        let name = |part: &[Piece<'_>]| match part {
            [Piece { token: Token::Ident(name), .. }] => Some(name.to_ascii_lowercase()),
            _ => None,
        };
        let feature = name(parts.first()?)?;
        let Some(value) = parts.get(1) else {
            return match feature.as_str() {
                "width" | "height" | "color" | "color-gamut" => Some(true),
                "monochrome" | "grid" | "hover" | "pointer" => Some(false),
                _ => None,
            };
        };
        let length = || Units::default().value(value, None).and_then(|v| v.length());
        Some(match feature.as_str() {
            "min-width" => self.width >= length()?,
            "max-width" => self.width <= length()?,
            "width" => self.width == length()?,
            "min-height" => self.height >= length()?,
            "max-height" => self.height <= length()?,
            "height" => self.height == length()?,
            "orientation" => (self.height >= self.width) == (name(value)? == "portrait"),
            "prefers-color-scheme" => name(value)? == "light",
            "prefers-reduced-motion" | "prefers-contrast" | "prefers-reduced-transparency" => {
                name(value)? == "no-preference"
            }
            "forced-colors" | "inverted-colors" => name(value)? == "none",
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::css::tokens;

    #[test]
    fn queries_hold_on_a_light_screen() {
        let screen = Screen { width: 300.0, height: 150.0 };
        let matches = |text| screen.matches(&tokens(text));
        for (text, expected) in [
            ("screen", Ok(true)),
            ("print", Ok(false)),
            ("print, all", Ok(true)),
            ("only screen and (min-width: 200px)", Ok(true)),
            ("(max-width:299px)", Ok(false)),
            ("not print", Ok(true)),
            ("not all and (orientation: landscape)", Ok(false)),
            ("(prefers-color-scheme: dark)", Ok(false)),
            ("(prefers-color-scheme: light)", Ok(true)),
            ("(width > 5px)", Err(())),
            ("(a", Err(())),
            ("screen, nonsense", Ok(true)),
        ] {
            assert_eq!(matches(text), expected, "{text}");
        }
    }
}
