//! The properties of CSS that drawings have.

use super::sheet::{Declaration, shown};
use super::variables::has_variables;
use crate::svg::values::{Around, Kind};

/// Properties that elements inherit.
const INHERITED: [(&str, &str); 40] = [
    ("clip-rule", "nonzero"),
    ("color", "black"),
    ("color-interpolation", "sRGB"),
    ("color-interpolation-filters", "linearRGB"),
    ("color-rendering", "auto"),
    ("direction", "ltr"),
    ("dominant-baseline", "auto"),
    ("fill", "black"),
    ("fill-opacity", "1"),
    ("fill-rule", "nonzero"),
    ("font-family", "serif"),
    ("font-kerning", "auto"),
    ("font-optical-sizing", "auto"),
    ("font-size", "medium"),
    ("font-stretch", "normal"),
    ("font-style", "normal"),
    ("font-variant", "normal"),
    ("font-variation-settings", "normal"),
    ("font-weight", "normal"),
    ("glyph-orientation-vertical", "auto"),
    ("image-rendering", "auto"),
    ("letter-spacing", "normal"),
    ("marker-end", "none"),
    ("marker-mid", "none"),
    ("marker-start", "none"),
    ("paint-order", "normal"),
    ("shape-rendering", "auto"),
    ("stroke", "none"),
    ("stroke-dasharray", "none"),
    ("stroke-dashoffset", "0"),
    ("stroke-linecap", "butt"),
    ("stroke-linejoin", "miter"),
    ("stroke-miterlimit", "4"),
    ("stroke-opacity", "1"),
    ("stroke-width", "1"),
    ("text-anchor", "start"),
    ("text-rendering", "auto"),
    ("visibility", "visible"),
    ("word-spacing", "normal"),
    ("writing-mode", "horizontal-tb"),
];

/// Others that become attributes.
const OTHERS: [&str; 45] = [
    "alignment-baseline",
    "background-color",
    "baseline-shift",
    "clip-path",
    "cx",
    "cy",
    "d",
    "display",
    "filter",
    "flood-color",
    "flood-opacity",
    "font-size-adjust",
    "height",
    "isolation",
    "lighting-color",
    "mask",
    "mask-type",
    "mix-blend-mode",
    "opacity",
    "overflow",
    "r",
    "rotate",
    "rx",
    "ry",
    "scale",
    "stop-color",
    "stop-opacity",
    "text-decoration",
    "text-overflow",
    "text-transform",
    "transform",
    "transform-box",
    "transform-origin",
    "translate",
    "unicode-bidi",
    "vector-effect",
    "white-space",
    "width",
    "x",
    "y",
    // Parts of shorthands that are requested separately.
    "font",
    "marker",
    "background",
    "text-decoration-line",
    "glyph-orientation-horizontal",
];

/// Properties that usvg reads in a `style` attribute alone.
pub(crate) const IN_STYLE: [&str; 3] = ["mix-blend-mode", "isolation", "font-kerning"];

/// Properties that change a picture in browsers, but not here.
const NOT_DRAWN: [&str; 26] = [
    "animation",
    "animation-name",
    "background-image",
    "border",
    "box-shadow",
    "font-feature-settings",
    "font-palette",
    "font-variant-alternates",
    "font-variant-caps",
    "font-variant-ligatures",
    "font-variant-numeric",
    "inline-size",
    "mask-border",
    "mask-image",
    "offset-path",
    "perspective",
    "shape-inside",
    "shape-subtract",
    "stroke-alignment",
    "text-combine-upright",
    "text-emphasis",
    "text-orientation",
    "text-shadow",
    "zoom",
    "-webkit-text-stroke",
    "text-decoration-color",
];

/// Returns the initial value of a property that elements inherit.
pub(crate) fn initial(name: &str) -> Option<&'static str> {
    INHERITED.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
}

fn is_known(name: &str) -> bool {
    initial(name).is_some() || OTHERS.contains(&name)
}

/// Returns whether a property applies to an element.
pub(crate) fn takes(element: &str, name: &str) -> bool {
    match name {
        "x" | "y" | "width" | "height" => {
            matches!(element, "svg" | "rect" | "image" | "use" | "foreignObject")
                || element == "symbol" && (name == "width" || name == "height")
        }
        "cx" | "cy" => matches!(element, "circle" | "ellipse"),
        "r" => element == "circle",
        "rx" | "ry" => matches!(element, "rect" | "ellipse"),
        "d" => element == "path",
        // Attributes with these names have another meaning there.
        "rotate" => !matches!(element, "text" | "tspan" | "altGlyph" | "animateMotion"),
        "scale" => element != "feDisplacementMap",
        _ => true,
    }
}

