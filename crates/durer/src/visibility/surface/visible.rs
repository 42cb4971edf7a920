//! The result of an image-space algorithm, one item and depth per pixel, and its conversion to a picture.

use crate::math::Vec4;
use crate::shade::color::premultiply;
use crate::shade::{PreparedLights, PreparedMaterials};
use crate::target::{Framebuffer, NO_ITEM};
use crate::visibility::surface::background::background_rows;
use crate::visibility::surface::input::{SurfaceInput, TriangleSet};
use crate::visibility::surface::lit::{Lighting, Lit};
use crate::visibility::surface::picture::{self, Picture};
use crate::visibility::surface::setup::Coverage;
use crate::visibility::surface::window::SampleRect;

/// Nearest surface at each sample of a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Visible {
    window: SampleRect,
    /// Row by row; [`NO_ITEM`] at the background.
    pub item: Vec<u32>,
    /// Row by row; 1 at the background.
    pub depth: Vec<f32>,
}

impl Visible {
    /// Bytes for each sample.
    pub const PER_SAMPLE: u64 = size_of::<(u32, f32)>() as u64;

    /// Creates an empty window, as far as the far plane.
    pub fn new(window: SampleRect) -> Self {
        let size = |a: i32, b: i32| (b - a).max(0) as usize;
        let count = size(window.x0, window.x1) * size(window.y0, window.y1);
        Self { window, item: vec![NO_ITEM; count], depth: vec![1.0; count] }
    }

    /// Returns the place of a sample of the window.
    #[inline]
    pub fn index(&self, x: i32, y: i32) -> usize {
        let w = &self.window;
        (y - w.y0) as usize * (w.x1 - w.x0) as usize + (x - w.x0) as usize
    }

    /// Returns the samples it holds.
    pub fn window(&self) -> SampleRect {
        self.window
    }

    /// Returns the column and row of a place.
    pub fn place(&self, index: usize) -> [i32; 2] {
        let width = (self.window.x1 - self.window.x0).max(1) as usize;
        [self.window.x0 + (index % width) as i32, self.window.y0 + (index / width) as i32]
    }

    /// Returns the first column and row number, the items and the depths of each row.
    pub fn rows(&self) -> impl Iterator<Item = ([u32; 2], &[u32], &[f32])> {
        let width = ((self.window.x1 - self.window.x0).max(1)) as usize;
        let rows = self.item.chunks(width).zip(self.depth.chunks(width));
        let [x, first] = [self.window.x0, self.window.y0].map(|v| v.max(0) as u32);
        (first..).zip(rows).map(move |(y, (items, depths))| ([x, y], items, depths))
    }

    /// Overwrites a sample, unless the depth is beyond the far plane.
    #[inline]
    pub fn put(&mut self, x: i32, y: i32, depth: f32, item: u32) {
        if depth < 1.0 {
            let index = self.index(x, y);
            (self.depth[index], self.item[index]) = (depth, item);
        }
    }
}

/// Returns the pixels of a view's window.
pub fn pixels_of(view: &crate::view::View) -> SampleRect {
    let window = view.window();
    SampleRect { x0: window.x0(), y0: window.y0(), x1: window.x1(), y1: window.y1() }
}

/// Returns whether the first is in front: the smaller depth, of equal ones the lower item.
#[inline]
pub fn nearer(a: (f32, u32), b: (f32, u32)) -> bool {
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
}

/// Holes of masked materials, and the triangles that have such a material.
pub struct Masks<'a> {
    lit: Lit<'a>,
    masked: TriangleSet,
}

impl<'a> Masks<'a> {
    /// Creates the masks for the triangles of an input.
    pub fn new(input: &SurfaceInput<'_>, lighting: Lighting<'a>) -> Self {
        Self { lit: Lit::new(lighting), masked: input.having(Coverage::Masked) }
    }

    /// Returns whether a triangle may have holes.
    #[inline]
    pub fn is_masked(&self, triangle: usize) -> bool {
        self.masked.contains(triangle)
    }

    /// Returns whether a triangle is there at a pixel.
    #[inline]
    pub fn passes(&mut self, triangle: usize, item: u32, x: i32, y: i32) -> bool {
        !self.is_masked(triangle) || self.lit.passes_mask(item, x, y)
    }
}

/// Calls `f` with the data needed to light an input's items, which are found at pixels' centres.
pub fn with_lighting<R>(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    look: &picture::Options,
    f: impl FnOnce(Lighting<'_>) -> R,
) -> R {
    let materials = PreparedMaterials::new(input.scene).with_ink(look.background.ink());
    f(Lighting {
        scene: input.scene,
        view: input.view,
        runs: &input.runs,
        materials: &materials,
        lights,
        shading: look.shading,
        reach: 0,
        level: look.level,
    })
}

/// Lights the surfaces visible at the pixels' centres into all planes that the framebuffer has.
pub fn write(
    visible: &Visible,
    lighting: Lighting<'_>,
    look: &picture::Options,
    framebuffer: &mut Framebuffer,
) {
    let mut picture = Picture::with_lighting(lighting, look, framebuffer);
    visible.rows().for_each(|([x, y], items, depths)| picture.write(x, y, items, depths));
}

/// Writes depth, item and normal, but no colour.
pub fn write_planes(
    visible: &Visible,
    lighting: Lighting<'_>,
    look: &picture::Options,
    framebuffer: &mut Framebuffer,
) {
    let mut picture = Picture::with_lighting(lighting, look, framebuffer);
    visible.rows().for_each(|([x, y], items, depths)| picture.write_planes(x, y, items, depths));
}

/// Returns the background of a row, linear and premultiplied.
pub fn background_at(look: &picture::Options, height: u32, y: i32) -> Vec4 {
    premultiply(background_rows(look.background, height)(y))
}
