//! `overlay()`: laws, hard cases, and validity by an independent judge.

mod agreement;
pub mod cases;
mod laws;
pub mod validity;
