//! The depth of a triangle as a plane over the screen.

use super::vertex::ScreenVertex;
use crate::raster::fixed::{HALF_PIXEL, SUBPIXELS};

/// The plane of depth through three vertices: its value at the centre of the pixel that holds the
/// first, and its change per pixel.
#[inline(always)]
pub fn depth_plane(
    a: &ScreenVertex,
    b: &ScreenVertex,
    c: &ScreenVertex,
    snapped_area: f64,
) -> [f32; 3] {
    // Through the places before snapping, which are exact.
    let away = |to: i32, from: i32, rest: f32, rest_from: f32| {
        f64::from(to - from) + (f64::from(rest) - f64::from(rest_from))
    };
    let (mut dx1, mut dy1) =
        (away(b.x, a.x, b.rest_x, a.rest_x), away(b.y, a.y, b.rest_y, a.rest_y));
    let (mut dx2, mut dy2) =
        (away(c.x, a.x, c.rest_x, a.rest_x), away(c.y, a.y, c.rest_y, a.rest_y));
    let mut area = dx1 * dy2 - dx2 * dy1;
    let (mut rest_x, mut rest_y) = (f64::from(a.rest_x), f64::from(a.rest_y));
    if area < 0.25 * snapped_area {
        // A sliver that only snapping gives its area: its plane is that of the snapped triangle.
        (dx1, dy1) = (f64::from(b.x - a.x), f64::from(b.y - a.y));
        (dx2, dy2) = (f64::from(c.x - a.x), f64::from(c.y - a.y));
        (area, rest_x, rest_y) = (snapped_area, 0.0, 0.0);
    }
    let scale = f64::from(SUBPIXELS) / area;
    let z = f64::from(a.depth);
    let (dz1, dz2) = (f64::from(b.depth) - z, f64::from(c.depth) - z);
    let depth_dx = (dz1 * dy2 - dz2 * dy1) * scale;
    let depth_dy = (dz2 * dx1 - dz1 * dx2) * scale;
    let depth = z + depth_dx * to_center(a.x, rest_x) + depth_dy * to_center(a.y, rest_y);
    [depth as f32, depth_dx as f32, depth_dy as f32]
}

/// From a coordinate to the centre of the pixel that holds its snapped place, in pixels.
#[inline(always)]
fn to_center(v: i32, rest: f64) -> f64 {
    (f64::from(HALF_PIXEL - (v & (SUBPIXELS - 1))) - rest) / f64::from(SUBPIXELS)
}
