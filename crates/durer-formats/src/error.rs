//! The errors of readers and writers.

use crate::wording::{message, shown};
use thiserror::Error;

/// Position in a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    #[default]
    Whole,
    /// Line of a text file, counted from 1, and column, counted from 1 in bytes (0: unknown).
    Line(u64, u64),
    /// Byte offset, counted from 0.
    Byte(u64),
    /// Path inside a structured file, e.g. `meshes[0].primitives[1].indices`.
    Path(String),
    /// Place in a feature of map data.
    Feature {
        /// Number of the feature in its file, counted from 1.
        number: u64,
        /// Its id or name with the key, e.g. `id 7` or `name Bavaria`; empty without one.
        name: String,
        /// Position in the file.
        at: Box<Self>,
    },
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line, 0) => write!(f, "line {line}: "),
            Self::Line(line, column) => write!(f, "line {line}, column {column}: "),
            Self::Byte(offset) => write!(f, "byte {offset}: "),
            Self::Path(path) => write!(f, "{}: ", shown(path)),
            Self::Feature { number, name, at } => {
                let at = at.to_string();
                let at = at.strip_suffix(": ").map_or(String::new(), |at| format!("{at}, "));
                let name =
                    if name.is_empty() { String::new() } else { format!(" ({})", shown(name)) };
                write!(f, "{at}feature {number}{name}: ")
            }
        }
    }
}

/// Error in reading or writing bytes. The caller puts the file's name before the message.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The bytes do not conform to their format.
    #[error("{}", crate::wording::message(&format!("{place}{message}")))]
    Decode {
        /// Position of the fault.
        place: Place,
        /// Description of the fault, and of the expected content.
        message: String,
    },
    /// The file needs a feature that durer lacks, e.g. a required glTF extension.
    #[error("{}", unsupported(place, what, hint))]
    Unsupported {
        /// Position in the file.
        place: Place,
        /// Name of the missing feature.
        what: String,
        /// Advice, or empty.
        hint: String,
    },
    /// A stated limit would be exceeded.
    #[error("{place}the {what} is {value}, above the limit of {limit}")]
    Limit {
        /// Position in the file.
        place: Place,
        /// Limited quantity, a noun without an article, e.g. `"decoded size"`.
        what: &'static str,
        /// Amount that the file needs.
        value: u64,
        /// Limit in force.
        limit: u64,
    },
    /// A resource that the file refers to could not be read.
    #[error("{}", crate::wording::message(&format!("{place}cannot read `{}`: {message}", shown(uri))))]
    Resource {
        /// Position of the reference.
        place: Place,
        /// Target of the reference, as the file writes it.
        uri: String,
        /// Reason for the refusal.
        message: String,
    },
    /// The format is unknown, by content and by name.
    #[error("{}", crate::wording::message(&format!("not a known format: {}", .0)))]
    Unknown(String),
    /// The library refused the value.
    #[error(transparent)]
    Library(#[from] durer::Error),
    /// Reading or writing failed. The message is the system's; so the system's error is not also a source.
    #[error("{}", without_number(.0))]
    Io(std::io::Error),
}

impl From<std::io::Error> for Error {
    fn from(error: std::io::Error) -> Self {
        Self::Io(error)
    }
}

/// Returns the system's message without the number that Rust adds.
fn without_number(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or(&text).to_owned()
}

fn unsupported(place: &Place, what: &str, hint: &str) -> String {
    let what = shown(what);
    let then = if hint.is_empty() { "" } else { "; " };
    message(&format!("{place}{what} is not supported{then}{hint}")).into_owned()
}

impl Error {
    /// Creates a decode error at a line and column, both counted from 1 (column 0: unknown).
    pub fn line(line: u64, column: u64, message: impl Into<String>) -> Self {
        Self::Decode { place: Place::Line(line, column), message: message.into() }
    }

    /// Creates a decode error at a byte offset.
    pub fn byte(offset: u64, message: impl Into<String>) -> Self {
        Self::Decode { place: Place::Byte(offset), message: message.into() }
    }

    /// Creates a decode error at a path inside a structured file.
    pub fn path(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Decode { place: Place::Path(path.into()), message: message.into() }
    }

    /// Returns the error with its place replaced by a function of it.
    pub(crate) fn at(self, place_of: impl FnOnce(Place) -> Place) -> Self {
        match self {
            Self::Decode { place, message } => Self::Decode { place: place_of(place), message },
            Self::Unsupported { place, what, hint } => {
                Self::Unsupported { place: place_of(place), what, hint }
            }
            Self::Limit { place, what, value, limit } => {
                Self::Limit { place: place_of(place), what, value, limit }
            }
            Self::Resource { place, uri, message } => {
                Self::Resource { place: place_of(place), uri, message }
            }
            other => other,
        }
    }

    /// Creates a decode error of the file as a whole.
    pub fn whole(message: impl Into<String>) -> Self {
        Self::Decode { place: Place::Whole, message: message.into() }
    }
}

/// Warning of a repair or an omission; the result is usable nevertheless.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Position in the file.
    pub place: Place,
    /// Description of the fault and its repair.
    pub message: String,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&message(&format!("{}{}", self.place, self.message)))
    }
}

/// The crate's result.
pub type Result<T, E = Error> = std::result::Result<T, E>;
