//! `--hatch contour` and `--hatch stipple`: marks between the lines of a drawing.

use super::{CONTOUR_SPACING, usage};
use crate::failure::Failure;
use crate::options::drawing::Hatch;
use crate::render_args::RenderArgs;
use durer::paper::ViewBreaks;
use durer::pipeline::{self, DrawOptions, DrawStyle, ToneMarks};
use durer::scene::Scene;
use durer::target::drawing::{Drawing, Line, LineClass};

/// Returns the marks for `--hatch`.
pub fn asked(args: &RenderArgs) -> Option<Hatch> {
    args.drawing.hatch.filter(|hatch| matches!(hatch, Hatch::Contour | Hatch::Stipple))
}

/// Refuses marks in styles that have fills or show hidden lines.
pub fn check(args: &RenderArgs) -> Result<(), Failure> {
    let Some(hatch) = asked(args) else { return Ok(()) };
    let style = args.drawing.style.unwrap_or_default();
    if style == DrawStyle::HiddenLine {
        return Ok(());
    }
    let name = if hatch == Hatch::Stipple { "stipple" } else { "contour" };
    Err(Failure::Usage(format!(
        "--hatch {name}: its marks are drawn between the lines of --style hidden-line, not in the style {style}; \
         use that style, or --hatch shade"
    )))
}

/// Returns the marks for the tones of a view; `factor` is its scale, millimetres per plane unit.
pub fn marks(
    args: &RenderArgs,
    (scene, options): (&Scene, &DrawOptions),
    breaks: &ViewBreaks,
    factor: f64,
) -> Result<Vec<Line>, Failure> {
    let marks = match asked(args) {
        None => return Ok(Vec::new()),
        Some(Hatch::Stipple) => {
            let pens = args.drawing.pen.unwrap_or_default();
            ToneMarks::Dots { diameter: pens.width(LineClass::Stipple) / factor }
        }
        Some(_) => ToneMarks::Contours { spacing: CONTOUR_SPACING / factor },
    };
    let lines = pipeline::tone_marks(scene, options, marks).map_err(usage)?;
    // The lines of the breaks themselves are in the drawing already.
    let cut = breaks.cut(Drawing { lines, ..Drawing::default() }).map_err(usage)?;
    Ok(cut.lines.into_iter().filter(|l| l.class != LineClass::Break).collect())
}
