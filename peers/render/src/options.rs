//! The command line.

use crate::{Result, USAGE};
use std::path::PathBuf;

/// Options of both measurements.
pub struct Options {
    /// Files or meshes.
    pub names: Vec<String>,
    /// Number of turns of each contender.
    pub rounds: usize,
    /// Samples per pixel; `None` = 1 and 4.
    pub samples: Option<u32>,
    /// Folder for pictures.
    pub png: Option<PathBuf>,
    /// Folder of the meshes made by `make`; `None` = they are made.
    pub meshes: Option<PathBuf>,
}

impl Options {
    /// Seven rounds, unless something else is said.
    pub fn parse(mut args: impl Iterator<Item = String>) -> Result<Self> {
        let mut options =
            Self { names: Vec::new(), rounds: 7, samples: None, png: None, meshes: None };
        while let Some(arg) = args.next() {
            let mut value = || args.next().ok_or(USAGE);
            match arg.as_str() {
                "--rounds" => options.rounds = value()?.parse::<usize>()?.max(1),
                "--samples" => options.samples = Some(value()?.parse()?),
                "--png" => options.png = Some(value()?.into()),
                "--meshes" => options.meshes = Some(value()?.into()),
                option if option.starts_with('-') => return Err(USAGE.into()),
                _ => options.names.push(arg),
            }
        }
        if let Some(folder) = &options.png {
            std::fs::create_dir_all(folder)?;
        }
        Ok(options)
    }
}
