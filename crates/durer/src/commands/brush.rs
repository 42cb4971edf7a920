//! From the rasterizer to the fragment operations: texturing.

use super::state::Pipeline;
use super::texture::Prepared;
use crate::fragment::{Fragment, apply};
use crate::math::{DVec2, DVec4};
use crate::target::{Framebuffer, NO_ITEM};

/// The colour of a fragment before texturing.
#[derive(Clone, Copy)]
pub(super) struct Look {
    /// Linear RGBA.
    pub color: DVec4,
    pub index: f64,
    /// Texture coordinates there, and one pixel further along x and y.
    pub tex_coords: [DVec2; 3],
}

/// Brush that gives fragments their texture and passes them on.
pub(super) struct Brush<'a> {
    p: &'a Pipeline,
    texture: Option<Prepared<'a>>,
}

impl<'a> Brush<'a> {
    /// Prepares the texture.
    pub fn new(p: &'a Pipeline) -> Self {
        Self { p, texture: p.texture.as_ref().map(|texture| texture.prepare()) }
    }

    /// Returns the state of the pipeline.
    pub fn pipeline(&self) -> &'a Pipeline {
        self.p
    }

    /// Passes a fragment on, unless its column or row is negative.
    pub fn put(
        &self,
        at: [i32; 2],
        depth: f64,
        look: &Look,
        front: bool,
        target: &mut Framebuffer,
    ) {
        self.put_covered(at, depth, look, 1.0, front, target);
    }

    /// Passes a fragment on as [`Self::put`] does, with the alpha of its textured colour multiplied by a coverage.
    pub fn put_covered(
        &self,
        [x, y]: [i32; 2],
        depth: f64,
        look: &Look,
        coverage: f64,
        front: bool,
        target: &mut Framebuffer,
    ) {
        if x < 0 || y < 0 {
            return;
        }
        let color = look.color.clamp(DVec4::ZERO, DVec4::ONE);
        let color = match &self.texture {
            Some(texture) => texture.apply(color, look.tex_coords),
            None => color,
        };
        let color = color * DVec4::ONE.with_w(coverage);
        let fragment = Fragment {
            x: x as u32,
            y: y as u32,
            depth: self.p.depth_range.clamp(depth as f32),
            color: color.as_vec4(),
            index: look.index as f32,
            front_facing: front,
            item: NO_ITEM,
            normal: [0.0; 3],
        };
        apply(&self.p.fragments, fragment, target);
    }
}