/// Returns whether a value is a keyword that every property may have.
fn is_general(value: &str) -> bool {
    ["inherit", "initial", "unset", "revert", "revert-layer"]
        .iter()
        .any(|word| value.eq_ignore_ascii_case(word))
}

/// Returns the usable values of a declaration for properties that drawings have.
///
/// # Errors
/// The warning if it cannot be used.
pub(super) fn usable(
    declaration: &Declaration,
    is_sheet: bool,
) -> Result<Vec<Declaration>, String> {
    let Declaration { name, value, .. } = declaration;
    if name.starts_with("--") {
        return Ok(vec![declaration.clone()]);
    }
    if let Some(note) = not_drawn(name, value) {
        return Err(note);
    }
    if NOT_DRAWN.contains(&name.as_str()) || !is_known(name) {
        return Ok(Vec::new());
    }
    let said = |name: &str, value: &str| Declaration {
        name: name.to_owned(),
        value: value.to_owned(),
        ..declaration.clone()
    };
    match name.as_str() {
        "marker" => {
            return Ok(["marker-start", "marker-mid", "marker-end"]
                .map(|name| said(name, value))
                .to_vec());
        }
        "text-decoration-line" => return Ok(vec![said("text-decoration", value)]),
        "background" => return Ok(vec![said("background-color", value)]),
        "font" if !has_variables(value) && !is_general(value) => {
            let parts = font(value).ok_or_else(|| {
                format!("`font` of `style` is `{}`: it must be a style, a size and families, as `bold 12px serif`; it is ignored", shown(value))
            })?;
            return Ok(parts.iter().map(|(name, value)| said(name, value)).collect());
        }
        _ => {}
    }
    let Some(kind) = Kind::of_style(name) else { return Ok(vec![declaration.clone()]) };
    // An element's own declarations are checked when it is known whether they apply there.
    if !is_sheet && !takes("g", name) {
        return Ok(vec![declaration.clone()]);
    }
    let needs_unit = is_sheet && NEED_UNITS.contains(&name.as_str());
    if needs_unit && value.parse::<f64>().is_ok_and(|v| v != 0.0) {
        return Err(format!(
            "`{name}` of `style` is `{}`: in style sheets it needs a unit, as `{value}px`; it is ignored",
            shown(value)
        ));
    }
    let is_usable = is_general(value)
        || has_variables(value)
        || (kind == Kind::Path && (value == "none" || value.starts_with("path(")))
        || kind != Kind::Path && kind.words(name, value, &around()).is_some();
    if is_usable {
        return Ok(vec![declaration.clone()]);
    }
    Err(format!("`{name}` of `style` is `{}`: {}; it is ignored", shown(value), kind.wanted()))
}

/// Returns a warning about a declaration that changes a picture in browsers, but not here.
pub(crate) fn not_drawn(name: &str, value: &str) -> Option<String> {
    let is_usual = ["none", "normal", "auto", "0", "1"].contains(&value) || is_general(value);
    let fate = match name {
        _ if is_usual || has_variables(value) => return None,
        "vector-effect" if value == "non-scaling-stroke" => "not drawn; strokes are scaled",
        "text-decoration" if !value.split_whitespace().all(|word| LINES.contains(&word)) => {
            "drawn as plain lines in the colour of the text"
        }
        "font-variant" => "not drawn",
        _ if NOT_DRAWN.contains(&name) => "not drawn",
        _ => return None,
    };
    Some(format!("`{name}: {}` is {fate}", shown(value)))
}

/// Lines of `text-decoration` that are drawn.
const LINES: [&str; 5] = ["underline", "overline", "line-through", "blink", "solid"];

/// Properties whose lengths need a unit in style sheets, as in browsers.
const NEED_UNITS: [&str; 5] = ["font-size", "height", "letter-spacing", "width", "word-spacing"];

/// Returns a context for values that are not relative.
fn around() -> Around {
    Around { color: Some(crate::css::Color::of_bytes([0, 0, 0, 255])), ..Around::default() }
}

/// Returns the properties that `font` sets.
pub(crate) fn font(value: &str) -> Option<Vec<(&'static str, String)>> {
    let font = svgtypes::FontShorthand::from_str(value).ok()?;
    let or_normal = |part: Option<&str>| part.unwrap_or("normal").to_owned();
    Some(vec![
        ("font-style", or_normal(font.font_style)),
        ("font-variant", or_normal(font.font_variant)),
        ("font-weight", or_normal(font.font_weight)),
        ("font-stretch", or_normal(font.font_stretch)),
        ("font-size", font.font_size.to_owned()),
        ("font-family", font.font_family.to_owned()),
        ("font-kerning", "auto".to_owned()),
    ])
}
