//! What can be said on the command line.

mod choices;

pub use choices::{Cull, Samples, Shading, Shadows, ToneMap, UpAxis};

use crate::config::ConfigArgs;
use crate::drawing::args::DrawingArgs;
use crate::encoding::EncodingArgs;
use crate::environment::{self, Environment};
use crate::explode::ExplodeArgs;
use crate::kind::Kind;
use crate::sandbox::Sandbox;
use crate::section::SectionArgs;
use crate::sides::{Sides, sides};
use crate::staging::StageArgs;
use crate::values::{self, Algorithm, Size};
use crate::{color, lights};
use clap::{Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;
use durer::math::{DVec2, DVec3, Rect};
use durer::pipeline::{self, Background, Exposure};
use durer::scene::Light;
use durer::view::layout::Layout;
use durer::view::projection::NamedView;
use std::path::PathBuf;

const ABOUT: &str = "Renders 3D models to pictures and drawings, on the CPU";

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong use; 3 done in part \
(several models with --skip-failures).";

const RENDER_EXAMPLES: &str = "\
Examples:
  durer render bunny.obj -o bunny.png
  durer render bunny.obj -o wide.png --size 800x
  durer render part.stl -o part.png --size 1920x1080 --view front --background transparent
  durer render scene.glb -o scene.png --camera Overview --aa 16
  durer render scene.glb -o scene.png --eye -3.4,1.2,-1.3 --target 0,0.5,0 --fov 35
  durer render part.stl -o sheet.png --viewports front,top,right,iso --size 1600x1200
  durer render part.stl -o part.jpg --quality 80
  durer render part.stl -o turn.webp --turntable 72 --duration 4
  durer render part.stl -o frames/part_%03d.png --turntable 72
  durer render *.stl -o thumbnails/ --size 256x256 --skip-failures
  durer render bunny.obj -o compare.png --algorithm all
  durer render bunny.obj -o bunny.png --light directional:-1,-2,-1:white:3 --shadows map
  durer render bunny.obj -o bunny.png --item items.png --depth depth.png --normal normals.png
  durer render part.stl -o part.svg --view front --hidden dashed
  durer render part.stl -o part.pdf --sheet third-angle --page A3 --hidden dashed
  durer render scene.glb -o scene.png --style regions+lines --size 1600x1200
  curl -s https://example.org/a.glb | durer render - -o - --size 256x256 > a.png

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong use; 3 done in part \
(several models with --skip-failures).";

/// Renders 3D models to pictures, on the CPU.
#[derive(Debug, Parser)]
#[command(name = "durer", version, about = ABOUT, after_help = EXIT_CODES, after_long_help = format!("{}\n\n{EXIT_CODES}", crate::config::HELP), max_term_width = 100)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Where further options are.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render models to pictures (PNG, JPEG, WebP, animations), or draw them as SVG, PDF, DXF, HPGL, G-code or GeoJSON
    #[command(after_long_help = RENDER_EXAMPLES, after_help = "--help shows more, and examples.")]
    Render(Box<RenderArgs>),
    /// Cut map data to windows, polygons or tiles
    #[command(after_long_help = crate::clip::EXAMPLES, after_help = "--help shows more, and examples.")]
    Clip(Box<crate::clip::ClipArgs>),
    /// Make vector tiles of map data for the web: PMTiles, MBTiles, or a file per tile
    #[command(after_long_help = crate::tiles::EXAMPLES, after_help = "--help shows more, and examples.")]
    Tiles(Box<crate::tiles::TilesArgs>),
    /// Leave out points of map data; borders that neighbours share stay shared
    #[command(after_long_help = crate::regions::SIMPLIFY, after_help = "--help shows more, and examples.")]
    Simplify(Box<crate::regions::SimplifyArgs>),
    /// Make polygons that reach a distance farther than features do, or less far
    #[command(after_long_help = crate::regions::BUFFER, after_help = "--help shows more, and examples.")]
    Buffer(Box<crate::regions::BufferArgs>),
    /// Join features that have the same values of some fields
    #[command(after_long_help = crate::regions::DISSOLVE, after_help = "--help shows more, and examples.")]
    Dissolve(Box<crate::regions::DissolveArgs>),
    /// Make polygons valid
    #[command(after_long_help = crate::regions::FIX, after_help = "--help shows more, and examples.")]
    Fix(Box<crate::regions::FixArgs>),
    /// Say what is wrong with polygons, and with a coverage, and where
    #[command(after_long_help = crate::regions::CHECK, after_help = "--help shows more, and examples.")]
    Check(Box<crate::regions::CheckArgs>),
    /// Draw an SVG, or a map of GeoJSON, WKT or WKB layers, to a picture
    #[command(after_long_help = crate::draw::EXAMPLES, after_help = "--help shows more, and examples.")]
    Draw(Box<crate::draw::DrawArgs>),
    /// Fill what is connected with a pixel of a PNG or JPEG, by seed fill
    #[command(after_long_help = crate::fill::EXAMPLES, after_help = "--help shows more, and examples.")]
    Fill(Box<crate::fill::FillArgs>),
    /// Say what is in a model, or in a layer of a map
    Info(InfoArgs),
    /// Say which objects, triangles, lines and points lie behind a point or a rectangle of the picture
    Pick(Box<PickArgs>),
    /// Make a new view from a picture and its depths, for a camera near by
    #[command(after_long_help = crate::warp::EXAMPLES, after_help = "--help shows more, and examples.")]
    Warp(Box<crate::warp::WarpArgs>),
    /// Plot a surface y = f(x, z): a formula or a height map
    #[command(after_long_help = crate::plot::EXAMPLES, after_help = "--help shows more, and examples.")]
    Plot(Box<crate::plot::PlotArgs>),
    /// Write what lets file managers show models as small pictures
    #[command(after_help = crate::thumbnailer::HELP)]
    Thumbnailer(crate::thumbnailer::ThumbnailerArgs),
    /// Write a completion script for a shell to standard output
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write the manual page to standard output, in roff
    Man,
}

