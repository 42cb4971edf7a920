//! The placement of annotations: beside the views, in lanes, clear of each other.

use super::board::{Board, Draft};
use super::draw::{Linear, Said, reading};
use super::request::ViewSide;
use super::seen::Seen;
use super::style::{FIRST, STEP};
use crate::math::{DVec2, Rect};
use crate::target::dimension::Measure;

/// Lanes that are tried at each side of a view.
const LANES: u32 = 14;

/// Ways of leaders, degrees: to the upper right first.
const WAYS: [f64; 16] = [
    45.0, 60.0, 30.0, 135.0, 120.0, 150.0, -45.0, -60.0, -30.0, -135.0, -120.0, -150.0, 75.0,
    105.0, 15.0, 165.0,
];

/// Distance of leaders' elbows beyond a view's border, in millimetres, and number of steps farther.
const ELBOW: f64 = 4.0;
const ELBOWS: u32 = 6;

/// Penalty for each crossing of a leader, as additional length in millimetres.
const CROSSING: f64 = 60.0;

/// Candidate point for a leader.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub center: DVec2,
    /// 0 for a point.
    pub radius: f64,
    /// The only direction, seen from the centre, from which leaders come; `None` for any.
    pub facing: Option<DVec2>,
}

/// Puts a linear dimension into the first lane with room, trying `sides` in this order; returns whether there was one.
pub(super) fn linear(
    board: &mut Board,
    view: &Seen,
    ends: [DVec2; 2],
    along: DVec2,
    sides: &[ViewSide],
    said: &Said,
) -> bool {
    // Programs that measure again do not know about breaks.
    let measured = (ends[1] - ends[0]).dot(along).abs() * said.scale;
    let is_whole = (measured - said.value).abs() <= 1e-6 * said.value.abs();
    let said = &Said { is_plain: said.is_plain && is_whole, ..said.clone() };
    for &side in sides {
        for lane in 0..LANES {
            let line = lane_at(view.bounds(), ends, along, side, FIRST + STEP * f64::from(lane));
            let draft = board.linear(&Linear { ends, line, along }, said);
            if board.is_free(&draft.solid) {
                board.put(draft);
                return true;
            }
        }
    }
    false
}

/// Returns a point of a dimension line at a distance from a view, or, for an oblique one, from its ends.
fn lane_at(bounds: Rect, ends: [DVec2; 2], along: DVec2, side: ViewSide, distance: f64) -> DVec2 {
    let (min, max) = (bounds.min(), bounds.max());
    let straight = along.x.abs() < 1e-3 || along.y.abs() < 1e-3;
    match side {
        ViewSide::Above if straight => DVec2::new(ends[0].x, min.y - distance),
        ViewSide::Below if straight => DVec2::new(ends[0].x, max.y + distance),
        ViewSide::Left if straight => DVec2::new(min.x - distance, ends[0].y),
        ViewSide::Right if straight => DVec2::new(max.x + distance, ends[0].y),
        _ => {
            let along = reading(along);
            let up = DVec2::new(along.y, -along.x);
            let sign = if matches!(side, ViewSide::Above | ViewSide::Left) { 1.0 } else { -1.0 };
            let (p, q) = (ends[0].dot(up), ends[1].dot(up));
            let outer = if sign > 0.0 { p.max(q) } else { p.min(q) };
            ends[0] + up * (outer - p + sign * distance)
        }
    }
}

/// Returns the sides on which a dimension may be, the nearest to the measured part first; only `wanted`, if given.
pub(super) fn sides(
    view: &Seen,
    ends: [DVec2; 2],
    along: DVec2,
    wanted: Option<ViewSide>,
) -> Vec<ViewSide> {
    if let Some(side) = wanted {
        return vec![side];
    }
    let bounds = view.bounds();
    let off = (ends[0] + ends[1]) * 0.5 - (bounds.min() + bounds.max()) * 0.5;
    let (first, second, swapped) = if along.x.abs() >= along.y.abs() {
        (ViewSide::Below, ViewSide::Above, off.y < -1e-6)
    } else {
        (ViewSide::Left, ViewSide::Right, off.x > 1e-6)
    };
    if swapped { vec![second, first] } else { vec![first, second] }
}

/// Puts a leader with a text to one of several equivalent targets, on the shortest free way; returns whether there was
/// one. `measure` returns the measured value from the target, the end of the leader and its direction.
pub(super) fn leader(
    board: &mut Board,
    view: &Seen,
    targets: &[Target],
    side: Option<ViewSide>,
    said: &Said,
    measure: impl Fn(&Target, DVec2) -> Option<Measure>,
) -> bool {
    let mut best: Option<(f64, Draft)> = None;
    for target in targets {
        for (order, degrees) in WAYS.iter().enumerate() {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            let way = DVec2::new(cos, -sin);
            let faces = target.facing.is_none_or(|f| f.dot(way) > 0.7);
            if !faces || !is_on(side, way) {
                continue;
            }
            let tip = target.center + way * target.radius;
            let exit = exit(view.bounds(), target.center, way);
            for step in 0..ELBOWS {
                let elbow =
                    target.center + way * (exit.max(target.radius) + ELBOW * f64::from(step + 1));
                // Nearly equal ones go by their order.
                let cost = tip.distance(elbow)
                    + CROSSING * board.crossings([tip, elbow]) as f64
                    + order as f64 * 0.5;
                if best.as_ref().is_some_and(|b| b.0 <= cost) {
                    continue;
                }
                let draft = board.leader(tip, elbow, said, measure(target, way));
                if board.is_free(&draft.solid) {
                    best = Some((cost, draft));
                }
            }
        }
    }
    let found = best.is_some();
    if let Some((_, draft)) = best {
        board.put(draft);
    }
    found
}

fn is_on(side: Option<ViewSide>, way: DVec2) -> bool {
    match side {
        None => true,
        Some(ViewSide::Above) => way.y < -0.5,
        Some(ViewSide::Below) => way.y > 0.5,
        Some(ViewSide::Left) => way.x < -0.25,
        Some(ViewSide::Right) => way.x > 0.25,
    }
}

/// Returns the distance from a point along a direction to the border of a rectangle; 0 if the point is outside.
fn exit(bounds: Rect, from: DVec2, way: DVec2) -> f64 {
    let (min, max) = (bounds.min(), bounds.max());
    let reach = |low: f64, high: f64, at: f64, way: f64| {
        if way > 1e-9 {
            (high - at) / way
        } else if way < -1e-9 {
            (low - at) / way
        } else {
            f64::INFINITY
        }
    };
    let both = reach(min.x, max.x, from.x, way.x).min(reach(min.y, max.y, from.y, way.y));
    if both.is_finite() { both.max(0.0) } else { 0.0 }
}
