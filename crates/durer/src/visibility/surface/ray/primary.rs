//! Rays from the eye, in screen space.
//!
//! The transformation to screen space takes lines through the eye to lines along the depth axis. So the transformation
//! that S. Woop, C. Benthin and I. Wald apply for each ray (*Watertight Ray/Triangle Intersection*, JCGT 2013) is
//! applied once for all rays: a triangle is hit if its three edge functions have the right sign, here as integers on
//! the snapped triangle. No ray slips through between two triangles, and hits and depths are those of the z-buffer.

use super::bvh::{Box3, Bvh, Test, face};
use crate::math::Vec3;
use crate::raster::fixed::{HALF_PIXEL, SUBPIXEL_BITS, SUBPIXELS};
use crate::trace::Tracer;
use crate::view::View;
use crate::visibility::surface::setup::ScreenTriangle;
use crate::visibility::surface::visible::nearer;

pub struct ScreenRays<'a> {
    triangles: &'a [ScreenTriangle],
    bvh: Bvh,
}

/// A hit from the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenHit {
    pub depth: f32,
    pub item: u32,
    /// Index into the input's triangles.
    pub triangle: u32,
}

impl<'a> ScreenRays<'a> {
    pub fn new(triangles: &'a [ScreenTriangle], view: &View) -> Self {
        let boxes: Vec<Box3> = triangles.iter().map(|t| box_of(t, view)).collect();
        Self { triangles, bvh: Bvh::new(&boxes, face) }
    }

    /// Returns the nearest triangle for which `hides` returns true, at a point `offset` (1/256 pixel) from a pixel's
    /// centre. `hides` is called only for hits nearer than the nearest so far.
    #[inline]
    pub fn cast(
        &self,
        [x, y]: [i32; 2],
        offset: [i32; 2],
        stack: &mut Vec<(u32, f32)>,
        mut hides: impl FnMut(&ScreenHit) -> bool,
        tests: &mut impl Tracer<Test>,
    ) -> Option<ScreenHit> {
        let place = |v: i32, o: i32| (v << SUBPIXEL_BITS) + HALF_PIXEL + o;
        let at = [place(x, offset[0]), place(y, offset[1])];
        let (px, py) = (at[0] as f32, at[1] as f32);
        let enter = |b: &Box3| {
            let inside = b.min.x <= px && px <= b.max.x && b.min.y <= py && py <= b.max.y;
            inside.then_some(b.min.z)
        };
        let mut best: Option<ScreenHit> = None;
        let rest = offset.map(|o| o as f32 / SUBPIXELS as f32);
        let visit = |i: u32, limit: &mut f32| {
            let t = &self.triangles[i as usize];
            if !covers(t, at) {
                return;
            }
            let [ox, oy] = t.origin();
            let depth = t.depth_at((x - ox) as f32 + rest[0], (y - oy) as f32 + rest[1]);
            let wins = best.is_none_or(|b| nearer((depth, t.item), (b.depth, b.item)));
            let hit = ScreenHit { depth, item: t.item, triangle: i };
            if depth < 1.0 && wins && hides(&hit) {
                *limit = depth;
                best = Some(hit);
            }
        };
        self.bvh.visit(1.0, stack, enter, visit, tests);
        best
    }
}

/// Returns the box of a triangle in 1/256 pixel and depth; coordinates far off the screen are
/// brought near, so that `f32` holds them exactly.
fn box_of(t: &ScreenTriangle, view: &View) -> Box3 {
    let range = |v: &[i32; 3], pixels: u32| {
        let end = (pixels as i32 + 1).saturating_mul(SUBPIXELS);
        let keep = |v: i32| v.clamp(-SUBPIXELS, end) as f32;
        (keep(v[0].min(v[1]).min(v[2])), keep(v[0].max(v[1]).max(v[2])))
    };
    let ((x0, x1), (y0, y1)) = (range(&t.x, view.width()), range(&t.y, view.height()));
    Box3 { min: Vec3::new(x0, y0, t.depth_min), max: Vec3::new(x1, y1, t.depth_max) }
}

/// Returns whether a triangle covers a point in 1/256 pixel, by the top-left rule.
#[inline]
fn covers(t: &ScreenTriangle, [sx, sy]: [i32; 2]) -> bool {
    (0..3).all(|i| {
        let j = (i + 1) % 3;
        let (dx, dy) = (i64::from(t.x[j] - t.x[i]), i64::from(t.y[j] - t.y[i]));
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        let value = dx * i64::from(sy - t.y[i]) - dy * i64::from(sx - t.x[i]);
        value > 0 || (value == 0 && top_left)
    })
}
