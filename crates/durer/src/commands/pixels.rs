//! The pixel path of the classic pipeline: rectangles of pixels are read, drawn and copied, past all geometry but
//! through texturing and the fragment operations.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification* 2.1 (2006), 2.13, 3.6 and 4.3. A pixel of the
//! source in column n, row m becomes the rectangle from (x + n·zx, y + m·zy) to (x + (n + 1)·zx, y + (m + 1)·zy) at the
//! raster position (x, y) and the zoom (zx, zy); its value is written to the pixels whose centres are in it. Rows count
//! as they do in the framebuffer: downwards, or upwards where its origin is at the lower left.

use super::brush::{Brush, Look};
use super::state::Pipeline;
use crate::fragment::Scissor;
use crate::math::{DVec2, DVec4};
use crate::shade::color::decode_rgba8;
use crate::target::{Framebuffer, Pixels};
use crate::{Error, Result};
use std::ops::Range;

/// Pixels of one plane of a framebuffer.
#[derive(Debug, Clone, PartialEq)]
pub enum PixelBlock {
    /// 8-bit sRGB with straight alpha.
    Color(Pixels<[u8; 4]>),
    /// Window depths.
    Depth(Pixels<f32>),
    /// Stencil values.
    Stencil(Pixels<u8>),
    /// Colour indices.
    Index(Pixels<u8>),
}

/// Plane of a framebuffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PixelPlane {
    /// Colours.
    Color,
    /// Window depths.
    Depth,
    /// Stencil values.
    Stencil,
    /// Colour indices.
    Index,
}

/// Returns a rectangle of a plane: first column, first row, width, height. Rows are in the order of the framebuffer.
///
/// ```
/// use durer::commands::{PixelBlock, PixelPlane, read_pixels};
/// use durer::target::Framebuffer;
///
/// let target = Framebuffer::new(4, 4).with_depth();
/// let PixelBlock::Depth(depths) = read_pixels(&target, [1, 1, 2, 3], PixelPlane::Depth)? else { panic!() };
/// assert_eq!((depths.width(), depths.height(), depths.get(1, 2)), (2, 3, Some(1.0)));
/// assert!(read_pixels(&target, [3, 0, 2, 1], PixelPlane::Color).is_err());
/// # Ok::<(), durer::Error>(())
/// ```
///
/// # Errors
/// [`Error::Parameter`] for a rectangle that is not within the framebuffer; [`Error::Unsupported`] for a plane that it
/// does not have.
pub fn read_pixels(
    target: &Framebuffer,
    rectangle: [u32; 4],
    plane: PixelPlane,
) -> Result<PixelBlock> {
    let missing = Error::Unsupported {
        what: "reading a plane that the framebuffer does not have",
        instead: "create it with that plane",
    };
    Ok(match plane {
        PixelPlane::Color => PixelBlock::Color(part(&target.color, rectangle)?),
        PixelPlane::Depth => {
            PixelBlock::Depth(part(target.depth.as_ref().ok_or(missing)?, rectangle)?)
        }
        PixelPlane::Stencil => {
            PixelBlock::Stencil(part(target.stencil.as_ref().ok_or(missing)?, rectangle)?)
        }
        PixelPlane::Index => {
            PixelBlock::Index(part(target.index.as_ref().ok_or(missing)?, rectangle)?)
        }
    })
}

fn part<T: Copy>(plane: &Pixels<T>, [x, y, width, height]: [u32; 4]) -> Result<Pixels<T>> {
    let fits = |first: u32, size: u32, all: u32| first.checked_add(size).is_some_and(|e| e <= all);
    if !fits(x, width, plane.width()) || !fits(y, height, plane.height()) {
        let value = format!("{width}x{height}+{x}+{y}");
        return Err(Error::parameter("rectangle of pixels", value, "within the framebuffer"));
    }
    let columns = x as usize..(x + width) as usize;
    let rows = (y..y + height).flat_map(|row| plane.row(row)[columns.clone()].iter().copied());
    Pixels::from_data(width, height, rows.collect())
}

/// Draws a block at the raster position; at none, which was clipped away, nothing.
pub(super) fn draw(p: &Pipeline, block: &PixelBlock, target: &mut Framebuffer) {
    let Some(raster) = p.raster else { return };
    let brush = Brush::new(p);
    let own = Look {
        color: raster.color.as_dvec4(),
        index: f64::from(raster.index),
        tex_coords: [raster.tex_coord; 3],
    };
    match block {
        PixelBlock::Color(pixels) => each(p, raster.at, pixels, target, |at, code, target| {
            let color: DVec4 = decode_rgba8(code).as_dvec4();
            brush.put(at, raster.depth, &Look { color, ..own }, true, target);
        }),
        PixelBlock::Depth(pixels) => each(p, raster.at, pixels, target, |at, depth, target| {
            brush.put(at, f64::from(depth), &own, true, target);
        }),
        PixelBlock::Index(pixels) => each(p, raster.at, pixels, target, |at, index, target| {
            brush.put(at, raster.depth, &Look { index: f64::from(index), ..own }, true, target);
        }),
        // Stencil values pass the scissor test and the stencil's mask only.
        PixelBlock::Stencil(pixels) => {
            each(p, raster.at, pixels, target, |[x, y], value, target| {
                let (x, y) = (x as u32, y as u32);
                let state = &p.fragments;
                let seen = state.scissor.is_none_or(|s: Scissor| s.contains(x, y));
                if let (true, Some(plane)) = (seen, &mut target.stencil) {
                    let old = plane.get(x, y).unwrap_or(0);
                    plane.set(x, y, state.write_mask.stencil(true, value, old));
                }
            })
        }
    }
}

/// Calls `put` with the pixels that each pixel of a block becomes, row after row.
fn each<T: Copy>(
    p: &Pipeline,
    at: DVec2,
    block: &Pixels<T>,
    target: &mut Framebuffer,
    mut put: impl FnMut([i32; 2], T, &mut Framebuffer),
) {
    for m in 0..block.height() {
        let rows = covered(at.y, p.pixel_zoom.y, m, target.height());
        if rows.is_empty() {
            continue;
        }
        for (n, &value) in (0..).zip(block.row(m)) {
            for x in covered(at.x, p.pixel_zoom.x, n, target.width()) {
                rows.clone().for_each(|y| put([x as i32, y as i32], value, target));
            }
        }
    }
}

/// Returns the pixels of `limit` whose centres the k-th of equal steps covers, its lower end included.
fn covered(start: f64, zoom: f64, k: u32, limit: u32) -> Range<u32> {
    let ends = [f64::from(k), f64::from(k) + 1.0].map(|k| start + zoom * k);
    let first = |v: f64| (v - 0.5).ceil().clamp(0.0, f64::from(limit)) as u32;
    first(ends[0].min(ends[1]))..first(ends[0].max(ends[1]))
}
