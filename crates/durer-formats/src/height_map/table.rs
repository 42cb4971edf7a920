//! Rows of numbers with commas, semicolons, tabs or blanks between them.

use super::{Grid, HeightMapOptions, check_size};
use crate::text::{quote, utf8};
use crate::{Error, Place, Result, Warning, number};

/// Whether text begins with a number, after comments.
pub fn looks_like_one(bytes: &[u8]) -> bool {
    let text = utf8(bytes.get(..4096).unwrap_or(bytes));
    let line = text.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).find(|l| is_row(l));
    line.is_some_and(|l| number::float(l).is_some())
}

fn is_row(line: &[u8]) -> bool {
    !line.is_empty() && !line.starts_with(b"#")
}

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    let text = utf8(bytes);
    let mut grid = Grid {
        columns: 0,
        rows: 0,
        heights: Vec::new(),
        place: None,
        format: "CSV".to_owned(),
        warnings: Vec::new(),
    };
    let separator = separator(&text);
    for (index, line) in text.split(|b| *b == b'\n').enumerate() {
        let content = line.trim_ascii();
        if !is_row(content) {
            continue;
        }
        let number = index as u64 + 1;
        if grid.rows == 0 && grid.warnings.is_empty() && is_heading(content, separator) {
            let message = "the heading is left out".to_owned();
            grid.warnings.push(Warning { place: Place::Line(number, 0), message });
            continue;
        }
        row(&mut grid, line, number, separator)?;
        check_size(grid.columns as u64, grid.rows as u64, &options.limits)?;
    }
    if grid.rows == 0 {
        return Err(Error::whole("there is no row of numbers"));
    }
    Ok(grid)
}

/// What parts the numbers: a semicolon, tab or comma where the first lines have one, else blanks.
fn separator(text: &[u8]) -> Option<u8> {
    let probe = text.get(..4096).unwrap_or(text);
    let mut rows = probe.split(|b| *b == b'\n').filter(|l| is_row(l.trim_ascii()));
    let first = rows.next().unwrap_or_default();
    [b';', b'\t', b','].into_iter().find(|s| first.contains(s))
}

/// Cells of a line with the column of each, counted from 1 in bytes.
fn cells(line: &[u8], separator: Option<u8>) -> impl Iterator<Item = (u64, &[u8])> {
    let parts = line.split(move |b| separator.map_or(b.is_ascii_whitespace(), |s| *b == s));
    let mut at = 0u64;
    let placed = parts.map(move |part| {
        let blanks = part.len() - part.trim_ascii_start().len();
        let column = at + blanks as u64 + 1;
        at += part.len() as u64 + 1;
        (column, part.trim_ascii())
    });
    // Several blanks are one; a comma after a comma is an empty cell.
    placed.filter(move |(_, cell)| separator.is_some() || !cell.is_empty())
}

/// A first line in which some cell is text.
fn is_heading(line: &[u8], separator: Option<u8>) -> bool {
    cells(line, separator).any(|(_, cell)| height(cell).is_none())
}

/// A height; NaN for what stands for a missing one.
fn height(cell: &[u8]) -> Option<f64> {
    let cell = cell.strip_prefix(b"\"").and_then(|c| c.strip_suffix(b"\"")).unwrap_or(cell);
    let none = ["", "na", "n/a", "null", "none", "-", "--"];
    if none.iter().any(|n| cell.eq_ignore_ascii_case(n.as_bytes())) {
        return Some(f64::NAN);
    }
    number::float(cell).filter(|(_, length)| *length == cell.len()).map(|(value, _)| value)
}

fn row(grid: &mut Grid, line: &[u8], number: u64, separator: Option<u8>) -> Result<()> {
    let before = grid.heights.len();
    for (column, cell) in cells(line.trim_ascii_end(), separator) {
        let value = height(cell).ok_or_else(|| {
            Error::line(number, column, format!("`{}` is not a number", quote(cell)))
        })?;
        grid.heights.push(value);
    }
    let count = grid.heights.len() - before;
    if grid.rows == 0 {
        grid.columns = count;
    } else if count != grid.columns {
        let message = format!("{count} numbers; the rows before have {}", grid.columns);
        return Err(Error::line(number, 0, message));
    }
    grid.rows += 1;
    Ok(())
}
