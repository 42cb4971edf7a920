//! The axes of a scene's surroundings.

use super::lane::{Lane, Vec3Lane};
use crate::math::Vec3;
use crate::scene::UpAxis;

/// Returns the components of a vector along axes.
#[inline(always)]
pub(super) fn turned<L: Lane>(v: Vec3Lane<L>, [x, y, z]: &[Vec3; 3]) -> Vec3Lane<L> {
    Vec3Lane::new(v.dot_all(*x), v.dot_all(*y), v.dot_all(*z))
}

/// Returns the axes to the right, up and to the front of a scene, as the named views show them.
pub(super) fn world_axes(up: UpAxis) -> [Vec3; 3] {
    [up.right(), up.up(), up.front()].map(|axis| axis.as_vec3())
}
