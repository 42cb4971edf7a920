//! Features as a file with one table.
//!
//! Pages are written as features are added. The types of fields are known at the end, when the table gets its columns:
//! rows that were written before a field first occurred have no value for it, which SQLite reads as null.

use super::{APPLICATION, blob};
use crate::geo::members::members;
use crate::geo::members::with_id;
use crate::geo::schema::{FieldKind, Schema};
use crate::geo::{Feature, Member, System, crs, wkb};
use crate::sqlite::{NewDatabase, NewTable, Value, index, record};
use crate::{Error, Place, Result, Warning};
use durer::math::Rect;

/// Number of features held until the types of their fields count as known, and …
const HELD: usize = 10_000;

/// … positions that they may have.
const HELD_POSITIONS: usize = 1 << 20;

/// Fields that a table may have, as SQLite is built, beside a number and a geometry.
const MAX_FIELDS: usize = 1998;

/// 1.3.0.
const VERSION: u32 = 10_300;

/// Time of the last change in every file: a file with the same features is the same file at any
/// time.
const CHANGED: &str = "1970-01-01T00:00:00.000Z";

/// Writer of features to pages.
pub struct Writer {
    database: NewDatabase,
    table: NewTable,
    /// The number of the last feature.
    last: i64,
    system: System,
    schema: Schema,
    /// Features that are not written yet, and their numbers.
    held: Vec<(Feature, i64)>,
    positions: usize,
    is_settled: bool,
    /// Types with which the values of fields were last written.
    written: Vec<FieldKind>,
    /// Fields whose values were numbers first, and texts later.
    mixed: Vec<String>,
    bounds: Option<Rect>,
    /// Numbers of kinds of geometries, as far as they are of one.
    kind: Option<u32>,
    kinds_differ: bool,
    ordinates: blob::Ordinates,
}

impl Writer {
    /// Creates a file without a feature.
    pub fn new() -> Self {
        Self {
            database: NewDatabase::new(),
            table: NewTable::new(),
            last: 0,
            system: System::default(),
            schema: Schema::default(),
            held: Vec::new(),
            positions: 0,
            is_settled: false,
            written: Vec::new(),
            mixed: Vec::new(),
            bounds: None,
            kind: None,
            kinds_differ: false,
            ordinates: blob::Ordinates::default(),
        }
    }

    /// Sets the system of the coordinates, before the first feature.
    pub fn set_system(&mut self, system: System) {
        self.system = system;
    }

    /// Returns the pages since the last call.
    pub fn take(&mut self) -> Vec<u8> {
        self.database.take()
    }

    /// Adds a feature.
    ///
    /// # Errors
    /// If there are too many fields or pages.
    pub fn add(&mut self, feature: &Feature) -> Result<()> {
        let (feature, number) = with_number(feature, self.last);
        self.last = number;
        self.schema.add(&feature);
        if self.schema.columns().len() > MAX_FIELDS {
            let what = format!("a GeoPackage of more than {MAX_FIELDS} fields");
            let hint = "--select chooses some".to_owned();
            return Err(Error::Unsupported { place: Place::Whole, what, hint });
        }
        self.note(&feature);
        if self.is_settled {
            return self.row(&feature, number);
        }
        self.positions += feature.geometry.as_ref().map_or(0, crate::geo::Geometry::len);
        self.held.push((feature, number));
        if self.held.len() >= HELD || self.positions >= HELD_POSITIONS {
            self.settle()?;
        }
        Ok(())
    }

    /// Writes the features that were held.
    fn settle(&mut self) -> Result<()> {
        self.is_settled = true;
        let held = std::mem::take(&mut self.held);
        held.iter().try_for_each(|(feature, number)| self.row(feature, *number))
    }

    fn note(&mut self, feature: &Feature) {
        let Some(geometry) = &feature.geometry else { return };
        if self.system.is_unknown()
            && let Some(srid) = feature.srid
        {
            self.system = System::of_code(srid);
        }
        let bounds = [self.bounds, geometry.bounds()];
        self.bounds = Rect::around(bounds.iter().flatten().flat_map(|b| [b.min(), b.max()]));
        let kind = wkb::kind(geometry);
        self.kinds_differ |= self.kind.is_some_and(|own| own != kind);
        self.kind = Some(kind);
        self.ordinates.add(geometry.dimensions());
    }

    fn row(&mut self, feature: &Feature, number: i64) -> Result<()> {
        let id = system_id(&self.system);
        let geometry = feature.geometry.as_ref().map(|geometry| blob::write(geometry, id));
        let geometry = geometry.as_deref().map_or(Value::Null, Value::Blob);
        let mut values = vec![Value::Null, geometry];
        for member in members(feature.properties.as_deref().unwrap_or_default()) {
            let Some(place) = self.schema.find(&member.key()) else { continue };
            let Some(field) = self.schema.columns().get(place) else { continue };
            let kind = field.kind;
            if values.len() < place + 3 {
                values.resize(place + 3, Value::Null);
                self.written.resize(self.written.len().max(place + 1), FieldKind::Null);
            }
            let was = std::mem::replace(&mut self.written[place], kind);
            let is_number =
                |k| matches!(k, FieldKind::Boolean | FieldKind::Integer | FieldKind::Number);
            if is_number(was) && !is_number(kind) {
                self.mixed.push(member.key());
            }
            values[place + 2] = value(&member, kind);
        }
        let nulls = values.iter().skip(2).rev().take_while(|v| **v == Value::Null).count();
        values.truncate(values.len() - nulls);
        self.table.add_at(&mut self.database, number, &values)
    }

