//! CPU time of this process and of children, and medians.

use std::time::Instant;

/// Cost of a piece of work.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cost {
    /// User and system time of all threads, seconds.
    pub cpu: f64,
    /// Time on the wall, seconds.
    pub wall: f64,
    /// Largest resident memory, bytes; 0 if not measured.
    pub memory: f64,
}

/// CPU seconds of all threads of this process.
fn process_cpu() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is valid for the call, and this clock exists on all Linux kernels.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Runs the work and returns its cost; nothing else may be running.
pub fn measure<T>(work: impl FnOnce() -> T) -> (T, Cost) {
    let (wall, cpu) = (Instant::now(), process_cpu());
    let result = work();
    let cost = Cost { cpu: process_cpu() - cpu, wall: wall.elapsed().as_secs_f64(), memory: 0.0 };
    (result, cost)
}

/// Returns the middle of the values, the upper one of two; 0 for none.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Medians of each part.
pub fn median_cost(costs: &[Cost]) -> Cost {
    let of = |part: fn(&Cost) -> f64| median(costs.iter().map(part));
    Cost { cpu: of(|c| c.cpu), wall: of(|c| c.wall), memory: of(|c| c.memory) }
}

/// Returns how many times `ours` fits into `theirs`: the median over the rounds, each with its own
/// quotient.
pub fn ratio(theirs: &[Cost], ours: &[Cost], part: fn(&Cost) -> f64) -> f64 {
    median(theirs.iter().zip(ours).map(|(t, o)| part(t) / part(o)))
}
