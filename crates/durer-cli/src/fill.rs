//! `durer fill`.

use crate::encoding::{self, PictureFileArgs};
use crate::failure::Failure;
use crate::input::{self, display_name};
use crate::kind::Wanted;
use crate::messages::Messages;
use crate::options::RunningArgs;
use crate::output::{self, Name, Target};
use crate::{color, report, values};
use clap::{Args, ValueEnum, ValueHint};
use durer::math::DVec2;
use durer::raster::seed_fill::{self, PixelValue, SeedFill, boundary_fill, flood_fill};
use durer::target::Pixels;
use durer::trace::NoTrace;
use durer_formats::image::Orientation;
use durer_formats::picture::PictureFormat;
use durer_formats::png::Channels;
use durer_formats::wording::counted;
use durer_formats::{Limits, image, png};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

pub const EXAMPLES: &str = "\
Examples:
  durer fill plan.png -o plan.png --at 120,80 --color '#ffd9a0'
  durer fill photo.jpg -o sky.png --at 400,30 --color transparent --tolerance 24
  durer fill map.png -o map2.png --at 10,10 --at 300,200 --color lightgray --connectivity 8
  durer fill ink.png -o red.png --at 64,64 --color red --boundary black --tolerance 100

The difference of two pixels is that of the channel (red, green, blue, alpha) in which they differ most. A PNG with \
16 bits per channel keeps them, unless the output is JPEG or WebP; a difference of 1 then means 257 of its steps.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage.";

/// The options of `durer fill`.
#[derive(Debug, Args)]
pub struct FillArgs {
    /// A PNG or JPEG; `-` reads standard input
    #[arg(value_name = "IMAGE", value_hint = ValueHint::FilePath)]
    pub image: PathBuf,
    /// File to write the picture to
    ///
    /// A .png, .jpg or .webp file, or `-` for standard output. A file is only ever replaced by a complete
    /// picture.
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// A pixel to start from, counted from 0 at the upper left of the picture as viewers show it; may be repeated
    ///
    /// Fills are made one after the other, each on the result of the one before. A point between whole
    /// numbers selects the pixel that contains it: 1.5,0 is the pixel 1,0.
    #[arg(long, value_name = "X,Y", required = true, allow_hyphen_values = true, value_parser = values::point)]
    pub at: Vec<DVec2>,
    /// The colour of filled pixels; it need not be opaque
    #[arg(long, value_name = "COLOR", value_parser = color::bytes)]
    pub color: [u8; 4],
    /// Largest difference in any channel, 0 to 255, from the pixel where the fill starts (with
    /// --boundary: from the boundary's colour)
    #[arg(long, value_name = "T", default_value = "0", allow_hyphen_values = true)]
    pub tolerance: u8,
    /// Neighbourhood of pixels
    #[arg(long, value_name = "N", default_value = "4")]
    pub connectivity: Connectivity,
    /// Fill up to this colour, whatever is inside [default: fill pixels like the first one]
    #[arg(long, value_name = "COLOR", value_parser = color::bytes)]
    pub boundary: Option<[u8; 4]>,
    /// The algorithm; all fill the same pixels
    #[arg(long, value_name = "NAME", default_value = "spans", value_parser = method)]
    pub algorithm: SeedFill,
    /// Compression and quality of the file.
    #[command(flatten)]
    pub file: PictureFileArgs,
    /// Refuse images that have, or decompress to, more bytes; suffixes k, M and G are allowed
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true, default_value = "4G", value_parser = values::bytes)]
    pub max_bytes: u64,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Write a report on standard output, in JSON: how many pixels each fill reached
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// `--connectivity`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Connectivity {
    /// Pixels that share a side
    #[value(name = "4")]
    Four,
    /// Pixels that share a side or a corner
    #[value(name = "8")]
    Eight,
}

fn method(name: &str) -> Result<SeedFill, String> {
    let names: Vec<&str> = SeedFill::ALL.iter().map(|m| m.name()).collect();
    name.parse().map_err(|_| format!("it must be one of {}", names.join(", ")))
}

