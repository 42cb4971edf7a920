//! `durer warp`.

use crate::encoding::{self, PictureFileArgs};
use crate::failure::Failure;
use crate::kind::Wanted;
use crate::messages::Messages;
use crate::options::RunningArgs;
use crate::output::{self, Name};
use crate::sides::{Sides, sides};
use crate::values::{self, Size};
use crate::{camera, color, input, report};
use clap::{Args, ValueHint};
use durer::math::{DVec2, DVec3};
use durer::scene::{Camera, Projection};
use durer::shade::color::encode_rgba8;
use durer::target::Pixels;
use durer::trace::NoTrace;
use durer::view::warp::{self, DepthPicture, Warped};
use durer_formats::wording::counted;
use durer_formats::{Limits, image, png};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The help's examples.
pub const EXAMPLES: &str = "\
Examples:
  durer render part.stl -o a.png --depth a_depth.png --eye 8,3,9 --target 0,0,0 --near 4 --far 20
  durer warp a.png a_depth.png -o b.png --eye 8,3,9 --target 0,0,0 --near 4 --far 20 \\
    --to-eye 8.5,3,8.6

`durer render --json` reports the camera of each picture. Holes are places that the picture does not show; --fill names \
a second picture that may show them.

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage.";

/// The options of `durer warp`.
#[derive(Debug, Args)]
pub struct WarpArgs {
    /// A picture: PNG or JPEG
    #[arg(value_name = "COLOR", value_hint = ValueHint::FilePath)]
    pub color: PathBuf,
    /// Its depths, as `durer render --depth` writes them
    #[arg(value_name = "DEPTH", value_hint = ValueHint::FilePath)]
    pub depth: PathBuf,
    /// File to write the new picture to: a .png, .jpg or .webp file, or `-` for standard output
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// Position of the picture's eye
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector)]
    pub eye: DVec3,
    /// Target of the picture's camera
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector)]
    pub target: DVec3,
    /// Up direction of the picture's camera
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, default_value = "0,1,0", value_parser = values::direction)]
    pub up: DVec3,
    /// Its vertical angle of view in degrees [default: 30, as of `render`]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::angle_of_view, conflicts_with = "ortho")]
    pub fov: Option<f64>,
    /// For a parallel projection: the height of the view in world units
    #[arg(long, value_name = "HEIGHT", allow_hyphen_values = true, value_parser = values::positive)]
    pub ortho: Option<f64>,
    /// Distance of the near plane, where depth is 0
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true, value_parser = values::number)]
    pub near: f64,
    /// Distance of the far plane, where depth is 1
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true, value_parser = values::number)]
    pub far: f64,
    /// Position of the new eye
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector)]
    pub to_eye: DVec3,
    /// Point that the new eye looks at [default: as before]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector)]
    pub to_target: Option<DVec3>,
    /// Direction that points up in the new picture [default: as before]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::direction)]
    pub to_up: Option<DVec3>,
    /// Width and height of the new picture; one may be left out [default: as before]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = sides)]
    pub size: Option<Sides>,
    /// The colour of holes, which no picture shows
    #[arg(long, value_name = "COLOR", default_value = "#ff00ff", value_parser = color::color)]
    pub holes: durer::math::Vec4,
    /// A second picture and its depths, which fill holes; same lens and planes
    #[arg(long, num_args = 2, value_names = ["COLOR", "DEPTH"], value_hint = ValueHint::FilePath, requires = "fill_eye")]
    pub fill: Vec<PathBuf>,
    /// Position of the second picture's eye
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, requires = "fill")]
    pub fill_eye: Option<DVec3>,
    /// Target of the second picture's camera [default: the same]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, requires = "fill")]
    pub fill_target: Option<DVec3>,
    /// Compression and quality of the file.
    #[command(flatten)]
    pub file: PictureFileArgs,
    /// Write a report on standard output, in JSON
    #[arg(long)]
    pub json: bool,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
}

#[derive(Debug, Serialize)]
struct Report {
    file: String,
    width: u32,
    height: u32,
    /// Pixels that come from the second picture.
    filled: u64,
    /// Pixels that no picture shows.
    holes: u64,
}

/// A picture in memory.
struct Loaded {
    color: Pixels<[u8; 4]>,
    depth: Pixels<f32>,
}

