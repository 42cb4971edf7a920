//! From the visible item of each pixel to the planes of a picture: the last step of all methods that find one surface
//! per pixel.
//!
//! Blended surfaces count as opaque in the depth, item and normal planes; and those passed to this module also in the
//! colours. The module `layers` lays them over each other.

use crate::math::Vec4;
use crate::shade::color::{
    encode_opaque_x16, encode_premultiplied, encode_premultiplied_x16, encode_rgba8,
};
use crate::shade::{PreparedLights, PreparedMaterials, Shading};
use crate::simd::{Level, default_level, dispatch};
use crate::target::{Framebuffer, NO_ITEM};
use crate::view::window::PixelRect;
use crate::visibility::surface::Background;
use crate::visibility::surface::background::background_rows;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::lit::{BlockSums, Lighting, Lit, opaque};
use crate::visibility::surface::points::patch::Patch;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, u32x16};
use fearless_simd_macros::simd;
use std::ops::Range;

/// Options for the planes of a picture with one surface per pixel.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Shading; `None` = by material.
    pub shading: Option<Shading>,
    /// Background of the picture.
    pub background: Background,
    /// SIMD level; all levels produce the same bytes.
    pub level: Level,
}

impl Default for Options {
    /// Returns the default: by material, on white, the machine's best level.
    fn default() -> Self {
        let background = Background::Color(Vec4::ONE);
        Self { shading: None, background, level: default_level() }
    }
}

/// Lights one row after the other and writes it to the planes of a framebuffer.
pub(crate) struct Picture<'a> {
    framebuffer: &'a mut Framebuffer,
    background: Background,
    level: Level,
    /// Lights single pixels, tests masks.
    pub lit: Lit<'a>,
    /// Items from here on are lines and points, which the item plane does not show.
    triangle_count: u32,
    /// Rows of the whole picture.
    height: u32,
    /// Pixels of it that the framebuffer holds.
    window: PixelRect,
}

impl<'a> Picture<'a> {
    /// Creates the picture of items that are found up to `reach`/256 pixels from pixels' centres.
    pub fn new(
        input: &'a SurfaceInput<'a>,
        materials: &'a PreparedMaterials<'a>,
        lights: &'a PreparedLights,
        (options, reach): (&Options, i32),
        framebuffer: &'a mut Framebuffer,
    ) -> Self {
        let lighting = Lighting {
            scene: input.scene,
            view: input.view,
            runs: &input.runs,
            materials,
            lights,
            shading: options.shading,
            reach,
            level: options.level,
        };
        Self::with_lighting(lighting, options, framebuffer)
    }

    /// Creates a picture with materials that are prepared already.
    pub fn with_lighting(
        lighting: Lighting<'a>,
        options: &Options,
        framebuffer: &'a mut Framebuffer,
    ) -> Self {
        Self {
            framebuffer,
            background: options.background,
            level: options.level,
            lit: Lit::by_rows(lighting),
            triangle_count: lighting.scene.triangle_count() as u32,
            height: lighting.view.height(),
            window: lighting.view.window(),
        }
    }

    /// Writes the pixels of row `y` from column `x`: the item and depth at each pixel's centre,
    /// [`NO_ITEM`] at the background.
    pub fn write(&mut self, x: u32, y: u32, items: &[u32], depths: &[f32]) {
        self.write_planes(x, y, items, depths);
        self.write_color(x, y, items);
    }

    /// Writes the colours of the pixels of row `y` from column `x`, and no other plane.
    pub fn write_color(&mut self, x: u32, y: u32, items: &[u32]) {
        let behind = self.behind(y as i32);
        let Some(Part { of, start, row }) = self.part(x, y, items.len()) else { return };
        let at = [(x as usize + of.start) as i32, y as i32];
        let row = self.framebuffer.color.row_mut(row);
        let (lit, out) = (&mut self.lit, row.get_mut(start..).unwrap_or_default());
        dispatch!(self.level, simd => color_row(simd, lit, &items[of], behind, at, out));
    }

    /// Returns the background of row `y`: linear, straight alpha.
    pub fn behind(&self, y: i32) -> Vec4 {
        background_rows(self.background, self.height)(y)
    }

    /// Writes row `y` of the colour plane from the sums of its pixels, sixteen after sixteen.
    pub fn write_sums(&mut self, y: u32, sums: &[BlockSums]) {
        let Some(Part { of, start, row }) = self.part(0, y, 16 * sums.len()) else { return };
        let row = self.framebuffer.color.row_mut(row).get_mut(start..).unwrap_or_default();
        dispatch!(self.level, simd => encode_row(simd, sums, of.start, row));
    }

