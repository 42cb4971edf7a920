//! The one error type of the library.

use thiserror::Error;

/// Reason why the library refuses a value.
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
        /// Value that was given.
        value: String,
        /// Expected form of the value.
        expected: &'static str,
    },
    /// A coordinate is NaN or infinite where only finite numbers have a meaning.
    #[error("{what} {index} is not finite")]
    NonFinite {
        /// Kind of thing, e.g. `"segment"`.
        what: &'static str,
        /// Its index in the input.
        index: usize,
    },
    /// A value refers to something that does not exist, e.g. a vertex index beyond the last vertex.
    #[error("{what} {index} does not exist: there are {count}")]
    Dangling {
        /// Kind of the target, e.g. `"vertex"`.
        what: &'static str,
        /// The index that was used.
        index: usize,
        /// Number of things of that kind.
        count: usize,
    },
    /// A name that nothing has.
    #[error("there is no {what} “{value}”; the nearest are: {near}")]
    Unknown {
        /// Kind of the thing, e.g. `"algorithm"`.
        what: &'static str,
        /// The name that was given.
        value: String,
        /// Names that exist and are like it.
        near: String,
    },
    /// A size that the caller chose is above a stated limit.
    #[error("the {what} is {value}, above the limit of {limit}")]
    TooLarge {
        /// Limited size, a noun without an article, e.g. `"number of pixels"`.
        what: &'static str,
        /// Size that was chosen.
        value: u64,
        /// The limit in force.
        limit: u64,
    },
    /// The size of the data, or a count of steps of the work, is above a stated limit.
    #[error("the {what} is {value}, above the limit of {limit}")]
    Limit {
        /// Limited quantity, a noun without an article, e.g. `"number of vertices"`.
        what: &'static str,
        /// Amount that the input requires.
        value: u64,
        /// The limit in force.
        limit: u64,
    },
    /// The combination requested has no meaning, e.g. vector output of an image-space algorithm.
    #[error("{what} is not supported; {instead}")]
    Unsupported {
        /// Combination that was requested.
        what: &'static str,
        /// Alternative to use.
        instead: &'static str,
    },
    /// The work would take more memory than its budget allows ([`crate::work::Work`]).
    #[error("{stage}: {} of memory are needed, {option} allows {}", need_in_words(*need, *budget), in_words(*budget))]
    Memory {
        /// Purpose of the memory, e.g. `"planes of the picture"`.
        stage: &'static str,
        /// Bytes that would be in use together.
        need: u64,
        /// Bytes that are allowed.
        budget: u64,
        /// Name of the setting for the budget, in the caller's words.
        option: &'static str,
    },
    /// The system has no memory for a large buffer.
    #[error("{stage}: the system has no {} of memory left", in_words(*need))]
    OutOfMemory {
        /// Purpose of the work.
        stage: &'static str,
        /// Bytes of the buffer.
        need: u64,
    },
    /// The work has taken longer than it may.
    #[error("it takes longer than the {seconds} s that {option} allows")]
    TimedOut {
        /// Seconds that are allowed.
        seconds: f64,
        /// Name of the setting for the time, in the caller's words.
        option: &'static str,
    },
    /// The work was ended from outside.
    #[error("it was cancelled")]
    Cancelled,
}

impl Error {
    /// Returns whether the work ended because of its cost, not because of its input.
    pub fn is_of_budget(&self) -> bool {
        use Error::{Cancelled, Memory, OutOfMemory, TimedOut};
        matches!(self, Memory { .. } | OutOfMemory { .. } | TimedOut { .. } | Cancelled)
    }

    /// Returns whether the input is sound but needs more than a limit or a budget allows.
    pub fn is_of_cost(&self) -> bool {
        self.is_of_budget() || matches!(self, Self::Limit { .. })
    }

    /// Creates a [`Error::Parameter`] from any displayable value.
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

/// Returns a number of bytes above a budget in words, which differ from those for the budget.
fn need_in_words(need: u64, budget: u64) -> String {
    let words = in_words(need);
    if words == in_words(budget) { format!("more than {words}") } else { words }
}

/// Returns a number of bytes as people read it, with at most one digit behind the point: `1.2 MB`, `640 MB`; powers of
/// 1024.
fn in_words(bytes: u64) -> String {
    let units = ["bytes", "kB", "MB", "GB", "TB", "PB", "EB"];
    let (mut value, mut unit) = (bytes as f64, 0);
    while value >= 999.95 {
        (value, unit) = (value / 1024.0, unit + 1);
    }
    let number = format!("{value:.1}");
    let number = number.strip_suffix(".0").unwrap_or(&number);
    format!("{number} {}", units.get(unit).copied().unwrap_or("EB"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_reported_shortly() {
        let reported = [0, 999, 1000, 1536, 64 << 20, 67_500_000, 1 << 30, u64::MAX].map(in_words);
        let expected =
            ["0 bytes", "999 bytes", "1 kB", "1.5 kB", "64 MB", "64.4 MB", "1 GB", "16 EB"];
        assert_eq!(reported, expected);
    }

    #[test]
    fn needs_differ_from_the_budget_in_words() {
        let budget = 2 << 30;
        assert_eq!(need_in_words(budget + 1, budget), "more than 2 GB");
        assert_eq!(need_in_words(3 << 30, budget), "3 GB");
    }
}
