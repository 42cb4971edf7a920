//! Pictures of models that are larger than memory, read in pieces and never held as a whole.
//!
//! The file is read three times: for the camera, to find the visible items, and to read the visible triangles, which
//! form a scene.

use super::check::{algorithm, asks_for_rays};
use super::jobs::{Job, Picture};
use super::scene_options::picture_options;
use super::{RenderArgs, colored, deliver, report_model, report_picture, shots, usage, with_file};
use crate::camera::{self, Shot, Sights};
use crate::drawing;
use crate::failure::Failure;
use crate::film::Sink;
use crate::input::{self, InPieces};
use crate::messages::Messages;
use crate::options::Shadows;
use crate::report::noticed::Noticed;
use crate::report::{Growing, PictureReport};
use crate::staging;
use crate::values::Algorithm;
use durer::math::DVec3;
use durer::pipeline::{self, RenderOptions, SurfaceMethod, SurveyResult};
use durer::scene::{Camera, NamedCamera, Projection, Scene, UpAxis};
use durer::target::Framebuffer;
use durer::view::fit;
use durer::view::projection::{EndsOfPieces, FitOptions, FitPieces, ViewDirection};
use durer_formats::wording::counted;
use durer_formats::{Facts, Pieces};
use std::time::Instant;

/// Returns whether a picture needs the whole model at once.
fn needs_whole(args: &RenderArgs) -> bool {
    let requested = &args.picture.algorithm;
    let drawing = &args.drawing;
    drawing::is_wanted(args, super::wanted(args).kind)
        || drawing.callouts
        || args.explode.explode.is_some()
        || !args.section.section.is_empty()
        || args.stage.needs_model()
        || args.picture.turntable.is_some()
        || args.picture.sides.is_open()
        || args.look.orient
        || args.look.color.is_some_and(|color| color.w < 1.0)
        || !matches!(requested, None | Some(Algorithm::Surfaces(SurfaceMethod::ZBuffer)))
        || algorithm(args) != Algorithm::Surfaces(SurfaceMethod::ZBuffer)
        || !matches!(args.look.shadows, Shadows::None)
        || asks_for_rays(args).is_some()
}

/// Adds to an error of the budget that other pictures need less.
pub fn hinted(failure: Failure) -> Failure {
    match failure {
        Failure::Data(message) if message.contains("--max-memory") => Failure::Data(
            message
                + "; a still picture of a given size by the z-buffer, without shadows, edges or a floor, is made in \
                   pieces and needs less",
        ),
        other => other,
    }
}

/// Returns whether pictures of a model can be made from its pieces.
pub fn suits(args: &RenderArgs, job: &Job, pieces: &dyn Pieces) -> bool {
    let camera = Camera {
        eye: DVec3::Z,
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 1.0 },
        near: 0.0,
        far: 1.0,
    };
    let method = Algorithm::Surfaces(SurfaceMethod::ZBuffer);
    let of_pieces = job.pictures.iter().all(|picture| {
        let shot = Shot::of(&args.picture, picture.frame);
        let options = picture_options(args, camera, &shot, method);
        pipeline::check_pieces(&options, pieces.has_normals()).is_ok()
    });
    of_pieces && !needs_whole(args)
}

/// Makes the pictures of a model in pieces.
pub fn render_model(
    args: &RenderArgs,
    job: &Job,
    pieces: InPieces,
    messages: &Messages,
    reports: &mut Growing,
) -> Result<(), Failure> {
    let name = input::display_name(job.model);
    let start = Instant::now();
    let mut noticed = Noticed::default();
    let mut streamed = Streamed { args, pieces, name: &name, messages, facts: None };
    for picture in &job.pictures {
        let mut sink = Sink::File(&picture.color);
        let made = streamed.render_picture(picture, &mut sink);
        report_picture(
            &name,
            made.map_err(|f| with_file(&name, f))?,
            &mut noticed,
            messages,
            reports,
        );
    }
    let mut model = streamed.facts()?.model;
    noticed.warn(&name, &mut model, messages);
    report_model(job, model, start.elapsed().as_secs_f64(), reports);
    Ok(())
}

/// A model in pieces, to be rendered.
struct Streamed<'a> {
    args: &'a RenderArgs,
    pieces: InPieces,
    name: &'a str,
    messages: &'a Messages,
    facts: Option<Facts>,
}

