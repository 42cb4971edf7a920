//! The same work on one thread or several, joined in order, so that the result is the same.

/// Applies `f` to every task, on the current rayon pool where the feature `parallel` is on.
#[cfg(feature = "parallel")]
pub fn map<T: Send, R: Send>(tasks: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    use rayon::prelude::*;
    if tasks.len() < 2 || rayon::current_num_threads() == 1 {
        return tasks.into_iter().map(f).collect();
    }
    tasks.into_par_iter().map(f).collect()
}

/// Applies `f` to every task.
#[cfg(not(feature = "parallel"))]
pub fn map<T: Send, R: Send>(tasks: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    tasks.into_iter().map(f).collect()
}
