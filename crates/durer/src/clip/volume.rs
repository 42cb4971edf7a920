//! Clipping in homogeneous coordinates against −w ≤ x, y, z ≤ w.
//!
//! James Blinn and Martin Newell, *Clipping Using Homogeneous Coordinates*, SIGGRAPH 1978; polygons
//! border by border as in Ivan Sutherland and Gary Hodgman, *Reentrant Polygon Clipping*, CACM 1974.
//! Object space. A point has six boundary coordinates d₁ … d₆, each ≥ 0 inside one border; between an
//! inside and an outside point the border is met at (d_in · p_out − d_out · p_in) / (d_in − d_out).
//! Nothing is divided by w, so w may be anything: points behind, in and before the eye plane.
//!
//! This form is monotonic in floating point: a border that both ends satisfy, a new vertex satisfies exactly. So results are in
//! the volume without tolerance, clipping twice changes nothing, and because the inside point always comes first, both
//! directions of an edge give the same bits.

use super::outcode::{ClipDepths, Outcode};
use crate::info::{Class, Info, Occluder};
use crate::math::{DMat4, DVec2, DVec3, DVec4, Plane};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "homogeneous-volume",
    title: "Homogeneous clipping",
    authors: "James Blinn, Martin Newell",
    year: 1978,
    source: "Clipping Using Homogeneous Coordinates, SIGGRAPH",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(vertices × borders crossed) time, O(vertices) memory",
    limits: "convex polygons; a concave one may get bridging edges along the border. Polygons with a \
             coordinate that is not finite or beyond 10^150 are left out",
    pseudocode: &[
        "for each vertex: its boundary coordinates d1 … d6, and the outcode of their signs",
        "AND of the outcodes ≠ 0, or nothing is left in the end: reject, stop",
        "OR of the outcodes = 0: accept, stop",
        "for each border that some vertex lies beyond:",
        "    for each vertex P of the ring, Q the next, by their d:",
        "        d(P) ≥ 0: keep P",
        "        signs differ: emit P + t·(Q − P) with t = d(P) / (d(P) − d(Q)), from the inside end",
        "drop vertices with w ≤ 0",
        "divide x, y, z by w",
    ],
};

/// The facts of what new vertices get: the same algorithm, with values beside the positions.
pub const ATTRIBUTES: Info = Info {
    name: "clip-attributes",
    title: "Attributes at new vertices",
    authors: "P. S. Heckbert",
    year: 1990,
    source: "Generic convex polygon scan conversion and clipping, in Graphics Gems",
    cost: "O(vertices × borders crossed), a mix of each value per new vertex",
    limits: "values that are linear in space: colours, texture coordinates, normals before they are made unit length",
    pseudocode: &[
        "for each vertex: its values, d1 … d6, and the outcode of their signs",
        "AND of the outcodes ≠ 0, or nothing is left in the end: reject, stop",
        "OR of the outcodes = 0: accept, stop",
        "for each border that some vertex lies beyond:",
        "    for each vertex P of the ring, Q the next, by their d:",
        "        d(P) ≥ 0: keep P with its values",
        "        signs differ: t ← d(P) / (d(P) − d(Q)); x, y, z, w and each value: P + t·(Q − P)",
        "drop vertices with w ≤ 0",
        "divide x, y, z by w; the values stay as they are, and 1/w is kept for the pixels",
        "// on the screen the new vertex is s = t·w(Q) / ((1 − t)·w(P) + t·w(Q)) of the way:",
        "// values that are mixed there by s are wrong, unless w(P) = w(Q)",
    ],
    ..INFO
};

/// Coordinates beyond this are left out: products of two must stay finite.
const COORDINATE_LIMIT: f64 = 1e150;

/// Options: the borders to clip to, and the place of the near plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// −w … w or 0 … w.
    pub depth: ClipDepths,
    /// All six borders, or only the near plane.
    pub borders: Borders,
}

