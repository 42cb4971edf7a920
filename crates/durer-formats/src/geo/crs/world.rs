//! Projections for maps of the world.

use durer::math::DVec2;
use std::f64::consts::FRAC_PI_2;

/// Coefficients of Equal Earth: B. Šavrič, T. Patterson and B. Jenny, *The Equal Earth map projection*, 2018.
const EQUAL_EARTH: [f64; 4] = [1.340264, -0.081106, 0.000893, 0.003796];

/// Half the root of 3.
const M: f64 = 0.866_025_403_784_438_6;

/// Projects longitude and the sine of the authalic latitude, on a sphere of radius 1.
pub fn equal_earth(lon: f64, sin: f64) -> DVec2 {
    let theta = libm::asin(M * sin);
    let (y, slope) = equal_earth_height(theta);
    DVec2::new(lon * libm::cos(theta) / (M * slope), y)
}

/// Returns the height over the equator, and how it grows.
fn equal_earth_height(theta: f64) -> (f64, f64) {
    let [a1, a2, a3, a4] = EQUAL_EARTH;
    let t2 = theta * theta;
    let t6 = t2 * t2 * t2;
    let y = theta * (a1 + a2 * t2 + t6 * (a3 + a4 * t2));
    (y, a1 + 3.0 * a2 * t2 + t6 * (7.0 * a3 + 9.0 * a4 * t2))
}

/// Returns longitude and the sine of the authalic latitude of a point.
pub fn equal_earth_back(p: DVec2) -> Option<(f64, f64)> {
    let mut theta = p.y;
    for _ in 0..12 {
        let (y, slope) = equal_earth_height(theta);
        let step = (y - p.y) / slope;
        theta -= step;
        if step.abs() < 1e-14 {
            break;
        }
    }
    let sin = libm::sin(theta) / M;
    let (_, slope) = equal_earth_height(theta);
    (sin.abs() <= 1.0 + 1e-9).then(|| (M * p.x * slope / libm::cos(theta), sin.clamp(-1.0, 1.0)))
}

/// Distances of x and y from the middle at every fifth degree of latitude, as cubic pieces: value, slope and further
/// coefficients per degree. The values are A. H. Robinson's, 1974; the pieces are the ones in use in other software, so
/// that maps match.
#[rustfmt::skip]
const ROBINSON_X: [[f32; 4]; 19] = [
    [1.0, 2.2199e-17, -7.15515e-05, 3.1103e-06],
    [0.9986, -0.000482243, -2.4897e-05, -1.3309e-06],
    [0.9954, -0.00083103, -4.48605e-05, -9.86701e-07],
    [0.99, -0.00135364, -5.9661e-05, 3.6777e-06],
    [0.9822, -0.00167442, -4.49547e-06, -5.72411e-06],
    [0.973, -0.00214868, -9.03571e-05, 1.8736e-08],
    [0.96, -0.00305085, -9.00761e-05, 1.64917e-06],
    [0.9427, -0.00382792, -6.53386e-05, -2.6154e-06],
    [0.9216, -0.00467746, -0.00010457, 4.81243e-06],
    [0.8962, -0.00536223, -3.23831e-05, -5.43432e-06],
    [0.8679, -0.00609363, -0.000113898, 3.32484e-06],
    [0.835, -0.00698325, -6.40253e-05, 9.34959e-07],
    [0.7986, -0.00755338, -5.00009e-05, 9.35324e-07],
    [0.7597, -0.00798324, -3.5971e-05, -2.27626e-06],
    [0.7186, -0.00851367, -7.01149e-05, -8.6303e-06],
    [0.6732, -0.00986209, -0.000199569, 1.91974e-05],
    [0.6213, -0.010418, 8.83923e-05, 6.24051e-06],
    [0.5722, -0.00906601, 0.000182, 6.24051e-06],
    [0.5322, -0.00677797, 0.000275608, 6.24051e-06],
];

