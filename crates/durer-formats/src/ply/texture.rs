//! Pictures on the faces of a PLY file.

use super::header::Header;
use crate::facets::whole;
use crate::{Model, Place, ReadOptions, Resources, mtl};
use durer::scene::{Mesh, Part};

/// Assigns to a mesh the materials of the pictures that the header names; `numbers` has the picture's number for each
/// face, if faces name one.
pub(super) fn lay_on(
    model: &mut Model,
    mesh: &mut Mesh,
    header: &Header,
    numbers: &[u32],
    resources: &dyn Resources,
    options: &ReadOptions,
) {
    let names = &header.textures;
    if names.is_empty() {
        return;
    }
    if mesh.tex_coords.is_empty() {
        let message = format!("`{}` is not laid on: there are no texture coordinates", names[0]);
        return model.warn(Place::Whole, message);
    }
    let first = model.scene.materials.len();
    if !mtl::add_pictures(model, names, resources, options) {
        // The mesh is shown as if it named none.
        return model.scene.materials.truncate(first);
    }
    if !mesh.colors.is_empty() {
        mesh.colors = Vec::new();
        model.warn(Place::Whole, "colors of vertices or faces are not shown under the texture");
    }
    if numbers.is_empty() {
        mesh.parts.push(whole(mesh, first));
    } else {
        mesh.parts = parts(model, mesh, numbers, first..first + names.len());
    }
}

/// Returns the runs of faces with the same picture.
fn parts(
    model: &mut Model,
    mesh: &Mesh,
    numbers: &[u32],
    materials: std::ops::Range<usize>,
) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut unknown = 0;
    for (face, &number) in numbers.iter().enumerate() {
        let start = mesh.faces.get(face).map_or(face as u32, |&start| start);
        let material = Some(materials.start.saturating_add(number as usize));
        let material = material.filter(|m| materials.contains(m));
        // The largest number is −1, which writers use for none.
        unknown += u64::from(material.is_none() && number != u32::MAX);
        match parts.last_mut() {
            Some(last) if last.material == material => {}
            last => {
                if let Some(last) = last {
                    last.range.end = start;
                }
                parts.push(Part { range: start..start, material, name: String::new() });
            }
        }
    }
    if let Some(last) = parts.last_mut() {
        last.range.end = mesh.triangle_count() as u32;
    }
    let words =
        "{face names|faces name} a picture that the file does not have; {it is|they are} grey";
    model.warn_counted(Place::Whole, unknown, words);
    parts
}
