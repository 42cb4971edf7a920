//! Models seen by a camera: pictures, planes, drawings, lines, picking.

use crate::args::{channels, flat, plane, points};
use crate::error;
use crate::model::{CameraNumbers, Model, camera, numbers};
use crate::threads::on_threads;
use durer::math::DVec2;
use durer::scene::{Camera, Projection, Topology};
use durer::target::drawing::{Drawing, LineClass};
use durer::target::{Framebuffer, Pixels};
use durer::view::View;
use durer::view::pick::{PickArea, pick};
use durer_cli::embedded::{self, Rendered};
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// The planes of a picture, its camera, and the reason why nothing is visible, if nothing is.
type Planes<'py> = (
    Bound<'py, PyArray3<u8>>,
    Option<Bound<'py, PyArray2<f32>>>,
    Option<Bound<'py, PyArray2<u32>>>,
    Option<Bound<'py, PyArray3<f32>>>,
    Option<CameraNumbers>,
    Option<String>,
);

/// Renders a picture with the given planes (depth, item, normal); if `linear` is set, depths are distances along the
/// axis, 0 at the background.
#[pyfunction]
fn render<'py>(
    py: Python<'py>,
    model: &Model,
    options: Vec<String>,
    planes: [bool; 3],
    linear: bool,
    threads: usize,
) -> PyResult<Planes<'py>> {
    let rendered = on_threads(py, threads, || {
        let mut rendered = embedded::render(&options, &model.subject(), planes)?;
        if let (true, Some(camera)) = (linear, rendered.camera) {
            rendered.planes.depth.iter_mut().for_each(|depth| make_linear(depth, &camera));
        }
        Ok(rendered)
    })?;
    let Rendered { planes, camera, unseen } = rendered.map_err(|e| error::of_failure(py, &e))?;
    let Framebuffer { color, depth, item, normal, .. } = planes;
    let depth = depth.map(|depth| plane(py, depth)).transpose()?;
    let item = item.map(|item| plane(py, item)).transpose()?;
    let normal = normal.map(|normal| channels(py, normal)).transpose()?;
    Ok((channels(py, color)?, depth, item, normal, camera.as_ref().map(numbers), unseen))
}

/// Converts window depths to distances along the camera's axis; 0 at the background.
fn make_linear(depth: &mut Pixels<f32>, camera: &Camera) {
    let (near, far) = (camera.near, camera.far);
    let distance = |d: f64| match camera.projection {
        Projection::Perspective { .. } => near * far / (far - d * (far - near)),
        Projection::Orthographic { .. } => near + d * (far - near),
    };
    for d in depth.data_mut() {
        *d = if *d < 1.0 { distance(f64::from(*d)) as f32 } else { 0.0 };
    }
}

/// Returns the camera of a picture, with its width and height.
#[pyfunction]
fn fit(
    py: Python<'_>,
    model: &Model,
    options: Vec<String>,
    threads: usize,
) -> PyResult<(CameraNumbers, [u32; 2])> {
    let fitted = on_threads(py, threads, || embedded::camera(&options, &model.subject()))?;
    let (camera, size) = fitted.map_err(|e| error::of_failure(py, &e))?;
    Ok((numbers(&camera), size))
}

/// Returns a drawing as the bytes of a file.
#[pyfunction]
fn draw<'py>(
    py: Python<'py>,
    model: &Model,
    options: Vec<String>,
    suffix: &str,
    threads: usize,
) -> PyResult<Bound<'py, PyBytes>> {
    let drawn = on_threads(py, threads, || embedded::draw(&options, &model.subject(), suffix))?;
    Ok(PyBytes::new(py, &drawn.map_err(|e| error::of_failure(py, &e))?))
}

/// Coordinates, offsets, classes, invisibilities, and whether lines are closed.
type Lines<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<bool>>,
);

/// Returns the lines of a drawing in its plane; classes are indices of `line_classes`.
#[pyfunction]
fn lines<'py>(
    py: Python<'py>,
    model: &Model,
    options: Vec<String>,
    threads: usize,
) -> PyResult<Lines<'py>> {
    let drawn = on_threads(py, threads, || embedded::lines(&options, &model.subject()))?;
    let Drawing { lines, .. } = drawn.map_err(|e| error::of_failure(py, &e))?;
    let class = |class: LineClass| LineClass::ALL.iter().position(|&c| c == class);
    let (mut coords, mut offsets) = (Vec::new(), vec![0]);
    for line in &lines {
        coords.extend_from_slice(&line.points);
        offsets.push(coords.len() as i64);
    }
    let classes = lines.iter().map(|l| class(l.class).unwrap_or(0) as u8).collect();
    Ok((
        points(py, coords)?,
        flat(py, offsets),
        flat(py, classes),
        flat(py, lines.iter().map(|l| l.invisibility).collect()),
        flat(py, lines.iter().map(|l| l.closed).collect()),
    ))
}

/// Returns the names of all classes of lines.
#[pyfunction]
fn line_classes() -> Vec<&'static str> {
    LineClass::ALL.iter().map(|class| class.name()).collect()
}

/// Kind, item, instance, index in the mesh, window depth, and position in the world.
type Picked = (&'static str, u32, usize, usize, f64, [f64; 3]);

/// Returns the hits behind a point of a picture, nearest first.
#[pyfunction]
fn picked(
    py: Python<'_>,
    model: &Model,
    seen_by: CameraNumbers,
    size: [u32; 2],
    at: [f64; 2],
) -> PyResult<Vec<Picked>> {
    let view = View::new(camera(seen_by), size[0], size[1]);
    let view = view.map_err(|e| error::of_library(py, &e))?;
    let hits = py.detach(|| pick(&model.scene, &view, PickArea::Point(DVec2::from(at))));
    let kind = |topology: Topology| match topology {
        Topology::Points => "point",
        Topology::Lines => "line",
        Topology::Triangles => "triangle",
    };
    let tuple = |hit: durer::view::pick::Hit| {
        let position = hit.position.to_array();
        (kind(hit.topology), hit.item, hit.instance, hit.primitive, hit.depth, position)
    };
    Ok(hits.into_iter().map(tuple).collect())
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(render, m)?)?;
    m.add_function(wrap_pyfunction!(fit, m)?)?;
    m.add_function(wrap_pyfunction!(draw, m)?)?;
    m.add_function(wrap_pyfunction!(lines, m)?)?;
    m.add_function(wrap_pyfunction!(line_classes, m)?)?;
    m.add_function(wrap_pyfunction!(picked, m)?)
}
