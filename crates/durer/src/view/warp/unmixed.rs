//! Colours of smoothed outlines, restored to those of one surface.
//!
//! With several samples per pixel, the colours along an outline are mixed from both sides, but each pixel has the depth
//! of one side. If pixels moved with it, the other side's colour would appear as a ghost.

use super::DepthPicture;
use crate::target::Pixels;

/// Depths of 16 bits are rounded by half of this; smaller steps say nothing.
const ROUNDING: f32 = 4.0 / 65_535.0;

/// Colours closer than this are the same.
const SAME: u8 = 2;

/// Returns the source's colours, in which a pixel at a jump of depth gets the colour of its own side if its colour is
/// between those of both sides. Cost: O(pixels).
pub(super) fn unmixed(source: &DepthPicture<'_>) -> Pixels<[u8; 4]> {
    let mut colors = source.color.clone();
    for y in 0..colors.height() {
        for x in 0..colors.width() {
            if let Some(own) = own_color(source, [x, y]) {
                colors.set(x, y, own);
            }
        }
    }
    colors
}

/// Returns the colour of a mixed pixel without that of the other side; `None` for a pixel that is not mixed.
fn own_color(source: &DepthPicture<'_>, at: [u32; 2]) -> Option<[u8; 4]> {
    let pixel = |steps: i32, [dx, dy]: [i32; 2]| {
        let x = at[0].checked_add_signed(dx * steps)?;
        let y = at[1].checked_add_signed(dy * steps)?;
        Some((source.depth.get(x, y)?, source.color.get(x, y)?))
    };
    let (depth, color) = pixel(0, [0, 0])?;
    [[1, 0], [-1, 0], [0, 1], [0, -1]].into_iter().find_map(|way| {
        let (beyond, _) = pixel(1, way)?;
        let (before, own) = pixel(-1, way)?;
        if !jumps(depth, beyond, before) || jumps(depth, before, beyond) {
            return None;
        }
        let (_, other) = pixel(2, way).or(pixel(1, way))?;
        let mixed = !is_near(color, own) && is_between(color, own, other);
        mixed.then_some(own)
    })
}

/// Returns whether depth jumps from a pixel to the next one, compared with the step on its other side: on
/// one plane both are equal, because window depth is linear on the screen.
fn jumps(here: f32, next: f32, opposite: f32) -> bool {
    let nothing = |depth: f32| depth >= 1.0;
    nothing(here) != nothing(next) || (next - here).abs() > 3.0 * (here - opposite).abs() + ROUNDING
}

fn is_near(a: [u8; 4], b: [u8; 4]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= SAME)
}

fn is_between(c: [u8; 4], a: [u8; 4], b: [u8; 4]) -> bool {
    let between = |c: u8, a: u8, b: u8| {
        (a.min(b).saturating_sub(SAME)..=a.max(b).saturating_add(SAME)).contains(&c)
    };
    c.iter().zip(a).zip(b).all(|((c, a), b)| between(*c, a, b))
}
