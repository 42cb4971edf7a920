//! ESRI ASCII grid: six lines of keys, then rows of heights from north to south.

use super::{Grid, HeightMapOptions, check_size};
use crate::text::{Cursor, quote, utf8};
use crate::{Error, Result};

/// Header before the heights.
#[derive(Debug, Default)]
struct Header {
    columns: Option<u64>,
    rows: Option<u64>,
    /// West and south, and whether they refer to the middle of a cell or to its corner.
    west: Option<(f64, bool)>,
    south: Option<(f64, bool)>,
    dx: Option<f64>,
    dy: Option<f64>,
    no_data: Option<f64>,
}

/// The value of a missing height if the file names none.
const NO_DATA: f64 = -9999.0;

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    let text = utf8(bytes);
    let mut cursor = Cursor::new(&text);
    let header = Header::read(&mut cursor)?;
    let need = |value: Option<u64>, key: &str| {
        value.ok_or_else(|| cursor.error(format!("`{key}` is missing before the heights")))
    };
    let (columns, rows) = (need(header.columns, "ncols")?, need(header.rows, "nrows")?);
    let count = check_size(columns, rows, &options.limits)?;
    // Each height takes a digit and a blank at least.
    if count > cursor.bytes_left().div_ceil(2) {
        let message = format!("the file is too short for {columns} columns and {rows} rows");
        return Err(cursor.error(message));
    }
    let missing = header.no_data.unwrap_or(NO_DATA);
    let mut heights = Vec::with_capacity(count);
    while heights.len() < count {
        match cursor.float()? {
            Some(height) if height == missing => heights.push(f64::NAN),
            Some(height) => heights.push(height),
            None if cursor.at_end() => {
                let message = format!("the file ends after {} of {count} heights", heights.len());
                return Err(cursor.error(message));
            }
            None => cursor.next_line(),
        }
    }
    while !cursor.at_end() {
        if let Some(word) = cursor.word() {
            let message = format!("`{}` follows the last of {count} heights", quote(word));
            return Err(cursor.error(message));
        }
        cursor.next_line();
    }
    let place = header.place(columns, rows);
    let (columns, rows, warnings) = (columns as usize, rows as usize, Vec::new());
    Ok(Grid { columns, rows, heights, place, format: "ESRI ASCII grid".to_owned(), warnings })
}

impl Header {
    fn read(cursor: &mut Cursor) -> Result<Self> {
        let mut header = Self::default();
        while !cursor.at_end() {
            let before = cursor.clone();
            let Some(word) = cursor.word() else {
                cursor.next_line();
                continue;
            };
            if !word[0].is_ascii_alphabetic() || word.eq_ignore_ascii_case(b"nan") {
                *cursor = before;
                break;
            }
            let key = String::from_utf8_lossy(word).to_ascii_lowercase();
            let place = cursor.place();
            let value = cursor.float()?.filter(|v| v.is_finite() || key == "nodata_value");
            let wrong = |what: &str| {
                let message = format!("`{key}` needs {what}");
                Error::Decode { place: place.clone(), message }
            };
            let value = value.ok_or_else(|| wrong("a number"))?;
            let whole = || {
                let fits = (1.0..=1e15).contains(&value) && value.fract() == 0.0;
                fits.then_some(value as u64).ok_or_else(|| wrong("a whole number from 1"))
            };
            let size = || Some(value).filter(|v| *v > 0.0).ok_or_else(|| wrong("a size above 0"));
            match key.as_str() {
                "ncols" => header.columns = Some(whole()?),
                "nrows" => header.rows = Some(whole()?),
                "xllcorner" => header.west = Some((value, false)),
                "xllcenter" => header.west = Some((value, true)),
                "yllcorner" => header.south = Some((value, false)),
                "yllcenter" => header.south = Some((value, true)),
                "cellsize" => (header.dx, header.dy) = (Some(size()?), Some(value)),
                "dx" => header.dx = Some(size()?),
                "dy" => header.dy = Some(size()?),
                "nodata_value" => header.no_data = Some(value),
                _ => return Err(wrong("to be a key of the format, such as ncols or cellsize")),
            }
            cursor.next_line();
        }
        Ok(header)
    }

    /// Returns west, east, south and north of the outermost heights.
    fn place(&self, columns: u64, rows: u64) -> Option<[f64; 4]> {
        let (dx, dy) = (self.dx?, self.dy?);
        let first = |(at, is_middle): (f64, bool), size: f64| {
            if is_middle { at } else { at + size * 0.5 }
        };
        let (west, south) = (first(self.west?, dx), first(self.south?, dy));
        let (east, north) = ((columns - 1) as f64 * dx, (rows - 1) as f64 * dy);
        Some([west, west + east, south, south + north])
    }
}
