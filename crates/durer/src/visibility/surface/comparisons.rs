//! Depth comparisons of the z-buffer as it was published: triangle by triangle, pixel by pixel.
//!
//! The production path ([`super::z_buffer`]) finds the same pixels with fewer comparisons: it works on tiles and skips
//! blocks that nearer triangles cover. Its count would say more about the tiles than about the algorithm.

use super::cover::{Cover, SampleGrid};
use super::input::{METHOD, SurfaceInput};
use super::picture;
use super::rows::nearest::is_nearer;
use super::setup::Coverage;
use super::visible::{Masks, Visible, pixels_of, with_lighting};
use crate::shade::PreparedLights;

/// Operations of the z-buffer on all triangles of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Comparisons {
    /// Pixels of all triangles: at each, a depth is compared with the stored one.
    pub compared: u64,
    /// Comparisons that the triangle won, so that its depth was stored; blended surfaces store none.
    pub stored: u64,
}

/// Counts the depth comparisons at the pixels' centres, with the triangles in the order of the input.
/// Cost: O(covered pixels); memory O(pixels).
///
/// # Errors
/// [`crate::Error::Memory`] if the budget has no room for depths, and the reason that stopped the input's work.
pub(crate) fn comparisons(input: &SurfaceInput<'_>) -> crate::Result<Comparisons> {
    let mut counts = Comparisons::default();
    let window = pixels_of(input.view);
    let pixels = u64::from(input.view.window().width()) * u64::from(input.view.window().height());
    let _depths = input.work.charge(METHOD, pixels.saturating_mul(Visible::PER_SAMPLE))?;
    let mut visible = Visible::new(window);
    let blended = input.having(Coverage::Blended);
    let lights = PreparedLights::new(&[], input.view.camera());
    with_lighting(input, &lights, &picture::Options::default(), |lighting| {
        let mut masks = Masks::new(input, lighting);
        for (place, triangle) in input.triangles.iter().enumerate() {
            if input.work.is_stopped() {
                return;
            }
            let item = triangle.item;
            Cover::new(triangle, SampleGrid::PIXELS).spans(&window, |span| {
                for x in span.x0..span.x1 {
                    counts.compared += 1;
                    let depth = SampleGrid::PIXELS.depth(triangle, x, span.y);
                    let index = visible.index(x, span.y);
                    let wins = is_nearer(depth, item, visible.depth[index], visible.item[index]);
                    if wins && !blended.contains(place) && masks.passes(place, item, x, span.y) {
                        counts.stored += 1;
                        visible.put(x, span.y, depth, item);
                    }
                }
            });
        }
    });
    input.work.check()?;
    Ok(counts)
}
