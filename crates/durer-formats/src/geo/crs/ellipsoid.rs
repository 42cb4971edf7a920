//! The common ground of projections: an ellipsoid of revolution, and its auxiliary latitudes.
//!
//! After J. P. Snyder, *Map Projections: A Working Manual*, 1987, and C. F. F. Karney, *Transverse Mercator with an
//! accuracy of a few nanometers*, 2011. Angles are in radians.

use std::f64::consts::FRAC_PI_2;

/// An ellipsoid of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Half the longer axis, in metres.
    pub a: f64,
    /// The square of the eccentricity; 0 for a sphere.
    pub e2: f64,
}

impl Ellipsoid {
    /// The ellipsoid of WGS 84.
    #[cfg(test)]
    pub const WGS84: Self = Self::flattened(6_378_137.0, 298.257_223_563);

    /// Creates an ellipsoid by its inverse flattening, 0 for a sphere.
    pub const fn flattened(a: f64, inverse: f64) -> Self {
        let f = if inverse == 0.0 { 0.0 } else { 1.0 / inverse };
        Self { a, e2: f * (2.0 - f) }
    }

    /// Creates a sphere of the same longer axis.
    pub fn sphere(self) -> Self {
        Self { e2: 0.0, ..self }
    }

    pub fn e(self) -> f64 {
        self.e2.sqrt()
    }

    /// Returns the third flattening.
    pub fn n(self) -> f64 {
        let root = (1.0 - self.e2).sqrt();
        (1.0 - root) / (1.0 + root)
    }

    /// Returns the radius of a parallel, in units of the longer axis.
    pub fn parallel(self, lat: f64) -> f64 {
        let (sin, cos) = libm::sincos(lat);
        cos / (1.0 - self.e2 * sin * sin).sqrt()
    }

    /// Returns the isometric latitude.
    pub fn isometric(self, lat: f64) -> f64 {
        let e = self.e();
        libm::asinh(libm::tan(lat)) - e * libm::atanh(e * libm::sin(lat))
    }

    /// Returns the tangent of the conformal latitude, given the latitude's.
    pub fn conformal_tan(self, tau: f64) -> f64 {
        let e = self.e();
        let root = (1.0 + tau * tau).sqrt();
        let sigma = libm::sinh(e * libm::atanh(e * tau / root));
        tau * (1.0 + sigma * sigma).sqrt() - sigma * root
    }

    /// Returns the latitude whose conformal latitude has this tangent, by Newton's method.
    pub fn latitude_of_conformal(self, tan: f64) -> f64 {
        /// Number of iterations: three suffice for the earth, a few more for flatter bodies.
        const STEPS: usize = 8;
        if !tan.is_finite() || tan.abs() > 1e15 {
            return FRAC_PI_2.copysign(tan);
        }
        let mut tau = tan / (1.0 - self.e2).sqrt().max(f64::MIN_POSITIVE);
        for _ in 0..STEPS {
            let at = self.conformal_tan(tau);
            let slope = (1.0 + (1.0 - self.e2) * tau * tau)
                / ((1.0 - self.e2) * ((1.0 + at * at) * (1.0 + tau * tau)).sqrt());
            let step = (tan - at) * slope;
            tau += step;
            if step.abs() <= 1e-15 * tau.abs().max(1.0) {
                break;
            }
        }
        libm::atan(tau)
    }

    /// Returns the latitude of an isometric one.
    pub fn latitude_of_isometric(self, psi: f64) -> f64 {
        self.latitude_of_conformal(libm::sinh(psi))
    }

    /// Returns a quantity that grows with the area below a latitude, from -[`Self::polar_q`] to
    /// that.
    pub fn q(self, lat: f64) -> f64 {
        let (sin, e) = (libm::sin(lat), self.e());
        let far = if e == 0.0 { sin } else { libm::atanh(e * sin) / e };
        (1.0 - self.e2) * (sin / (1.0 - self.e2 * sin * sin) + far)
    }

    /// Returns the value of [`Self::q`] at the pole.
    pub fn polar_q(self) -> f64 {
        self.q(FRAC_PI_2)
    }

    /// Returns the radius of the sphere of the same area.
    pub fn authalic_radius(self) -> f64 {
        self.a * (self.polar_q() / 2.0).sqrt()
    }

    /// Returns the sine of the authalic latitude.
    pub fn authalic_sin(self, lat: f64) -> f64 {
        (self.q(lat) / self.polar_q()).clamp(-1.0, 1.0)
    }

    /// Returns the latitude of a [`Self::q`], by Newton's method.
    pub fn latitude_of_q(self, q: f64) -> f64 {
        const STEPS: usize = 10;
        let share = q / self.polar_q();
        if share.abs() >= 1.0 {
            return FRAC_PI_2.copysign(share);
        }
        let mut lat = libm::asin(share);
        for _ in 0..STEPS {
            let (sin, cos) = libm::sincos(lat);
            let below = 1.0 - self.e2 * sin * sin;
            let slope = 2.0 * (1.0 - self.e2) * cos / (below * below);
            if slope <= 0.0 {
                break;
            }
            let step = (q - self.q(lat)) / slope;
            lat = (lat + step).clamp(-FRAC_PI_2, FRAC_PI_2);
            if step.abs() < 1e-15 {
                break;
            }
        }
        lat
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latitudes_come_back() {
        for body in [Ellipsoid::WGS84, Ellipsoid::WGS84.sphere(), Ellipsoid::flattened(1.0, 10.0)] {
            for i in -89..=89 {
                let lat = f64::from(i).to_radians();
                let back = body.latitude_of_isometric(body.isometric(lat));
                assert!((back - lat).abs() < 1e-14, "{i}");
                let back = body.latitude_of_q(body.q(lat));
                assert!((back - lat).abs() < 1e-13, "{i}: {}", back - lat);
            }
            assert_eq!(body.latitude_of_q(9.0), FRAC_PI_2);
            assert_eq!(body.latitude_of_isometric(-99.0), -FRAC_PI_2);
        }
    }
}
