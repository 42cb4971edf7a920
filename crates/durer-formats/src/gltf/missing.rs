//! The error for references to missing objects.

use super::json::Whole;
use crate::Error;
use crate::wording::there_are;
use std::fmt::Display;

/// Returns the error for a reference beyond the `count` existing objects.
pub fn missing(what: &str, index: Whole, count: usize, at: impl Display) -> Error {
    let message = match count {
        0 => format!("there is no {what} {}, none at all", index.0),
        _ => format!("there is no {what} {}: {}", index.0, there_are(count as u64)),
    };
    Error::path(at.to_string(), message)
}
