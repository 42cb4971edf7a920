//! Geometries cut by many cells, such as districts: each piece with the number of its cell.
//!
//! Cells are found by their boxes; each is a [`Mask`], ready for many geometries. A polygon with many points becomes a
//! mask itself, and the cells near it are cut with it: that examines only the edges near a cell, and gives the same
//! points.
//!
//! ```
//! use durer::clip::cells::Cells;
//! use durer::clip::mask::Rules;
//! use durer::clip::polygon::Shapes;
//! use durer::geometry::{Geometry, Points};
//! use durer::math::DVec2;
//!
//! let square = |x: f64| [(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)].map(DVec2::from);
//! let cells = Cells::new([0.0, 1.0, 5.0].map(|x| Shapes::from_rings([square(x)])).into())?;
//! let road = Points::flat(vec![DVec2::new(0.5, 0.5), DVec2::new(1.5, 0.5)]);
//! let pieces = cells.cut(&Geometry::LineString(road), &Rules::default())?;
//! assert_eq!(pieces.iter().map(|piece| piece.cell).collect::<Vec<_>>(), [0, 1]);
//! # Ok::<(), durer::Error>(())
//! ```
//!
//! Cost: O(log c + the cells whose boxes meet the geometry's) for c cells of similar width, plus the cost of each cut.

use super::mask::{Area, Cut, Cutter, Mask, Rules};
use super::polygon::{BooleanOp, Shapes, coverage};
use crate::geometry::{Dimensions, Geometry};
use crate::math::Rect;
use crate::work::Work;
use crate::{Result, parallel};

/// Cells, ready for many geometries.
#[derive(Debug)]
pub struct Cells {
    cells: Vec<Cell>,
    /// Cells with an area, by their left borders.
    order: Vec<usize>,
    /// The width of the widest.
    width: f64,
}

#[derive(Debug)]
struct Cell {
    mask: Mask,
    bounds: Option<Rect>,
}

/// The part of a geometry in one cell.
#[derive(Debug)]
pub struct CellPiece {
    /// Number of the cell.
    pub cell: usize,
    /// The part, and the changes made to it.
    pub cut: Cut,
}

impl Cells {
    /// Prepares cells, each of valid polygons, as [`Rules::clean`] returns them. A cell that encloses no area has no
    /// contents.
    ///
    /// # Errors
    /// As [`Mask::polygons`].
    pub fn new(shapes: Vec<Shapes>) -> Result<Self> {
        let cell = |shapes: Shapes| {
            let bounds = shapes.bounds();
            Ok(Cell { mask: Mask::polygons(shapes)?, bounds })
        };
        let cells: Vec<Cell> = shapes.into_iter().map(cell).collect::<Result<_>>()?;
        let mut order: Vec<(f64, usize)> = Vec::with_capacity(cells.len());
        let mut width = 0.0_f64;
        for (i, bounds) in cells.iter().enumerate().filter_map(|(i, c)| Some((i, c.bounds?))) {
            order.push((bounds.min().x, i));
            width = width.max(bounds.size().x);
        }
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(Self { cells, order: order.into_iter().map(|(_, i)| i).collect(), width })
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Returns whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Returns the cells whose boxes meet another one, in their order.
    pub fn near(&self, bounds: &Rect) -> Vec<usize> {
        let of = |i: usize| self.cells.get(i).and_then(|cell| cell.bounds);
        let left = |&i: &usize| of(i).map_or(f64::INFINITY, |own| own.min().x);
        // A width is rounded.
        let first = bounds.min().x - self.width * 1.001;
        let start = self.order.partition_point(|i| left(i) < first);
        let end = self.order.partition_point(|i| left(i) <= bounds.max().x);
        let near = self.order.get(start..end).unwrap_or_default().iter().copied();
        let mut near: Vec<usize> =
            near.filter(|&i| of(i).is_some_and(|own| own.overlaps(bounds))).collect();
        near.sort_unstable();
        near
    }

    /// Returns the pieces of a geometry, in the order of the cells; a cell near it that contains no part of it has a
    /// piece without geometry.
    ///
    /// # Errors
    /// As [`Cutter::cut`].
    pub fn cut(&self, geometry: &Geometry, rules: &Rules) -> Result<Vec<CellPiece>> {
        let Some(bounds) = geometry.bounds() else { return Ok(Vec::new()) };
        let near = self.near(&bounds);
        let large = if near.len() > 1 { Large::new(geometry, rules)? } else { None };
        let cut = |cell: usize| {
            let of = &self.cells[cell];
            let cut = match &large {
                Some(large) => large.within(of)?,
                None => {
                    let op = BooleanOp::Intersection;
                    let rules = rules.clone();
                    Cutter { mask: &of.mask, op, rules, algorithm: None }.cut(geometry)?
                }
            };
            Ok(CellPiece { cell, cut })
        };
        let pieces: Result<Vec<CellPiece>> = parallel::map(near, cut).into_iter().collect();
        let repaired = large.is_some_and(|large| large.repaired);
        let mut pieces = pieces?;
        pieces.iter_mut().for_each(|piece| piece.cut.repaired |= repaired);
        Ok(pieces)
    }
}

/// Polygons with so many points that cells are clipped with them instead of the other way round.
struct Large {
    mask: Mask,
    repaired: bool,
    work: Work,
}

/// Number of positions from which a geometry counts as large.
const MANY: usize = 64;

impl Large {
    /// Prepares the polygons of a geometry; `None` for other geometries, and for geometries that are small, have
    /// heights or measures, or are to be clipped on a grid.
    fn new(geometry: &Geometry, rules: &Rules) -> Result<Option<Self>> {
        let is_polygon = matches!(geometry, Geometry::Polygon(_) | Geometry::MultiPolygon(_));
        let is_flat = geometry.dimensions() == Dimensions::Xy;
        if !is_polygon || !is_flat || geometry.len() < MANY || rules.grid.is_some() {
            return Ok(None);
        }
        let made = rules.clean(geometry)?;
        let (mask, work) = (Mask::polygons(made.area.shapes)?, rules.work.clone());
        Ok(Some(Self { mask, repaired: made.repaired, work }))
    }

    fn within(&self, cell: &Cell) -> Result<Cut> {
        let flat = |shapes: Shapes| Area::flat(shapes).into_geometry();
        let Some(bounds) = cell.bounds else { return Ok(Cut::default()) };
        Ok(match self.mask.side(&bounds) {
            Some(false) => Cut::default(),
            Some(true) => Cut { geometry: flat(cell.mask.shapes().clone()), ..Cut::default() },
            None => {
                let work = self.work.clone();
                let options =
                    coverage::Options { keep: true, work, ..coverage::Options::default() };
                let op = BooleanOp::Intersection;
                let cut = coverage::cut(cell.mask.shapes(), self.mask.prepared(), op, &options)?;
                Cut { geometry: flat(cut.shapes), snapped: cut.snapped, ..Cut::default() }
            }
        })
    }
}
