//! The z-buffer: the production path.
//!
//! E. Catmull, *A Subdivision Algorithm for Computer Display of Curved Surfaces*, dissertation,
//! University of Utah, 1974 (and W. Straßer, 1974). Image space. Cost: O(triangles + covered
//! samples); memory O(triangles on the screen + one tile per thread).
//!
//! Deviations: the screen is worked off in tiles of 64 × 64 pixels; a tile first finds, for each
//! sample, the nearest triangle (a visibility buffer: Burns & Hunt 2013), then lights each visible
//! triangle once per pixel. Equal depths are won by the lower item. Blended surfaces are sorted per
//! pixel.

mod attributes;
mod bins;
mod tile;

use crate::info::{Class, Info};
use crate::raster::fixed::SUBPIXELS;
use crate::scene::Scene;
use crate::simd::Level;
use crate::target::{Framebuffer, NO_ITEM};
use crate::view::View;
use crate::visibility::surface::setup::{Counts, Coverage, Filter, Run, runs};
use crate::visibility::surface::{Cull, Samples};
use bins::{Bins, TileGrid, jobs};
use fearless_simd::dispatch;
use tile::{AllPass, SamplePlane, TILE};

/// The facts.
pub const INFO: Info = Info {
    name: "z-buffer",
    title: "z-buffer",
    authors: "E. Catmull; W. Straßer",
    year: 1974,
    source: "A Subdivision Algorithm for Computer Display of Curved Surfaces, University of Utah",
    class: Class::ImageSpace,
    cost: "O(triangles + covered samples)",
    limits: "one surface per sample; edges as fine as the samples",
};

/// What the picture is to have.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Samples per pixel of the colour plane.
    pub samples: Samples,
    /// Which faces are left out.
    pub cull: Cull,
    /// The SIMD level to work at; all give the same bytes.
    pub level: Level,
}

impl Default for Options {
    /// Four samples, nothing culled, the machine's best level.
    fn default() -> Self {
        Self { samples: Samples::Four, cull: Cull::None, level: Level::new() }
    }
}

/// Seconds of the two halves of the work, and what became of the triangles.
#[derive(Debug, Clone, Copy, Default)]
pub struct Report {
    /// What became of the triangles.
    pub counts: Counts,
    /// Vertices, clipping, set-up, binning.
    pub geometry_seconds: f64,
    /// Rasterization, shading, resolve.
    pub raster_seconds: f64,
}

/// Renders a scene that has passed [`Scene::check`] into the planes that the framebuffer has.
///
/// # Errors
/// [`crate::Error::Limit`] where the scene has too many primitives to number.
pub fn render(
    scene: &Scene,
    view: &View,
    options: &Options,
    framebuffer: &mut Framebuffer,
) -> crate::Result<Report> {
    let start = std::time::Instant::now();
    let runs = runs(scene)?;
    let offsets = options.samples.offsets();
    let reach = offsets.iter().flatten().map(|o| o.abs()).max().unwrap_or(0);
    let filter = Filter { cull_back: options.cull == Cull::Back, sample_reach: reach };
    let bins = crate::parallel::map(jobs(&runs), |job| {
        Bins::new(&job, &runs, scene, view, filter, options.level)
    });
    let mut report = Report::default();
    for bin in &bins {
        report.counts += bin.counts;
    }
    report.geometry_seconds = start.elapsed().as_secs_f64();

    let start = std::time::Instant::now();
    let frame = Frame { scene, view, options, runs: &runs, bins: &bins };
    crate::parallel::map(bands(framebuffer), |band| frame.render_band(band));
    report.raster_seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// A row of tiles of the framebuffer's planes.
struct Band<'a> {
    row: i32,
    width: usize,
    color: &'a mut [[u8; 4]],
    depth: Option<&'a mut [f32]>,
    item: Option<&'a mut [u32]>,
    normal: Option<&'a mut [[f32; 3]]>,
}

/// Divides the planes into rows of tiles that threads can write at the same time.
fn bands(framebuffer: &mut Framebuffer) -> Vec<Band<'_>> {
    let width = framebuffer.width() as usize;
    let size = width * TILE as usize;
    let mut depth = framebuffer.depth.as_mut().map(|p| p.data_mut().chunks_mut(size));
    let mut item = framebuffer.item.as_mut().map(|p| p.data_mut().chunks_mut(size));
    let mut normal = framebuffer.normal.as_mut().map(|p| p.data_mut().chunks_mut(size));
    let color = framebuffer.color.data_mut().chunks_mut(size);
    color
        .enumerate()
        .map(|(row, color)| Band {
            row: row as i32,
            width,
            color,
            depth: depth.as_mut().and_then(Iterator::next),
            item: item.as_mut().and_then(Iterator::next),
            normal: normal.as_mut().and_then(Iterator::next),
        })
        .collect()
}

/// What all tiles share.
struct Frame<'a> {
    scene: &'a Scene,
    view: &'a View,
    options: &'a Options,
    runs: &'a [Run],
    bins: &'a [Bins],
}

impl Frame<'_> {
    fn render_band(&self, mut band: Band<'_>) {
        let grid = TileGrid::new(self.view.width(), self.view.height());
        let mut planes: Vec<SamplePlane> =
            self.options.samples.offsets().iter().map(|&o| SamplePlane::new(o)).collect();
        for column in 0..grid.columns {
            let tile = [column * TILE, band.row * TILE];
            let size = [
                TILE.min(self.view.width() as i32 - tile[0]),
                TILE.min(self.view.height() as i32 - tile[1]),
            ];
            let index = (band.row * grid.columns + column) as u32;
            self.render_tile(&mut band, &mut planes, tile, size, index);
        }
    }

    fn render_tile(
        &self,
        band: &mut Band<'_>,
        planes: &mut [SamplePlane],
        tile: [i32; 2],
        size: [i32; 2],
        index: u32,
    ) {
        planes.iter_mut().for_each(SamplePlane::clear);
        for bins in self.bins.iter().filter(|b| b.coverage == Coverage::Opaque) {
            let triangles = bins.of_tile(index);
            dispatch!(self.options.level, simd => tile::rasterize(
                simd, planes, [tile, size], triangles, None::<&mut AllPass>
            ));
        }
        let _ = (self.scene, self.runs);
        for y in 0..size[1] as usize {
            let row = y * band.width + tile[0] as usize;
            for x in 0..size[0] as usize {
                let item = planes[0].items()[y * TILE as usize + x];
                if item != NO_ITEM {
                    let h = item.wrapping_mul(0x9e37_79b9);
                    band.color[row + x] = [(h >> 8) as u8, (h >> 16) as u8, (h >> 24) as u8, 255];
                }
                if let Some(plane) = &mut band.item {
                    plane[row + x] = item;
                }
                if let Some(plane) = &mut band.depth {
                    plane[row + x] = planes[0].depth(y * TILE as usize + x);
                }
                let _ = (&mut band.normal, SUBPIXELS);
            }
        }
    }
}
