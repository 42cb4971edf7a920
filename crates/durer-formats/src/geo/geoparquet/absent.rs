//! A replacement for GeoParquet without the feature `geoparquet`.

use crate::geo::beside::Beside;
use crate::geo::{Feature, System, Warnings};
use crate::{Error, Place, Result};
use std::io::Write;

/// Reader without features, which cannot be made.
pub struct Reader {
    /// System of the coordinates.
    pub system: System,
}

impl Reader {
    /// Refuses the file, and names the build that would read it.
    ///
    /// # Errors
    /// Always.
    pub fn new(_: Vec<u8>, _: &Beside<'_>, _: &mut Warnings) -> Result<Self> {
        Err(missing("GeoParquet"))
    }

    /// Returns no feature; never called.
    pub fn next_feature(&mut self, _: &mut Warnings) -> Result<Option<Feature>> {
        Ok(None)
    }
}

/// Refuses to write, and names the build that would.
///
/// # Errors
/// Always.
pub fn write(_: &mut impl Write, _: &[Feature], _: &System) -> Result<()> {
    Err(missing("writing GeoParquet"))
}

fn missing(what: &str) -> Error {
    let hint = "one with `--features geoparquet` does; else convert with GeoJSON, GeoPackage or FlatGeobuf";
    let what = format!("{what} by this build of durer");
    Error::Unsupported { place: Place::Whole, what, hint: hint.to_owned() }
}
