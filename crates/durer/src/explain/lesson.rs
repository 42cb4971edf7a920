//! Lessons: an algorithm with its examples, its sentences, and the function that makes frames of its steps.

use super::input::{Input, Options};
use super::replay::{Frame, Frames};
use super::words::{Template, Word};
use crate::info::Info;
use crate::{Error, Result};

/// Everything that is needed to explain one algorithm.
#[derive(Debug, Clone, Copy)]
pub struct Lesson {
    /// Name by which [`super::run`] finds it: that of the facts, or of a variant.
    pub name: &'static str,
    /// The algorithm's facts.
    pub info: &'static Info,
    /// Description of the input that the algorithm takes.
    pub takes: Word,
    /// Examples, the hard cases first.
    pub examples: &'static [Example],
    /// Sentences about every kind of step.
    pub templates: &'static [&'static Template],
    /// Kinds of steps that no example reaches, each with the reason.
    pub unreached: &'static [(&'static str, &'static str)],
    /// Maker of the frames of a run, at most as many as its last argument.
    pub(super) make: Make,
}

/// Function that makes the frames of a run of a lesson's algorithm.
pub(super) type Make = fn(&Lesson, &Input, &Options, usize) -> Result<Frames>;

/// A given input with a name.
#[derive(Debug, Clone, Copy)]
pub struct Example {
    /// Name on the command line, in kebab case.
    pub name: &'static str,
    /// Title.
    pub title: Word,
    /// Maker of the input.
    pub input: fn() -> Input,
}

impl Example {
    /// Creates an example from its name, its title in English and German, and the function that makes the input.
    pub(super) const fn new(
        name: &'static str,
        en: &'static str,
        de: &'static str,
        input: fn() -> Input,
    ) -> Self {
        Self { name, title: Word::new(en, de), input }
    }
}

impl Lesson {
    /// Runs the algorithm and returns a frame for each of its steps, at most `cap`, and one more with the number of
    /// missing ones if there are more.
    ///
    /// # Errors
    /// [`Error::Parameter`] where the algorithm takes another kind of input; [`Error::Unknown`] for an example that
    /// does not exist; [`Error::Limit`] for an input of more than [`super::MAX_POINTS`] points;
    /// [`Error::NonFinite`]; and those of the algorithm.
    pub fn run(&self, input: &Input, options: &Options, cap: usize) -> Result<Vec<Frame>> {
        Ok(self.record(input, options, cap)?.iter().collect())
    }

    /// Runs the algorithm as [`Lesson::run`] does, and returns frames that are made when they are shown: for runs of
    /// many steps.
    ///
    /// # Errors
    /// Those of [`Lesson::run`].
    pub fn record(&self, input: &Input, options: &Options, cap: usize) -> Result<Frames> {
        if let Input::Example(name) = input {
            let input = self.example(name)?;
            return (self.make)(self, &input, options, cap);
        }
        input.check()?;
        (self.make)(self, input, options, cap)
    }

    /// Returns the example of a name, the first one for an empty name.
    ///
    /// # Errors
    /// [`Error::Unknown`] for an example that does not exist.
    pub fn example(&self, name: &str) -> Result<Input> {
        let found = self.examples.iter().find(|example| name.is_empty() || example.name == name);
        let names = || self.examples.iter().map(|example| example.name);
        found.map(|example| (example.input)()).ok_or_else(|| unknown("example", name, names()))
    }

    /// Returns the kinds of steps, each once.
    pub fn kinds(&self) -> Vec<&'static str> {
        let mut kinds: Vec<_> = self.templates.iter().map(|template| template.kind).collect();
        kinds.dedup();
        kinds
    }
}

/// Returns an error that lists the names most like a wrong one.
pub(super) fn unknown(
    what: &'static str,
    name: &str,
    names: impl Iterator<Item = &'static str>,
) -> Error {
    let mut near: Vec<_> = names.map(|known| (distance(name, known), known)).collect();
    near.sort_unstable();
    let best = near.first().map_or(0, |(distance, _)| *distance);
    let alike = near.into_iter().take_while(|(distance, _)| *distance <= best + 3).take(6);
    let near: Vec<_> = alike.map(|(_, known)| known).collect();
    let value = name.chars().take(60).collect();
    Error::Unknown { what, value, near: near.join(", ") }
}

/// Returns how unlike two names are: the number of characters to insert, delete or replace (Levenshtein 1965),
/// or nearly nothing where one begins or contains the other.
fn distance(given: &str, known: &str) -> usize {
    if known.starts_with(given) && !given.is_empty() {
        return 0;
    }
    if known.contains(given) && !given.is_empty() {
        return 1;
    }
    let known: Vec<char> = known.chars().collect();
    let mut row: Vec<usize> = (0..=known.len()).collect();
    for (i, a) in given.chars().take(60).enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (k, b) in known.iter().enumerate() {
            let above = row.get(k + 1).copied().unwrap_or_default();
            let best = (diagonal + usize::from(a != *b)).min(above + 1).min(left + 1);
            diagonal = above;
            if let Some(cell) = row.get_mut(k) {
                *cell = left;
            }
            left = best;
        }
        if let Some(last) = row.last_mut() {
            *last = left;
        }
    }
    row.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_come_first() {
        assert_eq!([distance("bresenhan", "bresenham"), distance("", "abc")], [1, 3]);
        assert_eq!(distance("kitten", "sitting"), 3);
        let names = ["dda", "wu", "bresenham", "cyrus-beck", "vatti", "ray", "sutherland-hodgman"];
        let message = unknown("algorithm", "hodgman", names.into_iter()).to_string();
        assert!(message.ends_with("“hodgman”; the nearest are: sutherland-hodgman"), "{message}");
    }
}
