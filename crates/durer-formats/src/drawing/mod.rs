//! Drawings to files: sheets of paper to SVG, PDF, DXF, HPGL and G-code, drawings themselves to GeoJSON.
//!
//! All writers give the same bytes for the same value: no dates, no random names.

mod dxf;
mod dxf_curve;
mod dxf_dimension;
mod dxf_entity;
mod dxf_tags;
mod gcode;
mod geojson;
mod hpgl;
mod machine;
mod number;
mod pdf;
mod pdf_gradient;
mod pdf_text;
mod svg;
mod svg_curve;
mod svg_paint;

pub use dxf::write as write_dxf;
pub use dxf_tags::{DxfFrame, DxfStrokes};
pub use gcode::write as write_gcode;
pub use geojson::write as write_geojson;
pub use hpgl::write as write_hpgl;
pub use machine::MachineOptions;
pub use pdf::write as write_pdf;
pub use svg::write as write_svg;

use crate::{Error, Result};
use durer::target::drawing::Drawing;
use durer::target::sheet::{PaperMark, Sheet};
use durer::work::Work;
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
    /// Moves and switches of machines (RS-274).
    Gcode,
    /// Pieces with their properties, in plane units.
    GeoJson,
}

impl DrawingFormat {
    /// All formats.
    pub const ALL: &'static [Self] =
        &[Self::Svg, Self::Pdf, Self::Dxf, Self::Hpgl, Self::Gcode, Self::GeoJson];

    /// Returns the name used on the command line; also the suffix of files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Pdf => "pdf",
            Self::Dxf => "dxf",
            Self::Hpgl => "hpgl",
            Self::Gcode => "gcode",
            Self::GeoJson => "geojson",
        }
    }

    /// Returns whether it drives a machine with pens, which needs no order of strokes from the
    /// caller.
    pub const fn is_for_pens(self) -> bool {
        matches!(self, Self::Hpgl | Self::Gcode)
    }

    /// Returns the format of a file name's suffix, without its dot, in any case.
    pub fn of_suffix(suffix: &str) -> Option<Self> {
        let lower = suffix.to_ascii_lowercase();
        match lower.as_str() {
            "plt" => Some(Self::Hpgl),
            "nc" | "ngc" => Some(Self::Gcode),
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

/// Options of some of the formats.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileOptions {
    /// Entities of strokes in DXF.
    pub dxf: DxfStrokes,
    /// Place of the sheet in DXF; sheets with dimensions have the default.
    pub dxf_frame: DxfFrame,
    /// Options for HPGL and G-code.
    pub machine: MachineOptions,
    /// Budget for files that are made in memory: PDF and DXF.
    pub work: Work,
}

/// Stage of files that are made in memory.
const MADE: &str = "file of the drawing";

/// Writes a drawing in one of the formats: the sheet, or for GeoJSON the drawings laid onto it.
///
/// # Errors
/// [`Error::Io`] if writing fails; [`Error::Library`] if the budget has no room for the file, for gradients and groups of
/// marks in formats other than SVG and PDF, for dimensions in DXF of another frame than the default, and for gradients in
/// PDF that repeat more than some thousand times; the errors of [`MachineOptions::check`].
pub fn write(
    out: &mut impl Write,
    format: DrawingFormat,
    sheet: &Sheet,
    drawing: &Drawing,
    options: &FileOptions,
) -> Result<()> {
    let refused = sheet.layers.iter().flat_map(|l| &l.marks).find_map(|mark| match mark {
        PaperMark::Group(_) => Some("a group of marks with a clip path or an opacity"),
        PaperMark::Gradient(_) => Some("a gradient"),
        _ => None,
    });
    if let Some(what) = refused
        && !matches!(format, DrawingFormat::Svg | DrawingFormat::Pdf)
    {
        return Err(durer::Error::Unsupported { what, instead: "write SVG or PDF" }.into());
    }
    if format == DrawingFormat::Dxf && !options.dxf_frame.is_sheet() {
        let mut marks = sheet.layers.iter().flat_map(|layer| &layer.marks);
        if marks.any(|mark| matches!(mark, PaperMark::Dimension(_))) {
            let (what, instead) = ("a dimension in units of a map", "write millimetres");
            return Err(durer::Error::Unsupported { what, instead }.into());
        }
    }
    match format {
        DrawingFormat::Svg => write_svg(out, sheet),
        DrawingFormat::Pdf => pdf::write_within(out, sheet, &options.work),
        DrawingFormat::Dxf => {
            dxf::write_within(out, sheet, (options.dxf, options.dxf_frame), &options.work)
        }
        DrawingFormat::Hpgl => hpgl::write_for(out, sheet, &options.machine),
        DrawingFormat::Gcode => write_gcode(out, sheet, &options.machine),
        DrawingFormat::GeoJson => write_geojson(out, drawing),
    }
}
