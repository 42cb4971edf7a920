//! The report as text that grows while pictures are made. Only a line is kept for each picture, in one block with the
//! others: small allocations per picture, held to the end, would fragment the memory between the large temporary blocks
//! of pictures, and keep an allocator from reusing these.

use super::{Failed, ModelReport, PictureReport, peak_memory};
use crate::failure::Failure;
use durer_formats::wording;
use serde::Serialize;
use std::io::{self, Write};

/// Report, if one is requested.
pub struct Growing {
    wanted: bool,
    /// Reports of finished models, separated by commas, then the pictures of the current one.
    models: String,
    /// Length of the part that belongs to finished models.
    done: usize,
    /// Reports of the models that failed.
    failed: String,
}

/// The JSON before the models.
#[derive(Serialize)]
struct Head {
    /// The version of durer.
    version: &'static str,
}

/// The JSON after the models.
#[derive(Serialize)]
struct Tail {
    /// Seconds from start to end.
    total_seconds: f64,
    /// The peak memory of the process, if the system reports it.
    peak_memory_bytes: Option<u64>,
}

impl Growing {
    /// Creates an empty report, which stays empty if none is requested.
    pub fn new(wanted: bool) -> Self {
        Self { wanted, models: String::new(), done: 0, failed: String::new() }
    }

    /// Adds a picture of the model in work.
    pub fn picture(&mut self, picture: &PictureReport) {
        if self.wanted {
            let between = if self.models.len() > self.done { "," } else { "" };
            let line = serde_json::to_string(picture).unwrap_or_default();
            self.models.extend([between, "\n        ", &*wording::json(&line)]);
        }
    }

    /// Ends a model with all of its pictures.
    pub fn model(&mut self, model: &ModelReport) {
        if self.wanted {
            // The beginning of the report is known last.
            let opening = opening(model, self.done > 0);
            self.models.insert_str(self.done, &opening);
            let pictures = self.models.len() > self.done + opening.len();
            self.models.push_str(closing(pictures));
            self.done = self.models.len();
        }
    }

    /// Ends a model that failed, with the pictures written before.
    pub fn failed(&mut self, failed: &Failed) {
        if self.wanted {
            let pictures = self.models.split_off(self.done);
            let opening = opening(failed, !self.failed.is_empty());
            self.failed.extend([&opening, &pictures, closing(!pictures.is_empty())]);
        }
    }

    /// Writes the report to standard output, if it is requested.
    pub fn print(&self, total_seconds: f64) -> Result<(), Failure> {
        if !self.wanted {
            return Ok(());
        }
        let mut out = io::stdout().lock();
        self.write(total_seconds, &mut out)
            .and_then(|()| out.flush())
            .map_err(|e| Failure::of_stdout(&e))
    }

    fn write(&self, total_seconds: f64, out: &mut impl Write) -> io::Result<()> {
        let head = members(&Head { version: env!("CARGO_PKG_VERSION") }, "  ");
        write!(out, "{{\n{head}")?;
        for (name, list) in [("models", &self.models), ("failed", &self.failed)] {
            let end = if list.is_empty() { "]" } else { "\n  ]" };
            write!(out, ",\n  \"{name}\": [{list}{end}")?;
        }
        let tail = Tail { total_seconds, peak_memory_bytes: peak_memory() };
        writeln!(out, ",\n{}\n}}", members(&tail, "  "))
    }
}

/// Returns the begin of a model's entry up to its pictures, after others or the first.
fn opening(facts: &impl Serialize, follows: bool) -> String {
    let between = if follows { "," } else { "" };
    format!("{between}\n    {{\n{},\n      \"pictures\": [", members(facts, "      "))
}

/// Returns the end of a model's entry, after pictures or none.
fn closing(pictures: bool) -> &'static str {
    if pictures { "\n      ]\n    }" } else { "]\n    }" }
}

/// Returns the members of an object, a line each, with an indent in front of each.
fn members(object: &impl Serialize, indent: &str) -> String {
    let text = serde_json::to_string_pretty(object).unwrap_or_default();
    let text = wording::json(&text);
    let inner = text.strip_prefix("{\n  ").and_then(|text| text.strip_suffix("\n}"));
    // No string of JSON has a line break in it.
    let deeper = inner.unwrap_or_default().replace("\n  ", &format!("\n{indent}"));
    format!("{indent}{deeper}")
}
