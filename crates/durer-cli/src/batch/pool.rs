//! Rows are run at the same time, each by a worker.

use super::child::{Outcome, Worker};
use super::entry::{Entry, Kind, RowError, Status};
use super::journal::Journal;
use super::rows::{Row, Rows};
use super::task::{self, Answer, Setup, Task};
use super::worker::TIMEOUT;
use crate::batch_args::{BatchArgs, OnError};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::watch;
use durer::Error;
use durer::work::Work;
use durer_formats::wording;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time that running rows have after a signal.
const GRACE: Duration = Duration::from_secs(25);

/// Time between two looks for signals.
const LOOK: Duration = Duration::from_millis(20);

/// Time between two changes of the rate that is shown.
const SHOW: Duration = Duration::from_millis(500);

/// Lives of a row whose workers are killed.
const LIVES: u32 = 2;

/// Attempts to start a worker.
const STARTS: u32 = 3;

/// Results of a journal that count.
pub type Known = HashMap<String, (task::Known, Status)>;

/// Numbers of rows.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Rows run now.
    pub done: u64,
    /// Rows done before.
    pub same: u64,
    /// Rows that failed, now or before.
    pub failed: u64,
    /// Rows that were not run.
    pub left: u64,
}

/// The rows, and the state of the run.
pub struct Pool<'a> {
    args: &'a BatchArgs,
    setup: Setup,
    rows: &'a Rows,
    known: Known,
    next: AtomicUsize,
    journal: Mutex<Journal>,
    counts: Mutex<Counts>,
    progress: Progress,
    start: Instant,
    /// True if no further rows are started.
    stopped: AtomicBool,
    /// Running rows are not waited for.
    abandoned: AtomicBool,
    /// A warning of workers was shown.
    warned: AtomicBool,
    /// Reason why the batch stopped.
    failure: Mutex<Option<Failure>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<'a> Pool<'a> {
    /// Creates the state before the first row.
    pub fn new(
        args: &'a BatchArgs,
        setup: Setup,
        rows: &'a Rows,
        known: Known,
        journal: Journal,
    ) -> Self {
        Self {
            args,
            setup,
            rows,
            known,
            next: AtomicUsize::new(0),
            journal: Mutex::new(journal),
            counts: Mutex::default(),
            progress: Progress::new(&Work::default(), rows.rows.len() as u64, !args.quiet),
            start: Instant::now(),
            stopped: AtomicBool::new(false),
            abandoned: AtomicBool::new(false),
            warned: AtomicBool::new(false),
            failure: Mutex::new(None),
        }
    }

    /// Runs all rows, as many at a time as there are jobs.
    pub fn run(self, jobs: usize) -> Result<Counts, Failure> {
        std::thread::scope(|scope| {
            let serving: Vec<_> = (0..jobs).map(|_| scope.spawn(|| self.serve())).collect();
            let (mut end_at, mut shown) = (None, Instant::now());
            while !serving.iter().all(|thread| thread.is_finished()) {
                if watch::take_signal() {
                    self.stopped.store(true, Ordering::Relaxed);
                    // The second one ends the wait.
                    let end = if end_at.is_some() { Duration::ZERO } else { GRACE };
                    end_at = Some(Instant::now() + end);
                }
                if end_at.is_some_and(|end| Instant::now() >= end) {
                    self.abandoned.store(true, Ordering::Relaxed);
                }
                if shown.elapsed() >= SHOW {
                    shown = Instant::now();
                    self.progress.stage(|| self.rate(end_at.is_some()));
                }
                std::thread::sleep(LOOK);
            }
        });
        if let Some(failure) = lock(&self.failure).take() {
            return Err(failure);
        }
        let mut counts = *lock(&self.counts);
        counts.left = self.rows.rows.len() as u64 - counts.done - counts.same - counts.failed;
        Ok(counts)
    }

    /// Describes how fast rows are run.
    fn rate(&self, ends: bool) -> String {
        let Counts { done, failed, .. } = *lock(&self.counts);
        let rate = (done + failed) as f64 / self.start.elapsed().as_secs_f64().max(1e-3);
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        let ends = if ends { "; ending" } else { "" };
        format!("{rate:.1} rows/s{failed}{ends}")
    }

    /// Runs rows with one worker after the other, until there are no more.
    fn serve(&self) {
        let mut worker = None;
        while let Some(row) = self.next() {
            let known = self.known.get(&row.id);
            let task = self.rows.task(row, known.map(|(known, _)| known.clone()));
            let served = match self.run_row(&mut worker, &task) {
                Ok(Some(Answer::Ran(entry))) => self.note(&entry),
                Ok(Some(Answer::Same)) => {
                    self.count(known.map_or(Status::Done, |(_, status)| *status), true);
                    Ok(())
                }
                Ok(Some(Answer::Runs(_)) | None) => return,
                Err(failure) => Err(failure),
            };
            if let Err(failure) = served {
                self.stopped.store(true, Ordering::Relaxed);
                lock(&self.failure).get_or_insert(failure);
            }
        }
    }

    fn next(&self) -> Option<&Row> {
        if self.stopped.load(Ordering::Relaxed) {
            return None;
        }
        self.rows.rows.get(self.next.fetch_add(1, Ordering::Relaxed))
    }

    /// Runs a row, again if its worker was killed; `None` if its result is no longer needed.
    fn run_row(&self, kept: &mut Option<Worker>, task: &Task) -> Result<Option<Answer>, Failure> {
        let start = Instant::now();
        let failed = |kind, message: &str, key: Option<String>| {
            let (seconds, names) = (start.elapsed().as_secs_f64(), &task.inputs);
            let error = RowError::new(kind, message, names);
            let entry = Entry::failed(&task.id, &task.output, seconds, error);
            Ok(Some(Answer::Ran(Box::new(Entry { key, ..entry }))))
        };
        let (mut words, mut key) = (String::new(), None);
        for _ in 0..LIVES {
            let mut worker = match kept.take() {
                Some(worker) => worker,
                None => self.worker()?,
            };
            match worker.run(task, self.args.timeout_per_row, &self.abandoned, &mut key) {
                Outcome::Answered(answer) => {
                    // After a panic the worker's state is uncertain.
                    if !is_fault(&answer) {
                        *kept = Some(worker);
                    }
                    return Ok(Some(answer));
                }
                Outcome::TimedOut => {
                    let seconds = self.args.timeout_per_row.unwrap_or_default();
                    let error = Error::TimedOut { seconds, option: TIMEOUT };
                    return failed(Kind::Timeout, &error.to_string(), key);
                }
                Outcome::Abandoned => return Ok(None),
                Outcome::Died(last) => words = last,
            }
            // Messages with which the worker ends by itself.
            for (option, kind) in [(TIMEOUT, Kind::Timeout), ("--max-memory", Kind::Memory)] {
                if words.contains(option) {
                    return failed(kind, &words, key);
                }
            }
        }
        failed(Kind::Crash, &words, key)
    }

    /// Starts a worker; if it is killed while starting, another one is started.
    fn worker(&self) -> Result<Worker, Failure> {
        let mut started = Worker::start(&self.setup);
        for _ in 1..STARTS {
            if started.is_ok() {
                break;
            }
            started = Worker::start(&self.setup);
        }
        let warning = started.as_mut().ok().and_then(|worker| worker.warning.take());
        if let Some(warning) = warning.filter(|_| !self.warned.swap(true, Ordering::Relaxed)) {
            self.progress.print(&format!("durer: warning: {warning}"));
        }
        started
    }

    /// Notes and counts a row that was run.
    fn note(&self, entry: &Entry) -> Result<(), Failure> {
        lock(&self.journal).append(entry)?;
        if let Some(error) = &entry.error {
            if self.args.on_error == OnError::Stop {
                self.stopped.store(true, Ordering::Relaxed);
            }
            if !self.args.quiet {
                let place = if error.place.is_empty() { "" } else { ": " };
                let message =
                    format!("durer: {}: {}{place}{}", entry.id, error.place, error.message);
                self.progress.print(&wording::message(&message));
            }
        }
        self.count(entry.status, false);
        Ok(())
    }

    /// Counts a row, run now or `before`.
    fn count(&self, status: Status, before: bool) {
        let mut counts = lock(&self.counts);
        *match status {
            Status::Failed => &mut counts.failed,
            Status::Done if before => &mut counts.same,
            Status::Done => &mut counts.done,
        } += 1;
        self.progress.advance();
    }
}

fn is_fault(answer: &Answer) -> bool {
    let Answer::Ran(entry) = answer else { return false };
    entry.error.as_ref().is_some_and(|error| error.kind == Kind::Fault)
}
