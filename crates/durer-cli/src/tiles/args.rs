//! The options of `durer tiles`.

use crate::layer::FieldArgs;
use crate::options::{RunningArgs, TileCoordinates};
use crate::values;
use clap::{Args, ValueEnum, ValueHint};
use durer::clip::simplify::LineSimplifier;
use durer::clip::tiles::Tile;
use durer_formats::geo::GeoFormat;
use durer_formats::geo::crs::Crs;
use std::ops::RangeInclusive;
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer tiles countries.geojson roads.geojson -o map.pmtiles
  durer tiles parcels.geojson --zoom 10-16 --where 'area>=100' --select owner,use -o parcels.mbtiles
  durer tiles countries.geojson --zoom 0-6 -o tiles/
  durer tiles countries.geojson --zoom 3 -o 'tiles/{z}/{x}/{y}.geojson'

Each file becomes a layer, and so does each layer of a GeoPackage or TopoJSON file. Without --zoom, the levels follow from the distances between vertices and features. The features of a layer are simplified together, so that neighbours keep their borders; the \
highest level keeps all points. Polygons are valid. Geometry beyond 180 degrees is moved to the other side.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer tiles`.
#[derive(Debug, Args)]
pub struct TilesArgs {
    /// Map data: GeoJSON, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, KML, GPX, WKT, WKB; `-` reads standard input
    #[arg(value_name = "IN", required = true, value_hint = ValueHint::FilePath)]
    pub inputs: Vec<PathBuf>,
    /// File or folder to write the tiles to: map.pmtiles, map.mbtiles, a folder, or a folder with
    /// `{z}/{x}/{y}.mvt` or `.geojson`
    ///
    /// A folder gets one file per tile, not compressed, and `tiles.json`, a TileJSON file.
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// The zoom levels, e.g. 0-14 or 7; at most 24 [default: from 0 to the level that shows the detail of the data,
    /// in at most 100,000 tiles]
    ///
    /// On the highest level, vertices are about 8 cells apart, features that are near each other 2 cells, and 99 % of
    /// the lines and areas are 4 cells long or more. A message reports the levels that were chosen.
    #[arg(long, value_name = "MIN-MAX", value_parser = zooms, help_heading = "Tiles")]
    pub zoom: Option<RangeInclusive<u8>>,
    /// The side of a tile, in cells of its grid
    #[arg(long, value_name = "CELLS", default_value_t = 4096, value_parser = clap::value_parser!(u32).range(1..=8192), help_heading = "Tiles")]
    pub extent: u32,
    /// Distance that features continue beyond the border of their tile, in cells
    #[arg(long, value_name = "CELLS", default_value_t = 64, value_parser = clap::value_parser!(u32).range(0..8192), help_heading = "Tiles")]
    pub buffer: u32,
    /// Refuse to write more tiles than this
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = values::count, help_heading = "Tiles")]
    pub max_tiles: u64,
    /// Largest distance that lines may move on levels below the highest, in cells; see `durer
    /// simplify`
    #[arg(long, value_name = "CELLS", default_value_t = 3.0, allow_hyphen_values = true, value_parser = values::not_negative, help_heading = "Simplification")]
    pub tolerance: f64,
    /// douglas-peucker or visvalingam
    #[arg(
        long,
        value_name = "NAME",
        default_value = "visvalingam",
        help_heading = "Simplification"
    )]
    pub method: LineSimplifier,
    /// Leave out polygons smaller than a square of this side, in cells; several small ones near each other become
    /// such a square if their areas add up to it. At most 1 on the highest level; 0 keeps all polygons with an area
    /// on the grid
    #[arg(long, value_name = "CELLS", default_value_t = 4.0, allow_hyphen_values = true, value_parser = values::not_negative, help_heading = "Simplification")]
    pub tiny: f64,
    /// The name of a layer; one for each IN, or one for all [default: the names of the files; of files with several
    /// layers, the names of these]
    #[arg(long, value_name = "NAME", help_heading = "Layers")]
    pub layer: Vec<String>,
    /// The properties to leave out, joined by commas; by their new names where --rename gives some
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        conflicts_with = "select",
        help_heading = "Fields"
    )]
    pub exclude: Vec<String>,
    /// The name of the map [default: the name of OUT]
    #[arg(long, value_name = "TEXT", help_heading = "Layers")]
    pub name: Option<String>,
    /// Credit to show beside the map, as HTML
    #[arg(long, value_name = "HTML", help_heading = "Layers")]
    pub attribution: Option<String>,
    /// Coordinate system of the input [default: that of the file, which is converted; lonlat if it states none]
    #[arg(long, value_name = "SYSTEM", help_heading = "Reading")]
    pub coordinates: Option<TileCoordinates>,
    /// The coordinate system of the input [default: that of the file; longitude and latitude for GeoJSON]
    ///
    /// EPSG:4326 and other codes, robinson, equal-earth, mercator, or a definition as well-known text. Longitude
    /// comes before latitude, easting before northing.
    #[arg(long, value_name = "CRS", value_parser = Crs::parse, conflicts_with = "coordinates", help_heading = "Reading")]
    pub from_crs: Option<Crs>,
    /// Lines and borders never extend more than half around the world: an edge of more than 180 degrees goes the other
    /// way, across the date line
    #[arg(long, help_heading = "Reading")]
    pub short_way: bool,
    /// The format of all IN [default: by content, then by suffix]
    #[arg(long, value_name = "FORMAT", value_parser = crate::layer::format, help_heading = "Reading")]
    pub from: Option<GeoFormat>,
    /// The format of OUT [default: by its suffix; mvt for a folder]
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<TileFormat>,
    /// Features to keep, and their fields.
    #[command(flatten)]
    pub fields: FieldArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write a report on standard output, in JSON: tiles and bytes of each level
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// Format of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TileFormat {
    /// One file, for any web server
    Pmtiles,
    /// One file, a database of SQLite
    Mbtiles,
    /// Mapbox vector tiles in a folder
    Mvt,
    /// GeoJSON in a folder
    Geojson,
}

impl TileFormat {
    /// Returns its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pmtiles => "pmtiles",
            Self::Mbtiles => "mbtiles",
            Self::Mvt => "mvt",
            Self::Geojson => "geojson",
        }
    }

    /// Returns whether each tile is a separate file.
    pub fn is_folder(self) -> bool {
        matches!(self, Self::Mvt | Self::Geojson)
    }
}

fn zooms(text: &str) -> Result<RangeInclusive<u8>, String> {
    let level = |text: &str| {
        let found = text.parse::<u8>().ok().filter(|zoom| *zoom <= Tile::MAX_ZOOM);
        found.ok_or_else(|| format!("`{text}` is not a level; they are 0 to {}", Tile::MAX_ZOOM))
    };
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let (first, last) = (level(first)?, level(last)?);
    if first > last {
        return Err("the lower level comes first, e.g. 0-14".to_owned());
    }
    Ok(first..=last)
}
