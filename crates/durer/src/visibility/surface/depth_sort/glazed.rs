//! Blended surfaces, laid over everything painted before them: the painter's order has sorted them already.

use crate::math::Vec4;
use crate::shade::color::{encode_premultiplied, premultiply};
use crate::target::Framebuffer;
use crate::visibility::surface::background::background_rows;
use crate::visibility::surface::input::{SurfaceInput, TriangleSet};
use crate::visibility::surface::layers::{below_color, over};
use crate::visibility::surface::lit::{Lighting, Lit};
use crate::visibility::surface::picture;
use crate::visibility::surface::visible::{Visible, pixels_of, write};

/// Opaque colour so far, and the sum of everything blended over it since.
pub struct Glazed<'a> {
    input: &'a SurfaceInput<'a>,
    blended: TriangleSet,
    lighting: Lighting<'a>,
    look: &'a picture::Options,
    opaque: Visible,
    /// Linear, premultiplied; `None` if nothing was blended since the latest opaque surface.
    sums: Vec<Option<Vec4>>,
    lit: Lit<'a>,
}

/// Bytes for each pixel: the opaque surface, the sum over it, and a colour.
pub const PER_PIXEL: u64 = Visible::PER_SAMPLE + size_of::<(Option<Vec4>, [u8; 4])>() as u64;

impl<'a> Glazed<'a> {
    pub fn new(
        input: &'a SurfaceInput<'a>,
        blended: TriangleSet,
        lighting: Lighting<'a>,
        look: &'a picture::Options,
    ) -> Self {
        let opaque = Visible::new(pixels_of(input.view));
        let sums = vec![None; opaque.item.len()];
        Self { input, blended, lighting, look, opaque, sums, lit: Lit::new(lighting) }
    }

    /// Paints a pixel of a triangle of the input.
    pub fn put(&mut self, [x, y]: [i32; 2], triangle: usize, depth: f32) {
        if depth >= 1.0 {
            return;
        }
        let (index, item) = (self.opaque.index(x, y), self.input.triangles[triangle].item);
        if !self.blended.contains(triangle) {
            self.opaque.put(x, y, depth, item);
            self.sums[index] = None;
            return;
        }
        let under = self.sums[index].unwrap_or_else(|| {
            let behind = background_rows(self.look.background, self.input.view.height())(y);
            below_color(&mut self.lit, self.opaque.item[index], premultiply(behind), [x, y])
        });
        self.sums[index] = Some(over(&mut self.lit, item, under, [x, y]));
    }

    /// Writes the colour plane, and no other.
    pub fn write(self, framebuffer: &mut Framebuffer) {
        let mut colors = Framebuffer::new(framebuffer.width(), framebuffer.height());
        write(&self.opaque, self.lighting, self.look, &mut colors);
        for (color, sum) in colors.color.data_mut().iter_mut().zip(&self.sums) {
            if let Some(sum) = sum {
                *color = encode_premultiplied(*sum);
            }
        }
        framebuffer.color = colors.color;
    }
}
