//! Reports in Parquet.

use super::{COLUMNS, Entry, cells};
use crate::failure::Failure;
use crate::output::{self, Target};
use ::parquet::column::writer::ColumnWriter;
use ::parquet::data_type::ByteArray;
use ::parquet::errors::ParquetError;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::parser::parse_message_type;
use std::sync::Arc;

/// Writes a table of one row group.
pub fn write<'a>(target: &Target, entries: impl Iterator<Item = &'a Entry>) -> Result<(), Failure> {
    let entries: Vec<&Entry> = entries.collect();
    let failed = |e: ParquetError| Failure::Data(format!("--output {target}: {e}"));
    let content = table(&entries).map_err(failed)?;
    output::deliver_bytes(target, &content).map(drop)
}

fn table(entries: &[&Entry]) -> Result<Vec<u8>, ParquetError> {
    let column = |name: &&str| match *name {
        "bytes" => format!("OPTIONAL INT64 {name};"),
        "seconds" => format!("REQUIRED DOUBLE {name};"),
        _ => format!("REQUIRED BYTE_ARRAY {name} (UTF8);"),
    };
    let columns: Vec<String> = COLUMNS.iter().map(column).collect();
    let schema = parse_message_type(&format!("message report {{ {} }}", columns.join(" ")))?;
    let texts: Vec<_> = entries.iter().map(|entry| cells(entry)).collect();
    let mut content = Vec::new();
    let properties = Arc::new(WriterProperties::builder().build());
    let mut writer = SerializedFileWriter::new(&mut content, Arc::new(schema), properties)?;
    let mut group = writer.next_row_group()?;
    let mut number = 0;
    while let Some(mut column) = group.next_column()? {
        match column.untyped() {
            ColumnWriter::Int64ColumnWriter(to) => {
                let sizes = || entries.iter().map(|entry| entry.bytes);
                let values: Vec<i64> =
                    sizes().flatten().map(|b| i64::try_from(b).unwrap_or(i64::MAX)).collect();
                let levels: Vec<i16> = sizes().map(|size| i16::from(size.is_some())).collect();
                to.write_batch(&values, Some(&levels), None)?;
            }
            ColumnWriter::DoubleColumnWriter(to) => {
                let values: Vec<f64> = entries.iter().map(|entry| entry.seconds).collect();
                to.write_batch(&values, None, None)?;
            }
            ColumnWriter::ByteArrayColumnWriter(to) => {
                let values: Vec<ByteArray> =
                    texts.iter().map(|cells| cells[number].as_str().into()).collect();
                to.write_batch(&values, None, None)?;
            }
            _ => return Err(ParquetError::General("a column has another type".to_owned())),
        }
        column.close()?;
        number += 1;
    }
    group.close()?;
    writer.close()?;
    Ok(content)
}
