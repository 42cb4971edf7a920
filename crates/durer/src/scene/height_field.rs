//! Surfaces y = f(x, z), given by their heights over a grid.

use super::{Aabb, Instance, Mesh, Scene};
use crate::math::{DMat4, DVec3};
use crate::{Error, Result};

/// Largest magnitude of a height; greater ones are taken for poles of a function and are missing. Squares of kept
/// heights do not overflow.
const LARGEST: f64 = 1e100;

/// A surface y = f(x, z) over a grid of points with equal distances along x and along z.
///
/// Rows run along x, the first row has the smallest z; seen from the front (from +z, y up) it is the farthest. The
/// heights of some points may be missing: a cell of the grid is part of the surface if all four of its corners are
/// present. A cell is two triangles, divided by the diagonal whose ends differ less in height.
///
/// A surface may be cut off at two [levels](Self::within): parts below or above do not belong to it, and a cell with
/// corners on both sides, which jumps over all that is between, is left out, as poles of functions make them.
///
/// # Guarantees
/// At least one column and one row, at most [`HeightField::MAX_POINTS`] points; finite ranges that
/// increase, except that the range of a single column or row may be one number; heights that are
/// there are finite.
///
/// ```
/// use durer::scene::HeightField;
/// let bowl = HeightField::from_fn([3, 2], [-1.0, 1.0], [0.0, 1.0], |x, z| x * x + z)?;
/// assert_eq!(bowl.height(2, 1), Some(2.0));
/// assert_eq!(bowl.range(), Some([0.0, 2.0]));
/// assert_eq!(bowl.to_scene().triangle_count(), 4);
/// # Ok::<(), durer::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    columns: usize,
    rows: usize,
    x: [f64; 2],
    z: [f64; 2],
    /// Row by row; NaN where missing.
    heights: Vec<f64>,
    /// Heights at which the surface is cut off, below and above.
    levels: Option<[f64; 2]>,
}

/// Diagonal that divides a cell of a height field into its two triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Diagonal {
    /// Diagonal from the corner with the smallest x and z to the one with the largest.
    Rising,
    /// Diagonal from the corner with the largest x and the smallest z to its opposite.
    Falling,
}

impl Diagonal {
    /// Returns the corners of the two triangles, counter-clockwise seen from above; bit 0 of a
    /// corner is its column, bit 1 its row, relative to the cell's first point.
    pub const fn triangles(self) -> [[usize; 3]; 2] {
        match self {
            Self::Rising => [[0, 2, 3], [0, 3, 1]],
            Self::Falling => [[2, 3, 1], [2, 1, 0]],
        }
    }
}

impl HeightField {
    /// The most points a field may have.
    pub const MAX_POINTS: u64 = 1 << 27;

    /// Creates the field of `size` = columns × rows points, given row by row, over the ranges of x
    /// and z.
    ///
    /// Heights that are not finite, or beyond ±1e100, are missing.
    ///
    /// # Errors
    /// [`Error::Limit`] for more than [`Self::MAX_POINTS`] points, [`Error::Parameter`] for no
    /// points, a range that is not finite or does not increase, or another number of heights.
    pub fn new(size: [usize; 2], x: [f64; 2], z: [f64; 2], mut heights: Vec<f64>) -> Result<Self> {
        let count = check(size, x, z)?;
        if heights.len() != count {
            return Err(Error::parameter("number of heights", heights.len(), "columns × rows"));
        }
        for height in &mut heights {
            if height.is_nan() || height.abs() > LARGEST {
                *height = f64::NAN;
            }
        }
        Ok(Self { columns: size[0], rows: size[1], x, z, heights, levels: None })
    }

    /// Returns the field of a function, called with x and z of each point; its values are treated like the heights of
    /// [`Self::new`].
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_fn(
        size: [usize; 2],
        x: [f64; 2],
        z: [f64; 2],
        mut f: impl FnMut(f64, f64) -> f64,
    ) -> Result<Self> {
        let count = check(size, x, z)?;
        let mut heights = Vec::with_capacity(count);
        for row in 0..size[1] {
            let z = between(z, row, size[1]);
            heights.extend((0..size[0]).map(|column| f(between(x, column, size[0]), z)));
        }
        Self::new(size, x, z, heights)
    }

