//! The options of `durer batch`.

use crate::sandbox::Sandbox;
use crate::values;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer batch models.csv -o out -- render --size 256
  durer batch models.csv -o out --resume -- render --size 256
  durer batch models.csv -o out --shard 3/16 --resume -- render --size 256
  durer batch models.jsonl -o out --shard auto --resume --timeout-per-row 60 --max-memory 2G
  durer batch regions.csv -o out --name '{id}/roads.geojson' -- clip --by city.geojson
  find . -name '*.stl' | jq -cR '{id: ltrimstr(\"./\"), input: .}' | durer batch - -o out
  durer batch models.csv -o out --retry failed -- render --size 256
  durer batch --merge out -o report.csv

The manifest is CSV with a header, JSON Lines, or Parquet (if durer is built with --features geoparquet); one row is one output. \
Columns: `id` (letters, digits, `.`, `_`, `-` and `/`; each one once), `input` (a path, or a data URI), `output` (the \
file's name in OUT; by default --name), `command` (render, clip, draw, plot, tiles or info; by default the one after `--`), \
`sha256` (of the input, to be checked), and options of the command by their long names. A row's option takes the place of \
the same one after `--`. An empty cell is an option that is not given.

The journal in OUT/.durer has a line for each finished row, so that --resume continues after an \
interruption and repeats only rows whose input, options or output changed. SIGTERM and Ctrl-C let the \
running rows finish, at most 25 seconds.

Exit codes: 0 all rows done; 1 the manifest or OUT cannot be read or written, or another process works on the shard; \
2 wrong usage; 3 some rows failed, or were not run.";

/// The options of `durer batch`.
#[derive(Debug, Args)]
pub struct BatchArgs {
    /// Table of rows: CSV, JSON Lines or Parquet, by content; `-` reads standard input
    #[arg(value_name = "MANIFEST", value_hint = ValueHint::FilePath, required_unless_present = "merge")]
    pub manifest: Option<PathBuf>,
    /// Folder to write to, created if needed; with --merge the report: .csv, .jsonl or .parquet, `-` for CSV on
    /// standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// Merge the journals in this folder into one report, ordered by id
    #[arg(long, value_name = "OUT", value_hint = ValueHint::DirPath, conflicts_with_all = ["manifest", "shard", "resume", "restart", "retry", "words"])]
    pub merge: Option<PathBuf>,
    /// Names of the outputs in OUT, without a column `output`: {id}, and {stem}, {name} and {folder} of the input
    /// [default: {id} with the suffix of the format]
    #[arg(long, value_name = "PATTERN")]
    pub name: Option<String>,
    /// Run only this share of the rows, I of N, counted from 0; or `auto`: from the environment of a job array
    ///
    /// A row belongs to a shard by its id alone. `auto` knows Slurm (SLURM_ARRAY_TASK_ID, …_MIN, …_COUNT), AWS Batch
    /// (AWS_BATCH_JOB_ARRAY_INDEX, …_SIZE), Kubernetes (JOB_COMPLETION_INDEX, with DURER_SHARDS for the number of jobs)
    /// and Cloud Run (CLOUD_RUN_TASK_INDEX, …_COUNT). DURER_SHARD and DURER_SHARDS come first.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<String>,
    /// Continue: leave out rows that are done, or failed, with the same input and options
    ///
    /// Rows are run again if their output is missing or has another size, and if they failed because the output could
    /// not be written or the process was killed.
    #[arg(long, conflicts_with = "restart")]
    pub resume: bool,
    /// Ignore the journals in OUT and run all rows
    #[arg(long)]
    pub restart: bool,
    /// Continue as --resume does, and run rows again that failed
    #[arg(long, value_name = "WHICH", conflicts_with = "restart")]
    pub retry: Option<Retry>,
    /// Number of rows to run at the same time, each in a separate process [default: the number of processors]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Threads of each row; the output does not depend on them
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: u16,
    /// Response to a failed row
    #[arg(long, value_name = "WHAT", default_value = "row")]
    pub on_error: OnError,
    /// End a row after this many seconds, as failed [default: never]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::positive)]
    pub timeout_per_row: Option<f64>,
    /// Memory for each row, in bytes with an optional suffix k, M or G; one that needs more has failed [default: half
    /// of the machine's, divided by --jobs, at most 4G]
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_memory: Option<u64>,
    /// Restrict the processes of rows to the folders of their inputs and OUT, by Landlock (Linux)
    ///
    /// A fault in a reader can then neither read nor change other files, nor open connections. The folders are those of
    /// the inputs of all rows of the shard and of the files named by their options. If the system does not support it,
    /// the command stops with an error, or with `best-effort` continues with a warning.
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "strict")]
    pub sandbox: Option<Sandbox>,
    /// Print no progress, and no errors of rows
    #[arg(short, long)]
    pub quiet: bool,
    /// Command of the rows, and options for all of them
    #[arg(last = true, value_name = "COMMAND AND OPTIONS")]
    pub words: Vec<String>,
}

/// `--retry`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Retry {
    /// Rows that failed
    Failed,
}

/// `--on-error`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OnError {
    /// Note it, and go on with the other rows
    Row,
    /// Start no further rows
    Stop,
}
