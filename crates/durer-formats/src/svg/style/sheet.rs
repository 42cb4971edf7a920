//! Style sheets: their rules, and the declarations in these.
//!
//! Source: *CSS Syntax Module Level 3* and *CSS Cascading and Inheritance Level 5*, W3C.

use super::media::Screen;
use super::selector::{self, Selector};
use crate::css::{Piece, Token, tokens};

/// Rules within `@media` and `@supports` may be so deep.
const MAX_DEPTH: u32 = 8;

/// A property with its value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Declaration {
    /// Name, in small letters unless it is a custom property.
    pub name: String,
    pub value: String,
    pub is_important: bool,
    /// Bytes from the start of the text to it.
    pub at: usize,
}

/// Selectors and the declarations for elements that they match.
#[derive(Debug)]
pub(super) struct Rule {
    pub selectors: Vec<Selector>,
    pub declarations: Vec<Declaration>,
}

/// Rules of a style sheet, and the parts that were not understood, by their bytes from the start of
/// the text.
#[derive(Debug, Default)]
pub(super) struct Sheet {
    pub rules: Vec<Rule>,
    pub notes: Vec<(usize, String)>,
}

/// Number of letters of an unknown text that a message quotes.
const SHOWN: usize = 40;

/// Returns the beginning of a text.
pub(crate) fn shown(text: &str) -> String {
    let text = text.trim();
    let mut shown: String = text.chars().take(SHOWN).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    shown
}

/// Returns the rules of a style sheet that hold on this screen.
pub(super) fn parse(text: &str, screen: &Screen) -> Sheet {
    let pieces = tokens(text);
    let mut reader = Reader { text, pieces: &pieces, screen, sheet: Sheet::default() };
    reader.rules(0, pieces.len(), 0);
    reader.sheet
}

/// Returns the declarations of a `style` attribute, and its faults.
pub(super) fn declarations(text: &str) -> (Vec<Declaration>, Vec<(usize, String)>) {
    let pieces = tokens(text);
    let screen = Screen::default();
    let mut reader = Reader { text, pieces: &pieces, screen: &screen, sheet: Sheet::default() };
    let found = reader.declarations(0, pieces.len());
    (found, reader.sheet.notes)
}

struct Reader<'a, 'b> {
    text: &'a str,
    pieces: &'b [Piece<'a>],
    screen: &'b Screen,
    sheet: Sheet,
}

impl Reader<'_, '_> {
    fn note(&mut self, at: usize, message: String) {
        let place = self.pieces.get(at).map_or(self.text.len(), |piece| piece.start);
        self.sheet.notes.push((place, message));
    }

    /// Returns the text from one token to before another.
    fn text(&self, from: usize, to: usize) -> &str {
        let start = self.pieces.get(from).map_or(self.text.len(), |piece| piece.start);
        let end = to.checked_sub(1).and_then(|last| self.pieces.get(last)).map_or(start, |p| p.end);
        self.text.get(start..end.max(start)).unwrap_or_default()
    }

