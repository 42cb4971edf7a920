//! Materials: Phong's kind, and physical ones of all programs, as unified by ufbx.

use super::picture::{Pictures, path};
use crate::mtl::image::{Images, grey};
use crate::piece::SETS;
use crate::text::Tally;
use crate::{Limits, Model, Place, Resources, color};
use durer::math::{DMat3, DVec2, DVec3, Vec3, Vec4};
use durer::scene::{AlphaMode, Material, Sampler, ShadingModel, TextureRef, Wrap};
use std::collections::HashMap;
use ufbx::{Exporter, MaterialMap, Scene, ShaderType, Texture, WrapMode};

/// The largest exponent of a highlight: narrower ones fall between pixels.
const MAX_SHININESS: f32 = 10_000.0;

/// Materials, each made once for the sets of texture coordinates that a mesh has.
pub(super) struct Materials<'s> {
    images: Images<'s>,
    known: HashMap<(u32, Vec<u32>), usize>,
    textures: HashMap<(usize, Wrap, Wrap), usize>,
    /// True if colours are linear light instead of sRGB values.
    linear: bool,
    layered: Tally,
    lost: Tally,
    opaque: Tally,
    bumps: Tally,
}

/// Meaning of a picture's opacity values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shows {
    Opacity,
    Transparency,
}

impl<'s> Materials<'s> {
    pub fn new(scene: &Scene, pictures: &'s Pictures<'s>, limits: Limits) -> Self {
        let exporter = scene.metadata.exporter;
        let linear = matches!(exporter, Exporter::BlenderBinary | Exporter::BlenderAscii);
        let (known, textures) = Default::default();
        let (layered, lost, opaque, bumps) = Default::default();
        let images = Images::new(pictures as &dyn Resources, limits);
        Self { images, known, textures, linear, layered, lost, opaque, bumps }
    }

    /// Returns the scene's number of a material on a mesh whose sets of texture coordinates have
    /// these names.
    pub fn get(&mut self, model: &mut Model, from: &ufbx::Material, sets: &[&str]) -> usize {
        let used = from.textures.iter().map(|t| set(&t.texture, sets)).collect();
        let key = (from.element.typed_id, used);
        if let Some(&number) = self.known.get(&key) {
            return number;
        }
        let name = from.element.name.to_string();
        let mut to = Material { name, specular: Vec3::ZERO, ..Material::default() };
        if from.features.pbr.enabled || from.shader_type == ShaderType::BlenderPhong {
            self.physical(model, from, &mut to, sets);
        } else {
            self.phong(model, from, &mut to, sets);
        }
        self.normals(model, from, &mut to, sets);
        model.scene.materials.push(to);
        self.known.insert(key, model.scene.materials.len() - 1);
        model.scene.materials.len() - 1
    }

    /// Adds warnings about omissions.
    pub fn warn(&self, model: &mut Model) {
        for (tally, what) in [
            (
                &self.layered,
                "{texture has layers or is computed; its|textures have layers or are computed; their} first picture is shown",
            ),
            (
                &self.lost,
                "{texture names no picture; it is|textures name no picture; they are} left out",
            ),
            (
                &self.opaque,
                "{material is wholly transparent, as some programs write opaque ones; it is|materials are wholly transparent, as some programs write opaque ones; they are} shown opaque",
            ),
            (
                &self.bumps,
                "bump {map shows heights, which is not read; it is|maps show heights, which is not read; they are} left out",
            ),
        ] {
            model.warn_of(tally, what);
        }
    }

