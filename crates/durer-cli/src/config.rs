//! A file of options, `durer.toml`: its keys become defaults of the parser, so that values are checked as on the
//! command line, which takes precedence.

mod settings;

use crate::draw;
use crate::failure::Failure;
use crate::given::{Given, is_by_hand};
use crate::input;
use clap::builder::Resettable;
use clap::{ArgMatches, Args, Command, Id, ValueHint};
use settings::{Setting, read};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The file that is taken if none is named.
const NAME: &str = "durer.toml";

/// More than anybody writes.
const MOST_BYTES: u64 = 1 << 20;

/// Text about the file of options at the end of the help.
pub const HELP: &str = "\
Options can also be set in a file, `durer.toml` in the current folder or --config FILE, under their command:
  [render]
  size = 512
  background = \"transparent\"
  light = [\"ambient:white:0.2\", \"directional:-1,-2,-1\"]
Flags are true or false, lists of numbers may be arrays, and paths are relative to the file. The command line \
overrides the file, and --no-config ignores it.";

/// File with further options.
#[derive(Debug, Clone, Args)]
pub struct ConfigArgs {
    /// Read options from this file [default: durer.toml, if it exists]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, global = true, conflicts_with = "no_config", help_heading = "Running")]
    pub config: Option<PathBuf>,
    /// Ignore durer.toml
    #[arg(long, global = true, help_heading = "Running")]
    pub no_config: bool,
}

/// The parser with the defaults of a file, and the command line for it.
pub struct Configured {
    /// Parser that knows the defaults.
    pub command: Command,
    /// Arguments as given, except for values that a file writes differently.
    pub line: Vec<OsString>,
    /// The file, if there is one.
    pub file: Option<PathBuf>,
}

/// Makes the options of the file, if there is one, defaults of a command line.
pub fn configured(command: Command, line: Vec<OsString>) -> Result<Configured, Failure> {
    let named = line.iter().any(|word| word.to_string_lossy().starts_with("--config"));
    if !named && !Path::new(NAME).is_file() {
        return Ok(Configured { command, line, file: None });
    }
    // Errors of the line are reported later, when the file's options are known.
    let given = command.clone().ignore_errors(true).try_get_matches_from(&line);
    let given = given.ok().and_then(|mut matches| matches.remove_subcommand());
    let Some((name, given)) = given else { return Ok(Configured { command, line, file: None }) };
    let Some(file) = file(&given) else { return Ok(Configured { command, line, file: None }) };
    let text = text(&file)?;
    let mut built = command.clone();
    built.build();
    let settings = read(&file, &text, &built, &name)?;
    let Some(sub) = built.find_subcommand(&name) else {
        return Ok(Configured { command, line, file: None });
    };
    check_pairs(&file, &settings, sub)?;
    let by_hand: Vec<&Id> =
        sub.get_arguments().map(clap::Arg::get_id).filter(|id| is_by_hand(&given, id)).collect();
    let excluded = |s: &Setting| by_hand.iter().any(|id| s.given.is_excluded_by(id, sub));
    let settings = settings.into_iter().filter(|s| !excluded(s));
    let (words, defaults): (Vec<_>, Vec<_>) =
        settings.partition(|s| name == "draw" && draw::is_style(&s.given.id));
    let line = with_words(line, &name, &words);
    let command = command.mut_subcommand(&name, |sub| defaults.into_iter().fold(sub, with_default));
    Ok(Configured { command, line, file: Some(file) })
}

/// Returns the file that is named, or the one that is there.
fn file(given: &ArgMatches) -> Option<PathBuf> {
    if given.get_flag("no_config") {
        return None;
    }
    let named = given.get_one::<PathBuf>("config").cloned();
    named.or_else(|| Some(PathBuf::from(NAME)).filter(|p| p.is_file()))
}

fn text(file: &Path) -> Result<String, Failure> {
    let bytes = input::bytes(file, MOST_BYTES)?;
    String::from_utf8(bytes).map_err(|_| Failure::of_file(file, "the text is not UTF-8"))
}

/// Refuses two settings that exclude each other.
fn check_pairs(file: &Path, settings: &[Setting], sub: &Command) -> Result<(), Failure> {
    for (i, setting) in settings.iter().enumerate() {
        for earlier in &settings[..i] {
            if setting.given.is_excluded_by(&earlier.given.id, sub) {
                let (one, other) = (&earlier.given.key, &setting.given.key);
                let message = format!("`{one}` and `{other}` exclude each other");
                return Err(setting.wrong(file, &message));
            }
        }
    }
    Ok(())
}

/// Returns the command line with settings right behind the command's name.
fn with_words(mut line: Vec<OsString>, name: &str, settings: &[Setting]) -> Vec<OsString> {
    let words = settings.iter().flat_map(|s| s.given.words()).map(OsString::from);
    // The name is the first word that is neither an option nor the file of --config.
    let mut after_config = false;
    let place = line.iter().skip(1).position(|word| {
        let found = !after_config && word == name;
        after_config = word == "--config";
        found
    });
    if let Some(place) = place {
        let behind = place + 2;
        line.splice(behind..behind, words);
    }
    line
}

fn with_default(sub: Command, setting: Setting) -> Command {
    let Given { id, values, .. } = setting.given;
    sub.mut_arg(id, |arg| {
        arg.required(false).required_unless_present(Resettable::Reset).default_values(values)
    })
}
