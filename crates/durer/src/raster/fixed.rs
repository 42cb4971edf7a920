//! Screen coordinates in fixed point: 24 bits of pixels, 8 bits below the pixel.
//!
//! All triangle rasterizers snap to this grid first and decide coverage on it with integers, so they
//! agree on every pixel; two triangles that share an edge share its snapped end points too.

/// Bits below the pixel, as Direct3D demands and most hardware has.
pub const SUBPIXEL_BITS: u32 = 8;

/// Steps of the grid in one pixel.
pub const SUBPIXELS: i32 = 1 << SUBPIXEL_BITS;

/// Half a pixel: the offset of a pixel's centre from its upper left corner.
pub(crate) const HALF_PIXEL: i32 = SUBPIXELS / 2;

/// Screen coordinates beyond ± this many pixels must be clipped before they are snapped.
///
/// Edge functions of coordinates within this guard band fit i64 with room to spare, and i32 inside a
/// block of 16 × 8 pixels that an edge crosses; the coordinates are at most 2¹⁷ · 2⁸ = 2²⁵.
pub const GUARD_BAND: f64 = 131_072.0;

/// Returns the grid point nearest to a screen coordinate in pixels, ties to even.
///
/// Coordinates outside ± [`GUARD_BAND`] are clamped to it; NaN becomes 0.
#[inline]
pub fn snap(pixels: f64) -> i32 {
    // Below 1.5 · 2⁵² there are no fractions: adding it rounds, without a call where the processor has no instruction.
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    (pixels.clamp(-GUARD_BAND, GUARD_BAND) * f64::from(SUBPIXELS) + WHOLE - WHOLE) as i32
}

/// Returns the screen coordinate of a grid point, in pixels; exact.
#[inline]
pub fn unsnap(fixed: i32) -> f64 {
    f64::from(fixed) / f64::from(SUBPIXELS)
}

/// Returns the first pixel whose centre is not left of (above) the coordinate.
#[inline]
pub fn first_center(fixed: i32) -> i32 {
    (fixed + HALF_PIXEL - 1) >> SUBPIXEL_BITS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centers_are_found() {
        assert_eq!(first_center(snap(0.5)), 0);
        assert_eq!(first_center(snap(0.5) + 1), 1);
        assert_eq!(first_center(snap(-0.5)), -1);
        assert_eq!(first_center(snap(3.0)), 3);
    }
}
