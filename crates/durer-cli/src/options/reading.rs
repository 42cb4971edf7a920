//! The options for reading models.

use crate::values;
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Options and limits for reading a model.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadingArgs {
    /// Pose the model at this animation, by name or number [default: the first, given --time]
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,
    /// Pose the model at this time of the animation
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub time: Option<f64>,
    /// Show the model in this variant of its materials, by name or number; `durer info` lists them
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
    /// Show this scene of a glTF file, by name or by number from 0; `durer info` lists them [default: the file's own]
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,
    /// Use the lights of COLLADA and FBX files; lights of glTF files are always used
    #[arg(long)]
    pub own_lights: bool,
    /// Allow references to any file below this folder [default: the model's own folder]
    ///
    /// By default, textures, buffers and material libraries are read only from the model's folder, and links or `..`
    /// that lead elsewhere are refused. References of a model from standard input are relative to this folder.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub root: Option<PathBuf>,
    /// Read only this plate, counted from 1, of a Bambu Studio or OrcaSlicer project [default: all plates]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub plate: Option<u32>,
    /// Refuse models with more triangles, lines and points than this [default: 100 million]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::count)]
    pub max_triangles: Option<u64>,
    /// Refuse models that have, or decompress to, more bytes; suffixes k, M and G are allowed
    /// [default: 4G]
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_bytes: Option<u64>,
}
