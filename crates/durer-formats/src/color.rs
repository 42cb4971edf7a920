//! The transfer function of sRGB, and the material of vertex colours.

use durer::math::{Vec3, Vec4, powf};
use durer::scene::Material;

/// Returns linear light from an sRGB value, IEC 61966-2-1; values above 1 follow the same curve.
pub(crate) fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { powf((srgb + 0.055) / 1.055, 2.4) }
}

/// Applies [`linear`] to three channels.
pub(crate) fn linear3(srgb: [f32; 3]) -> Vec3 {
    Vec3::from_array(srgb.map(linear))
}

/// Returns [`linear`] of all 256 bytes, for formats that store colours as bytes.
pub(crate) fn linear_bytes() -> [f32; 256] {
    std::array::from_fn(|i| linear(i as f32 / 255.0))
}

/// Returns the linear colour of `#RRGGBB` or `#RRGGBBAA`, sRGB; `None` for other texts.
pub(crate) fn hex(text: &str) -> Option<Vec4> {
    let digits = text.strip_prefix('#').filter(|d| matches!(d.len(), 6 | 8))?;
    let digits = Some(digits).filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit()))?;
    let bits = u32::from_str_radix(digits, 16).ok()?;
    let bits = if digits.len() == 6 { bits << 8 | 0xff } else { bits };
    let [r, g, b, a] = bits.to_be_bytes().map(|v| f32::from(v) / 255.0);
    Some(linear3([r, g, b]).extend(a))
}

/// The name of the material that shows vertex colours.
pub(crate) const VERTEX_COLORS: &str = "vertex colors";

/// Returns the material that shows vertex colors unchanged: the default material, but white.
pub(crate) fn vertex_color_material() -> Material {
    Material { name: VERTEX_COLORS.to_owned(), base_color: Vec4::ONE, ..Material::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hexadecimal_colors() {
        assert_eq!(hex("#ff000080"), Some(Vec4::new(1.0, 0.0, 0.0, 128.0 / 255.0)));
        assert_eq!(hex("#00FF00"), Some(Vec4::new(0.0, 1.0, 0.0, 1.0)));
        for wrong in
            ["", "#", "ff0000", "#ff000", "#ff00000", "#+f0000", "#gg0000", "#\u{20ac}\u{20ac}"]
        {
            assert_eq!(hex(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn ends_and_middle_are_right() {
        let table = linear_bytes();
        assert_eq!((table[0], linear(1.0)), (0.0, 1.0));
        assert!((table[128] - 0.21586).abs() < 1e-4, "{}", table[128]);
        assert!(table.is_sorted());
    }
}
