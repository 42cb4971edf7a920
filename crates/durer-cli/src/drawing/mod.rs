//! `durer render` to drawings: vector files, and pictures painted from drawings.

pub mod annotations;
mod broken;
mod callouts;
mod check;
mod layout;
mod sheet;
mod tones;

use crate::camera;
use crate::failure::Failure;
use crate::film::Sink;
use crate::kind::Kind;
use crate::options::drawing::{Crease, Fill, Hatch, Hidden, Merge, Smooth};
use crate::options::{Ortho, ViewArgs};
use crate::output;
use crate::render_args::RenderArgs;
use crate::report::drawing::{DrawingReport, FeatureReport};
use crate::report::{CameraReport, PictureReport};
use crate::shape;
use crate::values::Size;
pub use annotations::Annotated;
use annotations::Look;
use callouts::Callouts;
pub use check::check;
use durer::math::{DVec2, Vec4};
use durer::paper::{self, Page, Scale, SheetView, ViewBreaks, ViewKind};
use durer::pipeline::{self, Background, DrawOptions, DrawStyle, Lighting};
use durer::scene::{Camera, Scene};
use durer::target::Pixels;
use durer::target::drawing::Drawing;
use durer::target::sheet::Sheet;
use durer::view::components::Component;
use durer::visibility::line::hidden_line;
use durer_formats::drawing::{DrawingFormat, DxfStrokes, FileOptions};
use layout::{lay_out, scale_warning, unit};
use sheet::Shot;
use std::time::Instant;

/// Distance of hatching lines in the darkest tone, millimetres.
const HATCH_SPACING: f64 = 0.7;

/// The same for lines along the curvature.
const CONTOUR_SPACING: f64 = 0.6;

/// The length of stubs on paper, percent of the drawing's larger side.
const STUBS: f64 = 1.0;

/// Distance within which hidden lines beside visible ones are left out on paper, in percent of the drawing's larger
/// side: 0.36 mm of 180, a pen's width.
const BENEATH: f64 = 0.2;

/// Largest distance between fitted curves and lines of vector drawings, in millimetres: machines that cut paper and
/// sheet metal are no more exact.
const FIT: f64 = 0.02;

/// Smallest tolerance of simplified lines, as a part of the drawing's extent: smaller deviations come from rounding.
const FINEST: f64 = 1e-5;

/// The shape of a sheet of several views if no page is given: ISO paper in landscape.
const SHEET: DVec2 = DVec2::new(297.0, 210.0);

/// Returns whether the options request a drawing, rather than for pixels of surfaces.
pub fn is_wanted(args: &RenderArgs, kind: Kind) -> bool {
    kind.is_vector() || args.drawing.style.is_some() || args.drawing.sheet.is_some()
}

/// Assigns contours, and lines by their distance, classes of their own, if requested.
fn weighted(
    args: &RenderArgs,
    scene: &Scene,
    drawing: Drawing,
    camera: &Camera,
) -> durer::Result<Drawing> {
    let mut drawing = drawing;
    if args.drawing.contour {
        drawing = pipeline::contoured(drawing, scene, camera)?;
    }
    if args.drawing.depth_cue {
        drawing = pipeline::depth_cued(drawing, scene, camera)?;
    }
    Ok(drawing)
}

/// Returns the colour of the paper. Vector files stay blank unless a colour is requested.
fn background(args: &RenderArgs, kind: Kind) -> Result<Option<[u8; 4]>, Failure> {
    let requested = args.given.iter().any(|g| g == "background");
    match args.picture.background {
        _ if !requested && kind.is_vector() => Ok(None),
        Background::Color(color) if color.w == 0.0 => Ok(None),
        Background::Color(color) => Ok(Some(bytes(color))),
        _ => {
            let message = "--background: drawings have one colour behind them, no gradient";
            Err(Failure::Usage(message.to_owned()))
        }
    }
}