/// The borders that are cut.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Borders {
    /// All six.
    #[default]
    All,
    /// The near plane; and the four sides only for triangles that reach beyond the guard band −g·w ≤ x, y ≤ g·w, as
    /// graphics hardware does. The rasterizer's own clip does the rest, and the depth test must discard fragments
    /// beyond the far plane.
    NearOnly {
        /// g, above 1; a power of two keeps results exactly inside. Half the rasterizer's range
        /// divided by half the viewport's width is right; more overflows its coordinates, less
        /// cuts more polygons than need be.
        guard_band: f64,
    },
    /// The near and the far plane, and the four sides as above: for lines, whose remaining part is drawn as part of the
    /// whole line.
    Depths {
        /// Guard band, as above.
        guard_band: f64,
    },
}

/// Anything that can be interpolated along an edge: attributes of vertices.
pub trait Interpolate: Clone {
    /// Returns (a · wa + b · wb) / total, component by component; the weights are not negative.
    fn blend(a: &Self, wa: f64, b: &Self, wb: f64, total: f64) -> Self;
}

impl Interpolate for () {
    fn blend((): &Self, _: f64, (): &Self, _: f64, _: f64) -> Self {}
}

macro_rules! blend_arithmetic {
    ($($type:ty),+) => {
        $(impl Interpolate for $type {
            #[inline]
            fn blend(a: &Self, wa: f64, b: &Self, wb: f64, total: f64) -> Self {
                (*a * wa + *b * wb) / total
            }
        })+
    };
}
blend_arithmetic!(f64, DVec2, DVec3, DVec4);

impl<T: Interpolate, const N: usize> Interpolate for [T; N] {
    fn blend(a: &Self, wa: f64, b: &Self, wb: f64, total: f64) -> Self {
        std::array::from_fn(|k| T::blend(&a[k], wa, &b[k], wb, total))
    }
}

impl<A: Interpolate, B: Interpolate> Interpolate for (A, B) {
    fn blend(a: &Self, wa: f64, b: &Self, wb: f64, total: f64) -> Self {
        (A::blend(&a.0, wa, &b.0, wb, total), B::blend(&a.1, wa, &b.1, wb, total))
    }
}

/// A vertex before the division, with the values to interpolate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipVertex<A = ()> {
    /// Clip space, homogeneous.
    pub position: DVec4,
    /// Linear in space.
    pub attributes: A,
}

impl<A: Clone> ClipVertex<A> {
    /// Returns the position and the attributes.
    pub(crate) fn parts(&self) -> (DVec4, A) {
        (self.position, self.attributes.clone())
    }
}

/// Step of the algorithm, with the attributes of new vertices. Vertex numbers refer to the ring at the start of a
/// border's turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step<A = ()> {
    /// Outcode of a vertex.
    Code {
        /// Its number in the input.
        vertex: usize,
        /// Borders beyond which it is.
        code: Outcode,
        /// Its boundary coordinates d₁ … d₆, see [`boundary_coordinates`].
        distances: [f64; 6],
    },
    /// All vertices lie beyond one border, or one is not finite, or fewer than three are left:
    /// the result is empty.
    Rejected,
    /// Nothing has to be cut: the input is the output.
    Accepted,
    /// A border's turn; the next steps list the new ring.
    Border(Outcode),
    /// An inside vertex is kept.
    Keep {
        /// Number of the vertex.
        vertex: usize,
    },
    /// An edge meets the border.
    Cut {
        /// The number of its inside end.
        inside: usize,
        /// The number of its outside end.
        outside: usize,
        /// The boundary coordinates of both: of the inside end, ≥ 0, and of the outside end, < 0.
        distances: [f64; 2],
        /// The new vertex.
        position: DVec4,
        /// Its attributes, mixed by the same t as its position.
        attributes: A,
    },
    /// Vertices without a place, w ≤ 0, were dropped from the result.
    Dropped,
}

impl<A> PseudocodeLine for Step<A> {
    /// Returns the line of the pseudocode that runs, counted from 1: of [`INFO`], of [`ATTRIBUTES`], and of all places
    /// of [`super::place`].
    fn line(&self) -> usize {
        match self {
            Self::Code { .. } => 1,
            Self::Rejected => 2,
            Self::Accepted => 3,
            Self::Border(_) => 4,
            Self::Keep { .. } => 6,
            Self::Cut { .. } => 7,
            Self::Dropped => 8,
        }
    }
}

/// Returns the six distances from the borders in the order of [`Outcode::BORDERS`]; ≥ 0 is inside.
/// Their signs are exact, and no positive factor of p changes them.
pub fn boundary_coordinates(p: DVec4, depth: ClipDepths) -> [f64; 6] {
    Options { depth, ..Options::default() }.distances(p)
}

