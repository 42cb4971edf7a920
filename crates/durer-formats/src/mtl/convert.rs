//! From a material's statements to the scene's material.

use super::image::{Images, grey};
use super::notes::Notes;
use super::parse::{Map, Statements};
use crate::{Model, color};
use durer::math::{DMat3, DVec2, Vec3};
use durer::scene::{AlphaMode, Material, Sampler, ShadingModel, Texture, TextureRef, Wrap};

/// The largest exponent of a highlight: narrower ones fall between pixels.
const MAX_SHININESS: f32 = 10_000.0;

/// Highlights of lower exponents would cover all that is lit: who writes them wants none.
const MIN_SHININESS: f32 = 1.0;

/// Colours above this are written in 0 … 255; those a little above 1 are only bright.
const BRIGHTEST: f32 = 2.0;

/// Builds a material; its textures go into the scene.
pub(super) fn material(
    model: &mut Model,
    images: &mut Images<'_>,
    notes: &mut Notes,
    name: &str,
    m: &Statements,
) -> Material {
    let mut material = Material { name: name.to_owned(), ..Material::default() };
    let scaled = from_bytes(m);
    if scaled.is_some() {
        notes.byte_colors.add(name);
    }
    let m = scaled.as_ref().unwrap_or(m);
    set_colors(&mut material, m);
    set_alpha(&mut material, notes, name, m);
    base_texture(model, images, &mut material, m);
    specular(model, images, &mut material, m);
    physical(model, images, &mut material, m);
    if let Some(map) = &m.map_emissive {
        material.emissive_texture = whole(model, images, map);
        if m.emissive.is_none() && material.emissive_texture.is_some() {
            material.emissive = Vec3::ONE;
        }
    }
    normals(model, images, notes, &mut material, m);
    if m.illum == Some(0.0) {
        material.model = ShadingModel::Unlit;
    }
    material
}

fn set_colors(material: &mut Material, m: &Statements) {
    let mapped = m.map_diffuse.is_some();
    // Some writers put all colour into the picture and leave Kd black; a black factor would hide it.
    let diffuse = m.diffuse.filter(|kd| !(mapped && *kd == [0.0; 3]));
    let diffuse = diffuse.map(color::linear3).or(mapped.then_some(Vec3::ONE));
    if let Some(diffuse) = diffuse {
        material.base_color = diffuse.extend(1.0);
    }
    material.emissive = m.emissive.map_or(Vec3::ZERO, color::linear3);
}

/// Returns the statements with colours divided by 255, if they are written as bytes.
fn from_bytes(m: &Statements) -> Option<Statements> {
    let above = |color: &[f32; 3], limit: f32| color.iter().any(|v| *v > limit);
    // Emission may be above 1, and so may the ambient colour of a lamp's surface.
    let colors = [m.diffuse, m.specular];
    colors.iter().flatten().any(|color| above(color, BRIGHTEST)).then(|| {
        let scale = |color: Option<[f32; 3]>| {
            color.map(|c| if above(&c, 1.0) { c.map(|v| v / 255.0) } else { c })
        };
        let (diffuse, specular, emissive) =
            (scale(m.diffuse), scale(m.specular), scale(m.emissive));
        Statements { diffuse, specular, emissive, ..m.clone() }
    })
}

/// Sets alpha from `d`, or else from `Tr`, whose value 1 many writers use for opaque although the manual defines it as
/// transparent.
fn set_alpha(material: &mut Material, notes: &mut Notes, name: &str, m: &Statements) {
    let alpha = match (m.dissolve, m.transparency) {
        (Some(d), _) => d,
        (None, Some(tr)) if tr >= 1.0 || (notes.tr_is_opacity && tr > 0.0) => {
            notes.opacity.add(name);
            tr
        }
        (None, Some(tr)) => 1.0 - tr,
        (None, None) => 1.0,
    };
    let alpha = alpha.clamp(0.0, 1.0);
    if alpha == 0.0 {
        notes.invisible.add(name);
    }
    material.base_color.w = alpha;
    if alpha < 1.0 || m.map_alpha.is_some() {
        material.alpha_mode = AlphaMode::Blend;
    }
}

/// Sets the normal texture from `norm`, or else from a bump map that shows normals, as many writers have it.
fn normals(
    model: &mut Model,
    images: &mut Images<'_>,
    notes: &mut Notes,
    material: &mut Material,
    m: &Statements,
) {
    let bump = m.map_bump.as_ref().filter(|_| m.map_normal.is_none());
    let shows_normals = bump.and_then(|map| images.shows_normals(model, &map.path));
    if shows_normals == Some(false) {
        notes.bump.add(&material.name);
    }
    if let Some(map) = m.map_normal.as_ref().or(bump.filter(|_| shows_normals == Some(true))) {
        material.normal_texture = whole(model, images, map);
        material.normal_scale = map.strength as f32;
    }
}

