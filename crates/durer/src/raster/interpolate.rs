//! Interpolation: barycentric coordinates, areas, perspective-correct attributes, depth planes.
//!
//! Barycentric coordinates: August Ferdinand Möbius, *Der barycentrische Calcul*, 1827.
//! Perspective-correct interpolation: James Blinn, *Hyperbolic Interpolation*, IEEE CG&A, 1992; Paul
//! Heckbert and Henry Moreton, *Interpolation for Polygon Texture Mapping and Shading*, 1991.

pub mod rows;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::{DVec2, DVec3};
use std::ops::{Add, Mul};

/// The facts of barycentric coordinates.
pub const BARYCENTRIC: Info = Info {
    name: "barycentric",
    title: "Barycentric coordinates",
    authors: "A. F. Möbius",
    year: 1827,
    source: "Der barycentrische Calcul",
    class: Class::ObjectSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(1)",
    limits: "triangles with an area",
    pseudocode: &[
        "d ← (B − A) × (C − A), twice the area of ABC",
        "d = 0: the triangle has no area, stop",
        "for each corner:",
        "    the triangle of P and the opposite side: (B − P) × (C − P) for A",
        "    its weight ← this area / d",
        "// the weights add up to 1",
        "P = λ_A A + λ_B B + λ_C C; a value of the corners likewise",
        "P is in the triangle if no weight is negative",
    ],
};

/// The facts of perspective-correct interpolation.
pub const INFO: Info = Info {
    name: "perspective-correct",
    title: "Perspective-correct interpolation",
    authors: "P. S. Heckbert, H. P. Moreton",
    year: 1991,
    source: "Interpolation for polygon texture mapping and shading, in State of the Art in Computer Graphics",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[Coherence::Face],
    cost: "O(1), one division",
    limits: "vertices in front of the eye",
    pseudocode: &[
        "for each corner: keep 1/w and value/w",
        "// both are linear on the screen, the value itself is not",
        "for each row that the triangle covers:",
        "    along its two edges: 1/w and value/w, linear in y",
        "    for each pixel between them:",
        "        1/w and value/w, linear in x; value ← (value/w) / (1/w)",
        "        set the pixel to the value",
        "// with w = 1 everywhere this is linear interpolation",
    ],
};

