//! Features from a file.

use super::blob;
use super::contents::{Contents, Layer, contents};
use crate::geo::beside::Beside;
use crate::geo::members::{object, quoted};
use crate::geo::{Feature, GEOMETRIES, Geometry, Member, System, Warnings, number, unread};
use crate::sqlite::{Column, Database, Rows, Value};
use crate::text::Tally;
use crate::{Error, Place, Result};

/// Reader of the features of all layers of a file, or of one, layer by layer.
pub struct Reader {
    database: Database,
    layers: Vec<Layer>,
    /// The layer that is read now, and its rows.
    at: usize,
    rows: Option<Rows>,
    faults: Faults,
}

/// Omissions, reported at the end.
#[derive(Debug, Default)]
struct Faults {
    binary: Tally,
    geometries: Tally,
    /// Description of the first fault.
    why: String,
}

impl Reader {
    /// Reads the contents of the file, and looks for the files beside it.
    ///
    /// # Errors
    /// An error for files that are not GeoPackages, for one whose last changes are in another file, and for
    /// a layer that does not exist.
    pub fn new(bytes: Vec<u8>, beside: &Beside<'_>, warnings: &mut Warnings) -> Result<Self> {
        refuse_changes(beside)?;
        let database = Database::new(bytes)?;
        let contents = contents(&database)?;
        let layers = chosen(contents, beside.layer, warnings)?;
        Ok(Self { database, layers, at: 0, rows: None, faults: Faults::default() })
    }

    /// Returns the names of the layers that are read.
    pub fn layers(&self) -> Vec<String> {
        self.layers.iter().map(|layer| layer.name.clone()).collect()
    }

    /// Returns the system of all layers.
    pub fn system(&self) -> System {
        self.layers.first().map(|layer| layer.system.clone()).unwrap_or_default()
    }

    /// Returns the next feature; `None` at the end.
    pub fn next_feature(&mut self, warnings: &mut Warnings) -> Result<Option<Feature>> {
        if self.at == 0 && self.rows.is_none() {
            self.check_systems()?;
            if self.layers.len() > 1 {
                let (count, names) = (self.layers.len(), names(&self.layers));
                warnings
                    .note(format!("its {count} layers, {names}, become one; --layer names one"));
            }
        }
        while let Some(layer) = self.layers.get(self.at) {
            let rows = self.rows.get_or_insert_with(|| self.database.rows(layer.root));
            let in_layer = |e: Error| e.at(|place| in_layer(layer, &place));
            if let Some(row) = rows.next(&self.database).map_err(in_layer)? {
                let values = self.database.values(&row).map_err(in_layer)?;
                let place = Place::Path(format!("layer {}, row {}", layer.name, row.number));
                let mut made = Row { layer, place, faults: &mut self.faults, warnings };
                let mut feature = made.feature(row.number, values);
                // With several layers, ids would not be unique.
                feature.id = feature.id.filter(|_| self.layers.len() == 1);
                return Ok(Some(feature));
            }
            self.at += 1;
            self.rows = None;
        }
        self.warn(warnings);
        Ok(None)
    }

    /// Refuses layers in different coordinate systems.
    fn check_systems(&self) -> Result<()> {
        let system = self.system();
        if self.layers.iter().all(|layer| layer.system == system) {
            return Ok(());
        }
        let name = |layer: &Layer| match layer.system.code {
            Some(code) => format!("{} (EPSG:{code})", layer.name),
            None => layer.name.clone(),
        };
        let names = self.layers.iter().map(name).collect::<Vec<_>>().join(", ");
        let message =
            format!("its layers are in different coordinate systems; --layer names one of {names}");
        Err(Error::whole(message))
    }

    fn warn(&mut self, warnings: &mut Warnings) {
        let faults = std::mem::take(&mut self.faults);
        warnings.add_counted(
            faults.binary,
            "binary value is left out",
            "binary values are left out",
        );
        if faults.geometries.count > 0 {
            let message = unread(faults.geometries.count, GEOMETRIES, &faults.why);
            warnings.push(faults.geometries.first, message);
        }
    }
}

fn in_layer(layer: &Layer, place: &Place) -> Place {
    Place::Path(
        format!("layer {}, {place}", layer.name).trim_end_matches([',', ':', ' ']).to_owned(),
    )
}

