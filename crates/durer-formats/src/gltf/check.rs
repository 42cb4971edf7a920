//! References and sizes, checked before anything is read, so that the error of a broken file names the place of the
//! fault, even in a part that is not drawn.

use super::accessor::Layout;
use super::json::{Material, Root, TextureInfo, Whole};
use super::missing::missing;
use crate::{Error, Result, uri};
use std::fmt::Display;

/// Checks every reference of the file.
///
/// # Errors
/// A decode error with the path of the first reference to a missing object.
pub fn references(root: &Root) -> Result<()> {
    data(root)?;
    meshes(root)?;
    nodes(root)?;
    animations(root)?;
    materials(root)
}

/// Checks that `index`, if present, is below `count`.
fn exists(index: Option<Whole>, count: usize, what: &str, at: impl Display) -> Result<()> {
    match index {
        Some(i) if i.index() >= count => Err(missing(what, i, count, at)),
        _ => Ok(()),
    }
}

/// Checks that a required member is present.
fn present<T>(value: &Option<T>, name: &str, at: impl Display) -> Result<()> {
    let missing = || Error::path(at.to_string(), format!("`{name}` is missing"));
    value.as_ref().map(|_| ()).ok_or_else(missing)
}

fn data(root: &Root) -> Result<()> {
    for (i, buffer) in root.buffers.iter().enumerate() {
        present(&buffer.byte_length, "byteLength", format_args!("buffers[{i}]"))?;
        if let Some(uri) = &buffer.uri {
            uri::check(uri, &format!("buffers[{i}].uri"))?;
        }
    }
    for (i, view) in root.buffer_views.iter().enumerate() {
        let at = format!("bufferViews[{i}]");
        present(&view.buffer, "buffer", &at)?;
        present(&view.byte_length, "byteLength", &at)?;
        exists(view.buffer, root.buffers.len(), "buffer", &at)?;
        if let Some(packing) = &view.extensions.meshopt {
            exists(packing.buffer, root.buffers.len(), "buffer", &at)?;
        }
        let buffer = &root.buffers[view.buffer.map_or(0, Whole::index)];
        let end = view.byte_offset.0.saturating_add(view.byte_length.map_or(0, |l| l.0));
        let length = buffer.byte_length.map_or(0, |l| l.0);
        if end > length {
            return Err(Error::path(at, format!("ends at byte {end} of a buffer of {length}")));
        }
    }
    (0..root.accessors.len()).try_for_each(|i| Layout::of(root, i).map(|_| ()))?;
    for (i, image) in root.images.iter().enumerate() {
        let at = format!("images[{i}]");
        exists(image.buffer_view, root.buffer_views.len(), "buffer view", &at)?;
        if let Some(uri) = &image.uri {
            uri::check(uri, &format!("{at}.uri"))?;
        }
    }
    Ok(())
}

fn meshes(root: &Root) -> Result<()> {
    let accessors = root.accessors.len();
    for (m, mesh) in root.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("meshes[{m}].primitives[{p}]");
            for (name, &accessor) in &primitive.attributes {
                exists(
                    Some(accessor),
                    accessors,
                    "accessor",
                    format_args!("{at}.attributes.{name}"),
                )?;
            }
            exists(primitive.indices, accessors, "accessor", format_args!("{at}.indices"))?;
            exists(
                primitive.material,
                root.materials.len(),
                "material",
                format_args!("{at}.material"),
            )?;
            for (t, target) in primitive.targets.iter().enumerate() {
                for (name, &accessor) in target {
                    let at = format_args!("{at}.targets[{t}].{name}");
                    exists(Some(accessor), accessors, "accessor", at)?;
                }
            }
            for mapping in primitive.extensions.variants.iter().flat_map(|v| &v.mappings) {
                let at = format_args!("{at}.extensions.KHR_materials_variants");
                exists(mapping.material, root.materials.len(), "material", at)?;
            }
            if let Some(draco) = &primitive.extensions.draco {
                let at = format!("{at}.extensions.KHR_draco_mesh_compression");
                present(&draco.buffer_view, "bufferView", &at)?;
                exists(draco.buffer_view, root.buffer_views.len(), "buffer view", &at)?;
            }
        }
    }
    Ok(())
}

