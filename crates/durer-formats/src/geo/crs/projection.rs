//! Projections, each as formulas there and back.

use super::ellipsoid::Ellipsoid;
use super::transverse::Transverse;
use super::world;
use durer::math::DVec2;
use std::f64::consts::{FRAC_PI_2, PI};

/// Projection from an ellipsoid to a plane; angles in radians, lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Mercator with a scale at the equator.
    Mercator { scale: f64 },
    /// Transverse Mercator.
    Transverse { lat: f64, scale: f64 },
    /// Lambert's conformal conic of two parallels, or twice the same one.
    Conformal { lat: f64, parallels: [f64; 2], scale: f64 },
    /// Albers' equal-area conic.
    Albers { lat: f64, parallels: [f64; 2] },
    /// Lambert's azimuthal equal-area projection.
    Azimuthal { lat: f64 },
    /// Stereographic around a pole: 1 for the north, -1 for the south, and its scale there.
    Stereographic { pole: f64, scale: f64 },
    /// Robinson's.
    Robinson,
    /// Equal Earth.
    EqualEarth,
}

/// A projection with its frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    pub method: Method,
    pub body: Ellipsoid,
    /// The meridian in the middle.
    pub meridian: f64,
    /// Offset added to coordinates, in metres.
    pub offset: DVec2,
}

impl Projection {
    /// Projects longitude and latitude in radians; `None` if the projection has no such place.
    pub fn forward(&self, lon: f64, lat: f64) -> Option<DVec2> {
        if lat.abs() > FRAC_PI_2 + 1e-10 {
            return None;
        }
        let (lat, lon) = (lat.clamp(-FRAC_PI_2, FRAC_PI_2), around(lon - self.meridian));
        let (body, a) = (self.body, self.body.a);
        if self.is_far(lat) {
            return None;
        }
        let p = match self.method {
            Method::Mercator { scale } => DVec2::new(lon, body.isometric(lat)) * (a * scale),
            Method::Transverse { lat: origin, scale } => {
                Transverse::new(body, origin, scale).forward(lon, lat)?
            }
            Method::Conformal { lat: origin, parallels, scale } => {
                let cone = Cone::conformal(body, parallels);
                let rho = |lat| cone.conformal_radius(lat) * a * scale;
                cone.unroll(lon, rho(lat), rho(origin))
            }
            Method::Albers { lat: origin, parallels } => {
                let cone = Cone::albers(body, parallels);
                let rho = |lat| cone.albers_radius(body.q(lat)) * a;
                cone.unroll(lon, rho(lat), rho(origin))
            }
            Method::Azimuthal { lat: origin } => azimuthal(body, origin, lon, lat)?,
            Method::Stereographic { pole, scale } => {
                let rho = polar_radius(body, scale) * libm::exp(-body.isometric(lat * pole));
                let (sin, cos) = libm::sincos(lon);
                DVec2::new(rho * sin, -pole * rho * cos)
            }
            Method::Robinson => world::robinson(lon, lat) * a,
            Method::EqualEarth => {
                world::equal_earth(lon, body.authalic_sin(lat)) * body.authalic_radius()
            }
        };
        Some(p + self.offset).filter(|p| p.is_finite() && p.abs().max_element() < LARGEST)
    }

    /// Returns whether a latitude is a pole's that the projection maps to infinity.
    fn is_far(&self, lat: f64) -> bool {
        let far = match self.method {
            Method::Mercator { .. } => true,
            Method::Conformal { parallels: [first, second], .. } => lat * (first + second) < 0.0,
            Method::Stereographic { pole, .. } => lat * pole < 0.0,
            _ => false,
        };
        far && is_pole(lat)
    }

