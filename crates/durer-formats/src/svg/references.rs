//! What a drawing's elements refer to: usvg follows patterns, masks and clip paths by recursion, and without end where
//! three of them, or two of different kinds, go in a circle. Such drawings are refused before it sees them.

use crate::{Error, Result};
use simplecss::{AttributeOperator, DeclarationTokenizer, PseudoClass, StyleSheet};
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node, NodeId};

/// Elements within one another and within what refers to them may be so deep, as usvg has it for elements alone.
const MAX_DEPTH: usize = 1024;

/// What following a reference takes of the stack, in elements.
const REFERENCE: usize = 8;

/// Elements that are filled and stroked.
const SHAPES: [&str; 9] =
    ["path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "text", "tspan"];

/// How something is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Fill,
    Stroke,
    ClipPath,
    Mask,
    Marker,
    /// By `href`.
    Href,
}

impl Kind {
    /// Whether elements of this name are what is looked for.
    fn fits(self, name: &str) -> bool {
        match self {
            Self::Fill | Self::Stroke => name == "pattern",
            Self::ClipPath => name == "clipPath",
            Self::Mask => name == "mask",
            Self::Marker => name == "marker",
            Self::Href => true,
        }
    }
}

/// Properties that refer to elements.
const PROPERTIES: [(&str, Kind); 7] = [
    ("fill", Kind::Fill),
    ("stroke", Kind::Stroke),
    ("clip-path", Kind::ClipPath),
    ("mask", Kind::Mask),
    ("marker-start", Kind::Marker),
    ("marker-mid", Kind::Marker),
    ("marker-end", Kind::Marker),
];

/// Refuses references that go in circles, and elements that are too deep.
///
/// # Errors
/// [`Error::Decode`] with the place of the element where a circle closes, or that is too deep.
pub fn check(document: &Document<'_>) -> Result<()> {
    let with_id = |node: Node<'_, '_>| node.attribute("id").is_some();
    let mut ids: HashMap<_, Vec<_>> = HashMap::new();
    for node in document.descendants().filter(|node| with_id(*node)) {
        ids.entry(node.attribute("id").unwrap_or_default()).or_default().push(node);
    }
    let sheet = sheet(document);
    Walk { document, sheet: &sheet, ids, depths: HashMap::new(), open: Vec::new() }
        .depth(document.root_element(), Kind::Href, 0, [(None, true); 2])
        .map(drop)
}

/// The rules of all style sheets that say what elements refer to, those that count least first.
fn sheet<'a>(document: &'a Document<'_>) -> StyleSheet<'a> {
    let mut sheet = StyleSheet::new();
    for style in document.descendants().filter(|node| node.has_tag_name("style")) {
        if style.attribute("type").is_none_or(|kind| kind == "text/css") {
            sheet.parse_more(style.text().unwrap_or_default());
        }
    }
    let refers = |name: &str| PROPERTIES.iter().any(|(known, _)| *known == name);
    sheet.rules.retain(|rule| rule.declarations.iter().any(|said| refers(said.name)));
    sheet
}

struct Walk<'a, 'i> {
    document: &'a Document<'i>,
    sheet: &'a StyleSheet<'a>,
    /// Of several elements with the same id any may be meant.
    ids: HashMap<&'a str, Vec<Node<'a, 'i>>>,
    /// How deep the elements are that have been followed, with the paints that they have from around them.
    depths: HashMap<(NodeId, [Option<&'a str>; 2]), usize>,
    /// Those that are being followed, and how they were referred to.
    open: Vec<(NodeId, Kind)>,
}

/// What fill and stroke an element has from around it, and whether that was said outside of what is being followed.
type Paints<'a> = [(Option<&'a str>, bool); 2];

/// What is said of each of [`PROPERTIES`], fill and stroke first.
type Said<'a> = [Option<&'a str>; PROPERTIES.len()];

impl<'a, 'i> Walk<'a, 'i> {
    /// How many levels there are in an element and in what it refers to; `above` are around it, with these paints.
    fn depth(
        &mut self,
        start: Node<'a, 'i>,
        kind: Kind,
        above: usize,
        around: Paints<'a>,
    ) -> Result<usize> {
        let key = (start.id(), around.map(|(paint, _)| paint));
        if let Some(depth) = self.depths.get(&key) {
            return if above + depth > MAX_DEPTH { Err(self.too_deep(start)) } else { Ok(*depth) };
        }
        self.open.push((start.id(), kind));
        let is_clip = start.has_tag_name((super::ROOT.0, "clipPath"));
        let mut deepest = 0;
        let mut left = vec![(start, 0, around)];
        while let Some((node, level, mut paints)) = left.pop() {
            if above + level > MAX_DEPTH {
                return Err(self.too_deep(node));
            }
            deepest = deepest.max(level);
            let said = self.said(node);
            for (paint, said) in paints.iter_mut().zip(said) {
                if let Some(value) = said.filter(|value| *value != "inherit") {
                    *paint = (Some(value), false);
                }
            }
            for (kind, target, is_outside) in self.references(node, &said, &paints, is_clip) {
                if let Some(at) = self.open.iter().position(|(id, _)| *id == target.id()) {
                    if self.is_endless(at, kind, is_outside) {
                        return Err(self.circle(node, target));
                    }
                    continue;
                }
                let below = level + REFERENCE;
                // What `use` shows has its paints from there.
                let is_use = kind == Kind::Href && node.tag_name().name() == "use";
                let around = if is_use { paints } else { self.inherited(target) };
                deepest = deepest.max(below + self.depth(target, kind, above + below, around)?);
            }
            let children = node.children().filter(Node::is_element);
            left.extend(children.map(|child| (child, level + 1, paints)));
        }
        self.open.pop();
        self.depths.insert(key, deepest);
        Ok(deepest)
    }

