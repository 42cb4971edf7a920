//! How the command ends when it does not end well.

use std::fmt;
use std::path::Path;
use std::process::ExitCode;

/// Why the command stops.
#[derive(Debug)]
pub enum Failure {
    /// Data that is wrong, or a file that cannot be read or written.
    Data(String),
    /// Options that are wrong, or do not go together.
    Usage(String),
    /// Some models failed and were skipped; each has been told.
    Partial,
    /// Whoever read the output has gone; nothing to tell.
    ClosedPipe,
}

impl Failure {
    /// The exit code of the process.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::ClosedPipe => ExitCode::SUCCESS,
            Self::Data(_) => ExitCode::from(1),
            Self::Usage(_) => ExitCode::from(2),
            Self::Partial => ExitCode::from(3),
        }
    }

    /// A failure of a file: its name, then what is wrong with it.
    pub fn of_file(file: &Path, what: impl fmt::Display) -> Self {
        Self::Data(format!("{}: {what}", file.display()))
    }

    /// A failed write to standard output.
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
            Self::Data(message) | Self::Usage(message) => f.write_str(message),
            Self::Partial | Self::ClosedPipe => Ok(()),
        }
    }
}

/// The system's message without the number that Rust adds.
pub fn in_words(error: &std::io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}
