//! `durer draw`.

mod args;
mod fonts;
mod layers;
mod map;
mod report;
mod svg;

pub use args::{DrawArgs, EXAMPLES};
pub use fonts::built_in as built_in_fonts;
pub use layers::is_style;

use crate::encoding;
use crate::failure::{Failure, in_words};
use crate::input::{self, display_name};
use crate::kind::Wanted;
use crate::messages::Messages;
use crate::output::{self, Name, Target};
use crate::places::is_stream;
use crate::sides::Sides;
use crate::values::Size;
use args::Smoothing;
use durer::math::DVec2;
use durer::raster::paint::{Canvas, Options};
use durer::target::Pixels;
use durer::view::window::{PixelRect, Viewport};
use durer_formats::geo::GeoFormat;
use durer_formats::{Limits, Resources, Warning, archive};
use layers::Layer;
use report::{LayerReport, Report};
use std::io::Read;
use std::path::Path;
use std::time::Instant;

/// The longer side of a map in pixels, where no size is given.
const MAP_SIDE: f64 = 1024.0;

/// Draws one picture.
pub fn run(args: &DrawArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let target = check(args)?;
    let messages = Messages::new(&args.running, 1);
    let mut report = Report {
        version: env!("CARGO_PKG_VERSION"),
        output: target.to_string(),
        ..Report::default()
    };
    let mut job = Job { args, messages: &messages, report: &mut report };
    let mut given = Vec::new();
    for layer in &args.layers.0 {
        given.push(job.read(layer)?);
    }
    let picture = job.draw(given)?;
    messages.progress.stage(|| format!("writing {target}"));
    let encode = Instant::now();
    let format = wanted(args).kind.picture();
    if args.picture.file.encoding.deliver(&target, format, &picture)? {
        let message = format!("{}; --background gives it another colour", encoding::FLATTENED);
        messages.warning(&target.to_string(), &message);
        report.warnings.push(message);
    }
    drop(messages);
    report.encode_seconds = encode.elapsed().as_secs_f64();
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = crate::report::peak_memory();
    if args.json { crate::report::print(&report) } else { Ok(()) }
}

/// Draws layers whose bytes are in memory, one for each input that the options name.
pub fn pixels(args: &DrawArgs, layers: Vec<Vec<u8>>) -> Result<Pixels<[u8; 4]>, Failure> {
    let messages = Messages::new(&args.running, 1);
    let mut report = Report::default();
    let mut job = Job { args, messages: &messages, report: &mut report };
    let mut given = Vec::new();
    for (layer, bytes) in args.layers.0.iter().zip(layers) {
        given.push(job.given(layer, bytes)?);
    }
    job.draw(given)
}

/// Checks options that the parser cannot check; returns the target of the picture.
fn check(args: &DrawArgs) -> Result<Target, Failure> {
    let inputs: Vec<_> = args.layers.0.iter().map(|l| &l.input).collect();
    input::check_streams(&inputs)?;
    let first = inputs.first().map(|&input| Name { input: input.clone(), frame: None });
    let names: Vec<Name> = first.into_iter().collect();
    args.picture.file.encoding.check(wanted(args).kind)?;
    let target = output::plan("--output", &args.output, &names, &wanted(args))?;
    let Some(target) = target.into_iter().next() else {
        return Err(Failure::Usage("nothing to draw".to_owned()));
    };
    if args.json && target == Target::Stdout {
        let message = "--json: the report goes to standard output, where the picture goes too";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(target)
}

/// Returns the output format: from --format, or from the output's name.
fn wanted(args: &DrawArgs) -> Wanted {
    Wanted::picture(&args.output, args.picture.file.format)
}

/// One run.
struct Job<'a> {
    args: &'a DrawArgs,
    messages: &'a Messages,
    report: &'a mut Report,
}

/// A file that has been read.
struct Given<'a> {
    layer: &'a Layer,
    format: GeoFormat,
    file: Unpacked,
}

/// A file without its compression.
struct Unpacked {
    bytes: Vec<u8>,
    /// Its name, without a folder.
    name: String,
    /// Access to the files beside it.
    beside: Box<dyn Resources>,
}