    /// Returns points along x.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns points along z.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns x of the first and the last column.
    pub fn x_range(&self) -> [f64; 2] {
        self.x
    }

    /// Returns z of the first and the last row.
    pub fn z_range(&self) -> [f64; 2] {
        self.z
    }

    /// Returns x of a column.
    pub fn x(&self, column: usize) -> f64 {
        between(self.x, column, self.columns)
    }

    /// Returns z of a row.
    pub fn z(&self, row: usize) -> f64 {
        between(self.z, row, self.rows)
    }

    /// Returns the height of a point; `None` if it is missing or outside the grid.
    pub fn height(&self, column: usize, row: usize) -> Option<f64> {
        if column >= self.columns {
            return None;
        }
        self.heights.get(row * self.columns + column).copied().filter(|h| !h.is_nan())
    }

    /// Returns a point of the surface; `None` if its height is missing.
    pub fn point(&self, column: usize, row: usize) -> Option<DVec3> {
        self.height(column, row).map(|y| DVec3::new(self.x(column), y, self.z(row)))
    }

    /// Returns the number of points without a height.
    pub fn missing(&self) -> usize {
        self.heights.iter().filter(|h| h.is_nan()).count()
    }

    /// Returns the surface, cut off where it is below the first or above the second level. [`Self::height`] still
    /// returns the heights beyond.
    ///
    /// # Errors
    /// [`Error::Parameter`] for levels that are not finite or do not increase.
    pub fn within(self, [low, high]: [f64; 2]) -> Result<Self> {
        if !(low < high && low.is_finite() && high.is_finite()) {
            let value = format!("{low} … {high}");
            let expected = "two finite numbers, the first the smaller";
            return Err(Error::parameter("levels", value, expected));
        }
        Ok(Self { levels: Some([low, high]), ..self })
    }

    /// Returns the levels at which the surface is cut off, if it is.
    pub fn levels(&self) -> Option<[f64; 2]> {
        self.levels
    }

    /// Returns whether a height is between the levels.
    pub(crate) fn keeps(&self, y: f64) -> bool {
        self.levels.is_none_or(|[low, high]| (low..=high).contains(&y))
    }

    /// Returns the lowest and the highest height, between the levels; `None` if all are missing or
    /// beyond them.
    pub fn range(&self) -> Option<[f64; 2]> {
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        // `min` and `max` pass over NaN.
        let [lo, hi] = self.heights.iter().fold(start, |[lo, hi], &h| [lo.min(h), hi.max(h)]);
        let Some([low, high]) = self.levels else { return (lo <= hi).then_some([lo, hi]) };
        let any = self.heights.iter().any(|&h| self.keeps(h));
        any.then_some([lo.max(low), hi.min(high)])
    }

    /// Returns the box around the grid and all heights of the [range](Self::range); `None` if there
    /// are none.
    pub fn bounds(&self) -> Option<Aabb> {
        let [lo, hi] = self.range()?;
        let corner = |x, y, z| DVec3::new(x, y, z);
        Some(Aabb { min: corner(self.x[0], lo, self.z[0]), max: corner(self.x[1], hi, self.z[1]) })
    }

