//! Inputs of explanations from files.

use super::args::ExplainArgs;
use crate::failure::Failure;
use crate::input::{self, display_name};
use crate::messages::Messages;
use durer::explain::Input;
use durer_formats::lesson::{Options, read};
use durer_formats::{Error, Limits};

/// The most bytes that a file with so few things has.
const MOST_BYTES: u64 = 16 << 20;

/// Returns the input that the arguments name: a file or an example.
pub fn input(args: &ExplainArgs, messages: &Messages) -> Result<Input, Failure> {
    let Some(path) = &args.input else {
        return Ok(Input::Example(args.example.clone().unwrap_or_default()));
    };
    let name = display_name(path);
    let work = args.running.work.clone();
    let limits = Limits { decoded_bytes: MOST_BYTES, work, ..Limits::default() };
    let bytes = input::bytes_within(path, &limits)?;
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = input::folder(path);
    let options = Options { limits, window: args.window, seed: args.at };
    let read = read(&bytes, &file, &*folder, &options).map_err(|e| match e {
        // The place of --at.
        Error::Library(e @ durer::Error::Parameter { .. }) => Failure::of_library(&e),
        e @ Error::Library(durer::Error::Limit { .. }) => {
            Failure::Data(format!("{name}: {e}; {}", super::SMALLER))
        }
        e => Failure::Data(format!("{name}: {e}")),
    })?;
    read.warnings.iter().for_each(|warning| messages.warning(&name, warning));
    Ok(read.input)
}
