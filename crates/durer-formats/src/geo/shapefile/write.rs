//! Features as a Shapefile: the files that make one up.

use super::encoding::whole_letters;
use super::{HEADER, MAGIC};
use crate::geo::members::members;
use crate::geo::schema::{Field, FieldKind, Schema};
use crate::geo::{Dimensions, Feature, Geometry, Points, System, crs};
use crate::{Error, Place, Result, Warning};
use durer::clip::polygon::signed_area;
use durer::math::{DVec2, Rect};
use std::collections::BTreeSet;

/// The longest text that a table holds, in bytes.
const MAX_TEXT: usize = 254;

/// The longest name of a field, in bytes.
const MAX_KEY: usize = 10;

/// A fixed date for the head of tables, which must have one: the same input gives the same bytes on every day.
const DAY: [u8; 3] = [95, 7, 26];

/// Files beside the .shp: ends of names, and bytes.
pub type Sidecars = Vec<(&'static str, Vec<u8>)>;

/// Returns the bytes of a .shp, and the files beside it.
///
/// # Errors
/// If features have several kinds of geometry, as a Shapefile contains only one, or are too many.
pub fn write(features: &[Feature], system: &System) -> Result<(Vec<u8>, Sidecars, Vec<Warning>)> {
    let mut warnings = Vec::new();
    let shapes: Vec<Shape> = features.iter().map(|f| Shape::of(f.geometry.as_ref())).collect();
    let kind = kind(&shapes)?;
    let (shp, shx) = records(&shapes, kind)?;
    let dbf = table(features, &mut warnings)?;
    let mut beside = vec![("shx", shx), ("dbf", dbf), ("cpg", b"UTF-8".to_vec())];
    let known = || crs::wkt_of_code(system.code?);
    let wkt = system.wkt.clone().filter(|wkt| crs::is_wkt1(wkt)).or_else(known);
    match wkt {
        Some(wkt) => beside.push(("prj", wkt.into_bytes())),
        None if system.is_unknown() => {}
        None => {
            let message = "the coordinate system has no definition for a .prj; none is written";
            warnings.push(Warning { place: Place::Whole, message: message.to_owned() });
        }
    }
    Ok((shp, beside, warnings))
}

/// Positions, lines or rings of one feature.
#[derive(Debug, Default)]
struct Shape {
    points: Vec<Points>,
    lines: Vec<Points>,
    /// Closed; outer rings clockwise, holes counter-clockwise.
    rings: Vec<Points>,
}

impl Shape {
    fn of(geometry: Option<&Geometry>) -> Self {
        let mut shape = Self::default();
        geometry.into_iter().for_each(|geometry| shape.add(geometry));
        shape
    }

    fn add(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Point(points) | Geometry::MultiPoint(points) => {
                self.points.push(points.clone())
            }
            Geometry::LineString(line) => self.lines.push(line.clone()),
            Geometry::MultiLineString(lines) => self.lines.extend(lines.iter().cloned()),
            Geometry::Polygon(rings) => self.polygon(rings),
            Geometry::MultiPolygon(polygons) => {
                polygons.iter().for_each(|rings| self.polygon(rings))
            }
            Geometry::Collection(parts) => parts.iter().for_each(|part| self.add(part)),
        }
    }

    fn polygon(&mut self, rings: &[Points]) {
        for (i, ring) in rings.iter().enumerate().filter(|(_, ring)| !ring.is_empty()) {
            let turned = (signed_area(&ring.xy) > 0.0) == (i == 0);
            let order: Vec<usize> = (0..ring.len()).chain([0]).collect();
            let mut closed = Points::new(ring.dimensions);
            let mut add = |&j: &usize| closed.push(ring.xy[j], ring.zm(j));
            if turned {
                order.iter().rev().for_each(&mut add)
            } else {
                order.iter().for_each(&mut add)
            }
            self.rings.push(closed);
        }
    }

    fn parts(&self) -> impl Iterator<Item = &Points> {
        let all = self.points.iter().chain(&self.lines).chain(&self.rings);
        all.filter(|part| !part.is_empty())
    }

    fn len(&self) -> usize {
        self.parts().map(Points::len).sum()
    }
}

/// Kind of all records: the number of the flat kind, and whether they have heights and measures.
#[derive(Debug, Clone, Copy)]
struct Kind {
    shape: u32,
    dimensions: Dimensions,
}

