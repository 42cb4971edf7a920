//! A replacement for LAZ without the feature `laz`.

use super::Header;
use crate::{Error, Place, Result};

/// Returns an unknown system.
///
/// # Errors
/// Always.
pub(super) fn points(_: &[u8], _: &Header, _: impl FnMut(&[u8])) -> Result<u64> {
    Err(Error::Unsupported {
        place: Place::Whole,
        what: "compressed LAS (LAZ)".to_owned(),
        hint: "it is with the feature `laz`".to_owned(),
    })
}
