//! The regions of elements that remain after filters.

use std::collections::HashMap;
use usvg::roxmltree::Node;

/// Returns each `id` of `url(#id)` in a value.
pub(super) fn links(value: &str) -> impl Iterator<Item = &str> {
    value.split("url(").skip(1).filter_map(|rest| {
        let (inside, _) = rest.split_once(')')?;
        inside.trim().trim_matches(['"', '\'']).trim().strip_prefix('#')
    })
}

/// Returns a list of filters without those whose references are `missing`.
pub(super) fn without_links(value: &str, missing: impl Fn(&str) -> bool) -> String {
    let (mut out, mut rest) = (String::new(), value);
    while let Some(at) = rest.find("url(") {
        let (before, link) = rest.split_at(at);
        let (link, after) = link.split_at(link.find(')').map_or(link.len(), |end| end + 1));
        out.push_str(before);
        if !links(link).any(&missing) {
            out.push_str(link);
        }
        rest = after;
    }
    out.push_str(rest);
    out.trim().to_owned()
}

/// Returns whether a filter's result shows the colours of its element. Inputs count as *Filter Effects Module Level
/// 1*, W3C, § 9 says.
pub(super) fn shows_source(filter: Node<'_, '_>) -> bool {
    let mut results: HashMap<&str, bool> = HashMap::new();
    let mut last = true;
    for primitive in filter
        .children()
        .filter(|node| node.is_element() && node.tag_name().name().starts_with("fe"))
    {
        let of = |node: Node<'_, '_>, name: &str| match node.attribute(name) {
            Some("SourceGraphic") => true,
            Some(
                "SourceAlpha" | "BackgroundImage" | "BackgroundAlpha" | "FillPaint" | "StrokePaint",
            ) => false,
            Some(name) => results.get(name).copied().unwrap_or(last),
            None => last,
        };
        let (a, b) = (of(primitive, "in"), of(primitive, "in2"));
        let shows = match (primitive.tag_name().name(), primitive.attribute("operator")) {
            ("feFlood" | "feTurbulence" | "feImage", _) => false,
            ("feMerge", _) => {
                let mut parts = primitive.children().filter(Node::is_element);
                parts.any(|part| of(part, "in"))
            }
            ("feComposite", Some("in" | "out")) => a,
            ("feComposite" | "feBlend", _) => a || b,
            _ => a,
        };
        if let Some(name) = primitive.attribute("result") {
            results.insert(name, shows);
        }
        last = shows;
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use usvg::roxmltree::Document;

    #[test]
    fn filters_show_or_hide_their_source() {
        for (primitives, expected) in [
            ("<feGaussianBlur stdDeviation='1'/>", true),
            ("<feGaussianBlur in='SourceAlpha'/>", false),
            (
                "<feOffset in='SourceAlpha' result='a'/><feMerge><feMergeNode in='a'/><feMergeNode in='SourceGraphic'/></feMerge>",
                true,
            ),
            (
                "<feOffset in='SourceAlpha' result='a'/><feMerge><feMergeNode in='a'/></feMerge>",
                false,
            ),
            ("<feFlood/>", false),
            ("<feFlood result='f'/><feComposite in='f' in2='SourceGraphic' operator='in'/>", false),
            ("<feFlood result='f'/><feComposite in='SourceGraphic' in2='f' operator='in'/>", true),
            ("<feFlood result='f'/><feBlend in='f' in2='SourceGraphic'/>", true),
            ("<feDropShadow/>", true),
            ("", true),
        ] {
            let text = format!("<filter>{primitives}</filter>");
            let document = Document::parse(&text).unwrap();
            assert_eq!(shows_source(document.root_element()), expected, "{primitives}");
        }
    }
}
