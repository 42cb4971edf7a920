//! Layers on the command line, each with the style that follows it.

use crate::layer::{Condition, condition};
use crate::{color, values};
use clap::error::Error;
use clap::{ArgMatches, Args, Command, FromArgMatches, ValueEnum, ValueHint};
use durer::map::{Marker, Style};
use durer_formats::geo::crs::Crs;
use std::ops::Range;
use std::path::PathBuf;

/// A colour, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ink(pub Option<[u8; 4]>);

/// Lengths of dashes and gaps; none for a solid line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dashes(pub Vec<f64>);

/// The property by which labels are placed first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Priority {
    pub field: String,
    /// True if large numbers come first, such as populations, instead of small ones, such as ranks.
    pub largest_first: bool,
}

/// `--marker`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MarkerArg {
    /// A disk
    Circle,
    /// A square
    Square,
    /// A triangle that points upwards
    Triangle,
    /// An upright cross, in the colour of the stroke
    Cross,
}

impl From<MarkerArg> for Marker {
    fn from(marker: MarkerArg) -> Self {
        match marker {
            MarkerArg::Circle => Self::Circle,
            MarkerArg::Square => Self::Square,
            MarkerArg::Triangle => Self::Triangle,
            MarkerArg::Cross => Self::Cross,
        }
    }
}

/// Fields for labels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Labels {
    /// The property that labels show.
    pub field: Option<String>,
    pub priority: Option<Priority>,
}

/// A file and how it looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    pub input: PathBuf,
    /// The layer of the file, if one is named.
    pub chosen: Option<String>,
    /// Conditions on its features; all must hold.
    pub conditions: Vec<Condition>,
    /// Its coordinate system, if it is given.
    pub from_crs: Option<Crs>,
    pub style: Style,
    pub labels: Labels,
    /// True if an option of the style was given for it.
    pub styled: bool,
    /// Options of the style that were given for it or for all, by their names in the parser.
    pub given: Vec<String>,
}

/// Layers to draw, from the bottom to the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers(pub Vec<Layer>);

/// The options as declared for the parser: values without their layers. Only the declarations are used.
#[derive(Debug, Args)]
#[command(next_help_heading = "Style of map layers")]
#[allow(dead_code)]
struct LayerArgs {
    /// SVG; or layers of a map: GeoJSON, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, KML, GPX, WKT, WKB, also
    /// compressed by gzip; `-` reads standard input
    #[arg(required = true, value_name = "IN", value_hint = ValueHint::FilePath, help_heading = None)]
    input: Vec<PathBuf>,
    /// The layer of a TopoJSON or GeoPackage file; of an archive, the file or FILE/LAYER [default: all, as one]
    #[arg(long, value_name = "NAME", help_heading = "Reading")]
    layer: Vec<String>,
    /// Draw features whose field satisfies a condition: FIELD=VALUE; also !=, <, <=, >, >= and ~ (contains, ignoring
    /// case)
    ///
    /// If a layer has several, all must hold. Numbers are compared as numbers; a VALUE in quotes is a text.
    #[arg(long = "where", value_name = "FIELD=VALUE", value_parser = condition, help_heading = "Reading")]
    conditions: Vec<Condition>,
    /// The coordinate system of the layer [default: that of the file; longitude and latitude for GeoJSON]
    ///
    /// EPSG:4326 and other codes, robinson, equal-earth, mercator, or a definition as well-known text.
    #[arg(long, value_name = "CRS", value_parser = Crs::parse, help_heading = "Coordinates")]
    from_crs: Vec<Crs>,
    /// The colour of areas and markers, or `none` [default: #e3e7e0]
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    fill: Vec<Ink>,
    /// The colour of lines and borders, or `none` [default: #55606b]
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    stroke: Vec<Ink>,
    /// The width of lines and borders in pixels [default: 1]
    #[arg(long, value_name = "PX", allow_hyphen_values = true, value_parser = values::not_negative)]
    stroke_width: Vec<f64>,
    /// Lengths of dashes and gaps in turn, in pixels, e.g. 4,2; or `none`
    #[arg(long, value_name = "PX,PX,…", allow_hyphen_values = true, value_parser = dashes)]
    dashes: Vec<Dashes>,
    /// Opacity of the layer, 0 to 1 [default: 1]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = share)]
    opacity: Vec<f64>,
    /// Symbol for a point [default: circle]
    #[arg(long, value_name = "SHAPE")]
    marker: Vec<MarkerArg>,
    /// The width of markers in pixels [default: 6]
    #[arg(long, value_name = "PX", allow_hyphen_values = true, value_parser = values::not_negative)]
    marker_size: Vec<f64>,
    /// Label features with this property
    ///
    /// Labels are placed within areas, along lines and beside points. They overlap neither each other nor markers.
    /// Labels of upper layers come first, then the ones that --label-priority puts first, then labels of larger
    /// features; labels without room are left out. Names that do not fit their area are written in two lines if that
    /// helps, and NAME of Natural Earth is replaced by ABBREV if nothing else fits.
    #[arg(long, value_name = "FIELD")]
    label: Vec<String>,
    /// Place labels with small values of this property first, or with large ones for `-FIELD` [default:
    /// LABELRANK, if features have it]
    ///
    /// Labels that fit within their area do not compete with others and come first.
    #[arg(long, value_name = "FIELD", allow_hyphen_values = true, value_parser = priority)]
    label_priority: Vec<Priority>,
    /// The size of labels in pixels [default: 12]
    #[arg(long, value_name = "PX", allow_hyphen_values = true, value_parser = values::positive)]
    label_size: Vec<f64>,
    /// The colour of labels [default: #222]
    #[arg(long, value_name = "COLOR", value_parser = color::bytes)]
    label_color: Vec<[u8; 4]>,
    /// The colour around labels, or `none` [default: white]
    #[arg(long, value_name = "COLOR", value_parser = ink)]
    label_halo: Vec<Ink>,
}

