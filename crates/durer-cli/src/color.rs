//! Colours and backgrounds as options take them.

use durer::math::Vec4;
use durer::pipeline::Background;
use durer::shade::color::LINEAR_FROM_SRGB;

/// Names that can stand for a colour: those of CSS level 1, a few more greys, `transparent`.
const NAMES: [(&str, u32); 22] = [
    ("black", 0x0000_00ff),
    ("white", 0xffff_ffff),
    ("transparent", 0x0000_0000),
    ("gray", 0x8080_80ff),
    ("grey", 0x8080_80ff),
    ("silver", 0xc0c0_c0ff),
    ("lightgray", 0xd3d3_d3ff),
    ("lightgrey", 0xd3d3_d3ff),
    ("darkgray", 0xa9a9_a9ff),
    ("darkgrey", 0xa9a9_a9ff),
    ("red", 0xff00_00ff),
    ("maroon", 0x8000_00ff),
    ("orange", 0xffa5_00ff),
    ("yellow", 0xffff_00ff),
    ("olive", 0x8080_00ff),
    ("lime", 0x00ff_00ff),
    ("green", 0x0080_00ff),
    ("aqua", 0x00ff_ffff),
    ("teal", 0x0080_80ff),
    ("blue", 0x0000_ffff),
    ("navy", 0x0000_80ff),
    ("purple", 0x8000_80ff),
];

/// What `--background gradient` means: a bright sky over a light grey.
const GRADIENT: (&str, &str) = ("#9fb7d4", "#f2f4f7");

/// A linear RGBA colour from `#rgb`, `#rgba`, `#rrggbb`, `#rrggbbaa` or a name.
pub fn color(text: &str) -> Result<Vec4, String> {
    let [r, g, b, a] = bytes(text)?;
    let linear = |channel: u8| LINEAR_FROM_SRGB[usize::from(channel)];
    Ok(Vec4::new(linear(r), linear(g), linear(b), f32::from(a) / 255.0))
}

/// The same as sRGB bytes with straight alpha.
pub fn bytes(text: &str) -> Result<[u8; 4], String> {
    let rgba = match text.strip_prefix('#') {
        Some(digits) => hexadecimal(digits),
        None => NAMES.iter().find(|(name, _)| text.eq_ignore_ascii_case(name)).map(|n| n.1),
    };
    rgba.map(u32::to_be_bytes).ok_or_else(wanted)
}

fn wanted() -> String {
    let names: Vec<&str> = NAMES.iter().map(|n| n.0).filter(|n| !n.contains("grey")).collect();
    format!("a colour is #rgb, #rrggbb, #rrggbbaa or one of {}", names.join(", "))
}

/// 0xRRGGBBAA from 3, 4, 6 or 8 hexadecimal digits.
fn hexadecimal(digits: &str) -> Option<u32> {
    if !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let value = u32::from_str_radix(digits, 16).ok()?;
    let doubled = |v: u32| (0..4).fold(0, |sum, i| sum | (((v >> (4 * i)) & 15) * 17) << (8 * i));
    match digits.len() {
        3 => Some(doubled(value << 4 | 15)),
        4 => Some(doubled(value)),
        6 => Some(value << 8 | 255),
        8 => Some(value),
        _ => None,
    }
}

/// A colour, `gradient`, or `TOP,BOTTOM`.
pub fn background(text: &str) -> Result<Background, String> {
    match text.split_once(',') {
        _ if text == "gradient" => Ok(Background::Gradient(color(GRADIENT.0)?, color(GRADIENT.1)?)),
        Some((top, bottom)) => Ok(Background::Gradient(color(top.trim())?, color(bottom.trim())?)),
        None => color(text)
            .map(Background::Color)
            .map_err(|e| format!("{e}; or `gradient`, or two colours TOP,BOTTOM")),
    }
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
        for wrong in ["", "#", "#12", "#12345", "#gggggg", "#+12345", "reddish", "1,2,3"] {
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
    }
}
