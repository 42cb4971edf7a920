//! `durer._durer`, the compiled part of the Python package: functions from arrays and option strings to arrays and
//! bytes.
//!
//! The package's Python code converts arrays to the layout that each function names; returned arrays own their memory,
//! moved into them without a copy. Work is done without the interpreter's lock.

mod args;
mod clip;
mod error;
mod explain;
mod features;
mod geometry;
mod model;
mod overlay;
mod parts;
mod picture;
mod raster;
mod threads;
mod view;

use pyo3::prelude::*;
use std::io::Write;

/// Runs the command with its name and arguments, and returns its exit code.
#[pyfunction]
fn command(py: Python<'_>, line: Vec<std::ffi::OsString>) -> u8 {
    let code = py.detach(|| {
        let code = durer_cli::main_with(line);
        // The interpreter does not flush it at its end; if standard output is closed, an error cannot be reported.
        let _ = std::io::stdout().flush();
        code
    });
    // A code of exit hides its number; there are only these.
    let is = |number: u8| code == std::process::ExitCode::from(number);
    (0..=u8::MAX).find(|&number| is(number)).unwrap_or(1)
}

/// Adds the functions and classes of the module.
#[pymodule(gil_used = false)]
fn _durer(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add_function(wrap_pyfunction!(command, m)?)?;
    for add in [
        model::add,
        parts::add,
        view::add,
        picture::add,
        clip::add,
        features::add,
        raster::add,
        explain::add,
    ] {
        add(m)?;
    }
    Ok(())
}
