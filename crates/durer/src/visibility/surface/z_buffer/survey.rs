//! Survey of the visible items of a scene that comes in pieces and is never held as a whole.
//!
//! Depth and item of the nearest triangle are kept for all samples of the picture, so that the memory needed depends on
//! the picture, not on the scene. The visible triangles then form a scene of which the ordinary renderer makes the same
//! picture, because opaque surfaces that are nowhere nearest do not change it.

use super::bins::{ByTile, STAGE, sort_by_tile};
use super::early_samples;
use super::micropolygon::{Fragments, MOST_TILES, Micropolygons};
use super::rasterize::{AllPass, rasterize};
use super::tile::{SamplePlane, TILE, TILE_PIXELS};
use super::tile_grid::TileGrid;
use crate::scene::Scene;
use crate::simd::Level;
use crate::simd::dispatch;
use crate::target::NO_ITEM;
use crate::view::View;
use crate::visibility::surface::Samples;
use crate::visibility::surface::setup::{
    Assembler, Counts, Coverage, Filter, Run, Sampled, ScreenTriangle, Sink, runs,
};
use crate::work::{Charge, Work};
use crate::{Error, Result};
use fearless_simd::Simd;
use std::ops::Range;

/// The most items of all pieces: of equal depths the lower item wins, which is decided by the sign of a difference.
pub const MOST_ITEMS: u64 = i32::MAX as u64;

/// Triangles that are set up together.
const JOB: usize = 8192;

/// Options of a survey.
#[derive(Debug, Clone)]
pub struct Options {
    /// Samples per pixel of the colour plane.
    pub samples: Samples,
    /// True to include pixels' centres, for the planes of depth, item and normal.
    pub centers: bool,
    /// Triangles to leave out, and the size of points and lines.
    pub filter: Filter,
    /// SIMD level.
    pub level: Level,
    /// Budget of the work, and its cancellation.
    pub work: Work,
}

/// The nearest items so far.
pub struct Survey {
    view: View,
    options: Options,
    tiles: Vec<Vec<SamplePlane>>,
    /// Items of the pieces so far.
    count: u32,
    counts: Counts,
    /// Charge of the samples to the budget.
    charge: Charge,
}

/// Result of a survey.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// The items that are seen at some sample, ascending; they count through all pieces.
    pub items: Vec<u32>,
    /// Counts of the triangles by their treatment.
    pub counts: Counts,
    /// Charge of the list to the budget.
    _charge: Charge,
}

/// Triangles of a piece on the screen, by the tiles that they touch.
struct Binned {
    triangles: Vec<ScreenTriangle>,
    touching: ByTile,
    counts: Counts,
    _charge: Charge,
}

/// Sink of triangles; small ones are sampled at once, where pixels have one sample, as in a picture.
struct Taken<'f> {
    triangles: Vec<ScreenTriangle>,
    early: &'static [[i32; 2]],
    small: Micropolygons<'f>,
}

impl Sink for Taken<'_> {
    #[inline(always)]
    fn take(&mut self, triangle: ScreenTriangle) {
        self.triangles.push(triangle);
    }

    #[inline(always)]
    fn takes_sampled(&self) -> &'static [[i32; 2]] {
        self.early
    }

    #[inline(always)]
    fn take_sampled<S: Simd>(
        &mut self,
        simd: S,
        sampled: &Sampled,
        which: u64,
        primitive: impl Fn(usize) -> (u32, [u32; 3]),
    ) {
        self.small.add(simd, None, (sampled, which), primitive);
    }
}

impl Survey {
    /// Creates an empty survey.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has no room for the samples.
    pub fn new(view: &View, options: Options) -> Result<Self> {
        let offsets = options.samples.offsets();
        let mut count = offsets.len() as u64;
        let with_centers = options.centers && options.samples != Samples::One;
        count += u64::from(with_centers);
        let tiles = TileGrid::of(view).count();
        let samples = u64::from(tiles) * TILE_PIXELS as u64 * count;
        // One depth and one item for each sample.
        let charge = options.work.charge("samples of the picture", samples.saturating_mul(8))?;
        let planes = || {
            let mut planes = SamplePlane::of(offsets);
            if with_centers {
                planes.extend(SamplePlane::of(&[[0; 2]]));
            }
            planes
        };
        let tiles = (0..tiles).map(|_| planes()).collect();
        let counts = Counts::default();
        Ok(Self { view: *view, options, tiles, count: 0, counts, charge })
    }

    /// Examines the next piece: a scene that has passed [`Scene::check`], all of whose surfaces are opaque.
    ///
    /// # Errors
    /// [`Error::Limit`] for more than [`MOST_ITEMS`], [`Error::Unsupported`] for surfaces that are not opaque,
    /// [`Error::Memory`] if the budget has no room for the piece, and the error of stopped work.
    pub fn add(&mut self, piece: &Scene) -> Result<()> {
        self.options.work.check()?;
        let runs = self.numbered(runs(piece)?)?;
        let (binned, small) = crate::parallel::map_and_keep(
            jobs(&runs),
            Fragments::default,
            |small, (run, range)| self.set_up(piece, run, range, small),
        );
        let binned = binned.into_iter().collect::<Result<Vec<Binned>>>()?;
        let _small = self.options.work.charge(STAGE, small.iter().map(Fragments::bytes).sum())?;
        for of_job in &binned {
            self.counts += of_job.counts;
        }
        let (view, level) = (&self.view, self.options.level);
        let tiles = self.tiles.iter_mut().enumerate().collect();
        crate::parallel::map(tiles, |(index, planes): (usize, &mut Vec<SamplePlane>)| {
            draw(planes, view, level, index as u32, (&binned, &small));
        });
        Ok(())
    }

