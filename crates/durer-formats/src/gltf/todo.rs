//! The changes to materials that have to wait for their images.

use super::json::TextureInfo;
use super::specular_glossiness::Glossy;
use super::texture_ref::texture;
use crate::{Place, Warning};
use durer::math::Vec4;
use durer::scene::{Material, TextureRef};
use std::collections::BTreeMap;

/// Something to be done to a material once its images are there.
pub struct Job {
    /// Index of the material.
    pub material: usize,
    /// The texture that the scene's material has no place for.
    pub texture: Option<TextureRef>,
    /// Change to make.
    pub what: What,
}

/// Change to make to a material.
#[derive(Clone, Copy)]
pub enum What {
    /// Multiply a factor by the mean of the texture.
    Mean {
        /// True if its colours are stored as sRGB.
        srgb: bool,
        /// Sets the factor, given the linear mean.
        set: fn(&mut Material, Vec4),
    },
    /// Make base colour, metalness and roughness of the diffuse and the specular-glossiness texture.
    Glossy(Glossy),
    /// Conversion of a transmitting material to a blended one: its alpha is the part of the light behind it that it
    /// keeps.
    Glass,
}

/// Changes to make to materials once their images are loaded, and warnings.
#[derive(Default)]
pub struct Todo {
    /// Changes, in the order of application.
    pub jobs: Vec<Job>,
    /// First material and number of materials for each extension and kind of texture that is not applied.
    left_out: BTreeMap<(&'static str, &'static str), (usize, u64)>,
}

impl Todo {
    /// Requests the mean of a texture, by which `set` multiplies a factor.
    pub fn mean(
        &mut self,
        material: usize,
        info: Option<&TextureInfo>,
        srgb: bool,
        extension: &'static str,
        set: fn(&mut Material, Vec4),
    ) {
        if let Some(texture) = texture(info) {
            let texture = Some(texture);
            self.jobs.push(Job { material, texture, what: What::Mean { srgb, set } });
            self.leave_out(extension, "is not laid on, its mean is taken", material);
        }
    }

    /// Notes that a texture of a material's extension is not laid on.
    pub fn leave_out(&mut self, extension: &'static str, what: &'static str, material: usize) {
        self.left_out.entry((extension, what)).or_insert((material, 0)).1 += 1;
    }

    /// Adds the warnings about textures that are left out.
    pub fn warn(&self, warnings: &mut Vec<Warning>) {
        for ((extension, what), (first, count)) in &self.left_out {
            let of = if *count > 1 { format!(" ({count} textures)") } else { String::new() };
            let place = Place::Path(format!("materials[{first}].extensions.{extension}"));
            warnings.push(Warning { place, message: format!("its texture {what}{of}") });
        }
    }
}
