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
use durer::visibility::line::{self, ClassSet, edge_lines};
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
    /// Edges whose faces turn by more degrees are drawn as creases
    ///
    /// With TO, e.g. 40,25, a crease that has begun goes on, though its edges get blunter, as long as they
    /// turn by more than TO degrees and it goes straight on: for sculpted models, whose edges fade.
    ///
    /// Without an angle, and with --smooth, what is beside an edge decides, too: edges from 3 degrees on are creases
    /// between flat faces that bend no further, and a few edges of up to 60 degrees that begin and end within a round
    /// part are none. Any other angle than 40 decides alone.
    #[arg(long, value_name = "FROM[,TO]", allow_hyphen_values = true, default_value = "40", value_parser = crease)]
    pub crease: Crease,
    /// Classes of lines to draw, separated by commas [default: all but tangent, wire and shadow]
    ///
    /// silhouette, crease, border, non-manifold, material, intersection, section, tangent, shadow, wire; `all` is
    /// all but the last three. `tangent` is where curved faces meet others smoothly, as a fillet a plane: --lines
    /// all,tangent.
    #[arg(long, value_name = "CLASSES", value_parser = |s: &str| line_classes(s).map_err(|e| e.to_string()))]
    pub lines: Option<ClassSet>,
    /// Cut back lines that end in the open, where that takes at most this much of the drawing's larger
    /// side, in percent [default: 1; 0 for .geojson]
    ///
    /// Silhouettes of round parts and creases are cut back to the next junction or left out (four times as
    /// far where that takes at most three edges of the mesh), small gaps in them are closed, and where they
    /// would run into another line on paper, that line alone is drawn. 0 gives the mesh as it is, and so
    /// does --lines where it leaves out classes.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true, value_parser = stubs)]
    pub stubs: Option<f64>,
    /// Leave out hidden lines that run within this much of visible ones, in percent of the drawing's larger side
    /// [default: 0.2; 0 for .geojson and with --stubs 0]
    ///
    /// On paper their strokes would run into each other: where a view is nearly along an axis, what is hidden lies
    /// a hair beside what is seen.
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true, value_parser = stubs)]
    pub beneath: Option<f64>,
    /// Widths of strokes in millimetres: WIDTH[,CLASS=WIDTH…]
    ///
    /// E.g. `0.35,silhouette=0.7,hidden=0.18`; the first is for all that are not named. Classes are those
    /// of --lines, `contour` and `hidden`. By default outlines are 0.5, edges 0.35, hidden lines 0.25 wide.
    #[arg(long, value_name = "WIDTHS", value_parser = parsed::<Pens>)]
    pub pen: Option<Pens>,
    /// Draw near lines wider and darker than far ones, in four steps with layers of their own
    ///
    /// From 1.4 times the width of the class's pen to half of it; for parallel views and perspective.
    #[arg(long)]
    pub depth_cue: bool,
    /// Draw outlines that have nothing behind them as a class of their own: `contour`, 0.7 mm wide unless --pen says
    ///
    /// Silhouettes and borders before other parts of the model stay what they are.
    #[arg(long)]
    pub contour: bool,
    /// Hatching of areas instead of filling [default: shade for .hpgl and .gcode, else none]
    ///
    /// With `shade` the style hidden-line is hatched between its lines, too; a wireframe cannot be. `contour` and
    /// `stipple` are for that style: their marks follow the shading of pictures, as it is with smooth normals. The caps
    /// of a --section are hatched among lines anyway; `none` fills them.
    #[arg(long, value_name = "HOW")]
    pub hatch: Option<Hatch>,
    /// Rule that joins neighbouring areas [default: shade; band for .dxf, face for .geojson]
    #[arg(long, value_name = "HOW")]
    pub merge: Option<Merge>,
    /// Extent of areas: to their borders, or under what covers them [default: trapped for .svg, .pdf and
    /// .png without --hatch shade, else disjoint]
    #[arg(long, value_name = "HOW")]
    pub fill: Option<Fill>,
    /// Draw outlines of round parts where the normals turn away, not along the edges between facets
    /// [default: auto; off for .geojson and with --stubs 0; without a word: on]
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "on")]
    pub smooth: Option<Smooth>,
    /// Faces whose intersections are drawn as lines
    #[arg(long, value_name = "WHERE", default_value = "bodies")]
    pub intersections: Intersections,
    /// Largest distance at which borders of faces are joined
    ///
    /// `auto` takes what rounding may have moved: a few of the last digits of the file's coordinates. A length, in
    /// units of the model, closes wider gaps. `none` takes vertices as they are in the file.
    #[arg(long, value_name = "LENGTH|auto|none", allow_hyphen_values = true, default_value = "auto", value_parser = weld)]
    pub weld: Weld,
    /// Largest distance between fitted curves and the mesh's lines, in millimetres on paper; 0 draws
    /// lines as polylines [default: 0.02; 0 for pictures]
    ///
    /// Lines become circles, arcs, ellipses and cubic curves where those lie that near to all their points. Where a
    /// line turns regularly, it is taken for a round one, whose facets the curve leaves as an arc through their corners
    /// does: five turns in a row or more, one way, by at most 30 degrees, over chords of like lengths. So a polygon of 12
    /// sides is a circle, and one of 8 is not; corners, junctions and ends stay where they are. .geojson
    /// has polylines.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub fit: Option<f64>,
    /// Write curves to .dxf as polylines with arcs, for programs that know no circles, ellipses and splines
    #[arg(long)]
    pub dxf_polylines: bool,
    /// The paper: A0 … A6, letter, legal, tabloid, WxH in millimetres, or fit [default: fit]
    ///
    /// Named sizes are turned as the drawing needs; A4-landscape and A4-portrait are not.
    #[arg(long, value_name = "PAGE", value_parser = parsed::<Page>)]
    pub page: Option<Page>,
    /// Free space at each side of the paper, in millimetres [default: 10 with --page or --sheet, else 5]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub margin: Option<f64>,
    /// Scale on the paper: 1:10, 2:1, …, or auto
    ///
    /// `auto` takes the largest of 1:1, 1:2, 1:5, 1:10 … and 2:1, 5:1, 10:1 … that fits, and is the default
    /// for parallel views with --page or --sheet. Without them a .dxf is 1:1, for machines, and where the unit is known,
    /// from the file or --unit, so are a .gcode, and an .svg of 20 to 420 mm; all else fills the paper, 180 mm without a page.
    #[arg(long, value_name = "SCALE", value_parser = parsed::<Scale>)]
    pub scale: Option<Scale>,
    /// Unit of the model's coordinates [default: m for glTF, COLLADA and FBX, else mm]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// Several views on one page with a title block: front, top, right and isometric, or those of --views
    ///
    /// Sections with a letter (--section A:…) and details (--detail) come beside or below them.
    #[arg(long, value_name = "KIND")]
    pub sheet: Option<SheetKind>,
    /// The views of a sheet, joined by commas: front, top, right, left, bottom, back, iso
    #[arg(long, value_name = "VIEWS", requires = "sheet", value_delimiter = ',', value_parser = parsed::<NamedView>)]
    pub views: Vec<NamedView>,
    /// Show a part of a view within a circle again, enlarged, on the sheet
    ///
    /// The circle's middle and its radius are in the units of the model. Without a SCALE, e.g. 5:1, it is a standard
    /// one. The circle stands in the VIEW that shows most within it, if none is named. E.g.
    /// --detail B:30,0,8,4 or --detail B:30,0,8,4,10:1,front. May be given several times.
    #[arg(long, value_name = "LETTER:X,Y,Z,RADIUS[,SCALE[,VIEW]]", requires = "sheet", allow_hyphen_values = true, value_parser = detail)]
    pub detail: Vec<DetailSpec>,
    /// Leave out what lies between two places on an axis: x, y or z, in the model's own units
    ///
    /// Views that see the axis in its true length show the rest moved together, with break lines where it is broken;
    /// all others show all of the model. Dimensions keep the true length. E.g. --break x:40,260. May be given several
    /// times.
    #[arg(id = "break", long, value_name = "AXIS:FROM,TO", allow_hyphen_values = true, value_parser = parsed::<Break>)]
    pub breaks: Vec<Break>,
    /// Number the parts of an assembly around the isometric view, or the only one, and list them
    ///
    /// Parts are the objects of the file; those of one mesh have one number and are counted.
    #[arg(long)]
    pub callouts: bool,
    /// Text of the title [default: the model's name]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// A date for the title block; there is none where it is not given
    #[arg(long, value_name = "TEXT", requires = "sheet")]
    pub date: Option<String>,
    /// Pens and what moves them.
    #[command(flatten)]
    pub machine: MachineArgs,
    /// Centre lines, dimensions, threads.
    #[command(flatten)]
    pub annotations: AnnotationArgs,
}

