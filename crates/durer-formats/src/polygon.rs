//! Polygons of meshes to triangles.
//!
//! Readers add a polygon as a fan: triangles that all have its first corner. That is right if the whole polygon is
//! visible from that corner, as in convex ones. [`recut`] finds the others, once all positions are known, and replaces
//! them by the right triangles: ear clipping where the outline does not cross itself, which includes bridges to holes
//! that are walked twice; else the points around which the outline winds, by the non-zero rule. Corners that are not in
//! one plane are projected along Newell's normal (M. E. Newell's, as in I. E. Sutherland, R. F. Sproull and R. A.
//! Schumacker, *A Characterization of Ten Hidden-Surface Algorithms*, 1974).
//!
//! Triangles run around as their polygon does. Every corner stays a corner of a triangle, also on a
//! straight border, so that neighbours meet without gaps; only spikes without area go.
//! Cost: O(corners) for fans; O(n log n) on usual input for others, bounded by [`Budget`].

mod crossing;
mod ears;
mod plane;
mod rebuild;

use crate::text::Tally;
use crate::{Limits, Model, Place, Result};
use durer::math::DVec3;
use durer::scene::{Mesh, Topology};
use plane::Plane;
use rebuild::Replaced;
use std::ops::Range;

/// Number of tests of a point or an edge that may still be made, over all polygons of a mesh: for hostile outlines it
/// would grow with the cube of their corners.
#[derive(Debug)]
struct Budget(u64);

impl Budget {
    /// About a second's work.
    const TESTS: u64 = 1 << 28;

    /// Spends this many tests; `None` if they are used up.
    fn spend(&mut self, tests: usize) -> Option<()> {
        self.0 = self.0.checked_sub(tests as u64)?;
        Some(())
    }
}

/// Observations about the polygon.
#[derive(Debug, Default)]
struct Found {
    crossing: Tally,
    /// Left as fans.
    given_up: Tally,
}

/// Replaces the incorrect fans of [`Mesh::faces`] by triangles that cover their polygons, and warns of outlines that
/// cross themselves. Where lines cross, vertices are added, with interpolated attributes. Meshes whose faces are all
/// triangles are left alone at once.
///
/// # Errors
/// [`crate::Error::Limit`] if crossings make more triangles than allowed.
pub(crate) fn recut(model: &mut Model, mesh: &mut Mesh, limits: &Limits) -> Result<()> {
    if mesh.faces.is_empty() || mesh.topology != Topology::Triangles {
        return Ok(());
    }
    let (replaced, found) = replacements(mesh);
    if !replaced.is_empty() {
        replaced.put_into(mesh, limits)?;
    }
    for (tally, message) in [
        (
            &found.crossing,
            "{polygon crosses itself|polygons cross themselves}; filled by the non-zero rule",
        ),
        (
            &found.given_up,
            "{polygon is too intricate; shown as a fan from its first corner|polygons are too intricate; shown as fans from their first corners}",
        ),
    ] {
        model.warn_of(tally, message);
    }
    Ok(())
}

/// Returns the triangles of each face of a mesh of triangles.
pub(crate) fn faces(mesh: &Mesh) -> impl Iterator<Item = Range<usize>> + '_ {
    let count = mesh.triangle_count();
    let firsts = mesh.faces.iter().map(|&first| first as usize);
    let ends = firsts.clone().skip(1).chain([count]);
    let single = if mesh.faces.is_empty() { count } else { 0 };
    firsts.zip(ends).map(|(first, end)| first..end).chain((0..single).map(|i| i..i + 1))
}

/// Returns the triangles that replace fans.
fn replacements(mesh: &Mesh) -> (Replaced, Found) {
    let (mut replaced, mut found) = (Replaced::new(mesh), Found::default());
    let mut budget = Budget(Budget::TESTS);
    let indices = mesh.indices.as_deref().unwrap_or_default();
    let at = |v: &u32| mesh.positions.get(*v as usize).copied().unwrap_or_default().as_dvec3();
    let (mut corners, mut points) = (Vec::new(), Vec::new());
    for (face, range) in faces(mesh).enumerate() {
        let fan = indices.get(3 * range.start..3 * range.end).unwrap_or_default();
        match fan {
            [] | [_, _, _] => continue,
            [a, b, c, _, _, d] if quad_is_flat([a, b, c, d].map(at)) => continue,
            _ => {}
        }
        corners.clear();
        corners.extend(fan.iter().take(2).chain(fan.iter().skip(2).step_by(3)).copied());
        points.clear();
        points.extend(corners.iter().map(at));
        if !fan_is_right(&points) {
            replace(&points, &corners, face, &mut replaced, &mut found, &mut budget);
        }
    }
    (replaced, found)
}

/// Returns whether the two triangles of a fan are within a right angle of one plane, so that they form the quad.
fn quad_is_flat([a, b, c, d]: [DVec3; 4]) -> bool {
    let (b, c, d) = (b - a, c - a, d - a);
    b.cross(c).dot(c.cross(d)) >= 0.0
}

/// Returns whether the triangles from the first corner cover a polygon: all run as it does, and once
/// around.
fn fan_is_right(points: &[DVec3]) -> bool {
    let Some((&origin, rest)) = points.split_first() else { return true };
    let normals = || rest.windows(2).map(|w| [w[0] - origin, w[1] - origin]);
    let normal: DVec3 = normals().map(|[a, b]| a.cross(b)).sum();
    // Corners on a straight border turn in either direction by rounding.
    let runs_along = |[a, b]: [DVec3; 2]| {
        let turn = a.cross(b).dot(normal);
        turn >= 0.0 || turn >= -1e-12 * a.length() * b.length() * normal.length()
    };
    normal != DVec3::ZERO && normals().all(runs_along) && !winds_twice(origin, rest, normal)
}

/// Returns whether directions from the origin that turn in one direction pass the first one again.
fn winds_twice(origin: DVec3, rest: &[DVec3], normal: DVec3) -> bool {
    let Some(first) = rest.iter().map(|p| *p - origin).find(|d| *d != DVec3::ZERO) else {
        return false;
    };
    let side = |p: &DVec3| first.cross(*p - origin).dot(normal);
    let behind = rest.iter().position(|p| side(p) < 0.0);
    behind.is_some_and(|at| rest.iter().skip(at).any(|p| side(p) > 0.0))
}

/// Cuts one polygon up.
fn replace(
    points: &[DVec3],
    corners: &[u32],
    face: usize,
    replaced: &mut Replaced,
    found: &mut Found,
    budget: &mut Budget,
) {
    let place = || Place::Path(format!("face {}", face + 1));
    let Some(plane) = Plane::of(points) else { return };
    let flat: Vec<_> = points.iter().map(|p| plane.flat(*p)).collect();
    let mut triangles = Vec::with_capacity(corners.len());
    let whole = match crossing::count(&flat, budget) {
        Some(0) => ears::cut(&flat, budget, &mut triangles),
        Some(_) => Some(false),
        None => None,
    };
    match whole {
        Some(true) => replaced.add(face, corners, &triangles),
        // A twisted face is a fan as good as any: there is nothing where its edges seem to cross.
        Some(false) if plane.is_left_by(points) => {}
        Some(false) => match crossing::resolve(&flat, budget) {
            Some(resolved) => {
                found.crossing.add(place);
                replaced.add_resolved(face, corners, &resolved);
            }
            None => found.given_up.add(place),
        },
        None => found.given_up.add(place),
    }
}

#[cfg(test)]
mod tests;
