//! From the vertices, faces and edges of a PLY file to a scene.

use super::bounds::Bounds;
use super::build::Builder;
use super::faces::Faces;
use super::header::{Encoding, Header};
use super::{splat, texture};
use crate::facets::{self, Attributes};
use crate::model::count_infinite;
use crate::obj::corners::Corners;
use crate::wording::agreeing;
use crate::{Error, Model, Place, ReadOptions, Resources, Result, place};
use durer::math::DVec3;
use durer::scene::{Instance, Mesh, Topology};

/// Makes the model: triangles and lines; else discs; else points.
///
/// # Errors
/// A file without vertices, or without any face or edge whose vertices exist; too many triangles.
pub(super) fn finish(
    mut builder: Builder,
    header: &Header,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model> {
    let mut model = Model { format: format(header).to_owned(), ..Model::default() };
    if header.element("vertex").is_none() {
        return Err(Error::whole("has no element `vertex`: there is nothing to show"));
    }
    drop_unfinished(&mut model, &mut builder);
    let nothing = !builder.has_faces() && builder.edges.ends.indices.is_empty();
    check_dangling(&mut model, &builder.bounds, nothing)?;
    let origin = builder.vertices.wide.as_deref().map_or(DVec3::ZERO, place::origin);
    if let Some(wide) = builder.vertices.wide.take() {
        builder.vertices.all.positions = place::narrow(&wide, origin);
    }
    warn(&mut model, &builder);
    let Builder { vertices, faces, edges, .. } = &mut builder;
    let palettes = [&mut faces.facets.palette, &mut edges.palette].map(|p| &mut p.colors);
    for colors in [&mut vertices.all.colors].into_iter().chain(palettes) {
        facets::make_linear(&mut model, colors);
    }
    for mesh in meshes(&mut model, builder, header, resources, options)? {
        let number = model.scene.meshes.len();
        model.scene.meshes.push(mesh);
        let (world_from_mesh, name) = (place::matrix(origin), String::new());
        model.scene.instances.push(Instance { mesh: number, world_from_mesh, name });
    }
    Ok(model)
}

pub(super) fn format(header: &Header) -> &'static str {
    match header.encoding {
        Encoding::Ascii => "PLY, ascii",
        Encoding::LittleEndian => "PLY, binary little endian",
        Encoding::BigEndian => "PLY, binary big endian",
    }
}

/// Leaves out faces and edges that precede vertices if vertices are missing at the end of the file.
fn drop_unfinished(model: &mut Model, builder: &mut Builder) {
    let there = builder.vertices.len();
    if there as u64 >= builder.bounds.vertex_count {
        return;
    }
    let highest = |corners: &Corners| {
        let keyed = corners.keys.iter().map(|k| k.position).max();
        keyed.or_else(|| corners.indices.iter().copied().max())
    };
    let used = highest(&builder.faces.facets.triangles).max(highest(&builder.edges.ends));
    if used.is_some_and(|highest| highest as usize >= there) {
        (builder.faces, builder.edges) = Default::default();
        model.warn(Place::Whole, "faces and edges are left out: vertices of theirs are missing");
    }
}

/// Warns of faces and edges whose vertices do not exist.
///
/// # Errors
/// If nothing else is left.
pub(super) fn check_dangling(model: &mut Model, bounds: &Bounds, nothing: bool) -> Result<()> {
    let dangling = &bounds.dangling;
    if dangling.count == 0 {
        return Ok(());
    }
    let (place, message) = (dangling.first.clone(), bounds.dangling_message());
    if nothing {
        return Err(Error::Decode { place, message });
    }
    let words = "{face or edge like this is|faces or edges like this are} left out";
    let message = format!("{message}; {}", agreeing(dangling.count, words));
    model.warn(place, message);
    Ok(())
}

fn warn(model: &mut Model, builder: &Builder) {
    model.warn_infinite(count_infinite(&builder.vertices.all.positions));
    if builder.vertices.all.positions.is_empty() {
        model.warn(Place::Whole, "holds no vertices");
    }
    warn_of_faces(model, &builder.faces);
    for message in &builder.unread {
        model.warn(Place::Whole, message);
    }
}

/// Warns of faces that were left out or changed.
pub(super) fn warn_of_faces(model: &mut Model, faces: &Faces) {
    for (tally, message) in faces.warnings() {
        model.warn_of(tally, message);
    }
}

fn meshes(
    model: &mut Model,
    builder: Builder,
    header: &Header,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Vec<Mesh>> {
    let Builder { vertices, faces, edges, .. } = builder;
    let mut lines = None;
    if !edges.ends.indices.is_empty() {
        let Attributes { positions, colors, .. } = &vertices.all;
        let (positions, colors) = (positions.clone(), colors.clone());
        let own = Attributes { positions, colors, ..Attributes::default() };
        let mesh = own.joined(model, edges.ends, &edges.palette, &[]);
        lines = Some(Mesh { topology: Topology::Lines, ..mesh });
    }
    let mut meshes = Vec::new();
    if !faces.facets.triangles.indices.is_empty() {
        let Faces { facets, tex_coords, textures, .. } = faces;
        let lay_on = |model: &mut Model, mesh: &mut Mesh| {
            texture::lay_on(model, mesh, header, &textures, resources, options);
        };
        let limits = &options.limits;
        meshes.push(facets::mesh(model, vertices.all, facets, &tex_coords, limits, lay_on)?);
    } else if lines.is_none() && !vertices.splats.is_empty() && !vertices.all.colors.is_empty() {
        meshes.push(splat::discs(model, &vertices, &options.limits)?);
    } else if lines.is_none() {
        meshes.push(Mesh { topology: Topology::Points, ..vertices.all.into_mesh() });
    }
    meshes.extend(lines);
    facets::show_colors(model, &mut meshes);
    Ok(meshes)
}