fn nodes(root: &Root) -> Result<()> {
    let count = root.nodes.len();
    for (s, scene) in root.scenes.iter().enumerate() {
        for &node in &scene.nodes {
            exists(Some(node), count, "node", format_args!("scenes[{s}].nodes"))?;
        }
    }
    let lights = root.extensions.lights.as_ref().map_or(0, |l| l.lights.len());
    for (n, node) in root.nodes.iter().enumerate() {
        let at = format!("nodes[{n}]");
        for &child in &node.children {
            exists(Some(child), count, "node", format_args!("{at}.children"))?;
        }
        exists(node.mesh, root.meshes.len(), "mesh", format_args!("{at}.mesh"))?;
        exists(node.skin, root.skins.len(), "skin", format_args!("{at}.skin"))?;
        exists(node.camera, root.cameras.len(), "camera", format_args!("{at}.camera"))?;
        let light = node.extensions.light.as_ref().and_then(|l| l.light);
        exists(light, lights, "light", format_args!("{at}.extensions.KHR_lights_punctual"))?;
        let instancing = node.extensions.instancing.iter().flat_map(|i| &i.attributes);
        for (name, &accessor) in instancing {
            let at = format_args!("{at}.extensions.EXT_mesh_gpu_instancing.attributes.{name}");
            exists(Some(accessor), root.accessors.len(), "accessor", at)?;
        }
    }
    for (s, skin) in root.skins.iter().enumerate() {
        let at = format!("skins[{s}]");
        for &joint in &skin.joints {
            exists(Some(joint), count, "node", format_args!("{at}.joints"))?;
        }
        exists(skin.skeleton, count, "node", format_args!("{at}.skeleton"))?;
        let matrices = format_args!("{at}.inverseBindMatrices");
        exists(skin.inverse_bind_matrices, root.accessors.len(), "accessor", matrices)?;
        if skin.joints.is_empty() {
            return Err(Error::path(at, "a skin must have joints"));
        }
    }
    Ok(())
}

fn animations(root: &Root) -> Result<()> {
    let accessors = root.accessors.len();
    for (a, animation) in root.animations.iter().enumerate() {
        for (s, sampler) in animation.samplers.iter().enumerate() {
            let at = format!("animations[{a}].samplers[{s}]");
            present(&sampler.input, "input", &at)?;
            present(&sampler.output, "output", &at)?;
            exists(sampler.input, accessors, "accessor", format_args!("{at}.input"))?;
            exists(sampler.output, accessors, "accessor", format_args!("{at}.output"))?;
        }
        for (c, channel) in animation.channels.iter().enumerate() {
            let at = format!("animations[{a}].channels[{c}]");
            present(&channel.sampler, "sampler", &at)?;
            let samplers = animation.samplers.len();
            exists(channel.sampler, samplers, "sampler", format_args!("{at}.sampler"))?;
            exists(
                channel.target.node,
                root.nodes.len(),
                "node",
                format_args!("{at}.target.node"),
            )?;
        }
    }
    Ok(())
}

fn materials(root: &Root) -> Result<()> {
    for (t, texture) in root.textures.iter().enumerate() {
        let at = format!("textures[{t}]");
        exists(texture.source, root.images.len(), "image", format_args!("{at}.source"))?;
        for (name, extension) in [
            ("EXT_texture_webp", &texture.extensions.webp),
            ("KHR_texture_basisu", &texture.extensions.basisu),
        ] {
            let source = extension.as_ref().and_then(|e| e.source);
            exists(source, root.images.len(), "image", format_args!("{at}.extensions.{name}"))?;
        }
        exists(texture.sampler, root.samplers.len(), "sampler", format_args!("{at}.sampler"))?;
    }
    for (m, material) in root.materials.iter().enumerate() {
        for (slot, info) in slots(material) {
            let at = format!("materials[{m}].{slot}");
            present(&info.index, "index", &at)?;
            exists(info.index, root.textures.len(), "texture", &at)?;
        }
    }
    Ok(())
}

/// Returns all textures of a material that are read, with their places in it.
fn slots(material: &Material) -> impl Iterator<Item = (&'static str, &TextureInfo)> {
    let pbr = &material.pbr_metallic_roughness;
    let extensions = &material.extensions;
    let glossy = extensions.specular_glossiness.as_ref();
    let specular = extensions.specular.as_ref();
    let coat = extensions.clearcoat.as_ref();
    let sheen = extensions.sheen.as_ref();
    let transmission = extensions.transmission.as_ref();
    [
        ("normalTexture", material.normal_texture.as_ref()),
        ("occlusionTexture", material.occlusion_texture.as_ref()),
        ("emissiveTexture", material.emissive_texture.as_ref()),
        ("pbrMetallicRoughness.baseColorTexture", pbr.base_color_texture.as_ref()),
        ("pbrMetallicRoughness.metallicRoughnessTexture", pbr.metallic_roughness_texture.as_ref()),
        (
            "extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
            glossy.and_then(|g| g.diffuse_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture",
            glossy.and_then(|g| g.specular_glossiness_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_specular.specularTexture",
            specular.and_then(|s| s.specular_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_specular.specularColorTexture",
            specular.and_then(|s| s.specular_color_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_clearcoat.clearcoatTexture",
            coat.and_then(|c| c.clearcoat_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture",
            coat.and_then(|c| c.clearcoat_roughness_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_sheen.sheenColorTexture",
            sheen.and_then(|s| s.sheen_color_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_sheen.sheenRoughnessTexture",
            sheen.and_then(|s| s.sheen_roughness_texture.as_ref()),
        ),
        (
            "extensions.KHR_materials_transmission.transmissionTexture",
            transmission.and_then(|t| t.transmission_texture.as_ref()),
        ),
    ]
    .into_iter()
    .filter_map(|(slot, info)| Some((slot, info?)))
}
