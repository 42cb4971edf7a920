//! The options of further pictures.

use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Pictures of other planes than colour.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Further pictures")]
pub struct PlaneArgs {
    /// The visible triangle of each pixel
    ///
    /// A PNG whose colour is the triangle's index as R<<16|G<<8|B, 0xFFFFFF where there is none.
    /// Triangles count in file order, over all parts of the scene; a face of n vertices is n − 2
    /// triangles (others where its outline has spikes or crosses itself): those from its first
    /// vertex, or where these would not cover it, as in concave faces, others. One sample at the pixel's centre, whatever --aa says.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub item: Option<PathBuf>,
    /// The depth of each pixel
    ///
    /// A 16-bit grey PNG: window depth (0 at the near plane, 1 at the far) times 65535, 65535 where
    /// there is nothing. One sample at the pixel's centre. Give --near and --far to compare pictures.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub depth: Option<PathBuf>,
    /// The normal of each pixel
    ///
    /// A PNG whose colour is the unit normal in world space, each component n as n/2 + 1/2;
    /// (128, 128, 128) where there is nothing. One sample at the pixel's centre.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub normal: Option<PathBuf>,
}
