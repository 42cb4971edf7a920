//! The options of `durer clip`.

use super::window::{Window, region};
use crate::layer::{FieldArgs, SystemArgs, format};
use crate::options::{RunningArgs, TileCoordinates};
use crate::values;
use clap::{Args, ValueHint};
use durer::clip::mask::Algorithm;
use durer::clip::polygon::{BooleanOp, WindingRule};
use durer_formats::geo::GeoFormat;
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer clip countries.geojson --window -10,35,30,60 -o europe.geojson
  durer clip roads.geojson --by city.geojson -o roads_in_city.geojson
  durer clip roads.wkt --by lakes.wkt --outside -o dry_roads.wkt
  durer clip parcels.geojson --cells districts.geojson -o parcels_by_district.geojson
  durer clip parcels.geojson --op union -o built_up.geojson
  durer clip countries.geojson --tiles 4 -o tiles/
  durer clip countries.geojson --window -10,35,30,60 -o europe.svg
  durer clip parcels.shp -o parcels.fgb --where 'use~forest' --select id,use
  durer clip roads.gpx -o roads.geojson --to-crs EPSG:32632
  cat planet.geojsonl | durer clip - --window 5,45,11,48 -o - > alps.geojsonl

Properties, ids and members that GeoJSON does not define are kept; heights and measures are \
interpolated at cuts. Lines keep their order and direction. Polygons are valid: valid input \
is clipped to a window by the rectangle clip, and all else by an overlay.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 features were left out by \
--skip-failures.";

/// The options of `durer clip`.
#[derive(Debug, Args)]
pub struct ClipArgs {
    /// GeoJSON (also one feature per line), JSON of ArcGIS, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, KML, GPX, WKT, WKB or
    /// SVG, also compressed by gzip; `-` reads standard input
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// File to write the result to
    ///
    /// The suffix selects the format: .geojson, .json; .geojsonl, .ndjson, .jsonl (one feature per line); .geojsons
    /// (RFC 8142); .topojson; .fgb; .shp, with .dbf, .shx, .cpg and .prj beside it; .csv; .wkt; .wkb; .hex; .svg. `-`
    /// for standard output, in the format of the input. A file is only ever replaced by a complete result. With
    /// --tiles, a folder.
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// Options for the clip region.
    #[command(flatten)]
    pub region: RegionArgs,
    /// Options for the clipping method.
    #[command(flatten)]
    pub cutting: CuttingArgs,
    /// Options for features and their fields.
    #[command(flatten)]
    pub fields: FieldArgs,
    /// Options for coordinate systems.
    #[command(flatten)]
    pub systems: SystemArgs,
    /// The format of IN [default: by its content, then by its suffix]
    #[arg(long, value_name = "FORMAT", value_parser = format, help_heading = "Formats")]
    pub from: Option<GeoFormat>,
    /// The layer of a TopoJSON or GeoPackage file; of an archive, the file or FILE/LAYER [default: all, as one]
    #[arg(long, value_name = "NAME", help_heading = "Formats")]
    pub layer: Option<String>,
    /// The format of OUT: geojson, geojsonl, geojsons, topojson, flatgeobuf, shapefile, csv, wkt, wkb, wkb-hex or svg
    /// [default: by its suffix]
    #[arg(long, visible_alias = "format", value_name = "FORMAT", value_parser = format, help_heading = "Formats")]
    pub to: Option<GeoFormat>,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write a report on standard output, in JSON: counts and areas in and out
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// Options for the clip region.
#[derive(Debug, Args)]
#[command(next_help_heading = "Mask")]
pub struct RegionArgs {
    /// A rectangle: its left, lower, right and upper border, in the coordinates of the file; y of an SVG is
    /// negated, so that it grows upwards
    ///
    /// In degrees, a left border that is larger than the right one, such as 170,-10,-170,10, makes a window across
    /// the 180th meridian, as in RFC 7946; longitudes beyond 180 degrees are in it, too.
    #[arg(long, value_name = "XL,YB,XR,YT", allow_hyphen_values = true, value_parser = region, conflicts_with_all = ["by", "tiles", "cells"])]
    pub window: Option<Window>,
    /// The polygons of a file, as one mask
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["tiles", "cells"])]
    pub by: Option<PathBuf>,
    /// The polygons of a file, each feature as a cell: a feature is written once for each cell that it reaches, cut
    /// to the cell, with the cell's fields after its own
    ///
    /// If the feature has a field of the same name, the cell's field gets the prefix `cell_`; cells without fields are
    /// identified by their number in the file, as `cell`.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["tiles", "outside", "op", "algorithm"])]
    pub cells: Option<PathBuf>,
    /// The tiles of a web map at this zoom level, 0 to 24
    ///
    /// Each tile becomes OUT/z/x/y.geojson; where OUT is `-` or ends in .geojsonl, all go into one sequence of
    /// features with the member "tile". Geometry beyond 180 degrees is moved to the other side. For simplified
    /// vector tiles of many levels see `durer tiles`.
    #[arg(long, value_name = "Z", allow_hyphen_values = true, value_parser = clap::value_parser!(u8).range(0..=24))]
    pub tiles: Option<u8>,
    /// Refuse to write more tiles than this
    #[arg(long, value_name = "N", default_value_t = 1_000_000, requires = "tiles", value_parser = values::count)]
    pub max_tiles: u64,
    /// Coordinate system of the input, for --tiles
    #[arg(long, value_name = "SYSTEM", default_value = "lonlat", requires = "tiles")]
    pub tile_coordinates: TileCoordinates,
    /// Keep the parts outside; the same as `--op difference`
    #[arg(long, conflicts_with_all = ["op", "tiles"])]
    pub outside: bool,
}

