//! Survey of the visible items of a scene that comes in pieces and is never held as a whole.
//!
//! Depth and item of the nearest triangle are kept for all samples of the picture, so that the memory needed depends on
//! the picture, not on the scene. The visible triangles then form a scene of which the ordinary renderer makes the same
//! picture, because opaque surfaces that are nowhere nearest do not change it.

use super::bins::{Binned, Source};
use super::early_samples;
use super::rasterize::AllPass;
use super::tile::{SamplePlane, TILE, TILE_PIXELS};
use super::tile_grid::TileGrid;
use crate::scene::Scene;
use crate::simd::{Level, dispatch};
use crate::target::NO_ITEM;
use crate::view::View;
use crate::visibility::surface::Samples;
use crate::visibility::surface::setup::{Coverage, Run, TriangleCounts, TriangleFilter, runs};
use crate::work::{Charge, Work};
use crate::{Error, Result};

/// The most items of all pieces: of equal depths the lower item wins, which is decided by the sign of a difference.
pub const MOST_ITEMS: u64 = i32::MAX as u64;

/// Options of a survey.
#[derive(Debug, Clone)]
pub struct Options {
    /// Samples per pixel of the colour plane.
    pub samples: Samples,
    /// True to include pixels' centres, for the planes of depth, item and normal.
    pub centers: bool,
    /// Triangles to leave out, and the size of points and lines.
    pub filter: TriangleFilter,
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
    counts: TriangleCounts,
    /// Charge of the samples to the budget.
    charge: Charge,
}

/// Result of a survey.
#[derive(Debug, Clone, PartialEq)]
pub struct SurveyResult {
    /// The items that are seen at some sample, ascending; they count through all pieces.
    pub items: Vec<u32>,
    /// Counts of the triangles by their treatment.
    pub counts: TriangleCounts,
    /// Charge of the list to the budget.
    _charge: Charge,
}

impl Survey {
    /// Creates an empty survey.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has no room for the samples.
    pub(crate) fn new(view: &View, options: Options) -> Result<Self> {
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
        let counts = TriangleCounts::default();
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
        let Options { samples, centers, filter, level, ref work } = self.options;
        let (scene, view, early) = (piece, &self.view, early_samples(samples, centers));
        let source = Source { scene, view, runs: &runs, filter, early, lighting: None, level };
        let binned = Binned::new(&source, work)?;
        self.counts += binned.counts();
        let occupied = binned.occupied(view);
        let tiles = (0..).zip(&mut self.tiles).zip(occupied).filter(|(_, occupied)| *occupied);
        crate::parallel::map(tiles.collect(), |((index, planes), _): ((u32, &mut Vec<_>), _)| {
            draw(planes, view, level, index, &binned);
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
            return Err(Error::Limit { what: "number of items", value, limit: MOST_ITEMS });
        }
        runs.iter_mut().for_each(|run| run.first_item += self.count);
        self.count = value as u32;
        Ok(runs)
    }

    /// Returns the visible triangles of all pieces.
    ///
    /// # Errors
    /// [`Error::Memory`] if the budget has no room for the list.
    pub fn finish(self) -> Result<SurveyResult> {
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
        Ok(SurveyResult { items, counts, _charge: charge })
    }
}

/// Draws the triangles that touch a tile.
fn draw(planes: &mut [SamplePlane], view: &View, level: Level, index: u32, binned: &Binned) {
    let tile = TileGrid::of(view).origin(index);
    let sides = [view.width() as i32 - tile[0], view.height() as i32 - tile[1]];
    let area = [tile, sides.map(|side| side.min(TILE))];
    binned.draw_fragments(planes, None, index);
    binned.rasterize(Coverage::Opaque, planes, area, index, None::<&mut AllPass>);
    // Triangles behind the farthest depth are left out of the following pieces.
    dispatch!(level, simd => planes.iter_mut().for_each(|plane| plane.find_farthest(simd)));
}
