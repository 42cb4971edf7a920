//! Algorithms and their steps.

use crate::args::contiguous;
use crate::error;
use durer::explain::{self, Figure, Frame, Grid, Input, Language, Lesson, Options};
use durer::math::{DVec2, DVec3, Rect};
use durer_cli::embedded;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Shapes of the plane: window, lines, rings, rings of the clip, points.
type Shapes<'py> = (
    Option<[f64; 4]>,
    Vec<PyReadonlyArray2<'py, f64>>,
    Vec<PyReadonlyArray2<'py, f64>>,
    Vec<PyReadonlyArray2<'py, f64>>,
    Option<PyReadonlyArray2<'py, f64>>,
);

/// Input of a lesson.
#[derive(FromPyObject)]
enum Given<'py> {
    Example(String),
    Shapes(Shapes<'py>),
    Picture((PyReadonlyArray2<'py, u8>, [u32; 2])),
    Faces(Vec<PyReadonlyArray2<'py, f64>>),
}

fn points<const N: usize>(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; N]>> {
    let shape = array.shape();
    if shape[1] != N {
        let message = format!("points must be (n, {N}), got ({}, {})", shape[0], shape[1]);
        return Err(PyTypeError::new_err(message));
    }
    Ok(contiguous(array, "points")?.as_chunks::<N>().0.to_vec())
}

fn input(given: &Given<'_>) -> PyResult<Input> {
    let flat = |array: &PyReadonlyArray2<'_, f64>| {
        Ok(points::<2>(array)?.into_iter().map(DVec2::from).collect::<Vec<_>>())
    };
    let many = |arrays: &[PyReadonlyArray2<'_, f64>]| {
        arrays.iter().map(flat).collect::<PyResult<Vec<_>>>()
    };
    Ok(match given {
        Given::Example(name) => Input::Example(name.clone()),
        Given::Shapes((window, lines, rings, clip, own)) => {
            let rect = |[xmin, ymin, xmax, ymax]: [f64; 4]| {
                Rect::new(DVec2::new(xmin, ymin), DVec2::new(xmax, ymax))
            };
            let window = window.map(rect).transpose();
            Input::Figure(Figure {
                window: window.map_err(|e| PyValueError::new_err(format!("window: {e}")))?,
                lines: many(lines)?,
                rings: many(rings)?,
                clip: many(clip)?,
                points: own.as_ref().map(flat).transpose()?.unwrap_or_default(),
            })
        }
        Given::Picture((cells, seed)) => {
            let columns = cells.shape()[1] as u32;
            Input::Grid(Grid { columns, cells: contiguous(cells, "image")?.to_vec(), seed: *seed })
        }
        Given::Faces(faces) => {
            let face = |face| Ok(points::<3>(face)?.into_iter().map(DVec3::from).collect());
            Input::Faces(faces.iter().map(face).collect::<PyResult<_>>()?)
        }
    })
}

fn language(code: &str) -> PyResult<Language> {
    [Language::English, Language::German]
        .into_iter()
        .find(|language| language.code() == code)
        .ok_or_else(|| PyValueError::new_err(format!("language is '{code}'; it must be en or de")))
}

/// Runs a lesson; returns its facts and frames as JSON.
#[pyfunction]
fn trace(
    py: Python<'_>,
    algorithm: &str,
    given: Given<'_>,
    cap: usize,
    code: &str,
) -> PyResult<String> {
    traced(py, algorithm, (&given, cap, code), explain::json)
}

/// Runs a lesson; returns a page with buttons.
#[pyfunction]
fn trace_page(
    py: Python<'_>,
    algorithm: &str,
    given: Given<'_>,
    cap: usize,
    code: &str,
) -> PyResult<String> {
    traced(py, algorithm, (&given, cap, code), embedded::page)
}

/// Runs a lesson; returns the result of `shown` for its frames.
fn traced(
    py: Python<'_>,
    algorithm: &str,
    (given, cap, code): (&Given<'_>, usize, &str),
    shown: fn(&Lesson, &[Frame], Language) -> String,
) -> PyResult<String> {
    let language = language(code)?;
    let input = input(given)?;
    let lesson = explain::lesson(algorithm).map_err(|e| error::of_library(py, &e))?;
    let run = || {
        let frames = lesson.run(&input, &Options::default(), cap)?;
        Ok(shown(lesson, &frames, language))
    };
    py.detach(run).map_err(|e| error::of_library(py, &e))
}

/// Facts of an algorithm: name, title, authors, year, source, cost, limits, class.
type Facts =
    (&'static str, &'static str, &'static str, u16, &'static str, &'static str, &'static str);

/// Returns the facts of all algorithms, in the order of the pipeline.
#[pyfunction]
fn algorithms() -> Vec<Facts> {
    let facts =
        |i: &durer::info::Info| (i.name, i.title, i.authors, i.year, i.source, i.cost, i.limits);
    explain::ALGORITHMS.iter().map(|i| facts(i)).collect()
}

/// Returns the names of algorithms that can be traced, each with its examples.
#[pyfunction]
fn lessons() -> Vec<(&'static str, Vec<&'static str>)> {
    explain::lessons().map(|l| (l.name, l.examples.iter().map(|e| e.name).collect())).collect()
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(trace, m)?)?;
    m.add_function(wrap_pyfunction!(trace_page, m)?)?;
    m.add_function(wrap_pyfunction!(algorithms, m)?)?;
    m.add_function(wrap_pyfunction!(lessons, m)?)
}