    /// Returns longitude and latitude of a point in radians; `None` for points outside the map.
    pub fn inverse(&self, p: DVec2) -> Option<(f64, f64)> {
        let (body, a) = (self.body, self.body.a);
        let p = p - self.offset;
        let (lon, lat) = match self.method {
            Method::Mercator { scale } => {
                let q = p / (a * scale);
                (q.x, body.latitude_of_isometric(q.y))
            }
            Method::Transverse { lat, scale } => Transverse::new(body, lat, scale).inverse(p)?,
            Method::Conformal { lat: origin, parallels, scale } => {
                let cone = Cone::conformal(body, parallels);
                let (lon, rho) = cone.roll(p, cone.conformal_radius(origin) * a * scale);
                (lon, cone.latitude_of_radius(body, rho / (a * scale)))
            }
            Method::Albers { lat: origin, parallels } => {
                let cone = Cone::albers(body, parallels);
                let (lon, rho) = cone.roll(p, cone.albers_radius(body.q(origin)) * a);
                let q = (cone.constant - (rho * cone.n / a) * (rho * cone.n / a)) / cone.n;
                (lon, body.latitude_of_q(beside_pole(q, body.polar_q())?))
            }
            Method::Azimuthal { lat } => azimuthal_back(body, lat, p)?,
            Method::Stereographic { pole, scale } => {
                let psi = -libm::log(p.length() / polar_radius(body, scale));
                (libm::atan2(p.x, -pole * p.y), pole * body.latitude_of_isometric(psi))
            }
            Method::Robinson => world::robinson_back(p / a)?,
            Method::EqualEarth => {
                let (lon, sin) = world::equal_earth_back(p / body.authalic_radius())?;
                (lon, body.latitude_of_q(sin * body.polar_q()))
            }
        };
        let inside = lon.abs() <= PI + SLACK && lat.abs() <= FRAC_PI_2 + SLACK;
        inside.then(|| (around(lon + self.meridian), lat.clamp(-FRAC_PI_2, FRAC_PI_2)))
    }
}

/// Largest coordinate of a map in metres; places beyond, such as poles of conformal projections, cannot be shown.
const LARGEST: f64 = 1e9;

/// Rounding may lead so far, in radians, beyond the border of the world.
const SLACK: f64 = 1e-9;

/// Returns an angle that is beyond ±π, within.
pub fn around(angle: f64) -> f64 {
    if angle.abs() <= PI + 1e-12 {
        return angle;
    }
    let turned = libm::fmod(angle + PI, 2.0 * PI);
    if turned < 0.0 { turned + PI } else { turned - PI }
}

/// Returns a value within ±`most`, or a little beyond by rounding.
fn beside_pole(q: f64, most: f64) -> Option<f64> {
    (q.abs() <= most * (1.0 + SLACK)).then(|| q.clamp(-most, most))
}

/// A cone that touches or cuts the body.
struct Cone {
    n: f64,
    constant: f64,
    conformal: Option<Ellipsoid>,
}

impl Cone {
    fn conformal(body: Ellipsoid, [first, second]: [f64; 2]) -> Self {
        let (m1, m2) = (body.parallel(first), body.parallel(second));
        let (p1, p2) = (body.isometric(first), body.isometric(second));
        let one = (first - second).abs() < 1e-10;
        let n = if one { libm::sin(first) } else { libm::log(m1 / m2) / (p2 - p1) };
        Self { n, constant: m1 / n * libm::exp(n * p1), conformal: Some(body) }
    }

    fn albers(body: Ellipsoid, [first, second]: [f64; 2]) -> Self {
        let (m1, m2) = (body.parallel(first), body.parallel(second));
        let (q1, q2) = (body.q(first), body.q(second));
        let one = (first - second).abs() < 1e-10;
        let n = if one { libm::sin(first) } else { (m1 * m1 - m2 * m2) / (q2 - q1) };
        Self { n, constant: m1 * m1 + n * q1, conformal: None }
    }

    /// Returns the radius of a latitude, in units of the longer axis.
    fn conformal_radius(&self, lat: f64) -> f64 {
        let psi = self.conformal.map_or(0.0, |body| body.isometric(lat));
        if lat.abs() >= FRAC_PI_2 && lat * self.n > 0.0 {
            return 0.0;
        }
        self.constant * libm::exp(-self.n * psi)
    }

    fn latitude_of_radius(&self, body: Ellipsoid, rho: f64) -> f64 {
        if rho == 0.0 {
            return FRAC_PI_2.copysign(self.n);
        }
        body.latitude_of_isometric(libm::log(self.constant / rho) / self.n)
    }

    fn albers_radius(&self, q: f64) -> f64 {
        (self.constant - self.n * q).max(0.0).sqrt() / self.n
    }

    fn unroll(&self, lon: f64, rho: f64, origin: f64) -> DVec2 {
        let (sin, cos) = libm::sincos(self.n * lon);
        DVec2::new(rho * sin, origin - rho * cos)
    }

