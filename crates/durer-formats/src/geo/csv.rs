//! Tables as text (RFC 4180) whose columns hold geometries: as WKT or hexadecimal WKB in one, or as
//! longitude and latitude, or x and y, in two.
//!
//! The first row names the columns. The separator is the comma, semicolon, tab or bar, whichever is most frequent in
//! the first row. A column whose values are all JSON numbers, or `true` and `false`, has values of that type; any other
//! column has texts, so that `01067` and `1 067` do not change. Empty values are null.

use super::members::{members, object, quoted};
use super::{Feature, Geometry, Member, Points, Warnings, wkb, wkt};
use crate::text::{Tally, name};
use crate::{Error, Place, Result};
use durer::math::DVec2;
use std::borrow::Cow;
use std::io::{self, Write};

/// Names of columns with whole geometries, in lower case.
const GEOMETRY: [&str; 10] = [
    "wkt",
    "geometry",
    "geom",
    "the_geom",
    "wkt_geom",
    "wkt_geometry",
    "wkb_geometry",
    "wkb",
    "shape",
    "geo_wkt",
];

/// Names of columns with x and y, in lower case.
const PLACES: [(&str, &str); 13] = [
    ("lon", "lat"),
    ("lng", "lat"),
    ("long", "lat"),
    ("longitude", "latitude"),
    ("lon_deg", "lat_deg"),
    ("x", "y"),
    ("easting", "northing"),
    ("decimallongitude", "decimallatitude"),
    ("coord_x", "coord_y"),
    ("point_x", "point_y"),
    ("xcoord", "ycoord"),
    ("laenge", "breite"),
    ("länge", "breite"),
];

/// Names of columns with a height beside x and y, in lower case.
const HEIGHTS: [&str; 5] = ["z", "height", "elevation", "altitude", "ele"];

/// Columns that hold geometries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Where {
    Whole(usize),
    /// x, y, and the height if there is one.
    Parts(usize, usize, Option<usize>),
}

/// Kind of a column's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Json,
    Text,
}

/// Returns whether the first row names columns with geometries.
pub fn sniff(text: &[u8]) -> bool {
    let skipped = Rows::after_separator(text).map_or(0, |rows| rows.at + 1);
    let names = text.get(skipped..).unwrap_or_default();
    let end = names.iter().position(|&b| b == b'\n').map_or(text.len(), |end| skipped + end);
    let Some(line) = text.get(..end) else { return false };
    let mut rows = Rows::new(line);
    let Some(first) = rows.next(line) else { return false };
    first.len() > 1 && std::str::from_utf8(line).is_ok() && places(&keys(&first)).is_some()
}

