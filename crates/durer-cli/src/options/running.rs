//! The options of the run itself.

use crate::sandbox::Sandbox;
use crate::values;
use clap::Args;

/// Options for the run itself: threads, limits, progress.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Running")]
pub struct RunningArgs {
    /// Use at most this many threads [default: the number of processors]; the output does not depend
    /// on it
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Use these SIMD instructions: scalar, sse2, sse4.2, avx2, avx512, neon or auto [default: auto, the best of the
    /// machine]; the output does not depend on them
    #[arg(long, value_name = "LEVEL", value_parser = values::simd_level)]
    pub simd: Option<durer::simd::Level>,
    /// Use at most this much memory, in bytes with an optional suffix k, M or G [default: half of what the machine or
    /// its control group allows, at most 4G]
    ///
    /// Work that needs more ends with an error that names the stage and the option. The other limits of size count
    /// towards this one.
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_memory: Option<u64>,
    /// Stop with an error after this many seconds [default: never]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::positive)]
    pub timeout: Option<f64>,
    /// The budget and cancellation of the work.
    #[arg(skip)]
    pub work: durer::work::Work,
    /// Restrict file access to the folders of inputs and outputs, by Landlock (Linux)
    ///
    /// A fault in a reader can then neither read nor change other files, nor open connections. If the system
    /// does not support it, the command stops with an error, or with `best-effort` continues with a warning.
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "strict")]
    pub sandbox: Option<Sandbox>,
    /// Print no warnings and no progress; errors are still printed
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print all warnings and a summary
    #[arg(short, long)]
    pub verbose: bool,
}
