//! `durer clip --cells`: every feature cut by each of many cells, and told which cell each piece is in.

use super::args::ClipArgs;
use super::srids::Srids;
use super::{Job, rules};
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{open, words};
use crate::messages::Messages;
use durer::clip::mask::{Area, Cut, Cutter, Mask, Rules};
use durer::clip::polygon::{BooleanOp, FillRule, Shapes, coverage};
use durer::math::Rect;
use durer_formats::geo::{Dimensions, Feature, Geometry, Member};
use rayon::prelude::*;
use std::path::Path;

/// The cells of a file.
pub struct Cells {
    cells: Vec<Cell>,
    /// Cells by their left borders.
    order: Vec<usize>,
    /// The width of the widest.
    width: f64,
}

struct Cell {
    mask: Mask,
    bounds: Rect,
    /// The fields that its pieces get.
    fields: Vec<Member>,
}

/// The field of pieces of cells that have no fields: their number in the file.
const NUMBER: &str = "cell";

/// Before the name of a cell's field where the feature has one of that name.
const PREFIX: &str = "cell_";

/// Reads the cells of a file: every feature with polygons is one.
pub fn read(
    path: &Path,
    args: &ClipArgs,
    srids: &mut Srids,
    messages: &Messages,
) -> Result<Cells, Failure> {
    let fail = |what: String| Failure::Data(format!("{}: {what}", display_name(path)));
    let (_, mut reader) = open(path, None, None, &args.running.work)?;
    let (mut cells, mut number, mut repaired, mut without) = (Vec::new(), 0u64, 0u64, 0u64);
    while let Some(feature) = reader.next_feature().map_err(|e| fail(words(&e)))? {
        number += 1;
        srids.add(feature.srid);
        let cell = Cell::new(&feature, number, rules(args, &feature), &mut repaired);
        let cell = cell.map_err(|e| fail(format!("feature {number}: {e}")))?;
        without += u64::from(cell.is_none());
        cells.extend(cell);
    }
    let name = display_name(path);
    messages.warnings(&name, reader.warnings());
    if repaired > 0 {
        let message =
            "polygons crossed, pinched or overlapped themselves; made valid by the even-odd rule";
        messages.warning(&name, message);
    }
    if without > 0 && !cells.is_empty() {
        messages.warning(&name, format!("{without} features enclose nothing and are no cells"));
    }
    if cells.is_empty() {
        return Err(fail("there is no polygon to cut with".to_owned()));
    }
    Ok(Cells::new(cells))
}

impl Cell {
    /// `None` where a feature encloses nothing.
    fn new(
        feature: &Feature,
        number: u64,
        rules: Rules,
        repaired: &mut u64,
    ) -> durer::Result<Option<Self>> {
        let Some(geometry) = &feature.geometry else { return Ok(None) };
        let made = rules.clean(geometry)?;
        *repaired += u64::from(made.repaired);
        let Some(bounds) = made.area.shapes.bounds() else { return Ok(None) };
        let mut fields = feature.fields();
        if fields.is_empty() {
            fields.push(Member::new(NUMBER, number.to_string()));
        }
        Ok(Some(Self { mask: Mask::polygons(made.area.shapes)?, bounds, fields }))
    }
}

/// A feature in one cell.
struct Piece {
    cell: usize,
    cut: Cut,
}

impl Cells {
    fn new(cells: Vec<Cell>) -> Self {
        let left = |i: usize| cells[i].bounds.min().x;
        let mut order: Vec<usize> = (0..cells.len()).collect();
        order.sort_by(|&i, &j| left(i).total_cmp(&left(j)));
        let width = cells.iter().map(|cell| cell.bounds.size().x).fold(0.0, f64::max);
        Self { cells, order, width }
    }

    /// Returns the cells whose boxes meet another one, in the order of the file.
    fn near(&self, bounds: &Rect) -> Vec<usize> {
        let left = |&i: &usize| self.cells[i].bounds.min().x;
        // A width is rounded.
        let first = bounds.min().x - self.width * 1.001;
        let start = self.order.partition_point(|i| left(i) < first);
        let end = self.order.partition_point(|i| left(i) <= bounds.max().x);
        let near = self.order.get(start..end).unwrap_or_default().iter().copied();
        let mut near: Vec<usize> =
            near.filter(|&i| self.cells[i].bounds.overlaps(bounds)).collect();
        near.sort_unstable();
        near
    }

