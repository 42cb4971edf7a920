//! Liang and Barsky's method as a program with faults.

use super::{Program, fault};
use crate::clip::line::liang_barsky::{INFO, Numbers, Step};
use crate::clip::line::{End, HalfSpaceRelation, Segment};
use crate::explain::clip_lines::by_parameters;
use crate::math::{DVec2, Rect};
use crate::trace::{Recorder, Tracer};

pub(super) const PROGRAM: Program = Program {
    lesson: INFO.name,
    faults: &[
        fault(4, "p < 0, entered from outside: u1 := min(u1, r)"),
        fault(5, "p > 0, left to outside: u2 := max(u2, r)"),
        fault(7, "if u1 < u2, or all is outside a border: reject, stop"),
        fault(8, "if u1 > 0: the start is A + u2·(B − A)"),
        fault(9, "if u2 < 1: the end is A + u1·(B − A)"),
    ],
    frames: |input, line, cap| {
        by_parameters(input, cap, |window, segment, t| {
            clip(window, segment, line, t);
            Ok(())
        })
    },
};

/// A bound of the parameter, and the border that set it.
#[derive(Clone, Copy)]
struct Bound {
    u: f64,
    border: usize,
}

fn clip(window: &Rect, segment: Segment<DVec2>, faulty: usize, t: &mut Recorder<Step<DVec2>>) {
    let (a, b) = (segment.start, segment.end);
    let (min, max) = (window.min(), window.max());
    // Distances of both ends inwards, border by border.
    let inwards = |p: DVec2| [p.x - min.x, max.x - p.x, p.y - min.y, max.y - p.y];
    let mut u1 = Bound { u: 0.0, border: 0 };
    let mut u2 = Bound { u: 1.0, border: 0 };
    let mut outside = false;
    for (border, (q, end)) in inwards(a).into_iter().zip(inwards(b)).enumerate() {
        let (p, r) = (q - end, q / (q - end));
        if p < 0.0 && if faulty == 4 { r < u1.u } else { r > u1.u } {
            u1 = Bound { u: r, border };
        }
        if p > 0.0 && if faulty == 5 { r > u2.u } else { r < u2.u } {
            u2 = Bound { u: r, border };
        }
        let relation = match (q >= 0.0, end >= 0.0) {
            (true, true) => HalfSpaceRelation::Inside,
            (false, true) => HalfSpaceRelation::Entering,
            (true, false) => HalfSpaceRelation::Leaving,
            (false, false) => HalfSpaceRelation::Outside,
        };
        outside |= relation == HalfSpaceRelation::Outside;
        let numbers = Numbers { start: q, end, lower: u1.u, upper: u2.u };
        t.step(|| Step::Border { border, relation, numbers });
    }
    let passed = if faulty == 7 { u1.u < u2.u } else { u1.u > u2.u };
    if passed || outside {
        return t.step(|| Step::Rejected);
    }
    let at = |u: f64| a + (b - a) * u;
    if u1.u > 0.0 {
        let point = at(if faulty == 8 { u2.u } else { u1.u });
        t.step(|| Step::Cut { end: End::Start, border: u1.border, point });
    }
    if u2.u < 1.0 {
        let point = at(if faulty == 9 { u1.u } else { u2.u });
        t.step(|| Step::Cut { end: End::End, border: u2.border, point });
    }
    t.step(|| Step::Accepted);
}
