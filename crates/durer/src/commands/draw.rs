//! From vertices to fragments.

use super::brush::{Brush, Look};
use super::lighting::ShadeModel;
use super::state::{CullFace, Pipeline, RasterPosition};
use super::{CornerVertex, Primitive};
use crate::clip::volume::{ClipVertex, Interpolate, Options, clip_polygon, clip_segment};
use crate::fragment::{FragmentState, Scissor};
use crate::math::{DMat3, DMat4, DVec2, DVec3, DVec4, IVec2, Vec4};
use crate::raster::interpolate::{PerspectivePlane, ScreenPlane};
use crate::raster::line::{self, bresenham, projected};
use crate::raster::point;
use crate::raster::triangle::{self, SnappedTriangle, TriangleRasterizer};
use crate::shade::color::encode_rgba8;
use crate::target::{Framebuffer, NO_ITEM, RowOrigin};
use crate::trace::NoTrace;
use crate::view::window::PixelRect;
use crate::{Error, Result};

/// Interpolated values: linear colours of both sides, colour index, texture coordinates.
#[derive(Clone, Copy)]
struct Paint {
    front: DVec4,
    back: DVec4,
    index: f64,
    tex_coord: DVec2,
}

impl Interpolate for Paint {
    fn blend(a: &Self, wa: f64, b: &Self, wb: f64, total: f64) -> Self {
        Self {
            front: Interpolate::blend(&a.front, wa, &b.front, wb, total),
            back: Interpolate::blend(&a.back, wa, &b.back, wb, total),
            index: Interpolate::blend(&a.index, wa, &b.index, wb, total),
            tex_coord: Interpolate::blend(&a.tex_coord, wa, &b.tex_coord, wb, total),
        }
    }
}

impl Paint {
    fn color(&self, front: bool) -> DVec4 {
        if front { self.front } else { self.back }
    }
}

/// Position in clip space, colours beside it.
type Corner = ClipVertex<Paint>;

/// A corner on the screen: pixels, rows as in the framebuffer; window depth; 1/w; colours.
#[derive(Clone, Copy)]
struct OnScreen {
    at: DVec2,
    depth: f64,
    inv_w: f64,
    paint: Paint,
}