impl Kind {
    fn code(self) -> u32 {
        match (self.dimensions.has_z(), self.dimensions.has_m()) {
            (true, _) => 10 + self.shape,
            (false, true) => 20 + self.shape,
            _ => self.shape,
        }
    }
}

fn kind(shapes: &[Shape]) -> Result<Kind> {
    let count = |any: fn(&Shape) -> usize| shapes.iter().filter(|s| any(s) > 0).count();
    let points = count(|s| s.points.iter().map(Points::len).sum());
    let counts = [
        (points, 1, "points"),
        (count(|s| s.lines.len()), 3, "lines"),
        (count(|s| s.rings.len()), 5, "polygons"),
    ];
    let there: Vec<_> = counts.iter().filter(|(count, ..)| *count > 0).collect();
    if there.len() > 1 {
        let words: Vec<String> =
            there.iter().map(|(count, _, what)| format!("{count} features of {what}")).collect();
        return Err(Error::Unsupported {
            place: Place::Whole,
            what: format!("a Shapefile with {}", words.join(" and ")),
            hint: "it holds one kind; write FlatGeobuf or GeoJSON, or each kind for itself"
                .to_owned(),
        });
    }
    let shape = match there.first() {
        Some((_, 1, _)) if shapes.iter().any(|s| s.len() > 1) => 8,
        Some((_, shape, _)) => *shape,
        None => 0,
    };
    let all = || shapes.iter().flat_map(Shape::parts);
    let z = all().any(|part| part.dimensions.has_z());
    let m = all().any(|part| part.dimensions.has_m());
    Ok(Kind { shape, dimensions: Dimensions::new(z, m) })
}

/// Returns the .shp and the .shx.
fn records(shapes: &[Shape], kind: Kind) -> Result<(Vec<u8>, Vec<u8>)> {
    let (mut shp, mut shx) = (vec![0; HEADER], vec![0; HEADER]);
    for (number, shape) in (1_u32..).zip(shapes) {
        let content = content(shape, kind);
        let words = |length: usize| {
            let what = "length of a Shapefile in bytes";
            let (value, limit) = (length as u64, 2 * u64::from(u32::MAX >> 1));
            let error = || Error::Limit { place: Place::Whole, what, value, limit };
            i32::try_from(length / 2).map(i32::to_be_bytes).map_err(|_| error())
        };
        let (start, length) = (words(shp.len())?, words(content.len())?);
        shx.extend(start.iter().chain(&length));
        shp.extend(number.to_be_bytes().iter().chain(&length).chain(&content));
    }
    let all = || shapes.iter().flat_map(Shape::parts);
    let bounds = Rect::around(all().flat_map(|part| part.xy.iter().copied()));
    let third = |i: usize| range(all().flat_map(|part| part.zm.iter().map(move |zm| zm[i])));
    for file in [&mut shp, &mut shx] {
        let words = u32::try_from(file.len() / 2).unwrap_or(u32::MAX);
        let mut head = Vec::with_capacity(HEADER);
        head.extend(MAGIC);
        head.extend([0; 20]);
        head.extend(words.to_be_bytes());
        head.extend(1000_u32.to_le_bytes());
        head.extend(kind.code().to_le_bytes());
        put_bounds(&mut head, bounds);
        for range in [third(0), third(1)] {
            range.iter().for_each(|n| head.extend(n.to_le_bytes()));
        }
        file.splice(..HEADER, head);
    }
    Ok((shp, shx))
}

/// Returns the smallest and the largest of numbers; zeros if there are none.
fn range(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let joined = numbers.map(|n| [n, n]).reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
    joined.unwrap_or_default()
}

fn put_bounds(out: &mut Vec<u8>, bounds: Option<Rect>) {
    let (low, high) = bounds.map_or_else(Default::default, |b| (b.min(), b.max()));
    for corner in [low, high] as [DVec2; 2] {
        out.extend(corner.x.to_le_bytes().iter().chain(&corner.y.to_le_bytes()));
    }
}