fn bytes(color: Vec4) -> [u8; 4] {
    color.to_array().map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// A model with the data of its drawing's title block.
pub struct Subject<'a> {
    /// Scene of the model.
    pub scene: &'a Scene,
    /// The model's name without folder and suffix.
    pub name: &'a str,
    /// The format found.
    pub format: &'a str,
    /// The material of the caps, where the model was cut.
    pub cap_material: Option<usize>,
    /// The kinds of its parts, if they are to be numbered.
    pub components: Vec<Component>,
    /// The annotations of its drawings, with its round parts.
    pub annotated: Option<Annotated>,
}

/// A view with its visible lines and regions.
pub struct Shown {
    /// Its part on a sheet; `None` without one.
    kind: Option<ViewKind>,
    camera: Camera,
    drawing: Drawing,
    /// The breaks of the drawing.
    breaks: ViewBreaks,
}

impl Shown {
    fn sheet_view(&self) -> Option<SheetView<'_>> {
        let kind = self.kind.clone()?;
        Some(SheetView {
            kind,
            camera: self.camera,
            drawing: &self.drawing,
            breaks: self.breaks.clone(),
        })
    }
}

/// A drawing on its sheet.
pub struct Made {
    /// Marks on paper.
    pub sheet: Sheet,
    /// Lines and regions of each view.
    pub drawings: Vec<Drawing>,
    /// Report on the picture.
    pub report: PictureReport,
    /// Reason why nothing of the model is visible, if nothing is.
    pub unseen: Option<String>,
    /// Time at which the drawing was put on its sheet.
    start: Instant,
}

/// Draws one picture of a model and writes its file; if nothing of the model is visible, returns the reason.
pub fn render(
    args: &RenderArgs,
    subject: &Subject,
    frame: Option<u32>,
    sink: &mut Sink,
    kind: Kind,
) -> Result<(PictureReport, Option<String>), Failure> {
    let Made { sheet, drawings, mut report, unseen, start } = make(args, subject, frame, kind)?;
    write(args, kind, sink, sheet, &drawings, &mut report, start)?;
    report.files = vec![sink.name()];
    Ok((report, unseen))
}

