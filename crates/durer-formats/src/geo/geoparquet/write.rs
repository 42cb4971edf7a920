//! Features as a file.

use super::{days, projjson};
use crate::geo::members::members;
use crate::geo::members::with_id;
use crate::geo::schema::{FieldKind, Schema};
use crate::geo::{Feature, Geometry, System, wkb};
use crate::{Error, Result};
use durer::math::Rect;
use parquet::basic::{Compression, ConvertedType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::Write;
use std::sync::Arc;

/// Features of a row group.
const GROUP: usize = 1 << 16;

/// Writes features in their order, the geometry as the first column.
///
/// # Errors
/// [`Error::Io`].
pub fn write(out: &mut impl Write, features: &[Feature], system: &System) -> Result<()> {
    let features: Vec<Feature> = features.iter().map(with_id).collect();
    let columns = columns(&features);
    let geometry = free("geometry", &columns);
    let about = json!({
        "version": "1.1.0", "primary_column": geometry,
        "columns": { geometry.clone(): column(&features, system) },
    });
    let pair = KeyValue::new("geo".to_owned(), about.to_string());
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by("durer".to_owned())
        .set_key_value_metadata(Some(vec![pair]))
        .build();
    let schema = schema(&geometry, &columns).map_err(failed)?;
    let mut bytes = Vec::new();
    let mut writer =
        SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties)).map_err(failed)?;
    for group in features.chunks(GROUP) {
        write_group(&mut writer, group, &columns).map_err(failed)?;
    }
    writer.close().map_err(failed)?;
    Ok(out.write_all(&bytes)?)
}

fn failed(_: ParquetError) -> Error {
    // Writing to memory cannot fail, so the fault is in the table itself.
    Error::Io(std::io::Error::other(
        "the features cannot be put into a table of Parquet; write another format",
    ))
}

/// A field with the kind that it is stored as.
type Column = (String, FieldKind);

/// Returns all fields; texts that only look like days are texts.
fn columns(features: &[Feature]) -> Vec<Column> {
    let schema = Schema::of(features);
    let mut columns: Vec<Column> =
        schema.columns().iter().map(|field| (field.key.clone(), field.kind)).collect();
    for feature in features {
        for member in feature.fields() {
            let own = schema.find(&member.key()).and_then(|place| columns.get_mut(place));
            if let (Some((_, kind @ FieldKind::Date)), Some(text)) = (own, member.text())
                && days::of_text(&text).is_none()
            {
                *kind = FieldKind::Text;
            }
        }
    }
    columns
}

/// Returns a name that no field has.
fn free(name: &str, columns: &[Column]) -> String {
    let mut names = std::iter::once(name.to_owned()).chain((1..).map(|i| format!("{name}_{i}")));
    names.find(|name| !columns.iter().any(|(key, _)| key == name)).unwrap_or_default()
}

/// Returns the metadata of the geometries.
fn column(features: &[Feature], system: &System) -> Value {
    let geometries = || features.iter().filter_map(|f| f.geometry.as_ref());
    let kinds: BTreeSet<String> = geometries().map(kind).collect();
    let mut column = json!({ "encoding": "WKB", "geometry_types": kinds });
    let bounds = geometries().filter_map(Geometry::bounds);
    if let Some(all) = Rect::around(bounds.flat_map(|b| [b.min(), b.max()])) {
        column["bbox"] = json!([all.min().x, all.min().y, all.max().x, all.max().y]);
    }
    // Without a system, coordinates are longitude and latitude.
    if system.code != Some(4326) {
        column["crs"] = projjson::of_system(system).unwrap_or(Value::Null);
    }
    column
}

fn kind(geometry: &Geometry) -> String {
    let height = if geometry.dimensions().has_z() { " Z" } else { "" };
    format!("{}{height}", geometry.name())
}

