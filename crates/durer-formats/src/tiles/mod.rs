//! Vector tiles, and files that hold many of them.
//!
//! [`Layer`] and [`encode`] make the bytes of a tile, as the Mapbox Vector Tile Specification 2.1 says; [`PmTiles`] and
//! [`MbTiles`] put tiles into one file.

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
