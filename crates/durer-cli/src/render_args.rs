//! The options of `durer render`.

use crate::explode::ExplodeArgs;
use crate::kind::Kind;
use crate::options::drawing::DrawingArgs;
use crate::options::{LookArgs, PictureArgs, PlaneArgs, ReadingArgs, RunningArgs, ViewArgs};
use crate::section::SectionArgs;
use crate::staging::StageArgs;
use crate::values;
use clap::{Args, ValueHint};
use std::path::PathBuf;

pub const EXAMPLES: &str = "\
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
  durer render a/*.stl b/*.stl -o 'thumbnails/{folder}/{stem}.png' --size 256x256
  durer render bunny.obj -o compare.png --algorithm all
  durer render bunny.obj -o bunny.png --light directional:-1,-2,-1:white:3 --shadows map
  durer render bunny.obj -o bunny.png --item items.png --depth depth.png --normal normals.png
  durer render part.stl -o part.svg --view front --hidden dashed
  durer render part.stl -o part.pdf --sheet third-angle --page A3 --hidden dashed
  durer render scene.glb -o scene.png --style regions+lines --size 1600x1200
  curl -s https://example.org/a.glb | durer render - -o - --size 256x256 > a.png

Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 partly done \
(several models with --skip-failures).";

/// The options of `durer render`.
#[derive(Debug, Clone, Args)]
pub struct RenderArgs {
    /// Models: glTF, GLB, OBJ, STL, PLY, 3MF, COLLADA, OFF, FBX where the build has it, and points in LAS, LAZ,
    /// E57, XYZ, PTS, or lines of numbers; `-` reads one from standard input
    #[arg(required = true, value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub models: Vec<PathBuf>,
    /// File to write the picture to
    ///
    /// A .png, .jpg or .webp file, or a drawing as .svg, .pdf, .dxf, .hpgl, .gcode or .geojson; `-` for standard
    /// output; a folder (existing, or ending in `/`) for NAME.png of each model. The file's name may have {stem} (the
    /// model's name without its suffix), {name} (with it) and {folder} (its folder): two pictures with one name are an
    /// error, and 'out/{folder}/{name}.png' keeps them apart. A --turntable goes into one .png, .webp or .gif, which is
    /// animated; or into a file for each frame: in a folder, or by a name with a place for the frame's number, e.g.
    /// `frame_%04d.png`. A missing folder for several pictures is created. A file is only ever replaced by a complete
    /// picture.
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// The format of the output, independent of the name's suffix [default: by the suffix, else png]
    #[arg(long, value_name = "FORMAT", value_parser = values::kind())]
    pub format: Option<Kind>,
    /// The options that were given, by their names in the parser.
    #[arg(skip)]
    pub given: Vec<String>,
    /// Options for the picture.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Options for the camera.
    #[command(flatten)]
    pub view: ViewArgs,
    /// Options for the look of surfaces.
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
    /// Continue with the next model if one fails; exit code 3 if some failed and some did not
    #[arg(long, help_heading = "Running")]
    pub skip_failures: bool,
    /// Write a report on standard output, in JSON
    ///
    /// Seconds per stage (read, geometry, raster, encode), triangles (in, clipped, culled, drawn, not
    /// finite), warnings, the peak memory of the process if the system reports it, and the `status` of
    /// each picture: `ok`, `empty` if the model has nothing to draw, `invisible` if nothing of it is
    /// visible.
    #[arg(long, help_heading = "Running")]
    pub json: bool,
}