/// Options for the clipping method.
#[derive(Debug, Args)]
#[command(next_help_heading = "Cutting")]
pub struct CuttingArgs {
    /// intersection, difference; union, xor: these combine all polygons, including the mask's, into
    /// one and leave out lines and points
    #[arg(long, value_name = "OP", default_value = "intersection", conflicts_with = "tiles")]
    pub op: BooleanOp,
    /// Fill rule for the polygons of IN and FILE: even-odd, non-zero, positive (rings counter-clockwise), negative or
    /// abs-geq-two (two rings at least) [default: even-odd; of an SVG, the rule of its paths]
    #[arg(long, value_name = "RULE")]
    pub fill_rule: Option<WindingRule>,
    /// Name of an algorithm [default: a fast one that is exact for the input]
    #[arg(long, value_name = "NAME", long_help = algorithm_help(), value_parser = algorithm)]
    pub algorithm: Option<Algorithm>,
    /// The grid for vertices of overlays, in units of the coordinates [default: 2^-40 of the extent]
    ///
    /// Without it, vertices of the input keep their coordinates, and cuts are the crossings of edges of the input,
    /// correctly rounded. With it, and always with `vatti`, all vertices of polygons are snapped. Powers of two are
    /// best.
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = values::positive)]
    pub grid: Option<f64>,
}

fn names() -> String {
    Algorithm::all().into_iter().map(Algorithm::name).collect::<Vec<_>>().join(", ")
}

fn algorithm(text: &str) -> Result<Algorithm, String> {
    let found = Algorithm::all().into_iter().find(|a| a.name() == text);
    found.ok_or_else(|| format!("it must be one of {}", names()))
}

fn algorithm_help() -> String {
    format!(
        "The algorithm, by name [default: the fastest one with a correct result]\n\nOne of {}. Algorithms \
         for lines take windows and leave polygons to the default, and vice versa. sutherland-hodgman takes \
         convex masks and leaves bridges along the border. sutherland-hodgman, rectangle and \
         weiler-atherton refuse polygons whose rings cross or overlap; greiner-hormann refuses these only \
         if they touch the mask in a vertex or along an edge; rectangle also refuses some whose rings \
         touch. Of the algorithms for polygons, only overlay and vatti follow --grid and --fill-rule, and \
         do --op union and xor.",
        names()
    )
}
