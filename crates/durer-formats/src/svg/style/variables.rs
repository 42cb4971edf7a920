//! Custom properties, and `var()` if they are used.
//!
//! Source: *CSS Custom Properties for Cascading Variables Module Level 1*, W3C.

use crate::css::{Token, tokens};
use std::collections::BTreeMap;

/// `var()` may lead to values with `var()` so often.
const MAX_DEPTH: u32 = 32;

/// Largest length of a value in bytes: repeated doubling would fill the memory.
const MAX_LENGTH: usize = 1 << 16;

/// The custom properties that elements have, one set within another.
#[derive(Debug, Default)]
pub(crate) struct Variables {
    sets: Vec<Set>,
    /// Number of bytes of substituted values.
    written: usize,
}

/// Cost of composing a value, beside its length.
const COST: usize = 64;

/// Largest total length of all values.
const MAX_WRITTEN: usize = 1 << 28;

#[derive(Debug)]
struct Set {
    around: Option<usize>,
    /// `None` for one whose value is none, as of a circle.
    values: BTreeMap<String, Option<String>>,
}

impl Variables {
    /// Adds the properties that an element itself declares, within those around it, and returns the number of the set.
    /// Values are as declared.
    pub fn add(&mut self, around: Option<usize>, said: BTreeMap<String, String>) -> usize {
        let mut values = BTreeMap::new();
        for name in said.keys() {
            values.insert(name.clone(), self.own(around, &said, name));
        }
        self.sets.push(Set { around, values });
        self.sets.len() - 1
    }

    /// Returns the value of one of the properties that an element says itself.
    fn own(
        &mut self,
        around: Option<usize>,
        said: &BTreeMap<String, String>,
        name: &str,
    ) -> Option<String> {
        let value = said.get(name)?;
        match value.to_ascii_lowercase().as_str() {
            "initial" => None,
            "inherit" | "unset" | "revert" | "revert-layer" => self.value(around, name),
            _ if !has_variables(value) => Some(value.clone()),
            _ => {
                let mut open = vec![name.to_owned()];
                self.replace(value, around, said, &mut open)
            }
        }
    }

    /// Returns the value of a custom property in a set or those around it.
    fn value(&self, set: Option<usize>, name: &str) -> Option<String> {
        let mut set = set;
        while let Some(found) = set.and_then(|at| self.sets.get(at)) {
            if let Some(value) = found.values.get(name) {
                return value.clone();
            }
            set = found.around;
        }
        None
    }

    /// Returns a value with its `var()` replaced; `None` if one is undefined, or replaced by too
    /// much.
    pub fn replaced(&mut self, value: &str, set: Option<usize>) -> Option<String> {
        if !has_variables(value) {
            return Some(value.to_owned());
        }
        self.replace(value, set, &BTreeMap::new(), &mut Vec::new())
    }

    /// Replaces like [`Self::replaced`]; `said` are the values that are not replaced yet, `open` the names being
    /// replaced.
    fn replace(
        &mut self,
        value: &str,
        set: Option<usize>,
        said: &BTreeMap<String, String>,
        open: &mut Vec<String>,
    ) -> Option<String> {
        if open.len() > MAX_DEPTH as usize {
            return None;
        }
        let pieces = tokens(value);
        let (mut out, mut at, mut from) = (String::new(), 0, 0);
        while let Some(piece) = pieces.get(at) {
            if !matches!(&piece.token, Token::Function(name) if name.eq_ignore_ascii_case("var")) {
                at += 1;
                continue;
            }
            out.push_str(value.get(from..piece.start)?);
            let close = piece.mate.min(pieces.len());
            let inside = pieces.get(at + 1..close)?;
            let mut words = inside.iter().filter(|piece| piece.token != Token::Blank);
            let Token::Ident(name) = &words.next()?.token else { return None };
            let comma = inside.iter().find(|piece| piece.token == Token::Other(','));
            let end = pieces.get(close).map_or(value.len(), |piece| piece.start);
            let fallback = comma.and_then(|comma| value.get(comma.end..end));
            let found = self.variable(name, set, said, open).or_else(|| {
                open.push(String::new());
                let replaced = fallback.and_then(|text| self.replace(text.trim(), set, said, open));
                open.pop();
                replaced
            });
            out.push_str(&found?);
            self.written = self.written.saturating_add(out.len() + COST);
            if out.len() > MAX_LENGTH || self.written > MAX_WRITTEN {
                return None;
            }
            at = close + 1;
            from = pieces.get(close).map_or(value.len(), |piece| piece.end);
        }
        out.push_str(value.get(from..)?);
        Some(out)
    }

    /// Returns the value of a name.
    fn variable(
        &mut self,
        name: &str,
        set: Option<usize>,
        said: &BTreeMap<String, String>,
        open: &mut Vec<String>,
    ) -> Option<String> {
        let Some(own) = said.get(name) else { return self.value(set, name) };
        if open.iter().any(|other| other == name) {
            return None;
        }
        if !has_variables(own) {
            return self.own(set, said, name);
        }
        open.push(name.to_owned());
        let value = self.replace(own, set, said, open);
        open.pop();
        value
    }
}

/// Returns whether a value contains variables to replace.
pub(super) fn has_variables(value: &str) -> bool {
    value.as_bytes().windows(4).any(|part| part.eq_ignore_ascii_case(b"var("))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(
        variables: &mut Variables,
        around: Option<usize>,
        said: &[(&str, &str)],
    ) -> Option<usize> {
        let said =
            said.iter().map(|(name, value)| (format!("--{name}"), (*value).to_owned())).collect();
        Some(variables.add(around, said))
    }

    #[test]
    fn variables_are_inherited_and_may_be_missing() {
        let mut variables = Variables::default();
        let outer = set(&mut variables, None, &[("a", "red"), ("b", "var(--a)"), ("c", "1px")]);
        let inner = set(
            &mut variables,
            outer,
            &[("a", "blue"), ("d", "calc(var(--c) + var(--e, 2px))"), ("c", "initial")],
        );
        let mut of = |text: &str, set| variables.replaced(text, set);
        assert_eq!(of("var(--a)", outer).as_deref(), Some("red"));
        assert_eq!(of("x var( --b ) y", inner).as_deref(), Some("x red y"));
        assert_eq!(of("var(--a) var(--a)", inner).as_deref(), Some("blue blue"));
        assert_eq!(of("var(--c)", inner), None);
        assert_eq!(of("var(--d)", inner), None);
        assert_eq!(of("var(--z, var(--y, rgb(1, 2, 3)))", inner).as_deref(), Some("rgb(1, 2, 3)"));
        assert_eq!(of("var(--z,)", inner).as_deref(), Some(""));
        assert_eq!(of("var(--z)", None), None);
    }

    #[test]
    fn circles_and_explosions_are_nothing() {
        let mut variables = Variables::default();
        let circle = set(
            &mut variables,
            None,
            &[("a", "var(--b)"), ("b", "var(--a)"), ("c", "var(--c, 1)"), ("d", "5")],
        );
        assert_eq!(variables.replaced("var(--a)", circle), None);
        assert_eq!(variables.replaced("var(--a, var(--d))", circle).as_deref(), Some("5"));
        let mut around = set(&mut variables, None, &[("x0", "aaaaaaaaaaaaaaaa")]);
        for i in 0..30 {
            let doubled = format!("var(--x{i}) var(--x{i})");
            around = set(&mut variables, around, &[(&format!("x{}", i + 1), &doubled)]);
        }
        assert_eq!(variables.replaced("var(--x30)", around), None);
        assert_eq!(variables.replaced(&"var(--x,".repeat(5000), None), None);
    }
}