/// Returns the content of a record.
fn content(shape: &Shape, kind: Kind) -> Vec<u8> {
    let mut out = Vec::new();
    if shape.len() == 0 {
        out.extend(0_u32.to_le_bytes());
        return out;
    }
    let word = |n: usize| u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes();
    out.extend(kind.code().to_le_bytes());
    if kind.shape != 1 {
        put_bounds(&mut out, Rect::around(shape.parts().flat_map(|part| part.xy.iter().copied())));
    }
    if matches!(kind.shape, 3 | 5) {
        out.extend(word(shape.parts().count()));
    }
    if kind.shape != 1 {
        out.extend(word(shape.len()));
    }
    if matches!(kind.shape, 3 | 5) {
        let mut start = 0;
        for part in shape.parts() {
            out.extend(word(start));
            start += part.len();
        }
    }
    for p in shape.parts().flat_map(|part| &part.xy) {
        out.extend(p.x.to_le_bytes().iter().chain(&p.y.to_le_bytes()));
    }
    for (i, there) in [kind.dimensions.has_z(), kind.dimensions.has_m()].into_iter().enumerate() {
        if !there {
            continue;
        }
        let numbers =
            || shape.parts().flat_map(move |part| (0..part.len()).map(move |j| part.zm(j)[i]));
        if kind.shape != 1 {
            range(numbers()).iter().for_each(|n| out.extend(n.to_le_bytes()));
        }
        numbers().for_each(|n| out.extend(n.to_le_bytes()));
    }
    out
}

/// A field of the table.
struct Column<'a> {
    /// Its name, truncated if it is long.
    key: String,
    /// The field of the features; `None` for their numbers, if there is no field.
    field: Option<&'a Field>,
    kind: u8,
    width: usize,
    decimals: usize,
}

fn table(features: &[Feature], warnings: &mut Vec<Warning>) -> Result<Vec<u8>> {
    let schema = Schema::of(features);
    let mut fields: Vec<Option<&Field>> = schema.columns().iter().map(Some).collect();
    if fields.is_empty() {
        fields.push(None);
    }
    let mut columns = named(&fields, warnings);
    let rows: Vec<Vec<Vec<u8>>> =
        features.iter().zip(0_u64..).map(|(f, i)| values(f, i, &columns, &schema)).collect();
    fit(&mut columns, &rows, warnings);
    let length = 1 + columns.iter().map(|c| c.width).sum::<usize>();
    let head = 32 + 32 * columns.len() + 1;
    let too_many = || {
        let value = length.max(head) as u64;
        let what = "length of rows or of the head of a .dbf";
        Error::Limit { place: Place::Whole, what, value, limit: u64::from(u16::MAX) }
    };
    let [head, length] = [head, length].map(u16::try_from);
    let (head, length) = (head.map_err(|_| too_many())?, length.map_err(|_| too_many())?);
    let mut out = vec![3, DAY[0], DAY[1], DAY[2]];
    out.extend(u32::try_from(rows.len()).unwrap_or(u32::MAX).to_le_bytes());
    out.extend(head.to_le_bytes().iter().chain(&length.to_le_bytes()));
    out.resize(32, 0);
    for column in &columns {
        let start = out.len();
        out.extend(column.key.as_bytes());
        out.resize(start + 11, 0);
        out.push(column.kind);
        out.extend([0; 4]);
        out.extend([column.width as u8, column.decimals as u8]);
        out.resize(start + 32, 0);
    }
    out.push(0x0d);
    for row in &rows {
        out.push(b' ');
        for (column, value) in columns.iter().zip(row) {
            let value = whole_letters(value.get(..column.width).unwrap_or(value));
            let blanks = vec![b' '; column.width - value.len()];
            let numeric = column.kind == b'N';
            let (first, second) = if numeric { (&blanks[..], value) } else { (value, &blanks[..]) };
            out.extend(first.iter().chain(second));
        }
    }
    out.push(0x1a);
    Ok(out)
}

