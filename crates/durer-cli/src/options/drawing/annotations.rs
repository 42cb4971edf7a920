//! The options of annotations.

use clap::{Args, ValueEnum, ValueHint};
use durer::annotate::{Thread, ThreadSize};
use std::path::PathBuf;

/// Centre lines, dimensions, threads.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Annotations")]
pub struct AnnotationArgs {
    /// Draw centre lines and centre marks of round parts, and pitch circles of holes
    ///
    /// Cylinders of at least 12 facets count, and parts of them from 170° on. In the layer `center`.
    #[arg(long)]
    pub center_lines: bool,
    /// Dimensions to be put beside the views, joined by commas: size, holes, bosses
    ///
    /// `size` is how large the whole is, each direction once; `holes` are diameters of holes and `bosses` of other
    /// cylinders, those that are alike once, with their number. In units of the model, in the layer `dimension`.
    #[arg(long, value_name = "WHICH", value_delimiter = ',')]
    pub dimension: Vec<Dimensioned>,
    /// Take dimensions, notes and threads from this file
    ///
    /// TOML, with [[dimension]] tables: `kind` linear (`from`, `to`, `along`), diameter or radius (`of`), angle
    /// (`vertex`, `from`, `to`), note (`at`); each with `view`, `side` and `text` where wanted, in which <> is what is
    /// measured. Places are points, [x, y, z] in units of the model, or round parts by name: "hole 1", "boss 2",
    /// "fillet 1", numbered in the order of the file as --json lists them, or the name of an object with just one. And
    /// [[thread]] tables with `name` and `size`.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub annotations: Option<PathBuf>,
    /// Draw the cylinders of an object, or a round part such as `hole 1`, as threads; may be repeated
    ///
    /// With a size they are labelled, too: `--thread bolt=M8`, or M8x1 for other pitches than the coarse one.
    #[arg(long, value_name = "NAME[=SIZE]", value_parser = thread)]
    pub thread: Vec<Thread>,
}

/// `--dimension`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Dimensioned {
    /// The size of the whole
    Size,
    /// The diameters of holes
    Holes,
    /// The diameters of cylinders that are no holes
    Bosses,
}

/// Reads a name, and a size where there is one.
pub fn thread(text: &str) -> Result<Thread, String> {
    let (name, size) = match text.rsplit_once('=') {
        Some((name, size)) => {
            let size: ThreadSize = size.parse().map_err(|e: durer::Error| e.to_string())?;
            (name, Some(size))
        }
        None => (text, None),
    };
    match name.trim() {
        "" => Err("it has no name; e.g. bolt=M8".to_owned()),
        name => Ok(Thread { name: name.to_owned(), size }),
    }
}
