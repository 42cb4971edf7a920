//! The one scene that all visible-surface algorithms start from.

use crate::scene::Scene;
use crate::simd::default_level;
use crate::view::View;
use crate::visibility::surface::setup::{
    Assembler, Coverage, Run, ScreenTriangle, TriangleCounts, TriangleFilter, runs,
};
use crate::work::Work;

/// The triangles of a scene on the screen, in item order: the input of each algorithm.
///
/// A triangle that was cut at the near plane has several pieces with the same item. The production
/// z-buffer does without this list; all others read it.
#[derive(Debug, Clone)]
pub struct SurfaceInput<'a> {
    /// The scene, which has passed [`Scene::check`].
    pub scene: &'a Scene,
    /// The camera and the screen.
    pub view: &'a View,
    /// Filter that chose the triangles.
    pub filter: TriangleFilter,
    /// Runs of items that share an instance and a material.
    pub(crate) runs: Vec<Run>,
    /// All triangles that may cover a sample.
    pub triangles: Vec<ScreenTriangle>,
    /// Counts of the scene's triangles by their treatment.
    pub(crate) counts: TriangleCounts,
    /// Budget for the triangles' memory, and cancellation.
    pub work: Work,
}

/// Stage in which a method builds its own lists from the triangles.
pub(crate) const METHOD: &str = "lists of the method";

/// Primitives that are set up between two checks of their memory.
const STEP: usize = 1 << 18;

impl<'a> SurfaceInput<'a> {
    /// Transforms, clips and snaps the scene's triangles.
    ///
    /// # Errors
    /// [`crate::Error::Limit`] if the scene has too many primitives to number.
    pub fn new(scene: &'a Scene, view: &'a View, filter: TriangleFilter) -> crate::Result<Self> {
        Self::within(&Work::default(), scene, view, filter)
    }

    /// Builds it like [`Self::new`], within a budget; methods that work on the triangles stop when it
    /// is cancelled.
    ///
    /// # Errors
    /// As [`Self::new`], and [`crate::Error::Memory`] if the budget has no room for the triangles.
    pub(crate) fn within(
        work: &Work,
        scene: &'a Scene,
        view: &'a View,
        filter: TriangleFilter,
    ) -> crate::Result<Self> {
        let work = work.part();
        let mut kept = 0;
        let runs = runs(scene)?;
        let mut assembler = Assembler::new(scene, view, filter, default_level());
        let mut triangles = Vec::new();
        for run in &runs {
            for start in run.range.clone().step_by(STEP) {
                let end = start.saturating_add(STEP as u32).min(run.range.end);
                assembler.primitives(run, start..end, &mut triangles);
                let bytes = (triangles.capacity() * size_of::<ScreenTriangle>()) as u64;
                work.keep("triangles on the screen", bytes - kept)?;
                kept = bytes;
            }
        }
        let counts = assembler.counts;
        Ok(Self { scene, view, filter, runs, triangles, counts, work })
    }

    /// Returns the run that a triangle of [`Self::triangles`] belongs to.
    pub(crate) fn run_of(&self, item: u32) -> &Run {
        &self.runs[crate::visibility::surface::points::attributes::run_of(&self.runs, item)]
    }

    /// Returns the triangles of [`Self::triangles`] with one kind of coverage.
    pub(crate) fn having(&self, coverage: Coverage) -> TriangleSet {
        let has = |t: &ScreenTriangle| self.run_of(t.item).coverage == coverage;
        match self.runs.iter().any(|run| run.coverage == coverage) {
            true => TriangleSet(self.triangles.iter().map(has).collect()),
            false => TriangleSet(Vec::new()),
        }
    }
}

/// Some of the triangles of an input.
#[derive(Debug, Clone)]
pub(crate) struct TriangleSet(Vec<bool>);

impl TriangleSet {
    /// Returns whether the triangle at a place of the input's list is one of them.
    #[inline(always)]
    pub fn contains(&self, triangle: usize) -> bool {
        self.0.get(triangle).copied().unwrap_or(false)
    }

    /// Returns whether there can be none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
