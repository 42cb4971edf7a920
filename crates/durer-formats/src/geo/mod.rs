//! Geodata: features in GeoJSON, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, WKT, WKB and SVG, read and written
//! one by one; and in KML and GPX, only read.
//!
//! [`Reader`] takes bytes and gives features; [`Writer`] takes features and gives bytes. GeoJSON is read and written as
//! a stream, feature by feature, in all its layouts (a FeatureCollection, one feature per line, RFC 8142 sequences);
//! the other formats are held whole. [`unzipped`] decompresses any of them from gzip. [`crs`] transforms coordinates
//! from one system to another.
//!
//! ```
//! use durer_formats::geo::{GeoFormat, Reader, Writer};
//!
//! let line = r#"{"type":"Feature","id":7,"properties":{"a":1},"geometry":{"type":"Point","coordinates":[1,2.5]}}"#;
//! let mut reader = Reader::new(GeoFormat::GeoJsonSeq, line.as_bytes())?;
//! let mut writer = Writer::new(GeoFormat::Wkt, Vec::new());
//! while let Some(feature) = reader.next_feature()? {
//!     writer.write(&feature)?;
//! }
//! assert_eq!(writer.finish(reader.members())?, b"POINT (1 2.5)\n");
//! # Ok::<(), durer_formats::Error>(())
//! ```

mod beside;
pub mod crs;
mod csv;
mod curve;
mod feature;
mod flatgeobuf;
mod foreign;
mod format;
mod geojson;
mod geopackage;
mod geoparquet;
mod gpx;
mod gzip;
mod kml;
mod markup;
mod members;
pub(crate) mod number;
mod numbered;
mod reader;
mod rings;
mod schema;
mod shapefile;
mod svg;
mod svg_shapes;
mod system;
mod topojson;
mod wkb;
mod wkt;
mod writer;

pub use beside::Beside;
pub use durer::geometry::{Dimensions, Geometry, Points};
pub use feature::{Feature, Member};
pub use format::GeoFormat;
pub use gzip::unzipped;
pub use reader::{Reader, read_all};
pub use schema::{Field, FieldKind, Schema};
pub use system::System;
pub use wkb::{from_wkb, to_wkb};
pub use writer::{Finished, Writer};

/// Geometries and values may be nested so deep, at most.
const MAX_DEPTH: usize = 128;

/// Number of warnings that are kept; the rest is counted.
const MAX_WARNINGS: usize = 1000;

/// Things that cannot be read, for [`unread`].
const GEOMETRIES: &str = "{geometry cannot be read and is left out|geometries cannot be read and are left out; the first}";
const FEATURES: &str =
    "{feature cannot be read and is left out|features cannot be read and are left out; the first}";

/// Returns a warning about things that cannot be read, with the reason for the first of them.
fn unread(count: u64, things: &str, why: &str) -> String {
    format!("{}: {why}", crate::wording::agreeing(count, things))
}

/// Repairs and omissions while reading, the first thousand of them.
#[derive(Debug, Clone, Default)]
struct Warnings {
    kept: Vec<crate::Warning>,
    more: u64,
    /// Curves that became lines; reported at the end.
    curves: crate::text::Tally,
    /// Members of geometries within others, which have no place; reported at the end.
    members: crate::text::Tally,
    /// Values such as NaN, which JSON lacks and Python writes; reported at the end.
    nan: crate::text::Tally,
    /// Messages that tell how the file is read; nothing was repaired or left out.
    notes: Vec<String>,
}

impl Warnings {
    /// Adds a message that tells how the file is read.
    fn note(&mut self, message: String) {
        self.notes.push(message.clone());
        self.push(crate::Place::Whole, message);
    }

    /// Returns whether no more are kept.
    fn are_many(&self) -> bool {
        self.kept.len() >= MAX_WARNINGS
    }

    /// Moves the findings of another reader to this one.
    fn append(&mut self, other: &mut Self) {
        for warning in other.kept.drain(..) {
            self.push(warning.place, warning.message);
        }
        self.more += std::mem::take(&mut other.more);
        self.curves.append(std::mem::take(&mut other.curves));
        self.members.append(std::mem::take(&mut other.members));
        self.nan.append(std::mem::take(&mut other.nan));
        self.notes.append(&mut other.notes);
    }

    /// Replaces all places by the results of a function of them.
    fn relocate(&mut self, place_of: impl Fn(crate::Place) -> crate::Place) {
        let tallies =
            [&mut self.curves, &mut self.members, &mut self.nan].map(|tally| &mut tally.first);
        let places = self.kept.iter_mut().map(|warning| &mut warning.place).chain(tallies);
        places.for_each(|place| *place = place_of(std::mem::take(place)));
    }

    /// Adds warnings about the counted faults.
    fn take_over(&mut self) {
        let [curves, members, nan] =
            [&mut self.curves, &mut self.members, &mut self.nan].map(std::mem::take);
        self.add_counted(
            curves,
            "curve is flattened to lines of 32 edges per quarter turn",
            "curves are flattened to lines of 32 edges per quarter turn",
        );
        self.add_counted(
            members,
            "member of a geometry within a collection, which GeoJSON does not define, is left out",
            "members of geometries within collections, which GeoJSON does not define, are left out",
        );
        self.add_counted(
            nan,
            "value is NaN or Infinity, which JSON does not have; it is null",
            "values are NaN or Infinity, which JSON does not have; they are null",
        );
    }

    /// Adds a warning about counted faults, if there are any, in words for one and for several.
    fn add_counted(&mut self, tally: crate::text::Tally, one: &str, several: &str) {
        if tally.count > 0 {
            self.push(tally.first, crate::wording::counted(tally.count, one, several));
        }
    }

    fn push(&mut self, place: crate::Place, message: impl Into<String>) {
        if !self.are_many() {
            self.kept.push(crate::Warning { place, message: message.into() });
        } else {
            self.more += 1;
        }
    }
}
