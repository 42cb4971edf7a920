//! Vectors, planes, rectangles, and the exact predicates that decide topology.

pub use glam::{
    DAffine2, DAffine3, DMat3, DMat4, DQuat, DVec2, DVec3, DVec4, I64Vec2, IVec2, Mat3, Mat4,
    UVec2, Vec2, Vec3, Vec4,
};

/// Side of a directed line on which a point is; decided exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Orientation {
    /// The three points turn to the left (y up): the third is left of the line first → second.
    CounterClockwise,
    /// The three points turn to the right (y up).
    Clockwise,
    /// The three points are on one line.
    Collinear,
}

/// Returns the orientation of three points, exact for all finite input whose products neither
/// overflow nor underflow (Shewchuk, *Adaptive Precision Floating-Point Arithmetic*, 1997).
///
/// ```
/// use durer::math::{DVec2, Orientation, orient2d};
/// let (a, b) = (DVec2::ZERO, DVec2::X);
/// assert_eq!(orient2d(a, b, DVec2::Y), Orientation::CounterClockwise);
/// ```
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Orientation {
    let det = orient2d_value(a, b, c);
    if det > 0.0 {
        Orientation::CounterClockwise
    } else if det < 0.0 {
        Orientation::Clockwise
    } else {
        Orientation::Collinear
    }
}

/// Returns whether x is in the open sector around an apex, from the ray through one point counter-clockwise to the ray
/// through another; exact like [`orient2d`]. If both rays are the same, everything except that ray is in the sector.
///
/// ```
/// use durer::math::{DVec2, in_sector};
/// let (east, north) = (DVec2::X, DVec2::Y);
/// assert!(in_sector(DVec2::ZERO, east, DVec2::ONE, north));
/// assert!(!in_sector(DVec2::ZERO, north, DVec2::ONE, east));
/// ```
pub fn in_sector(apex: DVec2, from: DVec2, x: DVec2, to: DVec2) -> bool {
    let left = |a, b, c| orient2d(a, b, c) == Orientation::CounterClockwise;
    let (first, second) = (left(to, apex, x), left(apex, from, x));
    if left(to, apex, from) { first && second } else { first || second }
}

/// Returns twice the signed area of the triangle a, b, c; its sign is exact, its size approximate.
pub fn orient2d_value(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// An oriented plane: the points p with `normal · p + distance = 0`.
///
/// The positive side, `normal · p + distance > 0`, is the inside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Points to the inside; need not have unit length.
    pub normal: DVec3,
    /// `−normal · q` for any point q of the plane.
    pub distance: f64,
}

impl Plane {
    /// Returns the plane through `point` whose inside is where `normal` points.
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        Self { normal, distance: -normal.dot(point) }
    }

    /// Returns `normal · p + distance`: positive inside, zero on the plane; in units of `normal`'s length.
    pub fn evaluate(&self, p: DVec3) -> f64 {
        self.normal.dot(p) + self.distance
    }

    /// Returns the plane with a normal of unit length; `None` if the normal has no direction.
    pub fn normalized(&self) -> Option<Self> {
        let length = self.normal.length();
        (length.is_finite() && length > 0.0)
            .then(|| Self { normal: self.normal / length, distance: self.distance / length })
    }
}

/// An axis-parallel rectangle; closed, so its border belongs to it.
///
/// # Guarantees
/// All four numbers are finite and `min ≤ max` on both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    min: DVec2,
    max: DVec2,
}

impl Rect {
    /// Returns the rectangle between two corners.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] if a number is not finite or `min > max` on an axis.
    pub fn new(min: DVec2, max: DVec2) -> crate::Result<Self> {
        if min.is_finite() && max.is_finite() && min.x <= max.x && min.y <= max.y {
            Ok(Self { min, max })
        } else {
            Err(crate::Error::parameter(
                "rectangle",
                format!("{},{} … {},{}", min.x, min.y, max.x, max.y),
                "finite, with min ≤ max on both axes",
            ))
        }
    }