pub(super) fn check_viewport(viewport: Option<[u32; 4]>, target: &Framebuffer) -> Result<()> {
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
pub(super) fn clear(
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

/// The vertex operations of a drawing command.
struct Vertices<'a> {
    p: &'a Pipeline,
    clip_from_object: DMat4,
    /// Matrix that transforms normals to eye space.
    normals: DMat3,
}

impl<'a> Vertices<'a> {
    fn new(p: &'a Pipeline) -> Self {
        let normals = DMat3::from_mat4(p.model_view).inverse().transpose();
        // A matrix without inverse leaves no direction to be lit from.
        let normals = if normals.is_finite() { normals } else { DMat3::ZERO };
        Self { p, clip_from_object: p.projection * p.model_view, normals }
    }

    fn corner(&self, v: &CornerVertex) -> Corner {
        let p = self.p;
        let color = v.color.unwrap_or(p.color);
        let [front, back] = if p.lighting.enabled {
            let normal = self.normals * v.normal.unwrap_or(p.normal);
            let normal = if p.lighting.normalize { normal.normalize_or_zero() } else { normal };
            let eye = p.model_view * v.position.extend(1.0);
            let lit = |front| p.lighting.lit(front, eye, normal, color, &mut NoTrace);
            let front = lit(true);
            [front, if p.lighting.model.two_sided { lit(false) } else { front }]
        } else {
            [color.as_dvec4(); 2]
        };
        let paint = Paint {
            front,
            back,
            index: f64::from(v.index.unwrap_or(p.index)),
            tex_coord: v.tex_coord.unwrap_or(p.tex_coord),
        };
        let position = self.clip_from_object * v.position.extend(1.0);
        ClipVertex { position, attributes: paint }
    }
}

/// Returns corners that have the colours of one of them, if shading is flat.
fn shaded<const N: usize>(p: &Pipeline, mut corners: [Corner; N], from: usize) -> [Corner; N] {
    if p.lighting.shade_model == ShadeModel::Flat {
        let Paint { front, back, index, .. } = corners[from].attributes;
        for corner in &mut corners {
            let tex_coord = corner.attributes.tex_coord;
            corner.attributes = Paint { front, back, index, tex_coord };
        }
    }
    corners
}

/// Draws primitives; vertices that are not finite make theirs vanish, and so do vertices too few.
pub(super) fn draw(
    p: &Pipeline,
    primitive: Primitive,
    vertices: &[CornerVertex],
    target: &mut Framebuffer,
) {
    let of = Vertices::new(p);
    let corners: Vec<Corner> = vertices.iter().map(|v| of.corner(v)).collect();
    let brush = Brush::new(p);
    match primitive {
        Primitive::Points => corners.iter().for_each(|c| dot(&brush, *c, target)),
        Primitive::Lines => {
            corners.as_chunks().0.iter().for_each(|ends| segment(&brush, *ends, target));
        }
        Primitive::LineStrip => {
            corners.windows(2).for_each(|ends| segment(&brush, [ends[0], ends[1]], target));
        }
        Primitive::Triangles => {
            for ring in corners.as_chunks::<3>().0 {
                polygon(&brush, &shaded(p, *ring, 2), target);
            }
        }
        Primitive::Polygon => {
            let Some(&first) = corners.first() else { return };
            let flat: Vec<Corner> = corners.iter().map(|c| shaded(p, [first, *c], 0)[1]).collect();
            polygon(&brush, &flat, target);
        }
    }
}

/// Returns the raster position of a vertex; `None` if it is clipped away.
pub(super) fn raster_position(
    p: &Pipeline,
    vertex: &CornerVertex,
    target: &Framebuffer,
) -> Option<RasterPosition> {
    let corner = Vertices::new(p).corner(vertex);
    let [corner, _] = clip_segment([corner, corner], &Options::default(), &mut NoTrace)?;
    let OnScreen { at, depth, paint, .. } = on_screen(p, &corner, target);
    let color = paint.front.as_vec4();
    Some(RasterPosition { at, depth, color, index: paint.index as f32, tex_coord: paint.tex_coord })
}

fn on_screen(p: &Pipeline, v: &Corner, target: &Framebuffer) -> OnScreen {
    let [x, y, w, h] = viewport(p, target).map(f64::from);
    let ndc: DVec3 = v.position.truncate() / v.position.w;
    let down = match target.origin {
        RowOrigin::TopLeft => 1.0 - ndc.y,
        RowOrigin::BottomLeft => 1.0 + ndc.y,
    };
    OnScreen {
        at: DVec2::new(x + (ndc.x + 1.0) * 0.5 * w, y + down * 0.5 * h),
        depth: p.depth_range.window(ndc.z),
        inv_w: v.position.w.recip(),
        paint: v.attributes,
    }
}

/// Returns the viewport: first column, first row, width, height.
fn viewport(p: &Pipeline, target: &Framebuffer) -> [u32; 4] {
    p.viewport.unwrap_or([0, 0, target.width(), target.height()])
}

/// Returns the pixels of the viewport.
fn window(p: &Pipeline, target: &Framebuffer) -> [i32; 4] {
    let [x, y, w, h] = viewport(p, target);
    [x, y, x.saturating_add(w), y.saturating_add(h)].map(|v| v.min(i32::MAX as u32) as i32)
}

/// Draws a point. It is clipped in clip space, by its centre, so its window is left to the side at which it ends.
fn dot(brush: &Brush, corner: Corner, target: &mut Framebuffer) {
    let p = brush.pipeline();
    let Some([v, _]) = clip_segment([corner, corner], &Options::default(), &mut NoTrace) else {
        return;
    };
    let v = on_screen(p, &v, target);
    let [x0, y0, x1, y1] = window(p, target);
    let window = Some(PixelRect::spanning(x0, y0, x1, y1));
    let options = point::Options { size: p.point_size, smooth: p.point_smooth, window };
    let Paint { front: color, index, tex_coord, .. } = v.paint;
    let look = Look { color, index, tex_coords: [tex_coord; 3] };
    let plot = |at: IVec2, area| {
        brush.put_covered(at.to_array(), v.depth, &look, area, true, target);
    };
    point::draw(v.at, &options, plot, &mut NoTrace);
}

/// Returns the pixel of a place; the border at which the viewport ends belongs to its last pixels.
fn pixel(p: &Pipeline, at: DVec2, target: &Framebuffer) -> IVec2 {
    let [_, _, x1, y1] = window(p, target);
    projected::pixel(at, DVec2::new(f64::from(x1), f64::from(y1)))
}

fn segment(brush: &Brush, ends: [Corner; 2], target: &mut Framebuffer) {
    let p = brush.pipeline();
    let [x0, y0, x1, y1] = window(p, target);
    let size = (x1 - x0).max(y1 - y0);
    let Some(cut) = projected::cut(shaded(p, ends, 1), size as u32) else { return };
    let [a, b] = [0, 1].map(|i| on_screen(p, &cut[i], target));
    let [from, to] = [a, b].map(|v| pixel(p, v.at, target));
    let way = (to - from).as_dvec2();
    let mut pixels = Vec::new();
    let options = line::Options { window: Some((IVec2::new(x0, y0), IVec2::new(x1 - 1, y1 - 1))) };
    bresenham::draw(from, to, &options, |p| pixels.push(p), &mut NoTrace);
    let length2 = way.length_squared();
    let paint = |t: f64| {
        // Linear in space: nearer ends have more weight.
        let (near, far) = (a.inv_w * (1.0 - t), b.inv_w * t);
        Interpolate::blend(&a.paint, near, &b.paint, far, near + far)
    };
    for at in pixels {
        let t = |at: IVec2| {
            if length2 > 0.0 { (at - from).as_dvec2().dot(way) / length2 } else { 0.0 }
        };
        let depth = a.depth + (b.depth - a.depth) * t(at);
        let Paint { front: color, index, tex_coord, .. } = paint(t(at));
        let beside = |step: IVec2| paint(t(at + step)).tex_coord;
        let tex_coords = [tex_coord, beside(IVec2::X), beside(IVec2::Y)];
        brush.put(at.to_array(), depth, &Look { color, index, tex_coords }, true, target);
    }
}

fn polygon(brush: &Brush, ring: &[Corner], target: &mut Framebuffer) {
    let clipped = clip_polygon(ring, &Options::default(), &mut NoTrace);
    let corners: Vec<OnScreen> =
        clipped.iter().map(|v| on_screen(brush.pipeline(), v, target)).collect();
    for k in 2..corners.len() {
        triangle(brush, [corners[0], corners[k - 1], corners[k]], target);
    }
}

fn triangle(brush: &Brush, corners: [OnScreen; 3], target: &mut Framebuffer) {
    let p = brush.pipeline();
    let points = corners.map(|c| c.at);
    let Ok(snapped) = SnappedTriangle::snap(points) else { return };
    // Counter-clockwise with y up is negative where rows count downwards.
    let front = match snapped.doubled_area() {
        0 => return,
        area => (area < 0) == (target.origin == RowOrigin::TopLeft),
    };
    if p.cull == (if front { CullFace::Front } else { CullFace::Back }) {
        return;
    }
    let [x0, y0, x1, y1] = window(p, target);
    let Ok(clip) = PixelRect::new(x0, y0, x1, y1) else { return };
    let inv_w = corners.map(|c| c.inv_w);
    let plane = |values| PerspectivePlane::through(points, inv_w, values);
    let channel = |k: usize| plane(corners.map(|c| c.paint.color(front)[k]));
    let coordinate = |k: usize| plane(corners.map(|c| c.paint.tex_coord[k]));
    let depths = corners.map(|c| c.depth);
    let (Some(depth), [Some(r), Some(g), Some(b), Some(a)], Some(index), [Some(u), Some(v)]) = (
        ScreenPlane::through(points, depths),
        [0, 1, 2, 3].map(channel),
        plane(corners.map(|c| c.paint.index)),
        [0, 1].map(coordinate),
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
            let tex_coord = |at| DVec2::new(u.at(at), v.at(at));
            let look = Look {
                color: DVec4::new(r.at(at), g.at(at), b.at(at), a.at(at)),
                index: index.at(at),
                tex_coords: [at, at + DVec2::X, at + DVec2::Y].map(tex_coord),
            };
            brush.put([x, span.y], z, &look, front, target);
        }
    });
}
