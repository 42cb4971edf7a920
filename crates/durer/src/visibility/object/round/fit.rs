//! The cylinder that points and normals of a surface lie on.

use crate::math::{DVec2, DVec3};

/// An endless cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surface {
    /// A point of the axis.
    pub point: DVec3,
    /// Axis of unit length.
    pub axis: DVec3,
    pub radius: f64,
}

impl Surface {
    /// Returns the vector from the axis to a point, at a right angle to the axis.
    pub fn spoke(&self, p: DVec3) -> DVec3 {
        let d = p - self.point;
        d - self.axis * d.dot(self.axis)
    }

    /// Returns the distance of a point from the surface.
    pub fn error(&self, p: DVec3) -> f64 {
        (self.spoke(p).length() - self.radius).abs()
    }

    /// Returns two directions at right angles to the axis and each other.
    pub fn across(&self) -> [DVec3; 2] {
        across(self.axis)
    }
}

fn across(axis: DVec3) -> [DVec3; 2] {
    let u = axis.any_orthonormal_vector();
    [u, axis.cross(u)]
}

/// Sums over a growing surface, from which its cylinder follows.
#[derive(Debug, Clone, Default)]
pub(super) struct Sums {
    /// Sums of products of the normals' coordinates, by area: xx, yy, zz, xy, xz, yz.
    normals: [f64; 6],
    area: f64,
    points: Vec<DVec3>,
}

impl Sums {
    /// Adds a triangle with its unit normal; without one only its corners count.
    pub fn add(&mut self, corners: [DVec3; 3], normal: Option<DVec3>) {
        self.points.extend(corners);
        let [a, b, c] = corners;
        let area = (b - a).cross(c - a).length();
        self.area += 0.5 * area;
        let Some(n) = normal else { return };
        let products = [n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z];
        self.normals.iter_mut().zip(products).for_each(|(sum, p)| *sum += p * area);
    }

    /// Returns the area added so far.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns the corners added so far.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Returns the cylinder: its axis is the direction most nearly at right angles to the normals, its circle the best
    /// one in the algebraic sense (I. Kåsa, *A circle fitting procedure and its error analysis*, IEEE Transactions on
    /// Instrumentation and Measurement, 1976). `None` if the points are in line.
    pub fn fit(&self) -> Option<Surface> {
        let axis = smallest_direction(self.normals)?;
        let [u, v] = across(axis);
        let middle = self.points.iter().sum::<DVec3>() / self.points.len().max(1) as f64;
        let flat = |p: &DVec3| DVec2::new(u.dot(*p - middle), v.dot(*p - middle));
        let (center, radius) = circle(self.points.iter().map(flat))?;
        let mut surface = Surface { point: middle + u * center.x + v * center.y, axis, radius };
        if self.points.len() >= MANY {
            // The normals of facets are tilted where rims are divided differently; their corners are not.
            for _ in 0..STEPS {
                surface = nearer(&surface, &self.points).unwrap_or(surface);
            }
        }
        Some(surface)
    }
}

/// Number of corners from which they determine the axis better than the normals do.
const MANY: usize = 18;
/// Steps of refinement: each doubles the number of right digits.
const STEPS: usize = 3;

/// Makes one step of Gauss and Newton towards the cylinder that is nearest to points: the axis tilts and moves, the
/// radius changes. `None` if the points do not determine it.
fn nearer(surface: &Surface, points: &[DVec3]) -> Option<Surface> {
    let [u, v] = surface.across();
    let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let start = surface.point + surface.axis * (middle - surface.point).dot(surface.axis);
    let mut equations = [[0.0; 6]; 5];
    for p in points {
        let spoke = surface.spoke(*p);
        let (x, y) = (spoke.dot(u), spoke.dot(v));
        let far = libm::hypot(x, y);
        if far == 0.0 {
            return None;
        }
        let height = (*p - start).dot(surface.axis) / surface.radius;
        let (x, y) = (x / far, y / far);
        let row = [x, y, height * x, height * y, 1.0, far - surface.radius];
        for (i, equation) in equations.iter_mut().enumerate() {
            equation.iter_mut().zip(row).for_each(|(sum, value)| *sum += row[i] * value);
        }
    }
    let [x, y, tilt_x, tilt_y, radius] = solved(equations)?;
    let axis = surface.axis + (u * tilt_x + v * tilt_y) / surface.radius;
    let found = Surface {
        point: start + u * x + v * y,
        axis: axis.try_normalize()?,
        radius: surface.radius + radius,
    };
    (found.radius > 0.0 && found.point.is_finite()).then_some(found)
}

/// Solves symmetric equations, a column for the right side last; a trace of each unknown's own is added, so that
/// unknowns that the equations do not determine stay near 0.
fn solved(mut m: [[f64; 6]; 5]) -> Option<[f64; 5]> {
    const TRACE: f64 = 1e-10;
    let trace: f64 = (0..5).map(|i| m[i][i]).sum();
    (0..5).for_each(|i| m[i][i] += TRACE * trace);
    for i in 0..5 {
        let pivot = m[i][i];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        let upper = m[i];
        for row in m.iter_mut().skip(i + 1) {
            let share = row[i] / pivot;
            row.iter_mut().zip(upper).for_each(|(value, above)| *value -= share * above);
        }
    }
    let mut x = [0.0; 5];
    for i in (0..5).rev() {
        let known: f64 = (i + 1..5).map(|k| m[i][k] * x[k]).sum();
        x[i] = (m[i][5] - known) / m[i][i];
    }
    Some(x)
}

