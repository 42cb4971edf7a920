//! `durer render`.

mod cells;
mod check;
mod idle;
mod jobs;
mod scene_options;
mod streamed;

use crate::compare;
use crate::drawing::{self, Annotated, Subject};
use crate::explode;
use crate::failure::Failure;
use crate::film::{Film, Sink};
use crate::input;
use crate::messages::Messages;
use crate::output::{self, Target};
use crate::render_args::RenderArgs;
use crate::report::noticed::Noticed;
use crate::report::{Failed, Growing, ModelReport, PictureReport};
use crate::section;
use crate::staging;
use crate::values::{Algorithm, Size};
use crate::watch;
use cells::shots;
pub use cells::{Cell, assemble};
pub use check::check;
use check::{algorithm, check_size, check_tile, wanted};
use durer::math::{DVec2, Vec4};
use durer::pipeline;
use durer::scene::{AlphaMode, Camera, Material, Scene};
use durer::target::Framebuffer;
use durer::view::components::{Component, components};
use durer::view::objects::divided;
use durer::visibility::object::SceneOrientation;
use durer::work::{Charge, Work};
use durer_formats::wording::counted;
use durer_formats::{Model, png};
use jobs::{Job, Picture, plan};
use scene_options::render_options;
use std::time::Instant;

/// Renders all models, each to its pictures.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let args = &sized(args, DVec2::ONE);
    check(args)?;
    let jobs = plan(args)?;
    let pictures = jobs.iter().map(|job| job.pictures.len() as u64).sum();
    let messages = Messages::new(&args.running, pictures);
    idle::warn(args, &messages);
    let mut report = Growing::new(args.json);
    let ended = render_all(args, &jobs, &messages, &mut report);
    drop(messages);
    let printed = report.print(start.elapsed().as_secs_f64());
    ended.and(printed)
}

/// Renders models one after the other, up to the first failure unless failures are skipped.
fn render_all(
    args: &RenderArgs,
    jobs: &[Job],
    messages: &Messages,
    report: &mut Growing,
) -> Result<(), Failure> {
    let (mut done, mut failed) = (0, 0);
    for job in jobs {
        let Err(failure) = render_model(args, job, messages, report) else {
            done += 1;
            if args.skip_failures {
                watch::done();
            }
            continue;
        };
        let error = failure.to_string();
        let skipped = args.skip_failures && matches!(failure, Failure::Data(_));
        if skipped {
            messages.error(&error);
            failed += 1;
        }
        report.failed(&Failed { model: job.model.display().to_string(), error });
        if !skipped {
            return Err(failure);
        }
        if !args.running.work.go_on() {
            break;
        }
    }
    match (done, failed) {
        (_, 0) => Ok(()),
        (1.., _) => Err(Failure::Partial),
        _ => Err(Failure::Data("no model could be rendered".to_owned())),
    }
}

/// Turns faces that are turned inwards, or against their neighbours.
fn orient(
    args: &RenderArgs,
    scene: &mut Scene,
    name: &str,
    messages: &Messages,
) -> Result<(), Failure> {
    let failed = |e: durer::Error| Failure::Data(format!("{name}: {e}"));
    let bytes = 160 * scene.triangle_count();
    let _faces = args.running.work.charge("edges of the model", bytes).map_err(failed)?;
    let found = SceneOrientation::of(scene).map_err(failed)?;
    found.apply(scene);
    let (bodies, faces) = (found.inside_out, found.flipped);
    let bodies = counted(bodies, "body inside out", "bodies inside out");
    let faces = counted(faces, "face", "faces");
    messages.detail(|| format!("{name}: {bodies} and {faces} turned"));
    Ok(())
}

/// Returns the options with both sides of the picture; an open one as in a picture of a given
/// shape.
fn sized(args: &RenderArgs, natural: DVec2) -> RenderArgs {
    let mut args = args.clone();
    args.picture.size = args.picture.sides.of_shape(natural);
    args
}

