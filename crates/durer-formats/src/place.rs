//! Moving a far-off model to its middle, so that single precision keeps its detail.

use durer::math::{DMat4, DVec3, Vec3};
use durer::scene::Aabb;

/// A model is far off where its coordinates exceed its extent by this factor: beyond it, single
/// precision would keep fewer than 21 bits of the extent. Nearer models keep their coordinates.
const FAR: f64 = 8.0;

/// Returns the origin to store positions against: zero, or for a far-off model its middle.
pub(crate) fn origin(points: &[DVec3]) -> DVec3 {
    origin_of(Aabb::around(points.iter().copied()))
}

/// Returns the [`origin`] for points with this box around them.
pub(crate) fn origin_of(bounds: Option<Aabb>) -> DVec3 {
    let Some(bounds) = bounds else { return DVec3::ZERO };
    let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let extent = bounds.size().max_element();
    let middle = bounds.center();
    if farthest > FAR * extent && extent > 0.0 && middle.is_finite() { middle } else { DVec3::ZERO }
}

/// Returns single-precision positions relative to `origin`.
pub(crate) fn narrow(points: &[DVec3], origin: DVec3) -> Vec<Vec3> {
    points.iter().map(|&p| (p - origin).as_vec3()).collect()
}

/// Returns the matrix from positions relative to `origin` to the file's coordinates.
pub(crate) fn matrix(origin: DVec3) -> DMat4 {
    DMat4::from_translation(origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_off_detail_survives() {
        let base = DVec3::new(4.5e6, 5.1e6, 300.0);
        let points = [base, base + DVec3::new(0.001, 0.0, 0.0), base + DVec3::splat(2.0)];
        let o = origin(&points);
        for (p, q) in points.iter().zip(narrow(&points, o)) {
            assert!((q.as_dvec3() + o - *p).length() < 1e-6);
        }
        assert_eq!(origin(&[DVec3::ZERO, DVec3::ONE]), DVec3::ZERO);
    }
}
