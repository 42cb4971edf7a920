//! The error for references to what does not exist.

use super::json::Whole;
use crate::Error;
use std::fmt::Display;

/// Returns the error for a reference to one of `count` things that does not exist.
pub fn missing(what: &str, index: Whole, count: usize, at: impl Display) -> Error {
    let message = match count {
        0 => format!("there is no {what} {}, none at all", index.0),
        _ => format!("there is no {what} {}: there are {count}", index.0),
    };
    Error::path(at.to_string(), message)
}
