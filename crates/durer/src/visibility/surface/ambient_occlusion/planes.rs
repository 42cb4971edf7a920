//! The planes of a picture that hold each fourth pixel of a row side by side.

use crate::math::{DMat4, DVec4, Vec3};
use crate::parallel;
use crate::scene::Projection;
use crate::target::Pixels;
use crate::view::View;

/// The side of the pattern by which slices are turned, in pixels.
pub const PATTERN: usize = 4;

/// Samples farther than this many pixels away would miss near surfaces.
pub const FARTHEST: u32 = 256;

/// Number of pixels processed together.
pub const LANES: usize = 16;

/// Number of alternating columns that are kept apart, as a shift.
const PHASES_SHIFT: u32 = PATTERN.trailing_zeros();

/// Entries before and after each row, so that reads beyond the picture find the background.
const MARGIN: usize = ((FARTHEST as usize + 1) >> PHASES_SHIFT) + LANES + 1;

/// Distances and normals of the visible surfaces, in the directions of the screen: to the right, down, and back to the
/// eye.
///
/// The order within a row: first the pixels at 0, 4, 8 …, then those at 1, 5, 9 …, so that pixels with the same
/// directions are side by side, and so are their samples.
pub struct Planes {
    pub width: u32,
    pub height: u32,
    pub lens: Lens,
    /// Numbers of one phase of a row, with its margins.
    stride: usize,
    /// The coordinate along the axis back to the eye, relative to the eye; NaN at background pixels.
    pub back: Vec<f32>,
    /// Unit normals on the eye's side, by component.
    pub normal: [Vec<f32>; 3],
}

impl Planes {
    pub fn new(view: &View, depth: &Pixels<f32>, normal: &Pixels<[f32; 3]>) -> Self {
        let (width, height) = (depth.width(), depth.height());
        let stride = MARGIN + (width as usize).div_ceil(PATTERN).next_multiple_of(LANES) + MARGIN;
        let lens = Lens::new(view);
        let len = PATTERN * stride * height as usize;
        let empty = Self {
            width,
            height,
            lens,
            stride,
            back: Vec::new(),
            normal: [const { Vec::new() }; 3],
        };
        let mut back = vec![f32::NAN; len];
        let mut normals = [(); 3].map(|()| vec![0.0; len]);
        let row = PATTERN * stride;
        let [across, down, towards] = normals.each_mut().map(|n| n.chunks_mut(row));
        let rows = back.chunks_mut(row).zip(across).zip(down).zip(towards).zip(0..height);
        parallel::map(rows.collect(), |((((back, across), down), towards), y)| {
            for x in 0..width {
                let Some(depth) = depth.get(x, y).filter(|d| *d < 1.0) else { continue };
                let Some(normal) = normal.get(x, y) else { continue };
                if let Some((z, n)) = empty.lens.point([x, y], depth, normal.into()) {
                    let at = empty.in_row(x as usize);
                    (back[at], across[at], down[at], towards[at]) = (z, n.x, n.y, n.z);
                }
            }
        });
        Self { back, normal: normals, ..empty }
    }

    /// Returns the number of values in a row, all phases with their margins.
    pub fn row_len(&self) -> usize {
        PATTERN * self.stride
    }

    /// Returns the number of values in a plane.
    pub fn len(&self) -> usize {
        self.row_len() * self.height as usize
    }

    /// Returns the place of a pixel in its row.
    fn in_row(&self, x: usize) -> usize {
        x % PATTERN * self.stride + MARGIN + x / PATTERN
    }

    /// Returns the index of the pixel at column `x`, which may be up to [`FARTHEST`] + 1 outside the picture, in an
    /// existing row. Every fourth pixel to the right follows at consecutive indices.
    #[inline(always)]
    pub fn place(&self, x: i32, y: i32) -> usize {
        let phase = x as usize % PATTERN;
        let along = (MARGIN as i32 + (x >> PHASES_SHIFT)) as usize;
        (y as usize * PATTERN + phase) * self.stride + along
    }
}

/// Mapping from a pixel and its depth to a position, in the directions of the screen.
pub struct Lens {
    /// To the right, down the screen, and back to the eye; world axes.
    axes: [Vec3; 3],
    pub perspective: bool,
    /// The coordinate back to the eye, from depth: numerator and denominator, each by slope and constant.
    back: [f64; 4],
    /// The other two coordinates of pixel 0 before scaling; `step` is the change per pixel.
    pub first: [f32; 2],
    pub step: [f32; 2],
    /// Factor: a constant, and the increase for each unit back to the eye.
    pub scale: [f32; 2],
}

impl Lens {
    fn new(view: &View) -> Self {
        let camera = view.camera();
        let [right, up, back] = camera.axes();
        let axes = [right, -up, back];
        let [x, y, z] = axes.map(|a| a.extend(0.0));
        let from_screen = DMat4::from_cols(x, y, z, DVec4::W).transpose()
            * DMat4::from_translation(-camera.eye)
            * view.screen_from_world().inverse();
        let [x, y, z, w] = [0, 1, 2, 3].map(|i| from_screen.col(i));
        let perspective = matches!(camera.projection, Projection::Perspective { .. });
        // In perspective, the last homogeneous coordinate is the same for all points in front.
        let scale = if perspective { [0.0, 1.0 / w.z] } else { [1.0 / w.w, 0.0] };
        Self {
            axes: axes.map(|a| a.as_vec3()),
            perspective,
            back: [z.z, w.z, z.w, w.w],
            first: [(w.x + 0.5 * x.x) as f32, (w.y + 0.5 * y.y) as f32],
            step: [x.x as f32, y.y as f32],
            scale: scale.map(|s| s as f32),
        }
    }

    /// Returns the coordinate along the axis back to the eye and the unit normal of the surface that a pixel shows, if
    /// both are finite.
    fn point(&self, [x, y]: [u32; 2], depth: f32, normal: Vec3) -> Option<(f32, Vec3)> {
        let [slope, constant, slope_below, below] = self.back;
        let depth = f64::from(depth);
        let z = ((slope * depth + constant) / (slope_below * depth + below)) as f32;
        let normal = Vec3::from_array(self.axes.map(|a| a.dot(normal))).try_normalize()?;
        let scale = self.scale[0] + self.scale[1] * z;
        let place = Vec3::new(
            (self.first[0] + self.step[0] * x as f32) * scale,
            (self.first[1] + self.step[1] * y as f32) * scale,
            z,
        );
        let to_eye = if self.perspective { -place } else { Vec3::Z };
        let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
        place.is_finite().then_some((z, normal))
    }
}
