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
//!
//! Where a triangle goes: `bins` sets it up and lists it for the tiles that it touches, unless it is as small as a
//! pixel and `micropolygon` samples it during set-up. In a tile, `rasterize` keeps the nearest item of each sample, with
//! near triangles first (`front_to_back`). `resolve` passes the visible items to the queue of `lit`, which lights them
//! and adds the colours to the sums of their pixels; `blended` lays blended surfaces over these. At last `resolve`
//! encodes the sums.

mod area;
mod band;
mod bins;
mod blended;
mod front_to_back;
mod micropolygon;
mod rasterize;
mod resolve;
pub(crate) mod survey;
mod tile;
mod tile_grid;

use crate::info::{Class, Coherence, Info, Occluder};
use crate::math::Vec4;
use crate::scene::Scene;
use crate::shade::color::{encode_premultiplied, premultiply};
use crate::shade::{PreparedLights, PreparedMaterials, Shading};
use crate::simd::{Level, default_level, dispatch};
use crate::stopwatch::Stopwatch;
use crate::target::{Framebuffer, NO_ITEM};
use crate::view::View;
use crate::visibility::surface::background::background_rows;
use crate::visibility::surface::lit::{KnownNormals, Lighting, Lit, PointQueue};
use crate::visibility::surface::setup::{
    Coverage, ScreenTriangle, TriangleCounts, TriangleFilter, runs,
};
use crate::visibility::surface::{Background, Cull, Marks, Samples};
use crate::work::Work;
use area::{Area, Codes};
use band::{Band, bands};
use bins::{Binned, Source};
use blended::{Blended, light_blended};
use front_to_back::FrontToBack;
use rasterize::{AllPass, rasterize};
use resolve::{MaskTest, resolve};
use tile::{SamplePlane, TILE, TILE_PIXELS};
use tile_grid::TileGrid;

/// Facts about the algorithm.
pub const INFO: Info = Info {
    name: "z-buffer",
    title: "z-buffer",
    authors: "E. Catmull; W. Straßer",
    year: 1974,
    source: "A Subdivision Algorithm for Computer Display of Curved Surfaces, University of Utah",
    class: Class::ImageSpace,
    occluder: Occluder::Point,
    coherence: &[Coherence::Edge, Coherence::Depth],
    cost: "O(triangles + covered samples)",
    limits: "one surface per sample; edges as fine as the samples",
    pseudocode: &[],
};

/// Options for rendering with the z-buffer.
#[derive(Debug, Clone)]
pub struct Options {
    /// Samples per pixel of the colour plane.
    pub samples: Samples,
    /// Faces to leave out.
    pub cull: Cull,
    /// The size of lines and points.
    pub marks: Marks,
    /// Shading; `None` = by material.
    pub shading: Option<Shading>,
    /// Background of the picture.
    pub background: Background,
    /// SIMD level; all levels produce the same bytes.
    pub level: Level,
    /// Budget of the work, and its cancellation.
    pub work: Work,
}

impl Default for Options {
    /// Returns four samples on white, nothing culled, the machine's best level.
    fn default() -> Self {
        Self {
            samples: Samples::Four,
            cull: Cull::None,
            marks: Marks::default(),
            shading: None,
            background: Background::Color(Vec4::ONE),
            level: default_level(),
            work: Work::default(),
        }
    }
}

/// Seconds spent in the two halves of the work, and the fate of the triangles.
#[derive(Debug, Clone, Copy, Default)]
pub struct StageReport {
    /// Counts of the triangles by their treatment.
    pub counts: TriangleCounts,
    /// Vertices, clipping, set-up, binning.
    pub geometry_seconds: f64,
    /// Rasterization, shading, resolve.
    pub raster_seconds: f64,
}