    /// Returns the longitude and radius; radii have the sign of the cone.
    fn roll(&self, p: DVec2, origin: f64) -> (f64, f64) {
        let sign = 1_f64.copysign(self.n);
        let y = origin - p.y;
        let angle = libm::atan2(sign * p.x, sign * y);
        (angle / self.n, sign * DVec2::new(p.x, y).length())
    }
}

/// Returns the radius of the circle that the equator becomes, by the scale at the pole.
fn polar_radius(body: Ellipsoid, scale: f64) -> f64 {
    let e = body.e();
    let power = libm::pow(1.0 + e, 1.0 + e) * libm::pow(1.0 - e, 1.0 - e);
    2.0 * body.a * scale / power.sqrt()
}

/// Returns the scale at the pole of a stereographic projection that is true on a parallel.
pub fn scale_of_parallel(body: Ellipsoid, lat: f64) -> f64 {
    let lat = lat.abs();
    if lat >= FRAC_PI_2 - 1e-10 {
        return 1.0;
    }
    body.a * body.parallel(lat) / (polar_radius(body, 1.0) * libm::exp(-body.isometric(lat)))
}

/// Returns whether a latitude is a pole's.
fn is_pole(lat: f64) -> bool {
    lat.abs() > FRAC_PI_2 - 1e-10
}

/// Returns the factor by which the scales along both axes differ from those on the sphere of the same area.
fn skew(body: Ellipsoid, origin: f64, cos_authalic: f64) -> f64 {
    body.a * body.parallel(origin) / (body.authalic_radius() * cos_authalic)
}

fn azimuthal(body: Ellipsoid, origin: f64, lon: f64, lat: f64) -> Option<DVec2> {
    let (sin_lon, cos_lon) = libm::sincos(lon);
    if is_pole(origin) {
        let sign = 1_f64.copysign(origin);
        let rho = body.a * (body.polar_q() - sign * body.q(lat)).max(0.0).sqrt();
        return Some(DVec2::new(rho * sin_lon, -sign * rho * cos_lon));
    }
    let (sin1, sin) = (body.authalic_sin(origin), body.authalic_sin(lat));
    let (cos1, cos) = ((1.0 - sin1 * sin1).sqrt(), (1.0 - sin * sin).sqrt());
    let below = 1.0 + sin1 * sin + cos1 * cos * cos_lon;
    // The point opposite of the origin would be a circle.
    if below < 1e-10 {
        return None;
    }
    let b = body.authalic_radius() * (2.0 / below).sqrt();
    let d = skew(body, origin, cos1);
    Some(DVec2::new(b * d * cos * sin_lon, b / d * (cos1 * sin - sin1 * cos * cos_lon)))
}

fn azimuthal_back(body: Ellipsoid, origin: f64, p: DVec2) -> Option<(f64, f64)> {
    if is_pole(origin) {
        let sign = 1_f64.copysign(origin);
        let rho = p.length() / body.a;
        let q = beside_pole(sign * (body.polar_q() - rho * rho), body.polar_q())?;
        return Some((libm::atan2(p.x, -sign * p.y), body.latitude_of_q(q)));
    }
    let (sin1, radius) = (body.authalic_sin(origin), body.authalic_radius());
    let cos1 = (1.0 - sin1 * sin1).sqrt();
    let d = skew(body, origin, cos1);
    let q = DVec2::new(p.x / d, p.y * d);
    let rho = q.length();
    if rho == 0.0 {
        return Some((0.0, origin));
    }
    let half = rho / (2.0 * radius);
    if half > 1.0 {
        return None;
    }
    let (sin_c, cos_c) = libm::sincos(2.0 * libm::asin(half));
    let sin = cos_c * sin1 + q.y * sin_c * cos1 / rho;
    let lon = libm::atan2(q.x * sin_c, rho * cos1 * cos_c - q.y * sin1 * sin_c);
    Some((lon, body.latitude_of_q(sin.clamp(-1.0, 1.0) * body.polar_q())))
}

/// Returns the scale at the equator of a Mercator projection that is true on a parallel.
pub fn mercator_scale(body: Ellipsoid, lat: f64) -> f64 {
    body.parallel(lat)
}
