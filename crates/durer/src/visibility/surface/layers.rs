//! Blended surfaces over opaque ones.
//!
//! *Over* is T. Porter and T. Duff's (*Compositing Digital Images*, SIGGRAPH 1984), on premultiplied
//! linear colours. Scan-line methods sort a row's layers by depth; depth sort meets them in order.

use crate::math::Vec4;
use crate::shade::color::premultiply;
use crate::target::NO_ITEM;
use crate::visibility::surface::active::Active;
use crate::visibility::surface::input::SurfaceInput;
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::nearest::{DepthRow, Masked, is_nearer};
use crate::visibility::surface::picture::Picture;
use crate::visibility::surface::setup::Coverage;

/// A blended surface at a pixel of a row.
#[derive(Debug, Clone, Copy)]
struct Layer {
    x: u32,
    item: u32,
    depth: f32,
}

/// The blended surfaces of one row at a time.
pub(crate) struct Layers {
    opaque: DepthRow,
    layers: Vec<Layer>,
}

/// Whether some surface of an input blends.
pub(crate) fn any_blended(input: &SurfaceInput<'_>) -> bool {
    input.runs.iter().any(|run| run.coverage == Coverage::Blended)
}

impl Layers {
    /// `None` where nothing blends.
    pub fn of(input: &SurfaceInput<'_>) -> Option<Self> {
        let opaque = DepthRow::new(input.view.width());
        any_blended(input).then(|| Self { opaque, layers: Vec::new() })
    }

    /// Writes the colours of row `y`: what is opaque, and over it what is blended and before it, far
    /// layers first; of equally far ones the lower item is in front.
    pub fn write(
        &mut self,
        y: i32,
        active: &[Active],
        input: &SurfaceInput<'_>,
        masked: &Masked<'_>,
        picture: &mut Picture<'_>,
    ) {
        self.collect(y, active, input, masked, &mut picture.lit);
        picture.write_color(0, y as u32, &self.opaque.item);
        let behind = premultiply(picture.behind(y));
        for layers in self.layers.chunk_by(|a, b| a.x == b.x) {
            let x = layers[0].x;
            let below = self.opaque.item[x as usize];
            let under = below_color(&mut picture.lit, below, behind, [x as i32, y]);
            let sum = layers.iter().fold(under, |under, layer| {
                over(&mut picture.lit, layer.item, under, [x as i32, y])
            });
            picture.set_color(x, y as u32, sum);
        }
    }

    /// Finds the opaque surface at each pixel, and the layers before it in order.
    fn collect(
        &mut self,
        y: i32,
        active: &[Active],
        input: &SurfaceInput<'_>,
        masked: &Masked<'_>,
        lit: &mut Lit<'_>,
    ) {
        let Self { opaque, layers, .. } = self;
        opaque.clear();
        layers.clear();
        let blended = |a: &&Active| {
            let item = input.triangles[a.triangle as usize].item;
            input.run_of(item).coverage == Coverage::Blended
        };
        for a in active.iter().filter(|a| !blended(a)) {
            let t = &input.triangles[a.triangle as usize];
            masked.enter(opaque, t, [a.x0, a.x1], y, lit, |_, _| ());
        }
        for a in active.iter().filter(blended) {
            let t = &input.triangles[a.triangle as usize];
            let [ox, oy] = t.origin();
            for x in a.x0..a.x1 {
                let depth = t.depth_at((x - ox) as f32, (y - oy) as f32);
                let i = x as usize;
                if is_nearer(depth, t.item, opaque.depth[i], opaque.item[i]) {
                    layers.push(Layer { x: x as u32, item: t.item, depth });
                }
            }
        }
        layers.sort_unstable_by(|a, b| {
            a.x.cmp(&b.x).then(b.depth.total_cmp(&a.depth)).then(b.item.cmp(&a.item))
        });
    }
}

/// The linear, premultiplied colour of what is opaque at a pixel; `behind` where nothing is.
pub(crate) fn below_color(lit: &mut Lit<'_>, item: u32, behind: Vec4, [x, y]: [i32; 2]) -> Vec4 {
    if item == NO_ITEM { behind } else { lit.color(item, x, y).truncate().extend(1.0) }
}

/// An item over what is there; linear, premultiplied.
pub(crate) fn over(lit: &mut Lit<'_>, item: u32, under: Vec4, [x, y]: [i32; 2]) -> Vec4 {
    let over = premultiply(lit.color(item, x, y));
    over + under * (1.0 - over.w)
}
