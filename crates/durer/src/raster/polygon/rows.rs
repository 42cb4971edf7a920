//! The crossings of a polygon's edges with the centres of rows, edge by edge.

use super::snapped_edges;
use crate::curve::Contours;
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS, first_center};

/// Calls `f` with the row, and the first pixel whose centre is not left of the edge, of each crossing of an edge with a
/// row of the target, which has `width` × `height` pixels; edges in their order, each from its upper end. Pixels are
/// within 0 … `width`. Exact, as all snapped edges are.
pub fn for_each_crossing(
    contours: &Contours,
    (width, height): (u32, u32),
    mut f: impl FnMut(u32, u32),
) {
    snapped_edges(contours, 0..contours.points().len(), |a, b| {
        let (upper, lower) = if a.1 <= b.1 { (a, b) } else { (b, a) };
        let [ux, uy, lx, ly] = [upper.0, upper.1, lower.0, lower.1].map(i64::from);
        let (dx, dy) = (lx - ux, ly - uy);
        let last = i64::from(first_center(lower.1)).min(height.into());
        for row in i64::from(first_center(upper.1)).max(0)..last {
            let below = row * i64::from(SUBPIXELS) + i64::from(HALF_PIXEL) - uy;
            // ⌈(x − ½) / 1⌉ for the crossing's x, in 1/256 of a pixel.
            let numerator = (ux - i64::from(HALF_PIXEL)) * dy + dx * below;
            let x = -(-numerator).div_euclid(dy * i64::from(SUBPIXELS));
            f(row as u32, x.clamp(0, width.into()) as u32);
        }
    });
}
