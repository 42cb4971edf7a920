//! `durer clip --cells`: every feature is clipped to each of many cells, and each piece receives the fields of its
//! cell.

use super::args::ClipArgs;
use super::srids::Srids;
use super::{Job, rules};
use crate::failure::Failure;
use crate::input::display_name;
use crate::layer::{open, words};
use crate::messages::Messages;
use durer::clip::cells::{self, CellPiece};
use durer::clip::mask::Rules;
use durer::clip::polygon::{Shapes, WindingRule};
use durer::parallel;
use durer_formats::geo::{Feature, Member};
use durer_formats::wording::counted;
use std::path::Path;

/// The cells of a file.
pub struct Cells {
    cells: cells::Cells,
    /// The fields for the pieces of each cell.
    fields: Vec<Vec<Member>>,
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
    let (mut cells, mut fields) = (Vec::new(), Vec::new());
    let (mut number, mut repaired, mut without) = (0u64, 0u64, 0u64);
    while let Some(feature) = reader.next_feature().map_err(|e| fail(words(&e)))? {
        number += 1;
        srids.add(feature.srid);
        let cell = cell(&feature, number, rules(args, &feature), &mut repaired);
        let Some((shapes, own)) = cell.map_err(|e| fail(format!("feature {number}: {e}")))? else {
            without += 1;
            continue;
        };
        cells.push(shapes);
        fields.push(own);
    }
    srids.of_file(&reader.system());
    let name = display_name(path);
    messages.warnings(&name, reader.warnings());
    if repaired > 0 {
        let message =
            "polygons crossed, pinched or overlapped themselves; made valid by the even-odd rule";
        messages.warning(&name, message);
    }
    if without > 0 && !cells.is_empty() {
        let (one, several) = (
            "feature encloses nothing and is no cell",
            "features enclose nothing and are no cells",
        );
        messages.warning(&name, counted(without, one, several));
    }
    if cells.is_empty() {
        return Err(fail("there is no polygon to cut with".to_owned()));
    }
    let cells = cells::Cells::new(cells).map_err(|e| fail(e.to_string()))?;
    Ok(Cells { cells, fields })
}

/// Returns the polygons of a cell and the fields for its pieces; `None` if a feature has no area.
fn cell(
    feature: &Feature,
    number: u64,
    rules: Rules,
    repaired: &mut u64,
) -> durer::Result<Option<(Shapes, Vec<Member>)>> {
    let Some(geometry) = &feature.geometry else { return Ok(None) };
    let made = rules.clean(geometry)?;
    *repaired += u64::from(made.repaired);
    let mut fields = feature.fields();
    if fields.is_empty() {
        fields.push(Member::new(NUMBER, number.to_string()));
    }
    let shapes = made.area.shapes;
    Ok(shapes.bounds().is_some().then_some((shapes, fields)))
}

impl Job<'_> {
    /// Cuts each feature by each cell.
    pub fn cut_by_cells(&mut self, cells: &Cells) -> Result<(), Failure> {
        let args = self.args;
        let cut = |feature: &Feature| match &feature.geometry {
            Some(geometry) => cells.cells.cut(geometry, &rules(args, feature)),
            None => Ok(Vec::new()),
        };
        let mut writer = None;
        loop {
            let features = self.batch()?;
            if features.is_empty() {
                return self.end(writer);
            }
            let first = self.report.given.features - features.len() as u64;
            let cuts = parallel::of_each(&features, cut);
            for (i, (feature, pieces)) in features.iter().zip(cuts).enumerate() {
                let pieces = pieces.map_err(|e| self.of_feature(first + i as u64, &e))?;
                self.report.add(pieces.iter().map(|piece| &piece.cut));
                for CellPiece { cell, cut } in pieces {
                    if cut.geometry.is_some() {
                        let mut piece = Feature { geometry: cut.geometry, ..feature.clone() };
                        piece.fill_rule = WindingRule::EvenOdd;
                        piece.set_fields(&with_fields(feature.fields(), &cells.fields[cell]));
                        self.put(&mut writer, &mut piece)?;
                    }
                }
            }
        }
    }
}

/// Returns a feature's fields, followed by its cell's.
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