/// Returns the six borders as planes of the space that `clip_from_source` starts from, normals
/// inward, in the order of [`Outcode::BORDERS`].
///
/// The matrix may hold a perspective; its source space is affine (w = 1).
pub fn planes_in_source(clip_from_source: &DMat4, depth: ClipDepths) -> [Plane; 6] {
    let rows = clip_from_source.transpose();
    let [x, y, z, w] = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
    let near = match depth {
        ClipDepths::NegativeOneToOne => w + z,
        ClipDepths::ZeroToOne => z,
    };
    [w + x, w - x, w + y, w - y, near, w - z]
        .map(|row| Plane { normal: row.truncate(), distance: row.w })
}

impl Options {
    /// Returns the extent of the four sides in units of w.
    fn side(&self) -> f64 {
        match self.borders {
            Borders::All => 1.0,
            Borders::NearOnly { guard_band } | Borders::Depths { guard_band } => {
                guard_band.max(1.0)
            }
        }
    }

    fn distances(&self, p: DVec4) -> [f64; 6] {
        let side = self.side() * p.w;
        let near = match self.depth {
            ClipDepths::NegativeOneToOne => p.w + p.z,
            ClipDepths::ZeroToOne => p.z,
        };
        [side + p.x, side - p.x, side + p.y, side - p.y, near, p.w - p.z]
    }

    /// Returns the borders to be cut that p lies beyond.
    fn code(&self, p: DVec4) -> Outcode {
        let code = Outcode::from_inside(self.distances(p).map(|d| d >= 0.0));
        match self.borders {
            Borders::All | Borders::Depths { .. } => code,
            // Straight ahead at infinity (w = 0) there is no place on the screen: cut that off.
            Borders::NearOnly { .. } if p.w <= 0.0 => code,
            Borders::NearOnly { .. } => code & Outcode(!Outcode::FAR.0),
        }
    }

    /// Puts a new vertex exactly on its border, where rounding left it beside.
    fn place(&self, border: usize, p: &mut DVec4) {
        let side = self.side() * p.w;
        match border {
            0 => p.x = -side,
            1 => p.x = side,
            2 => p.y = -side,
            3 => p.y = side,
            4 if self.depth == ClipDepths::ZeroToOne => p.z = 0.0,
            4 => p.z = -p.w,
            _ => p.z = p.w,
        }
    }

    /// Computes the point at which an edge meets a border; `d_in ≥ 0 > d_out`.
    fn cut<A: Interpolate>(
        &self,
        border: usize,
        [inside, outside]: [&ClipVertex<A>; 2],
        [d_in, d_out]: [f64; 2],
    ) -> ClipVertex<A> {
        if d_in == 0.0 {
            return inside.clone();
        }
        let total = d_in - d_out;
        let (i, o) = (&inside.position, &outside.position);
        let mut position = Interpolate::blend(i, -d_out, o, d_in, total);
        self.place(border, &mut position);
        let attributes = A::blend(&inside.attributes, -d_out, &outside.attributes, d_in, total);
        ClipVertex { position, attributes }
    }
}

/// Returns the borders to clip against: those that some vertex is beyond. `None` rejects all.
fn needed<A>(
    vertices: &[ClipVertex<A>],
    options: &Options,
    t: &mut impl Tracer<Step<A>>,
) -> Option<Outcode> {
    let (mut any, mut all) = (Outcode::INSIDE, Outcode(u8::MAX));
    let mut sound = !vertices.is_empty();
    for (vertex, p) in vertices.iter().map(|v| v.position).enumerate() {
        let code = Outcode::of_homogeneous(p, options.depth);
        t.step(|| Step::Code { vertex, code, distances: boundary_coordinates(p, options.depth) });
        all &= code;
        any |= options.code(p);
        sound &= p.abs().cmple(DVec4::splat(COORDINATE_LIMIT)).all();
    }
    if !sound || !all.is_inside() {
        t.step(|| Step::Rejected);
        return None;
    }
    if any.is_inside() {
        t.step(|| Step::Accepted);
    }
    Some(any)
}

