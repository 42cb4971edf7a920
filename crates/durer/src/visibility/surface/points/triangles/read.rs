//! The inputs for preparing eight primitives, read from their mesh and laid side by side.

use crate::scene::Mesh;
use crate::visibility::surface::gather::{four_columns, widened};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8, f64x8};

/// Eight vectors, by axis.
pub type Vectors<S> = [f32x8<S>; 3];

/// Numbers of three corners of eight triangles, by corner.
pub type Corners<S> = [f64x8<S>; 3];

/// Values of eight triangles at their corners, by corner.
pub type AtCorners<S> = [Vectors<S>; 3];

/// Positions and normals at the corners of eight primitives, as they are read from a mesh: before they are needed,
/// because they have to be waited for.
#[derive(Debug, Clone, Copy, Default)]
pub struct Read {
    /// By corner and primitive; the fourth numbers are unused.
    positions: [[[f32; 4]; 8]; 3],
    /// Normals in the same order; meaningless if the mesh has none.
    pub normals: [[[f32; 4]; 8]; 3],
}

impl Read {
    /// Reads the corners of one primitive.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, mesh: &Mesh, corners: [u32; 3]) {
        for (to, corner) in self.positions.iter_mut().zip(corners) {
            to[lane] = mesh.positions[corner as usize].extend(0.0).to_array();
        }
        if !mesh.normals.is_empty() {
            for (to, corner) in self.normals.iter_mut().zip(corners) {
                to[lane] = mesh.normals[corner as usize].extend(0.0).to_array();
            }
        }
    }
}

/// Returns the values that were read, side by side.
#[inline(always)]
pub fn at_corners<S: Simd>(simd: S, read: &[[[f32; 4]; 8]; 3]) -> AtCorners<S> {
    let mut at = [[simd.splat_f32x8(0.0); 3]; 3];
    for (to, from) in at.iter_mut().zip(read) {
        let mut rows = [simd.splat_f32x4(0.0); 8];
        for (row, from) in rows.iter_mut().zip(from) {
            *row = f32x4::from_slice(simd, from);
        }
        let [x, y, z, _] = four_columns(simd, rows);
        *to = [x, y, z];
    }
    at
}

/// Returns the positions.
#[inline(always)]
pub fn all_widened<S: Simd>(simd: S, read: &Read) -> [Corners<S>; 3] {
    let mut all = [[simd.splat_f64x8(0.0); 3]; 3];
    let positions = at_corners(simd, &read.positions);
    for (to, from) in all.as_flattened_mut().iter_mut().zip(positions.as_flattened()) {
        *to = widened(simd, *from);
    }
    all
}
