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
    /// Cylinders with at least 12 facets count, and parts of cylinders from 170°. They are in the
    /// layer `center`.
    #[arg(long)]
    pub center_lines: bool,
    /// Dimensions to place beside the views, joined by commas: size, holes, bosses
    ///
    /// `size` gives the extent of the model in each direction, `holes` the diameters of holes, and `bosses` the
    /// diameters of other cylinders; equal ones are dimensioned once, with their number. Dimensions are in units of the
    /// model, in the layer `dimension`.
    #[arg(long, value_name = "WHICH", value_delimiter = ',')]
    pub dimension: Vec<Dimensioned>,
    /// Read dimensions, notes and threads from this file
    ///
    /// TOML, with [[dimension]] tables: `kind` linear (`from`, `to`, `along`), diameter or radius (`of`), angle
    /// (`vertex`, `from`, `to`), note (`at`); each with optional `view`, `side` and `text`, in which <> is replaced by
    /// the measured value. Places are points, [x, y, z] in units of the model, or round parts by name: "hole 1", "boss
    /// 2", "fillet 1", numbered in the order of the file as --json lists them, or the name of an object with just one.
    /// And [[thread]] tables with `name` and `size`.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub annotations: Option<PathBuf>,
    /// Draw the cylinders of an object, or a round part such as `hole 1`, as threads; may be repeated
    ///
    /// With a size, threads are labelled: `--thread bolt=M8`, or M8x1 for a pitch other than the coarse one.
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
    /// The diameters of cylinders that are not holes
    Bosses,
}

/// Reads a name, and a size if there is one.
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