    /// Returns the surface with `f` applied to each height and to the levels; `f` must not reverse their order.
    pub fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        let heights = self.heights.iter().map(|&h| f(h));
        let heights = heights.map(|h| if h.abs() <= LARGEST { h } else { f64::NAN }).collect();
        Self { heights, levels: self.levels.map(|levels| levels.map(&f)), ..*self }
    }

    /// Returns the surface over other ranges.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a range that is not finite or does not increase.
    pub fn with_ranges(self, x: [f64; 2], z: [f64; 2]) -> Result<Self> {
        check([self.columns, self.rows], x, z)?;
        Ok(Self { x, z, ..self })
    }

    /// Returns the surface with other numbers of columns and rows over the same ranges,
    /// interpolated bilinearly; missing where a corner of the cell that a point falls into is
    /// missing.
    ///
    /// # Errors
    /// As [`Self::new`] for the new size.
    pub fn resampled(&self, size: [usize; 2]) -> Result<Self> {
        let place = |i: usize, count: usize, points: usize| {
            let at =
                i as f64 * points.saturating_sub(1) as f64 / count.saturating_sub(1).max(1) as f64;
            let cell = (at as usize).min(points.saturating_sub(2));
            (cell, at - cell as f64)
        };
        let count = check(size, self.x, self.z)?;
        let mut heights = Vec::with_capacity(count);
        for row in 0..size[1] {
            let (r, v) = place(row, size[1], self.rows);
            for column in 0..size[0] {
                let (c, u) = place(column, size[0], self.columns);
                // Points without weight may be missing or beyond the last point.
                let part = |c: usize, r: usize, weight: f64| match weight {
                    0.0 => 0.0,
                    _ => self.height(c, r).unwrap_or(f64::NAN) * weight,
                };
                let far = part(c, r, (1.0 - u) * (1.0 - v)) + part(c + 1, r, u * (1.0 - v));
                let near = part(c, r + 1, (1.0 - u) * v) + part(c + 1, r + 1, u * v);
                heights.push(far + near);
            }
        }
        Ok(Self { levels: self.levels, ..Self::new(size, self.x, self.z, heights)? })
    }

    /// Returns the diagonal of the cell between this point and the next column and row; `None` if a
    /// corner is missing, no part of it is between the levels, or the cell does not exist.
    pub fn cell(&self, column: usize, row: usize) -> Option<Diagonal> {
        let [a, b] = [self.height(column, row)?, self.height(column + 1, row)?];
        let [c, d] = [self.height(column, row + 1)?, self.height(column + 1, row + 1)?];
        if let Some([low, high]) = self.levels {
            let (lowest, highest) = (a.min(b).min(c).min(d), a.max(b).max(c).max(d));
            let beyond = highest < low || lowest > high;
            if beyond || (lowest < low && highest > high) {
                return None;
            }
        }
        let (rising, falling) = ((d - a).abs(), (b - c).abs());
        Some(if falling < rising { Diagonal::Falling } else { Diagonal::Rising })
    }

    /// Returns the triangles of the surface, in single precision, relative to `origin`; front faces
    /// look up.
    ///
    /// A face of the mesh is a cell. Triangles that are cut at a level have vertices of their own. Cost: one pass.
    pub fn to_mesh(&self, origin: DVec3) -> Mesh {
        let (mut positions, mut numbers) = (Vec::new(), Vec::with_capacity(self.heights.len()));
        for row in 0..self.rows {
            for column in 0..self.columns {
                numbers.push(positions.len() as u32);
                let kept = self.point(column, row).filter(|p| self.keeps(p.y));
                positions.extend(kept.map(|p| (p - origin).as_vec3()));
            }
        }
        let (mut indices, mut faces) = (Vec::new(), Vec::new());
        for row in 0..self.rows {
            for column in 0..self.columns {
                let Some(diagonal) = self.cell(column, row) else { continue };
                faces.push((indices.len() / 3) as u32);
                for triangle in diagonal.triangles() {
                    let place = |k: usize| [column + (k & 1), row + (k >> 1)];
                    let mut ring: Vec<DVec3> = triangle
                        .iter()
                        .filter_map(|&k| self.point(place(k)[0], place(k)[1]))
                        .collect();
                    if !cut(&mut ring, self.levels) {
                        let corner = |k| place(k)[1] * self.columns + place(k)[0];
                        indices.extend(triangle.iter().filter_map(|&k| numbers.get(corner(k))));
                        continue;
                    }
                    let first = positions.len() as u32;
                    positions.extend(ring.iter().map(|&p| (p - origin).as_vec3()));
                    let fan = (1..ring.len().saturating_sub(1) as u32).map(|i| [0, i, i + 1]);
                    indices.extend(fan.flatten().map(|i| first + i));
                }
            }
        }
        Mesh { positions, indices: Some(indices), faces, ..Mesh::default() }
    }

    /// Returns a scene of the surface alone, in its place.
    pub fn to_scene(&self) -> Scene {
        let origin = self.bounds().map_or(DVec3::ZERO, |b| b.center());
        let world_from_mesh = DMat4::from_translation(origin);
        let instance = Instance { mesh: 0, world_from_mesh, name: String::new() };
        Scene { meshes: vec![self.to_mesh(origin)], instances: vec![instance], ..Scene::default() }
    }
}