impl Streamed<'_> {
    /// Returns the facts about the model; its warnings are reported the first time.
    fn facts(&mut self) -> Result<Facts, Failure> {
        if let Some(facts) = &self.facts {
            return Ok(facts.clone());
        }
        let facts = self.pieces.facts()?;
        self.messages.warnings(self.name, &facts.model.warnings);
        self.messages.detail(|| {
            let Facts { model, triangles, .. } = &facts;
            let triangles = counted(*triangles, "triangle", "triangles");
            format!("{}: {}, {triangles}, read in pieces", self.name, model.format)
        });
        Ok(self.facts.insert(facts).clone())
    }

    /// Renders one picture and writes its files; if nothing of the model is visible, returns the reason.
    fn render_picture(
        &mut self,
        picture: &Picture,
        sink: &mut Sink,
    ) -> Result<(PictureReport, Option<String>), Failure> {
        let args = self.args;
        let mut report = PictureReport::default();
        let (mut cells, mut statuses) = (Vec::new(), Vec::new());
        let method = Algorithm::Surfaces(SurfaceMethod::ZBuffer);
        for cell in shots(args, picture.frame)? {
            let camera = camera::camera_by(&args.view, self, &cell.shot)?;
            report.cameras.push((&camera).into());
            let options = picture_options(args, camera, &cell.shot, method);
            let seen = self.survey(&options, &mut report)?;
            let (framebuffer, status) = self.render_seen(&seen, &options, &mut report)?;
            statuses.push(status);
            cells.push((cell, framebuffer));
        }
        let unseen = report.set_status(&statuses);
        deliver(args, picture, cells, method, &mut report, sink)?;
        Ok((report, unseen))
    }

    /// Finds the visible items.
    fn survey(
        &mut self,
        options: &RenderOptions,
        report: &mut PictureReport,
    ) -> Result<SurveyResult, Failure> {
        let facts = self.facts()?;
        let (all, mut done) = (facts.triangles + facts.points, 0);
        let (messages, name) = (self.messages, self.name);
        let start = Instant::now();
        let mut survey = pipeline::survey(options).map_err(usage)?;
        let args = self.args;
        let passed = self.pieces.pieces.primitives(&mut |piece| {
            let percent = 100 * done / all.max(1);
            report_pass(messages, name, 2, &format!("finding the visible triangles, {percent} %"));
            done += piece.meshes.iter().map(|mesh| mesh.primitive_count() as u64).sum::<u64>();
            dress(args, piece);
            survey.add(piece)
        });
        passed.map_err(|e| self.pieces.failure(&e))?;
        report.geometry_seconds += start.elapsed().as_secs_f64();
        survey.finish().map_err(usage)
    }

    /// Renders the visible items.
    fn render_seen(
        &mut self,
        seen: &SurveyResult,
        options: &RenderOptions,
        report: &mut PictureReport,
    ) -> Result<(Framebuffer, pipeline::Status), Failure> {
        report_pass(self.messages, self.name, 3, "reading the visible triangles");
        let only = self.pieces.pieces.only(&seen.items);
        let (mut scene, _charge) = only.map_err(|e| self.pieces.failure(&e))?;
        dress(self.args, &mut scene);
        let triangles = self.facts()?.triangles;
        let (framebuffer, stages) =
            pipeline::render_seen(&scene, triangles, seen, options).map_err(usage)?;
        report.add(&stages);
        let status = if seen.items.is_empty() {
            let pieces = &mut self.pieces.pieces;
            let status = pipeline::status_of_pieces(options, |visit| {
                pieces.primitives(&mut |piece| visit(piece))
            });
            status.map_err(|e| self.pieces.failure(&e))?
        } else {
            pipeline::status(&scene, options, &framebuffer).map_err(usage)?
        };
        Ok((framebuffer, status))
    }

    /// Visits all vertices, for the camera.
    fn vertices(&mut self, mut visit: impl FnMut(&Scene)) -> Result<(), Failure> {
        report_pass(self.messages, self.name, 1, "reading for the view");
        let passed = self.pieces.pieces.vertices(&mut |piece| {
            visit(piece);
            Ok(())
        });
        passed.map_err(|e| self.pieces.failure(&e))
    }
}

/// Shows which pass over the file is being made.
fn report_pass(messages: &Messages, name: &str, number: u32, what: &str) {
    messages.progress.stage(|| format!("{name}: pass {number} of 3, {what}"));
}

/// Assigns the requested materials to a scene.
fn dress(args: &RenderArgs, scene: &mut Scene) {
    if let Some(color) = args.look.color {
        scene.give_material(colored(color));
    }
    staging::give_materials(&args.stage, args.look.color, scene);
}

impl Sights for Streamed<'_> {
    fn up_axis(&self) -> UpAxis {
        self.args.view.up_axis.map_or(self.pieces.pieces.up_axis(), Into::into)
    }

    fn cameras(&self) -> &[NamedCamera] {
        &[]
    }

    fn center(&mut self) -> Result<DVec3, Failure> {
        let mut ends = EndsOfPieces::new(DVec3::X);
        self.vertices(|piece| ends.add(piece))?;
        Ok(ends.bounds().map_or(DVec3::ZERO, |bounds| bounds.center()))
    }

    fn depth_range(&mut self, camera: &Camera) -> Result<(f64, f64), Failure> {
        let mut ends = EndsOfPieces::new(fit::back(camera));
        self.vertices(|piece| ends.add(piece))?;
        Ok(fit::depth_range_of(camera, ends.ends()))
    }

    /// Returns a still one.
    fn fitted(
        &mut self,
        direction: &ViewDirection,
        options: &FitOptions,
        _turning: bool,
    ) -> Result<Camera, Failure> {
        let data = |e: durer::Error| Failure::Data(e.to_string());
        let mut fit = FitPieces::new(direction, options).map_err(data)?;
        self.vertices(|piece| fit.add(piece))?;
        fit.camera().map_err(data)
    }
}
