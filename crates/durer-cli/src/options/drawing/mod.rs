//! The options of drawings.

mod annotations;
mod machine;

pub use annotations::{AnnotationArgs, Dimensioned, thread};
pub use machine::MachineArgs;

use crate::values;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use durer::math::DVec3;
use durer::paper::{self, Break, Page, Pens, Scale};
use durer::pipeline::{DrawStyle, line_classes};
use durer::view::projection::NamedView;
use durer::visibility::line::{self, ClassSet};
use durer::visibility::object::Weld;
use durer::visibility::region;

/// Exact drawings: lines and areas, as vectors or painted.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Drawing")]
pub struct DrawingArgs {
    /// Style of the drawing [default for vector files: hidden-line]
    #[arg(long, value_name = "STYLE", value_parser = style())]
    pub style: Option<DrawStyle>,
    /// Treatment of hidden lines
    #[arg(long, value_name = "HOW", default_value = "drop")]
    pub hidden: Hidden,
    /// Draw edges as creases if their faces turn by more than this many degrees
    ///
    /// With TO, e.g. 40,25, a crease continues straight on along blunter edges as long as they turn by
    /// more than TO degrees; this suits sculpted models, whose edges fade.
    ///
    /// By default, and with --smooth, the surroundings of an edge count too: edges from 3 degrees are creases if the
    /// faces beside them are flat, and a few edges of up to 60 degrees that begin and end within a round part are
    /// not; a crease between round parts that leads from one sharp corner to another is drawn whole, though it
    /// fades. With any angle other than 40, the angle alone decides.
    #[arg(long, value_name = "FROM[,TO]", allow_hyphen_values = true, default_value = "40", value_parser = crease)]
    pub crease: Crease,
    /// Classes of lines to draw, separated by commas [default: all but tangent, wire and shadow]
    ///
    /// silhouette, crease, border, non-manifold, material, intersection, section, tangent, shadow, wire; `all` is all
    /// except the last three. `tangent` edges are where curved faces meet others smoothly, such as a fillet and a
    /// plane: --lines all,tangent.
    #[arg(long, value_name = "CLASSES", value_parser = |s: &str| line_classes(s).map_err(|e| e.to_string()))]
    pub lines: Option<ClassSet>,
    /// Cut back lines with loose ends by at most this much, in percent of the drawing's larger side
    /// [default: 1; 0 for .geojson]
    ///
    /// Silhouettes of round parts and creases are cut back to the next junction or removed (up to four
    /// times as far if at most three edges of the mesh are affected), small gaps in them are closed, and of
    /// lines that would touch on paper only one is drawn. 0 draws the mesh as it is, and so does --lines if
    /// it excludes classes.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true, value_parser = stubs)]
    pub stubs: Option<f64>,
    /// Leave out hidden lines that run within this much of visible ones, in percent of the drawing's larger side
    /// [default: 0.2; 0 for .geojson and with --stubs 0]
    ///
    /// Their strokes would touch on paper: in a view nearly along an axis, hidden lines are very close to visible
    /// ones.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true, value_parser = stubs)]
    pub beneath: Option<f64>,
    /// Widths of strokes in millimetres: WIDTH[,CLASS=WIDTH…]
    ///
    /// E.g. `0.35,silhouette=0.7,hidden=0.18`; a width without a class applies to all classes that are not named.
    /// Classes are those of --lines, `contour` and `hidden`. By default outlines are 0.5, edges 0.35, hidden lines 0.25
    /// wide.
    #[arg(long, value_name = "WIDTHS", value_parser = parsed::<Pens>)]
    pub pen: Option<Pens>,
    /// Draw near lines wider and darker than far ones, in four steps with layers of their own
    ///
    /// Widths range from 1.4 times the width of the class's pen to half of it, in parallel views and in perspective.
    #[arg(long)]
    pub depth_cue: bool,
    /// Draw outlines that have nothing behind them as a class of their own: `contour`, 0.7 mm wide unless --pen sets
    /// it
    ///
    /// Silhouettes and borders in front of other parts of the model keep their class.
    #[arg(long)]
    pub contour: bool,
    /// Hatching of areas instead of filling [default: shade for .hpgl and .gcode, else none]
    ///
    /// With `shade` the style hidden-line is hatched between its lines, too; a wireframe cannot be. `contour` and
    /// `stipple` are for that style: their marks follow the shading of pictures, as it is with smooth normals. The caps
    /// of a --section are hatched among lines anyway; `none` fills them.
    #[arg(long, value_name = "HOW")]
    pub hatch: Option<Hatch>,
    /// Rule by which neighbouring areas are joined [default: shade; band for .dxf, face for
    /// .geojson]
    #[arg(long, value_name = "HOW")]
    pub merge: Option<Merge>,
    /// Extent of areas: to their borders, or a little under the areas that cover them [default: trapped for
    /// .svg, .pdf and .png without --hatch shade, else disjoint]
    #[arg(long, value_name = "HOW")]
    pub fill: Option<Fill>,
    /// Draw outlines of round parts where their normals turn away from the eye, instead of along
    /// edges between facets [default: auto; off for .geojson and with --stubs 0; on without a
    /// value]
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "on")]
    pub smooth: Option<Smooth>,
    /// Faces whose intersections are drawn as lines
    #[arg(long, value_name = "WHERE", default_value = "bodies")]
    pub intersections: Intersections,
    /// Largest distance at which borders of faces are joined
    ///
    /// `auto` allows for rounding: a few of the last digits of the file's coordinates. A length, in units of the
    /// model, closes wider gaps. `none` uses the vertices as they are in the file.
    #[arg(long, value_name = "LENGTH|auto|none", allow_hyphen_values = true, default_value = "auto", value_parser = weld)]
    pub weld: Weld,
    /// Largest distance between fitted curves and the mesh's lines, in millimetres on paper; 0 draws
    /// lines as polylines [default: 0.02; 0 for pictures]
    ///
    /// Lines become circles, arcs, ellipses and cubic curves that pass all their points within this distance. A line
    /// that turns regularly is taken as round, and the curve passes through its corners: at least five turns in a row,
    /// in one direction, by at most 30 degrees, with chords of similar lengths. So a polygon of 12 sides becomes a
    /// circle, and one of 8 does not. Corners, junctions and ends do not move. .geojson has polylines.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub fit: Option<f64>,
    /// Write curves to .dxf as polylines with arcs, for programs that do not read circles, ellipses and
    /// splines
    #[arg(long)]
    pub dxf_polylines: bool,
    /// The paper: A0 … A6, letter, legal, tabloid, WxH in millimetres, or fit [default: fit]
    ///
    /// Named sizes are rotated to fit the drawing; A4-landscape and A4-portrait are not.
    #[arg(long, value_name = "PAGE", value_parser = parsed::<Page>)]
    pub page: Option<Page>,
    /// Free space at each side of the paper, in millimetres [default: 10 with --page or --sheet, else 5]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub margin: Option<f64>,
    /// Scale on the paper: 1:10, 2:1, …, or auto
    ///
    /// `auto` takes the largest of 1:1, 1:2, 1:5, 1:10 … and 2:1, 5:1, 10:1 … that fits, and is the default for
    /// parallel views with --page or --sheet. Without them a .dxf is 1:1, for machines, and if the unit is known, from
    /// the file or --unit, so are a .gcode, and an .svg of 20 to 420 mm; everything else fills the paper, 180 mm
    /// without a page.
    #[arg(long, value_name = "SCALE", value_parser = parsed::<Scale>)]
    pub scale: Option<Scale>,
    /// Unit of the model's coordinates [default: m for glTF, COLLADA and FBX, else mm]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// Several views on one page with a title block: front, top, right and isometric, or the views of --views
    ///
    /// Sections with a letter (--section A:…) and details (--detail) are placed beside or below
    /// them.
    #[arg(long, value_name = "KIND")]
    pub sheet: Option<SheetKind>,
    /// The views of a sheet, joined by commas: front, top, right, left, bottom, back, iso
    #[arg(long, value_name = "VIEWS", requires = "sheet", value_delimiter = ',', value_parser = parsed::<NamedView>)]
    pub views: Vec<NamedView>,
    /// Repeat a circular part of a view on the sheet, enlarged
    ///
    /// The centre and the radius of the circle are in the units of the model. SCALE, e.g. 5:1, is a standard one by
    /// default, and VIEW is the one that shows most within the circle. E.g. --detail B:30,0,8,4 or --detail
    /// B:30,0,8,4,10:1,front. May be repeated.
    #[arg(long, value_name = "LETTER:X,Y,Z,RADIUS[,SCALE[,VIEW]]", requires = "sheet", allow_hyphen_values = true, value_parser = detail)]
    pub detail: Vec<DetailSpec>,
    /// Leave out the part between two places on an axis: x, y or z, in the units of the model
    ///
    /// Views that show the axis in its true length close the gap and draw break lines there; all others show the
    /// whole model. Dimensions keep the true length. E.g. --break x:40,260. May be repeated.
    #[arg(id = "break", long, value_name = "AXIS:FROM,TO", allow_hyphen_values = true, value_parser = parsed::<Break>)]
    pub breaks: Vec<Break>,
    /// Number the parts of an assembly around the isometric view, or the only one, and list them
    ///
    /// Parts are the objects of the file; parts that share a mesh have one number and are counted.
    #[arg(long)]
    pub callouts: bool,
    /// Text of the title [default: the model's name]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// A date for the title block [default: none]
    #[arg(long, value_name = "TEXT", requires = "sheet")]
    pub date: Option<String>,
    /// Pens and what moves them.
    #[command(flatten)]
    pub machine: MachineArgs,
    /// Centre lines, dimensions, threads.
    #[command(flatten)]
    pub annotations: AnnotationArgs,
}

