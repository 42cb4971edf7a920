//! Errors and warnings, as the exceptions that the package defines.

use durer_cli::embedded::Failure;
use durer_formats::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Creates an exception of the package.
fn exception(py: Python<'_>, name: &str, args: (String, Option<String>)) -> PyErr {
    let class = py.import("durer._errors").and_then(|errors| errors.getattr(name));
    match class.and_then(|class| class.call1(args)) {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

/// Returns a `ValueError`, or a `LimitError` for work that costs more than it may.
pub fn of_library(py: Python<'_>, error: &durer::Error) -> PyErr {
    match error.is_of_cost() {
        true => exception(py, "LimitError", (error.to_string(), None)),
        false => PyValueError::new_err(error.to_string()),
    }
}

/// Returns the exception for wrong options, or for values that do not go with them.
pub fn of_failure(py: Python<'_>, failure: &Failure) -> PyErr {
    match failure {
        Failure::Refused(_) => exception(py, "LimitError", (failure.to_string(), None)),
        Failure::Usage(_) => exception(py, "OptionError", (failure.to_string(), None)),
        Failure::Data(_) | Failure::Partial | Failure::ClosedPipe => {
            PyValueError::new_err(failure.to_string())
        }
    }
}

/// Returns a `ReadError` with its place, or a more fitting error; `name` is the source's.
pub fn of_reader(py: Python<'_>, error: Error, name: &str) -> PyErr {
    let message = match name {
        "" => error.to_string(),
        name => format!("{name}: {error}"),
    };
    let place = |place: &durer_formats::Place| {
        Some(place.to_string().trim_end_matches(": ").to_owned()).filter(|place| !place.is_empty())
    };
    match &error {
        Error::Limit { .. } => exception(py, "LimitError", (message, None)),
        Error::Library(inner) if inner.is_of_cost() => exception(py, "LimitError", (message, None)),
        Error::Decode { place: at, .. }
        | Error::Unsupported { place: at, .. }
        | Error::Resource { place: at, .. } => exception(py, "ReadError", (message, place(at))),
        Error::Io(_) => match error {
            Error::Io(inner) => inner.into(),
            _ => exception(py, "ReadError", (message, None)),
        },
        _ => exception(py, "ReadError", (message, None)),
    }
}
