//! From vertices to fragments.

use super::{CullFace, Pipeline, Primitive, Vertex};
use crate::clip::volume::{Blend, ClipVertex, Options, clip_polygon, clip_segment};
use crate::fragment::{Fragment, FragmentState, Scissor, apply};
use crate::math::{DVec2, DVec3, DVec4, IVec2, Vec4};
use crate::raster::interpolate::{PerspectivePlane, ScreenPlane};
use crate::raster::line::{self, bresenham};
use crate::raster::triangle::{self, SnappedTriangle, TriangleRasterizer};
use crate::shade::color::encode_rgba8;
use crate::target::{Framebuffer, NO_ITEM};
use crate::trace::NoTrace;
use crate::view::window::PixelRect;
use crate::{Error, Result};

/// Linear colour and colour index.
type Paint = (DVec4, f64);

/// Position in clip space, colours beside it.
type Corner = ClipVertex<Paint>;

/// A corner on the screen: pixels, y down; window depth; 1/w; colours.
#[derive(Clone, Copy)]
struct OnScreen {
    at: DVec2,
    depth: f64,
    inv_w: f64,
    paint: Paint,
}

pub fn check_viewport(viewport: Option<[u32; 4]>, target: &Framebuffer) -> Result<()> {
    let Some([x, y, w, h]) = viewport else { return Ok(()) };
    let fits = |first: u32, size: u32, all: u32| {
        size > 0 && first.checked_add(size).is_some_and(|e| e <= all)
    };
    if fits(x, w, target.width()) && fits(y, h, target.height()) {
        Ok(())
    } else {
        Err(Error::parameter(
            "viewport",
            format!("{w}x{h}+{x}+{y}"),
            "within the framebuffer, not empty",
        ))
    }
}

/// Fills planes within the scissor rectangle, through the write masks.
pub fn clear(
    state: &FragmentState,
    color: Option<Vec4>,
    depth: Option<f32>,
    stencil: Option<u8>,
    index: Option<u8>,
    target: &mut Framebuffer,
) {
    let all = Scissor { x0: 0, y0: 0, x1: target.width(), y1: target.height() };
    let area = state.scissor.map_or(all, |s| s.intersection(&all));
    for (x, y) in (area.y0..area.y1).flat_map(|y| (area.x0..area.x1).map(move |x| (x, y))) {
        if let (Some(color), Some(old)) = (color, target.color.get(x, y)) {
            target.color.set(x, y, state.write_mask.color(encode_rgba8(color), old));
        }
        if let (Some(depth), true) = (depth, state.write_mask.depth) {
            if let Some(plane) = &mut target.depth {
                plane.set(x, y, depth);
            }
            if let Some(plane) = &mut target.item {
                plane.set(x, y, NO_ITEM);
            }
        }
        if let (Some(value), Some(plane)) = (stencil, &mut target.stencil) {
            let old = plane.get(x, y).unwrap_or(0);
            plane.set(x, y, state.write_mask.stencil(true, value, old));
        }
        if let (Some(value), Some(plane)) = (index, &mut target.index) {
            let old = plane.get(x, y).unwrap_or(0);
            plane.set(x, y, state.write_mask.index(value, old));
        }
    }
}

/// Draws primitives; vertices that are not finite make theirs vanish, and so do vertices too few.
pub fn draw(p: &Pipeline, primitive: Primitive, vertices: &[Vertex], target: &mut Framebuffer) {
    let clip_from_object = p.projection * p.model_view;
    let corner = |v: &Vertex| ClipVertex {
        position: clip_from_object * v.position.extend(1.0),
        attributes: (v.color.unwrap_or(p.color).as_dvec4(), f64::from(v.index.unwrap_or(p.index))),
    };
    let corners: Vec<Corner> = vertices.iter().map(corner).collect();
    match primitive {
        Primitive::Points => corners.iter().for_each(|c| point(p, *c, target)),
        Primitive::Lines => {
            corners.as_chunks().0.iter().for_each(|ends| segment(p, *ends, target));
        }
        Primitive::LineStrip => {
            corners.windows(2).for_each(|ends| segment(p, [ends[0], ends[1]], target));
        }
        Primitive::Triangles => {
            corners.as_chunks::<3>().0.iter().for_each(|ring| polygon(p, ring, target));
        }
        Primitive::Polygon => polygon(p, &corners, target),
    }
}

fn on_screen(p: &Pipeline, v: &Corner, target: &Framebuffer) -> OnScreen {
    let [x, y, w, h] = p.viewport.unwrap_or([0, 0, target.width(), target.height()]).map(f64::from);
    let ndc: DVec3 = v.position.truncate() / v.position.w;
    let at = DVec2::new(x + (ndc.x + 1.0) * 0.5 * w, y + (1.0 - ndc.y) * 0.5 * h);
    OnScreen {
        at,
        depth: p.depth_range.window(ndc.z),
        inv_w: v.position.w.recip(),
        paint: v.attributes,
    }
}

