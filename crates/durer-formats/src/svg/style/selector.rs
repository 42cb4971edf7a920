//! Selectors of style rules.
//!
//! Source: *Selectors Level 4*, W3C.

use crate::css::{Piece, Token, split};

/// Selectors within `:not()` and `:is()` may be so deep.
const MAX_DEPTH: u32 = 8;

/// Pseudo-classes and pseudo-elements that no element of a still picture has.
const NEVER: [&str; 24] = [
    "active",
    "after",
    "autofill",
    "backdrop",
    "before",
    "checked",
    "current",
    "disabled",
    "first-letter",
    "first-line",
    "focus",
    "focus-visible",
    "focus-within",
    "fullscreen",
    "future",
    "highlight",
    "hover",
    "marker",
    "past",
    "placeholder",
    "playing",
    "selection",
    "target",
    "visited",
];

/// Relation of an element to the one that the next part describes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Combinator {
    Descendant,
    Child,
    NextSibling,
    LaterSibling,
}

/// Condition on an element.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Simple {
    Type(String),
    Id(String),
    Class(String),
    Attribute {
        name: String,
        test: Test,
        ignore_case: bool,
    },
    /// The element is the `a`·n + `b`-th among its siblings, for some n from 0 on.
    Nth {
        a: i64,
        b: i64,
        from_end: bool,
        of_type: bool,
    },
    Root,
    Empty,
    Link,
    Lang(String),
    Not(Vec<Selector>),
    Is(Vec<Selector>),
    Never,
}

/// Condition on an attribute's value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Test {
    Present,
    Equals(String),
    /// One of the words.
    Includes(String),
    /// The value or its beginning before a `-`.
    Dash(String),
    Starts(String),
    Ends(String),
    Contains(String),
}

/// Conditions on one element, all of which must hold.
pub(super) type Compound = Vec<Simple>;

/// Specificity of a selector: its numbers of ids, classes and types, which order rules.
pub(super) type Specificity = [u32; 3];

/// An element, and its surroundings.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Selector {
    /// Conditions on the element itself.
    pub last: Compound,
    /// Conditions on elements before it, from the nearest on, each with its relation to the element
    /// after it.
    pub before: Vec<(Combinator, Compound)>,
    pub specificity: Specificity,
}