/// Names of the options above that have no meaning without a drawing.
pub const NAMES: &[&str] = &[
    "hidden",
    "crease",
    "lines",
    "stubs",
    "beneath",
    "pen",
    "depth_cue",
    "contour",
    "hatch",
    "merge",
    "fill",
    "smooth",
    "intersections",
    "weld",
    "fit",
    "dxf_polylines",
    "pen_order",
    "pens",
    "feed",
    "travel",
    "gcode_lines",
    "pen_down",
    "pen_up",
    "page",
    "margin",
    "scale",
    "unit",
    "break",
    "callouts",
    "title",
    "center_lines",
    "dimension",
    "annotations",
    "thread",
];

/// Names of the options among them for annotations beside a view.
pub const OF_ANNOTATIONS: &[&str] = &["center_lines", "dimension", "annotations", "thread"];

fn style() -> impl TypedValueParser<Value = DrawStyle> {
    let help = |style: DrawStyle| match style {
        DrawStyle::HiddenLine => "Visible and hidden edges, distinguished by their lines",
        DrawStyle::Wireframe => "All edges, visible or not",
        DrawStyle::Regions => "The visible parts of surfaces in flat colours",
        DrawStyle::RegionsAndLines => "The same with lines on top",
        DrawStyle::Shadows => "The same with exact shadows",
    };
    let names = DrawStyle::ALL.iter().map(|s| PossibleValue::new(s.name()).help(help(*s)));
    PossibleValuesParser::new(names).try_map(|name| name.parse::<DrawStyle>())
}

