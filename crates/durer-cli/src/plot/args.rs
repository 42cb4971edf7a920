//! The options of `durer plot`.

use crate::color;
use crate::encoding::EncodingArgs;
use crate::options::RunningArgs;
use crate::options::drawing::MachineArgs;
use crate::sides::{Sides, sides};
use crate::values::{self, Size};
use clap::{Args, ValueEnum, ValueHint};
use durer::math::{DVec3, Vec4};
use durer::paper::Page;
use durer::plot::ColorMap;
use durer::view::projection::NamedView;
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer plot --formula 'sin(x) * cos(z)' --x -4,4 --z -4,4 -o waves.svg
  durer plot --formula '3*sinc(3*r)' --samples 81 --color-map viridis --fill -o sombrero.pdf
  durer plot volcano.json -o volcano.svg --azimuth 200 --title 'Maunga Whau'
  durer plot terrain.asc -o terrain.png --size 1600x1200 --fill --color-map terrain
  durer plot heights.npy -o plotter.hpgl --lines x --page A3

Formulas may use x, z, r = sqrt(x^2 + z^2), pi, tau, e; + - * / % ^; and the functions
sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log log2 log10 sqrt cbrt pow hypot abs sign
floor ceil round fract mod min max clamp sinc erf j0 j1.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage.";

/// The options of `durer plot`.
#[derive(Debug, Args)]
pub struct PlotArgs {
    /// A height map: ESRI ASCII grid, NPY, NPZ, CSV, JSON, or grey PNG; `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath, required_unless_present = "formula", conflicts_with = "formula")]
    pub input: Option<PathBuf>,
    /// File to write the plot to
    ///
    /// The suffix selects the format: .svg, .pdf, .dxf, .hpgl, .gcode, .geojson, or .png, .jpg, .webp; `-`
    /// for standard output, with --to. A file is only ever replaced by a complete plot.
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// The format of OUT [default: by its suffix]
    #[arg(long, value_name = "FORMAT", value_parser = super::format)]
    pub to: Option<super::Format>,
    /// Source of heights.
    #[command(flatten)]
    pub surface: SurfaceArgs,
    /// Options for the camera.
    #[command(flatten)]
    pub view: PlotViewArgs,
    /// Lines and colours of the plot.
    #[command(flatten)]
    pub look: PlotLookArgs,
    /// Pens and what moves them.
    #[command(flatten)]
    pub machine: MachineArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// The options that were given, by their names in the parser.
    #[arg(skip)]
    pub given: Vec<String>,
    /// Write a report on standard output, in JSON
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// Source of heights.
#[derive(Debug, Args)]
#[command(next_help_heading = "Surface")]
pub struct SurfaceArgs {
    /// A formula for y in x and z, such as 'sin(x) * cos(z)'
    #[arg(long, short, value_name = "FORMULA", allow_hyphen_values = true)]
    pub formula: Option<String>,
    /// The range of x [default: -4,4 for a formula, else the file's]
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true, value_parser = values::range)]
    pub x: Option<[f64; 2]>,
    /// The range of z [default: -4,4 for a formula, else the file's]
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true, value_parser = values::range)]
    pub z: Option<[f64; 2]>,
    /// Points along x and z at which a formula is evaluated
    #[arg(long, value_name = "NxM", allow_hyphen_values = true, default_value = "61x61", value_parser = values::size, requires = "formula")]
    pub samples: Size,
    /// Factor for heights, or `auto`: 0.4 of the longer side of the ground
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true, default_value = "auto", value_parser = super::exaggeration)]
    pub exaggeration: super::Exaggeration,
    /// Depth over width of the ground as drawn: a number, `equal` for one scale, or `auto`: equal, or 1 where one
    /// range is more than five times the other
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, default_value = "auto", value_parser = super::aspect)]
    pub aspect: super::Ratio,
    /// Range of heights to draw; lower and higher parts are left out, as are poles of 1/x and tan
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true, value_parser = values::range)]
    pub y_range: Option<[f64; 2]>,
    /// A value that means a missing height, besides the format's own
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true, value_parser = values::number, conflicts_with = "formula")]
    pub no_data: Option<f64>,
    /// Array of an NPZ file or member of a JSON object that holds the heights
    #[arg(long, value_name = "NAME", conflicts_with = "formula")]
    pub array: Option<String>,
    /// Refuse files that have, or decompress to, more bytes; suffixes k, M and G are allowed
    /// [default: 4G]
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_bytes: Option<u64>,
}

