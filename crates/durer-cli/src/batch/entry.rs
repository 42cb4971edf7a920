//! The lines of a journal, the results of rows.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Report on a row, as a line of the journal has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The row's name.
    pub id: String,
    /// Hash of everything that the output depends on; missing if the input could not be read.
    pub key: Option<String>,
    /// Outcome.
    pub status: Status,
    /// Name of the output in its folder.
    pub output: String,
    /// Hash of the output.
    pub sha256: Option<String>,
    /// Size of the output.
    pub bytes: Option<u64>,
    /// Further outputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub planes: Vec<Written>,
    /// Files that the input refers to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub read: Vec<Reference>,
    /// Time that the row took.
    pub seconds: f64,
    /// Time at which it ended, in milliseconds since 1970.
    #[serde(default)]
    pub ended: u64,
    /// Warnings about the input.
    pub warnings: Vec<String>,
    /// Reason of the failure.
    pub error: Option<RowError>,
}

/// Outcome of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The output is whole.
    Done,
    /// The row failed, without output.
    Failed,
}

/// A file beside the main output.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Written {
    /// Name in the folder of outputs.
    pub output: String,
    /// Hash of the content.
    pub sha256: String,
    /// Size.
    pub bytes: u64,
}

/// A file that an input refers to, such as a texture.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reference {
    /// Path as from the folder of the input.
    pub path: PathBuf,
    /// Hash of the content; missing if the file does not exist.
    pub sha256: Option<String>,
}

/// Failure of a row.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RowError {
    /// Kind of failure.
    pub kind: Kind,
    /// File, and the place in it if known.
    pub place: String,
    /// Message with the reason.
    pub message: String,
}

/// Kind of failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The options are wrong.
    Usage,
    /// The input is wrong.
    Data,
    /// The input has another hash than the manifest says.
    Checksum,
    /// The input is missing, or cannot be read.
    Read,
    /// The output cannot be written.
    Write,
    /// The time was over.
    Timeout,
    /// More memory was needed.
    Memory,
    /// A panic.
    Fault,
    /// The process was killed, twice.
    Crash,
}

impl Kind {
    /// Returns whether the same row can succeed another time, or fails at once.
    pub fn passes(self) -> bool {
        matches!(self, Self::Usage | Self::Checksum | Self::Read | Self::Write | Self::Crash)
    }

    /// Returns its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Usage => "usage",
            Self::Data => "data",
            Self::Checksum => "checksum",
            Self::Read => "read",
            Self::Write => "write",
            Self::Timeout => "timeout",
            Self::Memory => "memory",
            Self::Fault => "fault",
            Self::Crash => "crash",
        }
    }
}

impl Entry {
    /// Creates the report on a row that failed.
    pub fn failed(id: &str, output: &str, seconds: f64, error: RowError) -> Self {
        Self {
            id: id.to_owned(),
            key: None,
            status: Status::Failed,
            output: output.to_owned(),
            sha256: None,
            bytes: None,
            planes: Vec::new(),
            read: Vec::new(),
            seconds,
            ended: now(),
            warnings: Vec::new(),
            error: Some(error),
        }
    }

    /// Returns all outputs, with their sizes.
    pub fn files(&self) -> impl Iterator<Item = (&str, u64)> {
        let main = self.bytes.map(|bytes| (&*self.output, bytes));
        main.into_iter().chain(self.planes.iter().map(|plane| (&*plane.output, plane.bytes)))
    }
}

impl RowError {
    /// Creates an error; its place is the name that the message begins with, if that is one of `names`.
    pub fn new(kind: Kind, message: &str, names: &[String]) -> Self {
        let part = |(place, message): (&str, &str)| Self {
            kind,
            place: place.to_owned(),
            message: message.to_owned(),
        };
        let begins = |name: &&String| {
            !name.is_empty()
                && message.strip_prefix(name.as_str()).is_some_and(|r| r.starts_with(": "))
        };
        let Some(name) = names.iter().find(begins) else { return part(("", message)) };
        let (rest, at) = (&message[name.len() + 2..], name.len() + 2);
        match rest.split_once(": ") {
            Some((line, text)) if line.starts_with("line ") => {
                part((&message[..at + line.len()], text))
            }
            _ => part((name, rest)),
        }
    }
}

/// Returns the time in milliseconds since 1970.
pub fn now() -> u64 {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    since.map_or(0, |since| u64::try_from(since.as_millis()).unwrap_or(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_divided_into_place_and_message() {
        let names = ["x/a.obj".to_owned(), String::new()];
        for (message, place, rest) in [
            ("x/a.obj: line 3: `one` is not a number", "x/a.obj: line 3", "`one` is not a number"),
            ("x/a.obj: it is empty", "x/a.obj", "it is empty"),
            ("--size: no", "", "--size: no"),
        ] {
            let error = RowError::new(Kind::Data, message, &names);
            assert_eq!((&*error.place, &*error.message), (place, rest));
        }
    }

    #[test]
    fn kinds_have_their_names() {
        for kind in [Kind::Usage, Kind::Crash, Kind::Checksum] {
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.name());
        }
    }
}