    /// Writes the remaining pages, under the name of a layer; returns the first page, which takes the place of the
    /// first one that was taken, the pages at the end, and the warnings.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn finish(mut self, name: &str) -> Result<(Vec<u8>, Vec<u8>, Vec<Warning>)> {
        if !self.is_settled {
            self.settle()?;
        }
        let (name, mut warnings) = (layer_name(name), Vec::new());
        let (sql, geometry, renamed) = self.definition(&name);
        for (what, list) in [
            ("fields have names that differ by capitals alone, and get new ones", renamed),
            (
                "fields are texts after being numbers; their first values stay numbers",
                self.mixed.clone(),
            ),
        ] {
            if !list.is_empty() {
                let message = format!("{} {what}: {}", list.len(), list.join(", "));
                warnings.push(Warning { place: Place::Whole, message });
            }
        }
        let mut database = self.database;
        let root = self.table.finish(&mut database)?;
        let id = system_id(&self.system);
        systems(&mut database, &self.system)?;
        contents(&mut database, &name, self.bounds, id)?;
        let kind = blob::kind_name(self.kind.filter(|_| !self.kinds_differ));
        geometry_columns(&mut database, [&name, &geometry, kind], id, self.ordinates.codes())?;
        database.name("table", &name, &name, root, &sql);
        let (first, rest) = database.finish(APPLICATION, VERSION)?;
        Ok((first, rest, warnings))
    }

    /// Returns the statement that creates the table, the name of its geometry column, and fields that were renamed.
    fn definition(&self, name: &str) -> (String, String, Vec<String>) {
        let mut taken: Vec<String> = Vec::new();
        let mut renamed = Vec::new();
        let fields = self.schema.columns();
        let wanted = |name: &str| fields.iter().any(|f| f.key.eq_ignore_ascii_case(name));
        let free = |name: &str| {
            let mut others =
                std::iter::once(name.to_owned()).chain((1..).map(|i| format!("{name}_{i}")));
            others.find(|name| !wanted(name)).unwrap_or_default()
        };
        let (number, geometry) = (free("fid"), free("geom"));
        let kind = blob::kind_name(self.kind.filter(|_| !self.kinds_differ));
        let mut parts = vec![
            format!("{} INTEGER PRIMARY KEY NOT NULL", quote(&number)),
            format!("{} {kind}", quote(&geometry)),
        ];
        for field in fields {
            let plain: String = field.key.chars().filter(|c| *c != '\0').collect();
            let is_taken =
                |name: &str, taken: &[String]| taken.iter().any(|t| t.eq_ignore_ascii_case(name));
            let mut name = plain.clone();
            for i in 2.. {
                if !name.is_empty()
                    && !is_taken(&name, &taken)
                    && (name == field.key || !wanted(&name))
                {
                    break;
                }
                name = format!("{plain}_{i}");
            }
            if name != field.key {
                renamed.push(format!("{} → {name}", field.key));
            }
            parts.push(format!("{} {}", quote(&name), type_name(field.kind)));
            taken.push(name);
        }
        (format!("CREATE TABLE {} ({})", quote(name), parts.join(", ")), geometry, renamed)
    }
}

/// Returns the feature and its number: its id, if that is a whole number above the last one. Any other id
/// becomes a field.
fn with_number(feature: &Feature, last: i64) -> (Feature, i64) {
    let number = feature.id.as_ref().and_then(|id| id.parse::<i64>().ok());
    match number.filter(|&number| number > last && number < i64::MAX / 2) {
        Some(number) => (feature.clone(), number),
        None => (with_id(feature), last + 1),
    }
}

fn value(member: &Member, kind: FieldKind) -> Value<'static> {
    let text = &member.value;
    match kind {
        _ if FieldKind::of(text) == FieldKind::Null => Value::Null,
        FieldKind::Boolean => Value::Integer((text == "true").into()),
        FieldKind::Integer => text.parse().map_or(Value::Null, Value::Integer),
        FieldKind::Number => text.parse().map_or(Value::Null, Value::Real),
        _ => Value::Text(member.text().unwrap_or_else(|| text.clone()).into()),
    }
}

fn type_name(kind: FieldKind) -> &'static str {
    match kind {
        FieldKind::Boolean => "BOOLEAN",
        FieldKind::Integer => "INTEGER",
        FieldKind::Number => "REAL",
        FieldKind::Date => "DATE",
        FieldKind::Null | FieldKind::Text | FieldKind::Json => "TEXT",
    }
}

