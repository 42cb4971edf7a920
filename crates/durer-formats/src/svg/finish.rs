//! The amendments that need all attributes of all elements.

use super::outline::{Attributes, Bounds, Boxes, path_length};
use super::shapes::{Reference, Shape};
use super::style::shown;
use super::transform;
use super::values::{Around, Kind};
use super::write::{Changes, attributes};
use super::{filters, markers};
use durer::math::{DAffine2, DVec2};
use std::borrow::Cow;
use std::collections::HashMap;
use usvg::roxmltree::Node;

/// Remaining work for an element.
#[derive(Debug, Clone, Default)]
pub(super) struct Later {
    /// Values of properties that make up its transform.
    transform: HashMap<String, String>,
    /// A shape to clip by, and where in the document it is said.
    pub clip: Option<(String, usize)>,
    pub is_filtered: bool,
    /// It may have markers.
    pub is_marked: bool,
    /// Its path data as they were said, with arcs.
    pub data: Option<String>,
    has_length: bool,
}

impl Later {
    /// Records the value of a transform.
    pub fn transform(&mut self, name: &str, value: &str) {
        self.transform.insert(name.to_owned(), value.to_owned());
    }

    /// Records the work that an attribute requires.
    pub fn note(&mut self, name: &str, value: &str, at: usize) {
        match name {
            "pathLength" => self.has_length = true,
            "filter" => self.is_filtered = true,
            "clip-path" => self.clip(value, at),
            "transform-box" => self.transform(name, value),
            _ => {}
        }
    }

    /// Records the clip, if it is a shape.
    pub fn clip(&mut self, value: &str, at: usize) {
        let is_shape =
            !value.trim_start().starts_with("url(") && value != "none" && value != "inherit";
        self.clip = is_shape.then(|| (value.trim().to_owned(), at));
    }

    pub fn is_nothing(&self) -> bool {
        self.transform.is_empty()
            && self.clip.is_none()
            && !self.is_filtered
            && !self.is_marked
            && !self.has_length
    }
}

/// An element with its remaining work.
pub(super) struct Pending<'a, 'i> {
    pub node: Node<'a, 'i>,
    pub around: Around,
    pub later: Later,
}

/// All elements as they are by now.
struct View<'v, 'a, 'i> {
    changes: &'v Changes<'a>,
    ids: &'v HashMap<&'a str, Node<'a, 'i>>,
}

impl<'a> Attributes<'a> for View<'_, 'a, '_> {
    fn value(&self, node: Node<'a, '_>, name: &str) -> Option<&str> {
        match self.changes.attributes.get(&node.id()) {
            Some(all) => all.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_ref()),
            None => node.attribute(name),
        }
    }

    fn shown<'j>(&self, node: Node<'a, 'j>) -> Option<Node<'a, 'j>> {
        let link =
            node.attributes().find(|a| a.name() == "href")?.value().trim().strip_prefix('#')?;
        let id = self.ids.get(link)?.id();
        node.document().get_node(id)
    }
}

impl<'a> View<'_, 'a, '_> {
    /// Returns the value that an element has, or takes from around.
    fn inherited(&self, node: Node<'a, '_>, name: &str) -> Option<&str> {
        node.ancestors().find_map(|node| self.value(node, name).filter(|value| *value != "inherit"))
    }
}

/// Markers of paths with more vertices are left to usvg.
const MAX_VERTICES: usize = 100_000;

/// Returns whether path data have curves, arcs or closed parts: straight open lines are marked as they should be
/// anyway.
fn is_curved_or_closed(data: &str) -> bool {
    data.contains(['a', 'A', 'c', 'C', 's', 'S', 'q', 'Q', 't', 'T', 'z', 'Z'])
}

/// Sets an attribute of an element, or takes it away.
fn set<'a>(
    changes: &mut Changes<'a>,
    node: Node<'a, '_>,
    name: &'static str,
    value: Option<String>,
) {
    let all = changes.attributes.entry(node.id()).or_insert_with(|| attributes(node).collect());
    all.retain(|(own, _)| own != name);
    all.extend(value.map(|value| (Cow::Borrowed(name), Cow::Owned(value))));
}