/// Returns twice the signed area of a triangle by the short formula, in square units of its
/// coordinates; positive where a, b, c turn to the left with y up.
pub fn doubled_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns the area of a triangle in space, in square units of its coordinates; not negative.
pub fn area_3d([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length() * 0.5
}

/// Returns the signed area of a polygon by the short formula, A = ½ Σ xᵢ (yᵢ₊₁ − yᵢ₋₁); positive where it turns to the
/// left with y up. The ring is closed implicitly. Coordinates are relative to the first vertex, so that a small polygon
/// far from the origin keeps its area.
///
/// ```
/// use durer::math::DVec2;
/// let square = [(1e9, 0.0), (1e9 + 1.0, 0.0), (1e9 + 1.0, 1.0), (1e9, 1.0)].map(DVec2::from);
/// assert_eq!(durer::raster::interpolate::polygon_area(&square), 1.0);
/// ```
pub fn polygon_area(ring: &[DVec2]) -> f64 {
    let n = ring.len();
    let Some(&origin) = ring.first() else { return 0.0 };
    let term = |(i, p): (usize, &DVec2)| {
        (p.x - origin.x) * (ring[(i + 1) % n].y - ring[(i + n - 1) % n].y)
    };
    0.5 * ring.iter().enumerate().map(term).sum::<f64>()
}

/// Returns the barycentric coordinates of a point of the plane: weights that add up to 1 and give
/// the point.
///
/// All are in 0 … 1 for a point in the triangle. `None` for a triangle without area.
pub fn barycentric_2d([a, b, c]: [DVec2; 3], p: DVec2) -> Option<[f64; 3]> {
    let area = doubled_area([a, b, c]);
    let weights = [doubled_area([p, b, c]), doubled_area([p, c, a]), doubled_area([p, a, b])];
    normalized(weights, area)
}

/// Returns the barycentric coordinates of a point in space, projected along the normal onto the
/// triangle's plane. `None` for a triangle without area.
pub fn barycentric_3d([a, b, c]: [DVec3; 3], p: DVec3) -> Option<[f64; 3]> {
    let normal = (b - a).cross(c - a);
    // Areas of the three parts, as seen along the normal.
    let part = |u: DVec3, v: DVec3| normal.dot((u - p).cross(v - p));
    normalized([part(b, c), part(c, a), part(a, b)], normal.length_squared())
}

fn normalized(weights: [f64; 3], total: f64) -> Option<[f64; 3]> {
    (total != 0.0 && total.is_finite()).then(|| weights.map(|w| w / total))
}

/// Returns the weighted sum of a value at the corners.
pub fn blend<T: Mul<f64, Output = T> + Add<Output = T>>(weights: [f64; 3], [a, b, c]: [T; 3]) -> T {
    a * weights[0] + b * weights[1] + c * weights[2]
}

/// Converts weights on the screen to weights in space: each is scaled by the nearness of its corner.
///
/// `inv_w` is 1/w of the corners, positive. Weights that add up to 1 give weights that add up to 1.
///
/// ```
/// use durer::raster::interpolate::perspective_correct;
/// // Half way on the screen from a near point to one three times as far is a quarter of the way.
/// assert_eq!(perspective_correct([0.5, 0.5, 0.0], [1.0, 1.0 / 3.0, 1.0]), [0.75, 0.25, 0.0]);
/// ```
pub fn perspective_correct(screen: [f64; 3], inv_w: [f64; 3]) -> [f64; 3] {
    let near = std::array::from_fn::<f64, 3, _>(|k| screen[k] * inv_w[k]);
    let total = near[0] + near[1] + near[2];
    near.map(|w| w / total)
}

/// A linear function over the screen, f(p) = value + gradient · (p − origin): depth, 1/w, or an
/// attribute divided by w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenPlane {
    /// Point at which `value` holds, in pixels: a corner, so that far-off triangles lose no digits.
    pub origin: DVec2,
    /// The function at `origin`.
    pub value: f64,
    /// Increase per pixel to the right and downwards.
    pub gradient: DVec2,
}

impl ScreenPlane {
    /// Returns the plane through three values at three screen points; `None` for a triangle without
    /// area.
    pub fn through([a, b, c]: [DVec2; 3], [fa, fb, fc]: [f64; 3]) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let area = u.perp_dot(v);
        let (fu, fv) = (fb - fa, fc - fa);
        let gradient = DVec2::new(fu * v.y - fv * u.y, fv * u.x - fu * v.x) / area;
        (area != 0.0 && gradient.is_finite()).then_some(Self { origin: a, value: fa, gradient })
    }

    /// Returns the function at a screen point in pixels.
    #[inline]
    pub fn at(&self, p: DVec2) -> f64 {
        let d = p - self.origin;
        self.value + (self.gradient.x * d.x + self.gradient.y * d.y)
    }
}

/// An attribute over a triangle in perspective: (attribute / w) and (1 / w) are linear on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerspectivePlane {
    over_w: ScreenPlane,
    inv_w: ScreenPlane,
}

impl PerspectivePlane {
    /// Creates the plane from screen points, 1/w (positive) and attributes of the corners; returns `None` without
    /// area.
    pub fn through(points: [DVec2; 3], inv_w: [f64; 3], values: [f64; 3]) -> Option<Self> {
        let over_w = std::array::from_fn(|k| values[k] * inv_w[k]);
        Some(Self {
            over_w: ScreenPlane::through(points, over_w)?,
            inv_w: ScreenPlane::through(points, inv_w)?,
        })
    }

    /// Returns the attribute at a screen point in pixels.
    #[inline]
    pub fn at(&self, p: DVec2) -> f64 {
        self.over_w.at(p) / self.inv_w.at(p)
    }
}
