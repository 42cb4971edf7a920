//! JSON: `[[row], [row], …]`, or an object with `width`, `height` and `values`, or with such rows as
//! its `values`, `heights`, `elevation` or `data`; null is a missing height.

use super::{Grid, HeightMapOptions, check_size};
use crate::wording::counted;
use crate::{Error, Limits, Place, Result, foreign};
use serde_json::Value;

/// Members of an object that may hold the heights.
const MEMBERS: [&str; 5] = ["values", "heights", "elevation", "data", "z"];
/// Memory that a value takes while it is read, against one byte of text (a digit) and one for the comma.
const BYTES_PER_BYTE: u64 = 16;

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    let memory = (bytes.len() as u64).saturating_mul(BYTES_PER_BYTE);
    let limit = options.limits.decoded_bytes;
    if memory > limit {
        let what = "memory for JSON";
        return Err(Error::Limit { place: Place::Whole, what, value: memory, limit });
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let value: Value = serde_json::from_slice(text)
        .map_err(|e| Error::line(e.line() as u64, e.column() as u64, foreign::json(&e)))?;
    let (name, values) = heights(&value, options)?;
    let rows = array(values, name)?;
    let (columns, rows, heights) = if rows.first().is_some_and(Value::is_array) {
        nested(rows, name, &options.limits)?
    } else {
        flat(&value, rows, name, &options.limits)?
    };
    let (format, warnings) = ("JSON".to_owned(), Vec::new());
    Ok(Grid { columns, rows, heights, place: None, format, warnings })
}

/// Returns the array of heights and its path.
fn heights<'a>(value: &'a Value, options: &'a HeightMapOptions) -> Result<(&'a str, &'a Value)> {
    let Value::Object(object) = value else { return Ok(("", value)) };
    let found = match &options.array {
        Some(name) => object.get(name).map(|v| (name.as_str(), v)),
        None => MEMBERS.iter().find_map(|name| object.get(*name).map(|v| (*name, v))),
    };
    found.ok_or_else(|| {
        let wanted = options.array.clone().unwrap_or_else(|| MEMBERS.join(", "));
        Error::whole(format!("the object has no array of heights: none of {wanted}"))
    })
}

fn array<'a>(value: &'a Value, path: &str) -> Result<&'a Vec<Value>> {
    value.as_array().ok_or_else(|| wrong(path, "an array is needed"))
}

fn wrong(path: &str, message: &str) -> Error {
    match path {
        "" => Error::whole(message),
        _ => Error::path(path, message),
    }
}

fn height(value: &Value, path: impl FnOnce() -> String) -> Result<f64> {
    match value {
        Value::Null => Ok(f64::NAN),
        // Some writers write "not a number" as a text.
        Value::String(s) if s.eq_ignore_ascii_case("nan") => Ok(f64::NAN),
        _ => value.as_f64().ok_or_else(|| wrong(&path(), "a number or null is needed")),
    }
}

fn nested(rows: &[Value], name: &str, limits: &Limits) -> Result<(usize, usize, Vec<f64>)> {
    let columns = rows.first().and_then(Value::as_array).map_or(0, Vec::len);
    let count = check_size(columns as u64, rows.len() as u64, limits)?;
    let mut heights = Vec::with_capacity(count);
    for (r, row) in rows.iter().enumerate() {
        let row = array(row, &format!("{name}[{r}]"))?;
        if row.len() != columns {
            let numbers = counted(row.len() as u64, "number", "numbers");
            let message = format!("{numbers}; the first row has {columns}");
            return Err(wrong(&format!("{name}[{r}]"), &message));
        }
        for (c, value) in row.iter().enumerate() {
            heights.push(height(value, || format!("{name}[{r}][{c}]"))?);
        }
    }
    Ok((columns, rows.len(), heights))
}

fn flat(
    object: &Value,
    values: &[Value],
    name: &str,
    limits: &Limits,
) -> Result<(usize, usize, Vec<f64>)> {
    let size = |keys: [&str; 3]| {
        let found = keys.iter().find_map(|k| object.get(k).map(|v| (*k, v)));
        let (key, value) = found.ok_or_else(|| {
            wrong(name, &format!("numbers in one row need `{}` beside them", keys[0]))
        })?;
        value.as_u64().ok_or_else(|| wrong(key, "a whole number from 1 is needed"))
    };
    let (columns, rows) =
        (size(["width", "columns", "ncols"])?, size(["height", "rows", "nrows"])?);
    let count = check_size(columns, rows, limits)?;
    if values.len() != count {
        let numbers = counted(values.len() as u64, "number", "numbers");
        let message = format!("{numbers}; {columns} × {rows} are needed");
        return Err(wrong(name, &message));
    }
    let heights = values.iter().enumerate();
    let heights = heights.map(|(i, v)| height(v, || format!("{name}[{i}]")));
    Ok((columns as usize, rows as usize, heights.collect::<Result<_>>()?))
}
