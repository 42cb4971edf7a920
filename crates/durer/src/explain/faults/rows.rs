//! Filling by edge table and active edge table as a program with faults.

use super::{Program, fault};
use crate::curve::Contours;
use crate::explain::fills::by_rows;
use crate::raster::coverage::FillRule;
use crate::raster::polygon::edge_table::{INFO, Step, TableEdge, row, table};
use crate::raster::span::Span;
use crate::sorting::CompactSort;
use crate::trace::{Recorder, Tracer};

pub(super) const PROGRAM: Program = Program {
    lesson: INFO.name,
    faults: &[
        fault(5, "leave the AET in the order of entry"),
        fault(7, "fill from the x of the first to that of the second, inclusive"),
        fault(9, "remove the edges with y_max = y − 1 from the AET"),
        fault(11, "x ← x + ⌊Δx/Δy⌋"),
        fault(12, "if acc ≥ Δy: x ← x + 1"),
    ],
    frames: |input, line, cap| {
        by_rows(input, cap, |contours, size, t| fill(contours, size, line, t))
    },
};

fn fill(contours: &Contours, [columns, rows]: [u32; 2], faulty: usize, t: &mut Recorder<Step>) {
    let mut waiting = table(contours, rows);
    waiting.compact_sort_by_key(|edge| std::cmp::Reverse(edge.rows.0));
    waiting.iter().rev().for_each(|edge| t.step(|| Step::Table(*edge)));
    let mut active: Vec<TableEdge> = Vec::new();
    let mut y = waiting.last().map_or(0, |edge| edge.rows.0);
    while (y as u32) < rows && !(waiting.is_empty() && active.is_empty()) {
        while let Some(edge) = waiting.pop_if(|edge| edge.rows.0 == y) {
            t.step(|| Step::Enter { y, x: edge.x });
            active.push(edge);
        }
        if faulty != 5 {
            active.compact_sort_by_key(|edge| edge.x);
        }
        active.iter().for_each(|&edge| t.step(|| Step::Active { y, edge }));
        row(&active, y, columns, FillRule::EvenOdd, |span| {
            let more = i32::from(faulty == 7);
            t.step(|| Step::Span(Span { x1: (span.x1 + more).min(columns as i32), ..span }));
        });
        y += 1;
        let last = if faulty == 9 { y - 1 } else { y };
        active.retain(|edge| edge.rows.1 > last);
        t.step(|| Step::Leave { y, active: active.len() });
        active.iter_mut().for_each(|edge| advance(edge, faulty));
        if active.is_empty() {
            y = waiting.last().map_or(y, |edge| edge.rows.0);
        }
    }
}

/// Goes on to the next row.
fn advance(edge: &mut TableEdge, faulty: usize) {
    edge.x += edge.step;
    if faulty == 11 {
        return;
    }
    edge.error += edge.remainder;
    if edge.error >= edge.whole {
        edge.x += 1;
        if faulty != 12 {
            edge.error -= edge.whole;
        }
    }
}
