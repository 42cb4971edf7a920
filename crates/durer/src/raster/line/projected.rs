//! Lines between points of clip space: which pixel each end has, so that all pixels of the whole line can be lit that
//! are within a window.
//!
//! A line that is cut at the border of the picture and then drawn between the pixels of the cut has another slope than
//! the whole line. So lines are not cut at the sides; the line algorithm enters the window with the state that it has
//! there ([`super::Options::window`]). They are cut at the near and far planes, which end the line itself.

use crate::clip::volume::{Borders, ClipVertex, Interpolate, Options, clip_segment};
use crate::math::{DVec2, IVec2};
use crate::trace::NoTrace;

/// Coordinates of pixels stay below this power of two, far within the integers.
const MOST: f64 = (1_u32 << 29) as f64;

/// Returns the part of a segment between the near and the far plane, in front of the eye, and within `2^29` pixels of a
/// window of `size` pixels at most; `None` if nothing of it can be in the window.
pub(crate) fn cut<A: Interpolate>(
    ends: [ClipVertex<A>; 2],
    size: u32,
) -> Option<[ClipVertex<A>; 2]> {
    let guard_band = (2.0 * MOST / f64::from(size.max(1))).max(1.0);
    let options = Options { borders: Borders::Depths { guard_band }, ..Options::default() };
    clip_segment(ends, &options, &mut NoTrace)
}

/// Returns the pixel of a place, column and row; places exactly on the border at which the window ends belong to its
/// last pixels.
pub(crate) fn pixel(at: DVec2, end: DVec2) -> IVec2 {
    let on_border = at.cmpeq(end);
    let at = at.floor() - DVec2::new(f64::from(on_border.x), f64::from(on_border.y));
    at.as_ivec2()
}