/// Returns columns with names that are short enough and differ.
fn named<'a>(fields: &[Option<&'a Field>], warnings: &mut Vec<Warning>) -> Vec<Column<'a>> {
    let mut taken = BTreeSet::new();
    let mut cut = Vec::new();
    let mut columns = Vec::new();
    for &field in fields {
        let key = field.map_or("FID", |field| &field.key);
        let fits = |text: &str, room: usize| {
            let bytes = text.as_bytes();
            let bytes = whole_letters(bytes.get(..room).unwrap_or(bytes));
            String::from_utf8_lossy(bytes).into_owned()
        };
        let mut short = fits(key, MAX_KEY);
        for number in 1.. {
            if taken.insert(short.to_lowercase()) {
                break;
            }
            let end = format!("_{number}");
            short = fits(key, MAX_KEY - end.len()) + &end;
        }
        if short != key {
            cut.push(format!("{key} is {short}"));
        }
        let kind = match field.map(|f| f.kind) {
            Some(FieldKind::Boolean) => b'L',
            Some(FieldKind::Integer | FieldKind::Number) => b'N',
            Some(FieldKind::Date) => b'D',
            None => b'N',
            _ => b'C',
        };
        columns.push(Column { key: short, field, kind, width: 1, decimals: 0 });
    }
    if !cut.is_empty() {
        let (count, first) =
            (cut.len(), cut.iter().take(5).cloned().collect::<Vec<_>>().join(", "));
        let more = if count > 5 { ", …" } else { "" };
        let message = format!("{count} names of fields are cut to ten bytes: {first}{more}");
        warnings.push(Warning { place: Place::Whole, message });
    }
    columns
}

/// Returns the values of a feature, as they are in a row.
fn values(feature: &Feature, index: u64, columns: &[Column<'_>], schema: &Schema) -> Vec<Vec<u8>> {
    let mut given = vec![None; schema.columns().len()];
    for member in members(feature.properties.as_deref().unwrap_or_default()) {
        let place = schema.find(&member.key()).and_then(|i| given.get_mut(i));
        place.into_iter().for_each(|value| *value = Some(member.value.clone()));
    }
    let value = |column: &Column<'_>| {
        let json = match column.field {
            Some(field) => schema.find(&field.key).and_then(|i| given.get(i)).cloned().flatten(),
            None => Some(index.to_string()),
        };
        let json = json.filter(|json| json != "null");
        match (column.kind, json) {
            (b'L', json) => match json.as_deref() {
                Some("true") => b"T".to_vec(),
                Some(_) => b"F".to_vec(),
                None => b"?".to_vec(),
            },
            (_, None) => Vec::new(),
            (b'N', Some(json)) => json.into_bytes(),
            (b'D', Some(json)) => json.bytes().filter(u8::is_ascii_digit).collect(),
            (_, Some(json)) => {
                let text: Option<String> = serde_json::from_str(&json).ok();
                text.unwrap_or(json).into_bytes()
            }
        }
    };
    columns.iter().map(value).collect()
}

/// Sets how wide columns are, by their values.
fn fit(columns: &mut [Column<'_>], rows: &[Vec<Vec<u8>>], warnings: &mut Vec<Warning>) {
    let mut long = 0;
    for (i, column) in columns.iter_mut().enumerate() {
        let all = || rows.iter().filter_map(|row| row.get(i));
        let width = all().map(Vec::len).max().unwrap_or(0);
        long += all().filter(|value| value.len() > MAX_TEXT).count();
        let decimals = |value: &Vec<u8>| {
            let point = value.iter().position(|&b| b == b'.')?;
            Some(value.iter().skip(point + 1).take_while(|b| b.is_ascii_digit()).count())
        };
        if column.field.is_some_and(|f| f.kind == FieldKind::Number) {
            // Readers take a column without decimals for whole numbers.
            column.decimals = all().filter_map(decimals).max().unwrap_or(0).clamp(1, 30);
        }
        let least = if column.decimals > 0 { column.decimals + 2 } else { 1 };
        column.width = if column.kind == b'D' { 8 } else { width.clamp(least, MAX_TEXT) };
    }
    if long > 0 {
        let message =
            format!("{long} texts are longer than the {MAX_TEXT} bytes that a .dbf holds; cut");
        warnings.push(Warning { place: Place::Whole, message });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::members::quoted;

    #[test]
    fn long_names_stay_apart() {
        let properties = Some(format!(
            "{{{}:1,{}:2,{}:3}}",
            quoted("population_2000"),
            quoted("population_2010"),
            quoted("ÄÄÄÄÄÄ")
        ));
        let schema = Schema::of(&[Feature { properties, ..Feature::default() }]);
        let fields: Vec<_> = schema.columns().iter().map(Some).collect();
        let mut warnings = Vec::new();
        let keys: Vec<String> = named(&fields, &mut warnings).into_iter().map(|c| c.key).collect();
        assert_eq!(keys, ["population", "populati_1", "ÄÄÄÄÄ"]);
        assert!(warnings[0].message.contains("population_2010 is populati_1"));
    }
}
