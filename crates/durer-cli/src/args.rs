//! The subcommands.

use crate::config::ConfigArgs;
use crate::encoding::EncodingArgs;
use crate::given::is_by_hand;
use crate::info::InfoArgs;
use crate::options::RunningArgs;
use crate::pick::PickArgs;
use crate::render_args::RenderArgs;
use crate::watch;
use clap::{ArgMatches, FromArgMatches, Parser, Subcommand};
use clap_complete::Shell;

const ABOUT: &str = "Renders 3D models to pictures and drawings, on the CPU";

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 bad data, or a file that cannot be read or written; 2 wrong usage; 3 partly done \
(several models with --skip-failures, rows of a batch).";

/// Renders 3D models to pictures, on the CPU.
#[derive(Debug, Parser)]
#[command(name = "durer", version, about = ABOUT, after_help = EXIT_CODES, after_long_help = format!("{}\n\n{EXIT_CODES}", crate::config::HELP), max_term_width = 100)]
pub struct Cli {
    /// Subcommand to run.
    #[command(subcommand)]
    pub command: Command,
    /// File with further options.
    #[command(flatten)]
    pub config: ConfigArgs,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render models to pictures (PNG, JPEG, WebP, animations), or draw them as SVG, PDF, DXF, HPGL, G-code or GeoJSON
    #[command(after_long_help = crate::render_args::EXAMPLES, after_help = "--help shows more, and examples.")]
    Render(Box<RenderArgs>),
    /// Cut map data to windows, polygons or tiles
    #[command(after_long_help = crate::clip::EXAMPLES, after_help = "--help shows more, and examples.")]
    Clip(Box<crate::clip::ClipArgs>),
    /// Cut map data into vector tiles for the web: PMTiles, MBTiles, or one file per tile
    #[command(after_long_help = crate::tiles::EXAMPLES, after_help = "--help shows more, and examples.")]
    Tiles(Box<crate::tiles::TilesArgs>),
    /// Remove points from map data; borders that neighbours share stay shared
    #[command(after_long_help = crate::regions::SIMPLIFY, after_help = "--help shows more, and examples.")]
    Simplify(Box<crate::regions::SimplifyArgs>),
    /// Grow or shrink features by a distance
    #[command(after_long_help = crate::regions::BUFFER, after_help = "--help shows more, and examples.")]
    Buffer(Box<crate::regions::BufferArgs>),
    /// Join features that have the same values of some fields
    #[command(after_long_help = crate::regions::DISSOLVE, after_help = "--help shows more, and examples.")]
    Dissolve(Box<crate::regions::DissolveArgs>),
    /// Make polygons valid
    #[command(after_long_help = crate::regions::FIX, after_help = "--help shows more, and examples.")]
    Fix(Box<crate::regions::FixArgs>),
    /// Report invalid polygons and coverage errors, with their places
    #[command(after_long_help = crate::regions::CHECK, after_help = "--help shows more, and examples.")]
    Check(Box<crate::regions::CheckArgs>),
    /// Draw an SVG file, or a map with layers, as a picture or as vectors
    #[command(after_long_help = crate::draw::EXAMPLES, after_help = "--help shows more, and examples.")]
    Draw(Box<crate::draw::DrawArgs>),
    /// Fill the connected area around a pixel of a PNG or JPEG
    #[command(after_long_help = crate::fill::EXAMPLES, after_help = "--help shows more, and examples.")]
    Fill(Box<crate::fill::FillArgs>),
    /// Describe a model, or the layers of a map
    Info(Box<InfoArgs>),
    /// List the objects, triangles, lines and points at a point or in a rectangle of the picture
    Pick(Box<PickArgs>),
    /// Compute the view of a nearby camera from a picture and its depths
    #[command(after_long_help = crate::warp::EXAMPLES, after_help = "--help shows more, and examples.")]
    Warp(Box<crate::warp::WarpArgs>),
    /// Plot a surface y = f(x, z): a formula or a height map
    #[command(after_long_help = crate::plot::EXAMPLES, after_help = "--help shows more, and examples.")]
    Plot(Box<crate::plot::PlotArgs>),
    /// List the algorithms, with the space, occluder and coherence that they are classified by
    #[command(after_long_help = crate::algorithms::EXAMPLES, after_help = "--help shows more, and examples.")]
    Algorithms(crate::algorithms::AlgorithmsArgs),
    /// Explain an algorithm step by step: a sheet of pictures, a page with buttons, or data
    #[command(after_long_help = crate::explain::EXAMPLES, after_help = "--help shows more, and examples.")]
    Explain(Box<crate::explain::ExplainArgs>),
    /// Show the explorer, all algorithms step by step on your own input, in the browser
    #[command(after_long_help = crate::explore::EXAMPLES, after_help = "--help shows more, and examples.")]
    Explore(crate::explore::ExploreArgs),
    /// Run the rows of a table, each in a process that may fail: renderings, clips, drawings by the million, also on
    /// many machines
    #[command(after_long_help = crate::batch_args::EXAMPLES, after_help = "--help shows more, and examples.")]
    Batch(Box<crate::batch_args::BatchArgs>),
    /// Run the rows that `durer batch` writes to standard input
    #[command(hide = true)]
    BatchWorker,
    /// Write the file that lets file managers show thumbnails of models
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

impl Command {
    /// Returns the command of a parsed line, with its budget; where it matters, records which options were given by
    /// hand.
    pub fn of(matches: &ArgMatches) -> clap::error::Result<Self> {
        let mut command = Cli::from_arg_matches(matches)?.command;
        let Some((_, given)) = matches.subcommand() else { return Ok(command) };
        let names: Vec<String> =
            given.ids().filter(|id| is_by_hand(given, id)).map(ToString::to_string).collect();
        if let Some(encoding) = command.encoding() {
            let given = |id: &str| names.iter().any(|name| name == id);
            (encoding.compression_given, encoding.quality_given) =
                (given("compression"), given("quality"));
        }
        match &mut command {
            Self::Render(args) => args.given = names,
            Self::Plot(args) => args.given = names,
            _ => {}
        }
        if let Some(running) = command.running() {
            running.work = watch::work(running);
        }
        Ok(command)
    }

