//! `overlay()`: laws, hard cases, and validity by an independent judge.

pub mod cases;
mod laws;
pub mod validity;