/// Reads a model and makes its pictures.
fn render_model(
    args: &RenderArgs,
    job: &Job,
    messages: &Messages,
    reports: &mut Growing,
) -> Result<(), Failure> {
    let name = input::display_name(job.model);
    messages.progress.stage(|| format!("reading {name}"));
    let start = Instant::now();
    // The model's part of the budget is released with it.
    let part = args.running.work.part();
    let reading = input::read_options(&args.reading, &part);
    let pieces = input::in_pieces(job.model, &reading).transpose()?;
    let has_pieces = pieces.is_some();
    if let Some(pieces) = pieces.filter(|p| streamed::suits(args, job, &*p.pieces)) {
        return streamed::render_model(args, job, pieces, messages, reports);
    }
    let model = input::read(job.model, &reading);
    let mut model = if has_pieces { model.map_err(streamed::hinted)? } else { model? };
    let read_seconds = start.elapsed().as_secs_f64();
    messages.warnings(&name, &model.warnings);
    let prepared = prepare(args, &mut model.scene, &name, &part, messages)?;
    messages.detail(|| {
        format!(
            "{name}: {}, {}, read in {read_seconds:.3} s",
            model.format,
            counted(model.scene.triangle_count(), "triangle", "triangles")
        )
    });
    let found = with_open_side(args, &name, &model.scene)?;
    let args = found.as_ref().unwrap_or(args);
    let mut noticed = Noticed::default();
    let mut film = job.film();
    let kind = wanted(args).kind;
    let is_drawing = drawing::is_wanted(args, kind);
    let annotated = match is_drawing {
        true => Annotated::new(&args.drawing.annotations, &model.scene, args.drawing.weld)
            .map_err(|failure| with_file(&name, failure))?,
        false => None,
    };
    let subject = Subject {
        scene: &model.scene,
        name: &job.stem,
        format: &model.format,
        cap_material: prepared.cap_material,
        components: prepared.components,
        annotated,
    };
    for picture in &job.pictures {
        messages.progress.stage(|| format!("rendering {name}"));
        let mut sink = film.as_mut().map_or(Sink::File(&picture.color), Sink::Film);
        let report = if is_drawing {
            drawing::render(args, &subject, picture.frame, &mut sink, kind)
        } else {
            render_picture(args, &model.scene, picture, &mut sink)
        };
        let made = report
            .map_err(|failure| input::blamed(&name, &model.scene, with_file(&name, failure)))?;
        report_picture(&name, made, &mut noticed, messages, reports);
    }
    film.map_or(Ok(()), Film::finish)?;
    noticed.warn(&name, &mut model, messages);
    report_model(job, model, read_seconds, reports);
    Ok(())
}

/// Returns the options with the side of the picture that was left open; `None` if none was.
pub fn with_open_side(
    args: &RenderArgs,
    name: &str,
    scene: &Scene,
) -> Result<Option<RenderArgs>, Failure> {
    if !args.picture.sides.is_open() {
        return Ok(None);
    }
    let shape = drawing::shape(args, scene);
    let found = sized(args, shape.map_err(|f| input::blamed(name, scene, f))?);
    check_tile(&found)?;
    check_size(&found)?;
    Ok(Some(found))
}

/// Facts about a scene after the options have changed it.
pub struct Prepared {
    /// The kinds of its parts, if they are to be numbered.
    pub components: Vec<Component>,
    /// The material of the caps, if it was cut.
    pub cap_material: Option<usize>,
    /// Memory of copies that were made.
    _copies: Option<Charge>,
}

impl Prepared {
    /// Returns the data of a scene that no option changes.
    pub fn unchanged() -> Self {
        Self { components: Vec::new(), cap_material: None, _copies: None }
    }
}

/// Applies the axis, materials, directions, cuts and places of the options to a scene.
pub fn prepare(
    args: &RenderArgs,
    scene: &mut Scene,
    name: &str,
    work: &Work,
    messages: &Messages,
) -> Result<Prepared, Failure> {
    if let Some(axis) = args.view.up_axis {
        scene.up_axis = axis.into();
    }
    if let Some(color) = args.look.color {
        scene.give_material(colored(color));
    }
    staging::give_materials(&args.stage, args.look.color, scene);
    let assembles = args.drawing.callouts || args.explode.explode.is_some();
    let charged = work.charge("copies of the model", bytes_of_copies(args, scene, assembles));
    let copies = charged.map_err(|e| Failure::of_library(&e).named(name))?;
    if let Some(divided) = assembles.then(|| divided(scene)).flatten() {
        *scene = divided;
    }
    if args.look.orient {
        orient(args, scene, name, messages)?;
    }
    // Instances that were cut no longer share meshes.
    let components = if args.drawing.callouts { components(scene) } else { Vec::new() };
    let cap_material = section::apply(&args.section, scene, name, messages)?;
    explode::apply(&args.explode, scene).map_err(|f| with_file(name, f))?;
    Ok(Prepared { components, cap_material, _copies: Some(copies) })
}

