//! `durer draw`.

mod args;
mod features;
mod fonts;
mod layers;
mod map;
mod report;
mod svg;

pub use args::{DrawArgs, EXAMPLES};
pub use fonts::built_in as built_in_fonts;
pub use layers::is_style;

use crate::encoding;
use crate::failure::Failure;
use crate::input::{self, display_name};
use crate::kind::{Kind, Wanted};
use crate::messages::Messages;
use crate::output::{self, Name, Target};
use crate::places::is_stream;
use crate::sides::Sides;
use crate::values::Size;
use args::Smoothing;
use durer::math::DVec2;
use durer::paper::SheetPainter;
use durer::raster::coverage::FillRule;
use durer::raster::paint::{Canvas, Options, Paint, PaintTarget};
use durer::target::Pixels;
use durer::target::drawing::Drawing;
use durer::target::sheet::Sheet;
use durer::view::window::{PixelRect, Viewport};
use durer::work::Work;
use durer_formats::drawing::{self, DrawingFormat, DxfFrame, FileOptions};
use durer_formats::geo::GeoFormat;
use durer_formats::{Limits, Resources, Warning, archive, gzip};
use layers::Layer;
use report::{LayerReport, Report};
use std::borrow::Cow;
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
    let mut job = Job::new(args, &messages, &mut report);
    let mut given = Vec::new();
    for layer in &args.layers.0 {
        given.push(job.read(layer)?);
    }
    let kind = wanted(args).kind;
    let encode = match kind.drawing() {
        Some(format) => {
            let vectors = job.draw_vectors(given, format)?;
            messages.progress.stage(|| format!("writing {target}"));
            let encode = Instant::now();
            let work = &args.running.work;
            output::deliver(&target, work, |out| write(out, format, &vectors, work))?;
            encode
        }
        None => {
            let picture = job.draw(given)?;
            messages.progress.stage(|| format!("writing {target}"));
            let encode = Instant::now();
            if args.picture.encoding.deliver(&target, kind.picture(), &picture)? {
                let message =
                    format!("{}; --background gives it another colour", encoding::FLATTENED);
                messages.warning(&target.to_string(), &message);
                job.report.warnings.push(message);
            }
            encode
        }
    };
    let skipped = job.skipped;
    drop(messages);
    report.encode_seconds = encode.elapsed().as_secs_f64();
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = crate::report::peak_memory();
    if args.json {
        crate::report::print(&report)?;
    }
    if skipped > 0 { Err(Failure::Partial) } else { Ok(()) }
}

/// A sheet, and its place in a file for CAD.
struct Vectors {
    sheet: Sheet,
    frame: DxfFrame,
}

/// Writes a sheet as a file of vectors.
fn write(
    out: &mut impl std::io::Write,
    format: DrawingFormat,
    Vectors { sheet, frame }: &Vectors,
    work: &Work,
) -> durer_formats::Result<()> {
    let options = FileOptions { work: work.clone(), dxf_frame: *frame, ..FileOptions::default() };
    drawing::write(out, format, sheet, &Drawing::default(), &options)
}

/// Draws layers whose bytes are in memory, one for each input that the options name.
pub fn pixels(args: &DrawArgs, layers: Vec<Vec<u8>>) -> Result<Pixels<[u8; 4]>, Failure> {
    in_memory(args, layers, |job, given| job.draw(given))
}

/// Draws layers whose bytes are in memory as [`pixels`] does, and returns the file of vectors of the output's kind.
pub fn vectors(args: &DrawArgs, layers: Vec<Vec<u8>>) -> Result<Vec<u8>, Failure> {
    let kind = wanted(args).kind;
    let Some(format) = kind.drawing() else {
        let names: Vec<_> = DrawingFormat::ALL.iter().map(|f| Kind::Drawing(*f)).collect();
        let names = names.iter().filter(|kind| kind.is_of_maps()).map(|kind| kind.suffix());
        let names = names.collect::<Vec<_>>().join(", ");
        return Err(Failure::Usage(format!(
            "vectors of maps and SVG files are written as {names}"
        )));
    };
    check_kind(args, kind)?;
    let vectors = in_memory(args, layers, |job, given| job.draw_vectors(given, format))?;
    let mut bytes = Vec::new();
    write(&mut bytes, format, &vectors, &args.running.work)
        .map_err(|e| Failure::Data(e.to_string()))?;
    Ok(bytes)
}

/// Does something with layers whose bytes are in memory, without messages.
fn in_memory<T>(
    args: &DrawArgs,
    layers: Vec<Vec<u8>>,
    draw: impl FnOnce(&mut Job<'_>, Vec<Given<'_>>) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let messages = Messages::new(&args.running, 1);
    let mut report = Report::default();
    let mut job = Job::new(args, &messages, &mut report);
    let mut given = Vec::new();
    for (layer, bytes) in args.layers.0.iter().zip(layers) {
        given.push(job.given(layer, bytes)?);
    }
    draw(&mut job, given)
}

