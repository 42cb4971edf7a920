//! One row of depth: which triangle is nearest at each pixel's centre.

use crate::target::NO_ITEM;
use crate::visibility::surface::input::{SurfaceInput, TriangleSet};
use crate::visibility::surface::lit::Lit;
use crate::visibility::surface::setup::{Coverage, ScreenTriangle};

/// The depth and the item of the nearest triangle so far at each pixel of a row.
#[derive(Debug, Clone)]
pub struct DepthRow {
    /// Window depth; 1 at the background.
    pub depth: Vec<f32>,
    /// The nearest item; [`NO_ITEM`] at the background.
    pub item: Vec<u32>,
}

impl DepthRow {
    /// Creates an empty row of this many pixels.
    pub fn new(width: u32) -> Self {
        Self { depth: vec![1.0; width as usize], item: vec![NO_ITEM; width as usize] }
    }

    /// Forgets all triangles.
    pub fn clear(&mut self) {
        self.depth.fill(1.0);
        self.item.fill(NO_ITEM);
    }

    /// Enters the pixels x0 … x1 − 1 of a triangle where it is nearer than the stored depth and `passes` returns that
    /// it has no hole; calls `wrote` for each pixel entered.
    #[inline(always)]
    pub fn enter(
        &mut self,
        t: &ScreenTriangle,
        [x0, x1]: [i32; 2],
        y: i32,
        mut passes: impl FnMut(i32) -> bool,
        mut wrote: impl FnMut(i32, f32),
    ) {
        let [ox, oy] = t.origin();
        let dy = (y - oy) as f32;
        let columns = x0.max(0) as usize..x1.max(x0).max(0) as usize;
        let Some(depths) = self.depth.get_mut(columns.clone()) else { return };
        let Some(items) = self.item.get_mut(columns) else { return };
        for (x, (kept, item)) in (x0..x1).zip(depths.iter_mut().zip(items)) {
            let depth = t.depth_at((x - ox) as f32, dy);
            if is_nearer(depth, t.item, *kept, *item) && passes(x) {
                (*kept, *item) = (depth, t.item);
                wrote(x, depth);
            }
        }
    }
}

/// Returns whether a surface hides the current one: it is nearer, or equally far with a lower item.
/// Depths from 1 on are beyond the far plane, which [`NO_ITEM`] at depth 1 represents.
#[inline(always)]
pub fn is_nearer(depth: f32, item: u32, kept: f32, kept_item: u32) -> bool {
    depth < kept || (depth == kept && item < kept_item && kept_item != NO_ITEM)
}

/// Triangles to be entered into rows, with holes where they have them.
pub(crate) struct Masked<'a> {
    triangles: &'a [ScreenTriangle],
    /// Triangles that have to be tested for holes at each pixel.
    pub masked: TriangleSet,
}

impl<'a> Masked<'a> {
    pub fn new(input: &'a SurfaceInput<'_>) -> Self {
        Self { triangles: &input.triangles, masked: input.having(Coverage::Masked) }
    }

    /// Enters a span of the triangle at a place of the input's list.
    #[inline(always)]
    pub fn enter(
        &self,
        row: &mut DepthRow,
        triangle: u32,
        span: [i32; 2],
        y: i32,
        lit: &mut Lit<'_>,
        wrote: impl FnMut(i32, f32),
    ) {
        let t = &self.triangles[triangle as usize];
        if self.masked.contains(triangle as usize) {
            row.enter(t, span, y, |x| lit.passes_mask(t.item, x, y), wrote);
        } else {
            row.enter(t, span, y, |_| true, wrote);
        }
    }
}
