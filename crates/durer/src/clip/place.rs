//! The places in the pipeline at which triangles are clipped: before the camera transform, in clip
//! space, after the division, in the viewport, or per pixel. All five give the same picture.
//!
//! In the world each border is a plane, one dot product per vertex, and rejected vertices are never transformed. In
//! clip space the borders are the same for all cameras, additions suffice, and w may have any sign. After the division
//! borders are constants, but a triangle through the eye plane has no image, so the part on and behind that plane must
//! be cut off first, and attributes are no longer linear. In the viewport the near and the far plane have been applied,
//! and four borders of a rectangle in the plane are left. Per pixel, polygons are cut only at the eye plane: each pixel
//! is tested against the scissor rectangle ([`crate::raster`] visits no others), the mask if there is one
//! ([`crate::fragment::PixelMask`]), and the depth range of the volume.

use super::outcode::{ClipDepths, Outcode};
use super::volume::{self, ClipVertex, Interpolate, Step, cut_ring, planes_in_source};
use crate::info::{Class, Info, Occluder};
use crate::math::{DMat4, DVec3, DVec4, Plane};
use crate::trace::Tracer;

/// The facts of clipping in the world.
pub const WORLD: Info = Info {
    name: "world",
    title: "Against six planes before the camera transform",
    authors: "Ivan Sutherland, Gary Hodgman",
    year: 1974,
    source: "Reentrant Polygon Clipping, Communications of the ACM",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(vertices × planes): a dot product each",
    limits: "an affine world; convex polygons",
    pseudocode: &[
        "take the six borders back into the world by the matrix: planes n·P + c",
        "a vertex is not finite: reject, stop",
        "the ring is the face in the world",
        "for each of the six planes:",
        "    for each vertex P, Q the next:",
        "        n·P + c ≥ 0: keep P",
        "        sides differ: emit the point of PQ in the plane",
        "transform the remaining ring by the matrix",
        "divide by w",
    ],
};

/// The facts of clipping in clip space.
pub const CLIP_SPACE: Info = Info {
    name: "clip-space",
    title: "In clip space",
    authors: "James Blinn, Martin Newell",
    year: 1978,
    source: "Clipping Using Homogeneous Coordinates, SIGGRAPH",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(vertices × borders crossed): an addition each",
    limits: "convex polygons",
    pseudocode: &[
        "transform the vertices by the matrix; outcodes of −w ≤ x, y, z ≤ w",
        "AND of the outcodes ≠ 0: reject, stop",
        "OR of the outcodes = 0: accept, stop",
        "for each border that some vertex lies beyond:",
        "    for each vertex P, Q the next, by boundary coordinates d:",
        "        d(P) ≥ 0: keep P",
        "        signs differ: emit the point at t = d(P) / (d(P) − d(Q))",
        "drop vertices with w ≤ 0",
        "divide by w",
    ],
};

/// The facts of clipping after the division.
pub const AFTER_DIVISION: Info = Info {
    name: "after-division",
    title: "After the division, the eye plane removed first",
    authors: "William Newman, Robert Sproull",
    year: 1973,
    source: "Principles of Interactive Computer Graphics",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(vertices × borders): a comparison each, and one more border for the eye plane",
    limits: "convex polygons; loses digits for triangles that reach behind the eye",
    pseudocode: &[
        "transform the vertices by the matrix",
        "a vertex is not finite: reject, stop",
        "borders: first w ≥ a small number, for the division; divide by w",
        "then for each border −1 ≤ x, y, z ≤ 1:",
        "    for each vertex P, Q the next:",
        "        P inside: keep P",
        "        sides differ: emit the point of PQ on the border",
        "attributes are linear only divided by w",
    ],
};

/// The facts of clipping in the viewport.
pub const VIEWPORT: Info = Info {
    name: "viewport",
    title: "In the viewport, in two dimensions",
    authors: "Ivan Sutherland, Gary Hodgman",
    year: 1974,
    source: "Reentrant Polygon Clipping, Communications of the ACM",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(vertices × 4 borders) after two borders in clip space",
    limits: "convex polygons; near and far plane must have been cut before",
    pseudocode: &[
        "transform the vertices by the matrix",
        "a vertex is not finite: reject, stop",
        "borders: near and far in clip space; divide by w",
        "then for each border of the viewport: left, right, bottom, top:",
        "    for each vertex P, Q the next:",
        "        P inside: keep P",
        "        sides differ: emit the point of PQ on the border",
        "attributes are linear only divided by w",
    ],
};

/// The facts of clipping per pixel.
pub const PER_PIXEL: Info = Info {
    name: "per-pixel",
    title: "Per pixel: scissor, masks and depth range",
    authors: "Mark Segal, Kurt Akeley",
    year: 1992,
    source: "The OpenGL Graphics System: A Specification",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(pixels covered), in the window or not, unless the rasterizer walks the window only",
    limits: "coordinates must fit the rasterizer's guard band",
    pseudocode: &[
        "transform the vertices by the matrix",
        "a vertex is not finite: reject, stop",
        "clip at the eye plane only",
        "for the border w ≥ a small number:",
        "    for each vertex P, Q the next:",
        "        P inside: keep P",
        "        sides differ: emit the point of PQ on the border",
        "divide by w; rasterize",
        "each pixel: within scissor and mask, depth within the volume?",
    ],
};

