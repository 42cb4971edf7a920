//! `overlay()`: laws, hard cases, and validity by an independent judge.

pub mod cases;
pub mod validity;
