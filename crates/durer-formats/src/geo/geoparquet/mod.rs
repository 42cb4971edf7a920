//! GeoParquet 1.0 and 1.1, <https://geoparquet.org/releases/v1.1.0/>: a Parquet file with geometries as well-known
//! binary, by the crate `parquet` (feature `geoparquet`).
//!
//! Row groups are read one after the other. Written features are held until the end, because the columns come first.

#[cfg(not(feature = "geoparquet"))]
mod absent;
#[cfg(feature = "geoparquet")]
mod days;
#[cfg(feature = "geoparquet")]
mod footer;
#[cfg(feature = "geoparquet")]
mod projjson;
#[cfg(feature = "geoparquet")]
mod read;
#[cfg(feature = "geoparquet")]
mod values;
#[cfg(feature = "geoparquet")]
mod write;

#[cfg(not(feature = "geoparquet"))]
pub use absent::{Reader, write};
#[cfg(feature = "geoparquet")]
pub use read::Reader;
#[cfg(feature = "geoparquet")]
pub use write::write;

/// Returns whether the bytes begin like a Parquet file.
pub fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1")
}
