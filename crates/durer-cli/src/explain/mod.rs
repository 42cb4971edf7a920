//! `durer explain`.

mod args;
mod page;
mod source;

pub use args::{EXAMPLES, ExplainArgs};
pub use page::page;

use crate::draw::built_in_fonts;
use crate::failure::Failure;
use crate::messages::Messages;
use crate::output::{self, Target, deliver, deliver_bytes};
use crate::places::is_stream;
use crate::report;
use args::Format;
use durer::explain::{self, Frame, Language, Lesson, Options};
use durer::math::DAffine2;
use durer::raster::paint::{self, Canvas};
use durer::target::Pixels;
use durer_formats::png::{Compression, write_color};
use durer_formats::svg::{Drawing, ReadOptions};
use durer_formats::{Limits, NoResources};
use std::fmt::Write;

/// The most pixels of a sheet.
const MOST_PIXELS: f64 = 1e8;

/// Explains an algorithm, or lists them.
pub fn run(args: &ExplainArgs) -> Result<(), Failure> {
    let language = args.lang.into();
    let Some(name) = &args.algorithm else {
        return report::print_text(&list(explain::lessons(), language));
    };
    let usage = |e: durer::Error| Failure::of_library(&e);
    // Names are written like Cohen-Sutherland or cohen_sutherland, too.
    let name = name.to_lowercase().replace(['_', ' ', '–'], "-");
    let lesson = explain::lesson(&name).map_err(usage)?;
    if args.list {
        return report::print_text(&list([lesson], language));
    }
    let format = format(args)?;
    let is_text = format == Format::Text && is_stream(&args.output);
    let target =
        if is_text { Target::Stdout } else { output::file_or_stream("--output", &args.output)? };
    let messages = Messages::new(&args.running, 1);
    let input = source::input(args, &messages)?;
    let options = Options { operation: args.operation, rule: args.fill_rule };
    let of_input = |failure: Failure| match &args.input {
        Some(path) => failure.named(&crate::input::display_name(path)),
        None => failure,
    };
    let frames = lesson.run(&input, &options, args.max_steps as usize).map_err(|e| match e {
        durer::Error::Limit { .. } if args.input.is_some() => {
            Failure::Refused(format!("{e}; {SMALLER}"))
        }
        e => usage(e),
    });
    let frames = frames.map_err(of_input)?;
    let frames = chosen(args, frames)?;
    match format {
        Format::Png => write_png(args, &target, &frames, language),
        Format::Svg => {
            deliver_bytes(&target, drawing(args, &frames, language).as_bytes()).map(drop)
        }
        Format::Json => {
            deliver_bytes(&target, explain::json(lesson, &frames, language).as_bytes()).map(drop)
        }
        Format::Html => {
            deliver_bytes(&target, page(lesson, &frames, language).as_bytes()).map(drop)
        }
        Format::Text => deliver_bytes(&target, captions(&frames, language).as_bytes()).map(drop),
    }
}

/// Advice for inputs that are too large to be explained.
pub const SMALLER: &str =
    "take a part of it, or one with fewer points (durer clip, durer simplify)";

/// Returns the format by an option or by the name of the output.
fn format(args: &ExplainArgs) -> Result<Format, Failure> {
    if let Some(format) = args.format {
        return Ok(format);
    }
    if is_stream(&args.output) {
        return Ok(Format::Text);
    }
    let suffix = args.output.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    match suffix.as_str() {
        "svg" => Ok(Format::Svg),
        "png" => Ok(Format::Png),
        "json" => Ok(Format::Json),
        "html" | "htm" => Ok(Format::Html),
        "txt" => Ok(Format::Text),
        _ => {
            let shown = durer_formats::wording::shown_path(&args.output);
            Err(Failure::Usage(format!(
                "--output {shown}: name a .svg, .png, .json, .html or .txt file, or give --format"
            )))
        }
    }
}

/// Returns the requested step, or all.
fn chosen(args: &ExplainArgs, mut frames: Vec<Frame>) -> Result<Vec<Frame>, Failure> {
    let count = frames.len();
    if count == 0 {
        return Err(Failure::Data("the algorithm took no step on this input".to_owned()));
    }
    let Some(step) = args.step else { return Ok(frames) };
    if (1..=count).contains(&step) {
        return Ok(vec![frames.swap_remove(step - 1)]);
    }
    Err(Failure::Usage(format!("--step {step}: there are steps 1 to {count}")))
}

/// Returns the list of algorithms with their examples.
fn list<'a>(lessons: impl IntoIterator<Item = &'a Lesson>, language: Language) -> String {
    let mut out = String::new();
    for lesson in lessons {
        let info = lesson.info;
        let _ = writeln!(
            out,
            "{}  ({}: {}, {})",
            lesson.name,
            lesson.title().text(language),
            info.authors,
            info.year
        );
        for example in lesson.examples {
            let _ = writeln!(
                out,
                "    --example {:<16} {}",
                example.name,
                example.title.text(language)
            );
        }
    }
    out
}

/// Returns the captions, one a line with its number and the line of the pseudocode.
fn captions(frames: &[Frame], language: Language) -> String {
    let mut out = String::new();
    for (i, frame) in frames.iter().enumerate() {
        let _ = writeln!(out, "{:>4}  [{:>2}]  {}", i + 1, frame.line, frame.text(language));
    }
    out
}

/// Returns the drawing: one step with its table, or all side by side.
fn drawing(args: &ExplainArgs, frames: &[Frame], language: Language) -> String {
    match (args.step, frames) {
        (Some(_), [frame]) => explain::svg(frame, language),
        _ => explain::sheet(frames, args.columns.into(), language),
    }
}

/// Draws the same as pixels, two for each of the drawing's.
fn write_png(
    args: &ExplainArgs,
    target: &Target,
    frames: &[Frame],
    language: Language,
) -> Result<(), Failure> {
    let svg = drawing(args, frames, language);
    let fail = |what: String| Failure::Data(format!("the sheet: {what}"));
    let fonts = built_in_fonts();
    let limits = Limits { work: args.running.work.clone(), ..Limits::default() };
    let options = ReadOptions { fonts: &fonts, resources: &NoResources, limits };
    let drawing = Drawing::read(svg.as_bytes(), &options).map_err(|e| fail(e.to_string()))?;
    let size = drawing.size() * 2.0;
    if size.x * size.y > MOST_PIXELS || size.max_element() > 32_000.0 {
        let message =
            "it has too many steps for a PNG; --max-steps shows fewer, or write an svg".to_owned();
        return Err(Failure::Usage(message));
    }
    let (w, h) = (size.x.ceil() as u32, size.y.ceil() as u32);
    let mut canvas =
        Canvas::new(w, h, paint::Options::default()).map_err(|e| fail(e.to_string()))?;
    canvas.set_work(&args.running.work);
    canvas.clear([255; 4]);
    let _ = drawing.draw(&mut canvas, DAffine2::from_scale(durer::math::DVec2::splat(2.0)));
    let mut pixels = Pixels::new(w, h, [255; 4]);
    canvas.render(&mut pixels).map_err(|e| Failure::of_library(&e))?;
    deliver(target, &pixels.work(), |out| write_color(out, &pixels, Compression::Small)).map(drop)
}
