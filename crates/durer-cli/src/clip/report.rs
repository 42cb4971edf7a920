//! The report of `durer clip --json`.

use super::srids::Srids;
use crate::tiles::BrokenOff;
use durer::clip::mask::Cut;
use durer::clip::polygon::signed_area;
use durer_formats::geo::{Geometry, Points};
use serde::Serialize;

/// The whole report.
#[derive(Debug, Default, Serialize)]
pub struct Report {
    /// The version of durer.
    pub version: &'static str,
    /// Path of the input, as given on the command line.
    pub input: String,
    /// Path of the output, as given on the command line.
    pub output: String,
    /// The format that was read.
    pub from: &'static str,
    /// The format that was written.
    pub to: &'static str,
    /// Counts of the input.
    #[serde(rename = "in")]
    pub given: Counts,
    /// Features that --where left out.
    #[serde(skip_serializing_if = "is_zero")]
    pub unchosen: u64,
    /// Counts of the output.
    pub out: Counts,
    /// Features whose polygons crossed themselves or one another and were made valid.
    pub repaired: u64,
    /// Points of polygons that are not exactly where edges cross, because rings would cross there.
    pub snapped: u64,
    /// Some features that were joined lack heights or measures that others have.
    #[serde(skip)]
    pub mixed: bool,
    /// Features with edges that may be meant to go across the 180th meridian.
    #[serde(skip)]
    pub long_ways: u64,
    /// Lines that have no length.
    #[serde(skip)]
    pub flat: u64,
    /// Features at which polygons of the mask may have been lost, smaller than a cell of the grid.
    #[serde(skip)]
    pub lost: u64,
    /// The coordinate systems of the input.
    #[serde(skip)]
    pub srids: Srids,
    /// SRIDs of the mask.
    #[serde(skip)]
    pub mask_srids: Srids,
    /// Features with coordinates that are no longitudes and latitudes, where the output has these.
    #[serde(skip)]
    pub far_degrees: u64,
    /// Features whose own member was replaced by the name of their tile.
    #[serde(skip)]
    pub replaced: u64,
    /// Features that reach beyond the latitudes of tiles.
    #[serde(skip)]
    pub beyond: u64,
    /// Number of features that are more than a world away.
    #[serde(skip)]
    pub too_far: u64,
    /// Tiles that are not empty.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tiles: Option<u64>,
    /// Reason why tiles are missing, and the files of those that exist.
    #[serde(flatten)]
    pub broken_off: Option<BrokenOff>,
    /// Repairs and omissions while reading.
    pub warnings: Vec<String>,
    /// Seconds from start to end.
    pub total_seconds: f64,
    /// The peak memory of the process, if the system reports it.
    pub peak_memory_bytes: Option<u64>,
}

impl Report {
    /// Counts the changes to one feature, in one piece or several.
    pub fn add<'a>(&mut self, cuts: impl IntoIterator<Item = &'a Cut>) {
        let (mut repaired, mut lost) = (false, false);
        for cut in cuts {
            repaired |= cut.repaired;
            lost |= cut.lost;
            self.snapped += cut.snapped as u64;
            self.flat += cut.flat as u64;
        }
        self.repaired += u64::from(repaired);
        self.lost += u64::from(lost);
    }
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// Counts and sizes of geometries.
#[derive(Debug, Default, Clone, Copy, Serialize)]
pub struct Counts {
    pub features: u64,
    pub points: u64,
    pub lines: u64,
    pub polygons: u64,
    pub holes: u64,
    /// Positions; rings without the repeated one.
    pub vertices: u64,
    /// Area of the polygons as written, without holes, in squared units of the coordinates.
    pub area: f64,
    /// Length of the lines, in units of the coordinates.
    pub length: f64,
}

impl Counts {
    /// Counts a feature.
    pub fn add(&mut self, geometry: Option<&Geometry>) {
        self.features += 1;
        if let Some(geometry) = geometry {
            self.measure(geometry);
        }
    }

    /// Adds other counts.
    pub fn join(&mut self, other: &Self) {
        self.features += other.features;
        self.points += other.points;
        self.lines += other.lines;
        self.polygons += other.polygons;
        self.holes += other.holes;
        self.vertices += other.vertices;
        self.area += other.area;
        self.length += other.length;
    }

    fn measure(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                self.points += points.len() as u64;
                self.vertices += points.len() as u64;
            }
            Geometry::LineString(line) => self.line(line),
            Geometry::MultiLineString(lines) => lines.iter().for_each(|line| self.line(line)),
            Geometry::Polygon(rings) => self.polygon(rings),
            Geometry::MultiPolygon(polygons) => polygons.iter().for_each(|p| self.polygon(p)),
            Geometry::Collection(parts) => parts.iter().for_each(|part| self.measure(part)),
        }
    }

    fn line(&mut self, line: &Points) {
        self.lines += u64::from(!line.is_empty());
        self.vertices += line.len() as u64;
        self.length += line.xy.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    }

    fn polygon(&mut self, rings: &[Points]) {
        self.polygons += u64::from(!rings.is_empty());
        self.holes += rings.len().saturating_sub(1) as u64;
        let mut sign = 1.0;
        for ring in rings {
            self.vertices += ring.len() as u64;
            self.area += sign * signed_area(&ring.xy).abs();
            sign = -1.0;
        }
    }
}
