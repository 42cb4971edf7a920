//! The options of the run itself.

use crate::sandbox::Sandbox;
use crate::values;
use clap::Args;

/// Options for the run itself: threads, limits, progress.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Running")]
pub struct RunningArgs {
    /// Work on so many threads [default: as many as there are processors]; the pictures are the same
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Work with these SIMD instructions: scalar, sse2, sse4.2, avx2, avx512, neon or auto [default: auto, the best of the
    /// machine]; the pictures are the same
    #[arg(long, value_name = "LEVEL", value_parser = values::simd_level)]
    pub simd: Option<durer::simd::Level>,
    /// Take no more memory than this for the work, in bytes; k, M, G are understood [default: half of what the machine or its
    /// control group allows, at most 4G]
    ///
    /// Work that needs more ends with an error that names the stage and the option. The other limits of size count towards
    /// this one.
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_memory: Option<u64>,
    /// End with an error after so many seconds [default: never]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::positive)]
    pub timeout: Option<f64>,
    /// The budget, and what stops the work.
    #[arg(skip)]
    pub work: durer::work::Work,
    /// Open nothing but the folders of what is read and of what is written, by Landlock (Linux)
    ///
    /// A fault in a reader can then neither read nor change other files, nor open connections. Where the system
    /// cannot do that, the command ends with an error, or with `best-effort` goes on with a warning.
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "strict")]
    pub sandbox: Option<Sandbox>,
    /// No warnings and no progress; errors are still told
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// All warnings, and what was done
    #[arg(short, long)]
    pub verbose: bool,
}
