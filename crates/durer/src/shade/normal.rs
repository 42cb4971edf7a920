//! The normal that a surface is lit with: turned to the viewer, and perturbed by a normal map.

use super::lane::{Lane, Vec3Lane};
use super::surface::{Surface, TexCoord};
use crate::math::{Vec2, Vec3};

/// The unit vectors of a surface point, all on the viewer's side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame<L> {
    /// Direction to the eye.
    pub view: Vec3Lane<L>,
    /// The face's own normal.
    pub face: Vec3Lane<L>,
    /// The interpolated normal.
    pub normal: Vec3Lane<L>,
}

/// Turns face and interpolated normal to the viewer's side of the face.
///
/// The face decides, not the interpolated normal, which near a silhouette may legitimately point away; so nothing is
/// black from behind, whatever the winding.
#[inline(always)]
pub(super) fn face_viewer<L: Lane>(
    view: Vec3Lane<L>,
    face: Vec3Lane<L>,
    normal: Vec3Lane<L>,
) -> Frame<L> {
    let zero = Vec3Lane::splat(view.x, Vec3::ZERO);
    let view = view.unit_or(zero);
    let facing = face.dot(view);
    let behind = Vec3Lane::if_above(facing.splat(0.0) - facing, 0.0, face.reversed(), zero);
    framed(view, Vec3Lane::if_above(facing, 0.0, face, behind), normal)
}

/// Returns the unit vectors where the face's normal is on the viewer's side already.
#[inline(always)]
pub(super) fn face_seen<L: Lane>(
    view: Vec3Lane<L>,
    face: Vec3Lane<L>,
    normal: Vec3Lane<L>,
) -> Frame<L> {
    framed(view.unit_or(Vec3Lane::splat(view.x, Vec3::ZERO)), face, normal)
}

/// Creates the frame from a unit vector to the eye and a face on its side. If the normal is missing (zero, NaN), the
/// face's is taken, or else the direction to the eye.
#[inline(always)]
fn framed<L: Lane>(view: Vec3Lane<L>, face: Vec3Lane<L>, normal: Vec3Lane<L>) -> Frame<L> {
    let face = Vec3Lane::if_above(face.dot(face), 0.0, face, view);
    let normal = normal.unit_or(face);
    let agrees = normal.dot(face);
    let normal = Vec3Lane::if_above(agrees, 0.0, normal, normal.reversed());
    Frame { view, face, normal }
}

/// Returns the normal of a normal map, in the space of the surface and on the side of
/// `surface.normal`.
///
/// `map` holds the map's x, y (up in the image) and z, scaled. Without tangents the frame comes from
/// the screen derivatives: Mikkelsen, *Bump Mapping Unparametrized Surfaces on the GPU*, 2010.
#[inline]
pub(super) fn perturbed(surface: &Surface<'_>, at: TexCoord, map: Vec3) -> Vec3 {
    let n = surface.normal.normalize_or(surface.geometric_normal);
    let (t, b) = match surface.tangent {
        Some(tangent) => {
            let t = tangent.truncate();
            let t = (t - n * n.dot(t)).normalize_or_zero();
            (t, n.cross(t) * tangent.w)
        }
        None => tangents(surface.position_dx, surface.position_dy, at, n),
    };
    let bent = (t * map.x + b * map.y + n * map.z).normalize_or(n);
    if bent.is_finite() { bent } else { n }
}

/// Returns the tangent and bitangent (towards the top of the image) of the unit normal `n`, of equal scale.
fn tangents(dpdx: Vec3, dpdy: Vec3, at: TexCoord, n: Vec3) -> (Vec3, Vec3) {
    // Gradients of u and v on the surface, up to a common factor of which only the sign matters.
    let (across_x, across_y) = (n.cross(dpdx), dpdy.cross(n));
    let gradient = |c: fn(Vec2) -> f32| across_y * c(at.ddx) + across_x * c(at.ddy);
    let (t, b) = (gradient(|d| d.x), gradient(|d| d.y));
    let side = if dpdx.dot(across_y) < 0.0 { -1.0 } else { 1.0 };
    let largest = t.length_squared().max(b.length_squared());
    if largest > 0.0 && largest.is_finite() {
        let scale = side / largest.sqrt();
        (t * scale, b * -scale)
    } else {
        (Vec3::ZERO, Vec3::ZERO)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(view: Vec3, face: Vec3, normal: Vec3) -> (Vec3, Vec3) {
        let f = face_viewer(view.into(), face.into(), normal.into());
        (f.face.into(), f.normal.into())
    }

    #[test]
    fn everything_faces_the_viewer() {
        let tilted = Vec3::new(0.6, 0.0, 0.8);
        for (face, normal) in [(Vec3::Z, tilted), (-Vec3::Z, -tilted), (Vec3::Z, -tilted)] {
            assert_eq!(framed(Vec3::Z * 5.0, face, normal), (Vec3::Z, tilted));
        }
        // A normal that points away at a silhouette is kept.
        let away = Vec3::new(0.995, 0.0, -0.0998).normalize();
        let face = Vec3::new(0.995, 0.0, 0.0998).normalize();
        assert!((framed(Vec3::Z, face, away).1 - away).length() < 1e-6);
        // Missing normals are replaced.
        assert_eq!(framed(Vec3::Z, Vec3::X, Vec3::ZERO).1, Vec3::Z);
        assert_eq!(framed(Vec3::Z, Vec3::ZERO, Vec3::NAN).1, Vec3::Z);
        assert_eq!(framed(Vec3::Z, Vec3::ZERO, -tilted).1, tilted);
    }

    #[test]
    fn derivatives_give_the_frame_that_tangents_give() {
        // A picture on the plane z = 0, u to the right, v downwards, rotated by 30°.
        let (c, s) = (0.866_025_4_f32, 0.5);
        let map = Vec3::new(0.3, -0.2, 0.93).normalize();
        for mirrored in [1.0_f32, -1.0] {
            // Screen x and y (down) on the plane, and u, v of a point (x, y): (±x, −y).
            let (dx, dy) = (Vec3::new(c, s, 0.0), Vec3::new(s, -c, 0.0));
            let uv = |p: Vec3| Vec2::new(p.x * mirrored, -p.y);
            let at = TexCoord { uv: Vec2::ZERO, ddx: uv(dx), ddy: uv(dy) };
            let bare = Surface {
                normal: Vec3::Z,
                geometric_normal: Vec3::Z,
                position_dx: dx,
                position_dy: dy,
                ..Surface::default()
            };
            let tangent = Some(Vec3::new(mirrored, 0.0, 0.0).extend(mirrored));
            let given = Surface { tangent, ..bare };
            let expected = Vec3::new(map.x * mirrored, map.y, map.z);
            assert!((perturbed(&given, at, map) - expected).length() < 1e-6);
            assert!((perturbed(&bare, at, map) - expected).length() < 1e-6);
        }
    }

    #[test]
    fn a_flat_map_and_a_missing_frame_change_nothing() {
        let surface = Surface { normal: Vec3::Y, ..Surface::default() };
        let at = TexCoord::default();
        assert_eq!(perturbed(&surface, at, Vec3::Z), Vec3::Y);
        assert_eq!(perturbed(&surface, at, Vec3::new(0.5, 0.5, 0.7)), Vec3::Y);
        let nan = Surface { tangent: Some(crate::math::Vec4::NAN), ..surface };
        assert_eq!(perturbed(&nan, at, Vec3::X), Vec3::Y);
    }
}
