//! The tables that a GeoPackage lists as its contents.

use crate::geo::{System, crs};
use crate::sqlite::{Column, Database, Table, Value, columns};
use crate::{Error, Result};
use std::collections::BTreeMap;

/// A table of features.
#[derive(Debug, Clone)]
pub struct Layer {
    /// Its name.
    pub name: String,
    /// Its first page.
    pub root: u32,
    /// Its columns.
    pub columns: Vec<Column>,
    /// The place of the column of geometries, if it has one.
    pub geometry: Option<usize>,
    /// True for each column that holds JSON.
    pub json: Vec<bool>,
    /// The system of its coordinates.
    pub system: System,
}

/// Tables of a database, and the tables left out.
#[derive(Debug, Default)]
pub struct Contents {
    /// Tables of features, followed by tables of attributes, which have no geometry.
    pub layers: Vec<Layer>,
    /// Names of tables that are left out, with reasons.
    pub left_out: Vec<(String, &'static str)>,
}

/// Reads the tables that describe the contents.
///
/// # Errors
/// If it is another database, or a damaged one.
pub fn contents(database: &Database) -> Result<Contents> {
    let tables = database.tables()?;
    let about = Records::of(database, &tables, "gpkg_contents")?;
    let about = about.ok_or_else(|| Error::whole(foreign(database, &tables)))?;
    let systems = systems(database, &tables)?;
    let geometries = Records::of(database, &tables, "gpkg_geometry_columns")?.unwrap_or_default();
    let json = json_columns(database, &tables)?;
    let mut contents = Contents::default();
    let mut others = Vec::new();
    for row in &about.0 {
        let (name, kind) = (text(row, "table_name"), text(row, "data_type"));
        let geometry = geometries.0.iter().find(|g| is(text(g, "table_name"), name));
        let why = match kind {
            "features" | "attributes" => None,
            "tiles" | "2d-gridded-coverage" => Some("it holds pixels"),
            _ => Some("it is of an extension"),
        };
        let found = tables.iter().find(|t| is(&t.name, name));
        let layer = match (why, found) {
            (Some(why), _) => Err(why),
            (None, Some(table)) => layer(table, geometry, &systems, &json),
            (None, None) => Err("it is not there"),
        };
        match layer {
            Ok(layer) if kind == "features" => contents.layers.push(layer),
            Ok(layer) => others.push(layer),
            Err(why) => contents.left_out.push((name.to_owned(), why)),
        }
    }
    contents.layers.extend(others);
    Ok(contents)
}

fn layer(
    table: &Table,
    geometry: Option<&Record>,
    systems: &BTreeMap<i64, System>,
    json: &[(String, String)],
) -> Result<Layer, &'static str> {
    if table.kind == "view" {
        return Err("it is a view, which only a database can work out");
    }
    let columns = columns(&table.sql).ok_or("how it was made is not known")?;
    let named = |name: &str| columns.iter().position(|c| is(&c.name, name));
    let (place, system) = match geometry {
        None => (None, System::default()),
        Some(row) => {
            let place =
                named(text(row, "column_name")).ok_or("its column of geometries is not there")?;
            let system = integer(row, "srs_id").and_then(|id| systems.get(&id));
            (Some(place), system.cloned().unwrap_or_default())
        }
    };
    let is_json =
        |c: &Column| json.iter().any(|(own, name)| is(own, &table.name) && is(name, &c.name));
    let json = columns.iter().map(is_json).collect();
    Ok(Layer { name: table.name.clone(), root: table.root, columns, geometry: place, json, system })
}

/// Returns the coordinate systems of the file by their numbers in it. Two of them mean an unknown system.
fn systems(database: &Database, tables: &[Table]) -> Result<BTreeMap<i64, System>> {
    let rows = Records::of(database, tables, "gpkg_spatial_ref_sys")?.unwrap_or_default();
    let system = |row: &Record| {
        let id = integer(row, "srs_id").filter(|id| *id > 0)?;
        let organization = text(row, "organization").to_ascii_uppercase();
        let code = integer(row, "organization_coordsys_id").and_then(|c| i32::try_from(c).ok());
        let code = code.filter(|_| matches!(&organization[..], "EPSG" | "ESRI"));
        let definition = [text(row, "definition_12_063"), text(row, "definition")];
        let is_defined = |d: &&&str| !d.trim().is_empty() && !is(d, "undefined");
        let wkt = definition.iter().rev().find(is_defined).map(|d| (*d).to_owned());
        let code = code.or_else(|| crs::code_of_wkt(wkt.as_deref()?));
        Some((id, System { code, wkt }))
    };
    Ok(rows.0.iter().filter_map(system).collect())
}

/// Returns the tables and columns whose texts are JSON.
fn json_columns(database: &Database, tables: &[Table]) -> Result<Vec<(String, String)>> {
    let rows = Records::of(database, tables, "gpkg_data_columns")?.unwrap_or_default();
    let of_json = rows.0.iter().filter(|row| is(text(row, "mime_type"), "application/json"));
    let names = |row| [text(row, "table_name"), text(row, "column_name")].map(str::to_owned);
    Ok(of_json.map(names).map(|[table, column]| (table, column)).collect())
}

/// Describes a database that has no list of contents.
fn foreign(database: &Database, tables: &[Table]) -> String {
    /// "MPBX".
    const TILES: u32 = 0x4d50_4258;
    let has = |name: &str| tables.iter().any(|table| is(&table.name, name));
    let what = if database.application() == TILES || has("metadata") && has("tiles") {
        "this is MBTiles, which contains tiles; use the data that they were made from"
    } else if has("geometry_columns") {
        "this is SpatiaLite; export it as a GeoPackage"
    } else {
        "this is an SQLite database without the table gpkg_contents that a GeoPackage has"
    };
    what.to_owned()
}

/// A row of a small table: its values by the lower-case names of their columns.
type Record = BTreeMap<String, Value<'static>>;

/// The rows of a small table.
#[derive(Default)]
struct Records(Vec<Record>);

impl Records {
    /// Returns all rows of the table with a name; `None` if there is none.
    fn of(database: &Database, tables: &[Table], name: &str) -> Result<Option<Self>> {
        let Some(table) = tables.iter().find(|t| t.kind == "table" && is(&t.name, name)) else {
            return Ok(None);
        };
        let unknown = || Error::path(format!("table {name}"), "how it was made is not known");
        let columns = columns(&table.sql).ok_or_else(unknown)?;
        let (mut rows, mut records) = (database.rows(table.root), Vec::new());
        while let Some(row) = rows.next(database)? {
            let mut record = Record::new();
            let values = database.values(&row)?;
            for (column, value) in columns.iter().filter(|c| c.is_stored).zip(values) {
                let value = match value {
                    _ if column.is_number => Value::Integer(row.number),
                    Value::Integer(n) => Value::Integer(n),
                    Value::Text(text) => Value::Text(text.into_owned().into()),
                    _ => continue,
                };
                record.insert(column.name.to_ascii_lowercase(), value);
            }
            records.push(record);
        }
        Ok(Some(Self(records)))
    }
}

fn text<'a>(record: &'a Record, key: &str) -> &'a str {
    record.get(key).and_then(Value::text).unwrap_or_default()
}

fn integer(record: &Record, key: &str) -> Option<i64> {
    record.get(key).and_then(Value::integer)
}

/// Returns whether names are the same for SQLite.
fn is(one: &str, other: &str) -> bool {
    one.eq_ignore_ascii_case(other)
}
