//! The values of attributes, rewritten so that usvg understands them.
//!
//! usvg silently ignores or misinterprets values that it does not know.

use super::{arcs, transform};
use crate::css::{self, Color, Token, Units, Whole};
use std::borrow::Cow;
use std::str::FromStr;
use svgtypes::{Length, LengthListParser, LengthUnit, NumberListParser, PathParser};

/// Elements whose size and place are lengths.
const SIZED: [&str; 14] = [
    "circle",
    "ellipse",
    "image",
    "line",
    "linearGradient",
    "marker",
    "mask",
    "pattern",
    "radialGradient",
    "rect",
    "stop",
    "svg",
    "symbol",
    "use",
];

/// Lengths that cannot be less than 0.
const NOT_NEGATIVE: [&str; 6] = ["width", "height", "r", "rx", "ry", "stroke-width"];

/// Kind of values of an attribute or a property.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Paint,
    Color,
    Length {
        negative: bool,
    },
    Lengths,
    Opacity,
    Number,
    Transform,
    /// `transform` of CSS.
    Functions,
    /// `auto` or `normal`, or a length.
    Spacing,
    FontSize,
    Points,
    Path,
    ViewBox,
    Words(&'static [&'static str]),
}

impl Kind {
    /// Returns the kind of a property's values, also in style sheets; `None` for those that are not
    /// checked.
    pub fn of_property(name: &str) -> Option<Self> {
        Some(match name {
            "fill" | "stroke" => Self::Paint,
            "color" | "flood-color" | "lighting-color" | "stop-color" => Self::Color,
            "fill-opacity" | "flood-opacity" | "opacity" | "stop-opacity" | "stroke-opacity" => {
                Self::Opacity
            }
            "stroke-width" => Self::Length { negative: false },
            "stroke-dashoffset" => Self::Length { negative: true },
            "stroke-dasharray" => Self::Lengths,
            "stroke-miterlimit" => Self::Number,
            "stroke-linecap" => Self::Words(&["butt", "round", "square"]),
            "stroke-linejoin" => Self::Words(&["miter", "miter-clip", "round", "bevel", "arcs"]),
            "fill-rule" | "clip-rule" => Self::Words(&["nonzero", "evenodd"]),
            "letter-spacing" | "word-spacing" => Self::Spacing,
            "font-size" => Self::FontSize,
            "transform" => Self::Transform,
            _ => return None,
        })
    }

    /// Returns the kind of values of a property in style sheets that has another meaning, or none, as a
    /// presentation attribute.
    pub fn of_style(name: &str) -> Option<Self> {
        Some(match name {
            "transform" => Self::Functions,
            "x" | "y" | "cx" | "cy" => Self::Length { negative: true },
            "width" | "height" | "r" | "rx" | "ry" => Self::Length { negative: false },
            "d" => Self::Path,
            _ => return Self::of_property(name),
        })
    }

    /// Returns the kind of an attribute's values.
    pub fn of_attribute(element: &str, name: &str) -> Option<Self> {
        Some(match name {
            "gradientTransform" | "patternTransform" => Self::Transform,
            "spreadMethod" => Self::Words(&["pad", "reflect", "repeat"]),
            "clipPathUnits"
            | "gradientUnits"
            | "maskContentUnits"
            | "maskUnits"
            | "patternContentUnits"
            | "patternUnits" => Self::Words(&["userSpaceOnUse", "objectBoundingBox"]),
            "viewBox" => Self::ViewBox,
            "d" if element == "path" => Self::Path,
            "points" if element == "polygon" || element == "polyline" => Self::Points,
            "cx" | "cy" | "fr" | "fx" | "fy" | "height" | "offset" | "r" | "rx" | "ry"
            | "width" | "x" | "x1" | "x2" | "y" | "y1" | "y2"
                if SIZED.contains(&element) =>
            {
                Self::Length { negative: !NOT_NEGATIVE.contains(&name) }
            }
            _ => return Self::of_property(name),
        })
    }

    /// Returns whether usvg understands a value.
    pub fn is_known(self, value: &str) -> bool {
        let length = || Length::from_str(value);
        match self {
            Self::Paint => svgtypes::Paint::from_str(value).is_ok(),
            Self::Color => value == "currentColor" || svgtypes::Color::from_str(value).is_ok(),
            Self::Length { negative } => {
                value == "auto" || length().is_ok_and(|l| negative || l.number >= 0.0)
            }
            Self::Lengths => {
                let fits = |l: Result<Length, _>| l.is_ok_and(|l: Length| l.number >= 0.0);
                value == "none" || LengthListParser::from(value).all(fits)
            }
            Self::Opacity => {
                length().is_ok_and(|l| matches!(l.unit, LengthUnit::None | LengthUnit::Percent))
            }
            Self::Number => svgtypes::Number::from_str(value).is_ok(),
            Self::Transform => value == "none" || svgtypes::Transform::from_str(value).is_ok(),
            Self::Functions => false,
            Self::Spacing => value == "normal" || length().is_ok(),
            Self::FontSize => {
                FONT_SIZES.iter().any(|(name, _)| *name == value)
                    || length().is_ok_and(|l| l.number >= 0.0)
            }
            Self::Points => {
                let mut count = 0;
                NumberListParser::from(value).inspect(|_| count += 1).all(|n| n.is_ok())
                    && count % 2 == 0
            }
            Self::Path => value == "none" || PathParser::from(value).all(|s| s.is_ok()),
            Self::ViewBox => svgtypes::ViewBox::from_str(value).is_ok(),
            Self::Words(words) => words.contains(&value),
        }
    }

