//! Pictures: encoded, filled, warped; plots, maps and tiles.

use crate::args::{channels, contiguous, pixels, plane};
use crate::error;
use crate::model::{CameraNumbers, camera};
use crate::threads::on_threads;
use durer::raster::seed_fill::{Connectivity, Options, SeedFill, boundary_fill, flood_fill};
use durer::scene::HeightField;
use durer::target::Pixels;
use durer::trace::NoTrace;
use durer::view::warp;
use durer::work::Work;
use durer_cli::embedded;
use durer_formats::height_map::HeightMap;
use durer_formats::picture::{Encoding, PictureFormat, write};
use durer_formats::png::Compression;
use numpy::{PyArray2, PyArray3, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::path::PathBuf;

/// Encodes a picture as PNG, JPEG or WebP.
#[pyfunction]
fn encode<'py>(
    py: Python<'py>,
    picture: PyReadonlyArray3<'py, u8>,
    suffix: &str,
    quality: u8,
    small: bool,
) -> PyResult<Bound<'py, PyBytes>> {
    let picture = pixels::<4>(&picture, "pixels")?;
    let format = PictureFormat::of_suffix(suffix).ok_or_else(|| {
        PyValueError::new_err(format!(
            "'{suffix}' is not a format of pictures; there are png, jpg and webp"
        ))
    })?;
    let compression = if small { Compression::Small } else { Compression::Fast };
    let encoded = py.detach(|| {
        let mut bytes = Vec::new();
        write(&mut bytes, format, &picture, &Encoding { compression, quality }).map(|_| bytes)
    });
    Ok(PyBytes::new(py, &encoded.map_err(|e| error::of_reader(py, e, ""))?))
}

/// Writes a file as a whole or not at all.
#[pyfunction]
fn deliver(py: Python<'_>, path: PathBuf, bytes: &[u8]) -> PyResult<()> {
    let written = py.detach(|| embedded::deliver(&path, bytes));
    written.map_err(|e| pyo3::exceptions::PyOSError::new_err(e.to_string()))
}

/// Fills the area around pixels; returns the picture and how many pixels each fill reached.
#[pyfunction]
fn fill<'py>(
    py: Python<'py>,
    picture: PyReadonlyArray3<'py, u8>,
    seeds: Vec<[u32; 2]>,
    color: [u8; 4],
    tolerance: u8,
    boundary: Option<[u8; 4]>,
    eight: bool,
) -> PyResult<(Bound<'py, PyArray3<u8>>, Vec<u64>)> {
    let mut picture = pixels::<4>(&picture, "image")?;
    let connectivity = if eight { Connectivity::Eight } else { Connectivity::Four };
    let options = Options { connectivity, ..Options::default() };
    if let Some([x, y]) = seeds.iter().find(|[x, y]| picture.get(*x, *y).is_none()) {
        let (width, height) = (picture.width(), picture.height());
        return Err(PyIndexError::new_err(format!(
            "at ({x}, {y}) is outside the picture of {width}x{height}"
        )));
    }
    let counts = py.detach(|| {
        let way = SeedFill::Spans;
        let fill = |[x, y]: [u32; 2]| match boundary {
            Some(to) => boundary_fill(
                &mut picture,
                (x, y),
                color,
                to,
                tolerance,
                way,
                &options,
                &mut NoTrace,
            ),
            None => flood_fill(&mut picture, (x, y), color, tolerance, way, &options, &mut NoTrace),
        };
        seeds.iter().copied().map(fill).collect::<durer::Result<Vec<u64>>>()
    });
    let counts = counts.map_err(|e| error::of_library(py, &e))?;
    Ok((channels(py, picture)?, counts))
}

/// A warped picture, the number of the source of each pixel, and the number of holes.
type WarpedArrays<'py> = (Bound<'py, PyArray3<u8>>, Bound<'py, PyArray2<u32>>, u64);

