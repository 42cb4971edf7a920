//! `durer plot`.

mod args;
mod idle;
mod report;

pub use args::{EXAMPLES, PlotArgs};

use crate::encoding;
use crate::failure::Failure;
use crate::input;
use crate::kind::Kind;
use crate::messages::Messages;
use crate::output::{self, Target};
use crate::report as reports;
use crate::values::{self, Size};
use args::{Hidden, Lines};
use durer::math::{DVec2, DVec3};
use durer::paper::{self, Page};
use durer::plot::{self, Axes, Plot};
use durer::scene::{HeightField, UpAxis};
use durer::shade::color::encode_rgba8;
use durer::target::Pixels;
use durer::target::drawing::Drawing;
use durer::view::projection::{Lens, ViewDirection};
use durer::visibility::line::floating_horizon;
use durer_formats::Limits;
use durer_formats::drawing::{self, DrawingFormat, FileOptions};
use durer_formats::formula::Formula;
use durer_formats::height_map::{self, HeightMap, HeightMapOptions};
use durer_formats::picture::{self, PictureFormat};
use durer_formats::wording::counted;
use report::Report;
use std::path::Path;
use std::time::Instant;

/// More lines than this in a family are a dark area on paper; a finer file is resampled.
const MOST_LINES: usize = 100;
/// `--aspect auto`: where one side of the ground is more than this many times the other, both are drawn
/// alike.
const MOST_LENGTHY: f64 = 5.0;
/// `--exaggeration auto`: height over the longer side of the ground.
const AUTO_HEIGHT: f64 = 0.4;
/// Range in which a formula is evaluated by default.
const FORMULA_RANGE: [f64; 2] = [-4.0, 4.0];

/// Format of the plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Vectors.
    Drawing(DrawingFormat),
    /// Pixels.
    Picture(PictureFormat),
}

/// Returns a format by its name or a file's suffix.
pub fn format(text: &str) -> Result<Format, String> {
    let picture = PictureFormat::of_suffix(text).map(Format::Picture);
    picture
        .or_else(|| DrawingFormat::of_suffix(text).map(Format::Drawing))
        .ok_or_else(|| "a plot is svg, pdf, dxf, hpgl, gcode, geojson, png, jpg or webp".to_owned())
}

/// `--exaggeration`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exaggeration {
    /// The factor by the extent of the surface.
    Auto,
    /// A factor from the option.
    Factor(f64),
}

/// Parses `auto` or a factor above 0.
pub fn exaggeration(text: &str) -> Result<Exaggeration, String> {
    match text {
        "auto" => Ok(Exaggeration::Auto),
        _ => {
            values::positive(text).map(Exaggeration::Factor).map_err(|e| format!("{e}; or `auto`"))
        }
    }
}

/// `--aspect`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ratio {
    /// The ratio by the extent of the ground.
    Auto,
    /// One scale for x and z.
    Equal,
    /// A factor from the option.
    Of(f64),
}

/// Parses `auto`, `equal`, or a number above 0.
pub fn aspect(text: &str) -> Result<Ratio, String> {
    match text {
        "auto" => Ok(Ratio::Auto),
        "equal" => Ok(Ratio::Equal),
        _ => values::positive(text).map(Ratio::Of).map_err(|e| format!("{e}; or `auto`, `equal`")),
    }
}

