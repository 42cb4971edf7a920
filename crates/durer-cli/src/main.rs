//! The `durer` command.

mod args;
mod camera;
mod clip;
mod color;
mod failure;
mod fit;
mod info;
mod input;
mod lights;
mod messages;
mod output;
mod pick;
mod progress;
mod render;
mod report;
mod resources;
mod values;
