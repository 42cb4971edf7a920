//! From the statements of an OBJ file to meshes and materials.

use super::corners::{Corner, NONE};
use super::parse::{Parsed, Run};
use super::smooth;
use crate::wording::agreeing;
use crate::{Model, Place, ReadOptions, Resources, Result, color, mtl, place, polygon};
use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{Instance, Material, Mesh, Part, Topology};

/// Builds the meshes: triangles first, then lines, then points.
///
/// # Errors
/// A limit, or an inconsistent scene, which would be a bug in this reader.
pub(super) fn build(
    mut parsed: Parsed,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model> {
    let mut model = Model { format: "OBJ".to_owned(), ..Model::default() };
    parsed.repairs.warn(&mut model);
    mtl::load(&mut model, &parsed.libraries, &parsed.materials, resources, options);
    let origin = place::origin(&parsed.positions);
    let nothing_drawn =
        parsed.triangles.indices.is_empty() && parsed.lines.is_empty() && parsed.points.is_empty();
    if nothing_drawn {
        let message = format!(
            "no faces, lines or points: the {}",
            agreeing(
                parsed.positions.len() as u64,
                "{vertex is taken as a point|vertices are taken as points}"
            )
        );
        model.warn(Place::Whole, message);
        parsed.points = (0..parsed.positions.len() as u32).collect();
    }
    let lines = loose(&parsed, &parsed.lines, &parsed.line_runs, Topology::Lines, origin);
    let points = loose(&parsed, &parsed.points, &parsed.point_runs, Topology::Points, origin);
    if !parsed.triangles.indices.is_empty() {
        let mut mesh = triangles(&mut model, parsed, origin);
        polygon::recut(&mut model, &mut mesh, &options.limits)?;
        add(&mut model, mesh, origin);
    }
    for mut mesh in [lines, points].into_iter().flatten() {
        forget_undefined(&model, &mut mesh);
        add(&mut model, mesh, origin);
    }
    whiten(&mut model);
    model.scene.check()?;
    Ok(model)
}

/// Removes materials that no library defines from lines and points, which would hardly be visible in grey: without a
/// material they get a colour that contrasts with the background.
fn forget_undefined(model: &Model, mesh: &mut Mesh) {
    let is_default = |m: &Material| *m == Material { name: m.name.clone(), ..Material::default() };
    for part in &mut mesh.parts {
        let material = part.material.and_then(|m| model.scene.materials.get(m));
        if material.is_some_and(is_default) {
            part.material = None;
        }
    }
}

fn add(model: &mut Model, mesh: Mesh, origin: DVec3) {
    let (name, number) = (mesh.name.clone(), model.scene.meshes.len());
    model.scene.meshes.push(mesh);
    let world_from_mesh = place::matrix(origin);
    model.scene.instances.push(Instance { mesh: number, world_from_mesh, name });
}

/// Sets a white material for meshes that have vertex colors and name no material: the colors replace the grey of the
/// default material.
fn whiten(model: &mut Model) {
    let number = model.scene.materials.len();
    let mut used = false;
    for mesh in model.scene.meshes.iter_mut().filter(|m| !m.colors.is_empty()) {
        if mesh.parts.is_empty() {
            let range = 0..mesh.primitive_count() as u32;
            mesh.parts.push(Part { range, material: None, name: String::new() });
        }
        for part in mesh.parts.iter_mut().filter(|p| p.material.is_none()) {
            (part.material, used) = (Some(number), true);
        }
    }
    if used {
        model.scene.materials.push(color::vertex_color_material());
    }
}

fn parts(runs: &[Run], count: usize, has_objects: bool) -> Vec<Part> {
    if let [run @ Run { material: None, .. }] = runs
        && run.name(has_objects).is_empty()
    {
        return Vec::new();
    }
    let ends = runs.iter().skip(1).map(|r| r.start).chain([count]);
    runs.iter()
        .zip(ends)
        .map(|(run, end)| Part {
            range: run.start as u32..end as u32,
            material: run.material,
            name: run.name(has_objects).to_owned(),
        })
        .collect()
}

fn linear_colors(colors: impl Iterator<Item = Vec3>) -> Vec<Vec4> {
    colors.map(|c| color::linear3(c.to_array()).extend(1.0)).collect()
}

/// Returns the mesh of lines or points, with only the vertices that it uses, in the file's order.
fn loose(
    parsed: &Parsed,
    indices: &[u32],
    runs: &[Run],
    topology: Topology,
    origin: DVec3,
) -> Option<Mesh> {
    if indices.is_empty() {
        return None;
    }
    let mut used = indices.to_vec();
    used.sort_unstable();
    used.dedup();
    let chosen = || used.iter().filter_map(|&i| parsed.positions.get(i as usize).copied());
    let colors = used.iter().filter_map(|&i| parsed.colors.get(i as usize).copied());
    let renumbered = indices.iter().filter_map(|i| used.binary_search(i).ok());
    let mut mesh = Mesh {
        topology,
        positions: chosen().map(|p| (p - origin).as_vec3()).collect(),
        colors: linear_colors(colors),
        indices: Some(renumbered.map(|i| i as u32).collect()),
        ..Mesh::default()
    };
    mesh.parts = parts(runs, mesh.primitive_count(), parsed.has_objects());
    Some(mesh)
}

/// Returns the mesh of triangles; vertices are the file's positions, or triples where corners have
/// more.
fn triangles(model: &mut Model, parsed: Parsed, origin: DVec3) -> Mesh {
    let has_objects = parsed.has_objects();
    let Parsed { positions, colors, tex_coords, normals, triangles, faces, .. } = parsed;
    let count = triangles.indices.len() / 3;
    let mut mesh = Mesh {
        parts: parts(&parsed.triangle_runs, count, has_objects),
        faces,
        indices: Some(triangles.indices),
        ..Mesh::default()
    };
    if triangles.keys.is_empty() {
        mesh.positions = place::narrow(&positions, origin);
        mesh.colors = linear_colors(colors.into_iter());
        return mesh;
    }
    let keys = triangles.keys;
    let position = |k: &Corner| positions.get(k.position as usize).copied().unwrap_or_default();
    mesh.positions = keys.iter().map(|k| (position(k) - origin).as_vec3()).collect();
    drop(positions);
    if !colors.is_empty() {
        let color = |k: &Corner| colors.get(k.position as usize).copied().unwrap_or(Vec3::ONE);
        mesh.colors = linear_colors(keys.iter().map(color));
    }
    if keys.iter().any(|k| k.tex_coord != NONE) {
        let coord = |k: &Corner| tex_coords.get(k.tex_coord as usize).copied();
        mesh.tex_coords = vec![keys.iter().map(|k| coord(k).unwrap_or(Vec2::ZERO)).collect()];
    }
    if keys.iter().any(|k| k.normal != NONE) {
        let normal = |k: &Corner| normals.get(k.normal as usize).copied();
        mesh.normals = keys.iter().map(|k| normal(k).unwrap_or(Vec3::ZERO)).collect();
        smooth::fill(model, &mut mesh, &keys, normals.len());
    }
    mesh
}
