//! One report of all journals.

#[cfg(feature = "geoparquet")]
mod parquet;

use super::entry::{Entry, Status};
use super::journal;
use crate::failure::Failure;
use crate::output::{self, Target};
use durer::work::Work;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// Columns of a table.
const COLUMNS: [&str; 10] = [
    "id", "status", "output", "bytes", "sha256", "seconds", "warnings", "error", "place", "message",
];

/// Writes the last entry of each row, ordered by id.
pub fn run(out: &Path, report: &Path) -> Result<(), Failure> {
    let target = output::file_or_stream("--output", report)?;
    let mut last: BTreeMap<String, Entry> = BTreeMap::new();
    journal::read_all(out, |entry| {
        if last.get(&entry.id).is_none_or(|known| known.ended <= entry.ended) {
            last.insert(entry.id.clone(), entry);
        }
    })?;
    let suffix = report.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match suffix.as_str() {
        "jsonl" | "ndjson" => write_lines(&target, last.values())?,
        "csv" => write_csv(&target, last.values())?,
        "" if target == Target::Stdout => write_csv(&target, last.values())?,
        "parquet" => write_parquet(&target, last.values())?,
        _ => {
            let what = "a report is .csv, .jsonl or .parquet";
            return Err(Failure::Usage(format!("--output {}: {what}", report.display())));
        }
    }
    let failed = last.values().filter(|entry| entry.status == Status::Failed).count();
    let line = format!("durer: {} rows: {} done, {failed} failed", last.len(), last.len() - failed);
    // If standard error is closed, the message is lost.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
    Ok(())
}

fn write_lines<'a>(
    target: &Target,
    entries: impl Iterator<Item = &'a Entry>,
) -> Result<(), Failure> {
    let written = output::deliver(target, &Work::default(), |out| {
        for entry in entries {
            let text = serde_json::to_string(entry).map_err(std::io::Error::from)?;
            writeln!(out, "{}", durer_formats::wording::json(&text))?;
        }
        Ok(())
    });
    written.map(drop)
}

fn write_csv<'a>(target: &Target, entries: impl Iterator<Item = &'a Entry>) -> Result<(), Failure> {
    let written = output::deliver(target, &Work::default(), |out| {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(COLUMNS).map_err(std::io::Error::from)?;
        for entry in entries {
            table.write_record(cells(entry)).map_err(std::io::Error::from)?;
        }
        Ok(table.flush()?)
    });
    written.map(drop)
}

/// Returns the cells of a row.
fn cells(entry: &Entry) -> [String; COLUMNS.len()] {
    let status = if entry.status == Status::Done { "done" } else { "failed" };
    let error = entry.error.as_ref();
    [
        entry.id.clone(),
        status.to_owned(),
        entry.output.clone(),
        entry.bytes.map_or_else(String::new, |bytes| bytes.to_string()),
        entry.sha256.clone().unwrap_or_default(),
        format!("{:.6}", entry.seconds),
        entry.warnings.join("; "),
        error.map_or("", |error| error.kind.name()).to_owned(),
        error.map_or("", |error| error.place.as_str()).to_owned(),
        error.map_or("", |error| error.message.as_str()).to_owned(),
    ]
}

#[cfg(feature = "geoparquet")]
use self::parquet::write as write_parquet;

#[cfg(not(feature = "geoparquet"))]
fn write_parquet<'a>(_: &Target, _: impl Iterator<Item = &'a Entry>) -> Result<(), Failure> {
    let what = "a report is Parquet if durer is built with --features geoparquet; .csv and .jsonl are there always";
    Err(Failure::Usage(format!("--output: {what}")))
}
