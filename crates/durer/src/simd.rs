//! SIMD levels: chosen at run time, and all of them give the same bits.

pub use fearless_simd::Level;

/// Every level that this machine can run, weakest first; tests render at each of them.
pub fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = Vec::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        use fearless_simd::Simd;
        levels.extend(best.as_sse2().map(|s| s.level()));
        levels.extend(best.as_sse4_2().map(|s| s.level()));
        levels.extend(best.as_avx2().map(|s| s.level()));
    }
    if !levels.iter().any(|l| format!("{l:?}") == format!("{best:?}")) {
        levels.push(best);
    }
    levels
}