    /// Writes one pixel of the colour plane from a linear, premultiplied colour.
    pub fn set_color(&mut self, x: u32, y: u32, sum: Vec4) {
        if let Some(Part { start, row, .. }) = self.part(x, y, 1) {
            self.framebuffer.color.set(start as u32, row, encode_premultiplied(sum));
        }
    }

    /// Writes depth, item and normal, as far as the framebuffer has them; no colour.
    pub fn write_planes(&mut self, x: u32, y: u32, items: &[u32], depths: &[f32]) {
        let Some(Part { of, start, row: y_in }) = self.part(x, y, items.len()) else { return };
        let first = x as usize + of.start;
        let (items, depths) = (&items[of.clone()], depths.get(of).unwrap_or_default());
        if let Some(plane) = &mut self.framebuffer.depth {
            let row = plane.row_mut(y_in).get_mut(start..).unwrap_or_default();
            row.iter_mut().zip(depths).for_each(|(to, &depth)| *to = depth);
        }
        if let Some(plane) = &mut self.framebuffer.item {
            let row = plane.row_mut(y_in).get_mut(start..).unwrap_or_default();
            for (to, &item) in row.iter_mut().zip(items) {
                *to = if item < self.triangle_count { item } else { NO_ITEM };
            }
        }
        if let Some(plane) = &mut self.framebuffer.normal {
            let row = plane.row_mut(y_in).get_mut(start..).unwrap_or_default();
            let visible = row.iter_mut().zip(items).enumerate();
            for (i, (to, &item)) in visible.filter(|(_, (_, item))| **item != NO_ITEM) {
                *to = self.lit.normal(item, (first + i) as i32, y as i32).to_array();
            }
        }
    }

    /// Returns which of the pixels of row `y` from column `x` the framebuffer holds; `None` if it holds none.
    fn part(&self, x: u32, y: u32, count: usize) -> Option<Part> {
        let window = &self.window;
        let [x, y] = [x, y].map(|v| i32::try_from(v).unwrap_or(i32::MAX));
        let end = x.saturating_add(i32::try_from(count).unwrap_or(i32::MAX));
        let pixels = window.intersection(&PixelRect::spanning(x, y, end, y.saturating_add(1)));
        (!pixels.is_empty()).then(|| Part {
            of: (pixels.x0() - x) as usize..(pixels.x1() - x) as usize,
            start: (pixels.x0() - window.x0()) as usize,
            row: (y - window.y0()) as u32,
        })
    }

    /// Returns whether the framebuffer has planes that show values at the pixels' centres.
    pub fn wants_planes(&self) -> bool {
        let planes = &self.framebuffer;
        planes.depth.is_some() || planes.item.is_some() || planes.normal.is_some()
    }
}

/// Pixels of a row that a framebuffer holds.
struct Part {
    /// Their places among the pixels of the row.
    of: Range<usize>,
    /// Column of the first in the framebuffer.
    start: usize,
    /// Row in the framebuffer.
    row: u32,
}

/// Encodes the pixels of a row from one on.
#[simd]
fn encode_row<S: Simd>(simd: S, sums: &[BlockSums], first: usize, out: &mut [[u8; 4]]) {
    let (mut lane, mut rest) = (first % 16, out);
    for sums in &sums[first / 16..] {
        if rest.is_empty() {
            return;
        }
        let codes = &encode_premultiplied_x16(simd, &sums.0)[lane..];
        let (part, others) = rest.split_at_mut(codes.len().min(rest.len()));
        for (to, code) in part.iter_mut().zip(codes) {
            *to = code.to_le_bytes();
        }
        (lane, rest) = (0, others);
    }
}

/// Lights the pixels of a row, sixteen at a time.
#[simd]
fn color_row<S: Simd>(
    simd: S,
    lit: &mut Lit<'_>,
    items: &[u32],
    behind: Vec4,
    [x, y]: [i32; 2],
    out: &mut [[u8; 4]],
) {
    let behind = u32x16::splat(simd, u32::from_le_bytes(encode_rgba8(behind)));
    for (i, (out, of_out)) in out.chunks_mut(16).zip(items.chunks(16)).enumerate() {
        let mut items = [NO_ITEM; 16];
        items[..of_out.len()].copy_from_slice(of_out);
        let shown = u32x16::from_slice(simd, &items);
        let there = shown.simd_ne(u32x16::splat(simd, NO_ITEM));
        let mut codes = behind;
        if there.any_true() {
            let (mut colors, patch) = ([[0.0; 16]; 4], Patch::row([x + 16 * i as i32, y]));
            Lit::colors_x16(simd, lit, shown, patch, &mut colors);
            codes = there.select(encode_opaque_x16(simd, opaque(simd, &colors)), behind);
        }
        let codes: [u32; 16] = codes.into();
        for (to, code) in out.iter_mut().zip(codes) {
            *to = code.to_le_bytes();
        }
    }
}
