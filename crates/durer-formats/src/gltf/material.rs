//! Materials, textures, samplers and images.

use super::buffer::Source;
use super::json::{self, Root, Sampler, Whole};
use super::surface::{self, BRIGHTEST};
use super::texture_ref::texture;
use super::todo::Todo;
use super::{broken, derived};
use crate::wording::counted;
use crate::{Error, Place, Resources, Result, Warning, image, uri};
use durer::math::{Vec3, Vec4};
use durer::scene::{
    AlphaMode, Image, Material, MipFilter, Sampler as SceneSampler, Scene, ShadingModel, Texture,
    TextureFilter, Wrap,
};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// Reads all materials, and the textures and images that they use. Their indices in the scene are the file's; images
/// that are not used or cannot be read are empty (white). Textures derived from the file's come after them.
///
/// # Errors
/// If an image is above the limits.
pub fn read(
    source: &Source<'_>,
    resources: &dyn Resources,
    scene: &mut Scene,
    warnings: &mut Vec<Warning>,
) -> Result<()> {
    let root = source.root;
    let mut todo = Todo::default();
    let materials = root.materials.iter().enumerate();
    scene.materials = materials.map(|(i, m)| material(i, m, &mut todo, warnings)).collect();
    for (i, used) in used_images(root, scene, &todo, warnings).into_iter().enumerate() {
        scene.images.push(if used {
            read_image(source, i, resources, warnings)?
        } else {
            Image::default()
        });
    }
    // One additional image, for textures without one.
    let none = scene.images.len();
    scene.images.push(Image::default());
    let sampler = |t: &json::Texture| t.sampler.map(|s| sampler(&root.samplers[s.index()]));
    let texture = |t: &json::Texture| Texture {
        image: image_of(t).map_or(none, Whole::index),
        sampler: sampler(t).unwrap_or_default(),
    };
    scene.textures = root.textures.iter().map(texture).collect();
    derived::run(source, scene, &mut todo)?;
    todo.warn(warnings);
    Ok(())
}

/// Returns the image of a texture: preferably the one of EXT_texture_webp, else the one for readers that do not know
/// it.
fn image_of(texture: &json::Texture) -> Option<Whole> {
    let webp = texture.extensions.webp.as_ref().and_then(|webp| webp.source);
    webp.or(texture.source)
}

/// Returns true for each image that is used; warns of textures without one.
fn used_images(root: &Root, scene: &Scene, todo: &Todo, warnings: &mut Vec<Warning>) -> Vec<bool> {
    let mut used = vec![false; root.images.len()];
    let mut without = BTreeSet::new();
    let others = todo.jobs.iter().filter_map(|job| job.texture.as_ref());
    for texture in scene.materials.iter().flat_map(Material::textures).chain(others) {
        match image_of(&root.textures[texture.texture]) {
            Some(image) => used[image.index()] = true,
            None => {
                without.insert(texture.texture);
            }
        }
    }
    if let Some(first) = without.first() {
        let basisu = |t: &&usize| root.textures[**t].extensions.basisu.is_some();
        let message = match (without.iter().filter(basisu).count(), without.len()) {
            (0, 1) => "has no image that can be read; drawn white".to_owned(),
            (0, n) => format!(
                "this and {} have no image that can be read; drawn white",
                counted(n as u64 - 1, "more texture", "more textures")
            ),
            (_, n) => format!(
                "KTX 2 (KHR_texture_basisu) is not decoded, and no other image is given: {n} drawn white"
            ),
        };
        let place = Place::Path(format!("textures[{first}]"));
        warnings.push(Warning { place, message });
    }
    used
}

/// Returns an image; one that is missing or broken is empty, with a warning.
fn read_image(
    source: &Source<'_>,
    index: usize,
    resources: &dyn Resources,
    warnings: &mut Vec<Warning>,
) -> Result<Image> {
    let at = format!("images[{index}]");
    match decode_image(source, index, resources, &at, warnings) {
        Err(error @ Error::Limit { .. }) => Err(error),
        Err(error) => {
            let message = format!("{}; drawn white", broken::apart(error).1);
            warnings.push(Warning { place: Place::Path(at), message });
            Ok(Image::default())
        }
        ok => ok,
    }
}

fn decode_image(
    source: &Source<'_>,
    index: usize,
    resources: &dyn Resources,
    at: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Image> {
    let image = &source.root.images[index];
    let uri = image.uri.as_deref().filter(|uri| !uri::is_data(uri));
    let name = image.name.as_deref().or(uri).map_or_else(|| at.to_owned(), str::to_owned);
    let limits = source.budget.rest();
    let bytes = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => {
            let found = uri::load(uri, at, resources, limits.decoded_bytes)?;
            let place = || Place::Path(at.to_owned());
            warnings.extend(found.note.map(|message| Warning { place: place(), message }));
            Cow::Owned(found.bytes)
        }
        (None, Some(view)) => source.view(view, at)?.whole()?,
        (None, None) => return Err(Error::path(at, "has neither a URI nor a buffer view")),
    };
    let image = image::decode(&bytes, &name, &limits)?;
    source.budget.bytes(image.data.len() as u64 * 4, at)?;
    Ok(image)
}

/// Converts a sampler with OpenGL's numbers for filters and wraps; unknown numbers become the default.
fn sampler(sampler: &Sampler) -> SceneSampler {
    let number = |n: Option<Whole>| n.map_or(0, |n| n.0);
    let wrap = |n| match number(n) {
        33071 => Wrap::ClampToEdge,
        33648 => Wrap::MirroredRepeat,
        _ => Wrap::Repeat,
    };
    let (min, mip) = match number(sampler.min_filter) {
        9728 => (TextureFilter::Nearest, MipFilter::None),
        9729 => (TextureFilter::Linear, MipFilter::None),
        9984 => (TextureFilter::Nearest, MipFilter::Nearest),
        9985 => (TextureFilter::Linear, MipFilter::Nearest),
        9986 => (TextureFilter::Nearest, MipFilter::Linear),
        _ => (TextureFilter::Linear, MipFilter::Linear),
    };
    let mag = if number(sampler.mag_filter) == 9728 {
        TextureFilter::Nearest
    } else {
        TextureFilter::Linear
    };
    SceneSampler { mag, min, mip, wrap_u: wrap(sampler.wrap_s), wrap_v: wrap(sampler.wrap_t) }
}

fn material(
    index: usize,
    m: &json::Material,
    todo: &mut Todo,
    warnings: &mut Vec<Warning>,
) -> Material {
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
    surface::extend(index, &mut material, &m.extensions, todo);
    material
}
