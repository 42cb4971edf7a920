//! Colours and backgrounds as options take them.

use durer::math::Vec4;
use durer::pipeline::Background;
use durer::shade::color::LINEAR_FROM_SRGB;

/// Colours of `--background gradient`: a bright sky over a light grey.
const GRADIENT: (&str, &str) = ("#9fb7d4", "#f2f4f7");

/// Parses a linear RGBA colour; takes the same texts as [`bytes`].
pub fn color(text: &str) -> Result<Vec4, String> {
    let [r, g, b, a] = bytes(text)?;
    let linear = |channel: u8| LINEAR_FROM_SRGB[usize::from(channel)];
    Ok(Vec4::new(linear(r), linear(g), linear(b), f32::from(a) / 255.0))
}

/// Returns a colour of CSS as sRGB bytes with straight alpha: a name of CSS 4, `#rgb`, `#rrggbb` (both also
/// with alpha), `rgb()`, `rgba()`, `hsl()` or `hsla()`.
pub fn bytes(text: &str) -> Result<[u8; 4], String> {
    durer_formats::css::color(text).ok_or_else(|| {
        "a colour is a name of CSS 4, #rgb, #rrggbb, #rrggbbaa, rgb(R,G,B), rgba(R,G,B,A) or hsl(H,S%,L%)"
            .to_owned()
    })
}

/// Returns a colour, `gradient`, or `TOP,BOTTOM`.
pub fn background(text: &str) -> Result<Background, String> {
    match split(text) {
        _ if text == "gradient" => Ok(Background::Gradient(color(GRADIENT.0)?, color(GRADIENT.1)?)),
        Some((top, bottom)) => Ok(Background::Gradient(color(top.trim())?, color(bottom.trim())?)),
        None => color(text)
            .map(Background::Color)
            .map_err(|e| format!("{e}; or `gradient`, or two colours TOP,BOTTOM")),
    }
}

/// Splits at the first comma outside brackets.
fn split(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0;
    let comma = text.find(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    })?;
    Some((text.get(..comma)?, text.get(comma + 1..)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_spellings_of_a_color() {
        let red = Vec4::new(1.0, 0.0, 0.0, 1.0);
        for text in ["red", "RED", "#f00", "#f00f", "#ff0000", "#FF0000ff"] {
            let c = color(text).unwrap();
            assert!((c - red).abs().max_element() < 1e-6, "{text}: {c}");
        }
        assert_eq!(color("transparent").unwrap(), Vec4::ZERO);
        assert!((color("#80808080").unwrap().w - 128.0 / 255.0).abs() < 1e-6);
        assert!((color("#808080").unwrap().x - 0.215_86).abs() < 1e-4);
        for (text, expected) in [
            ("papayawhip", [255, 239, 213, 255]),
            ("LightGrey", [211, 211, 211, 255]),
            ("RebeccaPurple", [0x66, 0x33, 0x99, 255]),
            ("rgb(1, 2,3)", [1, 2, 3, 255]),
            ("rgba(255,0,0,0)", [255, 0, 0, 0]),
            ("hsl(120,100%,25%)", [0, 128, 0, 255]),
            ("#1234", [0x11, 0x22, 0x33, 0x44]),
        ] {
            assert_eq!(bytes(text), Ok(expected), "{text}");
        }
        for wrong in [
            "", "#", "#12", "#12345", "#gggggg", "#+12345", "reddish", "1,2,3", "rgb(1,2",
            "red blue",
        ] {
            assert!(color(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn gradients_have_a_top_and_a_bottom() {
        let (white, black) = (color("white").unwrap(), color("black").unwrap());
        assert_eq!(background("white,black").unwrap(), Background::Gradient(white, black));
        assert_eq!(background("white").unwrap(), Background::Color(white));
        assert!(matches!(background("gradient").unwrap(), Background::Gradient(..)));
        assert!(background("white,black,white").is_err());
        let spelled = background("rgb(255,255,255), hsl(0,0%,0%)").unwrap();
        assert_eq!(spelled, Background::Gradient(white, black));
        assert_eq!(background("rgb(0,0,0)").unwrap(), Background::Color(black));
    }
}
