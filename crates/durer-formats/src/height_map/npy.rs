//! NumPy's NPY, versions 1 to 3: a header in the syntax of a Python dictionary, then the numbers.

use super::{Grid, HeightMapOptions, check_size};
use crate::text::quote;
use crate::{Error, Limits, Place, Result};

/// The first bytes of a file.
pub const MAGIC: &[u8] = b"\x93NUMPY";

/// An array of any shape whose numbers are read as f64.
pub struct Array {
    pub shape: Vec<u64>,
    pub values: Vec<f64>,
    /// NumPy's name of the type, without the byte order.
    pub kind: String,
    fortran: bool,
}

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    array(bytes, &options.limits)?.grid("NPY")
}

impl Array {
    /// Returns the array as rows of heights.
    pub fn grid(self, format: &str) -> Result<Grid> {
        let &[rows, columns] = self.shape.as_slice() else {
            let shape: Vec<String> = self.shape.iter().map(u64::to_string).collect();
            let message =
                format!("an array of two dimensions is needed, not ({})", shape.join(", "));
            return Err(Error::whole(message));
        };
        let (rows, columns) = (rows as usize, columns as usize);
        let heights = if self.fortran {
            let at = |i: usize| self.values[(i % columns) * rows + i / columns];
            (0..self.values.len()).map(at).collect()
        } else {
            self.values
        };
        let (format, warnings) = (format!("{format}, {}", self.kind), Vec::new());
        Ok(Grid { columns, rows, heights, place: None, format, warnings })
    }
}

/// Reads an array.
pub fn array(bytes: &[u8], limits: &Limits) -> Result<Array> {
    let short = || Error::byte(bytes.len() as u64, "the file ends in its header");
    if !bytes.starts_with(MAGIC) {
        return Err(Error::byte(0, "this is not an NPY array"));
    }
    let (length, start) = match bytes.get(6).ok_or_else(short)? {
        1 => (u64::from(u16::from_le_bytes(number(bytes, 8).ok_or_else(short)?)), 10),
        2 | 3 => (u64::from(u32::from_le_bytes(number(bytes, 8).ok_or_else(short)?)), 12),
        version => {
            return Err(Error::Unsupported {
                place: Place::Byte(6),
                what: format!("version {version} of NPY"),
                hint: "versions 1 to 3 are read".to_owned(),
            });
        }
    };
    let end = start + usize::try_from(length).map_err(|_| short())?;
    let header = String::from_utf8_lossy(bytes.get(start..end).ok_or_else(short)?);
    let wrong = |what: String| Error::byte(start as u64, what);
    let descr = member(&header, "descr").ok_or_else(|| wrong("`descr` is missing".to_owned()))?;
    let shape = shape(&header)
        .ok_or_else(|| wrong(format!("no shape in `{}`", quote(header.as_bytes()))))?;
    let fortran = member(&header, "fortran_order").is_some_and(|v| v.starts_with("True"));
    let kind = descr.trim_start_matches(['\'', '"']);
    let kind = kind.split(['\'', '"']).next().unwrap_or_default();
    let data = bytes.get(end..).unwrap_or_default();
    let count = match shape.as_slice() {
        [] => 1,
        [rows, columns] => check_size(*columns, *rows, limits)?,
        other => check_size(other.iter().fold(1, |n: u64, &d| n.saturating_mul(d)), 1, limits)?,
    };
    let values = values(kind, data, count, end as u64)?;
    Ok(Array {
        shape,
        values,
        kind: kind.trim_start_matches(['<', '>', '=', '|']).to_owned(),
        fortran,
    })
}

/// Returns the text after a key of the dictionary.
fn member<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let at = header.find(&format!("'{key}'")).or_else(|| header.find(&format!("\"{key}\"")))?;
    let (_, value) = header[at..].split_once(':')?;
    Some(value.trim_start())
}

fn shape(header: &str) -> Option<Vec<u64>> {
    let inside = member(header, "shape")?.strip_prefix('(')?.split_once(')')?.0;
    let sizes = inside.split(',').map(str::trim).filter(|s| !s.is_empty());
    sizes.map(|s| s.trim_end_matches('L').parse().ok()).collect()
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// Converts numbers of N bytes with `f`, their order turned to little-endian.
fn each<const N: usize>(data: &[u8], count: usize, big: bool, f: fn([u8; N]) -> f64) -> Vec<f64> {
    let numbers = data.as_chunks::<N>().0.iter().take(count);
    numbers
        .map(|&bytes| {
            let mut bytes = bytes;
            if big {
                bytes.reverse();
            }
            f(bytes)
        })
        .collect()
}

fn values(kind: &str, data: &[u8], count: usize, offset: u64) -> Result<Vec<f64>> {
    let (order, name) =
        kind.split_at(kind.len() - kind.trim_start_matches(['<', '>', '=', '|']).len());
    let big = order == ">";
    let width: usize = name.get(1..).and_then(|w| w.parse().ok()).unwrap_or(0);
    let needed = count.saturating_mul(width);
    if data.len() < needed {
        let message = format!("the numbers take {needed} bytes; there are {}", data.len());
        return Err(Error::byte(offset, message));
    }
    Ok(match name {
        "f8" => each(data, count, big, f64::from_le_bytes),
        "f4" => each(data, count, big, |b| f64::from(f32::from_le_bytes(b))),
        "i8" => each(data, count, big, |b| i64::from_le_bytes(b) as f64),
        "u8" => each(data, count, big, |b| u64::from_le_bytes(b) as f64),
        "i4" => each(data, count, big, |b| f64::from(i32::from_le_bytes(b))),
        "u4" => each(data, count, big, |b| f64::from(u32::from_le_bytes(b))),
        "i2" => each(data, count, big, |b| f64::from(i16::from_le_bytes(b))),
        "u2" => each(data, count, big, |b| f64::from(u16::from_le_bytes(b))),
        "i1" => each(data, count, big, |b| f64::from(i8::from_le_bytes(b))),
        "u1" | "b1" => each(data, count, big, |b| f64::from(u8::from_le_bytes(b))),
        _ => {
            return Err(Error::Unsupported {
                place: Place::Byte(offset),
                what: format!("an array of type `{}`", quote(kind.as_bytes())),
                hint: "f4, f8, and whole numbers of 1 to 8 bytes are read".to_owned(),
            });
        }
    })
}
