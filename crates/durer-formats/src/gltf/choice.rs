//! Choosing one of a list by its name or number.

use crate::{Error, Result};

/// Returns names, with the word and the number for things without one: `scene0`, `scene1` …
pub fn names<'a>(word: &str, given: impl Iterator<Item = &'a Option<String>>) -> Vec<String> {
    let name = |(i, name): (usize, &Option<String>)| name.clone().unwrap_or(format!("{word}{i}"));
    given.enumerate().map(name).collect()
}

/// Returns the number of the thing of this name, or else of this number; `None` if none is requested.
///
/// # Errors
/// If there is no such thing, with a list of all.
pub fn find(
    word: &str,
    names: &[String],
    wanted: Option<&str>,
    at: &'static str,
) -> Result<Option<usize>> {
    let Some(wanted) = wanted else { return Ok(None) };
    let by_number = || wanted.parse().ok().filter(|n| *n < names.len());
    let found = names.iter().position(|name| name == wanted).or_else(by_number);
    found.map(Some).ok_or_else(|| {
        let all = match names {
            [] => "there is none".to_owned(),
            [only] => format!("the only one is {only}"),
            several => format!("there are {}", several.join(", ")),
        };
        Error::path(at, format!("there is no {word} `{wanted}`; {all}"))
    })
}
