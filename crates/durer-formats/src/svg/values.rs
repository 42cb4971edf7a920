//! Values that usvg would pass over in silence, or take for something else.
//!
//! What cannot be used is told with its place and taken out: then what is inherited or the default counts, as CSS
//! has it. What can be used but is unknown to usvg is put in other words.

use super::{ROOT, arcs};
use crate::{Place, Warning, css};
use std::collections::BTreeSet;
use std::ops::Range;
use std::str::FromStr;
use svgtypes::{Color, Length, LengthListParser, LengthUnit, NumberListParser, PathParser};
use usvg::roxmltree::{Document, Node};

/// Letters of a value that a warning shows.
const SHOWN: usize = 40;

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

/// What an attribute or a property may be.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Paint,
    Color,
    Length { negative: bool },
    Lengths,
    Opacity,
    Number,
    Transform,
    Points,
    Path,
    ViewBox,
    Words(&'static [&'static str]),
}

impl Kind {
    /// What a property may be, of style sheets too; `None` for those that are not looked at.
    fn of_property(name: &str) -> Option<Self> {
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
            "transform" => Self::Transform,
            _ => return None,
        })
    }

    /// What an attribute may be.
    fn of_attribute(element: &str, name: &str) -> Option<Self> {
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

    fn allows(self, value: &str) -> bool {
        let length = || Length::from_str(value);
        value == "inherit"
            || match self {
                Self::Paint => svgtypes::Paint::from_str(value).is_ok(),
                Self::Color => value == "currentColor" || Color::from_str(value).is_ok(),
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

    /// What would be right, and what becomes of it.
    fn wanted(self) -> String {
        let wanted = match self {
            Self::Paint => "a colour, as `red` or `#c80000`, `none` or `url(#…)`",
            Self::Color => "a colour, as `red` or `#c80000`",
            Self::Length { negative: true } => "a length, as `12`, `3.5mm` or `20%`",
            Self::Length { negative: false } => "a length of at least 0, as `12`, `3.5mm` or `20%`",
            Self::Lengths => "lengths of at least 0, or `none`",
            Self::Opacity => "a number from 0 to 1, or a percentage",
            Self::Number => "a number",
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

    /// What becomes of a value that cannot be used.
    fn fate(self, name: &str, value: &str) -> Fate {
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

/// What becomes of a value that cannot be used.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fate {
    PassedOver,
    PartlyUsed,
    Zero,
}

impl Fate {
    fn in_words(self) -> &'static str {
        match self {
            Self::PassedOver => "it is passed over",
            Self::PartlyUsed => "what comes before the error is drawn",
            Self::Zero => "it counts as 0",
        }
    }
}

/// A value that means the same and that usvg knows.
fn other_words(kind: Kind, value: &str) -> Option<String> {
    if kind == Kind::Path {
        return arcs::as_curves(value);
    }
    let plain = value.trim();
    if matches!(kind, Kind::Paint | Kind::Color) {
        if let Some(words) = css::in_other_words(plain) {
            return Some(words.to_owned());
        }
        if plain.eq_ignore_ascii_case("currentColor") && value != "currentColor" {
            return Some("currentColor".to_owned());
        }
    }
    if kind.allows(value) {
        return None;
    }
    [plain.to_owned(), plain.to_ascii_lowercase()].into_iter().find(|value| kind.allows(value))
}

/// What was found in a document.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub warnings: Vec<Warning>,
    /// Parts of the text and what has to stand there instead, in order.
    changes: Vec<(Range<usize>, String)>,
    /// What has been told.
    seen: BTreeSet<String>,
}

impl Found {
    /// Looks at all values of a document.
    pub fn new(document: &Document<'_>) -> Self {
        let mut found = Self::default();
        for node in document.descendants().filter(is_drawn) {
            let element = node.tag_name().name();
            for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
                let (name, value) = (attribute.name(), attribute.value());
                let place = || place(document, attribute.range().start);
                if name == "style" {
                    found.style(value, element, &place());
                    found.colors(document, attribute.range_value());
                } else if let Some(kind) = Kind::of_attribute(element, name) {
                    let changes = found.changes.len();
                    if let Some(value) = other_words(kind, value) {
                        found.changes.push((attribute.range_value(), value));
                    }
                    let known = found.changes.len() > changes && kind != Kind::Path;
                    let told = !known && found.value(kind, (name, value), element, &place());
                    if told && kind.fate(name, value) == Fate::PassedOver {
                        found.changes.push((attribute.range(), String::new()));
                    }
                }
            }
            if element == "style" {
                found.sheet(document, node);
            }
        }
        found.changes.sort_by_key(|(range, _)| range.start);
        found
    }

    /// The document in words that usvg understands; `None` where it is so already.
    pub fn amended(&self, text: &str) -> Option<String> {
        let (mut out, mut at) = (String::with_capacity(text.len()), 0);
        for (range, words) in &self.changes {
            // What an entity stands for is found wherever it is used.
            if range.start >= at {
                out.push_str(text.get(at..range.start)?);
                out.push_str(words);
                at = range.end;
            }
        }
        out.push_str(text.get(at..)?);
        (!self.changes.is_empty()).then_some(out)
    }

    /// Tells what is wrong with a value; whether anything is.
    fn value(&mut self, kind: Kind, said: (&str, &str), element: &str, place: &Place) -> bool {
        let (name, value) = said;
        if kind.allows(value) {
            if kind == Kind::Transform && !can_be_drawn(value) {
                let what = "it makes everything smaller than 10⁻⁷ of its size, or flat, or reaches beyond all numbers; what \
                            it applies to is left out";
                self.tell(said, element, place, what);
            }
            return false;
        }
        if !value.trim().is_empty() {
            let fate = kind.fate(name, value).in_words();
            self.tell((name, value), element, place, &format!("{}; {fate}", kind.wanted()));
        }
        true
    }

    fn tell(&mut self, (name, value): (&str, &str), element: &str, place: &Place, what: &str) {
        let mut shown: String = value.trim().chars().take(SHOWN).collect();
        if shown.len() < value.trim().len() {
            shown.push('…');
        }
        if self.seen.insert(format!("{name} {value}")) {
            let message = format!("`{name}` of `{element}` is `{shown}`: {what}");
            self.warnings.push(Warning { place: place.clone(), message });
        }
    }

    /// The declarations of a `style` attribute.
    fn style(&mut self, text: &str, element: &str, place: &Place) {
        for said in simplecss::DeclarationTokenizer::from(text) {
            self.declaration(&said, element, place);
        }
    }

    /// A style sheet.
    fn sheet(&mut self, document: &Document<'_>, node: Node<'_, '_>) {
        let place = place(document, node.range().start);
        for text in node.children().filter(Node::is_text) {
            let sheet = simplecss::StyleSheet::parse(text.text().unwrap_or_default());
            for said in sheet.rules.iter().flat_map(|rule| &rule.declarations) {
                self.declaration(said, "style", &place);
            }
            self.colors(document, text.range());
        }
    }

    fn declaration(&mut self, said: &simplecss::Declaration<'_>, element: &str, place: &Place) {
        let Some(kind) = Kind::of_property(said.name) else { return };
        if css::in_other_words(said.value).is_none() {
            self.value(kind, (said.name, said.value), element, place);
        }
    }

    /// Puts colours of declarations that usvg does not know in other words.
    fn colors(&mut self, document: &Document<'_>, range: Range<usize>) {
        let Some(text) = document.input_text().get(range.clone()) else { return };
        for (at, name, words) in css::names_to_replace(text) {
            if text.get(..at).is_some_and(|before| before.trim_end().ends_with(':')) {
                let start = range.start + at;
                self.changes.push((start..start + name.len(), words.to_owned()));
            }
        }
    }
}

/// Elements of SVG but those of animations, whose `fill` is something else.
fn is_drawn(node: &Node<'_, '_>) -> bool {
    let name = node.tag_name();
    node.is_element()
        && name.namespace().is_none_or(|space| space == ROOT.0)
        && !name.name().starts_with("animate")
        && name.name() != "set"
}

/// Whether usvg draws what has this transform.
fn can_be_drawn(value: &str) -> bool {
    svgtypes::Transform::from_str(value).ok().is_none_or(|t| {
        let [a, b, c, d, e, f] = [t.a, t.b, t.c, t.d, t.e, t.f].map(|v| v as f32);
        usvg::Transform::from_row(a, b, c, d, e, f).is_valid()
    })
}

fn place(document: &Document<'_>, at: usize) -> Place {
    let at = document.text_pos_at(at);
    Place::Line(at.row.into(), at.col.into())
}
