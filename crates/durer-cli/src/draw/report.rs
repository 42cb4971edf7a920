//! The report of `durer draw --json`.

use durer::map::LayerCounts;
use serde::Serialize;

/// The whole report.
#[derive(Debug, Default, Serialize)]
pub struct Report {
    /// The version of durer.
    pub version: &'static str,
    /// Path of the output, as given on the command line.
    pub output: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Layers, from the bottom to the top.
    pub layers: Vec<LayerReport>,
    /// Repairs, replacements and omissions.
    pub warnings: Vec<String>,
    /// Seconds for reading and decoding.
    pub read_seconds: f64,
    /// Seconds for outlines and pixels.
    pub draw_seconds: f64,
    /// Seconds for making and writing the PNG.
    pub encode_seconds: f64,
    /// Seconds from start to end.
    pub total_seconds: f64,
    /// The peak memory of the process, if the system reports it.
    pub peak_memory_bytes: Option<u64>,
}

/// One file.
#[derive(Debug, Default, Serialize)]
pub struct LayerReport {
    /// Path of the input, as given on the command line.
    pub input: String,
    /// The format found.
    pub format: &'static str,
    /// Counts of a map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<MapCounts>,
}

/// Counts of a layer of a map: parts that touch the window.
#[derive(Debug, Default, Clone, Copy, Serialize)]
pub struct MapCounts {
    pub features: u64,
    pub points: u64,
    pub lines: u64,
    pub polygons: u64,
    pub labels: u64,
    /// Labels that found no room.
    pub labels_left_out: u64,
}

impl MapCounts {
    /// Creates the counts of a layer whose labels have yet to be placed.
    pub fn new(features: usize, counts: LayerCounts) -> Self {
        let LayerCounts { points, lines, polygons, .. } = counts;
        Self { features: features as u64, points, lines, polygons, ..Self::default() }
    }

    /// Returns the number of points, lines and polygons.
    pub fn parts(&self) -> u64 {
        self.points + self.lines + self.polygons
    }
}