/// The options of `durer info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// Models, or map data: GeoJSON, TopoJSON, FlatGeobuf, GeoPackage, Shapefile, CSV, KML, GPX, WKT, WKB; `-` reads a model
    /// from standard input
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub models: Vec<PathBuf>,
    /// Write JSON: one object, or an array of them for several files
    #[arg(long)]
    pub json: bool,
    /// Reading and its limits.
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
}

/// The options of `durer render`.
#[derive(Debug, Clone, Args)]
pub struct RenderArgs {
    /// Models: glTF, GLB, OBJ, STL, PLY, 3MF, COLLADA, OFF, FBX where the build has it, and points in LAS, LAZ,
    /// E57, XYZ, PTS; `-` reads one from standard input
    #[arg(required = true, value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub models: Vec<PathBuf>,
    /// Where the picture goes
    ///
    /// A .png, .jpg or .webp file, or a drawing as .svg, .pdf, .dxf, .hpgl, .gcode or .geojson; `-` for
    /// standard output; a folder (existing, or ending in `/`) for NAME.png of each model. A --turntable goes into
    /// one .png, .webp or .gif, which is animated; or into a file for each frame: in a folder, or by a name with a
    /// place for the frame's number, e.g. `frame_%04d.png`. A missing folder for several pictures is made. A
    /// file is replaced only by a whole picture.
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// The format of the output, also where the name has another ending or none [default: by its suffix, else png]
    #[arg(long, value_name = "FORMAT", value_parser = values::kind())]
    pub format: Option<Kind>,
    /// The options that were given, by their names in the parser.
    #[arg(skip)]
    pub given: Vec<String>,
    /// What the picture is like.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Where the eye is.
    #[command(flatten)]
    pub view: ViewArgs,
    /// How surfaces look.
    #[command(flatten)]
    pub look: LookArgs,
    /// The floor, grid and axes around the model, and edges over it.
    #[command(flatten)]
    pub stage: StageArgs,
    /// Planes that cut the model.
    #[command(flatten)]
    pub section: SectionArgs,
    /// Parts moved apart.
    #[command(flatten)]
    pub explode: ExplodeArgs,
    /// Exact drawings.
    #[command(flatten)]
    pub drawing: DrawingArgs,
    /// Further planes.
    #[command(flatten)]
    pub planes: PlaneArgs,
    /// Reading and its limits.
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
    /// Go on with the next model where one fails; exit code 3 if some failed and some did not
    #[arg(long, help_heading = "Running")]
    pub skip_failures: bool,
    /// Write a report on standard output, in JSON
    ///
    /// Seconds per stage (read, geometry, raster, encode), triangles (in, clipped, culled, drawn,
    /// not finite), warnings, the peak memory of the process where the system tells it, and of each
    /// picture its `status`: `ok`, `empty` where the model has nothing to draw, `invisible` where nothing
    /// of it is seen.
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}