/// Refuses options of pixels for vectors, and the other way round.
fn check_kind(args: &DrawArgs, kind: Kind) -> Result<(), Failure> {
    args.picture.encoding.check(&[kind])?;
    if kind.is_vector() && args.picture.aa == Smoothing::None {
        let message = "--aa: vectors have no pixels; end the name in .png, or leave the option out";
        return Err(Failure::Usage(message.to_owned()));
    }
    if args.picture.dxf_units.is_some() && kind.drawing() != Some(DrawingFormat::Dxf) {
        let message = "--dxf-units: it is for .dxf files; leave it out";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(())
}

/// Checks options that the parser cannot check; returns the target of the picture.
fn check(args: &DrawArgs) -> Result<Target, Failure> {
    let inputs: Vec<_> = args.layers.0.iter().map(|l| &l.input).collect();
    input::check_streams(&inputs)?;
    let first = inputs.first().map(|&input| Name { input: input.clone(), frame: None });
    let names: Vec<Name> = first.into_iter().collect();
    check_kind(args, wanted(args).kind)?;
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
    Wanted::map(&args.output, args.picture.format)
}

/// One run.
struct Job<'a> {
    args: &'a DrawArgs,
    messages: &'a Messages,
    report: &'a mut Report,
    /// The place of the sheet in a file for CAD.
    frame: DxfFrame,
    /// The coordinate systems of the layers.
    systems: features::Systems,
    /// Number of features that cannot be read and are left out.
    skipped: u64,
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
    /// The layer of the file to draw.
    layer: Option<String>,
}

impl<'a> Job<'a> {
    fn new(args: &'a DrawArgs, messages: &'a Messages, report: &'a mut Report) -> Self {
        let (frame, systems) = Default::default();
        Self { args, messages, report, frame, systems, skipped: 0 }
    }
}