/// Returns a name in SQL.
fn quote(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

/// Returns a name that a table may have: at most 200 bytes, none that belongs to the format.
fn layer_name(name: &str) -> String {
    let mut own = String::new();
    for c in name.chars().filter(|c| !c.is_control()) {
        if own.len() + c.len_utf8() <= 200 {
            own.push(c);
        }
    }
    let lower = own.to_ascii_lowercase();
    let taken = ["gpkg_", "rtree_", "sqlite_"].iter().any(|prefix| lower.starts_with(prefix));
    if own.is_empty() || taken {
        format!("layer_{own}").trim_end_matches('_').to_owned()
    } else {
        own
    }
}

/// Returns the number of a system in the file; -1 for one that is not known.
fn system_id(system: &System) -> i32 {
    /// Number for a system that has a definition and no number.
    const OWN: i32 = 300_000;
    match (system.code, &system.wkt) {
        (Some(code), _) if code > 0 => code,
        (_, Some(_)) => OWN,
        _ => -1,
    }
}

/// The definition of WGS 84 that every file has.
const WGS84: &str = r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AXIS["Latitude",NORTH],AXIS["Longitude",EAST],AUTHORITY["EPSG","4326"]]"#;

fn systems(database: &mut NewDatabase, system: &System) -> Result<()> {
    let mut table = NewTable::new();
    let mut add = |id: i32, name: &str, of: &str, definition: &str| {
        let code = Value::Integer(id.into());
        let values = [name.into(), Value::Null, of.into(), code, definition.into(), Value::Null];
        table.add_at(database, id.into(), &values)
    };
    add(-1, "Undefined Cartesian SRS", "NONE", "undefined")?;
    add(0, "Undefined geographic SRS", "NONE", "undefined")?;
    let id = system_id(system);
    let mut all = vec![(4326, "WGS 84".to_owned(), "EPSG", WGS84.to_owned())];
    if id > 0 && id != 4326 {
        let known = || system.code.and_then(crs::wkt_of_code);
        let wkt = system.wkt.clone().or_else(known).unwrap_or_else(|| "undefined".to_owned());
        let of = match system.code {
            None => "NONE",
            Some(code) if is_esri(code) => "ESRI",
            Some(_) => "EPSG",
        };
        let name = system.code.map_or_else(|| "unnamed".to_owned(), |code| format!("{of}:{code}"));
        all.push((id, name, of, wkt));
    }
    all.sort_by_key(|system| system.0);
    all.iter().try_for_each(|(id, name, of, wkt)| add(*id, name, of, wkt))?;
    let root = table.finish(database)?;
    let name = "gpkg_spatial_ref_sys";
    let sql = "CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER NOT NULL PRIMARY KEY, \
               organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT)";
    database.name("table", name, name, root, sql);
    Ok(())
}

/// Returns whether a number is of Esri's list, which has others than the EPSG's.
fn is_esri(code: i32) -> bool {
    code >= 50_000
}

fn contents(database: &mut NewDatabase, layer: &str, bounds: Option<Rect>, id: i32) -> Result<()> {
    let mut table = NewTable::new();
    let corners = bounds.map(|b| [b.min().x, b.min().y, b.max().x, b.max().y]);
    let number = |i: usize| corners.map_or(Value::Null, |corners| Value::Real(corners[i]));
    let [a, b, c, d] = [0, 1, 2, 3].map(number);
    let (kind, changed, none) = (Value::from("features"), Value::from(CHANGED), Value::from(""));
    let id = Value::Integer(id.into());
    table.add(database, &[layer.into(), kind, layer.into(), none, changed, a, b, c, d, id])?;
    let root = table.finish(database)?;
    let name = "gpkg_contents";
    let sql = "CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, \
               identifier TEXT UNIQUE, description TEXT DEFAULT '', \
               last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')), \
               min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER, \
               CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id))";
    database.name("table", name, name, root, sql);
    own_index(database, name, 1, &[layer.into()])?;
    own_index(database, name, 2, &[layer.into()])
}

fn geometry_columns(
    database: &mut NewDatabase,
    [layer, column, kind]: [&str; 3],
    id: i32,
    [z, m]: [i64; 2],
) -> Result<()> {
    let mut table = NewTable::new();
    let [id, z, m] = [id.into(), z, m].map(Value::Integer);
    table.add(database, &[layer.into(), column.into(), kind.into(), id, z, m])?;
    let root = table.finish(database)?;
    let name = "gpkg_geometry_columns";
    let sql = "CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL, \
               geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL, \
               CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name), CONSTRAINT uk_gc_table_name UNIQUE (table_name), \
               CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name), \
               CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id))";
    database.name("table", name, name, root, sql);
    own_index(database, name, 1, &[layer.into(), column.into()])?;
    own_index(database, name, 2, &[layer.into()])
}

/// Adds the index that SQLite would make for unique values, of a table with one row.
fn own_index(
    database: &mut NewDatabase,
    table: &str,
    number: u32,
    key: &[Value<'_>],
) -> Result<()> {
    let row = [key, &[Value::Integer(1)]].concat();
    let root = index(database, &[record(&row)])?;
    database.name("index", &format!("sqlite_autoindex_{table}_{number}"), table, root, "");
    Ok(())
}
