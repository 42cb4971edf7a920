//! Tables in dBASE's format, as Shapefiles have them.

use super::Faults;
use super::encoding::Encoding;
use crate::geo::Member;
use crate::geo::members::{object, quoted};
use crate::geo::number;
use crate::text::{Tally, name};
use crate::{Error, Place, Result};
use std::borrow::Cow;

/// Bytes that describe a field.
const FIELD: usize = 32;

/// A field.
#[derive(Debug)]
struct Column {
    key: String,
    kind: u8,
    /// Its bytes in a row.
    bytes: std::ops::Range<usize>,
}

/// A table, held whole.
#[derive(Debug)]
pub struct Table {
    bytes: Vec<u8>,
    columns: Vec<Column>,
    encoding: Option<Encoding>,
    /// Bytes before the first row, of a row, and rows.
    head: usize,
    length: usize,
    rows: usize,
}

impl Table {
    /// Reads the head of a table.
    ///
    /// # Errors
    /// If the head does not give the position of rows.
    pub fn new(bytes: Vec<u8>, encoding: Option<Encoding>) -> Result<Self> {
        let wrong = |at: u64, message: &str| Err(Error::byte(at, message));
        let Some(start) = bytes.first_chunk::<FIELD>() else {
            return wrong(0, "the head of a table is expected, 32 bytes");
        };
        let count = u32::from_le_bytes([start[4], start[5], start[6], start[7]]) as usize;
        let head = usize::from(u16::from_le_bytes([start[8], start[9]]));
        let length = usize::from(u16::from_le_bytes([start[10], start[11]]));
        if head < FIELD || length == 0 {
            return wrong(8, "the lengths of head and rows are expected, not 0");
        }
        let encoding = encoding.or_else(|| Encoding::of_driver(start[29]));
        let held = bytes.len().saturating_sub(head) / length;
        let columns = columns(&bytes, head, length, encoding);
        Ok(Self { columns, encoding, head, length, rows: count.min(held), bytes })
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    fn bytes_of(&self, row: usize) -> Option<&[u8]> {
        let start = row.checked_mul(self.length)?.checked_add(self.head)?;
        self.bytes.get(start..start.checked_add(self.length)?).filter(|_| row < self.rows)
    }

    /// Returns whether a row is marked as deleted.
    pub fn is_deleted(&self, row: usize) -> bool {
        self.bytes_of(row).is_some_and(|bytes| bytes.first() == Some(&b'*'))
    }

    /// Returns the values of a row as a JSON object.
    pub fn row(&self, row: usize, faults: &mut Faults) -> String {
        let Some(bytes) = self.bytes_of(row) else {
            faults.rows.add(|| Place::Path(format!("record {}", row + 1)));
            return "{}".to_owned();
        };
        let place = |key: &str| Place::Path(format!("record {}, field {key}", row + 1));
        let member = |column: &Column| {
            let value = bytes.get(column.bytes.clone()).unwrap_or_default();
            Member::new(&column.key, self.value(column, value, faults, || place(&column.key)))
        };
        object(&self.columns.iter().map(member).collect::<Vec<_>>())
    }

    /// Returns a value in JSON.
    fn value(
        &self,
        column: &Column,
        value: &[u8],
        faults: &mut Faults,
        place: impl Fn() -> Place,
    ) -> String {
        let blank = value.iter().all(|b| matches!(b, b' ' | 0 | b'*'));
        let json = match column.kind {
            b'C' => return self.text(value, &mut faults.letters, place),
            b'I' | b'+' => value.first_chunk().map(|b| i32::from_le_bytes(*b).to_string()),
            b'O' => value.first_chunk().and_then(|b| double(f64::from_le_bytes(*b))),
            b'B' if value.len() == 8 => {
                value.first_chunk().and_then(|b| double(f64::from_le_bytes(*b)))
            }
            b'Y' => value.first_chunk().and_then(|b| double(i64::from_le_bytes(*b) as f64 / 1e4)),
            b'@' | b'T' => value.as_chunks::<4>().0.first_chunk().and_then(|[d, t]| moment(*d, *t)),
            b'M' | b'G' | b'P' | b'B' if !blank => {
                faults.memos.add(place);
                return NULL.to_owned();
            }
            _ if blank => return NULL.to_owned(),
            b'N' | b'F' => decimal(value),
            b'L' => match value.first() {
                Some(b'T' | b't' | b'Y' | b'y') => Some("true".to_owned()),
                Some(b'F' | b'f' | b'N' | b'n') => Some("false".to_owned()),
                Some(b'?') => return NULL.to_owned(),
                _ => None,
            },
            b'D' => day(value),
            _ => return self.text(value, &mut faults.letters, place),
        };
        json.unwrap_or_else(|| {
            faults.values.add(place);
            NULL.to_owned()
        })
    }

    fn text(&self, value: &[u8], letters: &mut Tally, place: impl Fn() -> Place) -> String {
        let end = value.iter().rposition(|b| !matches!(b, b' ' | 0)).map_or(0, |i| i + 1);
        let value = value.get(..end).unwrap_or_default();
        if value.is_empty() {
            return NULL.to_owned();
        }
        let (text, fits) = decode(self.encoding, value);
        if !fits {
            letters.add(place);
        }
        quoted(&text)
    }
}

const NULL: &str = "null";

/// Decodes a text; without a known encoding it is UTF-8 where that fits, else Windows-1252.
fn decode(encoding: Option<Encoding>, bytes: &[u8]) -> (Cow<'_, str>, bool) {
    match encoding {
        Some(encoding) => encoding.decode(bytes),
        None => {
            // A letter that is cut off is one of UTF-8 only after others of it.
            let whole = super::encoding::whole_letters(bytes);
            (name(if whole.is_ascii() { bytes } else { whole }), true)
        }
    }
}

/// Returns the fields described in a header, as far as rows have bytes for them.
fn columns(bytes: &[u8], head: usize, length: usize, encoding: Option<Encoding>) -> Vec<Column> {
    let described = bytes.get(FIELD..head.min(bytes.len())).unwrap_or_default();
    let mut at = 1;
    let mut columns = Vec::new();
    for field in described.as_chunks::<FIELD>().0 {
        if matches!(field[0], 0x0d | 0) {
            break;
        }
        let ends = field.iter().take(11).position(|&b| b == 0).unwrap_or(11);
        let key = decode(encoding, &field[..ends]).0.trim().to_owned();
        let wide = usize::from(field[16]);
        // Texts of more than 255 bytes keep the rest of their length where others keep decimals.
        let wide = if field[11] == b'C' { wide + 256 * usize::from(field[17]) } else { wide };
        if at + wide > length {
            break;
        }
        // FoxPro's internal fields.
        if field[11] != b'0' {
            columns.push(Column { key, kind: field[11], bytes: at..at + wide });
        }
        at += wide;
    }
    columns
}

fn double(value: f64) -> Option<String> {
    let mut text = Vec::new();
    number::write(&mut text, value).ok().filter(|()| value.is_finite())?;
    String::from_utf8(text).ok()
}

/// Returns a decimal number as JSON, with its digits unchanged except for trailing zeros after the first decimal.
fn decimal(value: &[u8]) -> Option<String> {
    let value: Vec<u8> = value.iter().copied().filter(|b| !matches!(b, b' ' | 0)).collect();
    let text = std::str::from_utf8(&value).ok()?;
    if serde_json::from_str::<serde_json::Number>(text).is_ok() {
        let is_plain = text.contains('.') && !text.contains(['e', 'E']);
        let short = if is_plain { text.trim_end_matches('0') } else { text };
        return Some(if short.ends_with('.') { format!("{short}0") } else { short.to_owned() });
    }
    let dotted = text.replace(',', ".");
    let (number, length) = crate::number::float(dotted.as_bytes())?;
    (length == dotted.len()).then(|| double(number))?
}

/// Converts `YYYYMMDD` to a day of JSON.
fn day(value: &[u8]) -> Option<String> {
    let digits = std::str::from_utf8(value.first_chunk::<8>()?).ok()?;
    let whole = digits.bytes().all(|b| b.is_ascii_digit());
    whole.then(|| format!("\"{}-{}-{}\"", &digits[..4], &digits[4..6], &digits[6..]))
}

/// Returns a Julian day and milliseconds as a moment of JSON; by Fliegel and Van Flandern, 1968.
fn moment(day: [u8; 4], milliseconds: [u8; 4]) -> Option<String> {
    let (julian, time) = (i64::from(i32::from_le_bytes(day)), i32::from_le_bytes(milliseconds));
    if !(1_721_426..5_373_485).contains(&julian) || !(0..86_400_000).contains(&time) {
        return (julian == 0).then(|| NULL.to_owned());
    }
    let l = julian + 68_569;
    let n = 4 * l / 146_097;
    let l = l - (146_097 * n + 3) / 4;
    let i = 4000 * (l + 1) / 1_461_001;
    let l = l - 1461 * i / 4 + 31;
    let j = 80 * l / 2447;
    let (day, l) = (l - 2447 * j / 80, j / 11);
    let (month, year) = (j + 2 - 12 * l, 100 * (n - 49) + i + l);
    let (seconds, rest) = (time / 1000, time % 1000);
    let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    let fraction = if rest > 0 { format!(".{rest:03}") } else { String::new() };
    Some(format!("\"{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}{fraction}\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_become_json() {
        for (text, json) in [
            ("  12", Some("12")),
            ("0012", Some("12")),
            ("-.5", Some("-0.5")),
            ("1,5", Some("1.5")),
            ("1.50", Some("1.5")),
            ("8.000", Some("8.0")),
            ("100", Some("100")),
            ("1.20e10", Some("1.20e10")),
            ("1e3x", None),
        ] {
            assert_eq!(decimal(text.as_bytes()).as_deref(), json, "{text}");
        }
        assert_eq!(day(b"20241231").as_deref(), Some("\"2024-12-31\""));
        assert_eq!(day(b"2024123x"), None);
        let at = moment(2_451_545_i32.to_le_bytes(), 43_200_500_i32.to_le_bytes());
        assert_eq!(at.as_deref(), Some("\"2000-01-01T12:00:00.500\""));
    }
}