/// Clips a segment; both ends are returned in their order, those inside bit for bit.
///
/// A segment that touches the volume in one point is returned with two equal ends. One that ends in
/// the null vector, which is not a point, is left out.
pub fn clip_segment<A: Interpolate>(
    segment: [ClipVertex<A>; 2],
    options: &Options,
    t: &mut impl Tracer<Step<A>>,
) -> Option<[ClipVertex<A>; 2]> {
    let borders = needed(&segment, options, t)?;
    let mut ends = segment;
    for (k, &border) in Outcode::BORDERS.iter().enumerate() {
        if !borders.contains(border) {
            continue;
        }
        t.step(|| Step::Border(border));
        let d = [0, 1].map(|i: usize| options.distances(ends[i].position)[k]);
        if d[0] < 0.0 && d[1] < 0.0 {
            t.step(|| Step::Rejected);
            return None;
        }
        let outside = (0..2).find(|&i| d[i] < 0.0);
        let new = outside.map(|o| options.cut(k, [&ends[1 - o], &ends[o]], [d[1 - o], d[o]]));
        for vertex in 0..2 {
            t.step(|| match &new {
                Some(v) if outside == Some(vertex) => {
                    let (inside, outside) = (1 - vertex, vertex);
                    let distances = [d[inside], d[outside]];
                    let (position, attributes) = v.parts();
                    Step::Cut { inside, outside, distances, position, attributes }
                }
                _ => Step::Keep { vertex },
            });
        }
        if let (Some(o), Some(new)) = (outside, new) {
            ends[o] = new;
        }
    }
    if unseen(&ends, options) || ends.iter().any(|v| v.position.w <= 0.0) {
        t.step(|| Step::Rejected);
        return None;
    }
    Some(ends)
}

/// Clips a convex polygon, given as a ring of vertices of either winding, which is kept.
///
/// Returns at least three vertices, or none. All have w > 0 and lie in the volume exactly.
///
/// ```
/// use durer::clip::volume::{ClipVertex, Options, clip_polygon};
/// use durer::math::DVec4;
/// use durer::trace::NoTrace;
/// // One corner lies behind the eye.
/// let corners = [(0.0, 0.0, 0.0, 1.0), (0.5, 0.0, 0.0, 1.0), (0.0, 3.0, -3.0, -2.0)];
/// let ring = corners.map(|p| ClipVertex { position: DVec4::from(p), attributes: () });
/// assert_eq!(clip_polygon(&ring, &Options::default(), &mut NoTrace).len(), 4);
/// ```
pub fn clip_polygon<A: Interpolate>(
    ring: &[ClipVertex<A>],
    options: &Options,
    t: &mut impl Tracer<Step<A>>,
) -> Vec<ClipVertex<A>> {
    let mut ring = ring.to_vec();
    clip_ring(&mut ring, &mut Vec::new(), options, t);
    ring
}

/// Clips triangles one by one and appends the triangles of each result to `out`: triangles wholly inside unchanged,
/// polygons as fans from their first vertex.
///
/// The same as [`clip_polygon`] for each, without taking memory for each: triangles that are wholly inside or outside
/// take a few nanoseconds.
///
/// ```
/// use durer::clip::volume::{ClipVertex, Options, clip_triangles};
/// use durer::math::DVec4;
/// // One corner lies behind the eye: the quadrilateral that is left makes two triangles.
/// let corners = [(0.0, 0.0, 0.0, 1.0), (0.5, 0.0, 0.0, 1.0), (0.0, 3.0, -3.0, -2.0)];
/// let triangle = corners.map(|p| ClipVertex { position: DVec4::from(p), attributes: () });
/// let mut out = Vec::new();
/// clip_triangles(&[triangle], &Options::default(), &mut out);
/// assert_eq!(out.len(), 2);
/// ```
pub fn clip_triangles<A: Interpolate + Copy>(
    triangles: &[[ClipVertex<A>; 3]],
    options: &Options,
    out: &mut Vec<[ClipVertex<A>; 3]>,
) {
    let (mut ring, mut spare) = (Vec::new(), Vec::new());
    for triangle in triangles {
        let codes = triangle.map(|v| Outcode::of_homogeneous(v.position, options.depth));
        if !(codes[0] & codes[1] & codes[2]).is_inside() {
            continue;
        }
        let placed = |v: &ClipVertex<A>| v.position.w > 0.0 && v.position.w <= COORDINATE_LIMIT;
        if (codes[0] | codes[1] | codes[2]).is_inside() && triangle.iter().all(placed) {
            out.push(*triangle);
            continue;
        }
        ring.clear();
        ring.extend_from_slice(triangle);
        clip_ring(&mut ring, &mut spare, options, &mut NoTrace);
        if let Some((first, rest)) = ring.split_first() {
            out.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
        }
    }
}

