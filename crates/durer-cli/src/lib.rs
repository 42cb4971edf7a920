//! The `durer` command as a function: the binary calls it, and fuzz targets call its parsers.

mod algorithms;
mod args;
mod batch;
mod batch_args;
mod beside;
mod camera;
mod clip;
mod color;
mod compare;
mod config;
mod draw;
mod drawing;
#[doc(hidden)]
pub mod embedded;
mod encoding;
mod environment;
mod explain;
mod explode;
mod explore;
mod failure;
mod fill;
mod film;
#[doc(hidden)]
pub mod fuzzing;
mod given;
mod idle;
mod info;
mod input;
mod kind;
mod layer;
mod lights;
mod memory;
mod messages;
mod names;
mod options;
mod output;
mod panics;
mod pick;
mod places;
mod plot;
mod progress;
mod regions;
mod render;
mod render_args;
mod report;
mod resources;
mod sandbox;
mod section;
mod shape;
mod sides;
mod staging;
mod threads;
mod thumbnailer;
mod tiles;
mod toml_words;
mod values;
mod warp;
mod watch;

use args::{Cli, Command};
use clap::CommandFactory;
use clap::error::{ContextKind, ContextValue};
use config::Configured;
use durer_formats::ModelFormat;
use durer_formats::geo::GeoFormat;
use durer_formats::wording::shown_path;
use failure::Failure;
use options::RunningArgs;
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

/// Runs the command with the arguments of the process, and returns its exit code.
pub fn main() -> ExitCode {
    main_with(std::env::args_os().collect())
}

/// Runs the command with its name and arguments, and returns its exit code; once in a process.
pub fn main_with(line: Vec<OsString>) -> ExitCode {
    failure::report_large_files();
    let result = panics::reported_at_the_end(|| parse_and_run(line));
    if let Some(code) = watch::interrupted() {
        return ExitCode::from(code);
    }
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let message = failure.to_string();
            if !message.is_empty() {
                // If standard error is closed, only the exit code reports the failure.
                let _ = writeln!(std::io::stderr().lock(), "durer: {message}");
            }
            failure.exit_code()
        }
    }
}

/// Parses the arguments and runs the command; for a wrong option that comes from the file of
/// options, the error names that file.
fn parse_and_run(line: Vec<OsString>) -> Result<(), Failure> {
    let (command, file) = parse(line)?;
    run(command).map_err(|failure| match (failure, file) {
        (Failure::Usage(what), Some(file)) => {
            Failure::Usage(format!("{what} (with the options of {})", shown_path(&file)))
        }
        (other, _) => other,
    })
}

/// Returns the command line, with the options of a file; where it matters, records which options were given by hand.
fn parse(line: Vec<OsString>) -> Result<(Command, Option<PathBuf>), Failure> {
    let Configured { command, line, file } = config::configured(Cli::command(), line)?;
    let matches = command.try_get_matches_from(line).map_err(answered)?;
    let command = Command::of(&matches).map_err(answered)?;
    let Some((name, given)) = matches.subcommand() else { return Ok((command, file)) };
    places::settle(name, given)?;
    if let Some(file) = file.as_ref().filter(|_| is_verbose(given)) {
        let message = format!("durer: options are taken from {} too", shown_path(file));
        // As for errors: a failure to print cannot be reported.
        let _ = writeln!(std::io::stderr().lock(), "{message}");
    }
    Ok((command, file))
}

fn is_verbose(given: &clap::ArgMatches) -> bool {
    given.ids().any(|id| id == "verbose") && given.get_flag("verbose")
}

/// Ends the process with clap's message: help, the version, or an error of the command line. Returns a failure if the
/// message cannot be printed.
fn answered(mut answer: clap::Error) -> Failure {
    if let Some(ContextValue::String(word)) = answer.get(ContextKind::InvalidSubcommand)
        && let Some(command) = command_of(word)
    {
        let tip = format!("a command comes before the file: durer {command} {word}");
        answer.remove(ContextKind::SuggestedSubcommand);
        answer.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    if answer.use_stderr() {
        answer.exit();
    }
    match answer.print().and_then(|()| std::io::stdout().flush()) {
        Ok(()) => std::process::exit(answer.exit_code()),
        Err(e) => Failure::of_stdout(&e),
    }
}

/// Returns the command that draws a file of this name.
fn command_of(name: &str) -> Option<&'static str> {
    let is_map = || GeoFormat::of_name(name).is_some();
    ModelFormat::of_name(name).map(|_| "render").or_else(|| is_map().then_some("draw"))
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Render(args) => on_threads(&args.running, || render::run(&args)),
        Command::Info(args) => on_threads(&args.running, || info::run(&args)),
        Command::Clip(args) => on_threads(&args.running, || clip::run(&args)),
        Command::Buffer(args) => on_threads(&args.files.running, || regions::buffer(&args)),
        Command::Dissolve(args) => on_threads(&args.files.running, || regions::dissolve(&args)),
        Command::Fix(args) => on_threads(&args.files.running, || regions::fix(&args)),
        Command::Check(args) => on_threads(&args.running, || regions::check(&args)),
        Command::Tiles(args) => on_threads(&args.running, || tiles::run(&args)),
        Command::Simplify(args) => on_threads(&args.files.running, || regions::simplify(&args)),
        Command::Warp(args) => on_threads(&args.running, || warp::run(&args)),
        Command::Draw(args) => on_threads(&args.running, || draw::run(&args)),
        Command::Fill(args) => on_threads(&args.running, || fill::run(&args)),
        Command::Pick(args) => on_threads(&args.running, || pick::run(&args)),
        Command::Plot(args) => on_threads(&args.running, || plot::run(&args)),
        Command::Batch(args) => batch::run(&args),
        Command::BatchWorker => batch::work(),
        Command::Algorithms(args) => algorithms::run(&args),
        Command::Explain(args) => on_threads(&args.running, || explain::run(&args)),
        Command::Explore(args) => explore::run(&args),
        Command::Thumbnailer(args) => thumbnailer::run(&args),
        Command::Completions { shell } => completions(shell),
        Command::Man => manual(),
    }
}

/// Runs the work on as many threads and with the instructions that were requested.
fn on_threads(
    args: &RunningArgs,
    work: impl FnOnce() -> Result<(), Failure>,
) -> Result<(), Failure> {
    watch::start(args);
    if let Some(level) = args.simd {
        durer::simd::set_default_level(level);
    }
    threads::start(args)?;
    work()
}

fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "durer", &mut script);
    report::print_text(&String::from_utf8_lossy(&script))
}

/// Prints the manual as one page: the command, then each subcommand with all of its options.
fn manual() -> Result<(), Failure> {
    let mut page = Vec::new();
    let mut command = Cli::command();
    command.build();
    let render =
        |c: &clap::Command, out: &mut Vec<u8>| clap_mangen::Man::new(c.clone()).render(out);
    render(&command, &mut page).map_err(|e| Failure::of_stdout(&e))?;
    let shown = |c: &&clap::Command| c.get_name() != "help" && !c.is_hide_set();
    for sub in command.get_subcommands().filter(shown) {
        render(sub, &mut page).map_err(|e| Failure::of_stdout(&e))?;
    }
    report::print_text(&String::from_utf8_lossy(&page))
}
