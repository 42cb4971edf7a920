//! The transfer function of sRGB, and the material of vertex colours.

use durer::math::{Vec3, Vec4, powf};
use durer::scene::Material;

/// Linear light from an sRGB value, IEC 61966-2-1; values above 1 go on by the same curve.
pub(crate) fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 { srgb / 12.92 } else { powf((srgb + 0.055) / 1.055, 2.4) }
}

/// [`linear`] for three channels.
pub(crate) fn linear3(srgb: [f32; 3]) -> Vec3 {
    Vec3::from_array(srgb.map(linear))
}

/// [`linear`] of all 256 bytes: for formats that store colours as bytes.
pub(crate) fn linear_bytes() -> [f32; 256] {
    std::array::from_fn(|i| linear(i as f32 / 255.0))
}

/// What shows vertex colors as they are: the default material, but white.
pub(crate) fn vertex_color_material() -> Material {
    Material { name: "vertex colors".to_owned(), base_color: Vec4::ONE, ..Material::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_middle_are_right() {
        let table = linear_bytes();
        assert_eq!((table[0], linear(1.0)), (0.0, 1.0));
        assert!((table[128] - 0.21586).abs() < 1e-4, "{}", table[128]);
        assert!(table.is_sorted());
    }
}
