//! Child processes: their cost, and their end.

use crate::Result;
use crate::clock::Cost;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

/// Runs a command to its end, discards its output, and returns its cost.
///
/// Peak memory cannot be less than this process's own at the time of the call (Linux counts the
/// memory that a child shares before it begins), so nothing large may be held here.
pub fn run(command: &mut Command) -> Result<Cost> {
    let start = Instant::now();
    let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    let child = child.map_err(|e| format!("{}: {e}", command.get_program().display()))?;
    let id = child.id() as libc::pid_t;
    // SAFETY: all-zero bytes are a valid rusage, which is a struct of integers.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    let mut status = 0;
    // SAFETY: both pointers are valid for the call; the child is ours and nobody else waits for it.
    let waited = unsafe { libc::wait4(id, &mut status, 0, &mut usage) };
    if waited != id {
        return Err(std::io::Error::last_os_error().into());
    }
    if status != 0 {
        let program = command.get_program().display();
        return Err(format!("{program} failed with wait status {status}: {command:?}").into());
    }
    let seconds = |t: libc::timeval| t.tv_sec as f64 + t.tv_usec as f64 * 1e-6;
    Ok(Cost {
        cpu: seconds(usage.ru_utime) + seconds(usage.ru_stime),
        wall: start.elapsed().as_secs_f64(),
        memory: usage.ru_maxrss as f64 * 1024.0,
    })
}

/// A child that is asked to end when its owner is dropped, so that it can remove its files.
pub struct Ended(pub Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // SAFETY: the child is ours and has not been waited for, so its number is still its own.
        unsafe { libc::kill(self.0.id() as libc::pid_t, libc::SIGTERM) };
        // If there is nothing to wait for, it has ended.
        let _ = self.0.wait();
    }
}

/// A folder that goes with its owner.
pub struct TempFolder(PathBuf);

impl TempFolder {
    /// Creates a new folder among the temporary files.
    pub fn new() -> Result<Self> {
        let folder = std::env::temp_dir().join(format!("durer-peers-{}", std::process::id()));
        std::fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }

    /// Returns the position of the feature.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for TempFolder {
    fn drop(&mut self) {
        // A folder that cannot be removed stays among the temporary files.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