/// Options that have an effect only with `--label`, and only with a stroke.
pub const OF_LABELS: [&str; 4] = ["label_priority", "label_size", "label_color", "label_halo"];
pub const OF_STROKES: [&str; 2] = ["stroke_width", "dashes"];
const DEPENDENT: [&str; 6] =
    ["label_priority", "label_size", "label_color", "label_halo", "stroke_width", "dashes"];

/// Returns whether an option is one of the style of layers, by its name in the parser.
pub fn is_style(id: &clap::Id) -> bool {
    LayerArgs::augment_args(Command::new("layers")).get_arguments().any(|a| a.get_id() == id)
}

fn ink(text: &str) -> Result<Ink, String> {
    match text {
        "none" => Ok(Ink(None)),
        color => color::bytes(color).map(|c| Ink(Some(c))).map_err(|e| format!("{e}; or none")),
    }
}

fn priority(text: &str) -> Result<Priority, String> {
    let (field, largest_first) = match text.strip_prefix('-') {
        Some(field) => (field, true),
        None => (text, false),
    };
    let named = Priority { field: field.to_owned(), largest_first };
    if field.is_empty() { Err("a property's name is missing".to_owned()) } else { Ok(named) }
}

fn dashes(text: &str) -> Result<Dashes, String> {
    if text == "none" {
        return Ok(Dashes::default());
    }
    let lengths: Vec<f64> = text.split(',').map(values::not_negative).collect::<Result<_, _>>()?;
    if lengths.iter().sum::<f64>() > 0.0 {
        Ok(Dashes(lengths))
    } else {
        Err("one of the lengths must be above 0".to_owned())
    }
}

fn share(text: &str) -> Result<f64, String> {
    let inside = |n: &f64| (0.0..=1.0).contains(n);
    values::number(text).and_then(|n| Some(n).filter(inside).ok_or("it must be from 0 to 1".into()))
}

impl Args for Layers {
    fn augment_args(command: Command) -> Command {
        LayerArgs::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        LayerArgs::augment_args_for_update(command)
    }
}

