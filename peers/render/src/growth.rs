//! The growth of a frame's cost: with triangles, pixels, overdraw and threads, drawn as charts.

#[path = "../../../crates/durer/examples/growth/chart.rs"]
mod chart;

use crate::clock::{Cost, median_cost};
use crate::durer_peer::Durer;
use crate::options::Options;
use crate::picture::Picture;
use crate::{Result, USAGE, layers, mesh, table};
use chart::{Axis, Chart};
use std::path::Path;

/// Meridians and parallels of the spheres: four times as many triangles each time, to 4 million.
const SPHERES: [(u32, u32); 6] =
    [(64, 32), (128, 64), (256, 128), (512, 256), (1024, 512), (2048, 1024)];

/// Measures and draws all charts.
pub fn run(options: &Options) -> Result<()> {
    let folder = Path::new(options.names.first().ok_or(USAGE)?);
    std::fs::create_dir_all(folder)?;
    table::head(&["grows", "by", "samples", "CPU ms", "wall ms"]);
    let rounds = options.rounds;
    let spheres = SPHERES.map(|(around, down)| mesh::displaced(around, down));
    let name = |m: &mesh::Mesh| format!("{}k", m.triangles.len() / 1000);
    let triangles = each_samples(|samples| {
        spheres.iter().map(|m| Ok((name(m), frame(m, samples, 1, 1.0, rounds)?))).collect()
    })?;
    draw(folder, "triangles", "triangles at 1920 x 1080; up: CPU ms", &triangles, |c| c.cpu)?;
    let pixels = each_samples(|samples| {
        [0.25, 0.5, 1.0, 2.0, 4.0]
            .map(|by| {
                let side = format!("{:.1}M", 2.0736 * by * by);
                Ok((side, frame(&spheres[2], samples, 1, by, rounds)?))
            })
            .into_iter()
            .collect()
    })?;
    draw(folder, "pixels", "pixels, 65k triangles; up: CPU ms", &pixels, |c| c.cpu)?;
    let orders =
        [("b2f", "back to front"), ("f2b", "front to back"), ("blend", "half transparent")];
    let overdraw = orders.map(|(order, name)| {
        let costs = [1, 4, 16, 64].map(|count| -> Result<Place> {
            Ok((count.to_string(), quads(order, count, rounds)?))
        });
        Ok((name, costs.into_iter().collect::<Result<Vec<_>>>()?))
    });
    let overdraw = overdraw.into_iter().collect::<Result<Vec<_>>>()?;
    draw(folder, "overdraw", "textured screens one before another; up: CPU ms", &overdraw, |c| {
        c.cpu
    })?;
    let threads = each_samples(|samples| {
        [1, 2, 4]
            .map(|count| Ok((count.to_string(), frame(&spheres[3], samples, count, 1.0, rounds)?)))
            .into_iter()
            .collect()
    })?;
    draw(folder, "threads", "threads, 262k triangles; up: wall ms", &threads, |c| c.wall)
}

/// Name of a place on the axis, and the frame's cost there.
type Place = (String, Cost);

/// A curve's name and places.
type Curve = (&'static str, Vec<Place>);

fn each_samples(costs: impl Fn(u32) -> Result<Vec<Place>>) -> Result<Vec<Curve>> {
    Ok(vec![("1 sample", costs(1)?), ("4 samples", costs(4)?)])
}

fn frame(mesh: &mesh::Mesh, samples: u32, threads: usize, by: f64, rounds: usize) -> Result<Cost> {
    let mut durer = Durer::new(mesh, samples, threads)?;
    durer.size = durer.size.map(|side| (f64::from(side) * by) as u32);
    let costs = (0..rounds).map(|_| durer.turn()).collect::<Result<Vec<_>>>()?;
    Ok(median_cost(&costs))
}

fn quads(order: &str, count: usize, rounds: usize) -> Result<Cost> {
    let (scene, view) = (layers::quads(order, count), layers::view());
    let costs = (0..rounds).map(|_| layers::turn(&scene, &view)).collect::<Result<Vec<_>>>()?;
    Ok(median_cost(&costs))
}

fn draw(
    folder: &Path,
    name: &str,
    title: &str,
    curves: &[Curve],
    part: fn(&Cost) -> f64,
) -> Result<()> {
    let values = |places: &[Place]| places.iter().map(|p| part(&p.1) * 1e3).collect::<Vec<f64>>();
    let all: Vec<f64> = curves.iter().flat_map(|c| values(&c.1)).collect();
    let range =
        [all.iter().copied().fold(f64::MAX, f64::min), all.iter().copied().fold(0.0, f64::max)];
    let places = curves.first().map_or(&[][..], |c| &c.1).iter().map(|p| p.0.clone()).collect();
    let mut chart = Chart::new(title, Axis { range, places })?;
    for (curve, places) in curves {
        for (at, cost) in places {
            let ms = |v: f64| format!("{:.2}", v * 1e3);
            table::row(&[name.into(), at.clone(), (*curve).into(), ms(cost.cpu), ms(cost.wall)]);
        }
        chart.curve(curve, &values(places))?;
    }
    let picture = chart.picture()?;
    let pixels = picture.data().iter().map(|p| [p[0], p[1], p[2]]).collect();
    let picture = Picture { width: picture.width() as usize, pixels, background: [255; 3] };
    picture.write(&folder.join(format!("{name}.png")))
}
