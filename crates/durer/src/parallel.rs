//! Work on several threads, joined in order: results never depend on how many there are.

#[cfg(feature = "parallel")]
use std::cell::Cell;
use std::sync::{Mutex, PoisonError};

/// Applies `f` to each item and returns the results in the order of the items.
///
/// Runs on the current rayon pool where the feature `parallel` is on, else one after the other.
pub fn map<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    // Loops, not iterators, whose many generic functions would be compiled for each caller.
    let mut results = Vec::with_capacity(items.len());
    // Too little work for tasks; and a single thread avoids their cost.
    if items.len() < 2 || threads() == 1 {
        for item in items {
            results.push(f(item));
        }
        return results;
    }
    let mut todo = Vec::with_capacity(items.len());
    for item in items {
        todo.push(Mutex::new((Some(item), None)));
    }
    for_each(todo.len(), &|i| {
        let slot = || todo[i].lock().unwrap_or_else(PoisonError::into_inner);
        let item = slot().0.take();
        let result = item.map(&f);
        slot().1 = result;
    });
    for slot in todo {
        if let (_, Some(result)) = slot.into_inner().unwrap_or_else(PoisonError::into_inner) {
            results.push(result);
        }
    }
    results
}

/// Applies `f` to each item as [`map`] does, with a state that one thread at a time has and that is used again: it
/// comes from `make` or as the items before left it. The results must not depend on it, because which item gets which
/// state is not determined.
pub fn map_with<S: Send, T: Send, R: Send>(
    items: Vec<T>,
    make: impl Fn() -> S + Sync + Send,
    f: impl Fn(&mut S, T) -> R + Sync + Send,
) -> Vec<R> {
    map_and_keep(items, make, f).0
}

/// Applies `f` to each item as [`map_with`] does, and also returns the states that exist in the end: at most one for
/// each thread, in no particular order.
pub fn map_and_keep<S: Send, T: Send, R: Send>(
    items: Vec<T>,
    make: impl Fn() -> S + Sync + Send,
    f: impl Fn(&mut S, T) -> R + Sync + Send,
) -> (Vec<R>, Vec<S>) {
    let states = Mutex::new(Vec::new());
    let idle = || states.lock().unwrap_or_else(PoisonError::into_inner);
    let results = map(items, |item| {
        let waiting = idle().pop();
        let mut state = waiting.unwrap_or_else(&make);
        let result = f(&mut state, item);
        idle().push(state);
        result
    });
    (results, states.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Returns `f` of each number below `count`, in order. `job` numbers in a row are the work of one thread.
pub fn each<R: Copy + Default + Send>(
    count: usize,
    job: usize,
    f: impl Fn(usize) -> R + Sync + Send,
) -> Vec<R> {
    let mut all = vec![R::default(); count];
    let jobs = all.chunks_mut(job).zip((0..).step_by(job)).collect();
    map(jobs, |(results, first): (&mut [R], usize)| {
        results.iter_mut().zip(first..).for_each(|(result, i)| *result = f(i));
    });
    all
}

/// Jobs for each thread where neighbours in a list share one, so that no thread waits long for the others.
const JOBS: usize = 16;

/// Returns `f` of each element of a list, in order. Neighbours are the work of one thread.
pub fn of_each<T: Sync, R: Send>(list: &[T], f: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    let size = list.len().div_ceil(threads() * JOBS).max(1);
    let jobs = list.chunks(size).collect();
    map(jobs, |some: &[T]| some.iter().map(&f).collect::<Vec<R>>()).into_iter().flatten().collect()
}

#[cfg(feature = "parallel")]
thread_local! {
    /// True within [`alone`].
    static ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Runs work on this thread alone: for work so small that sharing it would cost more than it saves.
pub fn alone<R>(work: impl FnOnce() -> R) -> R {
    #[cfg(feature = "parallel")]
    {
        /// Sets the flag back, also if the work panics.
        struct Before(bool);
        impl Drop for Before {
            fn drop(&mut self) {
                ALONE.set(self.0);
            }
        }
        let _before = Before(ALONE.replace(true));
        work()
    }
    #[cfg(not(feature = "parallel"))]
    {
        work()
    }
}

/// Returns the number of threads that share the work.
pub fn threads() -> usize {
    #[cfg(feature = "parallel")]
    {
        if ALONE.get() { 1 } else { rayon::current_num_threads() }
    }
    #[cfg(not(feature = "parallel"))]
    {
        1
    }
}

/// Calls `f` with each number below `count`. Not generic, so that rayon's code is compiled once and not for each
/// caller.
fn for_each(count: usize, f: &(dyn Fn(usize) + Sync)) {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().with_max_len(1).for_each(f);
    }
    #[cfg(not(feature = "parallel"))]
    {
        (0..count).for_each(f);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks lists that chunks do not divide, with fewer and more elements than chunks.
    #[test]
    fn each_element_has_its_result() {
        for count in [0, 1, 2, 31, 33, 127, 1000, 1001, 4099] {
            let list: Vec<u64> = (0..count).collect();
            let expected: Vec<u64> = list.iter().map(|i| i * i).collect();
            assert_eq!(of_each(&list, |i| i * i), expected, "{count}");
        }
    }
}
