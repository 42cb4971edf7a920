//! Cohen and Sutherland's method as a program with faults.

use super::{Program, fault};
use crate::Result;
use crate::clip::line::cohen_sutherland::{INFO, Step};
use crate::clip::line::{End, Segment};
use crate::clip::outcode::Outcode;
use crate::explain::clip_lines::by_codes;
use crate::math::{DVec2, Rect};
use crate::trace::{Recorder, Tracer};

pub(super) const PROGRAM: Program = Program {
    lesson: INFO.name,
    faults: &[
        fault(1, "code1 := outcode(A); code2 := outcode(A)"),
        fault(3, "if code1 AND code2 = 0000: accept AB, stop"),
        fault(4, "if code1 OR code2 ≠ 0000: reject, stop"),
        fault(7, "P := crossing of AB with the opposite border"),
        fault(8, "c := c without the border's bit"),
    ],
    frames: |input, line, cap| {
        by_codes(input, cap, |window, segment, t| {
            clip(window, segment, line, t);
            Result::Ok(())
        })
    },
};

/// Turns of the loop after which a program that does not end is stopped; without a fault it takes at most 8.
const MOST_TURNS: usize = 12;

fn clip(window: &Rect, segment: Segment<DVec2>, faulty: usize, t: &mut Recorder<Step<DVec2>>) {
    let whole = [segment.start, segment.end];
    let of = |p| Outcode::of_point_2d(window, p);
    let mut codes = if faulty == 1 { [of(whole[0]); 2] } else { whole.map(of) };
    t.step(|| Step::Codes { start: codes[0], end: codes[1] });
    for _ in 0..MOST_TURNS {
        let (or, and) = (codes[0] | codes[1], codes[0] & codes[1]);
        if (if faulty == 3 { and } else { or }).is_inside() {
            return t.step(|| Step::Accepted);
        }
        if !(if faulty == 4 { or } else { and }).is_inside() {
            return t.step(|| Step::Rejected);
        }
        let which = usize::from(codes[0].is_inside());
        let all = Outcode::BORDERS.into_iter();
        let Some(border) = all.into_iter().find(|&b| codes[which].contains(b)) else { return };
        let at = if faulty == 7 { opposite(border) } else { border };
        let point = crossing(window, whole, at);
        codes[which] = if faulty == 8 { Outcode(codes[which].0 & !border.0) } else { of(point) };
        let (end, code) = ([End::Start, End::End][which], codes[which]);
        t.step(|| Step::Cut { end, border, point, code });
    }
}

fn opposite(border: Outcode) -> Outcode {
    match border {
        Outcode::LEFT => Outcode::RIGHT,
        Outcode::RIGHT => Outcode::LEFT,
        Outcode::BOTTOM => Outcode::TOP,
        _ => Outcode::BOTTOM,
    }
}

/// Returns the crossing of a line with a border.
fn crossing(window: &Rect, [a, b]: [DVec2; 2], border: Outcode) -> DVec2 {
    let (min, max) = (window.min(), window.max());
    let (x, y) = match border {
        Outcode::LEFT => (Some(min.x), max.y),
        Outcode::RIGHT => (Some(max.x), max.y),
        Outcode::BOTTOM => (None, min.y),
        _ => (None, max.y),
    };
    match x {
        Some(x) => DVec2::new(x, a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x)),
        None => DVec2::new(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y), y),
    }
}
