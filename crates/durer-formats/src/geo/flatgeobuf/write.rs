//! Features as a file.

use super::build::{Builder, Later, Value};
use super::{MAGIC, column, index};
use crate::geo::members::members;
use crate::geo::schema::{FieldKind, Schema};
use crate::geo::{Feature, Geometry, Points, System, wkb};
use durer::math::Rect;
use std::io::{self, Write};

/// Writes features along Hilbert's curve, with an index of their places. All are held as they are written.
pub fn write(out: &mut impl Write, features: &[Feature], system: &System) -> io::Result<()> {
    let schema = Schema::of(features);
    let bounds: Vec<Option<Rect>> =
        features.iter().map(|f| f.geometry.as_ref()?.bounds()).collect();
    let kind = common_kind(features);
    let (order, mut bytes, mut places) = (index::order(&bounds), Vec::new(), Vec::new());
    for &i in &order {
        places.push((bounds.get(i).copied().flatten(), bytes.len() as u64));
        let feature = features.get(i).map(|feature| self::feature(feature, &schema, kind));
        bytes.extend(feature.unwrap_or_default());
    }
    out.write_all(&MAGIC)?;
    out.write_all(&[1])?;
    out.write_all(&header(features, &schema, kind, system))?;
    out.write_all(&index::build(places.into_iter()))?;
    out.write_all(&bytes)
}

/// Returns the number of the kind that all geometries are; 0 where they differ.
fn common_kind(features: &[Feature]) -> u8 {
    let mut kinds = features.iter().filter_map(|f| f.geometry.as_ref()).map(wkb::kind);
    let first = kinds.next();
    first.filter(|first| kinds.all(|kind| kind == *first)).unwrap_or(0) as u8
}

fn has(features: &[Feature], is_so: fn(&Points) -> bool) -> bool {
    let mut found = false;
    for geometry in features.iter().filter_map(|f| f.geometry.as_ref()) {
        geometry.for_each(&mut |points| found |= is_so(points));
    }
    found
}

fn header(features: &[Feature], schema: &Schema, kind: u8, system: &System) -> Vec<u8> {
    let bounds = features.iter().filter_map(|f| f.geometry.as_ref()?.bounds());
    let bounds = Rect::around(bounds.flat_map(|b| [b.min(), b.max()]));
    let (has_z, has_m) =
        (has(features, |p| p.dimensions.has_z()), has(features, |p| p.dimensions.has_m()));
    let (mut buffer, root) = Builder::new();
    let mut fields = vec![(0, Value::Later)];
    fields.extend(bounds.map(|_| (1, Value::Later)));
    fields.extend([
        (2, Value::U8(kind)),
        (3, Value::U8(has_z.into())),
        (4, Value::U8(has_m.into())),
    ]);
    let width = if features.is_empty() { 0 } else { index::WIDTH };
    fields.extend([(7, Value::Later), (8, Value::U64(features.len() as u64))]);
    fields.push((9, Value::U16(width)));
    fields.extend((!system.is_unknown()).then_some((10, Value::Later)));
    let mut open = buffer.table(root, &fields).into_iter();
    let mut next = || open.next();
    if let Some(name) = next() {
        buffer.text(name, "layer");
    }
    if let (Some(bounds), Some(envelope)) = (bounds, bounds.and_then(|_| next())) {
        let (low, high) = (bounds.min(), bounds.max());
        buffer.doubles(envelope, [low.x, low.y, high.x, high.y].into_iter());
    }
    if let Some(columns) = next() {
        let places = buffer.tables(columns, schema.columns().len());
        for (place, field) in places.into_iter().zip(schema.columns()) {
            let kind = column_kind(field.kind);
            let open = buffer.table(place, &[(0, Value::Later), (1, Value::U8(kind))]);
            open.into_iter().for_each(|name| buffer.text(name, &field.key));
        }
    }
    if let Some(place) = next() {
        put_system(&mut buffer, place, system);
    }
    buffer.finish()
}

fn put_system(buffer: &mut Builder, place: Later, system: &System) {
    let mut fields = Vec::new();
    if let Some(code) = system.code {
        fields.extend([(0, Value::Later), (1, Value::I32(code))]);
    }
    fields.extend(system.wkt.as_ref().map(|_| (4, Value::Later)));
    let open = buffer.table(place, &fields);
    let name = system.code.map(|code| if code >= 50_000 { "ESRI" } else { "EPSG" });
    let texts = name.into_iter().chain(system.wkt.as_deref());
    open.into_iter().zip(texts).for_each(|(place, text)| buffer.text(place, text));
}

fn column_kind(kind: FieldKind) -> u8 {
    match kind {
        FieldKind::Boolean => column::BOOL,
        FieldKind::Integer => column::LONG,
        FieldKind::Number => column::DOUBLE,
        FieldKind::Json => column::JSON,
        FieldKind::Null | FieldKind::Date | FieldKind::Text => column::STRING,
    }
}

