//! Restriction of the process to the files that it is to read and write, on systems that support it.

use crate::failure::Failure;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The answer to a system that cannot confine the process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
pub enum Sandbox {
    /// The command ends with an error.
    Strict,
    /// The command continues with a warning and as much protection as the system supports.
    BestEffort,
}

/// Files that describe memory and threads.
#[cfg(target_os = "linux")]
const SYSTEM: [&str; 4] =
    ["/proc/self", "/proc/meminfo", "/sys/fs/cgroup", "/sys/devices/system/cpu"];

/// Confines the process: from now on it can open only files in the folders of its inputs or in given folders, can
/// create and replace files only in the folders of its outputs, and can open no connections.
///
/// Returns a warning where the system cannot do it, and need not.
///
/// # Errors
/// A system that cannot do it, but must.
pub fn confine(
    how: Sandbox,
    inputs: &[PathBuf],
    outputs: &[PathBuf],
) -> Result<Option<String>, Failure> {
    let read: Vec<PathBuf> = inputs.iter().filter_map(|input| folder(input)).collect();
    let written: Vec<PathBuf> = outputs.iter().filter_map(|output| folder(output)).collect();
    match (landlocked(&read, &written), how) {
        (Ok(()), _) => Ok(None),
        (Err(why), Sandbox::Strict) => {
            let hint = "--sandbox=best-effort continues without it";
            Err(Failure::Usage(format!("--sandbox: {why}; {hint}")))
        }
        (Err(why), Sandbox::BestEffort) => Ok(Some(format!("--sandbox: {why}"))),
    }
}

/// Returns the folder of a file, without links; for a folder or a special file, the path itself. For a path that does
/// not exist, the nearest existing folder above it, where it will be created.
fn folder(path: &Path) -> Option<PathBuf> {
    if let Ok(full) = std::fs::canonicalize(path) {
        let within = if full.is_file() { full.parent() } else { Some(&*full) };
        return within.map(Path::to_owned);
    }
    let mut above = path.ancestors().skip(1);
    above.find_map(|path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        std::fs::canonicalize(path).ok()
    })
}

/// Makes the kernel confine the process, by Landlock (M. Salaün, Linux 5.13; truncation from 6.2 on).
#[cfg(target_os = "linux")]
fn landlocked(read: &[PathBuf], written: &[PathBuf]) -> Result<(), String> {
    use landlock::{
        ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, Ruleset, RulesetAttr,
        RulesetCreatedAttr, RulesetError, path_beneath_rules,
    };
    let reading = AccessFs::ReadFile | AccessFs::ReadDir;
    let confined = || -> Result<(), RulesetError> {
        let files = AccessFs::from_all(ABI::V3);
        Ruleset::default()
            // At least file access must be confined.
            .set_compatibility(CompatLevel::HardRequirement)
            .handle_access(files)?
            .set_compatibility(CompatLevel::BestEffort)
            .handle_access(AccessFs::from_all(ABI::V5))?
            .handle_access(AccessNet::from_all(ABI::V5))?
            .create()?
            .add_rules(path_beneath_rules(SYSTEM, reading))?
            .add_rules(path_beneath_rules(read, reading))?
            .add_rules(path_beneath_rules(written, files & !AccessFs::Execute))?
            .restrict_self()
            .map(drop)
    };
    confined().map_err(|_| {
        "this system does not confine processes; it needs Linux 6.2 or later, with Landlock"
            .to_owned()
    })
}

#[cfg(not(target_os = "linux"))]
fn landlocked(_: &[PathBuf], _: &[PathBuf]) -> Result<(), String> {
    Err("only Linux confines processes this way".to_owned())
}
