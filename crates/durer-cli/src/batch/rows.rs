//! Rows of a manifest, checked before any of them is run.

use super::journal;
use super::manifest::{self, Record};
use super::options::{self, Common, Parser};
use super::shard::Shard;
use super::task::{Known, Task};
use crate::batch_args::BatchArgs;
use crate::failure::Failure;
use crate::given::Given;
use crate::input::display_name;
use crate::names;
use serde_json::Value;
use std::collections::{BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Component, Path, PathBuf};

/// A row to run.
#[derive(Debug)]
pub struct Row {
    /// Its name.
    pub id: String,
    /// The command.
    command: &'static str,
    /// Paths or data URIs.
    inputs: Vec<String>,
    /// Name of the output in its folder.
    pub output: String,
    /// Options that name further outputs, with the names.
    planes: Vec<(String, String)>,
    /// Hash that the input must have.
    sha256: Option<String>,
    /// Its own options.
    options: Vec<Given>,
}

/// The rows of a manifest that belong to a shard, and their common settings.
pub struct Rows {
    /// The rows, in the order of the manifest.
    pub rows: Vec<Row>,
    /// Parser of options.
    pub parser: Parser,
    /// Options of all rows.
    pub common: Common,
}

/// Columns that are not options.
const COLUMNS: [&str; 5] = ["id", "input", "output", "command", "sha256"];

/// Begin of an input that has its bytes in itself.
pub const DATA: &str = "data:";

impl Rows {
    /// Reads and checks all rows of a manifest; keeps the rows of a shard.
    pub fn read(args: &BatchArgs, path: &Path, shard: Shard) -> Result<Self, Failure> {
        let parser = Parser::new();
        let common = parser.common(&args.words)?;
        check_pattern(args.name.as_deref())?;
        let (mut rows, mut ids, mut outputs) = (Vec::new(), Seen::default(), Seen::default());
        let name = display_name(path);
        manifest::read(path, |record| {
            let at = |what: String| Failure::Data(format!("{name}: {}: {what}", record.place));
            let row = row(&record, &parser, &common, args.name.as_deref()).map_err(at)?;
            if let Some(first) = ids.add(&row.id, &record.place) {
                return Err(at(format!("id `{}` is used in {first}, too", row.id)));
            }
            for output in std::iter::once(&row.output).chain(row.planes.iter().map(|p| &p.1)) {
                if let Some(first) = outputs.add(output, &record.place) {
                    return Err(at(format!("output `{output}` is used in {first}, too")));
                }
            }
            if shard.has(&row.id) {
                rows.push(row);
            }
            Ok(())
        })?;
        Ok(Self { rows, parser, common })
    }

    /// Returns a hint if the first input is not in the current folder but in that of the manifest.
    pub fn elsewhere(&self, manifest: &Path) -> Option<String> {
        let input = self.rows.first()?.inputs.first().filter(|input| !input.starts_with(DATA))?;
        let folder = manifest.parent().filter(|folder| !folder.as_os_str().is_empty())?;
        let there = folder.join(input);
        let is_there = !Path::new(input).exists() && there.exists();
        is_there.then(|| {
            let (name, there) = (display_name(manifest), display_name(&there));
            format!("{name}: inputs are named from the current folder, not from the manifest's; {there} exists")
        })
    }

    /// Returns the folders of all files that rows read, as far as they are there, without links.
    pub fn folders(&self) -> Vec<PathBuf> {
        let mut folders = BTreeSet::new();
        let mut add = |path: &str| {
            let Ok(full) = std::fs::canonicalize(path) else { return };
            let folder = if full.is_dir() { Some(&*full) } else { full.parent() };
            folders.extend(folder.map(Path::to_owned));
        };
        for row in &self.rows {
            row.inputs.iter().filter(|input| !input.starts_with(DATA)).for_each(|input| add(input));
            let joined = self.parser.joined(&self.common, row.command, row.options.clone());
            let (_, options) = options::planes(row.command, joined);
            let named = options.iter().filter(|given| self.parser.names_files(row.command, given));
            named.flat_map(|given| &given.values).for_each(|path| add(path));
        }
        folders.into_iter().collect()
    }

