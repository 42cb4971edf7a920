//! Side-by-side measurements of clipping: `clip-peers lines | rect [FOLDER] | triangles`.
//!
//! Ours and the other's run in turn in the same process; figures are medians of nine runs, in CPU
//! time of the calling thread, which a busy machine disturbs less than the time of the clock.

mod lines;
mod rect;
mod triangles;

use std::path::Path;

/// CPU time of this thread in nanoseconds.
fn cpu_time() -> f64 {
    let mut t = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `t` is valid for writing.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut t) };
    t.tv_sec as f64 * 1e9 + t.tv_nsec as f64
}

/// Medians in nanoseconds of several functions that run in turn, nine times each.
pub fn medians(functions: &mut [(&str, &mut dyn FnMut() -> f64)], work: usize) -> Vec<f64> {
    const RUNS: usize = 9;
    let mut times = vec![Vec::new(); functions.len()];
    let mut checks = vec![0.0; functions.len()];
    for run in 0..=RUNS {
        for (i, (_, f)) in functions.iter_mut().enumerate() {
            let start = cpu_time();
            checks[i] = f();
            // The first round warms caches and allocators.
            if run > 0 {
                times[i].push((cpu_time() - start) / work as f64);
            }
        }
    }
    let median = |t: &mut Vec<f64>| {
        t.sort_by(f64::total_cmp);
        t[t.len() / 2]
    };
    let result: Vec<f64> = times.iter_mut().map(median).collect();
    for (i, (name, _)) in functions.iter().enumerate() {
        let ratio = result[i] / result[0];
        println!("  {name:<44} {:>12.2} ns  ×{ratio:<6.2} check {:.6e}", result[i], checks[i]);
    }
    result
}

/// A small generator of numbers in 0 … 1, the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("lines") => lines::run(),
        Some("rect") => rect::run(std::env::args().nth(2).as_deref().map(Path::new)),
        Some("triangles") => triangles::run(),
        _ => eprintln!("usage: clip-peers lines | rect [FOLDER] | triangles"),
    }
}
