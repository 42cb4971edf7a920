//! The lists of the triangles that touch each tile: lists per job, joined in the order of the jobs. Fragments of small
//! triangles have no order, and stay with the thread that made them.

use super::micropolygon::{Fragments, MOST_TILES, Micropolygons};
use super::rasterize::{FragmentTest, rasterize};
use super::tile::SamplePlane;
use super::tile_grid::TileGrid;
use crate::Result;
use crate::scene::Scene;
use crate::simd::{Level, dispatch};
use crate::view::View;
use crate::visibility::surface::lit::{KnownNormals, Lighting};
use crate::visibility::surface::points::triangles::RunNormals;
use crate::visibility::surface::setup::{
    Assembler, Coverage, Run, Sampled, ScreenTriangle, ScreenVertex, Sink, TriangleCounts,
    TriangleFilter,
};
use crate::work::{Charge, Work};
use fearless_simd::Simd;
use std::ops::Range;

/// The least triangles per job, enough to keep a thread busy for about a tenth of a millisecond, and the most, whose
/// vertices stay in the second-level cache: those at the borders of jobs are transformed twice.
const JOB_TRIANGLES: [u32; 2] = [8192, 32768];

/// Number of jobs that share the work evenly, unless they are too small.
const JOBS: u32 = 32;

/// A scene whose triangles are set up, and how.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub runs: &'a [Run],
    pub filter: TriangleFilter,
    /// Samples at which small opaque triangles are sampled during set-up, one or four; none to keep all triangles.
    pub early: &'static [[i32; 2]],
    /// Lighting that needs normals of small triangles.
    pub lighting: Option<&'a Lighting<'a>>,
    pub level: Level,
}

/// Pieces of runs that one thread sets up at a time; all of one coverage.
struct Job {
    coverage: Coverage,
    pieces: Vec<(usize, Range<u32>)>,
}

/// Divides the runs into jobs: opaque ones first, then masked, then blended, each in scene order.
fn jobs(runs: &[Run]) -> Vec<Job> {
    let all = runs.iter().fold(0, |sum: u32, run| sum.saturating_add(run.range.len() as u32));
    let [least, most] = JOB_TRIANGLES;
    let size = (all / JOBS).clamp(least, most);
    let mut jobs: Vec<Job> = Vec::new();
    for coverage in [Coverage::Opaque, Coverage::Masked, Coverage::Blended] {
        let mut room = 0;
        for (index, run) in runs.iter().enumerate().filter(|(_, r)| r.coverage == coverage) {
            let mut start = run.range.start;
            while start < run.range.end {
                if room == 0 {
                    jobs.push(Job { coverage, pieces: Vec::new() });
                    room = size;
                }
                let end = run.range.end.min(start.saturating_add(room));
                room -= end - start;
                if let Some(job) = jobs.last_mut() {
                    job.pieces.push((index, start..end));
                }
                start = end;
            }
        }
    }
    jobs
}

/// The triangles of one job and the tiles that they touch.
pub struct Bins {
    /// Treatment of the fragments of the job's triangles.
    coverage: Coverage,
    /// Counts of the job's triangles.
    counts: TriangleCounts,
    triangles: Vec<ScreenTriangle>,
    /// Triangles that touch each tile, in item order.
    touching: ByTile,
}

/// Buffers for making [`Bins`], which are used again; and the fragments of small triangles, of all jobs that were done
/// with them.
#[derive(Default)]
struct Scratch {
    /// Tile and triangle.
    touched: Vec<(u32, u32)>,
    vertices: Vec<ScreenVertex>,
    /// Fragments of triangles that are not among those in the bins.
    fragments: Fragments,
    /// Charge of the fragments to the budget.
    charge: Option<Charge>,
}

/// Name of triangles and fragments in errors about memory.
const STAGE: &str = "triangles on the screen";

impl Scratch {
    /// Charges the growth of the fragments to a budget.
    fn charge(&mut self, work: &Work) -> Result<()> {
        let charge = match &mut self.charge {
            Some(charge) => charge,
            none => none.insert(work.charge(STAGE, 0)?),
        };
        charge.grow_to(self.fragments.bytes())
    }
}

