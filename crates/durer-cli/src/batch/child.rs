//! A worker as the process that started it sees it.

use super::task::{Answer, Ready, Setup, Task};
use crate::failure::{Failure, in_words};
use serde::Serialize;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Time between two checks whether the row is still requested.
const LOOK: Duration = Duration::from_millis(50);

/// Time beyond the limit of a row after which a worker that has not ended by itself is killed.
const BACKSTOP: Duration = Duration::from_secs(3);

/// Time that a worker has to start.
const START: Duration = Duration::from_secs(60);

/// Bytes of a worker's messages that are kept.
const MESSAGES: usize = 4096;

/// A process that runs rows; killed when it is dropped.
pub struct Worker {
    child: Child,
    stdin: Option<ChildStdin>,
    answers: Receiver<String>,
    /// Warning about a restriction that the system does not support.
    pub warning: Option<String>,
    /// The last that it wrote to standard error.
    printed: Arc<Mutex<Vec<u8>>>,
    listener: Option<JoinHandle<()>>,
}

/// Outcome of a row in a worker.
pub enum Outcome {
    /// The worker answered.
    Answered(Answer),
    /// The worker ended; with its last message, or else how it ended.
    Died(String),
    /// The time limit passed, and the worker did not end by itself.
    TimedOut,
    /// The row is no longer needed.
    Abandoned,
}

impl Worker {
    /// Starts a worker.
    pub fn start(setup: &Setup) -> Result<Self, Failure> {
        let fail = |what: &str| Failure::Data(format!("a worker cannot be started: {what}"));
        let failed = |e: io::Error| fail(&in_words(&e));
        let mut child = Command::new(program().map_err(failed)?)
            .args(["batch-worker", "--no-config"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        let (give, answers) = channel();
        if let Some(stdout) = child.stdout.take() {
            // It ends with the worker.
            std::thread::spawn(move || {
                for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                    if give.send(line).is_err() {
                        break;
                    }
                }
            });
        }
        let printed = Arc::<Mutex<Vec<u8>>>::default();
        let listener = child.stderr.take().map(|mut stderr| {
            let printed = Arc::clone(&printed);
            std::thread::spawn(move || {
                let mut piece = [0; MESSAGES];
                while let Ok(count @ 1..) = stderr.read(&mut piece) {
                    let mut printed = printed.lock().unwrap_or_else(PoisonError::into_inner);
                    printed.extend_from_slice(&piece[..count]);
                    let excess = printed.len().saturating_sub(MESSAGES);
                    printed.drain(..excess);
                }
            })
        });
        let stdin = child.stdin.take();
        let mut worker = Self { child, stdin, answers, warning: None, printed, listener };
        let said = worker.say(setup).map(|()| worker.answers.recv_timeout(START));
        let ready = match said {
            Ok(Ok(line)) => serde_json::from_str::<Ready>(&line).ok(),
            _ => None,
        };
        match ready {
            Some(ready) if ready.version == env!("CARGO_PKG_VERSION") => {
                worker.warning = ready.warning;
                Ok(worker)
            }
            Some(ready) => Err(fail(&format!("it is durer {}; start again", ready.version))),
            None => Err(match worker.last_words() {
                words if words.starts_with("--sandbox: ") => Failure::Usage(words),
                words => fail(&words),
            }),
        }
    }

    /// Runs a row, until it is done or `abandoned`; sets the row's key when it is known.
    pub fn run(
        &mut self,
        task: &Task,
        timeout: Option<f64>,
        abandoned: &AtomicBool,
        key: &mut Option<String>,
    ) -> Outcome {
        let allowed = timeout.and_then(|s| Duration::try_from_secs_f64(s).ok());
        let allowed = allowed.map_or(Duration::MAX, |time| time.saturating_add(BACKSTOP));
        let start = Instant::now();
        if self.say(task).is_err() {
            return Outcome::Died(self.last_words());
        }
        loop {
            match self.answers.recv_timeout(LOOK) {
                Ok(line) => match serde_json::from_str(&line) {
                    Ok(Answer::Runs(found)) => *key = Some(found),
                    Ok(answer) => return Outcome::Answered(answer),
                    Err(e) => return Outcome::Died(format!("its answer is broken: {e}")),
                },
                Err(RecvTimeoutError::Disconnected) => return Outcome::Died(self.last_words()),
                Err(RecvTimeoutError::Timeout) if abandoned.load(Ordering::Relaxed) => {
                    return Outcome::Abandoned;
                }
                Err(RecvTimeoutError::Timeout) if start.elapsed() > allowed => {
                    return Outcome::TimedOut;
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    fn say(&mut self, value: &impl Serialize) -> io::Result<()> {
        let Some(stdin) = &mut self.stdin else { return Err(io::ErrorKind::BrokenPipe.into()) };
        let text = format!("{}\n", serde_json::to_string(value)?);
        stdin.write_all(text.as_bytes()).and_then(|()| stdin.flush())
    }

    /// Returns the last message of a worker that ended, or how it ended.
    fn last_words(&mut self) -> String {
        self.stdin = None;
        let _ = self.child.kill();
        let ended = self.child.wait();
        if let Some(listener) = self.listener.take() {
            let _ = listener.join();
        }
        let printed = self.printed.lock().unwrap_or_else(PoisonError::into_inner);
        let printed = String::from_utf8_lossy(&printed);
        let last = printed.lines().rev().find(|line| !line.trim().is_empty());
        match last.map(|line| line.strip_prefix("durer: ").unwrap_or(line)) {
            Some(line) => line.to_owned(),
            None => ended.map_or_else(|e| in_words(&e), in_few_words),
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.stdin = None;
        // One that has ended cannot be killed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Returns how a process ended.
fn in_few_words(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        let why = if signal == 9 { ", as the system does when memory runs out" } else { "" };
        return format!("its process was ended by signal {signal}{why}");
    }
    format!("its process ended with {status}")
}

/// Returns the program of this process, also after its file was replaced.
fn program() -> io::Result<std::path::PathBuf> {
    #[cfg(target_os = "linux")]
    if std::path::Path::new("/proc/self/exe").exists() {
        return Ok("/proc/self/exe".into());
    }
    std::env::current_exe()
}
