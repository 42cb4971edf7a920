//! The command as its users see it: the built binary, run on small models.

mod algorithms;
mod clip;
mod clip_told;
mod conformance_clip;
mod conformance_models;
mod draw;
mod drawings;
mod faults;
mod fill;
mod harness;
mod limits;
mod looks;
mod memory;
mod options;
mod outputs;
mod pick;
mod pictures;
mod plot;
mod readme;
mod resources;
mod same_bytes;
mod streams;