    /// Returns the options about threads, limits and messages, if the command has them.
    pub fn running(&mut self) -> Option<&mut RunningArgs> {
        Some(match self {
            Self::Render(args) => &mut args.running,
            Self::Info(args) => &mut args.running,
            Self::Clip(args) => &mut args.running,
            Self::Buffer(args) => &mut args.files.running,
            Self::Dissolve(args) => &mut args.files.running,
            Self::Fix(args) => &mut args.files.running,
            Self::Check(args) => &mut args.running,
            Self::Tiles(args) => &mut args.running,
            Self::Simplify(args) => &mut args.files.running,
            Self::Warp(args) => &mut args.running,
            Self::Draw(args) => &mut args.running,
            Self::Fill(args) => &mut args.running,
            Self::Pick(args) => &mut args.running,
            Self::Plot(args) => &mut args.running,
            Self::Explain(args) => &mut args.running,
            Self::Algorithms(_)
            | Self::Explore(_)
            | Self::Thumbnailer(_)
            | Self::Batch(_)
            | Self::BatchWorker
            | Self::Completions { .. }
            | Self::Man => return None,
        })
    }

    /// Returns the encoding options, where it makes pictures.
    fn encoding(&mut self) -> Option<&mut EncodingArgs> {
        match self {
            Self::Render(args) => Some(&mut args.picture.encoding),
            Self::Draw(args) => Some(&mut args.picture.encoding),
            Self::Fill(args) => Some(&mut args.file.encoding),
            Self::Warp(args) => Some(&mut args.file.encoding),
            Self::Plot(args) => Some(&mut args.look.encoding),
            _ => None,
        }
    }
}
