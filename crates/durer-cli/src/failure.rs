//! The kinds of failure of the command.

use durer_formats::wording::{message, shown_path};
use std::fmt;
use std::path::Path;
use std::process::ExitCode;

/// Reason why the command stops.
#[derive(Debug)]
pub enum Failure {
    /// Data that is wrong, or a file that cannot be read or written.
    Data(String),
    /// Work that would cost more than is allowed; who knows the file adds its name ([`Self::named`]).
    Refused(String),
    /// Options that are wrong, or cannot be combined.
    Usage(String),
    /// Some models failed and were skipped; an error was printed for each.
    Partial,
    /// The reader of the output has closed it; nothing is reported.
    ClosedPipe,
}

impl Failure {
    /// Returns the exit code of the process.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::ClosedPipe => ExitCode::SUCCESS,
            Self::Data(_) | Self::Refused(_) => ExitCode::from(1),
            Self::Usage(_) => ExitCode::from(2),
            Self::Partial => ExitCode::from(3),
        }
    }

    /// Returns the failure for an error of the library: wrong options, or work that costs too much.
    pub fn of_library(error: &durer::Error) -> Self {
        let message = error.to_string();
        if error.is_of_cost() { Self::Refused(message) } else { Self::Usage(message) }
    }

    /// Returns the failure with the file's name, if it is missing.
    pub fn named(self, name: &str) -> Self {
        match self {
            Self::Refused(message) => Self::Data(format!("{name}: {message}")),
            other => other,
        }
    }

    /// Returns the failure with the name of the input that it is about.
    pub fn of_input(self, name: &str) -> Self {
        match self {
            Self::Usage(message) => Self::Usage(format!("{name}: {message}")),
            Self::Data(message) => Self::Data(format!("{name}: {message}")),
            other => other.named(name),
        }
    }

    /// Creates a failure of a file: its name, then what is wrong with it.
    pub fn of_file(file: &Path, what: impl fmt::Display) -> Self {
        Self::Data(format!("{}: {what}", shown_path(file)))
    }

    /// Creates a failed write to standard output.
    pub fn of_stdout(error: &std::io::Error) -> Self {
        match error.kind() {
            std::io::ErrorKind::BrokenPipe => Self::ClosedPipe,
            _ => Self::Data(format!("standard output: {}", in_words(error))),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Data(text) | Self::Refused(text) | Self::Usage(text) => {
                f.write_str(&message(text))
            }
            Self::Partial | Self::ClosedPipe => Ok(()),
        }
    }
}

/// Makes writes beyond the largest size of a file (`ulimit -f`) fail like others, instead of ending the process.
pub fn report_large_files() {
    #[cfg(unix)]
    {
        let noted = std::sync::Arc::default();
        // If that fails, the signal keeps its default effect.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noted);
    }
}

/// Returns the system's message without the number that Rust adds.
pub fn in_words(error: &std::io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use durer::view::window::PixelRect;

    #[test]
    fn sizes_that_the_caller_chose_are_usage_and_sizes_of_data_are_not() {
        let too_wide = PixelRect::of_size(u32::MAX, 1).expect_err("a side above 2³¹");
        assert!(
            matches!(too_wide, durer::Error::TooLarge { value: 0xffff_ffff, .. }),
            "{too_wide:?}"
        );
        assert!(matches!(Failure::of_library(&too_wide), Failure::Usage(_)));
        let too_many = durer::Error::Limit { what: "vertices", value: 9, limit: 8 };
        assert!(matches!(Failure::of_library(&too_many), Failure::Refused(_)));
    }
}