/// Draws one picture of a model.
pub fn make(
    args: &RenderArgs,
    subject: &Subject,
    frame: Option<u32>,
    kind: Kind,
) -> Result<Made, Failure> {
    let start = Instant::now();
    let style = args.drawing.style.unwrap_or_default();
    let mut report = PictureReport::default();
    let shots = match args.drawing.sheet {
        Some(_) => sheet::shots(args, subject.scene)?,
        None => {
            let kind = args.drawing.callouts.then_some(ViewKind::Free);
            vec![Shot::new(kind, single_camera(args, subject.scene, frame)?)]
        }
    };
    let annotated = &subject.annotated;
    let breaks = broken::breaks(args, subject.scene, &shots, &mut report.notes)?;
    report.cameras = shots.iter().map(|s| CameraReport::from(&s.camera)).collect();
    let (mut shown, mut statuses, mut sources) = (Vec::new(), Vec::new(), Vec::new());
    for shot in shots {
        let (cut, cap_material) = match shot.cut(args, subject.scene, &mut report.notes)? {
            Some((cut, charge)) => (Some((cut.scene, charge)), Some(cut.cap_material)),
            None => (None, subject.cap_material),
        };
        let scene = cut.as_ref().map_or(subject.scene, |cut| &cut.0);
        let toned = with_tones(style, args.drawing.hatch);
        let mut options =
            DrawOptions { cap_material, ..draw_options(args, kind, toned, shot.camera) };
        options.lines.tolerance = line_tolerance(args, kind, subject);
        let drawing = pipeline::draw(scene, &options).map_err(usage)?;
        let drawing = weighted(args, scene, drawing, &shot.camera).map_err(usage)?;
        let DrawOptions { camera, aspect, .. } = &options;
        let status = pipeline::drawing_status(scene, camera, *aspect, &drawing);
        statuses.push(status.map_err(usage)?);
        let breaks = breaks.seen_by(&shot.camera);
        let drawing = breaks.cut(drawing).map_err(usage)?;
        shown.push(Shown { kind: shot.kind, camera: shot.camera, drawing, breaks });
        sources.push((cut, options));
    }
    let unseen = report.set_status(&statuses);
    sheet::add_details(args, &mut shown, &mut report.notes)?;
    let called = if args.drawing.callouts {
        // The cameras of sheets see all of the model in a square.
        let aspect = if args.drawing.sheet.is_some() { 1.0 } else { aspect(args) };
        Callouts::find(subject, &shown, aspect, &mut report.notes)?
    } else {
        Callouts::default()
    };
    let geometry_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let room = annotated.as_ref().map_or(0.0, Annotated::room);
    let mut laid = lay_out(args, kind, subject, (frame, room), (&shown, &called))?;
    // In a line drawing the faces of a section are hatched, unless they are to be filled.
    let on_paper = kind != Kind::Drawing(DrawingFormat::GeoJson);
    let lines_only = on_paper && !style.has_regions() && args.drawing.hatch.is_none();
    let has_areas = shown.iter().any(|s| !s.drawing.regions.is_empty());
    let hatched = has_areas && (hatch(args, kind) != Hatch::None || lines_only);
    // The scale on paper says how far apart lines are in the model.
    if hatched {
        for (view, placed) in shown.iter_mut().zip(&laid.views) {
            let spacing = HATCH_SPACING / placed.factor;
            view.drawing = pipeline::hatched(std::mem::take(&mut view.drawing), spacing);
        }
    }
    let marked = tones::requested(args).is_some();
    if marked {
        let of = sources.iter().map(|(cut, options)| {
            let scene = cut.as_ref().map_or(subject.scene, |cut| &cut.0);
            (scene, options)
        });
        let of: Vec<_> = of.collect();
        tones::add(args, &mut shown, &of, laid.views.iter().map(|placed| placed.factor))?;
    }
    if hatched || marked {
        laid = lay_out(args, kind, subject, (frame, room), (&shown, &called))?;
    }
    if let Some(annotated) = annotated {
        annotated.put(&mut laid, &shown, &look(args, subject))?;
    }
    if args.drawing.machine.orders(kind.drawing()) {
        paper::order::sheet(&mut laid.sheet);
    }
    report.notes.append(&mut laid.notes);
    report.geometry_seconds = geometry_seconds;
    report.triangles.given = subject.scene.triangle_count();
    let all: Vec<&Drawing> = shown.iter().map(|s| &s.drawing).collect();
    let features = annotated.iter().flat_map(|a| &a.features).map(FeatureReport::from).collect();
    let scale_warning = scale_warning(args, kind, subject, &laid);
    let drawing = DrawingReport::new(style.name(), &all, &laid, features);
    report.drawing = Some(DrawingReport { scale_warning, ..drawing });
    let drawings = shown.into_iter().map(|s| s.drawing).collect();
    Ok(Made { sheet: laid.sheet, drawings, report, unseen, start })
}

fn look(args: &RenderArgs, subject: &Subject) -> Look {
    Look {
        unit: unit(args, subject).millimetres(),
        hidden: args.drawing.hidden != Hidden::Drop,
        color: args.drawing.pen.unwrap_or_default().color,
    }
}

/// Returns the style to draw in: hatching by shade needs the areas between lines, so hidden-line drawings get regions
/// too.
fn with_tones(style: DrawStyle, hatch: Option<Hatch>) -> DrawStyle {
    match (style, hatch) {
        (DrawStyle::HiddenLine, Some(Hatch::Shade)) => DrawStyle::RegionsAndLines,
        _ => style,
    }
}

fn hatch(args: &RenderArgs, kind: Kind) -> Hatch {
    args.drawing.hatch.unwrap_or(match kind {
        Kind::Drawing(format) if format.is_for_pens() => Hatch::Shade,
        _ => Hatch::None,
    })
}

