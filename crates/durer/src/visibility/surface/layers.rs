//! Blended surfaces over opaque ones.
//!
//! *Over* is T. Porter and T. Duff's (*Compositing Digital Images*, SIGGRAPH 1984), on premultiplied linear colours.
//! Scan-line methods sort the layers of a row by depth, subdivision and ray casting the layers of a sample; depth sort
//! produces them in order.

use crate::math::Vec4;
use crate::shade::color::premultiply;
use crate::target::NO_ITEM;
use crate::visibility::surface::input::{METHOD, SurfaceInput, TriangleSet};
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::picture::Picture;
use crate::visibility::surface::rows::active::Active;
use crate::visibility::surface::rows::nearest::{DepthRow, Masked, is_nearer};
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};
use crate::work::Charge;

/// A blended surface at a sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layer {
    /// Index of the sample: a column of a row, or a place in a window.
    pub place: u32,
    pub item: u32,
    pub depth: f32,
}

/// Sorts layers by place, and within a place from far to near; at equal depths the lower item is in front.
pub(crate) fn sort_layers(layers: &mut [Layer]) {
    layers.sort_unstable_by(|a, b| {
        a.place.cmp(&b.place).then(b.depth.total_cmp(&a.depth)).then(b.item.cmp(&a.item))
    });
}

/// The blended surfaces of one row at a time.
pub(crate) struct Layers<'a> {
    triangles: &'a [ScreenTriangle],
    blended: TriangleSet,
    opaque: DepthRow,
    layers: Vec<Layer>,
    /// Memory of the layers.
    charge: Charge,
}

/// Writes row `y` to all planes. `row` has the nearest surfaces, blended or not; in the colours, blended surfaces are
/// laid over the opaque ones.
pub(crate) fn write_row(
    y: i32,
    row: &DepthRow,
    active: &[Active],
    layers: &mut Option<Layers<'_>>,
    masked: &Masked<'_>,
    picture: &mut Picture<'_>,
) {
    let Some(layers) = layers else {
        return picture.write(0, y as u32, &row.item, &row.depth);
    };
    picture.write_planes(0, y as u32, &row.item, &row.depth);
    layers.write(y, active, masked, picture);
}

impl<'a> Layers<'a> {
    /// Creates the layers of an input; returns `None` if nothing blends.
    pub fn of(input: &'a SurfaceInput<'_>) -> Option<Self> {
        let (triangles, blended) = (&input.triangles, input.having(Coverage::Blended));
        let opaque = DepthRow::new(input.view.width());
        let charge = input.work.charge(METHOD, 0).unwrap_or_default();
        let layers = Vec::new();
        (!blended.is_empty()).then(|| Self { triangles, blended, opaque, layers, charge })
    }

    /// Writes the colours of row `y`: the opaque surfaces, and over them the blended ones in front, far layers first;
    /// at equal depths the lower item is in front.
    fn write(&mut self, y: i32, active: &[Active], masked: &Masked<'_>, picture: &mut Picture<'_>) {
        self.collect(y, active, masked, &mut picture.lit);
        picture.write_color(0, y as u32, &self.opaque.item);
        let behind = premultiply(picture.behind(y));
        for layers in self.layers.chunk_by(|a, b| a.place == b.place) {
            let x = layers[0].place;
            let (below, items) = (self.opaque.item[x as usize], layers.iter().map(|l| l.item));
            let sum = compose(&mut picture.lit, below, items, behind, [x as i32, y]);
            picture.set_color(x, y as u32, sum);
        }
    }

    /// Finds the opaque surface at each pixel, and the layers before it in order.
    fn collect(&mut self, y: i32, active: &[Active], masked: &Masked<'_>, lit: &mut Lit<'_>) {
        let Self { triangles, blended, opaque, layers, charge } = self;
        opaque.clear();
        layers.clear();
        let blends = |a: &&Active| blended.contains(a.triangle as usize);
        for a in active.iter().filter(|a| !blends(a)) {
            masked.enter(opaque, a.triangle, [a.x0, a.x1], y, lit, |_, _| ());
        }
        for a in active.iter().filter(blends) {
            let t = &triangles[a.triangle as usize];
            let [ox, oy] = t.origin();
            for x in a.x0..a.x1 {
                let depth = t.depth_at((x - ox) as f32, (y - oy) as f32);
                let i = x as usize;
                if is_nearer(depth, t.item, opaque.depth[i], opaque.item[i]) {
                    layers.push(Layer { place: x as u32, item: t.item, depth });
                }
            }
            if !charge.grow_to_or_stop((layers.capacity() * size_of::<Layer>()) as u64) {
                return;
            }
        }
        sort_layers(layers);
    }
}

/// Composes blended items over an opaque one, far ones first; linear, premultiplied.
pub(crate) fn compose(
    lit: &mut Lit<'_>,
    opaque: u32,
    blended: impl IntoIterator<Item = u32>,
    behind: Vec4,
    at: [i32; 2],
) -> Vec4 {
    let under = below_color(lit, opaque, behind, at);
    blended.into_iter().fold(under, |under, item| over(lit, item, under, at))
}

/// Returns the mean colour of a pixel's samples; equal samples are lit once.
pub(crate) fn mean<T: Ord>(samples: &mut [T], mut color: impl FnMut(&T) -> Vec4) -> Vec4 {
    samples.sort_unstable();
    let share = 1.0 / samples.len() as f32;
    let parts = samples.chunk_by(|a, b| a == b);
    parts.fold(Vec4::ZERO, |sum, same| sum + color(&same[0]) * (same.len() as f32 * share))
}

/// Returns the linear, premultiplied colour of the opaque surface at a pixel; `behind` if there is none.
pub(crate) fn below_color(lit: &mut Lit<'_>, item: u32, behind: Vec4, [x, y]: [i32; 2]) -> Vec4 {
    if item == NO_ITEM { behind } else { lit.color(item, x, y).truncate().extend(1.0) }
}

/// Returns an item laid over the colour there; linear, premultiplied.
pub(crate) fn over(lit: &mut Lit<'_>, item: u32, under: Vec4, [x, y]: [i32; 2]) -> Vec4 {
    let over = premultiply(lit.color(item, x, y));
    over + under * (1.0 - over.w)
}
