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
        let ours = folder.join(format!("{name}-durer.png"));
        let theirs = folder.join(format!("{name}-f3d.png"));
        let mut costs = [Vec::new(), Vec::new()];
        for _ in 0..options.rounds {
            costs[0].push(child::run(&mut render(&durer, model, &ours))?);
            if let Some(display) = &display {
                costs[1].push(child::run(&mut display.f3d(model, &theirs))?);
            }
        }
        print(&name, "durer", &costs[0], &costs[0]);
        pictures.push(ours);
        if display.is_some() {
            print(&name, "f3d", &costs[1], &costs[0]);
            pictures.push(theirs);
        }
    }
    // Only now, as what this process holds would count as its children's peak.
    pictures.iter().try_for_each(|p| check(p))
}

fn print(model: &str, who: &str, costs: &[Cost], ours: &[Cost]) {
    let cost = median_cost(costs);
    table::row(&[
        model.to_owned(),
        who.to_owned(),
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

/// The release build of the command, or what `DURER` names.
fn durer() -> Result<PathBuf> {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/release/durer");
    let path = std::env::var_os("DURER").map_or(built, PathBuf::from);
    if path.is_file() {
        Ok(path)
    } else {
        Err(format!("{}: build it with cargo build --release", path.display()).into())
    }
}

/// What the command line names; else a scanned boat, where the data are, and spheres.
fn models(options: &Options, temp: &Path) -> Result<Vec<PathBuf>> {
    if !options.names.is_empty() {
        return Ok(options.names.iter().map(PathBuf::from).collect());
    }
    let folder = match &options.meshes {
        Some(folder) => folder.clone(),
        None => {
            // In a process of its own: see child::run on memory.
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
