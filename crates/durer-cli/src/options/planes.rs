//! The options of further pictures.

use clap::{Args, ValueHint};
use std::path::PathBuf;

/// Pictures of other planes than colour.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Further pictures")]
pub struct PlaneArgs {
    /// The visible triangle of each pixel
    ///
    /// A PNG whose colour is the triangle's index as R<<16|G<<8|B; 0xFFFFFF where no triangle is visible. Triangles are
    /// counted in file order over all parts of the scene. A face with n vertices is divided into n − 2 triangles (or
    /// another number if its outline has spikes or crosses itself): a fan from its first vertex, or other triangles if
    /// the fan would not cover the face, as in concave ones. There is one sample at the centre of each pixel,
    /// independent of --aa.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub item: Option<PathBuf>,
    /// The depth of each pixel
    ///
    /// A 16-bit grey PNG with the window depth (0 at the near plane, 1 at the far plane) times 65535;
    /// 65535 where nothing is visible. One sample at the centre of each pixel. Give --near and --far
    /// to compare pictures.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub depth: Option<PathBuf>,
    /// The normal of each pixel
    ///
    /// A PNG whose colour is the unit normal in world space, each component n as n/2 + 1/2; (128,
    /// 128, 128) where nothing is visible. One sample at the centre of each pixel.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub normal: Option<PathBuf>,
}
