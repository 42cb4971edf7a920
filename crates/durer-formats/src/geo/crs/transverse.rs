//! Transverse Mercator by the series of L. Krüger, *Konforme Abbildung des Erdellipsoids in der Ebene*, 1912, to the
//! sixth order as C. F. F. Karney has it, *Transverse Mercator with an accuracy of a few nanometers*, 2011: right to
//! nanometres within some 4,000 km of the meridian.

use super::ellipsoid::Ellipsoid;
use durer::math::DVec2;

/// Largest value for which the series is valid; some 80 degrees from the meridian on the equator.
const FARTHEST: f64 = 2.623_395_162_778;

/// The coefficients of powers of the third flattening, beginning with the power that is the series' number.
type Rows = [&'static [f64]; 6];

const THERE: Rows = [
    &[1.0 / 2.0, -2.0 / 3.0, 5.0 / 16.0, 41.0 / 180.0, -127.0 / 288.0, 7891.0 / 37800.0],
    &[13.0 / 48.0, -3.0 / 5.0, 557.0 / 1440.0, 281.0 / 630.0, -1_983_433.0 / 1_935_360.0],
    &[61.0 / 240.0, -103.0 / 140.0, 15061.0 / 26880.0, 167_603.0 / 181_440.0],
    &[49561.0 / 161_280.0, -179.0 / 168.0, 6_601_661.0 / 7_257_600.0],
    &[34729.0 / 80640.0, -3_418_889.0 / 1_995_840.0],
    &[212_378_941.0 / 319_334_400.0],
];

const BACK: Rows = [
    &[1.0 / 2.0, -2.0 / 3.0, 37.0 / 96.0, -1.0 / 360.0, -81.0 / 512.0, 96199.0 / 604_800.0],
    &[1.0 / 48.0, 1.0 / 15.0, -437.0 / 1440.0, 46.0 / 105.0, -1_118_711.0 / 3_870_720.0],
    &[17.0 / 480.0, -37.0 / 840.0, -209.0 / 4480.0, 5569.0 / 90720.0],
    &[4397.0 / 161_280.0, -11.0 / 504.0, -830_251.0 / 7_257_600.0],
    &[4583.0 / 161_280.0, -108_847.0 / 3_991_680.0],
    &[20_648_693.0 / 638_668_800.0],
];

/// The projection of one meridian.
pub struct Transverse {
    body: Ellipsoid,
    there: [f64; 6],
    back: [f64; 6],
    /// The scale times the radius of the circle as long as a meridian, in metres.
    radius: f64,
    /// Northing of the origin's latitude.
    origin: f64,
}

impl Transverse {
    pub fn new(body: Ellipsoid, lat: f64, scale: f64) -> Self {
        let n = body.n();
        let n2 = n * n;
        let series = 1.0 + n2 / 4.0 + n2 * n2 / 64.0 + n2 * n2 * n2 / 256.0;
        let radius = scale * body.a / (1.0 + n) * series;
        let (there, back) = (coefficients(&THERE, n), coefficients(&BACK, n));
        let mut new = Self { body, there, back, radius, origin: 0.0 };
        new.origin = new.series(&new.there, libm::atan(body.conformal_tan(libm::tan(lat))), 0.0).0;
        new
    }

    /// Returns the sums of the series at ξ, η.
    fn series(&self, coefficients: &[f64; 6], xi: f64, eta: f64) -> (f64, f64) {
        let (mut dx, mut de) = (0.0, 0.0);
        // From the smallest terms on, which rounds best.
        for (i, c) in coefficients.iter().enumerate().rev() {
            let twice = 2.0 * (i + 1) as f64;
            let (sin, cos) = libm::sincos(twice * xi);
            dx += c * sin * libm::cosh(twice * eta);
            de += c * cos * libm::sinh(twice * eta);
        }
        (xi + dx, eta + de)
    }

    pub fn forward(&self, lon: f64, lat: f64) -> Option<DVec2> {
        let tan = self.body.conformal_tan(libm::tan(lat));
        let (sin, cos) = libm::sincos(lon);
        let xi = libm::atan2(tan, cos);
        let eta = libm::asinh(sin / libm::hypot(tan, cos));
        let (xi, eta) = self.series(&self.there, xi, eta);
        (eta.abs() <= FARTHEST).then(|| DVec2::new(eta, xi - self.origin) * self.radius)
    }

    pub fn inverse(&self, p: DVec2) -> Option<(f64, f64)> {
        let (xi, eta) = (p.y / self.radius + self.origin, p.x / self.radius);
        if eta.abs() > FARTHEST {
            return None;
        }
        let negative = self.back.map(|c| -c);
        let (xi, eta) = self.series(&negative, xi, eta);
        let (sinh, (sin, cos)) = (libm::sinh(eta), libm::sincos(xi));
        let tan = sin / libm::hypot(sinh, cos);
        Some((libm::atan2(sinh, cos), self.body.latitude_of_conformal(tan)))
    }
}

fn coefficients(rows: &Rows, n: f64) -> [f64; 6] {
    let mut power = 1.0;
    rows.map(|row| {
        power *= n;
        row.iter().rev().fold(0.0, |sum, c| sum * n + c) * power
    })
}
