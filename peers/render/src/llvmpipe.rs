//! Mesa's llvmpipe, by a harness of its own that is named by `LLVMPIPE_BENCH`.

use crate::Result;
use crate::clock::Cost;
use crate::picture::Picture;
use crate::scene;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the harness, if there is one.
pub fn harness() -> Option<PathBuf> {
    std::env::var_os("LLVMPIPE_BENCH").map(PathBuf::from)
}

/// Runs one turn of frames with a number of raster threads (0 = all in the calling one); returns the medians that the
/// harness prints.
pub fn turn(
    harness: &Path,
    mesh: &Path,
    samples: u32,
    threads: u32,
    picture: Option<&Path>,
) -> Result<Cost> {
    let (frames, warm) = (scene::FRAMES.to_string(), scene::WARM.to_string());
    let samples_text = samples.to_string();
    let mut arguments = vec!["--frames", &frames, "--warm", &warm];
    if samples > 1 {
        arguments.extend(["--msaa", &samples_text]);
    }
    let mut command = command(harness, threads);
    command.arg("mesh").arg(mesh).args(arguments);
    if let Some(path) = picture {
        command.arg("--png").arg(path);
    }
    medians(command, harness)
}

/// Runs one turn with the arguments and a number of raster threads.
pub fn run(harness: &Path, arguments: &[&str], threads: u32) -> Result<Cost> {
    let mut command = command(harness, threads);
    command.args(arguments);
    medians(command, harness)
}

fn command(harness: &Path, threads: u32) -> Command {
    let mut command = Command::new(harness);
    command.env("LIBGL_ALWAYS_SOFTWARE", "1").env("GALLIUM_DRIVER", "llvmpipe");
    command.env("LP_NUM_THREADS", threads.to_string());
    command
}

/// Returns the medians that the harness prints.
fn medians(mut command: Command, harness: &Path) -> Result<Cost> {
    let output = command.output().map_err(|e| format!("{}: {e}", harness.display()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let reported = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() || !reported.contains("llvmpipe") {
        return Err(format!("{}: {reported}", harness.display()).into());
    }
    let value = |name: &str| -> Result<f64> {
        let word = text.split_whitespace().find_map(|w| w.strip_prefix(name));
        Ok(word.ok_or_else(|| format!("no {name} in {text}"))?.parse::<f64>()? / 1000.0)
    };
    Ok(Cost { cpu: value("cpu_med=")?, wall: value("med_ms=")?, memory: 0.0 })
}

/// Returns the picture that the harness has written.
pub fn picture(path: &Path) -> Result<Picture> {
    let mut picture = Picture::read(path)?;
    // The harness clears to these; Mesa rounds halves up.
    picture.background = scene::BACKGROUND.map(|c| (c * 255.0 + 0.5) as u8);
    Ok(picture)
}
