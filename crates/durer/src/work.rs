//! The cost of work: a budget of memory, and a way to stop it.
//!
//! A [`Work`] is a value that options hand down. Large buffers are charged to it before they are made, each as a whole, so
//! that normal work does not get slower by it; long loops ask it at times whether to go on. Nothing of it is global: two
//! pictures that are made at the same time have a budget each, or one together, as their caller wants it.
//!
//! ```
//! use durer::work::Work;
//!
//! let work = Work::with_budget(1 << 20, "--max-memory");
//! let planes = work.charge("planes of the picture", 600_000)?;
//! let message = work.charge("glyphs", 600_000).unwrap_err().to_string();
//! assert_eq!(message, "glyphs: 1.1 MB of memory are needed, --max-memory allows 1 MB");
//! drop(planes);
//! assert!(work.charge("glyphs", 600_000).is_ok());
//! # Ok::<(), durer::Error>(())
//! ```
//!
//! It also counts progress: see [`Work::progress`].

use crate::{Error, Result};
use std::mem::size_of;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Planes below this are made without asking whether the system has so much: it has, or all ends anyway.
const LARGE: u64 = 16 << 20;

/// A budget of memory and a flag that stops the work; clones share both. The default has no bound and is never stopped.
#[derive(Debug, Clone, Default)]
pub struct Work(Option<Arc<Scope>>);

/// A part of the work, and the memory that is kept for it.
#[derive(Debug)]
struct Scope {
    shared: Arc<Shared>,
    /// Bytes that are given back with the last handle.
    kept: AtomicU64,
}

/// State that all parts share.
#[derive(Debug)]
struct Shared {
    /// Bytes.
    budget: u64,
    /// Name of the setting for the budget.
    option: &'static str,
    /// Bytes that are charged.
    used: AtomicU64,
    stopped: AtomicBool,
    why: Mutex<Option<Error>>,
    stage: Mutex<&'static str>,
    /// Stage that [`Work::begin`] named last, and its counts of finished and of all steps.
    counted: Mutex<&'static str>,
    done: AtomicU64,
    of: AtomicU64,
}

/// Progress of work, as [`Work::progress`] returns it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Progress {
    /// Current stage: `"rows of tiles"`, `"lines"`, …; empty before the first counted one.
    pub stage: &'static str,
    /// Number of finished steps; at most `of`.
    pub done: u64,
    /// Number of all steps.
    pub of: u64,
}

impl Progress {
    /// Returns the part that is done, 0 to 1; `None` before anything that is counted.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.done as f64 / self.of as f64)
    }
}

/// Two are equal where they are clones of each other, or both have no bound.
impl PartialEq for Work {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

impl Eq for Work {}

impl Drop for Scope {
    fn drop(&mut self) {
        self.shared.give_back(self.kept.load(Ordering::Relaxed));
    }
}

impl Shared {
    fn take(&self, stage: &'static str, bytes: u64) -> Result<()> {
        let mut used = self.used.load(Ordering::Relaxed);
        loop {
            let need = used.saturating_add(bytes);
            if need > self.budget {
                return Err(self.refused(stage, need));
            }
            let order = Ordering::Relaxed;
            match self.used.compare_exchange_weak(used, need, order, order) {
                Ok(_) => return Ok(()),
                Err(now) => used = now,
            }
        }
    }

    fn refused(&self, stage: &'static str, need: u64) -> Error {
        Error::Memory { stage, need, budget: self.budget, option: self.option }
    }

    fn give_back(&self, bytes: u64) {
        self.used.fetch_sub(bytes, Ordering::Relaxed);
    }

    fn stop(&self, why: Error) {
        lock(&self.why).get_or_insert(why);
        self.stopped.store(true, Ordering::Relaxed);
    }
}

impl Work {
    /// Work that may hold `bytes` at a time, in what is charged; `option` is what errors call the budget, such as
    /// `"--max-memory"`.
    pub fn with_budget(bytes: u64, option: &'static str) -> Self {
        let shared = Shared {
            budget: bytes,
            option,
            used: AtomicU64::new(0),
            stopped: AtomicBool::new(false),
            why: Mutex::new(None),
            stage: Mutex::new("start"),
            counted: Mutex::new(""),
            done: AtomicU64::new(0),
            of: AtomicU64::new(0),
        };
        Self(Some(Arc::new(Scope { shared: Arc::new(shared), kept: AtomicU64::new(0) })))
    }

    /// Work without a budget that can be stopped.
    pub fn stoppable() -> Self {
        Self::with_budget(u64::MAX, "the budget")
    }

