//! The list of parts on a sheet: number, name, and how many there are (ISO 7573).

use super::marks::{Annotator, THICK, THIN};
use crate::curve::stroke_font;
use crate::math::DVec2;
use crate::paper::title_block;
use crate::target::drawing::TextAnchor;

/// A row of the list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartsListRow {
    /// Number in the part's callout.
    pub number: String,
    /// Name of the part.
    pub name: String,
    /// Number of parts of this kind.
    pub quantity: usize,
}

/// Height of a row and of its letters, millimetres.
const ROW: f64 = 6.0;
const TEXT: f64 = 2.5;
/// Widths of the columns for numbers and quantities, and of that for names at least and at most.
const NUMBER: f64 = 12.0;
const NAME: (f64, f64) = (45.0, 90.0);
/// Number of rows up to which a list below the views is not divided.
const HIGH: usize = 12;
/// Space between a border and letters.
const PAD: f64 = 1.6;

/// Division of a list into blocks beside each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Rows of a block, without its heading.
    rows: usize,
    blocks: usize,
    /// Width of a block.
    width: f64,
}

impl Shape {
    /// Creates a list of blocks with at most the given total width; a single block, unless that is higher than [`HIGH`]
    /// rows.
    pub fn within_width(rows: &[PartsListRow], width: f64) -> Self {
        let own = width_of(rows);
        let most = (width / own).floor().max(1.0) as usize;
        let high = rows.len().div_ceil(most.min(rows.len().div_ceil(HIGH)).max(1));
        Self { rows: high, blocks: rows.len().div_ceil(high.max(1)), width: own }
    }

    /// Creates a list of blocks that are at most so high, as few as can be.
    pub fn within_height(rows: &[PartsListRow], height: f64) -> Self {
        let high = ((height / ROW).floor() - 1.0).max(1.0) as usize;
        let high = high.min(rows.len());
        Self { rows: high, blocks: rows.len().div_ceil(high.max(1)), width: width_of(rows) }
    }

    /// Returns the width and height, millimetres; 0 for a list of nothing.
    pub fn size(&self) -> DVec2 {
        let blocks = self.blocks as f64;
        DVec2::new(self.width * blocks, (self.rows as f64 + 1.0) * ROW * blocks.min(1.0))
    }
}

fn width_of(rows: &[PartsListRow]) -> f64 {
    let name = |r: &PartsListRow| stroke_font::line(&r.name, TEXT).advance + 2.0 * PAD;
    2.0 * NUMBER + rows.iter().map(name).fold(NAME.0, f64::max).min(NAME.1)
}

/// Draws the list with its lower right corner at a place, the first part above the heading: layer `parts-list`.
pub fn put(annotator: &mut Annotator, rows: &[PartsListRow], shape: &Shape, corner: DVec2) {
    for (block, rows) in rows.chunks(shape.rows.max(1)).enumerate() {
        let right = corner.x - (shape.blocks - 1).saturating_sub(block) as f64 * shape.width;
        let left = right - shape.width;
        let texts = |y: f64,
                     number: &str,
                     name: &str,
                     quantity: &str,
                     annotator: &mut Annotator| {
            let base = y - (ROW - TEXT) * 0.5;
            let room = shape.width - 2.0 * NUMBER - 2.0 * PAD;
            let middle = NUMBER * 0.5;
            annotator.text(DVec2::new(left + middle, base), number, TEXT, TextAnchor::Middle);
            let at = DVec2::new(left + NUMBER + PAD, base);
            annotator.text(at, name, title_block::fitted(name, TEXT, room), TextAnchor::Start);
            annotator.text(DVec2::new(right - middle, base), quantity, TEXT, TextAnchor::Middle);
        };
        texts(corner.y, "ITEM", "NAME", "QTY", annotator);
        for (i, row) in rows.iter().enumerate() {
            let y = corner.y - (i as f64 + 1.0) * ROW;
            annotator.line(vec![DVec2::new(left, y), DVec2::new(right, y)], THIN, &[]);
            texts(y, &row.number, &row.name, &row.quantity.to_string(), annotator);
        }
        let top = corner.y - (rows.len() as f64 + 1.0) * ROW;
        for x in [left + NUMBER, right - NUMBER] {
            annotator.line(vec![DVec2::new(x, top), DVec2::new(x, corner.y)], THIN, &[]);
        }
        annotator.rectangle(DVec2::new(left, top), DVec2::new(right, corner.y), THICK);
    }
    annotator.end_layer("parts-list");
}
