//! SIMD levels: chosen at run time, and all of them give the same bits.

pub use fearless_simd::Level;
use fearless_simd::Simd;
use std::sync::OnceLock;

/// What everything works at where no other level is asked for.
static DEFAULT: OnceLock<Level> = OnceLock::new();

/// The level that everything works at where no other is asked for: the machine's best, or what
/// [`set_default_level`] has chosen.
pub fn default_level() -> Level {
    *DEFAULT.get_or_init(Level::new)
}

/// Chooses the level that everything works at from here on, in the whole process: for tests and
/// measurements, since all levels give the same bits. Gives whether it could be chosen, which it can once, and
/// only before anything has worked at the machine's best.
///
/// ```standalone_crate
/// use durer::simd::{default_level, levels, name, set_default_level};
/// let weakest = levels()[0];
/// assert!(set_default_level(weakest));
/// assert_eq!(name(default_level()), name(weakest));
/// ```
pub fn set_default_level(level: Level) -> bool {
    DEFAULT.set(level).is_ok()
}

/// How many numbers of 32 bits a register of the level holds.
#[inline(always)]
pub(crate) const fn lanes<S: Simd>() -> usize {
    size_of::<S::i32s>() / size_of::<i32>()
}

/// Every level that this machine can run, weakest first; tests render at each of them. Every x86-64 processor has
/// SSE2, so there is no scalar one there.
pub fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = Vec::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        levels.extend(best.as_sse2().map(|s| s.level()));
        levels.extend(best.as_sse4_2().map(|s| s.level()));
        levels.extend(best.as_avx2().map(|s| s.level()));
    }
    if !levels.iter().any(|&level| name(level) == name(best)) {
        levels.push(best);
    }
    levels
}

/// What a level is called: `scalar`, `sse2`, `sse4.2`, `avx2`, `avx512`, `neon` or `wasm`.
pub fn name(level: Level) -> &'static str {
    match level {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse2(_) => "sse2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Sse4_2(_) => "sse4.2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx2(_) => "avx2",
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        Level::Avx512(_) => "avx512",
        #[cfg(target_arch = "aarch64")]
        Level::Neon(_) => "neon",
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Level::WasmSimd128(_) => "wasm",
        _ => "scalar",
    }
}
