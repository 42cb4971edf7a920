//! Commands that rows can have, and their options.

use crate::args::Cli;
use crate::failure::Failure;
use crate::given::{self, Given, is_by_hand, is_called, is_flag, is_without_value};
use crate::kind::Kind;
use crate::places::OTHER_INPUTS;
use clap::{Arg, ArgMatches, Command, CommandFactory, ValueHint};
use serde_json::Value;

/// Commands that rows can have.
pub const COMMANDS: [&str; 6] = ["render", "clip", "draw", "plot", "tiles", "info"];

/// Options of the process and not of a row.
const OF_THE_PROCESS: [&str; 13] = [
    "json",
    "quiet",
    "verbose",
    "threads",
    "simd",
    "timeout",
    "max_memory",
    "sandbox",
    "config",
    "no_config",
    "skip_failures",
    "help",
    "version",
];

/// Options that name further outputs.
const PLANES: [&str; 3] = ["item", "depth", "normal"];

/// The parser of all commands.
pub struct Parser(Command);

/// Options of all rows of a command.
#[derive(Debug, Clone)]
pub struct Common {
    /// The command.
    pub command: &'static str,
    /// Its options.
    pub options: Vec<Given>,
}

impl Parser {
    /// Creates the parser.
    pub fn new() -> Self {
        let mut command = Cli::command();
        command.build();
        Self(command)
    }

    /// Returns the command of a name, if rows can have it.
    pub fn command(name: &str) -> Option<&'static str> {
        COMMANDS.into_iter().find(|command| *command == name)
    }

    fn sub(&self, command: &str) -> Option<&Command> {
        self.0.find_subcommand(command)
    }

    /// Returns the option of a command by its long name.
    fn option(&self, command: &str, name: &str) -> Option<&Arg> {
        let of_row = |a: &&Arg| {
            let id = a.get_id().as_str();
            id != "output" && !OF_THE_PROCESS.contains(&id)
        };
        self.sub(command)?.get_arguments().filter(of_row).find(|a| is_called(a, name))
    }

    /// Returns whether the values of an option are files or folders.
    pub fn names_files(&self, command: &str, given: &Given) -> bool {
        let mut arguments = self.sub(command).into_iter().flat_map(Command::get_arguments);
        let hint = arguments.find(|arg| arg.get_id() == &given.id).map(Arg::get_value_hint);
        matches!(hint, Some(ValueHint::FilePath | ValueHint::DirPath | ValueHint::AnyPath))
            || OTHER_INPUTS.contains(&given.id.as_str())
    }

    /// Parses the words after `--`: a command's name, `render` if it is missing, and options.
    pub fn common(&self, words: &[String]) -> Result<Common, Failure> {
        let (command, options) = match words.split_first() {
            Some((first, rest)) if !first.starts_with('-') => (first.as_str(), rest),
            _ => ("render", words),
        };
        let usage = |what: String| Failure::Usage(format!("after --: {what}"));
        let command = Self::command(command)
            .ok_or_else(|| usage(format!("`{command}` is not one of {}", COMMANDS.join(", "))))?;
        let is_output = |w: &&String| w.starts_with("-o") || w.starts_with("--output");
        if let Some(word) = options.iter().find(is_output) {
            let what = "--name or the column `output` names the outputs of rows";
            return Err(usage(format!("{word}: {what}")));
        }
        let output = if command == "info" { vec![] } else { vec!["-o", "output"] };
        let line = ["durer", command].into_iter().chain(options.iter().map(String::as_str));
        let line = line.chain(output).chain(["--", "input"]);
        let matches = match self.0.clone().try_get_matches_from(line) {
            // The formula of a plot is its input.
            Err(_) if command == "plot" => self.0.clone().try_get_matches_from(
                ["durer", command, "-o", "output"]
                    .into_iter()
                    .chain(options.iter().map(String::as_str)),
            ),
            other => other,
        };
        let matches = matches.map_err(|e| usage(given::first_paragraph(&e.to_string())))?;
        let Some(given) = matches.subcommand_matches(command) else {
            return Ok(Common { command, options: Vec::new() });
        };
        let options = self.given(command, given).map_err(usage)?;
        Ok(Common { command, options })
    }

    /// Returns the options that were given.
    fn given(&self, command: &str, given: &ArgMatches) -> Result<Vec<Given>, String> {
        let mut options = Vec::new();
        let arguments = self.sub(command).into_iter().flat_map(Command::get_arguments);
        for arg in arguments.filter(|arg| is_by_hand(given, arg.get_id())) {
            let id = arg.get_id().as_str();
            let raw = || given.get_raw(id).into_iter().flatten();
            let Some(name) = arg.get_long() else {
                if raw().count() > 1 {
                    return Err("inputs are in the manifest, not here".to_owned());
                }
                continue;
            };
            if id == "output" {
                continue;
            }
            if OF_THE_PROCESS.contains(&id) {
                return Err(format!(
                    "--{name}: it is not an option of rows; see `durer batch --help`"
                ));
            }
            let values = match is_flag(arg) {
                true => vec!["true".to_owned()],
                false => raw().map(|value| value.to_string_lossy().into_owned()).collect(),
            };
            options.push(Given::new(arg, name, values));
        }
        Ok(options)
    }

    /// Returns the option that a cell of a row gives; `None` for an empty cell.
    pub fn of_cell(
        &self,
        command: &str,
        name: &str,
        value: &Value,
    ) -> Result<Option<Given>, String> {
        let arg = self.option(command, name).ok_or_else(|| {
            let others = COMMANDS.iter().find(|other| self.option(other, name).is_some());
            let other =
                others.map_or_else(String::new, |other| format!("; `durer {other}` has it"));
            format!("column `{name}`: `durer {command}` has no such option for rows{other}")
        })?;
        let wrong = |what: &str| format!("column `{name}`: {what}");
        let values = match value {
            Value::Null => return Ok(None),
            Value::String(text) if text.is_empty() => return Ok(None),
            Value::Bool(is) if is_flag(arg) => vec![is.to_string()],
            // Python writes True, spreadsheets TRUE.
            Value::String(text) if is_flag(arg) && truth(text).is_some() => {
                vec![text.to_ascii_lowercase()]
            }
            Value::String(text) if is_without_value(arg) && truth(text) == Some(false) => {
                return Ok(None);
            }
            Value::String(text) if is_without_value(arg) && truth(text) == Some(true) => Vec::new(),
            Value::Bool(false) if is_without_value(arg) => return Ok(None),
            Value::Bool(true) if is_without_value(arg) => Vec::new(),
            _ if is_flag(arg) => return Err(wrong("it is a flag: true or false")),
            Value::Array(items) => {
                let items: Option<Vec<String>> = items.iter().map(text).collect();
                let items = items.filter(|items| !items.is_empty());
                given::list(arg, items.ok_or_else(|| wrong("a list has texts or numbers"))?)
            }
            one => vec![text(one).ok_or_else(|| wrong("it takes a text, a number, or a list"))?],
        };
        Ok(Some(Given::new(arg, name, values)))
    }

    /// Returns the options of a row: its own, and the common ones that they neither replace nor exclude.
    pub fn joined(&self, common: &Common, command: &str, own: Vec<Given>) -> Vec<Given> {
        let Some(sub) = self.sub(command).filter(|_| common.command == command) else { return own };
        let stays = |given: &&Given| {
            !own.iter().any(|own| own.id == given.id || given.is_excluded_by(&own.id, sub))
        };
        let kept: Vec<Given> = common.options.iter().filter(stays).cloned().collect();
        kept.into_iter().chain(own).filter(|g| !g.words().is_empty()).collect()
    }
}