    /// Returns the first token from `from` on, before `end`, that is one of those; blocks are
    /// stepped over.
    fn find(&self, from: usize, end: usize, wanted: &[Token<'_>]) -> usize {
        let mut at = from;
        while let Some(piece) = self.pieces.get(at).filter(|_| at < end) {
            if wanted.contains(&piece.token) {
                return at;
            }
            at = piece.mate.max(at) + 1;
        }
        end
    }

    /// Reads rules from one token to before another.
    fn rules(&mut self, from: usize, end: usize, depth: u32) {
        let mut at = from;
        while let Some(piece) = self.pieces.get(at).filter(|_| at < end) {
            match &piece.token {
                // Old browsers were to take a style sheet for a comment.
                Token::Blank | Token::Other('<' | '!' | ';') => at += 1,
                Token::Ident(word) if word == "--" => at += 2,
                Token::At(name) => at = self.at_rule(&name.to_ascii_lowercase(), at, end, depth),
                _ => {
                    let open = self.find(at, end, &[Token::Open('{')]);
                    let close = self.pieces.get(open).map_or(end, |piece| piece.mate).min(end);
                    self.rule(at, open, close);
                    at = close + 1;
                }
            }
        }
    }

    fn rule(&mut self, at: usize, open: usize, close: usize) {
        let prelude = self.pieces.get(at..open).unwrap_or_default();
        let Some(selectors) = selector::list(prelude) else {
            let message = format!(
                "the rule for `{}` is ignored: such selectors are not understood",
                shown(self.text(at, open))
            );
            return self.note(at, message);
        };
        let declarations = self.declarations(open + 1, close);
        self.sheet.rules.push(Rule { selectors, declarations });
    }

    /// Parses a rule that begins with `@`; returns where it ends.
    fn at_rule(&mut self, name: &str, at: usize, end: usize, depth: u32) -> usize {
        let open = self.find(at + 1, end, &[Token::Open('{'), Token::Other(';')]);
        let is_block = self.pieces.get(open).is_some_and(|piece| piece.token == Token::Open('{'));
        let close = if is_block { self.pieces[open].mate.min(end) } else { open };
        let prelude = self.pieces.get(at + 1..open).unwrap_or_default();
        let passed_over = |why: &str| format!("`@{name}` is ignored{why}");
        match name {
            "media" if depth < MAX_DEPTH => match self.screen.matches(prelude) {
                Ok(true) => self.rules(open + 1, close, depth + 1),
                Ok(false) => {}
                Err(()) => {
                    let query = shown(self.text(at + 1, open));
                    self.note(at, passed_over(&format!(": `{query}` is not understood")));
                }
            },
            "layer" if is_block && depth < MAX_DEPTH => {
                self.note(at, "rules of `@layer` count as if they were outside of it".to_owned());
                self.rules(open + 1, close, depth + 1);
            }
            // Browsers know nearly all that is requested.
            "supports" if is_block && depth < MAX_DEPTH => {
                let is_not = prelude
                    .iter()
                    .find(|p| p.token != Token::Blank)
                    .is_some_and(|p| p.token.is_word("not"));
                if !is_not {
                    self.rules(open + 1, close, depth + 1);
                }
            }
            "charset" | "namespace" | "keyframes" | "-webkit-keyframes" | "-moz-keyframes"
            | "page" | "property" | "layer" => {}
            "import" => self.note(at, passed_over(": style sheets of other files are not read")),
            "font-face" => self.note(at, passed_over(": fonts are those that are given")),
            _ => self.note(at, passed_over("")),
        }
        close + 1
    }

    /// Reads declarations from one token to before another.
    fn declarations(&mut self, from: usize, end: usize) -> Vec<Declaration> {
        let mut found = Vec::new();
        let mut at = from;
        while let Some(piece) = self.pieces.get(at).filter(|_| at < end) {
            if matches!(piece.token, Token::Blank | Token::Other(';')) {
                at += 1;
                continue;
            }
            let is_custom = matches!(&piece.token, Token::Ident(name) if name.starts_with("--"));
            let block = [Token::Other(';'), Token::Open('{')];
            let over = self.find(at, end, if is_custom { &block[..1] } else { &block });
            if self.pieces.get(over).is_some_and(|piece| over < end && piece.token == block[1]) {
                let within = shown(self.text(at, over));
                self.note(at, format!("the rule for `{within}` within another rule is ignored"));
                at = self.pieces.get(over).map_or(end, |piece| piece.mate).min(end) + 1;
                continue;
            }
            match self.declaration(at, over) {
                Some(declaration) => found.push(declaration),
                None => {
                    let said = shown(self.text(at, over));
                    self.note(
                        at,
                        format!(
                            "`{said}` is not a declaration, as `fill: red` is one; it is ignored"
                        ),
                    );
                }
            }
            at = over + 1;
        }
        found
    }

    /// Returns the declaration that reaches from one token to before another.
    fn declaration(&self, at: usize, over: usize) -> Option<Declaration> {
        let Token::Ident(name) = &self.pieces.get(at)?.token else { return None };
        let mut from = at + 1;
        let is_blank = |at: usize| self.pieces.get(at).is_some_and(|p| p.token == Token::Blank);
        while is_blank(from) {
            from += 1;
        }
        if from >= over || self.pieces.get(from)?.token != Token::Other(':') {
            return None;
        }
        from += 1;
        while from < over && is_blank(from) {
            from += 1;
        }
        let mut to = over;
        while to > from && is_blank(to - 1) {
            to -= 1;
        }
        let mut is_important = false;
        if to > from && self.pieces.get(to - 1)?.token.is_word("important") {
            let mut mark = to - 1;
            while mark > from && is_blank(mark - 1) {
                mark -= 1;
            }
            if mark > from && self.pieces.get(mark - 1)?.token == Token::Other('!') {
                is_important = true;
                to = mark - 1;
                while to > from && is_blank(to - 1) {
                    to -= 1;
                }
            }
        }
        let is_custom = name.starts_with("--");
        let name = if is_custom { name.to_string() } else { name.to_ascii_lowercase() };
        let value = without_comments(self.text(from, to), self.pieces.get(from..to)?);
        let at = self.pieces.get(at)?.start;
        (is_custom || !value.is_empty()).then_some(Declaration { name, value, is_important, at })
    }
}

/// Returns the text of tokens; comments between them are blanks.
fn without_comments(text: &str, pieces: &[Piece<'_>]) -> String {
    if !text.contains("/*") {
        return text.to_owned();
    }
    let start = pieces.first().map_or(0, |piece| piece.start);
    let mut out = String::with_capacity(text.len());
    let mut end = start;
    for piece in pieces {
        if piece.start > end {
            out.push(' ');
        }
        let range = piece.start.saturating_sub(start)..piece.end.saturating_sub(start);
        out.push_str(text.get(range).unwrap_or_default());
        end = piece.end;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> Vec<String> {
        let (found, _) = declarations(text);
        found
            .iter()
            .map(|d| format!("{}={}{}", d.name, d.value, if d.is_important { "!" } else { "" }))
            .collect()
    }

    #[test]
    fn declarations_are_read_as_browsers_do() {
        assert_eq!(
            said("FILL : red ;;--X: ; stroke:url(a;b)!important;x;d:path('M0 0;')"),
            ["fill=red", "--X=", "stroke=url(a;b)!", "d=path('M0 0;')"]
        );
        assert_eq!(said("a:1/* x */2;b:c ! IMPORTANT"), ["a=1 2", "b=c!"]);
        assert_eq!(said("--a:{x:y};b:2"), ["--a={x:y}", "b=2"]);
        let (_, notes) = declarations("fill red; x { y: z } stroke: blue");
        assert_eq!(notes.len(), 2, "{notes:?}");
    }

    #[test]
    fn rules_and_what_is_passed_over() {
        let sheet = parse(
            "<!-- @import url(a.css); a,b{x:1} @media print{c{x:1}} @media screen{d{x:1}}
            e:has(f){x:1} @font-face{src:url(a)} @supports (x:y){g{x:1}} h{x:1 -->",
            &Screen::default(),
        );
        assert_eq!(sheet.rules.len(), 4, "{:?}", sheet.rules);
        assert_eq!(sheet.rules[0].selectors.len(), 2);
        let notes: Vec<_> =
            sheet.notes.iter().map(|(at, message)| (*at, message.as_str())).collect();
        assert!(notes[0].0 == 5 && notes[0].1.starts_with("`@import` is ignored"), "{notes:?}");
        assert!(
            notes[1].1.contains("`e:has(f)`") && notes[2].1.contains("@font-face"),
            "{notes:?}"
        );
        assert_eq!(notes.len(), 3);
    }

    #[test]
    fn depth_is_bounded() {
        let sheet = parse(&"@media screen{".repeat(20_000), &Screen::default());
        assert!(sheet.rules.is_empty());
    }
}