/// Computes the view of a camera from pictures with window depths.
#[pyfunction]
fn warped<'py>(
    py: Python<'py>,
    sources: Vec<(PyReadonlyArray3<'py, u8>, PyReadonlyArray2<'py, f32>, CameraNumbers)>,
    to: CameraNumbers,
    size: [u32; 2],
    hole: [u8; 4],
    threads: usize,
) -> PyResult<WarpedArrays<'py>> {
    let mut owned = Vec::new();
    for (color, depth, from) in &sources {
        let color = pixels::<4>(color, "image")?;
        let (rows, columns) = (depth.shape()[0], depth.shape()[1]);
        if [columns, rows] != [color.width() as usize, color.height() as usize] {
            let (width, height) = (color.width(), color.height());
            let message = format!(
                "depth must be ({height}, {width}) as its picture, got ({rows}, {columns})"
            );
            return Err(PyTypeError::new_err(message));
        }
        let data = contiguous(depth, "depth")?.to_vec();
        let depth = Pixels::from_data(color.width(), color.height(), data);
        owned.push((color, depth.map_err(|e| error::of_library(py, &e))?, camera(*from)));
    }
    let warped = on_threads(py, threads, || {
        let sources: Vec<warp::DepthPicture> = owned
            .iter()
            .map(|(color, depth, camera)| warp::DepthPicture { color, depth, camera: *camera })
            .collect();
        let options = warp::Options { hole, work: Work::default() };
        sources.iter().try_for_each(|s| s.camera.check())?;
        camera(to).check()?;
        warp::warp(&sources, &camera(to), size, &options, &mut NoTrace)
    })?;
    let warped = warped.map_err(|e| error::of_library(py, &e))?;
    Ok((channels(py, warped.framebuffer.color)?, plane(py, warped.source)?, warped.holes))
}

/// Creates a height map from rows of heights.
fn height_map(
    py: Python<'_>,
    heights: &PyReadonlyArray2<'_, f64>,
    [x, z]: [[f64; 2]; 2],
) -> PyResult<HeightMap> {
    let size = [heights.shape()[1], heights.shape()[0]];
    let field = HeightField::new(size, x, z, contiguous(heights, "z")?.to_vec());
    let field = field.map_err(|e| error::of_library(py, &e))?;
    Ok(HeightMap { field, on_map: false, format: "array".to_owned(), warnings: Vec::new() })
}

/// Plots heights as the bytes of a vector file.
#[pyfunction]
fn plot<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'py, f64>,
    ranges: [[f64; 2]; 2],
    options: Vec<String>,
    suffix: &str,
    threads: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    let map = height_map(py, &heights, ranges)?;
    let plotted = on_threads(py, threads, || embedded::plot(&options, map, suffix))?;
    Ok(PyBytes::new(py, &plotted.map_err(|e| error::of_failure(py, &e))?))
}

/// Plots heights as pixels.
#[pyfunction]
fn plot_pixels<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'py, f64>,
    ranges: [[f64; 2]; 2],
    options: Vec<String>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let map = height_map(py, &heights, ranges)?;
    let plotted = on_threads(py, threads, || embedded::plot_pixels(&options, map))?;
    channels(py, plotted.map_err(|e| error::of_failure(py, &e))?)
}

/// Draws an SVG or the layers of a map.
#[pyfunction]
fn draw_layers<'py>(
    py: Python<'py>,
    words: Vec<String>,
    layers: Vec<Vec<u8>>,
    threads: usize,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let drawn = on_threads(py, threads, || embedded::draw_layers(&words, layers))?;
    channels(py, drawn.map_err(|e| error::of_failure(py, &e))?)
}

/// Draws an SVG or the layers of a map as the bytes of a vector file.
#[pyfunction]
fn draw_vectors<'py>(
    py: Python<'py>,
    words: Vec<String>,
    layers: Vec<Vec<u8>>,
    suffix: &str,
    threads: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    let drawn = on_threads(py, threads, || embedded::draw_vectors(&words, layers, suffix))?;
    Ok(PyBytes::new(py, &drawn.map_err(|e| error::of_failure(py, &e))?))
}

/// Cuts files of map data into tiles.
#[pyfunction]
fn tiles(py: Python<'_>, words: Vec<String>, threads: usize) -> PyResult<()> {
    let made = on_threads(py, threads, || embedded::tiles(&words))?;
    made.map_err(|e| error::of_failure(py, &e))
}

/// Returns a colour of CSS as sRGB bytes with straight alpha.
#[pyfunction]
fn css_color(text: &str) -> PyResult<[u8; 4]> {
    durer_formats::css::color(text).ok_or_else(|| {
        PyValueError::new_err(format!("'{text}' is not a colour of CSS, as red or #ff0000"))
    })
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(encode, m)?)?;
    m.add_function(wrap_pyfunction!(deliver, m)?)?;
    m.add_function(wrap_pyfunction!(fill, m)?)?;
    m.add_function(wrap_pyfunction!(warped, m)?)?;
    m.add_function(wrap_pyfunction!(plot, m)?)?;
    m.add_function(wrap_pyfunction!(plot_pixels, m)?)?;
    m.add_function(wrap_pyfunction!(draw_layers, m)?)?;
    m.add_function(wrap_pyfunction!(draw_vectors, m)?)?;
    m.add_function(wrap_pyfunction!(tiles, m)?)?;
    m.add_function(wrap_pyfunction!(css_color, m)?)
}