/// Makes the new view and writes it.
pub fn run(args: &WarpArgs) -> Result<(), Failure> {
    let name = Name { input: "warped".into(), frame: None };
    let wanted = Wanted::picture(&args.output, args.file.format);
    args.file.encoding.check(&[wanted.kind])?;
    let targets = output::plan("--output", &args.output, std::slice::from_ref(&name), &wanted)?;
    let Some(target) = targets.first() else { return Ok(()) };
    if args.json && *target == output::Target::Stdout {
        let message = "--json: the report goes to standard output, where the picture goes too";
        return Err(Failure::Usage(message.to_owned()));
    }
    let messages = Messages::new(&args.running, 1);
    let camera = camera(args);
    check("--near, --far, --eye, --target, --up", &camera)?;
    let (target_point, up) = (args.to_target.unwrap_or(args.target), args.to_up.unwrap_or(args.up));
    let new = Camera { eye: args.to_eye, target: target_point, up, ..camera };
    check("--to-eye, --to-target, --to-up", &new)?;
    let limits = Limits { work: args.running.work.clone(), ..Limits::default() };
    let first = load(&args.color, &args.depth, &limits)?;
    let second = match &args.fill[..] {
        [color, depth] => Some(load(color, depth, &limits)?),
        _ => None,
    };
    let (width, height) = (first.color.width(), first.color.height());
    let before = DVec2::new(f64::from(width), f64::from(height));
    let size = args.size.map_or(Size { width, height }, |sides| sides.of_shape(before));
    let mut sources = vec![DepthPicture { color: &first.color, depth: &first.depth, camera }];
    if let Some(second) = &second {
        let eye = args.fill_eye.unwrap_or(args.eye);
        let camera = Camera { eye, target: args.fill_target.unwrap_or(args.target), ..camera };
        check("--fill-eye, --fill-target", &camera)?;
        sources.push(DepthPicture { color: &second.color, depth: &second.depth, camera });
    }
    let work = args.running.work.clone();
    let options = warp::Options { hole: encode_rgba8(args.holes), work };
    let warped = warp::warp(&sources, &new, [size.width, size.height], &options, &mut NoTrace)
        .map_err(|e| Failure::Data(format!("{}: {e}", args.depth.display())))?;
    if args.file.encoding.deliver(target, wanted.kind.picture(), &warped.framebuffer.color)? {
        messages.warning(&target.to_string(), encoding::FLATTENED);
    }
    report_warp(args, target, &warped, &messages)
}

fn report_warp(
    args: &WarpArgs,
    target: &output::Target,
    warped: &Warped,
    messages: &Messages,
) -> Result<(), Failure> {
    let filled = warped.source.data().iter().filter(|s| **s == 1).count() as u64;
    let (width, height) = (warped.source.width(), warped.source.height());
    let report = Report { file: target.to_string(), width, height, filled, holes: warped.holes };
    messages.detail(|| {
        let holes = counted(report.holes, "hole", "holes");
        format!("{}: {width}x{height}, {holes}, {filled} filled", report.file)
    });
    if args.json { report::print(&report) } else { Ok(()) }
}

fn camera(args: &WarpArgs) -> Camera {
    let projection = match args.ortho {
        Some(height) => Projection::Orthographic { height },
        None => Projection::Perspective { fov_y: args.fov.unwrap_or(camera::FOV).to_radians() },
    };
    let WarpArgs { eye, target, up, near, far, .. } = *args;
    Camera { eye, target, up, projection, near, far }
}

fn check(options: &str, camera: &Camera) -> Result<(), Failure> {
    camera.check().map_err(|e| Failure::Usage(format!("{options}: {e}")))
}

fn load(color: &Path, depth: &Path, limits: &Limits) -> Result<Loaded, Failure> {
    let image = image::decode(&input::bytes_within(color, limits)?, "", limits)
        .map_err(|e| Failure::of_file(color, e))?;
    let colors = Pixels::from_data(image.width, image.height, image.data)
        .map_err(|e| Failure::of_file(color, e))?;
    let depths = png::read_depth(&input::bytes_within(depth, limits)?, limits)
        .map_err(|e| Failure::of_file(depth, e))?;
    if (depths.width(), depths.height()) != (colors.width(), colors.height()) {
        let sizes = [(depths.width(), depths.height()), (colors.width(), colors.height())];
        let [d, c] = sizes.map(|(w, h)| format!("{w}x{h}"));
        return Err(Failure::of_file(depth, format!("it is {d}; it must be {c}, as its picture")));
    }
    Ok(Loaded { color: colors, depth: depths })
}
