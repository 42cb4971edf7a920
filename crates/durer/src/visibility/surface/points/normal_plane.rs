//! Normals as linear functions of the place on the screen.

use crate::math::Vec3;
use crate::target::NO_ITEM;
use crate::visibility::surface::points::patch::Patch;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x16};

/// The normals of an item, undivided: weighted by homogeneous edge functions, which are linear, they are linear
/// themselves, and only their direction matters.
///
/// Data of a triangle for points that are lit together, in one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct NormalPlane {
    /// Normals of the visible side, world axes, of any length: the constant and the changes along x and y. The fourth
    /// numbers are 0.
    pub(super) planes: [[f32; 4]; 3],
    /// The pixel from whose centre x and y are counted.
    pub origin: [i32; 2],
    /// The item.
    pub item: u32,
    /// True if the planes can be used: wherever a sample of the item may be, the normals are clearly on the visible
    /// side of the face, and their lengths are such that rounding cannot change that.
    pub settled: bool,
}

impl Default for NormalPlane {
    /// Creates the plane of no item.
    fn default() -> Self {
        Self { planes: [[0.0; 4]; 3], origin: [0; 2], item: NO_ITEM, settled: false }
    }
}

impl NormalPlane {
    /// Returns the offset of a pixel's centre from the origin.
    #[inline(always)]
    fn place(&self, [x, y]: [i32; 2]) -> [f32; 2] {
        [(x - self.origin[0]) as f32, (y - self.origin[1]) as f32]
    }

    /// Returns the normal at a pixel's centre.
    #[inline(always)]
    pub fn at(&self, pixel: [i32; 2]) -> Vec3 {
        let ([constant, dx, dy], [x, y]) = (&self.planes, self.place(pixel));
        let [x, y, z] = [0, 1, 2].map(|i| dx[i] * x + dy[i] * y + constant[i]);
        Vec3::new(x, y, z)
    }

    /// Returns the normal as [`Self::at`] does, bit for bit, and 0.
    #[inline(always)]
    pub fn at_x4<S: Simd>(&self, simd: S, pixel: [i32; 2]) -> f32x4<S> {
        let ([constant, dx, dy], [x, y]) = (&self.planes, self.place(pixel));
        let (dx, dy) = (f32x4::from_slice(simd, dx), f32x4::from_slice(simd, dy));
        dx * x + dy * y + f32x4::from_slice(simd, constant)
    }

    /// Returns the normals of the pixels of a patch as [`Self::at`] does, bit for bit.
    #[inline(always)]
    pub fn of_patch<S: Simd>(&self, simd: S, patch: Patch) -> [f32x16<S>; 3] {
        let ([constant, dx, dy], at) = (&self.planes, self.place(patch.at));
        let [x, y] = patch.places(simd, at);
        let mut normal = [x; 3];
        for (i, to) in normal.iter_mut().enumerate() {
            *to = x * dx[i] + y * dy[i] + constant[i];
        }
        normal
    }
}
