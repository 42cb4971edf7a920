//! Meshes posed: morph targets, then skins (glTF 2.0, §3.7.2.2 and §3.7.3).

use super::buffer::Source;
use super::geometry::Geometry;
use super::json::{Primitive, Whole};
use crate::{Error, Result};
use durer::math::{DMat3, DMat4, DVec3, Vec3};

/// Moves vertices by the weighted sum of the morph targets' differences.
///
/// Missing weights are 0; normals and tangents are left as long as they become.
///
/// # Errors
/// If a target has another number of vertices, or its data are broken.
pub fn morph(
    source: &Source<'_>,
    g: &mut Geometry,
    primitive: &Primitive,
    weights: &[f32],
    at: &str,
) -> Result<()> {
    let active = primitive.targets.iter().zip(weights).enumerate().filter(|(_, (_, w))| **w != 0.0);
    for (t, (target, &weight)) in active {
        let read = |name: &str| -> Result<Vec<[f32; 3]>> {
            let Some(&accessor) = target.get(name) else { return Ok(Vec::new()) };
            let at = format!("{at}.targets[{t}].{name}");
            let deltas = source.floats::<3>(accessor, &at)?;
            if deltas.len() == g.mesh.positions.len() {
                return Ok(deltas);
            }
            let message =
                format!("has {} elements for {} vertices", deltas.len(), g.mesh.positions.len());
            Err(Error::path(at, message))
        };
        let (positions, normals, tangents) = (read("POSITION")?, read("NORMAL")?, read("TANGENT")?);
        let add = |v: &mut Vec3, delta: [f32; 3]| *v += Vec3::from(delta) * weight;
        g.mesh.positions.iter_mut().zip(positions).for_each(|(p, d)| add(p, d));
        g.mesh.normals.iter_mut().zip(normals).for_each(|(n, d)| add(n, d));
        for (tangent, delta) in g.mesh.tangents.iter_mut().zip(tangents) {
            *tangent += (Vec3::from(delta) * weight).extend(0.0);
        }
        morph_sets(source, g, target, weight, &format!("{at}.targets[{t}]"))?;
    }
    Ok(())
}

/// Moves texture coordinates and colours, for [`morph`].
fn morph_sets(
    source: &Source<'_>,
    g: &mut Geometry,
    target: &std::collections::BTreeMap<String, Whole>,
    weight: f32,
    at: &str,
) -> Result<()> {
    for (i, set) in g.mesh.tex_coords.iter_mut().enumerate() {
        let name = format!("TEXCOORD_{i}");
        if let Some(&accessor) = target.get(&name) {
            let deltas = source.floats::<2>(accessor, &format!("{at}.{name}"))?;
            set.iter_mut().zip(deltas).for_each(|(uv, [u, v])| {
                uv.x += u * weight;
                uv.y += v * weight;
            });
        }
    }
    let Some(&accessor) = target.get("COLOR_0").filter(|_| !g.mesh.colors.is_empty()) else {
        return Ok(());
    };
    let alpha = source.root.accessors.get(accessor.index()).is_some_and(|a| a.shape == "VEC4");
    let at = format!("{at}.COLOR_0");
    let deltas: Vec<[f32; 4]> = if alpha {
        source.floats::<4>(accessor, &at)?
    } else {
        source.floats::<3>(accessor, &at)?.into_iter().map(|[r, g, b]| [r, g, b, 0.0]).collect()
    };
    let moved = g.mesh.colors.iter_mut().zip(deltas);
    moved.for_each(|(c, d)| *c += durer::math::Vec4::from(d) * weight);
    Ok(())
}

/// Returns each joint's matrix from mesh space to the world: the joint's current matrix times its inverse bind matrix.
///
/// # Errors
/// If there are fewer inverse bind matrices than joints.
pub fn joint_matrices(source: &Source<'_>, skin: Whole, world: &[DMat4]) -> Result<Vec<DMat4>> {
    let at = format!("skins[{}]", skin.0);
    let Some(skin) = source.root.skins.get(skin.index()) else {
        return Err(Error::path(at, "does not exist"));
    };
    let inverse: Vec<DMat4> = match skin.inverse_bind_matrices {
        Some(accessor) => {
            let at = format!("{at}.inverseBindMatrices");
            let matrices = source.floats::<16>(accessor, &at)?;
            if matrices.len() < skin.joints.len() {
                let message =
                    format!("{} matrices for {} joints", matrices.len(), skin.joints.len());
                return Err(Error::path(at, message));
            }
            matrices.iter().map(|m| DMat4::from_cols_array(&m.map(f64::from))).collect()
        }
        None => vec![DMat4::IDENTITY; skin.joints.len()],
    };
    let joint = |n: &Whole| world.get(n.index()).copied().unwrap_or_default();
    Ok(skin.joints.iter().map(joint).zip(inverse).map(|(world, inverse)| world * inverse).collect())
}

