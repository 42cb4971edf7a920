//! `EXT_mesh_gpu_instancing`: a node's mesh at many places.

use super::buffer::Source;
use super::json::Instancing;
use super::node::unit;
use crate::{Error, Result};
use durer::math::{DMat4, DQuat, DVec3};

/// Returns the matrices of the instances in their node's space; data that the scene cannot hold, such as an
/// application's own attributes, are ignored.
///
/// # Errors
/// If an attribute is broken, or they have different numbers of elements.
pub fn matrices(source: &Source<'_>, instancing: &Instancing, node: usize) -> Result<Vec<DMat4>> {
    let at = format!("nodes[{node}].extensions.EXT_mesh_gpu_instancing.attributes");
    let translations = read::<3>(source, instancing, "TRANSLATION", &at)?;
    let rotations = read::<4>(source, instancing, "ROTATION", &at)?;
    let scales = read::<3>(source, instancing, "SCALE", &at)?;
    let counts = [&translations.count(), &rotations.count(), &scales.count()];
    let mut given = counts.into_iter().flatten();
    // Without any of them all instances are in one place, where one looks like many.
    let count = given.next().copied().unwrap_or(1);
    if let Some(other) = given.find(|other| **other != count) {
        let message = format!("their numbers of elements differ: {count} and {other}");
        return Err(Error::path(at, message));
    }
    source.budget.bytes((count as u64).saturating_mul(size_of::<DMat4>() as u64), &at)?;
    let matrix = |i: usize| {
        let [x, y, z, w] = rotations.at(i).unwrap_or([0.0, 0.0, 0.0, 1.0]);
        DMat4::from_scale_rotation_translation(
            scales.at(i).map_or(DVec3::ONE, DVec3::from),
            unit(DQuat::from_xyzw(x, y, z, w)),
            translations.at(i).map_or(DVec3::ZERO, DVec3::from),
        )
    };
    Ok((0..count).map(matrix).collect())
}

/// The elements of one attribute, if there is one.
struct Attribute<const N: usize>(Option<Vec<[f32; N]>>);

impl<const N: usize> Attribute<N> {
    fn count(&self) -> Option<usize> {
        self.0.as_ref().map(Vec::len)
    }

    fn at(&self, i: usize) -> Option<[f64; N]> {
        self.0.as_ref()?.get(i).map(|element| element.map(f64::from))
    }
}

fn read<const N: usize>(
    source: &Source<'_>,
    instancing: &Instancing,
    name: &str,
    at: &str,
) -> Result<Attribute<N>> {
    let accessor = instancing.attributes.get(name);
    let elements = accessor.map(|a| source.floats::<N>(*a, &format!("{at}.{name}"))).transpose()?;
    Ok(Attribute(elements))
}