impl FromArgMatches for Layers {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let inputs: Vec<PathBuf> =
            matches.get_many("input").into_iter().flatten().cloned().collect();
        let places: Vec<usize> = matches.indices_of("input").into_iter().flatten().collect();
        let first = places.first().copied().unwrap_or(usize::MAX);
        let mut common = (Style::default(), Labels::default());
        apply(matches, 0..first, &mut common);
        let of_all: Option<String> = last(matches, "layer", &(0..first));
        let system_of_all: Option<Crs> = last(matches, "from_crs", &(0..first));
        let for_all: Vec<Condition> = all(matches, "conditions", &(0..first));
        let ends = places.iter().skip(1).copied().chain([usize::MAX]);
        let layers =
            inputs.into_iter().zip(places.iter().zip(ends)).map(|(input, (start, end))| {
                let mut look = common.clone();
                let styled = apply(matches, *start..end, &mut look);
                let styled = styled || look != (Style::default(), Labels::default());
                let (style, labels) = look;
                let chosen = last(matches, "layer", &(*start..end)).or_else(|| of_all.clone());
                let own = all(matches, "conditions", &(*start..end));
                let conditions = for_all.iter().cloned().chain(own).collect();
                let own = last(matches, "from_crs", &(*start..end));
                let from_crs = own.or_else(|| system_of_all.clone());
                let given = DEPENDENT.iter().filter(|name| {
                    let places = matches.indices_of(name).into_iter().flatten();
                    places.into_iter().any(|at| at < first || (*start..end).contains(&at))
                });
                let given = given.map(|name| (*name).to_owned()).collect();
                Layer { input, chosen, conditions, from_crs, style, labels, styled, given }
            });
        Ok(Self(layers.collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Sets the options of a part of the command line; returns whether there are any.
fn apply(matches: &ArgMatches, place: Range<usize>, (style, labels): &mut (Style, Labels)) -> bool {
    let mut any = false;
    macro_rules! set {
        ($($name:literal: $type:ty => |$value:ident| $to:expr;)+) => {
            $(if let Some($value) = last::<$type>(matches, $name, &place) {
                any = true;
                $to;
            })+
        };
    }
    set! {
        "fill": Ink => |ink| style.fill = ink.0;
        "stroke": Ink => |ink| style.stroke = ink.0;
        "stroke_width": f64 => |width| style.stroke_width = width;
        "dashes": Dashes => |dashes| style.dashes = dashes.0;
        "opacity": f64 => |opacity| style.opacity = opacity;
        "marker": MarkerArg => |marker| style.marker = marker.into();
        "marker_size": f64 => |size| style.marker_size = size;
        "label": String => |field| labels.field = Some(field);
        "label_priority": Priority => |by| labels.priority = Some(by);
        "label_size": f64 => |size| style.label_size = size;
        "label_color": [u8; 4] => |color| style.label_color = color;
        "label_halo": Ink => |ink| style.label_halo = ink.0;
    }
    any
}

/// Returns the values of an option within a part of the command line.
fn all<T: Clone + Send + Sync + 'static>(
    matches: &ArgMatches,
    name: &str,
    place: &Range<usize>,
) -> Vec<T> {
    let values = matches.get_many::<T>(name).into_iter().flatten();
    let placed = matches.indices_of(name).into_iter().flatten().zip(values);
    placed.filter(|(index, _)| place.contains(index)).map(|(_, value)| value.clone()).collect()
}

/// Returns the last value of an option within a part of the command line.
fn last<T: Clone + Send + Sync + 'static>(
    matches: &ArgMatches,
    name: &str,
    place: &Range<usize>,
) -> Option<T> {
    all(matches, name, place).pop()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        layers: Layers,
        #[arg(short)]
        output: Option<String>,
    }

    fn layers(text: &str) -> Vec<Layer> {
        let line = Line::try_parse_from(text.split(' ')).map_err(|e| e.to_string()).unwrap();
        let _ = line.output;
        line.layers.0
    }

    #[test]
    fn a_style_follows_its_layer_and_what_comes_first_is_for_all() {
        let found = layers("x --stroke none a --fill red -o z b --stroke #00f c");
        let look = |l: &Layer| (l.input.to_str().map(str::to_owned), l.style.fill, l.style.stroke);
        let grey = Style::default().fill;
        let name = |n: &str| Some(n.to_owned());
        assert_eq!(look(&found[0]), (name("a"), Some([255, 0, 0, 255]), None));
        assert_eq!(look(&found[1]), (name("b"), grey, Some([0, 0, 255, 255])));
        assert_eq!(look(&found[2]), (name("c"), grey, None));
        let found = layers("x --where n>1 a --where t=x --where u=y b");
        assert_eq!([found[0].conditions.len(), found[1].conditions.len()], [3, 1]);
        let found = layers("x --from-crs 3857 a b --from-crs EPSG:32632");
        let code = |l: &Layer| l.from_crs.as_ref().and_then(Crs::code);
        assert_eq!([code(&found[0]), code(&found[1])], [Some(3857), Some(32632)]);
        let plain = layers("x a");
        assert!(!plain[0].styled && plain[0].style == Style::default());
    }

    #[test]
    fn wrong_styles_are_refused() {
        for wrong in ["--fill reddish", "--opacity 2", "--dashes 0,0", "--stroke-width -1"] {
            assert!(Line::try_parse_from(format!("x a {wrong}").split(' ')).is_err(), "{wrong}");
        }
        assert!(Line::try_parse_from(["x"]).is_err(), "no layer");
    }
}
