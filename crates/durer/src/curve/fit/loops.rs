//! Closed polylines as whole circles and ellipses.

use super::bends::Bends;
use super::measure::Run;
use super::{EXACT, Fitted, circle, ellipse, joined};
use crate::target::{Curve, CurvePiece, EllipticArc};
use std::f64::consts::TAU;

/// Fewer points make no whole circle.
const FEWEST: usize = 8;

/// Returns the circle or ellipse that a closed polyline approximates: preferably one that contains its points exactly,
/// else one near them. At most one of the points may have to be kept.
pub(super) fn whole(bends: &Bends) -> Option<Fitted> {
    let count = bends.count();
    let turned: f64 = bends.turns[1..=count].iter().sum();
    if bends.breaks.len() > 1 || count < FEWEST || (turned.abs() - TAU).abs() > 0.1 {
        return None;
    }
    let first = bends.breaks.first().copied().or((0..count).find(|i| !bends.is_fold(*i)))?;
    let turned_to = bends.from(first);
    let run = Run::new(&turned_to, 0, count);
    let around = [circle::whole(&run, turned), ellipse::whole(&run, turned)];
    let near = |run: &Run<'_>, within: f64| {
        let found = around.iter().flatten().find(|arc| run.is_near(arc, bends.tolerance * within));
        found.and_then(|arc| joined(*arc, run, bends.tolerance))
    };
    // Folds exist only among points that are exactly on a circle.
    let all = Run::of_all(&turned_to, 0, count);
    let arc: EllipticArc = near(&run, EXACT).or_else(|| near(&all, 1.0))?;
    let start = run.first();
    let curve = Curve { start, pieces: vec![CurvePiece::Arc(arc, start)], closed: true };
    Some(Fitted { curve, from: vec![first] })
}
