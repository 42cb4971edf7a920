//! The command's options over values in memory, for bindings to other languages.
//!
//! Options are arguments as on the command line, without the inputs and the output. Nothing is printed; files are read
//! only if an option names one.

use crate::camera::{self, Shot};
use crate::draw::{self, DrawArgs};
use crate::drawing::{self, Annotated, Made, Subject};
use crate::explain;
use crate::kind::Kind;
use crate::messages::Messages;
use crate::plot::{self, PlotArgs, Surface};
use crate::render::{self, Prepared, Shown, assemble};
use crate::render_args::RenderArgs;
use crate::report::PictureReport;
use crate::staging::Look;
use crate::tiles::{self, TilesArgs};
use crate::{input, watch};
use clap::Args;
use clap::parser::ValueSource;
use durer::explain::{Frame, Language, Lesson};
use durer::math::DVec2;
use durer::scene::{Camera, Scene};
use durer::target::drawing::Drawing;
use durer::target::{Framebuffer, Pixels};
use durer_formats::drawing::DrawingFormat;
use durer_formats::height_map::HeightMap;
use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

pub use crate::failure::Failure;
pub use crate::resources::Folder;

/// A model in memory.
#[derive(Debug, Clone, Copy)]
pub struct InMemory<'a> {
    /// Meshes and materials.
    pub scene: &'a Scene,
    /// Title of its drawings.
    pub name: &'a str,
    /// Name of the format that it was read from, which determines its unit; empty if there is none.
    pub format: &'a str,
}

/// A picture and the camera that it was seen from.
#[derive(Debug)]
pub struct Rendered {
    /// Colours, and the planes that were requested.
    pub planes: Framebuffer,
    /// The camera; `None` of a picture that was painted from a drawing.
    pub camera: Option<Camera>,
    /// Reason why nothing of the model is visible, if nothing is.
    pub unseen: Option<String>,
}

/// Parsers that have been built, by the name of their command.
static PARSERS: Mutex<Option<HashMap<&'static str, clap::Command>>> = Mutex::new(None);

/// Parses arguments; returns the options and the names of the given ones.
fn parse<A: Args>(
    name: &'static str,
    words: impl IntoIterator<Item = String>,
) -> Result<(A, Vec<String>), Failure> {
    let usage = |e: clap::Error| Failure::Usage(message(&e.to_string()));
    let mut parsers = PARSERS.lock().unwrap_or_else(PoisonError::into_inner);
    let parser = parsers
        .get_or_insert_default()
        .entry(name)
        .or_insert_with(|| A::augment_args(clap::Command::new(name).disable_help_flag(true)));
    let line = std::iter::once(name.to_owned()).chain(words);
    let matches = parser.try_get_matches_from_mut(line).map_err(usage)?;
    drop(parsers);
    let by_hand =
        |id: &&clap::Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
    let given = matches.ids().filter(by_hand).map(ToString::to_string).collect();
    Ok((A::from_arg_matches(&matches).map_err(usage)?, given))
}

/// Returns the first paragraphs of the parser's message, without its advice for the command line.
fn message(text: &str) -> String {
    let text = text.split("\n\nUsage:").next().unwrap_or_default();
    let text = text.split("\n\nFor more").next().unwrap_or_default();
    let text = text.trim().trim_start_matches("error: ");
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join("; ")
}

/// Parses the options of `render` for an output of a format, and checks them.
fn render_args(options: &[String], format: &str) -> Result<RenderArgs, Failure> {
    let fixed = ["model".to_owned(), format!("--output=picture.{format}"), "--quiet".to_owned()];
    let words = fixed.into_iter().chain(options.iter().cloned());
    let (mut args, given): (RenderArgs, _) = parse("render", words)?;
    if args.picture.turntable.is_some() {
        let message = "--turntable: one picture is made at a time; give the azimuth of each";
        return Err(Failure::Usage(message.to_owned()));
    }
    args.given = given;
    args.running.work = watch::work(&args.running);
    args.picture.size = args.picture.sides.of_shape(DVec2::ONE);
    render::check(&args)?;
    Ok(args)
}

/// A scene as the options want it.
struct Ready<'a> {
    args: RenderArgs,
    scene: Cow<'a, Scene>,
    prepared: Prepared,
}

/// Changes a scene by the options; copies it only if they change it.
fn ready<'a>(model: &InMemory<'a>, args: RenderArgs) -> Result<Ready<'a>, Failure> {
    let messages = Messages::new(&args.running, 1);
    let mut scene = Cow::Borrowed(model.scene);
    let prepared = if changes(&args) {
        render::prepare(&args, scene.to_mut(), model.name, &args.running.work, &messages)?
    } else {
        Prepared::unchanged()
    };
    let found = render::with_open_side(&args, model.name, &scene)?;
    Ok(Ready { args: found.unwrap_or(args), scene, prepared })
}

