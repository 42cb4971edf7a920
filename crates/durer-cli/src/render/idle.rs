//! Options of the command line that have no effect together with others.

use super::check::{algorithm, wanted};
use crate::drawing;
use crate::idle::{self, Rule};
use crate::kind::Kind;
use crate::messages::Messages;
use crate::options::drawing::Hatch;
use crate::options::{Samples, Shading, Shadows};
use crate::render_args::RenderArgs;
use crate::values::Algorithm;
use durer::pipeline::{DrawStyle, SurfaceMethod};
use durer_formats::drawing::DrawingFormat;

/// Warns of options that were given without any effect.
pub fn warn(args: &RenderArgs, messages: &Messages) {
    let kind = wanted(args).kind;
    let rules = if drawing::is_wanted(args, kind) {
        [of_lines(args), of_style(args), of_file(args, kind), of_lists(args, kind)]
    } else {
        [of_algorithm(args), of_samples(args), of_shading(args), None]
    };
    idle::warn(&args.given, rules.into_iter().flatten(), messages);
}

/// Returns options for areas, where a drawing has lines only.
fn of_lines(args: &RenderArgs) -> Option<Rule> {
    let lines =
        matches!(args.drawing.style, None | Some(DrawStyle::HiddenLine | DrawStyle::Wireframe));
    // The caps of sections are areas.
    let hatched = args.drawing.hatch.is_some_and(|hatch| hatch != Hatch::None);
    let has_areas = hatched || !args.section.section.is_empty();
    (lines && !has_areas).then_some((
        "the drawing consists of lines; --style regions has areas",
        &["light", "exposure", "own_lights", "cull", "merge", "fill"],
    ))
}

/// Returns options for lines that a style does not have.
fn of_style(args: &RenderArgs) -> Option<Rule> {
    match args.drawing.style? {
        DrawStyle::Wireframe => Some(("a wireframe shows all lines alike", &["hidden", "beneath"])),
        DrawStyle::Regions => Some((
            "the style regions has no lines; regions+lines has",
            &["hidden", "beneath", "lines", "stubs"],
        )),
        _ => None,
    }
}

/// Returns options that a format of drawings has no place for.
fn of_file(args: &RenderArgs, kind: Kind) -> Option<Rule> {
    let sheet = args.drawing.sheet.is_some();
    Some(match kind.drawing()? {
        DrawingFormat::GeoJson => (
            "a .geojson has the units of the model, and no paper",
            &["page", "margin", "scale", "unit", "pen", "background", "title"],
        ),
        DrawingFormat::Dxf | DrawingFormat::Hpgl if !sheet => {
            ("the file has no place for it", &["background", "title"])
        }
        DrawingFormat::Dxf | DrawingFormat::Hpgl | DrawingFormat::Gcode => {
            ("the file has no place for it", &["background"])
        }
        _ => return None,
    })
}

/// Returns options for the look or the order of lines, where a file lists lines with their properties or has none.
fn of_lists(args: &RenderArgs, kind: Kind) -> Option<Rule> {
    let format = kind.drawing()?;
    let hatched = args.drawing.hatch.is_some_and(|hatch| hatch != Hatch::None);
    if format == DrawingFormat::GeoJson {
        return Some((
            "a .geojson has all lines, with `visible` and the number of surfaces in front of them as properties",
            &["hidden"],
        ));
    }
    (args.drawing.style == Some(DrawStyle::Regions) && !hatched && !format.is_for_pens())
        .then_some(("the style regions has no lines; regions+lines has", &["pen_order"]))
}

/// Returns options for surfaces, where a picture shows edges only.
fn of_algorithm(args: &RenderArgs) -> Option<Rule> {
    (algorithm(args) == Algorithm::Wireframe).then_some((
        "the algorithm wireframe draws edges, not surfaces",
        &[
            "aa",
            "shading",
            "light",
            "own_lights",
            "cull",
            "shadows",
            "exposure",
            "environment",
            "tone_map",
        ],
    ))
}

/// Returns `--aa` for algorithms with one sample per pixel, if it requests more.
fn of_samples(args: &RenderArgs) -> Option<Rule> {
    use SurfaceMethod::{DepthSort, ScanLineZ, SpanningScanLine};
    let single =
        matches!(algorithm(args), Algorithm::Surfaces(ScanLineZ | SpanningScanLine | DepthSort));
    (single && args.picture.aa != Samples::One)
        .then_some(("this algorithm has one sample per pixel", &["aa"]))
}

/// Returns options for light, where surfaces have none.
fn of_shading(args: &RenderArgs) -> Option<Rule> {
    let shading = args.look.shading;
    if matches!(shading, Some(Shading::Unlit)) {
        let lit: &[&str] = &["light", "own_lights", "exposure", "environment", "shadows"];
        // Without shadows is what `--shadows none` requests.
        let idle = if matches!(args.look.shadows, Shadows::None) { &lit[..4] } else { lit };
        return Some(("--shading unlit shows colours without light", idle));
    }
    matches!(args.look.shadows, Shadows::Rays)
        .then_some(("rays to the lights need no map", &["shadow_map"]))
}
