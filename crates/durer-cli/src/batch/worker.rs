//! The process that runs rows: it reads them from standard input and answers on standard output, until the input ends.

use super::entry::{Entry, Kind, Reference, RowError, Status, Written, now};
use super::key::{self, Hashes};
use super::rows::DATA;
use super::task::{Answer, Known, Ready, Setup, Task};
use crate::args::{Cli, Command};
use crate::failure::{Failure, in_words};
use crate::given::first_paragraph;
use crate::options::RunningArgs;
use crate::output::{self, Target};
use crate::{beside, messages, panics, places, report, resources, sandbox, threads, watch};
use crate::{clip, draw, info, plot, render, tiles};
use clap::CommandFactory;
use durer::Error;
use durer::work::Work;
use durer_formats::wording::shown_path;
use serde::Serialize;
use std::io::{self, BufRead, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;

/// Name of the option for the time of a row.
pub const TIMEOUT: &str = "--timeout-per-row";

/// Runs rows until there are no more.
pub fn work() -> Result<(), Failure> {
    let broken =
        |what: &str| Failure::Usage(format!("batch-worker: {what}; `durer batch` starts it"));
    let mut first = String::new();
    if io::stdin().lock().read_line(&mut first).unwrap_or(0) == 0 {
        return Err(broken("nothing to do"));
    }
    let setup: Setup = serde_json::from_str(&first).map_err(|e| broken(&e.to_string()))?;
    // Threads that are started from here on are confined, too.
    let confine = |how| sandbox::confine(how, &setup.read, std::slice::from_ref(&setup.out));
    let warning = setup.sandbox.map(confine).transpose()?.flatten();
    let lines = lines();
    beside::keep_apart(setup.temporary.clone());
    watch::start_rows();
    threads::start(&running(&setup))?;
    messages::keep();
    report::keep();
    say(&Ready { version: env!("CARGO_PKG_VERSION").to_owned(), warning })?;
    let mut worker = Worker { setup, hashes: Hashes::default() };
    while let Ok(line) = lines.recv() {
        let task: Task = serde_json::from_str(&line).map_err(|e| broken(&e.to_string()))?;
        say(&worker.answer(&task))?;
    }
    Ok(())
}

/// Returns the lines of standard input. When it ends, the parent process has ended, so this process ends too.
fn lines() -> Receiver<String> {
    let (give, take) = channel();
    std::thread::spawn(move || {
        for line in io::stdin().lock().lines().map_while(Result::ok) {
            if give.send(line).is_err() {
                break;
            }
        }
        beside::end(|| 0)
    });
    take
}

fn say(value: &impl Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string(value).map_err(|e| Failure::Data(e.to_string()))?;
    let mut out = io::stdout().lock();
    writeln!(out, "{text}").and_then(|()| out.flush()).map_err(|e| Failure::of_stdout(&e))
}

fn running(setup: &Setup) -> RunningArgs {
    RunningArgs {
        threads: Some(setup.threads),
        simd: None,
        max_memory: Some(setup.max_memory),
        timeout: None,
        work: Work::default(),
        sandbox: None,
        quiet: true,
        verbose: false,
    }
}

struct Worker {
    setup: Setup,
    hashes: Hashes,
}

impl Worker {
    /// Runs a row, if it is not known.
    fn answer(&mut self, task: &Task) -> Answer {
        let start = Instant::now();
        let mut key = None;
        let ran = panics::caught(|| self.run(task, &mut key));
        watch::over();
        let fault = |panic: String| {
            RowError::new(Kind::Fault, &format!("this is a bug in durer: {panic}"), &[])
        };
        let seconds = start.elapsed().as_secs_f64();
        let read = self.read(task);
        let warnings = messages::keep();
        let entry = match ran.map_err(fault).and_then(|ran| ran) {
            Ok(None) => return Answer::Same,
            Ok(Some(mut files)) => {
                let main = files.remove(0);
                Entry {
                    id: task.id.clone(),
                    key,
                    status: Status::Done,
                    output: main.output,
                    sha256: Some(main.sha256),
                    bytes: Some(main.bytes),
                    planes: files,
                    read,
                    seconds,
                    ended: now(),
                    warnings,
                    error: None,
                }
            }
            Err(error) => {
                let failed = Entry::failed(&task.id, &task.output, seconds, error);
                Entry { key, read, warnings, ..failed }
            }
        };
        Answer::Ran(Box::new(entry))
    }

    /// Runs a row; returns its outputs, the main one first, or `None` if it is known.
    fn run(
        &mut self,
        task: &Task,
        key: &mut Option<String>,
    ) -> Result<Option<Vec<Written>>, RowError> {
        report::keep();
        let inputs = self.inputs(task)?;
        let (mut command, read) = self.parse(task, &inputs)?;
        let work = command.running().map(|running| running.work.clone()).unwrap_or_default();
        watch::begin(&work, self.setup.timeout, TIMEOUT);
        *key = Some(self.key(task, &inputs, &read)?);
        if task.known.as_ref().is_some_and(|known| self.is_same(known, key.as_deref(), &inputs)) {
            return Ok(None);
        }
        resources::note();
        // Nobody waits for the row if that fails.
        let _ = key.clone().map(|key| say(&Answer::Runs(key)));
        let outputs = std::iter::once(&task.output).chain(task.planes.iter().map(|p| &p.1));
        let outputs: Vec<(&String, PathBuf)> =
            outputs.map(|name| (name, self.setup.out.join(name))).collect();
        let write_error = |path: &Path, e: &io::Error| {
            let names = [shown_path(path)];
            RowError::new(Kind::Write, &format!("{}: {}", names[0], in_words(e)), &names)
        };
        for (_, path) in &outputs {
            let folder = path.parent().unwrap_or(Path::new(""));
            std::fs::create_dir_all(folder).map_err(|e| write_error(folder, &e))?;
        }
        let done = run(&command).and_then(|()| match task.command.as_str() {
            "info" => {
                let target = Target::File(self.setup.out.join(&task.output));
                output::deliver_bytes(&target, report::keep().as_bytes()).map(drop)
            }
            _ => Ok(()),
        });
        watch::over();
        done.map_err(|failure| error_of(&failure, &work, &inputs, &outputs))?;
        let written = |(name, path): &(&String, PathBuf)| {
            let (sha256, bytes) = key::of_file(path).map_err(|e| write_error(path, &e))?;
            Ok(Written { output: (*name).clone(), sha256, bytes })
        };
        outputs.iter().map(written).collect::<Result<_, _>>().map(Some)
    }

    /// Returns whether a row is as it was.
    fn is_same(&mut self, known: &Known, key: Option<&str>, inputs: &[PathBuf]) -> bool {
        let folder = folder(inputs.first());
        let mut same = |r: &Reference| self.hashes.of(&folder.join(&r.path)).ok() == r.sha256;
        key == Some(&known.key) && known.read.iter().all(&mut same)
    }

    /// Returns the files that the inputs of the row that was run refer to.
    fn read(&mut self, task: &Task) -> Vec<Reference> {
        let noted = resources::note();
        let folder = folder(task.inputs.first().map(PathBuf::from).as_ref());
        let reference = |path: PathBuf| {
            let sha256 = self.hashes.of(&path).ok();
            let path = path.strip_prefix(&folder).map(Path::to_owned).unwrap_or(path);
            Reference { path, sha256 }
        };
        noted.into_iter().map(reference).collect()
    }

    /// Returns the paths of the inputs; bytes of data URIs are written to files.
    fn inputs(&self, task: &Task) -> Result<Vec<PathBuf>, RowError> {
        let path = |(number, input): (usize, &String)| {
            if !input.starts_with(DATA) {
                return Ok(PathBuf::from(input));
            }
            let fail = |kind, what: &str| RowError::new(kind, what, &[]);
            let data = durer_formats::data_uri(input)
                .map_err(|e| fail(Kind::Read, &format!("column `input`: {e}")))?;
            let folder = self.setup.temporary.join(format!("inputs-{}", std::process::id()));
            let folder = folder.join(number.to_string());
            let path = folder.join(format!("data{}", suffix(input)));
            let write = || {
                // Files of an earlier row are removed, so that they do not mix with this row's.
                let _ = std::fs::remove_dir_all(&folder);
                std::fs::create_dir_all(&folder)?;
                std::fs::write(&path, data)
            };
            write().map_err(|e| fail(Kind::Write, &in_words(&e)))?;
            Ok(path)
        };
        task.inputs.iter().enumerate().map(path).collect()
    }

    /// Parses the options of a row; returns the paths that the command reads, too.
    fn parse(&self, task: &Task, inputs: &[PathBuf]) -> Result<(Command, Vec<PathBuf>), RowError> {
        let usage =
            |e: clap::Error| RowError::new(Kind::Usage, &first_paragraph(&e.to_string()), &[]);
        let line = self.line(task, inputs);
        let matches = Cli::command().try_get_matches_from(line).map_err(usage)?;
        let command = Command::of(&matches).map_err(usage)?;
        let (read, _) = matches.subcommand().map(|(n, g)| places::named(n, g)).unwrap_or_default();
        Ok((command, read))
    }

    /// Returns the key of a row.
    fn key(
        &mut self,
        task: &Task,
        inputs: &[PathBuf],
        read: &[PathBuf],
    ) -> Result<String, RowError> {
        let mut hashes = Vec::new();
        for (path, input) in inputs.iter().zip(&task.inputs) {
            let (hash, _) = key::of_file(path).map_err(|e| unreadable(path, &e))?;
            if let Some(wanted) = task.sha256.as_ref().filter(|wanted| **wanted != hash) {
                let name = shown_path(path);
                let what = format!("{name}: its SHA-256 is {hash}; the manifest says {wanted}");
                return Err(RowError::new(Kind::Checksum, &what, &[name]));
            }
            let name = Path::new(if input.starts_with(DATA) { "data" } else { input }).file_name();
            hashes.push((name.unwrap_or_default().to_string_lossy().into_owned(), hash));
        }
        let mut files = Vec::new();
        for path in read.iter().filter(|path| !inputs.contains(path) && path.is_file()) {
            let hash = self.hashes.of(path).map_err(|e| unreadable(path, &e))?;
            files.push((path.to_string_lossy().into_owned(), hash));
        }
        Ok(key::of_row(task, &hashes, &files))
    }

    /// Returns the command line of a row.
    fn line(&self, task: &Task, inputs: &[PathBuf]) -> Vec<PathBuf> {
        let mut line: Vec<PathBuf> = vec!["durer".into(), task.command.clone().into()];
        line.extend(task.options.iter().flat_map(|(_, words)| words.iter().map(PathBuf::from)));
        line.push(format!("--max-memory={}", self.setup.max_memory).into());
        for (option, name) in &task.planes {
            line.extend([format!("--{option}").into(), self.setup.out.join(name)]);
        }
        match task.command.as_str() {
            "info" => line.push("--json".into()),
            _ => line.extend(["--output".into(), self.setup.out.join(&task.output)]),
        }
        if !inputs.is_empty() {
            line.push("--".into());
            line.extend_from_slice(inputs);
        }
        line
    }
}

/// Returns the folder of an input, without links.
fn folder(input: Option<&PathBuf>) -> PathBuf {
    let full = input.and_then(|input| std::fs::canonicalize(input).ok());
    full.and_then(|full| full.parent().map(Path::to_owned)).unwrap_or_default()
}

/// Runs the command of a row.
fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Render(args) => render::run(args),
        Command::Clip(args) => clip::run(args),
        Command::Draw(args) => draw::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Tiles(args) => tiles::run(args),
        Command::Info(args) => info::run(args),
        _ => Err(Failure::Usage("rows cannot have this command".to_owned())),
    }
}