    /// Returns a value in a form that usvg understands, if it can be used; `name` is the property's, and relative
    /// values refer to `around`.
    pub fn words<'v>(self, name: &str, value: &'v str, around: &Around) -> Option<Cow<'v, str>> {
        if self == Self::Path {
            return path(value);
        }
        let plain = value.trim();
        let has_functions = plain.contains('(');
        match self {
            Self::Paint | Self::Color if plain.eq_ignore_ascii_case("currentColor") => {
                return Some(Cow::Borrowed("currentColor"));
            }
            Self::Paint if has_functions || !self.is_known(value) => return paint(plain, around),
            Self::Color if has_functions || !self.is_known(value) => return color(plain, around),
            Self::Functions => {
                let _ = transform::parse(plain, &around.units, around.units.viewport)?;
                return Some(Cow::Borrowed(plain));
            }
            _ if self.is_known(value) => return Some(Cow::Borrowed(value)),
            _ => {}
        }
        if self.is_known(plain) {
            return Some(Cow::Borrowed(plain));
        }
        let lower = plain.to_ascii_lowercase();
        if self.is_known(&lower) {
            return Some(Cow::Owned(lower));
        }
        self.computed(name, plain, around).map(Cow::Owned)
    }

    /// Computes a value with functions or units that usvg does not know.
    fn computed(self, name: &str, value: &str, around: &Around) -> Option<String> {
        let units = &around.units;
        let length = |whole: f64| units.parse(value, Some(Whole::Length(whole)))?.length();
        // Computed values are clamped to the range; literal values must be in it.
        let in_range = |length: f64| match value.contains('(') {
            true => Some(length.max(0.0)),
            false => Some(length).filter(|length| *length >= 0.0),
        };
        let number = match self {
            Self::Length { negative: true } => length(whole_of(name, units))?,
            Self::Length { negative: false } => in_range(length(whole_of(name, units))?)?,
            Self::Spacing => length(units.font_size)?,
            Self::FontSize => in_range(length(units.font_size)?)?,
            Self::Opacity => {
                units.parse(value, Some(Whole::Number(1.0)))?.number()?.clamp(0.0, 1.0)
            }
            Self::Number => units.parse(value, None)?.number()?,
            Self::Lengths => return lengths(value, whole_of(name, units), units),
            _ => return None,
        };
        Some(number.to_string())
    }

    /// Returns advice: the expected values, and the effect of a wrong one.
    pub fn wanted(self) -> String {
        let wanted = match self {
            Self::Paint => "a colour, as `red` or `#c80000`, `none` or `url(#…)`",
            Self::Color => "a colour, as `red` or `#c80000`",
            Self::Length { negative: true } => "a length, as `12`, `3.5mm` or `20%`",
            Self::Length { negative: false } => "a length of at least 0, as `12`, `3.5mm` or `20%`",
            Self::Lengths => "lengths of at least 0, or `none`",
            Self::Opacity => "a number from 0 to 1, or a percentage",
            Self::Number => "a number",
            Self::Spacing => "`normal` or a length",
            Self::FontSize => "a length of at least 0, a percentage or a word as `large`",
            Self::Functions => "functions as `translate(10px, 5px)` and `rotate(45deg)`",
            Self::Transform => {
                "a list of `matrix`, `translate`, `scale`, `rotate`, `skewX` and `skewY`"
            }
            Self::Points => "pairs of numbers",
            Self::Path => "path data",
            Self::ViewBox => "four numbers, the last two above 0",
            Self::Words(words) => return format!("it must be one of {}", words.join(", ")),
        };
        format!("it must be {wanted}")
    }

    /// Returns the effect of a value that cannot be used.
    pub fn fate(self, name: &str, value: &str) -> Fate {
        match self {
            Self::Path | Self::Points => Fate::PartlyUsed,
            // Corners that are not round have no radii less than 0 but none.
            Self::Length { negative: false }
                if name != "rx" && name != "ry" && Length::from_str(value).is_ok() =>
            {
                Fate::Zero
            }
            _ => Fate::PassedOver,
        }
    }
}

/// Effect of a value that cannot be used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Fate {
    PassedOver,
    PartlyUsed,
    Zero,
}

impl Fate {
    pub fn in_words(self) -> &'static str {
        match self {
            Self::PassedOver => "it is ignored",
            Self::PartlyUsed => "the part before the error is drawn",
            Self::Zero => "it counts as 0",
        }
    }
}