/// Reports a picture and, if nothing of the model is visible in it, the reason.
fn report_picture(
    name: &str,
    (report, unseen): (PictureReport, Option<String>),
    noticed: &mut Noticed,
    messages: &Messages,
    reports: &mut Growing,
) {
    if let Some(why) = unseen {
        messages.warning(name, &why);
        noticed.unseen.get_or_insert(why);
    }
    warn_of_differing(name, &report, messages);
    messages.detail(|| describe(&report));
    messages.progress.advance();
    noticed.add(&report);
    reports.picture(&report);
}

fn report_model(job: &Job, model: Model, read_seconds: f64, reports: &mut Growing) {
    reports.model(&ModelReport {
        model: input::given_name(job.model),
        format: model.format,
        read_seconds,
        warnings: model.warnings.iter().map(ToString::to_string).collect(),
    });
}

/// Returns the default material in another colour.
fn colored(color: Vec4) -> Material {
    let alpha_mode = if color.w < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque };
    Material { base_color: color, alpha_mode, ..Material::default() }
}

/// Warns of algorithms that find other surfaces than the z-buffer at some pixels; all should find the same.
fn warn_of_differing(name: &str, report: &PictureReport, messages: &Messages) {
    for c in report.compared.iter().filter(|c| c.differing_pixels > 0) {
        let pixels = counted(c.differing_pixels, "pixel", "pixels");
        let algorithm = c.algorithm;
        messages.warning(name, format!("{algorithm} differs from the z-buffer at {pixels}"));
    }
}

fn describe(report: &PictureReport) -> String {
    if let Some(drawing) = &report.drawing {
        return format!("{}: {}", report.files.join(", "), drawing.summary());
    }
    format!(
        "{}: {}x{}, {} drawn; geometry {:.4} s, raster {:.4} s, encode {:.4} s",
        report.files.join(", "),
        report.width,
        report.height,
        counted(report.triangles.drawn, "triangle", "triangles"),
        report.geometry_seconds,
        report.raster_seconds,
        report.encode_seconds
    )
}

/// Adds the file's name to a failure, also if the data do not fit the options, such as a camera that the file does not
/// have.
fn with_file(name: &str, failure: Failure) -> Failure {
    match failure {
        Failure::Data(message) if message.starts_with("--") => {
            Failure::Data(format!("{name}: {message}"))
        }
        other => other.named(name),
    }
}

/// Returns the bytes of the copies that sections and assemblies make of a model.
fn bytes_of_copies(args: &RenderArgs, scene: &Scene, assembles: bool) -> u64 {
    let cuts = args.section.section.iter().any(|section| section.letter.is_none());
    let of_cuts = if cuts { scene.bytes().saturating_add(scene.bytes_of_instances()) } else { 0 };
    let moved = args.explode.explode.is_some();
    let times = u64::from(assembles) + u64::from(moved);
    of_cuts.saturating_add(scene.bytes().saturating_mul(times))
}

/// Renders one picture and writes its files; if nothing of the model is visible, returns the reason.
fn render_picture(
    args: &RenderArgs,
    scene: &Scene,
    picture: &Picture,
    sink: &mut Sink,
) -> Result<(PictureReport, Option<String>), Failure> {
    let Size { width, height } = args.picture.size;
    let mut report = PictureReport { width, height, ..PictureReport::default() };
    let Shown { cells, unseen, .. } = render_cells(args, scene, picture.frame, &mut report)?;
    deliver(args, picture, cells, algorithm(args), &mut report, sink)?;
    Ok((report, unseen))
}

/// The cells of a picture, rendered.
pub struct Shown {
    /// Parts of the picture with their pixels.
    pub cells: Vec<(Cell, Framebuffer)>,
    /// The camera of each cell.
    pub cameras: Vec<Camera>,
    /// Reason why nothing of the model is visible, if nothing is.
    pub unseen: Option<String>,
}

