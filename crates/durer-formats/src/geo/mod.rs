//! Geodata: features in GeoJSON, WKT, WKB and SVG, read and written one at a time.
//!
//! [`Reader`] takes bytes and gives features; [`Writer`] takes features and gives bytes. GeoJSON is
//! read and written as a stream, a feature at a time, whichever way it is laid out (a
//! FeatureCollection, one feature per line, RFC 8142 sequences); the other formats are held whole.
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

mod feature;
mod format;
mod geojson;
pub(crate) mod number;
mod reader;
mod svg;
mod svg_shapes;
mod wkb;
mod wkt;
mod writer;

pub use feature::{Dimensions, Feature, Geometry, Member, Points};
pub use format::GeoFormat;
pub use reader::{Reader, read_all};
pub use writer::Writer;

/// Geometries and values may be nested so deep, at most.
const MAX_DEPTH: usize = 128;

/// So many warnings are kept; the rest is counted.
const MAX_WARNINGS: usize = 1000;

/// What was repaired or left out while reading, the first thousand of it.
#[derive(Debug, Clone, Default)]
struct Warnings {
    kept: Vec<crate::Warning>,
    more: u64,
}

impl Warnings {
    /// Whether no more are kept.
    fn are_many(&self) -> bool {
        self.kept.len() >= MAX_WARNINGS
    }

    fn push(&mut self, place: crate::Place, message: impl Into<String>) {
        if !self.are_many() {
            self.kept.push(crate::Warning { place, message: message.into() });
        } else {
            self.more += 1;
        }
    }
}
