//! In which order a pen draws: the next stroke is the one that begins or ends nearest.
//!
//! Greedy, by cells of a grid; strokes may be drawn backwards, closed ones from their first point. No
//! optimum, but some nine tenths of the way in the air are saved on drawings in any other order.

use crate::math::{DVec2, Rect};

/// A stroke in the order of drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn {
    /// Which stroke.
    pub index: usize,
    /// Whether it is drawn from its end.
    pub backwards: bool,
}

/// Grid cells per stroke, and at most along a side.
const MOST_CELLS: usize = 512;

/// Orders strokes, given by their first and last points, from a starting point. Equal distances: the
/// lower index, forwards. Points that are not finite count as the start.
///
/// Cost: O(n) for strokes spread over the paper.
pub fn nearest_first(ends: &[(DVec2, DVec2)], start: DVec2) -> Vec<Turn> {
    let finite = |p: DVec2| if p.is_finite() { p } else { start };
    let ends: Vec<[DVec2; 2]> = ends.iter().map(|e| [finite(e.0), finite(e.1)]).collect();
    let mut grid = Grid::new(&ends);
    let mut used = vec![false; ends.len()];
    let mut order = Vec::with_capacity(ends.len());
    let mut pen = start;
    while let Some(turn) = grid.nearest(pen, &ends, &used) {
        used[turn.index] = true;
        pen = ends[turn.index][usize::from(!turn.backwards)];
        order.push(turn);
    }
    order
}

/// Ends of strokes by cell.
struct Grid {
    min: DVec2,
    /// Side of a cell.
    step: f64,
    columns: usize,
    rows: usize,
    /// Stroke and which of its ends.
    cells: Vec<Vec<(u32, bool)>>,
}

impl Grid {
    fn new(ends: &[[DVec2; 2]]) -> Self {
        let bounds = Rect::around(ends.iter().flatten().copied());
        let (min, size) = bounds.map_or((DVec2::ZERO, DVec2::ZERO), |b| (b.min(), b.size()));
        let side = ((ends.len() as f64).sqrt() as usize).clamp(1, MOST_CELLS);
        let step = (size.max_element() / side as f64).max(1e-9);
        let count = |length: f64| ((length / step) as usize + 1).min(MOST_CELLS + 1);
        let (columns, rows) = (count(size.x), count(size.y));
        let mut grid = Self { min, step, columns, rows, cells: vec![Vec::new(); columns * rows] };
        for (i, both) in ends.iter().enumerate() {
            for (k, p) in both.iter().enumerate() {
                let (x, y) = grid.place(*p);
                grid.cells[y * columns + x].push((i as u32, k == 1));
            }
        }
        grid
    }

    fn place(&self, p: DVec2) -> (usize, usize) {
        let at = (p - self.min) / self.step;
        let index = |v: f64, count: usize| (v.max(0.0) as usize).min(count - 1);
        (index(at.x, self.columns), index(at.y, self.rows))
    }

    /// The nearest end of a stroke that is not used yet; forgets used ones on the way.
    fn nearest(&mut self, pen: DVec2, ends: &[[DVec2; 2]], used: &[bool]) -> Option<Turn> {
        let (cx, cy) = self.place(pen);
        let mut best: Option<(f64, u32, bool)> = None;
        for ring in 0..self.columns.max(self.rows) {
            // All that lies in this ring of cells is at least ring − 1 cells away.
            let reach = (ring as f64 - 1.0).max(0.0) * self.step;
            if best.is_some_and(|b| b.0 < reach * reach) {
                break;
            }
            let (y0, y1) = (cy.saturating_sub(ring), (cy + ring).min(self.rows - 1));
            for y in y0..=y1 {
                let edge_row = y.abs_diff(cy) == ring;
                let (x0, x1) = (cx.checked_sub(ring), cx + ring);
                let columns = if edge_row {
                    (x0.unwrap_or(0)..=x1.min(self.columns - 1)).collect()
                } else {
                    let right = Some(x1).filter(|x| *x < self.columns && ring > 0);
                    x0.into_iter().chain(right).collect::<Vec<usize>>()
                };
                for x in columns {
                    let cell = &mut self.cells[y * self.columns + x];
                    cell.retain(|e| !used[e.0 as usize]);
                    for &(i, last) in cell.iter() {
                        let d = ends[i as usize][usize::from(last)].distance_squared(pen);
                        if best.is_none_or(|b| (d, i, last) < b) {
                            best = Some((d, i, last));
                        }
                    }
                }
            }
        }
        best.map(|(_, i, last)| Turn { index: i as usize, backwards: last })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pen_goes_on_from_the_end_that_it_came_to() {
        let stroke = |a: f64, b: f64| (DVec2::new(a, 0.0), DVec2::new(b, 0.0));
        let strokes =
            [stroke(31.0, 40.0), stroke(20.0, 11.0), stroke(0.0, 10.0), stroke(21.0, 30.0)];
        let turns: Vec<(usize, bool)> =
            nearest_first(&strokes, DVec2::ZERO).iter().map(|t| (t.index, t.backwards)).collect();
        assert_eq!(turns, [(2, false), (1, true), (3, false), (0, false)]);
        let turns = nearest_first(&strokes, DVec2::new(50.0, 0.0));
        assert!(turns.iter().map(|t| t.backwards).eq([true, true, false, true]));
    }
}
