//! Side-by-side measurements of durer's renderer and others; see README.md.

mod child;
mod clock;
mod durer_peer;
mod euc_peer;
mod f3d;
mod frame;
mod growth;
mod layers;
mod llvmpipe;
mod mesh;
mod methods;
mod options;
mod picture;
mod process;
mod scene;
mod shaders;
mod swiftshader;
mod table;
mod vulkan;

use std::process::ExitCode;

/// Any error, reported to the user as it is.
type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const USAGE: &str = "\
usage: durer-peers-render process [FILE…] [--rounds N] [--meshes DIR] [--png DIR]
       durer-peers-render frame [MESH…] [--rounds N] [--samples 1|4] [--png DIR]
       durer-peers-render methods [FILE.stl…] [--rounds N]
       durer-peers-render layers [--rounds N]
       durer-peers-render growth DIR [--rounds N]
       durer-peers-render make DIR

process   whole process, model file in, 1024 × 1024 PNG out: durer and f3d
frame     1920 × 1080 frames in process: durer, euc, llvmpipe where LLVMPIPE_BENCH names its harness,
          SwiftShader where SWIFTSHADER names its library or Debian's chromium has put it; MESH is sphere13k, sphere69k, sphere1m or an STL file
methods   durer's ways to find visible surfaces, 1024 × 1024, beside each other
layers    100 full-screen quads, textured, in three orders: durer and llvmpipe, each with its threads in
          the calling process
growth    a frame's cost by triangles, pixels, overdraw and threads, as charts in DIR
make      writes the meshes as STL, GLB and BMESH";

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("durer-peers-render: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    let mut args = std::env::args().skip(1);
    let command = args.next().ok_or(USAGE)?;
    let options = options::Options::parse(args)?;
    match command.as_str() {
        "process" => process::run(&options),
        "frame" => frame::run(&options),
        "methods" => methods::run(&options),
        "layers" => layers::run(&options),
        "growth" => growth::run(&options),
        "make" => mesh::make(options.names.first().ok_or(USAGE)?.as_ref()),
        _ => Err(USAGE.into()),
    }
}
