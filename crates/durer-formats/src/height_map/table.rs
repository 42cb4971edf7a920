//! Rows of numbers with commas, semicolons, tabs or blanks between them: heights, or points x, y, z.

use super::{Grid, HeightMapOptions, check_size, points};
use crate::text::{quote, utf8};
use crate::wording::counted;
use crate::{Error, Place, Result, Warning, number};

/// Returns whether text begins with a number or the names of coordinates, after comments.
pub fn looks_like_one(bytes: &[u8]) -> bool {
    let text = utf8(bytes.get(..4096).unwrap_or(bytes));
    let line = text.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).find(|l| is_row(l));
    let names =
        |l: &[u8]| matches!(heading_of(l, separator(l)), Heading::Points | Heading::Latitude);
    line.is_some_and(|l| number::float(l).is_some() || names(l))
}

fn is_row(line: &[u8]) -> bool {
    !line.is_empty() && !line.starts_with(b"#")
}

/// Number of rows above which a table of three columns without a heading gives a warning about the effect of a heading.
const LONG: usize = 12;

pub fn read(bytes: &[u8], options: &HeightMapOptions) -> Result<Grid> {
    let (mut table, heading) = table(bytes, options)?;
    if table.columns == 3 && heading == Heading::Latitude {
        table.heights.as_chunks_mut::<3>().0.iter_mut().for_each(|point| point.swap(0, 1));
    }
    let is_list = matches!(heading, Heading::Points | Heading::Latitude);
    let found = if table.columns == 3 { points::gridded(&table, is_list, options)? } else { None };
    if let Some(grid) = found.or_else(|| points::with_coordinates(&table)) {
        return Ok(grid);
    }
    let mut grid = table;
    if heading != Heading::None {
        let message = "the heading is left out".to_owned();
        grid.warnings.insert(0, Warning { place: Place::Line(1, 0), message });
    }
    if grid.columns == 3 && grid.rows > LONG {
        let message = format!(
            "it is read as {} rows of three heights; points x, y, z need a heading that names them",
            grid.rows
        );
        grid.warnings.push(Warning { place: Place::Whole, message });
    }
    if grid.columns == 1 && grid.rows == 1 {
        return Err(Error::whole("one height is not a surface; two rows and columns are needed"));
    }
    Ok(grid)
}

/// Meaning of a table's first line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Heading {
    /// Numbers like the others.
    None,
    /// Names of the coordinates of points, x first.
    Points,
    /// The same, with the latitude first.
    Latitude,
    /// Other words.
    Words,
}

/// Returns the numbers of a table. If only the first cell of the first line is text, that cell counts as missing.
fn table(bytes: &[u8], options: &HeightMapOptions) -> Result<(Grid, Heading)> {
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
    let mut heading = None;
    for (index, line) in text.split(|b| *b == b'\n').enumerate() {
        let content = line.trim_ascii();
        if !is_row(content) {
            continue;
        }
        let number = index as u64 + 1;
        if grid.rows == 0 && heading.is_none() {
            let first = heading_of(content, separator);
            heading = Some(first);
            if first != Heading::None {
                continue;
            }
        }
        row(&mut grid, line, number, separator)?;
        check_size(grid.columns as u64, grid.rows as u64, &options.limits)?;
    }
    if grid.rows == 0 {
        return Err(Error::whole("there is no row of numbers"));
    }
    Ok((grid, heading.unwrap_or(Heading::None)))
}

/// Returns the separator of numbers: a semicolon, tab or comma if the first lines have one, else
/// blanks.
fn separator(text: &[u8]) -> Option<u8> {
    let probe = text.get(..4096).unwrap_or(text);
    let mut rows = probe.split(|b| *b == b'\n').filter(|l| is_row(l.trim_ascii()));
    let first = rows.next().unwrap_or_default();
    [b';', b'\t', b','].into_iter().find(|s| first.contains(s))
}

/// Returns the cells of a line with the column of each, counted from 1 in bytes.
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

/// Names of coordinates, in lower case.
const X: [&str; 7] = ["x", "lon", "lng", "long", "longitude", "east", "easting"];
const Y: [&str; 6] = ["y", "lat", "latitude", "north", "northing", "lati"];

/// Returns a name without quotes, in lower case.
fn name(cell: &[u8]) -> String {
    String::from_utf8_lossy(cell).trim_matches(['"', ' ', '\'']).to_ascii_lowercase()
}

/// Returns the meaning of a first line; text in the corner, followed only by numbers, names the first row and column.
fn heading_of(line: &[u8], separator: Option<u8>) -> Heading {
    let words: Vec<bool> = cells(line, separator).map(|(_, cell)| height(cell).is_none()).collect();
    let names: Vec<String> = cells(line, separator).map(|(_, cell)| name(cell)).collect();
    let (is_x, is_y) = (|n: &String| X.contains(&n.as_str()), |n: &String| Y.contains(&n.as_str()));
    match words.split_first() {
        _ if matches!(&names[..], [x, y, _] if is_x(x) && is_y(y)) => Heading::Points,
        _ if matches!(&names[..], [y, x, _] if is_x(x) && is_y(y)) => Heading::Latitude,
        Some((true, others)) if others.len() > 1 && !others.contains(&true) => Heading::None,
        _ if words.contains(&true) => Heading::Words,
        _ => Heading::None,
    }
}

/// Returns a height; NaN for a missing one.
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
        if grid.heights.is_empty() && height(cell).is_none() {
            grid.heights.push(f64::NAN);
            continue;
        }
        let value = height(cell).ok_or_else(|| {
            Error::line(number, column, format!("`{}` is not a number", quote(cell)))
        })?;
        grid.heights.push(value);
    }
    let count = grid.heights.len() - before;
    if grid.rows == 0 {
        grid.columns = count;
    } else if count != grid.columns {
        let numbers = counted(count as u64, "number", "numbers");
        let message = format!("{numbers}; the rows before have {}", grid.columns);
        return Err(Error::line(number, 0, message));
    }
    grid.rows += 1;
    Ok(())
}