impl<'a, 'i> Pending<'a, 'i> {
    /// Does the recorded work.
    pub fn finish(
        &self,
        changes: &mut Changes<'a>,
        ids: &HashMap<&'a str, Node<'a, 'i>>,
        notes: &mut Vec<(usize, String)>,
    ) {
        if self.later.is_filtered {
            self.filter(changes, ids, notes);
        }
        if self.later.has_length {
            self.dashes(changes, ids);
        }
        if self.name() == "use" {
            self.size(changes, ids);
        }
        if !self.later.transform.is_empty() {
            self.transform(changes, ids, notes);
        }
        if self.later.is_marked {
            self.mark(changes, ids);
        }
        if let Some((value, at)) = &self.later.clip {
            self.clip(value, *at, changes, ids, notes);
        }
    }

    fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Returns the reference box of the element.
    fn bounds(&self, view: &View<'_, 'a, 'i>, reference: Reference) -> Option<Bounds> {
        let [width, height] = self.around.units.viewport;
        if reference == Reference::View {
            return Some(Bounds { low: DVec2::ZERO, high: DVec2::new(width, height) });
        }
        let mut bounds = Boxes::new(view, &self.around, &view.changes.looked).find(self.node)?;
        let is_stroked = view.inherited(self.node, "stroke").is_some_and(|stroke| stroke != "none");
        if reference == Reference::Stroke && is_stroked {
            let width = view.inherited(self.node, "stroke-width").unwrap_or("1");
            let half = self.around.units.parse(width, None)?.length()? / 2.0;
            bounds = Bounds { low: bounds.low - half, high: bounds.high + half };
        }
        Some(bounds)
    }

    /// Combines the properties of a transform.
    fn transform(
        &self,
        changes: &mut Changes<'a>,
        ids: &HashMap<&'a str, Node<'a, 'i>>,
        notes: &mut Vec<(usize, String)>,
    ) {
        let view = View { changes, ids };
        let said = |name: &str| self.later.transform.get(name).map(String::as_str);
        let reference = match said("transform-box") {
            Some("fill-box" | "content-box") => Reference::Fill,
            Some("stroke-box" | "border-box") => Reference::Stroke,
            _ => Reference::View,
        };
        let at = self
            .node
            .attribute_node("style")
            .map_or(self.node.range().start, |style| style.range().start);
        let Some(bounds) = self.bounds(&view, reference) else {
            let value = said("transform-box").unwrap_or_default();
            let name = self.name();
            return notes.push((at, format!("`transform-box` of `{name}` is `{value}`: its box is not known; its transform is ignored")));
        };
        let (corner, size) = (bounds.low.to_array(), bounds.size().to_array());
        let units = &self.around.units;
        let own = view.value(self.node, "transform").and_then(|text| {
            let t: svgtypes::Transform = text.parse().ok()?;
            Some(DAffine2::from_cols(
                DVec2::new(t.a, t.b),
                DVec2::new(t.c, t.d),
                DVec2::new(t.e, t.f),
            ))
        });
        let mut map = DAffine2::IDENTITY;
        for name in ["translate", "rotate", "scale", "transform"] {
            let Some(value) = said(name) else {
                if name == "transform" {
                    map *= own.unwrap_or_default();
                }
                continue;
            };
            let found = match name {
                "transform" => transform::parse(value, units, size),
                _ => transform::single(name, value, units, size),
            };
            match found {
                Some(more) => map *= more,
                None => notes.push((
                    at,
                    format!(
                        "`{name}` of `{}` is `{}`: {}; it is ignored",
                        self.name(),
                        shown(value),
                        Kind::Functions.wanted()
                    ),
                )),
            }
        }
        let origin = said("transform-origin").or_else(|| view.value(self.node, "transform-origin"));
        let origin = origin.and_then(|text| transform::origin(text, units, corner, size));
        let origin = origin.unwrap_or(bounds.low);
        let map = DAffine2::from_translation(origin) * map * DAffine2::from_translation(-origin);
        let name = match self.name() {
            "linearGradient" | "radialGradient" => "gradientTransform",
            "pattern" => "patternTransform",
            _ => "transform",
        };
        set(changes, self.node, name, Some(transform::attribute(&map)));
        set(changes, self.node, "transform-origin", None);
    }

