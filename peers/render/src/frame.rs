//! Frames of 1920 × 1080 in process.

use crate::child::TempFolder;
use crate::clock::{Cost, median_cost, ratio};
use crate::durer_peer::Durer;
use crate::euc_peer::Euc;
use crate::mesh::{self, Mesh};
use crate::options::Options;
use crate::picture::Picture;
use crate::swiftshader::{self, SwiftShader};
use crate::{Result, llvmpipe, table};
use durer::pipeline::SurfaceMethod;
use std::path::{Path, PathBuf};

/// Measures all meshes with 1 and 4 samples and prints a table.
pub fn run(options: &Options) -> Result<()> {
    let temp = TempFolder::new()?;
    if llvmpipe::harness().is_none() {
        println!("llvmpipe: not measured, LLVMPIPE_BENCH is not set\n");
    }
    match swiftshader::library() {
        Some(library) => println!("SwiftShader: {}\n", swiftshader::name(&library)?),
        None => println!("SwiftShader: not measured, SWIFTSHADER is not set\n"),
    }
    table::head(&[
        "mesh",
        "samples",
        "who",
        "CPU ms",
        "wall ms",
        "its CPU / durer's",
        "its wall / durer's",
    ]);
    let all = mesh::SIZES.map(|s| s.0.to_owned());
    let names = if options.names.is_empty() { &all[..] } else { &options.names };
    let mut remarks = Vec::new();
    for name in names {
        let mesh = mesh::named(name)?;
        // Of a file the name alone: pictures are called after it.
        let name = Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or(name);
        for samples in [1, 4].into_iter().filter(|s| options.samples.is_none_or(|o| o == *s)) {
            let mut contest = Contest::new(name, &mesh, samples, temp.path())?;
            for _ in 0..options.rounds {
                contest.round()?;
            }
            contest.print();
            remarks.extend(contest.compare(options.png.as_deref())?);
        }
    }
    println!("\nPictures of the last frame beside durer's on one thread:\n");
    table::head(&[
        "mesh",
        "samples",
        "who",
        "covered pixels",
        "coverage differs",
        "mean difference of a channel",
    ]);
    remarks.iter().for_each(|r| table::row(r));
    Ok(())
}

/// One who draws.
enum Contender {
    Durer(Box<Durer>),
    Euc(Box<Euc>),
    /// The harness and its number of raster threads.
    Llvmpipe(PathBuf, u32),
    SwiftShader(Box<SwiftShader>),
}

/// All renderers of one mesh with a number of samples.
struct Contest<'a> {
    mesh: &'a str,
    samples: u32,
    /// Name, index of the durer it is compared with, contender, and turns.
    contenders: Vec<(&'static str, usize, Contender, Vec<Cost>)>,
    bmesh: PathBuf,
    picture: PathBuf,
}

impl<'a> Contest<'a> {
    fn new(name: &'a str, mesh: &Mesh, samples: u32, folder: &Path) -> Result<Self> {
        let durer = |threads| -> Result<Contender> {
            Ok(Contender::Durer(Box::new(Durer::new(mesh, samples, threads)?)))
        };
        let mut contenders = vec![
            ("durer, 1 thread", 0, durer(1)?, Vec::new()),
            ("durer, 2 threads", 1, durer(2)?, Vec::new()),
        ];
        if samples == 1 {
            let euc = Contender::Euc(Box::new(Euc::new(mesh)));
            contenders.push(("euc 0.5, 1 thread", 0, euc, Vec::new()));
        }
        if samples == 4 {
            let mut way = Durer::new(mesh, samples, 1)?;
            way.algorithm = SurfaceMethod::ABuffer;
            contenders.push(("durer, A-buffer", 0, Contender::Durer(Box::new(way)), Vec::new()));
        }
        let bmesh = folder.join("mesh.bmesh");
        if let Some(harness) = llvmpipe::harness() {
            mesh::write_bmesh(&bmesh, mesh)?;
            let one = Contender::Llvmpipe(harness.clone(), 0);
            contenders.push(("llvmpipe, 1 thread", 0, one, Vec::new()));
            let two = Contender::Llvmpipe(harness, 2);
            contenders.push(("llvmpipe, 2 threads", 1, two, Vec::new()));
        }
        if let Some(library) = swiftshader::library() {
            let swift = |threads| -> Result<Contender> {
                let library = library.clone();
                let swift = SwiftShader::new(library, mesh, samples, threads, folder)?;
                Ok(Contender::SwiftShader(Box::new(swift)))
            };
            contenders.push(("SwiftShader, 1 thread", 0, swift(1)?, Vec::new()));
            contenders.push(("SwiftShader, 2 threads", 1, swift(2)?, Vec::new()));
        }
        Ok(Self { mesh: name, samples, contenders, bmesh, picture: folder.join("llvmpipe.png") })
    }

    /// Each contender's turn.
    fn round(&mut self) -> Result<()> {
        for (_, _, contender, costs) in &mut self.contenders {
            costs.push(match contender {
                Contender::Durer(durer) => durer.turn()?,
                Contender::Euc(euc) => euc.turn(),
                Contender::Llvmpipe(harness, threads) => llvmpipe::turn(
                    harness,
                    &self.bmesh,
                    self.samples,
                    *threads,
                    Some(&self.picture),
                )?,
                Contender::SwiftShader(swift) => swift.turn()?,
            });
        }
        Ok(())
    }

    fn print(&self) {
        for (name, against, _, costs) in &self.contenders {
            let ours = &self.contenders[*against].3;
            let cost = median_cost(costs);
            table::row(&[
                self.mesh.to_owned(),
                self.samples.to_string(),
                (*name).to_owned(),
                format!("{:.2}", cost.cpu * 1e3),
                format!("{:.2}", cost.wall * 1e3),
                format!("{:.2}", ratio(costs, ours, |c| c.cpu)),
                format!("{:.2}", ratio(costs, ours, |c| c.wall)),
            ]);
        }
    }

    /// Checks that all have drawn the same thing.
    fn compare(&self, folder: Option<&Path>) -> Result<Vec<[String; 6]>> {
        let mut rows = Vec::new();
        let mut first: Option<Picture> = None;
        for (name, _, contender, _) in &self.contenders {
            let picture = match contender {
                Contender::Durer(durer) => durer.picture(),
                Contender::Euc(euc) => euc.picture(),
                Contender::Llvmpipe(..) => llvmpipe::picture(&self.picture)?,
                Contender::SwiftShader(swift) => swift.picture(),
            };
            if let Some(folder) = folder {
                let who: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
                picture.write(&folder.join(format!("{}-{}-{who}.png", self.mesh, self.samples)))?;
            }
            let first = first.get_or_insert_with(|| picture.clone());
            let (differ, mean) = first.compare(&picture);
            let (covered, mean) = (picture.covered().to_string(), format!("{mean:.2}"));
            let (mesh, samples) = (self.mesh.to_owned(), self.samples.to_string());
            rows.push([mesh, samples, (*name).to_owned(), covered, differ.to_string(), mean]);
        }
        Ok(rows)
    }
}
