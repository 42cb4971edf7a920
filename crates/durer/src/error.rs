//! The one error type of the library.

use thiserror::Error;

/// What can be wrong with a value handed to the library.
///
/// The library opens no file, so these speak of values; `durer-formats` has its own error for bytes.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A parameter is outside its documented domain.
    #[error("{name} is {value}; it must be {expected}")]
    Parameter {
        /// The parameter's name, as in the signature or the command line.
        name: &'static str,
        /// What was given.
        value: String,
        /// What would be right.
        expected: &'static str,
    },
    /// A coordinate is NaN or infinite where only finite numbers have a meaning.
    #[error("{what} {index} is not finite")]
    NonFinite {
        /// What kind of thing, e.g. `"segment"`.
        what: &'static str,
        /// Its index in the input.
        index: usize,
    },
    /// A value refers to something that does not exist, e.g. a vertex index beyond the last vertex.
    #[error("{what} {index} does not exist: there are {count}")]
    Dangling {
        /// What is referred to, e.g. `"vertex"`.
        what: &'static str,
        /// The index that was used.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A size is above a stated limit.
    #[error("{what} {value} is above the limit of {limit}")]
    Limit {
        /// What is limited, e.g. `"pixels"`.
        what: &'static str,
        /// What was asked for.
        value: u64,
        /// The limit in force.
        limit: u64,
    },
    /// The combination asked for has no meaning, e.g. vector output of an image-space algorithm.
    #[error("{what} is not supported; {instead}")]
    Unsupported {
        /// What was asked for.
        what: &'static str,
        /// What to use instead.
        instead: &'static str,
    },
}

impl Error {
    /// A [`Error::Parameter`] from any displayable value.
    pub fn parameter(
        name: &'static str,
        value: impl std::fmt::Display,
        expected: &'static str,
    ) -> Self {
        Self::Parameter { name, value: value.to_string(), expected }
    }
}

/// The library's result.
pub type Result<T, E = Error> = std::result::Result<T, E>;