    fn phong(
        &mut self,
        model: &mut Model,
        from: &ufbx::Material,
        to: &mut Material,
        sets: &[&str],
    ) {
        let maps = &from.fbx;
        let color =
            self.base(model, to, (&maps.diffuse_color, &maps.diffuse_factor), sets, self.linear);
        self.emission(model, to, (&maps.emission_color, &maps.emission_factor), sets, self.linear);
        let exponent = number(&maps.specular_exponent).unwrap_or(20.0);
        if from.shader_type != ShaderType::FbxLambert && exponent >= 1.0 {
            to.specular = tint(&maps.specular_color, self.linear).unwrap_or(Vec3::ZERO)
                * number(&maps.specular_factor).unwrap_or(1.0);
            to.shininess = exponent.min(MAX_SHININESS);
            to.specular_texture = self.whole(model, &maps.specular_color, sets);
        }
        let own = from.element.props.props.iter().find(|p| p.name == "Opacity");
        let own = own.map(|p| p.value_vec4.x as f32).filter(|v| v.is_finite());
        let part = tint(&maps.transparency_color, true).map_or(1.0, |c| c.element_sum() / 3.0);
        let opacity = own.unwrap_or(1.0 - part * number(&maps.transparency_factor).unwrap_or(0.0));
        let [by_color, by_factor] =
            [&maps.transparency_color, &maps.transparency_factor].map(|map| self.file(map));
        let alpha = by_color.or(by_factor).map(|t| (t, Shows::Transparency));
        self.opacity(model, to, opacity, (color, alpha), sets);
    }

    fn physical(
        &mut self,
        model: &mut Model,
        from: &ufbx::Material,
        to: &mut Material,
        sets: &[&str],
    ) {
        let maps = &from.pbr;
        to.model = ShadingModel::MetallicRoughness;
        if from.features.unlit.enabled {
            to.model = ShadingModel::Unlit;
        }
        let color = self.base(model, to, (&maps.base_color, &maps.base_factor), sets, true);
        self.emission(model, to, (&maps.emission_color, &maps.emission_factor), sets, true);
        to.metallic = number(&maps.metalness).unwrap_or(0.0).clamp(0.0, 1.0);
        let rough = number(&maps.roughness).or(number(&maps.glossiness).map(|g| 1.0 - g));
        to.roughness = rough.unwrap_or(0.5).clamp(0.0, 1.0);
        if from.shader_type == ShaderType::BlenderPhong {
            // Blender writes the square of ten times the smoothness.
            let exponent = number(&from.fbx.specular_exponent).unwrap_or(25.0).max(0.0);
            to.roughness = (1.0 - exponent.sqrt() / 10.0).clamp(0.0, 1.0);
        }
        self.roughness(model, from, to, sets);
        to.ior = number(&maps.specular_ior).filter(|n| *n >= 1.0).unwrap_or(to.ior);
        if from.features.coat.enabled {
            to.clearcoat = number(&maps.coat_factor).unwrap_or(0.0).clamp(0.0, 1.0);
            to.clearcoat_roughness = number(&maps.coat_roughness).unwrap_or(0.0).clamp(0.0, 1.0);
        }
        to.occlusion_texture = self.whole(model, &maps.ambient_occlusion, sets);
        let opacity = number(&maps.opacity).unwrap_or(1.0);
        let alpha = self.file(&maps.opacity).map(|t| (t, Shows::Opacity));
        self.opacity(model, to, opacity, (color, alpha), sets);
    }

    /// Sets roughness and metalness by pictures of roughness, or of its opposite, and of metalness, joined.
    fn roughness(
        &mut self,
        model: &mut Model,
        from: &ufbx::Material,
        to: &mut Material,
        sets: &[&str],
    ) {
        let maps = &from.pbr;
        let [rough, gloss, metal] =
            [&maps.roughness, &maps.glossiness, &maps.metalness].map(|map| self.file(map));
        let inverted = rough.is_none() && gloss.is_some();
        let rough = rough.or(gloss);
        let Some(placed) = rough.or(metal) else { return };
        let [a, b] = [rough, metal].map(|t| t.and_then(path));
        let image = self.images.joined(model, [a.as_deref(), b.as_deref()], |[rough, metal]| {
            let rough = rough.map_or(255, grey);
            let rough = if inverted { 255 - rough } else { rough };
            [255, rough, metal.map_or(255, grey), 255]
        });
        let Some(image) = image else { return };
        to.metallic_roughness_texture = Some(self.place(model, placed, image, sets));
        to.roughness = if rough.is_some() { 1.0 } else { to.roughness };
        to.metallic = if metal.is_some() { 1.0 } else { to.metallic };
    }