fn write(
    args: &RenderArgs,
    kind: Kind,
    sink: &mut Sink,
    sheet: Sheet,
    drawings: &[Drawing],
    report: &mut PictureReport,
    start: Instant,
) -> Result<(), Failure> {
    match (kind, sink) {
        (Kind::Picture(_) | Kind::Gif, sink) => {
            let pixels = paint(args, kind, sheet)?;
            (report.width, report.height) = (pixels.width(), pixels.height());
            report.raster_seconds = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let format = kind.picture();
            report.flattened = sink.put(&pixels, format, &args.picture.encoding)?;
            report.encode_seconds = start.elapsed().as_secs_f64();
        }
        (Kind::Drawing(_), Sink::Film(_)) => {}
        (Kind::Drawing(format), Sink::File(target)) => {
            report.raster_seconds = start.elapsed().as_secs_f64();
            let start = Instant::now();
            output::deliver(target, &args.running.work, |out| {
                encode(args, out, format, &sheet, drawings)
            })?;
            report.encode_seconds = start.elapsed().as_secs_f64();
        }
    }
    Ok(())
}

/// Paints a sheet as pixels.
pub fn paint(args: &RenderArgs, kind: Kind, sheet: Sheet) -> Result<Pixels<[u8; 4]>, Failure> {
    let Size { width, height } = args.picture.size;
    let beside = background(args, kind)?.unwrap_or([0; 4]);
    paper::paint(sheet, width, height, beside).map_err(|e| Failure::Usage(e.to_string()))
}

/// Writes a sheet as vectors, or of GeoJSON the first of its drawings.
pub fn encode(
    args: &RenderArgs,
    out: &mut impl std::io::Write,
    format: DrawingFormat,
    sheet: &Sheet,
    drawings: &[Drawing],
) -> durer_formats::Result<()> {
    let empty = Drawing::default();
    let drawing = drawings.first().unwrap_or(&empty);
    let options = FileOptions {
        dxf: dxf_strokes(args),
        machine: args.drawing.machine.options(),
        work: args.running.work.clone(),
        ..FileOptions::default()
    };
    durer_formats::drawing::write(out, format, sheet, drawing, &options)
}

/// Returns the largest distance between fitted curves and lines, in millimetres on paper.
fn curve_fit(args: &RenderArgs, kind: Kind) -> f64 {
    args.drawing.fit.unwrap_or(if kind.is_vector() { FIT } else { 0.0 })
}

/// Returns the tolerance for simplifying lines, as a part of the drawing's extent: smaller on large paper, so that
/// curves still pass through the points that they are fitted to.
fn line_tolerance(args: &RenderArgs, kind: Kind, subject: &Subject) -> f64 {
    let usual = hidden_line::Options::default().tolerance;
    let fit = curve_fit(args, kind);
    let truth = subject.scene.bounding_sphere().map_or(0.0, |s| 2.0 * s.radius)
        * unit(args, subject).millimetres();
    let extent = match (args.drawing.page, args.drawing.scale) {
        (Some(Page::Exact(size) | Page::Either(size)), _) => size.max_element(),
        (_, Some(Scale::Given(scale))) => truth * scale,
        _ if matches!(kind, Kind::Drawing(DrawingFormat::Dxf | DrawingFormat::Gcode)) => truth,
        _ => 0.0,
    };
    match fit > 0.0 && extent > 0.0 && extent.is_finite() {
        true => (fit * 0.5 / extent).clamp(FINEST, usual),
        false => usual,
    }
}

fn dxf_strokes(args: &RenderArgs) -> DxfStrokes {
    match args.drawing.dxf_polylines || args.drawing.fit == Some(0.0) {
        true => DxfStrokes::Polylines,
        false => DxfStrokes::Pieces,
    }
}

/// Returns whether areas extend under the ones that cover them.
fn is_trapped(args: &RenderArgs, kind: Kind) -> bool {
    let paper = matches!(kind, Kind::Drawing(DrawingFormat::Svg | DrawingFormat::Pdf));
    let viewed = paper || !kind.is_vector();
    match args.drawing.fill {
        Some(fill) => fill == Fill::Trapped,
        None => viewed && matches!(args.drawing.hatch, None | Some(Hatch::None)),
    }
}

