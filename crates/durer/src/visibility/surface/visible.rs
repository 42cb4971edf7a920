//! The result of an image-space algorithm, one item and depth per pixel, and its way to a picture.

use crate::math::Vec4;
use crate::shade::color::{encode_rgba8, encode_srgb8, premultiply, unpremultiply};
use crate::shade::{PreparedLights, PreparedMaterials, Shading};
use crate::simd::Level;
use crate::target::{Framebuffer, NO_ITEM};
use crate::visibility::surface::Background;
use crate::visibility::surface::cover::Window;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::lit::{Lighting, Lit};
use crate::visibility::surface::setup::Coverage;
use fearless_simd::{Simd, dispatch};
use fearless_simd_macros::simd;

/// How what is visible is to look.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// `None` = by material.
    pub shading: Option<Shading>,
    /// What is behind everything.
    pub background: Background,
    /// The SIMD level to work at; all give the same bytes.
    pub level: Level,
}

impl Default for Look {
    /// By material, on white.
    fn default() -> Self {
        Self { shading: None, background: Background::Color(Vec4::ONE), level: Level::new() }
    }
}

/// What is nearest at each sample of a window.
#[derive(Debug, Clone, PartialEq)]
pub struct Visible {
    window: Window,
    /// Row by row; [`NO_ITEM`] where nothing is.
    pub item: Vec<u32>,
    /// Row by row; 1 where nothing is.
    pub depth: Vec<f32>,
}

impl Visible {
    /// Nothing, as far as the far plane.
    pub fn new(window: Window) -> Self {
        let size = |a: i32, b: i32| (b - a).max(0) as usize;
        let count = size(window.x0, window.x1) * size(window.y0, window.y1);
        Self { window, item: vec![NO_ITEM; count], depth: vec![1.0; count] }
    }

    /// The place of a sample of the window.
    #[inline]
    pub fn index(&self, x: i32, y: i32) -> usize {
        let w = &self.window;
        (y - w.y0) as usize * (w.x1 - w.x0) as usize + (x - w.x0) as usize
    }

    /// Writes a sample, whatever was there; what lies beyond the far plane is not seen.
    #[inline]
    pub fn put(&mut self, x: i32, y: i32, depth: f32, item: u32) {
        if depth < 1.0 {
            let index = self.index(x, y);
            (self.depth[index], self.item[index]) = (depth, item);
        }
    }
}

/// All pixels of a view.
pub fn pixels_of(view: &crate::view::View) -> Window {
    Window { x0: 0, y0: 0, x1: view.width() as i32, y1: view.height() as i32 }
}

/// What lies in front: the smaller depth, of equal ones the lower item.
#[inline]
pub fn nearer(a: (f32, u32), b: (f32, u32)) -> bool {
    a.0 < b.0 || (a.0 == b.0 && a.1 < b.1)
}

/// Says of masked materials where they are; knows which triangles have one.
pub struct Masks<'a> {
    lit: Lit<'a>,
    /// Of each triangle of the input; empty where nothing is masked.
    masked: Vec<bool>,
}

impl<'a> Masks<'a> {
    /// For the triangles of an input.
    pub fn new(input: &SurfaceInput<'_>, lighting: Lighting<'a>) -> Self {
        let any = input.runs.iter().any(|r| r.coverage == Coverage::Masked);
        let masked = |item: u32| input.run_of(item).coverage == Coverage::Masked;
        let masked = match any {
            true => input.triangles.iter().map(|t| masked(t.item)).collect(),
            false => Vec::new(),
        };
        Self { lit: Lit::new(lighting), masked }
    }

    /// Whether a triangle may have holes.
    #[inline]
    pub fn is_masked(&self, triangle: usize) -> bool {
        self.masked.get(triangle).copied().unwrap_or(false)
    }

    /// Whether a triangle is there at a pixel.
    #[inline]
    pub fn passes(&mut self, triangle: usize, item: u32, x: i32, y: i32) -> bool {
        !self.is_masked(triangle) || self.lit.passes_mask(item, x, y)
    }
}

