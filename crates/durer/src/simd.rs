//! SIMD levels: chosen at run time, and all of them give the same bits.

pub use fearless_simd::Level;
use fearless_simd::Simd;
use std::sync::OnceLock;

/// Level of all work for which no other is requested.
static DEFAULT: OnceLock<Level> = OnceLock::new();

/// Returns the level used unless another one is requested: the machine's best, or the one chosen by
/// [`set_default_level`].
pub fn default_level() -> Level {
    *DEFAULT.get_or_init(Level::new)
}

/// Chooses the level that everything works at from here on, in the whole process: for tests and measurements, since all
/// levels produce the same bits. Returns whether it could be chosen, which it can once, and only before anything has
/// worked at the machine's best.
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

/// Returns the number of 32-bit lanes in a register of the level.
#[inline(always)]
pub(crate) const fn lanes<S: Simd>() -> usize {
    size_of::<S::i32s>() / size_of::<i32>()
}

/// Returns every level with separate code that this machine can run, weakest first; tests render at each of them. On
/// architectures whose every processor has vector registers, such as SSE2's on x86-64, `scalar` is included only with
/// the feature `scalar`.
///
/// SSE4.2 is not among them: its further instructions make no kernel faster than SSE2 does, so both run the same code,
/// which saves a quarter of the kernels.
pub fn levels() -> Vec<Level> {
    let best = Level::new();
    let mut levels = Vec::new();
    #[cfg(feature = "scalar")]
    levels.push(Level::fallback());
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        levels.extend(best.as_sse2().map(|s| s.level()));
        levels.extend(best.as_avx2().map(|s| s.level()));
    }
    if !levels.iter().any(|&level| name(level) == name(with_code(best))) {
        levels.push(best);
    }
    levels
}

/// Returns the level of a name as returned by [`name`], or the machine's best for `auto`; none if the machine lacks it.
///
/// ```
/// use durer::simd::{by_name, levels, name};
/// let weakest = name(levels()[0]);
/// assert_eq!(by_name(weakest).map(name), Some(weakest));
/// assert!(by_name("mmx").is_none());
/// ```
pub fn by_name(text: &str) -> Option<Level> {
    let best = Level::new();
    if text == "auto" {
        return Some(best);
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if text == "sse4.2" {
        return best.as_sse4_2().map(|s| s.level());
    }
    levels().into_iter().find(|&level| name(level) == text)
}

/// Returns the level whose code a level runs: SSE2's for SSE4.2, its own for all others.
pub(crate) fn with_code(level: Level) -> Level {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let (Level::Sse4_2(_), Some(sse2)) = (level, level.as_sse2()) {
        return sse2.level();
    }
    level
}

/// Evaluates an expression with the instructions of a level, whose token is bound to the pattern. It does what the
/// macro of the same name in `fearless_simd` does, but builds no code for SSE4.2.
macro_rules! dispatch {
    (@with $token:expr, $simd:pat => $work:expr) => {{
        let token = $token;
        let $simd = token;
        fearless_simd::Simd::vectorize(
            token,
            #[inline(always)]
            || $work,
        )
    }};
    ($level:expr, $simd:pat => $work:expr) => {
        match $crate::simd::with_code($level) {
            #[cfg(any(
                feature = "scalar",
                not(any(
                    all(target_arch = "aarch64", target_feature = "neon"),
                    all(
                        any(target_arch = "x86", target_arch = "x86_64"),
                        target_feature = "sse2",
                        target_feature = "fxsr"
                    ),
                    all(target_arch = "wasm32", target_feature = "simd128")
                ))
            ))]
            fearless_simd::Level::Fallback(token) => {
                $crate::simd::dispatch!(@with token, $simd => $work)
            }
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            fearless_simd::Level::Sse2(token) => {
                $crate::simd::dispatch!(@with token, $simd => $work)
            }
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            fearless_simd::Level::Avx2(token) => {
                $crate::simd::dispatch!(@with token, $simd => $work)
            }
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            fearless_simd::Level::Avx512(token) => {
                $crate::simd::dispatch!(@with token, $simd => $work)
            }
            #[cfg(target_arch = "aarch64")]
            fearless_simd::Level::Neon(token) => {
                $crate::simd::dispatch!(@with token, $simd => $work)
            }
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            fearless_simd::Level::WasmSimd128(token) => {
                $crate::simd::dispatch!(@with token, $simd => $work)
            }
            _ => unreachable!("every level has code"),
        }
    };
}
pub(crate) use dispatch;

/// Returns the name of a level: `scalar`, `sse2`, `sse4.2`, `avx2`, `avx512`, `neon` or `wasm`.
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
