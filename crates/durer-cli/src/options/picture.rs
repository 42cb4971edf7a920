//! The options of the picture.

use super::Samples;
use crate::color;
use crate::encoding::EncodingArgs;
use crate::sides::{Sides, sides};
use crate::values::{self, Algorithm, Size};
use clap::Args;
use durer::pipeline::Background;
use durer::view::layout::Layout;
use durer::view::projection::NamedView;
use durer::view::window::PixelRect;

/// The shape of the output.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Picture")]
pub struct PictureArgs {
    /// Width and height in pixels, or one number for a square
    ///
    /// One side may be left out (`640x`, `x480`); it is then computed from the outline of the model if the
    /// view fits it, from the aspect ratio of a camera of the file, or from square cells of --viewports.
    #[arg(id = "size", long = "size", value_name = "WxH", allow_hyphen_values = true, default_value = "1024x1024", value_parser = sides)]
    pub sides: Sides,
    /// The same, found where a side was open.
    #[arg(skip)]
    pub size: Size,
    /// Render only a part of the picture, of this size in pixels, its upper left pixel at X,Y
    ///
    /// Tiles joined in any order are the whole picture byte for byte. The memory needed depends on the tile, so that
    /// pictures may be larger than one machine's memory; --size is the size of the whole picture. The algorithms
    /// wireframe and depth-sort, edges, ambient occlusion, viewports and drawings have no tiles.
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true, conflicts_with = "viewports", value_parser = values::tile)]
    pub tile: Option<PixelRect>,
    /// Method that finds visible surfaces [default: z-buffer; a-buffer with --aa 64; ray with --shadows
    /// rays or --bounces]
    #[arg(long, value_name = "NAME", value_parser = values::algorithm())]
    pub algorithm: Option<Algorithm>,
    /// Samples per pixel, for algorithms that take several
    ///
    /// The A-buffer uses masks of 16 sub-pixels, or of 64 with 64.
    #[arg(long, visible_alias = "samples", value_name = "N", default_value = "4")]
    pub aa: Samples,
    /// A colour, `transparent`, `gradient`, or TOP,BOTTOM
    ///
    /// Colours are #rgb, #rrggbb, #rrggbbaa, or a name such as white, black, silver, navy.
    #[arg(long, value_name = "COLOR", default_value = "white", value_parser = color::background)]
    pub background: Background,
    /// Several views in one picture
    ///
    /// Views joined by commas, e.g. `front,top,right,iso`, in as square a grid as possible; columns
    /// and rows may be given first: `3x1:front,right,iso`. Each view fits the model.
    #[arg(long, value_name = "LAYOUT", value_parser = layout, conflicts_with_all = ["view", "azimuth", "elevation", "eye", "camera"])]
    pub viewports: Option<Layout>,
    /// Render N pictures around the up axis, into one animated file or one file each
    #[arg(long, value_name = "N", allow_hyphen_values = true, conflicts_with = "viewports", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub turntable: Option<u32>,
    /// Frames per second of an animated turntable [default: 24]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::positive, requires = "turntable")]
    pub fps: Option<f64>,
    /// Seconds per turn of an animated turntable [default: by --fps]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::positive, requires = "turntable", conflicts_with = "fps")]
    pub duration: Option<f64>,
    /// Compression and quality of the file.
    #[command(flatten)]
    pub encoding: EncodingArgs,
    /// Refuse pictures with more pixels; the default is 16384x16384
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "268435456", value_parser = values::count)]
    pub max_pixels: u64,
}

impl PictureArgs {
    /// Returns the size of the file: the tile's, if there is one.
    pub fn rendered_size(&self) -> Size {
        let of_tile = |tile: PixelRect| Size { width: tile.width(), height: tile.height() };
        self.tile.map_or(self.size, of_tile)
    }
}

/// Parses a layout whose cells are named views.
fn layout(text: &str) -> Result<Layout, String> {
    let layout: Layout = text.parse().map_err(|e: durer::Error| e.to_string())?;
    for name in layout.names() {
        name.parse::<NamedView>().map_err(|e| e.to_string())?;
    }
    Ok(layout)
}