impl Job<'_> {
    /// Prints warnings and adds them to the report.
    fn warn(&mut self, name: &str, warnings: &[Warning]) {
        self.messages.warnings(name, warnings);
        self.report.warnings.extend(warnings.iter().map(ToString::to_string));
    }

    /// Draws layers that are in memory as pixels.
    fn draw(&mut self, given: Vec<Given<'_>>) -> Result<Pixels<[u8; 4]>, Failure> {
        self.timed(|this| {
            let canvas: Canvas = this.painted(given)?;
            this.messages.progress.stage(|| "painting".to_owned());
            let work = &this.args.running.work;
            let fail = |e: durer::Error| Failure::of_library(&e).named(&this.names());
            let stage = (work, "planes of the picture");
            let picture = Pixels::within(stage, canvas.width(), canvas.height(), [0; 4]);
            let mut picture = picture.map_err(fail)?;
            canvas.render(&mut picture).map_err(fail)?;
            Ok(picture)
        })
    }

    /// Draws layers that are in memory as vectors, for a format.
    fn draw_vectors(
        &mut self,
        given: Vec<Given<'_>>,
        format: DrawingFormat,
    ) -> Result<Vectors, Failure> {
        self.timed(|this| {
            let painter: SheetPainter = this.painted(given)?;
            painter.work().check().map_err(|e| Failure::of_library(&e).named(&this.names()))?;
            let sheet = painter.into_sheet().map_err(|kinds| {
                let kinds = Vec::from_iter(kinds).join(", ");
                let name = this.names();
                let vectors = if format == DrawingFormat::Dxf { "DXF" } else { "vectors" };
                Failure::Data(format!(
                    "{name}: {kinds} cannot be written as {vectors}; a picture (.png) shows them"
                ))
            })?;
            Ok(Vectors { sheet, frame: this.frame })
        })
    }

    /// Draws, and reports the time that it takes without reading.
    fn timed<T>(
        &mut self,
        draw: impl FnOnce(&mut Self) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let (start, read_before) = (Instant::now(), self.report.read_seconds);
        let drawn = draw(self);
        let read = self.report.read_seconds - read_before;
        self.report.draw_seconds = start.elapsed().as_secs_f64() - read;
        drawn
    }

    /// Returns a target with everything that the layers paint.
    fn painted<T: Surface>(&mut self, given: Vec<Given<'_>>) -> Result<T, Failure> {
        let drawing = given.iter().find(|g| g.format == GeoFormat::Svg);
        match (drawing, &given[..]) {
            (Some(_), [one]) => self.drawing(one),
            (Some(drawing), _) => {
                let name = display_name(&drawing.layer.input);
                let message = format!("{name}: an SVG is drawn alone; only map data make layers");
                Err(Failure::Usage(message))
            }
            (None, _) => self.map(&given),
        }
    }

    /// Returns the names of all inputs.
    fn names(&self) -> String {
        let names: Vec<String> =
            self.args.layers.0.iter().map(|layer| display_name(&layer.input)).collect();
        names.join(", ")
    }

    fn read<'a>(&mut self, layer: &'a Layer) -> Result<Given<'a>, Failure> {
        let name = display_name(&layer.input);
        self.messages.progress.stage(|| format!("reading {name}"));
        let start = Instant::now();
        let bytes = input::bytes_within(&layer.input, &self.limits())?;
        self.report.read_seconds += start.elapsed().as_secs_f64();
        self.given(layer, bytes)
    }

    /// Finds the format of a layer.
    fn given<'a>(&mut self, layer: &'a Layer, bytes: Vec<u8>) -> Result<Given<'a>, Failure> {
        let name = display_name(&layer.input);
        let start = Instant::now();
        let unpacked = gzip::unpacked(&bytes, &self.limits()).map_err(|e| match e {
            durer_formats::Error::Limit { limit, .. } => input::too_large(limit),
            other => other.to_string(),
        });
        let unpacked = match unpacked.map_err(|e| Failure::Data(format!("{name}: {e}")))? {
            Cow::Owned(unpacked) => Some(unpacked),
            Cow::Borrowed(_) => None,
        };
        let file = self.unpacked(layer, unpacked.unwrap_or(bytes))?;
        if file.bytes.is_empty() {
            return Err(Failure::Data(format!("{name}: the file is empty")));
        }
        self.report.read_seconds += start.elapsed().as_secs_f64();
        let bytes = &file.bytes[..];
        let svg = GeoFormat::of_content(bytes) == Some(GeoFormat::Svg);
        let given = self.args.from.filter(|_| !svg);
        let format = given.or_else(|| crate::layer::format_of(Path::new(&file.name), bytes));
        let Some(format) = format else {
            let (what, read) = (crate::layer::foreign(bytes), GeoFormat::READ);
            let message = format!("{name}: {what}; durer draw reads maps and drawings from {read}");
            return Err(Failure::Data(message));
        };
        let (input, map) = (name, None);
        self.report.layers.push(LayerReport { input, format: format.name(), map });
        Ok(Given { layer, format, file })
    }

    /// Returns the file of a layer, or the only or chosen map of an archive.
    fn unpacked(&self, layer: &Layer, bytes: Vec<u8>) -> Result<Unpacked, Failure> {
        let path = &layer.input;
        if !bytes.starts_with(archive::MAGIC) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let (beside, layer) = (input::folder(path), layer.chosen.clone());
            return Ok(Unpacked { bytes, name, beside, layer });
        }
        let chosen = layer.chosen.as_deref();
        let packed = crate::layer::packed(bytes, chosen, &self.limits());
        let packed = packed.map_err(|e| Failure::Data(format!("{}: {e}", display_name(path))))?;
        let name = packed.name.rsplit('/').next().unwrap_or_default().to_owned();
        let (bytes, layer) = (packed.bytes, packed.within);
        Ok(Unpacked { bytes, name, beside: Box::new(packed.beside), layer })
    }

    /// Returns the limits on inputs.
    fn limits(&self) -> Limits {
        let work = self.args.running.work.clone();
        Limits { decoded_bytes: self.args.max_bytes, work, ..Limits::default() }
    }

    /// Returns an empty target of a size.
    fn surface<T: Surface>(
        &mut self,
        (width, height): (u32, u32),
        background: [u8; 4],
    ) -> Result<T, Failure> {
        (self.report.width, self.report.height) = (width, height);
        T::empty(self.args, (width, height), self.args.picture.background.unwrap_or(background))
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

/// A target of painting that a file is made of.
trait Surface: PaintTarget + Sized {
    /// Creates an empty target of a size in pixels.
    fn empty(args: &DrawArgs, size: (u32, u32), background: [u8; 4]) -> Result<Self, Failure>;

    /// Begins a layer with a name.
    fn begin_layer(&mut self, name: &str);
}

impl Surface for Canvas {
    fn empty(
        args: &DrawArgs,
        (width, height): (u32, u32),
        background: [u8; 4],
    ) -> Result<Self, Failure> {
        let picture = &args.picture;
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
        let canvas = Self::new(width, height, options);
        let mut canvas =
            canvas.map_err(|e| Failure::Usage(format!("the size {width}x{height}: {e}")))?;
        canvas.set_work(&args.running.work);
        canvas.clear(background);
        Ok(canvas)
    }

    fn begin_layer(&mut self, _name: &str) {}
}

impl Surface for SheetPainter {
    fn empty(
        args: &DrawArgs,
        (width, height): (u32, u32),
        background: [u8; 4],
    ) -> Result<Self, Failure> {
        let mut painter = Self::new(width, height);
        painter.set_work(&args.running.work);
        if !is_for_cad(args) {
            painter.set_background(background);
            return Ok(painter);
        }
        painter.set_cad();
        if background[3] > 0 && background != [255; 4] {
            let [width, height] = [width, height].map(f64::from);
            let sheet = durer::curve::Path::rectangle(0.0, 0.0, width, height);
            painter.begin_layer("background");
            painter.fill(&sheet, FillRule::EvenOdd, &Paint::Color(background), 1.0);
        }
        Ok(painter)
    }

    fn begin_layer(&mut self, name: &str) {
        self.begin_layer(name);
    }
}

/// Returns whether the output is a file for CAD, whose paper is as white as the program's.
fn is_for_cad(args: &DrawArgs) -> bool {
    wanted(args).kind.drawing() == Some(DrawingFormat::Dxf)
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
