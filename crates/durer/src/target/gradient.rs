//! Gradients: colours that change along a line or between two circles.

use crate::math::{DAffine2, DVec2};

/// Largest relative difference of the axes of a map that keeps the shape of circles.
const SIMILAR: f64 = 1e-9;

/// Extension of a gradient before its first and after its last stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Spread {
    /// The colour of the end.
    #[default]
    Pad,
    /// The gradient again.
    Repeat,
    /// The gradient turned round, and so on.
    Reflect,
}

/// Curve along which a gradient's parameter runs from 0 to 1; points in the gradient's own space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GradientShape {
    /// Gradient from one point to another, constant across.
    Linear {
        /// Point where the parameter is 0.
        start: DVec2,
        /// Point where the parameter is 1.
        end: DVec2,
    },
    /// Gradient from a focal circle to an outer circle, as in SVG and PDF.
    Radial {
        /// Centre of the outer circle, where the parameter is 1.
        center: DVec2,
        /// Radius of the outer circle.
        radius: f64,
        /// Centre of the inner circle, where the parameter is 0.
        focus: DVec2,
        /// Radius of the inner circle.
        focus_radius: f64,
    },
}

/// A colour ramp along a line or between two circles.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// Geometry of the parameter.
    pub shape: GradientShape,
    /// Parameters 0 … 1 in rising order and their colours: sRGB with straight alpha.
    pub stops: Vec<(f64, [u8; 4])>,
    /// Extension outside 0 … 1.
    pub spread: Spread,
    /// Map from the gradient's own space to that of the path that it fills.
    pub transform: DAffine2,
}

impl Gradient {
    /// Returns the colour of a gradient that shows a single one, as SVG says: that of its last stop if it has no finite
    /// extent, no other stop, or no inverse of `map`, its map to the target; a transparent one if it has no stops.
    pub(crate) fn only_color(&self, map: DAffine2) -> Option<[u8; 4]> {
        let Some((_, last)) = self.stops.last() else { return Some([0; 4]) };
        let is_flat = match self.shape {
            GradientShape::Linear { start, end } => start == end || !(start + end).is_finite(),
            GradientShape::Radial { center, radius, focus, focus_radius } => {
                let is_finite = (center + focus + radius + focus_radius).is_finite();
                radius <= 0.0 || !is_finite
            }
        };
        let determinant = map.matrix2.determinant();
        let has_inverse = determinant.is_finite() && determinant != 0.0 && map.is_finite();
        (is_flat || self.stops.len() == 1 || !has_inverse).then_some(*last)
    }

    /// Returns the same gradient for paths that have been mapped. Its own transform is the identity, except where
    /// circles become ellipses: there it maps an outer circle of radius 1 around the origin.
    ///
    /// ```
    /// use durer::math::{DAffine2, DVec2};
    /// use durer::target::gradient::{Gradient, GradientShape, Spread};
    ///
    /// let shape = GradientShape::Linear { start: DVec2::ZERO, end: DVec2::X };
    /// let stops = vec![(0.0, [0, 0, 0, 255]), (1.0, [255; 4])];
    /// let (spread, transform) = (Spread::Pad, DAffine2::IDENTITY);
    /// let gradient = Gradient { shape, stops, spread, transform };
    /// let larger = gradient.mapped(DAffine2::from_scale(DVec2::new(3.0, 2.0)));
    /// let expected = GradientShape::Linear { start: DVec2::ZERO, end: DVec2::new(3.0, 0.0) };
    /// assert_eq!((larger.shape, larger.transform), (expected, DAffine2::IDENTITY));
    /// ```
    pub fn mapped(&self, map: DAffine2) -> Self {
        let map = map * self.transform;
        let (shape, transform) = match self.shape {
            GradientShape::Linear { start, end } => {
                let way = end - start;
                let (start, along) = (map.transform_point2(start), map.transform_vector2(way));
                // Colours are constant across, and change at a right angle to that.
                let normal = map.transform_vector2(way.perp()).perp();
                let way = normal * (along.dot(normal) / normal.length_squared());
                (GradientShape::Linear { start, end: start + way }, DAffine2::IDENTITY)
            }
            GradientShape::Radial { center, radius, focus, focus_radius } => match scale_of(&map) {
                Some(scale) => {
                    let (radius, focus_radius) = (radius * scale, focus_radius * scale);
                    let [center, focus] = [center, focus].map(|p| map.transform_point2(p));
                    let shape = GradientShape::Radial { center, radius, focus, focus_radius };
                    (shape, DAffine2::IDENTITY)
                }
                None => {
                    let (focus, focus_radius) = ((focus - center) / radius, focus_radius / radius);
                    let (size, turn) = (DVec2::splat(radius), 0.0);
                    let unit = DAffine2::from_scale_angle_translation(size, turn, center);
                    let center = DVec2::ZERO;
                    (GradientShape::Radial { center, radius: 1.0, focus, focus_radius }, map * unit)
                }
            },
        };
        Self { shape, transform, ..self.clone() }
    }
}

/// Returns the scale of a map that keeps shapes; `None` for other maps.
pub(crate) fn scale_of(map: &DAffine2) -> Option<f64> {
    let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis];
    let (scale, skew) = (x.length(), x.dot(y).abs());
    let is_similar =
        (y.length() - scale).abs() <= SIMILAR * scale && skew <= SIMILAR * scale * scale;
    (is_similar && scale > 0.0).then_some(scale)
}
