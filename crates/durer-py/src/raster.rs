//! Geometries as pixels of a grid of numbers.

use crate::overlay::check;
use crate::threads::on_threads;
use durer::curve::Contours;
use durer::geometry::{Geometry, Points};
use durer::math::{DAffine2, DVec2, IVec2};
use durer::raster::coverage::{self, FillRule};
use durer::raster::line::{self, bresenham};
use durer::raster::polygon::{Options, PolygonRasterizer};
use durer::target::Pixels;
use durer::trace::NoTrace;
use durer_formats::geo::from_wkb;
use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;

/// Largest side of a grid.
const MOST: u32 = 32_767;

/// Rule that chooses the pixels of areas.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    /// Pixels whose centre is inside.
    Centers,
    /// Pixels with any point in common.
    Touched,
    /// All, weighted by the share inside.
    Coverage,
}

/// A grid whose pixels get values.
struct Grid {
    pixels: Pixels<f64>,
    mode: Mode,
}

/// A part of the grid: first column and row, width and height.
#[derive(Clone, Copy)]
struct Window {
    x: i64,
    y: i64,
    width: u32,
    height: u32,
}

impl Grid {
    fn set(&mut self, x: i64, y: i64, value: f64) {
        if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) {
            self.pixels.set(x, y, value);
        }
    }

    /// Returns the part of the grid around points; `None` if there is none.
    fn window<'a>(&self, points: impl Iterator<Item = &'a DVec2> + Clone) -> Option<Window> {
        let size = DVec2::new(f64::from(self.pixels.width()), f64::from(self.pixels.height()));
        let low = points.clone().fold(DVec2::INFINITY, |a, &b| a.min(b)).floor().max(DVec2::ZERO);
        let high = points.fold(DVec2::NEG_INFINITY, |a, &b| a.max(b)).ceil();
        // A border on a line between pixels touches both.
        let high = (high + 1.0).min(size);
        let extent = high - low;
        (extent.x > 0.0 && extent.y > 0.0).then_some(Window {
            x: low.x as i64,
            y: low.y as i64,
            width: extent.x as u32,
            height: extent.y as u32,
        })
    }

    /// Fills polygons given by their rings, in pixels.
    fn fill(&mut self, rings: &[Vec<DVec2>], value: f64) -> Result<(), String> {
        let Some(window) = self.window(rings.iter().flatten()) else { return Ok(()) };
        let corner = DVec2::new(window.x as f64, window.y as f64);
        let mut contours = Contours::new();
        for ring in rings {
            contours.push(ring.iter().map(|&p| p - corner), true);
        }
        let Window { x, y, width, height } = window;
        if self.mode == Mode::Coverage {
            let options =
                coverage::Options { rule: FillRule::EvenOdd, ..coverage::Options::default() };
            let shares = coverage::fill(&contours, width, height, &options, &mut NoTrace);
            let shares = shares.map_err(|e| e.to_string())?;
            for row in 0..height {
                for (column, &share) in shares.row(row).iter().enumerate().filter(|(_, s)| **s > 0)
                {
                    let (column, row) = ((x + column as i64) as u32, (y + i64::from(row)) as u32);
                    let (share, old) = (f64::from(share) / 255.0, self.pixels.get(column, row));
                    self.pixels.set(
                        column,
                        row,
                        old.unwrap_or(0.0) * (1.0 - share) + value * share,
                    );
                }
            }
            return Ok(());
        }
        let mut spans = Vec::new();
        let options = Options { rule: FillRule::EvenOdd };
        PolygonRasterizer::OrderedEdgeList
            .fill(&contours, width, height, &options, |s| spans.push(s));
        for span in spans {
            (span.x0..span.x1).for_each(|column| {
                self.set(x + i64::from(column), y + i64::from(span.y), value);
            });
        }
        if self.mode == Mode::Touched {
            for ring in rings {
                let ends = ring.iter().zip(ring.iter().cycle().skip(1));
                ends.for_each(|(&a, &b)| self.touch(a, b, value));
            }
        }
        Ok(())
    }

    /// Sets all pixels that a segment has a point in common with, row by row.
    fn touch(&mut self, a: DVec2, b: DVec2, value: f64) {
        let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
        let (rows, columns) = (f64::from(self.pixels.height()), f64::from(self.pixels.width()));
        let x_at =
            |y: f64| if b.y > a.y { a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)) } else { a.x };
        let (first, last) = (a.y.floor().max(0.0), b.y.floor().min(rows - 1.0));
        let mut row = first;
        while row <= last {
            let (top, bottom) = (row.max(a.y), (row + 1.0).min(b.y));
            let (p, q) = if b.y > a.y { (x_at(top), x_at(bottom)) } else { (a.x, b.x) };
            let (from, to) = (p.min(q).floor().max(0.0), p.max(q).floor().min(columns - 1.0));
            (from as i64..=to as i64).for_each(|column| self.set(column, row as i64, value));
            row += 1.0;
        }
    }

    fn line(&mut self, points: &[DVec2], value: f64) {
        for pair in points.windows(2) {
            if self.mode == Mode::Touched {
                self.touch(pair[0], pair[1], value);
                continue;
            }
            let far = f64::from(1 << 24);
            let [from, to] =
                [pair[0], pair[1]].map(|p| p.floor().clamp(DVec2::splat(-far), DVec2::splat(far)));
            let [from, to] = [from, to].map(|p| IVec2::new(p.x as i32, p.y as i32));
            let plot = |p: IVec2| self.set(p.x.into(), p.y.into(), value);
            bresenham::draw(from, to, &line::Options::default(), plot, &mut NoTrace);
        }
    }

    fn burn(&mut self, geometry: &Geometry, to_pixels: DAffine2, value: f64) -> Result<(), String> {
        let moved = |points: &Points| -> Vec<DVec2> {
            points.xy.iter().map(|&p| to_pixels.transform_point2(p)).collect()
        };
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                for p in moved(points) {
                    self.set(p.x.floor() as i64, p.y.floor() as i64, value);
                }
            }
            Geometry::LineString(line) => self.line(&moved(line), value),
            Geometry::MultiLineString(lines) => {
                lines.iter().for_each(|line| self.line(&moved(line), value));
            }
            Geometry::Polygon(rings) => {
                self.fill(&rings.iter().map(moved).collect::<Vec<_>>(), value)?
            }
            Geometry::MultiPolygon(polygons) => {
                for rings in polygons {
                    self.fill(&rings.iter().map(moved).collect::<Vec<_>>(), value)?;
                }
            }
            Geometry::Collection(parts) => {
                for part in parts {
                    self.burn(part, to_pixels, value)?;
                }
            }
        }
        Ok(())
    }
}

