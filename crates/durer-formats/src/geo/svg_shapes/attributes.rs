//! Parsers for attributes of SVG: matrices, lengths, properties, and the numbers in all of them.

use crate::foreign;
use durer::math::DVec2;
use quick_xml::events::BytesStart;

/// The matrix (a, b, c, d, e, f) of SVG: x' = a·x + c·y + e, y' = b·x + d·y + f.
pub type Matrix = [f64; 6];

pub const UPRIGHT: Matrix = [1.0, 0.0, 0.0, -1.0, 0.0, 0.0];

/// Absolute units of CSS 2, in pixels.
const UNITS: [(&str, f64); 7] = [
    ("px", 1.0),
    ("in", 96.0),
    ("cm", 96.0 / 2.54),
    ("mm", 9.6 / 2.54),
    ("q", 2.4 / 2.54),
    ("pt", 96.0 / 72.0),
    ("pc", 16.0),
];

pub fn apply(m: &Matrix, p: DVec2) -> DVec2 {
    DVec2::new(m[0] * p.x + m[2] * p.y + m[4], m[1] * p.x + m[3] * p.y + m[5])
}

/// Returns the matrix that applies `inner`, then `outer`.
pub fn compose(outer: &Matrix, inner: &Matrix) -> Matrix {
    let linear = [outer[0], outer[1], outer[2], outer[3], 0.0, 0.0];
    let x = apply(&linear, DVec2::new(inner[0], inner[1]));
    let y = apply(&linear, DVec2::new(inner[2], inner[3]));
    let o = apply(outer, DVec2::new(inner[4], inner[5]));
    [x.x, x.y, y.x, y.y, o.x, o.y]
}

pub fn attribute(element: &BytesStart<'_>, name: &str) -> Result<Option<String>, String> {
    let found = element.try_get_attribute(name).map_err(|e| foreign::xml(&e.into()))?;
    let Some(found) = found else { return Ok(None) };
    quick_xml::escape::unescape(&found.value)
        .map(|t| Some(t.into_owned()))
        .map_err(|_| foreign::entity())
}

/// Returns the target of `href`, of SVG 2 or of XLink.
pub fn reference(element: &BytesStart<'_>) -> Result<Option<String>, String> {
    Ok(attribute(element, "href")?.or(attribute(element, "xlink:href")?))
}

/// Returns a length in pixels.
pub fn length(element: &BytesStart<'_>, name: &str) -> Result<Option<f64>, String> {
    let text = attribute(element, name)?.unwrap_or_default();
    let mut scanner = Scanner::new(&text);
    let Some(value) = scanner.number()? else { return Ok(None) };
    let unit = String::from_utf8_lossy(scanner.rest).trim().to_ascii_lowercase();
    if unit.is_empty() {
        return Ok(Some(value));
    }
    let known = UNITS.iter().find(|(known, _)| *known == unit);
    let (_, pixels) = known.ok_or_else(|| {
        let text = crate::text::quote(text.as_bytes());
        format!("`{name}` is `{text}`; a number, or one in px, in, cm, mm, q, pt or pc is expected")
    })?;
    Ok(Some(value * pixels))
}

/// Returns an element's own value for a property that takes one of a few keywords: its style takes precedence over its
/// attribute. `inherit` gives `None`; other words are ignored.
pub fn property<T: Copy>(
    element: &BytesStart<'_>,
    name: &str,
    words: &[(&str, T)],
    notes: &mut Vec<String>,
) -> Result<Option<T>, String> {
    let style = attribute(element, "style")?.unwrap_or_default();
    let given = match declared(&style, name) {
        Some(value) => Some(value),
        None => attribute(element, name)?,
    };
    let Some(given) = given else { return Ok(None) };
    let word = given.trim();
    let found = words.iter().find(|(known, _)| word.eq_ignore_ascii_case(known));
    let inherits = ["inherit", "unset", "initial"].iter().any(|w| word.eq_ignore_ascii_case(w));
    // `display` has many keywords; only `none` hides.
    if found.is_none() && !inherits && words.len() > 1 {
        let known: Vec<&str> = words.iter().map(|(known, _)| *known).collect();
        let word = crate::text::quote(word.as_bytes());
        notes.push(format!("`{name}` is `{word}`, not one of {}; it is ignored", known.join(", ")));
    }
    Ok(found.map(|(_, value)| *value))
}

