//! Materials that consist only of a picture, for formats without a material library.

use super::convert;
use super::image::Images;
use super::notes::Notes;
use super::parse::{Map, Statements};
use crate::{Model, ReadOptions, Resources};

/// Adds a matte material with the colours of each picture; returns whether any of them could be read. Unreadable ones
/// give a warning.
pub(crate) fn add_pictures(
    model: &mut Model,
    names: &[String],
    resources: &dyn Resources,
    options: &ReadOptions,
) -> bool {
    let mut images = Images::new(resources, options.limits.clone());
    // A picture alone gives no notes.
    let (mut notes, mut any) = (Notes::default(), false);
    for name in names {
        let path = super::relative(name);
        let map = Map { path, clamp: false, scale: [1.0; 2], offset: [0.0; 2], strength: 1.0 };
        let statements = Statements { map_diffuse: Some(map), ..Statements::default() };
        let mut material = convert::material(model, &mut images, &mut notes, name, &statements);
        if material.base_color_texture.is_none() {
            material.base_color = durer::scene::Material::default().base_color;
        }
        any |= material.base_color_texture.is_some();
        model.scene.materials.push(material);
    }
    any
}
