//! Outcodes: the borders of a window or volume that a point is beyond, one bit per border.
//!
//! Danny Cohen and Ivan Sutherland, 1967; in print in Newman & Sproull, *Principles of Interactive Computer Graphics*
//! (1973). Two tests decide most cases: if the OR of all codes is empty, everything is inside; if the AND is not empty,
//! everything is beyond one border.

use crate::math::{DVec2, DVec4, Rect};
use std::fmt;
use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign};

/// Range of depths in the clip volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ClipDepths {
    /// −w ≤ z ≤ w, as in OpenGL; durer's own convention.
    #[default]
    NegativeOneToOne,
    /// 0 ≤ z ≤ w, as in Direct3D, Vulkan, Metal.
    ZeroToOne,
}

/// The borders beyond which a point lies; empty for a point inside or on the border.
///
/// y points up: `BOTTOM` is below the smallest y. A NaN coordinate sets both bits of its axis.
///
/// ```
/// use durer::clip::outcode::Outcode;
/// use durer::math::{DVec2, Rect};
/// let window = Rect::new(DVec2::ZERO, DVec2::ONE).unwrap();
/// let code = Outcode::of_point_2d(&window, DVec2::new(2.0, -1.0));
/// assert_eq!(code, Outcode::RIGHT | Outcode::BOTTOM);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Outcode(pub u8);

impl Outcode {
    /// Inside all borders, or on them.
    pub const INSIDE: Self = Self(0);
    /// x below the smallest, or x < −w.
    pub const LEFT: Self = Self(1);
    /// x above the largest, or x > w.
    pub const RIGHT: Self = Self(2);
    /// y below the smallest, or y < −w.
    pub const BOTTOM: Self = Self(4);
    /// y above the largest, or y > w.
    pub const TOP: Self = Self(8);
    /// Before the near plane: z < −w, or z < 0.
    pub const NEAR: Self = Self(16);
    /// Behind the far plane: z > w.
    pub const FAR: Self = Self(32);

    /// The six borders in the order of their bits.
    pub const BORDERS: [Self; 6] =
        [Self::LEFT, Self::RIGHT, Self::BOTTOM, Self::TOP, Self::NEAR, Self::FAR];

    /// Returns the code of a point of the plane; its four bits are exact comparisons.
    #[inline]
    pub fn of_point_2d(window: &Rect, p: DVec2) -> Self {
        let (min, max) = (window.min(), window.max());
        let inside = [p.x >= min.x, p.x <= max.x, p.y >= min.y, p.y <= max.y];
        Self::from_inside(inside)
    }

    /// Returns the code of a homogeneous point (x, y, z, w) of clip space; any w, so that a point behind the eye is
    /// beyond several borders at once.
    #[inline]
    pub fn of_homogeneous(p: DVec4, depth: ClipDepths) -> Self {
        let near = match depth {
            ClipDepths::NegativeOneToOne => -p.w,
            ClipDepths::ZeroToOne => 0.0,
        };
        let inside = [p.x >= -p.w, p.x <= p.w, p.y >= -p.w, p.y <= p.w, p.z >= near, p.z <= p.w];
        Self::from_inside(inside)
    }

    /// Creates an outcode whose bit k is set where `inside[k]` is false.
    #[inline]
    pub(crate) fn from_inside<const N: usize>(inside: [bool; N]) -> Self {
        Self(inside.iter().rev().fold(0, |bits, &inside| bits << 1 | u8::from(!inside)))
    }

    /// Returns the bits as digits in the order of the borders given, for books that number borders
    /// otherwise.
    ///
    /// ```
    /// use durer::clip::outcode::Outcode;
    /// let code = Outcode::LEFT | Outcode::TOP;
    /// assert_eq!(code.to_string(), "1001");
    /// let order = [Outcode::BOTTOM, Outcode::LEFT, Outcode::TOP, Outcode::RIGHT];
    /// assert_eq!(code.digits(&order), "0110");
    /// ```
    pub fn digits(self, order: &[Self]) -> String {
        order.iter().map(|&border| if self.contains(border) { '1' } else { '0' }).collect()
    }

    /// Returns whether no bit is set.
    #[inline]
    pub fn is_inside(self) -> bool {
        self.0 == 0
    }

    /// Returns whether all bits of `other` are set.
    #[inline]
    pub fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

/// As taught: top, bottom, right, left, with two more digits in front for far and near where a bit of them is set.
impl fmt::Display for Outcode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 < 16 { write!(f, "{:04b}", self.0) } else { write!(f, "{:06b}", self.0) }
    }
}

impl fmt::Debug for Outcode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Outcode({self})")
    }
}

impl BitOr for Outcode {
    type Output = Self;

    #[inline]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitAnd for Outcode {
    type Output = Self;

    #[inline]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOrAssign for Outcode {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl BitAndAssign for Outcode {
    #[inline]
    fn bitand_assign(&mut self, other: Self) {
        self.0 &= other.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_belong_to_the_window() {
        let window = Rect::new(DVec2::new(-1.0, 2.0), DVec2::new(3.0, 5.0)).unwrap();
        let code = |x, y| Outcode::of_point_2d(&window, DVec2::new(x, y));
        assert_eq!(code(-1.0, 2.0), Outcode::INSIDE);
        assert_eq!(code(3.0, 5.0), Outcode::INSIDE);
        assert_eq!(code(-1.5, 3.0), Outcode::LEFT);
        assert_eq!(code(3.5, 6.0), Outcode::RIGHT | Outcode::TOP);
        assert_eq!(code(0.0, 1.0), Outcode::BOTTOM);
        assert_eq!(code(f64::NAN, 3.0), Outcode::LEFT | Outcode::RIGHT);
    }

    #[test]
    fn depth_ranges_differ_only_at_the_near_plane() {
        let p = DVec4::new(0.0, 0.0, -0.5, 1.0);
        assert_eq!(Outcode::of_homogeneous(p, ClipDepths::NegativeOneToOne), Outcode::INSIDE);
        assert_eq!(Outcode::of_homogeneous(p, ClipDepths::ZeroToOne), Outcode::NEAR);
    }

    #[test]
    fn a_point_behind_the_eye_is_never_inside() {
        let p = DVec4::new(0.0, 0.0, 0.0, -1.0);
        let all = Outcode::BORDERS.into_iter().fold(Outcode::INSIDE, |a, b| a | b);
        assert_eq!(Outcode::of_homogeneous(p, ClipDepths::NegativeOneToOne), all);
    }
}
