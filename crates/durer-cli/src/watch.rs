//! Ends the command where it takes too long or too much memory, and on Ctrl-C and termination.
//!
//! A thread looks at the clock, at the memory that the process holds, and for signals. It stops the work ([`Work`]),
//! which then ends with an error at its next check. Work that does not check, as in a library, is ended after a while:
//! the files that are not whole are removed, and the process exits.

use crate::options::RunningArgs;
use crate::{beside, memory};
use durer::Error;
use durer::work::Work;
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The time that stopped work has to end by itself, and the same after a signal.
const GRACE: Duration = Duration::from_secs(1);
const GRACE_OF_SIGNALS: Duration = Duration::from_millis(100);

/// The time between two checks, and the longer one while no limit is near.
const OFTEN: Duration = Duration::from_millis(4);
const SELDOM: Duration = Duration::from_millis(20);

/// Memory held besides the charged memory: the program itself, stacks, and small values.
const BESIDES: u64 = 16 << 20;

/// The process ends at once where it holds this much and an eighth of the budget more than allowed.
const SLACK: u64 = 8 << 20;

/// The current stage, for the message of a forced end.
static NOW: Mutex<String> = Mutex::new(String::new());

/// The file that it works on.
static FILE: Mutex<String> = Mutex::new(String::new());

/// Set once a model is done, so that ending early leaves some output.
static DONE: AtomicBool = AtomicBool::new(false);

/// The number of the signal that came.
static SIGNAL: OnceLock<Arc<AtomicUsize>> = OnceLock::new();

/// Sets the stage that the command is in.
pub fn now(what: String) {
    *NOW.lock().unwrap_or_else(PoisonError::into_inner) = what;
}

/// Sets the file that the command works on.
pub fn of_file(name: String) {
    *FILE.lock().unwrap_or_else(PoisonError::into_inner) = name;
}

/// Notes that a result is complete and stays, whatever happens later.
pub fn done() {
    DONE.store(true, Ordering::Relaxed);
}

/// Returns the exit code for the signal that came, if one did.
pub fn interrupted() -> Option<u8> {
    let signal = SIGNAL.get().map_or(0, |signal| signal.load(Ordering::Relaxed));
    u8::try_from(signal).ok().filter(|signal| *signal > 0).map(|signal| 128 + signal)
}

/// Returns the work of a command, within its budget.
pub fn work(args: &RunningArgs) -> Work {
    let budget = args.max_memory.unwrap_or_else(memory::usual_budget);
    Work::with_budget(budget, "--max-memory")
}

/// Work that is watched, with its limits.
struct Watched {
    work: Work,
    timeout: Option<f64>,
    /// Name of the option for the time.
    option: &'static str,
    start: Instant,
    /// Time at which the work was stopped because of its memory.
    stopped: Option<Instant>,
}

/// The work that is watched now.
static WATCHED: Mutex<Option<Watched>> = Mutex::new(None);

fn watched() -> MutexGuard<'static, Option<Watched>> {
    WATCHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Watches the command from now on. If no thread can be started, signals end it in the usual way.
pub fn start(args: &RunningArgs) {
    begin(&args.work, args.timeout, "--timeout");
    spawn(note_signals);
}

/// Watches rows from now on, one after the other; signals are left to the process that started this one.
pub fn start_rows() {
    for number in signals() {
        let _ = signal_hook::flag::register(number, Arc::default());
    }
    spawn(|| ());
}

/// Watches this work in place of other work, for a time that begins now.
pub fn begin(work: &Work, timeout: Option<f64>, option: &'static str) {
    let (work, start) = (work.clone(), Instant::now());
    *watched() = Some(Watched { work, timeout, option, start, stopped: None });
}

/// Ends the watch over the current work.
pub fn over() {
    *watched() = None;
}

/// Starts the thread that watches; it ends with the process.
fn spawn(first: impl FnOnce() + Send + 'static) {
    let _ = thread::Builder::new().name("watch".to_owned()).spawn(move || {
        first();
        watch();
    });
}

fn signals() -> impl Iterator<Item = i32> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    #[cfg(unix)]
    let signals = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
    #[cfg(not(unix))]
    let signals = [SIGINT, SIGTERM];
    signals.into_iter()
}

/// Records signals from now on, in place of letting them end the process.
pub fn note_signals() {
    let signal = SIGNAL.get_or_init(Arc::default);
    for number in signals() {
        // One that cannot be noted ends the process at once.
        let _ = signal_hook::flag::register_usize(number, signal.clone(), number as usize);
    }
}

/// Returns whether a signal came since this was called last.
pub fn take_signal() -> bool {
    SIGNAL.get().is_some_and(|signal| signal.swap(0, Ordering::Relaxed) > 0)
}

fn watch() {
    let mut end_at = None;
    loop {
        // The watched work may end while it is examined, so the lock is kept.
        let mut guard = watched();
        let wait = match &mut *guard {
            None => OFTEN,
            Some(watched) => {
                if let Some(code) = interrupted() {
                    watched.work.stop(Error::Cancelled);
                    let end = *end_at.get_or_insert_with(|| Instant::now() + GRACE_OF_SIGNALS);
                    if Instant::now() >= end {
                        end_with(None, code.into());
                    }
                }
                watched.look_at_clock();
                watched.look_at_memory()
            }
        };
        drop(guard);
        thread::sleep(wait);
    }
}

impl Watched {
    fn look_at_clock(&self) {
        let Some(seconds) = self.timeout else { return };
        let (allowed, taken) = (Duration::try_from_secs_f64(seconds), self.start.elapsed());
        let allowed = allowed.unwrap_or(Duration::MAX);
        if taken >= allowed {
            let error = Error::TimedOut { seconds, option: self.option };
            self.work.stop(error.clone());
            if taken >= allowed.saturating_add(GRACE) {
                end(&error);
            }
        }
    }

    /// Compares the memory in use with the budget, and stops the work above it; returns the time until the next look.
    fn look_at_memory(&mut self) -> Duration {
        let (budget, Some(held)) = (self.work.budget(), memory::held()) else { return SELDOM };
        let above = held.saturating_sub(BESIDES);
        if above > budget {
            self.work.stop_at(above);
            let since = *self.stopped.get_or_insert_with(Instant::now);
            if above > budget.saturating_add(budget / 8 + SLACK) || since.elapsed() >= GRACE {
                let stage = self.work.stage();
                end(&Error::Memory { stage, need: above, budget, option: "--max-memory" });
            }
        } else {
            self.stopped = None;
        }
        if above > budget / 2 || budget < 512 << 20 { OFTEN } else { SELDOM }
    }
}

/// Ends the process with an error.
fn end(error: &Error) -> ! {
    let [now, file] =
        [&NOW, &FILE].map(|s| s.lock().unwrap_or_else(PoisonError::into_inner).clone());
    let file = Some(file).filter(|file| !now.contains(file.as_str()));
    let now = Some(now).filter(|now| !now.is_empty());
    let parts = [file, now, Some(error.to_string())].into_iter().flatten();
    let message = parts.collect::<Vec<_>>().join(": ");
    end_with(Some(message), if DONE.load(Ordering::Relaxed) { 3 } else { 1 })
}

fn end_with(message: Option<String>, code: i32) -> ! {
    beside::end(|| {
        let mut out = std::io::stderr().lock();
        if let Some(message) = message {
            // Overwrites the progress line. If standard error is closed, the message is lost.
            let clear = if out.is_terminal() { "\r\x1b[2K" } else { "" };
            let _ = writeln!(out, "{clear}durer: {message}");
        }
        code
    })
}