/// Leaves of a convex ring the part between two levels. Returns whether it was cut.
pub(crate) fn cut(ring: &mut Vec<DVec3>, levels: Option<[f64; 2]>) -> bool {
    let Some([low, high]) = levels else { return false };
    if ring.iter().all(|p| (low..=high).contains(&p.y)) {
        return false;
    }
    for (level, sign) in [(low, 1.0), (high, -1.0)] {
        let whole = std::mem::take(ring);
        let inside = |p: &DVec3| (p.y - level) * sign >= 0.0;
        for (i, p) in whole.iter().enumerate() {
            let q = &whole[(i + 1) % whole.len()];
            if inside(p) {
                ring.push(*p);
            }
            if inside(p) != inside(q) {
                // Always from the inside, so that neighbours find the same point.
                let (p, q) = if inside(p) { (p, q) } else { (q, p) };
                let cut = *p + (*q - *p) * ((level - p.y) / (q.y - p.y));
                ring.push(DVec3 { y: level, ..cut });
            }
        }
    }
    true
}

/// Returns the range within 0 … 1 of a segment from one height to another that is between two levels.
pub(crate) fn part_between([from, to]: [f64; 2], levels: Option<[f64; 2]>) -> Option<[f64; 2]> {
    let Some([low, high]) = levels else { return Some([0.0, 1.0]) };
    let (lowest, highest) = (from.min(to), from.max(to));
    if highest < low || lowest > high || (lowest < low && highest > high) {
        return None;
    }
    // Where the segment passes a level.
    let at = |level: f64| ((level - from) / (to - from)).clamp(0.0, 1.0);
    let beyond = |y: f64| if y < low { Some(low) } else { (y > high).then_some(high) };
    let part = [beyond(from).map_or(0.0, at), beyond(to).map_or(1.0, at)];
    (part[0] < part[1]).then_some(part)
}

/// Returns the position of point `i` of `count`; the ends are exact.
fn between([first, last]: [f64; 2], i: usize, count: usize) -> f64 {
    if i + 1 >= count && count > 1 {
        return last;
    }
    let part = i as f64 / count.saturating_sub(1).max(1) as f64;
    first + (last - first) * part
}

/// Returns the number of points, where the size and the ranges are right.
fn check(size: [usize; 2], x: [f64; 2], z: [f64; 2]) -> Result<usize> {
    let count = (size[0] as u64).saturating_mul(size[1] as u64);
    if count == 0 {
        let size = format!("{}x{}", size[0], size[1]);
        return Err(Error::parameter("size of the grid", size, "at least 1x1 points"));
    }
    if count > HeightField::MAX_POINTS {
        let limit = HeightField::MAX_POINTS;
        return Err(Error::Limit {
            what: "number of points of a height field",
            value: count,
            limit,
        });
    }
    for (name, [first, last], n) in [("x range", x, size[0]), ("z range", z, size[1])] {
        let extent = last - first;
        let grows = extent >= LARGEST.recip() || (n == 1 && extent == 0.0);
        if !grows || first.abs().max(last.abs()) > LARGEST {
            let value = format!("{first} … {last}");
            let expected = "two numbers within ±10¹⁰⁰, the first the smaller by 10⁻¹⁰⁰ or more";
            return Err(Error::parameter(name, value, expected));
        }
        // Neighbours that are the same number would be no grid.
        if n > 1 && between([first, last], 1, n) <= first {
            let value = format!("{first} … {last}");
            return Err(Error::parameter(name, value, "wide enough to tell its points apart"));
        }
    }
    Ok(count as usize)
}
