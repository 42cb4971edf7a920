//! Panics, which are reported if they end the command; one that a reader catches is an error of its
//! file.

use std::backtrace::{Backtrace, BacktraceStatus};
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook};
use std::sync::Mutex;

/// Message and place of the last panic, and the backtrace if `RUST_BACKTRACE` requests it.
static LAST: Mutex<String> = Mutex::new(String::new());

/// Runs the work; if it panics, reports that and continues unwinding.
pub fn reported_at_the_end<T>(work: impl FnOnce() -> T) -> T {
    set_hook(Box::new(|panic| {
        let mut report = panic.to_string();
        let calls = Backtrace::capture();
        if calls.status() == BacktraceStatus::Captured {
            report += &format!("\n{calls}");
        }
        *LAST.lock().unwrap_or_else(|e| e.into_inner()) = report;
    }));
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let report = LAST.lock().unwrap_or_else(|e| e.into_inner());
        let _ = writeln!(std::io::stderr().lock(), "durer: this is a bug in durer: {report}");
        drop(report);
        resume_unwind(payload)
    })
}

/// Runs the work; returns message and place of its panic instead of a result.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|_| LAST.lock().unwrap_or_else(|e| e.into_inner()).clone())
}
