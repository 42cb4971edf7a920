//! A CPU graphics pipeline: geometry in, pixels or exact vector drawings out.
//!
//! Values in, values out: the library opens no file and prints nothing. Modules are declared in
//! reading order, which is also the order of dependencies.

#![forbid(unsafe_code)]

pub mod error;
pub mod info;
pub mod math;
pub mod parallel;
pub mod simd;
pub mod trace;

pub mod target;

pub mod scene;

pub mod curve;

pub mod clip;

pub mod view;

pub mod raster;

pub mod shade;

pub mod fragment;

pub mod visibility;

pub mod explain;

pub mod pipeline;

pub use error::{Error, Result};
