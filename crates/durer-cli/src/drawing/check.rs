//! Refuses options that a drawing cannot follow, before anything is read.

use super::{background, broken, hatch, is_wanted, sheet, tones};
use crate::failure::Failure;
use crate::kind::Kind;
use crate::options::drawing::{Fill, Hatch, NAMES, OF_ANNOTATIONS};
use crate::render_args::RenderArgs;
use durer::pipeline::DrawStyle;
use durer_formats::drawing::DrawingFormat;

/// Options for pixels, and their counterparts for drawings.
const OF_PIXELS: &[(&str, &str)] = &[
    ("algorithm", "it finds visible surfaces for pixels; use --style for drawings"),
    ("aa", "vectors have no samples; leave it out, or write a .png"),
    ("look", "it is for pictures; use --style"),
    ("ambient_occlusion", "areas of drawings have one colour each; leave it out"),
    ("ground", "--style shadows draws shadows exactly"),
    ("edges", "--style regions+lines draws areas with edges"),
    ("grid", "it is for pictures; leave it out"),
    ("axes", "it is for pictures; leave it out"),
    ("line_width", "--pen sets the width of lines; leave it out"),
    ("point_size", "points of drawings are small crosses; leave it out"),
    ("color", "drawings have the colours of pens and materials; leave it out"),
    ("shading", "areas of drawings have one colour each; leave it out, and give lights by --light"),
    ("shadows", "--style shadows draws them exactly"),
    ("shadow_map", "--style shadows draws shadows exactly, without a map"),
    ("bounces", "drawings show no reflections; leave it out"),
    ("environment", "drawings show no reflections; leave it out"),
    ("tone_map", "areas of drawings have one colour each; --exposure makes all lighter or darker"),
    ("tile", "drawings are made as a whole; leave it out"),
    ("viewports", "use --sheet third-angle, or a file for each --view"),
    ("item", "areas of a .geojson with --style regions have the property `item`"),
    ("depth", "write it beside a .png without --style"),
    ("normal", "write it beside a .png without --style"),
];

/// Options that are about pixels but go with painted drawings too.
const OF_PICTURES: &[(&str, &str)] = &[
    ("size", "a vector file has millimetres; use --page, e.g. --page 200x150"),
    ("compression", "it is for .png files; leave it out"),
];

/// Checks options that the parser cannot check.
pub fn check(args: &RenderArgs, kind: Kind) -> Result<(), Failure> {
    let given = |id: &str| args.given.iter().any(|g| g == id);
    let option = |id: &str| id.replace('_', "-");
    if !is_wanted(args, kind) {
        return match NAMES.iter().find(|id| given(id)) {
            Some(id) => Err(Failure::Usage(format!(
                "--{}: it is for drawings; write a .svg, .pdf, .dxf, .hpgl, .gcode or .geojson, or give \
                 --style, e.g. --style hidden-line",
                option(id)
            ))),
            None => Ok(()),
        };
    }
    let vector = kind.is_vector();
    let wrong = OF_PIXELS.iter().chain(OF_PICTURES.iter().filter(|_| vector));
    for (id, instead) in wrong {
        if given(id) {
            let what = if vector { "a vector drawing" } else { "a drawing" };
            return Err(Failure::Usage(format!("--{} is not for {what}: {instead}", option(id))));
        }
    }
    let noted = OF_ANNOTATIONS.iter().find(|id| given(id));
    if let (Some(id), true) = (noted, kind == Kind::Drawing(DrawingFormat::GeoJson)) {
        let message = "GeoJSON has no paper to write on; write a .svg, .pdf or .dxf";
        return Err(Failure::Usage(format!("--{}: {message}", option(id))));
    }
    background(args, kind)?;
    args.drawing.machine.check(kind.drawing())?;
    if args.drawing.fill == Some(Fill::Trapped) && hatch(args, kind) == Hatch::Shade {
        let message = "--fill trapped: hatching is drawn on areas that do not overlap; use --fill \
                       disjoint, or --hatch none";
        return Err(Failure::Usage(message.to_owned()));
    }
    let requested = args.drawing.hatch == Some(Hatch::Shade);
    if requested && args.drawing.style == Some(DrawStyle::Wireframe) {
        let message = "--hatch shade: a wireframe shows no areas; use --style hidden-line, regions, \
                       regions+lines or shadows";
        return Err(Failure::Usage(message.to_owned()));
    }
    tones::check(args)?;
    let geojson = kind == Kind::Drawing(DrawingFormat::GeoJson);
    if geojson && args.drawing.fit.is_some_and(|fit| fit > 0.0) {
        let message = "--fit: GeoJSON has no curves, and no paper; leave it out";
        return Err(Failure::Usage(message.to_owned()));
    }
    if args.drawing.dxf_polylines && kind != Kind::Drawing(DrawingFormat::Dxf) {
        let message = "--dxf-polylines: it is for .dxf files; leave it out";
        return Err(Failure::Usage(message.to_owned()));
    }
    check_weights(args, kind)?;
    broken::check(args, kind)?;
    sheet::check(args, kind)
}

/// Refuses options that distinguish visible lines if there are none.
fn check_weights(args: &RenderArgs, kind: Kind) -> Result<(), Failure> {
    let given = [("depth-cue", args.drawing.depth_cue), ("contour", args.drawing.contour)];
    let Some((name, _)) = given.into_iter().find(|(_, given)| *given) else { return Ok(()) };
    let message = match args.drawing.style {
        Some(DrawStyle::Wireframe) => "a wireframe shows all lines alike; use --style hidden-line",
        Some(DrawStyle::Regions) => "areas have no lines; use --style regions+lines",
        _ if name == "depth-cue" && kind == Kind::Drawing(DrawingFormat::GeoJson) => {
            "GeoJSON has no pens; leave it out"
        }
        _ => return Ok(()),
    };
    Err(Failure::Usage(format!("--{name}: {message}")))
}
