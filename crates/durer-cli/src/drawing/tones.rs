//! `--hatch contour` and `--hatch stipple`: marks between the lines of a drawing.

use super::{CONTOUR_SPACING, Shown, usage};
use crate::failure::Failure;
use crate::options::drawing::Hatch;
use crate::render_args::RenderArgs;
use durer::paper::{Detail, ViewBreaks, ViewKind};
use durer::pipeline::{self, DrawOptions, DrawStyle, ToneMarks};
use durer::scene::Scene;
use durer::target::drawing::{Drawing, Line, LineClass};

/// Returns the marks for `--hatch`.
pub fn requested(args: &RenderArgs) -> Option<Hatch> {
    args.drawing.hatch.filter(|hatch| matches!(hatch, Hatch::Contour | Hatch::Stipple))
}

/// Refuses marks in styles that have fills or show hidden lines.
pub fn check(args: &RenderArgs) -> Result<(), Failure> {
    let Some(hatch) = requested(args) else { return Ok(()) };
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

/// A view's scene and the options that it was drawn by.
pub type Source<'a> = (&'a Scene, &'a DrawOptions);

/// Adds the marks for the tones of all views, and of the details after them; `factors` are their scales, millimetres
/// per plane unit.
pub fn add(
    args: &RenderArgs,
    shown: &mut [Shown],
    sources: &[Source<'_>],
    factors: impl Iterator<Item = f64>,
) -> Result<(), Failure> {
    for (i, (view, factor)) in shown.iter_mut().zip(factors).enumerate() {
        let marks = match &view.kind {
            Some(ViewKind::Detail(detail)) => {
                of_detail(args, detail, sources[detail.of], &view.breaks, factor)?
            }
            _ => of_view(args, sources[i], &view.breaks, factor)?,
        };
        view.drawing = pipeline::with_marks(std::mem::take(&mut view.drawing), marks);
    }
    Ok(())
}

fn of_view(
    args: &RenderArgs,
    source: Source<'_>,
    breaks: &ViewBreaks,
    factor: f64,
) -> Result<Vec<Line>, Failure> {
    let lines = marks(args, source, factor)?;
    // The lines of the breaks themselves are in the drawing already.
    let cut = breaks.cut(Drawing { lines, ..Drawing::default() }).map_err(usage)?;
    Ok(cut.lines.into_iter().filter(|l| l.class != LineClass::Break).collect())
}

/// Returns the marks of a detail: those of its view would be as much too far apart as it is enlarged.
fn of_detail(
    args: &RenderArgs,
    detail: &Detail,
    (scene, options): Source<'_>,
    breaks: &ViewBreaks,
    factor: f64,
) -> Result<Vec<Line>, Failure> {
    let (camera, origin) = detail.camera(&options.camera, breaks);
    let options = DrawOptions { camera, aspect: 1.0, ..options.clone() };
    let mut lines = marks(args, (scene, &options), factor)?;
    lines.iter_mut().flat_map(|l| &mut l.points).for_each(|p| *p += origin);
    let cut = breaks.cut(Drawing { lines, ..Drawing::default() }).map_err(usage)?;
    let cut = detail.cut(&cut).map_err(usage)?;
    Ok(cut.lines.into_iter().filter(|l| l.class != LineClass::Break).collect())
}

/// Returns the marks of all that a camera sees; `factor` is the scale, millimetres per plane unit.
fn marks(
    args: &RenderArgs,
    (scene, options): Source<'_>,
    factor: f64,
) -> Result<Vec<Line>, Failure> {
    let marks = match requested(args) {
        None => return Ok(Vec::new()),
        Some(Hatch::Stipple) => {
            let pens = args.drawing.pen.unwrap_or_default();
            ToneMarks::Dots { diameter: pens.width(LineClass::Stipple) / factor }
        }
        Some(_) => ToneMarks::Contours { spacing: CONTOUR_SPACING / factor },
    };
    pipeline::tone_marks(scene, options, marks).map_err(usage)
}