    /// Returns the row as a worker takes it.
    pub fn task(&self, row: &Row, known: Option<Known>) -> Task {
        let joined = self.parser.joined(&self.common, row.command, row.options.clone());
        let (_, options) = options::planes(row.command, joined);
        Task {
            id: row.id.clone(),
            command: row.command.to_owned(),
            options: options.into_iter().map(|given| (given.key.clone(), given.words())).collect(),
            inputs: row.inputs.clone(),
            output: row.output.clone(),
            planes: row.planes.clone(),
            sha256: row.sha256.clone(),
            known,
        }
    }
}

/// Names with the places where they were first, by hashes of 128 bits.
#[derive(Default)]
struct Seen(HashMap<[u64; 2], String>);

impl Seen {
    /// Adds a name; returns the place of the first one of the same name.
    fn add(&mut self, name: &str, place: &str) -> Option<&str> {
        let hash = |seed: u8| {
            let mut hasher = DefaultHasher::new();
            (seed, name).hash(&mut hasher);
            hasher.finish()
        };
        match self.0.entry([hash(0), hash(1)]) {
            std::collections::hash_map::Entry::Occupied(first) => Some(first.into_mut()),
            std::collections::hash_map::Entry::Vacant(vacant) => {
                vacant.insert(place.to_owned());
                None
            }
        }
    }
}

/// Makes a row of a record.
fn row(
    record: &Record,
    parser: &Parser,
    common: &Common,
    pattern: Option<&str>,
) -> Result<Row, String> {
    let cell = |name: &str| -> Result<Option<String>, String> {
        match record.cells.get(name) {
            None | Some(Value::Null) => Ok(None),
            Some(value) => {
                let text = options::text(value)
                    .ok_or_else(|| format!("column `{name}`: it is not a text"))?;
                Ok(Some(text).filter(|text| !text.is_empty()))
            }
        }
    };
    let id = cell("id")?.ok_or("there is no `id`")?;
    check_id(&id)?;
    let command = match cell("command")? {
        None => common.command,
        Some(name) => Parser::command(&name).ok_or_else(|| {
            format!("command `{name}` is not one of {}", options::COMMANDS.join(", "))
        })?,
    };
    let mut own = Vec::new();
    for (name, value) in record.cells.iter().filter(|(name, _)| !COLUMNS.contains(&name.as_str())) {
        own.extend(parser.of_cell(command, name, value)?);
    }
    let inputs = inputs(record.cells.get("input"), command, &own, common)?;
    let first = Path::new(inputs.first().map_or("", String::as_str));
    let first = if is_data(&inputs) { Path::new("data") } else { first };
    let joined = parser.joined(common, command, own.clone());
    let suffix = options::suffix(command, &joined);
    let named = |pattern: &str| names::expand(&pattern.replace("{id}", &id), first);
    let output = match (cell("output")?, pattern) {
        (Some(output), _) => output,
        (None, Some(pattern)) => named(pattern),
        (None, None) => format!("{id}.{suffix}"),
    };
    check_output(&output)?;
    let (named_planes, _) = options::planes(command, joined);
    let planes =
        named_planes.iter().flat_map(|g| g.values.iter().map(|v| (g.key.clone(), named(v))));
    let planes: Vec<(String, String)> = planes.collect();
    planes.iter().try_for_each(|(_, output)| check_output(output))?;
    let sha256 = cell("sha256")?.map(|text| text.to_ascii_lowercase());
    if sha256.as_ref().is_some_and(|s| s.len() != 64 || !s.bytes().all(|b| b.is_ascii_hexdigit())) {
        return Err("column `sha256`: it has 64 hexadecimal digits".to_owned());
    }
    Ok(Row { id, command, inputs, output, planes, sha256, options: own })
}

fn is_data(inputs: &[String]) -> bool {
    inputs.first().is_some_and(|input| input.starts_with(DATA))
}