/// Returns whether options change the scene.
fn changes(args: &RenderArgs) -> bool {
    args.view.up_axis.is_some()
        || args.look.color.is_some()
        || args.look.orient
        || !matches!(args.stage.look, Look::Plain | Look::Studio)
        || args.drawing.callouts
        || args.explode.explode.is_some()
        || !args.section.section.is_empty()
}

/// Adds the name of the model to a failure that its coordinates are to blame for.
fn blamed<T>(model: &InMemory, result: Result<T, Failure>) -> Result<T, Failure> {
    result.map_err(|failure| input::blamed(model.name, model.scene, failure))
}

/// Renders a picture with the options of `durer render`; `planes` are the planes (depth, item, normal) that the result
/// gets besides the colours.
///
/// # Errors
/// [`Failure::Usage`] for options that are wrong, others for a scene that cannot be shown by them.
pub fn render(
    options: &[String],
    model: &InMemory,
    planes: [bool; 3],
) -> Result<Rendered, Failure> {
    let mut words = options.to_vec();
    for (name, _) in ["depth", "item", "normal"].iter().zip(planes).filter(|(_, wanted)| *wanted) {
        words.push(format!("--{name}={name}.png"));
    }
    let ready = ready(model, render_args(&words, "png")?)?;
    let args = &ready.args;
    if drawing::is_wanted(args, Kind::PNG) {
        let Made { sheet, unseen, .. } = blamed(model, made(&ready, model, Kind::PNG))?;
        let color = drawing::paint(args, Kind::PNG, sheet)?;
        let planes = Framebuffer { color, ..Framebuffer::new(0, 0) };
        return Ok(Rendered { planes, camera: None, unseen });
    }
    let mut report = PictureReport::default();
    let shown = render::render_cells(args, &ready.scene, None, &mut report);
    let Shown { cells, cameras, unseen } = blamed(model, shown)?;
    let planes = assemble(cells, args).map_err(|e| Failure::of_library(&e))?;
    Ok(Rendered { planes, camera: cameras.first().copied(), unseen })
}

/// Returns the camera of a picture with the options of `durer render`, and the picture's width and height.
///
/// # Errors
/// As [`render`].
pub fn camera(options: &[String], model: &InMemory) -> Result<(Camera, [u32; 2]), Failure> {
    let ready = ready(model, render_args(options, "png")?)?;
    let size = ready.args.picture.size;
    let shot = Shot { view: None, size, turn: None };
    let camera = blamed(model, camera::camera(&ready.args.view, &ready.scene, &shot))?;
    Ok((camera, [size.width, size.height]))
}

fn made(ready: &Ready, model: &InMemory, kind: Kind) -> Result<Made, Failure> {
    let args = &ready.args;
    let annotated = Annotated::new(&args.drawing.annotations, &ready.scene, args.drawing.weld)?;
    let subject = Subject {
        scene: &ready.scene,
        name: model.name,
        format: model.format,
        cap_material: ready.prepared.cap_material,
        components: ready.prepared.components.clone(),
        annotated,
    };
    drawing::make(args, &subject, None, kind)
}

/// Draws a model with the options of `durer render`, and returns the file in a format of drawings, by its suffix.
///
/// # Errors
/// As [`render`]; also [`Failure::Usage`] for a format that is not a drawing's.
pub fn draw(options: &[String], model: &InMemory, suffix: &str) -> Result<Vec<u8>, Failure> {
    let format = drawing_format(suffix)?;
    let ready = ready(model, render_args(options, suffix)?)?;
    let made = blamed(model, made(&ready, model, Kind::Drawing(format)))?;
    let mut bytes = Vec::new();
    drawing::encode(&ready.args, &mut bytes, format, &made.sheet, &made.drawings)
        .map_err(|e| Failure::Data(e.to_string()))?;
    Ok(bytes)
}

fn drawing_format(suffix: &str) -> Result<DrawingFormat, Failure> {
    DrawingFormat::of_suffix(suffix).ok_or_else(|| {
        let names: Vec<_> = DrawingFormat::ALL.iter().map(|f| f.name()).collect();
        Failure::Usage(format!(
            "`{suffix}` is not a format of drawings; there are {}",
            names.join(", ")
        ))
    })
}

