//! COLLADA, 1.4 and 1.5: XML of scenes.
//!
//! Source: Khronos Group, *COLLADA – Digital Asset Schema Release 1.4.1* and *1.5.0*, 2008.
//!
//! The reader takes meshes (triangles, strips, fans, polygons with holes, lines) with normals, colours and texture
//! coordinates, the nodes of the scene with all transforms, materials of the common profile, cameras, lights, and skins
//! and morphs in their bind shape. It ignores animations, splines and physics. Lengths become metres through the
//! matrices of the instances. Colours are sRGB values, except linear ones of materials from Blender since 2.80. An x
//! axis that is up becomes y.

pub(crate) mod document;
mod eye;
mod faults;
mod geometry;
mod material;
mod nodes;
mod source;

use crate::mtl::image::Images;
use crate::{Error, Model, Place, ReadOptions, Resources, Result, xml};
use document::{Document, float};
use durer::math::{DMat4, DVec3, DVec4};
use durer::scene::UpAxis;
use material::Materials;
use nodes::Nodes;

/// Returns whether a file that begins so is COLLADA.
pub(crate) fn sniff(head: &[u8]) -> bool {
    // A mark, a blank, half a character of UTF-16, or the first element.
    if !matches!(head, [b'<' | b' ' | b'\t' | b'\n' | b'\r' | 0 | 0xef | 0xfe | 0xff, ..]) {
        return false;
    }
    let text = xml::utf8(head);
    let key = b"<COLLADA";
    text.trim_ascii_start().starts_with(b"<") && text.windows(key.len()).any(|w| w == key)
}

/// Reads a COLLADA file.
///
/// # Errors
/// [`Error::Decode`] for XML that is not well-formed, or another root than `COLLADA`;
/// [`Error::Limit`] for data above a limit. All other faults are warnings.
pub fn read(bytes: &[u8], resources: &dyn Resources, options: &ReadOptions) -> Result<Model> {
    let text = xml::utf8(bytes);
    let text = std::str::from_utf8(&text).map_err(|e| {
        Error::byte(e.valid_up_to() as u64, "this is not UTF-8; save the file in UTF-8")
    })?;
    let limits = options.limits.clone();
    let document = Document::parse(text, limits.decoded_bytes)?;
    let root = document.root().filter(|&r| document.name(r) == "COLLADA");
    let root = root.ok_or_else(|| Error::whole("the outermost element is not <COLLADA>"))?;
    let mut model = Model { format: format(&document, root), ..Model::default() };
    let images = Images::new(resources, limits.clone());
    let materials = Materials::new(&document, images, &mut model);
    let mut nodes = Nodes::new(&document, materials, limits);
    let (up_axis, world, unit) = frame(&document, root, &mut model);
    model.scene.up_axis = up_axis;
    match scene(&document, root) {
        Some(scene) => nodes.place(&mut model, scene, world)?,
        None => model.warn(Place::Whole, "the file has no visual scene"),
    }
    nodes.warn(&mut model);
    let lights = if options.own_lights { &nodes.lights[..] } else { &[] };
    crate::eye::warn_of_dark(nodes.lights.len() - lights.len(), &mut model);
    eye::add(&mut model, &document, &nodes.cameras, lights, unit);
    animations(&document, root, &mut model);
    if model.scene.instances.is_empty() {
        model.warn(Place::Whole, "the scene has no nodes with a mesh");
    }
    model.scene.check()?;
    Ok(model)
}

fn format(document: &Document<'_>, root: usize) -> String {
    format!("COLLADA {}", document.attribute(root, "version").unwrap_or_default()).trim().to_owned()
}

/// Returns the up axis, the matrix to metres, and the length of the file's unit.
fn frame(document: &Document<'_>, root: usize, model: &mut Model) -> (UpAxis, DMat4, f64) {
    let unit = document.find(root, &["asset", "unit"]);
    let meter = unit.and_then(|u| document.attribute(u, "meter"));
    let length = meter.map_or(Some(1.0), |m| float(m.trim()).filter(|m| *m > 0.0 && m.is_finite()));
    if let (None, Some(unit)) = (length, unit) {
        let message = "<unit> has no length above 0 in `meter`; a unit is taken as a metre";
        model.warn(document.place(unit), message);
    }
    let length = length.unwrap_or(1.0);
    let scale = DMat4::from_scale(DVec3::splat(length));
    let up = document.find(root, &["asset", "up_axis"]).map(|n| document.text(n));
    match up.as_deref() {
        Some("Z_UP") => (UpAxis::Z, scale, length),
        Some("X_UP") => {
            // −y is to the right, x up, z towards the eye.
            let turn = DMat4::from_cols(DVec4::Y, -DVec4::X, DVec4::Z, DVec4::W);
            (UpAxis::Y, scale * turn, length)
        }
        _ => (UpAxis::Y, scale, length),
    }
}

/// Returns the scene that the file shows, else the first one.
fn scene(document: &Document<'_>, root: usize) -> Option<usize> {
    let instance = document.find(root, &["scene", "instance_visual_scene"]);
    let named = instance.and_then(|i| document.refers(i, "url"));
    let libraries = document.named(root, "library_visual_scenes");
    named.or_else(|| libraries.into_iter().find_map(|l| document.find(l, &["visual_scene"])))
}

fn animations(document: &Document<'_>, root: usize, model: &mut Model) {
    let libraries = document.named(root, "library_animations");
    let mut all = libraries.flat_map(|l| document.named(l, "animation"));
    if let Some(first) = all.next() {
        let count = 1 + all.count();
        let words = "{animation is|animations are} not read; the model is shown at rest";
        model.warn_counted(document.place(first), count as u64, words);
    }
}