/// Returns the value that declarations of CSS give a property: the last of several, but important ones take precedence.
/// simplecss, which usvg uses, stops at the first declaration that it cannot read, such as `font:12px/1.5 serif` or
/// `--own:1`.
fn declared(style: &str, property: &str) -> Option<String> {
    let style = without_comments(style);
    let mut found: Option<(bool, &str)> = None;
    for (name, value) in style.split(';').filter_map(|declaration| declaration.split_once(':')) {
        if !name.trim().eq_ignore_ascii_case(property) {
            continue;
        }
        let (value, is_important) = match value.rsplit_once('!') {
            Some((value, word)) if word.trim().eq_ignore_ascii_case("important") => (value, true),
            _ => (value, false),
        };
        if is_important || found.is_none_or(|(is_important, _)| !is_important) {
            found = Some((is_important, value));
        }
    }
    found.map(|(_, value)| value.trim().to_owned())
}

fn without_comments(style: &str) -> String {
    let (mut out, mut rest) = (String::new(), style);
    while let Some((before, comment)) = rest.split_once("/*") {
        out.push_str(before);
        rest = comment.split_once("*/").map_or("", |(_, after)| after);
    }
    out + rest
}

pub fn transforms(text: &str) -> Result<Matrix, String> {
    let mut all = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    for part in text.split(')').map(|p| p.trim_matches([' ', ',', '\n', '\t', '\r'])) {
        if part.is_empty() {
            continue;
        }
        let (name, numbers) = part.split_once('(').ok_or("a transform needs brackets")?;
        let numbers = Scanner::new(numbers).all()?;
        let matrix = match (name.trim(), &numbers[..]) {
            ("matrix", &[a, b, c, d, e, f]) => [a, b, c, d, e, f],
            ("translate", &[x]) => [1.0, 0.0, 0.0, 1.0, x, 0.0],
            ("translate", &[x, y]) => [1.0, 0.0, 0.0, 1.0, x, y],
            ("scale", &[s]) => [s, 0.0, 0.0, s, 0.0, 0.0],
            ("scale", &[x, y]) => [x, 0.0, 0.0, y, 0.0, 0.0],
            ("rotate", &[angle]) => rotation(angle, DVec2::ZERO),
            ("rotate", &[angle, x, y]) => rotation(angle, DVec2::new(x, y)),
            _ => {
                return Err(format!(
                    "the transform `{}` is not known",
                    crate::text::quote(part.as_bytes())
                ));
            }
        };
        all = compose(&all, &matrix);
    }
    Ok(all)
}

fn rotation(degrees: f64, center: DVec2) -> Matrix {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let (x, y) = (center.x, center.y);
    [cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y]
}

/// Returns all numbers of a text.
pub fn numbers(text: &str) -> Result<Vec<f64>, String> {
    Scanner::new(text).all()
}

/// Numbers and letters, parted by blanks and commas or nothing.
pub struct Scanner<'a> {
    rest: &'a [u8],
}

impl<'a> Scanner<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { rest: text.as_bytes() }
    }

    fn skip(&mut self) {
        while let [b' ' | b',' | b'\t' | b'\n' | b'\r', rest @ ..] = self.rest {
            self.rest = rest;
        }
    }

    pub fn at_end(&mut self) -> bool {
        self.skip();
        self.rest.is_empty()
    }

    pub fn letter(&mut self) -> Option<char> {
        self.skip();
        let (first, rest) = self.rest.split_first().filter(|(b, _)| b.is_ascii_alphabetic())?;
        self.rest = rest;
        Some(char::from(*first))
    }

    /// Returns a number, or `None` at the end.
    pub fn number(&mut self) -> Result<Option<f64>, String> {
        if self.at_end() {
            return Ok(None);
        }
        let found = crate::number::float(self.rest).filter(|(value, _)| value.is_finite());
        let (value, length) = found.ok_or_else(|| {
            format!("a number is expected, not `{}`", crate::text::quote(self.rest))
        })?;
        self.rest = self.rest.get(length..).unwrap_or_default();
        Ok(Some(value))
    }

    pub fn need(&mut self) -> Result<f64, String> {
        self.number()?.ok_or_else(|| "a number is missing at the end".to_owned())
    }

    /// Returns a flag of an arc, which needs no separator after it.
    pub fn flag(&mut self) -> Result<bool, String> {
        self.skip();
        match self.rest {
            [flag @ (b'0' | b'1'), rest @ ..] => {
                self.rest = rest;
                Ok(*flag == b'1')
            }
            _ => Err("a flag of an arc must be 0 or 1".to_owned()),
        }
    }

    pub fn pair(&mut self) -> Result<DVec2, String> {
        Ok(DVec2::new(self.need()?, self.need()?))
    }

    fn all(mut self) -> Result<Vec<f64>, String> {
        let mut numbers = Vec::new();
        while let Some(number) = self.number()? {
            numbers.push(number);
        }
        Ok(numbers)
    }
}
