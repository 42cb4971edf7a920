//! The cost of work: a budget of memory, and a way to stop it.
//!
//! A [`Work`] is a value that options contain. Large buffers are charged to it before they are allocated, each as a
//! whole, so that the check costs little; long loops check at intervals whether to go on. Nothing of it is global: two
//! pictures rendered at the same time may have separate budgets or share one.
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
//! A [`Work`] also counts progress: see [`Work::progress`].

use crate::{Error, Result};
use std::mem::size_of;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Size below which buffers are allocated without checking whether the system has so much memory: it has, or the
/// process ends anyway.
const LARGE: u64 = 16 << 20;

/// Budget of memory, with a flag that stops the work; clones share both. The default has no budget and is never
/// stopped.
#[derive(Debug, Clone, Default)]
pub struct Work(Option<Arc<Scope>>);

/// Part of the work, with the memory that is kept for it.
#[derive(Debug)]
struct Scope {
    shared: Arc<Shared>,
    /// Bytes that are released with the last handle.
    kept: AtomicU64,
}

/// State that all parts of the work share.
#[derive(Debug)]
struct Shared {
    /// Budget in bytes.
    budget: u64,
    /// Name of the setting for the budget.
    option: &'static str,
    /// Number of charged bytes.
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
    /// Name of the current stage: `"rows of tiles"`, `"lines"`, …; empty before the first counted one.
    pub stage: &'static str,
    /// Number of finished steps; at most `of`.
    pub done: u64,
    /// Number of all steps.
    pub of: u64,
}

impl Progress {
    /// Returns the finished part, 0 to 1; `None` before the first counted stage.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0).then(|| self.done as f64 / self.of as f64)
    }
}

/// Two values are equal if they are clones of each other, or both have no budget.
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
    /// Creates work that may have `bytes` charged at a time; `option` is the name of the budget in errors, such as
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

    /// Creates work without a budget that can be stopped.
    pub fn stoppable() -> Self {
        Self::with_budget(u64::MAX, "the budget")
    }

    /// Returns a part of the work, which shares its budget and its stop; the memory kept for the part is released when
    /// all its clones are dropped.
    pub fn part(&self) -> Self {
        let part = |scope: &Arc<Scope>| {
            Arc::new(Scope { shared: scope.shared.clone(), kept: AtomicU64::new(0) })
        };
        Self(self.0.as_ref().map(part))
    }

    /// Charges memory until the returned charge is dropped: once for each buffer, or each thousand elements.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has too little left; the reason of the stop if the work was stopped.
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

    /// Charges memory for data that stay as long as this part of the work, such as a model that is read.
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

    /// Charges memory like [`Self::keep`] where an error cannot be returned: exceeding the budget stops the work, so
    /// that its next check fails. Returns whether the memory fits.
    pub(crate) fn keep_or_stop(&self, stage: &'static str, bytes: u64) -> bool {
        self.keep(stage, bytes).map_err(|error| self.stop(error)).is_ok()
    }

    /// Checks whether the work shall go on, by a single load if it shall. For long loops: once per row, tile or
    /// thousand steps.
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

    /// Stops the work: its next check fails with this error. The first reason counts.
    pub fn stop(&self, why: Error) {
        if let Some(scope) = &self.0 {
            scope.shared.stop(why);
        }
    }

    /// Stops the work, as [`Self::stop`], because it was found to use this many bytes, more than its budget.
    pub fn stop_at(&self, bytes: u64) {
        if let Some(scope) = &self.0 {
            self.stop(scope.shared.refused(self.stage(), bytes));
        }
    }

    /// Resumes work that was stopped for lack of memory, after memory has been released. Returns whether the work
    /// continues: if it was stopped for another reason, it stays stopped.
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

    /// Sets the current stage of the work, for errors that are found outside of it. Charges set it, too.
    pub fn enter(&self, stage: &'static str) {
        if let Some(scope) = &self.0 {
            *lock(&scope.shared.stage) = stage;
        }
    }

    /// Returns the latest stage of the work.
    pub fn stage(&self) -> &'static str {
        self.0.as_ref().map_or("start", |scope| *lock(&scope.shared.stage))
    }

    /// Begins a stage of this many steps, none of which is done; [`Self::progress`] reports it from now on.
    pub fn begin(&self, stage: &'static str, of: u64) {
        if let Some(scope) = &self.0 {
            let mut counted = lock(&scope.shared.counted);
            *counted = stage;
            scope.shared.done.store(0, Ordering::Relaxed);
            scope.shared.of.store(of, Ordering::Relaxed);
        }
    }

    /// Counts finished steps of the stage: once per row, tile or thousand elements, where [`Self::check`] is called.
    #[inline]
    pub fn advance(&self, steps: u64) {
        if let Some(scope) = &self.0 {
            scope.shared.done.fetch_add(steps, Ordering::Relaxed);
        }
    }

    /// Returns the progress of the work in its current stage; from any thread. All parts of the work share it; stages
    /// that run at the same time are counted together.
    pub fn progress(&self) -> Progress {
        let Some(scope) = &self.0 else { return Progress::default() };
        let stage = *lock(&scope.shared.counted);
        let of = scope.shared.of.load(Ordering::Relaxed);
        let done = scope.shared.done.load(Ordering::Relaxed).min(of);
        Progress { stage, done, of }
    }

    /// Returns the number of bytes charged now.
    pub fn used(&self) -> u64 {
        self.0.as_ref().map_or(0, |scope| scope.shared.used.load(Ordering::Relaxed))
    }

    /// Returns the budget, bytes; [`u64::MAX`] if there is none.
    pub fn budget(&self) -> u64 {
        self.0.as_ref().map_or(u64::MAX, |scope| scope.shared.budget)
    }

    /// Checks whether the system has room for a buffer of this many elements. A large one is allocated and freed at
    /// once, so that a lack of memory is an error and does not end the process.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] if there is no room.
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

/// Memory charged to a budget, and released on drop.
///
/// A clone charges as much again and is never refused: memory for a copy has to be charged before. All charges are
/// equal, so that compared values may contain them.
#[derive(Debug, Default)]
pub struct Charge {
    scope: Option<Arc<Scope>>,
    stage: &'static str,
    bytes: u64,
}

impl Charge {
    /// Returns the work that the memory is charged to.
    pub fn work(&self) -> Work {
        Work(self.scope.clone())
    }

    /// Charges more, for a buffer that grows.
    ///
    /// # Errors
    /// As [`Work::charge`]; the earlier charge stays.
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

    /// Raises the charge to this many bytes, or leaves it if it is larger: for a buffer that has grown.
    ///
    /// # Errors
    /// As [`Work::charge`].
    pub fn grow_to(&mut self, bytes: u64) -> Result<()> {
        match bytes.saturating_sub(self.bytes) {
            0 => Ok(()),
            more => self.grow(more),
        }
    }

    /// Raises the charge like [`Self::grow_to`] where an error cannot be returned: exceeding the budget stops the work,
    /// so that its next check fails. Returns whether the memory fits.
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