fn parsed<T: std::str::FromStr<Err = durer::Error>>(text: &str) -> Result<T, String> {
    text.parse().map_err(|e: durer::Error| e.to_string())
}

fn weld(text: &str) -> Result<Weld, String> {
    match text {
        "auto" => Ok(Weld::Auto),
        "none" => Ok(Weld::None),
        _ => values::not_negative(text)
            .map(Weld::Within)
            .map_err(|e| format!("{e}; or auto, or none")),
    }
}

/// `--crease`, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crease {
    /// Edges are creases from here.
    pub from: f64,
    /// Creases go on down to here.
    pub to: f64,
}

impl Default for Crease {
    fn default() -> Self {
        Self { from: 40.0, to: 40.0 }
    }
}

fn crease(text: &str) -> Result<Crease, String> {
    let wrong =
        || "it must be between 0 and 180 degrees; or two angles, FROM,TO, TO not above FROM";
    let angle = |text: &str| {
        let inside = |n: &f64| (0.0..=180.0).contains(n);
        values::number(text).and_then(|n| Some(n).filter(inside).ok_or(wrong().into()))
    };
    match text.split_once(',') {
        None => angle(text).map(|from| Crease { from, to: from }),
        Some((from, to)) => {
            let found = Crease { from: angle(from)?, to: angle(to)? };
            Some(found).filter(|c| c.to <= c.from).ok_or(wrong().into())
        }
    }
}

fn stubs(text: &str) -> Result<f64, String> {
    let inside = |n: &f64| (0.0..50.0).contains(n);
    values::number(text)
        .and_then(|n| Some(n).filter(inside).ok_or("it must be at least 0 and below 50".into()))
}

/// `--hidden`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Hidden {
    /// They are left out
    Drop,
    /// Dashed, in layers of their own
    Dashed,
    /// Thin and grey, in layers by the number of surfaces in front of them
    Layer,
}

/// `--hatch`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Hatch {
    /// Straight lines over areas of one tone, the closer the darker
    Shade,
    /// Lines along the curvature of surfaces, the closer the darker, crossed where it is darkest
    Contour,
    /// Dots as wide as the pen `stipple`, the closer the darker
    Stipple,
    /// Areas are filled
    None,
}