/// The options above by name, for those that mean nothing without a drawing.
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

/// Those among them that are about what is written beside a view.
pub const OF_ANNOTATIONS: &[&str] = &["center_lines", "dimension", "annotations", "thread"];

fn style() -> impl TypedValueParser<Value = DrawStyle> {
    let help = |style: DrawStyle| match style {
        DrawStyle::HiddenLine => "The edges that can be seen, and those that cannot, told apart",
        DrawStyle::Wireframe => "All edges, whatever lies in front",
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
        || "it must lie between 0 and 180 degrees; or two angles, FROM,TO, TO not above FROM";
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
    /// None: each area shows one face
    Face,
    /// Those of one material and shade
    Shade,
    /// Those of one material and like shades, of 16: round faces become bands
    Band,
    /// Those of one material
    Material,
    /// Those of one part
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
    /// On objects that the mesh says are round: where most of what bends turns by less than 25 degrees from facet to
    /// facet
    Auto,
    /// On all that has no creases
    On,
    /// Outlines are edges of the mesh
    Off,
}

/// `--intersections`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Intersections {
    /// Between bodies: what is modelled in one piece is taken to be sound
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
    /// The view from above stands on top of the front view, that from the right on the right
    ThirdAngle,
    /// The view from above stands below the front view, that from the right on the left
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
    /// The view that it is a part of.
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

impl From<Intersections> for edge_lines::Intersections {
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
