//! Bitmaps: masks of bits, drawn as fragments at the raster position, which then moves on; letters, above all.
//!
//! M. Segal, K. Akeley, *The OpenGL Graphics System: A Specification* 2.1 (2006), 3.7. The first pixel of the mask is at
//! (⌊x − x₀⌋, ⌊y − y₀⌋) for the raster position (x, y) and the origin (x₀, y₀); every bit that is set becomes one fragment,
//! whatever the pixel zoom is. Rows count as they do in the framebuffer: downwards, or upwards where its origin is at the
//! lower left.

use super::brush::{Brush, Look};
use super::state::Pipeline;
use crate::math::DVec2;
use crate::target::Framebuffer;
use crate::{Error, Result};

/// A mask of bits with its place beside the raster position.
#[derive(Debug, Clone, PartialEq)]
pub struct Bitmap {
    width: u32,
    height: u32,
    /// Rows of whole bytes.
    bytes: Vec<u8>,
    /// Place of the raster position in the mask, pixels from the mask's first corner.
    pub origin: DVec2,
    /// Way of the raster position after drawing, pixels.
    pub advance: DVec2,
}

impl Bitmap {
    /// Creates a bitmap from its rows: each has ⌈width / 8⌉ bytes, the first pixel in the highest bit. Its origin is its
    /// first corner, and the raster position does not move.
    ///
    /// ```
    /// use durer::commands::Bitmap;
    ///
    /// let corner = Bitmap::new(3, 2, vec![0b1110_0000, 0b1000_0000])?;
    /// assert!(corner.is_set(2, 0) && corner.is_set(0, 1) && !corner.is_set(1, 1));
    /// assert!(Bitmap::new(9, 2, vec![0; 2]).is_err());
    /// # Ok::<(), durer::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Parameter`] for another number of bytes.
    pub fn new(width: u32, height: u32, bytes: Vec<u8>) -> Result<Self> {
        let needed = u64::from(width.div_ceil(8)) * u64::from(height);
        if bytes.len() as u64 != needed {
            let value = format!("{} bytes for {width}x{height} bits", bytes.len());
            let expected = "⌈width / 8⌉ bytes for each row";
            return Err(Error::parameter("bitmap", value, expected));
        }
        Ok(Self { width, height, bytes, origin: DVec2::ZERO, advance: DVec2::ZERO })
    }

    /// Returns the bitmap with another origin and advance.
    pub fn placed(self, origin: DVec2, advance: DVec2) -> Self {
        Self { origin, advance, ..self }
    }

    /// Returns whether the bit of a pixel is set; false beyond the mask.
    pub fn is_set(&self, x: u32, y: u32) -> bool {
        let index = y as usize * self.width.div_ceil(8) as usize + (x / 8) as usize;
        let byte = self.bytes.get(index).copied().unwrap_or(0);
        x < self.width && y < self.height && byte & (0x80 >> (x % 8)) != 0
    }
}

/// Draws a bitmap and moves the raster position; at none, which was clipped away, nothing happens.
pub(super) fn draw(p: &mut Pipeline, bitmap: &Bitmap, target: &mut Framebuffer) -> Result<()> {
    if !bitmap.origin.is_finite() || !bitmap.advance.is_finite() {
        let value = format!("origin {}, advance {}", bitmap.origin, bitmap.advance);
        return Err(Error::parameter("bitmap", value, "finite"));
    }
    let Some(raster) = p.raster else { return Ok(()) };
    let brush = Brush::new(p);
    let look = Look {
        color: raster.color.as_dvec4(),
        index: f64::from(raster.index),
        tex_coords: [raster.tex_coord; 3],
    };
    let first = (raster.at - bitmap.origin).floor();
    let columns = overlap(first.x, bitmap.width, target.width());
    for y in overlap(first.y, bitmap.height, target.height()) {
        for x in columns.clone() {
            let [n, m] = [f64::from(x) - first.x, f64::from(y) - first.y].map(|v| v as u32);
            if bitmap.is_set(n, m) {
                brush.put([x as i32, y as i32], raster.depth, &look, true, target);
            }
        }
    }
    let at = raster.at + bitmap.advance;
    p.raster = Some(super::RasterPosition { at, ..raster });
    Ok(())
}

/// Returns the pixels below `limit` of a run of `count` from `first` on.
fn overlap(first: f64, count: u32, limit: u32) -> std::ops::Range<u32> {
    let clamped = |v: f64| v.clamp(0.0, f64::from(limit)) as u32;
    clamped(first)..clamped(first + f64::from(count))
}
