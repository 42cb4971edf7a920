//! Colours of CSS, as documents and options say them.

use std::str::FromStr;

/// The one name that CSS 4 adds to the colours of CSS 3, which svgtypes and usvg do not know, and the same in words
/// that they do.
const REBECCA_PURPLE: (&str, &str) = ("rebeccapurple", "#663399");

/// A colour of CSS as sRGB bytes with straight alpha: a name of CSS 4 or `transparent` in letters of any case, `#rgb`, `#rrggbb`
/// (both also with alpha), `rgb()`, `rgba()`, `hsl()` or `hsla()`; `None` for other text.
///
/// ```
/// use durer_formats::css::color;
/// assert_eq!(color("RebeccaPurple"), Some([0x66, 0x33, 0x99, 255]));
/// assert_eq!(color("hsl(120,100%,25%)"), color("#008000"));
/// assert_eq!(color("reddish"), None);
/// ```
///
/// Cost: linear in the length of the text. Source: *CSS Color Module Level 4*, W3C.
pub fn color(text: &str) -> Option<[u8; 4]> {
    let text = text.to_ascii_lowercase();
    let color = svgtypes::Color::from_str(in_other_words(&text).unwrap_or(&text)).ok()?;
    Some([color.red, color.green, color.blue, color.alpha])
}

/// A name of a colour, in letters of any case, in words that svgtypes and usvg understand; `None` where it is in such words.
pub(crate) fn in_other_words(name: &str) -> Option<&'static str> {
    name.trim().eq_ignore_ascii_case(REBECCA_PURPLE.0).then_some(REBECCA_PURPLE.1)
}

/// Where such a name stands in a text, in small letters, and the other words.
pub(crate) fn names_to_replace(text: &str) -> impl Iterator<Item = (usize, &str, &'static str)> {
    let (name, words) = REBECCA_PURPLE;
    text.match_indices(name).map(move |(at, name)| (at, name, words))
}