/// Sets the pixels of geometries to their values, one geometry after the other; `to_pixels` are the coefficients a, b,
/// c, d, e, f of column = a·x + b·y + c and row = d·x + e·y + f.
#[pyfunction]
fn rasterize<'py>(
    py: Python<'py>,
    shapes: Vec<PyBackedBytes>,
    values: Vec<f64>,
    size: [u32; 2],
    to_pixels: [f64; 6],
    fill: f64,
    mode: &str,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let mode = match mode {
        "centers" => Mode::Centers,
        "touched" => Mode::Touched,
        "coverage" => Mode::Coverage,
        _ => {
            return Err(PyValueError::new_err(format!(
                "mode is '{mode}'; it must be centers or coverage"
            )));
        }
    };
    let [width, height] = size;
    if width.max(height) > MOST || width.min(height) == 0 {
        return Err(PyValueError::new_err(format!(
            "out_shape is ({height}, {width}); sides are 1 to {MOST}"
        )));
    }
    let [a, b, c, d, e, f] = to_pixels;
    let to_pixels = DAffine2::from_cols_array(&[a, d, b, e, c, f]);
    let made = on_threads(py, 1, || {
        let mut grid = Grid { pixels: Pixels::new(width, height, fill), mode };
        for (at, (bytes, value)) in shapes.iter().zip(values).enumerate() {
            let fail = |e: String| format!("shapes[{at}]: {e}");
            let (geometry, _) = from_wkb(bytes).map_err(|e| fail(e.to_string()))?;
            check(&geometry).map_err(fail)?;
            grid.burn(&geometry, to_pixels, value).map_err(fail)?;
        }
        Ok(grid.pixels)
    })?;
    crate::args::plane(py, made.map_err(PyValueError::new_err::<String>)?)
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(rasterize, m)?)
}