impl Job<'_> {
    /// Prints warnings and adds them to the report.
    fn warn(&mut self, name: &str, warnings: &[Warning]) {
        self.messages.warnings(name, warnings);
        self.report.warnings.extend(warnings.iter().map(ToString::to_string));
    }

    /// Draws layers that are in memory.
    fn draw(&mut self, given: Vec<Given<'_>>) -> Result<Pixels<[u8; 4]>, Failure> {
        let (start, read_before) = (Instant::now(), self.report.read_seconds);
        let args = self.args;
        let drawing = given.iter().find(|g| g.format == GeoFormat::Svg);
        let canvas = match (drawing, &given[..]) {
            (Some(_), [one]) => self.drawing(one)?,
            (Some(drawing), _) => {
                let name = display_name(&drawing.layer.input);
                let message = format!("{name}: an SVG is drawn alone; only map data make layers");
                return Err(Failure::Usage(message));
            }
            (None, _) => self.map(&given)?,
        };
        drop(given);
        self.messages.progress.stage(|| "painting".to_owned());
        let work = &self.args.running.work;
        let name = args.layers.0.first().map_or(String::new(), |l| display_name(&l.input));
        let fail = |e: durer::Error| Failure::of_library(&e).named(&name);
        let stage = (work, "planes of the picture");
        let picture = Pixels::within(stage, canvas.width(), canvas.height(), [0; 4]);
        let mut picture = picture.map_err(fail)?;
        canvas.render(&mut picture).map_err(fail)?;
        self.report.draw_seconds =
            start.elapsed().as_secs_f64() - (self.report.read_seconds - read_before);
        (self.report.width, self.report.height) = (picture.width(), picture.height());
        Ok(picture)
    }

    fn read<'a>(&mut self, layer: &'a Layer) -> Result<Given<'a>, Failure> {
        let name = display_name(&layer.input);
        self.messages.progress.stage(|| format!("reading {name}"));
        let start = Instant::now();
        let limits = self.limits();
        let bytes = unzipped(input::bytes_within(&layer.input, &limits)?, self.args.max_bytes);
        let bytes = bytes.map_err(|e| Failure::Data(format!("{name}: {e}")))?;
        self.report.read_seconds += start.elapsed().as_secs_f64();
        self.given(layer, bytes)
    }

    /// Finds the format of a layer.
    fn given<'a>(&mut self, layer: &'a Layer, bytes: Vec<u8>) -> Result<Given<'a>, Failure> {
        let name = display_name(&layer.input);
        let file = self.unpacked(layer, bytes)?;
        let bytes = &file.bytes[..];
        let svg = GeoFormat::of_content(bytes) == Some(GeoFormat::Svg);
        let told = self.args.from.filter(|_| !svg);
        let format = told.or_else(|| crate::layer::format_of(Path::new(&file.name), bytes));
        let Some(format) = format else {
            let (what, read) = (crate::layer::foreign(bytes), GeoFormat::READ);
            let message = format!("{name}: {what}; durer draw reads SVG, and map data from {read}");
            return Err(Failure::Data(message));
        };
        let (input, map) = (name, None);
        self.report.layers.push(LayerReport { input, format: format.name(), map });
        Ok(Given { layer, format, file })
    }

    /// Returns the file of a layer, or the only map of an archive.
    fn unpacked(&self, layer: &Layer, bytes: Vec<u8>) -> Result<Unpacked, Failure> {
        let path = &layer.input;
        if !bytes.starts_with(archive::MAGIC) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            return Ok(Unpacked { bytes, name, beside: input::folder(path) });
        }
        let packed = crate::layer::packed(bytes, None, &self.limits());
        let packed = packed.map_err(|e| Failure::Data(format!("{}: {e}", display_name(path))))?;
        let name = packed.name.rsplit('/').next().unwrap_or_default().to_owned();
        Ok(Unpacked { bytes: packed.bytes, name, beside: Box::new(packed.beside) })
    }

    /// Returns the limits on inputs.
    fn limits(&self) -> Limits {
        let work = self.args.running.work.clone();
        Limits { decoded_bytes: self.args.max_bytes, work, ..Limits::default() }
    }

    /// Returns an empty canvas.
    fn canvas(&self, (width, height): (u32, u32), background: [u8; 4]) -> Result<Canvas, Failure> {
        let picture = &self.args.picture;
        let (pixels, limit) = (u64::from(width) * u64::from(height), picture.max_pixels);
        if pixels > limit {
            let message = format!(
                "the size {width}x{height}: {pixels} pixels are above the limit of {limit}; \
                 --max-pixels raises it"
            );
            return Err(Failure::Usage(message));
        }
        let anti_alias = picture.aa == Smoothing::Coverage;
        let options = Options { anti_alias, ..Options::default() };
        let canvas = Canvas::new(width, height, options);
        let mut canvas =
            canvas.map_err(|e| Failure::Usage(format!("the size {width}x{height}: {e}")))?;
        canvas.set_work(&self.args.running.work);
        canvas.clear(picture.background.unwrap_or(background));
        Ok(canvas)
    }

    /// Returns the part of a picture to draw in.
    fn viewport(&self, (width, height): (u32, u32)) -> Result<Viewport, Failure> {
        let usage = |e: durer::Error| Failure::Usage(e.to_string());
        let whole = PixelRect::of_size(width, height).map_err(usage)?;
        let pixels = self.args.picture.viewport.unwrap_or(whole);
        if pixels.intersection(&whole) != pixels {
            let message = format!("--viewport reaches beyond the picture of {width}x{height}");
            return Err(Failure::Usage(message));
        }
        Viewport::new(pixels).map_err(usage)
    }
}

/// Returns the bytes of a file, decompressed if they are gzip, up to a limit. (An SVG is decompressed by its reader.)
fn unzipped(bytes: Vec<u8>, limit: u64) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let source = durer_formats::geo::unzipped(Box::new(&bytes[..]), 1 << 16);
    let mut all = Vec::new();
    let read = source.and_then(|s| s.take(limit.saturating_add(1)).read_to_end(&mut all));
    read.map_err(|e| in_words(&e))?;
    let fits = all.len() as u64 <= limit;
    fits.then_some(all).ok_or_else(|| {
        format!("it has more bytes than the limit of {limit}; --max-bytes raises it")
    })
}

/// Returns whole sides for a picture of a given shape, whose natural size is `natural`.
fn sides(given: Option<Sides>, natural: DVec2) -> (u32, u32) {
    let Size { width, height } =
        given.unwrap_or(Sides { width: None, height: None }).of_shape(natural);
    (width, height)
}

/// Returns the rectangle of a viewport as a path.
fn frame(viewport: &Viewport) -> durer::curve::Path {
    let p = viewport.pixels();
    let (x, y) = (f64::from(p.x0()), f64::from(p.y0()));
    durer::curve::Path::rectangle(x, y, f64::from(p.width()), f64::from(p.height()))
}

/// Returns whether a layer is a file, which has a folder, and not standard input.
fn has_folder(layer: &Layer) -> bool {
    !is_stream(&layer.input)
}
