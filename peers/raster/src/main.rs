//! Side by side with other rasterizers: same paths, same run, medians, alternating.

mod fills;
mod lines;
mod scenes;

use cpu_time::ProcessTime;

/// CPU milliseconds of every contestant, the median of `rounds` runs that alternate between them.
pub fn medians(rounds: usize, contestants: &mut [(&str, Box<dyn FnMut() + '_>)]) -> Vec<f64> {
    let mut times = vec![Vec::new(); contestants.len()];
    for round in 0..=rounds {
        for (i, (_, run)) in contestants.iter_mut().enumerate() {
            let start = ProcessTime::now();
            run();
            if round > 0 {
                times[i].push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
    }
    times
        .iter_mut()
        .map(|t| {
            t.sort_by(f64::total_cmp);
            t[t.len() / 2]
        })
        .collect()
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let filter = args.get(2).cloned().unwrap_or_default();
    let times = |default| args.get(3).and_then(|a| a.parse().ok()).unwrap_or(default);
    match args.get(1).map(String::as_str) {
        Some("fill") => fills::anti_aliased(&filter, times(9)),
        Some("aliased") => fills::aliased(&filter, times(9)),
        Some("profile") => fills::alone(&filter, times(20), true),
        Some("profile-aliased") => fills::alone(&filter, times(20), false),
        Some("lines") => lines::aliased(),
        Some("hairlines") => lines::hairlines(),
        Some("flood") => lines::floods(),
        _ => eprintln!(
            "usage: peers-raster fill|aliased|profile|profile-aliased [scene [times]] | lines | hairlines | flood"
        ),
    }
}
