//! Tables of geometries, as well-known binary or ragged arrays: one result for each, in parallel.

use crate::args::{contiguous, flat};
use crate::geometry::{Kind, Ragged, RaggedOut, Row};
use crate::overlay::{self, clip, mask, op, rules};
use crate::threads::on_threads;
use durer::clip::mask::{Mask, Rules};
use durer::clip::polygon::validity::{Touching, is_valid};
use durer::clip::polygon::{BooleanOp, Shapes};
use durer::geometry::{Geometry, Points};
use durer::math::{DVec2, Rect};
use durer_formats::geo::{from_wkb, to_wkb};
use numpy::{
    IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;
use rayon::prelude::*;

/// Smallest number of features for a thread.
const LEAST: usize = 16;

/// Region to clip to: a rectangle, or polygons as well-known binary.
#[derive(FromPyObject)]
enum Region {
    Rect([f64; 4]),
    Polygons(Vec<PyBackedBytes>),
}

impl Region {
    fn mask(&self) -> Result<Mask, String> {
        match self {
            Self::Rect(rect) => {
                let [xmin, ymin, xmax, ymax] = *rect;
                let window = Rect::new(DVec2::new(xmin, ymin), DVec2::new(xmax, ymax));
                window.and_then(Mask::window).map_err(|e| format!("rect {rect:?}: {e}"))
            }
            Self::Polygons(all) => {
                let read = |(at, bytes): (usize, &PyBackedBytes)| match from_wkb(bytes) {
                    Ok((geometry, _)) => Ok(geometry),
                    Err(e) => Err(format!("mask[{at}]: {e}")),
                };
                mask(&all.iter().enumerate().map(read).collect::<Result<Vec<_>, _>>()?)
            }
        }
    }
}

/// Work to do with each feature.
enum Task<'a> {
    Clip(&'a Mask),
    Overlay(BooleanOp),
}

impl Task<'_> {
    fn run(
        &self,
        geometry: &Geometry,
        other: Option<&Geometry>,
        rules: &Rules,
    ) -> Result<Option<Geometry>, String> {
        match (self, other) {
            (Self::Clip(mask), _) => clip(geometry, mask, rules),
            (Self::Overlay(op), Some(other)) => overlay::overlay(geometry, other, *op, rules),
            (Self::Overlay(_), None) => Ok(None),
        }
    }
}

/// Returns an empty geometry of the same kind.
fn emptied(geometry: &Geometry) -> Geometry {
    match geometry {
        Geometry::Point(_) => Geometry::Point(Points::default()),
        Geometry::LineString(_) => Geometry::LineString(Points::default()),
        Geometry::Polygon(_) => Geometry::Polygon(Vec::new()),
        Geometry::MultiPoint(_) => Geometry::MultiPoint(Points::default()),
        Geometry::MultiLineString(_) => Geometry::MultiLineString(Vec::new()),
        Geometry::MultiPolygon(_) => Geometry::MultiPolygon(Vec::new()),
        Geometry::Collection(_) => Geometry::Collection(Vec::new()),
    }
}

/// Runs the task on one feature, from and to well-known binary.
fn one(
    task: &Task<'_>,
    rules: &Rules,
    bytes: &[u8],
    other: Option<&[u8]>,
) -> Result<Vec<u8>, String> {
    let (geometry, srid) = from_wkb(bytes).map_err(|e| e.to_string())?;
    let other = other.map(from_wkb).transpose().map_err(|e| format!("the other one: {e}"))?;
    let made = task.run(&geometry, other.as_ref().map(|(g, _)| g), rules)?;
    let made = made.unwrap_or_else(|| emptied(&geometry));
    let mut out = Vec::with_capacity(bytes.len());
    to_wkb(&mut out, &made, srid).map_err(|e| e.to_string())?;
    Ok(out)
}

/// Results of rows; `None` for rows without a geometry.
type Made<T> = Vec<Option<Result<T, String>>>;

/// Rows that failed, with the reasons.
type Errors = Vec<(usize, String)>;

