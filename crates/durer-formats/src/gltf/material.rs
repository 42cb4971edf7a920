//! Materials, textures, samplers and images.

use super::buffer::Source;
use super::json::{self, MaterialExtensions, Sampler, TextureInfo, Whole};
use super::uri;
use crate::{Error, Place, Resources, Result, Warning, image};
use durer::math::{DMat3, DVec2, DVec3, Vec3, Vec4};
use durer::scene::{
    AlphaMode, Filter, Image, Material, MipFilter, Sampler as SceneSampler, Scene, ShadingModel,
    Texture, TextureRef, Wrap,
};
use std::borrow::Cow;

/// Emission is cut at this factor, so that light stays finite whatever a file says.
const BRIGHTEST: f32 = 1e6;

/// Reads all materials, and the textures and images that they use. Their indices in the scene are
/// those of the file; images that nothing uses, or that cannot be read, are empty (white).
///
/// # Errors
/// Where an image lies outside of the model's folder or above the limits.
pub fn read(
    source: &Source<'_>,
    resources: &dyn Resources,
    scene: &mut Scene,
    warnings: &mut Vec<Warning>,
) -> Result<()> {
    let root = source.root;
    scene.materials =
        root.materials.iter().enumerate().map(|(i, m)| material(i, m, warnings)).collect();
    let mut used = vec![false; root.images.len()];
    for texture in scene.materials.iter().flat_map(Material::textures) {
        match root.textures[texture.texture].source {
            Some(image) => used[image.index()] = true,
            None => {
                let place = Place::Path(format!("textures[{}]", texture.texture));
                let message = "has no PNG or JPEG image; drawn white".to_owned();
                warnings.push(Warning { place, message });
            }
        }
    }
    for (i, used) in used.into_iter().enumerate() {
        scene.images.push(if used {
            read_image(source, i, resources, warnings)?
        } else {
            Image::default()
        });
    }
    // One more image, for textures that have none.
    let none = scene.images.len();
    scene.images.push(Image::default());
    scene.textures = root
        .textures
        .iter()
        .map(|t| Texture {
            image: t.source.map_or(none, Whole::index),
            sampler: t
                .sampler
                .map_or(SceneSampler::default(), |s| sampler(&root.samplers[s.index()])),
        })
        .collect();
    Ok(())
}

/// An image; one that is missing or broken is empty, with a warning.
fn read_image(
    source: &Source<'_>,
    index: usize,
    resources: &dyn Resources,
    warnings: &mut Vec<Warning>,
) -> Result<Image> {
    let at = format!("images[{index}]");
    match decode_image(source, index, resources, &at) {
        Err(error @ Error::Limit { .. }) => Err(error),
        Err(error) => {
            let message = format!("{}; drawn white", without_place(error));
            warnings.push(Warning { place: Place::Path(at), message });
            Ok(Image::default())
        }
        ok => ok,
    }
}

/// What an error says, without the place, which the warning has.
fn without_place(error: Error) -> String {
    match error {
        Error::Decode { message, .. } => message,
        Error::Resource { uri, message, .. } => format!("cannot read `{uri}`: {message}"),
        other => other.to_string(),
    }
}

fn decode_image(
    source: &Source<'_>,
    index: usize,
    resources: &dyn Resources,
    at: &str,
) -> Result<Image> {
    let image = &source.root.images[index];
    let uri = image.uri.as_deref().filter(|uri| !uri::is_data(uri));
    let name = image.name.as_deref().or(uri).map_or_else(|| at.to_owned(), str::to_owned);
    let limits = source.budget.rest();
    let bytes = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => Cow::Owned(uri::load(uri, at, resources, limits.decoded_bytes)?),
        (None, Some(view)) => source.view(view, at)?.whole()?,
        (None, None) => return Err(Error::path(at, "has neither a URI nor a buffer view")),
    };
    let image = image::decode(&bytes, &name, &limits)?;
    source.budget.bytes(image.data.len() as u64 * 4, at)?;
    Ok(image)
}

