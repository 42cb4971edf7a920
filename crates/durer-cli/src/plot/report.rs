//! The report of `durer plot --json`.

use super::Surface;
use crate::output::Target;
use durer::plot::{Options, Plot};
use durer::target::drawing::{Line, LineClass};
use serde::Serialize;

/// The report.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The version of durer.
    version: &'static str,
    /// The file as on the command line, or the formula.
    surface: String,
    /// The format found.
    format: String,
    /// Points along x and z.
    points: [usize; 2],
    /// Points without a height.
    missing: usize,
    /// First and last x.
    x: [f64; 2],
    /// First and last z.
    z: [f64; 2],
    /// Lowest and highest height.
    heights: Option<[f64; 2]>,
    /// Depth over width of the ground as drawn, if it has two scales.
    #[serde(skip_serializing_if = "Option::is_none")]
    aspect: Option<f64>,
    /// Factor for heights.
    exaggeration: f64,
    /// Chains of visible lines of the grid.
    lines: usize,
    /// Their length on the plane of the picture, exaggerated as it is.
    length: f64,
    /// Filled cells.
    cells: usize,
    /// File of the plot; `-` is standard output.
    file: String,
    /// Seconds for reading or evaluating.
    pub read_seconds: f64,
    /// Seconds for finding the lines.
    pub draw_seconds: f64,
    /// Seconds for encoding and writing.
    pub write_seconds: f64,
    /// The peak memory of the process, if the system reports it.
    peak_memory_bytes: Option<u64>,
}

impl Report {
    /// Creates all but the times.
    pub fn new(surface: &Surface, plot: &Plot, options: &Options, target: &Target) -> Self {
        let field = &surface.field;
        let grid = |l: &Line| l.class == LineClass::Grid && l.is_visible();
        Self {
            version: env!("CARGO_PKG_VERSION"),
            surface: surface.name.clone(),
            format: surface.format.clone(),
            points: [field.columns(), field.rows()],
            missing: field.missing(),
            x: field.x_range(),
            z: field.z_range(),
            heights: field.range(),
            aspect: options.aspect,
            exaggeration: options.exaggeration,
            lines: plot.drawing.lines.iter().filter(|l| grid(l)).count(),
            length: plot.drawing.length(grid),
            cells: plot.drawing.regions.len(),
            file: target.to_string(),
            read_seconds: 0.0,
            draw_seconds: 0.0,
            write_seconds: 0.0,
            peak_memory_bytes: crate::report::peak_memory(),
        }
    }
}
