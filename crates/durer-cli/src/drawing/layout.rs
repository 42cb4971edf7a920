//! The layout of drawings on paper: units, scale, page and margins.

use super::callouts::Callouts;
use super::{Shown, Subject, background, curve_fit, is_trapped};
use crate::failure::Failure;
use crate::kind::Kind;
use crate::options::Ortho;
use crate::options::drawing::Unit;
use crate::render_args::RenderArgs;
use crate::values::Size;
use durer::paper::{self, Contents, LaidOut, Page, PaperFrame, Scale, SheetView, TitleBlock};
use durer::target::drawing::Drawing;
use durer_formats::drawing::DrawingFormat;

/// Range of the longer side, millimetres, of drawings that are 1:1 if neither page nor scale is given: for DXF and
/// G-code as far as their digits reach, for SVG up to the size of a desk or a screen.
const SMALLEST: f64 = 0.1;
const LARGEST: f64 = 900_000.0;
const HANDY: std::ops::RangeInclusive<f64> = 20.0..=420.0;

/// Free space on paper, millimetres: on pages, and around drawings without one.
const PAGE_MARGIN: f64 = 10.0;
const MARGIN: f64 = 5.0;

/// The longer side of the paper behind a painted picture, millimetres: pens are as wide in it as on a
/// sheet of this size.
const PAINTED_SIDE: f64 = 190.0;

pub(super) fn unit(args: &RenderArgs, subject: &Subject) -> Unit {
    known_unit(args, subject).unwrap_or(Unit::Mm)
}

/// Returns the model's unit, if it is given or known from the format. Readers convert lengths to metres, or to
/// millimetres for 3MF.
pub(super) fn known_unit(args: &RenderArgs, subject: &Subject) -> Option<Unit> {
    let format = subject.format.to_ascii_lowercase();
    let is_one = |names: &[&str]| names.iter().any(|name| format.contains(name));
    let of_format = match () {
        () if is_one(&["gl", "collada", "fbx"]) => Some(Unit::M),
        () if is_one(&["3mf"]) => Some(Unit::Mm),
        () => None,
    };
    args.drawing.unit.or(of_format)
}

pub(super) fn lay_out(
    args: &RenderArgs,
    kind: Kind,
    subject: &Subject,
    (frame, room): (Option<u32>, f64),
    (shown, called): (&[Shown], &Callouts),
) -> Result<LaidOut, Failure> {
    let paper = paper_options(args, kind, subject, frame, shown)?;
    let options = paper::Options { around: room, ..paper };
    let name = args.drawing.title.clone().unwrap_or_else(|| subject.name.to_owned());
    let views: Vec<SheetView> = shown.iter().filter_map(Shown::sheet_view).collect();
    let laid = if views.is_empty() {
        let empty = Drawing::default();
        let drawing = shown.first().map_or(&empty, |s| &s.drawing);
        paper::lay_out(drawing, &name, &options)
    } else {
        let sheet = args.drawing.sheet;
        let title = sheet.map(|_| TitleBlock {
            name,
            unit: unit(args, subject).name().to_owned(),
            date: args.drawing.date.clone(),
        });
        let contents = Contents {
            angle: sheet.map(Into::into).unwrap_or_default(),
            views: &views,
            callouts: &called.callouts,
            parts: &called.parts,
            title: title.as_ref(),
        };
        paper::lay_out_views(&contents, &options)
    };
    laid.map_err(|e| Failure::Usage(format!("--{e}")))
}

/// Returns whether a drawing without page and scale is 1:1: for machines, and where that makes a handy sheet.
fn is_true_size(args: &RenderArgs, kind: Kind, subject: &Subject, shown: &[Shown]) -> bool {
    let sides = shown.iter().filter_map(|s| s.drawing.bounds()).map(|b| b.size().max_element());
    let size = sides.fold(0.0, f64::max) * unit(args, subject).millimetres();
    match kind {
        Kind::Drawing(DrawingFormat::Dxf) => (SMALLEST..=LARGEST).contains(&size),
        Kind::Drawing(DrawingFormat::Svg) => {
            known_unit(args, subject).is_some() && HANDY.contains(&size)
        }
        Kind::Drawing(DrawingFormat::Gcode) => {
            known_unit(args, subject).is_some() && (SMALLEST..=LARGEST).contains(&size)
        }
        _ => false,
    }
}