fn unreadable(path: &Path, e: &io::Error) -> RowError {
    let name = shown_path(path);
    RowError::new(Kind::Read, &format!("{name}: {}", in_words(e)), &[name])
}

/// Returns the suffix of the file for a data URI, by its media type; the content decides in most cases.
fn suffix(uri: &str) -> String {
    let media = uri[DATA.len()..].split([';', ',']).next().unwrap_or_default();
    let kind = media.rsplit(['/', '-', '.']).next().unwrap_or_default();
    let kind = match kind.split('+').next().unwrap_or_default() {
        "binary" => "glb",
        "geo" => "geojson",
        kind => kind,
    };
    let plain = (1..=8).contains(&kind.len()) && kind.bytes().all(|b| b.is_ascii_alphanumeric());
    if plain { format!(".{kind}") } else { String::new() }
}

/// Returns the error of a row whose command failed.
fn error_of(
    failure: &Failure,
    work: &Work,
    inputs: &[PathBuf],
    outputs: &[(&String, PathBuf)],
) -> RowError {
    let message = failure.to_string();
    let written: Vec<String> = outputs.iter().map(|(_, path)| shown_path(path)).collect();
    let names: Vec<String> = inputs.iter().map(|path| shown_path(path)).collect();
    let kind = match (work.check(), failure) {
        (Err(Error::TimedOut { .. }), _) => Kind::Timeout,
        (Err(error), _) if error.is_of_budget() => Kind::Memory,
        (_, Failure::Usage(_)) => Kind::Usage,
        (_, Failure::Refused(_)) => Kind::Memory,
        // Matches the error of a budget, in which the stage varies.
        _ if message.contains("--max-memory allows") => Kind::Memory,
        _ if written.iter().any(|name| message.starts_with(name)) => Kind::Write,
        _ => Kind::Data,
    };
    RowError::new(kind, &message, &[names, written].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn media_types_have_suffixes() {
        for (uri, name) in [
            ("data:model/obj;base64,QQ==", ".obj"),
            ("data:model/gltf-binary;base64,QQ==", ".glb"),
            ("data:model/gltf+json,{}", ".gltf"),
            ("data:image/svg+xml,x", ".svg"),
            ("data:application/geo+json,x", ".geojson"),
            ("data:,x", ""),
            ("data:a/../b,x", ".b"),
            ("data:text/ä,x", ""),
        ] {
            assert_eq!(suffix(uri), name, "{uri}");
        }
    }
}
