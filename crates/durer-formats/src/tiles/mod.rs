//! Vector tiles, and files that hold many of them.
//!
//! [`Layer`] and [`encode`] make the bytes of a tile by the Mapbox Vector Tile Specification 2.1; [`PmTiles`] and
//! [`MbTiles`] write tiles to one file.

mod archive;
mod gzip;
mod mbtiles;
mod mvt;
mod pmtiles;
mod protobuf;

pub use archive::{Field, LayerInfo, Metadata};
pub use gzip::gzip;
pub use mbtiles::MbTiles;
pub use mvt::{Dictionary, Layer, Value, encode};
pub use pmtiles::PmTiles;
