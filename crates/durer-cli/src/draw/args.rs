//! The options of `durer draw`.

use super::layers::Layers;
use crate::encoding::EncodingArgs;
use crate::kind::Kind;
use crate::options::RunningArgs;
use crate::sides::{Sides, sides};
use crate::{color, values};
use clap::{Args, ValueEnum, ValueHint};
use durer::math::Rect;
use durer::view::window::PixelRect;
use durer_formats::geo::GeoFormat;
use durer_formats::geo::crs::Crs;
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer draw tiger.svg -o tiger.png
  durer draw tiger.svg -o tiger.png --size 2048x --background white
  durer draw page.svg -o page.png --font fonts/
  durer draw countries.geojson -o world.png --size 1600x --label NAME
  durer draw countries.geojson -o world.svg
  durer draw countries.geojson --to-crs robinson -o robinson.svg
  durer draw land.geojson --fill '#f4efe6' --stroke none rivers.geojson --stroke '#4a7fb5' \\
      cities.geojson --marker-size 5 --fill '#b03030' --label name -o map.png \\
      --background '#cfe2f0' --window -10,35,30,60
  durer clip roads.geojson --window 5,45,11,48 -o - | durer draw - -o alps.png

Map layers are drawn in the order given. Style options, --layer, --where and --from-crs apply to the layer before \
them; those before the first layer apply to all layers.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer draw`.
#[derive(Debug, Args)]
pub struct DrawArgs {
    /// Layers to draw.
    #[command(flatten)]
    pub layers: Layers,
    /// File to write the picture to
    ///
    /// A .png, .jpg or .webp file, a .svg, .pdf or .dxf file for vectors, or `-` for standard output. A file is only
    /// ever replaced by a complete picture.
    ///
    /// Vectors show the same as pixels; a pixel is 1/96 inch. Each map layer becomes a layer, and letters become
    /// outlines. Bitmaps, patterns, masks, filters and blend modes of an SVG are refused; in DXF also gradients, clip
    /// paths and --opacity.
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// Options for the picture.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Fonts to use.
    #[command(flatten)]
    pub fonts: FontArgs,
    /// The format of the map layers [default: by their content, then by their suffix]
    #[arg(long, value_name = "FORMAT", value_parser = crate::layer::format, help_heading = "Reading")]
    pub from: Option<GeoFormat>,
    /// Convert the layers to this coordinate system; --window is given in it
    #[arg(long, value_name = "CRS", value_parser = Crs::parse, help_heading = "Coordinates")]
    pub to_crs: Option<Crs>,
    /// Leave out features that cannot be read, with a warning that counts them and exit code 3
    ///
    /// Works for GeoJSON, CSV, WKT with a geometry per line, hexadecimal WKB and Shapefiles. In other formats, and in
    /// text that is not JSON, the end of a broken feature cannot be found.
    #[arg(long, help_heading = "Reading")]
    pub skip_failures: bool,
    /// Refuse files of more bytes; k, M, G are understood
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true, default_value = "4G", value_parser = values::bytes, help_heading = "Reading")]
    pub max_bytes: u64,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write a report on standard output, in JSON: sizes, counts, seconds, warnings
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// The shape of the output.
#[derive(Debug, Args)]
#[command(next_help_heading = "Picture")]
pub struct PictureArgs {
    /// Width and height in pixels, which are 1/96 inch in vectors [default: an SVG's own; 1024 on the longer side
    /// of a map]
    ///
    /// One side may be left out (`800x`, `x600`) and follows from the other. If the shape differs,
    /// the drawing is as large as fits, in the middle.
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = sides)]
    pub size: Option<Sides>,
    /// Anti-aliasing: by the exact area covered, or none
    #[arg(long, value_name = "HOW", default_value = "coverage")]
    pub aa: Smoothing,
    /// A colour, or `transparent` [default: transparent for an SVG, white for a map]
    #[arg(long, value_name = "COLOR", value_parser = color::bytes)]
    pub background: Option<[u8; 4]>,
    /// Part of the map to show: left, lower, right and upper border, in the coordinates of the file, or of --to-crs
    ///
    /// Of an SVG, whose y grows downwards, the smaller y first. [default: all]
    #[arg(long, value_name = "XL,YB,XR,YT", allow_hyphen_values = true, value_parser = crate::clip::window)]
    pub window: Option<Rect>,
    /// Part of the picture to draw to, in pixels from the upper left corner [default: the whole
    /// picture]
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true, value_parser = viewport)]
    pub viewport: Option<PixelRect>,
    /// The format of the output: png, jpeg or webp; svg, pdf or dxf for vectors [default: by its suffix, else png]
    #[arg(long, value_name = "FORMAT", value_parser = values::map_kind())]
    pub format: Option<Kind>,
    /// The units of a .dxf: those of the map's coordinates, as drawings of the same place have them, or millimetres on
    /// the sheet [default: map; mm for an SVG]
    #[arg(long, value_name = "UNITS")]
    pub dxf_units: Option<DxfUnits>,
    /// Compression and quality of the file.
    #[command(flatten)]
    pub encoding: EncodingArgs,
    /// Refuse pictures with more pixels; the default is 16384x16384
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "268435456", value_parser = values::count)]
    pub max_pixels: u64,
}

/// Fonts.
#[derive(Debug, Args)]
#[command(next_help_heading = "Text")]
pub struct FontArgs {
    /// A font file or a folder of fonts (TrueType, OpenType); the first is used for labels
    ///
    /// Only these fonts are used, so the picture is the same on every machine. DejaVu Sans (Latin,
    /// Greek, Cyrillic) is built in and replaces missing fonts.
    #[arg(long, value_name = "PATH", value_hint = ValueHint::AnyPath)]
    pub font: Vec<PathBuf>,
    /// Also use the installed fonts; pictures then depend on the machine
    #[arg(long)]
    pub system_fonts: bool,
}

/// `--dxf-units`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DxfUnits {
    /// Places keep their coordinates
    Map,
    /// Millimetres from the lower left corner of the sheet
    Mm,
}

/// `--aa`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Smoothing {
    /// Pixels are painted or not, by their centres
    None,
    /// Pixels are painted by the share of their area that is covered
    Coverage,
}

fn viewport(text: &str) -> Result<PixelRect, String> {
    let wrong = || "a viewport is X,Y,W,H in whole pixels, e.g. 0,0,640,480".to_owned();
    let numbers: Vec<i32> =
        text.split(',').map(|n| n.trim().parse()).collect::<Result<_, _>>().map_err(|_| wrong())?;
    let [x, y, w, h] = numbers[..] else { return Err(wrong()) };
    if x < 0 || y < 0 || w < 1 || h < 1 {
        return Err("a viewport starts at 0,0 or later and is 1x1 at least".to_owned());
    }
    let (right, bottom) =
        (x.checked_add(w).ok_or_else(wrong)?, y.checked_add(h).ok_or_else(wrong)?);
    PixelRect::new(x, y, right, bottom).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewports_have_a_place_and_an_extent() {
        assert_eq!(viewport("1,2,3,4"), Ok(PixelRect::new(1, 2, 4, 6).unwrap()));
        for wrong in ["", "1,2,3", "-1,0,3,3", "0,0,0,3", "2147483647,0,1,1", "a,b,c,d"] {
            assert!(viewport(wrong).is_err(), "{wrong}");
        }
    }
}
