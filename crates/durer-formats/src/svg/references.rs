//! The references between a drawing's elements: usvg follows patterns, masks, clip paths and filters by recursion,
//! endlessly if three of them, or two of different kinds, form a cycle. Such drawings are refused before usvg reads
//! them.

use super::filters::links;
use crate::{Error, Result};
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node, NodeId};

/// Largest depth of elements within one another, including references; usvg's limit counts elements alone.
pub const MAX_DEPTH: usize = 1024;

/// Largest number of references followed in all: chains in which each element refers twice to the next would otherwise
/// take for ever in a small file.
const MAX_FOLLOWED: u64 = 1_000_000;

/// Stack that following a reference takes, in elements.
const REFERENCE: usize = 8;

/// Stack that a drawing inside an image takes, in elements.
pub const IMAGE: usize = 64;

/// Elements that are filled and stroked; `a` and `tref` within a text.
const SHAPES: [&str; 13] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "text", "tspan",
    "textPath", "tref", "a", "use",
];

/// Kind of a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    Fill,
    Stroke,
    ClipPath,
    Mask,
    Filter,
    Marker,
    /// Reference by `href`.
    Href,
}

impl Kind {
    /// Returns whether elements of this name are possible targets.
    fn fits(self, name: &str) -> bool {
        match self {
            Self::Fill | Self::Stroke => name == "pattern",
            Self::ClipPath => name == "clipPath",
            Self::Mask => name == "mask",
            Self::Filter => name == "filter",
            Self::Marker => name == "marker",
            Self::Href => true,
        }
    }
}

/// Properties that refer to elements.
const PROPERTIES: [(&str, Kind); 9] = [
    ("fill", Kind::Fill),
    ("stroke", Kind::Stroke),
    ("clip-path", Kind::ClipPath),
    ("mask", Kind::Mask),
    ("filter", Kind::Filter),
    ("marker", Kind::Marker),
    ("marker-start", Kind::Marker),
    ("marker-mid", Kind::Marker),
    ("marker-end", Kind::Marker),
];

/// Kinds with a single value, in the order of [`Values`].
const CASCADED: [Kind; 5] = [Kind::Fill, Kind::Stroke, Kind::ClipPath, Kind::Mask, Kind::Filter];

/// Returns the kind of reference that a property makes.
fn property(name: &str) -> Option<Kind> {
    PROPERTIES.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
}

/// Function from elements to their line and column in the file.
pub type PlaceOf<'p> = &'p dyn Fn(&Node<'_, '_>) -> (u64, u64);

/// Refuses references that go in circles or multiply, and elements that are too deep within one another and within the
/// `above` levels around the document; returns how many levels there are with those. Properties of style sheets must be
/// in attributes already.
///
/// # Errors
/// [`Error::Decode`] with the place of the element where a circle closes, that is too deep, or from where on there are
/// too many references.
pub fn check(document: &Document<'_>, above: usize, place: PlaceOf<'_>) -> Result<usize> {
    let mut ids: HashMap<_, Vec<_>> = HashMap::new();
    for node in document.descendants() {
        for id in node.attributes().filter(|attribute| attribute.name() == "id") {
            ids.entry(id.value()).or_default().push(node);
        }
    }
    let (found, around) = (HashMap::new(), HashMap::new());
    Walk { place, ids, found, around, open: Vec::new() }
        .follow(document.root_element(), BY_HREF, above, Values::default())
        .map(|found| above + found.levels)
}

struct Walk<'a, 'i, 'p> {
    place: PlaceOf<'p>,
    /// Elements by id; an id may name several.
    ids: HashMap<&'a str, Vec<Node<'a, 'i>>>,
    /// Results for the elements that have been followed, by the kind of reference and the values around them.
    found: HashMap<(NodeId, Opened, Values<'a>), Found>,
    /// Inherited values around elements that were referred to.
    around: HashMap<NodeId, Values<'a>>,
    /// References that are being followed.
    open: Vec<(NodeId, Opened)>,
}

/// Contents of an element and of everything that it refers to.
#[derive(Debug, Clone, Copy, Default)]
struct Found {
    levels: usize,
    /// Number of times that references are followed to draw it once.
    followed: u64,
}

/// Kind of reference to an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Opened {
    kind: Kind,
    /// True for a reference by a paint of an element outside of the one that is being followed.
    is_outside: bool,
}