/// The options of `durer pick`.
#[derive(Debug, Args)]
pub struct PickArgs {
    /// The model; `-` reads it from standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// A point of the picture, in pixels from its upper left corner
    ///
    /// x to the right, y downwards; the middle of the first pixel is 0.5,0.5.
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = values::point, required_unless_present = "rect", conflicts_with = "rect")]
    pub at: Option<DVec2>,
    /// A rectangle of the picture, in pixels: two opposite corners
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = values::rect)]
    pub rect: Option<Rect>,
    /// Width and height of the picture in pixels, as for `render`
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, default_value = "1024x1024", value_parser = sides)]
    pub size: Sides,
    /// Write JSON
    #[arg(long)]
    pub json: bool,
    /// Where the eye is.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Reading and its limits.
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// Threads and messages.
    #[command(flatten)]
    pub running: RunningArgs,
}

/// The shape of the output.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Picture")]
pub struct PictureArgs {
    /// Width and height in pixels, or one number for a square
    ///
    /// One side may be left out, `640x` or `x480`, and follows from the shape of what is seen: the model's
    /// outline, where the view fits it; the aspect ratio of a camera of the file; square cells of --viewports.
    #[arg(id = "size", long = "size", value_name = "WxH", allow_hyphen_values = true, default_value = "1024x1024", value_parser = sides)]
    pub sides: Sides,
    /// The same, found where a side was open.
    #[arg(skip)]
    pub size: Size,
    /// How visible surfaces are found [default: z-buffer, or a-buffer where a material blends or
    /// --aa is 64, or ray where --shadows rays or --bounces asks for it]
    #[arg(long, value_name = "NAME", value_parser = values::algorithm())]
    pub algorithm: Option<Algorithm>,
    /// Samples per pixel, where the algorithm takes several
    ///
    /// The A-buffer has masks of 16 sub-pixels, or of 64 for 64.
    #[arg(long, visible_alias = "samples", value_name = "N", default_value = "4")]
    pub aa: Samples,
    /// A colour, `transparent`, `gradient`, or TOP,BOTTOM
    ///
    /// Colours are #rgb, #rrggbb, #rrggbbaa, or a name such as white, black, silver, navy.
    #[arg(long, value_name = "COLOR", default_value = "white", value_parser = color::background)]
    pub background: Background,
    /// Several views in one picture
    ///
    /// Views joined by commas, e.g. `front,top,right,iso`, in as square a grid as possible; columns
    /// and rows may be given first: `3x1:front,right,iso`. Each view fits the model.
    #[arg(long, value_name = "LAYOUT", value_parser = crate::camera::layout, conflicts_with_all = ["view", "azimuth", "elevation", "eye", "camera"])]
    pub viewports: Option<Layout>,
    /// N pictures around the up axis, in one animated file or in one file each
    #[arg(long, value_name = "N", allow_hyphen_values = true, conflicts_with = "viewports", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub turntable: Option<u32>,
    /// Frames a second, where a turntable goes into one file [default: 24]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::positive, requires = "turntable")]
    pub fps: Option<f64>,
    /// Seconds of a whole turn, where it goes into one file [default: by --fps]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::positive, requires = "turntable", conflicts_with = "fps")]
    pub duration: Option<f64>,
    /// Compression and quality of the file.
    #[command(flatten)]
    pub encoding: EncodingArgs,
    /// Refuse pictures of more pixels; the default is 16384x16384
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "268435456", value_parser = values::count)]
    pub max_pixels: u64,
}

