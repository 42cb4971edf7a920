//! Declarations of style sheets and `style` attributes as attributes.

use super::scope::Scope;
use super::{Edits, Walk, general, is_general};
use crate::css;
use crate::svg::finish::Later;
use crate::svg::letters::Case;
use crate::svg::style::{self, Declared, IN_STYLE};
use crate::svg::transform;
use crate::svg::values::Kind;
use std::borrow::Cow;
use usvg::roxmltree::Node;

impl<'a, 'i> Walk<'a, 'i> {
    /// Examines the declarations of a property in style sheets and in the element's style.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn declared(
        &mut self,
        node: Node<'a, 'i>,
        name: &str,
        declared: &Declared,
        scope: &Scope,
        edits: &mut Edits<'a>,
        later: &mut Later,
        in_style: &mut String,
    ) {
        let element = node.tag_name().name();
        let of_style =
            || node.attribute_node("style").map_or(node.range().start, |style| style.range().start);
        let at = declared.at.unwrap_or_else(of_style);
        let mut set = |name: &str, value: Option<String>| {
            edits.push((Cow::Owned(name.to_owned()), value.map(Cow::Owned)));
        };
        if declared.value.contains("var(") {
            self.varied.insert(node.id());
        }
        let Some(value) = self.styles.variables.replaced(&declared.value, scope.variables) else {
            self.note((name, &declared.value), element, at, "it is undefined; it is ignored");
            return set(name, None);
        };
        let value = value.trim();
        if is_general(value) {
            let words = general(name, &value.to_ascii_lowercase());
            return set(name, words.map(Cow::into_owned));
        }
        let is_root = node.parent_element().is_none();
        match name {
            "font" => {
                for (name, value) in style::font(value).unwrap_or_default() {
                    set(name, Some(value));
                }
                return;
            }
            "transform" if is_root => {
                let units = &scope.around.units;
                let map = transform::parse(value, units, units.viewport);
                return set(name, map.map(|map| transform::attribute(&map)));
            }
            "transform" | "translate" | "rotate" | "scale" | "transform-box" if !is_root => {
                return later.transform(name, value);
            }
            "transform-origin" if !is_root => return later.transform(name, value),
            "filter" => later.is_filtered = true,
            "background-color" if is_root => {
                let color = css::color_within(value, scope.around.color).map(css::Color::bytes);
                if let Some([r, g, b, a]) = color.filter(|color| color[3] > 0) {
                    set(name, Some(format!("#{r:02x}{g:02x}{b:02x}{a:02x}")));
                } else if color.is_none() && value != "none" {
                    self.note(
                        (name, value),
                        element,
                        at,
                        "only colours are drawn behind a drawing; it is ignored",
                    );
                }
                return;
            }
            "background-color" | "text-overflow" => return,
            "text-transform" if Case::of(value).is_some() => return,
            "text-transform" => {
                return self.note((name, value), element, at, "text is set as it is written");
            }
            "white-space" => {
                let keeps =
                    value.starts_with("pre") && value != "pre-line" || value == "break-spaces";
                return set(
                    "xml:space",
                    Some(if keeps { "preserve" } else { "default" }.to_owned()),
                );
            }
            "clip-path" => later.clip(value, at),
            "mask" if !value.starts_with("url(") && value != "none" => {
                return self.note(
                    (name, value),
                    element,
                    at,
                    "only masks that are elements are drawn; it is ignored",
                );
            }
            "width" | "height" if is_root && (value == "auto" || value.ends_with('%')) => {
                // There is no element around that it could be part of.
                return;
            }
            "width" | "height" if value == "auto" => return set(name, None),
            _ => {}
        }
        self.check_links(node, name, value, at);
        let mut words = Cow::Borrowed(value);
        if let Some(kind) = Kind::of_style(name) {
            match kind.words(name, value, &scope.around) {
                Some(usable) => words = usable,
                None => {
                    self.note(
                        (name, value),
                        element,
                        at,
                        &format!("{}; it is ignored", kind.wanted()),
                    );
                    return set(name, None);
                }
            }
        }
        let is_in_style = IN_STYLE.contains(&name)
            || name == "image-rendering"
                && matches!(&*words, "smooth" | "high-quality" | "crisp-edges" | "pixelated");
        if is_in_style {
            in_style.push_str(&format!("{name}:{words};"));
            set(name, None);
        } else {
            set(name, Some(words.into_owned()));
        }
    }
}
