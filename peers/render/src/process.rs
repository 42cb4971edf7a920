//! Whole processes: model file in, 1024 × 1024 PNG out.

use crate::child::{self, TempFolder};
use crate::clock::{Cost, median_cost, ratio};
use crate::f3d::Display;
use crate::options::Options;
use crate::picture::Picture;
use crate::{Result, table};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Measures all models and prints a table.
pub fn run(options: &Options) -> Result<()> {
    let temp = TempFolder::new()?;
    let folder = options.png.as_deref().unwrap_or(temp.path());
    let durer = durer()?;
    let display = Display::start().map_err(|e| println!("f3d: not measured, {e}\n")).ok();
    let models = models(options, temp.path())?;
    table::head(&[
        "model",
        "work",
        "who",
        "CPU s",
        "wall s",
        "peak MB",
        "its CPU / durer's",
        "its peak / durer's",
    ]);
    let mut pictures = Vec::new();
    for model in &models {
        let name = model.file_name().unwrap_or_default().to_string_lossy().replace('.', "-");
        // Asked for outside of the measured runs, and only where somebody else is to have it.
        let view = || Camera::of(&durer, model, &temp.path().join("view.png"));
        let f3d = display.as_ref().map(|display| view().map(|view| (display, view))).transpose()?;
        for work in Work::ALL {
            let file = format!("{name}-{}", work.name().replace(' ', "-"));
            let picture = |who| folder.join(format!("{file}-{who}.png"));
            let (ours, theirs) = (picture("durer"), picture("f3d"));
            let mut costs = [Vec::new(), Vec::new()];
            for _ in 0..options.rounds {
                costs[0].push(child::run(&mut work.durer(&durer, model, &ours))?);
                if let Some((display, view)) = &f3d {
                    let mut command = work.f3d(display.f3d(model, &theirs), view);
                    costs[1].push(child::run(&mut command)?);
                }
            }
            print(&[&name, work.name(), "durer"], &costs[0], &costs[0]);
            pictures.push(ours);
            if f3d.is_some() {
                print(&[&name, work.name(), "f3d"], &costs[1], &costs[0]);
                pictures.push(theirs);
            }
        }
    }
    // Only now, because memory of this process would count in its children's peak.
    pictures.iter().try_for_each(|p| check(p))
}

/// Task of both.
#[derive(Clone, Copy)]
enum Work {
    /// Defaults of each: other views, and durer alone smooths edges.
    Defaults,
    /// The view that durer chooses, edges not smoothed.
    OneSample,
    /// The same view, edges smoothed: durer by four samples per pixel, f3d by FXAA.
    Smoothed,
}

impl Work {
    const ALL: [Self; 3] = [Self::Defaults, Self::OneSample, Self::Smoothed];

    fn name(self) -> &'static str {
        match self {
            Self::Defaults => "defaults",
            Self::OneSample => "one sample",
            Self::Smoothed => "smoothed",
        }
    }

    fn durer(self, durer: &Path, model: &Path, picture: &Path) -> Command {
        let mut command = render(durer, model, picture);
        if let Self::OneSample = self {
            command.args(["--aa", "1"]);
        }
        command
    }

    fn f3d(self, mut command: Command, camera: &Camera) -> Command {
        match self {
            Self::Defaults => return command,
            Self::OneSample => {}
            Self::Smoothed => {
                command.arg("--fxaa");
            }
        }
        let Camera { eye, target, up, fov } = camera;
        command.arg(format!("--camera-position={eye}"));
        command.arg(format!("--camera-focal-point={target}"));
        command.arg(format!("--camera-view-up={up}"));
        command.arg(format!("--camera-view-angle={fov}"));
        command
    }
}

/// A camera as durer reports it.
struct Camera {
    eye: String,
    target: String,
    up: String,
    fov: String,
}

impl Camera {
    /// Returns the one that durer chooses for a model.
    fn of(durer: &Path, model: &Path, picture: &Path) -> Result<Self> {
        let output = render(durer, model, picture).arg("--json").output()?;
        let report = String::from_utf8(output.stdout)?;
        let of = |key: &str, ends: &[char]| -> Result<String> {
            let key = format!("\"{key}\":");
            let value = report.split_once(&key).and_then(|(_, rest)| rest.split_once(ends));
            let (value, _) = value.ok_or_else(|| format!("no {key} in the report of durer"))?;
            Ok(value.split_whitespace().collect::<String>().replace('[', ""))
        };
        let point = |key| of(key, &[']']);
        let fov = of("fov", &[',', '}'])?;
        Ok(Self { eye: point("eye")?, target: point("target")?, up: point("up")?, fov })
    }
}

fn print(what: &[&str; 3], costs: &[Cost], ours: &[Cost]) {
    let cost = median_cost(costs);
    let [model, work, who] = what.map(str::to_owned);
    table::row(&[
        model,
        work,
        who,
        format!("{:.3}", cost.cpu),
        format!("{:.3}", cost.wall),
        format!("{:.1}", cost.memory / 1e6),
        format!("{:.1}", ratio(costs, ours, |c| c.cpu)),
        format!("{:.1}", ratio(costs, ours, |c| c.memory)),
    ]);
}

fn render(durer: &Path, model: &Path, picture: &Path) -> Command {
    let mut command = Command::new(durer);
    command.arg("render").arg(model).arg("-o").arg(picture).args(["--size", "1024x1024", "-q"]);
    command
}

/// Returns the release build of the command, or the one named by `DURER`.
fn durer() -> Result<PathBuf> {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/release/durer");
    let path = std::env::var_os("DURER").map_or(built, PathBuf::from);
    if path.is_file() {
        Ok(path)
    } else {
        Err(format!("{}: build it with cargo build --release", path.display()).into())
    }
}

/// Returns the models of the command line; else a scanned boat, if the data are there, and spheres.
fn models(options: &Options, temp: &Path) -> Result<Vec<PathBuf>> {
    if !options.names.is_empty() {
        return Ok(options.names.iter().map(PathBuf::from).collect());
    }
    let folder = match &options.meshes {
        Some(folder) => folder.clone(),
        None => {
            // In a separate process: see child::run on memory.
            child::run(Command::new(std::env::current_exe()?).arg("make").arg(temp))?;
            temp.to_owned()
        }
    };
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let data = std::env::var_os("DURER_DATA").map_or(beside, PathBuf::from);
    let boat = data.join("meshes/3DBenchy.stl");
    if !boat.is_file() {
        println!("3DBenchy.stl: not measured, DURER_DATA does not name its folder\n");
    }
    let made = ["triangle.stl", "sphere69k.stl", "sphere69k.glb", "sphere1m.stl", "sphere1m.glb"];
    let made = made.iter().map(|name| folder.join(name));
    Ok(Some(boat).into_iter().filter(|b| b.is_file()).chain(made).collect())
}

/// A picture that shows nothing would be quickly made.
fn check(path: &Path) -> Result<()> {
    let picture = Picture::read(path)?;
    let covered = picture.covered();
    // One triangle of a sphere is small, too.
    if covered == 0 || picture.pixels.len() != 1024 * 1024 {
        return Err(format!("{}: an empty picture or a wrong size", path.display()).into());
    }
    println!("\n{}: {covered} pixels differ from the first", path.display());
    Ok(())
}