/// Renders the cells of one picture.
pub fn render_cells(
    args: &RenderArgs,
    scene: &Scene,
    frame: Option<u32>,
    report: &mut PictureReport,
) -> Result<Shown, Failure> {
    let (mut cells, mut statuses, mut cameras) = (Vec::new(), Vec::new(), Vec::new());
    let staged = staging::staged(&args.stage, scene, &args.running.work)?;
    let model = scene;
    let framed = staged.as_ref().map_or(model, |s| &s.framed);
    let scene = staged.as_ref().map_or(model, |s| &s.whole);
    let algorithm = algorithm(args);
    for cell in shots(args, frame)? {
        let options = render_options(args, [model, framed, scene], &cell.shot, algorithm)?;
        report.cameras.push((&options.camera).into());
        cameras.push(options.camera);
        let mut framebuffer = match algorithm {
            Algorithm::Surfaces(_) => {
                let (framebuffer, stages) = pipeline::render(scene, &options).map_err(usage)?;
                report.add(&stages);
                framebuffer
            }
            Algorithm::Wireframe => compare::wireframe(scene, &options).map_err(usage)?,
            Algorithm::All => compare::sheet(scene, &options, report)?,
        };
        // A sheet has labels, and a floor is seen where the model is not.
        let shows_more = algorithm == Algorithm::All || staged.is_some();
        let status = if shows_more {
            pipeline::render(model, &options)
                .and_then(|(alone, _)| pipeline::status(model, &options, &alone))
        } else {
            pipeline::status(model, &options, &framebuffer)
        };
        statuses.push(status.map_err(usage)?);
        staging::draw_edges(&args.stage, model, &options, &mut framebuffer)?;
        cells.push((cell, framebuffer));
    }
    let unseen = report.set_status(&statuses);
    Ok(Shown { cells, cameras, unseen })
}

/// Combines the cells of a picture and writes its files.
fn deliver(
    args: &RenderArgs,
    picture: &Picture,
    cells: Vec<(Cell, Framebuffer)>,
    algorithm: Algorithm,
    report: &mut PictureReport,
    sink: &mut Sink,
) -> Result<(), Failure> {
    report.algorithm = match algorithm {
        Algorithm::Surfaces(method) => method.name().to_owned(),
        Algorithm::Wireframe => durer::visibility::wireframe::INFO.name.to_owned(),
        Algorithm::All => "all".to_owned(),
    };
    let framebuffer = assemble(cells, args).map_err(usage)?;
    (report.width, report.height) = (framebuffer.width(), framebuffer.height());
    let start = Instant::now();
    report.files = write_planes(args, picture, &framebuffer)?;
    // The picture is written last: if it is new, so are the other files.
    let format = wanted(args).kind.picture();
    report.flattened = sink.put(&framebuffer.color, format, &args.picture.encoding)?;
    report.files.push(sink.name());
    report.encode_seconds = start.elapsed().as_secs_f64();
    Ok(())
}

/// Returns the failure for options that the renderer refuses.
fn usage(e: durer::Error) -> Failure {
    Failure::of_library(&e)
}

/// Writes the planes beside colour that are requested; returns the names of the files.
fn write_planes(
    args: &RenderArgs,
    picture: &Picture,
    planes: &Framebuffer,
) -> Result<Vec<String>, Failure> {
    let compression = args.picture.encoding.compression.into();
    let mut files = Vec::new();
    let mut done = |target: &Target| files.push(target.to_string());
    if let (Some(target), Some(items)) = (&picture.item, &planes.item) {
        output::deliver(target, &items.work(), |out| png::write_items(out, items, compression))?;
        done(target);
    }
    if let (Some(target), Some(depth)) = (&picture.depth, &planes.depth) {
        output::deliver(target, &depth.work(), |out| png::write_depth(out, depth, compression))?;
        done(target);
    }
    if let (Some(target), Some(normals)) = (&picture.normal, &planes.normal) {
        output::deliver(target, &normals.work(), |out| {
            png::write_normals(out, normals, compression)
        })?;
        done(target);
    }
    Ok(files)
}