    /// Returns a part of the work: it shares budget and stop, and what is kept for it is given back when all clones of it
    /// are gone.
    pub fn part(&self) -> Self {
        let part = |scope: &Arc<Scope>| {
            Arc::new(Scope { shared: scope.shared.clone(), kept: AtomicU64::new(0) })
        };
        Self(self.0.as_ref().map(part))
    }

    /// Takes memory that is given back when the charge is dropped. Once for each buffer, or each thousand elements.
    ///
    /// # Errors
    /// [`Error::Memory`] where the budget has not so much left; what stopped the work, where something did.
    pub fn charge(&self, stage: &'static str, bytes: u64) -> Result<Charge> {
        let mut charge = Charge { scope: self.0.clone(), stage, bytes: 0 };
        charge.grow(bytes)?;
        Ok(charge)
    }

    /// Charges like [`Self::charge`], for a number of elements of a type.
    ///
    /// # Errors
    /// As [`Self::charge`].
    pub fn charge_for<T>(&self, stage: &'static str, count: u64) -> Result<Charge> {
        self.charge(stage, count.saturating_mul(size_of::<T>() as u64))
    }

    /// Takes memory for what stays as long as this part of the work, such as a model that is read.
    ///
    /// # Errors
    /// As [`Self::charge`].
    pub fn keep(&self, stage: &'static str, bytes: u64) -> Result<()> {
        let Some(scope) = &self.0 else { return Ok(()) };
        self.enter(stage);
        self.check()?;
        scope.shared.take(stage, bytes)?;
        scope.kept.fetch_add(bytes, Ordering::Relaxed);
        Ok(())
    }

    /// Keeps a charge like [`Self::keep`], if an error cannot be returned: exceeding the budget stops the work, so that its
    /// next check fails. Returns whether it fits.
    pub fn keep_or_stop(&self, stage: &'static str, bytes: u64) -> bool {
        self.keep(stage, bytes).map_err(|error| self.stop(error)).is_ok()
    }

    /// Returns whether the work shall go on: one load where it shall. For long loops, by the row, tile or thousand steps.
    ///
    /// # Errors
    /// Reason given to [`Self::stop`].
    #[inline]
    pub fn check(&self) -> Result<()> {
        match &self.0 {
            Some(scope) if scope.shared.stopped.load(Ordering::Relaxed) => Err(self.why()),
            _ => Ok(()),
        }
    }

    /// Returns whether [`Self::check`] fails, for loops that leave the error to their callers.
    #[inline]
    pub fn is_stopped(&self) -> bool {
        self.0.as_ref().is_some_and(|scope| scope.shared.stopped.load(Ordering::Relaxed))
    }

    #[cold]
    fn why(&self) -> Error {
        let why = self.0.as_ref().map(|scope| lock(&scope.shared.why).clone());
        why.flatten().unwrap_or(Error::Cancelled)
    }

    /// Stops the work: from here on it fails with this error at its next check. The first reason counts.
    pub fn stop(&self, why: Error) {
        if let Some(scope) = &self.0 {
            scope.shared.stop(why);
        }
    }

    /// Stops the work, as [`Self::stop`], because it is seen to hold this many bytes, more than its
    /// budget.
    pub fn stop_at(&self, bytes: u64) {
        if let Some(scope) = &self.0 {
            self.stop(scope.shared.refused(self.stage(), bytes));
        }
    }

    /// Lets work go on that was stopped for its memory, after what needed so much has been dropped. Returns whether it may:
    /// what was stopped for another reason stays stopped.
    pub fn go_on(&self) -> bool {
        let Some(scope) = &self.0 else { return true };
        let mut why = lock(&scope.shared.why);
        if !matches!(*why, None | Some(Error::Memory { .. })) {
            return false;
        }
        *why = None;
        scope.shared.stopped.store(false, Ordering::Relaxed);
        true
    }

    /// Says which stage the work has come to, for errors that are found from outside. Charges do so, too.
    pub fn enter(&self, stage: &'static str) {
        if let Some(scope) = &self.0 {
            *lock(&scope.shared.stage) = stage;
        }
    }

    /// Returns the stage that the work came to last.
    pub fn stage(&self) -> &'static str {
        self.0.as_ref().map_or("start", |scope| *lock(&scope.shared.stage))
    }

