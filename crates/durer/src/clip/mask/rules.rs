//! The fill rule and grid of polygons, and valid polygons by them.

use super::Area;
use super::area::oriented;
use crate::Result;
use crate::clip::polygon::overlay::{self, overlay};
use crate::clip::polygon::validity::{Touching, is_valid};
use crate::clip::polygon::{BooleanOp, Shapes, WindingRule, coverage, vatti};
use crate::geometry::Geometry;
use crate::math::{DVec2, Rect};
use crate::trace::NoTrace;
use crate::work::Work;

/// Fill rule of polygons and grid of their crossings.
#[derive(Debug, Clone, Default)]
pub struct Rules {
    /// Rule that decides which points crossing rings enclose.
    pub fill: WindingRule,
    /// Size of a cell of the grid on which vertices are placed, in units of the coordinates; `None` computes
    /// exactly.
    pub grid: Option<f64>,
    /// Budget of memory, and whether to go on.
    pub work: Work,
}

/// Valid polygons with the region of others.
#[derive(Debug, Default)]
pub struct Made {
    /// The polygons, with heights and measures.
    pub area: Area,
    /// True if the others were not valid.
    pub repaired: bool,
    /// Points that stay on the grid, as in [`Cut::snapped`](super::Cut::snapped).
    pub snapped: usize,
}

impl Rules {
    /// Returns whether valid polygons keep the area that they enclose by the even-odd rule, and their position.
    pub(super) fn keep_valid(&self, shapes: &Shapes) -> bool {
        let as_even_odd = match self.fill {
            WindingRule::EvenOdd => true,
            // Holes may run the same way as the rings around them.
            WindingRule::NonZero => shapes.polygons().all(|p| p.holes().len() == 0),
            WindingRule::Positive | WindingRule::Negative | WindingRule::AbsGeqTwo => false,
        };
        as_even_odd && self.grid.is_none()
    }

    /// Returns whether a polygon of the mask is smaller than a cell of the grid, so that it may be lost.
    pub fn loses(&self, area: &Area, mask: &Shapes) -> bool {
        let Some(cell) = self.options(area, mask, self.fill).grid else { return false };
        let size = |ring: &[DVec2]| Rect::around(ring.iter().copied()).map(|r| r.size());
        mask.polygons().filter_map(|p| size(p.outer())).any(|size| size.max_element() < cell)
    }

    /// Returns the overlay's options: the finest grid that it takes, unless one is given.
    fn options(&self, area: &Area, clip: &Shapes, subject_rule: WindingRule) -> overlay::Options {
        let fit = || coverage::finest_grid([area.shapes.bounds(), clip.bounds()]);
        overlay::Options {
            subject_rule,
            clip_rule: WindingRule::EvenOdd,
            grid: self.grid.or_else(fit),
            origins: true,
            drop_collinear: false,
            work: self.work.clone(),
        }
    }

    /// Overlays any polygons with valid polygons: on the grid if one is set, else exactly.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for coordinates that are not finite, and a grid that is too fine for them.
    pub fn overlay(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: WindingRule,
    ) -> Result<Made> {
        self.join(area, clip, op, subject_rule, false)
    }

    fn join(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: WindingRule,
        mend: bool,
    ) -> Result<Made> {
        if self.grid.is_some() {
            let area = self.snapped(area, clip, op, subject_rule)?;
            return Ok(Made { area, ..Made::default() });
        }
        let work = self.work.clone();
        let options = coverage::Options { rule: subject_rule, mend, keep: false, work };
        let cut = coverage::join(&area.shapes, clip, op, &options)?;
        let snapped = cut.snapped;
        Ok(Made { area: area.cut(cut.shapes, &cut.sources), repaired: false, snapped })
    }

    /// Overlays with all vertices on the grid.
    pub(super) fn snapped(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: WindingRule,
    ) -> Result<Area> {
        let options = self.options(area, clip, subject_rule);
        Ok(area.overlaid(&overlay(&area.shapes, clip, op, &options, &mut NoTrace)?))
    }

    /// Overlays like [`Rules::overlay`] by Vatti's sweep; all vertices are on the grid.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for coordinates that are not finite, and a grid that is too fine for them.
    pub fn vatti(
        &self,
        area: &Area,
        clip: &Shapes,
        op: BooleanOp,
        subject_rule: WindingRule,
    ) -> Result<Area> {
        let options = self.options(area, clip, subject_rule);
        let output = vatti::vatti(&area.shapes, clip, op, &options, &mut NoTrace)?;
        Ok(area.overlaid(&output))
    }

    /// Returns the region of a geometry as valid polygons, with outer rings counter-clockwise. The polygons of
    /// a collection are sets of points, united whatever rule each follows.
    ///
    /// # Errors
    /// [`crate::Error::Parameter`] for coordinates that are not finite, and a grid that is too fine for them.
    pub fn clean(&self, geometry: &Geometry) -> Result<Made> {
        let Geometry::Collection(parts) = geometry else { return self.clean_polygons(geometry) };
        let mut all = Made::default();
        for part in parts {
            let made = self.clean(part)?;
            all.area.append(&made.area);
            all.repaired |= made.repaired;
            all.snapped += made.snapped;
        }
        if all.area.shapes.polygon_count() > 1 {
            let rule = WindingRule::Positive;
            let joined = self.overlay(&all.area, &Shapes::new(), BooleanOp::Union, rule)?;
            (all.area, all.snapped) = (joined.area, all.snapped + joined.snapped);
        }
        Ok(all)
    }

    fn clean_polygons(&self, geometry: &Geometry) -> Result<Made> {
        let area = Area::of_geometry(geometry);
        let keeps = self.keep_valid(&area.shapes);
        if keeps && is_valid(&area.shapes, Touching::No) {
            let area = Area::of_geometry(&oriented(geometry.clone()));
            return Ok(Made { area, ..Made::default() });
        }
        let repaired =
            self.fill == WindingRule::EvenOdd && !is_valid(&area.shapes, Touching::AtPoints);
        let made = self.join(&area, &Shapes::new(), BooleanOp::Union, self.fill, true)?;
        Ok(Made { repaired, ..made })
    }
}
