//! Options of plots that have no effect together with others.

use super::args::{Lines, PlotArgs};
use crate::idle::{self, Rule};
use crate::kind::Kind;
use crate::messages::Messages;
use durer_formats::drawing::DrawingFormat;

/// Warns of options that were given without any effect.
pub fn warn(args: &PlotArgs, kind: Kind, messages: &Messages) {
    let look = &args.look;
    let rules = [
        look.no_axes.then_some(("the plot has no axes", &["labels"][..])),
        look.color_map.is_none().then_some(("there is no --color-map", &["no_color_bar"])),
        (look.lines == Lines::None).then_some(("the plot has no lines", &["every", "hidden"])),
        kind.is_vector().then_some(("a vector file has millimetres; use --page", &["size"])),
        of_file(kind),
    ];
    idle::warn(&args.given, rules.into_iter().flatten(), messages);
}

/// Returns options that a format has no place for.
fn of_file(kind: Kind) -> Option<Rule> {
    use DrawingFormat::{Dxf, Gcode, GeoJson, Hpgl};
    Some(match kind {
        Kind::Drawing(GeoJson | Hpgl) => ("the file has no place for it", &["background", "ink"]),
        Kind::Drawing(Dxf | Gcode) => ("the file has no place for it", &["background"]),
        Kind::Drawing(_) => return None,
        Kind::Picture(_) | Kind::Gif => ("it is for plotters", &["pen_order"]),
    })
}
