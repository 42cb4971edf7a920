//! `durer explore`: serves the explorer's pages on this machine, and opens the browser.

mod pages;
mod reply;

use crate::failure::{Failure, in_words};
use crate::report;
use clap::{Args, ValueHint};
use pages::Pages;
use std::io::Write;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Duration;

pub const EXAMPLES: &str = "\
Examples:
  durer explore                     (serves the pages and opens the browser)
  durer explore --no-open --port 8000
  durer explore --from dist         (pages of a folder)

The pages are served on this machine only, until Ctrl-C. Files that are opened in them stay in the browser.

Exit codes: 0 done; 1 the port cannot be used; 2 wrong usage, or no pages.";

/// Time that a browser has to send its request or take the answer.
const PATIENCE: Duration = Duration::from_secs(10);

/// Time until the next try after a connection that could not be served.
const PAUSE: Duration = Duration::from_millis(50);

/// The options of `durer explore`.
#[derive(Debug, Args)]
pub struct ExploreArgs {
    /// Print the address only, and leave the browser closed
    #[arg(long)]
    pub no_open: bool,
    /// The port [default: one that is free]
    #[arg(long, value_name = "N", default_value = "0", hide_default_value = true)]
    pub port: u16,
    /// Folder with the built pages, instead of those in the command
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub from: Option<PathBuf>,
}

/// Serves the pages until the process ends.
pub fn run(args: &ExploreArgs) -> Result<(), Failure> {
    let pages = Pages::new(args.from.as_deref())?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(|e| {
        Failure::Data(format!("port {}: {}; --port names another one", args.port, in_words(&e)))
    })?;
    let address = listener.local_addr().map_err(|e| Failure::Data(in_words(&e)))?;
    let url = format!("http://{address}/");
    report::print_text(&format!("The explorer is at {url}; Ctrl-C ends it.\n"))?;
    if !args.no_open {
        open(&url);
    }
    for stream in listener.incoming() {
        let pages = pages.clone();
        // A browser requests several files at once and keeps idle connections open.
        let answered = stream
            .and_then(|stream| std::thread::Builder::new().spawn(move || serve(stream, &pages)));
        if answered.is_err() {
            // There are too many connections: some will end soon.
            std::thread::sleep(PAUSE);
        }
    }
    Ok(())
}

/// Answers one request. If the browser closes the connection, the rest of the answer is dropped.
fn serve(mut stream: TcpStream, pages: &Pages) {
    let patient = stream.set_read_timeout(Some(PATIENCE)).is_ok()
        && stream.set_write_timeout(Some(PATIENCE)).is_ok();
    if let Some(head) = reply::head(&mut stream).filter(|_| patient) {
        let _ = stream.write_all(&reply::reply(&head, pages));
    }
}

/// Opens the browser by the command that the system has for it; without one, the address has been printed.
fn open(url: &str) {
    let (program, before): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(before).arg(url);
    let _ = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
}
