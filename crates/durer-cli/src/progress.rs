//! Progress on a terminal, for work that takes over half a second.

use crate::watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Shorter work shows nothing.
const PATIENCE: Duration = Duration::from_millis(500);

/// A line on standard error that says what is being done; nothing where that is no terminal.
#[derive(Debug, Default)]
pub struct Progress {
    shown: Option<Shown>,
}

#[derive(Debug)]
struct Shown {
    bar: ProgressBar,
    /// Dropping it tells the thread that waits to show the bar that there is no need any more.
    wake: Option<Sender<()>>,
    waiting: Option<JoinHandle<()>>,
}

impl Progress {
    /// Progress over `count` pictures; `wanted` is false for `--quiet`.
    pub fn new(count: u64, wanted: bool) -> Self {
        if !wanted || !std::io::stderr().is_terminal() {
            return Self::default();
        }
        let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
        let template = if count > 1 {
            "{spinner} {pos}/{len} {wide_msg} {elapsed}, {eta} left"
        } else {
            "{spinner} {wide_msg} {elapsed}"
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let (wake, woken) = channel::<()>();
        let late = bar.clone();
        let waiting = std::thread::spawn(move || {
            if woken.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                late.set_draw_target(ProgressDrawTarget::stderr());
                late.enable_steady_tick(Duration::from_millis(100));
            }
        });
        Self { shown: Some(Shown { bar, wake: Some(wake), waiting: Some(waiting) }) }
    }

    /// Says what is being done.
    pub fn stage(&self, what: impl FnOnce() -> String) {
        let what = what();
        if let Some(shown) = &self.shown {
            shown.bar.set_message(what.clone());
        }
        watch::now(what);
    }

    /// One more picture is done.
    pub fn advance(&self) {
        if let Some(shown) = &self.shown {
            shown.bar.inc(1);
        }
    }

    /// Writes a line to standard error without tearing the progress line.
    pub fn tell(&self, line: &str) {
        use std::io::Write;
        // A closed standard error leaves nobody to tell.
        let write = || drop(writeln!(std::io::stderr().lock(), "{line}"));
        match &self.shown {
            Some(shown) => shown.bar.suspend(write),
            None => write(),
        }
    }
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