    /// Returns the pieces of a geometry, in the order of the cells.
    fn cut(&self, geometry: &Geometry, rules: Rules) -> durer::Result<Vec<Piece>> {
        let Some(bounds) = geometry.bounds() else { return Ok(Vec::new()) };
        let near = self.near(&bounds);
        let large = if near.len() > 1 { Large::new(geometry, rules)? } else { None };
        let cut = |&cell: &usize| {
            let of = &self.cells[cell];
            let cut = match &large {
                Some(large) => large.within(of)?,
                None => {
                    let op = BooleanOp::Intersection;
                    Cutter { mask: &of.mask, op, rules, algorithm: None }.cut(geometry)?
                }
            };
            Ok(Piece { cell, cut })
        };
        let pieces: durer::Result<Vec<Piece>> = near.par_iter().map(cut).collect();
        let repaired = large.is_some_and(|large| large.repaired);
        let mut pieces = pieces?;
        pieces.iter_mut().for_each(|piece| piece.cut.repaired |= repaired);
        Ok(pieces)
    }
}

/// Polygons with so many points that cells are cut with them, and not they with the cells: that looks at what is near a cell
/// only. Both give the same points.
struct Large {
    mask: Mask,
    repaired: bool,
}

/// Number of positions from which a geometry counts as large.
const MANY: usize = 64;

impl Large {
    /// `None` for what is small, has heights or measures, or is to be cut on a grid.
    fn new(geometry: &Geometry, rules: Rules) -> durer::Result<Option<Self>> {
        let is_polygon = matches!(geometry, Geometry::Polygon(_) | Geometry::MultiPolygon(_));
        let is_flat = geometry.dimensions() == Dimensions::Xy;
        if !is_polygon || !is_flat || geometry.len() < MANY || rules.grid.is_some() {
            return Ok(None);
        }
        let made = rules.clean(geometry)?;
        Ok(Some(Self { mask: Mask::polygons(made.area.shapes)?, repaired: made.repaired }))
    }

    fn within(&self, cell: &Cell) -> durer::Result<Cut> {
        let flat = |shapes: Shapes| Area::flat(shapes).into_geometry();
        Ok(match self.mask.side(&cell.bounds) {
            Some(false) => Cut::default(),
            Some(true) => Cut { geometry: flat(cell.mask.shapes().clone()), ..Cut::default() },
            None => {
                let options = coverage::Options { keep: true, ..coverage::Options::default() };
                let op = BooleanOp::Intersection;
                let cut = coverage::cut(cell.mask.shapes(), self.mask.prepared(), op, &options)?;
                Cut { geometry: flat(cut.shapes), snapped: cut.snapped, ..Cut::default() }
            }
        })
    }
}

impl Job<'_> {
    /// Each feature by each cell.
    pub fn cut_by_cells(&mut self, cells: &Cells) -> Result<(), Failure> {
        let args = self.args;
        let cut = |feature: &Feature| match &feature.geometry {
            Some(geometry) => cells.cut(geometry, rules(args, feature)),
            None => Ok(Vec::new()),
        };
        let mut writer = None;
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                return self.end(writer);
            }
            let first = self.report.given.features - features.len() as u64;
            let cuts: Vec<_> = features.par_iter().map(cut).collect();
            for (i, (feature, pieces)) in features.iter().zip(cuts).enumerate() {
                let pieces = pieces.map_err(|e| self.of_feature(first + i as u64, &e))?;
                self.report.add(pieces.iter().map(|piece| &piece.cut));
                for Piece { cell, cut } in pieces {
                    if cut.geometry.is_some() {
                        let mut piece = Feature { geometry: cut.geometry, ..feature.clone() };
                        piece.fill_rule = FillRule::EvenOdd;
                        piece.set_fields(&with_fields(feature.fields(), &cells.cells[cell].fields));
                        self.put(&mut writer, &mut piece)?;
                    }
                }
            }
        }
    }
}

/// Returns a feature's fields, and then those of its cell.
fn with_fields(mut fields: Vec<Member>, of_cell: &[Member]) -> Vec<Member> {
    for field in of_cell {
        let mut name = field.key();
        while fields.iter().any(|own| own.key() == name) {
            name.insert_str(0, PREFIX);
        }
        fields.push(Member::new(&name, field.value.clone()));
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_of_cells_give_way() {
        let field = |name: &str, value: &str| Member::new(name, value.to_owned());
        let own = vec![field("id", "1"), field("cell_id", "2")];
        let all = with_fields(own, &[field("id", "3"), field("kind", "4")]);
        let names: Vec<String> = all.iter().map(Member::key).collect();
        assert_eq!(names, ["id", "cell_id", "cell_cell_id", "kind"]);
        assert_eq!(all[2].value, "3");
    }
}