/// Runs a function for each row, in parallel.
fn each<T: Send>(
    count: usize,
    row: impl Fn(usize) -> Option<Result<T, String>> + Send + Sync,
) -> Made<T> {
    (0..count).into_par_iter().with_min_len(LEAST).map(row).collect()
}

/// Separates the results from the errors.
fn parted<T>(made: Made<T>) -> (Vec<Option<T>>, Errors) {
    let mut errors = Vec::new();
    let result = |(at, made): (usize, Option<Result<T, String>>)| match made? {
        Ok(value) => Some(value),
        Err(e) => {
            errors.push((at, e));
            None
        }
    };
    (made.into_iter().enumerate().map(result).collect(), errors)
}

/// Rows of well-known binary.
type Binary<'py> = Vec<Option<Bound<'py, PyBytes>>>;

fn binary<'py>(py: Python<'py>, rows: Vec<Option<Vec<u8>>>) -> Binary<'py> {
    rows.into_iter().map(|row| row.map(|bytes| PyBytes::new(py, &bytes))).collect()
}

/// Clips rows of well-known binary to a region.
#[pyfunction]
fn clip_wkb<'py>(
    py: Python<'py>,
    rows: Vec<Option<PyBackedBytes>>,
    region: Region,
    grid: Option<f64>,
    threads: usize,
) -> PyResult<(Binary<'py>, Errors)> {
    let made = on_threads(py, threads, || {
        let (mask, rules) = (region.mask()?, rules(grid));
        let task = Task::Clip(&mask);
        Ok(each(rows.len(), |at| Some(one(&task, &rules, rows[at].as_ref()?, None))))
    })?;
    let (rows, errors) = parted(made.map_err(PyValueError::new_err::<String>)?);
    Ok((binary(py, rows), errors))
}

/// Overlays rows of well-known binary, each with the row at the same index.
#[pyfunction]
fn overlay_wkb<'py>(
    py: Python<'py>,
    a: Vec<Option<PyBackedBytes>>,
    b: Vec<Option<PyBackedBytes>>,
    operation: &str,
    grid: Option<f64>,
    threads: usize,
) -> PyResult<(Binary<'py>, Errors)> {
    let task = Task::Overlay(op(operation).map_err(PyValueError::new_err)?);
    let rules = rules(grid);
    let made = on_threads(py, threads, || {
        each(a.len().min(b.len()), |at| {
            let (a, b) = (a[at].as_ref()?, b[at].as_ref()?);
            Some(one(&task, &rules, a, Some(b)))
        })
    })?;
    let (rows, errors) = parted(made);
    Ok((binary(py, rows), errors))
}

/// Bytes, offsets and errors of a column.
type Column<'py> = (Bound<'py, PyArray1<u8>>, Bound<'py, PyArray1<i64>>, Errors);

/// Clips a column of well-known binary, given by its bytes and offsets, to a region; rows that are not `valid`, and
/// failed ones, are empty.
#[pyfunction]
fn clip_column<'py>(
    py: Python<'py>,
    data: PyReadonlyArray1<'py, u8>,
    offsets: PyReadonlyArray1<'py, i64>,
    valid: Option<PyReadonlyArray1<'py, bool>>,
    region: Region,
    grid: Option<f64>,
    threads: usize,
) -> PyResult<Column<'py>> {
    let (data, offsets) = (contiguous(&data, "data")?, contiguous(&offsets, "offsets")?);
    let valid = valid.as_ref().map(|valid| contiguous(valid, "valid")).transpose()?;
    let count = offsets.len().saturating_sub(1);
    let row = |at: usize| {
        let range = usize::try_from(offsets[at]).ok()?..usize::try_from(offsets[at + 1]).ok()?;
        data.get(range)
    };
    let is_valid = |at: usize| valid.is_none_or(|valid| valid.get(at) == Some(&true));
    if let Some(at) = (0..count).find(|&at| row(at).is_none()) {
        return Err(PyValueError::new_err(format!("offsets[{at}] is not within the data")));
    }
    let made = on_threads(py, threads, || {
        let (mask, rules) = (region.mask()?, rules(grid));
        let task = Task::Clip(&mask);
        let made = each(count, |at| {
            is_valid(at).then(|| one(&task, &rules, row(at).unwrap_or_default(), None))
        });
        let (rows, errors) = parted(made);
        let mut ends = vec![0];
        let mut bytes = Vec::with_capacity(data.len());
        for row in rows {
            bytes.extend_from_slice(row.as_deref().unwrap_or_default());
            ends.push(bytes.len() as i64);
        }
        Ok((bytes, ends, errors))
    })?;
    let (bytes, ends, errors) = made.map_err(PyValueError::new_err::<String>)?;
    Ok((flat(py, bytes), flat(py, ends), errors))
}

