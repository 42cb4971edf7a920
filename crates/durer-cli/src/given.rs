//! Options given by their long names with values as text, as files of options and manifests of batches have them.

use clap::{Arg, ArgAction, ArgMatches, Command, Id};

/// An option with its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Given {
    /// Name as written, without dashes.
    pub key: String,
    /// Identifier in the parser.
    pub id: Id,
    /// Its values, as on the command line; `true` or `false` for a flag, none if the option is given without a value.
    pub values: Vec<String>,
    /// True if it takes no value, and whether it takes several at once.
    flag: bool,
    several: bool,
}

impl Given {
    /// Creates an option under one of its names.
    pub fn new(arg: &Arg, key: &str, values: Vec<String>) -> Self {
        let (flag, several) = (is_flag(arg), takes_several(arg));
        Self { key: key.to_owned(), id: arg.get_id().clone(), values, flag, several }
    }

    /// Returns the arguments as they would be written on the command line.
    pub fn words(&self) -> Vec<String> {
        let option = format!("--{}", self.key);
        match &self.values[..] {
            [value] if self.flag => (value == "true").then_some(option).into_iter().collect(),
            values if self.several => {
                std::iter::once(option).chain(values.iter().cloned()).collect()
            }
            [] => vec![option],
            values => values.iter().map(|value| format!("{option}={value}")).collect(),
        }
    }

    /// Returns whether another option excludes this one.
    pub fn is_excluded_by(&self, other: &Id, sub: &Command) -> bool {
        let find = |id: &Id| sub.get_arguments().find(|a| a.get_id() == id);
        let (Some(this), Some(that)) = (find(&self.id), find(other)) else { return false };
        let names = |a: &Arg, b: &Arg| {
            sub.get_arg_conflicts_with(a).iter().any(|excluded| excluded.get_id() == b.get_id())
        };
        names(this, that) || names(that, this)
    }
}

/// Returns whether an option has this long name, or has it as an alias.
pub fn is_called(arg: &Arg, name: &str) -> bool {
    let aliases = arg.get_all_aliases().unwrap_or_default();
    arg.get_long() == Some(name) || aliases.contains(&name)
}

/// Returns whether an option takes no value.
pub fn is_flag(arg: &Arg) -> bool {
    !arg.get_action().takes_values()
}

/// Returns whether an option may be given without a value.
pub fn is_without_value(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|n| n.min_values() == 0)
}

fn takes_several(arg: &Arg) -> bool {
    arg.get_num_args().is_some_and(|n| n.max_values() > 1)
}

/// Returns the values of a list: unchanged if the option can be repeated or takes several, else joined by commas.
pub fn list(arg: &Arg, items: Vec<String>) -> Vec<String> {
    let each = matches!(arg.get_action(), ArgAction::Append);
    if each || takes_several(arg) { items } else { vec![items.join(",")] }
}

/// Returns whether an option was given on the command line.
pub fn is_by_hand(given: &ArgMatches, id: &Id) -> bool {
    let known = given.ids().any(|i| i == id);
    known && given.value_source(id.as_str()) == Some(clap::parser::ValueSource::CommandLine)
}

/// Returns the parser's message without its hints at the command line.
pub fn first_paragraph(message: &str) -> String {
    let lines = message.lines().map(str::trim).take_while(|line| !line.is_empty());
    let text = lines.collect::<Vec<_>>().join(" ");
    text.strip_prefix("error: ").unwrap_or(&text).to_owned()
}
