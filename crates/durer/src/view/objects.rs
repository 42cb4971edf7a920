//! Meshes of several objects as meshes of their own.

use super::components::number_off;
use super::near;
use crate::math::{DMat4, DVec3, Vec3};
use crate::scene::{Aabb, Instance, Mesh, Part, Scene, Topology};
use std::collections::BTreeMap;

/// Returns a scene in which each named part of a mesh of triangles is a separate instance; `None` if no mesh has
/// parts of two names. Files that distinguish objects only by names are read as one mesh; with this their objects are
/// the parts of assemblies ([`super::components`], [`super::explode`]).
///
/// Parts of one name are one object. Objects with similar names, such as `bolt.001` and `bolt.002`, that are equal up
/// to a shift are instances of one mesh. Memory: as much as the meshes. Cost: O(n log n) for n triangles of such
/// meshes.
pub fn divided(scene: &Scene) -> Option<Scene> {
    let objects: Vec<Vec<Mesh>> = scene.meshes.iter().map(objects).collect();
    if objects.iter().all(Vec::is_empty) {
        return None;
    }
    let mut all = Scene { meshes: Vec::new(), instances: Vec::new(), ..scene.clone() };
    let mut placed: Vec<Vec<Placed>> = Vec::with_capacity(objects.len());
    for (whole, objects) in scene.meshes.iter().zip(objects) {
        placed.push(match objects.is_empty() {
            true => vec![add(&mut all.meshes, whole.clone(), None)],
            false => shared(&mut all.meshes, objects, scene.last_digit),
        });
    }
    let mut trees = Vec::new();
    for (i, instance) in scene.instances.iter().enumerate() {
        for Placed { mesh, name, shift } in placed.get(instance.mesh).into_iter().flatten() {
            let name = name.clone().unwrap_or_else(|| instance.name.clone());
            let world_from_mesh = instance.world_from_mesh * DMat4::from_translation(*shift);
            all.instances.push(Instance { mesh: *mesh, world_from_mesh, name });
            trees.push(scene.trees.get(i).copied().unwrap_or(0));
        }
    }
    if !scene.trees.is_empty() {
        all.trees = trees;
    }
    Some(all)
}

/// A mesh in its place.
struct Placed {
    mesh: usize,
    /// `None` to use the instance's name.
    name: Option<String>,
    shift: DVec3,
}

fn add(meshes: &mut Vec<Mesh>, mesh: Mesh, name: Option<String>) -> Placed {
    meshes.push(mesh);
    Placed { mesh: meshes.len() - 1, name, shift: DVec3::ZERO }
}

/// Adds the meshes of objects; meshes that are equal up to a shift are added once.
fn shared(meshes: &mut Vec<Mesh>, objects: Vec<Mesh>, last_digit: f64) -> Vec<Placed> {
    let mut firsts: BTreeMap<String, usize> = BTreeMap::new();
    let mut placed = Vec::with_capacity(objects.len());
    for object in objects {
        let (name, stem) = (object.name.clone(), number_off(&object.name).to_owned());
        let like = firsts.get(&stem).copied().filter(|_| !stem.is_empty());
        let found = like.and_then(|mesh| Some((mesh, shift(&meshes[mesh], &object, last_digit)?)));
        match found {
            Some((mesh, shift)) => placed.push(Placed { mesh, name: Some(name), shift }),
            None => {
                placed.push(add(meshes, object, Some(name)));
                firsts.entry(stem).or_insert(meshes.len() - 1);
            }
        }
    }
    placed
}

/// Returns the translation that makes a mesh equal to another one, up to rounding.
fn shift(from: &Mesh, to: &Mesh, last_digit: f64) -> Option<DVec3> {
    let like = from.indices == to.indices
        && from.tex_coords == to.tex_coords
        && from.colors == to.colors
        && from.faces == to.faces
        && from.positions.len() == to.positions.len()
        && from
            .parts
            .iter()
            .map(|p| (&p.range, p.material))
            .eq(to.parts.iter().map(|p| (&p.range, p.material)));
    let points = |mesh: &Mesh| Aabb::around(mesh.positions.iter().map(|p| p.as_dvec3()));
    let (a, b) = points(from).filter(|_| like).zip(points(to))?;
    let way = b.center() - a.center();
    let largest = [a, b].map(|b| b.min.abs().max(b.max.abs()).max_element());
    let step = largest[0].max(largest[1]) * near::STEP;
    let near = near::reach(step, last_digit, a.size().max_element());
    let is_there =
        |(p, q): (&Vec3, &Vec3)| (p.as_dvec3() + way - q.as_dvec3()).abs().max_element() <= near;
    let normals = from.normals.iter().zip(&to.normals);
    let all = from.positions.iter().zip(&to.positions).all(is_there)
        && from.normals.len() == to.normals.len()
        && normals.into_iter().all(|(n, m)| n.abs_diff_eq(*m, 1e-3));
    all.then_some(way)
}

