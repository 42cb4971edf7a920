//! A COLLADA document as a tree of elements, whose texts are not copied from the file.

use crate::foreign;
use crate::{Error, Place, Result, number};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::HashMap;
use std::ops::Range;

/// Memory that an element takes, at most, besides its attributes' texts.
const ELEMENT: u64 = 128;
/// Elements may be nested so deeply.
const DEPTH: usize = 10_000;

/// The elements, by number, each after the one that it is in.
#[derive(Debug, Default)]
pub(crate) struct Document<'a> {
    text: &'a str,
    elements: Vec<Element>,
    /// Names of elements and attributes, each once.
    names: Vec<String>,
    /// Numbers of elements by `id`.
    ids: HashMap<String, usize>,
}

#[derive(Debug)]
struct Element {
    name: usize,
    attributes: Vec<(usize, String)>,
    /// Range between its start and its end.
    content: Range<usize>,
    start: usize,
    first: Option<usize>,
    last: Option<usize>,
    next: Option<usize>,
}

impl<'a> Document<'a> {
    /// Reads a document of at most this many bytes of memory.
    ///
    /// # Errors
    /// XML that is not well-formed, or too large.
    pub fn parse(text: &'a str, limit: u64) -> Result<Self> {
        let mut reader = Reader::from_str(text);
        let mut document = Document { text, ..Document::default() };
        let mut names = HashMap::new();
        let mut open: Vec<usize> = Vec::new();
        let mut memory = 0u64;
        loop {
            let start = reader.buffer_position() as usize;
            let event = reader.read_event();
            let after = reader.buffer_position() as usize;
            let wrong = |message: String| Error::Decode { place: document.line(start), message };
            match event.map_err(|e| wrong(foreign::xml(&e)))? {
                Event::Start(e) => {
                    let number = document.add(&e, start..after, open.last().copied(), &mut names);
                    memory = memory.saturating_add(ELEMENT + 2 * (after - start) as u64);
                    open.push(number);
                }
                Event::Empty(e) => {
                    document.add(&e, start..after, open.last().copied(), &mut names);
                    memory = memory.saturating_add(ELEMENT + 2 * (after - start) as u64);
                }
                Event::End(_) => {
                    if let Some(element) = open.pop().and_then(|n| document.elements.get_mut(n)) {
                        element.content.end = start;
                    }
                }
                Event::Eof if open.is_empty() => return Ok(document),
                Event::Eof => {
                    let inside = open.last().map_or("", |&n| document.name(n));
                    return Err(wrong(format!("the file ends inside <{inside}>")));
                }
                _ => {}
            }
            for (what, value, limit) in [
                ("memory for elements", memory, limit),
                ("depth of elements", open.len() as u64, DEPTH as u64),
            ] {
                if value > limit {
                    return Err(Error::Limit { place: document.line(start), what, value, limit });
                }
            }
        }
    }

    fn add(
        &mut self,
        e: &BytesStart<'_>,
        span: Range<usize>,
        parent: Option<usize>,
        known: &mut HashMap<String, usize>,
    ) -> usize {
        let mut named = |name: &str, names: &mut Vec<String>| match known.get(name) {
            Some(&number) => number,
            None => {
                names.push(name.to_owned());
                known.insert(name.to_owned(), names.len() - 1);
                names.len() - 1
            }
        };
        let name = named(e.local_name().as_ref(), &mut self.names);
        let mut attributes = Vec::new();
        let number = self.elements.len();
        for a in e.attributes().with_checks(false).flatten() {
            let value = quick_xml::escape::unescape(&a.value);
            let value = value.map_or_else(|_| a.value.to_string(), |v| v.into_owned());
            if a.key.as_ref() == "id" {
                self.ids.entry(value.clone()).or_insert(number);
            }
            attributes.push((named(a.key.local_name().as_ref(), &mut self.names), value));
        }
        let content = span.end..span.end;
        let (first, last, next) = (None, None, None);
        self.elements.push(Element {
            name,
            attributes,
            content,
            start: span.start,
            first,
            last,
            next,
        });
        if let Some(parent) = parent.and_then(|p| self.elements.get_mut(p)) {
            let before = parent.last.replace(number);
            parent.first = parent.first.or(Some(number));
            if let Some(before) = before.and_then(|b| self.elements.get_mut(b)) {
                before.next = Some(number);
            }
        }
        number
    }

    /// Returns the outermost element, if there is one.
    pub fn root(&self) -> Option<usize> {
        (!self.elements.is_empty()).then_some(0)
    }

    /// Returns its name, without a prefix.
    pub fn name(&self, element: usize) -> &str {
        let name = self.elements.get(element).and_then(|e| self.names.get(e.name));
        name.map_or("", String::as_str)
    }

