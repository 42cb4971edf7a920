//! `durer batch`: the rows of a table, each run in a process that may fail.

mod child;
mod entry;
mod journal;
mod key;
mod manifest;
mod merge;
mod options;
mod pool;
mod rows;
mod shard;
mod task;
mod worker;

pub use worker::work;

use crate::batch_args::BatchArgs;
use crate::failure::{Failure, in_words};
use crate::memory;
use crate::places::is_stream;
use crate::watch;
use entry::{Entry, Status};
use journal::Journal;
use pool::{Counts, Known, Pool};
use rows::Rows;
use shard::Shard;
use std::collections::HashMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::thread::available_parallelism;
use std::time::Instant;
use task::Setup;

/// Least memory of a row.
const LEAST_MEMORY: u64 = 64 << 20;

/// Runs the rows of a shard, or joins journals.
pub fn run(args: &BatchArgs) -> Result<(), Failure> {
    if let Some(out) = &args.merge {
        return merge::run(out, &args.output);
    }
    let Some(manifest) = &args.manifest else {
        return Err(Failure::Usage("a manifest is missing".to_owned()));
    };
    let start = Instant::now();
    let shard = match &args.shard {
        Some(text) => Shard::parse(text, |name| std::env::var(name).ok())?,
        None => Shard::ALL,
    };
    // A signal ends the wait for a manifest that somebody writes, and is noted while one is read from a file.
    let waits = is_stream(manifest);
    if !waits {
        watch::note_signals();
    }
    let rows = Rows::read(args, manifest, shard)?;
    if waits {
        watch::note_signals();
    }
    if let Some(hint) = rows.elsewhere(manifest).filter(|_| !args.quiet) {
        let _ = writeln!(std::io::stderr().lock(), "durer: {hint}");
    }
    let out = folder(&args.output)?;
    let mut journal = Journal::open(&out, shard)?;
    if args.restart {
        journal.clear()?;
    }
    let resumes = args.resume || args.retry.is_some();
    if !resumes && !journal.is_empty() {
        let what =
            "rows of this shard were run before; --resume continues, --restart runs all again";
        return Err(Failure::Usage(format!("{}: {what}", args.output.display())));
    }
    let known = if resumes { known(args, &out, &rows)? } else { Known::new() };
    let temporary = out.join(journal::FOLDER).join(format!("{}.tmp", shard.file_name()));
    // Only one process runs at a time, so its contents were left by a killed one.
    let made = remove(&temporary).and_then(|()| fs::create_dir_all(&temporary));
    made.map_err(|e| Failure::of_file(&temporary, in_words(&e)))?;
    let processors = available_parallelism().map_or(1, usize::from);
    let usual = (processors / usize::from(args.threads)).max(1);
    let jobs = args.jobs.map_or(usual, usize::from).min(rows.rows.len());
    let share = memory::usual_budget_of(jobs as u64).max(LEAST_MEMORY);
    let setup = Setup {
        out,
        temporary: temporary.clone(),
        threads: args.threads,
        max_memory: args.max_memory.unwrap_or(share),
        timeout: args.timeout_per_row,
        sandbox: args.sandbox,
        read: args.sandbox.map_or_else(Vec::new, |_| rows.folders()),
    };
    let ended = Pool::new(args, setup, &rows, known, journal).run(jobs);
    // Nothing in it is needed.
    let _ = remove(&temporary);
    let counts = ended?;
    if !args.quiet {
        let line = format!("durer: {}", summary(&counts, start.elapsed().as_secs_f64()));
        // If standard error is closed, the message is lost.
        let _ = writeln!(std::io::stderr().lock(), "{line}");
    }
    if counts.failed + counts.left > 0 { Err(Failure::Partial) } else { Ok(()) }
}

/// Creates the folder of outputs and journals; returns its full path, which workers write to.
fn folder(out: &Path) -> Result<std::path::PathBuf, Failure> {
    let made = fs::create_dir_all(out.join(journal::FOLDER));
    made.map_err(|e| Failure::of_file(out, in_words(&e)))?;
    Ok(out.to_owned())
}

fn remove(folder: &Path) -> std::io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Returns the keys of rows that need not be run if they have not changed: rows that are done and whose files exist,
/// and rows that failed for lasting reasons.
fn known(args: &BatchArgs, out: &Path, rows: &Rows) -> Result<Known, Failure> {
    let mut last: HashMap<String, Option<Entry>> =
        rows.rows.iter().map(|row| (row.id.clone(), None)).collect();
    journal::read_all(out, |entry| {
        if let Some(known) = last.get_mut(&entry.id)
            && known.as_ref().is_none_or(|known| known.ended <= entry.ended)
        {
            *known = Some(entry);
        }
    })?;
    let is_there = |(name, bytes): (&str, u64)| {
        fs::metadata(out.join(name)).is_ok_and(|m| m.is_file() && m.len() == bytes)
    };
    let counts = |entry: &Entry| match (entry.status, &entry.error) {
        (Status::Done, _) => entry.files().all(is_there),
        (Status::Failed, Some(error)) => args.retry.is_none() && !error.kind.passes(),
        (Status::Failed, None) => false,
    };
    let known = last.into_values().flatten().filter(counts);
    let of = |e: Entry| Some((e.id, (task::Known { key: e.key?, read: e.read }, e.status)));
    Ok(known.filter_map(of).collect())
}

/// Describes the results of the rows.
fn summary(counts: &Counts, seconds: f64) -> String {
    let Counts { done, same, failed, left } = *counts;
    let rows = if done == 1 { "row" } else { "rows" };
    let mut parts = vec![format!("{done} {rows} done")];
    let mut some = |count: u64, what: &str| {
        if count > 0 {
            parts.push(format!("{count} {what}"));
        }
    };
    some(same, "done before");
    some(failed, "failed");
    some(left, "not run; --resume continues");
    let rate = (done + failed) as f64 / seconds.max(1e-3);
    format!("{}; {seconds:.1} s, {rate:.1} rows/s", parts.join(", "))
}