/// Returns the selectors of a list; `None` if one is not understood, as then none counts.
pub(super) fn list(pieces: &[Piece<'_>]) -> Option<Vec<Selector>> {
    list_at(pieces, 0)
}

fn list_at(pieces: &[Piece<'_>], depth: u32) -> Option<Vec<Selector>> {
    if depth > MAX_DEPTH {
        return None;
    }
    split(pieces, ',')
        .into_iter()
        .map(|part| Parser { pieces: part, at: 0, depth }.selector())
        .collect()
}

struct Parser<'a, 'b> {
    pieces: &'b [Piece<'a>],
    at: usize,
    depth: u32,
}

impl<'a, 'b> Parser<'a, 'b> {
    fn peek(&self) -> Option<&'b Token<'a>> {
        self.pieces.get(self.at).map(|piece| &piece.token)
    }

    fn next(&mut self) -> Option<&'b Token<'a>> {
        let token = self.peek();
        self.at += 1;
        token
    }

    fn selector(mut self) -> Option<Selector> {
        let mut specificity = [0; 3];
        let mut parts = vec![self.compound(&mut specificity)?];
        let mut combinators = Vec::new();
        while self.at < self.pieces.len() {
            combinators.push(self.combinator()?);
            parts.push(self.compound(&mut specificity)?);
        }
        let last = parts.pop()?;
        let before = combinators.into_iter().zip(parts).rev().collect();
        Some(Selector { last, before, specificity })
    }

    fn combinator(&mut self) -> Option<Combinator> {
        let mut found = None;
        loop {
            let next = match self.peek() {
                Some(Token::Blank) => Combinator::Descendant,
                Some(Token::Other('>')) => Combinator::Child,
                Some(Token::Other('+')) => Combinator::NextSibling,
                Some(Token::Other('~')) => Combinator::LaterSibling,
                _ => return found,
            };
            self.at += 1;
            found = match (found, next) {
                (None | Some(Combinator::Descendant), next) => Some(next),
                (found, Combinator::Descendant) => found,
                _ => return None,
            };
        }
    }

    fn compound(&mut self, specificity: &mut Specificity) -> Option<Compound> {
        let mut compound = Vec::new();
        let start = self.at;
        if let Some(name) = self.type_name()? {
            specificity[2] += 1;
            compound.push(Simple::Type(name));
        }
        while let Some(token) = self.peek() {
            let (simple, place) = match token {
                Token::Hash(name) => (Simple::Id(name.to_string()), 0),
                Token::Other('.') => {
                    self.at += 1;
                    let Some(Token::Ident(name)) = self.peek() else { return None };
                    (Simple::Class(name.to_string()), 1)
                }
                Token::Open('[') => (self.attribute()?, 1),
                Token::Other(':') => {
                    compound.push(self.pseudo(specificity)?);
                    continue;
                }
                _ => break,
            };
            self.at += 1;
            specificity[place] += 1;
            compound.push(simple);
        }
        (self.at > start).then_some(compound)
    }

    /// Returns the name of a type, if there is one; `*` matches all, and prefixes of namespaces are skipped.
    fn type_name(&mut self) -> Option<Option<String>> {
        let mut name = None;
        loop {
            match self.peek() {
                Some(Token::Ident(word)) => name = Some(word.to_string()),
                Some(Token::Other('*')) => name = None,
                _ => return Some(name),
            }
            self.at += 1;
            let next = self.pieces.get(self.at + 1).map(|piece| &piece.token);
            if self.peek() != Some(&Token::Other('|')) || next == Some(&Token::Other('=')) {
                return Some(name);
            }
            self.at += 1;
        }
    }

    /// Parses the content of brackets; ends before the closing one.
    fn attribute(&mut self) -> Option<Simple> {
        self.at += 1;
        self.skip_blanks();
        let mut name = self.type_name()??;
        // Prefixes as of `xlink|href` have been passed over.
        if let Some(local) = name.rsplit(':').next() {
            name = local.to_owned();
        }
        self.skip_blanks();
        let operator = match self.peek()? {
            Token::Close(']') => {
                return Some(Simple::Attribute { name, test: Test::Present, ignore_case: false });
            }
            Token::Other(c) => *c,
            _ => return None,
        };
        self.at += 1;
        if operator != '=' && self.next() != Some(&Token::Other('=')) {
            return None;
        }
        self.skip_blanks();
        let value = match self.next()? {
            Token::Ident(value) | Token::String(value) => value.to_string(),
            _ => return None,
        };
        self.skip_blanks();
        let mut ignore_case = false;
        if let Some(Token::Ident(flag)) = self.peek() {
            ignore_case = flag.eq_ignore_ascii_case("i");
            self.at += 1;
            self.skip_blanks();
        }
        let test = match operator {
            '=' => Test::Equals(value),
            '~' => Test::Includes(value),
            '|' => Test::Dash(value),
            '^' => Test::Starts(value),
            '$' => Test::Ends(value),
            '*' => Test::Contains(value),
            _ => return None,
        };
        (self.peek() == Some(&Token::Close(']'))).then_some(Simple::Attribute {
            name,
            test,
            ignore_case,
        })
    }

    fn skip_blanks(&mut self) {
        while self.peek() == Some(&Token::Blank) {
            self.at += 1;
        }
    }

    /// Parses a pseudo-class or pseudo-element, to its end.
    fn pseudo(&mut self, specificity: &mut Specificity) -> Option<Simple> {
        self.at += 1;
        let is_element = self.peek() == Some(&Token::Other(':'));
        self.at += usize::from(is_element);
        match self.next()? {
            Token::Ident(name) => {
                specificity[if is_element { 2 } else { 1 }] += 1;
                pseudo_class(&name.to_ascii_lowercase())
            }
            Token::Function(name) => {
                let start = self.at;
                let mut open = 1;
                while open > 0 {
                    match self.next()? {
                        Token::Open(_) | Token::Function(_) => open += 1,
                        Token::Close(_) => open -= 1,
                        _ => {}
                    }
                }
                let inside = self.pieces.get(start..self.at - 1)?;
                self.pseudo_function(&name.to_ascii_lowercase(), inside, specificity)
            }
            _ => None,
        }
    }

    fn pseudo_function(
        &self,
        name: &str,
        inside: &[Piece<'_>],
        specificity: &mut Specificity,
    ) -> Option<Simple> {
        let selectors = || list_at(inside, self.depth + 1);
        let nth = |from_end, of_type| {
            let (a, b) = nth(inside)?;
            Some(Simple::Nth { a, b, from_end, of_type })
        };
        match name {
            "not" | "is" | "matches" | "where" | "-webkit-any" => {
                let selectors = selectors()?;
                let most = selectors.iter().map(|s| s.specificity).max()?;
                if name != "where" {
                    specificity.iter_mut().zip(most).for_each(|(sum, more)| *sum += more);
                }
                return Some(if name == "not" {
                    Simple::Not(selectors)
                } else {
                    Simple::Is(selectors)
                });
            }
            _ => specificity[1] += 1,
        }
        match name {
            "nth-child" => nth(false, false),
            "nth-last-child" => nth(true, false),
            "nth-of-type" => nth(false, true),
            "nth-last-of-type" => nth(true, true),
            "lang" => match inside {
                [Piece { token: Token::Ident(name) | Token::String(name), .. }] => {
                    Some(Simple::Lang(name.to_ascii_lowercase()))
                }
                _ => None,
            },
            _ => None,
        }
    }
}

fn pseudo_class(name: &str) -> Option<Simple> {
    let nth = |from_end, of_type| Some(Simple::Nth { a: 0, b: 1, from_end, of_type });
    let only = |of_type| {
        let both =
            [false, true].map(|from_end| Simple::Nth { a: 0, b: 1, from_end, of_type }).to_vec();
        Some(Simple::Is(vec![Selector { last: both, before: Vec::new(), specificity: [0; 3] }]))
    };
    match name {
        "first-child" => nth(false, false),
        "last-child" => nth(true, false),
        "first-of-type" => nth(false, true),
        "last-of-type" => nth(true, true),
        "only-child" => only(false),
        "only-of-type" => only(true),
        "root" | "scope" => Some(Simple::Root),
        "empty" => Some(Simple::Empty),
        "link" | "any-link" => Some(Simple::Link),
        name if NEVER.contains(&name)
            || name.starts_with("-webkit-")
            || name.starts_with("-moz-") =>
        {
            Some(Simple::Never)
        }
        _ => None,
    }
}

/// Returns the numbers of `an+b`.
fn nth(pieces: &[Piece<'_>]) -> Option<(i64, i64)> {
    let mut text = String::new();
    for piece in pieces {
        match &piece.token {
            Token::Ident(word) => text.push_str(word),
            Token::Number(v) if *v >= 0.0 && piece.end - piece.start > format!("{v}").len() => {
                text.push_str(&format!("+{v}"));
            }
            Token::Number(v) => text.push_str(&format!("{v}")),
            Token::Dimension(v, unit) => text.push_str(&format!("{v}{unit}")),
            Token::Other(c) => text.push(*c),
            Token::Blank => {}
            _ => return None,
        }
    }
    let text = text.to_ascii_lowercase();
    match text.as_str() {
        "odd" => return Some((2, 1)),
        "even" => return Some((2, 0)),
        _ => {}
    }
    let Some((a, b)) = text.split_once('n') else { return Some((0, text.parse().ok()?)) };
    let a = match a {
        "" | "+" => 1,
        "-" => -1,
        a => a.parse().ok()?,
    };
    let b = if b.is_empty() { 0 } else { b.parse().ok()? };
    Some((a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::css::tokens;

    fn of(text: &str) -> Option<Vec<Selector>> {
        list(&tokens(text))
    }

    #[test]
    fn specificity_counts_ids_classes_and_types() {
        for (text, expected) in [
            ("*", [0, 0, 0]),
            ("svg|rect.a.b#c", [1, 2, 1]),
            ("g > rect ~ .x[data-y='1']:first-child", [0, 3, 2]),
            ("a:not(.b, #c)", [1, 0, 1]),
            ("a:where(#b) + c::before", [0, 0, 3]),
            (":is(rect, .a):nth-child(2n + 1)", [0, 2, 0]),
        ] {
            let found = of(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(found[0].specificity, expected, "{text}");
        }
        assert_eq!(of("a, b").unwrap().len(), 2);
    }

    #[test]
    fn steps_are_read_with_and_without_blanks() {
        for (text, expected) in [
            ("2n+1", (2, 1)),
            ("2n + 1", (2, 1)),
            ("-n+3", (-1, 3)),
            ("n", (1, 0)),
            ("+3", (0, 3)),
            ("5", (0, 5)),
            ("odd", (2, 1)),
            ("-2n-1", (-2, -1)),
            ("3n - 2", (3, -2)),
        ] {
            assert_eq!(nth(&tokens(text)), Some(expected), "{text}");
        }
        assert_eq!(nth(&tokens("x")), None);
    }

    #[test]
    fn what_is_no_selector() {
        for text in
            ["", "a,", "> a", "a >", "a > > b", ".", "a:has(b)", "[", "[a=]", "a:x", ":not()", "a{"]
        {
            assert_eq!(of(text), None, "{text}");
        }
        assert_eq!(of(&":not(".repeat(1000)), None);
    }
}