    /// Returns the elements right inside another, in their order.
    pub fn children(&self, element: usize) -> impl Iterator<Item = usize> + '_ {
        let first = self.elements.get(element).and_then(|e| e.first);
        std::iter::successors(first, |&n| self.elements.get(n)?.next)
    }

    /// Returns the children of one name.
    pub fn named<'s>(&'s self, element: usize, name: &'s str) -> impl Iterator<Item = usize> + 's {
        self.children(element).filter(move |&n| self.name(n) == name)
    }

    /// Returns the first at the end of a path of names.
    pub fn find(&self, element: usize, path: &[&str]) -> Option<usize> {
        path.iter().try_fold(element, |at, name| self.named(at, name).next())
    }

    /// Returns all elements inside another, at any depth, in their order.
    pub fn inside(&self, element: usize) -> impl Iterator<Item = usize> + '_ {
        // Elements are in the order of their starts.
        let end = self.elements.get(element).map_or(0, |e| e.content.end);
        let from = element + 1;
        let rest = self.elements.get(from..).unwrap_or_default();
        let within = rest.iter().take_while(move |e| e.start < end);
        within.enumerate().map(move |(i, _)| from + i)
    }

    pub fn attribute(&self, element: usize, key: &str) -> Option<&str> {
        let attributes = &self.elements.get(element)?.attributes;
        let found =
            attributes.iter().find(|(name, _)| self.names.get(*name).is_some_and(|n| n == key));
        found.map(|(_, value)| value.as_str())
    }

    /// Returns an attribute that is a whole number.
    pub fn whole(&self, element: usize, key: &str) -> Option<u64> {
        self.attribute(element, key)?.trim().parse().ok()
    }

    /// Returns the element that an attribute names by `#id`; or by the id alone, as some writers
    /// do.
    pub fn refers(&self, element: usize, key: &str) -> Option<usize> {
        self.by_id(self.attribute(element, key)?)
    }

    /// Returns the element of an id, with or without `#` before it.
    pub fn by_id(&self, id: &str) -> Option<usize> {
        self.ids.get(id.strip_prefix('#').unwrap_or(id)).copied()
    }

    /// Returns the text between its start and its end, as it is in the file.
    pub fn raw(&self, element: usize) -> &'a str {
        let content = self.elements.get(element).map(|e| e.content.clone());
        content.and_then(|c| self.text.get(c)).unwrap_or_default()
    }

    /// Returns its text, trimmed.
    pub fn text(&self, element: usize) -> String {
        let raw = self.raw(element).trim();
        let raw = raw.strip_prefix("<![CDATA[").and_then(|r| r.strip_suffix("]]>")).unwrap_or(raw);
        quick_xml::escape::unescape(raw).map_or_else(|_| raw.to_owned(), |t| t.into_owned())
    }

    /// Returns its text as numbers; `None` for each word that is not one.
    pub fn floats(&self, element: usize) -> impl Iterator<Item = Option<f64>> + use<'a> {
        self.raw(element).split_ascii_whitespace().map(float)
    }

    /// Returns its text as exactly N numbers.
    pub fn vector<const N: usize>(&self, element: usize) -> Option<[f64; N]> {
        let mut vector = [0.0; N];
        let mut floats = self.floats(element);
        for value in &mut vector {
            *value = floats.next()?.filter(|v| v.is_finite())?;
        }
        floats.next().is_none().then_some(vector)
    }

    /// Returns the place where an element begins, for messages.
    pub fn place(&self, element: usize) -> Place {
        self.line(self.elements.get(element).map_or(0, |e| e.start))
    }

    fn line(&self, byte: usize) -> Place {
        let before = self.text.as_bytes().get(..byte).unwrap_or_default();
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        Place::Line(line as u64, (byte - line_start.min(byte)) as u64 + 1)
    }
}

/// Returns a number, also one with a decimal comma, as some writers set it where their users live.
pub(super) fn float(word: &str) -> Option<f64> {
    let whole = |text: &str| {
        let (value, length) = number::float(text.as_bytes())?;
        (length == text.len()).then_some(value)
    };
    whole(word).or_else(|| whole(&word.replacen(',', ".", 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_of_elements() {
        let text = "<a>\n <b id=\"x\" n=\"3\">1 2,5 z</b><c/><p:b k=\"&lt;\"><d/></p:b>\n</a>";
        let document = Document::parse(text, 1 << 20).expect("well formed");
        let names = |e| document.children(e).map(|n| document.name(n)).collect::<Vec<_>>();
        assert_eq!((names(0), names(3)), (vec!["b", "c", "b"], vec!["d"]));
        let b = document.by_id("#x").expect("an id");
        assert_eq!((document.whole(b, "n"), document.attribute(3, "k")), (Some(3), Some("<")));
        assert_eq!(document.floats(b).collect::<Vec<_>>(), [Some(1.0), Some(2.5), None]);
        assert_eq!(document.inside(0).count(), 4);
        assert_eq!(document.inside(3).map(|n| document.name(n)).collect::<Vec<_>>(), ["d"]);
        assert_eq!(document.place(b), Place::Line(2, 2));
    }

    #[test]
    fn what_is_broken_is_reported_with_its_line() {
        let message =
            |text: &str, limit| Document::parse(text, limit).expect_err("broken").to_string();
        assert_eq!(message("<a>\n<b>", 999), "line 2, column 4: the file ends inside <b>");
        assert!(message("<a>\n</b>", 999).starts_with("line 2, column 1: "));
        assert!(message("<a><a/><a/></a>", 300).contains("above the limit of 300"));
        let deep = "<a>".repeat(20_000);
        assert!(message(&deep, u64::MAX).contains("depth of elements"));
    }
}
