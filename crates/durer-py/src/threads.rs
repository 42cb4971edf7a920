//! The threads that share the work of a call.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Pools by their number of threads.
type Pools = HashMap<usize, Arc<ThreadPool>>;

/// The pools, and the process that they belong to: a forked process does not have its parent's
/// threads.
static POOLS: Mutex<Option<(u32, Pools)>> = Mutex::new(None);

fn pool(threads: usize) -> Result<Arc<ThreadPool>, String> {
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if pools.as_ref().is_some_and(|(owner, _)| *owner != process) {
        // Dropping pools of the parent would wait for threads that do not exist here.
        std::mem::forget(pools.take());
    }
    let (_, pools) = pools.get_or_insert_with(|| (process, HashMap::new()));
    if let Some(pool) = pools.get(&threads) {
        return Ok(pool.clone());
    }
    let built = ThreadPoolBuilder::new().num_threads(threads).build();
    let built = Arc::new(built.map_err(|e| format!("the threads cannot be started: {e}"))?);
    pools.insert(threads, built.clone());
    Ok(built)
}

/// Runs work on a number of threads, 0 for one for each processor, without the interpreter's lock.
pub fn on_threads<T: Send>(
    py: Python<'_>,
    threads: usize,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    py.detach(|| Ok(pool(threads)?.install(work))).map_err(PyRuntimeError::new_err::<String>)
}