/// The eye; the plot always fits the paper.
#[derive(Debug, Args)]
#[command(next_help_heading = "View")]
pub struct PlotViewArgs {
    /// iso, front, back, left, right, top or bottom
    #[arg(long, value_name = "VIEW", conflicts_with_all = ["azimuth", "elevation"])]
    pub view: Option<NamedView>,
    /// Degrees around the up axis from the front, to the right
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::number, default_value = "30")]
    pub azimuth: f64,
    /// Degrees above the horizon, -90 to 90
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::elevation, default_value = "30")]
    pub elevation: f64,
    /// Position of the eye, in perspective: x, height and z of the surface, all of which must be in front of the eye
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, conflicts_with_all = ["view", "azimuth", "elevation", "ortho"])]
    pub eye: Option<DVec3>,
    /// Point that the eye looks at [default: the middle of the surface]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, requires = "eye")]
    pub target: Option<DVec3>,
    /// Perspective, with this vertical angle of view in degrees [default: parallel projection; 35 with --eye]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::angle_of_view, conflicts_with = "ortho")]
    pub fov: Option<f64>,
    /// Parallel projection; this is the default
    #[arg(long)]
    pub ortho: bool,
}

/// Lines, colours, paper.
#[derive(Debug, Args)]
#[command(next_help_heading = "Look")]
pub struct PlotLookArgs {
    /// Lines to draw: along x, along z, both, or none
    #[arg(long, value_name = "WHICH", default_value = "both")]
    pub lines: Lines,
    /// Draw every N-th row and column of the grid; all of them hide
    ///
    /// By default, a file with more than 100 points along a side is resampled to 100. --every 1
    /// uses all points.
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::count)]
    pub every: Option<u64>,
    /// Treatment of hidden parts of lines
    #[arg(long, value_name = "HOW", default_value = "drop")]
    pub hidden: Hidden,
    /// Colour by height: viridis, terrain, cool-warm or grey; lines, or with --fill the cells
    #[arg(long, value_name = "MAP", value_parser = color_map)]
    pub color_map: Option<ColorMap>,
    /// Fill the cells, with the colours of --color-map, or with the background's
    #[arg(long)]
    pub fill: bool,
    /// Leave out the bar with the heights of colours
    #[arg(long)]
    pub no_color_bar: bool,
    /// Colour of lines and labels
    #[arg(long, value_name = "COLOR", default_value = "black", value_parser = color::color)]
    pub ink: Vec4,
    /// Colour of lines on the lower side of the surface [default: the colour of the other lines]
    #[arg(long, value_name = "COLOR", value_parser = color::color)]
    pub underside: Option<Vec4>,
    /// A colour, or `transparent` for none
    #[arg(long, value_name = "COLOR", default_value = "white", value_parser = color::color)]
    pub background: Vec4,
    /// Width of the lines in millimetres
    #[arg(long, value_name = "MM", allow_hyphen_values = true, default_value = "0.18", value_parser = values::positive)]
    pub pen: f64,
    /// Leave out the axes
    #[arg(long)]
    pub no_axes: bool,
    /// Names of the axes, joined by commas [default: x,y,z]
    #[arg(long, value_name = "X,Y,Z", value_parser = names)]
    pub labels: Option<[String; 3]>,
    /// A title above the plot
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub title: String,
    /// The paper: A0 … A6, letter, … (lying), or WIDTHxHEIGHT in millimetres
    #[arg(long, value_name = "PAGE", default_value = "180x135", value_parser = page)]
    pub page: Page,
    /// Encoding of pictures.
    #[command(flatten)]
    pub encoding: EncodingArgs,
    /// Width and height of a picture in pixels; one side may be left out, and follows from the page
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, default_value = "1600x1200", value_parser = sides)]
    pub size: Sides,
}

/// `--lines`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Lines {
    /// Lines of constant z
    X,
    /// Lines of constant x
    Z,
    /// Both families
    Both,
    /// None
    None,
}

/// `--hidden`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Hidden {
    /// They are left out
    Drop,
    /// They are dashed
    Dashed,
}

fn color_map(text: &str) -> Result<ColorMap, String> {
    text.parse().map_err(|e: durer::Error| e.to_string())
}

/// Returns three names joined by commas; they may be empty.
fn names(text: &str) -> Result<[String; 3], String> {
    let names: Vec<String> = text.split(',').map(|n| n.trim().to_owned()).collect();
    names.try_into().map_err(|_| "three names joined by commas are needed, e.g. x,y,z".to_owned())
}

/// Returns a page; `fit` has no meaning for a plot, which fits the page.
fn page(text: &str) -> Result<Page, String> {
    match text.parse() {
        Ok(Page::Fit) => Err("a plot fits its page; name a size such as A4 or 180x135".to_owned()),
        other => other.map_err(|e: durer::Error| e.to_string()),
    }
}
