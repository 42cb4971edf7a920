//! Features from a file.

use super::values::{Meaning, json};
use crate::foreign;
use crate::geo::beside::Beside;
use crate::geo::members::object;
use crate::geo::{Feature, GEOMETRIES, Geometry, Member, System, Warnings, unread, wkb};
use crate::text::Tally;
use crate::{Error, Place, Result};
use parquet::data_type::ByteArray;
use parquet::file::reader::FileReader;
use parquet::file::serialized_reader::SerializedFileReader;
use parquet::record::{Field, Row, reader::RowIter};
use serde_json::Value;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Reader of the features of a file.
pub struct Reader {
    rows: RowIter<'static>,
    row: u64,
    /// The column of geometries.
    geometry: String,
    /// Columns that are not fields: boxes around geometries, and further geometries.
    hidden: Vec<String>,
    /// Meanings of columns' values, in the columns' order.
    meanings: Vec<Meaning>,
    /// System that the file states.
    pub system: System,
    binary: Tally,
    broken: Tally,
    why: String,
}

impl Reader {
    /// Reads the description of the file's columns.
    ///
    /// # Errors
    /// An error for files that are not Parquet, or have no geometries as well-known binary.
    pub fn new(bytes: Vec<u8>, _: &Beside<'_>, warnings: &mut Warnings) -> Result<Self> {
        super::footer::check(&bytes)?;
        // On broken files the crate may panic.
        let open = || SerializedFileReader::new(::bytes::Bytes::from(bytes));
        let file = caught(open)?.map_err(|_| broken("its directory is missing or damaged"))?;
        let about = file.metadata().file_metadata();
        let text = about.key_value_metadata().into_iter().flatten().find(|pair| pair.key == "geo");
        let text = text.and_then(|pair| pair.value.clone()).ok_or_else(|| {
            Error::whole("this is Parquet without the metadata `geo` of GeoParquet, so that no column is known to hold geometries")
        })?;
        let geo: Value = serde_json::from_str(&text).map_err(|e| {
            Error::path("metadata `geo`", format!("it is not JSON: {}", foreign::json(&e)))
        })?;
        let geometry = geo["primary_column"].as_str().unwrap_or("geometry").to_owned();
        let column = &geo["columns"][&geometry];
        check(column, &geometry, warnings)?;
        let meanings = about.schema().get_fields().iter().map(|f| Meaning::of(f)).collect();
        let hidden = hidden(&geo, &geometry, warnings);
        let system = super::projjson::system(column.get("crs"), warnings);
        let rows = caught(|| RowIter::from_file_into(Box::new(file)))?;
        let (row, binary, broken, why) = Default::default();
        Ok(Self { rows, row, geometry, hidden, meanings, system, binary, broken, why })
    }

    /// Returns the next feature; `None` at the end.
    pub fn next_feature(&mut self, warnings: &mut Warnings) -> Result<Option<Feature>> {
        let row = caught(|| self.rows.next())?;
        let Some(row) = row else {
            self.warn(warnings);
            return Ok(None);
        };
        self.row += 1;
        let place = Place::Path(format!("row {}", self.row));
        let row =
            row.map_err(|_| broken("the data of this row are damaged").at(|_| place.clone()))?;
        Ok(Some(self.feature(row, &place, warnings)))
    }

    fn feature(&mut self, row: Row, place: &Place, warnings: &mut Warnings) -> Feature {
        let (mut fields, mut geometry) = (Vec::new(), None);
        for ((key, field), meaning) in row.into_columns().into_iter().zip(&self.meanings) {
            if key == self.geometry {
                let shape = match &field {
                    Field::Null => Ok(None),
                    Field::Bytes(bytes) => shape(bytes, place, warnings).map(Some),
                    _ => Err(Error::whole("it is not binary")),
                };
                geometry = shape.unwrap_or_else(|e| {
                    self.why = if self.broken.count == 0 {
                        e.to_string()
                    } else {
                        std::mem::take(&mut self.why)
                    };
                    self.broken.add(|| place.clone());
                    None
                });
            } else if !self.hidden.contains(&key) {
                match json(&field, *meaning) {
                    Some(value) => fields.push(Member::new(&key, value)),
                    None => self.binary.add(|| place.clone()),
                }
            }
        }
        let (properties, srid) = (Some(object(&fields)), self.system.code);
        Feature { geometry, properties, srid, ..Feature::default() }
    }

    fn warn(&mut self, warnings: &mut Warnings) {
        let (binary, broken) = (std::mem::take(&mut self.binary), std::mem::take(&mut self.broken));
        warnings.add_counted(binary, "binary value is left out", "binary values are left out");
        if broken.count > 0 {
            let message = unread(broken.count, GEOMETRIES, &self.why);
            warnings.push(broken.first, message);
        }
    }
}

/// Returns a geometry as well-known binary.
fn shape(bytes: &ByteArray, place: &Place, warnings: &mut Warnings) -> Result<Geometry> {
    let mut reader = wkb::Reader::new(bytes.data());
    let feature = reader.next_feature();
    reader.warnings.relocate(|_| place.clone());
    warnings.append(&mut reader.warnings);
    feature?.and_then(|f| f.geometry).ok_or_else(|| Error::byte(0, "it is empty"))
}

/// Refuses geometries in other encodings.
fn check(column: &Value, name: &str, warnings: &mut Warnings) -> Result<()> {
    let place = format!("column {name}");
    match column["encoding"].as_str() {
        Some("WKB") => {}
        Some(other) => {
            let what = format!("the encoding `{other}` of geometries");
            let hint = "WKB is read".to_owned();
            return Err(Error::Unsupported { place: Place::Path(place), what, hint });
        }
        None => return Err(Error::path("metadata `geo`", format!("there is no column {name}"))),
    }
    if column["edges"].as_str() == Some("spherical") {
        let message = "edges are great circles in the file; they are taken as straight";
        warnings.push(Place::Path(place), message);
    }
    Ok(())
}

/// Returns the columns that are not fields; warns of further geometries.
fn hidden(geo: &Value, geometry: &str, warnings: &mut Warnings) -> Vec<String> {
    let columns = geo["columns"].as_object().into_iter().flatten();
    let mut hidden = Vec::new();
    for (name, column) in columns {
        hidden.extend(column["covering"]["bbox"]["xmin"][0].as_str().map(str::to_owned));
        if name != geometry {
            hidden.push(name.clone());
            let message = "further geometries of each feature are left out";
            warnings.push(Place::Path(format!("column {name}")), message);
        }
    }
    hidden
}

fn broken(message: &str) -> Error {
    Error::whole(format!("the Parquet file is broken: {message}"))
}

/// Returns the result of a function, or an error if it panics.
fn caught<T>(make: impl FnOnce() -> T) -> Result<T> {
    catch_unwind(AssertUnwindSafe(make)).map_err(|_| broken("its metadata contradict each other"))
}
