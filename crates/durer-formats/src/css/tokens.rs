//! Tokens of CSS.
//!
//! Source: *CSS Syntax Module Level 3*, W3C, § 4. Any text can be tokenized; other characters are delimiters of one
//! character.

use std::borrow::Cow;

/// A token; comments are not tokens.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Token<'a> {
    Ident(Cow<'a, str>),
    /// A name and the parenthesis after it.
    Function(Cow<'a, str>),
    At(Cow<'a, str>),
    /// `#` and a name.
    Hash(Cow<'a, str>),
    String(Cow<'a, str>),
    /// `url(` and an address without quotes.
    Url(Cow<'a, str>),
    Number(f64),
    Percent(f64),
    Dimension(f64, Cow<'a, str>),
    Blank,
    /// `(`, `[` or `{`.
    Open(char),
    /// `)`, `]` or `}`.
    Close(char),
    Other(char),
}

impl Token<'_> {
    /// Returns whether this is that word, in letters of any case.
    pub fn is_word(&self, word: &str) -> bool {
        matches!(self, Self::Ident(name) if name.eq_ignore_ascii_case(word))
    }

    /// Returns the character that closes the group that this token opens.
    fn closing(&self) -> Option<char> {
        match self {
            Self::Function(_) | Self::Open('(') => Some(')'),
            Self::Open('[') => Some(']'),
            Self::Open(_) => Some('}'),
            _ => None,
        }
    }
}

/// A token and its place.
#[derive(Debug, Clone)]
pub(crate) struct Piece<'a> {
    pub token: Token<'a>,
    /// Byte offsets of the token's start and end.
    pub start: usize,
    pub end: usize,
    /// Index of the closing token for an opening one, or the number of tokens if none closes it; for other
    /// tokens their own index.
    pub mate: usize,
}

/// Returns the tokens of a text, in order. Cost: linear in its length.
pub(crate) fn tokens(text: &str) -> Vec<Piece<'_>> {
    let mut lexer = Lexer { text, at: 0 };
    let mut pieces: Vec<Piece<'_>> = Vec::new();
    let mut open: Vec<(usize, char)> = Vec::new();
    // Number of open brackets of each kind, so that closing ones without a partner are not searched.
    let mut waiting = [0_usize; 3];
    while lexer.at < text.len() {
        let start = lexer.at;
        let Some(token) = lexer.token() else { continue };
        let index = pieces.len();
        if let Token::Close(closing) = token
            && waiting[kind_of(closing)] > 0
        {
            // Inner brackets still open end here too.
            while let Some((opened, wanted)) = open.pop() {
                waiting[kind_of(wanted)] -= 1;
                if let Some(piece) = pieces.get_mut(opened) {
                    piece.mate = index;
                }
                if wanted == closing {
                    break;
                }
            }
        }
        if let Some(closing) = token.closing() {
            open.push((index, closing));
            waiting[kind_of(closing)] += 1;
        }
        pieces.push(Piece { token, start, end: lexer.at, mate: index });
    }
    let count = pieces.len();
    for (opened, _) in open {
        if let Some(piece) = pieces.get_mut(opened) {
            piece.mate = count;
        }
    }
    pieces
}

fn kind_of(closing: char) -> usize {
    match closing {
        ')' => 0,
        ']' => 1,
        _ => 2,
    }
}

struct Lexer<'a> {
    text: &'a str,
    /// Index of the next byte.
    at: usize,
}

fn is_name_start(c: char) -> bool {
    c.is_ascii_alphabetic() || c == '_' || !c.is_ascii()
}

fn is_name(c: char) -> bool {
    is_name_start(c) || c.is_ascii_digit() || c == '-'
}

impl<'a> Lexer<'a> {
    fn rest(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Returns the character this many bytes on, where those before it are ASCII.
    fn peek(&self, ahead: usize) -> Option<char> {
        self.rest().get(ahead..)?.chars().next()
    }

    fn skip(&mut self, fits: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let length = rest.find(|c| !fits(c)).unwrap_or(rest.len());
        self.at += length;
        rest.get(..length).unwrap_or_default()
    }

    /// Returns the next token; `None` for a comment.
    fn token(&mut self) -> Option<Token<'a>> {
        let rest = self.rest();
        let first = rest.chars().next()?;
        if rest.starts_with("/*") {
            self.at += rest.get(2..)?.find("*/").map_or(rest.len(), |end| end + 4);
            return None;
        }
        if first.is_ascii_whitespace() {
            self.skip(|c| c.is_ascii_whitespace());
            return Some(Token::Blank);
        }
        if self.is_number(0) {
            return Some(self.number());
        }
        if self.is_ident(0) {
            return Some(self.word());
        }
        self.at += first.len_utf8();
        Some(match first {
            '"' | '\'' => self.string(first),
            '#' if self.peek(0).is_some_and(|c| is_name(c) || c == '\\') => {
                Token::Hash(self.name())
            }
            '@' if self.is_ident(0) => Token::At(self.name()),
            '(' | '[' | '{' => Token::Open(first),
            ')' | ']' | '}' => Token::Close(first),
            other => Token::Other(other),
        })
    }

    /// Returns whether a number begins at this offset.
    fn is_number(&self, ahead: usize) -> bool {
        let digit = |at| self.peek(at).is_some_and(|c: char| c.is_ascii_digit());
        match self.peek(ahead) {
            Some('+' | '-') => {
                digit(ahead + 1) || (self.peek(ahead + 1) == Some('.') && digit(ahead + 2))
            }
            Some('.') => digit(ahead + 1),
            _ => digit(ahead),
        }
    }

    /// Returns whether a name begins at this offset.
    fn is_ident(&self, ahead: usize) -> bool {
        let starts = |at| match self.peek(at) {
            Some('\\') => self.peek(at + 1).is_some_and(|c| c != '\n'),
            other => other.is_some_and(is_name_start),
        };
        starts(ahead)
            || self.peek(ahead) == Some('-')
                && (self.peek(ahead + 1) == Some('-') || starts(ahead + 1))
    }

    fn number(&mut self) -> Token<'a> {
        let start = self.at;
        self.at += usize::from(matches!(self.peek(0), Some('+' | '-')));
        self.skip(|c| c.is_ascii_digit());
        if self.peek(0) == Some('.') && self.peek(1).is_some_and(|c| c.is_ascii_digit()) {
            self.at += 1;
            self.skip(|c| c.is_ascii_digit());
        }
        let sign = usize::from(matches!(self.peek(1), Some('+' | '-')));
        if matches!(self.peek(0), Some('e' | 'E'))
            && self.peek(1 + sign).is_some_and(|c| c.is_ascii_digit())
        {
            self.at += 1 + sign;
            self.skip(|c| c.is_ascii_digit());
        }
        let value = self.text.get(start..self.at).and_then(|n| n.parse().ok()).unwrap_or(0.0);
        if self.peek(0) == Some('%') {
            self.at += 1;
            Token::Percent(value)
        } else if self.is_ident(0) {
            Token::Dimension(value, self.name())
        } else {
            Token::Number(value)
        }
    }

    /// Returns a name, or the function or address that it begins.
    fn word(&mut self) -> Token<'a> {
        let name = self.name();
        if self.peek(0) != Some('(') {
            return Token::Ident(name);
        }
        self.at += 1;
        if !name.eq_ignore_ascii_case("url") {
            return Token::Function(name);
        }
        let rest = self.rest();
        let inside = rest.trim_start();
        if inside.starts_with(['"', '\'']) {
            return Token::Function(name);
        }
        let end = rest.find(')').unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        Token::Url(Cow::Borrowed(rest.get(..end).unwrap_or_default().trim()))
    }

    /// Returns the name that begins here.
    fn name(&mut self) -> Cow<'a, str> {
        let plain = self.skip(is_name);
        if self.peek(0) != Some('\\') {
            return Cow::Borrowed(plain);
        }
        let mut name = plain.to_owned();
        while self.peek(0) == Some('\\') {
            self.at += 1;
            name.extend(self.escaped());
            name.push_str(self.skip(is_name));
        }
        Cow::Owned(name)
    }

    /// Returns the character behind a backslash.
    fn escaped(&mut self) -> Option<char> {
        let rest = self.rest();
        let digits = rest.bytes().take(6).take_while(u8::is_ascii_hexdigit).count();
        if digits == 0 {
            let c = rest.chars().next()?;
            self.at += c.len_utf8();
            return Some(c);
        }
        self.at += digits;
        let code = u32::from_str_radix(rest.get(..digits)?, 16).unwrap_or(0);
        self.at += usize::from(self.peek(0).is_some_and(|c| c.is_ascii_whitespace()));
        Some(char::from_u32(code).filter(|c| *c != '\0').unwrap_or(char::REPLACEMENT_CHARACTER))
    }

    /// Returns the text up to the quote, or to the end of the line.
    fn string(&mut self, quote: char) -> Token<'a> {
        let plain = self.skip(|c| c != quote && c != '\\' && c != '\n');
        let mut text = Cow::Borrowed(plain);
        while self.peek(0) == Some('\\') {
            self.at += 1;
            // An escaped line end continues the line.
            if self.peek(0) == Some('\n') {
                self.at += 1;
            } else {
                text.to_mut().extend(self.escaped());
            }
            let more = self.skip(|c| c != quote && c != '\\' && c != '\n');
            text.to_mut().push_str(more);
        }
        self.at += usize::from(self.peek(0) == Some(quote));
        Token::String(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<Token<'_>> {
        tokens(text).into_iter().map(|piece| piece.token).collect()
    }

    #[test]
    fn tokens_are_those_of_the_standard() {
        use Token::*;
        let name = Cow::Borrowed;
        assert_eq!(
            kinds("a:b(-1.5e1px 50%)/* x */#c@d"),
            [
                Ident(name("a")),
                Other(':'),
                Function(name("b")),
                Dimension(-15.0, name("px")),
                Blank,
                Percent(50.0),
                Close(')'),
                Hash(name("c")),
                At(name("d"))
            ]
        );
        assert_eq!(kinds("url( a b )"), [Url(name("a b"))]);
        assert_eq!(kinds("url('a')"), [Function(name("url")), String(name("a")), Close(')')]);
        assert_eq!(kinds("--x\\31 2"), [Ident(name("--x12"))]);
        assert_eq!(kinds("'a\\\nb\\'c'"), [String(name("ab'c"))]);
        assert_eq!(kinds("+.5-x"), [Dimension(0.5, name("-x"))]);
        assert_eq!(kinds("1e3 2em"), [Number(1000.0), Blank, Dimension(2.0, name("em"))]);
    }

    #[test]
    fn what_opens_knows_what_closes_it() {
        let mates = |text| tokens(text).iter().map(|piece| piece.mate).collect::<Vec<_>>();
        assert_eq!(mates("{(]}x"), [3, 3, 2, 3, 4]);
        assert_eq!(mates("f(("), [2, 2]);
    }

    #[test]
    fn no_text_is_without_tokens() {
        for text in ["\\", "/*", "'", "\u{e9}\\", "url(", "#", "@", "-", "\\\n", "1e", "1.", "💠--"]
        {
            let found = tokens(text);
            let ends = found.windows(2).all(|pair| pair[0].end <= pair[1].start);
            assert!(ends && found.last().is_none_or(|last| last.end <= text.len()), "{text}");
        }
    }
}
