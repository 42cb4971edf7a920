//! A drawing's document, rewritten with other attributes.

use super::letters::Letters;
use super::outline::Changed;
use std::borrow::Cow;
use std::cell::Cell;
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node, NodeId};

const XLINK: &str = "http://www.w3.org/1999/xlink";
const XML: &str = "http://www.w3.org/XML/1998/namespace";

/// Changes to a document.
#[derive(Debug, Default)]
pub(super) struct Changes<'a> {
    /// All attributes that elements have now, by qualified name.
    pub attributes: Changed<'a>,
    /// Elements of definitions to be added at the end.
    pub definitions: String,
    /// Number of elements examined to find boxes.
    pub looked: Cell<u32>,
    /// Elements that become groups, and the contents of the groups.
    pub groups: HashMap<NodeId, String>,
    /// Elements whose letters are not set as they are written.
    pub letters: HashMap<NodeId, Letters>,
}

impl Changes<'_> {
    pub fn is_empty(&self) -> bool {
        self.attributes.is_empty()
            && self.definitions.is_empty()
            && self.letters.is_empty()
            && self.groups.is_empty()
    }
}

/// A rewritten document, or a part of one.
#[derive(Debug, Default)]
pub(super) struct Written {
    pub text: String,
    /// Place of each element's original in the old document, in order.
    pub places: Vec<usize>,
}

/// Returns the attributes of an element that count, by qualified name.
pub(super) fn attributes<'a>(
    node: Node<'a, '_>,
) -> impl Iterator<Item = (Cow<'a, str>, Cow<'a, str>)> {
    node.attributes().filter_map(|attribute| {
        let name = match attribute.namespace() {
            None => Cow::Borrowed(attribute.name()),
            Some(XLINK) if attribute.name() == "href" => Cow::Borrowed("xlink:href"),
            Some(XML) => Cow::Owned(format!("xml:{}", attribute.name())),
            Some(_) => return None,
        };
        Some((name, Cow::Borrowed(attribute.value())))
    })
}

/// Returns whether an element is one of SVG.
pub(super) fn is_of_svg(node: &Node<'_, '_>) -> bool {
    node.tag_name().namespace().is_none_or(|space| space == super::ROOT.0)
}

/// Writes a document with changes. Comments, style sheets and elements outside SVG are left out.
pub(super) fn document(document: &Document<'_>, changes: &Changes<'_>) -> Written {
    let mut out =
        Written { text: String::with_capacity(document.input_text().len()), places: Vec::new() };
    element(document.root_element(), changes, &mut out);
    out
}

/// Writes an element and its content.
pub(super) fn element(root: Node<'_, '_>, changes: &Changes<'_>, out: &mut Written) {
    // Without recursion: elements may be very deep in one another.
    let mut next = Some(root);
    while let Some(node) = next {
        let is_open = open(node, changes, out);
        let child = if is_open { node.first_child() } else { None };
        next = child.or_else(|| {
            let mut at = node;
            loop {
                if is_written(at) {
                    close(at, changes, out);
                }
                if at == root {
                    return None;
                }
                if let Some(sibling) = at.next_sibling() {
                    return Some(sibling);
                }
                at = at.parent()?;
            }
        });
    }
}

fn is_written(node: Node<'_, '_>) -> bool {
    node.is_element() && is_of_svg(&node) && node.tag_name().name() != "style"
}

/// Writes a text or the beginning of an element; returns whether its content is to be written.
fn open(node: Node<'_, '_>, changes: &Changes<'_>, out: &mut Written) -> bool {
    if let Some(text) = node.text().filter(|_| node.is_text()) {
        let letters = node.parent().and_then(|parent| changes.letters.get(&parent.id()));
        escape(
            &letters.map_or(Cow::Borrowed(text), |letters| letters.set(text, beside(node))),
            false,
            &mut out.text,
        );
        return false;
    }
    if !is_written(node) {
        return false;
    }
    out.places.push(node.range().start);
    out.text.push('<');
    out.text.push_str(name_of(node, changes));
    if node == node.document().root_element() {
        out.text.push_str(&format!(" xmlns=\"{}\" xmlns:xlink=\"{XLINK}\"", super::ROOT.0));
    }
    let mut say = |name: &str, value: &str| {
        out.text.push(' ');
        out.text.push_str(name);
        out.text.push_str("=\"");
        escape(value, true, &mut out.text);
        out.text.push('"');
    };
    match changes.attributes.get(&node.id()) {
        Some(all) => all.iter().for_each(|(name, value)| say(name, value)),
        None => attributes(node).for_each(|(name, value)| say(&name, &value)),
    }
    out.text.push('>');
    let Some(inside) = changes.groups.get(&node.id()) else { return true };
    out.places.extend(std::iter::repeat_n(node.range().start, elements_in(inside)));
    out.text.push_str(inside);
    false
}

