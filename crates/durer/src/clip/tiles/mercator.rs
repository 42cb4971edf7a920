//! Web Mercator (EPSG:3857) as a square of side 1, x to the east from longitude −180°, y to the south.
//!
//! The Mercator projection of a sphere, as web maps use it for coordinates on the WGS 84 ellipsoid.

use crate::math::DVec2;
use std::f64::consts::PI;

/// Half the circumference of the sphere of Web Mercator, in metres: where EPSG:3857 ends on all sides.
pub(crate) const HALF_WORLD: f64 = PI * 6_378_137.0;

/// Latitude at which points nearer to a pole are placed, far beyond the square: the pole itself is
/// infinitely far away.
const LAST_LATITUDE: f64 = 89.999;

/// Returns the place of a longitude and latitude in degrees. Longitudes beyond ±180° continue into the neighbouring
/// worlds; latitudes beyond ±85.0511° are outside the square.
///
/// ```
/// use durer::clip::tiles::mercator;
/// use durer::math::DVec2;
/// assert_eq!(mercator::project(DVec2::ZERO), DVec2::splat(0.5));
/// assert_eq!(mercator::project(DVec2::new(540.0, 0.0)).x, 2.0);
/// ```
pub fn project(degrees: DVec2) -> DVec2 {
    let latitude = degrees.y.clamp(-LAST_LATITUDE, LAST_LATITUDE);
    let sine = libm::sin(latitude * (PI / 180.0));
    let north = libm::atanh(sine) / PI;
    DVec2::new(degrees.x / 360.0 + 0.5, 0.5 - 0.5 * north)
}

/// Returns the longitude and latitude in degrees of a place.
pub fn unproject(place: DVec2) -> DVec2 {
    DVec2::new((place.x - 0.5) * 360.0, latitude(1.0 - 2.0 * place.y))
}

/// Returns the latitude in degrees at a height of the square, 1 at its upper border and −1 at its
/// lower one.
pub(crate) fn latitude(part: f64) -> f64 {
    libm::atan(libm::sinh(part * PI)).to_degrees()
}

/// Returns the place of coordinates of EPSG:3857, in metres.
pub(crate) fn of_metres(metres: DVec2) -> DVec2 {
    let part = metres / (2.0 * HALF_WORLD);
    DVec2::new(part.x + 0.5, 0.5 - part.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_ends_where_web_mercator_does() {
        let top = unproject(DVec2::ZERO);
        // The latitude where Web Mercator ends.
        assert!((top.y - 85.051_128_779_806_59).abs() < 1e-12);
        assert_eq!(top.x, -180.0);
        assert!(project(top).abs().max_element() < 1e-12);
        assert_eq!(of_metres(DVec2::new(HALF_WORLD, -HALF_WORLD)), DVec2::ONE);
        for latitude in [-80.0, -1e-3, 12.5, 66.6] {
            let there = DVec2::new(7.0, latitude);
            assert!(unproject(project(there)).distance(there) < 1e-12, "{latitude}");
        }
        assert!(project(DVec2::new(0.0, 90.0)).y < -0.5);
        assert!(project(DVec2::new(0.0, -1e9)).y.is_finite());
    }
}