/// Returns the truth value of a word, in any case.
fn truth(word: &str) -> Option<bool> {
    [("true", true), ("false", false)]
        .into_iter()
        .find(|(name, _)| word.eq_ignore_ascii_case(name))
        .map(|(_, value)| value)
}

/// Returns a text or a number as on the command line.
pub fn text(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// Divides options into those that name further outputs and the others.
pub fn planes(command: &str, options: Vec<Given>) -> (Vec<Given>, Vec<Given>) {
    options.into_iter().partition(|g| command == "render" && PLANES.contains(&g.id.as_str()))
}

/// Returns the suffix of an output without a name.
pub fn suffix(command: &str, options: &[Given]) -> String {
    let value = |id: &str| {
        let given = options.iter().find(|given| given.id == id)?;
        given.values.first().map(String::as_str)
    };
    match command {
        "info" => "json".to_owned(),
        "tiles" => value("to").unwrap_or("pmtiles").to_owned(),
        "clip" => {
            let format = value("to").and_then(|name| crate::layer::format(name).ok());
            let suffix = format.and_then(|format| format.suffixes().first().copied());
            suffix.unwrap_or("geojson").to_owned()
        }
        "plot" => Kind::of_name(value("to").unwrap_or("png")).suffix().to_owned(),
        _ => Kind::of_name(value("format").unwrap_or("png")).suffix().to_owned(),
    }
}