/// Report of `--json`.
#[derive(Debug, Serialize)]
struct Report {
    version: &'static str,
    input: String,
    output: String,
    width: u32,
    height: u32,
    fills: Vec<Fill>,
    fill_seconds: f64,
    total_seconds: f64,
    peak_memory_bytes: Option<u64>,
}

/// One fill.
#[derive(Debug, Serialize)]
struct Fill {
    x: u32,
    y: u32,
    /// Number of pixels that it reached.
    pixels: u64,
}

/// Fills a picture.
pub fn run(args: &FillArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let names = [Name { input: args.image.clone(), frame: None }];
    let wanted = Wanted::picture(&args.output, args.file.format);
    args.file.encoding.check(&[wanted.kind])?;
    let target = output::plan("--output", &args.output, &names, &wanted)?.into_iter().next();
    let target = target.ok_or_else(|| Failure::Usage("nothing to fill".to_owned()))?;
    if args.json && target == Target::Stdout {
        let message = "--json: the report goes to standard output, where the picture goes too";
        return Err(Failure::Usage(message.to_owned()));
    }
    let messages = Messages::new(&args.running, 1);
    let name = display_name(&args.image);
    messages.progress.stage(|| format!("reading {name}"));
    let mut picture = Picture::read(args, &name)?;
    let (width, height) = picture.size();
    messages.progress.stage(|| format!("filling {name}"));
    let filling = Instant::now();
    let mut fills = Vec::new();
    for at in &args.at {
        let (x, y) = place(*at, (width, height))?;
        let pixels = picture.fill(args, (x, y));
        let pixels = pixels.map_err(|e| Failure::Data(format!("{name}: {e}")))?;
        fills.push(Fill { x, y, pixels });
    }
    let fill_seconds = filling.elapsed().as_secs_f64();
    messages.progress.stage(|| format!("writing {target}"));
    picture.write(args, &target, wanted.kind.picture(), &messages)?;
    for Fill { x, y, pixels } in &fills {
        let pixels = counted(*pixels, "pixel", "pixels");
        messages.detail(|| format!("{name}: {pixels} from {x},{y}"));
    }
    drop(messages);
    if !args.json {
        return Ok(());
    }
    report::print(&Report {
        version: env!("CARGO_PKG_VERSION"),
        input: name,
        output: target.to_string(),
        width,
        height,
        fills,
        fill_seconds,
        total_seconds: start.elapsed().as_secs_f64(),
        peak_memory_bytes: report::peak_memory(),
    })
}

/// The picture as viewers show it, in sRGB with straight alpha.
enum Picture {
    Eight(Pixels<[u8; 4]>),
    /// Picture with the channels that its file has and its fills need.
    Sixteen(Pixels<[u16; 4]>, Channels),
}

impl Picture {
    fn read(args: &FillArgs, name: &str) -> Result<Self, Failure> {
        let fail = |e: durer_formats::Error| Failure::Data(format!("{name}: {e}"));
        let limits = Limits {
            decoded_bytes: args.max_bytes,
            image_side: u16::MAX.into(),
            work: args.running.work.clone(),
            ..Limits::default()
        };
        let bytes = input::bytes_within(&args.image, &limits)?;
        let orientation = Orientation::of(&bytes);
        if image::bits_per_sample(&bytes) > 8 {
            let image = image::decode_deep(&bytes, "", &limits).map_err(fail)?;
            let [r, g, b, a] = args.color;
            let channels = Channels {
                color: image.channels.color || r != g || g != b,
                alpha: image.channels.alpha || a != u8::MAX,
            };
            return Ok(Self::Sixteen(orientation.turned(image.pixels), channels));
        }
        let image = image::decode(&bytes, "", &limits).map_err(fail)?;
        let pixels = Pixels::from_data(image.width, image.height, image.data);
        let turned = orientation.turned(pixels.map_err(|e| fail(e.into()))?);
        let charged = turned.charged_to(&args.running.work, "picture");
        Ok(Self::Eight(charged.map_err(|e| fail(e.into()))?))
    }