fn put(
    p: &Pipeline,
    [x, y]: [i32; 2],
    depth: f64,
    (color, index): Paint,
    front: bool,
    target: &mut Framebuffer,
) {
    let fragment = Fragment {
        x: x as u32,
        y: y as u32,
        depth: p.depth_range.clamp(depth as f32),
        color: color.clamp(DVec4::ZERO, DVec4::ONE).as_vec4(),
        index: index as f32,
        front_facing: front,
        item: NO_ITEM,
        normal: [0.0; 3],
    };
    if x >= 0 && y >= 0 {
        apply(&p.fragments, fragment, target);
    }
}

/// Returns the pixels of the viewport.
fn window(p: &Pipeline, target: &Framebuffer) -> [i32; 4] {
    let [x, y, w, h] = p.viewport.unwrap_or([0, 0, target.width(), target.height()]);
    [x, y, x.saturating_add(w), y.saturating_add(h)].map(|v| v.min(i32::MAX as u32) as i32)
}

/// Returns the pixel of a place within the viewport, whose right and lower border belong to its last
/// pixels.
fn pixel(p: &Pipeline, at: DVec2, target: &Framebuffer) -> IVec2 {
    let [x0, y0, x1, y1] = window(p, target);
    at.floor().as_ivec2().clamp(IVec2::new(x0, y0), IVec2::new((x1 - 1).max(x0), (y1 - 1).max(y0)))
}

fn point(p: &Pipeline, corner: Corner, target: &mut Framebuffer) {
    let Some([v, _]) = clip_segment([corner, corner], &Options::default(), &mut NoTrace) else {
        return;
    };
    let v = on_screen(p, &v, target);
    let at = pixel(p, v.at, target);
    put(p, at.to_array(), v.depth, v.paint, true, target);
}

fn segment(p: &Pipeline, ends: [Corner; 2], target: &mut Framebuffer) {
    let Some(clipped) = clip_segment(ends, &Options::default(), &mut NoTrace) else { return };
    let [a, b] = [0, 1].map(|i| on_screen(p, &clipped[i], target));
    let [from, to] = [a, b].map(|v| pixel(p, v.at, target));
    let way = (to - from).as_dvec2();
    let mut pixels = Vec::new();
    bresenham::draw(from, to, &line::Options::default(), |p| pixels.push(p), &mut NoTrace);
    for at in pixels {
        let length2 = way.length_squared();
        let t = if length2 > 0.0 { (at - from).as_dvec2().dot(way) / length2 } else { 0.0 };
        let depth = a.depth + (b.depth - a.depth) * t;
        // Linear in space: what is near counts more.
        let (near, far) = (a.inv_w * (1.0 - t), b.inv_w * t);
        let paint = Blend::blend(&a.paint, near, &b.paint, far, near + far);
        put(p, at.to_array(), depth, paint, true, target);
    }
}

fn polygon(p: &Pipeline, ring: &[Corner], target: &mut Framebuffer) {
    let clipped = clip_polygon(ring, &Options::default(), &mut NoTrace);
    let corners: Vec<OnScreen> = clipped.iter().map(|v| on_screen(p, v, target)).collect();
    for k in 2..corners.len() {
        triangle(p, [corners[0], corners[k - 1], corners[k]], target);
    }
}

fn triangle(p: &Pipeline, corners: [OnScreen; 3], target: &mut Framebuffer) {
    let points = corners.map(|c| c.at);
    let Ok(snapped) = SnappedTriangle::snap(points) else { return };
    // On the screen y is down: counter-clockwise with y up is negative here.
    let front = match snapped.doubled_area() {
        0 => return,
        area => area < 0,
    };
    if p.cull == (if front { CullFace::Front } else { CullFace::Back }) {
        return;
    }
    let [x0, y0, x1, y1] = window(p, target);
    let Ok(clip) = PixelRect::new(x0, y0, x1, y1) else { return };
    let inv_w = corners.map(|c| c.inv_w);
    let plane = |values| PerspectivePlane::through(points, inv_w, values);
    let channel = |k: usize| plane(corners.map(|c| c.paint.0[k]));
    let depths = corners.map(|c| c.depth);
    let (Some(depth), [Some(r), Some(g), Some(b), Some(a)], Some(index)) = (
        ScreenPlane::through(points, depths),
        [0, 1, 2, 3].map(channel),
        plane(corners.map(|c| c.paint.1)),
    ) else {
        return;
    };
    let deepest = depths.into_iter().fold(0.0, f64::max) as f32;
    let slope = [depth.gradient.x as f32, depth.gradient.y as f32];
    let offset = f64::from(p.polygon_offset.offset(slope, deepest));
    let range = (depths.into_iter().fold(1.0, f64::min), depths.into_iter().fold(0.0, f64::max));
    let options = triangle::Options { clip };
    TriangleRasterizer::EdgeWalking.rasterize(&snapped, &options, |span| {
        for x in span.x0..span.x1 {
            let at = DVec2::new(f64::from(x) + 0.5, f64::from(span.y) + 0.5);
            let z = depth.at(at).clamp(range.0, range.1.max(range.0)) + offset;
            let color = DVec4::new(r.at(at), g.at(at), b.at(at), a.at(at));
            put(p, [x, span.y], z, (color, index.at(at)), front, target);
        }
    });
}
