//! The views of `--sheet`: principal ones, sections, details.

use super::Shown;
use crate::failure::Failure;
use crate::kind::Kind;
use crate::options::drawing::DetailSpec;
use crate::render_args::RenderArgs;
use crate::section::UNCAPPED;
use durer::math::{DVec3, Plane};
use durer::paper::{Detail, ViewKind};
use durer::scene::{Camera, Projection, Scene, UpAxis};
use durer::target::drawing::{Drawing, Line};
use durer::view::fit;
use durer::view::picture_plane::PicturePlane;
use durer::view::projection::NamedView;
use durer::view::section::Section;
use durer::work::Charge;
use durer_formats::drawing::DrawingFormat;
use durer_formats::wording::agreeing;

/// The views of a sheet where none are named.
const VIEWS: &[NamedView] = &[NamedView::Front, NamedView::Top, NamedView::Right, NamedView::Iso];

/// Options that say from where a model is seen.
const OF_VIEWS: &[&str] =
    &["view", "azimuth", "elevation", "eye", "target", "up", "fov", "ortho", "camera", "turntable"];

/// Checks options of sheets that the parser cannot check.
pub fn check(args: &RenderArgs, kind: Kind) -> Result<(), Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let drawing = &args.drawing;
    if kind == Kind::Drawing(DrawingFormat::GeoJson)
        && (drawing.sheet.is_some() || drawing.callouts)
    {
        let option = if drawing.callouts { "callouts" } else { "sheet" };
        return usage(format!("--{option}: GeoJSON has no paper; write a file for each --view"));
    }
    if drawing.sheet.is_none() {
        return Ok(());
    }
    let given = |id: &&&str| args.given.iter().any(|g| g == *id);
    if let Some(id) = OF_VIEWS.iter().find(given) {
        return usage(format!(
            "--{id}: --sheet has its own views, which --views names; leave one of the two out"
        ));
    }
    let views = &args.drawing.views;
    if let Some(twice) = repeated(views) {
        return usage(format!("--views: {twice} is given twice; each view has one place"));
    }
    let details = args.drawing.detail.iter();
    let shown = |view: &NamedView| of_sheet(args).contains(view);
    if let Some(missing) = details.clone().filter_map(|d| d.view).find(|v| !shown(v)) {
        return usage(format!("--detail: the sheet has no view `{missing}`; --views names them"));
    }
    let sections = args.section.views().map(|s| s.0);
    let letters: Vec<&str> = sections.chain(details.map(|d| d.letter.as_str())).collect();
    match repeated(&letters) {
        Some(twice) => usage(format!("--section, --detail: the letter {twice} is given twice")),
        None => Ok(()),
    }
}

/// Returns the first that is equal to one before it.
fn repeated<T: PartialEq>(all: &[T]) -> Option<&T> {
    all.iter().enumerate().find(|(i, one)| all[..*i].contains(one)).map(|(_, one)| one)
}

/// Returns the principal views.
fn of_sheet(args: &RenderArgs) -> &[NamedView] {
    if args.drawing.views.is_empty() { VIEWS } else { &args.drawing.views }
}

/// A view that is to be drawn.
pub struct Shot {
    /// Its part on a sheet; `None` without one.
    pub kind: Option<ViewKind>,
    /// Camera of the view.
    pub camera: Camera,
}

impl Shot {
    /// Creates a view of a kind.
    pub fn new(kind: Option<ViewKind>, camera: Camera) -> Self {
        Self { kind, camera }
    }

    /// Returns the part of a scene that a section leaves, and its memory, or `None` for other views. Adds warnings to
    /// the notes.
    pub fn cut(
        &self,
        args: &RenderArgs,
        scene: &Scene,
        notes: &mut Vec<String>,
    ) -> Result<Option<(Section, Charge)>, Failure> {
        let Some(ViewKind::Section { letter, plane }) = &self.kind else { return Ok(None) };
        let bytes = scene.bytes().saturating_add(scene.bytes_of_instances());
        let charge = args.running.work.charge("sections of the model", bytes);
        let charge = charge.map_err(|e| Failure::of_library(&e))?;
        let cut = args.section.cut(scene, &[*plane])?;
        if cut.scene.triangle_count() == 0 {
            notes.push(format!("section {letter} leaves nothing of the model"));
        }
        if cut.open_cuts > 0 {
            let cuts = agreeing(cut.open_cuts, UNCAPPED);
            notes.push(format!("section {letter}: {cuts}"));
        }
        Ok(Some((cut, charge)))
    }
}

