//! Sutherland and Hodgman's method as a program with faults.

use super::{Program, fault};
use crate::clip::line::HalfPlane;
use crate::clip::polygon::sutherland_hodgman::INFO;
use crate::clip::polygon::sutherland_hodgman::by_borders::{EdgeRule, Step};
use crate::explain::clip_polygons::by_stages;
use crate::math::DVec2;
use crate::trace::{Recorder, Tracer};

pub(super) const PROGRAM: Program = Program {
    lesson: INFO.name,
    faults: &[
        fault(2, "S := the first vertex of the list; out := empty"),
        fault(4, "in→in: emit S"),
        fault(5, "in→out: emit P"),
        fault(6, "out→in: emit the cut of SP"),
        fault(7, "out→out: emit P"),
        fault(8, "S stays the same vertex"),
    ],
    frames: |input, line, cap| {
        by_stages(input, cap, |borders, ring, t| {
            clip(borders, ring, line, t);
            Ok(())
        })
    },
};

fn clip(borders: &[HalfPlane], ring: &[DVec2], faulty: usize, t: &mut Recorder<Step<DVec2>>) {
    let mut list = ring.to_vec();
    for (index, border) in borders.iter().enumerate() {
        list = past(index, border, &list, faulty, t);
        t.step(|| Step::List { border: index, vertices: list.clone() });
    }
}

/// Clips a list to one border.
fn past(
    index: usize,
    border: &HalfPlane,
    list: &[DVec2],
    faulty: usize,
    t: &mut Recorder<Step<DVec2>>,
) -> Vec<DVec2> {
    let start = if faulty == 2 { list.first() } else { list.last() };
    let Some(mut from) = start.copied() else { return Vec::new() };
    let value = |p: DVec2| border.normal.dot(p - border.point);
    let mut out = Vec::new();
    for &to in list {
        let rule = match (value(from) >= 0.0, value(to) >= 0.0) {
            (true, true) => EdgeRule::InIn,
            (true, false) => EdgeRule::InOut,
            (false, true) => EdgeRule::OutIn,
            (false, false) => EdgeRule::OutOut,
        };
        let cut = cut([from, to], [value(from), value(to)]);
        let emitted = match rule {
            EdgeRule::InIn => [None, Some(if faulty == 4 { from } else { to })],
            EdgeRule::InOut => [if faulty == 5 { Some(to) } else { cut }, None],
            EdgeRule::OutIn => [cut, (faulty != 6).then_some(to)],
            EdgeRule::OutOut => [None, (faulty == 7).then_some(to)],
        };
        out.extend(emitted.into_iter().flatten());
        t.step(|| Step::Edge { border: index, from, to, rule, emitted });
        if faulty != 8 {
            from = to;
        }
    }
    out
}

/// Returns the cut of an edge; none if one of its ends is on the border.
fn cut([from, to]: [DVec2; 2], [a, b]: [f64; 2]) -> Option<DVec2> {
    (a != 0.0 && b != 0.0).then(|| from + (to - from) * (a / (a - b)))
}
