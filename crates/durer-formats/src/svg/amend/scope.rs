//! The values that an element inherits.

use super::Walk;
use crate::css;
use crate::svg::letters::{Case, Letters};
use crate::svg::style::{self, Declared};
use crate::svg::values::{Around, font_size};
use std::borrow::Cow;
use std::collections::BTreeMap;
use usvg::roxmltree::Node;

/// The values that an element inherits.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Scope {
    pub(super) around: Around,
    pub(super) variables: Option<usize>,
    pub(super) letters: Letters,
    /// Space between letters, in pixels.
    pub(super) spacing: f64,
    /// True within a text that does not position single letters.
    pub(super) is_free: bool,
}

impl<'a, 'i> Walk<'a, 'i> {
    /// Enters an element and records the values that its own ones are relative to.
    pub(super) fn enter(
        &mut self,
        node: Node<'a, 'i>,
        said: &BTreeMap<String, Declared>,
        scope: &mut Scope,
    ) {
        let mut value = |name: &str, scope: &Scope| {
            let text = said.get(name).map(|d| Cow::Borrowed(d.value.as_str()));
            let text = text.or_else(|| node.attribute(name).map(Cow::Borrowed))?;
            self.styles.variables.replaced(&text, scope.variables)
        };
        if let Some(size) =
            value("font-size", scope).and_then(|v| font_size(v.trim(), &scope.around.units))
        {
            scope.around.units.font_size = size;
        }
        let of_font = said.get("font").and_then(|_| value("font", scope));
        if let Some((_, size)) =
            of_font.and_then(|v| style::font(&v)?.into_iter().find(|(n, _)| *n == "font-size"))
        {
            scope.around.units.font_size =
                font_size(&size, &scope.around.units).unwrap_or(scope.around.units.font_size);
        }
        if let Some(text) = value("color", scope) {
            scope.around.color =
                css::color_within(&text, scope.around.color).or(scope.around.color);
        }
        if let Some(text) = value("letter-spacing", scope) {
            let spacing = scope.around.units.parse(text.trim(), None).and_then(|v| v.length());
            if text != "inherit" {
                scope.spacing = spacing.unwrap_or(0.0);
                scope.letters.are_apart = scope.spacing != 0.0;
            }
        }
        if let Some(text) = value("text-transform", scope) {
            scope.letters.case = Case::of(text.trim()).unwrap_or(scope.letters.case);
        }
        let name = node.tag_name().name();
        if node.parent_element().is_none() {
            let units = &mut scope.around.units;
            units.root_font_size = units.font_size;
            let black = css::Color::of_bytes([0, 0, 0, 255]);
            scope.around.color = scope.around.color.or(Some(black));
        }
        if name == "svg" {
            scope.around.units.viewport =
                style::viewport(node).unwrap_or(scope.around.units.viewport);
        }
        if name == "text" {
            let lists = ["x", "y", "dx", "dy", "rotate"];
            let places = |node: Node<'_, '_>| {
                let mut values = lists.iter().filter_map(|name| node.attribute(*name));
                values.any(|v| v.trim().contains([' ', ',', '\n', '\t']))
            };
            scope.is_free = !node.descendants().any(places);
        }
        let is_text = scope.is_free && matches!(name, "text" | "tspan" | "textPath" | "a");
        if is_text && !scope.letters.are_as_written() {
            self.changes.letters.insert(node.id(), scope.letters);
        }
    }
}