/// Returns the circle through points around the origin: the least squares of x² + y² − 2ax − 2by −
/// c.
fn circle(points: impl Iterator<Item = DVec2> + Clone) -> Option<(DVec2, f64)> {
    let largest = points.clone().map(DVec2::length_squared).fold(0.0, f64::max);
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    // In units of the largest distance, so that all sums are of one size.
    let unit = largest.sqrt();
    let (mut n, mut xx, mut xy, mut yy, mut xz, mut yz, mut z) =
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for p in points.map(|p| p / unit) {
        let square = p.length_squared();
        n += 1.0;
        (xx, xy, yy) = (xx + p.x * p.x, xy + p.x * p.y, yy + p.y * p.y);
        (xz, yz, z) = (xz + p.x * square, yz + p.y * square, z + square);
    }
    // The sums of x and y are 0.
    let determinant = xx * yy - xy * xy;
    if determinant.is_nan() || determinant <= 1e-18 * (xx + yy) * (xx + yy) {
        return None;
    }
    let center = DVec2::new(xz * yy - yz * xy, yz * xx - xz * xy) * (0.5 / determinant);
    let radius = (z / n + center.length_squared()).sqrt();
    radius.is_finite().then(|| (center * unit, radius * unit))
}

/// Returns the eigenvector of the smallest eigenvalue of a symmetric matrix, by rotations (C. G. J.
/// Jacobi, *Über ein leichtes Verfahren …*, 1846); `None` if it is 0 or not finite.
fn smallest_direction([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Option<DVec3> {
    /// Off-diagonal entries shrink quadratically: six rounds reach the last bit.
    const ROUNDS: usize = 8;
    let mut m = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut vectors = [DVec3::X, DVec3::Y, DVec3::Z];
    let size = xx + yy + zz;
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    for _ in 0..ROUNDS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut m, &mut vectors, p, q);
        }
    }
    let smallest = (0..3).min_by(|&a, &b| m[a][a].total_cmp(&m[b][b]))?;
    vectors.get(smallest)?.try_normalize()
}

/// Rotates a symmetric matrix so that its entry (p, q) becomes 0.
fn rotate(m: &mut [[f64; 3]; 3], vectors: &mut [DVec3; 3], p: usize, q: usize) {
    if m[p][q] == 0.0 {
        return;
    }
    let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cos = 1.0 / (t * t + 1.0).sqrt();
    let sin = t * cos;
    for row in m.iter_mut() {
        let (a, b) = (row[p], row[q]);
        (row[p], row[q]) = (cos * a - sin * b, sin * a + cos * b);
    }
    let (upper, lower) = (m[p], m[q]);
    for (k, (a, b)) in upper.into_iter().zip(lower).enumerate() {
        (m[p][k], m[q][k]) = (cos * a - sin * b, sin * a + cos * b);
    }
    let (a, b) = (vectors[p], vectors[q]);
    (vectors[p], vectors[q]) = (a * cos - b * sin, a * sin + b * cos);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_direction_is_an_eigenvector() {
        let n = [DVec3::new(1.0, 2.0, 0.5).normalize(), DVec3::new(-1.0, 0.3, 0.7).normalize()];
        let mut sums = Sums::default();
        for n in n {
            let [u, v] = across(n);
            sums.add([DVec3::ZERO, u, v], Some(n));
        }
        let axis = smallest_direction(sums.normals).expect("direction");
        assert!(axis.cross(n[0].cross(n[1]).normalize()).length() < 1e-12, "{axis}");
    }

    #[test]
    fn corners_tell_the_axis() {
        let at = |a: f64, z: f64| DVec3::new(3.0 * a.cos() + 1.0, 3.0 * a.sin(), z);
        let points: Vec<DVec3> =
            (0..24).map(|i| at(f64::from(i) * 0.05, f64::from(i % 3) * 2.0)).collect();
        let axis = DVec3::new(0.02, -0.01, 1.0).normalize();
        let mut surface = Surface { point: DVec3::new(1.1, 0.05, 0.0), axis, radius: 3.1 };
        for _ in 0..4 {
            surface = nearer(&surface, &points).expect("step");
        }
        let off = points.iter().map(|p| surface.error(*p)).fold(0.0, f64::max);
        assert!(off < 1e-7 && surface.axis.z > 1.0 - 1e-9, "{surface:?}: {off}");
    }

    #[test]
    fn a_circle_goes_through_its_points() {
        let points = [0.1, 0.7, 2.0, 2.2].map(|a: f64| DVec2::new(a.cos(), a.sin()) * 2.5);
        let middle = points.iter().sum::<DVec2>() / 4.0;
        let (center, radius) = circle(points.iter().map(|p| *p - middle)).expect("circle");
        assert!((center + middle).length() < 1e-12 && (radius - 2.5).abs() < 1e-12);
        let line = [-1.0, 0.0, 1.0].map(|x| DVec2::new(x, 2.0 * x));
        assert_eq!(circle(line.iter().copied()), None);
    }
}