/// Renders a scene that has passed [`Scene::check`] into the planes that the framebuffer has.
///
/// # Errors
/// [`crate::Error::Limit`] if the scene has too many primitives to number, [`crate::Error::Memory`] if the budget
/// has no room for its triangles on the screen, and the error of stopped work.
pub fn render(
    scene: &Scene,
    view: &View,
    lights: &PreparedLights,
    options: &Options,
    framebuffer: &mut Framebuffer,
) -> crate::Result<StageReport> {
    let start = Stopwatch::start();
    let runs = runs(scene)?;
    let bands = bands(framebuffer, view);
    let reach = options.samples.reach();
    let filter = TriangleFilter { cull: options.cull, sample_reach: reach, marks: options.marks };
    let bytes = PreparedMaterials::bytes(scene);
    let _materials = options.work.charge(PreparedMaterials::STAGE, bytes)?;
    let materials = PreparedMaterials::new(scene).with_ink(options.background.ink());
    let lighting = Lighting {
        scene,
        view,
        runs: &runs,
        materials: &materials,
        lights,
        shading: options.shading,
        reach,
        level: options.level,
    };
    let prepared = start.seconds();
    let early = early_samples(options.samples, bands.iter().any(Band::wants_center));
    let (work, level, lighting) = (&options.work, options.level, &lighting);
    let source =
        Source { scene, view, runs: &runs, filter, early, lighting: Some(lighting), level };
    let binned = &Binned::new(&source, work)?;
    let mut report = StageReport { counts: binned.counts(), ..StageReport::default() };
    report.geometry_seconds = start.seconds() - prepared;

    let triangle_count = scene.triangle_count() as u32;
    let occupied = binned.occupied(view);
    let frame = Frame { view, options, lighting: *lighting, binned, occupied, triangle_count };
    let scratch = || Scratch::new(&frame);
    work.begin("rows of tiles", bands.len() as u64);
    crate::parallel::map_with(bands, scratch, |scratch, band| {
        if !work.is_stopped() {
            frame.render_band(band, scratch);
            work.advance(1);
        }
    });
    work.check()?;
    report.raster_seconds = start.seconds() - report.geometry_seconds;
    Ok(report)
}

/// Returns the samples at which small triangles are sampled while they are set up; none if there are too many, or
/// where others are examined too, as at pixels' centres for the planes besides colour.
fn early_samples(samples: Samples, with_planes: bool) -> &'static [[i32; 2]] {
    match samples {
        Samples::Four if with_planes => &[],
        Samples::One | Samples::Four => samples.offsets(),
        Samples::Sixteen => &[],
    }
}

/// Data that all tiles share.
struct Frame<'a> {
    view: &'a View,
    options: &'a Options,
    lighting: Lighting<'a>,
    binned: &'a Binned,
    /// True if there is anything in each tile.
    occupied: Vec<bool>,
    /// Items from here on are lines and points, which the item plane does not show.
    triangle_count: u32,
}

/// One thread's buffers.
struct Scratch<'a> {
    planes: Vec<SamplePlane>,
    /// One sample at the pixel's centre, for depth, item and normal: made where they are first requested.
    center: Vec<SamplePlane>,
    known: KnownNormals,
    blended: Blended,
    queue: PointQueue,
    codes: Box<Codes>,
    lit: Lit<'a>,
    order: FrontToBack<'a>,
}

impl<'a> Scratch<'a> {
    fn new(frame: &Frame<'a>) -> Self {
        let offsets = frame.options.samples.offsets();
        Self {
            planes: SamplePlane::of(offsets),
            center: Vec::new(),
            known: KnownNormals::new(TILE_PIXELS, offsets.len()),
            blended: Blended::new(offsets),
            queue: PointQueue::new(TILE_PIXELS),
            codes: Box::new([0; TILE_PIXELS]),
            lit: Lit::new(frame.lighting),
            order: FrontToBack::default(),
        }
    }
}

impl<'a> Frame<'a> {
    fn render_band(&self, mut band: Band<'_>, scratch: &mut Scratch<'a>) {
        let grid = TileGrid::of(self.view);
        let wants_center = band.wants_center();
        let first = band.row * grid.columns.cast_unsigned();
        for index in first..first + grid.columns.cast_unsigned() {
            let tile = grid.origin(index);
            let size = [
                TILE.min(self.view.width() as i32 - tile[0]),
                TILE.min(self.view.height() as i32 - tile[1]),
            ];
            if self.occupied[index as usize] {
                self.color_tile(&mut band, scratch, [tile, size], index);
            } else {
                self.empty_tile(&mut band, [tile, size]);
            }
            if wants_center {
                self.center_tile(&mut band, scratch, [tile, size], index);
            }
        }
    }

