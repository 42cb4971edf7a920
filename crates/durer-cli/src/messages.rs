//! Messages on standard error.

use crate::options::RunningArgs;
use crate::progress::Progress;
use durer_formats::Warning;
use durer_formats::wording;
use std::sync::{Mutex, PoisonError};

/// Warnings of one model that are printed without `--verbose`; the others are counted.
const WARNINGS: usize = 5;

/// Warnings that are kept instead of being printed, if requested.
static KEPT: Mutex<Option<Vec<String>>> = Mutex::new(None);

/// Collects warnings from now on, and returns the ones collected so far.
pub fn keep() -> Vec<String> {
    KEPT.lock().unwrap_or_else(PoisonError::into_inner).replace(Vec::new()).unwrap_or_default()
}

/// Errors, warnings and progress, as far as requested.
#[derive(Debug)]
pub struct Messages {
    quiet: bool,
    verbose: bool,
    /// The progress line.
    pub progress: Progress,
}

impl Messages {
    /// Creates the messages for `count` pictures or models.
    pub fn new(args: &RunningArgs, count: u64) -> Self {
        let progress = Progress::new(&args.work, count, !args.quiet);
        Self { quiet: args.quiet, verbose: args.verbose, progress }
    }

    /// Prints an error, even with `--quiet`.
    pub fn error(&self, message: impl std::fmt::Display) {
        self.progress.print(&wording::message(&format!("durer: {message}")));
    }

    /// Prints a warning about a file that does not come from its reader.
    pub fn warning(&self, file: &str, message: impl std::fmt::Display) {
        if !self.quiet {
            self.warn(&format!("{file}: {message}"));
        }
    }

    /// Prints a choice that the command made about a file.
    pub fn note(&self, file: &str, message: impl std::fmt::Display) {
        if !self.quiet {
            self.progress.print(&wording::message(&format!("durer: {file}: {message}")));
        }
    }

    /// Prints a warning, or keeps it.
    fn warn(&self, text: &str) {
        if let Some(kept) = &mut *KEPT.lock().unwrap_or_else(PoisonError::into_inner) {
            kept.push(wording::message(text).into_owned());
            return;
        }
        self.progress.print(&wording::message(&format!("durer: warning: {text}")));
    }

    /// Prints the warnings of a model.
    pub fn warnings(&self, file: &str, warnings: &[Warning]) {
        if self.quiet {
            return;
        }
        let shown = if self.verbose { warnings.len() } else { warnings.len().min(WARNINGS) };
        for warning in &warnings[..shown] {
            self.warn(&format!("{file}: {warning}"));
        }
        let rest = warnings.len() - shown;
        if rest > 0 {
            self.warn(&format!("{file}: and {rest} more; --verbose prints all"));
        }
    }

    /// Reports a step for `--verbose`.
    pub fn detail(&self, message: impl FnOnce() -> String) {
        if self.verbose {
            self.progress.print(&wording::message(&format!("durer: {}", message())));
        }
    }
}