    /// Returns the width and height.
    fn size(&self) -> (u32, u32) {
        match self {
            Self::Eight(pixels) => (pixels.width(), pixels.height()),
            Self::Sixteen(pixels, _) => (pixels.width(), pixels.height()),
        }
    }

    /// Writes the picture, with as many bits per channel as the format has.
    fn write(
        &self,
        args: &FillArgs,
        target: &Target,
        format: PictureFormat,
        messages: &Messages,
    ) -> Result<(), Failure> {
        let encoding = &args.file.encoding;
        let warn = |text: &str| messages.warning(&target.to_string(), text);
        let flattened = match (self, format) {
            (Self::Eight(pixels), _) => encoding.deliver(target, format, pixels)?,
            (Self::Sixteen(pixels, channels), PictureFormat::Png) => {
                let compression = encoding.compression.into();
                output::deliver(target, &pixels.work(), |out| {
                    png::write_deep_color(out, pixels, *channels, compression)
                })?;
                false
            }
            (Self::Sixteen(pixels, _), _) => {
                warn("16 bits per channel become 8; a PNG keeps them");
                encoding.deliver(target, format, &eight_bits(pixels)?)?
            }
        };
        if flattened {
            warn(encoding::FLATTENED);
        }
        Ok(())
    }

    /// Fills from a pixel; returns how many it reaches.
    fn fill(&mut self, args: &FillArgs, seed: (u32, u32)) -> durer::Result<u64> {
        // 255 steps of 257 are the whole range of 16 bits.
        let deep = |v: u8| u16::from(v) * 257;
        match self {
            Self::Eight(pixels) => {
                fill(args, pixels, seed, args.color, args.boundary, args.tolerance)
            }
            Self::Sixteen(pixels, _) => {
                let (color, boundary) = (args.color.map(deep), args.boundary.map(|c| c.map(deep)));
                fill(args, pixels, seed, color, boundary, deep(args.tolerance))
            }
        }
    }
}

/// Returns the nearest colours of eight bits per channel.
fn eight_bits(pixels: &Pixels<[u16; 4]>) -> Result<Pixels<[u8; 4]>, Failure> {
    let nearest = |v: u16| ((u32::from(v) + 128) / 257) as u8;
    let data = pixels.data().iter().map(|p| p.map(nearest)).collect();
    Pixels::from_data(pixels.width(), pixels.height(), data)
        .map_err(|e| Failure::Data(e.to_string()))
}

/// Returns the pixel that contains a point.
fn place(at: DVec2, (width, height): (u32, u32)) -> Result<(u32, u32), Failure> {
    let inside = |v: f64, side: u32| v >= 0.0 && v < f64::from(side);
    if inside(at.x, width) && inside(at.y, height) {
        Ok((at.x as u32, at.y as u32))
    } else {
        let message = format!("--at {},{}: outside the image of {width}x{height}", at.x, at.y);
        Err(Failure::Usage(message))
    }
}

fn fill<P: PixelValue>(
    args: &FillArgs,
    pixels: &mut Pixels<P>,
    seed: (u32, u32),
    color: P,
    boundary: Option<P>,
    tolerance: P::Level,
) -> durer::Result<u64> {
    let connectivity = match args.connectivity {
        Connectivity::Four => seed_fill::Connectivity::Four,
        Connectivity::Eight => seed_fill::Connectivity::Eight,
    };
    let options = seed_fill::Options { connectivity, ..Default::default() };
    let (method, t) = (args.algorithm, &mut NoTrace);
    match boundary {
        Some(boundary) => {
            boundary_fill(pixels, seed, color, boundary, tolerance, method, &options, t)
        }
        None => flood_fill(pixels, seed, color, tolerance, method, &options, t),
    }
}
