//! Manifests in Parquet.

use super::Record;
use crate::failure::{Failure, in_words};
use crate::panics;
use ::parquet::file::reader::FileReader;
use ::parquet::file::serialized_reader::SerializedFileReader;
use ::parquet::record::{Field, Row};
use bytes::Bytes;
use serde_json::Value;
use std::io::Read;

/// Reads a table row by row.
pub fn read(
    name: &str,
    mut source: impl Read,
    each: &mut dyn FnMut(Record) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let fail = |what: String| Failure::Data(format!("{name}: {what}"));
    let mut content = Vec::new();
    source.read_to_end(&mut content).map_err(|e| fail(in_words(&e)))?;
    // A broken file makes the library panic at some places.
    let all = panics::caught(|| {
        let reader = SerializedFileReader::new(Bytes::from(content))?;
        reader.get_row_iter(None)?.collect::<Result<Vec<Row>, _>>()
    });
    let all = all.unwrap_or_else(|what| Err(::parquet::errors::ParquetError::General(what)));
    let all = all.map_err(|e| fail(format!("it is not valid Parquet: {e}")))?;
    for (number, row) in (1..).zip(all) {
        let place = format!("row {number}");
        let value = |field: &Field| {
            value(field).ok_or_else(|| {
                fail(format!("{place}: a column has texts, numbers or truth values"))
            })
        };
        let cells =
            row.get_column_iter().map(|(column, field)| Ok((column.clone(), value(field)?)));
        let cells = cells.collect::<Result<_, _>>()?;
        each(Record { place, cells })?;
    }
    Ok(())
}

/// Returns a value as JSON has it; `None` for types that no option takes.
fn value(field: &Field) -> Option<Value> {
    Some(match field {
        Field::Null => Value::Null,
        Field::Bool(value) => (*value).into(),
        Field::Byte(value) => (*value).into(),
        Field::Short(value) => (*value).into(),
        Field::Int(value) => (*value).into(),
        Field::Long(value) => (*value).into(),
        Field::UByte(value) => (*value).into(),
        Field::UShort(value) => (*value).into(),
        Field::UInt(value) => (*value).into(),
        Field::ULong(value) => (*value).into(),
        // As written, not as the number of double precision nearby.
        Field::Float(value) => Value::String(value.to_string()),
        Field::Double(value) => (*value).into(),
        Field::Str(text) => text.as_str().into(),
        Field::Bytes(bytes) => bytes.as_utf8().ok()?.into(),
        Field::ListInternal(list) => {
            list.elements().iter().map(value).collect::<Option<Vec<_>>>()?.into()
        }
        _ => return None,
    })
}
