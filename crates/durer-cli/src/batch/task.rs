//! Messages between a process of `durer batch` and its workers: lines of JSON.

use super::entry::{Entry, Reference};
use crate::sandbox::Sandbox;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The first line to a worker: the settings common to all of its rows.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Setup {
    /// Folder of the outputs.
    pub out: PathBuf,
    /// Folder for files that are not whole.
    pub temporary: PathBuf,
    /// Threads of the worker.
    pub threads: u16,
    /// Bytes of memory for a row.
    pub max_memory: u64,
    /// Seconds for a row.
    pub timeout: Option<f64>,
    /// Restriction of workers to the folders below and the folder of outputs.
    pub sandbox: Option<Sandbox>,
    /// Folders of inputs.
    pub read: Vec<PathBuf>,
}

/// The first line of a worker.
#[derive(Debug, Serialize, Deserialize)]
pub struct Ready {
    /// Its version of durer.
    pub version: String,
    /// Warning about restrictions that the system does not support.
    pub warning: Option<String>,
}

/// A row to run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Task {
    /// Name of the row.
    pub id: String,
    /// Name of the command.
    pub command: String,
    /// Options by name, each as arguments of the command line.
    pub options: Vec<(String, Vec<String>)>,
    /// Paths or data URIs.
    pub inputs: Vec<String>,
    /// Name of the output in its folder.
    pub output: String,
    /// Options that name further outputs, with the names.
    pub planes: Vec<(String, String)>,
    /// Hash that the input must have.
    pub sha256: Option<String>,
    /// An entry in the journal that counts.
    pub known: Option<Known>,
}

/// Facts on which the output of a row depended when it was run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Known {
    /// Its key.
    pub key: String,
    /// Files that the input referred to.
    pub read: Vec<Reference>,
}

/// A line that answers a row.
#[derive(Debug, Serialize, Deserialize)]
pub enum Answer {
    /// The row has the known key, and was not run.
    Same,
    /// The row has this key, and is run now; another answer follows.
    Runs(String),
    /// The row was run.
    Ran(Box<Entry>),
}
