//! 3MF.

use crate::{Error, Model, ReadOptions, Resources, Result};

/// Reads a 3MF file.
///
/// # Errors
/// TODO
pub fn read(_bytes: &[u8], _resources: &dyn Resources, _options: &ReadOptions) -> Result<Model> {
    Err(Error::whole("x"))
}
