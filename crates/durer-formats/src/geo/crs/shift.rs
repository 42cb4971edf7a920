//! From one frame to another by seven parameters: the position vector transformation, method 9606 of the EPSG's list,
//! and Bowring's formula for geographic coordinates (*Transformation from spatial to geographical coordinates*, Survey
//! Review 23, 1976), repeated. Places are on the ellipsoid; ignoring heights changes longitudes and latitudes by
//! millimetres.

use super::ellipsoid::Ellipsoid;
use durer::math::DVec3;

/// Transformation of a frame to WGS 84.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Offset in metres.
    offset: DVec3,
    /// Around the axes, in seconds of arc.
    turn: DVec3,
    /// Parts in a million.
    scale: f64,
}

/// A second of arc in radians.
const SECOND: f64 = std::f64::consts::PI / 648_000.0;

impl Shift {
    /// The shift of WGS 84 itself.
    pub const NONE: Self = Self::new([0.0; 3], [0.0; 3], 0.0);

    /// Creates a shift from metres, seconds of arc, and parts in a million.
    pub const fn new(offset: [f64; 3], turn: [f64; 3], scale: f64) -> Self {
        Self { offset: DVec3::from_array(offset), turn: DVec3::from_array(turn), scale }
    }

    fn to_wgs84(self, p: DVec3) -> DVec3 {
        let turned = p + (self.turn * SECOND).cross(p);
        turned * (1.0 + self.scale * 1e-6) + self.offset
    }

    /// Shifts a point back from WGS 84, without products of angles.
    fn of_wgs84(self, p: DVec3) -> DVec3 {
        let q = (p - self.offset) / (1.0 + self.scale * 1e-6);
        q - (self.turn * SECOND).cross(q)
    }
}

/// Returns the longitude and latitude in another frame; angles in radians.
pub fn apply(
    (lon, lat): (f64, f64),
    from: (Ellipsoid, Shift),
    to: (Ellipsoid, Shift),
) -> (f64, f64) {
    let p = to.1.of_wgs84(from.1.to_wgs84(geocentric(from.0, lon, lat)));
    let (new_lon, new_lat) = geographic(to.0, p);
    // Longitudes beyond 180° stay there.
    let turns = ((lon - new_lon) / std::f64::consts::TAU).round();
    (new_lon + turns * std::f64::consts::TAU, new_lat)
}

fn geocentric(body: Ellipsoid, lon: f64, lat: f64) -> DVec3 {
    let ((sin, cos), (sin_lon, cos_lon)) = (libm::sincos(lat), libm::sincos(lon));
    let n = body.a / (1.0 - body.e2 * sin * sin).sqrt();
    DVec3::new(n * cos * cos_lon, n * cos * sin_lon, n * (1.0 - body.e2) * sin)
}

fn geographic(body: Ellipsoid, p: DVec3) -> (f64, f64) {
    /// Number of iterations; two suffice close to the ellipsoid.
    const STEPS: usize = 3;
    let axis = (1.0 - body.e2).sqrt();
    let around = (p.x * p.x + p.y * p.y).sqrt();
    let second = body.e2 / (1.0 - body.e2);
    let mut lat = libm::atan2(p.z, around * (1.0 - body.e2));
    for _ in 0..STEPS {
        let reduced = libm::atan2(axis * libm::sin(lat), libm::cos(lat));
        let (sin, cos) = libm::sincos(reduced);
        let up = p.z + second * body.a * axis * sin * sin * sin;
        lat = libm::atan2(up, around - body.e2 * body.a * cos * cos * cos);
    }
    (libm::atan2(p.y, p.x), lat)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_come_back() {
        let shift = Shift::new([500.0, -100.0, 300.0], [1.0, -2.0, 3.0], 5.0);
        let bodies = [Ellipsoid::flattened(6_377_397.155, 299.152_812_8), Ellipsoid::WGS84];
        for (lon, lat) in [(0.0, 0.0), (3.5, 1.5), (-9.0, -1.0), (1.0, 0.8)] {
            let there = apply((lon, lat), (bodies[0], shift), (bodies[1], Shift::NONE));
            assert!((there.1 - lat).abs() > 1e-6);
            // Heights of up to 600 m are neglected in between: a tenth of a metre.
            let back = apply(there, (bodies[1], Shift::NONE), (bodies[0], shift));
            assert!(((back.0 - lon) * lat.cos()).abs() < 2e-8 && (back.1 - lat).abs() < 2e-8);
            let same = apply((lon, lat), (bodies[0], shift), (bodies[0], shift));
            assert!(((same.0 - lon) * lat.cos()).abs() < 3e-9 && (same.1 - lat).abs() < 3e-9);
        }
    }
}