/// Returns the warning about the scale of drawings that machines cut or that are measured, if one is due.
pub(super) fn scale_warning(
    args: &RenderArgs,
    kind: Kind,
    subject: &Subject,
    laid: &LaidOut,
) -> Option<String> {
    let requested = matches!(args.drawing.scale, Some(Scale::Given(_)));
    let cuts = matches!(kind, Kind::Drawing(DrawingFormat::Dxf | DrawingFormat::Gcode));
    if !cuts || args.drawing.sheet.is_some() {
        return None;
    }
    let size = laid.sheet.size;
    let on_bed = kind != Kind::Drawing(DrawingFormat::Gcode) || args.drawing.page.is_some();
    if !requested && !on_bed && laid.scale == 1.0 && size.max_element() > *HANDY.end() {
        let [width, height] = [size.x, size.y].map(|v| v.ceil());
        return Some(format!(
            "the drawing is as large as the model, {width} × {height} mm; --page, e.g. {width}x{height}, \
             sets the size of the machine's bed and fits the drawing to it"
        ));
    }
    if !requested && laid.scale != 1.0 {
        let scale = paper::scale_text(laid.scale);
        return Some(format!("the drawing is {scale}; --scale 1:1 makes it as large as the model"));
    }
    known_unit(args, subject).is_none().then(|| {
        let format = subject.format.split(',').next().unwrap_or_default();
        format!("{format} files have no unit; one unit of the model is drawn as 1 mm; --unit sets another")
    })
}

fn paper_options(
    args: &RenderArgs,
    kind: Kind,
    subject: &Subject,
    frame: Option<u32>,
    shown: &[Shown],
) -> Result<paper::Options, Failure> {
    let drawing = &args.drawing;
    let view = &args.view;
    // Whoever says where the eye is, or how high the view, wants to see just that; so do frames of a
    // turntable, which have to fit each other.
    let placed =
        view.eye.is_some() || view.camera.is_some() || matches!(view.ortho, Some(Ortho::Height(_)));
    let window = drawing.sheet.is_none()
        && drawing.breaks.is_empty()
        && (placed || frame.is_some() || !kind.is_vector());
    let page = drawing.page.unwrap_or_else(|| match kind {
        Kind::Picture(_) | Kind::Gif if drawing.sheet.is_none() && drawing.scale.is_none() => {
            let Size { width, height } = args.picture.size;
            let size = durer::math::DVec2::new(f64::from(width), f64::from(height));
            Page::Exact(size * (PAINTED_SIDE / size.max_element()))
        }
        _ => Page::Fit,
    });
    let on_page = drawing.page.is_some() || drawing.sheet.is_some();
    let parallel = view.fov.is_none() && view.eye.is_none() && view.camera.is_none();
    let scale = match (on_page, parallel) {
        (true, true) => Scale::Standard,
        (false, true) if is_true_size(args, kind, subject, shown) => Scale::Given(1.0),
        _ => Scale::Fit,
    };
    // A painted window fills the picture, as pixels of surfaces do.
    let filled = !kind.is_vector() && window && drawing.page.is_none();
    let margin = if on_page {
        PAGE_MARGIN
    } else if filled {
        0.0
    } else {
        MARGIN
    };
    Ok(paper::Options {
        page,
        margin: drawing.margin.unwrap_or(margin),
        scale: drawing.scale.unwrap_or(scale),
        unit: unit(args, subject).millimetres(),
        frame: if window { PaperFrame::Window } else { PaperFrame::Content },
        hidden: drawing.hidden.into(),
        pens: drawing.pen.unwrap_or_default(),
        fit: curve_fit(args, kind),
        fit_areas: kind.is_vector() && !is_trapped(args, kind),
        background: background(args, kind)?,
        around: 0.0,
    })
}