crate::info::family! {
    /// Place of clipping.
    pub enum ClipPlace {
        /// Before the camera transform, against six planes.
        World => WORLD,
        /// Clip space.
        ClipSpace => CLIP_SPACE,
        /// After the division; points in and behind the eye plane are removed before it.
        AfterDivision => AFTER_DIVISION,
        /// The viewport: near and far in clip space, the other four borders in two dimensions.
        Viewport => VIEWPORT,
        /// Per pixel: polygons are cut only at the eye plane, so the ring may reach beyond all borders.
        PerPixel => PER_PIXEL,
    }
}

/// A vertex after the division.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NdcVertex<A = ()> {
    /// Normalized device coordinates: −1 … 1 on each axis, or z in 0 … 1.
    pub position: DVec3,
    /// 1/w, positive; linear on the screen.
    pub inv_w: f64,
    /// Linear in space.
    pub attributes: A,
}

/// The border of [`ClipPlace::AfterDivision`] before the others: w ≥ a little.
pub const EYE: Outcode = Outcode(64);

/// Clips a convex polygon of world-space points with attributes and takes it to normalized device
/// coordinates; winding is kept. Returns at least three vertices, or none.
///
/// The result of [`ClipPlace::PerPixel`] has yet to be clipped, when its pixels are drawn.
///
/// ```
/// use durer::clip::outcode::ClipDepths;
/// use durer::clip::place::{ClipPlace, clip};
/// use durer::math::{DMat4, DVec3};
/// use durer::trace::NoTrace;
/// let triangle = [DVec3::ZERO, DVec3::X * 3.0, DVec3::Y].map(|p| (p, ()));
/// for &place in ClipPlace::ALL {
///     let depth = ClipDepths::NegativeOneToOne;
///     let vertices = clip(place, &triangle, &DMat4::IDENTITY, depth, &mut NoTrace).len();
///     assert_eq!(vertices, if place == ClipPlace::PerPixel { 3 } else { 4 });
/// }
/// ```
pub fn clip<A: Interpolate>(
    place: ClipPlace,
    polygon: &[(DVec3, A)],
    clip_from_world: &DMat4,
    depth: ClipDepths,
    t: &mut impl Tracer<Step<A>>,
) -> Vec<NdcVertex<A>> {
    let transformed = |(p, a): &(DVec3, A)| ClipVertex {
        position: *clip_from_world * p.extend(1.0),
        attributes: a.clone(),
    };
    match place {
        ClipPlace::World => {
            let inside = in_world(polygon, &planes_in_source(clip_from_world, depth), t);
            divided(inside.iter().map(transformed))
        }
        ClipPlace::ClipSpace => {
            let ring: Vec<_> = polygon.iter().map(transformed).collect();
            let options = volume::Options { depth, ..Default::default() };
            divided(volume::clip_polygon(&ring, &options, t).into_iter())
        }
        ClipPlace::AfterDivision => {
            let ring: Vec<_> = polygon.iter().map(transformed).collect();
            let before = before_eye(&ring, nearest_w(clip_from_world, depth) * 0.5, t);
            in_ndc(divided(before.into_iter()), depth, ALL_BORDERS, t)
        }
        ClipPlace::Viewport => {
            let ring: Vec<_> = polygon.iter().map(transformed).collect();
            let between = between_near_and_far(&ring, depth, t);
            in_ndc(divided(between.into_iter()), depth, SIDES, t)
        }
        ClipPlace::PerPixel => {
            let ring: Vec<_> = polygon.iter().map(transformed).collect();
            let before = before_eye(&ring, nearest_w(clip_from_world, depth) * 0.5, t);
            divided(before.into_iter())
        }
    }
}

/// Indices into [`Outcode::BORDERS`]: left, right, bottom and top, the borders of the viewport.
const SIDES: std::ops::Range<usize> = 0..4;
/// Near and far.
const DEPTHS: std::ops::Range<usize> = 4..6;
const ALL_BORDERS: std::ops::Range<usize> = 0..6;

/// Clips to the near and the far plane, in clip space.
fn between_near_and_far<A: Interpolate>(
    ring: &[ClipVertex<A>],
    depth: ClipDepths,
    t: &mut impl Tracer<Step<A>>,
) -> Vec<ClipVertex<A>> {
    if ring.iter().any(|v| !v.position.is_finite()) {
        t.step(|| Step::Rejected);
        return Vec::new();
    }
    let mut ring = ring.to_vec();
    for k in DEPTHS {
        let distance = |v: &ClipVertex<A>| volume::boundary_coordinates(v.position, depth)[k];
        let cut = |[i, o]: [&ClipVertex<A>; 2], [d_in, d_out]: [f64; 2]| {
            let total = d_in - d_out;
            ClipVertex {
                position: Interpolate::blend(&i.position, -d_out, &o.position, d_in, total),
                attributes: A::blend(&i.attributes, -d_out, &o.attributes, d_in, total),
            }
        };
        ring = cut_ring(&ring, Outcode::BORDERS[k], distance, cut, ClipVertex::parts, t);
    }
    ring
}

