//! Corners of eight triangles side by side.

use fearless_simd::{Simd, f32x8, i32x8, u32x8};

/// Triangles that are set up at a time.
pub const EIGHT: usize = 8;

/// One corner of eight triangles.
#[derive(Clone, Copy)]
pub struct Corner<S: Simd> {
    pub x: i32x8<S>,
    pub y: i32x8<S>,
    pub code: u32x8<S>,
    pub depth: f32x8<S>,
}