/// The triangles of a scene on the screen, by tile.
pub struct Binned {
    /// Lists of the jobs, in their order.
    bins: Vec<Bins>,
    /// Fragments of small triangles, in no order.
    pub fragments: Vec<Fragments>,
    level: Level,
    _charges: Vec<Charge>,
}

impl Binned {
    /// Sets up all triangles of a scene.
    ///
    /// # Errors
    /// [`crate::Error::Memory`] if the budget has no room for them, and the error of stopped work.
    pub fn new(source: &Source<'_>, work: &Work) -> Result<Self> {
        let jobs = jobs(source.runs);
        let (bins, scratch) =
            crate::parallel::map_and_keep(jobs, Scratch::default, |scratch, job| {
                work.check()?;
                let bins = Bins::new(&job, source, scratch);
                scratch.charge(work)?;
                let charge = work.charge(STAGE, bins.bytes())?;
                Ok((bins, charge))
            });
        let bins = bins.into_iter().collect::<Result<Vec<(Bins, Charge)>>>()?;
        let (bins, mut charges): (Vec<Bins>, Vec<Charge>) = bins.into_iter().unzip();
        let mut fragments = Vec::new();
        for Scratch { fragments: of_thread, charge, .. } in scratch {
            fragments.push(of_thread);
            charges.extend(charge);
        }
        Ok(Self { bins, fragments, level: source.level, _charges: charges })
    }

    /// Returns the counts of all triangles.
    pub fn counts(&self) -> TriangleCounts {
        let mut counts = TriangleCounts::default();
        self.bins.iter().for_each(|bins| counts += bins.counts);
        counts
    }

    /// Returns the lists of triangles of one coverage.
    pub fn having(&self, coverage: Coverage) -> impl Iterator<Item = &Bins> + '_ {
        self.bins.iter().filter(move |bins| bins.coverage == coverage)
    }

    /// Returns, for each tile of a view, whether it has triangles.
    pub fn occupied(&self, view: &View) -> Vec<bool> {
        let tiles = 0..TileGrid::of(view).count();
        let mut occupied: Vec<bool> = tiles.map(|tile| self.has_fragments(tile)).collect();
        for (tile, _) in self.bins.iter().flat_map(|bins| &bins.touching.starts) {
            occupied[*tile as usize] = true;
        }
        occupied
    }

    /// Returns whether a tile has fragments of small triangles.
    pub fn has_fragments(&self, tile: u32) -> bool {
        !self.fragments.iter().all(|of_thread| of_thread.nothing_in(tile))
    }

    /// Rasterizes a tile's triangles of one coverage.
    pub fn rasterize<T: FragmentTest>(
        &self,
        coverage: Coverage,
        planes: &mut [SamplePlane],
        area: [[i32; 2]; 2],
        tile: u32,
        mut test: Option<&mut T>,
    ) {
        for bins in self.having(coverage) {
            let (triangles, test) = (bins.of_tile(tile), test.as_deref_mut());
            dispatch!(self.level, simd => rasterize(simd, planes, area, triangles, test));
        }
    }

    /// Draws the fragments of a tile, and sets normals in `known` where they are visible.
    pub fn draw_fragments(
        &self,
        planes: &mut [SamplePlane],
        mut known: Option<&mut KnownNormals>,
        tile: u32,
    ) {
        // There are no fragments if pixels have more samples than a plane contains.
        let [plane] = planes else { return };
        for fragments in &self.fragments {
            dispatch!(self.level, simd =>
                Fragments::draw(simd, fragments, plane, known.as_deref_mut(), tile));
        }
    }
}

