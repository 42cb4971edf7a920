//! A drawing's document in terms that usvg knows: attributes with values that it understands, in place of style sheets
//! and newer features. Unusable values give a warning with their place and are removed: then the inherited or default
//! value applies, as in CSS.

mod copies;
mod declared;
mod scope;

use super::filters;
use super::finish::{Later, Pending};
use super::letters::SHARE;
use super::lines::Lines;
use super::references::MAX_DEPTH;
use super::style::{Styles, initial, not_drawn, shown, takes};
use super::values::{Fate, Kind, can_be_drawn, is_elsewhere};
use super::write::{self, Changes, Written, attributes, is_of_svg};
use crate::{Result, Warning};
use scope::Scope;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use usvg::roxmltree::{Document, Node, NodeId};

/// Result of amending a document.
#[derive(Default)]
pub(super) struct Amended {
    /// `None` if nothing has to be other.
    pub written: Option<Written>,
    pub warnings: Vec<Warning>,
    /// Addresses of pictures, which their numbers have replaced, and where they were.
    pub pictures: Vec<(String, usize)>,
}

/// Rewrites a document in terms that usvg knows. Pictures get numbers from `first_picture` on.
///
/// # Errors
/// If there are too many style rules and elements.
pub(super) fn amended(document: &Document<'_>, first_picture: usize) -> Result<Amended> {
    let mut walk = Walk::new(document, first_picture);
    let mut stack: Vec<(NodeId, Scope)> = Vec::new();
    for node in document.descendants().filter(Node::is_element) {
        let parent = node.parent_element().map(|parent| parent.id());
        while stack.last().is_some_and(|(id, _)| Some(*id) != parent) {
            stack.pop();
        }
        if stack.len() > MAX_DEPTH {
            // Such a document is refused when its references are examined.
            return Ok(Amended::default());
        }
        let scope = stack.last().map(|(_, scope)| *scope).unwrap_or_default();
        let own = walk.element(node, scope)?;
        if own.variables.is_some() && node.tag_name().name() == "use" {
            walk.uses.push((node, own));
        }
        if node.attribute("id").is_some() {
            walk.around.insert(node.id(), scope.variables);
        }
        stack.push((node.id(), own));
    }
    walk.finish()
}

struct Walk<'a, 'i> {
    document: &'a Document<'i>,
    styles: Styles,
    ids: HashMap<&'a str, Node<'a, 'i>>,
    changes: Changes<'a>,
    pending: Vec<Pending<'a, 'i>>,
    /// Elements with `var()`.
    varied: HashSet<NodeId>,
    /// The custom properties around elements that may be referred to.
    around: HashMap<NodeId, Option<usize>>,
    /// `use` elements that have custom properties.
    uses: Vec<(Node<'a, 'i>, Scope)>,
    pictures: Vec<(String, usize)>,
    first_picture: usize,
    has_markers: bool,
    notes: Vec<(usize, String)>,
    /// Messages that were given already.
    seen: BTreeSet<String>,
}

/// Changes to attributes of an element: new values, or removal.
type Edits<'a> = Vec<(Cow<'a, str>, Option<Cow<'a, str>>)>;

impl<'a, 'i> Walk<'a, 'i> {
    fn new(document: &'a Document<'i>, first_picture: usize) -> Self {
        let mut ids = HashMap::new();
        for node in document.descendants() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        Self {
            document,
            styles: Styles::new(document),
            ids,
            changes: Changes::default(),
            pending: Vec::new(),
            varied: HashSet::new(),
            around: HashMap::new(),
            uses: Vec::new(),
            pictures: Vec::new(),
            first_picture,
            has_markers: document.descendants().any(|node| node.tag_name().name() == "marker"),
            notes: Vec::new(),
            seen: BTreeSet::new(),
        }
    }

