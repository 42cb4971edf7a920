//! Several viewports on one screen.
//!
//! Viewports of a layout tile the screen: each pixel belongs to exactly one, so nothing drawn in one
//! can touch another.

use super::window::{PixelRect, Viewport};
use crate::info::{Class, Info, Occluder};
use crate::trace::{NoTrace, PseudocodeLine, Tracer};
use crate::{Error, Result};
use std::str::FromStr;

/// Facts about the division of a screen.
pub const INFO: Info = Info {
    name: "viewport-layout",
    title: "Several viewports on one screen",
    authors: "William M. Newman, Robert F. Sproull",
    year: 1973,
    source: "Principles of Interactive Computer Graphics",
    class: Class::ImageSpace,
    occluder: Occluder::None,
    coherence: &[],
    cost: "O(n) for n viewports",
    limits: "a grid of rows; at least one pixel for each viewport",
    pseudocode: &[
        "for each row r of R, from the top:",
        "    y0 ← ⌊H r / R⌋; y1 ← ⌊H (r + 1) / R⌋",
        "    n ← number of names in the row: as many as columns, or fewer in the last row",
        "    for each name, number c of n, from the left:",
        "        x0 ← ⌊W c / n⌋; x1 ← ⌊W (c + 1) / n⌋",
        "        its viewport has the columns x0 to x1 − 1 and the rows y0 to y1 − 1",
        "        map the window onto the viewport, and clip to it what is drawn",
        "// the end of a part is the beginning of the next: no pixel belongs to two viewports or to none",
    ],
};

/// Step of the division of a screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The rows of pixels of a row of viewports.
    Row {
        /// Number of the row, from the top.
        row: usize,
        /// First row of pixels, and the one behind the last.
        y: [i32; 2],
        /// Number of viewports in it.
        cells: usize,
    },
    /// A viewport.
    Cell {
        /// Number in its row, from the left.
        column: usize,
        /// Its pixels.
        pixels: PixelRect,
    },
}

impl PseudocodeLine for Step {
    fn line(&self) -> usize {
        match self {
            Self::Row { .. } => 2,
            Self::Cell { .. } => 6,
        }
    }
}

/// Returns the viewports that a list of steps leads to.
pub fn replay(steps: &[Step]) -> Vec<PixelRect> {
    let cell = |step: &Step| match step {
        Step::Cell { pixels, .. } => Some(*pixels),
        Step::Row { .. } => None,
    };
    steps.iter().filter_map(cell).collect()
}

/// A grid of named cells, filled row by row from the upper left.
///
/// Written `front,top,side,iso` (as square a grid as possible) or `3x1:front,side,top`
/// (columns × rows). The last row's cells share the whole width where names run out.
///
/// ```
/// use durer::view::layout::Layout;
/// let layout: Layout = "2x2:front,top,side,iso".parse().unwrap();
/// let cells = layout.viewports(101, 100).unwrap();
/// assert_eq!(cells[1].0, "top");
/// assert_eq!((cells[0].1.pixels().width(), cells[1].1.pixels().width()), (50, 51));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    columns: usize,
    rows: usize,
    names: Vec<String>,
}

/// More cells than this on one screen are refused.
pub const MAX_CELLS: usize = 4096;

impl Layout {
    /// Creates a grid of `columns` × `rows` cells with their names, row by row.
    ///
    /// # Errors
    /// [`Error::Parameter`] if a name is empty, there are no names, more names than cells, or so few that a row stays
    /// empty; [`Error::TooLarge`] above [`MAX_CELLS`].
    pub fn new(columns: usize, rows: usize, names: Vec<String>) -> Result<Self> {
        let cells = columns.saturating_mul(rows);
        if cells > MAX_CELLS {
            let limit = MAX_CELLS as u64;
            return Err(Error::TooLarge {
                what: "number of viewports",
                value: cells as u64,
                limit,
            });
        }
        if names.iter().any(|n| n.is_empty()) || names.is_empty() {
            return Err(Error::parameter("layout", names.join(","), "names parted by commas"));
        }
        if names.len() > cells || names.len() <= cells - columns {
            let value = format!("{} names in {columns}x{rows} cells", names.len());
            return Err(Error::parameter("layout", value, "names in every row, and not too many"));
        }
        Ok(Self { columns, rows, names })
    }

    /// Returns the number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the names of the cells, row by row.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the viewports with their names, in order, on a screen of this size in pixels.
    ///
    /// # Errors
    /// [`Error::Parameter`] if a cell would have no pixel, [`Error::TooLarge`] for a side above
    /// 2³¹ − 1.
    pub fn viewports(&self, width: u32, height: u32) -> Result<Vec<(&str, Viewport)>> {
        self.viewports_traced(width, height, &mut NoTrace)
    }

    /// Returns the viewports as [`Self::viewports`] does, and reports the steps.
    ///
    /// # Errors
    /// Those of [`Self::viewports`].
    pub fn viewports_traced(
        &self,
        width: u32,
        height: u32,
        t: &mut impl Tracer<Step>,
    ) -> Result<Vec<(&str, Viewport)>> {
        let screen = PixelRect::of_size(width, height)?;
        let mut cells = Vec::with_capacity(self.names.len());
        for (row, names) in self.names.chunks(self.columns).enumerate() {
            let (y0, y1) = part(screen.y1(), row, self.rows);
            t.step(|| Step::Row { row, y: [y0, y1], cells: names.len() });
            for (column, name) in names.iter().enumerate() {
                let (x0, x1) = part(screen.x1(), column, names.len());
                let pixels = PixelRect::new(x0, y0, x1, y1)?;
                cells.push((name.as_str(), Viewport::new(pixels)?));
                t.step(|| Step::Cell { column, pixels });
            }
        }
        Ok(cells)
    }
}

/// Returns part `i` of `n` of a length, to whole pixels; the parts add up to it.
fn part(length: i32, i: usize, n: usize) -> (i32, i32) {
    // i ≤ n, so the quotient is at most `length`.
    let border = |i: usize| (i64::from(length) * i as i64 / n.max(1) as i64) as i32;
    (border(i), border(i + 1))
}

impl FromStr for Layout {
    type Err = Error;

    fn from_str(s: &str) -> Result<Self> {
        let (grid, names) = match s.split_once(':') {
            Some((grid, names)) => (Some(parse_grid(grid)?), names),
            None => (None, s),
        };
        let names: Vec<String> = names.split(',').map(|n| n.trim().to_owned()).collect();
        let (columns, rows) = grid.unwrap_or_else(|| squarish(names.len()));
        Self::new(columns, rows, names)
    }
}

fn parse_grid(grid: &str) -> Result<(usize, usize)> {
    let sizes = grid.split_once('x').and_then(|(c, r)| Some((c.parse().ok()?, r.parse().ok()?)));
    match sizes {
        Some((columns, rows)) if columns > 0 && rows > 0 => Ok((columns, rows)),
        _ => Err(Error::parameter("layout grid", grid, "columns x rows, e.g. 2x2")),
    }
}

/// Returns the fewest columns whose square holds `n`, and the rows they need.
fn squarish(n: usize) -> (usize, usize) {
    let columns = (1..=n).find(|c| c.saturating_mul(*c) >= n).unwrap_or(1);
    (columns, n.div_ceil(columns))
}