/// `--merge`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Merge {
    /// Each face is a separate area
    Face,
    /// Areas with the same material and shade
    Shade,
    /// Areas with the same material and one of 16 shades: round faces become bands
    Band,
    /// Areas with the same material
    Material,
    /// Areas of the same part
    Part,
}

/// `--fill`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Fill {
    /// Neighbours share their borders and nothing overlaps: for cutters and plotters
    Disjoint,
    /// Areas reach a little under those painted after them: viewers show no cracks
    Trapped,
}

/// `--smooth`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Smooth {
    /// On round objects: those whose bent edges mostly turn by less than 25 degrees, or have narrow facets
    Auto,
    /// Wherever there is no crease
    On,
    /// Outlines are edges of the mesh
    Off,
}

/// `--intersections`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Intersections {
    /// Between bodies only; a body modelled in one piece is assumed not to intersect itself
    Bodies,
    /// Within bodies too
    All,
}

/// `--unit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Unit {
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Metres
    M,
    /// Inches
    In,
    /// Feet
    Ft,
}

/// `--sheet`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SheetKind {
    /// The top view is above the front view, the right view on the right
    ThirdAngle,
    /// The top view is below the front view, the right view on the left
    FirstAngle,
}

impl From<SheetKind> for paper::Angle {
    fn from(kind: SheetKind) -> Self {
        match kind {
            SheetKind::ThirdAngle => Self::Third,
            SheetKind::FirstAngle => Self::First,
        }
    }
}

/// `--detail`.
#[derive(Debug, Clone, PartialEq)]
pub struct DetailSpec {
    /// Letter that names it.
    pub letter: String,
    /// The middle of the circle, in the units of the model.
    pub center: DVec3,
    /// Its radius.
    pub radius: f64,
    /// Length on paper over true length.
    pub scale: Option<f64>,
    /// The view that it is part of.
    pub view: Option<NamedView>,
}

fn detail(text: &str) -> Result<DetailSpec, String> {
    let wrong =
        "a detail is LETTER:X,Y,Z,RADIUS[,SCALE[,VIEW]], e.g. B:30,0,8,4 or B:30,0,8,4,5:1,front";
    let (name, rest) = text.split_once(':').ok_or(wrong)?;
    let letter = values::letter(name)?;
    let parts: Vec<&str> = rest.split(',').map(str::trim).collect();
    let (numbers, further) = parts.split_at_checked(4).ok_or(wrong)?;
    let numbers: Vec<f64> = numbers.iter().map(|s| values::number(s)).collect::<Result<_, _>>()?;
    let (&[x, y, z, radius], [] | [_] | [_, _]) = (&numbers[..], further) else {
        return Err(wrong.to_owned());
    };
    if radius <= 0.0 {
        return Err("the radius of a detail must be above 0".to_owned());
    }
    let scale = match further.first().map(|s| parsed::<Scale>(s)).transpose()? {
        Some(Scale::Given(scale)) => Some(scale),
        _ => None,
    };
    let view = further.get(1).map(|s| parsed::<NamedView>(s)).transpose()?;
    Ok(DetailSpec { letter, center: DVec3::new(x, y, z), radius, scale, view })
}

impl Unit {
    /// Returns its length in millimetres.
    pub const fn millimetres(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::M => 1000.0,
            Self::In => 25.4,
            Self::Ft => 304.8,
        }
    }

    /// Returns the name that drawings show.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::In => "in",
            Self::Ft => "ft",
        }
    }
}

impl From<Hidden> for paper::Hidden {
    fn from(hidden: Hidden) -> Self {
        match hidden {
            Hidden::Drop => Self::Drop,
            Hidden::Dashed => Self::Dashed,
            Hidden::Layer => Self::Layer,
        }
    }
}

impl From<Intersections> for line::Intersections {
    fn from(which: Intersections) -> Self {
        match which {
            Intersections::Bodies => Self::BetweenBodies,
            Intersections::All => Self::All,
        }
    }
}

impl From<Smooth> for line::Smooth {
    fn from(how: Smooth) -> Self {
        match how {
            Smooth::Auto => Self::Auto,
            Smooth::On => Self::On,
            Smooth::Off => Self::Off,
        }
    }
}

impl From<Merge> for region::Merge {
    fn from(merge: Merge) -> Self {
        match merge {
            Merge::Face => Self::Face,
            Merge::Shade => Self::Shade,
            Merge::Band => Self::Band,
            Merge::Material => Self::Material,
            Merge::Part => Self::Part,
        }
    }
}
