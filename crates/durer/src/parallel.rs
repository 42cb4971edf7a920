//! Work on several threads, joined in order: results never depend on how many there are.

/// Applies `f` to each item and gives the results in the order of the items.
///
/// Runs on the current rayon pool where the feature `parallel` is on, else one after the other.
pub fn map<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        items.into_par_iter().with_max_len(1).map(f).collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        items.into_iter().map(f).collect()
    }
}
