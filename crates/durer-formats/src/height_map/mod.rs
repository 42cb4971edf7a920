//! Height maps: ESRI ASCII grids, NumPy arrays, tables of numbers, JSON, and grey PNG pictures.
//!
//! The first row of a file is the farthest of the surface, its first column the left one: like a map on a table, seen
//! from its lower border.

mod esri;
mod json;
mod npy;
mod npz;
mod picture;
mod points;
mod table;

use crate::wording::agreeing;
use crate::{Error, Limits, Place, Result, Warning, archive, gzip};
use durer::scene::HeightField;

/// The formats of height maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HeightMapFormat {
    /// ESRI ASCII grid.
    Esri,
    /// A NumPy array.
    Npy,
    /// A ZIP of NumPy arrays.
    Npz,
    /// Rows of numbers with commas, semicolons, tabs or blanks between them.
    Table,
    /// JSON: an array of rows, or an object with `width`, `height` and `values`.
    Json,
    /// A grey PNG of 8 or 16 bits.
    Png,
}

impl HeightMapFormat {
    /// All formats, in the order in which messages list them.
    pub const ALL: [Self; 6] =
        [Self::Esri, Self::Npy, Self::Npz, Self::Table, Self::Json, Self::Png];

    /// Returns its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Esri => "ESRI ASCII grid",
            Self::Npy => "NPY",
            Self::Npz => "NPZ",
            Self::Table => "CSV",
            Self::Json => "JSON",
            Self::Png => "PNG",
        }
    }

    /// Returns the endings of its files' names, lower case, without a dot.
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Esri => &["asc", "grd"],
            Self::Npy => &["npy"],
            Self::Npz => &["npz"],
            Self::Table => &["csv", "tsv", "txt", "dat"],
            Self::Json => &["json"],
            Self::Png => &["png"],
        }
    }

    /// Returns the format that the content speaks for, if any does; a table of numbers says
    /// nothing.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        match () {
            () if bytes.starts_with(b"\x89PNG\r\n\x1a\n") => Some(Self::Png),
            () if bytes.starts_with(npy::MAGIC) => Some(Self::Npy),
            () if bytes.starts_with(archive::MAGIC) => Some(Self::Npz),
            () if text.starts_with(b"{") || text.starts_with(b"[") => Some(Self::Json),
            () if text.get(..5).is_some_and(|t| t.eq_ignore_ascii_case(b"ncols")) => {
                Some(Self::Esri)
            }
            () if text.get(..5).is_some_and(|t| t.eq_ignore_ascii_case(b"nrows")) => {
                Some(Self::Esri)
            }
            () => None,
        }
    }

    /// Returns the format that a file's name speaks for, if any does.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, suffix) = gzip::stem(name).rsplit_once('.')?;
        let suffix = suffix.to_ascii_lowercase();
        Self::ALL.into_iter().find(|f| f.suffixes().contains(&suffix.as_str()))
    }
}

/// Options for reading a height map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HeightMapOptions {
    /// Limits: [`Limits::decoded_bytes`] counts eight bytes per point.
    pub limits: Limits,
    /// A height that means "missing", besides the format's own.
    pub no_data: Option<f64>,
    /// Array of an NPZ file, or member of a JSON object; `None` takes the only one, or the first.
    pub array: Option<String>,
}

/// A height map as read.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    /// The surface. Without coordinates in the file x and z count its columns and rows from 0.
    pub field: HeightField,
    /// True if the file states its place on a map: then x runs to the east, and z to the south: it
    /// is minus the file's northing.
    pub on_map: bool,
    /// The format, e.g. `"NPY, i2"`.
    pub format: String,
    /// Repairs and omissions.
    pub warnings: Vec<Warning>,
}

/// Rows of heights, as the readers of formats give them.
struct Grid {
    columns: usize,
    rows: usize,
    heights: Vec<f64>,
    /// West, east, south, north: the places of the outermost points.
    place: Option<[f64; 4]>,
    format: String,
    warnings: Vec<Warning>,
}