/// Transforms vertices to the world by the weighted mean of their joints' matrices (linear blend skinning); weights are
/// divided by their sum, and a vertex without weights follows joint 0.
///
/// # Errors
/// If a vertex follows a joint that the skin does not have.
pub fn skin(g: &mut Geometry, joints: &[DMat4], at: &str) -> Result<()> {
    for v in 0..g.mesh.positions.len() {
        let matrix = blend(g, v, joints, at)?;
        g.mesh.positions[v] = matrix.transform_point3(g.mesh.positions[v].as_dvec3()).as_vec3();
        let linear = DMat3::from_mat4(matrix);
        if let Some(normal) = g.mesh.normals.get_mut(v) {
            // Normals go by the cofactors, which a singular matrix has too.
            let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
            let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
            let turned = cofactors * normal.as_dvec3() * linear.determinant().signum();
            *normal = turned.try_normalize().unwrap_or(DVec3::ZERO).as_vec3();
        }
        if let Some(tangent) = g.mesh.tangents.get_mut(v) {
            let turned = linear * tangent.truncate().as_dvec3();
            *tangent = turned.normalize_or_zero().as_vec3().extend(tangent.w);
        }
    }
    Ok(())
}

/// Returns the weighted mean of the matrices that vertex `v` follows.
fn blend(g: &Geometry, v: usize, joints: &[DMat4], at: &str) -> Result<DMat4> {
    let (mut sum, mut total) = (DMat4::ZERO, 0.0);
    for (set, four) in g.influences.iter().enumerate() {
        for (&joint, &weight) in four.joints[v].iter().zip(&four.weights[v]) {
            if weight == 0.0 || !weight.is_finite() {
                continue;
            }
            let Some(matrix) = joints.get(joint as usize) else {
                let message = format!("vertex {v} follows joint {joint} of {}", joints.len());
                return Err(Error::path(format!("{at}.attributes.JOINTS_{set}"), message));
            };
            sum += *matrix * f64::from(weight);
            total += f64::from(weight);
        }
    }
    if total == 0.0 {
        return Ok(joints.first().copied().unwrap_or_default());
    }
    Ok(sum * (1.0 / total))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gltf::geometry::Influences;
    use durer::math::Vec4;
    use durer::scene::Mesh;

    #[test]
    fn normals_stay_perpendicular_under_scale_and_mirror() {
        // A plane through x + y = 0, stretched along x and mirrored along z.
        let mut g = Geometry {
            mesh: Mesh {
                positions: vec![Vec3::ZERO, Vec3::new(1.0, -1.0, 0.0), Vec3::Z],
                normals: vec![Vec3::new(1.0, 1.0, 0.0).normalize(); 3],
                tangents: vec![Vec4::new(0.0, 0.0, 1.0, -1.0); 3],
                ..Mesh::default()
            },
            influences: vec![Influences { joints: vec![[0; 4]; 3], weights: vec![[1.0; 4]; 3] }],
            ..Geometry::default()
        };
        let joint = DMat4::from_scale(DVec3::new(3.0, 1.0, -2.0));
        skin(&mut g, &[joint], "here").unwrap();
        let [a, b, c] = [0, 1, 2].map(|i| g.mesh.positions[i]);
        assert_eq!([a, b, c], [Vec3::ZERO, Vec3::new(3.0, -1.0, 0.0), Vec3::Z * -2.0]);
        let normal = g.mesh.normals[0];
        assert!(normal.dot(b).abs() < 1e-6 && normal.dot(c).abs() < 1e-6, "{normal}");
        // On the same side as before: towards growing x and y.
        assert!((normal.length() - 1.0).abs() < 1e-6 && normal.x > 0.0 && normal.y > 0.0);
        assert_eq!(g.mesh.tangents[0], Vec4::new(0.0, 0.0, -1.0, -1.0));
    }
}
