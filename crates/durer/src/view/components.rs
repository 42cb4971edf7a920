//! The parts that a scene is assembled of, as lists of parts name and count them.

use crate::scene::{Instance, Scene, Topology};

/// Parts of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Common name; never empty.
    pub name: String,
    /// Number of its instances.
    pub count: usize,
    /// Indices into [`Scene::instances`] of all their instances.
    pub instances: Vec<usize>,
}

/// Finds the kinds of parts of a scene: parts made of the same meshes are of one kind. Kinds are in the order of their
/// first parts; instances without triangles are not parts.
///
/// A kind has the name of its parts without the numbers that distinguish them: `bolt` for `bolt.001` and
/// `bolt.002`. Cost: O(n log n) for n instances.
pub fn components(scene: &Scene) -> Vec<Component> {
    let is_seen = |i: &usize| {
        let mesh = scene.instances.get(*i).and_then(|placed| scene.meshes.get(placed.mesh));
        mesh.is_some_and(|m| m.topology == Topology::Triangles && m.triangle_count() > 0)
    };
    let mesh = |i: &usize| scene.instances.get(*i).map(|placed| placed.mesh);
    let seen = parts(scene).into_iter().map(|part| part.into_iter().filter(is_seen).collect());
    let mut by_meshes: Vec<(Vec<Option<usize>>, Vec<usize>)> = seen
        .filter(|part: &Vec<usize>| !part.is_empty())
        .map(|part| (part.iter().map(mesh).collect(), part))
        .collect();
    by_meshes.sort_unstable();
    let mut kinds: Vec<Vec<Vec<usize>>> = by_meshes
        .chunk_by(|a, b| a.0 == b.0)
        .map(|c| c.iter().map(|p| p.1.clone()).collect())
        .collect();
    kinds.sort_unstable();
    let component = |(index, parts): (usize, Vec<Vec<usize>>)| {
        let first = parts.iter().filter_map(|part| scene.instances.get(*part.first()?));
        let names: Vec<&str> = first.map(|i| i.name.trim()).collect();
        let (name, count) = (common_name(&names, index + 1), parts.len());
        Component { name, count, instances: parts.into_iter().flatten().collect() }
    };
    kinds.into_iter().enumerate().map(component).collect()
}

/// Returns the instances of each part: consecutive ones with the same place and name, because files have an instance
/// for each material of an object.
pub(super) fn parts(scene: &Scene) -> Vec<Vec<usize>> {
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut last: Option<&Instance> = None;
    for (i, instance) in scene.instances.iter().enumerate() {
        let goes_on = last.is_some_and(|last| {
            !instance.name.is_empty()
                && last.name == instance.name
                && last.world_from_mesh == instance.world_from_mesh
                && last.mesh != instance.mesh
        });
        match parts.last_mut() {
            Some(part) if goes_on => part.push(i),
            _ => parts.push(vec![i]),
        }
        last = Some(instance);
    }
    parts
}

/// Returns the common name of instances of one kind, or one made from its number.
fn common_name(names: &[&str], number: usize) -> String {
    let first = names.first().copied().unwrap_or_default();
    let alike = names.iter().all(|n| *n == first);
    let stem = if alike { first } else { number_off(first) };
    if first.is_empty() {
        format!("part {number}")
    } else if !stem.is_empty() && names.iter().all(|n| alike || number_off(n) == stem) {
        stem.to_owned()
    } else {
        first.to_owned()
    }
}

/// Returns a name without the number at its end and the separator before it.
pub(super) fn number_off(name: &str) -> &str {
    let name = name.trim_end_matches(|c: char| c.is_ascii_digit());
    name.trim_end_matches(['.', '_', '-', ' ', ':', '#'])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DMat4, Vec3};
    use crate::scene::Mesh;

    #[test]
    fn instances_of_one_mesh_are_counted_and_named_by_what_they_share() {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Mesh::default() };
        let line = Mesh { topology: Topology::Lines, ..mesh.clone() };
        let named =
            [(1, "plate"), (0, "M5.001"), (2, "axis"), (0, "M5.002"), (3, ""), (4, "lid 2")];
        let instance = |(mesh, name): (usize, &str)| Instance {
            mesh,
            world_from_mesh: DMat4::IDENTITY,
            name: name.to_owned(),
        };
        let scene = Scene {
            meshes: vec![mesh.clone(), mesh.clone(), line, mesh.clone(), mesh],
            instances: named.map(instance).to_vec(),
            ..Scene::default()
        };
        let found: Vec<(String, usize)> =
            components(&scene).into_iter().map(|c| (c.name, c.count)).collect();
        let expected = [("plate", 1), ("M5", 2), ("part 3", 1), ("lid 2", 1)];
        assert_eq!(found, expected.map(|(name, count)| (name.to_owned(), count)));
    }

    #[test]
    fn materials_of_one_object_are_one_part() {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Mesh::default() };
        let at = |mesh, x: f64, name: &str| Instance {
            mesh,
            world_from_mesh: DMat4::from_translation(crate::math::DVec3::X * x),
            name: name.to_owned(),
        };
        // A wheel of rubber and steel, twice, and an axle.
        let wheels = [0.0, 9.0].map(|x| [at(0, x, "wheel"), at(1, x, "wheel")]);
        let mut instances: Vec<Instance> = wheels.into_iter().flatten().collect();
        instances.push(at(2, 0.0, "axle"));
        let scene = Scene { meshes: vec![mesh; 3], instances, ..Scene::default() };
        let found = components(&scene);
        let wheel = Component { name: "wheel".to_owned(), count: 2, instances: vec![0, 1, 2, 3] };
        let axle = Component { name: "axle".to_owned(), count: 1, instances: vec![4] };
        assert_eq!(found, [wheel, axle]);
        let exploded = crate::view::explode::explode(
            &scene,
            crate::view::explode::ExplodeDirection::Radial,
            None,
        );
        let places: Vec<DMat4> =
            exploded.expect("exploded").instances.iter().map(|i| i.world_from_mesh).collect();
        assert!(places[0] == places[1] && places[2] == places[3] && places[0] != places[2]);
    }
}