/// Calls `f` with what is needed to light an input's items.
pub fn with_lighting<R>(
    input: &SurfaceInput<'_>,
    lights: &PreparedLights,
    look: &Look,
    f: impl FnOnce(Lighting<'_>) -> R,
) -> R {
    let materials = PreparedMaterials::new(input.scene);
    f(Lighting {
        scene: input.scene,
        view: input.view,
        runs: &input.runs,
        materials: &materials,
        lights,
        shading: look.shading,
    })
}

/// Rows that one thread lights at a time.
const BAND: usize = 32;

/// Lights what is visible at the pixels' centres into all planes that the framebuffer has; blended
/// surfaces count as opaque.
pub fn write(
    visible: &Visible,
    lighting: Lighting<'_>,
    look: &Look,
    framebuffer: &mut Framebuffer,
) {
    write_planes(visible, lighting, framebuffer);
    let width = framebuffer.width() as usize;
    let rows = framebuffer.color.data_mut().chunks_mut((BAND * width).max(1)).enumerate().collect();
    crate::parallel::map(rows, |(band, out): (usize, &mut [[u8; 4]])| {
        let mut lit = Lit::new(lighting);
        for (row, out) in out.chunks_mut(width).enumerate() {
            let y = band * BAND + row;
            let items = &visible.item[y * width..(y + 1) * width];
            out.fill(encode(background_at(look, lighting.view.height(), y as i32)));
            dispatch!(look.level, simd => light_row(simd, &mut lit, items, y as i32, out));
        }
    });
}

/// Depth, item and normal.
pub fn write_planes(visible: &Visible, lighting: Lighting<'_>, framebuffer: &mut Framebuffer) {
    let triangle_count = lighting.scene.triangle_count() as u32;
    let width = framebuffer.width() as usize;
    if let Some(depth) = &mut framebuffer.depth {
        depth.data_mut().copy_from_slice(&visible.depth);
    }
    if let Some(items) = &mut framebuffer.item {
        for (to, &item) in items.data_mut().iter_mut().zip(&visible.item) {
            *to = if item < triangle_count { item } else { NO_ITEM };
        }
    }
    if let Some(normals) = &mut framebuffer.normal {
        let mut lit = Lit::new(lighting);
        for (i, to) in normals.data_mut().iter_mut().enumerate() {
            if visible.item[i] != NO_ITEM {
                let (x, y) = ((i % width) as i32, (i / width) as i32);
                *to = lit.normal(visible.item[i], x, y).to_array();
            }
        }
    }
}

/// The background of a row, linear and premultiplied.
pub fn background_at(look: &Look, height: u32, y: i32) -> Vec4 {
    premultiply(look.background.at_row(height, y))
}

/// From linear premultiplied to 8-bit sRGB.
pub fn encode(premultiplied: Vec4) -> [u8; 4] {
    let opaque = premultiplied.w >= 1.0;
    encode_rgba8(if opaque { premultiplied } else { unpremultiply(premultiplied) })
}

#[simd]
fn light_row<S: Simd>(simd: S, lit: &mut Lit<'_>, items: &[u32], y: i32, out: &mut [[u8; 4]]) {
    for (eight, (items, out)) in items.chunks(8).zip(out.chunks_mut(8)).enumerate() {
        let mut whole = [NO_ITEM; 8];
        whole[..items.len()].copy_from_slice(items);
        if whole == [NO_ITEM; 8] {
            continue;
        }
        let mut colors = [[0.0; 8]; 3];
        lit.colors_x8(simd, &whole, 8 * eight as i32, y, &mut colors);
        let [r, g, b] = colors;
        for (i, out) in out.iter_mut().enumerate() {
            if whole[i] != NO_ITEM {
                *out = [encode_srgb8(r[i]), encode_srgb8(g[i]), encode_srgb8(b[i]), 255];
            }
        }
    }
}
