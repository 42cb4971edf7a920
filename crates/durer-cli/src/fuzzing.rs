//! The parsers of the command, for the bodies of fuzz targets.

use crate::args::Cli;
use crate::drawing::annotations;
use clap::{CommandFactory, FromArgMatches};

/// Returns the options that take values, each after the name of its subcommand.
pub fn options() -> Vec<[String; 2]> {
    let command = Cli::command();
    let of = |sub: &clap::Command| {
        let name = sub.get_name().to_owned();
        let takes = |arg: &&clap::Arg| arg.get_action().takes_values();
        let longs = sub.get_arguments().filter(takes).filter_map(clap::Arg::get_long);
        longs.map(|long| [name.clone(), format!("--{long}")]).collect::<Vec<_>>()
    };
    command.get_subcommands().flat_map(of).collect()
}

/// Parses a command line without running it; returns the error's message, if there is one.
pub fn command_line(words: &[String]) -> Option<String> {
    let line = std::iter::once("durer").chain(words.iter().map(String::as_str));
    let matches = Cli::command().try_get_matches_from(line);
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    cli.err().map(|error| error.to_string())
}

/// Parses annotations; returns the error's message, if there is one.
pub fn annotations(text: &str) -> Option<String> {
    annotations::parse(text).err()
}