    /// Examines an element within a scope; returns the scope of its contents.
    fn element(&mut self, node: Node<'a, 'i>, mut scope: Scope) -> Result<Scope> {
        let name = node.tag_name().name();
        if !is_of_svg(&node) || name.starts_with("animate") || name == "set" || name == "style" {
            return Ok(scope);
        }
        let has_style = node.attribute("style").is_some();
        let mut said = BTreeMap::new();
        if has_style || self.styles.has_sheets {
            said = self.styles.said(self.document, node)?;
        }
        let custom: BTreeMap<String, String> = said
            .iter()
            .filter(|(name, _)| name.starts_with("--"))
            .map(|(name, declared)| (name.clone(), declared.value.clone()))
            .collect();
        if !custom.is_empty() {
            scope.variables = Some(self.styles.variables.add(scope.variables, custom));
        }
        self.enter(node, &said, &mut scope);
        let (mut edits, mut later) = (Vec::new(), Later::default());
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let (property, value) = (attribute.name(), attribute.value());
            if property != "style" && !(said.contains_key(property) && takes(name, property)) {
                let at = attribute.range().start;
                later.note(property, value, at);
                if self.has_markers && name == "path" && property == "d" {
                    later.data = Some(value.to_owned());
                }
                self.attribute(node, property, value, at, &scope, &mut edits);
            }
        }
        if name == "image" || name == "feImage" {
            self.picture(node, &mut edits);
        }
        let mut in_style = String::new();
        for (property, declared) in &said {
            if !property.starts_with("--") && takes(name, property) {
                self.declared(
                    node,
                    property,
                    declared,
                    &scope,
                    &mut edits,
                    &mut later,
                    &mut in_style,
                );
            }
        }
        if self.changes.letters.get(&node.id()).is_some_and(|letters| letters.are_apart) {
            let share = (scope.spacing * SHARE).to_string();
            edits.push((Cow::Borrowed("letter-spacing"), Some(Cow::Owned(share))));
        }
        let has_foreign =
            node.attributes().any(|a| a.namespace().is_some_and(|space| space != super::ROOT.0));
        if has_style || !edits.is_empty() || !in_style.is_empty() {
            let mut all: Vec<_> =
                attributes(node).filter(|(name, _)| name != "style" && name != "class").collect();
            for (name, value) in edits {
                all.retain(|(own, _)| *own != name);
                all.extend(value.map(|value| (name, value)));
            }
            if !in_style.is_empty() {
                all.push((Cow::Borrowed("style"), Cow::Owned(in_style)));
            }
            self.changes.attributes.insert(node.id(), all);
        } else if has_foreign && attributes(node).count() < node.attributes().len() {
            let all = attributes(node).collect();
            self.changes.attributes.insert(node.id(), all);
        }
        let is_shape = matches!(name, "path" | "polygon" | "rect" | "circle" | "ellipse");
        later.is_marked = self.has_markers && is_shape;
        if name == "use" || !later.is_nothing() {
            self.pending.push(Pending { node, around: scope.around, later });
        }
        Ok(scope)
    }

    /// Puts a number in the place of the address of a picture.
    fn picture(&mut self, node: Node<'a, 'i>, edits: &mut Edits<'a>) {
        let links = || node.attributes().filter(|a| a.name() == "href");
        let link = links()
            .find(|a| a.namespace().is_none())
            .or_else(|| links().find(|a| a.namespace() == Some("http://www.w3.org/1999/xlink")));
        let Some(link) = link.filter(|link| !link.value().starts_with('#')) else { return };
        let key =
            format!("{}{}", super::pictures::LISTED, self.first_picture + self.pictures.len());
        self.pictures.push((link.value().to_owned(), link.range().start));
        edits.push((Cow::Borrowed("xlink:href"), None));
        edits.push((Cow::Borrowed("href"), Some(Cow::Owned(key))));
    }

    /// Examines an attribute.
    fn attribute(
        &mut self,
        node: Node<'a, 'i>,
        name: &'a str,
        value: &'a str,
        at: usize,
        scope: &Scope,
        edits: &mut Edits<'a>,
    ) {
        let element = node.tag_name().name();
        let kind = Kind::of_attribute(element, name);
        let is_property = initial(name).is_some() || kind.is_some();
        let mut said = Cow::Borrowed(value);
        if is_property && value.contains("var(") {
            self.varied.insert(node.id());
            match self.styles.variables.replaced(value, scope.variables) {
                Some(replaced) => {
                    said = Cow::Owned(replaced);
                    edits.push((Cow::Borrowed(name), Some(said.clone())));
                }
                None => {
                    self.note((name, value), element, at, "it is undefined; it is ignored");
                    return edits.push((Cow::Borrowed(name), None));
                }
            }
        }
        self.check_links(node, name, &said, at);
        if is_of_svg(&node)
            && PRESENTATION.contains(&name)
            && let Some(note) = not_drawn(name, &said)
            && self.seen.insert(note.clone())
        {
            self.notes.push((at, note));
        }
        if is_property && said != "inherit" && is_general(&said) {
            return edits.push((Cow::Borrowed(name), general(name, &said)));
        }
        let Some(kind) = kind.filter(|_| said != "inherit") else { return };
        let words = kind.words(name, &said, &scope.around);
        let is_noted = self.check(kind, (name, &said), element, at, words.is_some());
        let edit = match words {
            Some(Cow::Borrowed(words)) if words == &*said => return,
            Some(words) => Some(Cow::Owned(words.into_owned())),
            None if is_noted && kind.fate(name, &said) == Fate::PassedOver => None,
            None => return,
        };
        edits.push((Cow::Borrowed(name), edit));
    }

    /// Reports the fault of a value; returns whether there is one.
    fn check(
        &mut self,
        kind: Kind,
        said: (&str, &str),
        element: &str,
        at: usize,
        is_usable: bool,
    ) -> bool {
        let (name, value) = said;
        if kind == Kind::Transform && !can_be_drawn(value) {
            let what = "it makes everything flat or smaller than 10⁻⁷ of its size, or has too large \
                        numbers; the elements it applies to are left out";
            self.note(said, element, at, what);
            return false;
        }
        if is_usable && (kind != Kind::Path || kind.is_known(value)) {
            return false;
        }
        if !value.trim().is_empty() {
            let fate = kind.fate(name, value).in_words();
            self.note(said, element, at, &format!("{}; {fate}", kind.wanted()));
        }
        true
    }

    fn note(&mut self, (name, value): (&str, &str), element: &str, at: usize, what: &str) {
        if self.seen.insert(format!("{name} {value}")) {
            self.notes.push((at, format!("`{name}` of `{element}` is `{}`: {what}", shown(value))));
        }
    }

    /// Reports references to missing elements.
    fn check_links(&mut self, node: Node<'a, 'i>, name: &str, value: &str, at: usize) {
        let element = node.tag_name().name();
        let wants = match name {
            "fill" | "stroke" => "nothing is painted",
            "clip-path" | "mask" | "marker-start" | "marker-mid" | "marker-end" => "it is ignored",
            "href" if matches!(element, "use" | "textPath" | "tref") => "nothing is drawn",
            _ => return,
        };
        let elsewhere = match name {
            "href" => !value.trim().is_empty() && !value.trim().starts_with('#'),
            _ => value.starts_with("url(") && value.ends_with(')') && is_elsewhere(value),
        };
        if elsewhere {
            let what = format!("elements of other files, and pictures, are not read; {wants}");
            return self.note((name, value), element, at, &what);
        }
        let link = match name {
            "href" => value.trim().strip_prefix('#'),
            // Without a replacement.
            _ => filters::links(value)
                .next()
                .filter(|_| value.split_once(')').is_some_and(|(_, rest)| rest.trim().is_empty())),
        };
        if let Some(id) = link.filter(|id| !self.ids.contains_key(id)) {
            let what = format!("there is no element with the id `{}`; {wants}", shown(id));
            self.note((name, value), element, at, &what);
        }
    }

    /// Returns the amended document and the messages.
    fn finish(mut self) -> Result<Amended> {
        self.copy_shown()?;
        self.notes.append(&mut self.styles.notes);
        for pending in std::mem::take(&mut self.pending).into_iter().rev() {
            pending.finish(&mut self.changes, &self.ids, &mut self.notes);
        }
        let lines = Lines::new(self.document.input_text());
        let mut seen = BTreeSet::new();
        self.notes.sort_by_key(|(at, _)| *at);
        let notes = self.notes.iter().filter(|(_, message)| seen.insert(message.as_str()));
        let warnings = notes
            .map(|(at, message)| Warning { place: lines.place(*at), message: message.clone() })
            .collect();
        let is_new = self.styles.has_sheets || !self.changes.is_empty();
        let written = is_new.then(|| write::document(self.document, &self.changes));
        Ok(Amended { written, warnings, pictures: self.pictures })
    }
}

/// Attributes whose properties are only partly drawn.
const PRESENTATION: [&str; 3] = ["vector-effect", "font-variant", "text-decoration"];

/// Returns whether a value is one that all properties may have.
fn is_general(value: &str) -> bool {
    ["inherit", "initial", "unset", "revert", "revert-layer"]
        .iter()
        .any(|word| value.eq_ignore_ascii_case(word))
}

/// Returns such a value as an attribute.
fn general(name: &str, value: &str) -> Option<Cow<'static, str>> {
    match (value.to_ascii_lowercase().as_str(), initial(name)) {
        ("initial", Some(value)) => Some(Cow::Borrowed(value)),
        // Properties that are not inherited may still take the parent's value.
        ("inherit", None) => Some(Cow::Borrowed("inherit")),
        _ => None,
    }
}