/// A kind, coordinates and offsets.
type RaggedArrays<'py> = (u8, Bound<'py, PyArray2<f64>>, Vec<Bound<'py, PyArray1<i64>>>);

/// Ragged arrays as arguments.
type Given<'py> = (u8, PyReadonlyArray2<'py, f64>, Vec<PyReadonlyArray1<'py, i64>>);

fn ragged<'a>((kind, coords, offsets): &'a Given<'_>) -> PyResult<Ragged<'a>> {
    let width = coords.shape()[1];
    if !(2..=3).contains(&width) {
        let rows = coords.shape()[0];
        return Err(PyTypeError::new_err(format!(
            "coords must be (n, 2) or (n, 3), got ({rows}, {width})"
        )));
    }
    let offsets = offsets.iter().map(|o| contiguous(o, "offsets")).collect::<PyResult<_>>()?;
    let kind = Kind::of_number(*kind).map_err(PyTypeError::new_err)?;
    let ragged = Ragged { kind, coords: contiguous(coords, "coords")?, width, offsets };
    ragged.check().map_err(PyValueError::new_err)?;
    Ok(ragged)
}

fn arrays(py: Python<'_>, out: RaggedOut) -> PyResult<RaggedArrays<'_>> {
    let RaggedOut { kind, coords, width, offsets } = out;
    let count = coords.len() / width;
    let coords = coords.into_pyarray(py).reshape([count, width])?;
    Ok((kind as u8, coords, offsets.into_iter().map(|o| flat(py, o)).collect()))
}

/// Number of rows of ragged arrays that a thread works on at a time: few enough for its cache.
const RUN: usize = 256;

/// Runs a function for each row of ragged arrays, in parallel, with a scratch buffer. Returns runs of results, one after
/// the other, or the first error.
fn runs<T: Send>(
    count: usize,
    row: impl Fn(usize, &mut Shapes) -> Result<T, String> + Send + Sync,
) -> Result<Vec<Vec<T>>, String> {
    let run = |first: usize| {
        let mut scratch = Shapes::new();
        let rows = first..count.min(first + RUN);
        rows.map(|at| row(at, &mut scratch).map_err(|e| format!("geometries[{at}]: {e}"))).collect()
    };
    let made: Vec<Result<Vec<T>, String>> =
        (0..count.div_ceil(RUN)).into_par_iter().map(|at| run(at * RUN)).collect();
    made.into_iter().collect()
}

/// Clips a row of ragged arrays; rows away from the mask's border are decided without building a geometry.
fn clip_row(
    ragged: &Ragged<'_>,
    at: usize,
    mask: &Mask,
    rules: &Rules,
    scratch: &mut Shapes,
) -> Result<Row, String> {
    let side = ragged.bounds(at).and_then(|bounds| mask.side(&bounds));
    let mut stays =
        || rules.grid.is_none() && ragged.fill(at, scratch) && is_valid(scratch, Touching::No);
    match side {
        Some(false) => Ok(Row::Made(None)),
        Some(true) if stays() => Ok(Row::Whole(at)),
        _ => clip(&ragged.geometry(at), mask, rules).map(Row::Made),
    }
}

/// Clips ragged arrays to a region.
#[pyfunction]
fn clip_ragged<'py>(
    py: Python<'py>,
    given: Given<'py>,
    region: Region,
    grid: Option<f64>,
    threads: usize,
) -> PyResult<RaggedArrays<'py>> {
    let ragged = ragged(&given)?;
    let made = on_threads(py, threads, || {
        let (mask, rules) = (region.mask()?, rules(grid));
        let row = |at: usize, scratch: &mut Shapes| clip_row(&ragged, at, &mask, &rules, scratch);
        RaggedOut::new(&ragged, &runs(ragged.len(), row)?)
    })?;
    arrays(py, made.map_err(PyValueError::new_err::<String>)?)
}

