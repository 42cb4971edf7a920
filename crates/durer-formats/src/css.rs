//! Colours of CSS, as documents and options say them; tokens, lengths and computed values of CSS.

mod functions;
mod spaces;
mod tokens;
mod units;

pub(crate) use functions::{split, words};
pub(crate) use spaces::Color;
pub(crate) use tokens::{Piece, Token, tokens};
pub(crate) use units::{Units, Whole};

use std::str::FromStr;

/// The one colour name that CSS 4 adds to CSS 3, which svgtypes does not know, and its value in a form that it does.
const REBECCA_PURPLE: (&str, &str) = ("rebeccapurple", "#663399");

/// Returns a colour of CSS as sRGB bytes with straight alpha: a name of CSS 4 or `transparent` in letters of any case,
/// `#rgb`, `#rrggbb` (both also with alpha), `rgb()`, `hsl()`, `hwb()`, `lab()`, `lch()`, `oklab()`, `oklch()`,
/// `color()`, `color-mix()` or `light-dark()`, whose light colour is taken; `None` for other text. Colours outside of
/// sRGB are clamped.
///
/// ```
/// use durer_formats::css::color;
/// assert_eq!(color("RebeccaPurple"), Some([0x66, 0x33, 0x99, 255]));
/// assert_eq!(color("hsl(120,100%,25%)"), color("#008000"));
/// assert_eq!(color("rgb(255 0 0 / 50%)"), Some([255, 0, 0, 128]));
/// assert_eq!(color("color-mix(in srgb, red, blue)"), Some([128, 0, 128, 255]));
/// assert_eq!(color("reddish"), None);
/// ```
///
/// Cost: linear in the length of the text. Source: *CSS Color Module Level 4* and *Level 5*, W3C.
pub fn color(text: &str) -> Option<[u8; 4]> {
    color_within(text, None).map(Color::bytes)
}

/// Parses like [`color`], with `current` as the value of `currentColor`.
pub(crate) fn color_within(text: &str, current: Option<Color>) -> Option<Color> {
    let text = text.trim();
    match text.contains('(') {
        true => functions::parse(text, current),
        false if text.eq_ignore_ascii_case("currentcolor") => current,
        false => simple(text).map(Color::of_bytes),
    }
}

/// Returns a colour that is a name or a number with `#`.
fn simple(text: &str) -> Option<[u8; 4]> {
    let text = text.to_ascii_lowercase();
    let words = if text == REBECCA_PURPLE.0 { REBECCA_PURPLE.1 } else { &text };
    let color = svgtypes::Color::from_str(words).ok()?;
    Some([color.red, color.green, color.blue, color.alpha])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected values are those of the specification's examples and of its tests (WPT, css/css-color).
    #[test]
    fn colors_of_css_4_and_5() {
        for (text, expected) in [
            ("rgb(10% 50% 90% / 50%)", [26, 128, 230, 128]),
            ("rgba(0,0,255,.5)", [0, 0, 255, 128]),
            ("rgb(300 -5 0)", [255, 0, 0, 255]),
            ("rgb(calc(255 / 2) none 0)", [128, 0, 0, 255]),
            ("hsl(120deg 100% 25%)", [0, 128, 0, 255]),
            ("hsla(-240, 100%, 25%, 100%)", [0, 128, 0, 255]),
            ("hsl(120, 200%, 25%)", [0, 128, 0, 255]),
            ("hsl(.5turn 100 50)", [0, 255, 255, 255]),
            ("hwb(90deg 20% 40%)", [102, 153, 51, 255]),
            ("hwb(0 60% 60%)", [128, 128, 128, 255]),
            ("lab(46.2775% -47.5621 48.5837)", [0, 128, 0, 255]),
            ("lch(46.2775% 67.9892 134.3912)", [0, 128, 0, 255]),
            ("oklab(51.975% -0.1403 0.10768)", [0, 128, 0, 255]),
            ("oklch(51.975% 0.17686 142.495)", [0, 128, 0, 255]),
            ("oklch(100% 0 none)", [255, 255, 255, 255]),
            ("color(srgb 0 50.2% 0 / .5)", [0, 128, 0, 128]),
            ("color(srgb-linear 0 .21586 0)", [0, 128, 0, 255]),
            ("color(display-p3 0.21604 0.49418 0.13151)", [0, 128, 0, 255]),
            ("color(xyz 0.07719 0.15438 0.02573)", [0, 128, 0, 255]),
            ("color-mix(in srgb, white 30%, black)", [77, 77, 77, 255]),
            ("color-mix(in srgb, 20% red, 20% blue)", [128, 0, 128, 102]),
            ("color-mix(in srgb, transparent, red)", [255, 0, 0, 128]),
            ("color-mix(in oklab, white, black)", [99, 99, 99, 255]),
            ("color-mix(in hsl, red, lime)", [255, 255, 0, 255]),
            ("color-mix(in hsl, hsl(350 100% 50%), hsl(10 100% 50%))", [255, 0, 0, 255]),
            ("light-dark(#123, white)", [0x11, 0x22, 0x33, 255]),
            ("#F008", [255, 0, 0, 136]),
        ] {
            assert_eq!(color(text), Some(expected), "{text}");
        }
        let green = Color::of_bytes([0, 128, 0, 255]);
        let mixed = color_within("color-mix(in srgb, CurrentColor 50%, white)", Some(green));
        assert_eq!(mixed.map(Color::bytes), Some([128, 192, 128, 255]));
    }

    #[test]
    fn what_is_no_color() {
        for text in [
            "",
            "#",
            "#12345",
            "rgb()",
            "rgb(1 2)",
            "rgb(1 2 3 4)",
            "rgb(1, 2, 3, 4, 5)",
            "rgba(0, 50%, 0, 0.5)",
            "rgb(1px 2 3)",
            "hsl(10px 1% 2%)",
            "color(cmyk 0 0 0)",
            "color-mix(red, blue)",
            "color-mix(in srgb, red 0%, blue 0%)",
            "rgb(1 2 3 / 4 / 5)",
            "rgb(from red r g b)",
            "red blue",
            "currentColor",
            "é",
        ] {
            assert_eq!(color(text), None, "{text}");
        }
        assert_eq!(color(&"light-dark(".repeat(5000)), None);
    }
}