/// Sets the base texture from `map_Kd`, with `map_d` as its alpha.
fn base_texture(
    model: &mut Model,
    images: &mut Images<'_>,
    material: &mut Material,
    m: &Statements,
) {
    let (color, alpha) = (m.map_diffuse.as_ref(), m.map_alpha.as_ref());
    let Some(placed) = color.or(alpha) else { return };
    let image = match (color, alpha) {
        (Some(color), None) => images.whole(model, &color.path),
        // The same file for both means its alpha channel.
        (Some(color), Some(alpha)) if color.path == alpha.path => images.whole(model, &color.path),
        _ => {
            let paths = [color, alpha].map(|map| map.map(|m| m.path.as_str()));
            // A picture made for alpha alone has it in its alpha channel or as grey.
            let channel = alpha.is_some_and(|map| images.has_alpha(model, &map.path));
            images.joined(model, paths, |[color, alpha]| {
                let [r, g, b, _] = color.unwrap_or([255; 4]);
                let a = alpha.map_or(255, |p| if channel { p[3] } else { grey(p) });
                [r, g, b, a]
            })
        }
    };
    material.base_color_texture = image.map(|i| texture(model, placed, i));
}

fn specular(model: &mut Model, images: &mut Images<'_>, material: &mut Material, m: &Statements) {
    let matte = m.illum.is_some_and(|i| i < 2.0);
    let matte = matte || m.shininess.is_some_and(|exponent| exponent < MIN_SHININESS);
    let given = m.specular.or(m.map_specular.is_some().then_some([1.0; 3])).filter(|_| !matte);
    material.specular = given.map_or(Vec3::ZERO, color::linear3);
    let shininess = m.shininess.unwrap_or(material.shininess);
    material.shininess = shininess.clamp(MIN_SHININESS, MAX_SHININESS);
    if let Some(map) = m.map_specular.as_ref().filter(|_| !matte) {
        material.specular_texture = whole(model, images, map);
    }
}

/// Applies the statements of the metallic-roughness extension.
fn physical(model: &mut Model, images: &mut Images<'_>, material: &mut Material, m: &Statements) {
    let maps = [&m.map_roughness, &m.map_metallic].map(|map| map.as_ref());
    if m.roughness.is_none() && m.metallic.is_none() && maps == [None, None] {
        return;
    }
    material.model = ShadingModel::MetallicRoughness;
    let factor = |value: Option<f32>, mapped: bool, none: f32| {
        value.unwrap_or(if mapped { 1.0 } else { none }).clamp(0.0, 1.0)
    };
    material.roughness = factor(m.roughness, maps[0].is_some(), 0.5);
    material.metallic = factor(m.metallic, maps[1].is_some(), 0.0);
    let Some(placed) = maps[0].or(maps[1]) else { return };
    let image = images.joined(model, maps.map(|m| m.map(|m| m.path.as_str())), |[rough, metal]| {
        [255, rough.map_or(255, grey), metal.map_or(255, grey), 255]
    });
    material.metallic_roughness_texture = image.map(|i| texture(model, placed, i));
}

fn whole(model: &mut Model, images: &mut Images<'_>, map: &Map) -> Option<TextureRef> {
    let image = images.whole(model, &map.path)?;
    Some(texture(model, map, image))
}

/// Returns a texture of the scene: equal ones are shared.
fn texture(model: &mut Model, map: &Map, image: usize) -> TextureRef {
    let wrap = if map.clamp { Wrap::ClampToEdge } else { Wrap::Repeat };
    let texture =
        Texture { image, sampler: Sampler { wrap_u: wrap, wrap_v: wrap, ..Sampler::default() } };
    let textures = &mut model.scene.textures;
    let number = textures.iter().position(|t| *t == texture).unwrap_or(textures.len());
    if number == textures.len() {
        textures.push(texture);
    }
    // The file's v runs upwards: 1 − (s·(1 − v) + o) = s·v + (1 − s − o).
    let ([su, sv], [ou, ov]) = (map.scale, map.offset);
    let moved = DVec2::new(ou, 1.0 - sv - ov);
    let transform = DMat3::from_scale_angle_translation(DVec2::new(su, sv), 0.0, moved);
    TextureRef { texture: number, tex_coord: 0, transform }
}
