//! `overlay()`: laws, hard cases, and validity checked independently.

mod agreement;
pub mod cases;
mod crossing;
pub mod distance;
mod hard;
mod laws;
mod touching;
pub mod tree;
pub mod validity;
mod whole;