/// Reads a height map of any known format: by its content, or where that says nothing, by the suffix
/// of `name`; text that begins with a number is a table. The file may be compressed by gzip.
///
/// # Errors
/// [`Error::Unknown`] if neither gives the format; [`Error::Decode`] with line or byte for broken contents;
/// [`Error::Limit`] above the limits; [`Error::Unsupported`] for known features that are not read; [`Error::Library`]
/// for a grid that [`HeightField::new`] refuses.
pub fn read(bytes: &[u8], name: &str, options: &HeightMapOptions) -> Result<HeightMap> {
    let bytes = &*gzip::unpacked(bytes, &options.limits)?;
    let format = HeightMapFormat::of_content(bytes)
        .or_else(|| HeightMapFormat::of_name(name).filter(|f| *f == HeightMapFormat::Table))
        .or_else(|| table::looks_like_one(bytes).then_some(HeightMapFormat::Table));
    let mut grid = match format {
        Some(HeightMapFormat::Esri) => esri::read(bytes, options)?,
        Some(HeightMapFormat::Npy) => npy::read(bytes, options)?,
        Some(HeightMapFormat::Npz) => npz::read(bytes, options)?,
        Some(HeightMapFormat::Table) => table::read(bytes, options)?,
        Some(HeightMapFormat::Json) => json::read(bytes, options)?,
        Some(HeightMapFormat::Png) => picture::read(bytes, options)?,
        None => return Err(Error::Unknown(unknown(bytes))),
    };
    let has_names = matches!(format, Some(HeightMapFormat::Npz | HeightMapFormat::Json));
    if let Some(name) = options.array.as_ref().filter(|_| !has_names) {
        let message = format!("{} has no arrays with names; `{name}` is ignored", grid.format);
        grid.warnings.push(Warning { place: Place::Whole, message });
    }
    finish(grid, options)
}

fn unknown(bytes: &[u8]) -> String {
    let formats =
        HeightMapFormat::ALL.map(|f| format!("{} (.{})", f.name(), f.suffixes().join(" .")));
    let what = if bytes.is_empty() { "the file is empty" } else { "neither content nor name tell" };
    format!("{what}; height maps are read from {}", formats.join(", "))
}

fn finish(grid: Grid, options: &HeightMapOptions) -> Result<HeightMap> {
    let Grid { columns, rows, mut heights, place, format, mut warnings } = grid;
    if let Some(no_data) = options.no_data {
        heights.iter_mut().filter(|h| **h == no_data).for_each(|h| *h = f64::NAN);
    }
    let infinite = heights.iter().filter(|h| h.is_infinite()).count();
    if infinite > 0 {
        let message =
            agreeing(infinite as u64, "infinite {height is|heights are} taken as missing");
        warnings.push(Warning { place: Place::Whole, message });
    }
    let count = |n: usize| n.saturating_sub(1) as f64;
    let (x, z) = match place {
        Some([west, east, south, north]) => ([west, east], [-north, -south]),
        None => ([0.0, count(columns)], [0.0, count(rows)]),
    };
    let field = HeightField::new([columns, rows], x, z, heights)?;
    Ok(HeightMap { field, on_map: place.is_some(), format, warnings })
}

/// Checks a size before memory is taken, and that the file's bytes can hold it.
fn check_size(columns: u64, rows: u64, limits: &Limits) -> Result<usize> {
    let count = columns.saturating_mul(rows);
    let limit = HeightField::MAX_POINTS.min(limits.decoded_bytes / 8);
    if count > limit {
        let what = "number of points of a height map";
        return Err(Error::Limit { place: Place::Whole, what, value: count, limit });
    }
    if count == 0 {
        return Err(Error::whole(format!("the grid has {columns} columns and {rows} rows")));
    }
    Ok(count as usize)
}
