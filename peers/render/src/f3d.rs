//! f3d, which needs an X server: one virtual one for all runs.

use crate::Result;
use crate::child::Ended;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A virtual X server that ends with its owner.
pub struct Display {
    name: String,
    _server: Ended,
}

impl Display {
    /// Starts a display, if there is an f3d to show on it: starts Xvfb on the first free display from 99 on and waits
    /// until it listens.
    pub fn start() -> Result<Self> {
        crate::child::run(Command::new("f3d").arg("--version"))?;
        let socket = |n: u32| format!("/tmp/.X11-unix/X{n}");
        let number = (99..200).find(|&n| !Path::new(&socket(n)).exists()).ok_or("no display")?;
        let name = format!(":{number}");
        let mut command = Command::new("Xvfb");
        command.args([&name, "-screen", "0", "1280x1280x24", "-nolisten", "tcp"]);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let server = Ended(command.spawn().map_err(|e| format!("Xvfb: {e}"))?);
        let start = Instant::now();
        while !Path::new(&socket(number)).exists() {
            if start.elapsed() > Duration::from_secs(20) {
                return Err("Xvfb does not listen after 20 seconds".into());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(Self { name, _server: server })
    }

    /// f3d with its defaults, model in, picture out.
    pub fn f3d(&self, model: &Path, picture: &Path) -> Command {
        let mut command = Command::new("f3d");
        command.env("DISPLAY", &self.name).arg(model);
        command.arg(format!("--output={}", picture.display())).arg("--resolution=1024,1024");
        command
    }
}
