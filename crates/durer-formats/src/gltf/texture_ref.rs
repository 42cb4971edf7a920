//! Textures as materials name them, with the transform of KHR_texture_transform.

use super::json::{self, TextureInfo};
use durer::math::{DMat3, DVec2, DVec3};
use durer::scene::TextureRef;

/// Returns a texture as a material names it.
pub fn texture(info: Option<&TextureInfo>) -> Option<TextureRef> {
    let info = info?;
    let transform = info.extensions.transform.as_ref();
    let set = transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
    Some(TextureRef {
        texture: info.index?.index(),
        tex_coord: u32::try_from(set.0).unwrap_or(u32::MAX),
        transform: transform.map_or(DMat3::IDENTITY, matrix),
    })
}

/// Returns the matrix of KHR_texture_transform: scale, then rotation, then offset. v points down, so what the
/// extension calls counter-clockwise has its sine below the diagonal negative; its example (offset 0, 1, a quarter
/// turn, scale ½: the lower left quadrant) shows the sign.
fn matrix(transform: &json::TextureTransform) -> DMat3 {
    let (sin, cos) = (libm::sin(transform.rotation), libm::cos(transform.rotation));
    let [su, sv] = transform.scale.unwrap_or([1.0; 2]);
    let offset = DVec2::from(transform.offset.unwrap_or_default());
    DMat3::from_cols(
        DVec3::new(cos * su, -sin * su, 0.0),
        DVec3::new(sin * sv, cos * sv, 0.0),
        offset.extend(1.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extensions_example_shows_the_lower_left_quadrant() {
        let transform = json::TextureTransform {
            offset: Some([0.0, 1.0]),
            rotation: std::f64::consts::FRAC_PI_2,
            scale: Some([0.5, 0.5]),
            tex_coord: None,
        };
        let at = |u, v| matrix(&transform).transform_point2(DVec2::new(u, v));
        let near = |a: DVec2, b: DVec2| assert!((a - b).length() < 1e-12, "{a} {b}");
        near(at(0.0, 0.0), DVec2::new(0.0, 1.0));
        near(at(1.0, 0.0), DVec2::new(0.0, 0.5));
        near(at(0.0, 1.0), DVec2::new(0.5, 1.0));
    }
}