/// Returns the inputs of a row: one, or several where the command takes them.
fn inputs(
    value: Option<&Value>,
    command: &str,
    own: &[Given],
    common: &Common,
) -> Result<Vec<String>, String> {
    let wrong = || "column `input`: it is a path or a data URI".to_owned();
    let inputs: Vec<String> = match value {
        None | Some(Value::Null) => Vec::new(),
        Some(Value::Array(items)) => {
            items.iter().map(options::text).collect::<Option<_>>().ok_or_else(wrong)?
        }
        Some(value) => vec![options::text(value).ok_or_else(wrong)?],
    };
    let formula = own.iter().chain(&common.options).any(|given| given.id == "formula");
    match inputs.len() {
        0 if command == "plot" && formula => {}
        0 => return Err("there is no `input`".to_owned()),
        1 => {}
        _ if ["draw", "tiles"].contains(&command) => {}
        _ => return Err(format!("column `input`: `durer {command}` has one for each row")),
    }
    if let Some(input) = inputs.iter().find(|i| i.is_empty() || *i == "-" || i.contains('\0')) {
        return Err(format!(
            "column `input`: `{input}` is not a file; name one, or give a data URI"
        ));
    }
    Ok(inputs)
}

/// Refuses ids that are not safe as names of files on every system.
fn check_id(id: &str) -> Result<(), String> {
    let known = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    let parts = || id.split('/');
    if !id.chars().all(known) {
        return Err(format!(
            "id `{id}`: it has letters (A to Z), digits, `.`, `_`, `-` and `/` only"
        ));
    }
    if parts().any(|part| part.is_empty() || part == "." || part == "..") {
        return Err(format!("id `{id}`: no part between slashes is empty, `.` or `..`"));
    }
    Ok(())
}

fn check_pattern(pattern: Option<&str>) -> Result<(), Failure> {
    let Some(pattern) = pattern else { return Ok(()) };
    let usage = |what: String| Failure::Usage(format!("--name {pattern}: {what}"));
    let sample = names::expand(&pattern.replace("{id}", "id"), Path::new("folder/name.suffix"));
    if sample.contains(['{', '}']) {
        return Err(usage(format!("there are {{id}}, {}", names::PLACEHOLDERS)));
    }
    check_output(&sample).map_err(usage)
}

/// Refuses names of outputs that lead outside of their folder, or are not one file.
fn check_output(output: &str) -> Result<(), String> {
    let wrong = |what: &str| Err(format!("output `{output}`: {what}"));
    let path = Path::new(output);
    let inside = |part: Component| matches!(part, Component::Normal(_));
    if output.is_empty() || output.contains('\0') || !path.components().all(inside) {
        return wrong("it is a name within OUT, without `..`");
    }
    if output.contains("//") || output.ends_with('/') || output.contains("/./") {
        return wrong("no part between slashes is empty or `.`");
    }
    if path.components().next() == Some(Component::Normal(journal::FOLDER.as_ref())) {
        return wrong("the folder .durer belongs to the journal");
    }
    match path.extension().and_then(|suffix| suffix.to_str()) {
        Some("shp") => wrong("a Shapefile is several files; .fgb, .gpkg and .geojson are one"),
        Some(_) if output.contains(['%', '{', '}']) => {
            wrong("a row writes one file; no `%`, `{` or `}`")
        }
        Some(_) => Ok(()),
        None => wrong("it needs a suffix, such as .png"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_names_on_every_system() {
        for id in ["a", "A-1_b.c", "x/y/z", "..a"] {
            assert_eq!(check_id(id), Ok(()), "{id}");
        }
        for id in ["", "a b", "ä", "/a", "a/", "a//b", "../a", "a/./b", "a\\b", "a:b"] {
            assert!(check_id(id).is_err(), "{id}");
        }
    }

    #[test]
    fn outputs_are_files_in_their_folder() {
        for output in ["a.png", "x/y.z/ä b.png"] {
            assert_eq!(check_output(output), Ok(()), "{output}");
        }
        for output in [
            "",
            "a",
            "/a.png",
            "../a.png",
            "x/../a.png",
            "x/",
            "./a.png",
            "x//a.png",
            "x/./a.png",
            ".durer/a.png",
            "a.shp",
            "a_%d.png",
            "{z}.mvt",
            "a.png/",
        ] {
            assert!(check_output(output).is_err(), "{output}");
        }
    }
}