/// Draws a model as [`draw`] for GeoJSON does, and returns the lines and regions of the plane.
///
/// # Errors
/// As [`draw`].
pub fn lines(options: &[String], model: &InMemory) -> Result<Drawing, Failure> {
    let ready = ready(model, render_args(options, "geojson")?)?;
    let mut made = blamed(model, made(&ready, model, Kind::Drawing(DrawingFormat::GeoJson)))?;
    Ok(if made.drawings.is_empty() { Drawing::default() } else { made.drawings.swap_remove(0) })
}

/// Plots a height map with the options of `durer plot`, and returns the file in a format of drawings, by its suffix.
///
/// # Errors
/// [`Failure::Usage`] for options that are wrong, [`Failure::Data`] for heights that cannot be plotted.
pub fn plot(options: &[String], map: HeightMap, suffix: &str) -> Result<Vec<u8>, Failure> {
    let format = drawing_format(suffix)?;
    let (args, plot) = plotted(options, map, suffix)?;
    let mut bytes = Vec::new();
    plot::write(&mut bytes, plot::Format::Drawing(format), plot, &args)
        .map_err(|e| Failure::Data(e.to_string()))?;
    Ok(bytes)
}

/// Plots a height map with the options of `durer plot`, as pixels.
///
/// # Errors
/// As [`plot`].
pub fn plot_pixels(options: &[String], map: HeightMap) -> Result<Pixels<[u8; 4]>, Failure> {
    let (args, plot) = plotted(options, map, "png")?;
    plot::paint(plot, &args).map_err(|e| Failure::of_library(&e))
}

fn plotted(
    options: &[String],
    map: HeightMap,
    suffix: &str,
) -> Result<(PlotArgs, durer::plot::Plot), Failure> {
    let fixed = ["heights".to_owned(), format!("--output=plot.{suffix}"), "--quiet".to_owned()];
    let words = fixed.into_iter().chain(options.iter().cloned());
    let (mut args, _): (PlotArgs, _) = parse("plot", words)?;
    args.running.work = watch::work(&args.running);
    let surface = Surface::of_map(map, "heights".to_owned(), &args)?;
    let (plot, _) = plot::plot_of(&args, &surface)?;
    Ok((args, plot))
}

/// Draws an SVG, or layers of a map, with the arguments of `durer draw`, whose inputs name the layers in order.
///
/// # Errors
/// [`Failure::Usage`] for options that are wrong, [`Failure::Data`] for bytes that cannot be drawn.
pub fn draw_layers(words: &[String], layers: Vec<Vec<u8>>) -> Result<Pixels<[u8; 4]>, Failure> {
    let fixed = ["--output=picture.png".to_owned(), "--quiet".to_owned()];
    let (mut args, _): (DrawArgs, _) = parse("draw", words.iter().cloned().chain(fixed))?;
    args.running.work = watch::work(&args.running);
    draw::pixels(&args, layers)
}

/// Draws layers as [`draw_layers`] does, and returns a file of vectors, by its suffix.
///
/// # Errors
/// Those of [`draw_layers`]; [`Failure::Usage`] for a format without vectors, [`Failure::Data`] for content that the
/// format cannot hold.
pub fn draw_vectors(
    words: &[String],
    layers: Vec<Vec<u8>>,
    suffix: &str,
) -> Result<Vec<u8>, Failure> {
    let fixed = [format!("--output=picture.{suffix}"), "--quiet".to_owned()];
    let (mut args, _): (DrawArgs, _) = parse("draw", words.iter().cloned().chain(fixed))?;
    args.running.work = watch::work(&args.running);
    draw::vectors(&args, layers)
}

/// Cuts files of map data into tiles, with the arguments of `durer tiles`.
///
/// # Errors
/// As the command.
pub fn tiles(words: &[String]) -> Result<(), Failure> {
    let quiet = ["--quiet".to_owned()];
    let (mut args, _): (TilesArgs, _) = parse("tiles", words.iter().cloned().chain(quiet))?;
    args.running.work = watch::work(&args.running);
    if args.json {
        return Err(Failure::Usage("--json: the report goes to standard output".to_owned()));
    }
    tiles::run(&args)
}

/// Returns the page with buttons for the frames of a lesson.
pub fn page(lesson: &Lesson, frames: &[Frame], language: Language) -> String {
    explain::page(lesson, frames, language)
}

/// Writes a file as a whole or not at all: beside its place, then renamed.
///
/// # Errors
/// [`Failure::Data`] if it cannot be written.
pub fn deliver(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    crate::output::deliver_bytes(&crate::output::Target::File(path.to_owned()), bytes).map(drop)
}