/// Makes the plot.
pub fn run(args: &PlotArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let format = format_of(args)?;
    let kind = match format {
        Format::Picture(format) => Kind::Picture(format),
        Format::Drawing(format) => Kind::Drawing(format),
    };
    args.look.encoding.check(&[kind])?;
    args.machine.check(kind.drawing())?;
    let target = target(args)?;
    let messages = Messages::new(&args.running, 1);
    idle::warn(args, kind, &messages);
    messages.progress.stage(|| "reading".to_owned());
    let surface = Surface::read(args, &messages)?;
    let read_seconds = start.elapsed().as_secs_f64();
    messages.progress.stage(|| "drawing".to_owned());
    let start = Instant::now();
    let (plot, options) = plot_of(args, &surface)?;
    let draw_seconds = start.elapsed().as_secs_f64();
    messages.progress.stage(|| "writing".to_owned());
    let lines = plot.drawing.lines.len();
    let mut report = args.json.then(|| Report::new(&surface, &plot, &options, &target));
    let start = Instant::now();
    let mut flattened = false;
    let bytes = output::deliver(&target, &args.running.work, |out| {
        flattened = write(out, format, plot, args)?;
        Ok(())
    })?;
    if flattened {
        messages.warning(&target.to_string(), encoding::FLATTENED);
    }
    let lines = counted(lines as u64, "line", "lines");
    messages.detail(|| format!("{target}: {lines}, {bytes} bytes"));
    drop(messages);
    if let Some(report) = &mut report {
        (report.read_seconds, report.draw_seconds) = (read_seconds, draw_seconds);
        report.write_seconds = start.elapsed().as_secs_f64();
        reports::print(report)?;
    }
    Ok(())
}

/// Plots a surface by the options.
pub fn plot_of(args: &PlotArgs, surface: &Surface) -> Result<(Plot, plot::Options), Failure> {
    let options = options(args, surface)?;
    let plot = plot::surface(&surface.field, &options).map_err(|e| match options.eye {
        Some(_) => Failure::Usage(format!("--{e}")),
        None => Failure::Data(format!("{}: {e}", surface.name)),
    })?;
    Ok((plot, options))
}

fn format_of(args: &PlotArgs) -> Result<Format, Failure> {
    if let Some(format) = args.to {
        return Ok(format);
    }
    let suffix = args.output.extension().unwrap_or_default().to_string_lossy();
    let name = args.output.display();
    format(&suffix).map_err(|e| {
        Failure::Usage(format!(
            "--output {name}: the suffix does not name a format; {e}, or use --to"
        ))
    })
}