/// Returns the objects of a mesh by name, in the order of their first parts; none if there are not
/// two.
fn objects(mesh: &Mesh) -> Vec<Mesh> {
    let mut order: Vec<(&str, Vec<&Part>)> = Vec::new();
    let mut place: BTreeMap<&str, usize> = BTreeMap::new();
    for part in mesh.parts.iter().filter(|p| !p.range.is_empty()) {
        let index = *place.entry(&part.name).or_insert(order.len());
        if index == order.len() {
            order.push((&part.name, Vec::new()));
        }
        order[index].1.push(part);
    }
    if order.len() < 2 || mesh.topology != Topology::Triangles {
        return Vec::new();
    }
    order.iter().map(|(name, parts)| object(mesh, name, parts)).collect()
}

/// Returns the mesh of some parts of another.
fn object(mesh: &Mesh, name: &str, parts: &[&Part]) -> Mesh {
    let triangles = || parts.iter().flat_map(|p| p.range.clone()).map(|i| i as usize);
    let corners: Vec<u32> = triangles().flat_map(|i| mesh.triangle(i)).collect();
    let mut used = corners.clone();
    used.sort_unstable();
    used.dedup();
    let index = |corner: &u32| used.partition_point(|u| u < corner) as u32;
    let mut found = Mesh {
        name: name.to_owned(),
        topology: mesh.topology,
        positions: chosen(&mesh.positions, &used),
        normals: chosen(&mesh.normals, &used),
        tangents: chosen(&mesh.tangents, &used),
        tex_coords: mesh.tex_coords.iter().map(|set| chosen(set, &used)).collect(),
        colors: chosen(&mesh.colors, &used),
        indices: Some(corners.iter().map(index).collect()),
        ..Mesh::default()
    };
    let mut end = 0;
    for part in parts {
        let range = end..end + (part.range.end - part.range.start);
        let first = mesh.faces.partition_point(|f| *f < part.range.start);
        let faces = mesh.faces[first..].iter().take_while(|f| **f < part.range.end);
        found.faces.extend(faces.map(|f| f - part.range.start + range.start));
        end = range.end;
        found.parts.push(Part { range, ..(*part).clone() });
    }
    found
}

/// Returns the attributes of some vertices; none if there are none.
fn chosen<T: Copy>(all: &[T], used: &[u32]) -> Vec<T> {
    used.iter().filter_map(|i| all.get(*i as usize).copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_two_names_become_two_meshes() {
        let part = |range, name: &str| Part { range, material: None, name: name.to_owned() };
        let mesh = Mesh {
            positions: (0..6).map(|i| Vec3::splat(i as f32)).collect(),
            indices: Some(vec![0, 1, 2, 0, 2, 3, 3, 4, 5, 1, 2, 5]),
            faces: vec![0, 2, 3],
            parts: vec![part(0..2, "a"), part(2..3, "b"), part(3..4, "a")],
            ..Mesh::default()
        };
        let instance =
            Instance { mesh: 0, world_from_mesh: DMat4::IDENTITY, name: "all".to_owned() };
        let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
        let found = divided(&scene).expect("divided");
        found.check().expect("sound");
        let names: Vec<&str> = found.instances.iter().map(|i| i.name.as_str()).collect();
        assert_eq!(names, ["a", "b"]);
        let [a, b] = &found.meshes[..] else { panic!("{} meshes", found.meshes.len()) };
        assert_eq!(a.indices.as_deref(), Some(&[0, 1, 2, 0, 2, 3, 1, 2, 4][..]));
        assert_eq!((&a.faces[..], &b.faces[..]), (&[0, 2][..], &[0][..]));
        assert_eq!(a.positions[4], Vec3::splat(5.0));
        assert_eq!(b.positions, [3.0, 4.0, 5.0].map(Vec3::splat));
        assert_eq!(divided(&found), None);
    }

    #[test]
    fn objects_that_differ_by_a_shift_share_a_mesh() {
        let corner = |i: usize| [Vec3::ZERO, Vec3::X, Vec3::Y][i % 3];
        let shifts = [Vec3::ZERO, Vec3::new(2.0, 0.5, 0.0), Vec3::new(4.0, 0.0, 0.0)];
        let part = |i: usize, name: &str| Part {
            range: i as u32..i as u32 + 1,
            material: None,
            name: name.to_owned(),
        };
        let mut positions: Vec<Vec3> = (0..9).map(|i| corner(i) + shifts[i / 3]).collect();
        // The last of them is larger.
        positions[8] += Vec3::Y;
        let parts = ["bolt.1", "bolt.2", "bolt.3"].iter().zip(0..).map(|(name, i)| part(i, name));
        let mesh = Mesh { positions, parts: parts.collect(), ..Mesh::default() };
        let world_from_mesh = DMat4::from_scale(DVec3::splat(3.0));
        let instance = Instance { mesh: 0, world_from_mesh, name: String::new() };
        let scene = Scene { meshes: vec![mesh], instances: vec![instance], ..Scene::default() };
        let found = divided(&scene).expect("divided");
        let meshes: Vec<usize> = found.instances.iter().map(|i| i.mesh).collect();
        assert_eq!((meshes, found.meshes.len()), (vec![0, 0, 1], 2));
        let moved = found.instances[1].world_from_mesh.transform_point3(DVec3::X);
        assert_eq!(moved, DVec3::new(9.0, 1.5, 0.0));
        let names: Vec<&str> = found.instances.iter().map(|i| i.name.as_str()).collect();
        assert_eq!(names, ["bolt.1", "bolt.2", "bolt.3"]);
    }
}