fn keys(row: &[Cow<'_, [u8]>]) -> Vec<String> {
    row.iter().map(|value| name(value.trim_ascii()).into_owned()).collect()
}

/// Returns the columns of geometries, by their names.
fn places(keys: &[String]) -> Option<Where> {
    // A unit may follow in brackets.
    let bare = |key: &String| {
        key.to_lowercase().split(['(', '[']).next().map(str::trim_end).map(str::to_owned)
    };
    let lower: Vec<String> = keys.iter().map(|key| bare(key).unwrap_or_default()).collect();
    let index = |name: &&str| lower.iter().position(|key| key == *name);
    // The last of that name: tables that are written here have the geometry at the end, after any field of the same
    // name.
    let last = |name: &&str| lower.iter().rposition(|key| key == *name);
    let whole = GEOMETRY.iter().find_map(last);
    let height = HEIGHTS.iter().find_map(index);
    let pair = || PLACES.iter().find_map(|(x, y)| Some((index(x)?, index(y)?)));
    whole.map(Where::Whole).or_else(|| pair().map(|(x, y)| Where::Parts(x, y, height)))
}

/// A walk over rows.
#[derive(Debug, Clone, Copy)]
struct Rows {
    at: usize,
    line: u64,
    delimiter: u8,
}

impl Rows {
    /// Creates a walk at the first row, which determines the separator of values.
    fn new(text: &[u8]) -> Self {
        if let Some(rows) = Self::after_separator(text) {
            return rows;
        }
        let mut counts = [0_u32; 4];
        let mut quoted = false;
        for &byte in text {
            match byte {
                b'"' => quoted = !quoted,
                b'\n' if !quoted => break,
                _ if quoted => {}
                _ => {
                    let found = DELIMITERS.iter().position(|&d| d == byte);
                    found.and_then(|i| counts.get_mut(i)).into_iter().for_each(|n| *n += 1);
                }
            }
        }
        // Of several equally frequent ones, the first.
        let most = DELIMITERS.iter().zip(counts).rev().max_by_key(|(_, count)| *count);
        Self { at: 0, line: 1, delimiter: most.map_or(b',', |(&d, _)| d) }
    }

    /// Creates a walk after the line `sep=;` with which Excel names the separator; `None` without one.
    fn after_separator(text: &[u8]) -> Option<Self> {
        let line = text.split(|&b| b == b'\n').next()?;
        match *line.trim_ascii_end().strip_prefix(b"sep=")? {
            [] if line.starts_with(b"sep=\t") => {
                Some(Self { at: line.len(), line: 1, delimiter: b'\t' })
            }
            [delimiter] if DELIMITERS.contains(&delimiter) => {
                Some(Self { at: line.len(), line: 1, delimiter })
            }
            _ => None,
        }
    }

    /// Steps to the next row that is not empty, and returns its line.
    fn start(&mut self, text: &[u8]) -> u64 {
        while matches!(text.get(self.at), Some(b'\r' | b'\n')) {
            self.line += u64::from(text.get(self.at) == Some(&b'\n'));
            self.at += 1;
        }
        self.line
    }

    /// Returns the values of the next row that is not empty.
    fn next<'a>(&mut self, text: &'a [u8]) -> Option<Vec<Cow<'a, [u8]>>> {
        self.start(text);
        if self.at >= text.len() {
            return None;
        }
        let mut values = Vec::new();
        loop {
            values.push(self.value(text));
            match text.get(self.at) {
                Some(&byte) if byte == self.delimiter => self.at += 1,
                _ => return Some(values),
            }
        }
    }

    /// Returns the value from here to the next separator, without quotes.
    fn value<'a>(&mut self, text: &'a [u8]) -> Cow<'a, [u8]> {
        if text.get(self.at) == Some(&b'"') {
            return Cow::Owned(self.quoted(text));
        }
        let rest = text.get(self.at..).unwrap_or_default();
        let end = |b: &u8| *b == self.delimiter || matches!(b, b'\n' | b'\r');
        let length = rest.iter().position(end).unwrap_or(rest.len());
        self.at += length;
        Cow::Borrowed(rest.get(..length).unwrap_or_default())
    }

    fn quoted(&mut self, text: &[u8]) -> Vec<u8> {
        let mut value = Vec::new();
        let mut within = true;
        self.at += 1;
        while let Some(&byte) = text.get(self.at) {
            match byte {
                b'"' if within && text.get(self.at + 1) == Some(&b'"') => {
                    value.push(b'"');
                    self.at += 1;
                }
                b'"' if within => within = false,
                b'\n' | b'\r' if !within => break,
                _ if !within && byte == self.delimiter => break,
                _ => value.push(byte),
            }
            self.line += u64::from(byte == b'\n');
            self.at += 1;
        }
        value
    }
}

const DELIMITERS: [u8; 4] = [b',', b';', b'\t', b'|'];

/// Reader of the rows of a table as features.
#[derive(Debug)]
pub struct Reader {
    text: Vec<u8>,
    rows: Rows,
    keys: Vec<String>,
    kinds: Vec<Kind>,
    place: Where,
    ragged: Tally,
    nowhere: Tally,
}

impl Reader {
    /// Creates a reader; examines all values to find the types of columns.
    ///
    /// # Errors
    /// If no column is known to hold geometries.
    pub fn new(text: Vec<u8>) -> Result<Self> {
        let mut rows = Rows::new(&text);
        let names = rows.next(&text).map(|row| keys(&row));
        let keys =
            names.ok_or_else(|| Error::whole("the file is empty; its first row has names"))?;
        let place = places(&keys).ok_or_else(|| no_place(&keys))?;
        let mut kinds = vec![Kind::Json; keys.len()];
        let mut further = rows;
        while let Some(row) = further.next(&text) {
            for (kind, value) in kinds.iter_mut().zip(&row) {
                if !value.is_empty() && !is_json(value) {
                    *kind = Kind::Text;
                }
            }
        }
        let (ragged, nowhere) = Default::default();
        Ok(Self { text, rows, keys, kinds, place, ragged, nowhere })
    }

