//! The parts that a scene is assembled of, as lists of parts name and count them.

use crate::scene::{Scene, Topology};

/// Parts of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// What they are called; never empty.
    pub name: String,
    /// Indices into [`Scene::instances`]: as many as there are of it.
    pub instances: Vec<usize>,
}

/// Finds the kinds of parts of a scene: instances of one mesh are of one kind. In the order of the first of each;
/// what has no triangles is no part.
///
/// A kind is called as its instances are, without the numbers that tell them apart: `bolt` for `bolt.001` and
/// `bolt.002`. Cost: O(n log n) for n instances.
pub fn components(scene: &Scene) -> Vec<Component> {
    let is_part = |mesh: usize| {
        let mesh = scene.meshes.get(mesh);
        mesh.is_some_and(|m| m.topology == Topology::Triangles && m.triangle_count() > 0)
    };
    let mut by_mesh: Vec<(usize, usize)> =
        scene.instances.iter().enumerate().map(|(i, placed)| (placed.mesh, i)).collect();
    by_mesh.retain(|(mesh, _)| is_part(*mesh));
    by_mesh.sort_unstable();
    let mut kinds: Vec<Vec<usize>> =
        by_mesh.chunk_by(|a, b| a.0 == b.0).map(|c| c.iter().map(|p| p.1).collect()).collect();
    kinds.sort_unstable_by_key(|instances| instances.first().copied());
    let component = |(index, instances): (usize, Vec<usize>)| {
        let names = instances.iter().filter_map(|i| scene.instances.get(*i));
        let names: Vec<&str> = names.map(|i| i.name.trim()).collect();
        Component { name: common_name(&names, index + 1), instances }
    };
    kinds.into_iter().enumerate().map(component).collect()
}

/// What instances of one kind are called, or by its number.
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

/// A name without the number at its end, and what divides the two.
fn number_off(name: &str) -> &str {
    let name = name.trim_end_matches(|c: char| c.is_ascii_digit());
    name.trim_end_matches(['.', '_', '-', ' ', ':', '#'])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{DMat4, Vec3};
    use crate::scene::{Instance, Mesh};

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
            components(&scene).into_iter().map(|c| (c.name, c.instances.len())).collect();
        let expected = [("plate", 1), ("M5", 2), ("part 3", 1), ("lid 2", 1)];
        assert_eq!(found, expected.map(|(name, count)| (name.to_owned(), count)));
    }
}
