//! A replacement for E57 without the feature `e57`.

use crate::{Error, Model, Place, ReadOptions, Resources, Result};

/// Reads nothing.
///
/// # Errors
/// Always: [`Error::Unsupported`].
pub fn read(_: &[u8], _: &dyn Resources, _: &ReadOptions) -> Result<Model> {
    Err(Error::Unsupported {
        place: Place::Whole,
        what: "E57".to_owned(),
        hint: "it is with the feature `e57`".to_owned(),
    })
}