#[rustfmt::skip]
const ROBINSON_Y: [[f32; 4]; 19] = [
    [-5.20417e-18, 0.0124, 1.21431e-18, -8.45284e-11],
    [0.062, 0.0124, -1.26793e-09, 4.22642e-10],
    [0.124, 0.0124, 5.07171e-09, -1.60604e-09],
    [0.186, 0.0123999, -1.90189e-08, 6.00152e-09],
    [0.248, 0.0124002, 7.10039e-08, -2.24e-08],
    [0.31, 0.0123992, -2.64997e-07, 8.35986e-08],
    [0.372, 0.0124029, 9.88983e-07, -3.11994e-07],
    [0.434, 0.0123893, -3.69093e-06, -4.35621e-07],
    [0.4958, 0.0123198, -1.02252e-05, -3.45523e-07],
    [0.5571, 0.0121916, -1.54081e-05, -5.82288e-07],
    [0.6176, 0.0119938, -2.41424e-05, -5.25327e-07],
    [0.6769, 0.011713, -3.20223e-05, -5.16405e-07],
    [0.7346, 0.0113541, -3.97684e-05, -6.09052e-07],
    [0.7903, 0.0109107, -4.89042e-05, -1.04739e-06],
    [0.8435, 0.0103431, -6.4615e-05, -1.40374e-09],
    [0.8936, 0.00969686, -6.4636e-05, -8.547e-06],
    [0.9394, 0.00840947, -0.000192841, -4.2106e-06],
    [0.9761, 0.00616527, -0.000256, -4.2106e-06],
    [1.0, 0.00328947, -0.000319159, -4.2106e-06],
];

/// Half the width and half the height of the map on a sphere of radius 1, in radians of the equator.
const WIDTH: f64 = 0.8487;
const HEIGHT: f64 = 1.3523;

/// Returns the value of a piece at this many degrees from its start, and how it grows.
fn piece(c: &[f32; 4], z: f64) -> (f64, f64) {
    let [c0, c1, c2, c3] = c.map(f64::from);
    (c0 + z * (c1 + z * (c2 + z * c3)), c1 + z * (2.0 * c2 + z * 3.0 * c3))
}

/// Returns the piece that contains a latitude, and the distance from its start in degrees.
fn at(lat: f64) -> (usize, f64) {
    /// Five degrees in radians, and how many times they are in one.
    const STEP: f64 = 0.087_266_462_599_716_47;
    const STEPS: f64 = 11.459_155_902_616_464;
    // A little more, so that a full fifth degree is in the piece that begins there.
    let i = ((lat.abs() * STEPS + 1e-15) as usize).min(18);
    (i, (lat.abs() - STEP * i as f64).to_degrees())
}

/// Projects longitude and latitude, on a sphere of radius 1.
pub fn robinson(lon: f64, lat: f64) -> DVec2 {
    let (i, z) = at(lat);
    let [x, y] = [&ROBINSON_X, &ROBINSON_Y].map(|table| piece(&table[i], z).0);
    DVec2::new(WIDTH * x * lon, (HEIGHT * y).copysign(lat))
}

/// Returns longitude and latitude of a point.
pub fn robinson_back(p: DVec2) -> Option<(f64, f64)> {
    let height = p.y.abs() / HEIGHT;
    if height > 1.0 + 1e-6 {
        return None;
    }
    if height >= 1.0 {
        let [width, ..] = ROBINSON_X[18];
        return Some((p.x / (WIDTH * f64::from(width)), FRAC_PI_2.copysign(p.y)));
    }
    let i = ROBINSON_Y.iter().rposition(|c| f64::from(c[0]) <= height).unwrap_or(0).min(17);
    let mut z = 5.0 * (height - f64::from(ROBINSON_Y[i][0]))
        / f64::from(ROBINSON_Y[i + 1][0] - ROBINSON_Y[i][0]);
    for _ in 0..50 {
        let (y, slope) = piece(&ROBINSON_Y[i], z);
        let step = (y - height) / slope;
        z -= step;
        if step.abs() < 1e-12 {
            break;
        }
    }
    let lat = ((i as f64) * 5.0 + z).to_radians().min(FRAC_PI_2);
    // The width is computed from the latitude as in the other direction, even if rounding puts it into the next piece.
    let (j, z) = at(lat);
    let x = piece(&ROBINSON_X[j], z).0;
    Some((p.x / (WIDTH * x), lat.copysign(p.y)))
}
