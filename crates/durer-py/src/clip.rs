//! Many segments against a rectangle or a convex ring.

use crate::args::{contiguous, flat};
use crate::error;
use crate::threads::on_threads;
use durer::clip::line::batch::{Clipped, Options, Segments, clip};
use durer::clip::line::{ConvexPolygon, Segment, cyrus_beck};
use durer::math::{DVec2, Rect};
use durer::trace::NoTrace;
use numpy::IntoPyArray;
use numpy::{
    PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;

/// Number of segments given to a thread at a time: their columns and results stay in the second-level cache, and are
/// small enough for the allocator not to request each from the system.
const CHUNK: usize = 1 << 12;

/// Segments with their flags.
type Kept<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, PyArray1<bool>>);

/// Four arrays of coordinates with flags.
type KeptArrays<'py> = ([Bound<'py, PyArray1<f64>>; 4], Bound<'py, PyArray1<bool>>);

fn window(rect: [f64; 4]) -> PyResult<Rect> {
    let [xmin, ymin, xmax, ymax] = rect;
    let wrong = |e: durer::Error| PyValueError::new_err(format!("rect {rect:?}: {e}"));
    Rect::new(DVec2::new(xmin, ymin), DVec2::new(xmax, ymax)).map_err(wrong)
}

fn not_finite(clipped: &Clipped) -> PyResult<()> {
    match clipped.non_finite.first() {
        Some(at) => Err(PyValueError::new_err(format!(
            "segments[{at}] has a coordinate that is not finite"
        ))),
        None => Ok(()),
    }
}

/// Clips segments of four arrays to a rectangle.
fn clipped(window: &Rect, segments: Segments<'_>) -> durer::Result<Clipped> {
    let mut out = Clipped::default();
    clip(window, segments, &Options::default(), &mut out).map(|()| out)
}

fn flags(clipped: &Clipped) -> Vec<bool> {
    (0..clipped.x0.len()).map(|i| clipped.is_accepted(i)).collect()
}

/// Clips segments, given as four arrays, to a rectangle.
#[pyfunction]
fn clip_arrays<'py>(
    py: Python<'py>,
    arrays: [PyReadonlyArray1<'py, f64>; 4],
    rect: [f64; 4],
    threads: usize,
) -> PyResult<KeptArrays<'py>> {
    let window = window(rect)?;
    let [x0, y0, x1, y1] = &arrays;
    let segments = Segments {
        x0: contiguous(x0, "x0")?,
        y0: contiguous(y0, "y0")?,
        x1: contiguous(x1, "x1")?,
        y1: contiguous(y1, "y1")?,
    };
    let clipped = on_threads(py, threads, || clipped(&window, segments))?;
    let clipped = clipped.map_err(|e| error::of_library(py, &e))?;
    not_finite(&clipped)?;
    let kept = flags(&clipped);
    let Clipped { x0, y0, x1, y1, .. } = clipped;
    Ok(([x0, y0, x1, y1].map(|a| flat(py, a)), flat(py, kept)))
}

/// Clips segments, each two points, to a rectangle.
#[pyfunction]
fn clip_segments<'py>(
    py: Python<'py>,
    segments: PyReadonlyArray3<'py, f64>,
    rect: [f64; 4],
    threads: usize,
) -> PyResult<Kept<'py>> {
    let window = window(rect)?;
    let all = contiguous(&segments, "segments")?.as_chunks::<4>().0;
    let made = on_threads(py, threads, || {
        let mut out = vec![[0.0; 4]; all.len()];
        let mut kept = vec![false; all.len()];
        let parts = all.par_chunks(CHUNK).zip(out.par_chunks_mut(CHUNK));
        let firsts: Vec<_> = parts
            .zip(kept.par_chunks_mut(CHUNK))
            .map_init(Columns::default, |columns, ((all, out), kept)| {
                columns.clip(&window, all, out, kept)
            })
            .collect::<durer::Result<_>>()?;
        let first = firsts.iter().enumerate().find_map(|(i, at)| at.map(|at| i * CHUNK + at));
        Ok((out, kept, first))
    })?;
    let (out, kept, first) = made.map_err(|e: durer::Error| error::of_library(py, &e))?;
    if let Some(at) = first {
        let message = format!("segments[{at}] has a coordinate that is not finite");
        return Err(PyValueError::new_err(message));
    }
    packed(py, out, kept)
}

fn packed<'py>(py: Python<'py>, out: Vec<[f64; 4]>, kept: Vec<bool>) -> PyResult<Kept<'py>> {
    let count = out.len();
    let segments = out.into_flattened().into_pyarray(py).reshape([count, 2, 2])?;
    Ok((segments, flat(py, kept)))
}

/// Buffers of a thread, reused for one part of the segments after another.
#[derive(Default)]
struct Columns {
    given: [Vec<f64>; 4],
    clipped: Clipped,
}

impl Columns {
    /// Clips a part of the segments; returns the first of them that is not finite.
    fn clip(
        &mut self,
        window: &Rect,
        all: &[[f64; 4]],
        out: &mut [[f64; 4]],
        kept: &mut [bool],
    ) -> durer::Result<Option<usize>> {
        let Self { given, clipped } = self;
        for (i, column) in given.iter_mut().enumerate() {
            column.clear();
            column.extend(all.iter().map(|segment| segment[i]));
        }
        let [x0, y0, x1, y1] = &*given;
        let options = Options { threads: false, ..Options::default() };
        clip(window, Segments { x0, y0, x1, y1 }, &options, clipped)?;
        for (i, (out, kept)) in out.iter_mut().zip(kept).enumerate() {
            *out = [clipped.x0[i], clipped.y0[i], clipped.x1[i], clipped.y1[i]];
            *kept = clipped.is_accepted(i);
        }
        Ok(clipped.non_finite.first().copied())
    }
}

/// Clips segments, each two points, to a convex ring.
#[pyfunction]
fn clip_segments_to_ring<'py>(
    py: Python<'py>,
    segments: PyReadonlyArray3<'py, f64>,
    ring: PyReadonlyArray2<'py, f64>,
    threads: usize,
) -> PyResult<Kept<'py>> {
    let all = contiguous(&segments, "segments")?.as_chunks::<4>().0;
    let ring: Vec<DVec2> =
        contiguous(&ring, "ring")?.as_chunks::<2>().0.iter().map(|&p| p.into()).collect();
    let ring = ConvexPolygon::new(&ring)
        .map_err(|e| PyValueError::new_err(format!("ring: {e}; durer.clip takes any polygon")))?;
    let (out, kept): (Vec<_>, Vec<_>) = on_threads(py, threads, || {
        let one = |&[x0, y0, x1, y1]: &[f64; 4]| {
            let segment = Segment::new(DVec2::new(x0, y0), DVec2::new(x1, y1));
            // Segments that are not finite have no part inside, and are an error below.
            let part = cyrus_beck::clip_polygon(&ring, segment, &mut NoTrace).unwrap_or_default();
            let Segment { start, end } = part.unwrap_or(segment);
            ([start.x, start.y, end.x, end.y], part.is_some())
        };
        all.par_iter().map(one).unzip()
    })?;
    if let Some(at) = all.iter().position(|s| s.iter().any(|x| !x.is_finite())) {
        let message = format!("segments[{at}] has a coordinate that is not finite");
        return Err(PyValueError::new_err(message));
    }
    packed(py, out, kept)
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(clip_arrays, m)?)?;
    m.add_function(wrap_pyfunction!(clip_segments, m)?)?;
    m.add_function(wrap_pyfunction!(clip_segments_to_ring, m)?)
}