/// The camera: a named view, angles, a place, or one of the file's.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "View")]
pub struct ViewArgs {
    /// iso, front, back, left, right, top or bottom; fits the model into the picture
    #[arg(long, value_name = "VIEW", default_value = "iso",  conflicts_with_all = ["azimuth", "elevation", "eye", "camera"])]
    pub view: NamedView,
    /// Degrees around the up axis from the front, to the right; fits the model
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::number, conflicts_with_all = ["eye", "camera"])]
    pub azimuth: Option<f64>,
    /// Degrees above the horizon, -90 to 90; fits the model
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::elevation, conflicts_with_all = ["eye", "camera"])]
    pub elevation: Option<f64>,
    /// Where the eye is, in the world of the file
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, conflicts_with = "camera")]
    pub eye: Option<DVec3>,
    /// What the eye looks at [default: the middle of the model]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::vector, requires = "eye")]
    pub target: Option<DVec3>,
    /// What is up in the picture [default: the up axis]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = values::direction, requires = "eye")]
    pub up: Option<DVec3>,
    /// Vertical angle of view in degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = values::angle_of_view, conflicts_with_all = ["ortho", "camera"])]
    pub fov: Option<f64>,
    /// Parallel projection; the height of the view in world units, or `fit`
    #[arg(long, value_name = "HEIGHT", allow_hyphen_values = true, value_parser = crate::camera::ortho, conflicts_with = "camera")]
    pub ortho: Option<crate::camera::Ortho>,
    /// Distance of the near plane [default: by the model]
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true, value_parser = values::number)]
    pub near: Option<f64>,
    /// Distance of the far plane [default: by the model]
    #[arg(long, value_name = "DISTANCE", allow_hyphen_values = true, value_parser = values::number)]
    pub far: Option<f64>,
    /// A camera of the file, by its name; `durer info` lists them
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Which axis is up: x, y, z, -x, -y or -z [default: by the format]
    #[arg(long, value_name = "AXIS", ignore_case = true, allow_hyphen_values = true)]
    pub up_axis: Option<UpAxis>,
}

/// Light and surfaces.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Look")]
pub struct LookArgs {
    /// How surfaces are shaded [default: by the material]
    #[arg(long, value_name = "MODEL")]
    pub shading: Option<Shading>,
    /// A light; replaces the default three-point light or the file's own
    #[arg(long, value_name = "LIGHT", allow_hyphen_values = true, long_help = lights::SYNTAX, value_parser = lights::light)]
    pub light: Vec<Light>,
    /// Which faces are left out
    #[arg(long, value_name = "WHICH", default_value = "material")]
    pub cull: Cull,
    /// Width of a model's lines in pixels
    #[arg(long, value_name = "PIXELS", allow_hyphen_values = true, default_value = "1.5", value_parser = values::pixels)]
    pub line_width: f64,
    /// Side of a model's points in pixels
    #[arg(long, value_name = "PIXELS", allow_hyphen_values = true, default_value = "3", value_parser = values::pixels)]
    pub point_size: f64,
    /// The colour of what has no material [default: light grey; of lines and points what is seen
    /// against the background]
    #[arg(long, value_name = "COLOR", value_parser = color::color)]
    pub color: Option<durer::math::Vec4>,
    /// Whether surfaces keep light from others
    #[arg(long, value_name = "HOW", default_value = "none")]
    pub shadows: Shadows,
    /// Texels along the side of a shadow map
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "2048", value_parser = clap::value_parser!(u32).range(1..=16384), requires = "shadows")]
    pub shadow_map: u32,
    /// How often rays are reflected by mirrors and refracted by what blends
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value = "0", value_parser = clap::value_parser!(u32).range(0..=32))]
    pub bounces: u32,
    /// Exposure of the light: `auto`, or a number of EV
    ///
    /// `auto` makes all lights stronger or weaker by one factor, so that white matte surfaces where much of
    /// their light falls are nearly white. EV shows light as the file or --light gives it (at 0 one of
    /// strength 1, or of pi lux, makes white), times two to this power, with the light of what shines by
    /// itself. Default: auto for the file's own lights and for --environment FILE, else 0.
    #[arg(long, value_name = "EV", allow_hyphen_values = true, value_parser = lights::exposure)]
    pub exposure: Option<Exposure>,
    /// Surroundings that mirrors show: `studio`, `none`, or a panorama in a Radiance file (.hdr)
    ///
    /// In a studio stand bright screens, which metals and what is smooth mirror; `none` leaves but a sky over
    /// the ground. A panorama (equirectangular) lights the model too, in place of the default light and
    /// beside the file's or --light.
    #[arg(long, value_name = "WHAT", default_value = "studio", value_hint = ValueHint::FilePath, value_parser = environment::environment)]
    pub environment: Environment,
    /// Tone map that brings bright light into the range of the picture
    #[arg(long, value_name = "MAP", default_value = "none")]
    pub tone_map: ToneMap,
    /// The surroundings that were read for --environment.
    #[arg(skip)]
    pub surroundings: std::sync::OnceLock<pipeline::Surroundings>,
}

