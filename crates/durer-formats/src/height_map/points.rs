//! Lists of points x, y, z, and tables whose first row and column are coordinates: resampled to an even grid.

use super::{Grid, HeightMapOptions, check_size};
use crate::wording::agreeing;
use crate::{Error, Place, Result, Warning};
use spade::{DelaunayTriangulation, FloatTriangulation, HasPosition, Point2, Triangulation};

/// Steps of a grid may differ by this part of them: files round coordinates.
const EVEN: f64 = 1e-3;

/// Smallest and largest number of columns and rows of the grid for scattered points.
const SIDES: [usize; 2] = [16, 512];

/// Returns the even grid of a table of three columns, if its rows are points x, y, z: each x with each y once, or if
/// `is_list` is set. Scattered points are interpolated within their Delaunay triangles.
pub fn gridded(table: &Grid, is_list: bool, options: &HeightMapOptions) -> Result<Option<Grid>> {
    let points = table.heights.as_chunks::<3>().0;
    if let Some(lattice) = lattice(points, options)? {
        return Ok(Some(Grid { format: "CSV, points".to_owned(), ..lattice }));
    }
    if is_list { scattered(points, options).map(Some) } else { Ok(None) }
}

/// Returns the distinct values of a coordinate, rising.
fn distinct(points: &[[f64; 3]], axis: usize) -> Vec<f64> {
    let mut values: Vec<f64> = points.iter().map(|p| p[axis] + 0.0).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// Returns the grid of points that have each x with each y once.
fn lattice(points: &[[f64; 3]], options: &HeightMapOptions) -> Result<Option<Grid>> {
    if points.iter().any(|p| !p[0].is_finite() || !p[1].is_finite()) {
        return Ok(None);
    }
    let (x, y) = (distinct(points, 0), distinct(points, 1));
    if x.len() < 2 || y.len() < 2 || x.len().checked_mul(y.len()) != Some(points.len()) {
        return Ok(None);
    }
    check_size(x.len() as u64, y.len() as u64, &options.limits)?;
    let mut heights = vec![None; points.len()];
    for [px, py, height] in points {
        let column = x.partition_point(|v| v < px);
        // The farthest row is the first.
        let row = y.len() - 1 - y.partition_point(|v| v < py);
        match heights.get_mut(row * x.len() + column) {
            Some(place) if place.is_none() => *place = Some(*height),
            _ => return Ok(None),
        }
    }
    let heights = heights.into_iter().map(|h| h.unwrap_or(f64::NAN)).collect();
    Ok(Some(spread(&x, &y, heights)))
}

/// Returns a grid on rising coordinates, the farthest row first, evenly spaced; heights between them are
/// interpolated where they were not even.
fn spread(x: &[f64], y: &[f64], heights: Vec<f64>) -> Grid {
    let (columns, rows) = (x.len(), y.len());
    let ends = |v: &[f64]| v.first().copied().zip(v.last().copied()).unwrap_or_default();
    let ((west, east), (south, north)) = (ends(x), ends(y));
    let mut warnings = Vec::new();
    let mut even = heights;
    if !is_even(x) || !is_even(y) {
        let message =
            "the coordinates are not evenly spaced; heights are interpolated where they are";
        warnings.push(Warning { place: Place::Whole, message: message.to_owned() });
        let south_first: Vec<f64> = even.rchunks_exact(columns).flatten().copied().collect();
        let at = |column: usize, row: usize| {
            let (i, u) = between(x, column);
            let (j, v) = between(y, row);
            let h =
                |i: usize, j: usize| south_first.get(j * columns + i).copied().unwrap_or(f64::NAN);
            // A missing height matters only if its weight is not 0.
            let mix = |a: f64, b: f64, part: f64| match part {
                0.0 => a,
                1.0 => b,
                _ => a + (b - a) * part,
            };
            mix(mix(h(i, j), h(i + 1, j), u), mix(h(i, j + 1), h(i + 1, j + 1), u), v)
        };
        let cells = (0..rows).rev().flat_map(|row| (0..columns).map(move |column| (column, row)));
        even = cells.map(|(column, row)| at(column, row)).collect();
    }
    Grid {
        columns,
        rows,
        heights: even,
        place: Some([west, east, south, north]),
        format: String::new(),
        warnings,
    }
}

/// Returns the interval of rising values that holds the place `index` of an even grid over all of them, and
/// where in it.
fn between(values: &[f64], index: usize) -> (usize, f64) {
    let last = values.len().saturating_sub(1);
    let (low, high) = (values[0], values[last]);
    let wanted = low + (high - low) * index as f64 / last.max(1) as f64;
    let next = values.partition_point(|v| *v <= wanted).clamp(1, last);
    let (a, b) = (values[next - 1], values[next]);
    (next - 1, ((wanted - a) / (b - a)).clamp(0.0, 1.0))
}

fn is_even(values: &[f64]) -> bool {
    let (Some(first), Some(last)) = (values.first(), values.last()) else { return true };
    let step = (last - first) / values.len().saturating_sub(1).max(1) as f64;
    values.windows(2).all(|pair| ((pair[1] - pair[0]) / step - 1.0).abs() <= EVEN)
}

/// A point of a list, with its height.
struct Spot {
    at: Point2<f64>,
    height: f64,
}

impl HasPosition for Spot {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// The coordinates that can be triangulated.
const NEEDED: &str =
    "their coordinates must be 0, or between 1.8e-43 and 3.2e60 to either side of it";

/// Interpolates scattered points on a grid; heights outside of their hull are missing.
fn scattered(points: &[[f64; 3]], options: &HeightMapOptions) -> Result<Grid> {
    let of_file = |message: String| Warning { place: Place::Whole, message };
    let whole: Vec<&[f64; 3]> = points.iter().filter(|p| p.iter().all(|v| v.is_finite())).collect();
    let spot = |p: &&[f64; 3]| Spot { at: Point2::new(p[0], p[1]), height: p[2] };
    let spots = whole.iter().map(spot).collect();
    let triangles = DelaunayTriangulation::<Spot>::bulk_load(spots);
    let triangles = triangles
        .map_err(|_| Error::whole(format!("the points cannot be triangulated: {NEEDED}")))?;
    let known = triangles.num_vertices();
    if triangles.num_inner_faces() == 0 {
        let message = "a surface needs three points x, y, z at least that are not on one line";
        return Err(Error::whole(message));
    }
    let mut warnings = Vec::new();
    if whole.len() < points.len() {
        let count = (points.len() - whole.len()) as u64;
        warnings.push(of_file(agreeing(count, "{point has|points have} no place or height")));
    }
    if known < whole.len() {
        let words = "{point has the place of another|points have the place of others}; the last height counts";
        warnings.push(of_file(agreeing((whole.len() - known) as u64, words)));
    }
    let range = |axis: usize| {
        let values = || whole.iter().map(|p| p[axis]);
        [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
    };
    let (x, y) = (range(0), range(1));
    // About as many places as there are points, as many along x as along y.
    let side =
        ((known as f64).sqrt() * 1.5).ceil().clamp(SIDES[0] as f64, SIDES[1] as f64) as usize;
    check_size(side as u64, side as u64, &options.limits)?;
    let barycentric = triangles.barycentric();
    let place = |[low, high]: [f64; 2], i: usize| low + (high - low) * i as f64 / (side - 1) as f64;
    let cells = (0..side).rev().flat_map(|row| (0..side).map(move |column| (column, row)));
    let height = |(column, row): (usize, usize)| {
        let at = Point2::new(place(x, column), place(y, row));
        barycentric.interpolate(|v| v.data().height, at).unwrap_or(f64::NAN)
    };
    let heights = cells.map(height).collect();
    let message =
        format!("{known} points are put on a grid of {side} × {side}, by Delaunay triangles");
    warnings.push(of_file(message));
    let place = Some([x[0], x[1], y[0], y[1]]);
    let format = "CSV, points".to_owned();
    Ok(Grid { columns: side, rows: side, heights, place, format, warnings })
}

/// Returns the grid of a table whose first row and column, after a first cell that says nothing, are coordinates that
/// rise or fall.
pub fn with_coordinates(table: &Grid) -> Option<Grid> {
    let (columns, rows) = (table.columns, table.rows);
    if columns < 3 || rows < 3 || !table.heights.first()?.is_nan() {
        return None;
    }
    let mut x = table.heights.get(1..columns)?.to_vec();
    let mut y: Vec<f64> = table.heights.chunks_exact(columns).skip(1).map(|row| row[0]).collect();
    let (rises, falls) =
        (|v: &[f64]| v.is_sorted_by(|a, b| a < b), |v: &[f64]| v.is_sorted_by(|a, b| a > b));
    if !(rises(&x) || falls(&x)) || !(rises(&y) || falls(&y)) {
        return None;
    }
    let mut lines: Vec<Vec<f64>> =
        table.heights.chunks_exact(columns).skip(1).map(|row| row[1..].to_vec()).collect();
    if falls(&x) {
        x.reverse();
        lines.iter_mut().for_each(|line| line.reverse());
    }
    // The farthest row is the first.
    if rises(&y) {
        lines.reverse();
    } else {
        y.reverse();
    }
    let grid = spread(&x, &y, lines.concat());
    Some(Grid { format: "CSV, coordinates in the first row and column".to_owned(), ..grid })
}
