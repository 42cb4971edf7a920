//! Seconds that stages take, used only in reports.

/// Runs from where it is started.
pub(crate) struct Stopwatch(#[cfg(not(target_arch = "wasm32"))] std::time::Instant);

impl Stopwatch {
    /// Starts one.
    pub(crate) fn start() -> Self {
        Self(
            #[cfg(not(target_arch = "wasm32"))]
            std::time::Instant::now(),
        )
    }

    /// Returns the seconds since the start; 0 in WebAssembly, which has no clock of its own.
    pub(crate) fn seconds(&self) -> f64 {
        #[cfg(target_arch = "wasm32")]
        return 0.0;
        #[cfg(not(target_arch = "wasm32"))]
        self.0.elapsed().as_secs_f64()
    }
}