/// Context of relative values.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Around {
    pub units: Units,
    /// Value of `currentColor`, if it is known.
    pub color: Option<Color>,
}

/// Keywords for font sizes, with their factors on the surrounding size or on `medium`, as in usvg.
const FONT_SIZES: [(&str, f64); 9] = [
    ("xx-small", 1.0 / 1.728),
    ("x-small", 1.0 / 1.44),
    ("small", 1.0 / 1.2),
    ("medium", 1.0),
    ("large", 1.2),
    ("x-large", 1.44),
    ("xx-large", 1.728),
    ("smaller", 1.0 / 1.2),
    ("larger", 1.2),
];

/// Returns the size of a font in pixels, where that around is known.
pub(super) fn font_size(value: &str, units: &Units) -> Option<f64> {
    match FONT_SIZES.iter().find(|(name, _)| *name == value) {
        Some((_, times)) => Some(units.font_size * times),
        None => units.parse(value, Some(Whole::Length(units.font_size)))?.length(),
    }
}

/// Returns the base of percentages of a property with that name, in pixels.
pub(super) fn whole_of(name: &str, units: &Units) -> f64 {
    let [width, height] = units.viewport;
    match name {
        "x" | "cx" | "rx" | "width" | "x1" | "x2" | "fx" | "dx" | "markerWidth" | "refX" => width,
        "y" | "cy" | "ry" | "height" | "y1" | "y2" | "fy" | "dy" | "markerHeight" | "refY" => {
            height
        }
        _ => libm::sqrt((width * width + height * height) / 2.0),
    }
}

/// Returns the path data, of CSS too, with curves in place of arcs.
fn path(value: &str) -> Option<Cow<'_, str>> {
    let plain = value.trim_start();
    if !plain.starts_with("path(") {
        return Some(arcs::as_curves(value).map_or(Cow::Borrowed(value), Cow::Owned));
    }
    let pieces = css::tokens(plain);
    let data = pieces.iter().find_map(|piece| match &piece.token {
        Token::String(data) => Some(data),
        _ => None,
    })?;
    Some(Cow::Owned(arcs::as_curves(data).unwrap_or_else(|| data.to_string())))
}

/// Returns a colour as usvg reads it.
fn color(value: &str, around: &Around) -> Option<Cow<'static, str>> {
    let [r, g, b, a] = css::color_within(value, around.color)?.bytes();
    Some(Cow::Owned(match a {
        255 => format!("#{r:02x}{g:02x}{b:02x}"),
        _ => format!("#{r:02x}{g:02x}{b:02x}{a:02x}"),
    }))
}

/// Returns a paint: its reference stays; its colour, or fallback colour, is written as usvg reads it.
fn paint<'v>(value: &'v str, around: &Around) -> Option<Cow<'v, str>> {
    if !value.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("url(")) {
        let lower = value.to_ascii_lowercase();
        return color(value, around)
            .or_else(|| Kind::Paint.is_known(&lower).then_some(Cow::Owned(lower)));
    }
    let (link, fallback) = value.split_at(value.find(')')? + 1);
    let fallback = match fallback.trim() {
        // Pictures and elements of other files are not paint.
        "" if is_elsewhere(link) => return Some(Cow::Borrowed("none")),
        fallback => fallback,
    };
    let known = |words: &str| words.is_empty() || words == "none" || words == "currentColor";
    if known(fallback) || fallback.starts_with("icc-color") {
        return Some(Cow::Borrowed(value));
    }
    let words = match fallback.to_ascii_lowercase().as_str() {
        "none" => Cow::Borrowed("none"),
        "currentcolor" => Cow::Borrowed("currentColor"),
        _ => color(fallback, around)?,
    };
    Some(Cow::Owned(format!("{link} {words}")))
}

/// Returns whether a `url(…)` refers to another file.
pub(super) fn is_elsewhere(link: &str) -> bool {
    let inner = link.get(4..).unwrap_or_default().trim_end_matches(')');
    !inner.trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\'').starts_with('#')
}

/// Returns lengths in pixels.
fn lengths(value: &str, whole: f64, units: &Units) -> Option<String> {
    let pieces = css::tokens(value);
    let mut out = String::new();
    for part in css::split(&pieces, ',').into_iter().flat_map(css::words) {
        let length = units.value(part, Some(Whole::Length(whole)))?.length();
        out.push_str(&format!("{} ", length.filter(|length| *length >= 0.0)?));
    }
    Some(out)
}

/// Returns whether usvg draws elements with this transform.
pub(super) fn can_be_drawn(value: &str) -> bool {
    svgtypes::Transform::from_str(value).ok().is_none_or(|t| {
        let [a, b, c, d, e, f] = [t.a, t.b, t.c, t.d, t.e, t.f].map(|v| v as f32);
        usvg::Transform::from_row(a, b, c, d, e, f).is_valid()
    })
}