/// Clips a ring in place, or empties it; `spare` is room to work.
fn clip_ring<A: Interpolate>(
    ring: &mut Vec<ClipVertex<A>>,
    spare: &mut Vec<ClipVertex<A>>,
    options: &Options,
    t: &mut impl Tracer<Step<A>>,
) {
    let Some(borders) = needed(ring, options, t) else { return ring.clear() };
    for (k, &border) in Outcode::BORDERS.iter().enumerate() {
        if borders.contains(border) {
            let distance = |v: &ClipVertex<A>| options.distances(v.position)[k];
            let cut = |ends: [&ClipVertex<A>; 2], d: [f64; 2]| options.cut(k, ends, d);
            cut_into(ring, spare, border, distance, cut, ClipVertex::parts, t);
            std::mem::swap(ring, spare);
        }
    }
    if ring.iter().any(|v| v.position.w <= 0.0) {
        // Only a polygon through the eye itself has such points: they have no place on a screen.
        t.step(|| Step::Dropped);
        ring.retain(|v| v.position.w > 0.0);
    }
    if ring.len() < 3 || unseen(ring, options) {
        t.step(|| Step::Rejected);
        ring.clear();
    }
}

/// Returns whether the whole remaining polygon is in the guard band beyond one border.
fn unseen<A>(vertices: &[ClipVertex<A>], options: &Options) -> bool {
    let codes = vertices.iter().map(|v| Outcode::of_homogeneous(v.position, options.depth));
    !codes.fold(Outcode(u8::MAX), |all, code| all & code).is_inside()
}

/// Returns one border of the Sutherland–Hodgman method: the part of a ring with `distance ≥ 0`.
///
/// `cut` receives the inside end and the outside end of an edge with their distances; `parts` returns the position and
/// the attributes of a new vertex for the steps.
pub(super) fn cut_ring<V: Clone, A>(
    ring: &[V],
    border: Outcode,
    distance: impl Fn(&V) -> f64,
    cut: impl Fn([&V; 2], [f64; 2]) -> V,
    parts: impl Fn(&V) -> (DVec4, A),
    t: &mut impl Tracer<Step<A>>,
) -> Vec<V> {
    let mut kept = Vec::with_capacity(ring.len() + 1);
    cut_into(ring, &mut kept, border, distance, cut, parts, t);
    kept
}

/// Cuts a ring as [`cut_ring`] does, into existing memory.
fn cut_into<V: Clone, A>(
    ring: &[V],
    kept: &mut Vec<V>,
    border: Outcode,
    distance: impl Fn(&V) -> f64,
    cut: impl Fn([&V; 2], [f64; 2]) -> V,
    parts: impl Fn(&V) -> (DVec4, A),
    t: &mut impl Tracer<Step<A>>,
) {
    t.step(|| Step::Border(border));
    kept.clear();
    let Some(first) = ring.first().map(&distance) else { return };
    let mut d = first;
    for (i, vertex) in ring.iter().enumerate() {
        if d >= 0.0 {
            t.step(|| Step::Keep { vertex: i });
            kept.push(vertex.clone());
        }
        let (next, d_next) =
            if i + 1 == ring.len() { (0, first) } else { (i + 1, distance(&ring[i + 1])) };
        let (inside, outside, ends) =
            if d >= 0.0 { (i, next, [d, d_next]) } else { (next, i, [d_next, d]) };
        // An inside end on the border is kept as it is: a cut there would double it.
        if ends[0] > 0.0 && ends[1] < 0.0 {
            let new = cut([&ring[inside], &ring[outside]], ends);
            t.step(|| {
                let (position, attributes) = parts(&new);
                Step::Cut { inside, outside, distances: ends, position, attributes }
            });
            kept.push(new);
        }
        d = d_next;
    }
}