const BY_HREF: Opened = Opened { kind: Kind::Href, is_outside: false };

/// Value of a property.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Value<'a> {
    text: &'a str,
    is_outside: bool,
}

/// Values of fill, stroke, clip path, mask and filter.
type Values<'a> = [Option<Value<'a>>; 5];

impl<'a, 'i> Walk<'a, 'i, '_> {
    /// Returns the contents of an element and of everything that it refers to; the element has `above` levels
    /// around it and inherits these values.
    fn follow(
        &mut self,
        start: Node<'a, 'i>,
        opened: Opened,
        above: usize,
        around: Values<'a>,
    ) -> Result<Found> {
        let key = (start.id(), opened, around);
        if let Some(found) = self.found.get(&key) {
            let is_deep = above + found.levels > MAX_DEPTH;
            return if is_deep { Err(self.too_deep(start)) } else { Ok(*found) };
        }
        self.open.push((start.id(), opened));
        let is_clip = start.has_tag_name((super::ROOT.0, "clipPath"));
        let mut found = Found::default();
        let mut left = vec![(start, 0, around)];
        while let Some((node, level, around)) = left.pop() {
            if above + level > MAX_DEPTH {
                return Err(self.too_deep(node));
            }
            found.levels = found.levels.max(level);
            let said = handed_down(self.said(node, &around), &around);
            for (opened, target) in self.references(node, &said, is_clip) {
                if let Some(at) = self.open.iter().position(|(id, _)| *id == target.id()) {
                    if self.is_endless(at, opened) {
                        return Err(self.circle(node, target));
                    }
                    continue;
                }
                let below = level + REFERENCE;
                // The target of a `use` takes its place.
                let is_use = opened.kind == Kind::Href && node.tag_name().name() == "use";
                let around = if is_use { said } else { self.around(target) };
                let around = self.needed(target, around);
                let of_target = self.follow(target, opened, above + below, around)?;
                found.levels = found.levels.max(below + of_target.levels);
                found.followed += 1 + of_target.followed;
                if found.followed > MAX_FOLLOWED {
                    return Err(self.too_many(node));
                }
            }
            let children = node.children().filter(Node::is_element);
            left.extend(children.map(|child| (child, level + 1, said)));
        }
        self.open.pop();
        self.found.insert(key, found);
        Ok(found)
    }

    /// Lists the references of an element that is drawn; clip paths have neither paint, mask nor
    /// filter.
    fn references(
        &self,
        node: Node<'a, 'i>,
        said: &Values<'a>,
        is_clip: bool,
    ) -> Vec<(Opened, Node<'a, 'i>)> {
        let is_shape = SHAPES.contains(&node.tag_name().name());
        let mut found = Vec::new();
        let mut follow = |opened: Opened, value: &'a str| {
            let targets = links(value).filter_map(|id| self.ids.get(id)).flatten();
            let fitting = targets.filter(|target| opened.kind.fits(target.tag_name().name()));
            found.extend(fitting.map(|target| (opened, *target)));
        };
        for (kind, value) in CASCADED.into_iter().zip(said) {
            let Some(value) = value else { continue };
            let is_followed = match kind {
                Kind::ClipPath => true,
                Kind::Fill | Kind::Stroke => is_shape && !is_clip,
                Kind::Filter => !is_clip && !self.has_image_of_itself(node, value.text),
                _ => !is_clip,
            };
            if is_followed {
                follow(Opened { kind, is_outside: value.is_outside }, value.text);
            }
        }
        let markers = attributes(node).filter(|(name, _)| property(name) == Some(Kind::Marker));
        let marker = Opened { kind: Kind::Marker, is_outside: false };
        markers.filter(|_| !is_clip).for_each(|(_, value)| follow(marker, value));
        // Targets of links are not drawn.
        if node.tag_name().name() != "a" {
            found.extend(self.linked(node).map(|target| (BY_HREF, target)));
        }
        found
    }

    /// Returns the elements that an element refers to by `href`.
    fn linked(&self, node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
        let links = node.attributes().filter(|attribute| attribute.name() == "href");
        let ids = links.filter_map(|link| link.value().trim().strip_prefix('#'));
        ids.filter_map(|id| self.ids.get(id)).flatten().copied()
    }

    /// Returns whether the filter of an element shows the element: then usvg leaves the filter out.
    fn has_image_of_itself(&self, node: Node<'a, 'i>, filter: &str) -> bool {
        let filters = links(filter).filter_map(|id| self.ids.get(id)).flatten();
        let mut images = filters.flat_map(Node::children);
        images.any(|image| {
            image.tag_name().name() == "feImage" && self.linked(image).any(|shown| shown == node)
        })
    }

    /// Returns whether usvg would follow endlessly the cycle that a reference to the element opened `at` closes: it
    /// breaks cycles of one or two elements of the same kind, and all cycles with a marker or of `href` alone.
    fn is_endless(&self, at: usize, closing: Opened) -> bool {
        let within = self.open.get(at + 1..).unwrap_or_default().iter().map(|(_, opened)| *opened);
        let circle: Vec<Opened> = within.chain([closing]).collect();
        // usvg does not see paints inherited from around the references when it breaks cycles.
        let is_alike = circle.iter().all(|other| other.kind == closing.kind && !other.is_outside);
        let is_cut = is_alike && (circle.len() <= 2 || closing.kind == Kind::Href);
        !is_cut && circle.iter().all(|other| other.kind != Kind::Marker)
    }

    /// Returns the values that an element inherits, from the root on.
    fn around(&mut self, node: Node<'a, 'i>) -> Values<'a> {
        if let Some(known) = self.around.get(&node.id()) {
            return *known;
        }
        let ancestors: Vec<_> = node.ancestors().skip(1).filter(Node::is_element).collect();
        let mut around = Values::default();
        for ancestor in ancestors.into_iter().rev() {
            around = handed_down(self.said(ancestor, &around), &around);
        }
        let around = around.map(|value| value.map(|value| Value { is_outside: true, ..value }));
        self.around.insert(node.id(), around);
        around
    }

    /// Returns the inherited values that an element and its descendants can use: clip path, mask and filter only if it
    /// states `inherit` for them.
    fn needed(&self, node: Node<'a, 'i>, mut around: Values<'a>) -> Values<'a> {
        let mut values = attributes(node);
        if !values.any(|(name, value)| value == INHERIT && property(name).is_some()) {
            around[2..].fill(None);
        }
        around
    }

    /// Returns an element's own values as usvg finds them: of attributes the first counts.
    fn said(&self, node: Node<'a, 'i>, around: &Values<'a>) -> Values<'a> {
        let mut said = Values::default();
        for (name, text) in attributes(node) {
            let at = CASCADED.iter().position(|kind| property(name) == Some(*kind));
            let Some((slot, around)) = at.and_then(|at| said.get_mut(at).zip(around.get(at)))
            else {
                continue;
            };
            let value = match (text, around) {
                (INHERIT, Some(value)) => Value { is_outside: false, ..*value },
                (INHERIT, None) => Value { text: "none", is_outside: false },
                _ => Value { text, is_outside: false },
            };
            slot.get_or_insert(value);
        }
        said
    }

    fn place(&self, node: Node<'_, '_>) -> (u64, u64) {
        (self.place)(&node)
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

    fn too_many(&self, node: Node<'_, '_>) -> Error {
        let (line, column) = self.place(node);
        let message = format!(
            "references are followed more than {MAX_FOLLOWED} times: \
             elements refer more than once to others that do the same"
        );
        Error::line(line, column, message)
    }

    fn too_deep(&self, node: Node<'_, '_>) -> Error {
        let (line, column) = self.place(node);
        let message =
            format!("elements and what they refer to are more than {MAX_DEPTH} levels deep");
        Error::line(line, column, message)
    }
}

/// Keyword that takes the value of the element around.
const INHERIT: &str = "inherit";

/// Returns the attributes of an element that usvg reads.
fn attributes<'a>(node: Node<'a, '_>) -> impl Iterator<Item = (&'a str, &'a str)> {
    const KNOWN: [&str; 3] =
        [super::ROOT.0, "http://www.w3.org/1999/xlink", "http://www.w3.org/XML/1998/namespace"];
    let known = node.attributes().filter(|a| a.namespace().is_none_or(|ns| KNOWN.contains(&ns)));
    known.map(|attribute| (attribute.name(), attribute.value()))
}

/// Returns the values for an element's children: fill and stroke are inherited by all, the others by children with
/// `inherit`.
fn handed_down<'a>(mut said: Values<'a>, around: &Values<'a>) -> Values<'a> {
    for (own, around) in said.iter_mut().zip(around).take(2) {
        *own = own.or(*around);
    }
    said
}
