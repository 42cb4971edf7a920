//! From the statements of an OBJ file to meshes and materials.

use super::corners::{Corner, NONE};
use super::parse::{Parsed, Repairs, Run};
use crate::{Model, Place, ReadOptions, Resources, Result, color, mtl, place, polygon};
use durer::math::{DVec3, Vec2, Vec3, Vec4};
use durer::scene::{Instance, Mesh, Part, Topology};

/// Builds the meshes: triangles first, then lines, then points.
///
/// # Errors
/// A limit, or a scene that does not hold together, which would be an error of this reader.
pub(super) fn build(
    mut parsed: Parsed,
    resources: &dyn Resources,
    options: &ReadOptions,
) -> Result<Model> {
    let mut model = Model { format: "OBJ".to_owned(), ..Model::default() };
    warn_of_repairs(&mut model, &parsed.repairs);
    mtl::load(&mut model, &parsed.libraries, &parsed.materials, resources, options);
    let origin = place::origin(&parsed.positions);
    let nothing_drawn =
        parsed.triangles.indices.is_empty() && parsed.lines.is_empty() && parsed.points.is_empty();
    if nothing_drawn {
        let message = format!(
            "no faces, lines or points: the {} vertices are taken as points",
            parsed.positions.len()
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
    for mesh in [lines, points].into_iter().flatten() {
        add(&mut model, mesh, origin);
    }
    whiten(&mut model);
    model.scene.check()?;
    Ok(model)
}

fn add(model: &mut Model, mesh: Mesh, origin: DVec3) {
    let (name, number) = (mesh.name.clone(), model.scene.meshes.len());
    model.scene.meshes.push(mesh);
    let world_from_mesh = place::matrix(origin);
    model.scene.instances.push(Instance { mesh: number, world_from_mesh, name });
}

/// Vertex colors replace the grey of the default material: meshes that have them and name no
/// material get a white one.
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

fn warn_of_repairs(model: &mut Model, repairs: &Repairs) {
    let word = &repairs.unknown_word;
    for (tally, message) in [
        (
            &repairs.unknown,
            format!("statements are not known and were skipped, the first: `{word}`"),
        ),
        (&repairs.short_faces, "elements have too few corners and were left out".to_owned()),
        (&repairs.non_finite, "vertices have a coordinate that is NaN or infinite".to_owned()),
        (&repairs.sloppy, "numbers have something behind them, which was ignored".to_owned()),
        (
            &repairs.no_attributes,
            "corners name texture coordinates or normals, of which the file has none".to_owned(),
        ),
        (
            &repairs.no_color,
            "vertices have no color where others have one; they are white".to_owned(),
        ),
        (&repairs.unnamed_parts, "further groups were joined to the last: too many".to_owned()),
    ] {
        if tally.count > 0 {
            model.warn(tally.first.clone(), format!("{} {message}", tally.count));
        }
    }
    if repairs.byte_colors {
        model.warn(Place::Whole, "vertex colors go up to 255 instead of 1; they were scaled");
    }
}

fn parts(runs: &[Run], count: usize) -> Vec<Part> {
    if let [Run { material: None, name, .. }] = runs
        && name.is_empty()
    {
        return Vec::new();
    }
    let ends = runs.iter().skip(1).map(|r| r.start).chain([count]);
    runs.iter()
        .zip(ends)
        .map(|(run, end)| Part {
            range: run.start as u32..end as u32,
            material: run.material,
            name: run.name.clone(),
        })
        .collect()
}

fn linear_colors(colors: impl Iterator<Item = Vec3>) -> Vec<Vec4> {
    colors.map(|c| color::linear3(c.to_array()).extend(1.0)).collect()
}

/// The mesh of lines or points, with only the vertices that it uses, in the file's order.
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
    mesh.parts = parts(runs, mesh.primitive_count());
    Some(mesh)
}

/// The mesh of triangles; vertices are the file's positions, or triples where corners have more.
fn triangles(model: &mut Model, parsed: Parsed, origin: DVec3) -> Mesh {
    let Parsed { positions, colors, tex_coords, normals, triangles, faces, .. } = parsed;
    let count = triangles.indices.len() / 3;
    let mut mesh = Mesh {
        parts: parts(&parsed.triangle_runs, count),
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
        fill_normals(model, &mut mesh, &keys);
    }
    mesh
}

/// Gives vertices without a normal the area-weighted mean of their triangles' normals.
fn fill_normals(model: &mut Model, mesh: &mut Mesh, keys: &[Corner]) {
    let missing = keys.iter().filter(|k| k.normal == NONE).count();
    if missing == 0 {
        return;
    }
    model.warn(
        Place::Whole,
        format!("{missing} vertices have no normal where others have; theirs were computed"),
    );
    for i in 0..mesh.triangle_count() {
        let corners = mesh.triangle(i);
        let [a, b, c] =
            corners.map(|v| mesh.positions.get(v as usize).copied().unwrap_or_default());
        let area_normal = (b - a).cross(c - a);
        for v in corners.map(|v| v as usize) {
            if keys.get(v).is_some_and(|k| k.normal == NONE)
                && let Some(n) = mesh.normals.get_mut(v)
            {
                *n += area_normal;
            }
        }
    }
    for (n, _) in mesh.normals.iter_mut().zip(keys).filter(|(_, k)| k.normal == NONE) {
        *n = n.normalize_or_zero();
    }
}