/// Returns whether there is anything before a text and after it in the same `text` element.
fn beside(node: Node<'_, '_>) -> [bool; 2] {
    let is_within = |node: &Node<'_, '_>| node.tag_name().name() != "text";
    let is_seen = |node: Node<'_, '_>| {
        node.is_element() || node.text().is_some_and(|text| !text.trim().is_empty())
    };
    let around = || node.ancestors().take_while(is_within);
    [
        around().any(|node| node.prev_sibling().is_some_and(is_seen)),
        around().any(|node| node.next_sibling().is_some_and(is_seen)),
    ]
}

/// Returns the name that an element has now.
fn name_of<'a>(node: Node<'a, '_>, changes: &Changes<'_>) -> &'a str {
    if changes.groups.contains_key(&node.id()) { "g" } else { node.tag_name().name() }
}

/// Returns the number of elements in the written text.
fn elements_in(text: &str) -> usize {
    text.matches('<').count() - text.matches("</").count()
}

fn close(node: Node<'_, '_>, changes: &Changes<'_>, out: &mut Written) {
    let root = node.document().root_element();
    if node == root && !changes.definitions.is_empty() {
        let count = elements_in(&changes.definitions) + 1;
        out.places.extend(std::iter::repeat_n(root.range().start, count));
        out.text.push_str("<defs>");
        out.text.push_str(&changes.definitions);
        out.text.push_str("</defs>");
    }
    out.text.push_str("</");
    out.text.push_str(name_of(node, changes));
    out.text.push('>');
}

/// Writes a text so that XML readers get it unchanged.
pub(super) fn escape(text: &str, is_attribute: bool, out: &mut String) {
    let special = |c: char| {
        matches!(c, '<' | '>' | '&' | '\r') || is_attribute && matches!(c, '"' | '\n' | '\t')
    };
    let mut rest = text;
    while let Some(at) = rest.find(special) {
        let (before, after) = rest.split_at(at);
        out.push_str(before);
        let mut chars = after.chars();
        match chars.next() {
            Some('<') => out.push_str("&lt;"),
            Some('>') => out.push_str("&gt;"),
            Some('&') => out.push_str("&amp;"),
            Some('"') => out.push_str("&quot;"),
            Some(c) => out.push_str(&format!("&#{};", u32::from(c))),
            None => {}
        }
        rest = chars.as_str();
    }
    out.push_str(rest);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::parse;

    fn written(text: &str) -> String {
        let old = parse(text).unwrap();
        let new = document(&old, &Changes::default());
        let again = parse(&new.text).unwrap();
        let elements: Vec<_> = again.descendants().filter(Node::is_element).collect();
        assert_eq!(elements.len(), new.places.len());
        for (element, place) in elements.iter().zip(&new.places) {
            assert!(text[*place..].contains(element.tag_name().name()));
        }
        new.text
    }

    #[test]
    fn what_is_written_reads_the_same() {
        let text = "<!DOCTYPE svg [<!ENTITY e '<g a=\"1\"/>'>]><s:svg xmlns:s='http://www.w3.org/2000/svg' xmlns:l='http://www.w3.org/1999/xlink'
            a='&lt;&quot;&#10;x'><!-- c --><s:text xml:space='preserve'> a&amp;b<![CDATA[<]]>\n</s:text><x xmlns='urn:y'><s:g/></x>&e;
            <s:style>a{}</s:style><s:use l:href='#x'/></s:svg>";
        assert_eq!(
            written(text).replace("\n            ", ""),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" a=\"&lt;&quot;&#10;x\">\
             <text xml:space=\"preserve\"> a&amp;b&lt;\n</text><g a=\"1\"></g><use xlink:href=\"#x\"></use></svg>"
        );
    }

    #[test]
    fn depth_does_no_harm() {
        let deep = format!(
            "<svg xmlns='{}'>{}{}</svg>",
            crate::svg::ROOT.0,
            "<g>".repeat(3000),
            "</g>".repeat(3000)
        );
        assert_eq!(written(&deep).matches("<g>").count(), 3000);
    }
}