/// Pictures of other planes than colour.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Further pictures")]
pub struct PlaneArgs {
    /// The visible triangle of each pixel
    ///
    /// A PNG whose colour is the triangle's index as R<<16|G<<8|B, 0xFFFFFF where there is none.
    /// Triangles count in file order, over all parts of the scene; a face of n vertices is n − 2
    /// triangles (others where its outline has spikes or crosses itself): those from its first
    /// vertex, or where these would not cover it, as in concave faces, others. One sample at the pixel's centre, whatever --aa says.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub item: Option<PathBuf>,
    /// The depth of each pixel
    ///
    /// A 16-bit grey PNG: window depth (0 at the near plane, 1 at the far) times 65535, 65535 where
    /// there is nothing. One sample at the pixel's centre. Give --near and --far to compare pictures.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub depth: Option<PathBuf>,
    /// The normal of each pixel
    ///
    /// A PNG whose colour is the unit normal in world space, each component n as n/2 + 1/2;
    /// (128, 128, 128) where there is nothing. One sample at the pixel's centre.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub normal: Option<PathBuf>,
}

/// What is read of a model, and how much.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Reading")]
pub struct ReadingArgs {
    /// Pose the model at this animation, by name or number [default: the first, given --time]
    #[arg(long, value_name = "NAME")]
    pub animation: Option<String>,
    /// Pose the model at this time of the animation
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::not_negative)]
    pub time: Option<f64>,
    /// Show the model in this variant of its materials, by name or number; `durer info` lists them
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
    /// Let the lights of COLLADA and FBX files shine; those of glTF always do
    #[arg(long)]
    pub own_lights: bool,
    /// Let references lead to any file below this folder [default: the model's own folder]
    ///
    /// Textures, buffers and material libraries are read from the model's folder alone, whatever links and `..`
    /// lead to; with this also from below another one, for example one above it. Of a model from standard input,
    /// references start there.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub root: Option<PathBuf>,
    /// Read only what stands on this plate, counted from 1, of a project of Bambu Studio or OrcaSlicer [default: all plates]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub plate: Option<u32>,
    /// Refuse models of more triangles, lines and points [default: 100 million]
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::count)]
    pub max_triangles: Option<u64>,
    /// Refuse models that are, or unpack to, more bytes; k, M, G are understood [default: 4G]
    #[arg(long, value_name = "BYTES", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_bytes: Option<u64>,
}

/// How the command runs.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Running")]
pub struct RunningArgs {
    /// Work on so many threads [default: as many as there are processors]; the pictures are the same
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Work with these SIMD instructions, e.g. sse2 [default: the best of the machine]; the pictures are the same
    #[arg(long, value_name = "LEVEL", value_parser = values::simd_level)]
    pub simd: Option<durer::simd::Level>,
    /// Take no more memory than this for the work, in bytes; k, M, G are understood [default: half of what the machine or its
    /// control group allows, at most 4G]
    ///
    /// Work that needs more ends with an error that names the stage and the option. The other limits of size count towards
    /// this one.
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = values::bytes)]
    pub max_memory: Option<u64>,
    /// End with an error after so many seconds [default: never]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = values::positive)]
    pub timeout: Option<f64>,
    /// The budget, and what stops the work.
    #[arg(skip)]
    pub work: durer::work::Work,
    /// Open nothing but the folders of what is read and of what is written, by Landlock (Linux)
    ///
    /// A fault in a reader can then neither read nor change other files, nor open connections. Where the system
    /// cannot do that, the command ends with an error, or with `best-effort` goes on with a warning.
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "strict")]
    pub sandbox: Option<Sandbox>,
    /// No warnings and no progress; errors are still told
    #[arg(short, long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// All warnings, and what was done
    #[arg(short, long)]
    pub verbose: bool,
}