impl Bins {
    /// Sets up the triangles of a job and sorts them into tiles.
    fn new(job: &Job, source: &Source<'_>, scratch: &mut Scratch) -> Self {
        let Source { scene, view, runs, filter, early, lighting, level } = *source;
        let Scratch { touched, fragments, vertices, .. } = scratch;
        touched.clear();
        let mut assembler = Assembler::new(scene, view, filter, level);
        assembler = assembler.with_memory(std::mem::take(vertices));
        let most = job.pieces.iter().map(|(_, range)| range.len()).sum();
        // Only opaque triangles are sampled during set-up, and only if places of the screen fit their numbers.
        let screen = TileGrid::of(view);
        let is_early = job.coverage == Coverage::Opaque && screen.count() <= MOST_TILES;
        let early = if is_early { early } else { &[] };
        let mut sorter = Sorter {
            screen,
            reach: filter.sample_reach,
            triangles: Vec::with_capacity(most),
            touched,
            early,
            micropolygons: Micropolygons::new(screen, early, fragments),
            normals: None,
        };
        // Each run is assembled into the sorter, with normals for small triangles if its lighting needs them.
        for (run, range) in &job.pieces {
            let lighting = lighting.filter(|_| !early.is_empty());
            let normals = lighting.is_some_and(|lighting| lighting.asks_for_normals(*run));
            sorter.normals =
                normals.then(|| RunNormals::new(scene, view, runs, (*run, filter.sample_reach)));
            assembler.primitives(&runs[*run], range.clone(), &mut sorter);
            sorter.micropolygons.finish(level, sorter.normals.as_ref());
        }
        let mut triangles = sorter.triangles;
        if triangles.len() < most / 2 {
            // Most triangles were sampled or left out; the space reserved for them would stay.
            triangles.shrink_to_fit();
        }
        let (coverage, counts) = (job.coverage, assembler.counts);
        *vertices = assembler.into_memory();
        let touching = sort_by_tile(touched, screen.count());
        Self { coverage, counts, triangles, touching }
    }

    /// Returns their size in bytes.
    fn bytes(&self) -> u64 {
        let ByTile { starts, entries } = &self.touching;
        let triangles = self.triangles.capacity() * size_of::<ScreenTriangle>();
        (triangles + starts.capacity() * 8 + entries.capacity() * 4) as u64
    }

    /// Returns the triangles that touch a tile, in item order.
    pub fn of_tile(&self, tile: u32) -> impl Iterator<Item = &ScreenTriangle> + '_ {
        self.touching.of(tile).iter().map(|&e| &self.triangles[e as usize])
    }
}

/// Sorter that keeps triangles, and finds the tiles that they touch.
struct Sorter<'s> {
    screen: TileGrid,
    reach: i32,
    triangles: Vec<ScreenTriangle>,
    /// Tile and triangle.
    touched: &'s mut Vec<(u32, u32)>,
    /// The samples at which small triangles are sampled at once.
    early: &'static [[i32; 2]],
    micropolygons: Micropolygons<'s>,
    /// Normals of the run whose triangles come, if they are needed.
    normals: Option<RunNormals<'s>>,
}

impl Sink for Sorter<'_> {
    #[inline(always)]
    fn take(&mut self, triangle: ScreenTriangle) {
        let index = self.triangles.len();
        // Stored first: reading its numbers from memory is then faster than from its parts.
        self.triangles.push(triangle);
        let touched = &mut self.touched;
        self.screen.touched(&self.triangles[index], self.reach, |tile| {
            touched.push((tile, index as u32));
        });
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
        self.micropolygons.add(simd, self.normals.as_ref(), (sampled, which), primitive);
    }
}

/// Triangles by the tiles that they touch.
struct ByTile {
    /// Tiles with something in them, ascending, and where their entries begin.
    starts: Vec<(u32, u32)>,
    entries: Vec<u32>,
}

impl ByTile {
    /// Returns the entries of a tile.
    fn of(&self, tile: u32) -> &[u32] {
        match self.starts.binary_search_by_key(&tile, |s| s.0) {
            Ok(i) => {
                let end = self.starts.get(i + 1).map_or(self.entries.len(), |s| s.1 as usize);
                &self.entries[self.starts[i].1 as usize..end]
            }
            Err(_) => &[],
        }
    }
}

/// Sorts (tile, triangle) pairs by tile, keeping the order of the triangles.
fn sort_by_tile(touched: &[(u32, u32)], tiles: u32) -> ByTile {
    let mut next = vec![0u32; tiles as usize + 1];
    for (tile, _) in touched {
        next[*tile as usize + 1] += 1;
    }
    let mut starts = Vec::new();
    for tile in 0..tiles as usize {
        if next[tile + 1] > 0 {
            starts.push((tile as u32, next[tile]));
        }
        next[tile + 1] += next[tile];
    }
    let mut entries = vec![0; touched.len()];
    for (tile, triangle) in touched {
        let slot = &mut next[*tile as usize];
        entries[*slot as usize] = *triangle;
        *slot += 1;
    }
    ByTile { starts, entries }
}