    /// Returns the runs with items numbered on from the pieces before.
    fn numbered(&mut self, mut runs: Vec<Run>) -> Result<Vec<Run>> {
        if runs.iter().any(|run| run.coverage != Coverage::Opaque) {
            let what = "a picture in pieces of surfaces that are not opaque";
            return Err(Error::Unsupported { what, instead: "the whole scene must be in memory" });
        }
        let own: u64 = runs.iter().map(|run| run.range.len() as u64).sum();
        let value = u64::from(self.count) + own;
        if value > MOST_ITEMS {
            return Err(Error::Limit { what: "items", value, limit: MOST_ITEMS });
        }
        runs.iter_mut().for_each(|run| run.first_item += self.count);
        self.count = value as u32;
        Ok(runs)
    }

    fn set_up(
        &self,
        piece: &Scene,
        run: &Run,
        range: Range<u32>,
        small: &mut Fragments,
    ) -> Result<Binned> {
        let Options { filter, level, work, .. } = &self.options;
        let screen = TileGrid::of(&self.view);
        let early = early_samples(self.options.samples, self.options.centers);
        let early = if screen.count() <= MOST_TILES { early } else { &[] };
        let small = Micropolygons::new(screen, early, small);
        let mut taken = Taken { triangles: Vec::with_capacity(range.len()), early, small };
        let mut assembler = Assembler::new(piece, &self.view, *filter, *level);
        assembler.primitives(run, range, &mut taken);
        let Taken { triangles, mut small, .. } = taken;
        small.finish(*level, None);
        let mut touched = Vec::with_capacity(triangles.len());
        for (i, triangle) in triangles.iter().enumerate() {
            screen.touched(triangle, filter.sample_reach, |tile| touched.push((tile, i as u32)));
        }
        let touching = sort_by_tile(&touched, screen.count());
        let bytes = triangles.capacity() * size_of::<ScreenTriangle>() + 4 * touched.len();
        let _charge = work.charge(STAGE, bytes as u64)?;
        Ok(Binned { triangles, touching, counts: assembler.counts, _charge })
    }

    /// Returns the visible triangles of all pieces.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has no room for the list.
    pub fn finish(self) -> Result<Seen> {
        let Self { tiles, options: Options { work, .. }, counts, charge: _charge, .. } = self;
        let mut charge = work.charge("triangles that are seen", 0)?;
        let mut items = Vec::new();
        let mut of_tile = Vec::new();
        for planes in tiles {
            of_tile.clear();
            for plane in &planes {
                of_tile.extend(plane.item.iter().copied().filter(|&item| item != NO_ITEM));
            }
            of_tile.sort_unstable();
            of_tile.dedup();
            items.extend_from_slice(&of_tile);
            charge.grow_to(4 * items.capacity() as u64)?;
        }
        items.sort_unstable();
        items.dedup();
        Ok(Seen { items, counts, _charge: charge })
    }
}

/// Returns the pieces of runs that one thread sets up at a time.
fn jobs(runs: &[Run]) -> Vec<(&Run, Range<u32>)> {
    let of_run = |run: &'_ Run| {
        let end = run.range.end;
        run.range.clone().step_by(JOB).map(move |start| start..end.min(start + JOB as u32))
    };
    runs.iter().flat_map(|run| of_run(run).map(move |range| (run, range))).collect()
}

/// Draws the triangles that touch a tile.
fn draw(
    planes: &mut [SamplePlane],
    view: &View,
    level: Level,
    index: u32,
    (binned, small): (&[Binned], &[Fragments]),
) {
    let tile = TileGrid::of(view).origin(index);
    let sides = [view.width() as i32 - tile[0], view.height() as i32 - tile[1]];
    let area = [tile, sides.map(|side| side.min(TILE))];
    let mut drawn = false;
    for fragments in small {
        // There are no fragments if pixels have more samples than a plane contains.
        if let [plane] = planes {
            dispatch!(level, simd => Fragments::draw(simd, fragments, plane, None, index));
        }
        drawn |= !fragments.nothing_in(index);
    }
    for Binned { triangles, touching, .. } in binned {
        let triangles = touching.of(index).iter().map(|&i| &triangles[i as usize]);
        let triangles = triangles.inspect(|_| drawn = true);
        dispatch!(level, simd => rasterize(simd, planes, area, triangles, None::<&mut AllPass>));
    }
    if drawn {
        // Triangles behind the farthest depth are left out of the following pieces.
        dispatch!(level, simd => planes.iter_mut().for_each(|plane| plane.find_farthest(simd)));
    }
}