/// OpenGL's numbers for filters and wraps; what is unknown is the default.
fn sampler(sampler: &Sampler) -> SceneSampler {
    let number = |n: Option<Whole>| n.map_or(0, |n| n.0);
    let wrap = |n| match number(n) {
        33071 => Wrap::ClampToEdge,
        33648 => Wrap::MirroredRepeat,
        _ => Wrap::Repeat,
    };
    let (min, mip) = match number(sampler.min_filter) {
        9728 => (Filter::Nearest, MipFilter::None),
        9729 => (Filter::Linear, MipFilter::None),
        9984 => (Filter::Nearest, MipFilter::Nearest),
        9985 => (Filter::Linear, MipFilter::Nearest),
        9986 => (Filter::Nearest, MipFilter::Linear),
        _ => (Filter::Linear, MipFilter::Linear),
    };
    let mag = if number(sampler.mag_filter) == 9728 { Filter::Nearest } else { Filter::Linear };
    SceneSampler { mag, min, mip, wrap_u: wrap(sampler.wrap_s), wrap_v: wrap(sampler.wrap_t) }
}

fn material(index: usize, m: &json::Material, warnings: &mut Vec<Warning>) -> Material {
    let pbr = &m.pbr_metallic_roughness;
    let normal = m.normal_texture.as_ref();
    let occlusion = m.occlusion_texture.as_ref();
    let strength = m.extensions.emissive_strength.as_ref().and_then(|e| e.emissive_strength);
    let mut material = Material {
        name: m.name.clone().unwrap_or_default(),
        model: ShadingModel::MetallicRoughness,
        base_color: Vec4::from(pbr.base_color_factor.unwrap_or([1.0; 4]))
            .clamp(Vec4::ZERO, Vec4::ONE),
        base_color_texture: texture(pbr.base_color_texture.as_ref()),
        metallic: pbr.metallic_factor.unwrap_or(1.0).clamp(0.0, 1.0),
        roughness: pbr.roughness_factor.unwrap_or(1.0).clamp(0.0, 1.0),
        metallic_roughness_texture: texture(pbr.metallic_roughness_texture.as_ref()),
        normal_texture: texture(normal),
        normal_scale: normal.and_then(|t| t.scale).unwrap_or(1.0),
        occlusion_texture: texture(occlusion),
        occlusion_strength: occlusion.and_then(|t| t.strength).unwrap_or(1.0),
        emissive: Vec3::from(m.emissive_factor.unwrap_or([0.0; 3])).clamp(Vec3::ZERO, Vec3::ONE)
            * strength.unwrap_or(1.0).clamp(0.0, BRIGHTEST),
        emissive_texture: texture(m.emissive_texture.as_ref()),
        alpha_mode: AlphaMode::Opaque,
        double_sided: m.double_sided,
        ..Material::default()
    };
    let place = || Place::Path(format!("materials[{index}]"));
    match m.alpha_mode.as_deref() {
        None | Some("OPAQUE") => {}
        Some("MASK") => {
            material.alpha_mode = AlphaMode::Mask { cutoff: m.alpha_cutoff.unwrap_or(0.5) }
        }
        Some("BLEND") => material.alpha_mode = AlphaMode::Blend,
        Some(other) => {
            let message = format!("unknown alpha mode `{other}`; drawn opaque");
            warnings.push(Warning { place: place(), message });
        }
    }
    extend(&mut material, &m.extensions);
    material
}

/// What extensions change.
fn extend(material: &mut Material, extensions: &MaterialExtensions) {
    if let Some(glossy) = &extensions.specular_glossiness {
        // Its diffuse part as a dielectric; the specular colour has no place here.
        material.base_color = Vec4::from(glossy.diffuse_factor.unwrap_or([1.0; 4]));
        material.base_color_texture = texture(glossy.diffuse_texture.as_ref());
        material.metallic = 0.0;
        material.roughness = 1.0 - glossy.glossiness_factor.unwrap_or(1.0).clamp(0.0, 1.0);
        material.metallic_roughness_texture = None;
    }
    if extensions.unlit.is_some() {
        material.model = ShadingModel::Unlit;
    }
}

fn texture(info: Option<&TextureInfo>) -> Option<TextureRef> {
    let info = info?;
    let transform = info.extensions.transform.as_ref();
    let set = transform.and_then(|t| t.tex_coord).unwrap_or(info.tex_coord);
    Some(TextureRef {
        texture: info.index?.index(),
        tex_coord: u32::try_from(set.0).unwrap_or(u32::MAX),
        transform: transform.map_or(DMat3::IDENTITY, matrix),
    })
}

/// KHR_texture_transform: scale, then rotation, then offset. v points down, so what the extension
/// calls counter-clockwise has its sine below the diagonal negative; its example (offset 0, 1,
/// a quarter turn, scale ½: the lower left quadrant) tells the sign.
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