    /// Returns the next row; `None` at the end.
    pub fn next_feature(&mut self, warnings: &mut Warnings) -> Result<Option<Feature>> {
        let line = self.rows.start(&self.text);
        let Some(row) = self.rows.next(&self.text) else {
            self.warn(warnings);
            return Ok(None);
        };
        self.check_commas(&row, line)?;
        if row.len() != self.keys.len() {
            self.ragged.add(|| Place::Line(line, 0));
        }
        let mut feature = match self.place {
            Where::Whole(at) => whole(row.get(at).map_or(&[], |v| v), line, warnings)?,
            Where::Parts(x, y, z) => point(&row, (x, y, z)).unwrap_or_else(|| {
                self.nowhere.add(|| Place::Line(line, 0));
                Feature::default()
            }),
        };
        feature.properties = Some(object(&self.fields(&row)));
        Ok(Some(feature))
    }

    /// Refuses a row that decimal commas have split into more values than there are columns.
    fn check_commas(&self, row: &[Cow<'_, [u8]>], line: u64) -> Result<()> {
        let Where::Parts(x, y, _) = self.place else { return Ok(()) };
        let surplus = row.get(self.keys.len()..).unwrap_or_default();
        let is_whole = |i: usize| row.get(i).is_some_and(|value| is_integer(value.trim_ascii()));
        let is_split = self.rows.delimiter == b','
            && surplus.iter().any(|value| !value.trim_ascii().is_empty())
            && is_whole(x)
            && is_whole(y);
        if !is_split {
            return Ok(());
        }
        let (values, columns) = (row.len(), self.keys.len());
        let message = format!(
            "the row has {values} values for {columns} columns, as if its numbers had decimal commas; write them with points, in \
             quotes, or with semicolons between the values"
        );
        Err(Error::line(line, 0, message))
    }

    fn warn(&mut self, warnings: &mut Warnings) {
        let [ragged, nowhere] = [&mut self.ragged, &mut self.nowhere].map(std::mem::take);
        warnings.add_counted(
            ragged,
            "row has more or fewer values than there are columns",
            "rows have more or fewer values than there are columns",
        );
        warnings.add_counted(
            nowhere,
            "row has no numbers in the columns of its place; it has no geometry",
            "rows have no numbers in the columns of their place; they have no geometry",
        );
    }

    /// Returns all values except the geometry's.
    fn fields(&self, row: &[Cow<'_, [u8]>]) -> Vec<Member> {
        let own = |i: usize| match self.place {
            Where::Whole(at) => i == at,
            Where::Parts(x, y, z) => i == x || i == y || Some(i) == z,
        };
        let columns = self.keys.iter().zip(&self.kinds).enumerate().filter(|(i, _)| !own(*i));
        let field = |(i, (key, kind)): (usize, (&String, &Kind))| {
            let value = row.get(i).map_or(&[][..], |v| v);
            let json = match kind {
                _ if value.is_empty() => "null".to_owned(),
                Kind::Json => name(value).into_owned(),
                Kind::Text => quoted(&name(value)),
            };
            Member::new(key, json)
        };
        columns.map(field).collect()
    }
}

/// Returns the point at x and y, and at a height if there is one.
fn point(row: &[Cow<'_, [u8]>], (x, y, z): (usize, usize, Option<usize>)) -> Option<Feature> {
    let value = |i: usize| number(row.get(i)?);
    let height = z.and_then(value);
    let mut point = Points::new(super::Dimensions::new(height.is_some(), false));
    point.push(DVec2::new(value(x)?, value(y)?), [height.unwrap_or(0.0), 0.0]);
    Some(Feature::of_geometry(Geometry::Point(point)))
}

fn no_place(keys: &[String]) -> Error {
    let keys = crate::text::quote(keys.join(", ").as_bytes());
    Error::line(
        1,
        0,
        format!(
            "no column is known to hold geometries among {keys}; name it WKT or geometry, or two \
             of them lon and lat, or x and y"
        ),
    )
}

/// Returns a finite number; a decimal comma counts as a point.
fn number(value: &[u8]) -> Option<f64> {
    let value = value.trim_ascii();
    let dotted: Vec<u8> = value.iter().map(|&b| if b == b',' { b'.' } else { b }).collect();
    let (number, length) = crate::number::float(&dotted)?;
    (length == value.len() && number.is_finite()).then_some(number)
}

/// Returns whether a value is a number without point and exponent.
fn is_integer(value: &[u8]) -> bool {
    let digits = value.strip_prefix(b"-").unwrap_or(value);
    !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)
}

/// Returns whether a value is a number of JSON that a double holds, or a truth value.
fn is_json(value: &[u8]) -> bool {
    let is_value =
        matches!(value, b"true" | b"false") || matches!(value.first(), Some(b'-' | b'0'..=b'9'));
    let digits = value.iter().filter(|b| b.is_ascii_digit()).count();
    is_value && digits <= 17 && serde_json::from_slice::<serde_json::Value>(value).is_ok()
}

/// Returns the geometry that one value holds.
fn whole(value: &[u8], line: u64, warnings: &mut Warnings) -> Result<Feature> {
    let value = value.trim_ascii();
    if value.is_empty() {
        return Ok(Feature::default());
    }
    let here = |_: Place| Place::Line(line, 0);
    let (feature, mut own) = if wkb::sniff_hex(value) {
        let bytes = wkb::decode_hex(value, line)?;
        let mut reader = wkb::Reader::new(&bytes);
        (reader.next_feature(), reader.warnings)
    } else {
        let mut reader = wkt::Reader::new(value, wkt::Mark::default());
        (reader.next_feature(), reader.warnings)
    };
    own.relocate(here);
    warnings.append(&mut own);
    feature.map(Option::unwrap_or_default).map_err(|e| e.at(here))
}

/// Writes features as rows: their fields, then the geometry as WKT.
pub fn write(out: &mut impl Write, features: &[Feature]) -> io::Result<()> {
    let columns = super::schema::Schema::of(features);
    let keys = columns.columns().iter().map(|c| c.key.as_str()).chain(["WKT"]);
    row(out, keys.map(|key| Cow::Borrowed(key.as_bytes())))?;
    for feature in features {
        let fields = members(feature.properties.as_deref().unwrap_or_default());
        let mut values = vec![String::new(); columns.columns().len()];
        for field in &fields {
            let place = columns.find(&field.key()).and_then(|i| values.get_mut(i));
            place.into_iter().for_each(|value| *value = plain(&field.value));
        }
        let mut text = Vec::new();
        wkt::write_feature(&mut text, feature)?;
        let geometry = text.trim_ascii_end().to_vec();
        let values = values.into_iter().map(String::into_bytes).chain([geometry]);
        row(out, values.map(Cow::Owned))?;
    }
    Ok(())
}

/// Returns a value of JSON as a table has it: texts without quotes, nothing for null.
fn plain(value: &str) -> String {
    match serde_json::from_str(value) {
        Ok(serde_json::Value::String(text)) => text,
        Ok(serde_json::Value::Null) => String::new(),
        _ => value.to_owned(),
    }
}

fn row<'a>(out: &mut impl Write, values: impl Iterator<Item = Cow<'a, [u8]>>) -> io::Result<()> {
    for (i, value) in values.enumerate() {
        out.write_all(if i > 0 { b"," } else { b"" })?;
        // Whatever may separate values, because a reader may count them in the first row.
        let special = |b: &u8| DELIMITERS.contains(b) || matches!(b, b'"' | b'\n' | b'\r');
        if value.iter().any(special) {
            let doubled = String::from_utf8_lossy(&value).replace('"', "\"\"");
            write!(out, "\"{doubled}\"")?;
        } else {
            out.write_all(&value)?;
        }
    }
    out.write_all(b"\n")
}