/// Numbers of rows, and their arrays.
type Changed<'py> = (Bound<'py, PyArray1<i64>>, RaggedArrays<'py>);

/// Clips ragged arrays to a region; returns only the rows that come out with other coordinates, whatever the direction of
/// their rings.
#[pyfunction]
fn clip_changed<'py>(
    py: Python<'py>,
    given: Given<'py>,
    region: Region,
    grid: Option<f64>,
    threads: usize,
) -> PyResult<Changed<'py>> {
    let ragged = ragged(&given)?;
    let made = on_threads(py, threads, || {
        let (mask, rules) = (region.mask()?, rules(grid));
        let row = |at: usize, scratch: &mut Shapes| {
            let row = clip_row(&ragged, at, &mask, &rules, scratch)?;
            let same = match &row {
                Row::Whole(_) => true,
                Row::Made(made) => made.as_ref().is_some_and(|g| are_same(&ragged.geometry(at), g)),
            };
            Ok((!same).then_some((at as i64, row)))
        };
        let rows = runs(ragged.len(), row)?;
        let changed = |run: Vec<Option<_>>| run.into_iter().flatten().unzip();
        let (numbers, rows): (Vec<Vec<i64>>, Vec<Vec<_>>) = rows.into_iter().map(changed).unzip();
        Ok((numbers.concat(), RaggedOut::new(&ragged, &rows)?))
    })?;
    let (numbers, made) = made.map_err(PyValueError::new_err::<String>)?;
    Ok((flat(py, numbers), arrays(py, made)?))
}

/// Returns whether two lines or polygons have the same coordinates in the same order, rings in either direction.
fn are_same(a: &Geometry, b: &Geometry) -> bool {
    let turned = |a: &Points, b: &Points| {
        let mut back = b.xy.iter().take(1).chain(b.xy.iter().skip(1).rev());
        a.zm.is_empty()
            && b.zm.is_empty()
            && a.xy.len() == b.xy.len()
            && a.xy.iter().all(|p| back.next() == Some(p))
    };
    match (a, b) {
        (Geometry::LineString(a), Geometry::LineString(b)) => a == b,
        (Geometry::Polygon(a), Geometry::Polygon(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || turned(a, b))
        }
        _ => false,
    }
}

/// Overlays ragged arrays, each geometry with the one at the same index.
#[pyfunction]
fn overlay_ragged<'py>(
    py: Python<'py>,
    a: Given<'py>,
    b: Given<'py>,
    operation: &str,
    grid: Option<f64>,
    threads: usize,
) -> PyResult<RaggedArrays<'py>> {
    let task = Task::Overlay(op(operation).map_err(PyValueError::new_err)?);
    let (a, b) = (ragged(&a)?, ragged(&b)?);
    if a.len() != b.len() {
        let message = format!(
            "the arrays have {} and {} geometries; they must have as many",
            a.len(),
            b.len()
        );
        return Err(PyValueError::new_err(message));
    }
    let rules = rules(grid);
    let made = on_threads(py, threads, || {
        let row = |at: usize, _: &mut Shapes| {
            task.run(&a.geometry(at), Some(&b.geometry(at)), &rules).map(Row::Made)
        };
        RaggedOut::new(&a, &runs(a.len(), row)?)
    })?;
    arrays(py, made.map_err(PyValueError::new_err::<String>)?)
}

/// Adds the names of this file to the module.
pub fn add(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add_function(wrap_pyfunction!(clip_wkb, m)?)?;
    m.add_function(wrap_pyfunction!(overlay_wkb, m)?)?;
    m.add_function(wrap_pyfunction!(clip_column, m)?)?;
    m.add_function(wrap_pyfunction!(clip_ragged, m)?)?;
    m.add_function(wrap_pyfunction!(clip_changed, m)?)?;
    m.add_function(wrap_pyfunction!(overlay_ragged, m)?)
}
