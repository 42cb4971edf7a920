//! Tables as SVG.

use super::{LINE, TEXT, text, width, wrap};
use crate::explain::table::Table;
use crate::explain::words::Language;
use std::fmt::Write;

/// Widest cell in pixels; longer texts have several lines.
const MOST: f64 = 380.0;
const PADDING: f64 = 6.0;

/// A drawn table.
#[derive(Default)]
pub(super) struct Drawn {
    pub width: f64,
    pub height: f64,
    pub body: String,
}

/// A cell, divided into lines.
struct Laid {
    lines: Vec<String>,
    changed: bool,
    head: bool,
}

/// Draws a table; an empty one takes no room.
pub(super) fn table(table: &Table, language: Language) -> Drawn {
    let rows = laid(table, language);
    let count = rows.iter().map(Vec::len).max().unwrap_or_default();
    let widths: Vec<f64> = (0..count).map(|k| column(&rows, k)).collect();
    let mut drawn = Drawn { width: widths.iter().sum(), ..Drawn::default() };
    for row in &rows {
        let lines = row.iter().map(|cell| cell.lines.len()).max().unwrap_or(1);
        let high = lines as f64 * LINE + 2.0;
        let mut x = 0.0;
        for (cell, &wide) in row.iter().zip(&widths) {
            draw(&mut drawn.body, cell, [x, drawn.height, wide, high]);
            x += wide;
        }
        drawn.height += high;
    }
    drawn
}

fn laid(table: &Table, language: Language) -> Vec<Vec<Laid>> {
    let cell = |text: &str, changed, head| Laid { lines: wrap(text, TEXT, MOST), changed, head };
    let heads = table.heads.iter().map(|word| cell(word.text(language), false, true)).collect();
    let mut rows: Vec<Vec<Laid>> = if table.heads.is_empty() { Vec::new() } else { vec![heads] };
    for row in &table.rows {
        let name = cell(&row.name.text(language), false, true);
        let cells = row.cells.iter().map(|c| cell(&c.value.text(language), c.changed, false));
        rows.push(std::iter::once(name).chain(cells).collect());
    }
    rows
}

/// Returns the width of a column.
fn column(rows: &[Vec<Laid>], k: usize) -> f64 {
    let lines = rows.iter().filter_map(|row| row.get(k)).flat_map(|cell| &cell.lines);
    // Bold letters are wider.
    lines.map(|line| width(line, TEXT) * 1.12).fold(20.0, f64::max) + 2.0 * PADDING
}

fn draw(out: &mut String, cell: &Laid, [x, y, wide, high]: [f64; 4]) {
    let fill = if cell.changed { "#ffe3a8" } else { "#fff" };
    let [left, top, w, h] = [x, y, wide, high].map(super::short);
    let _ = write!(
        out,
        "<rect x='{left}' y='{top}' width='{w}' height='{h}' fill='{fill}' stroke='#ccc'/>"
    );
    let weight = if cell.head || cell.changed { " font-weight='bold'" } else { "" };
    for (i, line) in cell.lines.iter().enumerate() {
        text(out, (x + PADDING, y + (i as f64 + 1.0) * LINE - 3.0), line, weight);
    }
}