    /// What an element refers to where it is drawn; clip paths have neither paint nor mask.
    fn references(
        &self,
        node: Node<'a, 'i>,
        said: &Said<'a>,
        paints: &Paints<'a>,
        is_clip: bool,
    ) -> Vec<(Kind, Node<'a, 'i>, bool)> {
        let mut found = Vec::new();
        let is_shape = SHAPES.contains(&node.tag_name().name());
        for ((_, kind), said) in PROPERTIES.into_iter().zip(said) {
            let (value, is_outside) = match kind {
                Kind::Fill if is_shape && !is_clip => paints[0],
                Kind::Stroke if is_shape && !is_clip => paints[1],
                Kind::Fill | Kind::Stroke => (None, false),
                Kind::ClipPath => (*said, false),
                _ if is_clip => (None, false),
                _ => (*said, false),
            };
            let targets = value.and_then(target_of).and_then(|id| self.ids.get(id));
            let fitting = targets.into_iter().flatten();
            let fitting = fitting.filter(|target| kind.fits(target.tag_name().name()));
            found.extend(fitting.map(|target| (kind, *target, is_outside)));
        }
        let href = node.attributes().find(|a| a.name() == "href").map(|a| a.value());
        let targets = href.and_then(|href| self.ids.get(href.trim().strip_prefix('#')?));
        found.extend(targets.into_iter().flatten().map(|target| (Kind::Href, *target, false)));
        found
    }

    /// Whether usvg would follow a circle without end, that closes by a reference to what was opened `at`: it cuts
    /// those of one or two elements of the same kind, and all with a marker or of `href` alone.
    fn is_endless(&self, at: usize, kind: Kind, is_outside: bool) -> bool {
        let within = self.open.get(at + 1..).unwrap_or_default().iter().map(|(_, kind)| *kind);
        let kinds: Vec<Kind> = within.chain([kind]).collect();
        let is_alike = kinds.iter().all(|other| *other == kind);
        let is_cut = is_alike && (kinds.len() <= 2 || kind == Kind::Href) && !is_outside;
        !is_cut && !kinds.contains(&Kind::Marker)
    }

    /// Fill and stroke that are said around an element.
    fn inherited(&self, node: Node<'a, 'i>) -> Paints<'a> {
        let mut paints = [(None, true); 2];
        for around in node.ancestors().skip(1).filter(Node::is_element) {
            for ((paint, _), said) in paints.iter_mut().zip(self.said(around)) {
                *paint = paint.or(said.filter(|value| *value != "inherit"));
            }
            if paints.iter().all(|(paint, _)| paint.is_some()) {
                break;
            }
        }
        paints
    }

    /// What is said of each property for an element itself: by its style before the sheets and its attributes, but
    /// for what is important.
    fn said(&self, node: Node<'a, 'i>) -> Said<'a> {
        let mut said = PROPERTIES.map(|(name, _)| (node.attribute(name), false));
        let rules = self.sheet.rules.iter().filter(|rule| rule.selector.matches(&Styled(node)));
        let own = DeclarationTokenizer::from(node.attribute("style").unwrap_or_default());
        for declared in rules.flat_map(|rule| rule.declarations.iter().copied()).chain(own) {
            for ((name, _), (value, important)) in PROPERTIES.iter().zip(&mut said) {
                if *name == declared.name && (declared.important || !*important) {
                    (*value, *important) = (Some(declared.value), declared.important);
                }
            }
        }
        said.map(|(value, _)| value.map(str::trim))
    }

    fn place(&self, node: Node<'_, '_>) -> (u64, u64) {
        let at = self.document.text_pos_at(node.range().start);
        (at.row.into(), at.col.into())
    }

    fn circle(&self, node: Node<'_, '_>, target: Node<'_, '_>) -> Error {
        let ((line, column), id) = (self.place(node), target.attribute("id").unwrap_or_default());
        let id = crate::text::quote(id.as_bytes());
        Error::line(
            line,
            column,
            format!("references go in a circle: this one to `#{id}` closes it"),
        )
    }

    fn too_deep(&self, node: Node<'_, '_>) -> Error {
        let (line, column) = self.place(node);
        let message =
            format!("elements and what they refer to are more than {MAX_DEPTH} levels deep");
        Error::line(line, column, message)
    }
}

/// An element as style sheets see it.
struct Styled<'a, 'i>(Node<'a, 'i>);

impl simplecss::Element for Styled<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Styled)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Styled)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.prev_sibling_element().is_none()
    }
}

/// The `id` in `url(#id)`.
fn target_of(value: &str) -> Option<&str> {
    let (inside, _) = value.split_once("url(")?.1.split_once(')')?;
    inside.trim().trim_matches(['"', '\'']).strip_prefix('#')
}