    /// Makes a clip path of a shape.
    fn clip(
        &self,
        value: &str,
        at: usize,
        changes: &mut Changes<'a>,
        ids: &HashMap<&'a str, Node<'a, 'i>>,
        notes: &mut Vec<(usize, String)>,
    ) {
        let view = View { changes, ids };
        let shape = Shape::parse(value);
        let bounds = shape.as_ref().and_then(|shape| self.bounds(&view, shape.reference));
        let area =
            shape.zip(bounds).and_then(|(shape, bounds)| shape.area(bounds, &self.around.units));
        let Some(area) = area else {
            let (name, value) = (self.name(), shown(value));
            let why = if Shape::parse(value.as_str()).is_some() && bounds.is_none() {
                "the box around it is not known"
            } else {
                "it must be a shape as `circle(10px at 5px 5px)`, or `url(#…)`"
            };
            return notes
                .push((at, format!("`clip-path` of `{name}` is `{value}`: {why}; it is ignored")));
        };
        let mut number = changes.definitions.len();
        let mut id = format!("clip-{number}");
        while ids.contains_key(id.as_str()) {
            number += 1;
            id = format!("clip-{number}");
        }
        let rule = if area.is_even_odd { "evenodd" } else { "nonzero" };
        changes.definitions.push_str(&format!(
            "<clipPath id=\"{id}\"><path clip-rule=\"{rule}\" d=\"{}\"></path></clipPath>",
            area.data
        ));
        set(changes, self.node, "clip-path", Some(format!("url(#{id})")));
    }

    /// Removes filters that do not exist, and elements of whose colours a filter leaves nothing.
    fn filter(
        &self,
        changes: &mut Changes<'a>,
        ids: &HashMap<&'a str, Node<'a, 'i>>,
        notes: &mut Vec<(usize, String)>,
    ) {
        let view = View { changes, ids };
        let value = view.value(self.node, "filter").filter(|value| value.contains("url("));
        let Some(value) = value.map(str::to_owned) else { return };
        let value = value.as_str();
        let is_filter = |node: &&Node<'_, '_>| node.tag_name().name() == "filter";
        let missing = |id: &&str| ids.get(id).filter(is_filter).is_none();
        let at = self.node.range().start;
        let name = self.name();
        if let Some(id) = filters::links(value).find(missing) {
            notes.push((at, format!("`filter` of `{name}` is `{}`: there is no filter with the id `{}`; it is ignored", shown(value), shown(id))));
            let rest = filters::without_links(value, |id| missing(&id));
            return set(changes, self.node, "filter", Some(rest).filter(|rest| !rest.is_empty()));
        }
        let mut filters = filters::links(value).filter_map(|id| ids.get(id));
        if !filters.all(|filter| filters::shows_source(*filter)) {
            notes.push((at, format!("`{name}` is left out: its filter `{}` shows none of its colours, and filters are not drawn", shown(value))));
            set(changes, self.node, "display", Some("none".to_owned()));
        }
    }