fn draw_options(args: &RenderArgs, kind: Kind, style: DrawStyle, camera: Camera) -> DrawOptions {
    let drawing = &args.drawing;
    let lighting = match &args.look.light[..] {
        [] => Lighting::Auto,
        lights => Lighting::Given(lights.to_vec()),
    };
    let geojson = kind == Kind::Drawing(DrawingFormat::GeoJson);
    let merge = drawing.merge.unwrap_or(match kind {
        Kind::Drawing(DrawingFormat::GeoJson) => Merge::Face,
        Kind::Drawing(DrawingFormat::Dxf) => Merge::Band,
        _ => Merge::Shade,
    });
    let all = geojson || drawing.stubs == Some(0.0);
    let default = hidden_line::Options::default();
    let smooth = drawing.smooth.unwrap_or(if all { Smooth::Off } else { Smooth::Auto });
    DrawOptions {
        work: args.running.work.clone(),
        style,
        camera,
        aspect: aspect(args),
        lines: hidden_line::Options {
            classes: drawing.lines.unwrap_or(default.classes),
            crease: drawing.crease.from.to_radians(),
            crease_end: drawing.crease.to.to_radians(),
            // Files for programs have all lines; on paper, hidden lines may be left out from the start.
            hidden: drawing.hidden != Hidden::Drop || geojson,
            intersections: drawing.intersections.into(),
            neighbours: smooth != Smooth::Off && drawing.crease == Crease::default(),
            smooth: smooth.into(),
            weld: drawing.weld,
            stubs: drawing.stubs.unwrap_or(if geojson { 0.0 } else { STUBS }) / 100.0,
            beneath: drawing.beneath.unwrap_or(if all { 0.0 } else { BENEATH }) / 100.0,
            ..default
        },
        lighting,
        exposure: args.look.exposure,
        cull: args.look.cull.into(),
        merge: merge.into(),
        trapped: is_trapped(args, kind),
        cap_material: None,
    }
}

/// Returns the ratio of width to height of the camera's view: the picture's, or the page's if it is certain.
fn aspect(args: &RenderArgs) -> f64 {
    let Size { width, height } = size(args);
    (f64::from(width) / f64::from(height)).clamp(1e-3, 1e3)
}

/// Returns the size that cameras are fitted to; in units of a tenth of a millimetre for pages.
fn size(args: &RenderArgs) -> Size {
    match args.drawing.page {
        Some(Page::Exact(page)) => {
            let side = |s: f64| ((s * 10.0).round() as u32).max(1);
            Size { width: side(page.x), height: side(page.y) }
        }
        _ => args.picture.size,
    }
}

/// Returns the shape of a picture whose size leaves a side open: its page's, or the model's in the view.
pub fn shape(args: &RenderArgs, scene: &Scene) -> Result<DVec2, Failure> {
    match args.drawing.page {
        Some(Page::Exact(size) | Page::Either(size)) => Ok(size),
        _ if args.drawing.sheet.is_some() => Ok(SHEET),
        _ if args.drawing.style.is_some() => {
            shape::of_view(&view(args), scene, args.picture.turntable)
        }
        _ => shape::of_picture(&args.picture, &args.view, scene),
    }
}

/// Returns the view options. Fitted views are parallel unless an angle of view is given, because drawings are measured
/// in parallel views.
fn view(args: &RenderArgs) -> ViewArgs {
    let mut view = args.view.clone();
    let fitted = view.eye.is_none() && view.camera.is_none();
    if fitted && view.fov.is_none() && view.ortho.is_none() {
        view.ortho = Some(Ortho::Fit);
    }
    view
}

/// Returns the camera of the view options.
fn single_camera(args: &RenderArgs, scene: &Scene, frame: Option<u32>) -> Result<Camera, Failure> {
    let shot =
        camera::Shot { view: None, size: size(args), turn: frame.zip(args.picture.turntable) };
    camera::camera(&view(args), scene, &shot)
}

/// Returns the failure for options that the library refuses.
fn usage(e: durer::Error) -> Failure {
    Failure::of_library(&e)
}
