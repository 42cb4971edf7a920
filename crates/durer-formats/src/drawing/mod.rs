//! Drawings to files: sheets of paper to SVG, PDF, DXF and HPGL, drawings themselves to GeoJSON.
//!
//! All writers give the same bytes for the same value: no dates, no random names.

mod dxf;
mod geojson;
mod hpgl;
mod number;
mod pdf;
mod pdf_text;
mod svg;

pub use dxf::write as write_dxf;
pub use geojson::write as write_geojson;
pub use hpgl::write as write_hpgl;
pub use pdf::write as write_pdf;
pub use svg::write as write_svg;

use crate::{Error, Result};
use durer::target::drawing::Drawing;
use durer::target::sheet::Sheet;
use std::io::Write;
use std::str::FromStr;

/// The file formats of drawings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DrawingFormat {
    /// Scalable Vector Graphics.
    Svg,
    /// Portable Document Format.
    Pdf,
    /// Drawing Exchange Format, for CAD.
    Dxf,
    /// Hewlett-Packard Graphics Language, for plotters.
    Hpgl,
    /// Pieces with their properties, in plane units.
    GeoJson,
}

impl DrawingFormat {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Svg, Self::Pdf, Self::Dxf, Self::Hpgl, Self::GeoJson];

    /// The name used on the command line; also the suffix of files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Pdf => "pdf",
            Self::Dxf => "dxf",
            Self::Hpgl => "hpgl",
            Self::GeoJson => "geojson",
        }
    }

    /// The format that a file name's suffix stands for, without its dot, in any case.
    pub fn of_suffix(suffix: &str) -> Option<Self> {
        let lower = suffix.to_ascii_lowercase();
        match lower.as_str() {
            "plt" => Some(Self::Hpgl),
            "json" => Some(Self::GeoJson),
            _ => Self::ALL.iter().copied().find(|f| f.name() == lower),
        }
    }
}

impl std::fmt::Display for DrawingFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for DrawingFormat {
    type Err = Error;

    fn from_str(s: &str) -> Result<Self> {
        Self::ALL
            .iter()
            .copied()
            .find(|f| f.name() == s)
            .ok_or_else(|| Error::Unknown(s.to_owned()))
    }
}

/// Writes a drawing in one of the formats: the sheet, or for GeoJSON what was laid onto it.
///
/// # Errors
/// [`Error::Io`] where writing fails.
pub fn write(
    out: &mut impl Write,
    format: DrawingFormat,
    sheet: &Sheet,
    drawing: &Drawing,
) -> Result<()> {
    match format {
        DrawingFormat::Svg => write_svg(out, sheet),
        DrawingFormat::Pdf => write_pdf(out, sheet),
        DrawingFormat::Dxf => write_dxf(out, sheet),
        DrawingFormat::Hpgl => write_hpgl(out, sheet),
        DrawingFormat::GeoJson => write_geojson(out, drawing),
    }
}
