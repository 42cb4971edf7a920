//! Shapefiles, by *ESRI Shapefile Technical Description*, 1998: geometries in a .shp, their fields in a table beside it
//! (.dbf) whose encoding a .cpg may name, the coordinate system in a .prj. The index (.shx) is written, but not needed
//! for reading.

mod dbf;
mod encoding;
mod record;
mod write;

use super::beside::Beside;
use super::numbered::Label;
use super::{Feature, System, Warnings};
use crate::text::Tally;
use crate::wording::counted;
use crate::{Error, Place, Result};
use dbf::Table;
use encoding::Encoding;
pub use write::write;

/// Bytes of the header of a .shp or .shx.
const HEADER: usize = 100;

/// The number that a .shp or .shx begins with.
const MAGIC: [u8; 4] = 9994_u32.to_be_bytes();

/// Returns whether the bytes begin like a .shp; an index begins alike.
pub fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC) && bytes.get(28..32) == Some(&1000_u32.to_le_bytes())
}

/// Reader of the records of a Shapefile as features.
pub struct Reader {
    bytes: Vec<u8>,
    at: usize,
    /// Records read.
    row: usize,
    table: Option<Table>,
    /// System that the .prj states.
    pub system: System,
    faults: Faults,
}

/// Repairs, reported at the end.
#[derive(Debug, Default)]
pub struct Faults {
    pub values: Tally,
    pub letters: Tally,
    pub memos: Tally,
    pub rows: Tally,
    pub infinite: Tally,
    pub patches: Tally,
    pub measures: Tally,
}

impl Faults {
    /// Adds the record that has just been read to the places of its faults.
    fn label(&mut self, label: impl Fn() -> Label) {
        let Self { infinite, patches, measures, .. } = self;
        [infinite, patches, measures].into_iter().for_each(|tally| tally.label(&label));
    }
}

impl Reader {
    /// Creates a reader; searches for the files beside this one.
    ///
    /// # Errors
    /// If the file is no .shp, or its table cannot be read.
    pub fn new(bytes: Vec<u8>, beside: &Beside<'_>, warnings: &mut Warnings) -> Result<Self> {
        if !sniff(&bytes) || bytes.len() < HEADER {
            return Err(Error::byte(
                0,
                "the header of a Shapefile is expected, 100 bytes from 9994 on",
            ));
        }
        let text = |suffix| beside.find(suffix).map(|bytes| crate::text::name(&bytes).into_owned());
        let encoding = text("cpg").and_then(|name| Encoding::of_name(&name, warnings));
        let table = match beside.find("dbf") {
            Some(table) => Some(Table::new(table, encoding).map_err(|e| e.at(of_table))?),
            None => {
                let message = "there is no .dbf beside it; features have no fields";
                warnings.push(Place::Whole, message);
                None
            }
        };
        let system = text("prj").map(|wkt| System::of_wkt(&wkt)).unwrap_or_default();
        Ok(Self { bytes, at: HEADER, row: 0, table, system, faults: Faults::default() })
    }

    /// Returns the next record; `None` at the end.
    pub fn next_feature(&mut self, warnings: &mut Warnings) -> Result<Option<Feature>> {
        loop {
            let Some(content) = self.content(warnings) else {
                self.warn(warnings);
                return Ok(None);
            };
            let place = Place::Byte(content.start as u64);
            let row = self.row;
            self.row += 1;
            if self.table.as_ref().is_some_and(|table| table.is_deleted(row)) {
                continue;
            }
            let (from, number) = (warnings.kept.len(), self.row as u64);
            let record = self.bytes.get(content).unwrap_or_default();
            let geometry = record::read(record, &place, &mut self.faults, warnings);
            let table = self.table.as_ref();
            let properties = table.map(|table| table.row(row, &mut self.faults));
            let srid = self.system.code;
            let mut feature = Feature { properties, srid, ..Feature::default() };
            let label = || Label::of(number, &feature);
            self.faults.label(label);
            warnings.label(from, label);
            feature.geometry = geometry.map_err(|error| error.in_feature(&label()))?;
            return Ok(Some(feature));
        }
    }

    /// Returns the bytes of the next record's content.
    fn content(&mut self, warnings: &mut Warnings) -> Option<std::ops::Range<usize>> {
        let head = self.bytes.get(self.at..)?.first_chunk::<8>();
        let Some([.., a, b, c, d]) = head else {
            if self.at < self.bytes.len() {
                warnings
                    .push(Place::Byte(self.at as u64), "the file ends within a record; left out");
                self.at = self.bytes.len();
            }
            return None;
        };
        let start = self.at + 8;
        let words = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
        let end = start.saturating_add(words.saturating_mul(2));
        if end > self.bytes.len() {
            warnings.push(Place::Byte(self.at as u64), "the file ends within a record; left out");
            self.at = self.bytes.len();
            return None;
        }
        self.at = end;
        Some(start..end)
    }

    fn warn(&mut self, warnings: &mut Warnings) {
        let faults = std::mem::take(&mut self.faults);
        if let Some(table) = self.table.take()
            && table.rows() != self.row
        {
            let rows = counted(table.rows() as u64, "row", "rows");
            let records = counted(self.row as u64, "record", "records");
            let message = format!("the .dbf has {rows} for {records}");
            warnings.push(Place::Whole, message);
        }
        for (tally, one, several) in [
            (
                faults.values,
                "value of the .dbf is not of the kind of its field; it is null",
                "values of the .dbf are not of the kind of their field; they are null",
            ),
            (
                faults.letters,
                "text of the .dbf is not in its encoding; taken as Windows-1252",
                "texts of the .dbf are not in its encoding; taken as Windows-1252",
            ),
            (
                faults.memos,
                "memo, which is in a separate file, is left out",
                "memos, which are in a separate file, are left out",
            ),
            (
                faults.rows,
                "record has no row in the .dbf; it has no fields",
                "records have no row in the .dbf; they have no fields",
            ),
            (
                faults.infinite,
                "geometry has coordinates that are not finite; left out",
                "geometries have coordinates that are not finite; left out",
            ),
            (
                faults.patches,
                "multipatch is flattened: its triangles and rings become polygons",
                "multipatches are flattened: their triangles and rings become polygons",
            ),
            (
                faults.measures,
                "position has no measure where others have one; it is 0",
                "positions have no measure where others have one; it is 0",
            ),
        ] {
            warnings.add_counted(tally, one, several);
        }
    }
}

fn of_table(place: Place) -> Place {
    Place::Path(format!("the .dbf, {place}").trim_end_matches([':', ' ']).to_owned())
}
