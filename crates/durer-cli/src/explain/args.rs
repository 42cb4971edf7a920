//! The options of `durer explain`.

use crate::options::RunningArgs;
use crate::values;
use clap::{Args, ValueEnum, ValueHint};
use durer::clip::polygon::{BooleanOp, WindingRule};
use durer::explain::Language;
use durer::math::{DVec2, Rect};
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
Examples:
  durer explain                                      (lists algorithms and their examples)
  durer explain cohen-sutherland -o steps.html
  durer explain weiler-atherton --example letter -o steps.svg --columns 4
  durer explain sutherland-hodgman plan.geojson --window 2,2,8,8 -o steps.png
  durer explain liang-barsky --step 3 --lang de -o step3.svg

INPUT is map data or an SVG for algorithms of the plane: the first polygon is the subject, further ones are the clip, \
lines are clipped, and single points are tested; --window sets the window. For algorithms of space it is a model of at most \
200 faces, seen obliquely from above; for fills and halftones a picture of at most 2000 pixels, filled from --at. \
Without INPUT an example is explained.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage.";

/// The options of `durer explain`.
#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// The algorithm; without one, all are listed with their examples
    #[arg(value_name = "ALGORITHM")]
    pub algorithm: Option<String>,
    /// Map data, an SVG, a model or a small picture to explain it on; `-` reads standard input
    #[arg(value_name = "INPUT", value_hint = ValueHint::FilePath, conflicts_with = "example")]
    pub input: Option<PathBuf>,
    /// File to write; `-` is standard output
    ///
    /// An SVG or PNG shows all steps side by side; a page (html) has buttons and keys to go from step to step, and
    /// needs no network; JSON has all values, tables and marks.
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::AnyPath, default_value = "-")]
    pub output: PathBuf,
    /// The format of the output [default: by its suffix, else text]
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<Format>,
    /// Only this step, counted from 1: its picture with the table of its state
    #[arg(long, value_name = "N")]
    pub step: Option<usize>,
    /// Language of captions: en or de
    #[arg(long, value_name = "LANG", default_value = "en")]
    pub lang: Lang,
    /// The example by its name [default: the first]
    #[arg(long, value_name = "NAME")]
    pub example: Option<String>,
    /// List algorithms and their examples; with an algorithm, its examples
    #[arg(long)]
    pub list: bool,
    /// Pictures in a row of the sheet
    #[arg(long, value_name = "N", default_value = "4", value_parser = clap::value_parser!(u16).range(1..=20))]
    pub columns: u16,
    /// Show no more steps than this; a last step says how many are missing
    #[arg(long, value_name = "N", default_value = "200", value_parser = clap::value_parser!(u32).range(1..=2_000))]
    pub max_steps: u32,
    /// The window to clip to, in the coordinates of the file; y of an SVG is negated, so that it grows upwards
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = values::rect, requires = "input")]
    pub window: Option<Rect>,
    /// The pixel from which a picture is filled
    #[arg(long, value_name = "X,Y", default_value = "0,0", allow_hyphen_values = true, value_parser = values::point)]
    pub at: DVec2,
    /// Operation on two polygons: intersection, union, difference or xor
    #[arg(long, value_name = "OP", default_value = "intersection", value_parser = operation)]
    pub operation: BooleanOp,
    /// Rule for the inside of rings: even-odd or non-zero
    #[arg(long, value_name = "RULE", default_value = "even-odd", value_parser = rule)]
    pub fill_rule: WindingRule,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
}

/// `--format`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Steps side by side, as vectors
    Svg,
    /// Steps side by side, as pixels
    Png,
    /// Values, tables and marks
    Json,
    /// A page with buttons
    Html,
    /// Captions, one a line
    Text,
}

/// `--lang`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Lang {
    /// English
    En,
    /// German
    De,
}

impl From<Lang> for Language {
    fn from(lang: Lang) -> Self {
        match lang {
            Lang::En => Self::English,
            Lang::De => Self::German,
        }
    }
}

fn operation(name: &str) -> Result<BooleanOp, String> {
    match name {
        "intersection" => Ok(BooleanOp::Intersection),
        "union" => Ok(BooleanOp::Union),
        "difference" => Ok(BooleanOp::Difference),
        "xor" => Ok(BooleanOp::Xor),
        _ => Err("it must be intersection, union, difference or xor".to_owned()),
    }
}

fn rule(name: &str) -> Result<WindingRule, String> {
    match name {
        "even-odd" => Ok(WindingRule::EvenOdd),
        "non-zero" => Ok(WindingRule::NonZero),
        _ => Err("it must be even-odd or non-zero".to_owned()),
    }
}
