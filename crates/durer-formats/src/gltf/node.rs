//! The tree of nodes: checked once, then walked without recursion.

use super::json::{Node, Root, Whole};
use crate::{Error, Place, Result};
use durer::math::{DMat4, DQuat, DVec3};

/// Values that an animation sets for a node.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Override {
    /// Translation in the parent's space.
    pub translation: Option<DVec3>,
    /// Need not have unit length.
    pub rotation: Option<DQuat>,
    /// Scale along the node's axes.
    pub scale: Option<DVec3>,
    /// One per morph target.
    pub weights: Option<Vec<f32>>,
}

impl Override {
    /// Returns whether the node's place changes.
    pub fn moves(&self) -> bool {
        self.translation.is_some() || self.rotation.is_some() || self.scale.is_some()
    }
}

/// The nodes' forest.
#[derive(Debug)]
pub struct Tree {
    /// Each node's parent.
    pub parents: Vec<Option<usize>>,
    /// All nodes, each after its parent.
    order: Vec<usize>,
}

impl Tree {
    /// Checks that the nodes are a forest. It may be as deep as there are nodes: nothing recurses.
    ///
    /// # Errors
    /// If a node has two parents or is its own ancestor, or there are more than `most` nodes.
    pub fn of(root: &Root, most: u64) -> Result<Self> {
        let (value, limit) = (root.nodes.len() as u64, most);
        if value > limit {
            let place = Place::Path("nodes".to_owned());
            return Err(Error::Limit { place, what: "number of nodes", value, limit });
        }
        let parents = parents(root)?;
        let roots = (0..parents.len()).filter(|&n| parents[n].is_none());
        let order: Vec<usize> = walk(root, roots).collect();
        if order.len() < parents.len() {
            let mut reached = vec![false; parents.len()];
            order.iter().for_each(|&n| reached[n] = true);
            let first = reached.iter().position(|r| !r).unwrap_or_default();
            return Err(Error::path(format!("nodes[{first}]"), "is its own ancestor"));
        }
        Ok(Self { parents, order })
    }

    /// Returns each node's matrix to the world, in which the file's origin is at `center`.
    pub fn world_matrices(&self, root: &Root, pose: &[Override], center: DVec3) -> Vec<DMat4> {
        let mut world = vec![DMat4::IDENTITY; self.parents.len()];
        for &n in &self.order {
            let local = local_matrix(&root.nodes[n], &pose[n]);
            let moved = || DMat4::from_translation(center) * local;
            world[n] = self.parents[n].map_or_else(moved, |p| world[p] * local);
        }
        world
    }

    /// Returns the nodes of the chosen scene, else of the default scene (or the first one if that does not exist, or all
    /// nodes of a file without scenes), in drawing order: depth first, as in the file. A node below another one of the scene appears once; the
    /// nodes of the scene that are not roots are passed to `odd`.
    pub fn scene_nodes(
        &self,
        root: &Root,
        chosen: Option<usize>,
        mut odd: impl FnMut(usize),
    ) -> Vec<usize> {
        let scene = chosen.unwrap_or_else(|| root.scene.map_or(0, Whole::index));
        let scene = root.scenes.get(scene).or(root.scenes.first());
        let roots: Vec<usize> = match scene {
            Some(scene) => scene.nodes.iter().map(|n| n.index()).collect(),
            None => (0..self.parents.len()).filter(|&n| self.parents[n].is_none()).collect(),
        };
        roots.iter().copied().filter(|&n| self.parents[n].is_some()).for_each(&mut odd);
        let mut listed = vec![false; self.parents.len()];
        roots.iter().for_each(|&n| listed[n] = true);
        let under = self.below(|n| listed[n]);
        let tops: Vec<usize> = roots.into_iter().filter(|&n| !under[n]).collect();
        let first_time = |n: &usize| std::mem::replace(&mut listed[*n], false);
        let tops: Vec<usize> = tops.into_iter().filter(first_time).collect();
        walk(root, tops.into_iter()).collect()
    }

    /// Returns for each node whether `is` holds for one of its ancestors.
    fn below(&self, is: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut below = vec![false; self.parents.len()];
        for &n in &self.order {
            below[n] = self.parents[n].is_some_and(|p| below[p] || is(p));
        }
        below
    }

    /// Returns for each node whether KHR_node_visibility lets it be seen: itself and all of its ancestors.
    pub fn visible(&self, root: &Root) -> Vec<bool> {
        let hidden = |n: usize| {
            let visibility = root.nodes[n].extensions.visibility.as_ref();
            visibility.and_then(|v| v.visible) == Some(false)
        };
        let below = self.below(hidden);
        below.into_iter().enumerate().map(|(n, below)| !below && !hidden(n)).collect()
    }
}

/// Returns each node's parent.
fn parents(root: &Root) -> Result<Vec<Option<usize>>> {
    let mut parents = vec![None; root.nodes.len()];
    for (n, node) in root.nodes.iter().enumerate() {
        for child in &node.children {
            if let Some(first) = parents[child.index()].replace(n) {
                let message = format!("has two parents, nodes {first} and {n}");
                return Err(Error::path(format!("nodes[{}]", child.0), message));
            }
        }
    }
    Ok(parents)
}

/// Visits nodes depth first, as in the file. Ends, because no node has two parents, so a walk from a root cannot reach
/// a cycle.
fn walk(root: &Root, roots: impl DoubleEndedIterator<Item = usize>) -> impl Iterator<Item = usize> {
    let mut stack: Vec<usize> = roots.rev().collect();
    std::iter::from_fn(move || {
        let node = stack.pop()?;
        stack.extend(root.nodes[node].children.iter().rev().map(|c| c.index()));
        Some(node)
    })
}

/// Returns a node's matrix to its parent.
fn local_matrix(node: &Node, pose: &Override) -> DMat4 {
    if let (Some(matrix), false) = (&node.matrix, pose.moves()) {
        return DMat4::from_cols_array(matrix);
    }
    let translation = pose.translation.unwrap_or(node.translation.map_or(DVec3::ZERO, DVec3::from));
    let scale = pose.scale.unwrap_or(node.scale.map_or(DVec3::ONE, DVec3::from));
    let rotation =
        pose.rotation.unwrap_or(node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array));
    DMat4::from_scale_rotation_translation(scale, unit(rotation), translation)
}

/// Returns the quaternion at unit length; one without a direction turns nothing.
pub fn unit(q: DQuat) -> DQuat {
    let length = q.length();
    if length.is_finite() && length > 1e-12 { q * (1.0 / length) } else { DQuat::IDENTITY }
}