/// Divides by w; a ring with a vertex that has no place is left out.
fn divided<A: Interpolate>(ring: impl Iterator<Item = ClipVertex<A>>) -> Vec<NdcVertex<A>> {
    let mut divided = Vec::new();
    for v in ring {
        let inv_w = v.position.w.recip();
        let position = v.position.truncate() / v.position.w;
        if !(inv_w > 0.0 && inv_w.is_finite() && position.is_finite()) {
            return Vec::new();
        }
        divided.push(NdcVertex { position, inv_w, attributes: v.attributes });
    }
    if divided.len() < 3 { Vec::new() } else { divided }
}

fn in_world<A: Interpolate>(
    polygon: &[(DVec3, A)],
    planes: &[Plane; 6],
    t: &mut impl Tracer<Step<A>>,
) -> Vec<(DVec3, A)> {
    if polygon.iter().any(|(p, _)| !p.is_finite()) {
        t.step(|| Step::Rejected);
        return Vec::new();
    }
    let mut ring = polygon.to_vec();
    for (plane, border) in planes.iter().zip(Outcode::BORDERS) {
        let distance = |v: &(DVec3, A)| plane.evaluate(v.0);
        let cut = |[i, o]: [&(DVec3, A); 2], [d_in, d_out]: [f64; 2]| {
            Interpolate::blend(i, -d_out, o, d_in, d_in - d_out)
        };
        ring = cut_ring(&ring, border, distance, cut, |v| (v.0.extend(1.0), v.1.clone()), t);
    }
    ring
}

/// Returns the smallest w of a point in the view volume: half of it is a safe distance for the eye plane, far enough
/// from the eye for the division to keep the digits of visible points.
fn nearest_w(clip_from_world: &DMat4, depth: ClipDepths) -> f64 {
    let world_from_clip = clip_from_world.inverse();
    let near = if depth == ClipDepths::ZeroToOne { 0.0 } else { -1.0 };
    let corners = (0..8).map(|i| {
        let pick = |bit: i32, lo: f64| if i >> bit & 1 == 1 { 1.0 } else { lo };
        // The world point of a corner has w = 1; its w in clip space is that of the corner inverted.
        (world_from_clip * DVec4::new(pick(0, -1.0), pick(1, -1.0), pick(2, near), 1.0)).w.recip()
    });
    let smallest = corners.filter(|w| w.is_finite() && *w > 0.0).fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { smallest } else { f64::MIN_POSITIVE }
}

fn before_eye<A: Interpolate>(
    ring: &[ClipVertex<A>],
    smallest_w: f64,
    t: &mut impl Tracer<Step<A>>,
) -> Vec<ClipVertex<A>> {
    if ring.iter().any(|v| !v.position.is_finite()) {
        t.step(|| Step::Rejected);
        return Vec::new();
    }
    let cut = |[i, o]: [&ClipVertex<A>; 2], [d_in, d_out]: [f64; 2]| {
        let total = d_in - d_out;
        let mut position = Interpolate::blend(&i.position, -d_out, &o.position, d_in, total);
        position.w = smallest_w;
        let attributes = A::blend(&i.attributes, -d_out, &o.attributes, d_in, total);
        ClipVertex { position, attributes }
    };
    cut_ring(ring, EYE, |v| v.position.w - smallest_w, cut, ClipVertex::parts, t)
}

fn in_ndc<A: Interpolate>(
    mut ring: Vec<NdcVertex<A>>,
    depth: ClipDepths,
    borders: std::ops::Range<usize>,
    t: &mut impl Tracer<Step<A>>,
) -> Vec<NdcVertex<A>> {
    for k in borders {
        let border = Outcode::BORDERS[k];
        let distance =
            |v: &NdcVertex<A>| volume::boundary_coordinates(v.position.extend(1.0), depth)[k];
        let parts = |v: &NdcVertex<A>| (v.position.extend(1.0), v.attributes.clone());
        ring = cut_ring(&ring, border, distance, cut_ndc, parts, t);
    }
    if ring.len() < 3 { Vec::new() } else { ring }
}

/// Computes the point at which an edge meets a border, after the division: position and 1/w are linear there, and
/// attributes are weighted by 1/w of their ends.
fn cut_ndc<A: Interpolate>([i, o]: [&NdcVertex<A>; 2], [d_in, d_out]: [f64; 2]) -> NdcVertex<A> {
    let total = d_in - d_out;
    let (wi, wo) = (-d_out * i.inv_w, d_in * o.inv_w);
    NdcVertex {
        position: Interpolate::blend(&i.position, -d_out, &o.position, d_in, total),
        inv_w: Interpolate::blend(&i.inv_w, -d_out, &o.inv_w, d_in, total),
        attributes: A::blend(&i.attributes, wi, &o.attributes, wo, wi + wo),
    }
}