/// Returns the place of the plot, checked before anything is read.
fn target(args: &PlotArgs) -> Result<Target, Failure> {
    let target = output::file_or_stream("--output", &args.output)?;
    if args.json && target == Target::Stdout {
        let message = "--json: the report goes to standard output, where the plot goes too";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(target)
}

/// Surface to plot.
pub struct Surface {
    field: HeightField,
    name: String,
    format: String,
    on_map: bool,
}

impl Surface {
    fn read(args: &PlotArgs, messages: &Messages) -> Result<Self, Failure> {
        match (&args.surface.formula, &args.input) {
            (Some(formula), _) => Self::of_formula(formula, args),
            (None, Some(path)) => Self::of_file(path, args, messages),
            // The parser requires one of them.
            (None, None) => Err(Failure::Usage("a file or --formula is needed".to_owned())),
        }
    }

    fn of_formula(text: &str, args: &PlotArgs) -> Result<Self, Failure> {
        let wrong = |e: &dyn std::fmt::Display| Failure::Usage(format!("--formula: {e}"));
        let formula = Formula::parse(text).map_err(|e| wrong(&e))?;
        let Size { width, height } = args.surface.samples;
        if width < 2 || height < 2 {
            let message = format!("--samples {width}x{height}: a surface has 2x2 points at least");
            return Err(Failure::Usage(message));
        }
        let size = [width as usize, height as usize];
        let x = args.surface.x.unwrap_or(FORMULA_RANGE);
        let z = args.surface.z.unwrap_or(FORMULA_RANGE);
        let mut stack = Vec::new();
        let f = |x: f64, z: f64| formula.evaluate_on(&mut stack, x, z);
        let field = HeightField::from_fn(size, x, z, f)
            .map_err(|e| Failure::Usage(format!("--samples, --x, --z: {e}")))?;
        if field.range().is_none() {
            return Err(wrong(&"it has no value at any point of the grid"));
        }
        let field = within(field, args)?;
        Ok(Self { field, name: text.to_owned(), format: "formula".to_owned(), on_map: false })
    }

    fn of_file(path: &Path, args: &PlotArgs, messages: &Messages) -> Result<Self, Failure> {
        let name = input::display_name(path);
        // A name with brackets or operators is a formula, right or wrong.
        let is_formula =
            || Formula::parse(&name).is_ok() || name.contains(['(', ')', '*', '^', '+', '=']);
        if name != "-" && !path.exists() && is_formula() {
            let message = format!("there is no file `{name}`; use --formula for a formula");
            return Err(Failure::Usage(message));
        }
        let default = Limits::default();
        let decoded_bytes = args.surface.max_bytes.unwrap_or(default.decoded_bytes);
        let work = args.running.work.clone();
        let limits = Limits { decoded_bytes, work, ..default };
        let bytes = input::bytes_within(path, &limits)?;
        let options = HeightMapOptions {
            limits,
            no_data: args.surface.no_data,
            array: args.surface.array.clone(),
        };
        let file_name = path.file_name().unwrap_or_default().to_string_lossy();
        let map = height_map::read(&bytes, &file_name, &options)
            .map_err(|e| Failure::Data(format!("{name}: {e}")))?;
        messages.warnings(&name, &map.warnings);
        Self::of_map(map, name, args)
    }

    /// Returns the surface of a height map, with the ranges and the number of lines of the options.
    pub fn of_map(map: HeightMap, name: String, args: &PlotArgs) -> Result<Self, Failure> {
        let (x, z) = (args.surface.x, args.surface.z);
        let on_map = map.on_map && z.is_none();
        let (old_x, old_z) = (map.field.x_range(), map.field.z_range());
        let field = map.field.with_ranges(x.unwrap_or(old_x), z.unwrap_or(old_z));
        let field = field.map_err(|e| Failure::Usage(format!("--x, --z: {e}")))?;
        let field = within(field, args)?;
        let read = [field.columns(), field.rows()];
        let field = match args.look.every {
            Some(_) => field,
            None => field
                .resampled(read.map(|n| n.min(MOST_LINES)))
                .map_err(|e| Failure::Data(format!("{name}: {e}")))?,
        };
        Ok(Self { field, name, format: map.format, on_map })
    }

    /// Returns the ratio of depth to width of the ground as drawn; `None` for one scale.
    fn aspect(&self, ratio: Ratio) -> Option<f64> {
        let extent = |[from, to]: [f64; 2]| to - from;
        let own = extent(self.field.z_range()) / extent(self.field.x_range());
        match ratio {
            Ratio::Of(ratio) => Some(ratio),
            Ratio::Auto if !(1.0 / MOST_LENGTHY..=MOST_LENGTHY).contains(&own) => Some(1.0),
            Ratio::Auto | Ratio::Equal => None,
        }
    }

    /// Returns a factor for heights with which the plot is neither too flat nor too high.
    fn auto_exaggeration(&self, aspect: Option<f64>) -> f64 {
        let extent = |[from, to]: [f64; 2]| to - from;
        let width = extent(self.field.x_range());
        let depth = aspect.map_or(extent(self.field.z_range()), |aspect| aspect * width);
        let ground = width.max(depth);
        let height = self.field.range().map_or(0.0, extent);
        let factor = AUTO_HEIGHT * ground / height;
        if factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
    }
}

/// Returns a field without the heights beyond `--y-range`.
fn within(field: HeightField, args: &PlotArgs) -> Result<HeightField, Failure> {
    let Some([low, high]) = args.surface.y_range else { return Ok(field) };
    let field = field.within([low, high]).map_err(|e| Failure::Usage(format!("--y-range: {e}")))?;
    match field.range() {
        Some(_) => Ok(field),
        None => Err(Failure::Usage(format!("--y-range {low},{high}: there is no height in it"))),
    }
}

/// The vertical angle of view of `--eye`, degrees.
const EYE_FOV: f64 = 35.0;

fn options(args: &PlotArgs, surface: &Surface) -> Result<plot::Options, Failure> {
    let view = &args.view;
    let (azimuth, elevation) = view.view.map_or((view.azimuth, view.elevation), |v| v.angles());
    let direction = ViewDirection::from_angles(azimuth, elevation, UpAxis::Y)
        .map_err(|e| Failure::Usage(format!("--{e}")))?;
    let lens = match view.fov.or(view.eye.map(|_| EYE_FOV)) {
        Some(fov) => Lens::Perspective { fov_y: fov.to_radians() },
        None => Lens::Orthographic,
    };
    let middle = || surface.field.bounds().map_or(DVec3::ZERO, |b| b.center());
    let eye = view.eye.map(|eye| [eye, view.target.unwrap_or_else(middle)]);
    let look = &args.look;
    let every = match look.every {
        Some(n) => usize::try_from(n).unwrap_or(usize::MAX),
        // A file is resampled, a formula has as many samples as were requested.
        None => 1,
    };
    let along_x = matches!(look.lines, Lines::X | Lines::Both);
    let along_z = matches!(look.lines, Lines::Z | Lines::Both);
    let lines = floating_horizon::Options {
        every_row: if along_x { every } else { 0 },
        every_column: if along_z { every } else { 0 },
        hidden: look.hidden == Hidden::Dashed,
    };
    let aspect = surface.aspect(args.surface.aspect);
    let exaggeration = match args.surface.exaggeration {
        Exaggeration::Factor(factor) => factor,
        Exaggeration::Auto => surface.auto_exaggeration(aspect),
    };
    let names = look.labels.clone().unwrap_or_else(|| ["x", "y", "z"].map(str::to_owned));
    let axes = (!look.no_axes).then_some(Axes { names, z_is_south: surface.on_map });
    let background = Some(encode_rgba8(look.background)).filter(|c| c[3] > 0);
    Ok(plot::Options {
        direction,
        lens,
        eye,
        lines,
        exaggeration,
        aspect,
        color_bar: !look.no_color_bar,
        color_map: look.color_map,
        fill: look.fill,
        ink: encode_rgba8(look.ink),
        underside: look.underside.map(encode_rgba8),
        axes,
        title: look.title.clone(),
        page: paper_size(look.page),
        background,
        pen: look.pen,
        ..plot::Options::default()
    })
}

/// Returns the size of the paper; paper of free orientation is used in landscape, like plots.
fn paper_size(page: Page) -> DVec2 {
    match page {
        Page::Exact(size) => size,
        Page::Either(size) => DVec2::new(size.max_element(), size.min_element()),
        Page::Fit => plot::Options::default().page,
    }
}

/// Writes a plot; returns whether the picture had to be laid onto white.
pub fn write(
    out: &mut impl std::io::Write,
    format: Format,
    plot: Plot,
    args: &PlotArgs,
) -> durer_formats::Result<bool> {
    match format {
        Format::Drawing(DrawingFormat::GeoJson) => {
            drawing::write_geojson(out, &plot.drawing).map(|()| false)
        }
        Format::Drawing(format) => {
            let mut sheet = plot.into_sheet();
            if args.machine.orders(Some(format)) {
                paper::order::sheet(&mut sheet);
            }
            let (machine, work) = (args.machine.options(), args.running.work.clone());
            let options = FileOptions { machine, work, ..FileOptions::default() };
            drawing::write(out, format, &sheet, &Drawing::default(), &options).map(|()| false)
        }
        Format::Picture(format) => {
            let pixels = paint(plot, args)?;
            picture::write(out, format, &pixels, &args.look.encoding.encoding())
        }
    }
}

/// Paints a plot as pixels.
pub fn paint(plot: Plot, args: &PlotArgs) -> durer::Result<Pixels<[u8; 4]>> {
    let sheet = plot.into_sheet();
    let background = sheet.background.unwrap_or([0; 4]);
    let Size { width, height } = args.look.size.of_shape(sheet.size);
    paper::paint(sheet, width, height, background)
}