fn schema(geometry: &str, columns: &[Column]) -> Result<TypePtr, ParquetError> {
    let field = |name: &str, physical, converted| {
        let builder = Type::primitive_type_builder(name, physical);
        let builder = builder.with_repetition(Repetition::OPTIONAL);
        builder.with_converted_type(converted).build().map(Arc::new)
    };
    let mut fields = vec![field(geometry, Physical::BYTE_ARRAY, ConvertedType::NONE)?];
    for (name, kind) in columns {
        fields.push(match kind {
            FieldKind::Boolean => field(name, Physical::BOOLEAN, ConvertedType::NONE),
            FieldKind::Integer => field(name, Physical::INT64, ConvertedType::NONE),
            FieldKind::Number => field(name, Physical::DOUBLE, ConvertedType::NONE),
            FieldKind::Date => field(name, Physical::INT32, ConvertedType::DATE),
            FieldKind::Json => field(name, Physical::BYTE_ARRAY, ConvertedType::JSON),
            FieldKind::Null | FieldKind::Text => {
                field(name, Physical::BYTE_ARRAY, ConvertedType::UTF8)
            }
        }?);
    }
    Type::group_type_builder("schema").with_fields(fields).build().map(Arc::new)
}

fn write_group(
    writer: &mut SerializedFileWriter<&mut Vec<u8>>,
    features: &[Feature],
    columns: &[Column],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    let mut rows: Vec<Vec<Option<String>>> = vec![vec![None; features.len()]; columns.len()];
    for (i, feature) in features.iter().enumerate() {
        for member in members(feature.properties.as_deref().unwrap_or_default()) {
            let key = member.key();
            let place = columns.iter().position(|(own, _)| *own == key);
            let cell = place.and_then(|place| rows.get_mut(place)?.get_mut(i));
            let is_null = FieldKind::of(&member.value) == FieldKind::Null;
            if let Some(cell) = cell.filter(|_| !is_null) {
                *cell = Some(member.value);
            }
        }
    }
    let shape = |feature: &Feature| {
        let mut bytes = Vec::new();
        let plain = Feature::of_geometry(feature.geometry.clone()?);
        wkb::write_feature(&mut bytes, &plain).ok()?;
        Some(ByteArray::from(bytes))
    };
    let shapes: Vec<Option<ByteArray>> = features.iter().map(shape).collect();
    let mut cells = rows.into_iter().zip(columns);
    let mut shapes = Some(shapes);
    while let Some(mut column) = group.next_column()? {
        match (shapes.take(), column.untyped()) {
            (Some(list), ColumnWriter::ByteArrayColumnWriter(to)) => {
                put(list, |v, d| to.write_batch(v, d, None))?
            }
            (_, to) => put_cells(to, cells.next())?,
        }
        column.close()?;
    }
    group.close()?;
    Ok(())
}

fn put_cells(
    to: &mut ColumnWriter<'_>,
    cells: Option<(Vec<Option<String>>, &Column)>,
) -> Result<(), ParquetError> {
    let Some((cells, (_, kind))) = cells else { return Ok(()) };
    let text = |value: &str| -> Option<String> {
        let is_text = value.starts_with('"') && *kind != FieldKind::Json;
        if is_text { serde_json::from_str(value).ok() } else { Some(value.to_owned()) }
    };
    let each = |value: Option<String>| value.as_deref().and_then(text);
    let cells = cells.into_iter().map(each);
    match to {
        ColumnWriter::BoolColumnWriter(to) => {
            put(cells.map(|c| Some(c? == "true")).collect(), |v, d| to.write_batch(v, d, None))
        }
        ColumnWriter::Int32ColumnWriter(to) => {
            put(cells.map(|c| days::of_text(&c?)).collect(), |v, d| to.write_batch(v, d, None))
        }
        ColumnWriter::Int64ColumnWriter(to) => {
            put(cells.map(|c| c?.parse().ok()).collect(), |v, d| to.write_batch(v, d, None))
        }
        ColumnWriter::DoubleColumnWriter(to) => {
            put(cells.map(|c| c?.parse().ok()).collect(), |v, d| to.write_batch(v, d, None))
        }
        ColumnWriter::ByteArrayColumnWriter(to) => {
            let bytes = |c: Option<String>| Some(ByteArray::from(c?.into_bytes()));
            put(cells.map(bytes).collect(), |v, d| to.write_batch(v, d, None))
        }
        _ => Ok(()),
    }
}

/// Writes values that are there, and which are.
fn put<T>(
    cells: Vec<Option<T>>,
    write: impl FnOnce(&[T], Option<&[i16]>) -> Result<usize, ParquetError>,
) -> Result<(), ParquetError> {
    let levels: Vec<i16> = cells.iter().map(|cell| cell.is_some().into()).collect();
    let values: Vec<T> = cells.into_iter().flatten().collect();
    write(&values, Some(&levels)).map(drop)
}
