//! The comparison of two triangles' depths over a whole window, certain for every sample as computed.

use crate::visibility::surface::cover::SampleGrid;
use crate::visibility::surface::setup::ScreenTriangle;
use crate::visibility::surface::window::SampleRect;

/// Returns the largest depth over a window's samples; exact, because rounding is monotonic: depths increase or decrease
/// along rows and columns and are extreme at corners.
pub fn farthest(t: &ScreenTriangle, grid: SampleGrid, window: &SampleRect) -> f32 {
    window.corners().into_iter().fold(0.0, |far: f32, [x, y]| far.max(grid.depth(t, x, y)))
}

fn nearest(t: &ScreenTriangle, grid: SampleGrid, window: &SampleRect) -> f32 {
    let corners = window.corners().into_iter();
    corners.fold(f32::INFINITY, |near, [x, y]| near.min(grid.depth(t, x, y)))
}

/// Returns the depth of the triangle's plane and a bound on its rounding error.
fn on_plane(t: &ScreenTriangle, grid: SampleGrid, [x, y]: [i32; 2]) -> (f64, f64) {
    let [dx, dy] = grid.offset(t, x, y).map(f64::from);
    let (ax, ay) = (f64::from(t.depth_dx) * dx, f64::from(t.depth_dy) * dy);
    let depth = f64::from(t.depth);
    // Two products and two sums, each with an error of half an ulp of f32, for two numbers.
    let slack = 4.0 * f64::from(f32::EPSILON) * (depth.abs() + ax.abs() + ay.abs());
    (depth + (ax + ay), slack)
}

/// Returns whether `front` wins against `behind` at every sample of a window that it surrounds.
pub fn hides(
    front: &ScreenTriangle,
    behind: &ScreenTriangle,
    grid: SampleGrid,
    window: &SampleRect,
) -> bool {
    let (far, near) = (farthest(front, grid, window), nearest(behind, grid, window));
    if far < near || (far == near && front.item < behind.item) {
        return true;
    }
    // Depths are clamped to the range of the vertices; clamping must not raise `front` above its plane, nor
    // lower `behind` to it.
    if front.depth_min >= near || far >= behind.depth_max {
        return false;
    }
    window.corners().into_iter().all(|corner| {
        let (f, f_slack) = on_plane(front, grid, corner);
        let (b, b_slack) = on_plane(behind, grid, corner);
        f + f_slack + b_slack < b
    })
}