    /// Places the markers of a path, and removes those that browsers do not draw.
    fn mark(&self, changes: &mut Changes<'a>, ids: &HashMap<&'a str, Node<'a, 'i>>) {
        const NAMES: [&str; 3] = ["marker-start", "marker-mid", "marker-end"];
        let view = View { changes, ids };
        let is_in = |name: &str| self.node.ancestors().any(|node| node.tag_name().name() == name);
        if is_in("marker") || is_in("clipPath") {
            return;
        }
        let marker = |value: &str| {
            let marker = ids.get(filters::links(value).next()?)?;
            (marker.tag_name().name() == "marker").then_some(*marker)
        };
        let said = NAMES.map(|name| view.inherited(self.node, name));
        let markers = said.map(|value| value.and_then(marker));
        if markers.iter().all(Option::is_none) {
            return;
        }
        let name = self.name();
        if matches!(name, "rect" | "circle" | "ellipse") {
            return NAMES
                .iter()
                .for_each(|name| set(changes, self.node, name, Some("none".to_owned())));
        }
        let points = || view.value(self.node, "points").map(|points| format!("M{points}Z"));
        let data = match name {
            "polygon" => points(),
            _ => self.later.data.clone().or_else(|| view.value(self.node, "d").map(str::to_owned)),
        };
        let shows_context = |marker: &Node<'_, '_>| {
            let mut values = marker.descendants().flat_map(|node| node.attributes());
            values.any(|a| a.value().contains("context-"))
        };
        let Some(data) = data.filter(|data| is_curved_or_closed(data)) else { return };
        let is_path_of_text = self.node.attribute("id").is_some()
            && self.node.document().descendants().any(|node| node.tag_name().name() == "textPath");
        let vertices = markers::vertices(&data);
        // Elsewhere than on top usvg draws them with the path alone.
        let is_on_top =
            view.inherited(self.node, "paint-order").is_none_or(|order| !order.contains("markers"));
        if is_path_of_text
            || !is_on_top
            || markers.iter().flatten().any(shows_context)
            || vertices.len() > MAX_VERTICES
        {
            return;
        }
        let is_reversed =
            markers[0].and_then(|m| view.value(m, "orient")) == Some("auto-start-reverse");
        let links = [0, 1, 2].map(|i| said[i].filter(|_| markers[i].is_some()));
        let placed = markers::paths(&vertices, links, is_reversed);
        let shape = if name == "polygon" { "points" } else { "d" };
        let mut own = String::new();
        super::write::escape(view.value(self.node, shape).unwrap_or_default(), true, &mut own);
        let inside = format!(
            "<{name} {shape}=\"{own}\" marker-start=\"none\" marker-mid=\"none\" marker-end=\"none\"></{name}>{placed}"
        );
        set(changes, self.node, if name == "polygon" { "points" } else { "d" }, None);
        changes.groups.insert(self.node.id(), inside);
    }

    /// Scales dashes by the path length that the element gives.
    fn dashes(&self, changes: &mut Changes<'a>, ids: &HashMap<&'a str, Node<'a, 'i>>) {
        let view = View { changes, ids };
        let units = &self.around.units;
        let said =
            view.value(self.node, "pathLength").and_then(|text| text.trim().parse::<f64>().ok());
        let Some(said) = said.filter(|said| *said > 0.0) else { return };
        let Some(dashes) = view.inherited(self.node, "stroke-dasharray").filter(|d| *d != "none")
        else {
            return;
        };
        let Some(length) = path_length(&view, self.node, &self.around) else { return };
        let scale = length / said;
        let mut scaled = Vec::new();
        for dash in dashes.split([' ', ',', '\n', '\t']).filter(|dash| !dash.is_empty()) {
            let whole = super::values::whole_of("stroke-dasharray", units);
            let Some(dash) =
                units.parse(dash, Some(crate::css::Whole::Length(whole))).and_then(|v| v.length())
            else {
                return;
            };
            scaled.push((dash * scale).to_string());
        }
        let offset = view
            .inherited(self.node, "stroke-dashoffset")
            .and_then(|text| units.parse(text, None)?.length());
        let offset = offset.map(|offset| (offset * scale).to_string());
        set(changes, self.node, "stroke-dasharray", Some(scaled.join(" ")));
        if let Some(offset) = offset {
            set(changes, self.node, "stroke-dashoffset", Some(offset));
        }
    }

    /// Sets the size of a `use` to its symbol's if it has none itself.
    fn size(&self, changes: &mut Changes<'a>, ids: &HashMap<&'a str, Node<'a, 'i>>) {
        for side in ["width", "height"] {
            let view = View { changes, ids };
            let Some(symbol) =
                view.shown(self.node).filter(|node| node.tag_name().name() == "symbol")
            else {
                return;
            };
            if view.value(self.node, side).is_none_or(|value| value == "auto") {
                let of_symbol =
                    view.value(symbol, side).filter(|value| *value != "auto").map(str::to_owned);
                if of_symbol.is_some() {
                    set(changes, self.node, side, of_symbol);
                }
            }
        }
    }
}
