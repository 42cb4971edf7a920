//! Keys and values of the file, each checked by the parser of its option.

use crate::failure::Failure;
use crate::given::{self, Given, first_paragraph, is_called, is_flag};
use crate::toml_words::fault;
use clap::error::ErrorKind;
use clap::{Arg, Command, ValueHint};
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Options that are about the file itself, or about no work.
const NOT_IN_FILES: &[&str] = &["config", "no_config", "help", "version"];

/// An option as the file has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// The option and its values.
    pub given: Given,
    /// Line in the file, counted from 1.
    line: usize,
}

impl Setting {
    /// Returns a failure at its place.
    pub fn wrong(&self, file: &Path, what: &str) -> Failure {
        wrong(file, self.line, what)
    }
}

fn wrong(file: &Path, line: usize, what: &str) -> Failure {
    Failure::Usage(format!("{}: line {line}: {what}", file.display()))
}

/// The text with where its lines are.
struct Source<'a> {
    file: &'a Path,
    text: &'a str,
}

impl Source<'_> {
    fn line(&self, offset: usize) -> usize {
        self.text.bytes().take(offset).filter(|b| *b == b'\n').count() + 1
    }

    fn wrong(&self, offset: usize, what: &str) -> Failure {
        wrong(self.file, self.line(offset), what)
    }
}

/// Reads the settings of all commands and returns the ones of one command.
pub fn read(
    file: &Path,
    text: &str,
    command: &Command,
    name: &str,
) -> Result<Vec<Setting>, Failure> {
    let source = Source { file, text };
    let table = DeTable::parse(text)
        .map_err(|e| source.wrong(e.span().map_or(0, |s| s.start), fault(e.message())))?;
    let mut wanted = Vec::new();
    for (key, value) in table.get_ref() {
        let (title, place) = (key.get_ref(), key.span().start);
        let DeValue::Table(keys) = value.get_ref() else {
            let what = format!("`{title}`: options belong under their command, e.g. [render]");
            return Err(source.wrong(place, &what));
        };
        let Some(sub) = command.find_subcommand(title.as_ref()) else {
            let what = format!("[{title}]: there is no such command; `durer --help` lists them");
            return Err(source.wrong(place, &what));
        };
        let settings = settings(&source, sub, keys)?;
        if sub.get_name() == name {
            wanted = settings;
        }
    }
    Ok(wanted)
}

fn settings(source: &Source, sub: &Command, keys: &DeTable) -> Result<Vec<Setting>, Failure> {
    let mut settings: Vec<Setting> = Vec::new();
    for (key, value) in keys {
        let setting = setting(source, sub, key, value)?;
        if settings.iter().any(|s| s.given.id == setting.given.id) {
            let what =
                format!("`{}`: the option is also given under another name", setting.given.key);
            return Err(setting.wrong(source.file, &what));
        }
        settings.push(setting);
    }
    settings.sort_by_key(|s| s.line);
    Ok(settings)
}

fn setting<S: AsRef<str>>(
    source: &Source,
    sub: &Command,
    key: &Spanned<S>,
    value: &Spanned<DeValue>,
) -> Result<Setting, Failure> {
    let name = key.get_ref().as_ref();
    let fail = |what: &str| source.wrong(key.span().start, &format!("`{name}`: {what}"));
    let in_files = |a: &&Arg| !NOT_IN_FILES.contains(&a.get_id().as_str());
    let arg =
        sub.get_arguments().filter(in_files).find(|a| is_called(a, name)).ok_or_else(|| {
            let command = sub.get_name();
            fail(&format!("there is no such option; `durer {command} --help` lists them"))
        })?;
    let values = values(arg, value.get_ref()).map_err(|e| fail(&e))?;
    let line = source.line(key.span().start);
    let mut setting = Setting { given: Given::new(arg, name, values), line };
    check(sub, &setting).map_err(|e| fail(&e))?;
    if is_path(arg) {
        let folder = source.file.parent().unwrap_or(Path::new(""));
        setting.given.values.iter_mut().for_each(|value| *value = beside(folder, value));
    }
    Ok(setting)
}

/// Returns the values as on the command line.
fn values(arg: &Arg, value: &DeValue) -> Result<Vec<String>, String> {
    match value {
        DeValue::Boolean(is) if is_flag(arg) => Ok(vec![is.to_string()]),
        _ if is_flag(arg) => Err("it is a flag: true or false".to_owned()),
        DeValue::Array(array) => {
            let items: Vec<String> =
                array.iter().map(|item| word(item.get_ref())).collect::<Result<_, _>>()?;
            if items.is_empty() {
                return Err("the array is empty; leave the key out".to_owned());
            }
            Ok(given::list(arg, items))
        }
        one => word(one).map(|word| vec![word]),
    }
}

/// Returns a string or a number.
fn word(value: &DeValue) -> Result<String, String> {
    match value {
        DeValue::String(text) => Ok(text.clone().into_owned()),
        DeValue::Integer(number) => Ok(number.to_string()),
        DeValue::Float(number) => Ok(number.to_string()),
        _ => Err("it takes a string, a number, or an array of those".to_owned()),
    }
}

/// Returns the parser's objection to a value.
fn check(sub: &Command, setting: &Setting) -> Result<(), String> {
    let line = std::iter::once(sub.get_name().to_owned()).chain(setting.given.words());
    let Err(error) = sub.clone().try_get_matches_from(line) else { return Ok(()) };
    match error.kind() {
        // Missing arguments may be on the command line.
        ErrorKind::MissingRequiredArgument | ErrorKind::ArgumentConflict => Ok(()),
        _ => Err(first_paragraph(&error.to_string())),
    }
}

fn is_path(arg: &Arg) -> bool {
    use ValueHint::{AnyPath, DirPath, ExecutablePath, FilePath};
    matches!(arg.get_value_hint(), AnyPath | DirPath | ExecutablePath | FilePath)
}

/// Returns a path of the file as seen from where the command runs.
fn beside(folder: &Path, path: &str) -> String {
    if path == crate::places::STREAM {
        path.to_owned()
    } else {
        folder.join(path).display().to_string()
    }
}