    /// Returns the colour that a surface shows, or its picture, which is returned.
    fn base<'m>(
        &mut self,
        model: &mut Model,
        to: &mut Material,
        (color, factor): (&'m MaterialMap, &MaterialMap),
        sets: &[&str],
        linear: bool,
    ) -> Option<&'m Texture> {
        let factor = number(factor).unwrap_or(1.0).max(0.0);
        if let Some(tint) = tint(color, linear) {
            to.base_color = (tint * factor).extend(1.0);
        }
        to.base_color_texture = self.whole(model, color, sets);
        // A picture takes the colour's place.
        to.base_color_texture?;
        to.base_color = Vec4::new(factor, factor, factor, 1.0);
        self.file(color)
    }

    fn emission(
        &mut self,
        model: &mut Model,
        to: &mut Material,
        (color, factor): (&MaterialMap, &MaterialMap),
        sets: &[&str],
        linear: bool,
    ) {
        let factor = number(factor).unwrap_or(1.0).max(0.0);
        to.emissive = tint(color, linear).unwrap_or(Vec3::ZERO) * factor;
        to.emissive_texture = self.whole(model, color, sets);
        if to.emissive_texture.is_some() {
            to.emissive = Vec3::splat(factor);
        }
    }

    /// Makes alpha of an opacity and of a picture.
    fn opacity(
        &mut self,
        model: &mut Model,
        to: &mut Material,
        opacity: f32,
        (color, alpha): (Option<&Texture>, Option<(&Texture, Shows)>),
        sets: &[&str],
    ) {
        if opacity <= 0.0 && alpha.is_none() {
            self.opaque.add(|| Place::Path(to.name.clone()));
        } else if alpha.is_none() {
            to.base_color.w = opacity.min(1.0);
        }
        let Some((texture, shows)) = alpha else {
            to.alpha_mode =
                if to.base_color.w < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque };
            return;
        };
        let [base, mask] = [color, Some(texture)].map(|t| t.and_then(path));
        let Some(mask) = mask else { return };
        if base.as_ref() == Some(&mask) {
            // The same file for both means its alpha channel.
            to.alpha_mode = AlphaMode::Blend;
            return;
        }
        let channel = self.images.has_alpha(model, &mask);
        let image = self.images.joined(model, [base.as_deref(), Some(&mask)], |[base, mask]| {
            let [r, g, b, _] = base.unwrap_or([255; 4]);
            let a = mask.map_or(255, |p| match shows {
                _ if channel => p[3],
                Shows::Opacity => grey(p),
                Shows::Transparency => 255 - grey(p),
            });
            [r, g, b, a]
        });
        if let Some(image) = image {
            to.base_color_texture = Some(self.place(model, color.unwrap_or(texture), image, sets));
            to.alpha_mode = AlphaMode::Blend;
        }
    }

    /// Sets the normal texture: a normal map, or a bump map that shows normals, as many programs have it.
    fn normals(
        &mut self,
        model: &mut Model,
        from: &ufbx::Material,
        to: &mut Material,
        sets: &[&str],
    ) {
        for map in [&from.pbr.normal_map, &from.fbx.normal_map, &from.fbx.bump] {
            let Some(path) = self.file(map).and_then(path) else { continue };
            match self.images.shows_normals(model, &path) {
                Some(true) => to.normal_texture = self.whole(model, map, sets),
                Some(false) => self.bumps.add(|| Place::Path(to.name.clone())),
                None => {}
            }
            return;
        }
    }

    /// Returns the texture with a picture behind a map: itself, or the first one that it is composed of.
    fn file<'m>(&mut self, map: &'m MaterialMap) -> Option<&'m Texture> {
        let texture = map.texture.as_deref().filter(|_| map.texture_enabled)?;
        if path(texture).is_some() {
            return Some(texture);
        }
        let place = || Place::Path(texture.element.name.to_string());
        let first = texture.file_textures.into_iter().next();
        let tally = if first.is_some() { &mut self.layered } else { &mut self.lost };
        tally.add(place);
        first
    }

    fn whole(&mut self, model: &mut Model, map: &MaterialMap, sets: &[&str]) -> Option<TextureRef> {
        let texture = self.file(map)?;
        let image = self.images.whole(model, &path(texture)?)?;
        Some(self.place(model, texture, image, sets))
    }

    /// Returns a texture of the scene: equal ones are shared.
    fn place(
        &mut self,
        model: &mut Model,
        texture: &Texture,
        image: usize,
        sets: &[&str],
    ) -> TextureRef {
        let wrap = |mode| if mode == WrapMode::Clamp { Wrap::ClampToEdge } else { Wrap::Repeat };
        let (wrap_u, wrap_v) = (wrap(texture.wrap_u), wrap(texture.wrap_v));
        let textures = &mut model.scene.textures;
        let number = *self.textures.entry((image, wrap_u, wrap_v)).or_insert_with(|| {
            let sampler = Sampler { wrap_u, wrap_v, ..Sampler::default() };
            textures.push(durer::scene::Texture { image, sampler });
            textures.len() - 1
        });
        TextureRef { texture: number, tex_coord: set(texture, sets), transform: transform(texture) }
    }
}