fn feature(feature: &Feature, schema: &Schema, kind: u8) -> Vec<u8> {
    let properties = properties(feature, schema);
    let (mut buffer, root) = Builder::new();
    let mut fields = Vec::new();
    fields.extend(feature.geometry.as_ref().map(|_| (0, Value::Later)));
    fields.push((1, Value::Later));
    let mut open = buffer.table(root, &fields).into_iter();
    if let Some((geometry, place)) = feature.geometry.as_ref().and_then(|g| Some((g, open.next()?)))
    {
        put_geometry(&mut buffer, place, geometry, kind == 0);
    }
    if let Some(place) = open.next() {
        buffer.bytes(place, &properties);
    }
    buffer.finish()
}

/// Returns the values of a feature's fields, each after the number of its column; null ones are not
/// there.
fn properties(feature: &Feature, schema: &Schema) -> Vec<u8> {
    let mut out = Vec::new();
    for member in members(feature.properties.as_deref().unwrap_or_default()) {
        let Some(index) = schema.find(&member.key()) else { continue };
        let (Ok(number), Some(field)) = (u16::try_from(index), schema.columns().get(index)) else {
            continue;
        };
        if FieldKind::of(&member.value) == FieldKind::Null {
            continue;
        }
        out.extend(number.to_le_bytes());
        match column_kind(field.kind) {
            column::BOOL => out.push(u8::from(member.value == "true")),
            column::LONG => out.extend(member.value.parse::<i64>().unwrap_or(0).to_le_bytes()),
            column::DOUBLE => out.extend(member.value.parse::<f64>().unwrap_or(0.0).to_le_bytes()),
            _ => {
                let text = member.text().unwrap_or(member.value);
                out.extend(u32::try_from(text.len()).unwrap_or(u32::MAX).to_le_bytes());
                out.extend(text.as_bytes());
            }
        }
    }
    out
}

/// Writes a geometry, with its kind where the header does not say it.
fn put_geometry(buffer: &mut Builder, place: Later, geometry: &Geometry, with_kind: bool) {
    let kind = with_kind.then(|| (6, Value::U8(wkb::kind(geometry) as u8)));
    match geometry {
        Geometry::Point(points) | Geometry::LineString(points) | Geometry::MultiPoint(points) => {
            put_runs(buffer, place, &[points], false, kind);
        }
        Geometry::MultiLineString(lines) => {
            put_runs(buffer, place, &lines.iter().collect::<Vec<_>>(), false, kind);
        }
        Geometry::Polygon(rings) => {
            put_runs(buffer, place, &rings.iter().collect::<Vec<_>>(), true, kind)
        }
        Geometry::MultiPolygon(polygons) => {
            let fields: Vec<_> = kind.into_iter().chain([(7, Value::Later)]).collect();
            for place in buffer.table(place, &fields) {
                let places = buffer.tables(place, polygons.len());
                for (place, rings) in places.into_iter().zip(polygons) {
                    let kind = Some((6, Value::U8(3)));
                    put_runs(buffer, place, &rings.iter().collect::<Vec<_>>(), true, kind);
                }
            }
        }
        Geometry::Collection(parts) => {
            let fields: Vec<_> = kind.into_iter().chain([(7, Value::Later)]).collect();
            for place in buffer.table(place, &fields) {
                let places = buffer.tables(place, parts.len());
                for (place, part) in places.into_iter().zip(parts) {
                    put_geometry(buffer, place, part, true);
                }
            }
        }
    }
}

/// Writes lines or rings, side by side, with a list of where each ends.
fn put_runs(
    buffer: &mut Builder,
    place: Later,
    runs: &[&Points],
    closed: bool,
    kind: Option<(usize, Value)>,
) {
    let again = |run: &Points| (closed && !run.is_empty()).then_some(0);
    let order = |run: &Points| (0..run.len()).chain(again(run)).collect::<Vec<usize>>();
    let all: Vec<(&Points, usize)> =
        runs.iter().flat_map(|run| order(run).into_iter().map(move |i| (*run, i))).collect();
    let [z, m] = [0, 1].map(|i| {
        let there =
            |run: &&Points| if i == 0 { run.dimensions.has_z() } else { run.dimensions.has_m() };
        runs.iter()
            .any(there)
            .then(|| all.iter().map(|(run, j)| run.zm(*j)[i]).collect::<Vec<f64>>())
    });
    let mut end = 0;
    let ends: Vec<u32> = runs
        .iter()
        .map(|run| {
            end += order(run).len();
            u32::try_from(end).unwrap_or(u32::MAX)
        })
        .collect();
    let several = runs.len() > 1;
    let mut fields = Vec::new();
    fields.extend(several.then_some((0, Value::Later)));
    fields.push((1, Value::Later));
    fields.extend(z.as_ref().map(|_| (2, Value::Later)));
    fields.extend(m.as_ref().map(|_| (3, Value::Later)));
    fields.extend(kind);
    let mut open = buffer.table(place, &fields).into_iter();
    if let Some(place) = several.then(|| open.next()).flatten() {
        buffer.words(place, &ends);
    }
    if let Some(place) = open.next() {
        let numbers: Vec<f64> = all.iter().flat_map(|(run, i)| run.xy[*i].to_array()).collect();
        buffer.doubles(place, numbers.into_iter());
    }
    for (list, place) in [z, m].into_iter().flatten().zip(open) {
        buffer.doubles(place, list.into_iter());
    }
}
