//! Manifests in Parquet.

use super::{Record, check_columns};
use crate::failure::{Failure, in_words};
use crate::panics;
use ::parquet::errors::ParquetError;
use ::parquet::file::reader::FileReader;
use ::parquet::file::serialized_reader::SerializedFileReader;
use ::parquet::record::Field;
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
    let broken = |e: ParquetError| fail(format!("it is not valid Parquet: {e}"));
    let mut content = Vec::new();
    source.read_to_end(&mut content).map_err(|e| fail(in_words(&e)))?;
    let reader = caught(|| SerializedFileReader::new(Bytes::from(content))).map_err(broken)?;
    let columns = reader.metadata().file_metadata().schema().get_fields();
    let columns: Vec<&str> = columns.iter().map(|column| column.name()).collect();
    check_columns(&columns).map_err(fail)?;
    let mut rows = caught(|| reader.get_row_iter(None)).map_err(broken)?;
    for number in 1_u64.. {
        let Some(row) = caught(|| rows.next().transpose()).map_err(broken)? else { break };
        let place = format!("row {number}");
        let cell = |(column, field): (&String, &Field)| {
            let value = value(field).ok_or_else(|| {
                let what = "it has texts, numbers, truth values, or lists of them";
                fail(format!("{place}: column `{column}`: {what}"))
            })?;
            Ok((column.clone(), value))
        };
        let cells = row.get_column_iter().map(cell).collect::<Result<_, Failure>>()?;
        each(Record { place, cells })?;
    }
    Ok(())
}

/// Runs a part of the library, which panics on some broken files; that is an error like others.
fn caught<T>(work: impl FnOnce() -> Result<T, ParquetError>) -> Result<T, ParquetError> {
    panics::caught(work).unwrap_or_else(|what| Err(ParquetError::General(what)))
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
        Field::Float(value) => real(value.is_nan(), value),
        Field::Double(value) => real(value.is_nan(), value),
        Field::Str(text) => text.as_str().into(),
        Field::Bytes(bytes) => bytes.as_utf8().ok()?.into(),
        Field::ListInternal(list) => {
            list.elements().iter().map(value).collect::<Option<Vec<_>>>()?.into()
        }
        _ => return None,
    })
}

/// Returns a number by its shortest decimal, a whole one without a point: tables that have no integers with gaps have `256.0` for
/// a size, and a number that is none for a gap.
fn real(is_missing: bool, number: &impl ToString) -> Value {
    if is_missing { Value::Null } else { number.to_string().into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_on_the_command_line() {
        let text = |field: Field| value(&field).unwrap();
        assert_eq!(text(Field::Double(256.0)), "256");
        assert_eq!(text(Field::Double(-0.25)), "-0.25");
        assert_eq!(text(Field::Float(0.1)), "0.1");
        assert_eq!(text(Field::Float(f32::NAN)), Value::Null);
        assert_eq!(text(Field::Double(f64::NAN)), Value::Null);
        assert_eq!(text(Field::Double(f64::INFINITY)), "inf");
        assert_eq!(text(Field::ULong(u64::MAX)), u64::MAX);
        assert_eq!(value(&Field::Date(1)), None);
    }
}