/// Returns the number of the set of texture coordinates that a texture names, else the first.
fn set(texture: &Texture, sets: &[&str]) -> u32 {
    let requested: &str = texture.uv_set.as_ref();
    sets.iter().take(SETS).position(|name| *name == requested).unwrap_or(0) as u32
}

/// Returns the matrix from texture coordinates with v downwards to the picture: the inverse of the picture's placement.
fn transform(texture: &Texture) -> DMat3 {
    let vector = |name: &str, none: f64| {
        let found = texture.element.props.find_prop(name).map(|p| p.value_vec4);
        let v = found.map_or(DVec3::splat(none), |v| DVec3::new(v.x, v.y, v.z));
        if v.is_finite() { v } else { DVec3::splat(none) }
    };
    let scale = vector("Scaling", 1.0).truncate();
    if !texture.has_uv_transform || scale.x == 0.0 || scale.y == 0.0 {
        return DMat3::IDENTITY;
    }
    let [scaled, turned] = ["TextureScalingPivot", "TextureRotationPivot"];
    let [scaled, turned] = [scaled, turned].map(|name| vector(name, 0.0).truncate());
    let angle = vector("Rotation", 0.0).z.to_radians();
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let turn = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z);
    let about = |pivot: DVec2, what: DMat3| {
        DMat3::from_translation(pivot) * what * DMat3::from_translation(-pivot)
    };
    let moved = DMat3::from_translation(vector("Translation", 0.0).truncate());
    let laid = moved * about(turned, turn) * about(scaled, DMat3::from_scale(scale));
    let flip = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::new(0.0, 1.0, 1.0));
    let inverse = laid.inverse();
    if inverse.is_finite() { flip * inverse * flip } else { DMat3::IDENTITY }
}

/// Returns the number of a map, if it has one.
fn number(map: &MaterialMap) -> Option<f32> {
    Some(map.value_vec4.x as f32).filter(|v| map.has_value && v.is_finite())
}

/// Returns the colour of a map as linear light, if it has one.
fn tint(map: &MaterialMap, linear: bool) -> Option<Vec3> {
    let v = map.value_vec4;
    let rgb = [v.x, v.y, v.z].map(|v| (v as f32).max(0.0));
    let finite = map.has_value && rgb.iter().all(|v| v.is_finite());
    finite.then(|| if linear { Vec3::from(rgb) } else { color::linear3(rgb) })
}
