//! `durer algorithms`: the classification of all algorithms, printed from their facts.

use crate::failure::Failure;
use crate::report;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use durer::explain::ALGORITHMS;
use durer::info::{Class, Coherence, Info, Occluder};
use serde::Serialize;

/// Examples for the long help.
pub const EXAMPLES: &str = "\
Examples:
  durer algorithms                                   all of them
  durer algorithms clip                              those with \"clip\" in name or title
  durer algorithms --space image --occluder line     scan lines that decide visibility
  durer algorithms --coherence frame --json          as data

Space: where an algorithm decides, after Sutherland, Sproull and Schumacker (1974). Occluder: the part of a surface \
that is compared with others to find what is hidden. Coherence: the likeness of neighbours that saves work.";

/// The options of `durer algorithms`.
#[derive(Debug, Args)]
pub struct AlgorithmsArgs {
    /// Only algorithms with all of these words in name, title or authors
    #[arg(value_name = "WORD")]
    pub words: Vec<String>,
    /// Only algorithms that decide in this space
    #[arg(long, value_parser = among(Class::ALL, |c| c.name()))]
    pub space: Option<Class>,
    /// Only algorithms that compare this part of surfaces
    #[arg(long, value_parser = among(Occluder::ALL, |o| o.name()))]
    pub occluder: Option<Occluder>,
    /// Only algorithms that use this coherence; if given several times, all of them
    #[arg(long, value_parser = among(Coherence::ALL, |c| c.name()))]
    pub coherence: Vec<Coherence>,
    /// Write JSON: an array of objects
    #[arg(long)]
    pub json: bool,
}

/// Returns a parser of the names of a closed set.
fn among<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(|value| name(*value));
    PossibleValuesParser::new(names).try_map(move |given| {
        all.iter().copied().find(|value| name(*value) == given).ok_or("unknown name")
    })
}

/// Facts of an algorithm, as JSON.
#[derive(Debug, Serialize)]
struct Facts {
    name: &'static str,
    title: &'static str,
    authors: &'static str,
    year: u16,
    source: &'static str,
    space: &'static str,
    occluder: &'static str,
    coherence: Vec<&'static str>,
    cost: &'static str,
    limits: &'static str,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pseudocode: &'static [&'static str],
}

impl From<&Info> for Facts {
    fn from(info: &Info) -> Self {
        Self {
            name: info.name,
            title: info.title,
            authors: info.authors,
            year: info.year,
            source: info.source,
            space: info.class.name(),
            occluder: info.occluder.name(),
            coherence: info.coherence.iter().map(|c| c.name()).collect(),
            cost: info.cost,
            limits: info.limits,
            pseudocode: info.pseudocode,
        }
    }
}

/// Prints the algorithms that were requested.
pub fn run(args: &AlgorithmsArgs) -> Result<(), Failure> {
    let found: Vec<Facts> =
        ALGORITHMS.iter().filter(|i| is_wanted(args, i)).map(|i| Facts::from(*i)).collect();
    if args.json { report::print(&found) } else { report::print_text(&table(&found)) }
}

fn is_wanted(args: &AlgorithmsArgs, info: &Info) -> bool {
    let text = [info.name, info.title, info.authors].join("\n").to_lowercase();
    args.words.iter().all(|word| text.contains(&word.to_lowercase()))
        && args.space.is_none_or(|space| space == info.class)
        && args.occluder.is_none_or(|occluder| occluder == info.occluder)
        && args.coherence.iter().all(|kind| info.coherence.contains(kind))
}

/// Returns a line for each algorithm, in columns, after one of headings.
fn table(found: &[Facts]) -> String {
    if found.is_empty() {
        return "nothing\n".to_owned();
    }
    let heading = ["name", "space", "occluder", "coherence", "year", "title"].map(str::to_owned);
    let mut rows = vec![heading];
    rows.extend(found.iter().map(|facts| {
        let coherence =
            if facts.coherence.is_empty() { "-".into() } else { facts.coherence.join(",") };
        let texts = [facts.name, facts.space, facts.occluder].map(str::to_owned);
        let [name, space, occluder] = texts;
        [name, space, occluder, coherence, facts.year.to_string(), facts.title.to_owned()]
    }));
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let widths: [usize; 5] = std::array::from_fn(width);
    rows.iter().map(|row| line(row, widths)).collect()
}

fn line(row: &[String; 6], widths: [usize; 5]) -> String {
    let columns = row.iter().zip(widths).map(|(text, width)| format!("{text:width$}  "));
    columns.chain([format!("{}\n", row[5])]).collect()
}
