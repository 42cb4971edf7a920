//! Depth: the range of window depth, polygon offset (OpenGL 4.6, 13.8.1, 14.6.5). The test itself is
//! [`super::Compare`], whose usual choice is [`super::Compare::Less`]: of equal depths the first stays.

/// Window depths of the near and the far plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthRange {
    /// Window depth of the near plane, 0…1.
    pub near: f32,
    /// Window depth of the far plane, 0…1; may be less than `near`.
    pub far: f32,
}

impl Default for DepthRange {
    /// Returns the default: near 0, far 1.
    fn default() -> Self {
        Self { near: 0.0, far: 1.0 }
    }
}

impl DepthRange {
    /// Converts normalized device depth −1…1 to window depth; both ends of the range are clamped to 0…1.
    pub(crate) fn window(&self, ndc: f64) -> f64 {
        let (near, far) = self.held();
        ndc * ((far - near) * 0.5) + (near + far) * 0.5
    }

    /// Returns a window depth clamped to the range. NaN becomes the nearer end.
    pub(crate) fn clamp(&self, depth: f32) -> f32 {
        let (near, far) = self.held();
        let (low, high) = (near.min(far) as f32, near.max(far) as f32);
        if depth > high {
            high
        } else if depth > low {
            depth
        } else {
            low
        }
    }

    fn held(&self) -> (f64, f64) {
        let hold = |d: f32| if d > 0.0 { f64::from(d.min(1.0)) } else { 0.0 };
        (hold(self.near), hold(self.far))
    }
}

/// Offset of the depth of whole polygons, so that they do not hide lines or decals on them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PolygonOffset {
    /// Times the polygon's steepest slope in depth per pixel.
    pub factor: f32,
    /// Times the smallest difference that a depth of this size can have.
    pub units: f32,
    /// Above 0 the offset is at most, below 0 at least this; 0 = no bound.
    pub clamp: f32,
}

impl PolygonOffset {
    /// Returns the offset that is added to the depths of a polygon.
    ///
    /// `slope` is the change of depth per pixel along x and y, `deepest` the largest absolute depth of
    /// its vertices: for a floating-point depth plane the smallest difference is 2^(e − 23), e being the
    /// exponent of that depth.
    pub fn offset(&self, slope: [f32; 2], deepest: f32) -> f32 {
        let steepest = slope[0].abs().max(slope[1].abs());
        let smallest = f32::from_bits(deepest.abs().max(f32::MIN_POSITIVE).to_bits() & 0x7f80_0000)
            * (1.0 / 8_388_608.0);
        let offset = self.factor * steepest + self.units * smallest;
        if self.clamp > 0.0 {
            offset.min(self.clamp)
        } else if self.clamp < 0.0 {
            offset.max(self.clamp)
        } else {
            offset
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_takes_both_planes_to_its_ends() {
        for (near, far) in [(0.0, 1.0), (0.25, 0.5), (1.0, 0.0), (-3.0, 9.0)] {
            let range = DepthRange { near, far };
            assert_eq!(range.window(-1.0), f64::from(near.clamp(0.0, 1.0)));
            assert_eq!(range.window(1.0), f64::from(far.clamp(0.0, 1.0)));
        }
        assert_eq!(DepthRange::default().window(0.5), 0.75);
        let half = DepthRange { near: 0.5, far: 0.25 };
        assert_eq!([0.0, 0.3, 0.9, f32::NAN].map(|d| half.clamp(d)), [0.25, 0.3, 0.5, 0.25]);
    }

    #[test]
    fn offset_is_slope_and_units() {
        let offset = PolygonOffset { factor: 2.0, units: 0.0, clamp: 0.0 };
        assert_eq!(offset.offset([0.01, -0.03], 0.5), 0.06);
        let unit = PolygonOffset { factor: 0.0, units: 1.0, clamp: 0.0 };
        // One unit is exactly one step of the float.
        for deepest in [0.5_f32, 0.75, 0.999, 1e-3] {
            let next = f32::from_bits(deepest.to_bits() + 1);
            assert_eq!(deepest + unit.offset([0.0; 2], deepest), next);
        }
        let held = PolygonOffset { clamp: -0.01, factor: -1.0, ..unit };
        assert_eq!(held.offset([5.0, 0.0], 0.5), -0.01);
        let held = PolygonOffset { clamp: 0.01, factor: 1.0, ..unit };
        assert_eq!(held.offset([5.0, 0.0], 0.5), 0.01);
        assert!(unit.offset([0.0; 2], f32::NAN).is_finite());
    }
}