    /// Begins a stage of this many steps, none of which is done; [`Self::progress`] tells of it from here
    /// on.
    pub fn begin(&self, stage: &'static str, of: u64) {
        if let Some(scope) = &self.0 {
            let mut counted = lock(&scope.shared.counted);
            *counted = stage;
            scope.shared.done.store(0, Ordering::Relaxed);
            scope.shared.of.store(of, Ordering::Relaxed);
        }
    }

    /// Counts steps of the stage that are done: by the row, tile or thousand elements, as [`Self::check`] is asked.
    #[inline]
    pub fn advance(&self, steps: u64) {
        if let Some(scope) = &self.0 {
            scope.shared.done.fetch_add(steps, Ordering::Relaxed);
        }
    }

    /// Returns how far the work has come in the stage that it is in, from any thread. All parts of one work have it in
    /// common; stages that run at the same time are counted together.
    pub fn progress(&self) -> Progress {
        let Some(scope) = &self.0 else { return Progress::default() };
        let stage = *lock(&scope.shared.counted);
        let of = scope.shared.of.load(Ordering::Relaxed);
        let done = scope.shared.done.load(Ordering::Relaxed).min(of);
        Progress { stage, done, of }
    }

    /// Bytes that are charged now.
    pub fn used(&self) -> u64 {
        self.0.as_ref().map_or(0, |scope| scope.shared.used.load(Ordering::Relaxed))
    }

    /// Returns the budget, bytes; [`u64::MAX`] if there is none.
    pub fn budget(&self) -> u64 {
        self.0.as_ref().map_or(u64::MAX, |scope| scope.shared.budget)
    }

    /// Returns whether the system has room for a buffer of this many elements: large ones are requested, and given back
    /// at once, so that a buffer that cannot be had is an error and does not end the process.
    ///
    /// # Errors
    /// [`Error::Memory`] if it has none.
    pub fn room_for<T>(&self, stage: &'static str, count: u64) -> Result<()> {
        let bytes = count.saturating_mul(size_of::<T>() as u64);
        if bytes < LARGE {
            return Ok(());
        }
        let found = usize::try_from(count)
            .is_ok_and(|count| Vec::<T>::new().try_reserve_exact(count).is_ok());
        if found { Ok(()) } else { Err(Error::OutOfMemory { stage, need: bytes }) }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Memory that is taken from a budget, and given back on drop.
///
/// A clone takes as much again, without being refused: what is copied has to be charged before. All charges are equal, so
/// that they can lie in values that are compared.
#[derive(Debug, Default)]
pub struct Charge {
    scope: Option<Arc<Scope>>,
    stage: &'static str,
    bytes: u64,
}

impl Charge {
    /// Returns the work whose memory it takes.
    pub fn work(&self) -> Work {
        Work(self.scope.clone())
    }

    /// Takes more, for a buffer that grows.
    ///
    /// # Errors
    /// As [`Work::charge`]; what was taken before stays.
    pub fn grow(&mut self, bytes: u64) -> Result<()> {
        let Some(scope) = &self.scope else { return Ok(()) };
        if scope.shared.stopped.load(Ordering::Relaxed) {
            return Err(lock(&scope.shared.why).clone().unwrap_or(Error::Cancelled));
        }
        *lock(&scope.shared.stage) = self.stage;
        scope.shared.take(self.stage, bytes)?;
        self.bytes += bytes;
        Ok(())
    }

    /// Takes what is missing to this many bytes, or nothing if there are more: for a buffer that has
    /// grown.
    ///
    /// # Errors
    /// As [`Work::charge`].
    pub fn grow_to(&mut self, bytes: u64) -> Result<()> {
        match bytes.saturating_sub(self.bytes) {
            0 => Ok(()),
            more => self.grow(more),
        }
    }

    /// Grows like [`Self::grow_to`], if an error cannot be returned: exceeding the budget stops the work, so that its next
    /// check fails. Returns whether it fits.
    pub fn grow_to_or_stop(&mut self, bytes: u64) -> bool {
        let Err(error) = self.grow_to(bytes) else { return true };
        if let Some(scope) = &self.scope {
            scope.shared.stop(error);
        }
        false
    }
}

impl Clone for Charge {
    fn clone(&self) -> Self {
        if let Some(scope) = &self.scope {
            scope.shared.used.fetch_add(self.bytes, Ordering::Relaxed);
        }
        Self { scope: self.scope.clone(), stage: self.stage, bytes: self.bytes }
    }
}

impl PartialEq for Charge {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Drop for Charge {
    fn drop(&mut self) {
        if let Some(scope) = &self.scope {
            scope.shared.give_back(self.bytes);
        }
    }
}