/// Refuses a file into which another program has not written its last changes yet.
fn refuse_changes(beside: &Beside<'_>) -> Result<()> {
    for (suffix, what) in
        [("-wal", "changes"), ("-journal", "data replaced by an interrupted change")]
    {
        let name = format!("{}{suffix}", beside.name);
        let found = beside.resources.find(&name, u64::MAX);
        // A journal that begins with zeros is finished.
        let is_open = |bytes: &[u8]| bytes.first().is_some_and(|b| *b != 0 || suffix == "-wal");
        if !beside.name.is_empty() && found.is_ok_and(|found| is_open(&found.bytes)) {
            let message = format!(
                "{name} beside it holds {what}, so that the file alone is not complete; close the program \
                 that writes it, or open it once with SQLite"
            );
            return Err(Error::whole(message));
        }
    }
    Ok(())
}

fn names(layers: &[Layer]) -> String {
    layers.iter().map(|layer| &layer.name[..]).collect::<Vec<_>>().join(", ")
}

/// Returns the layers to read; all features, if none is named.
fn chosen(contents: Contents, name: Option<&str>, warnings: &mut Warnings) -> Result<Vec<Layer>> {
    let Contents { layers, left_out } = contents;
    if let Some(name) = name {
        if let Some(layer) = layers.iter().find(|layer| layer.name == name) {
            return Ok(vec![layer.clone()]);
        }
        let message = match left_out.iter().find(|(own, _)| own == name) {
            Some((_, why)) => format!("layer {name} cannot be read: {why}"),
            None => format!("there is no layer {name}; it has {}", names(&layers)),
        };
        return Err(Error::whole(message));
    }
    for (name, why) in &left_out {
        warnings.push(Place::Path(format!("layer {name}")), format!("left out: {why}"));
    }
    let (layers, tables): (Vec<Layer>, Vec<Layer>) =
        layers.into_iter().partition(|layer| layer.geometry.is_some());
    if !tables.is_empty() {
        let names = names(&tables);
        let words = "{table without geometries is left out|tables without geometries are left out}; --layer names one";
        let message = format!("{}: {names}", crate::wording::agreeing(tables.len() as u64, words));
        warnings.push(Place::Whole, message);
    }
    Ok(layers)
}

/// Converter of a row to a feature.
struct Row<'a> {
    layer: &'a Layer,
    place: Place,
    faults: &'a mut Faults,
    warnings: &'a mut Warnings,
}

impl Row<'_> {
    fn feature(&mut self, number: i64, values: Vec<Value<'_>>) -> Feature {
        let (mut fields, mut geometry, mut id) = (Vec::new(), None, None);
        let mut values = values.into_iter();
        for (i, column) in self.layer.columns.iter().enumerate() {
            let value = if column.is_stored { values.next() } else { Some(Value::Null) };
            if column.is_number {
                id = Some(number.to_string());
            } else if self.layer.geometry == Some(i) {
                geometry = self.geometry(value);
            } else {
                let is_json = self.layer.json.get(i).copied().unwrap_or(false);
                let value = self.value(column, value, is_json);
                fields.extend(value.map(|value| Member::new(&column.name, value)));
            }
        }
        let (properties, srid) = (Some(object(&fields)), self.layer.system.code);
        Feature { geometry, properties, id, srid, ..Feature::default() }
    }

    fn geometry(&mut self, value: Option<Value<'_>>) -> Option<Geometry> {
        let read = match value {
            Some(Value::Blob(bytes)) => blob::read(bytes, self.warnings, &self.place),
            None | Some(Value::Null) => return None,
            Some(_) => Err(Error::whole("it is not a blob")),
        };
        read.unwrap_or_else(|error| {
            if self.faults.geometries.count == 0 {
                self.faults.why = error.to_string();
            }
            self.faults.geometries.add(|| self.place.clone());
            None
        })
    }

    /// Returns a value as JSON; `None` for binary values.
    fn value(
        &mut self,
        column: &Column,
        value: Option<Value<'_>>,
        is_json: bool,
    ) -> Option<String> {
        let is_boolean = column.kind == "BOOLEAN";
        Some(match value {
            None => column.default.clone().unwrap_or_else(|| "null".to_owned()),
            Some(Value::Null) if column.kind == "BLOB" => return None,
            Some(Value::Null) => "null".to_owned(),
            Some(Value::Integer(n)) if is_boolean => (n != 0).to_string(),
            Some(Value::Integer(n)) => n.to_string(),
            Some(Value::Real(n)) => number::json(n),
            Some(Value::Text(text)) if is_json && is_json_text(&text) => text.trim().to_owned(),
            Some(Value::Text(text)) => quoted(&text),
            Some(Value::Blob(_)) => {
                self.faults.binary.add(|| self.place.clone());
                return None;
            }
        })
    }
}

fn is_json_text(text: &str) -> bool {
    serde_json::from_str::<serde::de::IgnoredAny>(text).is_ok()
}