    /// Returns the smallest rectangle around the finite points; `None` if there is none.
    pub fn around(points: impl IntoIterator<Item = DVec2>) -> Option<Self> {
        let mut points = points.into_iter().filter(|p| p.is_finite());
        let first = points.next()?;
        let (min, max) = points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
        Some(Self { min, max })
    }

    /// Returns the corner with the smallest coordinates.
    pub fn min(&self) -> DVec2 {
        self.min
    }

    /// Returns the corner with the largest coordinates.
    pub fn max(&self) -> DVec2 {
        self.max
    }

    /// Returns the width and height.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Returns whether the point is inside or on the border.
    pub fn contains(&self, p: DVec2) -> bool {
        p.x >= self.min.x && p.x <= self.max.x && p.y >= self.min.y && p.y <= self.max.y
    }

    /// Returns whether the two closed rectangles have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }
}

/// Returns an order of points: by x, then y, then z.
pub(crate) fn by_coordinates(a: &DVec3, b: &DVec3) -> std::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

/// Returns `x` to the power `y` for `x ≥ 0`, the same bits on every machine.
///
/// The platform's `powf` differs between C libraries; this one uses only IEEE basic operations.
/// Relative error below 2e-6 over the range that shading uses (results in 1e-30 … 1e30).
pub fn powf(x: f32, y: f32) -> f32 {
    if x <= 0.0 {
        return if y == 0.0 { 1.0 } else { 0.0 };
    }
    exp2(y * log2(x))
}

/// Returns the logarithm to base 2 of a positive finite number; see [`powf`].
pub(crate) fn log2(x: f32) -> f32 {
    let x = f64::from(x);
    let bits = x.to_bits();
    let mut exponent = ((bits >> 52) & 0x7ff) as i64 - 1023;
    let mut m = f64::from_bits((bits & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000);
    if m > std::f64::consts::SQRT_2 {
        m *= 0.5;
        exponent += 1;
    }
    // ln m = 2 artanh(s), s = (m − 1)/(m + 1), |s| ≤ 0.1716: seven terms give 1e-11.
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let series = 1.0
        + s2 * (1.0 / 3.0
            + s2 * (1.0 / 5.0 + s2 * (1.0 / 7.0 + s2 * (1.0 / 9.0 + s2 * (1.0 / 11.0)))));
    (exponent as f64 + 2.0 * s * series * std::f64::consts::LOG2_E) as f32
}

/// Returns two to the power `x`; overflow gives infinity, underflow zero; see [`powf`].
pub(crate) fn exp2(x: f32) -> f32 {
    if x.is_nan() {
        return x;
    }
    if x >= 128.0 {
        return f32::INFINITY;
    }
    if x < -149.0 {
        return 0.0;
    }
    let x = f64::from(x);
    let whole = x.round();
    let t = (x - whole) * std::f64::consts::LN_2;
    // e^t for |t| ≤ 0.3466 by its Taylor polynomial of degree 8: error below 1e-10.
    let p = 1.0
        + t * (1.0
            + t * (1.0 / 2.0
                + t * (1.0 / 6.0
                    + t * (1.0 / 24.0
                        + t * (1.0 / 120.0
                            + t * (1.0 / 720.0 + t * (1.0 / 5040.0 + t / 40320.0)))))));
    (p * f64::from_bits(((whole as i64 + 1023) as u64) << 52)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powf_is_close_to_the_platforms() {
        for i in 1..2000 {
            let x = i as f32 / 1000.0;
            for y in [0.0, 0.4167, 1.0, 2.2, 2.4, 32.0, 100.0] {
                let (ours, theirs) = (powf(x, y), x.powf(y));
                if theirs > 1e-30 {
                    assert!((ours - theirs).abs() <= 2e-5 * theirs, "{x}^{y}: {ours} {theirs}");
                }
            }
        }
    }

    #[test]
    fn orientation_is_exact_near_a_line() {
        let tiny = f64::EPSILON;
        let (a, b) = (DVec2::new(12.0, 12.0), DVec2::new(24.0, 24.0));
        assert_eq!(orient2d(DVec2::splat(0.5), a, b), Orientation::Collinear);
        assert_eq!(orient2d(DVec2::new(0.5, 0.5 + tiny), a, b), Orientation::CounterClockwise);
    }
}