    /// Rasterizes the tile's opaque triangles.
    fn rasterize_opaque(
        &self,
        order: &mut FrontToBack<'a>,
        (planes, known): (&mut [SamplePlane], &mut KnownNormals),
        area: [[i32; 2]; 2],
        index: u32,
    ) {
        let binned = self.binned;
        binned.draw_fragments(planes, Some(known), index);
        // Without back faces little is hidden, and sorting would not pay off.
        if self.options.cull == Cull::Back {
            return binned.rasterize(Coverage::Opaque, planes, area, index, None::<&mut AllPass>);
        }
        let mut drawn = binned.has_fragments(index);
        for part in order.parts(binned, index) {
            dispatch!(self.options.level, simd => {
                if std::mem::take(&mut drawn) {
                    planes.iter_mut().for_each(|plane| plane.find_farthest(simd));
                }
                let farthest = planes.iter().map(SamplePlane::farthest_of_all).fold(0, i32::max);
                let is_seen = |t: &&ScreenTriangle| t.depth_min.to_bits() as i32 <= farthest;
                let triangles = part.iter().copied().filter(is_seen).inspect(|_| drawn = true);
                rasterize(simd, planes, area, triangles, None::<&mut AllPass>)
            });
        }
    }

    /// Fills a tile that shows only the background.
    fn empty_tile(&self, band: &mut Band<'_>, [tile, size]: [[i32; 2]; 2]) {
        let background = background_rows(self.options.background, self.view.height());
        for ([_, y], row) in band.rows_of(tile, size) {
            row.fill(encode_premultiplied(premultiply(background(tile[1] + y))));
        }
    }

    fn color_tile(
        &self,
        band: &mut Band<'_>,
        scratch: &mut Scratch<'a>,
        area: [[i32; 2]; 2],
        index: u32,
    ) {
        let [tile, size] = area;
        let Scratch { planes, known, blended, queue, codes, lit, order, .. } = scratch;
        known.clear();
        blended.clear();
        planes.iter_mut().for_each(SamplePlane::clear);
        self.rasterize_opaque(order, (planes, known), area, index);
        let mut mask = MaskTest { lit, tile };
        self.binned.rasterize(Coverage::Masked, planes, area, index, Some(&mut mask));
        let nearest_first = order.nearest_first(self.binned, index);
        if !nearest_first.is_empty() {
            dispatch!(self.options.level, simd =>
                light_blended(simd, blended, nearest_first, planes, area, lit));
        }
        let background = background_rows(self.options.background, self.view.height());
        let area = Area::new(area, background);
        dispatch!(self.options.level, simd =>
            resolve(simd, (planes, known), blended, queue, lit, &area, codes));
        for ([x, y], row) in band.rows_of(tile, size) {
            let codes = &codes[(y * TILE + x) as usize..];
            for (to, code) in row.iter_mut().zip(codes) {
                *to = code.to_le_bytes();
            }
        }
    }

    /// Draws depth, item and normal of a tile: one sample at the centre, where blended surfaces count as opaque.
    fn center_tile(
        &self,
        band: &mut Band<'_>,
        scratch: &mut Scratch<'_>,
        area: [[i32; 2]; 2],
        index: u32,
    ) {
        let [tile, size] = area;
        let Scratch { center, lit, .. } = scratch;
        if center.is_empty() {
            *center = SamplePlane::of(&[[0; 2]]);
        }
        center.iter_mut().for_each(SamplePlane::clear);
        self.binned.draw_fragments(center, None, index);
        for coverage in [Coverage::Opaque, Coverage::Blended] {
            self.binned.rasterize(coverage, center, area, index, None::<&mut AllPass>);
        }
        let mut mask = MaskTest { lit, tile };
        self.binned.rasterize(Coverage::Masked, center, area, index, Some(&mut mask));
        let plane = &center[0];
        for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
            let from = (y * TILE + x) as usize;
            let Some(to) = band.place([tile[0] + x, tile[1] + y]) else { continue };
            let item = plane.items(from)[0];
            if let Some(depth) = &mut band.depth {
                depth[to] = plane.depth(from);
            }
            if let Some(items) = &mut band.item {
                items[to] = if item < self.triangle_count { item } else { NO_ITEM };
            }
            if let Some(normal) = &mut band.normal
                && item != NO_ITEM
            {
                normal[to] = lit.normal(item, tile[0] + x, tile[1] + y).to_array();
            }
        }
    }
}