/// Returns the views of a sheet except its details: parallel, with one target, so that they are aligned.
pub fn shots(args: &RenderArgs, scene: &Scene) -> Result<Vec<Shot>, Failure> {
    let sphere = scene.bounding_sphere();
    let target = fit::center(scene).or(sphere.map(|s| s.center)).unwrap_or(DVec3::ZERO);
    let radius = sphere.map_or(1.0, |s| s.radius).max(target.abs().max_element() * 1e-9).max(1e-30);
    let reach = radius * 2.5;
    let camera = |to_eye: DVec3, up: DVec3| Camera {
        eye: target + to_eye * reach,
        target,
        up,
        projection: Projection::Orthographic { height: 2.0 * radius * 1.05 },
        near: reach - 1.2 * radius,
        far: reach + 1.2 * radius,
    };
    let principal = of_sheet(args).iter().map(|view| {
        let direction = view.direction(scene.up_axis);
        Shot::new(Some(ViewKind::Principal(*view)), camera(direction.to_eye(), direction.up()))
    });
    let sections = args.section.views().map(|(letter, plane)| {
        let (to_eye, up) = against(&plane, scene.up_axis);
        let kind = ViewKind::Section { letter: letter.to_owned(), plane };
        Shot::new(Some(kind), camera(to_eye, up))
    });
    Ok(principal.chain(sections).collect())
}

/// Lines of sight nearer to the up axis than this sine have no up of their own.
const ALONG_UP: f64 = 1e-6;

/// Returns the direction to an eye that looks at a plane from outside, and its up direction.
fn against(plane: &Plane, up_axis: UpAxis) -> (DVec3, DVec3) {
    // Planes without a direction are refused as they are read.
    let to_eye = -plane.normal.normalize_or(DVec3::Z);
    let up = up_axis.up().reject_from_normalized(to_eye);
    if up.length() > ALONG_UP {
        return (to_eye, up.normalize());
    }
    let above = to_eye.dot(up_axis.up()) > 0.0;
    let view = if above { NamedView::Top } else { NamedView::Bottom };
    (to_eye, view.direction(up_axis).up())
}

/// Adds the details to the views that they are parts of.
pub fn add_details(
    args: &RenderArgs,
    shown: &mut Vec<Shown>,
    notes: &mut Vec<String>,
) -> Result<(), Failure> {
    for spec in &args.drawing.detail {
        match detail(spec, shown)? {
            Some(detail) => shown.push(detail),
            None => notes.push(format!(
                "detail {}: no view shows anything within {} of {}, {}, {}; it is left out",
                spec.letter, spec.radius, spec.center.x, spec.center.y, spec.center.z
            )),
        }
    }
    Ok(())
}

/// Returns a detail of the view that it names, or that shows most within its circle; `None` if that is
/// nothing.
fn detail(spec: &DetailSpec, shown: &[Shown]) -> Result<Option<Shown>, Failure> {
    let mut best: Option<(f64, Shown)> = None;
    for (of, view) in shown.iter().enumerate() {
        let Some(ViewKind::Principal(side)) = view.kind else { continue };
        if spec.view.map_or(side == NamedView::Iso, |wanted| wanted != side) {
            continue;
        }
        let plane = PicturePlane::of_camera(&view.camera, 1.0).map_err(super::usage)?;
        let center = view.breaks.drawn_at(plane.plane_from_world(spec.center).at);
        let (letter, scale) = (spec.letter.clone(), spec.scale);
        let detail = Detail { letter, of, center, radius: spec.radius, scale };
        let drawing = detail.cut(&view.drawing).map_err(super::usage)?;
        let length = seen(&drawing);
        if length > best.as_ref().map_or(0.0, |b| b.0) {
            let kind = Some(ViewKind::Detail(detail));
            let breaks = view.breaks.clone();
            best = Some((length, Shown { kind, camera: view.camera, drawing, breaks }));
        }
    }
    Ok(best.map(|b| b.1))
}

/// Returns the total length of a drawing's visible lines and of its areas' borders.
fn seen(drawing: &Drawing) -> f64 {
    let borders = drawing.regions.iter().flat_map(|r| &r.rings);
    let border = |ring: &Vec<_>| durer::paper::dashes::length(ring, true);
    drawing.length(Line::is_visible) + borders.map(border).sum::<f64>()
}
