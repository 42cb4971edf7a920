//! Reading manifests: CSV, JSON Lines and Parquet, distinguished by their content.

#[cfg(feature = "geoparquet")]
mod parquet;

use crate::failure::{Failure, in_words};
use crate::input::display_name;
use crate::places::is_stream;
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// A row as the manifest has it.
#[derive(Debug)]
pub struct Record {
    /// Its place, e.g. `line 3`.
    pub place: String,
    /// Columns and values, without empty ones.
    pub cells: Map<String, Value>,
}

/// Mark at the begin of a text that says that it is UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// Bytes that Parquet files begin with.
const PARQUET: &[u8] = b"PAR1";

/// Reads a manifest row by row.
///
/// # Errors
/// The file cannot be read or is not a table, or an error of `each`.
pub fn read(
    path: &Path,
    mut each: impl FnMut(Record) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let name = display_name(path);
    let fail = |e: &io::Error| Failure::Data(format!("{name}: {}", in_words(e)));
    let source: Box<dyn Read> = match is_stream(path) {
        true => Box::new(io::stdin()),
        false => Box::new(File::open(path).map_err(|e| fail(&e))?),
    };
    let mut source = BufReader::with_capacity(1 << 16, source);
    let begin = source.fill_buf().map_err(|e| fail(&e))?;
    if begin.starts_with(PARQUET) {
        return read_parquet(&name, source, &mut each);
    }
    if begin.starts_with(BYTE_ORDER_MARK) {
        source.consume(BYTE_ORDER_MARK.len());
    }
    let begin = source.fill_buf().map_err(|e| fail(&e))?;
    match begin.iter().find(|byte| !byte.is_ascii_whitespace()) {
        Some(b'{') => read_lines(&name, source, &mut each),
        Some(b'[') => Err(Failure::Data(format!(
            "{name}: it is an array of JSON; write each of its objects on a line of its own (jq -c '.[]')"
        ))),
        _ => read_csv(&name, source, &mut each),
    }
}

/// Reads an object per line.
fn read_lines(
    name: &str,
    source: impl BufRead,
    each: &mut dyn FnMut(Record) -> Result<(), Failure>,
) -> Result<(), Failure> {
    for (number, line) in (1..).zip(source.lines()) {
        let place = format!("line {number}");
        let fail = |what: &str| Failure::Data(format!("{name}: {place}: {what}"));
        let line = line.map_err(|e| fail(&in_words(&e)))?;
        if line.trim().is_empty() {
            continue;
        }
        let value = serde_json::from_str(&line).map_err(|e| {
            let (text, column) = (e.to_string(), e.column());
            let what = text.split(" at line ").next().unwrap_or_default();
            fail(&format!("column {column}: {what}"))
        })?;
        let Value::Object(cells) = value else {
            return Err(fail("it is not an object; a row is written {\"id\": …, \"input\": …}"));
        };
        each(Record { place, cells })?;
    }
    Ok(())
}

/// Reads a table with a header.
fn read_csv(
    name: &str,
    mut source: impl BufRead,
    each: &mut dyn FnMut(Record) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let fail = |place: Option<u64>, what: String| {
        let place = place.map_or_else(String::new, |line| format!("line {line}: "));
        Failure::Data(format!("{name}: {place}{what}"))
    };
    let wrong = |e: csv::Error| {
        let line = e.position().map(csv::Position::line);
        match e.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                fail(line, format!("it has {len} cells; the header has {expected_len}"))
            }
            csv::ErrorKind::Utf8 { .. } => fail(line, "the text is not UTF-8".to_owned()),
            csv::ErrorKind::Io(e) => fail(line, in_words(e)),
            _ => fail(line, e.to_string()),
        }
    };
    let delimiter = delimiter(source.fill_buf().map_err(|e| fail(None, in_words(&e)))?);
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.delimiter(delimiter).trim(csv::Trim::All).from_reader(source);
    let header = reader.headers().map_err(wrong)?.clone();
    check_columns(&header.iter().collect::<Vec<_>>())
        .map_err(|what| fail(Some(1), format!("{what}; the first line names the columns")))?;
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row).map_err(wrong)? {
        let line = row.position().map_or(0, csv::Position::line);
        let filled = header.iter().zip(&row).filter(|(_, cell)| !cell.is_empty());
        let cells = filled.map(|(column, cell)| (column.to_owned(), cell.into())).collect();
        each(Record { place: format!("line {line}"), cells })?;
    }
    Ok(())
}

/// Returns the separator of a table, the most frequent one in its first line.
fn delimiter(begin: &[u8]) -> u8 {
    let line = begin.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let count = |delimiter: &u8| line.iter().filter(|byte| *byte == delimiter).count();
    // Of several equally frequent ones, the comma.
    [b'\t', b';', b','].into_iter().max_by_key(count).unwrap_or(b',')
}

/// Checks that the columns of a table have different names, and that one of them is the id; a table without columns has no rows.
fn check_columns(names: &[&str]) -> Result<(), String> {
    let mut known = HashSet::new();
    if let Some(twice) = names.iter().find(|name| !known.insert(**name)) {
        return Err(format!("column `{twice}` appears twice"));
    }
    if !names.is_empty() && !known.contains("id") {
        return Err(format!("there is no column `id` among {}", names.join(", ")));
    }
    Ok(())
}

#[cfg(feature = "geoparquet")]
use self::parquet::read as read_parquet;

#[cfg(not(feature = "geoparquet"))]
fn read_parquet(
    name: &str,
    _: impl Read,
    _: &mut dyn FnMut(Record) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let what = "it is Parquet, which durer reads if it is built with --features geoparquet; write it as CSV or JSON Lines";
    Err(Failure::Data(format!("{name}: {what}")))
}
