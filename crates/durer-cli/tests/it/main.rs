//! The command as its users see it: the built binary, run on small models.

mod clip;
mod conformance_clip;
mod conformance_models;
mod faults;
mod harness;
mod options;
mod outputs;
mod pick;
mod pictures;
mod plot;
mod readme;
mod resources;
mod streams;
