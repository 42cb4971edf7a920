//! Progress on a terminal, for work that takes over half a second.

use crate::watch;
use durer::work::{self, Work};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Shorter work shows nothing.
const PATIENCE: Duration = Duration::from_millis(500);

/// A line on standard error that shows the progress; nothing if it is not a terminal.
#[derive(Debug, Default)]
pub struct Progress {
    /// Work whose progress is counted.
    work: Work,
    shown: Option<Shown>,
}

#[derive(Debug)]
struct Shown {
    bar: ProgressBar,
    /// Dropping it stops the thread that waits to show the bar.
    wake: Option<Sender<()>>,
    waiting: Option<JoinHandle<()>>,
}

impl Progress {
    /// Creates the progress of the work over `count` pictures; `wanted` is false for `--quiet`.
    pub fn new(work: &Work, count: u64, wanted: bool) -> Self {
        let work = work.clone();
        if !wanted || !std::io::stderr().is_terminal() {
            return Self { work, shown: None };
        }
        let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
        let template = if count > 1 {
            "{spinner} {pos}/{len} {wide_msg} {part} {elapsed}, {eta} left"
        } else {
            "{spinner} {wide_msg} {part} {elapsed}"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            let counted = work.clone();
            // Writing to a text cannot fail.
            let part = move |_: &ProgressState, out: &mut dyn Write| {
                let _ = out.write_str(&percent(counted.progress()));
            };
            bar.set_style(style.with_key("part", part));
        }
        let (wake, woken) = channel::<()>();
        let late = bar.clone();
        let waiting = std::thread::spawn(move || {
            if woken.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                late.set_draw_target(ProgressDrawTarget::stderr());
                late.enable_steady_tick(Duration::from_millis(100));
            }
        });
        let shown = Some(Shown { bar, wake: Some(wake), waiting: Some(waiting) });
        Self { work, shown }
    }

    /// Shows the current stage of the work.
    pub fn stage(&self, what: impl FnOnce() -> String) {
        let what = what();
        // The previous stage has ended.
        self.work.begin("", 0);
        if let Some(shown) = &self.shown {
            shown.bar.set_message(what.clone());
        }
        watch::now(what);
    }

    /// Counts one more picture as done.
    pub fn advance(&self) {
        if let Some(shown) = &self.shown {
            shown.bar.inc(1);
        }
    }

    /// Writes a line to standard error without tearing the progress line.
    pub fn print(&self, line: &str) {
        use std::io::Write;
        // If standard error is closed, the line is lost.
        let write = || drop(writeln!(std::io::stderr().lock(), "{line}"));
        match &self.shown {
            Some(shown) => shown.bar.suspend(write),
            None => write(),
        }
    }
}

/// Formats the progress of a stage, in percent; empty if nothing is counted.
fn percent(progress: work::Progress) -> String {
    progress.share().map_or_else(String::new, |share| format!("{:.0} %", (share * 100.0).floor()))
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(shown) = &mut self.shown {
            shown.wake = None;
            if let Some(waiting) = shown.waiting.take() {
                // The thread only waits and sets a flag; it has nothing to fail with.
                let _ = waiting.join();
            }
            shown.bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_counted_is_reported_in_percent() {
        let work = Work::stoppable();
        assert_eq!(percent(work.progress()), "");
        work.begin("rows", 3);
        work.advance(2);
        assert_eq!(percent(work.progress()), "66 %");
        Progress::new(&work, 1, false).stage(|| "reading".to_owned());
        assert_eq!(percent(work.progress()), "");
    }
}
