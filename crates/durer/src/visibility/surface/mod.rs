//! Algorithms for visible surfaces, their input, and the lighting that they share.

pub mod a_buffer;
pub mod ambient_occlusion;
pub(crate) mod background;
pub(crate) mod comparisons;
pub(crate) mod cover;
pub mod depth_sort;
pub(crate) mod gather;
pub(crate) mod input;
pub(crate) mod layers;
pub(crate) mod lit;
pub(crate) mod method;
pub(crate) mod picture;
pub(crate) mod points;
pub mod ray;
pub(crate) mod rows;
pub mod scan_line_z;
pub(crate) mod setup;
pub mod shadow_map;
pub mod spanning_scan_line;
pub(crate) mod visible;
pub mod warnock;
pub(crate) mod window;
pub mod z_buffer;

pub use input::SurfaceInput;
pub use method::{Options, Step, SurfaceMethod, render_with};
pub use picture::Options as PictureOptions;
pub use setup::{ScreenTriangle, TriangleCounts, TriangleFilter};
pub use window::{SampleRect, WindowRelation};

use crate::math::{Vec3, Vec4};
use crate::shade::color::luminance;

/// Share of light below which a blended surface hides what is behind it: the last bit of a colour's sum.
pub(crate) const LEAST_THROUGH: f32 = 1.0 / 16_777_216.0;

/// Faces to leave out by their orientation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Cull {
    /// No faces: all are drawn, from both sides.
    #[default]
    None,
    /// Faces that are seen from behind.
    Back,
    /// Faces that are seen from behind and whose material is single-sided, as in glTF.
    Material,
}

/// Number of samples per pixel of the production path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Samples {
    /// One sample, at the pixel's centre.
    One,
    /// Four samples, on a rotated grid.
    #[default]
    Four,
    /// Sixteen samples, no two in a row or column of the 16 × 16 grid.
    Sixteen,
}

impl Samples {
    /// Returns the positions of the samples relative to the pixel's centre, in 1/256 pixel, x right and y down: the
    /// standard patterns of Direct3D 11.
    pub(crate) fn offsets(self) -> &'static [[i32; 2]] {
        const FOUR: [[i32; 2]; 4] = sixteenths([[-2, -6], [6, -2], [-6, 2], [2, 6]]);
        const SIXTEEN: [[i32; 2]; 16] = sixteenths([
            [1, 1],
            [-1, -3],
            [-3, 2],
            [4, -1],
            [-5, -2],
            [2, 5],
            [5, 3],
            [3, -5],
            [-2, 6],
            [0, -7],
            [-4, -6],
            [-6, 4],
            [-8, 0],
            [7, -4],
            [6, 7],
            [-7, -8],
        ]);
        match self {
            Self::One => &[[0, 0]],
            Self::Four => &FOUR,
            Self::Sixteen => &SIXTEEN,
        }
    }

    /// Returns the largest distance of a sample from the pixel's centre, along x or y, in 1/256 pixel.
    pub(crate) fn reach(self) -> i32 {
        self.offsets().iter().flatten().map(|o| o.abs()).max().unwrap_or(0)
    }
}

/// Converts sixteenths of a pixel to the 24.8 grid.
const fn sixteenths<const N: usize>(mut offsets: [[i32; 2]; N]) -> [[i32; 2]; N] {
    let mut i = 0;
    while i < N {
        offsets[i] = [offsets[i][0] * 16, offsets[i][1] * 16];
        i += 1;
    }
    offsets
}

/// Size on the screen of a model's lines and points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marks {
    /// Width of lines in pixels, above 0.
    pub line_width: f64,
    /// Side of the square that represents a point, in pixels, above 0.
    pub point_size: f64,
}

impl Marks {
    /// The usual size: lines of 1.5 pixels, points of 3.
    pub const USUAL: Self = Self { line_width: 1.5, point_size: 3.0 };
}

impl Default for Marks {
    /// Returns the default: [`Self::USUAL`].
    fn default() -> Self {
        Self::USUAL
    }
}

/// Background of the picture; colours are linear RGBA with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// One colour; alpha 0 makes it transparent.
    Color(Vec4),
    /// Gradient from the top row to the bottom row.
    Gradient(Vec4, Vec4),
}

impl Background {
    /// Returns the linear colour for lines and points without a material before this background: dark on light, light
    /// on dark. Transparent parts count as light.
    pub(crate) fn ink(&self) -> Vec3 {
        let mean = match *self {
            Self::Color(color) => color,
            Self::Gradient(top, bottom) => (top + bottom) * 0.5,
        };
        let seen = luminance(mean.truncate() * mean.w) + 1.0 - mean.w;
        // About where black and white have the same contrast (WCAG 2.1: √(1.05 · 0.05) − 0.05).
        if seen > 0.18 { DARK_INK } else { LIGHT_INK }
    }
}

/// sRGB (38, 41, 48).
const DARK_INK: Vec3 = Vec3::new(0.0194, 0.0222, 0.0296);

/// sRGB (231, 231, 231): the look of a surface without a material.
const LIGHT_INK: Vec3 = Vec3::splat(0.8);
